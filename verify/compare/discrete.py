"""Discrete beams of other codes that `verify` itself does not model, as factored eigenvalue problems.

Chains with lumped mass or other wall joints, Cosserat rods, Hermite elements with lumped mass, linear Timoshenko
elements. Unknowns: deflections of joints 0..N in mean part lengths, for some also rotations.
"""

from math import pi
from typing import Any

import numpy as np

from verify.beam import Beam
from verify.errors import InputError
from verify.models.arrays import Array
from verify.models.division import divide
from verify.models.eigen import lowest
from verify.models.inverse import first_bending
from verify.models.pencil import DENSE_UNKNOWNS, FactoredPencil

WALL_COMPLIANCE = {"half": 0.5, "full": 1.0, "rigid": 0.0, "stiff": 0.25}
"""Of the joint at a clamped end, l/EI: 2EI/l, EI/l, first link fixed to the wall, 4EI/l."""
NODE_INERTIA = {"lumped": 0.0, "lumped-rotary": 1 / 24, "hrz": 1 / 78}
"""Rotary inertia of half an element at its node over rho A l^3: none, a rigid half element, HRZ (Hinton, Rock and
Zienkiewicz, Earthquake Eng. Struct. Dyn. 4, 1976)."""
LARGEST = 1500
"""Parts: dense triangles of this size are factorised."""
POINT = 1e-5
"""Of m l^2/12, on links of point masses between free ends: without it one motion has no mass."""


