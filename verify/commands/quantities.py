"""`verify quantities`: what can be measured."""

import click

from verify.commands.shared import console, json_option, print_json
from verify.quantities.base import describe
from verify.report.result import Column, Table

DETAILED = 4
"""Quantities up to which the arguments are listed."""


@click.command()
@click.argument("words", nargs=-1, metavar="[WORD]...")
@json_option
def quantities(words: tuple[str, ...], as_json: bool) -> None:
    """List the quantities; with WORDs those that mention all of them, and the arguments where few remain.

    Example: `verify quantities mode order`
    """
    listed = describe(*words)
    if as_json:
        print_json(listed)
        return
    rows = [(entry["name"], entry["unit"], entry["summary"]) for entry in listed]
    Table("", [Column("quantity"), Column("unit"), Column("summary")], rows).print(console())
    if len(listed) > DETAILED:
        return
    for entry in listed:
        arguments = [
            (a["name"], a["type"], "required" if a["required"] else str(a["default"]), a["description"])
            for a in entry["arguments"]
        ]
        columns = [Column(name) for name in ("argument", "type", "default", "meaning")]
        click.echo()
        Table(f"Arguments of {entry['name']}", columns, arguments).print(console())
