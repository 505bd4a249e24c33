"""A straight chain of rigid links: its geometry, compliances and masses, and the maps of its small motions.

Lengths are in mean link lengths, stiffnesses and masses in those of the beam: equal links have length 1 exactly.
"""

from collections.abc import Sequence
from dataclasses import dataclass, field
from functools import cached_property
from typing import Any

import numpy as np

from verify.arrays import Array, Indices
from verify.linear.factored import sparse_rows
from verify.problem.supports import FIXED


@dataclass(frozen=True, eq=False, kw_only=True)
class Chain:
    """N rigid links and N + 1 joints, of which those at pinned and free ends have no spring."""

    supports: tuple[str, str]
    unit: float
    """Unit of length, m."""
    lengths: Array
    """(N,), of the links."""
    compliances: Array
    """(N + 1,), 1/k of joints 0..N; infinite without a spring."""
    masses: Array
    """(N,)."""
    inertias: Array
    """(N,), about the middle of each link."""
    start: float = 0.0
    """Position of joint 0: 1/2 behind a half segment that is welded to the wall."""
    elastic: tuple[bool, bool] = (False, False)
    """Ends that rotate in a joint of their own, with a spring or a body beyond it."""
    reading_factors: Array | None = None
    """(N + 1,), on the corrections of the joints' reading beside elastic ends (`walls`); None: all one."""

    @property
    def n_segments(self) -> int:
        """N."""
        return len(self.lengths)

    @cached_property
    def nodes(self) -> Array:
        """Positions of joints 0..N, (N + 1,), m."""
        return np.asarray(np.cumsum(np.append(self.start, self.lengths)) * self.unit)

    @property
    def held(self) -> tuple[bool, bool]:
        """Ends without deflection."""
        return FIXED[self.supports[0]].deflection, FIXED[self.supports[1]].deflection

    @property
    def walls(self) -> tuple[bool, bool]:
        """Ends without rotation, which have a joint at the wall."""
        return FIXED[self.supports[0]].rotation, FIXED[self.supports[1]].rotation

    @property
    def spans(self) -> Array:
        """Length of beam that each joint represents, the whole end link's at an end, (N + 1,)."""
        return at_joints(self.lengths)


def link_inertia(mass: Any, length: Any) -> Any:
    """M l^2 / 12: a uniform thin link about its middle."""
    return mass * length**2 / 12.0


def at_joints(links: Array) -> Array:
    """Means of a property (N,) of adjoining links at joints 0..N, (N + 1,); the end link's at an end."""
    return np.concatenate([links[:1], 0.5 * (links[1:] + links[:-1]), links[-1:]])


def right_of(links: Array) -> Array:
    """A property (N,) of the links at joints 0..N, (N + 1,): on a step the right one, at the end the last."""
    return np.append(links, links[-1])


def joint_masses(masses: Array, inertias: Array, lengths: Array) -> tuple[Array, Array]:
    """Mass of links over the positions of joints 0..N, tridiagonal: diagonal (N + 1,) and off-diagonal (N,).

    The kinetic energy of a link is half of m/4 (y_i + y_j)^2 + J/l^2 (y_j - y_i)^2.
    """
    spin = inertias / lengths**2
    own, shared = masses / 4.0 + spin, masses / 4.0 - spin
    return np.append(own, 0.0) + np.append(0.0, own), shared


def banded(shape: tuple[int, int], offset: int, *diagonals: Any) -> Any:
    """Sparse by rows: row i has the i-th value of each diagonal in columns i + offset, i + offset + 1, ...

    Columns outside the shape are dropped.
    """
    columns = np.arange(shape[0])[:, None] + np.arange(offset, offset + len(diagonals))
    return sparse_rows(columns, np.stack([np.broadcast_to(d, shape[0]) for d in diagonals], axis=1), shape[1])


def selection(rows: Any, columns: Any, shape: tuple[int, int], values: Any = 1.0) -> Any:
    """Sparse with one value in each of the rows, which ascend."""
    from scipy.sparse import csr_array

    starts = np.searchsorted(rows, np.arange(shape[0] + 1))
    return csr_array((np.broadcast_to(values, np.shape(rows)).astype(float), columns, starts), shape)


def squares(rows: Any, weights: Array) -> Any:
    """R^T diag(weights) R of sparse rows (r, n)."""
    return rows.T @ banded((len(weights),) * 2, 0, weights) @ rows


