"""Motion in time by other means: assembled matrices and scipy's DOP853, nothing of the suite's stepping."""

from functools import lru_cache

import numpy as np
from scipy.integrate import solve_ivp

from verify.beam import Beam, PointForce

STRIP = Beam(length=0.43, width=0.017, thickness=0.0013, youngs_modulus=113e9, density=4470.0)
FREQUENCY = 1310.0
FORCES = (
    PointForce(position=0.037, amplitude=1.3, phase_deg=17.0),
    PointForce(position=0.402, amplitude=0.8, phase_deg=101.0),
)


def grown(t, soft_s):
    """3 p^2 - 2 p^3 of a start over `soft_s` seconds, then 1."""
    p = min(t / soft_s, 1.0) if soft_s else 1.0
    return p * p * (3.0 - 2.0 * p)


def linear_motion(mass, stiffness, damping, loads, times, soft_s=0.0, y0=None, growth=None):
    """M q'' + C q' + K q = sum of load F cos(omega t + phase), (len(times), n) by DOP853; loads is (n_forces, n)."""
    n, omega = len(mass), 2 * np.pi * FREQUENCY
    inverse, part = np.linalg.inv(mass), growth or (lambda t: grown(t, soft_s))

    def rates(t, y):
        push = sum(
            f.amplitude * np.cos(omega * t + np.deg2rad(f.phase_deg)) * p for f, p in zip(FORCES, loads, strict=True)
        )
        return np.concatenate([y[n:], inverse @ (part(t) * push - damping @ y[n:] - stiffness @ y[:n])])

    start = np.zeros(2 * n) if y0 is None else y0
    found = solve_ivp(rates, (0, times[-1]), start, method="DOP853", rtol=1e-11, atol=1e-16, t_eval=times)
    return found.y[:n].T


def shapes_at(basis):
    """Every mode's shape or a derivative of it at one place, (n_modes,), kept for who asks again at that place."""

    @lru_cache(maxsize=64)
    def shape(x, derivative):
        return basis.shapes(np.array([x]), derivative)[:, 0]

    return shape


def coupled_motion(basis, slider, duration, damping, soft_s=0.0, two_way=True):
    """(distance, speed) of a tanh slider and its impulse on it, beam and slider as one system of equations.

    Surface of the links or elements: u = w, -(h/2) w'; the contact acts with its lever h/2.
    """
    n, omega, half = len(basis.omegas), 2 * np.pi * FREQUENCY, 0.5 * basis.beam.thickness
    loads = [(f, basis.loads(f.position)) for f in FORCES]
    start, grip = slider.start_on(basis.beam), slider.mu * slider.normal_force

    shape = shapes_at(basis)

    def rates(t, y):
        q, qd, (travelled, v, _) = y[:n], y[n : 2 * n], y[2 * n :]
        x = start + travelled
        x = x + half * float(q @ shape(x, 1))
        rise, turn, slope, bend = qd @ shape(x, 0), qd @ shape(x, 1), q @ shape(x, 1), q @ shape(x, 2)
        along = (slope * shape(x, 0) - half * shape(x, 1)) / np.hypot(1.0, slope)
        friction = -grip * np.tanh(slider.slope * (v - qd @ along))
        push = sum(f.amplitude * np.cos(omega * t + np.deg2rad(f.phase_deg)) * p for f, p in loads)
        bent = grown(t, soft_s) * push - 2 * damping * basis.omegas * qd - basis.omegas**2 * q
        pull, drift = 0.0, 0.0
        if slider.kinematics == "following":
            pull, drift = rise * (turn + bend * v) - slider.gravity * slope, -slope * rise
        return np.concatenate(
            [qd, bent - two_way * friction * along, [v + drift, pull + friction / slider.mass, friction]]
        )

    y0 = np.zeros(2 * n + 3)
    y0[2 * n + 1] = slider.speed
    found = solve_ivp(rates, (0, duration), y0, method="DOP853", rtol=1e-11, atol=1e-18, max_step=0.02 / FREQUENCY)
    return found.y[2 * n :, -1]


