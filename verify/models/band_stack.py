"""Many pencils side by side: symmetric bands, what bodies add to them, triangular factors, solutions and counts of all.

A band is kept by its main diagonal and those above it, (n, w + 1, c): entry [i, a, j] is A_{i, i + a} of matrix j,
zero beyond the last row. A body adds the square of a row over all unknowns, which would make the band as wide as it
reaches; instead its motion stands beside the unknowns, after the last of them (Sylvester's law counts both alike).
Vectors are (n, k, c), k of each matrix. Loops run over the rows; what numpy is given in each is all matrices, so that
a few hundred of them cost little more than one.
"""

from collections.abc import Iterator
from math import ceil
from typing import TypeAlias

import msgspec
import numpy as np

from verify.models.arrays import Array, Indices

_NEAR = 32768
"""Numbers that a product takes at once."""
_MOST = 6_000_000
"""Numbers in factors that are taken at once: 48 MB."""
_FEW = 500_000
"""Numbers in factors of which all rows stay near the processor."""
_ROWS = 16
"""Pivots whose product is a number of ordinary size."""
_NEXT_TO_NOTHING = 1e-30
"""For a pivot that is zero: small beside any, and large enough to be divided by twice."""


_Step: TypeAlias = tuple[int, Array, list[Array], list[Array], Array]
"""(How far after a row, its share there, of what of each row, from what of each row, scratch)."""


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
        n, width, _ = self.stiffness.shape
        return int(n * (width + self.felt.shape[1]))

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


class Pivots(msgspec.Struct, frozen=True, eq=False, kw_only=True):
    """D of the factors below of m matrices A + F D S D F^T, S of signs."""

    pivots: Array
    """d, (n + r, m)."""
    signs: Array
    """S, (r, m)."""

    @property
    def below(self) -> Indices:
        """How many eigenvalues of each matrix are negative, (m,) (Sylvester)."""
        negative = np.signbit(self.pivots).view(np.uint8)
        kind = np.uint8 if len(negative) < 256 else np.intp
        count: Indices = np.add.reduce(negative, axis=0, dtype=kind).astype(np.intp)
        return np.asarray(count - (self.signs > 0.0).sum(axis=0))

    @property
    def logs(self) -> Array:
        """Log |det|, (m,)."""
        parts = [np.multiply.reduce(self.pivots[i : i + _ROWS], axis=0) for i in range(0, len(self.pivots), _ROWS)]
        return np.asarray(sum(np.log(abs(part)) for part in parts))


class Factors(Pivots, frozen=True, eq=False, kw_only=True):
    """[[A, F D], [D F^T, -S]] = L diag(d) L^T without row exchanges."""

    beside: Array
    """L_{i + 1 + a, i} d_i, (n, w, m)."""
    felt: Array
    """Of the rows of F^T, likewise, (n, r, m)."""
    corner: Array
    """Of the corner, likewise, above its diagonal, (r, r, m)."""
    roots: Array
    """D, (r, m), roots of what the motions of bodies weigh."""

    @property
    def grown(self) -> Array:
        """The diagonal of |L| |d| |L|^T, (n + r, m): the factors are those of a matrix that is off by its rounding."""
        sizes = abs(self.pivots)
        found, (n, w, _) = sizes.copy(), self.beside.shape
        for a in range(min(w, n - 1)):
            found[1 + a : n] += self.beside[: n - 1 - a, a] ** 2 / sizes[: n - 1 - a]
        found[n:] += self.roots**2 * (self.felt**2 / sizes[:n, None]).sum(axis=0)
        for j in range(len(self.corner)):
            found[n + j + 1 :] += self.corner[j, j + 1 :] ** 2 / sizes[n + j]
        return np.asarray(found)

    def solve(self, loads: Array) -> Array:
        """A^-1 b, (n, k, m)."""
        return self._back(*self._forward(loads))

    def energy(self, loads: Array) -> Array:
        """b^T A^-1 b, (k, m)."""
        found, moved = self._forward(loads)
        inner = _energies(found[: len(loads)], self.pivots[: len(loads)])
        return inner + _energies(moved, self.pivots[len(loads) :])

    def _forward(self, loads: Array) -> tuple[Array, Array]:
        """(D^-1 L^-1 b, (n + w, k, m), zeros at the end; of the corner, (r, k, m))."""
        n, w, m = self.beside.shape
        found, taken = np.empty((n + w, loads.shape[1], m)), np.empty((w, loads.shape[1], m))
        found[:n], found[n:] = loads, 0.0
        rows = zip(self.pivots, self.beside[:, :, None], found, _windows(found, w), strict=False)
        for pivot, beside, own, after in rows:
            np.divide(own, pivot, own)
            np.multiply(beside, own, taken)
            np.subtract(after, taken, after)
        found[n:] = 0.0
        moved = -self.roots[:, None] * np.einsum("irm,ikm->rkm", self.felt, found[:n])
        for j, across in enumerate(self.corner):
            moved[j] /= self.pivots[n + j]
            for later in range(j + 1, len(across)):
                moved[later] -= across[later] * moved[j]
        return found, moved

    def _back(self, found: Array, moved: Array) -> Array:
        """L^-T of what `_forward` gives, in its place, (n, k, m)."""
        n, w, _ = self.beside.shape
        for j in range(len(moved) - 1, -1, -1):
            for after in range(j + 1, len(moved)):
                moved[j] -= self.corner[j, after] / self.pivots[n + j] * moved[after]
        if len(moved):
            found[:n] -= np.einsum("irm,rkm->ikm", self.felt, self.roots[:, None] * moved) / self.pivots[:n, None]
        if not w:
            return found
        taken = np.empty((w, *found.shape[1:]))
        first, others = taken[0], list(taken[1:])
        rows = zip(self.beside[:, :, None], self.pivots, found, _windows(found, w), strict=False)
        for beside, pivot, own, after in reversed(list(rows)[: n - 1]):
            np.multiply(beside, after, taken)
            for other in others:
                np.add(first, other, first)
            np.divide(first, pivot, first)
            np.subtract(own, first, own)
        return found[:n]


