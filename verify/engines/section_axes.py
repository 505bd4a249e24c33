"""Which way the section of a chain lies: by its stiffnesses, by what is drawn, by inertias and by the beam it means.

A section of depth b across the hinges and a along them has EI in proportion to a b^3: EI in both planes are as the
squares of the sides.
"""

from math import exp, log
from typing import NamedTuple

import numpy as np

from verify.engines.description import AXES, Axis
from verify.engines.line import Line
from verify.problem.beam import Beam, in_plane

APART = log(1.2)
"""Logarithm of a ratio of stiffnesses or squares of sides up to which a section is as good as square."""


class Contradiction(NamedTuple):
    """What contradicts in words, the relative error of a frequency that it means, what to change."""

    text: str
    size: float
    remedy: str


def inner_stiffness(line: Line) -> float:
    """EI of the inner joints, N m^2."""
    steps = line.links[:, 0]
    return float(np.median(0.5 * (steps[1:] + steps[:-1]) * line.springs[1:]))


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


def contradictions(found: list[Line], axes: list[Axis], beam: Beam | None) -> list[Contradiction]:
    """Of the stiffnesses, the section that is drawn, the inertias and the beam."""
    line, several = found[0], list[Contradiction]()
    drawn, inert = (log(one) if one > 0.0 else 0.0 for one in line.deep)
    if drawn * inert < 0.0 and min(abs(drawn), abs(inert)) > APART:
        text = f"along hinges {line.about} the section is {_side(drawn)} as drawn, {_side(inert)} by the inertias"
        several.append(Contradiction(text, _error(drawn - inert), "turn the geoms or the inertias"))
    wrong = [i for i, one in enumerate(found) if beam and _nearest(one, beam) != axes[i]]
    if beam and wrong and abs(_beam_ratio(beam)) > APART:
        one, axis, other = found[wrong[0]], axes[wrong[0]], AXES[axes[wrong[0]] == AXES[0]]
        stiffness, means = inner_stiffness(one), in_plane(beam, axis).bending_stiffness
        size = _error(log(stiffness / means))
        if line.ball:
            text = f"ball joints have one EI, {stiffness:.6g} N m2, the beam has {means:.6g} in {axis}"
            several.append(Contradiction(text, size, f"give hinges {line.about} and {line.across} in their place"))
        else:
            text = f"hinges {one.about} bend the section in {axis} and have the stiffness of {other}"
            turn = f"turn them to {one.across}" if len(found) == 1 else "swap the axes of the hinges"
            several.append(Contradiction(text, size, f"{turn}, or turn the section"))
    elif not beam and len(found) > 1 and (drawn or inert):
        ratio, section = log(inner_stiffness(line) / inner_stiffness(found[1])), drawn or inert
        if abs(ratio - section) > APART:
            sides = f"by its sides {'as drawn' if drawn else 'behind the inertias'} {exp(section):.3g} times"
            text = f"hinges {line.about} have {exp(ratio):.3g} times the stiffness of hinges {found[1].about}, {sides}"
            remedy = "give two hinges in place of each ball joint" if line.ball else "check the stiffnesses"
            remedy = "swap the axes of the hinges, or turn the section" if ratio * section < 0.0 else remedy
            several.append(Contradiction(text, _error(ratio - section), remedy))
    return several


def _side(logarithm: float) -> str:
    return "thin" if logarithm > 0.0 else "wide"


def _error(logarithm: float) -> float:
    """Relative error of the lower frequency by a ratio of stiffnesses."""
    return 1.0 - exp(-0.5 * abs(logarithm))
