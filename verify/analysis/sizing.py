"""Smallest number of segments or elements from which on an accuracy is kept."""

from collections.abc import Callable
from math import ceil, inf
from typing import TYPE_CHECKING, TypeAlias

import msgspec

from verify.analysis.compare import ORDER_FLOOR
from verify.analysis.solution_cache import Settings, SolutionCache
from verify.analysis.variants import Rules, Variant, falls_within, shared_from, without_effect
from verify.errors import InputError
from verify.exact.error_laws import (
    KEPT,
    KEPT_FROM,
    LAWS,
    certain_from,
    expected_error,
    has_law,
    is_kept,
    law_of,
    parts_from_here_on,
    sine_fits,
    smallest_count,
)
from verify.linear.catalogue import MODELS, discrete
from verify.timing import interleaved_medians

if TYPE_CHECKING:
    from verify.problem.beam import Beam

_LARGEST_COUNT = 200_000
_LARGEST_UNKNOWN = 2000
"""Largest size of a model without an error law, and of errors that go up and down with the size."""
_EVERY, _CLOSELY = 100, 2000
"""Sizes are solved one by one up to the first, 5 % apart up to the second, then doubled."""
_LOWER_BRANCH = 0.05
"""Above the lower branch Hermite elements are at least 7.9 % off: smaller errors are on it."""
_WALK = (40, 100_000, 100)
"""Sizes one by one after the last that fails: the second number over it, no fewer than the first, no more than the
third, and never beyond its double."""
_LOWER = 100
"""Modes up to which those below are checked."""
_OTHER_RULES = 500
"""Size up to which other rules than the defaults are scanned, or five times that of the defaults."""
_NEAR = 3
"""Parts by which the size that is solved may differ from that of the discrete dispersion."""

PROVEN = "every larger N meets it by the discrete dispersion"
BY_LAW = "every larger N meets it by the error law, to which this size keeps"
KEPT_LAW = "larger N meet it by the error law, to which all sizes that were solved keep"
UNKNOWN = "no smaller or larger N was solved"

Reached = Callable[[int], bool]
Modes: TypeAlias = int | range
"""One mode, or all of several, numbered from 1."""


class Enough(msgspec.Struct, frozen=True, kw_only=True):
    """From which size on an accuracy is kept."""

    count: int
    """From this size on the error is within the limit, as far as `known_by` says."""
    mode: int
    """The mode that requires so many parts."""
    smaller: int | None = None
    """The smallest size below it that meets the limit, though one between does not."""
    known_by: str
    """How the statement on larger sizes is known."""


class Choice(msgspec.Struct, frozen=True, kw_only=True):
    """The parts of one model from which on an accuracy is kept, and what they cost."""

    model: str
    settings: Settings = ()
    """Other than the model's defaults: (("wall", "half"),) is the literature's wall."""
    count: int
    """Smallest sufficient size."""
    mode: int
    """The mode that requires it."""
    lower: tuple[int, ...]
    """Lower modes whose error at `count` exceeds the limit; empty where all modes of a range were required."""
    unknowns: int
    error: float
    """Signed relative frequency error of `mode` at `count`, solved."""
    expected_error: float | None
    """The same from the error law; None where there is none (stepped beams, modes beyond the lower branch)."""
    run_time_s: float
    """Median of warm solves, set-up included."""
    smaller: int | None
    """As of `Enough`."""
    known_by: str

    @property
    def variant(self) -> Variant:
        """The model with its settings."""
        return Variant(self.model, self.settings)


