"""`verify table`: the result of one study."""

import click

from verify.commands import shared


@click.command(cls=shared.BeamCommand)
@shared.scene_argument
@click.argument("options", nargs=-1, metavar="[KEY=VALUE]...")
@click.option("--study", default="convergence", show_default=True, metavar="NAME", help="Section of the study.")
@shared.overrides_option
@shared.cluster_options
@shared.charts_option
@shared.format_options
def table(
    scene: str, options: tuple[str, ...], study: str, overrides: tuple[str, ...], charts: str | None, **formats: bool
) -> None:
    """Run one study of SCENE and print its tables; KEY=VALUE sets an option of the study.

    Example: `verify table steel-cantilever modes=1-5 counts=10,20,49 wall=gregory,half`
    """
    from verify.analysis.solution_cache import SolutionCache
    from verify.convert import convert
    from verify.errors import InputError
    from verify.scene.load import load_scene, type_at
    from verify.studies.base import STUDIES, studies_of

    known = STUDIES.named(study).__struct_fields__
    for key, _, text in (option.partition("=") for option in options):
        home = next((f"{one}.{key}" for one in ("beam", "drive", "slider") if type_at(f"{one}.{key}") is not None), "")
        if home and key not in known:
            raise InputError(f"{study}.{key} is not a known key: give --set {home}={text}")
    loaded = load_scene(scene, (*overrides, *(f"{study}.{option}" for option in options)))
    chosen = dict(studies_of(loaded)).get(study) or convert({}, STUDIES[study], study)
    chosen.check(loaded)
    with shared.progress(chosen.steps or None, quiet=any(formats.values()), lines=chosen.steps > 0) as step:
        result = chosen.run(loaded, SolutionCache(loaded.beam), step)
    shared.show(result, **formats)
    shared.save_charts(result, charts)
