"""The travelling wave that a driven beam carries, and what drives or absorbs it.

A point of the beam's line moves by Re(w(x) e^{i omega t}). Between the forces, away from near fields,
w = A+ e^{-ik(x - m)} + A- e^{+ik(x - m)} about the middle m of a window: a wave towards +x and one towards -x.
`measure` fits both. With the reflection Gamma = |weaker| / |stronger| the standing-wave ratio is (1 + Gamma) /
(1 - Gamma): 1 for a travelling wave, infinite for a standing one.

A point of the surface moves by u_x = -(h/2) psi, u_y = w, with the rotation psi of its section (w' without shear). Its
path is an ellipse with the signed area S3 = 2 Im(conj(u_x) u_y) (times pi/2) and the axis ratio tan chi, sin 2 chi =
S3 / (|u_x|^2 + |u_y|^2); both are negative for a wave towards +x, whose surface points turn counter-clockwise and move
backwards at the crests, where a slider touches them.

    field = ExactModel(beam).harmonic(forces, 4276.0)
    measure(field, middle_half(beam)).standing_wave_ratio
"""

from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from verify.arrays import Array, ComplexArray
from verify.errors import InputError, NoFigureError
from verify.linear.field import HarmonicField, phasor, wavenumber
from verify.linear.numerics import extremes, gauss_rule, mean_over, whole_halves
from verify.linear.positions import Numbers, positions_on
from verify.linear.surface import surface_distance_at
from verify.problem.beam import Beam
from verify.validation import check_number
from verify.waves.best_drive import BestDrive, best_drive
from verify.waves.driven_case import DrivenCase
from verify.waves.from_time_series import phasors
from verify.waves.impedance_matching import matched_device
from verify.waves.operating_point import OperatingPoint, best_frequency, maximum_crest_speed
from verify.waves.two_waves import ROUNDING, TwoWaves, fit_waves, fitted_wavenumber, two_waves
from verify.waves.waveguide import Waveguide
from verify.waves.window import Window, check_clear, middle_half

__all__ = [
    "BestDrive", "DrivenCase", "OperatingPoint", "TwoWaves", "WaveMeasures", "best_drive",
    "best_frequency", "ellipse", "fit_waves", "matched_device", "maximum_crest_speed", "measure", "measure_series",
    "middle_half", "phasors", "power_imbalance", "surface_motion", "two_waves",
]  # fmt: skip
SHARPNESS = 24
"""Points for each half wavelength of the window, for charts and to start the search for extremes from."""
POINTS_OF_A_PART = 8
"""The same for each segment or element: a discrete field ripples at their length."""


