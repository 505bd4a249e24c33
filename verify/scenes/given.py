"""What was typed, read by its type: ranges where whole numbers are listed, per cents where a number is relative."""

import re
from typing import Any, get_args, get_origin

import msgspec

from verify.checks import RELATIVE
from verify.errors import InputError, shown
from verify.scenes.checked import arms_of, bare, table_of

LONGEST = 10_000
"""Numbers of a range."""
_RANGE = re.compile(r"(\d{1,18})-(\d{1,18})(?::(\d{1,18}))?")


def as_meant(value: Any, kind: Any, field: str) -> Any:
    """A literal as its type takes it: '1-3,7' where whole numbers are listed, '0.1%' where a number is relative.

    One whole number stands for a list of one. Anything else stays as it is, and the type refuses what does not fit.
    Raises InputError for a range that is none.
    """
    if lists_whole_numbers(kind):
        numbers = whole_numbers(value, field)
        return [numbers] if isinstance(numbers, int) and not isinstance(numbers, bool) else numbers
    return fraction(value) if is_relative(kind) else value


def whole_numbers(value: Any, field: str) -> Any:
    """'1-5', '10-50:10' (every tenth), or a list with such ranges among its numbers, spelt out. Raises InputError."""
    if isinstance(value, list):
        return [one for part in value for one in _spelt(part, field)] if any(map(_ranged, value)) else value
    return _spelt(value, field) if _ranged(value) else value


def _ranged(value: Any) -> bool:
    return isinstance(value, str) and _RANGE.fullmatch(value.replace(" ", "")) is not None


def _spelt(value: Any, field: str) -> list[Any]:
    found = _RANGE.fullmatch(value.replace(" ", "")) if isinstance(value, str) else None
    if found is None:
        return [value]
    start, end, step = int(found[1]), int(found[2]), int(found[3] or 1)
    if end < start or step == 0:
        raise InputError(f"{field} = {shown(value)} is an empty range: write it upwards, 1-5 or 10-50:10")
    if (end - start) // step >= LONGEST:
        raise InputError(f"{field} = {shown(value)} is more than {LONGEST} numbers: take a larger step, 10-5000:10")
    return list(range(start, end + 1, step))


def fraction(value: Any) -> Any:
    """'0.1%' as 0.001; anything else as it is."""
    if not (isinstance(value, str) and value.rstrip().endswith("%")):
        return value
    try:
        return float(value.rstrip()[:-1]) / 100.0
    except ValueError:
        return value


def lists_whole_numbers(kind: Any) -> bool:
    """Whether a value is a list of as many whole numbers as one likes."""
    parts = next((get_args(arm) for arm in arms_of(kind) if get_origin(arm) is tuple), ())
    return len(parts) == 2 and parts[1] is Ellipsis and bare(parts[0]) is int


def is_relative(kind: Any) -> bool:
    """Whether a number is one without a unit, so that per cents say it as well."""
    metas = [meta for part in (kind, *get_args(kind)) for meta in getattr(part, "__metadata__", ())]
    return any((meta.extra or {}).get(RELATIVE) for meta in metas)


def type_at_key(kind: Any, key: str) -> Any:
    """The type of what 'beam.length' or 'gate.ID.within' names; None where there is no such key."""
    for step in key.split("."):
        entry = next((get_args(arm)[0] for arm in arms_of(kind) if get_origin(arm) is tuple), None)
        if entry is not None:
            kind = entry
            continue
        table = table_of(kind)
        fields = msgspec.structs.fields(table) if isinstance(table, type) and issubclass(table, msgspec.Struct) else ()
        kind = next((field.type for field in fields if field.encode_name == step), None)
    return kind
