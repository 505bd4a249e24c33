"""Compiled kernels of the chain whose links stretch.

With a stretch of its own, uniform along the link, a link's motion is linear in the positions of its two joints: its
mass matrix is constant and tridiagonal, the same along x and y, and no joint force is unknown. Displacements from the
straight chain are the state, so that small stretches keep their digits.
"""

import numpy as np

from verify.arrays import Array
from verify.chain.records import Elastic
from verify.jit import inline, jit


@inline(fastmath={"contract"})
def _solve(e: Elastic, force: Array) -> None:
    """Accelerations in the place of forces, (N + 1, 2); zero at held joints."""
    last = force.shape[0] - 1
    for axis in range(2):
        for j in range(1, last + 1):
            force[j, axis] -= e.factors[j, axis, 0] * force[j - 1, axis]
        for j in range(last + 1):
            force[j, axis] *= e.factors[j, axis, 1]
        for j in range(last - 1, -1, -1):
            force[j, axis] -= e.factors[j + 1, axis, 0] * force[j + 1, axis]


@inline(fastmath={"contract"})
def _strain(e: Elastic, i: int, u: Array) -> tuple[float, float, float, float]:
    """Length, cosine and sine of a link, and its stretch."""
    length = e.links[i, 0]
    dx, dy = u[i + 1, 0] - u[i, 0], u[i + 1, 1] - u[i, 1]
    now = np.sqrt((length + dx) ** 2 + dy * dy)
    return now, (length + dx) / now, dy / now, (dx * (2.0 * length + dx) + dy * dy) / (now + length)


@inline(fastmath={"contract"})
def _turn(force: Array, i: int, now: float, c: float, s: float, moment: float) -> None:
    """A moment on a link as forces across it at both ends."""
    pair = moment / now
    force[i, 0], force[i, 1] = force[i, 0] + pair * s, force[i, 1] - pair * c
    force[i + 1, 0], force[i + 1, 1] = force[i + 1, 0] - pair * s, force[i + 1, 1] + pair * c


@inline(fastmath={"contract"})
def _load(e: Elastic, t: float, u: Array, force: Array) -> None:
    """Dead loads shared between the joints of their links."""
    for k in range(e.loads.shape[0]):
        share, fx, fy, moment = e.loads[k, 0], e.loads[k, 1], e.loads[k, 2], e.loads[k, 3]
        i, now = int(e.loads[k, 6]), np.cos(e.loads[k, 4] * t + e.loads[k, 5])
        for end in range(2):
            part = now * (share if end else 1.0 - share)
            force[i + end, 0], force[i + end, 1] = force[i + end, 0] + part * fx, force[i + end, 1] + part * fy
        if moment != 0.0:
            length, c, s, _ = _strain(e, i, u)
            _turn(force, i, length, c, s, now * moment)


@inline(fastmath={"contract"})
def accelerate(e: Elastic, t: float, u: Array, v: Array, out: Array) -> None:
    """Accelerations of all joints, (N + 1, 2), from displacements and velocities."""
    n = e.links.shape[0]
    for j in range(n + 1):
        out[j, 0], out[j, 1] = 0.0, 0.0
    before_length, before_c, before_s, before_rate = 1.0, 1.0, 0.0, 0.0
    for i in range(n):
        now, c, s, stretch = _strain(e, i, u)
        pull, weight = e.links[i, 2] * stretch, 0.5 * e.links[i, 1]
        rate = (c * (v[i + 1, 1] - v[i, 1]) - s * (v[i + 1, 0] - v[i, 0])) / now
        bend = np.arctan2(before_c * s - before_s * c, before_c * c + before_s * s)
        moment = e.links[i, 3] * bend + e.links[i, 4] * (rate - before_rate)
        for axis in range(2):
            along = pull * (c if axis == 0 else s)
            out[i, axis] += along + weight * e.gravity[axis]
            out[i + 1, axis] += weight * e.gravity[axis] - along
        _turn(out, i, now, c, s, -moment)
        if i > 0:
            _turn(out, i - 1, before_length, before_c, before_s, moment)
        before_length, before_c, before_s, before_rate = now, c, s, rate
    _load(e, t, u, out)
    _solve(e, out)


@jit(fastmath={"contract"})
def march(e: Elastic, t: float, h: float, steps: int, u: Array, v: Array, k: Array, w: Array) -> bool:
    """RK4 steps; `k` is (4, N + 1, 2), `w` (2, N + 1, 2). Whether the state is still finite."""
    for step in range(steps):
        now = t + step * h
        for stage in range(4):
            if stage == 0:
                accelerate(e, now, u, v, k[0])
                continue
            share = h if stage == 3 else 0.5 * h
            square = 0.0 if stage == 1 else 0.5 * share * h
            for j in range(u.shape[0]):
                for axis in range(2):
                    place = u[j, axis] + share * v[j, axis]
                    w[0, j, axis] = place if stage == 1 else place + square * k[stage - 2, j, axis]
                    w[1, j, axis] = v[j, axis] + share * k[stage - 1, j, axis]
            accelerate(e, now + share, w[0], w[1], k[stage])
        for j in range(u.shape[0]):
            for axis in range(2):
                u[j, axis] += h * v[j, axis] + h * h / 6.0 * (k[0, j, axis] + k[1, j, axis] + k[2, j, axis])
                v[j, axis] += h / 6.0 * (k[0, j, axis] + 2.0 * (k[1, j, axis] + k[2, j, axis]) + k[3, j, axis])
    return bool(np.isfinite(u[-1, 0]) and np.isfinite(v[-1, 0]))
