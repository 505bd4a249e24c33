"""The order in the number of links at which a chain's frequencies converge, by the beam and the rules of the chain.

As derived in `loaded` and `attached`, and as measured on 70 to 640 links: a body and a step leave terms of several
orders, the largest of which at many links is the lowest. Where two of them meet at sizes that are used nobody says.
"""

from collections.abc import Sequence
from itertools import accumulate, pairwise
from typing import TYPE_CHECKING

import msgspec

from verify.segments.links import elastic_ends

if TYPE_CHECKING:
    from verify.problem.beam import Beam
    from verify.problem.cross_section import Piece

_WALL_ORDERS = {"half": 2, "welded": 2, "third-order": 3}
"""Of walls whose joint is of less than order 4."""


class _Standing(msgspec.Struct, frozen=True):
    """Where on a beam something stands, metres: between its ends, and at an end that nothing holds."""

    pulls: tuple[float, ...]
    """Masses and lateral springs."""
    turns: tuple[float, ...]
    """Rotary inertias and rotational springs."""
    tips: frozenset[float]
    """Free ends."""
    ends: frozenset[float]
    """Both ends."""

    @property
    def pulls_inside(self) -> bool:
        """Whether one of the first stands elsewhere than at a free end, where its joint alone feels it."""
        return any(place not in self.tips for place in self.pulls)

    @property
    def turns_inside(self) -> bool:
        """Whether one of the second stands between the ends."""
        return any(place not in self.ends for place in self.turns)


def order_of(
    beam: "Beam",
    *,
    wall: str = "gregory",
    joints: str = "series",
    grading: float = 1.0,
    theory: str = "euler-bernoulli",
    attachment: str = "reciprocal",
) -> int | None:
    """The order due of the frequencies of a chain of this beam; None where that hangs on the number of links."""
    here, graded, sheared = _standing(beam), grading != 1.0, theory == "timoshenko"
    orders = [4, *_of_rules(beam, here, joints, graded, theory)]
    if "clamped" in beam.supports or any(elastic_ends(beam, attachment)):
        orders.append(_WALL_ORDERS.get(wall, 4))
    orders += _of_bodies(beam, here, graded, attachment, sheared)
    told = min(orders)
    at_a_step = _meet(here.pulls, _steps(beam, ("bending_stiffness", "shear_stiffness")))
    lowest = 1 if sheared and (at_a_step or (attachment == "lever" and here.pulls_inside)) else told
    if beam.tension and joints == "tensioned" and here.turns_inside:
        lowest = min(lowest, 3)
    return told if told <= lowest else None


def _of_rules(beam: "Beam", here: _Standing, joints: str, graded: bool, theory: str) -> list[int]:
    """What steps, joints and theories leave."""
    thick, moments = theory != "euler-bernoulli", _steps(beam, ("second_moment",))
    crossed = graded or _meet(moments, _steps(beam, ("youngs_modulus",)))
    orders = [1] * (joints == "printed" and bool(moments) and crossed)
    orders += [2] * (bool(beam.section) or graded)
    orders += [2] * (bool(beam.tension or thick) and joints != "tensioned")
    return orders + [2] * (theory == "timoshenko" and bool(beam.foundation or here.pulls_inside))


def _of_bodies(beam: "Beam", here: _Standing, graded: bool, attachment: str, sheared: bool) -> list[int]:
    """What stands where sections meet, and what is felt by the lever, leaves."""
    lever, meetings = attachment == "lever", _steps(beam, ()) if graded else _steps(beam, ("bending_stiffness",))
    orders = [1] * _meet(here.turns, meetings)  # a chain bends on one side of it as on the other
    orders += [1] * (graded and not lever and _meet(here.pulls, meetings))
    orders += [1] * (lever and bool(here.turns)) + [2] * (lever and here.pulls_inside)
    return orders + [1] * (lever and sheared and any(place in here.tips for place in here.pulls))


def _standing(beam: "Beam") -> _Standing:
    pulls = [m.position for m in beam.mass if m.mass] + [s.position for s in beam.spring if s.stiffness]
    turns = [m.position for m in beam.mass if m.rotary_inertia] + [s.position for s in beam.spring if s.rotational]
    ends = (0.0, beam.length)
    tips = frozenset(end for end, support in zip(ends, beam.supports, strict=True) if support == "free")
    return _Standing(tuple(pulls), tuple(turns), tips, frozenset(ends))


def _steps(beam: "Beam", figures: Sequence[str]) -> tuple[float, ...]:
    """Where sections meet that differ in one of these figures, metres; all where none is named."""

    def differ(one: "Piece", other: "Piece") -> bool:
        return not figures or any(getattr(one, name) != getattr(other, name) for name in figures)

    places = accumulate(piece.length for piece in beam.pieces)
    return tuple(at for at, (one, other) in zip(places, pairwise(beam.pieces), strict=False) if differ(one, other))


def _meet(places: Sequence[float], others: Sequence[float]) -> bool:
    """Whether one of the places is one of the others, to rounding."""
    return any(abs(place - other) <= 1e-9 * max(place, other) for place in places for other in others)
