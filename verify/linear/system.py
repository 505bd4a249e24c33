"""Linear structural systems kept in factored form, K = B^T diag(d) B: modes, harmonic response, buckling.

An assembled K loses the low eigenvalues of a beam to rounding like n^4 eps. Here the vectors may come from any solver;
each eigenvalue is the Rayleigh quotient sum d (B v)^2 / v^T M v, with B applied as successive differences, so that its
error is of second order in that of the vector. Factorisations use the augmented (saddle-point) matrix
[[-1/d, B], [B^T, -s M]], which never forms B^T diag(d) B and takes stiffnesses of any size and sign.

Unknowns, stiffnesses and masses are dimensionless, of order one; models scale them.
"""

from collections.abc import Sequence
from dataclasses import dataclass, field
from functools import cached_property
from typing import Any

import numpy as np

from verify.arrays import Array, BoolArray, ComplexArray
from verify.errors import InputError

DENSE = 150
"""Unknowns up to which all modes come from one singular value decomposition, which is faster than Lanczos there."""
MOST_MODES = 1000
"""Unknowns of which all modes are computed: beyond, the decomposition takes minutes and gigabytes."""
RESONANCE = 1e-9
"""Relative distance in frequency to an undamped resonance below which a response is rounding."""
FEW = 4
"""Frequencies up to which each is solved by itself: all modes cost more than a few factorisations."""


