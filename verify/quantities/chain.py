"""Named figures of the nonlinear chain."""

from typing import TYPE_CHECKING, Annotated, Any, ClassVar, Literal

from msgspec import Meta

from verify import options
from verify.errors import InputError
from verify.judge.workbench import Workbench
from verify.quantities import beforehand, compiled
from verify.quantities.kind import Arguments, Grading, Mode, Quantity, Wall
from verify.quantities.motion_arguments import Friction, Slope

if TYPE_CHECKING:
    from collections.abc import Callable

    from verify.chain.ride import ChainRide
    from verify.scenes.scene import Scene

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

    force: Annotated[float, Meta(gt=0, description="N, of every force of the scene's drive")]
    time: Annotated[float, Meta(gt=0, lt=0.1, description="s after the forces set in")] = 1e-3
    inertia: Annotated[
        options.Inertia,
        Meta(description="transverse: rigid links without inertia along x; elastic: links that stretch by EA / l"),
    ] = "full"
    of: Annotated[Literal["end", "rms"], Meta(description="the departure at that time, or its rms until then")] = "end"
    x: Annotated[float, Meta(gt=0, description="m from the left end; default mid-span")] | None = None


class FromRest(Chained, frozen=True, kw_only=True):
    """The driven chain at one time and place."""

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

    reads: ClassVar[tuple[str, ...]] = ("beam",)
    mode: Mode
    x: Annotated[float, Meta(ge=0, description="m from the left end: on which piece")]
    wall: Wall = "gregory"
    grading: Grading = 1.0


class Ridden(Arguments, frozen=True, kw_only=True):
    """The scene's slider on the nonlinear chain from rest, with what is given instead of the scene's."""

    slides: ClassVar[bool] = True
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


def _cantilever_tip(a: TipUnderLoad, scene: "Scene", bench: Workbench) -> float:
    from verify.chain import problems as chain_studies

    return float(getattr(chain_studies.cantilever_tip(a.load, a.links, a.wall), a.component))


def _rollup_gap(a: RolledUp, scene: "Scene", bench: Workbench) -> float:
    from verify.chain import problems as chain_studies

    return chain_studies.rollup_gap(a.links, a.wall)


def _hanging_frequency(a: Hanging, scene: "Scene", bench: Workbench) -> float:
    from verify.chain import problems as chain_studies

    return chain_studies.hanging_frequency(a.mode, a.links)


def _turning_frequency(a: Turning, scene: "Scene", bench: Workbench) -> float:
    from verify.chain import problems as chain_studies

    return chain_studies.turning_frequency(a.mode, a.links, a.speed, a.wall)


def _large_amplitude_frequency(a: LargeAmplitude, scene: "Scene", bench: Workbench) -> float:
    from verify.chain import problems as chain_studies

    return chain_studies.large_amplitude_frequency(scene.beam, a.amplitude, a.links, bench.tell)


def _energy_drift(a: FreeMotion, scene: "Scene", bench: Workbench) -> float:
    from verify.chain import problems as chain_studies

    return chain_studies.energy_drift(
        scene.beam, a.links, a.amplitude, a.periods, a.step, a.tolerance or 1e-8, bench.tell
    )


def _transient_deflection(a: FromRest, scene: "Scene", bench: Workbench) -> float:
    from msgspec.structs import replace

    from verify.chain import problems as chain_studies
    from verify.chain.from_rest import point_forces

    forces = point_forces(scene, "chain.transient_deflection")
    assert scene.drive is not None
    if a.x > scene.beam.length:
        raise InputError(f"x = {a.x!r} lies off the chain: give up to {scene.beam.length!r} m")
    if a.force is not None:
        forces = tuple(replace(force, amplitude=a.force) for force in forces)
    method = a.method or ("rk4" if a.step is not None else "adaptive")
    motion = chain_studies.transient(
        scene.beam,
        forces,
        scene.drive.frequency_hz,
        [a.time],
        a.links,
        step=a.step,
        method=method,
        axial_inertia=a.inertia == "full",
        tolerance=a.tolerance,
        progress=bench.tell,
    )
    bench.n_unkept_motions += 1
    return float(motion.deflection([a.x])[0, 0])


def _axial_departure(a: Departing, scene: "Scene", bench: Workbench) -> float:
    from verify.chain.departure import departure, driven_chain

    driven = driven_chain(scene, "chain.axial_departure", a.links, a.time, a.x)
    found = departure(driven, a.force, a.inertia, bench.tell)
    return found.at_end if a.of == "end" else found.rms


def _contact_line_error(a: ContactLine, scene: "Scene", bench: Workbench) -> float:
    from verify.chain.problems import contact_line_error

    if a.x > scene.beam.length:
        raise InputError(f"x = {a.x!r} lies off the chain: give up to {scene.beam.length!r} m")
    return contact_line_error(scene.beam, a.mode, a.links, a.x, wall=a.wall, grading=a.grading)


