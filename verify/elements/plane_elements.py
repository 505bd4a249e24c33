"""Large in-plane motion of a beam: nonlinear Hermite elements, geometrically exact, by scikit-fem's basis.

Both coordinates r(s) = (x, y) of the line of centroids are cubic Hermite polynomials of the arc length s of the
unloaded beam. With the stretch J = |r'| and the curvature kappa = theta' = (r' x r'')/J^2 the energy per length is

    EA (J - J_0)^2 / 2 + EI (kappa - kappa_0)^2 / 2,      rho A |dr/dt|^2 / 2

without shear and rotary inertia (J. C. Simo and L. Vu-Quoc, Comput. Methods Appl. Mech. Engrg. 58 (1986) 79, in that
limit); J_0 and kappa_0 are those of the interpolated shape at rest, 1 and 0 of a straight beam. Bending is integrated
at four points of Gauss. A cubic cannot bend without stretching, which full integration of EA resists (membrane
locking); two points leave a mechanism of the slopes, that a hundredth of EA would restrain at the cost of accuracy: of
EA a tenth of EI/l^2 is integrated at the four points, the rest at the two, so that a uniform stretch has EA. The mass
matrix is constant, and the tangent of the straight beam across its length is the matrix of `fem_beam`.

The beam moves relative to a base with prescribed motion: unknowns are coordinates in the base's frame, so that a clamp
fixes y' alone and leaves the stretch x' free; the base acts by inertia forces.
"""

from collections.abc import Callable
from dataclasses import dataclass, field
from functools import cached_property
from typing import NamedTuple

import numpy as np
from scipy.linalg import LinAlgError
from scipy.linalg.lapack import dgbsv

from verify.arrays import Array, Indices
from verify.errors import InputError
from verify.linear.mesh import Parts, divide
from verify.problem.beam import Beam, check_features
from verify.problem.supports import FIXED
from verify.validation import check_integer, check_number

BAND = 7  # an element couples two nodes of four values
FINE = 16  # parts of an element for splines of the shape at rest: their error, of order 4 too, is 1e-5 of the element's
RESTRAINT = 0.1  # part of EA at four points, in EI/l^2: its error is far below that of bending
QUARTER = np.array([[0.0, -1.0], [1.0, 0.0]])  # Rotation by 90 degrees


class Forces(NamedTuple):
    """Loads along and across the straight beam; in `large_motion` along x and y of the ground."""

    tip: Array = np.zeros(2)
    """(2,), N, dead, on the right end."""
    moment: float = 0.0
    """N m, on the right end."""
    follower: Array = np.zeros(2)
    """(2,), N, on the right end, along its tangent and normal."""
    gravity: Array = np.zeros(2)
    """(2,), m/s^2."""

    def scaled(self, share: float) -> "Forces":
        """A share of all loads."""
        return Forces(share * self.tip, share * self.moment, share * self.follower, share * self.gravity)


NONE = Forces()  # No loads


