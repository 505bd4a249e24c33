"""Beams as pictures show them: a chain of rigid links with its pins, elements as one bar, supports, what is on them."""

from collections.abc import Iterator

import msgspec
import numpy as np

from verify.beam import Beam
from verify.models.arrays import Array
from verify.pictures.picture import GREY, INK, ORANGE, STEEL, Solid, Trace, arrow, bars, discs, strip

THIN, NARROW, BROAD = 0.007, 0.012, 0.06
"""Half a drawn thickness at least; half a drawn width at least and at most; all over the length."""
WALL = 0.068
"""Half the height of what guides an end, over the length."""
GAP = 0.08
"""Of a link, between it and its joints."""


class Drawn(msgspec.Struct, frozen=True, kw_only=True):
    """How thick and wide a beam is drawn, half of each over its length, and what is to be said of it."""

    half: float
    depth: float
    said: str


def drawn_section(beam: Beam) -> Drawn:
    """As it is where that can be seen, else larger, in words."""
    fibre, width = beam.own.extreme_fibre, beam.width
    half = max(THIN, fibre / beam.length if fibre else 0.0)
    own = 0.5 * (width or 0.0) / beam.length
    depth = min(max(own, NARROW), BROAD)
    if fibre is None:
        return Drawn(half=half, depth=depth, said="the section has no sizes and is drawn as a strip")
    thick = half * beam.length / fibre
    said = f"thickness drawn {times(thick)}" if thick > 1.01 else "thickness as it is"
    if width is not None and abs(depth / own - 1.0) > 0.01:
        said += f", width {times(depth / own)}"
    return Drawn(half=half, depth=depth, said=said)


def times(factor: float) -> str:
    """'5,800 times as large': two digits, or three from 1.0 to 9.99."""
    if 1e-2 <= factor < 10.0:
        return f"{factor:.3g} times as large"
    power = int(np.floor(np.log10(factor))) - 1
    rounded = round(factor / 10.0**power) * 10.0**power
    return f"{rounded:,.0f} times as large" if rounded < 1e7 else f"{factor:.1e} times as large"


def chain_solids(line: Array, values: Array, drawn: Drawn) -> tuple[Solid, ...]:
    """Rigid links between joints (f, n, 2), coloured by (f, n), and the pins."""
    ends = np.stack([values[:, :-1], values[:, 1:], values[:, 1:], values[:, :-1]], axis=2)
    links = Solid(outlines=bars(line, drawn.half, GAP), values=ends, depth=drawn.depth, edges=True)
    size = min(0.75 * drawn.half, 0.35 * float(np.linalg.norm(np.diff(line[0], axis=0), axis=1).min()))
    pins = Solid(outlines=discs(line, size), depth=1.12 * drawn.depth, colour=INK)
    return links, pins


def bar_solids(line: Array, values: Array, drawn: Drawn) -> tuple[Solid, ...]:
    """One bar through (f, n, 2), coloured by (f, n)."""
    ends = np.stack([values[:, :-1], values[:, 1:], values[:, 1:], values[:, :-1]], axis=2)
    return (Solid(outlines=strip(line, drawn.half), values=ends, depth=drawn.depth),)


def support_solids(supports: tuple[str, str], y: float, drawn: Drawn) -> Iterator[Solid]:
    """What holds the ends of a beam of length 1 at the height y."""
    for x, support, out in ((0.0, supports[0], -1.0), (1.0, supports[1], 1.0)):
        for outline, colour in _held(support, out):
            yield Solid(outlines=outline[None, None] + np.array([x, y]), depth=1.3 * drawn.depth, colour=colour)


def _held(support: str, out: float) -> Iterator[tuple[Array, str]]:
    """Outlines about the end: a wedge below a pin, a wall behind a clamp, a wall with a slot before a guide."""
    if support == "pinned":
        yield np.array([[0.0, -0.004], [-0.02, -0.04], [0.02, -0.04]]), GREY
        yield np.array([[-0.03, -0.04], [-0.03, -0.047], [0.03, -0.047], [0.03, -0.04]]), STEEL
    elif support == "clamped":
        yield np.array([[0.0, -0.045], [0.025 * out, -0.045], [0.025 * out, 0.045], [0.0, 0.045]]), GREY
    elif support == "guided":
        yield np.array([[0.0, -WALL], [0.006 * out, -WALL], [0.006 * out, WALL], [0.0, WALL]]), STEEL
        yield np.array([[0.012 * out, -WALL], [0.025 * out, -WALL], [0.025 * out, WALL], [0.012 * out, WALL]]), GREY


def attached_parts(beam: Beam, x: Array, line: Array, y: float, drawn: Drawn) -> tuple[list[Solid], list[Trace]]:
    """Bodies and springs on a beam, moved with its line (f, n, 2) through x (n,), metres."""
    solids, traces = [], []
    for mass in beam.mass:
        at = _on(line, x, mass.position)[:, None]
        solids.append(Solid(outlines=discs(at, min(2.2 * drawn.half, 0.022), 24), depth=0.5 * drawn.depth, colour=INK))
    for spring in beam.spring:
        top = _on(line, x, spring.position)
        if spring.stiffness:
            traces.append(Trace(points=_zigzag(top, y - 0.1), colour=INK, depth=1.2 * drawn.depth))
        if spring.rotational:
            traces.append(Trace(points=top[:, None] + _SPIRAL, colour=INK, depth=1.2 * drawn.depth))
    return solids, traces


def _on(line: Array, x: Array, position: float) -> Array:
    """Where a line (f, n, 2) through x stands at a position, (f, 2)."""
    return np.array([[np.interp(position, x, one[:, k]) for k in (0, 1)] for one in line])


_SPIRAL = (np.linspace(0.006, 0.024, 60) * np.exp(1j * np.linspace(0.0, 5.0 * np.pi, 60)))[:, None]
_SPIRAL = np.concatenate([_SPIRAL.real, _SPIRAL.imag], axis=1)
"""A spring against turning, (60, 2)."""


def _zigzag(top: Array, ground: float) -> Array:
    """A spring from (f, 2) straight down, (f, 14, 2)."""
    share = np.linspace(0.0, 1.0, 14)
    swing = 0.012 * np.array([0, 0, *([1, -1] * 5), 0, 0])
    x = top[:, :1] + swing
    y = top[:, 1:] * (1.0 - share) + ground * share
    return np.stack([x, y], axis=2)


def force_solids(foot: Array, along: Array, drawn: Drawn, colour: str = ORANGE) -> tuple[Solid, ...]:
    """An arrow from (f, 2) along (f, 2)."""
    return tuple(Solid(outlines=part, depth=0.35 * drawn.depth, colour=colour) for part in arrow(foot, along, 0.004))
