"""Plain data checked against a type, with errors that name the field, its value and the remedy."""

import re
from math import isfinite, isnan
from types import UnionType
from typing import Any, Literal, TypeVar, Union, get_args, get_origin

import msgspec

from verify.errors import InputError, near_name, shown

T = TypeVar("T")

_UNKNOWN = re.compile(r"Object contains unknown field `(?P<key>.*)`")
_MISSING = re.compile(r"Object missing required field `(?P<key>.*)`")
_ONE_NUMBER = re.compile(r"Expected `(float|int)( \| null)?`.*, got `array`")
_NUMBER_MEANT = re.compile(r"Expected `float( \| null)?`")
_WITH_UNIT = re.compile(r"\s*[+-]?(\d+\.?\d*|\.\d+)([eE][+-]?\d+)?\s*[^\W\d_%°/*^]")
_STEP = re.compile(r"\.([A-Za-z_][\w-]*)|\[(\d+|\.\.\.)\]")
_PLAIN = {
    "int": "a whole number",
    "float": "a number",
    "str": "a word",
    "bool": "true or false",
    "array": "a list",
    "object": "a table",
}


def checked(data: Any, kind: type[T], where: str = "") -> T:
    """`data` (plain dicts, lists, numbers, strings) as a value of `kind`, unknown keys refused.

    `where` heads the names of fields in messages. Raises InputError with one sentence.
    """
    try:
        return msgspec.convert(data, kind, strict=True)
    except msgspec.ValidationError as error:
        if isinstance(error.__cause__, InputError):
            raise error.__cause__ from None
        raise InputError(_sentence(str(error), data, kind, where)) from None


def _sentence(message: str, data: Any, kind: Any, where: str) -> str:
    """What msgspec found, as one sentence in the words of a scene file."""
    what, _, path = message.partition(" - at `")
    steps = [a or int(b) for a, b in _STEP.findall(path.rstrip("`").replace("[...]", "")) if a or b.isdigit()]
    field = _dotted(where, steps)
    if found := _UNKNOWN.match(what):
        known = _keys_of(table_of(_type_at(kind, steps)))
        return f"{_dotted(where, [*steps, found['key']])} is not a known key: {near_name(found['key'], known)}"
    if found := _MISSING.match(what):
        return f"{_dotted(where, [*steps, found['key']])} is missing: give it a value"
    value = _value_at(data, steps)
    if what.startswith("Invalid enum value"):
        words = tuple(str(word) for word in get_args(bare(_type_at(kind, steps))))
        return f"{field} = {shown(value)} is not known: {near_name(str(value), words)}"
    return f"{field} = {_as_given(value)}: {_wanted(what, value, kind, steps)}"


def _wanted(what: str, value: Any, kind: Any, steps: list[Any]) -> str:
    """The remedy, by what msgspec found and what is often meant by it."""
    if one := _ONE_NUMBER.match(what):
        return "give one number, with a point before its decimals" if one[1] == "float" else "give one whole number"
    if isinstance(value, str) and _NUMBER_MEANT.match(what) and _WITH_UNIT.match(value):
        return "give a number alone, in SI units, which are not written: 0.08 for 80 mm"
    if isinstance(value, str) and what.startswith("Expected `array`"):
        return _listed(_type_at(kind, steps))
    return _humane(what)


def _listed(kind: Any) -> str:
    """What to give for a word where a list stands."""
    parts = next((get_args(arm) for arm in arms_of(kind) if get_origin(arm) is tuple), ())
    words = get_args(bare(parts[0])) if parts and get_origin(bare(parts[0])) is Literal else ()
    if not words:
        return "give a list"
    several = "one or more" if parts[-1] is Ellipsis else str(len(parts))
    return f"give a list, {several} of {', '.join(words)} with commas between"


def _as_given(value: Any) -> str:
    """A value as a message shows it; floats that are none in words, for a plan prints them too."""
    if isinstance(value, float) and not isfinite(value):
        return "not a number" if isnan(value) else "infinity" if value > 0 else "-infinity"
    return shown(value)


def _humane(what: str) -> str:
    """Msgspec's 'Expected `int` >= 1' in plain words."""
    text = what.split(", got ", maxsplit=1)[0].replace("Expected", "give").replace(" | null", "")
    return re.sub(r"`(\w[\w |]*)`", lambda found: " or ".join(_PLAIN.get(w, w) for w in found[1].split(" | ")), text)


def _dotted(where: str, steps: list[Any]) -> str:
    text = where
    for step in steps:
        text += f"[{step}]" if isinstance(step, int) else f".{step}" if text else str(step)
    return text or "the scene"


def _value_at(data: Any, steps: list[Any]) -> Any:
    for step in steps:
        try:
            data = data[step]
        except (KeyError, IndexError, TypeError):
            return data
    return data


def bare(kind: Any) -> Any:
    """The type without its None and without its annotations."""
    if hasattr(kind, "__metadata__"):
        return bare(get_args(kind)[0])
    if get_origin(kind) in (Union, UnionType):
        return bare(next(arm for arm in get_args(kind) if arm is not type(None)))
    return kind


def _type_at(kind: Any, steps: list[Any]) -> Any:
    for step in steps:
        kind = bare(kind) if isinstance(step, int) else table_of(kind)
        if isinstance(step, int):
            arms = get_args(kind)
            kind = arms[min(step, len(arms) - 1)] if arms and arms[-1] is not Ellipsis else arms[0]
        else:
            kind = next(f.type for f in msgspec.structs.fields(kind) if f.encode_name == step)
    return kind


def _keys_of(kind: Any) -> tuple[str, ...]:
    return tuple(f.encode_name for f in msgspec.structs.fields(kind))


def arms_of(kind: Any) -> tuple[Any, ...]:
    """The kinds that a kind stands for, without annotations."""
    if hasattr(kind, "__metadata__"):
        return arms_of(get_args(kind)[0])
    if get_origin(kind) in (Union, UnionType):
        return tuple(arm for one in get_args(kind) for arm in arms_of(one))
    return (kind,)


def table_of(kind: Any) -> Any:
    """Of the kinds that a kind stands for, the one with keys of its own, if there is one."""
    arms = arms_of(kind)
    return next((arm for arm in arms if isinstance(arm, type) and issubclass(arm, msgspec.Struct)), bare(kind))
