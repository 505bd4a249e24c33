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

from verify.models.arrays import Array, Indices

FREE, ROLLER = 0, 1
"""Kinds of tip."""
WORK_COLUMNS = 20
_SMALL = 0.5
"""Relative angles below this take the short series for sine and cosine."""


class Flat(NamedTuple):
    """A chain as the kernels see it: few arrays, because every call hands all of them on. SI."""

    links: Array
    """(N, 10): half length, mass, inertia, joint spring, dashpot, and the columns of `mobilities`."""
    numbers: Array
    """(7,): offset, rate, amplitude, circular frequency and phase of the base's rotation; gravity along x and y."""
    loads: Array
    """(n_loads, 7): arm from the link's middle, F_x, F_y, moment, circular frequency, phase, link from 0."""
    held: Array
    """(n_held, 5), the roller first: arm, amplitude, circular frequency, phase of the y prescribed, link from 0."""
    small: Array
    """(n_held, n_held + 1), scratch."""
    tip: int
    """FREE or ROLLER."""
    tip_spring: float
    """N/m, axial, at the roller."""
    axial: bool
    """Whether the links have inertia along x."""
    ledger: bool
    """Whether the power of loads is worth a pass of its own."""


HALF, MASS, INERTIA, SPRING, DASHPOT, MOBILITY = range(6)
"""Columns of `Flat.links`."""


def mobilities(half: Array, masses: Array, inertias: Array) -> Array:
    """What one link answers to forces at its joints, (N, 5): 1/m, 1/J, h/J, h^2/J + 1/m, h^2/J - 1/m."""
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
    """Angle, rate and acceleration of the base's prescribed rotation, from `Flat.numbers`."""
    if hub[2] == 0.0:
        return hub[0] + hub[1] * t, hub[1], 0.0
    phase = hub[3] * t + hub[4]
    swing, speed = hub[2] * np.sin(phase), hub[2] * hub[3] * np.cos(phase)
    return hub[0] + hub[1] * t + swing, hub[1] + speed, -hub[3] * hub[3] * swing


@njit(cache=True, inline="always", fastmath={"contract"})
def _series(angle: float) -> Any:
    """Cosine and sine of a small angle, to rounding."""
    z = angle * angle
    c = 1.0 / 24 - z * (1.0 / 720 - z * (1.0 / 40320 - z * (1.0 / 3628800 - z * (1 / 479001600 - z / 87178291200))))
    s = 1 / 120 - z * (1 / 5040 - z * (1 / 362880 - z * (1 / 39916800 - z * (1 / 6227020800 - z / 1307674368000))))
    return 1.0 - z * (0.5 - z * c), angle * (1.0 - z * (1.0 / 6 - z * s))


@njit(cache=True, fastmath={"contract"})
def _direction(angle: float) -> Any:
    """Cosine and sine of an angle, by the short series where it is small."""
    if abs(angle) < _SMALL:
        return _series(angle)
    return np.cos(angle), np.sin(angle)


@njit(cache=True, fastmath={"contract"})
def _cosines(angles: Array, work: Array) -> None:
    """Cosine and sine of relative angles into columns 0 and 1."""
    largest = 0.0
    for i in range(angles.size):
        largest = max(largest, abs(angles[i]))
    if not largest <= _SMALL:
        for i in range(angles.size):
            work[i, 0], work[i, 1] = np.cos(angles[i]), np.sin(angles[i])
        return
    for i in range(angles.size):
        work[i, 0], work[i, 1] = _series(angles[i])


@njit(cache=True, fastmath={"contract"})
def _moments(f: Flat, t: float, q: Array, v: Array, work: Array) -> Any:
    """Absolute angles, rates and joint moments into columns 2, 3, 6, forces cleared; (dissipation, hub's power)."""
    angle, rate, _ = hub_motion(f.numbers, t)
    before = -f.links[0, SPRING] * q[0] - f.links[0, DASHPOT] * v[0]
    lost, hub_power = f.links[0, DASHPOT] * v[0] * v[0], before * rate
    n = q.size
    for i in range(n):
        angle += q[i]
        rate += v[i]
        after = 0.0
        if i + 1 < n:
            after = -f.links[i + 1, SPRING] * q[i + 1] - f.links[i + 1, DASHPOT] * v[i + 1]
            lost += f.links[i + 1, DASHPOT] * v[i + 1] * v[i + 1]
        work[i, 2], work[i, 3], work[i, 4], work[i, 5], work[i, 6] = angle, rate, 0.0, 0.0, before - after
        before = after
    return lost, hub_power