class DiscreteBeam:
    """A beam in N equal parts per section, relative to its own EI and rho A. Raises InputError for attachments."""

    def __init__(self, beam: Beam, count: int, theory: str) -> None:
        beam.check_added("this candidate", ("section",))
        if count > LARGEST:
            raise InputError(f"count = {count} exceeds {LARGEST}, the most of this candidate: give fewer parts")
        parts = divide(beam, count)
        self.beam, self.n, self.unit, self.lengths = beam, count, parts.unit, parts.lengths
        self.stiffnesses, self.masses = parts.stiffnesses, parts.lengths * parts.masses_per_length
        self.rotary, self.shear = np.zeros(count), np.full(count, np.inf)  # rho I l, kappa G A
        ends = [beam.supports[0], *["free"] * (count - 1), beam.supports[1]]
        self.free = np.array([support not in ("pinned", "clamped") for support in ends])
        self.turning = np.array([support not in ("clamped", "guided") for support in ends])
        self.slopes = _bands(-1.0 / self.lengths, 1.0 / self.lengths)
        self.jumps = -_bands(-np.ones(count), np.ones(count)).T.tocsr()  # of slope at joints 0..N
        if theory == "euler-bernoulli":
            return
        inertias, stiffnesses = [p.rotary_inertia for p in beam.pieces], [p.shear_stiffness for p in beam.pieces]
        if None in inertias or (theory == "timoshenko" and None in stiffnesses):
            raise InputError("beam.rotary_inertia or beam.shear_stiffness is missing: give both for this theory")
        steps = np.cumsum([p.length for p in beam.pieces]) / self.unit
        piece = np.minimum(np.searchsorted(steps, parts.nodes[1:] - 0.5 * self.lengths), len(beam.pieces) - 1)
        self.rotary = np.array(inertias, float)[piece] * self.lengths / (beam.mass_per_length * self.unit**2)
        if theory == "timoshenko":
            self.shear = np.array(stiffnesses, float)[piece] * self.unit**2 / beam.bending_stiffness

    def chain_hz(self, n_modes: int, mass: str, wall: str) -> Array:
        """Rigid links with joint springs, Hz: their mass as 'links' with m l^2/12, as 'points', or at the 'joints'."""
        free, compliances, turn = self.free.copy(), self._compliances(wall), self.rotary / self.lengths**2
        for beside, support in zip((1, -2), self.beam.supports, strict=True):
            free[beside] &= not (support == "clamped" and wall == "rigid")
        if mass == "joints":
            own, coupled = 0.5 * self.masses + turn, -turn
        else:
            spin = {"links": 1.0, "points": POINT if free.all() else 0.0}[mass] * self.masses / 12.0
            own, coupled = 0.25 * self.masses + spin + turn, 0.25 * self.masses - spin - turn
        jointed = np.isfinite(compliances) & (compliances > 0.0)
        strain = (self.jumps @ self.slopes)[jointed][:, free]
        return self._lowest_hz(n_modes, strain, 1.0 / compliances[jointed], _assembled(own, coupled, free), free, 0)

    def rod_hz(self, n_modes: int, wall: str) -> Array:
        """Cosserat rod, Hz: masses at the nodes, rotation and shear of each part.

        Gazzola and others, "Forward and inverse problems in the mechanics of soft filaments", R. Soc. open sci. 5 (2018).
        """
        from scipy.sparse import block_array, diags_array, eye_array

        compliances, turning = self._compliances(wall), np.ones(self.n, dtype=bool)
        for end, support in zip((0, -1), self.beam.supports, strict=True):
            turning[end] &= not (support == "clamped" and wall == "rigid")
        jointed = np.isfinite(compliances) & (compliances > 0.0)
        chord = [self.slopes[:, self.free], -eye_array(self.n).tocsr()[:, turning]]
        strain = block_array([[None, self.jumps[jointed][:, turning]], chord]).tocsr()
        stiffness = np.append(1.0 / compliances[jointed], self.shear * self.lengths)
        mass = diags_array(np.append(_at_ends(0.5 * self.masses)[self.free], self.rotary[turning]))
        return self._lowest_hz(n_modes, strain, stiffness, mass, self.free, int(turning.sum()))

    def elements_hz(self, n_modes: int, mass: str) -> Array:
        """Elements of two nodes, Hz: Hermite with `mass` of NODE_INERTIA, or 'linear', 'linear-lumped' Timoshenko.

        Each has a spring EI/l between its rotations and one between chord and mean rotation: 12 EI/l^3 of the cubic in
        series with kappa G A / l, or the latter alone (linear, reduced integration).
        """
        from scipy.sparse import block_array, block_diag, diags_array

        if mass == "lumped" and np.isinf(self.shear).all() and not self.rotary.any():
            return self._condensed_hz(n_modes)
        free, turning, ones = self.free, self.turning, np.ones(self.n)
        chord = [self.slopes[:, free], -_bands(0.5 * ones, 0.5 * ones)[:, turning]]
        strain = block_array([[None, _bands(-ones, ones)[:, turning]], chord]).tocsr()
        cubic = 0.0 if mass in ("linear", "linear-lumped") else self.lengths / (12.0 * self.stiffnesses)
        stiffness = np.append(self.stiffnesses / self.lengths, 1.0 / (cubic + 1.0 / (self.shear * self.lengths)))
        if mass == "linear":
            pairs = ((self.masses, free), (self.rotary, turning))
            matrix = block_diag([_assembled(values / 3.0, values / 6.0, which) for values, which in pairs]).tocsr()
        else:
            inertias = NODE_INERTIA.get(mass, 0.0) * self.masses * self.lengths**2 + 0.5 * self.rotary
            matrix = diags_array(np.append(_at_ends(0.5 * self.masses)[free], _at_ends(inertias)[turning]))
        return self._lowest_hz(n_modes, strain, stiffness, matrix, free, int(turning.sum()))

    def _condensed_hz(self, n_modes: int) -> Array:
        """Hermite elements without rotary inertia at the nodes, rotations eliminated: K = D^T S^-1 D.

        D: deflections to jumps of slope; S: the three-moment matrix, moments to the same jumps.
        """
        from scipy.linalg import cholesky, solve_triangular
        from scipy.sparse import csc_array, diags_array

        flexibility, held = self.lengths / self.stiffnesses, ~self.turning
        held[1:-1] = True
        lower = cholesky(_assembled(flexibility / 3.0, flexibility / 6.0, held).toarray(), lower=True)
        jump = (self.jumps @ self.slopes)[held][:, self.free]
        strain = csc_array(solve_triangular(lower, jump.toarray(), lower=True))
        mass = diags_array(_at_ends(0.5 * self.masses)[self.free])
        return self._lowest_hz(n_modes, strain, np.ones(int(held.sum())), mass, self.free, 0)

    def _compliances(self, wall: str) -> Array:
        """1/k of joints 0..N: two half links in series, at clamped ends by the wall rule; infinite without a joint."""
        from verify.segments.walls import wall_factors

        whole = _at_ends(0.5 * self.lengths / self.stiffnesses)
        whole[[0, -1]] *= 2.0
        if wall not in WALL_COMPLIANCE:
            return np.asarray(whole * wall_factors(self.beam.supports, self.n, wall))
        ends = {"clamped": WALL_COMPLIANCE[wall], "guided": 0.5}
        whole[[0, -1]] *= [ends.get(support, np.inf) for support in self.beam.supports]
        return whole

    def _lowest_hz(self, n_modes: int, strain: Any, stiffness: Array, mass: Any, free: Any, n_turns: int) -> Array:
        """Elastic frequencies of B^T diag(stiffness) B against M: `free` deflections, then `n_turns` rotations."""
        x = np.concatenate([[0.0], np.cumsum(self.lengths)])[free] * self.unit
        rigid = [np.append(a + b * x, np.full(n_turns, b * self.unit)) for a, b in self.beam.rigid_lines]
        size = mass.shape[0]
        held = np.asarray(mass.toarray()) if size <= DENSE_UNKNOWNS else mass.tocsc()
        pencil = FactoredPencil(
            n=size,
            rigid=np.array(rigid).reshape(len(rigid), size).T,
            strain=lambda v: np.asarray(strain @ v),
            stiffness=stiffness,
            strain_matrix=lambda: strain,
            mass_matrix=lambda: held,
            bending=first_bending(self.lengths, self.stiffnesses, self.masses / self.lengths),
        )
        available = min(n_modes, size - len(rigid))
        if available < 1:
            return np.empty(0)
        omega = np.sqrt(lowest(pencil, available).values) * self.beam.wave_constant / self.unit**2
        return np.asarray(omega / (2.0 * pi))


def _at_ends(values: Array) -> Array:
    """Sums at joints 0..N of what each part adds to both its ends, (N + 1,)."""
    return np.asarray(np.append(values, 0.0) + np.append(0.0, values))


def _bands(left: Array, right: Array) -> Any:
    """A sparse (N, N + 1) matrix with `left` of joint i and `right` of joint i + 1 in row i."""
    from scipy.sparse import diags_array

    return diags_array([left, right], offsets=[0, 1], shape=(len(left), len(left) + 1)).tocsr()


def _assembled(own: Array, coupled: Array, kept: Any) -> Any:
    """Matrices [[own, coupled], [coupled, own]] of the parts assembled, sparse, at the joints that are `kept`."""
    from scipy.sparse import diags_array

    return diags_array([coupled, _at_ends(own), coupled], offsets=[-1, 0, 1]).tocsr()[kept][:, kept]
