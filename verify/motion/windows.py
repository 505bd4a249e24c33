"""The beam's pieces around a slider: read where it comes, wider the farther it goes, and kept for when it is back."""

from collections.abc import Callable

import msgspec
import numpy as np

from verify.models.arrays import Array
from verify.motion.surface import Stage

REACH = 1
"""Pieces kept ready on each side of those that the slider is among."""
WIDEST = 32
"""Pieces that are read for a slider at once. In rows of 400 exact modes they cost four times as much as three."""
MOST_BYTES = 2**27
"""Of windows that are kept: all of a uniform beam in 400 exact modes, 100 MB."""
READ_S, VALUE_S = 1e-3, 2.5e-7
"""Of every derivative in a window, and of every coefficient; those of an exact beam of sections cost most."""
Window = tuple[Array, Array]
"""Polynomials of some pieces, (pieces, degree + 1, rows), and their edges, metres."""


def table_seconds(table: Array) -> float:
    """An estimate from above of the time that reading such a table takes, (pieces, degree + 1, rows)."""
    return float(READ_S * table.shape[1] + VALUE_S * table.size)


def on_beam(stage: Stage, start: float, travelled: float) -> bool:
    """Whether start + travelled lies on the beam, judged as the loop does, in distances from the start."""
    return bool(stage.edges[0] - start <= travelled <= stage.edges[-1] - start)


class Windows(msgspec.Struct, eq=False):
    """Those of one stage, for a slider that was put on at `start`, metres."""

    stage: Stage
    start: float
    heard: Callable[[Array], None]
    """Hears each table that is read."""
    size: int = 1
    """Pieces that the next is to span: twice those of the one before."""
    kept: dict[tuple[int, int], Window] = msgspec.field(default_factory=dict)

    def around(self, travelled: float) -> Window | None:
        """The polynomials around start + travelled, their edges counted from start; None off the beam."""
        if not on_beam(self.stage, self.start, travelled):
            return None
        edges = self.stage.edges - self.start
        pieces = len(edges) - 1
        here = int(np.clip(np.searchsorted(edges, travelled, side="right") - 1, 0, pieces - 1))
        first = here // self.size * self.size
        span = max(first - REACH, 0), min(first + self.size + REACH, pieces)
        self.size = min(2 * self.size, WIDEST)
        if span not in self.kept:
            self._keep(span, edges)
        return self.kept[span]

    def _keep(self, span: tuple[int, int], edges: Array) -> None:
        """Read a window; what is kept is let go where it would grow too large with it."""
        table = self.stage.table(*span)
        self.heard(table)
        if sum(one.nbytes for one, _ in self.kept.values()) + table.nbytes > MOST_BYTES:
            self.kept.clear()
        self.kept[span] = table, edges[span[0] : span[1] + 1]
