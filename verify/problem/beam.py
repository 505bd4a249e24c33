"""The beam: geometry, material, supports, attached masses and springs, point forces. Values, no numerics."""

from functools import cache, cached_property
from math import pi, sqrt
from typing import Annotated

import msgspec
from msgspec.structs import replace

from verify.errors import InputError, written
from verify.problem.cross_section import CrossSection, Piece, Section, merged, piece_of, set_fields
from verify.problem.point_attachments import Attachment, PointMass, PointSpring
from verify.problem.supports import FIXED, Support
from verify.validation import Items, Pair, Relative, check_number, entry_of, unit, validate

SHORTEST_SECTION = 1e-6  # shortest section relative to the beam's length; a shorter one may be a rounding residue


class Beam(CrossSection, frozen=True, kw_only=True, forbid_unknown_fields=True, dict=True):
    """A straight beam, uniform or stepped, vibrating across its thickness, with attached masses and springs.

    The section is defined by shape, sizes, E and rho, or directly by `bending_stiffness` and `mass_per_length`. SI
    units. Raises InputError for a size that is not finite and positive, an incomplete or contradictory section, an
    unknown support, and an attachment off the beam.
    """

    length: Annotated[float, unit("m", gt=0)]
    """L, m."""
    supports: Pair[Support] = ("pinned", "pinned")
    """Left (x = 0) and right (x = L) end: pinned, clamped, free or guided."""
    poissons_ratio: Annotated[float, unit("dimensionless", gt=-1, le=0.5)] = 0.33
    """nu, for Timoshenko theory and plate theory only."""
    loss_factor: Annotated[Relative, unit("0 means undamped", ge=0, lt=10)] = 0.0
    """eta of the harmonic field, E (1 + i eta). At a resonance it equals a modal damping ratio of eta/2 times the
    fraction of the modal stiffness that is due to bending and shear."""
    section: Items[Section] = ()
    """Sections of a stepped beam from left to right; their lengths add up to `length`."""
    mass: Items[PointMass] = ()
    """Attached rigid bodies."""
    spring: Items[PointSpring] = ()
    """Springs to the ground."""
    tension: Annotated[float, unit("N, negative is compression")] = 0.0
    """Axial force, N, along the undeformed beam; negative is compression."""
    foundation: Annotated[float, unit("N/m^2, 0 means none", ge=0)] = 0.0
    """Stiffness of a Winkler foundation, N/m^2 (N/m per metre of beam)."""

    def __post_init__(self) -> None:
        validate(self, "beam")
        total = sum(section.length for section in self.section)
        if self.section and abs(total - self.length) > 1e-9 * self.length:
            raise InputError(
                f"beam.section lengths add up to {written(total)} m and beam.length = {written(self.length)} m: make "
                "them equal"
            )
        for i, section in enumerate(self.section):
            if section.length < SHORTEST_SECTION * self.length:
                raise InputError(
                    f"beam.section[{i}].length = {section.length!r} m is less than {SHORTEST_SECTION:g} of "
                    f"beam.length = {self.length!r} m: leave it out or check its unit"
                )
        for piece in (self.base_section, *self.pieces):
            stiffness, mass = piece.bending_stiffness, piece.mass_per_length
            if not all(1e-50 < size < 1e50 for size in (stiffness, mass, self.length)):  # or powers of them overflow
                raise InputError(
                    f"beam: its bending stiffness is {stiffness:.3g} N m^2, its mass per length {mass:.3g} kg/m, its "
                    f"length {self.length:.3g} m: give values between 1e-50 and 1e50, check their units"
                )
        for kind in attachment_kinds(type(self)):
            for i, attachment in enumerate(getattr(self, kind)):
                attachment.check_on(f"beam.{kind}[{i}]", self.length, self.supports)

    @cached_property
    def base_section(self) -> Piece:
        """The section of the beam's own fields over its whole length; `section` may replace it by pieces."""
        return piece_of(set_fields(self), self.length, "beam", self.poissons_ratio)

    @cached_property
    def pieces(self) -> tuple[Piece, ...]:
        """Pieces of constant section from left to right; a uniform beam has one."""
        base, nu = self.base_section, self.poissons_ratio
        return tuple(
            piece_of(merged(section, self), section.length, f"beam.section[{i}]", nu, base)
            for i, section in enumerate(self.section)
        ) or (base,)

    @property  # type: ignore[misc]
    def bending_stiffness(self) -> float:
        """EI of the beam's own section, N m^2."""
        return self.base_section.bending_stiffness

    @property  # type: ignore[misc]
    def mass_per_length(self) -> float:
        """Rho A of the beam's own section, kg/m."""
        return self.base_section.mass_per_length

    @cached_property
    def attached(self) -> tuple[Attachment, ...]:
        """All attachments: masses, then springs."""
        return tuple(attachment for kind in attachment_kinds(type(self)) for attachment in getattr(self, kind))

    @property
    def uniform(self) -> bool:
        """Whether the beam has one section and no attachments, as closed forms assume."""
        return not features(self)

    @property
    def rigid_motions(self) -> int:
        """Number of rigid-body motions: 0, 1 or 2."""
        return len(rigid_lines(self))

    def mirrored(self) -> "Beam":
        """The mirror image of the beam."""
        left, right = self.supports
        turned = {
            kind: tuple(replace(a, position=self.length - a.position) for a in reversed(getattr(self, kind)))
            for kind in attachment_kinds(type(self))
        }
        return replace(self, supports=(right, left), section=self.section[::-1], **turned)

    @property
    def surface_distance(self) -> float:
        """Distance of the surface from the neutral line of the beam's own section, m. Raises InputError if unknown."""
        distance = self.base_section.extreme_fibre
        if distance is None:
            raise InputError(
                "beam.extreme_fibre is missing: the motion of a surface depends on how far it lies from the neutral "
                "line, give it in metres"
            )
        return distance

    @property
    def wave_constant(self) -> float:
        """sqrt(EI / (rho A)) of the beam's own section, m^2/s: omega = beta^2 times this."""
        return sqrt(self.bending_stiffness / self.mass_per_length)


