"""What a nonlinear chain's run returns: the chain at the times kept, what it cost, where the energy went."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from verify.arrays import Array
from verify.chain.kinematics import energies, hub
from verify.chain.system import ChainState, ChainSystem, link_at
from verify.errors import InputError
from verify.motion.result import Statistics
from verify.validation import check_number


class ChainStatistics(Statistics, frozen=True, kw_only=True):
    """What a run of rigid links cost beside."""

    method: str
    """Of integration."""
    rejected: int = 0
    """Steps that the error estimate refused."""
    started: str = "consistent"
    """'consistent', or how far the start had to be moved onto the held points."""
    pivot_changes: int = 0
    """How often other angles were chosen to depend on the held points."""
    furthest: float = 0.0
    """Largest turn of a link from the straight chain at the end of a step, radians; 0 where no step was taken."""


@dataclass(frozen=True, kw_only=True, eq=False)
class MovedChain:
    """A chain of whatever links at the times kept."""

    system: ChainSystem
    times: Array
    """(n,), s; fewer than asked for where the run was stopped."""
    statistics: Statistics

    @property
    def finished(self) -> bool:
        """Whether every time asked for is here."""
        return self.statistics.finished


@dataclass(frozen=True, kw_only=True, eq=False)
class ChainMotion(MovedChain):
    """States of a chain at the times kept, and its energy ledger."""

    statistics: ChainStatistics
    """What it cost, how it started and ended, how far links turned."""
    angles: Array
    """(n, N), relative, radians."""
    rates: Array
    """(n, N), rad/s."""
    dissipated: Array
    """(n,), joule since the start."""
    work_in: Array
    """(n,), joule put in by loads, actuators and hub since the start; zero where no ledger was asked for."""

    def state(self, index: int) -> ChainState:
        """The state at one of the times."""
        return ChainState(self.angles[index], self.rates[index], float(self.times[index]))

    def energies(self) -> tuple[Array, Array, Array]:
        """Kinetic, elastic and gravitational energy, (n,) each, joule."""
        kinetic, elastic, height = energies(self.system, self.times, self.angles, self.rates)
        return kinetic, elastic, height

    def residual(self) -> Array:
        """Energy now less energy at first less work put in plus what was lost, (n,), joule: zero but for the step."""
        total = np.sum(self.energies(), axis=0)
        changed: Array = total - total[0] - (self.work_in - self.work_in[0]) + (self.dissipated - self.dissipated[0])
        return changed

    def points(self, x: Sequence[float]) -> Array:
        """Places of material points at x of the straight chain, (n, len(x), 2), metres, on their links."""
        return np.stack([self._read(x, np.cos), self._read(x, np.sin)], axis=2)

    def _read(self, x: Sequence[float], share: Any) -> Array:
        """One coordinate of material points, (n, len(x)): links by the cosine or the sine of their angles."""
        found, theta = np.zeros((len(self.times), len(x))), self.directions()
        for k, position in enumerate(x):
            check_number("x", position, "metres", at_least=0)
            if position > self.system.length * (1 + 1e-12):
                raise InputError(f"x = {position!r} lies off the chain: give up to {self.system.length!r} m")
            link, at = link_at(self.system, position)
            reach = np.append(self.system.lengths[: link - 1], at)
            found[:, k] = share(theta[:, :link]) @ reach
        return found

    def deflection(self, x: Sequence[float]) -> Array:
        """Y of material points on their links, (n, len(x)), metres."""
        return self._read(x, np.sin)

    def directions(self) -> Array:
        """Absolute angles of the links, (n, N), radians."""
        return np.asarray(np.cumsum(self.angles, axis=1) + hub(self.system.rotation, self.times)[0][:, None])
