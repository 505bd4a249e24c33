"""Likely causes of the errors of a run: values that mistakes give, the discretisation, the time step's own damping."""

from collections.abc import Mapping, Sequence
from math import pi
from statistics import median

import numpy as np

from verify.arrays import Array
from verify.compare.candidates import EULER, Candidate, candidates, frequencies_hz
from verify.formatting import with_unit
from verify.problem.beam import Beam
from verify.problem.phrase import PREFIX
from verify.scene.file import load_beam
from verify.sheets.reading import frequency_of
from verify.sheets.sheet import Figure, Sheet

ALIKE = 1.25
"""Factor within which the steps that several modes imply are one step: damping beyond the first order is less."""
FOLLOWS = 5.0
"""Largest error of a damping ratio, over the largest of the frequencies, that a wrong stiffness or mass makes."""
EXCESS = 1e-4
"""Damping ratio beyond the exact one that has no cause: that of a record of finite length."""

NEAR, SHARE = 3e-3, 0.2
"""Largest rms difference from a candidate, and over the rms error of the run: time steps move frequencies too."""
MANY = range(4, 61)
UNIFORM = 0.05
"""Largest deviation, over the mean error, of frequencies that are off by one factor."""
MILLI = 0.05
"""Relative difference from a thousand of the ratio of a value in mm to one in m."""
RIGHT = "give the joints at the wall Gregory's weights, EI/l times 8/3, 6/7, 24/23, or one of 2EI/l"
GOOD = {"gregory": "take more links", "half": "take more links, or Gregory's weights: EI/l times 8/3, 6/7, 24/23"}
BODIES = "give every link its mass m l at its centre, and the inertia m l^3/12 about it"


def cause(sheet: Sheet, figure: Figure, value: float, values: Mapping[str, float], count: int | None) -> str:
    """What makes the figure of a run what it is, '' where nothing is known; `values`: all figures of the run."""
    for one in figure.cause:
        if abs(value - one.value) <= one.within * abs(one.value):
            return one.because
    if figure.unit == "m" and figure.exact and abs(value / figure.exact / 1e3 - 1.0) < max(figure.within, MILLI):
        return f"{figure.column!r} is in mm: write the unit behind its name, as in '{figure.column}_mm'"
    if figure.read == "damping":
        rings = [one.error(values[one.name]) for one in sheet.figure if one.read == "frequency" and one.name in values]
        follows = abs(figure.error(value)) < FOLLOWS * max(map(abs, rings), default=0.0)
        return "" if follows else numerical_damping(sheet, values)
    if figure.read == "frequency" and sheet.chain:
        return discretisation(sheet, values, count)
    return ""


def numerical_damping(sheet: Sheet, values: Mapping[str, float]) -> str:
    """Damping that the model does not have: first-order steps add omega h/2 to every damping ratio."""
    off = {}
    for figure in sheet.figure:
        if figure.read == "damping" and figure.name in values:
            excess = values[figure.name] - figure.exact
            if abs(excess) > max(EXCESS, figure.uncertainty):
                off[figure.mode] = excess, 2.0 * pi * frequency_of(sheet, figure)
    if not off:
        return ""
    gained = [mode for mode, (excess, _) in off.items() if excess < 0.0]
    damped = [one for one in sheet.figure if one.read == "damping" and one.exact > 0.0 and one.name in values]
    if all(abs(values[one.name]) < EXCESS * one.exact for one in damped):
        return "nothing damps the run: add the dashpots that the sheet says"
    if gained:
        listed = " and ".join(map(str, gained))
        text = f"the time step feeds energy into mode {listed}, or the dashpots are too weak"
        return f"{text}: halve the step to tell which, and take an implicit integrator or the dashpots of the sheet"
    steps = [2.0 * excess / omega for excess, omega in off.values()]
    if len(steps) > 1 and max(steps) < ALIKE * min(steps):
        step, ratios = with_unit(median(steps), "s"), [values[one.name] / one.exact for one in damped]
        # dashpots in proportion to the springs are as steps of order 1
        dashpots = f", or dashpots are {median(ratios):.3g} times those of the sheet" * (
            len(ratios) > 1 and max(ratios) < ALIKE * min(ratios)
        )
        return (
            f"the integrator damps as implicit Euler does at {step}{dashpots}: take one of order 2, or halve the step"
        )
    return "the integrator or a dashpot damps more than the sheet says: halve the step to tell which"


def discretisation(sheet: Sheet, values: Mapping[str, float], count: int | None) -> str:
    """The chains of `compare`'s candidates with the frequencies of the run, of `count` links or any number."""
    figures = [one for one in sheet.figure if one.read == "frequency" and one.name in values]
    if sheet.chain is None or sheet.chain.space or any(sheet.chain.gravity) or len(figures) < 2:
        return ""
    beam = load_beam(PREFIX + sheet.chain.beam).beam
    measured, exact = (np.log([values[one.name] for one in figures]), np.log([one.exact for one in figures]))
    off, modes = measured - exact, [one.mode for one in figures]
    near = min(NEAR, SHARE * float(np.sqrt((off**2).mean())))
    found = [one for one in _nearest(beam, measured, modes, [count] if count else MANY) if one[0] <= near]
    if not found:
        if float(off.std()) < min(NEAR, UNIFORM * abs(float(off.mean()))):
            factor = float(np.exp(off.mean()))
            text = f"all frequencies are {factor:.4g} times the exact ones, stiffness over mass {factor**2:.4g} times"
            return f"{text}: check E, density, section and length"
        return "" if count else "the number of links would tell the cause: give it with --counts"
    candidate, chains = found[0][2], " or ".join(f"{n} {one.label}" for _, n, one in found[:2])
    remedy = RIGHT if candidate.mass == "links" else BODIES
    if candidate.mass == "links" and candidate.wall in GOOD:
        remedy = GOOD[candidate.wall]
    fitted = "" if count else ", N fitted"
    return f"these are the frequencies of {chains}{fitted}: {remedy}"


def _nearest(beam: Beam, logs: Array, modes: list[int], counts: Sequence[int]) -> list[tuple[float, int, Candidate]]:
    """(rms difference of logarithms of frequencies, links, candidate) of each chain with its best number of links."""
    best = list[tuple[float, int, Candidate]]()
    for candidate in candidates(beam, "segments"):
        if candidate.sized and candidate.theory == EULER:
            fits = []
            for n in counts:
                hertz = frequencies_hz(candidate, beam, n, max(modes))
                if len(hertz) >= max(modes):
                    off = np.log(hertz[[mode - 1 for mode in modes]]) - logs
                    fits.append((float(np.sqrt((off**2).mean())), n, candidate))
            best += [min(fits, key=lambda one: one[:2])] if fits else []
    return sorted(best, key=lambda one: one[:2])
