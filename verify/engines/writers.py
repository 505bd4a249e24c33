"""A `RigidChain` as a file of an engine: MJCF, SDF, URDF, scripts for Exudyn and Pinocchio, JSON, CSV."""

from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import numpy as np

from verify.arrays import Array
from verify.engines.choice import default_steps
from verify.engines.description import Axis, RigidChain
from verify.errors import InputError, shown
from verify.files import writable_folder, write_whole
from verify.report.result import Column, Table, to_json
from verify.settings import WALLS

DIRECTIONS: dict[Axis, str] = {"bending": "0 -1 0", "width": "0 0 1", "torsion": "1 0 0"}
SLIDES: dict[Axis, str] = {"bending": "0 0 1", "width": "0 1 0"}
COLOURS = "0.18 0.50 0.93 1", "0.95 0.61 0.14 1"
DEEPEST = 496
"""Largest number of nested bodies that MuJoCo's reader takes."""
MASSLESS = 1e-11
"""Mass of a body between two hinges at one place over that of its link, in formats that demand one."""
LEAST = 2e-15, 2e-14
"""Its least mass, kg, and inertia, kg m^2, twice those that MuJoCo takes."""
MODES = 3
_SPRING = 'stiffness="{stiffness!r}" damping="{damping!r}"'
_MJCF_JOINT = f'<joint name="{{name}}" type="{{kind}}" axis="{{direction}}" {_SPRING}{{more}}/>'
_MJCF_BODY = (
    '\n<inertial pos="{centre}" mass="{mass!r}" diaginertia="{inertia[0]!r} {inertia[1]!r} {inertia[2]!r}"/>'
    '<geom type="box" contype="0" conaffinity="0" pos="{middle!r} 0 0" size="{half}" rgba="{colour}"/>\n'
)
_SDF = (
    '<sdf version="1.6"><model name="beam">\n',
    '<link name="{body}"><pose>{pose}</pose><inertial>'
    "<pose>{centre} 0 0 0</pose><mass>{mass!r}</mass><inertia><ixx>{inertia[0]!r}</ixx>"
    "<iyy>{inertia[1]!r}</iyy><izz>{inertia[2]!r}</izz><ixy>0</ixy><ixz>0</ixz><iyz>0</iyz></inertia></inertial>"
    '<visual name="{body}"><pose>{middle!r} 0 0 0 0 0</pose><geometry><box><size>{size}</size></box></geometry>'
    "<material><diffuse>{colour}</diffuse></material></visual></link>\n"
    '<joint name="{name}" type="{kind}"><parent>{parent}</parent><child>{body}</child><axis>'
    "<xyz>{direction}</xyz><limit><lower>-1e16</lower><upper>1e16</upper></limit><dynamics>"
    "<damping>{damping!r}</damping><spring_reference>0</spring_reference>"
    "<spring_stiffness>{stiffness!r}</spring_stiffness></dynamics></axis></joint>\n",
    "</model></sdf>\n",
)
_URDF = (
    '<robot name="beam">\n<link name="world"/>\n',
    '<link name="{body}"><inertial><origin xyz="{centre}"/><mass value="{mass!r}"/>'
    '<inertia ixx="{inertia[0]!r}" iyy="{inertia[1]!r}" izz="{inertia[2]!r}" ixy="0" ixz="0" iyz="0"/></inertial>'
    '<visual><origin xyz="{middle!r} 0 0"/><geometry><box size="{size}"/></geometry>'
    '<material name="{body}"><color rgba="{colour}"/></material></visual></link>\n'
    '<joint name="{name}" type="{kind}"><parent link="{parent}"/><child link="{body}"/>'
    '<origin xyz="{offset}"{turned}/><axis xyz="{direction}"/><dynamics damping="{damping!r}"/>'
    '<limit lower="-3.14" upper="3.14" effort="1e9" velocity="1e9"/></joint>\n'
    '<gazebo reference="{name}"><springStiffness>{stiffness!r}</springStiffness><springReference>0</springReference>'
    "</gazebo>\n",
    '<link name="tip"/>\n<joint name="tip" type="fixed"><parent link="{body}"/><child link="tip"/>'
    '<origin xyz="{length!r} 0 0"/></joint>\n</robot>\n',
)


