"""A structural system in factored form, K = B^T diag(d) B, and its augmented matrix.

Rounding in an assembled K costs the low eigenvalues of a beam n^4 eps; B is applied as successive differences instead.
The augmented (saddle-point) matrix [[-1/d, B], [B^T, -s M]] is valid for stiffnesses of any size and sign.

Unknowns, stiffnesses and masses are dimensionless, of order one; models scale them.
"""

from collections.abc import Sequence
from dataclasses import dataclass, field
from functools import cached_property
from typing import Any

import numpy as np

from verify.arrays import Array, Indices, Numeric, Sparse


def sparse_rows(columns: Indices, values: Array, n: int) -> Sparse:
    """Sparse (r, n) with values (r, c) at columns (r, c), without zeros and columns outside 0..n - 1."""
    from scipy.sparse import csr_array

    stored = (values != 0.0) & (columns >= 0) & (columns < n)
    starts = np.concatenate([[0], np.cumsum(stored.sum(axis=1))])
    return csr_array((values[stored], columns[stored], starts), shape=(len(columns), n))


@dataclass(frozen=True, eq=False)
class FactoredSystem:
    """K = B^T diag(d) B and M over n unknowns, B a product of sparse factors."""

    strain_factors: Sequence[Sparse]
    """Sparse; B = factors[-1] @ ... @ factors[0]. The first factors are differences, exact in floating point."""
    stiffness: Array  # d, (m,); negative where an axial compression releases energy
    mass: Sparse  # M, (n, n), sparse by columns
    rigid: Array = field(default_factory=lambda: np.zeros((0, 0)))
    """(n, r), rigid-body motions, whose zero eigenvalues are excluded."""
    lower_bound: float = 0.0
    """Lower bound of all eigenvalues without `bodies`, the shift of Lanczos: a stiff foundation clusters them above."""
    bodies: Sparse | None = None
    """Sparse rows R (r, n) of attached bodies, R^T R a part of M: r eigenvalues may be below `lower_bound`."""

    @property
    def n(self) -> int:
        """Number of unknowns."""
        return int(self.mass.shape[0])

    @property
    def n_rigid(self) -> int:
        """Number of rigid-body motions."""
        return int(self.rigid.shape[1]) if self.rigid.size else 0

    def strain(self, vectors: Numeric) -> Numeric:
        """B v, (m, k), of v (n, k)."""
        for factor in self.strain_factors:
            vectors = factor @ vectors
        return vectors

    @cached_property
    def transposed(self) -> Sparse:
        """B^T, (n, m), sparse by rows."""
        product = self.strain_factors[-1]
        for factor in reversed(self.strain_factors[:-1]):
            product = product @ factor
        return product.T.tocsr()

    @cached_property
    def _pattern(self) -> tuple[Array, Indices, Any, Any, Array]:
        """[[-1, B], [B^T, M]]: values by block; their order by columns, rows and starts of columns; scales.

        Rows of soft strains are scaled by powers of two: an infinite 1/d costs the other rows their digits.
        """
        m, scales = len(self.stiffness), np.exp2(np.minimum(np.round(0.5 * np.log2(abs(self.stiffness))), 0.0))
        strain, mass, diagonal = self.transposed.T.tocoo(), self.mass.tocoo(), np.arange(m)
        rows = np.concatenate([diagonal, strain.row, m + strain.col, m + mass.row])
        columns = np.concatenate([diagonal, m + strain.col, strain.row, m + mass.col])
        values = strain.data * scales[strain.row]
        order = np.lexsort((rows, columns))
        starts = np.concatenate([[0], np.cumsum(np.bincount(columns, minlength=m + self.n))])
        values = np.concatenate([-np.ones(m), values, values, mass.data])
        return values, order, rows[order].astype(np.int32), starts.astype(np.int32), scales

    def augmented(self, mass_factor: float, stiffness: Any = None) -> Any:
        """[[-1/d, B], [B^T, mass_factor M]], sparse by columns; the pattern is built once, the data per frequency."""
        from scipy.sparse import csc_array

        d, m = self.stiffness if stiffness is None else stiffness, len(self.stiffness)
        values, order, rows, starts, scales = self._pattern
        data = values.astype(d.dtype)
        data[:m] *= scales**2 / d
        data[len(data) - self.mass.nnz :] *= mass_factor
        return csc_array((data[order], rows, starts), shape=(m + self.n,) * 2)
