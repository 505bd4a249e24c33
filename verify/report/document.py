"""What a report says, as plain values: kept beside the page as JSON, and rendered again from there."""

import os
import platform
import sys
from collections import Counter
from collections.abc import Iterator
from datetime import UTC, datetime
from importlib import metadata
from typing import TYPE_CHECKING, Any

import msgspec

from verify.report.answer import answers_of
from verify.report.problem import Problem, problem_of
from verify.run.gates import GateResult
from verify.studies.catalogue import STUDIES
from verify.studies.chart import Chart
from verify.words import cell, told_once, work_in_words

if TYPE_CHECKING:
    from verify.run.runner import RunResult
    from verify.studies.told import Column, Table

SENTENCE = 32
"""Characters from which on words in a cell may be broken into lines."""
_PACKAGES = ("fem-segment-verify", "numpy", "scipy", "scikit-fem", "matplotlib")


class Cell(msgspec.Struct, frozen=True):
    """A cell of a table, written out."""

    side: str
    """How it stands: n, long, word, pass, fail, soft or nothing."""
    text: str


class PageTable(msgspec.Struct, frozen=True, kw_only=True):
    """A table with its figures written out."""

    title: str
    before: str
    heads: tuple[Cell, ...]
    rows: tuple[tuple[Cell, ...], ...]
    notes: tuple[str, ...]
    folded: bool


class Section(msgspec.Struct, frozen=True):
    """What one study tells on the page, beside its charts."""

    name: str
    title: str
    facts: tuple[str, ...]
    tables: tuple[PageTable, ...]
    notes: tuple[str, ...]
    """What stands below several of its tables, once."""


class Skipped(msgspec.Struct, frozen=True):
    """Something that was not done."""

    what: str
    why: str


class Document(msgspec.Struct, frozen=True, kw_only=True):
    """A whole report."""

    name: str
    title: str
    description: str
    date: str
    """Day and time, universal."""
    passed: bool
    seconds: float
    work: str
    """What was solved, in words."""
    command: str
    """The line that does it again."""
    environment: dict[str, str]
    problem: Problem
    answers: tuple[str, ...]
    charts: tuple[Chart, ...]
    sections: tuple[Section, ...]
    gates: tuple[GateResult, ...]
    skipped: tuple[Skipped, ...]


def document_of(result: "RunResult", command: str, work: str = "") -> Document:
    """What the report of a run says; `work` is what was solved, where the result does not say it."""
    from verify.run.plan import skipped_by

    scene = result.scene
    return Document(
        name=scene.name,
        title=scene.title,
        description=scene.description,
        date=datetime.now(UTC).strftime("%Y-%m-%d %H:%M UTC"),
        passed=result.passed,
        seconds=result.seconds,
        work=work or work_in_words(len(result.solves), result.n_fields, result.n_motions, result.others),
        command=command,
        environment=environment(),
        problem=problem_of(scene),
        answers=answers_of(result),
        charts=tuple(chart for found in result.found.values() for chart in found.charts()),
        sections=tuple(_source_first(result)),
        gates=result.gates,
        skipped=tuple(Skipped(one.what, one.why) for one in skipped_by(scene)),
    )


def _source_first(result: "RunResult") -> Iterator[Section]:
    """What a source says and what is found of it, then all other tables."""
    sections = list(sections_of(result))
    of_source = {name for name in result.found if name in STUDIES and STUDIES[name].of_source}
    yield from (one for one in sections if one.name in of_source)
    yield from (one for one in sections if one.name not in of_source)


def sections_of(result: "RunResult") -> Iterator[Section]:
    """Every study that has words or tables for the page."""
    for name, found in result.found.items():
        shown = [table for table in found.tables() if table.shown != "terminal"]
        counted = Counter(note for table in shown for note in table.notes)
        shared = tuple(told_once(note for note, times in counted.items() if times > 1))
        tables = tuple(_on_page(table, shared) for table in shown)
        facts = tuple(fact[:1].upper() + fact[1:] for fact in found.facts())
        if facts or tables:
            title = STUDIES[name].title if name in STUDIES else ""
            yield Section(name, title or name.capitalize(), facts, tables, shared)


def _verdict(value: bool | None) -> str:
    """The colour of a verdict."""
    return "soft" if value is None else "pass" if value else "fail"


def _side(i: int, column: "Column", rows: tuple[tuple[Any, ...], ...]) -> str:
    """Numbers stand right; words left, with room where they are sentences."""
    if not column.left:
        return "n"
    longest = max((len(row[i]) for row in rows if isinstance(row[i], str)), default=0)
    return "long" if longest > SENTENCE else "word" if longest < SENTENCE // 2 else ""


def _on_page(table: "Table", shared: tuple[str, ...]) -> PageTable:
    """A table with its figures written out: heads with their side, rows of cells, sentences before and after.

    Columns without any figure are left out.
    """
    kept = [i for i in range(len(table.columns)) if not table.rows or any(row[i] is not None for row in table.rows)]
    columns = [table.columns[i] for i in kept]
    sides = [_side(i, table.columns[i], table.rows) for i in kept]
    rows = tuple(
        tuple(
            Cell(
                _verdict(value) if column.form == "verdict" else side,
                cell(value, column.form, column.factor, column.unit),
            )
            for side, value, column in zip(sides, (row[i] for i in kept), columns, strict=True)
        )
        for row in table.rows
    )
    return PageTable(
        title=table.title,
        before=table.before,
        heads=tuple(Cell(side, column.head) for side, column in zip(sides, columns, strict=True)),
        rows=rows,
        notes=tuple(told_once(note for note in table.below(kept) if note not in shared)),
        folded=table.folded,
    )


def environment() -> dict[str, str]:
    """What the figures were made with: versions, those of packages that bring models too, platform, processors."""
    versions = {name: metadata.version(name) for name in _PACKAGES}
    groups = ("verify.models", "verify.quantities", "verify.studies")
    points = (point for group in groups for point in metadata.entry_points(group=group))
    versions |= {point.dist.name: point.dist.version for point in points if point.dist}
    return {
        "Python": platform.python_version(),
        **versions,
        "platform": f"{platform.system()} {platform.machine()}",
        "processors": str(len(os.sched_getaffinity(0)) if sys.platform == "linux" else os.cpu_count()),
    }
