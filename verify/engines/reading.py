"""MJCF, SDF and URDF files as bodies and joints at rest.

MJCF is compiled by MuJoCo, which resolves defaults, includes and the inertias of geoms. SDF and URDF are read by the
standard library; the springs of URDF are those of Gazebo's extension.
"""

from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any, NamedTuple
from xml.etree import ElementTree

import numpy as np

from verify.arrays import Array
from verify.errors import InputError, one_line, shown
from verify.files import readable

SLIDE = "is a slide or a free base"
ROUND, BOX = (3, 5), 6
"""Types of geoms of MuJoCo: capsule, cylinder; box."""
SPIN = 1e-6
"""Negative principal inertia over the largest one that rounding of a file's digits explains."""
DRAG = "the drag of its medium is left out"
LIMITS = ("lower", "-"), ("upper", "")
"""Ends of the range of a joint and the sign of their defaults."""


class Move(NamedTuple):
    """A hinge at a place, m, about an axis in the world; `bound`: what acts on it besides its spring and dashpot.

    `damping`: N m s, `armature`: inertia of the hinge, kg m^2. A ball joint is three hinges of one name and stiffness.
    """

    joint: str
    at: Array
    axis: Array
    stiffness: float
    bound: str = ""
    damping: float = 0.0
    armature: float = 0.0


class Solid(NamedTuple):
    """A rigid body in the world: parent (-1: the world), origin, mass, centre, inertia about it (3, 3).

    What is drawn for it: `radius` of the cylinder or capsule, m, else 0; `shape`: squares of half lengths, (3, 3).
    """

    name: str
    parent: int
    origin: Array
    mass: float
    centre: Array
    inertia: Array
    moves: tuple[Move, ...]
    radius: float = 0.0
    shape: Array = np.zeros((3, 3))


class Setting(NamedTuple):
    """Engine, integrator and time step, s, of a simulation; '' and nan: unknown. `note`: what is left out.

    `viscosity`: N s/m^2 of the medium, as of `RigidChain`.
    """

    engine: str = ""
    integrator: str = ""
    step: float = np.nan
    note: str = ""
    viscosity: float = 0.0


def read(path: Path) -> tuple[str, list[Solid], Array, Setting]:
    """(root element: mujoco, sdf or robot; bodies, each after its parent; gravity, m/s^2; setting). Raises InputError.

    Gravity of URDF, and of SDF without a world, is that of an empty world.
    """
    gravity, setting = np.array([0.0, 0.0, -9.81]), Setting()
    readable(path, "file")
    try:
        root = ElementTree.parse(path).getroot()
        if root.tag == "mujoco":
            solids, gravity, setting = _mjcf(path, root)
        elif root.tag == "sdf":
            solids = _xml(next(root.iter("model"), root), None)
            world = next(root.iter("world"), root)
            gravity = np.array(_numbers(world, "gravity", "0 0 -9.81", 3))
            # Gazebo classic runs type ode, which later versions take for any
            engine = "Gazebo" if world.find("physics[@type='dart']") is not None else ""
            setting = Setting(engine, "", float(_value(world, "physics/max_step_size") or np.nan))
        elif root.tag == "robot":
            solids = _xml(root, {one.get("reference", ""): one for one in root.findall("gazebo[springStiffness]")})
        else:
            raise InputError(f"its root element is {shown(root.tag)}, give MJCF, SDF or URDF")
        _check(solids)
    except InputError as error:
        raise InputError(f"{path.name}: {error}") from None
    except (OSError, SyntaxError, ValueError, LookupError, TypeError, RuntimeError) as error:
        why = f"{error} is named and is not there" if isinstance(error, LookupError) else one_line(str(error))
        raise InputError(f"{path.name}: not readable ({why}): correct it there, or write it anew") from None
    return root.tag, solids, gravity, setting


