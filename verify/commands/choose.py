"""`verify choose`: the smallest sufficient number of segments and elements."""

from typing import Any

import click

from verify.analysis.variants import Rules
from verify.answers.sizes import choose as choose_sizes
from verify.commands.shared import BeamCommand, format_options, overrides_option, progress, scene_argument, show
from verify.errors import InputError
from verify.scene.file import load_beam
from verify.validation import Relative, convert, literal, typed


@click.command(cls=BeamCommand)
@scene_argument
@click.argument("rules", nargs=-1, metavar="[RULE=VALUE]...")
@click.option("--mode", metavar="N", help="All modes up to N, or those of a range: 5-12, 7-7.")
@click.option(
    "--error", required=True, metavar="E", help="Largest relative error of frequency, or of path: 1% or 0.01."
)
@overrides_option
@format_options
def choose(
    scene: str, rules: tuple[str, ...], mode: str | None, error: str, overrides: tuple[str, ...], **formats: Any
) -> None:
    """Smallest number of segments and elements for a given accuracy, and the solve time.

    RULE=VALUE sets up the models: wall=half,gregory joints=printed theory=timoshenko grading=2 attachment=lever.
    Example: `verify choose steel-cantilever --mode 5 --error 0.1%`

    Without --mode the error is that of the tip's path, of links and nonlinear elements on the [base] of the scene, or
    that of a case of known answer: `verify choose rotating-blade --error 1%`, `verify choose elastica-elements`.
    """
    pairs = [rule.partition("=") for rule in rules]
    for key, equals, _ in pairs:
        if not equals:
            raise InputError(f"rule = {key!r}: write it as RULE=VALUE, wall=half")
    chosen = convert({key: literal(text, key) for key, _, text in pairs}, Rules)
    largest = relative_error(error)
    if mode:
        show(choose_sizes(load_beam(scene, overrides), _modes(mode), largest, chosen), **formats)
        return
    from verify.answers.doubling import choose_motion

    if rules:
        raise InputError(f"rule = {rules[0]!r}: it is for frequencies, give --mode or leave it out")
    with progress(quiet=True in formats.values()) as step:
        result = choose_motion(scene, largest, overrides, step)
    show(result, **formats)


def _modes(text: str) -> range:
    """The modes of '12', from 1 on, or of '5-12'. Raises InputError."""
    modes = typed(text, tuple[int, ...], "mode")
    if not all(isinstance(mode, int) and mode > 0 for mode in modes) or modes != [*range(modes[0], modes[-1] + 1)]:
        raise InputError(f"mode = {text!r}: give the last mode, or all of a range as 5-12, numbered from 1")
    return range(1 if len(modes) == 1 and "-" not in text else modes[0], modes[-1] + 1)


def relative_error(text: str) -> float:
    """A relative error. A plain number of 0.1 or more is refused: most who write it mean per cent."""
    value = typed(text, Relative, "error")
    if not isinstance(value, float | int) or not 1e-12 <= value < (1.0 if text.endswith("%") else 0.1):
        raise InputError(f"error = {text!r}: give a relative error from 1e-12, below 0.1 or with a per cent sign: 1%")
    return value
