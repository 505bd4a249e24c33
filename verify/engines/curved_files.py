"""A chain of a file that is curved at rest, or graded in mass and stiffness, against the clamped rod that it means."""

from dataclasses import replace as with_fields
from typing import Any

import numpy as np
from msgspec.structs import replace

from verify.analysis.verdict import Margin
from verify.arrays import Array
from verify.engines.curve_faults import hinges_off, links_off
from verify.engines.curved import CurvedChain, curved_chain
from verify.engines.description import AXES, Hinge, Joint
from verify.engines.line import STRAIGHT, Line
from verify.engines.meant_rod import UNEVEN, along_curve, law_of_masses, length_errors, meant_rod
from verify.engines.rules import ADAPTED, MORE, SERIES, WEIGHTS, Judged, at_wall, half_links, weights_of
from verify.engines.running import gravity_margin
from verify.engines.stiffness_law import ALIKE, SCENE, Law
from verify.errors import InputError, shown
from verify.formatting import with_unit
from verify.settings import WALLS, wall_label


def needs_rod(line: Line) -> bool:
    """Whether a file is curved, or its masses and stiffnesses vary, which no beam of one mass per length explains."""
    lengths, masses = line.links.T[:2]
    n, ei = len(lengths), line.springs * half_links(lengths)
    odd = int((abs(masses / lengths / np.median(masses / lengths) - 1.0) > UNEVEN).sum())
    return line.curve.bent or (odd > max(1, n // 4) and bool(np.ptp(ei[min(3, n - 1) :]) > ALIKE * ei[-1]))


def judge_rod(lines: list[Line], name: str) -> list[Judged]:
    """The rules of a chain and what is wrong with it, about each axis; all have the same two chains. Raises InputError.

    Without a scene no joint but those at the wall has another correct stiffness, and none where one is off the law.
    """
    lines, on_chords = along_curve(lines)
    _check(lines, name)
    n, half, errors = len(lines[0].springs), half_links(lines[0].links[:, 0]), length_errors(lines[0])
    masses, links = law_of_masses(lines[0], errors, name)
    try:
        rules, laws = zip(*(_rule(line, errors) for line in lines), strict=True)
    except InputError as error:
        text = str(error).replace(f", or {SCENE}", "").replace(f"give {SCENE}", "correct them")  # none is curved
        raise InputError(f"{name}: {text}") from None
    meant = curved_chain(*meant_rod(lines, laws, masses))
    links += links_off(lines, meant, errors)
    each = list(zip(lines, rules, laws, strict=True))
    springs = [law.joints / half / weights_of(rule, n) for rule, law in zip(rules, laws, strict=True)]
    odd = {line.joints[j]: float(k[j]) for (line, _, law), k in zip(each, springs, strict=True) for j in law.odd}
    walls = [_wall(line, rule, meant, errors, bool(odd)) for line, rule, _ in each]
    texts = list[str]()
    for (line, rule, law), (_, right) in zip(each, walls, strict=True):
        texts += [rule] * (not right) + law.faults(line.joints, line.springs * half / law.joints)
    levels = [law.joints[0] for law in laws]
    mixed = len(lines) > 1 and (len(lines) < len(AXES) or np.ptp(levels) > ALIKE * levels[0])
    turned = hinges_off(lines, meant) if mixed else []
    faults, remedy = [*dict.fromkeys(texts), *links, *turned], MORE
    if turned:
        remedy = "turn hinges to the axes of the rod at the joints"
    elif on_chords and meant.rod.bent:
        off = with_unit(float(np.hypot(*np.transpose([link.off for link in meant.links])).max()), "m")
        remedy = f"shift centres of mass off the chords by up to {off}, to those of the curve between joints"
    present, correct = (_chain(lines, each, meant) for each in ([k.springs for k in lines], [k for k, _ in walls]))
    means = (law.kind + ", {:.6g} to {:.6g} N m2" if np.ptp(law.joints) else "= {:.6g} N m2" for law in laws)
    texts = [text.format(*law.joints[[0, -1]]) for text, law in zip(means, laws, strict=True)]
    return [
        Judged(line, present, correct, rule, float(law.joints[0]), k, faults, links, [], odd, text, remedy)
        for (line, rule, law), (k, _), text in zip(each, walls, texts, strict=True)
    ]


def _rule(line: Line, errors: Array) -> tuple[str, Law]:
    """(rule of the joints at the wall, law of the others) with lengths of relative `errors`. Raises InputError."""
    lengths = line.links[:, 0]
    values = line.springs * half_links(lengths)
    rule, law = at_wall(values, line.joints, "clamped", lengths)
    values = values * weights_of(rule, len(values))
    nearer = [j for j in range(len(WEIGHTS.get(rule, ()))) if law.kind == "smooth" and j not in law.odd]
    apart = abs(values / law.joints - 1.0)
    law.joints[nearer] = values[nearer]  # than by extrapolation
    return rule, law._replace(odd=[j for j in law.odd if apart[j] > errors[j]])


def _wall(line: Line, rule: str, meant: CurvedChain, errors: Array, kept: bool) -> tuple[Array, bool]:
    """(springs with correct ones at the wall, but for those that are `kept`, whether the rule there is right)."""
    wall, lengths = "half" if line.turns == "torsion" and not meant.rod.bent else meant.wall, line.links[:3, 0]
    even = bool(np.ptp(lengths) < errors[0] * lengths[0])
    right = rule in (wall_label(wall), SERIES, ADAPTED, *[wall_label("gregory")] * even)
    best = np.array([one.stiffness for joint in meant.joints[:-1] if (one := joint.hinge(line.axis))])
    first = (np.arange(len(best)) < len(WALLS[wall].weights)) & (not (kept or right or np.isnan(line.springs[0])))
    return np.where(first, best, line.springs), right


def _check(lines: list[Line], name: str) -> None:
    """Raise InputError for hinges about one axis in space and joints without a stiffness."""
    plane, hinges, directions = len(lines) == 1, lines[0].curve.hinges, lines[0].curve.directions
    across = np.linalg.norm(np.cross(hinges[:, None], hinges), axis=2)  # sines between hinges
    normal = hinges[int(np.median(across, axis=1).argmin())]
    off, out = np.linalg.norm(np.cross(hinges, normal), axis=1), abs(directions @ normal).max()
    if plane and off.max() > STRAIGHT and out < STRAIGHT:
        joint, angle = shown(lines[0].joints[int(off.argmax())]), np.degrees(np.arcsin(min(off.max(), 1.0)))
        text = f"the hinge of {joint} is {angle:.2g} degrees off the normal of the curve's plane"
        raise InputError(f"{name}: {text}, turn it")
    if (plane and max(out, *off) > STRAIGHT) or (not plane and [line.axis for line in lines[1:]] == ["torsion"]):
        raise InputError(f"{name}: on a curve in space its links bend about one axis, give two hinges across each")
    for line in lines:
        if (free := np.flatnonzero((line.springs == 0.0) | (np.isnan(line.springs) & (np.arange(len(off)) > 0)))).size:
            joint = shown(line.joints[free[0]] or lines[0].joints[free[0]])
            raise InputError(f"{name}: joint {joint} has no stiffness about an axis of the others, give it one")


def _chain(lines: list[Line], springs: list[Array], meant: CurvedChain) -> CurvedChain:
    """The bodies of the file with springs about each axis, (N,)."""
    curve, rows, hinges = lines[0].curve, list[tuple[Hinge, ...]](), list[tuple[int, Array]]()
    for j in range(meant.count):
        found = [(one, float(k[j])) for one, k in zip(lines, springs, strict=True) if not np.isnan(k[j])]
        rows.append(tuple(Hinge(one.axis, k, float(one.dashpots[j]), float(one.armatures[j])) for one, k in found))
        hinges += [(j, one.curve.hinges[j]) for one, _ in found]
    first, length = np.array([j for j, _ in hinges]), float(lines[0].links[:, 0].sum())
    joints = tuple(Joint(old.position, each) for old, each in zip(meant.joints, [*rows, ()], strict=True))
    beam = replace(meant.beam, length=length, mass_per_length=float(curve.bodies[0].sum()) / length)
    about = curve.places[first], np.array([one for _, one in hinges]), first
    return with_fields(meant, beam=beam, joints=joints, bodies=curve.bodies, hinges=about)


def rod_under_gravity(judged: list[Judged], _: Any, gravity: Array, within: float) -> list[Margin]:
    """The margin of a weight that bends a rod, by linear theory."""
    chain: Any = judged[0].present
    speeds, springs = chain.speeds[0], np.diag(chain.matrices()[1])
    angles = np.einsum("m,min,i->n", chain.bodies[0], speeds, gravity) / springs
    sag = float(np.linalg.norm(speeds @ angles, axis=1).max()) / chain.beam.length
    return gravity_margin(sag, f"its weight bends it by {sag:.2g} of its length (linear theory)", within)
