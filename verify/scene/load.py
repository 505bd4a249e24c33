"""Scenes from files and tables: the parts that a command uses, converted and checked with all errors at once."""

from collections.abc import Collection, Iterable, Iterator, Mapping, Sequence
from pathlib import Path
from typing import Any

import msgspec

from verify.errors import InputError, near_name, raise_all
from verify.problem.slider import OF_ONE_LAW
from verify.quantities.base import QUANTITIES
from verify.scene.file import BEAM_KEYS, MAX_SENTENCES, key_of, read_tables, scene_path, set_values, type_in
from verify.scene.model import Scene
from verify.studies.base import STUDIES, Study, studies_of
from verify.validation import convert

TYPES = {field.name: field.type for field in msgspec.structs.fields(Scene) if field.name != "studies"}
"""Types of the keys of a scene that belong to no study."""


def load_scene(name_or_path: str | Path, overrides: Sequence[str] = (), parts: Collection[str] | None = None) -> Scene:
    """A packaged scene by name, any other by path, a beam in one line after 'beam: ', with 'key=value' overrides.

    `parts`: the tables that are used, as of `scene_from`; those that overrides name are among them. Raises InputError
    with one sentence for each error.
    """
    if parts is not None:
        parts = {*parts, *(key_of(text).partition(".")[0] for text in overrides)}
    return scene_from(tables_of(name_or_path, overrides, parts), parts)


def tables_read(quantities: Iterable[str]) -> set[str] | None:
    """Tables of a scene that quantities read; None, which is all, where one reads the results of any study."""
    tables = {table for name in quantities for table in QUANTITIES.named(name).reads}
    return None if "claims" in tables else tables


def scene_from(tables: dict[str, Any], parts: Collection[str] | None = None) -> Scene:
    """A scene from plain tables as in a file. Raises InputError with one sentence for each error.

    With `parts` (names of tables) the scene has these besides name and beam, and the others are left out unchecked. The
    drive is always a part where it has a device or a shunt, since they load the beam.
    """
    drive = tables.get("drive")
    attached = isinstance(drive, dict) and (drive.get("device") or drive.get("shunt"))
    used = {*BEAM_KEYS, *(tables if parts is None else parts), *["drive"] * bool(attached)}
    errors: list[str] = []
    studies: dict[str, Any] = {}
    for name, section in tables.items():
        try:
            if name not in TYPES and (name == "studies" or name not in STUDIES):
                raise InputError(f"{name} is not a known key: {near_name(str(name), (*TYPES, *STUDIES))}")
            if name in used and name not in TYPES:
                studies[name] = convert(section, STUDIES[name], name)
        except InputError as error:
            errors += error.sentences
    values = {name: value for name, value in tables.items() if name in TYPES and name in used}
    try:
        scene = convert(values | {"studies": studies}, Scene)
        errors += study_errors(scene, studies if parts else dict(studies_of(scene)) | studies)
    except InputError as error:
        errors += error.sentences
    errors += _argument_errors(values)
    raise_all(errors, MAX_SENTENCES)
    return scene


def study_errors(scene: Scene, studies: Mapping[str, Study]) -> Iterator[str]:
    """A sentence for each study that does not suit the scene."""
    for name, study in studies.items():
        if (beside := scene.beside) and name in scene.studies and not (study.devices or beside in study.accepts):
            yield f"{beside}: [{name}] does not model it, leave out [{name}] or {beside}"
        try:
            study.check(scene)
        except InputError as error:
            yield from error.sentences


def _argument_errors(tables: dict[str, Any]) -> Iterator[str]:
    """A sentence for each gate and claim with an unknown quantity or wrong arguments."""
    for table in ("gate", "claim"):
        entries = tables[table] if isinstance(tables.get(table), list) else []
        if tables.get(table) == []:
            yield f"{table} = []: nothing is judged, give a [[{table}]] or leave the key out"
        for entry in (entry for entry in entries if isinstance(entry, dict)):
            name, arguments = entry.get("quantity"), entry.get("arguments", {})
            of_run = table == "claim" and not arguments
            if isinstance(name, str) and isinstance(arguments, dict) and not of_run:
                try:
                    QUANTITIES.named(name).bind(arguments)
                except InputError as error:
                    yield f"{table}.{entry.get('id', '?')}: {error}"


def tables_of(
    name_or_path: str | Path, overrides: Sequence[str] = (), parts: Collection[str] | None = None
) -> dict[str, Any]:
    """The plain tables of a scene file with overrides, not yet checked. Raises InputError."""
    tables = read_tables(name_or_path)
    for name in tables if parts is None else {*tables} & {*parts}:
        section = tables[name]
        for field in STUDIES[name].files if isinstance(section, dict) and name in STUDIES else ():
            if isinstance(section.get(field), str):
                section[field] = str(scene_path(name_or_path).parent / section[field])
    set_values(tables, overrides, type_at)
    _drop_obsolete(tables, set(map(key_of, overrides)))
    return tables


def type_at(key: str) -> Any:
    """The type of the value at 'beam.length' or 'gate.ID.within'; None where there is no such key."""
    first = key.partition(".")[0]
    return type_in(TYPES if first in TYPES else {first: STUDIES.get(first)}, key)


def _drop_obsolete(tables: dict[str, Any], keys: set[str]) -> None:
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
