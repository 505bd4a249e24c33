"""Likely causes of the errors of a run: values that mistakes give, the discretisation, the time step's own damping."""

from collections.abc import Callable, Mapping, Sequence
from contextlib import suppress
from math import log, pi
from statistics import median
from typing import NamedTuple

import numpy as np

from verify.analysis.verdict import per_cent
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
LOCAL, MOST_LEFT, LISTED, BETTER = 0.1, 0.5, 0.01, 0.3
"""Of a change, by which powers, which are of small changes, may err; largest part of the errors that an explanation
leaves, least that is listed; rms difference of a chain of any number of links, over a parameter's, that is listed."""
FARTHEST = 1.7
"""Largest logarithm of a figure over its exact value that powers explain."""
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


class Explanation(NamedTuple):
    """A mistake that would explain figures: a clause and what to do."""

    text: str
    remedy: str
    figures: frozenset[str]
    among: frozenset[str]
    """Figures that it explains, and those that it has to explain."""
    left: float
    """Of their errors, what it does not explain."""
    kind: str = "figures"
    """What it has to explain."""

    @property
    def scope(self) -> str:
        """'all 4 figures', '3 of 4 figures', 'the one figure that fails'."""
        n, of = len(self.figures), len(self.among)
        if of == 1:
            return "the one " + self.kind.replace("figures", "figure").replace("fail", "fails")
        return f"{f'{n} of {of}' if n < of else 'both' if n == 2 else f'all {n}'} {self.kind}"


