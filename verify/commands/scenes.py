"""`verify scenes`: list and show scenes, start a new one."""

from pathlib import Path

import click

from verify.commands.shared import BeamCommand, format_options, overrides_option, scene_argument, show
from verify.errors import InputError, printable


@click.group(invoke_without_command=True)
@format_options
@click.pass_context
def scenes(context: click.Context, /, **formats: bool) -> None:
    """List the packaged scenes; show one, or write a new one."""
    if context.invoked_subcommand is not None:
        return
    from verify.report.result import Column, Result, Table
    from verify.scene.load import load_scene, packaged_scenes

    found = [load_scene(name) for name in packaged_scenes()]
    rows = [(one.name, one.title, len(one.gate)) for one in found]
    show(Result(tables=[Table("", [Column("scene"), Column("title"), Column("gates")], rows)]), **formats)


@scenes.command("show")
@scene_argument
@overrides_option
def show_scene(scene: str, overrides: tuple[str, ...]) -> None:
    """Print the TOML of SCENE: the file itself or, with --set, the values that result.

    Example: `verify scenes show paper --set beam.length=0.4`
    """
    from verify.scene.load import load_scene, read_text, scene_path, tables_of, toml_text

    load_scene(scene, overrides)
    text = toml_text(tables_of(scene, overrides)) if overrides else read_text(scene_path(scene))
    click.echo(text, nl=not text.endswith("\n"))


@scenes.command(cls=BeamCommand)
@click.argument("path")
@click.option("--from", "scene", metavar="SCENE", help="Copy SCENE with its comments, under the name of PATH.")
@click.option("--force", is_flag=True, help="Replace an existing file.")
def init(path: str, scene: str | None, force: bool) -> None:
    """Write a commented scene to PATH: a starter, a copy of SCENE, or the starter with another beam and no gates.

    Example: `verify scenes init mine.toml --from steel-cantilever`
    """
    from shlex import quote

    from verify.files import exists, write_whole
    from verify.problem.phrase import PREFIX
    from verify.scene.load import STARTER, copy_with_name, name_of, read_text, scene_path, starter_with, tables_of

    text = read_text(STARTER)
    if scene is not None:
        source = starter_with(tables_of(scene)) if scene.startswith(PREFIX) else read_text(scene_path(scene))
        text = copy_with_name(source, name_of(Path(path)))
    if exists(Path(path), "path") and not force:
        raise InputError(f"path = {path!r} exists: name another file, or replace it with --force")
    write_whole(Path(path), text, "path")
    click.echo(printable(f"wrote {path}; next: verify run {quote(path)}"))
