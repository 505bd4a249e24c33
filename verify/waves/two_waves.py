"""The fit of a forward and a backward wave to a deflection: linear in their amplitudes, a search in the wavenumber."""

from collections.abc import Callable
from typing import Any

import msgspec
import numpy as np

from verify.arrays import Array, ComplexArray
from verify.checks import check_kind
from verify.errors import InputError, ZeroFieldError
from verify.linear.field import HarmonicField, phasor, unit_response
from verify.linear.numerics import Rule, gauss_rule
from verify.waves.results import TwoWaves
from verify.waves.window import Window, check_field_window, check_wavenumber

ROUNDING = 1e-13
"""Deflection relative to the response to the forces below which it is rounding."""
_REACH = 0.04
"""Relative distance from the beam's own up to which a wavenumber is fitted."""


def wave_basis(x: Array, k: Any, middle: float) -> ComplexArray:
    """e^{-ik(x - middle)} and e^{+ik(x - middle)}, (..., len(x), 2) for k of shape (...)."""
    phase = 1j * np.asarray(k)[..., None] * (x - middle)
    return np.stack([np.exp(-phase), np.exp(phase)], axis=-1)


def window_rule(window: Window, k: float) -> Rule:
    """Gauss points and weights of a window: the fit is then in the mean square over all of it."""
    start, end = map(float, window)
    return gauss_rule((start, end), max(int(np.ceil(2.0 * (end - start) * k / np.pi)), 1))


def amplitudes_of(rule: Rule, k: ComplexArray, deflections: ComplexArray, middle: float) -> ComplexArray:
    """Forward and backward amplitudes at the middle, (n, 2, m), of fields (n, m, len(rule.x)) with wavenumbers (n,)."""
    basis = wave_basis(rule.x, k, middle)
    adjoint = np.conj(np.swapaxes(basis, 1, 2)) * rule.weights
    return np.asarray(np.linalg.solve(adjoint @ basis, adjoint @ np.swapaxes(deflections, 1, 2)), dtype=complex)


def two_waves(field: HarmonicField, window: Window, wave_number: complex | None = None) -> TwoWaves:
    """The two waves of a field in a window, fitted in the mean square. Raises as `travelling_wave.measure`."""
    check_kind("field", field, HarmonicField)
    check_field_window(field, window)
    k = None if wave_number is None else check_wavenumber("wave_number", wave_number, window)
    rule = window_rule(window, field.wavenumber.real)
    deflection = field.deflection(rule.x)
    force = sum(abs(phasor(force)) for force in field.forces)
    if abs(deflection).max() <= ROUNDING * force * unit_response(field.beam, field.frequency_hz):
        raise zero_field()
    if k is None:
        k = fitted_wavenumber(rule.x, deflection, field.wavenumber, rule.weights)
    return _fit(rule.x, deflection, k, rule.weights)


def zero_field() -> ZeroFieldError:
    """The error of a field without motion in the window."""
    return ZeroFieldError(
        "the field is zero in the window: drive.force acts on a support or has no amplitude, move it or give it one"
    )


def fit_waves(x: Array, deflection: ComplexArray, k: complex, weights: Array | None = None) -> TwoWaves:
    """Forward and backward amplitude by least squares on the phasors, exact on two-wave fields.

    x (n,), m, in any order; deflection (n,), complex; weights (n,), of each point, equal by default. Amplitudes refer
    to the middle. Raises InputError for other shapes, values that are not finite, weights that are not positive, a zero
    deflection, and a wavenumber that does not propagate or of which x spans less than half a wavelength.
    """
    at, values = np.asarray(x, dtype=float), np.asarray(deflection, dtype=complex)
    counted = np.ones(at.shape) if weights is None else np.asarray(weights, dtype=float)
    if at.ndim != 1 or len(at) < 2 or values.shape != at.shape or counted.shape != at.shape:
        raise InputError(
            f"x, deflection and weights have the shapes {at.shape}, {values.shape} and {counted.shape}: give two or "
            "more numbers in a row, as many of each"
        )
    if not (np.isfinite(at).all() and np.isfinite(values).all() and np.isfinite(counted).all() and counted.min() > 0):
        raise InputError("x, deflection and weights have to be finite and weights above 0: leave out what is not")
    if not values.any():
        raise zero_field()
    return _fit(at, values, check_wavenumber("k", k, (float(at.min()), float(at.max()))), counted)


def _fit(x: Array, deflection: ComplexArray, k: complex, weights: Array) -> TwoWaves:
    root, middle = np.sqrt(weights), 0.5 * float(x.min() + x.max())
    basis, values = wave_basis(x, k, middle) * root[:, None], deflection * root
    amplitudes = np.linalg.lstsq(basis, values, rcond=None)[0]
    residual = float(np.linalg.norm(values - basis @ amplitudes) / np.linalg.norm(values))
    return TwoWaves(
        wavenumber=complex(k), forward=complex(amplitudes[0]), backward=complex(amplitudes[1]), residual=residual
    )


def fitted_wavenumber(x: Array, deflection: ComplexArray, start: complex, weights: Array | None = None) -> complex:
    """The wavenumber near `start` (within 4 %, the same phase) of least residual.

    Raises InputError where the residual still falls at the edge of the search.
    """
    halves, weights = float(x[-1] - x[0]) * start.real / np.pi, np.ones(len(x)) if weights is None else weights
    grid = np.linspace(1.0 - _REACH, 1.0 + _REACH, 2 * int(np.ceil(4.0 * _REACH * halves)) + 9)

    def residuals(factors: Array) -> Array:
        return np.array([_fit(x, deflection, complex(f * start), weights).residual for f in factors])

    least = minimum_near(residuals, grid, 1e-10)
    if least.at_edge:
        raise InputError(
            f"the fitted wavenumber ends at the edge of its search, {least.x * start.real:.6g} 1/m, {_REACH:.0%} from "
            f"the beam's {start.real:.6g} 1/m: state the wavenumber, two waves near the beam's are not there"
        )
    return complex(least.x * start)


class Minimum(msgspec.Struct, frozen=True, kw_only=True):
    """Where a figure is least in an interval."""

    x: float
    value: float
    at_edge: bool
    """Whether it still falls at an end of the interval, which is then no minimum."""


def minimum_near(figure: Callable[[Array], Array], grid: Array, tolerance: float) -> Minimum:
    """The minimum, to `tolerance` in x, of `figure` ((n,) -> (n,), not negative) next to the best of a grid."""
    from scipy.optimize import minimize_scalar

    values = figure(grid)
    i = int(np.argmin(values))
    best, low, high = (float(grid[j]) for j in (i, max(i - 1, 0), min(i + 1, len(grid) - 1)))
    # the square: a figure that falls to zero has a corner there, its square a parabola; steps from the best of the
    # grid, so that no digits are lost to the size of x
    found = minimize_scalar(
        lambda step: float(figure(np.array([best + step]))[0]) ** 2,
        bounds=(low - best, high - best),
        method="bounded",
        options={"xatol": tolerance},
    )
    x, value = (best + found.x, found.fun**0.5) if found.fun < values[i] ** 2 else (best, float(values[i]))
    at_edge = min(x - grid[0], grid[-1] - x) < 0.01 * (grid[1] - grid[0])
    return Minimum(x=float(x), value=float(value), at_edge=bool(at_edge))
