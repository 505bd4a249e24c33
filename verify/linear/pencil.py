"""A pencil of B^T diag(d) B against M kept as its factors: its quotient to rounding, and what is factorised of it.

An assembled K = B^T diag(d) B drowns its low eigenvalues in the rounding of its high ones, like n^4 eps for a
beam. Here K stays factored: whatever finds the vectors, each eigenvalue is read from
sum d (B v)^2 / (v^T M v) with B applied as differences of differences, each nearly exact.
"""

from collections.abc import Callable
from math import log2
from typing import Any

import msgspec
import numpy as np

from verify.arrays import Array, Indices
from verify.errors import InputError

DENSE_UNKNOWNS = 250
"""Up to here a dense solver is faster than a sparse one and its vectors are good enough for the quotient."""
LARGE = 20_000
"""Unknowns from which on vectors are solved for once more: the factors leave a noise of n^2 eps in their strains, whose
square would be 1e-9 of the eigenvalues of a million parts, and was 1e-12 of those of 20 000 free elements."""

_RESTARTS = 10, 100
"""Of Lanczos, the fewest and the most after which it is given up: ordinary modes take one."""
_RESTARTED = 5e5
"""Unknowns times restarts, about: of some thirty solves each that is a few seconds."""
_SLOWEST = 2.0**-200
"""Omega^2 below which no unit grows."""


class FactoredPencil(msgspec.Struct, frozen=True, eq=False, kw_only=True):
    """K = B^T diag(d) B and M over n unknowns, in units of order one (element length, stiffness and mass 1)."""

    n: int
    """Unknowns."""
    rigid: Array
    """(n, r), r independent motions without strain; their zero eigenvalues are left out."""
    strain: Callable[[Array], Array]
    """v (n, k) -> B v (m, k), by differences of differences."""
    stiffness: Array
    """d, (m,), positive but for what an axial force takes (`uneven` then)."""
    strain_matrix: Callable[[], Any]
    """() -> B as a sparse array (m, n); asked for only where a factorisation needs it."""
    mass_matrix: Callable[[], Any]
    """() -> M as a sparse array (n, n) above DENSE_UNKNOWNS, dense up to it."""
    masses: Callable[[Array], Array] | None = None
    """V (n, k) -> v^T M v, (k,), where M as one matrix would lose digits in it."""
    below: float = 0.0
    """What all eigenvalues lie above, rigid motions none: a stiff foundation lifts them to where they lie close."""
    bending: float = 0.0
    """About the lowest eigenvalue of what bends (`inverse.first_bending`), which tells what is slow; 0: not known."""
    bands: list[Any] = msgspec.field(default_factory=list)
    """The band of the driven pencil, None where it is not narrow, once it was asked for."""
    turned: list[Any] = msgspec.field(default_factory=list)
    """What `transposed` gives, once it was asked for."""
    bases: list[tuple[Array, Array]] = msgspec.field(default_factory=list)
    """All modes of it, sharp ones, once they were asked for (`driven_pencil.receptance_basis`)."""
    rough_bases: list[tuple[Array, Array]] = msgspec.field(default_factory=list)
    """The same where sharp ones are not had."""
    uneven: bool = False
    """Whether d spans many powers of ten or both signs, so that dense vectors are found from the inverse of K."""

    @property
    def rigid_modes(self) -> int:
        """R, how many motions have no strain."""
        return int(self.rigid.shape[1])

    def transposed(self) -> Any:
        """B^T as a sparse array (n, m) by rows."""
        if not self.turned:
            self.turned.append(self.strain_matrix().T.tocsr())
        return self.turned[0]


def factored_quotient(pencil: FactoredPencil, vectors: Array, strains: Array | None = None) -> tuple[Array, Array]:
    """Rayleigh quotients sum d (B v)^2 / v^T M v, (k,), and the vectors scaled to v^T M v = 1, (n, k).

    `strains` (m, k) are B v where they are known better than the vectors' own digits tell.
    """
    strains = pencil.strain(vectors) if strains is None else strains
    masses = pencil.masses(vectors) if pencil.masses else weighed_squares(vectors, pencil.mass_matrix())
    if len(vectors) < LARGE:
        values = np.einsum("i,ij,ij->j", pencil.stiffness, strains, strains) / masses
    else:
        values = _in_pairs(pencil.stiffness[:, None] * strains**2) / masses
    return values, vectors / np.sqrt(masses)


