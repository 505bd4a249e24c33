r"""Ring of rigid links: frequency of mode n over sqrt(EI / (rho A R^4)), in its plane and across it; GJ = EI / 1.3.

In the plane a link turns by theta_j = cos(n a j), a = 2 pi/N; the joints of chords of length l move by
u_{j+1} - u_j = i l e^{iaj} theta_j, and the middle of a link by (l/4) [c+ e^{i(n+1)aj} - c- e^{-i(n-1)aj}] with
c+- = cot((n +- 1) a/2). The mean kinetic energy is m l^2 omega^2 (2 + 3 c+^2 + 3 c-^2)/96, that of the springs
k sin^2(n a/2): the law of a polygon, `polygon`. With joints EI/(a R) and the mass rho A a R its error is
a^2 (q - (3 n^2 - 1)/(24 (n^2 + 1))), q = 1/24 where the joints are on the circle and 0 at l = a R. No factor of the
joints cancels 1/(n^2 + 1): q = 1/8 leaves a^2/(6 (n^2 + 1)).

That part is due to the place of the mass. The centre of an arc lies e = a^2 R/12 outside the middle of its chord, which
subtracts 2 e (n^2 - 1)/(R (n^2 + 1)) from the relative kinetic energy: with joints on the circle the error cancels at
every mode. Rigid arcs with joints EI/(a R) have, with s = sin(n a/2) and s+- = sin((n +- 1) a/2),

    omega^2 = 8 s^2 / (a^2 [s^2 (1/s+^2 + 1/s-^2) + 2 - 4 s (1/s+ + 1/s-) sin(a/2)/a]) ,

order 4 with the law of straight links, -a^4 omega^2/1440 (docs/theory.md, "Curved rods"). Straight links with the
centres of mass of the arcs are of order 4, too.

Across the plane a deflection w and a twist b/R bend by (b - w'')/R^2 and twist by (b' + w')/R^2. With
w = W cos(n phi) the energy EI (b + n^2 W)^2 + n^2 GJ (b + W)^2 is least at b = -n^2 (EI + GJ) W/(EI + n^2 GJ):
omega^2 = n^2 (n^2 - 1)^2/(n^2 + EI/GJ).
"""

from math import pi, sin, sqrt, tan
from typing import Any, Literal

import numpy as np

from verify.arrays import Array
from verify.cases.base import case

HOPPE = "R. Hoppe 1871, inextensible ring without rotary inertia"
ACROSS = "Saint-Venant's torsion, derived in this file"
TWIST = 1.3  # EI/GJ of a round section at Poisson's ratio 0.3


def polygon(mode: int, count: int) -> float:
    """Frequency of a regular polygon of chords of the circle."""
    a, side = 2.0 * pi / count, 2.0 * sin(pi / count)
    far, near = (3.0 / tan(0.5 * (mode + one) * a) ** 2 for one in (1, -1))
    return sqrt(96.0 * sin(0.5 * mode * a) ** 2 / (2.0 + far + near)) / (a * side)


@case("ring-polygon", polygon(3, 40), 1e-12, "closed form, derived in this file", mode=3, links="chords", count=40)
@case("ring-chords-2", 6 / sqrt(5), 1e-15, HOPPE, mode=2, links="chords")
@case("ring-chords-across-2", 6 / sqrt(4 + TWIST), 1e-15, ACROSS, mode=2, across=True, links="chords")
@case("ring-2", 6 / sqrt(5), 1e-15, HOPPE, mode=2)
@case("ring-3", 24 / sqrt(10), 1e-15, HOPPE, mode=3)
@case("ring-balanced-2", 6 / sqrt(5), 1e-15, HOPPE, mode=2, links="balanced")
@case("ring-across-2", 6 / sqrt(4 + TWIST), 1e-15, ACROSS, mode=2, across=True)
@case("ring-across-3", 24 / sqrt(9 + TWIST), 1e-15, ACROSS, mode=3, across=True)
def frequency(
    mode: int, across: bool = False, links: Literal["arcs", "chords", "balanced"] = "arcs", count: int = 40
) -> float:
    """Frequency of a closed chain by its eigenproblem; balanced: chords with the centres of mass of the arcs."""
    from scipy.linalg import eigh, null_space

    a = 2.0 * pi / count
    joints = on_circle(a * np.arange(count + 1))
    x, weights = np.polynomial.legendre.leggauss(3)  # the moments of an arc to 1e-2 a^6
    arcs = on_circle(a * (np.arange(count)[:, None] + 0.5 * (1.0 + x)))
    chords = joints[:-1, None] + (0.5 * (1.0 + x))[:, None] * np.diff(joints, axis=0)[:, None]
    middles = np.tensordot(arcs - chords, 0.5 * weights, (1, 0)) if links == "balanced" else np.zeros((count, 3))
    points = arcs if links == "arcs" else chords + middles[:, None]
    radial, axis = joints[:-1], np.array([0.0, 0.0, 1.0])
    about = np.stack([np.cross(axis, radial), radial], axis=1) if across else np.tile(axis, (count, 1, 1))
    springs = np.array([1.0 / TWIST, 1.0] if across else [1.0]) / a
    # motion of the points by a rotation about every joint before them, and by a rigid motion of the ring
    turned = np.cross(about, points[:, :, None, None] - radial[:, None])
    turned *= np.tri(count)[:, None, :, None, None]
    rigid = np.concatenate([np.broadcast_to(np.eye(3), (count, 3, 3, 3)), np.cross(np.eye(3), points[:, :, None])], 2)
    moves = np.concatenate([turned.reshape(count, 3, -1, 3), rigid], axis=2)
    mass = np.einsum("iqua,iqva,q->uv", moves, moves, 0.5 * a * weights, optimize=True)
    stiffness = np.diag(np.append(np.tile(springs, count), np.zeros(6)))
    flat = about.reshape(-1, 3)
    closure = np.vstack([flat.T, np.cross(flat, np.repeat(radial, about.shape[1], axis=0)).T])
    basis = null_space(np.hstack([closure, np.zeros((6, 6))]))
    mass, stiffness = basis.T @ mass @ basis, basis.T @ stiffness @ basis
    place = len(mass) - 6 - 2 * (mode - 2) - 1  # after six rigid motions, modes in pairs; the inverse keeps the digits
    shifted = eigh(mass, stiffness + mass, eigvals_only=True, subset_by_index=[place, place])
    return float(np.sqrt(1.0 / shifted[0] - 1.0))


def on_circle(angles: Any) -> Array:
    """Points of the unit circle, (..., 3)."""
    return np.stack([np.cos(angles), np.sin(angles), np.zeros_like(angles)], axis=-1)
