"""Attachments of a beam at a point: each is a class of four coefficients. Values, no numerics."""

from collections.abc import Sequence
from typing import Annotated, ClassVar

import msgspec

from verify.errors import InputError
from verify.problem.supports import check_free
from verify.validation import check_position, unit, validate


class Attachment(msgspec.Struct, frozen=True, kw_only=True, forbid_unknown_fields=True, repr_omit_defaults=True):
    """A body fixed to the beam at a point, a spring from there to the ground, or both.

    A subclass has fields and, as fields or properties, those of the four coefficients below that are not 0. Models,
    engines, fits and drawing read these alone; the name of its field of `Beam` is `kind`. Raises InputError for an
    invalid value and where all four are 0.
    """

    kind: ClassVar[str]
    position: Annotated[float, unit("m", ge=0)]
    """x of the fixing, m from the left end."""

    def __post_init__(self) -> None:
        validate(self, f"beam.{self.kind}")
        if not any((*self.across.values(), *self.around.values())):
            names = " or ".join(name for name in self.__struct_fields__ if name != "position")
            raise InputError(f"beam.{self.kind} at position = {self.position!r} has no effect: give {names}")

    @property
    def stiffness(self) -> float:
        """Stiffness against deflection, N/m."""
        return 0.0

    @property
    def rotational(self) -> float:
        """Stiffness against rotation, N m/rad."""
        return 0.0

    @property
    def mass(self) -> float:
        """Mass that moves with the deflection, kg."""
        return 0.0

    @property
    def rotary_inertia(self) -> float:
        """Rotary inertia about the fixing, kg m^2."""
        return 0.0

    @property
    def across(self) -> dict[str, float]:
        """Coefficients against deflection by name."""
        return {"stiffness": self.stiffness, "mass": self.mass}

    @property
    def around(self) -> dict[str, float]:
        """Coefficients against rotation by name."""
        return {"rotational": self.rotational, "rotary_inertia": self.rotary_inertia}

    @property
    def massive(self) -> bool:
        """Whether it has inertia."""
        return bool(self.mass or self.rotary_inertia)

    @property
    def elastic(self) -> bool:
        """Whether it has stiffness, to which the beam's loss factor does not apply."""
        return bool(self.stiffness or self.rotational)

    def check_on(self, where: str, length: float, supports: Sequence[str]) -> None:
        """Raise InputError for a position off the beam, or on a support where a coefficient has no effect."""
        check_position(f"{where}.position", self.position, length)
        check_free(where, self.position, length, supports, self.across, self.around)


class PointMass(Attachment, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """A rigid body fixed to the beam at a point. Raises InputError for an invalid value or without inertia."""

    kind = "mass"
    mass: Annotated[float, unit("kg", ge=0)] = 0.0
    """kg."""
    rotary_inertia: Annotated[float, unit("kg m^2", ge=0)] = 0.0
    """Rotary inertia about the fixing, kg m^2; the body rotates with the beam's section."""


class PointSpring(Attachment, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """A spring from the beam to the ground at a point. Raises InputError for an invalid value or no stiffness."""

    kind = "spring"
    stiffness: Annotated[float, unit("N/m", ge=0)] = 0.0
    """Stiffness against deflection, N/m."""
    rotational: Annotated[float, unit("N m/rad", ge=0)] = 0.0
    """Stiffness against rotation, N m/rad."""
