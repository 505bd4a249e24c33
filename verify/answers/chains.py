"""The joints of a beam as a chain of rigid bodies."""

from collections.abc import Callable
from contextlib import suppress
from dataclasses import replace
from functools import partial
from math import inf, isfinite
from pathlib import Path
from typing import Any

from verify.analysis.margins import beam_margins
from verify.analysis.solution_cache import SolutionCache
from verify.analysis.verdict import FINE, Margin, per_cent
from verify.answers.beams import AnyBeam, named
from verify.blas import one_blas_thread
from verify.engines.choice import Candidate, choose, default_steps, largest_mode, trade
from verify.engines.curved import CurvedChain
from verify.engines.damping import Asked, asked, damped
from verify.engines.describe import describe
from verify.engines.description import MOST_LINKS, RigidChain, Steps
from verify.engines.integrators import integrator_of
from verify.engines.running import chain_runs
from verify.engines.writers import data, table, write
from verify.errors import InputError
from verify.formatting import with_unit
from verify.report.result import Column, Result, Table
from verify.settings import DEFAULT, wall_label
from verify.validation import check_integer, check_number, check_type

COMPARED = "gregory", "half", "full", "rigid"
"""Rules at a clamped end that are compared."""
AUTOMATIC = {"MuJoCo": ("implicitfast", "discrete")}
"""Integrators that are tried in turn where none is named; of other engines the first in `INTEGRATORS`."""
MJCF = ".xml", ".mjcf"
"""Ends of files for MuJoCo, which has drag and armature."""
MOST_TRIED = 30
"""Links beyond the fewest, one more at a time, among which those for a step are sought."""


@one_blas_thread()
def engine_chain(
    beam: AnyBeam,
    count: int | None = None,
    *,
    mode: int = 3,
    error: float = 0.01,
    wall: str = DEFAULT.wall,
    in_space: bool = False,
    damping: float | str = 0.0,
    step: float | None = None,
    engine: str = "",
    path: str | Path | None = None,
) -> Result:
    """Joints and links of a beam as a chain of rigid bodies, with the frequency errors of exactly this chain.

    `beam`: as of `choose`. `count`: number of links, None for the fewest within `error` up to `mode`. `wall`: rule of
    the joints at a clamped end. `in_space`: both bending planes and torsion. `damping`: ratio of mode 1, or a request
    in words (`engines.damping.asked`). `step`, s, of `engine` "NAME" or "NAME:INTEGRATOR": chooses links, integrator,
    armature by which the chain runs, with all errors up to `mode`, of the damping ratio too, within `error`. Without
    it, the file of an engine has a step of `engines.choice.default_steps`. `path`: file to write, .xml (MJCF), .sdf,
    .urdf, _exudyn.py, _pinocchio.py, .json, .csv. `data` has joints (N m/rad, N m s), links (m, kg, kg m^2) and
    frequencies (Hz). Raises InputError, also where no chain runs at the step.
    """
    beam = named(beam).beam
    make = partial(describe, beam, wall=wall, in_space=in_space)
    wanted: dict[str, Any] = {"mode": mode, "error": error, "damping": damping, "step": step, "engine": engine}
    return made_chain(make, len(beam.pieces), count, path=path, **wanted)


def made_chain(
    make: Callable[[int], RigidChain],
    least: int,
    count: int | None,
    *,
    mode: int,
    error: float,
    damping: float | str,
    step: float | None,
    engine: str,
    path: str | Path | None,
) -> Result:
    """The result of `engine_chain` of chains that `make` makes by their number of links, `least` or more."""
    check_integer("mode", mode, 1, 100)
    check_number("error", error, "relative, of a frequency", at_least=1e-12, below=1)
    check_type("engine", engine, str)
    check_type("path", path or "", str, Path)
    request, end = asked(damping), str(path or ".xml").lower()
    engine = engine or "MuJoCo" * (end.endswith(MJCF) and path is not None)
    highest = max(mode, 1 if request.in_hz else int(max(request.at)))
    if step is None:
        count = count or fewest(make, least, highest, error)
        steps = steps_of(engine, inf, bool(request.ratios[0]))[0] if engine else None
        chain = damped(make(count), request, steps, drag=end.endswith(MJCF))
        result = chain_result(chain := default_steps(chain, steps, mode, error) if steps else chain, mode, error)
    else:
        check_number("step", step, "s", above=0)
        if not engine:
            raise InputError("engine is missing: a step is of an engine, such as MuJoCo or Exudyn:RK44")
        plain = [make(n) for n in ([count] if count else _counts(make, least, highest, error))]
        chosen, rows = _for_step(plain, request, steps_of(engine, step, True), mode, error, end)
        result, chain = chain_result(chosen.chain, mode, error), chosen.chain
        links, weights = ("", "the fewest that run ")[len(plain) > 1], ("without", "with the least")[chosen.beta > 0.0]
        why = f"{links}within {per_cent(error)} up to mode {mode}, {weights} armature."
        table = _trade_table(rows, chosen, mode, error)
        result = replace(result, tables=[*result.tables, table], summary=f"{result.summary[:-1]}, {why}")
    return result if path is None else replace(result, data=dict(result.data) | {"wrote": write(chain, Path(path))})


