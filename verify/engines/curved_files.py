"""A chain of a file that is curved at rest, or graded in mass and stiffness: the rod that it means, what deviates.

The joints mean the curve, and EI = k (l + l')/2 of a joint between links l and l', and GJ likewise, each by a law
along the rod; l are parts of the curve where the links are its pieces, with their centres of mass off the chords, else
chords. Masses and polar inertias are those of the links. The reference is that rod, clamped and free.
"""

from collections.abc import Sequence
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
from verify.engines.rules import ADAPTED, SERIES, WEIGHTS, Judged, at_wall, half_links, written
from verify.engines.stiffness_law import ALIKE, MANY, Law, fitted_law
from verify.errors import InputError, shown
from verify.formatting import with_unit
from verify.settings import WALLS, wall_label

UNEVEN = 0.01
"""Relative difference of mass per length from which a link differs."""
JUMP = 3.0
"""Difference between two links, over that of their neighbours, from which it is a step."""
TILT, SHARE, JUMPED, DECAY = 5e-3, 0.1, 0.5, 2.0 - 3.0**0.5
"""Angle of hinges off the axes of a joint, rad, and over the rest angle and its changes, from which they are named: an
error of its square and EI/GJ. Axes by the joints alone are uncertain by a part of the rest angle, near a jump of the
curvature by what a cubic spline overshoots, 1/(4 3^(1/2)), which decays from joint to joint; those of one link are off
by half the rest angle."""
HEAVY = 1.5
"""Mass per length over that of both neighbours from which a link carries a body."""
INERTIA, CENTRE = 0.1, 0.02
"""Relative difference of an inertia, and distance of a centre of mass over the length, from which a link differs."""
LOST = 0.01, 0.2
"""Difference, rad and relative, between rest angles and those by the links from which they are no rounding."""
AT = 1e-6
"""Distance over the length up to which steps are at one place."""
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
    _check(lines, name)
    plane, lengths, unsure = len(lines) == 1, lines[0].links[:, 0], _unsure(lines[0])
    density, links = _densities(lines, unsure, name)
    held, laws, rules = bool(np.isnan(lines[0].springs[0])), list[Law](), list[str]()
    means = [line.springs * half_links(lengths) for line in lines]
    try:
        for line, values in zip(lines, means, strict=True):
            rule, law = at_wall(values, line.joints, "clamped", lengths)
            known = values * np.append(WEIGHTS.get(rule, ()), np.ones(len(values)))[: len(values)]
            near = abs(known / law.joints - 1.0)
            nearer = [j for j in range(len(WEIGHTS.get(rule, ()))) if law.kind == "smooth" and j not in law.odd]
            law.joints[nearer] = known[nearer]  # than by extrapolation
            odd = [j for j in law.odd if near[j] > unsure[j]]
            laws, rules = [*laws, law._replace(odd=odd)], [*rules, rule]
    except InputError as error:
        text, whole = str(error), "the beam that they mean as a scene"  # none is curved
        raise InputError(
            f"{name}: {text.replace(f', or {whole}', '').replace(f'give {whole}', 'correct them')}"
        ) from None
    rod, joints = _rod(lines, laws, density, plane)
    meant = curved_chain(rod, np.unique(rod.s)[joints])
    fitting = [SERIES, ADAPTED, *[wall_label("gregory")] * bool(np.ptp(lengths[:3]) < unsure[0] * lengths[0])]
    judged, correct, off = list[Judged](), list[Array](), dict[str, float]()
    for line, law, rule in zip(lines, laws, rules, strict=True):
        weights = np.append(WEIGHTS.get(rule, ()), np.ones(len(lengths)))
        off |= {line.joints[j]: float((law.joints / half_links(lengths) / weights[: len(lengths)])[j]) for j in law.odd}
    for line, law, values, rule in zip(lines, laws, means, rules, strict=True):
        wall = "half" if line.turns == "torsion" and not rod.bent else meant.wall
        best = np.array([one.stiffness for joint in meant.joints[:-1] if (one := joint.hinge(line.axis))])
        fits, first = rule in (*fitting, wall_label(wall)), np.arange(len(best)) < len(WALLS[wall].weights)
        springs = np.where(first & (not (held or off or fits)), best, line.springs)
        wrong = [rule] * (not fits)
        wrong += [law.text(line.joints, values / law.joints)] if law.odd else []
        ends, level = " to ".join(f"{x:.6g}" for x in law.joints[[0, -1]]), float(law.joints[0])
        text = f"{law.kind}, {ends} N m2" if np.ptp(law.joints) else written(law.joints[0])
        judged.append(Judged(line, meant, meant, rule, level, springs, wrong, [], [], off, text))
        correct.append(springs)
    present, right = (_chain(lines, each, meant) for each in ([line.springs for line in lines], correct))
    links += _links_off(lines, meant, unsure)
    faults = list(dict.fromkeys(text for one in judged for text in one.faults)) + links
    levels = [law.joints[0] for law in laws]
    mixed = not plane and (len(lines) < len(AXES) or np.ptp(levels) > ALIKE * levels[0])
    tilted = _tilted(lines, meant) if mixed else []
    if chords and rod.bent:
        off_by = with_unit(float(np.hypot(*np.transpose([link.off for link in meant.links])).max()), "m")
        text = f"shift centres of mass off the chords by up to {off_by}, to those of the curve between joints"
        judged = [one._replace(remedy=text) for one in judged]
    judged = [
        one._replace(remedy="turn hinges to the axes of the rod at the joints") if tilted else one for one in judged
    ]
    return [one._replace(present=present, correct=right, faults=faults + tilted, links=links) for one in judged]


