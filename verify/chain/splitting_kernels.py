"""The compiled loop of a chain in modal coordinates: exact linear flow and nonlinear kicks in turn."""

import numpy as np

from verify.chain.held_kernels import SETTLED, place
from verify.chain.kernels import accelerate, furthest, torn
from verify.chain.records import DIVERGED, DONE, HALF, RUNNING, Flat, Modal
from verify.chain.recursion_kernels import cosines, direction, solve
from verify.models.arrays import Array, Indices
from verify.jit import jit, inline

FAR = 0.1
"""Share by which the last mode's hold on the tip may change before the roller is closed afresh."""
NEWTON_STEPS = 20
"""Of closing afresh; three or four do where the links stand near the line."""


@inline(fastmath={"contract"})
def _expand(modes: Array, state: Array, rest: Array, q: Array, v: Array) -> None:
    """Angles and rates from modal coordinates, (m, 2); `modes` is (m, N)."""
    for i in range(q.size):
        q[i], v[i] = rest[i], 0.0
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


@inline(fastmath={"contract", "reassoc"})
def _reduce(duals: Array, a: Array, out: Array) -> None:
    """Modal accelerations, (m,); `duals` is (m, N)."""
    for j in range(duals.shape[0]):
        total = 0.0
        for i in range(a.size):
            total += duals[j, i] * a[i]
        out[j] = total


@inline(fastmath={"contract"})
def _rotate(turns: Array, state: Array) -> None:
    """Exact linear flow: `turns` (m, 3) holds cos, sin / omega and - omega sin of the step."""
    for j in range(turns.shape[0]):
        x, y = state[j, 0], state[j, 1]
        state[j, 0], state[j, 1] = turns[j, 0] * x + turns[j, 1] * y, turns[j, 2] * x + turns[j, 0] * y


@inline(fastmath={"contract"})
def forced(t: float, drives: Array, shares: Array, out: Array) -> None:
    """Steady answer of the modes to the harmonic loads, (m, 2); `shares` is (n_loads, m)."""
    for j in range(out.shape[0]):
        out[j, 0], out[j, 1] = 0.0, 0.0
    for k in range(drives.shape[0]):
        phase = drives[k, 0] * t + drives[k, 1]
        now, rate = np.cos(phase), -drives[k, 0] * np.sin(phase)
        for j in range(shares.shape[1]):
            out[j, 0] += shares[k, j] * now
            out[j, 1] += shares[k, j] * rate


@inline(fastmath={"contract"})
def _close(f: Flat, d: Modal, free: Array, work: Array) -> bool:
    """One chord step of the roller's closure along the last mode, which turns the tip off its line by `d.tilt` at rest.

    Whether it still does so where the links stand, to a share of `FAR`.
    """
    gap, speed, turn, lever, last = 0.0, 0.0, 0.0, 0.0, free.shape[0] - 1
    for i in range(f.links.shape[0]):
        c, s = direction(work[i, 2])
        turn += d.modes[last, i]
        gap += 2.0 * f.links[i, HALF] * s
        speed += 2.0 * f.links[i, HALF] * c * work[i, 3]
        lever += 2.0 * f.links[i, HALF] * c * turn
    free[last, 0] -= gap / d.tilt
    free[last, 1] -= speed / d.tilt
    return bool(abs(lever - d.tilt) < FAR * abs(d.tilt))


@inline(fastmath={"contract"})
def _settle(d: Modal, t: float, afresh: bool, free: Array, work: Array) -> bool:
    """Bring the chain at the end of a step onto the roller's line; whether it came there.

    The way is `afresh` that of the roller's force as the links stand, which works on no motion along the line; or the
    last mode, which takes back what its own chord steps have left.
    """
    forced(t, d.drives, d.shares, d.steady)
    for j in range(free.shape[0]):
        d.trial[j, 0], d.trial[j, 1] = free[j, 0] + d.steady[j, 0], free[j, 1] + d.steady[j, 1]
        d.force[j] = 0.0
    d.force[free.shape[0] - 1] = 1.0
    _expand(d.modes, d.trial, d.rest, d.vectors[0], d.vectors[1])
    place(d.loose, t, d.vectors[0], d.vectors[1], work)
    if afresh:
        cosines(d.vectors[0], work)
        _find_way(d, work)
    for i in range(d.rest.size):
        d.vectors[0, i] = 0.0
    for j in range(free.shape[0]):
        turn = 0.0
        for i in range(d.rest.size):
            turn += d.modes[j, i]
            d.vectors[0, i] += d.force[j] * turn
    return _land(d, free, work)


