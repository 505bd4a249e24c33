"""The lowest eigenvalues of many small pencils of one layout at once, each as certain as if it had been solved alone.

Counts and determinants tell a shift for each mode of each pencil (`isolated`), two steps of inverse iteration take any
load to its vector, and Rayleigh quotient iteration those that are not there yet. What comes out is not trusted but
judged: by residuals of the factored K, by the gaps between the values, and by a count of the eigenvalues below the
last, which finds a mode that was missed. What does not pass is left to who asks.
"""

from collections.abc import Callable, Sequence

import msgspec
import numpy as np

from verify.models.arrays import Array, BoolArray
from verify.models.band_stack import Factors, Pencils, factorised, in_parts, regular
from verify.models.isolated import between, isolated

_STEPS = 3
"""Of Rayleigh quotient iteration at most: each triples the digits of a vector."""
_LEVEL = 1e-3
"""Of the place above the last value: what K is grounded by, so that it is regular where motions are rigid."""
_STILL = 1e-17
"""Of a value: what a residual may leave of it to be off by, without a step that lowers it."""
_SURE = 1e-13
"""Relative, of a value: beyond it a pencil has not settled."""
_UNLIKE = 1e6
"""Of K_ii / M_ii."""
_APART = 1e-6
"""Of values, relative: what lies closer is not told apart."""
_CAUTION = 10.0
"""Times the rounding of a row of a factorisation."""


class PencilStack(msgspec.Struct, frozen=True, eq=False, kw_only=True):
    """K = B^T diag(d) B and M of many beams, the beam's axis last, in the units of each (`FactoredPencil`)."""

    pencils: Pencils
    """K and M assembled, as bands and what bodies add to them."""
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


def lowest_of_each(stack: PencilStack, n_modes: int) -> tuple[Array, BoolArray]:
    """(the lowest elastic eigenvalues (n_modes, n_beams), which of the beams have settled (n_beams,)).

    Values of beams that have not settled mean nothing.
    """
    with np.errstate(all="ignore"):
        values = isolated(stack.pencils, stack.rigid_modes, n_modes + 1)
        top = 0.5 * (values[-2] + values[-1])
        return judged(stack, *_homed(stack.pencils, values[:-1]), top)


def judged(stack: PencilStack, vectors: Array, carried: Array, top: Array) -> tuple[Array, BoolArray]:
    """(the values of vectors V, ascending, (k, n_beams); which of the beams have settled (n_beams,)).

    V and `carried`, M V, are (n, k, n_beams); `top`, (n_beams,), is where there is thought to be none between the last
    value and the next.
    """
    tau = _LEVEL * top
    ground, above = (factorised(stack.pencils, shift[None]) for shift in (-tau, top))
    strains = stack.strain(vectors)
    squares = _over_unknowns(vectors, carried)
    masses = stack.masses(vectors) if stack.masses else squares
    forces = stack.springs[:, None] * strains
    values = _over_unknowns(forces, strains) / masses
    rest = stack.loads(forces) - values * carried
    residuals = np.sqrt(ground.energy(rest) / squares / (values + tau))
    order = np.argsort(values, axis=0)
    values, residuals = (np.take_along_axis(each, order, axis=0) for each in (values, residuals))
    moved = _moved(stack.pencils, above, vectors, squares)
    told_apart = moved < 0.1 * np.minimum(top - values[-1], values[0] + tau)
    counted = (above.below == len(values) + stack.rigid_modes) & told_apart
    return values, np.asarray(_sure(tau, values, residuals, top) & _alike(stack) & counted, dtype=bool)


def _alike(stack: PencilStack) -> BoolArray:
    """Whose parts are alike enough for K as a matrix, (n_beams,): of others A has lost what residuals are told by."""
    stiffness, mass = stack.pencils.diagonals
    squares = stiffness / mass
    return np.asarray(squares.max(axis=0) <= _UNLIKE * squares.min(axis=0), dtype=bool)


def _over_unknowns(one: Array, other: Array) -> Array:
    """Sums of products over the first axis."""
    return np.asarray(np.einsum("i...,i...->...", one, other))


