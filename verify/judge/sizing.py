"""How many segments or elements an accuracy takes: from which size on it is kept, and how that is known."""

from collections.abc import Callable
from math import ceil
from typing import TYPE_CHECKING, TypeAlias

import msgspec

from verify.errors import InputError
from verify.exact.error_laws import (
    LAWS,
    certain_from,
    expected_error,
    has_law,
    law_of,
    sine_fits,
    smallest_count,
)
from verify.judge.cache import Settings, SolutionCache
from verify.judge.known import by_law, kept, largest_error, solved, unbuilt, worst_of
from verify.judge.several import count_guess, demanding
from verify.judge.variants import Rules, Variant, falls_within, shared_from, without_effect
from verify.models.catalogue import MODELS, discrete
from verify.patience import check_work
from verify.timing import interleaved_medians

if TYPE_CHECKING:
    from verify.beam import Beam

_LARGEST_COUNT = 200_000
_LARGEST_UNKNOWN = 2000
"""Of a model without an error law, and of errors that go up and down: nobody says beforehand whether they get there."""
_EVERY, _CLOSELY = 100, 2000
"""Sizes are gone through one by one up to the first, 5 % apart up to the second, then doubled."""
_LOWER_BRANCH = 0.05
"""Above the lower branch Hermite elements are at least 7.9 % off: smaller errors are found on it."""
_WALK = (40, 100_000, 100)
"""Sizes one by one after the last that fails: the second number over it, no fewer than the first, no more than the
third, and never beyond its double."""
_PER_PART, _PER_MODE, _LADEN = 1e-4, 1.5e-6, 7.0
"""Seconds of a solve for each part, and for each part and mode, the latter so many times for what steps alone do not
have: on a slow core 10 to 200 us for a part with 3 to 90 modes of a stepped beam, 40 to 1200 with bodies."""
_LOWER = 100
"""Modes up to which those below are looked at."""

Reached = Callable[[int], bool]
Modes: TypeAlias = int | range
"""One mode, or all of several, numbered from 1."""


class Enough(msgspec.Struct, frozen=True, kw_only=True):
    """From which size on an accuracy is kept."""

    count: int
    """At this size, and at larger ones as far as `known_by` says, the error is within what was asked."""
    mode: int
    """The mode that asks for so many: the one that was asked for, or of several the worst with one part less."""
    smaller: int | None = None
    """The smallest size below it that happens to do, though one between does not; None where none was found."""
    known_by: str
    """Which larger sizes do, and how it is known."""
    work_s: float = 0.0
    """Seconds that sizes gone through take on a slow core, as told beforehand."""


class Choice(msgspec.Struct, frozen=True, kw_only=True):
    """The parts of one model from which on an accuracy is kept, and what they cost."""

    model: str
    settings: Settings = ()
    """Other than the model's defaults: (("wall", "half"),) is the literature's wall."""
    count: int
    """From here on enough."""
    mode: int
    """The mode that asks for so many."""
    lower: tuple[int, ...]
    """Modes below the one asked for whose error at `count` is beyond what was asked; empty where all were asked for."""
    unknowns: int
    error: float
    """Signed relative frequency error of `mode` at `count`, solved."""
    expected_error: float | None
    """The same from the error law; None where there is none (stepped beams, modes beyond the lower branch)."""
    run_time_s: float
    """Median of warm solves, set-up included."""
    smaller: int | None
    """As of `Enough`."""
    smaller_error: float | None
    """Its error, of several modes the largest."""
    known_by: str
    unbuilt: str = ""
    """Why there is no model of one part less; empty where there is one, beyond what was asked."""

    @property
    def variant(self) -> Variant:
        """The model with its settings."""
        return Variant(self.model, self.settings)


def _expected(model: str, beam: "Beam", mode: int, count: int) -> float | None:
    """The error that the model's own law expects; None on a stepped beam, and where the model has none for the mode."""
    known = beam.uniform and model in LAWS and has_law(beam, mode, count)
    return expected_error(model, beam, mode, count) if known else None


def check_reachable(beam: "Beam", model: str, settings: Settings) -> None:
    """Raise InputError for what a model refuses at any number of parts."""
    MODELS.named(model).check(beam, 1, _CLOSELY, **dict(settings))


