"""The lowest eigenvalues of many small pencils of one layout at once, each as certain as if it had been solved alone.

Vectors of a pencil that is alike are taken to all others by a step of inverse iteration and a Rayleigh-Ritz problem
of a few unknowns, then by Rayleigh quotient iteration, each mode of each pencil with its own shift. What comes out is
not trusted but judged (`_settled`): by residuals, by the gaps between the values, and by a count of the eigenvalues
below the last, which finds a mode that was missed. What does not pass is left to who asks.
"""

from collections.abc import Callable

import msgspec
import numpy as np

from verify.models.arrays import Array
from verify.models.band_stack import count_below, product, solution, triangles
from verify.models.eigen import UNLIKE

BESIDE = 4
"""Vectors carried along beside those wanted."""
_STEPS = 4
"""Of Rayleigh quotient iteration at most: each triples the digits of a vector."""
_COLUMNS = 1280
"""Modes of beams that are solved for at once: few enough that their triangles stay near the processor."""
_STILL = 1e-6
"""Relative: what has moved less in a step has come home in it."""
_SURE = 1e-13
"""Relative, of a value: beyond it a pencil has not settled."""
_ABOVE = 0.01
"""How far above the last value eigenvalues are counted, relative."""
_APART = 1e-6
"""Of values, relative: what lies closer is not told apart."""
_NEXT_TO_NOTHING = 1e-70
"""For a pivot that is zero: small beside any, and large enough to be divided by twice."""
_MARGIN = 4.0
"""On a residual, whose own rounding is of the size of that of the assembled matrices."""


class PencilStack(msgspec.Struct, frozen=True, eq=False, kw_only=True):
    """K = B^T diag(d) B and M of many beams, the beam's axis last, in the units of each (`FactoredPencil`)."""

    stiffness: Array
    """K assembled, as bands (n, w + 1, n_beams) (`band_stack`)."""
    mass: Array
    """M, likewise."""
    strain: Callable[[Array], Array]
    """v (n, k, n_beams) -> B v (m, k, n_beams), by differences of differences."""
    springs: Array
    """d, (m, n_beams)."""
    rigid_modes: int
    """How many motions of each have no strain."""
    masses: Callable[[Array], Array] | None = None
    """V (n, k, n_beams) -> v^T M v, (k, n_beams), where M as one matrix would lose digits in it."""


def lowest_of_each(stack: PencilStack, n_modes: int, start: Array) -> tuple[Array, Array]:
    """(the lowest elastic eigenvalues (n_modes, n_beams), which of the beams have settled (n_beams,)).

    `start` (n, k), k >= rigid + `n_modes`, are the lowest vectors of a pencil like these, rigid motions first. Values
    of beams that have not settled mean nothing.
    """
    with np.errstate(all="ignore"):
        try:
            values, vectors = _projected(stack, n_modes, start)
        except np.linalg.LinAlgError:
            n_beams = stack.mass.shape[2]
            return np.full((n_modes, n_beams), np.nan), np.zeros(n_beams, dtype=bool)
        return judged(stack, _homed(stack, values, vectors))


def judged(stack: PencilStack, vectors: Array) -> tuple[Array, Array]:
    """(the values of vectors (n, k, n_beams), ascending, (k, n_beams); which of the beams have settled (n_beams,))."""
    strains, carried = stack.strain(vectors), product(stack.mass, vectors)
    squares = _over_unknowns(vectors, carried)
    masses = stack.masses(vectors) if stack.masses else squares
    values = _over_unknowns(stack.springs[:, None] * strains, strains) / masses
    rest = (product(stack.stiffness, vectors) - values * carried) / np.sqrt(squares)
    residuals = np.sqrt(_over_unknowns(rest, solution(*triangles(stack.mass, stack.mass, np.zeros((1, 1))), rest)))
    order = np.argsort(values, axis=0)
    values, residuals = (np.take_along_axis(each, order, axis=0) for each in (values, residuals))
    return values, _settled(stack, values, _MARGIN * residuals) & ~_unlike(stack)


def _over_unknowns(one: Array, other: Array) -> Array:
    """Sums of products over the first axis."""
    return np.asarray(np.einsum("i...,i...->...", one, other))


