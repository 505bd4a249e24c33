"""SI prefixes: the unit in which the largest of some values is at least one."""

from collections.abc import Iterable
from math import isfinite

import msgspec

PREFIXES = (
    *(("G", 1e-9), ("M", 1e-6), ("k", 1e-3), ("", 1.0)),
    *(("m", 1e3), ("µ", 1e6), ("n", 1e9), ("p", 1e12), ("f", 1e15), ("a", 1e18)),
)
LARGEST = {"m": "k", "g": "k", "s": ""}
"""Largest prefix in use: no megametres, no kiloseconds."""


class Unit(msgspec.Struct, frozen=True):
    """A unit, and the factor from the SI unit to it."""

    name: str
    factor: float


def unit_of(size: float, symbol: str = "m") -> Unit:
    """The unit for values up to `size` (in the SI unit `symbol`), which is `symbol` itself for 0 and NaN."""
    if size == 0.0 or not isfinite(size):
        return Unit(symbol, 1.0)
    names = [prefix for prefix, _ in PREFIXES]
    allowed = PREFIXES[names.index(LARGEST.get(symbol, names[0])) :]
    prefix, factor = next((one for one in allowed if abs(size) * one[1] >= 1.0), allowed[-1])
    return Unit(prefix + symbol, factor)


def unit_over(values: "Iterable[float | None]", symbol: str = "m") -> Unit:
    """The unit for the largest of these values; None and what is not finite are ignored."""
    return unit_of(max((abs(v) for v in values if v is not None and isfinite(v)), default=0.0), symbol)


def in_words(value: float, symbol: str = "m", form: str = ".3g") -> str:
    """'1.53 mm': a value with its prefix, rounded first (0.9999 mm is 1 mm)."""
    rounded = float(format(value, form))
    unit = unit_of(rounded, symbol)
    return f"{unit.factor * rounded:{'+' if form.startswith('+') else ''}g} {unit.name}"
