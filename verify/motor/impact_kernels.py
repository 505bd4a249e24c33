"""The compiled hard slider: a point that flies in parabolas, lands with restitution, and rides until it leaves again.

On a steady beam that does not feel it, so that the surface is known at every instant: landings and leavings are found
by halving, wherever in a step they fall. So is where friction turns round.
"""

import numpy as np

from verify.arrays import Array
from verify.jit import inline, jit
from verify.motion.records import Surface
from verify.motion.surface_kernels import find_piece, set_factors
from verify.motor import records as rec
from verify.motor.beam_kernels import slide_by_tanh
from verify.motor.feet_kernels import draw, keep, material, write
from verify.motor.records import Feet, Hard, Line, Log, Rubbing

HALVINGS = 100
BLOWS = 100_000
"""In a step, at most, with leavings and turns; a bounce that dies away has far fewer, what goes on and on is told."""
SETTLED = 1e-6
"""Of a step: a bounce that lasts no longer is a rest."""
TOLD = 4e-15
"""Rounding of the surface, of its height and of what it rises in all time so far, by which its phase is rounded."""
LOW = 1e4
"""Of that: what is higher is a bounce whatever it loses."""
ALIKE = 1e-9
"""Of the speeds at hand: a slip that is no more than that is none."""


@inline
def _under(t: float, x: float, v: float, surface: Surface, half: float, line: Line, feet: Feet) -> float:
    """The surface under x at a time: its height, NaN off the beam; sets its speed, its slope and how fast it rises.

    Its acceleration across, as a point that rides on it has it, goes to `kick`: of second order in the wave. One that
    is kept at its place goes along no slope, whatever its speed v.
    """
    touch, piece, v = feet.touch, find_piece(surface.edges, x, feet.piece[0]), v * feet.riders[0, rec.FREE]
    if piece < 0:
        return np.nan
    feet.piece[0] = piece
    edge, length = surface.edges[piece], surface.edges[piece + 1] - surface.edges[piece]
    set_factors(t, surface.modes, surface.drive, line.factors)
    draw(surface.table, piece, line)
    _, level, slope, bend, rise, turn, along = material(piece, (x - edge) / length, length, half, line)
    touch[0, rec.SURFACE], touch[0, rec.SLOPE] = along, slope
    passed, square = v + half * (turn + bend * v), surface.drive.omega * surface.drive.omega
    touch[0, rec.LIFT], touch[0, rec.RAMP] = rise + slope * passed, slope * (v + half * bend * v)
    feet.kick[0, 0] = -square * (level + half * slope * slope) + (2.0 * turn + bend * passed) * passed
    return level


@inline
def _gap(t: float, s: float, surface: Surface, rubbing: Rubbing, hard: Hard, line: Line, feet: Feet) -> float:
    """How far the flying point is above the surface, s seconds after t."""
    body, state, along = feet.body, feet.state, feet.riders[0, rec.INVERSE_MASS] * feet.riders[0, rec.PULL]
    free = feet.riders[0, rec.FREE]
    v = body[0, rec.V] + along * s
    x = body[0, rec.X] + free * (body[0, rec.V] + 0.5 * along * s) * s
    z = state[0, rec.HEIGHT] + (state[0, rec.CLIMB] - 0.5 * hard.press * s) * s
    return float(z - _under(t + s, x, v, surface, rubbing.half, line, feet))


@inline
def _pulling(rub: float, feet: Feet) -> float:
    """What pulls the point along beside this friction: `slider.pull`, or what holds its speed against friction."""
    return float(feet.riders[0, rec.PULL] if feet.riders[0, rec.INVERSE_MASS] > 0.0 else -rub)


@inline
def _move_flying(s: float, rubbing: Rubbing, hard: Hard, feet: Feet) -> None:
    """The point flies for s seconds."""
    body, state, sums = feet.body, feet.state, feet.sums
    along, free = feet.riders[0, rec.INVERSE_MASS] * feet.riders[0, rec.PULL], feet.riders[0, rec.FREE]
    way, rise = (body[0, rec.V] + 0.5 * along * s) * s, (state[0, rec.CLIMB] - 0.5 * hard.press * s) * s
    body[0, rec.X] += free * way
    body[0, rec.V] += along * s
    state[0, rec.HEIGHT] += rise
    state[0, rec.CLIMB] -= hard.press * s
    sums[0, rec.PULLED] += _pulling(0.0, feet) * way
    sums[0, rec.PRESSED] -= hard.mass * hard.press * rise