def enough_from(
    bench: SolutionCache, model: str, mode: Modes, error: float, settings: Settings = (), before_s: float = 0.0
) -> Enough:
    """From which size on the solved frequency error is within `error`; one part less is outside it.

    `mode` may be a range: all its modes are within. Where the discrete dispersion is known, it proves it. Elsewhere an
    error may change its sign and dip under `error` before it stays there: sizes are gone through from the smallest to
    twice the last that fails, to where the error law is certain of larger ones, and to where every section has parts of
    its own (`shared_from`). Where a body, a spring or a step falls anywhere within a part, the error goes up and down,
    and those after the last that fails are solved one by one (`walked`). What holds beyond is the law's word, where
    there is one and every size tried keeps to it (`known`). Where the law asks for more than 2000 parts, and for modes
    beyond the hundredth, its answer alone is looked around. Raises InputError where no size up to 200 000 reaches the
    error, or, where it goes up and down, where one beyond 2000 fails, and as soon as sizes to be gone through would
    take longer, with `before_s` seconds of work done before, than is waited for.
    """
    check_reachable(bench.beam, model, settings)
    modes = _several(mode)
    smallest = max(len(bench.beam.pieces), MODELS.named(model).fewest)
    law = model in LAWS and bench.beam.uniform and not (bench.beam.section or settings)
    guesses = {one: count_guess(model, bench.beam, one, error) for one in modes}
    guess = max(guesses.values())
    proven = law and sine_fits(bench.beam.supports) and error < _LOWER_BRANCH
    if proven or (law and (guess > _CLOSELY or modes[-1] > _EVERY)):
        near = demanding(model, bench.beam, guesses, proven)
        beside = {one: _beside_guess(bench, model, one, error, smallest) for one in near}
        worst = max(beside, key=lambda one: (beside[one], one))
        count = beside[worst]
        if not proven:
            return Enough(count=count, mode=worst, known_by=by_law(bench, model, worst, count))
        known_by = "every larger N does, proven by the discrete dispersion"
        smaller = _dip(model, bench.beam, mode, error, count)
        return Enough(count=count, mode=worst, smaller=smaller, known_by=known_by)
    reached = _reached(bench, model, modes, error, settings)
    uneven = falls_within(bench.beam)
    each_s = _part_s(bench.beam, modes[-1])
    certain = max(certain_from(model, bench.beam, one, error) for one in modes) if law else shared_from(bench.beam)
    count, smaller, does = _scanned(reached, smallest, max(guess, certain), model, error, uneven, each_s, before_s)
    worst = worst_of(bench, model, modes, count - 1, settings)
    beyond = kept(bench, model, modes, count, does) if law and max(does) >= certain else ""
    known_by, work_s = solved(count, does, beyond), each_s * sum(does)
    return Enough(count=count, mode=worst, smaller=smaller, known_by=known_by, work_s=work_s)


def _part_s(beam: "Beam", n_modes: int) -> float:
    """Seconds of a solve, for each part."""
    return _PER_PART + _PER_MODE * n_modes * (1.0 if set(beam.added) <= {"section"} else _LADEN)


def _several(mode: Modes) -> range:
    return mode if isinstance(mode, range) else range(mode, mode + 1)


def _reached(bench: SolutionCache, model: str, modes: range, error: float, settings: Settings) -> Reached:
    """Whether all modes are within `error` at a size."""

    def reached(count: int) -> bool:
        if MODELS.named(model).n_elastic(bench.beam, count, **dict(settings)) < modes[-1]:
            return False
        try:
            return all(abs(bench.frequency_error(model, count, mode, settings)) <= error for mode in reversed(modes))
        except InputError:  # of so few parts: what they refuse at any number is refused above
            return False

    return reached


def _beside_guess(bench: SolutionCache, model: str, mode: int, error: float, smallest: int) -> int:
    """From where one mode is within `error`, next to the error law's answer."""
    reached = _reached(bench, model, _several(mode), error, ())
    return _around(reached, count_guess(model, bench.beam, mode, error), smallest, model, error)


