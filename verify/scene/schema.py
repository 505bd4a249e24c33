"""JSON Schema of a scene file; descriptions are the docstrings under the fields."""

import ast
import inspect
from functools import cache
from itertools import pairwise
from textwrap import dedent
from typing import Any

import msgspec

from verify.quantities.base import QUANTITIES
from verify.scene.model import Scene
from verify.studies.base import STUDIES
from verify.validation import check_choice, description_of, entry_of, structs_of

DRAFT = "http://json-schema.org/draft-07/schema#"
"""Read by TOML editors."""
TOP = "scene"  # name of the keys outside of any section


def sections() -> dict[str, type[msgspec.Struct]]:
    """Every table of a scene by its dotted name: 'scene', 'beam', 'beam.section', ..., and those of studies."""
    kinds: dict[str, type[msgspec.Struct]] = {TOP: Scene}

    def add(kind: type[msgspec.Struct], where: str) -> None:
        for field in msgspec.structs.fields(kind):
            tables = structs_of(entry_of(field.type)) | structs_of(field.type)
            for tag, table in tables.items():
                if table in kinds.values():  # a material of several actuators
                    continue
                name = f"{where}{field.encode_name}" + (f".{tag}" if len(tables) > 1 else "")
                kinds[name] = table
                add(table, f"{name}.")

    add(Scene, "")
    for name in STUDIES:
        kinds[name] = STUDIES[name]
        add(STUDIES[name], f"{name}.")
    return kinds


def scene_schema(section: str = TOP) -> dict[str, Any]:
    """JSON Schema, draft 7, of a scene file or of one of its sections. Raises InputError for an unknown section."""
    kinds = sections()
    check_choice("section", section, tuple(kinds))
    references, tables = msgspec.json.schema_components(kinds.values(), ref_template="#/$defs/{name}")
    names = {name: reference["$ref"] for name, reference in zip(kinds, references, strict=True)}
    tables = {name: _tidy(table) for name, table in tables.items()}
    for name, kind in kinds.items():
        table = tables[names[name].rpartition("/")[2]]
        table["description"] = (inspect.getdoc(kind) or "").split("\n\n")[0].replace("\n", " ")
        tag = {"kind": "Kind of the table."} if kind.__struct_config__.tag else {}
        for key, meaning in (descriptions(kind) | tag).items():
            field = table["properties"][key]
            table["properties"][key] = {**({"allOf": [field]} if "$ref" in field else field), "description": meaning}
    for name in ("Gate", "Claim"):
        tables[name]["properties"]["quantity"]["enum"] = sorted(QUANTITIES)
    top = tables["Scene"]["properties"]
    top.pop("studies", None)
    top |= {name: {"$ref": names[name]} for name in STUDIES}
    chosen = tables[names[section].rpartition("/")[2]]
    return {"$schema": DRAFT, **chosen, "$defs": tables}


@cache
def descriptions(kind: type[msgspec.Struct]) -> dict[str, str]:
    """What each key means: the docstring under its field in the source, or the description in its annotation."""
    meanings: dict[str, str] = {}
    for base in reversed(kind.__mro__[:-1]):
        try:
            body = ast.parse(dedent(inspect.getsource(base))).body[0]
        except (OSError, TypeError, SyntaxError):
            continue
        for node, after in pairwise(getattr(body, "body", ())):
            if isinstance(node, ast.AnnAssign) and isinstance(node.target, ast.Name) and isinstance(after, ast.Expr):
                meanings[node.target.id] = " ".join(str(ast.literal_eval(after.value)).split())
    fields = {field.name: field for field in msgspec.structs.fields(kind)}
    for name, field in fields.items():
        meanings.setdefault(name, description_of(field.type))
    return {fields[name].encode_name: meanings[name] for name in fields if meanings[name]}


def _tidy(schema: Any) -> Any:
    """Without null, which TOML lacks, and with draft 7's form of fixed-length lists."""
    if isinstance(schema, list):
        return [_tidy(part) for part in schema]
    if not isinstance(schema, dict):
        return schema
    plain = {key: _tidy(value) for key, value in schema.items() if not (key == "default" and value is None)}
    if "prefixItems" in plain:
        plain |= {"items": plain.pop("prefixItems"), "additionalItems": False}
    arms = [arm for arm in plain.pop("anyOf", []) if arm != {"type": "null"}]
    return {**plain, **({"anyOf": arms} if len(arms) > 1 else {"allOf": arms} if arms else {})}
