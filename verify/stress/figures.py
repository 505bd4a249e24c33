"""The stress table: rows measured one by one, and how what was found is told."""

from collections.abc import Callable, Iterable, Iterator
from typing import TYPE_CHECKING, Any
from weakref import WeakKeyDictionary

import msgspec

from verify.patience import PATIENCE_S, patient
from verify.stress.catalogue import row, rows
from verify.stress.kind import Outcome, Row, exponent
from verify.studies.chart import Chart
from verify.studies.told import Column, Found, Table

if TYPE_CHECKING:
    from verify.judge.workbench import Workbench

WORST = 5
"""Rows named in a sentence."""
PUSHED = "rows solved on beams of their own"


class StressFound(Found, frozen=True, eq=False, kw_only=True):
    """Outcomes of rows, in the order of the table."""

    outcomes: tuple[Outcome, ...]
    left_out: tuple[str, ...] = ()
    """Ids of rows that were not begun, since they take longer than was given."""
    date: str = ""
    machine: dict[str, str | int] = msgspec.field(default_factory=dict)

    @property
    def held(self) -> bool:
        """Whether every row is."""
        return all(one.held for one in self.outcomes)

    def tables(self) -> tuple[Table, ...]:
        """Every row; reasons below."""
        refused = (refused_table(self),) if any(one.said for one in self.outcomes) else ()
        return (stress_table(self), textbook_table(self), *refused)

    def charts(self) -> tuple[Chart, ...]:
        """Errors over size, costs over size, shares of all promises."""
        from verify.stress.charts import stress_charts

        return stress_charts(self)

    def in_short(self) -> str:
        """How many promises are held."""
        n, held = len(self.outcomes), sum(one.held for one in self.outcomes)
        return f"{held} of {n} promises are held where they were pushed."

    def facts(self) -> tuple[str, ...]:
        """How many are held, which come closest, what is not held."""
        n, held = len(self.outcomes), sum(one.held for one in self.outcomes)
        said = [f"{held} of {n} rows are held"]
        if close := self.worst()[:WORST]:
            said.append(
                "closest to their promise: " + ", ".join(f"{one.id} (margin {one.margin:.2g})" for one in close)
            )
        said += [f"{one.id} is not held: {one.reason}" for one in self.outcomes if not one.held]
        if self.left_out:
            said.append(f"left out, for they take longer than is waited for: {', '.join(self.left_out)}")
        return tuple(said)

    def worst(self) -> list[Outcome]:
        """Rows with a margin, the thinnest first."""
        return sorted((one for one in self.outcomes if one.margin is not None), key=lambda one: one.margin or 0.0)

    def plain(self) -> dict[str, Any]:
        """For JSON: rows, and the exponents fitted to costs."""
        return {
            "date": self.date,
            "machine": self.machine,
            "rows": [msgspec.to_builtins(one) for one in self.outcomes],
            "fits": [fit for one in self.outcomes if one.kind == "growth" for fit in _fits(one)],
            "left_out": list(self.left_out),
        }

    def records(self) -> list[dict[str, Any]]:
        """A row each, without its points and sentences."""
        drop = ("points", "beside_points", "said")
        return [{k: v for k, v in msgspec.to_builtins(one).items() if k not in drop} for one in self.outcomes]


def _fits(one: Outcome) -> Iterator[dict[str, Any]]:
    for what, points in ((one.title, one.points), (one.textbook, one.beside_points)):
        if points:
            yield {
                "what": what,
                "row": one.id,
                "exponent": exponent(points),
                "unit": one.unit,
                "sizes": [size for size, _ in points],
                "costs": [cost for _, cost in points],
            }


def stress_table(found: StressFound) -> Table:
    """What is promised, measured and left, and how far it was pushed."""
    return Table(
        before="Each row pushes one figure along what makes it hard, or takes a list of cases in turn. A floor is the "
        "most its error may be, a growth the largest exponent of a cost, a refusal the field that one sentence has to "
        "name. Margin: promise over measured.",
        columns=(
            Column("row", left=True),
            Column("promise", ".2g"),
            Column("measured", ".2g"),
            Column("margin", ".2g"),
            Column("held", left=True),
            Column("pushed to", left=True),
            Column("textbook", ".1e", wide=True),
            Column("s", ".1f", wide=True),
        ),
        rows=tuple(_cells(one) for one in found.outcomes),
        notes=tuple(f"{one.id}: {one.reason}" for one in found.outcomes if not one.held),
        shown="both",
    )


