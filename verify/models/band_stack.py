"""Many pencils side by side: symmetric bands, what bodies add to them, triangular factors, solutions and counts of all.

A band is kept by its main diagonal and those above it, (n, w + 1, c): entry [i, a, j] is A_{i, i + a} of matrix j,
zero beyond the last row. A body adds the square of a row over all unknowns, which would make the band as wide as it
reaches; instead its motion stands beside the unknowns, after the last of them (Sylvester's law counts both alike).
Vectors are (n, k, c), k of each matrix. Loops run over the rows; what numpy is given in each is all matrices, so that
a few hundred of them cost little more than one.
"""

from math import ceil

import msgspec
import numpy as np

from verify.models.arrays import Array, Indices

_NEAR = 32768
"""Numbers that a product takes at once."""
_MOST = 1_500_000
"""Numbers in the factors that are tallied at once: 12 MB."""
_ROWS = 16
"""Pivots whose product is a number of ordinary size."""
_NEXT_TO_NOTHING = 1e-30
"""For a pivot that is zero: small beside any, and large enough to be divided by twice."""


class Pencils(msgspec.Struct, frozen=True, eq=False, kw_only=True):
    """K and M of c beams: bands, and F^T diag(held) F and F^T diag(heavy) F of what bodies feel."""

    stiffness: Array
    """(n, w + 1, c)."""
    mass: Array
    """(n, w + 1, c) or narrower."""
    felt: Array
    """F, (n, r, c), what r motions of bodies are of the unknowns; r = 0 where there are none."""
    held: Array
    """(r, c), stiffness against them."""
    heavy: Array
    """(r, c), mass that takes part in them."""

    @property
    def diagonals(self) -> tuple[Array, Array]:
        """K_ii and M_ii, (n, c) both."""
        squares = self.felt**2
        stiffness = self.stiffness[:, 0] + np.einsum("irc,rc->ic", squares, self.held)
        return stiffness, self.mass[:, 0] + np.einsum("irc,rc->ic", squares, self.heavy)

    @property
    def size(self) -> int:
        """Numbers in the factors of one of them."""
        return len(self.stiffness) * (self.stiffness.shape[1] + self.felt.shape[1] + 1)

    def of_beams(self, which: Indices) -> "Pencils":
        """Those of some beams, in this order."""
        return Pencils(**{name: np.take(getattr(self, name), which, axis=-1) for name in self.__struct_fields__})

    def weighed(self, vectors: Array) -> Array:
        """M v, (n, k, c)."""
        found = product(self.mass, vectors)
        for row, heavy in zip(self.felt.swapaxes(0, 1), self.heavy, strict=True):
            if heavy.any():
                found += row[:, None] * (heavy * np.einsum("ic,ikc->kc", row, vectors))
        return found


def banded(stiffness: Array, mass: Array) -> Pencils:
    """Bands without bodies."""
    none = np.zeros((0, mass.shape[2]))
    return Pencils(stiffness=stiffness, mass=mass, felt=np.zeros((len(mass), *none.shape)), held=none, heavy=none)


class Factors(msgspec.Struct, frozen=True, eq=False, kw_only=True):
    """[[A, F D], [D F^T, -S]] = L diag(d) L^T without row exchanges, of m matrices A + F D S D F^T, S of signs."""

    pivots: Array
    """d, (n + r, m)."""
    beside: Array
    """L_{i + 1 + a, i} d_i, (n, w, m)."""
    felt: Array
    """Of the rows of F, likewise, (n, r, m)."""
    corner: Array
    """Of the corner, likewise, (r, r, m), above its diagonal."""
    roots: Array
    """D, (r, m), roots of what the motions of bodies weigh."""
    signs: Array
    """S, (r, m)."""

    @property
    def below(self) -> Indices:
        """How many eigenvalues of each matrix are negative, (m,) (Sylvester)."""
        negative = np.signbit(self.pivots).view(np.uint8)
        if len(negative) > 255:
            return np.asarray(negative.sum(axis=0, dtype=np.intp) - (self.signs > 0.0).sum(axis=0))
        return np.add.reduce(negative, axis=0).astype(np.intp) - (self.signs > 0.0).sum(axis=0)

    @property
    def logs(self) -> Array:
        """Log |det|, (m,)."""
        parts = [np.multiply.reduce(self.pivots[i : i + _ROWS], axis=0) for i in range(0, len(self.pivots), _ROWS)]
        return np.asarray(sum(np.log(abs(part)) for part in parts))

    @property
    def grown(self) -> Array:
        """The diagonal of |L| |d| |L|^T, (n + r, m): the factors are those of a matrix that is off by its rounding."""
        found = abs(self.pivots)
        n, w, _ = self.beside.shape
        sizes, corner = found[:n].copy(), found[n:].copy()
        for a in range(min(w, n - 1)):
            found[1 + a : n] += self.beside[: n - 1 - a, a] ** 2 / sizes[: n - 1 - a]
        found[n:] += self.roots**2 * (self.felt**2 / sizes[:, None]).sum(axis=0)
        for j in range(len(corner)):
            found[n + j + 1 :] += self.corner[j, j + 1 :] ** 2 / corner[j]
        return np.asarray(found)

    def solve(self, loads: Array) -> Array:
        """A^-1 b, (n, k, m)."""
        n, w, _ = self.beside.shape
        inverse = 1.0 / self.pivots
        found, moved = self._forward(loads, inverse)
        for j in range(len(moved) - 1, -1, -1):
            for after in range(j + 1, len(moved)):
                moved[j] -= self.corner[j, after] * moved[after] * inverse[n + j]
        for row, share in zip(self.felt.swapaxes(0, 1), self.roots[:, None] * moved, strict=True):
            found[:n] -= (inverse[:n] * row)[:, None] * share
        taken = np.empty((w, *loads.shape[1:]))
        for i in range(n - 2, -1, -1):
            np.multiply(self.beside[i, :, None], found[i + 1 : i + 1 + w], out=taken)
            for a in range(1, w):
                taken[0] += taken[a]
            taken[0] *= inverse[i]
            found[i] -= taken[0]
        return found[:n]

    def energy(self, loads: Array) -> Array:
        """b^T A^-1 b, (k, m)."""
        found, moved = self._forward(loads, 1.0 / self.pivots)
        n = len(loads)
        inner = np.einsum("ikm,ikm,im->km", found[:n], found[:n], self.pivots[:n])
        return np.asarray(inner + np.einsum("rkm,rkm,rm->km", moved, moved, self.pivots[n:]))

    def _forward(self, loads: Array, inverse: Array) -> tuple[Array, Array]:
        """(D^-1 L^-1 b, (n + w, k, m) with zeros at the end, and of the corner, (r, k, m))."""
        n, w, _ = self.beside.shape
        found, taken = np.empty((n + w, *loads.shape[1:])), np.empty((w, *loads.shape[1:]))
        found[:n], found[n:] = loads, 0.0
        for i in range(n):
            found[i] *= inverse[i]
            np.multiply(self.beside[i, :, None], found[i], out=taken)
            found[i + 1 : i + 1 + w] -= taken
        found[n:] = 0.0
        moved = -self.roots[:, None] * np.einsum("irm,ikm->rkm", self.felt, found[:n])
        for j in range(len(moved)):
            moved[j] *= inverse[n + j]
            for after in range(j + 1, len(moved)):
                moved[after] -= self.corner[j, after] * moved[j]
        return found, moved


