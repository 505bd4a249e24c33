"""K = B^T diag(d) B and M of the elements: B reads strains exactly, d and M are scikit-fem's.

scikit-fem assembles K and M. K drowns its low eigenvalues in the rounding of its high ones, so it is kept as the
factors it is made of: d of every element is read off K's entries between its two nodes, and B is written as differences
of differences. Axial force, foundation, springs and masses are in `added`.
"""

from typing import Any

import numpy as np
from msgspec.structs import replace

from verify.arrays import Array, ComplexArray
from verify.elements.added import added_mass, added_strains, stiffest
from verify.elements.curvatures import (
    curvature_matrix,
    curvature_weights,
    element_curvatures,
    element_shear_strains,
    shear_strain_matrix,
)
from verify.elements.mesh import Elements
from verify.errors import InputError
from verify.linear.compression import buckling_ratio
from verify.linear.inverse import first_bending
from verify.linear.pencil import DENSE_UNKNOWNS, FactoredPencil
from verify.options import Theory
from verify.problem.beam import Beam


def element_pencil(elements: Elements) -> FactoredPencil:
    """K = B^T diag(d) B over the strains of each element, and M by scikit-fem.

    Strains are first the two curvatures of each element, then its two shear strains where it has them, then those of
    `added`. Raises InputError for a compression at which the elements buckle.
    """
    pencil = _pencil(elements)
    if elements.beam.tension < 0.0:
        check_unbuckled(elements, pencil)
    return pencil


def _pencil(elements: Elements) -> FactoredPencil:
    lengths, free, beam, parts = elements.lengths, elements.free, elements.beam, elements.parts
    mass = inertia_matrix(elements)[free][:, free].tocsc()
    if len(free) <= DENSE_UNKNOWNS:
        mass = mass.toarray()
    tension = beam.tension * parts.unit**2 / beam.bending_stiffness
    matrix = shear_strain_matrix if elements.shears else curvature_matrix
    read = element_shear_strains if elements.shears else element_curvatures
    plain = FactoredPencil(
        n=len(free),
        rigid=rigid_shapes(elements)[free],
        strain=lambda values: read(lengths, elements.all_values(values).T),
        stiffness=own_weights(elements),
        strain_matrix=lambda: matrix(lengths)[:, free],
        mass_matrix=lambda: mass,
        uneven=uneven(beam, elements.theory),
        bending=first_bending(lengths, parts.stiffnesses, parts.masses_per_length, tension),
    )
    return added_strains(elements, plain)


def uneven(beam: Beam, theory: Theory) -> bool:
    """Whether stiffnesses of many sizes come together: of shear, of springs, of short elements beside attachments."""
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
    own = len(elements.lengths) * (4 if elements.shears else 2)
    stiffness[:own] *= 1.0 + 1j * elements.beam.loss_factor
    return stiffness


def own_weights(elements: Elements) -> Array:
    """D of the beam's own bending and shear, (2N,) or (4N,), read off what scikit-fem assembles."""
    lengths, beam, parts = elements.lengths, elements.beam, elements.parts
    if not elements.shears:
        return curvature_weights(lengths, elements.assemble("bending", parts.stiffnesses))
    scale = parts.unit**2 / beam.bending_stiffness
    stiffness = elements.of_pieces([piece.shear_stiffness * scale for piece in beam.pieces])  # type: ignore[operator]
    shear = elements.assemble("shearing", np.minimum(stiffness, stiffest(elements)))
    bending = elements.assemble("turning", parts.stiffnesses)
    nodal = 2 * len(lengths) + 2
    inside = shear.diagonal()[elements.basis.interior_dofs]
    return np.concatenate([curvature_weights(lengths, bending[:nodal, :nodal]), *inside])


def inertia_matrix(elements: Elements) -> Any:
    """M by scikit-fem with the masses that stand on the beam, over all degrees of freedom, sparse."""
    beam, parts = elements.beam, elements.parts
    mass = elements.assemble("moving" if elements.shears else "inertia", parts.masses_per_length)
    mass = mass + added_mass(elements) if beam.mass else mass
    if elements.theory == "euler-bernoulli":
        return mass
    scale = 1.0 / (beam.mass_per_length * parts.unit**2)
    rotary = elements.of_pieces([piece.rotary_inertia * scale for piece in beam.pieces])  # type: ignore[operator]
    return mass + elements.assemble("rolling" if elements.shears else "stretching", rotary)


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
