"""Pictures and movies of modes, waves and motion: png, gif, webp, mp4; a solid beam by pyvista where requested."""

from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from verify.errors import InputError
from verify.files import whole
from verify.formatting import unit_of
from verify.io.data import Dataset, Request
from verify.report.plotting import INK, MODEL_COLORS, movie_frames
from verify.report.result import Movie

if TYPE_CHECKING:
    from matplotlib.animation import FuncAnimation
    from matplotlib.figure import Figure

    from verify.arrays import Array
    from verify.scene.model import Scene

FRAMES, FPS = 36, 20
"""Frames of one period of a mode, and per second."""
MAX_FRAMES = 300
"""Of a motion; more steps are thinned out."""
MARKERS = {"pinned": "^", "clamped": "s", "guided": "D", "free": "none"}
HEIGHT = 0.08
"""Largest drawn deflection over the length."""


def write_picture(scene: "Scene", data: Dataset, path: Path, request: Request) -> None:
    """Write a picture (png) or a movie of a dataset.

    Raises InputError for mp4 without ffmpeg, and for a solid picture without pyvista.
    """
    kind, frames = path.suffix.lower().removeprefix("."), _frames(data, request)
    if kind == "png":
        largest = int(np.argmax(abs(frames["deflection"]).max(axis=1)))
        frames = {name: values[largest : largest + 1] for name, values in frames.items()}
    if request.solid:
        pictures = _solid(data, frames)
    else:
        drawn = movie_frames(movie(scene, data, frames), 110.0, INK, "white")[0]
        pictures = [image.convert("RGB") for image in drawn]
    with whole(path, "to") as part:
        if kind == "png":
            pictures[0].save(part, format="png")
        elif kind == "mp4":
            _write_mp4(pictures, part)
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


def _scale(deflection: "Array", length: float) -> float:
    """Factor from the deflection to lengths of the beam. Raises InputError for a beam at rest."""
    largest = float(abs(deflection).max())
    if not 0.0 < largest < np.inf:
        raise InputError("what: the beam is at rest, give the drive a force")
    return HEIGHT * length / largest


def movie(scene: "Scene", data: Dataset, frames: "dict[str, Array]") -> Movie:
    """The frames as a movie: the beam at its supports, forces as arrows, the slider on the surface."""

    def animate(figure: "Figure") -> "FuncAnimation":
        from matplotlib.animation import FuncAnimation

        ax: Any = figure.subplots()
        length, deflection = scene.beam.length, frames["deflection"]
        scale = _scale(deflection, length)
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

        return FuncAnimation(figure, update, frames=len(deflection), interval=1000.0 / FPS)

    return Movie(data.what, data.title, "", animate)


def _write_mp4(pictures: list[Any], path: Path) -> None:
    """H.264 by ffmpeg, from the path or from imageio-ffmpeg. Raises InputError where there is none."""
    import shutil
    import subprocess

    program = shutil.which("ffmpeg")
    if program is None:
        try:
            from imageio_ffmpeg import get_ffmpeg_exe
        except ImportError:
            raise InputError("to: mp4 needs ffmpeg, install it or imageio-ffmpeg, or give .gif or .webp") from None
        program = get_ffmpeg_exe()
    width, height = (size // 2 * 2 for size in pictures[0].size)
    raw = ["-f", "rawvideo", "-pix_fmt", "rgb24", "-s", f"{width}x{height}", "-r", str(FPS), "-i", "-"]
    command = [program, "-y", "-loglevel", "error", *raw, "-pix_fmt", "yuv420p", "-f", "mp4", str(path)]
    frames = b"".join(picture.crop((0, 0, width, height)).tobytes() for picture in pictures)
    done = subprocess.run(command, input=frames, capture_output=True, check=False)
    if done.returncode:
        raise InputError(f"to: ffmpeg cannot write mp4 ({done.stderr.decode(errors='replace').strip()}): give .gif")


def _solid(data: Dataset, frames: "dict[str, Array]") -> list[Any]:
    """The beam as a strip with its colours by deflection, off screen. Raises InputError without pyvista."""
    try:
        import pyvista
    except ImportError:
        raise InputError(
            "solid = true needs pyvista: pip install 'fem-segment-verify[viz]', or leave --solid out"
        ) from None
    from PIL import Image

    length = float(data.x[-1])
    half = min(max(0.5 * (data.beam.width or 0.0), 0.04 * length), 0.1 * length)
    scale = _scale(frames["deflection"], length)
    largest, pictures = float(abs(frames["deflection"]).max()), []
    plotter = pyvista.Plotter(off_screen=True, window_size=(1280, 720))
    for deflection, label in zip(frames["deflection"], frames["label"], strict=True):
        sides = np.meshgrid([-half, half], data.x, indexing="ij")
        grid = pyvista.StructuredGrid(sides[1], sides[0], np.tile(scale * deflection, (2, 1)))
        grid["deflection"] = np.tile(deflection, (2, 1)).ravel(order="F")
        plotter.clear()
        plotter.add_mesh(grid, scalars="deflection", cmap="coolwarm", clim=(-largest, largest), show_edges=data.links)
        plotter.add_text(f"{data.title}\n{label}", font_size=10)
        plotter.camera_position = [(0.5 * length, -1.6 * length, 0.7 * length), (0.5 * length, 0, 0), (0, 0, 1)]
        plotter.camera.zoom(1.4)
        pictures.append(Image.fromarray(np.asarray(plotter.screenshot(return_img=True))))
    plotter.close()
    return pictures
