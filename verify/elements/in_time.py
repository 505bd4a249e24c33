"""The free modes of the Hermite elements for motion in time."""

import numpy as np

from verify.arrays import Array
from verify.elements.linear import check, leading_sign
from verify.elements.mesh import build_elements
from verify.elements.pencil import damped_stiffness, element_pencil
from verify.linear.driven_pencil import check_dense
from verify.linear.eigen import modal_basis
from verify.linear.places import as_typed
from verify.linear.time_basis import TimeBasis, check_held, own_ratios
from verify.problem.beam import Beam


@as_typed
def time_basis(beam: Beam, n_elements: int) -> TimeBasis:
    """All modes of the Hermite elements, (n,), by Euler-Bernoulli's theory.

    Raises InputError for rigid motions and meshes beyond the dense size.
    """
    check(beam, 1, n_elements)
    check_held(beam)
    elements = build_elements(beam, n_elements)
    parts, basis, unit = elements.parts, elements.basis, elements.parts.unit
    pencil = element_pencil(elements)
    check_dense(pencil, "motion in time")
    values, vectors = modal_basis(pencil)
    nodal = elements.all_values(vectors / np.sqrt(beam.mass_per_length * unit))
    nodal = np.ascontiguousarray((nodal * leading_sign(elements, nodal)[:, None]).T)
    inner = parts.nodes[1:-1] * unit

    def weighted(x: Array, derivative: int) -> Array:
        """Shapes at x in the mesh's unit, (len(x), n)."""
        dofs, weights = basis.weights(x, derivative)
        terms = (nodal[dof] * (weight / unit**derivative)[:, None] for dof, weight in zip(dofs, weights, strict=True))
        return np.asarray(sum(terms))

    def shapes(x: Array, derivative: int) -> Array:
        # a position at a node stays on its right, where rounding would put it on its left
        on_mesh = np.maximum(np.asarray(x) / unit, parts.nodes[inner.searchsorted(x, side="right")])
        return np.ascontiguousarray(weighted(on_mesh, derivative).T)

    unlike = beam.loss_factor and beam.lossless
    return TimeBasis(
        model="fem",
        count=n_elements,
        beam=beam,
        omegas=np.sqrt(values) * beam.wave_constant / unit**2,
        shapes=shapes,
        loads=lambda position: weighted(np.array([position / unit]), 0)[0],
        edges=parts.nodes * unit,
        degree=3,
        method="dense eigenvalues",
        ratios=own_ratios(pencil, vectors, damped_stiffness(elements, pencil)) if unlike else None,
    )
