"""What a bench found, and how it is told: a table and a chart for each case, a sentence for each comparison."""

from itertools import groupby
from typing import Any

import msgspec

from verify.bench.rows import ChildCost, Row, Sentence, plain_row
from verify.peers.breaking import Break
from verify.studies.chart import Chart
from verify.studies.told import Column, Found, Table
from verify.words import told_once


class BenchFound(Found, frozen=True, eq=False, kw_only=True):
    """Rows by set, case and method."""

    scene: str
    date: str
    machine: dict[str, str]
    versions: dict[str, str]
    costs: tuple[ChildCost, ...]
    rows: tuple[Row, ...]
    sentences: tuple[Sentence, ...]
    pushed: tuple[Break, ...] = ()
    """What other engines did beyond what they bear."""
    notes: tuple[str, ...] = ()
    """Sets that nobody asks for and methods that take no part, each with the reason."""
    refused: tuple[str, ...] = ()
    """Sets and cases that are asked for and cannot be run, each with the reason."""
    estimate_s: float = 0.0
    """Seconds that the work was estimated to take, from above."""
    load: float | None = None
    """Processes that ran or waited when it ended, over the cores, this one among them; None where nobody counts."""
    moved: tuple[Sentence, ...] = ()
    """Against an earlier run: what moved."""

    def in_short(self) -> str:
        """The first comparison that was earned, else the first at errors that are asked for."""
        told = sorted((one for one in self.sentences if one.earned or one.at), key=lambda one: not one.earned)
        return next((one.text for one in told), "")

    def facts(self) -> tuple[str, ...]:
        """What moved against an earlier run, where there is one; a sentence for each comparison; what cannot be run."""
        return (*(one.text for one in (*self.moved, *self.sentences)), *self.refused)

    def tables(self) -> tuple[Table, ...]:
        """One for each case, what broke, and what processes of their own paid."""
        return (*(_case_table(rows) for rows in self.by_case()), *self._pushed_table(), *self._costs_table())

    def by_case(self) -> list[tuple[Row, ...]]:
        """The rows of each case."""
        return [tuple(rows) for _, rows in groupby(self.rows, key=lambda row: row.line[:2])]

    def _pushed_table(self) -> tuple[Table, ...]:
        if not self.pushed:
            return ()
        rows = tuple((b.engine, b.links, b.pushed, b.did or "did not break", b.steps, b.seconds) for b in self.pushed)
        return (Table(title="Other engines pushed until they break", columns=PUSHED, rows=rows, folded=True),)

    def _costs_table(self) -> tuple[Table, ...]:
        machine = ", ".join((*self.machine.values(), *(f"{name} {v}" for name, v in self.versions.items())))
        rows = tuple((one.what, one.seconds) for one in self.costs)
        columns = (Column("once in a process", left=True), Column("time", "duration"))
        busy = "" if self.load is None else f", {self.load:g} processes to a core"
        notes = (f"Of {self.date} on {machine}{busy}.", *told_once(self.notes))
        return (Table(title="What is paid once" if rows else "On what", columns=columns, rows=rows, notes=notes),)

    def charts(self) -> tuple[Chart, ...]:
        """One for each set: run time against error."""
        from verify.bench.charts import bench_charts

        return bench_charts(self)

    def records(self) -> list[dict[str, Any]]:
        """Every row, settings in words."""
        words = ({"settings": _settings(row), "left_out": row.left_out} for row in self.rows)
        return [plain_row(row) | more for row, more in zip(self.rows, words, strict=True)]

    def plain(self) -> dict[str, Any]:
        """Everything, for JSON."""
        plain: dict[str, Any] = msgspec.to_builtins(self)
        return plain


COLUMNS = (
    Column("method", left=True),
    Column("at", left=True),
    Column("error %", "bare percent"),
    Column("order", ".2f"),
    Column("run", "duration"),
    Column("spread", "duration", wide=True),
    Column("set-up", "duration"),
    Column("first call", "duration", wide=True),
)

PUSHED = (
    Column("engine", left=True),
    Column("N"),
    Column("by", left=True),
    Column("what it did", left=True),
    Column("good steps"),
    Column("took", "duration"),
)


def _case_table(rows: tuple[Row, ...]) -> Table:
    first = rows[0]
    references = dict.fromkeys(
        f"against {row.reference}: known to {100 * (row.reference_uncertainty or 0.0):.1g} %"
        for row in rows
        if row.reference
    )
    engines = [text for text in references if "its own run" in text]
    notes = [text for text in references if text not in engines] + engines[:2]
    notes += [f"{row.method}, {_at(row)}: {row.left_out}" for row in rows if row.left_out]
    return Table(
        title=f"{first.set}, {first.about}" if first.about else first.set,
        columns=COLUMNS,
        rows=tuple(
            (row.method, _at(row), row.error or None, row.order, row.warm_s, row.spread_s, row.set_up_s, row.first_s)
            for row in rows
        ),
        notes=tuple(notes),
        folded=True,
    )


def _at(row: Row) -> str:
    """'N = 49', '1.2e-05 s', 'tolerance 1e-05'."""
    if "step" in row.settings:
        return f"step {1e6 * float(row.settings['step']):.3g} µs"
    if "tolerance" in row.settings:
        return f"tolerance {row.settings['tolerance']:g}"
    return "–" if row.count is None else f"N = {row.count}"


def _settings(row: Row) -> str:
    return " ".join(f"{name}={value}" for name, value in row.settings.items())
