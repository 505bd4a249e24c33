"""Any model's harmonic field of a beam with devices on it, from that model's own answers.

Across, a device pulls with its impedance times the speed of its place. What all pull, and what the beam then does
there, is a small linear system of the beam's answers to a unit force at each place, read apart where the beam alone
resonates (`poles`).

Against turning no model is asked for a couple. A spring kappa there makes w = w_0 - (kappa - kappa_0) theta C_0, where
C_0 is the answer to a couple beside a spring kappa_0, and theta = theta_0 / (1 + (kappa - kappa_0) G) the turn. So

    w(kappa) = w_0 + (kappa - kappa_0) / (1 + (kappa - kappa_0) G) (w_1 - w_0) (1 + a G) / a,  a = kappa_1 - kappa_0,

of which a third spring tells G. It holds for complex kappa = i omega Z as well: three springs that a model knows say
what any device does on it, felt as it feels springs, without a reading of its slope.
"""

from collections.abc import Callable, Sequence
from contextlib import suppress
from typing import TypeAlias

import numpy as np
from msgspec.structs import replace

from verify.arrays import ComplexArray
from verify.checks import check_kind, check_number, several
from verify.errors import InputError, ResonanceError, shown
from verify.linear.fields import RESONANCE, HarmonicField, combined, phasor, unit_response, wavenumber
from verify.linear.places import Forces, as_forces, as_typed
from verify.problem.beam import Beam, PointForce, check_frequency
from verify.problem.device import Device
from verify.problem.point_attachments import PointSpring
from verify.waves.cancelled import check_kept
from verify.waves.imposed import Solve
from verify.waves.poles import Conditions, UnsettledError, field_at_pole, is_near, is_resonant, looked_at


class DevicesResonanceError(ResonanceError):
    """An undamped beam is driven at a resonance that it has with its devices."""


SolveOn: TypeAlias = Callable[[Beam, Sequence[PointForce], float], HarmonicField]
"""A model's field of a beam under forces at a frequency."""

_TRIED = ((1.0, 3.0, 0.3), (0.7, 2.2, 0.2))
"""Springs against turning, in EI k: others where one makes a resonance."""
_ASIDE = 0.8
"""Of 1/k: from a held place so far inwards a force turns it."""
_SLOWEST = 1e-200
"""Hz: what a spring pulls at, over its velocity, is a number."""
_LOOKED_AT = 97
"""Places at which two fields are held against each other."""


@as_typed
def field_with_devices(
    solve: SolveOn, beam: Beam, forces: Forces, frequency_hz: float, devices: Device | Sequence[Device]
) -> HarmonicField:
    """The field under forces with devices on the beam; its forces are what acts across beside what resists turning.

    `solve` is a model's: (beam, forces, hertz) -> its field, such as `analytic_modes.solve_harmonic`. Raises
    InputError for a device off the beam or on a support that makes it idle, and where nothing drives the beam.
    """
    if not callable(solve):
        raise InputError(f"solve = {shown(solve)}: give a model's solve, such as analytic_modes.solve_harmonic")
    check_kind("beam", beam, Beam)
    check_frequency("frequency_hz", frequency_hz, beam)
    check_number("frequency_hz", frequency_hz, "hertz, on a beam with devices", at_least=_SLOWEST)
    forces, devices = as_forces(forces), several("devices", devices, Device)
    for device in devices:
        device.check_on(beam)
    acting = [*forces, *(_own_force(device) for device in devices if device.amplitude)]
    if not acting:
        raise InputError("forces is empty and no device has an amplitude: give a PointForce, or a device a force")

    def alone(acts: Sequence[PointForce], frequency: float) -> HarmonicField:
        return _turned(solve, devices, frequency)(beam, acts, frequency)

    across = [device for device in devices if device.impedance(2.0 * np.pi * frequency_hz) != 0.0]
    if not across and not any(device.turning for device in devices):
        return alone(acting, frequency_hz)
    loads = [acting, *([PointForce(position=device.position)] for device in across)]

    def at_pole() -> HarmonicField:
        return _at_pole(alone, loads, devices, across, frequency_hz)

    try:
        fields = [alone(load, frequency_hz) for load in loads]
    except ResonanceError:  # of the beam alone, of which that with devices knows nothing
        with suppress(UnsettledError):
            return at_pole()
        raise
    places = np.array([device.position for device in across])
    seen, unit = looked_at(places, beam), unit_response(beam, frequency_hz)
    read = [field.shapes(seen, 0) for field in fields]
    newtons = [sum(abs(force.amplitude) for force in load) for load in loads]
    if is_near(read, newtons, unit, beam, frequency_hz):
        with suppress(UnsettledError):
            return at_pole()
    at = np.array(read)[:, : len(places)]
    pulls = _pulls(at, places.tolist(), _conditions(across, frequency_hz).take, unit, frequency_hz)
    check_kept([1.0, *pulls], read, newtons, unit, frequency_hz)
    found = combined(list(zip([1.0, *pulls], fields, strict=True)))
    return replace(found, forces=(*fields[0].forces, *_reactions(across, pulls)))


def _turned(solve: SolveOn, devices: Sequence[Device], frequency_hz: float) -> SolveOn:
    """A model's fields with what resists turning at a frequency."""
    omega = 2.0 * np.pi * frequency_hz
    for device in devices:
        if (z := device.turning_impedance(omega)) != 0.0:
            solve = _with_turning(solve, device.position, 1j * omega * z)
    return solve


