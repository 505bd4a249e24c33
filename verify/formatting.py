"""Numbers and names as text: SI prefixes, rounding residues, names of theories."""

from collections.abc import Callable, Iterable
from math import floor, isfinite, log10
from typing import NamedTuple

import numpy as np

from verify.errors import written

PREFIXES = {"G": 1e-9, "M": 1e-6, "k": 1e-3, "": 1.0, "m": 1e3, "µ": 1e6, "n": 1e9, "p": 1e12, "f": 1e15, "a": 1e18}
LARGEST = {"m": "k", "g": "k", "s": ""}  # largest prefix in use: no megametres, no kiloseconds


class Unit(NamedTuple):
    """A unit, and the factor from the SI unit to it."""

    name: str
    factor: float


def unit_of(size: float, symbol: str = "m") -> Unit:
    """The unit in which `size` (in the SI unit `symbol`) is at least one; `symbol` itself for 0 and NaN."""
    if size == 0.0 or not isfinite(size):
        return Unit(symbol, 1.0)
    names = list(PREFIXES)
    allowed = names[names.index(LARGEST.get(symbol, "G")) :]
    prefix = next((one for one in allowed if abs(size) * PREFIXES[one] >= 1.0), "a")
    return Unit(prefix + symbol, PREFIXES[prefix])


def unit_over(values: Iterable[float | None], symbol: str = "m") -> Unit:
    """The unit for the largest of these values; None and what is not finite are ignored."""
    return unit_of(max((abs(v) for v in values if v is not None and isfinite(v)), default=0.0), symbol)


def with_unit(value: float, symbol: str = "m", form: str = ".3g") -> str:
    """'1.53 mm': a value with its prefix, rounded first (0.9999 mm is 1 mm)."""
    rounded = float(format(value, form))
    unit = unit_of(rounded, symbol)
    return f"{unit.factor * rounded:{'+' if form.startswith('+') else ''}g} {unit.name}"


def floored(value: float, digits: int) -> float:
    """The number of so many digits that is at most a positive value."""
    unit = 10.0 ** (floor(log10(value)) + 1 - digits)
    return float(f"{floor(value / unit) * unit:.{digits}g}")


def with_error(value: float, error: float, sign: str = "") -> str:
    """'9.8 ± 0.2': the error to one digit, the value to the same decimal place; `sign` is '+' for both signs."""
    error = float(f"{error:.1g}")
    if not isfinite(value) or not isfinite(error) or error <= 0.0:
        return f"{value:{sign}.12g} ± {error:g}"
    place = floor(log10(error))
    value = round(value, -place) + 0.0  # no negative zero
    if place >= 0 or not value:
        return f"{value:{sign}.0f} ± {error:g}"
    digits = min(floor(log10(abs(value))) - place + 1, 15)  # of a float, after which come digits of its rounding
    return f"{value:{sign}#.{digits}g} ± {error:g}".replace(".e", "e")


def one_line(**units: str) -> Callable[[object], str]:
    """A `__repr__` of fields and properties with these units: range and shape of arrays, number of other entries."""

    def shown(value: object) -> str:
        if isinstance(value, dict):
            return str(len(value))
        array = np.asarray(value := getattr(value, "name", value))
        if array.ndim and array.dtype.kind in "fci":
            sizes = abs(array) if np.iscomplexobj(array) else array
            return f"{np.nanmin(sizes):.4g} to {np.nanmax(sizes):.4g}"
        if array.ndim and array.dtype.kind == "O":
            return str(len(array))
        return f"{value:.6g}" if isinstance(value, float) else str(value)

    def text(self: object) -> str:
        values = {name: getattr(self, name) for name in units}
        present = {name: value for name, value in values.items() if value is not None and np.size(value)}
        shapes = {name: f" {value.shape}" for name, value in present.items() if isinstance(value, np.ndarray)}
        parts = [f"{name} = {shown(v)} {units[name]}".rstrip() + shapes.get(name, "") for name, v in present.items()]
        return f"<{type(self).__name__}: {', '.join(parts)}>"

    return text


def as_written(numbers: Iterable[float]) -> str:
    """Numbers without rounding residues: '[0.03425, 0.10275]' for 0.10275000000000001."""
    return str([float(written(one)) for one in numbers])


def theory_name(theory: str) -> str:
    """'Euler-Bernoulli' for 'euler-bernoulli'."""
    return "-".join(part.capitalize() for part in theory.split("-"))