@njit(cache=True, fastmath={"contract"})
def _loads(f: Flat, t: float, work: Array) -> None:
    """Point loads: forces along and across each link into columns 4, 5; moments into 6, alone into 13."""
    for k in range(f.loads.shape[0]):
        work[int(f.loads[k, 6]), 13] = 0.0
    for k in range(f.loads.shape[0]):
        i = int(f.loads[k, 6])
        arm, fx, fy, moment, omega, phase, _ = f.loads[k]
        now = np.cos(omega * t + phase)
        c, s = _direction(work[i, 2])
        along, across = now * (c * fx + s * fy), now * (c * fy - s * fx)
        turn = now * moment + arm * across
        work[i, 4], work[i, 5], work[i, 6] = work[i, 4] + along, work[i, 5] + across, work[i, 6] + turn
        work[i, 13] += turn


@njit(cache=True, fastmath={"contract"})
def _load_power(f: Flat, work: Array) -> float:
    """Power of the point loads, from velocities carried from link to link."""
    last = -1
    for k in range(f.loads.shape[0]):
        last = max(last, int(f.loads[k, 6]))
    v1, v2, power = 0.0, 0.0, 0.0
    for i in range(last + 1):
        if i > 0:
            v1, v2 = _turned(work[i, 0], work[i, 1], v1, v2)
        step = f.links[i, HALF] * work[i, 3]
        power += work[i, 4] * v1 + work[i, 5] * (v2 + step)
        v2 += 2.0 * step
    for k in range(f.loads.shape[0]):
        i = int(f.loads[k, 6])
        power += work[i, 13] * work[i, 3]
        work[i, 13] = 0.0
    return power


@njit(cache=True, fastmath={"contract"})
def _weigh(f: Flat, work: Array) -> None:
    """Gravity into columns 4 and 5."""
    gx, gy = f.numbers[5], f.numbers[6]
    if gx != 0.0 or gy != 0.0:
        for i in range(f.links.shape[0]):
            c, s = _direction(work[i, 2])
            work[i, 4] += f.links[i, MASS] * (c * gx + s * gy)
            work[i, 5] += f.links[i, MASS] * (c * gy - s * gx)


@njit(cache=True, inline="always", fastmath={"contract"})
def _terms(f: Flat, i: int, work: Array) -> Any:
    """A = diag(a, b), O = diag(-a, o) of a link, and its ends' accelerations without joint forces."""
    a, along, inward = (
        f.links[i, MOBILITY],
        f.links[i, MOBILITY] * work[i, 4],
        f.links[i, HALF] * work[i, 3] * work[i, 3],
    )
    across, turn = a * work[i, 5], f.links[i, MOBILITY + 2] * work[i, 6]
    return (
        a,
        f.links[i, MOBILITY + 3],
        f.links[i, MOBILITY + 4],
        along + inward,
        across - turn,
        along - inward,
        across + turn,
    )


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
def _tip(f: Flat, pull: float, work: Array) -> Any:
    """The last link seen from its first joint: its tip free, or the roller's unknown force eliminated.

    `pull` is what the axial spring at the roller pulls back with.
    """
    i = f.links.shape[0] - 1
    a, b, o, s1, s2, e1, e2 = _terms(f, i, work)
    i11, i12, i22, r1, r2 = 0.0, 0.0, 0.0, 0.0, 0.0
    if f.tip == ROLLER:
        c, s = _direction(work[i, 2])
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
    for i in range(f.links.shape[0]):
        s = _direction(0.5 * work[i, 2])[1]
        total += 4.0 * f.links[i, HALF] * s * s
    return total


@njit(cache=True, fastmath={"contract"})
def _eliminate(f: Flat, pull: float, work: Array) -> Any:
    """Both sides up to the middle joint; the force there, in the frame of the link behind it."""
    n = f.links.shape[0]
    middle = n // 2
    y11, y12, y22, u1, u2 = _tip(f, pull, work)
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
    a, o = f.links[i, MOBILITY], f.links[i, MOBILITY + 4]
    i11, i12, i22 = work[i, 7], work[i, 8], work[i, 9]
    g1, g2 = a * p1, -o * p2
    o1, o2 = work[i, 10] + i11 * g1 + i12 * g2, work[i, 11] + i12 * g1 + i22 * g2
    work[i, 12] = work[i, 6] * f.links[i, MOBILITY + 1] - f.links[i, MOBILITY + 2] * (p2 + o2)
    return o1, o2


