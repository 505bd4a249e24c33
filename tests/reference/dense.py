"""Dense matrices of Hermite elements and of rigid links on any beam: textbook entries, springs in joints.

Written independently of the package, from which it takes value types alone. SI units; the caller gives the nodes.
"""

from collections.abc import Sequence
from functools import cached_property
from math import pi
from typing import Any, TypeAlias

import numpy as np
from scipy.interpolate import CubicSpline
from scipy.linalg import eigh

from verify.problem.beam import Beam, PointForce
from verify.problem.cross_section import Piece

Array: TypeAlias = Any


def phasor(force: PointForce) -> complex:
    """Amplitude and phase of a force as a complex number, newton."""
    return complex(force.amplitude * np.exp(1j * np.deg2rad(force.phase_deg)))


HELD = {"pinned": (0,), "clamped": (0, 1), "guided": (1,), "free": ()}
"""Deflection 0 and slope 1 that an end prescribes."""
WALLS = ("clamped", "guided")
GREGORY = np.array([3.0 / 8.0, 7.0 / 6.0, 23.0 / 24.0])
"""Compliance of the joints next to a clamp over that of inner joints."""
CUBICS = np.array([[1.0, 0.0, -3.0, 2.0], [0.0, 1.0, -2.0, 1.0], [0.0, 0.0, 3.0, -2.0], [0.0, 0.0, -1.0, 1.0]])
"""Hermite's, of deflection and slope at both ends, over the length."""


class DenseModel:
    """Dense matrices over all unknowns: bending stiffness, all other stiffness, mass.

    Twice the bending energy is the sum of `rigidity` times squares of the strains `bend` v.
    """

    bend: Array
    rigidity: Array
    bending: Array
    rest: Array
    mass: Array
    free: list[int]

    def __init__(self, beam: Beam, nodes: Array) -> None:
        self.beam, self.nodes, self.lengths = beam, nodes, np.diff(nodes)
        ends = np.cumsum([piece.length for piece in beam.pieces])
        middles = np.clip(np.searchsorted(ends, nodes[:-1] + 0.5 * self.lengths), 0, len(ends) - 1)
        self.pieces: list[Piece] = [beam.pieces[int(i)] for i in middles]

    def reduced(self, matrix: Any) -> Any:
        """Rows and columns of the unconstrained unknowns."""
        return matrix[np.ix_(self.free, self.free)]

    @cached_property
    def modes(self) -> tuple[Array, Array]:
        """(omega^2, shapes over all unknowns in columns, of modal mass 1).

        omega^2 is the Rayleigh quotient: rounding in the assembled stiffness costs eigenvalues n^4 eps.
        """
        _, vectors = eigh(self.reduced(self.bending + self.rest), self.reduced(self.mass))
        every = np.zeros((len(self.mass), len(self.free)))
        every[self.free] = vectors
        values = self.squares(every)
        values[: self.beam.rigid_motions] = 0.0
        return values, every

    def squares(self, vectors: Array) -> Array:
        """Rayleigh quotients omega^2 of vectors in columns."""
        energy = self.rigidity @ (self.bend @ vectors) ** 2 + np.sum(vectors * (self.rest @ vectors), axis=0)
        return np.asarray(energy / np.sum(vectors * (self.mass @ vectors), axis=0))

    def frequencies_hz(self, n_modes: int) -> Array:
        """The first elastic frequencies, Hz."""
        rigid = self.beam.rigid_motions
        return np.asarray(np.sqrt(self.modes[0][rigid : rigid + n_modes]) / (2.0 * pi))

    def harmonic(self, load: Array, hertz: float, ratio: float = 0.0, more: Array | None = None) -> Array:
        """All unknowns under a load: bending with the beam's loss, `more` dashpots, a ratio of every mode."""
        omega, lossy = 2.0 * pi * hertz, 1.0 + 1j * self.beam.loss_factor
        solution = np.zeros(len(self.mass), dtype=complex)
        if ratio:
            values, vectors = self.modes
            amplitudes = (vectors.T @ load) / (
                values - omega**2 + 2j * ratio * omega * np.sqrt(np.maximum(values, 0.0))
            )
            return np.asarray(vectors @ amplitudes)
        stiffness = self.bending * lossy + self.rest + (0.0 if more is None else 1j * omega * more)
        matrix: Any = self.reduced(stiffness - omega**2 * self.mass)
        solution[self.free] = np.linalg.solve(matrix, load[self.free])
        return solution

    def buckling(self, geometric: Array) -> float:
        """The least compression under which no stiffness is left, `geometric` being the stiffness of a unit tension."""
        values = eigh(self.reduced(geometric), self.reduced(self.bending + self.rest), eigvals_only=True)
        return float(1.0 / values[-1])


