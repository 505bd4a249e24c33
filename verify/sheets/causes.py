"""Likely causes of the errors of a run: values that mistakes give, the discretisation, the time step's own damping."""

from collections.abc import Mapping
from math import pi
from statistics import median

from verify.answers.frequencies import compare_frequencies
from verify.errors import InputError
from verify.formatting import with_unit
from verify.problem.phrase import PREFIX
from verify.sheets.reading import frequency_of
from verify.sheets.sheet import Figure, Sheet

ALIKE = 1.25
"""Factor within which the steps that several modes imply are one step: damping beyond the first order is less."""
EXCESS = 1e-4
"""Damping ratio beyond the exact one that has no cause: that of a record of finite length."""


def cause(sheet: Sheet, figure: Figure, value: float, values: Mapping[str, float], count: int | None) -> str:
    """What makes the figure of a run what it is, '' where nothing is known; `values`: all figures of the run."""
    for one in figure.cause:
        if abs(value - one.value) <= one.within * abs(one.value):
            return one.because
    if figure.read == "damping":
        return numerical_damping(sheet, values)
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
    if gained:
        listed = " and ".join(map(str, gained))
        return f"the time step feeds energy into mode {listed}: halve it, or take an implicit integrator"
    steps = [2.0 * excess / omega for excess, omega in off.values()]
    if len(steps) > 1 and max(steps) < ALIKE * min(steps):
        return f"the integrator damps as implicit Euler does at {with_unit(median(steps), 's')}: take one of order 2"
    return "the integrator or a dashpot damps more than the sheet says: halve the step to tell which"


def discretisation(sheet: Sheet, values: Mapping[str, float], count: int | None) -> str:
    """What `compare` says of the frequencies of the run."""
    assert sheet.chain
    listed = [values[one.name] for one in sheet.figure if one.read == "frequency" and one.name in values]
    if len(listed) < 2 or sheet.chain.space:
        return ""
    try:
        found = compare_frequencies(PREFIX + sheet.chain.beam, listed, unit="Hz", count=count, kind="segments")
    except InputError:
        return ""
    return found.summary.rstrip(".")
