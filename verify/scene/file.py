"""Scene files as plain tables: TOML read once, values set by `--set`, copies under another name; and the beam alone."""

import re
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Annotated, Any

import msgspec
from msgspec import Meta

from verify.errors import InputError, near_name, raise_all, shown
from verify.files import exists, read_text
from verify.problem.beam import Beam
from verify.problem.phrase import PREFIX, beam_table
from verify.validation import RULE, convert, entry_of, structs_of, toml, typed

DATA = Path(__file__).parent / "data"
STARTER = DATA / "starter.toml"
MAX_SENTENCES = 30  # errors of one scene that are listed
LARGEST = 5_000_000  # bytes of a scene, which Python's reader of TOML takes seconds to read
SCHEMA_LINE = "#:schema ./verify.schema.json"
"""Names the schema for TOML editors; `verify schema --json > verify.schema.json` writes the file."""
_NAME = {RULE: "at most 120 letters, digits, dots, _ and -, with a letter or digit first"}


class NamedBeam(msgspec.Struct, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """The keys of a scene that a command on the beam alone reads."""

    name: Annotated[str, Meta(pattern=r"^[A-Za-z0-9][A-Za-z0-9._-]*$", max_length=120, extra=_NAME)]
    """Name of the scene and of its reports."""
    title: str = ""
    """Heading of its report."""
    description: str = ""
    """Text below the heading."""
    beam: Beam
    """The beam."""


BEAM_KEYS = NamedBeam.__struct_fields__


def load_beam(name_or_path: str | Path, overrides: Sequence[str] = ()) -> NamedBeam:
    """The beam of a scene as of `load_scene`; its other tables are neither checked nor set. Raises InputError."""
    tables = read_tables(name_or_path)
    for key in map(key_of, overrides):
        if key.partition(".")[0] not in BEAM_KEYS:
            raise InputError(f"--set {key}: this command reads the beam alone, leave it out or set a key of beam")
    types = {field.name: field.type for field in msgspec.structs.fields(NamedBeam)}
    set_values(tables, overrides, lambda key: type_in(types, key))
    return convert({key: tables[key] for key in BEAM_KEYS if key in tables}, NamedBeam)


def packaged_scenes() -> tuple[str, ...]:
    """Names of the scenes in the package."""
    return tuple(sorted(path.stem for path in DATA.glob("*.toml") if path != STARTER))


def scene_path(name_or_path: str | Path) -> Path:
    """The file of a packaged scene, or the path itself. Raises InputError for an unknown name."""
    name = str(name_or_path)
    if name in packaged_scenes():
        return DATA / f"{name}.toml"
    path = Path(name)
    if exists(path, "scene") or path.suffix or len(path.parts) != 1:
        return path
    remedy = near_name(name, packaged_scenes())
    raise InputError(f"scene = {shown(name)} is neither a packaged scene nor a file: {remedy}")


def read_tables(name_or_path: str | Path) -> dict[str, Any]:
    """The plain tables of a packaged scene, of a file, or of a beam in one line after 'beam: '. Raises InputError."""
    phrase = str(name_or_path).removeprefix(PREFIX)
    if phrase != str(name_or_path):
        return {"name": "beam", "title": phrase, "beam": beam_table(phrase)}
    return read_toml(scene_path(name_or_path))


def read_toml(path: Path) -> dict[str, Any]:
    """The tables of a TOML file. Raises InputError where it is none."""
    text = read_text(path, "scene", LARGEST)
    try:
        return toml(text)
    except (ValueError, RecursionError) as error:
        raise InputError(f"scene = {shown(str(path))} is not TOML: {error}") from None


def key_of(assignment: str) -> str:
    """The key of 'beam.length=0.4'."""
    return assignment.partition("=")[0].strip()


def set_values(tables: dict[str, Any], overrides: Sequence[str], type_at: Callable[[str], Any]) -> None:
    """Set 'key=value' words in place; `type_at` is the type of a key. Raises InputError, a sentence for each error."""
    if not isinstance(overrides, tuple | list) or not all(isinstance(text, str) for text in overrides):
        raise InputError(f"overrides = {overrides!r}: give a list of 'key=value' words")
    keys = [key_of(text) for text in overrides]
    errors = [f"--set {key} occurs twice: set it once" for key in dict.fromkeys(keys) if keys.count(key) > 1]
    for text in overrides:
        try:
            _set_value(tables, text, type_at)
        except InputError as error:
            errors += error.sentences
    raise_all(errors, MAX_SENTENCES)


def _set_value(tables: dict[str, Any], assignment: str, type_at: Callable[[str], Any]) -> None:
    """Set one value in place: 'beam.length=0.4', 'gate.ID.within=1e-6'. Raises InputError."""
    key, equals, text = (part.strip() for part in assignment.partition("="))
    if not equals or not key or not text:
        raise InputError(f"--set {shown(assignment)} is not an assignment: write key=value, beam.length=0.4")
    value = typed(text, type_at(key), key)
    *parents, last = key.split(".")
    table: Any = tables
    for depth, step in enumerate(parents):
        field = ".".join(parents[: depth + 1])
        table = table[_position(table, step, field)] if isinstance(table, list) else table.setdefault(step, {})
        if not isinstance(table, dict | list):
            raise InputError(f"--set {field} is a value, not a table: set {field} itself")
    table[_position(table, last, key) if isinstance(table, list) else last] = value


def type_in(types: dict[str, Any], key: str) -> Any:
    """The type of the value at 'beam.length' or 'gate.ID.within', by the types of tables; None without such a key."""
    first, *steps = key.split(".")
    kind: Any = types.get(first)
    for step in steps:
        if (entry := entry_of(kind)) is not None:
            kind = entry  # the step is an id or a number
            continue
        fields = [field for table in structs_of(kind).values() for field in msgspec.structs.fields(table)]
        kind = next((field.type for field in fields if field.encode_name == step), None)
    return kind


def _position(entries: list[Any], step: str, field: str) -> int:
    """Index of a list's entry, by its id or its number from 0. Raises InputError."""
    numbers = [str(i) for i in range(len(entries))]
    names = [str(e["id"]) if isinstance(e, dict) and "id" in e else i for i, e in zip(numbers, entries, strict=True)]
    for labels in (names, numbers):
        if step in labels:
            return labels.index(step)
    raise InputError(f"--set {field} is no entry of the list: {near_name(step, names)}")


def copy_with_name(text: str, name: str) -> str:
    """A scene's text under another name, with its comments and the line that names a schema."""
    import tomlkit

    copied = tomlkit.parse(text)
    copied["name"] = name
    result = tomlkit.dumps(copied)
    return result if "#:schema" in result else f"{SCHEMA_LINE}\n{result}"


def starter_with(tables: dict[str, Any]) -> str:
    """The starter with its comments, other tables for name, title and beam, and no gates, which are its own beam's."""
    head, _, tail = read_text(STARTER, "scene").partition("[[gate]]")[0].partition("[beam]")
    return head.partition("name =")[0] + toml_text(tables) + "\n" + tail.partition("\n\n")[2]


def toml_text(tables: dict[str, Any]) -> str:
    """Plain tables as TOML."""
    import tomlkit

    return tomlkit.dumps(tables)


def name_of(path: Path) -> str:
    """A scene's name after its file: letters, digits, dots, _ and -. Raises InputError where none is left."""
    name = re.sub(r"[^A-Za-z0-9._-]+", "-", path.stem).lstrip("._-")[:120]
    if not name:
        raise InputError(f"path = {shown(str(path))} gives no name for a scene: use letters or digits")
    return name
