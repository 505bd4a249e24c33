"""Prescribed motion in the plane of the base that carries a beam."""

from collections.abc import Callable
from dataclasses import dataclass
from functools import partial
from typing import TypeAlias

import numpy as np

from verify.arrays import Array
from verify.errors import InputError, shown

Prescribed: TypeAlias = Callable[[float], tuple[float, float, float]]
"""Value, first and second derivative at a time, s."""
KNOTS = 1024  # of a table over a run; quintic pieces between err by (duration/1024)^6 / 46000 of the sixth derivative


def still(time: float) -> tuple[float, float, float]:
    """No motion."""
    return 0.0, 0.0, 0.0


def _power_series(coefficients: tuple[float, ...], time: float) -> tuple[float, float, float]:
    series = np.polynomial.Polynomial(coefficients)
    return float(series(time)), float(series.deriv()(time)), float(series.deriv(2)(time))


def polynomial(*coefficients: float) -> Prescribed:
    """Motion c_0 + c_1 t + c_2 t^2 + ..."""
    return partial(_power_series, coefficients)


def tabulated(times: Array, values: Array) -> Prescribed:
    """Motion through a table by a spline of degree 5, with the rate at the last time kept after it.

    Raises InputError for fewer than six rows and for times that do not ascend.
    """
    from scipy.interpolate import make_interp_spline

    at = np.asarray(times, dtype=float)
    if len(at) < 6 or not (np.diff(at) > 0.0).all():
        raise InputError(f"times = {shown(times)}: give six ascending times or more")
    spline = make_interp_spline(at, np.asarray(values, dtype=float), k=5)
    rates = spline, spline.derivative(), spline.derivative(2)

    def motion(time: float) -> tuple[float, float, float]:
        value, rate, acceleration = (float(figure(min(time, at[-1]))) for figure in rates)
        late = max(time - float(at[-1]), 0.0)
        return value + late * rate, rate, 0.0 if late else acceleration

    return motion


@dataclass(frozen=True, kw_only=True)
class Base:
    """Prescribed motion of the base; the beam starts at `hub_radius` from the axis of its rotation, m."""

    rotation: Prescribed = still
    """Angle, rad, rate, acceleration."""
    x: Prescribed = still
    """Coordinate of the axis along the beam at angle 0, m."""
    y: Prescribed = still
    """Coordinate of the axis across it, m."""
    hub_radius: float = 0.0

    def table(self, duration: float) -> Array:
        """Pieces of equal duration, (KNOTS, 14), for compiled code.

        Powers 0 to 5 of the angle, 0 to 3 of the axis's accelerations along x and y, of the time since the piece began.
        """
        from scipy.interpolate import BPoly, CubicSpline, PPoly

        at = np.linspace(0.0, duration, KNOTS + 1)
        rotation, x, y = (np.array([motion(t) for t in at.tolist()]) for motion in (self.rotation, self.x, self.y))
        angle = PPoly.from_bernstein_basis(BPoly.from_derivatives(at, rotation)).c[::-1]
        return np.concatenate([angle, *(CubicSpline(at, axis[:, 2]).c[::-1] for axis in (x, y))]).T.copy()


FIXED = Base()
"""A base that does not move."""
