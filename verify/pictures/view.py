"""Where a picture's plane lies on the sheet: one parallel view for solid and flat drawings and the words on them."""

import msgspec
import numpy as np

from verify.models.arrays import Array
from verify.pictures.picture import COLOURS, Picture

HEAD, FOOT = 0.045, 0.088
"""Of the width of the sheet: above the drawing, for the title, and below it, for the words."""
STILL, MOVING = 1600, 960
"""Pixels across."""
HIGHEST = 0.5
"""Of a drawing, over its width."""
FROM = (0.11, 0.30, 1.0)
"""Whence a solid drawing is seen."""


class View(msgspec.Struct, frozen=True, eq=False, kw_only=True):
    """A parallel projection onto pixels of the drawing, whose upper left corner is (0, 0)."""

    size: tuple[int, int]
    """Width and height of the drawing, pixels."""
    right: Array
    """(3,), unit vector."""
    up: Array
    """(3,)."""
    towards: Array
    """(3,), from the picture to the eye."""
    centre: Array
    """(3,), which stands in the middle of the drawing."""
    scale: float
    """Pixels of a length of 1."""

    def pixels(self, points: Array, depth: float = 0.0) -> Array:
        """Of points (..., 2) of the plane at a depth in front of it, (..., 2)."""
        space = np.concatenate([points, np.full((*points.shape[:-1], 1), depth)], axis=-1) - self.centre
        flat = np.stack([space @ self.right, -(space @ self.up)], axis=-1)
        return np.asarray(flat * self.scale + 0.5 * np.array(self.size))


def view_of(picture: Picture, width: int, *, slanted: bool) -> View:
    """All of the picture's box, as wide as the sheet, or as high as HIGHEST lets it be."""
    towards = np.array(FROM if slanted and picture.slanted else (0.0, 0.0, 1.0))
    towards = towards / np.linalg.norm(towards)
    right = np.cross([0.0, 1.0, 0.0], towards)
    right /= np.linalg.norm(right)
    up = np.cross(towards, right)
    left, far, bottom, top = picture.box
    depth = max((solid.depth for solid in picture.solids), default=0.0)
    corners = np.array([[x, y, z] for x in (left, far) for y in (bottom, top) for z in (-depth, depth)])
    across, along = corners @ right, corners @ up
    scale = min(width / np.ptp(across), HIGHEST * width / np.ptp(along))
    size = (width, int(np.ceil(scale * np.ptp(along) / 2.0)) * 2)
    centre = right * (across.max() + across.min()) / 2.0 + up * (along.max() + along.min()) / 2.0
    return View(size=size, right=right, up=up, towards=towards, centre=centre, scale=float(scale))


def sheet_of(view: View) -> tuple[int, int]:
    """Width and height of the whole, both even, as films have to be."""
    width, height = view.size
    return width, height + 2 * int((HEAD + FOOT) * width / 2.0)


def colours(values: Array) -> Array:
    """Red, green and blue, 0 to 255, (..., 3), of values from -1 to 1."""
    known = np.array([[int(one[i : i + 2], 16) for i in (1, 3, 5)] for one in COLOURS], dtype=float)
    places = np.linspace(-1.0, 1.0, len(COLOURS))
    return np.stack([np.interp(values, places, known[:, k]) for k in range(3)], axis=-1)
