"""MJCF, SDF and URDF files as bodies and joints at rest, and the straight chain of rigid links in them.

MJCF is compiled by MuJoCo, which resolves defaults, includes and the inertias of geoms. SDF and URDF are read by the
standard library; the stiffnesses of a URDF are in a JSON file next to it, `beam.urdf.json`: that of the writer, or
N m/rad by names of joints.
"""

import json
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Any, NamedTuple
from xml.etree import ElementTree

import numpy as np

from verify.arrays import Array
from verify.engines.description import AXES, Axis
from verify.errors import InputError, one_line, shown

STRAIGHT = 1e-3
"""Largest deviation from a straight chain, relative to its length, and from a right angle of its hinges, rad."""
LIGHT = 1e-2
"""Largest mass of a body between two joints at one place, over the median mass."""


class Move(NamedTuple):
    """A degree of freedom at a place, m, about or along an axis in the world."""

    joint: str
    slides: bool
    at: Array
    axis: Array
    stiffness: float
    armature: float = 0.0
    bound: str = ""
    """What else acts on it: a contact, an equality."""


@dataclass(frozen=True, eq=False)
class Solid:
    """A rigid body at rest in the world: parent (-1: the world), mass, centre, inertia about it (3, 3)."""

    name: str
    parent: int
    origin: Array
    mass: float
    centre: Array
    inertia: Array
    moves: tuple[Move, ...]
    shape: tuple[str, Array] | None = None
    """'box' or 'round' with its sizes as vectors of the world, rows (3, 3), m."""


@dataclass(frozen=True, eq=False)
class Line:
    """The chain about one axis: N links, joints 0..N - 1 before them. SI.

    `springs[0]` is NaN where joint 0 does not turn. `bodies`: (link, position from it, mass, inertia), fixed to a link.
    """

    axis: Axis
    direction: Array
    joints: list[tuple[str, ...]]
    springs: Array
    armatures: Array
    links: Array
    """Length, mass, centre of mass from the joint, inertia about it, (N, 4)."""
    bodies: list[tuple[int, float, float, float]]
    slides: bool
    sizes: tuple[str, float, float] | None
    """Shape, width and thickness of the drawn section, m."""


def read(path: Path) -> tuple[str, list[Solid]]:
    """('mjcf', 'sdf' or 'urdf', by the root element; bodies, each after its parent). Raises InputError."""
    try:
        root = ElementTree.parse(path).getroot()
        if root.tag == "mujoco":
            return "mjcf", _mjcf(path)
        if root.tag == "sdf":
            model = root.find(".//model")
            return "sdf", _xml(root if model is None else model, path.name, None)
        if root.tag == "robot":
            beside = path.with_name(path.name + ".json")
            if not beside.exists():
                raise InputError(
                    f"{path.name}: URDF has no joint springs, give them in {beside.name}: N m/rad by joint"
                )
            return "urdf", _xml(root, path.name, _stiffnesses(json.loads(beside.read_text("utf-8"))))
    except InputError:
        raise
    except (OSError, ElementTree.ParseError, ValueError, LookupError, TypeError, RecursionError) as error:
        raise InputError(f"{path.name}: not readable, {type(error).__name__}: {one_line(str(error))}") from None
    raise InputError(f"{path.name}: its root element is {shown(root.tag)}, give MJCF, SDF or URDF")


