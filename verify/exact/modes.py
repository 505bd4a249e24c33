"""Exact Euler-Bernoulli modes: uniform beams with any pair of supports, free of overflow at any mode.

For stepped beams the exact frequencies, from the transfer of the end conditions through the sections.
"""

from collections.abc import Sequence
from functools import lru_cache
from math import cos, exp, pi, sin, sqrt

import numpy as np

from verify.beam import Beam
from verify.checks import check_whole
from verify.errors import InputError
from verify.exact.closed_forms import check_mode, check_uniform, frequency_hz, root_parts, wavenumber_length
from verify.exact.harmonic import solve_harmonic, unit_responses
from verify.exact.section_minors import end_minor
from verify.models.arrays import Array
from verify.models.modes import Modes
from verify.models.places import Numbers, as_typed, real_array

__all__ = [
    "exact_frequency_hz",
    "mode_shape",
    "solve_harmonic",
    "solve_modes",
    "stepped_frequency_hz",
    "unit_responses",
]

_MIRRORED = {
    ("pinned", "clamped"),
    ("pinned", "free"),
    ("free", "clamped"),
    ("guided", "clamped"),
    ("guided", "free"),
    ("pinned", "guided"),
}


_LEAST = 1e-9
"""Of beta L: below it a count sees rounding alone."""


@as_typed
def solve_modes(beam: Beam, n_modes: int) -> Modes:
    """The first `n_modes` exact elastic modes.

    Roots in the exponential form y = (n + c) pi + s g atan(exp(-2 y / g)), shapes with decaying exponentials
    from both ends. Raises InputError for n_modes < 1.
    """
    check_whole("n_modes", n_modes, 1)
    frequencies = np.array([frequency_hz(beam, n) for n in range(1, n_modes + 1)])

    def shapes(x: Array, derivative: int) -> Array:
        return mode_shapes(beam, n_modes, x, derivative)

    def nowhere() -> Array:
        return np.empty((n_modes, 0))

    empty = np.empty(0)
    return Modes(
        model="analytic",
        count=None,
        length=beam.length,
        frequencies_hz=frequencies,
        shapes=shapes,
        nodes=empty,
        points=empty,
        sampled=nowhere,
        curvature_points=empty,
        curvatures=nowhere,
    )


def mode_shape(beam: Beam, mode: int, x: Numbers, derivative: int = 0) -> Array:
    """Mass-normalised shape of one exact mode or its derivative (0 to 3), of the shape of x, SI.

    x in metres. Positive where the beam first moves off its left end. Raises InputError.
    """
    return _shapes(beam, (mode,), x, derivative)[0]  # type: ignore[no-any-return]


def mode_shapes(beam: Beam, n_modes: int, x: Numbers, derivative: int = 0) -> Array:
    """The same of the first `n_modes` modes, (n_modes, *shape of x)."""
    return _shapes(beam, range(1, n_modes + 1), x, derivative)


def _shapes(beam: Beam, modes: Sequence[int], x: Numbers, derivative: int) -> Array:
    check_uniform(beam)
    at = real_array("x", x, "metres")
    xi = at.ravel() / beam.length
    left, right = beam.supports
    if (left, right) in _MIRRORED:
        signs = np.array([_mirror_sign(beam.supports, mode) for mode in modes]) * (-1.0) ** derivative
        values = signs[:, None] * _unit_shapes((right, left), modes, 1.0 - xi, xi, derivative)
    else:
        values = _unit_shapes((left, right), modes, xi, 1.0 - xi, derivative)
    found = values / sqrt(beam.mass_per_length * beam.length) / beam.length**derivative
    return found.reshape(len(modes), *at.shape)


@lru_cache(maxsize=20_000)
def _mirror_sign(supports: tuple[str, str], mode: int) -> float:
    """+1 or -1, so that a mirrored shape is positive where it first moves off its left end."""
    near = np.array([1e-3 / mode])
    return float(np.sign(_unit_shapes((supports[1], supports[0]), (mode,), 1.0 - near, near, 0)[0, 0]))


def _quarter_turns(turns: Array, remainder: Array, xi: Array) -> tuple[Array, Array]:
    """Cos and sin of ((n + c) pi + remainder) xi, the large part reduced exactly (two-product, fmod 2)."""
    high = turns * xi
    low = _product_error(turns, xi, high)
    reduced = np.fmod(high, 2.0)
    nearest = np.round(2.0 * reduced)
    angle = (reduced - nearest / 2.0 + low) * pi + remainder * xi
    c, s = np.cos(angle), np.sin(angle)
    quarter = nearest.astype(int) % 4
    return np.choose(quarter, [c, -s, -c, s]), np.choose(quarter, [s, c, -s, -c])


