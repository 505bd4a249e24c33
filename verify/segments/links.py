"""The chain of rigid links itself: links, joints, walls, and what it does in small motion about straight.

Unknowns are the transverse positions of the joints, which keep the mass matrix well conditioned. Inside, a
length is measured in mean link lengths, a stiffness and a mass in those of the beam, so that equal links have
length 1 exactly.

What a chain carries beside its links (axial force, foundation, bodies, springs, slipping joints) `loaded` adds.
"""

from typing import Any

import msgspec
import numpy as np

from verify.arrays import Array
from verify.linear.inverse import first_bending
from verify.linear.mesh import Parts
from verify.problem.beam import Beam

FIELD = "n_segments"


class Body(msgspec.Struct, frozen=True, kw_only=True):
    """A point mass or spring on a chain, in the chain's units but for its place."""

    position: float
    """Metres."""
    mass: float = 0.0
    rotary_inertia: float = 0.0
    stiffness: float = 0.0
    rotational: float = 0.0
    give: float = 0.0
    """Compliance of the slip that a mass stands on where joints slip (`attached`)."""


class Chain(msgspec.Struct, frozen=True, eq=False, kw_only=True):
    """A straight chain of N links in units of a mean link length and of the beam's EI and rho A."""

    supports: tuple[str, str]
    rigid_motions: int
    """0, 1 or 2."""
    unit: float
    """Metres: the unit of length."""
    start: float
    """Where the first joint stands, in units from the left end: 0, or 1/2 behind a welded half segment."""
    lengths: Array
    """(N,), link lengths."""
    compliances: Array
    """(N + 1,), 1/k of each joint; infinite where an end has none (pinned, free)."""
    masses: Array
    """(N,)."""
    inertias: Array
    """(N,), about each link's middle."""
    stiffnesses: Array | None = None
    """(N,), EI of the links; None: one everywhere."""
    tension: float = 0.0
    """Negative compresses."""
    foundation: float = 0.0
    bodies: tuple[Body, ...] = ()
    """Where they are felt is `attached`'s matter, by the rule `attachment`."""
    attachment: str = "reciprocal"
    elastic: tuple[bool, bool] = (False, False)
    """Whether the left and the right end turn in a joint of their own, with a spring or a body beyond it."""
    end_inertias: tuple[float, float] = (0.0, 0.0)
    """Rotary inertias beyond those joints."""
    end_springs: tuple[float, float] = (0.0, 0.0)
    """Rotational springs beyond those joints that hold such a body."""
    end_compliances: tuple[float, float] = (0.0, 0.0)
    """Of rotational springs beyond those joints that hold none: part of the joint's compliance."""
    end_joints: tuple[float, float] | None = None
    """Compliances of the end joints without those springs, of which soft ones leave no digit; None: `compliances`."""
    edges: Array | None = None
    """(N + 1,), on the corrections of the joints' reading where ends are elastic (`walls`); None: one everywhere."""
    slips: Array | None = None
    """(N + 1,), compliances of the joints against slipping, infinite where an end has none; None: nothing slips."""
    shears: Array | None = None
    """(N,), kappa G A of the links; None: nothing slips."""
    softness: Array | None = None
    """(N + 1,), what they would be inside: of the length of beam that each stands for."""
    joint_inertias: Array | None = None
    """(N + 1,), taken off the links' thickness inertia where a tensioned joint bends; None: nothing."""
    weights: Array | None = None
    """(N + 1,), compliances of the joints that slip over what they would be inside (`walls`); None: nothing slips."""
    slip_masses: Array | None = None
    """(N + 1,), taken off the links' mass where a tensioned joint slips; None: nothing."""
    eased: Array | None = None
    """(N + 1,), the joints' own stiffness over that of the beam alone; None: one everywhere."""
    lines: tuple[tuple[float, float], ...] = ()
    """Of a chain that is not plain: the rigid motions a + b x that nothing resists, metres."""

    @property
    def plain(self) -> bool:
        """Whether there is nothing but links, joints and walls."""
        taken = self.slips is not None or self.joint_inertias is not None
        return not (self.tension or self.foundation or self.bodies or taken)

    @property
    def n_segments(self) -> int:
        """N."""
        return len(self.lengths)

    @property
    def held(self) -> tuple[bool, bool]:
        """Whether the left and the right end keep their transverse position."""
        left, right = (support in ("pinned", "clamped") for support in self.supports)
        return left, right

    @property
    def walls(self) -> tuple[bool, bool]:
        """Whether the left and the right end keep their slope, through a joint at the wall."""
        left, right = (support in ("clamped", "guided") for support in self.supports)
        return left, right

    @property
    def jointed(self) -> tuple[bool, bool]:
        """Whether the left and the right end have a joint that bends: at a wall, or with an elastic support beyond."""
        left, right = (wall or elastic for wall, elastic in zip(self.walls, self.elastic, strict=True))
        return left, right

    @property
    def own_compliances(self) -> Array:
        """1/k of each joint without a spring beyond it, (N + 1,)."""
        found = self.compliances.copy()
        if self.end_joints is not None:
            found[[0, -1]] = self.end_joints
        return found

    @property
    def first_bending(self) -> float:
        """About the lowest omega^2 of what bends it, in its units (`FactoredPencil`)."""
        stiffnesses = 1.0 if self.stiffnesses is None else self.stiffnesses
        return first_bending(self.lengths, stiffnesses, self.masses / self.lengths, self.tension)

    @property
    def lifted(self) -> float:
        """What ground lifts every omega^2 above, in its units; 0 where bodies or a push may take one down again.

        What is left is as large as what bends, for a motion that it bears may be rigid, and a million roundings of it.
        """
        if (
            self.tension < 0.0
            or any(body.mass or body.rotary_inertia for body in self.bodies)
            or any(self.end_inertias)
        ):
            return 0.0
        squares = np.minimum(self.lengths / self.masses, self.lengths**3 / (12.0 * self.inertias))
        found = self.foundation * float(squares.min())
        return max(found - max(1e-10 * found, self.first_bending), 0.0)

    @property
    def nodes(self) -> Array:
        """Joint positions, (N + 1,), metres."""
        steps = np.concatenate([[self.start], self.lengths])
        return np.asarray(np.cumsum(steps) * self.unit)


