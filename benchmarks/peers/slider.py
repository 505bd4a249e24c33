"""The slider of the races: a point mass on the surface with tanh friction, one-way, and a reference for engines.

The engines know the angular velocities of the links. The surface under the slider moves with -(h/2) times their
smooth reading: means of two links at every joint, a cubic through four joints (Catmull and Rom) between.
"""

from collections.abc import Callable
from dataclasses import dataclass
from math import tanh

import numpy as np
from scipy.linalg import eigh

from benchmarks.peers.case import Array, Case, matrices

Run = Callable[[float, float], tuple[float, float, float]]
"""(step, end) -> (distance travelled, speed) of the slider, and the seconds that the steps took."""


@dataclass(frozen=True, kw_only=True)
class Sled:
    """What slides. SI."""

    mass: float = 1e-3
    mu: float = 0.2
    slope: float = 1e4
    gravity: float = 9.81
    half_thickness: float = 5e-4
    start: float = 0.25

    def force(self, relative_speed: float) -> float:
        """Friction on the slider, newton."""
        return -self.mu * self.mass * self.gravity * tanh(self.slope * relative_speed)


def surface_speed(case: Case, sled: Sled, spins: Array, x: float) -> float:
    """Speed of the surface at x from the links' angular velocities, (n,), counter-clockwise positive."""
    i = min(max(int(x / case.link), 2), case.n - 3)
    s = x / case.link - i
    a, b, c, d = (0.5 * (spins[j - 1] + spins[j]) for j in range(i - 1, i + 3))
    value = 0.5 * (2 * b + (c - a) * s + (2 * a - 5 * b + 4 * c - d) * s * s + (3 * b - a - 3 * c + d) * s**3)
    return float(-sled.half_thickness * value)


def reference(case: Case, sled: Sled, end: float, steps: int = 20_000) -> tuple[float, float]:
    """(distance, speed) at the end on the exact linear chain: a sum over its modes, small Runge-Kutta steps."""
    omegas, spin_shapes, sine, cosine = _modes(case)
    drive, dt = 2.0 * np.pi * case.frequency_hz, end / steps

    def spins(t: float) -> Array:
        phase = drive * t
        rates = drive * (sine * np.cos(phase) - cosine * np.sin(phase))
        rates += cosine * omegas * np.sin(omegas * t) - sine * drive * np.cos(omegas * t)
        return np.asarray(spin_shapes @ rates)

    x, v, now = sled.start, 0.0, spins(0.0)

    def pull(at: Array, place: float, speed: float) -> float:
        return sled.force(speed - surface_speed(case, sled, at, place)) / sled.mass

    for k in range(steps):
        middle, after = spins((k + 0.5) * dt), spins((k + 1) * dt)
        k1 = pull(now, x, v)
        k2 = pull(middle, x + 0.5 * dt * v, v + 0.5 * dt * k1)
        k3 = pull(middle, x + 0.5 * dt * v + 0.25 * dt * dt * k1, v + 0.5 * dt * k2)
        k4 = pull(after, x + dt * v + 0.5 * dt * dt * k2, v + dt * k3)
        x += dt * v + dt * dt * (k1 + k2 + k3) / 6.0
        v += dt * (k1 + 2.0 * k2 + 2.0 * k3 + k4) / 6.0
        now = after
    return x - sled.start, v


def _modes(case: Case) -> tuple[Array, Array, Array, Array]:
    """(omega, spins of the links in every mode, amplitudes of the forced sine and cosine)."""
    n, link = case.n, case.link
    mass, stiffness = matrices(case)
    values, shapes = eigh(stiffness[1:-1, 1:-1], mass[1:-1, 1:-1])
    everywhere = np.zeros((n + 1, n - 1))
    everywhere[1:-1] = shapes
    sine, cosine = np.zeros(n - 1), np.zeros(n - 1)
    for x, amplitude, phase in case.forces:
        i, where = case.place(x)
        load = (everywhere[i] * (1 - where / link) + everywhere[i + 1] * where / link) * amplitude
        answer = load / (values - (2.0 * np.pi * case.frequency_hz) ** 2)
        cosine += answer * np.cos(np.radians(phase))
        sine -= answer * np.sin(np.radians(phase))
    return np.sqrt(values), np.diff(everywhere, axis=0) / link, sine, cosine
