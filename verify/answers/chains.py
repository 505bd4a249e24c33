"""The joints of a beam as a chain of rigid bodies."""

from dataclasses import replace
from pathlib import Path

from verify.analysis.margins import beam_margins
from verify.analysis.solution_cache import SolutionCache
from verify.analysis.verdict import Margin
from verify.answers.beams import AnyBeam, named
from verify.blas import one_blas_thread
from verify.engines.describe import describe
from verify.engines.description import MOST_LINKS, RigidChain
from verify.engines.writers import data, table, write
from verify.errors import InputError
from verify.problem.beam import Beam
from verify.report.result import Column, Result, Table
from verify.settings import DEFAULT, wall_label
from verify.validation import check_integer, check_number

COMPARED = "gregory", "half", "full", "rigid"
"""Rules at a clamped end that are compared."""


@one_blas_thread()
def engine_chain(
    beam: AnyBeam,
    count: int | None = None,
    *,
    mode: int = 3,
    error: float = 0.01,
    wall: str = DEFAULT.wall,
    in_space: bool = False,
    damping: float = 0.0,
    path: str | Path | None = None,
) -> Result:
    """Joints and links of a beam as a chain of rigid bodies, with the frequency errors of exactly this chain.

    `beam`: as of `choose`. `count`: number of links, None for the fewest within `error` at all modes up to `mode`.
    `wall`: rule of the joints at a clamped end. `in_space`: both bending planes and torsion. `damping`: ratio of mode
    1. `path`: file to write, .xml (MJCF), .sdf, .urdf, _exudyn.py, _pinocchio.py, .json, .csv. `data` has joints (N
    m/rad, N m s), links (m, kg, kg m^2) and frequencies (Hz). Raises InputError.
    """
    check_integer("mode", mode, 1, 100)
    check_number("error", error, "relative, of a frequency", at_least=1e-12, below=1)
    beam = named(beam).beam
    if count is None:
        count = fewest(beam, mode, error, wall, in_space)
    chain = describe(beam, count, wall=wall, in_space=in_space, damping=damping)
    result = _chain_result(chain, mode)
    return result if path is None else replace(result, data=dict(result.data) | {"wrote": write(chain, Path(path))})


def fewest(beam: Beam, mode: int, error: float, wall: str = DEFAULT.wall, in_space: bool = False) -> int:
    """The smallest number of links that is within the error at all modes up to one, and so is the next one tried."""
    count, first = max(len(beam.pieces), mode + 1, 2), 0
    while count <= MOST_LINKS:
        tried = describe(beam, count, wall=wall, in_space=in_space)
        errors = [tried.errors(axis, mode) for axis in tried.axes]
        worst = max(float(abs(one).max()) if len(one) >= mode else 1.0 for one in errors)
        if worst <= error and first:
            return first
        first = count if worst <= error else 0
        count += max(int(count * (min(worst / error, 2.4) ** 0.25 - 1.0)), 1)  # no chain is of a higher order than 4
    text = f"{MOST_LINKS} links are not within it at mode {mode}, raise it or give count"
    raise InputError(f"error = {error!r}: {text}")


def _chain_result(chain: RigidChain, mode: int) -> Result:
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
            raise InputError(f"count = {n}: the chain has {len(hertz)} modes in {axis}, raise it or lower mode")
        every = [[*other.errors(axis, mode).tolist(), *[None] * mode][:mode] for other in others.values()]
        exact = chain.exact_hz(axis, mode).tolist()
        rows += zip([axis] * mode, range(1, mode + 1), exact, hertz, errors, *every, strict=True)
        margins += [
            Margin(
                name=f"discretisation of {n} links in {axis}",
                size=abs(errors[-1]),
                where=f"at mode {mode}",
                remedy="give more links",
                condition=f"{n} links are enough in {axis}",
            )
        ]
    rule = f", {wall_label(chain.wall)}" if held else ""
    warnings = ["joint 0 is at the right end of the beam, which has the stronger support"] * chain.mirrored
    if chain.in_space and chain.beam.attached:
        warnings.append("attached masses have their rotary inertia about all axes, springs act in bending alone")
    tables = [table(chain), Table("Frequencies", columns, rows)]
    return Result(f"N = {n} rigid links{rule}.", tables, warnings=warnings, margins=margins, data=data(chain))
