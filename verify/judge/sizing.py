"""How many segments or elements an accuracy takes: from which size on it is kept, and how that is known."""

from collections.abc import Callable
from math import ceil
from typing import TYPE_CHECKING

import msgspec

from verify.errors import InputError
from verify.exact.error_laws import LAWS, expected_error, law_of, parts_from_here_on, sine_fits, smallest_count
from verify.judge.variants import Rules, Variant, beside, without_effect
from verify.judge.workbench import Settings, Workbench
from verify.models.catalogue import MODELS, discrete
from verify.timing import interleaved_medians

if TYPE_CHECKING:
    from verify.beam import Beam

_LARGEST_COUNT = 200_000
_LARGEST_UNKNOWN = 2000
"""Of a model without an error law: nobody says beforehand whether it gets there."""
_EVERY, _CLOSELY = 100, 2000
"""Sizes are gone through one by one up to the first, 5 % apart up to the second, then doubled."""
_LOWER_BRANCH = 0.05
"""Above the lower branch Hermite elements are at least 7.9 % off: smaller errors are found on it."""

Reached = Callable[[int], bool]


class Enough(msgspec.Struct, frozen=True, kw_only=True):
    """From which size on an accuracy is kept."""

    count: int
    """At this size and every larger one, as far as `known_by` says, the error is within what was asked."""
    smaller: int | None = None
    """The smallest size below it that happens to do, though one between does not; None where none was found."""
    known_by: str
    """How it is known that larger sizes do."""


class Choice(msgspec.Struct, frozen=True, kw_only=True):
    """The parts of one model from which on an accuracy is kept, and what they cost."""

    model: str
    settings: Settings = ()
    """Other than the model's defaults: (("wall", "half"),) is the literature's wall."""
    count: int
    """From here on enough."""
    unknowns: int
    error: float
    """Signed relative frequency error at `count`, solved."""
    expected_error: float | None
    """The same from the error law; None where there is none (stepped beams)."""
    run_time_s: float
    """Median of warm solves, set-up included."""
    smaller: int | None
    """A smaller size that happens to do, though one between does not; None where none was found."""
    smaller_error: float | None
    """Its error."""
    known_by: str
    """How it is known that every larger size does."""

    @property
    def variant(self) -> Variant:
        """The model with its settings."""
        return Variant(self.model, self.settings)


def count_guess(model: str, beam: "Beam", mode: int, error: float) -> int:
    """Where to begin: the error law's answer, on a stepped beam the fewest parts that have the mode."""
    if not beam.uniform or model not in LAWS:
        return smallest_count(beam, mode)
    return parts_from_here_on(model, beam, mode, error)


def _expected(model: str, beam: "Beam", mode: int, count: int) -> float | None:
    """The error that the model's own law expects; None on a stepped beam, and of a model without one."""
    return None if not beam.uniform or model not in LAWS else expected_error(model, beam, mode, count)


def check_reachable(beam: "Beam", model: str, settings: Settings) -> None:
    """Raise InputError for what a model refuses at any number of parts."""
    MODELS.named(model).check(beam, 1, _CLOSELY, **dict(settings))


def enough_from(bench: Workbench, model: str, mode: int, error: float, settings: Settings = ()) -> Enough:
    """From which size on the solved frequency error is within `error`; one part less is outside it.

    Where the discrete dispersion is known, it proves it. Elsewhere an error may change its sign and dip under `error`
    before it stays there: sizes are gone through from the smallest to twice the last that fails, and what holds
    beyond is the error law's word. Where the law asks for more than 2000 parts, and for modes beyond the hundredth,
    its answer alone is looked around. Raises InputError where no size up to 200 000 reaches the error.
    """

    def reached(count: int) -> bool:
        if MODELS.named(model).n_elastic(bench.beam, count, **dict(settings)) < mode:
            return False
        try:
            return abs(bench.frequency_error(model, count, mode, settings)) <= error
        except InputError:  # of so few parts: what they refuse at any number is refused above
            return False

    guess = count_guess(model, bench.beam, mode, error)
    check_reachable(bench.beam, model, settings)
    smallest = max(len(bench.beam.pieces), MODELS.named(model).fewest)
    uniform = model in LAWS and bench.beam.uniform and not (bench.beam.section or settings)
    if uniform and sine_fits(bench.beam.supports) and error < _LOWER_BRANCH:
        count = _around(reached, guess, smallest, model, error)
        return Enough(
            count=count,
            smaller=_dip(model, bench.beam, mode, error, count),
            known_by="every larger N does, proven by the discrete dispersion",
        )
    if guess > _CLOSELY or mode > _EVERY:
        known_by = "every larger N does by the error law; smaller ones were not looked through"
        return Enough(count=_around(reached, guess, smallest, model, error), known_by=known_by)
    count, smaller, end = _scanned(reached, smallest, guess, model, error)
    tried = f"all N up to {end}" if end <= _EVERY else f"all N up to {_EVERY} and some up to {end}"
    beyond = "beyond that by the error law" if uniform else "beyond that nothing is known"
    return Enough(count=count, smaller=smaller, known_by=f"every larger N does, solved for {tried}, {beyond}")


