"""A driven beam: model, drive and devices; superposition of the waves of its actuators."""

from collections.abc import Iterator, Sequence
from contextlib import suppress
from typing import TYPE_CHECKING, Any

import msgspec
import numpy as np
from msgspec.structs import replace

from verify.actuators.on_beam import ActuatedBeam, Mounted, as_moments, on_beam, responder
from verify.actuators.port import Actuator
from verify.actuators.shunt import Load
from verify.arrays import Array, ComplexArray
from verify.errors import InputError, NoFigureError, ResonanceError
from verify.linear.base import BeamModel
from verify.linear.field import HarmonicField, phasor, unit_response, wavenumber
from verify.problem.beam import Beam, PointForce, PointLoad, PointMoment
from verify.problem.device import Device
from verify.waves.two_waves import ROUNDING, wave_basis, window_rule, zero_field
from verify.waves.window import Window, check_span, check_waves

if TYPE_CHECKING:
    from verify.analysis.solution_cache import SolutionCache


class DrivenCase(msgspec.Struct, frozen=True, kw_only=True):
    """One model under harmonic loads of one kind at one frequency, with devices and shunted actuators.

    Raises InputError for a device off the beam or on a support, for active devices with a drive of another kind than
    force, for shunts with imposed displacements, and for voltages or currents without an actuator.
    """

    model: BeamModel
    forces: tuple[PointForce, ...]  # Amplitudes in N, N m, m, V or A by `kind`
    frequency_hz: float
    kind: str = "force"
    devices: tuple[Device, ...] = ()
    actuator: Actuator | None = None  # Of voltages, currents and shunts; patches are part of the model's beam
    shunts: tuple[tuple[float, Load], ...] = ()  # (position, m, electrical load) of passive actuators

    def __post_init__(self) -> None:
        for device in self.devices:
            device.check_on("device", self.beam.length, self.beam.supports)
            if device.amplitude and self.kind != "force":
                raise InputError(f"drive.kind = {self.kind!r}: a device then has no force, leave its amplitude out")
        if self.shunts and self.kind == "displacement":
            raise InputError("drive.kind = 'displacement': shunts take another kind, give 'force' or 'voltage'")
        if self.actuator is None and (self.shunts or self.electrical):
            raise InputError(f"drive.kind = {self.kind!r}: it and shunts need a drive.actuator, give one, or 'force'")

    @property
    def electrical(self) -> bool:
        """Whether the amplitudes are voltages or currents."""
        return self.kind in ("voltage", "current")

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
        if self.kind == "displacement":
            return self.model.imposed(forces, frequency_hz, devices=self.passive)
        if self.electrical or self.shunts:
            return self.actuated(forces, frequency_hz).field
        return self.model.harmonic(self._loads(forces), frequency_hz, devices=self.passive)

    def actuated(self, forces: tuple[PointForce, ...], frequency_hz: float) -> ActuatedBeam:
        """The field and the ports of the actuators, driven ones first. Raises InputError."""
        mounted, loads = self._mounted(forces), self._loads(forces)
        return on_beam(self.model, mounted, frequency_hz, forces=loads, devices=self.passive)

    @property
    def places(self) -> tuple[tuple[float, ...], tuple[float, ...]]:
        """Positions of transverse forces, and of moments, of the drive, devices and shunts, m."""
        loads = [load for one in self._mounted(self.acting) for load in one.loads(self.beam)]
        loads += self._loads(self.acting)
        turning = [load.position for load in loads if isinstance(load, PointMoment)]
        across = [load.position for load in loads if isinstance(load, PointForce)]
        across += [device.position for device in self.passive if device.across]
        return tuple(across), (*turning, *(device.position for device in self.passive if device.turning))

    def units(self, frequency_hz: float) -> Iterator[HarmonicField]:
        """The fields under the unit amplitude of each force (displacement, voltage). Raises InputError."""
        at, own = [one.position for one in self.acting], np.eye(len(self.acting)).tolist()
        drives = [tuple(PointForce(position=x, amplitude=a) for x, a in zip(at, row, strict=True)) for row in own]
        if not self.electrical:
            yield from (self.field(forces, frequency_hz) for forces in drives)
            return
        self.model.check_propagates(frequency_hz)
        mounted = [self._mounted(forces) for forces in drives]
        respond = responder(self.model, mounted[0], frequency_hz, devices=self.passive)
        yield from (respond(one).field for one in mounted)

    def _loads(self, forces: Sequence[PointForce]) -> tuple[PointLoad, ...]:
        """The forces or moments of a drive without actuators."""
        return {"force": tuple(forces), "moment": as_moments(forces)}.get(self.kind, ())

    def _mounted(self, forces: Sequence[PointForce]) -> list[Mounted]:
        """Driven actuators, then those with an electrical load."""
        conditions: list[tuple[float, dict[str, Any]]] = [(x, {"load": load}) for x, load in self.shunts]
        if self.electrical:
            conditions = [*((one.position, {self.kind: phasor(one)}) for one in forces), *conditions]
        own: Any = self.actuator
        return [Mounted(actuator=own, position=x, **condition) for x, condition in conditions]

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
    return cache.once(("field", case), lambda: case.field(case.acting, case.frequency_hz))