def enough_from(
    cache: SolutionCache,
    model: str,
    mode: Modes,
    error: float,
    settings: Settings = (),
    largest: int = _LARGEST_COUNT,
) -> Enough:
    """From which size on the solved frequency error is within `error`; one part less is outside it.

    `mode` may be a range: all its modes are within. Between pinned and guided ends the discrete dispersion proves it.
    Elsewhere an error may change its sign and dip under the limit before it stays there: sizes are scanned from the
    smallest to twice the last that fails, to where the error law is certain of larger ones, and to where every section
    has parts of its own (`shared_from`). Where a body, a spring or a step falls anywhere within a part, sizes after the
    last that fails are solved one by one. Where the law asks for more than 2000 parts, and for modes beyond the
    hundredth, the neighbourhood of its size alone is solved. Raises InputError where no size up to `largest` reaches
    the limit, or, where errors go up and down, where one beyond 2000 fails.
    """
    beam, modes = cache.beam, mode if isinstance(mode, range) else range(mode, mode + 1)
    MODELS.named(model).check(beam, 1, _CLOSELY, **dict(settings))
    smallest = max(len(beam.pieces), MODELS.named(model).fewest)
    law = model in LAWS and beam.uniform and not (beam.section or settings)
    guesses = {
        one: parts_from_here_on(model, beam, one, error)
        if beam.uniform and model in LAWS
        else smallest_count(beam, one)
        for one in modes
    }
    guess = max(guesses.values())
    proven = law and sine_fits(beam.supports) and error < _LOWER_BRANCH
    if proven or (law and (guess > _CLOSELY or modes[-1] > _EVERY)):
        near = [one for one in modes if guesses[one] >= (guess - _NEAR if proven else 0)]
        sizes = {
            one: _around(_reached(cache, model, range(one, one + 1), error, ()), guesses[one], smallest, model, error)
            for one in near
        }
        worst = max(sizes, key=lambda one: (sizes[one], one))
        count = sizes[worst]
        if proven:
            return Enough(count=count, mode=worst, smaller=_dip(model, beam, modes, error, count), known_by=PROVEN)
        known = has_law(beam, worst, count)
        off = cache.frequency_error(model, count, worst) / expected_error(model, beam, worst, count) if known else inf
        return Enough(count=count, mode=worst, known_by=BY_LAW if abs(abs(off) - 1.0) <= KEPT else UNKNOWN)
    reached = _reached(cache, model, modes, error, settings)
    certain = max(certain_from(model, beam, one, error) for one in modes) if law else shared_from(beam)
    uneven = falls_within(beam)
    largest = largest if model in LAWS or uneven else min(largest, _LARGEST_UNKNOWN)
    count, smaller, does = _scanned(
        reached, smallest, max(guess, certain), model, error, uneven=uneven, largest=largest
    )
    known_by = f"N from {count} to {max(does)} were solved, larger ones were not"
    if law and max(does) >= certain and _keeps_to_law(cache, model, modes, [n for n in does if n >= count]):
        known_by = KEPT_LAW
    errors = {one: cache.error_or_why(model, count - 1, one, settings)[0] for one in modes}
    worst = max(modes, key=lambda one: (inf if (off := errors[one]) is None else abs(off), one))
    return Enough(count=count, mode=worst, smaller=smaller, known_by=known_by)


def _reached(cache: SolutionCache, model: str, modes: range, error: float, settings: Settings) -> Reached:
    """Whether all modes are within `error` at a size."""

    def reached(count: int) -> bool:
        if MODELS.named(model).n_elastic(cache.beam, count, **dict(settings)) < modes[-1]:
            return False
        try:
            return all(abs(cache.frequency_error(model, count, mode, settings)) <= error for mode in reversed(modes))
        except InputError:  # too few parts: settings that are refused at any number are refused above
            return False

    return reached


def _keeps_to_law(cache: SolutionCache, model: str, modes: range, counts: list[int]) -> bool:
    """Whether the errors at all these sizes are near the error law's."""
    sizes = [n for n in counts if n >= KEPT_FROM]
    return bool(sizes) and all(
        is_kept(model, cache.beam, mode, n, cache.frequency_error(model, n, mode), ORDER_FLOOR)
        for n in sizes
        for mode in modes
    )


def _dip(model: str, beam: "Beam", modes: range, error: float, count: int) -> int | None:
    """The smallest size below `count` within `error` by the discrete dispersion."""
    sizes = range(smallest_count(beam, modes[-1]), count)
    if law_of(model).hump is None or len(sizes) == 0:
        return None

    def within(size: int) -> bool:
        return all(abs(expected_error(model, beam, one, size)) <= error for one in modes)

    if len(modes) > 1:  # one part less than `count` is outside
        return next((size for size in sizes[:-1] if within(size)), None)
    # towards the cut-off the error falls again: if the smallest size does not do, none does
    return sizes[0] if within(sizes[0]) and not all(map(within, sizes)) else None


