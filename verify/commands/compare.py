"""The command `verify compare`: somebody's own model under the same gates."""

from pathlib import Path
from typing import TYPE_CHECKING

import click

from verify.commands.shared import (
    GATE_FAILED,
    as_line,
    json_alone,
    load_first,
    overridden,
    print_json,
    scene_first,
    whole_number,
)

if TYPE_CHECKING:
    from verify.identify.told import Compared
    from verify.scenes.scene import Scene


@click.command()
@click.argument("words", nargs=-1, metavar="SCENE [FREQUENCIES]")
@click.option("--scene", help="Whose beam the model is of, where it is not named first.")
@overridden
@click.option("--count", metavar="N", help="Segments or elements of the model. Default: whichever fits.")
@click.option("--modes", metavar="FILE", help="Mode shapes: x in the first column, then one column for each mode.")
@click.option("--model", metavar="MODULE:CLASS", help="A model in Python in place of a list.")
@click.option(
    "--unit",
    type=click.Choice(["Hz", "kHz", "rad/s"], case_sensitive=False),
    metavar="[Hz|kHz|rad/s]",
    help="Of the list. Default: its head's, else Hz.",
)
@click.option("--kind", type=click.Choice(["segments", "elements"]), help="What you built, if it is to be no guess.")
@click.option("--error", default="0.1%", show_default=True, metavar="E", help="For which the parts are counted.")
@click.option("--mode", metavar="N", help="At which. Default: the last of the list.")
@click.option("--within", metavar="E", help="Gate every error against the exact beam: 1%.")
@click.option("--theory", default="euler-bernoulli", show_default=True, help="Of the exact beam.")
@click.option("--reports", "folder", metavar="PATH", help="Folder for an HTML report. Default: none is written.")
@json_alone
def compare(
    words: tuple[str, ...],
    scene: str | None,
    overrides: tuple[str, ...],
    count: str | None,
    modes: str | None,
    model: str | None,
    unit: str | None,
    kind: str | None,
    error: str,
    mode: str | None,
    within: str | None,
    theory: str,
    folder: str | None,
    as_json: bool,
) -> None:
    """Say what somebody's model of SCENE's beam is, from its natural FREQUENCIES, and judge it.

    FREQUENCIES is a text file, or - for standard input: comma, semicolon, tab or spaces, with a head or without, a
    column of mode numbers or none. Exit 1 where the list has to be mended, nothing known fits it, or an error
    lies beyond --within.
    """
    from verify.identify.compare import Asked
    from verify.identify.compare import compare as compared
    from verify.report.plain import accuracy, mode_number

    if len(words) == 1 and scene is None and modes is None and model is None:
        raise click.UsageError(f"SCENE and FREQUENCIES are asked for, {words[0]!r} is one of them.")
    named, rest = scene_first(words, scene, 1, default=None)
    loaded = load_first(words, scene, named, overrides, "verify compare SCENE FREQUENCIES")
    asked = Asked(
        frequencies=Path(rest[0]) if rest else None,
        shapes=None if modes is None else Path(modes),
        model=model,
        count=whole_number("count", count),
        unit=unit,
        kind=kind,
        mode=None if mode is None else mode_number(mode),
        error=accuracy(error),
        within=None if within is None else accuracy(within, "within"),
        theory=theory,
    )
    result = compared(loaded, asked)
    report = _report(loaded, result, folder) if folder is not None else None
    _show(result, report, as_json=as_json)
    if not result.passed:
        raise SystemExit(GATE_FAILED)


def _report(scene: "Scene", result: "Compared", folder: str) -> Path:
    """Write the page. Raises InputError."""
    import sys

    from verify.files import writable_folder
    from verify.report.html import write_comparison

    path = writable_folder(Path(folder), "reports") / f"compare-{scene.name}.html"
    write_comparison(scene, result, path, as_line(["verify", *sys.argv[1:]]))
    return path


def _show(result: "Compared", report: Path | None, *, as_json: bool) -> None:
    if as_json:
        print_json(result.plain() | {"report": str(report) if report else None})
        return
    from verify.report.terminal import print_compared

    print_compared(result, report)
