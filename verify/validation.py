"""Validation of frozen values by their annotations, and checks of single arguments: one sentence for each error."""

from collections.abc import Sequence
from functools import cache
from math import inf, isfinite
from types import MemberDescriptorType
from typing import TYPE_CHECKING, Annotated, Any, TypeAlias, TypeVar, cast

import msgspec
from msgspec import Meta

from verify.convert import RELATIVE, convert, entry_of, sentence
from verify.errors import InputError, near_name, shown

MOST_PARTS = 10**9  # largest number of segments or elements
Relative: TypeAlias = Annotated[float, Meta(extra={RELATIVE: True})]
"""A dimensionless number, which a command line also accepts in per cent: 0.001 or 0.1%."""
Item = TypeVar("Item")
if TYPE_CHECKING:
    Items: TypeAlias = Sequence[Item]
    Pair: TypeAlias = Sequence[Item]
else:  # fields accept any sequence and hold tuples, see `validate`
    Items, Pair = tuple[Item, ...], tuple[Item, Item]


def unit(name: str, **limits: float | None) -> Meta:
    """Annotation of a finite number: its unit and its limits `gt`, `ge`, `lt`, `le`."""
    meta: Any = Meta  # its overloads know no dictionary
    return cast(Meta, meta(extra={"unit": name}, **limits))


def validate(value: msgspec.Struct, where: str) -> None:
    """Check a frozen value against its annotations; convert numbers of numpy and lists in its fields in place.

    `where` is its name in messages. Raises InputError with a sentence for each invalid field.
    """
    unchecked, fields = _unchecked(type(value))
    values = {name: _python(field) for name, field in msgspec.structs.asdict(value).items()}
    for name, (annotation, _) in fields.items():
        if isinstance(values[name], msgspec.Struct) and entry_of(annotation) is not None:
            values[name] = (values[name],)
    converted = convert(values, unchecked, where)
    for name, (annotation, slot) in fields.items():
        field = getattr(converted, name)
        if isinstance(field, float) and not isfinite(field):
            raise InputError(sentence(f"{where}.{name}", field, annotation))
        slot.__set__(value, field)


@cache
def _unchecked(kind: type[msgspec.Struct]) -> tuple[type[msgspec.Struct], dict[str, tuple[Any, Any]]]:
    """(the struct without its `__post_init__`, (type, slot) of each field by name); properties may hide the slots."""
    types = {field.name: field.type for field in msgspec.structs.fields(kind)}
    slots = {
        name: next(slot for base in kind.__mro__ if isinstance(slot := vars(base).get(name), MemberDescriptorType))
        for name in types
    }
    return msgspec.defstruct(kind.__name__, types.items()), {name: (types[name], slots[name]) for name in types}


def _python(value: Any) -> Any:
    """Convert numbers and arrays of numpy to those of Python; a masked number to None."""
    if isinstance(value, list | tuple):
        return tuple(map(_python, value))
    return value.tolist() if hasattr(value, "tolist") else value


def python_scalar(value: Any) -> Any:
    """Convert a numpy scalar to a number of Python, whose arithmetic is in double precision."""
    return value.item() if hasattr(value, "dtype") and getattr(value, "shape", None) == () else value


def check_unmasked(field: str, value: object) -> None:
    """Raise InputError for a masked array, whose mask `numpy.asarray` would drop."""
    mask: Any = getattr(value, "mask", None)
    if mask is not None and mask.any():
        raise InputError(f"{field} has masked numbers: leave them out or unmask them")


def check_number(
    field: str,
    value: object,
    unit_name: str,
    *,
    above: float | None = None,
    below: float | None = None,
    at_least: float | None = None,
    at_most: float | None = None,
) -> None:
    """Raise InputError unless `value` is finite and within the limits, of which `above` and `below` are open."""
    if isinstance(value, float | int) and -inf < value < inf and not isinstance(value, bool):
        inside = (above is None or above < value) and (below is None or value < below)
        if inside and (at_least is None or at_least <= value) and (at_most is None or value <= at_most):
            return
    annotation: Any = Annotated[float, unit(unit_name, gt=above, ge=at_least, lt=below, le=at_most)]
    convert(python_scalar(value), annotation, field)


def check_integer(field: str, value: object, least: int, most: int | None = None) -> None:
    """Raise InputError unless `value` is a whole number from `least` to `most`."""
    if type(value) is int and least <= value <= (inf if most is None else most):
        return
    annotation: Any = Annotated[int, Meta(ge=least, le=most)]
    convert(python_scalar(value), annotation, field)


def check_position(field: str, x: float, length: float) -> None:
    """Raise InputError unless x (m) is on a beam of this length (m)."""
    if not 0.0 <= x <= length:
        raise InputError(f"{field} = {x!r} lies off the beam: give a position between 0 and {length!r} m")


def check_choice(field: str, value: object, choices: Sequence[str]) -> None:
    """Raise InputError, which suggests the nearest choice, unless `value` is one of the choices."""
    if not isinstance(value, str) or value not in choices:
        name = value if isinstance(value, str) else ""
        raise InputError(f"{field} = {shown(value)} is not known: {near_name(name, tuple(choices))}")


def check_type(field: str, value: Any, *types: type) -> None:
    """Raise InputError unless `value` is an instance of one of these types."""
    if not isinstance(value, types):
        raise InputError(f"{field} = {shown(value)}: give a {' or a '.join(one.__name__ for one in types)}")


def check_sizes(field: str, sizes: Sequence[float]) -> None:
    """Raise InputError unless there are three or more different sizes, which an observed order needs."""
    if len(sizes) < 3 or len(set(sizes)) != len(sizes):
        raise InputError(f"{field} = {list(sizes)}: an observed order needs three or more different sizes")


def as_tuple(field: str, value: Any, *types: type[Item]) -> tuple[Item, ...]:
    """One or several items of one of these types as a tuple. Raises InputError for any other type."""
    single = isinstance(value, types) or not hasattr(value, "__iter__") or getattr(value, "shape", None) == ()
    items = (value,) if single else tuple(value)
    for entry in items:
        if not isinstance(entry, types):
            names = " or a ".join(kind.__name__ for kind in types)
            raise InputError(f"{field} has {shown(entry)}: give a {names}, or a list of them")
    return items
