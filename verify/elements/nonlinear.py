"""A beam of nonlinear Hermite elements: equilibria under load and rotation, and frequencies about them."""

from collections.abc import Sequence
from dataclasses import dataclass
from math import pi

import numpy as np
from scipy.linalg import LinAlgError, cholesky, cholesky_banded, eigh, eigvalsh, solve_triangular

from verify.arrays import Array, ComplexArray
from verify.elements.plane_elements import BAND, NONE, QUARTER, Forces, PlaneElements
from verify.errors import InputError, shown
from verify.linear.field import phasor
from verify.linear.positions import Numbers, as_vector
from verify.problem.beam import PointForce
from verify.validation import check_number

TOLERANCE = 1e-11
"""Newton step, relative to the length, that ends the iteration: the next one, by its square, is rounding."""
FLOOR = 1e-8  # a step below it that is not smaller than the one before is rounding, which grows with EA L^2/EI
LARGEST_TURN = 0.5  # largest change of a slope in one Newton step: tangents are unit vectors


class NonlinearHermite(PlaneElements):
    """A beam of `count` nonlinear Hermite elements; `axial_stiffness` EA, N, is by default that of its section.

    `curvature` of the unloaded beam, 1/m, is a function of arrays of arc length, m; such a beam is a cantilever that
    starts along x. Supports are those of the beam; the left of two supported ends does not slide along the beam, and
    with `immovable` nor does the right one. Raises InputError for attachments, a loss factor, axial force, an unknown
    EA, and curved beams on other supports.
    """

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
        of the tip's tangent and normal. The base turns steadily at `rate`, rad/s, `hub_radius` (m) beyond the axis, and
        the loads turn with it.
        Newton's method in load steps from the unloaded beam, a quarter as long where it fails and twice as long where
        it does not; from `start` in one step. Raises InputError where steps of a millionth of the load fail.
        """
        forces = Forces(in_plane("load", load), moment, in_plane("follower", follower), in_plane("gravity", gravity))
        state, done, part = self.rest if start is None else start.state, 0.0, 1.0
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
        return BentElements(model=self, state=state, rate=rate, forces=forces)

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
            gradient, hessian = self.elastic(state)
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

    def frequencies_hz(self, state: Array, rate: float, forces: Forces, flapping: bool) -> Array:
        """See `BentElements.frequencies_hz`."""
        if forces.follower.any():
            raise InputError(f"follower = {shown(forces.follower)}: its stiffness is not symmetric, give a dead load")
        free = np.flatnonzero(self.free.ravel())
        stiffness, mass = (
            dense(self.band(matrices))[np.ix_(free, free)]
            for matrices in (self.elastic(state)[1] - self.loads(forces, state)[1], self.element_masses)
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
    """Equilibrium of nonlinear elements in the frame of their base; x along the start of the unloaded beam."""

    model: NonlinearHermite
    state: Array
    """(count + 1, 2, 2): of a node r = (x, y), m, then r'."""
    rate: float = 0.0
    """Of the base, rad/s."""
    forces: Forces = NONE
    """Along and across the straight beam."""

    @property
    def tip(self) -> Array:
        """(2,), m: (x, y) of the right end."""
        return np.asarray(self.state[-1, 0])

    @property
    def deflection(self) -> float:
        """Transverse displacement of the right end, m."""
        return float(self.state[-1, 0, 1] - self.model.rest[-1, 0, 1])

    @property
    def shortening(self) -> float:
        """Axial displacement of the right end towards the left one, m."""
        return float(self.model.rest[-1, 0, 0] - self.state[-1, 0, 0])

    @property
    def turn(self) -> float:
        """Rotation of the right end, rad, between -pi and pi."""
        (c, s), (x, y) = self.model.rest[-1, 1], self.state[-1, 1]
        return float(np.arctan2(c * y - s * x, c * x + s * y))

    @property
    def energy(self) -> float:
        """Strain energy, J."""
        return float(self.model.energy(self.state))

    def frequencies_hz(self, *, flapping: bool = False) -> Array:
        """Natural frequencies about the equilibrium, Hz, in ascending order; dead loads and gravity have no stiffness.

        In the plane, with the gyroscopic term of the base's rotation (lead-lag); with `flapping` across the plane, of a
        straight beam whose EI is the same there. Those in the plane include axial modes and, above 2 sqrt(EI/rho A)/l^2
        rad/s (about mode 0.45 `count`), modes of the slopes x' that the two points of EA leave soft, which no beam has.
        Raises InputError for an unstable equilibrium, and under a follower force.
        """
        return self.model.frequencies_hz(self.state, self.rate, self.forces, flapping)

    def __repr__(self) -> str:
        x, y = self.tip
        return f"BentElements({self.model.count} elements, tip at ({x:.6g}, {y:.6g}) m)"


def in_plane(name: str, value: Numbers) -> Array:
    """A vector (along, across), (2,), from one number across the beam, or two. Raises InputError."""
    vector = as_vector(name, value, "N or m/s^2")
    if vector.shape not in ((1,), (2,)):
        raise InputError(f"{name} = {shown(value)}: give one number across the beam, or two, along and across")
    return vector if len(vector) == 2 else np.array([0.0, vector[0]])