def _check(lines: list[Line], name: str) -> None:
    """Raise InputError for hinges about one axis in space and joints without a stiffness."""
    bending, plane, ways = [line for line in lines if line.axis != "torsion"], len(lines) == 1, lines[0].curve.ways
    hinges = lines[0].curve.hinges
    across = np.linalg.norm(np.cross(hinges[:, None], hinges), axis=2)  # sines between hinges
    normal = hinges[int(np.median(across, axis=1).argmin())]
    off = np.linalg.norm(np.cross(hinges, normal), axis=1)
    if plane and off.max() > STRAIGHT and abs(ways @ normal).max() < STRAIGHT:
        joint, angle = shown(lines[0].joints[int(off.argmax())]), np.degrees(np.arcsin(min(off.max(), 1.0)))
        raise InputError(
            f"{name}: the hinge of {joint} is {angle:.2g} degrees off the normal of the curve's plane, turn it"
        )
    if (plane and max(abs(ways @ normal).max(), off.max()) > STRAIGHT) or (not plane and len(bending) < 2):
        raise InputError(f"{name}: on a curve in space its links bend about one axis, give two hinges across each")
    for line in lines:
        if (free := np.flatnonzero((line.springs == 0.0) | (np.isnan(line.springs) & (np.arange(len(ways)) > 0)))).size:
            joint, text = (
                shown(line.joints[free[0]] or lines[0].joints[free[0]]),
                "has no stiffness about an axis of the others",
            )
            raise InputError(f"{name}: joint {joint} {text}, on a curve give it one")


def _densities(lines: list[Line], unsure: Array, name: str) -> tuple[Law, list[str]]:
    """(law of masses per length, without those off it, the latter in words). Raises InputError."""
    (lengths, masses), joints = lines[0].links.T[:2], lines[0].joints
    density = masses / lengths
    heavy = density > HEAVY * np.maximum(np.append(density[1:], 0.0), np.append(0.0, density[:-1]))
    if heavy.any():
        link = shown(joints[int(heavy.argmax())])
        raise InputError(f"{name}: the link of joint {link} carries a body, on a curve give the links alone")
    try:  # the first three count like the others: there is no wall
        middles = np.cumsum(lengths) - 0.5 * lengths
        values, places = (np.append(sign * one[2::-1], one) for sign, one in ((1.0, density), (-1.0, middles)))
        law = fitted_law(values, places, [*joints[2::-1], *joints])
    except InputError:
        return Law("", density, density, []), []
    ratios = density / law.joints[3:]
    odd = [j - 3 for j in law.odd if j > 2 and abs(ratios[j - 3] - 1.0) > UNEVEN + unsure[j - 3]]
    right = np.where(np.isin(range(len(density)), odd), law.joints[3:], density)
    return law._replace(joints=right, links=law.links[3:], odd=odd), _named("mass of the link of", joints, ratios, odd)


def _named(what: str, joints: list[str], ratios: Array, odd: Sequence[int]) -> list[str]:
    """One fault of what is off at links beyond joints `odd`, by their names with ratios, or none."""
    each = [f"{joints[j] or 'the wall'} ({ratios[j]:.3g} times)" for j in odd]
    more = f" and {len(each) - MANY} more" * (len(each) > MANY)
    return [f"{what} {', '.join(each[:MANY])}{more}"] if each else []


