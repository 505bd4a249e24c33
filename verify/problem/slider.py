"""The slider: friction, contact and feet. Values, no numerics."""

from typing import Annotated, Any

import msgspec
from msgspec.structs import replace

from verify.errors import InputError
from verify.options import CouplingChoice, Face, Kinematics, Law, Line, NormalChoice
from verify.problem.beam import Beam
from verify.validation import check_number, check_position, unit, validate

GRAVITY = 9.81
STEEPNESS = 1e4
"""Default of K in Eq. (3), s/m."""
OF_ONE_LAW: dict[Law, str] = {"tanh": "slope", "coulomb": "mu_static"}
"""Fields that belong to one friction law only."""


class Contact(msgspec.Struct, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """Unilateral contact of a slider that may lose contact: compliant, or hard with restitution. Raises InputError."""

    stiffness: Annotated[float, unit("N/m", gt=0)] | None = None
    """Normal stiffness of each foot, all its points together, N/m; without this and `layer_stiffness` hard contact."""
    damping: Annotated[float, unit("N s/m", ge=0)] = 0.0
    """Normal damping of each foot, N s/m; the contact force is never tensile."""
    tangential_stiffness: Annotated[float, unit("N/m", gt=0)] | None = None
    """Tangential stiffness of each foot, N/m; rigid if not given."""
    layer_stiffness: Annotated[float, unit("N/m for each metre of foot", gt=0)] | None = None
    """Normal stiffness of a layer per metre of foot, N/m^2, in place of `stiffness`."""
    layer_tangential_stiffness: Annotated[float, unit("N/m for each metre of foot", gt=0)] | None = None
    """Tangential stiffness of a layer per metre of foot, N/m^2."""
    restitution: Annotated[float, unit("speed after over speed before", ge=0, le=1)] = 0.0
    """Coefficient of restitution of hard contact, 0 to 1."""

    def __post_init__(self) -> None:
        validate(self, "slider.contact")
        for name in ("stiffness", "tangential_stiffness"):
            one, other = getattr(self, name), getattr(self, f"layer_{name}")
            if one is not None and other is not None:
                raise InputError(f"slider.contact.{name} = {one!r} and layer_{name} = {other!r}: give one")
        for name in ("damping", "tangential_stiffness", "layer_tangential_stiffness"):
            if self.hard and (value := getattr(self, name)):
                raise InputError(f"slider.contact.{name} = {value!r} is of springs: give slider.contact.stiffness too")
        if self.restitution and not self.hard:
            raise InputError(
                f"slider.contact.restitution = {self.restitution!r} is of a hard contact: springs lose by "
                "slider.contact.damping, leave the stiffness or the restitution out"
            )

    @property
    def hard(self) -> bool:
        """Whether the contact is rigid."""
        return self.stiffness is None and self.layer_stiffness is None

    def across(self, length: float) -> float:
        """Normal stiffness of a foot of this length, N/m."""
        return (self.stiffness or 0.0) + (self.layer_stiffness or 0.0) * length

    def along(self, length: float) -> float:
        """Tangential stiffness of a foot of this length, N/m; 0 where rigid."""
        return (self.tangential_stiffness or 0.0) + (self.layer_tangential_stiffness or 0.0) * length


class Foot(msgspec.Struct, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """A rigid foot of a slider that may lose contact, with height and pitch of its own. Raises InputError."""

    length: Annotated[float, unit("m", ge=0)] = 0.0
    """Length along the beam, m."""
    points: Annotated[int, unit("", ge=1)] = 1
    """Number of contact points, at the middles of equal cells of the length, with equal shares of the stiffness."""
    offset: Annotated[float, unit("m")] = 0.0
    """Position of its middle relative to the slider, m."""
    mass: Annotated[float, unit("kg", gt=0)] | None = None
    """Mass that moves across the beam, kg; default the slider's mass over the number of feet."""
    inertia: Annotated[float, unit("kg m^2", gt=0)] | None = None
    """Rotary inertia about its middle, kg m^2; default mass length^2 / 12."""
    pitches: bool = True
    """Whether it rotates; a foot of one point does not."""
    face: Face = "upper"
    """Face of the beam on which it is preloaded; on the lower one its weight acts against the preload."""
    mirrored: bool = False
    """Whether it is between the beam and the mirror image of the beam above it."""

    def __post_init__(self) -> None:
        validate(self, "slider.foot")
        if self.points > 1 and not self.length:
            raise InputError(f"slider.foot.points = {self.points!r} on no length: give slider.foot.length in metres")
        if self.inertia is not None and (self.points == 1 or not self.pitches):
            why = "of a foot of one point" if self.points == 1 else "with pitches = false"
            raise InputError(f"slider.foot.inertia = {self.inertia!r} {why}, which does not turn: leave it out")
        if self.mirrored and self.face != "upper":
            raise InputError(
                "slider.foot.mirrored = true on the lower face: a foot between two beams is on the upper one"
            )


class Slider(msgspec.Struct, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """A point mass on the surface, driven by friction.

    Friction by the paper's Eq. (3), F = -mu N tanh(K (v - v_beam)), or by Coulomb's law with stiction; N = m g +
    preload, v is the slider's speed along the tangent. Raises InputError.
    """

    mass: Annotated[float, unit("kg", gt=0)]
    """m_s, kg."""
    mu: Annotated[float, unit("coefficient of friction", ge=0)]
    """Coefficient of (kinetic) friction; 0 of a moving load."""
    slope: Annotated[float, unit("s/m", gt=0)] | None = None
    """K of Eq. (3), s/m, for law = 'tanh'; default 1e4."""
    law: Law = "tanh"
    """Friction law: tanh is Eq. (3), which never sticks; coulomb has stiction."""
    mu_static: Annotated[float, unit("coefficient of friction", gt=0)] | None = None
    """Coefficient of static friction, for law = 'coulomb'; default `mu`."""
    position: Annotated[float, unit("m")] | None = None
    """Initial position, m from the left end; default mid-span."""
    speed: Annotated[float, unit("m/s")] = 0.0
    """Initial speed along +x, m/s."""
    preload: Annotated[float, unit("N", ge=0)] = 0.0
    """Normal force in addition to the weight, N."""
    gravity: Annotated[float, unit("m/s^2", ge=0)] = GRAVITY
    """m/s^2."""
    coupling: CouplingChoice = "two-way"
    """Coupling of slider and beam; the error of one-way coupling is a margin of the run."""
    line: Line = "spline"
    """Contact line on a chain: the paper's C2 spline, or the links' straight edges."""
    kinematics: Kinematics = "tangential"
    """tangential: m dv/dt = F and dx/dt = v, as in the paper. following: a point that follows the surface exactly, with
    dx/dt = v - w' dw/dt and the inertia of the rotating tangent."""
    normal: NormalChoice = "held"
    """Normal force of a two-way coupled slider on the beam. held: m g + preload and the inertia across the beam, a
    moving mass with convective terms. massless: none, as in the paper. Friction has N = m g + preload in both."""
    contact: Contact | None = None
    """Unilateral contact; without it the slider never loses contact."""
    foot: tuple[Foot, ...] = ()
    """Feet of a slider with [slider.contact], all with one speed; default one point."""
    pull: Annotated[float, unit("N along x")] = 0.0
    """External force along +x on a slider with [slider.contact], N; a braking load is negative."""
    preload_stiffness: Annotated[float, unit("N/m", ge=0)] = 0.0
    """Stiffness of the spring that preloads each foot of a slider with [slider.contact], N/m."""

    def __post_init__(self) -> None:
        validate(self, "slider")
        if self.slope is not None and self.law == "coulomb":
            raise InputError(
                f"slider.slope = {self.slope!r} is K of Eq. (3), law = 'tanh': law = 'coulomb' has none, leave it out"
            )
        if self.mu_static is not None:
            check_number("slider.mu_static", self.mu_static, "coefficient of friction", at_least=self.mu)
            if self.law != "coulomb":
                raise InputError(
                    f"slider.mu_static = {self.mu_static!r} is for law = 'coulomb': Eq. (3) never sticks, leave it out"
                )
        if self.mass * self.gravity + self.preload == 0.0:
            raise InputError("slider.gravity = 0.0 without slider.preload presses on nothing: give one of the two")
        if self.contact is None:
            for name in ("foot", "pull", "preload_stiffness"):
                if getattr(self, name):
                    raise InputError(
                        f"slider.{name} belongs to a slider that may lose contact: give slider.contact too"
                    )
        else:
            self._check_contact(self.contact)

    def _check_contact(self, contact: Contact) -> None:
        """Raise InputError for what a slider with contact does not model, and for feet that do not fit its contact."""
        for name, fixed in (("line", "spline"), ("kinematics", "tangential"), ("normal", "held")):
            if getattr(self, name) != fixed:
                raise InputError(
                    f"slider.{name} = {getattr(self, name)!r} belongs to a slider that never loses contact: leave it "
                    "out, or slider.contact"
                )
        layer = next((n for n in ("layer_stiffness", "layer_tangential_stiffness") if getattr(contact, n)), None)
        for foot in self.feet:
            if layer and not foot.length:
                raise InputError(f"slider.contact.{layer} is for each metre of foot: give slider.foot.length")
            if foot.length and foot.points == 1 and not layer and not contact.hard:
                raise InputError(
                    f"slider.foot.length = {foot.length!r} of a foot of one point, which touches at its middle: give "
                    "slider.foot.points, or leave the length out"
                )
        if contact.hard and (len(self.foot) > 1 or any(foot.points > 1 for foot in self.foot)):
            raise InputError("slider.foot: a hard contact is of one point, give slider.contact.stiffness or one point")

    def check_stays(self) -> None:
        """Raise InputError for a slider that may lose contact."""
        if self.contact is not None:
            raise InputError(
                "slider.contact belongs to a slider that may lose contact, for [motor]: leave it out for one that "
                "never does"
            )

    @property
    def feet(self) -> tuple[Foot, ...]:
        """Its feet; one point by default."""
        return self.foot or (Foot(),)

    @property
    def steepness(self) -> float | None:
        """K of Eq. (3), s/m; None for Coulomb's law."""
        return None if self.law == "coulomb" else STEEPNESS if self.slope is None else self.slope

    @property
    def normal_force(self) -> float:
        """N, N: sum over its feet, without the force of `preload_stiffness`."""
        return sum(self.pressing(foot) for foot in self.feet)

    @property
    def load(self) -> float:
        """Normal force on one beam, N: half of a foot between two beams."""
        return sum(self.pressing(foot) * (0.5 if foot.mirrored else 1.0) for foot in self.feet)

    def pressing(self, foot: Foot) -> float:
        """Normal force on one foot at rest, N: preload plus weight, on the lower face less the weight.

        Between two beams the preload acts from both: twice the preload, or the weight where that is more.
        """
        weight, preload = self.mass * self.gravity / len(self.feet), self.preload / len(self.feet)
        if foot.mirrored:
            return max(2.0 * preload, weight)
        return max(preload - weight, 0.0) if foot.face == "lower" else weight + preload

    @property
    def effective_gravity(self) -> float:
        """Normal force of a foot over its moving mass, m/s^2, the least over all feet."""
        each = ((0.5 if foot.mirrored else 1.0) * self.pressing(foot) / self.moved_by(foot) for foot in self.feet)
        return min(each)

    def moved_by(self, foot: Foot) -> float:
        """Mass that moves with one of its feet across the beam, kg."""
        return self.mass / len(self.feet) if foot.mass is None else foot.mass

    def start_on(self, beam: Beam) -> float:
        """Initial position, m. Raises InputError off the beam."""
        x = 0.5 * beam.length if self.position is None else self.position
        check_position("slider.position", x, beam.length)
        return x


def changed(slider: Slider, **given: Any) -> Slider:
    """A slider with other values; another law drops the parameter of the first. Raises InputError."""
    if given.get("law", slider.law) != slider.law:
        given = {OF_ONE_LAW[slider.law]: None} | given
    return replace(slider, **given)
