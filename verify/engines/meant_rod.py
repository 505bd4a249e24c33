"""The rod that the joints and links of a file mean, along the curve through the joints.

EI = k (l + l')/2 of a joint between links l and l', and GJ likewise, each by a law along the rod; l are parts of the
curve where the links are its pieces, with their centres of mass off the chords, else chords. Masses and polar inertias
are those of the links.
"""

from collections.abc import Sequence

import numpy as np

from verify.arrays import Array
from verify.engines.line import Line
from verify.engines.rod import VALUES, Rod, spline
from verify.engines.stiffness_law import Law, fitted_law, named
from verify.errors import InputError, shown

UNEVEN = 0.01
"""Relative difference of mass per length from which a link differs."""
JUMP = 3.0
"""Difference between two links, over that of their neighbours, from which it is a step."""
HEAVY = 1.5
"""Mass per length over that of both neighbours from which a link carries a body."""
SAME_PLACE = 1e-6
"""Distance over the length up to which steps are at one place."""
RIGID = 1e3
"""GJ over EI of a chain without hinges in torsion."""
TILT = 5e-3
"""Angle of a hinge off the axes of a joint, rad, from which it is no rounding: an error of its square and EI/GJ."""


def along_curve(lines: list[Line]) -> tuple[list[Line], bool]:
    """The lines with the lengths of the curve where links are its pieces; whether they are its chords."""
    places, directions, (_, centres, _), *_ = lines[0].curve
    arcs, chords, arms = np.diff(spline(places)[0]), lines[0].links[:, 0], centres - places[:-1]
    off = np.linalg.norm(np.cross(arms, directions), axis=1)
    if off.sum() < 0.5 * np.sqrt(np.maximum(arcs * (arcs - chords) / 6.0, 0.0)).sum():  # half of that of an arc
        return lines, True
    return [line._replace(links=np.column_stack([arcs, line.links[:, 1:]])) for line in lines], False


def length_errors(line: Line) -> Array:
    """Relative errors of lengths of links by those of the others, (N,): what the spline adds to their chords."""
    places, centres = line.curve.places, line.links[:, 2]
    chords = np.linalg.norm(np.diff(places, axis=0), axis=1)
    added = np.diff(spline(places)[0]) / chords - 1.0
    errors = np.asarray(largest_nearby(added) + np.median(added))
    errors[-1] += abs(2.0 * centres[-2] / chords[-2] - 1.0)  # it is by its centre of mass, as of the link before
    return errors


def largest_nearby(values: Array) -> Array:
    """The largest of a value and both next to it, above 0."""
    wide = np.pad(values, 1)
    return np.asarray(np.max([wide[:-2], values, wide[2:]], axis=0))


def law_of_masses(line: Line, errors: Array, name: str) -> tuple[Law, list[str]]:
    """(law of masses per length, without those off it, the latter in words). Raises InputError."""
    (lengths, masses), joints = line.links.T[:2], line.joints
    density, middles = masses / lengths, np.cumsum(lengths) - 0.5 * lengths
    heavy = density > HEAVY * np.maximum(np.append(density[1:], 0.0), np.append(0.0, density[:-1]))
    if heavy.any():
        link = shown(joints[int(heavy.argmax())])
        raise InputError(f"{name}: the link of joint {link} carries a body, on a curve give the links alone")
    try:  # the first three count like the others: there is no wall
        values, places = (np.append(sign * one[2::-1], one) for sign, one in ((1.0, density), (-1.0, middles)))
        law = fitted_law(values, places, [*joints[2::-1], *joints])
    except InputError:
        return Law("", density, density, []), []
    ratios = density / law.joints[3:]
    odd = [j - 3 for j in law.odd if j > 2 and abs(ratios[j - 3] - 1.0) > UNEVEN + errors[j - 3]]
    right = np.where(np.isin(range(len(density)), odd), law.joints[3:], density)
    return law._replace(joints=right, links=law.links[3:], odd=odd), named("mass of the link of", joints, ratios, odd)


