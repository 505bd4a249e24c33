"""The typed arguments of figures of the driven beam."""

from typing import Annotated, Any, ClassVar, Literal

from msgspec import Meta

from verify import options
from verify.checks import Relative, check_sizes
from verify.errors import InputError
from verify.judge.variants import DEFAULTS
from verify.models.catalogue import MODELS
from verify.quantities.kind import (
    Arguments,
    AtFrequency,
    Attachment,
    DiscreteField,
    DriveArguments,
    FieldModel,
    Joints,
    Mode,
    Size,
    Sizes,
    Theory,
    UnitModel,
    Wall,
    check_count,
)
from verify.words import as_written

Window = Annotated[tuple[float, float], Meta(description="metres, start and end; default L/4 to 3L/4")]


Loss = Annotated[Relative, Meta(description="eta of E (1 + i eta); default: the beam's")]
Imposed = Annotated[options.DriveKind, Meta(description="what is imposed; default: the scene's")]


class Driven(DriveArguments, frozen=True, kw_only=True):
    """A driven beam: what is not given is the scene's."""

    model: FieldModel = "analytic"
    count: Size | None = None
    loss_factor: Loss | None = None
    modal_damping: Annotated[Relative, Meta(description="ratio of every mode; fem and segment")] = 0.0
    joint_dashpot: Annotated[float, Meta(description="N m s at every joint; segment")] = 0.0
    drive: Imposed | None = None
    load: Annotated[options.Load, Meta(description="how a force is shared among joints; segment")] = "reciprocal"
    reading: Annotated[options.Reading, Meta(description="how the chain is read between joints; segment")] = "corrected"
    wall: Wall = "gregory"
    joints: Joints = "series"
    theory: Theory = "euler-bernoulli"
    attachment: Attachment = "reciprocal"

    def __post_init__(self) -> None:
        check_count(self.model, self.count)
        self.check_settings()

    def check_settings(self) -> None:
        """Raise InputError for a setting that the model does not have."""
        known = MODELS.named(self.model).field_settings
        for name, value in self.settings:
            if name in known:
                continue
            if not MODELS[self.model].sized and name == "modal_damping":
                raise InputError("modal_damping is for model = fem or segment: the analytic field takes a loss_factor")
            able = " or ".join(m.name for m in MODELS.values() if name in m.field_settings)
            raise InputError(f"{name} = {value!r} is for model = {able}, not for {self.model}")

    @property
    def settings(self) -> tuple[tuple[str, Any], ...]:
        """Keyword arguments of the model's solve_harmonic other than their defaults."""
        chosen = {"modal_damping": 0.0, "joint_dashpot": 0.0, "load": "reciprocal", "reading": "corrected"}
        chosen |= {name: DEFAULTS[name] for name in ("wall", "joints", "theory", "attachment")}
        return tuple((name, getattr(self, name)) for name, default in chosen.items() if getattr(self, name) != default)


class At(Driven, frozen=True, kw_only=True):
    """A driven beam and a place on it."""

    places: ClassVar[tuple[str, ...]] = ("position", "x")
    x: Annotated[float, Meta(description="metres from the left end")]


class InWindow(Driven, frozen=True, kw_only=True):
    """A driven beam and a window on it."""

    window: Window | None = None


class Power(InWindow, frozen=True, kw_only=True):
    """A window and a balance of power up to its middle, with losses by the loss factor alone."""

    def __post_init__(self) -> None:
        super().__post_init__()
        for name in ("modal_damping", "joint_dashpot"):
            if value := getattr(self, name):
                raise InputError(
                    f"{name} = {value!r}: a power balance counts the losses of a loss_factor alone, give that instead"
                )


class AxisRatio(InWindow, frozen=True, kw_only=True):
    """A window to take the mean over, or a place."""

    places: ClassVar[tuple[str, ...]] = ("position", "x")
    x: Annotated[float, Meta(description="metres; default: the mean over whole half wavelengths")] | None = None

    def __post_init__(self) -> None:
        super().__post_init__()
        if self.x is not None and self.window is not None:
            raise InputError(
                f"x = {self.x!r} and window = {as_written(self.window)}: a place needs no window, give one"
            )


class WaveOrder(InWindow, frozen=True, kw_only=True):
    """A figure of a discrete model over several sizes."""

    model: DiscreteField
    counts: Sizes
    count: Annotated[int, Meta(ge=1, description="refused here: give counts")] | None = None
    of: Annotated[
        Literal["standing_wave_ratio", "axis_ratio", "deflection"],
        Meta(description="whose error; deflection at x, the middle of the window"),
    ] = "standing_wave_ratio"

    def __post_init__(self) -> None:
        if self.count is not None:
            raise InputError(f"count = {self.count!r}: wave.order takes several sizes, give counts instead")
        check_sizes("counts", self.counts)
        self.check_settings()
        for name in ("modal_damping", "joint_dashpot"):
            if value := getattr(self, name):
                raise InputError(
                    f"{name} = {value!r}: wave.order compares with the exact beam, which takes a loss_factor: give that"
                )


class BestFrequency(InWindow, frozen=True, kw_only=True):
    """Where the reflection is least."""

    span: Annotated[Relative, Meta(gt=0, lt=0.5, description="search within this part of the drive's frequency")] = (
        0.015
    )


class Lumped(Arguments, frozen=True, kw_only=True):
    """Two modes of the beam as one wave, whatever drives it."""

    places: ClassVar[tuple[str, ...]] = ("x",)
    reads: ClassVar[tuple[str, ...]] = ("beam",)
    x: Annotated[float, Meta(ge=0, description="metres from the left end")]
    modes: Annotated[tuple[Mode, Mode], Meta(description="which two")] = (21, 22)
    ratio: Annotated[float, Meta(gt=0, description="amplitude of the second over the first, both mass-normalised")] = (
        1.0
    )
    phase_deg: Annotated[float, Meta(description="by which the second leads")] = 90.0


class Receptance(AtFrequency, frozen=True, kw_only=True):
    """One place under a unit force at another."""

    places: ClassVar[tuple[str, ...]] = ("position", "x")
    model: UnitModel = "analytic"
    count: Size | None = None
    loss_factor: Loss | None = None
    position: Annotated[float, Meta(ge=0, description="of the force, metres from the left end")]
    x: Annotated[float, Meta(ge=0, description="metres from the left end")]
    theory: Theory = "euler-bernoulli"

    def __post_init__(self) -> None:
        check_count(self.model, self.count)


class Sensitivity(DriveArguments, frozen=True, kw_only=True):
    """The reflection about a point of frequency and phase, in the middle half of the beam."""

    model: UnitModel = "analytic"
    count: Size | None = None
    loss_factor: Loss | None = None
    drive: Imposed | None = None
    theory: Theory = "euler-bernoulli"

    def __post_init__(self) -> None:
        check_count(self.model, self.count)


class Fastest(Sensitivity, frozen=True, kw_only=True):
    """Where crests run fastest under a limit on the reflection."""

    limit: Annotated[Relative, Meta(gt=0, lt=1, description="largest reflection")] = 0.1