@dataclass(frozen=True, eq=False)
class PlaneElements:
    """Energy, mass and loads of a beam of nonlinear elements, and their assembly; see `NonlinearHermite`."""

    beam: Beam
    count: int
    axial_stiffness: float | None = None
    curvature: Callable[[Array], Array] | None = None
    """Curvature at rest, 1/m, of arc lengths, m, of a cantilever that starts along x: arrays of equal shape."""
    immovable: bool = False
    """Whether the right end keeps the x of the `start` of an equilibrium or a motion."""
    free: Array = field(init=False)
    """(count + 1, 2, 2): 1 where a coordinate or slope of a node may move, else 0."""

    def __post_init__(self) -> None:
        check_integer("count", self.count, len(self.beam.pieces))
        check_features(self.beam, "the nonlinear elements", ("section",))
        if self.beam.loss_factor:
            raise InputError(f"beam.loss_factor = {self.beam.loss_factor!r}: nonlinear elements have none, give 0")
        if self.axial_stiffness is not None:
            check_number("axial_stiffness", self.axial_stiffness, "N", above=0)
        if self.curvature and self.beam.supports != ("clamped", "free"):
            raise InputError(
                f"beam.supports = {self.beam.supports!r}: a curved beam is a cantilever, ('clamped', 'free')"
            )
        free = np.ones((self.count + 1, 2, 2))
        for node, support in zip((0, -1), self.beam.supports, strict=True):
            free[node, :, 1] = [not fixed for fixed in FIXED[support]]
        for node in (0, -1):  # the first end whose deflection is prevented does not slide
            if not free[node, 0, 1]:
                free[node, 0, 0] = 0.0
                break
        free[-1, 0, 0] *= not self.immovable
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
    def rest(self) -> Array:
        """State of the unloaded beam: (count + 1, 2, 2), of a node r = (x, y) in m, then r'. Raises InputError."""
        state = np.zeros((self.count + 1, 2, 2))
        state[:, 0, 0], state[:, 1, 0] = self.nodes, 1.0
        if self.curvature is None:
            return state
        from scipy.interpolate import CubicSpline

        fine = np.interp(np.arange(FINE * self.count + 1) / FINE, np.arange(self.count + 1), self.nodes)
        bent = np.asarray(self.curvature(fine), dtype=float)
        if bent.shape != fine.shape or not np.isfinite(bent).all():
            raise InputError(
                "curvature: give a function of an array of arc lengths, m, that returns as many finite 1/m"
            )
        angles = CubicSpline(fine, bent).antiderivative()(fine)
        tangents = np.stack([np.cos(angles), np.sin(angles)], -1)
        state[:, 0], state[:, 1] = CubicSpline(fine, tangents).antiderivative()(self.nodes), tangents[::FINE]
        return state

    @cached_property
    def _at_rest(self) -> tuple[Array, Array]:
        """Stretch and curvature of the unloaded elements at six points, (n, 6) each: 1 and 0 of a straight beam."""
        if self.curvature is None:
            return np.ones_like(self._shapes[1]), np.zeros_like(self._shapes[1])
        return self._strains(self.rest)

    @cached_property
    def _shapes(self) -> tuple[Array, Array, Array]:
        """Rows of r' and r'' at six points by the values of one coordinate, (n, 6, 2, 4); EA ds and EI ds, (n, 6)."""
        from skfem.assembly import CellBasis

        from verify.elements.element import line_basis

        full = line_basis(self.nodes, shear=False)
        rows, axial, bending = [], [], []
        ei = self.parts.of("bending_stiffness")
        if self.axial_stiffness is None:
            ea = np.array([piece.axial_stiffness for piece in self.parts.pieces]).repeat(self.parts.shares)
        else:  # unknown areas: EA of all
            ea = self.axial_stiffness * np.nan_to_num(self.parts.axial_stiffnesses, nan=1.0)
        restraint = np.minimum(RESTRAINT * ei / np.diff(self.nodes) ** 2, ea)
        for basis in (full, CellBasis(full.mesh, full.elem, intorder=3)):
            slopes, bends = (np.stack([w[k].grad[0] for w in basis.basis[:4]], axis=-1) for k in (0, 1))
            rows.append(np.stack([slopes, bends], axis=2))
            two = basis is not full
            stretch = ea - restraint if two else restraint
            axial.append(stretch[:, None] * basis.dx)
            bending.append((0.0 if two else 1.0) * ei[:, None] * basis.dx)
        return np.concatenate(rows, 1), np.concatenate(axial, 1), np.concatenate(bending, 1)

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

    @cached_property
    def _both_free(self) -> Array:
        """1 for the entries of an element's matrix whose values are both free, (n, 8, 8)."""
        free = self.of_elements(self.free)
        return free[:, :, None] * free[:, None, :]

    @cached_property
    def _weights(self) -> Array:
        """Generalised forces of unit accelerations along and across, (n, 8, 2), kg."""
        uniform = np.kron([[1.0], [0.0], [1.0], [0.0]], np.eye(2))
        return np.asarray(self.element_masses @ uniform)

    def band(self, matrices: Array) -> Array:
        """Element matrices (n, 8, 8) as bands (15, n_all); supported values keep no entry."""
        n_all, kept = 4 * (self.count + 1), matrices * self._both_free
        size = (2 * BAND + 1) * n_all
        return np.asarray(np.bincount(self._places[1].ravel(), kept.ravel(), size).reshape(-1, n_all), dtype=float)

    def vector(self, vectors: Array) -> Array:
        """Element vectors (n, 8) as a vector (n_all,)."""
        return np.asarray(np.bincount(self._places[0].ravel(), vectors.ravel(), 4 * (self.count + 1)), dtype=float)

    def solve(self, bands: Array, right: Array) -> Array:
        """Solution (count + 1, 2, 2) of a banded system; supported values do not change. Raises LinAlgError."""
        free = self.free.reshape(-1)
        factors = np.zeros((3 * BAND + 1, free.size), order="F")  # of LAPACK, without the checks of `solve_banded`
        factors[BAND:] = bands
        factors[2 * BAND] += 1.0 - free
        *_, solution, fault = dgbsv(BAND, BAND, factors, right * free, overwrite_ab=True, overwrite_b=True)
        if fault:
            raise LinAlgError("singular matrix")
        return np.asarray(solution).reshape(self.free.shape)

    @property
    def values(self) -> Indices:
        """Index of each value of an element, (n, 8), in a state."""
        return self._places[0]

    def of_elements(self, state: Array) -> Array:
        """The values of each element, (n, 8), of a state."""
        return np.asarray(state.reshape(-1)[self._places[0]])

    # --- Energy and its derivatives --------------------------------------------------------------------------------

    def energy(self, states: Array) -> Array:
        """Strain energy, (...), J, of states (..., count + 1, 2, 2)."""
        _, axial, bending = self._shapes
        (stretch, kappa), (length, bent) = self._strains(states), self._at_rest
        return np.asarray(0.5 * (axial * (stretch - length) ** 2 + bending * (kappa - bent) ** 2).sum((-2, -1)))

    def _strains(self, states: Array) -> tuple[Array, Array]:
        """Stretch and curvature at the points of states (..., count + 1, 2, 2), (..., n, 6) each."""
        values = states.reshape(*states.shape[:-3], -1)[..., self._places[0].reshape(-1, 4, 2)]
        a, b = np.moveaxis(np.einsum("nqdk,...nkc->...nqdc", self._shapes[0], values), -2, 0)
        stretch2 = (a * a).sum(-1)
        return np.sqrt(stretch2), (a[..., 0] * b[..., 1] - a[..., 1] * b[..., 0]) / stretch2

    def elastic(self, state: Array) -> tuple[Array, Array]:
        """Derivatives of the energy by the values of each element: first (n, 8), second (n, 8, 8)."""
        from verify.elements.strain_kernels import differentiate

        (rows, axial, bending), at_rest = self._shapes, self._at_rest
        gradient, hessian = np.zeros((self.count, 8)), np.zeros((self.count, 8, 8))
        differentiate(self.of_elements(state), rows, axial, bending, at_rest, np.zeros((5, 4)), gradient, hessian)
        return gradient, hessian

    # --- Loads -----------------------------------------------------------------------------------------------------

    def loads(self, forces: Forces, state: Array) -> tuple[Array, Array]:
        """Generalised forces of the elements (n, 8), and their derivatives by the state, (n, 8, 8)."""
        vectors, matrices = self._weights @ forces.gravity, np.zeros((self.count, 8, 8))
        vectors[-1, 4:6] += forces.tip
        if not (forces.moment or np.any(forces.follower)):
            return vectors, matrices
        a = state[-1, 1]
        square, turned = float(a @ a), QUARTER @ a
        tangent = a / square**0.5
        frame = np.stack([tangent, QUARTER @ tangent], axis=1)
        turning = np.outer(frame[:, 1], frame[:, 1]) / square**0.5
        vectors[-1, 4:6] += frame @ forces.follower
        vectors[-1, 6:] += forces.moment * turned / square
        along, across = forces.follower
        matrices[-1, 4:6, 6:] = along * turning + across * QUARTER @ turning
        matrices[-1, 6:, 6:] = forces.moment * (QUARTER / square - 2.0 * np.outer(turned, a) / square**2)
        return vectors, matrices
