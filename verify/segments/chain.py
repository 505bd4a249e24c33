"""A straight chain of rigid links: geometry, compliances, masses, and linear maps of its small motions.

Lengths are in mean link lengths (equal links have length 1 exactly), stiffnesses and masses in those of the beam.
"""

from collections.abc import Sequence
from dataclasses import dataclass, field
from functools import cached_property
from typing import Any

import numpy as np

from verify.arrays import Array, Indices, Sparse
from verify.linear.factored import sparse_rows
from verify.problem.supports import FIXED


@dataclass(frozen=True, eq=False, kw_only=True)
class Chain:
    """N rigid links and N + 1 joints; joints at pinned and free ends have no spring."""

    supports: Sequence[str]
    unit: float  # unit of length, m
    lengths: Array  # (N,), lengths of the links
    compliances: Array  # (N + 1,), 1/k of joints 0..N; infinite without a spring
    masses: Array  # (N,)
    inertias: Array  # (N,), about the middle of each link
    start: float = 0.0  # position of joint 0: 1/2 with a half segment welded to the wall
    elastic: tuple[bool, bool] = (False, False)
    """Whether each end has an elastic joint, with a spring or a body behind it."""
    reading_factors: Array | None = None
    """(N + 1,), factors on the reading corrections near elastic ends (`walls`); None: all 1."""

    flexibilities: Array | None = None
    """(N,), l/EI of the links of a stepped beam; None where it is proportional to their lengths."""

    @property
    def n_segments(self) -> int:
        """N."""
        return len(self.lengths)

    @cached_property
    def nodes(self) -> Array:
        """Positions of joints 0..N, (N + 1,), m."""
        return np.asarray(np.cumsum(np.append(self.start, self.lengths)) * self.unit)

    @property
    def supported(self) -> tuple[bool, bool]:
        """Whether each end has no deflection."""
        return FIXED[self.supports[0]].deflection, FIXED[self.supports[1]].deflection

    @property
    def walls(self) -> tuple[bool, bool]:
        """Whether each end has no rotation, and a joint at the wall."""
        return FIXED[self.supports[0]].rotation, FIXED[self.supports[1]].rotation

    @property
    def spans(self) -> Array:
        """Length of beam that each joint represents, at an end that of the end link, (N + 1,)."""
        return at_joints(self.lengths)


def link_inertia(mass: Any, length: Any) -> Any:
    """M l^2 / 12: a uniform thin link about its middle."""
    return mass * length**2 / 12.0


def at_joints(links: Array) -> Array:
    """Mean of a property (N,) of the adjoining links at joints 0..N, (N + 1,); at an end that of the end link."""
    return np.concatenate([links[:1], 0.5 * (links[1:] + links[:-1]), links[-1:]])


def right_of(links: Array) -> Array:
    """A property (N,) of the link to the right of joints 0..N, (N + 1,); at the right end of the last link."""
    return np.append(links, links[-1])


def joint_masses(masses: Array, inertias: Array, lengths: Array) -> tuple[Array, Array]:
    """Mass matrix of links over the positions of joints 0..N: diagonal (N + 1,) and off-diagonal (N,).

    The kinetic energy of a link is half of m/4 (y_i + y_j)^2 + J/l^2 (y_j - y_i)^2.
    """
    spin = inertias / lengths**2
    diagonal, shared = masses / 4.0 + spin, masses / 4.0 - spin
    return np.append(diagonal, 0.0) + np.append(0.0, diagonal), shared


def banded(shape: tuple[int, int], offset: int, *diagonals: Any) -> Sparse:
    """Sparse matrix; row i has the i-th value of each diagonal in columns i + offset, i + offset + 1, ...

    Columns outside the shape are dropped.
    """
    columns = np.arange(shape[0])[:, None] + np.arange(offset, offset + len(diagonals))
    return sparse_rows(columns, np.stack([np.broadcast_to(d, shape[0]) for d in diagonals], axis=1), shape[1])


def selection(rows: Any, columns: Any, shape: tuple[int, int], values: Any = 1.0) -> Sparse:
    """Sparse matrix with one value in each of the ascending rows."""
    from scipy.sparse import csr_array

    starts = np.searchsorted(rows, np.arange(shape[0] + 1))
    return csr_array((np.broadcast_to(values, np.shape(rows)).astype(float), columns, starts), shape)


def squares(rows: Sparse, weights: Array) -> Sparse:
    """R^T diag(weights) R of sparse rows (r, n)."""
    return rows.T @ banded((len(weights),) * 2, 0, weights) @ rows


