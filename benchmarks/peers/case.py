"""What every engine is given: a uniform pinned chain with a roller end, springs, two transverse forces."""

from collections.abc import Callable
from dataclasses import dataclass
from math import cos, pi, radians

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
Run = Callable[[float, float], tuple[Array, Array]]
"""(step, end) -> (times, deflection of the middle of the chain), sampled at every step or more rarely."""


@dataclass(frozen=True, kw_only=True)
class Case:
    """A chain of n equal links and what drives it from rest. SI."""

    n: int
    length: float
    mass: float
    """Of one link."""
    inertia: float
    """Of one link about its middle."""
    spring: float
    """N m/rad, at inner joints."""
    frequency_hz: float
    forces: tuple[tuple[float, float, float], ...]
    """(place, amplitude, phase in degrees) each; transverse, amplitude cos(omega t + phase)."""

    @property
    def link(self) -> float:
        """Length of a link."""
        return self.length / self.n

    def now(self, t: float) -> list[float]:
        """The forces at a time."""
        omega = 2.0 * pi * self.frequency_hz
        return [amplitude * cos(omega * t + radians(phase)) for _, amplitude, phase in self.forces]

    def place(self, x: float) -> tuple[int, float]:
        """The link, from 0, that holds x, and the place on it from its near end."""
        i = min(int(x / self.link + 1e-12), self.n - 1)
        return i, x - i * self.link


def every(steps: int, samples: int) -> int:
    """After how many steps to look, for at least so many samples."""
    return max(steps // samples, 1)


def count(step: float, end: float) -> tuple[int, float]:
    """The number of steps up to the end, and the step that fits."""
    steps = max(round(end / step), 1)
    return steps, end / steps


def matrices(case: Case) -> tuple[Array, Array]:
    """Mass and stiffness of the linear chain over its joints' positions, (n + 1, n + 1) each."""
    n, link = case.n, case.link
    mass, stiffness, bend = np.zeros((n + 1, n + 1)), np.zeros((n + 1, n + 1)), np.array([1.0, -2.0, 1.0]) / link
    own, shared = case.mass / 4 + case.inertia / link**2, case.mass / 4 - case.inertia / link**2
    for i in range(n):
        mass[i : i + 2, i : i + 2] += np.array([[own, shared], [shared, own]])
    for i in range(1, n):
        stiffness[i - 1 : i + 2, i - 1 : i + 2] += case.spring * np.outer(bend, bend)
    return mass, stiffness
