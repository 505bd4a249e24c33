"""The command `verify export`: files that other tools read."""

from pathlib import Path

import click

from verify.commands.shared import load, overridden, progress, scene_name
from verify.options import EXPORTED, FILE_FORMATS


@click.command()
@scene_name
@overridden
@click.option("--what", metavar="|".join(EXPORTED), help="Of the scene. Default: the most that it has.")
@click.option("--format", "form", metavar="|".join(FILE_FORMATS), help="Default: the suffix of --to, else vtu.")
@click.option("--to", metavar="PATH", help="A file, or a folder for it. Default: SCENE-WHAT.FORMAT here.")
@click.option("--model", default="segment", show_default=True, help="segment, fem, analytic, or one of your own.")
@click.option("--count", metavar="N", help="Segments or elements. Default: the scene's, else 49.")
@click.option("--modes", metavar="N", help="How many, from the first. Default: as many as the scene asks for, else 10.")
@click.option("--samples", metavar="N", help="Instants of a motion (101) or of a period of a field (36).")
@click.option("--reading", metavar="R", help="Of the segments' joints: corrected (default) or raw.")
def export(
    scene: str,
    overrides: tuple[str, ...],
    what: str | None,
    form: str | None,
    to: str | None,
    model: str,
    count: str | None,
    modes: str | None,
    samples: str | None,
    reading: str | None,
) -> None:
    """Write what SCENE has for ParaView, meshio, numpy, a spreadsheet or LaTeX.

    vtu, pvd and xdmf are meshes with vectors on them; a vector is metres, of a mode 1/sqrt(kg). A pvd has its meshes in
    a folder NAME-steps beside it. Example: `verify export paper --what modes --to modes.vtu`
    """
    from verify.commands.shared import whole_number
    from verify.exports.export import Asked
    from verify.exports.export import export as exported
    from verify.exports.sheets import Wanted
    from verify.run.runner import n_steps

    wanted = Wanted(
        model=model,
        count=whole_number("count", count),
        modes=whole_number("modes", modes),
        samples=whole_number("samples", samples),
        reading=reading,
    )
    loaded = load(scene, overrides)
    asked = Asked(what=what, format=form, to=None if to is None else Path(to), wanted=wanted)
    with progress(n_steps(loaded), quiet=False) as step:
        written = exported(loaded, asked, step)
    click.echo(f"{written.path}: {written.told}")
