"""Discrete beams of other codes that are not models of `verify`, as factored eigenvalue problems.

Chains with lumped mass or other wall joints, Cosserat rods, Hermite elements with lumped mass, linear Timoshenko
elements. Unknowns: deflections of joints 0..N in mean part lengths, for some also rotations.
"""

from math import pi
from typing import Any

import numpy as np

from verify.arrays import Array
from verify.errors import InputError
from verify.linear.mesh import divide
from verify.linear.system import StructuralSystem
from verify.problem.beam import Beam, check_features, rigid_lines

STEPS = {
    "centre": "equal links by the section at their centre",
    "outboard": "joints by EI/l of the outboard link",
    "inboard": "joints by EI/l of the inboard link",
    "mean": "joints by the mean EI",
}
"""Joint rules of equal links with the section at their centre, and their labels."""
MASSLESS = 1e-12
"""Rotary inertia over m l^2 in place of zero: negligible, keeps the mass matrix regular."""
NODE_INERTIA = {"lumped": MASSLESS, "lumped-rotary": 1 / 24, "hrz": 1 / 78}
"""Rotary inertia of half an element at its node over m l^2: none, a rigid half element, HRZ (Hinton, Rock and
Zienkiewicz, Earthquake Eng. Struct. Dyn. 4, 1976)."""


