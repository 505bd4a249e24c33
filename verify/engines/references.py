"""Exact references of the linear chain: modes in closed form, motion as a sum over all of them, a slider on it.

Joint deflections of a uniform pinned chain swing as sin(j k pi / n); mass and stiffness are polynomials of one second
difference. No eigenvalue solver takes part.
"""

from functools import lru_cache

import numpy as np

from verify.arrays import Array
from verify.engines.base import Chain, Rider


def frequencies(chain: Chain) -> Array:
    """(n - 1,), Hz, ascending."""
    return np.asarray(np.sqrt(_squares(chain)[0]) / (2.0 * np.pi))


def stability_limit(chain: Chain) -> float:
    """Longest step of the classical Runge-Kutta method, 2 sqrt(2) / omega of the fastest mode, s."""
    return float(np.sqrt(2.0) / (np.pi * frequencies(chain)[-1]))


def _squares(chain: Chain) -> tuple[Array, Array]:
    """(omega^2, modal mass over n / 2) of every mode."""
    s = 4.0 * np.sin(0.5 * np.arange(1, chain.n) * np.pi / chain.n) ** 2
    mass = chain.mass + s * (chain.inertia / chain.link**2 - 0.25 * chain.mass)
    return chain.spring / chain.link**2 * s**2 / mass, mass


@lru_cache(maxsize=4)
def _modal(chain: Chain) -> tuple[Array, Array, Array, Array]:
    """(omega, shapes at the joints (n + 1, n - 1) of unit modal mass, steady cosine and sine amplitudes)."""
    squares, mass = _squares(chain)
    numbers = np.outer(np.arange(chain.n + 1), np.arange(1, chain.n)) % (2 * chain.n)
    shapes = np.sin(numbers * (np.pi / chain.n)) / np.sqrt(0.5 * chain.n * mass)
    steady = np.zeros(chain.n - 1, dtype=complex)
    for force in chain.forces:
        phasor = force.amplitude * np.exp(1j * np.radians(force.phase_deg))
        steady += phasor * _at(chain, shapes, force.position) / (squares - (2.0 * np.pi * chain.frequency_hz) ** 2)
    return np.sqrt(squares), shapes, steady.real, -steady.imag


def _at(chain: Chain, shapes: Array, x: float) -> Array:
    i, at = chain.locate(x)
    return np.asarray(shapes[i] * (1.0 - at / chain.link) + shapes[i + 1] * (at / chain.link))


def deflection(chain: Chain, times: Array, x: float | None = None) -> Array:
    """(m,), m, from rest at x, mid-span unless given."""
    omega, shapes, cosine, sine = _modal(chain)
    drive, weights = 2.0 * np.pi * chain.frequency_hz, _at(chain, shapes, 0.5 * chain.length if x is None else x)
    turns, phase = np.outer(times, omega), drive * np.asarray(times)
    steady = np.cos(phase) * (cosine @ weights) + np.sin(phase) * (sine @ weights)
    return np.asarray(steady - np.cos(turns) @ (cosine * weights) - np.sin(turns) @ (sine * drive / omega * weights))


def ride(chain: Chain, rider: Rider, end: float, steps: int = 20_000) -> tuple[Array, Array, Array]:
    """(times, distance, speed), each (steps + 1,), by Runge-Kutta steps on the exact motion of the links."""
    omega, shapes, cosine, sine = _modal(chain)
    drive, step = 2.0 * np.pi * chain.frequency_hz, end / steps
    tilts = np.diff(shapes, axis=0).T / chain.link
    kept = np.zeros((steps + 1, 2))
    d, v = kept[0] = 0.0, rider.speed

    def acceleration(spins: Array, moved: float, speed: float) -> float:
        return rider.force(speed - rider.surface_speed(chain, spins, rider.start + moved)) / rider.mass

    for first in range(0, steps, 500):  # angular velocities of 500 steps at once
        block = min(500, steps - first)
        times = step * (first + 0.5 * np.arange(2 * block + 1))
        turns, phase = np.outer(times, omega), drive * times
        rates = drive * (np.outer(np.cos(phase), sine) - np.outer(np.sin(phase), cosine))
        spins = (rates + np.sin(turns) * (cosine * omega) - np.cos(turns) * (sine * drive)) @ tilts
        for k in range(block):
            now, middle, after = spins[2 * k : 2 * k + 3]
            k1 = acceleration(now, d, v)
            k2 = acceleration(middle, d + 0.5 * step * v, v + 0.5 * step * k1)
            k3 = acceleration(middle, d + 0.5 * step * v + 0.25 * step**2 * k1, v + 0.5 * step * k2)
            k4 = acceleration(after, d + step * v + 0.5 * step**2 * k2, v + step * k3)
            d += step * v + step**2 * (k1 + k2 + k3) / 6.0
            v += step * (k1 + 2.0 * k2 + 2.0 * k3 + k4) / 6.0
            kept[first + k + 1] = d, v
    return np.linspace(0.0, end, steps + 1), kept[:, 0], kept[:, 1]
