"""What a single number has to be, whichever value it belongs to: one sentence naming field, value and remedy."""

from functools import cache
from math import inf
from operator import index
from sys import float_info
from typing import Annotated, TypeAlias

from msgspec import Meta

from verify.errors import InputError, shown

if TYPE_CHECKING:
    import msgspec

LARGEST = float_info.max
RELATIVE = "relative"
Relative: TypeAlias = Annotated[float, Meta(extra={RELATIVE: True})]
"""A number without a unit, which a command line takes in per cent as well: 0.001 or 0.1%."""


def check_number(
    field: str, value: object, unit: str, *, above: float = -inf, below: float = inf, at_least: float = -inf
) -> None:
    """Raise InputError unless `value` is a finite number, at least `at_least`, strictly between `above` and `below`."""
    number = isinstance(value, int | float) and not isinstance(value, bool)
    if number and -LARGEST <= value <= LARGEST and above < value < below and value >= at_least:  # type: ignore[operator]
        return
    limits = [f"above {above:g}"] * (above > -inf) + [f"of at least {at_least:g}"] * (at_least > -inf)
    limits += [f"below {below:g}"] * (below < inf)
    wanted = " ".join(["a finite number", " and ".join(limits)]).strip()
    raise InputError(f"{field} = {shown(value)}: give {wanted} ({unit})")


def check_whole(field: str, value: object, least: int) -> None:
    """Raise InputError unless `value` is a whole number of at least `least`."""
    try:
        whole = index(value)  # type: ignore[arg-type]
    except TypeError:
        raise InputError(f"{field} = {shown(value)}: give a whole number of at least {least}") from None
    if isinstance(value, bool) or whole < least:
        raise InputError(f"{field} = {shown(value)}: give a whole number of at least {least}")
