"""Exact frequencies and mode shapes of uniform beams in closed form.

Roots of the Euler-Bernoulli frequency equations and mode shapes for every pair of supports, waves by Timoshenko's
theory, and the frequencies of a rod in extension and torsion.
"""

from collections.abc import Callable, Sequence
from math import atan, exp, pi, sqrt

import numpy as np

from verify.arrays import Array
from verify.exact.layout import HELD
from verify.exact.torsion import torsion_constant
from verify.problem.beam import Beam, check_features
from verify.problem.cross_section import Piece
from verify.validation import check_integer

HIGHEST = 10**9  # Highest mode number
# beta L = (n + c) pi + s(n) g atan(exp(-2 y/g)), the exponential form of cos y cosh y = +-1 and its kin.
# pair -> (c, sign rule, g); the sign rule is 0, a constant, or "odd" for +1 at odd n and -1 at even n.
_ROOTS: dict[frozenset[str], tuple[float, int | str, int]] = {
    frozenset({"pinned"}): (0.0, 0, 1),
    frozenset({"guided"}): (0.0, 0, 1),
    frozenset({"guided", "pinned"}): (-0.5, 0, 1),
    frozenset({"clamped"}): (0.5, "odd", 2),
    frozenset({"free"}): (0.5, "odd", 2),
    frozenset({"clamped", "free"}): (-0.5, "odd", 2),
    frozenset({"clamped", "pinned"}): (0.25, -1, 1),
    frozenset({"free", "pinned"}): (0.25, -1, 1),
    frozenset({"clamped", "guided"}): (-0.25, 1, 1),
    frozenset({"guided", "free"}): (-0.25, 1, 1),
}


def check_mode(mode: int) -> None:
    """Raise InputError unless `mode` is an integer from 1 to `HIGHEST`."""
    check_integer("mode", mode, 1, HIGHEST)


def check_uniform(beam: Beam) -> None:
    """Raise InputError for a stepped beam and for attachments."""
    check_features(beam, "a closed form", remedy="use the analytic, fem or segment model")


def wavenumber_length(supports: Sequence[str], mode: int) -> float:
    """beta_n L, dimensionless: (n + c) pi and a remainder by fixed-point iteration. Raises InputError for mode < 1."""
    check_mode(mode)
    c, rule, g = _ROOTS[frozenset(supports)]
    sign = (1 if mode % 2 else -1) if rule == "odd" else int(rule)
    whole, remainder = (mode + c) * pi, 0.0
    for _ in range(40):
        following = sign * g * atan(exp(-2.0 * (whole + remainder) / g))
        if following == remainder:
            break
        remainder = following
    return whole + remainder


def unit_shapes(supports: Sequence[str], betas: Array) -> Callable[[Array, int], Array]:
    """Euler-Bernoulli shapes at beta L (n,): (xi (m,), derivative by x / L) -> (n, m), mean square 1 over the length.

    Each is a sum of cos, sin, exp(-beta xi) and exp(-beta (1 - xi)), positive next to the left end.
    """

    def waves(factors: Array, xi: Array, derivative: int) -> Array:  # derivative over beta^derivative
        phase = betas[:, None] * xi + 0.5 * pi * (derivative % 4)
        c, s, left, right = factors.T[:, :, None]
        oscillating = c * np.cos(phase) + s * np.sin(phase)
        left = -left if derivative % 2 else left
        return np.asarray(oscillating + left * np.exp(-betas[:, None] * xi) + right * np.exp(betas[:, None] * (xi - 1)))

    unit, ends = np.eye(4)[:, None].repeat(len(betas), axis=1), np.array([0.0, 1.0])
    values = np.array([[waves(wave, ends, d) for wave in unit] for d in range(4)])  # (derivative, wave, n, end)
    conditions = [values[d, :, :, end] for end, support in enumerate(supports) for d in HELD[support]]
    factors = np.linalg.svd(np.array(conditions).transpose(2, 0, 1))[2][:, -1]  # the null vectors
    start, end = np.einsum("dwne,nw->edn", values, factors)
    # 4 k^4 times the integral of y^2 is the change of x (k^4 y^2 - 2 y' y''' + y''^2) for y'''' = k^4 y
    factors /= 0.5 * np.sqrt(end[0] ** 2 - 2.0 * end[1] * end[3] + end[2] ** 2)[:, None]
    factors *= np.sign(start[min({0, 1, 2} - set(HELD[supports[0]]))])[:, None]
    return lambda xi, derivative: waves(factors, xi, derivative) * betas[:, None] ** derivative


def frequency_hz(beam: Beam, mode: int) -> float:
    """The exact frequency of one mode of a uniform beam by Euler-Bernoulli theory, Hz. Raises InputError."""
    check_uniform(beam)
    beta = wavenumber_length(beam.supports, mode) / beam.length
    return beta * beta * beam.wave_constant / (2.0 * pi)


def theory_ratio(piece: Piece, wavenumber: float) -> float:
    """Frequency of a wave (1/m) by Timoshenko's theory (Phil. Mag. 41, 1921) over that by Euler-Bernoulli's.

    With a = k^2 I/A and s = k^2 EI / (kappa G A) it is the root of the lower root of
    a s Lambda^2 - (1 + a + s) Lambda + 1 = 0, Lambda = omega^2 / omega_EB^2.
    """
    square = wavenumber * wavenumber
    a = square * (piece.rotary_inertia or 0.0) / piece.mass_per_length
    s = square * piece.bending_stiffness / piece.shear_stiffness if piece.shear_stiffness else 0.0
    return sqrt(2.0 / (1.0 + a + s + sqrt((1.0 + a + s) ** 2 - 4.0 * a * s)))


def rod_frequency_hz(beam: Beam, mode: int, motion: str, fixed: tuple[bool, bool]) -> float:
    """The frequency of a uniform rod in 'extension' or 'torsion', Hz; `fixed`: its left and right end.

    c / 2L times the mode, less a half with one fixed end, with c = sqrt(E/rho) or sqrt(G J / (rho I_p)). Raises
    InputError for a section that is not defined by shape, sizes and material.
    """
    check_uniform(beam)
    section = beam.base_section
    speed = sqrt(section.axial_stiffness / section.mass_per_length)
    if motion == "torsion":
        ratio = 1.0
        if beam.width and beam.thickness:
            polar = beam.width * beam.thickness * (beam.width**2 + beam.thickness**2) / 12.0
            ratio = torsion_constant("rectangle", beam.width, beam.thickness) / polar
        speed *= sqrt(ratio / (2.0 * (1.0 + beam.poissons_ratio)))
    return (mode - 0.5 * (fixed[0] != fixed[1])) * speed / (2.0 * beam.length)
