"""Large in-plane motion of a beam: nonlinear Hermite elements, geometrically exact, by scikit-fem's basis.

Both coordinates r(s) = (x, y) of the line of centroids are cubic Hermite polynomials of the arc length s of the
straight beam. With the stretch J = |r'| and the curvature kappa = theta' = (r' x r'')/J^2 the energy per length is

    EA (J - 1)^2 / 2 + EI kappa^2 / 2,      rho A |dr/dt|^2 / 2

without shear and rotary inertia (J. C. Simo and L. Vu-Quoc, Comput. Methods Appl. Mech. Engrg. 58 (1986) 79, in that
limit). Bending is integrated at four points of Gauss. A cubic cannot bend without stretching, which full integration of
EA resists (membrane locking); two points leave a mechanism of the slopes, that a hundredth of EA would restrain at the
cost of accuracy: a tenth of EI/l^2 at the four points does it and vanishes with the element. The mass matrix is
constant, and the tangent of the straight beam across its length is the matrix of `fem_beam`.

The beam moves relative to a base with prescribed motion: unknowns are coordinates in the base's frame, so that a clamp
fixes y' alone and leaves the stretch x' free; the base acts by inertia forces.
"""

from collections.abc import Sequence
from dataclasses import dataclass, field
from functools import cached_property
from math import pi
from typing import NamedTuple

import numpy as np
from scipy.linalg import LinAlgError, cholesky, cholesky_banded, eigh, eigvalsh, solve_banded, solve_triangular

from verify.arrays import Array, ComplexArray, Indices
from verify.errors import InputError, shown
from verify.linear.field import phasor
from verify.linear.mesh import Parts, divide
from verify.linear.positions import Numbers, as_vector
from verify.problem.beam import Beam, PointForce
from verify.problem.supports import FIXED
from verify.validation import check_integer, check_number

BAND = 7  # an element couples two nodes of four values
RESTRAINT = 0.1  # stiffness of the stretch at four points, in EI/l^2: its error is far below that of bending
TOLERANCE = 1e-11
"""Newton step, relative to the length, that ends the iteration: the next one, by its square, is rounding."""
FLOOR = 1e-8  # a step below it that is not smaller than the one before is rounding, which grows with EA L^2/EI
LARGEST_TURN = 0.5  # largest change of a slope in one Newton step: tangents are unit vectors
QUARTER = np.array([[0.0, -1.0], [1.0, 0.0]])
"""Rotation by 90 degrees."""


class Forces(NamedTuple):
    """Dead loads on the beam, in the frame of the ground."""

    tip: Array = np.zeros(2)
    """(2,), N, on the right end."""
    moment: float = 0.0
    """N m, on the right end."""
    follower: Array = np.zeros(2)
    """(2,), N, on the right end, along and across it."""
    gravity: Array = np.zeros(2)
    """(2,), m/s^2."""

    def scaled(self, share: float) -> "Forces":
        """A share of all loads."""
        return Forces(share * self.tip, share * self.moment, share * self.follower, share * self.gravity)


NONE = Forces()
"""No loads."""


