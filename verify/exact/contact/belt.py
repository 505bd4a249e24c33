"""Stick and slip of a mass on a spring on a moving belt.

J. P. Den Hartog, Mechanical Vibrations, 4th ed. (1956), section 7.8; static and kinetic friction are forces.
"""

from math import atan2, pi, sqrt

from verify.errors import InputError
from verify.validation import check_number


def stick_slip_times(mass: float, stiffness: float, static: float, kinetic: float, speed: float) -> tuple[float, float]:
    """(stick, slip) times of the cycle, s: 2 D/(k v) and 2 (pi - atan(D omega/(k v)))/omega, D = static - kinetic.

    Raises InputError for kinetic >= static.
    """
    for name, value, unit in (("mass", mass, "kg"), ("stiffness", stiffness, "N/m"), ("speed", speed, "m/s")):
        check_number(name, value, unit, above=0)
    check_number("kinetic", kinetic, "newton, friction in sliding", at_least=0)
    check_number("static", static, "newton, largest friction at rest")
    if kinetic >= static:
        raise InputError(
            f"kinetic = {kinetic!r} is not below static = {static!r}: the mass does not slip back, lower it"
        )
    lead, omega = (static - kinetic) / stiffness, sqrt(stiffness / mass)
    return 2.0 * lead / speed, 2.0 * (pi - atan2(lead * omega, speed)) / omega
