"""The compiled friction of many points on one slider: by Coulomb's law or tanh, or through a layer that gives way."""

import numpy as np

from verify.models.arrays import Array
from verify.models.kernels import part
from verify.motor.records import (
    AFTER,
    CLOSING,
    DEPTH,
    GRIP,
    HELD,
    INVERSE_MASS,
    MEAN,
    MU,
    PULL,
    PUSH,
    RUB,
    STIFF,
    STRETCH,
    STUCK,
    SURFACE,
    SURFACE_BEFORE,
    Feet,
    V,
)

ROUNDS = 100
"""Of the search for a speed under tanh: each halves what is left at least."""


@part()
def _touched(i: int, dt: float, gone: float, feet: Feet, before: Array) -> float:
    """For how long point i has touched, of so much of the step: in the step of its landing, from there on."""
    depth, was = feet.touch[i, DEPTH], before[i, 0]
    if depth <= 0.0 or was > 0.0:
        return gone
    return float(dt * depth / (depth - was) + gone - 0.5 * dt)


@part()
def stretch(dt: float, feet: Feet, before: Array) -> None:
    """Points that give way are stretched on by the end of the step, as far as friction there lets them.

    The normal force at the end is that of mid-step, drawn on as the gap closes.
    """
    touch, points = feet.touch, feet.points
    for i in range(points.shape[0]):
        if points[i, GRIP] > 0.0:
            b = feet.owner[i]
            push = touch[i, PUSH] + 0.5 * dt * points[i, STIFF] * touch[i, CLOSING]
            most = feet.riders[b, MU] * (push if push > 0.0 else 0.0) / points[i, GRIP]
            most = most if touch[i, PUSH] > 0.0 else 0.0
            far = touch[i, STRETCH] + _touched(i, dt, dt, feet, before) * (touch[i, SURFACE] - feet.means[b, MEAN])
            far = most if far > most else far
            touch[i, STRETCH] = -most if far < -most else far


@part()
def hold(dt: float, feet: Feet, before: Array) -> None:
    """Friction in mid-step of points that give way, and their sum on every slider."""
    touch, points = feet.touch, feet.points
    for b in range(feet.body.shape[0]):
        feet.means[b, HELD] = 0.0
    for i in range(points.shape[0]):
        if points[i, GRIP] > 0.0:
            b = feet.owner[i]
            most = feet.riders[b, MU] * touch[i, PUSH]
            since = _touched(i, dt, 0.5 * dt, feet, before)
            force = points[i, GRIP] * (touch[i, STRETCH] + since * (touch[i, SURFACE] - feet.body[b, V]))
            touch[i, STUCK] = 1.0 if abs(force) < most else 0.0
            force = most if force > most else force
            touch[i, RUB] = -most if force < -most else force
            feet.means[b, HELD] += touch[i, RUB]


@part()
def _rubs(i: int, feet: Feet) -> bool:
    """Whether point i touches and does not give way."""
    return bool(feet.touch[i, PUSH] > 0.0 and feet.points[i, GRIP] == 0.0)


@part()
def _even(b: int, mean: float, feet: Feet, slope: float | None) -> tuple[float, float]:
    """Friction at a speed of slider b of its points that do not give way: (sum, what those at that speed can do)."""
    touch, total, reserve = feet.touch, 0.0, 0.0
    for i in range(feet.first[b], feet.first[b + 1]):
        if _rubs(i, feet):
            ahead, most = touch[i, SURFACE] - mean, feet.riders[b, MU] * touch[i, PUSH]
            if slope is not None:
                total += most * np.tanh(slope * ahead)
            elif ahead > 0.0:
                total += most
            elif ahead < 0.0:
                total -= most
            else:
                reserve += most
    return total, reserve


@part()
def agree(b: int, dt: float, feet: Feet, slope: float | None) -> float:
    """The mean speed of a step at which friction and slider b agree.

    Friction falls with the speed, so that there is one: Coulomb's between the speeds of the surface under two points or
    at one of them, that of tanh by halving and Newton's steps.
    """
    light = feet.riders[b, INVERSE_MASS]
    if light == 0.0:
        return float(feet.body[b, V])
    gain, most = 0.5 * dt * light, 0.0
    for i in range(feet.first[b], feet.first[b + 1]):
        most += feet.riders[b, MU] * feet.touch[i, PUSH] if _rubs(i, feet) else 0.0
    free = feet.body[b, V] + gain * (feet.riders[b, PULL] + feet.means[b, HELD])
    if most == 0.0:
        return float(free)
    if slope is not None:
        return _by_halving(b, free - gain * most, free + gain * most, free, gain, feet, slope)
    return _by_points(b, free - gain * most, free + gain * most, free, gain, feet, slope)


