"""Charts of a bench: for each set run time over error, a line for each method, time falling to the right."""

from itertools import groupby
from typing import TYPE_CHECKING

from verify.models.catalogue import MODELS
from verify.models.naming import MEAN
from verify.studies.charting import DASHES, GREY, LOG, MEAN_COLOUR, PALETTE, SYMBOLS, Figure, axes, line
from verify.studies.told import Chart

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
    data: list[Figure] = []
    for about in abouts:
        for method in methods:
            own = [row for row in rows if (row.about, row.method) == (about, method) and row.error and row.whole_s]
            if own:
                data.append(_trace(own, methods.index(method), abouts.index(about), named=not _named(data, method)))
    several = len(abouts) > 1
    keys = [line(about, GREY, [None], [None], **_style(i)) for i, about in enumerate(abouts)] if several else []
    return Chart(
        id=f"bench-{name}",
        title=f"{TITLES[name]}: run time against error",
        caption="Set-up and run together, medians of interleaved rounds of "
        f"{found.date} on {found.machine['processor']}. Errors fall to the right, lower is faster; point at one "
        "for its size, step or tolerance.",
        data=[*data, *keys],
        layout=axes(
            "size of the error, %",
            "run time, ms",
            xaxis=LOG | {"autorange": "reversed"},
            yaxis=LOG | {"exponentformat": "none"},
        ),
    )


def _named(data: list[Figure], method: str) -> bool:
    return any(trace["legendgroup"] == method for trace in data)


def _style(i: int) -> Figure:
    return {"line": {"dash": DASHES[i % len(DASHES)]}, "marker": {"symbol": SYMBOLS[i % len(SYMBOLS)]}}


def _trace(rows: "list[Row]", i: int, about: int, *, named: bool) -> Figure:
    first = rows[0]
    by_error = sorted(rows, key=lambda row: -abs(row.error or 0.0))
    own = line(
        first.method,
        _colour(first, i),
        [100.0 * abs(row.error or 0.0) for row in by_error],
        [1e3 * (row.whole_s or 0.0) for row in by_error],
        **_style(about),
    )
    return own | {"text": [_told(row) for row in by_error], "showlegend": named, "legendgroup": first.method}


def _colour(row: "Row", i: int) -> str:
    if row.model == MEAN:
        return MEAN_COLOUR
    plain = not row.settings and row.model in MODELS
    return MODELS[row.model].colour if plain else PALETTE[i % len(PALETTE)]


def _told(row: "Row") -> str:
    """What stands at a point: its size, step or tolerance, and its case."""
    at = next((f"{name} {value:.3g}" for name, value in row.settings.items() if name in ("step", "tolerance")), "")
    return ", ".join(word for word in (row.about, at or (f"N = {row.count}" if row.count else "")) if word)
