"""The least of a size over an interval, and a zero between two ends."""

from collections.abc import Callable
from math import sqrt

import msgspec
import numpy as np

from verify.arrays import Array


class Least(msgspec.Struct, frozen=True, kw_only=True):
    """Where a figure is least."""

    x: float
    value: float
    at_edge: bool
    """Whether it still falls at an end of the interval: then this is where the search ends, not a minimum."""


def least_over(figure: Callable[[Array], Array], grid: Array, tolerance: float) -> Least:
    """The least value of `figure`, which maps (n,) to (n,) and is never negative, on an ascending grid.

    To `tolerance` in x. The square is searched: a size that falls to nothing has a corner there, its square is a
    parabola. Distances are from the grid's best, in which no digits are lost to the size of x.
    """
    from scipy.optimize import minimize_scalar

    values = figure(grid)
    least = int(np.argmin(values))
    best, low, high = (float(grid[i]) for i in (least, max(least - 1, 0), min(least + 1, len(grid) - 1)))
    found = minimize_scalar(
        lambda step: float(figure(np.array([best + step]))[0]) ** 2,
        bounds=(low - best, high - best),
        method="bounded",
        options={"xatol": tolerance},
    )
    x, value = (best + found.x, sqrt(found.fun)) if found.fun < values[least] ** 2 else (best, float(values[least]))
    distance = min(x - grid[0], grid[-1] - x)
    return Least(x=float(x), value=value, at_edge=bool(distance < 0.01 * (grid[1] - grid[0])))


def zero_between(figure: Callable[[float], float], low: float, high: float, tolerance: float, relative: float) -> float:
    """Where a figure that changes its sign between two ends is zero, to `tolerance` + `relative` |x| in x.

    Raises ValueError where the sign is the same at both ends.
    """
    from scipy.optimize import brentq

    return float(brentq(figure, low, high, xtol=tolerance, rtol=relative))
