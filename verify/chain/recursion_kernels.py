"""Compiled forward dynamics of the planar chain of rigid links in O(N): forces and moments, and their elimination.

Kernels see flat arrays and allocate nothing.

Link i (0..N-1) has the frame (n_i, e_i), along and across it. Joint i lies between links i - 1 and i and carries
the force p_i on link i. Coordinates are the relative angles q_i and their rates; frames of neighbours differ by q_i,
so that the recursion needs no absolute angle but where a load or a support has a direction of its own. Seen from one
side, a part of the chain answers a force at its end by an acceleration, a 2 x 2 mobility; links are added to it one by
one, from the base and from the tip at once, and both sides meet in the middle. The roller's force is part of the
elimination: no multiplier is left over. (Articulated bodies seen from the joints: R. Featherstone, Rigid Body
Dynamics Algorithms, 2008, chapter 7; meeting in the middle is the twisted factorisation of a tridiagonal matrix.)
"""

import numpy as np

from verify.arrays import Array
from verify.chain.records import DASHPOT, FREE, HALF, MASS, MOBILITY, ROLLER, SPRING, Flat
from verify.jit import inline

Side = tuple[float, float, float, float, float]
"""A part of the chain seen from its end: mobility (xx, xy, yy) and its acceleration without a force there."""
SMALL = 0.5
"""Relative angles below this take the short series for sine and cosine."""


@inline(fastmath={"contract"})
def turned(c: float, s: float, x: float, y: float) -> tuple[float, float]:
    """A vector in a frame turned by the angle with cosine c and sine s."""
    return c * x + s * y, c * y - s * x


@inline(fastmath={"contract"})
def _turned_matrix(c: float, s: float, x11: float, x12: float, x22: float) -> tuple[float, float, float]:
    """A symmetric matrix in a frame turned by the angle with cosine c and sine s."""
    c2, s2 = c * c - s * s, 2.0 * c * s
    mean, half = 0.5 * (x11 + x22), 0.5 * (x11 - x22)
    d, off = c2 * half + s2 * x12, c2 * x12 - s2 * half
    return mean + d, off, mean - d


@inline(fastmath={"contract"})
def _inverse(x11: float, x12: float, x22: float) -> tuple[float, float, float]:
    """The inverse of a symmetric 2 x 2 matrix."""
    d = 1.0 / (x11 * x22 - x12 * x12)
    return x22 * d, -x12 * d, x11 * d


@inline(fastmath={"contract"})
def hub_motion(hub: Array, t: float) -> tuple[float, float, float]:
    """Angle, rate and acceleration of the base's prescribed rotation, from `Flat.numbers`."""
    if hub[2] == 0.0:
        return hub[0] + hub[1] * t, hub[1], 0.0
    phase = hub[3] * t + hub[4]
    swing, speed = hub[2] * np.sin(phase), hub[2] * hub[3] * np.cos(phase)
    return hub[0] + hub[1] * t + swing, hub[1] + speed, -hub[3] * hub[3] * swing


@inline(fastmath={"contract"})
def _series(angle: float) -> tuple[float, float]:
    """Cosine and sine of a small angle, to rounding."""
    z = angle * angle
    c = 1.0 / 24 - z * (1.0 / 720 - z * (1.0 / 40320 - z * (1.0 / 3628800 - z * (1 / 479001600 - z / 87178291200))))
    s = 1 / 120 - z * (1 / 5040 - z * (1 / 362880 - z * (1 / 39916800 - z * (1 / 6227020800 - z / 1307674368000))))
    return 1.0 - z * (0.5 - z * c), angle * (1.0 - z * (1.0 / 6 - z * s))


@inline(fastmath={"contract"})
def direction(angle: float) -> tuple[float, float]:
    """Cosine and sine of an angle, by the short series where it is small."""
    if abs(angle) < SMALL:
        return _series(angle)
    return np.cos(angle), np.sin(angle)


@inline(fastmath={"contract"})
def cosines(angles: Array, work: Array) -> None:
    """Cosine and sine of relative angles into columns 0 and 1."""
    largest = 0.0
    for i in range(angles.size):
        size = abs(angles[i])
        largest = size if size > largest else largest
    if not largest <= SMALL:
        for i in range(angles.size):
            work[i, 0], work[i, 1] = np.cos(angles[i]), np.sin(angles[i])
        return
    for i in range(angles.size):
        work[i, 0], work[i, 1] = _series(angles[i])


@inline(fastmath={"contract"})
def moments(f: Flat, t: float, q: Array, v: Array, work: Array) -> tuple[float, float]:
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


