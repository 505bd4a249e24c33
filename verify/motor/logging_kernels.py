"""The compiled log of a slider on feet: events between two mid-steps, samples with the means since the last."""

import numpy as np

from verify.jit import inline
from verify.models.arrays import Array, Indices
from verify.motion.records import STILL
from verify.motor import records as rec
from verify.motor.records import Feet, Line, Log


@inline
def note(time: float, dt: float, before: Array, feet: Feet, log: Log) -> None:
    """Write down who landed, left, stuck or slipped since the mid-step before, with `before` depth and sticking."""
    touch, tally = feet.touch, log.tally
    for i in range(touch.shape[0]):
        depth, was, x = touch[i, rec.DEPTH], before[i, 0], feet.body[feet.owner[i], rec.X]
        if (depth > 0.0) != (was > 0.0):
            kind = rec.LANDS if depth > 0.0 else rec.LEAVES
            write(time - dt * depth / (depth - was), kind, i, x, log.events, tally)
        elif depth > 0.0 and (touch[i, rec.STUCK] > 0.0) != (before[i, 1] > 0.0):
            kind = rec.STICKS if touch[i, rec.STUCK] > 0.0 else rec.SLIPS
            write(time - 0.5 * dt, kind, i, x, log.events, tally)
        before[i, 0], before[i, 1] = depth, touch[i, rec.STUCK]


@inline
def write(time: float, kind: float, point: int, x: float, events: Array, tally: Indices) -> None:
    """One event, as long as there is room; all are counted."""
    row = tally[rec.EVENTS]
    if row < len(events):
        events[row, rec.EVENT_TIME], events[row, rec.EVENT_KIND] = time, kind
        events[row, rec.EVENT_POINT], events[row, rec.EVENT_X] = point, x
    tally[rec.EVENTS] += 1


@inline
def keep(dt: float, feet: Feet, line: Line, log: Log) -> None:
    """Write one sample: the state now, means and sums since the last."""
    row, span = log.tally[rec.SAMPLES], dt * log.every
    for b in range(feet.body.shape[0]):
        _keep_slider(row, b, span, feet, log)
    for i in range(feet.points.shape[0]):
        log.pressures[row, i] = feet.touch[i, rec.PUSH]
    for f in range(feet.state.shape[0]):
        log.heights[row, f, 0], log.heights[row, f, 1] = feet.state[f, rec.HEIGHT], feet.state[f, rec.PITCH]
    for p in range(log.points.shape[0]):
        total = 0.0
        for j in range(log.points.shape[1]):
            total += log.points[p, j] * line.factors[STILL, j]
        log.deflections[row, p] = total
    log.tally[rec.SAMPLES] += 1


@inline
def _keep_slider(row: int, b: int, span: float, feet: Feet, log: Log) -> None:
    """One slider's state, means and sums since the last sample."""
    kept, sums, before = log.kept, feet.sums, log.before
    kept[row, b, rec.KEPT_X], kept[row, b, rec.KEPT_V] = feet.body[b, rec.X], feet.body[b, rec.V]
    kept[row, b, rec.KEPT_RUB] = (sums[b, rec.MEAN_RUB] - before[b, rec.MEAN_RUB]) / span
    kept[row, b, rec.KEPT_PUSH] = (sums[b, rec.MEAN_PUSH] - before[b, rec.MEAN_PUSH]) / span
    kept[row, b, rec.KEPT_TOUCHING] = (sums[b, rec.TOUCHING] - before[b, rec.TOUCHING]) / span
    kept[row, b, rec.KEPT_STICKING] = (sums[b, rec.STICKING] - before[b, rec.STICKING]) / span
    kept[row, b, rec.KEPT_RUBBED] = sums[b, rec.RUBBED] - before[b, rec.RUBBED]
    kept[row, b, rec.KEPT_ALONG] = sums[b, rec.ALONG] - before[b, rec.ALONG]
    speed, n = 0.0, 0
    for i in range(feet.first[b], feet.first[b + 1]):
        if feet.touch[i, rec.PUSH] > 0.0:
            speed += feet.touch[i, rec.SURFACE]
            n += 1
    kept[row, b, rec.KEPT_SURFACE] = speed / n if n > 0 else np.nan
    for s in range(sums.shape[1]):
        before[b, s] = sums[b, s]
