"""Attachments of a beam at a point: each is a class of four coefficients. Values, no numerics."""

from collections.abc import Sequence
from typing import Annotated, ClassVar

import msgspec

from verify.errors import InputError
from verify.problem.supports import check_free
from verify.validation import check_position, unit, validate


class Attachment(msgspec.Struct, frozen=True, kw_only=True, forbid_unknown_fields=True, repr_omit_defaults=True):
    """A body fixed to the beam at a point, a spring from there to the ground, or both.

    A subclass has fields and, as fields or properties, those of the four coefficients below that are not 0, which are
    all that models, engines, fits and the drawing read; `where` is its name in messages. Raises InputError for an
    invalid value and where all are 0.
    """

    where: ClassVar[str]
    acting_across: ClassVar[tuple[str, ...]] = ("stiffness", "mass")
    """Coefficients against deflection."""
    acting_around: ClassVar[tuple[str, ...]] = ("rotational", "rotary_inertia")
    """Coefficients against rotation."""
    position: Annotated[float, unit("m", ge=0)]
    """x, m from the left end."""

    stiffness = property(lambda self: 0.0, doc="Stiffness against deflection, N/m.")
    rotational = property(lambda self: 0.0, doc="Stiffness against rotation, N m/rad.")
    mass = property(lambda self: 0.0, doc="Mass that moves with the deflection, kg.")
    rotary_inertia = property(lambda self: 0.0, doc="Rotary inertia about the fixing, kg m^2.")

    def __post_init__(self) -> None:
        validate(self, self.where)
        if not (self.across or self.turning):
            names = [n for n in (*self.acting_across, *self.acting_around) if n in self.__struct_fields__]
            raise InputError(
                f"{self.where} at position = {self.position!r} has no effect: give one of {', '.join(names)}"
            )

    @property
    def across(self) -> bool:
        """Whether it acts on the deflection."""
        return any(getattr(self, name) for name in self.acting_across)

    @property
    def turning(self) -> bool:
        """Whether it acts on the rotation."""
        return any(getattr(self, name) for name in self.acting_around)

    @property
    def massive(self) -> bool:
        """Whether it has inertia."""
        return bool(self.mass or self.rotary_inertia)

    @property
    def elastic(self) -> bool:
        """Whether it has stiffness, to which the beam's loss factor does not apply."""
        return bool(self.stiffness or self.rotational)

    def check_on(self, where: str, length: float, supports: Sequence[str]) -> None:
        """Raise InputError for a position off a beam, or on a support where a coefficient has no effect."""
        check_position(f"{where}.position", self.position, length)
        across, turning = ({n: getattr(self, n) for n in names} for names in (self.acting_across, self.acting_around))
        check_free(where, self.position, length, supports, across, turning)


class PointMass(Attachment, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """A rigid body fixed to the beam at a point. Raises InputError for an invalid value or without inertia."""

    where = "beam.mass"
    mass: Annotated[float, unit("kg", ge=0)] = 0.0
    """kg."""
    rotary_inertia: Annotated[float, unit("kg m^2", ge=0)] = 0.0
    """Rotary inertia about the fixing, kg m^2; the body rotates with the beam's section."""


class PointSpring(Attachment, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """A spring from the beam to the ground at a point. Raises InputError for an invalid value or no stiffness."""

    where = "beam.spring"
    stiffness: Annotated[float, unit("N/m", ge=0)] = 0.0
    """Stiffness against deflection, N/m."""
    rotational: Annotated[float, unit("N m/rad", ge=0)] = 0.0
    """Stiffness against rotation, N m/rad."""
