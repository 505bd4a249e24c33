"""Quantities of the nonlinear chain: benchmark problems, motion from rest, a slider on the chain."""

from typing import TYPE_CHECKING, Annotated, Any, Literal

import msgspec
from msgspec import Meta
from msgspec.structs import replace

from verify import settings
from verify.errors import InputError
from verify.problem.beam import PointForce
from verify.quantities.base import Place, Scene, quantity
from verify.quantities.options import ForceAmplitude, Mode, SoftStart, Wall, check_forces
from verify.quantities.slider import SliderOptions, TimeOptions, motion_arguments
from verify.validation import unit

if TYPE_CHECKING:
    from verify.analysis.solution_cache import SolutionCache
    from verify.dynamics.result import Motion

Links = Annotated[int, Meta(ge=1, description="N, number of links")]
Seconds = Annotated[float, unit("s"), Meta(gt=0, description="duration from rest, s")]
TipLoad = Annotated[float, Meta(description="P L^2 / EI of a dead transverse force at the tip")]
TipComponent = Annotated[Literal["deflection", "shortening"], Meta(description="w/L, or 1 - x/L")]
HubSpeed = Annotated[float, Meta(ge=0, le=1e3, description="rotation rate of the hub over sqrt(EI / (rho A L^4))")]
Gyrations = Annotated[float, Meta(gt=0, description="amplitude at mid-span over the radius of gyration sqrt(I / A)")]
Step = Annotated[float, Meta(gt=0, description="fixed step, s; default: adaptive")]
Inertia = Annotated[
    settings.Inertia, Meta(description="axial inertia: rigid links with or without it, or links that stretch by EA / l")
]
Reading = Annotated[
    Literal["end", "rms", "beam"],
    Meta(description="end: at mid-span; rms: until then; beam: rms over joints, start phases and both directions"),
]
ChainLoad = Annotated[settings.Load, Meta(description="reciprocal: forces on four joints; lever: on their link's two")]
BEAM = ("beam",)


@quantity("chain.cantilever_tip", unit="1", reads=())
def cantilever_tip(*, segments: Links, load: TipLoad, component: TipComponent = "deflection") -> float:
    """Tip displacement over L of a cantilever under a dead transverse force (elastica)."""
    from verify.chain.benchmarks import CANTILEVER, EI
    from verify.chain.statics import bend

    return float(getattr(bend(CANTILEVER, segments, load * EI), component))


@quantity("chain.rollup_gap", unit="1", reads=())
def rollup_gap(*, segments: Links, wall: Wall = "half") -> float:
    """Distance between the ends over L of a cantilever rolled up by an end moment 2 pi EI/L."""
    from verify.chain.benchmarks import rollup_gap

    return rollup_gap(segments, wall)


@quantity("chain.hanging_frequency", unit="1", reads=())
def hanging_frequency(*, segments: Links, mode: Mode) -> float:
    """Natural frequency of a hanging chain of uniform links, omega sqrt(L/g)."""
    from verify.chain.benchmarks import hanging_frequency

    return hanging_frequency(mode, segments)


@quantity("chain.rotating_frequency", unit="1", reads=())
def rotating_frequency(*, segments: Links, mode: Mode, speed: HubSpeed) -> float:
    """Lead-lag natural frequency of a rotating cantilever, omega sqrt(rho A L^4/EI)."""
    from verify.chain.benchmarks import rotating_frequency

    return rotating_frequency(mode, segments, speed)


@quantity("chain.large_amplitude_frequency", unit="1", reads=BEAM)
def large_amplitude_frequency(scene: Scene, cache: "SolutionCache", *, segments: Links, amplitude: Gyrations) -> float:
    """First frequency of a beam between immovable hinges at finite amplitude over the linear frequency."""
    from verify.chain.benchmarks import large_amplitude_frequency

    return large_amplitude_frequency(scene.beam, amplitude, segments, cache.progress)


@quantity("chain.energy_drift", unit="1", reads=BEAM)
def energy_drift(scene: Scene, cache: "SolutionCache", *, segments: Links, step: Step | None = None) -> float:
    """Relative energy drift of an undamped roller-ended chain in a period of mode 1, released from 0.05 L."""
    from verify.chain.benchmarks import energy_drift

    return energy_drift(scene.beam, segments, step, progress=cache.progress)


@quantity("chain.imbalance", unit="1", reads=())
def imbalance(cache: "SolutionCache", *, segments: Links) -> float:
    """Residual of the chain's energy balance under hub motion and an eccentric load, over the damping loss."""
    from verify.chain.benchmarks import energy_balance_error

    return energy_balance_error(segments, "free", 1e-9, cache.progress)


@quantity("chain.contact_line_error", unit="1", reads=BEAM)
def contact_line_error(scene: Scene, *, segments: Links, mode: Mode, x: Place) -> float:
    """Slope error of the chain's contact line at x in a mode, relative to the largest slope."""
    from verify.chain.benchmarks import contact_line_error

    return contact_line_error(scene.beam, mode, segments, x)