def causes(sheet: Sheet, run: Run, figures: Sequence[Figure], values: Mapping[str, float]) -> dict[str, str]:
    """Likely causes of the errors of a run, with remedies, by name of the figure; without those that are not known.

    `values`: of the figures that the record has. A mistake in the record comes first, then its noise, then all
    mistakes that would explain the figures, those of most figures first.
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
    rigid = [one for one in figures if one.name in values and (one.powers or one.frictionless is not None)]
    among = frozenset(one.name for one in (*rigid, *off) if one.read != "damping")
    rubs = friction(sheet, values, off, among)
    alone, changes = elastic(sheet, rigid, values, off, run.count, among)
    known, found = known_values(values, off), dict[str, str]()
    for one in off:
        value, told = values[one.name], [each for each in known if one.name in each.figures]
        listed = told if one.read == "damping" else [*told, *rubs, *changes]
        if one.read == "first" and not any(one.name in each.figures for each in listed):
            listed = []
        text = noise(run, one, value) or ("" if told or rubs else unsettled(run, one, value))
        if not text and not listed and one.read == "damping":
            rings = [x.error(values[x.name]) for x in sheet.figure if x.read == "frequency" and x.name in values]
            follows = abs(one.error(value)) < FOLLOWS * max(map(abs, rings), default=0.0)
            text = "" if follows else numerical_damping(sheet, values)
        elif not (text or listed or (alone and MODULUS in one.powers)) and one.read == "first" and one.exact:
            factor = value / one.exact
            units = "" if 0.2 < factor < 5.0 and len(values) == len(figures) else UNITS
            text = f"the motion starts at {factor:.4g} times that of the sheet: {units}"
            text = f"{text}let it start at {one.exact:.4g} {one.unit}"
        found[one.name] = text or sentence(listed) or ("" if rubs or one.read == "damping" else alone)
    return {name: text for name, text in found.items() if text}


def sentence(listed: Sequence[Explanation]) -> str:
    """Explanations as conditions, those of most figures first: 'perhaps A, or B, each of which would explain ...'."""
    if not listed:
        return ""
    groups = dict[str, list[Explanation]]()
    for one in sorted(listed, key=lambda one: (-len(one.figures) / len(one.among), one.left)):
        groups.setdefault(one.scope, []).append(one)
    parts = list[str]()
    for scope, group in groups.items():
        texts = [
            f"{one.text} (leaves {per_cent(one.left)})" if LISTED < one.left < MOST_LEFT else one.text for one in group
        ]
        parts.append(f"{', or '.join(texts)}, {'each of ' * (len(group) > 1)}which would explain {scope}")
    alone = ", and one figure cannot tell a cause from others" * (set(groups) == {"the one figure"})
    remedies = ", else ".join(dict.fromkeys(one.remedy for group in groups.values() for one in group))
    return f"perhaps {', or '.join(parts)}{alone}: {remedies}"


def known_values(values: Mapping[str, float], off: Sequence[Figure]) -> list[Explanation]:
    """The mistakes that are known to give the values of figures."""
    found = dict[str, list[tuple[str, float]]]()
    for figure in off:
        value = values[figure.name]
        for one in figure.cause:
            if abs(value - one.value) <= one.within * abs(one.value):
                left = abs((value - one.value) / (value - figure.exact))
                found.setdefault(one.because, []).append((figure.name, left))
                break
    among = frozenset(one.name for one in off if one.read != "damping" or one.cause)
    return [
        Explanation(
            text,
            remedy,
            frozenset(name for name, _ in named),
            among,
            max(left for _, left in named),
            kind="figures that fail",
        )
        for (text, _, remedy), named in ((because.partition(": "), named) for because, named in found.items())
    ]


def unsettled(run: Run, figure: Figure, value: float) -> str:
    """Motion at the end of a record whose last value is read, where it is no less than a tenth of the error."""
    moved = float(np.ptp(run.signals[figure.column][-max(len(run.times) // 10, 2) :]))
    if figure.read != "last" or moved < 0.1 * abs(value - figure.exact):
        return ""
    text = f"{figure.column!r} still moves by {moved:.2g} {figure.unit} in the last tenth of the record"
    return f"{text}: damp it more, and check units (E in Pa, lengths in m) and the time step"


def friction(
    sheet: Sheet, values: Mapping[str, float], off: Sequence[Figure], among: frozenset[str]
) -> list[Explanation]:
    """The friction coefficient that the figures which are functions of it have in common."""
    shares = dict[str, float]()
    for one in sheet.figure:
        value = values.get(one.name)
        if one.frictionless is not None and value is not None and (one.friction == "linear" or value > 0.0):
            none, exact, found = (LAWS[one.friction](x) for x in (one.frictionless, one.exact, value))
            shares[one.name] = float((found - none) / (exact - none))
    others = any(one.powers and one.frictionless is None for one in off)  # that no friction changes
    if others or not any(one.name in shares for one in off) or max(shares.values()) - min(shares.values()) > UNIFORM:
        return []
    share, mu = median(shares.values()), sheet.parameters["friction_coefficient"]
    if abs(share - 1.0) < RIGHT_SHARE:
        return []
    text, remedy = f"mu is {share * mu:.3g}, {share:.3g} times the sheet's", f"give {mu:g}, else check the weight"
    if abs(share) < UNIFORM:
        text, remedy = "there is no friction", "check that the bodies touch, gravity, and the mu of their pair"
    elif abs(share / mu - 1.0) < UNIFORM:
        text = "friction is mu^2 N, as of an engine that multiplies the coefficients of the two bodies"
        remedy = "give their square roots"
    spread = max(abs(one - share) for one in shares.values())
    passing = among - {one.name for one in off}
    return [Explanation(text, remedy, passing | frozenset(shares), among, spread / abs(share - 1.0))]


def elastic(
    sheet: Sheet,
    rigid: Sequence[Figure],
    values: Mapping[str, float],
    off: Sequence[Figure],
    count: int | None,
    among: frozenset[str],
) -> tuple[str, list[Explanation]]:
    """What to say where nothing explains a figure, and the parameters, clamp or chains that would explain figures.

    A parameter explains the figures where its change brings all within what passes and leaves less than half of the
    errors; the change is that of least squares, weighted by what passes.
    """
    known = [one for one in rigid if one.powers]
    if not any(one in off for one in known):
        return "", []
    if any(abs(values[one.name]) < ABSENT * abs(one.exact) and GRAVITY in one.powers for one in known):
        text = f"it is 0, as without gravity or with rigid joints: give {sheet.parameters[GRAVITY]:g} m/s^2"
        return f"{text}, in the direction of the sheet", []
    errors = np.array([one.logarithm(values[one.name]) for one in known])
    if abs(errors).max() > FARTHEST:
        far = MODULUS in known[0].powers and not any(one.read == "first" for one in off)
        return f"the run is far from that of the sheet: {UNITS}the step" * far, []
    rings = np.array([one.read == "frequency" for one in known])
    fits, passing = fitted(known, errors), among - {one.name for one in off}
    named = passing | {one.name for one in known}
    texts = {one.parameter: _change(sheet, one.parameter, one.change, count) for one in fits}
    found = [
        Explanation(texts[one.parameter], "give the sheet's", named, among, one.left) for one in fits if one.explains
    ]
    ringing = frozenset(one.name for one in known if one.read == "frequency")
    chain = discretisation(sheet, values, count) if any(one.name in ringing for one in off) else None
    if chain and (not found or chain[0] < BETTER * rms(fits[0].rest[rings])):
        found.append(Explanation(*chain[1:], ringing, ringing, chain[0] / rms(errors[rings]), "frequencies"))
    first = "the step and every joint"
    if any(one.read == "first" and MODULUS not in one.powers for one in off):
        first = "the start"
    elif fits[0].left < MOST_LEFT:
        first = f"whether {texts[fits[0].parameter]}, which leaves {per_cent(fits[0].left)} of them"
    listed = ", ".join(f"{one.name} {one.error(values[one.name]):+.2g}" for one in off if one.name in among)
    text = f"no single parameter of the sheet would explain the errors ({listed}): check first {first}"
    return "" if found else text, found


class Fit(NamedTuple):
    """The change of a parameter that leaves least of the errors of figures."""

    left: float
    parameter: str
    change: float
    rest: Array
    explains: bool
    """Whether every figure passes with it."""


def fitted(known: Sequence[Figure], errors: Array) -> list[Fit]:
    """Every parameter by least squares of errors over what passes, the one that leaves least first."""
    within, found = np.array([one.within for one in known]), list[Fit]()
    for parameter in dict.fromkeys(parameter for one in known for parameter in one.powers):
        powers = np.array([one.powers.get(parameter, 0.0) for one in known])
        change = float((powers / within**2) @ errors / ((powers / within) ** 2).sum())
        rest = errors - change * powers
        left = float(np.linalg.norm(rest / within) / np.linalg.norm(errors / within))
        within_reach = (abs(rest) <= within + LOCAL * abs(change * powers)).all()
        if parameter != CLAMP or change > 0.0:
            found.append(Fit(left, parameter, change, rest, left < MOST_LEFT and bool(within_reach)))
    return sorted(found, key=lambda one: one.left)


def _change(sheet: Sheet, name: str, change: float, count: int | None) -> str:
    """A parameter and its error in words; of the clamp, whose change is its compliance over L/EI."""
    if name != CLAMP:
        value = sheet.parameters.get(name)
        return f"{name} is {np.exp(change):.4g} times " + ("the sheet's" if value is None else f"{value:.6g}")
    text = f"the clamp gives way by {change:.3g} L/{'GJ' if sheet.chain and sheet.chain.space else 'EI'}"
    if (links := count or (sheet.chain.count if sheet.chain else 0)) == 0:
        return text
    gregory, half = (weight / (weight + links * change) for weight in (3.0 / 8.0, 1.0 / 2.0))
    return f"{text} (the first of {links} joints at {half:.2g} of 2EI/l or {gregory:.2g} of Gregory's stiffness)"


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


def discretisation(sheet: Sheet, values: Mapping[str, float], count: int | None) -> tuple[float, str, str] | None:
    """(rms difference of logarithms, cause, remedy) of the nearest chain of `compare`, of `count` links or any number.

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
    return found[0][0], f"these are the frequencies of {chains}{fitted}", remedy


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
