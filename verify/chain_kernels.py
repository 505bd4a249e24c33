"""Compiled kernels of the planar chain of rigid links: O(N) forward dynamics and the loops around it.

Everything that a kernel calls stands in this file, because numba's cache does not notice edits elsewhere. Kernels
see flat arrays and allocate nothing.

Link i (0..N-1) has the frame (n_i, e_i), along and across it. Joint i lies between links i - 1 and i and carries
the force p_i on link i. Coordinates are the relative angles q_i and their rates; frames of neighbours differ by q_i,
so that the recursion needs no absolute angle but where a load or a support has a direction of its own. Seen from one
side, a part of the chain answers a force at its end by an acceleration, a 2 x 2 mobility; links are added to it one by
one, from the base and from the tip at once, and both sides meet in the middle. The roller's force is part of the
elimination: no multiplier is left over. (Articulated bodies seen from the joints: R. Featherstone, Rigid Body
Dynamics Algorithms, 2008, chapter 7; meeting in the middle is the twisted factorisation of a tridiagonal matrix.)
"""

from typing import Any, NamedTuple

import numpy as np
from numba import njit
from numpy.typing import NDArray

Array = NDArray[np.float64]
Indices = NDArray[np.int64]

FREE, ROLLER = 0, 1
"""Kinds of tip."""
WORK_COLUMNS = 20
_SMALL = 0.5
"""Relative angles below this take the short series for sine and cosine."""


class Flat(NamedTuple):
    """A chain as the kernels see it. SI."""

    half: Array
    """(N,), half lengths."""
    masses: Array
    """(N,)."""
    inertias: Array
    """(N,), about the middles."""
    mobility: Array
    """(N, 5): 1/m, 1/J, h/J, and h^2/J + 1/m, h^2/J - 1/m."""
    stiffness: Array
    """(N,), joint springs, the base's first."""
    dashpots: Array
    """(N,)."""
    gravity: Array
    """(2,), m/s^2."""
    hub: Array
    """(5,): offset, rate, amplitude, circular frequency and phase of the base's rotation."""
    tip: int
    """FREE or ROLLER."""
    tip_spring: float
    """N/m, axial, at the roller."""
    axial: bool
    """Whether the links have inertia along x."""
    load_links: Indices
    """(n_loads,)."""
    loads: Array
    """(n_loads, 6): arm from the link's middle, F_x, F_y, moment, circular frequency, phase."""


def mobilities(half: Array, masses: Array, inertias: Array) -> Array:
    """The columns of `Flat.mobility`."""
    a, spin = 1.0 / masses, 1.0 / inertias
    return np.stack([a, spin, half * spin, half**2 * spin + a, half**2 * spin - a], axis=1)


@njit(cache=True, inline="always")
def _turned(c: float, s: float, x: float, y: float) -> Any:
    """A vector in a frame turned by the angle with cosine c and sine s."""
    return c * x + s * y, c * y - s * x


@njit(cache=True, inline="always")
def _turned_matrix(c: float, s: float, x11: float, x12: float, x22: float) -> Any:
    """A symmetric matrix in a frame turned by the angle with cosine c and sine s."""
    c2, s2 = c * c - s * s, 2.0 * c * s
    mean, half = 0.5 * (x11 + x22), 0.5 * (x11 - x22)
    d, off = c2 * half + s2 * x12, c2 * x12 - s2 * half
    return mean + d, off, mean - d


@njit(cache=True, inline="always")
def _inverse(x11: float, x12: float, x22: float) -> Any:
    """The inverse of a symmetric 2 x 2 matrix."""
    d = 1.0 / (x11 * x22 - x12 * x12)
    return x22 * d, -x12 * d, x11 * d


@njit(cache=True, fastmath={"contract"})
def hub_motion(hub: Array, t: float) -> Any:
    """Angle, rate and acceleration of the base's prescribed rotation."""
    phase = hub[3] * t + hub[4]
    swing, speed = hub[2] * np.sin(phase), hub[2] * hub[3] * np.cos(phase)
    return hub[0] + hub[1] * t + swing, hub[1] + speed, -hub[3] * hub[3] * swing


@njit(cache=True, fastmath={"contract"})
def _cosines(angles: Array, work: Array) -> None:
    """Cosine and sine of relative angles into columns 0 and 1; a short series where all of them are small."""
    largest = 0.0
    for i in range(angles.size):
        largest = max(largest, abs(angles[i]))
    if largest > _SMALL or largest != largest:
        for i in range(angles.size):
            work[i, 0], work[i, 1] = np.cos(angles[i]), np.sin(angles[i])
        return
    for i in range(angles.size):
        z = angles[i] * angles[i]
        c = 1.0 / 24 - z * (1.0 / 720 - z * (1.0 / 40320 - z * (1.0 / 3628800 - z * (1 / 479001600 - z / 87178291200))))
        s = 1 / 120 - z * (1 / 5040 - z * (1 / 362880 - z * (1 / 39916800 - z * (1 / 6227020800 - z / 1307674368000))))
        work[i, 0] = 1.0 - z * (0.5 - z * c)
        work[i, 1] = angles[i] * (1.0 - z * (1.0 / 6 - z * s))


