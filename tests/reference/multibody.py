"""The nonlinear chain in absolute angles or joint displacements, dense, closed by multipliers, integrated by DOP853.

Links are straight bars with their mass at the middle and their rotary inertia; x along the straight chain, y across.
Of verify only the numbers of a chain are read.
"""

import numpy as np
from scipy.integrate import solve_ivp
from scipy.interpolate import CubicSpline
from scipy.optimize import brentq
from scipy.special import ellipe, ellipeinc, ellipk, ellipkinc


def reach_of(system, link, at):
    """Distances of a point from the joints before it along the links: its y is reach @ sin(theta)."""
    reach = np.zeros(system.n_links)
    reach[: link - 1] = system.lengths[: link - 1]
    reach[link - 1] = at
    return reach


def held(system):
    """(reach, y'' required) of the roller."""
    return [(reach_of(system, system.n_links, system.lengths[-1]), 0.0)] if system.tip == "roller" else []


def equations(system, t, angles, rates):
    """Mass matrix, generalised forces less the inertia of the present rates, constraint rows and their right sides."""
    n = system.n_links
    theta, w = system.hub_rate * t + np.cumsum(angles), system.hub_rate + np.cumsum(rates)
    c, s = np.cos(theta), np.sin(theta)
    moments = -system.stiffness * angles - system.dashpots * rates
    force = moments - np.append(moments[1:], 0.0)
    mass = np.diag(system.inertias.astype(float))
    for i in range(n):
        middle = reach_of(system, i + 1, system.lengths[i] / 2)
        along, across = -middle * s, middle * c
        force += system.masses[i] * (system.gravity[0] * along + system.gravity[1] * across)
        for felt, gradient, bend in ((system.axial_inertia, along, -middle * c), (True, across, -middle * s)):
            if felt:
                mass += system.masses[i] * np.outer(gradient, gradient)
                force -= system.masses[i] * gradient * (bend @ w**2)
    for load in system.loads:
        now = np.cos(2 * np.pi * load.frequency_hz * t + np.deg2rad(load.phase_deg))
        reach = reach_of(system, load.link, load.at)
        force += now * (load.force[1] * reach * c - load.force[0] * reach * s)
        force[load.link - 1] += now * load.moment
    stretch = system.lengths @ (c - 1.0)
    force -= system.axial_spring * stretch * (-system.lengths * s)
    rows = [reach * c for reach, _ in held(system)]
    right = [wanted + reach @ (s * w**2) for reach, wanted in held(system)]
    return mass, force, np.array(rows).reshape(len(rows), n), np.array(right)


def by_multipliers(system, t, angles, rates):
    """Relative accelerations from the bordered system [[M, G^T], [G, 0]]."""
    mass, force, rows, right = equations(system, t, angles, rates)
    n, m = len(force), len(rows)
    bordered = np.block([[mass, rows.T], [rows, np.zeros((m, m))]])
    return relative(system, t, np.linalg.solve(bordered, np.append(force, right))[:n])


def relative(system, t, accelerations):
    return np.diff(accelerations, prepend=0.0)


def elastica_tip(load):
    """(w/L, 1 - x/L) of a cantilever under a dead transverse tip load PL^2/EI, by elliptic integrals.

    K. E. Bisshopp and D. C. Drucker, Quart. Appl. Math. 3 (1945) 272.
    """
    alpha = np.sqrt(load)

    def angle(p):
        return np.arcsin(1 / (p * np.sqrt(2)))

    p = brentq(lambda p: ellipk(p**2) - ellipkinc(angle(p), p**2) - alpha, np.sqrt(0.5) + 1e-15, 1 - 1e-12, xtol=1e-15)
    deflection = 1 - 2 / alpha * (ellipe(p**2) - ellipeinc(angle(p), p**2))
    return deflection, 1 - np.sqrt(2) / alpha * np.sqrt(2 * p**2 - 1)


def rigid_motion(system, duration):
    """T -> (heights of the joints, their rates, the joints' speeds along x), from rest by DOP853 on the multipliers."""
    n = system.n_links

    def rates(t, y):
        return np.concatenate([y[n:], by_multipliers(system, t, y[:n], y[n:])])

    found = solve_ivp(
        rates, (0.0, duration), np.zeros(2 * n), method="DOP853", rtol=1e-10, atol=1e-14, dense_output=True
    )

    def seen(t):
        theta, spin = np.cumsum(found.sol(t).reshape(2, n), axis=1)
        parts = np.sin(theta), np.cos(theta) * spin, -np.sin(theta) * spin
        return tuple(np.append(0.0, np.cumsum(system.lengths * part)) for part in parts)

    return seen


