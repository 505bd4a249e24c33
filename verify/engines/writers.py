"""A `RigidChain` as a file of an engine: MJCF, SDF, URDF, scripts for Exudyn and Pinocchio, JSON, CSV."""

from collections.abc import Callable, Iterator
from pathlib import Path
from typing import NamedTuple

import numpy as np

from verify.arrays import Array
from verify.engines.description import Axis, Link, RigidChain
from verify.errors import InputError, shown
from verify.files import writable_folder, write_whole
from verify.problem.cross_section import merged, set_fields
from verify.report.result import Column, Table, to_json

DIRECTIONS: dict[Axis, str] = {"bending": "0 -1 0", "width": "0 0 1", "torsion": "1 0 0"}
SLIDES: dict[Axis, str] = {"bending": "0 0 1", "width": "0 1 0"}
COLOURS = "0.18 0.50 0.93 1", "0.95 0.61 0.14 1"
DEEPEST = 496
"""Largest number of nested bodies that MuJoCo's reader takes."""
MASSLESS = 1e-10
"""Mass and inertia of a body between two hinges at one place over those of a link, for formats that demand one."""
MODES = 3


class Motion(NamedTuple):
    """One degree of freedom of the tree: a body that moves against its parent."""

    name: str
    kind: str
    """revolute or prismatic."""
    direction: str
    body: str
    parent: str
    offset: float
    """x in the parent, m."""
    stiffness: float
    damping: float
    link: int | None
    """The link that the body is; None between hinges at one place."""


def tree(chain: RigidChain) -> Iterator[Motion]:
    """The tree in motions of one degree of freedom, from joint 0 on."""
    parent, offset = "world", chain.joints[0].position
    for j, joint in enumerate(chain.joints[:-1]):
        own = [(f"slide_{axis}", "prismatic", SLIDES[axis], 0.0, 0.0) for axis in SLIDES if axis in chain.axes]
        moves = own if j == 0 and not chain.held[0] else []
        moves += [(f"joint{j}_{h.axis}", "revolute", DIRECTIONS[h.axis], h.stiffness, h.damping) for h in joint.hinges]
        for i, (name, kind, direction, stiffness, damping) in enumerate(moves):
            last = i == len(moves) - 1
            body = f"link{j}" if last else f"link{j}_{name}"
            yield Motion(name, kind, direction, body, parent, offset, stiffness, damping, j if last else None)
            parent, offset = body, 0.0
        offset = chain.links[j].length


def loaded(chain: RigidChain, index: int) -> Link:
    """A link together with the bodies on it."""
    link = chain.links[index]
    own = [(link.mass, link.centre, link.inertia)]
    own += [(b.mass, b.position - link.start, (b.inertia,) * 3) for b in chain.bodies if b.link == index]
    mass = sum(m for m, _, _ in own)
    centre = sum(m * x for m, x, _ in own) / mass
    spread = sum(m * (x - centre) ** 2 for m, x, _ in own)
    xx, yy, zz = (sum(inertia[i] for _, _, inertia in own) for i in range(3))
    return Link(link.start, link.length, mass, centre, (xx, yy + spread, zz + spread))


def notes(chain: RigidChain) -> list[str]:
    """What the chain is, and what it is expected to show: a line each."""
    beam = chain.beam
    end = ", joint 0 at the right end of the beam" if chain.mirrored else ""
    lines = [
        f"beam {beam.supports[0]}-{beam.supports[1]}, length {beam.length!r} m, {chain.count} rigid links, SI units",
        f"x along the beam, z the deflection, wall {chain.wall}{end}",
    ]
    for axis in chain.axes:
        hertz = chain.frequencies_hz(axis, MODES)
        modes = ", ".join(f"{f:.9g} ({e:+.2e})" for f, e in zip(hertz, chain.errors(axis, MODES), strict=True))
        lines.append(f"expected frequencies in {axis}, Hz (relative error against the exact beam): {modes}")
    if chain.damping:
        lines.append(f"dashpots in proportion to the springs: damping ratio {chain.damping!r} in mode 1, more beyond")
    if chain.held[1] or any(far.stiffness for far in chain.joints[-1].hinges) or chain.springs:
        lines.append("small motion: supports of the far end and springs to the ground act along z (and y)")
    return lines


