"""`verify chain`: the joints of a chain of rigid bodies in plain units, and its file for another engine."""

from dataclasses import replace
from pathlib import Path
from typing import Any

import click

from verify.answers.chains import engine_chain
from verify.answers.curves import curve_chain
from verify.answers.ringing import with_run
from verify.commands.choose import relative_error
from verify.commands.shared import CHAINS, BeamCommand, Seconds, format_options, overrides_option, scene_argument, show
from verify.engines.damping import EXAMPLES
from verify.engines.judgement import judge_file
from verify.errors import InputError, printable
from verify.report.result import Table
from verify.scene.file import load_beam
from verify.settings import DEFAULT, WALLS
from verify.validation import typed

RECORDS = ".csv", ".txt", ".tsv", ".dat", ".asc"
"""Suffixes of records of a run."""
FIRST = 4
"""Joints that the terminal always shows."""
RULES = ", ".join(name for name, rule in WALLS.items() if not rule.first)


@click.command(cls=BeamCommand)
@scene_argument
@overrides_option
@click.option("--count", type=int, metavar="N", help="Links. Default: the fewest within --error, or a curve's points.")
@click.option("--mode", type=click.IntRange(1, 100), default=3, show_default=True, metavar="N", help="Highest mode.")
@click.option("--error", default="1%", show_default=True, metavar="E", help="Largest relative frequency error.")
@click.option(
    "--wall",
    default=DEFAULT.wall,
    show_default=True,
    metavar="RULE",
    help=f"Joints at a straight clamped end: {RULES}",
)
@click.option("--space", "in_space", is_flag=True, help="Both bending planes and torsion.")
@click.option("--section", default="", metavar="PHRASE", help="Of a curve: 'round 2 mm E=1GPa rho=1.2g/cm3'.")
@click.option("--damping", default="0", metavar="Z", help=f"Damping ratio by dashpots, of mode 1, or {EXAMPLES[4:]}.")
@click.option("--engine", metavar="NAME[:INTEGRATOR]", default="", help="MuJoCo, Exudyn:RK44. Default: that of --to.")
@click.option("--step", "time_step", metavar="TIME", help="Choose links, integrator, armature by which it runs: 2ms.")
@click.option("--to", "path", metavar="FILE", help=".xml (MJCF), .sdf, .urdf, _exudyn.py, _pinocchio.py, .json, .csv.")
@format_options
def chain(
    scene: str,
    overrides: tuple[str, ...],
    count: int | None,
    mode: int,
    error: str,
    wall: str,
    in_space: bool,
    section: str,
    damping: str,
    engine: str,
    time_step: str | None,
    path: str | None,
    **formats: Any,
) -> None:
    """Joints and links of SCENE as rigid bodies for MuJoCo, Gazebo, Drake, Exudyn, Pinocchio.

    Stiffnesses in N m/rad, dashpots, masses, inertias, and the frequency errors of exactly this chain.
    Example: `verify chain --beam "1 m x 40 x 8 mm steel, clamped-free" --count 20 --to beam.xml`, or with
    `--step 1ms --engine MuJoCo --damping "1% at 2" --mode 1` for a time step and a damping ratio.

    SCENE may be a curve, curve.csv: points in columns x, y and z, with EI, EI2, GJ, rho_A or a section in columns, one
    value for all by --set EI=0.02, or --section (see docs/engines.md). It is clamped at the first point, free at the
    last. Without --count its links run from point to point, with --step they are the fewest that run.
    """
    brief, step = not any(formats.values()), None if time_step is None else typed(time_step, Seconds, "step")
    shared: dict[str, Any] = {"mode": mode, "error": relative_error(error), "in_space": in_space}
    shared |= {"damping": damping, "engine": engine, "path": path, "step": step}
    if scene.lower().endswith(".csv"):
        if wall != DEFAULT.wall:
            raise InputError("--wall is of a straight beam, leave it out: a curve has the best that its links allow")
        result = curve_chain(scene, count, section=section, overrides=overrides, **shared)
    elif section:
        raise InputError("--section is of a curve, curve.csv, leave it out")
    else:
        result = engine_chain(load_beam(scene, overrides), count, wall=wall, **shared)
    if brief:
        result = replace(result, tables=[_shortened(result.tables[0]), *result.tables[1:]])
    show(result, **formats)
    if wrote := result.data.get("wrote"):
        click.echo(printable(wrote), err=not brief)


def judge_chain(
    words: list[str], overrides: tuple[str, ...], within: str, formats: dict[str, Any], options: dict[str, Any]
) -> None:
    """Print what `verify compare [SCENE] FILE [RECORD]` finds in a chain of rigid bodies and in a record of its run.

    `options`: as of `judge_file`. Exit status 1 where it fails.
    """
    files = [Path(word) for word in words if Path(word).suffix.lower() in CHAINS]
    records = [Path(word) for word in words if Path(word).suffix.lower() in RECORDS]
    others = [word for word in words if Path(word) not in (*files, *records)]
    if len(files) > 1 or len(others) > 1 or len(records) > 1:
        raise InputError(f"{' '.join(words)}: give one file, with one scene or none, one record or none")
    beam = load_beam(others[0], overrides).beam if others else None
    result = judge_file(files[0], beam, within=relative_error(within), **options)
    if records:
        result = with_run(result, records[0], relative_error(within))
    if not any(formats.values()):
        tables = [_shortened(one) if one.title.startswith("Joints") else one for one in result.tables]
        result = replace(result, tables=tables)
    show(result, **formats)


def _shortened(table: Table) -> Table:
    """The first rows and the last, and a row with what those in between have in common."""
    rows = [(str(row[0]), *row[1:]) for row in table.rows]
    inner = list(zip(*rows[FIRST:-1], strict=True))[1:]
    different = [{f"{v:.9g}" if isinstance(v, float) else v for v in values} for values in inner]
    alike = [values[0] if len(each) == 1 else None for values, each in zip(inner, different, strict=True)]
    between = [(f"{FIRST} to {len(rows) - 2}", *alike)] if len(rows) > FIRST + 2 else rows[FIRST:-1]
    return replace(table, rows=[*rows[:FIRST], *between, *rows[-1:]] if len(rows) > FIRST else rows)