def held_motion(basis, slider, duration, damping, soft_s=0.0):
    """(q, distance, speed along the beam) of a tanh slider held on the surface of a beam that carries it, DOP853.

    The slider is at (x, w(X)), X = x + (h/2) w'(x). Its acceleration across is the derivative of w(X) along the motion,
    taken by central differences of its speed across; it is linear in the reaction, which follows from two values. The
    reaction is square to the surface: it works on every mode by as much as that mode moves w(X).
    """
    n, omega, half = len(basis.omegas), 2 * np.pi * FREQUENCY, 0.5 * basis.beam.thickness
    loads = [(f, basis.loads(f.position)) for f in FORCES]
    start, follows = slider.start_on(basis.beam), slider.kinematics == "following"
    tick, pressed = 1e-4 / basis.omegas.max(), slider.normal_force
    grip = slider.mu * pressed

    shape = shapes_at(basis)

    def split(y):
        q, qd, x = y[:n], y[n : 2 * n], start + y[2 * n]
        return q, qd, x, x + half * (q @ shape(x, 1)), y[2 * n + 1]

    def lifted(q, x):
        return _lifted(shape, q, x, half)

    def along_x(y):
        q, qd, _, material, v = split(y)
        return v - (q @ shape(material, 1)) * (qd @ shape(material, 0)) * follows

    def across(y):
        q, qd, x, material, _ = split(y)
        moved = along_x(y) * (1 + half * (q @ shape(x, 2))) + half * (qd @ shape(x, 1))
        return qd @ shape(material, 0) + (q @ shape(material, 1)) * moved

    def rates(t, y, reaction):
        q, qd, x, material, v = split(y)
        rise, slope = qd @ shape(material, 0), q @ shape(material, 1)
        along = (slope * shape(material, 0) - half * shape(material, 1)) / np.hypot(1.0, slope)
        friction = -grip * np.tanh(slider.slope * (v - qd @ along))
        push = sum(f.amplitude * np.cos(omega * t + np.deg2rad(f.phase_deg)) * p for f, p in loads)
        bent = grown(t, soft_s) * push - 2 * damping * basis.omegas * qd - basis.omegas**2 * q
        pull = rise * (qd @ shape(material, 1) + q @ shape(material, 2) * v) - slider.gravity * slope
        return np.concatenate(
            [
                qd,
                bent - friction * along - reaction * lifted(q, x),
                [along_x(y), pull * follows + friction / slider.mass],
            ]
        )

    def held(t, y):
        lifts = []
        for reaction in (0.0, 1.0):
            way = tick * rates(t, y, reaction)
            lifts.append((across(y + way) - across(y - way)) / (2 * tick))
        found = (pressed + slider.mass * lifts[0]) / (1 - slider.mass * (lifts[1] - lifts[0]))
        return rates(t, y, found)

    y0 = np.zeros(2 * n + 2)
    y0[:n], y0[2 * n + 1] = _lying(basis, shape, slider, start, half), slider.speed
    found = solve_ivp(held, (0, duration), y0, method="DOP853", rtol=1e-10, atol=1e-17, max_step=0.02 / FREQUENCY)
    return found.y[:n, -1], found.y[2 * n, -1], found.y[2 * n + 1, -1]


def _lifted(shape, q, x, half):
    """How w(X), X = x + (h/2) w'(x), changes with every mode."""
    at = x + half * (q @ shape(x, 1))
    return shape(at, 0) + (q @ shape(at, 1)) * half * shape(x, 1)


def _lying(basis, shape, slider, x, half):
    """Modes of the beam at rest under the slider, whose reaction is square to its surface; each pass has 1e-3 left."""
    q = np.zeros(len(basis.omegas))
    for _ in range(40):
        q = -slider.normal_force * _lifted(shape, q, x, half)
        q /= basis.omegas**2
    return q
