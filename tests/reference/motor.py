"""Contact of a motor by other means than the engine: exact parabolas, DOP853 from event to event. Nothing of verify.

A mid-line moves as w(x, t); a body above it has the place x and the speed v along it, the height z across. Below it is
the material X = x + (h/2) w'(x), whose surface is at w(X) and runs along with u = (w_t w' - (h/2) w_t') / sqrt(1 + w'^2).
The body is pressed by `load`, its contact pushes back with k pen + c pen' while both are positive, pen = w(X) - z,
and friction drags it by u - v.
"""

from math import acos, asin, cos, exp, inf, pi, sin, sqrt, tanh
from typing import NamedTuple

import numpy as np
from scipy.integrate import solve_ivp
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


class OneWay:
    """A surface without reaction to the body."""

    beam = 0

    def __init__(self, at, half):
        self.at, self.half = at, half

    def below(self, t, s):
        """The surface below the body."""
        return surface(self.at, s[X], t, self.half)

    def pushed(self, t, s, normal, along):
        """Rates of the states of the surface itself: none."""
        return ()


# --- a body with a single point of contact


class Point(NamedTuple):
    """Mass in kg, the load that presses it on in N with its weight, stiffnesses across and along in N/m.

    `slope` is K of tanh friction, s/m, Coulomb's without; `prescribed` a speed, m/s.
    """

    mass: float
    load: float
    stiffness: float
    damping: float = 0.0
    mu: float = 0.2
    slope: float | None = None
    give: float | None = None
    pull: float = 0.0
    prescribed: float | None = None
    load_stiffness: float = 0.0


X, V, Z, ZD, Y, PRESSED, DRAGGED, TOUCHED, STUCK = range(9)
"""Entries of the state of a body: motion, stretch along, impulses, times."""
FREE, STICKS = None, 0
"""Modes; while the body slips, the mode is +1 or -1, the direction of friction on it."""


def body(x, v=0.0, z=0.0, q=()):
    """A state with these, on a beam with modal displacements q, all else nought."""
    s = np.zeros(2 * len(q) + 9)
    s[: len(q)], s[2 * len(q) + np.array([X, V, Z])] = q, (x, v, z)
    return s


