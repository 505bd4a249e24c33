"""The compiled log of a slider on feet: events between two mid-steps, samples with the means since the last."""

import numpy as np

from verify.models.arrays import Array, Indices
from verify.jit import inline
from verify.motion.records import STILL
from verify.motor.records import (
    ALONG,
    DEPTH,
    EVENT_KIND,
    EVENT_POINT,
    EVENT_TIME,
    EVENT_X,
    EVENTS,
    HEIGHT,
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
    MEAN_PUSH,
    MEAN_RUB,
    PITCH,
    PUSH,
    RUBBED,
    SAMPLES,
    SLIPS,
    STICKING,
    STICKS,
    STUCK,
    SURFACE,
    TOUCHING,
    Feet,
    Line,
    Log,
    V,
    X,
)


@inline
def note(time: float, dt: float, before: Array, feet: Feet, log: Log) -> None:
    """Write down who landed, left, stuck or slipped since the mid-step before, with `before` depth and sticking."""
    touch, tally = feet.touch, log.tally
    for i in range(touch.shape[0]):
        depth, was, x = touch[i, DEPTH], before[i, 0], feet.body[feet.owner[i], X]
        if (depth > 0.0) != (was > 0.0):
            kind = LANDS if depth > 0.0 else LEAVES
            write(time - dt * depth / (depth - was), kind, i, x, log.events, tally)
        elif depth > 0.0 and (touch[i, STUCK] > 0.0) != (before[i, 1] > 0.0):
            kind = STICKS if touch[i, STUCK] > 0.0 else SLIPS
            write(time - 0.5 * dt, kind, i, x, log.events, tally)
        before[i, 0], before[i, 1] = depth, touch[i, STUCK]


@inline
def write(time: float, kind: float, point: int, x: float, events: Array, tally: Indices) -> None:
    """One event, as long as there is room; all are counted."""
    row = tally[EVENTS]
    if row < len(events):
        events[row, EVENT_TIME], events[row, EVENT_KIND] = time, kind
        events[row, EVENT_POINT], events[row, EVENT_X] = point, x
    tally[EVENTS] += 1


@inline
def keep(dt: float, feet: Feet, line: Line, log: Log) -> None:
    """Write one sample: the state now, means and sums since the last."""
    row, span = log.tally[SAMPLES], dt * log.every
    for b in range(feet.body.shape[0]):
        _keep_slider(row, b, span, feet, log)
    for i in range(feet.points.shape[0]):
        log.pressures[row, i] = feet.touch[i, PUSH]
    for f in range(feet.state.shape[0]):
        log.heights[row, f, 0], log.heights[row, f, 1] = feet.state[f, HEIGHT], feet.state[f, PITCH]
    for p in range(log.points.shape[0]):
        total = 0.0
        for j in range(log.points.shape[1]):
            total += log.points[p, j] * line.factors[STILL, j]
        log.deflections[row, p] = total
    log.tally[SAMPLES] += 1


@inline
def _keep_slider(row: int, b: int, span: float, feet: Feet, log: Log) -> None:
    """One slider's state, means and sums since the last sample."""
    kept, sums, before = log.kept, feet.sums, log.before
    kept[row, b, KEPT_X], kept[row, b, KEPT_V] = feet.body[b, X], feet.body[b, V]
    kept[row, b, KEPT_RUB] = (sums[b, MEAN_RUB] - before[b, MEAN_RUB]) / span
    kept[row, b, KEPT_PUSH] = (sums[b, MEAN_PUSH] - before[b, MEAN_PUSH]) / span
    kept[row, b, KEPT_TOUCHING] = (sums[b, TOUCHING] - before[b, TOUCHING]) / span
    kept[row, b, KEPT_STICKING] = (sums[b, STICKING] - before[b, STICKING]) / span
    kept[row, b, KEPT_RUBBED] = sums[b, RUBBED] - before[b, RUBBED]
    kept[row, b, KEPT_ALONG] = sums[b, ALONG] - before[b, ALONG]
    speed, n = 0.0, 0
    for i in range(feet.first[b], feet.first[b + 1]):
        if feet.touch[i, PUSH] > 0.0:
            speed += feet.touch[i, SURFACE]
            n += 1
    kept[row, b, KEPT_SURFACE] = speed / n if n > 0 else np.nan
    for s in range(sums.shape[1]):
        before[b, s] = sums[b, s]
