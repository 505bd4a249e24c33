"""A rigid slider on the crests of a travelling wave with an elastic (Winkler) layer between them, in steady state.

Crests w = A cos s indent the layer by A (cos s - cos phi) where |s| < phi. The surface moves along the slider at
V cos s, V = (h/2) k omega A, the slider at r V. A layer that is compliant along the surface as well is sheared by
y = sin s - r s + c (unit V/omega) while it sticks and slips where |y| = epsilon (cos s - cos phi), with epsilon = 2 mu
kappa / (kappa_t k h) and kappa, kappa_t its stiffnesses per length, normal and tangential. Forces are over mu N, speeds
over V. Sources: T. Sashida and T. Kenjo, An Introduction to Ultrasonic Motors (1993), for the contact over a crest;
K. L. Johnson, Contact Mechanics (1985), section 8.3, for sticking and slipping layers.
"""

from collections.abc import Callable
from itertools import pairwise
from math import acos, atan, cos, pi, sin, sqrt

from verify.errors import InputError

ROUNDING = 4e-15
"""Distance from the friction limit of a layer that has just stopped slipping."""


def normal_integral(s: float, phi: float) -> float:
    """Integral of cos s - cos phi from 0 to s: half the normal force, over kappa A / k, at s = phi."""
    return sin(s) - s * cos(phi)


def force(phi: float, r: float, epsilon: float = 0.0) -> float:
    """Friction force F/(mu N) on a slider at r times the crest speed, -1 to 1; epsilon = 0 is Coulomb's law.

    The half angle phi is 1e-3 to pi; below it the normal force has fewer than nine digits.
    """
    if epsilon > 0.0:
        return _shear_integral(phi, r, epsilon) / (2.0 * epsilon * normal_integral(phi, phi))
    if r >= 1.0:
        return -1.0
    psi = acos(r) if r > cos(phi) else phi
    return 2.0 * normal_integral(psi, phi) / normal_integral(phi, phi) - 1.0


def no_load_speed(phi: float, epsilon: float = 0.0) -> float:
    """Speed over V at which the friction force vanishes."""
    if epsilon >= 1.0 / phi - cos(phi) / sin(phi):
        return sin(phi) / phi  # full sticking
    if epsilon > 0.0:
        return root(lambda r: force(phi, r, epsilon), min(cos(phi), 0.0), 1.0)
    half = 0.5 * normal_integral(phi, phi)
    return cos(root(lambda s: half - normal_integral(s, phi), 0.0, phi))


def efficiency(phi: float, r: float) -> float:
    """Power on the slider over power into the layer, Coulomb's law, 0 <= r < 1. Raises InputError without power."""
    psi = acos(r) if r > cos(phi) else phi

    def power(s: float) -> float:
        """Integral of (cos s - cos phi) cos s from 0 to s."""
        return 0.5 * s + 0.25 * sin(2.0 * s) - cos(phi) * sin(s)

    supplied = 2.0 * power(psi) - power(phi)
    if supplied <= 0.0:
        raise InputError(f"speed_ratio = {r!r}: the slider drives the layer and has no efficiency, lower it")
    return r * (2.0 * normal_integral(psi, phi) - normal_integral(phi, phi)) / supplied


def root(falling: Callable[[float], float], low: float, high: float) -> float:
    """Zero of a falling function on [low, high] to rounding; an end where the sign does not change."""
    from scipy.optimize import brentq

    if falling(low) <= 0.0:
        return low
    if falling(high) >= 0.0:
        return high
    return float(brentq(falling, low, high, xtol=1e-300, rtol=1e-15))


def _shear_integral(phi: float, r: float, epsilon: float) -> float:
    """Integral of the shear y over the contact, from y = 0 at s = -phi, event by event."""
    s, c, sign, total = -phi, sin(phi) - r * phi, 0, 0.0  # sign: direction of slip, 0 while it sticks
    while s < phi:
        if sign:
            # slip ends where the surface no longer outruns the friction limit: cos s + slope sin s = r
            slope = epsilon * sign
            ends = (e for e in _turning_points(r, slope) if e > s + 1e-12 and sign * (slope * cos(e) - sin(e)) < 0.0)
            end = min(min(ends, default=pi), phi)
            total += slope * (normal_integral(end, phi) - normal_integral(s, phi))
            c = slope * (cos(end) - cos(phi)) - sin(end) + r * end
            s, sign = end, 0
        else:
            end, sign = _slip_onset(s, phi, r, epsilon, c)
            total += cos(s) - cos(end) - 0.5 * r * (end * end - s * s) + c * (end - s)
            s = end
    return total


def _turning_points(r: float, slope: float) -> tuple[float, ...]:
    """Solutions of cos s + slope sin s = r between -pi and pi, and some beyond."""
    size = sqrt(1.0 + slope * slope)
    if abs(r) > size:
        return ()
    middle, half = atan(slope), acos(r / size)
    return middle - half, middle + half, middle - half + 2.0 * pi, middle + half - 2.0 * pi


def _slip_onset(s: float, phi: float, r: float, epsilon: float, c: float) -> tuple[float, int]:
    """(next s at which the shear reaches the friction limit, direction of slip); (phi, 0) where it never does.

    The distance from either limit is monotonic between its turning points.
    """

    def distance(at: float, sign: int) -> float:
        return epsilon * (cos(at) - cos(phi)) - sign * (sin(at) - r * at + c)

    turns = sorted(at for sign in (1, -1) for at in _turning_points(r, sign * epsilon) if s + 1e-12 < at < phi)
    for before, after in pairwise((s, *turns, phi)):
        reached = [
            (root(lambda at, sign=sign: distance(at, sign), before, after), sign)  # type: ignore[misc]
            for sign in (1, -1)
            if distance(after, sign) < -ROUNDING
        ]
        if reached:
            return min(reached)
    return phi, 0