@inline
def _suit(most: float, ahead: float, ease: float, slope: float | None) -> float:
    """What friction gives, at most `most`, where the surface is ahead and each unit takes `ease` of that."""
    if slope is not None:
        return slide_by_tanh(most, ahead, ease, slope)
    if ease == 0.0:
        return most if ahead > 0.0 else -most if ahead < 0.0 else 0.0
    given = ahead / ease
    return most if given > most else -most if given < -most else given


@inline
def _land(rubbing: Rubbing, hard: Hard, feet: Feet, slope: float | None) -> float:
    """A blow: restitution across, friction along; the speed away from the surface after it, m/s."""
    body, state, touch, sums = feet.body, feet.state, feet.touch, feet.sums
    into = touch[0, rec.LIFT] - state[0, rec.CLIMB]
    into = into if into > 0.0 else 0.0
    blow = hard.mass * (1.0 + hard.restitution) * into
    state[0, rec.CLIMB] += blow / hard.mass
    ahead = touch[0, rec.SURFACE] - body[0, rec.V]
    rub = _suit(feet.riders[0, rec.MU] * blow, ahead, feet.riders[0, rec.INVERSE_MASS], slope)
    mean = body[0, rec.V] + 0.5 * feet.riders[0, rec.INVERSE_MASS] * rub
    body[0, rec.V] += feet.riders[0, rec.INVERSE_MASS] * rub
    uphill = blow * touch[0, rec.RAMP]
    sums[0, rec.ACROSS] += blow * touch[0, rec.LIFT] - uphill
    sums[0, rec.LIFTED] -= blow * touch[0, rec.LIFT] - uphill
    sums[0, rec.UPHILL] += uphill
    sums[0, rec.DAMPED] += 0.5 * blow * into * (1.0 - hard.restitution)
    sums[0, rec.ALONG] += rub * touch[0, rec.SURFACE]
    sums[0, rec.RUBBED] += rub * (touch[0, rec.SURFACE] - mean)
    sums[0, rec.PULLED] -= 0.0 if feet.riders[0, rec.INVERSE_MASS] > 0.0 else rub * mean
    sums[0, rec.MEAN_RUB] += rub
    sums[0, rec.MEAN_PUSH] += blow
    return hard.restitution * into


@inline
def _pushed(t: float, s: float, surface: Surface, rubbing: Rubbing, hard: Hard, line: Line, feet: Feet) -> float:
    """What the surface presses the riding point with, over its mass, s seconds after t."""
    free = feet.riders[0, rec.FREE]
    _under(
        t + s,
        feet.body[0, rec.X] + free * feet.body[0, rec.V] * s,
        feet.body[0, rec.V],
        surface,
        rubbing.half,
        line,
        feet,
    )
    return float(hard.press + feet.kick[0, 0])


@inline
def _margin(
    riding: bool, t: float, s: float, surface: Surface, rubbing: Rubbing, hard: Hard, line: Line, feet: Feet
) -> float:
    """What is below 0 once the riding point leaves, or once the flying one lands, s seconds after t."""
    if riding:
        return _pushed(t, s, surface, rubbing, hard, line, feet)
    return _gap(t, s, surface, rubbing, hard, line, feet)


@inline
def _lasts(
    riding: bool, t: float, h: float, surface: Surface, rubbing: Rubbing, hard: Hard, line: Line, feet: Feet
) -> float:
    """How long the point rides or flies on, at most h seconds: sought by halving on both halves of h."""
    if _margin(riding, t, 0.5 * h, surface, rubbing, hard, line, feet) < 0.0:
        low, high = 0.0, 0.5 * h
    elif _margin(riding, t, h, surface, rubbing, hard, line, feet) < 0.0:
        low, high = 0.5 * h, h
    else:
        return h
    for _ in range(HALVINGS):
        middle = 0.5 * (low + high)
        if middle <= low or middle >= high:
            break
        if _margin(riding, t, middle, surface, rubbing, hard, line, feet) < 0.0:
            high = middle
        else:
            low = middle
    return high