def _windows(rows: Array, w: int) -> list[Array]:
    """After each row the w next ones."""
    return [rows[i : i + w] for i in range(1, len(rows) - w + 1)]


def _energies(shares: Array, pivots: Array) -> Array:
    return np.asarray(np.einsum("ikm,ikm,im->km", shares, shares, pivots))


def factorised(pencils: Pencils, shifts: Array) -> Factors:
    """The factors of K - shift M for shifts (k, c), m = k c. Not a number below a pivot that is zero."""
    (n, width, _), r = pencils.stiffness.shape, pencils.felt.shape[1]
    rows, corner = _window(pencils, shifts, n + width - 1), np.zeros((r, r, shifts.size))
    for _ in _eliminated(pencils, shifts, rows, corner):
        pass
    rows = rows[:n].reshape(n, width + r, -1)
    roots, signs = _cornered(_of_bodies(pencils, shifts), corner)
    return Factors(
        pivots=np.concatenate([rows[:, 0], corner[range(r), range(r)]]) if r else rows[:, 0],
        signs=signs,
        beside=rows[:, 1:width],
        felt=rows[:, width:],
        corner=corner,
        roots=roots,
    )


def tally(pencils: Pencils, shifts: Array) -> tuple[Indices, Array]:
    """(how many eigenvalues of K v = lambda M v lie below shifts, log |det(K - shift M)|), (k, c) both."""
    found = []
    for some in in_parts(pencils, shifts):
        pivots = _pivots(pencils, some)
        found.append((pivots.below.reshape(some.shape), pivots.logs.reshape(some.shape)))
    below, logs = (np.concatenate(each) for each in zip(*found, strict=True))
    return below, logs


def _pivots(pencils: Pencils, shifts: Array) -> Pivots:
    """Those of the factors of K - shift M alone."""
    (n, width, _), r = pencils.stiffness.shape, pencils.felt.shape[1]
    pivots, corner = np.empty((n + r, shifts.size)), np.zeros((r, r, shifts.size))
    few = shifts.size * pencils.size < _FEW
    rows = _window(pencils, shifts, n + width - 1 if few else width)
    for i, pivot in enumerate(_eliminated(pencils, shifts, rows, corner)):
        pivots[i] = pivot
    _, signs = _cornered(_of_bodies(pencils, shifts), corner)
    pivots[n:] = corner[range(r), range(r)]
    return Pivots(pivots=pivots, signs=signs)


def _window(pencils: Pencils, shifts: Array, n_rows: int) -> Array:
    """Room for rows of K - shift M and of what bodies feel, (n_rows, w + 1 + r, k, c)."""
    return np.empty((n_rows, pencils.stiffness.shape[1] + pencils.felt.shape[1], *shifts.shape))


