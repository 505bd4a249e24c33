"""One named figure."""

from itertools import takewhile
from math import isnan

import click

from verify.commands.shared import (
    DEFAULT,
    PERCENT,
    in_percent,
    is_scene,
    json_alone,
    load,
    overridden,
    print_json,
    progress,
    scene_first,
)
from verify.errors import InputError


@click.command()
@click.argument("words", nargs=-1, required=True, metavar="[SCENE] QUANTITY [KEY=VALUE]...")
@click.option("--scene", help=f"Whose beam and drive, where it is not named first. Default: {DEFAULT}.")
@overridden
@json_alone
def measure(words: tuple[str, ...], scene: str | None, overrides: tuple[str, ...], as_json: bool) -> None:
    """Any named QUANTITY: `verify measure paper mode.frequency_error model=segment mode=22 count=49`."""
    from verify.judge.workbench import Workbench
    from verify.quantities import catalogue as quantities
    from verify.scenes.toml import given_arguments

    scenes = [word for word in words[:1] if word.endswith(".toml")]  # whose path may have an "=" in it
    leading = scenes + list(takewhile(lambda word: "=" not in word, words[len(scenes) :]))
    named, rest = scene_first(leading, scene, 1)
    if not rest or (len(leading) == 1 and is_scene(leading[0])):
        raise click.UsageError("Missing argument 'QUANTITY': `verify quantities` lists them.")
    (quantity,) = rest
    found = quantities.quantity(quantity)
    given = given_arguments(words[len(leading) :])
    checked = quantities.arguments_of(found, given)
    asked = load(named, overrides)
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