@njit(cache=True, fastmath={"contract"})
def _substitute(f: Flat, work: Array, p1: float, p2: float) -> None:
    """Joint forces from the middle outwards; the links' angular accelerations into column 12."""
    n = f.links.shape[0]
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


@njit(cache=True, fastmath={"contract"})
def _solve_transverse(f: Flat, pull: float, work: Array) -> None:
    """The same for links without inertia along x, whose axial forces are static: one unknown for each joint."""
    n = f.links.shape[0]
    axial, y, u = pull, 0.0, 0.0
    for i in range(n - 1, -1, -1):
        (c, s), h = _direction(work[i, 2]), f.links[i, HALF]
        behind = axial - (c * work[i, 4] - s * work[i, 5])
        moment = work[i, 6] + h * s * (axial + behind)
        lift, a, b = (
            f.links[i, MOBILITY] * (s * work[i, 4] + c * work[i, 5]),
            f.links[i, MOBILITY],
            h * c * f.links[i, MOBILITY + 2] * c,
        )
        turn, inward = f.links[i, MOBILITY + 2] * c * moment, h * work[i, 3] * work[i, 3] * s
        g = 0.0 if i + 1 == n and f.tip == FREE else 1.0 / (a + b + y)
        r = g * (lift + turn - inward - u)
        work[i, 7], work[i, 8], work[i, 9], work[i, 10] = g, r, moment, c
        y, u = a + b - (b - a) * (b - a) * g, lift - turn + inward + (b - a) * r
        axial = behind
    p = -u / y
    for i in range(n):
        b, a = f.links[i, HALF] * work[i, 10] * f.links[i, MOBILITY + 2] * work[i, 10], f.links[i, MOBILITY]
        beyond = work[i, 8] - work[i, 7] * (b - a) * p
        work[i, 12] = work[i, 9] * f.links[i, MOBILITY + 1] - f.links[i, MOBILITY + 2] * work[i, 10] * (p + beyond)
        p = beyond


@njit(cache=True, fastmath={"contract"})
def _solve(f: Flat, pull: float, work: Array) -> None:
    """The links' angular accelerations into column 12 from what stands in columns 0 to 6."""
    if f.axial:
        p1, p2 = _eliminate(f, pull, work)
        _substitute(f, work, p1, p2)
    else:
        _solve_transverse(f, pull, work)


@njit(cache=True, fastmath={"contract"})
def _rise(f: Flat, k: int, work: Array, spins: int) -> float:
    """Vertical acceleration of a held point for the angular accelerations in a column; with column 3's rates."""
    total, link = 0.0, int(f.held[k, 4])
    for i in range(link + 1):
        c, s = _direction(work[i, 2])
        reach = 2.0 * f.links[i, HALF] if i < link else f.links[i, HALF] + f.held[k, 0]
        total += reach * (c * work[i, spins] - s * work[i, 3] * work[i, 3])
    return total


@njit(cache=True)
def _solve_small(a: Array, n: int) -> None:
    """Gauss with row exchange on an (n, n + 1) array; the answer in its last column."""
    for j in range(n):
        best = j
        for i in range(j + 1, n):
            if abs(a[i, j]) > abs(a[best, j]):
                best = i
        for m in range(n + 1):
            a[j, m], a[best, m] = a[best, m], a[j, m]
        for i in range(n):
            if i != j:
                ratio = a[i, j] / a[j, j]
                for m in range(j, n + 1):
                    a[i, m] -= ratio * a[j, m]
    for j in range(n):
        a[j, n] /= a[j, j]


@njit(cache=True, fastmath={"contract"})
def _hold(f: Flat, t: float, work: Array) -> float:
    """Forces of the actuators that keep their points on the prescribed y; their power.

    Each actuator's unit force is solved for by itself: a Schur complement of the size of their number.
    """
    n, first = f.links.shape[0], 1 if f.tip == ROLLER else 0
    count = f.held.shape[0] - first
    for i in range(n):
        work[i, 14] = work[i, 12]
    for k in range(count):
        phase = f.held[k + first, 2] * t + f.held[k + first, 3]
        wanted = -f.held[k + first, 1] * f.held[k + first, 2] ** 2 * np.cos(phase)
        f.small[k, count] = wanted - _rise(f, k + first, work, 14)
    for i in range(n):
        work[i, 15] = work[i, 3]
        work[i, 3] = 0.0
    for k in range(count):
        for i in range(n):
            work[i, 4], work[i, 5], work[i, 6] = 0.0, 0.0, 0.0
        link = int(f.held[k + first, 4])
        work[link, 5], work[link, 4] = _direction(work[link, 2])
        work[link, 6] = f.held[k + first, 0] * work[link, 5]
        _solve(f, 0.0, work)
        for i in range(n):
            work[i, 16 + k] = work[i, 12]
        for m in range(count):
            f.small[m, k] = _rise(f, m + first, work, 12)
    _solve_small(f.small, count)
    power = 0.0
    for i in range(n):
        work[i, 3], work[i, 12] = work[i, 15], work[i, 14]
    for k in range(count):
        phase = f.held[k + first, 2] * t + f.held[k + first, 3]
        power -= f.small[k, count] * f.held[k + first, 1] * f.held[k + first, 2] * np.sin(phase)
        for i in range(n):
            work[i, 12] += f.small[k, count] * work[i, 16 + k]
    return power


