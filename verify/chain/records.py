"""What the compiled kernels of the planar chain see, by name. SI; frozen but for the arrays in it."""

from typing import NamedTuple

import numpy as np

from verify.arrays import Array, Indices

FREE, ROLLER = 0, 1
"""Kinds of tip."""
WORK_COLUMNS = 20
HALF, MASS, INERTIA, SPRING, DASHPOT, MOBILITY = range(6)
"""Columns of `Flat.links`."""
RUNNING, DONE, DIVERGED, TOO_SMALL = 0, 1, 2, 3
"""What `march` returns."""


class Flat(NamedTuple):
    """A chain as the kernels see it: few arrays, because every call hands all of them on. SI."""

    links: Array
    """(N, 10): half length, mass, inertia, joint spring, dashpot, and the columns of `mobilities`."""
    numbers: Array
    """(7,): offset, rate, amplitude, circular frequency and phase of the base's rotation; gravity along x and y."""
    loads: Array
    """(n_loads, 7): arm from the link's middle, F_x, F_y, moment, circular frequency, phase, link from 0."""
    held: Array
    """(n_held, 5), the roller first: arm, amplitude, circular frequency, phase of the y prescribed, link from 0."""
    small: Array
    """(n_held, n_held + 1), scratch."""
    tip: int
    """FREE or ROLLER."""
    tip_spring: float
    """N/m, axial, at the roller."""
    axial: bool
    """Whether the links have inertia along x."""
    ledger: bool
    """Whether the power of loads is worth a pass of its own."""


def mobilities(half: Array, masses: Array, inertias: Array) -> Array:
    """What one link answers to forces at its joints, (N, 5): 1/m, 1/J, h/J, h^2/J + 1/m, h^2/J - 1/m."""
    a, spin = 1.0 / masses, 1.0 / inertias
    return np.stack([a, spin, half * spin, half**2 * spin + a, half**2 * spin - a], axis=1)


class March(NamedTuple):
    """An explicit Runge-Kutta run as the kernels see it: its method, its state and what it keeps."""

    a: Array
    """(s + 1, s), the last row the answer."""
    c: Array
    """(s,)."""
    weights: Array
    """(s + 1,), of the error estimate; empty for a fixed step."""
    order: float
    y: Array
    """(2N + 2,): angles, rates, energy lost, work put in."""
    new: Array
    """(2N + 2,), scratch."""
    k: Array
    """(s + 1, 2N + 2); k[0] holds the rates at y."""
    clock: Array
    """(3,): time, step, and the share of the longest lever arm below which a dependent angle is exchanged."""
    counts: Indices
    """(5,): steps, rejected steps, evaluations, samples kept, exchanges."""
    samples: Array
    """(n,), times to keep."""
    kept: Array
    """(n, 2N + 2)."""
    scale: Array
    """(6,): relative tolerance, absolute ones of angles and rates, largest so far: means of both, turn of a link."""
    pivots: Indices
    """(n_held,), dependent angles."""


def idle(n_links: int) -> March:
    """A run of no step and no sample, whose k[0] holds the rates at y."""
    size = 2 * n_links + 2
    return March(
        a=np.zeros((1, 1)),
        c=np.zeros(1),
        weights=np.zeros(0),
        order=1.0,
        y=np.zeros(size),
        new=np.zeros(size),
        k=np.zeros((1, size)),
        clock=np.zeros(3),
        counts=np.zeros(5, dtype=np.int64),
        samples=np.zeros(0),
        kept=np.zeros((0, size)),
        scale=np.zeros(6),
        pivots=np.zeros(0, dtype=np.int64),
    )


class Elastic(NamedTuple):
    """A chain of stretching links as the kernels see it. SI."""

    links: Array
    """(N, 5): length, mass, EA / l, joint spring, dashpot."""
    loads: Array
    """(n_loads, 7): share of the link's length, F_x, F_y, moment, circular frequency, phase, link from 0."""
    gravity: Array
    """(2,)."""
    factors: Array
    """(N + 1, 2, 2): of the mass matrix over joints, for x and y: coupling to the joint before, reciprocal pivot."""