@dataclass(frozen=True, eq=False)
class Motions:
    """Small motions of a chain, linear in its unknowns v.

    v: free joint positions, rotations of bodies behind elastic ends, and slips of joints, then of bodies, over the root
    of their compliance. The position of a slipping joint is the mean of both link ends; at an end that of the link.
    """

    chain: Chain
    rotating: Sequence[int] = ()  # ends (0, 1) with a body behind their joint
    slips: Array = field(default_factory=lambda: np.zeros(0))
    """(N + 1,), slip compliances of the joints, infinite without slip; empty in theories without shear."""
    body_compliances: Array = field(default_factory=lambda: np.zeros(0))
    """(bodies that slip,), slip compliances of the bodies."""

    @property
    def free(self) -> Indices:
        """Indices of joints whose positions are unknowns."""
        left, right = self.chain.supported
        return np.arange(int(left), self.chain.n_segments + 1 - right)

    @property
    def sliding(self) -> Indices:
        """Indices of joints that slip."""
        return np.flatnonzero(np.isfinite(self.slips))

    @property
    def n_slips(self) -> int:
        """Number of slips."""
        return len(self.sliding) + len(self.body_compliances)

    @property
    def n(self) -> int:
        """Number of unknowns."""
        return len(self.free) + len(self.rotating) + self.n_slips

    @cached_property
    def positions(self) -> Sparse:
        """Positions of joints 0..N, sparse (N + 1, n)."""
        return selection(self.free, np.arange(len(self.free)), (self.chain.n_segments + 1, self.n))

    @cached_property
    def end_rotations(self) -> Sparse:
        """Rotations behind the end joints, sparse (2, n); zero without a body."""
        first = len(self.free)
        return selection(self.rotating, first + np.arange(len(self.rotating)), (2, self.n))

    @cached_property
    def joint_slips(self) -> Sparse:
        """Offset of the right link from the left link at each joint, sparse (N + 1, n)."""
        first = len(self.free) + len(self.rotating)
        columns = first + np.arange(len(self.sliding))
        shape = (self.chain.n_segments + 1, self.n)
        return selection(self.sliding, columns, shape, np.sqrt(self.slips[self.sliding]))

    @cached_property
    def body_slips(self) -> Sparse:
        """Slips of the bodies that slip, sparse (bodies, n)."""
        i, roots = np.arange(len(self.body_compliances)), np.sqrt(self.body_compliances)
        return selection(i, self.n - len(i) + i, (len(i), self.n), roots)

    @cached_property
    def factors(self) -> tuple[Sparse, Sparse]:
        """Sparse factors v -> (position differences, v) -> (link rotations, v).

        The first factor has entries 1 and -1: differences are exact.
        """
        from scipy.sparse import block_array, vstack

        n, lengths, shares = self.chain.n_segments, self.chain.lengths, self._shares
        identity = banded((self.n, self.n), 0, 1.0)
        slips = -banded((n, n + 1), 0, shares[:-1] / lengths, shares[1:] / lengths) @ self.joint_slips
        scale = block_array([[banded((n, n), 0, 1.0 / lengths), slips], [None, identity]], format="csr")
        return vstack([banded((n, n + 1), 0, -1.0, 1.0) @ self.positions, identity], format="csr"), scale

    @property
    def _shares(self) -> Array:
        """Fraction of a joint's slip on either side of its position, (N + 1,)."""
        shares = np.full(self.chain.n_segments + 1, 0.5)
        shares[[0, -1]] = 1.0
        return shares

    @cached_property
    def both(self) -> Sparse:
        """The map v -> (link rotations, v), sparse (N + n, n)."""
        return self.factors[1] @ self.factors[0]

    @property
    def rotations(self) -> Sparse:
        """Rotations of the links, sparse (N, n)."""
        return self.both[: self.chain.n_segments]

    @cached_property
    def middles(self) -> Sparse:
        """Positions of the links' middles, sparse (N, n)."""
        n, shares = self.chain.n_segments, self._shares
        middles = banded((n, n + 1), 0, 0.5, 0.5) @ self.positions
        return middles + banded((n, n + 1), 0, 0.5 * shares[:-1], -0.5 * shares[1:]) @ self.joint_slips

    @cached_property
    def angles_of(self) -> Sparse:
        """Joint angles 0..N as rows over (link rotations, v), sparse (N + 1, N + n); at an end to the body behind."""
        from scipy.sparse import hstack

        n = self.chain.n_segments
        ends = selection([0, n], [0, 1], (n + 1, 2), [-1.0, 1.0]) @ self.end_rotations
        return hstack([banded((n + 1, n), -1, -1.0, 1.0), ends], format="csr")


def link_mass(motions: Motions) -> Sparse:
    """Mass matrix of the links, masses at the middles and inertias, sparse (n, n)."""
    chain, first, free = motions.chain, int(motions.chain.supported[0]), len(motions.free)
    if len(motions.sliding):
        return squares(motions.middles, chain.masses) + squares(motions.rotations, chain.inertias)
    diagonal, off = joint_masses(chain.masses, chain.inertias, chain.lengths)
    # zero for unknowns that are not positions
    values, coupled = np.zeros(motions.n), np.zeros(motions.n + 1)
    values[:free], coupled[1:free] = diagonal[first : first + free], off[first : first + free - 1]
    return banded((motions.n, motions.n), -1, coupled[:-1], values, coupled[1:]).T


def plain_factors(chain: Chain) -> tuple[Sparse, Sparse]:
    """Sparse factors v -> position differences -> joint angles of a chain without attachments and slip.

    Equal to the product of the factors of `Motions`, in a tenth of the time.
    """
    n, (left, right) = chain.n_segments, chain.supported
    first, last = (int(not wall) for wall in chain.walls)
    differences = banded((n, n + 1 - left - right), -int(left), -1.0, 1.0)
    turns = np.concatenate([[0.0], 1.0 / chain.lengths, [0.0]])[first : n + 2 - last]
    return differences, banded((len(turns) - 1, n), first - 1, -turns[:-1], turns[1:])
