"""Elements of many beams of one layout as one stack of pencils: what `element_pencil` has, the beam's axis last.

scikit-fem assembles an element of length one; those of all beams differ from it by their lengths and properties alone.
"""

from collections.abc import Callable, Hashable, Sequence
from functools import cache, partial
from itertools import accumulate

import msgspec
import numpy as np

from verify.beam import Beam
from verify.elements.added import SAME_PLACE
from verify.elements.curvatures import axial_weights, curvature_loads, element_curvatures, weights_beside
from verify.elements.cuts import stretches
from verify.elements.mesh import basis_between, free_unknowns, mass_matrix, slope_matrix, stiffness_matrix
from verify.models.arrays import Array, Indices
from verify.models.band_stack import banded, of_unknowns
from verify.models.division import ManyParts, divide_each
from verify.models.stacks import PencilStack
from verify.section import Piece

_REACH = 4
"""Diagonals of elements, the main one among them."""
_ONE = np.array([0.0, 1.0])
"""The nodes of an element of length one."""


class _Strained(msgspec.Struct, frozen=True, eq=False):
    """Some strains of many beams at once."""

    read: Callable[[Array], Array]
    """All values (2N + 2, k, n_beams) -> strains (m, k, n_beams)."""
    loads: Callable[[Array], Array]
    """What forces in them are on all values."""
    stiffness: Array
    """(m, n_beams)."""


def layout(beam: Beam, n_elements: int, grading: float, theory: str) -> Hashable:
    """What beams have in common that one stack takes, and whose refusals are the same; None for one to be taken alone.

    Alone are sheared elements, what is compressed and may buckle, and what stands inside an element, too near to a
    step for a node of its own.
    """
    if theory == "timoshenko" or beam.tension < 0.0:
        return None
    if theory != "euler-bernoulli" and (beam.tension or any(piece.rotary_inertia is None for piece in beam.pieces)):
        return None
    carried = (beam.tension > 0.0, beam.foundation > 0.0, beam.rigid_motions)
    if not (beam.mass or beam.spring):
        return (beam.supports, len(beam.section), *carried)
    pieces = stretches(beam)
    if not _on_ends(beam, pieces, n_elements):
        return None
    return (beam.supports, len(pieces), len(beam.mass), len(beam.spring), *carried)


def _on_ends(beam: Beam, pieces: Sequence[Piece], n_elements: int) -> bool:
    """Whether everything stands where pieces end."""
    near = SAME_PLACE * beam.length / n_elements
    ends = [0.0, *accumulate(piece.length for piece in pieces)]
    places = [mass.position for mass in beam.mass] + [spring.position for spring in beam.spring]
    return all(min(abs(place - end) for end in ends) < near for place in places)


def element_stack(beams: Sequence[Beam], n_elements: int, grading: float, theory: str) -> PencilStack:
    """The pencils of beams of one `layout`."""
    first = beams[0]
    there = bool(first.mass or first.spring)
    pieces = [stretches(beam) if there else beam.pieces for beam in beams]
    parts = divide_each(beams, n_elements, pieces, grading)
    lengths = np.diff(parts.nodes, axis=0)
    stiffness = _bands(_bending(), lengths, parts.stiffnesses / lengths**3)
    mass = _bands(_inertia(), lengths, parts.masses_per_length * lengths)
    if theory == "rayleigh":
        rotary = np.array([[piece.rotary_inertia for piece in each] for each in pieces]).T
        own = parts.of_pieces(rotary) / (np.array([beam.mass_per_length for beam in beams]) * parts.unit**2)
        mass += _bands(_slopes(), lengths, own / lengths)
    strained = [_curved(lengths, weights_beside(lengths, stiffness[:-2, 2]))]
    scale = parts.unit**2 / np.array([beam.bending_stiffness for beam in beams])
    if first.tension:
        pulled = _bands(_slopes(), lengths, np.array([beam.tension for beam in beams]) * scale / lengths)
        stiffness += pulled
        strained.append(_pulled(lengths, axial_weights(lengths, pulled[:-2, 2], pulled[:-3, 3])))
    if first.foundation:
        ground = np.broadcast_to(np.array([beam.foundation for beam in beams]) * parts.unit**2 * scale, lengths.shape)
        stiffness += _bands(_inertia(), lengths, ground * lengths)
        strained.append(_grounded(lengths, ground))
    if there:
        _add_masses(beams, parts, mass)
        places, held = _springs(beams, parts)
        _add(stiffness, places, held)
        strained.append(_held(2 * n_elements + 2, places, held))
    return _stack(strained, stiffness, mass, _free(first.supports, n_elements), first.rigid_motions)


