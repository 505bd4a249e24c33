"""Cubic C2 splines through a value at every node, made by numpy alone.

scipy's CubicSpline is the same curve; its package takes longer to import than a figure takes, and one spline longer to
make than all fields of a sweep.
"""

from functools import lru_cache
from typing import Any, TypeAlias

import msgspec
import numpy as np

from verify.models.arrays import Array

Ends: TypeAlias = tuple[int, int]
"""Which derivative is zero at the left and the right end: 1 or 2; 0 where the last two pieces are one cubic."""
SMALL = 250
"""Nodes up to which the inverse of the slopes' system is kept; beyond, LAPACK solves it as the band it is."""


class Spline(msgspec.Struct, frozen=True, eq=False):
    """k splines over the same nodes, metres."""

    nodes: Array
    """(N + 1,), ascending."""
    powers: Array
    """(4, k, N): on every piece what (x - its left node)^0 to ^3 are multiplied with."""

    def __call__(self, x: Array, derivative: int = 0) -> Array:
        """The splines or a derivative at x, (k, len(x)); a node belongs to the piece on its right."""
        piece = np.clip(self.nodes.searchsorted(x, side="right") - 1, 0, len(self.nodes) - 2)
        t = x - self.nodes[piece]
        a, b, c, d = self.powers[:, :, piece]
        if derivative == 0:
            return np.asarray(a + t * (b + t * (c + t * d)))
        if derivative == 1:
            return np.asarray(b + t * (2.0 * c + t * (3.0 * d)))
        if derivative == 2:
            return np.asarray(2.0 * c + t * (6.0 * d))
        return np.asarray(6.0 * d) if derivative == 3 else np.zeros_like(d)

    @property
    def c(self) -> Array:
        """(4, N, k), from the cube down, as scipy's splines have it."""
        return self.powers[::-1].transpose(0, 2, 1)


def natural_or_flat(nodes: Array, values: Any, ends: Ends) -> Spline:
    """Splines through values (k, N + 1), real or complex, at nodes (N + 1,), at each end as `ends` say.

    Slopes s at the nodes: h_i s_{i-1} + 2 (h_{i-1} + h_i) s_i + h_{i-1} s_{i+1} = 3 (h_i m_{i-1} + h_{i-1} m_i), with
    chords m of pieces h (de Boor, A Practical Guide to Splines, IV). Where the last two pieces are one cubic and there
    is one piece, it is straight there; where there are two and it is so at both ends, they are one parabola.
    """
    pieces = np.diff(nodes)
    chords = np.diff(values) / pieces
    right = np.empty_like(values)
    right[:, 1:-1] = 3.0 * (pieces[1:] * chords[:, :-1] + pieces[:-1] * chords[:, 1:])
    right[:, 0] = _at_end(pieces, chords, ends, ends[0])
    right[:, -1] = _at_end(pieces[::-1], chords[:, ::-1], ends, ends[1])
    slopes = right @ _inverse(pieces.tobytes(), ends).T if len(nodes) <= SMALL else _by_band(pieces, ends, right)
    bend = (slopes[:, :-1] + slopes[:, 1:] - 2.0 * chords) / pieces
    powers = np.array([values[:, :-1], slopes[:, :-1], (chords - slopes[:, :-1]) / pieces - bend, bend / pieces])
    return Spline(nodes, powers)


def _at_end(pieces: Array, chords: Array, ends: Ends, end: int) -> Any:
    """The right side of the slopes' system where these pieces start, (k,)."""
    if end == 1:
        return 0.0
    if end == 2:
        return 3.0 * pieces[0] * chords[:, 0]
    if len(pieces) == 1:
        return chords[:, 0]
    if _is_parabola(pieces, ends):
        return 2.0 * chords[:, 0]
    first, second = pieces[:2]
    both = first + second
    return ((first + 2.0 * both) * second * chords[:, 0] + first**2 * chords[:, 1]) / both


def _end_row(pieces: Array, ends: Ends, end: int) -> tuple[float, float]:
    """What the slopes where these pieces start and beside it are multiplied with there."""
    if end == 1 or (end == 0 and len(pieces) == 1):
        return 1.0, 0.0
    if end == 2:
        return 2.0 * pieces[0], pieces[0]
    return (1.0, 1.0) if _is_parabola(pieces, ends) else (pieces[1], pieces[0] + pieces[1])


def _is_parabola(pieces: Array, ends: Ends) -> bool:
    """Whether two pieces are one cubic by either end, which leaves one of them free."""
    return len(pieces) == 2 and ends == (0, 0)


def _system(pieces: Array, ends: Ends) -> tuple[Array, Array, Array]:
    """(below, on, above) the diagonal of the slopes' system, (N,), (N + 1,), (N,)."""
    on = np.empty(len(pieces) + 1)
    on[1:-1] = 2.0 * (pieces[1:] + pieces[:-1])
    below, above = np.append(pieces[1:], 0.0), np.append(0.0, pieces[:-1])
    on[0], above[0] = _end_row(pieces, ends, ends[0])
    on[-1], below[-1] = _end_row(pieces[::-1], ends, ends[1])
    return below, on, above


@lru_cache(maxsize=16)
def _inverse(pieces: bytes, ends: Ends) -> Array:
    below, on, above = _system(np.frombuffer(pieces), ends)
    return np.asarray(np.linalg.inv(np.diag(on) + np.diag(below, -1) + np.diag(above, 1)), dtype=float)


def _by_band(pieces: Array, ends: Ends, right: Array) -> Array:
    from scipy.linalg.lapack import dgtsv, zgtsv

    below, on, above = _system(pieces, ends)
    return np.asarray((zgtsv if np.iscomplexobj(right) else dgtsv)(below, on, above, right.T)[3].T)
