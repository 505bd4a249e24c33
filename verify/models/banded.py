"""A driven pencil solved as a narrow band: strains and unknowns in the order in which they lie along the beam.

The mixed matrix [[-1/d, B], [B^T, -omega^2 M]] couples neighbours alone. Sorted by place it is a band a few wide, which
LAPACK factorises with row exchanges in a time that grows with the length of the beam alone.
"""

from typing import Any

import msgspec
import numpy as np

from verify.models.arrays import Array, ComplexArray, Indices

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

    def factors(self, omega2: float, stiffness: ComplexArray, unit: float, real: bool) -> "BandFactors | None":
        """The factors with unknowns in a `unit` (`driven.swing`), of real numbers where `real`; None if singular."""
        from scipy.linalg.lapack import dgbtrf, zgbtrf

        storage = np.array(self.coupling, dtype=float if real else complex, order="F")
        storage[2 * self.width, self.place[: self.n_strains]] = -1.0 / (unit * (stiffness.real if real else stiffness))
        storage[self.mass_at] -= omega2 * unit * self.masses
        factors, pivots, info = (dgbtrf if real else zgbtrf)(storage, self.width, self.width, overwrite_ab=True)
        return None if info else BandFactors(band=self, factors=factors, pivots=pivots, unit=unit)


class BandFactors(msgspec.Struct, frozen=True, eq=False, kw_only=True):
    """Of a mixed matrix in a narrow band."""

    band: Band
    factors: Any
    pivots: Any
    unit: float
    """Of the unknowns."""

    def answered(self, lacking: Any, loads: Any) -> tuple[Any, Any]:
        """(forces (m, k), unknowns (n, k)) to strains (m, k) that are lacking, None for none, and loads (n, k)."""
        from scipy.linalg.lapack import dgbtrs, zgbtrs

        place, m, width = self.band.place, self.band.n_strains, self.band.width
        right = np.zeros((len(place), loads.shape[1]), dtype=self.factors.dtype, order="F")
        if lacking is not None:
            right[place[:m]] = lacking / self.unit
        right[place[m:]] = loads
        solver = zgbtrs if np.iscomplexobj(right) else dgbtrs
        found, _ = solver(self.factors, width, width, right, self.pivots, overwrite_b=True)
        return found[place[:m]], self.unit * found[place[m:]]


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
