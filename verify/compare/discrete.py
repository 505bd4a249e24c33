"""Discrete beams of other codes that are not models of `verify`, as factored eigenvalue problems.

Chains with lumped mass or other wall joints, Cosserat rods, Hermite elements with lumped mass, linear Timoshenko
elements. Unknowns: deflections of joints 0..N in mean part lengths, for some also rotations.
"""

from math import pi
from typing import Any

import numpy as np

from verify.arrays import Array
from verify.errors import InputError
from verify.linear.mesh import cut_pieces, divide
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
    """A beam in N equal parts per section, relative to its own EI and rho A.

    Parts end at point masses and springs too, which elements and links with half links at both ends may have. Raises
    InputError for a foundation or an axial force, and where other chains have attachments.
    """

    def __init__(self, beam: Beam, count: int, theory: str, joints: str = "series") -> None:
        check_features(beam, "this candidate", ("section", "attached"))
        pieces = cut_pieces(beam)
        parts, self.joints = divide(beam, count, pieces=pieces if len(pieces) > len(beam.pieces) else ()), joints
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
        check_features(self.beam, "this candidate", ("section",))
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
        return self._lowest_hz(
            n_modes, strain, 1.0 / compliances[jointed], _assembled(own, coupled, free), self.nodes[free]
        )

    def rod_hz(self, n_modes: int, wall: str) -> Array:
        """Cosserat rod, Hz: masses at the nodes, rotation and shear of each part.

        Gazzola and others, "Forward and inverse problems in the mechanics of soft filaments", R. Soc. Open Sci. 2018.
        """
        from scipy.sparse import block_array, diags_array, eye_array

        check_features(self.beam, "this candidate", ("section",))
        compliances, turning = self._compliances(wall), np.ones(self.n, dtype=bool)
        turning[[0, -1]] &= compliances[[0, -1]] > 0.0
        jointed = np.isfinite(compliances) & (compliances > 0.0)
        chord = [self.slopes[:, self.free], -eye_array(self.n).tocsr()[:, turning]]
        strain = block_array([[None, self.jumps[jointed][:, turning]], chord]).tocsr()
        stiffness = np.append(1.0 / compliances[jointed], self.shear * self.lengths)
        mass = diags_array(np.append(_at_ends(0.5 * self.masses)[self.free], self.rotary[turning]))
        return self._lowest_hz(n_modes, strain, stiffness, mass, self.nodes[self.free])

    def elements_hz(self, n_modes: int, mass: str) -> Array:
        """Elements of two nodes, Hz: Hermite with `mass` of NODE_INERTIA, or 'linear', 'linear-lumped' Timoshenko.

        Each has a spring EI/l between its rotations and one between chord and mean rotation: 12 EI/l^3 of the cubic in
        series with kappa G A / l, or the latter alone (linear, reduced integration).
        """
        from scipy.sparse import block_array, block_diag, diags_array, eye_array, vstack

        free, turning, ones = self.free, self.turning, np.ones(self.n)
        chord = [self.slopes[:, free], -_bands(0.5 * ones, 0.5 * ones)[:, turning]]
        strain = block_array([[None, _bands(-ones, ones)[:, turning]], chord]).tocsr()
        cubic = 0.0 if mass not in NODE_INERTIA else self.lengths / (12.0 * self.stiffnesses)
        stiffness = np.append(self.stiffnesses / self.lengths, 1.0 / (cubic + 1.0 / (self.shear * self.lengths)))
        bodies, springs = self._attached()
        if len(springs):
            at = springs[:, 0].astype(int)
            deflections, rotations = (eye_array(self.n + 1).tocsr()[at][:, which] for which in (free, turning))
            strain = vstack([strain, block_diag([deflections, rotations])]).tocsr()
            stiffness = np.concatenate([stiffness, springs[:, 1], springs[:, 2]])
            strain, stiffness = strain[stiffness > 0.0], stiffness[stiffness > 0.0]
        if mass == "linear":
            pairs = ((self.masses, free), (self.rotary, turning))
            matrix = block_diag([_assembled(values / 3.0, values / 6.0, which) for values, which in pairs]).tocsr()
        else:
            inertias = NODE_INERTIA.get(mass, 0.0) * self.masses * self.lengths**2 + 0.5 * self.rotary
            if mass == "lumped" and not (self.rotary.any() or bodies[1].any()):  # rotations have no modes
                n_modes = min(n_modes, int(free.sum()) - self.beam.rigid_motions)
            matrix = diags_array(np.append(_at_ends(0.5 * self.masses)[free], _at_ends(inertias)[turning]))
        matrix = matrix + diags_array(np.append(bodies[0][free], bodies[1][turning]))
        return self._lowest_hz(n_modes, strain, stiffness, matrix, self.nodes[free])

    def halves_hz(self, n_modes: int) -> Array:
        """Two rigid half links per part with a joint EI/l between, Hz: half links at both ends, whole ones inside.

        Wittbrodt, Adamiec-Wojcik and Wojciech, "Dynamics of Flexible Multibody Systems: Rigid Finite Element Method",
        2006; MathWorks, "Flexible beams by lumped parameters", Simscape Multibody. Attachments are on the links.
        """
        from scipy.sparse import csr_array, diags_array

        joints, ends = 0.5 * (self.nodes[:-1] + self.nodes[1:]), self.nodes[[0, -1]]
        corners = np.concatenate([ends[:1], joints, ends[1:]])
        halves = np.sort(np.concatenate([joints, self.nodes]))

        def deflection(x: Array) -> Any:  # at x by linear interpolation between the corners of the chain
            i = np.clip(np.searchsorted(corners, x, side="right") - 1, 0, self.n)
            share, rows = (x - corners[i]) / np.diff(corners)[i], np.arange(len(x))
            cells = np.concatenate([1.0 - share, share]), (np.tile(rows, 2), np.concatenate([i, i + 1]))
            return csr_array(cells, shape=(len(x), self.n + 2))

        free = np.concatenate([self.free[:1], np.ones(self.n, dtype=bool), self.free[-1:]])
        for beside, end in ((1, 0), (-2, -1)):
            free[beside] &= bool(self.turning[end])
        check_features(self.beam, "this candidate", ("section", "bodies"))
        masses, at = np.repeat(0.5 * self.masses, 2), deflection(halves)
        bodies = diags_array(self._attached()[0][0])
        inner = _assembled(masses / 3.0, masses / 6.0, np.ones(len(halves), dtype=bool))
        matrix = at.T @ inner @ at + deflection(self.nodes).T @ bodies @ deflection(self.nodes)
        slopes = diags_array(
            [-1.0 / np.diff(corners), 1.0 / np.diff(corners)], offsets=[0, 1], shape=(self.n + 1, self.n + 2)
        )
        jumps = diags_array([-np.ones(self.n), np.ones(self.n)], offsets=[0, 1], shape=(self.n, self.n + 1))
        strain = (jumps @ slopes).tocsr()[:, free]
        return self._lowest_hz(
            n_modes, strain, self.stiffnesses / self.lengths, matrix.tocsr()[free][:, free], corners[free]
        )

    @property
    def nodes(self) -> Array:
        """Joints 0..N, in mean part lengths."""
        return np.append(0.0, np.cumsum(self.lengths))

    def _attached(self) -> tuple[Array, Array]:
        """(mass and rotary inertia of bodies at the joints (2, N + 1); joint, stiffnesses of each spring (k, 3))."""
        scale, nodes, bodies = self.beam.mass_per_length * self.unit, self.nodes, np.zeros((2, self.n + 1))
        for body in self.beam.mass:
            at = abs(nodes - body.position / self.unit).argmin()
            bodies[:, at] += body.mass / scale, body.rotary_inertia / (scale * self.unit**2)
        ei = self.beam.bending_stiffness / self.unit
        rows = [
            (abs(nodes - one.position / self.unit).argmin(), one.stiffness * self.unit**2 / ei, one.rotational / ei)
            for one in self.beam.spring
        ]
        return bodies, np.array(rows, dtype=float).reshape(len(rows), 3)

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

    def _lowest_hz(self, n_modes: int, strain: Any, stiffness: Array, mass: Any, x: Array) -> Array:
        """Elastic frequencies of B^T diag(stiffness) B against M: deflections at `x` in parts, then rotations."""
        size, x = mass.shape[0], x * self.unit
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