def _product_error(a: Array, b: Array, product: Array) -> Array:
    """A b - fl(a b) exactly (Dekker's two-product with Veltkamp splitting)."""
    split = 134217729.0
    a_high = a * split - (a * split - a)
    b_high = b * split - (b * split - b)
    a_low, b_low = a - a_high, b - b_high
    return np.asarray(((a_high * b_high - product) + a_high * b_low + a_low * b_high) + a_low * b_low)


def _unit_shapes(supports: tuple[str, str], modes: Sequence[int], xi: Array, eta: Array, derivative: int) -> Array:
    """Shapes over xi = x / L with integral of phi^2 over the unit length 1; eta = 1 - xi. (modes, len(xi))."""
    parts = np.array([_parts(supports, mode) for mode in modes])
    turns, remainder, c, s, a, b = parts.T[:, :, None]
    y = turns * pi + remainder
    cosine, sine = _quarter_turns(turns, remainder, xi)
    # derivative k of c cos + s sin + a e^{-y xi} + b e^{-y eta}, each divided by y^k
    turned = [c * cosine + s * sine, s * cosine - c * sine]
    waves = turned[derivative % 2] * (1.0 if derivative < 2 else -1.0)
    decay = a * (-1.0) ** derivative * np.exp(-y * xi) + b * np.exp(-y * eta)
    return np.asarray((waves + decay) * y**derivative)


@lru_cache(maxsize=20_000)
def _parts(supports: tuple[str, str], mode: int) -> tuple[float, ...]:
    """(whole turns and remainder of y, then c, s, a, b) of one mode."""
    turns, remainder = root_parts(supports, mode)
    return turns, remainder, *_coefficients(supports, turns * pi + remainder, turns, remainder)


def _coefficients(
    supports: tuple[str, str], y: float, turns: float, remainder: float
) -> tuple[float, float, float, float]:
    """(c, s, a, b) of c cos + s sin + a e^{-y xi} + b e^{-y (1 - xi)}, integral of the square over [0, 1] = 1."""
    pair = set(supports)
    if pair <= {"pinned", "guided"}:
        wave = sqrt(2.0)
        return (0.0, wave, 0.0, 0.0) if supports[0] == "pinned" else (wave, 0.0, 0.0, 0.0)
    c, s = (float(part[0]) for part in _quarter_turns(np.array([turns]), np.array([remainder]), np.ones(1)))
    tail = exp(-y)
    if supports[1] == supports[0]:
        b = (c - s - tail) / (1.0 - tail * tail - 2.0 * tail * s)
    elif pair == {"clamped", "free"}:
        b = (tail + c + s) / (1.0 + tail * tail + 2.0 * tail * c)
    elif supports[1] == "pinned":
        b = -tail / (1.0 - tail * tail)
    else:
        b = tail / (1.0 + tail * tail)
    sigma, a = 1.0 - 2.0 * b * tail, 1.0 - b * tail
    side = -1.0 if supports[0] == "clamped" else 1.0
    return side, -side * sigma, a, b


def exact_frequency_hz(beam: Beam, mode: int) -> float:
    """The exact Euler-Bernoulli frequency of a uniform or stepped beam, Hz. Raises InputError."""
    return stepped_frequency_hz(beam, mode) if beam.added == ("section",) else frequency_hz(beam, mode)


def stepped_frequency_hz(beam: Beam, mode: int) -> float:
    """The exact frequency of one elastic mode of a beam of any number of sections, Hz, to 1e-14.

    The transfer matrix of each section is rearranged into its dynamic stiffness, which does not overflow, and
    frequencies below a trial value are counted (Wittrick and Williams, Q. J. Mech. Appl. Math. 24, 1971), so
    that none is missed. The count is bisected until it has singled one out; the digits come from the minors of the
    transfer, since a count is blurred by (L / shortest section)^3 eps, which is 1e-5 on beams that somebody might
    build. Raises InputError for mode < 1, and where rounding tells a frequency from its neighbours in no interval.
    """
    check_mode(mode)
    wanted = mode + beam.rigid_motions
    low, high = 0.0, 1.0
    while modes_below(beam, high) < wanted:
        low, high = high, 2.0 * high
    while low < (middle := 0.5 * (low + high)) < high and high > _LEAST:
        if low > 0.0 and (root := _root_near(beam, low, high)) is not None:
            return root * root * beam.wave_constant / (2.0 * pi * beam.length**2)
        low, high = (low, middle) if modes_below(beam, middle) >= wanted else (middle, high)
    raise InputError(
        f"mode = {mode}: rounding does not tell this frequency of a beam of {len(beam.pieces)} sections from its "
        "neighbours, make the shortest section longer"
    )


