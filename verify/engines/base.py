"""Input and output of the engine adapters, and the registry of engines."""

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from importlib import import_module
from math import pi
from typing import Any, Protocol

import numpy as np

from verify.arrays import Array
from verify.engines.describe import describe
from verify.engines.description import RigidChain
from verify.errors import InputError
from verify.problem.beam import Beam, PointForce, check_frequency
from verify.registry import Registry
from verify.segment_model import SegmentModel
from verify.segments.attachments import joint_weights
from verify.settings import Load
from verify.validation import check_integer


@dataclass(frozen=True, eq=False)
class Chain:
    """N equal rigid links, pinned at x = 0 and on a roller at the end, driven from rest.

    `forces`: transverse, amplitude cos(omega t + phase), grown over `soft_start_periods` as 3 p^2 - 2 p^3, or switched
    on at t = 0. `shares` (forces, N + 1) are those of the joints.
    """

    rigid: RigidChain
    frequency_hz: float
    forces: tuple[PointForce, ...]
    shares: Array
    soft_start_periods: float = 0.0

    def force_values(self, t: Any) -> Array:
        """Values of all forces at times t, s, (*shape of t, forces), N."""
        amplitudes, phases = np.array([(one.amplitude, one.phase_deg) for one in self.forces]).T
        turns = np.multiply.outer(t, np.full(len(phases), self.frequency_hz))
        p = np.clip(turns / self.soft_start_periods, 0.0, 1.0) if self.soft_start_periods else 1.0
        return np.asarray(amplitudes * p * p * (3.0 - 2.0 * p) * np.cos(2.0 * pi * turns + np.radians(phases)))

    @cached_property
    def torques(self) -> Array:
        """Torque about every joint per unit of every force on the straight chain, (forces, N)."""
        joints, n = [joint.position for joint in self.rigid.joints], self.rigid.count
        return np.asarray(self.shares @ self.rigid.rows("bending", [0, *range(n)], joints)[0])

    def deflection(self, angles: Array, x: float) -> Array:
        """Deflection at x of links at `angles` (m, N), rad from the straight chain, (m,), m."""
        starts, lengths = np.array([(link.start, link.length) for link in self.rigid.links]).T
        return np.asarray(np.sin(angles) @ np.clip(x - starts, 0.0, lengths))


def chain_of(
    beam: Beam,
    n: int,
    forces: Sequence[PointForce],
    frequency_hz: float,
    *,
    load: Load = "lever",
    soft_start_periods: float = 0.0,
) -> Chain:
    """The chain of a uniform pinned undamped beam, `load`: the joints that take a force. Raises InputError."""
    if beam.supports != ("pinned", "pinned"):
        raise InputError(f"beam.supports = {beam.supports!r}: the engines' chain is pinned, give ('pinned', 'pinned')")
    beam.check_features("the engines' chain")
    if beam.loss_factor:
        raise InputError(f"beam.loss_factor = {beam.loss_factor!r}: the engines' chain is undamped, give 0")
    check_integer("count", n, 2)
    check_frequency("frequency_hz", frequency_hz, beam)
    for i, force in enumerate(forces):
        if force.position > beam.length:
            raise InputError(f"force[{i}].position = {force.position!r}: give one between 0 and {beam.length!r} m")
    shares = joint_weights(SegmentModel(beam, n).chain, np.array([one.position for one in forces]), load).toarray()
    return Chain(describe(beam, n), frequency_hz, tuple(forces), shares, soft_start_periods)


@dataclass(frozen=True)
class Run:
    """Result of an engine up to a failure, at the ends of steps: times (m,), s, angles of the links and rates, (m, N).

    `failure`: message with the time of a failure.
    """

    times: Array
    angles: Array
    rates: Array
    failure: str = ""


def centred(rates: Array) -> Array:
    """Rates at the ends of steps, (m, N), of those in the middles of the steps before: of a semi-implicit Euler rule.

    By means and, at the end, extrapolation: of order 2 as the angles are.
    """
    return np.vstack([rates[:1], 0.5 * (rates[1:-1] + rates[2:]), 1.5 * rates[-1:] - 0.5 * rates[-2:-1]])


class Adapter(Protocol):
    """Interface of an engine."""

    def frequencies(self, chain: Chain) -> Array | None:
        """Natural frequencies (N - 1,), Hz, ascending; None if the engine computes none."""

    def run(self, chain: Chain, steps: int, end: float, order: int = 4) -> Run:
        """The motion from rest to `end` (s) in `steps` steps.

        `order` of explicit rules: 4, or with one stage a step and from a soft start 2.
        """


@dataclass(frozen=True)
class Engine:
    """An engine and its adapter.

    `package`: name for pip; `home`: 'module:class' of the adapter; `implicit`: steps have no stability limit.
    """

    name: str
    package: str
    module: str
    home: str
    implicit: bool = False

    def adapter(self) -> Adapter:
        """The adapter, which imports the engine. Raises InputError if it is not installed."""
        if why := missing(self):
            raise InputError(f"engine = {self.name!r}: {why}")
        module, _, attribute = self.home.partition(":")
        made: Adapter = getattr(import_module(module), attribute)()
        return made


ENGINES: Registry[Engine] = Registry(
    "engine",
    "verify.engines",
    members=(
        Engine("Exudyn", "exudyn", "exudyn", "verify.engines.exudyn:Exudyn", implicit=True),
        Engine("MuJoCo", "mujoco", "mujoco", "verify.engines.mujoco:Mujoco"),
        Engine("Pinocchio", "pin", "pinocchio", "verify.engines.pinocchio:Pinocchio"),
    ),
    refuses=lambda one: "" if isinstance(one, Engine) else "is not a verify.engines.Engine: make it one",
)


def missing(engine: Engine) -> str:
    """Message for an engine that is not installed, else empty; imports nothing."""
    from importlib.util import find_spec

    if find_spec(engine.module) is not None:
        return ""
    return f"{engine.name} is not installed: pip install {engine.package}, or leave it out"
