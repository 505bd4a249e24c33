"""A field in, wave measures and surface ellipses out.

Conventions: e^{+i omega t}; a wave towards +x is e^{-ikx}. A surface point moves by u_x = -(h/2) psi, u_y = w, with
the turn psi of its section, which is w' where nothing shears;
its ellipse has the signed area S3 = 2 Im(conj(u_x) u_y) (times pi/2), negative for a wave towards +x, whose
surface points turn counter-clockwise and move backwards at the crest.
"""

from collections.abc import Callable
from typing import Any, TypeAlias

import msgspec
import numpy as np

from verify.arrays import Array, ComplexArray
from verify.checks import check_kind, check_number, plain
from verify.errors import InputError, NoFigureError
from verify.linear.fields import HarmonicField, phasor, unit_response
from verify.linear.intervals import Rule, extremes, mean_over, rule_over, whole_halves
from verify.linear.places import Numbers, complex_array, in_a_row
from verify.linear.search import least_over
from verify.linear.surface import standing_at, surface_distance_at
from verify.problem.beam import Beam
from verify.waves.results import TwoWaves, WaveMeasures
from verify.waves.waveguide import Medium
from verify.waves.window import check_window, stated_wavenumber

SHARPNESS = 24
"""Points for each half wavelength of the window, to draw from and to look for extremes around."""
HILLS_OF_A_PART = 8
"""Points in each segment or element where a discrete field's extremes are looked for: it ripples at their length."""
STILL = 1e-13
"""A deflection this small beside the forces' own size is rounding: nothing moves."""
REACH = 0.04
"""How far from the beam's, relative, a fitted wavenumber is looked for."""


def middle_half(beam: Beam) -> tuple[float, float]:
    """The window [L/4, 3L/4], metres, where none is given."""
    check_kind("beam", beam, Beam)
    return 0.25 * beam.length, 0.75 * beam.length


def medium_of(field: HarmonicField) -> Medium:
    """What the field's waves run in."""
    return Medium(field.beam, field.theory)


def measure(field: HarmonicField, window: tuple[float, float], wave_number: complex | None = None) -> WaveMeasures:
    """Measure the wave that a field carries in a window (a, b) between the forces, metres.

    The wavenumber is stated (complex for a damped wave), or fitted where it is None. Raises InputError for a
    window that leaves the span between two forces or is shorter than half a wavelength, for a field that is zero
    there and for a fit that ends at its edge.
    """
    return _measures(_seen(field, window, wave_number), sample_points(window, field.wavenumber.real))


def measured_figure(field: HarmonicField, window: tuple[float, float], wave_number: complex | None, name: str) -> float:
    """One of `FIGURES` as `measure` has it, and nothing beside it. Raises as that, NoFigureError as the figure."""
    return FIGURES[name](_seen(field, window, wave_number))


def _seen(field: HarmonicField, window: tuple[float, float], wave_number: complex | None) -> "Seen":
    waves = two_waves(field, window, wave_number)
    x = sample_points(window, field.wavenumber.real)
    parts = HILLS_OF_A_PART * (field.count or 0) * (window[1] - window[0]) / field.beam.length
    return Seen(
        medium=medium_of(field),
        omega=field.omega,
        window=(float(window[0]), float(window[1])),
        fine=x if len(x) > parts else np.linspace(*window, int(parts) + 1),
        deflection=field.deflection,
        turn=field.turn,
        waves=waves,
    )


def two_waves(field: HarmonicField, window: tuple[float, float], wave_number: complex | None = None) -> TwoWaves:
    """The two waves alone, fitted in the mean square over the whole window. Raises as `measure` does."""
    check_kind("field", field, HarmonicField)
    places = [force.position for force in field.forces]
    check_window(field.beam, places, field.frequency_hz, window, field.turning_held, field.theory)
    start, span = field.wavenumber, (float(window[0]), float(window[1]))
    stated = None if wave_number is None else stated_wavenumber("wave_number", wave_number, span)
    rule = window_rule(window, start.real)
    deflection = field.deflection(rule.x)
    check_moving(field, deflection)
    if stated is None:
        stated = fitted_wavenumber(rule.x, deflection, start, rule.weights)
    return _fitted(rule.x, deflection, stated, rule.weights)


def check_moving(field: HarmonicField, deflection: ComplexArray) -> None:
    """Raise NoFigureError where what was read of a field is rounding beside its forces."""
    if abs(deflection).max() <= still(field):
        raise zero_field()


def still(field: HarmonicField) -> float:
    """The deflection, metres, up to which a field is rounding beside its forces."""
    force = sum(abs(phasor(force)) for force in field.forces)
    return STILL * force * unit_response(field.beam, field.frequency_hz)


