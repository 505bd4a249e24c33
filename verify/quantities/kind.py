"""What a quantity is, and the typed arguments that quantities share."""

from collections.abc import Callable, Iterable
from typing import TYPE_CHECKING, Annotated, Any, ClassVar, Generic, Literal, TypeAlias, TypeVar

import msgspec
from msgspec import Meta

from verify import options
from verify.checks import Relative, check_sizes
from verify.errors import InputError
from verify.judge.bracket import Bracket
from verify.judge.variants import DEFAULTS
from verify.judge.workbench import Need, Settings, Workbench
from verify.models import catalogue
from verify.models.catalogue import MODELS
from verify.models.compiling import Call
from verify.models.naming import MEAN, model_meta

if TYPE_CHECKING:
    from verify.scenes.scene import Scene

Figure: TypeAlias = float | complex | Bracket
"""What a quantity is evaluated to."""

Work: TypeAlias = Literal["closed form", "matrices", "modes", "harmonic", "equilibrium", "in time", "promise"]
"""What is done for a figure: nothing but arithmetic; matrices, of which nothing is solved; eigenvalues, of models of
parts, for the exact beam's are closed forms; driven fields; equilibria and modes of the nonlinear chain; motion; any of
these on beams of its own, where a promise is pushed."""


Mode = Annotated[int, Meta(ge=1, description="mode number from 1, elastic modes only")]
Size = Annotated[int, Meta(ge=1, description="segments or elements; the exact beam has none")]
Sizes = Annotated[tuple[Annotated[int, Meta(ge=1)], ...], Meta(description="three or more sizes, 20,40,80")]
_BRACKET = "mean is the middle between segment (below) and fem (above), nearer up to beta L = 0.696 pi N"
AnyModel = Annotated[str, model_meta(_BRACKET, "solve_modes", mean=True)]
ModesModel = Annotated[str, model_meta("which model", "solve_modes")]
DiscreteModel = Annotated[str, model_meta("which discrete model", "solve_modes", sized=True)]
FieldModel = Annotated[str, model_meta("which model", "solve_harmonic")]
DiscreteField = Annotated[str, model_meta("which discrete model", "solve_harmonic", sized=True)]
UnitModel = Annotated[str, model_meta("which model", "unit_responses")]
MovingModel = Annotated[str, model_meta("which model", "time_basis")]
Theory = Annotated[options.Theory, Meta(description="of the beam: with its rotary inertia, and its shear as well")]
Reading = Annotated[
    str, Meta(description="segment: corrected (y + delta^2 y / 12) or raw; fem: nodal; default the first")
]
Wall = Annotated[
    options.Wall,
    Meta(description="how segments are held at a clamped end; half is the literature's k = 2EI/l"),
]
Joints = Annotated[options.Joints, Meta(description="Eq. (1) of the segments' joints: put right, or as printed")]
Attachment = Annotated[
    options.Attachment, Meta(description="how segments feel point masses and springs: order 4, or as on a rigid link")
]
Grading = Annotated[float, Meta(gt=0, description="length of a section's last part over its first")]


def check_count(model: str, count: int | None) -> None:
    """Raise InputError for a model of parts without their number, or one that has none with one."""
    if model != MEAN:
        catalogue.check_count(model, count)
    elif count is None:
        raise InputError(f"count is missing: give the number of segments or elements for model = {MEAN}")


WHAT_EXISTS = ("beam", "drive", "slider", "motion")
"""Tables that say what there is, not what is asked of it."""


