"""Types of fields, plain data converted to them, checks of values: one sentence for each error."""

import re
from collections.abc import Iterator, Sequence
from functools import cache
from math import inf, isfinite
from types import MemberDescriptorType, UnionType
from typing import TYPE_CHECKING, Annotated, Any, Literal, TypeAlias, TypeVar, Union, cast, get_args, get_origin

import msgspec
from msgspec import Meta

from verify.errors import InputError, near_name, printable, raise_all, shown

T = TypeVar("T")
RELATIVE = "relative"  # key in `extra` of a dimensionless number, which a command line accepts in per cent as well
RULE = "rule"  # key in `extra` of a text with a pattern: what the pattern allows, in words
LONGEST_RANGE = 10_000
_WITH_UNIT = re.compile(r"\s*[+-]?(\d+\.?\d*|\.\d+)([eE][+-]?\d+)?\s*[^\W\d_%°/*^]")
_PLAIN = {"int": "a whole number", "float": "a number", "str": "a word", "bool": "true or false"}
_PLAIN |= {"array": "a list", "object": "a table"}
_LIMITS = (("gt", "above"), ("ge", "of at least"), ("lt", "below"), ("le", "of at most"))
FACTORS = {
    "m": {"m": 1.0, "cm": 1e-2, "mm": 1e-3, "um": 1e-6, "nm": 1e-9, "in": 0.0254, "ft": 0.3048},
    "Pa": {"Pa": 1.0, "kPa": 1e3, "MPa": 1e6, "GPa": 1e9, "psi": 6894.757293168361, "ksi": 6894757.293168361},
    "kg/m^3": {"kg/m3": 1.0, "g/cm3": 1e3, "lb/in3": 0.45359237 / 0.0254**3},
    "kg": {"kg": 1.0, "g": 1e-3, "mg": 1e-6, "lb": 0.45359237},
    "N": {"N": 1.0, "mN": 1e-3, "kN": 1e3, "lbf": 4.4482216152605},
    "Hz": {"Hz": 1.0, "kHz": 1e3, "MHz": 1e6},
    "s": {"s": 1.0, "ms": 1e-3, "us": 1e-6},
    "m/s": {"m/s": 1.0, "cm/s": 1e-2, "mm/s": 1e-3, "um/s": 1e-6},
}
"""Factor of every unit to the SI unit of the key. lb is the international pound, lbf its weight (NIST SP 811, B.8)."""
NUMBER = r"[+-]?(?:\d+\.?\d*|\.\d+)(?:[eE][+-]?\d+)?"
ALIKE = str.maketrans({"^": "", "³": "3", "µ": "u", "μ": "u"})
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


def arms_of(kind: Any) -> tuple[Any, ...]:
    """The members of a union, without annotations."""
    if hasattr(kind, "__metadata__"):
        return arms_of(get_args(kind)[0])
    if get_origin(kind) in (Union, UnionType):
        return tuple(arm for member in get_args(kind) for arm in arms_of(member))
    return (kind,)


def metas_of(kind: Any) -> list[msgspec.Meta]:
    """The annotations of a type and of the members of its union; those of list entries are left out."""
    if hasattr(kind, "__metadata__"):
        return [*kind.__metadata__, *metas_of(get_args(kind)[0])]
    return [meta for arm in get_args(kind) for meta in metas_of(arm)] if get_origin(kind) in (Union, UnionType) else []


def structs_of(kind: Any) -> dict[str, type[msgspec.Struct]]:
    """The structs among the members of a union by their tags, the values of `kind` in a table."""
    tables = [arm for arm in arms_of(kind) if isinstance(arm, type) and issubclass(arm, msgspec.Struct)]
    return {str(table.__struct_config__.tag): table for table in tables}


def entry_of(kind: Any) -> Any:
    """The type of the entries of a list of any length; None for any other type."""
    parts = next((get_args(arm) for arm in arms_of(kind) if get_origin(arm) is tuple), ())
    return parts[0] if len(parts) == 2 and parts[1] is Ellipsis else None


def extra_of(kind: Any, key: str) -> Any:
    """The value of `key` in the `extra` of a type's annotations; None without that key."""
    return next((meta.extra[key] for meta in metas_of(kind) if meta.extra and key in meta.extra), None)


def description_of(kind: Any) -> str:
    """The description in the annotations of a type, the outermost where there are several."""
    return next((meta.description for meta in reversed(metas_of(kind)) if meta.description), "")


