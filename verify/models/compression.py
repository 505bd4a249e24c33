"""How near an axial force brings a model to its buckling, by the factors of its stiffness."""

import numpy as np
from msgspec.structs import replace

from verify.errors import InputError
from verify.models.arrays import Array
from verify.models.pencil import FactoredPencil, factorised, mixed_matrix, restarts

_BASIS = 60
"""Vectors of Lanczos: on hard ground a beam buckles in many ways at about one load, and 20 take ten times as long."""
_LANCZOS = 1e-13
"""Where it stops, of the value."""


def buckling_ratio(pencil: FactoredPencil) -> float:
    """The energy that the negative stiffnesses take over that of the others, at its largest: 1 where it buckles.

    Where they are all in proportion to an axial force, as the others are not, the force over this is the model's
    buckling load. Of a pencil whose rigid motions strain no negative stiffness. 0 where none is negative.
    Raises InputError where on so many parts loads lie too close together.
    """
    from scipy.sparse import csr_array, diags_array
    from scipy.sparse.linalg import ArpackNoConvergence, LinearOperator, eigsh

    soft, strain = pencil.stiffness < 0.0, csr_array(pencil.strain_matrix())
    if not soft.any():
        return 0.0
    kept = strain[~soft]
    mixed, free = mixed_matrix(replace(pencil, strain_matrix=lambda: kept, stiffness=pencil.stiffness[~soft]))
    factor, taken = factorised(mixed), diags_array(np.sqrt(-pencil.stiffness[soft])) @ strain[soft][:, free]
    load = np.zeros(mixed.shape[0])

    def relax(given: Array) -> Array:
        load[-len(free) :] = taken.T @ given.ravel()
        return np.asarray(taken @ factor.solve(load)[-len(free) :])

    size = taken.shape[0]
    start = np.random.default_rng(1744).standard_normal(size)
    operator = LinearOperator((size, size), matvec=relax, dtype=float)
    sought = {"k": 1, "which": "LA", "v0": start, "tol": _LANCZOS, "ncv": min(_BASIS, size), "maxiter": restarts(size)}
    try:
        return float(eigsh(operator, return_eigenvectors=False, **sought)[0])
    except ArpackNoConvergence:
        raise InputError(
            "count: the lowest buckling loads lie too close together to be told apart on so many parts, lower it"
        ) from None
