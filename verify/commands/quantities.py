"""What can be measured."""

from typing import Any

import click

from verify.commands.shared import json_alone, print_json

INDENT = 4


@click.command("quantities")
@click.argument("words", nargs=-1, metavar="[WORD]...")
@json_alone
def list_quantities(words: tuple[str, ...], as_json: bool) -> None:
    """List what can be measured.

    Each named quantity with its arguments, units and defaults; with WORDs those that are told with all of them.
    Arguments that several of those listed share stand below them, once. Example: `verify quantities mode order`
    """
    from verify.quantities.catalogue import described, shared_arguments

    listed = described(*words)
    if as_json:
        print_json(listed)
        return
    shared = shared_arguments(listed)
    for one in listed:
        click.secho(one["quantity"], bold=True, nl=False)
        click.echo(f"  [{one['unit']}]  {one['summary']}")
        own = [argument for argument in one["arguments"] if shared.get(argument["name"]) != argument]
        below = [argument["name"] for argument in one["arguments"] if argument not in own]
        if below:
            click.echo(_wrapped(" ".join(below)))
        for argument in own:
            _print_argument(argument)
    if shared:
        click.secho("arguments of several of these", bold=True)
        for argument in shared.values():
            _print_argument(argument)


def _print_argument(argument: dict[str, Any]) -> None:
    default = "required" if argument["required"] else f"default {argument['default']}"
    text = f"{argument['name']:<13} {argument['type']}; {default}. {argument['meaning']}".rstrip()
    click.echo(_wrapped(text, hanging=14))


def _wrapped(text: str, hanging: int = 0) -> str:
    """Lines of a terminal's width behind an indent; what runs on stands `hanging` further in."""
    from shutil import get_terminal_size
    from textwrap import fill

    width = max(get_terminal_size().columns, 40)
    indent = " " * INDENT
    return fill(text, width, initial_indent=indent, subsequent_indent=indent + " " * hanging, break_on_hyphens=False)
