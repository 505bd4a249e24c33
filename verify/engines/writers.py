"""A `RigidChain` as a file of an engine: MJCF, SDF, URDF, scripts for Exudyn and Pinocchio, JSON, CSV."""

from collections.abc import Callable, Iterator
from pathlib import Path
from typing import NamedTuple

import numpy as np

from verify.arrays import Array
from verify.engines.description import Axis, RigidChain
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
"""Mass of a body between two hinges at one place over that of its link, in formats that demand one."""
MODES = 3
SCRIPTS = ("exudyn", "pinocchio")
_SDF = (
    '<link name="{0.body}"><pose relative_to="{frame}">{0.offset!r} 0 0 0 0 0</pose><inertial>'
    "<pose>{0.centre!r} 0 0 0 0 0</pose><mass>{0.mass!r}</mass><inertia><ixx>{0.inertia[0]!r}</ixx>"
    "<iyy>{0.inertia[1]!r}</iyy><izz>{0.inertia[2]!r}</izz><ixy>0</ixy><ixz>0</ixz><iyz>0</iyz></inertia></inertial>"
    '<visual name="{0.body}"><pose>{middle!r} 0 0 0 0 0</pose><geometry><box><size>{size}</size></box></geometry>'
    "<material><diffuse>{colour}</diffuse></material></visual></link>\n"
    '<joint name="{0.name}" type="{0.kind}"><parent>{0.parent}</parent><child>{0.body}</child><axis>'
    "<xyz>{0.direction}</xyz><limit><lower>-1e16</lower><upper>1e16</upper></limit><dynamics>"
    "<damping>{0.damping!r}</damping><spring_reference>0</spring_reference>"
    "<spring_stiffness>{0.stiffness!r}</spring_stiffness></dynamics></axis></joint>\n"
)
_URDF = (
    '<link name="{0.body}"><inertial><origin xyz="{0.centre!r} 0 0"/><mass value="{0.mass!r}"/>'
    '<inertia ixx="{0.inertia[0]!r}" iyy="{0.inertia[1]!r}" izz="{0.inertia[2]!r}" ixy="0" ixz="0" iyz="0"/></inertial>'
    '<visual><origin xyz="{middle!r} 0 0"/><geometry><box size="{size}"/></geometry>'
    '<material name="{0.body}"><color rgba="{colour}"/></material></visual></link>\n'
    '<joint name="{0.name}" type="{0.kind}"><parent link="{0.parent}"/><child link="{0.body}"/>'
    '<origin xyz="{0.offset!r} 0 0"/><axis xyz="{0.direction}"/><dynamics damping="{0.damping!r}"/>'
    '<limit lower="-3.14" upper="3.14" effort="1e9" velocity="1e9"/></joint>\n'
)


class Motion(NamedTuple):
    """One degree of freedom, revolute or prismatic, between a body and its parent. `offset`: x in the parent, m."""

    name: str
    kind: str
    direction: str
    body: str
    parent: str
    offset: float
    stiffness: float
    damping: float
    link: int
    mass: float
    centre: float
    inertia: tuple[float, ...]


def tree(chain: RigidChain) -> Iterator[Motion]:
    """The degrees of freedom from joint 0 on. The last at a joint moves the link with the bodies on it."""
    parent, offset = "world", chain.joints[0].position
    for j, (joint, link) in enumerate(zip(chain.joints, chain.links, strict=False)):
        moves = [(f"slide_{axis}", "prismatic", SLIDES[axis], 0.0, 0.0) for axis in SLIDES if axis in chain.axes]
        moves = moves if j == 0 and not chain.held[0] else []
        moves += [(f"joint{j}_{h.axis}", "revolute", DIRECTIONS[h.axis], h.stiffness, h.damping) for h in joint.hinges]
        own = [(link.mass, link.centre, link.inertia)]
        own += [(b.mass, b.position - link.start, (b.inertia,) * 3) for b in chain.bodies if b.link == j]
        mass = sum(m for m, _, _ in own)
        centre = sum(m * x for m, x, _ in own) / mass
        spread = sum(m * (x - centre) ** 2 for m, x, _ in own)
        inertia = tuple(sum(each[i] for _, _, each in own) + spread * (i > 0) for i in range(3))
        for name, kind, direction, stiffness, damping in moves:
            last = name == moves[-1][0]
            body, share = (f"link{j}", 1.0) if last else (f"link{j}_{name}", MASSLESS)
            weights = (share * mass, centre * last, tuple(share * one for one in inertia))
            yield Motion(name, kind, direction, body, parent, offset, stiffness, damping, j, *weights)
            parent, offset = body, 0.0
        offset = link.length


