"""Heavy column: weight per length q at which a clamped column buckles under itself, over EI / L^3. Order 4."""

from math import pi

import numpy as np

from verify.cases.base import case
from verify.cases.beams import CANTILEVER, EI, OMEGA, inextensible

GREENHILL = "A. G. Greenhill 1881: J_{-1/3}(2/3 sqrt q) = 0"
WEIGHTS = np.array([7.2, 7.4, 7.6])
"""Weights below the critical one, from which the square of the first frequency is extrapolated to zero: it is nearly
straight, and parabolic to 1e-7."""


@case("heavy-column", 7.83734743894348, 5e-15, GREENHILL)
def weight(count: int = 16) -> float:
    """Weight at which the first frequency of nonlinear elements vanishes."""
    squares = []
    for q in WEIGHTS.tolist():
        column = inextensible(count).bend(gravity=(-q * EI / CANTILEVER.mass_per_length, 0.0))
        squares.append((2.0 * pi * float(column.frequencies_hz()[0]) / OMEGA) ** 2)
    return float(np.polyval(np.polyfit(squares, WEIGHTS, 2), 0.0))