def _links_off(lines: list[Line], meant: CurvedChain, unsure: Array) -> list[str]:
    """Inertias and centres of mass that are not those of pieces of the rod."""
    (lengths, masses, centres, about), curve, joints = lines[0].links.T, lines[0].curve, lines[0].joints
    found, ways, plane = list[str](), curve.ways, len(lines) == 1
    chords = np.linalg.norm(np.diff(curve.places, axis=0), axis=1)
    across, right = (  # those about both directions across the link, without the section's
        np.trace(each, axis1=1, axis2=2) - 2.0 * np.einsum("ni,nij,nj->n", ways, each, ways)
        for each in (curve.bodies[2], meant.bodies[2])
    )
    ratios, straight = across / right, masses * chords**2 / (12.0 if plane else 6.0) / right
    if plane:  # of a body of one inertia, or of one with those of both sides
        ratios = np.where(_outside(0.5 * ratios, 1.0, straight) < INERTIA, 1.0, about / right)
    odd = np.flatnonzero(_outside(ratios, 1.0, straight) > INERTIA + 2.0 * unsure)
    if len(odd) > len(lengths) // 2:
        inertia = float(np.median(ratios)) / 12.0
        words = "point masses" if inertia < 1e-3 else f"inertia {inertia:.3g} m l^2"
        found.append(f"{words} in place of m l^2/12")
    else:
        found += _named("inertia of the link of", joints, ratios, odd.tolist())
    middle = np.einsum("ni,ni->n", meant.bodies[1] - meant.places[:-1], ways)
    odd = np.flatnonzero(_outside(centres, middle, 0.5 * chords) > (CENTRE + 0.5 * unsure) * lengths)
    if len(odd) > len(lengths) // 2:
        found.append(f"centre of mass at {float(np.median(centres / lengths)):.3g} l in place of l/2")
    else:
        found += _named("centre of mass of the link of", joints, centres / middle, odd.tolist())
    return found


def _outside(values: Array, piece: Any, chord: Array) -> Array:
    """Distance of values from those between a piece of the rod and a uniform straight link."""
    return np.asarray(abs(values - np.clip(values, np.minimum(piece, chord), np.maximum(piece, chord))))


def _tilted(lines: list[Line], meant: CurvedChain) -> list[str]:
    """Hinges off the axes of the rod at their joints, in words."""
    columns: dict[str, int] = {"bending": 1, "width": 2, "torsion": 0}
    rest = np.array([meant.rest_angle(j) for j in range(meant.count)])
    rest[:1], joints = rest[1:2], np.arange(meant.count)
    joints[:1] = 2  # the first two parts of the spline are one cubic
    near = DECAY ** abs(joints[:, None] - joints[1:] + 0.5)
    unknown = SHARE * rest + JUMPED * near @ abs(np.diff(rest))
    named, worst, count = list[str](), 0.0, 0
    for line in lines:
        off = np.linalg.norm(np.cross(line.curve.hinges, meant.axes_at[:, :, columns[line.axis]]), axis=1)
        odd = np.flatnonzero(off > np.maximum(TILT, unknown))
        named += [f"{line.joints[j] or 'the wall'} ({np.degrees(off[j]):.2g} degrees)" for j in odd]
        worst, count = max(worst, *off[odd], 0.0), max(count, len(odd))
    if count > meant.count // 2:
        return [f"hinges are up to {np.degrees(worst):.2g} degrees off the axes of the rod: EI and GJ mix, order 1"]
    more = f" and {len(named) - MANY} more" * (len(named) > MANY)
    return [f"hinge off the axes of the rod: {', '.join(named[:MANY])}{more}"] if named else []


