"""The scene's slider on the nonlinear chain of rigid links: each chain moves once for all sliders that ride on it."""

from typing import TYPE_CHECKING

import msgspec
from msgspec.structs import replace

from verify.chain.dynamics import at_rest
from verify.chain.result import ChainMotion
from verify.chain.ride import ChainRide, half_steps, ride
from verify.chain.stepping import simulate
from verify.chain.system import build_system
from verify.errors import InputError

if TYPE_CHECKING:
    from verify.beam import PointForce
    from verify.scenes.scene import Scene

KEPT = 40
"""Chains remembered; one of 49 links over a millisecond takes a megabyte."""


class Chains(msgspec.Struct, frozen=True, eq=False):
    """Chains from rest under forces that act at once, undamped."""

    moved: "dict[tuple[PointForce, ...], ChainMotion]" = {}

    def under(self, scene: "Scene", count: int) -> ChainMotion:
        """The chain of a scene, of which only the forces differ from one to the next. Raises InputError."""
        if scene.forces not in self.moved:
            if len(self.moved) >= KEPT:
                self.moved.clear()
            self.moved[scene.forces] = _moved(scene, count)
        return self.moved[scene.forces]

    def ride(self, scene: "Scene", count: int) -> ChainRide:
        """The scene's slider on its chain, one way. Raises InputError where the chain breaks off."""
        assert scene.slider is not None
        return ride(self.under(scene, count), scene.beam, replace(scene.slider, coupling="one-way"))


def _moved(scene: "Scene", count: int) -> ChainMotion:
    drive, asked = scene.drive, scene.motion
    assert drive is not None
    assert asked is not None
    system = build_system(scene.beam, count, scene.forces, drive.frequency_hz, load="reciprocal")
    times = half_steps(asked.duration, 1.0 / (drive.frequency_hz * asked.steps_per_period))
    motion = simulate(system, at_rest(system), times.tolist(), ledger=False)
    if motion.statistics.interrupted:
        raise KeyboardInterrupt
    if not motion.finished:
        raise InputError(f"the chain {motion.statistics.stopped}: give smaller forces")
    return motion
