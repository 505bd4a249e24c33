"""A rigid slider on the crests of a travelling wave, through a thin layer of springs (Winkler), in a steady state.

Crests w = A cos s press into the layer where |s| < phi, by A (cos s - cos phi). The surface runs along the slider at
V cos s, V = (h/2) k omega A; the slider at r V. A layer that gives way along the surface as well is stretched by
dy/ds = cos s - r while it sticks, in units of V/omega, and slips where |y| = epsilon (cos s - cos phi) with
epsilon = 2 mu kappa / (kappa_t k h), kappa and kappa_t its stiffnesses per length, across and along. Forces are over
mu N, speeds over V, powers over mu N V. Sources: Sashida and Kenjo, An Introduction to Ultrasonic Motors (1993), of the
contact over a crest; K. L. Johnson, Contact Mechanics (1985), section 8.3, of a layer that sticks and slips.
"""

from collections.abc import Callable, Iterator
from itertools import pairwise
from math import acos, asin, atan, cos, pi, sin, sqrt

from verify.errors import InputError
from verify.validation import check_number

NARROWEST = 1e-3
"""Half angle of a contact, radians, below which sines and cosines leave fewer than nine digits of what is pressed."""
ROUNDING = 4e-15
"""Of a stretch: one that has just stopped slipping is that near to its limit."""


def pressed(s: float, phi: float) -> float:
    """Integral of cos s - cos phi from 0 to s: half the normal force, over kappa A / k, where s = phi."""
    return sin(s) - s * cos(phi)


def carried(s: float, phi: float) -> float:
    """Integral of (cos s - cos phi) cos s from 0 to s."""
    return 0.5 * s + 0.25 * sin(2.0 * s) - cos(phi) * sin(s)


def force(phi: float, r: float, epsilon: float = 0.0) -> float:
    """F/(mu N) on a slider at r times the crest speed, -1 to 1.

    `epsilon` = 0 is Coulomb's friction at every point. Raises InputError for a half angle that is none.
    """
    _check(phi, epsilon)
    check_number("speed_ratio", r, "over the speed of the crests")
    if epsilon > 0.0:
        return _stretched(phi, r, epsilon) / (2.0 * epsilon * pressed(phi, phi))
    if r >= 1.0:
        return -1.0
    psi = acos(r) if r > cos(phi) else phi
    return 2.0 * pressed(psi, phi) / pressed(phi, phi) - 1.0


def no_load_speed(phi: float, epsilon: float = 0.0) -> float:
    """Speed over V at which the layer neither drives nor brakes. Raises InputError."""
    _check(phi, epsilon)
    if epsilon >= 1.0 / phi - cos(phi) / sin(phi) and phi < pi:
        return sin(phi) / phi  # it sticks throughout
    if epsilon > 0.0:
        return root(lambda r: force(phi, r, epsilon), min(cos(phi), 0.0), 1.0)
    half = 0.5 * pressed(phi, phi)
    return cos(root(lambda s: half - pressed(s, phi), 0.0, phi))


def efficiency(phi: float, r: float) -> float:
    """Power on the slider over power into the layer, Coulomb's friction. Raises InputError outside 0 to 1."""
    _check(phi, 0.0)
    check_number("speed_ratio", r, "over the speed of the crests", at_least=0, below=1)
    psi = acos(r) if r > cos(phi) else phi
    given = 2.0 * carried(psi, phi) - carried(phi, phi)
    if given <= 0.0:
        raise InputError(
            f"speed_ratio = {r!r}: the layer takes no power at half angle {phi!r}, it is driven by the slider: lower it"
        )
    return r * (2.0 * pressed(psi, phi) - pressed(phi, phi)) / given


def half_space_force(q: float, r: float) -> float:
    """F/(mu N) on a rigid slider pressed on a wavy elastic half-space, Coulomb's friction (Westergaard's contact).

    `q`: mean pressure over that which flattens the wave, 0 to 1. Raises InputError.
    """
    check_number("pressure_ratio", q, "mean pressure over that of full contact", above=0, below=1)
    check_number("speed_ratio", r, "over the speed of the crests")
    square = 0.5 * (1.0 - r) / q
    if square >= 1.0:
        return 1.0
    if square <= 0.0:
        return -1.0
    u = sqrt(square)
    return 4.0 / pi * (asin(u) + u * sqrt(1.0 - square)) - 1.0


def _check(phi: float, epsilon: float) -> None:
    check_number("contact_half_angle", phi, "radians of the wave, half the contact", at_least=NARROWEST, below=pi)
    check_number("epsilon", epsilon, "2 mu kappa / (kappa_t k h)", at_least=0)


def root(falls: Callable[[float], float], low: float, high: float) -> float:
    """Zero of a falling function between two ends, to rounding; an end where the sign does not change."""
    from scipy.optimize import brentq

    if falls(low) <= 0.0:
        return low
    if falls(high) >= 0.0:
        return high
    return float(brentq(falls, low, high, xtol=1e-300, rtol=1e-15))


def _stretched(phi: float, r: float, epsilon: float) -> float:
    """Integral of the stretch over the contact, from where it begins, s = -phi, without stretch."""
    return sum(part for part in _stretches(phi, r, epsilon))


def _stretches(phi: float, r: float, epsilon: float) -> Iterator[float]:
    """The same, stretch by stretch of sticking and slipping."""
    s, c = -phi, sin(phi) - r * phi  # of y = sin s - r s + c, nought at the start
    slips = 0  # what slips from the start sticks for no time
    while s < phi:
        if slips:
            end = min(_sticks_at(s, r, epsilon * slips, slips), phi)
            yield slips * epsilon * (pressed(end, phi) - pressed(s, phi))
            c = slips * epsilon * (cos(end) - cos(phi)) - sin(end) + r * end
            s, slips = end, 0
        else:
            end, slips = _slips_at(s, phi, r, epsilon, c)
            yield cos(s) - cos(end) - 0.5 * r * (end * end - s * s) + c * (end - s)
            s = end


def _sticks_at(s: float, r: float, slope: float, way: int) -> float:
    """The next s where the surface no longer outruns the layer at its limit: cos s + slope sin s = r."""

    def turns(edge: float) -> bool:
        return way * (-sin(edge) + slope * cos(edge)) < 0.0

    return min((edge for edge in _even_at(r, slope) if edge > s + 1e-12 and turns(edge)), default=pi)


def _even_at(r: float, slope: float) -> tuple[float, ...]:
    """Where cos s + slope sin s = r, from -pi to pi and about it."""
    size = sqrt(1.0 + slope * slope)
    if abs(r) > size:
        return ()
    middle, half = atan(slope), acos(r / size)
    return middle - half, middle + half, middle - half + 2.0 * pi, middle + half - 2.0 * pi


def _slips_at(s: float, phi: float, r: float, epsilon: float, c: float) -> tuple[float, int]:
    """(the next place where the stretch reaches its limit, which way it slips there); the end of contact where none.

    The room that is left to it, either way, rises or falls all along between the places where it turns.
    """

    def room(at: float, way: int) -> float:
        return epsilon * (cos(at) - cos(phi)) - way * (sin(at) - r * at + c)

    turns = sorted(at for way in (1, -1) for at in _even_at(r, way * epsilon) if s + 1e-12 < at < phi)
    for before, after in pairwise((s, *turns, phi)):
        reached = [
            (root(lambda at, way=way: room(at, way), before, after), way)  # type: ignore[misc]
            for way in (1, -1)
            if room(after, way) < -ROUNDING
        ]
        if reached:
            return min(reached)
    return phi, 0
