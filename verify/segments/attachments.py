"""Bodies and springs on a chain, and weights of joint positions and link rotations for them, forces and couples.

Lever rule: kinematics of the rigid link, order 2 for a force, 1 for a couple. Reciprocal rule: weights L_j + L_j''/12
(cubic Lagrange polynomials) of the four nearest joints for loads and readings, order 4 at a distance. The weights of an
attachment are corrected for its compliance at its own position (`docs/theory.md`, "Finite segments"). At an end a body
is behind an elastic joint.
"""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from functools import cached_property
from math import ceil, floor
from typing import Any, NamedTuple

import numpy as np

from verify.arrays import Array, BoolArray, Indices, Sparse
from verify.linear.factored import sparse_rows
from verify.problem.beam import Beam
from verify.problem.supports import FIXED
from verify.segments.chain import Chain, Motions, selection

_BEFORE, _AFTER = 2, 4
"""Numbers of joints before and after the start of an attachment's link whose weights are corrected."""
_FEWEST = 6
_WALL = 5  # largest number of joints with a wall correction
_SHORTEST = 8  # smallest number of links with corrected weights
_UNEQUAL = 0.05
"""Relative difference of neighbouring links above which weights are not corrected: such chains are of order 2."""
_PARABOLA = (0, 1, 2)
_POWERS = {"pinned": (1, 3), "free": (1, 2), "guided": (0, 2)}
"""Powers of the distance from an end in the moments due to distant loads."""
_FOUR_JOINTS = np.array([[-2, 6, -6, 2], [12, -30, 24, -6], [-23, 39, -21, 5], [14, -5, 4, -1]]) / 12.0
"""L_j + L_j''/12 of four joints (columns), L_j cubic Lagrange polynomials: coefficients of s^3, s^2, s, 1 (rows)."""
_ROUNDING = 1e-10  # Relative singular value below which the alignment is rounding, as of bodies exactly a link apart


def link_at(chain: Chain, positions: Array) -> tuple[Indices, Array]:
    """(link indices, 0 to 1 along them) of positions (m), both (p,); a position within rounding of a joint is on it."""
    nodes, n = chain.nodes / chain.unit, chain.n_segments
    places = np.clip(positions / chain.unit, nodes[0], nodes[-1])
    links = np.clip(np.searchsorted(nodes, places + 1e-9, side="right") - 1, 0, n - 1)
    along = (places - nodes[links]) / chain.lengths[links]
    along = np.where(abs(nodes[links + 1] - places) < 1e-9, 1.0, along)
    return links, np.where(abs(places - nodes[links]) < 1e-9, 0.0, along)


def joint_weights(chain: Chain, positions: Array, rule: str) -> Sparse:
    """Weights of joints 0..N for a force or a reading at positions (m), sparse (p, N + 1); assumes equal links.

    The chain continues by odd reflection at a pinned end and by even reflection at a guided one; at free and clamped
    ends the four joints move inward.
    """
    (links, s), n = link_at(chain, positions), chain.n_segments
    if rule == "lever" or n < 3:
        columns, weights = links[:, None] + np.arange(2), np.stack([1.0 - s, s], axis=1)
    else:
        reflects = [FIXED[support] in (FIXED["pinned"], FIXED["guided"]) for support in chain.supports]
        first = np.clip(links - 1, -int(reflects[0]), n - 3 + reflects[1])
        s = s + links - first
        columns, weights = first[:, None] + np.arange(4), np.vander(s, 4) @ _FOUR_JOINTS
        left, right = (-1.0 if support == "pinned" else 1.0 for support in chain.supports)
        weights = weights * np.where(columns < 0, left, np.where(columns > n, right, 1.0))
        columns = np.where(columns > n, 2 * n - columns, abs(columns))
    return sparse_rows(columns, weights, n + 1)


