"""Words on pictures: title, what is drawn how large, scale of colours. By Pillow, whatever drew the rest."""

from collections.abc import Iterable, Iterator
from functools import cache
from pathlib import Path

import numpy as np
from PIL import Image, ImageDraw, ImageFont

from verify.pictures.picture import INK, Picture
from verify.pictures.view import FOOT, HEAD, View, colours, sheet_of

Font = ImageFont.FreeTypeFont | ImageFont.ImageFont
MUTED = "#566072"
MARGIN, SCALE = 0.02, 0.24
"""Of the width: at the sides, and of the strip of colours."""


def lettered(picture: Picture, view: View, drawings: Iterable[Image.Image]) -> Iterator[Image.Image]:
    """Whole sheets of drawings."""
    for frame, drawing in enumerate(drawings):
        image = Image.new("RGB", sheet_of(view), "#ffffff")
        image.paste(drawing, (0, int(HEAD * image.width)))
        _write(image, picture, view, frame)
        yield image


def _write(image: Image.Image, picture: Picture, view: View, frame: int) -> None:
    pen, width = ImageDraw.Draw(image), image.width
    left, small, high = MARGIN * width, 0.0152 * width, HEAD * width
    title = _fitting(pen, picture.title, 0.0225 * width, width - 2.0 * left)
    pen.text((left, 0.4 * high), picture.title, font=title, fill=INK, anchor="lm")
    for label in picture.labels:
        x, y = view.pixels(np.array([label.x, label.y]), _front(picture))
        anchor = {"left": "lm", "right": "rm", "middle": "mm"}[label.side]
        pen.text((float(x), float(y) + high), label.text, font=_font(small), fill=INK, anchor=anchor)
    top = image.height - FOOT * width + 0.3 * small
    note = picture.notes[min(frame, len(picture.notes) - 1)] if picture.notes else ""
    room = (1.0 - 2.0 * MARGIN - (SCALE + 0.03) * any(picture.scale)) * width
    words = [note] * bool(note) + [line for one in picture.said for line in _broken(pen, one, _font(small), room)]
    for i, line in enumerate(words[:4]):
        pen.text((left, top + i * 1.36 * small), line, font=_font(small), fill=INK if note and i == 0 else MUTED)
    if any(picture.scale):
        _scale(pen, image, picture, (width - left - SCALE * width, top + 1.5 * small, SCALE * width, 0.0125 * width))


def _front(picture: Picture) -> float:
    return max((solid.depth for solid in picture.solids if solid.values is not None), default=0.0)


def _scale(
    pen: ImageDraw.ImageDraw, image: Image.Image, picture: Picture, place: tuple[float, float, float, float]
) -> None:
    """A strip of all colours, what its ends mean below it, of what it is above."""
    x, y, width, height = place
    strip = np.broadcast_to(colours(np.linspace(-1.0, 1.0, int(width)))[None], (int(height), int(width), 3))
    image.paste(Image.fromarray(np.rint(strip).astype(np.uint8)), (int(x), int(y)))
    low, of, high = picture.scale
    font = _font(0.0152 * image.width)
    pen.text((x + 0.5 * width, y - 0.35 * height), of, font=font, fill=INK, anchor="ms")
    pen.text((x, y + 1.3 * height), low, font=font, fill=MUTED, anchor="la")
    pen.text((x + width, y + 1.3 * height), high, font=font, fill=MUTED, anchor="ra")


def _broken(pen: ImageDraw.ImageDraw, text: str, font: Font, room: float) -> list[str]:
    """A text in lines that fit."""
    lines: list[str] = []
    line = ""
    for word in text.split():
        longer = f"{line} {word}".strip()
        if line and pen.textlength(longer, font=font) > room:
            lines, line = [*lines, line], word
        else:
            line = longer
    return [*lines, line]


def _fitting(pen: ImageDraw.ImageDraw, text: str, size: float, room: float) -> Font:
    """The font, smaller where the text would run out of the picture."""
    while size > 9.0 and pen.textlength(text, font=_font(size, bold=True)) > room:
        size *= 0.92
    return _font(size, bold=True)


@cache
def _font(size: float, *, bold: bool = False) -> Font:
    """DejaVu, which comes with matplotlib; Pillow's own where there is none."""
    from importlib.util import find_spec

    found = find_spec("matplotlib")
    if found is not None and found.origin is not None:
        path = Path(found.origin).parent / "mpl-data/fonts/ttf" / f"DejaVuSans{'-Bold' * bold}.ttf"
        if path.exists():
            return ImageFont.truetype(str(path), size)
    return ImageFont.load_default(size)
