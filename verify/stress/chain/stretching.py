"""Links that stretch against all their equations, and joints bent by any angle: what compiled chains add up.

A stretching link is a straight rod between two joints; forces are derivatives of its energies, written out for all
joints at once.
"""

from collections.abc import Iterator
from dataclasses import replace as changed
from math import pi
from typing import Any

import numpy as np

from verify.chain import warm
from verify.chain.system import ChainState, ChainSystem, LinkLoad
from verify.models.arrays import Array
from verify.models.compiling import Call
from verify.stress.chain.written_out import accelerated, systems
from verify.stress.kind import Floor, Row
from verify.stress.largest import largest

SPRINGS = 8.0e4 * np.array([1.0, 0.7, 1.3, 0.9, 1.1, 0.8, 1.2])
"""EA of each link, newton."""
SAMPLES, STEPS = 3, 25
"""Of a run, and steps from one to the next, each half of the longest."""


def _pulled(number: int) -> tuple[ChainSystem, bool]:
    """A cantilever and a chain between hinges, heavy, pushed and with dashpots; whether its tip is held along too."""
    base = systems()[0 if number < 1 else 2]
    push = LinkLoad(link=6, at=0.02, force=(14.0, -9.0), moment=0.3, frequency_hz=2300.0, phase_deg=41.0)
    dead = LinkLoad(link=4, at=0.05, force=(-15.0, 16.0), moment=-0.2, phase_deg=24.0)
    plain = changed(base, rotation=type(base.rotation)(), actuators=(), loads=(push, dead), gravity=(130.0, -981.0))
    return changed(plain, dashpots=0.3 * plain.dashpots), number > 1


class Rods:
    """All joints of a chain of rods in one plane, (2 (N + 1),): x and y of each in turn."""

    def __init__(self, system: ChainSystem, stiffness: Array, immovable: bool) -> None:
        self.system, self.stiffness = system, stiffness / system.lengths
        n = system.n_links
        self.straight = np.column_stack([np.append(0.0, np.cumsum(system.lengths)), np.zeros(n + 1)])
        self.mass = np.zeros((n + 1, n + 1))
        for i in range(n):
            middle, turn = np.array([0.5, 0.5]), np.array([-1.0, 1.0]) / system.lengths[i]
            own = system.masses[i] * np.outer(middle, middle) + system.inertias[i] * np.outer(turn, turn)
            self.mass[i : i + 2, i : i + 2] += own
        self.free = [list(range(1, n + 1 - immovable)), list(range(1, n + (system.tip != "roller")))]

    def turned(self, span: Array) -> Array:
        """By how much a rod's direction changes with its span, (2,)."""
        return np.array([-span[1], span[0]]) / float(span @ span)

    def accelerations(self, t: float, u: Array, v: Array) -> Array:
        """(N + 1, 2), of displacements and velocities."""
        system, n = self.system, self.system.n_links
        spans, rates = np.diff(self.straight + u, axis=0), np.diff(v, axis=0)
        turns = np.array([self.turned(span) for span in spans])
        angles, spins = np.unwrap(np.arctan2(spans[:, 1], spans[:, 0])), (turns * rates).sum(axis=1)
        moments = system.stiffness * np.diff(angles, prepend=0.0) + system.dashpots * np.diff(spins, prepend=0.0)
        on_links = np.append(moments[1:], 0.0) - moments
        force = np.zeros((n + 1, 2))
        for load in system.loads:
            now = np.cos(2.0 * pi * load.frequency_hz * t + np.deg2rad(load.phase_deg))
            share, link = load.at / system.lengths[load.link - 1], load.link - 1
            on_links[link] += now * load.moment
            force[link] += now * (1.0 - share) * np.array(load.force)
            force[link + 1] += now * share * np.array(load.force)
        for i, span in enumerate(spans):
            size = float(np.hypot(*span))
            pulled = self.stiffness[i] * (size - system.lengths[i]) * span / size
            half = 0.5 * system.masses[i] * np.array(system.gravity)
            force[i] += half + pulled - on_links[i] * turns[i]
            force[i + 1] += half - pulled + on_links[i] * turns[i]
        found = np.zeros((n + 1, 2))
        for axis, free in enumerate(self.free):
            found[free, axis] = np.linalg.solve(self.mass[np.ix_(free, free)], force[free, axis])
        return found

    def energy(self, u: Array, v: Array) -> float:
        """Kinetic, of rods and of joints, less what gravity has done."""
        system = self.system
        spans = np.diff(self.straight + u, axis=0)
        bends = np.diff(np.unwrap(np.arctan2(spans[:, 1], spans[:, 0])), prepend=0.0)
        stretches = np.hypot(*spans.T) - system.lengths
        fallen = system.masses @ (0.5 * (u[1:] + u[:-1]) @ np.array(system.gravity))
        moving = 0.5 * sum(float(v[:, axis] @ self.mass @ v[:, axis]) for axis in range(2))
        return float(moving + 0.5 * (self.stiffness @ stretches**2 + system.stiffness @ bends**2) - fallen)

    def step(self, t: float, h: float, u: Array, v: Array) -> tuple[Array, Array]:
        """One of Runge and Kutta's steps of order 4."""
        flows: list[tuple[Array, Array]] = []
        for share in (0.0, 0.5, 0.5, 1.0):
            du, dv = flows[-1] if flows else (0.0 * u, 0.0 * v)
            now = v + share * h * dv
            flows.append((now, self.accelerations(t + share * h, u + share * h * du, now)))
        weights = (1.0 / 6.0, 1.0 / 3.0, 1.0 / 3.0, 1.0 / 6.0)
        parts = [h * sum(w * flow[k] for w, flow in zip(weights, flows, strict=True)) for k in range(2)]
        return u + parts[0], v + parts[1]