def joint_compliance(length_i: Any, stiffness_i: Any, length_j: Any, stiffness_j: Any) -> Any:
    """1/k of the joint between links i and j: two half links in series, l_i/(2 E_i I_i) + l_j/(2 E_j I_j).

    k = 2 E_i I_i E_j I_j / (E_i I_i l_j + E_j I_j l_i), the paper's Eq. (1) with its indices put right.
    """
    return length_i / (2.0 * stiffness_i) + length_j / (2.0 * stiffness_j)


def printed_compliance(parts: Parts) -> Array:
    """1/k of the inner joints by Eq. (1) as the paper prints it, (N - 1,).

    k = 2 E_i E_j I_i I_j / (E_i I_j l_j + E_j I_i l_i): right units, wrong pairing. It is no series connection
    where both E I and E / l differ, and drops the convergence to order 1 there.
    """
    e, i, length = parts.moduli, parts.second_moments, parts.lengths
    return np.asarray(length[1:] / (2.0 * e[1:] * i[:-1]) + length[:-1] / (2.0 * e[:-1] * i[1:]))


def link_inertia(mass: Any, length: Any) -> Any:
    """M l^2 / 12: a uniform thin link about its middle."""
    return mass * length**2 / 12.0


def series_compliances(parts: Parts, stiffness: Array, joints: str) -> Array:
    """1/k of joints 0..N, (N + 1,), an end joint as if the end link went on beyond it."""
    lengths = parts.lengths
    if joints == "printed":
        inner = printed_compliance(parts)
    else:
        inner = joint_compliance(lengths[:-1], stiffness[:-1], lengths[1:], stiffness[1:])
    # the factors of the walls say how much of an end joint is there
    return np.concatenate([[lengths[0] / stiffness[0]], inner, [lengths[-1] / stiffness[-1]]])


def elastic_ends(beam: Beam, attachment: str) -> tuple[bool, bool]:
    """Whether a rotational spring or a rotary inertia stands at the left and the right end, beyond its end joint."""
    if attachment == "lever":
        return (False, False)
    turned = {s.position for s in beam.spring if s.rotational} | {m.position for m in beam.mass if m.rotary_inertia}
    return (0.0 in turned, beam.length in turned)