def _eliminated(pencils: Pencils, shifts: Array, window: Array, corner: Array) -> Iterator[Array]:
    """The pivots of K - shift M, (m,), one after another, with the row of the factors in a window (`_window`).

    In a window of w + 1 rows, which stay near the processor, each row takes the place of the one w + 1 before; one of
    n + w keeps them all. What rows take from what bodies feel of each other is taken from `corner`, (r, r, m), on and
    above its diagonal.
    """
    (n, width, _), length, less = pencils.stiffness.shape, len(window), -shifts
    whole, w = length > n, width - 1
    _enter(pencils, less, 0, window if whole else window[:w])
    rows = window.reshape(*window.shape[:2], -1)
    shares = np.empty_like(rows[0, 1:])
    pivots, others, steps = list(rows[:, 0]), list(rows[:, 1:]), _steps(rows, shares, width)
    if not whole:
        steps += _steps_of_bodies(rows, shares, width, corner)
    for i in range(n):
        here = i % length
        if not whole:
            _enter(pencils, less, i + w, window[(i + w) % length, None])
        np.divide(others[here], pivots[here], shares)
        for a, share, owns, lefts, part in steps:
            left = lefts[(i + a) % length]
            np.multiply(share, owns[here], part)
            np.subtract(left, part, left)
        yield pivots[here]
    for b in range(len(corner) if whole else 0):
        corner[b, b:] -= np.einsum("im,iam->am", rows[:n, width + b] / rows[:n, 0], rows[:n, width + b :])


def _enter(pencils: Pencils, less: Array, first: int, rows: Array) -> None:
    """Put rows of K + less M, from `first` on, and of what bodies feel in their room; zeros after the last of them."""
    (n, width, _), narrow = pencils.stiffness.shape, pencils.mass.shape[1]
    last = min(first + len(rows), n)
    there, rows[last - first :] = rows[: last - first], 0.0
    np.multiply(pencils.mass[first:last, :, None], less, out=there[:, :narrow])
    there[:, :narrow] += pencils.stiffness[first:last, :narrow, None]
    there[:, narrow:width] = pencils.stiffness[first:last, narrow:, None]
    there[:, width:] = pencils.felt[first:last, :, None]


def _steps(rows: Array, shares: Array, width: int) -> list[_Step]:
    """What each row takes from those after it, in a window (length, w + 1 + r, m)."""
    taken, w, bodies = np.empty_like(shares), width - 1, rows.shape[1] > width
    steps = [(a + 1, shares[a], list(rows[:, 1 + a : width]), list(rows[:, : w - a]), taken[a:w]) for a in range(w)]
    felt = list(rows[:, width:])
    return steps + [(a + 1, shares[a], felt, felt, taken[w:]) for a in range(w) if bodies]


def _steps_of_bodies(rows: Array, shares: Array, width: int, corner: Array) -> list[_Step]:
    """What each row takes from what bodies feel of each other."""
    taken = np.empty(corner.shape[1:])
    return [
        (0, shares[width - 1 + b], list(rows[:, width + b :]), [corner[b, b:]] * len(rows), taken[b:])
        for b in range(len(corner))
    ]


def _of_bodies(pencils: Pencils, shifts: Array) -> Array:
    """What the motions of bodies weigh, (r, m)."""
    return np.asarray((pencils.held[:, None] - shifts * pencils.heavy[:, None]).reshape(len(pencils.held), shifts.size))


def _cornered(own: Array, corner: Array) -> tuple[Array, Array]:
    """(roots of what the motions of bodies weigh, their signs), (r, m) all; `corner` becomes that of the factors."""
    signs, roots = np.where(own < 0.0, -1.0, 1.0), np.sqrt(abs(own))
    for j in range(len(corner)):
        corner[j, j:] *= roots[j] * roots[j:]
        corner[j, j] -= signs[j]
    for j in range(len(corner)):
        for after in range(j + 1, len(corner)):
            corner[after, after:] -= corner[j, after] / corner[j, j] * corner[j, after:]
    return roots, signs


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
        last = first + most
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


def in_parts(pencils: Pencils, shifts: Array) -> list[Array]:
    """Shifts (k, c) in equal parts whose factors are not too many to stay near the processor."""
    most = max(_MOST // (pencils.size * shifts.shape[1]), 1)
    return np.array_split(shifts, ceil(len(shifts) / most))
