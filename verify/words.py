"""Figures in words: durations, per cents, measured values, what a run solved."""

import re
from collections.abc import Callable, Iterable
from math import isfinite, isnan
from typing import Any

from verify.errors import written
from verify.units import in_words


def seconds_in_words(seconds: float | None) -> str:
    """A duration with a unit that suits it."""
    return "–" if seconds is None else in_words(seconds, "s")


def as_written(numbers: Iterable[float]) -> str:
    """Numbers as a person writes them: [0.03425, 0.10275], where a product left 0.10275000000000001."""
    return str([float(written(number)) for number in numbers])


def newtons(amplitudes: Iterable[float]) -> str:
    """'5 N', '0.05 and 0.03 N': of forces, each size once."""
    return " and ".join(f"{one:g}" for one in dict.fromkeys(amplitudes)) + " N"


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
    return f"{value:.{digits}g}" if isfinite(value) else "–" if isnan(value) else f"{'-' * (value < 0)}infinity"


def work_in_words(solves: int, fields: int, motions: int, others: dict[str, int] | None = None) -> str:
    """What a run solved, by kind, `others` by their names; kinds of which there is nothing are left out."""
    own = {"modal solve{}": solves, "driven field{}": fields, "motion{} in time": motions}
    kinds = {name.format("s" * (n != 1)): n for name, n in own.items()} | (others or {})
    return ", ".join(f"{n} {name}" for name, n in kinds.items() if n) or "closed forms only"


def bare_percent(value: float) -> str:
    """A relative figure in per cent without the sign for it, at most nine characters."""
    return f"{100 * value:+.4f}" if abs(value) >= 1e-4 else f"{100 * value:+.2e}".replace("e-0", "e-")


def rounded(value: float, within: float) -> str:
    """A value to a thousandth of the band around it, so that the band shown is the one judged: 4.55 within 1."""
    places = max(BEYOND - int(f"{within:e}".partition("e")[2]), 0)
    return f"{value:.0f}" if places == 0 else repr(round(value, places))


def share_of_band(share: float | None) -> str:
    """A share of a band in per cent, told as its edge only where it is there: 100.01 % is 'over 100 %'."""
    if share is None:
        return "–"
    text = number(100.0 * share, 3)
    if share != 1.0 and float(text) == 100.0:
        return f"{'over' if share > 1.0 else 'under'} 100 %"
    return f"{text} %"


BEYOND = 3
"""Digits beyond the first of a band: as many as its share is told with."""


def told_once(notes: Iterable[str]) -> list[str]:
    """Each note once; of three or more that differ in their numbers alone the first, and how many there are."""
    alike: dict[str, list[str]] = {}
    for note in dict.fromkeys(notes):
        alike.setdefault(re.sub(r"\d+", "0", note), []).append(note)
    told: list[str] = []
    for group in alike.values():
        told += group if len(group) < ALIKE else [f"{group[0]} ({len(group) - 1} more like it)"]
    return told


ALIKE = 3
"""Notes that differ in their numbers alone, from which on they are told as one."""


def in_a_row(what: str, names: list[str], most: int = 2) -> str:
    """'gate a', 'gates a, b', 'gates a, b and 3 more'."""
    row = ", ".join(names[:most]) + (f" and {len(names) - most} more" if len(names) > most else "")
    return f"{what}{'s' * (len(names) > 1)} {row}"


_FORMS: dict[str, Callable[[float], str]] = {
    "percent": percent,
    "size": lambda value: percent(value, sign=False),
    "bare percent": bare_percent,
    "bare size": lambda value: bare_percent(value).lstrip("+"),
    "duration": seconds_in_words,
    "ratio": lambda value: f"{value:.5f}" if value < 10 else number(value, 4),
    "4": lambda value: number(value, 4),
}
"""How a number is written in a cell, beside Python's own formats."""


VERDICTS = {True: "holds", False: "fails", None: "unknown"}


def cell(value: Any, form: str = "", factor: float = 1.0, unit: str = "") -> str:
    """A value in a cell of a table: words as they are, a dash for what there is not."""
    if form == "verdict":
        return VERDICTS[value]
    if value is None:
        return "–"
    if isinstance(value, str):
        return value
    if form in _FORMS:
        return _FORMS[form](factor * value) + unit
    return (format(factor * value, form) if form else f"{value}") + unit


def theory_name(theory: str) -> str:
    """'Euler-Bernoulli' of 'euler-bernoulli'."""
    return "-".join(part.capitalize() for part in theory.split("-"))
