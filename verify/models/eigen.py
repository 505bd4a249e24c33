"""Eigenvalues of B^T diag(d) B against M, to rounding, at any size.

An assembled K = B^T diag(d) B drowns its low eigenvalues in the rounding of its high ones, like n^4 eps for a
beam. Here K stays factored: whatever finds the vectors, each eigenvalue is read from
sum d (B v)^2 / (v^T M v) with B applied as differences of differences, each nearly exact.
"""

from collections.abc import Callable
from typing import Any

import msgspec
import numpy as np

from verify.errors import InputError
from verify.models.arrays import Array, ComplexArray, Indices
from verify.models.banded import band_of
from verify.patience import check_work

DENSE_UNKNOWNS = 250
"""Up to here a dense solver is faster than a sparse one and its vectors are good enough for the quotient."""
_LANCZOS = 1e-10
"""Where Lanczos stops: the error of a vector enters the quotient squared."""
_UNLIKE = 1e5
"""Of K_ii / M_ii: between parts so unlike, graded or stepped, assembling drowns what is soft."""
_HEAVY = 1e6
"""Of two masses: from there on modes are found one by one, since the slow motion of the heavy one drowns the others."""
_SAME = 0.9
"""Cosine of two vectors that are one mode."""
_HOMING = 3
"""Steps to a mode that is nearly known, each the cube of the one before."""
_POLISHED = 50_000
"""Unknowns from which on vectors are solved for once more: the factors leave a noise of n^2 eps in their strains, whose
square would be 1e-9 of the eigenvalues of a million parts."""
_BYTES_PER_UNKNOWN = 2000
"""Of the sparse factorisation and its matrices, beside the Lanczos basis (measured peaks at 3e5 parts in all: 1300
for modes, 2230 for a driven field, which counts as one mode and 700 of basis)."""


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
    bands: list[Any] = msgspec.field(default_factory=list)
    """The band of the driven pencil, None where it is not narrow, once it was asked for."""
    bases: list[tuple[Array, Array]] = msgspec.field(default_factory=list)
    """All modes of it, once they were asked for (`driven_pencil.receptance_basis`)."""
    uneven: bool = False
    """Whether d spans many powers of ten or both signs, so that dense vectors are found from the inverse of K."""

    @property
    def rigid_modes(self) -> int:
        """R, how many motions have no strain."""
        return int(self.rigid.shape[1])


class Eigenpairs(msgspec.Struct, frozen=True, eq=False, kw_only=True):
    """Elastic eigenpairs, ascending."""

    values: Array
    """(k,), lambda = omega^2 in the pencil's units."""
    vectors: Array
    """(n, k), v^T M v = 1."""
    method: str
    """How they were found."""


def check_size(n_unknowns: int, n_modes: int, available: int, field: str, count: int) -> None:
    """Raise InputError, before anything large is allocated, where modes, memory or time do not suffice.

    `available` is the number of elastic modes the model has; `field` and `count` name what the user chose.
    """
    if n_modes > available:
        raise InputError(
            f"n_modes = {n_modes!r} is more than the {available} elastic modes that {field} = {count} gives: "
            f"ask for fewer modes or raise {field}"
        )
    needed = required_bytes(n_unknowns, n_modes)
    if needed > (memory := _memory_bytes()):
        raise InputError(
            f"{field} = {count} needs about {needed / 2**30:.3g} GiB and this machine has "
            f"{memory / 2**30:.3g} GiB: lower {field}"
        )
    check_work(field, count, solve_seconds(n_unknowns, n_modes), f"lower {field} or the number of modes")


def uses_dense(n_unknowns: int, n_modes: int) -> bool:
    """Whether a dense solver is used: few unknowns, or a good part of all modes wanted."""
    return n_unknowns <= DENSE_UNKNOWNS or 4 * n_modes > n_unknowns


def required_bytes(n_unknowns: int, n_modes: int) -> int:
    """An estimate from above of the memory a solve takes."""
    if uses_dense(n_unknowns, n_modes):
        return 8 * 8 * n_unknowns**2
    return n_unknowns * (_BYTES_PER_UNKNOWN + 8 * 4 * (2 * n_modes + 20))


