"""Modes of Hermite elements, and their motion under forces that grow, by scipy's DOP853. Of verify value types alone."""

from typing import NamedTuple

import numpy as np
from scipy.integrate import solve_ivp

from tests.reference.dense import CUBICS, Elements


class Modes(NamedTuple):
    """Natural frequencies, rad/s, and shapes (x, derivative) -> (n,) of unit modal mass; matrices over all unknowns."""

    own: np.ndarray
    shape: object


def hermite_modes(beam, parts):
    """Modes of equal Hermite elements."""
    elements, length = Elements(beam, np.linspace(0.0, beam.length, parts + 1)), beam.length / parts
    values, vectors = elements.modes
    powers = np.arange(4)
    pieces = []  # (part, derivative): values of all modes by power of the share of the part
    for e in range(parts):
        cubics = (CUBICS.T * (1.0, length, 1.0, length)) @ vectors[2 * e : 2 * e + 4]
        derivatives = [np.polynomial.polynomial.polyder(cubics, d, scl=1 / length) for d in range(4)]
        pieces.append([np.vstack([one, np.zeros((4 - len(one), len(values)))]) for one in derivatives])

    def shape(x, derivative):
        e = min(max(int(x / length), 0), parts - 1)
        return (x / length - e) ** powers @ pieces[e][derivative]

    return Modes(np.sqrt(np.maximum(values, 0.0)), shape)


def smooth(p):
    """3 p^2 - 2 p^3 up to p = 1, then 1."""
    p = min(p, 1.0)
    return p * p * (3.0 - 2.0 * p)


def driven(modes, forces, hertz, times, *, damping=0.0, growth=lambda t: 1.0, breaks=(), start=None):
    """(q, dq/dt) of all modes under forces growth(t) F cos(omega t + phase) at the times, (n, 2 m), by DOP853.

    `breaks` are times at which the growth is not smooth.
    """
    own, n = modes.own, len(modes.own)
    loads = [(f.amplitude, np.deg2rad(f.phase_deg), modes.shape(f.position, 0)) for f in forces]

    def rates(t, y):
        push = growth(t) * sum(f * np.cos(2 * np.pi * hertz * t + turn) * load for f, turn, load in loads)
        return np.concatenate([y[n:], push - 2 * damping * own * y[n:] - own**2 * y[:n]])

    y, began, rows = np.zeros(2 * n) if start is None else start, 0.0, {0.0: start}
    for end in sorted({*breaks, *times}):
        if end > began:
            y = solve_ivp(rates, (began, end), y, method="DOP853", rtol=1e-12, atol=1e-18).y[:, -1]
            began = end
        rows[end] = y
    return np.array([rows[t] for t in times])
