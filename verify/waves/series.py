"""Wave measures of a beam that moves in time: its phasors at the drive's frequency, then as of a field."""

import numpy as np

from verify.arrays import Array, ComplexArray
from verify.checks import check_number
from verify.errors import InputError, NoFigureError
from verify.linear.fields import wavenumber
from verify.linear.places import as_typed, in_a_row, places, real_array
from verify.linear.spline import natural_or_flat
from verify.problem.beam import Beam
from verify.waves.results import WaveMeasures
from verify.waves.two_waves import STILL, fit_waves, fitted_wavenumber, measures_of
from verify.waves.waveguide import Medium
from verify.waves.window import check_clear, stated_wavenumber


def check_series(times: Array, values: Array, frequency_hz: float) -> None:
    """Raise InputError for series that are empty, not finite, not ascending in time or sampled too slowly."""
    check_number("frequency_hz", frequency_hz, "hertz", above=0)
    if times.ndim != 1 or not len(times) or values.ndim != 2 or len(values) != len(times) or not values.shape[1]:
        raise InputError(
            f"times have the shape {times.shape} and values {values.shape}: give (n_times,) and (n_times, n_points), "
            "neither empty"
        )
    if not (np.isfinite(times).all() and np.isfinite(values).all() and (np.diff(times) > 0).all()):
        raise InputError("times and values have to be finite and times ascending: leave out what is not")
    step = float(times[-1] - times[0]) / max(len(times) - 1, 1)
    if len(times) > 1 and step * frequency_hz > 0.5 * (1.0 - 1e-9):
        raise InputError(
            f"times have {1.0 / (step * frequency_hz):.4g} samples in each period of frequency_hz = {frequency_hz!r}: "
            "give more than two"
        )


@as_typed
def phasors(times: Array, values: Array, frequency_hz: float) -> ComplexArray:
    """Complex amplitudes of series at one frequency, over the last whole number of periods, (n_points,).

    times (n_times,) ascending, values (n_times, n_points). A constant and a linear trend are fitted beside the
    harmonic and dropped. Raises InputError for less than one period, fewer than eight samples of it, two samples or
    fewer in each period, and for what is empty or not finite.
    """
    times, values = real_array("times", times, "seconds"), real_array("values", values, "metres")
    check_series(times, values, frequency_hz)
    step = (times[-1] - times[0]) / max(len(times) - 1, 1)
    periods = int(np.floor((times[-1] - times[0] + step) * frequency_hz * (1.0 + 1e-9)))
    kept = times > times[-1] - periods / frequency_hz + 0.5 * step * (1.0 - 1e-6)
    if periods < 1 or kept.sum() < 8:
        raise InputError(
            f"times cover {(times[-1] - times[0]) * frequency_hz:.2f} periods in {len(times)} samples: "
            "give at least one whole period and eight samples"
        )
    t = times[kept] - times[kept].mean()
    angle = 2.0 * np.pi * frequency_hz * times[kept]
    basis = np.column_stack([np.ones_like(t), t * frequency_hz, np.cos(angle), -np.sin(angle)])
    fitted = np.linalg.lstsq(basis, values[kept], rcond=None)[0]
    return np.asarray(fitted[2] + 1j * fitted[3])


@as_typed
def measure_series(
    beam: Beam, x: Array, times: Array, values: Array, frequency_hz: float, k: complex | None = None
) -> WaveMeasures:
    """The same measures from time series at positions x (ascending), values (n_times, n_positions), metres.

    Between the positions the field is that of a cubic spline through their phasors; slopes come from the two fitted
    waves. What drives or holds the beam between the positions is not known here, but for its masses and springs: a
    large `waves.residual` tells that two waves are not alone there. Raises InputError for series or spans that are too
    short, positions off the beam and a `k` that is no wavenumber, WindowError where the beam has a mass or a spring
    between the positions.
    """
    check_number("frequency_hz", frequency_hz, "hertz", above=0)
    start, x = wavenumber(beam, frequency_hz), places("x", in_a_row("x", x, "metres"), beam.length)
    if not (np.isfinite(x).all() and (np.diff(x) > 0).all() and np.shape(values)[1:] == x.shape):
        raise InputError("x has to be finite, ascending and as long as values are wide")
    if len(x) < 4 or (x[-1] - x[0]) * start.real < np.pi:
        raise InputError("x covers less than half a wavelength or four points: measure over a longer span")
    ends = (float(x[0]), float(x[-1]))
    check_clear(beam, ends, f"x from {ends[0]:.6g} to {ends[1]:.6g} m", "measure over a span")
    deflection = phasors(times, values, frequency_hz)
    if not abs(deflection).max() > STILL * abs(np.asarray(values)).max():
        raise NoFigureError(f"values do not move at frequency_hz = {frequency_hz!r}: there is no wave to measure")
    near = fitted_wavenumber(x, deflection, start) if k is None else stated_wavenumber("k", k, ends)
    waves = fit_waves(x, deflection, near)
    middle = 0.5 * (x[0] + x[-1])

    def slope(at: Array) -> ComplexArray:
        turn = np.exp(1j * waves.wavenumber * (at - middle))
        return np.asarray(1j * waves.wavenumber * (waves.backward * turn - waves.forward / turn))

    line = natural_or_flat(x, deflection[None], (0, 0))
    return measures_of(Medium(beam), 2.0 * np.pi * frequency_hz, x, x, lambda at: line(at)[0], slope, waves)
