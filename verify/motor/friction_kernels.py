"""The compiled friction of many points on a slider that does not act on the beam.

Tanh: one mean speed of the step agrees with all points. Coulomb: where the surface under a point passes the slider's
speed, its friction reverses by 2 mu N; the shares of a step are found on straight lines through its middle, of that
speed and of the normal force. Points with tangential stiffness stretch until they slip.
"""

import numpy as np

from verify.arrays import Array
from verify.jit import inline
from verify.motor import records as rec
from verify.motor.records import Feet

WIDER = 1.125
"""Of the most that friction is: sought so far, since where a point slides one way Newton's step ends on 1."""
ROUNDS = 100
"""Of the search for a speed under tanh: each halves what is left at least."""
SHORT = 1.0
"""Of the turn of tanh: half a step that long is seen by its middle alone."""
FAR = 20.0
"""From there on tanh is 1 to the last digit, and ln cosh a straight line."""
NONE = 1e-12
"""Of the speeds at hand: by no more is a surface ahead that goes with the slider."""


@inline
def _touched(i: int, dt: float, gone: float, feet: Feet, before: Array) -> float:
    """For how long point i has touched, of so much of the step: in the step of its landing, from there on."""
    depth, was = feet.touch[i, rec.DEPTH], before[i, 0]
    if depth <= 0.0 or was > 0.0:
        return gone
    return float(dt * depth / (depth - was) + gone - 0.5 * dt)


@inline
def stretch(dt: float, feet: Feet, before: Array) -> None:
    """Points that give way are stretched on by the end of the step, as far as friction there lets them.

    The normal force at the end is that of mid-step, drawn on as the gap closes.
    """
    touch, points = feet.touch, feet.points
    for i in range(points.shape[0]):
        if points[i, rec.GRIP] > 0.0:
            b = feet.owner[i]
            push = touch[i, rec.PUSH] + 0.5 * dt * points[i, rec.STIFF] * touch[i, rec.CLOSING]
            most = feet.riders[b, rec.MU] * (push if push > 0.0 else 0.0) / points[i, rec.GRIP]
            most = most if touch[i, rec.PUSH] > 0.0 else 0.0
            far = touch[i, rec.STRETCH] + _touched(i, dt, dt, feet, before) * (
                touch[i, rec.SURFACE] - feet.means[b, rec.MEAN]
            )
            far = most if far > most else far
            touch[i, rec.STRETCH] = -most if far < -most else far


@inline
def hold(dt: float, feet: Feet, before: Array) -> None:
    """Friction in mid-step of points that give way, and their sum on every slider."""
    touch, points = feet.touch, feet.points
    for b in range(feet.body.shape[0]):
        feet.means[b, rec.HELD] = 0.0
    for i in range(points.shape[0]):
        if points[i, rec.GRIP] > 0.0:
            b = feet.owner[i]
            most = feet.riders[b, rec.MU] * touch[i, rec.PUSH]
            since = _touched(i, dt, 0.5 * dt, feet, before)
            force = points[i, rec.GRIP] * (
                touch[i, rec.STRETCH] + since * (touch[i, rec.SURFACE] - feet.body[b, rec.V])
            )
            touch[i, rec.STUCK] = 1.0 if abs(force) < most else 0.0
            force = most if force > most else force
            touch[i, rec.RUB] = -most if force < -most else force
            feet.means[b, rec.HELD] += touch[i, rec.RUB]


@inline
def _bent(x: float) -> tuple[float, float]:
    """(ln cosh x + ln 2, tanh x)."""
    size = abs(x)
    if size > FAR:
        return size, 1.0 if x > 0.0 else -1.0
    left = np.exp(-2.0 * size)
    turned = (1.0 - left) / (1.0 + left)
    return float(size + np.log1p(left)), float(turned if x > 0.0 else -turned)


