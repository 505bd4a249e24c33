"""Integrals of powers times exponentials: what the books of a motion in closed form are made of."""

import numpy as np

from verify.models.arrays import Array, ComplexArray

ABOVE = 40
"""Powers, and half as many as are asked for, above which the way down begins: what it begins with is forgotten."""


def weighted_powers(z: ComplexArray, end: ComplexArray, highest: int) -> ComplexArray:
    """Integrals of p^k e^{z p} over 0 <= p <= 1 for k = 0..highest, (highest + 1, n); z (n,) with Re z <= 0.

    `end` is e^z, (n,), as whoever asks has it: of a long motion its phase is that of the state at its end, to the last
    digit. Parts give I_k = (e^z - k I_{k-1}) / z, which loses nothing upwards while k <= |z|, and downwards beyond
    (as F. W. J. Olver, D. W. Lozier, R. F. Boisvert, C. W. Clark, NIST Handbook of Mathematical Functions, 2010, 3.6).
    """
    size = abs(z)
    found = _downwards(np.where(size <= highest + 1, z, 0.0), highest)
    far = size >= 1.0
    up = np.where(far, z, 1.0)
    found[0] = np.where(far, (end - 1.0) / up, found[0])
    for k in range(1, highest + 1):
        found[k] = np.where(far & (k <= size), (end - k * found[k - 1]) / up, found[k])
    return found


def _downwards(z: ComplexArray, highest: int) -> ComplexArray:
    """The same from above: right for the powers k > |z|, (highest + 1, n)."""
    end, last = np.exp(z), highest + highest // 2 + ABOVE
    value = np.asarray(end / (last + 1.0), dtype=complex)
    found = np.empty((highest + 1, len(z)), dtype=complex)
    for k in range(last, 0, -1):
        value = (end - z * value) / k
        if k <= highest + 1:
            found[k - 1] = value
    return found


def multiplied(a: Array | ComplexArray, b: Array | ComplexArray) -> ComplexArray:
    """Coefficients of the product of polynomials, row by row, (n, j) and (n, k) -> (n, j + k - 1)."""
    found = np.zeros((len(b), a.shape[1] + b.shape[1] - 1), dtype=complex)
    for power in range(a.shape[1]):
        found[:, power : power + b.shape[1]] += a[:, power, None] * b
    return found
