"""MJCF, SDF and URDF files as bodies and joints at rest, and the straight chain of rigid links in them.

MJCF is compiled by MuJoCo, which resolves defaults, includes and the inertias of geoms. SDF and URDF are read by the
standard library; the springs of URDF are those of Gazebo's extension.
"""

from collections.abc import Iterator
from pathlib import Path
from typing import NamedTuple
from xml.etree import ElementTree

import numpy as np

from verify.arrays import Array
from verify.engines.description import AXES, Axis
from verify.errors import InputError, shown
from verify.files import readable

SLIDE = "is a slide or a free base"
ROUND = (3, 5)
"""Types of geoms of MuJoCo: capsule, cylinder."""
STRAIGHT = 1e-3
"""Largest distance from the line of the chain over its length, and deviation of a hinge from a right angle, rad."""


class Move(NamedTuple):
    """A hinge at a place, m, about an axis in the world; `bound`: what acts on it besides its spring.

    A ball joint is three hinges of one name and stiffness.
    """

    joint: str
    at: Array
    axis: Array
    stiffness: float
    bound: str = ""


class Solid(NamedTuple):
    """A rigid body in the world: parent (-1: the world), origin, mass, centre, inertia about it (3, 3).

    `radius`: of the cylinder or capsule that is drawn for it, m, else 0.
    """

    name: str
    parent: int
    origin: Array
    mass: float
    centre: Array
    inertia: Array
    moves: tuple[Move, ...]
    radius: float = 0.0


class Line(NamedTuple):
    """The chain in one bending plane, N joints with a link beyond each. SI.

    A first link fixed to the wall has the joint '' of stiffness NaN. `links`, with the bodies fixed to them: length,
    mass, centre of mass from the joint, inertia about it, (N, 4). `solid`: inertias are those of prisms.
    """

    axis: Axis
    joints: list[str]
    springs: Array
    links: Array
    solid: bool


def read(path: Path) -> tuple[str, list[Solid], Array]:
    """(root element: mujoco, sdf or robot; bodies, each after its parent; gravity, m/s^2). Raises InputError.

    Gravity of SDF and URDF is that of an empty world.
    """
    earth = np.array([0.0, 0.0, -9.81])
    readable(path, "file")
    try:
        root = ElementTree.parse(path).getroot()
        if root.tag == "mujoco":
            return root.tag, *_mjcf(path)
        if root.tag == "sdf":
            return root.tag, _finite(_xml(next(root.iter("model")), path.name, None)), earth
        if root.tag == "robot":
            springs = {one.get("reference", ""): one.findtext("springStiffness") for one in root.findall("gazebo")}
            return root.tag, _finite(_xml(root, path.name, springs)), earth
    except InputError:
        raise
    except (OSError, SyntaxError, ValueError, LookupError, TypeError, RuntimeError, StopIteration) as error:
        unnamed = f"{error} is named and is not there" if isinstance(error, LookupError) else "it has no <model>"
        why = unnamed if isinstance(error, LookupError | StopIteration) else " ".join(str(error).split())
        raise InputError(f"{path.name}: not readable ({why}): correct it there, or write it anew") from None
    raise InputError(f"{path.name}: its root element is {shown(root.tag)}, give MJCF, SDF or URDF")


