"""A device on a driven beam: an impedance against deflection and rotation, and a blocked force. Values, no numerics."""

from typing import Annotated

from verify.errors import InputError
from verify.problem.beam import PointForce
from verify.problem.point_attachments import Attachment
from verify.validation import unit


class Device(Attachment, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """An actuator or absorber on a beam in its steady state: an impedance to the ground, and a force.

    It is part of the drive: harmonic fields model it; modes, motion in time and the nonlinear chain do not. Raises
    InputError for a negative or invalid value, or where all are zero.
    """

    where = "device"
    acting_across = ("stiffness", "mass", "dashpot", "amplitude")
    acting_around = ("rotational", "rotary_inertia", "rotational_dashpot")
    stiffness: Annotated[float, unit("N/m", ge=0)] = 0.0
    """Stiffness against deflection, N/m."""
    mass: Annotated[float, unit("kg", ge=0)] = 0.0
    """Mass that moves with the deflection, kg."""
    dashpot: Annotated[float, unit("N s/m", ge=0)] = 0.0
    """Damping against deflection, N s/m."""
    rotational: Annotated[float, unit("N m/rad", ge=0)] = 0.0
    """Stiffness against rotation, N m/rad."""
    rotary_inertia: Annotated[float, unit("kg m^2", ge=0)] = 0.0
    """Rotary inertia, kg m^2."""
    rotational_dashpot: Annotated[float, unit("N m s/rad", ge=0)] = 0.0
    """Damping against rotation, N m s/rad."""
    amplitude: Annotated[float, unit("N")] = 0.0
    """Blocked force of an actuator, N."""
    phase_deg: Annotated[float, unit("degrees")] = 0.0
    """Phase of the blocked force, degrees (e^{+i omega t})."""

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


def of_impedance(position: float, impedance: complex, omega: float, *, turning: bool = False) -> Device:
    """The device of dashpot and spring, or of dashpot and mass, that has an impedance (kg/s) at omega (rad/s).

    Raises InputError for an active impedance.
    """
    if impedance.real < 0.0:
        raise InputError(f"impedance = {impedance!r} is active, a dashpot is not: give a real part of at least 0")
    spring, mass, dashpot = Device.acting_around if turning else ("stiffness", "mass", "dashpot")
    reactive = {spring: -impedance.imag * omega} if impedance.imag < 0.0 else {mass: impedance.imag / omega}
    return Device(position=position, **{dashpot: impedance.real}, **reactive)
