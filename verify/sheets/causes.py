"""Likely causes of the errors of a run: values that mistakes give, the discretisation, the time step's own damping."""

from collections.abc import Callable, Mapping, Sequence
from contextlib import suppress
from math import log, nan, pi
from statistics import median

import numpy as np

from verify.arrays import Array
from verify.compare.candidates import EULER, Candidate, candidates, frequencies_hz
from verify.errors import InputError
from verify.formatting import with_unit
from verify.problem.beam import Beam
from verify.problem.phrase import PREFIX
from verify.scene.file import load_beam
from verify.sheets.faults import fault, noise
from verify.sheets.reading import Run, frequency_of, is_modal
from verify.sheets.reading import value as read_value
from verify.sheets.sheet import Figure, Sheet

ALIKE = 1.25
"""Factor within which the steps that several modes imply are one step: damping beyond the first order is less."""
FOLLOWS = 5.0
"""Largest error of a damping ratio, over the largest of the frequencies, that a wrong stiffness or mass makes."""
EXCESS = 1e-4
"""Damping ratio beyond the exact one that has no cause: that of a record of finite length."""

NEAR, SHARE = 3e-3, 0.25
"""Largest rms difference from a candidate, and over the rms error of the run: time steps move frequencies too."""
MANY = range(4, 61)
UNIFORM, RIGHT_SHARE = 0.03, 0.01
"""Largest difference of ratios of friction to that of the sheet which are one ratio; of one from 1."""
CLOSE = 0.05
"""Difference of two explanations, over the errors, up to which the figures do not separate them."""
FARTHEST, MOST, SURER = 1.7, 3, 0.3
"""Largest logarithm of a figure over its exact value that powers explain; most explanations that are listed; difference
of a chain with any number of links, over that of a parameter, below which it is the cause."""
ABSENT = 1e-9
"""Of a figure over its exact value, without the parameter that it is proportional to."""
MODULUS, GRAVITY = "youngs_modulus_Pa", "gravity_m_per_s2"
CLAMP = "clamp"
"""Parameter of every clamped sheet that is 0 in it: compliance of the clamp over L/EI."""
UNITS = "check units (E in Pa, lengths in m), else "
NONE = 0.01
"""Damping ratio over the exact one of a run without dashpots."""
LAWS: dict[str, Callable[[float], float]] = {"linear": float, "inverse": lambda x: 1.0 / x, "exponential": log}
"""Functions of a figure that are linear in the friction coefficient."""
RIGHT = "give the joints at the wall Gregory's weights, EI/l times 8/3, 6/7, 24/23, or one of 2EI/l"
GOOD = {"gregory": "take more links", "half": "take more links, or Gregory's weights: EI/l times 8/3, 6/7, 24/23"}
BODIES = "give every link its mass m l at its centre, and the inertia m l^3/12 about it"


def causes(sheet: Sheet, run: Run, figures: Sequence[Figure], values: Mapping[str, float]) -> dict[str, str]:
    """Causes of the errors of a run, with remedies, by name of the figure; without those that are not known.

    `values`: of the figures that the record has. A mistake in the record comes first, then its noise, values that
    mistakes give, and last what explains all figures together.
    """
    off = [one for one in figures if one.name in values and one.fails(values[one.name])]
    if not off:
        return {}

    def passes(other: Run) -> bool:
        with suppress(InputError):
            return not any(one.fails(read_value(sheet, one, other)) for one in sorted(figures, key=is_modal))
        return False

    if text := fault(run, passes, any(one.exact for one in off)):
        return dict.fromkeys((one.name for one in figures), text)
    rubs = friction(sheet, values, off)
    found = {one.name: noise(run, one, values[one.name]) or rubs or of_value(sheet, one, values) for one in off}
    common = elastic(sheet, figures, values, off, run.count)
    for one in off:
        if not found[one.name] and one.read == "first" and one.exact and not common:
            factor = values[one.name] / one.exact
            units = "" if 0.2 < factor < 5.0 and len(values) == len(figures) else UNITS
            text = f"the motion starts at {factor:.4g} times that of the sheet: {units}"
            found[one.name] = f"{text}let it start at {one.exact:.4g} {one.unit}"
        elif not found[one.name] and one.read != "damping":
            found[one.name] = unsettled(run, one, values[one.name]) or common
    return {name: text for name, text in found.items() if text}


def of_value(sheet: Sheet, figure: Figure, values: Mapping[str, float]) -> str:
    """The cause that the value of a figure tells by itself."""
    value = values[figure.name]
    for one in figure.cause:
        if abs(value - one.value) <= one.within * abs(one.value):
            return one.because
    if figure.read != "damping":
        return ""
    rings = [one.error(values[one.name]) for one in sheet.figure if one.read == "frequency" and one.name in values]
    follows = abs(figure.error(value)) < FOLLOWS * max(map(abs, rings), default=0.0)
    return "" if follows else numerical_damping(sheet, values)


