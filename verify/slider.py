"""The slider as a scene or a script states it. Data, no numerics."""

from typing import Any, get_args

from msgspec.structs import replace

from verify.beam import Beam
from verify.checks import check_kind, check_number, check_whole, check_word, settle
from verify.errors import InputError
from verify.options import CouplingChoice, Face, Kinematics, Law, Line, NormalChoice

GRAVITY = 9.81
STEEPNESS = 1e4
"""K of Eq. (3), s/m, unless given."""
OF_ONE_LAW: dict[Law, str] = {"tanh": "slope", "coulomb": "mu_static"}
"""Fields that only one law of friction has."""
_WORDS = {"law": Law, "coupling": CouplingChoice, "line": Line, "kinematics": Kinematics, "normal": NormalChoice}


class Contact(msgspec.Struct, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """How a slider that may leave the surface touches it: through springs, or hard. Raises InputError."""

    stiffness: float | None = None
    """N/m of each foot, all its points together; with `layer_stiffness` none, a hard contact."""
    damping: float = 0.0
    """N s/m, likewise. A dashpot never pulls."""
    tangential_stiffness: float | None = None
    """N/m along the surface, likewise; none: it does not give way along the surface."""
    layer_stiffness: float | None = None
    """N/m for each metre of a foot, of a layer between foot and beam: in place of `stiffness`."""
    layer_tangential_stiffness: float | None = None
    """The same along the surface."""
    restitution: float = 0.0
    """Speed after a hard landing over speed before, 0 to 1."""

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
        """Raise InputError for what no one contact can be."""
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
        """Whether nothing gives way."""
        return self.stiffness is None and self.layer_stiffness is None

    def across(self, length: float) -> float:
        """Stiffness of a foot of this length, N/m."""
        return (self.stiffness or 0.0) + (self.layer_stiffness or 0.0) * length

    def along(self, length: float) -> float:
        """The same along the surface; 0 where it does not give way."""
        return (self.tangential_stiffness or 0.0) + (self.layer_tangential_stiffness or 0.0) * length


class Foot(msgspec.Struct, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """A rigid foot of a slider that may leave the surface, with its own height and pitch. Raises InputError."""

    length: float = 0.0
    """Along the beam, metres."""
    points: int = 1
    """At which it touches, in the middles of as many equal cells of its length, with equal shares of the stiffness."""
    offset: float = 0.0
    """Of its middle from the slider's position, metres."""
    mass: float | None = None
    """That moves across the beam, kg; its share of the slider's unless given."""
    inertia: float | None = None
    """About its middle, kg m^2; mass length^2 / 12 unless given."""
    pitches: bool = True
    """Whether it turns; a foot of one point never does."""
    face: Face = "upper"
    """Of the beam, on which the preload presses it; its weight pulls it off the lower one."""
    mirrored: bool = False
    """Whether the mirror image of the beam presses on it from above, as a slider between two beams has it."""

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
    """A point mass that stays on the surface and is carried along by friction.

    Friction is the paper's Eq. (3), F = -mu N tanh(K (v - v_beam)), or Coulomb's law with true sticking. N is
    m g + preload. `v` is the slider's speed along the tangent. Raises InputError.
    """

    mass: float
    """m_s, kg."""
    mu: float
    """Coefficient of (kinetic) friction."""
    slope: float | None = None
    """K of Eq. (3), s/m, of law = 'tanh' alone; 1e4 unless given."""
    law: Law = "tanh"
    """Friction: tanh is Eq. (3), which never sticks; coulomb sticks."""
    mu_static: float | None = None
    """Of Coulomb's law at rest; as `mu` unless given."""
    position: float | None = None
    """Where it starts, metres from the left end; mid-span unless given."""
    speed: float = 0.0
    """Along +x at the start, m/s."""
    preload: float = 0.0
    """Newton pressing it on, beside its weight."""
    gravity: float = GRAVITY
    """m/s^2."""
    coupling: CouplingChoice = "auto"
    """Whether the beam feels the slider; auto decides by size."""
    line: Line = "spline"
    """Contact line on a chain: the paper's C2 spline, or the links' own straight edges."""
    kinematics: Kinematics = "tangential"
    """tangential: m dv/dt = F and dx/dt = v, as in the paper. following: the path of a point that follows the
    surface exactly, with dx/dt = v - w' dw/dt and the inertia of the turning tangent."""
    normal: NormalChoice = "held"
    """What a slider coupled two-way presses the beam with. held: m g + preload and its inertia across the beam, m times
    the acceleration of the surface under it, convective terms included: a moving mass. massless: nothing, the paper's
    simplification. Friction has N = m g + preload either way."""

    contact: Contact | None = None
    """How it touches where it may leave the surface; unless given it never does."""
    foot: tuple[Foot, ...] = ()
    """Where it may leave the surface: what it stands on, all with one speed; one point unless given."""
    pull: float = 0.0
    """Newton along +x on it, where it may leave the surface: a load that brakes is negative."""
    preload_stiffness: float = 0.0
    """N/m of the spring that presses each foot on, where it may leave the surface."""

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
        """Raise InputError for feet and loads of a slider that never leaves the surface, and what they do not take."""
        check_number("slider.pull", self.pull, "newton along x")
        check_number("slider.preload_stiffness", self.preload_stiffness, "N/m", at_least=0)
        if self.contact is None:
            for name in ("foot", "pull", "preload_stiffness"):
                if getattr(self, name):
                    raise InputError(
                        f"slider.{name} is of a slider that may leave the surface: give slider.contact too"
                    )
            return
        for name, fixed in (("mu_static", None), ("line", "spline"), ("kinematics", "tangential"), ("normal", "held")):
            if getattr(self, name) != fixed:
                raise InputError(
                    f"slider.{name} = {getattr(self, name)!r} is of a slider that never leaves: leave it out, or "
                    "slider.contact"
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
        """Raise InputError for one that may leave the surface, where nothing is made for that."""
        if self.contact is not None:
            raise InputError(
                "slider.contact is of a slider that may leave the surface, which run_motor and [motor] run: leave it "
                "out for one that always stays on"
            )

    @property
    def feet(self) -> tuple[Foot, ...]:
        """What it stands on: one point unless said otherwise."""
        return self.foot or (Foot(),)

    @property
    def steepness(self) -> float | None:
        """K of Eq. (3), s/m: `slope`, or what it is unless given; None of Coulomb's law."""
        return None if self.law == "coulomb" else STEEPNESS if self.slope is None else self.slope

    @property
    def normal_force(self) -> float:
        """N, newton: what presses all its feet on, each on its own face, without what a `preload_stiffness` adds."""
        return sum(self.pressing(foot) for foot in self.feet)

    @property
    def load(self) -> float:
        """Newton on one beam: of a foot between two beams each bears half."""
        return sum(self.pressing(foot) * (0.5 if foot.mirrored else 1.0) for foot in self.feet)

    def pressing(self, foot: Foot) -> float:
        """What presses one of its feet on at rest, newton: preload and weight, which lifts it off the lower face.

        Between two beams the preload comes from either: both together, or the weight alone where that is more.
        """
        weight, preload = self.mass * self.gravity / len(self.feet), self.preload / len(self.feet)
        if foot.mirrored:
            return max(2.0 * preload, weight)
        return max(preload - weight, 0.0) if foot.face == "lower" else weight + preload

    @property
    def effective_gravity(self) -> float:
        """m/s^2: what presses a foot on a beam, over what moves with it across; of the foot where that is least."""
        each = ((0.5 if foot.mirrored else 1.0) * self.pressing(foot) / self.moved_by(foot) for foot in self.feet)
        return min(each)

    def moved_by(self, foot: Foot) -> float:
        """What of it moves with one of its feet across the beam, kg."""
        return self.mass / len(self.feet) if foot.mass is None else foot.mass

    def start_on(self, beam: Beam) -> float:
        """Where it starts, metres. Raises InputError off the beam."""
        x = 0.5 * beam.length if self.position is None else self.position
        if not 0.0 <= x <= beam.length:
            raise InputError(
                f"slider.position = {x!r} lies off the beam: give a position between 0 and {beam.length!r} m"
            )
        return x


def changed(slider: Slider, **given: Any) -> Slider:
    """A slider with other values; another law leaves what only the first has behind. Raises InputError."""
    if given.get("law", slider.law) != slider.law:
        given = {OF_ONE_LAW[slider.law]: None} | given
    return replace(slider, **given)
