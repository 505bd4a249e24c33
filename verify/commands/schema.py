"""`verify schema`: the keys of a scene file."""

import click

from verify.commands.shared import console, print_json
from verify.report.result import Column, Table
from verify.scene.schema import TOP, scene_schema, sections

_LIMITS = (("exclusiveMinimum", ">"), ("minimum", ">="), ("exclusiveMaximum", "<"), ("maximum", "<="))


@click.command()
@click.argument("section", required=False)
@click.option("--json", "as_json", is_flag=True, help="Print the JSON Schema, for TOML editors.")
def schema(section: str | None, as_json: bool) -> None:
    """List the keys of a SECTION of a scene file with type, default and meaning; without SECTION the sections.

    Editors of TOML complete and check a scene whose first line is `#:schema ./verify.schema.json`.
    Example: `verify schema beam.spring`, `verify schema --json > verify.schema.json`
    """
    if as_json:
        print_json(scene_schema(section or TOP))
    elif section is None:
        rows = [(name, (kind.__doc__ or "").split("\n\n")[0]) for name, kind in sections().items()]
        Table("", [Column("section"), Column("meaning")], rows).print(console())
    else:
        table = scene_schema(section)
        required = table.get("required", ())
        keys = []
        for key, field in table["properties"].items():
            default = "required" if key in required else str(field.get("default", ""))
            keys.append((key, type_text(field), default, field.get("description", "")))
        columns = [Column(name) for name in ("key", "type", "default", "meaning")]
        Table(section, columns, keys).print(console())


def type_text(field: dict[str, object]) -> str:
    """Type and limits of a property of a JSON Schema: 'number > 0', 'list of table'."""
    for arms in ("anyOf", "allOf"):
        if isinstance(field.get(arms), list):
            return " | ".join(type_text(arm) for arm in field[arms])  # type: ignore[attr-defined]
    if "enum" in field:
        return " | ".join(map(str, field["enum"]))  # type: ignore[call-overload]
    if "$ref" in field:
        return "table"
    if field.get("type") == "array":
        items = field.get("items")
        return f"list of {type_text(items)}" if isinstance(items, dict) else "list"
    limits = "".join(f" {sign} {field[key]:g}" for key, sign in _LIMITS if key in field)
    return f"{field.get('type', 'any')}{limits}"
