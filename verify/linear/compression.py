"""How near an axial force brings a model to its buckling, by the factors of its stiffness."""

from typing import Any

import numpy as np
from msgspec.structs import replace

from verify.arrays import Array, BoolArray
from verify.errors import InputError
from verify.linear.inverse import inverse_of, lowest_told
from verify.linear.pencil import FactoredPencil, restarts
from verify.linear.polishing import best_read

_BASIS = 60
"""Vectors of Lanczos: on hard ground a beam buckles in many ways at about one load, and 20 take ten times as long."""
_LANCZOS = 1e-13
"""Where it stops, of the value."""


def buckling_ratio(pencil: FactoredPencil) -> float:
    """The energy that the negative stiffnesses take over that of the others, at its largest: 1 where it buckles.

    Where they are all in proportion to an axial force, as the others are not, the force over this is the model's
    buckling load. Of a pencil whose rigid motions strain no negative stiffness. 0 where none is negative. It is read
    from the strains of the shape that takes the most, so that what holds a beam softly keeps its digits beside what
    bends. Raises InputError where on so many parts loads lie too close together.
    """
    from scipy.sparse import csr_array, diags_array
    from scipy.sparse.linalg import ArpackNoConvergence, LinearOperator, eigsh

    soft, strain = pencil.stiffness < 0.0, csr_array(pencil.strain_matrix())
    if not soft.any():
        return 0.0
    held = _held(pencil, ~soft, strain[~soft])
    inverse = inverse_of(held, 0.0)
    hardly = abs(lowest_told(inverse)) < pencil.bending
    taken = diags_array(np.sqrt(-pencil.stiffness[soft])) @ strain[soft]

    def relax(given: Array) -> Array:
        load = taken.T @ given.ravel()
        return np.asarray(taken @ (inverse.refined(load)[1] if hardly else inverse.solve(load)))

    size = taken.shape[0]
    start = np.random.default_rng(1744).standard_normal(size)
    operator = LinearOperator((size, size), matvec=relax, dtype=float)
    sought = {"k": 1, "which": "LA", "v0": start, "tol": _LANCZOS, "ncv": min(_BASIS, size), "maxiter": restarts(size)}
    try:
        forces, shape = inverse.refined(taken.T @ eigsh(operator, **sought)[1][:, 0])
    except ArpackNoConvergence:
        raise InputError(
            "count: the lowest buckling loads lie too close together to be told apart on so many parts, lower it"
        ) from None
    strains = best_read(held, shape[:, None], (forces / held.stiffness)[:, None])
    return float(((taken @ shape) ** 2).sum() / (held.stiffness @ strains**2)[0])


def _held(pencil: FactoredPencil, kept: BoolArray, strain: Any) -> FactoredPencil:
    """The same, held by the strains that are `kept` alone, `strain` (m, n)."""
    return replace(
        pencil,
        strain=lambda free: pencil.strain(free)[kept],
        strain_matrix=lambda: strain,
        stiffness=pencil.stiffness[kept],
        turned=[],
    )
