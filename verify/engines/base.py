"""Input and output of the engine adapters, and the registry of engines."""

from collections.abc import Sequence
from dataclasses import dataclass
from importlib import import_module
from math import cos, pi, radians
from typing import Protocol

from verify.arrays import Array
from verify.engines.description import RigidChain, describe
from verify.errors import InputError
from verify.problem.beam import Beam, PointForce, check_frequency
from verify.registry import Registry
from verify.validation import check_integer

SAMPLES = 200
"""Number of samples of a run; every step of a shorter one."""


@dataclass(frozen=True)
class Chain:
    """N equal rigid links, pinned at x = 0 and on a roller at the end, driven from rest.

    `forces`: transverse, amplitude cos(omega t + phase), switched on at t = 0.
    """

    rigid: RigidChain
    frequency_hz: float
    forces: tuple[PointForce, ...]

    def force_values(self, t: float) -> list[float]:
        """Values of all forces at t, s, in N."""
        omega = 2.0 * pi * self.frequency_hz
        return [force.amplitude * cos(omega * t + radians(force.phase_deg)) for force in self.forces]

    def locate(self, x: float) -> tuple[int, float]:
        """(link, counted from 0, distance from its near end) of a position."""
        link = self.rigid.links[0].length
        i = min(int(x / link + 1e-12), self.rigid.count - 1)
        return i, x - i * link


def chain_of(beam: Beam, n: int, forces: Sequence[PointForce], frequency_hz: float) -> Chain:
    """The chain of a uniform pinned undamped beam. Raises InputError for any other."""
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
    return Chain(describe(beam, n), frequency_hz, tuple(forces))


@dataclass(frozen=True)
class Run:
    """Result of an engine up to a failure: times (m,), s, and mid-span deflections (m,), m.

    `steps`: completed steps; `failure`: message with the time of a failure.
    """

    times: Array
    deflection: Array
    steps: int
    failure: str = ""


class Adapter(Protocol):
    """Interface of an engine."""

    def frequencies(self, chain: Chain) -> Array | None:
        """Natural frequencies (N - 1,), Hz, ascending; None if the engine computes none."""

    def run(self, chain: Chain, steps: int, end: float) -> Run:
        """The motion from rest to `end` (s) in `steps` steps."""


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
    own=(
        Engine("Exudyn", "exudyn", "exudyn", "verify.engines.exudyn:Exudyn", implicit=True),
        Engine("MuJoCo", "mujoco", "mujoco", "verify.engines.mujoco:Mujoco"),
    ),
    refuses=lambda one: "" if isinstance(one, Engine) else "is not a verify.engines.Engine: make it one",
)


def missing(engine: Engine) -> str:
    """Message for an engine that is not installed, else empty; imports nothing."""
    from importlib.util import find_spec

    if find_spec(engine.module) is not None:
        return ""
    return f"{engine.name} is not installed: pip install {engine.package}, or leave it out"
