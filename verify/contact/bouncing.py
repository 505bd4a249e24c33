"""A point mass on a surface that shakes across: when it leaves, when it lands, when it bounces in step.

The surface moves as A sin theta; `ratio` is A omega^2 over what presses the mass down, g + F/m. Closed forms of
P. J. Holmes's bouncing ball (J. Sound Vib. 84 (1982) 173).
"""

from cmath import sqrt as complex_sqrt
from math import acos, asin, cos, pi, sin, sqrt
from typing import NamedTuple

from verify.contact.layer import root
from verify.errors import InputError
from verify.validation import check_number, check_whole


class Bounce(NamedTuple):
    """A mass that lands at the same phase once in so many periods."""

    phase: float
    """Of its landing, radians from the surface's own zero; of the two the one that can be stable."""
    speed: float
    """With which it leaves, and lands the other way, over A omega."""
    multipliers: tuple[complex, complex]
    """Of a small deviation from landing to landing: their product is e^2, stable inside the unit circle."""


LOOKS = 720
"""Of a turn, in which a landing is looked for."""
LONGEST = 1e9
"""Largest ratio whose landing is told: its flight of twice as many radians leaves the phase six digits."""


def leaving_phase(ratio: float) -> float:
    """Where the mass leaves the surface, radians. Raises InputError at 1 and below, where it never does."""
    check_number("acceleration_ratio", ratio, "largest acceleration over that which presses")
    if not ratio > 1.0:
        raise InputError(f"acceleration_ratio = {ratio!r}: the mass leaves the surface above 1 alone, raise it")
    return asin(1.0 / ratio)


def landing_phase(ratio: float) -> float:
    """Where it lands after it left for the first time, radians from the surface's own zero. Raises InputError.

    It is above the surface's highest place before a quarter of a turn is over, and is looked for from where it has
    fallen to that again: for a hard shake that is many turns later.
    """
    start = leaving_phase(ratio)
    if ratio > LONGEST:
        raise InputError(
            f"acceleration_ratio = {ratio!r}: the mass flies for {2.0 * ratio:.0e} rad, of which rounding leaves no "
            f"phase of its landing, give at most {LONGEST:g}"
        )

    def above(theta: float) -> float:
        t = theta - start
        return sin(start) + cos(start) * t - 0.5 * t * t / ratio - sin(theta)

    step, fallen = 2.0 * pi / LOOKS, ratio * (1.0 + cos(start)) - 1.0
    after = start + step * max(int(fallen / step), 1)
    while above(after) > 0.0:
        after += step
    return root(above, after - step, after)


def bouncing_limits(restitution: float) -> tuple[float, float]:
    """Between which ratios a mass that lands with this restitution bounces once a period, stably. Raises InputError."""
    check_number("restitution", restitution, "speed after over speed before", at_least=0)
    if restitution >= 1.0:
        raise InputError(f"restitution = {restitution!r}: a bounce that loses nothing has no limits, give one below 1")
    low = pi * (1.0 - restitution) / (1.0 + restitution)
    width = 2.0 * (1.0 + restitution**2) / (1.0 + restitution) ** 2
    return low, sqrt(low * low + width * width)


def bounce_in_step(ratio: float, restitution: float, periods: int = 1) -> Bounce:
    """The bounce with one landing in `periods` of the surface, stable or not. Raises InputError below its least ratio.

    It leaves with periods pi / ratio, and lands where cos phase is (1-e)/(1+e) times that. One that lands d theta late
    and leaves d v fast does so by d theta' = d theta + (1+e) ratio d v and d v' = e^2 d v - (1+e) sin(phase) d theta'
    the next time: of this map the determinant is e^2, the trace 1 + e^2 - (1+e)^2 ratio sin(phase).
    """
    check_number("acceleration_ratio", ratio, "largest acceleration over that which presses", above=0)
    check_whole("periods", periods, 1)
    e, least = restitution, periods * bouncing_limits(restitution)[0]
    if ratio < least:
        raise InputError(f"acceleration_ratio = {ratio!r}: nothing bounces in step below {least!r}, raise it")
    phase = acos(least / ratio)
    half = 0.5 * (1.0 + e * e - (1.0 + e) ** 2 * ratio * sin(phase))
    root = complex_sqrt(half * half - e * e)
    return Bounce(phase, periods * pi / ratio, (half + root, half - root))
