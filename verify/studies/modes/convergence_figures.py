"""Errors of modes over sizes, the bracket and run times, and how they are told."""

from itertools import groupby
from math import log
from typing import TYPE_CHECKING, Any

import msgspec

from verify.errors import InputError, NoBracketError
from verify.judge.crossing import ASTRAY
from verify.judge.variants import DEFAULTS, Variant
from verify.judge.workbench import Settings, Workbench, bracketed, comparable, has_bracket, theory_of
from verify.models.catalogue import MODELS
from verify.models.naming import MEAN
from verify.patience import check_work
from verify.studies.chart import Chart
from verify.studies.kind import Progress
from verify.studies.told import Column, Found, Table
from verify.timing import interleaved_medians
from verify.words import percent, theory_name

if TYPE_CHECKING:
    from collections.abc import Sequence

    from verify.beam import Beam
    from verify.studies.modes.convergence import Convergence


class Cell(msgspec.Struct, frozen=True, kw_only=True):
    """One mode of one model at one size. None where the model has no such mode there."""

    frequency_hz: float | None = None
    error: float | None = None
    order: float | None = None
    """Observed between this size and the one before; None at the first and where rounding rules."""
    run_time_s: float | None = None
    """Median of warm repeats of the whole solve, set-up included, for all modes of the table up to the last."""


class Row(msgspec.Struct, frozen=True, kw_only=True):
    """All models at one size for one mode."""

    mode: int
    count: int
    exact_hz: dict[str, float]
    """By each theory that is asked for; without those that the beam has no figure of."""
    cells: dict[str, Cell]
    """By the label of each variant: 'segment', 'segment wall=half'."""
    bracket_width: float | None
    """(upper - lower) / mean; None where there is no bracket."""
    mean_error: float | None
    """Error of the middle of the bracket."""
    notes: tuple[str, ...] = ()
    """Why a cell is empty, and by which of several settings the bracket is."""


class Bracketed(msgspec.Struct, frozen=True, kw_only=True):
    """By which of the settings that stand side by side there is a bracket."""

    settings: Settings = ()
    why_not: str = ""
    """Why by none of them; empty where there is one."""
    told: str = ""
    """By which, where others that stand beside it have none."""


class RuleErrors(msgspec.Struct, frozen=True, kw_only=True):
    """The error of one mode by one rule of the chain over sizes."""

    variant: Variant
    mode: int
    counts: tuple[int, ...]
    errors: tuple[float | None, ...]
    why: str = ""
    """Why there is none at any size; empty where there is one."""


class ConvergenceFound(Found, frozen=True, eq=False, kw_only=True):
    """Rows by mode, then by size."""

    rows: tuple[Row, ...]
    variants: tuple[Variant, ...] = ()
    """Of the cells."""
    bracketed: Bracketed = Bracketed()
    """By which settings the bracket is."""
    slopes: tuple[tuple[str, int], ...] = ()
    """(label of a variant, order at which it converges on this beam, as theory has it)."""
    rules: tuple[RuleErrors, ...] = ()
    """Every rule of the chain that makes a difference on this beam; none where there is but one."""

    def in_short(self) -> str:
        """What is left of the highest mode's error at the largest size, and how it fell on the way."""
        mode = max((row.mode for row in self.rows), default=0)
        own = [row for row in self.rows if row.mode == mode]
        if not own:
            return ""
        told = [_told(one.title, [row.cells[one.label] for row in own], self._due(one)) for one in self.variants]
        return f"At mode {mode} and N = {own[-1].count}, {' and '.join(told)}." if told else ""

    def _due(self, one: Variant) -> int | None:
        """The order at which a variant converges on this beam; None where nobody says."""
        return dict(self.slopes).get(one.label)

    def tables(self) -> tuple[Table, ...]:
        """One for each mode, of some variants at a time where there are many."""
        groups = [tuple(group) for _, group in groupby(self.rows, key=lambda row: row.mode)]
        parts = [self.variants[i : i + ABREAST] for i in range(0, len(self.variants), ABREAST)]
        tables = [(group, part) for group in groups for part in parts]
        slopes = dict(self.slopes)
        theories = tuple(dict.fromkeys(one.variant.theory for one in self.rules))
        rules = (self._rules_table(theory, several=len(theories) > 1) for theory in theories)
        return (*(_mode_table(group, part, slopes) for group, part in tables), *rules)

    def _rules_table(self, theory: str, *, several: bool) -> Table:
        """By one theory, which is named where there are several."""
        own = [one for one in self.rules if one.variant.theory == theory]
        by = f"{theory_name(theory)} and " if several else ""
        return Table(
            title=f"mode {own[0].mode} by {by}every rule of the chain, error in %",
            columns=(Column("N"), *(Column(_rule(one.variant), "bare percent") for one in own)),
            rows=tuple(zip(own[0].counts, *(one.errors for one in own), strict=True)),
            notes=tuple(f"{_rule(one.variant)}: {one.why}" for one in own if one.why),
        )

    def charts(self) -> tuple[Chart, ...]:
        """Errors over sizes, the rules of the chain, the bracket, run time against error."""
        from verify.studies.modes.charts import convergence_charts

        return convergence_charts(self)

    def records(self) -> list[dict[str, Any]]:
        """Rows with one level of names; those of the mode that has them with the errors of every rule."""
        return [flat_row(row, self.rules) for row in self.rows]

    def plain(self) -> Any:
        """The same."""
        return self.records()


