"""A motor's contact by other means: exact parabolas, event-driven DOP853, springs in a row. Nothing of verify.

A mid-line moves as w(x, t); a body above it has the place x and the speed v along it, the height z across. Below it is
the material X = x + (h/2) w'(x), whose surface is at w(X) and runs along with u = (w_t w' - (h/2) w_t') / sqrt(1 + w'^2)
there. The body is pressed by `load`, its contact pushes back with k pen + c pen' while both are positive, pen = w(X) - z,
and friction drags it by u - v.
"""

from math import acos, asin, cos, exp, inf, pi, sin, sqrt, tanh
from typing import NamedTuple

import numpy as np
from scipy.integrate import solve_ivp
from scipy.optimize import brentq

TIGHT = {"method": "DOP853", "rtol": 1e-11}


# --- a mass on a surface that shakes as A sin theta; heights over A, speeds over A omega, times in radians


def next_landing(ratio, theta, speed, after=1e-7, looks=400):
    """(phase, speed of the mass) where a mass that leaves the surface at theta comes down, `after` it has left."""

    def gap(phase):
        t = phase - theta
        return sin(theta) + speed * t - 0.5 * t * t / ratio - sin(phase)

    low = theta + after
    assert gap(low) > 0.0, "it has not left"
    high = low + 2.0 * pi / looks
    while gap(high) > 0.0:
        low, high = high, high + 2.0 * pi / looks
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
    """A landing."""

    phase: float
    closing: float
    """Relative speed with which it lands, over A omega."""
    left: float
    """Phase where it leaves next; its own where it bounces."""


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
    """Re[(a e^{-ikx} + b e^{ikx}) e^{i omega t}]: what is left of a driven beam's field away from its ends."""

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
    found, *_ = np.linalg.lstsq(rows, shapes(x), rcond=None)
    return Waves(complex(found[0]), complex(found[1]), k, omega)


def felt(at, x, t, half):
    """(w, its rate for v = 0, what v adds to that, u) of the surface at x."""
    _, _, tilt, turn, bend = at(x, t)
    w, rise, slope, twist, _ = at(x + half * tilt, t)
    along = (rise * slope - half * twist) / np.sqrt(1.0 + slope * slope)
    return w, rise + slope * half * turn, slope * (1.0 + half * bend), along


# --- a point on a spring and a dashpot, on a surface or on a two-way coupled beam


class Point(NamedTuple):
    """A body with a single point of contact."""

    mass: float
    across: float
    """kg that move across."""
    load: float
    """Newton that press it on, its weight among them."""
    stiffness: float
    damping: float = 0.0
    mu: float = 0.2
    slope: float | None = None
    """Of tanh friction, s/m; Coulomb's without."""
    give: float | None = None
    """Stiffness along the surface, N/m."""
    pull: float = 0.0
    held: float | None = None
    """Prescribed speed."""
    half: float = 0.0
    load_stiffness: float = 0.0


X, V, Z, ZD, Y, PRESSED, DRAGGED, TOUCHED, STUCK = range(9)
"""Entries of the state of a body: motion, stretch along, impulses, times."""
BODY = 9


class OneWay:
    """A surface without reaction to the body."""

    beam = 0

    def __init__(self, at, half):
        self.at, self.half = at, half

    def seen(self, t, s):
        """(w, its rate for v = 0, what v adds to that, u) under the body."""
        return felt(self.at, s[X], t, self.half)

    def pushed(self, t, s, normal, along):
        """Rates of the surface's own states."""
        return ()