def lost_angles(lines: list[Line]) -> list[tuple[str, float, str]]:
    """(in words, relative error in order of magnitude, remedy) of rest angles that are not those of the links.

    The centre of mass of a piece of a curve is off its chord by h^2/12 times the curvature: by both links a joint turns
    by their mean curvature times h. A chord says nothing; a joint without an angle between two alike then has lost it.
    """
    (places, ways, (_, centres, _), _, bent), lengths = lines[0].curve, lines[0].links[:, :1]
    arms, turns = centres - places[:-1], np.diff(ways, axis=0)
    by = -12.0 * (arms - np.einsum("ni,ni->n", arms, ways)[:, None] * ways) / lengths
    sizes = np.linalg.norm(by, axis=1)
    right = 0.5 * (by[1:] + by[:-1])
    if not bent:  # hinges across lean to the same side of every link
        lean = [np.einsum("ni,ni->n", one.curve.hinges, ways) for one in lines if one.axis != "torsion"]
        most, total = max(lean, key=lambda one: float(abs(one).max())), max(float(abs(one.sum())) for one in lean)
        if abs(most).max() > TILT and total > len(ways) * TILT:
            text = f"hinges across are up to {np.degrees(abs(most).max()):.2g} degrees off the axes of the links"
            return [(text, total, "give the bodies the angles of the curve at rest, or turn the hinges")]
        if np.median(sizes) < 0.5 * sizes.max():  # a body on one link or another
            return []
    if bent and _lengths(lines)[1]:
        around, size = 0.5 * (turns[2:] + turns[:-2]), np.linalg.norm(turns, axis=1)
        alike = np.linalg.norm(turns[2:] - turns[:-2], axis=1) < LOST[1] * np.linalg.norm(around, axis=1)
        lost = alike & (size[1:-1] < LOST[1] * np.linalg.norm(around, axis=1))
        right = turns.copy()
        right[1:-1] += lost[:, None] * (around - turns[1:-1])
    jumps = _nearby(np.linalg.norm(np.diff(by, axis=0), axis=1))  # a curve may begin inside a link
    apart, (before, after) = right - turns, (np.linalg.norm(each, axis=1) for each in (turns, right))
    sizes = np.linalg.norm(apart, axis=1)
    odd = sizes > LOST[0] + LOST[1] * np.maximum(before, after) + jumps
    if not odd.any():
        return []
    j = int(np.argmax(sizes * odd > 0.9 * sizes[odd].max()))
    more = f" and {odd.sum() - 1} more" * bool(odd.sum() > 1)
    text = f"rest angle {round(np.degrees(before[j]), 1):g} degrees at {shown(lines[0].joints[j + 1])}{more}"
    text += f", by its links {round(np.degrees(after[j]), 1):g} degrees"
    size = max(float(sizes[odd].max()), float(np.linalg.norm(apart[odd].sum(axis=0))))
    return [(text, size, "give the bodies the angles of the curve at rest, or centres of mass to these angles")]


def _nearby(values: Array) -> Array:
    """The largest of a value and both next to it, above 0."""
    wide = np.pad(values, 1)
    return np.asarray(np.max([wide[:-2], values, wide[2:]], axis=0))


def _unsure(line: Line) -> Array:
    """Relative error of the lengths of links by those of the others, (N,): what the spline adds to their chords."""
    places, centres = line.curve.places, line.links[:, 2]
    chords = np.linalg.norm(np.diff(places, axis=0), axis=1)
    more = np.diff(spline(places)[0]) / chords - 1.0
    unsure = np.asarray(_nearby(more) + np.median(more))
    unsure[-1] += abs(2.0 * centres[-2] / chords[-2] - 1.0)  # it is by its centre of mass, as of the link before
    return unsure


def _lengths(lines: list[Line]) -> tuple[list[Line], bool]:
    """The lines with the lengths of the curve where links are its pieces; whether they are its chords."""
    places, ways, (_, centres, _), *_ = lines[0].curve
    arcs, chords, arms = np.diff(spline(places)[0]), lines[0].links[:, 0], centres - places[:-1]
    off = np.linalg.norm(np.cross(arms, ways), axis=1)
    if off.sum() < 0.5 * np.sqrt(np.maximum(arcs * (arcs - chords) / 6.0, 0.0)).sum():  # half of that of an arc
        return lines, True
    return [line._replace(links=np.column_stack([arcs, line.links[:, 1:]])) for line in lines], False


