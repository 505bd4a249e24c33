"""Mistakes in the making of a record: a sign, a unit, an order or a column, without which its figures all pass."""

from collections.abc import Callable, Iterator
from itertools import combinations

import numpy as np

from verify.analysis.verdict import per_cent, three_digits
from verify.arrays import Array
from verify.sheets.reading import Run
from verify.sheets.sheet import Figure

DIRECT = ("first", "last", "least", "greatest", "amplitude", "period")
"""Readings that noise falsifies, as they are of few samples."""
PEAK = 6.0
"""Of noise in thousands of samples, over its sd."""
AUDIBLE, LOUD = 1e-4, 0.05
"""Sd of noise over the largest value: more than rounding, and less than motion between the rows."""


def fault(run: Run, passes: Callable[[Run], bool], scaled: bool) -> str:
    """The mistake without which `passes` is true, and its remedy; '' where none is alone the cause.

    `scaled`: whether a figure of an exact value that is not 0 fails; a small unit lets all others pass.
    """
    return next((text for text, signals in _mended(run, scaled) if passes(run.with_signals(signals))), "")


def _mended(run: Run, scaled: bool) -> Iterator[tuple[str, dict[str, Array]]]:
    """(mistake: remedy, columns without it)."""
    signals, names = run.signals, ", ".join(map(repr, run.signals))
    yield "the rows are in reverse order: sort them by time", {k: y[::-1] for k, y in signals.items()}
    several = [(names, signals)] * (len(signals) > 1)
    for name, part in [*((repr(k), {k: y}) for k, y in signals.items()), *several]:
        yield f"the sign of {name} is the opposite one: change it, or the axis", {k: -y for k, y in part.items()}
        remedy = f"write it behind the name, as in '{next(iter(part))}_mm'"
        if scaled:
            text = f"the unit of {name} is a thousandth of the sheet's: {remedy}"
            yield text, {k: 1e-3 * y for k, y in part.items()}
    for a, b in combinations(signals, 2):
        yield f"{a!r} and {b!r} are exchanged: order the columns as the sheet", {a: signals[b], b: signals[a]}


def noise_of(run: Run, column: str) -> str:
    """The size of noise in a column, '' where it is no more than rounding."""
    sd, size = run.noise(column), float(np.max(abs(run.signals[column])))
    return (
        f"{three_digits(sd)} (sd), {per_cent(sd / size)} of the largest value"
        if AUDIBLE * size < sd < LOUD * size
        else ""
    )


def noise(run: Run, figure: Figure, value: float) -> str:
    """The noise that explains the error of a figure, '' where it is smaller."""
    text, sd = noise_of(run, figure.column), run.noise(figure.column)
    if figure.read not in DIRECT or not text or (figure.read != "period" and abs(value - figure.exact) > PEAK * sd):
        return ""
    return f"{figure.column!r} has noise of {text}: record what the engine computes, with all digits"