@njit(cache=True, fastmath={"contract"})
def accelerate(f: Flat, t: float, q: Array, v: Array, work: Array, out: Array) -> Any:
    """Relative angular accelerations, (N,), into `out`; (power lost, power put in by loads, actuators and hub)."""
    lost, power = _moments(f, t, q, v, work)
    if f.axial or f.ledger:
        _cosines(q, work)
    _loads(f, t, work)
    if f.ledger:
        power += _load_power(f, work)
    _weigh(f, work)
    pull = -f.tip_spring * shortening(f, work) if f.tip_spring > 0.0 else 0.0
    _solve(f, pull, work)
    if f.held.shape[0] > (1 if f.tip == ROLLER else 0):
        power += _hold(f, t, work)
    out[0] = work[0, 12] - hub_motion(f.numbers, t)[2]
    for i in range(1, q.size):
        out[i] = work[i, 12] - work[i - 1, 12]
    return lost, power


@njit(cache=True, fastmath={"contract"})
def place(f: Flat, t: float, q: Array, v: Array, work: Array) -> None:
    """Angles and rates into columns 2, 3; positions and velocities of joints 0..N into 13 to 16."""
    angle, rate, _ = hub_motion(f.numbers, t)
    x, y, vx, vy = 0.0, 0.0, 0.0, 0.0
    for i in range(q.size):
        work[i, 13], work[i, 14], work[i, 15], work[i, 16] = x, y, vx, vy
        angle, rate = angle + q[i], rate + v[i]
        work[i, 2], work[i, 3] = angle, rate
        c, s = _direction(angle)
        dx, dy = 2.0 * f.links[i, HALF] * c, 2.0 * f.links[i, HALF] * s
        x, y, vx, vy = x + dx, y + dy, vx - rate * dy, vy + rate * dx
    n = q.size
    work[n, 13], work[n, 14], work[n, 15], work[n, 16] = x, y, vx, vy


@njit(cache=True, fastmath={"contract"})
def _constraints(f: Flat, t: float, pivots: Indices, work: Array, rates: bool) -> None:
    """Residuals of the held points (or of their rates), and derivatives by the dependent angles, into `small`."""
    count = f.held.shape[0]
    for k in range(count):
        i = int(f.held[k, 4])
        arm = f.links[i, HALF] + f.held[k, 0]
        share = arm / (2.0 * f.links[i, HALF])
        omega, phase = f.held[k, 2], f.held[k, 2] * t + f.held[k, 3]
        x = work[i, 13] + share * (work[i + 1, 13] - work[i, 13])
        column = 16 if rates else 14
        value = work[i, column] + share * (work[i + 1, column] - work[i, column])
        wanted = -f.held[k, 1] * omega * np.sin(phase) if rates else f.held[k, 1] * np.cos(phase)
        f.small[k, count] = value - wanted
        for d in range(count):
            f.small[k, d] = x - work[pivots[d], 13] if pivots[d] <= i else 0.0


@njit(cache=True, fastmath={"contract"})
def project(f: Flat, t: float, q: Array, v: Array, pivots: Indices, settled: float, work: Array) -> float:
    """Bring dependent angles (Newton, until a change is below `settled`) and rates onto the held points.

    The largest change of an angle; infinite where 20 steps do not suffice.
    """
    count, moved = f.held.shape[0], 0.0
    if count == 0:
        return 0.0
    for _ in range(20):
        place(f, t, q, v, work)
        _constraints(f, t, pivots, work, False)
        _solve_small(f.small, count)
        change = 0.0
        for d in range(count):
            q[pivots[d]] -= f.small[d, count]
            change = max(change, abs(f.small[d, count]))
        moved = max(moved, change)
        if change < settled:
            _constraints(f, t, pivots, work, True)
            _solve_small(f.small, count)
            for d in range(count):
                v[pivots[d]] -= f.small[d, count]
            return moved
    return np.inf


