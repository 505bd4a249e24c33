"""The compiled friction of Coulomb on a slider that the beam does not feel: through a step from crossing to crossing.

Where the surface under a point passes the slider's speed, its friction turns round by 2 mu N. What a step has of either
side is found from straight lines through its middle, of that speed and of the normal force.
"""

from verify.jit import inline
from verify.models.arrays import Array
from verify.motor import records as rec

NONE = 1e-12
"""Of the speeds at hand: by no more is a surface ahead that goes with the slider."""


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
