"""A rigid foot on the crests of a travelling wave w = A cos s: contact range, height, friction force.

A long foot spans whole wavelengths on a layer of stiffness kappa per length; `load` is its normal force over kappa A
times its length. A short foot lies on rigid crests, upright and quasi-static; `span` is half its length times the
wavenumber. Speeds are over the crest speed V, forces over mu N, Coulomb's law. Own derivations.
"""

from math import acos, cos, pi, sin

from verify.exact.contact.layer import force, normal_integral, root
from verify.validation import check_number


def contact_half_angle(load: float) -> float:
    """Half the contact range of a long foot on a crest, radians; pi in full contact. Raises InputError."""
    check_number("load", load, "normal force over kappa A times the length", above=0)
    return pi if load >= 1.0 else root(lambda phi: pi * load - normal_integral(phi, phi), 0.0, pi)


def standing_height(load: float) -> float:
    """Height of a long foot above the mean of the wave, over A: cos phi; -load in full contact. Raises InputError."""
    phi = contact_half_angle(load)
    return cos(phi) if phi < pi else -load


def foot_force(load: float, r: float) -> float:
    """F/(mu N) on a long foot at r times the crest speed, also in full contact. Raises InputError."""
    phi = contact_half_angle(load)
    if phi < pi:
        return force(phi, r)
    check_number("speed_ratio", r, "over the speed of the crests")
    psi = acos(min(max(r, -1.0), 1.0))
    return 2.0 * (sin(psi) + load * psi) / (pi * load) - 1.0


def short_foot_force(span: float, r: float) -> float:
    """Mean F/(mu N) on a short foot over a period, 2 (span + acos r)/pi - 1, at most 1. Raises InputError.

    A crest below the foot drives it; otherwise its nearer edge touches the wave, where the surface moves at V cos s.
    At r = 0 it is the load, over mu N, beyond which the foot does not start.
    """
    check_number("span", span, "half the foot's length times the wavenumber, radians", at_least=0)
    check_number("speed_ratio", r, "over the speed of the crests")
    return -1.0 if r >= 1.0 else min(1.0, 2.0 * (span + acos(max(r, -1.0))) / pi - 1.0)


def short_foot_speed(span: float) -> float:
    """No-load speed of a short foot over V: sin span, 1 from half a wavelength on. Raises InputError."""
    check_number("span", span, "half the foot's length times the wavenumber, radians", at_least=0)
    return sin(span) if span < 0.5 * pi else 1.0


def height_swing(span: float) -> float:
    """Peak-to-peak height of a short foot over A: 1 + cos span, 0 from a wavelength on. Raises InputError."""
    check_number("span", span, "half the foot's length times the wavenumber, radians", at_least=0)
    return 1.0 + cos(span) if span < pi else 0.0
