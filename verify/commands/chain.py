"""`verify chain`: the joints of a chain of rigid bodies in plain units, and its file for another engine."""

from dataclasses import replace
from pathlib import Path
from typing import Any

import click

from verify.analysis.margins import beam_margins
from verify.analysis.solution_cache import SolutionCache
from verify.analysis.verdict import Margin
from verify.commands.choose import relative_error
from verify.commands.shared import (
    CHAINS,
    GATE_FAILED,
    BeamCommand,
    format_options,
    overrides_option,
    scene_argument,
    show,
)
from verify.convert import typed
from verify.engines.describe import describe
from verify.engines.description import MOST_LINKS, RigidChain
from verify.engines.judgement import judge_file
from verify.engines.writers import data, table, write
from verify.errors import InputError, printable
from verify.problem.beam import Beam
from verify.report.result import Column, Result, Table
from verify.scene.file import load_beam
from verify.settings import DEFAULT, WALLS, wall_label
from verify.validation import Relative

FIRST = 4
"""Joints that the terminal always shows."""
COMPARED = "gregory", "half", "full", "rigid"
"""Rules at a clamped end that are compared."""
RULES = ", ".join(name for name, rule in WALLS.items() if not rule.first)


@click.command(cls=BeamCommand)
@scene_argument
@overrides_option
@click.option("--count", type=int, metavar="N", help="Links. Default: the fewest within --error at --mode.")
@click.option("--mode", type=click.IntRange(1, 100), default=3, show_default=True, metavar="N", help="Highest mode.")
@click.option("--error", default="1%", show_default=True, metavar="E", help="Largest relative frequency error.")
@click.option(
    "--wall", default=DEFAULT.wall, show_default=True, metavar="RULE", help=f"Joints at a clamped end: {RULES}."
)
@click.option("--space", "in_space", is_flag=True, help="Both bending planes and torsion.")
@click.option("--damping", default="0", metavar="Z", help="Damping ratio of mode 1 by dashpots at the joints: 1%.")
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
    damping: str,
    path: str | None,
    **formats: Any,
) -> None:
    """Joints and links of SCENE as rigid bodies for MuJoCo, Gazebo, Drake, Exudyn, Pinocchio.

    Stiffnesses in N m/rad, dashpots, masses, inertias, and the frequency errors of exactly this chain.
    Example: `verify chain --beam "1 m x 40 x 8 mm steel, clamped-free" --count 20 --to beam.xml`
    """
    ratio, beam = typed(damping, Relative, "damping"), load_beam(scene, overrides).beam
    if count is None:
        count = fewest(beam, mode, relative_error(error), wall, in_space)
    described, brief = describe(beam, count, wall=wall, in_space=in_space, damping=ratio), not any(formats.values())
    result = _result(described, mode, brief=brief)
    wrote = write(described, Path(path)) if path else ""
    show(result, **formats)
    if wrote:
        click.echo(printable(wrote), err=not brief)


def judge_chain(
    words: list[str],
    overrides: tuple[str, ...],
    modes: int,
    within: str,
    theory: str | None,
    corrected: str | None,
    formats: dict[str, Any],
    run: dict[str, Any],
) -> None:
    """Print what `verify compare [SCENE] FILE` finds in a chain of rigid bodies; exit status 1 where it fails."""
    files = [Path(word) for word in words if Path(word).suffix.lower() in CHAINS]
    others = [word for word in words if Path(word) not in files]
    if len(files) > 1 or len(others) > 1:
        raise InputError(f"{' '.join(words)}: give one file, with one scene or none")
    beam = load_beam(others[0], overrides).beam if others else None
    out = Path(corrected) if corrected else None
    result = judge_file(files[0], beam, modes, relative_error(within), theory, out, **run)
    if not any(formats.values()):
        result = replace(
            result, tables=[_shortened(one) if one.title.startswith("Joints") else one for one in result.tables]
        )
    show(result, **formats)
    if not result.data["passed"]:
        raise SystemExit(GATE_FAILED)


