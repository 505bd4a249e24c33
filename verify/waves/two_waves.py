"""A forward and a backward wave: their fit to a deflection, crest speed and energy flux in a waveguide."""

from collections.abc import Callable
from typing import Any

import msgspec
import numpy as np

from verify.arrays import Array, ComplexArray
from verify.errors import InputError, NoFigureError
from verify.linear.field import HarmonicField, phasor, unit_response, wavenumber
from verify.linear.numerics import Rule, gauss_rule
from verify.problem.beam import Beam
from verify.validation import check_type
from verify.waves.window import Window, check_span, check_wavenumber, check_waves

STANDING, ROUNDING = 1e-12, 1e-13
"""1 - Gamma below which a wave is standing, and deflection over `unit_response` times force that is rounding."""
_REACH = 0.04  # Largest relative distance of a fitted wavenumber from that of the beam


def reflections(forward: ComplexArray, backward: ComplexArray) -> Array:
    """Gamma, weaker over stronger amplitude, elementwise for arrays of equal shape; 1 where both are zero."""
    sizes = np.sort(np.stack([abs(forward), abs(backward)]), axis=0)
    return np.asarray(np.where(sizes[1] == 0.0, 1.0, sizes[0] / np.where(sizes[1] == 0.0, 1.0, sizes[1])))


def standing_wave_ratios(gammas: Array) -> Array:
    """(1 + Gamma) / (1 - Gamma), elementwise; infinite from Gamma = 1 - `STANDING` on."""
    stands = gammas >= 1.0 - STANDING
    return np.asarray(np.where(stands, np.inf, (1.0 + gammas) / np.where(stands, 1.0, 1.0 - gammas)))


class TwoWaves(msgspec.Struct, frozen=True, eq=False, kw_only=True):
    """A forward and a backward wave fitted to phasors; amplitudes refer to the middle of the window."""

    wavenumber: complex  # k, 1/m, prescribed or fitted
    forward: complex  # A+ of e^{-ik(x - middle)}, m
    backward: complex  # A- of e^{+ik(x - middle)}, m
    residual: float  # Residual of the fit, rms over rms of the field

    @property
    def direction(self) -> int:
        """Direction of the stronger wave: +1 towards +x, -1 towards -x."""
        return 1 if abs(self.forward) >= abs(self.backward) else -1

    @property
    def reflection(self) -> float:
        """Gamma, the weaker amplitude over the stronger, 0 to 1."""
        return float(reflections(np.array(self.forward), np.array(self.backward)))

    @property
    def standing_wave_ratio(self) -> float:
        """(1 + Gamma) / (1 - Gamma), 1 for a pure travelling wave, infinite for a standing one."""
        return float(standing_wave_ratios(np.array(self.reflection)))

    def check_travelling(self) -> None:
        """Raise NoFigureError for a standing wave, whose flux and signed area are within rounding of zero."""
        if self.reflection >= 1.0 - STANDING:
            raise NoFigureError("standing wave: its energy flux and S3 are zero, choose another phase_deg")


def wave_basis(x: Array, k: Any, middle: float) -> ComplexArray:
    """e^{-ik(x - middle)} and e^{+ik(x - middle)}, (..., len(x), 2) for k of shape (...)."""
    phase = 1j * np.asarray(k)[..., None] * (x - middle)
    return np.stack([np.exp(-phase), np.exp(phase)], axis=-1)


def window_rule(window: Window, k: float) -> Rule:
    """Gauss points and weights of a window, for a fit in the mean square."""
    start, end = map(float, window)
    return gauss_rule((start, end), max(int(np.ceil(2.0 * (end - start) * k / np.pi)), 1))