class Modes:
    """A two-way coupled beam of a few modes of unit mass, `shape`(place, derivative), forces F cos(omega t + phase)."""

    def __init__(self, own, shape, damping, forces, omega, half, grow=0.0):
        self.own, self.shape, self.damping, self.omega = np.asarray(own), shape, damping, omega
        self.half, self.grow = half, grow
        self.forces = [(f, phase, shape(place, 0)) for f, phase, place in forces]
        self.beam = 2 * len(own)

    def height(self, q, x):
        """Of the surface below the body at x: w(X), X = x + (h/2) w'(x)."""
        return q @ self.shape(x + self.half * (q @ self.shape(x, 1)), 0)

    def lifted(self, q, x):
        """Derivatives of the height by the modes, which are the modal forces of a unit force across."""
        here = x + self.half * (q @ self.shape(x, 1))
        return self.shape(here, 0) + (q @ self.shape(here, 1)) * self.half * self.shape(x, 1)

    def lying(self, x, load):
        """(q, deflection of the material below x) at rest under a load there."""
        q = np.zeros(len(self.own))
        for _ in range(60):
            q = -load * self.lifted(q, x) / self.own**2
        return q, self.height(q, x)

    def split(self, s):
        """(q, q_t, the body's)."""
        m = self.beam // 2
        return s[:m], s[m : 2 * m], s[2 * m :]

    def seen(self, t, s):
        """(w, its rate for v = 0, what v adds to that, u) under the body."""
        q, qd, body = self.split(s)

        def at(x, t):
            flat, tilted = self.shape(x, 0), self.shape(x, 1)
            return q @ flat, qd @ flat, q @ tilted, qd @ tilted, q @ self.shape(x, 2)

        return felt(at, body[X], t, self.half)

    def pushed(self, t, s, normal, along):
        """Rates of q and q_t under the body's reaction, which acts on the material below it."""
        q, qd, body = self.split(s)
        here = body[X] + self.half * (q @ self.shape(body[X], 1))
        flat, tilt = self.shape(here, 0), q @ self.shape(here, 1)
        dragged = (tilt * flat - self.half * self.shape(here, 1)) / np.sqrt(1.0 + tilt * tilt)
        p = min(t / self.grow, 1.0) if self.grow else 1.0
        push = p * p * (3.0 - 2.0 * p) * sum(f * cos(self.omega * t + turn) * load for f, turn, load in self.forces)
        push = push - 2.0 * self.damping * self.own * qd - self.own**2 * q
        return np.concatenate([qd, push - normal * self.lifted(q, body[X]) - along * dragged])


class Ridden(NamedTuple):
    """States (rows) at the requested times, and (time, mode) of all changes."""

    states: np.ndarray
    events: list


