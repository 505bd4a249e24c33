"""The travelling wave on a driven beam, the principle of the motor (Section I of the paper), and its measures.

Two actuators in quadrature (Section III: 4276 Hz, d = 11.6 mm from both ends) drive the deflection
Re(w(x) e^{i omega t}). Between them, away from near fields,

    w = A+ e^{-ik(x - m)} + A- e^{+ik(x - m)}

with m the middle of a window: a wave towards +x and a wave towards -x, which `measure` fits. With the reflection
Gamma = |weaker| / |stronger| the standing-wave ratio is (1 + Gamma) / (1 - Gamma): 1 for a travelling wave, infinite
for a standing wave.

A point of the surface, h/2 above the neutral line, moves by u_x = -(h/2) psi and u_y = w, where psi is the rotation of
the section (w' without shear), on the elliptic path of the paper's introduction. Its Stokes parameters are
S0 = |u_x|^2 + |u_y|^2 and S3 = 2 Im(conj(u_x) u_y), the area of the ellipse being pi/2 |S3|; the axis ratio is tan chi
with sin 2 chi = S3 / S0. A wave towards +x has S3 < 0: points move counter-clockwise, backwards at the crests, where
they are in contact with a slider, which therefore moves against the wave.

    field = ExactModel(beam).harmonic(forces, 4276.0)
    measure(field, middle_half(beam)).standing_wave_ratio
"""

from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from verify.arrays import Array, ComplexArray
from verify.errors import InputError, NoFigureError
from verify.formatting import one_line
from verify.linear.field import HarmonicField, phasor, wavenumber
from verify.linear.numerics import extremes, gauss_rule, mean_over, whole_halves
from verify.linear.positions import Numbers, positions_on, real_array
from verify.linear.surface import surface_distance_at
from verify.problem.beam import Beam, check_features
from verify.validation import check_number
from verify.waves.best_drive import BestDrive, best_drive
from verify.waves.driven_case import DrivenCase
from verify.waves.impedance_matching import matched_device
from verify.waves.operating_point import OperatingPoint, best_frequency, maximum_crest_speed
from verify.waves.two_waves import ROUNDING, TwoWaves, Waveguide, fit_waves, fitted_wavenumber, two_waves
from verify.waves.window import Window, check_clear, check_wavenumber, middle_half

__all__ = ["BestDrive", "DrivenCase", "OperatingPoint", "TwoWaves", "WaveMeasures", "axis_ratio", "best_drive"]
__all__ += ["best_frequency", "ellipse", "fit_waves", "matched_device", "maximum_crest_speed", "measure"]
__all__ += ["measure_series", "middle_half", "phasors", "surface_motion", "two_waves"]
POINTS_PER_HALF_WAVE = 24
"""Points per half wavelength for tables of surface quantities and as start of the search for extremes."""
POINTS_PER_PART = 8  # points per segment or element in the search for extremes: a discrete field ripples at that length