@inline
def _ahead(
    t: float, s: float, way: float, surface: Surface, rubbing: Rubbing, hard: Hard, line: Line, feet: Feet
) -> float:
    """How far the surface is ahead of the riding point, s seconds after t, which friction drags one way until then."""
    light, v, force = feet.riders[0, rec.INVERSE_MASS], feet.body[0, rec.V], 0.0
    if light > 0.0:
        push = _pushed(t, 0.5 * s, surface, rubbing, hard, line, feet)
        force = feet.riders[0, rec.PULL] + way * feet.riders[0, rec.MU] * hard.mass * (push if push > 0.0 else 0.0)
    after = v + s * light * force
    x = feet.body[0, rec.X] + feet.riders[0, rec.FREE] * 0.5 * (v + after) * s
    _under(t + s, x, after, surface, rubbing.half, line, feet)
    return float(feet.touch[0, rec.SURFACE] - after)


@inline
def _slides(t: float, h: float, surface: Surface, rubbing: Rubbing, hard: Hard, line: Line, feet: Feet) -> float:
    """For how long the riding point slides one way, at most h seconds, by halving: h where it begins with no slip."""
    first = _ahead(t, 0.0, 0.0, surface, rubbing, hard, line, feet)
    if abs(first) <= ALIKE * (abs(feet.touch[0, rec.SURFACE]) + abs(feet.body[0, rec.V])):
        return h
    way = 1.0 if first > 0.0 else -1.0
    if way * _ahead(t, 0.5 * h, way, surface, rubbing, hard, line, feet) < 0.0:
        low, high = 0.0, 0.5 * h
    elif way * _ahead(t, h, way, surface, rubbing, hard, line, feet) < 0.0:
        low, high = 0.5 * h, h
    else:
        return h
    for _ in range(HALVINGS):
        middle = 0.5 * (low + high)
        if middle <= low or middle >= high:
            break
        if way * _ahead(t, middle, way, surface, rubbing, hard, line, feet) < 0.0:
            high = middle
        else:
            low = middle
    return high


@inline
def _book_riding(s: float, mean: float, surface_mean: float, feet: Feet) -> None:
    """What s seconds of riding add to the sums along the beam, at these mean speeds of slider and surface."""
    sums, push, rub = feet.sums, feet.touch[0, rec.PUSH], feet.touch[0, rec.RUB]
    sums[0, rec.ALONG] += s * rub * surface_mean
    sums[0, rec.RUBBED] += s * rub * (surface_mean - mean)
    sums[0, rec.MEAN_RUB] += s * rub
    sums[0, rec.MEAN_PUSH] += s * push
    sums[0, rec.PULLED] += s * _pulling(rub, feet) * mean
    sums[0, rec.TOUCHING] += s
    sums[0, rec.STICKING] += s * feet.touch[0, rec.STUCK]


@inline
def _move_riding(
    t: float, s: float, surface: Surface, rubbing: Rubbing, hard: Hard, line: Line, feet: Feet, slope: float | None
) -> bool:
    """The point rides for s seconds, friction taken in their middle; whether it is still on the beam."""
    body, state, touch, sums = feet.body, feet.state, feet.touch, feet.sums
    free = feet.riders[0, rec.FREE]
    push = hard.mass * _pushed(t, 0.5 * s, surface, rubbing, hard, line, feet)
    push = push if push > 0.0 else 0.0
    gain = 0.5 * s * feet.riders[0, rec.INVERSE_MASS]
    ahead, v = touch[0, rec.SURFACE] - body[0, rec.V] - gain * feet.riders[0, rec.PULL], body[0, rec.V]
    rub = _suit(feet.riders[0, rec.MU] * push, ahead, gain, slope)
    surface_mean, uphill = touch[0, rec.SURFACE], s * push * touch[0, rec.RAMP]
    after = v + 2.0 * gain * (feet.riders[0, rec.PULL] + rub)
    stuck = slope is None and gain > 0.0 and abs(rub) < feet.riders[0, rec.MU] * push
    x = body[0, rec.X] + free * 0.5 * (v + after) * s
    level = _under(t + s, x, after, surface, rubbing.half, line, feet)
    if not np.isfinite(level):
        return False
    if stuck:
        most, wanted = feet.riders[0, rec.MU] * push, rub + (touch[0, rec.SURFACE] - after) / (2.0 * gain)
        rub = most if wanted > most else -most if wanted < -most else wanted
        after = v + 2.0 * gain * (feet.riders[0, rec.PULL] + rub)
    mean, rise = 0.5 * (v + after), level - state[0, rec.HEIGHT]
    across = (
        0.5 * hard.mass * (touch[0, rec.LIFT] ** 2 - state[0, rec.CLIMB] ** 2) + hard.mass * hard.press * rise - uphill
    )
    body[0, rec.X] += free * mean * s
    body[0, rec.V] = after
    state[0, rec.HEIGHT], state[0, rec.CLIMB] = level, touch[0, rec.LIFT]
    touch[0, rec.PUSH], touch[0, rec.RUB], touch[0, rec.STUCK] = push, rub, 1.0 if stuck else 0.0
    sums[0, rec.ACROSS] += across
    sums[0, rec.LIFTED] -= across
    sums[0, rec.UPHILL] += uphill
    sums[0, rec.PRESSED] -= hard.mass * hard.press * rise
    _book_riding(s, mean, surface_mean, feet)
    return True


