"""Exact modes: uniform Euler-Bernoulli beams in closed form, free of overflow at any mode; all others by transfer."""

from collections.abc import Iterable, Sequence
from functools import lru_cache
from math import exp, pi, sqrt

import numpy as np

from verify.arrays import Array
from verify.checks import check_whole, check_word
from verify.exact.buckling import check_stable
from verify.exact.closed_forms import check_mode, frequency_hz, root_parts
from verify.exact.roots import general_frequency_hz
from verify.linear.modes import Modes
from verify.linear.places import Numbers, as_typed, places
from verify.linear.sweeps import swept_modes
from verify.linear.theory import check_theory
from verify.options import THEORIES
from verify.problem.beam import Beam

MOST_MODES = 100_000
_MIRRORED = {
    ("pinned", "clamped"),
    ("pinned", "free"),
    ("free", "clamped"),
    ("guided", "clamped"),
    ("guided", "free"),
    ("pinned", "guided"),
}


@as_typed
def solve_modes(beam: Beam, n_modes: int, theory: str = "euler-bernoulli") -> Modes:
    """The first `n_modes` exact elastic modes by a beam theory.

    Of uniform Euler-Bernoulli beams roots in the exponential form y = (n + c) pi + s g atan(exp(-2 y / g)), shapes with
    decaying exponentials from both ends; of all others as `exact_frequency_hz` and `exact.shapes`. Raises InputError
    for n_modes < 1 or beyond `MOST_MODES`, an unknown theory, what a theory lacks, and
    compression beyond buckling.
    """
    check_n_modes(n_modes, theory)
    plain = theory == "euler-bernoulli" and beam.uniform
    solve = frequency_hz if plain else exact_frequency_hz
    frequencies = np.array([solve(beam, n, theory) for n in range(1, n_modes + 1)])

    def shapes(x: Array, derivative: int) -> Array:
        return mode_shapes(beam, n_modes, x, derivative, theory)

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
        method="closed form" if plain or has_closed_form(beam, n_modes, theory) else "counted",
    )


def check_n_modes(n_modes: int, theory: str) -> None:
    """Raise InputError for no modes, more than `MOST_MODES`, or an unknown theory."""
    check_whole("n_modes", n_modes, 1, MOST_MODES)
    check_word("theory", theory, THEORIES)


@as_typed
def sweep_modes(beams: Iterable[Beam], n_modes: int, theory: str = "euler-bernoulli") -> Array:
    """Exact frequencies of the first modes of many beams, (n_beams, n_modes) in Hz, as `solve_modes` has them.

    Raises InputError as `solve_modes` does, naming the beam by its index.
    """
    numbers = range(1, n_modes + 1)
    return swept_modes(beams, n_modes, lambda beam: np.array([exact_frequency_hz(beam, n, theory) for n in numbers]))


@as_typed
def mode_shape(beam: Beam, mode: int, x: Numbers, derivative: int = 0, theory: str = "euler-bernoulli") -> Array:
    """Mass-normalised shape of one exact mode or a derivative of any order at x, SI; a number x is a row of one.

    x in metres. Positive where the beam first moves off its left end. Of everything that has mass: point masses and
    rotary inertia too. By Timoshenko's theory the deflection, and the slope of its line, not the section's turn.
    Raises InputError.
    """
    check_mode(mode)
    return np.asarray(_shapes(beam, (mode,), x, derivative, theory)[0])


@as_typed
def mode_shapes(beam: Beam, n_modes: int, x: Numbers, derivative: int = 0, theory: str = "euler-bernoulli") -> Array:
    """The same of the first `n_modes` modes, (n_modes, *shape of x). Raises InputError likewise."""
    check_n_modes(n_modes, theory)
    return _shapes(beam, range(1, n_modes + 1), x, derivative, theory)


def _shapes(beam: Beam, modes: Sequence[int], x: Numbers, derivative: int, theory: str) -> Array:
    at = np.atleast_1d(places("x", x, beam.length))
    check_whole("derivative", derivative, 0)
    check_word("theory", theory, THEORIES)
    if theory != "euler-bernoulli" or not beam.uniform:
        return _general(beam, modes, at.ravel(), derivative, theory).reshape(len(modes), *at.shape)
    xi = at.ravel() / beam.length
    left, right = beam.supports
    if (left, right) in _MIRRORED:
        signs = np.array([_mirror_sign(beam.supports, mode) for mode in modes]) * (-1.0) ** derivative
        values = signs[:, None] * _unit_shapes((right, left), modes, 1.0 - xi, xi, derivative)
    else:
        values = _unit_shapes((left, right), modes, xi, 1.0 - xi, derivative)
    found = values / sqrt(beam.mass_per_length * beam.length) / beam.length**derivative
    return found.reshape(len(modes), *at.shape)


def _general(beam: Beam, modes: Sequence[int], x: Array, derivative: int, theory: str) -> Array:
    """Shapes without closed form."""
    from verify.exact.shapes import general_shapes

    check_theory(beam, theory)
    check_stable(beam)
    return general_shapes(beam, modes, x, derivative, theory)


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
    waves = turned[derivative % 2] * (1.0 if derivative % 4 < 2 else -1.0)
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


@as_typed
def exact_frequency_hz(beam: Beam, mode: int, theory: str = "euler-bernoulli") -> float:
    """The exact frequency of one elastic mode of any beam by a beam theory, Hz, to rounding.

    In closed form where there is one; else the root of one characteristic equation (`exact.minors`), which frequencies
    are counted by, so that none is missed. Modes rank by frequency: above its cut-off sqrt(kappa G A / rho I) a
    Timoshenko beam has a second family among them. Raises InputError, also for compression beyond buckling.
    """
    check_word("theory", theory, THEORIES)
    if theory == "euler-bernoulli" and beam.uniform:
        return frequency_hz(beam, mode)
    check_mode(mode)
    if has_closed_form(beam, mode, theory):
        return frequency_hz(beam, mode, theory)
    check_theory(beam, theory)
    check_stable(beam)
    return general_frequency_hz(beam, mode, theory)


def has_closed_form(beam: Beam, mode: int, theory: str) -> bool:
    """Whether a mode has a frequency in closed form."""
    if theory == "euler-bernoulli" or theory not in THEORIES or not beam.uniform:
        return beam.uniform
    if beam.supports != ("pinned", "pinned"):
        return False
    shear, turning = beam.own.shear_stiffness, beam.own.rotary_inertia
    if theory == "rayleigh" or shear is None or turning is None:
        return True
    return 2.0 * pi * frequency_hz(beam, mode, theory) < sqrt(shear / turning)


@as_typed
def stepped_frequency_hz(beam: Beam, mode: int) -> float:
    """The exact frequency of one elastic mode of a beam of any number of sections, Hz; as `exact_frequency_hz`."""
    check_mode(mode)
    check_stable(beam)
    return general_frequency_hz(beam, mode)
