"""The contact line moving over the crests: surface, feet and what each point presses with, over one period."""

from typing import TYPE_CHECKING

import numpy as np

from verify.models.catalogue import MODELS
from verify.studies.chart import Axis, Chart, Line
from verify.studies.charting import in_units, numbers
from verify.units import in_words, unit_of, unit_over

if TYPE_CHECKING:
    from verify.models.arrays import Array
    from verify.motor.result import MotorRun
    from verify.slider import Foot
    from verify.studies.chart import Numbers
    from verify.studies.motor.figures import MotorFound

FOOT, UPPER, LOWER = "#e8760c", "#d6427a", "#9b6bdf"
LONGEST = 0.9
"""Of the swing of the surface: the longest bar of a normal force."""
APART = 2.2
"""Of that swing: between a beam and its mirror image in the picture."""


def motor_movie(found: "MotorFound") -> tuple[Chart, ...]:
    """One period of the drive; nothing where there is none."""
    run = found.drawn.period
    if run is None or len(run.times) < 2:
        return ()
    title = found.drawn.title
    largest = float(run.pressures[1:].max()) or 1.0
    along, up = unit_of(float(run.points[-1])), unit_over(run.deflection.ravel().tolist())
    swing = float(np.abs(run.deflection).max()) or 1e-9
    mirrored = run.slider is not None and any(foot.mirrored for foot in run.slider.feet)
    drawn = (*_surfaces(run, swing, mirrored), *_feet(run, swing, largest))
    return (
        Chart(
            id="motor-moving",
            title=f"The contact line over one period, {title}",
            caption=f"Orange: the feet, rigid, which the crests press into. Bars: normal force of each contact point, "
            f"{in_words(largest, 'N')} at its longest, up from feet on the upper face and down from those on the lower "
            "one. Drawn without thickness; the slider runs without load."
            + (" Dashed: the mirror image of the beam, raised." if mirrored else ""),
            x=Axis(f"x, {along.name}"),
            y=Axis(f"height, {up.name}"),
            lines=tuple(in_units(one, along, up) for one in drawn),
            frames=tuple(f"{round(360 * k / (len(run.times) - 1))}° of a period" for k in range(1, len(run.times))),
            plays=True,
        ),
    )


def _surfaces(run: "MotorRun", swing: float, mirrored: bool) -> tuple[Line, ...]:
    model = MODELS[run.model]
    beams = [(model.title, 1.0, 0.0)] + [(f"{model.title}, mirrored", -1.0, APART * swing)] * mirrored
    return tuple(
        Line(
            name=name,
            colour=model.colour,
            x=numbers(run.points),
            y=rows[-1],
            moves=rows,
            width=2.2,
            dash="dash" if up else "solid",
        )
        for name, turn, up in beams
        for rows in [tuple(numbers(up + turn * w) for w in run.deflection[1:])]
    )


def _feet(run: "MotorRun", swing: float, largest: float) -> tuple[Line, ...]:
    """Feet by their undersides, and a bar for every point."""
    slider = run.slider
    assert slider is not None
    assert run.start is not None
    lines: list[Line] = []
    bars: dict[str, list[tuple[Array, Array, Array]]] = {}
    first = 0
    for f, foot in enumerate(slider.feet):
        for image in (False, True)[: 1 + foot.mirrored]:
            own = slice(first, first + foot.points)
            first += foot.points
            up = -1.0 if (foot.face == "lower") is not image else 1.0
            raised = APART * swing if image else 0.0
            arm = run.point_offsets[own] - foot.offset
            under = raised + run.height[1:, f, None] + run.pitch[1:, f, None] * arm
            tips = under + up * LONGEST * swing * run.pressures[1:, own] / largest
            name = "force of points below" if up < 0 else "force of points above"
            bars.setdefault(name, []).append((run.start + run.point_offsets[own], under, tips))
            lines.append(_foot(run, foot, f, raised))
    if slider.foot and any(foot.length for foot in slider.feet):
        return (*lines, *(_bars(name, parts) for name, parts in bars.items()))
    return tuple(_bars(name, parts) for name, parts in bars.items())


def _foot(run: "MotorRun", foot: "Foot", f: int, raised: float) -> Line:
    """From end to end, a point as a block."""
    ends = 0.5 * foot.length * np.array([-1.0, 1.0])
    rows = raised + run.height[1:, f, None] + run.pitch[1:, f, None] * ends
    moves = tuple(numbers(row) for row in rows)
    return Line(
        name="feet",
        colour=FOOT,
        x=numbers((run.start or 0.0) + foot.offset + ends),
        y=moves[-1],
        moves=moves,
        width=3.0,
        marker="" if foot.length else "square",
        size=10.0,
        keyed=f == 0 and not raised,
    )


def _bars(name: str, parts: "list[tuple[Array, Array, Array]]") -> Line:
    """All bars of one side as one broken line."""
    x = [v for places, _, _ in parts for at in places for v in (at, at, None)]
    moves: list[Numbers] = []
    for k in range(len(parts[0][1])):
        heights: list[float | None] = []
        for _, under, tips in parts:
            for low, high in zip(under[k], tips[k], strict=True):
                heights += [float(low), float(high), None]
        moves.append(numbers(heights))
    return Line(
        name=name,
        colour=LOWER if "below" in name else UPPER,
        x=numbers(x),
        y=moves[-1],
        moves=tuple(moves),
        width=4.0,
    )