class Rider:
    """A Point on a surface as an ODE in pieces: free or pressed, stuck or slipping with either sign."""

    def __init__(self, point, on):
        self.p, self.on = point, on

    def force(self, t, s):
        """K pen + c pen', of either sign."""
        w, rise, tilt, _ = self.on.below(t, s)
        b = s[self.on.beam :]
        return self.p.stiffness * (w - b[Z]) + self.p.damping * (rise + tilt * b[V] - b[ZD])

    def depth(self, t, s):
        """Pen."""
        return self.on.below(t, s)[0] - s[self.on.beam + Z]

    def slip(self, t, s):
        """U - v."""
        return self.on.below(t, s)[3] - s[self.on.beam + V]

    def rates(self, t, s, mode, friction=None):
        """Rates of the state in a mode; under a known friction, those without the stretch."""
        p, b, out = self.p, s[self.on.beam :], np.zeros(9)
        touches = mode is not FREE
        normal = self.force(t, s) if touches else 0.0
        if friction is None:
            friction = self.friction(t, s, normal, mode) if touches else 0.0
            out[Y] = self.stretching(t, s, mode) if touches and p.give is not None else 0.0
        out[X], out[Z] = b[V], b[ZD]
        out[V] = 0.0 if p.prescribed is not None else (friction + p.pull) / p.mass
        out[ZD] = (normal - p.load - p.load_stiffness * b[Z]) / p.mass
        out[PRESSED], out[DRAGGED], out[TOUCHED], out[STUCK] = normal, friction, touches, mode == STICKS
        return np.concatenate([self.on.pushed(t, s, normal, friction), out])

    def friction(self, t, s, normal, mode):
        """Friction on the body in contact."""
        if self.p.give is not None:
            return self.p.give * s[self.on.beam + Y]
        if self.p.slope is not None:
            return self.p.mu * normal * tanh(self.p.slope * self.slip(t, s))
        return self.needed(t, s) if mode == STICKS else mode * self.p.mu * normal

    def along(self, function, t, s, friction):
        """Rate of a function of t and s along the motion in contact, by a central difference."""
        way = self.tick * self.rates(t, s, 1, friction)
        return (function(t + self.tick, s + way) - function(t - self.tick, s - way)) / (2.0 * self.tick)

    def needed(self, t, s):
        """The friction that keeps u - v, whose rate is linear in it."""
        alone, loaded = (self.along(self.slip, t, s, friction) for friction in (0.0, self.p.load))
        return self.p.load * alone / (alone - loaded)

    def sticks(self, t, s, otherwise):
        """The mode without slip: it sticks if friction suffices."""
        return STICKS if abs(self.needed(t, s)) <= self.p.mu * self.force(t, s) else otherwise

    def limit_rate(self, t, s):
        """Rate of the stretch at its limit mu N / give."""
        return self.p.mu * self.along(self.force, t, s, self.p.give * s[self.on.beam + Y]) / self.p.give

    def stretching(self, t, s, mode):
        """Y' of a contact that gives way: the slip itself, or the rate of its limit."""
        return self.slip(t, s) if mode == STICKS else mode * self.limit_rate(t, s)

    def pressed(self, t, s):
        """The mode at the start and after a landing."""
        slip = self.slip(t, s)
        way = 1 if slip > 0.0 else -1
        if self.p.give is not None:
            return STICKS if self.force(t, s) > 0.0 or way * slip <= self.limit_rate(t, s) else way
        return way if slip or self.p.slope is not None else STICKS

    def ends(self, mode):
        """(function of t and s, direction of its change of sign, next mode by t and s) of all ends of a mode."""
        p = self.p
        if mode is FREE:
            return [(lambda t, s: min(self.force(t, s), self.depth(t, s)), 1, self.pressed)]
        found = [(self.force, -1, lambda t, s: FREE)]
        if p.give is not None and mode == STICKS:
            for way in (1, -1):
                excess = lambda t, s, way=way: way * p.give * s[self.on.beam + Y] - p.mu * self.force(t, s)  # noqa: E731
                found.append((excess, 1, lambda t, s, way=way: way))
        elif p.give is not None:
            found.append((lambda t, s: mode * self.slip(t, s) - self.limit_rate(t, s), -1, lambda t, s: STICKS))
        elif p.slope is None and mode == STICKS:
            spare = lambda t, s: p.mu * self.force(t, s) - abs(self.needed(t, s))  # noqa: E731
            found.append((spare, -1, lambda t, s: 1 if self.needed(t, s) > 0.0 else -1))
        elif p.slope is None:
            found.append((lambda t, s: mode * self.slip(t, s), -1, lambda t, s: self.sticks(t, s, -mode)))
        return found

    def run(self, start, times, period, rtol=1e-10):
        """(states at the times, (time, mode) of all changes)."""
        self.tick, t, s, states, events = 1e-5 * period, 0.0, start, [], []
        mode = self.pressed(t, s)
        given = {"method": "DOP853", "rtol": rtol, "atol": 1e-15, "max_step": 0.02 * period}
        while True:
            ends = self.ends(mode)
            signals = [_terminal(*end[:2]) for end in ends]
            rates, left = (lambda t, s, mode=mode: self.rates(t, s, mode)), times[times > t]
            found = solve_ivp(rates, (t, times[-1]), s, t_eval=left, events=signals, **given)
            states += list(np.transpose(found.y))
            if found.status == 0:
                return np.array(states), events
            hit = next(i for i, hits in enumerate(found.t_events) if len(hits))
            t, s = found.t_events[hit][-1], found.y_events[hit][-1].copy()
            mode = ends[hit][2](t, s)
            if mode is FREE:
                s[self.on.beam + Y] = 0.0
            events.append((t, mode))


def _terminal(function, direction):
    def end(t, s):
        return function(t, s)

    end.terminal, end.direction = True, direction
    return end


# --- a rigid foot of several points


class Foot(NamedTuple):
    """Points `places` from the middle of a rigid foot, on springs of `stiffness` together; it moves across and rotates."""

    mass: float
    inertia: float
    load: float
    stiffness: float
    places: np.ndarray
    damping: float = 0.0
    mu: float = 0.2
    speed: float = 0.0
    half: float = 0.0
    pitches: bool = True

    def run(self, waves, x, height, times):
        """Rows z, z_t, theta, theta_t, impulses of N and of Coulomb's friction, points' mean time in contact."""

        def rates(t, y):
            w, rise, tilt, u = surface(waves.at, x + self.speed * t + self.places, t, self.half)
            pen = w - y[0] - y[2] * self.places
            closing = rise + tilt * self.speed - y[1] - y[3] * self.places
            push = (self.stiffness * pen + self.damping * closing) / len(self.places)
            push = np.where(pen > 0.0, np.maximum(push, 0.0), 0.0)
            drag = self.mu * push * np.sign(u - self.speed)
            turned = push @ self.places / self.inertia if self.pitches else 0.0
            risen = (push.sum() - self.load) / self.mass
            return [y[1], risen, y[3], turned, push.sum(), drag.sum(), np.mean(push > 0.0)]

        given = {"method": "DOP853", "rtol": 1e-8, "atol": 1e-16, "max_step": 0.1 * pi / waves.omega}
        return solve_ivp(rates, (0.0, times[-1]), [height, *np.zeros(6)], t_eval=times, **given).y.T


def cells(length, n):
    """Middles of n equal cells."""
    return length * ((np.arange(n) + 0.5) / n - 0.5)


def height_under(depths, load):
    """Height at which springs that would be compressed by `depths` at height nought carry `load` in the mean: exact."""
    ordered = np.sort(depths)[::-1]
    heights = (np.cumsum(ordered) - load * len(depths)) / np.arange(1, len(depths) + 1)
    return heights[np.argmax(heights >= np.append(ordered[1:], -inf))]