def mjcf(chain: RigidChain, step: float | None = None) -> str:
    """The chain for MuJoCo; `step`, s, by default one radian of its highest frequency.

    Springs to the ground and the supports of the far end are fixed tendons, linear in the angles; a support is an
    equality, as stiff as the engine allows. Raises InputError for too many links.
    """
    if chain.count > DEEPEST:
        raise InputError(f"count = {chain.count}: MuJoCo reads at most {DEEPEST} nested bodies, lower it")
    if step is None:
        step = float(f"{1.0 / (2.0 * np.pi * max(chain.frequencies_hz(axis)[-1] for axis in chain.axes)):.1e}")
    moves, bodies = list(tree(chain)), ""
    for j in range(chain.count):
        link, own = (
            loaded(chain, j),
            [one for one in moves if one.body == f"link{j}" or one.body.startswith(f"link{j}_")],
        )
        joints = "".join(
            f'<joint name="{one.name}" type="{"slide" if one.kind == "prismatic" else "hinge"}" axis="{one.direction}" '
            f'stiffness="{one.stiffness!r}" damping="{one.damping!r}"/>'
            for one in own
        )
        bodies += (
            f'<body name="link{j}" pos="{own[0].offset!r} 0 0">{joints}\n<inertial pos="{link.centre!r} 0 0" '
            f'mass="{link.mass!r}" diaginertia="{_three(link.inertia)}"/>'
            f'<geom type="box" pos="{0.5 * link.length!r} 0 0" size="{_three(_sizes(chain, j, 0.5))}" contype="0" '
            f'conaffinity="0" rgba="{COLOURS[j % 2]}"/>\n'
        )
    bodies += f'<site name="tip" pos="{chain.links[-1].length!r} 0 0"/>' + "</body>" * chain.count

    def tendon(name: str, axis: Axis, row: Array, values: str = "") -> str:
        names = [f"slide_{axis}"] * chain.slides(axis) + [f"joint{j}_{axis}" for j, _ in chain.hinges(axis)]
        coefs = "".join(f'<joint joint="{n}" coef="{c!r}"/>' for n, c in zip(names, row.tolist(), strict=True) if c)
        return f'<fixed name="{name}"{values}>{coefs}</fixed>\n'

    tendons, equalities = "", ""
    for name, axis, row, stiffness, damping in grounded(chain):
        tendons += tendon(name, axis, row, f' stiffness="{stiffness!r}" damping="{damping!r}" springlength="0"')
    for axis in chain.axes:
        for row in chain.constraints(axis):
            tendons += tendon(f"support_{axis}", axis, row)
            equalities += (
                f'<tendon name="support_{axis}" tendon1="support_{axis}" solref="{2 * step!r} 1" '
                'solimp="0.9999 0.9999 0.001 0.5 2"/>'
            )
    return (
        f"<mujoco>\n<!--\n{_lines(chain)}\n-->\n"
        '<compiler angle="radian" inertiafromgeom="false" boundmass="0" boundinertia="0"/>\n'
        f'<option timestep="{step!r}" integrator="{"implicitfast" if chain.damping else "RK4"}" gravity="0 0 0" '
        'solver="PGS" jacobian="dense" iterations="20" tolerance="1e-14"><flag contact="disable"/></option>\n'
        f'<size memory="200M"/>\n<worldbody>\n{bodies}\n</worldbody>\n'
        + (f"<tendon>{tendons}</tendon>\n" if tendons else "")
        + (f"<equality>{equalities}</equality>\n" if equalities else "")
        + "</mujoco>\n"
    )


