"""A chain bent in the large as a moving picture: a cantilever rolled into a circle by a growing end moment."""

from math import pi
from typing import TYPE_CHECKING

from msgspec.structs import replace

from verify.studies.chart import Axis, Chart, Line
from verify.studies.charting import numbers
from verify.units import unit_of

if TYPE_CHECKING:
    from verify.beam import Beam

FRAMES, LINKS = 36, 20


def bending_movie(beam: "Beam", colour: str) -> Chart:
    """The section of `beam` as a cantilever of rigid links, from straight to a full circle, to scale."""
    from verify.chain.bending import bend

    own = replace(beam, supports=("clamped", "free"))
    full = 2.0 * pi * beam.bending_stiffness / beam.length
    unit = unit_of(beam.length)
    shapes = [bend(own, LINKS, moment=full * k / FRAMES, wall="half").joints for k in range(1, FRAMES + 1)]
    rows = [(numbers(unit.factor * one[:, 0]), numbers(unit.factor * one[:, 1])) for one in shapes]
    return Chart(
        id="chain-bending",
        title=f"The chain bent in the large, {LINKS} links",
        caption="The same section as a cantilever under an end moment that grows to 2πEI/L, where a beam closes into a "
        "circle; joints EI/l, at the wall 2EI/l, with which the chain closes too. Both axes have one scale.",
        x=Axis(f"x, {unit.name}"),
        y=Axis(f"y, {unit.name}"),
        lines=(
            Line(
                name=f"{LINKS} rigid links",
                colour=colour,
                x=rows[-1][0],
                y=rows[-1][1],
                moves=tuple(y for _, y in rows),
                shifts=tuple(x for x, _ in rows),
                marker="circle",
                size=4.0,
                width=2.2,
            ),
        ),
        frames=tuple(f"{k / FRAMES:.2f} of the full moment" for k in range(1, FRAMES + 1)),
        plays=True,
        equal=True,
    )