class DiscreteBeam:
    """A beam in N equal parts per section, relative to its own EI and rho A. Raises InputError for attachments."""

    def __init__(self, beam: Beam, count: int, theory: str, joints: str = "series") -> None:
        check_features(beam, "this candidate", ("section",))
        parts, self.joints = divide(beam, count), joints
        self.beam, self.n, self.unit = beam, count, parts.unit
        self.lengths = np.ones(count) if joints in STEPS else parts.lengths
        steps, centres = np.cumsum([p.length for p in beam.pieces]) / self.unit, np.cumsum(self.lengths)
        centres -= 0.5 * self.lengths
        piece = np.minimum(np.searchsorted(steps, centres), len(beam.pieces) - 1)
        self.stiffnesses = np.array([p.bending_stiffness for p in beam.pieces])[piece] / beam.bending_stiffness
        self.masses = np.array([p.mass_per_length for p in beam.pieces])[piece] * self.lengths / beam.mass_per_length
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
        self.rotary = np.array(inertias, float)[piece] * self.lengths / (beam.mass_per_length * self.unit**2)
        if theory == "timoshenko":
            self.shear = np.array(stiffnesses, float)[piece] * self.unit**2 / beam.bending_stiffness

    def chain_hz(self, n_modes: int, mass: str, wall: str) -> Array:
        """Rigid links with joint springs, Hz: their mass as 'links' with m l^2/12, as 'points', or at the 'joints'."""
        free, compliances, turn = self.free.copy(), self._compliances(wall), self.rotary / self.lengths**2
        for beside, end in ((1, 0), (-2, -1)):
            free[beside] &= compliances[end] > 0.0
        if mass == "joints":
            own, coupled = 0.5 * self.masses + turn, -turn
        else:
            points = 1e-6 if free.all() else 0.0  # between free ends one motion is massless
            spin = {"links": 1.0 / 12.0, "points": points}[mass] * self.masses
            own, coupled = 0.25 * self.masses + spin + turn, 0.25 * self.masses - spin - turn
        jointed = np.isfinite(compliances) & (compliances > 0.0)
        strain = (self.jumps @ self.slopes)[jointed][:, free]
        return self._lowest_hz(n_modes, strain, 1.0 / compliances[jointed], _assembled(own, coupled, free), free)

    def rod_hz(self, n_modes: int, wall: str) -> Array:
        """Cosserat rod, Hz: masses at the nodes, rotation and shear of each part.

        Gazzola and others, "Forward and inverse problems in the mechanics of soft filaments", R. Soc. Open Sci. 2018.
        """
        from scipy.sparse import block_array, diags_array, eye_array

        compliances, turning = self._compliances(wall), np.ones(self.n, dtype=bool)
        turning[[0, -1]] &= compliances[[0, -1]] > 0.0
        jointed = np.isfinite(compliances) & (compliances > 0.0)
        chord = [self.slopes[:, self.free], -eye_array(self.n).tocsr()[:, turning]]
        strain = block_array([[None, self.jumps[jointed][:, turning]], chord]).tocsr()
        stiffness = np.append(1.0 / compliances[jointed], self.shear * self.lengths)
        mass = diags_array(np.append(_at_ends(0.5 * self.masses)[self.free], self.rotary[turning]))
        return self._lowest_hz(n_modes, strain, stiffness, mass, self.free)

    def elements_hz(self, n_modes: int, mass: str) -> Array:
        """Elements of two nodes, Hz: Hermite with `mass` of NODE_INERTIA, or 'linear', 'linear-lumped' Timoshenko.

        Each has a spring EI/l between its rotations and one between chord and mean rotation: 12 EI/l^3 of the cubic in
        series with kappa G A / l, or the latter alone (linear, reduced integration).
        """
        from scipy.sparse import block_array, block_diag, diags_array

        free, turning, ones = self.free, self.turning, np.ones(self.n)
        chord = [self.slopes[:, free], -_bands(0.5 * ones, 0.5 * ones)[:, turning]]
        strain = block_array([[None, _bands(-ones, ones)[:, turning]], chord]).tocsr()
        cubic = 0.0 if mass not in NODE_INERTIA else self.lengths / (12.0 * self.stiffnesses)
        stiffness = np.append(self.stiffnesses / self.lengths, 1.0 / (cubic + 1.0 / (self.shear * self.lengths)))
        if mass == "linear":
            pairs = ((self.masses, free), (self.rotary, turning))
            matrix = block_diag([_assembled(values / 3.0, values / 6.0, which) for values, which in pairs]).tocsr()
        else:
            inertias = NODE_INERTIA.get(mass, 0.0) * self.masses * self.lengths**2 + 0.5 * self.rotary
            if mass == "lumped" and not self.rotary.any():  # rotations have no modes
                n_modes = min(n_modes, int(free.sum()) - self.beam.rigid_motions)
            matrix = diags_array(np.append(_at_ends(0.5 * self.masses)[free], _at_ends(inertias)[turning]))
        return self._lowest_hz(n_modes, strain, stiffness, matrix, free)

    def _compliances(self, wall: str) -> Array:
        """1/k of joints 0..N: two half links in series, at clamped ends by the wall rule; infinite without a joint.

        Outboard is away from the clamped end, or to the right.
        """
        from verify.segments.walls import wall_factors

        links = self.lengths / self.stiffnesses
        near, far = links[:-1], links[1:]
        if self.beam.supports[1] == "clamped" != self.beam.supports[0]:
            near, far = far, near
        rules = {"outboard": far, "inboard": near, "mean": 2.0 / (1.0 / near + 1.0 / far)}
        whole = np.concatenate([links[:1], rules.get(self.joints, 0.5 * (near + far)), links[-1:]])
        return np.asarray(whole * wall_factors(self.beam.supports, self.n, wall))

    def _lowest_hz(self, n_modes: int, strain: Any, stiffness: Array, mass: Any, free: Any) -> Array:
        """Elastic frequencies of B^T diag(stiffness) B against M: `free` deflections, then rotations."""
        size, x = mass.shape[0], np.concatenate([[0.0], np.cumsum(self.lengths)])[free] * self.unit
        rigid = [np.append(a + b * x, np.full(size - len(x), b * self.unit)) for a, b in rigid_lines(self.beam)]
        system = StructuralSystem([strain], stiffness, mass.tocsc(), np.array(rigid).reshape(len(rigid), size).T)
        available = min(n_modes, size - len(rigid))
        if available < 1:
            return np.empty(0)
        omega = np.sqrt(system.modes(available)[0]) * self.beam.wave_constant / self.unit**2
        return np.asarray(omega / (2.0 * pi))


def _at_ends(values: Array) -> Array:
    """Sums at joints 0..N of values (N,) that each part adds at both ends, (N + 1,)."""
    return np.asarray(np.append(values, 0.0) + np.append(0.0, values))


def _bands(left: Array, right: Array) -> Any:
    """A sparse (N, N + 1) matrix with `left` of joint i and `right` of joint i + 1 in row i."""
    from scipy.sparse import diags_array

    return diags_array([left, right], offsets=[0, 1], shape=(len(left), len(left) + 1)).tocsr()


def _assembled(own: Array, coupled: Array, free: Any) -> Any:
    """Sparse assembly of part matrices [[own, coupled], [coupled, own]] at the joints `free`."""
    from scipy.sparse import diags_array

    return diags_array([coupled, _at_ends(own), coupled], offsets=[-1, 0, 1]).tocsr()[free][:, free]
