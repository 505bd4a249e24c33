"""The largest of errors, of which none is lost for being no number."""

from collections.abc import Iterable
from math import isnan, nan


def largest(*errors: float | Iterable[float]) -> float:
    """Of numbers, or of one iterable of them; NaN where one is, which `max` passes over wherever it does not begin."""
    one = errors[0] if len(errors) == 1 else errors
    values: list[float] = list(one)  # type: ignore[arg-type]
    return nan if any(map(isnan, values)) else max(values)
