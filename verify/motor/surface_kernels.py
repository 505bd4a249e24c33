"""The compiled surface under a point: its polynomials on a piece of the beam, its material there."""

import numpy as np

from verify.jit import FAST, inline
from verify.models.arrays import Array
from verify.motion.records import MOVING, STILL
from verify.motor.records import Line


@inline(fastmath=FAST)
def draw(table: Array, piece: int, line: Line) -> None:
    """Polynomials of deflection and velocity on one piece, by the factors of the rows."""
    factors, local = line.factors, line.local
    for d in range(table.shape[1]):
        still, moving = 0.0, 0.0
        for j in range(table.shape[2]):
            still += table[piece, d, j] * factors[STILL, j]
            moving += table[piece, d, j] * factors[MOVING, j]
        local[piece, STILL, d], local[piece, MOVING, d] = still, moving


@inline
def material(
    piece: int, xi: float, length: float, lever: float, line: Line
) -> tuple[float, float, float, float, float, float, float]:
    """What stands over xi = 0 to 1 of a piece: (its own xi, w, w', w'', dw/dt, dw'/dt, its speed along the tangent).

    The material over x stands at X = x + lever w'(X) of the mid-line and moves with (-lever dw'/dt, dw/dt); `lever` is
    h/2 on the upper face, metres. All are of the mid-line at X, by metres and seconds.
    """
    local = line.local
    value, first = 0.0, 0.0
    for d in range(local.shape[2] - 1, 0, -1):
        value = value * xi + local[piece, STILL, d]
        first = first * xi + value
    at = xi + lever * first / (length * length)
    level, slope, bend, rise, turn = 0.0, 0.0, 0.0, 0.0, 0.0
    for d in range(local.shape[2] - 1, -1, -1):
        bend = bend * at + slope
        slope = slope * at + level
        level = level * at + local[piece, STILL, d]
        turn = turn * at + rise
        rise = rise * at + local[piece, MOVING, d]
    slope, bend, turn = slope / length, 2.0 * bend / (length * length), turn / length
    return at, level, slope, bend, rise, turn, (rise * slope - lever * turn) / np.sqrt(1.0 + slope * slope)