class Rider:
    """A Point on a surface as an ODE in pieces: free or pressed, stuck or slipping with either sign."""

    def __init__(self, point, surface):
        self.p, self.on, self.tick = point, surface, 0.0

    def force(self, t, s):
        """K pen + c pen', of either sign."""
        w, rise, tilt, _ = self.on.seen(t, s)
        b = s[self.on.beam :]
        return self.p.stiffness * (w - b[Z]) + self.p.damping * (rise + tilt * b[V] - b[ZD])

    def depth(self, t, s):
        """Pen."""
        return self.on.seen(t, s)[0] - s[self.on.beam + Z]

    def slip(self, t, s):
        """U - v."""
        return self.on.seen(t, s)[3] - s[self.on.beam + V]

    def rates(self, t, s, mode):
        """Of the state in this mode; while it sticks, with the friction that constrains it."""
        normal = self.force(t, s) if mode[0] == "pressed" else 0.0
        return self.with_friction(t, s, mode, normal, self.friction(t, s, mode, normal))

    def friction(self, t, s, mode, normal):
        """On the body."""
        if mode[0] == "free":
            return 0.0
        if self.p.give is not None:
            return self.p.give * s[self.on.beam + Y]
        if self.p.slope is not None:
            return self.p.mu * normal * tanh(self.p.slope * self.slip(t, s))
        return self.needed(t, s, normal) if mode[1] == "stuck" else mode[1] * self.p.mu * normal

    def needed(self, t, s, normal):
        """Friction that keeps u - v: its rate along the motion, by central differences, is linear in it."""
        found = []
        for force in (0.0, self.p.load):
            way = self.tick * self.with_friction(t, s, ("pressed", 1), normal, force)
            found.append(self.slip(t + self.tick, s + way) - self.slip(t - self.tick, s - way))
        return self.p.load * found[0] / (found[0] - found[1])

    def stretching(self, t, s, mode):
        """Y' of contact with give: the slip itself, or what keeps it at its limit."""
        if mode[1] == "stuck":
            return self.slip(t, s)
        return mode[1] * self.p.mu * self.force_rate(t, s) / self.p.give

    def force_rate(self, t, s):
        """Rate of k pen + c pen' along the motion under the present friction."""
        way = self.tick * self.with_friction(
            t, s, ("pressed", "stuck"), self.force(t, s), self.p.give * s[self.on.beam + Y]
        )
        return (self.force(t + self.tick, s + way) - self.force(t - self.tick, s - way)) / (2.0 * self.tick)

    def with_friction(self, t, s, mode, normal, friction):
        """Rates under known forces."""
        p, b = self.p, s[self.on.beam :]
        out = np.zeros(BODY)
        out[X], out[Z] = b[V], b[ZD]
        out[V] = 0.0 if p.held is not None else (friction + p.pull) / p.mass
        out[ZD] = (normal - p.load - p.load_stiffness * b[Z]) / p.across
        touches = mode[0] == "pressed"
        out[PRESSED], out[DRAGGED], out[TOUCHED] = normal, friction, float(touches)
        out[STUCK] = float(touches and mode[1] == "stuck")
        return np.concatenate([self.on.pushed(t, s, normal, friction), out])

    def whole(self, t, s, mode):
        """Rates with those of the stretch."""
        out = self.rates(t, s, mode)
        if mode[0] == "pressed" and self.p.give is not None:
            out[self.on.beam + Y] = self.stretching(t, s, mode)
        return out

    def entered(self, t, s):
        """The mode that a state begins in."""
        deep = self.depth(t, s)
        if deep < 0.0 or (deep == 0.0 and self.closing(t, s) <= 0.0) or self.force(t, s) < 0.0:
            return ("free", None)
        return ("pressed", self.along(t, s))

    def closing(self, t, s):
        """Pen'."""
        _, rise, tilt, _ = self.on.seen(t, s)
        return rise + tilt * s[self.on.beam + V] - s[self.on.beam + ZD]

    def along(self, t, s):
        """Stuck, or the sign of what drags it."""
        slip, normal = self.slip(t, s), max(self.force(t, s), 0.0)
        if self.p.slope is not None:
            return 1
        if self.p.give is not None:
            y, limit = s[self.on.beam + Y], self.p.mu * normal / self.p.give
            if abs(y) < limit * (1.0 - 1e-9):
                return "stuck"
            way = 1 if (y or slip) > 0.0 else -1
            outruns = way * slip > self.p.mu * self.force_rate(t, s) / self.p.give
            return way if outruns else "stuck"
        if abs(slip) > 1e-9 * self.speed or self.p.held is not None:
            return 1 if slip > 0.0 else -1
        needed = self.needed(t, s, normal)
        return "stuck" if abs(needed) <= self.p.mu * normal else (1 if needed > 0.0 else -1)

    def over(self, t, s, way):
        """Force of the stretch beyond the friction limit with a sign."""
        return way * self.p.give * s[self.on.beam + Y] - self.p.mu * self.force(t, s)

    def ends(self, mode):
        """(function of t and s, direction) of what ends a mode."""
        if mode[0] == "free":
            return [(self.depth, 1), (lambda t, s: self.force(t, s) if self.depth(t, s) > 0.0 else -1.0, 1)]
        found = [(self.force, -1)]
        if self.p.slope is not None:
            return found
        if self.p.give is not None and mode[1] == "stuck":
            return [*found, (lambda t, s: self.over(t, s, 1), 1), (lambda t, s: self.over(t, s, -1), 1)]
        if self.p.give is not None:
            way = mode[1]
            return [*found, (lambda t, s: way * self.slip(t, s) - way * self.stretching(t, s, mode), -1)]
        if mode[1] == "stuck":

            def spare(t, s):
                normal = self.force(t, s)
                return abs(self.needed(t, s, normal)) - self.p.mu * normal

            return [*found, (spare, 1)]
        return [*found, (lambda t, s: mode[1] * self.slip(t, s), -1)]

    def run(self, start, duration, at, period, max_step=0.02, rtol=1e-10):
        """States at the times `at`, from 0 to `duration`."""
        self.tick = 1e-5 * period
        self.speed = max(abs(self.on.seen(t, start)[3]) for t in np.linspace(0.0, period, 17))
        t, s, out, events = 0.0, np.array(start, dtype=float), [], []
        mode, last = self.entered(t, s), at[-1]
        while t < duration:
            ends = [self._end(end, way) for end, way in self.ends(mode)]
            found = solve_ivp(
                lambda t, s, mode=mode: self.whole(t, s, mode),
                (t, duration),
                s,
                method="DOP853",
                rtol=rtol,
                atol=1e-15,
                max_step=max_step * period,
                events=ends,
                dense_output=True,
            )
            done = found.t[-1]
            inside = [one for one in at if t <= one < done or one == done == last]
            out += [found.sol(one) for one in inside]
            t, s = done, found.y[:, -1].copy()
            if found.status == 0:
                break
            mode, s = self.next(t, s, mode, [len(hits) for hits in found.t_events])
            events.append((t, mode))
        return Ridden(np.array(out), events)

    @staticmethod
    def _end(function, way):
        def end(t, s):
            return function(t, s)

        end.terminal, end.direction = True, way
        return end

    def next(self, t, s, mode, hits):
        """(mode, state) after an end was met."""
        if mode[0] == "free":
            return ("pressed", self.along(t, s)), s
        if hits[0]:
            s[self.on.beam + Y] = 0.0
            return ("free", None), s
        if self.p.give is not None:
            return ("pressed", "stuck" if mode[1] != "stuck" else 1 if hits[1] else -1), s
        if self.p.held is not None:
            return ("pressed", -mode[1]), s
        needed = self.needed(t, s, self.force(t, s))
        if mode[1] == "stuck":
            return ("pressed", 1 if needed > 0.0 else -1), s
        return ("pressed", "stuck" if abs(needed) <= self.p.mu * self.force(t, s) else -mode[1]), s