@dataclass(frozen=True, eq=False, kw_only=True)
class WaveMeasures:
    """The wave that a field carries in a window, and the motion of the surface there; each figure on first use."""

    guide: Waveguide
    omega: float
    window: Window
    """m."""
    waves: TwoWaves
    """The forward and the backward wave fitted in the window."""
    deflection: Callable[[Array], ComplexArray]
    """w at any x of the window, m."""
    section_rotation: Callable[[Array], ComplexArray]
    """psi there, rad."""
    x: Array
    """(n,), m: where surface quantities are listed, 24 points for each half wavelength of the exact beam."""
    fine: Array
    """(m,), m: fine enough to separate the extremes of the field."""

    @property
    def reflection(self) -> float:
        """Gamma, the weaker wave over the stronger, 0 to 1."""
        return self.waves.reflection

    @property
    def standing_wave_ratio(self) -> float:
        """(1 + Gamma) / (1 - Gamma), from 1 to infinity."""
        return self.waves.standing_wave_ratio

    @cached_property
    def envelope(self) -> float:
        """(max - min) / (max + min) of |w| over the window: Gamma for two waves."""
        least, largest = extremes(lambda x: np.abs(self.deflection(x)), self.fine)
        return (largest - least) / (largest + least)

    @cached_property
    def travelling_index(self) -> float:
        """1 / cond of [Re w, Im w] in the mean square (Feeny's complex orthogonal decomposition), 0 to 1.

        Over whole half wavelengths, the most that fit in the middle of the window: there, and only there, it equals
        (1 - Gamma) / (1 + Gamma) for two waves.
        """
        whole, halves = whole_halves(self.window, self.waves.wavenumber.real)
        rule = gauss_rule(whole, 2 * halves)
        w = self.deflection(rule.x)
        values = np.linalg.svd(np.stack([w.real, w.imag]) * np.sqrt(rule.weights), compute_uv=False)
        return float(values[1] / values[0]) if values[0] > 0 else 0.0

    @cached_property
    def ellipses(self) -> tuple[Array, Array, Array]:
        """(signed axis ratio, tilt in degrees, signed area S3 in m^2) of the surface ellipses at `x`, (n,) each."""
        return self._ellipse(self.x)

    def _ellipse(self, x: Array) -> tuple[Array, Array, Array]:
        return ellipse(-self.guide.beam.surface_distance * self.section_rotation(x), self.deflection(x))

    @cached_property
    def mean_axis_ratio(self) -> float:
        """Of the signed axis ratio over the same whole half wavelengths: -+ `ideal_axis_ratio` as kh goes to 0."""
        whole, halves = whole_halves(self.window, self.waves.wavenumber.real)
        return mean_over(lambda x: self._ellipse(x)[0], whole, 2 * halves)

    @cached_property
    def ideal_axis_ratio(self) -> float:
        """Of a pure wave, unsigned: k h/2, by Timoshenko's theory times psi/w' of a running wave."""
        return float(self.guide.axis_ratio(self.omega, self.waves.wavenumber))

    @cached_property
    def signed_area_range(self) -> tuple[float, float, float]:
        """Least, mean and largest signed area over the window, m^2."""
        halves = whole_halves(self.window, self.waves.wavenumber.real)[1]
        low, high = extremes(lambda x: self._ellipse(x)[2], self.fine)
        return low, mean_over(lambda x: self._ellipse(x)[2], self.window, 2 * halves), high

    @property
    def signed_area_spread(self) -> float:
        """(max - min) / |mean| of the signed area: 0 for undamped waves away from forces and ends.

        Raises NoFigureError where the wave stands.
        """
        self.waves.check_travelling()
        least, mean, largest = self.signed_area_range
        return (largest - least) / abs(mean)

    @cached_property
    def crest_speed(self) -> float:
        """Of the surface at the crests, m/s along +x: -omega r (|A+|^2 - |A-|^2) / sqrt(|A+|^2 + |A-|^2).

        r is the `ideal_axis_ratio`.
        """
        one = self.waves
        return float(self.guide.crest_speed(self.omega, one.wavenumber, one.forward, one.backward))

    @cached_property
    def energy_flux(self) -> float:
        """Power that both waves carry towards +x through the middle of the window, W."""
        one = self.waves
        return float(self.guide.energy_flux(self.omega, one.wavenumber, one.forward, one.backward))


def measure(field: HarmonicField, window: Window, wave_number: complex | None = None) -> WaveMeasures:
    """Measure the wave that a field carries in a window (a, b) between the forces, m.

    The wavenumber is fitted unless stated (complex for a damped wave), 1/m. Raises InputError for a window that is not
    between two neighbouring forces, holds a device or an attachment or less than half a wavelength, for a field that is
    zero there and for a fit that ends at its edge.
    """
    waves = two_waves(field, window, wave_number)
    start, end = map(float, window)
    n = int(np.ceil(SHARPNESS * (end - start) * field.wavenumber.real / np.pi)) + 1
    n_fine = int(POINTS_OF_A_PART * (field.count or 0) * (end - start) / field.beam.length) + 1
    return WaveMeasures(
        guide=Waveguide(field.beam, field.theory),
        omega=field.omega,
        window=(start, end),
        waves=waves,
        deflection=field.deflection,
        section_rotation=field.rotation,
        x=np.linspace(start, end, n),
        fine=np.linspace(start, end, max(n, n_fine)),
    )


