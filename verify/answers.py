"""The questions of the command line as functions: how many parts, whose frequencies, which joints, how far trusted."""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np

from verify.analysis.margins import beam_margins
from verify.analysis.sizing import choose as choose_sizes
from verify.analysis.solution_cache import SolutionCache
from verify.analysis.variants import Rules, not_default
from verify.analysis.verdict import Margin, Verdict, verdict_of
from verify.arrays import Array
from verify.blas import one_blas_thread
from verify.compare.compare import Options
from verify.compare.compare import compare as compare_list
from verify.compare.reading import UNITS, FrequencyList, ModeShapes, listed, read_frequencies
from verify.convert import convert
from verify.engines.description import MOST_LINKS, RigidChain, describe
from verify.engines.writers import data, table, write
from verify.errors import InputError
from verify.linear.base import BeamModel
from verify.problem.beam import Beam
from verify.report.result import Column, Result, Table
from verify.scene.file import NamedBeam, load_beam
from verify.settings import DEFAULT, THEORIES, wall_label
from verify.validation import check_choice, check_integer, check_number, check_type

COMPARED = "gregory", "half", "full", "rigid"
"""Rules at a clamped end that are compared."""
KINDS = "segments", "elements"
"""Kinds of candidates."""
TEXT = {"", ".csv", ".txt", ".tsv", ".dat", ".f06", ".asc"}
"""Suffixes of lists of frequencies, in addition to those that are of no mesh."""


@one_blas_thread()
def choose(
    beam: Beam | NamedBeam | str | Path, mode: int | range, error: float, rules: Rules | Mapping[str, Any] | None = None
) -> Result:
    """Smallest number of segments and of elements from which on the frequency error is at most `error`, and their time.

    `beam`: a beam, the name of a packaged scene, the path of one, or a phrase 'beam: 1 m x 40 x 8 mm steel'. `mode`:
    from 1, or all of a range. `error`: relative. `rules`: settings of the models, {"wall": ("half", "gregory")}.
    A row of the table, `tables[0].records()`, is a model. Raises InputError.
    """
    first_mode, last = (mode.start, mode.stop - 1) if isinstance(mode, range) else (mode, mode)
    if isinstance(mode, range) and (mode.step != 1 or not 0 < first_mode <= last):
        raise InputError(f"mode = {mode!r}: give one mode, or all of a range(1, 13), numbered from 1")
    check_integer("mode", last, 1)
    check_number("error", error, "relative, of a frequency", at_least=1e-12, below=1)
    cache, given = SolutionCache(_named(beam).beam), rules if isinstance(rules, Rules) else convert(rules or {}, Rules)
    choices, skipped = choose_sizes(cache, mode, error, given)
    first = choices[0].variant.settings
    sizes = [(choice.variant.model, choice.size.count) for choice in choices if choice.variant.settings == first]
    margins = beam_margins(cache, sizes, mode=last, settings=first)
    rows: list[tuple[object, ...]] = []
    for choice in choices:
        size, cost = choice.size, (choice.unknowns, choice.error, choice.expected_error, choice.run_time_s)
        lower = ", ".join(map(str, choice.lower))
        rows.append((choice.variant.title, size.count, size.mode, *cost, size.smaller, lower))
    columns = [Column("model"), Column("N"), Column("mode"), Column("unknowns")]
    columns += [Column("error", percent=True, format="+.3g"), Column("error law", percent=True, format="+.3g")]
    columns += [Column("solve time", "s", ".3g", prefix=True), Column("smaller N that also meets it")]
    notes = [f"{choice.variant.title}: {choice.size.known_by}" for choice in choices]
    notes += ["error law: expected error, see docs/theory.md"]
    which = f"{first_mode}-{last}" if last > first_mode else f"{last}"
    return Result(
        f"Smallest N from which on the frequency error of mode {which} is at most {100.0 * error:g} %.",
        [Table("Sufficient sizes", [*columns, Column("lower modes above the limit")], rows, notes)],
        warnings=[f"{name} is skipped: {why}" for name, why in skipped.items()],
        margins=margins,
    )


