"""Checks of single values, each with one sentence: field, value, remedy."""

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
"""Its cube, by which memory is estimated, is finite."""
MOST_DASHPOT = 1e100
"""N m s; products with it are finite."""
RELATIVE = "relative"
Relative: TypeAlias = Annotated[float, Meta(extra={RELATIVE: True})]
"""A dimensionless number, which a command line accepts in per cent as well: 0.001 or 0.1%."""
Kind = TypeVar("Kind")
_NATIVE = (float, int, str, tuple, type(None))


def plain(value: Any, field: str = "a value") -> Any:
    """A numpy scalar as Python's own number, whose arithmetic is in double precision; whole numbers by `__index__`.

    Raises InputError for masked values.
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
    """Raise InputError for masked numpy values, in lists too. Does not import `numpy.ma`."""
    if (core := modules.get("numpy.ma.core")) is not None and _masked(value, core.MaskedArray):
        remedy = f"leave them out or unmask them{unit and f' ({unit})'}"
        raise InputError(f"{field} = {shown(value)} has numbers under a mask: {remedy}")


def _masked(value: object, masked: Any) -> bool:
    """Whether an array, or one in nested lists and tuples, has a mask that hides something."""
    left, seen = [value], set()
    while left:
        one: Any = left.pop()
        if isinstance(one, masked):
            if any(one.mask.tobytes()):  # of structured types too
                return True
        elif isinstance(one, list | tuple) and id(one) not in seen:
            seen.add(id(one))
            left += [each for each in one if type(each) is not float]
    return False


def check_sizes(field: str, sizes: "Sequence[float]") -> None:
    """Raise InputError unless there are three or more different sizes, which an observed order needs."""
    if len(sizes) < 3 or len(set(sizes)) != len(sizes):
        raise InputError(f"{field} = {list(sizes)}: an observed order needs three or more different sizes")


def several(field: str, given: Any, kind: type[Kind]) -> tuple[Kind, ...]:
    """One value of a type, or many, as a tuple. Raises InputError for anything else."""
    one = isinstance(given, kind) or not hasattr(given, "__iter__") or getattr(given, "shape", None) == ()
    found = (given,) if one else tuple(given)
    for each in found:
        if not isinstance(each, kind):
            raise InputError(f"{field} has {shown(each)}: give a {kind.__name__}, or a list of them")
    return found


def check_word(field: str, given: object, known: "Sequence[str]") -> None:
    """Raise InputError with the nearest known word unless `given` is one of them."""
    if not isinstance(given, str) or given not in known:
        word = given if isinstance(given, str) else ""
        raise InputError(f"{field} = {shown(given)} is not known: {near_name(word, tuple(known))}")


def check_kind(field: str, given: Any, *kinds: type) -> None:
    """Raise InputError unless `given` is an instance of one of these types."""
    if not isinstance(given, kinds):
        raise InputError(f"{field} = {shown(given)}: give a {' or a '.join(kind.__name__ for kind in kinds)}")


def settle(value: "msgspec.Struct", where: str = "", **kinds: type) -> None:
    """Convert the fields of a frozen value in place: numpy's numbers to Python's, lists and rows to tuples.

    `kinds` are fields with many values of a type, `where` is their owner's name in messages. Raises InputError.
    """
    for field, slot in _slots(type(value)):
        given = kept = slot.__get__(value)
        if field in kinds:
            kept = given if type(given) is tuple and not given else several(f"{where}.{field}", given, kinds[field])
        elif type(given) not in _NATIVE:
            name = f"{where}.{field}" if where else field
            if isinstance(given, list) or (hasattr(given, "dtype") and len(getattr(given, "shape", ())) == 1):
                check_unmasked(name, given)
                kept = tuple(map(plain, given))
            else:
                kept = plain(given, name)
        if kept is not given:
            slot.__set__(value, kept)


@cache
def _slots(kind: type) -> tuple[tuple[str, Any], ...]:
    """Storage of a struct's fields, which properties of the same name may hide."""
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
    """A whole number as an int; None for anything else, true and false among it."""
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
