"""Two beams above each other, segments over elements, as every picture of a scene's own beam has them."""

import msgspec
import numpy as np

from verify.beam import Beam
from verify.errors import InputError
from verify.models.arrays import Array
from verify.pictures.parts import attached_parts, bar_solids, chain_solids, support_solids
from verify.pictures.picture import Label, Picture, Solid, Trace
from verify.pictures.sizes import drawn_section, times
from verify.scenes.scene import Scene
from verify.units import in_words

CHAIN, ELEMENTS = "segment", "fem"
COUNT, MOST = 49, 400
"""Segments where nobody says; and at most, beyond which none is seen."""
AMPLITUDE, STEEPEST = 0.055, 1.6
"""The largest deflection drawn, over the length, unless a slope is drawn steeper than that."""
ROOM, LETTERS = 0.052, 0.034
"""Between what the upper beam and the lower one reach, half of it; and for the words above each, over the length."""
FINE, IN_A_WAVE = 481, 32
"""Points of what is smooth: at least, and in a wave."""
FORCE = 0.07
"""The longest arrow, over the length."""


class Asked(msgspec.Struct, frozen=True, kw_only=True):
    """What is drawn."""

    what: str
    mode: int | None = None
    count: int | None = None
    moving: bool = False
    """Whether a file takes more than one frame."""


class Stage(msgspec.Struct, frozen=True, kw_only=True):
    """How far deflections are drawn, and where the two beams lie above and below the middle, over the length."""

    largest: float
    """The deflection of the highest colour."""
    amplitude: float
    apart: float

    def y(self, row: "Row") -> float:
        """Where a beam lies when it is straight."""
        return self.apart if row.upper else -self.apart

    def line(self, beam: Beam, row: "Row") -> Array:
        """(f, n, 2) in the picture."""
        y = self.y(row) + self.amplitude * row.deflection / self.largest
        return np.stack([np.broadcast_to(row.x / beam.length, y.shape), y], axis=2)


class Row(msgspec.Struct, frozen=True, eq=False, kw_only=True):
    """One beam of a picture."""

    words: str
    upper: bool
    x: Array
    """(n,), metres."""
    deflection: Array
    """(f, n), in the unit of `largest`."""
    links: bool


def count_of(scene: Scene, asked: Asked, section: str) -> int:
    """As asked, else as the scene's own section says."""
    its = getattr(scene, section, None)
    return asked.count or (min(its.count, MOST) if its is not None else COUNT)


def picture_of_rows(
    scene: Scene,
    rows: list[Row],
    *,
    title: str,
    said: str,
    scale: tuple[str, str, str],
    largest: float,
    notes: tuple[str, ...],
    seconds: float,
    more: tuple[Solid, ...] = (),
    exact: Array | None = None,
) -> Picture:
    """Beams above each other, each held, loaded and named; `largest` is the deflection of the highest colour.

    `exact` (f, n), at even places, is a line in front of each.
    """
    drawn, stage = drawn_section(scene.beam), stage_of(scene.beam, rows, largest)
    solids: list[Solid] = []
    traces: list[Trace] = []
    for row in rows:
        line, y = stage.line(scene.beam, row), stage.y(row)
        values = np.clip(row.deflection / largest, -1.0, 1.0)
        solids += (chain_solids if row.links else bar_solids)(row.x / scene.beam.length, line, values, drawn)
        solids += support_solids(scene.beam.supports, y, drawn)
        bodies, springs = attached_parts(scene.beam, row.x, line, y, drawn)
        solids, traces = solids + bodies, traces + springs
        still = np.array([[[0.0, y], [1.0, y]]])
        traces.append(Trace(points=still, colour="#9aa2b1", width=0.8, depth=drawn.depth))
        if exact is not None:
            even = np.linspace(0.0, scene.beam.length, exact.shape[1])
            known = Row(words="", upper=row.upper, x=even, deflection=exact, links=False)
            traces.append(Trace(points=stage.line(scene.beam, known), width=1.2, depth=1.3 * drawn.depth))
    left = _free_place([one.position / scene.beam.length for one in scene.forces] if more else [])
    deepest = 0.11 if scene.beam.spring else FORCE + 0.005
    words = stage.amplitude + drawn.bulge + LETTERS
    return Picture(
        title=title,
        said=(f"{said}; {drawn.said}{_undrawn(scene.beam)}.",),
        notes=notes,
        solids=(*solids, *more),
        traces=tuple(traces),
        labels=tuple(Label(text=row.words, x=left, y=stage.y(row) + words) for row in rows),
        scale=scale,
        frames=len(rows[0].deflection),
        seconds=seconds,
        box=(-0.035, 1.035, -stage.apart - max(stage.amplitude + drawn.bulge, deepest), stage.apart + words + 0.02),
    )


def _undrawn(beam: Beam) -> str:
    """What holds a beam and stands in no picture, in words."""
    there = {"the ground below": beam.foundation, "the axial force": beam.tension}
    names = [name for name, size in there.items() if size]
    return f"; {' and '.join(names)} {'is' if len(names) == 1 else 'are'} not drawn" if names else ""


def _free_place(taken: list[float]) -> float:
    """Where words begin that no arrow stands in."""
    free = (x for x in np.arange(0.01, 0.65, 0.05) if not any(x - 0.02 < at < x + 0.34 for at in taken))
    return float(next(free, 0.0))


def stage_of(beam: Beam, rows: list[Row], largest: float) -> Stage:
    """Lower than AMPLITUDE where that would be too steep to look at, or joints lie farther out than `largest`."""
    smooth = next(row for row in rows if not row.links)
    steep = float(abs(np.gradient(smooth.deflection, smooth.x / beam.length, axis=1)).max()) / largest
    farthest = max(float(abs(row.deflection).max()) for row in rows) / largest
    amplitude = min(AMPLITUDE, STEEPEST / steep) / max(farthest, 1.0)
    return Stage(largest=largest, amplitude=amplitude, apart=amplitude + drawn_section(beam).bulge + ROOM)


def check_moves(largest: float, what: str) -> None:
    """Raise InputError for a beam at rest, of which nothing can be drawn."""
    if not largest > 0.0 or not np.isfinite(largest):
        raise InputError(f"drive: {what} does not move the beam, give it a force")


def exaggerated(beam: Beam, stage: Stage, over: str) -> str:
    """How many times as large deflections are drawn, in words; the largest is that over a period or a run."""
    drawn = times(stage.amplitude * beam.length / stage.largest)
    return f"Deflection drawn {drawn} (the largest {over} is {in_words(stage.largest)})"


def scale_of(largest: float) -> tuple[str, str, str]:
    """Words at the left, in the middle and at the right of a scale of colours: deflections to `largest`, metres."""
    return f"-{in_words(largest)}", "deflection", f"+{in_words(largest)}"
