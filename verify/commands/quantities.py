"""`verify quantities`: what can be measured."""

import click

from verify.commands.shared import console, json_option, print_json


@click.command()
@click.argument("words", nargs=-1, metavar="[WORD]...")
@json_option
def quantities(words: tuple[str, ...], as_json: bool) -> None:
    """List the quantities; with WORDs those that mention all of them, and the arguments where few remain.

    Example: `verify quantities mode order`
    """
    from verify.quantities.base import describe
    from verify.report.result import Column, Table

    found = describe(*words)
    if as_json:
        print_json(found)
        return
    rows = [(one["name"], one["unit"], one["summary"]) for one in found]
    Table("", [Column("quantity"), Column("unit"), Column("summary")], rows).print(console())
    if len(found) > DETAILED:
        return
    for one in found:
        arguments = [
            (a["name"], a["type"], "required" if a["required"] else str(a["default"]), a["description"])
            for a in one["arguments"]
        ]
        columns = [Column(name) for name in ("argument", "type", "default", "meaning")]
        click.echo()
        Table(f"Arguments of {one['name']}", columns, arguments).print(console())


DETAILED = 4
"""Quantities up to which the arguments are listed."""