@njit(cache=True)
def repivot(f: Flat, pivots: Indices, work: Array, loss: float) -> bool:
    """Exchange the roller's dependent angle, where it is the only one, if its lever arm has become short."""
    if f.held.shape[0] != 1:
        return False
    link, best = int(f.held[0, 4]), 0
    x = work[link + 1, 13]
    for i in range(link + 1):
        if abs(x - work[i, 13]) > abs(x - work[best, 13]):
            best = i
    if abs(x - work[pivots[0], 13]) >= loss * abs(x - work[best, 13]):
        return False
    pivots[0] = best
    return True


@njit(cache=True, fastmath={"contract"})
def energies(f: Flat, t: float, q: Array, v: Array, work: Array) -> Any:
    """Kinetic, elastic (joints and axial spring) and gravitational energy, joule."""
    place(f, t, q, v, work)
    kinetic, elastic, height = 0.0, 0.0, 0.0
    for i in range(q.size):
        vx, vy = 0.5 * (work[i, 15] + work[i + 1, 15]), 0.5 * (work[i, 16] + work[i + 1, 16])
        along = vx * vx if f.axial else 0.0
        kinetic += 0.5 * (f.links[i, MASS] * (along + vy * vy) + f.links[i, INERTIA] * work[i, 3] ** 2)
        elastic += 0.5 * f.links[i, SPRING] * q[i] * q[i]
        x, y = 0.5 * (work[i, 13] + work[i + 1, 13]), 0.5 * (work[i, 14] + work[i + 1, 14])
        height -= f.links[i, MASS] * (f.numbers[5] * x + f.numbers[6] * y)
    if f.tip_spring > 0.0:
        elastic += 0.5 * f.tip_spring * shortening(f, work) ** 2
    return kinetic, elastic, height


@njit(cache=True, fastmath={"contract"})
def derivative(f: Flat, t: float, y: Array, work: Array, out: Array) -> None:
    """Rates of the state (q, v, energy lost, work put in), (2N + 2,)."""
    n = f.links.shape[0]
    out[2 * n], out[2 * n + 1] = accelerate(f, t, y[:n], y[n : 2 * n], work, out[n : 2 * n])
    for i in range(n):
        out[i] = y[n + i]


@njit(cache=True, fastmath={"contract"})
def _stages(f: Flat, t: float, h: float, y: Array, a: Array, c: Array, k: Array, new: Array, work: Array) -> None:
    """Stages 1.. of an explicit Runge-Kutta step into k[1:], its answer (the last row of `a`) into `new`."""
    stages = a.shape[1]
    for s in range(1, stages + 1):
        new[:] = y
        for j in range(s):
            if a[s, j] != 0.0:
                weight = h * a[s, j]
                for i in range(y.size):
                    new[i] += weight * k[j, i]
        if s < stages:
            derivative(f, t + c[s] * h, new, work, k[s])


@njit(cache=True, fastmath={"contract"})
def _keep(t: float, h: float, at: float, y: Array, new: Array, k0: Array, k1: Array, n: int, out: Array) -> None:
    """The state at a time within a step: quintic Hermite in the angles, its derivative in the rates."""
    s = (at - t) / h
    r = 1.0 - s
    a0, a1 = r**3 * (1 + 3 * s + 6 * s * s), s**3 * (1 + 3 * r + 6 * r * r)
    b0, b1 = h * r**3 * s * (1 + 3 * s), -h * s**3 * r * (1 + 3 * r)
    c0, c1 = 0.5 * h * h * r**3 * s * s, 0.5 * h * h * s**3 * r * r
    d = 30 * s * s * r * r / h
    e0, e1 = r * r * (1 + 2 * s - 15 * s * s), s * s * (1 + 2 * r - 15 * r * r)
    g0, g1 = 0.5 * h * s * r * r * (2 - 5 * s), -0.5 * h * r * s * s * (2 - 5 * r)
    for i in range(n):
        j = n + i
        out[i] = a0 * y[i] + a1 * new[i] + b0 * y[j] + b1 * new[j] + c0 * k0[j] + c1 * k1[j]
        out[j] = d * (new[i] - y[i]) + e0 * y[j] + e1 * new[j] + g0 * k0[j] + g1 * k1[j]
    u0, u1 = r * r * (1 + 2 * s), s * s * (1 + 2 * r)
    for i in range(2 * n, y.size):
        out[i] = u0 * y[i] + u1 * new[i] + h * s * r * (r * k0[i] - s * k1[i])


RUNNING, DONE, DIVERGED, TOO_SMALL = 0, 1, 2, 3
"""What `march` returns."""


