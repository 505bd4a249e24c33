"""Validation of frozen values by their annotations, and checks of single arguments: one sentence for each error."""

from collections.abc import Sequence
from functools import cache
from math import isfinite
from types import MemberDescriptorType
from typing import Annotated, Any, TypeAlias, TypeVar, cast

import msgspec
from msgspec import Meta

from verify.convert import RELATIVE, convert, entry_of, sentence
from verify.errors import InputError, near_name, shown

MOST_PARTS = 10**9
"""Largest number of segments or elements."""
Relative: TypeAlias = Annotated[float, Meta(extra={RELATIVE: True})]
"""A dimensionless number, which a command line accepts in per cent as well: 0.001 or 0.1%."""
Kind = TypeVar("Kind")


def unit(name: str, **limits: float | None) -> Meta:
    """Annotation of a finite number: its unit and its limits `gt`, `ge`, `lt`, `le`."""
    meta: Any = Meta  # its overloads know no dictionary
    return cast(Meta, meta(extra={"unit": name}, **limits))


def validate(value: msgspec.Struct, where: str) -> None:
    """Check a frozen value against its annotations and convert its fields in place: numpy's numbers, lists.

    `where` is its name in messages. Raises InputError with a sentence for each field that does not fit.
    """
    same, fields = _unchecked(type(value))
    given = {name: _python(field) for name, field in msgspec.structs.asdict(value).items()}
    for name, (kind, _) in fields.items():
        if isinstance(given[name], msgspec.Struct) and entry_of(kind) is not None:
            given[name] = (given[name],)
    fitted = convert(given, same, where)
    for name, (kind, slot) in fields.items():
        field = getattr(fitted, name)
        if isinstance(field, float) and not isfinite(field):
            raise InputError(sentence(f"{where}.{name}", field, kind))
        slot.__set__(value, field)


@cache
def _unchecked(kind: type[msgspec.Struct]) -> tuple[type[msgspec.Struct], dict[str, tuple[Any, Any]]]:
    """A struct of the same annotations without `__post_init__`; the fields' types and slots, which properties hide."""
    types = {field.name: field.type for field in msgspec.structs.fields(kind)}
    slots = {
        name: next(slot for base in kind.__mro__ if isinstance(slot := vars(base).get(name), MemberDescriptorType))
        for name in types
    }
    return msgspec.defstruct(kind.__name__, types.items()), {name: (types[name], slots[name]) for name in types}


def _python(value: Any) -> Any:
    """Numbers and arrays of numpy as those of Python; a masked number is None."""
    if isinstance(value, list | tuple):
        return tuple(map(_python, value))
    return value.tolist() if hasattr(value, "tolist") else value


def plain(value: Any) -> Any:
    """A numpy scalar as Python's own number, whose arithmetic is in double precision."""
    return value.item() if hasattr(value, "dtype") and getattr(value, "shape", None) == () else value


def check_unmasked(field: str, value: object, unit: str = "") -> None:
    """Raise InputError for a masked array, whose mask `numpy.asarray` would drop."""
    mask: Any = getattr(value, "mask", None)
    if mask is not None and mask.any():
        raise InputError(f"{field} has numbers under a mask: leave them out or unmask them{unit and f' ({unit})'}")


def check_number(
    field: str,
    value: object,
    of: str,
    *,
    above: float | None = None,
    below: float | None = None,
    at_least: float | None = None,
    at_most: float | None = None,
) -> None:
    """Raise InputError unless `value` (unit `of`) is finite and within the limits; `above` and `below` are open."""
    kind: Any = Annotated[float, unit(of, gt=above, ge=at_least, lt=below, le=at_most)]
    convert(plain(value), kind, field)


def check_whole(field: str, value: object, least: int, most: int | None = None) -> None:
    """Raise InputError unless `value` is a whole number from `least` to `most`."""
    kind: Any = Annotated[int, Meta(ge=least, le=most)]
    convert(plain(value), kind, field)


def check_position(field: str, x: float, length: float) -> None:
    """Raise InputError unless x, m, lies on a beam of this length."""
    if not 0.0 <= x <= length:
        raise InputError(f"{field} = {x!r} lies off the beam: give a position between 0 and {length!r} m")


def check_word(field: str, given: object, known: Sequence[str]) -> None:
    """Raise InputError with the nearest known word unless `given` is one of them."""
    if not isinstance(given, str) or given not in known:
        word = given if isinstance(given, str) else ""
        raise InputError(f"{field} = {shown(given)} is not known: {near_name(word, tuple(known))}")


def check_kind(field: str, given: Any, *kinds: type) -> None:
    """Raise InputError unless `given` is an instance of one of these types."""
    if not isinstance(given, kinds):
        raise InputError(f"{field} = {shown(given)}: give a {' or a '.join(kind.__name__ for kind in kinds)}")


def check_sizes(field: str, sizes: Sequence[float]) -> None:
    """Raise InputError unless there are three or more different sizes, which an observed order needs."""
    if len(sizes) < 3 or len(set(sizes)) != len(sizes):
        raise InputError(f"{field} = {list(sizes)}: an observed order needs three or more different sizes")


def several(field: str, given: Any, kind: type[Kind]) -> tuple[Kind, ...]:
    """A value of a type, or several, as a tuple. Raises InputError for anything else."""
    single = isinstance(given, kind) or not hasattr(given, "__iter__") or getattr(given, "shape", None) == ()
    values = (given,) if single else tuple(given)
    for value in values:
        if not isinstance(value, kind):
            raise InputError(f"{field} has {shown(value)}: give a {kind.__name__}, or a list of them")
    return values
