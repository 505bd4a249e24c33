"""Actuators on a driven beam: superposition of the fields of their mechanical ports at one frequency.

Each port, a force at a point or the pair of moments at the ends of a patch, has a field of the beam under its unit
load. These fields have the mobilities M between the ports, v = v0 + M F, where v0 is due to other loads. The electrical
condition reduces a two-port F = B V - Z v, I = Y V + B v to F = F0 - Z_e v:

    voltage V:  F0 = B V,      Z_e = Z
    current I:  F0 = (B/Y) I,  Z_e = Z + B^2/Y
    load Y_el:  F0 = 0,        Z_e = Z + B^2/(Y + Y_el)

hence (1 + Z_e M) F = F0 - Z_e v0. A very stiff actuator imposes the displacement; its velocity, a difference of large
terms, loses as many digits as Z_e M has.
"""

from collections.abc import Callable, Sequence
from math import pi
from typing import Any

import msgspec
import numpy as np
from msgspec.structs import asdict, replace

from verify.actuators.patch import Patch
from verify.actuators.port import Actuator, Port
from verify.actuators.shunt import Load
from verify.errors import InputError, ResonanceError
from verify.formatting import one_line
from verify.linear.base import BeamModel, Devices
from verify.linear.field import HarmonicField, combined, phasor, point_force
from verify.linear.positions import Loads, frequencies_on, loads_on
from verify.problem.beam import Beam, PointForce, PointLoad, PointMoment
from verify.problem.device import Device
from verify.problem.point_attachments import PointMass, PointSpring
from verify.problem.supports import FIXED, check_free
from verify.validation import as_tuple, check_position

QUASI_STATIC = 0.05  # Largest relative error of an actuator's reduction to a spring and a mass


class Mounted(msgspec.Struct, frozen=True, kw_only=True):
    """An actuator on a beam, with one electrical condition: a voltage, a current (0: open electrodes) or a load.

    A voltage with a load is that of a source behind the load, in series.
    """

    actuator: Actuator
    position: float
    """Of its tip, or of the middle of a patch, m from the left end."""
    voltage: complex | None = None
    """Amplitude, V; 0: short-circuited electrodes."""
    current: complex | None = None
    """Amplitude of the current into the actuator, A."""
    load: Load | None = None
    """Electrical load."""

    def __post_init__(self) -> None:
        given = [one is not None for one in (self.voltage, self.current, self.load)]
        if sum(given) != 1 and given != [True, False, True]:
            only = "one of voltage, current and load, or voltage and load"
            raise InputError(f"actuator at position = {self.position!r} m: give {only}")

    def loads(self, beam: Beam) -> tuple[PointLoad, ...]:
        """The load of its mechanical port for F = 1. Raises InputError off the beam, and at a fixed point of it."""
        if not isinstance(self.actuator, Patch):
            check_position("actuator.position", self.position, beam.length)
            check_free("actuator", self.position, beam.length, beam.supports, {"force": 1.0})
            return (PointForce(position=self.position),)
        half = 0.5 * self.actuator.length
        ends = {1.0: self.position + half, -1.0: self.position - half}
        for end in ends.values():
            check_position("actuator.position, an end of the patch,", end, beam.length)
        # a moment at a clamped or guided end of the beam, which does not turn, has no effect
        still = [x for x, name in zip((0.0, beam.length), beam.supports, strict=True) if FIXED[name].rotation]
        return tuple(
            PointMoment(position=end, amplitude=sign)
            for sign, end in ends.items()
            if all(abs(end - x) > 1e-9 * beam.length for x in still)
        )

    def source(self, port: Port, omega: float) -> tuple[complex, complex]:
        """(F0, Z_e) of F = F0 - Z_e v."""
        factor: Any = port.force_factor
        if self.voltage is not None and self.load is None:
            return factor * self.voltage, complex(port.short_impedance)
        current, load = self.feed(omega)
        return factor / (port.blocked_admittance + load) * current, port.loaded_impedance(load)

    def feed(self, omega: float) -> tuple[complex, complex]:
        """(current of a source in parallel, A, admittance of the load, S) of all conditions but a voltage alone."""
        load = 0.0 if self.load is None else complex(self.load.admittance(omega))
        return (load * self.voltage if self.voltage is not None else self.current or 0.0), load