def solve_seconds(n_unknowns: int, n_modes: int) -> float:
    """An estimate from above of the time a solve takes: n^3 where it is dense, else what each Lanczos vector costs."""
    if uses_dense(n_unknowns, n_modes):
        return 1e-9 * n_unknowns**3
    return n_unknowns * (1e-5 + 8e-7 * n_modes)


def _memory_bytes() -> int:
    """Physical memory of this machine."""
    import os

    return os.sysconf("SC_PHYS_PAGES") * os.sysconf("SC_PAGE_SIZE")


def method_name(n_unknowns: int, n_modes: int, uneven: bool = False) -> str:
    """How `lowest` will find the vectors; every value is then read from the factored quotient."""
    if uneven and uses_dense(n_unknowns, n_modes):
        return "dense inverse"
    if n_unknowns <= DENSE_UNKNOWNS:
        return "dense"
    return "dense SVD" if uses_dense(n_unknowns, n_modes) else "sparse"


def lowest(pencil: FactoredPencil, n_modes: int) -> Eigenpairs:
    """The lowest `n_modes` elastic eigenpairs. The caller has checked the size with `check_size`."""
    strains, inverted = None, pencil.uneven
    if inverted and uses_dense(pencil.n, n_modes):
        vectors = _inverse_vectors(pencil, n_modes)
    elif pencil.n <= DENSE_UNKNOWNS:
        stiffness, mass = _assembled(pencil)
        inverted = _is_unlike(stiffness, mass)
        vectors = _inverse_vectors(pencil, n_modes) if inverted else _dense_vectors(pencil, n_modes, stiffness, mass)
    elif uses_dense(pencil.n, n_modes):
        vectors = _svd_vectors(pencil, n_modes)
    else:
        vectors, strains = _sparse_vectors(pencil, n_modes)
    if _is_heavy(pencil):
        vectors, strains = _homed(pencil, vectors), None
    return _in_order(pencil, vectors, method_name(pencil.n, n_modes, inverted), strains)


def _in_order(pencil: FactoredPencil, vectors: Array, method: str, strains: Array | None = None) -> Eigenpairs:
    """The pairs of vectors (n, k), their values read from the factored quotient; `strains` as there."""
    values, vectors = factored_quotient(pencil, vectors, strains)
    order = np.argsort(values, kind="stable")
    return Eigenpairs(values=values[order], vectors=vectors[:, order], method=method)


def _is_heavy(pencil: FactoredPencil) -> bool:
    """Whether something on the beam weighs far more than the parts of it."""
    masses = np.sort(pencil.mass_matrix().diagonal())
    half = len(masses) // 2  # np.median would wake numpy.ma, which takes longer than the figure
    return bool(masses[-1] > _HEAVY * 0.5 * (masses[half] + masses[-1 - half]))


def _homed(pencil: FactoredPencil, vectors: Array) -> Array:
    """Vectors by Rayleigh quotient iteration on the mixed matrix, (n, k); one that would leave its mode stays.

    B. N. Parlett, The Symmetric Eigenvalue Problem (1980), ch. 4.
    """
    from scipy.sparse import block_array, csc_array, diags_array

    mass, strain = csc_array(pencil.mass_matrix()), csc_array(pencil.strain_matrix())
    springs, n_strains = diags_array(-1.0 / pencil.stiffness), len(pencil.stiffness)
    homed = vectors.copy()
    for k in range(vectors.shape[1]):
        vector = vectors[:, [k]]
        for _ in range(_HOMING):
            value, vector = factored_quotient(pencil, vector)
            right = np.concatenate([np.zeros(n_strains), (mass @ vector)[:, 0]])
            try:
                mixed = block_array([[springs, strain], [strain.T, -value[0] * mass]], format="csc")
                vector = factorised(mixed).solve(right)[n_strains:, None]
            except InputError:  # singular to the last digit: it is the mode
                break
        _, vector = factored_quotient(pencil, vector)
        if abs(vector[:, 0] @ (mass @ homed[:, k])) > _SAME * np.sqrt(homed[:, k] @ (mass @ homed[:, k])):
            homed[:, k] = vector[:, 0]
    return homed


