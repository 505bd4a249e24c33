"""Order in the number of links at which a chain's frequencies converge, by the beam and the settings of the chain.

Derived in `docs/theory.md` and measured on 70 to 640 links: a body and a step leave terms of several orders, of which
the lowest dominates at many links.
"""

from itertools import accumulate, pairwise
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from verify.problem.beam import Beam

_WALL_ORDERS = {"half": 2, "welded": 2, "third-order": 3}
"""Of walls whose order is less than 4."""


def order_of(beam: "Beam", *, wall: str, joints: str, grading: float, theory: str, attachment: str) -> int | None:
    """The order of the frequencies of a chain of this beam; None where it depends on the number of links."""
    graded, thick, sheared, lever = (
        grading != 1.0,
        theory != "euler-bernoulli",
        theory == "timoshenko",
        attachment == "lever",
    )
    ends = (0.0, beam.length)
    tips = [end for end, support in zip(ends, beam.supports, strict=True) if support == "free"]
    lateral = [m.position for m in beam.mass if m.mass] + [s.position for s in beam.spring if s.stiffness]
    rotational = [m.position for m in beam.mass if m.rotary_inertia] + [s.position for s in beam.spring if s.rotational]
    inside = any(x not in tips for x in lateral)
    elastic = not lever and any(x in ends for x in rotational)
    moments, steps = _steps(beam, "second_moment"), _steps(beam) if graded else _steps(beam, "bending_stiffness")
    lowers = (
        (1, joints == "printed" and bool(moments) and (graded or _meet(moments, _steps(beam, "youngs_modulus")))),
        (2, bool(beam.section) or graded),
        (2, bool(beam.tension or thick) and joints != "tensioned"),
        (2, sheared and bool(beam.foundation or inside)),
        (_WALL_ORDERS.get(wall, 4), "clamped" in beam.supports or elastic),
        (1, _meet(rotational, steps)),  # a chain bends alike on both sides of it
        (1, graded and not lever and _meet(lateral, steps)),
        (1, lever and bool(rotational)),
        (2, lever and inside),
        (1, lever and sheared and any(x in tips for x in lateral)),
    )
    order = min([4, *(lower for lower, applies in lowers if applies)])
    lowest = order
    if sheared and (_meet(lateral, _steps(beam, "bending_stiffness", "shear_stiffness")) or (lever and inside)):
        lowest = 1
    if beam.tension and joints == "tensioned" and any(x not in ends for x in rotational):
        lowest = min(lowest, 3)
    return order if order <= lowest else None


def _steps(beam: "Beam", *figures: str) -> list[float]:
    """Positions, m, where sections meet that differ in one of these properties; all where none is named."""
    places = accumulate(piece.length for piece in beam.pieces)
    return [
        at
        for at, (one, other) in zip(places, pairwise(beam.pieces), strict=False)
        if not figures or any(getattr(one, name) != getattr(other, name) for name in figures)
    ]


def _meet(places: list[float], others: list[float]) -> bool:
    """Whether one of the positions is one of the others, to rounding."""
    return any(abs(place - other) <= 1e-9 * max(place, other) for place in places for other in others)
