"""Inextensible rods without shear, curved, twisted and graded at rest: angular frequencies by Ritz's method.

Unknowns are Legendre coefficients of the change of curvature psi(s) in the rod's own axes; the rotation is the integral of
psi(s'), the displacement that of psi(s') x (r(s) - r(s')), by exact integration of the polynomials through Gauss's points.
"""

from collections.abc import Callable
from typing import Any

import numpy as np
from numpy.polynomial import legendre
from scipy.linalg import eigh, null_space

POINTS = 80


def cross(vectors: Any) -> Any:
    """Matrices (..., 3, 3) of the products vector x."""
    return np.cross(vectors[..., None, :], np.eye(3)).swapaxes(-1, -2)


def frequencies(
    axes: Callable[[Any], Any],
    length: float,
    stiffness: Callable[[Any], Any],
    mass: Callable[[Any], Any],
    inertia: Any = 0.0,
    degree: int = 24,
    closed: bool = False,
) -> Any:
    """omega, ascending, of a rod clamped at s = 0 and free at `length`, or of a closed one after its rigid motions.

    By places s, (n,): `axes`: orthonormal (n, 3, 3), the columns tangent and axes of bending; `stiffness`: (n, 3) or (3,)
    about them, GJ first; `mass` per length: (n,) or one value. `inertia` of sections about the axes per length, (3,).
    A rod in its plane alone has other stiffnesses far above.
    """
    x, weights = legendre.leggauss(POINTS)
    s, weights = 0.5 * length * (1 + x), 0.5 * length * weights
    values = legendre.legvander(x, POINTS - 1)
    running = 0.5 * length * legendre.legval(x, legendre.legint(np.linalg.inv(values), lbnd=-1)).T
    shapes = np.einsum("ac,jd->jacd", np.eye(3), values[:, : degree + 1]).reshape(POINTS, 3, -1)
    frames = axes(s)
    places, turned = running @ frames[:, :, 0], frames @ shapes
    moved = np.einsum("ij,ijab,jbu->iau", running, cross(places[None] - places[:, None]), turned)
    elastic = np.einsum(
        "jau,j,ja,jav->uv", shapes, weights, stiffness(s) + np.zeros((POINTS, 3)), shapes, optimize=True
    )
    basis = np.eye(len(elastic))
    if closed:  # a rigid motion, and closure of rotation and place
        moved = np.concatenate([moved, np.broadcast_to(np.eye(3), (POINTS, 3, 3)), -cross(places)], axis=2)
        elastic = np.pad(elastic, (0, 6))
        rows = [turned, cross(places) @ turned]
        basis = null_space(
            np.pad(np.concatenate([np.tensordot(weights, row, (0, 0)) for row in rows]), ((0, 0), (0, 6)))
        )
    kinetic = np.einsum("jau,j,jav->uv", moved, weights * mass(s), moved, optimize=True)
    if np.any(inertia):
        spun = frames.swapaxes(1, 2) @ np.einsum("ij,jbu->ibu", running, turned)
        kinetic += np.einsum("jau,j,a,jav->uv", spun, weights, inertia, spun, optimize=True)
    kinetic, elastic = (basis.T @ matrix @ basis for matrix in (kinetic, elastic))
    shift = float(closed)
    found = eigh(kinetic, elastic + shift * kinetic, eigvals_only=True)[::-1][6 * closed :]
    return np.sqrt(1 / found[found > 1e-12] - shift)


def helix(radius: float, pitch: float) -> Callable[[Any], Any]:
    """Axes (tangent, away from the helix's axis, their product); `pitch` per radian, 0: a ring."""
    size = np.hypot(radius, pitch)

    def axes(s):
        c, w = np.cos(s / size), np.sin(s / size)
        tangent = np.stack([-radius * w, radius * c, np.full_like(c, pitch)], axis=-1) / size
        outward = np.stack([c, w, np.zeros_like(c)], axis=-1)
        return np.stack([tangent, outward, np.cross(tangent, outward)], axis=-1)

    return axes