def rigid_shapes(chain: Chain) -> Array:
    """The motions without strain that the supports leave, over the free joint positions, (n, 0 to 2)."""
    x = np.concatenate([[0.0], np.cumsum(chain.lengths)])
    left, right = chain.held
    centre = x[0] if left else x[-1] if right else 0.5 * x[-1]
    shapes = [np.ones_like(x)] * (not left and not right)
    shapes += [x - centre] * (chain.rigid_motions > len(shapes))
    return np.array(shapes).reshape(len(shapes), len(x)).T[free_joints(chain)]


def joint_angles(chain: Chain, free: Array) -> Array:
    """Relative angles at the joints, wall joints included, (m, k): differences of link slopes, nearly exact."""
    slopes = np.diff(with_ends(chain, free), axis=0) / chain.lengths[:, None]
    return np.diff(_between_zeros(slopes, *chain.walls), axis=0)


def strain_matrix(chain: Chain) -> Any:
    """B of `joint_angles` as a sparse array (m, n)."""
    from scipy.sparse import diags_array

    n = chain.n_segments
    slopes = diags_array([-1.0 / chain.lengths, 1.0 / chain.lengths], offsets=[0, 1], shape=(n, n + 1)).tocsc()
    joints = diags_array([np.ones(n), -np.ones(n)], offsets=[0, -1], shape=(n + 1, n)).tocsr()
    left, right = chain.walls
    rows = slice(0 if left else 1, n + 1 if right else n)
    return joints[rows] @ slopes[:, free_joints(chain)]


def free_joints(chain: Chain) -> slice:
    """Which of joints 0..N the supports leave free."""
    left, right = chain.held
    return slice(int(left), chain.n_segments + 1 - int(right))


def joint_masses(masses: Array, inertias: Array, lengths: Array) -> tuple[Array, Array]:
    """Mass of links over the positions of joints 0..N, tridiagonal: diagonal (N + 1,) and beside it (N,).

    Each link has m/4 (y_i + y_j)^2 + J/l^2 (y_j - y_i)^2, halved.
    """
    spin = inertias / lengths**2
    own, shared = masses / 4.0 + spin, masses / 4.0 - spin
    return np.append(own, 0.0) + np.append(0.0, own), shared


def mass_matrix(chain: Chain, *, dense: bool = False) -> Any:
    """M over the free joint positions, tridiagonal (`joint_masses`)."""
    diagonal, shared = joint_masses(chain.masses, chain.inertias, chain.lengths)
    free = free_joints(chain)
    diagonal, off = diagonal[free], shared[free.start : free.stop - 1]
    if dense:
        return np.diag(diagonal) + np.diag(off, 1) + np.diag(off, -1)
    from scipy.sparse import diags_array

    return diags_array([off, diagonal, off], offsets=[-1, 0, 1]).tocsc()


def with_ends(chain: Chain, free: Any) -> Any:
    """Positions of all joints, (N + 1, k): the unknowns with zeros at held ends."""
    return _between_zeros(free, *chain.held)


def _between_zeros(rows: Any, left: bool, right: bool) -> Any:
    """`rows` with a row of zeros before and after where asked (np.pad costs more than the whole product)."""
    padded = np.zeros((len(rows) + left + right, rows.shape[1]), dtype=rows.dtype)
    padded[int(left) : len(padded) - right] = rows
    return padded


def plain_curvatures(chain: Chain, joints: Array) -> Array:
    """Curvature of the beam at every joint from the joint's moment over EI there, (k, N + 1), 1/m of `joints`.

    The joint's angle over its compliance is the moment; over the EI of the link that follows (`right_of`) it is the
    curvature. Zero at ends without a joint.
    """
    angles = np.zeros_like(joints)
    slopes = np.diff(joints, axis=1) / chain.lengths
    angles[:, 1:-1] = np.diff(slopes, axis=1)
    left, right = chain.walls
    angles[:, 0] = slopes[:, 0] * left
    angles[:, -1] = -slopes[:, -1] * right
    return np.asarray(angles / (chain.compliances * stiffness_at_joints(chain)) / chain.unit**2)


def stiffness_at_joints(chain: Chain) -> Array:
    """EI at joints 0..N, (N + 1,)."""
    return right_of(np.ones(chain.n_segments) if chain.stiffnesses is None else chain.stiffnesses)


def right_of(links: Array) -> Array:
    """A figure of the links (N,) at joints 0..N, (N + 1,): on a step that of the right one, at the end of the last."""
    return np.append(links, links[-1])
