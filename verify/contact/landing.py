"""A mass that lands on a spring beside a dashpot, which press and never pull: how fast it leaves, when it lifts off.

Pressed in by p it is pushed back by k p + c p', until that is nought; its own frequency on them is omega_0 =
sqrt(k/m), zeta = c/(2 m omega_0). It lands and leaves within 2 acos(zeta)/sqrt(1 - zeta^2) over omega_0, and e =
exp(-zeta times that), for zeta above 1 by the same formula of acosh. Weight during the blow is left out. Source:
T. Schwager, T. Poeschel, Coefficient of restitution and linear-dashpot model revisited, Granular Matter 9 (2007) 465,
whose three branches are this one function.
"""

from math import asinh, atan2, exp, inf, sqrt

from verify.contact.layer import root
from verify.errors import InputError
from verify.validation import check_number


def contact_time(damping_ratio: float) -> float:
    """From landing to leaving, in 1/omega_0. Raises InputError for a dashpot that drives."""
    check_number("damping_ratio", damping_ratio, "of the mass on its contact, c/(2 sqrt(k m))", at_least=0)
    square = (1.0 - damping_ratio) * (1.0 + damping_ratio)
    if square == 0.0:
        return 2.0
    side = sqrt(abs(square))
    return 2.0 * (atan2(side, damping_ratio) if square > 0.0 else asinh(side)) / side


def restitution(damping_ratio: float) -> float:
    """Speed of leaving over that of landing, 1 without a dashpot, exp(-2) at zeta = 1. Raises InputError."""
    return exp(-damping_ratio * contact_time(damping_ratio))


def damping_ratio(mass: float, stiffness: float, damping: float) -> float:
    """Zeta of a mass (kg) on a spring (N/m) and a dashpot (N s/m). Raises InputError."""
    check_number("mass", mass, "kg", above=0)
    check_number("stiffness", stiffness, "N/m", above=0)
    check_number("damping", damping, "N s/m", at_least=0)
    found = 0.5 * damping / (sqrt(stiffness) * sqrt(mass))
    if found == inf:
        raise InputError(f"damping = {damping!r} N s/m has no ratio to stiffness and mass: lower it")
    return found


def damping_ratio_for(wanted: float) -> float:
    """Zeta at which a mass leaves with this share of its speed. Raises InputError outside 0 to 1, and at 0."""
    check_number("restitution", wanted, "speed after over speed before", above=0)
    if wanted > 1.0:
        raise InputError(f"restitution = {wanted!r}: nothing leaves faster than it lands, give at most 1")
    high = 1.0
    while restitution(high) > wanted:
        high *= 2.0
    return root(lambda zeta: restitution(zeta) - wanted, 0.0, high)


def lift_off_ratio(frequency_ratio: float, damping_ratio: float = 0.0) -> float:
    """A omega^2 over what presses the mass down at which it first leaves a surface that shakes as A sin(omega t).

    `frequency_ratio` is omega/omega_0: |1 - r^2/(1 + 2 i zeta r)|, nought at resonance without a dashpot, and 1 for a
    contact that does not give way. In the steady state. Raises InputError.
    """
    check_number("frequency_ratio", frequency_ratio, "over the frequency of the mass on its contact", at_least=0)
    check_number("damping_ratio", damping_ratio, "of the mass on its contact", at_least=0)
    return abs(1.0 - frequency_ratio**2 / complex(1.0, 2.0 * damping_ratio * frequency_ratio))