def notes(chain: RigidChain) -> str:
    """What the chain is and what it is expected to show, in lines."""
    beam, mirrored = chain.beam, ", joint 0 at the right end of the beam" * chain.mirrored
    lines = [
        f"beam {beam.supports[0]}-{beam.supports[1]}, length {beam.length!r} m, N = {chain.count} rigid links, SI units",
        f"x along the beam, z the deflection, joints at a wall by the rule {chain.wall}{mirrored}",
    ]
    for axis in chain.axes:
        modes = zip(chain.frequencies_hz(axis, MODES), chain.errors(axis, MODES), strict=True)
        text = ", ".join(f"{hertz:.9g} ({error:+.2e})" for hertz, error in modes)
        lines.append(f"frequencies in {axis}, Hz (relative errors against the exact beam): {text}")
    if chain.damping:
        lines.append(f"dashpots in proportion to the springs: damping ratio {chain.damping!r} in mode 1, more beyond")
    if beam.supports[1] != "free" or chain.springs:
        lines.append("supports of the far end and springs to the ground act along z (and y): for small motion")
    return "\n".join(lines)


def mjcf(chain: RigidChain, step: float | None = None) -> str:
    """The chain for MuJoCo; `step`, s, is by default one radian of the highest frequency.

    Springs to the ground, joint N and the supports of the far end are fixed tendons, linear in the angles; a support is
    an equality, as stiff as the engine allows. Raises InputError for too many links.
    """
    if chain.count > DEEPEST:
        raise InputError(f"count = {chain.count}: MuJoCo reads at most {DEEPEST} nested bodies, lower it")
    step = step or float(f"{0.5 / np.pi / max(chain.frequencies_hz(axis)[-1] for axis in chain.axes):.1e}")
    bodies, joints = "", ""
    for one in tree(chain):
        if not joints:
            bodies += f'<body name="link{one.link}" pos="{one.offset!r} 0 0">'
        joints += (
            f'<joint name="{one.name}" type="{"slide" if one.kind == "prismatic" else "hinge"}" axis="{one.direction}" '
            f'stiffness="{one.stiffness!r}" damping="{one.damping!r}"/>'
        )
        if one.body == f"link{one.link}":
            bodies += (
                f'{joints}\n<inertial pos="{one.centre!r} 0 0" mass="{one.mass!r}" '
                f'diaginertia="{" ".join(map(repr, one.inertia))}"/><geom type="box" contype="0" conaffinity="0" '
                f'pos="{0.5 * chain.links[one.link].length!r} 0 0" size="{_size(chain, one.link, 0.5)}" '
                f'rgba="{COLOURS[one.link % 2]}"/>\n'
            )
            joints = ""

    def tendon(name: str, axis: Axis, row: Array, values: str = "") -> str:
        names = [f"slide_{axis}"] * chain.slides(axis) + [f"joint{j}_{axis}" for j, _ in chain.hinges(axis)]
        coefs = "".join(f'<joint joint="{n}" coef="{c!r}"/>' for n, c in zip(names, row.tolist(), strict=True) if c)
        return f'<fixed name="{name}"{values}>{coefs}</fixed>\n'

    tendons, equalities, closed = "", "", ""
    for axis in chain.axes:
        for name, row, stiffness, damping in chain.grounded(axis):
            tendons += tendon(name, axis, row, f' stiffness="{stiffness!r}" damping="{damping!r}" springlength="0"')
        for row in chain.constraints(axis):
            closed = ' solver="PGS" jacobian="dense" iterations="20" tolerance="1e-14"'
            tendons += tendon(f"support_{axis}", axis, row)
            equalities += (
                f'<tendon tendon1="support_{axis}" solref="{2.0 * step!r} 1" solimp="0.9999 0.9999 0.001 0.5 2"/>'
            )
    return (
        f"<mujoco>\n<!--\n{notes(chain)}\n-->\n"
        '<compiler angle="radian" inertiafromgeom="false" boundmass="0" boundinertia="0"/>\n'
        f'<option timestep="{step!r}" integrator="{"implicitfast" if chain.damping else "RK4"}" gravity="0 0 0"{closed}/>\n'
        f'<size memory="200M"/>\n<worldbody>\n{bodies}<site name="tip" pos="{chain.links[-1].length!r} 0 0"/>'
        f"{'</body>' * chain.count}\n</worldbody>\n<tendon>{tendons}</tendon>\n<equality>{equalities}</equality>\n</mujoco>\n"
    )