def _check(solids: list[Solid]) -> None:
    """Raise InputError for values that no body and no spring has."""
    if not any(one.moves for one in solids):
        raise InputError("it has no joints, give a chain of bodies with hinges and springs")
    for one in solids:
        for move in one.moves:
            for name, value, unit in (("stiffness", move.stiffness, "N m/rad"), ("damping", move.damping, "N m s")):
                if not 0.0 <= value < np.inf:
                    raise InputError(f"joint {shown(move.joint)}: {name} = {value!r}, give {unit}, 0 or more")
        if not (0.0 <= one.mass < np.inf and np.isfinite(one.inertia).all() and np.isfinite(one.centre).all()):
            raise InputError(f"{shown(one.name)}: its mass or inertia is negative or no number, give kg and kg m^2")
        if (spin := np.linalg.eigvalsh(one.inertia))[0] < -SPIN * spin[-1]:
            text = f"its inertia has the principal value {spin[0]:.3g} kg m^2, give none below 0"
            raise InputError(f"{shown(one.name)}: {text}")


def _compiled(path: Path, root: ElementTree.Element) -> Any:
    """MuJoCo's model of a file. Raises InputError."""
    try:
        import mujoco
    except ImportError:
        raise InputError("MJCF is compiled by MuJoCo, install it: pip install mujoco") from None
    for one in root.iter():
        for key, value in one.attrib.items():
            if key != "name" and {"nan", "+nan", "-nan"} & {*value.lower().split()}:
                name = one.get("name") or next(above.get("name", "") for above in root.iter() if one in [*above])
                raise InputError(f"{one.tag} {shown(name)}: {key} = {shown(value)}, give finite numbers")
    try:
        model = mujoco.MjModel.from_xml_path(str(path.resolve()))
    except ValueError as error:
        text = one_line(", ".join(str(error).split("\n"))).rstrip(", ").removeprefix("XML ").removeprefix("Error: ")
        if root.find(".//composite") is not None:
            text = "composite, which MuJoCo 4 lacks: write its bodies and joints out by mj_saveLastXML of MuJoCo 3"
        elif "mujoco.elasticity" in text:
            text = "the plugin of cables, which MuJoCo 4 lacks: give joints with stiffness EI/l and GJ/l in its place"
        raise InputError(f"MuJoCo does not compile it, {text}") from None
    bits = mujoco.mjtDisableBit
    off = {bits.mjDSBL_SPRING: model.jnt_stiffness, bits.mjDSBL_DAMPER: model.dof_damping}
    for bit, values in (off | {bits.mjDSBL_GRAVITY: model.opt.gravity}).items():
        values[:] *= not model.opt.disableflags & bit
    return model


