"""The compiled surface: modes and drive in time, polynomials on the slider's piece, and what a point on it sees."""

import numpy as np

from verify.arrays import Array
from verify.jit import inline
from verify.motion import records as rec
from verify.motion.records import Law


@inline
def find_piece(edges: Array, x: float, piece: int) -> int:
    """The piece that holds x, from the one that did; -1 off the pieces."""
    while piece >= 0 and x < edges[piece]:
        piece -= 1
    if piece < 0:
        return -1
    while piece < len(edges) - 1 and x > edges[piece + 1]:
        piece += 1
    return piece if piece < len(edges) - 1 else -1


@inline(forceinline=True)
def material(local: Array, edges: Array, piece: int, x: float, half: float) -> float:
    """The local coordinate of the material point under x: X = x + (h/2) w'."""
    length = edges[piece + 1] - edges[piece]
    xi = (x - edges[piece]) / length
    value, first = 0.0, 0.0
    for d in range(local.shape[1] - 1, 0, -1):
        value = value * xi + local[rec.STILL, d]
        first = first * xi + value
    return float(xi + half * first / (length * length))


@inline(forceinline=True)
def touch(local: Array, edges: Array, piece: int, x: float, speed: float, law: Law, seen: Array, row: int) -> None:
    """The surface under x: tangential velocity of its material, and what a slider that follows it feels.

    The material point over x stands at X = x + (h/2) w'(X) of the mid-line and moves with (-(h/2) dw'/dt, dw/dt).
    """
    length = edges[piece + 1] - edges[piece]
    at = material(local, edges, piece, x, law.half)
    deflection, slope, bend, rise, turn = 0.0, 0.0, 0.0, 0.0, 0.0
    for d in range(local.shape[1] - 1, -1, -1):  # Horner for values and derivatives together
        bend = bend * at + slope
        slope = slope * at + deflection
        deflection = deflection * at + local[rec.STILL, d]
        turn = turn * at + rise
        rise = rise * at + local[rec.MOVING, d]
    slope, turn = slope / length, turn / length
    seen[row, rec.SURFACE] = (rise * slope - law.half * turn) / np.sqrt(1.0 + slope * slope)
    seen[row, rec.PULL], seen[row, rec.DRIFT], seen[row, rec.LEVEL] = 0.0, 0.0, deflection
    if law.following:
        seen[row, rec.PULL] = rise * (turn + 2.0 * bend / (length * length) * speed) - law.gravity * slope
        seen[row, rec.DRIFT] = -slope * rise


@inline
def between(ends: Array, edges: Array, piece: int, x: float) -> float:
    """What changes evenly along a piece, at x; `ends` are its values at all edges."""
    share = (x - edges[piece]) / (edges[piece + 1] - edges[piece])
    return float((1.0 - share) * ends[piece] + share * ends[piece + 1])
