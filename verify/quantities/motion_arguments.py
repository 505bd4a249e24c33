"""The typed arguments of figures in time: friction alone, sliders on a beam, the beam itself."""

from typing import Annotated, ClassVar, Literal

from msgspec import Meta

from verify import options
from verify.checks import Relative, check_sizes
from verify.errors import InputError
from verify.models.catalogue import MODELS
from verify.quantities.kind import (
    WHAT_EXISTS,
    Arguments,
    AtFrequency,
    DriveArguments,
    FieldModel,
    MovingModel,
    Size,
    Sizes,
    check_count,
)
from verify.slider import GRAVITY

Positive = Annotated[float, Meta(gt=0)]
Friction = Annotated[float, Meta(gt=0, description="coefficient of friction")]
Slope = Annotated[float, Meta(gt=0, description="K of Eq. (3), s/m")]
Gravity = Annotated[float, Meta(gt=0, description="m/s^2")]


class FreeDecay(Arguments, frozen=True, kw_only=True):
    """A slider left to itself on a surface at rest."""

    reads: ClassVar[tuple[str, ...]] = ()
    mu: Friction
    slope: Slope
    speed: Annotated[float, Meta(description="at the start, m/s")]
    time: Annotated[float, Meta(gt=0, description="seconds")]
    gravity: Gravity = GRAVITY


class Creep(Arguments, frozen=True, kw_only=True):
    """A slider pulled by a constant force below the friction's limit."""

    reads: ClassVar[tuple[str, ...]] = ()
    mu: Friction
    slope: Slope
    pull: Annotated[float, Meta(description="pulling force over mass, m/s^2")]
    gravity: Gravity = GRAVITY


class OnBelt(Arguments, frozen=True, kw_only=True):
    """A mass held by a spring on a belt, Coulomb friction."""

    reads: ClassVar[tuple[str, ...]] = ()
    mass: Annotated[float, Meta(gt=0, description="kg")]
    stiffness: Annotated[float, Meta(gt=0, description="N/m")]
    static: Annotated[float, Meta(gt=0, description="largest friction at rest, newton")]
    kinetic: Annotated[float, Meta(gt=0, description="friction when slipping, newton")]
    speed: Annotated[float, Meta(gt=0, description="of the belt, m/s")]


class Oscillator(Arguments, frozen=True, kw_only=True):
    """A mass on a spring and a floor with Coulomb friction."""

    reads: ClassVar[tuple[str, ...]] = ()
    mass: Annotated[float, Meta(gt=0, description="kg")]
    stiffness: Annotated[float, Meta(gt=0, description="N/m")]
    force: Annotated[float, Meta(gt=0, description="friction, newton")]


class OnWave(AtFrequency, frozen=True, kw_only=True):
    """A slider on a pure travelling wave."""

    amplitude: Annotated[float, Meta(gt=0, description="of the wave, metres")]
    slope: Slope
    mu: Friction
    kinematics: Annotated[
        options.Kinematics, Meta(description="following: its path is that of the surface, exactly")
    ] = "tangential"
    gravity: Gravity = GRAVITY


def check_law(law: str | None, slope: float | None) -> None:
    """Raise InputError for a slope of Eq. (3) beside a law that has none."""
    if law == "coulomb" and slope is not None:
        raise InputError(f"slope = {slope!r} is K of Eq. (3), law = 'tanh': law = 'coulomb' has none, leave it out")


class InTime(DriveArguments, frozen=True, kw_only=True):
    """A driven beam in time: what is not given is the scene's."""

    reads: ClassVar[tuple[str, ...]] = WHAT_EXISTS
    model: MovingModel = "segment"
    count: Size | None = None
    time: Annotated[float, Meta(gt=0, description="seconds; default: the scene's motion.duration")] | None = None
    start: Annotated[options.Start, Meta(description="default: the scene's motion.start")] | None = None
    soft_start_periods: (
        Annotated[float, Meta(ge=0, description="over which the forces grow; default: the scene's")] | None
    ) = None
    modal_damping: Annotated[Relative, Meta(ge=0, lt=1, description="ratio of every mode")] | None = None
    modes: Annotated[int, Meta(ge=1, description="the exact beam keeps from rest; default 400")] | None = None
    force: Annotated[float, Meta(ge=0, description="of every force, newton; default: the scene's")] | None = None

    def __post_init__(self) -> None:
        check_count(self.model, self.count)
        if self.modes is not None and self.count is not None:
            raise InputError(
                f"modes = {self.modes!r} is for model = analytic: {self.model} keeps all it has, leave it out"
            )


class DeflectionAt(InTime, frozen=True, kw_only=True):
    """A place on the beam."""

    places: ClassVar[tuple[str, ...]] = ("position", "x")
    x: Annotated[float, Meta(description="metres from the left end")]