def tree(chain: RigidChain, in_parts: bool = False) -> Iterator[dict[str, Any]]:
    """One degree of freedom after the other from joint 0 on: a body, its parent, the joint between them.

    The last at a joint moves the link, those before it a body almost without mass, whose inertia the link lacks where
    it is `in_parts`. `offset`: place, m, of the joint in the parent; `turn`: rotation from there to the body at rest.
    """
    parent, place, frame = "world", np.zeros(3), np.eye(3)
    for j, (joint, link) in enumerate(zip(chain.joints, chain.links, strict=False)):
        at, hinges = f"joint{j}_", joint.hinges
        moves = [(at + h.axis, "revolute", DIRECTIONS[h.axis], h.stiffness, h.damping, h.armature) for h in hinges]
        offset, halves = chain.rest(j)
        place, turn = place + frame @ offset, halves[0] @ halves[1]
        frame = frame @ turn
        if j == 0 and not chain.supported[0]:
            slides = [(axis, direction) for axis, direction in SLIDES.items() if axis in chain.axes]
            moves = [(f"slide_{axis}", "prismatic", direction, 0.0, 0.0, 0.0) for axis, direction in slides] + moves
        size, half = (" ".join(repr(scale * one) for one in (link.length, *chain.drawn(j))) for scale in (1.0, 0.5))
        small = max(MASSLESS, LEAST[1] / min(link.inertia))
        for name, kind, direction, stiffness, damping, armature in moves:
            last = name == moves[-1][0]
            whole = 1.0 - small * in_parts * (len(moves) - 1)
            body, share = (f"link{j}", whole) if last else (f"link{j}_{name}", small)
            mass = link.mass if last else max(MASSLESS * link.mass, LEAST[0])
            still, about = (turn == np.eye(3)).all(), halves[1].T @ np.array(direction.split(), dtype=float)
            yield {
                **{"name": name, "kind": kind, "axis": direction, "body": body, "parent": parent, "link": j},
                **{"direction": direction if (halves[1] == np.eye(3)).all() else numbers(about)},
                **{"turned": "" if still else f' rpy="{numbers(roll_pitch_yaw(turn))}"', "turn": turn},
                **{"pose": f"{numbers(place)} {numbers(roll_pitch_yaw(frame))}", "offset": numbers(offset)},
                **{"stiffness": stiffness, "damping": damping, "armature": armature, "last": last},
                **{"mass": mass, "centre": numbers(np.array([link.centre, *link.off]) * last), "length": link.length},
                **{"inertia": tuple(share * one for one in link.inertia)},
                **{"middle": 0.5 * link.length, "size": size, "half": half},
                **{"colour": COLOURS[j % 2]},
            }
            parent, offset, turn = body, np.zeros(3), np.eye(3)


def numbers(values: Array) -> str:
    """Numbers in a row, 0 without its point, as in files of engines."""
    return " ".join("0" if one == 0.0 else repr(one) for one in values.tolist())


def roll_pitch_yaw(turn: Array) -> Array:
    """Angles, rad, (3,), about x, then y, then z at rest, of a rotation."""
    pitch = np.arctan2(-turn[2, 0], np.hypot(turn[0, 0], turn[1, 0]))
    return np.array([np.arctan2(turn[2, 1], turn[2, 2]), pitch, np.arctan2(turn[1, 0], turn[0, 0])])