@inline
def _turned(ahead: float, half: float, slope: float) -> tuple[float, float]:
    """(tanh of how far a surface is ahead, its rise with that), of a step through whose half it goes by `half` m/s.

    Where that is longer than the turn of the law, these are means over the step; otherwise its middle tells them.
    """
    if half * slope < SHORT:
        turned = np.tanh(slope * ahead)
        return float(turned), float(slope * (1.0 - turned * turned))
    above, high = _bent(slope * (ahead + half))
    below, low = _bent(slope * (ahead - half))
    return (above - below) / (2.0 * slope * half), (high - low) / (2.0 * half)


@inline
def agree(
    first: int, last: int, light: float, pull: float, v: float, mu: float, slope: float, touch: Array
) -> tuple[float, float]:
    """(mean speed of a slider in a step, that at its end), and with them friction of every point, by tanh.

    `light` is the step over the slider's mass, `pull` what else acts on it, v its speed as the step begins. Friction
    falls with the speed, so that one mean agrees with it: by halving and Newton's steps.
    """
    gain, wide, free, mean = 0.5 * light, 0.0, v + 0.5 * light * pull, v
    for i in range(first, last):
        wide += gain * mu * touch[i, rec.PUSH]
    low, high = free - WIDER * wide, free + WIDER * wide
    mean = low if mean < low else high if mean > high else mean
    for _ in range(ROUNDS):
        total, rise = _slid(first, last, mean, wide, mu, slope, touch)
        after = mean - (mean - free - gain * total) / (1.0 + gain * rise)
        if mean - free - gain * total > 0.0:
            high = mean
        else:
            low = mean
        near = 1e-15 * (abs(mean) + abs(high - low))
        if abs(after - mean) > near and not low < after < high:
            after = 0.5 * (low + high)
        if abs(after - mean) <= near:
            break
        mean = after
    return mean, 2.0 * mean - v


@inline
def _slid(
    first: int, last: int, mean: float, wide: float, mu: float, slope: float, touch: Array
) -> tuple[float, float]:
    """(sum of friction on a slider of this mean speed, how it falls with that); every point has its own.

    By what friction may give the slider in half a step, `wide` m/s, it may go with the surface.
    """
    total, fall = 0.0, 0.0
    for i in range(first, last):
        most = mu * touch[i, rec.PUSH]
        half = 0.5 * abs(touch[i, rec.SURFACE] - touch[i, rec.SURFACE_BEFORE]) - wide
        turned, more = _turned(touch[i, rec.SURFACE] - mean, half, slope)
        touch[i, rec.RUB], touch[i, rec.STUCK] = most * turned, 0.0
        total += most * turned
        fall += most * more
    return total, fall


@inline
def _snapped(ahead: float, i: int, v: float, light: float, touch: Array) -> float:
    """How far a surface is ahead, 0 where that is rounding: points that stick are let go by nothing else."""
    speeds = abs(touch[i, rec.SURFACE]) + abs(v) + light * touch[i, rec.MOST]
    return 0.0 if abs(ahead) <= NONE * speeds else ahead


@inline
def _begin(first: int, last: int, light: float, v: float, mu: float, touch: Array, points: Array) -> None:
    """How far every point's surface is ahead of v as the step begins, and what friction can do there.

    The line has the mean speed of the step, which is off that of its middle by what the surface gains the more over 24.
    """
    for i in range(first, last):
        touch[i, rec.MOST] = 0.0
        if points[i, rec.GRIP] == 0.0:
            touch[i, rec.RUB], touch[i, rec.BEYOND], touch[i, rec.STUCK] = 0.0, 0.0, 0.0
            touch[i, rec.MOST] = mu * touch[i, rec.PUSH]
            gained = touch[i, rec.SURFACE] - touch[i, rec.SURFACE_BEFORE]
            ahead = touch[i, rec.SURFACE] + (gained - touch[i, rec.GAINED]) / 24.0 - 0.5 * gained - v
            touch[i, rec.AHEAD] = _snapped(ahead, i, v, light, touch)
            touch[i, rec.GAINED] = gained