def _mjcf(path: Path, root: ElementTree.Element) -> tuple[list[Solid], Array, Setting]:
    """The bodies at the angles where the springs have no moment, gravity, and how it runs."""
    model = _compiled(path, root)
    import mujoco

    if not model.njnt:
        return [], np.array(model.opt.gravity), Setting()
    model.opt.jacobian = mujoco.mjtJacobian.mjJAC_DENSE
    data = mujoco.MjData(model)
    data.qpos[:] = model.qpos_spring
    mujoco.mj_forward(model, data)
    springs = np.reshape(model.jnt_stiffness, (model.njnt, -1))
    dashpots = np.reshape(model.dof_damping, (model.nv, -1))
    bound = {int(dof): "has a dashpot that is not linear" for dof in np.flatnonzero(dashpots[:, 1:].any(axis=1))}
    kinds = ("has an equality", *["has dry friction"] * 2, *["is at a limit"] * 2, *["has a contact"] * 9)
    for kind, row in zip(data.efc_type, np.reshape(data.efc_J, (-1, model.nv)), strict=False):
        bound |= {int(dof): kinds[kind] for dof in np.flatnonzero(abs(row) > 1e-9)}  # else rounding within a loop
    for i, at in enumerate(model.tendon_adr):
        acts, joints = model.tendon_stiffness[i], model.wrap_objid[at : at + model.tendon_num[i]]
        acts = np.any(acts) or np.any(model.tendon_damping[i])
        bound |= {int(model.jnt_dofadr[j]): "has a tendon" for j in joints if acts}
    for i, bias in enumerate(model.actuator_biasprm):
        if bias[1:3].any() and model.actuator_trntype[i] == 0:
            bound[int(model.jnt_dofadr[model.actuator_trnid[i, 0]])] = "has an actuator with a stiffness or a damping"

    def moves(body: int) -> Iterator[Move]:
        for j in range(int(model.body_jntadr[body]), int(model.body_jntadr[body] + model.body_jntnum[body])):
            kind, dof = int(model.jnt_type[j]), int(model.jnt_dofadr[j])
            for i, axis in enumerate([data.xaxis[j]] if kind > 1 else data.xmat[body].reshape(3, 3).T):
                name, at, slide = model.joint(j).name or f"joint #{j}", data.xanchor[j].copy(), SLIDE * (kind in (0, 2))
                damping, armature = float(dashpots[dof + i, 0]), float(model.dof_armature[dof + i])
                yield Move(name, at, axis.copy(), float(springs[j, 0]), bound.get(dof + i, slide), damping, armature)

    solids = []
    for b in range(1, model.nbody):
        own = data.ximat[b].reshape(3, 3)
        with np.errstate(invalid="ignore"):  # refused by `_check`
            inertia = (own * model.body_inertia[b]) @ own.T
        place, up = data.xpos[b].copy(), int(model.body_parentid[b]) - 1
        name, mass = model.body(b).name or f"body {b}", float(model.body_mass[b])
        radius, shape = 0.0, np.zeros((3, 3))
        for i in range(model.body_geomadr[b], model.body_geomadr[b] + model.body_geomnum[b]):
            half, turn = np.array(model.geom_size[i]), data.geom_xmat[i].reshape(3, 3)
            if round_one := int(model.geom_type[i]) in ROUND:
                half, radius = half[[0, 0, 1]], max(radius, float(half[0]))
            if round_one or model.geom_type[i] == BOX:
                shape = max(shape, (turn * half**2) @ turn.T, key=np.trace)
        own_moves, centre = tuple(moves(b)), data.xipos[b].copy()
        solids.append(Solid(name, up, place, mass, centre, inertia, own_moves, radius, shape))
    rule = mujoco.mjtIntegrator(model.opt.integrator).name.removeprefix("mjINT_")
    if rule == "EULER" and model.opt.disableflags & mujoco.mjtDisableBit.mjDSBL_EULERDAMP:
        rule = "Euler without eulerdamp"
    # a body is dragged as the box of its inertia, here a cube; in Euler explicitly, unlike the dashpots
    alike = np.ptp(model.body_inertia, axis=1).max() < 1e-9 * model.body_inertia.max() and not model.opt.density
    viscosity = float(model.opt.viscosity) if alike and not rule.lower().startswith("euler") else 0.0
    lost = model.opt.density or model.opt.viscosity > viscosity
    notes = [*[DRAG] * bool(lost), *_turned(model)]
    setting = Setting("MuJoCo", rule, float(model.opt.timestep), "; ".join(notes), viscosity)
    return solids, np.array(model.opt.gravity), setting


def _turned(model: Any) -> list[str]:
    """What to know of a chain that is drawn elsewhere than where its springs are at rest, or nothing."""
    turned = abs(model.qpos_spring - model.qpos0)[model.jnt_qposadr]
    at, count = int(turned.argmax()), int(np.sum(turned > 1e-9))
    name = f"{shown(model.joint(at).name or f'joint #{at}')}{f' and {count - 1} more' * (count > 1)}"
    text = f"springref or ref turns {name} by up to {np.degrees(turned[at]):.3g} degrees from the drawing"
    return [f"judged where its springs are at rest: {text}"] * bool(count)


def _value(one: ElementTree.Element | None, path: str) -> str:
    """An attribute (URDF) or the text of an element (SDF), '' where missing."""
    head, _, last = path.rpartition("/")
    at = one.find(head) if one is not None and head else one
    return "" if at is None else at.get(last) or (at.findtext(last) or "").strip()


