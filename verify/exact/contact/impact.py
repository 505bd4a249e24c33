"""Impacts in closed form: a mass that bounces on a vibrating surface, and a mass that lands on a spring and dashpot.

Bouncing: the surface moves as A sin theta; `ratio` is A omega^2 over the acceleration of the preload, g + F/m. P. J.
Holmes, J. Sound Vib. 84 (1982) 173. Landing: spring k and dashpot c push and never pull, omega_0 = sqrt(k/m), zeta =
c/(2 m omega_0), gravity is neglected during the impact. T. Schwager and T. Poeschel, Granular Matter 9 (2007) 465.
"""

from cmath import sqrt as complex_sqrt
from math import acos, asin, asinh, atan2, cos, exp, pi, sin, sqrt
from typing import NamedTuple

from verify.errors import InputError
from verify.exact.contact.layer import root
from verify.validation import check_number, check_whole

SEARCH_STEP = 2.0 * pi / 720
"""Radians; first search for a landing."""
LARGEST_RATIO = 1e9
"""A flight lasts 2 ratio radians; beyond this rounding leaves its landing phase fewer than six digits."""


class Bounce(NamedTuple):
    """A periodic bounce: one landing in a number of periods, at constant phase."""

    phase: float
    """Landing phase, radians from the zero of the surface; the one of two that can be stable."""
    speed: float
    """Take-off speed over A omega; the mass lands with the opposite of it."""
    multipliers: tuple[complex, complex]
    """Floquet multipliers from landing to landing: their product is e^2, stable inside the unit circle."""


def landing_phase(ratio: float) -> float:
    """Phase of the first landing after lift-off, radians. Raises InputError for a ratio outside 1 to 1e9."""
    check_number("acceleration_ratio", ratio, "largest acceleration over that of the preload", at_most=LARGEST_RATIO)
    if not ratio > 1.0:
        raise InputError(f"acceleration_ratio = {ratio!r}: the mass lifts off above 1 alone, raise it")
    start = asin(1.0 / ratio)

    def gap(theta: float) -> float:
        t = theta - start
        return sin(start) + cos(start) * t - 0.5 * t * t / ratio - sin(theta)

    # no landing before the parabola is down to the crests: the mass passes them within a quarter of a turn
    above_crests = ratio * (1.0 + cos(start)) - 1.0
    after = start + SEARCH_STEP * max(int(above_crests / SEARCH_STEP), 1)
    while gap(after) > 0.0:
        after += SEARCH_STEP
    return root(gap, after - SEARCH_STEP, after)


def bouncing_limits(restitution: float) -> tuple[float, float]:
    """Ratios between which a stable bounce of one period exists. Raises InputError outside 0 <= e < 1."""
    check_number("restitution", restitution, "speed after over speed before", at_least=0)
    if restitution >= 1.0:
        raise InputError(f"restitution = {restitution!r}: a lossless bounce has no limits, give one below 1")
    low = pi * (1.0 - restitution) / (1.0 + restitution)
    return low, sqrt(low**2 + (2.0 * (1.0 + restitution**2) / (1.0 + restitution) ** 2) ** 2)


def periodic_bounce(ratio: float, restitution: float, periods: int = 1) -> Bounce:
    """The bounce with one landing in `periods` of the surface, stable or not. Raises InputError below its least ratio.

    cos phase is (1-e)/(1+e) times the take-off speed periods pi/ratio. Deviations d theta, d v obey d theta' = d theta
    + (1+e) ratio d v and d v' = e^2 d v - (1+e) sin(phase) d theta': a map of determinant e^2 and trace 1 + e^2 -
    (1+e)^2 ratio sin(phase).
    """
    check_number("acceleration_ratio", ratio, "largest acceleration over that of the preload", above=0)
    check_whole("periods", periods, 1)
    e, least = restitution, periods * bouncing_limits(restitution)[0]
    if ratio < least:
        raise InputError(f"acceleration_ratio = {ratio!r}: no periodic bounce exists below {least!r}, raise it")
    phase = acos(least / ratio)
    half = 0.5 * (1.0 + e * e - (1.0 + e) ** 2 * ratio * sin(phase))
    part = complex_sqrt(half * half - e * e)
    return Bounce(phase, periods * pi / ratio, (half + part, half - part))


def contact_time(damping_ratio: float) -> float:
    """Duration of an impact times omega_0, 2 acos(zeta)/sqrt(1 - zeta^2); acosh for zeta > 1. Raises InputError."""
    check_number("damping_ratio", damping_ratio, "of the mass on its contact, c/(2 sqrt(k m))", at_least=0)
    square = (1.0 - damping_ratio) * (1.0 + damping_ratio)
    if square == 0.0:
        return 2.0
    side = sqrt(abs(square))
    return 2.0 * (atan2(side, damping_ratio) if square > 0.0 else asinh(side)) / side


def restitution(damping_ratio: float) -> float:
    """Speed after over speed before an impact on spring and dashpot, exp(-zeta contact_time). Raises InputError."""
    return exp(-damping_ratio * contact_time(damping_ratio))


def damping_ratio_for(e: float) -> float:
    """Damping ratio of an impact of this restitution e, 0 < e <= 1. Raises InputError."""
    check_number("restitution", e, "speed after over speed before", above=0)
    if e > 1.0:
        raise InputError(f"restitution = {e!r}: an impact gains no speed, give at most 1")
    high = 1.0
    while restitution(high) > e:
        high *= 2.0
    return root(lambda zeta: restitution(zeta) - e, 0.0, high)


def lift_off_ratio(frequency_ratio: float, damping_ratio: float = 0.0) -> float:
    """A omega^2 over the acceleration of the preload at which a mass on spring and dashpot first leaves the surface.

    |1 - r^2/(1 + 2 i zeta r)| with r = omega/omega_0, in steady state. Raises InputError.
    """
    check_number("frequency_ratio", frequency_ratio, "over the frequency of the mass on its contact", at_least=0)
    check_number("damping_ratio", damping_ratio, "of the mass on its contact", at_least=0)
    return abs(1.0 - frequency_ratio**2 / complex(1.0, 2.0 * damping_ratio * frequency_ratio))
