"""How many segments or elements are enough."""

from collections.abc import Mapping
from typing import Any

from verify.analysis.margins import beam_margins
from verify.analysis.sizing import choose as choose_sizes
from verify.analysis.solution_cache import SolutionCache
from verify.analysis.variants import Rules
from verify.answers.beams import AnyBeam, named
from verify.blas import one_blas_thread
from verify.errors import InputError
from verify.report.result import Column, Result, Table
from verify.validation import check_integer, check_number, convert


@one_blas_thread()
def choose(
    beam: AnyBeam, mode: int | range | None = None, error: float = 0.01, rules: Rules | Mapping[str, Any] | None = None
) -> Result:
    """Smallest numbers of segments and elements from which on the errors of modes are at most `error`, and their time.

    `beam`: a beam, the name of a packaged scene, the path of one, or a phrase 'beam: 1 m x 40 x 8 mm steel'. `mode`:
    all modes up to it, numbered from 1, or those of a range. `error`: relative. `rules`: settings of the models,
    {"wall": ("half", "gregory")}. A row of the table, `tables[0].records()`, is a model. Raises InputError.

    Without `mode` the error is that of the tip's path, of rigid links and nonlinear elements in the motion of a scene
    with [base], or that of the case of known answer of this name; runs last up to a minute each.
    """
    if mode is None:
        from verify.answers.doubling import choose_motion

        if rules:
            raise InputError("rules: they are those of frequencies, give mode or leave them out")
        return choose_motion(beam, error)
    if not isinstance(mode, range):
        check_integer("mode", mode, 1)
        mode = range(1, mode + 1)
    first_mode, last = mode.start, mode.stop - 1
    if mode.step != 1 or not 0 < first_mode <= last:
        raise InputError(f"mode = {mode!r}: give the last mode, or all of a range(5, 13), numbered from 1")
    check_number("error", error, "relative, of a frequency", at_least=1e-12, below=1)
    cache, given = SolutionCache(named(beam).beam), rules if isinstance(rules, Rules) else convert(rules or {}, Rules)
    choices, skipped = choose_sizes(cache, mode, error, given)
    first = choices[0].variant.settings
    sizes = [(choice.variant.model, choice.size.count) for choice in choices if choice.variant.settings == first]
    margins = beam_margins(cache, sizes, mode=last, settings=first)
    rows: list[tuple[object, ...]] = []
    for choice in choices:
        size, cost = choice.size, (choice.unknowns, choice.error, choice.expected_error, choice.run_time_s)
        rows.append((choice.variant.title, size.count, size.mode, *cost, size.smaller))
    columns = [Column("model"), Column("N"), Column("worst mode"), Column("unknowns")]
    columns += [Column("error", percent=True, format="+.3g"), Column("error law", percent=True, format="+.3g")]
    columns += [Column("solve time", "s", ".3g", prefix=True), Column("smaller N that also meets it")]
    notes = [f"{choice.variant.title}: {choice.size.known_by}" for choice in choices]
    notes += ["error law: expected error, see docs/theory.md"]
    which = f"every mode from {first_mode} to {last}" if last > first_mode else f"mode {last}"
    return Result(
        f"Smallest N from which on the frequency error of {which} is at most {100.0 * error:g} %.",
        [Table("Sufficient sizes", columns, rows, notes)],
        warnings=[f"{name} is skipped: {why}" for name, why in skipped.items()],
        margins=margins,
    )
