"""Scene files: TOML read, overridden by `--set`, converted with all errors at once, copied under another name."""

import re
from collections.abc import Iterable, Iterator, Sequence
from pathlib import Path
from typing import Any

import msgspec

from verify.convert import convert, entry_of, structs_of, typed
from verify.errors import InputError, near_name, raise_all, shown
from verify.files import exists
from verify.problem.phrase import PREFIX, beam_table
from verify.problem.slider import OF_ONE_LAW
from verify.quantities.base import QUANTITIES
from verify.scene.model import Scene
from verify.studies.base import STUDIES

DATA = Path(__file__).parent / "data"
STARTER = DATA / "starter.toml"
MAX_SENTENCES = 30  # errors of one scene that are listed
SCHEMA_LINE = "#:schema ./verify.schema.json"
"""Names the schema for TOML editors; `verify schema --json > verify.schema.json` writes the file."""
_OWN = tuple(name for name in Scene.__struct_fields__ if name != "studies")


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


def load_scene(name_or_path: str | Path, overrides: Sequence[str] = ()) -> Scene:
    """A packaged scene by name, any other by path, a beam in one line after 'beam: ', with 'key=value' overrides.

    Raises InputError with one sentence for each error.
    """
    return scene_from(tables_of(name_or_path, overrides))


def scene_from(tables: dict[str, Any]) -> Scene:
    """A scene from plain tables as in a file. Raises InputError with one sentence for each error."""
    errors: list[str] = []
    own: dict[str, Any] = {name: value for name, value in tables.items() if name in _OWN}
    studies: dict[str, Any] = {}
    for name, section in tables.items():
        if name in _OWN:
            continue
        try:
            if name == "studies" or name not in STUDIES:
                raise InputError(f"{name} is not a known key: {near_name(str(name), (*_OWN, *STUDIES))}")
            studies[name] = convert(section, STUDIES[name], name)
        except InputError as error:
            errors += error.sentences
    try:
        scene = convert(own | {"studies": studies}, Scene)
    except InputError as error:
        errors += error.sentences
    errors += _argument_errors(tables)
    raise_all(errors, MAX_SENTENCES)
    return scene


def _argument_errors(tables: dict[str, Any]) -> Iterator[str]:
    """A sentence for each gate and claim with an unknown quantity or wrong arguments."""
    for table in ("gate", "claim"):
        for one in tables[table] if isinstance(tables.get(table), list) else ():
            name, arguments = (one.get("quantity"), one.get("arguments", {})) if isinstance(one, dict) else (None, None)
            of_run = table == "claim" and not arguments
            if isinstance(name, str) and isinstance(arguments, dict) and not of_run:
                try:
                    QUANTITIES.named(name).bind(arguments)
                except InputError as error:
                    yield f"{table}.{one.get('id', '?')}: {error}"


def tables_of(name_or_path: str | Path, overrides: Sequence[str] = ()) -> dict[str, Any]:
    """The plain tables of a scene file with overrides, not yet checked. Raises InputError."""
    if not isinstance(overrides, tuple | list) or not all(isinstance(text, str) for text in overrides):
        raise InputError(f"overrides = {overrides!r}: give a list of 'key=value' words")
    phrase = str(name_or_path).removeprefix(PREFIX)
    if phrase != str(name_or_path):
        tables: dict[str, Any] = {"name": "beam", "title": phrase, "beam": beam_table(phrase)}
    else:
        path = scene_path(name_or_path)
        tables = read_toml(path)
        for name, section in tables.items():
            for field in STUDIES[name].files if isinstance(section, dict) and name in STUDIES else ():
                if isinstance(section.get(field), str):
                    section[field] = str(path.parent / section[field])
    keys = [text.partition("=")[0].strip() for text in overrides]
    errors = [f"--set {key} occurs twice: set it once" for key in dict.fromkeys(keys) if keys.count(key) > 1]
    for text in overrides:
        try:
            override(tables, text)
        except InputError as error:
            errors += error.sentences
    raise_all(errors, MAX_SENTENCES)
    _drop_obsolete(tables, set(keys))
    return tables


