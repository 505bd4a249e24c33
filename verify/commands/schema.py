"""`verify schema`: the keys of a scene file."""

import click

from verify.commands.shared import console, print_json

_LIMITS = (("exclusiveMinimum", ">"), ("minimum", ">="), ("exclusiveMaximum", "<"), ("maximum", "<="))


@click.command()
@click.argument("section", required=False)
@click.option("--json", "as_json", is_flag=True, help="Print the JSON Schema, for TOML editors.")
def schema(section: str | None, as_json: bool) -> None:
    """List the keys of a SECTION of a scene file with type, default and meaning; without SECTION the sections.

    Editors of TOML complete and check a scene whose first line is `#:schema ./verify.schema.json`.
    Example: `verify schema beam.spring`, `verify schema --json > verify.schema.json`
    """
    from verify.report.result import Column, Table
    from verify.scene.schema import TOP, scene_schema, sections

    if as_json:
        print_json(scene_schema(section or TOP))
    elif section is None:
        rows = [(name, (kind.__doc__ or "").split("\n\n")[0]) for name, kind in sections().items()]
        Table("", [Column("section"), Column("meaning")], rows).print(console())
    else:
        wanted = scene_schema(section)
        required = wanted.get("required", ())
        keys = []
        for key, one in wanted["properties"].items():
            default = "required" if key in required else str(one.get("default", ""))
            keys.append((key, type_text(one), default, one.get("description", "")))
        columns = [Column(name) for name in ("key", "type", "default", "meaning")]
        Table(section, columns, keys).print(console())


def type_text(one: dict[str, object]) -> str:
    """Type and limits of a property of a JSON Schema: 'number > 0', 'list of table'."""
    for arms in ("anyOf", "allOf"):
        if isinstance(one.get(arms), list):
            return " | ".join(type_text(arm) for arm in one[arms])  # type: ignore[attr-defined]
    if "enum" in one:
        return " | ".join(map(str, one["enum"]))  # type: ignore[call-overload]
    if "$ref" in one:
        return "table"
    if one.get("type") == "array":
        items = one.get("items")
        return f"list of {type_text(items)}" if isinstance(items, dict) else "list"
    limits = "".join(f" {sign} {one[key]:g}" for key, sign in _LIMITS if key in one)
    return f"{one.get('type', 'any')}{limits}"
