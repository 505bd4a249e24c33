"""Frequencies one at a time: the count of those below a trial value singles one out, its minor gives the digits."""

from collections.abc import Callable
from functools import lru_cache
from math import pi

from verify.checks import check_number, check_word
from verify.exact.characteristic import Found, trial
from verify.exact.layout import Lineup, line_up
from verify.linear.places import as_typed
from verify.options import THEORIES
from verify.problem.beam import Beam

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
    from scipy.optimize import brentq

    low, high = 0.0, 1.0
    while say(high).below < wanted:
        low, high = high, 2.0 * high
    while high - low > _DIGITS * high and high > 1e-300:
        lower, upper = say(low), say(high)
        alone = low > 0.0 and upper.below - lower.below == 1 and (upper.minor > 0.0) != (lower.minor > 0.0)
        if alone and high - low < 0.1 * high:
            return float(brentq(lambda root: say(root).minor, low, high, xtol=1e-300, rtol=8.9e-16))
        middle = 0.5 * (low + high)
        low, high = (low, middle) if say(middle).below >= wanted else (middle, high)
    return high
