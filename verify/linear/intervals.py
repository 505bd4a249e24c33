"""Means and extremes of a figure over an interval, free of the grid that they were found on."""

from collections.abc import Callable
from functools import cache, lru_cache

import msgspec
import numpy as np

from verify.arrays import Array, Indices

GAUSS = 12
"""Points of the quadrature in each part of an interval."""
CONVERGED, _DOUBLINGS = 1e-9, 3
"""A mean is taken over parts that are halved until it moves by this part of the largest value, or so often."""
_HILLS, _ZOOM, _DEPTH = 64, 17, 5
"""How many of the highest hills are looked at, by how many points, and how often more closely, eight times each."""


class Rule(msgspec.Struct, frozen=True, eq=False):
    """Points of an interval and their weights, which add up to 1."""

    x: Array
    weights: Array


@cache
def _legendre() -> tuple[Array, Array]:
    points, weights = np.polynomial.legendre.leggauss(GAUSS)
    return 0.5 * (points + 1.0), 0.5 * weights


@lru_cache(maxsize=64)
def rule_over(interval: tuple[float, float], parts: int) -> Rule:
    """Gauss-Legendre quadrature of an interval in equal parts, exact to rounding where each holds a period or less.

    Kept, so that its arrays are for reading alone.
    """
    points, weights = _legendre()
    edges = np.linspace(interval[0], interval[1], parts + 1)
    x = (edges[:-1, None] + np.diff(edges)[:, None] * points).ravel()
    each = np.tile(weights / parts, parts)
    x.flags.writeable = each.flags.writeable = False
    return Rule(x, each)


def mean_over(figure: Callable[[Array], Array], interval: tuple[float, float], parts: int) -> float:
    """The mean of a figure over an interval, to 1e-9 of its largest value if smooth over eighths of the parts."""
    before = float("nan")
    for _ in range(_DOUBLINGS + 1):
        rule = rule_over(interval, parts)
        values = figure(rule.x)
        mean = float(rule.weights @ values)
        if abs(mean - before) <= CONVERGED * float(abs(values).max()):
            break
        before, parts = mean, 2 * parts
    return mean


def whole_halves(window: tuple[float, float], k: float) -> tuple[tuple[float, float], int]:
    """(the middle part of a window that is a whole number of half wavelengths, the number); all of it if shorter."""
    number = int((window[1] - window[0]) * k / np.pi * (1.0 + 1e-12))
    if number < 1:
        return window, 1
    middle, half = 0.5 * (window[0] + window[1]), 0.5 * number * np.pi / k
    return (max(middle - half, window[0]), min(middle + half, window[1])), number


def extremes(figure: Callable[[Array], Array], x: Array) -> tuple[float, float]:
    """(least, largest) of a smooth figure over the span of x, which has to be fine enough to tell its hills apart.

    Every hill is looked at more closely, not the highest of the points alone.
    """
    values = figure(x)
    tops, bottoms = _tops(values), _tops(-values)
    hills, signs = np.concatenate([tops, bottoms]), np.repeat([1.0, -1.0], [len(tops), len(bottoms)])[:, None]
    low, high, rows = x[np.maximum(hills - 1, 0)], x[np.minimum(hills + 1, len(x) - 1)], np.arange(len(hills))
    steps = np.linspace(0.0, 1.0, _ZOOM)
    for _ in range(_DEPTH):
        at = low[:, None] + (high - low)[:, None] * steps
        best = (signs * figure(at.ravel()).reshape(at.shape)).argmax(axis=1)
        low, high = at[rows, np.maximum(best - 1, 0)], at[rows, np.minimum(best + 1, _ZOOM - 1)]
    found = np.concatenate([values, figure(0.5 * (low + high))])
    return float(found.min()), float(found.max())


def _tops(values: Array) -> Indices:
    """Where the highest hills are, ends included, (n,) of `_HILLS` at most."""
    padded = np.concatenate([[-np.inf], values, [-np.inf]])
    tops = np.flatnonzero((values >= padded[:-2]) & (values >= padded[2:]))
    return tops[np.argsort(values[tops])[-_HILLS:]]
