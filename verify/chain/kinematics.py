"""Where the links of a nonlinear chain stand and how they move, at one time or at many, and what energy that is.

Beside the compiled loops, which need the same of every step: here it is asked for once a state, and nothing is
compiled for it.
"""

from typing import NamedTuple

import numpy as np

from verify.arrays import Array
from verify.chain.system import ChainSystem, Rotation, circular, held_points

BLOCK = 1 << 18
"""So many angles are looked at in one piece where there are many times."""


class Placed(NamedTuple):
    """Links as they stand, at one time or at times that come first."""

    directions: Array
    """(..., N), absolute angles, radians."""
    rates: Array
    """(..., N), of those, rad/s."""
    joints: Array
    """(..., N + 1, 2), metres."""
    velocities: Array
    """(..., N + 1, 2), m/s."""


def hub(rotation: Rotation, times: float | Array) -> tuple[Array, Array]:
    """Angle and rate of the base's prescribed rotation, radians and rad/s, in the shape of the times."""
    time, omega = np.asarray(times, dtype=float), circular(rotation.frequency_hz)
    phase = omega * time + np.deg2rad(rotation.phase_deg)
    angle = rotation.offset + rotation.rate * time + rotation.amplitude * np.sin(phase)
    return angle, rotation.rate + rotation.amplitude * omega * np.cos(phase)


def place(system: ChainSystem, times: float | Array, angles: Array, rates: Array) -> Placed:
    """Links by relative angles and rates, (..., N), at times (...)."""
    angle, rate = hub(system.rotation, times)
    directions = np.cumsum(angles, axis=-1) + angle[..., None]
    turning = np.cumsum(rates, axis=-1) + rate[..., None]
    c, s = np.cos(directions), np.sin(directions)
    spans = system.lengths[:, None] * np.stack([c, s], axis=-1)
    swings = (system.lengths * turning)[..., None] * np.stack([-s, c], axis=-1)
    return Placed(directions, turning, _from_base(spans), _from_base(swings))


def _from_base(steps: Array) -> Array:
    """Sums from the base on, (..., N + 1, 2), of what each link adds."""
    found = np.zeros((*steps.shape[:-2], steps.shape[-2] + 1, 2))
    np.cumsum(steps, axis=-2, out=found[..., 1:, :])
    return found


def energies(system: ChainSystem, times: Array, angles: Array, rates: Array) -> Array:
    """Kinetic, elastic (joints and axial spring) and gravitational energy, (3, n), joule, of n states."""
    block = max(BLOCK // system.n_links, 1)
    parts = [slice(first, first + block) for first in range(0, len(times), block)]
    return np.concatenate(
        [np.zeros((3, 0)), *(_energies(system, times[part], angles[part], rates[part]) for part in parts)], axis=1
    )


def _energies(system: ChainSystem, times: Array, angles: Array, rates: Array) -> Array:
    """The same in one piece."""
    placed = place(system, times, angles, rates)
    middles = 0.5 * (placed.joints[:, 1:] + placed.joints[:, :-1])
    squares = (0.5 * (placed.velocities[:, 1:] + placed.velocities[:, :-1])) ** 2
    felt = squares.sum(axis=-1) if system.axial_inertia else squares[..., 1]
    kinetic = 0.5 * (felt @ system.masses + placed.rates**2 @ system.inertias)
    elastic = 0.5 * (angles**2 @ system.stiffness + system.axial_spring * shortening(system, placed.directions) ** 2)
    return np.stack([kinetic, elastic, -(middles @ np.array(system.gravity)) @ system.masses])


def shortening(system: ChainSystem, directions: Array) -> Array:
    """How far the tip stands back from the straight chain's, (...), metres."""
    return np.asarray(2.0 * np.sin(0.5 * directions) ** 2 @ system.lengths)


def held_rows(system: ChainSystem, x: Array) -> Array:
    """Derivatives of the held points' y by the relative angles, (n_held, N), metres, from the joints' x, (N + 1,)."""
    rows = np.zeros((len(held := held_points(system)), system.n_links))
    for row, (link, at) in zip(rows, held, strict=True):
        share = at / system.lengths[link - 1]
        row[:link] = x[link - 1] + share * (x[link] - x[link - 1]) - x[:link]
    return rows


def strayed(system: ChainSystem, time: float, placed: Placed) -> tuple[Array, Array]:
    """How far the held points stand off where they are held, and how fast they leave, (n_held,), metres and m/s."""
    wanted = [(0.0, 0.0)] if system.tip == "roller" else []
    for one in system.actuators:
        omega = circular(one.frequency_hz)
        phase = omega * time + np.deg2rad(one.phase_deg)
        wanted.append((one.amplitude * np.cos(phase), -one.amplitude * omega * np.sin(phase)))
    now = []
    for link, at in held_points(system):
        share = at / system.lengths[link - 1]
        y, rising = (values[link - 1 : link + 1, 1] for values in (placed.joints, placed.velocities))
        now.append((y[0] + share * (y[1] - y[0]), rising[0] + share * (rising[1] - rising[0])))
    off = np.array(now, dtype=float).reshape(len(now), 2) - np.array(wanted, dtype=float).reshape(len(now), 2)
    return off[:, 0], off[:, 1]
