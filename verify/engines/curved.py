"""A chain of rigid links along a curve: joints with rest angles, and what its motions about rest are.

Link j runs from node j to the next: its frame has x along the chord, z along `u` of the rod. The joint between two
links turns about the axes of the rotation half way between their frames: about those of one link, EI and GJ would mix
by half a rest angle, order 1. Its compliance is the integral of ds/EI between the middles of both links. At the wall
that is over half a link, or by Gregory's weights times h/EI at the joint where the first three links have one length h
and no step: both are of order 2 on a curve, the second with half of the error or less (a quarter circle, a taper of
10 to 1). Bodies carry the rest pose, so that all springs are at rest at zero angles, whatever a format calls the
reference of a spring.
"""

from dataclasses import dataclass
from functools import lru_cache
from typing import Any, Literal

import numpy as np

from verify.arrays import Array
from verify.engines.description import AXES, Axis, Hinge, Joint, Link, RigidChain
from verify.engines.rod import Rod, transported
from verify.errors import InputError
from verify.problem.beam import Beam
from verify.segments.walls import wall_factors

Links = Literal["chords", "arcs"]
ALIKE = 0.01
"""Relative difference of first links up to which they are alike: Gregory's joint is then off by 0.4 % of a link."""
BACK = -0.99
"""Cosine between links from which the axes of the joint between are uncertain."""
MOST = 1500
"""Unknowns of a chain of four parts a link; with more the error is by two parts alone: matrices are dense."""


@dataclass(frozen=True, eq=False, kw_only=True)
class CurvedChain(RigidChain):
    """A chain with joint j at `places`[j], (N + 1, 3), m, and link frames (N, 3, 3), clamped at joint 0, else free.

    `half`: from the frame of the link before, at joint 0 of the wall, to that of the joint, and on to that of the link,
    (N, 3, 3). `rod` and `nodes`, arc length at the joints, m, are what it divides. In the world are masses, (N,),
    centres, (N, 3), and inertias about them, (N, 3, 3), of `bodies`; places, axes, (n, 3), and joints of `hinges`.
    """

    rod: Rod
    nodes: tuple[float, ...]
    kind: Links
    places: Array
    frames: Array
    half: Array
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
        turns = np.stack([self.half[j] if j else self.frames[0] @ self.half[0].T, self.half[j]])
        return (self.places[0] if j == 0 else np.array([self.links[j - 1].length, 0.0, 0.0])), turns

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

    def exact_hz(self, axis: Axis = "bending", n_modes: int = 3) -> Array:
        """Frequencies of the rod, estimated from links in two and in four parts, (n_modes,), Hz."""
        return converged(self.rod, self.nodes, self.kind, n_modes)[0]

    def rest_angle(self, j: int) -> float:
        """Rotation between the links at a joint, rad, 0 at the wall."""
        return (j > 0) * float(4.0 * np.arcsin(min(np.linalg.norm(self.half[j] - np.eye(3)) / 8.0**0.5, 1.0)))


