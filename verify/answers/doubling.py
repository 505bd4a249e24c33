"""Sizes by doubling: links and elements for an error of the tip's path, parts or steps for an error of a case."""

from collections.abc import Callable, Iterable, Sequence
from contextlib import suppress
from functools import cache, partial
from math import inf
from pathlib import Path as FilePath
from time import process_time
from typing import Any, NamedTuple, TypeVar

from verify.analysis.solution_cache import SolutionCache
from verify.analysis.verdict import Margin, per_cent
from verify.answers.beams import AnyBeam
from verify.blas import one_blas_thread
from verify.cases.base import Case
from verify.errors import InputError
from verify.quantities.blade import Model, Path, TipPath, elements, told_path
from verify.report.result import Column, Result, Table
from verify.scene.load import load_scene
from verify.scene.model import Scene
from verify.studies.base import Progress
from verify.studies.large_motion import TITLES, LargeMotion, told
from verify.validation import check_number, convert

T = TypeVar("T")
MINUTE = 60.0  # expected time of a run, s, at which the doubling ends
SLOWER = 8.0
"""Largest time of a run over that of half its number: links take four times as many steps of twice the work, elements
the same by their tolerance."""
MOST = 100_000  # number that no case needs
FIRST: dict[Model, int] = {"segment": 4, "fem": 2}
TOLERANCE = 1e-4  # with these numbers: an error of per cents in time as in space
TIGHTER: dict[Model, float] = {"fem": 64.0, "segment": 4.0}
"""Tolerance over that of twice the number. The error in space falls by 16 and 4, that in time as the power 2/3 of the
tolerance of a step of order 2, and in proportion to that of explicit steps of order 5."""
LOOSER, LOOSEST = 4.0, 1e-3
"""Factor by which a tolerance grows while the error is met, and the largest: longer steps follow no motion."""
COARSE, STALLED = 3, 0.9
"""Runs with too few parts for an order; error over that of half the number, 1/4 at order 2, due to another cause."""
STALLS = "as are half as many, so that another cause limits it (links do not stretch): give a larger error"
LATE = "twice as many would take longer than a minute: give a larger error or a shorter motion"
PATHS = [
    "Error: largest distance of the tip from that of the reference, over the largest motion of the tip or 1 % of the "
    "length. N is doubled, with a tighter tolerance of a time step, until the error is met, then bisected at that "
    "tolerance, which is then loosened by factors of four. Run time: processor time of one run.",
    "Links do not stretch: where EA is known, the stretch is part of their error.",
]
CASE = ["N: links, elements, points or time steps. Error: the larger one of N and 2 N, which is run, too."]
COLUMNS = [Column("model"), Column("N"), Column("tolerance of a step", format=".2g")]
COLUMNS += [Column("error", percent=True, format=".2g"), Column("run time", "s", ".2g", prefix=True)]


class Tried(NamedTuple):
    """A run: error, time, s, number, tolerance of a time step over the length, and why there is none."""

    error: float
    seconds: float
    parts: int
    tolerance: float | None
    failure: str = ""


def choose_motion(
    scene: AnyBeam, error: float, overrides: Sequence[str] = (), progress: Progress = lambda step: None
) -> Result:
    """Numbers of links and elements, and time steps, for an error of the tip's path on a moving base, or of a case.

    `scene`: one with [base], its name or path, or the name of a case. `overrides` as of `load_scene`. Raises
    InputError.
    """
    check_number("error", error, "relative, of the path", at_least=1e-9, below=1)
    if isinstance(scene, str) and not overrides:
        from verify.cases.table import CASES

        if scene in CASES:
            return _of_cases(CASES[scene], list(CASES.values()), error)
    if isinstance(scene, str | FilePath):
        scene = load_scene(scene, overrides, {"base", LargeMotion.name})
    if not isinstance(scene, Scene) or scene.base is None:
        raise InputError("mode is missing: give the last mode, or a scene with [base], whose tip moves, or a case")
    return _of_base(scene, error, progress)