class SliderInTime(InTime, frozen=True, kw_only=True):
    """The scene's slider, with what is given instead of its own."""

    places: ClassVar[tuple[str, ...]] = ("position", "slider_position")
    slides: ClassVar[bool] = True

    step: Annotated[float, Meta(gt=0, description="seconds; default: as the start asks for")] | None = None
    mu: Friction | None = None
    slope: Slope | None = None
    mass: Annotated[float, Meta(gt=0, description="kg")] | None = None
    law: Annotated[options.Law, Meta(description="Eq. (3), or true sticking")] | None = None
    coupling: Annotated[options.CouplingChoice, Meta(description="whether the beam feels it")] | None = None
    line: Annotated[options.Line, Meta(description="contact line of a chain")] | None = None
    kinematics: Annotated[options.Kinematics, Meta(description="how it keeps to the surface")] | None = None
    normal: (
        Annotated[options.NormalChoice, Meta(description="whether its weight and inertia act on the beam")] | None
    ) = None
    preload: Annotated[float, Meta(ge=0, description="newton pressing it on beside its weight")] | None = None
    slider_position: Annotated[float, Meta(description="where it starts, metres")] | None = None
    slider_speed: Annotated[float, Meta(description="at the start, m/s")] | None = None

    def __post_init__(self) -> None:
        super().__post_init__()
        check_law(self.law, self.slope)


class SliderDeflection(SliderInTime, frozen=True, kw_only=True):
    """A place on the beam while the slider is on it."""

    places: ClassVar[tuple[str, ...]] = ("position", "slider_position", "x")
    x: Annotated[float, Meta(description="metres from the left end")]


class SliderBooked(SliderInTime, frozen=True, kw_only=True):
    """A line of the books of the driven beam and its slider, from rest."""

    of: Annotated[
        Literal["work_in", "damped", "rubbed", "slider", "contact_on_beam", "normal_on_beam", "turned"],
        Meta(
            description="from the start: work of the forces; lost in the beam; lost in friction; gained by the slider; "
            "work of friction, and of the normal reaction, on the beam; of turning and gravity on one that follows"
        ),
    ]


class Steady(DriveArguments, frozen=True, kw_only=True):
    """The driven beam in its steady state with the slider on it: what is not given is the scene's."""

    places: ClassVar[tuple[str, ...]] = ("position", "slider_position")
    reads: ClassVar[tuple[str, ...]] = WHAT_EXISTS
    slides: ClassVar[bool] = True

    model: FieldModel = "analytic"
    count: Size | None = None
    mass: Annotated[float, Meta(gt=0, description="kg")] | None = None
    slider_position: Annotated[float, Meta(description="where it stands, metres")] | None = None

    def __post_init__(self) -> None:
        check_count(self.model, self.count)


class LoadedDeflection(Steady, frozen=True, kw_only=True):
    """A place on the beam that carries the slider's mass at rest."""

    places: ClassVar[tuple[str, ...]] = ("position", "slider_position", "x")
    x: Annotated[float, Meta(description="metres from the left end")]


class CouplingSize(Steady, frozen=True, kw_only=True):
    """What of the slider the beam may feel."""

    of: Annotated[Literal["friction", "normal"], Meta(description="full friction, or m omega^2 |G| of its inertia")]
    mu: Friction | None = None
    preload: Annotated[float, Meta(ge=0, description="newton pressing it on beside its weight")] | None = None

    def __post_init__(self) -> None:
        super().__post_init__()
        for name in ("mu", "preload", "phase_deg", "position"):
            if self.of == "normal" and (value := getattr(self, name)) is not None:
                raise InputError(
                    f"{name} = {value!r} is for of = 'friction': inertia is sized by mass, place and frequency, "
                    "leave it out"
                )


class SliderOrder(SliderInTime, frozen=True, kw_only=True):
    """Displacements over several sizes, or over several steps."""

    counts: Sizes | None = None
    steps: Annotated[tuple[Positive, ...], Meta(description="three or more steps, seconds")] | None = None

    def __post_init__(self) -> None:
        if (self.counts is None) == (self.steps is None):
            raise InputError("slider.order takes counts or steps: give one of the two")
        check_sizes("steps" if self.counts is None else "counts", self.steps or self.counts or ())
        if self.steps is not None and self.step is not None:
            raise InputError(f"step = {self.step!r}: slider.order over steps takes its steps from there, leave it out")
        if self.counts is None:
            super().__post_init__()
        elif self.count is not None or not MODELS.named(self.model).sized:
            raise InputError("slider.order over counts is for fem and segment and takes no count: leave it out")