class Resting(Rider):
    """A Point on a hard contact that it never leaves: N = load + m times the acceleration of the surface below it."""

    def force(self, t, s):
        """N."""
        rates = []
        for side in (1.0, -1.0):
            there = s.copy()
            there[X] += side * self.tick * s[V]
            _, rise, tilt, _ = self.on.seen(t + side * self.tick, there)
            rates.append(rise + tilt * s[V])
        return self.p.load + self.p.across * (rates[0] - rates[1]) / (2.0 * self.tick)

    def depth(self, t, s):
        """It never leaves."""
        return 1.0


def body(x=0.0, v=0.0, z=0.0, zd=0.0, beam=0):
    """A state with these, all else nought."""
    s = np.zeros(beam + BODY)
    s[beam + X], s[beam + V], s[beam + Z], s[beam + ZD] = x, v, z, zd
    return s


# --- a rigid foot of several points


class Foot(NamedTuple):
    """Points on springs below a rigid foot at a prescribed speed, which moves across and rotates."""

    mass: float
    inertia: float
    load: float
    stiffness: float
    """N/m, of all points together."""
    places: np.ndarray
    """Of its points from its middle, metres."""
    damping: float = 0.0
    mu: float = 0.2
    speed: float = 0.0
    half: float = 0.0
    pitches: bool = True


def cells(length, n):
    """Middles of n equal cells."""
    return length * ((np.arange(n) + 0.5) / n - 0.5)


def foot_ridden(foot, waves, x, start, times, rtol=1e-9, max_step=np.inf):
    """Rows z, z_t, theta, theta_t, impulses of N and of Coulomb's friction, points' time in contact over their number."""
    n, s = len(foot.places), foot.places

    def rates(t, y):
        at = x + foot.speed * t + s
        w, rise, tilt, u = felt(waves.at, at, t, foot.half)
        pen = w - y[0] - y[2] * s
        closing = rise + tilt * foot.speed - y[1] - y[3] * s
        push = (foot.stiffness * pen + foot.damping * closing) / n
        push = np.where(pen > 0.0, np.maximum(push, 0.0), 0.0)
        drag = foot.mu * push * np.sign(u - foot.speed)
        turned = push @ s / foot.inertia if foot.pitches else 0.0
        return [
            y[1],
            (push.sum() - foot.load) / foot.mass,
            y[3],
            turned,
            push.sum(),
            drag.sum(),
            np.mean(push > 0.0),
        ]

    y0 = np.concatenate([start, np.zeros(3)])
    found = solve_ivp(
        rates, (0.0, times[-1]), y0, method="DOP853", rtol=rtol, atol=1e-16, t_eval=times, max_step=max_step
    )
    return found.y.T


# --- springs in a row under a slider at a prescribed speed, on crests cos s


def lain_on(depths, load):
    """Height at which springs that would be compressed by `depths` at height nought carry `load` in the mean: exact."""
    ordered = np.sort(depths)[::-1]
    heights = (np.cumsum(ordered) - load * len(depths)) / np.arange(1, len(depths) + 1)
    below = np.append(ordered[1:], -inf)
    return heights[np.argmax(heights >= below)]


def row_of_springs(n, r, epsilon, steps, height):
    """Mean F/(mu N) over a period of n springs on a wavelength at r times the crest speed, `height` over A.

    Stretch by return mapping in `steps` of a period, over V/omega; epsilon = 0 is Coulomb's. The wave moves each spring
    by cos(s - tau).
    """
    place, step = (np.arange(n) + 0.5) * 2.0 * pi / n, 2.0 * pi / steps
    stretch, dragged, pressed, before = np.zeros(n), 0.0, 0.0, np.cos(place) - height
    for i in range(1, 2 * steps + 1):  # the first period damps the start
        top = np.cos(place - step * i)
        deep = top - height
        pen = np.maximum(deep, 0.0)
        if epsilon:
            passed = np.sin(place - step * (i - 1)) - np.sin(place - step * i) - r * step
            touched = np.where(before < 0.0, pen / np.maximum(deep - before, 1e-300), 1.0)  # of the step it lands in
            stretch = np.clip(stretch + touched * passed, -epsilon * pen, epsilon * pen)
            drag = stretch / epsilon
        else:
            drag = pen * np.sign(top - r)
        before = deep
        if i > steps:
            dragged, pressed = dragged + drag.sum(), pressed + pen.sum()
    return dragged / pressed
