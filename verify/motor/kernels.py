"""The compiled loop of a stage on feet: half a step of free motion, forces in its middle, the other half."""

import numpy as np

from verify.models.arrays import Array, Indices
from verify.models.kernels import FAST, lean, part
from verify.motion.records import MOVING, STILL, Surface
from verify.motion.surface_kernels import find_piece, rotate_half, set_factors
from verify.motor.beam_kernels import bear, clear, leave, match, moved
from verify.motor.feet_kernels import drift, kick, place, press, see, stored
from verify.motor.records import (
    ALONG,
    CLOSING,
    DEPTH,
    DONE,
    EVENT_KIND,
    EVENT_POINT,
    EVENT_TIME,
    EVENT_X,
    EVENTS,
    FACE,
    HEIGHT,
    IMAGE,
    KEPT_ALONG,
    KEPT_PUSH,
    KEPT_RUB,
    KEPT_RUBBED,
    KEPT_STICKING,
    KEPT_SURFACE,
    KEPT_TOUCHING,
    KEPT_V,
    KEPT_X,
    LANDS,
    LEAVES,
    LIFT,
    LIFTED,
    MEAN_PUSH,
    MEAN_RUB,
    MEAN_SPEED,
    NOT_FINITE,
    OFF_BEAM,
    PITCH,
    PULLED,
    PUSH,
    RUB,
    RUBBED,
    SAMPLES,
    SLIPS,
    STEP,
    STICKING,
    STICKS,
    STUCK,
    SURFACE,
    TOUCHING,
    Beamed,
    Feet,
    Line,
    Log,
    Moved,
    Rubbing,
    V,
    X,
)
from verify.motor.rub_kernels import agree, hold, settle, share, stretch


@part(fastmath=FAST)
def _lay(table: Array, piece: int, line: Line) -> None:
    """Polynomials of deflection and velocity on one piece."""
    factors, local = line.factors, line.local
    for d in range(table.shape[1]):
        still, moving = 0.0, 0.0
        for j in range(table.shape[2]):
            still += table[piece, d, j] * factors[STILL, j]
            moving += table[piece, d, j] * factors[MOVING, j]
        local[piece, STILL, d], local[piece, MOVING, d] = still, moving


@part()
def _look(number: int, table: Array, edges: Array, half: float, line: Line, feet: Feet) -> bool:
    """Every point sees the surface under it; whether all stand on the beam."""
    for i in range(feet.points.shape[0]):
        x = place(i, feet)
        piece = find_piece(edges, x, feet.piece[i])
        if piece < 0:
            return False
        feet.piece[i] = piece
        if line.stamp[piece] != number:
            _lay(table, piece, line)
            line.stamp[piece] = number
        see(i, x, edges[piece], edges[piece + 1] - edges[piece], feet.body[V], half, line, feet)
    return True


@part()
def _rub(dt: float, feet: Feet, rubbing: Rubbing, slope: float | None) -> tuple[float, float]:
    """Friction where the beam does not feel it: (mean speed of the stage, its speed at the end)."""
    held = hold(dt, feet, rubbing)
    mean = agree(dt, held, feet, rubbing, slope)
    share(dt, mean, held, feet, rubbing, slope)
    after = settle(dt, mean, feet, rubbing)
    return 0.5 * (feet.body[V] + after), after


@part()
def _rub_back(dt: float, surface: Surface, feet: Feet, rubbing: Rubbing, slope: float | None, beam: Beamed) -> tuple[float, float]:
    """The same where the beam feels it; what points see of the surface is its mean then."""
    held = hold(dt, feet, rubbing)
    clear(feet, beam)
    bear(dt, surface.edges, rubbing.half, feet, beam)
    mean = match(dt, held, surface.edges, feet, rubbing, slope, beam)
    for i in range(feet.points.shape[0]):
        if feet.touch[i, PUSH] > 0.0 and feet.points[i, IMAGE] > 0.0:
            piece = feet.piece[i]
            length = surface.edges[piece + 1] - surface.edges[piece]
            along, across = moved(i, length, rubbing.half, feet, beam)
            feet.touch[i, SURFACE] += along
            feet.touch[i, LIFT] += across
            feet.touch[i, CLOSING] += feet.points[i, FACE] * across
            feet.sums[LIFTED] -= dt * feet.touch[i, RUB] * feet.touch[i, SURFACE]
    leave(surface.table, surface.modes, beam)
    return mean, 2.0 * mean - feet.body[V]


