"""Eigenvalues of B^T diag(d) B against M, to rounding, at any size, and what a drive makes of it.

How vectors are found depends on size and contrast; every value is read from the pencil's own quotient (`pencil`).
"""

import msgspec
import numpy as np

from verify.arrays import Array
from verify.errors import InputError
from verify.linear.inverse import Inverse, fitting_inverse
from verify.linear.pencil import (
    DENSE_UNKNOWNS,
    FactoredPencil,
    factored_quotient,
    restarts,
)
from verify.linear.polishing import polished, sharpened, told_apart

_LANCZOS = 1e-10
"""Where Lanczos stops: the error of a vector enters the quotient squared."""
_UNLIKE = 1e4
"""Of K_ii / M_ii, or of K_ii: between parts so unlike, graded or stepped, assembling drowns what is soft. Below, values
of random steps were off by 2e-12 at most, at ten times as much by 4e-10."""
_WHOLE = 32
"""Rows up to which a triangle is inverted at once."""
MOST_VALUES = 1_250_000_000
"""Numbers that a solve holds at most, 10 GB: eight dense matrices, or sparse factors and the Lanczos basis."""


class Eigenpairs(msgspec.Struct, frozen=True, eq=False, kw_only=True):
    """Elastic eigenpairs, ascending."""

    values: Array
    """(k,), lambda = omega^2 in the pencil's units."""
    vectors: Array
    """(n, k), v^T M v = 1."""
    method: str
    """How they were found."""


def check_size(n_unknowns: int, n_modes: int, available: int, field: str, count: int) -> None:
    """Raise InputError for more modes than the `available` elastic ones, and for systems that are too large.

    `field` and `count` name the number of parts.
    """
    if n_modes > available:
        raise InputError(
            f"n_modes = {n_modes!r} is more than the {available} elastic modes that {field} = {count} gives: "
            f"ask for fewer modes or raise {field}"
        )
    dense = uses_dense(n_unknowns, n_modes)
    if (8 * n_unknowns**2 if dense else n_unknowns * (250 + 8 * n_modes)) > MOST_VALUES:
        raise InputError(
            f"{field} = {count}: {n_unknowns} unknowns with {n_modes} modes exceed the largest system of 10 GB, lower "
            f"{field} or the number of modes"
        )


def uses_dense(n_unknowns: int, n_modes: int) -> bool:
    """Whether a dense solver is used: few unknowns, or a good part of all modes wanted."""
    return n_unknowns <= DENSE_UNKNOWNS or 4 * n_modes > n_unknowns


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
        vectors, strains = _inverse_vectors(pencil, n_modes)
    elif pencil.n <= DENSE_UNKNOWNS:
        root, mass = np.sqrt(pencil.stiffness)[:, None] * pencil.strain(np.eye(pencil.n)), pencil.mass_matrix()
        inverted = _is_soft_between(pencil) or _is_unlike((root * root).sum(axis=0), mass)
        if inverted:
            vectors, strains = _inverse_vectors(pencil, n_modes)
        else:
            vectors = _dense_vectors(pencil, n_modes, root, mass)
    elif uses_dense(pencil.n, n_modes):
        vectors = _svd_vectors(pencil, n_modes)
    else:
        vectors, strains = _sparse_vectors(pencil, n_modes)
    if strains is None:
        vectors = _elastic(pencil, vectors)
    return _in_order(pencil, vectors, method_name(pencil.n, n_modes, inverted), strains)


def _elastic(pencil: FactoredPencil, vectors: Array) -> Array:
    """Vectors (n, k) without what LAPACK leaves in them of rigid motions: it weighs and has no energy.

    In the lowest mode of parts that are unlike that is as much as the rounding of the highest over it.
    """
    inertia = pencil.mass_matrix() @ pencil.rigid
    if not inertia.size:
        return vectors
    return np.asarray(vectors - pencil.rigid @ np.linalg.solve(pencil.rigid.T @ inertia, inertia.T @ vectors))