def _settled(stack: PencilStack, values: Array, residuals: Array) -> Array:
    """Which beams have their lowest values, all of them and to `_SURE`, (n_beams,).

    An eigenvalue lies within its residual r, in the norm of M^-1, of every value, and within r^2 over its distance to
    the others (Kato and Temple). Values that lie apart so have eigenvalues of their own, and where no more than these
    lie below a little above the last none was missed.
    """
    top = (1.0 + _ABOVE) * values[-1]
    count, moved = count_below(stack.stiffness, stack.mass, top)
    edges = np.concatenate([np.zeros_like(values[:1]), values, top[None]])
    steps = np.diff(edges, axis=0)
    gaps = np.minimum(steps[1:], steps[:-1]) - residuals
    apart = (gaps > _APART * values) & (gaps > 2.0 * residuals) & (residuals**2 <= _SURE * values * gaps)
    sure = (count == len(values) + stack.rigid_modes) & (moved < 0.25 * _ABOVE * values[-1])
    return np.asarray(apart.all(axis=0) & sure)


def _unlike(stack: PencilStack) -> Array:
    """Which beams have parts so unlike that K as a matrix has lost those of the soft, (n_beams,) (`eigen.lowest`)."""
    squares = stack.stiffness[:, 0] / stack.mass[:, 0]
    return np.asarray(~(squares.max(axis=0) <= UNLIKE * squares.min(axis=0)))


def _projected(stack: PencilStack, n_modes: int, start: Array) -> tuple[Array, Array]:
    """Values (n_modes, n_beams) and vectors (n, n_modes, n_beams) after a step of inverse iteration, by Rayleigh-Ritz.

    Where motions are rigid the step is shifted below zero by what the first beam's lowest elastic value is about.
    """
    rigid = stack.rigid_modes
    shift = np.zeros(stack.mass.shape[2])
    if rigid:
        first = start[:, [rigid], None]
        shift[:] = (first * product(stack.stiffness, first)).sum(axis=0) / (first * product(stack.mass, first)).sum(axis=0)
    grounded = triangles(stack.stiffness, stack.mass, -shift[None])
    found = solution(*grounded, product(stack.mass, start[:, :, None]))
    rows, heavy = (np.ascontiguousarray(each.transpose(2, 1, 0)) for each in (found, product(stack.mass, found)))
    energies, weights = heavy @ start, rows @ heavy.transpose(0, 2, 1)
    inverse = np.linalg.inv(np.linalg.cholesky(weights))
    values, mixed = np.linalg.eigh(inverse @ energies @ inverse.transpose(0, 2, 1))
    wanted = mixed[:, :, rigid : rigid + n_modes]
    vectors = (inverse.transpose(0, 2, 1) @ wanted).transpose(0, 2, 1) @ rows
    return (values.T - shift)[rigid : rigid + n_modes], np.ascontiguousarray(vectors.transpose(2, 1, 0))


def _homed(stack: PencilStack, values: Array, vectors: Array) -> Array:
    """Vectors (n, k, n_beams) by Rayleigh quotient iteration of every mode of every beam until its value stands still.

    B. N. Parlett, The Symmetric Eigenvalue Problem (1980), ch. 4.
    """
    vectors, moved = _stepped(stack.stiffness, stack.mass, values, vectors)
    for _ in range(_STEPS - 1):
        values = values + moved
        mode, beam = np.nonzero(abs(moved) > _STILL * values)
        if not len(mode):
            break
        bands = (stack.stiffness[..., beam], stack.mass[..., beam])
        found, step = _stepped(*bands, values[mode, beam][None], vectors[:, None, mode, beam])
        vectors[:, mode, beam] = found[:, 0]
        moved = np.zeros_like(values)
        moved[mode, beam] = step[0]
    return vectors


def _stepped(stiffness: Array, mass: Array, values: Array, vectors: Array) -> tuple[Array, Array]:
    """A step of it: vectors (n, k, c), v^T M v = 1, and by how much the values (k, c) move."""
    at_once = max(_COLUMNS // values.shape[1], 1)
    found, moved = np.empty_like(vectors), np.empty_like(values)
    for first in range(0, len(values), at_once):
        some = slice(first, first + at_once)
        load = product(mass, vectors[:, some])
        pivots, lower = triangles(stiffness, mass, values[some])
        pivots[pivots == 0.0] = _NEXT_TO_NOTHING  # at an eigenvalue to the last digit
        part = solution(pivots, lower, load.reshape(len(load), 1, -1)).reshape(load.shape)
        squares = _over_unknowns(part, product(mass, part))
        moved[some] = _over_unknowns(part, load) / squares
        np.divide(part, np.sqrt(squares), out=found[:, some])
    return found, moved