def _drive(scene: Scene, time: TimeOptions) -> tuple[tuple[PointForce, ...], float, float]:
    """(forces, Hz, s) of an undamped motion from rest without soft start. Raises InputError for any other [motion]."""
    if scene.motion is None and time.soft_start_periods is None:
        time = replace(time, soft_start_periods=0.0)
    check_forces(scene, "a nonlinear chain")
    request = motion_arguments(scene, time)
    excitation = request["excitation"]
    given = request | {"soft_start_periods": excitation.soft_start_periods}
    for name, needed in (("start", "rest"), ("soft_start_periods", 0.0), ("modal_damping", 0.0)):
        if (given[name] or 0.0) != needed:
            raise InputError(f"{name} = {given[name]!r}: a chain starts from rest and is undamped, give {needed!r}")
    return excitation.forces, excitation.frequency_hz, request["duration"]


class FromRest(msgspec.Struct, frozen=True, kw_only=True):
    """The nonlinear chain from rest under the scene's forces."""

    segments: Links
    time: Seconds = 1e-3
    force: ForceAmplitude | None = None


@quantity("chain.transient_deflection", unit="m")
def transient_deflection(
    scene: Scene,
    cache: "SolutionCache",
    run: FromRest,
    *,
    x: Place,
    load: ChainLoad = "reciprocal",
    reading: Annotated[
        settings.ChainReading, Meta(description="corrected: spline as on the linear chain; links: straight links")
    ] = "corrected",
) -> float:
    """Deflection of the nonlinear chain at x after `time` from rest under the scene's forces."""
    from verify.chain.benchmarks import transient

    forces, hertz, time = _drive(scene, TimeOptions(model="analytic", time=run.time, force=run.force))
    motion = transient(scene.beam, forces, hertz, [time], run.segments, load=load, progress=cache.progress)
    return float(motion.deflection([x], reading=reading)[0, 0])


@quantity("chain.axial_departure", unit="1")
def axial_departure(
    scene: Scene,
    cache: "SolutionCache",
    run: FromRest,
    *,
    load: ChainLoad = "lever",
    inertia: Inertia = "full",
    of: Reading = "end",
) -> float:
    """Deflection of the nonlinear chain less that of the linear one from rest, at mid-span or all joints, relative.

    Both are read on their straight links.
    """
    from verify.chain.benchmarks import departure, departure_over_beam

    drive = _drive(scene, TimeOptions(model="analytic", time=run.time, force=run.force))
    settings: dict[str, Any] = {"load": load, "inertia": inertia, "progress": cache.progress}
    if of == "beam":
        return departure_over_beam(scene.beam, *drive, run.segments, **settings)
    return float(getattr(departure(scene.beam, *drive, run.segments, **settings), of))


class OnChain(msgspec.Struct, frozen=True, kw_only=True):
    """Time integration of the scene's slider, with or without feet, on the nonlinear chain from rest."""

    segments: Links
    links: Annotated[settings.Links, Meta(description="stretching: axial stiffness EA / l")] = "rigid"
    load: ChainLoad = "reciprocal"
    joint_dashpot: Annotated[float, Meta(ge=0, description="dashpot of every joint with a spring, N m s")] = 0.0
    force: ForceAmplitude | None = None
    soft_start_periods: SoftStart | None = None

    def run(self, scene: Scene, cache: "SolutionCache", options: SliderOptions) -> "Motion":
        """The motion of the slider. Raises InputError."""
        from verify.chain.slider_on_chain import slide_on_chain
        from verify.dynamics.arguments import Excitation, Keep

        if scene.motion is None:
            raise InputError("motion is missing: add [motion] with a duration for a slider on a chain")
        time = TimeOptions(model="analytic", force=self.force, soft_start_periods=self.soft_start_periods)
        case: dict[str, Any] = {"slider": options.of(scene), "count": self.segments, "links": self.links}
        case |= {"load": self.load, "joint_dashpot": self.joint_dashpot, "step": options.time_step(scene)}
        forces, hertz, seconds = _drive(scene, time)
        drive = scene.beam, Excitation(forces, hertz), seconds
        key: Any = ("chain", *drive, *case.values())
        if key not in cache.motors:
            cache.motors[key] = slide_on_chain(*drive, **case, keep=Keep(samples=2), progress=cache.progress)
        motion: Motion = cache.motors[key]
        if not motion.statistics.finished:
            raise InputError(
                f"duration = {seconds:.12g} s: the slider {motion.statistics.stopped} after {motion.end.time:.6g} s, "
                "give a shorter duration or another slider_position"
            )
        return motion


@quantity("chain.slider_displacement", unit="m")
def slider_displacement(scene: Scene, cache: "SolutionCache", by: OnChain, slider: SliderOptions) -> float:
    """Displacement of the scene's slider along +x on the nonlinear chain."""
    return by.run(scene, cache, slider).displacement


@quantity("chain.slider_mean_speed", unit="m/s")
def slider_mean_speed(scene: Scene, cache: "SolutionCache", by: OnChain, slider: SliderOptions) -> float:
    """Mean speed of the scene's slider along +x on the nonlinear chain."""
    return by.run(scene, cache, slider).mean_speed


@quantity("chain.slider_imbalance", unit="1")
def slider_imbalance(scene: Scene, cache: "SolutionCache", by: OnChain, slider: SliderOptions) -> float:
    """Residual of the slider's energy balance on the nonlinear chain, over the friction loss."""
    energy = by.run(scene, cache, slider).energy
    assert energy is not None
    if not energy.friction_loss:
        raise InputError("slider.mu: friction dissipates nothing in this run, give another slider or a longer duration")
    return abs(energy.slider_residual) / energy.friction_loss
