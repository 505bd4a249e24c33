"""One sheet for each case: its problem, its references and what is held to them."""

from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from verify.commands.shared import GATE_FAILED, json_alone, load, print_json, progress
from verify.errors import InputError, printable

if TYPE_CHECKING:
    from collections.abc import Callable

    from verify.report.sheets import Sheet
    from verify.run.gates import GateResult
    from verify.scenes.scene import Scene


@click.command()
@click.argument("scenes", nargs=-1, metavar="[SCENE]...")
@click.option("--to", "folder", metavar="FOLDER", help="Write a file for each, and an index.")
@click.option("--run", "judged", is_flag=True, help="Judge the gates; exit 1 where one fails.")
@json_alone
def catalogue(scenes: tuple[str, ...], folder: str | None, judged: bool, as_json: bool) -> None:
    """A sheet of every SCENE, or of all packaged ones, in Markdown.

    Problem, inputs, models, and for every gate its band, its reference with that one's own uncertainty and source, and
    why. Nothing is solved without --run.

    Example: `verify catalogue paper --run`
    """
    from verify.report.sheets import index, markdown
    from verify.scenes.scene import packaged_scenes, tables_of

    given = [(load(name, ()), tables_of(name)) for name in scenes or packaged_scenes()]
    _check_names([scene.name for scene, _ in given])
    target = None if folder is None else _writable(folder)
    sheets = _sheets(given, judged, quiet=as_json)
    texts = {f"{sheet.scene}.md": markdown(sheet) for sheet in sheets}
    if target is not None:
        _write(target, texts | {"index.md": index(sheets)})
    if as_json:
        import msgspec

        print_json(msgspec.to_builtins(sheets))
    elif target is not None:
        click.echo(printable(f"wrote {len(texts)} sheet{'s' * (len(texts) != 1)} and index.md into {target}"))
    else:
        click.echo("\n".join(_harmless(text) for text in texts.values()), nl=False)
    if any(one.passed is False for sheet in sheets for one in sheet.figures):
        raise SystemExit(GATE_FAILED)


def _harmless(text: str) -> str:
    """A text of several lines with nothing in it that a terminal would obey."""
    return "\n".join(map(printable, text.split("\n")))


def _check_names(names: list[str]) -> None:
    """Raise InputError for two scenes of one name: their sheets would be one file."""
    for name in names:
        if names.count(name) > 1:
            raise InputError(f"scene = {name!r} stands twice: give every scene a name of its own, and each once")
        if name == "index":
            raise InputError("scene = 'index' has the name of the page before all sheets: give it another name")


def _writable(folder: str) -> Path:
    from verify.files import writable_folder

    return writable_folder(Path(folder), "--to")


def _write(folder: Path, texts: dict[str, str]) -> None:
    from verify.files import write_whole

    for name, text in texts.items():
        write_whole(folder / name, text, "--to")


def _sheets(given: "list[tuple[Scene, dict[str, Any]]]", judged: bool, *, quiet: bool) -> "list[Sheet]":
    """With verdicts where they are asked for: gates alone, no study."""
    from verify.report.sheets import sheet_of

    if not judged:
        return [sheet_of(scene, tables) for scene, tables in given]
    with progress(sum(len(scene.gate) for scene, _ in given), quiet=quiet) as step:
        return [sheet_of(scene, tables, _verdicts(scene, step)) for scene, tables in given]


def _verdicts(scene: "Scene", step: "Callable[[str], None]") -> "list[GateResult]":
    from verify.run.gates import judge
    from verify.run.runner import workbench_for

    bench, results = workbench_for(scene, gates_only=True), []
    for gate in scene.gate:
        step(f"{scene.name}: gate {gate.id}")
        results.append(judge(gate, scene, bench))
    return results
