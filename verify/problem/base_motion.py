"""Prescribed motion in the plane of the base that carries a beam."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import partial
from typing import TYPE_CHECKING, TypeAlias

import numpy as np

from verify.arrays import Array
from verify.errors import InputError, shown
from verify.validation import check_number, convert

if TYPE_CHECKING:
    from scipy.interpolate import PPoly

Prescribed: TypeAlias = Callable[[float], tuple[float, float, float]]
"""Value, first and second derivative at a time, s."""
PIECES = (2**10, 2**12, 2**14)
"""Of a table over a run, more where the middles of fewer are off by `OFF`, relative: an error that falls as h^4."""
OFF = 1e-8


def still(time: float) -> tuple[float, float, float]:
    """No motion."""
    return 0.0, 0.0, 0.0


def _power_series(coefficients: tuple[float, ...], time: float) -> tuple[float, float, float]:
    value = rate = half = 0.0
    for coefficient in reversed(coefficients):
        half, rate, value = half * time + rate, rate * time + value, value * time + coefficient
    return value, rate, 2.0 * half


def polynomial(*coefficients: float) -> Prescribed:
    """Motion c_0 + c_1 t + c_2 t^2 + ..., t in s, rad or m. Raises InputError for numbers that are not finite."""
    for coefficient in coefficients:
        check_number("coefficients", coefficient, "rad or m over s^n")
    return partial(_power_series, tuple(map(float, coefficients)))


def tabulated(times: Sequence[float] | Array, values: Sequence[float] | Array) -> Prescribed:
    """Motion through values (n,), rad or m, at times (n,), s, by a spline of degree 5; then on at its last rate.

    Raises InputError for fewer than six rows, a value that is not finite, and times that do not ascend from 0.
    """
    from scipy.interpolate import make_interp_spline

    at, through = (
        np.array(convert(np.asarray(row).tolist(), tuple[float, ...], name))
        for name, row in (("times", times), ("values", values))
    )
    if len(at) < 6 or not (np.diff(at) > 0.0).all() or at[0] > 0.0:
        raise InputError(f"times = {shown(times)}: give six ascending times or more, the first 0")
    if len(through) != len(at) or not np.isfinite(through).all():
        raise InputError(f"values = {shown(values)}: give a finite number for each of the {len(at)} times")
    spline = make_interp_spline(at, through, k=5)
    rates = spline, spline.derivative(), spline.derivative(2)

    def motion(time: float) -> tuple[float, float, float]:
        value, rate, acceleration = (float(figure(min(time, at[-1]))) for figure in rates)
        late = max(time - float(at[-1]), 0.0)
        return value + late * rate, rate, 0.0 if late else acceleration

    return motion


@dataclass(frozen=True, kw_only=True)
class Base:
    """Prescribed motion of the base; the beam starts at `hub_radius` from the axis of its rotation.

    A motion is a function of the time, s, that returns value, rate and acceleration: `polynomial`, `tabulated`, your
    own. Raises InputError for a negative radius.
    """

    rotation: Prescribed = still
    """Angle, rad."""
    x: Prescribed = still
    """Coordinate of the axis along the beam at angle 0, m."""
    y: Prescribed = still
    """Coordinate of the axis across it, m."""
    hub_radius: float = 0.0
    """m."""

    def __post_init__(self) -> None:
        check_number("base.hub_radius", self.hub_radius, "m", at_least=0)

    @property
    def moves(self) -> bool:
        """Whether any of the three motions is prescribed."""
        return any(motion is not still for motion in (self.rotation, self.x, self.y))

    def table(self, duration: float) -> Array:
        """Pieces of equal duration, (n, 14), for compiled code; n of `PIECES` by the smoothness of the motion.

        Powers 0 to 5 of the angle, 0 to 3 of the axis's accelerations along x and y, of the time since the piece began.
        """
        from scipy.interpolate import CubicSpline

        for pieces in PIECES:
            at = np.linspace(0.0, duration, 2 * pieces + 1)
            motions = [
                np.zeros((len(at), 3)) if motion is still else np.array([motion(t) for t in at.tolist()])
                for motion in (self.rotation, self.x, self.y)
            ]
            angle = quintic(at[::2], motions[0][::2])
            along, across = (CubicSpline(at[::2], motion[::2, 2]) for motion in motions[1:])
            exact = motions[0][:, 1], motions[1][:, 2], motions[2][:, 2]
            curves = zip((angle.derivative(), along, across), exact, strict=True)
            if all(abs(curve(at) - true).max() <= OFF * abs(true).max() for curve, true in curves):
                break
        return np.concatenate([curve.c[::-1] for curve in (angle, along, across)]).T.copy()


def quintic(times: Array, rows: Array) -> "PPoly":
    """The piecewise polynomial of degree 5 through values, first and second derivatives (n, 3) at even times (n,)."""
    from scipy.interpolate import PPoly

    h, (value, rate, turn) = times[1] - times[0], rows[:-1].T
    d = rows[1:, 0] - value - h * rate - 0.5 * h**2 * turn
    e, f = h * (rows[1:, 1] - rate - h * turn), h**2 * (rows[1:, 2] - turn)
    high = (6 * d - 3 * e + f / 2) / h**5, (7 * e - 15 * d - f) / h**4, (10 * d - 4 * e + f / 2) / h**3
    return PPoly(np.stack([*high, 0.5 * turn, rate, value]), times)


FIXED = Base()  # A base that does not move
