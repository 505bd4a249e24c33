"""Modes, the driven wave over a period and the motion of a scene as arrays, in files whose suffix is the file type."""

from collections.abc import Callable
from dataclasses import dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING, Any

import msgspec
import numpy as np
from msgspec.structs import replace

from verify.analysis.margins import sufficient_count
from verify.analysis.solution_cache import SolutionCache
from verify.arrays import Array
from verify.dynamics.arguments import Keep, Step
from verify.dynamics.simulate import simulate
from verify.errors import InputError, shown
from verify.files import whole, writable_folder, write_whole
from verify.formatting import unit_of
from verify.linear.registry import MODELS
from verify.quantities.slider import TimeOptions, motion_arguments
from verify.quantities.waves import FieldOptions, driven_case
from verify.report.plotting import INK, MODEL_COLORS, MovingLine, animation, drawn, movie_frames, style
from verify.report.result import Column, Movie, Table, to_json
from verify.scene.model import Scene
from verify.studies.convergence import Convergence
from verify.validation import check_choice
from verify.waves.driven_case import driven

if TYPE_CHECKING:
    from matplotlib.axes import Axes

DATA, PICTURES = ("modes", "wave", "motion"), ("png", "gif", "webp")
CHART = "convergence"
FRAMES, FPS = 36, 20  # frames of one period of a mode, and per second
MAX_FRAMES = 300  # largest number of frames of a motion; more are thinned out
MARKERS = {"pinned": "^", "clamped": "s", "guided": "D", "free": "none"}
HEIGHT = 0.08  # largest drawn deflection over the length
METADATA: dict[str, Any] = {"png": {"Software": None}, "svg": {"Date": None, "Creator": None}}
TYPES = {"vtu": ("modes", "wave"), **dict.fromkeys(("xdmf", "csv", "json", "npz", "gif", "webp"), DATA)}
TYPES |= {"png": (*DATA, CHART), "svg": (CHART,)}  # what a file type holds
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


def write(scene: Scene, path: Path, request: Request, progress: Callable[[str], None] = lambda step: None) -> str:
    """Write modes, wave, motion or the chart of convergence to a file, whole or not at all; returns what was written.

    Raises InputError for an unknown file type, for content that it does not hold, and where the file cannot be written.
    """
    kind = path.suffix.lower().removeprefix(".")
    if kind not in TYPES:
        raise InputError(f"to = {shown(str(path))}: the suffix is no file type, give one of .{', .'.join(TYPES)}")
    there = [*["motion"] * (scene.motion is not None), *["wave"] * bool(scene.forces), "modes"]
    what = request.what or next(what for what in [*there, CHART] if what in TYPES[kind])
    check_choice("what", what, (*DATA, CHART))
    if what not in TYPES[kind]:
        holding = ", ".join(f".{name}" for name, held in TYPES.items() if what in held)
        raise InputError(f"what = {what!r}: a .{kind} file does not hold it, give one of {holding}")
    writable_folder(path.parent, "to")
    progress(what)
    if what == CHART:
        return _convergence(scene, path, request, progress)
    data_ = dataset(scene, what, request)
    if kind in PICTURES:
        _picture(scene, data_, path, request)
    else:
        writers = {"vtu": _vtu, "xdmf": _xdmf, "csv": _csv, "json": _arrays, "npz": _arrays}
        writers[kind](data_, path)
    return data_.title


def _convergence(scene: Scene, path: Path, request: Request, progress: Callable[[str], None]) -> str:
    """The chart of the frequency errors over N, of the scene's [convergence] or its defaults, or of one mode."""
    if request.count is not None or request.samples is not None:
        raise InputError(f"what = {CHART!r}: count and samples do not apply, --set convergence.counts=20,40,80")
    study = scene.studies.get(CHART, Convergence())
    if request.mode is not None:
        study = replace(study, modes=(request.mode,))
    result = study.run(scene, SolutionCache(scene.beam), progress)
    kind = path.suffix.lower().removeprefix(".")
    with whole(path, "to") as part, style(salt=CHART):
        drawn(result.figures[0]).savefig(part, format=kind, dpi=160, facecolor="white", metadata=METADATA[kind])
    return f"{result.figures[0].title}. {result.summary}"


def _vectors(values: "Array", axis: int = 1) -> "Array":
    """(n,) as vectors (n, 3) along one axis: x along the beam, y across its thickness."""
    vectors = np.zeros((len(values), 3))
    vectors[:, axis] = values
    return vectors


def _mesh(data: Dataset, points: "dict[str, Array]") -> Any:
    import meshio

    lines = np.stack([np.arange(len(data.x) - 1), np.arange(1, len(data.x))], axis=1)
    return meshio.Mesh(_vectors(data.x, 0), [("line", lines)], point_data=points)


def _vtu(data: Dataset, path: Path) -> None:
    """Deflections as vectors, so that programs can warp the beam by them."""
    scalars = ("amplitude", "phase_deg", "slope_real", "slope_imaginary")
    points = {name: values if name in scalars else _vectors(values) for name, values in data.points.items()}
    with whole(path, "to") as part:
        _mesh(data, points).write(part, file_format="vtu")


