"""Impacts in closed form: a mass that bounces on a vibrating surface, and a mass that lands on a spring and dashpot.

Bouncing: the surface moves as A sin theta; `ratio` is A omega^2 over the acceleration of the preload, g + F/m. P. J.
Holmes, J. Sound Vib. 84 (1982) 173. Landing: unilateral spring k and dashpot c, omega_0 = sqrt(k/m), zeta =
c/(2 m omega_0), gravity is neglected during the impact. T. Schwager and T. Poeschel, Granular Matter 9 (2007) 465.
"""

from math import asin, asinh, atan2, cos, exp, pi, sin, sqrt

from verify.exact.contact.layer import root

SEARCH_STEP = 2.0 * pi / 720
"""Step of the first search for a landing, rad."""


def landing_phase(ratio: float) -> float:
    """Phase of the first landing after lift-off, radians; six digits up to a ratio of 1e9."""
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
    """Duration of an impact times omega_0, 2 acos(zeta)/sqrt(1 - zeta^2); acosh for zeta > 1."""
    square = (1.0 - damping_ratio) * (1.0 + damping_ratio)
    if square == 0.0:
        return 2.0
    side = sqrt(abs(square))
    return 2.0 * (atan2(side, damping_ratio) if square > 0.0 else asinh(side)) / side


def restitution(damping_ratio: float) -> float:
    """Speed after over speed before an impact on spring and dashpot, exp(-zeta contact_time)."""
    return exp(-damping_ratio * contact_time(damping_ratio))