def amplitudes_of(rule: Rule, k: ComplexArray, deflections: ComplexArray, middle: float) -> ComplexArray:
    """Forward and backward amplitudes at the middle, (n, 2, m), of fields (n, m, len(rule.x)) with wavenumbers (n,)."""
    basis = wave_basis(rule.x, k, middle)
    adjoint = np.conj(np.swapaxes(basis, 1, 2)) * rule.weights
    return np.asarray(np.linalg.solve(adjoint @ basis, adjoint @ np.swapaxes(deflections, 1, 2)), dtype=complex)


Along: TypeAlias = Callable[[Array], ComplexArray]


class Seen(msgspec.Struct, frozen=True, eq=False, kw_only=True):
    """A field that is known at any place of a window, and the two waves in it: what measures are found from."""

    medium: Medium
    omega: float
    window: tuple[float, float]
    fine: Array
    """(m,), close enough to tell the hills of the field apart."""
    deflection: Along
    turn: Along
    """Of the section."""
    waves: TwoWaves

    @property
    def halves(self) -> tuple[tuple[float, float], int]:
        """The whole half wavelengths in the window's middle, and how many."""
        return whole_halves(self.window, self.waves.wavenumber.real)

    def envelope(self) -> float:
        """As `WaveMeasures` has it, like all below."""
        least, largest = extremes(lambda at: np.abs(self.deflection(at)), self.fine)
        return (largest - least) / (largest + least)

    def travelling_index(self) -> float:
        """Over whole half wavelengths."""
        whole, halves = self.halves
        rule = rule_over(whole, 2 * halves)
        return travelling_index(self.deflection(rule.x), rule.weights)

    def mean_axis_ratio(self) -> float:
        """Over the same."""
        return mean_axis_ratio(self.medium.beam, self.window, self.deflection, self.turn, self.waves)

    def signed_area_range(self) -> tuple[float, float, float]:
        """Least, mean and largest."""
        beam = self.medium.beam

        def areas(at: Array) -> Array:
            return signed_area(lifted(beam, self.turn(at)), self.deflection(at))

        low, high = extremes(areas, self.fine)
        return low, mean_over(areas, self.window, 2 * self.halves[1]), high

    def signed_area_spread(self) -> float:
        """Raises NoFigureError where the wave stands."""
        self.waves.check_travelling()
        least, mean, largest = self.signed_area_range()
        return (largest - least) / abs(mean)

    def crest_speed(self) -> float:
        """Of both waves."""
        waves = self.waves
        return float(crest_speed(self.medium, self.omega, waves.wavenumber, waves.forward, waves.backward))

    def energy_flux(self) -> float:
        """Likewise."""
        waves = self.waves
        return float(energy_flux(self.medium, self.omega, waves.wavenumber, waves.forward, waves.backward))


FIGURES: dict[str, Callable[[Seen], float]] = {
    "reflection": lambda seen: seen.waves.reflection,
    "standing_wave_ratio": lambda seen: seen.waves.standing_wave_ratio,
    "envelope": Seen.envelope,
    "travelling_index": Seen.travelling_index,
    "mean_axis_ratio": Seen.mean_axis_ratio,
    "signed_area_spread": Seen.signed_area_spread,
    "crest_speed": Seen.crest_speed,
    "energy_flux": Seen.energy_flux,
}
"""Figures of `WaveMeasures` by name, each found without the others."""


def measures_of(
    medium: Medium, omega: float, x: Array, fine: Array, deflection: Along, turn: Along, waves: TwoWaves
) -> WaveMeasures:
    """The measures of a field known at any place of the window: means and extremes do not depend on points.

    x (n,): where ellipses are given; fine (m,): as `Seen` has it.
    """
    window = float(x[0]), float(x[-1])
    seen = Seen(medium=medium, omega=omega, window=window, fine=fine, deflection=deflection, turn=turn, waves=waves)
    return _measures(seen, x)


def _measures(seen: Seen, x: Array) -> WaveMeasures:
    """All of them, ellipses at x (n,)."""
    beam, turn = seen.medium.beam, seen.medium.turn(seen.omega)
    ratio, tilt, area = ellipse(lifted(beam, seen.turn(x)), seen.deflection(x))
    return WaveMeasures(
        window=seen.window,
        waves=seen.waves,
        envelope=seen.envelope(),
        travelling_index=seen.travelling_index(),
        mean_axis_ratio=seen.mean_axis_ratio(),
        x=x,
        axis_ratio=ratio,
        tilt_deg=tilt,
        signed_area=area,
        signed_area_range=seen.signed_area_range(),
        ideal_axis_ratio=float(np.real(seen.waves.wavenumber * turn)) * beam.surface_distance,
        crest_speed=seen.crest_speed(),
        energy_flux=seen.energy_flux(),
    )