def _dip(model: str, beam: "Beam", mode: Modes, error: float, count: int) -> int | None:
    """The smallest size below `count` within `error` by the discrete dispersion."""
    modes = _several(mode)
    sizes = range(smallest_count(beam, modes[-1]), count)
    if law_of(model).hump is None or len(sizes) == 0:
        return None

    def within(size: int) -> bool:
        return all(abs(expected_error(model, beam, one, size)) <= error for one in modes)

    if len(modes) > 1:  # one part less than `count` is outside
        return next((size for size in sizes[:-1] if within(size)), None)
    if not within(sizes[0]):
        return None  # towards the cut-off the error falls again: if the smallest size does not do, none does
    return sizes[0] if any(not within(size) for size in sizes) else None


def _scanned(
    reached: Reached,
    smallest: int,
    guess: int,
    model: str,
    error: float,
    uneven: bool = False,
    each_s: float = 0.0,
    before_s: float = 0.0,
) -> tuple[int, int | None, dict[int, bool]]:
    """(the size from which on all that were tried reach, the smallest below it that does, what was tried).

    `uneven`: as of `falls_within`, so that sizes after the last that fails are gone through; `each_s`: of each part.
    """
    does: dict[int, bool] = {}
    count, failed = smallest, smallest - 1
    largest = _LARGEST_COUNT if uneven or model in LAWS else _LARGEST_UNKNOWN
    while count <= max(2 * failed, guess, smallest + 4):
        if count > largest:
            raise _unreached(model, error, count)
        does[count] = reached(count)
        if not does[count]:
            failed = _followed(count, model, error) if uneven else count
            seconds = before_s + each_s * (sum(does) + _ahead(failed, uneven))
            check_work("count", f"beyond {failed}", seconds, "ask for a larger error")
        closely = uneven or count < _CLOSELY
        count = count + 1 if count < _EVERY else ceil(1.05 * count) if closely else 2 * count
    if uneven:
        failed, does = walked(reached, failed, does)
        enough = _followed(failed, model, error) + 1
    else:
        enough = between(reached, failed, min(n for n in does if n > failed))
    return enough, next((n for n in does if n < failed and does[n]), None), does


def _followed(failed: int, model: str, error: float) -> int:
    """A size that fails while errors go up and down. Raises InputError where those after it are not gone through."""
    if failed > _LARGEST_UNKNOWN:
        raise InputError(
            f"error = {error!r}: the {model} model, whose error goes up and down with count here, is still beyond "
            f"it at count = {failed}, and larger ones are not looked through"
        )
    return failed


def _ahead(failed: int, uneven: bool) -> float:
    """Parts of all sizes that are looked at at least after one that fails."""
    if failed < _EVERY:
        return 1.5 * failed**2
    closely = failed / 0.05 if uneven or failed < _CLOSELY else 2.0 * failed
    return closely + uneven * _walk(failed) * failed