def grounded(chain: RigidChain) -> Iterator[tuple[str, Axis, Array, float, float]]:
    """(name, axis, row over the unknowns, stiffness, damping) of springs to the ground and joint N."""
    for i, one in enumerate(chain.springs):
        across, turned = chain.rows("bending", [one.link], [one.position])
        if one.stiffness:
            yield f"spring{i}", "bending", across[0], one.stiffness, one.damping
        if one.rotational:
            yield f"spring{i}_rotational", "bending", turned[0], one.rotational, one.rotational_damping
    for hinge in chain.joints[-1].hinges:
        if hinge.stiffness:
            row = chain.rows(hinge.axis, [chain.count - 1], [chain.joints[-1].position])[1][0]
            yield f"joint{chain.count}_{hinge.axis}", hinge.axis, row, hinge.stiffness, hinge.damping


def sdf(chain: RigidChain) -> str:
    """The chain for Gazebo and Drake: `spring_stiffness` on every joint."""
    text = f'<?xml version="1.0"?>\n<!--\n{_lines(chain)}\n-->\n<sdf version="1.9"><model name="beam">\n'
    for one in tree(chain):
        frame = "__model__" if one.parent == "world" else one.parent
        text += (
            f'<link name="{one.body}"><pose relative_to="{frame}">{one.offset!r} 0 0 0 0 0</pose>'
            f"{_inertial(chain, one, 'sdf')}</link>\n"
            f'<joint name="{one.name}" type="{one.kind}"><parent>{one.parent}</parent><child>{one.body}</child><axis>'
            f"<xyz>{one.direction}</xyz><limit><lower>-1e16</lower><upper>1e16</upper></limit><dynamics>"
            f"<damping>{one.damping!r}</damping><spring_reference>0</spring_reference>"
            f"<spring_stiffness>{one.stiffness!r}</spring_stiffness></dynamics></axis></joint>\n"
        )
    tip = f'<frame name="tip" attached_to="link{chain.count - 1}"><pose>{chain.links[-1].length!r} 0 0 0 0 0</pose>'
    return f"{text}{tip}</frame>\n</model></sdf>\n"


def urdf(chain: RigidChain) -> str:
    """The chain for ROS and Pinocchio: the tree and its dashpots, without springs."""
    text = f'<?xml version="1.0"?>\n<!--\n{_lines(chain)}\n-->\n<robot name="beam">\n<link name="world"/>\n'
    for one in tree(chain):
        text += (
            f'<link name="{one.body}">{_inertial(chain, one, "urdf")}</link>\n'
            f'<joint name="{one.name}" type="{one.kind}"><parent link="{one.parent}"/><child link="{one.body}"/>'
            f'<origin xyz="{one.offset!r} 0 0"/><axis xyz="{one.direction}"/><dynamics damping="{one.damping!r}"/>'
            '<limit lower="-3.14" upper="3.14" effort="1e9" velocity="1e9"/></joint>\n'
        )
    joint = f'<joint name="tip" type="fixed"><parent link="link{chain.count - 1}"/><child link="tip"/>'
    return f'{text}<link name="tip"/>\n{joint}<origin xyz="{chain.links[-1].length!r} 0 0"/></joint>\n</robot>\n'


def _inertial(chain: RigidChain, one: Motion, language: str) -> str:
    """Inertia and shape of a body of the tree."""
    whole = loaded(chain, int(one.body.partition("_")[0].removeprefix("link")))
    scale = MASSLESS if one.link is None else 1.0
    mass, inertia = scale * whole.mass, [scale * value for value in whole.inertia]
    centre = 0.0 if one.link is None else whole.centre
    names = [f"i{a}{b}" for a, b in ("xx", "yy", "zz", "xy", "xz", "yz")]
    values = dict(zip(names, [*inertia, 0.0, 0.0, 0.0], strict=True))
    size = _three(_sizes(chain, one.link or 0, 1.0))
    if language == "urdf":
        table = " ".join(f'{name}="{value!r}"' for name, value in values.items())
        inertial = f'<origin xyz="{centre!r} 0 0"/><mass value="{mass!r}"/><inertia {table}/>'
        look = f'<origin xyz="{0.5 * whole.length!r} 0 0"/><geometry><box size="{size}"/></geometry>'
        look += (
            f'<material name="colour{(one.link or 0) % 2}"><color rgba="{COLOURS[(one.link or 0) % 2]}"/></material>'
        )
    else:
        table = "".join(f"<{name}>{value!r}</{name}>" for name, value in values.items())
        inertial = f"<pose>{centre!r} 0 0 0 0 0</pose><mass>{mass!r}</mass><inertia>{table}</inertia>"
        look = f"<pose>{0.5 * whole.length!r} 0 0 0 0 0</pose><geometry><box><size>{size}</size></box></geometry>"
        look += f"<material><diffuse>{COLOURS[(one.link or 0) % 2]}</diffuse></material>"
    visual = "" if one.link is None else f'<visual name="{one.body}">{look}</visual>'
    return f"<inertial>{inertial}</inertial>{visual}"


