"""Impacts in closed form: a mass that bounces on a vibrating surface, and a mass that lands on a spring and dashpot.

Bouncing: the surface moves as A sin theta; `ratio` is A omega^2 over the acceleration of the preload, g + F/m. P. J.
Holmes, J. Sound Vib. 84 (1982) 173. Landing: unilateral spring k and dashpot c, omega_0 = sqrt(k/m), zeta =
c/(2 m omega_0), gravity is neglected during the impact. T. Schwager and T. Poeschel, Granular Matter 9 (2007) 465.
"""

from math import asin, asinh, atan2, cos, exp, pi, sin, sqrt

from verify.errors import InputError
from verify.exact.contact.layer import root
from verify.validation import check_number

SEARCH_STEP = 2.0 * pi / 720
"""Step of the first search for a landing, rad."""
LARGEST_RATIO = 1e9
"""Largest ratio: a flight lasts 2 ratio radians, and beyond it the landing phase has fewer than six digits."""


def landing_phase(ratio: float) -> float:
    """Phase of the first landing after lift-off, radians. Raises InputError for a ratio outside 1 to 1e9."""
    check_number("acceleration_ratio", ratio, "largest acceleration over that of the preload", at_most=LARGEST_RATIO)
    if not ratio > 1.0:
        raise InputError(f"acceleration_ratio = {ratio!r}: the mass lifts off above 1 only, raise it")
    start = asin(1.0 / ratio)

    def gap(theta: float) -> float:
        t = theta - start
        return sin(start) + cos(start) * t - 0.5 * t * t / ratio - sin(theta)

    # no landing before the parabola falls to the crests, which the mass passes within a quarter of a period
    above_crests = ratio * (1.0 + cos(start)) - 1.0
    after = start + SEARCH_STEP * max(int(above_crests / SEARCH_STEP), 1)
    while gap(after) > 0.0:
        after += SEARCH_STEP
    return root(gap, after - SEARCH_STEP, after)


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
