"""The compiled loop of a slider on feet on a given surface: half a step free, forces in its middle, the other half."""

import numpy as np

from verify.arrays import Array
from verify.jit import inline, jit
from verify.motion.records import MOVING, STILL
from verify.motion.surface_kernels import between, find_piece
from verify.motor import records as rec
from verify.motor.feet_kernels import drift, gone, keep, kick, note, place, press, see, stored
from verify.motor.friction_kernels import agree, cross, hold, stretch
from verify.motor.records import Feet, GivenSurface, Line, Log, Rubbing


@inline
def _stand(t: float, edges: Array, feet: Feet) -> bool:
    """Find the piece that every point stands on t seconds on, before anything moves; whether all are on the beam."""
    for i in range(feet.points.shape[0]):
        b = feet.owner[i]
        on = t * feet.body[b, rec.V] * feet.riders[b, rec.FREE]
        piece = find_piece(edges, feet.body[b, rec.X] + on + feet.points[i, rec.OFFSET], feet.piece[i])
        if piece < 0:
            return False
        feet.piece[i] = piece
    return True


@inline
def _look(number: int, edges: Array, given: GivenSurface, half: float, line: Line, feet: Feet) -> None:
    """Every point sees the surface under it, in the middle of a step of that number."""
    for i in range(feet.points.shape[0]):
        x, piece = place(i, feet), feet.piece[i]
        if line.stamp[piece] != number:
            for d in range(given.local.shape[3]):
                line.local[piece, STILL, d] = given.local[number, piece, STILL, d]
                line.local[piece, MOVING, d] = given.local[number, piece, MOVING, d]
            line.stamp[piece] = number
        see(i, x, edges[piece], edges[piece + 1] - edges[piece], gone(i, feet), half, line, feet)
        feet.touch[i, rec.SURFACE] += between(given.along[number], edges, piece, x)


@inline
def _rub(dt: float, feet: Feet, slope: float | None, before: Array) -> None:
    """Friction where the beam does not feel it, and what speeds the sliders have by it."""
    hold(dt, feet, before)
    means, riders, touch = feet.means, feet.riders, feet.touch
    for b in range(feet.body.shape[0]):
        first, last, v, mu = feet.first[b], feet.first[b + 1], feet.body[b, rec.V], riders[b, rec.MU]
        light, pull = dt * riders[b, rec.INVERSE_MASS], riders[b, rec.PULL] + means[b, rec.HELD]
        if slope is None:
            means[b, rec.MEAN], means[b, rec.AFTER] = cross(first, last, light, pull, v, mu, touch, feet.points)
        else:
            means[b, rec.MEAN], means[b, rec.AFTER] = agree(first, last, light, pull, v, mu, slope, touch)


@inline
def _book(dt: float, feet: Feet) -> None:
    """What a step adds to the sums; shares are of all points of a slider. Then it has its speed at the end."""
    touch, sums, means, riders = feet.touch, feet.sums, feet.means, feet.riders
    for b in range(feet.body.shape[0]):
        mean, rubbed, n = means[b, rec.MEAN], 0.0, feet.first[b + 1] - feet.first[b]
        for i in range(feet.first[b], feet.first[b + 1]):
            push, rub = touch[i, rec.PUSH], touch[i, rec.RUB]
            if push > 0.0:
                sums[b, rec.ALONG] += dt * (rub * touch[i, rec.SURFACE] + touch[i, rec.BEYOND])
                sums[b, rec.RUBBED] += dt * (rub * (touch[i, rec.SURFACE] - mean) + touch[i, rec.BEYOND])
                sums[b, rec.MEAN_RUB] += dt * rub
                sums[b, rec.MEAN_PUSH] += dt * push
                sums[b, rec.TOUCHING] += dt / n
                sums[b, rec.STICKING] += dt * touch[i, rec.STUCK] / n
                rubbed += rub
        sums[b, rec.PULLED] += dt * mean * (riders[b, rec.PULL] if riders[b, rec.INVERSE_MASS] > 0.0 else -rubbed)
        feet.body[b, rec.V] = means[b, rec.AFTER]


@inline
def _finite(feet: Feet) -> bool:
    """Whether every slider is where a number says."""
    total = 0.0
    for b in range(feet.body.shape[0]):
        total += feet.body[b, rec.V]
    for f in range(feet.state.shape[0]):
        total += feet.state[f, rec.HEIGHT]
    return bool(np.isfinite(total))


@inline
def _take(middle: float, dt: float, before: Array, feet: Feet, log: Log) -> bool:
    """The feet take the forces of a step, whose middle was at that time, and end it; whether all are finite."""
    kick(dt, feet)
    stretch(dt, feet, before)
    _book(dt, feet)
    drift(0.5 * dt, feet)
    log.tally[rec.STEP] += 1
    note(middle, dt, before, feet, log)
    return _finite(feet)


@jit
def ride(
    n_steps: int,
    dt: float,
    edges: Array,
    given: GivenSurface,
    feet: Feet,
    rubbing: Rubbing,
    line: Line,
    before: Array,
    log: Log,
) -> int:
    """Advance sliders by n_steps from step tally[STEP] on a surface without response; why it returns.

    `before` is (points, 2), depth and sticking at the last mid-step. All arrays are advanced in place, together.
    """
    tally = log.tally
    for _ in range(n_steps):
        number = tally[rec.STEP]
        if not _stand(0.5 * dt, edges, feet):
            stored(dt, feet)
            return rec.OFF_BEAM
        drift(0.5 * dt, feet)
        _look(number, edges, given, rubbing.half, line, feet)
        press(dt, feet, before)
        _rub(dt, feet, rubbing.slope, before)
        if not _take((number + 0.5) * dt, dt, before, feet, log):
            return rec.NOT_FINITE
        if tally[rec.STEP] % log.every == 0:
            stored(dt, feet)
            keep(dt, feet, log)
    stored(dt, feet)
    return rec.DONE
