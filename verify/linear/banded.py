"""A driven pencil solved as a narrow band: strains and unknowns in the order in which they lie along the beam.

The mixed matrix [[-1/d, B], [B^T, -omega^2 M]] couples neighbours alone. Sorted by place it is a band a few wide, which
LAPACK factorises with row exchanges in a time that grows with the length of the beam alone.
"""

from typing import Any

import msgspec
import numpy as np
from msgspec.structs import replace

from verify.arrays import Array, ComplexArray, Indices

WIDEST = 24
"""Diagonals beside the main one up to which a band is taken for narrow."""


class Band(msgspec.Struct, frozen=True, eq=False, kw_only=True):
    """Where the entries of a mixed matrix stand in LAPACK's storage of its band."""

    n_strains: int
    place: Indices
    """(n_strains + n,), at which row of the band each strain and then each unknown stands."""
    width: int
    """Diagonals on either side."""
    coupling: Array
    """(rows, n_strains + n), the part that no frequency and no stiffness changes."""
    mass_at: tuple[Indices, Indices]
    """Row and column of every entry of M in the storage."""
    masses: Array
    """Those entries."""

    def answer(self, loads: Any, omega2: float, stiffness: ComplexArray, unit: float) -> "BandAnswer | None":
        """What answers loads (n, k), of unknowns in a `unit` (`swing`); None where the band is singular."""
        from scipy.linalg.lapack import dgbsv, zgbsv

        real = not np.iscomplexobj(loads) and not stiffness.imag.any()
        kind, solver = (float, dgbsv) if real else (complex, zgbsv)
        storage = np.array(self.coupling, dtype=kind, order="F")
        storage[2 * self.width, self.place[: self.n_strains]] = -1.0 / (unit * (stiffness.real if real else stiffness))
        storage[self.mass_at] -= omega2 * unit * self.masses
        right = np.zeros((len(self.place), loads.shape[1]), dtype=kind, order="F")
        right[self.place[self.n_strains :]] = loads
        factors, pivots, found, info = solver(
            self.width, self.width, storage, right, overwrite_ab=True, overwrite_b=True
        )
        return None if info else BandAnswer(band=self, factors=factors, pivots=pivots, found=found, unit=unit)


class BandAnswer(msgspec.Struct, frozen=True, eq=False, kw_only=True):
    """What a narrow band answered, and its factors for what else is asked."""

    band: Band
    factors: Any
    pivots: Any
    found: Any
    """(n_strains + n, k), in the order of the band."""
    unit: float
    """Of the unknowns."""

    @property
    def forces(self) -> Any:
        """In the strains, (m, k)."""
        return self.found[self.band.place[: self.band.n_strains]]

    @property
    def unknowns(self) -> Any:
        """(n, k)."""
        return self.unit * self.found[self.band.place[self.band.n_strains :]]

    def to(self, lacking: Any, loads: Any) -> "BandAnswer":
        """The answer to strains (m, k) that are lacking and to loads (n, k)."""
        from scipy.linalg.lapack import dgbtrs, zgbtrs

        band, right = self.band, np.empty_like(self.found, order="F")
        right[band.place[: band.n_strains]] = lacking / self.unit
        right[band.place[band.n_strains :]] = loads
        solver = zgbtrs if np.iscomplexobj(right) else dgbtrs
        found, _ = solver(self.factors, band.width, band.width, right, self.pivots, overwrite_b=True)
        return replace(self, found=found)


def band_of(strain: Any, mass: Any) -> Band | None:
    """The band of B (m, n) and M (n, n), dense or sparse; None where it is not narrow."""
    rows, columns, values = _entries(strain)
    mass_rows, mass_columns, masses = _entries(mass)
    n_strains, n = strain.shape
    touched = np.maximum(np.bincount(rows, minlength=n_strains), 1)
    middles = np.bincount(rows, weights=columns, minlength=n_strains) / touched
    order = np.argsort(np.concatenate([middles, np.arange(n)]), kind="stable")
    place = np.empty(n_strains + n, dtype=np.intp)
    place[order] = np.arange(n_strains + n)
    first, second = place[rows], place[n_strains + columns]
    third, fourth = place[n_strains + mass_rows], place[n_strains + mass_columns]
    width = int(max(abs(first - second).max(initial=0), abs(third - fourth).max(initial=0)))
    if width > WIDEST:
        return None
    coupling = np.zeros((3 * width + 1, n_strains + n), order="F")
    coupling[2 * width + first - second, second] = values
    coupling[2 * width + second - first, first] = values
    at = (2 * width + third - fourth, fourth)
    return Band(n_strains=n_strains, place=place, width=width, coupling=coupling, mass_at=at, masses=masses)


def _entries(matrix: Any) -> tuple[Indices, Indices, Array]:
    """(rows, columns, values) of what is not zero."""
    if isinstance(matrix, np.ndarray):
        rows, columns = np.nonzero(matrix)
        return rows, columns, matrix[rows, columns]
    found = matrix.tocoo()
    return found.row, found.col, found.data
