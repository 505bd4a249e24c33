"""Frames in one file: png, webp, gif by Pillow, mp4 by imageio-ffmpeg; written whole or not at all."""

from collections.abc import Iterator
from importlib.util import find_spec
from itertools import chain
from pathlib import Path

import numpy as np
from PIL import Image

from verify.errors import InputError
from verify.files import whole
from verify.pictures.picture import GREY, ORANGE, RED, STEEL
from verify.pictures.view import colours

MOVING = (".gif", ".webp", ".mp4")
SUFFIXES = (".png", *MOVING)


def check_writable(suffix: str) -> None:
    """Raise InputError, before anything is drawn, for what takes a package that is not there."""
    if suffix == ".mp4" and find_spec("imageio_ffmpeg") is None:
        raise InputError("to: an mp4 takes imageio-ffmpeg, pip install imageio-ffmpeg, or give a .webp or .gif")


def write_film(frames: Iterator[Image.Image], path: Path, n: int, seconds: float) -> None:
    """All frames, shown in so many seconds, over and over. Raises InputError where the file cannot be written."""
    suffix = path.suffix.lower()
    with whole(path, "to") as part:
        if suffix == ".mp4":
            _mp4(frames, part, n / seconds)
        elif suffix == ".png":
            next(frames).save(part, format="PNG", optimize=True)
        else:
            _loop(frames, part, suffix, 1000.0 * seconds / n)


def _loop(frames: Iterator[Image.Image], part: Path, suffix: str, milliseconds: float) -> None:
    first = next(frames)
    with part.open("wb") as stream:
        if suffix == ".webp":
            more = {"append_images": frames, "duration": round(milliseconds), "quality": 80}
            first.save(stream, format="WEBP", save_all=True, loop=0, **more)
            return
        palette = _palette()
        first, *rest = (frame.quantize(palette=palette, dither=Image.Dither.NONE) for frame in chain([first], frames))
        duration = max(round(milliseconds / 10.0) * 10, 20)  # it counts hundredths, and viewers slow down below two
        first.save(stream, format="GIF", save_all=True, loop=0, append_images=rest, duration=duration)


def _palette() -> Image.Image:
    """Of all frames, the same colours: the scale's in several lights, greys, what else is drawn; white among them."""
    ramp = colours(np.linspace(-1.0, 1.0, 21))
    lights = np.array([1.0, 0.92, 0.8, 0.68, 0.56, 0.44, 0.3])
    others = np.array([[int(one[i : i + 2], 16) for i in (1, 3, 5)] for one in (RED, ORANGE, STEEL, GREY)], dtype=float)
    shades = np.concatenate([ramp, others])[None] * lights[:, None, None]
    greys = np.repeat(np.append(np.linspace(0.0, 238.0, 44), 255.0)[:, None], 3, axis=1)
    inked = np.linspace([29.0, 35.0, 48.0], [226.0, 229.0, 234.0], 24)
    known = np.rint(np.concatenate([shades.reshape(-1, 3), greys, inked]))[:256]
    image = Image.new("P", (1, 1))
    image.putpalette(known.astype(np.uint8).tobytes())
    return image


def _mp4(frames: Iterator[Image.Image], part: Path, per_second: float) -> None:
    """Three rounds, since players do not begin again by themselves."""
    import imageio_ffmpeg

    kept = [np.asarray(frame) for frame in frames]
    height, width = kept[0].shape[:2]
    writer = imageio_ffmpeg.write_frames(
        str(part),
        (width, height),
        fps=per_second,
        macro_block_size=2,
        output_params=["-f", "mp4"],
        ffmpeg_log_level="error",
    )
    writer.send(None)
    try:
        for frame in kept * 3:
            writer.send(np.ascontiguousarray(frame))
    finally:
        writer.close()
