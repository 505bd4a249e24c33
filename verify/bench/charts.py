"""Charts of a bench: for each set run time over error, a line for each method, time falling to the right."""

from itertools import groupby
from typing import TYPE_CHECKING, Any

from verify.models.catalogue import MODELS
from verify.models.naming import MEAN
from verify.studies.chart import Axis, Chart, Line
from verify.studies.charting import DASHES, MEAN_COLOUR, SYMBOLS, key, line, other_line

if TYPE_CHECKING:
    from verify.bench.found import BenchFound
    from verify.bench.rows import Row

TITLES = {
    "modes": "Natural frequencies",
    "harmonic": "The steady field",
    "transient": "The linear beam in time",
    "slider": "The slider's displacement",
    "chain": "The nonlinear chain in time",
}


def bench_charts(found: "BenchFound") -> tuple[Chart, ...]:
    """One for each set that has a figure."""
    groups = ((name, list(rows)) for name, rows in groupby(found.rows, key=lambda row: row.set))
    return tuple(_chart(name, rows, found) for name, rows in groups if any(row.error for row in rows))


def _chart(name: str, rows: "list[Row]", found: "BenchFound") -> Chart:
    methods, abouts = list(dict.fromkeys(r.method for r in rows)), list(dict.fromkeys(r.about for r in rows))
    lines: list[Line] = []
    for about in abouts:
        for method in methods:
            own = [row for row in rows if (row.about, row.method) == (about, method) and _drawable(row)]
            if own:
                lines.append(_drawn(own, methods.index(method), abouts.index(about), named=not _named(lines, method)))
    several = len(abouts) > 1
    keys = [key(about, **_style(i)) for i, about in enumerate(abouts)] if several else []
    return Chart(
        id=f"bench-{name}",
        title=f"{TITLES[name]}: run time against error",
        caption="Set-up and run together, medians of interleaved rounds of "
        f"{found.date} on {found.machine['processor']}. Errors fall to the right, lower is faster; point at one "
        "for its size, step or tolerance.",
        x=Axis("size of the error, %", log=True, backwards=True),
        y=Axis("run time, ms", log=True),
        lines=(*lines, *keys),
    )


def _drawable(row: "Row") -> bool:
    """Whether it has an error that is its own, and no more of what its reference leaves open, and a time."""
    return abs(row.error or 0.0) > (row.reference_uncertainty or 0.0) and bool(row.whole_s)


def _named(lines: list[Line], method: str) -> bool:
    return any(one.group == method for one in lines)


def _style(i: int) -> dict[str, Any]:
    return {"dash": DASHES[i % len(DASHES)], "marker": SYMBOLS[i % len(SYMBOLS)]}


def _drawn(rows: "list[Row]", i: int, about: int, *, named: bool) -> Line:
    first = rows[0]
    by_error = sorted(rows, key=lambda row: -abs(row.error or 0.0))
    x = [100.0 * abs(row.error or 0.0) for row in by_error]
    y = [1e3 * (row.whole_s or 0.0) for row in by_error]
    said = tuple(_told(row) for row in by_error)
    style: dict[str, Any] = {"said": said, "keyed": named, "group": first.method} | _style(about)
    colour = _colour(first)
    return line(first.method, colour, x, y, **style) if colour else other_line(i, first.method, x, y, **style)


def _colour(row: "Row") -> str:
    """Of a mean and of a model as it is; none of a method that has none of its own."""
    if row.model == MEAN:
        return MEAN_COLOUR
    plain = not row.settings and row.model in MODELS
    return MODELS[row.model].colour if plain else ""


def _told(row: "Row") -> str:
    """What stands at a point: its size, step or tolerance, and its case."""
    at = next((f"{name} {value:.3g}" for name, value in row.settings.items() if name in ("step", "tolerance")), "")
    return ", ".join(word for word in (row.about, at or (f"N = {row.count}" if row.count else "")) if word)
