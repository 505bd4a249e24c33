"""How thick and wide a beam is drawn: every stretch of it in the same measure, and that measure in words."""

from collections.abc import Sequence

import msgspec
import numpy as np

from verify.beam import Beam
from verify.models.arrays import Array
from verify.section import merged

THIN, THICK = 0.007, 0.03
"""Half of the least thickness drawn, unless another stretch would come out thicker than THICK; over the length."""
NARROW, BROAD = 0.012, 0.06
"""Half a drawn width at least and at most, over the length."""


class Span(msgspec.Struct, frozen=True, kw_only=True):
    """A stretch of one section; everything over the length of the beam."""

    start: float
    end: float
    half: float
    """Half its thickness, as it is drawn."""
    depth: float
    """Half its width."""


class Drawn(msgspec.Struct, frozen=True, kw_only=True):
    """How thick and wide a beam is drawn along it, and what is to be said of it."""

    spans: tuple[Span, ...]
    """From left to right, without gaps; neighbours differ."""
    said: str

    @property
    def half(self) -> float:
        """Of the thickest stretch."""
        return max(span.half for span in self.spans)

    @property
    def depth(self) -> float:
        """Of the widest one."""
        return max(span.depth for span in self.spans)

    @property
    def bulge(self) -> float:
        """By how much the thickest stretch reaches out beyond a beam of the least thickness."""
        return max(self.half - THIN, 0.0)

    @property
    def steps(self) -> Array:
        """Where one stretch ends and the next begins."""
        return np.array([span.start for span in self.spans[1:]])

    def half_at(self, x: Array) -> Array:
        """Half the thickness at places over the length, of the shape of x; at a step of the right stretch."""
        found = np.searchsorted(self.steps - 1e-9, x, side="right")
        return np.array([span.half for span in self.spans])[found]


def drawn_section(beam: Beam) -> Drawn:
    """As it is where that can be seen, else larger, in words; all sections by one factor."""
    fibres = [piece.extreme_fibre for piece in beam.pieces]
    widths = _widths(beam)
    thick = _enlarged([fibre / beam.length for fibre in fibres if fibre is not None], THIN, THICK)
    wide = _enlarged([0.5 * width / beam.length for width in widths if width is not None], NARROW, BROAD)
    halves = [THIN if fibre is None else max(thick, 1.0) * fibre / beam.length for fibre in fibres]
    depths = [NARROW if width is None else 0.5 * wide * width / beam.length for width in widths]
    if all(fibre is None for fibre in fibres):
        return Drawn(spans=_spans(beam, halves, depths), said="the section has no sizes and is drawn as a strip")
    said = f"thickness drawn {times(thick)}" if thick > 1.01 else "thickness as it is"
    if None in fibres:
        said += ", of a section without sizes as a strip"
    if abs(wide - 1.0) > 0.01:
        said += f", width {times(wide)}"
    return Drawn(spans=_spans(beam, halves, depths), said=said)


def _enlarged(halves: list[float], least: float, most: float) -> float:
    """By what all are drawn larger, so that the least can be seen and the largest leaves room for the rest."""
    if not halves:
        return 1.0
    return min(max(1.0, least / min(halves)), most / max(halves))


def _widths(beam: Beam) -> list[float | None]:
    """Of each piece, metres; of a round one its diameter; None where it has no sizes."""
    sizes = [merged(section, beam) for section in beam.section] or [beam]
    return [one.width if one.shape in (None, "rectangle") else one.diameter for one in sizes]


def _spans(beam: Beam, halves: Sequence[float], depths: Sequence[float]) -> tuple[Span, ...]:
    """Stretches that differ, from left to right."""
    ends = np.cumsum([piece.length for piece in beam.pieces]) / beam.length
    ends[-1] = 1.0
    spans: list[Span] = []
    for end, half, depth in zip(ends.tolist(), halves, depths, strict=True):
        start = spans[-1].end if spans else 0.0
        if spans and (spans[-1].half, spans[-1].depth) == (half, depth):
            start = spans.pop().start
        spans.append(Span(start=start, end=end, half=half, depth=depth))
    return tuple(spans)


def times(factor: float) -> str:
    """'5,800 times as large': two digits, or three from 1.0 to 9.99."""
    if 1e-2 <= factor < 10.0:
        return f"{factor:.3g} times as large"
    power = int(np.floor(np.log10(factor))) - 1
    rounded = round(factor / 10.0**power) * 10.0**power
    return f"{rounded:,.0f} times as large" if rounded < 1e7 else f"{factor:.1e} times as large"
