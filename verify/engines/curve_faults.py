"""What deviates from the rod that a file means: links, hinges and rest angles of a chain that is curved at rest."""

from typing import Any

import numpy as np

from verify.arrays import Array
from verify.engines.curved import CurvedChain
from verify.engines.description import AXES
from verify.engines.line import Line
from verify.engines.meant_rod import TILT, along_curve, largest_nearby
from verify.engines.stiffness_law import first, named
from verify.errors import shown

SHARE, JUMPED, DECAY = 0.1, 0.5, 2.0 - 3.0**0.5
"""Angle of hinges off the axes of a joint over the rest angle and over its changes from which they are named.

Axes by the joints alone are uncertain by a part of the rest angle; by what a cubic spline overshoots at a jump of the
curvature, 1/(4 3^(1/2)) = 0.14 of the change between even joints, which decays from joint to joint; three times that
leaves room for uneven ones. Hinges about the axes of one link are off by half the rest angle.
"""
INERTIA, CENTRE = 0.1, 0.02
"""Relative difference of an inertia, and distance of a centre of mass over the length, from which a link differs."""
LOST = 0.01, 0.2
"""Difference, rad and relative, between rest angles and those by the links from which they are no rounding."""


def links_off(lines: list[Line], meant: CurvedChain, errors: Array) -> list[str]:
    """Inertias and centres of mass that are not those of pieces of the rod; `errors` of lengths, relative."""
    (lengths, masses, centres, about), curve, joints = lines[0].links.T, lines[0].curve, lines[0].joints
    faults, directions, plane = list[str](), curve.directions, len(lines) == 1
    chords = np.linalg.norm(np.diff(curve.places, axis=0), axis=1)
    across, right = (  # those about both directions across the link, without the section's
        np.trace(each, axis1=1, axis2=2) - 2.0 * np.einsum("ni,nij,nj->n", directions, each, directions)
        for each in (curve.bodies[2], meant.bodies[2])
    )
    ratios, straight = across / right, masses * chords**2 / (12.0 if plane else 6.0) / right
    if plane:  # of a body of one inertia, or of one with those of both sides
        ratios = np.where(_outside(0.5 * ratios, 1.0, straight) < INERTIA, 1.0, about / right)
    odd = np.flatnonzero(_outside(ratios, 1.0, straight) > INERTIA + 2.0 * errors)
    if len(odd) > len(lengths) // 2:
        inertia = float(np.median(ratios)) / 12.0
        words = "point masses" if inertia < 1e-3 else f"inertia {inertia:.3g} m l^2"
        faults.append(f"{words} in place of m l^2/12")
    else:
        faults += named("inertia of the link of", joints, ratios, odd.tolist())
    middle = np.einsum("ni,ni->n", meant.bodies[1] - meant.places[:-1], directions)
    odd = np.flatnonzero(_outside(centres, middle, 0.5 * chords) > (CENTRE + 0.5 * errors) * lengths)
    if len(odd) > len(lengths) // 2:
        return [*faults, f"centre of mass at {float(np.median(centres / lengths)):.3g} l in place of l/2"]
    return faults + named("centre of mass of the link of", joints, centres / middle, odd.tolist())


def _outside(values: Array, piece: Any, chord: Array) -> Array:
    """Distance of values from those between a piece of the rod and a uniform straight link."""
    return np.asarray(abs(values - np.clip(values, np.minimum(piece, chord), np.maximum(piece, chord))))


def hinges_off(lines: list[Line], meant: CurvedChain) -> list[str]:
    """Hinges off the axes of the rod at their joints."""
    rest = np.array([meant.rest_angle(j) for j in range(meant.count)])
    rest[:1], joints = rest[1:2], np.arange(meant.count)
    joints[:1] = 2  # the first two parts of the spline are one cubic
    near = DECAY ** abs(joints[:, None] - joints[1:] + 0.5)
    unknown = SHARE * rest + JUMPED * near @ abs(np.diff(rest))
    texts, worst, count = list[str](), 0.0, 0
    for line in lines:
        off = np.linalg.norm(np.cross(line.curve.hinges, meant.axes_at[:, :, (AXES.index(line.axis) + 1) % 3]), axis=1)
        odd = np.flatnonzero(off > np.maximum(TILT, unknown))
        texts += [f"{line.joints[j] or 'the wall'} ({np.degrees(off[j]):.2g} degrees)" for j in odd]
        worst, count = max(worst, *off[odd], 0.0), max(count, len(odd))
    if count > meant.count // 2:
        return [f"hinges are up to {np.degrees(worst):.2g} degrees off the axes of the rod: EI and GJ mix, order 1"]
    return [f"hinge off the axes of the rod: {first(texts)}"] if texts else []


def lost_angles(lines: list[Line]) -> list[tuple[str, float, str]]:
    """(in words, relative error in order of magnitude, remedy) of rest angles that are not those of the links.

    The centre of mass of a piece of a curve is off its chord by h^2/12 times the curvature: by both links a joint turns
    by their mean curvature times h. A chord says nothing; a joint without an angle between two alike then has lost it.
    """
    (places, directions, (_, centres, _), _, bent), lengths = lines[0].curve, lines[0].links[:, :1]
    arms, turns = centres - places[:-1], np.diff(directions, axis=0)
    by = -12.0 * (arms - np.einsum("ni,ni->n", arms, directions)[:, None] * directions) / lengths
    right = 0.5 * (by[1:] + by[:-1])
    if not bent:  # hinges across lean to the same side of every link
        lean = [np.einsum("ni,ni->n", one.curve.hinges, directions) for one in lines if one.axis != "torsion"]
        most, total = max(lean, key=lambda one: float(abs(one).max())), max(float(abs(one.sum())) for one in lean)
        if abs(most).max() > TILT and total > len(directions) * TILT:
            text = f"hinges across are up to {np.degrees(abs(most).max()):.2g} degrees off the axes of the links"
            return [(text, total, "give the bodies the angles of the curve at rest, or turn the hinges")]
        if np.median(sizes := np.linalg.norm(by, axis=1)) < 0.5 * sizes.max():  # a body on one link or another
            return []
    if bent and along_curve(lines)[1]:
        around, size = 0.5 * (turns[2:] + turns[:-2]), np.linalg.norm(turns, axis=1)
        limit = LOST[1] * np.linalg.norm(around, axis=1)
        lost = (np.linalg.norm(turns[2:] - turns[:-2], axis=1) < limit) & (size[1:-1] < limit)
        right = turns.copy()
        right[1:-1] += lost[:, None] * (around - turns[1:-1])
    jumps = largest_nearby(np.linalg.norm(np.diff(by, axis=0), axis=1))  # a curve may begin inside a link
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