@inline
def _level(first: int, last: int, gain: float, touch: Array) -> tuple[float, float]:
    """Friction on a slider that gains so much in a step: (sum of what slides, what the points at its speed can do)."""
    total, reserve = 0.0, 0.0
    for i in range(first, last):
        way = touch[i, rec.AHEAD] if touch[i, rec.AHEAD] != 0.0 else touch[i, rec.GAINED] - gain
        if way > 0.0:
            total += touch[i, rec.MOST]
        elif way < 0.0:
            total -= touch[i, rec.MOST]
        else:
            reserve += touch[i, rec.MOST]
    return total, reserve


@inline
def _gain(first: int, last: int, light: float, pull: float, touch: Array) -> tuple[float, float]:
    """(what a slider would gain in a whole step by what acts now, m/s; the share of mu N that holds it at a point).

    Friction falls with that gain, so that there is one: between what the surface gains under two of the points that are
    at the slider's speed, or what it gains under one, which then holds it.
    """
    free, most = light * pull, 0.0
    for i in range(first, last):
        most += touch[i, rec.MOST]
    low, high = free - light * most, free + light * most
    for i in range(first, last):
        at = touch[i, rec.GAINED]
        if low < at < high and touch[i, rec.AHEAD] == 0.0 and touch[i, rec.MOST] > 0.0:
            total, reserve = _level(first, last, at, touch)
            wanted = (at - free) / light - total
            if abs(wanted) <= reserve:
                return float(at), float(wanted / reserve)
            if wanted > 0.0:
                high = at
            else:
                low = at
    total, _ = _level(first, last, 0.5 * (low + high), touch)
    return float(free + light * total), 0.0


@inline
def _next(first: int, last: int, left: float, gain: float, touch: Array) -> tuple[int, float]:
    """(the point whose surface next passes the slider's speed, below 0 if none does; after how much of the step)."""
    found, share = -1, left
    for i in range(first, last):
        ahead, more = touch[i, rec.AHEAD], touch[i, rec.GAINED] - gain
        if ahead * more < 0.0 and abs(ahead) < share * abs(more) and touch[i, rec.MOST] > 0.0:
            found, share = i, -ahead / more
    return found, share


@inline
def _go_on(
    first: int, last: int, done: float, share: float, gain: float, held: float, v: float, light: float, touch: Array
) -> None:
    """What a share of the step adds to the friction of all points, and by how much the surface is ahead then."""
    middle = done + 0.5 * share - 0.5
    for i in range(first, last):
        most = touch[i, rec.MOST]
        if most > 0.0:
            before, more = touch[i, rec.AHEAD], touch[i, rec.GAINED] - gain
            way = before if before != 0.0 else more
            force = most * (1.0 + middle * (1.0 - touch[i, rec.PUSH_BEFORE] / touch[i, rec.PUSH]))
            force = 0.0 if force < 0.0 else force if way > 0.0 else -force if way < 0.0 else held * most
            touch[i, rec.AHEAD] = _snapped(before + share * more, i, v, light, touch)
            touch[i, rec.STUCK] = 1.0 if way == 0.0 else 0.0
            touch[i, rec.RUB] += share * force
            touch[i, rec.BEYOND] += share * force * (before + 0.5 * share * more)


@inline
def cross(
    first: int, last: int, light: float, pull: float, v: float, mu: float, touch: Array, points: Array
) -> tuple[float, float]:
    """(mean speed of a slider in a step, that at its end) by friction of its points that do not give way.

    `light` is the step over the slider's mass, `pull` what else acts on it, v its speed as the step begins.
    """
    _begin(first, last, light, v, mu, touch, points)
    done = 0.0
    for _ in range(4 * (last - first) + 4):
        gain, held = _gain(first, last, light, pull, touch)
        found, share = _next(first, last, 1.0 - done, gain, touch)
        _go_on(first, last, done, share, gain, held, v, light, touch)
        done += share
        if found < 0:
            break
        touch[found, rec.AHEAD] = 0.0
    for i in range(first, last):
        pull += touch[i, rec.RUB] if touch[i, rec.MOST] > 0.0 else 0.0
    mean = v + 0.5 * light * pull
    for i in range(first, last):
        if touch[i, rec.MOST] > 0.0:
            touch[i, rec.BEYOND] -= touch[i, rec.RUB] * (touch[i, rec.SURFACE] - mean)
    return mean, v + light * pull