class UnitWaves(msgspec.Struct, frozen=True, eq=False):
    """The two waves in a window per unit amplitude of each of n_a actuators, at n frequencies.

    NaN at a frequency without a fit: an undamped resonance, beyond the cut-off, or a window that is too short.
    """

    case: DrivenCase
    frequencies_hz: Array  # (n,)
    k: ComplexArray  # (n,), 1/m
    forward: ComplexArray  # A+ at the middle of the window, (n, n_a), m per unit of the drive's amplitudes
    backward: ComplexArray  # A- at the middle of the window, (n, n_a), m per unit of the drive's amplitudes
    missing: tuple[NoFigureError, ...]  # The reason for each frequency without waves

    def superposed(self, drives: ComplexArray) -> tuple[ComplexArray, ComplexArray]:
        """A+ and A- in m, (n, p) arrays, under p sets of complex amplitudes, (n_a, p) or (n, n_a, p).

        NaN where the motion is within rounding. Raises NoFigureError where it is at all frequencies.
        """
        scale = np.ones((len(self.k), 1))
        if self.case.kind == "force":
            scale[:, 0] = [unit_response(self.case.beam, float(f)) for f in self.frequencies_hz]
        elif self.case.kind != "displacement":  # on no support without effect
            scale[:, 0] = abs(np.concatenate([self.forward, self.backward], axis=1)).max(axis=1)
        forward, backward = ((wave[:, None, :] @ drives)[:, 0, :] for wave in (self.forward, self.backward))
        moves = np.maximum(abs(forward), abs(backward)) > ROUNDING * scale * abs(drives).sum(axis=-2)
        if not moves.any():
            raise self.missing[0] if self.missing else zero_field()
        return np.where(moves, forward, np.nan), np.where(moves, backward, np.nan)


def unit_waves(case: DrivenCase, frequencies_hz: Array, window: Window) -> UnitWaves:
    """Unit waves of a case's actuators, including active devices. Raises InputError for an invalid window."""
    beam, theory, highest = case.beam, case.model.theory, float(frequencies_hz.max())
    positions, (across, turning) = [force.position for force in case.acting], case.places
    check_span(beam, [*across, *positions], window, turning, theory)
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
    if case.kind == "force" and not case.passive and not case.shunts:
        return case.model.receptance(positions, frequencies_hz, x)
    found = np.full((len(frequencies_hz), len(positions), len(x)), np.nan, dtype=complex)
    # cut here, one system serves all frequencies
    ports = [load.position for one in case._mounted(case.acting) for load in one.loads(case.beam)]
    case = replace(case, model=case.model.cut_at([*ports, *case.places[1]]))
    for i, hertz in enumerate(frequencies_hz.tolist()):
        with suppress(NoFigureError):
            for j, field in enumerate(case.units(hertz)):
                found[i, j] = field.deflection(x)
    return found
