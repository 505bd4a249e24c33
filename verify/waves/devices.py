"""Any model's harmonic field of a beam with devices on it, from that model's own answers.

Across, a device pulls with its impedance times the speed of its place. What all pull, and what the beam then does
there, is a small linear system of the beam's answers to a unit force at each place.

Against turning no model is asked for a couple. A spring kappa there makes w = w_0 - (kappa - kappa_0) theta C_0, where
C_0 is the answer to a couple beside a spring kappa_0, and theta = theta_0 / (1 + (kappa - kappa_0) G) the turn. So

    w(kappa) = w_0 + (kappa - kappa_0) / (1 + (kappa - kappa_0) G) (w_1 - w_0) (1 + a G) / a,  a = kappa_1 - kappa_0,

of which a third spring tells G. It holds for complex kappa = i omega Z as well: three springs that a model knows say
what any device does on it, felt as it feels springs, without a reading of its slope.
"""

from collections.abc import Callable, Sequence
from typing import TypeAlias

import numpy as np
from msgspec.structs import replace

from verify.attached import PointSpring
from verify.beam import Beam, PointForce
from verify.checks import several
from verify.device import Device
from verify.errors import InputError, ResonanceError
from verify.models.arrays import ComplexArray
from verify.models.fields import RESONANCE, HarmonicField, combined, phasor, wavenumber
from verify.models.places import Forces, as_forces
from verify.waves.imposed import AROUND, STEP


class DevicesResonanceError(ResonanceError):
    """An undamped beam is driven at a resonance that it has with its devices."""


SolveOn: TypeAlias = Callable[[Beam, Sequence[PointForce], float], HarmonicField]
"""A model's field of a beam under forces at a frequency."""

_TRIED = ((1.0, 3.0, 0.3), (0.7, 2.2, 0.2))
"""Springs against turning, in EI k: others where one makes a resonance."""
_ASIDE = 0.8
"""Of 1/k: from a held place so far inwards a force turns it."""
_LOOKED_AT = 97
"""Places at which two fields are held against each other."""


def field_with_devices(
    solve: SolveOn, beam: Beam, forces: Forces, frequency_hz: float, devices: Device | Sequence[Device]
) -> HarmonicField:
    """The field under forces with devices on the beam; its forces are what acts across beside what resists turning.

    `solve` is a model's: (beam, forces, hertz) -> its field, such as `analytic_modes.solve_harmonic`. Raises
    InputError for a device off the beam or on a support that makes it idle, and where nothing drives the beam.
    """
    forces, devices = as_forces(forces), several("devices", devices, Device)
    for device in devices:
        device.check_on(beam)
    acting = [*forces, *(_own_force(device) for device in devices if device.amplitude)]
    if not acting:
        raise InputError("forces is empty and no device has an amplitude: give a PointForce, or a device a force")
    omega = 2.0 * np.pi * frequency_hz
    for device in devices:
        if (z := device.turning_impedance(omega)) != 0.0:
            solve = _with_turning(solve, device.position, 1j * omega * z)
    free = solve(beam, acting, frequency_hz)
    across = [(device.position, z) for device in devices if (z := device.impedance(omega)) != 0.0]
    units = [solve(beam, [PointForce(position=place)], frequency_hz) for place, _ in across]
    pulls = _pulls(free, units, [place for place, _ in across], 1j * omega * np.array([z for _, z in across]))
    found = combined([(1.0, free), *zip(pulls, units, strict=True)])
    reactions = [force_of(place, pull) for (place, _), pull in zip(across, pulls, strict=True)]
    return replace(found, beam=beam, forces=(*free.forces, *reactions))


def interpolated(at: Callable[[float], HarmonicField], frequency_hz: float) -> HarmonicField:
    """A field from four frequencies around, where what it is made of has a pole and it has none. Raises InputError."""
    parts = [(weight, at(frequency_hz * (1.0 + steps * STEP))) for steps, weight in AROUND]
    forces = [field.forces for _, field in parts]
    acting = [
        force_of(one[0].position, sum(weight * phasor(force) for (weight, _), force in zip(parts, one, strict=True)))
        for one in zip(*forces, strict=True)
    ]
    return replace(combined(parts), frequency_hz=frequency_hz, forces=tuple(acting))


def _pulls(
    free: HarmonicField, units: Sequence[HarmonicField], places: list[float], turned: ComplexArray
) -> list[complex]:
    """Forces of devices on the beam, newton: r = -i omega Z (free + units r), each read at its place."""
    if not units:
        return []
    at = np.array(places)
    own = np.array([unit.shapes(at, 0) for unit in units]).T
    matrix = np.eye(len(units)) + turned[:, None] * own
    if np.linalg.svd(matrix, compute_uv=False)[-1] < RESONANCE * max(abs(matrix).max(), 1.0):
        raise DevicesResonanceError(
            f"frequency_hz = {free.frequency_hz!r} is an undamped resonance of the beam with devices at {places} m: "
            "give a device a dashpot or choose another frequency"
        )
    return [complex(pull) for pull in np.linalg.solve(matrix, -turned * free.shapes(at, 0))]


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
    return replace(combined([(1.0 - share, first), (share, second)]), beam=beam)


def _sprung(beam: Beam, position: float, rotational: float) -> Beam:
    return replace(beam, spring=(*beam.spring, PointSpring(position=position, rotational=rotational)))


def powers(field: HarmonicField, forces: Sequence[PointForce]) -> tuple[float, ...]:
    """The mean power that each force gives the beam, watt: 1/2 Re(F conj(v))."""
    speeds = 1j * field.omega * field.shapes(np.array([force.position for force in forces]), 0)
    return tuple(float(0.5 * (phasor(force) * np.conj(v)).real) for force, v in zip(forces, speeds, strict=True))