def _root_near(beam: Beam, low: float, high: float) -> float | None:
    """The root of the frequency equation in or beside an interval of beta L; None where there it is not alone.

    The interval is widened to three times its length: its ends are as blurred as the count that set them.
    """
    stretches = _stretches(beam)
    low, high = max(2.0 * low - high, 0.5 * low), 2.0 * high - low
    above = end_minor(stretches, beam.supports, high) > 0.0
    if modes_below(beam, high) - modes_below(beam, low) != 1 or above == (
        end_minor(stretches, beam.supports, low) > 0.0
    ):
        return None
    while low < (middle := 0.5 * (low + high)) < high:
        same = (end_minor(stretches, beam.supports, middle) > 0.0) == above
        low, high = (low, middle) if same else (middle, high)
    return high


def modes_below(beam: Beam, beta_length: float) -> int:
    """How many frequencies, rigid ones included, lie below omega = beta^2 sqrt(EI / rho A), by beta L.

    Every section counts its own with both ends clamped; the assembled dynamic stiffness adds its negative
    eigenvalues.
    """
    stretches = _stretches(beam)
    stiffness, below = np.zeros((2 * len(stretches) + 2, 2 * len(stretches) + 2)), 0
    for i, (length, bending, mass) in enumerate(stretches):
        beta = beta_length * (mass / bending) ** 0.25
        ends = slice(2 * i, 2 * i + 4)
        stiffness[ends, ends] += bending * _dynamic_stiffness(beta, length)
        below += _clamped_below(beta * length)
    free = [k for k in range(len(stiffness)) if k not in _held(beam, 2 * len(stretches))]
    return below + int((np.linalg.eigvalsh(stiffness[np.ix_(free, free)]) < 0).sum())


def _stretches(beam: Beam) -> list[tuple[float, float, float]]:
    """(length, EI, rho A) of the sections, relative to the beam's."""
    base = beam.bending_stiffness, beam.mass_per_length
    return [(p.length / beam.length, p.bending_stiffness / base[0], p.mass_per_length / base[1]) for p in beam.pieces]


def _held(beam: Beam, right: int) -> set[int]:
    """Which of deflection and slope at both ends the supports hold, as rows of the dynamic stiffness."""
    held = set()
    for first, support in zip((0, right), beam.supports, strict=True):
        held |= {first} if support in ("pinned", "clamped") else set()
        held |= {first + 1} if support in ("clamped", "guided") else set()
    return held


def _clamped_below(y: float) -> int:
    """How many roots of cos y cosh y = 1 lie below y."""
    n = max(int(y / pi - 0.5), 1)
    while n > 0 and wavenumber_length(("clamped", "clamped"), n) >= y:
        n -= 1
    return n + int(wavenumber_length(("clamped", "clamped"), n + 1) < y)


def _dynamic_stiffness(beta: float, length: float) -> Array:
    """Forces and moments at both ends of a section by end deflections and slopes, EI = 1, (4, 4)."""
    y = beta * length
    ww, wt, tt, ww2, wt2, tt2 = _stiffness_functions(y) if y > 1.0 else _stiffness_series(y)
    ww, ww2, wt, wt2, tt, tt2 = ww * beta**3, ww2 * beta**3, wt * beta**2, wt2 * beta**2, tt * beta, tt2 * beta
    return np.array([[ww, wt, ww2, wt2], [wt, tt, -wt2, tt2], [ww2, -wt2, ww, -wt], [wt2, tt2, -wt, tt]])


def _stiffness_functions(y: float) -> tuple[float, ...]:
    """The six functions of y = beta l over 1 - cos y cosh y; both carry the same e^{-y}, so nothing overflows."""
    c, s, tail = cos(y), sin(y), exp(-y)
    ch, sh = 0.5 * (1.0 + tail * tail), 0.5 * (1.0 - tail * tail)
    upper = (s * ch + c * sh, s * sh, s * ch - c * sh, -(sh + s * tail), ch - c * tail, sh - s * tail)
    return tuple(value / (tail - c * ch) for value in upper)


def _stiffness_series(y: float) -> tuple[float, ...]:
    """The same for short sections by their power series, in which nothing cancels.

    With z = (1 + i) y: cos z = cos y cosh y - i sin y sinh y, sin z = sin y cosh y + i cos y sinh y; powers of
    1 + i are whole numbers.
    """
    sums, turn, term = [0.0] * 7, 1 + 0j, 1.0  # term is y^n / n!
    for n in range(40):
        re, im, sign = turn.real, turn.imag, (-1.0) ** (n // 2)
        if n % 2:
            parts = (sign * (re + im), 0.0, sign * (re - im), 0.0)
        else:
            parts = (0.0, -sign * im, 0.0, -sign * re if n else 0.0)
        plain = (-2.0 * (n % 4 == 1), 2.0 * (n % 4 == 2), 2.0 * (n % 4 == 3))
        for i, value in enumerate((*parts, *plain)):
            sums[i] += value * term
        turn, term = turn * (1 + 1j), term * y / (n + 1)
    return tuple(sums[i] / sums[3] for i in (0, 1, 2, 4, 5, 6))