@njit(cache=True, fastmath={"contract"})
def _error(n: int, h: float, k: Array, weights: Array, y: Array, scale: Array) -> float:
    """Norm of a step's estimated error over its tolerance: angles and rates each by their root mean square.

    `scale` is relative tolerance, absolute tolerance of the angles, of the rates, and the largest means of `y` so far.
    """
    worst = 0.0
    for part in range(2):
        error, size = 0.0, 0.0
        for i in range(part * n, (part + 1) * n):
            e = 0.0
            for j in range(weights.size):
                e += weights[j] * k[j, i]
            error += e * e
            size += y[i] * y[i]
        scale[3 + part] = max(scale[3 + part], np.sqrt(size / n))
        worst = max(worst, h * np.sqrt(error / n) / (scale[1 + part] + scale[0] * scale[3 + part]))
    return worst


@njit(cache=True, fastmath={"contract"})
def _torn(rates: Array, h: float) -> bool:
    """Whether rates are not finite, or one step would turn a joint by more than half a turn."""
    fine = True
    for i in range(rates.size):
        fine = fine and abs(rates[i]) * h < np.pi
    return not fine


@njit(cache=True, fastmath={"contract"})
def _propose(error: float, order: float, h: float) -> Any:
    """The next step after one with this error over its tolerance."""
    if not error >= 0.0:
        return 0.2 * h
    return h * min(4.0, max(0.2, 0.9 * max(error, 1e-10) ** (-1.0 / order)))


class March(NamedTuple):
    """An explicit Runge-Kutta run as the kernels see it: its method, its state and what it keeps."""

    a: Array
    """(s + 1, s), the last row the answer."""
    c: Array
    """(s,)."""
    weights: Array
    """(s + 1,), of the error estimate; empty for a fixed step."""
    order: float
    y: Array
    """(2N + 2,): angles, rates, energy lost, work put in."""
    new: Array
    """(2N + 2,), scratch."""
    k: Array
    """(s + 1, 2N + 2); k[0] holds the rates at y."""
    clock: Array
    """(3,): time, step, and the share of the longest lever arm below which a dependent angle is exchanged."""
    counts: Indices
    """(5,): steps, rejected steps, evaluations, samples kept, exchanges."""
    samples: Array
    """(n,), times to keep."""
    kept: Array
    """(n, 2N + 2)."""
    scale: Array
    """(5,): relative tolerance, absolute ones of angles and rates, the largest means of both so far."""
    pivots: Indices
    """(n_held,), dependent angles."""


@njit(cache=True, fastmath={"contract"})
def _keep_samples(m: March, t: float, h: float) -> None:
    """What lies within an accepted step."""
    last, n = m.k.shape[0] - 1, m.y.size // 2 - 1
    while m.counts[3] < m.samples.size and m.samples[m.counts[3]] <= (t + h) * (1.0 + 1e-12):
        _keep(t, h, m.samples[m.counts[3]], m.y, m.new, m.k[0], m.k[last], n, m.kept[m.counts[3]])
        m.counts[3] += 1


@njit(cache=True, fastmath={"contract"})
def march(f: Flat, m: March, budget: int, work: Array) -> int:
    """At most `budget` steps, fixed or held to the tolerances of `scale`; each ends on the held points."""
    n, last = f.links.shape[0], m.k.shape[0] - 1
    for _ in range(budget):
        if m.counts[3] >= m.samples.size:
            return DONE
        t, h = m.clock[0], m.clock[1]
        if t + h == t:
            return TOO_SMALL
        _stages(f, t, h, m.y, m.a, m.c, m.k, m.new, work)
        if _torn(m.new[n : 2 * n], h) and m.weights.size == 0:
            return DIVERGED
        project(f, t + h, m.new[:n], m.new[n : 2 * n], m.pivots, 1e-9, work)
        m.counts[4] += repivot(f, m.pivots, work, m.clock[2])
        derivative(f, t + h, m.new, work, m.k[last])
        m.counts[2] += m.a.shape[1]
        if m.weights.size > 0:
            error = _error(n, h, m.k, m.weights, m.y, m.scale)
            m.clock[1] = _propose(error, m.order, h)
            if not error <= 1.0:
                m.counts[1] += 1
                continue
        m.counts[0] += 1
        m.clock[0] = t + h
        _keep_samples(m, t, h)
        m.y[:], m.k[0] = m.new, m.k[last]
    return DONE if m.counts[3] >= m.samples.size else RUNNING


