"""`verify compare`: the discretisation behind natural frequencies or mode shapes of another program."""

from os.path import exists
from pathlib import Path
from typing import Any

import click

from verify.answers.frequencies import KINDS, compare_frequencies
from verify.commands import shared
from verify.compare.reading import UNITS, read_shapes, read_words, solve_model
from verify.errors import InputError
from verify.files import read_text
from verify.scene.file import load_beam
from verify.settings import THEORIES
from verify.validation import Relative, typed


@click.command(cls=shared.BeamCommand)
@shared.scene_argument
@click.argument("words", nargs=-1, metavar="FILE | FREQUENCIES...")
@shared.overrides_option
@click.option("--count", type=click.IntRange(min=1), metavar="N", help="Segments or elements. Default: any number.")
@click.option("--modes", "shapes", metavar="FILE", help="Mode shapes: x in the first column, then one column a mode.")
@click.option("--model", metavar="MODULE:FUNCTION", help="A Python model (beam, n_modes, count) -> frequencies in Hz.")
@click.option("--unit", type=click.Choice(list(UNITS)), help="Of the list. Default: its header's, else by the beam.")
@click.option("--kind", type=click.Choice(KINDS), help="Candidates of one kind only.")
@click.option("--mode", type=click.IntRange(min=1), metavar="N", help="Mode of the required N. Default: the last.")
@click.option("--within", metavar="E", default="1%", show_default=True, help="Acceptance: largest error of a mode.")
@click.option(
    "--theory", type=click.Choice(THEORIES), help="Of the beam. Default: that of the list; rayleigh in space."
)
@click.option("--drive", metavar="HZ", help="FILE is a record of a steady vibration at it; 'scene': that of the drive.")
@click.option("--at", "places", multiple=True, metavar="X", help="Place of each signal of a steady record: 0.3m.")
@click.option("--corrected", metavar="OUT", help="Write the chain of an .xml, .sdf or .urdf with correct stiffnesses.")
@click.option("--engine", metavar="NAME[:INTEGRATOR]", default="", help="That a chain runs in. Default: its file's.")
@click.option("--step", "time_step", metavar="TIME", help="Its time step, such as 1ms. Default: that of its file.")
@shared.output_options
def compare(
    scene: str,
    words: tuple[str, ...],
    overrides: tuple[str, ...],
    count: int | None,
    shapes: str | None,
    model: str | None,
    unit: str | None,
    kind: str | None,
    mode: int | None,
    within: str,
    theory: str | None,
    drive: str | None,
    places: tuple[str, ...],
    corrected: str | None,
    engine: str,
    time_step: str | None,
    **formats: Any,
) -> None:
    """Identify the discretisation behind natural frequencies of SCENE's beam, and their errors.

    FILE is a list of frequencies or a solver's output (.csv, .txt, .tsv, .dat, .f06, or - for standard input), measured
    modes (.uff, .unv), or a mesh with mode shapes. Exit status 1 where the list has a fault or an error is too large.

    FILE may be a record of free vibration: a table with a time column, then signals.

    FILE may be a chain of rigid bodies, with or without SCENE: .xml (MJCF), .sdf, .urdf (see docs/engines.md), and a
    record of its run may follow: `verify compare my.xml ring.csv`.

    Example: `verify compare steel-cantilever 27.6 172.6 482.6 944.7 1559.7 --within 1%`
    """
    _refuse_data([scene, *words])
    if any(Path(word).suffix.lower() in shared.CHAINS for word in (scene, *words)):
        from verify.commands.chain import judge_chain  # and the engines

        step = None if time_step is None else typed(time_step, shared.Seconds, "step")
        options: dict[str, Any] = {"modes": mode or 3, "theory": theory, "engine": engine, "step": step}
        options |= {"corrected": Path(corrected) if corrected else None}
        return judge_chain([scene, *words], overrides, within, formats, options)
    if drive is not None:
        return _steady(scene, words, overrides, drive, places, within, formats)
    if places:
        raise click.UsageError("--at is of a steady record with --drive.")
    if engine or time_step:
        raise click.UsageError("--engine and --step are of a chain in an .xml, .sdf or .urdf.")
    if bool(words) == bool(model):
        raise click.UsageError("Give either FILE or FREQUENCIES, or --model.")
    limit = typed(within, Relative, "within")
    if not (isinstance(limit, float | int) and limit > 0.0):
        raise InputError(f"within = {within!r}: give a relative error such as 1% or 0.01")
    loaded = load_beam(scene, overrides)
    forms = None if shapes is None else read_shapes(Path(shapes), loaded.beam.length)
    frequencies = None if exists(words[0] if words else "") else read_words(words, unit)  # of any length: no error
    if model is not None:
        frequencies = solve_model(model, loaded.beam, count, mode)
    elif frequencies is None and len(words) > 1:
        raise InputError(f"frequencies = {' '.join(words)}: give one file, or numbers alone")
    with shared.progress(quiet=True in formats.values(), lines=count is None) as step:
        options = {"unit": unit, "count": count, "kind": kind, "mode": mode, "theory": theory}
        words_or_file = frequencies or Path(words[0])
        result = compare_frequencies(loaded, words_or_file, shapes=forms, within=limit, progress=step, **options)
    shared.show(result, **formats)


def _refuse_data(words: list[str]) -> None:
    """Raise InputError for files that `verify chain` writes and this command does not read."""
    for name in (word for word in words if word.lower().endswith((".json", ".py"))):
        remedy = "compare the .xml, .sdf or .urdf of this chain, by `verify chain ... --to FILE`"
        if name.lower().endswith(".py"):
            remedy = "run it and compare the frequencies that it prints, or the .xml, .sdf or .urdf of this chain"
        elif not Path(name).is_file() or '"links"' not in read_text(Path(name), "file"):
            continue  # a list of frequencies
        raise InputError(f"{name}: chains are read from .xml (MJCF), .sdf and .urdf: {remedy}")


def _steady(
    scene: str,
    words: tuple[str, ...],
    overrides: tuple[str, ...],
    drive: str,
    places: tuple[str, ...],
    within: str,
    formats: dict[str, Any],
) -> None:
    """Print a record of a steady vibration beside the exact field of the drive; exit status 1 where it is off."""
    from verify.answers.steady import compare_steady  # and scenes with a drive
    from verify.scene.load import load_scene

    if len(words) != 1:
        raise click.UsageError("Give one record to --drive.")
    hz = None if drive == "scene" else typed(drive, shared.Hertz, "drive")
    at = [typed(x, shared.Metres, "at") for x in places]
    limit = typed(within, Relative, "within")
    result = compare_steady(load_scene(scene, overrides, {"drive"}), Path(words[0]), hz, at, limit)
    shared.show(result, **formats)
