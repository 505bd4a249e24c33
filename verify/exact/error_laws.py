"""Frequencies and errors of both discrete models in closed form: discrete dispersion and error laws, mu = beta L / N.

The dispersion is exact for pinned and guided ends, where modes are sines; other ends have leading error laws.
"""

from cmath import tanh
from collections.abc import Callable, Sequence
from math import cos, exp, pi, sin, sqrt

import msgspec

from verify.errors import InputError
from verify.exact.closed_forms import wavenumber_length
from verify.problem.beam import Beam
from verify.settings import WALLS

_LAW_TO = 2.5  # mu up to which errors follow `expected_error` within a third of its terms from 20 parts on (measured)
_GREGORY = WALLS["gregory"].corrections


def sine_fits(supports: Sequence[str]) -> bool:
    """Whether both ends are pinned or guided, where discrete modes are samples of a sine."""
    return set(supports) <= {"pinned", "guided"}


def dispersion_frequency_hz(model: str, beam: Beam, mode: int, count: int) -> float:
    """The exact frequency of a discrete model of equal parts, Hz: pinned or guided ends, a mode on the lower branch."""
    omega = sqrt(law_of(model).root(wavenumber_length(beam.supports, mode) / count))
    return omega * beam.wave_constant * (count / beam.length) ** 2 / (2.0 * pi)


def _segment_root(mu: float) -> float:
    """omega^2 rho A l^4 / EI of rigid links: 48 s^4 / (3 - 2 s^2), s = sin(mu/2)."""
    s2 = sin(mu / 2.0) ** 2
    return 48.0 * s2 * s2 / (3.0 - 2.0 * s2)


def _hermite_root(mu: float) -> float:
    """omega^2 rho A l^4 / EI of Hermite elements: the lower root of two nodal equations.

    Sine deflections and cosine slopes at the nodes satisfy both exactly.
    """
    c, s, fall = cos(mu), sin(mu), sin(mu / 2.0) ** 2  # fall = (1 - cos mu) / 2
    k11, k12, k22 = 48.0 * fall, -12.0 * s, 8.0 + 4.0 * c
    m11, m12, m22 = (312.0 + 108.0 * c) / 420.0, 26.0 * s / 420.0, (8.0 - 6.0 * c) / 420.0
    a, b, det = m11 * m22 - m12**2, k11 * m22 + k22 * m11 - 2.0 * k12 * m12, 192.0 * fall**2
    return 2.0 * det / (b + sqrt(b * b - 4.0 * a * det))


def leading_error(model: str, supports: Sequence[str], mode: int, count: int) -> float:
    """The leading relative frequency error of a uniform beam of equal parts.

    +mu^4/1440 for Hermite elements; mu^4 (-1/1440 + c / (12 N)) for segments with Gregory's joints at their c
    clamped ends, valid for N well above 120 c: below both terms nearly cancel, and `expected_error` is needed.
    """
    law, mu4 = law_of(model), (wavenumber_length(supports, mode) / count) ** 4
    clamped = supports.count("clamped") if law.clamped_terms else 0
    return mu4 * (law.leading + clamped / (12.0 * count))


def expected_error(model: str, beam: Beam, mode: int, count: int) -> float:
    """The relative frequency error of a uniform beam by the dispersion and the residual of clamped ends.

    Exact between pinned and guided ends; at other ends within a third of the sum of its terms' sizes from N = 20 on.
    Valid where `has_law`.
    """
    return error_at(model, beam, wavenumber_length(beam.supports, mode) / count, count)


def error_at(model: str, beam: Beam, mu: float, count: int) -> float:
    """The same at a wavenumber that need not be a mode's, mu in radians per part, below pi."""
    law = law_of(model)
    clamped = beam.supports.count("clamped") if law.clamped_terms and mu <= _LAW_TO else 0
    return sqrt(law.root(mu)) / mu**2 - 1.0 - (0.5 * clamped * wall_residual(mu) / count if clamped else 0.0)


def has_law(beam: Beam, mode: int, count: int) -> bool:
    """Whether `expected_error` is valid: on the lower branch, mu < pi, where a sine fits the ends, else to mu = 2.5."""
    mu = wavenumber_length(beam.supports, mode) / count
    return mu < pi if sine_fits(beam.supports) else mu <= _LAW_TO


def wall_residual(mu: float) -> float:
    """Gregory's sum of M^2 over the joints from a clamped end on less its integral, in links.

    M = cos z - sin z + e^-z at z = k mu is the bending moment, of mean square 1. Half of the residual over N lowers the
    frequency. It is -mu^4/6 for small mu but for rounding of 1e-16/mu, zero at 0.42, and at most 0.12 mu^4 up to 2.5.
    """

    def beyond(a: complex) -> complex:
        """The sum of e^(-a k) less the integral."""
        return 0.5 + 0.5 / tanh(0.5 * a) - 1.0 / a

    waves = beyond(complex(mu, -mu))
    sums = 0.5 - beyond(complex(0.0, -2.0 * mu)).imag + 2.0 * (waves.real - waves.imag) + beyond(2.0 * mu).real
    squares = ((cos(k * mu) - sin(k * mu) + exp(-k * mu)) ** 2 for k in range(3))
    return sums + sum(a * square for a, square in zip(_GREGORY, squares, strict=True))


class Law(msgspec.Struct, frozen=True, kw_only=True):
    """The dispersion and the error law of a discrete model of equal parts."""

    root: Callable[[float], float]
    """mu = beta L / N -> omega^2 rho A l^4 / EI, the exact dispersion on the lower branch."""
    leading: float  # Leading relative frequency error over mu^4, without clamped ends
    clamped_terms: bool  # Whether clamped ends add to the error


LAWS = {
    "segment": Law(root=_segment_root, leading=-1.0 / 1440.0, clamped_terms=True),
    "fem": Law(root=_hermite_root, leading=1.0 / 1440.0, clamped_terms=False),
}
"""By the name of the model."""


def law_of(model: str) -> Law:
    """The law of a discrete model. Raises InputError for one without."""
    if model not in LAWS:
        raise InputError(f"model = {model!r} has no known error law: choose one of {', '.join(LAWS)}")
    return LAWS[model]
