"""The scenes that there are, and a new one."""

from pathlib import Path

import click

from verify.commands.shared import json_alone, load, overridden, print_json, scene_name
from verify.errors import InputError, printable


@click.command()
@json_alone
def scenes(as_json: bool) -> None:
    """List the packaged scenes. Example: `verify scenes --json`."""
    from verify.scenes.scene import load_scene, packaged_scenes

    found = [load_scene(name) for name in packaged_scenes()]
    if as_json:
        print_json([{"scene": s.name, "title": s.title, "gates": len(s.gate)} for s in found])
        return
    for one in found:
        click.secho(one.name, bold=True, nl=False)
        click.echo(f"  {one.title} ({len(one.gate)} gates)")


@click.command()
@click.argument("path")
@click.option("--from", "source", metavar="SCENE", help="Copy SCENE, its comments with it, under the name of PATH.")
@click.option("--force", is_flag=True, help="Replace a file that is there.")
@json_alone
def init(path: str, source: str | None, force: bool, as_json: bool) -> None:
    """Write a commented scene to PATH to start from.

    Example: `verify init mine.toml --from steel-cantilever`
    """
    from verify.files import exists, write_whole
    from verify.scenes.scene import STARTER, scene_path
    from verify.scenes.toml import read_text
    from verify.scenes.writing import name_of, renamed

    if path.startswith("--"):
        raise InputError(f"path = {path!r} looks like an option: write it as './{path}'")
    text = STARTER.read_text("utf-8") if source is None else renamed(read_text(scene_path(source)), name_of(Path(path)))
    if exists(Path(path), "path") and not force:
        raise InputError(f"path = {path!r} exists: name another file, or replace it with --force")
    write_whole(Path(path), text, "path")
    if as_json:
        print_json({"path": path, "next": ["verify", "run", path]})
    else:
        from shlex import quote

        click.echo(printable(f"wrote {path}; next: verify run {quote(path)}"))


@click.command()
@scene_name
@overridden
@json_alone
def show(scene: str, overrides: tuple[str, ...], as_json: bool) -> None:
    """Print the TOML of SCENE.

    As it is written or, with --set, as it is then read.

    Example: `verify show paper --set beam.length=0.4`
    """
    from verify.scenes.scene import scene_path, tables_of
    from verify.scenes.toml import read_text
    from verify.scenes.writing import toml_text

    load(scene, overrides)  # which refuses what is no scene
    if as_json:
        print_json(tables_of(scene, overrides))
    else:
        text = toml_text(tables_of(scene, overrides)) if overrides else read_text(scene_path(scene))
        click.echo(text, nl=not text.endswith("\n"))
