"""The one type that studies, benchmarks, comparisons and stress checks return, and its forms as text and data.

A `Result` holds what was computed as plain values: a summary, tables, figures, warnings, data. Everything that shows it
(terminal, HTML page, CSV, Markdown, JSON, LaTeX) reads it through this module.
"""

import csv
import io
import json
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from math import isfinite
from typing import TYPE_CHECKING, Any, Literal

from verify.analysis.verdict import COLOURS, Margin, Verdict, verdict_of
from verify.formatting import Unit, unit_over

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from rich.console import Console

MISSING = "–"


@dataclass(frozen=True)
class Column:
    """A column of a table. Values are stored in SI units, relative errors as ratios."""

    name: str
    unit: str = ""
    """SI unit of the stored values."""
    format: str = ".5g"
    percent: bool = False
    """Show ratios in per cent."""
    prefix: bool = False
    """Show values with the SI prefix that suits the largest of the column (m -> mm)."""


@dataclass(frozen=True)
class Table:
    """Rows under columns; None is a value that does not exist."""

    title: str
    columns: Sequence[Column]
    rows: Sequence[Sequence[Any]]
    notes: Sequence[str] = ()
    """Fixed sentences below it."""

    def records(self) -> list[dict[str, Any]]:
        """The rows as data, in SI units, keyed by column name."""
        names = [column.name for column in self.columns]
        return [dict(zip(names, map(plain, row), strict=True)) for row in self.rows]

    def headings(self) -> list[str]:
        """Column names with the unit in which `text_rows` shows the values."""
        return [f"{c.name}, {u.name}" if u.name else c.name for c, u in zip(self.columns, self._units(), strict=True)]

    def text_rows(self) -> list[list[str]]:
        """The rows as text, every cell formatted as its column says."""
        factors = [unit.factor for unit in self._units()]
        return [[_cell(*cell) for cell in zip(row, self.columns, factors, strict=True)] for row in self.rows]

    def _units(self) -> Iterator[Unit]:
        """The unit in which each column is shown."""
        for i, column in enumerate(self.columns):
            numbers = (float(row[i]) for row in self.rows if isinstance(row[i], int | float))
            scaled = unit_over(numbers, column.unit) if column.prefix and column.unit else Unit(column.unit, 1.0)
            yield Unit("%", 100.0) if column.percent else scaled

    def layout(self) -> tuple[list[str], list[list[str]], list[bool], list[int]]:
        """(headings, rows as text, whether a column has words, its width in characters)."""
        texts, n = self.text_rows(), range(len(self.columns))
        words = [any(isinstance(row[i], str) for row in self.rows) for i in n]
        return self.headings(), texts, words, [max((len(row[i]) for row in texts), default=0) for i in n]

    def csv(self) -> str:
        """Comma-separated values in SI units with all digits."""
        out = io.StringIO()
        writer = csv.writer(out, lineterminator="\n")
        writer.writerow([f"{c.name}, {c.unit}" if c.unit else c.name for c in self.columns])
        writer.writerows([["" if v is None else plain(v) for v in row] for row in self.rows])
        return out.getvalue()

    def markdown(self) -> str:
        """A Markdown table as a person reads it."""
        lines = [self.headings(), ["---:"] * len(self.columns), *self.text_rows()]
        return "".join("| " + " | ".join(cell.replace("|", "\\|") for cell in line) + " |\n" for line in lines)

    def print(self, console: "Console") -> None:
        """Print it with rich. Text wraps; numbers do not: where they are too wide the columns go in several blocks."""
        from rich.table import Table as RichTable

        (headings, rows, words, widths), n = self.layout(), range(len(self.columns))
        least = [max(min(widths[i], 18) if words[i] else widths[i], *map(len, headings[i].split())) + 2 for i in n]
        keys = [0]  # leading columns that name a row stand in every block
        while (i := len(keys)) < len(n) and 2 * sum(least[: i + 1]) < console.width:
            if any(isinstance(row[i], float) for row in self.rows):
                break
            keys.append(i)
        blocks = [list(keys)]
        for i in n[len(keys) :]:
            if sum(least[j] for j in blocks[-1]) + least[i] > console.width + 2 and len(blocks[-1]) > len(keys):
                blocks.append(list(keys))
            blocks[-1].append(i)
        for block in blocks:
            grid = RichTable(title=self.title or None, title_justify="left", box=None, pad_edge=False)
            tight = sum(max(len(headings[i]), widths[i]) + 2 for i in block) > console.width + 2
            for i in block:
                side: Literal["left", "right"] = "left" if words[i] else "right"
                width = least[i] - 2 if tight and not words[i] else None  # rich shrinks numbers before text
                grid.add_column(headings[i], justify=side, width=width, overflow="fold")
            for row in rows:
                grid.add_row(*(row[i] for i in block))
            console.print(grid)
        for note in self.notes:
            console.print(note)


