"""Pictures and movies of modes, waves and motion: png, gif, webp."""

from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from verify.errors import InputError
from verify.files import whole
from verify.formatting import unit_of
from verify.io.data import Dataset, Request
from verify.report.plotting import INK, MODEL_COLORS, MovingLine, animation, movie_frames
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
    kind, deflection, slider = path.suffix.lower().removeprefix("."), data.deflection, data.histories
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
    if (places := slider.get("slider_position")) is not None:
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

    drawn = movie_frames(Movie(data.what, data.title, "", animate), 110.0, INK, "white")
    first, *others = [image.convert("RGB") for image in drawn]
    more = {} if kind == "png" else {"save_all": True, "append_images": others, "duration": 1000 // FPS, "loop": 0}
    with whole(path, "to") as part:
        first.save(part, format=kind, **more)