def notes(chain: RigidChain) -> str:
    """What the chain is and what it is expected to show, in lines."""
    beam, mirrored = chain.beam, ", joint 0 at the right end of the beam" * chain.mirrored
    lines = [
        f"beam {beam.supports[0]}-{beam.supports[1]}, length {beam.length!r} m, {chain.count} rigid links, SI units",
        f"x along {chain.along}, z the deflection, joints at a wall by the rule {chain.wall}{mirrored}",
    ]
    for axis in chain.motions:
        modes = zip(chain.frequencies_hz(axis, MODES), chain.errors(axis, MODES), strict=True)
        text = ", ".join(f"{hertz:.9g} ({error:+.2e})" for hertz, error in modes)
        lines.append(f"frequencies in {axis}, Hz (relative errors against {chain.reference}): {text}")
    if chain.damping:
        more = "more beyond" if not chain.viscosity else "with drag by the viscosity"
        lines.append(f"dashpots in proportion to the springs: damping ratio {chain.damping!r} in mode 1, {more}")
    if chain.steps:
        lines.append(f"time step {chain.steps.step!r} s in {chain.steps.engine} {chain.steps.integrator}".rstrip())
    lines += chain.remarks
    if chain.closed:
        lines.append("supports of the far end and springs to the ground act along z (and y): for small motion")
    return "\n".join(lines)


def mjcf(chain: RigidChain, step: float | None = None) -> str:
    """The chain for MuJoCo; `step`, s, is by default that of the chain, else of `default_steps`.

    Springs to the ground, joint N and the supports of the far end are fixed tendons, linear in the angles; a support is
    an equality, as stiff as the engine allows. Raises InputError for too many links.
    """
    if chain.count > DEEPEST:
        raise InputError(f"count = {chain.count}: MuJoCo reads at most {DEEPEST} nested bodies, lower it")
    chain = chain if chain.steps or step else default_steps(chain)
    step = step or (chain.steps.step if chain.steps else 0.0)
    rule = "implicitfast" if chain.damping else "RK4"
    if chain.steps and chain.steps.engine == "MuJoCo":
        rule = chain.steps.integrator
    rule, _, flag = rule.partition(" without ")
    from scipy.spatial.transform import Rotation

    options = f' viscosity="{chain.viscosity!r}"' if chain.viscosity else ""
    flags = f'<flag {flag}="disable"/>' if flag else ""
    bodies, begun = "", False
    for one in tree(chain):
        quaternion = numbers(Rotation.from_matrix(one["turn"]).as_quat(scalar_first=True))
        turned = f' quat="{quaternion}"' if one["turned"] else ""
        bodies += "" if begun else f'<body name="link{one["link"]}" pos="{one["offset"]}"{turned}>'
        more = f' armature="{one["armature"]!r}"' if one["armature"] else ""
        kind = "hinge" if one["kind"] == "revolute" else "slide"
        bodies += _MJCF_JOINT.format(**one | {"kind": kind, "more": more})
        bodies += _MJCF_BODY.format(**one) if one["last"] else ""
        begun = not one["last"]

    def tendon(name: str, axis: Axis, row: Array, values: str = "") -> str:
        each = zip(chain.unknowns(axis), row.tolist(), strict=True)
        coefs = "".join(f'<joint joint="{joint}" coef="{coef!r}"/>' for (joint, *_), coef in each if coef)
        return f'<fixed name="{name}"{values}>{coefs}</fixed>\n'

    tendons, equalities, closed = "", "", ""
    for axis in chain.axes:
        for name, row, stiffness, damping in chain.grounded(axis):
            tendons += tendon(name, axis, row, f' stiffness="{stiffness!r}" damping="{damping!r}" springlength="0"')
        for row in chain.constraints(axis):
            closed = ' solver="PGS" jacobian="dense" iterations="20" tolerance="1e-14"'
            tendons += tendon(f"support_{axis}", axis, row)
            stiff = f'solref="{2.0 * step!r} 1" solimp="0.9999 0.9999 0.001 0.5 2"'
            equalities += f'<tendon tendon1="support_{axis}" {stiff}/>'
    return (
        f"<mujoco>\n<!--\n{notes(chain)}\n-->\n"
        '<compiler angle="radian" inertiafromgeom="false" boundmass="0" boundinertia="0"/>\n'
        f'<option timestep="{step!r}" integrator="{rule}" gravity="0 0 0"{options}{closed}>{flags}</option>\n'
        f'<size memory="200M"/>\n<worldbody>\n{bodies}<site name="tip" pos="{chain.links[-1].length!r} 0 0"/>'
        f"{'</body>' * chain.count}\n</worldbody>\n<tendon>{tendons}</tendon>\n<equality>{equalities}</equality>\n"
        "</mujoco>\n"
    )