def _told(title: str, cells: "Sequence[Cell]", due: int | None) -> str:
    """What is left of an error at the largest size, and how it fell; that there is none where there is none."""
    error = cells[-1].error
    if error is None:
        return f"{title} have no such mode"
    falling = f", {_falling([cell.order for cell in cells], due)}" if len(cells) > 1 else ""
    return f"{title} are {percent(error)} off{falling}"


def _falling(orders: "Sequence[float | None]", due: int | None) -> str:
    """At which order, where the last two that are seen lie near the one that is due, or near each other."""
    last, before = orders[-1], orders[-2] if len(orders) > 2 else None
    if last is None:
        return "with no order to the size before (rounding, or a change of sign)"
    if last <= 0.0:
        return "not falling yet with the size before"
    if not strays(orders, due):
        return f"falling at order {last:.2f}" + ("" if before is not None else " over two sizes alone")
    seen = ", ".join(f"{order:.2f}" for order in (before, last) if order is not None)
    theory = f", where {due} is due" if due else ""
    return f"falling at no settled order ({seen}{theory}: sizes near a change of sign or too coarse)"


def strays(orders: "Sequence[float | None]", due: int | None) -> bool:
    """Whether the last two orders lie apart from the one that is due, or, where nobody knows that, from each other.

    `orders` over sizes, the first of which has none before it.
    """
    seen = [order for order in orders[1:][-2:] if order is not None]
    known = due if due is not None else seen[-1] if seen else 0.0
    return any(abs(order - known) > ASTRAY for order in seen)


def flat_row(row: Row, rules: tuple[RuleErrors, ...] = ()) -> dict[str, Any]:
    """One row with one level of names, and the errors of rules that are none of its cells."""
    alone = len(row.exact_hz) == 1
    exact = {"exact_hz" if alone else f"{theory}_exact_hz": hertz for theory, hertz in row.exact_hz.items()}
    flat: dict[str, Any] = {"mode": row.mode, "count": row.count, **exact}
    for model, cell in row.cells.items():
        flat |= {f"{model}_{name}": value for name, value in msgspec.to_builtins(cell).items()}
    for one in rules:
        if one.variant.label not in row.cells:
            errors = dict(zip(one.counts, one.errors, strict=True)) if one.mode == row.mode else {}
            flat[f"{one.variant.label}_error"] = errors.get(row.count)
    return flat | {"bracket_width": row.bracket_width, "mean_error": row.mean_error, "notes": list(row.notes)}


READ_SO = (
    "Frequencies in Hz, errors against the exact beam by {} and the bracket's width in %, order from the size before, "
    "warm solve in ms. A dash under order: there is no size before it, or rounding or a change of sign between."
)


ABREAST = 2
"""Variants in one table: more do not fit into a terminal."""


def _rule(variant: Variant) -> str:
    """A rule of the chain above a column of a table of one theory."""
    return ", ".join(f"{n} {value}" for n, value in variant.settings if n != "theory") or "default"


def _head(variant: Variant) -> str:
    """What stands above a variant's frequencies."""
    words = MODELS[variant.model].title.split()[0] or variant.model
    return " ".join([words, *(str(value) for _, value in variant.settings)])