def _in_order(pencil: FactoredPencil, vectors: Array, method: str, strains: Array | None = None) -> Eigenpairs:
    """The pairs of vectors (n, k), their values read from the factored quotient; `strains` as there."""
    values, vectors = factored_quotient(pencil, vectors, strains)
    if values.min(initial=0.0) < 0.0:
        raise InputError(
            f"beam.tension: a mode of {pencil.n} unknowns has an omega^2 of {values.min():.0e}, below nothing: "
            "compress the beam less, hold it better, or lower count"
        )
    order = np.argsort(values, kind="stable")
    return Eigenpairs(values=values[order], vectors=vectors[:, order], method=method)


def has_unlike_parts(pencil: FactoredPencil) -> bool:
    """Whether the parts of a small pencil are so unlike that its vectors are found from the inverse of K."""
    root = np.sqrt(pencil.stiffness)[:, None] * pencil.strain(np.eye(pencil.n))
    return _is_soft_between(pencil) or _is_unlike((root * root).sum(axis=0), pencil.mass_matrix())


def _is_unlike(stiffness: Array, mass: Array) -> bool:
    """Whether the parts' own frequencies, by K_ii (n,) and M, or they lie so far apart that K has lost the soft."""
    return any(bool(size.max() > _UNLIKE * size.min()) for size in (stiffness / mass.diagonal(), stiffness))


def _is_soft_between(pencil: FactoredPencil) -> bool:
    """Whether some strain is so soft that stiff parts beside it move as rigid ones: of one joint no K_ii tells it."""
    return bool(pencil.stiffness.max() > _UNLIKE * pencil.stiffness.min())


def _dense_vectors(pencil: FactoredPencil, n_modes: int, root: Array, mass: Array) -> Array:
    """Vectors by LAPACK on the assembled pencil, K = root^T root: their error enters the quotient squared.

    Through numpy, which one small problem takes a third of scipy's start for. It has no triangular solve: L^-1 is
    taken once, of a mass matrix that is well conditioned where parts are alike.
    """
    inverse = _inverted(np.asarray(np.linalg.cholesky(mass), dtype=float))
    half = root @ inverse.T
    _, vectors = np.linalg.eigh(half.T @ half)
    return np.asarray(inverse.T @ vectors[:, pencil.rigid_modes : pencil.rigid_modes + n_modes])


def _inverted(lower: Array) -> Array:
    """The inverse of a lower triangle (n, n) by halves, in half the time or less of one that knows of no triangle."""
    if len(lower) <= _WHOLE:
        return np.asarray(np.linalg.inv(lower), dtype=float)
    half, found = len(lower) // 2, np.zeros_like(lower)
    first = found[:half, :half] = _inverted(lower[:half, :half])
    second = found[half:, half:] = _inverted(lower[half:, half:])
    found[half:, :half] = -second @ (lower[half:, :half] @ first)
    return found


def _svd_vectors(pencil: FactoredPencil, n_modes: int) -> Array:
    """Vectors by the SVD of diag(d)^{1/2} B L^{-T}, M = L L^T: conditioned like n^2 where K is like n^4."""
    mass = pencil.mass_matrix()
    inverse = _inverted(np.linalg.cholesky(mass.toarray() if hasattr(mass, "toarray") else mass))
    strain = np.sqrt(pencil.stiffness)[:, None] * pencil.strain(np.eye(pencil.n))
    # full_matrices: where motions are rigid, B has fewer rows than columns, and those come last
    right = np.linalg.svd(strain @ inverse.T, full_matrices=True)[2]
    last = pencil.n - pencil.rigid_modes
    return np.asarray(inverse.T @ right[last - n_modes : last][::-1].T)


def _inverse_vectors(pencil: FactoredPencil, n_modes: int) -> tuple[Array, Array | None]:
    """Vectors by LAPACK from L^T K^-1 L with M = L L^T and K^-1 through the mixed matrix, which takes any d.

    What is very stiff has next to nothing in it, where K would drown all else in its rounding. Rigid motions are
    projected out, as for Lanczos. Strains of all where some are slow.
    """
    from scipy.linalg import cholesky, eigh, solve_triangular

    inverse = fitting_inverse(pencil)
    mass = np.asarray(inverse.mass.toarray() if hasattr(inverse.mass, "toarray") else inverse.mass)
    lower = cholesky(mass, lower=True)
    first, flexibility = pencil.n - n_modes, _flexibility(inverse, lower)
    found = eigh(flexibility, subset_by_index=(first, pencil.n - 1), driver="evr")[1]
    if found.shape[1] < n_modes:  # of values that are all alike LAPACK's bisection loses some, and says nothing
        found = np.linalg.eigh(flexibility)[1][:, first:]
    vectors = np.asarray(solve_triangular(lower, found[:, ::-1], lower=True, trans="T"))
    return _of_inverse(inverse, vectors)