def _three(values: tuple[float, ...] | list[float]) -> str:
    return " ".join(map(repr, values))


def _lines(chain: RigidChain) -> str:
    return "\n".join(notes(chain))


def _sizes(chain: RigidChain, index: int, scale: float) -> list[float]:
    """Length, width and thickness of a link to be drawn, m; a hundredth of its length where unknown."""
    link, beam = chain.links[index], chain.beam
    pieces = np.cumsum([section.length for section in beam.section])
    piece = int(np.searchsorted(pieces, link.start + 0.5 * link.length))
    fields = merged(beam.section[piece], beam) if beam.section else set_fields(beam)
    width, thickness = (fields.get(name, fields.get("diameter", 0.01 * beam.length)) for name in ("width", "thickness"))
    return [scale * link.length, scale * width, scale * thickness]


_DATA = '''"""{notes}"""

import numpy as np
{imports}

# joint, type, x in its parent, stiffness, dashpot; mass, centre and inertia of its body (xx, yy, zz about the centre)
TREE = [
{tree}]
# body, x in it, x at rest; stiffness to the ground in x, y, z and about them; dashpots
SPRINGS = [
{springs}]
# whether the far end is held in y, z
HELD = {held}
TIP = {tip}
'''
_EXUDYN = '''

def build():
    """The system, assembled."""
    system, n = exu.SystemContainer().AddSystem(), len(TREE)
    _, kinds, offsets, stiffnesses, dashpots, masses, centres, inertias = map(list, zip(*TREE))
    zeros, along = [0.0] * n, lambda xs: exu.Vector3DList([[x, 0.0, 0.0] for x in xs])
    node = system.AddNode(items.NodeGenericODE2(
        referenceCoordinates=zeros, initialCoordinates=zeros, initialCoordinates_t=zeros, numberOfODE2Coordinates=n))
    tree = system.AddObject(items.ObjectKinematicTree(
        nodeNumber=node, jointTypes=[getattr(exu.JointType, kind) for kind in kinds], linkParents=list(range(-1, n - 1)),
        jointTransformations=exu.Matrix3DList([np.eye(3)] * n), jointOffsets=along(offsets),
        linkInertiasCOM=exu.Matrix3DList([np.diag(one) for one in inertias]), linkCOMs=along(centres), linkMasses=masses,
        jointPControlVector=stiffnesses, jointDControlVector=dashpots,
        jointPositionOffsetVector=zeros, jointVelocityOffsetVector=zeros))
    ground = system.AddObject(items.ObjectGround())

    def markers(body, x, rest):
        fixed = system.AddMarker(items.MarkerBodyRigid(bodyNumber=ground, localPosition=[rest, 0.0, 0.0]))
        at = {{"objectNumber": tree, "linkNumber": body, "localPosition": [x, 0.0, 0.0]}}
        return [fixed, system.AddMarker(items.MarkerKinematicTreeRigid(**at))]

    for body, x, rest, stiffness, dashpot in SPRINGS:
        system.AddObject(items.RigidBodySpringDamper(
            markerNumbers=markers(body, x, rest), stiffness=np.diag(stiffness), damping=np.diag(dashpot)))
    if any(HELD):
        system.AddObject(items.GenericJoint(markerNumbers=markers(*TIP), constrainedAxes=[0, *HELD, 0, 0, 0]))
    system.Assemble()
    return system


def frequencies_hz(system):
    """Natural frequencies by the engine's eigenvalue solver."""
    return np.sort(system.ComputeODE2Eigenvalues(convert2Frequencies=True, useAbsoluteValues=True)[0])


if __name__ == "__main__":
    print(frequencies_hz(build())[:10])
'''
_PINOCCHIO = '''

def build():
    """The model, whose `springs` are not part of Pinocchio: see `stiffness`."""
    model, parent = pin.Model(), 0
    model.gravity = pin.Motion.Zero()
    for name, kind, offset, _, dashpot, mass, centre, inertia in TREE:
        place = pin.SE3(np.eye(3), np.array([offset, 0.0, 0.0]))
        parent = model.addJoint(parent, getattr(pin, f"JointModel{{kind[0]}}{{kind[-1]}}")(), place, name)
        body = pin.Inertia(mass, np.array([centre, 0.0, 0.0]), np.diag(inertia))
        model.appendBodyToJoint(parent, body, pin.SE3.Identity())
    model.damping = np.array([one[4] for one in TREE])
    return model


def jacobian(model, body, x):
    """Jacobian of x of a body about the straight beam, (6, n)."""
    data, q = model.createData(), pin.neutral(model)
    pin.computeJointJacobians(model, data, q)
    place = pin.SE3(np.eye(3), np.array([x, 0.0, 0.0]))
    return pin.getFrameJacobian(model, data, body + 1, place, pin.LOCAL_WORLD_ALIGNED)


def stiffness(model):
    """Stiffness matrix of the joints and of the springs to the ground: torque = -stiffness @ q."""
    matrix = np.diag([one[3] for one in TREE])
    for body, x, _, values, _ in SPRINGS:
        rows = jacobian(model, body, x)
        matrix += rows.T @ np.diag(values) @ rows
    return matrix


def frequencies_hz(model):
    """Natural frequencies of small motion, the supports of the far end as constraints."""
    mass = pin.crba(model, model.createData(), pin.neutral(model))
    mass = np.triu(mass) + np.triu(mass, 1).T
    held = jacobian(model, *TIP[:2])[1:3][np.array(HELD, dtype=bool)]
    basis = null_space(held) if len(held) else np.eye(model.nv)
    values = eigh(basis.T @ stiffness(model) @ basis, basis.T @ mass @ basis, eigvals_only=True)
    return np.sqrt(np.maximum(values, 0.0)) / (2.0 * np.pi)


if __name__ == "__main__":
    print(frequencies_hz(build())[:10])
'''
SCRIPTS = {
    "exudyn": (_EXUDYN, "import exudyn as exu\nfrom exudyn import utilities as items"),
    "pinocchio": (_PINOCCHIO, "import pinocchio as pin\nfrom scipy.linalg import eigh, null_space"),
}


