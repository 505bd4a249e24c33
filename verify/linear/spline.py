"""Cubic C2 splines through a value at every node."""

from typing import Any, TypeAlias

from verify.arrays import Array

Ends: TypeAlias = tuple[int, int]
"""Which derivative is zero at the left and the right end: 1 or 2; 0 where the last two pieces are one cubic."""
_CONDITIONS = ("not-a-knot", "clamped", "natural")


def natural_or_flat(nodes: Array, values: Any, ends: Ends) -> Any:
    """Scipy's CubicSpline through values (k, N + 1), real or complex: (x, derivative) -> (k, len(x)).

    Where the last two pieces are one cubic, one piece alone is straight there, and two at both ends are one parabola.
    """
    from scipy.interpolate import CubicSpline

    return CubicSpline(nodes, values, axis=1, bc_type=tuple(_CONDITIONS[order] for order in ends))