@njit(cache=True, fastmath={"contract"})
def _moments(f: Flat, t: float, q: Array, v: Array, work: Array) -> Any:
    """Absolute angles, rates and joint moments into columns 2, 3, 6, forces cleared; (dissipation, hub's power)."""
    angle, rate, _ = hub_motion(f.hub, t)
    before = -f.stiffness[0] * q[0] - f.dashpots[0] * v[0]
    lost, hub_power = f.dashpots[0] * v[0] * v[0], before * rate
    n = q.size
    for i in range(n):
        angle += q[i]
        rate += v[i]
        after = 0.0
        if i + 1 < n:
            after = -f.stiffness[i + 1] * q[i + 1] - f.dashpots[i + 1] * v[i + 1]
            lost += f.dashpots[i + 1] * v[i + 1] * v[i + 1]
        work[i, 2], work[i, 3], work[i, 4], work[i, 5], work[i, 6] = angle, rate, 0.0, 0.0, before - after
        before = after
    return lost, hub_power


@njit(cache=True, fastmath={"contract"})
def _loads(f: Flat, t: float, work: Array) -> None:
    """Gravity and point loads: forces along and across each link into columns 4, 5, moments into 6."""
    gx, gy = f.gravity[0], f.gravity[1]
    if gx != 0.0 or gy != 0.0:
        for i in range(f.masses.size):
            c, s = np.cos(work[i, 2]), np.sin(work[i, 2])
            work[i, 4], work[i, 5] = f.masses[i] * (c * gx + s * gy), f.masses[i] * (c * gy - s * gx)
    for k in range(f.load_links.size):
        i = f.load_links[k]
        arm, fx, fy, moment, omega, phase = f.loads[k]
        now = np.cos(omega * t + phase)
        c, s = np.cos(work[i, 2]), np.sin(work[i, 2])
        along, across = now * (c * fx + s * fy), now * (c * fy - s * fx)
        work[i, 4] += along
        work[i, 5] += across
        work[i, 6] += now * moment + arm * across


@njit(cache=True, inline="always", fastmath={"contract"})
def _terms(f: Flat, i: int, work: Array) -> Any:
    """A = diag(a, b), O = diag(-a, o) of a link, and its ends' accelerations without joint forces."""
    a, along, inward = f.mobility[i, 0], f.mobility[i, 0] * work[i, 4], f.half[i] * work[i, 3] * work[i, 3]
    across, turn = a * work[i, 5], f.mobility[i, 2] * work[i, 6]
    return a, f.mobility[i, 3], f.mobility[i, 4], along + inward, across - turn, along - inward, across + turn


@njit(cache=True, inline="always", fastmath={"contract"})
def _from_base(f: Flat, i: int, work: Array, x11: float, x12: float, x22: float, z1: float, z2: float) -> Any:
    """Add link i to the part behind its first joint; the answer stands in the frame of link i."""
    a, b, o, s1, s2, e1, e2 = _terms(f, i, work)
    i11, i12, i22 = _inverse(x11 + a, x12, x22 + b)
    d1, d2 = z1 - s1, z2 - s2
    r1, r2 = i11 * d1 + i12 * d2, i12 * d1 + i22 * d2
    work[i, 7], work[i, 8], work[i, 9], work[i, 10], work[i, 11] = i11, i12, i22, r1, r2
    return a - a * a * i11, a * o * i12, b - o * o * i22, e1 + a * r1, e2 - o * r2


@njit(cache=True, inline="always", fastmath={"contract"})
def _from_tip(f: Flat, i: int, work: Array, y11: float, y12: float, y22: float, u1: float, u2: float) -> Any:
    """Add link i to the part beyond its second joint (given in the frame of link i)."""
    a, b, o, s1, s2, e1, e2 = _terms(f, i, work)
    i11, i12, i22 = _inverse(y11 + a, y12, y22 + b)
    d1, d2 = e1 - u1, e2 - u2
    r1, r2 = i11 * d1 + i12 * d2, i12 * d1 + i22 * d2
    work[i, 7], work[i, 8], work[i, 9], work[i, 10], work[i, 11] = i11, i12, i22, r1, r2
    return a - a * a * i11, a * o * i12, b - o * o * i22, s1 - a * r1, s2 + o * r2