def _stack(strained: list[_Strained], stiffness: Array, mass: Array, free: Indices, rigid_modes: int) -> PencilStack:
    """Strains and matrices over all degrees of freedom as a stack over those that are free."""
    splits = np.cumsum([len(each.stiffness) for each in strained])[:-1]

    def strain(vectors: Array) -> Array:
        values = np.zeros((len(stiffness), *vectors.shape[1:]))
        values[free] = vectors
        return np.concatenate([each.read(values) for each in strained])

    def loads(forces: Array) -> Array:
        shares = zip(strained, np.split(forces, splits), strict=True)
        return np.asarray(sum(each.loads(share) for each, share in shares))[free]

    return PencilStack(
        pencils=banded(of_unknowns(stiffness, free), of_unknowns(mass, free)),
        strain=strain,
        loads=loads,
        springs=np.concatenate([each.stiffness for each in strained]),
        rigid_modes=rigid_modes,
    )


def _curved(lengths: Array, weights: Array) -> _Strained:
    """Of bending."""
    return _Strained(partial(element_curvatures, lengths), partial(curvature_loads, lengths), weights)


def _pulled(lengths: Array, weights: Array) -> _Strained:
    """Of an axial force (`added`): chord, mean curvature and gradient of every element."""

    def read(values: Array) -> Array:
        return np.concatenate([np.diff(values[::2], axis=0) / lengths[:, None], element_curvatures(lengths, values)])

    def loads(forces: Array) -> Array:
        chord = forces[: len(lengths)] / lengths[:, None]
        found = curvature_loads(lengths, forces[len(lengths) :])
        found[2::2] += chord
        found[:-2:2] -= chord
        return found

    return _Strained(read, loads, weights)


def _grounded(lengths: Array, ground: Array) -> _Strained:
    """Of a foundation (`added`): deflection at four Gauss points of every element."""
    from verify.elements.element import cubics

    points, shares = np.polynomial.legendre.leggauss(4)
    lift, turn, lift_after, turn_after = (each[:, None, None, None] for each in cubics(0.5 + 0.5 * points))
    spans = lengths[:, None]

    def read(values: Array) -> Array:
        found = lift * values[:-2:2] + turn * (spans * values[1:-2:2])
        found += lift_after * values[2::2] + turn_after * (spans * values[3::2])
        return np.asarray(found.reshape(-1, *values.shape[1:]))

    def loads(forces: Array) -> Array:
        each = forces.reshape(len(points), len(lengths), *forces.shape[1:])
        found = np.zeros((2 * len(lengths) + 2, *forces.shape[1:]))
        found[:-2:2] += (lift * each).sum(axis=0)
        found[1:-2:2] += (turn * each).sum(axis=0) * spans
        found[2::2] += (lift_after * each).sum(axis=0)
        found[3::2] += (turn_after * each).sum(axis=0) * spans
        return found

    weights = 0.5 * shares[:, None, None] * (ground * lengths)
    return _Strained(read, loads, weights.reshape(-1, lengths.shape[1]))


def _held(n_values: int, places: Indices, stiffness: Array) -> _Strained:
    """Of springs on degrees of freedom, (springs, n_beams) both."""
    every = np.arange(stiffness.shape[1])

    def loads(forces: Array) -> Array:
        found = np.zeros((n_values, *forces.shape[1:]))
        for at, force in zip(places, forces, strict=True):
            found[at, :, every] += force.T
        return found

    return _Strained(lambda values: np.take_along_axis(values, places[:, None], axis=0), loads, stiffness)


def _free(supports: tuple[str, str], n_elements: int) -> Indices:
    """Degrees of freedom that the supports leave of one beam."""
    return free_unknowns(basis_between(np.arange(n_elements + 1.0)), supports)


@cache
def _bending() -> Array:
    """Of an element of length one, (4, 4); kept, for reading alone."""
    return np.asarray(stiffness_matrix(basis_between(_ONE), _ONE[1:]).toarray())


@cache
def _inertia() -> Array:
    """Likewise."""
    return np.asarray(mass_matrix(basis_between(_ONE), _ONE[1:]).toarray())


@cache
def _slopes() -> Array:
    """Likewise."""
    return np.asarray(slope_matrix(basis_between(_ONE), _ONE[1:]).toarray())


def _bands(one: Array, lengths: Array, weights: Array) -> Array:
    """Elements of these lengths, (N, n_beams), as bands over all degrees of freedom of each beam, (2N + 2, 4, n_beams).

    `one` is what an element of length one has, `weights`, likewise, what those of deflections have of that. Slopes have
    a length more each.
    """
    n, n_beams = lengths.shape
    found = np.zeros((2 * n + 2, _REACH, n_beams))
    by_slopes = (weights, weights * lengths, weights * lengths**2)
    for row in range(_REACH):
        for column in range(row, _REACH):
            share = one[row, column] * by_slopes[row % 2 + column % 2]
            found[row : row + 2 * n : 2, column - row] += share
    return found


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