def stretched_error(number: float) -> float:
    """Of displacements, velocities, deflections and energies of links let go bent, step by step the same."""
    from verify.chain.stretching import elastic_step_limit, simulate_elastic

    system, immovable = _pulled(int(number))
    h = 0.5 * elastic_step_limit(system, SPRINGS)
    times = np.linspace(0.0, (SAMPLES - 1) * STEPS * h, SAMPLES)
    bent = 0.02 * np.sin(2.0 * pi * np.arange(system.n_links + 1.0) / system.n_links)
    run = simulate_elastic(system, SPRINGS, times, step=h, immovable=immovable, deflected=bent)
    rods = Rods(system, SPRINGS, immovable)
    u, v = np.zeros((2, system.n_links + 1, 2))
    u[:, 1], worst = bent, 0.0
    x = 0.37 * system.length
    for i in range(SAMPLES - 1):
        for k in range(STEPS):
            u, v = rods.step((i * STEPS + k) * h, h, u, v)
        pairs: list[tuple[Any, Any]] = [(run.displacements[i + 1], u), (run.velocities[i + 1], v)]
        pairs.append((run.deflection([x])[i + 1, 0], np.interp(x, rods.straight[:, 0], u[:, 1])))
        pairs.append((run.energies[i + 1], rods.energy(u, v)))
        worst = largest(worst, *(float(abs(a - b).max() / abs(b).max()) for a, b in map(np.atleast_1d, pairs)))
    return worst


def angles_error(angle: float) -> float:
    """Of accelerations of three chains whose joints are bent by up to an angle, to either side, and moving."""
    from verify.chain.dynamics import accelerations

    worst = 0.0
    for system in (systems()[0], systems()[4], systems()[5]):
        n = np.arange(1.0, system.n_links + 1.0)
        state = ChainState(angle * np.cos(2.0 * n), 4.0 * np.cos(1.3 * n), 0.13)
        exact = accelerated(system, 0.13, state.angles, state.rates)
        worst = largest(worst, float(abs(accelerations(system, state) - exact).max() / abs(exact).max()))
    return worst


def _links() -> Iterator[Call]:
    yield from warm.stretching()


ROWS: tuple[Row, ...] = (
    Floor(
        id="stretching-written-out",
        title="Three chains of links that stretch, pushed, heavy and damped, against their equations in the same steps",
        why="chain/stretching_kernels.py: Runge and Kutta's steps to rounding, times a growth of a few hundred steps.",
        along="chain",
        at=(0.0, 1.0, 2.0),
        promise=1e-11,
        error=stretched_error,
        kernels=_links,
    ),
    Floor(
        id="joints-at-any-angle",
        title="Accelerations of chains whose joints are bent by small angles and by large ones",
        why="chain/recursion_kernels.py: short series and full ones to rounding.",
        along="rad",
        at=(1e-4, 0.2, 0.49, 0.51, 1.4, 2.9),
        promise=1e-13,
        error=angles_error,
        kernels=warm.rigid,
    ),
)
