"""Quantities of the nonlinear chain: contact line, motion from rest, a slider on the chain."""

from typing import TYPE_CHECKING, Annotated, Any, Literal

import msgspec
from msgspec import Meta
from msgspec.structs import replace

from verify import settings
from verify.errors import InputError
from verify.problem.beam import PointForce
from verify.quantities.base import Place, Scene, quantity
from verify.quantities.options import ForceAmplitude, Mode, SoftStart, check_forces
from verify.quantities.slider import SliderOptions, TimeOptions, motion_arguments
from verify.validation import check_integer, unit

if TYPE_CHECKING:
    from verify.analysis.solution_cache import SolutionCache
    from verify.chain.departure import DrivenChain
    from verify.dynamics.result import Motion

Links = Annotated[int, Meta(ge=1, description="N, number of links")]
Seconds = Annotated[float, unit("s"), Meta(gt=0, description="duration from rest, s")]
Inertia = Annotated[
    settings.Inertia, Meta(description="axial inertia: rigid links with or without it, or links that stretch by EA / l")
]
Reading = Annotated[
    Literal["end", "rms", "beam"],
    Meta(description="end: at mid-span; rms: until then; beam: rms over joints, start phases and both directions"),
]
ChainLoad = Annotated[settings.Load, Meta(description="reciprocal: forces on four joints; lever: on their link's two")]


@quantity("chain.contact_line_error", unit="1", reads=("beam",))
def contact_line_error(scene: Scene, *, segments: Links, mode: Mode, x: Place) -> float:
    """Slope error of the chain's contact line at x in a mode, relative to the largest slope.

    On the piece at x, against the exact mode. Order 3, at a clamped wall 1.
    """
    import numpy as np

    from verify.analytic_modes import ExactModel
    from verify.chain.system import build_system, link_at, straight_chain
    from verify.segment_model import SegmentModel
    from verify.segments.reading import contact_line

    check_integer("segments", segments, 2)
    system, exact = build_system(scene.beam, segments), ExactModel(scene.beam)
    joints = SegmentModel(scene.beam, segments).modes(mode).readings["raw"]()[mode - 1]
    link, _ = link_at(system, x)
    edges, xi = system.nodes[link - 1 : link + 1], np.linspace(0.0, 1.0, 17)
    powers = contact_line(straight_chain(system), joints[None]).c[::-1, link - 1, 0] * np.ptp(edges) ** np.arange(4)
    slope = np.polynomial.polynomial.polyval(xi, np.polynomial.polynomial.polyder(powers)) / np.ptp(edges)
    error = slope - exact.mode_shape(mode, edges[0] + xi * np.ptp(edges), 1)
    return float(abs(error).max()) / float(abs(exact.mode_shape(mode, system.nodes, 1)).max())


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

    def chain(self, scene: Scene, **settings: Any) -> "tuple[DrivenChain, float]":
        """The chain under the scene's forces, and the duration, s. Raises InputError."""
        from verify.chain.departure import DrivenChain

        forces, hertz, time = _drive(scene, TimeOptions(model="analytic", time=self.time, force=self.force))
        chain = DrivenChain(beam=scene.beam, forces=forces, frequency_hz=hertz, count=self.segments, **settings)
        return chain, time


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
    chain, time = run.chain(scene, load=load, progress=cache.progress)
    return float(chain.motion([time]).deflection([x], reading=reading)[0, 0])


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
    chain, time = run.chain(scene, load=load, inertia=inertia, progress=cache.progress)
    return chain.departure_over_beam(time) if of == "beam" else chain.departure(time)[of == "rms"]


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
        how: dict[str, Any] = {**case, "keep": Keep(samples=2), "progress": cache.progress}
        motion = cache.once(("chain", *drive, *case.values()), lambda: slide_on_chain(*drive, **how))
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