def _mjcf(path: Path) -> list[Solid]:
    """Compiled by MuJoCo, at the angles where the springs have no moment."""
    try:
        import mujoco
    except ImportError:
        raise InputError(f"{path.name}: MJCF is compiled by MuJoCo, install it: pip install mujoco") from None
    model = mujoco.MjModel.from_xml_path(str(path.resolve()))
    model.opt.jacobian = mujoco.mjtJacobian.mjJAC_DENSE
    data = mujoco.MjData(model)
    data.qpos[:] = model.qpos_spring
    mujoco.mj_forward(model, data)
    bound: dict[int, str] = {}
    kinds = ["an equality", "dry friction", "dry friction", "a limit", "a limit"]
    for kind, row in zip(data.efc_type, np.reshape(data.efc_J, (-1, model.nv)), strict=False):
        bound |= {int(dof): (kinds[kind] if kind < len(kinds) else "a contact") for dof in np.flatnonzero(row)}
    for first, n, spring in zip(model.tendon_adr, model.tendon_num, model.tendon_stiffness, strict=True):
        bound |= {int(model.jnt_dofadr[i]): "a tendon" for i in model.wrap_objid[first : first + n] if np.any(spring)}
    for (joint, _), kind, bias in zip(
        model.actuator_trnid, model.actuator_trntype, model.actuator_biasprm, strict=True
    ):
        bound |= {int(model.jnt_dofadr[joint]): "an actuator with a stiffness"} if kind == 0 and bias[1] else {}

    def moves(body: int) -> Iterator[Move]:
        for j in range(model.body_jntadr[body], model.body_jntadr[body] + model.body_jntnum[body]):
            kind, dof, name = int(model.jnt_type[j]), int(model.jnt_dofadr[j]), model.joint(j).name or f"joint #{j}"
            spring = float(np.reshape(model.jnt_stiffness, (model.njnt, -1))[j, 0])
            turns = data.xmat[body].reshape(3, 3).T  # a ball's spring is that of three hinges in small motion
            axes = [data.xaxis[j]] if kind >= 2 else list(turns)
            each = [(True, axis) for axis in np.eye(3)] * (kind == 0) + [(kind == 2, axis) for axis in axes]
            for i, (slides, axis) in enumerate(each):
                armature = float(model.dof_armature[dof + i])
                at = data.xanchor[j].copy()
                yield Move(name, slides, at, axis.copy(), spring, armature, bound.get(dof + i, ""))

    solids = []
    for b in range(1, model.nbody):
        own, shape = data.ximat[b].reshape(3, 3), None
        for g in range(model.body_geomadr[b], model.body_geomadr[b] + model.body_geomnum[b]):
            kind, turned = mujoco.mjtGeom(model.geom_type[g]).name[7:], data.geom_xmat[g].reshape(3, 3)
            size = {"BOX": model.geom_size[g], "CAPSULE": model.geom_size[g][[0, 0, 1]]}.get(kind)
            size = model.geom_size[g][[0, 0, 1]] if kind == "CYLINDER" else size
            if shape is None and size is not None:
                shape = "box" if kind == "BOX" else "round", (turned * 2.0 * size).T
        solids.append(
            Solid(
                model.body(b).name or f"body {b}",
                int(model.body_parentid[b]) - 1,
                data.xpos[b].copy(),
                float(model.body_mass[b]),
                data.xipos[b].copy(),
                (own * model.body_inertia[b]) @ own.T,
                tuple(moves(b)),
                shape,
            )
        )
    return solids


def _stiffnesses(data: Any) -> dict[str, float]:
    """N m/rad by joint of the JSON file next to a URDF. Raises InputError."""
    if "joints" not in data:
        return {name: float(value) for name, value in data.items()}
    if data["springs"] or data["supports"][1] != "free":
        raise InputError(
            "springs to the ground and supports of the far end are not judged, give a chain with a free end"
        )
    return {f"joint{j}_{h['axis']}": h["stiffness"] for j, one in enumerate(data["joints"]) for h in one["hinges"]}


def _value(one: ElementTree.Element | None, path: str) -> str:
    """An attribute (URDF) or the text of an element (SDF) below an element, '' where missing."""
    head, _, last = path.rpartition("/")
    at = one.find(head) if one is not None and head else one
    return "" if at is None else at.get(last) or (at.findtext(last) or "").strip()


def _pose(one: ElementTree.Element | None) -> Array:
    """The transformation (4, 4) of an element's origin (URDF) or pose (SDF): x y z, roll pitch yaw."""
    words = _value(one, "pose") or f"{_value(one, 'origin/xyz') or '0 0 0'} {_value(one, 'origin/rpy')}"
    x, y, z, roll, pitch, yaw = [*map(float, words.split()), 0.0, 0.0, 0.0][:6]
    pose = np.eye(4)
    for angle, i, k in ((yaw, 0, 1), (pitch, 2, 0), (roll, 1, 2)):
        turn, c, s = np.eye(4), np.cos(angle), np.sin(angle)
        turn[[i, k, i, k], [i, k, k, i]] = c, c, -s, s
        pose = pose @ turn
    pose[:3, 3] = x, y, z
    return pose