def curved_chain(rod: Rod, nodes: Array, kind: Links = "chords") -> CurvedChain:
    """The chain with joints at arc lengths `nodes`, (N + 1,), m, from 0 to the length.

    `kind`: "chords" end on the curve and are short by a^2/24 at an angle a between links; "arcs" have the length of the
    curve and the directions of its chords. Masses are those of the curve.
    """
    n, places, h = len(nodes) - 1, rod.place(nodes), np.diff(nodes)
    chords = np.diff(places, axis=0)
    lengths = np.linalg.norm(chords, axis=1)
    middles, tangents = 0.5 * (nodes[1:] + nodes[:-1]), chords / lengths[:, None]
    along = np.vstack([rod.tangent, tangents])
    if np.einsum("ni,ni->n", along[1:], along[:-1]).min() < BACK:
        raise InputError("curve: two links point in opposite directions, give more links or points along the turn")
    every = transported(along, rod.start, rod.at(np.append(0.0, middles))[:, 5])
    first, frames = every[0], every[1:]
    if kind == "arcs":
        lengths = h
        places = places[0] + np.vstack([np.zeros(3), np.cumsum(h[:, None] * tangents, axis=0)])
    turns = np.swapaxes(frames[:-1], 1, 2) @ frames[1:]
    half = np.append((first.T @ frames[0])[None], _half(turns), axis=0)
    s, weights = rod.quadrature(np.concatenate([nodes, middles]))
    link, joint, values = np.clip(np.searchsorted(nodes, s) - 1, 0, n - 1), np.searchsorted(middles, s), rod.at(s)
    soft = np.stack([np.bincount(joint, weights / values[:, i], n + 1) for i in range(3)], axis=1)[:n]
    wall = "gregory" if np.ptp(h[:3]) < ALIKE * h[0] and not rod.steps(0.0, middles[:3][-1]) else "half"
    if wall == "gregory":
        factors = wall_factors(("clamped", "free"), n, wall)[:3]
        soft[:3, :2] = (factors * h[:3].mean())[:n, None] / rod.at(nodes[:3])[:n, :2]
    x, heavy = (s - nodes[link]) * (lengths / h)[link], weights * values[:, 3]
    masses = np.bincount(link, heavy, n)
    centres = np.bincount(link, heavy * x, n) / masses
    inertias = np.outer(np.bincount(link, heavy * (x - centres[link]) ** 2, n), [not rod.in_space, 1.0, 1.0])
    both = values[:, :2] / values[:, :2].sum(axis=1)[:, None]  # rho I of a section of one material
    for i, share in enumerate((1.0, *both.T) if rod.in_space else ()):
        inertias[:, i] += np.bincount(link, weights * values[:, 4] * share, n)
    axes = AXES if rod.in_space else AXES[:1]
    springs = np.append(1.0 / soft, np.zeros((1, 3)), axis=0).tolist()
    edges = np.append(0.0, np.cumsum(lengths)).tolist()
    rows = zip(edges, lengths.tolist(), masses.tolist(), centres.tolist(), map(tuple, inertias.tolist()), strict=False)
    ei, mass = rod.values[0, [0, 3]].tolist()
    beam = Beam(length=edges[-1], supports=("clamped", "free"), bending_stiffness=ei, mass_per_length=mass)
    joints = tuple(Joint(x, tuple(map(Hinge, axes, k))) for x, k in zip(edges, springs, strict=True))
    about = frames @ np.swapaxes(half, 1, 2)
    each = np.stack([-about[:, :, 1], about[:, :, 2], about[:, :, 0]], axis=1)[:, : len(axes)]
    order = np.repeat(np.arange(n), len(axes))
    world = np.einsum("nij,nj,nkj->nik", frames, inertias, frames)
    shape: dict[str, Any] = {"nodes": tuple(nodes.tolist()), "places": places, "frames": frames, "half": half}
    shape |= {"hinges": (places[order], each.reshape(-1, 3), order)}
    shape |= {"bodies": (masses, places[:-1] + centres[:, None] * tangents, world)}
    links = tuple(Link(*row) for row in rows)
    return CurvedChain(beam, wall, joints, links, in_space=rod.in_space, rod=rod, kind=kind, **shape)


def _half(turns: Array) -> Array:
    """The rotations of half the angle, (n, 3, 3): the polar factor of 1 + R."""
    left, _, right = np.linalg.svd(np.eye(3) + turns)
    return np.asarray(left @ right)


@lru_cache(maxsize=16)
def converged(rod: Rod, nodes: tuple[float, ...], kind: Links, n_modes: int) -> tuple[Array, Array]:
    """(frequencies of the rod, Hz, observed orders), (n_modes,), by Richardson from links in 1, 2 and 4 parts."""
    n, hertz = len(nodes) - 1, list[Array]()
    parts = (1, 2, 4) if 4 * n * (1 + 2 * rod.in_space) <= MOST else (1, 2)
    for part in parts:
        finer = np.interp(np.arange(n * part + 1) / part, np.arange(n + 1), nodes)
        hertz.append(curved_chain(rod, finer, kind).frequencies_hz(n_modes=n_modes))
    few = min(map(len, hertz))
    steps, orders = np.diff([one[:few] for one in hertz], axis=0), np.full(few, np.nan)
    if len(parts) == 3:
        with np.errstate(divide="ignore", invalid="ignore"):
            orders = np.log2(steps[0] / steps[1])
    used = np.clip(np.nan_to_num(orders, nan=2.0), 1.0, 4.0)  # 2 where an error changes its sign
    return hertz[-1][:few] + steps[-1] / (2.0**used - 1.0), orders