def _mjcf(path: Path) -> tuple[list[Solid], Array]:
    """The bodies at the angles where the springs have no moment, and gravity."""
    try:
        import mujoco
    except ImportError:
        raise InputError(f"{path.name}: MJCF is compiled by MuJoCo, install it: pip install mujoco") from None
    model = mujoco.MjModel.from_xml_path(str(path.resolve()))
    model.opt.jacobian = mujoco.mjtJacobian.mjJAC_DENSE
    data = mujoco.MjData(model)
    data.qpos[:] = model.qpos_spring
    mujoco.mj_forward(model, data)
    springs = np.reshape(model.jnt_stiffness, (model.njnt, -1))
    bound = {int(dof): "has an armature" for dof in np.flatnonzero(model.dof_armature)}
    kinds = ("has an equality", *["has dry friction"] * 2, *["is at a limit"] * 2, *["has a contact"] * 9)
    for kind, row in zip(data.efc_type, np.reshape(data.efc_J, (-1, model.nv)), strict=False):
        bound |= {int(dof): kinds[kind] for dof in np.flatnonzero(row)}
    for at, n, spring in zip(model.tendon_adr, model.tendon_num, model.tendon_stiffness, strict=True):
        bound |= {int(model.jnt_dofadr[i]): "has a tendon" for i in model.wrap_objid[at : at + n] if np.any(spring)}
    for i, bias in enumerate(model.actuator_biasprm):
        if bias[1] and model.actuator_trntype[i] == 0:
            bound[int(model.jnt_dofadr[model.actuator_trnid[i, 0]])] = "has an actuator with a stiffness"

    def moves(body: int) -> Iterator[Move]:
        for j in range(int(model.body_jntadr[body]), int(model.body_jntadr[body] + model.body_jntnum[body])):
            kind, dof = int(model.jnt_type[j]), int(model.jnt_dofadr[j])
            for i, axis in enumerate([data.xaxis[j]] if kind > 1 else data.xmat[body].reshape(3, 3).T):
                name, at, slide = model.joint(j).name or f"joint #{j}", data.xanchor[j].copy(), SLIDE * (kind in (0, 2))
                yield Move(name, at, axis.copy(), float(springs[j, 0]), bound.get(dof + i, slide))

    solids = []
    for b in range(1, model.nbody):
        own = data.ximat[b].reshape(3, 3)
        with np.errstate(invalid="ignore"):  # refused by `_finite`
            inertia = (own * model.body_inertia[b]) @ own.T
        place, up = data.xpos[b].copy(), int(model.body_parentid[b]) - 1
        name, mass = model.body(b).name or f"body {b}", float(model.body_mass[b])
        drawn = range(model.body_geomadr[b], model.body_geomadr[b] + model.body_geomnum[b])
        radii = [float(model.geom_size[i, 0]) for i in drawn if model.geom_type[i] in ROUND]
        own_moves, radius, centre = tuple(moves(b)), max(radii, default=0.0), data.xipos[b].copy()
        solids.append(Solid(name, up, place, mass, centre, inertia, own_moves, radius))
    return _finite(solids), np.array(model.opt.gravity)


def _finite(solids: list[Solid]) -> list[Solid]:
    """The bodies. Raises ValueError where masses or places are no finite numbers."""
    for one in solids:
        springs = [move.stiffness for move in one.moves]
        if not all(np.isfinite(part).all() for part in (one.mass, one.centre, one.origin, one.inertia, springs)):
            raise ValueError(f"{shown(one.name)} has a number that is not finite")
    return solids


def _value(one: ElementTree.Element | None, path: str) -> str:
    """An attribute (URDF) or the text of an element (SDF), '' where missing."""
    head, _, last = path.rpartition("/")
    at = one.find(head) if one is not None and head else one
    return "" if at is None else at.get(last) or (at.findtext(last) or "").strip()


def _pose(one: ElementTree.Element | None) -> Array:
    """The transformation (4, 4) of an element's origin (URDF) or pose (SDF): x y z, roll pitch yaw."""
    words = _value(one, "pose") or f"{_value(one, 'origin/xyz') or '0 0 0'} {_value(one, 'origin/rpy')}"
    if len(words.split()) > 6:
        raise ValueError("a pose by a quaternion, give roll, pitch and yaw")
    x, y, z, roll, pitch, yaw = [*map(float, words.split()), 0.0, 0.0, 0.0][:6]
    pose, unit = np.eye(4), np.pi / 180.0 if _value(one, "pose/degrees") == "true" else 1.0
    for angle, i, k in ((yaw, 0, 1), (pitch, 2, 0), (roll, 1, 2)):
        turn, c, s = np.eye(4), np.cos(unit * angle), np.sin(unit * angle)
        turn[[i, k, i, k], [i, k, k, i]] = c, c, -s, s
        pose = pose @ turn
    pose[:3, 3] = x, y, z
    return pose


