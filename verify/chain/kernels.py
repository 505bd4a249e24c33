"""Compiled accelerations of the planar chain of rigid links, and the loop of Runge-Kutta steps."""

import numpy as np

from verify.arrays import Array
from verify.chain.held_kernels import hold, project, repivot
from verify.chain.records import DIVERGED, DONE, ROLLER, RUNNING, TOO_SMALL, Flat, March
from verify.chain.recursion_kernels import cosines, hub_motion, load_power, loads, moments, shortening, solve, weigh
from verify.jit import inline, jit


@inline(fastmath={"contract"})
def accelerate(f: Flat, t: float, q: Array, v: Array, work: Array, out: Array) -> tuple[float, float]:
    """Relative angular accelerations, (N,), into `out`; (power lost, power put in by loads, actuators and hub)."""
    lost, power = moments(f, t, q, v, work)
    if f.axial or f.ledger:
        cosines(q, work)
    loads(f, t, work)
    if f.ledger:
        power += load_power(f, work)
    weigh(f, work)
    pull = -f.tip_spring * shortening(f, work) if f.tip_spring > 0.0 else 0.0
    solve(f, pull, work)
    if f.held.shape[0] > (1 if f.tip == ROLLER else 0):
        power += hold(f, t, work)
    out[0] = work[0, 12] - hub_motion(f.numbers, t)[2]
    for i in range(1, q.size):
        out[i] = work[i, 12] - work[i - 1, 12]
    return lost, power


@inline(fastmath={"contract"})
def derivative(f: Flat, t: float, y: Array, work: Array, out: Array) -> None:
    """Rates of the state (q, v, energy lost, work put in), (2N + 2,)."""
    n = f.links.shape[0]
    out[2 * n], out[2 * n + 1] = accelerate(f, t, y[:n], y[n : 2 * n], work, out[n : 2 * n])
    for i in range(n):
        out[i] = y[n + i]


@inline(fastmath={"contract"})
def _stages(f: Flat, t: float, h: float, y: Array, a: Array, c: Array, k: Array, new: Array, work: Array) -> None:
    """Stages 1.. of an explicit Runge-Kutta step into k[1:], its answer (the last row of `a`) into `new`."""
    stages = a.shape[1]
    for s in range(1, stages + 1):
        for i in range(y.size):
            new[i] = y[i]
        for j in range(s):
            if a[s, j] != 0.0:
                weight = h * a[s, j]
                for i in range(y.size):
                    new[i] += weight * k[j, i]
        if s < stages:
            derivative(f, t + c[s] * h, new, work, k[s])


@inline(fastmath={"contract"})
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


@inline(fastmath={"contract"})
def _error(n: int, h: float, k: Array, weights: Array, y: Array, scale: Array) -> float:
    """Norm of a step's estimated error over its tolerance: angles and rates each by their root mean square.

    `scale` is relative tolerance, absolute tolerance of the angles, of the rates, and the largest means of `y` so far.
    """
    worst = 0.0
    for row in range(2):
        error, size = 0.0, 0.0
        for i in range(row * n, (row + 1) * n):
            e = 0.0
            for j in range(weights.size):
                e += weights[j] * k[j, i]
            error += e * e
            size += y[i] * y[i]
        mean = np.sqrt(size / n)
        scale[3 + row] = mean if mean > scale[3 + row] else scale[3 + row]
        over = h * np.sqrt(error / n) / (scale[1 + row] + scale[0] * scale[3 + row])
        worst = over if over > worst else worst
    return worst


@inline(fastmath={"contract"})
def torn(rates: Array, h: float) -> bool:
    """Whether rates are not finite, or one step would turn a joint by more than half a turn."""
    fine = True
    for i in range(rates.size):
        fine = fine and abs(rates[i]) * h < np.pi
    return not fine


@inline
def furthest(before: float, work: Array, n: int) -> float:
    """The largest of a number and the turns of n links from the straight chain, which stand in column 2, radians."""
    for i in range(n):
        turn = abs(work[i, 2])
        before = turn if turn > before else before
    return before


@inline(fastmath={"contract"})
def _propose(error: float, order: float, h: float) -> float:
    """The next step after one with this error over its tolerance."""
    if not error >= 0.0:
        return 0.2 * h
    share = 0.9 * (error if error > 1e-10 else 1e-10) ** (-1.0 / order)
    share = share if share > 0.2 else 0.2
    return h * (share if share < 4.0 else 4.0)


@inline(fastmath={"contract"})
def _keep_samples(m: March, t: float, h: float) -> None:
    """What lies within an accepted step."""
    last, n = m.k.shape[0] - 1, m.y.size // 2 - 1
    while m.counts[3] < m.samples.size and m.samples[m.counts[3]] <= (t + h) * (1.0 + 1e-12):
        _keep(t, h, m.samples[m.counts[3]], m.y, m.new, m.k[0], m.k[last], n, m.kept[m.counts[3]])
        m.counts[3] += 1


@jit(fastmath={"contract"})
def march(f: Flat, m: March, budget: int, work: Array) -> int:
    """At most `budget` steps, fixed or held to the tolerances of `scale`; each ends on the held points.

    Before the first, also of none, the rates of the start come into k[0].
    """
    n, last = f.links.shape[0], m.k.shape[0] - 1
    if m.counts[2] == 0:
        derivative(f, m.clock[0], m.y, work, m.k[0])
    for _ in range(budget):
        if m.counts[3] >= m.samples.size:
            return DONE
        t, h = m.clock[0], m.clock[1]
        if t + h == t:
            return TOO_SMALL
        _stages(f, t, h, m.y, m.a, m.c, m.k, m.new, work)
        if torn(m.new[n : 2 * n], h) and m.weights.size == 0:
            return DIVERGED
        project(f, t + h, m.new[:n], m.new[n : 2 * n], m.pivots, work)
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
        m.scale[5] = furthest(m.scale[5], work, n)
        _keep_samples(m, t, h)
        for i in range(m.y.size):
            m.y[i], m.k[0, i] = m.new[i], m.k[last, i]
    return DONE if m.counts[3] >= m.samples.size else RUNNING