def robot(chain: RigidChain, text: tuple[str, str, str]) -> str:
    """The chain in SDF, for Gazebo and Drake, or in URDF, whose springs are an extension of Gazebo, by its texts."""
    head, body, tail = text
    moves = list(tree(chain, in_parts=True))
    bodies = "".join(body.format(**one) for one in moves)
    return f'<?xml version="1.0"?>\n<!--\n{notes(chain)}\n-->\n{head}{bodies}{tail.format(**moves[-1])}'


def script(chain: RigidChain, engine: str) -> str:
    """A Python script with `build` and `frequencies_hz` of Exudyn or Pinocchio: data, then a fixed text."""
    moves, rows, springs, poses, before = list(tree(chain, in_parts=True)), "", "", "", np.eye(3)
    for i, one in enumerate(moves):
        kind = one["kind"].capitalize() + "XYZ"[[value != "0" for value in one["axis"].split()].index(True)]
        (offset, (turn, after)), first = chain.rest(one["link"]), not i or moves[i - 1]["link"] != one["link"]
        at = chain.links[one["link"]].centre * one["last"]
        values = [one["stiffness"], one["damping"], one["mass"], at, one["inertia"]]
        rows += f"    {(one['name'], kind, float(offset[0] * first), *values)!r},\n"
        if not chain.straight:
            place, turned = (before @ offset, before @ turn) if first else (np.zeros(3), np.eye(3))
            centre = after @ np.array(one["centre"].split(), dtype=float)
            inertia = after @ np.diag(one["inertia"]) @ after.T
            poses += f"    {i}: {tuple(each.tolist() for each in (place, turned, centre, inertia))!r},\n"
            before = after
    bodies = {one["link"]: i for i, one in enumerate(moves)}
    each = [(s.link, s.position, 4 if s.rotational else 2, s.stiffness, s.damping) for s in chain.springs]
    end, about = chain.joints[-1], {"torsion": 3, "bending": 4, "width": 5}
    each += [(chain.count - 1, end.position, about[h.axis], h.stiffness, h.damping) for h in end.hinges]
    for link, x, i, *pair in each:
        if pair[0]:
            six = [tuple(value * (k == i) for k in range(6)) for value in pair]
            springs += f"    {(bodies[link], x - chain.links[link].start, x, *six)!r},\n"
    fixed = (int(chain.supported[1] and chain.in_space), int(chain.supported[1]))
    tip = (len(moves) - 1, chain.links[-1].length, end.position)
    shift = min(float(chain.frequencies_hz(axis, 1)[0]) for axis in chain.motions) ** 2 * 40.0
    text = (Path(__file__).parent / f"{engine}_script.txt").read_text(encoding="utf-8")
    return (
        f'"""{notes(chain)}"""\n\nimport numpy as np\n\n'
        "# joint, type, x in its parent, stiffness, dashpot; mass, centre, inertia (xx, yy, zz about it) of its body\n"
        f"TREE = [\n{rows}]\n# by row, with the axes of the joints: place, rotation in the parent; centre, inertia\n"
        f"POSES = {{{chr(10) * bool(poses)}{poses}}}\n"
        "# body, x in it, x at rest; stiffness to the ground in x, y, z and about them; dashpots\n"
        f"SPRINGS = [\n{springs}]\n# whether the far end is fixed in y, z; its body, x in it, x at rest\n"
        f"SUPPORTED = {fixed}\nTIP = {tip}\n# of omega^2, about the lowest elastic one\nSHIFT = {shift:.3g}\n\n{text}"
    )


