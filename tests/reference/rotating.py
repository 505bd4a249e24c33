"""A rotating cantilever by Ritz's method with Legendre polynomials."""

import numpy as np
from numpy.polynomial.legendre import legder, leggauss, legval
from scipy.linalg import eigh


def flapping(speed, terms=16):
    """Lowest three frequencies in sqrt(EI/(rho A L^4)), hub radius 0; `speed` in the same unit.

    w = x^2 sum c_k P_k(2 x - 1) in the energies int w''^2 + speed^2 int (1 - x^2) w'^2 / 2 and int w^2.
    """
    points, weights = leggauss(2 * terms + 8)
    x, weights = 0.5 * (points + 1.0), 0.5 * weights
    basis = np.eye(terms)
    p, slope, bend = (np.array([legval(points, legder(row, m)) * 2.0**m for row in basis]) for m in range(3))
    w, first, second = x**2 * p, 2.0 * x * p + x**2 * slope, 2.0 * p + 4.0 * x * slope + x**2 * bend
    stiffness = (weights * second) @ second.T + speed**2 * (weights * 0.5 * (1.0 - x**2) * first) @ first.T
    return np.sqrt(eigh(stiffness, (weights * w) @ w.T, eigvals_only=True)[:3])
