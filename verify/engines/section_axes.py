"""Which way the section of a chain lies: by its stiffnesses, by what is drawn, by inertias and by the beam it means.

A section of depth b across the hinges and a along them has EI in proportion to a b^3: EI in both planes are as the
squares of the sides.
"""

from math import exp, log

import numpy as np

from verify.engines.description import AXES, Axis
from verify.engines.line import Line
from verify.engines.rules import half_links
from verify.problem.beam import Beam, in_plane

APART = log(1.2)
"""Logarithm of a ratio of stiffnesses or squares of sides up to which a section is as good as square."""


def inner_stiffness(line: Line) -> float:
    """EI of the inner joints, N m^2."""
    return float(np.median((line.springs * half_links(line.links[:, 0]))[1:]))


def planes(found: list[Line], beam: Beam | None) -> list[Axis]:
    """The plane of each line: by the sides of the section, else by its stiffness."""
    (thin, thick), line = AXES[:2], found[0]
    if beam and _beam_ratio(beam) > 0.0:
        thin, thick = thick, thin
    known = [log(one) for one in line.deep if one > 0.0 and abs(log(one)) > APART]
    if known:
        first = thick if known[0] > 0.0 else thin
    elif len(found) > 1:
        first = thick if log(inner_stiffness(line) / inner_stiffness(found[1])) > APART else thin
    else:
        first = _nearest(line, beam) if beam else AXES[0]
    return [first, thick if first == thin else thin][: len(found)]


def _beam_ratio(beam: Beam) -> float:
    """Logarithm of EI in bending over EI in width."""
    bending, width = (in_plane(beam, axis).bending_stiffness for axis in AXES[:2])
    return log(bending / width)


def _nearest(line: Line, beam: Beam) -> Axis:
    """The plane of a beam whose EI is nearest."""
    stiffness = inner_stiffness(line)
    return min(AXES[:2], key=lambda axis: abs(log(stiffness / in_plane(beam, axis).bending_stiffness)))


def contradictions(found: list[Line], axes: list[Axis], beam: Beam | None) -> list[tuple[str, float, str]]:
    """(in words, relative error of the lower frequency, remedy) of stiffnesses, drawn section, inertias and beam."""
    line, several = found[0], list[tuple[str, float, str]]()
    drawn, inert = (log(one) if one > 0.0 else 0.0 for one in line.deep)
    if drawn * inert < 0.0 and min(abs(drawn), abs(inert)) > APART:
        sides = ["deep" if one > 0.0 else "flat" for one in (drawn, inert)]
        text = f"across hinges {line.about} the section is {sides[0]} as drawn and {sides[1]} by the inertias"
        several.append((text, 1.0 - exp(-0.5 * abs(drawn - inert)), "turn the geoms or the inertias"))
    if len(found) == 1:
        other = _nearest(line, beam) if beam else axes[0]
        if beam and other != axes[0] and abs(_beam_ratio(beam)) > APART:
            text = f"hinges {line.about} bend the section in {axes[0]} and have the stiffness of {other}"
            off = log(inner_stiffness(line) / in_plane(beam, axes[0]).bending_stiffness)
            several.append((text, 1.0 - exp(-0.5 * abs(off)), f"turn them to {line.across}, or turn the section"))
        return several
    ratio, means = log(inner_stiffness(line) / inner_stiffness(found[1])), drawn or inert
    if beam:
        means = _beam_ratio(beam) * (1.0 if axes[0] == AXES[0] else -1.0)
    source = "the beam" if beam else "the section as drawn" if drawn else "the inertias"
    swapped = ratio * means < 0.0 and min(abs(ratio), abs(means)) > APART
    if swapped or (abs(ratio - means) > APART and (line.ball or (means and not beam))):
        one, two = f"hinges {line.about}", f"hinges {found[1].about}"
        text = f"{one} are {exp(ratio):.3g} times as stiff as {two}, by {source} {exp(means):.3g} times"
        if line.ball:
            text = f"ball joints have one stiffness, by {source} {one} are {exp(means):.3g} times as stiff as {two}"
        remedy = "give two hinges in place of each" if line.ball else "correct one of them"
        remedy = "swap the axes of the hinges, or turn the section" if swapped else remedy
        several.append((text, 1.0 - exp(-0.5 * abs(ratio - means)), remedy))
    return several
