"""Positions, velocities and energies of a nonlinear chain at one or many times, and projection onto its roller."""

from typing import NamedTuple

import numpy as np

from verify.arrays import Array
from verify.chain.system import ChainState, ChainSystem
from verify.errors import InputError


class Positions(NamedTuple):
    """Kinematics of the links; leading dimensions are times."""

    directions: Array  # (..., N), absolute angles, rad
    rates: Array  # (..., N), angular velocities, rad/s
    joints: Array  # (..., N + 1, 2), m
    velocities: Array  # (..., N + 1, 2), m/s


def place(system: ChainSystem, times: float | Array, angles: Array, rates: Array) -> Positions:
    """Kinematics of the links from relative angles and rates, (..., N), at times (...)."""
    angle, rate = system.hub(times)
    directions, spins = np.cumsum(angles, axis=-1) + angle[..., None], np.cumsum(rates, axis=-1) + rate[..., None]
    c, s = np.cos(directions), np.sin(directions)
    joints = np.zeros((*directions.shape[:-1], system.n_links + 1, 2))
    velocities = np.zeros_like(joints)
    np.cumsum(system.lengths[:, None] * np.stack([c, s], axis=-1), axis=-2, out=joints[..., 1:, :])
    swings = (system.lengths * spins)[..., None] * np.stack([-s, c], axis=-1)
    np.cumsum(swings, axis=-2, out=velocities[..., 1:, :])
    return Positions(directions, spins, joints, velocities)


def project(system: ChainSystem, state: ChainState) -> ChainState:
    """The state with the tip on its roller.

    One joint angle depends on the others, that with the longest lever arm: the links beyond it turn as one, and their
    rate cancels the tip's across. Raises InputError where they do not reach the roller.
    """
    q, v = (np.array(values, dtype=float) for values in (state.angles, state.rates))
    if system.tip == "free":
        return ChainState(q, v, state.time)
    joints = place(system, state.time, q, v).joints
    pivot = int(np.argmax(abs(joints[-1, 0] - joints[:-1, 0])))
    x, y = joints[-1] - joints[pivot]
    sine = -joints[pivot, 1] / np.hypot(x, y)
    if not abs(sine) < 1.0:
        raise InputError(f"state.angles: joint {pivot + 1} cannot turn the tip onto the roller, give a nearer state")
    turn = (np.arcsin(sine) if x > 0.0 else np.pi - np.arcsin(sine)) - np.arctan2(y, x)
    turn -= 2.0 * np.pi * np.round(turn / (2.0 * np.pi))
    q[pivot] += turn
    placed = place(system, state.time, q, v)
    v[pivot] -= placed.velocities[-1, 1] / (placed.joints[-1, 0] - placed.joints[pivot, 0])
    return ChainState(q, v, state.time)


def at_rest(system: ChainSystem, angles: Array | None = None) -> ChainState:
    """A state at rest relative to the hub with `angles` (default: straight), projected onto the roller."""
    still = np.zeros(system.n_links)
    return project(system, ChainState(still if angles is None else angles, still))


def energies(system: ChainSystem, times: Array, angles: Array, rates: Array) -> Array:
    """Kinetic, elastic (joints and axial spring) and gravitational energy, (3, n), joule, of n states."""
    placed = place(system, times, angles, rates)
    middles = 0.5 * (placed.joints[:, 1:] + placed.joints[:, :-1])
    squares = (0.5 * (placed.velocities[:, 1:] + placed.velocities[:, :-1])) ** 2
    resisted = squares.sum(axis=-1) if system.axial_inertia else squares[..., 1]
    kinetic = 0.5 * (resisted @ system.masses + placed.rates**2 @ system.inertias)
    shortening = 2.0 * np.sin(0.5 * placed.directions) ** 2 @ system.lengths
    elastic = 0.5 * (angles**2 @ system.stiffness + system.axial_spring * shortening**2)
    return np.stack([kinetic, elastic, -(middles @ np.array(system.gravity)) @ system.masses])