@inline(fastmath={"contract"})
def loads(f: Flat, t: float, work: Array) -> None:
    """Point loads: forces along and across each link into columns 4, 5; moments into 6, alone into 13."""
    for k in range(f.loads.shape[0]):
        work[int(f.loads[k, 6]), 13] = 0.0
    for k in range(f.loads.shape[0]):
        i = int(f.loads[k, 6])
        arm, fx, fy, moment = f.loads[k, 0], f.loads[k, 1], f.loads[k, 2], f.loads[k, 3]
        now = np.cos(f.loads[k, 4] * t + f.loads[k, 5])
        c, s = direction(work[i, 2])
        along, across = now * (c * fx + s * fy), now * (c * fy - s * fx)
        turn = now * moment + arm * across
        work[i, 4], work[i, 5], work[i, 6] = work[i, 4] + along, work[i, 5] + across, work[i, 6] + turn
        work[i, 13] += turn


@inline(fastmath={"contract"})
def load_power(f: Flat, work: Array) -> float:
    """Power of the point loads, from velocities carried from link to link."""
    last = -1
    for k in range(f.loads.shape[0]):
        last = max(last, int(f.loads[k, 6]))
    v1, v2, power = 0.0, 0.0, 0.0
    for i in range(last + 1):
        if i > 0:
            v1, v2 = turned(work[i, 0], work[i, 1], v1, v2)
        step = f.links[i, HALF] * work[i, 3]
        power += work[i, 4] * v1 + work[i, 5] * (v2 + step)
        v2 += 2.0 * step
    for k in range(f.loads.shape[0]):
        i = int(f.loads[k, 6])
        power += work[i, 13] * work[i, 3]
        work[i, 13] = 0.0
    return power


@inline(fastmath={"contract"})
def weigh(f: Flat, work: Array) -> None:
    """Gravity into columns 4 and 5."""
    gx, gy = f.numbers[5], f.numbers[6]
    if gx != 0.0 or gy != 0.0:
        for i in range(f.links.shape[0]):
            c, s = direction(work[i, 2])
            work[i, 4] += f.links[i, MASS] * (c * gx + s * gy)
            work[i, 5] += f.links[i, MASS] * (c * gy - s * gx)


@inline(fastmath={"contract"})
def _terms(f: Flat, i: int, work: Array) -> tuple[float, float, float, float, float, float, float]:
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


@inline(fastmath={"contract"})
def _from_base(f: Flat, i: int, work: Array, x11: float, x12: float, x22: float, z1: float, z2: float) -> Side:
    """Add link i to the part behind its first joint; the answer stands in the frame of link i."""
    a, b, o, s1, s2, e1, e2 = _terms(f, i, work)
    i11, i12, i22 = _inverse(x11 + a, x12, x22 + b)
    d1, d2 = z1 - s1, z2 - s2
    r1, r2 = i11 * d1 + i12 * d2, i12 * d1 + i22 * d2
    work[i, 7], work[i, 8], work[i, 9], work[i, 10], work[i, 11] = i11, i12, i22, r1, r2
    return a - a * a * i11, a * o * i12, b - o * o * i22, e1 + a * r1, e2 - o * r2


@inline(fastmath={"contract"})
def _from_tip(f: Flat, i: int, work: Array, y11: float, y12: float, y22: float, u1: float, u2: float) -> Side:
    """Add link i to the part beyond its second joint (given in the frame of link i)."""
    a, b, o, s1, s2, e1, e2 = _terms(f, i, work)
    i11, i12, i22 = _inverse(y11 + a, y12, y22 + b)
    d1, d2 = e1 - u1, e2 - u2
    r1, r2 = i11 * d1 + i12 * d2, i12 * d1 + i22 * d2
    work[i, 7], work[i, 8], work[i, 9], work[i, 10], work[i, 11] = i11, i12, i22, r1, r2
    return a - a * a * i11, a * o * i12, b - o * o * i22, s1 - a * r1, s2 + o * r2


