"""The chain with links that stretch (EA / l): axial inertia as a beam has it, at the price of axial waves.

Rigid links carry a spurious axial inertia (`ChainSystem.axial_inertia`). Here every link is a uniform bar that
stretches evenly, its inertia that of a link (`segments.chain.joint_masses`) along both directions. Both ends may be
immovable. RK4 with a fixed step; the limit is that of axial waves, of order l.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from time import perf_counter
from typing import Any

import numpy as np

from verify.arrays import Array
from verify.chain import records
from verify.chain.result import MovedChain
from verify.chain.system import ChainSystem, circular, link_at
from verify.errors import InputError
from verify.motion.result import END, Statistics
from verify.segments.chain import joint_masses
from verify.validation import check_number, check_unmasked


@dataclass(frozen=True, kw_only=True, eq=False)
class ElasticMotion(MovedChain):
    """Joints of a stretching chain at the times kept."""

    displacements: Array
    """(n, N + 1, 2), metres from the straight chain."""
    velocities: Array
    """(n, N + 1, 2), m/s."""
    axial_stiffness: float | Array
    """EA in newton, of all links or of each, (N,)."""

    @cached_property
    def energies(self) -> Array:
        """(n,), kinetic, elastic (of links and joints) and of gravity together, joule."""
        system, v = self.system, self.velocities
        diagonal, coupling = joint_masses(system.masses, system.inertias, system.lengths)
        kinetic = 0.5 * (v**2).sum(axis=2) @ diagonal + (v[:, 1:] * v[:, :-1]).sum(axis=2) @ coupling
        lengths, spans = system.lengths, np.diff(self.displacements, axis=1)
        along, across = lengths + spans[..., 0], spans[..., 1]
        squares = spans[..., 0] * (2.0 * lengths + spans[..., 0]) + across**2
        stretches = squares / (np.hypot(along, across) + lengths)
        bends = np.diff(np.arctan2(across, along), axis=1, prepend=0.0)
        bends -= 2.0 * np.pi * np.round(bends / (2.0 * np.pi))
        elastic = 0.5 * (stretches**2 @ (self.axial_stiffness / lengths) + bends**2 @ system.stiffness)
        u = self.displacements @ np.array(system.gravity)
        return np.asarray(kinetic + elastic - 0.5 * (u[:, 1:] + u[:, :-1]) @ system.masses)

    def deflection(self, x: Sequence[float]) -> Array:
        """Y of material points on their links, (n, len(x)), metres."""
        columns = []
        for position in x:
            link, at = link_at(self.system, position)
            share = at / self.system.lengths[link - 1]
            columns.append((1 - share) * self.displacements[:, link - 1, 1] + share * self.displacements[:, link, 1])
        return np.stack(columns, axis=1)


def elastic_step_limit(system: ChainSystem, axial_stiffness: float | Array) -> float:
    """A step that RK4 stands, seconds: 2 sqrt(2) over a bound on the highest circular frequency.

    No frequency of the chain exceeds the highest of any link by itself (B. M. Irons and G. Treharne): sqrt(EA l / J)
    in stretching, sqrt(2 (k_i + k_j) / J) in bending.
    """
    springs = system.stiffness + np.append(system.stiffness[1:], 0.0)
    fastest = np.maximum(axial_stiffness * system.lengths, 2.0 * springs) / system.inertias
    return float(2.0 * np.sqrt(2.0 / fastest.max()))


def simulate_elastic(
    system: ChainSystem,
    axial_stiffness: float | Array,
    times: Sequence[float] | Array,
    *,
    step: float | None = None,
    immovable: bool = False,
    deflected: Array | None = None,
) -> ElasticMotion:
    """The motion from rest, straight or from joint deflections `deflected` (N + 1,), kept at even `times` from 0.

    `axial_stiffness` is EA in newton, of all links or of each (N,); `step` is at most `elastic_step_limit`, half of
    it unless given, shortened to divide the spacing of the times; `immovable` holds the tip along x too. Raises
    InputError, also for actuators, a turning base, an axial spring and links without inertia along x.
    """
    began = perf_counter()
    samples = _checked(system, axial_stiffness, times)
    limit = elastic_step_limit(system, axial_stiffness)
    step = 0.5 * limit if step is None else step
    check_number("step", step, "seconds", above=0, at_most=limit)
    spacing = float(samples[1])
    flat = _flattened(system, axial_stiffness, immovable)
    u, v = np.zeros((system.n_links + 1, 2)), np.zeros((system.n_links + 1, 2))
    u[:, 1] = 0.0 if deflected is None else deflected
    steps, ready = int(np.ceil(spacing / step - 1e-9)), perf_counter()
    kept, stopped = _march(flat, samples, steps, u, v)
    done, wall = steps * (len(kept) - 1), perf_counter() - ready
    places, speeds = (np.array([state[part] for state in kept]) for part in range(2))
    return ElasticMotion(
        system=system,
        times=samples[: len(kept)],
        displacements=places,
        velocities=speeds,
        axial_stiffness=axial_stiffness,
        statistics=Statistics(
            steps=done,
            evaluations=4 * done,
            step_s=spacing / steps,
            set_up_s=ready - began,
            wall_s=wall,
            stopped=stopped,
        ),
    )


def _march(
    flat: records.Elastic, samples: Array, steps: int, u: Array, v: Array
) -> tuple[list[tuple[Array, Array]], str]:
    """(displacements, velocities) at the samples reached, so many steps apart, and why it stopped."""
    from verify.chain import stretching_kernels as kernels

    k, w = np.zeros((4, *u.shape)), np.zeros((2, *u.shape))
    spacing, kept = float(samples[1]), [(u.copy(), v.copy())]
    try:
        for t in samples[:-1]:
            if not kernels.march(flat, t, spacing / steps, steps, u, v, k, w):
                return kept, f"diverged before t = {t + spacing:.6g} s"
            kept.append((u.copy(), v.copy()))
    except KeyboardInterrupt:
        return kept, f"interrupted after t = {samples[len(kept) - 1]:.6g} s"
    return kept, END


def _checked(system: ChainSystem, axial_stiffness: float | Array, times: Any) -> Array:
    """The times as an array. Raises InputError."""
    stiffness = np.asarray(axial_stiffness)
    if stiffness.shape not in ((), (system.n_links,)):
        raise InputError(
            f"axial_stiffness has the shape {stiffness.shape}: give one value or one for each of {system.n_links} links"
        )
    for value in np.atleast_1d(stiffness).tolist():
        check_number("axial_stiffness", value, "newton", above=0)
    if not system.axial_inertia:
        raise InputError("chain.axial_inertia = False: links that stretch have inertia along x, leave it at True")
    if system.actuators or system.rotation.rate or system.rotation.amplitude or system.rotation.offset:
        raise InputError("chain: actuators and a turned base are for rigid links; give a chain without them")
    if system.axial_spring:
        raise InputError(
            f"chain.axial_spring = {system.axial_spring!r}: stretching links take immovable = True instead"
        )
    check_unmasked("times", times, "seconds")
    samples = np.asarray(times, dtype=float)
    if samples.ndim != 1 or len(samples) < 2 or samples[0] != 0.0 or np.ptp(np.diff(samples)) > 1e-9 * samples[1]:
        raise InputError("times: give two or more, evenly spaced, from 0")
    return samples


def _flattened(system: ChainSystem, stiffness: float | Array, immovable: bool) -> records.Elastic:
    """The chain as the kernels see it."""
    lengths = system.lengths
    free = np.ones((system.n_links + 1, 2))
    free[0] = 0.0
    free[-1] = 0.0 if immovable else 1.0, 0.0 if system.tip == "roller" else 1.0
    loads = [
        (p.at / lengths[p.link - 1], *p.force, p.moment, circular(p.frequency_hz), np.deg2rad(p.phase_deg), p.link - 1)
        for p in system.loads
    ]
    links = np.stack([lengths, system.masses, stiffness / lengths, system.stiffness, system.dashpots], axis=1)
    return records.Elastic(
        links=links,
        loads=np.array(loads, dtype=float).reshape(len(loads), 7),
        gravity=np.array(system.gravity, dtype=float),
        factors=_factorised(*joint_masses(system.masses, system.inertias, lengths), free),
    )


def _factorised(diagonal: Array, coupling: Array, free: Array) -> Array:
    """L D L^T of the mass matrix with held joints left out; `free` is (N + 1, 2), 1 or 0. See `Elastic.factors`."""
    factors = np.zeros((len(diagonal), 2, 2))
    factors[0, :, 1] = free[0] / diagonal[0]
    for j in range(1, len(diagonal)):
        ratio = coupling[j - 1] * factors[j - 1, :, 1]  # at a held joint of no effect: its reciprocal pivot is 0
        factors[j] = np.stack([ratio, free[j] / (diagonal[j] - ratio * coupling[j - 1])], axis=1)
    return factors
