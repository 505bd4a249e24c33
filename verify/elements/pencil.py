"""K = B^T diag(d) B and M of Hermite elements: B reads curvatures exactly, d and M are scikit-fem's.

scikit-fem assembles K and M. K drowns its low eigenvalues in the rounding of its high ones, so it is kept as the
factors it is made of: what every element contributes is read off K's entries between its two nodes, and B is
written as differences of differences. `factor_difference` holds the product against K, entry by entry.
"""

from typing import Any

import numpy as np

from verify.beam import Beam
from verify.elements.mesh import Elements, build_elements, mass_matrix, stiffness_matrix
from verify.models.arrays import Array
from verify.models.driven_pencil import check_dense
from verify.models.eigen import DENSE_UNKNOWNS, FactoredPencil


def element_pencil(elements: Elements) -> FactoredPencil:
    """K = B^T diag(d) B over two curvatures of each element, and M by scikit-fem."""
    from skfem import condense

    lengths, basis, free = elements.lengths, elements.basis, elements.free
    mass = condense(mass_matrix(basis, elements.parts.masses_per_length), I=free, expand=False).tocsc()
    if len(free) <= DENSE_UNKNOWNS:
        mass = mass.toarray()
    return FactoredPencil(
        n=len(free),
        rigid=rigid_shapes(elements)[free],
        strain=lambda values: element_curvatures(lengths, elements.all_values(values).T),
        stiffness=curvature_weights(lengths, stiffness_matrix(basis, elements.parts.stiffnesses)),
        strain_matrix=lambda: curvature_matrix(lengths)[:, free],
        mass_matrix=lambda: mass,
    )


def curvature_weights(lengths: Array, stiffness: Any) -> Array:
    """d, (2N,), of mean curvatures and their gradients: EI/l and 3 EI/l, from an assembled K, (2N + 2, 2N + 2).

    Between its two nodes K has one element alone: -4 d_1 / l^2 for the deflections, d_1 - d_0 for the slopes.
    """
    beside = stiffness.diagonal(2)
    gradients = -0.25 * lengths**2 * beside[::2]
    return np.concatenate([gradients - beside[1::2], gradients])


def rigid_shapes(elements: Elements) -> Array:
    """The motions without strain that the supports leave, over all degrees of freedom, (2N + 2, 0 to 2)."""
    beam, basis = elements.beam, elements.basis
    x, (deflections, slopes) = basis.mesh.p[0], basis.nodal_dofs
    held = [end for end, support in zip((x[0], x[-1]), beam.supports, strict=True) if support in ("pinned", "clamped")]
    lift, turn = np.zeros((2, basis.N))
    lift[deflections], turn[slopes] = 1.0, 1.0
    turn[deflections] = x - (held[0] if held else 0.5 * x[-1])
    shapes = [lift] * (not held) + [turn] * (beam.rigid_motions > (not held))
    return np.array(shapes).reshape(len(shapes), len(lift)).T


def element_curvatures(lengths: Array, nodal: Array) -> Array:
    """Mean curvature and its gradient in every element, (2N, k), from nodal values (2N + 2, k).

    theta_1 - theta_0 and theta_0 + theta_1 - 2 (w_1 - w_0)/l: their squares weighted with EI/l and 3 EI/l
    are twice the bending energy of a cubic element. Written as differences of differences.
    """
    chord = np.diff(nodal[::2], axis=0) / lengths[:, None]
    left, right = nodal[1:-1:2] - chord, nodal[3::2] - chord
    return np.concatenate([np.diff(nodal[1::2], axis=0), left + right])


def curvature_matrix(lengths: Array) -> Any:
    """B of `element_curvatures` as a sparse array (2N, 2N + 2)."""
    from scipy.sparse import csc_array

    n = len(lengths)
    e, one = np.arange(n), np.ones(n)
    rows = np.concatenate([e, e, n + e, n + e, n + e, n + e])
    columns = np.concatenate([2 * e + 1, 2 * e + 3, 2 * e, 2 * e + 1, 2 * e + 2, 2 * e + 3])
    values = np.concatenate([-one, one, 2.0 / lengths, one, -2.0 / lengths, one])
    return csc_array((values, (rows, columns)), shape=(2 * n, 2 * n + 2))


def factor_difference(beam: Beam, n_elements: int, grading: float = 1.0) -> float:
    """How far B^T diag(d) B is from the assembled K: the largest entry of the difference over sqrt(K_ii K_jj).

    Over the free unknowns, with B as the sparse array and as the differences that read the eigenvalues, the worse
    of both. Raises InputError where the beam cannot be divided so, and beyond the dense size.
    """
    elements = build_elements(beam, n_elements, grading)
    pencil = element_pencil(elements)
    check_dense(pencil, "the factored stiffness against the assembled one")
    assembled = stiffness_matrix(elements.basis, elements.parts.stiffnesses)[elements.free][:, elements.free].toarray()
    scale = np.sqrt(assembled.diagonal())
    factors = (pencil.strain(np.eye(pencil.n)), pencil.strain_matrix().toarray())
    products = [strain.T @ (pencil.stiffness[:, None] * strain) for strain in factors]
    return float(max(abs((product - assembled) / np.outer(scale, scale)).max() for product in products))
