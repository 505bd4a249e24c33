"""Acceleration of the chain of links that stretch (EA / l), for the march of `runge_kutta`: a beam's axial inertia.

The motion of a uniformly stretching link is linear in its joints: the mass matrix is constant, tridiagonal and equal
for x and y, without unknown joint forces. Coordinates are the displacements of joints 0..N from the straight chain,
alternating x and y, so that small stretches have no cancellation.
"""

import numpy as np

from verify.arrays import Array
from verify.chain.runge_kutta import ACCELERATION, Model
from verify.chain.system import ChainSystem
from verify.jit import inline, jit
from verify.segments.chain import joint_masses

LENGTH, MASS, AXIAL, SPRING, DASHPOT, FACTOR = range(6)
"""Columns of `links`, (N + 1, 9): data of link i; factor of L and reciprocal pivot of joint i for x and y."""


@inline(fastmath={"contract"})
def strain(links: Array, i: int, u: Array) -> tuple[float, float, float, float]:
    """(length, cosine, sine, stretch) of a link."""
    length, dx, dy = links[i, LENGTH], u[2 * i + 2] - u[2 * i], u[2 * i + 3] - u[2 * i + 1]
    now = np.sqrt((length + dx) ** 2 + dy * dy)
    return now, (length + dx) / now, dy / now, (dx * (2.0 * length + dx) + dy * dy) / (now + length)


@inline(fastmath={"contract"})
def twist(force: Array, i: int, now: float, c: float, s: float, moment: float) -> None:
    """Add a moment on a link as transverse forces at its joints."""
    x, y = moment / now * s, moment / now * c
    force[2 * i] += x
    force[2 * i + 1] -= y
    force[2 * i + 2] -= x
    force[2 * i + 3] += y


@jit(signature_or_function=ACCELERATION, no_cfunc_wrapper=False, fastmath={"contract"})
def accelerate(t: float, y: Array, out: Array, model: Model) -> None:
    """Accelerations of joints 0..N into out[2 N + 2:], zero at bilateral supports (see `runge_kutta`)."""
    links, loads, gravity, _, _ = model
    n, size = links.shape[0] - 1, 2 * links.shape[0]
    u, v, force = y[:size], y[size:], out[size:]
    for j in range(size):
        force[j] = 0.0
    old_now, old_c, old_s, old_rate = 1.0, 1.0, 0.0, 0.0
    for i in range(n):
        now, c, s, stretch = strain(links, i, u)
        rate = (c * (v[2 * i + 3] - v[2 * i + 1]) - s * (v[2 * i + 2] - v[2 * i])) / now
        bend = np.arctan2(old_c * s - old_s * c, old_c * c + old_s * s)
        moment = links[i, SPRING] * bend + links[i, DASHPOT] * (rate - old_rate)
        pull, weight = links[i, AXIAL] * stretch, 0.5 * links[i, MASS]
        force[2 * i] += pull * c + weight * gravity[0]
        force[2 * i + 1] += pull * s + weight * gravity[1]
        force[2 * i + 2] += weight * gravity[0] - pull * c
        force[2 * i + 3] += weight * gravity[1] - pull * s
        twist(force, i, now, c, s, -moment)
        if i > 0:
            twist(force, i - 1, old_now, old_c, old_s, moment)
        old_now, old_c, old_s, old_rate = now, c, s, rate
    for k in range(loads.shape[0]):
        i, load = int(loads[k, 6]), np.cos(loads[k, 4] * t + loads[k, 5])
        for end in range(2):
            part = load * (loads[k, 0] if end else 1.0 - loads[k, 0])
            force[2 * (i + end)] += part * loads[k, 1]
            force[2 * (i + end) + 1] += part * loads[k, 2]
        now, c, s, _ = strain(links, i, u)
        twist(force, i, now, c, s, load * loads[k, 3])
    for axis in range(2):
        column = FACTOR + 2 * axis
        for j in range(1, n + 1):
            force[2 * j + axis] -= links[j, column] * force[2 * j - 2 + axis]
        for j in range(n + 1):
            force[2 * j + axis] *= links[j, column + 1]
        for j in range(n - 1, -1, -1):
            force[2 * j + axis] -= links[j + 1, column] * force[2 * j + 2 + axis]


def flatten(system: ChainSystem) -> Model:
    """The data of `accelerate`; its numbers are the components of gravity."""
    n, lengths = system.n_links, system.lengths
    loads = system.load_table
    loads[:, 0] /= lengths[loads[:, 6].astype(int)]
    links = np.zeros((n + 1, 9))
    springs = system.axial_stiffness / lengths
    links[:-1, :FACTOR] = np.stack([lengths, system.masses, springs, system.stiffness, system.dashpots], axis=1)
    # L D L^T of the mass matrix, with reciprocal pivot 0 at a fixed joint
    diagonal, coupling = joint_masses(system.masses, system.inertias, lengths)
    for axis in range(2):
        reciprocal, fixed = 0.0, axis == 1 and system.tip == "roller"
        for j in range(1, n + 1):
            factor = coupling[j - 1] * reciprocal
            reciprocal = 0.0 if fixed and j == n else 1.0 / (diagonal[j] - factor * coupling[j - 1])
            links[j, FACTOR + 2 * axis : FACTOR + 2 * axis + 2] = factor, reciprocal
    return Model(links, loads, np.array(system.gravity, float), np.zeros((1, 1)), np.zeros((1, 1)))
