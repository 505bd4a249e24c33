"""From how many parts on an accuracy is kept."""

import click

from verify.commands.shared import (
    DEFAULT,
    json_alone,
    load,
    overridden,
    print_json,
    ruled,
    scene_first,
)


@click.command()
@click.argument("words", nargs=-1, metavar="[SCENE]")
@click.option("--mode", required=True, metavar="N", help="Mode number from 1, or all of several: 1-12.")
@click.option("--error", required=True, metavar="E", help="Largest frequency error: 1% or 0.01.")
@click.option("--scene", help=f"Whose beam, where it is not named first. Default: {DEFAULT}.")
@overridden
@ruled
@json_alone
def choose(
    words: tuple[str, ...],
    mode: str,
    error: str,
    scene: str | None,
    overrides: tuple[str, ...],
    as_json: bool,
    rules: dict[str, str],
) -> None:
    """From how many segments or elements on an accuracy is kept, as far as it was solved, and what they cost.

    Example: `verify choose steel-cantilever --mode 5 --error 0.1%`
    """
    from verify.judge.workbench import Workbench
    from verify.report.plain import accuracy, choice_as_plain, mode_numbers

    wanted, number = accuracy(error), mode_numbers(mode)
    beam = load(scene_first(words, scene, 0)[0], overrides).beam
    from verify.judge.sizing import choose_of_all
    from verify.run.tables import rules_of

    bench, asked = Workbench(beam), rules_of(rules)
    choices, left_out = choose_of_all(bench, number, wanted, asked)
    if as_json:
        print_json(choice_as_plain(bench, number, wanted, choices, left_out))
    else:
        from verify.report.terminal import print_choices

        print_choices(bench, number, wanted, choices, left_out)
