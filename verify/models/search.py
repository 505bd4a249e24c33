"""The least of a figure over an interval: the best of a grid, then Brent's method around it."""

from collections.abc import Callable

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
    """The least value of `figure`, which maps (n,) to (n,), on an ascending grid, to `tolerance` in x."""
    from scipy.optimize import minimize_scalar

    values = figure(grid)
    least = int(np.argmin(values))
    around = grid[max(least - 1, 0)], grid[min(least + 1, len(grid) - 1)]
    found = minimize_scalar(
        lambda x: float(figure(np.array([x]))[0]), bounds=around, method="bounded", options={"xatol": tolerance}
    )
    x, value = (found.x, found.fun) if found.fun <= values[least] else (grid[least], values[least])
    distance = min(x - grid[0], grid[-1] - x)
    return Least(x=float(x), value=float(value), at_edge=bool(distance < 0.01 * (grid[1] - grid[0])))
