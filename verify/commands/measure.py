"""`verify measure`: the value of one quantity."""

import click

from verify.analysis.solution_cache import SolutionCache
from verify.commands import shared
from verify.estimate import Estimate, as_plain, as_text
from verify.quantities.base import QUANTITIES, evaluate, parse_arguments
from verify.report.result import Result
from verify.scene.load import load_scene, tables_read
from verify.studies.tables import quantity_margins


@click.command(cls=shared.BeamCommand)
@shared.scene_argument
@click.argument("quantity")
@click.argument("arguments", nargs=-1, metavar="[KEY=VALUE]...")
@shared.overrides_option
@shared.json_option
def measure(scene: str, quantity: str, arguments: tuple[str, ...], overrides: tuple[str, ...], as_json: bool) -> None:
    """Evaluate QUANTITY of SCENE. `verify quantities` lists quantities and their arguments.

    A mean of a run is printed with its error, to the digits that hold.

    Example: `verify measure paper mode.frequency_error model=segment mode=22 count=49`
    """
    values = parse_arguments(quantity, arguments)
    loaded = load_scene(scene, overrides, tables_read([quantity]))
    with shared.progress(quiet=as_json) as step:
        step(quantity)
        value = evaluate(quantity, values, loaded, cache := SolutionCache(loaded.beam))
        margins = quantity_margins(quantity, values, loaded, cache)
    unit = QUANTITIES.named(quantity).unit_of(values)
    result = Result(f"{quantity} = {as_text(value)} {unit}".removesuffix(" 1"), margins=margins)
    if as_json:
        data = {"quantity": quantity, "arguments": values, "value": as_plain(value), "unit": unit}
        data |= {"error": value.error} if isinstance(value, Estimate) else {}
        shared.print_json(data | ({"verdict": result.verdict.to_dict()} if result.verdict else {}))
    else:
        result.print(shared.console())
