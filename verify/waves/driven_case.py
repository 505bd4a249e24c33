"""A driven beam: model, drive and devices; superposition of the waves of its actuators."""

from typing import TYPE_CHECKING

import msgspec
import numpy as np
from msgspec.structs import replace

from verify.arrays import Array, ComplexArray
from verify.errors import InputError, NoFigureError, ResonanceError
from verify.linear.base import BeamModel
from verify.linear.field import HarmonicField, unit_response, wavenumber
from verify.problem.beam import Beam, PointForce
from verify.problem.device import Device
from verify.waves.two_waves import ROUNDING, wave_basis, window_rule, zero_field
from verify.waves.window import Window, check_span, check_waves

if TYPE_CHECKING:
    from verify.analysis.solution_cache import SolutionCache


class DrivenCase(msgspec.Struct, frozen=True, kw_only=True):
    """One model under harmonic forces, or imposed displacements, at one frequency.

    Raises InputError for a device off the beam or on a support, and for active devices with imposed displacements.
    """

    model: BeamModel
    forces: tuple[PointForce, ...]
    """Amplitudes in N, or in m where `kind` is displacement."""
    frequency_hz: float
    kind: str = "force"
    devices: tuple[Device, ...] = ()

    def __post_init__(self) -> None:
        for device in self.devices:
            device.check_on(self.beam)
            if device.amplitude and self.kind != "force":
                raise InputError(
                    f"drive.kind = {self.kind!r}: a device has no force under imposed displacements, leave "
                    "drive.device.amplitude out"
                )

    @property
    def beam(self) -> Beam:
        """Beam of the model."""
        return self.model.beam

    @property
    def acting(self) -> tuple[PointForce, ...]:
        """All forces, including those of active devices."""
        return (*self.forces, *(device.own_force for device in self.devices if device.amplitude))

    @property
    def passive(self) -> tuple[Device, ...]:
        """The devices with zero blocked force."""
        return tuple(replace(d, amplitude=0.0) for d in self.devices if d.turning or d.stiffness or d.mass or d.dashpot)

    def field(self, forces: tuple[PointForce, ...], frequency_hz: float) -> HarmonicField:
        """The field under other forces (displacements) at another frequency. Raises InputError."""
        self.model.check_propagates(frequency_hz)
        solve = self.model.harmonic if self.kind == "force" else self.model.imposed
        return solve(forces, frequency_hz, devices=self.passive)

    def wavenumber(self, frequency_hz: float) -> complex:
        """Wavenumber in the model, 1/m: by its discrete dispersion if known, else that of the beam.

        Raises NoFigureError above the cut-off frequency.
        """
        self.model.check_propagates(frequency_hz)
        if self.beam.section:
            return wavenumber(self.beam, frequency_hz, self.model.theory)
        return self.model.wavenumber(frequency_hz)


def driven(case: DrivenCase, cache: "SolutionCache") -> HarmonicField:
    """The field of a case, computed once per cache. Raises InputError."""
    if case not in cache.fields:
        cache.fields[case] = case.field(case.acting, case.frequency_hz)
    return cache.fields[case]


class UnitWaves(msgspec.Struct, frozen=True, eq=False):
    """The two waves in a window per unit force (displacement) of each of n_a actuators, at n frequencies.

    NaN at a frequency without a fit: an undamped resonance, beyond the cut-off, or a window that is too short.
    """

    case: DrivenCase
    frequencies_hz: Array
    """(n,)."""
    k: ComplexArray
    """(n,), 1/m."""
    forward: ComplexArray
    """A+ at the middle of the window, (n, n_a), m/N or m/m."""
    backward: ComplexArray
    """A- at the middle of the window, (n, n_a), m/N or m/m."""
    missing: tuple[NoFigureError, ...]
    """The reason for each frequency without waves."""

    def superposed(self, drives: ComplexArray) -> tuple[ComplexArray, ComplexArray]:
        """A+ and A- in m, (n, p) arrays, under p sets of complex amplitudes, (n_a, p) or (n, n_a, p).

        NaN where the motion is within rounding. Raises NoFigureError where it is at all frequencies.
        """
        scale = np.ones((len(self.k), 1))
        if self.case.kind == "force":
            scale[:, 0] = [unit_response(self.case.beam, float(f)) for f in self.frequencies_hz]
        forward, backward = ((wave[:, None, :] @ drives)[:, 0, :] for wave in (self.forward, self.backward))
        moves = np.maximum(abs(forward), abs(backward)) > ROUNDING * scale * abs(drives).sum(axis=-2)
        if not moves.any():
            raise self.missing[0] if self.missing else zero_field()
        return np.where(moves, forward, np.nan), np.where(moves, backward, np.nan)


def unit_waves(case: DrivenCase, frequencies_hz: Array, window: Window) -> UnitWaves:
    """Unit waves of a case's actuators, including active devices. Raises InputError for an invalid window."""
    beam, theory, highest = case.beam, case.model.theory, float(frequencies_hz.max())
    positions, couples = [force.position for force in case.acting], [d.position for d in case.passive if d.turning]
    check_span(beam, [*positions, *(d.position for d in case.passive if d.across)], window, couples, theory)
    rule = window_rule(window, wavenumber(beam, highest, theory).real)
    responses = _unit_responses(case, frequencies_hz, positions, rule.x)
    k, missing = np.full(len(frequencies_hz), np.nan, dtype=complex), list[NoFigureError]()
    for i, hertz in enumerate(frequencies_hz.tolist()):
        try:
            check_waves(beam, hertz, window, theory)
            own = case.wavenumber(hertz)
            if not np.isfinite(responses[i]).all():
                fixed = " fixed at its actuators" if case.kind == "displacement" else ""
                raise ResonanceError(
                    f"frequency_hz = {hertz!r} is an undamped resonance of the {case.model.name} model{fixed}: give "
                    "the beam a loss_factor or choose another frequency"
                )
            k[i] = own
        except NoFigureError as error:
            missing.append(error)
    waves, known = np.full((len(k), 2, len(positions)), np.nan, dtype=complex), np.isfinite(k)
    basis = wave_basis(rule.x, k[known], 0.5 * sum(window))  # amplitudes at the middle
    adjoint = np.conj(np.swapaxes(basis, 1, 2)) * rule.weights
    waves[known] = np.linalg.solve(adjoint @ basis, adjoint @ np.swapaxes(responses[known], 1, 2))
    forward, backward = waves[:, 0], waves[:, 1]
    return UnitWaves(case, frequencies_hz, k, forward, backward, tuple(missing))


def _unit_responses(case: DrivenCase, frequencies_hz: Array, positions: list[float], x: Array) -> ComplexArray:
    """Deflection at x, (n, n_a, len(x)), per unit force, or displacement with all others zero; NaN at resonances."""
    if case.kind == "force" and not case.passive:
        return case.model.receptance(positions, frequencies_hz, x)
    responses = np.full((len(frequencies_hz), len(positions), len(x)), np.nan, dtype=complex)
    for i, hertz in enumerate(frequencies_hz.tolist()):
        for j in range(len(positions)):
            units = tuple(PointForce(position=p, amplitude=float(m == j)) for m, p in enumerate(positions))
            try:
                responses[i, j] = case.field(units, hertz).deflection(x)
            except NoFigureError:
                break
    return responses