def two_waves(field: HarmonicField, window: Window, wave_number: complex | None = None) -> TwoWaves:
    """The two waves of a field in a window, fitted in the mean square. Errors as in `travelling_wave.measure`."""
    check_type("field", field, HarmonicField)
    hertz = float(field.frequency_hz)
    check_span(field.beam, [force.position for force in field.forces], window, field.couples, field.theory)
    check_waves(field.beam, hertz, window, field.theory)
    k = None if wave_number is None else check_wavenumber("wave_number", wave_number, window)
    rule = window_rule(window, field.wavenumber.real)
    deflection = field.deflection(rule.x)
    force = sum(abs(phasor(force)) for force in field.forces)
    if abs(deflection).max() <= ROUNDING * force * unit_response(field.beam, hertz):
        raise zero_field()
    if k is None:
        k = fitted_wavenumber(rule.x, deflection, field.wavenumber, rule.weights)
    return _fit(rule.x, deflection, k, rule.weights)


def zero_field() -> NoFigureError:
    """The error for a field that is zero in the window."""
    return NoFigureError(
        "the field is zero in the window: drive.force is on a support or has no amplitude, move it or give it one"
    )


def fit_waves(x: Array, deflection: ComplexArray, k: complex) -> TwoWaves:
    """Forward and backward amplitude by least squares on phasors (n,) at x (n,), m: exact for two-wave fields.

    Amplitudes refer to the middle of x. Raises InputError for other shapes, values that are not finite, a zero
    deflection, an evanescent wavenumber, and x over less than half a wavelength.
    """
    at, values = np.asarray(x, dtype=float), np.asarray(deflection, dtype=complex)
    if at.ndim != 1 or len(at) < 2 or values.shape != at.shape or not np.isfinite([at, values]).all():
        raise InputError(f"x, {at.shape}, and deflection, {values.shape}: give two or more finite numbers of each")
    if not values.any():
        raise zero_field()
    return _fit(at, values, check_wavenumber("k", k, (float(at.min()), float(at.max()))), np.ones(len(at)))


def _fit(x: Array, deflection: ComplexArray, k: complex, weights: Array) -> TwoWaves:
    root = np.sqrt(weights)
    basis, values = wave_basis(x, k, 0.5 * float(x.min() + x.max())) * root[:, None], deflection * root
    forward, backward = np.linalg.lstsq(basis, values, rcond=None)[0].tolist()
    residual = float(np.linalg.norm(values - basis @ [forward, backward]) / np.linalg.norm(values))
    return TwoWaves(wavenumber=complex(k), forward=forward, backward=backward, residual=residual)


def fitted_wavenumber(x: Array, deflection: ComplexArray, start: complex, weights: Array | None = None) -> complex:
    """The wavenumber of least residual within 4 % of `start`, with the same complex phase.

    Raises InputError for a minimum at the edge of the search.
    """
    halves, weights = float(x[-1] - x[0]) * start.real / np.pi, np.ones(len(x)) if weights is None else weights
    grid = np.linspace(1.0 - _REACH, 1.0 + _REACH, 2 * int(np.ceil(4.0 * _REACH * halves)) + 9)

    def residuals(factors: Array) -> Array:
        return np.array([_fit(x, deflection, complex(f * start), weights).residual for f in factors])

    least = minimum_near(residuals, grid, 1e-10)
    if least.at_edge:
        raise InputError(
            f"the fitted wavenumber {least.x * start.real:.6g} 1/m is at the edge of its search, {_REACH:.0%} from the "
            f"beam's {start.real:.6g} 1/m: the field is not two waves, prescribe the wavenumber or choose a window"
        )
    return complex(least.x * start)


class Minimum(msgspec.Struct, frozen=True):
    """Minimum of a function in an interval; `at_edge`: at an end of the interval."""

    x: float
    value: float
    at_edge: bool


