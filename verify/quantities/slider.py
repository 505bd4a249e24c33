"""Quantities in time: a slider on the driven beam, energy balance and coupling, and the beam without slider."""

from typing import TYPE_CHECKING, Annotated, Any, ClassVar, Literal

import msgspec
from msgspec import Meta
from msgspec.structs import replace

from verify import settings
from verify.analysis.comparison import asymptotic_order, relative_error
from verify.analysis.solution_cache import SolutionCache
from verify.dynamics.arguments import Excitation, Keep, Step
from verify.errors import InputError
from verify.linear.positions import positions_on
from verify.linear.registry import MODELS
from verify.problem.slider import Slider, changed
from verify.quantities import options as opt
from verify.quantities.base import Place, Scene, figures, quantity
from verify.travelling_wave import measure_series
from verify.validation import check_sizes, unit
from verify.waves.window import check_span, check_waves

if TYPE_CHECKING:
    from verify.dynamics.result import Motion

Time = Annotated[float, unit("s"), Meta(gt=0, description="duration, s; default: the scene's motion.duration")]
Window = Annotated[tuple[float, float], Meta(description="start and end, m")]
Kinematics = Annotated[settings.Kinematics, Meta(description="kinematics of the slider")]
SAMPLES_PER_PERIOD, POINTS = 32, 40
"""Samples per period, and positions, at which the wave of a motion is measured."""
SOFT_START_PERIODS = 2.0
"""From rest: forces that act at once excite all modes, under which a slider's path does not converge."""


class TimeOptions(opt.DriveOptions, frozen=True, kw_only=True):
    """Drive and time integration of the driven beam."""

    accepts: ClassVar[tuple[str, ...]] = ("drive.shunt",)
    model: opt.TimeModel = "segment"
    count: opt.Size | None = None
    theory: opt.TimeTheory = "euler-bernoulli"
    time: Time | None = None
    start: Annotated[settings.Start, Meta(description="default: the scene's motion.start")] | None = None
    soft_start_periods: opt.SoftStart | None = None
    modal_damping: opt.ModalDamping | None = None
    modes: Annotated[int, Meta(ge=1, description="number, for model = analytic from rest; default: 400")] | None = None
    force: opt.ForceAmplitude | None = None


class SliderOptions(msgspec.Struct, frozen=True, kw_only=True):
    """Parameters that replace those of the scene's slider."""

    mu: opt.Mu | None = None
    slope: opt.Slope | None = None
    mass: opt.Mass | None = None
    law: Annotated[settings.Law, Meta(description="friction law; tanh: Eq. (3), coulomb: with stiction")] | None = None
    kinematics: Kinematics | None = None
    coupling: Annotated[settings.CouplingChoice, Meta(description="coupling of slider and beam")] | None = None
    normal: Annotated[settings.NormalChoice, Meta(description="bilateral: with weight and inertia")] | None = None
    slider_position: Annotated[Place, Meta(description="initial position, m")] | None = None
    slider_speed: Annotated[float, Meta(description="initial speed, m/s")] | None = None
    step: Annotated[float, Meta(gt=0, description="time step of the slider, s; default: automatic")] | None = None

    def of(self, scene: Scene) -> Slider:
        """The scene's slider with these parameters. Raises InputError for no slider, and parameters it contradicts."""
        if scene.slider is None:
            raise InputError("slider is missing: add [slider] with mass and mu to the scene")
        values = {name.removeprefix("slider_"): getattr(self, name) for name in self.__struct_fields__}
        return changed(scene.slider, **{k: v for k, v in values.items() if v is not None and k != "step"})

    def time_step(self, scene: Scene) -> Step:
        """The time step, by default by the scene's number in a period."""
        steps = scene.motion.steps_per_period if scene.motion and self.step is None else None
        return Step(seconds=self.step, per_period=steps)


