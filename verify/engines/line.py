"""The chain of rigid links among the bodies and joints of a file, straight or curved at rest."""

import itertools
from typing import NamedTuple

import numpy as np

from verify.arrays import Array
from verify.engines.description import AXES, Axis
from verify.engines.reading import Move, Solid
from verify.errors import InputError, shown

STRAIGHT = 1e-3
"""Largest distance from the line of the chain over its length, and deviation of a hinge from a right angle, rad."""
BOW, TURN = 0.1, 0.4
"""On a curve: of a centre of mass from its chord over the length, and of a hinge, half a rest angle off."""


class Line(NamedTuple):
    """The chain in one bending plane or in torsion, N joints with a link beyond each. SI.

    A first link fixed to the wall has the joint '' of stiffness NaN. `links`, with the bodies fixed to them: length,
    mass, centre of mass from the joint, inertia about it, (N, 4). `solid`: inertias are those of prisms. `about`,
    `across`: directions of the hinges and of the other ones at right angles in the world. `deep`: square of the depth
    of the section across the hinges over that along them, by what is drawn and by inertias of prisms, NaN where
    unknown. `ball`: the hinges are those of ball joints. `dashpots`, `armatures` of the hinges, (N,).
    """

    axis: Axis
    joints: list[str]
    springs: Array
    links: Array
    solid: bool
    about: str
    across: str
    deep: tuple[float, float]
    ball: bool
    dashpots: Array
    armatures: Array
    curve: "Curve"

    @property
    def turns(self) -> Axis:
        """The axis of its chain alone: "torsion", or "bending" in either plane."""
        return "torsion" if self.axis == "torsion" else "bending"


class Curve(NamedTuple):
    """Places of the joints and the end at rest, (N + 1, 3), m, directions of links, (N, 3), of the hinges of a line.

    `bodies`: masses, (N,), centres, (N, 3), inertias about them, (N, 3, 3), of links with what is fixed to them.
    """

    places: Array
    directions: Array
    bodies: tuple[Array, Array, Array]
    hinges: Array
    bent: bool


def _chain(solids: list[Solid], name: str) -> list[tuple[list[Move], list[Solid]]]:
    """The hinges and bodies, the link first, of each rigid part of the chain with springs, from the wall on.

    A first link fixed to the wall has no hinges. Raises InputError for branches and for what else acts on it.
    """
    owner, up = list[int](), dict[int, int]()
    for i, one in enumerate(solids):
        above = owner[one.parent] if one.parent >= 0 else -1
        owner.append(i if one.moves else above)
        up |= {i: above} if one.moves else {}
    sprung = [i for i in up if any(move.stiffness > 0.0 for move in solids[i].moves)]
    if not sprung:
        hint = " by gazebo/springStiffness" * name.lower().endswith(".urdf")
        raise InputError(f"{name}: no hinge has a stiffness, give springs{hint}")
    chain = sprung[:1]
    while up[chain[0]] >= 0:
        chain.insert(0, up[chain[0]])
    while below := [i for i in up if up[i] == chain[-1]]:
        if len(below) > 1:
            raise InputError(f"{name}: {shown(solids[chain[-1]].name)} carries {len(below)} bodies: the chain branches")
        chain += below
    if other := set(sprung) - set(chain):
        raise InputError(f"{name}: {shown(solids[min(other)].name)} has springs beyond the first chain, give one chain")
    for move in (move for i in chain for move in solids[i].moves if move.bound):
        raise InputError(f"{name}: joint {shown(move.joint)} {move.bound}: take it out, hinges and springs are judged")
    parts = list[tuple[list[Move], list[Solid]]]()
    for i in chain:
        own, members = list(solids[i].moves), [one for k, one in enumerate(solids) if owner[k] == i]
        before = parts.pop() if parts and np.allclose(parts[-1][0][-1].at, own[0].at, atol=1e-6) else ([], [])
        parts.append((before[0] + own, members + before[1]))
    if len(parts) > 1 and (base := solids[chain[0]].parent) >= 0:
        ahead, first, held = parts[1][0][-1].at, parts[0][0][-1].at, solids[base]
        density = parts[0][1][0].mass / np.linalg.norm(ahead - first)
        for start in (held.origin, 2.0 * held.centre - first):  # the frame of a link may be at its centre
            if abs(held.mass - density * (reach := np.linalg.norm(first - start))) < 0.05 * density * reach:
                return [([], [held._replace(origin=start)]), *parts]
    return parts


