"""Run time over error: methods at several sizes against one reference, timed in interleaved rounds.

Times are processor seconds of one thread, medians over the rounds, from the beam to the result.
"""

import platform
from collections.abc import Callable, Sequence
from dataclasses import asdict, dataclass
from itertools import pairwise
from math import exp, isfinite, log
from pathlib import Path
from statistics import median, quantiles
from time import process_time
from typing import TYPE_CHECKING, Any

from verify.errors import InputError
from verify.report.result import Column, Figure, Result, Table
from verify.report.summary import environment
from verify.timing import forget

if TYPE_CHECKING:
    from matplotlib.axes import Axes

ROUNDS, TURN_S = 9, 2e-3  # largest number of rounds; time for which short runs are repeated within a round, s
ERRORS = (1e-2, 1e-3, 1e-4, 1e-5)  # errors at which methods are compared
ABOVE_REFERENCE = 3.0
"""Multiple of the reference's uncertainty below which errors have no order and are excluded from comparisons."""


@dataclass(frozen=True)
class Method:
    """A method and its sizes."""

    name: str
    run: Callable[[Any], Any]  # size -> result
    sizes: Sequence[Any]  # from coarse to fine
    size_name: str = "N"  # name of the size: N, dt, tolerance; empty without refinement
    model: str = ""  # name of the model, which defines the colour
    error: Callable[[Any], float] | None = None  # relative error of a result; default: that of the question
    again: bool = False  # whether the time is that of a second run, which has the cached solutions of the first


@dataclass(frozen=True)
class Question:
    """A quantity of interest, its methods and the reference of their errors."""

    id: str
    title: str  # quantity and conditions
    reference: str
    uncertainty: float  # relative uncertainty of the reference
    error: Callable[[Any], float]  # relative error of a result
    methods: Sequence[Method]


@dataclass(frozen=True)
class Row:
    """Error and time of one method at one size."""

    method: str
    size_name: str
    size: float
    error: float
    order: float | None  # observed order from the coarser size
    seconds: float
    spread: float  # relative interquartile range of the rounds
    model: str = ""


def measure(question: Question, limit: float = 5.0) -> list[Row]:
    """Rows of all methods.

    A method whose runs have taken `limit` seconds is not refined further; rounds end after the same time, and a run
    that takes longer has one. Sizes at which a method raises InputError have no row.
    """
    jobs: list[tuple[Method, Any, float, int]] = []
    times = list[list[float]]()
    for method in question.methods:
        spent = 0.0
        for size in method.sizes:
            try:
                error = (method.error or question.error)(method.run(size))  # the first run compiles and imports
            except InputError:
                continue
            seconds = _timed(method, size, 1)
            jobs.append((method, size, abs(error), min(max(round(TURN_S / max(seconds, 1e-9)), 1), 20)))
            times.append([seconds])
            spent += seconds
            if spent > limit:
                break
    start = process_time()
    for turn in range(1, ROUNDS):
        if turn >= 3 and process_time() - start > limit:
            break
        for (method, size, _, repeats), own in zip(jobs, times, strict=True):
            if own[0] <= limit:
                own.append(_timed(method, size, repeats))
    rows, floor = list[Row](), ABOVE_REFERENCE * question.uncertainty
    for (m, size, error, _), own in zip(jobs, times, strict=True):
        order, before = None, rows[-1] if rows else None
        if before and before.method == m.name and min(error, before.error) > floor and before.size != size:
            order = log(before.error / error) / abs(log(before.size / size))
        low, _, high = quantiles(own if own[1:] else own * 2, n=4, method="inclusive")
        spread = (high - low) / median(own)
        rows.append(Row(m.name, m.size_name, float(size), error, order, median(own), spread, m.model))
    return rows


def _timed(method: Method, size: Any, repeats: int) -> float:
    """Mean processor time of a run without cached results, or `again` with them, s."""
    total = 0.0
    for _ in range(repeats):
        forget()
        if method.again:
            method.run(size)
        start = process_time()
        method.run(size)
        total += process_time() - start
    return total / repeats


def time_at(rows: Sequence[Row], error: float) -> float | None:
    """Time of a method for an error, s, by interpolation of log time over log error.

    Interpolates at the first size from which on all errors are within it; the coarsest size if all are; else None.
    """
    if not rows or not rows[-1].error <= error:
        return None
    for coarse, fine in reversed(list(pairwise(rows))):
        if coarse.error > error:
            part = log(coarse.error / error) / log(coarse.error / max(fine.error, 1e-17))
            return exp(log(coarse.seconds) + part * log(fine.seconds / coarse.seconds))
    return rows[0].seconds