def _size(chain: RigidChain, index: int, scale: float = 1.0) -> str:
    """Length, width and thickness of a link as drawn, m; a hundredth of the beam's length where unknown."""
    link, beam = chain.links[index], chain.beam
    steps = np.cumsum([section.length for section in beam.section[:-1]])
    piece = int(np.searchsorted(steps, link.start + 0.5 * link.length))
    fields = merged(beam.section[piece], beam) if beam.section else set_fields(beam)
    sizes = [fields.get(name, fields.get("diameter", 0.01 * beam.length)) for name in ("width", "thickness")]
    return " ".join(repr(scale * one) for one in (link.length, *sizes))


def _bodies(chain: RigidChain, text: str) -> str:
    """Bodies and joints of the tree in the format `text`."""
    return "".join(
        text.format(
            one,
            frame="__model__" if one.parent == "world" else one.parent,
            middle=0.5 * chain.links[one.link].length,
            size=_size(chain, one.link) if one.body == f"link{one.link}" else "1e-6 1e-6 1e-6",
            colour=COLOURS[one.link % 2],
        )
        for one in tree(chain)
    )


def sdf(chain: RigidChain) -> str:
    """The chain for Gazebo and Drake: `spring_stiffness` on every joint."""
    return (
        f'<?xml version="1.0"?>\n<!--\n{notes(chain)}\n-->\n<sdf version="1.9"><model name="beam">\n'
        f'{_bodies(chain, _SDF)}<frame name="tip" attached_to="link{chain.count - 1}">'
        f"<pose>{chain.links[-1].length!r} 0 0 0 0 0</pose></frame>\n</model></sdf>\n"
    )


def urdf(chain: RigidChain) -> str:
    """The chain for ROS and Pinocchio: the tree and its dashpots, without springs."""
    return (
        f'<?xml version="1.0"?>\n<!--\n{notes(chain)}\n-->\n<robot name="beam">\n<link name="world"/>\n'
        f'{_bodies(chain, _URDF)}<link name="tip"/>\n<joint name="tip" type="fixed"><parent link="link{chain.count - 1}"/>'
        f'<child link="tip"/><origin xyz="{chain.links[-1].length!r} 0 0"/></joint>\n</robot>\n'
    )