@dataclass(frozen=True, eq=False)
class Motions:
    """Small motions of a chain, linear in its unknowns v.

    v: free joint positions, rotations of bodies beyond elastic ends, and slips over the root of their compliance, of
    joints and then of bodies. A joint that slips has the mean position of both links' ends there; at an end, its own.
    """

    chain: Chain
    rotating: Sequence[int] = ()
    """Ends (0, 1) with a body beyond their joint."""
    slips: Array = field(default_factory=lambda: np.zeros(0))
    """(N + 1,), compliances of the joints against slip, infinite without; empty where nothing slips."""
    gives: Array = field(default_factory=lambda: np.zeros(0))
    """(bodies that slip,), their compliances."""

    @property
    def free(self) -> Indices:
        """Joints whose positions are unknowns."""
        left, right = self.chain.held
        return np.arange(int(left), self.chain.n_segments + 1 - right)

    @property
    def sliding(self) -> Indices:
        """Joints that slip."""
        return np.flatnonzero(np.isfinite(self.slips))

    @property
    def n_slips(self) -> int:
        """Number of slips."""
        return len(self.sliding) + len(self.gives)

    @property
    def n(self) -> int:
        """Number of unknowns."""
        return len(self.free) + len(self.rotating) + self.n_slips

    @cached_property
    def positions(self) -> Any:
        """Of joints 0..N, sparse (N + 1, n)."""
        return selection(self.free, np.arange(len(self.free)), (self.chain.n_segments + 1, self.n))

    @cached_property
    def end_rotations(self) -> Any:
        """Beyond the end joints, sparse (2, n): zero where nothing rotates."""
        first = len(self.free)
        return selection(self.rotating, first + np.arange(len(self.rotating)), (2, self.n))

    @cached_property
    def joint_slips(self) -> Any:
        """The link after each joint above the link before, sparse (N + 1, n)."""
        first = len(self.free) + len(self.rotating)
        columns = first + np.arange(len(self.sliding))
        shape = (self.chain.n_segments + 1, self.n)
        return selection(self.sliding, columns, shape, np.sqrt(self.slips[self.sliding]))

    @cached_property
    def body_slips(self) -> Any:
        """Of bodies that slip, sparse (bodies, n)."""
        count = len(self.gives)
        return selection(np.arange(count), self.n - count + np.arange(count), (count, self.n), np.sqrt(self.gives))

    @cached_property
    def factors(self) -> tuple[Any, Any]:
        """Sparse factors v -> (differences of positions, v) -> (rotations of the links, v).

        The first takes plain differences, which are exact.
        """
        from scipy.sparse import block_array, vstack

        n, lengths, shares = self.chain.n_segments, self.chain.lengths, self._shares
        own = banded((self.n, self.n), 0, 1.0)
        slips = -banded((n, n + 1), 0, shares[:-1] / lengths, shares[1:] / lengths) @ self.joint_slips
        scale = block_array([[banded((n, n), 0, 1.0 / lengths), slips], [None, own]], format="csr")
        return vstack([banded((n, n + 1), 0, -1.0, 1.0) @ self.positions, own], format="csr"), scale

    @property
    def _shares(self) -> Array:
        """Part of a joint's slip on either side of its position, (N + 1,)."""
        shares = np.full(self.chain.n_segments + 1, 0.5)
        shares[[0, -1]] = 1.0
        return shares

    @cached_property
    def both(self) -> Any:
        """(rotations of the links, v) of v, sparse (N + n, n)."""
        return self.factors[1] @ self.factors[0]

    @property
    def rotations(self) -> Any:
        """Of the links, sparse (N, n)."""
        return self.both[: self.chain.n_segments]

    @cached_property
    def middles(self) -> Any:
        """Positions of the links' middles, sparse (N, n)."""
        n, shares = self.chain.n_segments, self._shares
        found = banded((n, n + 1), 0, 0.5, 0.5) @ self.positions
        return found + banded((n, n + 1), 0, 0.5 * shares[:-1], -0.5 * shares[1:]) @ self.joint_slips

    @cached_property
    def angles_of(self) -> Any:
        """Angles at joints 0..N of (rotations of the links, v), sparse (N + 1, N + n): to the body beyond at an end."""
        from scipy.sparse import hstack

        n = self.chain.n_segments
        ends = selection([0, n], [0, 1], (n + 1, 2), [-1.0, 1.0]) @ self.end_rotations
        return hstack([banded((n + 1, n), -1, -1.0, 1.0), ends], format="csr")


def link_mass(motions: Motions) -> Any:
    """Mass matrix of the links: their masses at their middles, and their inertias, sparse (n, n)."""
    chain, first, free = motions.chain, int(motions.chain.held[0]), len(motions.free)
    if len(motions.sliding):
        return squares(motions.middles, chain.masses) + squares(motions.rotations, chain.inertias)
    diagonal, off = joint_masses(chain.masses, chain.inertias, chain.lengths)
    # zero for the unknowns that are no positions
    values, beside = np.zeros(motions.n), np.zeros(motions.n + 1)
    values[:free], beside[1:free] = diagonal[first : first + free], off[first : first + free - 1]
    return banded((motions.n, motions.n), -1, beside[:-1], values, beside[1:]).T


def plain_factors(chain: Chain) -> tuple[Any, Any]:
    """Sparse factors v -> differences of positions -> angles of joints, of a chain with nothing but links and joints.

    Those of `Motions` put together at once, which takes a tenth of the time.
    """
    n, (left, right) = chain.n_segments, chain.held
    first, last = (int(not wall) for wall in chain.walls)
    differences = banded((n, n + 1 - left - right), -int(left), -1.0, 1.0)
    turns = np.concatenate([[0.0], 1.0 / chain.lengths, [0.0]])[first : n + 2 - last]
    return differences, banded((len(turns) - 1, n), first - 1, -turns[:-1], turns[1:])
