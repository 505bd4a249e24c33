"""The command `verify picture`: a scene drawn, still or moving."""

from pathlib import Path

import click

from verify.commands.shared import load, overridden, scene_name, whole_number
from verify.options import PICTURED


@click.command()
@scene_name
@overridden
@click.option("--what", default="modes", show_default=True, metavar="|".join(PICTURED), help="Of the scene.")
@click.option("--mode", metavar="N", help="Which mode is drawn. Default: 3.")
@click.option("--count", metavar="N", help="Segments and elements. Default: the scene's, else 49; 20 of a chain.")
@click.option("--to", metavar="FILE", help="A .png, or moving a .webp, .gif or .mp4. Default: SCENE-WHAT.png here.")
@click.option("--flat", is_flag=True, help="Without pyvista, flat.")
def picture(
    scene: str,
    overrides: tuple[str, ...],
    what: str,
    mode: str | None,
    count: str | None,
    to: str | None,
    flat: bool,
) -> None:
    """Draw SCENE: a mode, the wave over a period, the slider's run, or a chain of its beam rolled up.

    Segments stand above elements; what is drawn larger than it is stands in words below. Solid by pyvista, which comes
    with pip install 'fem-segment-verify[viz]'; flat where there is none, or no OpenGL.
    """
    from verify.pictures.make import make_picture

    made = make_picture(
        load(scene, overrides),
        what,
        whole_number("mode", mode),
        whole_number("count", count),
        None if to is None else Path(to),
        flat,
    )
    if made.why_flat:
        click.echo(f"verify: drawn flat: {made.why_flat}", err=True)
    click.echo(f"{made.path}: {made.frames} frame{'s' * (made.frames != 1)}")