def _numbers(one: ElementTree.Element, path: str, default: str, *counts: int) -> list[float]:
    """As many finite numbers as one of `counts`, by default 1. Raises InputError."""
    words = _value(one, path) or default
    try:
        values = [float(word) for word in words.split()]
    except ValueError:
        values = []
    if len(values) not in (counts or (1,)) or not np.isfinite(values).all():
        remedy = " or ".join(map(str, counts)) + " finite numbers" if counts else "a finite number"
        raise InputError(f"{one.tag} {shown(one.get('name', ''))}: {path} = {shown(words)}, give {remedy}")
    return values


def _pose(one: ElementTree.Element, within: str = "") -> Array:
    """The transformation (4, 4) of an element's origin (URDF) or pose (SDF): x y z, roll pitch yaw."""
    if _value(one, within + "pose"):
        x, y, z, roll, pitch, yaw = [*_numbers(one, within + "pose", "", 6, 3), 0.0, 0.0, 0.0][:6]
    else:
        (x, y, z), (roll, pitch, yaw) = (_numbers(one, f"{within}origin/{key}", "0 0 0", 3) for key in ("xyz", "rpy"))
    pose, unit = np.eye(4), np.pi / 180.0 if _value(one, within + "pose/degrees") == "true" else 1.0
    for angle, i, k in ((yaw, 0, 1), (pitch, 2, 0), (roll, 1, 2)):
        turn, c, s = np.eye(4), np.cos(unit * angle), np.sin(unit * angle)
        turn[[i, k, i, k], [i, k, k, i]] = c, c, -s, s
        pose = pose @ turn
    pose[:3, 3] = x, y, z
    return pose


def _named(model: ElementTree.Element, tag: str, mark: str = "") -> dict[str, ElementTree.Element]:
    """Elements by `mark` and name. Raises InputError where a name is missing or there twice."""
    found = dict[str, ElementTree.Element]()
    for i, one in enumerate(model.findall(tag), 1):
        if not (name := one.get("name", "")) or mark + name in found:
            raise InputError(f"{tag} {i} has {'the name of another' if name else 'no name'}, give each its own")
        found[mark + name] = one
    return found


def _xml(model: ElementTree.Element, springs: dict[str, ElementTree.Element] | None) -> list[Solid]:
    """The links of a model of SDF, or of URDF with `springs` of its joints."""
    mark = "" if springs is None else "joint "  # in URDF a joint may have the name of a link
    links, joints = _named(model, "link"), _named(model, "joint", mark)
    above, bases, below = dict[str, tuple[str, str]](), dict[str, str](), dict[str, list[str]]()
    for key, one in joints.items():
        ends = [_value(one, f"{end}/link") or _value(one, end) for end in ("parent", "child")]
        for end, name in zip(("parent", "child"), ends, strict=True):
            if name not in links and (end, name) != ("parent", "world"):
                text = f"its {end} is {shown(name)}" if name else f"it has no {end}"
                raise InputError(f"joint {shown(one.get('name', ''))}: {text}, give the name of a link")
        if ends[1] in above:
            raise InputError(f"link {shown(ends[1])} is the child of two joints: closed loops are not read, open them")
        above[ends[1]], bases[key] = (key, ends[0]), ends[springs is None]
    frames = _named(model, "frame")
    bases |= {key: one.get("attached_to", "") for key, one in frames.items()}
    bases |= {} if springs is None else {child: key for child, (key, _) in above.items()}
    place = _places(frames | joints | links, bases)
    for key in links:
        below.setdefault(above.get(key, ("", "" if key == "world" else "world"))[1], []).append(key)
    order = [*below.get("", []), *below.get("world", [])]
    for key in order:  # grows
        order += below.get(key, []) if key != "world" else []
    if len(order) < len(links):
        raise InputError(f"link {shown(min(set(links) - set(order)))}: its joints lead round to itself, open the loop")
    number = {key: i for i, key in enumerate(order)}
    solids = list[Solid]()
    for key in order:
        at, one, (joint, parent) = place(key), links[key], above.get(key, ("", ""))
        mass, moves = _numbers(one, "inertial/mass/value" if springs is not None else "inertial/mass", "0")[0], []
        if joint and joints[joint].get("type", "") != "fixed":
            if not mass:
                raise InputError(f"link {shown(key)} has no inertial and a mesh no mass, give mass and inertia")
            moves = list(_moves(joints[joint], joint, place, springs))
        centre = at @ _pose(one, "inertial/")
        six = np.ravel([_numbers(one, f"inertial/inertia/i{d}", "0") for d in ("xx", "xy", "xz", "yy", "yz", "zz")])
        inertia = centre[:3, :3] @ six[[[0, 1, 2], [1, 3, 4], [2, 4, 5]]] @ centre[:3, :3].T
        radii = [_numbers(shape, "radius", "0")[0] for kind in ("cylinder", "capsule") for shape in one.iter(kind)]
        radius, up = max(radii, default=0.0), number.get(parent, -1)
        solids.append(Solid(key, up, at[:3, 3], mass, centre[:3, 3], inertia, tuple(moves), radius))
    return solids


