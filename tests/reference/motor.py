"""Contact of a motor by other means than the engine: exact parabolas, closed forms, waves. Nothing of verify.

A mid-line moves as w(x, t). Below a place x is the material X = x + (h/2) w'(x), whose surface is at w(X) and runs along
with u = (w_t w' - (h/2) w_t') / sqrt(1 + w'^2).
"""

from math import acos, asin, cos, exp, pi, sin, sqrt
from typing import NamedTuple

import numpy as np
from scipy.optimize import brentq

# --- a mass on a surface that shakes as A sin theta; heights over A, speeds over A omega, times in radians


def next_landing(ratio, theta, speed, after, steps=400):
    """(phase, speed of the mass) of the next landing of a mass that leaves the surface at theta, `after` it at least."""

    def gap(phase):
        t = phase - theta
        return sin(theta) + speed * t - 0.5 * t * t / ratio - sin(phase)

    low = theta + after
    assert gap(low) > 0.0, "it does not leave"
    high = low + 2.0 * pi / steps
    while gap(high) > 0.0:
        low, high = high, high + 2.0 * pi / steps
    phase = brentq(gap, low, high, xtol=1e-15, rtol=1e-15)
    return phase, speed - (phase - theta) / ratio


class Bounce(NamedTuple):
    """A periodic bounce: landing phase, take-off speed over A omega, Floquet multipliers from landing to landing."""

    phase: float
    speed: float
    multipliers: tuple


def bouncing_limits(restitution):
    """Ratios A omega^2 / g between which a stable bounce of one period exists, P. J. Holmes (1982)."""
    low = pi * (1.0 - restitution) / (1.0 + restitution)
    return low, sqrt(low**2 + (2.0 * (1.0 + restitution**2) / (1.0 + restitution) ** 2) ** 2)


def periodic_bounce(ratio, restitution):
    """The bounce of one landing in a period: a map of determinant e^2."""
    e, phase = restitution, acos(bouncing_limits(restitution)[0] / ratio)
    half = 0.5 * (1.0 + e * e - (1.0 + e) ** 2 * ratio * sin(phase))
    part = complex(half * half - e * e) ** 0.5
    return Bounce(phase, pi / ratio, (half + part, half - part))


def damping_ratio_for(restitution):
    """Damping ratio below 1 of an impact of this restitution on spring and dashpot that only push."""

    def lost(zeta):
        return exp(-2.0 * zeta * acos(zeta) / sqrt(1.0 - zeta**2)) - restitution

    return brentq(lost, 0.0, 0.99, xtol=1e-15)


def lift_off_ratio(frequency_ratio, zeta):
    """A omega^2 over the acceleration of the preload at which a mass on spring and dashpot first leaves."""
    return abs(1.0 - frequency_ratio**2 / complex(1.0, 2.0 * zeta * frequency_ratio))


def short_foot_force(span, r):
    """Mean F/(mu N) on a short foot on rigid crests, `span` half its length times k, at r times the crest speed.

    A crest below the foot drives it; otherwise its nearer edge touches the wave, whose surface moves at V cos s.
    """
    return -1.0 if r >= 1.0 else min(1.0, 2.0 * (span + acos(max(r, -1.0))) / pi - 1.0)


class Landed(NamedTuple):
    """Phase of a landing, its relative speed over A omega, and the phase of the next departure: its own of a bounce."""

    phase: float
    closing: float
    left: float


def bounces(ratio, restitution, turns, start=None):
    """Landings within `turns` periods, by exact parabolas: at first on the surface, or flying from (phase, speed).

    Where it would leave slower than 1e-6 it stays until the surface throws it off, at sin theta = 1/ratio or at once.
    """
    off = asin(1.0 / ratio)
    (theta, speed), after = start or (off, cos(off)), 1e-7 if start else 1e-3
    landings = []
    while True:
        phase, falling = next_landing(ratio, theta, speed, after)
        if phase > 2.0 * pi * turns:
            return landings
        closing = cos(phase) - falling
        if restitution * closing > 1e-6:
            theta, speed, after = phase, cos(phase) + restitution * closing, 1e-7
        else:
            own = (phase - off) % (2.0 * pi)
            theta = phase if own < pi - 2.0 * off else phase + 2.0 * pi - own
            speed, after = cos(theta), 1e-3
        landings.append(Landed(phase, closing, theta))


# --- surfaces


class Waves(NamedTuple):
    """Re[(a e^{-ikx} + b e^{ikx}) e^{i omega t}]: the field of a driven beam away from its ends."""

    forward: complex
    backward: complex
    k: float
    omega: float

    def at(self, x, t):
        """w, w_t, w', w_t', w''."""
        turn = np.exp(1j * self.omega * t)
        ahead, back = self.forward * np.exp(-1j * self.k * x) * turn, self.backward * np.exp(1j * self.k * x) * turn
        both, tilt = ahead + back, 1j * self.k * (back - ahead)
        return both.real, -self.omega * both.imag, tilt.real, -self.omega * tilt.imag, -(self.k**2) * both.real


def waves_of(shapes, k, omega, near, half_length=0.02):
    """Waves fitted to a complex field around `near`, x of the field."""
    x = np.linspace(near - half_length, near + half_length, 41)
    rows = np.stack([np.exp(-1j * k * x), np.exp(1j * k * x)], axis=1)
    waves, *_ = np.linalg.lstsq(rows, shapes(x), rcond=None)
    return Waves(complex(waves[0]), complex(waves[1]), k, omega)


def surface(at, x, t, half):
    """(w, its rate for v = 0, the factor of v in its rate, u) of the surface at x."""
    _, _, tilt, turn, bend = at(x, t)
    w, rise, slope, twist, _ = at(x + half * tilt, t)
    along = (rise * slope - half * twist) / np.sqrt(1.0 + slope * slope)
    return w, rise + slope * half * turn, slope * (1.0 + half * bend), along
