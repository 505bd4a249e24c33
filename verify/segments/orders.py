"""Order of convergence of a chain's frequencies in the number of links, by the beam and the settings of the chain.

Derived in `docs/theory.md` and measured on 70 to 640 links. Bodies and steps cause error terms of several orders; the
lowest dominates for many links.
"""

from itertools import accumulate, pairwise
from typing import TYPE_CHECKING

from verify.settings import WALLS

if TYPE_CHECKING:
    from verify.problem.beam import Beam

_DERIVED = {"series", "printed", "tensioned", "reciprocal", "lever", "euler-bernoulli", "rayleigh", "timoshenko"}
"""Choices for which the orders are derived; that of a wall rule follows from its weights."""


def order_of(beam: "Beam", *, wall: str, joints: str, grading: float, theory: str, attachment: str) -> int | None:
    """Order of the frequencies of a chain; None where it is not derived or depends on the number of links."""
    if not {joints, attachment, theory} <= _DERIVED:
        return None
    graded, lever = grading != 1.0, attachment == "lever"
    thick, sheared = theory != "euler-bernoulli", theory == "timoshenko"
    ends = (0.0, beam.length)
    tips = [end for end, support in zip(ends, beam.supports, strict=True) if support == "free"]
    lateral = [attachment.position for attachment in beam.attached if attachment.across]
    rotational = [attachment.position for attachment in beam.attached if attachment.turning]
    inside = any(x not in tips for x in lateral)
    elastic = not lever and any(x in ends for x in rotational)
    moments, steps = _steps(beam, "second_moment"), _steps(beam) if graded else _steps(beam, "bending_stiffness")
    lowers = (
        (1, joints == "printed" and bool(moments) and (graded or _coincide(moments, _steps(beam, "youngs_modulus")))),
        (2, bool(beam.section) or graded),
        (2, bool(beam.tension or thick) and joints != "tensioned"),
        (2, sheared and bool(beam.foundation or inside)),
        (WALLS[wall].order, "clamped" in beam.supports or elastic),
        (1, _coincide(rotational, steps)),  # a chain bends equally on both sides of a step
        (1, graded and not lever and _coincide(lateral, steps)),
        (1, lever and bool(rotational)),
        (2, lever and inside),
        (1, lever and sheared and any(x in tips for x in lateral)),
    )
    order = min([4, *(lower for lower, applies in lowers if applies)])
    lowest = order
    if sheared and (_coincide(lateral, _steps(beam, "bending_stiffness", "shear_stiffness")) or (lever and inside)):
        lowest = 1
    if beam.tension and joints == "tensioned" and any(x not in ends for x in rotational):
        lowest = min(lowest, 3)
    return order if order <= lowest else None


def _steps(beam: "Beam", *figures: str) -> list[float]:
    """Positions, m, of steps in one of these properties; without names of all steps."""
    places = accumulate(piece.length for piece in beam.pieces)
    return [
        at
        for at, (left, right) in zip(places, pairwise(beam.pieces), strict=False)
        if not figures or any(getattr(left, name) != getattr(right, name) for name in figures)
    ]


def _coincide(places: list[float], others: list[float]) -> bool:
    """Whether two lists have a common position, to rounding."""
    return any(abs(place - other) <= 1e-9 * max(place, other) for place in places for other in others)
