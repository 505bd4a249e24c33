"""K = B^T diag(d) B and M of the elements: B reads strains exactly, d and M are scikit-fem's.

scikit-fem assembles K and M. K drowns its low eigenvalues in the rounding of its high ones, so it is kept as the
factors it is made of: what every element contributes is read off K's entries between its two nodes, and B is
written as differences of differences. `factor_difference` holds the product against K, entry by entry.
What an axial force, a foundation, springs and masses add is in `added`.
"""

from typing import Any

import numpy as np
from msgspec.structs import replace

from verify.beam import Beam
from verify.elements.added import added_mass, added_matrix, added_strains, stiffest
from verify.elements.curvatures import (
    curvature_matrix,
    curvature_weights,
    element_curvatures,
    element_shear_strains,
    shear_strain_matrix,
)
from verify.elements.cuts import of_pieces
from verify.elements.mesh import (
    Elements,
    build_elements,
    mass_matrix,
    moving_matrix,
    rolling_matrix,
    shear_matrix,
    slope_matrix,
    stiffness_matrix,
    turn_matrix,
)
from verify.errors import InputError
from verify.models.arrays import Array, ComplexArray
from verify.models.compression import buckling_ratio
from verify.models.driven_pencil import check_dense
from verify.models.inverse import first_bending
from verify.models.pencil import DENSE_UNKNOWNS, FactoredPencil
from verify.options import Theory


def element_pencil(elements: Elements) -> FactoredPencil:
    """K = B^T diag(d) B over the strains of each element, and M by scikit-fem.

    First two curvatures of each element, then its two shear strains where it has them, then what is added to the
    beam. Raises InputError for a compression at which the elements buckle.
    """
    pencil = _pencil(elements)
    if elements.beam.tension < 0.0:
        check_unbuckled(elements, pencil)
    return pencil


def _pencil(elements: Elements) -> FactoredPencil:
    lengths, free = elements.lengths, elements.free
    mass = inertia_matrix(elements)[free][:, free].tocsc()
    if len(free) <= DENSE_UNKNOWNS:
        mass = mass.toarray()
    tension = elements.beam.tension * elements.parts.unit**2 / elements.beam.bending_stiffness
    own = curvature_matrix if elements.theory != "timoshenko" else shear_strain_matrix
    read = element_curvatures if elements.theory != "timoshenko" else element_shear_strains
    plain = FactoredPencil(
        n=len(free),
        rigid=rigid_shapes(elements)[free],
        strain=lambda values: read(lengths, elements.all_values(values).T),
        stiffness=own_weights(elements),
        strain_matrix=lambda: own(lengths)[:, free],
        mass_matrix=lambda: mass,
        uneven=uneven(elements.beam, elements.theory),
        bending=first_bending(lengths, elements.parts.stiffnesses, elements.parts.masses_per_length, tension),
    )
    return added_strains(elements, plain)


def uneven(beam: Beam, theory: Theory) -> bool:
    """Whether stiffnesses of many sizes come together: of shear, of springs, of short elements beside what stands."""
    return theory == "timoshenko" or bool(set(beam.added) - {"section"})


def check_unbuckled(elements: Elements, pencil: FactoredPencil | None = None) -> None:
    """Raise InputError where a compressed beam's elements buckle; `pencil` if it is there."""
    force, load = elements.beam.tension, mesh_buckling_load(elements, pencil)
    if -force >= load:
        raise InputError(
            f"beam.tension = {force!r} N compresses the beam beyond its buckling: {len(elements.lengths)} elements "
            f"buckle at {load:.6g} N, compress it less or hold it better"
        )


def mesh_buckling_load(elements: Elements, pencil: FactoredPencil | None = None) -> float:
    """The compression at which the elements of a compressed beam buckle first, newton; `pencil` if it is there."""
    if any(turn for _, turn in replace(elements.beam, tension=0.0).rigid_lines):
        return 0.0
    return -elements.beam.tension / buckling_ratio(pencil or _pencil(elements))


def damped_stiffness(elements: Elements, pencil: FactoredPencil) -> ComplexArray:
    """D with the beam's loss factor, which acts on its bending and shear and on nothing that is added, (m,)."""
    stiffness = np.asarray(pencil.stiffness, dtype=complex)
    stiffness[: own_strains(elements)] *= 1.0 + 1j * elements.beam.loss_factor
    return stiffness


