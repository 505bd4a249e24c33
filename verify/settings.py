"""One table of what can be chosen about a model, and the named choices of scenes, scripts and commands.

`ModelSettings` is the table of the settings: name, choices or limits, meaning, default, in the order of labels. Options
of models, quantities, studies and commands are views of it. `WALLS` is the table of the joints at a clamped end, of
which the three chains (`segments`, `engines`, `compare`) and their orders and labels are views.
"""

from typing import TYPE_CHECKING, Annotated, Literal, NamedTuple, TypeAlias, get_args

import msgspec
from msgspec import Meta

from verify.validation import check_choice, convert, python_scalar, unit


class WallRule(NamedTuple):
    """The joints of a chain at a clamped end: weights of a quadrature of M^2/EI along the beam (`segments.walls`)."""

    meaning: str
    """In words, without the name."""
    weights: tuple[float, ...] = ()
    """Compliances of the joints from the wall on, in l/EI; those beyond have 1, a joint of 0 is rigid."""
    first: float = 0.0
    """Distance of the first joint from the wall, in links; the beam before it is part of the wall."""
    fault: bool = False
    """Whether only chains of other programs have the rule, which `verify compare` and `chain` recognise."""

    @property
    def corrections(self) -> tuple[float, ...]:
        """Corrections of the weights 1, in l/EI."""
        return tuple(weight - 1.0 for weight in self.weights)

    @property
    def order(self) -> int:
        """Order of the frequencies of a uniform beam: that of the quadrature, at most 4, that of the inner joints.

        It is p + 1 of the first moment that does not vanish (`docs/theory.md`, "Walls").
        """
        s = self.first  # B_{p+1}(s)/(p + 1), p = 0, 1, 2, of Bernoulli's polynomials:
        integrals = s - 1 / 2, (s**2 - s + 1 / 6) / 2, (s**3 - 3 * s**2 / 2 + s / 2) / 3
        for p, integral in enumerate(integrals):
            moment = sum(a * (s + k) ** p for k, a in enumerate(self.corrections))
            if abs(moment - integral) > 1e-9:  # sums of fractions with rounding; a wrong digit is far above
                return p + 1
        return 4


WALLS: dict[str, WallRule] = {
    "gregory": WallRule("3/8, 7/6, 23/24", (3 / 8, 7 / 6, 23 / 24)),  # Gregory's end correction
    "half": WallRule("2EI/l", (1 / 2,)),  # the literature's spring, Eq. (1) with a rigid neighbour
    "full": WallRule("EI/l", (1.0,)),  # the spring of an inner joint, a frequent mistake
    "welded": WallRule("half a link welded", first=0.5),  # midpoint rule, a whole joint EI/l behind the half link
    "third-order": WallRule("5/12, 13/12", (5 / 12, 13 / 12)),
    # slightly better than Gregory's for low modes
    "five-joint": WallRule("five weights", (95 / 288, 317 / 240, 23 / 30, 793 / 720, 157 / 160)),
    "rigid": WallRule("first link fixed", (0.0,), fault=True),
    "stiff": WallRule("4EI/l", (1 / 4,), fault=True),
}
"""Rules by name. A row is all that a rule needs: models, scenes, `verify chain` and `verify compare` read it here."""


def wall_label(name: str) -> str:
    """A rule in tables and sentences: its name and its meaning."""
    return f"wall {name} ({WALLS[name].meaning})"


if TYPE_CHECKING:
    Wall: TypeAlias = str
else:  # a type checker knows no table
    _NAMES = tuple(name for name, rule in WALLS.items() if not rule.fault)
    Wall = Annotated[Literal[_NAMES], Meta(description="joints at a clamped end; half: k = 2EI/l")]

Theory = Annotated[Literal["euler-bernoulli", "rayleigh", "timoshenko"], Meta(description="beam theory")]
THEORIES: tuple[str, ...] = get_args(get_args(Theory)[0])
"""rayleigh: euler-bernoulli with rotary inertia. timoshenko: rayleigh with shear."""

Joints = Annotated[Literal["series", "printed", "tensioned"], Meta(description="joint stiffness, Eq. (1)")]
"""series: the paper's Eq. (1) corrected, two half links in series. printed: Eq. (1) with its
indices as printed. tensioned: series with corrections of axial force (less T l/12) and rotary inertia: order 4 under
axial force and in Rayleigh and Timoshenko theory."""

