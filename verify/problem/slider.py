"""The slider: friction, contact and feet. Values, no numerics."""

from typing import Annotated, Any

import msgspec
from msgspec.structs import replace

from verify.errors import InputError
from verify.problem.beam import Beam
from verify.settings import CouplingChoice, Face, Kinematics, Law, Line, NormalChoice
from verify.validation import Items, check_number, check_position, unit, validate

GRAVITY = 9.81
STEEPNESS = 1e4
"""Default of K in Eq. (3), s/m."""
OF_ONE_LAW: dict[Law, str] = {"tanh": "slope", "coulomb": "mu_static"}  # fields of one friction law only


class Contact(msgspec.Struct, frozen=True, kw_only=True, forbid_unknown_fields=True, repr_omit_defaults=True):
    """Unilateral contact of slider and beam: compliant, or hard with restitution. Raises InputError."""

    stiffness: Annotated[float, unit("N/m", gt=0)] | None = None
    """Normal stiffness of each foot, sum over its points, N/m; None with no `layer_stiffness`: hard contact."""
    damping: Annotated[float, unit("N s/m", ge=0)] = 0.0
    """Normal damping of each foot, N s/m; the contact force is never tensile."""
    tangential_stiffness: Annotated[float, unit("N/m", gt=0)] | None = None
    """Tangential stiffness of each foot, N/m; None: rigid."""
    layer_stiffness: Annotated[float, unit("N/m for each metre of foot", gt=0)] | None = None
    """Normal stiffness of a layer per metre of foot, N/m^2, instead of `stiffness`."""
    layer_tangential_stiffness: Annotated[float, unit("N/m for each metre of foot", gt=0)] | None = None
    """Tangential stiffness of a layer per metre of foot, N/m^2."""
    restitution: Annotated[float, unit("speed after over speed before", ge=0, le=1)] = 0.0
    """Coefficient of restitution of hard contact, 0 to 1."""

    def __post_init__(self) -> None:
        validate(self, "slider.contact")
        for name in ("stiffness", "tangential_stiffness"):
            of_foot, of_layer = getattr(self, name), getattr(self, f"layer_{name}")
            if of_foot is not None and of_layer is not None:
                raise InputError(f"slider.contact.{name} = {of_foot!r} and layer_{name} = {of_layer!r}: give one")
        for name in ("damping", "tangential_stiffness", "layer_tangential_stiffness"):
            if self.hard and (value := getattr(self, name)):
                raise InputError(
                    f"slider.contact.{name} = {value!r} is for compliant contact: give slider.contact.stiffness too"
                )
        if self.restitution and not self.hard:
            raise InputError(
                f"slider.contact.restitution = {self.restitution!r} is for hard contact: compliant contact has "
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


class Foot(msgspec.Struct, frozen=True, kw_only=True, forbid_unknown_fields=True, repr_omit_defaults=True):
    """A rigid foot of a slider with [slider.contact]; its height and pitch are free. Raises InputError."""

    length: Annotated[float, unit("m", ge=0)] = 0.0
    """Length along the beam, m."""
    points: Annotated[int, unit("", ge=1)] = 1
    """Number of contact points, at the middles of equal cells of the length; they share the stiffness equally."""
    offset: Annotated[float, unit("m")] = 0.0
    """Position of the middle of the foot relative to the slider, m."""
    mass: Annotated[float, unit("kg", gt=0)] | None = None
    """Mass in transverse motion, kg; default: the slider's mass over the number of feet."""
    inertia: Annotated[float, unit("kg m^2", gt=0)] | None = None
    """Rotary inertia about the middle of the foot, kg m^2; default: mass length^2 / 12."""
    pitches: bool = True
    """Whether the foot rotates; a foot of one point does not."""
    face: Face = "upper"
    """Face of the beam on which the foot is preloaded; on the lower face the weight acts against the preload."""
    mirrored: bool = False
    """Whether the foot is between the beam and a mirror image of the beam above it."""

    def __post_init__(self) -> None:
        validate(self, "slider.foot")
        if self.points > 1 and not self.length:
            raise InputError(f"slider.foot.points = {self.points!r} needs a length: give slider.foot.length in metres")
        if self.inertia is not None and (self.points == 1 or not self.pitches):
            why = "of a foot of one point" if self.points == 1 else "with pitches = false"
            raise InputError(f"slider.foot.inertia = {self.inertia!r} {why}, which does not rotate: leave it out")
        if self.mirrored and self.face != "upper":
            raise InputError(
                "slider.foot.mirrored = true with face = 'lower': give a foot between two beams face = 'upper'"
            )


ONE_POINT = (Foot(),)


class Slider(msgspec.Struct, frozen=True, kw_only=True, forbid_unknown_fields=True, repr_omit_defaults=True):
    """A point mass on the surface, driven by friction.

    Friction by the paper's Eq. (3), F = -mu N tanh(K (v - v_beam)), or by Coulomb's law with stiction; N = m g +
    preload, v is the slider's speed along the tangent. Raises InputError.
    """

    mass: Annotated[float, unit("kg", gt=0)]
    """m_s, kg."""
    mu: Annotated[float, unit("coefficient of friction", ge=0)]
    """Coefficient of (kinetic) friction; 0 for a moving load."""
    slope: Annotated[float, unit("s/m", gt=0)] | None = None
    """K of Eq. (3), s/m, for law = 'tanh'; default: 1e4."""
    law: Law = "tanh"
    """Friction law: tanh is Eq. (3), which never sticks; coulomb has stiction."""
    mu_static: Annotated[float, unit("coefficient of friction", gt=0)] | None = None
    """Coefficient of static friction, for law = 'coulomb'; default: `mu`."""
    position: Annotated[float, unit("m")] | None = None
    """Initial position, m from the left end; default: mid-span."""
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
    normal: NormalChoice = "bilateral"
    """Normal force of a two-way coupled slider on the beam. bilateral: m g + preload and the transverse inertia of a
    moving mass with convective terms. massless: none, as in the paper. Friction uses N = m g + preload in both."""
    contact: Contact | None = None
    """Unilateral contact; None: bilateral, the slider never loses contact."""
    foot: Items[Foot] = ()
    """Feet of a slider with [slider.contact], rigidly connected along x; default: one point."""
    external_force: Annotated[float, unit("N along x")] = 0.0
    """External force along +x on a slider with [slider.contact], N; a braking load is negative."""
    preload_stiffness: Annotated[float, unit("N/m", ge=0)] = 0.0
    """Stiffness of the spring that preloads each foot of a slider with [slider.contact], N/m."""

    def __post_init__(self) -> None:
        validate(self, "slider")
        if self.slope is not None and self.law == "coulomb":
            raise InputError(f"slider.slope = {self.slope!r} is K of Eq. (3): give law = 'tanh' or leave it out")
        if self.mu_static is not None:
            check_number("slider.mu_static", self.mu_static, "coefficient of friction", at_least=self.mu)
            if self.law != "coulomb":
                raise InputError(
                    f"slider.mu_static = {self.mu_static!r} is for law = 'coulomb': Eq. (3) never sticks, leave it out"
                )
        if self.mass * self.gravity + self.preload == 0.0:
            raise InputError("slider.gravity = 0.0 without slider.preload: the normal force is zero, give one of them")
        if self.contact is None:
            for name in ("foot", "external_force", "preload_stiffness"):
                if getattr(self, name):
                    raise InputError(f"slider.{name} is for a slider that may lose contact: give slider.contact too")
        else:
            self._check_contact(self.contact)

    def _check_contact(self, contact: Contact) -> None:
        """Raise InputError for options that unilateral contact does not model, and for feet that contradict it."""
        for name, default in (("line", "spline"), ("kinematics", "tangential"), ("normal", "bilateral")):
            if getattr(self, name) != default:
                raise InputError(
                    f"slider.{name} = {getattr(self, name)!r} is for a slider that never loses contact: leave it or "
                    "slider.contact out"
                )
        layer = next((n for n in ("layer_stiffness", "layer_tangential_stiffness") if getattr(contact, n)), None)
        for foot in self.feet:
            if layer and not foot.length:
                raise InputError(f"slider.contact.{layer} is per metre of foot: give slider.foot.length")
            if foot.length and foot.points == 1 and not layer and not contact.hard:
                raise InputError(
                    f"slider.foot.length = {foot.length!r} with one point, which is at its middle: give "
                    "slider.foot.points or leave the length out"
                )
        if contact.hard and (len(self.foot) > 1 or any(foot.points > 1 for foot in self.foot)):
            raise InputError("slider.foot: hard contact has one point, give slider.contact.stiffness or points = 1")

    @property
    def feet(self) -> tuple[Foot, ...]:
        """The feet; by default one of one point."""
        return tuple(self.foot) or ONE_POINT

    @property
    def steepness(self) -> float | None:
        """K of Eq. (3), s/m; None for Coulomb's law."""
        return None if self.law == "coulomb" else STEEPNESS if self.slope is None else self.slope

    @property
    def normal_force(self) -> float:
        """Normal force, N: sum over the feet, without the force of `preload_stiffness`."""
        return sum(self.static_normal_force(foot) for foot in self.feet)

    @property
    def load(self) -> float:
        """Normal force on one beam, N: half the force of a foot between two beams."""
        return sum(self.static_normal_force(foot) * (0.5 if foot.mirrored else 1.0) for foot in self.feet)

    def static_normal_force(self, foot: Foot) -> float:
        """Normal force on one foot at rest, N: preload plus weight, on the lower face preload less weight.

        Between two beams it is twice the preload, or the weight where that is more.
        """
        weight, preload = self.mass * self.gravity / len(self.feet), self.preload / len(self.feet)
        if foot.mirrored:
            return max(2.0 * preload, weight)
        return max(preload - weight, 0.0) if foot.face == "lower" else weight + preload

    @property
    def effective_gravity(self) -> float:
        """Normal force of a foot over its mass in transverse motion, m/s^2, the least over all feet."""
        shares = ((foot, 0.5 if foot.mirrored else 1.0) for foot in self.feet)
        return min(share * self.static_normal_force(foot) / self.moving_mass(foot) for foot, share in shares)

    def moving_mass(self, foot: Foot) -> float:
        """Mass in transverse motion with one of the feet, kg."""
        return self.mass / len(self.feet) if foot.mass is None else foot.mass

    def initial_position(self, beam: Beam) -> float:
        """Initial position, m. Raises InputError off the beam."""
        x = 0.5 * beam.length if self.position is None else self.position
        check_position("slider.position", x, beam.length)
        return x


def changed(slider: Slider, **values: Any) -> Slider:
    """A slider with other values; a change of law drops the parameter of the former law. Raises InputError."""
    if values.get("law", slider.law) != slider.law:
        values = {OF_ONE_LAW[slider.law]: None} | values
    return replace(slider, **values)
