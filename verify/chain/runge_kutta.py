"""Explicit Runge-Kutta march of q'' = a(t, q, q') by tableau; the acceleration is an argument of the compiled march.

The state y is (coordinates, their rates, quadratures), (2 n + m,). The acceleration writes the derivatives of rates and
quadratures to out[n:], and may first project y onto its constraints: dependent coordinates are then functions of the
independent ones in every stage (coordinate partitioning), and only the latter are integrated.
"""

from collections.abc import Callable
from typing import Any, NamedTuple

import numpy as np
from numba import types

from verify.arrays import Array, Indices
from verify.jit import FAST, inline, jit
from verify.timing import Pace

_vector, _table = types.Array(types.float64, 1, "C"), types.Array(types.float64, 2, "C")
RUNNING, DONE, DIVERGED, TOO_SMALL = 0, 1, 2, 3
TIME, STEP = 0, 1  # entries of `clock`
RELATIVE, ABSOLUTE, ABSOLUTE_RATE, TURN, LARGEST, LARGEST_RATE, FURTHEST = range(7)
"""Entries of `control`: tolerances, largest mean change of a coordinate per step, largest rms and coordinate so far."""
STEPS, EVALUATIONS, KEPT = range(3)  # entries of `counts`


class Model(NamedTuple):
    """Data of an acceleration."""

    links: Array
    loads: Array
    numbers: Array
    scratch: Array
    base: Array
    """(pieces, 14), motion of the hub by `Base.table`."""


class Tableau(NamedTuple):
    """An explicit method of s stages."""

    a: Array  # (s + 1, s), the last row the result
    c: Array  # (s,)
    weights: Array
    """(s + 1,), error estimate of order 4, the last for the derivative at the result; empty for fixed steps."""


class State(NamedTuple):
    """State of a march, its control and working space."""

    y: Array  # (2 n + m,), coordinates, rates, quadratures at `clock`[TIME]
    k: Array  # (s + 3, y.size), derivatives of the stages, new and trial states
    clock: Array  # (2,), TIME and STEP: fixed for a tableau without `weights`, else controlled
    control: Array
    counts: Indices


_named: Any = types.NamedTuple
_model = _named((_table, _table, _vector, _table, _table), Model)
_state = _named((_vector, _table, _vector, _vector, types.Array(types.int64, 1, "C")), State)
ACCELERATION = types.void(types.float64, _vector, _vector, _model)  # accelerate(t, y, out, model)
MARCH = types.int64(
    types.FunctionType(ACCELERATION),
    _model,
    _named((_table, _vector, _vector), Tableau),
    types.int64,
    _state,
    _vector,
    _table,
    types.int64,
)


def _tableau(rows: list[list[float]], c: list[float], weights: list[float]) -> Tableau:
    a = np.zeros((len(c) + 1, len(c)))
    for i, row in enumerate(rows, start=1):
        a[i, : len(row)] = row
    return Tableau(a, np.array(c, dtype=float), np.array(weights, dtype=float))


RK4 = _tableau([[0.5], [0, 0.5], [0, 0, 1], [1 / 6, 1 / 3, 1 / 3, 1 / 6]], [0, 0.5, 0.5, 1], [])
DORMAND_PRINCE = _tableau(
    [
        [1 / 5],
        [3 / 40, 9 / 40],
        [44 / 45, -56 / 15, 32 / 9],
        [19372 / 6561, -25360 / 2187, 64448 / 6561, -212 / 729],
        [9017 / 3168, -355 / 33, 46732 / 5247, 49 / 176, -5103 / 18656],
        [35 / 384, 0, 500 / 1113, 125 / 192, -2187 / 6784, 11 / 84],
    ],
    [0, 1 / 5, 3 / 10, 4 / 5, 8 / 9, 1],
    [71 / 57600, 0, -71 / 16695, 71 / 1920, -17253 / 339200, 22 / 525, -1 / 40],
)
"""J. R. Dormand and P. J. Prince, J. Comp. Appl. Math. 6 (1980) 19."""


@inline(fastmath={"contract"})
def interpolate(n: int, s: float, h: float, y: Array, new: Array, k0: Array, k1: Array, out: Array) -> None:
    """The state at fraction s of a step: quintic Hermite interpolation of the coordinates and its derivative."""
    r = 1.0 - s
    a0, a1 = r * r * r * (1 + 3 * s + 6 * s * s), s * s * s * (1 + 3 * r + 6 * r * r)
    b0, b1 = h * r * r * r * s * (1 + 3 * s), -h * s * s * s * r * (1 + 3 * r)
    c0, c1 = 0.5 * h * h * r * r * r * s * s, 0.5 * h * h * s * s * s * r * r
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


@inline(fastmath=FAST)
def control_step(
    n: int, h: float, weights: Array, y: Array, k: Array, trial: Array, control: Array
) -> tuple[bool, float]:
    """(whether the estimated error of a step is within tolerance, next step).

    The errors of coordinates and of rates are rms values relative to those of the largest state so far.
    """
    worst = 0.0
    for i in range(2 * n):
        trial[i] = 0.0
    for j in range(weights.size):
        for i in range(2 * n):
            trial[i] += weights[j] * k[j, i]
    for row in range(2):
        error, size = 0.0, 0.0
        for i in range(row * n, row * n + n):
            error, size = error + trial[i] * trial[i], size + y[i] * y[i]
        control[LARGEST + row] = max(control[LARGEST + row], np.sqrt(size / n))
        over = h * np.sqrt(error / n) / (control[ABSOLUTE + row] + control[RELATIVE] * control[LARGEST + row])
        if not np.isfinite(over):
            return False, 0.2 * h
        worst = max(worst, over)
    return worst <= 1.0, h * min(4.0, max(0.2, 0.9 * max(worst, 1e-10) ** -0.2))