def factorised(pencils: Pencils, shifts: Array) -> Factors:
    """The factors of K - shift M for shifts (k, c), m = k c. Not a number below a pivot that is zero."""
    stiffness, mass, felt = pencils.stiffness, pencils.mass, pencils.felt
    (n, width, c), narrow, r = stiffness.shape, mass.shape[1], felt.shape[1]
    w = width - 1
    rows = np.empty((n + w, width + r, len(shifts) * c))
    filled = rows[:n].reshape(n, width + r, len(shifts), c)
    np.multiply(mass[:, :, None], -shifts, out=filled[:, :narrow])
    filled[:, :narrow] += stiffness[:, :narrow, None]
    filled[:, narrow:width] = stiffness[:, narrow:, None]
    filled[:, width:] = felt[:, :, None]
    rows[n:] = 0.0
    shares, taken = np.empty_like(rows[0, 1:width]), np.empty_like(rows[0, 1:])
    for i in range(n):
        own = rows[i, 1:]
        np.divide(own[:w], rows[i, 0], out=shares)
        for a in range(w):
            left, part = rows[i + 1 + a], taken[: w - a]
            np.multiply(shares[a], own[a:w], out=part)
            left[: w - a] -= part
            if r:
                np.multiply(shares[a], own[w:], out=taken[:r])
                left[width:] -= taken[:r]
    own = (pencils.held[:, None] - shifts * pencils.heavy[:, None]).reshape(r, rows.shape[2])
    pivots, corner, signs = _cornered(rows[:n, 0], rows[:n, width:], own)
    return Factors(
        pivots=pivots,
        beside=rows[:n, 1:width],
        felt=rows[:n, width:],
        corner=corner,
        roots=np.sqrt(abs(own)),
        signs=signs,
    )


def _cornered(pivots: Array, felt: Array, own: Array) -> tuple[Array, Array, Array]:
    """(all pivots, the corner's factors, signs) of what bodies weigh, (r, m)."""
    r = len(own)
    if not r:
        return pivots, np.empty((0, 0, own.shape[1])), own
    signs, roots = np.where(own < 0.0, -1.0, 1.0), np.sqrt(abs(own))
    corner = np.empty((r, r, own.shape[1]))
    scaled = felt / pivots[:, None]
    for j in range(r):
        for after in range(j, r):
            corner[j, after] = -roots[j] * roots[after] * np.einsum("im,im->m", felt[:, j], scaled[:, after])
        corner[j, j] -= signs[j]
    for j in range(r):
        for after in range(j + 1, r):
            corner[after, after:] -= corner[j, after] / corner[j, j] * corner[j, after:]
    return np.concatenate([pivots, corner[range(r), range(r)]]), corner, signs


def regular(factors: Factors) -> Factors:
    """The same with next to nothing for a pivot that is zero, at an eigenvalue to the last digit."""
    factors.pivots[factors.pivots == 0.0] = _NEXT_TO_NOTHING
    return factors


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


def tally(pencils: Pencils, shifts: Array) -> tuple[Indices, Array]:
    """(how many eigenvalues of K v = lambda M v lie below shifts, log |det(K - shift M)|), (k, c) both."""
    found = []
    for some in in_parts(pencils, shifts):
        factors = factorised(pencils, some)
        found.append((factors.below.reshape(some.shape), factors.logs.reshape(some.shape)))
    below, logs = (np.concatenate(each) for each in zip(*found, strict=True))
    return below, logs


def in_parts(pencils: Pencils, shifts: Array) -> list[Array]:
    """Shifts (k, c) in equal parts whose factors are not too many to stay near the processor."""
    most = max(_MOST // (pencils.size * shifts.shape[1]), 1)
    return np.array_split(shifts, ceil(len(shifts) / most))