def _xml(model: ElementTree.Element, name: str, springs: dict[str, float] | None) -> list[Solid]:
    """The links of a model of SDF, or of URDF with `springs` of its joints."""
    links = {one.get("name", ""): one for one in model.findall("link")}
    mark = "" if springs is None else "joint "  # in URDF a joint may have the name of a link
    joints = {mark + one.get("name", ""): one for one in model.findall("joint")}
    frames = {one.get("name", ""): one for one in model.findall("frame")} | joints | links
    ends = {
        key: tuple(_value(one, f"{end}/link") or _value(one, end) for end in ("parent", "child"))
        for key, one in joints.items()
    }
    above = {child: (key, parent) for key, (parent, child) in ends.items()}
    if len(above) < len(ends):
        raise InputError(f"{name}: a link is the child of two joints: closed loops are not read, open them")
    places: dict[str, Array] = dict.fromkeys(("", "__model__", "world"), np.eye(4))

    def place(frame: str) -> Array:
        if frame not in places:
            if frame not in frames:
                raise InputError(f"{name}: a pose refers to {shown(frame)}, which is no link, joint or frame of it")
            base = ends[frame][springs is None] if frame in joints else frames[frame].get("attached_to", "")
            base = above.get(frame, ("",))[0] if springs is not None and frame in links else base
            places[frame] = place(_value(frames[frame], "pose/relative_to") or base) @ _pose(frames[frame])
        return places[frame]

    order: list[str] = []
    while fresh := [key for key in links if key not in order and above.get(key, ("", "world"))[1] in ("world", *order)]:
        order += fresh
    solids = list[Solid]()
    for key in order:
        at, one, (joint, parent) = place(key), links[key], above.get(key, ("", ""))
        kind, moves, inertial = joints[joint].get("type", "") if joint else "fixed", [], one.find("inertial")
        if kind not in ("fixed", "revolute", "continuous", "prismatic", "universal"):
            raise InputError(f"{name}: joint {shown(joint)} is of type {shown(kind)}, give hinges in its place")
        if kind != "fixed" and (
            inertial is None or not float(_value(inertial, "mass") or _value(inertial, "mass/value"))
        ):
            raise InputError(f"{name}: link {shown(key)} has no inertial: a mesh has no mass, give mass and inertia")
        for axis in (joints[joint].find(tag) for tag in ("axis", "axis2")) if kind != "fixed" else ():
            if axis is not None:
                about = place(joint)[:3, :3] @ np.array((_value(axis, "xyz") or "1 0 0").split(), dtype=float)
                spring = (
                    float(_value(axis, "dynamics/spring_stiffness") or 0)
                    if springs is None
                    else springs.get(joint[len(mark) :], 0)
                )
                word = joint[len(mark) :] + "/axis2" * bool(moves)
                moves.append(Move(word, kind == "prismatic", place(joint)[:3, 3], about, spring))
        centre, shape = at @ _pose(inertial), None
        six = [float(_value(inertial, f"inertia/i{pair}") or 0.0) for pair in ("xx", "xy", "xz", "yy", "yz", "zz")]
        inertia = np.array(six)[[[0, 1, 2], [1, 3, 4], [2, 4, 5]]]
        for drawn in (*one.findall("visual"), *one.findall("collision")):
            box, rod = (_value(drawn, f"geometry/{size}") for size in ("box/size", "cylinder/radius"))
            if shape is None and (box or rod):
                size = box.split() if box else [*[2.0 * float(rod)] * 2, _value(drawn, "geometry/cylinder/length")]
                shape = "box" if box else "round", ((at @ _pose(drawn))[:3, :3] * np.array(size, dtype=float)).T
        own = float(_value(inertial, "mass/value") or _value(inertial, "mass") or 0)
        up = order.index(parent) if parent in order else -1
        turned = centre[:3, :3] @ inertia @ centre[:3, :3].T
        solids.append(Solid(key, up, at[:3, 3], own, centre[:3, 3], turned, tuple(moves), shape))
    return solids


