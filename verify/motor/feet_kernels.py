"""The compiled feet: surface under their points, normal forces, motion across the beam, samples and events."""

import numpy as np

from verify.arrays import Array, Indices
from verify.jit import inline
from verify.motion.records import MOVING, STILL
from verify.motor import records as rec
from verify.motor.records import Feet, Line, Log


@inline
def material(
    piece: int, xi: float, length: float, lever: float, line: Line
) -> tuple[float, float, float, float, float, float, float]:
    """What stands over xi = 0 to 1 of a piece: (its own xi, w, w', w'', dw/dt, dw'/dt, its speed along the tangent).

    The material over x stands at X = x + lever w'(X) of the mid-line and moves with (-lever dw'/dt, dw/dt); `lever` is
    h/2 on the upper face, metres. All are of the mid-line at X, by metres and seconds.
    """
    local = line.local
    value, first = 0.0, 0.0
    for d in range(local.shape[2] - 1, 0, -1):
        value = value * xi + local[piece, STILL, d]
        first = first * xi + value
    at = xi + lever * first / (length * length)
    level, slope, bend, rise, turn = 0.0, 0.0, 0.0, 0.0, 0.0
    for d in range(local.shape[2] - 1, -1, -1):
        bend = bend * at + slope
        slope = slope * at + level
        level = level * at + local[piece, STILL, d]
        turn = turn * at + rise
        rise = rise * at + local[piece, MOVING, d]
    slope, bend, turn = slope / length, 2.0 * bend / (length * length), turn / length
    return at, level, slope, bend, rise, turn, (rise * slope - lever * turn) / np.sqrt(1.0 + slope * slope)


@inline
def drift(t: float, feet: Feet) -> None:
    """Sliders and feet move on with their speeds."""
    body, state = feet.body, feet.state
    for b in range(body.shape[0]):
        body[b, rec.X] += t * body[b, rec.V] * feet.riders[b, rec.FREE]
    for f in range(state.shape[0]):
        state[f, rec.HEIGHT] += t * state[f, rec.CLIMB]
        state[f, rec.PITCH] += t * state[f, rec.TURN]


@inline
def see(i: int, x: float, edge: float, length: float, v: float, half: float, line: Line, feet: Feet) -> None:
    """What point i sees of the surface under x, of its material there: speed along, height and rate, slope.

    `edge` and `length` are those of its piece, `v` is how fast its place goes along.
    """
    touch, state, foot = feet.touch, feet.state, feet.foot[i]
    image, face, arm, inset = (
        feet.points[i, rec.IMAGE],
        feet.points[i, rec.FACE],
        feet.points[i, rec.ARM],
        feet.points[i, rec.INSET],
    )
    lever = half * face * image
    above = (x - edge) / length
    at, level, slope, bend, rise, turn, along = material(feet.piece[i], above, length, lever, line)
    lift = image * (rise + slope * (v + lever * (turn + bend * v)))
    touch[i, rec.RAMP] = image * slope * (v + lever * bend * v)
    touch[i, rec.SURFACE_BEFORE], touch[i, rec.SURFACE], touch[i, rec.PUSH_BEFORE] = (
        touch[i, rec.SURFACE],
        along,
        touch[i, rec.PUSH],
    )
    touch[i, rec.AT], touch[i, rec.ABOVE], touch[i, rec.SLOPE], touch[i, rec.ANSWER], touch[i, rec.LIFT] = (
        at,
        above,
        slope,
        0.0,
        lift,
    )
    touch[i, rec.DEPTH] = inset + face * (image * level - state[foot, rec.HEIGHT] - arm * state[foot, rec.PITCH])
    touch[i, rec.CLOSING] = face * (lift - state[foot, rec.CLIMB] - arm * state[foot, rec.TURN])


@inline
def press(dt: float, feet: Feet, before: Array) -> bool:
    """Normal forces in mid-step and what they give to the feet; whether any point has a dashpot.

    `before` is (points, 2), depth at the last mid-step.

    Dashpots see the mean speed of the step: twice more, with half of what the force before has given.
    """
    _fall_free(dt, feet)
    damped = _push(feet, before)
    for _ in range(2 if damped else 0):
        _gather(dt, feet)
        _push(feet, before)
    _gather(dt, feet)
    return damped


@inline
def _fall_free(dt: float, feet: Feet) -> None:
    """What presses the feet, given for the step."""
    given = feet.given
    for f in range(feet.state.shape[0]):
        force = given[f, rec.PRESS] - given[f, rec.SPRING] * feet.state[f, rec.HEIGHT]
        feet.kick[f, 0] = dt * given[f, rec.FOOT_INVERSE_MASS] * force
        feet.kick[f, 1] = 0.0