def _exact(rows: tuple[Row, ...], variants: tuple[Variant, ...]) -> str:
    """The exact frequency that errors are against; of each theory where the variants have several."""
    theories = dict.fromkeys(one.theory for one in variants)
    found = {theory: hertz for theory, hertz in rows[0].exact_hz.items() if theory in theories}
    if len(found) < 2:
        return next((f"{hertz:.4f} Hz" for hertz in found.values()), "not known")
    return ", ".join(f"{hertz:.4f} Hz ({theory_name(theory)})" for theory, hertz in found.items())


def _strayed(rows: tuple[Row, ...], one: Variant, due: int | None) -> tuple[str, ...]:
    """That the orders of a variant are none, where its last two are not."""
    if not strays([row.cells[one.label].order for row in rows], due):
        return ()
    return (f"{one.title}: orders are not settled{f', {due} is due' if due else ''}",)


def _mode_table(rows: tuple[Row, ...], variants: tuple[Variant, ...], slopes: dict[str, int]) -> Table:
    columns = [Column("N")]
    for one in variants:
        error, order, time = Column("error %", "bare percent"), Column("order", ".2f"), Column("ms", ".3g", 1e3)
        columns += [Column(_head(one), ".7g"), error, order, time]
    columns += [Column("bracket", "bare size"), Column("mean %", "bare percent", wide=True)]
    notes = tuple(dict.fromkeys(note for row in rows for note in row.notes))
    notes += tuple(note for one in variants for note in _strayed(rows, one, slopes.get(one.label)))
    return Table(
        title=f"mode {rows[0].mode}, exact {_exact(rows, variants)}",
        columns=tuple(columns),
        rows=tuple((row.count, *_figures(row, variants), row.bracket_width, row.mean_error) for row in rows),
        notes=(*notes, READ_SO.format(" and ".join(dict.fromkeys(theory_name(one.theory) for one in variants)))),
    )


def _figures(row: Row, variants: tuple[Variant, ...]) -> list[float | None]:
    cells = [row.cells[one.label] for one in variants]
    return [value for cell in cells for value in (cell.frequency_hz, cell.error, cell.order, cell.run_time_s)]


def convergence(bench: Workbench, asked: "Convergence", progress: Progress = lambda step: None) -> ConvergenceFound:
    """Everything a [convergence] asks for. `progress` is told the size about to be solved. Raises InputError."""
    last = max(asked.modes)
    names, left_out = comparable(bench.beam, asked.counts, last)
    variants = asked.variants(names)
    _check_together(bench.beam, variants, asked.counts, last)
    theories, seconds = tuple(dict.fromkeys(map(theory_of, asked.combinations))), {}
    for count in asked.counts:
        progress(f"{count} segments and elements")
        seconds[count] = _timed(bench, variants, count, last)
    rows: list[Row] = []
    by = _bracketed(bench.beam, asked)
    for mode in asked.modes:
        previous: Row | None = None
        for count in asked.counts:
            previous = _row(bench, mode, count, seconds[count], previous, by, theories, tuple(left_out.values()))
            rows.append(previous)
    orders = ((one.label, one.order(bench.beam)) for one in variants)
    return ConvergenceFound(
        rows=tuple(rows),
        variants=variants,
        bracketed=by,
        slopes=tuple((label, order) for label, order in orders if order),
        rules=_rules(bench, variants, asked, last),
    )


def _rules(bench: Workbench, variants: tuple[Variant, ...], asked: "Convergence", mode: int) -> tuple[RuleErrors, ...]:
    """Errors by every rule of the chain on this beam, the default first; none where it has one rule alone."""
    every, counts = asked.every_rule(bench.beam), asked.counts
    models = dict.fromkeys(one.model for one in every)
    shown = dict.fromkeys((*(one for one in variants if one.model in models), *every))
    found = []
    for one in shown if every else ():
        errors, whys = zip(*(bench.error_or_why(one.model, n, mode, one.settings) for n in counts), strict=True)
        why = whys[-1] if all(error is None for error in errors) else ""
        found.append(RuleErrors(variant=one, mode=mode, counts=counts, errors=errors, why=why))
    return tuple(found)