def lines(solids: list[Solid], name: str) -> list[Line]:
    """The chain about each axis of its hinges with a stiffness. Raises InputError for what is no straight chain."""
    owner = list[int]()
    for i, one in enumerate(solids):
        owner.append(i if one.moves else owner[one.parent] if one.parent >= 0 else -1)
    up = {i: owner[one.parent] if one.parent >= 0 else -1 for i, one in enumerate(solids) if one.moves}
    sprung = [i for i in up if any(move.stiffness > 0.0 and not move.slides for move in solids[i].moves)]
    if not sprung:
        raise InputError(f"{name}: no hinge has a stiffness, give the joints their springs")
    chain = sprung[:1]
    while up[chain[0]] >= 0:
        chain.insert(0, up[chain[0]])
    while below := [i for i in up if up[i] == chain[-1]]:
        if len(below) > 1:
            raise InputError(f"{name}: {shown(solids[chain[-1]].name)} carries {len(below)} bodies: the chain branches")
        chain += below
    if other := set(sprung) - set(chain):
        raise InputError(f"{name}: {shown(solids[min(other)].name)} has springs beyond the first chain, give one chain")
    for move in (move for i in chain for move in solids[i].moves):
        if move.bound:
            raise InputError(
                f"{name}: {move.bound} acts on {shown(move.joint)} at rest, take it out to judge the chain"
            )
    light = LIGHT * float(np.median([solids[i].mass for i in chain]))
    parts = list[tuple[list[Move], list[Solid]]]()
    for i in chain:
        members = [solids[i], *(one for k, one in enumerate(solids) if owner[k] == i and k != i and one.mass)]
        joined = bool(parts) and parts[-1][1][0].mass < light
        joined = joined and np.allclose(parts[-1][0][-1].at, solids[i].moves[-1].at, atol=1e-6)
        parts.append(((parts.pop()[0] if joined else []) + list(solids[i].moves), members))
    places = np.array([moves[-1].at for moves, _ in parts])
    along = places[-1] - places[0]
    if len(parts) < 2 or not along.any():
        raise InputError(f"{name}: a chain has two moving links or more, it has {len(parts)}")
    along /= np.linalg.norm(along)
    mains = [members[0] for _, members in parts]
    per_length = np.median([one.mass for one in mains[:-1]] / np.diff(places @ along))
    base = solids[solids[chain[0]].parent] if solids[chain[0]].parent >= 0 else None
    if base is not None and (reach := float((places[0] - base.origin) @ along)) > 0.0:
        if abs(base.mass / reach / per_length - 1.0) < 0.05:  # it is the first link of the beam, fixed to the wall
            parts.insert(0, ([], [base]))
            mains.insert(0, base)
            places = np.vstack([base.origin, places])
    x, centres = (places - places[0]) @ along, np.array([one.centre for one in mains])
    off = [places - places[0] - np.outer(x, along), centres - places - np.outer((centres - places) @ along, along)]
    if max(np.linalg.norm(one, axis=1).max() for one in off) > STRAIGHT * x[-1]:
        raise InputError(f"{name}: its joints and centres of mass are on no straight line, give the chain at rest")
    centre = (centres - places) @ along
    last = float(centre[-1] / max(np.median(centre[:-1] / np.diff(x)), 0.1))
    drawn = float(np.abs(mains[-1].shape[1] @ along).max()) if mains[-1].shape else last
    heavy = abs(mains[-1].mass / max(last, 1e-12) / per_length - 1.0) > 0.01
    lengths = np.append(np.diff(x), drawn if heavy else last)
    hinges = [move for moves, _ in parts for move in moves if not move.slides]
    across = next((one.axis for one in hinges if abs(one.axis @ along) < STRAIGHT), None)
    turned = [along] if across is None else [across, np.cross(along, across), along]
    if any(max(abs(one.axis @ about) for about in turned) < 1.0 - STRAIGHT for one in hinges):
        raise InputError(f"{name}: its hinges are about more than three perpendicular axes, the beam's own among them")
    if any(move.slides for moves, _ in parts[1:] for move in moves):
        raise InputError(f"{name}: a joint slides inside the chain, give hinges")
    found = []
    for axis, about in zip(AXES if across is not None else AXES[2:], turned, strict=True):
        own = [[move for move in moves if not move.slides and abs(move.axis @ about) > 0.9] for moves, _ in parts]
        if not any(move.stiffness for moves in own for move in moves):
            continue
        starts = [j for j, moves in enumerate(own) if moves or not j]
        for move in (move for j in starts[1:] for move in own[j] if not move.stiffness):
            raise InputError(f"{name}: {shown(move.joint)} has no stiffness, give it a spring or weld it")
        each, bodies = [], []
        for n, (start, end) in enumerate(zip(starts, [*starts[1:], len(parts)], strict=True)):
            mass = sum(one.mass for one in mains[start:end])
            spots = [float((one.centre - places[start]) @ along) for one in mains[start:end]]
            middle = sum(one.mass * at for one, at in zip(mains[start:end], spots, strict=True)) / mass
            inertia = sum(
                about @ one.inertia @ about + (axis != "torsion") * one.mass * (at - middle) ** 2
                for one, at in zip(mains[start:end], spots, strict=True)
            )
            each.append((float(lengths[start:end].sum()), mass, middle, float(inertia)))
            bodies += [
                (n, float((one.centre - places[start]) @ along), one.mass, float(about @ one.inertia @ about))
                for _, members in parts[start:end]
                for one in members[1:]
            ]
        springs = [
            (1.0 / sum(1.0 / move.stiffness for move in own[j]) if all(move.stiffness for move in own[j]) else 0.0)
            if own[j] else np.nan
            for j in starts
        ]  # fmt: skip
        slides = any(move.slides and abs(move.axis @ np.cross(about, along)) > 0.9 for move in parts[0][0])
        names = [tuple(move.joint for move in own[j]) for j in starts]
        armatures = np.array([sum(move.armature for move in own[j]) for j in starts])
        sizes = None
        if mains[-2].shape is not None:
            width, thickness = (float(np.abs(mains[-2].shape[1] @ v).sum()) for v in (about, np.cross(about, along)))
            sizes = mains[-2].shape[0], width, thickness
        found.append(Line(axis, about, names, np.array(springs), armatures, np.array(each), bodies, slides, sizes))
    return found