def own_strains(elements: Elements) -> int:
    """How many strains there are of the beam's own bending and shear."""
    return len(elements.lengths) * (4 if elements.theory == "timoshenko" else 2)


def own_weights(elements: Elements) -> Array:
    """D of the beam's own bending and shear, (2N,) or (4N,), read off what scikit-fem assembles."""
    lengths, basis = elements.lengths, elements.basis
    if elements.theory != "timoshenko":
        return curvature_weights(lengths, stiffness_matrix(basis, elements.parts.stiffnesses))
    bending, shear = _timoshenko_stiffness(elements)
    nodal = 2 * len(lengths) + 2
    inside = shear.diagonal()[basis.interior_dofs]
    return np.concatenate([curvature_weights(lengths, bending[:nodal, :nodal]), *inside])


def own_matrix(elements: Elements) -> Any:
    """K of the beam's own bending and shear by scikit-fem, over all degrees of freedom, sparse."""
    if elements.theory != "timoshenko":
        return stiffness_matrix(elements.basis, elements.parts.stiffnesses)
    bending, shear = _timoshenko_stiffness(elements)
    return bending + shear


def _timoshenko_stiffness(elements: Elements) -> tuple[Any, Any]:
    """Bending and shear in K."""
    beam, parts, basis = elements.beam, elements.parts, elements.basis
    scale = parts.unit**2 / beam.bending_stiffness
    shear = of_pieces(beam, parts, [piece.shear_stiffness * scale for piece in beam.pieces])  # type: ignore[operator]
    shear = np.minimum(shear, stiffest(elements))
    return turn_matrix(basis, parts.stiffnesses), shear_matrix(basis, shear)


def inertia_matrix(elements: Elements) -> Any:
    """M by scikit-fem with the masses that stand on the beam, over all degrees of freedom, sparse."""
    beam, parts, basis = elements.beam, elements.parts, elements.basis
    shear = elements.theory == "timoshenko"
    mass = (moving_matrix if shear else mass_matrix)(basis, parts.masses_per_length)
    mass = mass + added_mass(elements) if beam.mass else mass
    if elements.theory == "euler-bernoulli":
        return mass
    scale = 1.0 / (beam.mass_per_length * parts.unit**2)
    rotary = of_pieces(beam, parts, [piece.rotary_inertia * scale for piece in beam.pieces])  # type: ignore[operator]
    return mass + (rolling_matrix if shear else slope_matrix)(basis, rotary)


def rigid_shapes(elements: Elements) -> Array:
    """The motions without strain that supports and springs leave, over all degrees of freedom, (n_all, 0 to 2)."""
    basis, unit = elements.basis, elements.parts.unit
    x, (deflections, slopes) = basis.mesh.p[0], basis.nodal_dofs
    lines = elements.beam.rigid_lines
    shapes = np.zeros((basis.N, len(lines)))
    for shape, (lift, turn) in zip(shapes.T, lines, strict=True):
        shape[deflections] = turn * x + (lift / unit if turn else lift)
        shape[slopes] = turn
    return shapes


def factor_difference(beam: Beam, n_elements: int, grading: float = 1.0, theory: Theory = "euler-bernoulli") -> float:
    """How far B^T diag(d) B is from the assembled K: the largest entry of the difference over sqrt(K_ii K_jj).

    Over the free unknowns, with B as the sparse array and as the differences that read the eigenvalues, the worse
    of both. Raises InputError where the beam cannot be divided so, and beyond the dense size.
    """
    elements = build_elements(beam, n_elements, grading, theory)
    pencil = element_pencil(elements)
    check_dense(pencil, "the factored stiffness against the assembled one")
    assembled = added_matrix(elements, own_matrix(elements))[elements.free][:, elements.free].toarray()
    scale = np.sqrt(assembled.diagonal())
    factors = (pencil.strain(np.eye(pencil.n)), pencil.strain_matrix().toarray())
    products = [strain.T @ (pencil.stiffness[:, None] * strain) for strain in factors]
    return float(max(abs((product - assembled) / np.outer(scale, scale)).max() for product in products))