def script(chain: RigidChain, engine: str) -> str:
    """A Python script with `build` and `frequencies_hz` of Exudyn or Pinocchio."""
    moves, rows, springs = list(tree(chain)), "", ""
    for one in moves:
        kind = one.kind.capitalize() + "XYZ"[[value != "0" for value in one.direction.split()].index(True)]
        whole = loaded(chain, one.link or 0)
        body = (0.0, 0.0, (0.0,) * 3) if one.link is None else (whole.mass, whole.centre, whole.inertia)
        rows += f"    {(one.name, kind, one.offset, one.stiffness, one.damping, *body)!r},\n"
    bodies = {one.link: i for i, one in enumerate(moves)}
    far = {hinge.axis: hinge for hinge in chain.joints[-1].hinges}
    each = [
        (s.link, s.position, {2: s.stiffness, 4: s.rotational}, {2: s.damping, 4: s.rotational_damping})
        for s in chain.springs
    ]
    if any(hinge.stiffness for hinge in far.values()):
        at = {"torsion": 3, "bending": 4, "width": 5}
        values = [{at[axis]: getattr(hinge, name) for axis, hinge in far.items()} for name in ("stiffness", "damping")]
        each.append((chain.count - 1, chain.joints[-1].position, *values))
    for link, x, *values in each:
        six = [tuple(value.get(i, 0.0) for i in range(6)) for value in values]
        springs += f"    {(bodies[link], x - chain.links[link].start, x, *six)!r},\n"
    held = (int(chain.held[1] and chain.in_space), int(chain.held[1]))
    text, imports = SCRIPTS[engine]
    tip = (len(moves) - 1, chain.links[-1].length, chain.joints[-1].position)
    return (_DATA + text).format(notes=_lines(chain), imports=imports, tree=rows, springs=springs, held=held, tip=tip)


