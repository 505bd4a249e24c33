"""A chain of the rigid pieces of a curve: joints with rest angles, and what its motions about rest are.

Joints lie on the curve and turn about the axes of the rod there. Between them are pieces of the curve: the frame of a
link has x along its chord, its centre of mass is off that. On either side a joint has the compliance of half a link by
EI and GJ at the joint; at the wall these are times Gregory's weights where the first three links have one length and no
step, in torsion only on a curve, where the twisting moment varies. For links of one length this is of order 4
(docs/theory.md, "Curved rods"), and at steps of order 2: half a link with a step inside has its integral of ds/EI.
Bodies carry the rest pose, so that all springs are at rest at zero angles, whatever a format calls the reference of a
spring.
"""

from dataclasses import dataclass, replace
from functools import lru_cache
from typing import Any

import numpy as np

from verify.arrays import Array
from verify.engines.description import AXES, Axis, Hinge, Joint, Link, RigidChain
from verify.engines.rod import Rod
from verify.errors import InputError
from verify.formatting import with_unit
from verify.problem.beam import Beam
from verify.segments.walls import wall_factors

ALIKE = 0.01
"""Relative difference of first links up to which they are alike: Gregory's joint is then off by 0.4 % of a link."""
AT = 1e-9
"""Distance over the length of the rod up to which a step is at a joint."""
BACK = -0.99
"""Cosine between links from which the axes of the joint between are uncertain."""
MOST = 1500
"""Unknowns of a chain of four parts a link; with more the error is by two parts alone: matrices are dense."""


@dataclass(frozen=True, eq=False, kw_only=True)
class CurvedChain(RigidChain):
    """A chain with joint j at `places`[j], (N + 1, 3), m, clamped at joint 0, else free.

    `frames` of links and `axes_at` the joints, of the rod there, (N, 3, 3). `rod` and `nodes`, arc length at the
    joints, m, are what it divides. In the world are masses, (N,), centres, (N, 3), and inertias about them, (N, 3, 3),
    of `bodies`; places, axes, (n, 3), and joints of `hinges`.
    """

    rod: Rod
    nodes: tuple[float, ...]
    parts: str
    places: Array
    frames: Array
    axes_at: Array
    bodies: tuple[Array, Array, Array]
    hinges: tuple[Array, Array, Array]

    straight, along, reference = False, "each link", "the rod, estimated by links in parts"

    @property
    def motions(self) -> tuple[Axis, ...]:
        """One, of all axes."""
        return ("coupled",) if self.in_space else AXES[:1]

    def unknowns(self, axis: Axis) -> list[tuple[str, int, float]]:
        """(name, joint, stiffness) of all hinges, joint by joint."""
        return [(f"joint{j}_{h.axis}", j, h.stiffness) for j, one in enumerate(self.joints[:-1]) for h in one.hinges]

    def constraints(self, axis: Axis) -> Array:
        """None: the far end is free."""
        return np.zeros((0, len(self.unknowns(axis))))

    def rest(self, j: int) -> tuple[Array, Array]:
        """(origin in the frame before, rotations from there to the joint's axes and on to the link, (2, 3, 3))."""
        axes, before = self.axes_at[j], self.frames[j - 1] if j else np.eye(3)
        place = np.array([self.links[j - 1].length, 0.0, 0.0]) if j else self.places[0]
        return place, np.stack([before.T @ axes, axes.T @ self.frames[j]])

    def drawn(self, j: int) -> tuple[float, float]:
        """Sides of a link, across and along `u`, m; where unknown a hundredth of the length, and as EI2 to EI."""
        ei, ei2, *_, width, thickness = self.rod.at(np.array([0.5 * (self.nodes[j] + self.nodes[j + 1])]))[0].tolist()
        thickness = thickness or 0.01 * self.beam.length
        return width or thickness * (ei2 / ei) ** 0.5, thickness

    def matrices(self, axis: Axis = "bending") -> tuple[Array, Array]:
        """(mass, stiffness) over all `unknowns`, (n, n), from the rest pose: its springs are without load."""
        (masses, _, inertias), (_, about, _) = self.bodies, self.hinges
        speeds, moved = self.speeds
        turns = about.T * moved[:, None]
        mass = np.tensordot(masses[:, None, None] * speeds, speeds, ((0, 1), (0, 1)))
        mass += np.tensordot(inertias @ turns, turns, ((0, 1), (0, 1)))
        return mass, np.diag([stiffness for *_, stiffness in self.unknowns(axis)])

    @property
    def speeds(self) -> tuple[Array, Array]:
        """(velocities of the bodies' centres by rates of the `unknowns`, (N, 3, n), 1 where they move them, (N, n))."""
        at, about, first = self.hinges
        moved = 1.0 * (first <= np.arange(self.count)[:, None])
        arms = np.cross(about, self.bodies[1][:, None] - at).transpose(0, 2, 1)
        return np.asarray(arms * moved[:, None]), np.asarray(moved)

    @property
    def on_chords(self) -> "CurvedChain":
        """The chain with centres of mass on its chords, order 2, as of straight links from joint to joint."""
        masses, centres, inertias = self.bodies
        starts, directions = self.places[:-1], self.frames[:, :, 0]
        centres = starts + np.einsum("ni,ni->n", centres - starts, directions)[:, None] * directions
        return replace(self, bodies=(masses, centres, inertias))

    def exact_hz(self, axis: Axis = "bending", n_modes: int = 3) -> Array:
        """Frequencies of the rod, estimated from links in two and in four parts, (n_modes,), Hz."""
        return rod_hz(self.rod, self.nodes, n_modes)