@inline
def _rests(t: float, dt: float, away: float, presses: float, level: float, hard: Hard, touch: Array) -> bool:
    """Whether a bounce that begins at t is none: too short for the step, or low and fed by the rounding of the surface.

    Of its height away^2/(2 presses) a blow takes the share 1 - e^2, and the rounding of the level may add as much.
    """
    known, height = TOLD * (abs(level) + abs(touch[0, rec.LIFT]) * (t + dt)), away**2 / (2.0 * presses)
    fed = (1.0 - hard.restitution**2) * height <= known and height <= LOW * known
    return 2.0 * away <= SETTLED * dt * presses or fed


@inline
def _step(
    t: float, dt: float, surface: Surface, rubbing: Rubbing, hard: Hard, line: Line, before: Array, feet: Feet, log: Log
) -> int:
    """One step, cut where the point leaves or lands and where its friction turns; why it ended."""
    done, x = 0.0, feet.body[0, rec.X]
    origin = surface.drive.origin
    for _ in range(BLOWS):
        left = dt - done
        if left <= 1e-15 * dt:
            return rec.DONE
        riding = before[0, 0] > 0.0
        s = _lasts(riding, t + done, left, surface, rubbing, hard, line, feet)
        if riding:
            turns = _slides(t + done, s, surface, rubbing, hard, line, feet) if rubbing.slope is None else s
            leaves, s = s < left and turns >= s, turns
            if not _move_riding(t + done, s, surface, rubbing, hard, line, feet, rubbing.slope):
                return rec.OFF_BEAM
            if leaves:
                before[0, 0] = -1.0
                write(origin + t + done + s, rec.LEAVES, 0, x, log.events, log.tally)
        else:
            _move_flying(s, rubbing, hard, feet)
            feet.touch[0, rec.PUSH] = 0.0
            level = _under(t + done + s, feet.body[0, rec.X], feet.body[0, rec.V], surface, rubbing.half, line, feet)
            if not np.isfinite(level):
                return rec.OFF_BEAM
            if s < left:
                feet.state[0, rec.HEIGHT] = level
                away = _land(rubbing, hard, feet, rubbing.slope)
                presses = hard.press + feet.kick[0, 0]
                write(origin + t + done + s, rec.LANDS, 0, x, log.events, log.tally)
                if presses > 0.0 and _rests(t, dt, away, presses, level, hard, feet.touch):
                    before[0, 0] = 1.0
        done += s
    return rec.DONE if dt - done <= 1e-15 * dt else rec.CHATTERS


@jit
def hop(
    n_steps: int,
    dt: float,
    surface: Surface,
    feet: Feet,
    rubbing: Rubbing,
    hard: Hard,
    line: Line,
    before: Array,
    log: Log,
) -> int:
    """Advance a hard point by n_steps from step tally[STEP]; why it came back. `before` is (1, 2): above 0 it rides."""
    tally = log.tally
    for _ in range(n_steps):
        why = _step(tally[rec.STEP] * dt, dt, surface, rubbing, hard, line, before, feet, log)
        if why != rec.DONE:
            return why
        tally[rec.STEP] += 1
        if not np.isfinite(feet.body[0, rec.V] + feet.state[0, rec.HEIGHT]):
            return rec.NOT_FINITE
        if tally[rec.STEP] % log.every == 0:
            keep(dt, feet, line, log)
    return rec.DONE


@jit
def put(t: float, surface: Surface, feet: Feet, rubbing: Rubbing, line: Line) -> float:
    """Put a hard point on the surface, with its rate of rise; what presses it on less gravity's part, m/s^2."""
    feet.state[0, rec.HEIGHT] = _under(t, feet.body[0, rec.X], feet.body[0, rec.V], surface, rubbing.half, line, feet)
    feet.state[0, rec.CLIMB] = feet.touch[0, rec.LIFT]
    return float(feet.kick[0, 0])