def _counts(make: Callable[[int], RigidChain], least: int, mode: int, error: float) -> list[int]:
    """Numbers of links from one below the fewest up to those that leave a quarter of the error, of order 4."""
    found = fewest(make, least, mode, error)
    most = min(int(4.0**0.25 * found) + 2, found + MOST_TRIED)
    return [*range(max(found - 1, least, mode + 1, 2), most + 1)]


def steps_of(engine: str, step: float, damped: bool) -> list[Steps]:
    """The integrators of `engine` 'NAME' or 'NAME:INTEGRATOR' that are tried in turn. Raises InputError."""
    name, _, setting = engine.partition(":")
    row = integrator_of(name, setting)
    settings = (row.setting,) if setting else AUTOMATIC.get(row.engine, (row.setting,))
    if not setting and row.engine == "MuJoCo" and step == inf and not damped:
        settings = ("RK4",)  # the largest limit without dashpots
    return [Steps(step, row.engine, one) for one in settings]


def _for_step(
    plain: list[RigidChain], request: Asked, integrators: list[Steps], mode: int, error: float, end: str
) -> tuple[Candidate, list[Candidate]]:
    """(the candidate that is chosen, all of them) of chains without dashpots for a file that ends in `end`.

    Raises InputError with what would run.
    """
    rows, remedies, largest = list[Candidate](), list[str](), (0.0, "")
    for steps in integrators:
        chains = [damped(one, request, steps, drag=end.endswith(MJCF)) for one in plain]
        found = trade(chains, steps, modes=mode, armatures=end.endswith((*MJCF, ".json", ".csv")))
        rows += found
        if chosen := choose(found, mode, error):
            return chosen, rows
        fine = [one.chain for one in found if len(one.space) >= mode and abs(one.space[mode - 1]) <= 0.5 * error]
        for one in fine[:1]:
            with suppress(InputError):
                begun = default_steps(one, steps, mode, error).steps
                largest = max(largest, (begun.step if begun else 0.0, steps.integrator))
        if len(request.ratios) == 1 and request.ratios[0] and not (request.in_hz or request.compensated):
            with suppress(InputError):
                other = [damped(one, request._replace(compensated=True), steps) for one in plain]
                good = choose(trade(other, steps, modes=mode), mode, error)
                remedies += ["compensated dashpots, damping '... compensated'"] * bool(good)
    remedies += [f"a step of {with_unit(largest[0], 's')} in {largest[1]}"] * bool(largest[0])
    remedies += ["hinges in one plane"] * (plain[0].in_space and plain[0].straight)
    if number := largest_mode(rows, error):
        remedies.insert(0, f"mode {number}")
    text = _diverges(rows[0], rows[-1], integrators, mode, error)
    raise InputError(f"{text}: give {' or '.join(remedies or ['more links'])}")


def _diverges(first: Candidate, last: Candidate, integrators: list[Steps], mode: int, error: float) -> str:
    """Why no chain of a range, from its first and its last one, runs within the error."""
    step, named = integrators[0].step, ", ".join(f"{one.engine} {one.integrator}" for one in integrators)
    span = " to ".join(str(n) for n in dict.fromkeys((first.chain.count, last.chain.count)))
    text = f"step = {with_unit(step, 's', '.6g')}: in {named} no chain of {span} links runs within {per_cent(error)} "
    text += f"up to mode {mode}"
    if not first.stable:
        text += f", {first.chain.count} links {'diverge' if step > first.limit else 'nearly diverge'} "
        text += f"(omega_max h = {first.omega_max * step:.3g}, limit {first.omega_max * first.limit:.3g})"
    if last.stable and len(last.space) >= mode:
        errors = f"frequency {100.0 * last.error[-1]:+.2g} %, damping {100.0 * last.numerical[-1]:+.2g} % off"
        text += f", {last.chain.count} in {last.chain.steps.integrator if last.chain.steps else ''} have {errors}"
    return text