@njit(cache=True, fastmath={"contract"})
def _tip(f: Flat, work: Array) -> Any:
    """The last link seen from its first joint: its free tip, or its roller's unknown force eliminated."""
    i = f.masses.size - 1
    a, b, o, s1, s2, e1, e2 = _terms(f, i, work)
    i11, i12, i22, r1, r2 = 0.0, 0.0, 0.0, 0.0, 0.0
    if f.tip == ROLLER:
        c, s = np.cos(work[i, 2]), np.sin(work[i, 2])
        along, across = 0.0, 0.0
        if f.tip_spring > 0.0:
            pull = -f.tip_spring * shortening(f, work)
            along, across = pull * c, -pull * s
        g = 1.0 / (a * s * s + b * c * c)
        i11, i12, i22 = g * s * s, g * s * c, g * c * c
        d1, d2 = e1 - a * along, e2 - b * across
        r1, r2 = i11 * d1 + i12 * d2 + along, i12 * d1 + i22 * d2 + across
    work[i, 7], work[i, 8], work[i, 9], work[i, 10], work[i, 11] = i11, i12, i22, r1, r2
    return a - a * a * i11, a * o * i12, b - o * o * i22, s1 - a * r1, s2 + o * r2


@njit(cache=True, fastmath={"contract"})
def shortening(f: Flat, work: Array) -> float:
    """How far the tip stands back from the straight chain's, from absolute angles in column 2, metres."""
    total = 0.0
    for i in range(f.half.size):
        s = np.sin(0.5 * work[i, 2])
        total += 4.0 * f.half[i] * s * s
    return total


@njit(cache=True, fastmath={"contract"})
def _eliminate(f: Flat, work: Array) -> Any:
    """Both sides up to the middle joint; the force there, in the frame of the link behind it."""
    n = f.masses.size
    middle = n // 2
    y11, y12, y22, u1, u2 = _tip(f, work)
    x11, x12, x22, z1, z2 = 0.0, 0.0, 0.0, 0.0, 0.0
    for j in range(middle):
        x11, x12, x22, z1, z2 = _from_base(f, j, work, x11, x12, x22, z1, z2)
        c, s = work[j + 1, 0], work[j + 1, 1]
        x11, x12, x22 = _turned_matrix(c, s, x11, x12, x22)
        z1, z2 = _turned(c, s, z1, z2)
        i = n - 2 - j
        if i >= middle:
            c, s = work[i + 1, 0], work[i + 1, 1]
            y11, y12, y22 = _turned_matrix(c, -s, y11, y12, y22)
            u1, u2 = _turned(c, -s, u1, u2)
            y11, y12, y22, u1, u2 = _from_tip(f, i, work, y11, y12, y22, u1, u2)
    i11, i12, i22 = _inverse(x11 + y11, x12 + y12, x22 + y22)
    return i11 * (z1 - u1) + i12 * (z2 - u2), i12 * (z1 - u1) + i22 * (z2 - u2)


@njit(cache=True, inline="always", fastmath={"contract"})
def _across(f: Flat, i: int, work: Array, p1: float, p2: float) -> Any:
    """The force at the other end of link i (both in its frame), and the link's angular acceleration."""
    a, o = f.mobility[i, 0], f.mobility[i, 4]
    i11, i12, i22 = work[i, 7], work[i, 8], work[i, 9]
    g1, g2 = a * p1, -o * p2
    o1, o2 = work[i, 10] + i11 * g1 + i12 * g2, work[i, 11] + i12 * g1 + i22 * g2
    work[i, 12] = work[i, 6] * f.mobility[i, 1] - f.mobility[i, 2] * (p2 + o2)
    return o1, o2


@njit(cache=True, fastmath={"contract"})
def _substitute(f: Flat, work: Array, p1: float, p2: float, out: Array) -> None:
    """Joint forces from the middle outwards, angular accelerations, and from them relative ones."""
    n = f.masses.size
    middle = n // 2
    b1, b2 = p1, p2
    for j in range(n - middle):
        i = middle + j
        p1, p2 = _across(f, i, work, p1, p2)
        if i + 1 < n:
            p1, p2 = _turned(work[i + 1, 0], work[i + 1, 1], p1, p2)
        i = middle - 1 - j
        if i >= 0:
            b1, b2 = _turned(work[i + 1, 0], -work[i + 1, 1], b1, b2)
            b1, b2 = _across(f, i, work, b1, b2)
    for i in range(1, n):
        out[i] = work[i, 12] - work[i - 1, 12]


@njit(cache=True, fastmath={"contract"})
def accelerate(f: Flat, t: float, q: Array, v: Array, work: Array, out: Array) -> Any:
    """Relative angular accelerations, (N,), into `out`; (power lost, power put in by loads and hub)."""
    lost, power = _moments(f, t, q, v, work)
    _cosines(q, work)
    _loads(f, t, work)
    p1, p2 = _eliminate(f, work)
    _substitute(f, work, p1, p2, out)
    out[0] = work[0, 12] - hub_motion(f.hub, t)[2]
    return lost, power
