"""Exact frequencies of uniform beams in closed form, in plain floating point.

Roots of the Euler-Bernoulli frequency equations for every pair of supports, and the frequencies of a
pinned-pinned beam by Rayleigh's and Timoshenko's theories beside them (model form).
"""

from math import atan, exp, pi, sqrt

from verify.checks import check_whole, check_word
from verify.errors import InputError
from verify.options import THEORIES
from verify.problem.beam import Beam

HIGHEST = 10**9
"""Mode of which there is a frequency."""
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
    """Raise InputError unless `mode` counts from 1, and not beyond what formulas hold."""
    check_whole("mode", mode, 1, HIGHEST)


def check_uniform(beam: Beam) -> None:
    """Raise InputError where the beam is stepped or something stands on it, naming the models that can."""
    if beam.stepped:
        raise InputError(
            f"beam.section: a beam of {len(beam.pieces)} sections has no closed form here, use the analytic, fem or "
            "segment model"
        )
    if beam.added:
        raise InputError(
            f"beam.{beam.added[0]}: a beam with it has no closed form here, use the analytic, fem or "
            "segment model, or none of it"
        )


def wavenumber_length(supports: tuple[str, str], mode: int) -> float:
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


def frequency_hz(beam: Beam, mode: int, theory: str = "euler-bernoulli") -> float:
    """The exact frequency of one mode, Hz, by a beam theory.

    `euler-bernoulli` for all supports; `rayleigh` adds the rotary inertia of the section, `timoshenko` also
    its shear flexibility (Timoshenko, Phil. Mag. 41, 1921), both for pinned-pinned beams. Raises InputError.
    """
    check_word("theory", theory, THEORIES)
    check_uniform(beam)
    beta = wavenumber_length(beam.supports, mode) / beam.length
    omega = beta * beta * beam.wave_constant
    if theory != "euler-bernoulli":
        if beam.supports != ("pinned", "pinned"):
            raise InputError(
                f"theory = {theory!r} has a closed form here for pinned-pinned beams only, "
                f"not {'-'.join(beam.supports)}: use euler-bernoulli, or the analytic model"
            )
        omega *= sqrt(_thickness_factor(beam, beta, theory))
    return omega / (2.0 * pi)


def _thickness_factor(beam: Beam, beta: float, theory: str) -> float:
    """omega^2 over Euler-Bernoulli's, for a sine of wavenumber beta (1/m) on a beam of finite thickness.

    With r^2 = I/A and g = E / (kappa G), Lambda = omega^2 / omega_EB^2 solves
    b^4 g Lambda^2 - (1 + b^2 (1 + g)) Lambda + 1 = 0 for b = beta r; the flexural root is the lower one.
    """
    own = beam.own
    if own.rotary_inertia is None:
        raise InputError(f"beam.rotary_inertia is missing: theory = {theory!r} takes rho I of a section given plainly")
    r2 = own.rotary_inertia / own.mass_per_length
    b2 = beta * beta * r2
    if theory == "rayleigh":
        return 1.0 / (1.0 + b2)
    if own.shear_stiffness is None:
        raise InputError(
            f"beam.shear_stiffness is missing: theory = {theory!r} takes kappa G A of a section given plainly"
        )
    g = own.bending_stiffness / (own.shear_stiffness * r2)
    half = 1.0 + b2 * (1.0 + g)
    return 2.0 / (half + sqrt(half * half - 4.0 * b2 * b2 * g))


def rule_frequency_hz(beam: Beam, lower: int, upper: int) -> float:
    """Root mean square of two exact frequencies, Hz: where both undamped modes answer a force equally."""
    return sqrt((frequency_hz(beam, lower) ** 2 + frequency_hz(beam, upper) ** 2) / 2.0)


def quarter_wavelength(beam: Beam, frequency: float) -> float:
    """A quarter of the bending wavelength of a uniform beam at `frequency` (Hz), metres. Raises InputError."""
    check_uniform(beam)
    if not frequency > 0:
        raise InputError(f"frequency_hz = {frequency!r}: give a positive frequency in hertz")
    return pi / 2.0 / sqrt(2.0 * pi * frequency / beam.wave_constant)
