"""`verify scenes`: list and show scenes, start a new one."""

from pathlib import Path
from shlex import quote
from typing import Any

import click

from verify.commands.shared import BeamCommand, format_options, overrides_option, scene_argument, show
from verify.errors import InputError, printable
from verify.files import exists, read_text, write_whole
from verify.problem.phrase import PREFIX
from verify.report.result import Column, Result, Table
from verify.scene import file as files


@click.group(invoke_without_command=True)
@format_options
@click.pass_context
def scenes(context: click.Context, /, **formats: Any) -> None:
    """List the packaged scenes; show one, or write a new one."""
    if context.invoked_subcommand is not None:
        return
    every = map(files.read_tables, files.packaged_scenes())
    rows = [(tables["name"], tables.get("title", ""), len(tables.get("gate", ()))) for tables in every]
    show(Result(tables=[Table("", [Column("scene"), Column("title"), Column("gates")], rows)]), **formats)


@scenes.command("show")
@scene_argument
@overrides_option
def show_scene(scene: str, overrides: tuple[str, ...]) -> None:
    """Print the TOML of SCENE: the file itself or, with --set, the values that result.

    Example: `verify scenes show paper --set beam.length=0.4`
    """
    from verify.scene.load import scene_from, tables_of  # the quantities and studies, which a list does without

    tables = tables_of(scene, overrides)
    scene_from(tables)
    text = files.toml_text(tables) if overrides else read_text(files.scene_path(scene), "scene")
    click.echo(text, nl=not text.endswith("\n"))


@scenes.command(cls=BeamCommand)
@click.argument("path")
@click.option("--from", "scene", metavar="SCENE", help="Copy SCENE with its comments, under the name of PATH.")
@click.option("--force", is_flag=True, help="Replace an existing file.")
def init(path: str, scene: str | None, force: bool) -> None:
    """Write a commented scene to PATH: a starter, a copy of SCENE, or the starter with another beam and no gates.

    Example: `verify scenes init mine.toml --from steel-cantilever`
    """
    text = read_text(files.STARTER, "scene")
    if scene is not None:
        if scene.startswith(PREFIX):
            text = files.starter_with(files.read_tables(scene))
        else:
            text = read_text(files.scene_path(scene), "scene")
        text = files.copy_with_name(text, files.name_of(Path(path)))
    if exists(Path(path), "path") and not force:
        raise InputError(f"path = {path!r} exists: name another file, or replace it with --force")
    write_whole(Path(path), text, "path")
    click.echo(printable(f"wrote {path}; next: verify run {quote(path)}"))
