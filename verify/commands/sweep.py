"""`verify sweep`: quantities over values of the scene and of their arguments."""

from pathlib import Path
from typing import Any

import click

from verify.analysis.solution_cache import SolutionCache
from verify.commands import shared
from verify.errors import InputError
from verify.quantities.base import QUANTITIES
from verify.scene.load import load_scene, tables_read, type_at
from verify.studies.sweep import Sweep
from verify.validation import convert, typed


@click.command(cls=shared.BeamCommand)
@shared.scene_argument
@click.argument("words", nargs=-1, metavar="[QUANTITY]... [KEY=VALUES]...")
@shared.overrides_option
@click.option("--to", "file", metavar="FILE", help="Append each row to FILE; the same sweep continues from it.")
@shared.cluster_options
@shared.output_options
def sweep(scene: str, words: tuple[str, ...], overrides: tuple[str, ...], file: str | None, **formats: Any) -> None:
    """Evaluate QUANTITY over every combination of the lists; without QUANTITY run the [sweep] of SCENE.

    A KEY with a dot is a value of the scene, one without is an argument of the quantities; a value that is a list is in
    double brackets: window=[[0.1,0.3]]. A range is FIRST-LAST:STEP in the key's unit: 29000-31000:250 is 29000, 29250,
    ..., 31000; without a step it is 1.
    FILE has JSON lines: a kill or Ctrl-C loses only what is being computed, the same call computes the rest.
    Example: `verify sweep paper mode.frequency_error mode=22 model=segment,fem count=20-100:20 beam.length=0.4,0.5`
    """
    quantities = [word for word in words if "=" not in word]
    pairs = [word.partition("=") for word in words if "=" in word]
    kinds = {key: kind for name in quantities for key, kind in QUANTITIES.named(name).types.items()}
    lists: dict[str, list[Any]] = {}
    for key, _, text in pairs:
        kind, values = type_at(key) if "." in key else kinds.get(key), typed(text, tuple[int, ...], key)
        lists[key] = [typed(value, kind, key) if isinstance(value, str) else value for value in values]
    if len(lists) < len(pairs):
        raise InputError("KEY = VALUES: one key occurs twice, give each once")
    if lists and not quantities:
        raise InputError("QUANTITY is missing: name one before KEY=VALUES, see `verify quantities`")
    over = {key: values for key, values in lists.items() if len(values) > 1 or "." in key}
    arguments = {key: values[0] for key, values in lists.items() if key not in over}
    parts = tables_read(quantities) if quantities else None
    loaded = load_scene(scene, overrides, parts and parts | {key.partition(".")[0] for key in over if "." in key})
    words_given = Sweep(quantities=tuple(quantities), over=over, arguments=arguments)
    study = words_given if quantities else loaded.studies.get("sweep") or convert({}, Sweep, "sweep")
    study.check(loaded)
    with shared.progress(quiet=True in formats.values()) as step:
        result = study.run(loaded, SolutionCache(loaded.beam), step, Path(file) if file else None)
    shared.show(result, **formats)
    if all(reasons := [row["reason"] for row in result.data["rows"]]):
        raise InputError(f"no combination has a value, the first one because {reasons[0]}")
