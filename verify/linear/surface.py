"""The section of a stepped beam at a position, and the range in which its surface has no step.

At a step the section to the right counts.
"""

from collections.abc import Sequence
from functools import lru_cache
from typing import NamedTuple

import numpy as np

from verify.arrays import Array, Indices
from verify.errors import InputError, written
from verify.linear.positions import SLACK, Numbers, positions_on
from verify.problem.beam import Beam

LEFT_BEAM = "left the beam"


def piece_at(beam: Beam, x: Numbers) -> Indices:
    """Index of the piece of the beam at x (m), of the shape of x. Raises InputError off the beam."""
    inner = np.cumsum([piece.length for piece in beam.pieces[:-1]]) - SLACK * beam.length
    return np.asarray(np.searchsorted(inner, positions_on("x", x, beam.length), side="right"), dtype=np.int64)


def section_at(beam: Beam, x: float) -> Beam:
    """A uniform beam of the section at x (m), for its `surface_distance` and `wave_constant`. Raises InputError."""
    return _uniform(beam, int(piece_at(beam, x))) if beam.section else beam


@lru_cache(maxsize=256)
def _uniform(beam: Beam, number: int) -> Beam:
    kept = ("length", "supports", "poissons_ratio", "loss_factor", "tension", "foundation")
    taken = ("bending_stiffness", "mass_per_length", "extreme_fibre", "shear_stiffness", "rotary_inertia")
    piece = beam.pieces[number]
    return Beam(**{name: getattr(beam, name) for name in kept}, **{name: getattr(piece, name) for name in taken})


def surface_distance_at(beam: Beam, x: Numbers) -> Array:
    """From the neutral line to the surface at x (m), m, of the shape of x. Raises InputError where it is unknown."""
    at, beams = piece_at(beam, x), [_uniform(beam, i) if beam.section else beam for i in range(len(beam.pieces))]
    return np.asarray(np.array([one.surface_distance if i in at else np.nan for i, one in enumerate(beams)])[at])


class ContactRange(NamedTuple):
    """The range of a beam, m, in which its surface has no step."""

    start: float
    end: float
    ends: tuple[str, str] = (LEFT_BEAM, LEFT_BEAM)
    """What a slider did that is beyond its start, and beyond its end."""


def contact_range(beam: Beam, x: float) -> ContactRange:
    """The contact range about x (m). Raises InputError off the beam."""
    distances, at = [piece.extreme_fibre for piece in beam.pieces], int(piece_at(beam, x))
    steps = np.cumsum([0.0, *(piece.length for piece in beam.pieces)])
    differs = [i for i, distance in enumerate(distances) if distance != distances[at]]
    left = [float(steps[i + 1]) for i in differs if i < at]
    right = [float(steps[i]) for i in differs if i > at]
    return ContactRange(
        start=min(left[-1], x) if left else 0.0,
        end=right[0] if right else beam.length,
        ends=(_came_to(left[-1]) if left else LEFT_BEAM, _came_to(right[0]) if right else LEFT_BEAM),
    )


def _came_to(x: float) -> str:
    return f"came to a step of beam.section at {written(x)} m"


def check_one_range(beam: Beam, positions: Sequence[float]) -> None:
    """Raise InputError for sliders at positions (m) between which the surface of the beam has a step."""
    first = contact_range(beam, positions[0])
    for x in positions:
        if contact_range(beam, x).ends != first.ends:
            raise InputError(
                f"slider.position = {written(x)} m lies on another beam.section than {written(positions[0])} m, and "
                "the surface has a step between: put all sliders on sections of one thickness"
            )
