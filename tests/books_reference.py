"""A heavy slider on a few Hermite elements and its energy books as one system of equations, by scipy's DOP853.

Nothing of the suite but what a scene holds: the elements written out, friction by Eq. (3), the normal
reaction of a held slider from the acceleration of the surface along its way, powers integrated with the motion.
"""

from functools import cache

import numpy as np
from scipy.integrate import solve_ivp
from scipy.linalg import eigh

from verify.scenes.scene import load_scene

PARTS = 4
FORCE, MASS, MU, SLOPE, PLACE, SPEED, ZETA, TIME, SOFT = 7.0, 0.021, 0.31, 410.0, 0.193, 1.3e-3, 0.004, 4e-4, 1.0
GRAVITY = 9.81
LINES = ("work_in", "damped", "contact_on_beam", "normal_on_beam", "rubbed")


def hermite(length):
    """The four cubics of an element and their derivatives along x, (4, 4, powers of a share of its length)."""
    cubics = [[1, 0, -3, 2], [0, length, -2 * length, length], [0, 0, 3, -2], [0, 0, -length, length]]
    table = np.zeros((4, 4, 4))
    for derivative in range(4):
        for one, powers in enumerate(cubics):
            found = np.polynomial.polynomial.polyder(powers, derivative) / length**derivative
            table[derivative, one, : len(found)] = found
    return table


def hermite_modes(beam):
    """(rad/s, function of x and derivative): modes of mass 1 of pinned Hermite elements, nodes' w and w' in a row."""
    length, line = beam.length / PARTS, beam.density * beam.width * beam.thickness
    bending = beam.youngs_modulus * beam.width * beam.thickness**3 / 12
    table, powers = hermite(length), np.arange(4)
    points, weights = np.polynomial.legendre.leggauss(4)
    mass, stiff = np.zeros((2, 2 * PARTS + 2, 2 * PARTS + 2))
    for e in range(PARTS):
        for point, weight in zip((points + 1) / 2, weights / 2, strict=True):
            here = slice(2 * e, 2 * e + 4)
            for matrix, factor, derivative in ((mass, line, 0), (stiff, bending, 2)):
                row = table[derivative] @ point**powers
                matrix[here, here] += weight * length * factor * np.outer(row, row)
    free = np.setdiff1d(np.arange(2 * PARTS + 2), [0, 2 * PARTS])
    values, vectors = eigh(stiff[np.ix_(free, free)], mass[np.ix_(free, free)])
    whole = np.zeros((2 * PARTS + 2, len(free)))
    whole[free] = vectors
    pieces = [[whole[2 * e : 2 * e + 4].T @ table[d] for d in range(4)] for e in range(PARTS)]

    def shape(x, derivative):
        e = min(int(x / length), PARTS - 1)
        xi = x / length - e
        return pieces[e][derivative] @ np.array([1.0, xi, xi * xi, xi * xi * xi])

    return np.sqrt(values), shape


def grown(t, hertz):
    """3 p^2 - 2 p^3 over the soft start."""
    p = min(t * hertz / SOFT, 1.0)
    return p * p * (3.0 - 2.0 * p)


@cache
def ridden(normal, felt=True):
    """{displacement, lines of the books} of a slider on the beam of `paper-slider`, held or massless.

    Not felt, its work is that on the moving surface.
    """
    scene = load_scene("paper-slider")
    beam, hertz = scene.beam, scene.drive.frequency_hz
    length, half, omega = beam.length, 0.5 * beam.thickness, 2 * np.pi * hertz
    own, shape = hermite_modes(beam)
    places = [(0.0116, 0.0), (length - 0.0116, np.pi / 2)]
    loads = [(turn, shape(place, 0)) for place, turn in places]
    held, limit, n = normal == "held", MU * MASS * GRAVITY, len(own)

    def lifted(q, x):
        """How w(X) at X = x + (h/2) w'(x) changes with q: the reaction is square to the surface, and does no more."""
        at = x + half * (q @ shape(x, 1))
        return shape(at, 0) + (q @ shape(at, 1)) * half * shape(x, 1)

    def contact(y):
        q, qd, x, v = y[:n], y[n : 2 * n], PLACE + y[2 * n], y[2 * n + 1]
        at = x + half * (q @ shape(x, 1))
        along = ((q @ shape(at, 1)) * shape(at, 0) - half * shape(at, 1)) / np.hypot(1.0, q @ shape(at, 1))
        return q, qd, x, v, at, along, lifted(q, x)

    def across(y):
        q, qd, x, v, at, *_ = contact(y)
        carried = v * (1 + half * (q @ shape(x, 2))) + half * (qd @ shape(x, 1))
        return qd @ shape(at, 0) + (q @ shape(at, 1)) * carried

    def rates(t, y, reaction):
        q, qd, _, v, _, along, lift = contact(y)
        friction = -limit * np.tanh(SLOPE * (v - qd @ along))
        push = FORCE * grown(t, hertz) * sum(np.cos(omega * t + turn) * load for turn, load in loads)
        forces = push - 2 * ZETA * own * qd - own**2 * q - felt * friction * along - reaction * lift
        lost = 2 * ZETA * own @ qd**2
        powers = [
            push @ qd,
            lost,
            -friction * (along @ qd),
            -reaction * (lift @ qd),
            friction * (along @ qd - v),
        ]
        return np.concatenate([qd, forces, [v, friction / MASS], powers])

    def moved(t, y):
        if not held:
            return rates(t, y, 0.0)
        lifts, tick = [], 1e-4 / own.max()
        for reaction in (0.0, 1.0):
            way = tick * rates(t, y, reaction)
            lifts.append((across(y + way) - across(y - way)) / (2 * tick))
        return rates(t, y, (MASS * GRAVITY + MASS * lifts[0]) / (1 - MASS * (lifts[1] - lifts[0])))

    y0 = np.zeros(2 * n + 2 + len(LINES))
    y0[2 * n + 1] = SPEED
    if held:  # it lies on the beam that its weight bends; the point under it as the surface has it
        for _ in range(60):
            y0[:n] = -MASS * GRAVITY * lifted(y0[:n], PLACE) / own**2
    end = solve_ivp(moved, (0, TIME), y0, method="DOP853", rtol=1e-10, atol=1e-17).y[:, -1]
    kept = dict(zip(LINES, (float(one) for one in end[2 * n + 2 :]), strict=True))
    return {"displacement": float(end[2 * n]), "slider": 0.5 * MASS * float(end[2 * n + 1] ** 2 - SPEED**2), **kept}