def _cells(one: Outcome) -> tuple[Any, ...]:
    refused = one.kind == "refusal"
    measured: Any = ("refused" if one.held else "not refused") if refused else one.measured
    return (
        one.id,
        "refused" if refused else one.promise,
        measured,
        one.margin,
        "held" if one.held else "NOT HELD",
        pushed(one),
        one.beside,
        one.seconds,
    )


def pushed(one: Outcome) -> str:
    """The value it was pushed to, or from where on it breaks, in words."""
    if one.value is None:
        return ""
    number = f"{one.value:g}" if float(one.value).is_integer() and abs(one.value) < 1e5 else f"{one.value:.3g}"
    return f"{'breaks at ' if one.breaks else ''}{number} {one.along}"


def textbook_table(found: StressFound) -> Table:
    """Why each is promised, and what the textbook's way is."""
    return Table(
        title="Where each promise comes from, and the textbook's way",
        columns=(
            Column("row", left=True),
            Column("what", left=True),
            Column("why", left=True),
            Column("textbook's way", left=True),
        ),
        rows=tuple((one.id, one.title, one.why, one.textbook) for one in found.outcomes),
        folded=True,
    )


def refused_table(found: StressFound) -> Table:
    """Every sentence of the rows that hold many."""
    return Table(
        title="What is refused, and what is said of it",
        columns=(Column("row", left=True), Column("sentence", left=True)),
        rows=tuple((one.id, sentence) for one in found.outcomes for sentence in one.said),
        folded=True,
    )


_DONE: "WeakKeyDictionary[Workbench, dict[str, Outcome]]" = WeakKeyDictionary()


def measured(one: Row) -> Outcome:
    """A row's outcome, with the patience that its promise was made for, whatever the environment says."""
    with patient(PATIENCE_S):
        return one.run()


def outcome_on(bench: "Workbench", name: str) -> Outcome:
    """A row's outcome, measured once on a bench. Raises InputError for a row that is not known."""
    done = _DONE.setdefault(bench, {})
    if name not in done:
        done[name] = measured(row(name))
        bench.others[PUSHED] = len(done)
    return done[name]


def chosen(names: Iterable[str], *, quick: bool) -> tuple[Row, ...]:
    """Rows by their ids; all of them, or all that are quick, where none is named. Raises InputError."""
    given = tuple(names)
    if given:
        return tuple(row(name) for name in dict.fromkeys(given))
    return tuple(one for one in rows().values() if one.quick or not quick)


def stress(
    asked: Iterable[Row], step: Callable[[str], None], bench: "Workbench | None" = None, *, cap: float | None = None
) -> Iterator[Outcome | str]:
    """Every outcome as soon as it is there; its id where its estimate lies beyond `cap` seconds."""
    for one in asked:
        if cap is not None and one.seconds > cap:
            yield one.id
            continue
        step(one.id)
        yield outcome_on(bench, one.id) if bench is not None else measured(one)


def told(outcomes: Iterable[Outcome | str]) -> StressFound:
    """Everything together, with day and machine."""
    import os
    import platform
    from datetime import UTC, datetime
    from importlib.metadata import version

    every = tuple(outcomes)
    machine: dict[str, str | int] = {"system": platform.system(), "machine": platform.machine()}
    machine |= {"cores": os.cpu_count() or 0, "python": platform.python_version()}
    machine |= {name: version(name) for name in ("numpy", "scipy")}
    return StressFound(
        outcomes=tuple(one for one in every if isinstance(one, Outcome)),
        left_out=tuple(one for one in every if isinstance(one, str)),
        date=datetime.now(UTC).date().isoformat(),
        machine=machine,
    )