def rotation_weights(chain: Chain, positions: Array, rule: str) -> Sparse:
    """Weights of link rotations for a couple or a reading at positions (m), sparse (p, N), without end correction.

    Lever rule: the link, at a joint the mean of both links. Reciprocal rule: linear between the links' middles in the
    bending compliance between them, so that a couple at a step of the beam bends the joint there as it bends the beam.
    """
    n = chain.n_segments
    if rule == "lever" or n < 3:
        links, s = link_at(chain, positions)
        before, share = np.maximum(links - (s == 0.0), 0), np.where(s == 0.0, 0.5, 1.0)
    else:
        middles = chain.nodes[1:] - 0.5 * chain.lengths * chain.unit
        links = np.clip(np.searchsorted(middles, positions), 1, n - 1)
        before = links - 1
        share = np.clip((positions - middles[before]) / (middles[links] - middles[before]), 0.0, 1.0)
        if chain.flexibilities is not None:
            left, right = chain.flexibilities[before], chain.flexibilities[links]
            past = (positions - chain.nodes[links]) / (chain.unit * 0.5)  # the joint, in half lengths of a link
            past = np.clip(past / np.where(past < 0.0, chain.lengths[before], chain.lengths[links]), -1.0, 1.0)
            share = (left + past * np.where(past < 0.0, left, right)) / (left + right)
    return sparse_rows(np.stack([before, links], axis=1), np.stack([1.0 - share, share], axis=1), n)


def attachment_weights(chain: Chain, positions: Sequence[float], rule: str) -> tuple[Sparse, Sparse]:
    """Weights of joint positions, sparse (p, N + 1), and link rotations, (p, N), for attachments at distinct positions.

    The reciprocal rule reproduces the self and mutual compliances of attachments on the beam, except between unequal
    links and on short chains. An attachment at a free end has the weights of the end joint.
    """
    from scipy.sparse import csr_array

    at = np.array(positions, dtype=float)
    across, rotations = joint_weights(chain, at, rule), rotation_weights(chain, at, rule)
    if rule == "lever" or chain.n_segments < 3 or not len(at):
        return across, rotations
    n, (links, along) = chain.n_segments, link_at(chain, at)
    places, lateral, turned = links + along, across.toarray(), rotations.toarray()
    for end, support in zip((0, n), chain.supports, strict=True):
        if support == "free":
            lateral[places == end] = np.eye(1, n + 1, end)
    if n >= _SHORTEST and not chain.start:
        for rows in _groups(chain, places):
            _correct(chain, places[rows], rows, lateral, turned)
    return csr_array(lateral), csr_array(turned)


def _groups(chain: Chain, places: Array) -> Iterator[list[int]]:
    """Row groups of attachments with overlapping corrections, without those at ends, from left to right.

    An attachment at a joint counts on both links, so that distances from either end agree.
    """
    n = chain.n_segments
    ends = [end for end, support in zip((0, n), chain.supports, strict=True) if support != "guided"]
    group, last = list[int](), (0, 0)
    for row in np.argsort(places, kind="stable"):
        place = places[row]
        if place in ends:
            continue
        link = min(floor(place), n - 1), max(ceil(place) - 1, 0)
        if group and min(link[0] - last[0], link[1] - last[1]) >= _BEFORE + _AFTER:
            yield group
            group = []
        group.append(int(row))
        last = link
    if group:
        yield group


