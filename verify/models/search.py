"""The least of a size over an interval: the best of a grid, then Brent's method around it. A zero between two ends."""

from collections.abc import Callable, Sequence
from math import sqrt
from typing import TypeAlias

import msgspec
import numpy as np

from verify.models.arrays import Array


class Least(msgspec.Struct, frozen=True, kw_only=True):
    """Where a figure is least."""

    x: float
    value: float
    at_edge: bool
    """Whether it still falls at an end of the interval: then this is where the search ends, not a minimum."""


def least_over(figure: Callable[[Array], Array], grid: Array, tolerance: float) -> Least:
    """The least value of `figure`, which maps (n,) to (n,) and is never negative, on an ascending grid.

    To `tolerance` in x, by its square: a size that falls to nothing has a corner there, its square is a parabola, which
    two or three steps find where a corner takes fifteen. They start from the grid's own values, and go by the distance
    from its best, in which a search loses no digits to the size of x.
    """
    values = figure(grid)
    least = int(np.argmin(values))
    best, around = float(grid[least]), slice(max(least - 1, 0), least + 2)
    known = [(float(x) - best, float(value) ** 2) for x, value in zip(grid[around], values[around], strict=True)]
    ends = known[0][0], known[-1][0]
    away, square = least_between(lambda step: float(figure(np.array([best + step]))[0]) ** 2, *ends, tolerance, known)
    x = best + away
    distance = min(x - grid[0], grid[-1] - x)
    return Least(x=x, value=sqrt(square), at_edge=bool(distance < 0.01 * (grid[1] - grid[0])))


Point: TypeAlias = tuple[float, float]
GOLDEN = 0.5 * (3.0 - sqrt(5.0))
MOST_STEPS = 500


def least_between(
    figure: Callable[[float], float], low: float, high: float, tolerance: float, known: Sequence[Point] = ()
) -> Point:
    """(x, figure(x)) of the least value between two ends, to `tolerance` in x: parabolas, golden sections where not.

    Brent (Algorithms for Minimization without Derivatives, 1973, 5.8) in the order of Forsythe, Malcolm and Moler's
    FMIN, as `scipy.optimize.minimize_scalar(method="bounded")` has it, step by step; from two or three points that are
    `known`, (x, figure(x)), where it has nothing but the ends to start from.
    """
    step = before = 0.0
    if known:
        ranked = sorted(known, key=lambda point: point[1])
        (x, fx), (w, fw), (v, fv) = ranked[0], ranked[1], ranked[-1]
        before = high - low
    else:
        x = w = v = low + GOLDEN * (high - low)  # the best, the second best and the one before it
        fx = fw = fv = figure(x)
    for _ in range(MOST_STEPS - 1):
        middle = 0.5 * (low + high)
        finest = sqrt(2.2e-16) * abs(x) + tolerance / 3.0
        if abs(x - middle) <= 2.0 * finest - 0.5 * (high - low):
            break
        parabola = _by_parabola((x, fx), (w, fw), (v, fv), before, (low, high)) if abs(before) > finest else None
        if parabola is None:
            before = low - x if x >= middle else high - x
            step = GOLDEN * before
        else:
            before, step = step, parabola
            if min(x + step - low, high - (x + step)) < 2.0 * finest:
                step = finest if middle >= x else -finest
        there = x + (step if abs(step) >= finest else finest if step >= 0.0 else -finest)
        found = figure(there)
        if found <= fx:
            low, high = (x, high) if there >= x else (low, x)
            (v, fv), (w, fw), (x, fx) = (w, fw), (x, fx), (there, found)
        else:
            low, high = (there, high) if there < x else (low, there)
            if found <= fw or w == x:
                (v, fv), (w, fw) = (w, fw), (there, found)
            elif found <= fv or v in (x, w):
                v, fv = there, found
    return x, fx


def _by_parabola(best: Point, second: Point, third: Point, before: float, ends: Point) -> float | None:
    """The step to the lowest point of a parabola through three, None where it leads out or shrinks too slowly."""
    (x, fx), (w, fw), (v, fv) = best, second, third
    r, q = (x - w) * (fx - fv), (x - v) * (fx - fw)
    p, q = (x - v) * q - (x - w) * r, 2.0 * (q - r)
    p, q = (-p if q > 0.0 else p), abs(q)
    taken = abs(p) < abs(0.5 * q * before) and q * (ends[0] - x) < p < q * (ends[1] - x)
    return (p + 0.0) / q if taken else None


def zero_between(figure: Callable[[float], float], low: float, high: float, tolerance: float, relative: float) -> float:
    """Where a figure that changes its sign between two ends is zero, to `tolerance` + `relative` |x| in x.

    Brent (as above, ch. 4), in the steps of `scipy.optimize.brentq`, whose package takes longer to import than most
    figures take. Raises ValueError where the sign is the same at both ends.
    """
    before, x, other = low, high, 0.0  # the last place, the best, and one on the other side of the zero
    f_before, fx, f_other = figure(before), figure(x), 0.0
    if f_before == 0.0:
        return before
    if fx * f_before > 0.0:
        raise ValueError(f"the figure is {f_before:g} at {low!r} and {fx:g} at {high!r}: no zero is known between")
    step = last = 0.0
    for _ in range(MOST_STEPS):
        if fx != 0.0 and (f_before < 0.0) != (fx < 0.0):
            other, f_other, step = before, f_before, x - before
            last = step
        if abs(f_other) < abs(fx):
            before, x, other = x, other, x
            f_before, fx, f_other = fx, f_other, fx
        finest, half = 0.5 * (tolerance + relative * abs(x)), 0.5 * (other - x)
        if fx == 0.0 or abs(half) < finest:
            break
        tried = _by_line((x, fx), (before, f_before), (other, f_other)) if abs(last) > finest else None
        if tried is not None and 2.0 * abs(tried) < min(abs(last), 3.0 * abs(half) - finest):
            last, step = step, tried
        else:
            last = step = half
        before, f_before = x, fx
        x += step if abs(step) > finest else finest if half > 0.0 else -finest
        fx = figure(x)
    return x


def _by_line(best: Point, before: Point, other: Point) -> float | None:
    """The step to zero by a secant or an inverse parabola through three points; None where the best is no better."""
    (x, fx), (w, fw), (v, fv) = best, before, other
    if not abs(fx) < abs(fw):
        return None
    if w == v:
        return -fx * (x - w) / (fx - fw)
    to_before, to_other = (fw - fx) / (w - x), (fv - fx) / (v - x)
    return -fx * (fv * to_other - fw * to_before) / (to_other * to_before * (fv - fw))