def _places(every: dict[str, ElementTree.Element], bases: dict[str, str]) -> Callable[[str], Array]:
    """The place (4, 4) in the model by the name of a frame; `bases`: frames that they are in without a name of one."""
    known, above = dict.fromkeys(("", "__model__", "world"), np.eye(4)), list[str]()

    def place(frame: str) -> Array:
        if frame not in known:
            if frame not in every:
                raise InputError(f"{shown(above[-1])} is placed in the frame {shown(frame)}, which is missing")
            if frame in above:
                raise InputError(f"the frames {', '.join(map(shown, above))} are placed in each other, open the loop")
            above.append(frame)
            base = _value(every[frame], "pose/relative_to") or bases.get(frame, "")
            known[frame] = place(base) @ _pose(every[frame])
            above.pop()
        return known[frame]

    return place


def _moves(
    joint: ElementTree.Element, key: str, place: Callable[[str], Array], springs: dict[str, ElementTree.Element] | None
) -> Iterator[Move]:
    """The hinges of a joint of SDF, or of URDF with `springs`; the second of a universal joint is 'name axis2'."""
    name, kind, at = joint.get("name", ""), joint.get("type", ""), place(key)
    if kind not in ("revolute", "continuous", "prismatic", "universal"):
        raise InputError(f"joint {shown(name)} is of type {shown(kind)}, give hinges in its place")
    for axis in ("axis", "axis2")[: 1 + (kind == "universal")]:
        bound, within = SLIDE * (kind == "prismatic"), f"{axis}/" if springs is None else ""
        old = "__model__" * (_value(joint, f"{axis}/use_parent_model_frame") in ("1", "true"))
        frame = place(_value(joint, f"{axis}/xyz/expressed_in") or old or key)
        about = frame[:3, :3] @ _numbers(joint, f"{axis}/xyz", "0 0 1" if springs is None else "1 0 0", 3)
        if not (size := np.linalg.norm(about)):
            raise InputError(f"joint {shown(name)}: {axis}/xyz is zero, give a direction")
        one, paths = joint, [f"{axis}/dynamics/spring_{word}" for word in ("stiffness", "reference")]
        if springs is not None:
            one, paths = springs.get(name, joint), ["springStiffness", "springReference"]
        stiffness, reference = (_numbers(one, path, "0")[0] for path in paths)
        low, high = (_numbers(joint, f"{within}limit/{end}", f"{sign}1e16")[0] for end, sign in LIMITS)
        at_limit, rubs = low >= 0.0 or high <= 0.0, _numbers(joint, f"{within}dynamics/friction", "0")[0]
        bound = bound or "is at a limit" * (kind != "continuous" and at_limit) or "has dry friction" * bool(rubs)
        bound = bound or "follows another by mimic" * (joint.find(".//mimic") is not None)
        bound = bound or f"has a spring at rest at {reference:.4g} rad" * bool(stiffness and reference)
        damping = _numbers(joint, f"{within}dynamics/damping", "0")[0]
        yield Move(name + " axis2" * (axis == "axis2"), at[:3, 3], about / size, stiffness, bound, damping)
