"""Everything that is wrong with a scene's tables, a sentence for each; entries that have an id are named by it."""

from typing import Any, get_args, get_origin

import msgspec

from verify.errors import InputError, near_name
from verify.scenes.checked import arms_of, checked, table_of

MOST = 30
"""Sentences that are worth reading at once."""


def problems(data: Any, kind: Any, where: str = "") -> list[str]:
    """What `checked` would refuse, and whatever it would refuse after that; empty where it takes the data.

    What several values have to be together is looked at once each of them is right by itself.
    """
    table = table_of(kind)
    if isinstance(data, dict) and isinstance(table, type) and issubclass(table, msgspec.Struct):
        return _of_table(data, table, where) or _refused(data, kind, where)
    entry = _entry_of(kind)
    if isinstance(data, list) and entry is not None:
        found = [problems(one, entry, _named(one, i, where)) for i, one in enumerate(data)]
        return [sentence for sentences in found for sentence in sentences] or _refused(data, kind, where)
    return _refused(data, kind, where)


def _of_table(data: dict[str, Any], table: type[msgspec.Struct], where: str) -> list[str]:
    """Key by key, as they stand. A key that is missing may be one that is misspelt: it is named where none is."""
    fields = {field.encode_name: field for field in msgspec.structs.fields(table)}
    found = []
    for key, value in data.items():
        name = f"{where}.{key}".lstrip(".")
        if key in fields:
            found += problems(value, fields[key].type, name)
        else:
            found.append(f"{name} is not a known key: {near_name(str(key), tuple(fields))}")
    if not set(data) - set(fields):
        missing = [key for key, field in fields.items() if field.required and key not in data]
        found += [f"{f'{where}.{key}'.lstrip('.')} is missing: give it a value" for key in missing]
    return found


def _refused(data: Any, kind: Any, where: str) -> list[str]:
    try:
        checked(data, kind, where)
    except InputError as error:
        return list(error.sentences)
    return []


def _entry_of(kind: Any) -> type[msgspec.Struct] | None:
    """Of a list of tables the type of one; None for any other."""
    entries = (get_args(arm)[0] for arm in arms_of(kind) if get_origin(arm) is tuple)
    return next((one for one in entries if isinstance(one, type) and issubclass(one, msgspec.Struct)), None)


def _named(entry: Any, i: int, where: str) -> str:
    """'gate.fem-order', or 'beam.section[1]' where there is no id."""
    name = entry.get("id") if isinstance(entry, dict) else None
    return f"{where}.{name}" if isinstance(name, str) and name else f"{where}[{i}]"