def measure_series(
    beam: Beam, x: Array, times: Array, values: Array, frequency_hz: float, k: complex | None = None
) -> WaveMeasures:
    """The same measures from time series at positions x (m, ascending), values (n_times, n_positions), m.

    Between the positions the field is a cubic spline through their phasors, and its slope that of the two fitted waves.
    Forces and devices between them are not known here: a large `waves.residual` indicates them. Raises InputError for
    series or spans that are too short and positions off the beam, WindowError for an attachment between them.
    """
    from scipy.interpolate import CubicSpline

    check_number("frequency_hz", frequency_hz, "hertz", above=0)
    at = positions_on("x", x, beam.length)
    if not (at.ndim == 1 and (np.diff(at) > 0).all() and np.shape(values)[1:] == at.shape):
        raise InputError("x has to be ascending and as long as values are wide")
    own = wavenumber(beam, frequency_hz)
    if len(at) < 4 or (at[-1] - at[0]) * own.real < np.pi:
        raise InputError("x covers less than half a wavelength or four points: measure over a longer span")
    start, end = float(at[0]), float(at[-1])
    check_clear(beam, (start, end), f"x from {start:.6g} to {end:.6g} m")
    measured = phasors(times, values, frequency_hz)
    if not abs(measured).max() > ROUNDING * abs(np.asarray(values)).max():
        raise NoFigureError(f"values do not move at frequency_hz = {frequency_hz!r}: there is no wave to measure")
    waves = fit_waves(at, measured, fitted_wavenumber(at, measured, own) if k is None else k)

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
    """u_x of the upper surface at x (m): -(h/2) times the rotation of the section there (rad), of one shape.

    Where two sections meet, h is that of the right one. Raises InputError off the beam.
    """
    return np.asarray(-surface_distance_at(beam, x) * np.asarray(rotation, dtype=complex))


def ellipse(across: ComplexArray, up: ComplexArray) -> tuple[Array, Array, Array]:
    """(signed axis ratio tan chi, tilt in degrees, signed area S3) of the paths of surface points, of their shape each.

    Stokes parameters of u_x = `across` and u_y = `up`: S0, S1 = |u_x|^2 +- |u_y|^2, S2 + i S3 = 2 conj(u_x) u_y,
    sin 2 chi = S3/S0.
    """
    across, up = np.asarray(across, dtype=complex), np.asarray(up, dtype=complex)
    total, difference = abs(across) ** 2 + abs(up) ** 2, abs(across) ** 2 - abs(up) ** 2
    product = 2.0 * np.conj(across) * up
    sine = np.where(total > 0, product.imag / np.where(total > 0, total, 1.0), 0.0)
    chi = 0.5 * np.arcsin(np.clip(sine, -1.0, 1.0))
    return np.tan(chi), 0.5 * np.rad2deg(np.arctan2(product.real, difference)), product.imag


def power_imbalance(field: HarmonicField, measures: WaveMeasures) -> float:
    """(power of the forces left of the window - losses up to its middle - flux through it) over that flux.

    The loss factor acts on bending, EI |psi'|^2, and shear, kappa G A |w' - psi|^2. Raises NoFigureError where the wave
    stands, and InputError for a beam with sections and for devices against rotation.
    """
    beam, middle = field.beam, 0.5 * sum(measures.window)
    if field.couples:
        raise InputError(
            f"device.position = {field.couples[0]!r}: a power balance takes no device against rotation, leave it out"
        )
    beam.check_added("a power balance", ("mass", "spring", "tension", "foundation"))
    measures.waves.check_travelling()
    left = [force for force in field.forces if force.position <= measures.window[0]]
    speeds = 1j * field.omega * field.deflection([force.position for force in left])
    power = sum(0.5 * (phasor(f) * np.conj(v)).real for f, v in zip(left, speeds, strict=True))
    # the third derivative jumps at a force, the second at a couple: quadrature in between
    jumps = [f.position for f in field.forces] + [m.position for m in beam.mass] + [s.position for s in beam.spring]
    cells = np.linspace(0.0, middle, max(int(middle * field.wavenumber.real), 8))
    edges = np.unique([*cells, *(x for x in jumps if x < middle)])
    points, weights = np.polynomial.legendre.leggauss(8)
    half = 0.5 * np.diff(edges)[:, None]
    x, weights = (edges[:-1, None] + half * (points + 1.0)).ravel(), (half * weights).ravel()
    lost = beam.bending_stiffness * float(abs(field.rotations(x, 1)) ** 2 @ weights)
    if field.theory == "timoshenko" and beam.own.shear_stiffness is not None:
        lost += beam.own.shear_stiffness * float(abs(field.slope(x) - field.rotation(x)) ** 2 @ weights)
    return float((power - 0.5 * field.omega * beam.loss_factor * lost) / measures.energy_flux - 1.0)