def read_toml(path: Path) -> dict[str, Any]:
    """The tables of a TOML file. Raises InputError where it is none."""
    import tomllib

    try:
        return tomllib.loads(read_text(path))
    except InputError:
        raise
    except (ValueError, RecursionError) as error:
        raise InputError(f"scene file {str(path)!r} is not TOML: {error}") from None


def read_text(path: Path) -> str:
    """The text of a scene file. Raises InputError where it cannot be read."""
    exists(path, "scene")
    if path.exists() and not (path.is_file() or path.is_dir()):
        raise InputError(f"scene file {str(path)!r} is a pipe or a device: write the scene to a file")
    try:
        return path.read_bytes().decode("utf-8-sig").replace("\r\n", "\n")
    except OSError as error:
        raise InputError(f"scene file {str(path)!r} cannot be read: {error.strerror or error}") from None
    except UnicodeDecodeError:
        raise InputError(f"scene file {str(path)!r} is not text in UTF-8: save it as TOML in UTF-8") from None


def override(tables: dict[str, Any], assignment: str) -> None:
    """Set one value in place: 'beam.length=0.4', 'gate.ID.within=1e-6'. Raises InputError."""
    key, equals, text = (part.strip() for part in assignment.partition("="))
    if not equals or not key or not text:
        raise InputError(f"--set {shown(assignment)} is not an assignment: write key=value, beam.length=0.4")
    value = typed(text, type_at(key), key)
    *parents, last = key.split(".")
    here: Any = tables
    for depth, step in enumerate(parents):
        field = ".".join(parents[: depth + 1])
        here = here[_position(here, step, field)] if isinstance(here, list) else here.setdefault(step, {})
        if not isinstance(here, dict | list):
            raise InputError(f"--set {field} is a value, not a table: set {field} itself")
    here[_position(here, last, key) if isinstance(here, list) else last] = value


def type_at(key: str) -> Any:
    """The type of the value at 'beam.length' or 'gate.ID.within'; None where there is no such key."""
    first, *steps = key.split(".")
    kind: Any = Scene if first in _OWN else STUDIES.get(first)
    for step in [first, *steps] if kind is Scene else steps:
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
    for known in (names, numbers):
        if step in known:
            return known.index(step)
    raise InputError(f"--set {field} is no entry of the list: {near_name(step, names)}")


def _drop_obsolete(tables: dict[str, Any], keys: Iterable[str]) -> None:
    """Remove what an override made obsolete: the reference of a new expectation, the parameter of another law."""
    for i, gate in enumerate(tables.get("gate", ()) if isinstance(tables.get("gate"), list) else ()):
        names = (i, gate.get("id")) if isinstance(gate, dict) else ()
        if any(f"gate.{name}.{limit}" in keys for name in names for limit in ("expect", "at_least", "at_most")):
            gate.pop("reference", None)
    slider = tables.get("slider")
    if "slider.law" in keys and isinstance(slider, dict):
        for law, name in OF_ONE_LAW.items():
            if slider["law"] != law and f"slider.{name}" not in keys:
                slider.pop(name, None)


def copy_with_name(text: str, name: str) -> str:
    """A scene's text under another name, with its comments and the line that names a schema."""
    import tomlkit

    copied = tomlkit.parse(text)
    copied["name"] = name
    result = tomlkit.dumps(copied)
    return result if "#:schema" in result else f"{SCHEMA_LINE}\n{result}"


def starter_with(tables: dict[str, Any]) -> str:
    """The starter with its comments, other tables for name, title and beam, and no gates, which are its own beam's."""
    head, _, tail = read_text(STARTER).partition("[[gate]]")[0].partition("[beam]")
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
