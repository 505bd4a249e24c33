"""The work-precision benchmarks."""

from dataclasses import replace
from typing import Any

import click

from verify.commands.shared import BeamCommand, output_options, progress, show
from verify.errors import InputError
from verify.quantities.base import TABLES
from verify.scene.load import load_scene
from verify.validation import convert, typed


@click.command(cls=BeamCommand)
@click.argument("sets", nargs=-1, metavar="[SET]...")
@click.option("--scene", metavar="SCENE", help="Take beam, drive and slider from there. Default: the paper's.")
@click.option("--mode", type=click.IntRange(1), help="Mode of the sets modes and engines. Default: 22.")
@click.option("--sizes", metavar="LIST", help="Segments and elements. Default: 24,49,98,196,392.")
@click.option("--seconds", type=float, default=5.0, show_default=True, help="Time limit of a method and of the rounds.")
@output_options
def bench(
    sets: tuple[str, ...], scene: str | None, mode: int | None, sizes: str | None, seconds: float, **formats: Any
) -> None:
    """Measure run time over error of all methods: modes, field, transient, slider, ride, chain, engines.

    Times are processor seconds, medians of interleaved rounds. Example: `verify bench modes chain --sizes 49,98`
    """
    from verify.bench.methods import SETS, Problem, problem_of, questions  # which load scipy
    from verify.bench.work_precision import measure, result

    problem = problem_of(load_scene(scene, (), TABLES)) if scene else Problem()
    counts = convert(typed(sizes, tuple[int, ...], "--sizes"), tuple[int, ...], "--sizes") if sizes else problem.sizes
    problem = replace(problem, sizes=sorted(set(counts)), mode=mode or problem.mode)
    measured = []
    with progress(quiet=True in formats.values()) as step:
        for name in sets or SETS:
            step(name)
            try:
                measured += [(question, measure(question, seconds)) for question in questions([name], problem)]
            except InputError as error:
                if sets:
                    raise
                click.echo(f"verify: {error}", err=True)  # one of all sets, which this beam or machine does not have
    show(result(measured), **formats)
