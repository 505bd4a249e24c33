"""What of a stepped beam stands under a point: its section, how far off its surface lies, how far that goes on.

Where two sections meet, the one to the right stands.
"""

from collections.abc import Sequence
from functools import lru_cache

import msgspec
import numpy as np

from verify.arrays import Array, Indices
from verify.errors import InputError, written
from verify.linear.positions import SLACK, Numbers, positions_on
from verify.problem.beam import Beam

LEFT_BEAM = "left the beam"


def piece_at(beam: Beam, x: Numbers) -> Indices:
    """Which of `beam.pieces` stands at x (metres), of the shape of x, from 0. Raises InputError off the beam."""
    inner = np.cumsum([piece.length for piece in beam.pieces[:-1]]) - SLACK * beam.length
    return np.asarray(np.searchsorted(inner, positions_on("x", x, beam.length), side="right"), dtype=np.int64)


def standing_at(beam: Beam, x: float) -> Beam:
    """The beam as if the section that stands at x (metres) were all of it; itself where that is its own.

    Its `surface_distance` and `wave_constant` are those at x. Raises InputError off the beam.
    """
    return _standing(beam, int(piece_at(beam, x))) if beam.section else beam


@lru_cache(maxsize=4096)
def _standing(beam: Beam, number: int) -> Beam:
    piece, own = beam.pieces[number], beam.own
    if msgspec.structs.replace(piece, length=own.length) == own:
        return beam
    return Beam(
        length=beam.length,
        supports=beam.supports,
        poissons_ratio=beam.poissons_ratio,
        loss_factor=beam.loss_factor,
        tension=beam.tension,
        foundation=beam.foundation,
        bending_stiffness=piece.bending_stiffness,
        mass_per_length=piece.mass_per_length,
        extreme_fibre=piece.extreme_fibre,
        shear_stiffness=piece.shear_stiffness,
        rotary_inertia=piece.rotary_inertia,
    )


def surface_distance_at(beam: Beam, x: Numbers) -> Array:
    """From the neutral line to the surface of the section that stands at x (metres), metres, of the shape of x.

    Raises InputError off the beam and where the distance is not known.
    """
    number = piece_at(beam, x)
    found = [_standing(beam, i).surface_distance if i in number else np.nan for i in range(len(beam.pieces))]
    return np.asarray(np.array(found)[number])


class Ground(msgspec.Struct, frozen=True):
    """A stretch of a beam on which its surface has no step: all of it where its sections are as thick."""

    start: float
    """Metres, as is the next."""
    end: float
    ends: tuple[str, str] = (LEFT_BEAM, LEFT_BEAM)
    """What a slider has done that goes beyond its start, and beyond its end."""


def ground_at(beam: Beam, x: float) -> Ground:
    """The stretch that x (metres) stands on. Raises InputError off the beam."""
    first, last = _alike(beam, x)
    steps = np.cumsum([0.0, *(piece.length for piece in beam.pieces)])
    left, right = float(steps[first]), float(steps[last + 1])
    begins, stops = first > 0, last < len(beam.pieces) - 1
    return Ground(
        start=min(left, x) if begins else 0.0,
        end=right if stops else beam.length,
        ends=(_came_to(left) if begins else LEFT_BEAM, _came_to(right) if stops else LEFT_BEAM),
    )


def _came_to(x: float) -> str:
    return f"came to a step of beam.section at {written(x)} m"


def _alike(beam: Beam, x: float) -> tuple[int, int]:
    """The first and the last of the pieces about x, in a row, whose surface lies as far off as that at x."""
    first = last = int(piece_at(beam, x))
    distances = [piece.extreme_fibre for piece in beam.pieces]
    while first > 0 and distances[first - 1] == distances[first]:
        first -= 1
    while last < len(distances) - 1 and distances[last + 1] == distances[last]:
        last += 1
    return first, last


def check_one_ground(beam: Beam, positions: Sequence[float]) -> None:
    """Raise InputError for sliders put at positions (metres) between which the surface of the beam has a step."""
    first = _alike(beam, positions[0])
    for x in positions:
        if _alike(beam, x) != first:
            raise InputError(
                f"slider.position = {written(x)} m stands on another beam.section than {written(positions[0])} m, and "
                "the surface has a step between: put all sliders on sections of one thickness"
            )
