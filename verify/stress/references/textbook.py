"""The textbook way of doing the same, as most programs do it: assembled matrices, hyperbolic functions, plain steps.

Compared subjects: nothing of the suite uses them.
"""

from math import cos, cosh, pi, sin, sinh, sqrt
from typing import Any

import numpy as np

from verify.beam import Beam
from verify.models.arrays import Array


def assembled(model: str, supports: tuple[str, str], n: int) -> tuple[Any, Any]:
    """K and M of N equal parts in units of a part, EI = rho A = l = 1, as sparse matrices; pinned ends for links."""
    from scipy.sparse import diags_array

    if model == "segment":
        row = np.array([1.0, -2.0, 1.0])
        strain = diags_array(list(row), offsets=[0, 1, 2], shape=(n - 1, n + 1)).tocsc()[:, 1:-1]
        ones = np.ones(n - 1)
        mass = diags_array([ones[1:] / 6, ones * 2 / 3, ones[1:] / 6], offsets=[-1, 0, 1])
        return (strain.T @ strain).tocsc(), mass.tocsc()
    return _hermite(supports, n)


def _hermite(supports: tuple[str, str], n: int) -> tuple[Any, Any]:
    from scipy.sparse import coo_array

    ke = np.array([[12, 6, -12, 6], [6, 4, -6, 2], [-12, -6, 12, -6], [6, 2, -6, 4]], dtype=float)
    me = np.array([[156, 22, 54, -13], [22, 4, 13, -3], [54, 13, 156, -22], [-13, -3, -22, 4]], dtype=float) / 420
    dofs = 2 * np.arange(n)[:, None] + np.arange(4)
    rows, columns = np.repeat(dofs, 4, axis=1).ravel(), np.tile(dofs, 4).ravel()
    held = {"pinned": [0], "clamped": [0, 1], "guided": [1], "free": []}
    free = np.setdiff1d(np.arange(2 * n + 2), held[supports[0]] + [2 * n + j for j in held[supports[1]]])
    made = [coo_array((np.tile(m.ravel(), n), (rows, columns))).tocsc()[free][:, free] for m in (ke, me)]
    return made[0], made[1]


def assembled_roots(model: str, supports: tuple[str, str], n: int, n_modes: int) -> Array:
    """Omega l^2 / sqrt(EI / (rho A)) of the first modes by scipy's eigsh about 0 on assembled matrices."""
    from scipy.sparse.linalg import eigsh

    stiffness, mass = assembled(model, supports, n)
    start = np.random.default_rng(1).standard_normal(stiffness.shape[0])
    values = eigsh(stiffness, k=n_modes, M=mass, sigma=0, v0=start, return_eigenvectors=False)
    return np.asarray(np.sqrt(abs(np.sort(values))))


def cantilever_wavenumber(mode: int) -> float:
    """Beta L of a cantilever by Newton on cos y cosh y + 1, as it is printed."""
    y = (mode - 0.5) * pi
    for _ in range(20):
        y -= (cos(y) * cosh(y) + 1.0) / (cos(y) * sinh(y) - sin(y) * cosh(y))
    return y


def cantilever_shape(y: float, x: float) -> float:
    """The cantilever's shape at x / L, as it is printed: cosh - cos less sigma times (sinh - sin)."""
    sigma = (sinh(y) - sin(y)) / (cosh(y) + cos(y))
    return cosh(y * x) - cos(y * x) - sigma * (sinh(y * x) - sin(y * x))


def hertz(beam: Beam, root: float, unit: float) -> float:
    """Of a dimensionless omega at a length."""
    return root * beam.wave_constant / unit**2 / (2.0 * pi)


def dense_frequency(stiffness: Array, mass: Array, mode: int) -> float:
    """Omega of one mode by LAPACK on dense matrices."""
    from scipy.linalg import eigh

    return sqrt(abs(float(eigh(stiffness, mass, eigvals_only=True)[mode - 1])))
