"""`verify sweep`: a quantity over its arguments or over values of the scene."""

import click

from verify.commands.shared import charts_option, format_options, overrides_option, scene_argument


@click.command()
@scene_argument
@click.argument("options", nargs=-1, metavar="[KEY=VALUE]...")
@overrides_option
@charts_option
@format_options
def sweep(
    scene: str, options: tuple[str, ...], overrides: tuple[str, ...], charts: str | None, **formats: bool
) -> None:
    """Evaluate a quantity over one or several axes; KEY=VALUE sets an option of the scene's [sweep].

    `verify schema sweep` lists the options.
    """
    from verify.commands.table import run_study

    run_study(scene, "sweep", options, overrides, charts, formats)