class ActuatorState(msgspec.Struct, frozen=True, kw_only=True):
    """Complex amplitudes at the ports of an actuator, and its mean powers."""

    voltage: complex
    """V."""
    current: complex
    """A, into the actuator."""
    force: complex
    """N on the beam; N m of a patch."""
    velocity: complex
    """m/s of the beam; rad/s of a patch."""
    power_in: float
    """Electrical power, W; negative where the actuator returns power."""
    power_out: float
    """Mechanical power to the beam, W; negative where the beam drives the actuator."""
    loss: float
    """W, by the losses of the ports; power_in = power_out + loss."""


class ActuatedBeam(msgspec.Struct, frozen=True, eq=False, kw_only=True):
    """A beam with actuators in its steady state."""

    field: HarmonicField
    actuators: tuple[ActuatorState, ...]
    __repr__ = one_line(field="", actuators="")


def on_beam(
    model: BeamModel,
    actuators: Mounted | Sequence[Mounted],
    frequency_hz: float,
    *,
    forces: Loads = (),
    devices: Devices = (),
    modal_damping: float = 0.0,
) -> ActuatedBeam:
    """The steady field of a beam with actuators, under other harmonic loads and with passive devices.

    `modal_damping` as in `BeamModel.harmonic`. Raises InputError for an actuator off the beam, two at one place or an
    active device, and ResonanceError at an undamped resonance of the beam without its actuators.
    """
    mounted = as_tuple("actuators", actuators, Mounted)
    return responder(model, mounted, frequency_hz, forces, devices, modal_damping)(mounted)


def responder(
    model: BeamModel,
    mounted: Sequence[Mounted],
    frequency_hz: float,
    forces: Loads = (),
    devices: Devices = (),
    modal_damping: float = 0.0,
) -> Callable[[Sequence[Mounted]], ActuatedBeam]:
    """The steady field by the electrical conditions of the actuators, which leave the unit fields as they are."""
    others = loads_on(model.beam, forces, PointLoad)
    passive = as_tuple("devices", devices, Device)
    if any(device.amplitude for device in passive):
        raise InputError("devices: a device beside actuators has no force of its own, give a PointForce")
    loads = [one.loads(model.beam) for one in mounted]
    if len(set(loads)) < len(loads):
        raise InputError("actuators: two are at one position, move one")
    omega = 2.0 * pi * float(frequencies_on(model.beam, frequency_hz)[0])
    # one model for all fields, so that its displacements are reciprocal, with nodes of elements at all ports
    cut = model.cut_at([one.position for load in loads for one in load])
    cut = cut.cut_at(one.position for one in others if isinstance(one, PointMoment))

    def field(load: tuple[PointLoad, ...]) -> HarmonicField:
        # the weights of a transverse port are those of a device, which include the beam's compliance at its own place
        own = [Device(position=one.position, amplitude=1.0) for one in load if isinstance(one, PointForce)]
        turning = [one for one in load if isinstance(one, PointMoment)]
        return cut.harmonic(turning, frequency_hz, devices=(*passive, *own), modal_damping=modal_damping)

    try:
        units = [field(load) for load in loads]
        rest = [cut.harmonic(others, frequency_hz, devices=passive, modal_damping=modal_damping)] if others else []
    except ResonanceError as error:
        raise ResonanceError(
            f"{error}; the fields of actuators are superposed on the beam without them, whose resonance this is"
        ) from None
    fields = (*units, *rest)
    moved = np.array([[sum(one.amplitude * f.displacement(one) for one in load) for f in fields] for load in loads])
    moved = moved * 1j * omega
    p, ports = len(loads), [one.actuator.port(omega) for one in mounted]
    free = moved[:, p] if rest else np.zeros(p)

    def respond(mounted: Sequence[Mounted]) -> ActuatedBeam:
        blocked, impedance = np.array([one.source(port, omega) for one, port in zip(mounted, ports, strict=True)]).T
        applied = np.linalg.solve(np.eye(p) + impedance[:, None] * moved[:, :p], blocked - impedance * free)
        velocity = free + moved[:, :p] @ applied
        parts = [*zip(applied.tolist(), units, strict=True), *((1.0, one) for one in rest)]
        whole, sums = combined(parts), dict[float, complex]()
        for weight, one in parts:
            for force in one.forces:
                sums[force.position] = sums.get(force.position, 0.0) + weight * phasor(force)
        whole = replace(
            whole,
            beam=model.beam,
            forces=tuple(point_force(at, value) for at, value in sums.items()),
            couples=tuple(sorted({at for _, one in parts for at in one.couples})),
        )
        states = map(_state, mounted, ports, applied.tolist(), velocity.tolist(), [omega] * p)
        return ActuatedBeam(field=whole, actuators=tuple(states))

    return respond