@dataclass(frozen=True)
class Figure:
    """A chart, drawn by matplotlib when a page or a file asks for it (see `report.plotting`)."""

    id: str
    title: str
    caption: str
    """What is shown, under which condition: a fixed text."""
    draw: Callable[["Axes"], None]
    """Draws on the axes of a single chart, labels with units included."""
    size: tuple[float, float] = (5.4, 3.5)
    """Inches."""


@dataclass(frozen=True)
class Movie:
    """An animation, rendered when a page or a file asks for it."""

    id: str
    title: str
    caption: str
    animate: Callable[["Axes"], tuple[Callable[[int], Sequence[Any]], Iterable[int]]]
    """Draws on axes; returns (function of a frame that moves artists and returns them, frames)."""


@dataclass(frozen=True, eq=False)
class Result:
    """Everything that one study, benchmark, comparison or stress run computed."""

    summary: str = ""
    """One sentence with the condition under which it holds; empty where nothing converged."""
    tables: Sequence[Table] = ()
    """The first is the one that CSV and Markdown show."""
    figures: Sequence[Figure] = ()
    movies: Sequence[Movie] = ()
    warnings: Sequence[str] = ()
    """Fixed sentences on what is not converged, left out, or outside its range of validity."""
    data: Mapping[str, Any] = field(default_factory=dict)
    """More values for JSON, in SI units."""
    margins: Sequence[Margin] = ()
    """Sizes of what it leaves out; without any it has no verdict."""

    @property
    def verdict(self) -> Verdict | None:
        """How far it can be trusted, by its margins."""
        return verdict_of(self.margins) if self.margins else None

    def __repr__(self) -> str:
        """The verdict, or the summary, and what else there is."""
        sentence = self.verdict.headline if self.verdict else self.summary
        return f"<Result: {sentence} Tables: {', '.join(table.title for table in self.tables) or 'none'}>"

    def to_dict(self) -> dict[str, Any]:
        """For JSON: verdict, summary, warnings, tables as records, and the data."""
        tables = [{"title": table.title, "rows": table.records()} for table in self.tables]
        data: dict[str, Any] = plain(self.data)
        verdict = {"verdict": self.verdict.to_dict()} if self.verdict else {}
        return verdict | {"summary": self.summary, "warnings": list(self.warnings), "tables": tables} | data

    def print(self, console: "Console", most_rows: int | None = None) -> None:
        """Print verdict, summary, tables, warnings; with `most_rows`, in a run, headline and short tables alone."""
        if self.verdict:
            print_verdict(self.verdict, console, brief=most_rows is not None)
        if self.summary:
            console.print(self.summary)
        for table in self.tables:
            if most_rows is not None and len(table.rows) > most_rows:
                console.print(f"{table.title}: {len(table.rows)} rows, see the report or --json", style="dim")
            else:
                table.print(console)
        for warning in self.warnings:
            console.print(f"warning: {warning}", style="yellow")


def print_verdict(verdict: Verdict, console: "Console", after: str = "", *, brief: bool = False) -> None:
    """Print the headline in its colour, and, unless `brief`, the further margins that are not trusted."""
    console.print(verdict.headline + after, style=f"bold {COLOURS[verdict.level]}")
    if verdict.others and not brief:
        console.print(verdict.others)


def to_json(value: Any) -> str:
    """JSON with an indent of two, numpy's types as Python's, what is not finite as null."""
    return json.dumps(plain(value), indent=2, ensure_ascii=False, allow_nan=False) + "\n"


def plain(value: Any) -> Any:
    """Numpy's numbers and arrays, tuples, complex numbers and dataclass-like values as what JSON takes."""
    if isinstance(value, Mapping):
        return {str(key): plain(one) for key, one in value.items()}
    if hasattr(value, "__struct_fields__"):
        return {name: plain(getattr(value, name)) for name in value.__struct_fields__}
    if hasattr(value, "tolist"):
        return plain(value.tolist())
    if isinstance(value, list | tuple):
        return [plain(one) for one in value]
    if isinstance(value, complex):
        return {"re": plain(value.real), "im": plain(value.imag)}
    return None if isinstance(value, float) and not isfinite(value) else value


def _cell(value: Any, column: Column, factor: float) -> str:
    if value is None:
        return MISSING
    if isinstance(value, bool):
        return "yes" if value else "no"
    if isinstance(value, str):
        return value
    if isinstance(value, int) and factor == 1.0 and column.format == ".5g":
        return str(value)
    text = format(factor * value, column.format)
    if text.endswith("inf"):
        return f"{text}inite"  # the ratio of two waves, one of which is zero by symmetry
    large = "e+0" in text and abs(float(text)) < 1e6  # '30' for '3e+01'
    return f"{float(text):{'+' * text.startswith('+')}.0f}" if large else text