def type_name(kind: Any) -> str:
    """'number', 'list of whole numbers', 'tanh | coulomb': a type as a listing shows it."""
    arm = next(arm for arm in arms_of(kind) if arm is not type(None))
    if get_origin(arm) is Literal:
        return " | ".join(map(str, get_args(arm)))
    if get_origin(arm) is tuple:
        parts = get_args(arm)
        return f"list of {type_name(parts[0])}s" if parts[-1] is Ellipsis else f"{len(parts)} {type_name(parts[0])}s"
    name: str = arm.__name__
    return _PLAIN.get(name, name).removeprefix("a ")


def convert(data: Any, kind: type[T], where: str = "") -> T:
    """`data` (plain dicts, lists, numbers, strings) as a value of `kind`; `where` is the field's name in messages.

    Raises InputError with one sentence for each unknown key, missing key and wrong value.
    """
    try:
        value = msgspec.convert(data, kind, strict=True)
    except msgspec.ValidationError as error:
        raise_all(list(_errors(data, kind, where)))
        raise InputError(f"{where or 'scene'}: {error}") from None
    if isinstance(value, float) and not isfinite(value):
        raise InputError(sentence(where, data, kind))
    return value


def _errors(data: Any, kind: Any, where: str) -> Iterator[str]:
    """A sentence for every error; the constraints between fields are checked where each field is valid."""
    if len(tables := structs_of(kind)) > 1 and isinstance(data, dict):
        yield from _tagged_errors(data, tables, where)
        return
    table, inside = next(iter(tables.values()), None), list[str]()
    lists = next((get_args(arm) for arm in arms_of(kind) if get_origin(arm) is tuple), None)
    if table is not None and isinstance(data, dict):
        fields = {field.encode_name: field for field in msgspec.structs.fields(table)}
        for key, value in data.items():
            name = f"{where}.{key}".lstrip(".")
            if key in fields:
                inside += _errors(value, fields[key].type, name)
            else:
                inside.append(f"{name} is not a known key: {near_name(str(key), tuple(fields))}")
        if not set(data) - set(fields):  # else a missing key may be the misspelt one
            missing = {k: type_name(field.type) for k, field in fields.items() if field.required and k not in data}
            gives = {key: f"one of {kind}" if " | " in kind else "it a value" for key, kind in missing.items()}
            inside += [f"{f'{where}.{key}'.lstrip('.')} is missing: give {give}" for key, give in gives.items()]
    elif lists is not None and isinstance(data, list | tuple):
        for i, item in enumerate(data):
            named = isinstance(item, dict) and isinstance(item.get("id"), str) and item["id"]
            entry = lists[0] if lists[-1] is Ellipsis else lists[min(i, len(lists) - 1)]
            inside += _errors(item, entry, f"{where}.{named}" if named else f"{where}[{i}]")
    if inside:
        yield from inside
        return
    try:
        msgspec.convert(data, kind, strict=True)
    except msgspec.ValidationError as error:
        if isinstance(error.__cause__, InputError):
            yield from error.__cause__.sentences
        else:
            yield sentence(where, data, kind, str(error))


def _tagged_errors(data: dict[str, Any], tables: dict[str, Any], where: str) -> Iterator[str]:
    """A sentence for every error of a table whose key `kind` selects one of several structs."""
    tag, names = data.get("kind"), tuple(tables)
    if isinstance(tag, str) and tag in tables:  # a list has no hash
        yield from _errors({key: value for key, value in data.items() if key != "kind"}, tables[tag], where)
    elif tag is None:
        yield f"{where}.kind is missing: give one of {', '.join(names)}"
    else:
        yield f"{where}.kind = {shown(tag)} is not known: {near_name(str(tag), names)}"


def sentence(field: str, value: Any, kind: Any, error: str = "") -> str:
    """The message for a value that does not fit its type: field, value, remedy; `error` is msgspec's own message."""
    subject = f"{field} = {shown(value)}"
    arms = arms_of(kind)
    words = next((get_args(arm) for arm in arms if get_origin(arm) is Literal), ())
    if words and (isinstance(value, str) or len(arms) - (type(None) in arms) == 1):
        return f"{subject} is not known: {near_name(str(value), tuple(map(str, words)))}"
    if int in arms or float in arms:
        if isinstance(value, list | tuple):
            return f"{subject}: give one number, with a point before its decimals"
        if isinstance(value, str) and _WITH_UNIT.match(value):
            si = extra_of(kind, "unit")
            return f"{subject}: give a number alone, in {si if si and si != 'm' else 'SI units: 0.08 for 80 mm'}"
        metas = metas_of(kind)
        limits = [f"{text} {edge:g}" for name, text in _LIMITS for m in metas if (edge := getattr(m, name)) is not None]
        number = f"a {'finite' if float in arms else 'whole'} number {' and '.join(limits)}".rstrip()
        return f"{subject}: give {number}" + (f" ({unit})" if (unit := extra_of(kind, "unit")) else "")
    table = next(iter(structs_of(kind).values()), None)
    if table is not None and not isinstance(value, dict):
        return f"{subject}: give a table, a {table.__name__} in Python"
    text = error.partition(", got ")[0].partition(" - at ")[0].replace("Expected", "give").replace(" | null", "")
    text = re.sub(r"`(\w[\w |]*)`", lambda m: " or ".join(_PLAIN.get(w, w) for w in m[1].split(" | ")), text)
    text = text.replace("length <=", "length at most").replace("length >=", "length at least")
    rule = extra_of(kind, RULE)
    return f"{subject}: {f'give {rule}' if rule else text}"


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


