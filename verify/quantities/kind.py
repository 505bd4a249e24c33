"""What a quantity is, and the typed arguments that quantities take."""

from collections.abc import Callable
from typing import TYPE_CHECKING, Annotated, Any, Literal

import msgspec
from msgspec import Meta

from verify import options
from verify.errors import InputError
from verify.judge.workbench import Need, Settings, Workbench

if TYPE_CHECKING:
    from verify.scenes.scene import Scene

Mode = Annotated[int, Meta(ge=1, description="mode number from 1, elastic modes only")]
Size = Annotated[int, Meta(ge=1, description="segments or elements; the exact beam has none")]
Sizes = Annotated[tuple[Annotated[int, Meta(ge=1)], ...], Meta(description="three or more sizes, 20,40,80")]
AnyModel = Annotated[
    Literal["analytic", "fem", "segment", "mean"],
    Meta(description="mean is the middle between segment (below) and fem (above), nearer up to beta L = 0.696 pi N"),
]
DiscreteModel = Annotated[Literal["fem", "segment"], Meta(description="which discrete model")]
Theory = Annotated[
    Literal["euler-bernoulli", "rayleigh", "timoshenko"], Meta(description="beam theory of the analytic model")
]
Reading = Annotated[
    str, Meta(description="segment: corrected (y + delta^2 y / 12) or raw; fem: nodal; default the first")
]
Wall = Annotated[
    options.Wall,
    Meta(description="how segments are held at a clamped end; half is the literature's k = 2EI/l"),
]
Joints = Annotated[options.Joints, Meta(description="Eq. (1) of the segments' joints: put right, or as printed")]
Grading = Annotated[float, Meta(gt=0, description="length of a section's last part over its first")]


def check_count(model: str, count: int | None) -> None:
    """Raise InputError for a discrete model without its size, or the exact beam with one."""
    if model != "analytic" and count is None:
        raise InputError(f"count is missing: give the number of segments or elements for model = {model}")
    if model == "analytic" and count is not None:
        raise InputError(f"count = {count!r} is for model = fem or segment: the exact beam has no parts, leave it out")


class Arguments(msgspec.Struct, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """Base of the typed arguments of a quantity."""


class Divided(Arguments, frozen=True, kw_only=True):
    """Arguments with the settings of the discrete models."""

    wall: Wall = "gregory"
    joints: Joints = "series"
    grading: Grading = 1.0

    @property
    def settings(self) -> Settings:
        """Those that are not the default."""
        chosen: list[tuple[str, str | float]] = []
        chosen += [("wall", self.wall)] if self.wall != "gregory" else []
        chosen += [("joints", self.joints)] if self.joints != "series" else []
        chosen += [("grading", self.grading)] if self.grading != 1.0 else []
        return tuple(chosen)

    def check_settings(self, model: str) -> None:
        """Raise InputError for a setting that the model does not have."""
        for name, _ in self.settings:
            if model in ("analytic", "fem") and (name != "grading" or model == "analytic"):
                raise InputError(f"{name} = {getattr(self, name)!r} is a setting of model = segment, not of {model}")


class AtSize(Divided, frozen=True, kw_only=True):
    """One mode of one model at one size."""

    model: AnyModel
    mode: Mode
    count: Size | None = None
    theory: Theory = "euler-bernoulli"

    def __post_init__(self) -> None:
        check_count(self.model, self.count)
        if self.model != "analytic" and self.theory != "euler-bernoulli":
            raise InputError(
                f"theory = {self.theory!r} belongs to model = analytic: the {self.model} model is Euler-Bernoulli"
            )
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

    model: Annotated[Literal["analytic", "fem", "segment"], Meta(description="which model")]
    mode: Mode
    node: Annotated[int, Meta(ge=1, description="which node, from the left, ends not counted")] = 1
    count: Size | None = None

    def __post_init__(self) -> None:
        check_count(self.model, self.count)
        self.check_settings(self.model)


class OverSizes(Divided, frozen=True, kw_only=True):
    """One mode of one model over several sizes."""

    model: Annotated[
        Literal["fem", "segment", "mean"],
        Meta(description="mean is the middle of the bracket"),
    ]
    mode: Mode
    counts: Sizes

    def __post_init__(self) -> None:
        self.check_settings(self.model)


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

    model: DiscreteModel
    count: Size
    modes: Annotated[int, Meta(ge=1, description="how many modes, from the first")] = 22


class ToError(Divided, frozen=True, kw_only=True):
    """An accuracy wanted of one mode of one discrete model."""

    model: DiscreteModel
    mode: Mode
    error: Annotated[float, Meta(gt=0, lt=1, description="largest relative frequency error, for instance 0.01")]
    of: Annotated[
        Literal["enough", "least"],
        Meta(description="from here on enough; or the least that does, where an error changes its sign below that"),
    ] = "enough"

    def __post_init__(self) -> None:
        self.check_settings(self.model)


class NeighbourModes(Arguments, frozen=True, kw_only=True):
    """A mode and the one below it."""

    mode: Annotated[int, Meta(ge=2, description="the upper one of two neighbouring modes")] = 22


class AtFrequency(Arguments, frozen=True, kw_only=True):
    """A frequency, the scene's drive unless given."""

    frequency_hz: Annotated[float, Meta(gt=0, description="default: the scene's drive")] | None = None


class Quantity(msgspec.Struct, frozen=True):
    """A named figure."""

    name: str
    unit: str
    summary: str
    arguments: type[Arguments]
    needs: Callable[[Any, "Scene"], tuple[Need, ...]]
    """What has to be solved for it, as far as can be known beforehand."""
    evaluate: Callable[[Any, "Scene", Workbench], Any]
