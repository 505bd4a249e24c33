"""The section of a stepped beam at a position (at a step the right one), and ranges without a step of the surface."""

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
    of_beam = ("length", "supports", "poissons_ratio", "loss_factor", "tension", "foundation")
    of_piece = ("bending_stiffness", "mass_per_length", "extreme_fibre", "shear_stiffness", "rotary_inertia")
    piece = beam.pieces[number]
    return Beam(**{name: getattr(beam, name) for name in of_beam}, **{name: getattr(piece, name) for name in of_piece})


def surface_distance_at(beam: Beam, x: Numbers) -> Array:
    """Distance of the surface from the neutral line at x (m), m, of the shape of x. Raises InputError if unknown."""
    at, beams = piece_at(beam, x), [_uniform(beam, i) if beam.section else beam for i in range(len(beam.pieces))]
    return np.asarray(np.array([b.surface_distance if i in at else np.nan for i, b in enumerate(beams)])[at])


class ContactRange(NamedTuple):
    """A range of the beam, m, without a step of the surface."""

    start: float
    end: float
    ends: tuple[str, str] = (LEFT_BEAM, LEFT_BEAM)
    """Messages for a slider beyond the start, and beyond the end, of the range."""


@lru_cache(maxsize=256)
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
    for x in positions[1:]:
        if contact_range(beam, x).ends != first.ends:
            raise InputError(
                f"slider.position = {written(x)} m and {written(positions[0])} m are separated by a step of the "
                "surface: place all sliders on sections of one thickness"
            )
