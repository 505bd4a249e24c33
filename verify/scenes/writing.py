"""Scenes as text: plain tables written as TOML, and a scene copied under another name with its comments."""

import json
import re
from pathlib import Path
from typing import Any

from verify.errors import InputError, shown

WIDTH = 100
"""Characters of a line from which on a list of tables is given lines of its own."""
SCHEMA_LINE = "#:schema ./verify.schema.json"
"""What editors of TOML read at the top of a file; `verify schema --to verify.schema.json` writes the file."""
_NAME = re.compile(r"^name[ \t]*=[ \t]*(\"[^\"\n]*\"|'[^'\n]*')", re.MULTILINE)
_TABLE = re.compile(r"^\[", re.MULTILINE)
_BARE = re.compile(r"[A-Za-z0-9_-]+")


def toml_text(data: dict[str, Any]) -> str:
    """Plain tables as TOML: values, then tables, then lists of tables, in the order in which they stand."""
    return "\n".join(_lines(data, ())).strip() + "\n"


def _lines(table: dict[str, Any], where: tuple[str, ...]) -> list[str]:
    """The lines of one table; of what it holds, tables at the top stand in sections of their own."""
    sections = {k: v for k, v in table.items() if isinstance(v, dict) and not where}
    lists = {k: v for k, v in table.items() if not where and _is_tables(v)}
    lines = [f"{_key(k)} = {_value(v, len(k))}" for k, v in table.items() if k not in sections and k not in lists]
    for key, value in sections.items():
        lines += ["", f"[{_key(key)}]", *_lines(value, (key,))]
    for key, entries in lists.items():
        for entry in entries:
            lines += ["", f"[[{_key(key)}]]", *_lines(entry, (key,))]
    return lines


def _is_tables(value: Any) -> bool:
    return isinstance(value, list) and bool(value) and all(isinstance(one, dict) for one in value)


def _key(key: str) -> str:
    return key if _BARE.fullmatch(key) else _quoted(key)


def _quoted(text: str) -> str:
    """A string; what a terminal would obey and not print is written by its number."""
    written = json.dumps(text, ensure_ascii=False)
    return "".join(c if c.isprintable() else f"\\U{ord(c):08x}" for c in written)


def _value(value: Any, before: int = 0) -> str:
    """One value; a list of tables on a line for each where it is long."""
    if isinstance(value, bool):
        return str(value).lower()
    if isinstance(value, str):
        return _quoted(value)
    if isinstance(value, dict):
        return "{ " + ", ".join(f"{_key(k)} = {_value(v)}" for k, v in value.items()) + " }" if value else "{}"
    if isinstance(value, list):
        entries = [_value(one) for one in value]
        text = f"[{', '.join(entries)}]"
        return text if before + len(text) < WIDTH or not _is_tables(value) else _on_lines(entries)
    return repr(value) if isinstance(value, int | float) else str(value)


def _on_lines(entries: list[str]) -> str:
    return "[\n" + "".join(f"  {entry},\n" for entry in entries) + "]"


def renamed(text: str, name: str) -> str:
    """A scene's text with another name and all its comments, and the line that names a schema. Raises InputError."""
    tables = _TABLE.search(text)
    lines = _NAME.finditer(text, 0, tables.start() if tables else len(text))
    tried = (f'{text[: found.start()]}name = "{name}"{text[found.end() :]}' for found in lines)
    copied = next((one for one in tried if _named(one) == name), None)  # a line within a text of lines names nothing
    if copied is None:
        raise InputError("--from: the scene has no name on a line of its own, give it one: name = 'mine'")
    return copied if "#:schema" in copied else f"{SCHEMA_LINE}\n{copied}"


def _named(text: str) -> object:
    """The name in a scene's text; None where it is no TOML any more."""
    import tomllib

    try:
        return tomllib.loads(text).get("name")
    except tomllib.TOMLDecodeError:
        return None


def name_of(path: Path) -> str:
    """A scene's name after its file: letters, digits, dots, _ and -. Raises InputError where none is left."""
    name = re.sub(r"[^A-Za-z0-9._-]+", "-", path.stem).lstrip("._-")[:120]
    if not name:
        raise InputError(f"path = {shown(str(path))} gives no name for a scene: use letters or digits")
    return name