def _links(parts: list[tuple[list[Move], list[Solid]]], name: str) -> tuple[Array, Array, Array, bool]:
    """(places of the joints, directions, lengths of the links, whether they are on a curve). Raises InputError."""
    mains = [members[0] for _, members in parts]
    places = np.array([moves[-1].at if moves else members[0].origin for moves, members in parts])
    centres, masses = np.array([one.centre for one in mains]), np.array([one.mass for one in mains])
    along = (places[-1] - places[0]) / (np.linalg.norm(places[-1] - places[0]) or 1.0)
    off = [one - np.outer(one @ along, along) for one in (places - places[0], centres - places)]
    reach = float(along @ (places[-1] - places[0]))
    curved = not reach or bool(max(np.linalg.norm(one, axis=1).max() for one in off) > STRAIGHT * reach)
    if len(parts) < 2 + curved:
        raise InputError(f"{name}: give two links or more, on a curve three")
    directions, steps = np.tile(along, (len(parts), 1)), np.diff((places - places[0]) @ along)
    if curved:
        steps, tips = np.diff(places, axis=0), (centres - places)[-2:]
        directions = np.vstack([steps, tips[-1:] if tips[-1].any() else steps[-1:]])
        directions, steps = directions / np.linalg.norm(directions, axis=1)[:, None], np.linalg.norm(steps, axis=1)
        # the centre of mass of a piece of a curve is off its chord by an angle in proportion to length and curvature
        size = np.linalg.norm(tips, axis=1)
        directions[-1] += np.cross(np.cross(tips[0], directions[-2]) * size[1] / (size[0] ** 2 or 1.0), directions[-1])
        directions[-1] /= np.linalg.norm(directions[-1])
    centre = np.einsum("ni,ni->n", centres - places, directions)
    if curved and np.linalg.norm(centres - places - centre[:, None] * directions, axis=1).max() > BOW * steps.max():
        text = "centres of mass are off the lines between its joints, give links from joint to joint, or more of them"
        raise InputError(f"{name}: {text}")
    share = centre[-2] / steps[-1] if curved else np.median(centre[:-1] / steps)  # it varies along a tapered rod
    last = float(centre[-1] / max(share, 0.1)) or float(steps[-1])
    heavy = masses[-1] / last * (steps[-1] / masses[-2] if curved else 1.0 / np.median(masses[:-1] / steps)) - 1.0
    longer = (1.0 - directions[-1] @ directions[-2]) / 12.0  # an arc than its chord
    if heavy > 0.01 + longer or (not curved and heavy < -0.01):  # a tapered rod is lighter at its end
        last = float(steps[-1])  # a body of the end moves the centre of mass
    return places, directions, np.append(steps, last), curved


def lines(solids: list[Solid], name: str) -> list[Line]:
    """The chain in bending in each plane of its hinges, in torsion, straight or along a curve.

    Raises InputError for what is no chain of links with hinges along or across them.
    """
    parts = _chain(solids, name)
    mains, (places, directions, lengths, curved) = [members[0] for _, members in parts], _links(parts, name)
    turned = _axes(parts, directions, name, curved)
    whole = [_joined(members) for _, members in parts]
    masses, centres, inertias = (np.array([getattr(one, at) for one in whole]) for at in ("mass", "centre", "inertia"))
    centre = np.einsum("ni,ni->n", centres - places, directions)
    prism, spins = masses * lengths**2 / 6.0, np.einsum("ni,nij,nj->n", directions, inertias, directions)
    apart = np.trace(inertias, axis1=1, axis2=2) - prism - 2.0 * spins
    found, solid = [], bool(np.median(abs(apart) / (spins + 1e-6 * prism)) < 0.05)
    ends = np.vstack([places, places[-1] + lengths[-1] * directions[-1]])
    for axis, about in zip(AXES, turned, strict=True):
        own = [[move for move in moves if abs(move.axis @ e) > 0.8] for e, (moves, _) in zip(about, parts, strict=True)]
        if not any(move.stiffness for moves in own for move in moves):
            if curved and any(own):  # free about this axis, all axes vibrate together
                joint = next(moves[0].joint for moves in own if moves)
                raise InputError(f"{name}: joint {shown(joint)} and all others like it have no stiffness, give one")
            continue
        for j, moves in enumerate(own[1:], 1):
            if len(moves) > 1 or (axis != "torsion" and not (moves and moves[0].stiffness)):
                text = "has no hinge with a stiffness" if len(moves) < 2 else "has two hinges"
                remedy = "give it one, or fix the body to the one before" if len(moves) < 2 else "give it one"
                raise InputError(f"{name}: {shown(mains[j].name)} {text} about {_direction(about[j])}, {remedy}")
        springs = np.array([moves[0].stiffness if moves else np.nan for moves in own])
        links = [lengths, masses, centre, np.einsum("ni,nij,nj->n", about, inertias, about)]
        joints = [moves[0].joint if moves else "" for moves in own]
        dashpots = np.array([moves[0].damping if moves else 0.0 for moves in own])
        armatures = np.array([moves[0].armature if moves else 0.0 for moves in own])
        ball = any(one.joint == other.joint for moves, _ in parts for one, other in itertools.pairwise(moves))
        across = np.cross(directions, about)
        seen = _direction(about[0]), _direction(across[0]), _deep(mains, directions, across, solid)
        hinges = np.array([moves[0].axis if moves else e for moves, e in zip(own, about, strict=True)])
        curve = Curve(ends, directions, (masses, centres, inertias), hinges, curved)
        found.append(Line(axis, joints, springs, np.stack(links, 1), solid, *seen, ball, dashpots, armatures, curve))
    return found


