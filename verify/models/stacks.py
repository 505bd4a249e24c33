"""The lowest eigenvalues of many small pencils of one layout at once, each as certain as if it had been solved alone.

Vectors of a pencil that is alike are taken to all others by a step of inverse iteration and a Rayleigh-Ritz problem
of a few unknowns, then by Rayleigh quotient iteration, each mode of each pencil with its own shift. Where modes are
many and bands narrow, counts tell the shifts (`isolated`) and any vector is taken to them. What comes out is not
trusted but judged: by residuals of the factored K, by the gaps between the values, and by a count of the eigenvalues
below the last, which finds a mode that was missed. What does not pass is left to who asks.
"""

from collections.abc import Callable

import msgspec
import numpy as np

from verify.models.arrays import Array, BoolArray
from verify.models.band_stack import count_below, product, solution, triangles
from verify.models.isolated import isolated

_STEPS = 4
"""Of Rayleigh quotient iteration at most: each triples the digits of a vector."""
_COLUMNS = 2000
"""Modes of beams that are solved for at once: few enough that their triangles stay near the processor."""
_LEVEL = 1e-3
"""Of the highest value carried along: the least that is inverted, so that vectors stay apart in one step."""
_STILL = 1e-9
"""Of a value: a residual that a step need not lower."""
_SURE = 1e-13
"""Relative, of a value: beyond it a pencil has not settled."""
_MANY, _NARROW = 12, 4
"""Modes from which on, and diagonals up to which, counts tell where values lie in less time than a projection."""
_UNLIKE = 1e6
"""Of K_ii / M_ii."""
_APART = 1e-6
"""Of values, relative: what lies closer is not told apart."""
_NEXT_TO_NOTHING = 1e-70
"""For a pivot that is zero: small beside any, and large enough to be divided by twice."""
_CAUTION = 10.0
"""Times the rounding of a row of a factorisation."""


class PencilStack(msgspec.Struct, frozen=True, eq=False, kw_only=True):
    """K = B^T diag(d) B and M of many beams, the beam's axis last, in the units of each (`FactoredPencil`)."""

    stiffness: Array
    """K assembled, as bands (n, w + 1, n_beams) (`band_stack`)."""
    mass: Array
    """M, likewise."""
    strain: Callable[[Array], Array]
    """v (n, k, n_beams) -> B v (m, k, n_beams), by differences of differences."""
    loads: Callable[[Array], Array]
    """Forces in the strains (m, k, n_beams) -> B^T q (n, k, n_beams), likewise."""
    springs: Array
    """d, (m, n_beams)."""
    rigid_modes: int
    """How many motions of each have no strain."""
    masses: Callable[[Array], Array] | None = None
    """V (n, k, n_beams) -> v^T M v, (k, n_beams), where M as one matrix would lose digits in it."""


