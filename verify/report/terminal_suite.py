"""Several runs in the terminal: one line for each scene, and what changed between two."""

from pathlib import Path
from typing import TYPE_CHECKING

from rich.box import SIMPLE_HEAD
from rich.table import Table
from rich.text import Text

from verify.report.terminal import Hyphenated, Terminal
from verify.words import seconds_in_words

if TYPE_CHECKING:
    from collections.abc import Container, Iterable

    from verify.report.diff import Differences
    from verify.report.suite import Card, Refused, Suite


def print_suite(suite: "Suite", page: Path | None) -> None:
    """Every scene with its verdict and its answer, what failed, the verdict over all, where the page lies."""
    console = Terminal()
    table = Table(box=SIMPLE_HEAD, pad_edge=False, padding=(0, 1, 0, 0))
    table.add_column("", no_wrap=True)
    table.add_column("scene")
    for head in ("gates", "time"):
        table.add_column(head, justify="right", no_wrap=True)
    table.add_column("answer", overflow="fold")
    for one in suite.scenes:
        table.add_row(*_row(one))
    console.print(table)
    for card in suite.cards:
        for gate in card.failed:
            console.print(Text(f"{card.name}: gate {gate.gate}: {gate.reason}", style="red"))
    console.print(Text(suite.verdict, style="bold green" if suite.passed else "bold red"))
    if page is not None:
        console.print(f"report: {page}", soft_wrap=True, markup=False)


def _row(one: "Card | Refused") -> "tuple[Text | Hyphenated | str, ...]":
    from verify.report.suite import Refused

    if isinstance(one, Refused):
        return Text("none", style="bold red"), Hyphenated(one.name), "–", "–", Text("could not run", style="red")
    mark = Text("pass", style="green") if one.passed else Text("FAIL", style="bold red")
    held = one.judged - len(one.failed)
    gates = str(held) if one.passed else f"{held} of {one.judged}"
    return mark, Hyphenated(one.name), gates, seconds_in_words(one.seconds), Text(one.answer)


def print_differences(found: "Differences", page: Path | None) -> None:
    """Scene by scene what changed, the verdict, where the page lies."""
    console = Terminal()
    for one in found.scenes:
        console.print(Text.assemble((one.name, "bold"), f": {one.verdict}"))
        if one.gates:
            heads = ("gate", "verdict", "measured", "expected", "of band")
            rows = ((gate.id, gate.verdict, gate.measured, gate.expected, gate.share) for gate in one.gates)
            failed = {i for i, gate in enumerate(one.gates) if gate.fails_now}
            console.print(_table(heads, rows, failed))
        for title, changes in (("answers and facts", one.said), ("versions", one.versions), ("inputs", one.inputs)):
            if changes:
                told = ((change.what, change.before or "–", change.after or "–") for change in changes)
                console.print(_table((title, "before", "after"), told))
    for words, names in (("no longer there", found.only_before), ("new", found.only_after)):
        if names:
            console.print(Text(f"{words}: {', '.join(names)}"))
    console.print(Text(found.verdict, style="bold red" if found.broken else "bold green"))
    if page is not None:
        console.print(f"report: {page}", soft_wrap=True, markup=False)


def _table(heads: tuple[str, ...], rows: "Iterable[tuple[str, ...]]", failed: "Container[int]" = ()) -> Table:
    """Rows under heads; those whose numbers are `failed` stand out."""
    table = Table(box=SIMPLE_HEAD, pad_edge=False, padding=(0, 1, 0, 0))
    for head in heads:
        table.add_column(head, overflow="fold")
    for i, (name, *cells) in enumerate(rows):
        style = "bold red" if i in failed else ""
        table.add_row(Hyphenated(name), *(Text(cell, style=style) for cell in cells))
    return table