def meant_rod(lines: list[Line], laws: Sequence[Law], density: Law) -> tuple[Rod, Array]:
    """(rod by the laws of the joints and links, in a plane `u` is in it; arc lengths at the joints and the end, m)."""
    (places, directions, (_, _, inertias), hinges, _), plane = lines[0].curve, len(lines) == 1
    lengths, (s, place) = lines[0].links[:, 0], spline(places)
    steps, heavier = [_stiffness_steps(law, s, lengths) for law in laws], _mass_steps(density, s)
    cuts = _cuts(s, np.concatenate([*steps, heavier]))
    middle = 0.5 * (cuts[1:] + cuts[:-1])
    link = np.searchsorted(s[1:-1], middle)
    along = (np.stack([cuts[:-1], cuts[1:]], axis=1) - s[link, None]) / np.diff(s)[link, None]

    def at(pairs: Array) -> Array:
        """A value at both ends of each part by those at both ends of each link, (N, 2)."""
        return np.asarray(pairs[link, :1] + along * np.diff(pairs, axis=1)[link]).ravel()

    def between(joints: Array) -> Array:
        """Linear from joint to joint, constant beyond the last."""
        return at(np.stack([joints, np.append(joints[1:], joints[-1])], axis=1))

    def stepped(law: Law, steps: Array) -> Array:
        levels = law.links[np.append(0, 1 + np.flatnonzero(np.diff(law.links)))]
        return np.repeat(levels[np.searchsorted(steps, middle)], 2)

    spins = np.ones(len(directions)) if plane else np.einsum("ni,nij,nj->n", directions, inertias, directions) / lengths
    pairs = zip(laws, steps, strict=True)
    each = [between(law.joints) if law.kind == "smooth" else stepped(law, x) for law, x in pairs]
    about = dict(zip((line.axis for line in lines), each, strict=True))
    ei, ei2 = each[0], each[1 if len(each) > 1 else 0]
    mass = stepped(density, heavier) if len(heavier) else at(_at_ends(density.joints))
    values = [ei, ei2, about.get("torsion", RIGID * np.maximum(ei, ei2)), mass, at(_at_ends(spins))]
    rows = np.stack([*values, *np.zeros((3, len(ei)))], axis=1)
    rod = Rod(np.repeat(place(cuts), 2, axis=0)[1:-1], rows, not plane, np.cross(hinges[0], directions[0]))
    joints = np.unique(rod.s)[np.isin(cuts, s)]
    if not plane:
        frames = rod.frames(np.unique(rod.s))[np.isin(cuts, s)][:-1]
        turned = np.einsum("ni,nij->nj", np.cross(hinges, frames[:, :, 0]), frames)
        roll = 0.5 * np.unwrap(2.0 * np.arctan2(-turned[:, 1], turned[:, 2]))
        rod.values[:, VALUES.index("roll")] = between(_without_outliers(roll, s[:-1]))
    return rod, joints


def _cuts(s: Array, steps: Array) -> Array:
    """Arc lengths of joints `s` and of steps apart from these and from each other, ascending."""
    cuts = np.sort(np.append(s, steps))
    apart = np.diff(cuts, prepend=-1.0) > SAME_PLACE * s[-1]
    return np.unique(cuts[np.isin(cuts, s) | (apart & (abs(cuts[:, None] - s).min(axis=1) > SAME_PLACE * s[-1]))])


def _stiffness_steps(law: Law, s: Array, lengths: Array) -> Array:
    """Arc lengths of steps of EI, by the compliance of the joint there: in a half link before or behind it."""
    if law.kind == "smooth":
        return s[:0]
    at, half = 1 + np.flatnonzero(np.diff(law.links)), 0.5 * lengths
    before, after, whole = law.links[at - 1], law.links[at], half[at - 1] + half[at]
    part = (whole / law.joints[at] - whole / after) / (1.0 / before - 1.0 / after)
    part = np.where(np.isin(at, law.odd), half[at - 1], np.clip(part, 0.0, whole)) - half[at - 1]
    part = np.round(part / whole, 3) * whole  # as those about other axes
    link = at - (part < 0.0)
    return np.asarray(s[at] + part * np.diff(s)[link] / lengths[link])


def _mass_steps(density: Law, s: Array) -> Array:
    """Arc lengths of steps of mass per length, inside a link by its mass."""
    if density.kind != "stepped":
        return s[:0]
    j = 1 + np.flatnonzero(np.diff(density.links))
    before, after = density.links[j - 1], density.links[j]
    return np.asarray(s[j] + np.diff(s)[j] * np.round((density.joints[j] - after) / (before - after), 3))


def _without_outliers(roll: Array, s: Array) -> Array:
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


def _at_ends(values: Array) -> Array:
    """Values of links at their ends, (N, 2): linear between the middles, or, with steps, constant in each."""
    steps = abs(np.diff(values))
    around = np.maximum(np.append(steps[1:], steps[-2]), np.append(steps[1], steps[:-1]))
    if (steps > JUMP * around + 1e-6 * values.min()).any():
        return np.stack([values, values], axis=1)
    inner = 0.5 * (values[1:] + values[:-1])
    first, last = 1.5 * values[[0, -1]] - 0.5 * values[[1, -2]]
    return np.stack([np.append(first, inner), np.append(inner, last)], axis=1)
