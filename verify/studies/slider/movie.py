"""The slider on the chain over the whole run as a moving picture, with the friction that carries it."""

from typing import TYPE_CHECKING, Any

import numpy as np

from verify.models.catalogue import bounding
from verify.studies.chart import Axis, Chart, Line
from verify.studies.charting import in_units, numbers
from verify.units import in_words, unit_of, unit_over

if TYPE_CHECKING:
    from verify.models.arrays import Array
    from verify.motion.result import Motion
    from verify.studies.chart import Numbers
    from verify.studies.slider.figures import SliderFound

FRAMES = 96
SLIDER, FRICTION = "#e8760c", "#d6427a"
ARROW = 0.08
"""Length of the largest friction in the picture, of the beam's."""
SEEN = 0.002
"""Of the beam's length: a pixel or two of the picture."""


def slider_movie(study: "SliderFound") -> tuple[Chart, ...]:
    """The chain by its joints, the slider on it, friction as a line from it; nothing where no joint was kept."""
    run = study.subject
    if not len(run.points) or len(run.times) < 2:
        return ()
    kept = np.unique(np.linspace(0, len(run.times) - 1, FRAMES).round().astype(int))
    largest = float(abs(run.friction).max()) or 1.0
    along, up = unit_of(float(run.points[-1])), unit_over(run.deflection[kept].ravel().tolist())
    time = unit_over(run.times.tolist(), "s")
    return (
        Chart(
            id="slider-moving",
            title=f"The ride, N = {study.count}",
            caption=f"Links straight from joint to joint. Pink: friction on the slider, {in_words(largest, 'N')} at "
            f"its longest. {_way_in_words(run)}",
            x=Axis(f"x, {along.name}"),
            y=Axis(f"deflection, {up.name}"),
            lines=tuple(in_units(one, along, up) for one in _parts(run, kept, largest)),
            frames=tuple(f"{time.factor * t:.3f} {time.name}" for t in run.times[kept]),
            plays=True,
        ),
    )


def _way_in_words(run: "Motion") -> str:
    """Where the slider goes along the beam, which is drawn to scale, and whether that can be seen."""
    low, high = float(run.position.min()), float(run.position.max())
    if high - low >= SEEN * float(run.points[-1]):
        at = unit_of(float(run.points[-1]))
        between = f"{at.factor * low:.4g} and {at.factor * high:.4g} {at.name}"
        return f"Along the beam the slider stands between {between}, to scale."
    return (
        f"Along the beam the slider stands within {in_words(high - low)}, too little to be seen; its way is "
        "charted above."
    )


def _parts(run: "Motion", kept: "Array", largest: float) -> tuple[Line, ...]:
    """Chain, friction, slider at the samples `kept`, (n_frames,)."""
    x, w, places = run.points, run.deflection[kept], run.position[kept]
    tips = places + ARROW * x[-1] * run.friction[kept] / largest
    heights = [float(np.interp(at, x, row)) for at, row in zip(places, w, strict=True)]
    model, joints = bounding()[0], tuple(numbers(row) for row in w)
    chain = Line(
        name=model.title, colour=model.colour, x=numbers(x), y=joints[-1], moves=joints, marker="circle", size=3.0
    )
    arrows = tuple((numbers(pair), (h, h)) for pair, h in zip(zip(places, tips, strict=True), heights, strict=True))
    blocks = tuple((numbers([at]), (h,)) for at, h in zip(places, heights, strict=True))
    return (
        chain,
        _carried("friction on the slider", FRICTION, arrows, width=3.0),
        _carried("slider", SLIDER, blocks, marker="square", size=12.0, joined=False),
    )


def _carried(name: str, colour: str, rows: "tuple[tuple[Numbers, Numbers], ...]", **style: Any) -> Line:
    """What has another place at every frame, by (x, y) of each."""
    shifts, moves = tuple(x for x, _ in rows), tuple(y for _, y in rows)
    return Line(name=name, colour=colour, x=shifts[-1], y=moves[-1], shifts=shifts, moves=moves, **style)
