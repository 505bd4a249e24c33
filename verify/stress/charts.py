"""Charts of the stress table as plain plotly figure data."""

from collections.abc import Iterable
from math import exp, inf, isfinite, log, pi
from typing import TYPE_CHECKING

from verify.stress.kind import Outcome, Points, exponent
from verify.studies.charting import GREY, LOG, MEAN_COLOUR, PALETTE, Figure, axes, line
from verify.studies.told import Chart

if TYPE_CHECKING:
    from verify.stress.figures import StressFound

BLUE, ORANGE = "#2f80ed", "#e8760c"
_COLOURS = {"segments": BLUE, "elements": ORANGE}
LEAST = 1e-17
"""An error of nothing is drawn here."""


def stress_charts(found: "StressFound") -> tuple[Chart, ...]:
    """Those for which there are rows."""
    by_id = {one.id: one for one in found.outcomes}
    charts = []
    if sizes := {parts: by_id[f"{parts}-parts"] for parts in _COLOURS if f"{parts}-parts" in by_id}:
        charts.append(_errors(sizes, by_id))
    if costs := [one for one in found.outcomes if one.kind == "growth" and one.points]:
        charts += [_costs(unit, [one for one in costs if one.unit == unit]) for unit in sorted({o.unit for o in costs})]
    if ranked := found.worst():
        charts.append(_shares(ranked))
    return tuple(charts)


def _drawn(points: Points) -> Points:
    return tuple((x, max(y, LEAST)) for x, y in points if isfinite(y))


def takes_over(points: Points) -> float | None:
    """Parts from which on rounding is more than what the division itself leaves in mode 1, (pi / N)^4 / 1440."""
    before: tuple[float, float] | None = None
    for n, error in points:
        here = log(max(error, LEAST)) - log((pi / n) ** 4 / 1440.0)
        if here >= 0.0 and before is not None:
            share = -before[1] / (here - before[1])
            return exp(log(before[0]) + share * (log(n) - log(before[0])))
        before = n, here
    return None


def _below(rows: Iterable[Outcome]) -> float:
    """The largest rounding of factored parts."""
    return max(error for one in rows for _, error in one.points)


def _errors(sizes: dict[str, Outcome], by_id: dict[str, Outcome]) -> Chart:
    data: list[Figure] = []
    shapes: list[Figure] = []
    notes: list[Figure] = []
    for parts, one in sizes.items():
        colour = _COLOURS[parts]
        more = by_id.get(f"{parts}-million")
        ours = sorted({*one.points, *(more.points if more else ())})
        textbook = sorted({*one.beside_points, *(more.beside_points if more else ())})
        data.append(line(f"{parts}, factored", colour, *zip(*_drawn(tuple(ours)), strict=True)))
        data.append(
            line(
                f"{parts}, assembled and eigsh",
                colour,
                *zip(*_drawn(tuple(textbook)), strict=True),
                line={"dash": "dash"},
                marker={"symbol": "x"},
            )
        )
        if (edge := takes_over(tuple(textbook))) is not None:
            shapes.append(
                {
                    "type": "line",
                    "x0": edge,
                    "x1": edge,
                    "yref": "paper",
                    "y0": 0,
                    "y1": 1,
                    "line": {"color": colour, "width": 1.5, "dash": "dot"},
                }
            )
            notes.append(
                {
                    "x": log(edge, 10),
                    "y": 1.0 if parts == "segments" else 0.93,
                    "yref": "paper",
                    "text": f"{parts}: {edge:.0f}",
                    "showarrow": False,
                    "xanchor": "left",
                    "yanchor": "top",
                    "xshift": 4,
                    "font": {"color": colour},
                }
            )
    n = sorted({n for one in sizes.values() for n, _ in one.points})
    data.append(
        line("left by the division, mode 1", GREY, n, [(pi / k) ** 4 / 1440.0 for k in n], line={"width": 3})
        | {"mode": "lines"}
    )
    layout = axes("parts", "relative error of a frequency", xaxis=LOG, yaxis=LOG)
    return Chart(
        "stress-errors",
        "Rounding over size",
        "Worst of modes 1 to 5 of a pinned strip against the discrete dispersion in closed form. Dotted: where the "
        "rounding of assembled matrices takes over from what the division itself leaves of mode 1 (grey). Kept "
        f"factored, it does where both are below {_below(sizes.values()):.0e}.",
        data,
        layout | {"shapes": shapes, "annotations": notes},
    )


def _costs(unit: str, rows: list[Outcome]) -> Chart:
    data: list[Figure] = []
    for i, one in enumerate(rows):
        colour = PALETTE[i % len(PALETTE)]
        data.append(line(f"{one.id}: N^{exponent(one.points):.2f}", colour, *zip(*one.points, strict=True)))
        if one.beside_points:
            data.append(
                line(
                    f"{one.textbook}: N^{exponent(one.beside_points):.2f}",
                    colour,
                    *zip(*one.beside_points, strict=True),
                    line={"dash": "dash"},
                    marker={"symbol": "x"},
                )
            )
    what = "Memory" if unit == "MB" else "Time"
    return Chart(
        f"stress-{what.lower()}",
        f"{what} over size",
        "With the exponents of least squares over all sizes. Dashed: the textbook's way."
        + (" Processor seconds, the least of several rounds." if what == "Time" else " Of a process of its own."),
        data,
        axes("parts", f"{what.lower()}, {unit}", xaxis=LOG, yaxis=LOG),
    )


SHOWN = 14
"""Bars that a chart has room for."""


def _shares(ranked: list[Outcome]) -> Chart:
    """The rows with the thinnest margins, the thinnest on top."""
    shown = [one for one in ranked if one.share not in (0.0, inf)][:SHOWN][::-1]
    bars: Figure = {
        "type": "bar",
        "orientation": "h",
        "y": [one.id for one in shown],
        "x": [one.share for one in shown],
        "marker": {"color": [MEAN_COLOUR if one.held else PALETTE[1] for one in shown]},
        "showlegend": False,
    }
    layout = axes("measured over promised", "", xaxis=LOG, yaxis={"automargin": True})
    edge = {"type": "line", "x0": 1, "x1": 1, "yref": "paper", "y0": 0, "y1": 1, "line": {"color": GREY, "width": 2}}
    return Chart(
        "stress-shares",
        "The worst rows",
        "How much of its promise each uses; left of the line at 1 is held. Refusals have no size and are not here.",
        [bars],
        layout | {"shapes": [edge]},
    )