def _check_together(beam: "Beam", variants: tuple[Variant, ...], counts: tuple[int, ...], n_modes: int) -> None:
    """Raise InputError where all solves, each done and then timed, would take too long."""
    from verify.models.eigen import solve_seconds

    seconds = 0.0
    for count in counts:
        for one in variants:
            model, how = MODELS[one.model], dict(one.settings)
            n = min(n_modes, model.n_elastic(beam, count, **how))
            seconds += solve_seconds(model.unknowns(beam, count, **how), n)
    check_work("counts", list(counts), 2.0 * seconds, "give fewer or smaller ones")


def _timed(bench: Workbench, variants: tuple[Variant, ...], count: int, n_modes: int) -> dict[Variant, float]:
    """Seconds of a warm solve for each variant, medians of rounds in which they take turns."""
    solves = []
    for one in variants:
        model, settings = MODELS[one.model], dict(one.settings)
        n = min(n_modes, model.n_elastic(bench.beam, count, **settings))
        solves.append(lambda model=model, n=n, how=settings: model.solve_modes(bench.beam, n, count, **how))
        bench.modes(one.model, count, n, one.settings)
    return dict(zip(variants, interleaved_medians(solves), strict=True))


def _row(
    bench: Workbench,
    mode: int,
    count: int,
    seconds: dict[Variant, float],
    previous: Row | None,
    by: Bracketed,
    theories: tuple[str, ...],
    left_out: tuple[str, ...],
) -> Row:
    cells, notes = {}, []
    for one, time in seconds.items():
        cells[one.label], note = _cell(bench, one, mode, count, time, previous)
        notes += [note] if note else []
    width, mean_error, why = _bracket(bench, mode, count, by)
    notes += [why] if why and not (notes and width is None) else []
    return Row(
        mode=mode,
        count=count,
        exact_hz=_exact_hz(bench, mode, theories),
        cells=cells,
        bracket_width=width,
        mean_error=mean_error,
        notes=(*notes, *left_out),
    )


def _bracketed(beam: "Beam", asked: "Convergence") -> Bracketed:
    """Of the settings that are asked for the first by which a beam has a bracket."""
    try:
        settings = bracketed(beam, asked.combinations)
    except NoBracketError as error:
        return Bracketed(why_not=str(error))
    if all(has_bracket(beam, others) for others in asked.combinations):
        return Bracketed(settings=settings)
    words = ", ".join(f"{name} {dict(settings).get(name, DEFAULTS[name])}" for name in asked.several)
    return Bracketed(
        settings=settings,
        told=f"the bracket and its mean are those of {words}: by the others segments may lie above the exact frequency",
    )


def _bracket(bench: Workbench, mode: int, count: int, by: Bracketed) -> tuple[float | None, float | None, str]:
    """(width of the bracket, error of its middle, by which of several settings), or (None, None, why there is none)."""
    if by.why_not:
        return None, None, by.why_not
    try:
        found = bench.bracket(mode, count, by.settings)
        return found.relative_width, bench.frequency_error(MEAN, count, mode, by.settings), by.told
    except InputError as error:
        return None, None, str(error)


def _exact_hz(bench: Workbench, mode: int, theories: tuple[str, ...]) -> dict[str, float]:
    """By each theory; of several, by those that have a figure. Raises InputError."""
    found = {}
    for theory in theories:
        try:
            found[theory] = bench.exact_hz(mode, theory)
        except InputError:
            if len(theories) == 1:
                raise
    return found


def _cell(
    bench: Workbench, one: Variant, mode: int, count: int, seconds: float, previous: Row | None
) -> tuple[Cell, str]:
    error, note = bench.error_or_why(one.model, count, mode, one.settings)
    if error is None:
        return Cell(), note
    order = _local_order(previous.count, previous.cells[one.label].error, count, error) if previous else None
    frequency = bench.paired_frequency_hz(one.model, count, mode, one.settings)
    return Cell(frequency_hz=frequency, error=error, order=order, run_time_s=seconds), ""


def _local_order(count_1: int, error_1: float | None, count_2: int, error_2: float) -> float | None:
    """The order between two sizes; None where an error is rounding, changes sign or the sizes are equal."""
    from verify.judge.compare import ORDER_FLOOR

    if error_1 is None or count_1 == count_2 or error_1 * error_2 <= 0 or min(abs(error_1), abs(error_2)) < ORDER_FLOOR:
        return None
    return log(error_1 / error_2) / log(count_2 / count_1)
