"""`verify identify`: stiffness, clamp and damping of a strip from records of its free vibration."""

from shlex import quote
from typing import Any

import click

from verify.answers.strips import identify_records
from verify.commands.shared import BeamCommand, Metres, format_options, overrides_option, scene_argument, show
from verify.errors import printable
from verify.problem.phrase import PREFIX
from verify.scene.file import load_beam
from verify.validation import typed


@click.command(cls=BeamCommand)
@scene_argument
@click.argument("records", nargs=-1, required=True, metavar="RECORD...")
@overrides_option
@click.option("--length", "lengths", multiple=True, metavar="L", help="Free length of each record, such as 250mm.")
@click.option("--modes", type=click.IntRange(1, 8), metavar="N", help="Modes of every record. Default: above noise.")
@format_options
def identify(
    scene: str,
    records: tuple[str, ...],
    overrides: tuple[str, ...],
    lengths: tuple[str, ...],
    modes: int | None,
    **formats: Any,
) -> None:
    """Bending stiffness, compliance of the clamp and damping of SCENE's strip from RECORDs of its free vibration.

    A record is a table with a time column, then signals. Two free lengths separate the stiffness from the clamp. The
    last line is the command that makes the chain with these values.

    Example: `verify identify --beam "0.3 m x 25 x 1 mm steel, cantilever" long.csv short.csv --length 0.3 --length 0.2`
    """
    result = identify_records(
        load_beam(scene, overrides), records, [typed(x, Metres, "length") for x in lengths], modes
    )
    show(result, **formats)
    name = f"--beam {quote(scene.removeprefix(PREFIX))}" if scene.startswith(PREFIX) else quote(scene)
    fields, damping = (result.data["chain"][key] for key in ("set", "damping"))
    words = [name, *(f"--set {quote(field)}" for field in (*overrides, *fields)), f"--damping {quote(damping)}"]
    click.echo(printable(f"verify chain {' '.join(words)} --to strip.xml"), err=any(formats.values()))
