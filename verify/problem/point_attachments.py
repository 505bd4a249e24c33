"""Point masses and point springs on a beam. Values, no numerics."""

import msgspec

from verify.checks import check_number, settle
from verify.errors import InputError


class PointMass(msgspec.Struct, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """A rigid body fixed to the beam at a point. Raises InputError for an invalid value, or where all are zero."""

    position: float
    """x of its fixing, m from the left end."""
    mass: float = 0.0
    """kg."""
    rotary_inertia: float = 0.0
    """About the fixing, kg m^2; it rotates with the slope of the beam."""

    def __post_init__(self) -> None:
        settle(self)
        check_number("beam.mass.position", self.position, "metres", at_least=0)
        check_number("beam.mass.mass", self.mass, "kilograms", at_least=0)
        check_number("beam.mass.rotary_inertia", self.rotary_inertia, "kg m^2", at_least=0)
        if not (self.mass or self.rotary_inertia):
            raise InputError(f"beam.mass at position = {self.position!r} weighs nothing: give mass or rotary_inertia")


class PointSpring(msgspec.Struct, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """A spring from the beam to the ground at a point. Raises InputError for an invalid value, or all zero."""

    position: float
    """x, m from the left end."""
    stiffness: float = 0.0
    """Stiffness against deflection, N/m."""
    rotational: float = 0.0
    """Stiffness against rotation, N m/rad."""

    def __post_init__(self) -> None:
        settle(self)
        check_number("beam.spring.position", self.position, "metres", at_least=0)
        check_number("beam.spring.stiffness", self.stiffness, "N/m", at_least=0)
        check_number("beam.spring.rotational", self.rotational, "N m/rad", at_least=0)
        if not (self.stiffness or self.rotational):
            raise InputError(f"beam.spring at position = {self.position!r} is slack: give stiffness or rotational")