@dataclass(frozen=True, eq=False, kw_only=True)
class WaveMeasures:
    """The wave in a window of a field and the motion of the surface; properties are computed on first use."""

    guide: Waveguide
    omega: float
    window: Window
    """m."""
    waves: TwoWaves
    """The forward and the backward wave fitted in the window."""
    deflection: Callable[[Array], ComplexArray]
    """w at any x of the window, m."""
    section_rotation: Callable[[Array], ComplexArray]
    """psi at any x of the window, rad."""
    x: Array
    """(n,), m: 24 points per half wavelength of the exact beam, or the positions of a time series."""
    fine: Array
    """(m,), m: positions that separate the extremes of the field."""
    field: HarmonicField | None = None
    """The field in which the wave is; None of a time series."""
    __repr__ = one_line(window="m", reflection="", standing_wave_ratio="")

    @property
    def reflection(self) -> float:
        """Gamma, the weaker wave over the stronger, 0 to 1."""
        return self.waves.reflection

    @property
    def standing_wave_ratio(self) -> float:
        """(1 + Gamma) / (1 - Gamma), from 1 to infinity."""
        return self.waves.standing_wave_ratio

    @cached_property
    def travelling_index(self) -> float:
        """1 / cond of [Re w, Im w] in the mean square, 0 to 1 (Feeny, J. Sound Vib. 310 (2008) 77).

        Over the largest whole number of half wavelengths in the middle of the window; for two waves it equals
        (1 - Gamma) / (1 + Gamma).
        """
        whole, halves = whole_halves(self.window, self.waves.wavenumber.real)
        rule = gauss_rule(whole, 2 * halves)
        w = self.deflection(rule.x)
        values = np.linalg.svd(np.stack([w.real, w.imag]) * np.sqrt(rule.weights), compute_uv=False)
        return float(values[1] / values[0]) if values[0] > 0 else 0.0

    @cached_property
    def ellipses(self) -> tuple[Array, Array, Array]:
        """(signed axis ratio, tilt in degrees, Stokes parameter S3 in m^2) of the surface paths at `x`, (n,) arrays."""
        return self._ellipse(self.x)

    def _ellipse(self, x: Array) -> tuple[Array, Array, Array]:
        return ellipse(-self.guide.beam.surface_distance * self.section_rotation(x), self.deflection(x))

    @cached_property
    def mean_axis_ratio(self) -> float:
        """Mean signed axis ratio over whole half wavelengths; -+ `Waveguide.axis_ratio` in the limit kh -> 0.

        1/|w|^2 has the mean 1/||A+|^2 - |A-|^2| over half a wavelength, and S3 is constant.
        """
        whole, halves = whole_halves(self.window, self.waves.wavenumber.real)
        return mean_over(lambda x: self._ellipse(x)[0], whole, 2 * halves)

    @cached_property
    def s3_range(self) -> tuple[float, float, float]:
        """(least, mean, largest) Stokes parameter S3 over the window, m^2."""
        halves = whole_halves(self.window, self.waves.wavenumber.real)[1]
        low, high = extremes(lambda x: self._ellipse(x)[2], self.fine)
        return low, mean_over(lambda x: self._ellipse(x)[2], self.window, 2 * halves), high

    @property
    def signed_area_spread(self) -> float:
        """(max - min) / |mean| of S3, or of the signed area of the ellipses; 0 for undamped waves without near fields.

        In such waves S3 is proportional to the constant energy flux. Raises NoFigureError for a standing wave.
        """
        self.waves.check_travelling()
        least, mean, largest = self.s3_range
        return (largest - least) / abs(mean)

    @cached_property
    def crest_speed(self) -> float:
        """Velocity of the surface along +x at the crests, m/s; negative for a wave towards +x."""
        waves = self.waves
        return float(self.guide.crest_speed(self.omega, waves.wavenumber, waves.forward, waves.backward))

    @cached_property
    def energy_flux(self) -> float:
        """Power transmitted towards +x through the middle of the window, W: `Waveguide.energy_flux`."""
        waves = self.waves
        return float(self.guide.energy_flux(self.omega, waves.wavenumber, waves.forward, waves.backward))

    @cached_property
    def power_imbalance(self) -> float:
        """(power of the forces left of the window - losses up to its middle - flux through it) over that flux.

        The loss factor acts on bending, EI |psi'|^2, and shear, kappa G A |w' - psi|^2. Raises NoFigureError for a
        standing wave, and InputError for a time series, a beam with sections and devices against rotation.
        """
        field, beam, middle = self.field, self.guide.beam, 0.5 * sum(self.window)
        if field is None:
            raise InputError(
                "a power balance needs the forces of a field, which a time series does not have: measure one"
            )
        if field.couples:
            raise InputError(
                f"device.position = {field.couples[0]!r}: a power balance models no device against rotation, leave it "
                "out"
            )
        check_features(beam, "a power balance", ("attached", "tension", "foundation"))
        self.waves.check_travelling()
        left = [force for force in field.forces if force.position <= self.window[0]]
        speeds = 1j * field.omega * field.deflection([force.position for force in left])
        power = sum(0.5 * (phasor(f) * np.conj(v)).real for f, v in zip(left, speeds, strict=True))
        # the third derivative jumps at a force, the second at a couple: quadrature between the jumps
        jumps = [force.position for force in field.forces] + [attachment.position for attachment in beam.attached]
        cells = np.linspace(0.0, middle, max(int(middle * field.wavenumber.real), 8))
        edges = np.unique([*cells, *(x for x in jumps if x < middle)])
        points, weights = np.polynomial.legendre.leggauss(8)
        half = 0.5 * np.diff(edges)[:, None]
        x, weights = (edges[:-1, None] + half * (points + 1.0)).ravel(), (half * weights).ravel()
        lost = beam.bending_stiffness * float(abs(field.rotations(x, 1)) ** 2 @ weights)
        if field.theory == "timoshenko" and beam.base_section.shear_stiffness is not None:
            shear = abs(field.slope(x) - field.rotation(x)) ** 2
            lost += beam.base_section.shear_stiffness * float(shear @ weights)
        return float((power - 0.5 * field.omega * beam.loss_factor * lost) / self.energy_flux - 1.0)