class Arguments(msgspec.Struct, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """Base of the typed arguments of a quantity."""

    slides: ClassVar[bool] = False
    """Whether they are about the scene's slider."""
    chained: ClassVar[bool] = False
    """Whether they are about the nonlinear chain."""
    reads: ClassVar[tuple[str, ...]] = WHAT_EXISTS
    """Tables of a scene on which the figure depends; a gate is about another scene where one of these is."""
    places: ClassVar[tuple[str, ...]] = ()
    """Those that are places on the beam, metres from its left end."""


class Divided(Arguments, frozen=True, kw_only=True):
    """Arguments with the settings of the discrete models."""

    reads: ClassVar[tuple[str, ...]] = ("beam",)
    wall: Wall = "gregory"
    joints: Joints = "series"
    grading: Grading = 1.0
    theory: Theory = "euler-bernoulli"
    attachment: Attachment = "reciprocal"

    @property
    def settings(self) -> Settings:
        """Those that are not the default."""
        pairs = ((name, getattr(self, name)) for name in DEFAULTS)
        return tuple((name, value) for name, value in pairs if value != DEFAULTS[name])

    def check_settings(self, model: str) -> None:
        """Raise InputError for a setting that the model does not have."""
        known = () if model == MEAN else MODELS.named(model).modal_settings
        for name, value in self.settings:
            if model != MEAN and name not in known:
                able = " or ".join(m.name for m in catalogue.discrete() if name in m.modal_settings)
                raise InputError(f"{name} = {value!r} is a setting of model = {able}, not of {model}")


class AtSize(Divided, frozen=True, kw_only=True):
    """One mode of one model at one size."""

    model: AnyModel
    mode: Mode
    count: Size | None = None

    def __post_init__(self) -> None:
        check_count(self.model, self.count)
        self.check_settings(self.model)


class DiscreteAtSize(Divided, frozen=True, kw_only=True):
    """One mode of one discrete model at one size."""

    model: DiscreteModel
    mode: Mode
    count: Size

    def __post_init__(self) -> None:
        self.check_settings(self.model)


class ShapeAt(DiscreteAtSize, frozen=True, kw_only=True):
    """One shape of one discrete model."""

    reading: Reading | None = None


class NodeAt(Divided, frozen=True, kw_only=True):
    """One node of one shape of one model."""

    model: ModesModel
    mode: Mode
    node: Annotated[int, Meta(ge=1, description="which node, from the left, ends not counted")] = 1
    count: Size | None = None

    def __post_init__(self) -> None:
        check_count(self.model, self.count)
        self.check_settings(self.model)


class ShapeOf(Divided, frozen=True, kw_only=True):
    """One shape of one model at one place."""

    places: ClassVar[tuple[str, ...]] = ("x",)
    model: ModesModel
    mode: Mode
    x: Annotated[float, Meta(description="metres from the left end")]
    count: Size | None = None

    def __post_init__(self) -> None:
        check_count(self.model, self.count)
        self.check_settings(self.model)


class OverSizes(Divided, frozen=True, kw_only=True):
    """One mode of one model over several sizes."""

    model: Annotated[str, model_meta("mean is the middle of the bracket", "solve_modes", sized=True, mean=True)]
    mode: Mode
    counts: Sizes

    def __post_init__(self) -> None:
        self.check_settings(self.model)
        check_sizes("counts", self.counts)


class ShapesOverSizes(OverSizes, frozen=True, kw_only=True):
    """One shape of one discrete model over several sizes."""

    model: DiscreteModel
    reading: Reading | None = None


class BracketAt(Divided, frozen=True, kw_only=True):
    """One mode at one size, both discrete models."""

    mode: Mode
    count: Size


class FirstModes(Arguments, frozen=True, kw_only=True):
    """The first modes of one discrete model at one size."""

    reads: ClassVar[tuple[str, ...]] = ("beam",)
    model: DiscreteModel
    count: Size
    modes: Annotated[int, Meta(ge=1, description="how many modes, from the first")] = 22


class Elements(Arguments, frozen=True, kw_only=True):
    """A mesh of Hermite elements."""

    reads: ClassVar[tuple[str, ...]] = ("beam",)
    count: Size
    grading: Grading = 1.0


class StockMode(Arguments, frozen=True, kw_only=True):
    """One mode of equal Hermite elements, by stock scikit-fem and by ours."""

    reads: ClassVar[tuple[str, ...]] = ("beam",)
    mode: Mode
    count: Size


class ToError(Divided, frozen=True, kw_only=True):
    """An accuracy wanted of one mode of one discrete model."""

    model: DiscreteModel
    mode: Mode
    error: Annotated[Relative, Meta(gt=0, lt=1, description="largest relative frequency error, for instance 0.01")]
    of: Annotated[
        Literal["enough", "least"],
        Meta(description="from here on enough; or the least that does, where an error changes its sign below that"),
    ] = "enough"

    def __post_init__(self) -> None:
        self.check_settings(self.model)


class PlateMode(Arguments, frozen=True, kw_only=True):
    """One mode of a strip."""

    reads: ClassVar[tuple[str, ...]] = ("beam",)
    mode: Mode


class NeighbourModes(Arguments, frozen=True, kw_only=True):
    """A mode and the one below it."""

    reads: ClassVar[tuple[str, ...]] = ("beam",)
    mode: Annotated[int, Meta(ge=2, description="the upper one of two neighbouring modes")] = 22


class AtFrequency(Arguments, frozen=True, kw_only=True):
    """A frequency, the scene's drive unless given."""

    reads: ClassVar[tuple[str, ...]] = ("beam", "drive")
    frequency_hz: Annotated[float, Meta(gt=0, description="default: the scene's drive")] | None = None


class DriveArguments(AtFrequency, frozen=True, kw_only=True):
    """The drive of a scene, with what is given instead."""

    places: ClassVar[tuple[str, ...]] = ("position",)
    phase_deg: Annotated[float, Meta(description="of the second force; default: the scene's")] | None = None
    position: Annotated[float, Meta(description="d of the first force, L-d of the second, metres")] | None = None


A = TypeVar("A", bound=Arguments)


def no_needs(arguments: Any, scene: "Scene") -> tuple[Need, ...]:
    """Nothing that has to be solved beforehand."""
    return ()


def no_kernels(arguments: Any, scene: "Scene") -> Iterable[Call]:
    """Nothing that is compiled."""
    return ()


class Quantity(msgspec.Struct, Generic[A], frozen=True):
    """A named figure. One is registered by `QUANTITIES.register(mine)` or as an entry point of `verify.quantities`."""

    name: str
    unit: str
    summary: str
    arguments: type[A]
    work: Work
    evaluate: Callable[[A, "Scene", Workbench], Figure]
    """Raises InputError."""
    needs: Callable[[A, "Scene"], tuple[Need, ...]] = no_needs
    """What has to be solved for it, as far as can be known beforehand. Raises InputError where it cannot be."""
    models: tuple[str, ...] = ()
    """Models that it uses beside the one its arguments name and those of its needs."""
    kernels: Callable[[A, "Scene"], Iterable[Call]] = no_kernels
    """Compiled loops that it runs, called with values of the right kinds, in order of need. May raise InputError."""
    searches: bool = False
    """Whether it goes through sizes of which `needs` knows the first alone."""
    devices: bool = False
    """Whether it knows a drive's devices; one of the beam that does not is refused beside them."""
    superposed: str = ""
    """Of a figure that a map over frequency and phase superposes from two unit drives: which of theirs it is."""