def _sure(tau: Array, values: Array, residuals: Array, top: Array) -> BoolArray:
    """Whose values are eigenvalues to `_SURE`, each another one, (n_beams,), if none but they lie below `top`.

    With A = K + tau M, an eigenvalue of A^-1 M lies within its residual r, in the norm of A and relative, of that of
    every vector, and within r^2 over its distance to the others (Kato and Temple); in the norm of M^-1 the residual of
    short parts would be rounding alone. Values that lie apart so have eigenvalues of their own.
    """
    lifted = tau + np.concatenate([values, top[None]])
    steps = np.diff(lifted, axis=0) / lifted[1:]
    gaps = np.minimum(steps, np.concatenate([values[:1] / tau, steps[:-1]])) - residuals
    sharp = residuals**2 <= _SURE * gaps * (values / lifted[:-1])
    return np.asarray((sharp & (gaps > _APART) & (gaps > 2.0 * residuals)).all(axis=0), dtype=bool)


def _moved(pencils: Pencils, factors: Factors, vectors: Array, squares: Array) -> Array:
    """How far rounding of the factors of a stack moves its eigenvalues, at most, (n_beams,).

    `squares` are v^T M v, (k, n_beams). What rounding does to K moves an eigenvalue by as much as it does to the energy
    of its vector, with the motions of bodies beside it.
    """
    rows, grown, n = 2 * (pencils.stiffness.shape[1] + len(pencils.held)) - 1, factors.grown, len(vectors)
    beside = factors.roots[:, None] * np.einsum("irn,ikn->rkn", pencils.felt, vectors)
    shares = np.einsum("in,ikn,ikn->kn", grown[:n], vectors, vectors)
    shares += np.einsum("rn,rkn,rkn->kn", grown[n:], beside, beside)
    return np.asarray(_CAUTION * rows * np.finfo(float).eps * (shares / squares).max(axis=0))


def _homed(pencils: Pencils, shifts: Array) -> tuple[Array, Array]:
    """(V, M V), (n, k, n_beams), of the modes next to shifts (k, n_beams).

    Two steps of inverse iteration, then Rayleigh quotient iteration of those that need it: B. N. Parlett, The Symmetric
    Eigenvalue Problem (1980), ch. 4.
    """
    parts = [_stepped(pencils, some) for some in in_parts(pencils, shifts)]
    vectors, carried, values, residuals = map(_beside, zip(*parts, strict=True))
    for _ in range(_STEPS):
        mode, beam = np.nonzero(residuals**2 > _STILL * values * between(values))
        if not len(mode):
            break
        found, heavy, at, left = _stepped(pencils.of_beams(beam), values[None, mode, beam])
        vectors[:, mode, beam], carried[:, mode, beam] = found[:, 0], heavy[:, 0]
        values[mode, beam], residuals[mode, beam] = at[0], left[0]
    return vectors, carried


def _beside(parts: Sequence[Array]) -> Array:
    """Parts of the modes together; of one, without a copy."""
    return parts[0] if len(parts) == 1 else np.concatenate(parts, axis=-2)


def _stepped(pencils: Pencils, shifts: Array) -> tuple[Array, Array, Array, Array]:
    """Two steps of inverse iteration from any load: (V, M V, (n, k, c), values, residuals (k, c)).

    What is left of (K - value M) v is told in the norm of M^-1 by V before and after the second of them.
    """
    factors = regular(factorised(pencils, shifts))

    def carried_by(vectors: Array) -> tuple[Array, Array]:
        carried = pencils.weighed(vectors.reshape(-1, *shifts.shape))
        return carried, _over_unknowns(vectors.reshape(carried.shape), carried)

    some = np.random.default_rng(4276).standard_normal((len(factors.beside), 1, 1))
    load, before = carried_by(factors.solve(np.broadcast_to(some, (len(some), 1, shifts.size))))
    found = factors.solve(load.reshape(len(load), 1, -1))
    carried, squares = carried_by(found)
    vectors = found.reshape(carried.shape)
    moved = _over_unknowns(vectors, load) / squares
    residuals = np.sqrt(np.maximum(before / squares - moved * moved, 0.0))
    return vectors, carried, shifts + moved, residuals