@part()
def _by_points(b: int, low: float, high: float, free: float, gain: float, feet: Feet, slope: float | None) -> float:
    """Coulomb: surface speeds between low and high are tried until one holds the slider or none is left between."""
    for i in range(feet.first[b], feet.first[b + 1]):
        at = feet.touch[i, SURFACE]
        if low < at < high and _rubs(i, feet):
            total, reserve = _even(b, at, feet, slope)
            wanted = (at - free) / gain - total
            if abs(wanted) <= reserve:
                return float(at)
            if wanted > 0.0:
                high = at
            else:
                low = at
    total, _ = _even(b, 0.5 * (low + high), feet, slope)
    return float(free + gain * total)


@part()
def _by_halving(b: int, low: float, high: float, free: float, gain: float, feet: Feet, slope: float) -> float:
    """tanh: the root of mean - free - gain friction(mean), which rises, from the speed at the start of the step."""
    mean = feet.body[b, V]
    mean = low if mean < low else high if mean > high else mean
    for _ in range(ROUNDS):
        miss, rise = _miss(b, mean, free, gain, feet, slope)
        if miss > 0.0:
            high = mean
        else:
            low = mean
        after = mean - miss / rise
        if not low < after < high:
            after = 0.5 * (low + high)
        if abs(after - mean) <= 1e-15 * (abs(mean) + abs(high - low)) or after == mean:
            return float(after)
        mean = after
    return float(mean)


@part()
def _miss(b: int, mean: float, free: float, gain: float, feet: Feet, slope: float) -> tuple[float, float]:
    """(mean - free - gain friction, its rise with the mean)."""
    touch, miss, rise = feet.touch, mean - free, 1.0
    for i in range(feet.first[b], feet.first[b + 1]):
        if _rubs(i, feet):
            most = feet.riders[b, MU] * touch[i, PUSH]
            share = np.tanh(slope * (touch[i, SURFACE] - mean))
            miss -= gain * most * share
            rise += gain * most * slope * (1.0 - share * share)
    return miss, rise


@part()
def share(b: int, dt: float, mean: float, feet: Feet, slope: float | None) -> None:
    """Friction of every point of slider b that does not give way; those that stick share what is left."""
    touch, riders = feet.touch, feet.riders
    total, reserve = _even(b, mean, feet, slope)
    left, light = 0.0, riders[b, INVERSE_MASS]
    if reserve > 0.0 and light > 0.0:
        left = 2.0 * (mean - feet.body[b, V]) / (dt * light) - riders[b, PULL] - feet.means[b, HELD] - total
        left = left / reserve
    for i in range(feet.first[b], feet.first[b + 1]):
        if feet.points[i, GRIP] > 0.0:
            continue
        most, ahead = riders[b, MU] * touch[i, PUSH], touch[i, SURFACE] - mean
        touch[i, STUCK] = 0.0
        if slope is not None:
            touch[i, RUB] = most * np.tanh(slope * ahead)
        elif ahead == 0.0:
            touch[i, RUB] = most * left
            touch[i, STUCK] = 1.0 if touch[i, PUSH] > 0.0 else 0.0
        else:
            touch[i, RUB] = most if ahead > 0.0 else -most


@part()
def settle(b: int, dt: float, mean: float, feet: Feet) -> None:
    """Mean and last speed of a step: that of the point that holds the slider, drawn on; otherwise by the mean.

    What was off when the stick began would otherwise swing on about the surface from step to step. It is bounded by
    what the point that holds can do.
    """
    touch, v, riders = feet.touch, feet.body[b, V], feet.riders
    after, gain = 2.0 * mean - v, dt * riders[b, INVERSE_MASS]
    for i in range(feet.first[b], feet.first[b + 1]):
        if gain > 0.0 and touch[i, STUCK] > 0.0 and _rubs(i, feet):
            wanted = 1.5 * touch[i, SURFACE] - 0.5 * touch[i, SURFACE_BEFORE]
            more = (wanted - after) / gain
            most, rub = riders[b, MU] * touch[i, PUSH], touch[i, RUB]
            more = most - rub if more > most - rub else more
            more = -most - rub if more < -most - rub else more
            touch[i, RUB] += more
            after += gain * more
            break
    feet.means[b, MEAN], feet.means[b, AFTER] = 0.5 * (v + after), after
