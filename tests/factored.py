"""The factored stiffness of elements against the one that scikit-fem assembles."""

import numpy as np
from scipy.sparse import diags_array

from verify.elements.added import _springs
from verify.elements.mesh import build_elements
from verify.elements.pencil import element_pencil


def factor_difference(beam, count, grading=1.0, theory="euler-bernoulli"):
    """Largest entry of B^T diag(d) B - K over sqrt(K_ii K_jj), of B as a matrix and as differences."""
    elements = build_elements(beam, count, grading, theory)
    parts, unit, ei = elements.parts, elements.parts.unit, beam.bending_stiffness
    pencil, one = element_pencil(elements), np.ones(count)
    if elements.shears:
        shear = elements.of_pieces([piece.shear_stiffness * unit**2 / ei for piece in beam.pieces])
        total = elements.assemble("turning", parts.stiffnesses) + elements.assemble("shearing", shear)
    else:
        total = elements.assemble("bending", parts.stiffnesses)
    if beam.tension:
        total = total + elements.assemble("stretching", beam.tension * unit**2 / ei * one)
    if beam.foundation:
        ground = beam.foundation * unit**4 / ei * one
        total = total + elements.assemble("moving" if elements.shears else "inertia", ground)
    if beam.spring:
        _, matrix, stiffness = _springs(elements)
        total = total + matrix().T @ diags_array(stiffness) @ matrix()
    assembled = total.tocsr()[elements.free][:, elements.free].toarray()
    scale = np.sqrt(assembled.diagonal())
    strains = (pencil.strain(np.eye(pencil.n)), pencil.strain_matrix().toarray())
    products = [strain.T @ (pencil.stiffness[:, None] * strain) for strain in strains]
    return max(abs((product - assembled) / np.outer(scale, scale)).max() for product in products)