def _ridden(figure: "Callable[[ChainRide], float]") -> "Callable[[Ridden, Scene, Workbench], float]":
    """One figure of the slider's run on the chain."""

    def evaluate(a: Ridden, scene: "Scene", bench: Workbench) -> float:
        return figure(_ride(a, scene, bench))

    return evaluate


def _ride(a: Ridden, scene: "Scene", bench: Workbench) -> "ChainRide":
    from msgspec.structs import replace

    from verify.chain.from_rest import point_forces
    from verify.chain.ride import ride_from_rest
    from verify.motion.request import STEPS_PER_PERIOD
    from verify.quantities.simulated import slider_of

    motion, slider = scene.motion, slider_of(a, scene)
    if motion is not None and a.soft_start_periods is not None:
        motion = replace(motion, soft_start_periods=a.soft_start_periods)
    forces = point_forces(replace(scene, motion=motion), "a slider on the nonlinear chain")
    assert scene.drive is not None
    time = beforehand.ride_time(a, scene)
    steps = motion.steps_per_period if motion else STEPS_PER_PERIOD
    found = ride_from_rest(
        scene.beam,
        [replace(force, amplitude=a.force) for force in forces] if a.force is not None else forces,
        scene.drive.frequency_hz,
        slider,
        a.segments,
        time,
        step=a.step or 1.0 / (steps * scene.drive.frequency_hz),
        links=a.links,
        progress=bench.tell,
    )
    bench.n_unkept_motions += 1
    return found


def _imbalance(run: "ChainRide") -> float:
    """What the slider's books miss over what friction rubs away."""
    assert run.ledger is not None
    return abs(run.ledger.residual) / run.ledger.rubbed


CHAIN_QUANTITIES: tuple[Quantity[Any], ...] = (
    Quantity(
        "chain.cantilever_tip",
        "1",
        "Tip of a cantilever under a dead transverse force: w/L or 1 - x/L.",
        TipUnderLoad,
        "equilibrium",
        _cantilever_tip,
        kernels=compiled.placed,
    ),
    Quantity(
        "chain.rollup_gap",
        "1",
        "Distance of the ends over L under an end moment 2 pi EI/L.",
        RolledUp,
        "equilibrium",
        _rollup_gap,
        kernels=compiled.placed,
    ),
    Quantity(
        "chain.hanging_frequency",
        "1",
        "Omega sqrt(L/g) of a hanging chain of uniform links.",
        Hanging,
        "equilibrium",
        _hanging_frequency,
        kernels=compiled.resting,
    ),
    Quantity(
        "chain.turning_frequency",
        "1",
        "Omega sqrt(rho A L^4/EI), lead-lag, of a cantilever whose clamp turns.",
        Turning,
        "equilibrium",
        _turning_frequency,
        kernels=compiled.resting,
    ),
    Quantity(
        "chain.large_amplitude_frequency",
        "1",
        "First frequency between immovable hinges over the linear one.",
        LargeAmplitude,
        "in time",
        _large_amplitude_frequency,
        needs=beforehand.buildable,
        kernels=compiled.stepped,
    ),
    Quantity(
        "chain.energy_drift",
        "1",
        "Largest change of energy of an undamped chain over its energy.",
        FreeMotion,
        "in time",
        _energy_drift,
        needs=beforehand.buildable,
        kernels=compiled.booked,
    ),
    Quantity(
        "chain.transient_deflection",
        "m",
        "Deflection of the chain from rest under the scene's forces.",
        FromRest,
        "in time",
        _transient_deflection,
        needs=beforehand.pushable,
        kernels=compiled.transient,
    ),
    Quantity(
        "chain.axial_departure",
        "1",
        "Nonlinear chain less the linear one, from rest, over the linear one's rms.",
        Departing,
        "in time",
        _axial_departure,
        needs=beforehand.buildable,
        kernels=compiled.departing,
    ),
    Quantity(
        "chain.contact_line_error",
        "1",
        "Slope of the contact line on the chain in a mode less the beam's, over the largest slope.",
        ContactLine,
        "equilibrium",
        _contact_line_error,
        needs=beforehand.buildable,
    ),
    *(
        Quantity(
            f"chain.slider_{name}",
            unit,
            summary,
            Ridden,
            "in time",
            _ridden(figure),
            needs=beforehand.rideable,
            kernels=compiled.ridden,
        )
        for name, unit, summary, figure in (
            (
                "displacement",
                "m",
                "Of the scene's slider along +x on the nonlinear chain.",
                lambda run: run.displacement,
            ),
            ("mean_speed", "m/s", "Displacement over time.", lambda run: run.mean_speed),
            ("largest_friction", "N", "Largest friction force on it.", lambda run: float(abs(run.friction).max())),
            ("imbalance", "1", "What the slider's energy ledger misses, over what friction rubs away.", _imbalance),
        )
    ),
)