def _axes(parts: list[tuple[list[Move], list[Solid]]], directions: Array, name: str, curved: bool) -> list[Array]:
    """Directions of the hinges across, of those at right angles, and along the links at every joint, (N, 3) each."""
    hinges = [(j, one) for j, (moves, _) in enumerate(parts) for one in moves]
    before = np.vstack([directions[:1], directions[:-1]]) + directions
    before /= np.linalg.norm(before, axis=1)[:, None]
    free = TURN if curved else STRAIGHT
    across = next((one.axis for j, one in hinges if one.stiffness and abs(one.axis @ before[j]) < free), None)
    found = list[Array]()
    for j, t in enumerate(before if across is not None else ()):
        near = [one.axis for i, one in hinges if i == j and abs(one.axis @ t) < free] if curved else []
        across = max(near, key=lambda e: abs(e @ across), default=across)
        across = across - (across @ t) * t
        across = across / np.linalg.norm(across)
        found.append(np.stack([across, np.cross(t, across), t]))
    near = [abs(found[j] @ one.axis).max() if found else abs(before[j] @ one.axis) for j, one in hinges]
    if not found or min(near) < 1.0 - (BOW if curved else STRAIGHT):
        joint, angle = hinges[int(np.argmin(near))][1].joint, np.degrees(np.arccos(min(near)))
        text = f"its hinges are not about or across its axis at right angles, {shown(joint)} by {angle:.2g} degrees"
        raise InputError(f"{name}: {text}, turn them, or give the bodies the angles of a curve")
    return list(np.array(found).transpose(1, 0, 2))


def _direction(about: Array) -> str:
    """A direction as in a file, of a positive sum: '0 0 1'."""
    return " ".join(f"{one:.3g}" for one in np.round(about if about.sum() > 0.0 else -about, 6) + 0.0)


def _deep(mains: list[Solid], directions: Array, across: Array, solid: bool) -> tuple[float, float]:
    """(b/a)^2 of a section of depth b across the hinges and a along them, by what is drawn and by inertias, or NaN."""
    rows = list(zip(mains, directions, np.cross(across, directions), across, strict=True))
    drawn = [(d @ one.shape @ d, a @ one.shape @ a) for one, _, a, d in rows if one.shape.any()]
    spins = [[d @ one.inertia @ d for d in each] for one, *each in rows]
    inert = [(x + a - d, x + d - a) for x, a, d in spins] if solid else []
    pairs = [np.array([pair for pair in each if min(pair) > 0.0]) for each in (drawn, inert)]
    shape, spin = (float(np.median(one[:, 0] / one[:, 1])) if len(one) else np.nan for one in pairs)
    return shape, spin


def _joined(members: list[Solid]) -> Solid:
    """One body of those that move together, of the name of the first."""
    mass = sum(one.mass for one in members)
    centre = np.sum([one.mass * one.centre for one in members], axis=0) / mass
    inertia = np.zeros((3, 3))
    for one in members:
        arm = one.centre - centre
        inertia += one.inertia + one.mass * (arm @ arm * np.eye(3) - np.outer(arm, arm))
    return members[0]._replace(mass=mass, centre=centre, inertia=inertia)