def table(chain: RigidChain) -> Table:
    """Joints 0..N with the link beyond each, SI."""
    columns = [Column("joint"), Column("position", "m")]
    for axis in chain.axes:
        word = "" if chain.axes == ("bending",) else f" {axis}"
        columns += [Column(f"stiffness{word}", "N m/rad", ".6g"), Column(f"dashpot{word}", "N m s", ".4g")]
    names = (("length", "m"), ("mass", "kg"), ("centre", "m"), ("xx", "kg m2"), ("yy", "kg m2"), ("zz", "kg m2"))
    columns += [Column(f"link {name}", unit) for name, unit in names]
    rows = []
    for j, joint in enumerate(chain.joints):
        link = chain.links[j] if j < chain.count else None
        beyond = (link.length, link.mass, link.centre, *link.inertia) if link else (None,) * 6
        hinges = [joint.hinge(axis) for axis in chain.axes]
        rows.append(
            (
                j,
                joint.position,
                *(v for h in hinges for v in ((h.stiffness, h.damping) if h else (None, None))),
                *beyond,
            )
        )
    return Table("Joints, and the link beyond each", columns, rows)


def data(chain: RigidChain) -> dict[str, object]:
    """The chain as data, SI, with its expected frequencies."""
    names = ("wall", "mirrored", "damping", "joints", "links", "bodies", "springs")
    expected = {
        axis: {"frequencies_hz": chain.frequencies_hz(axis, MODES), "error": chain.errors(axis, MODES)}
        for axis in chain.axes
    }
    return {"supports": chain.beam.supports, **{name: getattr(chain, name) for name in names}, "expected": expected}


_WRITERS: dict[str, Callable[[RigidChain], str]] = {
    "xml": mjcf,
    "sdf": sdf,
    "urdf": urdf,
    "json": lambda chain: to_json(data(chain)),
    "csv": lambda chain: table(chain).csv(),
}


def write(chain: RigidChain, path: Path, engine: str | None = None) -> str:
    """Write a chain to a file by its suffix, whole or not at all; returns a sentence on what was written.

    .xml MJCF, .sdf, .urdf, .json, .csv, .py for `engine` exudyn or pinocchio. What SDF and URDF do not express is in a
    JSON file next to them. Raises InputError.
    """
    kind = path.suffix.lower().removeprefix(".")
    if kind not in (*_WRITERS, "py"):
        raise InputError(
            f"to = {shown(str(path))}: the suffix is no file type, give one of .{', .'.join(_WRITERS)}, .py"
        )
    if chain.wall == "rigid":
        raise InputError("wall = 'rigid': a first link fixed to the wall is for comparison, give another wall")
    if (kind == "py") != (engine is not None) or (engine and engine not in SCRIPTS):
        raise InputError(f"engine = {engine!r}: for a .py file give {' or '.join(SCRIPTS)}, for others none")
    writable_folder(path.parent, "to")
    write_whole(path, script(chain, engine) if engine else _WRITERS[kind](chain), "to")
    missing = ["joint stiffnesses"] * (kind == "urdf")
    missing += ["springs to the ground"] * bool(chain.springs) + ["the supports of the far end"] * (
        chain.beam.supports[1] != "free"
    )
    if kind not in ("sdf", "urdf") or not missing:
        return f"wrote {path}"
    beside = path.with_name(path.name + ".json")
    write_whole(beside, to_json(data(chain)), "to")
    return f"wrote {path}; {kind.upper()} has no {', '.join(missing)}: apply those of {beside}"
