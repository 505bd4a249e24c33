"""Pictures and movies of modes, waves and motion: png, gif, webp."""

from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from verify.arrays import Array
from verify.errors import InputError
from verify.files import whole
from verify.formatting import unit_of
from verify.io.data import Dataset, Request
from verify.report.plotting import INK, MODEL_COLORS, movie_frames
from verify.report.result import Movie

if TYPE_CHECKING:
    from matplotlib.axes import Axes

    from verify.scene.model import Scene

FRAMES, FPS = 36, 20  # frames of one period of a mode, and per second
MAX_FRAMES = 300  # largest number of frames of a motion; more are thinned out
MARKERS = {"pinned": "^", "clamped": "s", "guided": "D", "free": "none"}
HEIGHT = 0.08  # largest drawn deflection over the length


def write_picture(scene: "Scene", data: Dataset, path: Path, request: Request) -> None:
    """Write a picture (png) or a movie of a dataset. Raises InputError for a beam at rest."""
    kind, frames = path.suffix.lower().removeprefix("."), _frames(data, request)
    if not 0.0 < abs(frames["deflection"]).max() < np.inf:
        raise InputError("what: the beam is at rest, give the drive a force")
    if kind == "png":
        largest = int(np.argmax(abs(frames["deflection"]).max(axis=1)))
        frames = {name: values[largest : largest + 1] for name, values in frames.items()}
    drawn = movie_frames(movie(scene, data, frames), 110.0, INK, "white")
    pictures = [image.convert("RGB") for image in drawn]
    with whole(path, "to") as part:
        if kind == "png":
            pictures[0].save(part, format="png")
        else:
            more = {"save_all": True, "append_images": pictures[1:], "duration": 1000 // FPS, "loop": 0}
            pictures[0].save(part, format=kind, **more)


def _frames(data: Dataset, request: Request) -> "dict[str, Array]":
    """Deflection (f, n), labels (f,), slider positions (f,) of the frames; of modes one swings over a period."""
    if data.what == "modes":
        mode = min(request.mode or 3, len(data.steps))
        swing = np.cos(2.0 * np.pi * np.arange(FRAMES) / FRAMES)
        labels = np.full(FRAMES, f"mode {mode} at {data.steps[mode - 1]:.6g} Hz")
        return {"deflection": data.deflection[mode - 1] * swing[:, None], "label": labels}
    thin = slice(None, None, -(-len(data.steps) // MAX_FRAMES))
    unit = unit_of(float(data.steps[-1]), "s")
    labels = np.array([f"t = {unit.factor * step:.3f} {unit.name}" for step in data.steps])
    frames = {"deflection": data.deflection[thin], "label": labels[thin]}
    return frames | {name: data.histories[name][thin] for name in ("slider_position",) if name in data.histories}


def movie(scene: "Scene", data: Dataset, frames: "dict[str, Array]") -> Movie:
    """The frames as a movie: the beam at its supports, forces as arrows, the slider on the surface."""

    def animate(ax: "Axes") -> Any:
        length, deflection = scene.beam.length, frames["deflection"]
        scale = HEIGHT * length / float(abs(deflection).max())
        color = MODEL_COLORS["segment" if data.links else "fem"]
        ax.plot([0.0, length], [0.0, 0.0], color="#b0b6be", linewidth=0.8)
        for x, support in zip((0.0, length), scene.beam.supports, strict=True):
            y = -0.3 * HEIGHT * length if support == "pinned" else 0.0
            ax.plot([x], [y], marker=MARKERS[support], color=INK, markersize=9, clip_on=False)
        for force in scene.forces if data.what != "modes" else ():
            tip = (force.position, 1.2 * HEIGHT * length)
            ax.annotate("", tip, (force.position, 2.1 * HEIGHT * length), arrowprops={"color": "#cc3f76", "width": 1.0})
        (line,) = ax.plot([], [], "-o" if data.links else "-", color=color, linewidth=3.0, markersize=3.5)
        (slider,) = ax.plot([], [], "s", color=MODEL_COLORS["fem"], markersize=11)
        text = ax.text(0.5, 0.97, "", transform=ax.transAxes, ha="center", va="top")
        ax.set(xlim=(-0.04 * length, 1.04 * length), ylim=(-2.4 * HEIGHT * length, 2.6 * HEIGHT * length))
        ax.set_axis_off()
        magnified = "" if data.what == "modes" else f"; deflection magnified {scale:.3g} times"
        ax.set_title(f"{data.title}{magnified}", fontsize=9)

        def update(frame: int) -> list[Any]:
            line.set_data(data.x, scale * deflection[frame])
            text.set_text(str(frames["label"][frame]))
            if "slider_position" in frames:
                at = float(frames["slider_position"][frame])
                height = scale * float(np.interp(at, data.x, deflection[frame])) + 0.25 * HEIGHT * length
                slider.set_data([at], [height])
            return [line, slider, text]

        return update, range(len(deflection))

    return Movie(data.what, data.title, "", animate)
