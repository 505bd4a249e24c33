"""A device on a driven beam: an impedance against deflection and rotation, and a force of its own. Values."""

from collections.abc import Sequence

import msgspec

from verify.checks import check_number, settle
from verify.errors import InputError
from verify.problem.beam import Beam, PointForce

ACROSS = ("stiffness", "mass", "dashpot", "amplitude")
TURNING = ("rotational", "rotary_inertia", "rotational_dashpot")
_UNITS = {
    "stiffness": "N/m",
    "mass": "kilograms",
    "dashpot": "N s/m",
    "rotational": "N m/rad",
    "rotary_inertia": "kg m^2",
    "rotational_dashpot": "N m s/rad",
}
HELD = ("pinned", "clamped")
"""Supports without deflection."""
_STILL = {"across": HELD, "turning": ("clamped", "guided")}
"""Supports without deflection, or without rotation."""


class Device(msgspec.Struct, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """An actuator or absorber on a beam in its steady state: an impedance to the ground, and a force.

    Part of the drive, not of the beam: harmonic fields model it; modes, motion in time and the nonlinear chain do not.
    Raises InputError where a value is negative or invalid, or all are zero.
    """

    position: float
    """x, m from the left end."""
    stiffness: float = 0.0
    """Stiffness against deflection, N/m."""
    mass: float = 0.0
    """Mass that moves with the deflection, kg."""
    dashpot: float = 0.0
    """Damping against deflection, N s/m."""
    rotational: float = 0.0
    """Stiffness against rotation, N m/rad."""
    rotary_inertia: float = 0.0
    """Rotary inertia, kg m^2."""
    rotational_dashpot: float = 0.0
    """Damping against rotation, N m s/rad."""
    amplitude: float = 0.0
    """Blocked force of an actuator, N."""
    phase_deg: float = 0.0
    """Phase of that force, degrees (e^{+i omega t})."""

    def __post_init__(self) -> None:
        settle(self)
        check_number("device.position", self.position, "metres", at_least=0)
        for name, unit in _UNITS.items():
            check_number(f"device.{name}", getattr(self, name), unit, at_least=0)
        check_number("device.amplitude", self.amplitude, "newton")
        check_number("device.phase_deg", self.phase_deg, "degrees")
        if not (self.across or self.turning):
            raise InputError(
                f"device at position = {self.position!r} does nothing: give it one of {', '.join((*ACROSS, *TURNING))}"
            )

    @property
    def across(self) -> bool:
        """Whether it acts on the deflection."""
        return any(getattr(self, name) for name in ACROSS)

    @property
    def turning(self) -> bool:
        """Whether it acts on the rotation."""
        return any(getattr(self, name) for name in TURNING)

    @property
    def own_force(self) -> PointForce:
        """The blocked force as a point force."""
        return PointForce(position=self.position, amplitude=self.amplitude, phase_deg=self.phase_deg)

    def dynamic_stiffness(self, omega: float) -> complex:
        """Force over deflection, S + i omega R - omega^2 m, N/m."""
        return complex(self.stiffness - omega**2 * self.mass, omega * self.dashpot)

    def rotational_dynamic_stiffness(self, omega: float) -> complex:
        """Couple over rotation, N m/rad."""
        return complex(self.rotational - omega**2 * self.rotary_inertia, omega * self.rotational_dashpot)

    def impedance(self, omega: float) -> complex:
        """Force over velocity, R + i (omega m - S / omega), kg/s."""
        return complex(self.dashpot, omega * self.mass - self.stiffness / omega)

    def turning_impedance(self, omega: float) -> complex:
        """Couple over angular velocity, N m s."""
        return complex(self.rotational_dashpot, omega * self.rotary_inertia - self.rotational / omega)

    def check_on(self, beam: Beam) -> None:
        """Raise InputError off the beam, and on a support where it has no effect."""
        if self.position > beam.length:
            raise InputError(
                f"device.position = {self.position!r} lies off the beam: give a position between 0 and "
                f"{beam.length!r} m"
            )
        for end, support in zip((0.0, beam.length), beam.supports, strict=True):
            for way, names in (("across", ACROSS), ("turning", TURNING)):
                if abs(self.position - end) <= 1e-9 * beam.length and getattr(self, way) and support in _STILL[way]:
                    name = next(name for name in names if getattr(self, name))
                    moves = "moves across" if way == "across" else "turns"
                    raise InputError(
                        f"device.position = {self.position!r} m stands on a {support} support, where nothing {moves} "
                        f"and device.{name} = {getattr(self, name)!r} does nothing: move it, or leave that out"
                    )


def check_moved(forces: Sequence[PointForce], beam: Beam) -> None:
    """Raise InputError for a driving force on a support without deflection."""
    for end, support in zip((0.0, beam.length), beam.supports, strict=True):
        for force in forces:
            if abs(force.position - end) <= 1e-9 * beam.length and support in HELD:
                raise InputError(
                    f"drive.force.position = {force.position!r} m stands on a {support} support, where nothing moves "
                    "across and a force does nothing: move it, or leave it out"
                )


def of_impedance(position: float, impedance: complex, omega: float, *, turning: bool = False) -> Device:
    """The device of dashpot and spring, or of dashpot and mass, with a given impedance at one frequency.

    Raises InputError for an active impedance.
    """
    if impedance.real < 0.0:
        raise InputError(
            f"impedance = {impedance!r} gives energy, which no dashpot does: give one whose real part is at least 0"
        )
    spring, mass, dashpot = TURNING if turning else ("stiffness", "mass", "dashpot")
    reactive = {spring: -impedance.imag * omega} if impedance.imag < 0.0 else {mass: impedance.imag / omega}
    return Device(position=position, **{dashpot: impedance.real}, **reactive)
