"""Symmetric bands of many pencils side by side: products, triangular factors, solutions and counts of all at once.

A band is kept by its main diagonal and those above it, (n, w + 1, c): entry [i, a, j] is A_{i, i + a} of matrix j,
zero beyond the last row. Vectors are (n, k, c), k of each matrix. Loops run over the rows; what numpy is given in each
is all matrices, so that a few hundred of them cost little more than one.
"""

import numpy as np

from verify.models.arrays import Array, Indices

_NEAR = 32768
"""Numbers that a product takes at once."""
_TALLIED = 8000
"""Shifts of matrices that are counted at once."""
_ROWS = 16
"""Pivots whose product is a number of ordinary size."""


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
    """A v, (n, k, c); `vectors` (n, k, 1) are the same of all matrices. Some rows at a time stay near the processor."""
    n, width, c = bands.shape
    found = np.empty((n, vectors.shape[1], c))
    most = max(_NEAR // found[0].size, 4)
    scratch = np.empty((most, *found.shape[1:]))
    for first in range(0, n, most):
        last = min(first + most, n)
        out = found[first:last]
        np.multiply(bands[first:last, :1], vectors[first:last], out=out)
        for above in range(1, width):
            for row, of, to in ((0, 0, above), (above, -above, -above)):
                start, stop = max(first, row), min(last, n - above + row)
                if stop > start:
                    part = scratch[: stop - start]
                    beside = bands[start + of : stop + of, above, None]
                    np.multiply(beside, vectors[start + to : stop + to], out=part)
                    out[start - first : stop - first] += part
    return found


def triangles(stiffness: Array, mass: Array, shifts: Array) -> tuple[Array, Array]:
    """(pivots d (n, k c), L (n, w, k c)) of K - shift M = L diag(d) L^T without row exchanges, for shifts (k, c).

    L by columns: entry [i, a, j] is L_{i + 1 + a, i}. Not a number below a pivot that is zero.
    """
    n, width, c = mass.shape
    rows, w = np.empty((n + width - 1, width, len(shifts) * c)), width - 1
    filled = rows[:n].reshape(n, width, len(shifts), c)
    np.multiply(mass[:, :, None], -shifts, out=filled)
    filled += stiffness[:, :, None]
    rows[n:] = 0.0
    kept, taken = np.empty_like(rows[0, 1:]), np.empty_like(rows[0, 1:])
    for i in range(n):
        lower = rows[i, 1:]
        kept[...] = lower
        np.divide(lower, rows[i, 0], out=lower)
        for a in range(w):
            left, part = rows[i + 1 + a, : w - a], taken[: w - a]
            np.multiply(lower[a], kept[a:], out=part)
            np.subtract(left, part, out=left)
    return rows[:n, 0], rows[:n, 1:]


def solution(pivots: Array, lower: Array, loads: Array) -> Array:
    """A^-1 b of the triangles of A, (n, k, c)."""
    n, w, _ = lower.shape
    found = np.empty((n + w, *loads.shape[1:]))
    found[:n], found[n:] = loads, 0.0
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


def count_below(stiffness: Array, mass: Array, shifts: Array) -> tuple[Indices, Array]:
    """(how many eigenvalues of K v = lambda M v lie below each shift, (c,), how the factors have grown, (n, c)).

    As many as K - shift M has negative pivots (Sylvester). These are the pivots of a matrix that is off by no more than
    the rounding of |L| |d| |L|^T, whose diagonal is the second.
    """
    pivots, lower = triangles(stiffness, mass, shifts[None])
    n, w, _ = lower.shape
    sizes = abs(pivots)
    grown = sizes.copy()
    for a in range(min(w, n - 1)):
        grown[1 + a :] += lower[: n - 1 - a, a] ** 2 * sizes[: n - 1 - a]
    return np.asarray((pivots < 0.0).sum(axis=0)), grown


def tally(stiffness: Array, mass: Array, shifts: Array) -> tuple[Indices, Array]:
    """(how many eigenvalues of K v = lambda M v lie below shifts, log |det(K - shift M)|), (k, c) both.

    As `triangles` goes, but of a row no more is kept than the next ones take.
    """
    at_once = max(_TALLIED // mass.shape[2], 1)
    found = [_tallied(stiffness, mass, shifts[first : first + at_once]) for first in range(0, len(shifts), at_once)]
    below, logs = (np.concatenate(each) for each in zip(*found, strict=True))
    return below, logs


def _tallied(stiffness: Array, mass: Array, shifts: Array) -> tuple[Indices, Array]:
    """The same of some of the shifts."""
    n, width, _ = mass.shape
    rows = [np.empty((width, *shifts.shape)) for _ in range(width)]
    shares, taken = np.empty_like(rows[0][1:]), np.empty_like(rows[0][1:])
    negative, below = np.empty(shifts.shape, dtype=bool), np.zeros(shifts.shape, dtype=np.uint8)
    product, logs = np.ones_like(shifts), np.zeros_like(shifts)
    for i in range(-width, n):
        own = rows[i % width]
        if i >= 0:
            np.signbit(own[0], out=negative)
            below += negative.view(np.uint8)
            product *= own[0]
            if i % _ROWS == _ROWS - 1 or i == n - 1:
                logs += np.log(abs(product))
                product[...] = 1.0
            np.divide(own[1:], own[0], out=shares)
            for a in range(width - 1):
                left, part = rows[(i + 1 + a) % width][: width - 1 - a], taken[: width - 1 - a]
                np.multiply(shares[a], own[1 + a :], out=part)
                left -= part
        if (entering := i + width) < n:
            np.multiply(mass[entering, :, None], -shifts, out=own)
            own += stiffness[entering, :, None]
        else:
            own[...] = 0.0
    return below.astype(np.intp), logs
