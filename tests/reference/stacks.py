"""Stacks on a beam: Hermite elements, rod elements of ceramic, and a charge for each stack, in one dense matrix.

Written independently of the package, from which it takes value types alone. A stack is a rod of the stiffness 1/sD with
one charge Q: V = Q/C - h u, and the force h Q - K_D u at its tip, h = d/(epsT sD t), C = epsT (1 - k^2) n A/t. SI.
"""

from math import pi
from typing import Any, NamedTuple

import numpy as np

from tests.reference.dense import Elements

RODS = 40


class Ceramic(NamedTuple):
    """Of a slender bar along the field: sE33, 1/Pa, d33, C/N, epsT33, F/m, density."""

    s: complex
    d: complex
    epsilon: complex
    density: float


class Rod(NamedTuple):
    """A stack with its electrical condition V = source - drop I, drop in ohm; or the current where it is not None."""

    x: float
    ceramic: Ceramic
    layers: int
    thickness: float
    area: float
    source: complex = 0.0
    drop: complex = 0.0
    current: complex | None = None


def solve(beam: Any, nodes: Any, rods: list[Rod], hertz: float, x: Any, load: Any = 0.0, more: Any = 0.0) -> Any:
    """(deflections at x, and voltage, current, tip velocity of each stack); the loss factor acts in bending.

    `load` and `more` stiffness are over the nodal values.
    """
    written, omega = Elements(beam, nodes), 2.0 * pi * hertz
    own = np.array(written.free)
    bending = written.bending * (1.0 + 1j * beam.loss_factor) + written.rest + more - omega**2 * written.mass
    size, n = len(written.mass), len(own)
    rows = np.array([written.row(rod.x, 0) for rod in rods])[:, own]
    matrix = np.zeros((n + len(rods) * (RODS + 1),) * 2, dtype=complex)
    right, taps = np.zeros(len(matrix), dtype=complex), []
    matrix[:n, :n], right[:n] = bending[np.ix_(own, own)], (np.zeros(size) + load)[own]
    for i, rod in enumerate(rods):
        c, step = rod.ceramic, rod.layers * rod.thickness / RODS
        k2 = c.d**2 / (c.s * c.epsilon)
        field = c.d / (c.epsilon * c.s * (1.0 - k2)) / rod.layers  # h
        capacity = c.epsilon * (1.0 - k2) * rod.layers * rod.area / rod.thickness
        line = rod.area / (c.s * (1.0 - k2) * step) * np.array([[1.0, -1.0], [-1.0, 1.0]])
        line = line - omega**2 * c.density * rod.area * step / 12.0 * np.array([[5.0, 1.0], [1.0, 5.0]])  # order 4
        first = n + i * (RODS + 1)
        places = np.zeros((RODS + 1, len(matrix)))  # displacement of every node of the rod; the base is fixed
        places[range(1, RODS), range(first, first + RODS - 1)] = 1.0
        places[RODS, :n] = rows[i]
        for j in range(RODS):
            matrix += places[j : j + 2].T @ line @ places[j : j + 2]
        charge, spare = first + RODS - 1, first + RODS
        matrix[:, charge] -= field * places[RODS]
        # V = Q/C - h u as the row of the charge; V = source - drop I, or I = current, as that of V
        matrix[charge] -= field * places[RODS]
        matrix[charge, charge] += 1.0 / capacity
        matrix[charge, spare] = -1.0
        if rod.current is None:
            matrix[spare, spare], matrix[spare, charge], right[spare] = 1.0, 1j * omega * rod.drop, rod.source
        else:
            matrix[spare, charge], right[spare] = 1j * omega, rod.current
        taps.append((charge, spare))
    found = np.linalg.solve(matrix, right)
    values = np.zeros(size, dtype=complex)
    values[own] = found[:n]
    charges, voltages = found[np.array(taps)].T
    speeds = 1j * omega * (rows @ found[:n])
    return written.values_at(values, x, 0), voltages, 1j * omega * charges, speeds
