"""What a scene may hold, told from the types that read it: sections, keys, types, defaults and meanings.

Meanings are the sentences that stand under the fields in the source; where there are none, those of the words to
choose among (`options`), or of the table itself.
"""

import ast
import inspect
from functools import lru_cache
from itertools import pairwise
from textwrap import dedent
from types import UnionType
from typing import Any, Literal, Union, get_args, get_origin

import msgspec

from verify import options
from verify.errors import InputError, near_name
from verify.models.naming import Among
from verify.scenes.checked import arms_of, table_of
from verify.scenes.scene import scene_type
from verify.scenes.sections import SECTIONS

TOP = "scene"
"""What the keys that stand in no section are asked for by."""


class Key(msgspec.Struct, frozen=True, kw_only=True):
    """One key of a section."""

    key: str
    type: str
    """In words."""
    required: bool
    default: Any
    """In plain data; None where it is required, or where nothing stands for it."""
    meaning: str


def sections() -> dict[str, type[msgspec.Struct]]:
    """Every table of a scene by its dotted name, those of other packages' studies too; what stands in one after it."""
    whole = scene_type(SECTIONS)
    return {TOP: whole, **dict(_below(whole, ""))}


def _below(kind: type[msgspec.Struct], where: str) -> list[tuple[str, type[msgspec.Struct]]]:
    found: list[tuple[str, type[msgspec.Struct]]] = []
    for field in msgspec.structs.fields(kind):
        if (table := inner_table(field.type)) is not None:
            name = f"{where}.{field.encode_name}".lstrip(".")
            found += [(name, table), *_below(table, name)]
    return found


def inner_table(kind: Any) -> type[msgspec.Struct] | None:
    """The table that a value is, or that a list is made of; None for any other."""
    for arm in arms_of(kind):
        if get_origin(arm) is tuple and (found := inner_table(get_args(arm)[0])) is not None:
            return found
    found = table_of(kind)
    return found if isinstance(found, type) and issubclass(found, msgspec.Struct) else None


def table_named(section: str) -> type[msgspec.Struct]:
    """The table of that dotted name. Raises InputError, with the nearest name, for one that there is not."""
    known = sections()
    if section not in known:
        raise InputError(f"section = {section!r} is not known: {near_name(section, tuple(known))}")
    return known[section]


def keys_of(section: str) -> tuple[Key, ...]:
    """The keys of a section by its dotted name. Raises InputError for one that there is not."""
    kind = table_named(section)
    told = meanings(kind)
    return tuple(
        Key(
            key=field.encode_name,
            type=type_words(field.type) + _limits(field.type),
            required=field.required,
            default=None if field.required else msgspec.to_builtins(_default(field)),
            meaning=told[field.encode_name],
        )
        for field in msgspec.structs.fields(kind)
    )


def _default(field: msgspec.structs.FieldInfo) -> Any:
    return field.default if field.default_factory is msgspec.NODEFAULT else field.default_factory()


def meanings(kind: type[msgspec.Struct]) -> dict[str, str]:
    """What each key of a table is, by its name; empty where nobody says."""
    told: dict[str, str] = {}
    for one in reversed(kind.__mro__):
        told |= _under_fields(one)
    return {field.encode_name: told.get(field.name) or _of_type(field.type) for field in msgspec.structs.fields(kind)}


@lru_cache(maxsize=64)
def _under_fields(kind: type) -> dict[str, str]:
    """The strings that stand under the fields in the source; none where there is no source."""
    try:
        body = ast.parse(dedent(inspect.getsource(kind))).body[0]
    except (OSError, TypeError, SyntaxError, IndexError):
        return {}
    return _after_assignments(body.body) if isinstance(body, ast.ClassDef) else {}


def _after_assignments(nodes: list[ast.stmt]) -> dict[str, str]:
    """The string behind each assignment, on one line, by the name that is assigned."""
    found = {}
    for node, after in pairwise(nodes):
        target = node.target if isinstance(node, ast.AnnAssign) else getattr(node, "targets", [None])[0]
        value = after.value if isinstance(after, ast.Expr) else None
        if isinstance(target, ast.Name) and isinstance(value, ast.Constant) and isinstance(value.value, str):
            found[target.id] = " ".join(value.value.split())
    return found


def _of_type(kind: Any) -> str:
    """What a type says of itself: its annotation, the words to choose among, or its docstring's first sentence."""
    if said := next((meta.description for meta in _metas(kind) if meta.description), ""):
        return said
    for arm in arms_of(kind):
        if get_origin(arm) is Literal:
            return _of_words(get_args(arm))
    table = inner_table(kind)
    return first_sentence(table) if table is not None else ""


def first_sentence(table: type) -> str:
    """What the docstring of a table's type opens with; what is raised is no matter for who writes a scene."""
    opening = (inspect.getdoc(table) or "").split("\n\n", maxsplit=1)[0].split(" Raises InputError", maxsplit=1)[0]
    return " ".join(opening.split())


def _of_words(words: tuple[Any, ...]) -> str:
    """What `options` says under a list of words."""
    names = [name for name, kind in vars(options).items() if get_args(kind) == words]
    under = _after_assignments(ast.parse(inspect.getsource(options)).body)
    said = [under[name] for name in under if name in names or vars(options).get(name) == words]
    return said[0] if said else ""


def _metas(kind: Any) -> list[msgspec.Meta]:
    """The annotations of a type and of what it may be, those of a list's entries left out."""
    own = list(getattr(kind, "__metadata__", ()))
    if own:
        return [*own, *_metas(get_args(kind)[0])]
    return [meta for arm in get_args(kind) for meta in _metas(arm)] if get_origin(kind) in (Union, UnionType) else []


def _limits(kind: Any) -> str:
    """', at least 1' and so on."""
    words = {"ge": "at least", "gt": "above", "le": "at most", "lt": "below"}
    given = {words[name]: getattr(meta, name) for meta in _metas(kind) for name in words}
    return "".join(f", {word} {value:g}" for word, value in given.items() if value is not None)


def among_of(kind: Any) -> Among | None:
    """Which models a value may name; None where it names none."""
    extras = [meta.extra for part in (kind, *get_args(kind)) for meta in getattr(part, "__metadata__", ())]
    return next((extra["among"] for extra in extras if extra and "among" in extra), None)


def type_words(kind: Any) -> str:
    """A type as a user would say it."""
    if among := among_of(kind):
        return " | ".join(among.names())
    if hasattr(kind, "__metadata__"):
        return type_words(get_args(kind)[0])
    if get_origin(kind) is Literal:
        return " | ".join(map(str, get_args(kind)))
    if get_origin(kind) is tuple:
        return _list_words(get_args(kind))
    if get_origin(kind) in (Union, UnionType):
        return " or ".join(type_words(arm) for arm in get_args(kind) if arm is not type(None))
    return _plain_words(kind)


def _plain_words(kind: Any) -> str:
    if isinstance(kind, type) and issubclass(kind, msgspec.Struct):
        return "table"
    plain = {int: "whole number", float: "number", str: "word", bool: "true | false", Any: "anything"}
    return plain.get(kind, "table" if get_origin(kind) is dict else str(kind))


def _list_words(parts: tuple[Any, ...]) -> str:
    """'list of number', 'list of tables', or of a list of so many its entries."""
    if parts[-1] is not Ellipsis:
        words = [type_words(part) for part in parts]
        return f"list of {len(words)}: " + (words[0] if len(set(words)) == 1 else ", ".join(words))
    entry = type_words(parts[0])
    return "list of " + ("tables" if entry == "table" else entry)