def _flexibility(inverse: Inverse, lower: Array) -> Array:
    """L^T K^-1 L, (n, n), without rigid motions."""
    free, inertia, motions = inverse.free, inverse.inertia, inverse.motions
    loads = np.zeros((inverse.n_strains + len(free), len(lower)))
    loads[inverse.n_strains :] = (lower - inertia @ (motions.T @ lower))[free]
    answer = np.zeros_like(lower)
    answer[free] = inverse.unit * inverse.factor.solve(loads)[inverse.n_strains :]
    found = lower.T @ (answer - motions @ (inertia.T @ answer))
    return np.asarray(0.5 * (found + found.T))


def _of_inverse(inverse: Inverse, vectors: Array) -> tuple[Array, Array | None]:
    """Vectors (n, k) that an inverse gave, made better, and their strains where the vectors do not tell them."""
    if inverse.below < 0.0:
        better, strains = told_apart(inverse, vectors)
        return better[:, : vectors.shape[1]], strains[:, : vectors.shape[1]]
    return polished(inverse, vectors) if inverse.many else (vectors, None)


def _sparse_vectors(pencil: FactoredPencil, n_modes: int) -> tuple[Array, Array | None]:
    """Vectors by Lanczos on the inverse of the mixed matrix, which never forms B^T diag(d) B; their strains if many."""
    inverse = fitting_inverse(pencil)
    return _of_inverse(inverse, _by_lanczos(inverse, n_modes))


def _by_lanczos(inverse: Inverse, n_modes: int) -> Array:
    """The lowest vectors, (n, n_modes), ascending.

    Rigid motions are projected out of load and answer, which makes it the pseudo-inverse. The start vector is
    fixed, so that runs repeat.
    """
    from scipy.sparse.linalg import ArpackNoConvergence, LinearOperator, eigsh

    n = inverse.pencil.n
    operator = LinearOperator((n, n), matvec=lambda b: inverse.solve(b.ravel()), dtype=float)
    start = inverse.still(np.random.default_rng(20081).standard_normal(n))
    basis = min(n_modes + 30, n)
    try:
        values, vectors = eigsh(
            operator,
            k=n_modes,
            M=inverse.mass,
            sigma=inverse.below,
            OPinv=operator,
            v0=start,
            tol=_LANCZOS,
            ncv=basis,
            maxiter=restarts(n),
        )
    except ArpackNoConvergence:
        raise InputError(
            "n_modes: the lowest modes lie too close together to be told apart on so many parts, lower count"
        ) from None
    return np.asarray(vectors[:, np.argsort(values)])


def modal_basis(pencil: FactoredPencil, sharp: bool = False) -> tuple[Array, Array]:
    """All eigenvalues, (n,), rigid ones first as zeros, and M-orthonormal vectors, (n, n). For dense sizes.

    `sharp`: vectors from singular values at any size, sharpened once; for pencils of parts that are alike.
    """
    wanted = pencil.n - pencil.rigid_modes
    pairs = _in_order(pencil, _svd_vectors(pencil, wanted), "dense SVD") if sharp else lowest(pencil, wanted)
    rigid: Array = pencil.rigid
    if rigid.shape[1]:
        gram = rigid.T @ (pencil.mass_matrix() @ rigid)
        rigid = np.asarray(np.linalg.solve(np.linalg.cholesky(gram), rigid.T).T, dtype=float)
    values, vectors = np.append(np.zeros(rigid.shape[1]), pairs.values), np.hstack([rigid, pairs.vectors])
    return sharpened(pencil, values, vectors) if sharp else (values, vectors)
