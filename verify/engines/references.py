"""Exact references of the linear chain: modes in closed form, motion as a sum over all of them.

Joint deflections of a uniform pinned chain swing as sin(j k pi / n); mass and stiffness are polynomials of one second
difference. No eigenvalue solver takes part.
"""

from functools import lru_cache

import numpy as np

from verify.arrays import Array
from verify.engines.base import Chain


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