def _correct(chain: Chain, places: Array, rows: list[int], lateral: Array, turned: Array) -> None:
    """Correct rows of the weights (p, N + 1), (p, N) in place; positions count in links from the nearer end.

    The joint moments m due to a unit force (M = x' - x, x' > x) or couple (M = 1) satisfy sum c_k m_k q(k) = integral
    M q for moments q of distant loads, and sum c_k m_k n_k = integral M N for loads of the group. The m nearest to
    those of the uncorrected weights solve an orthogonal Procrustes problem (Schoenemann, Psychometrika 31 (1966)).
    """
    n, count, from_right = chain.n_segments, len(places), bool(places.mean() > 0.5 * chain.n_segments)
    if from_right:  # as in the mirror image
        places, rows = places[::-1], rows[::-1]
    order, from_end = (-1, n - places) if from_right else (1, places)
    support, elastic = chain.supports[from_right], chain.elastic[from_right]
    start = int(from_end.min()) - _BEFORE
    first = max(start, 0 if FIXED[support].rotation and not elastic else 1)
    beyond = max(int(from_end.max()) + _AFTER, first + max(_FEWEST, 3 + 2 * count))
    if beyond > n - 3:
        return
    lengths, compliances = chain.lengths[::order][max(first - 1, 0) : beyond + 1], chain.compliances[::order]
    weights = compliances[first:beyond] / compliances[beyond]
    inside = weights[max(_WALL - first, 0) :]
    if np.ptp(lengths) > _UNEQUAL * lengths.max() or (abs(inside - 1.0) > _UNEQUAL).any():
        return
    at_end = first <= 1 and start <= first
    origin = 0 if at_end else first
    powers = np.array(_PARABOLA if not at_end or elastic else _POWERS.get(support, _PARABOLA))
    joints, edge, x = np.arange(first, beyond) - float(origin), float(beyond - origin), from_end - origin
    roots, before = np.sqrt(weights)[:, None], int(first > 0)
    columns = slice(first - before, beyond + 1)
    # joint moments of the uncorrected weights
    forces, couples = lateral[rows][:, ::order], turned[rows][:, ::order]
    ahead = np.arange(first, n + 1)[:, None] - np.arange(first, beyond)
    of_forces = joints[:, None] - x + (forces[:, first:] @ np.maximum(ahead, 0)).T
    uncorrected = roots * np.hstack([of_forces, 1.0 - (couples[:, first:] @ (ahead[:-1] >= 0)).T])
    # least moments exact for distant loads, and the remainder exact for mutual compliances
    basis, triangle = np.linalg.qr(roots * joints[:, None] ** powers, mode="complete")
    far = len(powers)
    least = basis[:, :far] @ np.linalg.solve(triangle[:far].T, _far_integrals(x, edge, powers[:, None]))
    values, vectors = np.linalg.eigh(_mutual_integrals(edge - x) - least.T @ least)
    lacking = (vectors * np.sqrt(np.maximum(values, 0.0))) @ vectors.T
    aligned = basis[:, far:].T @ uncorrected @ lacking
    moments = (least + basis[:, far:] @ _rotation(aligned) @ lacking) / roots
    # weights from the changes of link forces and of moments
    every = np.zeros((2 * count, before + beyond - first + 2))
    every[:, before:-2] = moments.T
    every[:count, -2:] = np.arange(2.0) + edge - x[:, None]
    every[count:, -2:] = 1.0
    changes = np.diff(every)
    forces, couples = np.zeros_like(forces), np.zeros_like(couples)
    forces[:, columns] = np.diff(changes[:count], prepend=0.0)
    couples[:, columns.start : columns.stop - 1] = changes[count:, :-1]
    lateral[rows], turned[rows] = forces[:, ::order], couples[:, ::order]


def _rotation(aligned: Array) -> Array:
    """Orthonormal columns nearest to `aligned`, where it has no direction nearest to the leading unit vectors."""
    left, sizes, right = np.linalg.svd(aligned)
    rank = int((sizes > _ROUNDING * sizes[0]).sum())
    null, _, other = np.linalg.svd(left[: right.shape[0], rank:].T @ right[rank:].T, full_matrices=False)
    rotation: Array = left[:, :rank] @ right[:rank] + left[:, rank:] @ null @ other @ right[rank:]
    return rotation


def _far_integrals(x: Array, edge: float, p: Array) -> Array:
    """Integrals of M s^p less the joint sums from `edge` on, (powers, 2 n), for n forces, then n couples at x.

    The joint sums are Euler-Maclaurin sums, exact up to p = 4.
    """

    def joints(p: Array) -> Array:
        return 0.5 * edge**p - p * edge ** (p - 1) / 12.0 + p * (p - 1) * (p - 2) * edge ** (p - 3) / 720.0

    p = p.astype(float)
    couples = (edge ** (p + 1) - x ** (p + 1)) / (p + 1)
    forces = (edge ** (p + 2) - x ** (p + 2)) / (p + 2) - x * couples
    return np.hstack([forces - joints(p + 1) + x * joints(p), couples - joints(p)])


def _mutual_integrals(to_edge: Array) -> Array:
    """Integrals of M N less the joint sums from the edge on, (2 n, 2 n): n forces, n couples at `to_edge` before it."""
    row, column = to_edge[:, None], to_edge
    cut, product, total = np.minimum(row, column), row * column, row + column
    forces = product * cut - total * cut**2 / 2.0 + cut**3 / 3.0 - product / 2.0 + total / 12.0
    mixed = row * cut - cut**2 / 2.0 - row / 2.0 + 1.0 / 12.0 + 0.0 * column
    return np.block([[forces, mixed], [mixed.T, cut - 0.5]])


class Body(NamedTuple):
    """Sum of the attachments at one position (m), dimensionless."""

    position: float
    end: int | None = None  # the end, 0 or 1, behind whose joint the body is
    mass: float = 0.0
    rotary_inertia: float = 0.0
    stiffness: float = 0.0
    rotational: float = 0.0


