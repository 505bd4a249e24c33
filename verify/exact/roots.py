"""Frequencies one at a time: the count of those below a trial value singles one out, its minor gives the digits."""

from collections.abc import Callable
from functools import lru_cache
from math import pi

from verify.beam import Beam
from verify.checks import check_number, check_word
from verify.exact.lineup import Lineup, line_up
from verify.exact.minors import Found, trial
from verify.models.places import as_typed
from verify.options import THEORIES

LARGEST_TRIAL = 1e30
"""Beta L: its fourth power, and the squares of what shear and turning make of that, are numbers too."""
_DIGITS = 4e-16
"""Relative, where a search ends."""


@lru_cache(maxsize=64)
def trials(line: Lineup) -> Callable[[float], Found]:
    """What a trial beta L says, kept."""
    return lru_cache(maxsize=20_000)(lambda beta_length: trial(line, beta_length**4))


@as_typed
def modes_below(beam: Beam, beta_length: float, theory: str = "euler-bernoulli") -> int:
    """How many frequencies, rigid ones included, lie below omega = beta^2 sqrt(EI / rho A), by beta L.

    Raises InputError for a beta L that is none, or so large that its fourth power is no number.
    """
    check_number("beta_length", beta_length, "beta L", at_least=0.0, at_most=LARGEST_TRIAL)
    check_word("theory", theory, THEORIES)
    return trials(line_up(beam, theory))(beta_length).below


def general_frequency_hz(beam: Beam, mode: int, theory: str = "euler-bernoulli") -> float:
    """The frequency of one elastic mode of any beam, Hz, without any closed form."""
    beta_length = wavenumber_length(beam, mode, theory)
    return beta_length * beta_length * beam.wave_constant / (2.0 * pi * beam.length**2)


def wavenumber_length(beam: Beam, mode: int, theory: str = "euler-bernoulli") -> float:
    """The trial beta L at which one elastic mode lies."""
    return nth_root(trials(line_up(beam, theory)), mode + beam.rigid_motions)


def nth_root(say: Callable[[float], Found], wanted: int) -> float:
    """The positive trial value above which `wanted` roots are counted.

    Intervals are halved, the same ones for all roots, until one holds this root alone; where it never does, roots
    coincide to rounding.
    """
    low, high = 0.0, 1.0
    while say(high).below < wanted:
        low, high = high, 2.0 * high
    while high - low > _DIGITS * high and high > 1e-300:
        lower, upper = say(low), say(high)
        alone = low > 0.0 and upper.below - lower.below == 1 and (upper.minor > 0.0) != (lower.minor > 0.0)
        if alone and high - low < 0.1 * high:
            return _refined(say, low, lower.minor, high, upper.minor)
        middle = 0.5 * (low + high)
        low, high = (low, middle) if say(middle).below >= wanted else (middle, high)
    return high


def _refined(say: Callable[[float], Found], a: float, fa: float, b: float, fb: float) -> float:
    """The root of a minor in an interval over which its sign changes (Chandrupatla, Adv. Eng. Software 28, 1997)."""
    c, fc, t = a, fa, 0.5
    for _ in range(200):
        x = a + t * (b - a)
        fx = say(x).minor
        if (fx > 0.0) == (fa > 0.0):
            c, fc = a, fa
        else:
            c, fc, b, fb = b, fb, a, fa
        a, fa = x, fx
        best = a if abs(fa) < abs(fb) else b
        least = _DIGITS * abs(best) / abs(b - a) if b != a else 1.0
        if least >= 0.5 or fx == 0.0:
            return best
        xi, phi = (a - b) / (c - b), (fa - fb) / (fc - fb)
        t = 0.5
        if phi**2 < xi and (1.0 - phi) ** 2 < 1.0 - xi:
            t = fa / (fb - fa) * fc / (fb - fc) + (c - a) / (b - a) * fa / (fc - fa) * fb / (fc - fb)
        t = min(1.0 - least, max(least, t))
    return b
