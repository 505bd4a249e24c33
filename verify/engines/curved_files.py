"""A chain of a file that is curved at rest, or graded in mass and stiffness: the rod that it means, what deviates.

The joints mean the curve, and EI = k (l + l')/2 of a joint between links l and l', and GJ likewise, each by a law
along the rod; l are parts of the curve where the links are its pieces, with their centres of mass off the chords, else
chords. Masses and polar inertias are those of the links. The reference is that rod, clamped and free.
"""

from dataclasses import replace as with_fields
from typing import Any

import numpy as np
from msgspec.structs import replace

from verify.analysis.verdict import Margin
from verify.arrays import Array
from verify.engines.curved import CurvedChain, curved_chain
from verify.engines.description import AXES, Hinge, Joint
from verify.engines.line import STRAIGHT, Line
from verify.engines.rod import VALUES, Rod, spline
from verify.engines.rules import ADAPTED, SERIES, Judged, at_wall, half_links, written
from verify.engines.stiffness_law import ALIKE, Law
from verify.errors import InputError, shown
from verify.formatting import with_unit
from verify.settings import WALLS, wall_label

UNEVEN = 0.01
"""Relative difference of mass per length from which a link differs."""
JUMP = 3.0
"""Difference between two links, over that of their neighbours, from which it is a step."""
WEIGHTS = {wall_label(name): rule.weights for name, rule in WALLS.items() if not rule.first and all(rule.weights)}
"""Weights at a wall by the rule in words."""
TILT = 5e-3
"""Angle, rad, of hinges off the axes of a joint from which they are named: an error of about its square and EI/GJ."""
HEAVY = 1.5
"""Mass per length over that of both neighbours from which a link carries a body."""
RIGID = 1e3
"""GJ over EI of a chain without hinges in torsion."""


