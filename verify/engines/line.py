"""The straight chain of rigid links among the bodies and joints of a file."""

import itertools
from typing import NamedTuple

import numpy as np

from verify.arrays import Array
from verify.engines.description import AXES, Axis
from verify.engines.reading import Move, Solid
from verify.errors import InputError, shown

STRAIGHT = 1e-3
"""Largest distance from the line of the chain over its length, and deviation of a hinge from a right angle, rad."""


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

    @property
    def turns(self) -> Axis:
        """The axis of its chain alone: "torsion", or "bending" in either plane."""
        return "torsion" if self.axis == "torsion" else "bending"


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


def lines(solids: list[Solid], name: str) -> list[Line]:
    """The chain in bending in each plane of its hinges, in torsion. Raises InputError for what is no straight chain."""
    parts = _chain(solids, name)
    mains, hinges = [members[0] for _, members in parts], [move for moves, _ in parts for move in moves]
    places = np.array([moves[-1].at if moves else members[0].origin for moves, members in parts])
    along = (places[-1] - places[0]) / (np.linalg.norm(places[-1] - places[0]) or 1.0)
    x, centres = (places - places[0]) @ along, np.array([one.centre for one in mains])
    off = [places - places[0] - np.outer(x, along), centres - places - np.outer((centres - places) @ along, along)]
    if not along.any() or max(np.linalg.norm(one, axis=1).max() for one in off) > STRAIGHT * x[-1]:
        raise InputError(f"{name}: its joints and centres of mass are on no straight line, give two links or more")
    masses, centre, steps = np.array([one.mass for one in mains]), (centres - places) @ along, np.diff(x)
    last = float(centre[-1] / max(np.median(centre[:-1] / steps), 0.1)) or float(steps[-1])
    if abs(masses[-1] / last / np.median(masses[:-1] / steps) - 1.0) > 0.01:
        last = float(steps[-1])  # a body of the end moves the centre of mass
    across = next((one.axis for one in hinges if one.stiffness and abs(one.axis @ along) < STRAIGHT), along)
    turned = [across, np.cross(along, across), along]
    if across is along or any(max(abs(one.axis @ about) for about in turned) < 1.0 - STRAIGHT for one in hinges):
        raise InputError(f"{name}: its hinges are not about or across its own axis, at right angles, turn them")
    whole = [_joined(members) for _, members in parts]
    masses, centre = np.array([one.mass for one in whole]), np.array([one.centre for one in whole] - places) @ along
    prism, spins = masses * np.append(steps, last) ** 2 / 6.0, np.array([along @ one.inertia @ along for one in whole])
    apart = np.array([np.trace(one.inertia) for one in whole]) - prism - 2.0 * spins
    found, solid = [], bool(np.median(abs(apart) / (spins + 1e-6 * prism)) < 0.05)
    for axis, about in zip(AXES, turned, strict=True):
        own = [[move for move in moves if abs(move.axis @ about) > 0.9] for moves, _ in parts]
        if not any(move.stiffness for moves in own for move in moves):
            continue
        for j, moves in enumerate(own[1:], 1):
            if len(moves) > 1 or (axis != "torsion" and not (moves and moves[0].stiffness)):
                text = "has no hinge with a stiffness" if len(moves) < 2 else "has two hinges"
                remedy = "give it one, or fix the body to the one before" if len(moves) < 2 else "give it one"
                raise InputError(f"{name}: {shown(mains[j].name)} {text} about {_direction(about)}, {remedy}")
        springs = np.array([moves[0].stiffness if moves else np.nan for moves in own])
        links = [np.append(steps, last), masses, centre, np.array([about @ one.inertia @ about for one in whole])]
        joints = [moves[0].joint if moves else "" for moves in own]
        others = [
            np.array([getattr(moves[0], of) if moves else 0.0 for moves in own]) for of in ("damping", "armature")
        ]
        ball = any(one.joint == other.joint for moves, _ in parts for one, other in itertools.pairwise(moves))
        seen = _direction(about), _direction(np.cross(along, about)), _deep(mains, along, about, solid)
        found.append(Line(axis, joints, springs, np.stack(links, axis=1), solid, *seen, ball, *others))
    return found


def _direction(about: Array) -> str:
    """A direction as in a file, of a positive sum: '0 0 1'."""
    return " ".join(f"{one:.3g}" for one in np.round(about if about.sum() > 0.0 else -about, 6) + 0.0)


def _deep(mains: list[Solid], along: Array, about: Array, solid: bool) -> tuple[float, float]:
    """(b/a)^2 of a section of depth b across the hinges and a along them, by what is drawn and by inertias, or NaN."""
    across = np.cross(along, about)
    drawn = [(across @ one.shape @ across, about @ one.shape @ about) for one in mains if one.shape.any()]
    spins = [[d @ one.inertia @ d for d in (along, about, across)] for one in mains]
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