def _trade_table(rows: list[Candidate], chosen: Candidate, mode: int, error: float) -> Table:
    """Numbers of links next to the chosen one, with what space and time cost at a mode."""
    columns = [Column("links"), Column("integrator"), Column("armature, h² k", format=".3g")]
    columns += [Column("step limit", "s", ".3g", prefix=True)]
    columns += [Column(name, format="+.2g", percent=True) for name in ("space", "time", "error", "damping added")]
    columns += [Column("it")]
    each = list[tuple[object, ...]]()
    for one in (row for row in rows if abs(row.chain.count - chosen.chain.count) <= 2 and len(row.space) >= mode):
        assert one.chain.steps
        fate = "diverges" if one.chain.steps.step > one.limit else "nearly diverges"
        fate = f"is beyond {per_cent(error)}" if one.stable else fate
        fate = "is chosen" if one is chosen else "runs" if one.worst[mode - 1] <= error else fate
        figures = (float(values[mode - 1]) for values in (one.space, one.time, one.error, one.numerical))
        limit = one.limit if isfinite(one.limit) else None
        shown = [value if isfinite(value) and one.stable else None for value in figures]
        each.append((one.chain.count, one.chain.steps.integrator, one.beta or None, limit, *shown, fate))
    axis = chosen.chain.motions[0]
    note = f"Errors of frequency and damping ratio at mode {mode} in {axis}; small vibration about rest."
    return Table("Links for the step", columns, each, [note])


def fewest(make: Callable[[int], RigidChain], least: int, mode: int, error: float) -> int:
    """The smallest number of links, `least` or more, within the error at all modes up to one, and so the next tried."""
    count, first = max(least, mode + 1, 2), 0
    while count <= MOST_LINKS:
        tried = make(count)
        errors = [tried.errors(axis, mode) for axis in tried.motions]
        worst = max(float(abs(one).max()) if len(one) >= mode else 1.0 for one in errors)
        if worst <= error and first:
            return first
        first = count if worst <= error else 0
        count += max(int(count * (min(worst / error, 2.4) ** 0.25 - 1.0)), 1)  # no chain is of a higher order than 4
    text = f"{MOST_LINKS} links are not within it at mode {mode}, raise it or give count"
    raise InputError(f"error = {error!r}: {text}")


def chain_result(chain: RigidChain, mode: int, error: float) -> Result:
    """Verdict, joints and links, and frequencies next to those of the other rules at a clamped end."""
    held, n = "clamped" in chain.beam.supports, chain.count
    walls = [name for name in COMPARED if held and chain.straight and name != chain.wall]
    others = {f"wall {wall}": describe(chain.beam, n, wall=wall, in_space=chain.in_space) for wall in walls}
    if isinstance(chain, CurvedChain) and chain.rod.bent:
        others["mass on chords"] = chain.on_chords
    columns = [Column("axis"), Column("mode"), Column("exact", "Hz", ".7g"), Column("this chain", "Hz", ".7g")]
    columns += [Column(name, format="+.3g", percent=True) for name in ("error", *others)]
    rows = list[tuple[object, ...]]()
    margins = [*beam_margins(SolutionCache(chain.beam), (), mode=mode)] if chain.straight else []
    for axis in chain.motions:
        hertz, errors = chain.frequencies_hz(axis, mode).tolist(), chain.errors(axis, mode).tolist()
        if len(hertz) < mode:
            raise InputError(f"count = {n}: the chain has {len(hertz)} modes in {axis}, raise it or lower mode")
        every = [[*other.errors(axis, mode).tolist(), *[None] * mode][:mode] for other in others.values()]
        exact = chain.exact_hz(axis, mode).tolist()
        rows += zip([axis] * mode, range(1, mode + 1), exact, hertz, errors, *every, strict=True)
        size, worst = max((abs(one), f"at mode {i}") for i, one in enumerate(errors, start=1))
        name, enough = f"discretisation of {n} links in {axis}", f"{n} links are enough in {axis}"
        margins.append(Margin(name=name, size=size, where=worst, remedy="give more links", condition=enough))
    rule = f", {wall_label(chain.wall)}" if held else ""
    rule += f", for {with_unit(chain.steps.step, 's')} in {' '.join(chain.steps[1:])}" if chain.steps else ""
    warnings = ["joint 0 is at the right end of the beam, which has the stronger support"] * chain.mirrored
    if chain.in_space and chain.beam.attached:
        warnings.append("attached masses have their rotary inertia about all axes, springs act in bending alone")
    notes = ["Exact is the rod, estimated by links in 2 and 4 parts, of long chains in 1 and 2."] * (not chain.straight)
    tables = [table(chain), Table("Frequencies", columns, rows, notes)]
    if chain.steps:
        ran, margin, texts = chain_runs(chain, chain.steps, mode, max(error, FINE))
        tables, margins, warnings = [*tables, ran], [*margins, margin], [*warnings, *texts]
    else:
        warnings += chain.remarks
    return Result(f"N = {n} rigid {chain.parts}{rule}.", tables, warnings=warnings, margins=margins, data=data(chain))