def unsettled(run: Run, figure: Figure, value: float) -> str:
    """Motion at the end of a record whose last value is read, where it is no less than a tenth of the error."""
    moved = float(np.ptp(run.signals[figure.column][-max(len(run.times) // 10, 2) :]))
    if figure.read != "last" or moved < 0.1 * abs(value - figure.exact):
        return ""
    text = f"{figure.column!r} still moves by {moved:.2g} {figure.unit} in the last tenth of the record"
    return f"{text}: damp it more, and check units (E in Pa, lengths in m) and the time step"


def friction(sheet: Sheet, values: Mapping[str, float], off: Sequence[Figure]) -> str:
    """The friction coefficient that the figures which are functions of it have in common."""
    shares = dict[str, float]()
    for one in sheet.figure:
        if one.frictionless is not None and (one.friction == "linear" or values.get(one.name, 0.0) > 0.0):
            value = values.get(one.name, nan)
            none, exact, found = (LAWS[one.friction](x) for x in (one.frictionless, one.exact, value))
            shares[one.name] = float((found - none) / (exact - none))
    others = any(one.powers and one.frictionless is None for one in off)  # that no friction changes
    if others or not any(one.name in shares for one in off) or max(shares.values()) - min(shares.values()) > UNIFORM:
        return ""
    share, mu = median(shares.values()), sheet.parameters["friction_coefficient"]
    if abs(share - 1.0) < RIGHT_SHARE:
        return ""
    if abs(share) < UNIFORM:
        return "there is no friction: check that the bodies touch, gravity, and the mu of their pair"
    if abs(share / mu - 1.0) < UNIFORM:
        return "friction is mu^2 N: the engine multiplies the coefficients of the two bodies; give their square roots"
    return (
        f"friction is that of mu = {share * mu:.3g}, {share:.3g} times the sheet's: give {mu:g}, else check the weight"
    )


def elastic(
    sheet: Sheet, figures: Sequence[Figure], values: Mapping[str, float], off: Sequence[Figure], count: int | None
) -> str:
    """The parameter, clamp or discretisation that explains the figures, by the least rms difference."""
    known = [one for one in figures if one.powers and one.name in values]
    if not any(one in off for one in known):
        return ""
    if any(abs(values[one.name]) < ABSENT * abs(one.exact) and GRAVITY in one.powers for one in known):
        return f"there is no gravity: give {sheet.parameters[GRAVITY]:g} m/s^2, in the direction of the sheet"
    errors = np.array([one.logarithm(values[one.name]) for one in known])
    if abs(errors).max() > FARTHEST:  # powers are of small changes
        started = any(one.read == "first" for one in off)
        return (
            ""
            if started or MODULUS not in known[0].powers
            else f"the run is far from that of the sheet: {UNITS}the step"
        )
    weights, rings = 1.0 / np.array([one.within for one in known]), np.array([one.read == "frequency" for one in known])
    size, fits = float(np.linalg.norm(weights * errors)), list[tuple[float, float, str, float]]()
    for parameter in dict.fromkeys(parameter for one in known for parameter in one.powers):
        powers = np.array([one.powers.get(parameter, 0.0) for one in known])
        change = float((weights**2 * powers) @ errors / ((weights * powers) ** 2).sum())
        rest = errors - change * powers
        fits.append((float(np.linalg.norm(weights * rest)) / size, rms(rest[rings]), parameter, change))
    least, difference, _, _ = min(fits)
    rang = any(one in off for one in known if one.read == "frequency")
    chains = discretisation(sheet, values, count) if rang else None
    if chains and (least > SHARE or chains[0] < SURER * difference):
        return chains[1]
    soft = [(name, by) for fit, _, name, by in fits if fit < least + CLOSE and (name != CLAMP or by > 0.0)]
    alike = [_change(sheet, name, by, count) for name, by in soft][:MOST]
    return f"{', or '.join(alike)}: give the sheet's" if least < SHARE else ""


def _change(sheet: Sheet, name: str, change: float, count: int | None) -> str:
    """A parameter and its error in words; of the clamp, whose change is its compliance over L/EI."""
    if name != CLAMP:
        value = sheet.parameters.get(name)
        return f"{name} is {np.exp(change):.4g} times " + ("the sheet's" if value is None else f"{value:.6g}")
    text = f"the clamp gives way by {change:.3g} L/{'GJ' if sheet.chain and sheet.chain.space else 'EI'}"
    if (links := count or (sheet.chain.count if sheet.chain else 0)) == 0:
        return text
    gregory, half = (weight / (weight + links * change) for weight in (3.0 / 8.0, 1.0 / 2.0))
    return (
        f"{text}, as where the first of {links} joints has {half:.2g} of 2EI/l or {gregory:.2g} of Gregory's stiffness"
    )


def rms(values: Array) -> float:
    """Root of the mean square, 0 of none."""
    return float(np.sqrt((values**2).mean())) if len(values) else 0.0


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
    if all(abs(values[one.name]) < NONE * one.exact for one in damped):
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


def discretisation(sheet: Sheet, values: Mapping[str, float], count: int | None) -> tuple[float, str] | None:
    """(rms difference of logarithms, cause) of the chain of `compare`, of `count` links or any number, that is nearest.

    None where the frequencies of the run are its no more than by chance.
    """
    figures = [one for one in sheet.figure if one.read == "frequency" and one.name in values]
    if sheet.chain is None or sheet.chain.space or any(sheet.chain.gravity) or len(figures) < 2:
        return None
    beam = load_beam(PREFIX + sheet.chain.beam).beam
    measured, modes = np.log([values[one.name] for one in figures]), [one.mode for one in figures]
    near = min(NEAR, SHARE * rms(measured - np.log([one.exact for one in figures])))
    found = [one for one in _nearest(beam, measured, modes, [count] if count else MANY) if one[0] <= near]
    if not found:
        return None
    candidate, chains = found[0][2], " or ".join(f"{n} {one.label}" for _, n, one in found[:2])
    remedy = RIGHT if candidate.mass == "links" else BODIES
    if candidate.mass == "links" and candidate.wall in GOOD:
        remedy = GOOD[candidate.wall]
    fitted = "" if count else ", N fitted"
    return found[0][0], f"these are the frequencies of {chains}{fitted}: {remedy}"


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