def mean_axis_ratio(beam: Beam, window: tuple[float, float], deflection: Along, turn: Along, waves: TwoWaves) -> float:
    """The mean of `axis_ratio` over the whole half wavelengths of a window."""
    whole, halves = whole_halves(window, waves.wavenumber.real)

    def ratio(at: Array) -> Array:
        return ellipse(lifted(beam, turn(at)), deflection(at))[0]

    return mean_over(ratio, whole, 2 * halves)


def surface_motion(beam: Beam, slope: ComplexArray, turn: float = 1.0, x: Numbers | None = None) -> ComplexArray:
    """u_x of the upper surface, metres: -(h/2) times the turn of the section.

    `slope` is that turn (`HarmonicField.turn`), w' where nothing shears; or w' itself of a running wave, with `turn`
    the part of it that the section turns by. h/2 is that of the section that stands at x (metres, of the shape of
    `slope`); where two meet, the one to the right. Raises InputError without x for a beam whose surface has steps.
    """
    check_kind("beam", beam, Beam)
    slope = complex_array("slope", slope, "radians")
    check_number("turn", plain(turn), "part of the slope")
    if x is not None:
        if np.atleast_1d(x).shape != np.atleast_1d(slope).shape:
            raise InputError(f"x has the shape {np.shape(x)} and slope {slope.shape}: give a place for each")
        return np.asarray(-surface_distance_at(beam, x) * turn * slope)
    if len({piece.extreme_fibre for piece in beam.pieces}) > 1:
        raise InputError("x is missing: the surface has steps where beam.section changes, say where the slope is")
    return lifted(standing_at(beam, 0.0), slope, turn)


def lifted(beam: Beam, slope: ComplexArray, turn: float = 1.0) -> ComplexArray:
    """The same of the beam's own section, which all of a window has."""
    return np.asarray(-beam.surface_distance * turn * np.asarray(slope))


def ellipse(across: ComplexArray, up: ComplexArray) -> tuple[Array, Array, Array]:
    """(signed axis ratio tan chi, tilt in degrees, signed area S3) of the paths of surface points, of their shape each.

    Stokes parameters: S0 = |u_x|^2 + |u_y|^2, S1 = |u_x|^2 - |u_y|^2, S2 = 2 Re(conj(u_x) u_y), sin 2 chi = S3/S0.
    Raises InputError for shapes that differ.
    """
    across, up = complex_array("across", across, "metres"), complex_array("up", up, "metres")
    if across.shape != up.shape:
        raise InputError(f"across has the shape {across.shape} and up {up.shape}: give as many of both")
    total, difference = abs(across) ** 2 + abs(up) ** 2, abs(across) ** 2 - abs(up) ** 2
    product = 2.0 * np.conj(across) * up
    with np.errstate(invalid="ignore"):
        sine = np.where(total > 0, product.imag / np.where(total > 0, total, 1.0), 0.0)
    chi = 0.5 * np.arcsin(np.clip(sine, -1.0, 1.0))
    tilt = 0.5 * np.rad2deg(np.arctan2(product.real, difference))
    return np.tan(chi), tilt, product.imag


def signed_area(across: ComplexArray, up: ComplexArray) -> Array:
    """The last of these, S3 alone."""
    return np.asarray(2.0 * (across.real * up.imag - across.imag * up.real))


def crest_speed(medium: Medium, omega: Any, k: Any, forward: Any, backward: Any) -> Any:
    """Speed of the surface at the crests, m/s; works on arrays of amplitudes alike."""
    plus, minus = abs(forward) ** 2, abs(backward) ** 2
    turning = np.real(k * medium.turn(omega))
    return -omega * medium.beam.surface_distance * turning * (plus - minus) / np.sqrt(plus + minus)


def energy_flux(medium: Medium, omega: Any, k: Any, forward: Any, backward: Any) -> Any:
    """Power carried towards +x by both waves, watt, at the point where their amplitudes are meant.

    Shear force times deflection speed and moment times turning speed, 1/2 Re, with EI (1 + i eta); undamped
    EI k^3 omega (|A+|^2 - |A-|^2). Axial force and rotary inertia add to the shear force. Works on arrays of
    amplitudes alike.
    """
    k = np.asarray(k, dtype=complex)
    deflection, slope = forward + backward, 1j * k * (backward - forward)
    moment, shear = -(k**2) * deflection, 1j * k**3 * (forward - backward)
    speed, turn = 1j * omega * deflection, medium.turn(omega)
    stiffness = medium.beam.bending_stiffness * (1.0 + 1j * medium.beam.loss_factor) * turn
    across = stiffness * shear + medium.beside_shear(omega) * slope
    return 0.5 * np.real(across * np.conj(speed) - stiffness * moment * np.conj(1j * omega * turn * slope))


