"""Pictures drawn flat, by Pillow: what is left of them where there is nothing that draws solids."""

from collections.abc import Iterator

import numpy as np
from PIL import Image, ImageDraw

from verify.models.arrays import Array
from verify.pictures.picture import INK, Picture, Solid, at_frame
from verify.pictures.view import View, colours

FINER = 3
"""Times as many pixels are drawn, of which means are taken."""
PAPER = "#ffffff"


def flat_frames(picture: Picture, view: View) -> Iterator[Image.Image]:
    """Every frame of the drawing, without words."""
    for frame in range(picture.frames):
        yield _drawn(picture, view, frame)


def _drawn(picture: Picture, view: View, frame: int) -> Image.Image:
    width, height = view.size
    image = Image.new("RGB", (FINER * width, FINER * height), PAPER)
    pen = ImageDraw.Draw(image)
    for solid in picture.solids:
        _solid(pen, view, solid, frame)
    for trace in picture.traces:
        line = FINER * view.pixels(at_frame(trace.points, frame))
        thick = max(round(FINER * trace.width * width / 960.0), 1)
        pen.line([(float(x), float(y)) for x, y in line], fill=trace.colour, width=thick, joint="curve")
    return image.reduce(FINER)


def _solid(pen: ImageDraw.ImageDraw, view: View, solid: Solid, frame: int) -> None:
    """Each outline in the colour of its mean value."""
    outlines = FINER * view.pixels(at_frame(solid.outlines, frame))
    fills = _fills(solid, frame, len(outlines))
    for outline, fill in zip(outlines, fills, strict=True):
        corners = [(float(x), float(y)) for x, y in outline]
        pen.polygon(corners, fill=fill, outline=INK if solid.edges else fill, width=1 if solid.edges else 0)


def _fills(solid: Solid, frame: int, n: int) -> list[tuple[int, int, int] | str]:
    if solid.values is None:
        return [solid.colour] * n
    means: Array = at_frame(solid.values, frame).mean(axis=1)
    return [(int(r), int(g), int(b)) for r, g, b in np.rint(colours(means))]