@njit(cache=True, fastmath={"contract"})
def _expand(modes: Array, state: Array, rest: Array, q: Array, v: Array) -> None:
    """Angles and rates from modal coordinates, (m, 2); `modes` is (m, N)."""
    q[:] = rest
    v[:] = 0.0
    even = modes.shape[0] // 2 * 2
    for j in range(0, even, 2):
        a, b, c, d = state[j, 0], state[j, 1], state[j + 1, 0], state[j + 1, 1]
        for i in range(q.size):
            q[i] += a * modes[j, i] + c * modes[j + 1, i]
            v[i] += b * modes[j, i] + d * modes[j + 1, i]
    for j in range(even, modes.shape[0]):
        for i in range(q.size):
            q[i] += state[j, 0] * modes[j, i]
            v[i] += state[j, 1] * modes[j, i]


@njit(cache=True, fastmath={"contract", "reassoc"})
def _reduce(duals: Array, a: Array, out: Array) -> None:
    """Modal accelerations, (m,); `duals` is (m, N)."""
    for j in range(duals.shape[0]):
        total = 0.0
        for i in range(a.size):
            total += duals[j, i] * a[i]
        out[j] = total


@njit(cache=True, fastmath={"contract"})
def _rotate(turns: Array, state: Array) -> None:
    """Exact linear flow: `turns` (m, 3) holds cos, sin / omega and - omega sin of the step."""
    for j in range(turns.shape[0]):
        x, y = state[j, 0], state[j, 1]
        state[j, 0], state[j, 1] = turns[j, 0] * x + turns[j, 1] * y, turns[j, 2] * x + turns[j, 0] * y


@njit(cache=True, fastmath={"contract"})
def forced(t: float, drives: Array, shares: Array, out: Array) -> None:
    """Steady answer of the modes to the harmonic loads, (m, 2); `shares` is (n_loads, m)."""
    out[:] = 0.0
    for k in range(drives.shape[0]):
        phase = drives[k, 0] * t + drives[k, 1]
        now, rate = np.cos(phase), -drives[k, 0] * np.sin(phase)
        for j in range(shares.shape[1]):
            out[j, 0] += shares[k, j] * now
            out[j, 1] += shares[k, j] * rate


@njit(cache=True, fastmath={"contract"})
def _close(f: Flat, tilt: float, free: Array, work: Array) -> None:
    """One chord step of the roller's closure along the last mode, which turns the tip off its line by `tilt`."""
    gap, speed = 0.0, 0.0
    for i in range(f.links.shape[0]):
        c, s = _direction(work[i, 2])
        gap += 2.0 * f.links[i, HALF] * s
        speed += 2.0 * f.links[i, HALF] * c * work[i, 3]
    last = free.shape[0] - 1
    free[last, 0] -= gap / tilt
    free[last, 1] -= speed / tilt


@njit(cache=True, fastmath={"contract"})
def _flow(omega: Array, time: float, start: Array, out: Array) -> None:
    """Exact linear flow of a time from one state to another."""
    for j in range(omega.size):
        w, x, y = omega[j], start[j, 0], start[j, 1]
        c, s = np.cos(w * time), np.sin(w * time)
        out[j, 0] = c * x + (s / w if w > 0.0 else time) * y
        out[j, 1] = c * y - w * s * x


@njit(cache=True, fastmath={"contract"})
def _between(s: float, h: float, omega: Array, flowing: Array, miss: Array, steady: Array, out: Array) -> None:
    """Modal state at a share s of a step, (2, m): the linear flow from its start, a cubic through what kicks added."""
    slow0, slow1 = s * s * (3.0 - 2.0 * s), h * s * s * (s - 1.0)
    rate0, rate1 = 6.0 * s * (1.0 - s) / h, s * (3.0 * s - 2.0)
    for j in range(omega.size):
        a, b = miss[j, 0], miss[j, 1]
        if omega[j] * h > 2.0:
            out[0, j], out[1, j] = s * a, s * b
        else:
            out[0, j], out[1, j] = slow0 * a + slow1 * b, rate0 * a + rate1 * b
        out[0, j] += flowing[j, 0] + steady[j, 0]
        out[1, j] += flowing[j, 1] + steady[j, 1]


