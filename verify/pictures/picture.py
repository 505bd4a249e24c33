"""What a picture consists of: outlines with a depth, lines, words, over frames. Values; no way of drawing in it."""

from typing import Literal

import msgspec
import numpy as np

from verify.models.arrays import Array

INK, GREY, STEEL = "#1d2330", "#8a93a3", "#b9c1cd"
RED, ORANGE = "#d6427a", "#e8760c"
COLOURS = ("#1f4fa3", "#4f8fe0", "#a9cdf2", "#eef0f2", "#f5c3a2", "#e8793a", "#a8300f")
"""From the lowest value to the highest, evenly."""


class Solid(msgspec.Struct, frozen=True, eq=False, kw_only=True):
    """Convex outlines in the plane of the bending, drawn out to both sides of it."""

    outlines: Array
    """(f, m, k, 2): m outlines of k corners in each of f frames; f is 1 where nothing moves."""
    depth: float
    """To each side."""
    values: Array | None = None
    """(f, m, k): what colours it, from -1 to 1; None where `colour` does."""
    colour: str = STEEL
    edges: bool = False
    """Whether its edges are drawn."""


class Trace(msgspec.Struct, frozen=True, eq=False, kw_only=True):
    """A line in front of everything."""

    points: Array
    """(f, n, 2)."""
    colour: str = INK
    width: float = 1.5
    """Pixels of a picture 960 wide."""
    depth: float = 0.0
    """How far in front."""


class Label(msgspec.Struct, frozen=True, kw_only=True):
    """Words at a place of the picture."""

    text: str
    x: float
    y: float
    side: Literal["left", "right", "middle"] = "left"
    """Which side of the words stands there."""


class Picture(msgspec.Struct, frozen=True, eq=False, kw_only=True):
    """Everything that is drawn; lengths in the beam's own, y upwards."""

    title: str
    said: tuple[str, ...]
    """Below it: what is drawn how many times as large."""
    notes: tuple[str, ...]
    """(f,) Of each frame, or none."""
    solids: tuple[Solid, ...]
    traces: tuple[Trace, ...]
    labels: tuple[Label, ...]
    scale: tuple[str, str, str]
    """What the lowest, the middle and the highest colour mean; empty words where nothing is coloured."""
    frames: int
    seconds: float
    """Of all frames."""
    box: tuple[float, float, float, float]
    """Left, right, bottom, top of what moves in it."""
    slanted: bool = True
    """Whether a solid drawing looks at it from above."""


def at_frame(values: Array, frame: int) -> Array:
    """Of something that moves, or does not."""
    return np.asarray(values[min(frame, len(values) - 1)])


def bars(first: Array, last: Array, half: float) -> Array:
    """Outlines (f, m, 4, 2) of bars of half a thickness from places (f, m, 2) to others."""
    along = last - first
    up = np.stack([-along[..., 1], along[..., 0]], axis=2) / np.linalg.norm(along, axis=2, keepdims=True) * half
    return np.stack([first - up, last - up, last + up, first + up], axis=2)


def strip(line: Array, half: float | Array) -> Array:
    """Outlines (f, n - 1, 4, 2) of one bar along lines (f, n, 2), without a gap where it bends.

    `half` its thickness is that of all of it, or (n - 1,).
    """
    along = np.gradient(line, axis=1)
    up = np.stack([-along[..., 1], along[..., 0]], axis=2) / np.linalg.norm(along, axis=2, keepdims=True)
    first, last = (np.reshape(half, (-1, 1)) * way for way in (up[:, :-1], up[:, 1:]))
    a, b = line[:, :-1], line[:, 1:]
    return np.stack([a - first, b - last, b + last, a + first], axis=2)


def discs(at: Array, radius: float, corners: int = 12) -> Array:
    """Outlines (f, m, corners, 2) of round things at (f, m, 2)."""
    turn = 2.0 * np.pi * np.arange(corners) / corners
    ring = radius * np.stack([np.cos(turn), np.sin(turn)], axis=1)
    return np.asarray(at[:, :, None, :] + ring)


def box(at: Array, turn: Array, half_length: float, height: float) -> Array:
    """Outlines (f, 1, 4, 2) of a block that stands with the middle of its foot at (f, 2), turned by (f,)."""
    corners = np.array([[-half_length, 0.0], [half_length, 0.0], [half_length, height], [-half_length, height]])
    c, s = np.cos(turn)[:, None], np.sin(turn)[:, None]
    x, y = corners[:, 0] * c - corners[:, 1] * s, corners[:, 0] * s + corners[:, 1] * c
    return np.asarray(at[:, None, None, :] + np.stack([x, y], axis=2)[:, None])


def arrow(foot: Array, along: Array, half: float) -> tuple[Array, Array]:
    """Shaft (f, 1, 4, 2) and head (f, 1, 3, 2) of arrows from (f, 2) along (f, 2); nothing where they have no size."""
    size = np.linalg.norm(along, axis=1, keepdims=True)
    way = np.divide(along, size, out=np.zeros_like(along), where=size > 0.0)
    side = np.stack([-way[:, 1], way[:, 0]], axis=1)
    head = np.minimum(4.0 * half, 0.6 * size)
    neck, tip = foot + along - way * head, foot + along
    thick = side * np.minimum(half, 0.25 * size)
    shaft = np.stack([foot - thick, neck - thick, neck + thick, foot + thick], axis=1)
    point = np.stack([neck - 2.2 * thick, tip, neck + 2.2 * thick], axis=1)
    return shaft[:, None], point[:, None]