def travelling_index(deflection: ComplexArray, weights: Array) -> float:
    """1 / cond([Re w, Im w]), 0 to 1, both weighted by the length that each point stands for, (n,)."""
    columns = np.column_stack([deflection.real, deflection.imag]) * np.sqrt(weights)[:, None]
    values = np.linalg.svd(columns, compute_uv=False)
    return float(values[1] / values[0]) if values[0] > 0 else 0.0


def wave_basis(x: Array, k: Any, middle: float) -> ComplexArray:
    """e^{-ik(x - middle)} and e^{+ik(x - middle)}, (..., len(x), 2) for k of shape (...)."""
    phase = 1j * np.asarray(k)[..., None] * (x - middle)
    forward = np.exp(-phase)
    return np.stack([forward, np.exp(phase) if phase.real.any() else np.conj(forward)], axis=-1)


def fit_waves(x: Array, deflection: ComplexArray, k: complex, weights: Array | None = None) -> TwoWaves:
    """Forward and backward amplitude by least squares on the phasors, exact on two-wave fields.

    x (n,), metres; deflection (n,), complex; weights (n,): what each point counts, all the same where they are left
    out. Amplitudes are meant in the middle. Raises InputError for rows of other lengths or fewer than two numbers, what
    is not finite, weights that are not above 0, a deflection that is 0 everywhere, and a wavenumber that is none or of
    which x spans less than half a wave or more than 10 000 of them. Places may stand in any order.
    """
    at, seen = in_a_row("x", x, "metres"), complex_array("deflection", deflection, "metres")
    counted = np.ones(len(at)) if weights is None else in_a_row("weights", weights, "what each point counts")
    if len(at) < 2 or seen.shape != at.shape or counted.shape != at.shape:
        raise InputError(
            f"x, deflection and weights have the shapes {at.shape}, {seen.shape} and {counted.shape}: give two or more "
            "numbers in a row, as many of each"
        )
    if not (np.isfinite(at).all() and np.isfinite(seen).all() and np.isfinite(counted).all() and (counted > 0).all()):
        raise InputError("x, deflection and weights have to be finite and weights above 0: leave out what is not")
    if not seen.any():
        raise zero_field()
    span = (float(at.min()), float(at.max()))
    return _fitted(at, seen, stated_wavenumber("k", k, span), counted)


def _fitted(x: Array, deflection: ComplexArray, k: complex, weights: Array) -> TwoWaves:
    """The same of what is known to fit."""
    root, middle = np.sqrt(weights), 0.5 * float(x.min() + x.max())
    basis, values = wave_basis(x, k, middle) * root[:, None], deflection * root
    amplitudes = np.linalg.lstsq(basis, values, rcond=None)[0]
    rest = np.linalg.norm(values - basis @ amplitudes) / np.linalg.norm(values)
    return TwoWaves(
        wavenumber=complex(k), forward=complex(amplitudes[0]), backward=complex(amplitudes[1]), residual=float(rest)
    )


def zero_field() -> NoFigureError:
    """The refusal of a field in which nothing moves."""
    return NoFigureError(
        "the field is zero in the window: drive.force acts on a support or has no amplitude, move it or give it one"
    )


def fitted_wavenumber(x: Array, deflection: ComplexArray, start: complex, weights: Array | None = None) -> complex:
    """The wavenumber near `start` (within 4 %, the same phase) that leaves the least residual.

    Raises InputError where the residual still falls at the edge of the search.
    """
    halves, weights = float(x[-1] - x[0]) * start.real / np.pi, np.ones(len(x)) if weights is None else weights
    grid = np.linspace(1.0 - REACH, 1.0 + REACH, 2 * int(np.ceil(4.0 * REACH * halves)) + 9)
    least = least_over(
        lambda factors: np.array([_fitted(x, deflection, complex(f * start), weights).residual for f in factors]),
        grid,
        1e-10,
    )
    if least.at_edge:
        raise InputError(
            f"the fitted wavenumber ends at the edge of its search, {least.x * start.real:.6g} 1/m, {REACH:.0%} from "
            f"the beam's {start.real:.6g} 1/m: state the wavenumber, two waves near the beam's are not there"
        )
    return complex(least.x * start)


def sample_points(window: tuple[float, float], k: float) -> Array:
    """Evenly spaced points of a window to draw from, its ends included, 24 for each half wavelength."""
    halves = (window[1] - window[0]) * k / np.pi
    return np.linspace(window[0], window[1], int(np.ceil(SHARPNESS * halves)) + 1)


def window_rule(window: tuple[float, float], k: float) -> Rule:
    """Where and with what weight a field is fitted: a quadrature, so that the fit is one over the whole window."""
    return rule_over(
        (float(window[0]), float(window[1])), max(int(np.ceil(2.0 * (window[1] - window[0]) * k / np.pi)), 1)
    )
