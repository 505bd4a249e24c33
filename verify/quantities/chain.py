"""Quantities of the nonlinear chain: benchmark problems, its motion from rest, a slider on it."""

from collections.abc import Callable
from typing import TYPE_CHECKING, Annotated, Any, Literal

import msgspec
from msgspec import Meta
from msgspec.structs import replace

from verify import options
from verify.errors import InputError
from verify.quantities.base import Place, Scene, quantity
from verify.quantities.options import ForceAmplitude, Mode, SoftStart, Wall
from verify.quantities.slider import SliderOptions, TimeOptions, motion_arguments

if TYPE_CHECKING:
    from verify.analysis.solution_cache import SolutionCache
    from verify.chain.ride import ChainRide

Links = Annotated[int, Meta(ge=1, description="N, links of the chain")]
Seconds = Annotated[float, Meta(gt=0, description="s, from rest")]
BEAM = ("beam",)


@quantity("chain.cantilever_tip", unit="1", reads=())
def cantilever_tip(
    *,
    segments: Links,
    load: Annotated[float, Meta(description="P L^2 / EI of a dead transverse force at the tip")],
    component: Annotated[Literal["deflection", "shortening"], Meta(description="w/L, or 1 - x/L")] = "deflection",
) -> float:
    """Tip displacement over L of a cantilever under a dead transverse force (elastica)."""
    from verify.chain.problems import cantilever_tip

    return float(getattr(cantilever_tip(load, segments), component))


@quantity("chain.rollup_gap", unit="1", reads=())
def rollup_gap(*, segments: Links, wall: Wall = "half") -> float:
    """Distance of the ends over L of a cantilever under an end moment 2 pi EI/L."""
    from verify.chain.problems import rollup_gap

    return rollup_gap(segments, wall)


@quantity("chain.hanging_frequency", unit="1", reads=())
def hanging_frequency(*, segments: Links, mode: Mode) -> float:
    """Omega sqrt(L/g) of a hanging chain of uniform links."""
    from verify.chain.problems import hanging_frequency

    return hanging_frequency(mode, segments)


@quantity("chain.turning_frequency", unit="1", reads=())
def turning_frequency(
    *,
    segments: Links,
    mode: Mode,
    speed: Annotated[float, Meta(ge=0, le=1e3, description="of the hub, in sqrt(EI / (rho A L^4))")],
) -> float:
    """Omega sqrt(rho A L^4/EI) of the lead-lag modes of a rotating cantilever."""
    from verify.chain.problems import turning_frequency

    return turning_frequency(mode, segments, speed)


@quantity("chain.large_amplitude_frequency", unit="1", reads=BEAM)
def large_amplitude_frequency(
    scene: Scene,
    cache: "SolutionCache",
    *,
    segments: Links,
    amplitude: Annotated[float, Meta(gt=0, description="at mid-span, in radii of gyration h / sqrt(12)")],
) -> float:
    """First frequency between immovable hinges over the linear one."""
    from verify.chain.problems import large_amplitude_frequency

    return large_amplitude_frequency(scene.beam, amplitude, segments, cache.progress)


@quantity("chain.energy_drift", unit="1", reads=BEAM)
def energy_drift(
    scene: Scene,
    cache: "SolutionCache",
    *,
    segments: Links,
    step: Annotated[float, Meta(gt=0, description="fixed step, s; default: adaptive")] | None = None,
) -> float:
    """Largest change of energy of an undamped free chain over its energy, in a period from 0.05 L at mid-span."""
    from verify.chain.problems import energy_drift

    return energy_drift(scene.beam, segments, 0.05, 1.0, step, 1e-8, cache.progress)


@quantity("chain.imbalance", unit="1", reads=())
def imbalance(cache: "SolutionCache", *, segments: Links) -> float:
    """Residual of the energy balance of a chain under base motion, load and actuator, over its damping loss."""
    from verify.chain.problems import shaken_imbalance

    return shaken_imbalance(segments, "free", 1e-9, cache.progress)


@quantity("chain.contact_line_error", unit="1", reads=BEAM)
def contact_line_error(scene: Scene, *, segments: Links, mode: Mode, x: Place) -> float:
    """Slope of the chain's contact line at x in a mode less the beam's, over the largest slope."""
    from verify.chain.problems import contact_line_error

    return contact_line_error(scene.beam, mode, segments, x)


def _from_rest(scene: Scene, what: str, by: TimeOptions) -> dict[str, Any]:
    """Arguments of a simulation from rest, undamped, without soft start. Raises InputError for a [motion] of others."""
    if scene.motion is None and by.soft_start_periods is None:
        by = replace(by, soft_start_periods=0.0)
    request = motion_arguments(scene, by)
    for name, needed in (("start", "rest"), ("soft_start_periods", 0.0), ("modal_damping", 0.0)):
        if (request[name] or 0.0) != needed:
            raise InputError(f"{name} = {request[name]!r}: {what} is from rest, undamped, at once, give {needed!r}")
    return request


