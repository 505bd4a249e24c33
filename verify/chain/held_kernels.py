"""Compiled kernels of the chain's held points, the roller and the actuators: their forces, and the closure."""

import numpy as np

from verify.arrays import Array, Indices
from verify.chain.records import HALF, ROLLER, Flat
from verify.chain.recursion_kernels import direction, hub_motion, solve
from verify.jit import inline

SETTLED = 1e-9
"""Radians: the change of an angle after which another would be below rounding."""


@inline(fastmath={"contract"})
def rise(f: Flat, k: int, work: Array) -> float:
    """Vertical acceleration of a held point for column 12's angular accelerations and column 3's rates."""
    total, link = 0.0, int(f.held[k, 4])
    for i in range(link + 1):
        c, s = direction(work[i, 2])
        reach = 2.0 * f.links[i, HALF] if i < link else f.links[i, HALF] + f.held[k, 0]
        total += reach * (c * work[i, 12] - s * work[i, 3] * work[i, 3])
    return total


@inline
def solve_small(a: Array, n: int) -> None:
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


@inline(fastmath={"contract"})
def hold(f: Flat, t: float, work: Array) -> float:
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
        f.small[k, count] = wanted - rise(f, k + first, work)
    for i in range(n):
        work[i, 15] = work[i, 3]
        work[i, 3] = 0.0
    for k in range(count):
        for i in range(n):
            work[i, 4], work[i, 5], work[i, 6] = 0.0, 0.0, 0.0
        link = int(f.held[k + first, 4])
        work[link, 5], work[link, 4] = direction(work[link, 2])
        work[link, 6] = f.held[k + first, 0] * work[link, 5]
        solve(f, 0.0, work)
        for i in range(n):
            work[i, 16 + k] = work[i, 12]
        for m in range(count):
            f.small[m, k] = rise(f, m + first, work)
    solve_small(f.small, count)
    power = 0.0
    for i in range(n):
        work[i, 3], work[i, 12] = work[i, 15], work[i, 14]
    for k in range(count):
        phase = f.held[k + first, 2] * t + f.held[k + first, 3]
        power -= f.small[k, count] * f.held[k + first, 1] * f.held[k + first, 2] * np.sin(phase)
        for i in range(n):
            work[i, 12] += f.small[k, count] * work[i, 16 + k]
    return power


@inline(fastmath={"contract"})
def place(f: Flat, t: float, q: Array, v: Array, work: Array) -> None:
    """Angles and rates into columns 2, 3; positions and velocities of joints 0..N into 13 to 16."""
    angle, rate, _ = hub_motion(f.numbers, t)
    x, y, vx, vy = 0.0, 0.0, 0.0, 0.0
    for i in range(q.size):
        work[i, 13], work[i, 14], work[i, 15], work[i, 16] = x, y, vx, vy
        angle, rate = angle + q[i], rate + v[i]
        work[i, 2], work[i, 3] = angle, rate
        c, s = direction(angle)
        dx, dy = 2.0 * f.links[i, HALF] * c, 2.0 * f.links[i, HALF] * s
        x, y, vx, vy = x + dx, y + dy, vx - rate * dy, vy + rate * dx
    n = q.size
    work[n, 13], work[n, 14], work[n, 15], work[n, 16] = x, y, vx, vy


@inline(fastmath={"contract"})
def constraints(f: Flat, t: float, pivots: Indices, work: Array, rates: bool) -> None:
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


@inline(fastmath={"contract"})
def project(f: Flat, t: float, q: Array, v: Array, pivots: Indices, work: Array) -> None:
    """Bring dependent angles (Newton, at most 20 times, until a change is below SETTLED) and rates onto held points."""
    count = f.held.shape[0]
    settling = count == 0  # False from here on; written out, numba would compile one copy for it and one for True
    if settling:
        return
    for _ in range(20):
        place(f, t, q, v, work)
        constraints(f, t, pivots, work, settling)
        solve_small(f.small, count)
        change = 0.0
        for d in range(count):
            q[pivots[d]] -= f.small[d, count]
            size = abs(f.small[d, count])
            change = size if size > change else change
        if change < SETTLED:
            constraints(f, t, pivots, work, not settling)
            solve_small(f.small, count)
            for d in range(count):
                v[pivots[d]] -= f.small[d, count]
            return


@inline
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