def measure(field: HarmonicField, window: Window, wave_number: complex | None = None) -> WaveMeasures:
    """The wave of a field in a window (a, b) between the forces, m.

    The wavenumber (1/m, complex for a damped wave) is fitted by default. Raises InputError for a window that is not
    between two neighbouring forces, contains a device or an attachment, or is shorter than half a wavelength, for a
    field that is zero in the window, and for a fit that ends at the edge of its search.
    """
    waves = two_waves(field, window, wave_number)
    start, end = map(float, window)
    n = int(np.ceil(POINTS_PER_HALF_WAVE * (end - start) * field.wavenumber.real / np.pi)) + 1
    n_fine = int(POINTS_PER_PART * (field.count or 0) * (end - start) / field.beam.length) + 1
    return WaveMeasures(
        guide=Waveguide(field.beam, field.theory),
        omega=field.omega,
        window=(start, end),
        waves=waves,
        deflection=field.deflection,
        section_rotation=field.rotation,
        x=np.linspace(start, end, n),
        fine=np.linspace(start, end, max(n, n_fine)),
        field=field,
    )


def phasors(times: Array, values: Array, frequency_hz: float) -> ComplexArray:
    """Complex amplitudes (n_points,) of series at one frequency over the last whole number of periods.

    times (n_times,) ascending, s; values (n_times, n_points). A constant and a linear trend are fitted as well. Raises
    InputError for less than one period, fewer than eight samples, two samples or fewer in a period (Nyquist), and for
    arrays that are empty, not finite or not ascending.
    """
    check_number("frequency_hz", frequency_hz, "hertz", above=0)
    t, values = real_array("times", times, "seconds"), real_array("values", values, "metres")
    if t.ndim != 1 or values.ndim != 2 or len(values) != len(t) or not values.size:
        raise InputError(f"times, {t.shape}, and values, {values.shape}: give (n_times,) and (n_times, n_points)")
    if not (np.isfinite(t).all() and np.isfinite(values).all() and (np.diff(t) > 0).all()):
        raise InputError("times and values: give finite numbers and ascending times")
    step = float(t[-1] - t[0]) / max(len(t) - 1, 1)
    if step * frequency_hz > 0.5 * (1.0 - 1e-9):
        raise InputError(f"times have {1.0 / (step * frequency_hz):.4g} samples per period: give more than two")
    # the last sample represents a step too, so that n samples cover a period
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


