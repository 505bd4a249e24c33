"""What can be measured."""

import click

from verify.commands.shared import (
    json_alone,
    print_json,
)


@click.command("quantities")
@json_alone
def list_quantities(as_json: bool) -> None:
    """List the named quantities with their arguments, units and defaults."""
    from verify.quantities.catalogue import described

    listed = described()
    if as_json:
        print_json(listed)
        return
    for one in listed:
        click.secho(one["quantity"], bold=True, nl=False)
        click.echo(f"  [{one['unit']}]  {one['summary']}")
        for argument in one["arguments"]:
            default = "required" if argument["required"] else f"default {argument['default']}"
            click.echo(f"    {argument['name']:<13} {argument['type']}; {default}. {argument['meaning']}".rstrip())