@dataclass(frozen=True, eq=False)
class Attached:
    """Attachments of a beam in lengths of `unit` (m), with `rule` "reciprocal" or "lever"."""

    beam: Beam
    unit: float
    rule: str

    @cached_property
    def bodies(self) -> tuple[Body, ...]:
        """Attached masses and springs, summed at equal positions."""
        mass, stiffness = self.beam.mass_per_length * self.unit, self.beam.bending_stiffness / self.unit**3
        square, bodies = self.unit**2, dict[float, Body]()
        units, ends = (mass, mass * square, stiffness, stiffness * square), {0.0: 0, self.beam.length: 1}
        for attachment in self.beam.attached:
            body = bodies.get(at := attachment.position, Body(at, ends.get(at) if self.rule != "lever" else None))
            values = (attachment.mass, attachment.rotary_inertia, attachment.stiffness, attachment.rotational)
            sums = (a + value / size for a, value, size in zip(body[2:], values, units, strict=True))
            bodies[at] = Body(*body[:2], *sums)
        return tuple(bodies.values())

    @cached_property
    def at_ends(self) -> tuple[Body, Body]:
        """Bodies behind the joints of the left and the right end."""
        left, right = (next((b for b in self.bodies if b.end == end), Body(0.0)) for end in (0, 1))
        return left, right

    @property
    def elastic(self) -> tuple[bool, bool]:
        """Whether each end has an elastic joint, with a rotational spring or a rotary inertia behind it."""
        left, right = (body.rotational + body.rotary_inertia > 0.0 for body in self.at_ends)
        return left, right

    @property
    def end_springs(self) -> Array:
        """Compliances of rotational springs in series with an end joint (no inertia between them), (2,)."""
        return np.array([b.rotational and not b.rotary_inertia and 1.0 / b.rotational for b in self.at_ends], float)

    @property
    def massive(self) -> BoolArray:
        """Whether each body has a mass, (bodies,)."""
        return np.array([body.mass > 0.0 for body in self.bodies], dtype=bool)

    def rotations(self, weights: Sparse, motions: Motions) -> Sparse:
        """Rotations of the bodies as rows over (link rotations, unknowns), sparse (bodies, N + n)."""
        from scipy.sparse import diags_array, hstack

        beyond = np.array([body.end is not None and self.elastic[body.end] for body in self.bodies], dtype=bool)
        at = np.flatnonzero(beyond)
        ends = selection(at, [self.bodies[i].end for i in at], (len(beyond), 2))
        return hstack([diags_array(1.0 - beyond) @ weights, ends @ motions.end_rotations], format="csr")

    def deflections(self, weights: Sparse, motions: Motions, compliances: Array) -> Sparse:
        """Deflections of the bodies including slip (compliances `compliances`, (bodies,)), sparse (bodies, n)."""
        slipping = np.flatnonzero((compliances > 0.0) & self.massive)
        slip = selection(slipping, np.arange(len(slipping)), (len(compliances), len(slipping))) @ motions.body_slips
        return weights @ motions.positions + slip

    def energies(
        self, deflections: Sparse, rotations: Sparse, motions: Motions, compliances: Array
    ) -> tuple[list[Any], Any]:
        """(strain rows over (link rotations, unknowns) with stiffnesses, rows R with R^T R the mass of the bodies).

        A massless spring is in series with its slip, at an end with the joint, so that no unknown is massless.
        """
        from scipy.sparse import diags_array, hstack, vstack

        masses, rotary, lateral, rotational = np.array([body[2:] for body in self.bodies]).T
        lateral = lateral / (1.0 + lateral * np.where(self.massive, 0.0, compliances))
        rotational[[b.end is not None and self.end_springs[b.end] > 0.0 for b in self.bodies]] = 0.0
        across = hstack([selection([], [], (len(masses), motions.chain.n_segments)), deflections], format="csr")
        strains = [(across[lateral > 0.0], lateral[lateral > 0.0])]
        strains.append((rotations[rotational > 0.0], rotational[rotational > 0.0]))
        rows = [diags_array(np.sqrt(masses)) @ deflections, diags_array(np.sqrt(rotary)) @ rotations @ motions.both]
        return strains, vstack(rows, format="csr")
