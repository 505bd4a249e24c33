"""Linear structural systems K = B^T diag(d) B: modes, harmonic response, buckling.

Eigenvectors come from any of several solvers; each eigenvalue is the Rayleigh quotient sum d (B v)^2 / v^T M v, with B
applied as successive differences: its error is of second order in that of the vector. Factorisations are of the
augmented matrix (`factored`).
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any, TypeAlias

import numpy as np

from verify.arrays import Array, ComplexArray, Indices
from verify.errors import InputError
from verify.formatting import one_line
from verify.linear.factored import FactoredSystem

DENSE = 150  # Largest number of unknowns for one singular value decomposition, which is then faster than Lanczos
MOST_MODES = 2000  # Largest number of unknowns for all modes: ten seconds, growing with the cube
RESONANCE = 1e-9  # Relative frequency distance to an undamped resonance below which a response is rounding
HARD = 100.0
"""Lower bound over the lowest bending eigenvalue, about, above which a foundation clusters the eigenvalues."""
REFINED = 6  # Largest number of iterative refinements: one for equal parts, more on soft supports
LOST = 1e-4  # Largest last correction of a refinement, relative: fewer digits are no answer
FEW = 4  # Largest number of frequencies solved one by one: all modes cost more than a few factorisations
SUPERPOSED = 600  # Largest number of unknowns for superposition of all modes at many frequencies


Response: TypeAlias = tuple[Any, Any, Any]
"""Elastic and rigid-body part (n, k) of a response, real or complex, and the forces (p, k) of constraints."""


def uses_dense(n: int, k: int) -> bool:
    """Whether k modes of n unknowns are computed with dense matrices: few unknowns, or many of the modes."""
    return n <= DENSE or 3 * k > n


def memory(n: int, k: int) -> int:
    """Memory for k modes of n unknowns, bytes: eight dense matrices, or sparse factors and the Lanczos basis."""
    return 64 * n**2 if uses_dense(n, k) else 8 * n * (250 + 8 * k)


def _sums(terms: Array) -> Array:
    """Pairwise sums over rows, through contiguous memory: sequential sums of a million terms err by 1e-12."""
    return np.asarray(np.ascontiguousarray(terms.T).sum(axis=1))


@dataclass(frozen=True, eq=False)
class StructuralSystem(FactoredSystem):
    """Modes, harmonic response and buckling of a factored system."""

    __repr__ = one_line(n="unknowns", n_rigid="rigid-body modes", stiffness="")

    def rayleigh_quotients(self, vectors: Array) -> Array:
        """Eigenvalues (k,) of vectors (n, k)."""
        return _sums(self.stiffness[:, None] * self.strain(vectors) ** 2) / _sums(vectors * (self.mass @ vectors))

    # --- Modes ---------------------------------------------------------------------------------------------------

    def modes(self, k: int) -> tuple[Array, Array]:
        """The lowest k elastic eigenvalues omega^2 (k,), ascending, and vectors (n, k) of unit modal mass.

        Raises InputError for a compression beyond buckling, and where Lanczos does not converge.
        """
        solvers = {"Lanczos": self._by_lanczos, "singular values": self._by_svd, "dense": self._by_dense_pencils}
        strains, vectors = solvers[self.method(k)](k)
        masses = _sums(vectors * (self.mass @ vectors))
        values = _sums(self.stiffness[:, None] * strains**2) / masses
        if values.min(initial=1.0) <= 0.0:
            raise InputError("beam.tension exceeds the buckling load of this model: compress less or support it better")
        order = np.argsort(values, kind="stable")[:k]
        return values[order], (vectors / np.sqrt(masses))[:, order]

    def method(self, k: int) -> str:
        """Solver of `modes` for k vectors: "Lanczos", "singular values", or "dense" for negative stiffnesses."""
        if not uses_dense(self.n, k + self.n_rigid):
            return "Lanczos"
        return "singular values" if self.stiffness.min() > 0.0 else "dense"

    @cached_property
    def all_modes(self) -> tuple[Array, Array]:
        """All elastic eigenvalues and vectors, as `modes`. Raises InputError beyond `MOST_MODES` unknowns."""
        if self.n > MOST_MODES:
            raise InputError(
                f"all {self.n} modes of the model are needed, more than {MOST_MODES}: lower count, or leave out "
                "modal_damping"
            )
        return self.modes(self.n - self.n_rigid)

    def _by_svd(self, k: int) -> tuple[Array, Array]:
        """The k modes from the singular values of diag(d)^(1/2) B L^-T, M = L L^T: condition n^2 instead of n^4."""
        from scipy.linalg import solve_triangular

        lower, strain = np.linalg.cholesky(self.mass.toarray()), self.strain(np.eye(self.n))
        root = solve_triangular(lower, (np.sqrt(self.stiffness)[:, None] * strain).T, lower=True, check_finite=False).T
        right = np.linalg.svd(root, full_matrices=root.shape[0] < self.n)[2]
        last = self.n - self.n_rigid
        vectors = solve_triangular(lower, right[last - k : last].T, lower=True, trans="T", check_finite=False)
        return self.strain(vectors), vectors

    def _by_dense_pencils(self, k: int) -> tuple[Array, Array]:
        """The k modes with negative stiffnesses, which have no square root: low ones from K^-1, high ones from K.

        Rounding costs K its low eigenvalues and K^-1 its high ones; at their geometric mean both have condition n^2.
        """
        from scipy.linalg import eigh

        mass, strain = self.mass.toarray(), self.strain(np.eye(self.n))
        stiffness = strain.T @ (self.stiffness[:, None] * strain)
        values, vectors = (part[..., self.n_rigid :] for part in eigh(stiffness, mass))
        flexibility = mass @ self._inverse(0.0)(mass)[1]
        inverse, low = (part[..., ::-1] for part in eigh(0.5 * (flexibility + flexibility.T), mass))
        n_low = int(np.searchsorted(values, np.sqrt(values[-1] / inverse[0])))
        vectors = np.hstack([low[:, :n_low], vectors[:, n_low:]])[:, :k]
        return self.strain(vectors), vectors

    def _by_lanczos(self, k: int) -> tuple[Array, Array]:
        """Shift-invert Lanczos, the shift below all eigenvalues except those that bodies lower.

        Rounding of a vector is 1e-4 of its strain at 1e6 parts: strains are those of a refined solution.
        """
        from scipy.linalg import eigh
        from scipy.sparse.linalg import ArpackError, LinearOperator, eigsh

        # a stiff foundation clusters the eigenvalues; on soft supports bending is lost without a shift
        bending = (3.0 / self.n) ** 4
        shift = 0.999 * self.lower_bound if self.lower_bound > HARD * bending else 0.0 if self.n_rigid else -bending
        solve = self._inverse(shift)
        inverse = LinearOperator((self.n, self.n), matvec=lambda b: solve(b.reshape(-1, 1))[1][:, 0], dtype=float)
        start = self._without_rigid(np.random.default_rng(0).standard_normal(self.n))
        sought = {"M": self.mass, "sigma": shift, "OPinv": inverse, "v0": start, "ncv": min(k + 30, self.n)}
        below = self._count_below(shift)
        # 1 / (omega^2 - shift) is negative below the shift
        sides = [(below, "SA"), (k - below, "LA")] if below else [(k, "LM")]
        try:
            vectors = np.hstack([eigsh(inverse, number, which=end, **sought)[1] for number, end in sides if number > 0])
        except ArpackError:  # not converged, or within rounding
            raise InputError(
                f"the lowest {k} of {self.n} modes do not converge: support the beam, lower its masses or count"
            ) from None
        strains, vectors = solve(self.mass @ vectors, refined=True)
        energies, masses = strains.T @ (self.stiffness[:, None] * strains), vectors.T @ (self.mass @ vectors)
        slow = energies.diagonal() < 1e-3 * bending * masses.diagonal()
        for group in (np.flatnonzero(slow), np.flatnonzero(~slow)):
            if group.size > 1:
                # Rayleigh-Ritz: two motions on soft supports are one eigenvalue after the shift, and K^-1 amplifies the
                # rounding of higher vectors along lower ones
                span = eigh(energies[np.ix_(group, group)], masses[np.ix_(group, group)])[1]
                strains[:, group], vectors[:, group] = strains[:, group] @ span, vectors[:, group] @ span
        return strains, vectors

    def _count_below(self, shift: float) -> int:
        """Number of eigenvalues that bodies lower below a shift, itself below all others.

        K - s M = (K - s M_0) - s R^T R with a positive first part has as many negative eigenvalues as
        1 - s R (K - s M_0)^-1 R^T.
        """
        if shift <= 0.0 or self.bodies is None:
            return 0
        bare = replace(self, mass=(self.mass - self.bodies.T @ self.bodies).tocsc(), bodies=None)
        compliance = self.bodies @ bare._inverse(shift)(self.bodies.T.toarray())[1]
        return int((np.linalg.eigvalsh(shift * compliance) > 1.0).sum())

    def _inverse(self, shift: float) -> Callable[..., tuple[Array, Array]]:
        """Strains (m, k) and response (n, k) of K - shift M to loads (n, k), also with one step of refinement.

        Without a shift rigid-body motions are constrained, and projected out of loads and response.
        """
        from scipy.sparse.linalg import splu

        m, free = len(self.stiffness), np.arange(self.n) if shift else np.delete(np.arange(self.n), self._grounded())
        matrix, scales = self.augmented(-shift), self._pattern[-1][:, None]
        compliance = scales / self.stiffness[:, None]
        unknowns = np.concatenate([np.arange(m), m + free])
        factor = splu(matrix if len(free) == self.n else matrix[unknowns][:, unknowns])

        def solve(loads: Array, *, refined: bool = False) -> tuple[Array, Array]:
            right, response = np.zeros((m + len(free), loads.shape[1])), np.zeros(loads.shape)
            right[m:] = (self._without_rigid(loads, load=True) if len(free) < self.n else loads)[free]
            solution = factor.solve(right)
            response[free] = solution[m:]
            if refined:  # residuals by successive differences are exact, those of the matrix are rounding
                forces = scales * solution[:m]
                for part in reversed(self.strain_factors):
                    forces = part.T @ forces
                right[:m] = scales * (compliance * solution[:m] - self.strain(response))
                right[m:] += (shift * (self.mass @ response) - forces)[free]
                solution += factor.solve(right)
                response[free] = solution[m:]
            return compliance * solution[:m], self._without_rigid(response)

        return solve

    @cached_property
    def _rigid_dual(self) -> tuple[Array, Array]:
        """(M R, R (R^T M R)^-1), each (n, r)."""
        inertia = self.mass @ self.rigid
        return inertia, np.linalg.solve(self.rigid.T @ inertia, self.rigid.T).T

    def _without_rigid(self, vectors: Array, *, load: bool = False) -> Array:
        """Vectors, or loads, (n, ...) without their rigid-body part."""
        if not self.n_rigid:
            return vectors
        inertia, dual = self._rigid_dual
        return np.asarray(vectors - (inertia @ (dual.T @ vectors) if load else dual @ (inertia.T @ vectors)))

    def _grounded(self) -> list[int]:
        """Unknowns that, fixed, prevent all rigid-body motions (pivots of a Gaussian elimination)."""
        motions, fixed = self.rigid.copy(), list[int]()
        for j in range(self.n_rigid):
            fixed.append(int(abs(motions[:, j]).argmax()))
            motions[:, j + 1 :] -= np.outer(motions[:, j] / motions[fixed[-1], j], motions[fixed[-1], j + 1 :])
        return fixed

    # --- Harmonic response ---------------------------------------------------------------------------------------

    def _coordinates(self, omega2: float) -> tuple[Indices, Array]:
        """Coordinates of the elastic and the rigid-body part of v = e + R q: unknowns of e that are not 0, R (n, r).

        e = 0 at r unknowns that prevent rigid-body motions. B R = 0 is exact, B v is rounding of a large R q. Above the
        first bending modes r = 0: the sum costs decayed waves their digits.
        """
        if not self.n_rigid or omega2 > (3.0 / self.n) ** 4:
            return np.arange(self.n), np.zeros((self.n, 0))
        return np.delete(np.arange(self.n), self._grounded()), self.rigid

    def _bordered(
        self, omega2: float, d: Any, devices: Sequence[tuple[Any, Any]], rows: Any, free: Any, rigid: Any, small: Any
    ) -> Any:
        """K + devices - omega^2 M over strains, the `free` coordinates, amplitudes of `rigid`, and constraints.

        The forces of the constraints `rows` are in units of `small`.
        """
        from scipy.sparse import block_array, csc_array, hstack

        matrix, m = self.augmented(-omega2, d), len(d)

        def widened(rows: Any) -> Any:
            parts = rows if len(free) == self.n else hstack([csc_array(rows)[:, free], csc_array(rows @ rigid)])
            return hstack([csc_array((rows.shape[0], m)), parts], format="csr")

        if rigid.size:
            kept = np.concatenate([np.arange(m), m + free])
            inertia = -omega2 * (self.mass @ rigid)
            border = csc_array(np.vstack([np.zeros((m, rigid.shape[1])), inertia[free]]))
            matrix = block_array([[matrix[kept][:, kept], border], [border.T, rigid.T @ inertia]], format="csc")
        for row, z in devices:
            wide = widened(row)
            matrix = matrix + z * (wide.T @ wide).tocsc()
        if rows is not None:
            wide = small * widened(rows)
            matrix = block_array([[matrix, wide.T], [wide, None]], format="csc")
        return matrix

    def _solver(self, omega2: float, d: Any, devices: Sequence[tuple[Any, Any]], rows: Any) -> Callable[..., Response]:
        """Elastic and rigid-body part (n, k), forces (p, k) of p constraints `rows`, of K + devices - omega^2 M.

        Iterative refinement: the factors lose soft supports beside bending, factored strains do not. Raises LinAlgError
        where the matrix is singular, and where the last correction of a response exceeds `LOST`.
        """
        from scipy.sparse.linalg import splu

        m, n, (free, rigid) = len(d), self.n, self._coordinates(omega2)
        # rigid-body inertia of order one beside the stiffness, whatever the frequency
        small = np.sqrt(omega2) if omega2 and rigid.size else 1.0
        rigid = rigid / small
        split = len(free)
        try:
            factor = splu(self._bordered(omega2, d, devices, rows, free, rigid, small).astype(d.dtype))
        except RuntimeError:  # exactly singular
            raise np.linalg.LinAlgError(0.0) from None

        def solve(load: Any, displacements: Any = None, most: float = LOST) -> Response:
            held = np.zeros((0, load.shape[1])) if displacements is None else displacements

            def step(load: Any, strained: Any, held: Any) -> list[Any]:
                right = np.concatenate(
                    [np.zeros((m, load.shape[1])), (load - strained)[free], rigid.T @ load, small * held]
                )
                y, bent = factor.solve(right.astype(d.dtype))[m:], np.zeros(load.shape, dtype=d.dtype)
                bent[free] = y[:split]
                return [bent, rigid @ y[split:n], small * y[n:]]

            bent, moved, forces = step(load, 0.0, held)
            lost = np.inf
            for _ in range(REFINED):
                whole = bent + moved
                residual = load + omega2 * (self.mass @ whole)
                for row, z in devices:
                    residual = residual - z * (row.T @ (row @ whole))
                if rows is not None:
                    residual, held = residual - rows.T @ forces, displacements - rows @ whole
                more = step(residual, self.transposed @ (d[:, None] * self.strain(bent)), held)
                bent, moved, forces = bent + more[0], moved + more[1], forces + more[2]
                # a correction is what the factors lose; the next is as much smaller
                pairs = (more[0], bent), (more[0] + more[1], bent + moved)
                sizes = [(abs(c).max(axis=0), abs(v).max(axis=0)) for c, v in pairs]
                lost = max(float((c / np.where(v == 0.0, 1.0, v)).max(initial=0.0)) for c, v in sizes)
                if lost <= 1e-8:
                    break
            if not lost <= most:
                raise np.linalg.LinAlgError(lost)
            return bent, moved, -forces

        return solve

    def steady(
        self,
        loads: Any,
        omega2: float,
        stiffness: Any = None,
        devices: Sequence[tuple[Any, complex]] = (),
        rows: Any = None,
        displacements: Any = None,
    ) -> Response:
        """The steady response to loads (n, k), (K + devices - omega^2 M) v = load, in an elastic and a rigid-body part.

        Both are (n, k); the third result are the forces (p, k) of constraints rows (p, n) @ v = displacements (p, k).
        `stiffness` is d with losses, complex (m,). A device is the sparse row (1, n) of its displacement and a dynamic
        stiffness k + i omega c - omega^2 m. Raises LinAlgError within `RESONANCE` of an undamped resonance, and where
        rounding leaves fewer than four digits.
        """
        d, k = self.stiffness if stiffness is None else stiffness, loads.shape[1]
        if np.iscomplexobj(d) or any(complex(z).imag for _, z in devices):
            return self._solver(omega2, np.asarray(d, dtype=complex), devices, rows)(loads, displacements)
        solve = self._solver(omega2, d, [(row, complex(z).real) for row, z in devices], rows)
        nothing = None if rows is None else np.zeros((rows.shape[0], 1))

        def respond(load: Any) -> Any:
            # inertia of rigid-body motions bends nothing: no digits of bending
            bent, moved, _ = solve(load, nothing, np.inf)
            return bent + moved

        self._check_resonance(respond, respond(np.random.default_rng(0).standard_normal((self.n, 1))), omega2)
        if not np.iscomplexobj(loads):
            return solve(loads, displacements)
        both = None if rows is None else np.hstack([displacements, np.zeros(displacements.shape)])
        parts = solve(np.hstack([loads.real, loads.imag]), both)
        bent, moved, forces = (part[:, :k] + 1j * part[:, k:] for part in parts)
        return bent, moved, forces

    def _check_resonance(self, solve: Callable[[Any], Any], response: Any, omega2: float) -> None:
        """Raise LinAlgError within `RESONANCE` of a resonance, from the response (n, 1) to a random load.

        One step of inverse iteration gives omega_n^2 - omega^2 of the nearest resonance of the coupled system.
        """
        first = self.mass @ response
        distance = float((response * first).sum() / (first * solve(first)).sum())
        if abs(distance) <= 2.0 * RESONANCE * omega2:
            raise np.linalg.LinAlgError(distance)

    def harmonic_sweep(
        self, loads: Any, omega2: Array, loss_factor: float = 0.0, modal_damping: float = 0.0
    ) -> ComplexArray:
        """Elastic and rigid-body response (2, n_frequencies, n, k) to loads (n, k): all modes, a common loss factor.

        `modal_damping` is the damping ratio of every mode. NaN at the frequencies of undamped resonances.
        """
        receptances, acting, responding = self.modal_receptances(omega2, loss_factor, modal_damping)
        shares = (acting.T @ loads)[None] * receptances[:, :, None]
        shares = shares.transpose(1, 0, 2).reshape(acting.shape[1], -1)
        r = self.n_rigid
        response = np.stack([responding[:, r:] @ shares[r:], responding[:, :r] @ shares[:r]])
        return np.asarray(response.reshape(2, self.n, len(omega2), -1).transpose(0, 2, 1, 3))

    def modal_receptances(
        self, omega2: Array, loss_factor: float = 0.0, modal_damping: float = 0.0
    ) -> tuple[ComplexArray, Array, Array]:
        """1 / (omega_n^2 (1 + i eta) - omega^2) of all motions, (n_frequencies, k); load and response vectors (n, k).

        Rigid-body motions come first, with omega_n = 0. NaN at the frequencies of undamped resonances.
        """
        values, vectors = self.all_modes
        acting = responding = vectors
        if self.n_rigid:
            values = np.concatenate([np.zeros(self.n_rigid), values])
            acting, responding = np.hstack([self.rigid, vectors]), np.hstack([self._rigid_dual[1], vectors])
        damping = 2j * modal_damping * np.sqrt(values * omega2[:, None])
        denominators = values * (1.0 + 1j * loss_factor) - omega2[:, None] + damping
        near = abs(denominators) <= 2.0 * RESONANCE * omega2[:, None]
        denominators[near] = 1.0
        receptances = 1.0 / denominators
        receptances[near.any(axis=1)] = np.nan
        return receptances, acting, responding

    # --- Buckling ------------------------------------------------------------------------------------------------

    def buckling_factor(self) -> float:
        """The factor on all negative stiffnesses at which the system buckles; infinite without any.

        Rigid-body motions have no effect unless they strain a negative stiffness. Raises InputError where the lowest
        loads are too close together.
        """
        from scipy.sparse import diags_array
        from scipy.sparse.linalg import ArpackError, LinearOperator, eigsh

        soft = self.stiffness < 0.0
        if not soft.any():
            return float("inf")
        strain = self.transposed.T.tocsr()
        released = diags_array(np.sqrt(-self.stiffness[soft])) @ strain[soft]
        solve = StructuralSystem([strain[~soft]], self.stiffness[~soft], self.mass, self.rigid)._inverse(0.0)
        size = released.shape[0]
        operator = LinearOperator(
            (size, size),
            dtype=float,
            matvec=lambda forces: released @ solve(released.T @ forces.reshape(-1, 1))[1][:, 0],
        )
        if size <= 60:
            return float(1.0 / np.linalg.eigvalsh(operator @ np.eye(size))[-1])
        start = np.random.default_rng(0).standard_normal(size)
        try:
            return float(1.0 / eigsh(operator, 1, which="LA", v0=start, ncv=60, return_eigenvectors=False)[0])
        except ArpackError:  # not converged, or within rounding
            raise InputError(
                "count: the lowest buckling loads are too close together with so many parts, lower it"
            ) from None
