"""A run in the terminal: verdict, gates, results of studies, gates that were skipped."""

from typing import TYPE_CHECKING

from verify.report.result import Column, Table, print_verdict
from verify.report.summary import VERDICTS, expected, gates_sentence, study_title, value_text

if TYPE_CHECKING:
    from rich.console import Console

    from verify.report.archive import Saved
    from verify.scene.run import RunResult

LONG = 30
"""Rows of a table beyond which its title stands for it."""


def print_run(run: "RunResult", console: "Console", saved: "Saved | None" = None) -> None:
    """Print a run: its verdict first, and at the end again with the gates, where a terminal stops."""
    console.print(run.scene.title or run.scene.name, style="bold")
    gates, skipped = gates_in_short(run), [one for one in run.gates if one.passed is None]
    if run.results or gates.rows:
        print_verdict(run.verdict, console, brief=True)
    for name, result in run.results.items():
        console.print()
        console.print(study_title(run, name), style="bold")
        result.print(console, LONG)
    if gates.rows:
        console.print()
        gates.print(console)
    console.print()
    for reason in dict.fromkeys(one.reason for one in skipped):
        names = ", ".join(one.gate.id for one in skipped if one.reason == reason)
        console.print(f"skipped {names}: {reason}", style="dim")
    for warning in run.warnings:
        console.print(f"warning: {warning}", style="yellow")
    for one in run.failed:
        console.print(f"FAIL {one.gate.id}: {one.reason}", style="red")
    print_verdict(run.verdict, console, f" ({run.seconds:.3g} s)")
    console.print(gates_sentence(run))
    if saved is not None:
        console.print(f"report: {saved.page}", soft_wrap=True)


def gates_in_short(run: "RunResult") -> Table:
    """The gates that ran in five columns that fit 80 characters; the page has them in full."""
    rows = []
    for one in (gate for gate in run.gates if gate.passed is not None):
        unit = "" if one.unit == "1" or one.value is None else f" {one.unit}"
        measured = (value_text(one.value) + unit).rstrip()
        rows.append((VERDICTS[one.passed], one.gate.id, measured, expected(one.gate), one.fraction))
    names = ("verdict", "gate", "measured", "expected")
    return Table("Gates", [*map(Column, names), Column("of tolerance", format=".3g", percent=True)], rows)