@dataclass(frozen=True, eq=False)
class NonlinearHermite:
    """A beam of `count` nonlinear Hermite elements; `axial_stiffness` EA, N, is by default that of its section.

    Supports are those of the beam; the left of two supported ends does not slide along the beam. Raises InputError for
    attachments, a loss factor, axial force, and an unknown EA.
    """

    beam: Beam
    count: int
    axial_stiffness: float | None = None
    free: Array = field(init=False)
    """(count + 1, 2, 2): 1 where a coordinate or slope of a node may move, else 0."""

    def __post_init__(self) -> None:
        check_integer("count", self.count, len(self.beam.pieces))
        self.beam.check_features("the nonlinear elements", ("section",))
        if self.beam.loss_factor:
            raise InputError(f"beam.loss_factor = {self.beam.loss_factor!r}: nonlinear elements have none, give 0")
        if self.axial_stiffness is not None:
            check_number("axial_stiffness", self.axial_stiffness, "N", above=0)
        free = np.ones((self.count + 1, 2, 2))
        for node, support in zip((0, -1), self.beam.supports, strict=True):
            free[node, :, 1] = [not fixed for fixed in FIXED[support]]
        for node in (0, -1):  # the first end whose deflection is prevented does not slide
            if not free[node, 0, 1]:
                free[node, 0, 0] = 0.0
                break
        object.__setattr__(self, "free", free)

    # --- Constant arrays -------------------------------------------------------------------------------------------

    @cached_property
    def parts(self) -> Parts:
        """The elements."""
        return divide(self.beam, self.count)

    @cached_property
    def nodes(self) -> Array:
        """(count + 1,), m."""
        return self.parts.nodes * self.parts.unit

    @cached_property
    def straight(self) -> Array:
        """State of the straight beam: (count + 1, 2, 2), of a node r = (x, y) in m, then r'."""
        state = np.zeros((self.count + 1, 2, 2))
        state[:, 0, 0], state[:, 1, 0] = self.nodes, 1.0
        return state

    @cached_property
    def _shapes(self) -> tuple[Array, Array, Array]:
        """Rows of r' and r'' at six points by the values of an element, (n, 6, 4, 8); EA ds and EI ds, (n, 6)."""
        from skfem.assembly import CellBasis

        from verify.elements.element import line_basis

        full = line_basis(self.nodes, shear=False)
        rows, axial, bending = [], [], []
        ei, ea = self.parts.of("bending_stiffness"), self._axial
        for basis in (full, CellBasis(full.mesh, full.elem, intorder=3)):
            slopes, bends = (np.stack([w[k].grad[0] for w in basis.basis[:4]], axis=-1) for k in (0, 1))
            table = np.zeros((*slopes.shape[:2], 4, 4, 2))
            for axis in (0, 1):
                table[:, :, axis, :, axis], table[:, :, 2 + axis, :, axis] = slopes, bends
            rows.append(table.reshape(*slopes.shape[:2], 4, 8))
            two = basis is not full
            stretch = ea if two else RESTRAINT * ei / np.diff(self.nodes) ** 2
            axial.append(stretch[:, None] * basis.dx)
            bending.append((0.0 if two else 1.0) * ei[:, None] * basis.dx)
        return np.concatenate(rows, 1), np.concatenate(axial, 1), np.concatenate(bending, 1)

    @cached_property
    def _axial(self) -> Array:
        """EA of the elements, (n,), N."""
        if self.axial_stiffness is not None:
            return self.axial_stiffness * self.parts.axial_stiffnesses
        return np.array([piece.axial_stiffness for piece in self.parts.pieces]).repeat(self.parts.shares)

    @cached_property
    def element_masses(self) -> Array:
        """(n, 8, 8), kg: rho A by both coordinates alike."""
        from verify.elements.element import element_matrices, inertia, line_basis

        basis = line_basis(self.nodes, shear=False)
        local = element_matrices(basis, inertia, self.parts.of("mass_per_length")).tolocal()
        return np.asarray(np.einsum("nij,ab->niajb", local, np.eye(2)).reshape(-1, 8, 8))

    @cached_property
    def _places(self) -> tuple[Indices, Indices]:
        """Index of each value of an element, (n, 8), and of each entry of its matrix in banded storage, (n, 8, 8)."""
        values = 4 * np.arange(self.count)[:, None] + np.arange(8)
        row, column = values[:, :, None], values[:, None, :]
        return values, (BAND + row - column) * 4 * (self.count + 1) + column

    def band(self, matrices: Array) -> Array:
        """Element matrices (n, 8, 8) as bands (15, n_all); supported values keep no entry."""
        n_all = 4 * (self.count + 1)
        free = self.free.reshape(-1)[self._places[0]]
        kept = matrices * free[:, :, None] * free[:, None, :]
        size = (2 * BAND + 1) * n_all
        return np.asarray(np.bincount(self._places[1].ravel(), kept.ravel(), size).reshape(-1, n_all), dtype=float)

    def vector(self, vectors: Array) -> Array:
        """Element vectors (n, 8) as a vector (n_all,)."""
        return np.asarray(np.bincount(self._places[0].ravel(), vectors.ravel(), 4 * (self.count + 1)), dtype=float)

    def solve(self, bands: Array, right: Array) -> Array:
        """Solution (count + 1, 2, 2) of a banded system; supported values do not change. Raises LinAlgError."""
        free = self.free.reshape(-1)
        bands = bands.copy()
        bands[BAND] += 1.0 - free
        solution = solve_banded((BAND, BAND), bands, right * free, overwrite_ab=True, check_finite=False)
        return np.asarray(solution).reshape(self.free.shape)

    def of_elements(self, state: Array) -> Array:
        """The values of each element, (n, 8), of a state."""
        return np.asarray(state.reshape(-1)[self._places[0]])

    # --- Energy and its derivatives --------------------------------------------------------------------------------

    def strain_energy(self, state: Array) -> tuple[float, Array, Array]:
        """Energy, J, its gradient by the values of each element (n, 8), its second derivatives (n, 8, 8).

        With a = r', b = r'', p = -b turned by 90 degrees: kappa = a x b / J^2 has the derivatives p/J^2 - 2 kappa a/J^2
        by a and (a turned by 90 degrees)/J^2 by b.
        """
        rows, axial, bending = self._shapes
        a, b = np.split((rows @ self.of_elements(state)[:, None, :, None])[..., 0], 2, axis=-1)
        stretch2 = (a * a).sum(-1)[..., None]
        stretch = np.sqrt(stretch2)
        tangent, turned, p = a / stretch, a @ QUARTER.T, -b @ QUARTER.T
        kappa = (turned * b).sum(-1)[..., None] / stretch2
        by_a, by_b = (p - 2.0 * kappa * a) / stretch2, turned / stretch2
        strain = stretch - 1.0
        energy = 0.5 * float((axial * strain[..., 0] ** 2 + bending * kappa[..., 0] ** 2).sum())
        ea, ei = axial[..., None], bending[..., None]
        moment = ei * kappa
        gradient = np.concatenate([ea * strain * tangent + moment * by_a, moment * by_b], axis=-1)

        square, both = outer(tangent, tangent), outer(p, a)
        ea, ei, moment, stretch, stretch2, kappa = (
            array[..., None] for array in (ea, ei, moment, stretch, stretch2, kappa)
        )
        second = (8.0 * kappa * square - 2.0 * kappa * np.eye(2)) / stretch2
        second -= 2.0 * (both + both.swapaxes(-1, -2)) / stretch2**2
        hessian = np.empty((*axial.shape, 4, 4))
        hessian[..., :2, :2] = ea * (square + (1.0 - 1.0 / stretch) * (np.eye(2) - square)) + (
            ei * outer(by_a, by_a) + moment * second
        )
        mixed = -QUARTER / stretch2 - 2.0 * outer(a, turned) / stretch2**2
        hessian[..., :2, 2:] = ei * outer(by_a, by_b) + moment * mixed
        hessian[..., 2:, :2] = hessian[..., :2, 2:].swapaxes(-1, -2)
        hessian[..., 2:, 2:] = ei * outer(by_b, by_b)
        n = self.count
        flat = rows.reshape(n, -1, 8)
        curved = (hessian @ rows).reshape(n, -1, 8)
        return energy, (gradient.reshape(n, 1, -1) @ flat)[:, 0], flat.swapaxes(1, 2) @ curved

    # --- Loads -----------------------------------------------------------------------------------------------------

    def loads(self, forces: Forces, state: Array) -> tuple[Array, Array]:
        """Generalised forces of the elements (n, 8), and their derivatives by the state, (n, 8, 8)."""
        uniform = np.zeros((4, 2))
        uniform[::2] = forces.gravity
        vectors, matrices = self.element_masses @ uniform.ravel(), np.zeros((self.count, 8, 8))
        a = state[-1, 1]
        square, turned = float(a @ a), QUARTER @ a
        tangent = a / square**0.5
        frame = np.stack([tangent, QUARTER @ tangent], axis=1)
        turning = np.outer(frame[:, 1], frame[:, 1]) / square**0.5
        vectors[-1, 4:6] += forces.tip + frame @ forces.follower
        vectors[-1, 6:] += forces.moment * turned / square
        along, across = forces.follower
        matrices[-1, 4:6, 6:] = along * turning + across * QUARTER @ turning
        matrices[-1, 6:, 6:] = forces.moment * (QUARTER / square - 2.0 * np.outer(turned, a) / square**2)
        return vectors, matrices

    def bend(
        self,
        load: Numbers = 0.0,
        *,
        moment: float = 0.0,
        follower: Numbers = 0.0,
        gravity: Numbers = 0.0,
        rate: float = 0.0,
        hub_radius: float = 0.0,
        start: "BentElements | None" = None,
    ) -> "BentElements":
        """Equilibrium under a dead `load` (N), a `moment` (N m) and a `follower` force (N) at the right end.

        Forces and `gravity` (m/s^2) are one number across the beam, or two, along and across; the follower's are those
        of the tip's tangent and normal. The base turns steadily at `rate`, rad/s, `hub_radius` (m) beyond the axis.
        Newton's method in load steps from the straight beam, a quarter as long where it fails and twice as long where
        it does not; from `start` in one step. Raises InputError where steps of a millionth of the load fail.
        """
        forces = Forces(in_plane("load", load), moment, in_plane("follower", follower), in_plane("gravity", gravity))
        state, done, part = self.straight if start is None else start.state, 0.0, 1.0
        while done < 1.0:
            share = min(done + part, 1.0)
            solution = self._newton(state, forces.scaled(share), share * rate**2, hub_radius)
            if solution is not None:
                state, done, part = solution, share, 2.0 * part
            elif part > (1e-6 if start is None else 1.0):
                part *= 0.25
            else:
                raise InputError(
                    f"load: no stable equilibrium beyond {done:.3g} of it, reduce it or add a small force across"
                )
        return BentElements(model=self, state=state, rate=rate)

    def weights(self, s: float) -> Array:
        """Weights (count + 1, 2) of the nodes' values and slopes in a coordinate at `s`. Raises InputError."""
        from verify.elements.element import rows

        check_number("position", s, "m, on the beam", at_least=0, at_most=self.beam.length)
        return np.asarray(rows(self.nodes, np.array([s]), np.arange(2 * self.count + 2)).toarray().reshape(-1, 2))

    def across(self, forces: Sequence[PointForce]) -> ComplexArray:
        """Generalised forces (count + 1, 2, 2) of harmonic forces across the straight beam. Raises InputError."""
        vector = np.zeros(self.free.shape, dtype=complex)
        for force in forces:
            vector[..., 1] += phasor(force) * self.weights(force.position)
        return vector

    def _newton(self, state: Array, forces: Forces, square: float, hub_radius: float) -> Array | None:
        """The stable equilibrium near a state; None unless Newton's method converges to one.

        Under a follower force, which has no potential, a positive tangent does not tell stability: all count.
        """
        spin, hub, before = square * self.element_masses, np.zeros_like(state), np.inf
        hub[:, 0, 0] = hub_radius
        for _ in range(30):
            _, gradient, hessian = self.strain_energy(state)
            vectors, matrices = self.loads(forces, state)
            vectors = vectors - gradient + (spin @ self.of_elements(state + hub)[..., None])[..., 0]
            tangent = self.band(hessian - spin - matrices)
            step = self.solve(tangent, self.vector(vectors))
            size = max(abs(step[:, 0]).max() / self.beam.length, abs(step[:, 1]).max())
            if not size < LARGEST_TURN:
                return None
            state = state + step
            if size < TOLERANCE or (size < FLOOR and size >= before):
                return state if forces.follower.any() or self._positive(tangent) else None
            before = size
        return None

    def _positive(self, bands: Array) -> bool:
        """Whether a symmetric matrix is positive definite."""
        lower = bands[BAND:].copy()
        lower[0] += 1.0 - self.free.ravel()
        try:
            cholesky_banded(lower, lower=True)
        except LinAlgError:
            return False
        return True

    def frequencies_hz(self, state: Array, rate: float, flapping: bool) -> Array:
        """See `BentElements.frequencies_hz`."""
        free = np.flatnonzero(self.free.ravel())
        stiffness, mass = (
            dense(self.band(matrices))[np.ix_(free, free)]
            for matrices in (self.strain_energy(state)[2], self.element_masses)
        )
        if flapping:
            if abs(state[:, 0, 1]).max() > 1e-9 * self.beam.length:
                raise InputError("flapping = True is for a straight beam: leave it out")
            across = np.flatnonzero(free % 2)
            omega2 = eigh(stiffness[np.ix_(across, across)], mass[np.ix_(across, across)], eigvals_only=True)
            return np.asarray(np.sqrt(np.maximum(omega2, 0.0)) / (2.0 * pi))
        turning = self.band(np.einsum("nij,jk->nik", self.element_masses, np.kron(np.eye(4), QUARTER)))
        try:
            root, unit = cholesky(stiffness - rate**2 * mass, lower=True), cholesky(mass, lower=True)
        except LinAlgError:
            raise InputError(f"rate = {rate!r} rad/s: the equilibrium is not stable, it has no frequencies") from None
        root = solve_triangular(unit, root, lower=True)
        half = solve_triangular(unit, dense(turning)[np.ix_(free, free)], lower=True)
        gyroscopic = 2.0 * rate * solve_triangular(unit, half.T, lower=True).T
        skew = np.block([[-gyroscopic, -root], [root.T, np.zeros_like(root)]])
        omega = eigvalsh(1j * skew)
        return np.asarray(omega[len(omega) // 2 :] / (2.0 * pi))


def dense(bands: Array) -> Array:
    """A banded matrix in full."""
    n = bands.shape[1]
    matrix = np.zeros((n, n))
    for offset in range(-BAND, BAND + 1):
        row = bands[BAND + offset]
        matrix += np.diag(row[max(-offset, 0) : n - max(offset, 0)], -offset)
    return matrix


@dataclass(frozen=True, eq=False, kw_only=True)
class BentElements:
    """Equilibrium of nonlinear elements in the frame of their base; x along the straight beam, y across it."""

    model: NonlinearHermite
    state: Array
    """(count + 1, 2, 2): of a node r = (x, y), m, then r'."""
    rate: float = 0.0
    """Of the base, rad/s."""

    @property
    def tip(self) -> Array:
        """(2,), m: (x, y) of the right end."""
        return np.asarray(self.state[-1, 0])

    @property
    def deflection(self) -> float:
        """Transverse displacement of the right end, m."""
        return float(self.state[-1, 0, 1])

    @property
    def shortening(self) -> float:
        """Axial displacement of the right end towards the left one, m."""
        return self.model.beam.length - float(self.state[-1, 0, 0])

    @property
    def turn(self) -> float:
        """Rotation of the right end, rad, between -pi and pi."""
        return float(np.arctan2(self.state[-1, 1, 1], self.state[-1, 1, 0]))

    @property
    def energy(self) -> float:
        """Strain energy, J."""
        return self.model.strain_energy(self.state)[0]

    def frequencies_hz(self, *, flapping: bool = False) -> Array:
        """Natural frequencies about the equilibrium, Hz, in ascending order; dead loads and gravity have no stiffness.

        In the plane, with the gyroscopic term of the base's rotation (lead-lag); with `flapping` across the plane, of a
        straight beam whose EI is the same there. Those in the plane include axial modes and, above 2 sqrt(EI/rho A)/l^2
        rad/s (about mode 0.45 `count`), modes of the slopes x' that the two points of EA leave soft, which no beam has.
        Raises InputError for an unstable equilibrium.
        """
        return self.model.frequencies_hz(self.state, self.rate, flapping)

    def __repr__(self) -> str:
        x, y = self.tip
        return f"BentElements({self.model.count} elements, tip at ({x:.6g}, {y:.6g}) m)"


def in_plane(name: str, value: Numbers) -> Array:
    """A vector (along, across), (2,), from one number across the beam, or two. Raises InputError."""
    vector = as_vector(name, value, "N or m/s^2")
    if vector.shape not in ((1,), (2,)):
        raise InputError(f"{name} = {shown(value)}: give one number across the beam, or two, along and across")
    return vector if len(vector) == 2 else np.array([0.0, vector[0]])


def outer(a: Array, b: Array) -> Array:
    """Products a_i b_j of vectors (..., k)."""
    return a[..., :, None] * b[..., None, :]