@inline(fastmath={"contract"})
def _find_way(d: Modal, work: Array) -> None:
    """How a force of the roller moves the links as they stand: its share in each mode into `d.force`."""
    n, relative = d.rest.size, d.vectors[2]
    for i in range(n):
        work[i, 17] = work[i, 3]
        work[i, 3], work[i, 4], work[i, 5], work[i, 6] = 0.0, 0.0, 0.0, 0.0
    work[n - 1, 5], work[n - 1, 4] = direction(work[n - 1, 2])
    work[n - 1, 6] = d.loose.links[n - 1, HALF] * work[n - 1, 5]
    solve(d.loose, 0.0, work)
    before = 0.0
    for i in range(n):
        work[i, 3], relative[i] = work[i, 17], work[i, 12] - before
        before = work[i, 12]
    _reduce(d.duals, relative, d.force)


@inline(fastmath={"contract"})
def _land(d: Modal, free: Array, work: Array) -> bool:
    """Newton's method along a way, which turns the links by `d.vectors[0]`, and rates that stay on the line."""
    went, way, links = 0.0, d.vectors[0], d.loose.links
    for _ in range(NEWTON_STEPS):
        gap, speed, lever, longest = 0.0, 0.0, 0.0, 0.0
        for i in range(way.size):
            c, s = direction(work[i, 2] - went * way[i])
            gap += 2.0 * links[i, HALF] * s
            speed += 2.0 * links[i, HALF] * c * work[i, 3]
            lever += 2.0 * links[i, HALF] * c * way[i]
            longest = abs(way[i]) if abs(way[i]) > longest else longest
        went += gap / lever
        if abs(gap / lever) * longest < SETTLED:
            for j in range(free.shape[0]):
                free[j, 0] -= went * d.force[j]
                free[j, 1] -= speed / lever * d.force[j]
            return True
    return False


@inline(fastmath={"contract"})
def _flow(omega: Array, time: float, start: Array, out: Array) -> None:
    """Exact linear flow of a time from one state to another."""
    for j in range(omega.size):
        w, x, y = omega[j], start[j, 0], start[j, 1]
        c, s = np.cos(w * time), np.sin(w * time)
        out[j, 0] = c * x + (s / w if w > 0.0 else time) * y
        out[j, 1] = c * y - w * s * x


@inline(fastmath={"contract"})
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


@inline(fastmath={"contract"})
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


@inline(fastmath={"contract"})
def _keep_modal(d: Modal, t: float, h: float, counts: Indices, samples: Array, kept: Array, free: Array) -> None:
    """Samples within a step that went from `d.start` to `free`; an even spacing takes one sine for each mode."""
    miss, first = d.trial, True
    for j in range(free.shape[0]):
        miss[j, 0], miss[j, 1] = d.start[j, 0], d.start[j, 1]
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


@jit(fastmath={"contract"})
def march_modal(
    f: Flat, d: Modal, clock: Array, counts: Indices, samples: Array, kept: Array, budget: int, free: Array, work: Array
) -> int:
    """Exact linear flow of the modes and nonlinear kicks in turn, a fixed step; modal states are kept.

    A step is flow 0, kick 0, flow 1, ..., the last flow. `counts[4]` says whether links have turned too far for the
    chord steps between them: the roller is closed afresh at the end of each step from then on.
    """
    h = clock[1]
    for _ in range(budget):
        if counts[3] >= samples.size:
            return DONE
        t, far, near = clock[0], counts[4] > 0, counts[4] == 0
        for j in range(free.shape[0]):
            d.start[j, 0], d.start[j, 1] = free[j, 0], free[j, 1]
        for k in range(d.kicks.size):
            _rotate(d.flows[k], free)
            t += d.shares_of_step[k] * h
            _kick(f, d, t, d.kicks[k] * h, free, work)
            if d.tilt != 0.0 and not far:
                near = _close(f, d, free, work) and near
            clock[2] = furthest(clock[2], work, d.rest.size)
        _rotate(d.flows[d.kicks.size], free)
        if far or not near:
            if not _settle(d, clock[0] + h, far, free, work):
                return DIVERGED
            counts[4] = 1
        if torn(d.vectors[1], h):
            return DIVERGED
        counts[0] += 1
        counts[2] += 2 * d.kicks.size
        if counts[3] < samples.size and samples[counts[3]] <= (clock[0] + h) * (1.0 + 1e-12):
            _keep_modal(d, clock[0], h, counts, samples, kept, free)
        clock[0] += h
    return DONE if counts[3] >= samples.size else RUNNING