def _walk(failed: int) -> int:
    """How many sizes are gone through after one that fails."""
    fewest, parts, most = _WALK
    return min(failed, most, max(fewest, parts // max(failed, 1)))


def walked(reached: Reached, failed: int, does: dict[int, bool]) -> tuple[int, dict[int, bool]]:
    """(the last size that fails, what was tried, ascending), sizes after the last that fails solved one by one.

    A place on the beam wanders through the parts as N grows, and so does what it does to the error: after some tens
    of sizes it has been nearly everywhere, and they begin anew after each that fails.
    """
    does, at = dict(does), failed
    while at < failed + _walk(failed):
        at += 1
        if at not in does:
            does[at] = reached(at)
        if not does[at]:
            failed = at
            if failed > _LARGEST_UNKNOWN:
                break
    return max([failed, *(n for n in does if not does[n])]), dict(sorted(does.items()))


def _around(reached: Reached, guess: int, smallest: int, model: str, error: float) -> int:
    """The size that reaches with one part less that does not, next to a guess: a right guess costs two solves."""
    if reached(guess):
        return between(reached, *_gallop_down(reached, guess, smallest))
    return between(reached, *_gallop_up(reached, guess, model, error))


def between(reached: Reached, low: int, high: int) -> int:
    """The first that reaches between one that fails and one that reaches."""
    while high - low > 1:
        middle = (low + high) // 2
        low, high = (low, middle) if reached(middle) else (middle, high)
    return high


def _gallop_down(reached: Reached, good: int, smallest: int) -> tuple[int, int]:
    """(a count that fails, or one below the smallest; a count that reaches)."""
    step = 1
    while good - step >= smallest:
        if not reached(good - step):
            return good - step, good
        good, step = good - step, 2 * step
    return smallest - 1, good


def _gallop_up(reached: Reached, bad: int, model: str, error: float) -> tuple[int, int]:
    step = 1
    while not reached(bad + step):
        bad, step = bad + step, 2 * step
        if bad + step > (_LARGEST_COUNT if model in LAWS else _LARGEST_UNKNOWN):
            raise _unreached(model, error, bad)
    return bad, bad + step


def _unreached(model: str, error: float, count: int) -> InputError:
    return InputError(f"error = {error!r}: the {model} model does not reach it up to count = {count}")


def choose_of_all(
    bench: SolutionCache, mode: Modes, error: float, rules: Rules | None = None
) -> tuple[list[Choice], dict[str, str]]:
    """(choices of every model of parts, why those are left out that have none). Raises InputError.

    By its defaults and, on a beam where the literature has another rule, by that as well; or by the rules given.
    """
    names, left_out = [], {}
    for model in discrete():
        try:
            if model.name not in MODELS.built_in:
                if why := model.refuses(bench.beam):
                    raise InputError(why)
                enough_from(bench, model.name, mode, error)
            names.append(model.name)
        except InputError as problem:
            left_out[model.name] = str(problem)
    asked = (rules or Rules()).variants(names)
    left_out |= without_effect(bench.beam, rules or Rules())
    found: dict[Variant, Enough] = {}
    for one in asked:
        found[one] = enough_from(bench, one.model, mode, error, one.settings, _work_s(found))
    for one in (rules or Rules()).beside(bench.beam):
        try:
            if one not in found:
                found[one] = enough_from(bench, one.model, mode, error, one.settings, _work_s(found))
        except InputError as problem:
            left_out[one.title] = str(problem)
    return _choices(bench, found, mode, error), left_out


def _work_s(found: dict[Variant, Enough]) -> float:
    """Seconds of what was gone through."""
    return sum(one.work_s for one in found.values())


def choose(bench: SolutionCache, mode: Modes, error: float, variants: tuple[Variant, ...] = ()) -> list[Choice]:
    """For each variant the size from which on it keeps `error`, and its time, taken in turns. Raises InputError.

    The models of the package by their defaults, unless `variants` names others.
    """
    asked = variants or tuple(Variant(name) for name in MODELS.built_in if MODELS[name].sized)
    found = {one: enough_from(bench, one.model, mode, error, one.settings) for one in asked}
    return _choices(bench, found, mode, error)


def _choices(bench: SolutionCache, found: dict[Variant, Enough], mode: Modes, error: float) -> list[Choice]:
    highest = _several(mode)[-1]
    jobs = [_solver(bench, one, enough.count, highest) for one, enough in found.items()]
    return [
        Choice(
            model=one.model,
            settings=one.settings,
            count=enough.count,
            mode=enough.mode,
            lower=() if isinstance(mode, range) else _lower(bench, one, enough, error),
            unknowns=MODELS.named(one.model).unknowns(bench.beam, enough.count, **dict(one.settings)),
            error=bench.frequency_error(one.model, enough.count, enough.mode, one.settings),
            run_time_s=seconds,
            expected_error=None if one.settings else _expected(one.model, bench.beam, enough.mode, enough.count),
            smaller=enough.smaller,
            known_by=enough.known_by,
            unbuilt=unbuilt(bench, one.model, one.settings, enough.count - 1, enough.mode),
            smaller_error=None
            if enough.smaller is None
            else largest_error(bench, one.model, _several(mode), enough.smaller, one.settings),
        )
        for (one, enough), seconds in zip(found.items(), interleaved_medians(jobs), strict=True)
    ]


def _lower(bench: SolutionCache, one: Variant, enough: Enough, error: float) -> tuple[int, ...]:
    """Modes below that are outside `error` at a size that is enough for a higher one: they were solved with it."""
    if enough.mode > _LOWER:
        return ()
    found = {n: bench.error_or_why(one.model, enough.count, n, one.settings)[0] for n in range(1, enough.mode)}
    return tuple(n for n, off in found.items() if off is not None and abs(off) > error)


def _solver(bench: SolutionCache, one: Variant, count: int, mode: int) -> Callable[[], object]:
    settings = dict(one.settings)
    return lambda: MODELS.named(one.model).solve_modes(bench.beam, mode, count, **settings)
