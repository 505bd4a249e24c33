"""Searches for zeros and least values, place by place those of scipy's."""

from collections.abc import Callable
from math import cos, exp, inf, sin, sqrt, tanh

import numpy as np

from verify.models.arrays import Array
from verify.stress.kind import Floor, Row
from verify.stress.largest import largest

Figure = Callable[[float], float]
ZEROS: tuple[tuple[Figure, float, float, float, float], ...] = (
    (lambda x: x**3 - 2.0 * x - 5.0, -1.0, 7.3, 1e-12, 1e-14),
    (lambda x: tanh(40.0 * (x - 0.3)), -2.0, 5.0, 1e-9, 1e-15),
    (lambda x: exp(x) - 2.0, 3.0, -4.0, 1e-13, 4e-15),
    (lambda x: cos(x) * (exp(x) + exp(-x)) / 2.0 + 1.0, 4.0, 5.5, 1e-12, 1e-13),
    (lambda x: (x - 0.7) ** 9, -3.0, 1.1, 1e-5, 1e-8),
    (lambda x: 1.0 if x > 0.123 else -1e-9, -0.9, 1.0, 1e-7, 1e-9),
    (lambda x: 1e6 * (x + 1.3e-5), -2.0, 0.7, 1e-15, 1e-13),
    (lambda x: sqrt(x) - 1e-4, 0.0, 3.0, 1e-14, 1e-14),
    (lambda x: x - 0.25, 0.25, 1.0, 1e-9, 1e-9),
    (lambda x: x - 0.25, -1.0, 0.25, 1e-9, 1e-9),
    (lambda x: 1.0 / (x - 30.0) + 0.1, -20.0, 29.0, 0.3, 1e-3),
    (lambda x: sin(x) + 0.2 * sin(31.0 * x), 2.0, 4.4, 1e-11, 1e-12),
)
"""A figure, between which ends, to which tolerances."""
LEAST: tuple[tuple[Figure, float, float, float], ...] = (
    (lambda x: (x - 0.3) ** 2 + 0.1 * x**4, -1.0, 2.0, 1e-7),
    (lambda x: abs(x - 0.77), -1.0, 2.0, 1e-6),
    (lambda x: -exp(-((x - 4.1) ** 2)), 0.0, 9.0, 1e-8),
    (lambda x: x, 0.2, 1.0, 1e-5),
    (lambda x: -x, 0.2, 1.0, 1e-5),
    (lambda x: sin(3.0 * x) + 0.1 * x, -2.0, 5.0, 1e-9),
    (lambda x: (x + 200.0) ** 4, -900.0, 31.0, 1e-3),
    (lambda x: 1.0, 0.0, 1.0, 1e-4),
    (lambda x: abs(x) ** 0.4 + 0.01 * cos(40.0 * x), -0.7, 1.1, 1e-6),
    (lambda x: max(0.0, x - 0.4) - 0.001 * x, -1.0, 2.0, 1e-6),
)
KNOWN: tuple[tuple[Figure, float, float, float, int], ...] = (
    (lambda x: 3.0 * (x - 0.31) ** 2 + 0.2, 0.0, 1.0, 1e-8, 4),
    (lambda x: (x - 0.62) ** 2 * (1.0 + 0.3 * x), 0.0, 1.0, 1e-9, 9),
    (lambda x: 1.0 - cos(x - 0.45), 0.0, 1.0, 1e-7, 7),
)
"""Besides, how often it is asked where three points are known."""


def _listening(figure: Figure) -> tuple[Figure, list[float]]:
    heard: list[float] = []

    def told(x: float) -> float:
        heard.append(float(x))
        return figure(x)

    return told, heard


def zeros_error(number: float) -> float:
    """How far the places where a zero is sought stand from those of brentq, over the larger of both ends."""
    from scipy.optimize import brentq

    from verify.models.search import zero_between

    worst = 0.0
    for figure, low, high, tolerance, relative in ZEROS:
        own, mine = _listening(figure)
        other, theirs = _listening(figure)
        found = zero_between(own, low, high, tolerance, relative)
        exact = brentq(other, low, high, xtol=tolerance, rtol=relative, maxiter=500)
        worst = largest(worst, _apart([*mine, found], [*theirs, exact]) / max(abs(low), abs(high)))
    try:
        zero_between(lambda x: x * x + 1.0, -1.0, 3.0, 1e-6, 1e-6)
    except ValueError as error:
        return worst if "the figure is 2 at -1.0 and 10 at 3.0" in str(error) else 1.0
    return 1.0


def _apart(one: list[float], other: list[float]) -> float:
    return float(largest(abs(a - b) for a, b in zip(one, other, strict=True))) if len(one) == len(other) else inf


def least_error(number: float) -> float:
    """The same of a least value and scipy's bounded search; from known points its place, and how often it asks."""
    from scipy.optimize import minimize_scalar

    from verify.models.search import least_between

    worst = 0.0
    for figure, low, high, tolerance in LEAST:
        own, mine = _listening(figure)
        other, theirs = _listening(figure)
        x, value = least_between(own, low, high, tolerance)
        exact = minimize_scalar(other, bounds=(low, high), method="bounded", options={"xatol": tolerance})
        worst = largest(worst, _apart([*mine, x, value], [*theirs, float(exact.x), float(exact.fun)]) / (high - low))
    for figure, low, high, tolerance, most in KNOWN:
        own, mine = _listening(figure)
        given = [(at, figure(at)) for at in (low, 0.4, high)]
        x, value = least_between(own, low, high, tolerance, given)
        near = minimize_scalar(figure, bounds=(low, high), method="bounded", options={"xatol": 1e-12})
        wrong = not abs(x - near.x) <= 3.0 * tolerance + 3e-8 or value != figure(x) or len(mine) != most
        worst = largest(worst, float(wrong))
    return largest(worst, _gridded())


def _gridded() -> float:
    """Of a corner on a grid, inside it and at its edge."""
    from verify.models.search import least_over

    grid, wrong = np.linspace(2.0, 3.0, 11), False
    for at, value, edge in ((2.341, 0.0, False), (2.0, 0.0, True), (3.1, 0.1, True), (2.0011, 0.0, False)):

        def corner(x: Array, at: float = at) -> Array:
            return np.asarray(abs(x - at))

        found = least_over(corner, grid, 1e-10)
        wrong |= (
            not abs(found.x - min(at, 3.0)) <= 1e-8 or not abs(found.value - value) <= 1e-8 or found.at_edge is not edge
        )
    return float(wrong)


ROWS: tuple[Row, ...] = (
    Floor(
        id="zeros-step-by-step",
        title="Zeros between two ends, every place that is tried, against scipy's brentq",
        why="models/search.py: in the steps of `scipy.optimize.brentq`.",
        along="1",
        at=(1.0,),
        promise=1e-12,
        error=zeros_error,
    ),
    Floor(
        id="least-values-step-by-step",
        title="Least values between two ends, every place that is tried, against scipy's bounded search",
        why="models/search.py: as `scipy.optimize.minimize_scalar(method='bounded')` has it, step by step.",
        along="1",
        at=(1.0,),
        promise=1e-12,
        error=least_error,
    ),
)