def weighed_squares(vectors: Array, matrix: Any) -> Array:
    """V^T M v of every column, (k,)."""
    carried = matrix @ vectors
    if len(vectors) < LARGE:
        return np.asarray(np.einsum("ij,ij->j", vectors, carried))
    return _in_pairs(vectors * carried)


def _in_pairs(products: Array) -> Array:
    """Sums of columns, (k,), pairwise: a million terms one after another leave 1e-12 of their sum."""
    return np.asarray(np.ascontiguousarray(products.T).sum(axis=1))


def mixed_matrix(pencil: FactoredPencil, below: float = 0.0, unit: float = 1.0) -> tuple[Any, Indices]:
    """([[-s^2/(u d), s B], [B^T s, -below u M]] as a sparse array, the unknowns in it): K - below M with its strains.

    Where it is K alone and motions are rigid, as many unknowns are grounded as make the matrix regular. s are the
    `soft_scales` of u d, and u is the `unit` of the unknowns (`swing`). Raises InputError for d by which
    1 cannot be divided.
    """
    from scipy.sparse import csc_array

    grounds = [] if below else _grounds(pencil.rigid)
    free: Indices = np.delete(np.arange(pencil.n, dtype=np.intp), grounds)
    strain = pencil.strain_matrix()
    # None, not stored zeros: they would cost three times the solve
    corner = -below * unit * csc_array(pencil.mass_matrix()) if below else None
    with np.errstate(over="ignore"):
        given = -1.0 / (unit * pencil.stiffness)
    if not np.isfinite(given).all():
        least = abs(pencil.stiffness).min()
        raise InputError(
            f"the beam is held by {least / abs(pencil.stiffness).max():.0e} of its own stiffness: "
            "floating point cannot divide by it, hold the beam better or leave that out"
        )
    return bordered(given, strain[:, free] if grounds else strain, corner), free


def swing(omega2: float) -> float:
    """About 1/omega, a power of two: the unit of unknowns in which a mixed matrix keeps what is slow (`response`)."""
    return float(2.0 ** round(-0.5 * log2(max(omega2, _SLOWEST))))


def soft_scales(stiffness: Array) -> Array:
    """Powers of two, (m,), by which rows of strains that d (m,) holds softly come to the size of their diagonal, 1.

    An endless 1/d beside others would be lost to what is eliminated by that row, and take the others along.
    """
    return np.asarray(np.exp2(np.minimum(np.round(0.5 * np.log2(abs(stiffness))), 0.0)))


def bordered(diagonal: Any, strain: Any, corner: Any = None) -> Any:
    """[[s^2 diag(diagonal), s B], [B^T s, corner]] as one sparse array by columns; B (m, n), the corner (n, n) sparse.

    s are `soft_scales` of 1 / diagonal (m,).
    """
    from scipy.sparse import block_array, diags_array

    scales = soft_scales(1.0 / diagonal)
    scaled = diags_array(scales) @ strain
    return block_array([[diags_array(diagonal * scales**2), scaled], [scaled.T, corner]], format="csc")


def _grounds(rigid: Array) -> list[int]:
    """Unknowns that, held, leave no rigid motion: the largest entry of each motion, the earlier ones taken out."""
    motions, grounds = rigid.copy(), []
    for j in range(motions.shape[1]):
        ground = int(abs(motions[:, j]).argmax())
        grounds.append(ground)
        motions[:, j + 1 :] -= np.outer(motions[:, j] / motions[ground, j], motions[ground, j + 1 :])
    return grounds


def factorised(matrix: Any, remedy: str = "hold the beam better or choose another count") -> Any:
    """The sparse LU factors of a matrix.

    Raises InputError where memory does not suffice, and with a remedy where the matrix is singular.
    """
    from scipy.sparse.linalg import splu

    try:
        return splu(matrix)
    except (MemoryError, RuntimeError) as error:
        if "singular" in str(error):
            raise InputError(f"the system is singular to rounding: {remedy}") from None
        raise too_large(matrix.shape[0]) from None


def restarts(n_unknowns: int) -> int:
    """How often Lanczos begins anew at most: where values lie closer together than it can tell, it never ends."""
    least, most = _RESTARTS
    return int(min(max(_RESTARTED / n_unknowns, least), most))


def too_large(n_unknowns: int) -> InputError:
    """What is raised where memory does not suffice."""
    return InputError(f"count: {n_unknowns} unknowns do not fit into memory, lower it")
