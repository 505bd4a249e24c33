"""From how many parts on an accuracy is kept."""

import click

from verify.commands.shared import (
    json_alone,
    load,
    overridden,
    print_json,
    ruled,
)


@click.command()
@click.option("--mode", required=True, metavar="N", help="Mode number from 1, or all of several: 1-12.")
@click.option("--error", required=True, metavar="E", help="Largest frequency error: 1% or 0.01.")
@click.option("--scene", default="paper", show_default=True, help="Whose beam.")
@overridden
@ruled
@json_alone
def choose(mode: str, error: str, scene: str, overrides: tuple[str, ...], as_json: bool, rules: dict[str, str]) -> None:
    """From how many segments or elements on an accuracy is kept, as far as it was solved, and what they cost.

    Example: `verify choose --mode 5 --error 0.1% --scene steel-cantilever`
    """
    from verify.judge.workbench import Workbench
    from verify.report.plain import accuracy, choice_as_plain, mode_numbers

    wanted, number = accuracy(error), mode_numbers(mode)
    beam = load(scene, overrides).beam
    from verify.judge.sizing import choose_of_all
    from verify.run.tables import rules_of

    bench, asked = Workbench(beam), rules_of(rules)
    choices, left_out = choose_of_all(bench, number, wanted, asked)
    if as_json:
        print_json(choice_as_plain(bench, number, wanted, choices, left_out))
    else:
        from verify.report.terminal import print_choices

        print_choices(bench, number, wanted, choices, left_out)