def _xdmf(data: Dataset, path: Path) -> None:
    """A series in one file, its numbers as text: HDF5 is not needed."""
    import meshio

    with whole(path, "to") as part, meshio.xdmf.TimeSeriesWriter(part, data_format="XML") as writer:
        mesh = _mesh(data, {})
        writer.write_points_cells(mesh.points, mesh.cells)
        for i, step in enumerate(data.steps):
            slider = {name: np.full(len(data.x), values[i]) for name, values in data.histories.items()}
            writer.write_data(float(step), point_data={"deflection": _vectors(data.deflection[i]), **slider})


def _csv(data: Dataset, path: Path) -> None:
    """A row for each point; of a motion a row for each instant."""
    if data.what == "motion":
        head = [data.step_name, *data.histories, *(f"deflection at {float(x)!r} m" for x in data.x)]
        rows = np.column_stack([data.steps, *data.histories.values(), data.deflection])
    else:
        head, rows = ["x_m", *data.points], np.column_stack([data.x, *data.points.values()])
    write_whole(path, Table("", list(map(Column, head)), rows.tolist()).csv(), "to")


def _arrays(data: Dataset, path: Path) -> None:
    """All arrays, as JSON or compressed."""
    series = {data.step_name: data.steps, "deflection": data.deflection}
    arrays: dict[str, Any] = {"x": data.x, **data.points, **series, **data.histories}
    if path.suffix.lower() == ".json":
        write_whole(path, to_json({"what": data.what, "title": data.title, **arrays}), "to")
        return
    with whole(path, "to") as part, part.open("wb") as stream:
        np.savez_compressed(stream, title=np.array(data.title), **arrays)


def _picture(scene: Scene, data: Dataset, path: Path, request: Request) -> None:
    """Write a picture (png) or a movie of a dataset. Raises InputError for a beam at rest."""
    kind, deflection = path.suffix.lower().removeprefix("."), data.deflection
    if data.what == "modes":  # which swings over a period
        mode = min(request.mode or 3, len(data.steps))
        deflection = data.deflection[mode - 1] * np.cos(2.0 * np.pi * np.arange(FRAMES) / FRAMES)[:, None]
        labels = [f"mode {mode} at {data.steps[mode - 1]:.6g} Hz"] * FRAMES
    else:
        unit = unit_of(float(data.steps[-1]), "s")
        labels = [f"t = {unit.factor * step:.3f} {unit.name}" for step in data.steps]
    if not 0.0 < (largest := float(abs(deflection).max())) < np.inf:
        raise InputError("what: the beam is at rest, give the drive a force")
    frames: Any = range(0, len(deflection), -(-len(deflection) // MAX_FRAMES))
    if kind == "png":
        frames = [int(np.argmax(abs(deflection).max(axis=1)))]

    length, up = scene.beam.length, HEIGHT * scene.beam.length
    heights = up / largest * deflection
    form, color = ("-o", MODEL_COLORS["segment"]) if data.links else ("-", MODEL_COLORS["fem"])
    lines: list[MovingLine] = [(data.x, heights, form, {"color": color, "linewidth": 3.0, "markersize": 3.5})]
    if (places := data.histories.get("slider_position")) is not None:
        tops = [np.interp(x, data.x, w) + 0.25 * up for x, w in zip(places, heights, strict=True)]
        lines.append((places[:, None], np.array(tops)[:, None], "s", {"color": MODEL_COLORS["fem"], "markersize": 11}))

    def animate(ax: "Axes") -> Any:
        """The beam at its supports, forces as arrows, the slider on the surface."""
        ax.plot([0.0, length], [0.0, 0.0], color="#b0b6be", linewidth=0.8)
        for x, support in zip((0.0, length), scene.beam.supports, strict=True):
            y = -0.3 * up if support == "pinned" else 0.0
            ax.plot([x], [y], marker=MARKERS[support], color=INK, markersize=9, clip_on=False)
        for force in scene.forces if data.what != "modes" else ():
            arrow: Any = {"color": "#cc3f76", "width": 1.0}
            ax.annotate("", (force.position, 1.2 * up), (force.position, 2.1 * up), arrowprops=arrow)
        clock = ax.text(0.5, 0.97, "", transform=ax.transAxes, ha="center", va="top")
        ax.set(xlim=(-0.04 * length, 1.04 * length), ylim=(-2.4 * up, 2.6 * up))
        ax.set_axis_off()
        magnified = "" if data.what == "modes" else f"; deflection magnified {up / largest:.3g} times"
        ax.set_title(f"{data.title}{magnified}", fontsize=9)
        return animation(ax, lines, clock, labels), frames

    pictures = movie_frames(Movie(data.what, data.title, "", animate), 110.0, INK, "white")
    first, *others = [picture.convert("RGB") for picture in pictures]
    more = {} if kind == "png" else {"save_all": True, "append_images": others, "duration": 1000 // FPS, "loop": 0}
    with whole(path, "to") as part:
        first.save(part, format=kind, **more)
