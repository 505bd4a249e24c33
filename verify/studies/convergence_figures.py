"""Errors of modes over sizes, the bracket and run times, and how they are told."""

from itertools import groupby
from math import log
from typing import TYPE_CHECKING, Any

import msgspec

from verify.errors import InputError
from verify.judge.workbench import Workbench, comparable
from verify.models.catalogue import MODELS
from verify.models.naming import MEAN
from verify.patience import check_work
from verify.studies.kind import Progress
from verify.studies.told import Chart, Column, Found, Table
from verify.timing import interleaved_medians

if TYPE_CHECKING:
    from verify.beam import Beam
    from verify.studies.convergence import Convergence


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
    exact_hz: float
    cells: dict[str, Cell]
    """By model."""
    bracket_width: float | None
    """(upper - lower) / mean; None where there is no bracket."""
    mean_error: float | None
    """Error of the middle of the bracket."""
    notes: tuple[str, ...] = ()
    """Why a cell is empty."""


class ConvergenceFound(Found, frozen=True, eq=False, kw_only=True):
    """Rows by mode, then by size."""

    rows: tuple[Row, ...]

    def tables(self) -> tuple[Table, ...]:
        """One for each mode."""
        groups = [tuple(group) for _, group in groupby(self.rows, key=lambda row: row.mode)]
        return tuple(_mode_table(group) for group in groups)

    def charts(self) -> tuple[Chart, ...]:
        """Errors over sizes, the bracket, run time against error."""
        from verify.studies.mode_charts import convergence_charts

        return convergence_charts(self.rows)

    def records(self) -> list[dict[str, Any]]:
        """Rows with one level of names."""
        return [flat_row(row) for row in self.rows]

    def plain(self) -> Any:
        """The same."""
        return self.records()


def flat_row(row: Row) -> dict[str, Any]:
    """One row with one level of names."""
    flat: dict[str, Any] = {"mode": row.mode, "count": row.count, "exact_hz": row.exact_hz}
    for model, cell in row.cells.items():
        flat |= {f"{model}_{name}": value for name, value in msgspec.to_builtins(cell).items()}
    return flat | {"bracket_width": row.bracket_width, "mean_error": row.mean_error, "notes": list(row.notes)}


READ_SO = (
    "Frequencies in Hz, errors against exact Euler-Bernoulli and the bracket's width in %, order from the size before, "
    "warm solve in ms. A dash under order: there is no size before it, or rounding or a change of sign between."
)


def _mode_table(rows: tuple[Row, ...]) -> Table:
    columns = [Column("N")]
    for model in rows[0].cells:
        error, order, time = Column("error %", "bare percent"), Column("order", ".2f"), Column("ms", ".3g", 1e3)
        columns += [Column(MODELS[model].title.split()[0] or model, ".7g"), error, order, time]
    columns += [Column("bracket", "bare size"), Column("mean %", "bare percent", wide=True)]
    notes = tuple(dict.fromkeys(note for row in rows for note in row.notes))
    return Table(
        title=f"mode {rows[0].mode}, exact {rows[0].exact_hz:.4f} Hz",
        columns=tuple(columns),
        rows=tuple((row.count, *_figures(row), row.bracket_width, row.mean_error) for row in rows),
        notes=(*notes, READ_SO),
    )


def _figures(row: Row) -> list[float | None]:
    return [
        value for cell in row.cells.values() for value in (cell.frequency_hz, cell.error, cell.order, cell.run_time_s)
    ]


def convergence(bench: Workbench, asked: "Convergence", progress: Progress = lambda step: None) -> tuple[Row, ...]:
    """Rows by mode, then by size. `progress` is told the size about to be solved. Raises InputError."""
    names, left_out = comparable(bench.beam, asked.counts, max(asked.modes))
    models = tuple(names)
    _check_together(bench.beam, models, asked.counts, max(asked.modes))
    seconds = {}
    for count in asked.counts:
        progress(f"{count} segments and elements")
        seconds[count] = _timed(bench, models, count, max(asked.modes))
    rows: list[Row] = []
    for mode in asked.modes:
        previous: Row | None = None
        for count in asked.counts:
            previous = _row(bench, mode, count, seconds[count], previous, tuple(left_out.values()))
            rows.append(previous)
    return tuple(rows)


def _check_together(beam: "Beam", models: tuple[str, ...], counts: tuple[int, ...], n_modes: int) -> None:
    """Raise InputError where all solves, each done and then timed, would take too long."""
    from verify.models.eigen import solve_seconds

    sizes = [(MODELS[model], count) for count in counts for model in models]
    seconds = sum(solve_seconds(model.unknowns(beam, n), min(n_modes, model.n_elastic(beam, n))) for model, n in sizes)
    check_work("counts", list(counts), 2.0 * seconds, "give fewer or smaller ones")


def _timed(bench: Workbench, models: tuple[str, ...], count: int, n_modes: int) -> dict[str, float]:
    """Seconds of a warm solve for each model, medians of rounds in which the models take turns."""
    solves = {}
    for name in models:
        model = MODELS[name]
        n = min(n_modes, model.n_elastic(bench.beam, count))
        solves[name] = lambda model=model, n=n: model.solve_modes(bench.beam, n, count)
        bench.modes(name, count, n)
    return dict(zip(models, interleaved_medians(list(solves.values())), strict=True))


def _row(
    bench: Workbench, mode: int, count: int, seconds: dict[str, float], previous: Row | None, left_out: tuple[str, ...]
) -> Row:
    cells, notes = {}, []
    for model, time in seconds.items():
        cells[model], note = _cell(bench, model, mode, count, time, previous)
        notes += [note] if note else []
    width = mean_error = None
    try:
        found = bench.bracket(mode, count)
        width, mean_error = found.relative_width, bench.frequency_error(MEAN, count, mode)
    except InputError as error:
        notes += [str(error)] if not notes else []
    return Row(
        mode=mode,
        count=count,
        exact_hz=bench.exact_hz(mode),
        cells=cells,
        bracket_width=width,
        mean_error=mean_error,
        notes=(*notes, *left_out),
    )


def _cell(
    bench: Workbench, model: str, mode: int, count: int, seconds: float, previous: Row | None
) -> tuple[Cell, str]:
    error, note = bench.error_or_why(model, count, mode)
    if error is None:
        return Cell(), note
    order = _local_order(previous.count, previous.cells[model].error, count, error) if previous else None
    frequency = bench.paired_frequency_hz(model, count, mode)
    return Cell(frequency_hz=frequency, error=error, order=order, run_time_s=seconds), ""


def _local_order(count_1: int, error_1: float | None, count_2: int, error_2: float) -> float | None:
    """The order between two sizes; None where an error is rounding, changes sign or the sizes are equal."""
    from verify.judge.compare import ORDER_FLOOR

    if error_1 is None or count_1 == count_2 or error_1 * error_2 <= 0 or min(abs(error_1), abs(error_2)) < ORDER_FLOOR:
        return None
    return log(error_1 / error_2) / log(count_2 / count_1)