@part()
def _book(dt: float, mean: float, feet: Feet, rubbing: Rubbing) -> None:
    """What a step adds to the sums; shares are of all points."""
    touch, sums, n = feet.touch, feet.sums, feet.touch.shape[0]
    for i in range(n):
        push, rub = touch[i, PUSH], touch[i, RUB]
        if push > 0.0:
            sums[ALONG] += dt * rub * touch[i, SURFACE]
            sums[RUBBED] += dt * rub * (touch[i, SURFACE] - mean)
            sums[MEAN_RUB] += dt * rub
            sums[MEAN_PUSH] += dt * push
            sums[TOUCHING] += dt / n
            sums[STICKING] += dt * touch[i, STUCK] / n
    sums[PULLED] += dt * rubbing.pull * mean
    sums[MEAN_SPEED] += dt * mean


@part()
def _note(time: float, dt: float, before: Array, feet: Feet, log: Log) -> None:
    """Write down who landed, left, stuck or slipped since the mid-step before; `before` are depths and sticking then."""
    touch, tally = feet.touch, log.tally
    for i in range(touch.shape[0]):
        depth, was = touch[i, DEPTH], before[i, 0]
        if (depth > 0.0) != (was > 0.0):
            kind = LANDS if depth > 0.0 else LEAVES
            _write(time - dt * depth / (depth - was), kind, i, feet.body[X], log.events, tally)
        elif depth > 0.0 and (touch[i, STUCK] > 0.0) != (before[i, 1] > 0.0):
            _write(time - 0.5 * dt, STICKS if touch[i, STUCK] > 0.0 else SLIPS, i, feet.body[X], log.events, tally)
        before[i, 0], before[i, 1] = depth, touch[i, STUCK]


@part()
def _write(time: float, kind: float, point: int, x: float, events: Array, tally: Indices) -> None:
    row = tally[EVENTS]
    if row < len(events):
        events[row, EVENT_TIME], events[row, EVENT_KIND] = time, kind
        events[row, EVENT_POINT], events[row, EVENT_X] = point, x
    tally[EVENTS] += 1


@part()
def _keep(dt: float, feet: Feet, line: Line, log: Log) -> None:
    """Write one sample: the state now, means and sums since the last."""
    row, sums, before, span = log.tally[SAMPLES], feet.sums, log.before, dt * log.every
    kept, touched = log.kept, sums[MEAN_PUSH] - before[MEAN_PUSH]
    kept[row, KEPT_X], kept[row, KEPT_V] = feet.body[X], feet.body[V]
    kept[row, KEPT_RUB] = (sums[MEAN_RUB] - before[MEAN_RUB]) / span
    kept[row, KEPT_PUSH] = touched / span
    kept[row, KEPT_TOUCHING] = (sums[TOUCHING] - before[TOUCHING]) / span
    kept[row, KEPT_STICKING] = (sums[STICKING] - before[STICKING]) / span
    kept[row, KEPT_RUBBED] = sums[RUBBED] - before[RUBBED]
    kept[row, KEPT_ALONG] = sums[ALONG] - before[ALONG]
    speed, n = 0.0, 0
    for i in range(feet.points.shape[0]):
        log.pressures[row, i] = feet.touch[i, PUSH]
        if feet.touch[i, PUSH] > 0.0:
            speed += feet.touch[i, SURFACE]
            n += 1
    kept[row, KEPT_SURFACE] = speed / n if n > 0 else np.nan
    for f in range(feet.state.shape[0]):
        log.heights[row, f, 0], log.heights[row, f, 1] = feet.state[f, HEIGHT], feet.state[f, PITCH]
    for p in range(log.points.shape[0]):
        total = 0.0
        for j in range(log.points.shape[1]):
            total += log.points[p, j] * line.factors[STILL, j]
        log.deflections[row, p] = total
    for s in range(len(sums)):
        before[s] = sums[s]
    log.tally[SAMPLES] += 1