def curved_chain(rod: Rod, nodes: Array) -> CurvedChain:
    """The chain with joints at arc lengths `nodes`, (N + 1,), m, from 0 to the length. Raises InputError."""
    n, places, edges = len(nodes) - 1, rod.place(nodes), np.sort(np.append(nodes, 0.5 * (nodes[1:] + nodes[:-1])))
    chords, sections = np.diff(places, axis=0), rod.frames(edges)
    lengths, axes = np.linalg.norm(chords, axis=1), sections[:-1:2]
    directions = chords / lengths[:, None]
    if np.einsum("ni,ni->n", directions, np.vstack([axes[:1, :, 0], directions[:-1]])).min() < BACK:
        raise InputError("curve: two links point in opposite directions, give more links or points along the turn")
    across = np.cross(sections[1::2, :, 2], directions)
    across /= np.linalg.norm(across, axis=1)[:, None]
    frames = np.stack([directions, across, np.cross(directions, across)], axis=2)
    masses, centres, inertias = _bodies(rod, nodes, places, frames)
    soft, wall = _compliances(rod, edges)

    turning, (ei, mass) = AXES if rod.in_space else AXES[:1], rod.values[0, [0, 3]].tolist()
    springs, starts = np.append(1.0 / soft, np.zeros((1, 3)), axis=0), np.append(0.0, np.cumsum(lengths)).tolist()
    beam = Beam(length=starts[-1], supports=("clamped", "free"), bending_stiffness=ei, mass_per_length=mass)
    joints = tuple(Joint(x, tuple(map(Hinge, turning, k))) for x, k in zip(starts, springs.tolist(), strict=True))
    rows = zip(starts, lengths.tolist(), masses.tolist(), centres.tolist(), inertias.tolist(), strict=False)
    links = tuple(Link(x, length, m, at, tuple(own), tuple(off)) for x, length, m, (at, *off), own in rows)
    about = np.stack([-axes[:, :, 1], axes[:, :, 2], axes[:, :, 0]], axis=1)[:, : len(turning)]
    order, world = np.repeat(np.arange(n), len(turning)), np.einsum("nij,nj,nkj->nik", frames, inertias, frames)
    shape: dict[str, Any] = {"parts": _parts(rod, nodes), "nodes": tuple(nodes.tolist()), "places": places}
    shape |= {"frames": frames, "axes_at": axes, "hinges": (places[order], about.reshape(-1, 3), order)}
    shape |= {"bodies": (masses, places[:-1] + np.einsum("nij,nj->ni", frames, centres), world)}
    return CurvedChain(beam, wall, joints, links, in_space=rod.in_space, rod=rod, **shape)