def _dip(model: str, beam: "Beam", mode: int, error: float, count: int) -> int | None:
    """The smallest size below `count` within `error` by the discrete dispersion."""
    sizes = range(smallest_count(beam, mode), count)
    if law_of(model).hump is None or len(sizes) == 0 or abs(expected_error(model, beam, mode, sizes[0])) > error:
        return None  # towards the cut-off the error falls again: if the smallest size does not do, none does
    return sizes[0] if any(abs(expected_error(model, beam, mode, n)) > error for n in sizes) else None


def _scanned(reached: Reached, smallest: int, guess: int, model: str, error: float) -> tuple[int, int | None, int]:
    """(the size from which on all that were tried reach, the smallest below it that does, the last tried)."""
    does: dict[int, bool] = {}
    count, failed = smallest, smallest - 1
    while count <= max(2 * failed, guess, smallest + 4):
        if count > (_LARGEST_COUNT if model in LAWS else _LARGEST_UNKNOWN):
            raise _unreached(model, error, count)
        does[count] = reached(count)
        failed = failed if does[count] else count
        count = count + 1 if count < _EVERY else ceil(1.05 * count) if count < _CLOSELY else 2 * count
    enough = _between(reached, failed, min(n for n in does if n > failed))
    return enough, next((n for n in does if n < failed and does[n]), None), max(does)


def _around(reached: Reached, guess: int, smallest: int, model: str, error: float) -> int:
    """The size that reaches with one part less that does not, next to a guess: a right guess costs two solves."""
    if reached(guess):
        return _between(reached, *_gallop_down(reached, guess, smallest))
    return _between(reached, *_gallop_up(reached, guess, model, error))


def _between(reached: Reached, low: int, high: int) -> int:
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
    bench: Workbench, mode: int, error: float, rules: Rules | None = None
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
    variants, more = list(asked), beside(bench.beam, (rules or Rules()).settled)
    for one in more:
        try:
            enough_from(bench, one.model, mode, error, one.settings)
            variants.append(one)
        except InputError as problem:
            left_out[one.title] = str(problem)
    return choose(bench, mode, error, tuple(dict.fromkeys(variants))), left_out


def choose(bench: Workbench, mode: int, error: float, variants: tuple[Variant, ...] = ()) -> list[Choice]:
    """For each variant the size from which on it keeps `error`, and its time, taken in turns. Raises InputError.

    The models of the package by their defaults, unless `variants` names others.
    """
    asked = variants or tuple(Variant(name) for name in MODELS.built_in if MODELS[name].sized)
    found = {one: enough_from(bench, one.model, mode, error, one.settings) for one in asked}
    jobs = [_solver(bench, one, enough.count, mode) for one, enough in found.items()]
    return [
        Choice(
            model=one.model,
            settings=one.settings,
            count=enough.count,
            unknowns=MODELS.named(one.model).unknowns(bench.beam, enough.count, **dict(one.settings)),
            error=bench.frequency_error(one.model, enough.count, mode, one.settings),
            run_time_s=seconds,
            expected_error=None if one.settings else _expected(one.model, bench.beam, mode, enough.count),
            smaller=enough.smaller,
            known_by=enough.known_by,
            smaller_error=None
            if enough.smaller is None
            else bench.frequency_error(one.model, enough.smaller, mode, one.settings),
        )
        for (one, enough), seconds in zip(found.items(), interleaved_medians(jobs), strict=True)
    ]


def _solver(bench: Workbench, one: Variant, count: int, mode: int) -> Callable[[], object]:
    settings = dict(one.settings)
    return lambda: MODELS.named(one.model).solve_modes(bench.beam, mode, count, **settings)