Rule = Literal["reciprocal", "lever"]
Attachment = Annotated[Rule, Meta(description="distribution of point masses and springs on segments")]
"""reciprocal: over four joints, order 4. lever: to the rigid link, order 1 or 2."""

Load = Annotated[Rule, Meta(description="segment: distribution of a force over joints")]
"""reciprocal: over four joints, order 4. lever: over the two joints of the link, order 2."""

Reading = Annotated[Literal["corrected", "raw", "links"], Meta(description="segment: interpolation between joints")]
"""corrected: spline through y + delta^2 y / 12. raw: spline through y. links: straight links."""


class ModelSettings(msgspec.Struct, frozen=True, kw_only=True):
    """Settings of the models on which frequencies depend, in the order of labels."""

    wall: Wall = "gregory"
    joints: Joints = "series"
    grading: Annotated[float, Meta(gt=0, description="length of a section's last part over its first")] = 1.0
    theory: Theory = "euler-bernoulli"
    attachment: Attachment = "reciprocal"


class Settings(ModelSettings, frozen=True, kw_only=True):
    """All settings of the models; the last ones act on fields under loads alone."""

    load: Load = "reciprocal"
    reading: Reading = "corrected"
    joint_dashpot: Annotated[float, unit("N m s", ge=0, le=1e50), Meta(description="segment: at every joint")] = 0.0


DEFAULT = Settings()
"""The default of every setting."""
_TYPES = {field.name: field.type for field in msgspec.structs.fields(Settings)}


def check_setting(name: str, value: object) -> None:
    """Raise InputError for a value outside the choices or limits of a setting of the table."""
    if name == "wall":
        check_choice(name, value, [wall for wall, rule in WALLS.items() if not rule.fault])
    elif name in _TYPES:
        convert(python_scalar(value), _TYPES[name], name)


Shape = Literal["rectangle", "round", "tube"]
"""Cross-section. rectangle: width and thickness. round: diameter. tube: diameter and wall_thickness."""

ChainReading = Literal["corrected", "links"]
"""Interpolation between the joints of a nonlinear chain, as of `Reading`."""

Line = Literal["spline", "raw"]
"""Contact line of a chain. spline: the paper's C2 spline (Section II.B). raw: the straight edges of the links."""

Links = Literal["rigid", "stretching"]
LINKS: tuple[str, ...] = get_args(Links)
"""Links of a nonlinear chain. rigid: as in the paper. stretching: axial stiffness EA / l."""

Inertia = Literal["full", "transverse", "elastic"]
"""Axial inertia of links. full: rigid links. transverse: rigid links, none along x. elastic: stretching links."""

Tip = Literal["free", "roller"]
"""Far end of a nonlinear chain. free: no constraint. roller: y = 0, free along x."""

Law = Literal["tanh", "coulomb"]
"""Friction law. tanh: the paper's Eq. (3), without stiction. coulomb: Coulomb's law with stiction."""

CouplingChoice = Literal["two-way", "one-way"]
"""Coupling of slider and beam. two-way: contact forces act on both. one-way: on the slider alone."""

Kinematics = Literal["tangential", "following"]
"""Slider kinematics. tangential: m dv/dt = F, dx/dt = v. following: exact motion on the moving surface."""

NormalChoice = Literal["bilateral", "massless"]
"""Normal force of a two-way slider on the beam. bilateral: weight and inertia. massless: none, as in the paper."""

Face = Literal["upper", "lower"]
"""Face of the beam on which a foot rests."""

Start = Literal["rest", "steady"]
"""Initial state. rest: at rest, with the static deflection under a slider. steady: steady state under the drive."""

DriveKind = Literal["force", "moment", "displacement", "voltage", "current"]
DRIVE_UNITS = {"force": "N", "moment": "N m", "displacement": "m", "voltage": "V", "current": "A"}
"""Kind of a drive. force, moment: imposed forces, N, and moments, N m. displacement: imposed displacements, m.
voltage, current: of actuators, V and A."""

Reference = Literal["closed form", "independent method", "published", "other code", "measured", "regression"]
"""Reference of a gate's expected value. closed form: a formula. independent method: another derivation. published: a
publication. other code: another program. measured: an experiment. regression: an earlier value of this package."""