@one_blas_thread()
def compare_frequencies(
    beam: Beam | NamedBeam | str | Path,
    frequencies: Sequence[float] | Array | FrequencyList | str | Path,
    *,
    unit: str | None = None,
    shapes: ModeShapes | None = None,
    count: int | None = None,
    kind: str | None = None,
    mode: int | None = None,
    within: float = 0.01,
    theory: str = THEORIES[0],
    progress: Callable[[str], None] = lambda step: None,
) -> Result:
    """Identify the discretisation behind natural frequencies of a beam, and their errors against the exact beam.

    `beam`: as of `choose`. `frequencies`: (n,), Hz or in `unit` (rad/s, rad2/s2, s, ...), or a file of them: text, a
    solver's output, a mesh with mode shapes, measured modes. `shapes`: of the modes, (n, points). `count`: N of the
    model, None for any. `kind`: "segments" or "elements". `mode`: for the required N, None for the last. `within`:
    accepted relative error, and `data["passed"]` says whether it is kept. Raises InputError.
    """
    check_number("within", within, "relative, of a frequency", above=0)
    for field, value, choices in (("unit", unit, tuple(UNITS)), ("kind", kind, KINDS)):
        if value is not None:
            check_choice(field, value, choices)
    if shapes is not None:
        check_type("shapes", shapes, ModeShapes)
    named, options = _named(beam), Options(count=count, kind=kind, mode=mode, within=within, theory=theory)
    if isinstance(frequencies, str | Path):
        from verify.io.mode_files import is_mesh

        path, suffix = Path(frequencies), Path(frequencies).suffix.lower()
        if suffix not in TEXT and is_mesh(suffix):
            from verify.compare.shapes import compare_shapes, read_mesh

            return compare_shapes(named, read_mesh(path, named.beam.length), options)
        given = read_frequencies(path, unit)
    elif isinstance(frequencies, FrequencyList):
        given = frequencies
    else:
        values = convert(np.asarray(frequencies).tolist(), tuple[float, ...], "frequencies")
        given = listed("frequencies", values, unit=unit or "Hz", declared=unit is not None)
    return compare_list(named, given, shapes, options, progress)


@one_blas_thread()
def engine_chain(
    beam: Beam | NamedBeam | str | Path,
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

    `beam`: as of `choose`. `count`: number of links, None for the fewest within `error` at `mode`. `wall`: rule of the
    joints at a clamped end. `in_space`: both bending planes and torsion. `damping`: ratio of mode 1. `path`: file to
    write, .xml (MJCF), .sdf, .urdf, _exudyn.py, _pinocchio.py, .json, .csv. `data` has joints (N m/rad, N m s), links
    (m, kg, kg m^2) and frequencies (Hz). Raises InputError.
    """
    check_integer("mode", mode, 1, 100)
    check_number("error", error, "relative, of a frequency", at_least=1e-12, below=1)
    beam = _named(beam).beam
    if count is None:
        count = fewest(beam, mode, error, wall, in_space)
    chain = describe(beam, count, wall=wall, in_space=in_space, damping=damping)
    result = _chain_result(chain, mode)
    return result if path is None else replace(result, data=dict(result.data) | {"wrote": write(chain, Path(path))})


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
    text = f"{MOST_LINKS} links are not within it at mode {mode}, raise it or give count"
    raise InputError(f"error = {error!r}: {text}")


@one_blas_thread()
def verdict(model: BeamModel, *, mode: int | None = None, frequency_hz: float | None = None) -> Verdict:
    """How far a model of a beam can be trusted at a mode (from 1), or at a drive of a frequency, Hz: give one of them.

    The worst of discretisation, shear and rotary inertia, and bending across the width. `level` is "trusted",
    "conditional" or "not trusted", `headline` the sentence. Results have a `verdict` of their own. Raises InputError.
    """
    check_type("model", model, BeamModel)
    if (mode is None) == (frequency_hz is None):
        raise InputError("mode: give a mode or frequency_hz, one of the two")
    if frequency_hz is None:
        check_integer("mode", mode, 1)
    else:
        check_number("frequency_hz", frequency_hz, "hertz", above=0)
    settings = not_default({name: getattr(model, name) for name in model.settings()})
    sizes = [(model.name, model.count)]
    return verdict_of(
        beam_margins(SolutionCache(model.beam), sizes, mode=mode, frequency_hz=frequency_hz, settings=settings)
    )


def _named(beam: Beam | NamedBeam | str | Path) -> NamedBeam:
    """A beam with a name. Raises InputError."""
    if isinstance(beam, str | Path):
        return load_beam(beam)
    check_type("beam", beam, Beam, NamedBeam)
    return NamedBeam(name="beam", beam=beam) if isinstance(beam, Beam) else beam


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
