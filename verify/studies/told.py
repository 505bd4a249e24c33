"""How what a study finds is told: tables, charts, facts and an answer as plain values."""

from collections.abc import Callable, Iterable, Sequence
from typing import Any, Literal, TypeAlias

import msgspec
from msgspec.structs import replace

from verify.checks import plain
from verify.errors import InputError
from verify.studies.chart import Chart
from verify.units import unit_over

PERCENTS = ("percent", "size", "bare percent", "bare size")
"""Forms that write a relative figure in per cent."""


class Column(msgspec.Struct, frozen=True):
    """One column of a table."""

    head: str
    """What stands above it, with its unit."""
    form: str = ""
    """How a number is written: a format such as '+.4f', or 'percent', 'bare percent', 'duration', 'ratio', 'speed'."""
    factor: float = 1.0
    """By which it is multiplied before."""
    unit: str = ""
    """Behind each number."""
    left: bool = False
    """Words stand left, numbers right."""
    wide: bool = False
    """Left out where there is no room."""
    said: str = ""
    """Of what it is, a sentence for below a table that shows it."""
    si: str = ""
    """SI unit of what stands in it; `Table.of` takes the unit that suits, and its factor, from there."""
    data_head: str = ""
    """What stands above it in data, where its unit depends on nothing; its head unless given."""


Read: TypeAlias = tuple[Column, Callable[[Any], Any]]
"""A column, and what stands in it of the thing that a row is about."""


class Table(msgspec.Struct, frozen=True, kw_only=True):
    """Rows for a person; None is a figure that there is not."""

    title: str = ""
    before: str = ""
    """A sentence above it."""
    columns: tuple[Column, ...]
    rows: tuple[tuple[Any, ...], ...]
    notes: tuple[str, ...] = ()
    """Sentences below it."""
    shown: Literal["both", "page", "terminal"] = "page"
    """Where a run shows it; `verify table` shows it anyway."""
    folded: bool = False
    """On the page: behind its title until it is opened."""

    @classmethod
    def over(cls, things: Iterable[Any], columns: Sequence[Read], **told: Any) -> "Table":
        """A row for each thing, read off column by column; `told` is all else."""
        rows = tuple(tuple(read(one) for _, read in columns) for one in things)
        return cls.of([column for column, _ in columns], rows, **told)

    @classmethod
    def of(cls, columns: "Sequence[Column]", rows: tuple[tuple[Any, ...], ...], **told: Any) -> "Table":
        """With columns of one SI unit all in the unit that suits their largest figure; `told` is all else."""
        return cls(columns=_suited(columns, rows), rows=rows, **told)

    def below(self, shown: Iterable[int]) -> tuple[str, ...]:
        """Sentences below it where these columns are shown: what they are, then its notes."""
        said = " ".join(self.columns[i].said for i in shown if self.columns[i].said)
        return (said, *self.notes) if said else self.notes

    def records(self) -> list[dict[str, Any]]:
        """Its rows as data: in the unit that stands above them, an SI one where heads for a person have what suits.

        A head that stands twice is numbered.
        """
        names = numbered([column.data_head or column.head for column in self.columns])
        return [dict(zip(names, map(_as_data, row, self.columns), strict=True)) for row in self.rows]

    def __post_init__(self) -> None:
        for row in self.rows:
            if len(row) != len(self.columns):
                raise InputError(f"a table has a row of {len(row)} cells under {len(self.columns)} columns: match them")


def _suited(columns: Sequence[Column], rows: Sequence[Sequence[Any]]) -> tuple[Column, ...]:
    units = {
        si: unit_over((row[i] for row in rows for i, one in enumerate(columns) if one.si == si), si)
        for si in {one.si for one in columns if one.si}
    }
    return tuple(
        replace(
            one,
            head=f"{one.head}, {units[one.si].name}",
            factor=units[one.si].factor,
            data_head=f"{one.head}, {one.si}",
        )
        if one.si
        else one
        for one in columns
    )


class Found(msgspec.Struct, frozen=True, eq=False, kw_only=True):
    """What a study found. It tells itself; terminal, page, CSV, Markdown and JSON show what it tells."""

    def tables(self) -> tuple[Table, ...]:
        """Tables for a person."""
        return ()

    def charts(self) -> tuple[Chart, ...]:
        """Charts for the page."""
        return ()

    def in_short(self) -> str:
        """The one sentence that a reader takes home, with its condition; empty where there is none."""
        return ""

    def facts(self) -> tuple[str, ...]:
        """Sentences, each with the condition under which it holds."""
        return ()

    def plain(self) -> Any:
        """For JSON."""
        return msgspec.to_builtins(self, enc_hook=as_number)

    def records(self) -> list[dict[str, Any]]:
        """Rows with one level of names, for CSV and Markdown: those of the first table unless a study knows better."""
        return next(iter(self.tables()), Table(columns=(), rows=())).records()

    def under(self, overrides: tuple[str, ...]) -> "Found":
        """The same, told as found in a run that `overrides` changed what exists for: 'beam.length=0.43'."""
        return self

    def motions(self) -> int:
        """How many simulations in time were done for it."""
        return 0


def as_number(value: Any) -> Any:
    """A number of numpy's, as a study from elsewhere may have, as Python's own. Raises NotImplementedError."""
    if (found := plain(value)) is value:
        raise NotImplementedError(f"{type(value).__name__} is no plain data")
    return found


def numbered(heads: list[str]) -> list[str]:
    """Names of which none stands twice: 'rms', 'rms 2'."""
    seen: dict[str, int] = {}
    names = []
    for head in heads:
        seen[head] = seen.get(head, 0) + 1
        names.append(head if seen[head] == 1 else f"{head} {seen[head]}")
    return names


def _as_data(value: Any, column: Column) -> Any:
    """A number in its column's unit, in the SI unit where that is what suits, with all digits; all else as it is."""
    value = plain(value)
    if not isinstance(value, float | int) or isinstance(value, bool):
        return value
    scale = 100.0 if column.form in PERCENTS else 1.0 if column.si else column.factor
    return value if scale == 1.0 else scale * value
