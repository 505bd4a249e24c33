"""Quantities of a beam as a chain of rigid bodies in the time steps of an engine, small vibration about rest."""

from math import isfinite
from typing import TYPE_CHECKING, Annotated

import msgspec
from msgspec import Meta

from verify.errors import InputError
from verify.quantities.base import Scene, quantity
from verify.quantities.chain import Links
from verify.quantities.options import Mode
from verify.validation import Relative, check_integer, unit

if TYPE_CHECKING:
    from verify.engines.steps import Simulated

Step = Annotated[float, unit("s", gt=0), Meta(description="time step, s")]


class InSteps(msgspec.Struct, frozen=True, kw_only=True):
    """A chain in bending, with dashpots in proportion to its springs, in an engine."""

    count: Links
    engine: Annotated[str, Meta(description="engine or engine:integrator, a row of `engines.integrators`")] = "MuJoCo"
    damping: Annotated[Relative, Meta(ge=0, lt=1, description="damping ratio of mode 1 by dashpots")] = 0.0

    def of(self, scene: Scene, step: float) -> "Simulated":
        """The chain in steps, s. Raises InputError."""
        from verify.engines.describe import describe

        name, _, setting = self.engine.partition(":")
        return describe(scene.beam, self.count, damping=self.damping).simulated(step, name, setting)

    def mode(self, scene: Scene, mode: int, step: float) -> tuple[float, float]:
        """(damped frequency, Hz, damping ratio) of an elastic mode as it is simulated. Raises InputError."""
        run = self.of(scene, step)
        check_integer("mode", mode, 1, len(run.modes.hz) - run.rigid)
        at = run.rigid + mode - 1
        return float(run.modes.hz[at]), float(run.modes.zeta[at])


@quantity("engine.step_limit", unit="s", reads=("beam",))
def step_limit(scene: Scene, chain: InSteps) -> float:
    """Largest stable time step of a chain of rigid bodies in an engine."""
    if isfinite(limit := chain.of(scene, 1.0).limit):
        return float(limit)
    raise InputError(f"engine = {chain.engine!r}: every step is stable, choose an explicit integrator")


@quantity("engine.frequency", unit="Hz", reads=("beam",))
def frequency(scene: Scene, chain: InSteps, *, mode: Mode, step: Step) -> float:
    """Damped frequency of an elastic mode of a chain of rigid bodies, as an engine simulates it."""
    return chain.mode(scene, mode, step)[0]


@quantity("engine.damping", unit="1", reads=("beam",))
def damping(scene: Scene, chain: InSteps, *, mode: Mode, step: Step) -> float:
    """Damping ratio of an elastic mode of a chain of rigid bodies, as an engine simulates it."""
    return chain.mode(scene, mode, step)[1]