@inline(fastmath={"contract"})
def _tip(f: Flat, pull: float, work: Array) -> Side:
    """The last link seen from its first joint: its tip free, or the roller's unknown force eliminated.

    `pull` is what the axial spring at the roller pulls back with.
    """
    i = f.links.shape[0] - 1
    a, b, o, s1, s2, e1, e2 = _terms(f, i, work)
    i11, i12, i22, r1, r2 = 0.0, 0.0, 0.0, 0.0, 0.0
    if f.tip == ROLLER:
        c, s = direction(work[i, 2])
        along, across = pull * c, -pull * s
        g = 1.0 / (a * s * s + b * c * c)
        i11, i12, i22 = g * s * s, g * s * c, g * c * c
        d1, d2 = e1 - a * along, e2 - b * across
        r1, r2 = i11 * d1 + i12 * d2 + along, i12 * d1 + i22 * d2 + across
    work[i, 7], work[i, 8], work[i, 9], work[i, 10], work[i, 11] = i11, i12, i22, r1, r2
    return a - a * a * i11, a * o * i12, b - o * o * i22, s1 - a * r1, s2 + o * r2


@inline(fastmath={"contract"})
def shortening(f: Flat, work: Array) -> float:
    """How far the tip stands back from the straight chain's, from absolute angles in column 2, metres."""
    total = 0.0
    for i in range(f.links.shape[0]):
        s = direction(0.5 * work[i, 2])[1]
        total += 4.0 * f.links[i, HALF] * s * s
    return total


@inline(fastmath={"contract"})
def _eliminate(f: Flat, pull: float, work: Array) -> tuple[float, float]:
    """Both sides up to the middle joint; the force there, in the frame of the link behind it."""
    n = f.links.shape[0]
    middle = n // 2
    y11, y12, y22, u1, u2 = _tip(f, pull, work)
    x11, x12, x22, z1, z2 = 0.0, 0.0, 0.0, 0.0, 0.0
    for j in range(middle):
        x11, x12, x22, z1, z2 = _from_base(f, j, work, x11, x12, x22, z1, z2)
        c, s = work[j + 1, 0], work[j + 1, 1]
        x11, x12, x22 = _turned_matrix(c, s, x11, x12, x22)
        z1, z2 = turned(c, s, z1, z2)
        i = n - 2 - j
        if i >= middle:
            c, s = work[i + 1, 0], work[i + 1, 1]
            y11, y12, y22 = _turned_matrix(c, -s, y11, y12, y22)
            u1, u2 = turned(c, -s, u1, u2)
            y11, y12, y22, u1, u2 = _from_tip(f, i, work, y11, y12, y22, u1, u2)
    i11, i12, i22 = _inverse(x11 + y11, x12 + y12, x22 + y22)
    return i11 * (z1 - u1) + i12 * (z2 - u2), i12 * (z1 - u1) + i22 * (z2 - u2)


@inline(fastmath={"contract"})
def _across(f: Flat, i: int, work: Array, p1: float, p2: float) -> tuple[float, float]:
    """The force at the other end of link i (both in its frame), and the link's angular acceleration."""
    a, o = f.links[i, MOBILITY], f.links[i, MOBILITY + 4]
    i11, i12, i22 = work[i, 7], work[i, 8], work[i, 9]
    g1, g2 = a * p1, -o * p2
    o1, o2 = work[i, 10] + i11 * g1 + i12 * g2, work[i, 11] + i12 * g1 + i22 * g2
    work[i, 12] = work[i, 6] * f.links[i, MOBILITY + 1] - f.links[i, MOBILITY + 2] * (p2 + o2)
    return o1, o2


@inline(fastmath={"contract"})
def _substitute(f: Flat, work: Array, p1: float, p2: float) -> None:
    """Joint forces from the middle outwards; the links' angular accelerations into column 12."""
    n = f.links.shape[0]
    middle = n // 2
    b1, b2 = p1, p2
    for j in range(n - middle):
        i = middle + j
        p1, p2 = _across(f, i, work, p1, p2)
        if i + 1 < n:
            p1, p2 = turned(work[i + 1, 0], work[i + 1, 1], p1, p2)
        i = middle - 1 - j
        if i >= 0:
            b1, b2 = turned(work[i + 1, 0], -work[i + 1, 1], b1, b2)
            b1, b2 = _across(f, i, work, b1, b2)


@inline(fastmath={"contract"})
def _solve_transverse(f: Flat, pull: float, work: Array) -> None:
    """The same for links without inertia along x, whose axial forces are static: one unknown for each joint."""
    n = f.links.shape[0]
    axial, y, u = pull, 0.0, 0.0
    for i in range(n - 1, -1, -1):
        (c, s), h = direction(work[i, 2]), f.links[i, HALF]
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


@inline(fastmath={"contract"})
def solve(f: Flat, pull: float, work: Array) -> None:
    """The links' angular accelerations into column 12 from what stands in columns 0 to 6."""
    if f.axial:
        p1, p2 = _eliminate(f, pull, work)
        _substitute(f, work, p1, p2)
    else:
        _solve_transverse(f, pull, work)
