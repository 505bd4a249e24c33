"""What a scene may hold: its keys for a person, and their JSON Schema for an editor."""

from pathlib import Path

import click

from verify.commands.shared import json_alone, print_json
from verify.errors import printable


@click.command()
@click.argument("section", required=False)
@json_alone
def keys(section: str | None, as_json: bool) -> None:
    """What a SECTION of a scene may hold.

    Its keys, each with type, default, unit and meaning. Without SECTION: which sections there are.

    Example: `verify keys beam.spring`
    """
    from verify.report.terminal_lists import print_keys, print_sections
    from verify.scenes.described import first_sentence, keys_of, sections

    if section is None:
        told = {name: first_sentence(kind) for name, kind in sections().items()}
        listed = [{"section": name, "keys": len(keys_of(name)), "meaning": said} for name, said in told.items()]
        print_json(listed) if as_json else print_sections(listed)
        return
    found = keys_of(section)
    if as_json:
        import msgspec

        print_json(msgspec.to_builtins(found))
    else:
        print_keys(section, first_sentence(sections()[section]), found)


@click.command()
@click.option("--section", metavar="NAME", help="Of one section alone: beam, drive.force, gate.")
@click.option("--to", "path", metavar="FILE", help="Write it to FILE instead of printing it.")
def schema(section: str | None, path: str | None) -> None:
    """JSON Schema of a scene, for editors.

    With it an editor of TOML (Taplo, Even Better TOML) completes and checks the keys of a scene.

    Example: `verify schema --to verify.schema.json`, which the first line of a new scene names.
    """
    import json

    from verify.quantities.catalogue import QUANTITIES
    from verify.scenes.described import TOP
    from verify.scenes.schema import section_schema

    text = json.dumps(section_schema(section or TOP, QUANTITIES), indent=2, allow_nan=False) + "\n"
    if path is None:
        click.echo(text, nl=False)
        return
    from verify.files import check_no_scene, write_whole

    check_no_scene(Path(path), "--to")
    write_whole(Path(path), text, "--to")
    click.echo(printable(f"wrote {path}; a scene beside it names it in its first line: #:schema ./{Path(path).name}"))
