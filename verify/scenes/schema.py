"""JSON Schema of a scene, from the types that read it, so that editors complete and check keys."""

from collections.abc import Iterable
from typing import Any

import msgspec

from verify.scenes.described import TOP, first_sentence, meanings, sections, table_named

DRAFT = "http://json-schema.org/draft-07/schema#"
"""What editors of TOML read."""
_REFERENCE = "#/$defs/{name}"


def scene_schema(quantities: Iterable[str] = ()) -> dict[str, Any]:
    """The schema of a scene file, draft 7. Gates and claims may name `quantities` alone, if any are given."""
    kinds = sections()
    references, made = msgspec.json.schema_components(kinds.values(), ref_template=_REFERENCE)
    named = {ref["$ref"].rpartition("/")[2]: kind for ref, kind in zip(references, kinds.values(), strict=True)}
    tables = {name: _table(tidy(made[name]), kind) for name, kind in named.items()}
    if names := sorted(quantities):
        for table in (tables["Gate"], tables["Claim"]):
            table["properties"]["quantity"] |= {"enum": names}
    top = references[list(kinds).index(TOP)]["$ref"].rpartition("/")[2]
    return {"$schema": DRAFT, **tables.pop(top), "title": "A scene of verify", "$defs": tables}


def section_schema(section: str, quantities: Iterable[str] = ()) -> dict[str, Any]:
    """The schema of one section by its dotted name, as it stands in `sections`."""
    whole = scene_schema(quantities)
    if section == TOP:
        return whole
    (reference,), _ = msgspec.json.schema_components([table_named(section)], ref_template=_REFERENCE)
    name = reference["$ref"].rpartition("/")[2]
    return {"$schema": DRAFT, **whole["$defs"][name], "$defs": whole["$defs"]}


def _table(schema: dict[str, Any], kind: type[msgspec.Struct]) -> dict[str, Any]:
    """A table with what each of its keys means."""
    for key, meaning in meanings(kind).items():
        if meaning:
            schema["properties"][key] = _said(schema["properties"][key], meaning)
    return schema | {"description": first_sentence(kind)}


def _said(schema: dict[str, Any], meaning: str) -> dict[str, Any]:
    """A schema with a description; beside a reference nothing else is read, so that one is wrapped."""
    wrapped = {"allOf": [schema]} if "$ref" in schema else schema
    return {**wrapped, "description": meaning}


def tidy(schema: Any) -> Any:
    """Without what TOML cannot say, null, and in the words of draft 7, whose lists of so many have `items`."""
    if isinstance(schema, list):
        return [tidy(one) for one in schema]
    if not isinstance(schema, dict):
        return schema
    plain = {key: tidy(value) for key, value in schema.items() if not (key == "default" and value is None)}
    if "prefixItems" in plain:
        plain |= {"items": plain.pop("prefixItems"), "additionalItems": False}
    arms = [arm for arm in plain.pop("anyOf", []) if arm != {"type": "null"}]
    if len(arms) == 1:
        return {**arms[0], **plain} if "$ref" not in arms[0] or not plain else {"allOf": arms, **plain}
    return {**plain, "anyOf": arms} if arms else plain