class Elements(DenseModel):
    """Hermite elements by their textbook entries."""

    def __init__(self, beam: Beam, nodes: Array) -> None:
        super().__init__(beam, nodes)
        size = 2 * len(nodes)
        self.bending, self.rest, self.mass, self.geometric = np.zeros((4, size, size))
        self.bend, self.rigidity = np.zeros((size - 2, size)), np.zeros(size - 2)
        for i, (piece, n) in enumerate(zip(self.pieces, self.lengths, strict=True)):
            at, both = slice(2 * i, 2 * i + 4), slice(2 * i, 2 * i + 2)
            self.bend[both, at] = (0.0, -1.0, 0.0, 1.0), (2.0 / n, 1.0, -2.0 / n, 1.0)  # mean and linear curvature
            self.rigidity[both] = piece.bending_stiffness / n, 3.0 * piece.bending_stiffness / n
            bending, pulled, inertia = _hermite(float(n))
            self.bending[at, at] += piece.bending_stiffness * bending
            self.geometric[at, at] += pulled
            self.rest[at, at] += beam.foundation * inertia
            self.mass[at, at] += piece.mass_per_length * inertia
        self.rest += beam.tension * self.geometric
        for mass in beam.mass:
            self._attach(self.mass, mass.position, mass.mass, mass.rotary_inertia)
        for spring in beam.spring:
            self._attach(self.rest, spring.position, spring.stiffness, spring.rotational)
        held = list(HELD[beam.supports[0]]) + [size - 2 + k for k in HELD[beam.supports[1]]]
        self.free = [i for i in range(size) if i not in held]

    def _attach(self, matrix: Array, at: float, across: float, turning: float) -> None:
        for derivative, value in ((0, across), (1, turning)):
            row = self.row(at, derivative)
            matrix += value * np.outer(row, row)

    def row(self, x: float, derivative: int) -> Array:
        """Row of a derivative at x over the nodal values."""
        i = int(np.clip(np.searchsorted(self.nodes, x + 1e-12, side="right") - 1, 0, len(self.lengths) - 1))
        n, z = float(self.lengths[i]), (x - float(self.nodes[i])) / float(self.lengths[i])
        powers = ((1.0, z, z**2, z**3), (0.0, 1.0, 2.0 * z, 3.0 * z**2), (0.0, 0.0, 2.0, 6.0 * z))[derivative]
        row = np.zeros(2 * len(self.nodes))
        row[2 * i : 2 * i + 4] = CUBICS @ powers * (1.0, n, 1.0, n) / n**derivative
        return row

    def load(self, forces: Sequence[PointForce]) -> Array:
        """Of point forces."""
        return np.asarray(sum(phasor(force) * self.row(force.position, 0) for force in forces), dtype=complex)

    def values_at(self, solution: Any, x: Array, derivative: int) -> Any:
        """At places."""
        return np.asarray(np.array([self.row(at, derivative) for at in x.tolist()]) @ solution)


