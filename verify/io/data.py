"""What is exported of a scene as arrays: its modes, its driven wave over a period, its motion in time."""

from dataclasses import dataclass, field
from typing import Any

import msgspec
import numpy as np

from verify.analysis.margins import sufficient_count
from verify.analysis.solution_cache import SolutionCache
from verify.arrays import Array
from verify.dynamics.arguments import Keep, Step
from verify.dynamics.simulate import simulate
from verify.errors import InputError
from verify.linear.registry import MODELS
from verify.quantities.slider import TimeOptions, motion_arguments
from verify.quantities.waves import FieldOptions, driven_case
from verify.scene.model import Scene
from verify.waves.driven_case import driven

MODES, EXACT = 10, 201  # default number of modes, and points of the exact beam
PHASES, INSTANTS = 36, 101  # default number of steps of a period and of a motion


class Request(msgspec.Struct, frozen=True, kw_only=True):
    """What to export."""

    what: str | None = None  # modes, wave or motion; by default what the scene has and the file type holds
    model: str = "segment"
    count: int | None = None
    """Segments or elements; by default those of the scene's study of the same subject, else the fewest within 1 %."""
    mode: int | None = None  # number of modes of data, the mode of a picture
    samples: int | None = None  # steps of a period or of a motion


@dataclass(frozen=True)
class Dataset:
    """Values at n points along a beam, and deflections over k steps. SI units.

    `links`: whether the beam is straight between its points `x` (n,), ascending. `points`: (n,) each. `steps` (k,):
    time, or the frequencies of modes. `deflection` (k, n); of modes mass-normalised, 1/sqrt(kg). `histories`: (k,)
    each, of the slider.
    """

    what: str
    title: str
    links: bool
    x: Array
    points: dict[str, Array]
    steps: Array
    step_name: str
    deflection: Array
    histories: dict[str, Array] = field(default_factory=dict)


def dataset(scene: Scene, what: str, request: Request) -> Dataset:
    """Modes, wave or motion of a scene by one model. Raises InputError where the scene lacks what is needed."""
    model = MODELS.named(request.model)
    study = scene.studies.get({"modes": "spectrum"}.get(what, what))
    if request.count is not None and not model.sized:
        raise InputError(f"count = {request.count}: the {model.name} model has no segments or elements, leave it out")
    cache, count = SolutionCache(scene.beam), request.count or getattr(study, "count", None)
    if model.sized and count is None:
        hertz = scene.drive.frequency_hz if scene.drive and what != "modes" else None
        count = sufficient_count(cache, modes=0 if hertz else request.mode or MODES, frequency_hz=hertz)
    count = count if model.sized else None
    length = scene.beam.length
    x = np.linspace(0.0, length, EXACT) if count is None else np.asarray(cache.modes(model.name, count, 1).nodes)
    name = f"{count} {model.title}" if count else model.title
    reader = {"modes": _modes, "wave": _wave, "motion": _motion}[what]
    values = reader(scene, cache, request, count, x)
    values["title"] = f"{values['title']}, {name}"
    return Dataset(what=what, links=model.name == "segment", x=x, **values)


def _modes(scene: Scene, cache: SolutionCache, request: Request, count: int | None, x: Array) -> dict[str, Any]:
    n = request.mode or MODES
    if count is not None:
        if request.mode is None:
            n = min(n, MODELS[request.model].build(scene.beam, count).n_elastic)
        modes = cache.modes(request.model, count, n)
    else:
        modes = MODELS[request.model].build(scene.beam).modes(n)
    shapes, frequencies = np.asarray(modes.deflection(x))[:n], np.asarray(modes.frequencies_hz)[:n]
    digits = len(str(n))
    names = [f"mode_{i:0{digits}d} at {hertz:.9g} Hz" for i, hertz in enumerate(frequencies, 1)]
    return {
        "title": f"modes 1 to {n}",
        "points": dict(zip(names, shapes, strict=True)),
        "steps": frequencies,
        "step_name": "frequency_hz",
        "deflection": shapes,
    }


def _wave(scene: Scene, cache: SolutionCache, request: Request, count: int | None, x: Array) -> dict[str, Any]:
    if scene.drive is None or not scene.forces:
        raise InputError("what = 'wave': the scene has no drive with forces, add [drive] or export modes")
    field_ = driven(driven_case(scene, FieldOptions(model=request.model, count=count)), cache)
    w, slope, n = field_.deflection(x), field_.slope(x), request.samples or PHASES
    turns = np.exp(2j * np.pi * np.arange(n) / n)
    points = {"real": w.real, "imaginary": w.imag, "amplitude": np.abs(w), "phase_deg": np.rad2deg(np.angle(w))}
    return {
        "title": f"steady wave at {scene.drive.frequency_hz:g} Hz",
        "points": points | {"slope_real": np.asarray(slope.real), "slope_imaginary": np.asarray(slope.imag)},
        "steps": np.arange(n) / n / scene.drive.frequency_hz,
        "step_name": "time_s",
        "deflection": (w[None, :] * turns[:, None]).real,
    }


def _motion(scene: Scene, cache: SolutionCache, request: Request, count: int | None, x: Array) -> dict[str, Any]:
    if scene.motion is None:
        raise InputError("what = 'motion': the scene has no [motion], add it or --set motion.duration=1e-3")
    if scene.devices:
        raise InputError("what = 'motion': motion in time does not model drive.device, leave drive.device out")
    arguments = motion_arguments(scene, TimeOptions(model=request.model, count=count))
    if scene.slider is not None:
        arguments |= {"slider": scene.slider, "step": Step(per_period=scene.motion.steps_per_period)}
    run = simulate(**arguments, keep=Keep(at=x, samples=request.samples or INSTANTS))
    names = ("position", "speed", "friction", "surface_speed", "normal_force") if scene.slider else ()
    return {
        "title": f"motion, 0 to {run.times[-1]:g} s",
        "points": {},
        "steps": np.asarray(run.times),
        "step_name": "time_s",
        "deflection": np.asarray(run.deflection),
        "histories": {f"slider_{name}": np.asarray(getattr(run, name)) for name in names},
    }
