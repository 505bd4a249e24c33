"""The compiled surface: modes and drive in time, polynomials on the slider's piece, and what a point on it sees."""

import numpy as np

from verify.arrays import Array
from verify.jit import FAST, inline
from verify.motion import records as rec
from verify.motion.records import Drive, Here, Law


@inline(fastmath=FAST)
def rotate_half(modes: Array) -> None:
    """Advance every free mode by half a step."""
    for j in range(modes.shape[1]):
        real = modes[rec.Z_RE, j] * modes[rec.HALF_RE, j] - modes[rec.Z_IM, j] * modes[rec.HALF_IM, j]
        modes[rec.Z_IM, j] = modes[rec.Z_RE, j] * modes[rec.HALF_IM, j] + modes[rec.Z_IM, j] * modes[rec.HALF_RE, j]
        modes[rec.Z_RE, j] = real


@inline(fastmath=FAST)
def set_factors(time: float, modes: Array, drive: Drive, factors: Array) -> None:
    """Time factors of all rows and their rates: modes first, then (t/ramp)^d (cos, -sin) of the drive."""
    n = modes.shape[1]
    for j in range(n):
        factors[rec.STILL, j] = modes[rec.Z_RE, j]
        factors[rec.MOVING, j] = -modes[rec.SIGMA, j] * modes[rec.Z_RE, j] - modes[rec.OMEGA, j] * modes[rec.Z_IM, j]
    omega, unit = drive.omega, drive.unit
    angle = omega * (drive.origin + time)
    c, s = np.cos(angle), np.sin(angle)
    power, growth = 1.0, 0.0
    for d in range((factors.shape[1] - n) // 2):
        j = n + 2 * d
        factors[rec.STILL, j], factors[rec.STILL, j + 1] = power * c, -power * s
        factors[rec.MOVING, j] = growth * c - power * omega * s
        factors[rec.MOVING, j + 1] = -growth * s - power * omega * c
        growth = (d + 1) * power / unit
        power = power * time / unit


@inline(fastmath=FAST)
def set_local(table: Array, piece: int, factors: Array, local: Array) -> None:
    """Polynomials of deflection and velocity on one piece; table is (pieces, degree + 1, rows)."""
    for d in range(table.shape[1]):
        still, moving = 0.0, 0.0
        for j in range(table.shape[2]):
            still += table[piece, d, j] * factors[rec.STILL, j]
            moving += table[piece, d, j] * factors[rec.MOVING, j]
        local[rec.STILL, d], local[rec.MOVING, d] = still, moving


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


@inline
def climb(local: Array, edges: Array, piece: int, x: float, along: float, half: float) -> float:
    """Speed across the beam of a point on the surface over x that moves along x: dw/dt + w' dX/dt at its material."""
    length = edges[piece + 1] - edges[piece]
    at = material(local, edges, piece, x, half)
    value, slope, bend, rise, turn = 0.0, 0.0, 0.0, 0.0, 0.0
    for d in range(local.shape[1] - 1, -1, -1):
        bend = bend * at + slope
        slope = slope * at + value
        value = value * at + local[rec.STILL, d]
        turn = turn * at + rise
        rise = rise * at + local[rec.MOVING, d]
    bend = 2.0 * bend / (length * length)
    return float(rise + slope / length * (along + half * (turn / length + bend * along)))


@inline
def carried(local: Array, edges: Array, here: Here, half: float) -> float:
    """How far the whole motion moves the surface in a step, along the tangent here, metres."""
    at, slope, piece = here.at, here.slope, here.piece
    value, first = 0.0, 0.0
    for d in range(local.shape[1] - 1, -1, -1):
        first = first * at + value
        value = value * at + local[rec.STILL, d] - local[rec.BEFORE, d]
    return float((slope * value - half * first / (edges[piece + 1] - edges[piece])) / np.sqrt(1.0 + slope * slope))


@inline
def climbed(local: Array, edges: Array, here: Here, half: float) -> float:
    """How far the whole motion lifts in a step what stands on the surface here, metres."""
    value, over, turn = 0.0, 0.0, 0.0
    for d in range(local.shape[1] - 1, -1, -1):
        change = local[rec.STILL, d] - local[rec.BEFORE, d]
        value = value * here.at + change
        turn = turn * here.above + over
        over = over * here.above + change
    return float(value + here.slope * half * turn / (edges[here.piece + 1] - edges[here.piece]))