def factored_quotient(pencil: FactoredPencil, vectors: Array, strains: Array | None = None) -> tuple[Array, Array]:
    """Rayleigh quotients sum d (B v)^2 / v^T M v, (k,), and the vectors scaled to v^T M v = 1, (n, k).

    `strains` (m, k) are B v where they are known better than the vectors' own digits tell.
    """
    strains = pencil.strain(vectors) if strains is None else strains
    masses = pencil.masses(vectors) if pencil.masses else weighed_squares(vectors, pencil.mass_matrix())
    if len(vectors) < _POLISHED:
        values = np.einsum("i,ij,ij->j", pencil.stiffness, strains, strains) / masses
    else:
        values = _in_pairs(pencil.stiffness[:, None] * strains**2) / masses
    return values, vectors / np.sqrt(masses)


def weighed_squares(vectors: Array, matrix: Any) -> Array:
    """V^T M v of every column, (k,)."""
    carried = matrix @ vectors
    if len(vectors) < _POLISHED:
        return np.asarray(np.einsum("ij,ij->j", vectors, carried))
    return _in_pairs(vectors * carried)


def _in_pairs(products: Array) -> Array:
    """Sums of columns, (k,), pairwise: a million terms one after another leave 1e-12 of their sum."""
    return np.asarray(np.ascontiguousarray(products.T).sum(axis=1))


def _assembled(pencil: FactoredPencil) -> tuple[Array, Array]:
    """B^T diag(d) B and M, dense."""
    strain = pencil.strain(np.eye(pencil.n))
    return strain.T @ (pencil.stiffness[:, None] * strain), pencil.mass_matrix()


def _is_unlike(stiffness: Array, mass: Array) -> bool:
    """Whether the parts' own frequencies lie so far apart that K has lost those of the soft ones."""
    squares = stiffness.diagonal() / mass.diagonal()
    return bool(squares.max() > _UNLIKE * squares.min())


def _dense_vectors(pencil: FactoredPencil, n_modes: int, stiffness: Array, mass: Array) -> Array:
    """Vectors by LAPACK on the assembled pencil: their error enters the quotient squared.

    Through numpy, which one small problem takes a third of scipy's start for.
    """
    lower = np.linalg.cholesky(mass)
    half = np.linalg.solve(lower, stiffness)
    _, vectors = np.linalg.eigh(np.linalg.solve(lower, half.T))
    wanted = vectors[:, pencil.rigid_modes : pencil.rigid_modes + n_modes]
    return np.asarray(np.linalg.solve(lower.T, wanted))


def _svd_vectors(pencil: FactoredPencil, n_modes: int) -> Array:
    """Vectors by the SVD of diag(d)^{1/2} B L^{-T}, M = L L^T: conditioned like n^2 where K is like n^4."""
    mass = pencil.mass_matrix()
    lower = np.linalg.cholesky(mass.toarray() if hasattr(mass, "toarray") else mass)
    strain = np.sqrt(pencil.stiffness)[:, None] * pencil.strain(np.eye(pencil.n))
    # full_matrices: where motions are rigid, B has fewer rows than columns, and those come last
    right = np.linalg.svd(np.linalg.solve(lower, strain.T).T, full_matrices=True)[2]
    last = pencil.n - pencil.rigid_modes
    wanted = right[last - n_modes : last][::-1].T
    return np.asarray(np.linalg.solve(lower.T, wanted))


def _inverse_vectors(pencil: FactoredPencil, n_modes: int) -> Array:
    """Vectors by LAPACK from L^T K^-1 L with M = L L^T and K^-1 through the mixed matrix, which takes any d.

    What is very stiff has next to nothing in it, where K would drown all else in its rounding. Rigid motions are
    projected out, as for Lanczos.
    """
    from scipy.linalg import cholesky, eigh, solve_triangular

    mass = pencil.mass_matrix()
    mass = np.asarray(mass.toarray() if hasattr(mass, "toarray") else mass)
    lower = cholesky(mass, lower=True)
    mixed, free = mixed_matrix(pencil)
    inertia = mass @ pencil.rigid
    motions = np.linalg.solve(pencil.rigid.T @ inertia, pencil.rigid.T).T
    loads = np.zeros((mixed.shape[0], pencil.n))
    loads[-len(free) :] = (lower - inertia @ (motions.T @ lower))[free]
    answer = np.zeros((pencil.n, pencil.n))
    answer[free] = factorised(mixed).solve(loads)[-len(free) :]
    flexibility = lower.T @ (answer - motions @ (inertia.T @ answer))
    symmetric = 0.5 * (flexibility + flexibility.T)
    _, vectors = eigh(symmetric, subset_by_index=(pencil.n - n_modes, pencil.n - 1), driver="evr")
    return np.asarray(solve_triangular(lower, vectors[:, ::-1], lower=True, trans="T"))


