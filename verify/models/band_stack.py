"""Symmetric bands of many pencils side by side: products, triangular factors, solutions and counts of all at once.

A band is kept by its main diagonal and those above it, (n, w + 1, c): entry [i, a, j] is A_{i, i + a} of matrix j, zero
beyond the last row. Vectors are (n, k, c), k of each matrix. Loops run over the rows; what numpy is given in each is all
matrices, so that a few hundred of them cost little more than one.
"""

import numpy as np
from numpy.lib.stride_tricks import as_strided

from verify.models.arrays import Array, Indices

_CAUTION = 100.0
"""Times the rounding of a factorisation, for what the norm of its error and a mass matrix off its diagonal make."""


def of_unknowns(bands: Array, free: Indices) -> Array:
    """The bands of the rows and columns `free`, ascending, of bands over more."""
    n, width = len(free), bands.shape[1]
    kept = np.zeros((n, width, bands.shape[2]))
    for above in range(min(width, n)):
        rows, columns = free[: n - above], free[above:]
        near = columns - rows < width
        kept[: n - above, above][near] = bands[rows[near], (columns - rows)[near]]
    return kept


def product(bands: Array, vectors: Array) -> Array:
    """A v, (n, k, c)."""
    n = len(bands)
    found: Array = bands[:, :1] * vectors
    for above in range(1, bands.shape[1]):
        beside = bands[: n - above, above, None]
        found[: n - above] += beside * vectors[above:]
        found[above:] += beside * vectors[: n - above]
    return found


def triangles(bands: Array) -> tuple[Array, Array]:
    """(pivots d (n, c), L (n, w, c)) of A = L diag(d) L^T without row exchanges: entry [i, a, j] is L_{i + 1 + a, i}.

    Not a number where a pivot is zero. `bands` are left as they are.
    """
    n, width, c = bands.shape
    w = width - 1
    rows = np.zeros((n + w, 2 * w + 1, c))
    rows[:n, w:] = bands
    by_row, by_column, by_matrix = rows.strides
    # what is left of the matrix below each row: [i, a, b] is A_{i + 1 + a, i + 1 + b}, of which b >= a is read
    left = as_strided(rows[1:, w:], (n, w, w, c), (by_row, by_row - by_column, by_column, by_matrix))
    taken, beside = np.empty((w, w, c)), np.empty((w, c))
    for i in range(n):
        lower = rows[i, w + 1 :]
        beside[...] = lower
        np.divide(lower, rows[i, w], out=lower)
        np.multiply(lower[:, None], beside, out=taken)
        np.subtract(left[i], taken, out=left[i])
    return rows[:n, w], rows[:n, w + 1 :]


def solution(pivots: Array, lower: Array, loads: Array) -> Array:
    """A^-1 b of the triangles of A, (n, k, c)."""
    n, w, _ = lower.shape
    found = np.zeros((n + w, *loads.shape[1:]))
    found[:n] = loads
    taken = np.empty((w, *loads.shape[1:]))
    across = lower[:, :, None]
    for i in range(n - 1):
        np.multiply(across[i], found[i], out=taken)
        found[i + 1 : i + 1 + w] -= taken
    found[n:] = 0.0
    found[:n] /= pivots[:, None]
    for i in range(n - 2, -1, -1):
        np.multiply(across[i], found[i + 1 : i + 1 + w], out=taken)
        found[i] -= np.add.reduce(taken, axis=0)
    return found[:n]


def count_below(stiffness: Array, mass: Array, shifts: Array) -> tuple[Array, Array]:
    """(how many eigenvalues of K v = lambda M v lie below each shift, how far rounding may have moved that), (c,) both.

    As many as K - shift M has negative pivots (Sylvester), which are those of a matrix as far off as |L| |d| |L|^T times
    the rounding of a row: what that does to the eigenvalues is the second.
    """
    pivots, lower = triangles(stiffness - shifts * mass)
    n, w, _ = lower.shape
    sizes = abs(pivots)
    grown = sizes.copy()
    for a in range(w):
        grown[1 + a :] += lower[: n - 1 - a, a] ** 2 * sizes[: n - 1 - a]
    moved = _CAUTION * (2 * w + 1) * np.finfo(float).eps * (grown / mass[:, 0]).max(axis=0)
    return (pivots < 0.0).sum(axis=0), moved