@cache
def attachment_kinds(beam: type[Beam]) -> tuple[str, ...]:
    """Names of the fields of a type of beam that are lists of attachments."""
    fields = msgspec.structs.fields(beam)
    return tuple(field.name for field in fields if issubclass(entry_of(field.type) or object, Attachment))


def features(beam: Beam) -> tuple[str, ...]:
    """Names of the fields beyond a uniform beam on two supports: section, attachments, tension, foundation."""
    names = (*attachment_kinds(type(beam)), "tension", "foundation")
    return ("section",) * is_stepped(beam) + tuple(name for name in names if getattr(beam, name))


def is_stepped(beam: Beam) -> bool:
    """Whether a piece differs from the beam's own section."""
    return any(replace(piece, length=beam.length) != beam.base_section for piece in beam.pieces)


def is_lossless(beam: Beam) -> bool:
    """Whether the beam has stiffness to which the loss factor does not apply: springs, tension, foundation."""
    return bool(beam.tension or beam.foundation or any(attachment.elastic for attachment in beam.attached))


def check_features(beam: Beam, model: str, allowed: tuple[str, ...] = (), remedy: str = "use another model") -> None:
    """Raise InputError for features that are not `allowed`; `model` is the subject of the message.

    "attached" allows every attachment, "bodies" those without stiffness.
    """
    for name in features(beam):
        group = ("attached", "bodies") if name in attachment_kinds(type(beam)) else (name,)
        if "bodies" in group and any(attachment.elastic for attachment in getattr(beam, name)):
            group = ("attached",)
        if not set(group) & set(allowed):
            raise InputError(f"beam.{name}: {model} does not model it, leave it out or {remedy}")


def rigid_lines(beam: Beam) -> tuple[tuple[float, float], ...]:
    """Rigid-body motions w = a + b x, as (a, b) with x in m: none, one or two."""
    ends = zip((0.0, beam.length), beam.supports, strict=True)
    places = {at for at, support in ends if FIXED[support].deflection}
    places |= {attachment.position for attachment in beam.attached if attachment.stiffness}
    turned = any(FIXED[support].rotation for support in beam.supports) or bool(beam.tension)
    turned |= any(attachment.rotational for attachment in beam.attached)
    if beam.foundation or len(places) > 1 or (places and turned):
        return ()
    if places:
        return ((-places.pop(), 1.0),)
    return ((1.0, 0.0),) if turned else ((1.0, 0.0), (-0.5 * beam.length, 1.0))


def with_attachments(beam: Beam, mass: tuple[PointMass, ...] = (), spring: tuple[PointSpring, ...] = ()) -> Beam:
    """The beam with these attachments alone."""
    return replace(beam, **dict.fromkeys(attachment_kinds(type(beam)), ()) | {"mass": mass, "spring": spring})


def in_plane(beam: Beam, axis: str) -> Beam:
    """The beam, for the axis "width" turned by 90 degrees about its own, without springs."""
    if axis != "width":
        return beam
    section = tuple(replace(part, width=part.thickness, thickness=part.width) for part in beam.section)
    bodies = [attachment for attachment in beam.attached if attachment.massive]
    masses = [PointMass(position=a.position, mass=a.mass, rotary_inertia=a.rotary_inertia) for a in bodies]
    turned = replace(beam, width=beam.thickness, thickness=beam.width, section=section)
    return with_attachments(turned, mass=tuple(masses))


def check_frequency(field: str, frequency_hz: float, beam: Beam) -> None:
    """Raise InputError unless a frequency is positive and its wavelength is not too short for the beam."""
    check_number(field, frequency_hz, "hertz", at_least=1e-100)  # its square is a number
    waves = sqrt(frequency_hz) / sqrt(2.0 * pi * beam.wave_constant) * beam.length
    if waves > 1e6:  # too many points, and their phase loses its digits
        raise InputError(
            f"{field} = {frequency_hz!r} Hz has {waves:.1e} wavelengths along this beam, more than 1e6: lower it or "
            "check the beam's units"
        )


class PointLoad(msgspec.Struct, frozen=True, kw_only=True, forbid_unknown_fields=True, repr_omit_defaults=True):
    """A harmonic load at a point, amplitude cos(omega t + phase): a `PointForce` or a `PointMoment`.

    Raises InputError for a value that is not finite and a negative position. Functions that take a beam and a load
    check that the position is on the beam.
    """

    position: Annotated[float, unit("m from the left end", ge=0)]
    """x, m from the left end."""
    amplitude: Annotated[float, unit("N, of a moment N m")] = 1.0
    """N; of a moment N m."""
    phase_deg: Annotated[float, unit("degrees")] = 0.0
    """Phase, degrees (e^{+i omega t})."""

    def __post_init__(self) -> None:
        validate(self, "force")


class PointForce(PointLoad, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """A transverse harmonic point force; see `PointLoad`."""


class PointMoment(PointLoad, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """A harmonic point moment, positive in the sense of a positive slope w'; see `PointLoad`."""
