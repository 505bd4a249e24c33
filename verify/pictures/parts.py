"""Beams as pictures show them: a chain of rigid links with its pins, elements as one bar, supports, what is on them."""

from collections.abc import Iterator

import numpy as np

from verify.beam import Beam
from verify.models.arrays import Array
from verify.pictures.picture import GREY, INK, ORANGE, STEEL, Solid, Trace, arrow, bars, discs, strip
from verify.pictures.sizes import Drawn, Span

WALL = 0.068
"""Half the height of what guides an end, over the length."""
GAP = 0.08
"""Of a link, between it and its joints."""


def chain_solids(x: Array, line: Array, values: Array, drawn: Drawn) -> tuple[Solid, ...]:
    """Rigid links between joints (f, n, 2) at x (n,) over the length, coloured by (f, n), and the pins."""
    links = [_links(x, line, values, span) for span in drawn.spans]
    closest = float(np.linalg.norm(np.diff(line[0], axis=0), axis=1).min())
    at = np.searchsorted(drawn.steps, x, side="right")
    pins = [
        Solid(
            outlines=discs(line[:, at == i], min(0.75 * one.half, 0.35 * closest)), depth=1.12 * one.depth, colour=INK
        )
        for i, one in enumerate(drawn.spans)
    ]
    return tuple(one for one in (*links, *pins) if one.outlines.shape[1])


def _links(x: Array, line: Array, values: Array, span: Span) -> Solid:
    """What of the links between joints (f, n, 2) lies in a stretch; a link is cut where its section steps."""
    start, end = (np.clip((at - x[:-1]) / np.diff(x), GAP, 1.0 - GAP) for at in (span.start, span.end))
    kept = end > start
    first, last = (line[:, :-1][:, kept] + share[kept, None] * np.diff(line, axis=1)[:, kept] for share in (start, end))
    low, high = (values[:, :-1][:, kept] + share[kept] * np.diff(values, axis=1)[:, kept] for share in (start, end))
    colours = np.stack([low, high, high, low], axis=2)
    return Solid(outlines=bars(first, last, span.half), values=colours, depth=span.depth, edges=True)


def bar_solids(x: Array, line: Array, values: Array, drawn: Drawn) -> tuple[Solid, ...]:
    """One bar through (f, n, 2) at x (n,) over the length, coloured by (f, n), a solid for each stretch of it."""
    at = np.union1d(x, drawn.steps)
    line = np.stack([[np.interp(at, x, one[:, k]) for k in (0, 1)] for one in line]).swapaxes(1, 2)
    values = np.stack([np.interp(at, x, one) for one in values])
    stretch = np.searchsorted(drawn.steps, 0.5 * (at[1:] + at[:-1]))
    outlines = strip(line, np.array([span.half for span in drawn.spans])[stretch])
    ends = np.stack([values[:, :-1], values[:, 1:], values[:, 1:], values[:, :-1]], axis=2)
    return tuple(
        Solid(outlines=outlines[:, stretch == i], values=ends[:, stretch == i], depth=span.depth)
        for i, span in enumerate(drawn.spans)
    )


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
        radius = min(2.2 * float(drawn.half_at(np.array(mass.position / beam.length))), 0.022)
        solids.append(Solid(outlines=discs(at, radius, 24), depth=0.5 * drawn.depth, colour=INK))
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
