"""Means and extremes of a function over an interval, independent of the grid."""

from collections.abc import Callable
from typing import NamedTuple

import numpy as np

from verify.arrays import Array


class Rule(NamedTuple):
    """Points of an interval and their weights, whose sum is 1."""

    x: Array
    weights: Array


def gauss_rule(interval: tuple[float, float], parts: int) -> Rule:
    """12-point Gauss quadrature of an interval in equal parts, exact to rounding for at most one period per part."""
    points, weights = np.polynomial.legendre.leggauss(12)
    edges = np.linspace(*interval, parts + 1)
    x = edges[:-1, None] + np.diff(edges)[:, None] * 0.5 * (points + 1.0)
    return Rule(x.ravel(), np.tile(0.5 * weights / parts, parts))


def mean_over(function: Callable[[Array], Array], interval: tuple[float, float], parts: int) -> float:
    """Mean over an interval, to 1e-9 of the largest value for functions that are smooth over an eighth of a part."""
    before = mean = float("nan")
    for doubling in range(4):
        x, weights = gauss_rule(interval, parts * 2**doubling)
        values = function(x)
        before, mean = mean, float(weights @ values)
        if abs(mean - before) <= 1e-9 * float(abs(values).max()):
            break
    return mean


def whole_halves(window: tuple[float, float], k: float) -> tuple[tuple[float, float], int]:
    """(centred part of a window with an integer number of half wavelengths, the number); the window if shorter."""
    number = int((window[1] - window[0]) * k / np.pi * (1.0 + 1e-12))
    if number < 1:
        return window, 1
    middle, half = 0.5 * (window[0] + window[1]), 0.5 * number * np.pi / k
    return (max(middle - half, window[0]), min(middle + half, window[1])), number


def extremes(function: Callable[[Array], Array], x: Array) -> tuple[float, float]:
    """(least, largest) value of a smooth function over the span of x, which has to resolve its 64 highest maxima."""
    values = function(x)
    samples = [values]
    for sign in (1.0, -1.0):
        padded = np.concatenate([[-np.inf], sign * values, [-np.inf]])
        tops = np.flatnonzero((padded[1:-1] >= padded[:-2]) & (padded[1:-1] >= padded[2:]))
        tops = tops[np.argsort(sign * values[tops])[-64:]]
        low, high = x[np.maximum(tops - 1, 0)], x[np.minimum(tops + 1, len(x) - 1)]
        for _ in range(5):  # eight times closer each
            at = low[:, None] + (high - low)[:, None] * np.linspace(0.0, 1.0, 17)
            best, rows = (sign * function(at.ravel())).reshape(at.shape).argmax(axis=1), np.arange(len(tops))
            low, high = at[rows, np.maximum(best - 1, 0)], at[rows, np.minimum(best + 1, 16)]
        samples.append(function(0.5 * (low + high)))
    both = np.concatenate(samples)
    return float(both.min()), float(both.max())


def zeros(shape: Callable[[Array], Array], length: float, mode: int) -> Array:
    """Zeros of a shape between the ends of the beam, (n_zeros,), m, ascending.

    `shape` takes (n,) positions. Sampled 40 times per mode number, then Brent's method.
    """
    from scipy.optimize import brentq

    margin = 1e-4 / mode  # zeros at the ends are supports, not nodes
    x = np.linspace(margin * length, (1.0 - margin) * length, 40 * mode + 1)
    positive = shape(x) >= 0
    changes = np.flatnonzero(positive[:-1] != positive[1:])

    def at(position: float) -> float:
        return float(shape(np.array([position]))[0])

    return np.array([brentq(at, x[i], x[i + 1], xtol=1e-14 * length, rtol=1e-14) for i in changes])