def by_method(rows: Sequence[Row]) -> dict[str, list[Row]]:
    """Rows by method, from coarse to fine."""
    return {name: [row for row in rows if row.method == name] for name in dict.fromkeys(row.method for row in rows)}


def ratios(question: Question, rows: Sequence[Row]) -> dict[str, list[float | None]]:
    """Time of each method over that of the first method at each of `ERRORS`."""
    lines = by_method(rows)
    first = next(iter(lines.values()), [])
    floor = ABOVE_REFERENCE * question.uncertainty

    def ratio(line: Sequence[Row], error: float) -> float | None:
        times = time_at(line, error), time_at(first, error)
        return times[0] / times[1] if error > floor and times[0] and times[1] else None

    return {name: [ratio(line, error) for error in ERRORS] for name, line in lines.items()}


def ratio_cells(method: str, values: Sequence[float | None], rows: Sequence[Row], form: str) -> list[str | None]:
    """Ratios of a method at `ERRORS` as text, starred where it or the first method is within at its coarsest size."""
    lines = [of for name, of in by_method(rows).items() if name in (method, rows[0].method) and of[0].size_name]
    least = min((max(row.error for row in line) for line in lines), default=1.0)
    stars = ["*" * (method != rows[0].method and least <= error) for error in ERRORS]
    return [None if value is None else f"{value:{form}}{star}" for value, star in zip(values, stars, strict=True)]


COLUMNS = [Column("set"), Column("method"), Column("size"), Column("error", format=".2g")]
COLUMNS += [Column("order", format=".2f"), Column("time", "s", format=".3g", prefix=True)]
COLUMNS += [Column("spread", percent=True, format=".0f")]
REFERENCE_COLUMNS = [*map(Column, ("set", "quantity", "reference")), Column("uncertainty", format=".1g")]
RATIO_COLUMNS = (Column("set"), Column("method"), *(Column(f"at {error:g}", format=".3g") for error in ERRORS))
STAR_NOTE = "* This method or the first one is within the error at its coarsest size already, whose time it has here."
RATIO_NOTES = ["Time over that of the first method of the set at equal error, by logarithmic interpolation.", STAR_NOTE]


def result(measured: Sequence[tuple[Question, Sequence[Row]]]) -> Result:
    """Tables, a log-log chart for each question, and data."""
    sized = [(q, row, row.size_name and f"{row.size_name} = {row.size:.3g}") for q, own in measured for row in own]
    rows = [(q.id, row.method, size, row.error, row.order, row.seconds, row.spread) for q, row, size in sized]
    compared = {q.id: ratios(q, rows_of) for q, rows_of in measured}
    times = [(q.id, m, *ratio_cells(m, own, of, ".3g")) for q, of in measured for m, own in compared[q.id].items()]
    references = [(q.id, q.title, q.reference, q.uncertainty) for q, _ in measured]
    tables = [Table("Time over error", COLUMNS, rows), Table("Time ratio", RATIO_COLUMNS, times, RATIO_NOTES)]
    tables.append(Table("References", REFERENCE_COLUMNS, references))
    data = {
        "machine": {"processor": processor(), **environment()},
        "questions": [
            {"id": q.id, "title": q.title, "reference": q.reference, "uncertainty": q.uncertainty}
            | {"rows": [asdict(row) for row in rows_of], "ratios": compared[q.id]}
            for q, rows_of in measured
        ],
    }
    figures = [_figure(q, rows_of) for q, rows_of in measured]
    return Result(tables=tables, figures=figures, data=data)


def _figure(question: Question, rows: Sequence[Row]) -> Figure:
    def draw(ax: "Axes") -> None:
        from verify.report.plotting import MODEL_COLORS

        used: set[str] = set()
        for name, line in by_method(rows).items():
            color = MODEL_COLORS.get(line[0].model) if line[0].model not in used else None
            used.add(line[0].model)
            points = [(row.seconds, row.error) for row in line if isfinite(row.error) and row.error > 0.0]
            ax.loglog([x for x, _ in points], [y for _, y in points], "o-", label=name, color=color)
        ax.set(xlabel="processor time, s", ylabel="relative error")
        ax.legend()

    caption = "Relative error over processor seconds, every mark one size; medians of interleaved rounds."
    return Figure(f"bench-{question.id}", question.title, caption, draw)


def processor() -> str:
    """Name of the processor."""
    lines = info.read_text("utf-8").splitlines() if (info := Path("/proc/cpuinfo")).exists() else []
    return next((line.partition(":")[2].strip() for line in lines if "model name" in line), platform.processor())