def fewest(beam: Beam, mode: int, error: float, wall: str = DEFAULT.wall, in_space: bool = False) -> int:
    """The smallest number of links that is within the error at a mode, and so is the next one tried."""
    count, first = max(len(beam.pieces), mode + 1, 2), 0
    while count <= MOST_LINKS:
        tried = describe(beam, count, wall=wall, in_space=in_space)
        errors = [tried.errors(axis, mode) for axis in tried.axes]
        worst = max(abs(error_by_mode[-1]) if len(error_by_mode) >= mode else 1.0 for error_by_mode in errors)
        if worst <= error and first:
            return first
        first = count if worst <= error else 0
        count += max(int(count * (min(worst / error, 2.4) ** 0.25 - 1.0)), 1)  # no chain is of a higher order than 4
    text = f"{MOST_LINKS} links are not within it at mode {mode}, raise it or give --count"
    raise InputError(f"error = {error!r}: {text}")


def _result(chain: RigidChain, mode: int, *, brief: bool) -> Result:
    """Verdict, joints and links, and frequencies next to those of the other rules at a clamped end."""
    held, n = "clamped" in chain.beam.supports, chain.count
    walls = [name for name in COMPARED if held and name != chain.wall]
    others = {f"wall {wall}": describe(chain.beam, n, wall=wall, in_space=chain.in_space) for wall in walls}
    columns = [Column("axis"), Column("mode"), Column("exact", "Hz", ".7g"), Column("this chain", "Hz", ".7g")]
    columns += [Column(name, format="+.3g", percent=True) for name in ("error", *others)]
    rows, margins = list[tuple[object, ...]](), beam_margins(SolutionCache(chain.beam), (), mode=mode)
    for axis in chain.axes:
        hertz, errors = chain.frequencies_hz(axis, mode).tolist(), chain.errors(axis, mode).tolist()
        if len(hertz) < mode:
            raise InputError(f"count = {n}: the chain has {len(hertz)} modes in {axis}, raise it or lower --mode")
        every = [[*other.errors(axis, mode).tolist(), *[None] * mode][:mode] for other in others.values()]
        exact = chain.exact_hz(axis, mode).tolist()
        rows += zip([axis] * mode, range(1, mode + 1), exact, hertz, errors, *every, strict=True)
        name = f"discretisation of {n} links in {axis}"
        margins += [
            Margin(
                name=name,
                size=abs(errors[-1]),
                where=f"at mode {mode}",
                remedy="give more links",
                condition=f"{n} links are enough in {axis}",
            )
        ]
    rule = f", {wall_label(chain.wall)}" if held else ""
    warnings = ["joint 0 is at the right end of the beam, which has the stronger support"] * chain.mirrored
    if chain.in_space and (chain.beam.mass or chain.springs):
        warnings.append("attached masses have their rotary inertia about all axes, springs act in bending alone")
    tables = [_shortened(table(chain)) if brief else table(chain), Table("Frequencies", columns, rows)]
    return Result(f"N = {n} rigid links{rule}.", tables, warnings=warnings, margins=margins, data=data(chain))


def _shortened(table: Table) -> Table:
    """The first rows and the last, and a row with what those in between have in common."""
    rows = [(str(row[0]), *row[1:]) for row in table.rows]
    inner = list(zip(*rows[FIRST:-1], strict=True))[1:]
    alike = [
        values[0] if len({f"{v:.9g}" if isinstance(v, float) else v for v in values}) == 1 else None for values in inner
    ]
    between = [(f"{FIRST} to {len(rows) - 2}", *alike)] if len(rows) > FIRST + 2 else rows[FIRST:-1]
    return replace(table, rows=[*rows[:FIRST], *between, *rows[-1:]] if len(rows) > FIRST else rows)