def motion_arguments(scene: Scene, by: TimeOptions) -> dict[str, Any]:
    """Keyword arguments of `simulate` for the driven beam of a scene. Raises InputError."""
    motion, soft = scene.motion, by.soft_start_periods
    time = by.time if motion is None else by.time or motion.duration
    if time is None:
        raise InputError("time is missing and the scene has no [motion]: give time in seconds")
    opt.check_count(by.model, by.count)
    if by.modes is not None and by.count is not None:
        raise InputError(f"modes = {by.modes!r} is for model = analytic: {by.model} uses all its modes, leave it out")
    opt.check_theory("motion in time", by.theory)
    start = by.start or (motion.start if motion else "rest")
    if soft is None:
        soft = motion.soft_start_periods if motion and start == "rest" else None
        soft = (SOFT_START_PERIODS if start == "rest" else 0.0) if soft is None else soft
    damping = by.modal_damping if by.modal_damping is not None or motion is None else motion.modal_damping
    forces, hertz = by.forces(scene, by.force), opt.drive_frequency(scene, by.frequency_hz)
    loaded = scene.in_time(forces, hertz)
    excitation = Excitation(loaded.loads, hertz, soft, circuits=loaded.circuits)
    model = {"model": by.model, "count": by.count, "modes": by.modes, "start": start, "modal_damping": damping}
    return {"beam": loaded.beam, "excitation": excitation, "duration": time, **model}


def _simulated(cache: SolutionCache, arguments: dict[str, Any]) -> "Motion":
    """A simulation, computed once for equal arguments."""
    from verify.dynamics.simulate import simulate  # which `verify measure` of a mode does not load

    return cache.once(("motion", *arguments.items()), lambda: simulate(**arguments, progress=cache.progress))


def slider_run(scene: Scene, cache: SolutionCache, by: TimeOptions, slider: SliderOptions) -> "Motion":
    """The run of the scene's slider. Raises InputError where it stops early or its step has not converged."""
    return _slider_run(scene, cache, slider, motion_arguments(scene, by))


def _slider_run(
    scene: Scene, cache: SolutionCache, slider: SliderOptions, arguments: dict[str, Any], at: tuple[float, ...] = ()
) -> "Motion":
    from verify.dynamics.step_control import CONVERGED

    sliding = {"slider": slider.of(scene), "step": slider.time_step(scene), "keep": Keep(at=at, samples=2)}
    run = _simulated(cache, arguments | sliding)
    status = run.statistics
    if not status.finished:
        raise InputError(f"time = {arguments['duration']:.12g} s: the slider {status.stopped}, give a shorter time")
    if status.step_change is not None and status.step_change > CONVERGED:
        raise InputError(f"step = {status.step_s:.3g} s, the default, has not converged: give a shorter step or time")
    return run


slider = figures("slider", slider_run)
slider("displacement", "m", "Displacement of the scene's slider along +x at the end of the run.")
slider("mean_speed", "m/s", "Mean speed of the slider along +x: displacement over duration.")
slider("largest_friction", "N", "Largest friction force on the slider.")
slider("mean_friction", "N", "Mean friction force on the slider along +x.")
slider("mean_surface_speed", "m/s", "Mean tangential velocity of the surface under the slider.")
slider(
    "imbalance",
    "1",
    "Residual of the energy balance of beam and slider in a run from rest, over the work of the forces.",
    "energy_from_rest.imbalance",
)


@quantity("slider.reversal", unit="1")
def reversal(scene: Scene, cache: SolutionCache, by: TimeOptions, slider: SliderOptions) -> float:
    """Displacement with reversed drive phases over displacement; negative where the slider reverses."""
    arguments = motion_arguments(scene, by)
    drive = arguments["excitation"]
    reversed_drive = replace(drive, forces=[replace(force, phase_deg=-force.phase_deg) for force in drive.forces])
    back = _slider_run(scene, cache, slider, arguments | {"excitation": reversed_drive}).displacement
    forth = _slider_run(scene, cache, slider, arguments).displacement
    return back / forth if forth else float("nan")