def _hermite(n: float) -> tuple[Array, Array, Array]:
    """K of bending, of a tension of 1, and M of an element of length n, EI = rho A = 1."""
    d = np.array([1.0, n, 1.0, n])
    scale = np.outer(d, d)
    bending = np.array([[12, 6, -12, 6], [6, 4, -6, 2], [-12, -6, 12, -6], [6, 2, -6, 4]]) * scale / n**3
    pulled = np.array([[36, 3, -36, 3], [3, 4, -3, -1], [-36, -3, 36, -3], [3, -1, -3, 4]]) * scale / (30.0 * n)
    mass = np.array([[156, 22, 54, -13], [22, 4, 13, -3], [54, 13, 156, -22], [-13, -3, -22, 4]]) * scale * n / 420.0
    return bending, pulled, mass


class Links(DenseModel):
    """Rigid links with half their compliance in the joint at either end; attachments move with their link."""

    def __init__(self, beam: Beam, nodes: Array, wall: Array = GREGORY) -> None:
        super().__init__(beam, nodes)
        n, (left, right) = len(self.lengths), beam.supports
        eye = np.eye(n + 1)
        self.tilt, middle = np.diff(eye, axis=0) / self.lengths[:, None], 0.5 * (eye[1:] + eye[:-1])
        none = np.zeros((1, n + 1))
        walled = [self.tilt, *([none] if right in WALLS else [])]
        self.bend = np.diff(np.vstack([none, *walled] if left in WALLS else walled), axis=0)
        half = np.array([0.5 * a / piece.bending_stiffness for piece, a in zip(self.pieces, self.lengths, strict=True)])
        compliance = half[1:] + half[:-1]
        self.compliance = np.concatenate([2.0 * half[: left in WALLS], compliance, 2.0 * half[n - (right in WALLS) :]])
        factors = np.ones(len(self.compliance))
        for side, support in ((1, left), (-1, right)):
            along = factors[::side]
            if support == "clamped":
                along[: len(wall)] += wall[: len(along)] - 1.0
            elif support == "guided":
                along[0] *= 0.5
        self.compliance *= factors
        self.rigidity = 1.0 / self.compliance
        self.bending = (self.bend.T * self.rigidity) @ self.bend
        line = np.array([piece.mass_per_length for piece in self.pieces]) * self.lengths
        bed = beam.foundation * self.lengths
        self.geometric = (self.tilt.T * self.lengths) @ self.tilt
        self.mass, self.rest = (
            (middle.T * own) @ middle + (self.tilt.T * (own * self.lengths**2 / 12.0)) @ self.tilt
            for own in (line, bed)
        )
        self.rest += beam.tension * self.geometric
        for mass in beam.mass:
            self._attach(self.mass, mass.position, mass.mass, mass.rotary_inertia)
        for spring in beam.spring:
            self._attach(self.rest, spring.position, spring.stiffness, spring.rotational)
        held = [end for end, support in zip((0, n), beam.supports, strict=True) if support in ("pinned", "clamped")]
        self.free = [i for i in range(n + 1) if i not in held]

    def _link(self, x: float) -> int:
        return int(np.clip(np.searchsorted(self.nodes, x, side="right") - 1, 0, len(self.lengths) - 1))

    def _attach(self, matrix: Array, at: float, across: float, turning: float) -> None:
        row, tilt = self.row(at), self.tilt[self._link(at)]
        matrix += across * np.outer(row, row) + turning * np.outer(tilt, tilt)

    def row(self, x: float) -> Array:
        """Shares of both joints of a link by the lever rule."""
        i = self._link(x)
        share = (x - self.nodes[i]) / self.lengths[i]
        row = np.zeros(len(self.nodes))
        row[i : i + 2] = 1.0 - share, share
        return row

    def load(self, forces: Sequence[PointForce]) -> Array:
        """Of point forces, by the lever rule."""
        return np.asarray(sum(phasor(force) * self.row(force.position) for force in forces), dtype=complex)

    def values_at(self, solution: Any, x: Array, derivative: int) -> Any:
        """At places of the cubic spline through the joints, level at walls and without moment at other ends."""
        still = np.zeros(solution.shape[1:])
        ends = tuple((1 if support in WALLS else 2, still) for support in self.beam.supports)
        return np.asarray(CubicSpline(self.nodes, solution, bc_type=ends)(x, derivative))