def mixed_matrix(pencil: FactoredPencil) -> tuple[Any, Indices]:
    """([[-1/d, B], [B^T, 0]] as a sparse array, the unknowns in it): K with its strains kept as unknowns.

    Where all eigenvalues lie above some value, K less M times that. Where motions are rigid, as many unknowns are
    grounded as make the matrix regular.
    """
    from scipy.sparse import block_array, csc_array, diags_array

    free: Indices = np.delete(np.arange(pencil.n, dtype=np.intp), _grounds(pencil.rigid))
    strain = pencil.strain_matrix()[:, free]
    # None, not stored zeros: they would cost three times the solve
    inertia = -pencil.below * csc_array(pencil.mass_matrix()) if pencil.below else None
    return block_array([[diags_array(-1.0 / pencil.stiffness), strain], [strain.T, inertia]], format="csc"), free


def _grounds(rigid: Array) -> list[int]:
    """Unknowns that, held, leave no rigid motion: the largest entry of each motion, the earlier ones taken out."""
    motions, grounds = rigid.copy(), []
    for j in range(motions.shape[1]):
        ground = int(abs(motions[:, j]).argmax())
        grounds.append(ground)
        motions[:, j + 1 :] -= np.outer(motions[:, j] / motions[ground, j], motions[ground, j + 1 :])
    return grounds


def _sparse_vectors(pencil: FactoredPencil, n_modes: int) -> tuple[Array, Array | None]:
    """Vectors by Lanczos on the inverse of the mixed matrix, which never forms B^T diag(d) B; their strains if many.

    Rigid motions are projected out of load and answer, which makes it the pseudo-inverse. The start vector is
    fixed, so that runs repeat.
    """
    from scipy.sparse.linalg import ArpackNoConvergence, LinearOperator, eigsh

    mixed, free = mixed_matrix(pencil)
    factor, mass, n_strains = factorised(mixed), pencil.mass_matrix(), len(pencil.stiffness)
    load, answer = np.zeros(n_strains + len(free)), np.zeros(pencil.n)
    inertia = mass @ pencil.rigid
    motions = np.linalg.solve(pencil.rigid.T @ inertia, pencil.rigid.T).T

    def invert(b: Array) -> Array:
        balanced = b.ravel() - inertia @ (motions.T @ b.ravel())
        load[n_strains:] = balanced[free]
        answer[free] = factor.solve(load)[n_strains:]
        return np.asarray(answer - motions @ (inertia.T @ answer))  # a new array: eigsh keeps what it is given

    operator = LinearOperator((pencil.n, pencil.n), matvec=invert, dtype=float)
    start = np.random.default_rng(20081).standard_normal(pencil.n)
    start -= motions @ (inertia.T @ start)
    basis = min(n_modes + 30, pencil.n)
    try:
        values, vectors = eigsh(
            operator, k=n_modes, M=mass, sigma=pencil.below, OPinv=operator, v0=start, tol=_LANCZOS, ncv=basis
        )
    except ArpackNoConvergence:
        raise InputError(
            "n_modes: the lowest modes lie too close together to be told apart on so many parts, lower count"
        ) from None
    found = np.asarray(vectors[:, np.argsort(values)])
    if pencil.n < _POLISHED:
        return found, None
    from verify.models.polishing import polished

    return polished(pencil, factor, found, free, motions)


def factorised(matrix: Any) -> Any:
    """The sparse LU factors of a matrix. Raises InputError where memory does not suffice or the matrix is singular."""
    from scipy.sparse.linalg import splu

    try:
        return splu(matrix)
    except (MemoryError, RuntimeError) as error:
        if "singular" in str(error):
            raise InputError("the system is singular to rounding: choose another frequency_hz or count") from None
        raise _too_large(matrix.shape[0]) from None


def _too_large(n_unknowns: int) -> InputError:
    return InputError(f"count: {n_unknowns} unknowns do not fit into memory, lower it")


