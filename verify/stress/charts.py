"""Charts of the stress table."""

from collections.abc import Iterable
from math import exp, inf, isfinite, log, pi
from typing import TYPE_CHECKING

from verify.stress.kind import Outcome, Points, exponent
from verify.studies.chart import Axis, Bars, Chart, Line, Mark
from verify.studies.charting import GREY, MEAN_COLOUR, PALETTE, line, other_line, plain_line

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
    lines: list[Line] = []
    marks: list[Mark] = []
    for parts, one in sizes.items():
        colour = _COLOURS[parts]
        more = by_id.get(f"{parts}-million")
        ours = sorted({*one.points, *(more.points if more else ())})
        textbook = sorted({*one.beside_points, *(more.beside_points if more else ())})
        lines.append(line(f"{parts}, factored", colour, *zip(*_drawn(tuple(ours)), strict=True)))
        lines.append(_textbook(f"{parts}, assembled and eigsh", colour, _drawn(tuple(textbook))))
        if (edge := takes_over(tuple(textbook))) is not None:
            marks.append(Mark(edge, f"{parts}: {edge:.0f}", colour))
    n = sorted({n for one in sizes.values() for n, _ in one.points})
    left = plain_line("left by the division, mode 1", GREY, n, [(pi / k) ** 4 / 1440.0 for k in n], width=3.0)
    return Chart(
        id="stress-errors",
        title="Rounding over size",
        caption="Worst of modes 1 to 5 of a pinned strip against the discrete dispersion in closed form. Dotted: where "
        "the rounding of assembled matrices takes over from what the division itself leaves of mode 1 (grey). Kept "
        f"factored, it does where both are below {_below(sizes.values()):.0e}.",
        x=Axis("parts", log=True),
        y=Axis("relative error of a frequency", log=True),
        lines=(left, *lines),
        marks=tuple(marks),
    )


def _textbook(name: str, colour: str, points: Points) -> Line:
    return line(name, colour, *zip(*points, strict=True), marker="cross", dash="dash")


def _costs(unit: str, rows: list[Outcome]) -> Chart:
    lines: list[Line] = []
    for i, one in enumerate(rows):
        own = other_line(i, f"{one.id}: N^{exponent(one.points):.2f}", *zip(*one.points, strict=True))
        lines.append(own)
        if one.beside_points:
            name = f"{one.textbook}: N^{exponent(one.beside_points):.2f}"
            lines.append(_textbook(name, own.colour, one.beside_points))
    what = "Memory" if unit == "MB" else "Time"
    return Chart(
        id=f"stress-{what.lower()}",
        title=f"{what} over size",
        caption="With the exponents of least squares over all sizes. Dashed: the textbook's way."
        + (" Processor seconds, the least of several rounds." if what == "Time" else " Of a process of its own."),
        x=Axis("parts", log=True),
        y=Axis(f"{what.lower()}, {unit}", log=True),
        lines=tuple(lines),
    )


SHOWN = 14
"""Bars that a chart has room for."""


def _shares(ranked: list[Outcome]) -> Chart:
    """The rows with the thinnest margins, the thinnest on top."""
    shown = [one for one in ranked if one.share not in (0.0, inf)][:SHOWN][::-1]
    return Chart(
        id="stress-shares",
        title="The worst rows",
        caption="How much of its promise each uses; left of the line at 1 is held. Refusals have no size and are not "
        "here.",
        x=Axis("measured over promised", log=True),
        y=Axis(""),
        bars=Bars(
            tuple(one.id for one in shown),
            tuple(one.share for one in shown),
            tuple(MEAN_COLOUR if one.held else PALETTE[1] for one in shown),
        ),
        marks=(Mark(1.0, "", GREY),),
    )