def _parts(rod: Rod, nodes: Array) -> str:
    """What the links are, and the order of their errors."""
    why = "order 2 by a step of EI" if len(rod.jumps) else "order 4 where EI and mass are smooth"
    why += ", in twist order 2" * (rod.in_space and not len(rod.jumps))
    why = "order 2 by unequal lengths" if np.ptp(h := np.diff(nodes)) > ALIKE * h[0] else why
    return f"pieces of the curve of {with_unit(float(nodes[-1]), 'm')}, joints and ends on it, {why}"


def _bodies(rod: Rod, nodes: Array, places: Array, frames: Array) -> tuple[Array, Array, Array]:
    """Masses, (N,), centres from the joints and principal inertias of the pieces in their `frames`, (N, 3)."""
    s, weights = rod.quadrature(nodes)
    n, values, link = len(frames), rod.at(s), np.searchsorted(nodes[1:-1], s)
    heavy, local = weights * values[:, 3], np.einsum("qji,qj->qi", frames[link], rod.place(s) - places[link])
    masses = np.bincount(link, heavy, n).astype(float)
    centres = np.stack([np.bincount(link, heavy * x, n) for x in local.T], axis=1) / masses[:, None]
    spread = np.stack([np.bincount(link, heavy * x**2, n) for x in (local - centres[link]).T], axis=1)
    inertias = spread.sum(axis=1)[:, None] - spread
    if not rod.in_space:
        return masses, centres, np.repeat(inertias[:, 1:2], 3, axis=1)
    both = values[:, :2] / values[:, :2].sum(axis=1)[:, None]  # rho I of a section of one material
    sections = [np.bincount(link, weights * values[:, 4] * share, n) for share in (1.0, *both.T)]
    return masses, centres, inertias + np.stack(sections, axis=1)


def _compliances(rod: Rod, edges: Array) -> tuple[Array, str]:
    """(compliances of the joints, (N, 3), rad/N m, rule at the wall), by the `edges` of half links, (2 N + 1,)."""
    (s, weights), near, parts = rod.quadrature(edges), AT * edges[-1], len(edges) - 1
    ends = np.where(np.arange(parts) % 2, edges[1:] - near, edges[:-1] + near)  # those at joints
    half = 0.5 * np.repeat(np.diff(edges[::2]), 2)[:, None] / rod.at(ends)[:, :3]
    inside, part = np.searchsorted(rod.jumps, [edges[:-1] + near, edges[1:] - near]), np.searchsorted(edges[1:-1], s)
    integrals = np.stack([np.bincount(part, weights / one, parts) for one in rod.at(s)[:, :3].T], axis=1)
    half = np.where((inside[0] < inside[1])[:, None], integrals, half)
    soft, h = np.vstack([half[:1], half[1:-1:2] + half[2::2]]), np.diff(edges[:8:2])
    if np.ptp(h) > ALIKE * h[0] or ((rod.jumps > near) & (rod.jumps < edges[:6][-1])).any():
        return soft, "half"
    factors = wall_factors(("clamped", "free"), len(soft), "gregory")[:-1] / np.append(0.5, np.ones(len(soft) - 1))
    soft[:, : 2 + rod.bent] *= factors[:, None]
    return soft, "gregory"


@lru_cache(maxsize=16)
def rod_hz(rod: Rod, nodes: tuple[float, ...], n_modes: int) -> Array:
    """Frequencies of the rod, (n_modes,), Hz, from links in 2 and 4 parts, of long chains in 1 and 2.

    Extrapolated as of order 2: of order 4 the error is 2 % of that of the chain, of long chains 27 %.
    """
    n, hertz = len(nodes) - 1, list[Array]()
    for part in (2, 4) if 4 * n * (1 + 2 * rod.in_space) <= MOST else (1, 2):
        finer = np.interp(np.arange(n * part + 1) / part, np.arange(n + 1), nodes)
        hertz.append(curved_chain(rod, finer).frequencies_hz(n_modes=n_modes))
    coarse, fine = (one[: len(hertz[0])] for one in hertz)
    return np.asarray(fine + (fine - coarse) / 3.0)