def _xml(model: ElementTree.Element, name: str, springs: dict[str, str | None] | None) -> list[Solid]:
    """The links of a model of SDF, or of URDF with `springs` of its joints."""
    mark = "" if springs is None else "joint "  # in URDF a joint may have the name of a link
    links = {one.get("name", ""): one for one in model.findall("link")}
    joints = {mark + one.get("name", ""): one for one in model.findall("joint")}
    frames = {one.get("name", ""): one for one in model.findall("frame")} | joints | links
    ends = {
        key: [_value(one, f"{end}/link") or _value(one, end) for end in ("parent", "child")]
        for key, one in joints.items()
    }
    above = {child: (key, parent) for key, (parent, child) in ends.items()}
    if len(above) < len(ends):
        raise InputError(f"{name}: a link is the child of two joints: closed loops are not read, open them")
    places: dict[str, Array] = dict.fromkeys(("", "__model__", "world"), np.eye(4))

    def place(frame: str) -> Array:
        if frame not in places:
            base = ends[frame][springs is None] if frame in joints else frames[frame].get("attached_to", "")
            base = above.get(frame, ("",))[0] if springs is not None and frame in links else base
            places[frame] = place(_value(frames[frame], "pose/relative_to") or base) @ _pose(frames[frame])
        return places[frame]

    order, solids = list[str](), list[Solid]()
    while fresh := [key for key in links if key not in order and above.get(key, ("", "world"))[1] in ("world", *order)]:
        order += fresh
    for key in order:
        at, one, (joint, parent) = place(key), links[key], above.get(key, ("", ""))
        kind, moves, inertial = joints[joint].get("type", "") if joint else "fixed", [], one.find("inertial")
        mass = float(_value(inertial, "mass/value") or _value(inertial, "mass") or 0)
        if kind not in ("fixed", "revolute", "continuous", "prismatic"):
            raise InputError(f"{name}: joint {shown(joint)} is of type {shown(kind)}, give hinges in its place")
        if kind != "fixed":
            if not mass:
                raise InputError(f"{name}: link {shown(key)} has no inertial and a mesh no mass, give mass and inertia")
            axis, turn, word = joints[joint].find("axis"), place(joint), joint[len(mark) :]
            old = "__model__" * (_value(axis, "use_parent_model_frame") in ("1", "true"))
            frame = place(_value(axis, "xyz/expressed_in") or old or joint)
            about = frame[:3, :3] @ np.array((_value(axis, "xyz") or "1 0 0").split(), dtype=float)
            own = _value(axis, "dynamics/spring_stiffness") if springs is None else springs.get(word)
            moves = [Move(word, turn[:3, 3], about, float(own or 0.0), SLIDE * (kind == "prismatic"))]
        centre = at @ _pose(inertial)
        six = [float(_value(inertial, f"inertia/i{pair}") or 0.0) for pair in ("xx", "xy", "xz", "yy", "yz", "zz")]
        inertia = centre[:3, :3] @ np.array(six)[[[0, 1, 2], [1, 3, 4], [2, 4, 5]]] @ centre[:3, :3].T
        up = order.index(parent) if parent in order else -1
        radii = [float(_value(shape, "radius") or 0.0) for kind in ("cylinder", "capsule") for shape in one.iter(kind)]
        solids.append(Solid(key, up, at[:3, 3], mass, centre[:3, 3], inertia, tuple(moves), max(radii, default=0.0)))
    return solids


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
        raise InputError(f"{name}: no hinge has a stiffness, give springs (in URDF by gazebo/springStiffness)")
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
    """The chain in bending in each plane of its hinges. Raises InputError for what is no straight chain."""
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
    for axis, about in zip(AXES[:2], turned[:2], strict=True):
        own = [[move for move in moves if abs(move.axis @ about) > 0.9] for moves, _ in parts]
        if not any(move.stiffness for moves in own for move in moves):
            continue
        for j, moves in enumerate(own[1:], 1):
            if len(moves) != 1 or not moves[0].stiffness:
                text = f"has no hinge with a stiffness for {axis}: a chain begins at a wall"
                raise InputError(f"{name}: {shown(mains[j].name)} {text}")
        springs = np.array([moves[0].stiffness if moves else np.nan for moves in own])
        links = [np.append(steps, last), masses, centre, np.array([about @ one.inertia @ about for one in whole])]
        joints = [moves[0].joint if moves else "" for moves in own]
        found.append(Line(axis, joints, springs, np.stack(links, axis=1), solid))
    return found


def _joined(members: list[Solid]) -> Solid:
    """One body of those that move together, of the name of the first."""
    mass = sum(one.mass for one in members)
    centre = np.sum([one.mass * one.centre for one in members], axis=0) / mass
    inertia = np.zeros((3, 3))
    for one in members:
        arm = one.centre - centre
        inertia += one.inertia + one.mass * (arm @ arm * np.eye(3) - np.outer(arm, arm))
    return members[0]._replace(mass=mass, centre=centre, inertia=inertia)
