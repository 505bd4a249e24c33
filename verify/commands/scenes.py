"""The scenes that there are, and a new one."""

from pathlib import Path

import click

from verify.commands.shared import (
    json_alone,
    print_json,
)
from verify.errors import InputError


@click.command()
@json_alone
def scenes(as_json: bool) -> None:
    """List the packaged scenes."""
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
@click.option("--force", is_flag=True, help="Replace a file that is there.")
@json_alone
def init(path: str, force: bool, as_json: bool) -> None:
    """Write a commented scene to PATH to start from."""
    from verify.files import exists, write_whole
    from verify.scenes.scene import STARTER

    if path.startswith("--"):
        raise InputError(f"path = {path!r} looks like an option: write it as './{path}'")
    if exists(Path(path), "path") and not force:
        raise InputError(f"path = {path!r} exists: name another file, or replace it with --force")
    write_whole(Path(path), STARTER.read_text("utf-8"), "path")
    if as_json:
        print_json({"path": path, "next": ["verify", "run", path]})
    else:
        click.echo(f"wrote {path}; next: verify run {path}")
