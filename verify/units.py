"""Units that suit a size: of all that is told or drawn the SI unit with the prefix in which it is at least one.

What is beyond the last prefix, or the largest that a unit is taken in, is in that.
"""

from collections.abc import Iterable
from math import isfinite

import msgspec

PREFIXES = (
    *(("G", 1e-9), ("M", 1e-6), ("k", 1e-3), ("", 1.0)),
    *(("m", 1e3), ("µ", 1e6), ("n", 1e9), ("p", 1e12), ("f", 1e15), ("a", 1e18)),
)
LARGEST = {"m": "k", "g": "k", "s": ""}
"""The prefix beyond which nobody takes a unit: there are no megametres of beams, and no kiloseconds."""


class Unit(msgspec.Struct, frozen=True):
    """A unit, and how many of it the SI unit is."""

    name: str
    factor: float


def unit_of(size: float, symbol: str = "m") -> Unit:
    """The unit for figures up to this size, given in the SI unit `symbol`, of which it is one for 0 and for NaN."""
    if size == 0.0 or not isfinite(size):
        return Unit(symbol, 1.0)
    names = [prefix for prefix, _ in PREFIXES]
    chosen = PREFIXES[names.index(LARGEST.get(symbol, names[0])) :]
    prefix, factor = next((one for one in chosen if abs(size) * one[1] >= 1.0), chosen[-1])
    return Unit(prefix + symbol, factor)


def unit_over(values: "Iterable[float | None]", symbol: str = "m") -> Unit:
    """The unit for the largest of these, which all are drawn in; gaps are not asked."""
    return unit_of(max((abs(v) for v in values if v is not None and isfinite(v)), default=0.0), symbol)


def in_words(value: float, symbol: str = "m", form: str = ".3g") -> str:
    """'1.53 mm': a figure in the unit that suits it as it is written, in digits: 0.9999 mm is 1 mm."""
    written = float(format(value, form))
    unit = unit_of(written, symbol)
    return f"{unit.factor * written:{'+' if form.startswith('+') else ''}g} {unit.name}"


def time_in_words(seconds: float) -> str:
    """'0.5 ms': a time with the digits that it was given with, six at most."""
    return in_words(seconds, "s", "g")
