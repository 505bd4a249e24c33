"""`verify export`: files for other programs, pictures and movies."""

from functools import partial
from pathlib import Path

import click

from verify.answers.chains import fewest
from verify.commands.shared import CHAINS, BeamCommand, overrides_option, progress, scene_argument
from verify.engines.describe import describe
from verify.engines.writers import write as write_chain
from verify.errors import printable
from verify.io.export import Request, write
from verify.scene.file import load_beam
from verify.scene.load import load_scene
from verify.studies.base import STUDIES


@click.command(cls=BeamCommand)
@scene_argument
@overrides_option
@click.option("--what", metavar="WHAT", help="modes, wave, motion or convergence. Default: what the file type holds.")
@click.option("--to", "path", required=True, metavar="FILE", help="The suffix is the file type.")
@click.option("--model", default="segment", show_default=True, metavar="NAME", help="segment, fem or analytic.")
@click.option(
    "--count", type=click.IntRange(1), metavar="N", help="Segments or elements. Default: the scene's; within 1 %."
)
@click.option("--mode", type=click.IntRange(1), metavar="N", help="The mode of a picture, the number of modes of data.")
@click.option("--samples", type=click.IntRange(2), metavar="N", help="Instants of a period or of a motion.")
def export(
    scene: str,
    overrides: tuple[str, ...],
    what: str | None,
    path: str,
    model: str,
    count: int | None,
    mode: int | None,
    samples: int | None,
) -> None:
    """Write modes, the driven wave or the motion of SCENE to FILE.

    vtu and xdmf (a series) for ParaView; csv, json and npz for data; png, gif and webp for pictures. The chart of
    convergence is written as png or svg. A chain of rigid bodies: xml (MJCF), sdf, urdf, _exudyn.py, _pinocchio.py, in
    a plane; `verify chain` has its options.
    Example: `verify export paper --what modes --to modes.vtu`
    """
    if path.lower().endswith((*CHAINS, ".py")):
        beam = load_beam(scene, overrides).beam
        make = partial(describe, beam)
        described = make(count or fewest(make, len(beam.pieces), mode or 3, 0.01))
        return click.echo(printable(write_chain(described, Path(path))))
    study = "spectrum" if what == "modes" else what or ""
    parts = {study, *(STUDIES[study].reads or () if study in STUDIES else ())} if what else None
    request = Request(what=what, model=model, count=count, mode=mode, samples=samples)
    with progress() as step:
        summary = write(load_scene(scene, overrides, parts), Path(path), request, step)
    click.echo(printable(f"wrote {path}: {summary}"))
