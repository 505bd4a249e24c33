"""Values of figures: a number, a complex number, a bracket, or an estimate with its error; as JSON data and as text."""

from math import isfinite, isnan
from typing import Any, TypeAlias

from verify.analysis.solution_cache import Bracket
from verify.formatting import with_error


class Estimate(float):
    """A value with the error of its estimation, of which `verify measure` prints the digits that hold."""

    error: float

    def __new__(cls, value: float, error: float = 0.0) -> "Estimate":
        """`error` in the unit of the value; a copy or an unpickled value sets it later."""
        estimate = super().__new__(cls, value)
        estimate.error = float(error)
        return estimate


Value: TypeAlias = float | complex | Bracket  # type of an evaluated quantity


def as_plain(value: Value | None) -> Any:
    """A value as JSON data: a number, {"re", "im"} or {"lower", "upper"}; an estimate without its error."""
    if isinstance(value, complex):
        return {"re": value.real, "im": value.imag}
    if isinstance(value, Bracket):
        return {"lower": value.lower, "upper": value.upper}
    return float(value) if isinstance(value, Estimate) else value


def as_text(value: Value, form: str = "") -> str:
    """A value as text: '1.5', '1 + 2i', '0.9 to 1.1', '9.8 ± 0.2'.

    `form` is that of numbers; by default they have 12 digits, and an estimate those that hold.
    """
    if isinstance(value, Estimate) and value.error and not form:
        return with_error(value, value.error)
    form = form or ".12g"
    if isinstance(value, complex):
        return f"{value.real:{form}} {'+-'[value.imag < 0]} {abs(value.imag):{form}}i"
    if isinstance(value, Bracket):
        return f"{value.lower:{form}} to {value.upper:{form}}"
    return "NaN" if isnan(value) else f"{value:{form}}" if isfinite(value) else "infinity"