def _scanned(
    reached: Reached,
    smallest: int,
    guess: int,
    model: str,
    error: float,
    *,
    uneven: bool,
    largest: int = _LARGEST_COUNT,
) -> tuple[int, int | None, dict[int, bool]]:
    """(the size from which on all that were solved reach, the smallest below it that does, all that were solved).

    `uneven`: errors go up and down, so that sizes after the last that fails are solved one by one. A place on the beam
    moves through the parts as N grows: after some tens of sizes it has been nearly everywhere.
    """
    does: dict[int, bool] = {}
    count, failed = smallest, smallest - 1
    while count <= max(2 * failed, guess, smallest + 4):
        if count > largest:
            raise _unreached(model, error, count)
        does[count] = reached(count)
        if not does[count]:
            failed = count
            if uneven:
                _check_followed(failed, model, error)
        closely = uneven or count < _CLOSELY
        count = count + 1 if count < _EVERY else ceil(1.05 * count) if closely else 2 * count
    if not uneven:
        enough = between(reached, failed, min(n for n in does if n > failed))
        return enough, next((n for n in does if n < failed and does[n]), None), does
    fewest, parts, most = _WALK
    size = failed
    while size < failed + min(failed, most, max(fewest, parts // max(failed, 1))):
        size += 1
        if size not in does:
            does[size] = reached(size)
        if not does[size]:
            failed = size
            _check_followed(failed, model, error)
    failed = max([failed, *(n for n in does if not does[n])])
    _check_followed(failed, model, error)
    does = dict(sorted(does.items()))
    return failed + 1, next((n for n in does if n < failed and does[n]), None), does


def _check_followed(failed: int, model: str, error: float) -> None:
    """Raise InputError where an error that goes up and down fails at a size beyond those that are scanned."""
    if failed > _LARGEST_UNKNOWN:
        raise InputError(
            f"error = {error!r}: the error of the {model} model goes up and down with count here and exceeds it at "
            f"count = {failed}: ask for a larger error"
        )


def _around(reached: Reached, guess: int, smallest: int, model: str, error: float) -> int:
    """The size that reaches with one part less that does not, next to a guess: a right guess costs two solves."""
    step = 1
    if reached(guess):
        while guess - step >= smallest and reached(guess - step):
            guess, step = guess - step, 2 * step
        return between(reached, max(guess - step, smallest - 1), guess)
    while not reached(guess + step):
        guess, step = guess + step, 2 * step
        if guess + step > (_LARGEST_COUNT if model in LAWS else _LARGEST_UNKNOWN):
            raise _unreached(model, error, guess)
    return between(reached, guess, guess + step)


def between(reached: Reached, low: int, high: int) -> int:
    """The first that reaches between one that fails and one that reaches."""
    while high - low > 1:
        middle = (low + high) // 2
        low, high = (low, middle) if reached(middle) else (middle, high)
    return high


def _unreached(model: str, error: float, count: int) -> InputError:
    return InputError(f"error = {error!r}: the {model} model does not reach it up to count = {count}")


def choose_of_all(
    cache: SolutionCache, mode: Modes, error: float, rules: Rules | None = None
) -> tuple[list[Choice], dict[str, str]]:
    """(choices of every discrete model, reason by name for those left out). Raises InputError.

    By its defaults and, on a beam where the literature has another rule, by that as well; or by the rules given.
    """
    rules, names = rules or Rules(), []
    left_out = without_effect(cache.beam, rules)
    for model in discrete():
        try:
            if model.name not in MODELS.built_in:
                if why := model.refuses(cache.beam):
                    raise InputError(why)
                enough_from(cache, model.name, mode, error)
            names.append(model.name)
        except InputError as problem:
            left_out[model.name] = str(problem)
    found = {one: enough_from(cache, one.model, mode, error, one.settings) for one in rules.variants(names)}
    for one in rules.beside(cache.beam):
        try:
            if one not in found:
                own = max((enough.count for same, enough in found.items() if same.model == one.model), default=0)
                largest = max(_OTHER_RULES, 5 * own)
                found[one] = enough_from(cache, one.model, mode, error, one.settings, largest)
        except InputError as problem:
            left_out[one.title] = str(problem)
    return _choices(cache, found, mode, error), left_out


def choose(cache: SolutionCache, mode: Modes, error: float, variants: tuple[Variant, ...] = ()) -> list[Choice]:
    """For each variant the smallest sufficient size and its solve time. Raises InputError.

    The models of the package by their defaults, unless `variants` names others.
    """
    chosen = variants or tuple(Variant(name) for name in MODELS.built_in if MODELS[name].sized)
    found = {one: enough_from(cache, one.model, mode, error, one.settings) for one in chosen}
    return _choices(cache, found, mode, error)


def _choices(cache: SolutionCache, found: dict[Variant, Enough], mode: Modes, error: float) -> list[Choice]:
    highest, beam = mode[-1] if isinstance(mode, range) else mode, cache.beam

    def solver(one: Variant, count: int) -> Callable[[], object]:
        return lambda: MODELS.named(one.model).solve_modes(beam, highest, count, **dict(one.settings))

    times = interleaved_medians([solver(one, enough.count) for one, enough in found.items()])
    choices = []
    for (one, enough), seconds in zip(found.items(), times, strict=True):
        law = not one.settings and beam.uniform and one.model in LAWS and has_law(beam, enough.mode, enough.count)
        below = range(1, enough.mode if not isinstance(mode, range) and enough.mode <= _LOWER else 1)
        errors = {n: cache.error_or_why(one.model, enough.count, n, one.settings)[0] for n in below}
        choices.append(
            Choice(
                model=one.model,
                settings=one.settings,
                count=enough.count,
                mode=enough.mode,
                lower=tuple(n for n, off in errors.items() if off is not None and abs(off) > error),
                unknowns=MODELS.named(one.model).unknowns(beam, enough.count, **dict(one.settings)),
                error=cache.frequency_error(one.model, enough.count, enough.mode, one.settings),
                run_time_s=seconds,
                expected_error=expected_error(one.model, beam, enough.mode, enough.count) if law else None,
                smaller=enough.smaller,
                known_by=enough.known_by,
            )
        )
    return choices
