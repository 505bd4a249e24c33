"""A run in the terminal: verdict, gates, results of studies, gates that were skipped."""

from typing import TYPE_CHECKING

from verify.analysis.verdict import COLOURS
from verify.report.result import Column, Table
from verify.report.summary import VERDICTS, expected, study_title, value_text, worst_gate

if TYPE_CHECKING:
    from rich.console import Console

    from verify.report.archive import Saved
    from verify.scene.run import RunResult

LONG = 30
"""Rows of a table beyond which its title stands for it."""


def print_run(run: "RunResult", console: "Console", saved: "Saved | None" = None) -> None:
    """Print a run: its verdict first, and at the end again with the gates, where a terminal stops."""
    scene, found = run.scene, run.verdict
    style = f"bold {COLOURS[found.level]}"
    console.print(scene.title or scene.name, style="bold")
    console.print(found.headline, style=style)
    for name, result in run.results.items():
        console.print()
        console.print(study_title(run, name), style="bold")
        result.print(console, LONG)
    if run.gates:
        console.print()
        gates_in_short(run).print(console)
    console.print()
    for one in (gate for gate in run.gates if gate.passed is None):
        console.print(f"skipped {one.gate.id}: {one.reason}", style="dim")
    for warning in run.warnings:
        console.print(f"warning: {warning}", style="yellow")
    for one in run.failed:
        console.print(f"FAIL {one.gate.id}: {one.reason}", style="red")
    console.print(f"{found.headline} ({run.seconds:.3g} s)", style=style)
    for text in found.others:
        console.print(f"also: {text}")
    gates, worst = run.gates_in_words, worst_gate(run)
    if worst is not None and run.passed:
        gates += f", the worst is {worst.gate.id} with {100 * (worst.fraction or 0.0):.3g} % of its tolerance"
    console.print(f"{gates[:1].upper()}{gates[1:]}.")
    if saved is not None:
        console.print(f"report: {saved.page}", soft_wrap=True)


def gates_in_short(run: "RunResult") -> Table:
    """The gates in five columns that fit 80 characters; the page has them in full."""
    rows = []
    for one in run.gates:
        unit = "" if one.unit == "1" or one.value is None else f" {one.unit}"
        measured = (value_text(one.value) + unit).rstrip()
        rows.append((VERDICTS[one.passed], one.gate.id, measured, expected(one.gate), one.fraction))
    names = ("verdict", "gate", "measured", "expected")
    return Table("Gates", [*map(Column, names), Column("of tolerance", format=".3g", percent=True)], rows)