def needs_rod(line: Line) -> bool:
    """Whether a file is curved, or its masses and stiffnesses vary, which no beam of one mass per length explains."""
    lengths, masses = line.links.T[:2]
    odd, ei = abs(masses / lengths / np.median(masses / lengths) - 1.0) > UNEVEN, line.springs * half_links(lengths)
    return line.curve.bent or bool(
        odd.sum() > max(1, len(odd) // 4) and np.ptp(ei[min(3, len(ei) - 1) :]) > ALIKE * ei[-1]
    )


def judge_rod(lines: list[Line], name: str) -> list[Judged]:
    """The rules of a chain and what is wrong with it, about each axis; all have the same two chains. Raises InputError.

    Without a scene no joint but those at the wall has another correct stiffness, and none where one is off the law.
    """
    lines, chords = _lengths(lines)
    bending, plane = [line for line in lines if line.axis != "torsion"], len(lines) == 1
    _, ways, (masses, *_), hinges, _ = lines[0].curve
    lengths, lean = lines[0].links[:, 0], max(abs(ways @ hinges[0]).max(), 1.0 - abs(hinges @ hinges[0]).min())
    if (plane and lean > STRAIGHT) or (not plane and len(bending) < 2):
        raise InputError(f"{name}: on a curve in space its links bend about one axis, give two hinges across each")
    if any((line.springs == 0.0).any() or np.isnan(line.springs[1:]).any() for line in lines):
        raise InputError(f"{name}: a joint has no stiffness about an axis of the others, on a curve give it one")
    density = masses / lengths
    heavy = density > HEAVY * np.maximum(np.append(density[1:], 0.0), np.append(0.0, density[:-1]))
    if heavy.any():
        link = shown(bending[0].joints[int(heavy.argmax())])
        raise InputError(f"{name}: the link of joint {link} carries a body, on a curve give the links alone")
    held, laws, rules = bool(np.isnan(bending[0].springs[0])), list[Law](), list[str]()
    means = [line.springs * half_links(lengths) for line in lines]
    try:
        for line, values in zip(lines, means, strict=True):
            rule, law = at_wall(values, line.joints, "clamped", lengths)
            known = WEIGHTS.get(rule, ())[: law.kind == "smooth" and len(values)]
            law.joints[: len(known)] = values[: len(known)] * known  # nearer than by extrapolation
            laws, rules = [*laws, law], [*rules, rule]
    except InputError as error:
        raise InputError(f"{name}: {str(error).partition(':')[0]}: correct them") from None
    rod = _rod(lines, laws, plane)
    meant = curved_chain(rod, np.unique(rod.s))
    odd, judged, correct = [j for law in laws for j in law.odd], list[Judged](), list[Array]()
    for line, law, values, rule in zip(lines, laws, means, rules, strict=True):
        wall = "half" if line.turns == "torsion" and not rod.bent else meant.wall
        best = np.array([one.stiffness for joint in meant.joints[:-1] if (one := joint.hinge(line.axis))])
        fits, first = rule in (wall_label(wall), SERIES, ADAPTED), np.arange(len(best)) < len(WALLS[wall].weights)
        springs = np.where(first & (not (held or odd or fits)), best, line.springs)
        wrong = [rule] * (not fits)
        wrong += [law.text(line.joints, values / law.joints)] if law.odd else []
        names, ends = [line.joints[j] for j in law.odd], " to ".join(f"{x:.6g}" for x in law.joints[[0, -1]])
        text, level = f"{law.kind}, {ends} N m2" if np.ptp(law.joints) else written(law.joints[0]), float(law.joints[0])
        judged.append(Judged(line, meant, meant, rule, level, springs, wrong, [], [], names, text))
        correct.append(springs)
    present, right = (_chain(lines, each, meant) for each in ([line.springs for line in lines], correct))
    faults = list(dict.fromkeys(text for one in judged for text in one.faults))
    tilt = max(float(abs(np.einsum("ni,ni->n", one.curve.hinges, meant.axes_at[:, :, 0])[1:]).max()) for one in bending)
    levels = [law.joints[0] for law in laws]
    if not plane and tilt > TILT and (len(lines) < len(AXES) or np.ptp(levels) > ALIKE * levels[0]):
        angle = f"{np.degrees(tilt):.2g} degrees"
        faults.append(f"hinges across are up to {angle} off the axes of the rod: EI and GJ mix, order 1")
    if chords and rod.bent:
        off = with_unit(float(np.hypot(*np.transpose([link.off for link in meant.links])).max()), "m")
        text = f"shift centres of mass off the chords by up to {off}, to those of the curve between joints"
        judged = [one._replace(remedy=text) for one in judged]
    return [one._replace(present=present, correct=right, faults=faults) for one in judged]


def _lengths(lines: list[Line]) -> tuple[list[Line], bool]:
    """The lines with the lengths of the curve where links are its pieces; whether they are its chords."""
    places, ways, (_, centres, _), *_ = lines[0].curve
    arcs, chords, arms = np.diff(spline(places)[0]), lines[0].links[:, 0], centres - places[:-1]
    off = np.linalg.norm(np.cross(arms, ways), axis=1).max()
    if off < 0.5 * max((arcs * (arcs - chords)).max() / 6.0, 0.0) ** 0.5:  # the centre of an arc is twice as far off
        return lines, True
    return [line._replace(links=np.column_stack([arcs, line.links[:, 1:]])) for line in lines], False


def _rod(lines: list[Line], laws: list[Law], plane: bool) -> Rod:
    """The rod of links: values at both ends of each, by the laws of the joints; in a plane `u` is in it."""
    places, ways, (_, _, inertias), hinges, _ = lines[0].curve
    lengths, masses = lines[0].links.T[:2]
    spins = np.ones(len(ways)) if plane else np.einsum("ni,nij,nj->n", ways, inertias, ways) / lengths
    ei, *others = [_ends(law.links if law.kind != "smooth" else None, law.joints) for law in laws]
    ei2 = others[0] if others else ei
    about = {line.axis: value for line, value in zip(lines, [ei, *others], strict=True)}
    gj = about.get("torsion", RIGID * np.maximum(ei, ei2))
    values = [ei, ei2, gj, _even(masses / lengths), _even(spins), *np.zeros((3, len(ei)))]
    rod = Rod(np.repeat(places, 2, axis=0)[1:-1], np.stack(values, axis=1), not plane, np.cross(hinges[0], ways[0]))
    if not plane:
        frames = rod.frames(np.unique(rod.s))[:-1]
        turned = np.einsum("ni,nij->nj", np.cross(hinges, frames[:, :, 0]), frames)
        roll = 0.5 * np.unwrap(2.0 * np.arctan2(-turned[:, 1], turned[:, 2]))
        rod.values[:, VALUES.index("roll")] = _ends(None, roll)
    return rod


def _ends(links: Array | None, joints: Array) -> Array:
    """A value at both ends of each link, (2 N,): of `links`, or linear between `joints`, (N,)."""
    pairs = [joints, np.append(joints[1:], joints[-1])] if links is None else [links, links]
    return np.stack(pairs, axis=1).ravel()


def _even(values: Array) -> Array:
    """Values of links at their ends: one, linear between the middles, or, with steps, constant in each."""
    if np.ptp(values) < UNEVEN * values.min():
        return np.full(2 * len(values), np.median(values))
    steps = abs(np.diff(values))
    around = np.maximum(np.append(steps[1:], steps[-2]), np.append(steps[1], steps[:-1]))
    if (steps > JUMP * around + UNEVEN * values.min()).any():
        return _ends(values, values)
    ends = 1.5 * values[[0, -1]] - 0.5 * values[[1, -2]]
    return np.concatenate([ends[:1], np.repeat(0.5 * (values[1:] + values[:-1]), 2), ends[1:]])


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


def weight(judged: list[Judged], _: Any, gravity: Array, within: float) -> list[Margin]:
    """The margin of a weight that bends a rod, by linear theory."""
    chain: Any = judged[0].present
    speeds, springs = chain.speeds[0], np.diag(chain.matrices()[1])
    angles = np.einsum("m,min,i->n", chain.bodies[0], speeds, gravity) / springs
    sag = float(np.linalg.norm(speeds @ angles, axis=1).max()) / chain.beam.length
    text = f"not judged under gravity: its weight bends it by {sag:.2g} of its length (linear theory)"
    remedy = "set gravity to zero for the frequencies without it"
    words: dict[str, Any] = {"name": "gravity", "failure": text, "remedy": remedy, "harm": "premise"}
    return [Margin(size=sag, fine=within, limit=within, **words)] if sag > within else []