class Modal(NamedTuple):
    """A splitting in modal coordinates as the kernels see it, and its scratch."""

    kicks: Array
    """(n_kicks,), shares of the step."""
    shares_of_step: Array
    """(n_kicks + 1,), of the flows between them."""
    flows: Array
    """(n_kicks + 2, m, 3): turns of those flows, and of the whole step."""
    spacing: Array
    """(m, 3): turns between two samples where these are evenly spaced; empty elsewhere."""
    omega: Array
    """(m,), rad/s."""
    modes: Array
    """(m, N)."""
    duals: Array
    """(m, N)."""
    rest: Array
    """(N,), angles that the modes are about."""
    drives: Array
    """(n_loads, 2), circular frequencies and phases."""
    shares: Array
    """(n_loads, m), steady amplitudes."""
    tilt: float
    """Metres: how far the last mode moves the tip off the roller's line; 0 without a roller."""
    start: Array
    """(m, 2)."""
    steady: Array
    """(m, 2)."""
    trial: Array
    """(m, 2)."""
    vectors: Array
    """(3, N)."""
    force: Array
    """(m,)."""


@njit(cache=True, fastmath={"contract"})
def _kick(f: Flat, d: Modal, t: float, h: float, free: Array, work: Array) -> None:
    """Nonlinear kick of a step h: what the linear flow leaves out of the accelerations, by the explicit mid-point.

    `free` is the modal state without the steady answer.
    """
    forced(t, d.drives, d.shares, d.steady)
    for half in range(2):
        for j in range(free.shape[0]):
            d.trial[j, 0] = free[j, 0] + d.steady[j, 0]
            d.trial[j, 1] = free[j, 1] + d.steady[j, 1] + (0.5 * h * d.force[j] if half else 0.0)
        _expand(d.modes, d.trial, d.rest, d.vectors[0], d.vectors[1])
        accelerate(f, t, d.vectors[0], d.vectors[1], work, d.vectors[2])
        _reduce(d.duals, d.vectors[2], d.force)
        for j in range(free.shape[0]):
            d.force[j] += d.omega[j] * d.omega[j] * free[j, 0]
        for k in range(d.drives.shape[0]):  # the steady answer's own acceleration
            now = d.drives[k, 0] * d.drives[k, 0] * np.cos(d.drives[k, 0] * t + d.drives[k, 1])
            for j in range(free.shape[0]):
                d.force[j] += now * d.shares[k, j]
    for j in range(free.shape[0]):
        free[j, 1] += h * d.force[j]


@njit(cache=True, fastmath={"contract"})
def _keep_modal(d: Modal, t: float, h: float, counts: Indices, samples: Array, kept: Array, free: Array) -> None:
    """Samples within a step that went from `d.start` to `free`; an even spacing takes one sine for each mode."""
    miss, first = d.trial, True
    miss[:] = d.start
    _rotate(d.flows[d.kicks.size + 1], miss)
    for j in range(free.shape[0]):
        miss[j, 0], miss[j, 1] = free[j, 0] - miss[j, 0], free[j, 1] - miss[j, 1]
    while counts[3] < samples.size and samples[counts[3]] <= (t + h) * (1.0 + 1e-12):
        at = samples[counts[3]]
        if first or d.spacing.shape[0] == 0:
            if first:
                _flow(d.omega, at - t, d.start, d.start)
            else:
                _flow(d.omega, at - samples[counts[3] - 1], d.start, d.start)
        else:
            _rotate(d.spacing, d.start)
        first = False
        forced(at, d.drives, d.shares, d.steady)
        _between((at - t) / h, h, d.omega, d.start, miss, d.steady, kept[counts[3]])
        counts[3] += 1


@njit(cache=True, fastmath={"contract"})
def march_modal(
    f: Flat, d: Modal, clock: Array, counts: Indices, samples: Array, kept: Array, budget: int, free: Array, work: Array
) -> int:
    """Exact linear flow of the modes and nonlinear kicks in turn, a fixed step; modal states are kept.

    A step is flow 0, kick 0, flow 1, ..., the last flow.
    """
    h = clock[1]
    for _ in range(budget):
        if counts[3] >= samples.size:
            return DONE
        t = clock[0]
        d.start[:] = free
        for k in range(d.kicks.size):
            _rotate(d.flows[k], free)
            t += d.shares_of_step[k] * h
            _kick(f, d, t, d.kicks[k] * h, free, work)
            if d.tilt != 0.0:
                _close(f, d.tilt, free, work)
        _rotate(d.flows[d.kicks.size], free)
        if _torn(d.vectors[1], h):
            return DIVERGED
        counts[0] += 1
        counts[2] += 2 * d.kicks.size
        if counts[3] < samples.size and samples[counts[3]] <= (clock[0] + h) * (1.0 + 1e-12):
            _keep_modal(d, clock[0], h, counts, samples, kept, free)
        clock[0] += h
    return DONE if counts[3] >= samples.size else RUNNING
