"""The slider: friction, contact and feet. Values, no numerics."""

from typing import Any, get_args

import msgspec
from msgspec.structs import replace

from verify.checks import check_kind, check_number, check_whole, check_word, settle
from verify.errors import InputError
from verify.options import CouplingChoice, Face, Kinematics, Law, Line, NormalChoice
from verify.problem.beam import Beam

GRAVITY = 9.81
STEEPNESS = 1e4
"""Default of K in Eq. (3), s/m."""
OF_ONE_LAW: dict[Law, str] = {"tanh": "slope", "coulomb": "mu_static"}
"""Fields that belong to one friction law only."""
_WORDS = {"law": Law, "coupling": CouplingChoice, "line": Line, "kinematics": Kinematics, "normal": NormalChoice}


class Contact(msgspec.Struct, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """Unilateral contact of a slider that may lose contact: compliant, or hard with restitution. Raises InputError."""

    stiffness: float | None = None
    """Normal stiffness of each foot, all its points together, N/m; without this and `layer_stiffness` hard contact."""
    damping: float = 0.0
    """Normal damping of each foot, N s/m; the contact force is never tensile."""
    tangential_stiffness: float | None = None
    """Tangential stiffness of each foot, N/m; rigid if not given."""
    layer_stiffness: float | None = None
    """Normal stiffness of a layer per metre of foot, N/m^2, in place of `stiffness`."""
    layer_tangential_stiffness: float | None = None
    """Tangential stiffness of a layer per metre of foot, N/m^2."""
    restitution: float = 0.0
    """Coefficient of restitution of hard contact, 0 to 1."""

    def __post_init__(self) -> None:
        settle(self)
        of_foot, of_layer = "N/m", "N/m for each metre of foot"
        for name, unit in (
            ("stiffness", of_foot),
            ("tangential_stiffness", of_foot),
            ("layer_stiffness", of_layer),
            ("layer_tangential_stiffness", of_layer),
        ):
            if (value := getattr(self, name)) is not None:
                check_number(f"slider.contact.{name}", value, unit, above=0)
        check_number("slider.contact.damping", self.damping, "N s/m", at_least=0)
        check_number("slider.contact.restitution", self.restitution, "speed after over speed before", at_least=0)
        self._check_kinds()

    def _check_kinds(self) -> None:
        """Raise InputError for contradictory fields."""
        if self.restitution > 1.0:
            raise InputError(
                f"slider.contact.restitution = {self.restitution!r}: nothing leaves faster than it came, give 0 to 1"
            )
        for one, other in (
            ("stiffness", "layer_stiffness"),
            ("tangential_stiffness", "layer_tangential_stiffness"),
        ):
            if getattr(self, one) is not None and getattr(self, other) is not None:
                raise InputError(
                    f"slider.contact.{one} = {getattr(self, one)!r} and {other} = {getattr(self, other)!r}: give one"
                )
        if not self.hard and self.restitution:
            name = "stiffness" if self.layer_stiffness is None else "layer_stiffness"
            raise InputError(
                f"slider.contact.restitution = {self.restitution!r} is of a hard contact: springs of "
                f"slider.contact.{name} lose by damping, leave one out"
            )
        for name in ("damping", "tangential_stiffness", "layer_tangential_stiffness"):
            if self.hard and getattr(self, name):
                raise InputError(
                    f"slider.contact.{name} = {getattr(self, name)!r} is of springs: give slider.contact.stiffness too"
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

    length: float = 0.0
    """Length along the beam, m."""
    points: int = 1
    """Number of contact points, at the middles of equal cells of the length, with equal shares of the stiffness."""
    offset: float = 0.0
    """Position of its middle relative to the slider, m."""
    mass: float | None = None
    """Mass that moves across the beam, kg; default the slider's mass over the number of feet."""
    inertia: float | None = None
    """Rotary inertia about its middle, kg m^2; default mass length^2 / 12."""
    pitches: bool = True
    """Whether it rotates; a foot of one point does not."""
    face: Face = "upper"
    """Face of the beam on which it is preloaded; on the lower one its weight acts against the preload."""
    mirrored: bool = False
    """Whether it is between the beam and the mirror image of the beam above it."""

    def __post_init__(self) -> None:
        settle(self)
        check_number("slider.foot.length", self.length, "metres", at_least=0)
        check_whole("slider.foot.points", self.points, 1)
        check_number("slider.foot.offset", self.offset, "metres")
        check_word("slider.foot.face", self.face, get_args(Face))
        for name in ("pitches", "mirrored"):
            check_kind(f"slider.foot.{name}", getattr(self, name), bool)
        for name, unit in (("mass", "kg"), ("inertia", "kg m^2")):
            if (value := getattr(self, name)) is not None:
                check_number(f"slider.foot.{name}", value, unit, above=0)
        if self.points > 1 and not self.length:
            raise InputError(f"slider.foot.points = {self.points!r} on no length: give slider.foot.length in metres")
        if self.points == 1 and self.inertia is not None:
            raise InputError(
                f"slider.foot.inertia = {self.inertia!r} of a foot of one point, which does not turn: leave it out"
            )
        if not self.pitches and self.inertia is not None:
            raise InputError(
                f"slider.foot.inertia = {self.inertia!r} with pitches = false, which does not turn: leave it out"
            )
        if self.mirrored and self.face != "upper":
            raise InputError(
                "slider.foot.mirrored = true on the lower face: a foot between two beams is on the upper one"
            )


class Slider(msgspec.Struct, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """A point mass on the surface, driven by friction.

    Friction by the paper's Eq. (3), F = -mu N tanh(K (v - v_beam)), or by Coulomb's law with stiction; N = m g +
    preload, v is the slider's speed along the tangent. Raises InputError.
    """

    mass: float
    """m_s, kg."""
    mu: float
    """Coefficient of (kinetic) friction."""
    slope: float | None = None
    """K of Eq. (3), s/m, for law = 'tanh'; default 1e4."""
    law: Law = "tanh"
    """Friction law: tanh is Eq. (3), which never sticks; coulomb has stiction."""
    mu_static: float | None = None
    """Coefficient of static friction, for law = 'coulomb'; default `mu`."""
    position: float | None = None
    """Initial position, m from the left end; default mid-span."""
    speed: float = 0.0
    """Initial speed along +x, m/s."""
    preload: float = 0.0
    """Normal force in addition to the weight, N."""
    gravity: float = GRAVITY
    """m/s^2."""
    coupling: CouplingChoice = "auto"
    """One-way or two-way coupling; auto decides by the size of the coupling."""
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
    pull: float = 0.0
    """External force along +x on a slider with [slider.contact], N; a braking load is negative."""
    preload_stiffness: float = 0.0
    """Stiffness of the spring that preloads each foot of a slider with [slider.contact], N/m."""

    def __post_init__(self) -> None:
        settle(self, "slider", foot=Foot)
        if self.contact is not None:
            check_kind("slider.contact", self.contact, Contact)
        self._check_feet()
        for name, kind in _WORDS.items():
            check_word(f"slider.{name}", getattr(self, name), get_args(kind))
        check_number("slider.mass", self.mass, "kg", above=0)
        check_number("slider.mu", self.mu, "coefficient of friction", above=0)
        if self.slope is not None:
            check_number("slider.slope", self.slope, "s/m", above=0)
            if self.law == "coulomb":
                raise InputError(
                    f"slider.slope = {self.slope!r} is K of Eq. (3), law = 'tanh': law = 'coulomb' has none, "
                    "leave it out"
                )
        check_number("slider.speed", self.speed, "m/s")
        check_number("slider.gravity", self.gravity, "m/s^2", at_least=0)
        check_number("slider.preload", self.preload, "newton", at_least=0)
        if self.mu_static is not None:
            check_number("slider.mu_static", self.mu_static, "coefficient of friction", at_least=self.mu)
            if self.law != "coulomb":
                raise InputError(
                    f"slider.mu_static = {self.mu_static!r} is for law = 'coulomb': Eq. (3) never sticks, leave it out"
                )
        if self.position is not None:
            check_number("slider.position", self.position, "metres")
        if self.mass * self.gravity + self.preload == 0.0:
            raise InputError("slider.gravity = 0.0 without slider.preload presses on nothing: give one of the two")

    def _check_feet(self) -> None:
        """Raise InputError for feet and loads without contact, and for what a slider with contact does not model."""
        check_number("slider.pull", self.pull, "newton along x")
        check_number("slider.preload_stiffness", self.preload_stiffness, "N/m", at_least=0)
        if self.contact is None:
            for name in ("foot", "pull", "preload_stiffness"):
                if getattr(self, name):
                    raise InputError(
                        f"slider.{name} belongs to a slider that may lose contact: give slider.contact too"
                    )
            return
        for name, fixed in (("mu_static", None), ("line", "spline"), ("kinematics", "tangential"), ("normal", "held")):
            if getattr(self, name) != fixed:
                raise InputError(
                    f"slider.{name} = {getattr(self, name)!r} belongs to a slider that never loses contact: leave it "
                    "out, or slider.contact"
                )
        layered = [
            name
            for name in ("layer_stiffness", "layer_tangential_stiffness")
            if getattr(self.contact, name) is not None
        ]
        for foot in self.feet:
            if layered and not foot.length:
                raise InputError(f"slider.contact.{layered[0]} is for each metre of foot: give slider.foot.length")
            if foot.length and foot.points == 1 and not layered and not self.contact.hard:
                raise InputError(
                    f"slider.foot.length = {foot.length!r} of a foot of one point, which touches at its middle: give "
                    "slider.foot.points, or leave the length out"
                )
        if self.contact.hard and (len(self.foot) > 1 or any(foot.points > 1 for foot in self.foot)):
            raise InputError("slider.foot: a hard contact is of one point, give slider.contact.stiffness or one point")

    def check_stays(self) -> None:
        """Raise InputError for a slider that may lose contact."""
        if self.contact is not None:
            raise InputError(
                "slider.contact belongs to a slider that may lose contact, for run_motor and [motor]: leave it out for "
                "one that never does"
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
        if not 0.0 <= x <= beam.length:
            raise InputError(
                f"slider.position = {x!r} lies off the beam: give a position between 0 and {beam.length!r} m"
            )
        return x


def changed(slider: Slider, **given: Any) -> Slider:
    """A slider with other values; another law drops the parameter of the first. Raises InputError."""
    if given.get("law", slider.law) != slider.law:
        given = {OF_ONE_LAW[slider.law]: None} | given
    return replace(slider, **given)