def forced_response(pencil: FactoredPencil, loads: Any, omega2: float, stiffness: ComplexArray) -> ComplexArray:
    """V with (B^T diag(stiffness) B - omega^2 M) v = load, through the mixed matrix, (n, k) complex.

    `loads` is (n, k); `stiffness` (m,) is complex where there is damping.
    """
    try:
        if not pencil.bands:
            small = pencil.n <= DENSE_UNKNOWNS
            strain = pencil.strain(np.eye(pencil.n)) if small else pencil.strain_matrix()
            pencil.bands.append(band_of(strain, pencil.mass_matrix()))
        band = pencil.bands[0]
        found = None if band is None else band.solve(loads, omega2, stiffness)
    except MemoryError:
        raise _too_large(pencil.n) from None
    return _by_sparse_factors(pencil, loads, omega2, stiffness) if found is None else found


def _by_sparse_factors(pencil: FactoredPencil, loads: Any, omega2: float, stiffness: ComplexArray) -> ComplexArray:
    """The same where the mixed matrix is no narrow band. Raises InputError where it is singular."""
    from scipy.sparse import block_array, csc_array, diags_array

    strain = csc_array(pencil.strain_matrix())
    blocks = [[diags_array(-1.0 / stiffness), strain], [strain.T, -omega2 * csc_array(pencil.mass_matrix())]]
    right = np.zeros((len(stiffness) + pencil.n, loads.shape[1]), dtype=complex)
    right[len(stiffness) :] = loads
    return np.asarray(factorised(block_array(blocks, format="csc", dtype=complex)).solve(right)[len(stiffness) :])


def resonance_distance(pencil: FactoredPencil, omega2: float) -> float:
    """How far the nearest eigenvalue lies from omega^2, signed and relative: one step of inverse iteration.

    Exact where it is small, which is where it matters; far from a resonance an estimate.
    """
    start = np.random.default_rng(4276).standard_normal((pencil.n, 1))
    inertia = np.asarray(pencil.mass_matrix() @ start)
    vector = forced_response(pencil, inertia, omega2, pencil.stiffness.astype(complex)).real
    return float(vector[:, 0] @ inertia[:, 0] / (vector[:, 0] @ (pencil.mass_matrix() @ vector[:, 0])) / omega2)


def modal_basis(pencil: FactoredPencil, sharp: bool = False) -> tuple[Array, Array]:
    """All eigenvalues, (n,), rigid ones first as zeros, and M-orthonormal vectors, (n, n). For dense sizes.

    `sharp`: vectors from singular values at any size, sharpened once; for pencils that are not uneven.
    """
    wanted = pencil.n - pencil.rigid_modes
    pairs = _in_order(pencil, _svd_vectors(pencil, wanted), "dense SVD") if sharp else lowest(pencil, wanted)
    rigid: Array = pencil.rigid
    if rigid.shape[1]:
        gram = rigid.T @ (pencil.mass_matrix() @ rigid)
        rigid = np.asarray(np.linalg.solve(np.linalg.cholesky(gram), rigid.T).T, dtype=float)
    values, vectors = np.append(np.zeros(rigid.shape[1]), pairs.values), np.hstack([rigid, pairs.vectors])
    return _sharpened(pencil, values, vectors) if sharp else (values, vectors)


def _sharpened(pencil: FactoredPencil, values: Array, vectors: Array) -> tuple[Array, Array]:
    """All pairs with what low vectors have of high ones taken out, once (Ogita and Aishima, 2018, Algorithm 1).

    V^T K V from the strains is as exact for low modes as for high ones, which no assembled K is.
    """
    strains = np.sqrt(pencil.stiffness)[:, None] * pencil.strain(vectors)
    lack = np.eye(pencil.n) - vectors.T @ (pencil.mass_matrix() @ vectors)
    gaps = values - values[:, None]
    apart = abs(gaps) > 1e-9 * (values + values[:, None])
    mixed = (strains.T @ strains + values * lack) / np.where(apart, gaps, 1.0)
    vectors = vectors + vectors @ np.where(apart, mixed, 0.5 * lack)
    elastic = factored_quotient(pencil, vectors[:, pencil.rigid_modes :])
    first = slice(pencil.rigid_modes)
    return np.append(values[first], elastic[0]), np.hstack([vectors[:, first], elastic[1]])
