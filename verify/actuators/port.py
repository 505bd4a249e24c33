"""The electrical and the mechanical port of an actuator, which all its forms share."""

from abc import abstractmethod
from typing import Any

import msgspec

from verify.arrays import ComplexArray

Number = complex | ComplexArray  # A number, or one for each frequency, (n,)


class Port(msgspec.Struct, frozen=True, eq=False, kw_only=True):
    """An actuator at one frequency or many, e^{+i omega t}: F = B V - Z v, I = Y V + B v.

    F is the force on the structure and v the structure's velocity in the direction of F; of a patch F is the pair of
    moments at its ends and v the rate of its bending angle, the difference of the slopes there. V and I are voltage and
    current into the actuator.
    """

    force_factor: Number
    """B, N/V (N m/V of a patch)."""
    short_impedance: Number
    """Z with short-circuited electrodes, kg/s (N m s/rad of a patch)."""
    blocked_admittance: Number
    """Y at v = 0, S."""

    def loaded_impedance(self, shunt_admittance: Any = 0.0) -> Any:
        """-F/v with an electrical admittance (S) across the electrodes: Z + B^2 / (Y + Y_el); open-circuited for 0."""
        return self.short_impedance + self.force_factor**2 / (self.blocked_admittance + shunt_admittance)


class Actuator(msgspec.Struct, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """An actuator with one electrical and one mechanical port. Values; subclasses give the port."""

    @abstractmethod
    def port(self, omega: Any) -> Port:
        """The port at angular frequencies omega (rad/s), a number or (n,)."""
        raise NotImplementedError
