"""JSON Schema of a scene file; descriptions are the docstrings under the fields."""

import ast
import inspect
from functools import cache
from itertools import pairwise
from textwrap import dedent
from typing import Any

import msgspec

from verify.convert import description_of, structs_of
from verify.errors import InputError, near_name
from verify.quantities.base import QUANTITIES
from verify.scene.model import Scene
from verify.studies.base import STUDIES

DRAFT = "http://json-schema.org/draft-07/schema#"
"""Read by TOML editors."""
TOP = "scene"  # name of the keys outside of any section


def sections() -> dict[str, type[msgspec.Struct]]:
    """Every table of a scene by its dotted name: 'scene', 'beam', 'beam.section', ..., and those of studies."""
    found: dict[str, type[msgspec.Struct]] = {TOP: Scene}

    def add(kind: type[msgspec.Struct], where: str) -> None:
        for field in msgspec.structs.fields(kind):
            entry = next((arg for arg in getattr(field.type, "__args__", ()) if structs_of(arg)), field.type)
            tables = structs_of(field.type) or structs_of(entry)
            for table in tables:  # a union's by their tags: drive.actuator.stack
                name = where + field.encode_name + (f".{table.__struct_config__.tag}" if len(tables) > 1 else "")
                found[name] = table
                add(table, f"{name}.")

    add(Scene, "")
    for name in STUDIES:
        found[name] = STUDIES[name]
        add(STUDIES[name], f"{name}.")
    return found


def scene_schema(section: str = TOP) -> dict[str, Any]:
    """JSON Schema, draft 7, of a scene file or of one of its sections. Raises InputError for an unknown section."""
    kinds = sections()
    if section not in kinds:
        raise InputError(f"section = {section!r} is not known: {near_name(section, tuple(kinds))}")
    references, tables = msgspec.json.schema_components(kinds.values(), ref_template="#/$defs/{name}")
    names = {name: reference["$ref"] for name, reference in zip(kinds, references, strict=True)}
    tables = {name: _tidy(table) for name, table in tables.items()}
    for name, kind in kinds.items():
        table = tables[names[name].rpartition("/")[2]]
        table["description"] = (inspect.getdoc(kind) or "").split("\n\n")[0].replace("\n", " ")
        for key, meaning in descriptions(kind).items():
            own = table["properties"][key]
            table["properties"][key] = {**({"allOf": [own]} if "$ref" in own else own), "description": meaning}
        if (tag := kind.__struct_config__.tag_field) is not None:
            table["properties"][tag]["description"] = "Kind of this table."
    for name in ("Gate", "Claim"):
        tables[name]["properties"]["quantity"]["enum"] = sorted(QUANTITIES)
    top = tables["Scene"]["properties"]
    top.pop("studies", None)
    top |= {name: {"$ref": names[name]} for name in STUDIES}
    own = tables[names[section].rpartition("/")[2]]
    return {"$schema": DRAFT, **own, "$defs": tables}


@cache
def descriptions(kind: type[msgspec.Struct]) -> dict[str, str]:
    """What each key means: the docstring under its field in the source, or the description in its annotation."""
    found: dict[str, str] = {}
    for one in reversed(kind.__mro__[:-1]):
        try:
            body = ast.parse(dedent(inspect.getsource(one))).body[0]
        except (OSError, TypeError, SyntaxError):
            continue
        for node, after in pairwise(getattr(body, "body", ())):
            if isinstance(node, ast.AnnAssign) and isinstance(node.target, ast.Name) and isinstance(after, ast.Expr):
                found[node.target.id] = " ".join(str(ast.literal_eval(after.value)).split())
    fields = {field.name: field for field in msgspec.structs.fields(kind)}
    for name, field in fields.items():
        found.setdefault(name, description_of(field.type))
    return {fields[name].encode_name: found[name] for name in fields if found[name]}


def _tidy(schema: Any) -> Any:
    """Without null, which TOML lacks, and with draft 7's form of fixed-length lists."""
    if isinstance(schema, list):
        return [_tidy(one) for one in schema]
    if not isinstance(schema, dict):
        return schema
    plain = {key: _tidy(value) for key, value in schema.items() if not (key == "default" and value is None)}
    if "prefixItems" in plain:
        plain |= {"items": plain.pop("prefixItems"), "additionalItems": False}
    arms = [arm for arm in plain.pop("anyOf", []) if arm != {"type": "null"}]
    return {**plain, **({"anyOf": arms} if len(arms) > 1 else {"allOf": arms} if arms else {})}
