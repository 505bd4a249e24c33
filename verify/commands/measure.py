"""One named figure."""

from math import isnan

import click

from verify.commands.shared import (
    PERCENT,
    in_percent,
    json_alone,
    load,
    overridden,
    print_json,
    progress,
)
from verify.errors import InputError


@click.command()
@click.argument("quantity")
@click.argument("arguments", nargs=-1, metavar="[KEY=VALUE]...")
@click.option("--scene", default="paper", show_default=True, help="Whose beam and drive.")
@overridden
@json_alone
def measure(quantity: str, arguments: tuple[str, ...], scene: str, overrides: tuple[str, ...], as_json: bool) -> None:
    """Any named QUANTITY: `verify measure mode.frequency_error model=segment mode=22 count=49`."""
    from verify.judge.workbench import Workbench
    from verify.quantities import catalogue as quantities
    from verify.scenes.toml import given_arguments

    found = quantities.quantity(quantity)
    given = given_arguments(arguments)
    checked = quantities.arguments_of(found, given)
    asked = load(scene, overrides)
    bench = Workbench(asked.beam)
    with progress(PERCENT, quiet=as_json) as step:
        bench.tell = in_percent(step)
        value = quantities.evaluate(found, checked, asked, bench)
    if isinstance(value, float) and isnan(value):
        raise InputError(f"{quantity} is not a number for these arguments: they lie beyond what floating point carries")
    plain = quantities.as_plain(value)
    if as_json:
        shown = quantities.arguments_as_plain(checked, given)
        print_json({"quantity": quantity, "arguments": shown, "value": plain, "unit": found.unit})
    else:
        click.echo(f"{quantity} = {quantities.in_words(plain)} {found.unit}".removesuffix(" 1"))
