"""Point masses and point springs on a beam. Values, no numerics."""

from typing import Annotated

import msgspec

from verify.errors import InputError
from verify.validation import unit, validate


class PointMass(msgspec.Struct, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """A rigid body fixed to the beam at a point. Raises InputError for an invalid value or without inertia."""

    position: Annotated[float, unit("m", ge=0)]
    """x of the fixing, m from the left end."""
    mass: Annotated[float, unit("kg", ge=0)] = 0.0
    """kg."""
    rotary_inertia: Annotated[float, unit("kg m^2", ge=0)] = 0.0
    """Rotary inertia about the fixing, kg m^2; the body rotates with the beam's section."""

    def __post_init__(self) -> None:
        validate(self, "beam.mass")
        if not (self.mass or self.rotary_inertia):
            raise InputError(f"beam.mass at position = {self.position!r} has no inertia: give mass or rotary_inertia")


class PointSpring(msgspec.Struct, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """A spring from the beam to the ground at a point. Raises InputError for an invalid value or no stiffness."""

    position: Annotated[float, unit("m", ge=0)]
    """x, m from the left end."""
    stiffness: Annotated[float, unit("N/m", ge=0)] = 0.0
    """Stiffness against deflection, N/m."""
    rotational: Annotated[float, unit("N m/rad", ge=0)] = 0.0
    """Stiffness against rotation, N m/rad."""

    def __post_init__(self) -> None:
        validate(self, "beam.spring")
        if not (self.stiffness or self.rotational):
            raise InputError(f"beam.spring at position = {self.position!r} has none: give stiffness or rotational")
