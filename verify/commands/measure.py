"""`verify measure`: the value of one quantity."""

import click

from verify.commands.shared import console, json_option, overrides_option, print_json, progress, scene_argument


@click.command()
@scene_argument
@click.argument("quantity")
@click.argument("arguments", nargs=-1, metavar="[KEY=VALUE]...")
@overrides_option
@json_option
def measure(scene: str, quantity: str, arguments: tuple[str, ...], overrides: tuple[str, ...], as_json: bool) -> None:
    """Evaluate QUANTITY of SCENE. `verify quantities` lists quantities and their arguments.

    Example: `verify measure paper mode.frequency_error model=segment mode=22 count=49`
    """
    from verify.analysis.margins import quantity_margins
    from verify.analysis.solution_cache import SolutionCache
    from verify.quantities.base import QUANTITIES, as_plain, as_text, evaluate, parse_arguments
    from verify.report.verdict import COLOURS, verdict_of
    from verify.scene.load import load_scene

    given = parse_arguments(quantity, arguments)
    loaded = load_scene(scene, overrides)
    with progress(quiet=as_json) as step:
        step(quantity)
        value = evaluate(quantity, given, loaded, cache := SolutionCache(loaded.beam))
        margins = quantity_margins(quantity, given, loaded, cache)
    found = verdict_of(margins) if margins else None
    unit = QUANTITIES.named(quantity).unit
    if as_json:
        print_json(
            {"quantity": quantity, "arguments": given, "value": as_plain(value), "unit": unit}
            | ({"verdict": found.to_dict()} if found else {})
        )
    else:
        if found:
            console().print(found.headline, style=f"bold {COLOURS[found.level]}")
        click.echo(f"{quantity} = {as_text(value)} {unit}".removesuffix(" 1"))