@inline
def _push(feet: Feet, before: Array) -> bool:
    """Normal force of every point at its depth and mean speed; whether any has a dashpot.

    That of a dashpot jumps where a point lands: it counts from there on to the end of the step.
    """
    touch, points, damped = feet.touch, feet.points, False
    for i in range(points.shape[0]):
        depth, force = touch[i, rec.DEPTH], 0.0
        if depth > 0.0:
            force = points[i, rec.STIFF] * depth
            if points[i, rec.DASHPOT] > 0.0:
                foot, damped = feet.foot[i], True
                given = points[i, rec.FACE] * (feet.kick[foot, 0] + points[i, rec.ARM] * feet.kick[foot, 1])
                share = 0.5 + depth / (depth - before[i, 0]) if before[i, 0] <= 0.0 else 1.0
                force += share * points[i, rec.DASHPOT] * (touch[i, rec.CLOSING] - 0.5 * given)
            force = force if force > 0.0 else 0.0
        touch[i, rec.PUSH] = force
    return damped


@inline
def _gather(dt: float, feet: Feet) -> None:
    """Give the normal forces to the feet."""
    _fall_free(dt, feet)
    touch, points = feet.touch, feet.points
    for i in range(points.shape[0]):
        force = touch[i, rec.PUSH]
        if force > 0.0:
            foot, way = feet.foot[i], dt * points[i, rec.FACE] * force
            feet.kick[foot, 0] += way * feet.given[foot, rec.FOOT_INVERSE_MASS]
            feet.kick[foot, 1] += way * points[i, rec.ARM] * feet.given[foot, rec.FOOT_INVERSE_INERTIA]


@inline
def kick(dt: float, feet: Feet) -> None:
    """The feet take what the step gives them; its works."""
    state, sums, touch, points = feet.state, feet.sums, feet.touch, feet.points
    for i in range(points.shape[0]):
        force = touch[i, rec.PUSH]
        if touch[i, rec.DEPTH] > 0.0:
            foot, b = feet.foot[i], feet.owner[i]
            given = feet.kick[foot, 0] + points[i, rec.ARM] * feet.kick[foot, 1]
            closing = touch[i, rec.CLOSING] - 0.5 * points[i, rec.FACE] * given
            uphill = dt * force * points[i, rec.FACE] * touch[i, rec.RAMP]
            work = dt * force * points[i, rec.FACE] * touch[i, rec.LIFT] - uphill
            sums[b, rec.ACROSS] += work
            sums[b, rec.UPHILL] += uphill
            sums[b, rec.DAMPED] += dt * (force - points[i, rec.STIFF] * touch[i, rec.DEPTH]) * closing
            sums[b, rec.LIFTED] -= work
    for f in range(state.shape[0]):
        given = feet.given
        force = given[f, rec.PRESS] - given[f, rec.SPRING] * state[f, rec.HEIGHT]
        sums[feet.keeper[f], rec.PRESSED] += dt * force * (state[f, rec.CLIMB] + 0.5 * feet.kick[f, 0])
        state[f, rec.CLIMB] += feet.kick[f, 0]
        state[f, rec.TURN] += feet.kick[f, 1]


@inline
def stored(dt: float, feet: Feet) -> None:
    """Energy in the springs at the end of a step, at the depths of its middle drawn on."""
    state = feet.state
    for b in range(feet.sums.shape[0]):
        feet.sums[b, rec.STORED] = 0.0
    for i in range(feet.points.shape[0]):
        foot = feet.foot[i]
        climb = state[foot, rec.CLIMB] + feet.points[i, rec.ARM] * state[foot, rec.TURN]
        depth = feet.touch[i, rec.DEPTH] + 0.5 * dt * feet.points[i, rec.FACE] * (feet.touch[i, rec.LIFT] - climb)
        if depth > 0.0:
            feet.sums[feet.owner[i], rec.STORED] += 0.5 * feet.points[i, rec.STIFF] * depth * depth


@inline
def gone(i: int, feet: Feet) -> float:
    """How fast the place of point i goes along the beam, m/s: with its slider, unless that is kept where it is."""
    return float(feet.body[feet.owner[i], rec.V] * feet.riders[feet.owner[i], rec.FREE])


@inline
def place(i: int, feet: Feet) -> float:
    """Where point i stands, metres from where the slider started."""
    return float(feet.body[feet.owner[i], rec.X] + feet.points[i, rec.OFFSET])


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
def keep(dt: float, feet: Feet, log: Log) -> None:
    """Write one sample: the state now, means and sums since the last."""
    row, span = log.tally[rec.SAMPLES], dt * log.every
    for b in range(feet.body.shape[0]):
        _keep_slider(row, b, span, feet, log)
    for i in range(feet.points.shape[0]):
        log.pressures[row, i] = feet.touch[i, rec.PUSH]
    for f in range(feet.state.shape[0]):
        log.heights[row, f, 0], log.heights[row, f, 1] = feet.state[f, rec.HEIGHT], feet.state[f, rec.PITCH]
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