def script(chain: RigidChain, engine: str) -> str:
    """A Python script with `build` and `frequencies_hz` of Exudyn or Pinocchio: data, then a fixed text."""
    moves, rows, springs = list(tree(chain)), "", ""
    for one in moves:
        kind = one.kind.capitalize() + "XYZ"[[value != "0" for value in one.direction.split()].index(True)]
        row = (one.name, kind, one.offset, one.stiffness, one.damping, one.mass, one.centre, one.inertia)
        rows += f"    {row!r},\n"
    bodies = {one.link: i for i, one in enumerate(moves)}
    values = [(s.link, s.position, 2, s.stiffness, s.damping) for s in chain.springs]
    values += [(s.link, s.position, 4, s.rotational, s.rotational_damping) for s in chain.springs]
    end, about = chain.joints[-1], {"torsion": 3, "bending": 4, "width": 5}
    values += [(chain.count - 1, end.position, about[h.axis], h.stiffness, h.damping) for h in end.hinges]
    for link, x, i, *pair in values:
        if pair[0]:
            six = [tuple(value * (k == i) for k in range(6)) for value in pair]
            springs += f"    {(bodies[link], x - chain.links[link].start, x, *six)!r},\n"
    held = (int(chain.held[1] and chain.in_space), int(chain.held[1]))
    tip = (len(moves) - 1, chain.links[-1].length, end.position)
    text = (Path(__file__).parent / f"{engine}_script.txt").read_text(encoding="utf-8")
    return (
        f'"""{notes(chain)}"""\n\nimport numpy as np\n\n# joint, type, x in its parent, stiffness, dashpot; mass, centre, '
        f"inertia about it (xx, yy, zz) of its body\nTREE = [\n{rows}]\n# body, x in it, x at rest; stiffness to the "
        f"ground in x, y, z and about them; dashpots\nSPRINGS = [\n{springs}]\n# whether the far end is held in y, z; "
        f"its body, x in it, x at rest\nHELD = {held}\nTIP = {tip}\n\n{text}"
    )


def table(chain: RigidChain) -> Table:
    """Joints 0..N with the link beyond each, SI; in a plane a link has one inertia."""
    names = ("stiffness", "N m/rad", ".6g"), ("dashpot", "N m s", ".4g")
    words = {axis: f" {axis}" if chain.in_space else "" for axis in chain.axes}
    columns = [Column("joint"), Column("position", "m")]
    columns += [
        Column(name + words[axis], *unit) for axis in chain.axes for name, *unit in names[: 1 + bool(chain.damping)]
    ]
    columns += [Column("length", "m"), Column("mass", "kg"), Column("centre", "m")]
    columns += [Column(f"inertia{one}", "kg m2") for one in ((" xx", " yy", " zz") if chain.in_space else ("",))]
    rows = []
    for j, joint in enumerate(chain.joints):
        row: list[float | None] = [j, joint.position]
        for hinge in map(joint.hinge, chain.axes):
            row += [hinge and hinge.stiffness, hinge and hinge.damping][: 1 + bool(chain.damping)]
        if j < chain.count:
            link = chain.links[j]
            row += [link.length, link.mass, link.centre, *link.inertia]
        rows.append([*row, *[None] * 6][: len(columns)])
    return Table("Joints, and the link beyond each", columns, rows)


def data(chain: RigidChain) -> dict[str, object]:
    """The chain as data, SI, with its expected frequencies."""
    names = ("wall", "mirrored", "damping", "joints", "links", "bodies", "springs")
    expected = {
        axis: {"frequencies_hz": chain.frequencies_hz(axis, MODES), "error": chain.errors(axis, MODES)}
        for axis in chain.axes
    }
    own = {name: getattr(chain, name) for name in names}
    return {"supports": chain.beam.supports, "count": chain.count, **own, "expected": expected}


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
        raise InputError(f"to = {shown(str(path))}: the suffix is no file type, give .{', .'.join(_WRITERS)} or .py")
    if chain.wall == "rigid":
        raise InputError("wall = 'rigid': a first link fixed to the wall is for comparison, give another wall")
    if (kind == "py") != (engine is not None) or (engine and engine not in SCRIPTS):
        raise InputError(f"engine = {engine!r}: for a .py file give {' or '.join(SCRIPTS)}, for others none")
    writable_folder(path.parent, "to")
    write_whole(path, script(chain, engine) if engine else _WRITERS[kind](chain), "to")
    missing = ["joint springs"] * (kind == "urdf") + ["springs to the ground"] * bool(chain.springs)
    missing += ["support of the far end"] * (chain.beam.supports[1] != "free")
    if kind not in ("sdf", "urdf") or not missing:
        return f"wrote {path}"
    beside = path.with_name(path.name + ".json")
    write_whole(beside, to_json(data(chain)), "to")
    return f"wrote {path}: {kind.upper()} has no {', no '.join(missing)}, apply what is in {beside}"
