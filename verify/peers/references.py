"""Exact references of the linear chain: its modes in closed form, motion as a sum over all of them, a slider on it.

Joint positions of a uniform pinned chain swing as sin(j k pi / n): mass and stiffness are polynomials of one second
difference with odd ends. No eigen-solver and no model of the suite takes part.
"""

from functools import lru_cache

import numpy as np

from verify.field_docs import Value
from verify.models.arrays import Array
from verify.peers.case import Case, Sled, surface_speed

RIDE_STEPS = 20_000
BLOCK = 500
"""Steps whose spins are computed at once."""


class _Swing(Value, frozen=True, eq=False, kw_only=True):
    """Modes and what the forces do to them."""

    omega: Array
    """(n - 1,), rad/s."""
    shapes: Array
    """(n + 1, n - 1): deflections of the joints, of unit modal mass."""
    cosine: Array
    """(n - 1,), steady amplitudes of cos(omega t)."""
    sine: Array
    """(n - 1,), of sin(omega t)."""


def frequencies(case: Case) -> Array:
    """(n - 1,), Hz, ascending: omega^2 = K(k) / M(k) of the mode number k."""
    stiffness, mass = _polynomials(case)
    return np.asarray(np.sqrt(stiffness / mass) / (2.0 * np.pi))


def explicit_limit(case: Case) -> float:
    """Seconds: the longest step of the classical Runge-Kutta method that the fastest mode bears, 2 sqrt(2) / omega."""
    return float(np.sqrt(2.0) / (np.pi * frequencies(case)[-1]))


def _polynomials(case: Case) -> tuple[Array, Array]:
    """Stiffness and mass of each mode, for joints that swing as sin(j k pi / n), over n/2."""
    s = 4.0 * np.sin(0.5 * np.arange(1, case.n) * np.pi / case.n) ** 2
    return case.spring / case.link**2 * s**2, case.mass + s * (case.inertia / case.link**2 - 0.25 * case.mass)


@lru_cache(maxsize=8)
def _swing(case: Case) -> _Swing:
    stiffness, mass = _polynomials(case)
    squares = stiffness / mass
    numbers = np.outer(np.arange(case.n + 1), np.arange(1, case.n)) % (2 * case.n)
    shapes = np.sin(numbers * (np.pi / case.n)) / np.sqrt(0.5 * case.n * mass)
    sine, cosine = np.zeros(case.n - 1), np.zeros(case.n - 1)
    for force in case.forces:
        answer = force.amplitude * _lever(case, shapes, force.position)
        answer = answer / (squares - (2.0 * np.pi * case.frequency) ** 2)
        cosine += answer * np.cos(np.radians(force.phase_deg))
        sine -= answer * np.sin(np.radians(force.phase_deg))
    return _Swing(omega=np.sqrt(squares), shapes=shapes, cosine=cosine, sine=sine)


def _lever(case: Case, shapes: Array, x: float) -> Array:
    """(n - 1,): deflections of a material point of a link in every mode."""
    i, at = case.place(x)
    return np.asarray(shapes[i] * (1.0 - at / case.link) + shapes[i + 1] * (at / case.link))


def deflection(case: Case, times: Array, x: float | None = None) -> Array:
    """(m,), metres, of the linear chain from rest at any times, at x or at mid-span."""
    swing, drive = _swing(case), 2.0 * np.pi * case.frequency
    weights = _lever(case, swing.shapes, 0.5 * case.length if x is None else x)
    turns, phase = np.outer(times, swing.omega), drive * np.asarray(times)
    steady = np.cos(phase) * (swing.cosine @ weights) + np.sin(phase) * (swing.sine @ weights)
    free = np.cos(turns) @ (swing.cosine * weights) + np.sin(turns) @ (swing.sine * drive / swing.omega * weights)
    return np.asarray(steady - free)


class Ride(Value, frozen=True, eq=False, kw_only=True):
    """A slider on the exact linear chain, at every step."""

    times: Array
    """(m,), seconds, evenly spaced from 0."""
    distance: Array
    """(m,), metres."""
    speed: Array
    """(m,), m/s."""

    def at(self, times: Array) -> tuple[Array, Array]:
        """(distance, speed) at any times within, by cubics."""
        from scipy.interpolate import CubicSpline

        both = CubicSpline(self.times, np.stack([self.distance, self.speed]), axis=1)(times)
        return both[0], both[1]


def ride(case: Case, sled: Sled, end: float, steps: int = RIDE_STEPS) -> Ride:
    """The slider by Runge-Kutta steps on the exact motion of the chain's links, whose spins it reads (`case`)."""
    step = end / steps
    kept = np.zeros((steps + 1, 2))
    d, v = 0.0, sled.speed
    kept[0] = d, v

    def pull(spins: Array, moved: float, speed: float) -> float:
        return sled.force(speed - surface_speed(case, sled, spins, sled.start + moved)) / sled.mass

    for first in range(0, steps, BLOCK):
        block = min(BLOCK, steps - first)
        spins = _spins(case, np.asarray(step * (first + 0.5 * np.arange(2 * block + 1)), dtype=np.float64))
        for k in range(block):
            now, middle, after = spins[2 * k : 2 * k + 3]
            k1 = pull(now, d, v)
            k2 = pull(middle, d + 0.5 * step * v, v + 0.5 * step * k1)
            k3 = pull(middle, d + 0.5 * step * v + 0.25 * step**2 * k1, v + 0.5 * step * k2)
            k4 = pull(after, d + step * v + 0.5 * step**2 * k2, v + step * k3)
            d += step * v + step**2 * (k1 + k2 + k3) / 6.0
            v += step * (k1 + 2.0 * k2 + 2.0 * k3 + k4) / 6.0
            kept[first + k + 1] = d, v
    times = np.asarray(step * np.arange(steps + 1), dtype=np.float64)
    return Ride(times=times, distance=kept[:, 0], speed=kept[:, 1])


def _spins(case: Case, times: Array) -> Array:
    """(m, n), rad/s: angular velocities of the links from rest."""
    swing, drive = _swing(case), 2.0 * np.pi * case.frequency
    turns, phase = np.outer(times, swing.omega), drive * times
    rates = drive * (np.outer(np.cos(phase), swing.sine) - np.outer(np.sin(phase), swing.cosine))
    rates += np.sin(turns) * (swing.cosine * swing.omega) - np.cos(turns) * (swing.sine * drive)
    return np.asarray(rates @ (np.diff(swing.shapes, axis=0) / case.link).T)
