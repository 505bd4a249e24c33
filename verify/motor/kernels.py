"""The compiled loop of a stage on feet: half a step of free motion, forces in its middle, the other half."""

import numpy as np

from verify.arrays import Array
from verify.jit import inline, jit
from verify.motion.records import MOVING, STILL, Surface
from verify.motion.surface_kernels import between, find_piece, rotate_half, set_factors
from verify.motor import records as rec
from verify.motor.beam_kernels import bear, clear, leave, match, moved
from verify.motor.feet_kernels import draw, drift, gone, keep, kick, note, place, press, see, stored
from verify.motor.friction_kernels import agree, cross, hold, stretch
from verify.motor.records import BeamAnswer, Feet, GivenSurface, Line, Log, Rubbing

GIVES_WAY = 4
"""Times that dashpots and the beam under them are matched: each leaves half of c times the beam's answer in a step."""


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
def _look(number: int, surface: Surface, given: GivenSurface, half: float, line: Line, feet: Feet) -> None:
    """Every point sees the surface under it, in the middle of a step of that number."""
    edges, reckoned = surface.edges, len(given.local) == 0
    for i in range(feet.points.shape[0]):
        x, piece = place(i, feet), feet.piece[i]
        if line.stamp[piece] != number:
            if reckoned:
                draw(surface.table, piece, line)
            else:
                for d in range(given.local.shape[3]):
                    line.local[piece, STILL, d] = given.local[number, piece, STILL, d]
                    line.local[piece, MOVING, d] = given.local[number, piece, MOVING, d]
            line.stamp[piece] = number
        see(i, x, edges[piece], edges[piece + 1] - edges[piece], gone(i, feet), half, line, feet)
        if not reckoned:
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
def _close(i: int, across: float, feet: Feet) -> None:
    """How fast the gap at point i closes, with what the forces of the step give to the beam across there."""
    answer = feet.points[i, rec.IMAGE] * feet.points[i, rec.FACE] * across
    feet.touch[i, rec.CLOSING] += answer - feet.touch[i, rec.ANSWER]
    feet.touch[i, rec.ANSWER] = answer


@inline
def _rub_back(
    dt: float,
    damped: bool,
    surface: Surface,
    feet: Feet,
    half: float,
    slope: float | None,
    beam: BeamAnswer,
    before: Array,
) -> None:
    """The same where the beam feels it; what points see of the surface is its mean then."""
    for _ in range(GIVES_WAY if damped else 0):
        clear(feet, beam)
        bear(dt, surface.edges, half, feet, beam)
        for i in range(feet.points.shape[0]):  # dashpots act on the closing speed with the beam's response
            if feet.touch[i, rec.DEPTH] > 0.0:
                length = surface.edges[feet.piece[i] + 1] - surface.edges[feet.piece[i]]
                _close(i, moved(i, length, half, feet, beam)[1], feet)
        press(dt, feet, before)
    hold(dt, feet, before)
    clear(feet, beam)
    bear(dt, surface.edges, half, feet, beam)
    match(dt, surface.edges, half, feet, slope, beam)
    for i in range(feet.points.shape[0]):
        piece = feet.piece[i]
        along, across = moved(i, surface.edges[piece + 1] - surface.edges[piece], half, feet, beam)
        feet.touch[i, rec.SURFACE] += along
        feet.touch[i, rec.GAINED] = along
        if feet.touch[i, rec.PUSH] > 0.0:
            feet.touch[i, rec.LIFT] += feet.points[i, rec.IMAGE] * across
            _close(i, across, feet)
            feet.sums[feet.owner[i], rec.LIFTED] -= dt * feet.touch[i, rec.RUB] * feet.touch[i, rec.SURFACE]
    leave(surface.table, surface.modes, beam)


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
    surface: Surface,
    given: GivenSurface,
    feet: Feet,
    rubbing: Rubbing,
    beam: BeamAnswer | None,
    line: Line,
    before: Array,
    log: Log,
) -> int:
    """Advance beam and stage by n_steps from step tally[STEP]; why it came back.

    A surface that is given does not feel the stage, and needs no modes.

    `before` is (points, 2), depth and sticking at the last mid-step. All arrays are advanced in place, together.
    """
    modes, tally = surface.modes, log.tally
    for _ in range(n_steps):
        number = tally[rec.STEP]
        if not _stand(0.5 * dt, surface.edges, feet):
            stored(dt, feet)
            return rec.OFF_BEAM
        drift(0.5 * dt, feet)
        rotate_half(modes)
        set_factors((number + 0.5) * dt, modes, surface.drive, line.factors)
        _look(number, surface, given, rubbing.half, line, feet)
        damped = press(dt, feet, before)
        if beam is None:
            _rub(dt, feet, rubbing.slope, before)
        else:
            _rub_back(dt, damped, surface, feet, rubbing.half, rubbing.slope, beam, before)
        rotate_half(modes)
        if not _take(surface.drive.origin + (number + 0.5) * dt, dt, before, feet, log):
            return rec.NOT_FINITE
        if tally[rec.STEP] % log.every == 0:
            if len(log.points) > 0:
                set_factors((number + 1.0) * dt, modes, surface.drive, line.factors)
            stored(dt, feet)
            keep(dt, feet, line, log)
    stored(dt, feet)
    return rec.DONE
