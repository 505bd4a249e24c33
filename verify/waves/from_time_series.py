"""Phasors of time series at the drive's frequency, and the field between the points at which they were measured."""

from collections.abc import Callable

import numpy as np

from verify.arrays import Array, ComplexArray
from verify.errors import InputError, NoFigureError
from verify.linear.field import wavenumber
from verify.linear.positions import positions_on, real_array
from verify.problem.beam import Beam
from verify.validation import check_number
from verify.waves.two_waves import ROUNDING, TwoWaves, fit_waves, fitted_wavenumber
from verify.waves.window import check_clear, check_wavenumber


def phasors(times: Array, values: Array, frequency_hz: float) -> ComplexArray:
    """Complex amplitudes of series at one frequency, over the last whole number of periods, (n_points,).

    times (n_times,) ascending, s; values (n_times, n_points). A constant and a linear trend are fitted as well. Raises
    InputError for less than one period, fewer than eight samples of it, two or fewer in each period, and for what is
    empty, not finite or not ascending.
    """
    check_number("frequency_hz", frequency_hz, "hertz", above=0)
    t, values = real_array("times", times, "seconds"), real_array("values", values, "metres")
    if t.ndim != 1 or values.ndim != 2 or len(values) != len(t) or not values.size:
        raise InputError(f"times, {t.shape}, and values, {values.shape}: give (n_times,) and (n_times, n_points)")
    if not (np.isfinite(t).all() and np.isfinite(values).all() and (np.diff(t) > 0).all()):
        raise InputError("times and values have to be finite and times ascending: leave out what is not")
    step = float(t[-1] - t[0]) / max(len(t) - 1, 1)
    if step * frequency_hz > 0.5 * (1.0 - 1e-9):
        raise InputError(f"times have {1.0 / (step * frequency_hz):.4g} samples in each period: give more than two")
    # the last sample stands for a step of its own, so that n samples of a period cover it
    periods = int(np.floor((t[-1] - t[0] + step) * frequency_hz * (1.0 + 1e-9)))
    used = t > t[-1] - periods / frequency_hz + 0.5 * step * (1.0 - 1e-6)
    if periods < 1 or used.sum() < 8:
        raise InputError(
            f"times cover {(t[-1] - t[0]) * frequency_hz:.2f} periods in {len(t)} samples: give at least one whole "
            "period and eight samples"
        )
    angle, trend = 2.0 * np.pi * frequency_hz * t[used], (t[used] - t[used].mean()) * frequency_hz
    basis = np.column_stack([np.ones_like(trend), trend, np.cos(angle), -np.sin(angle)])
    fitted = np.linalg.lstsq(basis, values[used], rcond=None)[0]
    return np.asarray(fitted[2] + 1j * fitted[3])


def field_of_series(
    beam: Beam, x: Array, times: Array, values: Array, frequency_hz: float, k: complex | None
) -> tuple[Callable[[Array], ComplexArray], TwoWaves]:
    """(deflection at any x, m, by a cubic spline through the phasors; the two waves) of series at positions x."""
    from scipy.interpolate import CubicSpline

    check_number("frequency_hz", frequency_hz, "hertz", above=0)
    x = positions_on("x", x, beam.length)
    if not (x.ndim == 1 and np.isfinite(x).all() and (np.diff(x) > 0).all() and np.shape(values)[1:] == x.shape):
        raise InputError("x has to be finite, ascending and as long as values are wide")
    own = wavenumber(beam, frequency_hz)
    if len(x) < 4 or (x[-1] - x[0]) * own.real < np.pi:
        raise InputError("x covers less than half a wavelength or four points: measure over a longer span")
    span = (float(x[0]), float(x[-1]))
    check_clear(beam, span, f"x from {span[0]:.6g} to {span[1]:.6g} m")
    deflection = phasors(times, values, frequency_hz)
    if not abs(deflection).max() > ROUNDING * abs(np.asarray(values)).max():
        raise NoFigureError(f"values do not move at frequency_hz = {frequency_hz!r}: there is no wave to measure")
    k = fitted_wavenumber(x, deflection, own) if k is None else check_wavenumber("k", k, span)
    return CubicSpline(x, deflection), fit_waves(x, deflection, k)