def toml(text: str) -> dict[str, Any]:
    """The tables of a TOML text, dates as text, control characters escaped. Raises ValueError, RecursionError."""
    import tomllib

    def plain(value: Any) -> Any:
        if isinstance(value, dict):
            return {printable(key): plain(one) for key, one in value.items()}
        if isinstance(value, list):
            return [plain(one) for one in value]
        text = value.isoformat() if hasattr(value, "isoformat") else value
        return printable(text, "\n\t") if isinstance(text, str) else text

    tables: dict[str, Any] = plain(tomllib.loads(text))
    return tables


def literal(text: str, field: str) -> Any:
    """A TOML literal; a bare word is a string, values with commas between them are a list. Raises InputError."""
    if any("\ud800" <= character <= "\udfff" for character in text):
        raise InputError(f"{field} = {shown(text)} is not text in UTF-8: type it again")
    number = re.fullmatch(r"[+-]?(\d+\.|\.\d+)([eE][+-]?\d+)?", text)  # no TOML, but often typed
    try:
        value = float(text) if number else toml(f"value = {text}")["value"]
    except (ValueError, KeyError, RecursionError):
        lists = "," in text and not text.lstrip().startswith(("[", "{", '"', "'"))
        return [literal(part.strip(), field) for part in text.split(",") if part.strip()] if lists else text
    if isinstance(value, float) and not isfinite(value):
        raise InputError(f"{field} = {text}: give a finite number")
    return value


def typed(text: str, kind: Any, field: str) -> Any:
    """A command-line word by its type: lists of whole numbers as 1-3,7 or 10-50:10, 0.1% where relative, 40mm.

    What does not fit stays as it is; `convert` then refuses it. Raises InputError for an empty or a long range.
    """
    value, entry = literal(text, field), entry_of(kind)
    if entry is not None and int in arms_of(entry):
        parts = value if isinstance(value, list) else [value]
        return [number for part in parts for number in _spelt_out(part, field)]
    if entry is not None and str in arms_of(entry) and isinstance(value, str):
        return [value]
    if extra_of(kind, RELATIVE) and isinstance(value, str) and value.endswith("%"):
        number = literal(value[:-1].strip(), field)
        return number / 100.0 if isinstance(number, float | int) else value
    si = re.split(", | from ", extra_of(kind, "unit") or "")[0]
    if si in FACTORS and isinstance(value, str) and _WITH_UNIT.match(value):
        return in_si(value, si, field)
    return value


def in_si(text: str, si: str, field: str) -> float:
    """A number with one of the units of `si`, or with none in SI: '40 mm' is 0.04 of 'm'. Raises InputError."""
    units = FACTORS.get(si, {})
    match = re.fullmatch(rf"\s*({NUMBER})\s*(\S*)\s*", text)
    unit = match[2].translate(ALIKE) if match else ""
    if match is None or (unit and unit not in units):
        choices = f" with one of the units {', '.join(units)}" if units else ""
        raise InputError(f"{field} = {shown(text)}: give a number{choices}, without a unit it is in {si}")
    return float(match[1]) * units.get(unit, 1.0)


def _spelt_out(part: Any, field: str) -> list[Any]:
    """'10-50:10' as whole numbers, anything else as its only entry."""
    if (span := re.fullmatch(r"\s*(\d{1,18})-(\d{1,18})(?::(\d{1,18}))?\s*", str(part))) is None:
        return [part]
    start, end, step = int(span[1]), int(span[2]), int(span[3] or 1)
    if end < start or step == 0 or (end - start) // step >= LONGEST_RANGE:
        remedy = f"write a range upwards and of at most {LONGEST_RANGE} numbers, 1-5, or 10-50:10 in steps of 10"
        raise InputError(f"{field} = {shown(part)}: {remedy}")
    return list(range(start, end + 1, step))