def _rod(lines: list[Line], laws: list[Law], density: Law, plane: bool) -> tuple[Rod, Any]:
    """(rod of links, its values by the laws of the joints, in a plane `u` is in it; which of its points are joints)."""
    places, ways, (_, _, inertias), hinges, _ = lines[0].curve
    lengths, (s, place) = lines[0].links[:, 0], spline(places)
    steps = [_steps(law, s, lengths) if law.kind != "smooth" else np.zeros(0) for law in laws]
    heavy = s[:0]
    if density.kind == "stepped":  # inside a link by its mass
        j = 1 + np.flatnonzero(np.diff(density.links))
        before, after = density.links[j - 1], density.links[j]
        heavy = s[j] + np.diff(s)[j] * np.round((density.joints[j] - after) / (before - after), 3)
    cuts = np.sort(np.concatenate([s, *steps, heavy]))
    apart = np.isin(cuts, s) | (np.diff(cuts, prepend=-1.0) > AT * s[-1])
    cuts = np.unique(cuts[apart & (np.isin(cuts, s) | (abs(cuts[:, None] - s).min(axis=1) > AT * s[-1]))])
    middle = 0.5 * (cuts[1:] + cuts[:-1])
    link = np.searchsorted(s[1:-1], middle)
    along = (np.stack([cuts[:-1], cuts[1:]], axis=1) - s[link, None]) / np.diff(s)[link, None]

    def at(pairs: Array) -> Array:
        """A value at both ends of each part by those at both ends of each link, (N, 2)."""
        return np.asarray(pairs[link, :1] + along * np.diff(pairs, axis=1)[link]).ravel()

    def of(law: Law, steps: Array) -> Array:
        if law.kind == "smooth":
            return at(np.stack([law.joints, np.append(law.joints[1:], law.joints[-1])], axis=1))
        levels = law.links[np.append(0, 1 + np.flatnonzero(np.diff(law.links)))]
        return np.repeat(levels[np.searchsorted(steps, middle)], 2)

    spins = np.ones(len(ways)) if plane else np.einsum("ni,nij,nj->n", ways, inertias, ways) / lengths
    about = {line.axis: of(law, step) for line, law, step in zip(lines, laws, steps, strict=True)}
    ei, *others = about.values()
    ei2 = others[0] if others else ei
    gj = about.get("torsion", RIGID * np.maximum(ei, ei2))
    values = [
        ei,
        ei2,
        gj,
        at(_even(density.joints)) if not len(heavy) else of(density, heavy),
        at(_even(spins)),
        *np.zeros((3, len(ei))),
    ]
    points = np.repeat(place(cuts), 2, axis=0)[1:-1]
    rod = Rod(points, np.stack(values, axis=1), not plane, np.cross(hinges[0], ways[0]))
    if not plane:
        frames = rod.frames(np.unique(rod.s))[:-1][np.isin(cuts, s)[:-1]]
        turned = np.einsum("ni,nij->nj", np.cross(hinges, frames[:, :, 0]), frames)
        roll = _steady(0.5 * np.unwrap(2.0 * np.arctan2(-turned[:, 1], turned[:, 2])), s[:-1])
        rod.values[:, VALUES.index("roll")] = at(np.stack([roll, np.append(roll[1:], roll[-1])], axis=1))
    return rod, np.isin(cuts, s)


def _steps(law: Law, s: Array, lengths: Array) -> Array:
    """Arc lengths of steps of EI, by the compliance of the joint there: in a half link before or behind it."""
    at, half = 1 + np.flatnonzero(np.diff(law.links)), 0.5 * lengths
    before, after, whole = law.links[at - 1], law.links[at], half[at - 1] + half[at]
    part = (whole / law.joints[at] - whole / after) / (1.0 / before - 1.0 / after)
    part = np.where(np.isin(at, law.odd), half[at - 1], np.clip(part, 0.0, whole)) - half[at - 1]
    part = np.round(part / whole, 3) * whole  # as those about other axes
    return np.asarray(
        s[at] + part * np.where(part < 0.0, np.diff(s)[at - 1] / lengths[at - 1], np.diff(s)[at] / lengths[at])
    )


def _steady(roll: Array, s: Array) -> Array:
    """Rolls of hinges at arc lengths, rad, without those of single joints off their neighbours."""

    def apart(roll: Array) -> Array:
        share = (s[1:-1] - s[:-2]) / (s[2:] - s[:-2])
        return np.asarray(roll[:-2] + share * (roll[2:] - roll[:-2]) - roll[1:-1])

    for _ in range(len(roll) // 5):
        off, trial = apart(roll), roll.copy()
        j = int(abs(off).argmax())
        trial[j + 1] += off[j]
        if abs(off[j]) < TILT or abs(apart(trial)[max(j - 1, 0) : j + 2]).max() > 0.25 * abs(off[j]):
            break
        roll = trial
    return roll


def _even(values: Array) -> Array:
    """Values of links at their ends, (N, 2): linear between the middles, or, with steps, constant in each."""
    steps = abs(np.diff(values))
    around = np.maximum(np.append(steps[1:], steps[-2]), np.append(steps[1], steps[:-1]))
    if (steps > JUMP * around + 1e-6 * values.min()).any():
        return np.stack([values, values], axis=1)
    inner = 0.5 * (values[1:] + values[:-1])
    first, last = 1.5 * values[[0, -1]] - 0.5 * values[[1, -2]]
    return np.stack([np.append(first, inner), np.append(inner, last)], axis=1)


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
