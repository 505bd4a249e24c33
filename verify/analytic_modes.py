"""Exact Euler-Bernoulli modes of a uniform beam with any pair of supports, free of overflow at any mode."""

from math import pi, sqrt

import numpy as np

from verify.beam import Beam
from verify.closed_forms import frequency_hz, root_parts
from verify.errors import InputError
from verify.modes import Array, Modes

_MIRRORED = {("pinned", "clamped"), ("pinned", "free"), ("free", "clamped"), ("guided", "clamped"),
             ("guided", "free"), ("pinned", "guided")}  # fmt: skip


def solve_modes(beam: Beam, n_modes: int) -> Modes:
    """The first `n_modes` exact elastic modes.

    Roots in the exponential form y = (n + c) pi + s g atan(exp(-2 y / g)), shapes with decaying exponentials
    from both ends. Raises InputError for n_modes < 1.
    """
    if n_modes < 1:
        raise InputError(f"n_modes = {n_modes!r}: ask for at least one mode")
    frequencies = np.array([frequency_hz(beam, n) for n in range(1, n_modes + 1)])

    def shapes(x: Array, derivative: int) -> Array:
        return np.array([mode_shape(beam, n, x, derivative) for n in range(1, n_modes + 1)])

    empty = np.empty(0)
    return Modes(model="analytic", count=None, length=beam.length, frequencies_hz=frequencies, shapes=shapes,
                 nodes=empty, points=empty, sampled=lambda: np.empty((n_modes, 0)))  # fmt: skip


def mode_shape(beam: Beam, mode: int, x: Array, derivative: int = 0) -> Array:
    """Mass-normalised shape of one exact mode or its derivative (0 to 3), (len(x),), SI.

    x in metres. Positive where the beam first moves off its left end. Raises InputError.
    """
    xi = np.asarray(x, dtype=float) / beam.length
    left, right = beam.supports
    if (left, right) in _MIRRORED:
        sign = _mirror_sign(beam.supports, mode) * (-1.0) ** derivative
        values = sign * _unit_shape((right, left), mode, 1.0 - xi, xi, derivative)
    else:
        values = _unit_shape((left, right), mode, xi, 1.0 - xi, derivative)
    return np.asarray(values / sqrt(beam.mass_per_length * beam.length) / beam.length**derivative)


def _mirror_sign(supports: tuple[str, str], mode: int) -> float:
    """+1 or -1, so that a mirrored shape is positive where it first moves off its left end."""
    near = np.array([1e-3 / mode])
    return float(np.sign(_unit_shape((supports[1], supports[0]), mode, 1.0 - near, near, 0)[0]))


def _quarter_turns(turns: float, remainder: float, xi: Array) -> tuple[Array, Array]:
    """Cos and sin of ((n + c) pi + remainder) xi, the large part reduced exactly (two-product, fmod 2)."""
    high = turns * xi
    low = _product_error(turns, xi, high)
    reduced = np.fmod(high, 2.0)
    nearest = np.round(2.0 * reduced)
    angle = (reduced - nearest / 2.0 + low) * pi + remainder * xi
    cos, sin = np.cos(angle), np.sin(angle)
    quarter = nearest.astype(int) % 4
    table_c = np.choose(quarter, [cos, -sin, -cos, sin])
    table_s = np.choose(quarter, [sin, cos, -sin, -cos])
    return table_c, table_s


def _product_error(a: float, b: Array, product: Array) -> Array:
    """A b - fl(a b) exactly (Dekker's two-product with Veltkamp splitting)."""
    split = 134217729.0
    a_high = a * split - (a * split - a)
    b_high = b * split - (b * split - b)
    a_low, b_low = a - a_high, b - b_high
    return np.asarray(((a_high * b_high - product) + a_high * b_low + a_low * b_high) + a_low * b_low)


def _unit_shape(supports: tuple[str, str], mode: int, xi: Array, eta: Array, derivative: int) -> Array:
    """Shape over xi = x / L with integral of phi^2 over the unit length 1; eta = 1 - xi. (len(xi),)."""
    turns, remainder = root_parts(supports, mode)
    y = turns * pi + remainder
    cos, sin = _quarter_turns(turns, remainder, xi)
    c, s, a, b = _coefficients(supports, y, turns, remainder)
    # derivative k of c cos + s sin + a e^{-y xi} + b e^{-y eta}, each divided by y^k
    waves = [c * cos + s * sin, s * cos - c * sin, -c * cos - s * sin, c * sin - s * cos][derivative]
    decay = a * (-1.0) ** derivative * np.exp(-y * xi) + b * np.exp(-y * eta)
    return np.asarray((waves + decay) * y**derivative)


def _coefficients(
    supports: tuple[str, str], y: float, turns: float, remainder: float
) -> tuple[float, float, float, float]:
    """(c, s, a, b) of c cos + s sin + a e^{-y xi} + b e^{-y (1 - xi)}, integral of the square over [0, 1] = 1."""
    pair = set(supports)
    if pair <= {"pinned", "guided"}:
        wave = sqrt(2.0)
        return (0.0, wave, 0.0, 0.0) if supports[0] == "pinned" else (wave, 0.0, 0.0, 0.0)
    cos, sin = (float(part[0]) for part in _quarter_turns(turns, remainder, np.array([1.0])))
    tail = np.exp(-y)
    if supports[1] == supports[0]:
        b = (cos - sin - tail) / (1.0 - tail * tail - 2.0 * tail * sin)
    elif pair == {"clamped", "free"}:
        b = (tail + cos + sin) / (1.0 + tail * tail + 2.0 * tail * cos)
    elif supports[1] == "pinned":
        b = -tail / (1.0 - tail * tail)
    else:
        b = tail / (1.0 + tail * tail)
    sigma, a = 1.0 - 2.0 * b * tail, 1.0 - b * tail
    side = -1.0 if supports[0] == "clamped" else 1.0
    return side, -side * sigma, float(a), float(b)
