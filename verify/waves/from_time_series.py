"""Phasors of time series at the drive's frequency."""

import numpy as np

from verify.arrays import Array, ComplexArray
from verify.errors import InputError
from verify.linear.positions import real_array
from verify.validation import check_number


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
