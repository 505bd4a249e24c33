"""`verify plan`: which parts of a scene run."""

from typing import Any

import click

from verify.analysis.plausibility import unit_margins
from verify.commands.shared import format_options, overrides_option, scene_argument, show
from verify.report.result import Column, Result, Table
from verify.scene.load import load_scene
from verify.scene.run import plan as plan_scene
from verify.scene.run import scene_warnings


@click.command()
@scene_argument
@overrides_option
@format_options
def plan(scene: str, overrides: tuple[str, ...], **formats: Any) -> None:
    """Show which gates and studies of SCENE run, which are skipped, and why. Nothing is solved.

    Example: `verify plan paper --set beam.length=0.4`
    """
    loaded = load_scene(scene, overrides)
    rows = [(row.what, row.kind, row.runs, row.why) for row in plan_scene(loaded, overrides)]
    table = Table("", [Column("what"), Column("kind"), Column("runs"), Column("quantity, or why skipped")], rows)
    skipped = sum(not row[2] for row in rows)
    summary = f"{len(rows) - skipped} parts run, {skipped} are skipped."
    show(Result(summary, [table], warnings=scene_warnings(loaded), margins=unit_margins(loaded.beam)), **formats)