def minimum_near(figure: Callable[[Array], Array], grid: Array, tolerance: float) -> Minimum:
    """The minimum, to `tolerance` in x, of a non-negative function ((n,) -> (n,)) next to the best grid point."""
    from scipy.optimize import minimize_scalar

    values = figure(grid)
    i = int(np.argmin(values))
    best, low, high = (float(grid[j]) for j in (i, max(i - 1, 0), min(i + 1, len(grid) - 1)))
    # the square: a function that falls to zero has a corner, its square a parabola; distances from the best grid
    # point, so that no digits are lost to the size of x
    least = minimize_scalar(
        lambda step: float(figure(np.array([best + step]))[0]) ** 2,
        bounds=(low - best, high - best),
        method="bounded",
        options={"xatol": tolerance},
    )
    x, value = (best + least.x, least.fun**0.5) if least.fun < values[i] ** 2 else (best, values[i])
    return Minimum(float(x), float(value), bool(min(x - grid[0], grid[-1] - x) < 0.01 * (grid[1] - grid[0])))


class Waveguide(msgspec.Struct, frozen=True):
    """The beam's own section as a waveguide of a theory. Methods take numbers or arrays."""

    beam: Beam
    theory: str = "euler-bernoulli"

    def rotation_ratio(self, omega: Any) -> Any:
        """psi/w', rotation of the section over slope of the neutral line in a travelling wave: 1 without shear.

        kappa G A (w'' - psi') + (rho A omega^2 - k_f) w = 0 with w'' = -k^2 w (Timoshenko, Phil. Mag. 41, 1921);
        complex with losses.
        """
        shear, loss = self.beam.base_section.shear_stiffness, self.beam.loss_factor
        if self.theory != "timoshenko" or shear is None:
            return 1.0
        hertz = np.asarray(omega) / (2.0 * np.pi)
        k2 = np.vectorize(lambda f: wavenumber(self.beam, float(f), self.theory) ** 2)(hertz)
        resisted = shear * (1.0 + 1j * loss) * k2 if loss else shear * k2.real
        return 1.0 - (self.beam.mass_per_length * omega**2 - self.beam.foundation) / resisted

    def axis_ratio(self, omega: Any, k: Any) -> Any:
        """Width over height of the surface ellipse of a pure wave, r = (k h/2) psi/w'."""
        return np.real(k * self.rotation_ratio(omega)) * self.beam.surface_distance

    def crest_speed(self, omega: Any, k: Any, forward: Any, backward: Any) -> Any:
        """Velocity of the surface along +x at the crests of both waves, m/s.

        At largest w, du_x/dt = omega S3 / (2 |w|). S3 = -2 r (|A+|^2 - |A-|^2) is constant; with the rms
        sqrt(|A+|^2 + |A-|^2) of |w| the velocity is -omega r (|A+|^2 - |A-|^2) / sqrt(|A+|^2 + |A-|^2).
        """
        plus, minus = abs(forward) ** 2, abs(backward) ** 2
        return -omega * self.axis_ratio(omega, k) * (plus - minus) / np.sqrt(plus + minus)

    def energy_flux(self, omega: Any, k: Any, forward: Any, backward: Any) -> Any:
        """Energy flux of both waves towards +x, W, at the point to which their amplitudes refer.

        Transverse force times velocity and moment times angular velocity, 1/2 Re, with EI (1 + i eta); undamped
        EI k^3 omega (|A+|^2 - |A-|^2). Axial force and rotary inertia contribute to the transverse force.
        """
        beam, k = self.beam, np.asarray(k, dtype=complex)
        deflection, slope, ratio = forward + backward, 1j * k * (backward - forward), self.rotation_ratio(omega)
        stiffness = beam.bending_stiffness * (1.0 + 1j * beam.loss_factor) * ratio
        inertia = (beam.base_section.rotary_inertia or 0.0) * omega**2 if self.theory != "euler-bernoulli" else 0.0
        force = stiffness * 1j * k**3 * (forward - backward) + (inertia * ratio - beam.tension) * slope
        couple = stiffness * k**2 * deflection
        return 0.5 * np.real(force * np.conj(1j * omega * deflection) + couple * np.conj(1j * omega * ratio * slope))