def stretching_motion(system, axial, duration):
    """The same of links that stretch by `axial` = EA: joints' displacements, springs along and between the links."""
    n, lengths = system.n_links, system.lengths
    spin = system.inertias / lengths**2
    mass = np.zeros((n + 1, n + 1))
    for i in range(n):
        own, shared = system.masses[i] / 4 + spin[i], system.masses[i] / 4 - spin[i]
        mass[i : i + 2, i : i + 2] += [[own, shared], [shared, own]]
    free = [np.arange(1, n + 1), np.arange(1, n) if system.tip == "roller" else np.arange(1, n + 1)]
    inverse = [np.linalg.inv(mass[np.ix_(part, part)]) for part in free]

    def forces(t, u):
        step = np.diff(u, axis=0)
        along = step + np.stack([lengths, 0 * lengths], axis=1)
        stretched = np.hypot(*along.T)
        longer = (2 * lengths * step[:, 0] + (step**2).sum(axis=1)) / (stretched + lengths)
        tangent = along / stretched[:, None]
        turn = np.diff(np.arctan2(along[:, 1], along[:, 0]), prepend=0.0) * system.stiffness
        moment = (turn - np.append(turn[1:], 0.0)) / stretched
        pull = (axial / lengths * longer)[:, None] * tangent
        pull = pull + moment[:, None] * np.stack([-tangent[:, 1], tangent[:, 0]], axis=1)
        found = np.zeros((n + 1, 2))
        found[:-1] += pull
        found[1:] -= pull
        for load in system.loads:
            now = np.cos(2 * np.pi * load.frequency_hz * t + np.deg2rad(load.phase_deg)) * np.array(load.force)
            share = load.at / lengths[load.link - 1]
            found[load.link - 1] += (1 - share) * now
            found[load.link] += share * now
        return found

    def rates(t, y):
        u, v = y.reshape(2, n + 1, 2)
        pushed, a = forces(t, u), np.zeros((n + 1, 2))
        for axis in range(2):
            a[free[axis], axis] = inverse[axis] @ pushed[free[axis], axis]
        return np.concatenate([v.ravel(), a.ravel()])

    start = np.zeros(4 * (n + 1))
    found = solve_ivp(rates, (0.0, duration), start, method="DOP853", rtol=1e-9, atol=1e-14, dense_output=True)

    def seen(t):
        u, v = found.sol(t).reshape(2, n + 1, 2)
        return u[:, 1], v[:, 1], v[:, 0]

    return seen


def ridden(system, seen, slider, half, duration, max_step=1e-6):
    """(displacement, speed, work of friction at the slider) of a tanh slider on equal links between hinges, by DOP853.

    The surface is a natural cubic spline through y + delta^2 y / 12; the material under x stands at x + h/2 w'(x), and
    goes along with the link's own point there.
    """
    nodes, start = np.append(0.0, np.cumsum(system.lengths)), slider.position
    piece = int(np.searchsorted(nodes, start, side="right") - 1)
    joints = np.eye(len(nodes))
    joints[:, 1:-1] += np.diff(np.eye(len(nodes)), 2, axis=1) / 12
    line = CubicSpline(nodes, joints, axis=1, bc_type="natural").c[::-1, piece]

    def rates(t, y):
        gone, v, _ = y
        heights, rises, drawn = seen(t)
        a, b = line @ heights, line @ rises
        s = start + gone - nodes[piece]
        share = s / system.lengths[piece]
        carried = (1.0 - share) * drawn[piece] + share * drawn[piece + 1]
        s = s + half * (a[1] + 2 * a[2] * s + 3 * a[3] * s**2)
        slope, bend = a[1] + 2 * a[2] * s + 3 * a[3] * s**2, 2 * a[2] + 6 * a[3] * s
        rise, turn = b[0] + b[1] * s + b[2] * s**2 + b[3] * s**3, b[1] + 2 * b[2] * s + 3 * b[3] * s**2
        surface = (rise * slope - half * turn) / np.hypot(1, slope) + carried
        friction = -slider.mu * slider.normal_force * np.tanh(slider.slope * (v - surface))
        pull, drift = 0.0, 0.0
        if slider.kinematics == "following":
            pull, drift = rise * (turn + bend * v) - slider.gravity * slope, -slope * rise
        return [v + drift, pull + friction / slider.mass, friction * v]

    y0 = [0.0, slider.speed, 0.0]
    found = solve_ivp(rates, (0.0, duration), y0, method="DOP853", rtol=1e-10, atol=1e-16, max_step=max_step)
    return found.y[:, -1]
