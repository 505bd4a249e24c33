"""What figures of the nonlinear chain are asked with."""

from typing import Annotated, ClassVar, Literal

from msgspec import Meta

from verify import options
from verify.errors import InputError
from verify.quantities.kind import Arguments, Grading, Mode, Wall
from verify.quantities.motion_arguments import Friction, Slope

Links = Annotated[int, Meta(ge=1, description="links of the chain; segments and count mean the same")]
Load = Annotated[float, Meta(description="P L^2 / EI of a dead transverse force at the tip")]
Component = Annotated[Literal["deflection", "shortening"], Meta(description="of the tip: w/L, or 1 - x/L along x")]
Radii = Annotated[float, Meta(gt=0, description="at mid-span, in radii of gyration h / sqrt(12)")]
Step = Annotated[float, Meta(gt=0, description="fixed step of the motion, s; adaptive unless given")]
Method = Annotated[
    Literal["adaptive", "rk4", "modal", "linear"],
    Meta(description="modal: exact linear flow and kicks; linear: that flow alone; default rk4 with a step"),
]
Inertia = Annotated[Literal["full", "transverse"], Meta(description="of the links: transverse has none along x")]


class Chained(Arguments, frozen=True, kw_only=True):
    """A chain of so many links."""

    chained: ClassVar[bool] = True
    segments: Links

    @property
    def links(self) -> int:
        """N."""
        return self.segments


class TipUnderLoad(Chained, frozen=True, kw_only=True):
    """A loaded cantilever."""

    reads: ClassVar[tuple[str, ...]] = ()
    load: Load
    component: Component = "deflection"
    wall: Wall = "gregory"


class RolledUp(Chained, frozen=True, kw_only=True):
    """A cantilever rolled up once."""

    reads: ClassVar[tuple[str, ...]] = ()
    wall: Wall = "half"


class Hanging(Chained, frozen=True, kw_only=True):
    """One mode of a hanging chain."""

    reads: ClassVar[tuple[str, ...]] = ()
    mode: Mode


class Turning(Chained, frozen=True, kw_only=True):
    """One mode of a cantilever whose clamp turns."""

    reads: ClassVar[tuple[str, ...]] = ()
    mode: Mode
    speed: Annotated[float, Meta(ge=0, le=1e3, description="of the clamp, in sqrt(EI / (rho A L^4))")]
    wall: Wall = "gregory"


class LargeAmplitude(Chained, frozen=True, kw_only=True):
    """A hinged beam between immovable ends."""

    reads: ClassVar[tuple[str, ...]] = ("beam",)
    amplitude: Radii


class FreeMotion(Chained, frozen=True, kw_only=True):
    """An undamped chain let go."""

    reads: ClassVar[tuple[str, ...]] = ("beam",)
    amplitude: Annotated[float, Meta(gt=0, le=0.1, description="at mid-span, over L")] = 0.05
    periods: Annotated[float, Meta(gt=0, le=1000, description="of the linear first mode")] = 1.0
    step: Step | None = None
    tolerance: Annotated[float, Meta(gt=0, lt=0.1, description="of the adaptive step alone; default 1e-8")] | None = (
        None
    )

    def __post_init__(self) -> None:
        if self.step is not None and self.tolerance is not None:
            raise InputError(f"tolerance = {self.tolerance!r} with step = {self.step!r}: give one of the two")


class Departing(Chained, frozen=True, kw_only=True):
    """A nonlinear chain beside the linear one, driven from rest."""

    places: ClassVar[tuple[str, ...]] = ("x",)
    force: Annotated[float, Meta(gt=0, description="N, of every force of the scene's drive")]
    time: Annotated[float, Meta(gt=0, description="s after the forces set in")] = 1e-3
    inertia: Annotated[
        options.Inertia,
        Meta(description="transverse: rigid links without inertia along x; elastic: links that stretch by EA / l"),
    ] = "full"
    of: Annotated[Literal["end", "rms"], Meta(description="the departure at that time, or its rms until then")] = "end"
    x: Annotated[float, Meta(gt=0, description="m from the left end; default mid-span")] | None = None


class FromRest(Chained, frozen=True, kw_only=True):
    """The driven chain at one time and place."""

    places: ClassVar[tuple[str, ...]] = ("x",)
    time: Annotated[float, Meta(gt=0, description="s after the forces of the scene's drive set in")]
    x: Annotated[float, Meta(ge=0, description="m from the left end, on the links")]
    step: Step | None = None
    force: Annotated[float, Meta(gt=0, description="N, of every force; default those of the scene's drive")] | None = (
        None
    )
    method: Method | None = None
    inertia: Inertia = "full"
    tolerance: Annotated[float, Meta(gt=0, lt=0.1, description="of the adaptive step alone; default 1e-9")] | None = (
        None
    )


class ContactLine(Chained, frozen=True, kw_only=True):
    """One mode of the scene's beam as a slider on its nonlinear chain sees it."""

    places: ClassVar[tuple[str, ...]] = ("x",)
    reads: ClassVar[tuple[str, ...]] = ("beam",)
    mode: Mode
    x: Annotated[float, Meta(ge=0, description="m from the left end: on which piece")]
    wall: Wall = "gregory"
    grading: Grading = 1.0


class Ridden(Arguments, frozen=True, kw_only=True):
    """The scene's slider on the nonlinear chain from rest, with what is given instead of the scene's."""

    places: ClassVar[tuple[str, ...]] = ("slider_position",)
    slides: ClassVar[bool] = True
    chained: ClassVar[bool] = True
    segments: Links
    links: Annotated[options.Links, Meta(description="stretching: by the beam's own EA / l")] = "rigid"
    time: Annotated[float, Meta(gt=0, description="s; default: the scene's motion.duration")] | None = None
    step: Annotated[float, Meta(gt=0, description="of the slider, s; default: the scene's steps per period")] | None = (
        None
    )
    force: Annotated[float, Meta(gt=0, description="N, of every force; default those of the scene's drive")] | None = (
        None
    )
    soft_start_periods: (
        Annotated[float, Meta(ge=0, description="0 in place of the scene's: forces act at once")] | None
    ) = None
    mu: Friction | None = None
    slope: Slope | None = None
    mass: Annotated[float, Meta(gt=0, description="kg")] | None = None
    law: Annotated[options.Law, Meta(description="Eq. (3), or true sticking")] | None = None
    coupling: (
        Annotated[options.CouplingChoice, Meta(description="auto: refused where the chain would feel it")] | None
    ) = None
    kinematics: Annotated[options.Kinematics, Meta(description="how it keeps to the surface")] | None = None
    normal: Annotated[options.NormalChoice, Meta(description="held: refused where the chain would feel it")] | None = (
        None
    )
    preload: Annotated[float, Meta(ge=0, description="newton pressing it on beside its weight")] | None = None
    slider_position: Annotated[float, Meta(description="where it starts, metres")] | None = None
    slider_speed: Annotated[float, Meta(description="at the start, m/s")] | None = None