def _state(mounted: Mounted, port: Port, force: complex, v: complex, omega: float) -> ActuatorState:
    b, y, z = (complex(one) for one in (port.force_factor, port.blocked_admittance, port.short_impedance))
    if mounted.voltage is None or mounted.load is not None:
        fed, load = mounted.feed(omega)
        voltage = (fed - b * v) / (y + load)
    else:
        voltage = complex(mounted.voltage)
    current = y * voltage + b * v if mounted.current is None else complex(mounted.current)
    # of a complex B a part of V and v is lost as well
    lost = y.real * abs(voltage) ** 2 + z.real * abs(v) ** 2 + 2.0 * b.imag * (voltage * np.conj(v)).imag
    return ActuatorState(
        voltage=voltage,
        current=current,
        force=force,
        velocity=v,
        power_in=float(0.5 * (voltage * np.conj(current)).real),
        power_out=float(0.5 * (force * np.conj(v)).real),
        loss=float(0.5 * lost),
    )


def as_moments(forces: Sequence[PointForce]) -> tuple[PointMoment, ...]:
    """Moments, N m, with the amplitudes of forces."""
    return tuple(PointMoment(**asdict(one)) for one in forces)


class QuasiStatic(Actuator, frozen=True, kw_only=True):
    """An actuator far below its resonance, whose spring and mass are part of the beam."""

    force_factor: float  # B, N/V
    capacitance: float  # C at rest, F

    def port(self, omega: Any) -> Port:
        """The port at angular frequencies omega (rad/s), a number or (n,)."""
        own = 1j * omega * self.capacitance
        return Port(force_factor=self.force_factor, short_impedance=0.0 * omega, blocked_admittance=own)


class BeamInTime(msgspec.Struct, frozen=True, kw_only=True):
    """A beam and its loads in time that are equivalent to a drive."""

    beam: Beam
    loads: tuple[PointLoad, ...]
    circuits: tuple[Mounted, ...] = ()
    """Actuators with electrical loads, whose springs and masses are part of the beam."""
    error: float = 0.0
    """Relative error of an actuator's dynamic stiffness as a spring and a mass, its losses included."""