@one_blas_thread()
def _of_base(scene: Scene, error: float, progress: Progress) -> Result:
    study, pieces = scene.studies.get(LargeMotion.name, LargeMotion()), len(scene.beam.pieces)
    study.check(scene)
    elements(scene.beam, pieces, study.axial_stiffness)  # raises for what neither model has
    solutions, first = SolutionCache(scene.beam), {model: max(number, pieces) for model, number in FIRST.items()}

    @cache
    def run(model: Model, count: int, tolerance: float, samples: int = study.samples) -> tuple[float, TipPath | str]:
        progress(what := f"{count} {TITLES[model]}, tolerance {tolerance:.2g}")
        options: dict[str, Any] = {"model": model, "count": count, "tolerance": tolerance, "samples": samples}
        options |= {"axial_stiffness": study.axial_stiffness}
        return _timed(lambda: told_path(scene, solutions, convert(options, Path), partial(told, progress, what)))

    def off(one: tuple[float, TipPath | str], other: tuple[float, TipPath | str]) -> float:
        return inf if isinstance(one[1], str) or isinstance(other[1], str) else one[1].distance(other[1])

    for model, number in first.items():
        run(model, number, TOLERANCE, 8)  # compiles and imports
    count, tolerance = first["fem"], TOLERANCE
    before: tuple[float, TipPath | str] = 0.0, ""
    finest = run("fem", count, tolerance)
    while (between := off(before, finest)) > error:
        if isinstance(finest[1], str) and count > 2**COARSE:
            raise InputError(finest[1])
        if SLOWER * finest[0] > MINUTE:
            raise InputError(f"error = {error!r}: {count} elements move the tip by {per_cent(between)}, {LATE}")
        count, tolerance = 2 * count, tolerance / TIGHTER["fem"]
        before, finest = finest, run("fem", count, tolerance)
    found = dict[str, Tried]()
    for model, number in first.items():

        def attempt(parts: int, step: float, model: Model = model) -> Tried:
            ran = run(model, parts, step)
            return Tried(off(ran, finest), ran[0], parts, step, ran[1] if isinstance(ran[1], str) else "")

        found[TITLES[model]] = _smallest(attempt, error, number, pieces, TIGHTER[model])
    reference = (f"reference: {TITLES['fem']}", count, tolerance, None, finest[0])
    return _answer(f"path of the tip is off by at most {100.0 * error:g} %.", error, found, [reference], PATHS)


def _timed(job: Callable[[], T]) -> tuple[float, T | str]:
    """(processor time, s; result, or the sentence of its InputError, such as that of too few parts)."""
    began = process_time()
    try:
        result: T | str = job()
    except InputError as problem:
        result = str(problem)
    return process_time() - began, result


def _smallest(
    run: Callable[[int, float], Tried], error: float, first: int, fewest: int, tighter: float, slower: float = SLOWER
) -> Tried:
    """The smallest number, from `fewest` on, and its loosest tolerance, within the error; else the best of the runs."""
    tolerance, found = TOLERANCE, run(first, TOLERANCE)
    runs = [found]
    while found.error > error:
        stalls = len(runs) > COARSE and found.error > STALLED * runs[-2].error
        if stalls or slower * found.seconds > MINUTE or found.parts > MOST:
            best, why = min(runs), STALLS if stalls else LATE
            return best._replace(failure=f"{best.failure or f'{best.parts} are off by {per_cent(best.error)}'}, {why}")
        tolerance /= tighter
        runs.append(found := run(2 * found.parts, tolerance))
    low = fewest - 1
    while found.parts - low > 1:
        tried = run((low + found.parts) // 2, tolerance)
        low, found = (low, tried) if tried.error <= error else (tried.parts, found)
    while (tolerance := LOOSER * tolerance) <= LOOSEST and (tried := run(found.parts, tolerance)).error <= error:
        found = tried
    return found


def _answer(
    what: str, error: float, found: dict[str, Tried], more: Iterable[Sequence[object]], notes: Sequence[str]
) -> Result:
    """Sizes by title, with a sentence on an error that is not met."""
    rows = [(name, one.parts, one.tolerance, one.error, one.seconds) for name, one in found.items()]
    margins = [
        Margin(name=f"{name}, N = {one.parts}", size=one.error, harm="discretisation") for name, one in found.items()
    ]
    return Result(
        f"Smallest N tried whose {what}",
        [Table("Sufficient sizes", COLUMNS, [*rows, *more], notes)],
        warnings=[f"{name}: {one.failure}" for name, one in found.items() if one.error > error],
        margins=margins,
    )


def _of_cases(case: Case, every: Sequence[Case], error: float) -> Result:
    """Sizes of the models of a case: the cases of its file whose exact values differ by at most 0.1 %."""
    scale, found = abs(case.exact) or 1.0, dict[str, Tried]()
    if not case.sized:
        raise InputError(f"scene = {case.name!r}: the size of this case is fixed, choose another or one with [base]")
    if error * scale < case.uncertainty:
        raise InputError(f"error = {error!r}: the exact value is known to {case.uncertainty / scale:.1g}, give more")
    for one in every:
        if one.run.__module__ != case.run.__module__ or abs(one.exact - case.exact) > 1e-3 * scale:
            continue
        with suppress(InputError):
            one.value(FIRST["segment"])  # compiles and imports
        run = cache(lambda count, one=one: _timed(lambda: one.error(count)))

        def attempt(parts: int, step: float, run: Callable[[int], tuple[float, float | str]] = run) -> Tried:
            # twice as many, since an error that changes its sign is small once
            (seconds, size), (_, double) = run(parts), run(2 * parts)
            if isinstance(size, str) or isinstance(double, str):
                return Tried(inf, seconds, parts, None, str(size))
            return Tried(max(abs(size), abs(double)), seconds, parts, None)

        found[one.name] = _smallest(attempt, error, FIRST["segment"], 1, 1.0, SLOWER**2)
    return _answer(f"figure of case {case.name} is off by at most {100.0 * error:g} %.", error, found, [], CASE)
