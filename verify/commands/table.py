"""`verify table`: the result of one study."""

from typing import Any

import click

from verify.analysis.solution_cache import SolutionCache
from verify.commands import shared
from verify.errors import InputError
from verify.scene.load import load_scene, tables_of, type_at
from verify.studies.base import STUDIES
from verify.validation import convert


@click.command(cls=shared.BeamCommand)
@shared.scene_argument
@click.argument("options", nargs=-1, metavar="[KEY=VALUE]...")
@click.option("--study", metavar="NAME", help="Section of the study [default: convergence, with [base] large-motion].")
@shared.overrides_option
@shared.cluster_options
@shared.output_options
def table(scene: str, options: tuple[str, ...], study: str | None, overrides: tuple[str, ...], **formats: Any) -> None:
    """Run one study of SCENE and print its tables; KEY=VALUE sets an option of the study.

    Example: `verify table steel-cantilever modes=1-5 counts=10,20,49 wall=gregory,half`
    """
    study = study or ("large-motion" if "base" in tables_of(scene, overrides, set()) else "convergence")
    keys = STUDIES.named(study).__struct_fields__
    for key, _, text in (option.partition("=") for option in options):
        homes = (f"{table}.{key}" for table in ("beam", "drive", "slider"))
        home = next((home for home in homes if type_at(home) is not None), "")
        if home and key not in keys:
            raise InputError(f"{study}.{key} is not a known key: give --set {home}={text}")
    reads = STUDIES[study].reads
    parts = None if reads is None else {*reads, study}
    loaded = load_scene(scene, (*overrides, *(f"{study}.{option}" for option in options)), parts)
    chosen = loaded.studies.get(study) or convert({}, STUDIES[study], study)
    chosen.check(loaded)
    with shared.progress(chosen.steps or None, quiet=True in formats.values(), lines=chosen.steps > 0) as step:
        result = chosen.run(loaded, SolutionCache(loaded.beam), step)
    shared.show(result, **formats)
