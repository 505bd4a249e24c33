"""Figures in words: durations, per cents, measured values, what a run solved."""

from math import isfinite, isnan
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from verify.run.runner import RunResult


def seconds_in_words(seconds: float | None) -> str:
    """A duration with a unit that suits it."""
    if seconds is None:
        return "–"
    for limit, factor, unit in ((1e-3, 1e6, "µs"), (1.0, 1e3, "ms")):
        if seconds < limit:
            return f"{seconds * factor:.3g} {unit}"
    return f"{seconds:.3g} s"


def percent(value: float | None, *, sign: bool = True) -> str:
    """A relative figure in per cent; small ones in powers of ten."""
    if value is None:
        return "–"
    text = f"{100 * value:+.3g}" if abs(value) < 1e-5 else f"{100 * value:+.4f}"
    return (text if sign else text.lstrip("+")) + " %"


def figure(value: Any) -> str:
    """A measured figure, short."""
    if value is None:
        return "–"
    if isinstance(value, dict) and "re" in value:
        return f"{value['re']:.6g} {value['im']:+.6g}i"
    if isinstance(value, dict):
        return " .. ".join(figure(part) for part in value.values())
    return number(value, 7)


def number(value: float, digits: int) -> str:
    """A number to so many digits; a standing wave's ratio is infinity."""
    return f"{value:.{digits}g}" if isfinite(value) else "–" if isnan(value) else "infinity"


def work_in_words(result: "RunResult") -> str:
    """What a run solved, by kind; kinds of which there is nothing are left out."""
    kinds = {"modal solves": len(result.solves), "driven fields": result.n_fields, "motions in time": result.n_motions}
    return ", ".join(f"{n} {name}" for name, n in kinds.items() if n) or "closed forms only"
