"""Where a beam is cut into elements: at its steps, and at the masses and springs that stand on it.

A mass makes the shear force jump and a rotary inertia the moment, and a cubic bends linearly: where the jump lies
inside an element, frequencies are of order 3 and 1 (1 and 1 under Timoshenko's theory, whose slope jumps with the
shear force), where a node lies there they are of order 4. What stands
nearer than the shortest section to a step, an end or its neighbour makes no cut and acts inside its element.
"""

import numpy as np
from msgspec.structs import replace

from verify.beam import SHORTEST_SECTION, Beam
from verify.errors import InputError
from verify.models.arrays import Array
from verify.models.division import Parts, check_division, divide
from verify.section import Piece


def check_cuts(beam: Beam, n_elements: int, grading: float) -> None:
    """Raise InputError where a beam cannot be divided so."""
    check_division(beam, n_elements, grading)
    if n_elements < (least := len(stretches(beam))):
        raise InputError(
            f"n_elements = {n_elements}: the beam's steps, masses and springs cut it into {least} stretches and each "
            f"takes an element, give {least} or more"
        )


def stretches(beam: Beam) -> tuple[Piece, ...]:
    """The pieces of a beam, cut where something stands on it."""
    if not (beam.mass or beam.spring):
        return beam.pieces
    near, found, start = SHORTEST_SECTION * beam.length, [], 0.0
    places = sorted({mass.position for mass in beam.mass} | {spring.position for spring in beam.spring})
    for piece in beam.pieces:
        left, end = start, start + piece.length
        for place in places:
            if left + near <= place <= end - near:
                found.append(replace(piece, length=place - left))
                left = place
        found.append(replace(piece, length=end - left) if left > start else piece)
        start = end
    return tuple(found)


def cut(beam: Beam, n_elements: int, grading: float) -> Parts:
    """The elements of a beam, in every stretch graded alike. Raises InputError where it cannot be divided so."""
    check_cuts(beam, n_elements, grading)
    found = stretches(beam)
    return divide(beam, n_elements, grading, found if len(found) > len(beam.pieces) else ())


def of_pieces(beam: Beam, parts: Parts, figures: list[float]) -> Array:
    """A figure of every piece for every element, (N,)."""
    ends = np.cumsum([piece.length for piece in beam.pieces])[:-1] / parts.unit
    return np.array(figures)[ends.searchsorted(parts.nodes[:-1] + 0.5 * parts.lengths)]