def carried_along(n_modes: int, available: int) -> tuple[tuple[int, int], ...]:
    """(how many vectors, how many steps of inverse iteration) to try one after another; none of too many modes.

    Vectors beside those that are wanted cost less than steps: with half as many again, one step leaves next to none of
    stepped beams of which a quarter leaves one in twenty, and twice as many do where modes lie close together, as those
    of thick beams.
    """
    if 3 * (n_modes + n_modes // 4 + 3) > 2 * available:
        return ()
    most = 5 * available // 6
    return (min(n_modes + n_modes // 2 + 4, most), 1), (min(2 * n_modes + 6, most), 2)


class Ground(msgspec.Struct, frozen=True, eq=False):
    """K + tau M of a stack as triangles: regular where motions are rigid, and no step drowns all in the lowest mode."""

    tau: Array
    """(n_beams,)."""
    triangles: tuple[Array, Array]

    def solve(self, loads: Array) -> Array:
        """Its inverse times loads, (n, k, n_beams)."""
        return solution(*self.triangles, loads)


def lowest_of_each(stack: PencilStack, n_modes: int, start: Array, n_inverted: int = 1) -> tuple[Array, BoolArray]:
    """(the lowest elastic eigenvalues (n_modes, n_beams), which of the beams have settled (n_beams,)).

    `start` (n, k), k > rigid + `n_modes`, are the lowest vectors of a pencil like these, rigid motions first;
    `n_inverted` steps of inverse iteration are taken. Values of beams that have not settled mean nothing.
    """
    with np.errstate(all="ignore"):
        ground = grounded(stack, start)
        if n_modes >= _MANY and stack.mass.shape[1] <= _NARROW and n_inverted == 1:
            values = isolated(stack.stiffness, stack.mass, stack.rigid_modes, n_modes + 1)
            vectors = start[:, stack.rigid_modes : stack.rigid_modes + n_modes, None]
        else:
            values, vectors = _projected(stack, ground, n_modes, start, n_inverted)
        return judged(stack, ground, *_homed(stack, values[:-1], vectors), 0.5 * (values[-2] + values[-1]))


def grounded(stack: PencilStack, start: Array) -> Ground:
    """A stack with K + tau M, by the value of the last vector of `start`."""
    last = start[:, -1:, None]
    energy, mass = (_over_unknowns(last, product(bands, last)) for bands in (stack.stiffness, stack.mass))
    tau = _LEVEL * energy / mass
    return Ground(tau[0], triangles(stack.stiffness, stack.mass, -tau))


def judged(stack: PencilStack, ground: Ground, vectors: Array, carried: Array, top: Array) -> tuple[Array, BoolArray]:
    """(the values of vectors V, ascending, (k, n_beams); which of the beams have settled (n_beams,)).

    V and `carried`, M V, are (n, k, n_beams); `top`, (n_beams,), is where there is thought to be none between the last
    value and the next.
    """
    strains = stack.strain(vectors)
    squares = _over_unknowns(vectors, carried)
    masses = stack.masses(vectors) if stack.masses else squares
    forces = stack.springs[:, None] * strains
    values = _over_unknowns(forces, strains) / masses
    rest = (stack.loads(forces) - values * carried) / np.sqrt(squares)
    residuals = np.sqrt(_over_unknowns(rest, ground.solve(rest)) / (values + ground.tau))
    order = np.argsort(values, axis=0)
    values, residuals = (np.take_along_axis(each, order, axis=0) for each in (values, residuals))
    sure = _sure(ground, values, residuals, top) & _alike(stack)
    return values, sure & _counted(stack, ground, values, vectors / np.sqrt(squares), top)


def _alike(stack: PencilStack) -> BoolArray:
    """Whose parts are alike enough for K as a matrix, (n_beams,): of others A has lost what residuals are told by."""
    squares = stack.stiffness[:, 0] / stack.mass[:, 0]
    return np.asarray(squares.max(axis=0) <= _UNLIKE * squares.min(axis=0), dtype=bool)


def _over_unknowns(one: Array, other: Array) -> Array:
    """Sums of products over the first axis."""
    return np.asarray(np.einsum("i...,i...->...", one, other))


def _sure(ground: Ground, values: Array, residuals: Array, top: Array) -> BoolArray:
    """Whose values are eigenvalues to `_SURE`, each another one, (n_beams,), if none but they lie below `top`.

    With A = K + tau M, an eigenvalue of A^-1 M lies within its residual r, in the norm of A and relative, of that of
    every vector, and within r^2 over its distance to the others (Kato and Temple); in the norm of M^-1 the residual of
    short parts would be rounding alone. Values that lie apart so have eigenvalues of their own.
    """
    lifted = ground.tau + np.concatenate([values, top[None]])
    steps = np.diff(lifted, axis=0) / lifted[1:]
    gaps = np.minimum(steps, np.concatenate([values[:1] / ground.tau, steps[:-1]])) - residuals
    sharp = residuals**2 <= _SURE * gaps * (values / lifted[:-1])
    return np.asarray((sharp & (gaps > _APART) & (gaps > 2.0 * residuals)).all(axis=0), dtype=bool)


def _counted(stack: PencilStack, ground: Ground, values: Array, vectors: Array, top: Array) -> BoolArray:
    """Whose eigenvalues below `top` are as many as `values`, by a margin that rounding leaves, (n_beams,).

    Vectors (n, k, n_beams) have v^T M v = 1: what rounding does to K moves an eigenvalue by as much as it does to the
    energy of its vector.
    """
    count, grown = count_below(stack.stiffness, stack.mass, top)
    rows = 2 * stack.mass.shape[1] - 1
    moved = _CAUTION * rows * np.finfo(float).eps * np.einsum("in,ikn,ikn->kn", grown, vectors, vectors).max(axis=0)
    clear = moved < 0.1 * np.minimum(top - values[-1], values[0] + ground.tau)
    return np.asarray((count == len(values) + stack.rigid_modes) & clear, dtype=bool)


def _projected(stack: PencilStack, ground: Ground, n_modes: int, start: Array, n_inverted: int) -> tuple[Array, Array]:
    """Vectors (n, n_modes, n_beams) after steps of inverse iteration by Rayleigh-Ritz, values with the one above."""
    rows, first = start.T[None], stack.rigid_modes
    for _ in range(n_inverted):
        found = ground.solve(product(stack.mass, rows.transpose(2, 1, 0)))
        before, heavy = rows, _rows(product(stack.mass, found))
        rows = _rows(found)
        inverse = np.linalg.inv(_lower(rows @ heavy.transpose(0, 2, 1)))
        energies = inverse @ (heavy @ before.transpose(0, 2, 1)) @ inverse.transpose(0, 2, 1)
        lost = ~np.isfinite(energies).all(axis=(1, 2))
        energies[lost] = np.eye(energies.shape[1])
        values, mixed = np.linalg.eigh(energies)
        rows = (mixed.transpose(0, 2, 1) @ inverse) @ rows
    vectors = np.ascontiguousarray(rows[:, first : first + n_modes].transpose(2, 1, 0))
    return values.T[first : first + n_modes + 1] - ground.tau, vectors


def _lower(grams: Array) -> Array:
    """The Cholesky factors of matrices (n_beams, k, k); of one that has lost its sign in rounding the unit matrix.

    That beam will not settle, and takes none of the others with it.
    """
    try:
        return np.asarray(np.linalg.cholesky(grams))
    except np.linalg.LinAlgError:
        if len(grams) == 1:
            return np.eye(grams.shape[1])[None]
        half = len(grams) // 2
        return np.concatenate([_lower(grams[:half]), _lower(grams[half:])])


def _rows(vectors: Array) -> Array:
    """(n, k, n_beams) -> (n_beams, k, n), in a row of memory."""
    return np.ascontiguousarray(vectors.transpose(2, 1, 0))


def _homed(stack: PencilStack, values: Array, vectors: Array) -> tuple[Array, Array]:
    """(V, M V) (n, k, n_beams) by Rayleigh quotient iteration of every mode of every beam, from vectors of all or each.

    B. N. Parlett, The Symmetric Eigenvalue Problem (1980), ch. 4.
    """
    pair, values, residuals = _stepped(stack.stiffness, stack.mass, values, product(stack.mass, vectors), vectors)
    for _ in range(_STEPS - 1):
        mode, beam = np.nonzero(residuals > _STILL * values)
        if not len(mode):
            break
        stiffness, mass = (np.take(bands, beam, axis=2) for bands in (stack.stiffness, stack.mass))
        own = [each[:, None, mode, beam] for each in pair]
        found, at, left = _stepped(stiffness, mass, values[mode, beam][None], own[1], own[0])
        for each, one in zip(pair, found, strict=True):
            each[:, mode, beam] = one[:, 0]
        residuals = np.zeros_like(values)
        values[mode, beam], residuals[mode, beam] = at[0], left[0]
    return pair


def _stepped(
    stiffness: Array, mass: Array, values: Array, loads: Array, vectors: Array
) -> tuple[tuple[Array, Array], Array, Array]:
    """A step of it from vectors V and M V, (n, k, c) or of all alike: (V, M V), v^T M v = 1, values, residuals (k, c).

    What is left of (K - value M) v is told in the norm of M^-1 by V before and after.
    """
    at_once = max(_COLUMNS // values.shape[1], 1)
    found, heavy = (np.empty((len(mass), *values.shape)) for _ in range(2))
    quotients, residuals = np.empty_like(values), np.empty_like(values)
    for first in range(0, len(values), at_once):
        some = slice(first, first + at_once)
        load, shifts = loads[:, some], values[some]
        pivots, lower = triangles(stiffness, mass, shifts)
        pivots[pivots == 0.0] = _NEXT_TO_NOTHING  # at an eigenvalue to the last digit
        part = solution(pivots, lower, load.reshape(len(load), 1, -1)).reshape(load.shape)
        carried = product(mass, part)
        squares = _over_unknowns(part, carried)
        moved = _over_unknowns(part, load) / squares
        before = _over_unknowns(vectors[:, some], load) / squares
        residuals[some] = np.sqrt(np.maximum(before - moved * moved, 0.0))
        quotients[some] = shifts + moved
        size = 1.0 / np.sqrt(squares)
        np.multiply(part, size, out=found[:, some])
        np.multiply(carried, size, out=heavy[:, some])
    return (found, heavy), quotients, residuals
