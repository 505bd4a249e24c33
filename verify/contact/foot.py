"""How a rigid foot lies on the crests of a travelling wave, w = A cos s: what of it touches, how high it stands.

On a layer of stiffness kappa per length a foot of whole wavelengths stands still while the wave runs below it; `load`
is its normal force over kappa A times its length. A foot that spans no whole wavelengths rises and falls with the
crests; here it does so upright and slowly, on crests that do not give way, with `span` half its length times k. Speeds
are over V, the crests', forces over mu N, friction is Coulomb's. Own derivations, checked by direct sums.
"""

from math import acos, cos, pi, sin

from verify.contact.layer import force, pressed, root
from verify.validation import check_number


def contact_half_angle(load: float) -> float:
    """phi, half of what touches of a wavelength, in radians of the wave: G(phi) = pi load; pi where all of it does.

    Raises InputError for a foot that nothing presses on.
    """
    check_number("load", load, "normal force over kappa A times the length", above=0)
    if load >= 1.0:
        return pi
    return root(lambda phi: pi * load - pressed(phi, phi), 0.0, pi)


def standing_height(load: float) -> float:
    """Of the foot above the mean of the wave, over A: cos phi, and -load where all of it touches. Raises InputError."""
    phi = contact_half_angle(load)
    return cos(phi) if phi < pi else -load


def foot_force(load: float, r: float) -> float:
    """F/(mu N) on that foot at r times the crest speed, also where all of it touches. Raises InputError."""
    phi = contact_half_angle(load)
    if phi < pi:
        return force(phi, r)
    check_number("speed_ratio", r, "over the speed of the crests")
    psi = acos(min(max(r, -1.0), 1.0))
    return 2.0 * (sin(psi) + load * psi) / (pi * load) - 1.0


def short_foot_force(span: float, r: float) -> float:
    """Mean F/(mu N) over a period on a short foot at r times the crest speed, 2 (span + acos r)/pi - 1, at most 1.

    The crest carries the foot while it is below it, the nearer edge stands on the wave otherwise, where the surface
    runs at V cos s. Raises InputError.
    """
    check_number("span", span, "half the foot's length times the wavenumber, radians", at_least=0)
    check_number("speed_ratio", r, "over the speed of the crests")
    if r >= 1.0:
        return -1.0
    return min(1.0, 2.0 * (span + acos(max(r, -1.0))) / pi - 1.0)


def short_foot_speed(span: float) -> float:
    """Speed over V at which such a foot is neither driven nor braked: sin span, 1 from half a wavelength on.

    Raises InputError.
    """
    check_number("span", span, "half the foot's length times the wavenumber, radians", at_least=0)
    return sin(span) if span < 0.5 * pi else 1.0


def dead_band(span: float) -> float:
    """Share of mu N that a load on such a foot may not pass if it is to start, 2 b/lambda; none of it for a point.

    Loads from this on up to mu N, which a foot of half a wavelength still moves, stay where they are.
    Raises InputError.
    """
    return short_foot_force(span, 0.0)


def height_swing(span: float) -> float:
    """By how much such a foot rises and falls, over A: 1 + cos span, nought from a wavelength on. Raises InputError."""
    check_number("span", span, "half the foot's length times the wavenumber, radians", at_least=0)
    return 1.0 + cos(span) if span < pi else 0.0
