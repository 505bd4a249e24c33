"""A slider on a vibrating beam as one system of equations, by scipy's DOP853.

Hermite elements, friction by Eq. (3), the normal reaction of a bilateral slider from the acceleration of the
surface along its path, powers integrated with the motion. Of verify value types alone.
"""

from typing import NamedTuple

import numpy as np
from scipy.integrate import solve_ivp

from tests.reference.dense import CUBICS, Elements

LINES = ("work_in", "damped", "contact_on_beam", "normal_on_beam", "rubbed", "turned")
"""Of the energy balance, integrated with the motion."""


class Modes(NamedTuple):
    """Natural frequencies, rad/s, and shapes (x, derivative) -> (n,) of unit modal mass; matrices over all unknowns."""

    own: np.ndarray
    shape: object


def hermite_modes(beam, parts):
    """Modes of equal Hermite elements."""
    elements, length = Elements(beam, np.linspace(0.0, beam.length, parts + 1)), beam.length / parts
    values, vectors = elements.modes
    powers = np.arange(4)
    pieces = []  # (part, derivative): values of all modes by power of the share of the part
    for e in range(parts):
        cubics = (CUBICS.T * (1.0, length, 1.0, length)) @ vectors[2 * e : 2 * e + 4]
        derivatives = [np.polynomial.polynomial.polyder(cubics, d, scl=1 / length) for d in range(4)]
        pieces.append([np.vstack([one, np.zeros((4 - len(one), len(values)))]) for one in derivatives])

    def shape(x, derivative):
        e = min(max(int(x / length), 0), parts - 1)
        return (x / length - e) ** powers @ pieces[e][derivative]

    return Modes(np.sqrt(np.maximum(values, 0.0)), shape)


def smooth(p):
    """3 p^2 - 2 p^3 up to p = 1, then 1."""
    p = min(p, 1.0)
    return p * p * (3.0 - 2.0 * p)


def driven(modes, forces, hertz, times, *, damping=0.0, growth=lambda t: 1.0, breaks=(), start=None):
    """(q, dq/dt) of all modes under forces growth(t) F cos(omega t + phase) at the times, (n, 2 m), by DOP853.

    `breaks` are times at which the growth is not smooth.
    """
    own, n = modes.own, len(modes.own)
    loads = [(f.amplitude, np.deg2rad(f.phase_deg), modes.shape(f.position, 0)) for f in forces]

    def rates(t, y):
        push = growth(t) * sum(f * np.cos(2 * np.pi * hertz * t + turn) * load for f, turn, load in loads)
        return np.concatenate([y[n:], push - 2 * damping * own * y[n:] - own**2 * y[:n]])

    y, began, rows = np.zeros(2 * n) if start is None else start, 0.0, {0.0: start}
    for end in sorted({*breaks, *times}):
        if end > began:
            y = solve_ivp(rates, (began, end), y, method="DOP853", rtol=1e-12, atol=1e-18).y[:, -1]
            began = end
        rows[end] = y
    return np.array([rows[t] for t in times])


class Ridden(NamedTuple):
    """A slider's run: displacement, speed, modal state and energy balance at its end."""

    displacement: float
    speed: float
    q: np.ndarray
    rates: np.ndarray
    ledger: dict


def ridden(modes, forces, hertz, slider, duration, *, half, damping=0.0, soft=0.0, two_way=True):
    """A tanh slider on the beam; `half` is half the thickness, `soft` the periods over which the forces grow.

    One-way or two-way coupled, bilateral or massless, tangential or following. The material under it is at
    X = x + (h/2) w'(x); the reaction of a bilateral slider is normal to the surface, its modal forces are the
    derivatives of w(X). Its acceleration across is a central difference of its speed, linear in the reaction.
    Friction is limited by mu times the reaction of a bilateral slider where that presses, else by mu (m g + preload).
    """
    own, shape = modes
    n, omega, start = len(own), 2 * np.pi * hertz, slider.position
    held, follows = two_way and slider.normal == "bilateral", slider.kinematics == "following"
    load, slope_k = slider.mass * slider.gravity + slider.preload, slider.slope
    loads = [(f.amplitude, np.deg2rad(f.phase_deg), shape(f.position, 0)) for f in forces]

    def lifted(q, x):
        at = x + half * (q @ shape(x, 1))
        return shape(at, 0) + (q @ shape(at, 1)) * half * shape(x, 1)

    def drift(q, qd, at):
        return -(q @ shape(at, 1)) * (qd @ shape(at, 0)) if follows else 0.0

    def split(y):
        q, qd, x = y[:n], y[n : 2 * n], start + y[2 * n]
        return q, qd, x, x + half * (q @ shape(x, 1)), y[2 * n + 1]

    def across(y):
        q, qd, x, at, v = split(y)
        moved = (v + drift(q, qd, at)) * (1 + half * (q @ shape(x, 2))) + half * (qd @ shape(x, 1))
        return qd @ shape(at, 0) + (q @ shape(at, 1)) * moved

    def rates(t, y, reaction):
        q, qd, x, at, v = split(y)
        slope, rise = q @ shape(at, 1), qd @ shape(at, 0)
        along = (slope * shape(at, 0) - half * shape(at, 1)) / np.hypot(1.0, slope)
        limit = slider.mu * (max(reaction, 0.0) if held else load)
        friction = -limit * np.tanh(slope_k * (v - qd @ along))
        push = smooth(t * hertz / soft) if soft else 1.0
        push = push * sum(f * np.cos(omega * t + turn) * one for f, turn, one in loads)
        lift = lifted(q, x)
        bent = push - 2 * damping * own * qd - own**2 * q - two_way * friction * along - reaction * lift
        pull = rise * (qd @ shape(at, 1) + q @ shape(at, 2) * v) - slider.gravity * slope if follows else 0.0
        powers = [
            push @ qd,
            2 * damping * own @ qd**2,
            -friction * (along @ qd),
            -reaction * (lift @ qd),
            friction * (along @ qd - v),
            slider.mass * pull * v,
        ]
        return np.concatenate([qd, bent, [v + drift(q, qd, at), pull + friction / slider.mass], powers])

    def moved(t, y):
        if not held:
            return rates(t, y, 0.0)
        tick = 1e-4 / own.max()

        def lifted_by(reaction):
            way = tick * rates(t, y, reaction)
            return (across(y + way) - across(y - way)) / (2 * tick)

        still = lifted_by(0.0)
        for unit in (1.0, -1.0):  # friction is proportional to a reaction that presses, and vanishes where it pulls
            reaction = (load + slider.mass * still) / (1 - slider.mass * (lifted_by(unit) - still) / unit)
            if reaction * unit >= 0.0:
                break
        return rates(t, y, reaction)

    y = np.zeros(2 * n + 2 + len(LINES))
    y[2 * n + 1] = slider.speed
    if held:  # it lies on the beam that its weight bends
        for _ in range(60):
            y[:n] = -load * lifted(y[:n], start) / own**2
    grown = soft / hertz
    for begin, end in ((0.0, min(grown, duration)), (min(grown, duration), duration)):
        if end > begin:
            step = 0.03 / hertz
            y = solve_ivp(moved, (begin, end), y, method="DOP853", rtol=1e-10, atol=1e-17, max_step=step).y[:, -1]
    ledger = dict(zip(LINES, (float(one) for one in y[2 * n + 2 :]), strict=True))
    return Ridden(float(y[2 * n]), float(y[2 * n + 1]), y[:n], y[n : 2 * n], ledger)