@inline(fastmath={"contract"})
def step_stages(
    accelerate: Callable[..., None], model: Model, tableau: Tableau, n: int, h: float, march: State, new: Array
) -> None:
    """Write the result of a step to `new`, the derivatives of stages 1 to s and at the result to k[1:]."""
    a, c, y, k, t = tableau.a, tableau.c, march.y, march.k, march.clock[TIME]
    for s in range(1, c.size + 1):
        first = h * a[s, 0]
        for i in range(y.size):
            new[i] = y[i] + first * k[0, i]
        for j in range(1, s):
            weight = h * a[s, j]
            if weight != 0.0:
                for i in range(y.size):
                    new[i] += weight * k[j, i]
        accelerate(t + h if s == c.size else t + c[s] * h, new, k[s], model)
        for i in range(n):
            k[s, i] = new[n + i]


@inline(fastmath=FAST)
def take(n: int, new: Array, rates: Array, y: Array, k0: Array, control: Array) -> float:
    """Accept the result of a step as state; returns the mean modulus of its rates."""
    furthest, total = control[FURTHEST], 0.0
    for i in range(y.size):
        y[i], k0[i] = new[i], rates[i]
    for i in range(n):
        furthest, total = max(furthest, abs(new[i])), total + abs(new[n + i])
    control[FURTHEST] = furthest
    return total / n


@jit(signature_or_function=MARCH, fastmath={"contract"})
def march(
    accelerate: Callable[..., None],
    model: Model,
    tableau: Tableau,
    n: int,
    state: State,
    samples: Array,
    kept: Array,
    budget: int,
) -> int:
    """At most `budget` steps of n coordinates from the state at clock[TIME] to exactly samples[-1]; a status.

    `kept` is (samples, y.size). Loads may change between calls: the derivative at the start is evaluated anew.
    """
    c, weights, (y, k, clock, control, counts) = tableau.c, tableau.weights, state
    last, new, trial, end = c.size, k[c.size + 1], k[c.size + 2], samples[samples.size - 1]
    if counts[KEPT] == 0 and samples[0] <= clock[TIME]:
        for i in range(2 * n):
            kept[0, i] = y[i]
        counts[KEPT] = 1
    accelerate(clock[TIME], y, k[0], model)
    for i in range(n):
        k[0, i] = y[n + i]
    for _ in range(budget):
        if counts[KEPT] >= samples.size:
            return DONE
        t, h = clock[TIME], clock[STEP]
        closing = t + h * (1.0 + 1e-9) >= end  # a remainder below rounding is part of the last step
        if closing:
            h = end - t
        if t + h == t:
            return TOO_SMALL
        step_stages(accelerate, model, tableau, n, h, state, new)
        counts[EVALUATIONS] += last
        if weights.size > 0:
            accepted, following = control_step(n, h, weights, y, k, trial, control)
            if not (accepted and closing):
                clock[STEP] = following
            if not accepted:
                continue
        while counts[KEPT] < samples.size and (closing or samples[counts[KEPT]] <= t + h):
            at = min((samples[counts[KEPT]] - t) / h, 1.0)
            interpolate(n, at, h, y, new, k[0], k[last], kept[counts[KEPT]])
            counts[KEPT] += 1
        counts[STEPS] += 1
        clock[TIME] = end if closing else t + h
        if not take(n, new, k[last], y, k[0], control) * h < control[TURN]:
            return DIVERGED
    return DONE if counts[KEPT] >= samples.size else RUNNING


class Marched(NamedTuple):
    """Outcome of `integrate`."""

    kept: Array  # (completed samples, y.size), states
    status: int  # DONE, DIVERGED or TOO_SMALL
    time: float  # end time of the march, s
    step: float  # the last step, s
    counts: Indices  # (3,): steps, evaluations, samples
    furthest: float  # largest modulus of a coordinate at the ends of steps


def integrate(
    accelerate: Callable[..., None],
    model: Model,
    tableau: Tableau,
    n: int,
    y: Array,
    start: float,
    samples: Array,
    step: float,
    control: tuple[float, float, float, float],
    progress: Callable[[float], None] = lambda part: None,
    most: float = np.inf,
) -> Marched:
    """March from `y` at `start`, s, until all ascending `samples` are kept or the march ends; `y` becomes the end.

    `control` is the relative tolerance, those of coordinates and rates, and the mean change of a coordinate in a step
    at which it has diverged. `progress` is called with the fraction of time done. Raises InputError where more than
    `most` steps are to be expected.
    """
    k, kept, clock = np.zeros((len(tableau.c) + 3, y.size)), np.zeros((len(samples), y.size)), np.array([start, step])
    counts, numbers = np.zeros(3, dtype=np.int64), np.array([*control, 0.0, 0.0, 0.0])
    state = State(y, k, clock, numbers, counts)
    budget, status = max(200_000 // y.size, 16), RUNNING  # some tens of milliseconds between two interrupts
    run: Any = march
    span = max(float(samples[-1]) - start, 1e-300)
    pace = Pace(span, most)
    while status == RUNNING:
        status = run(accelerate, model, tableau, n, state, samples, kept, budget)
        progress(share := (float(clock[TIME]) - start) / span)
        pace.check(int(counts[EVALUATIONS]) // len(tableau.c), share)
    end, last = clock.tolist()
    return Marched(kept[: counts[KEPT]], status, end, last, counts, float(numbers[FURTHEST]))
