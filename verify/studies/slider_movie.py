"""The slider on the chain over the whole run as a moving picture, with the friction that carries it."""

from typing import TYPE_CHECKING

import numpy as np

from verify.models.catalogue import bounding
from verify.studies.chart import Axis, Chart, Line
from verify.studies.charting import numbers

if TYPE_CHECKING:
    from verify.studies.slider_figures import SliderFound

FRAMES = 96
SLIDER, FRICTION = "#e8760c", "#d6427a"
ARROW = 0.08
"""Length of the largest friction in the picture, of the beam's."""


def slider_movie(study: "SliderFound") -> tuple[Chart, ...]:
    """The chain by its joints, the slider on it, friction as a line from it; nothing where no joint was kept."""
    run, model = study.subject, bounding()[0]
    if not len(run.points) or len(run.times) < 2:
        return ()
    kept = np.unique(np.linspace(0, len(run.times) - 1, FRAMES).round().astype(int))
    x, w = 1e3 * run.points, 1e6 * run.deflection[kept]
    places, pulls = 1e3 * run.position[kept], run.friction[kept]
    heights = np.array([np.interp(at, x, row) for at, row in zip(places, w, strict=True)])
    largest = float(abs(run.friction).max()) or 1.0
    tips = places + ARROW * x[-1] * pulls / largest
    joints = tuple(numbers(row) for row in w)
    blocks = [numbers([h]) for h in heights]
    arrows = [numbers([h, h]) for h in heights]
    return (
        Chart(
            id="slider-moving",
            title=f"The ride, N = {study.count}",
            caption=f"Links straight from joint to joint. Pink: friction on the slider, {1e3 * largest:.3g} mN at its "
            "longest. Along the beam the slider moves by too little to be seen; its way is charted above.",
            x=Axis("x, mm"),
            y=Axis("deflection, µm"),
            lines=(
                Line(
                    name=model.title,
                    colour=model.colour,
                    x=numbers(x),
                    y=joints[-1],
                    moves=joints,
                    marker="circle",
                    size=3.0,
                ),
                Line(
                    name="friction on the slider",
                    colour=FRICTION,
                    x=numbers((places[-1], tips[-1])),
                    y=arrows[-1],
                    moves=tuple(arrows),
                    shifts=tuple(numbers(pair) for pair in zip(places, tips, strict=True)),
                    width=3.0,
                ),
                Line(
                    name="slider",
                    colour=SLIDER,
                    x=numbers(places[-1:]),
                    y=blocks[-1],
                    moves=tuple(blocks),
                    shifts=tuple(numbers([at]) for at in places),
                    marker="square",
                    size=12.0,
                    joined=False,
                ),
            ),
            frames=tuple(f"{1e3 * t:.3f} ms" for t in run.times[kept]),
            plays=True,
        ),
    )
