"""Elements of many beams of one layout as one stack of pencils: what `element_pencil` has, the beam's axis last.

scikit-fem assembles all of them at once, as elements between the nodes of lines that do not touch.
"""

from collections.abc import Hashable, Sequence
from itertools import accumulate
from typing import Any

import numpy as np

from verify.beam import Beam
from verify.elements.added import SAME_PLACE
from verify.elements.curvatures import curvature_loads, element_curvatures, weights_beside
from verify.elements.cuts import stretches
from verify.elements.mesh import basis_of_lines, free_unknowns, mass_matrix, stiffness_matrix
from verify.models.arrays import Array, Indices
from verify.models.band_stack import of_unknowns
from verify.models.division import ManyParts, divide_each
from verify.models.stacks import PencilStack
from verify.section import Piece

_REACH = 4
"""Diagonals of elements, the main one among them."""


def layout(beam: Beam, n_elements: int, grading: float, theory: str) -> Hashable:
    """What beams have in common that one stack takes, and whose refusals are the same; None for one to be taken alone.

    Alone are graded and sheared elements, axial force and foundation, and what stands inside an element, too near to a
    step for a node of its own.
    """
    if theory != "euler-bernoulli" or grading != 1.0 or beam.tension or beam.foundation:
        return None
    if not (beam.mass or beam.spring):
        return (beam.supports, len(beam.section))
    pieces = stretches(beam)
    if not _on_ends(beam, pieces, n_elements):
        return None
    return (beam.supports, len(pieces), len(beam.mass), len(beam.spring), beam.rigid_motions)


def _on_ends(beam: Beam, pieces: Sequence[Piece], n_elements: int) -> bool:
    """Whether everything stands where pieces end."""
    near = SAME_PLACE * beam.length / n_elements
    ends = [0.0, *accumulate(piece.length for piece in pieces)]
    places = [mass.position for mass in beam.mass] + [spring.position for spring in beam.spring]
    return all(min(abs(place - end) for end in ends) < near for place in places)


def element_stack(beams: Sequence[Beam], n_elements: int) -> PencilStack:
    """The pencils of beams of one `layout`."""
    first = beams[0]
    there = bool(first.mass or first.spring)
    parts = divide_each(beams, n_elements, [stretches(beam) if there else beam.pieces for beam in beams])
    nodes = parts.nodes
    basis = basis_of_lines(nodes.T)
    stiffness = _bands(stiffness_matrix(basis, parts.stiffnesses.T.ravel()), len(beams))
    mass = _bands(mass_matrix(basis, parts.masses_per_length.T.ravel()), len(beams))
    lengths, beside = np.diff(nodes, axis=0), stiffness[:-2, 2]
    springs, places = weights_beside(lengths, beside), np.zeros((0, len(beams)), dtype=np.intp)
    if there:
        _add_masses(beams, parts, mass)
        places, held = _springs(beams, parts)
        _add(stiffness, places, held)
        springs = np.concatenate([springs, held])
    free = _free(first.supports, n_elements)

    def strain(vectors: Array) -> Array:
        values = np.zeros((2 * n_elements + 2, *vectors.shape[1:]))
        values[free] = vectors
        felt = np.take_along_axis(values, places[:, None], axis=0)
        return np.concatenate([element_curvatures(lengths, values), felt])

    def loads(forces: Array) -> Array:
        values = curvature_loads(lengths, forces[: 2 * n_elements])
        for at, force in zip(places, forces[2 * n_elements :], strict=True):
            values[at, :, np.arange(len(beams))] += force.T
        return values[free]

    return PencilStack(
        stiffness=of_unknowns(stiffness, free),
        mass=of_unknowns(mass, free),
        strain=strain,
        loads=loads,
        springs=springs,
        rigid_modes=first.rigid_motions,
    )


def _free(supports: tuple[str, str], n_elements: int) -> Indices:
    """Degrees of freedom that the supports leave of one beam."""
    return free_unknowns(basis_of_lines(np.arange(n_elements + 1.0)[None]), supports)


def _bands(matrix: Any, n_beams: int) -> Array:
    """What is assembled of all beams as bands over all degrees of freedom of each, (2N + 2, 4, n_beams)."""
    size = matrix.shape[0]
    found = np.zeros((_REACH, size))
    for above in range(_REACH):
        found[above, : size - above] = matrix.diagonal(above)
    return np.ascontiguousarray(found.reshape(_REACH, n_beams, -1).transpose(2, 0, 1))


def _add(bands: Array, places: Indices, weights: Array) -> None:
    """Weights (n, n_beams) on the degrees of freedom `places`, (n, n_beams)."""
    for at, weight in zip(places, weights, strict=True):
        bands[at, 0, np.arange(bands.shape[2])] += weight


def _add_masses(beams: Sequence[Beam], parts: ManyParts, bands: Array) -> None:
    """Masses and rotary inertias, in those of each beam."""
    unit, own = parts.unit, np.array([beam.mass_per_length for beam in beams])
    figures = np.array([[(m.position, m.mass, m.rotary_inertia) for m in beam.mass] for beam in beams])
    if figures.size:
        position, mass, rotary = figures.transpose(2, 1, 0)
        at = 2 * _nearest(parts, position)
        _add(bands, np.concatenate([at, at + 1]), np.concatenate([mass / unit, rotary / unit**3]) / own)


def _springs(beams: Sequence[Beam], parts: ManyParts) -> tuple[Indices, Array]:
    """Degrees of freedom that springs hold and their stiffnesses in those of each beam, (springs, n_beams) both."""
    unit, own = parts.unit, np.array([beam.bending_stiffness for beam in beams])
    figures = np.array([[(s.position, s.stiffness, s.rotational) for s in beam.spring] for beam in beams])
    if not figures.size:
        return np.zeros((0, len(beams)), dtype=np.intp), np.zeros((0, len(beams)))
    position, lift, turn = figures.transpose(2, 1, 0)
    at = 2 * _nearest(parts, position)
    return np.concatenate([at, at + 1]), np.concatenate([lift * unit**3, turn * unit]) / own


def _nearest(parts: ManyParts, position: Array) -> Indices:
    """The node at each place, (places, n_beams)."""
    away = abs(parts.nodes[None] - (position / parts.unit)[:, None])
    return np.asarray(away.argmin(axis=1), dtype=np.intp)