def _conditions(across: Sequence[Device], frequency_hz: float) -> Conditions:
    """Of devices that pull with i omega Z for every metre."""
    omega = 2.0 * np.pi * frequency_hz
    take = 1j * omega * np.array([device.impedance(omega) for device in across], dtype=complex)
    return Conditions(np.ones(len(across), dtype=complex), take, np.zeros((len(across), 1), dtype=complex))


def _at_pole(
    alone: Solve,
    loads: Sequence[Sequence[PointForce]],
    devices: Sequence[Device],
    across: Sequence[Device],
    frequency_hz: float,
) -> HarmonicField:
    """The same at a resonance of the beam alone, or next to one. Raises DevicesResonanceError, UnsettledError."""

    def check(beam: Beam, distance: complex, singular: bool) -> None:
        if singular or is_resonant(beam, distance):
            raise _resonant(frequency_hz, [device.position for device in devices]) from None

    field, pulls = field_at_pole(alone, loads, lambda f: _conditions(across, f), frequency_hz, check)
    return replace(field, forces=(*loads[0], *_reactions(across, pulls.tolist())))


def _reactions(across: Sequence[Device], pulls: Sequence[complex]) -> list[PointForce]:
    return [force_of(device.position, pull) for device, pull in zip(across, pulls, strict=True)]


def _resonant(frequency_hz: float, places: list[float]) -> DevicesResonanceError:
    return DevicesResonanceError(
        f"frequency_hz = {frequency_hz!r} is an undamped resonance of the beam with devices at {places} m: "
        "give a device a dashpot or choose another frequency"
    )


def _pulls(
    read: ComplexArray, places: list[float], turned: ComplexArray, unit: float, frequency_hz: float
) -> list[complex]:
    """Forces of devices on the beam, newton: r = -i omega Z (free + units r), each read at its place, (1 + n, n)."""
    if not places:
        return []
    free, own = read[0], read[1:].T
    matrix = np.eye(len(places)) + turned[:, None] * own
    scaled = matrix / (1.0 + unit * abs(turned))[:, None]
    least = abs(scaled[0, 0]) if len(places) == 1 else np.linalg.svd(scaled, compute_uv=False)[-1]
    if least < RESONANCE * max(abs(scaled).max(), 1.0):
        raise _resonant(frequency_hz, places)
    return [complex(pull) for pull in np.linalg.solve(matrix, -turned * free)]


def _own_force(device: Device) -> PointForce:
    return PointForce(position=device.position, amplitude=device.amplitude, phase_deg=device.phase_deg)


def force_of(position: float, pull: complex) -> PointForce:
    """A phasor as a force."""
    return PointForce(position=position, amplitude=float(abs(pull)), phase_deg=float(np.rad2deg(np.angle(pull))))


def _with_turning(solve: SolveOn, position: float, stiffness: complex) -> SolveOn:
    """The same model's fields with a complex spring against turning at a place, N m/rad (see above)."""

    def solved(beam: Beam, forces: Sequence[PointForce], frequency_hz: float) -> HarmonicField:
        for shares in _TRIED:
            try:
                return _by_three_springs(solve, beam, forces, frequency_hz, position, stiffness, shares)
            except ResonanceError:
                if shares == _TRIED[-1]:
                    raise
        raise AssertionError

    return solved


def _by_three_springs(
    solve: SolveOn,
    beam: Beam,
    forces: Sequence[PointForce],
    frequency_hz: float,
    position: float,
    stiffness: complex,
    shares: tuple[float, ...],
) -> HarmonicField:
    k = abs(wavenumber(beam, frequency_hz))
    springs = [share * beam.bending_stiffness * k for share in shares]
    inwards = 1.0 if position < 0.5 * beam.length else -1.0
    probe = [PointForce(position=position + inwards * min(_ASIDE / k, 0.3 * beam.length))]
    x = np.linspace(0.0, beam.length, _LOOKED_AT)
    seen = [solve(_sprung(beam, position, spring), probe, frequency_hz).shapes(x, 0) for spring in springs]
    a, b = springs[1] - springs[0], springs[2] - springs[0]
    ratio = np.vdot(seen[2] - seen[0], seen[1] - seen[0]) / np.vdot(seen[2] - seen[0], seen[2] - seen[0])
    give = (a - ratio * b) / (a * b * (ratio - 1.0))
    first, second = (solve(_sprung(beam, position, spring), forces, frequency_hz) for spring in springs[:2])
    more = stiffness - springs[0]
    share = complex(more / (1.0 + more * give) * (1.0 + a * give) / a)
    found = combined([(1.0 - share, first), (share, second)])
    return replace(found, beam=beam, turning_held=(*first.turning_held, position))


def _sprung(beam: Beam, position: float, rotational: float) -> Beam:
    return replace(beam, spring=(*beam.spring, PointSpring(position=position, rotational=rotational)))


def powers(field: HarmonicField, forces: Sequence[PointForce]) -> tuple[float, ...]:
    """The mean power that each force gives the beam, watt: 1/2 Re(F conj(v))."""
    speeds = 1j * field.omega * field.shapes(np.array([force.position for force in forces]), 0)
    return tuple(float(0.5 * (phasor(force) * np.conj(v)).real) for force, v in zip(forces, speeds, strict=True))