@lean()
def ride(
    n_steps: int,
    dt: float,
    surface: Surface,
    feet: Feet,
    rubbing: Rubbing,
    beam: Beamed | None,
    line: Line,
    before: Array,
    log: Log,
) -> int:
    """Advance beam and stage by n_steps from step tally[STEP]; why it came back.

    `before` is (points, 2), depth and sticking at the last mid-step. All arrays are advanced in place, together.
    """
    modes, tally = surface.modes, log.tally
    free = 0.0 if rubbing.frozen else 1.0
    for _ in range(n_steps):
        number = tally[STEP]
        drift(0.5 * dt, free, feet)
        rotate_half(modes)
        set_factors((number + 0.5) * dt, modes, surface.drive, line.factors)
        if not _look(number, surface.table, surface.edges, rubbing.half, line, feet):
            return OFF_BEAM
        press(dt, feet)
        if beam is None:
            mean, after = _rub(dt, feet, rubbing, rubbing.slope)
        else:
            mean, after = _rub_back(dt, surface, feet, rubbing, rubbing.slope, beam)
        _book(dt, mean, feet, rubbing)
        kick(dt, feet)
        stretch(dt, mean, feet, rubbing)
        feet.body[V] = after
        drift(0.5 * dt, free, feet)
        rotate_half(modes)
        tally[STEP] += 1
        _note(surface.drive.origin + (number + 0.5) * dt, dt, before, feet, log)
        if not np.isfinite(feet.body[V] + feet.state[0, HEIGHT]):
            return NOT_FINITE
        if tally[STEP] % log.every == 0:
            if len(log.points) > 0:
                set_factors((number + 1.0) * dt, modes, surface.drive, line.factors)
            stored(dt, feet)
            _keep(dt, feet, line, log)
    stored(dt, feet)
    return DONE


@lean()
def ride_given(
    n_steps: int, dt: float, given: Moved, feet: Feet, rubbing: Rubbing, line: Line, before: Array, log: Log
) -> int:
    """The same on a surface that is given in the middle of every step, which does not feel the stage."""
    tally, free = log.tally, 0.0 if rubbing.frozen else 1.0
    for _ in range(n_steps):
        number = tally[STEP]
        drift(0.5 * dt, free, feet)
        for i in range(feet.points.shape[0]):
            x = place(i, feet)
            piece = find_piece(given.edges, x, feet.piece[i])
            if piece < 0:
                return OFF_BEAM
            feet.piece[i] = piece
            for d in range(given.local.shape[3]):
                line.local[piece, STILL, d] = given.local[number, piece, STILL, d]
                line.local[piece, MOVING, d] = given.local[number, piece, MOVING, d]
            length = given.edges[piece + 1] - given.edges[piece]
            see(i, x, given.edges[piece], length, feet.body[V], rubbing.half, line, feet)
            feet.touch[i, SURFACE] += given.along[number, piece]
        press(dt, feet)
        mean, after = _rub(dt, feet, rubbing, rubbing.slope)
        _book(dt, mean, feet, rubbing)
        kick(dt, feet)
        stretch(dt, mean, feet, rubbing)
        feet.body[V] = after
        drift(0.5 * dt, free, feet)
        tally[STEP] += 1
        _note((number + 0.5) * dt, dt, before, feet, log)
        if not np.isfinite(feet.body[V] + feet.state[0, HEIGHT]):
            return NOT_FINITE
        if tally[STEP] % log.every == 0:
            stored(dt, feet)
            _keep(dt, feet, line, log)
    stored(dt, feet)
    return DONE