def beam_in_time(
    beam: Beam,
    kind: str,
    forces: Sequence[PointForce],
    actuator: Actuator | None,
    frequency_hz: float,
    shunts: Sequence[tuple[float, Load]] = (),
) -> BeamInTime:
    """The beam, loads and circuits that are equivalent to a drive of a kind in time; `forces` have its amplitudes.

    Far below its resonance an actuator is a spring and a mass (of a slender bar a third of its own), the coefficients
    of i omega Z_e in powers of omega^2; a current sees the stiffness of open electrodes. A patch is a part of the
    section. Force factors and capacitances are those of the steady state. `shunts` are (position, m, load) of passive
    actuators. Raises InputError for displacements, the current of a patch, and an error of the reduction above
    `QUASI_STATIC`, losses of the actuator included.
    """
    if kind == "displacement" or (kind == "current" and isinstance(actuator, Patch)):
        what = "displacements" if kind == "displacement" else "currents of a patch"
        raise InputError(f"drive.kind = {kind!r}: a beam moves in time under no {what}, give 'force' or 'voltage'")
    driven = tuple(forces) if kind in ("voltage", "current") else ()
    loads: tuple[PointLoad, ...] = () if driven else as_moments(forces) if kind == "moment" else tuple(forces)
    if actuator is None or not (driven or shunts):
        return BeamInTime(beam=beam, loads=loads)
    omega = 2.0 * pi * frequency_hz
    if isinstance(actuator, Patch):
        whole = actuator.on(beam, [*(one.position for one in driven), *(x for x, _ in shunts)])
        patch = actuator.bonded(beam)
        volts = patch.moment_per_volt
        pairs = [
            replace(pair, amplitude=volts * one.amplitude * pair.amplitude, phase_deg=one.phase_deg)
            for one in driven
            for pair in Mounted(actuator=patch, position=one.position, current=0.0).loads(whole)
        ]
        circuits = tuple(Mounted(actuator=patch, position=x, load=load) for x, load in shunts)
        return BeamInTime(beam=whole, loads=(*loads, *pairs), circuits=circuits)
    port, worst = actuator.port(omega), 0.0
    places = [(one.position, kind == "current") for one in driven] + [(x, False) for x, _ in shunts]
    for x, opened in dict.fromkeys(places):
        stiffness, mass, error = _spring_and_mass(actuator, omega, opened)
        worst = max(worst, error)
        if error > QUASI_STATIC or stiffness < 0.0 or mass < 0.0:
            raise InputError(
                f"drive.actuator: in time it is a spring and a mass, which at {frequency_hz:g} Hz errs by {error:.2g} "
                f"(at most {QUASI_STATIC:g}): drive it far below its resonance, or use a quantity of the steady wave"
            )
        springs = (PointSpring(position=x, stiffness=stiffness),) if stiffness else ()
        body = PointMass(position=x, mass=mass)
        beam = replace(beam, spring=(*beam.spring, *springs), mass=(*beam.mass, body))
    factor = complex(port.force_factor / (port.blocked_admittance if kind == "current" else 1.0))
    capacitance = (complex(port.blocked_admittance) / (1j * omega)).real
    own = QuasiStatic(force_factor=complex(port.force_factor).real, capacitance=capacitance)
    return BeamInTime(
        beam=beam,
        loads=(*loads, *(point_force(one.position, factor * phasor(one)) for one in driven)),
        circuits=tuple(Mounted(actuator=own, position=x, load=load) for x, load in shunts),
        error=worst,
    )


def _spring_and_mass(actuator: Actuator, omega: float, opened: bool) -> tuple[float, float, float]:
    """(stiffness, N/m; mass, kg; relative error of their dynamic stiffness at omega), electrodes open or closed."""

    def dynamic(at: Any) -> Any:
        port = actuator.port(at)
        return 1j * at * (port.loaded_impedance() if opened else port.short_impedance)

    at = omega
    while True:
        steps = at * np.array([0.1, 0.2, 0.3])
        terms = np.vander((steps / at) ** 2, increasing=True)
        stiffness, inertia, _ = np.linalg.solve(terms, dynamic(steps).real).tolist()
        if abs(inertia) > 1e-6 * abs(stiffness):
            break
        at *= 10.0  # far below the resonance the mass is lost in rounding
    if abs(stiffness) < 1e-6 * abs(inertia):  # on a free base
        stiffness = 0.0
    mass, exact = -inertia / at**2, complex(dynamic(np.array([omega]))[0])
    return stiffness, mass, abs(exact - (stiffness - mass * omega**2)) / abs(exact)