def measure_series(
    beam: Beam, x: Array, times: Array, values: Array, frequency_hz: float, k: complex | None = None
) -> WaveMeasures:
    """The wave in time series at positions x (m, ascending), values (n_times, n_positions), m; by Euler-Bernoulli.

    Between the positions the field is a cubic spline through their phasors, with the slope of the two fitted waves. A
    large `waves.residual` indicates forces or devices between the positions. Raises InputError for a sampling in time
    or space with two points or fewer per period or wavelength (Nyquist), for series shorter than one period or half a
    wavelength, and for positions off the beam; WindowError for an attachment between the positions.
    """
    from scipy.interpolate import CubicSpline

    check_number("frequency_hz", frequency_hz, "hertz", above=0)
    at = positions_on("x", x, beam.length)
    if not (at.ndim == 1 and (np.diff(at) > 0).all() and np.shape(values)[1:] == at.shape):
        raise InputError("x: give ascending positions, one for each column of values")
    own = wavenumber(beam, frequency_hz)
    if len(at) < 4 or (at[-1] - at[0]) * own.real < np.pi:
        raise InputError("x covers less than half a wavelength or four points: give a longer span")
    stated = None if k is None else check_wavenumber("k", k, (float(at[0]), float(at[-1])))
    if (gap := float(np.diff(at).max())) >= (half := float(np.pi / (stated or own).real)):
        raise InputError(f"x has a gap of {gap:.4g} m, half a wavelength ({half:.4g} m) or more: give points in it")
    start, end = float(at[0]), float(at[-1])
    check_clear(beam, (start, end), f"x from {start:.6g} to {end:.6g} m")
    measured = phasors(times, values, frequency_hz)
    if not abs(measured).max() > ROUNDING * abs(np.asarray(values)).max():
        raise NoFigureError(f"values have no component at frequency_hz = {frequency_hz!r}: give its frequency")
    waves = fit_waves(at, measured, stated or fitted_wavenumber(at, measured, own))

    def slope(x: Array) -> ComplexArray:
        phase = np.exp(1j * waves.wavenumber * (x - 0.5 * (start + end)))
        return np.asarray(1j * waves.wavenumber * (waves.backward * phase - waves.forward / phase))

    return WaveMeasures(
        guide=Waveguide(beam),
        omega=2.0 * np.pi * frequency_hz,
        window=(start, end),
        waves=waves,
        deflection=CubicSpline(at, measured),
        section_rotation=slope,
        x=at,
        fine=at,
    )


def surface_motion(beam: Beam, rotation: ComplexArray, x: Numbers) -> ComplexArray:
    """u_x of the upper surface at x, m: -(h/2) times the rotation of the section (rad, of the shape of x).

    At a step h is that of the right section. Raises InputError off the beam.
    """
    return np.asarray(-surface_distance_at(beam, x) * np.asarray(rotation, dtype=complex))


def axis_ratio(field: HarmonicField, x: Numbers) -> Array:
    """Signed axis ratio of the path of the surface at x (m), (n,): negative for a wave to +x. Raises InputError."""
    return ellipse(surface_motion(field.beam, field.rotation(x), x), field.deflection(x))[0]


def ellipse(across: ComplexArray, up: ComplexArray) -> tuple[Array, Array, Array]:
    """(signed axis ratio tan chi, tilt in degrees, S3) of the paths u_x = `across`, u_y = `up`, m, of equal shape.

    Stokes parameters (Born and Wolf, Principles of Optics, section 1.4): S0, S1 = |u_x|^2 +- |u_y|^2,
    S2 + i S3 = 2 conj(u_x) u_y, tan 2 tilt = S2/S1, sin 2 chi = S3/S0. The path encloses -pi/2 S3, counter-clockwise.
    """
    across, up = np.asarray(across, dtype=complex), np.asarray(up, dtype=complex)
    total, difference = abs(across) ** 2 + abs(up) ** 2, abs(across) ** 2 - abs(up) ** 2
    product = 2.0 * np.conj(across) * up
    sine = np.where(total > 0, product.imag / np.where(total > 0, total, 1.0), 0.0)
    chi = 0.5 * np.arcsin(np.clip(sine, -1.0, 1.0))
    return np.tan(chi), 0.5 * np.rad2deg(np.arctan2(product.real, difference)), product.imag
