"""The compiled friction of many points on one stage: by Coulomb's law or tanh, or through a layer that gives way."""

import numpy as np

from verify.models.kernels import part
from verify.motor.records import (
    CLOSING,
    GRIP,
    PUSH,
    RUB,
    STIFF,
    STRETCH,
    STUCK,
    SURFACE,
    SURFACE_BEFORE,
    Feet,
    Rubbing,
    V,
)

ROUNDS = 100
"""Of the search for a speed: every one of Coulomb's rules out a point's, of tanh halves what is left."""


@part()
def stretch(dt: float, mean: float, feet: Feet, rubbing: Rubbing) -> None:
    """Points that give way are stretched on by the end of the step, as far as friction there lets them.

    The normal force at the end is that of mid-step, drawn on as the gap closes.
    """
    touch, points = feet.touch, feet.points
    for i in range(points.shape[0]):
        if points[i, GRIP] > 0.0:
            push = touch[i, PUSH] + 0.5 * dt * points[i, STIFF] * touch[i, CLOSING]
            most = rubbing.mu * (push if push > 0.0 else 0.0) / points[i, GRIP]
            most = most if touch[i, PUSH] > 0.0 else 0.0
            far = touch[i, STRETCH] + dt * (touch[i, SURFACE] - mean)
            far = most if far > most else far
            touch[i, STRETCH] = -most if far < -most else far


@part()
def hold(dt: float, feet: Feet, rubbing: Rubbing) -> float:
    """Friction in mid-step of points that give way; their sum, newton."""
    touch, points, total, v = feet.touch, feet.points, 0.0, feet.body[V]
    for i in range(points.shape[0]):
        if points[i, GRIP] > 0.0:
            most = rubbing.mu * touch[i, PUSH]
            force = points[i, GRIP] * (touch[i, STRETCH] + 0.5 * dt * (touch[i, SURFACE] - v))
            touch[i, STUCK] = 1.0 if abs(force) < most else 0.0
            force = most if force > most else force
            touch[i, RUB] = -most if force < -most else force
            total += touch[i, RUB]
    return total


@part()
def _even(mean: float, feet: Feet, rubbing: Rubbing, slope: float | None) -> tuple[float, float]:
    """Friction at a speed of the stage of the points that do not give way: (sum, what those at that speed can)."""
    touch, points, total, reserve = feet.touch, feet.points, 0.0, 0.0
    for i in range(points.shape[0]):
        if touch[i, PUSH] > 0.0 and points[i, GRIP] == 0.0:
            ahead, most = touch[i, SURFACE] - mean, rubbing.mu * touch[i, PUSH]
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
def agree(dt: float, held: float, feet: Feet, rubbing: Rubbing, slope: float | None) -> float:
    """The mean speed of a step at which friction and the stage agree; `held` are forces that do not depend on it.

    Friction falls with the speed, so that there is one: Coulomb's between the speeds of the surface under two points or
    at one of them, that of tanh by halving and Newton's steps.
    """
    lightness = rubbing.lightness
    if lightness == 0.0:
        return float(feet.body[V])
    gain = 0.5 * dt * lightness
    most = 0.0
    for i in range(feet.points.shape[0]):
        most += rubbing.mu * feet.touch[i, PUSH] if feet.points[i, GRIP] == 0.0 else 0.0
    free = feet.body[V] + gain * (rubbing.pull + held)
    if most == 0.0:
        return float(free)
    if slope is not None:
        return _by_halving(free - gain * most, free + gain * most, free, gain, feet, rubbing, slope)
    return _by_points(free - gain * most, free + gain * most, free, gain, feet, rubbing, slope)