def table(chain: RigidChain) -> Table:
    """Joints 0..N with the link beyond each, SI, but for rest angles; in a plane a link has one inertia."""
    word, heavy = " {}" if chain.in_space else "", any(h.armature for joint in chain.joints for h in joint.hinges)
    damped, names = bool(chain.damping), ("stiffness", "damping", "armature")
    fields = [name for name, shown in zip(names, (True, damped, heavy), strict=True) if shown]
    columns = [Column("joint"), Column("position", "m")]
    for axis in chain.axes:
        columns += [Column("stiffness" + word.format(axis), "N m/rad", ".6g")]
        columns += [Column("dashpot" + word.format(axis), "N m s", ".4g")] * damped
        columns += [Column("armature" + word.format(axis), "kg m2", ".4g")] * heavy
    columns += [Column("rest angle", "deg", ".5g")] * (not chain.straight)
    columns += [Column("length", "m"), Column("mass", "kg"), Column("centre", "m")]
    across = (not chain.straight) * ["y", "z"][not chain.in_space :]
    columns += [Column(f"centre {one}", "m") for one in across]
    columns += [Column("inertia" + word.format(one), "kg m2") for one in ("xx", "yy", "zz")[: 3 if word else 1]]
    rows = list[list[Any]]()
    for j, joint in enumerate(chain.joints):
        rows.append([j, joint.position])
        for hinge in map(joint.hinge, chain.axes):
            rows[j] += [getattr(hinge, field) if hinge else None for field in fields]
        rows[j] += [] if chain.straight else [np.degrees(chain.rest_angle(j)) if j < chain.count else None]
        link = chain.links[j] if j < chain.count else None
        values = [link.length, link.mass, link.centre, *link.off[2 - len(across) :], *link.inertia] if link else []
        rows[j] += [*values, *[None] * 8]
        del rows[j][len(columns) :]
    return Table("Joints, and the link beyond each", columns, rows)


def data(chain: RigidChain) -> dict[str, object]:
    """The chain as data, SI, with its expected frequencies."""
    names = ("wall", "mirrored", "damping", "viscosity", "joints", "links", "springs", "remarks")
    each = ((axis, chain.frequencies_hz(axis, MODES), chain.errors(axis, MODES)) for axis in chain.motions)
    expected = {axis: {"frequencies_hz": hertz, "error": error} for axis, hertz, error in each}
    own = {name: getattr(chain, name) for name in names} | {"steps": chain.steps and chain.steps._asdict()}
    own |= {} if chain.straight else {"frames": [chain.rest(j) for j in range(chain.count)]}
    return {"supports": chain.beam.supports, "count": chain.count, **own, "expected": expected}


_WRITERS: dict[str, Callable[[RigidChain], str]] = {
    ".xml": mjcf,
    ".mjcf": mjcf,
    ".sdf": lambda chain: robot(chain, _SDF),
    ".urdf": lambda chain: robot(chain, _URDF),
    "_exudyn.py": lambda chain: script(chain, "exudyn"),
    "_pinocchio.py": lambda chain: script(chain, "pinocchio"),
    ".json": lambda chain: to_json(data(chain)),
    ".csv": lambda chain: table(chain).csv(),
}


def write(chain: RigidChain, path: Path) -> str:
    """Write a chain to a file by the end of its name, whole or not at all; returns a sentence on what was written.

    .xml and .mjcf are MJCF. The stiffnesses of a URDF are also in a JSON file next to it. Raises InputError.
    """
    kind = next((end for end in _WRITERS if path.name.lower().endswith(end)), None)
    if kind is None:
        raise InputError(f"to = {shown(str(path))}: its end is no file type, give {', '.join(_WRITERS)}")
    if WALLS[chain.wall].fault:
        text = f"{WALLS[chain.wall].meaning} is a fault that chains are compared with"
        raise InputError(f"wall = {chain.wall!r}: {text}, give another wall")
    if kind in (".sdf", ".urdf") and chain.closed:
        text = "has no support of the far end and no spring to the ground, write .xml, _exudyn.py or _pinocchio.py"
        raise InputError(f"to = {shown(str(path))}: {kind[1:].upper()} {text}")
    writable_folder(path.parent, "to")
    write_whole(path, _WRITERS[kind](chain), "to")
    if kind != ".urdf":
        return f"wrote {path}"
    beside = path.with_name(path.name + ".json")
    write_whole(beside, to_json(data(chain)), "to")
    return f"wrote {path}: URDF has no joint springs but in Gazebo, apply what is in {beside}"
