"""The command `verify compare-shapes`: somebody's mode shapes on a mesh, judged."""

from pathlib import Path
from typing import TYPE_CHECKING

import click

from verify.commands.shared import (
    DEFAULT,
    GATE_FAILED,
    is_scene,
    json_alone,
    load_first,
    overridden,
    print_json,
    scene_first,
    whole_number,
)

if TYPE_CHECKING:
    from verify.identify.shapes_told import ShapesJudged


@click.command("compare-shapes")
@click.argument("words", nargs=-1, required=True, metavar="[SCENE] FILE")
@click.option("--scene", help=f"Whose beam the mesh is of, where it is not named first. Default: {DEFAULT}.")
@overridden
@click.option("--count", metavar="N", help="Segments or elements of the model. Default: what fits, else by the points.")
@click.option("--within", metavar="E", help="Gate every frequency against the exact beam: 1%.")
@json_alone
def compare_shapes(
    words: tuple[str, ...],
    scene: str | None,
    overrides: tuple[str, ...],
    count: str | None,
    within: str | None,
    as_json: bool,
) -> None:
    """Say which modes of SCENE's beam the shapes in a mesh FILE are, how far off, and whose model's they are nearest.

    FILE is any mesh that meshio reads, solid, shell or line, along an axis: vectors or numbers at its points are modes,
    field data named after Hz or rad/s their frequencies. Exit 1 where a shape is no mode's, or as `verify compare`.
    """
    from verify.exports.given_mesh import read_shapes_of_mesh
    from verify.identify.shapes import judge_shapes
    from verify.report.plain import accuracy

    parts, limit = whole_number("count", count), None if within is None else accuracy(within, "within")
    named, (file,) = scene_first(words, scene, 1)
    if len(words) == 1 and is_scene(file):
        raise click.UsageError(f"Missing argument 'FILE': {file!r} is a scene.")
    loaded = load_first(words, scene, named, overrides, "verify compare-shapes SCENE FILE")
    result = judge_shapes(loaded, read_shapes_of_mesh(Path(file), loaded.beam.length), parts, limit)
    _show(result, as_json=as_json)
    if not result.passed:
        raise SystemExit(GATE_FAILED)


def _show(result: "ShapesJudged", *, as_json: bool) -> None:
    if as_json:
        print_json(result.plain())
        return
    from verify.report.terminal import print_compared

    print_compared(result, None)
