"""Numbers and names as text."""

from collections.abc import Iterable
from math import isfinite, isnan

from verify.errors import written


def number(value: float, digits: int) -> str:
    """A number to so many significant digits; 'infinity' and '–' for what is not finite."""
    return f"{value:.{digits}g}" if isfinite(value) else "–" if isnan(value) else f"{'-' * (value < 0)}infinity"


def percent(value: float | None, *, sign: bool = True) -> str:
    """A ratio in per cent, small ones in powers of ten: '+0.4280 %'."""
    if value is None:
        return "–"
    text = f"{100 * value:+.3g}" if abs(value) < 1e-5 else f"{100 * value:+.4f}"
    return (text if sign else text.lstrip("+")) + " %"


def as_written(numbers: Iterable[float]) -> str:
    """Numbers without rounding residues: '[0.03425, 0.10275]' for 0.10275000000000001."""
    return str([float(written(one)) for one in numbers])


def newtons(amplitudes: Iterable[float]) -> str:
    """'0.05 and 0.03 N': each amplitude once."""
    return " and ".join(f"{one:g}" for one in dict.fromkeys(amplitudes)) + " N"


def theory_name(theory: str) -> str:
    """'Euler-Bernoulli' for 'euler-bernoulli'."""
    return "-".join(part.capitalize() for part in theory.split("-"))