@dataclass(frozen=True, eq=False)
class StructuralSystem:
    """K = B^T diag(d) B and M over n unknowns. B is a product of sparse factors, applied one after another."""

    strain_factors: Sequence[Any]
    """Sparse; B = factors[-1] @ ... @ factors[0]. The first take plain differences, which are exact."""
    stiffness: Array
    """d, (m,); negative where an axial compression releases energy."""
    mass: Any
    """M, (n, n), sparse by columns."""
    rigid: Array = field(default_factory=lambda: np.zeros((0, 0)))
    """(n, r), motions without strain, whose zero eigenvalues are left out."""
    lower_bound: float = 0.0
    """Lower bound of all eigenvalues. A hard foundation raises them to where they lie close together; the shift of
    Lanczos follows it."""

    @property
    def n(self) -> int:
        """Number of unknowns."""
        return int(self.mass.shape[0])

    @property
    def n_rigid(self) -> int:
        """Number of rigid-body motions."""
        return int(self.rigid.shape[1]) if self.rigid.size else 0

    def strain(self, vectors: Any) -> Any:
        """B v, (m, k), of v (n, k)."""
        for factor in self.strain_factors:
            vectors = factor @ vectors
        return vectors

    @cached_property
    def strain_matrix(self) -> Any:
        """B, (m, n), sparse by columns."""
        product = self.strain_factors[0]
        for factor in self.strain_factors[1:]:
            product = factor @ product
        return product.tocsc()

    def rayleigh_quotients(self, vectors: Array) -> Array:
        """Eigenvalues (k,) of vectors (n, k), accurate to rounding where the vectors are to half of the digits."""
        energies = self.stiffness[:, None] * self.strain(vectors) ** 2
        # pairwise sums over rows that are contiguous: one after another, a million terms leave 1e-12
        return np.asarray(np.ascontiguousarray(energies.T).sum(axis=1) / self._modal_masses(vectors))

    def _modal_masses(self, vectors: Array) -> Array:
        return np.asarray(np.ascontiguousarray((vectors * (self.mass @ vectors)).T).sum(axis=1))

    # --- Modes ---------------------------------------------------------------------------------------------------

    def modes(self, k: int) -> tuple[Array, Array]:
        """The lowest k elastic eigenvalues omega^2 (k,), ascending, and vectors (n, k) of unit modal mass.

        Raises InputError where a compression leaves no positive eigenvalue.
        """
        if self.n <= DENSE or 3 * (k + self.n_rigid) > self.n:
            vectors = self._by_svd(k) if self.stiffness.min() > 0.0 else self._by_dense_pencil(k)
        else:
            vectors = self._by_lanczos(k)
        values = self.rayleigh_quotients(vectors)
        if values.min(initial=1.0) <= 0.0:
            raise InputError("beam.tension: the compression buckles this model, compress less or hold the beam better")
        order = np.argsort(values, kind="stable")
        return values[order], (vectors / np.sqrt(self._modal_masses(vectors)))[:, order]

    @cached_property
    def all_modes(self) -> tuple[Array, Array]:
        """All elastic eigenvalues and vectors, as `modes`. Raises InputError beyond `MOST_MODES` unknowns."""
        if self.n > MOST_MODES:
            raise InputError(
                f"all {self.n} modes of the model are needed, more than {MOST_MODES}: lower count, or leave out "
                "modal_damping"
            )
        return self.modes(self.n - self.n_rigid)

    def _by_svd(self, k: int) -> Array:
        """From the singular values of diag(d)^(1/2) B L^-T with M = L L^T, conditioned like n^2 and not n^4."""
        inverse = np.linalg.inv(np.linalg.cholesky(self.mass.toarray()))
        root = np.sqrt(self.stiffness)[:, None] * self.strain(inverse.T)
        right = np.linalg.svd(root, full_matrices=root.shape[0] < self.n)[2]
        last = self.n - self.n_rigid
        return np.asarray(inverse.T @ right[last - k : last].T)

    def _by_dense_pencil(self, k: int) -> Array:
        """From the assembled matrices, for negative stiffnesses, which have no square root: few unknowns only."""
        from scipy.linalg import eigh

        strain = self.strain(np.eye(self.n))
        first = self.n_rigid
        pencil = strain.T @ (self.stiffness[:, None] * strain), self.mass.toarray()
        return np.asarray(eigh(*pencil, subset_by_index=[first, first + k - 1])[1])

    def _by_lanczos(self, k: int) -> Array:
        """Shift and invert; without a shift, rigid-body motions are held, and projected out of load and response."""
        from scipy.sparse.linalg import ArpackNoConvergence, LinearOperator, eigsh, splu

        shift = 0.999 * self.lower_bound
        free = np.arange(self.n) if shift else np.delete(np.arange(self.n), self._grounded())
        kept = np.concatenate([np.arange(len(self.stiffness)), len(self.stiffness) + free])
        matrix = self.augmented(-shift)
        factor = splu(matrix if len(free) == self.n else matrix[kept][:, kept])
        m = len(self.stiffness)

        def solve(load: Array) -> Array:
            right, response = np.zeros(m + len(free)), np.zeros(self.n)
            right[m:] = self._without_rigid_load(load)[free]
            response[free] = factor.solve(right)[m:]
            return self._without_rigid(response)

        inverse = LinearOperator((self.n, self.n), matvec=lambda b: solve(b.ravel()), dtype=float)
        start = self._without_rigid(np.random.default_rng(0).standard_normal(self.n))
        try:
            return np.asarray(
                eigsh(inverse, k, M=self.mass, sigma=shift, OPinv=inverse, v0=start, ncv=min(k + 30, self.n))[1]
            )
        except ArpackNoConvergence:
            raise InputError(
                f"the lowest {k} of {self.n} modes do not converge: hold the beam better, or lower count"
            ) from None

    @cached_property
    def _rigid_dual(self) -> tuple[Array, Array]:
        """(M R, R (R^T M R)^-1), each (n, r)."""
        inertia = self.mass @ self.rigid
        return inertia, np.linalg.solve(self.rigid.T @ inertia, self.rigid.T).T

    def _without_rigid(self, vector: Array) -> Array:
        if not self.n_rigid:
            return vector
        inertia, dual = self._rigid_dual
        return np.asarray(vector - dual @ (inertia.T @ vector))

    def _without_rigid_load(self, load: Array) -> Array:
        if not self.n_rigid:
            return load
        inertia, dual = self._rigid_dual
        return np.asarray(load - inertia @ (dual.T @ load))

    def _grounded(self) -> list[int]:
        """One unknown for each rigid-body motion that, held, leaves none (pivots of a Gaussian elimination)."""
        motions, held = self.rigid.copy() if self.n_rigid else np.zeros((self.n, 0)), []
        for j in range(motions.shape[1]):
            held.append(int(abs(motions[:, j]).argmax()))
            motions[:, j + 1 :] -= np.outer(motions[:, j] / motions[held[-1], j], motions[held[-1], j + 1 :])
        return held

    # --- Harmonic response ---------------------------------------------------------------------------------------

    def augmented(self, mass_factor: complex, stiffness: Any = None, corner: Any = None, border: Any = None) -> Any:
        """[[-1/d, B], [B^T, mass_factor M + corner]], sparse by columns; `border` (p, n) appends constraint rows.

        Rows of soft strains are scaled by powers of two: an endless 1/d beside others costs their digits.
        """
        from scipy.sparse import block_array, csc_array, diags_array

        d = self.stiffness if stiffness is None else stiffness
        scales = np.exp2(np.minimum(np.round(0.5 * np.log2(abs(d))), 0.0))
        strain = diags_array(scales) @ self.strain_matrix
        inner = mass_factor * self.mass if mass_factor else None
        if corner is not None:
            inner = corner if inner is None else inner + corner
        rows: list[list[Any]] = [[diags_array(-(scales**2) / d), strain], [strain.T, inner]]
        if border is not None:
            rows = [[*rows[0], None], [*rows[1], border.T], [None, border, None]]
        return csc_array(block_array(rows, format="csc"))

    def harmonic(
        self, loads: Any, omega2: float, stiffness: Any = None, devices: Sequence[tuple[Any, complex]] = ()
    ) -> Any:
        """The steady response (n, k) to loads (n, k): (K + devices - omega^2 M) v = load.

        `stiffness` is d with losses, complex (m,). A device is a sparse row (1, n), which reads its displacement, and
        its dynamic stiffness k + i omega c - omega^2 m. Raises LinAlgError within `RESONANCE` of a resonance where
        nothing is damped.
        """
        d = self.stiffness if stiffness is None else stiffness
        undamped = not np.iscomplexobj(d) and not any(complex(z).imag for _, z in devices)
        corner = sum((((z.real if undamped else z) * (row.T @ row)) for row, z in devices), start=0) if devices else None
        factor = self._factor(omega2, d, corner)
        m = len(d)

        def solve(load: Any) -> Any:
            right = np.concatenate([np.zeros((m, load.shape[1])), load])
            return factor.solve(right if undamped or np.iscomplexobj(right) else right.astype(complex))[m:]

        if undamped:
            # one step of inverse iteration on the coupled system: omega_n^2 - omega^2 of the nearest resonance
            first = solve(np.random.default_rng(0).standard_normal((self.n, 1)))
            second = solve(self.mass @ first)
            distance = float((first * (self.mass @ first)).sum() / (first * (self.mass @ second)).sum())
            if abs(distance) <= 2.0 * RESONANCE * omega2:
                raise np.linalg.LinAlgError(distance)
            if np.iscomplexobj(loads):
                both = solve(np.hstack([loads.real, loads.imag]))
                return both[:, : loads.shape[1]] + 1j * both[:, loads.shape[1] :]
        return solve(loads)

    def _factor(self, omega2: float, stiffness: Any, corner: Any = None, border: Any = None) -> Any:
        from scipy.sparse.linalg import splu

        try:
            return splu(self.augmented(-omega2, stiffness, corner, border))
        except RuntimeError:  # exactly singular
            raise np.linalg.LinAlgError(0.0) from None

    def harmonic_sweep(
        self, loads: Any, omega2: Array, loss_factor: float = 0.0, modal_damping: float = 0.0
    ) -> ComplexArray:
        """The response (n_frequencies, n, k) to loads (n, k) by superposition of all modes, all of which have the loss.

        `modal_damping` is the damping ratio of every mode. NaN at the frequencies of undamped resonances.
        """
        values, vectors = self.all_modes
        denominators = values * (1.0 + 1j * loss_factor) - omega2[:, None]
        denominators = denominators + 2j * modal_damping * np.sqrt(values * omega2[:, None])
        near = abs(denominators) <= 2.0 * RESONANCE * omega2[:, None]
        denominators[near.any(axis=1)] = np.nan
        shares = (vectors.T @ loads)[None] / denominators[:, :, None]
        response = vectors @ shares.transpose(1, 0, 2).reshape(len(values), -1)
        if self.n_rigid:
            inertia, dual = self._rigid_dual
            rigid = -(dual @ (self.rigid.T @ loads))[None] / omega2[:, None, None]
            return np.asarray(response.reshape(self.n, len(omega2), -1).transpose(1, 0, 2) + rigid)
        return np.asarray(response.reshape(self.n, len(omega2), -1).transpose(1, 0, 2))

    def prescribed(
        self,
        rows: Any,
        displacements: ComplexArray,
        omega2: float,
        stiffness: Any = None,
        devices: Sequence[tuple[Any, complex]] = (),
    ) -> tuple[ComplexArray, ComplexArray]:
        """The steady response (n,) where rows (p, n) of it are given, and the forces (p,) that hold them there."""
        d = self.stiffness if stiffness is None else stiffness
        corner = sum((z * (row.T @ row) for row, z in devices), start=0) if devices else None
        factor = self._factor(omega2, np.asarray(d, dtype=complex), corner, rows)
        right = np.concatenate([np.zeros(len(d) + self.n), displacements]).astype(complex)
        solution = factor.solve(right)
        return solution[len(d) : len(d) + self.n], -solution[len(d) + self.n :]

    # --- Buckling ------------------------------------------------------------------------------------------------

    def buckling_factor(self) -> float:
        """The factor on all negative stiffnesses at which the system buckles; infinite without any."""
        soft = self.stiffness < 0.0
        if not soft.any():
            return float("inf")
        if self.n_rigid:
            return 0.0
        from scipy.sparse import diags_array
        from scipy.sparse.linalg import LinearOperator, eigsh, splu

        released = (diags_array(np.sqrt(-self.stiffness[soft])) @ self.strain_matrix.tocsr()[soft]).tocsc()
        held = StructuralSystem([self.strain_matrix.tocsr()[~soft]], self.stiffness[~soft], self.mass)
        m, factor = len(held.stiffness), splu(held.augmented(0.0))

        def flexibility(forces: Array) -> Array:
            return np.asarray(released @ factor.solve(np.concatenate([np.zeros(m), released.T @ forces.ravel()]))[m:])

        size = released.shape[0]
        if size <= 2 or size <= 12:
            columns = np.column_stack([flexibility(unit) for unit in np.eye(size)])
            return float(1.0 / np.linalg.eigvalsh(0.5 * (columns + columns.T)).max())
        operator = LinearOperator((size, size), dtype=float, matvec=flexibility)
        start = np.random.default_rng(0).standard_normal(size)
        return float(1.0 / eigsh(operator, k=1, which="LA", v0=start, return_eigenvectors=False)[0])
