"""What a single number has to be, whichever value it belongs to: one sentence naming field, value and remedy."""

from functools import cache
from math import inf
from operator import index
from sys import float_info, modules
from types import MemberDescriptorType
from typing import TYPE_CHECKING, Annotated, Any, TypeAlias, TypeVar

from msgspec import Meta

from verify.errors import InputError, near_name, shown

if TYPE_CHECKING:
    from collections.abc import Sequence

    import msgspec

LARGEST = float_info.max
MOST_PARTS = 10**100
"""Its cube, by which work is estimated, is a number too."""
MOST_DASHPOT = 1e100
"""N m s: what it is multiplied by makes a number of it too."""
RELATIVE = "relative"
Relative: TypeAlias = Annotated[float, Meta(extra={RELATIVE: True})]
"""A number without a unit, which a command line takes in per cent as well: 0.001 or 0.1%."""
Kind = TypeVar("Kind")
_SETTLED = (float, int, str, tuple, type(None))


def plain(value: Any, field: str = "a value") -> Any:
    """A scalar of numpy's as Python's own number, whose arithmetic neither rounds to 32 bits nor overflows.

    What Python takes for a whole number, by `__index__` alone, likewise. Raises InputError for numbers under a mask.
    """
    if hasattr(value, "dtype"):
        if hasattr(value, "mask"):
            check_unmasked(field, value)
        return value.item() if getattr(value, "shape", None) == () else value
    if isinstance(value, int | float) or not hasattr(type(value), "__index__"):
        return value
    whole = whole_number(value)
    return value if whole is None else whole


def check_unmasked(field: str, value: object, unit: str = "") -> None:
    """Raise InputError for numbers under a numpy mask, in lists too.

    `numpy.ma` is not loaded for it: who holds a masked array has done so.
    """
    if (core := modules.get("numpy.ma.core")) is not None and _hides(value, core.MaskedArray):
        wanted = f"leave them out or unmask them{unit and f' ({unit})'}"
        raise InputError(f"{field} = {shown(value)} has numbers under a mask: {wanted}")


def _hides(value: object, masked: Any) -> bool:
    """Whether something, or what lists and tuples in it hold, is of the type `masked` with a mask that hides some."""
    left, seen = [value], set()
    while left:
        one: Any = left.pop()
        if isinstance(one, masked):
            if any(one.mask.tobytes()):  # of fields too
                return True
        elif isinstance(one, list | tuple) and id(one) not in seen:
            seen.add(id(one))
            left += [each for each in one if type(each) is not float]
    return False


def check_sizes(field: str, sizes: "Sequence[float]") -> None:
    """Raise InputError for sizes through which no order is observed: three or more, no two alike."""
    if len(sizes) < 3 or len(set(sizes)) != len(sizes):
        raise InputError(f"{field} = {list(sizes)}: an observed order needs three or more different sizes")


def several(field: str, given: Any, kind: type[Kind]) -> tuple[Kind, ...]:
    """One of a kind, or many of them, as a tuple. Raises InputError, naming the field, for anything else."""
    one = isinstance(given, kind) or not hasattr(given, "__iter__") or getattr(given, "shape", None) == ()
    found = (given,) if one else tuple(given)
    for each in found:
        if not isinstance(each, kind):
            raise InputError(f"{field} has {shown(each)}: give a {kind.__name__}, or a list of them")
    return found


def check_word(field: str, given: object, known: "Sequence[str]") -> None:
    """Raise InputError, with the nearest that is, unless what was given is one of the words that are known."""
    if not isinstance(given, str) or given not in known:
        word = given if isinstance(given, str) else ""
        raise InputError(f"{field} = {shown(given)} is not known: {near_name(word, tuple(known))}")


def check_kind(field: str, given: Any, *kinds: type) -> None:
    """Raise InputError, naming the field, unless what was given is a value of one of these kinds."""
    if not isinstance(given, kinds):
        raise InputError(f"{field} = {shown(given)}: give a {' or a '.join(kind.__name__ for kind in kinds)}")


def settle(value: "msgspec.Struct", where: str = "", **kinds: type) -> None:
    """What a user typed made what a frozen value holds: Python's numbers for numpy's, tuples for lists and rows.

    `kinds` are fields of many values, `where` is what a message calls their owner. Raises InputError.
    """
    for field, slot in _slots(type(value)):
        given = kept = slot.__get__(value)
        if field in kinds:
            kept = given if type(given) is tuple and not given else several(f"{where}.{field}", given, kinds[field])
        elif type(given) not in _SETTLED:
            kept = _settled(given, f"{where}.{field}" if where else field)
        if kept is not given:
            slot.__set__(value, kept)


def _settled(given: Any, name: str) -> Any:
    """Python's numbers for numpy's, alone or in a row. Raises InputError for what is under a mask."""
    if not _in_a_row(given):
        return plain(given, name)
    check_unmasked(name, given)
    return tuple(map(plain, given))


def _in_a_row(given: Any) -> bool:
    """Whether something is a list, or an array of one dimension."""
    return isinstance(given, list) or (hasattr(given, "dtype") and len(getattr(given, "shape", ())) == 1)


@cache
def _slots(kind: type) -> tuple[tuple[str, Any], ...]:
    """Where a frozen value keeps its fields: a property of the same name answers with what follows from them."""
    found: dict[str, Any] = {}
    for one in kind.__mro__:
        found |= {name: slot for name, slot in vars(one).items() if isinstance(slot, MemberDescriptorType)}
    return tuple(found.items())


def check_number(
    field: str,
    value: object,
    unit: str,
    *,
    above: float = -inf,
    below: float = inf,
    at_least: float = -inf,
    at_most: float = inf,
) -> None:
    """Raise InputError unless `value` is a finite number from `at_least` to `at_most`, above `above`, below `below`."""
    number = isinstance(value, int | float) and not isinstance(value, bool)
    if number and -LARGEST <= value <= LARGEST and above < value < below and at_least <= value <= at_most:  # type: ignore[operator]
        return
    limits = [f"above {above:g}"] * (above > -inf) + [f"of at least {at_least:g}"] * (at_least > -inf)
    limits += [f"below {below:g}"] * (below < inf) + [f"of at most {at_most:g}"] * (at_most < inf)
    wanted = " ".join(["a finite number", " and ".join(limits)]).strip()
    raise InputError(f"{field} = {shown(value)}: give {wanted} ({unit})")


def whole_number(value: object) -> int | None:
    """A whole number as Python's own; None for what is none, as true and false are not."""
    try:
        return None if isinstance(value, bool) else index(value)  # type: ignore[arg-type]
    except TypeError:
        return None


def check_whole(field: str, value: object, least: int, most: float = inf) -> None:
    """Raise InputError unless `value` is a whole number from `least` to `most`."""
    whole = whole_number(value)
    if whole is None or whole < least:
        raise InputError(f"{field} = {shown(value)}: give a whole number of at least {least}")
    if whole > most:
        raise InputError(f"{field} = {shown(value)}: give a whole number of at most {most:.0e}")