@quantity("slider.order", unit="1")
def order(
    scene: Scene,
    cache: SolutionCache,
    by: TimeOptions,
    slider: SliderOptions,
    *,
    counts: opt.Sizes | None = None,
    steps: Annotated[tuple[Annotated[float, Meta(gt=0)], ...], Meta(description="three or more, s")] | None = None,
) -> float:
    """Observed order of the slider's displacement: in N (reference: exact beam) or in the step (a sixteenth of it)."""

    def displacement(by: TimeOptions, step: float | None = None) -> float:
        return slider_run(scene, cache, by, replace(slider, step=step or slider.step)).displacement

    if (counts is None) == (steps is None):
        raise InputError(f"counts = {counts!r} and steps = {steps!r}: give one of the two")
    if steps is not None:
        check_sizes("steps", steps)
        if slider.step is not None:
            raise InputError(f"step = {slider.step!r} contradicts steps: leave it out")
        exact = displacement(by, min(steps) / 16.0)
        errors = [relative_error(displacement(by, step), exact) for step in steps]
        return asymptotic_order([1.0 / step for step in steps], errors, label=f"steps = {list(steps)}")
    assert counts is not None
    check_sizes("counts", counts)
    if by.count is not None or not MODELS.named(by.model).sized:
        raise InputError(f"counts = {list(counts)}: give a discrete model and leave count out")
    exact = displacement(replace(by, model="analytic"))
    errors = [relative_error(displacement(replace(by, count=n, modes=None)), exact) for n in counts]
    return asymptotic_order(counts, errors)


@quantity("slider.deflection", unit="m")
def deflection(scene: Scene, cache: SolutionCache, by: TimeOptions, slider: SliderOptions, *, x: Place) -> float:
    """Deflection of the beam at x at the end of the run, with the slider in contact."""
    return float(_slider_run(scene, cache, slider, motion_arguments(scene, by), at=(x,)).deflection[-1, 0])


Cause = Annotated[Literal["friction", "normal"], Meta(description="friction mu N, or the inertia: m omega^2 |G|")]
Term = Annotated[
    Literal["external_work", "damping_loss", "friction_loss", "slider", "friction_on_beam", "normal_on_beam"],
    Meta(description="work of the forces, losses, kinetic energy of the slider, or work of contact on the beam"),
]


@quantity("slider.energy", unit="J")
def energy(scene: Scene, cache: SolutionCache, by: TimeOptions, slider: SliderOptions, *, of: Term) -> float:
    """A term of the energy balance of beam and slider in a run from rest."""
    balance = slider_run(scene, cache, by, slider).energy_from_rest
    return float(getattr(balance, "drive_work" if of == "external_work" else of))


@quantity("slider.coupling_size", unit="1")
def coupling_size(scene: Scene, cache: SolutionCache, *, of: Cause) -> float:
    """Size of two-way coupling: surface motion due to the slider relative to that of the wave, exact beam."""
    by = TimeOptions(model="analytic", start="steady", time=1.0 / opt.drive_frequency(scene))
    coupling = slider_run(scene, cache, by, SliderOptions()).coupling
    assert coupling is not None
    size = coupling.normal_size if of == "normal" else coupling.friction_size
    if size is None:
        raise InputError("slider.position: the drive does not move the surface at this position, choose another")
    return size


@quantity("motion.reflection", unit="1", reads=("beam", "drive", "motion"))
def reflection(scene: Scene, cache: SolutionCache, by: TimeOptions, *, window: Window) -> float:
    """Reflection Gamma in a window of the driven beam in time, without slider: two waves fitted to its phasors."""
    import numpy as np

    arguments, beam = motion_arguments(scene, by), scene.beam
    excitation = arguments["excitation"]
    hertz = excitation.frequency_hz
    electrical = [load for one in excitation.circuits for load in one.loads(arguments["beam"])]
    check_span(beam, [one.position for one in (*excitation.forces, *electrical)], window)
    check_waves(beam, hertz, window)
    x = positions_on("window", np.linspace(*window, POINTS), beam.length)
    samples = int(SAMPLES_PER_PERIOD * arguments["duration"] * hertz) + 1
    run = _simulated(cache, arguments | {"keep": Keep(at=x, samples=samples)})
    return measure_series(beam, x, run.times, run.deflection, hertz).reflection