@part()
def _by_points(
    low: float, high: float, free: float, gain: float, feet: Feet, rubbing: Rubbing, slope: float | None
) -> float:
    """Coulomb: surface speeds between low and high are tried until one holds the stage or none is left between."""
    touch, points = feet.touch, feet.points
    for i in range(points.shape[0]):
        at = touch[i, SURFACE]
        if low < at < high and touch[i, PUSH] > 0.0 and points[i, GRIP] == 0.0:
            total, reserve = _even(at, feet, rubbing, slope)
            wanted = (at - free) / gain - total
            if abs(wanted) <= reserve:
                return float(at)
            if wanted > 0.0:
                high = at
            else:
                low = at
    total, _ = _even(0.5 * (low + high), feet, rubbing, slope)
    return float(free + gain * total)


@part()
def _by_halving(low: float, high: float, free: float, gain: float, feet: Feet, rubbing: Rubbing, slope: float) -> float:
    """tanh: the root of mean - free - gain friction(mean), which rises, from where it was a step before."""
    mean = feet.body[V]
    mean = low if mean < low else high if mean > high else mean
    for _ in range(ROUNDS):
        miss, rise = _miss(mean, free, gain, feet, rubbing, slope)
        if miss > 0.0:
            high = mean
        else:
            low = mean
        step = miss / rise
        after = mean - step
        if not low < after < high:
            after = 0.5 * (low + high)
        if abs(after - mean) <= 1e-15 * (abs(mean) + abs(high - low)) or after == mean:
            return float(after)
        mean = after
    return float(mean)


@part()
def _miss(mean: float, free: float, gain: float, feet: Feet, rubbing: Rubbing, slope: float) -> tuple[float, float]:
    """(mean - free - gain friction, its rise with the mean)."""
    touch, points, miss, rise = feet.touch, feet.points, mean - free, 1.0
    for i in range(points.shape[0]):
        if touch[i, PUSH] > 0.0 and points[i, GRIP] == 0.0:
            most = rubbing.mu * touch[i, PUSH]
            share = np.tanh(slope * (touch[i, SURFACE] - mean))
            miss -= gain * most * share
            rise += gain * most * slope * (1.0 - share * share)
    return miss, rise


@part()
def share(dt: float, mean: float, held: float, feet: Feet, rubbing: Rubbing, slope: float | None) -> None:
    """Friction of every point that does not give way, at the mean speed; those that stick share what is left."""
    touch, points = feet.touch, feet.points
    total, reserve = _even(mean, feet, rubbing, slope)
    left = 0.0
    if reserve > 0.0 and rubbing.lightness > 0.0:
        left = 2.0 * (mean - feet.body[V]) / (dt * rubbing.lightness) - rubbing.pull - held - total
        left = left / reserve
    for i in range(points.shape[0]):
        if points[i, GRIP] > 0.0:
            continue
        most, ahead = rubbing.mu * touch[i, PUSH], touch[i, SURFACE] - mean
        touch[i, STUCK] = 0.0
        if slope is not None:
            touch[i, RUB] = most * np.tanh(slope * ahead)
        elif ahead == 0.0:
            touch[i, RUB] = most * left
            touch[i, STUCK] = 1.0 if touch[i, PUSH] > 0.0 else 0.0
        else:
            touch[i, RUB] = most if ahead > 0.0 else -most


@part()
def settle(dt: float, mean: float, feet: Feet, rubbing: Rubbing) -> float:
    """The speed at the end of a step: that of the point that holds the stage, drawn on; otherwise by the mean.

    What was off when the stick began would otherwise swing on about the surface from step to step. It is bounded by
    what the point that holds can do.
    """
    touch, v = feet.touch, feet.body[V]
    after, gain = 2.0 * mean - v, dt * rubbing.lightness
    for i in range(feet.points.shape[0]):
        if touch[i, STUCK] > 0.0 and feet.points[i, GRIP] == 0.0:
            wanted = 1.5 * touch[i, SURFACE] - 0.5 * touch[i, SURFACE_BEFORE]
            more = (wanted - after) / gain
            most, rub = rubbing.mu * touch[i, PUSH], touch[i, RUB]
            more = most - rub if more > most - rub else more
            more = -most - rub if more < -most - rub else more
            touch[i, RUB] += more
            return float(after + gain * more)
    return float(after)
