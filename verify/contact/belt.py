"""A mass on a spring, on a belt that runs below it: it sticks, is carried, slips back.

Source: J. P. Den Hartog, Mechanical Vibrations, 4th ed. (1956), section 7.8; static and kinetic friction are forces.
"""

from math import atan2, pi, sqrt

from verify.errors import InputError
from verify.validation import check_number


def stick_slip_times(mass: float, stiffness: float, static: float, kinetic: float, speed: float) -> tuple[float, float]:
    """(stick, slip) seconds of the settled motion, 2 D/(k v) and 2 (pi - atan(D omega/(k v)))/omega.

    D is the drop of friction, static - kinetic. It slips from the spring's pull static/k on, as the cosine about
    kinetic/k that leaves with the speed of the belt, and meets it again at kinetic - D, which always holds.
    Raises InputError where there is no drop.
    """
    check_number("mass", mass, "kg", above=0)
    check_number("stiffness", stiffness, "N/m", above=0)
    check_number("kinetic", kinetic, "newton, friction while it slips", at_least=0)
    check_number("static", static, "newton, friction while it sticks", at_least=0)
    check_number("speed", speed, "m/s, of the belt", above=0)
    if kinetic >= static:
        raise InputError(
            f"kinetic = {kinetic!r} is not below static = {static!r}: without a drop nothing slips, lower it"
        )
    lead, omega = (static - kinetic) / stiffness, sqrt(stiffness / mass)
    return 2.0 * lead / speed, 2.0 * (pi - atan2(lead * omega, speed)) / omega