@quantity("chain.transient_deflection", unit="m")
def transient_deflection(
    scene: Scene,
    cache: "SolutionCache",
    *,
    segments: Links,
    time: Seconds,
    x: Place,
    force: ForceAmplitude | None = None,
) -> float:
    """Deflection of the chain at x after a time from rest under the scene's forces."""
    from verify.chain.problems import transient

    request = _from_rest(scene, "a chain", TimeOptions(model="analytic", time=time, force=force))
    forces, hertz = request["forces"], request["frequency_hz"]
    motion = transient(scene.beam, forces, hertz, [time], segments, progress=cache.progress)
    return float(motion.deflection([x])[0, 0])


@quantity("chain.axial_departure", unit="1")
def axial_departure(
    scene: Scene,
    cache: "SolutionCache",
    *,
    segments: Links,
    force: Annotated[float, Meta(gt=0, description="N, of every force")],
    time: Seconds = 1e-3,
    inertia: Annotated[
        options.Inertia, Meta(description="transverse: rigid, none along x; elastic: links stretch by EA / l")
    ] = "full",
    of: Annotated[Literal["end", "rms"], Meta(description="at that time, or rms until then")] = "end",
) -> float:
    """Deflection of the nonlinear chain at mid-span less the linear one's from rest, over the rms of the latter."""
    from math import ceil

    import numpy as np

    from verify.chain.departure import SAMPLES, SAMPLES_PER_PERIOD, Driven, departure

    request = _from_rest(scene, "a chain", TimeOptions(model="analytic", time=time))
    forces, hertz = request["forces"], request["frequency_hz"]
    times = np.linspace(0.0, time, max(SAMPLES, ceil(SAMPLES_PER_PERIOD * hertz * time) + 1))
    middle = 0.5 * scene.beam.length
    driven = Driven(beam=scene.beam, forces=forces, frequency_hz=hertz, count=segments, x=middle, times=times)
    found = departure(driven, force, inertia, cache.progress)
    return found.at_end if of == "end" else found.rms


class ChainRideOptions(msgspec.Struct, frozen=True, kw_only=True):
    """Time integration of the nonlinear chain from rest."""

    segments: Links
    links: Annotated[options.Links, Meta(description="stretching: by the beam's own EA / l")] = "rigid"
    force: ForceAmplitude | None = None
    soft_start_periods: SoftStart | None = None


def _ride(scene: Scene, cache: "SolutionCache", by: ChainRideOptions, options: SliderOptions) -> "ChainRide":
    """The run of the scene's slider on the chain. Raises InputError."""
    from verify.chain.ride import ride_from_rest

    slider = options.of(scene)
    if scene.motion is None:
        raise InputError("motion is missing: a slider on a chain takes [motion] with its duration")
    run = TimeOptions(model="analytic", force=by.force, soft_start_periods=by.soft_start_periods)
    request = _from_rest(scene, "a slider on a chain", run)
    forces, hertz, seconds = request["forces"], request["frequency_hz"], request["duration"]
    step = options.step or 1.0 / (scene.motion.steps_per_period * hertz)
    key: Any = ("chain", scene.beam, forces, hertz, slider, by.segments, seconds, step, by.links)
    if key not in cache.motors:
        cache.motors[key] = ride_from_rest(
            scene.beam, forces, hertz, slider, by.segments, seconds, step=step, links=by.links, progress=cache.progress
        )
    found: ChainRide = cache.motors[key]
    return found


def _imbalance(run: "ChainRide") -> float:
    assert run.ledger is not None
    return abs(run.ledger.residual) / run.ledger.rubbed


def _ride_figure(read: "Callable[[ChainRide], float]") -> Callable[..., float]:
    def ride_figure(scene: Scene, cache: "SolutionCache", by: ChainRideOptions, slider: SliderOptions) -> float:
        return read(_ride(scene, cache, by, slider))

    return ride_figure


RIDE: "dict[str, tuple[str, str, Callable[[ChainRide], float]]]" = {
    "displacement": ("m", "Displacement of the scene's slider along +x on the chain.", lambda run: run.displacement),
    "mean_speed": ("m/s", "Displacement of the slider on the chain over time.", lambda run: run.mean_speed),
    "imbalance": ("1", "Residual of the slider's energy balance on the chain over its friction loss.", _imbalance),
}
for _name, (_unit, _text, _read) in RIDE.items():
    quantity(f"chain.slider_{_name}", unit=_unit, summary=_text)(_ride_figure(_read))
