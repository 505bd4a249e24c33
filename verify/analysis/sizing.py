"""Sufficient number of segments or elements: the frequency error is within a limit for this and all larger numbers."""

from collections.abc import Callable
from math import ceil, pi
from typing import TypeAlias

import msgspec

from verify.analysis.solution_cache import Settings, SolutionCache
from verify.analysis.variants import Rules, Variant
from verify.errors import InputError
from verify.exact.closed_forms import wavenumber_length
from verify.exact.error_laws import LAWS, expected_error, has_law, sine_fits
from verify.linear.registry import MODELS, discrete
from verify.timing import interleaved_medians

LARGEST, LARGEST_WITHOUT_LAW = 200_000, 2000
"""Largest size of models with an error law, and of models of other packages."""
LARGEST_ALTERNATIVE = 500
"""Largest size with settings other than the defaults, or five times the size with the defaults."""
LAW_FROM = 60
"""Size from which on the error law replaces the scan (measured: within a third of its terms from 20 parts on)."""
EVERY, FINE, COARSE, WINDOW = 60, 1.05, 1.5, 20
"""Size up to which a scan tries every size; larger ones are 5 % apart, beyond `LARGEST_WITHOUT_LAW` 50 %.
Number of consecutive sizes to be within the limit: errors alternate with the places of steps within links."""
ROUNDING = 1e-12  # smallest error above rounding

PROVEN = "all larger N are within the limit by the discrete dispersion"
BY_LAW = "larger N are within the limit by the error law"

Modes: TypeAlias = int | range  # one mode, or a range of modes, numbered from 1
Within: TypeAlias = Callable[[int], bool]  # whether the errors at a size are within the limit


class Sufficient(msgspec.Struct, frozen=True, kw_only=True):
    """The sufficient size for an error limit."""

    count: int  # the error is within the limit for this and all larger sizes, by the argument `known_by`
    mode: int  # the mode that requires it
    smaller: int | None = None  # the smallest size tried that is within the limit, if a larger one is not
    known_by: str


class Choice(msgspec.Struct, frozen=True, kw_only=True):
    """The sufficient size of one model and its cost."""

    variant: Variant
    size: Sufficient
    unknowns: int
    error: float  # signed relative frequency error of the mode that requires the size, the largest of the modes asked
    expected_error: float | None
    """`error` by the error law; None without a law (steps, attachments, settings, modes beyond the lower branch)."""
    run_time_s: float  # median of warm solves, assembly included


def sufficient_size(
    cache: SolutionCache, model: str, mode: Modes, error: float, settings: Settings = (), largest: int = LARGEST
) -> Sufficient:
    """The size from which on the computed frequency error of `mode`, or of all modes of a range, is within `error`.

    For a uniform beam from `LAW_FROM` on by the error law, with neighbouring sizes solved; for pinned and guided ends
    the discrete dispersion proves it. In other cases by a scan up to twice the last size beyond the limit, bisection,
    and `WINDOW` consecutive sizes. Raises InputError if no size up to `largest` is within the limit.
    """
    if not error >= ROUNDING:
        raise InputError(f"error = {error!r} is within rounding: give {ROUNDING:g} or more")
    beam, modes = cache.beam, mode if isinstance(mode, range) else range(mode, mode + 1)
    cls = MODELS.named(model)
    cls.build(beam, LARGEST_WITHOUT_LAW, **dict(settings))  # raises for invalid settings and beams
    smallest = max(len(beam.pieces), cls.fewest)
    largest = largest if model in LAWS else min(largest, LARGEST_WITHOUT_LAW)

    def check_allowed(count: int) -> None:
        if count > largest:
            raise InputError(
                f"error = {error!r}: the {model} model exceeds it up to count = {largest}, give a larger error"
            )

    def within(count: int) -> bool:
        check_allowed(count)
        try:
            return all(abs(cache.frequency_error(model, count, one, settings)) <= error for one in reversed(modes))
        except InputError:  # too few parts
            return False

    def lawful(count: int) -> bool:
        check_allowed(count)
        return all(abs(expected_error(model, beam, one, count)) <= error for one in modes)

    guess = dip = 0
    has_guess = model in LAWS and beam.uniform and not settings
    if has_guess:
        # errors fall monotonically beyond 300 parts per clamped end, and for elements below mu = 2.98
        first = max(int(wavenumber_length(beam.supports, modes[-1]) / pi) + 1, modes[-1] + 1, 2)  # on the lower branch
        guess, dip, _ = _scan(lawful, first, max(4 * first, 300 * beam.supports.count("clamped")))
    if has_guess and (sine_fits(beam.supports) or guess >= LAW_FROM) and has_law(beam, modes[-1], guess):
        # start next to the estimate: a correct one costs two solutions
        low, high, step = guess - 1, guess, 1
        while not within(high):
            low, high, step = high, high + step, 2 * step
        step = 1
        while low >= smallest and within(low):
            high, low, step = low, max(low - 2 * step, smallest - 1), 2 * step
        count = _between(within, low, high)
        known_by = PROVEN if sine_fits(beam.supports) else BY_LAW
    else:
        count, dip, known_by = _scan(within, smallest, max(guess, smallest + 4))
    errors = {one: cache.error_or_reason(model, count - 1, one, settings)[0] for one in modes} if count > 1 else {}
    worst = max(modes, key=lambda one: (abs(off) if (off := errors.get(one)) is not None else float("inf"), one))
    smaller = dip if 0 < dip < count - 1 and within(dip) else None
    return Sufficient(count=count, mode=worst, smaller=smaller, known_by=known_by)


def _scan(within: Within, first: int, up_to: int) -> tuple[int, int, str]:
    """(sufficient size, smallest size tried that is within the limit, sizes solved in words).

    Sizes up to `up_to`, or twice the last size beyond the limit; next to the sufficient size a full window.
    """
    sizes, last, size = dict[int, bool](), first - 1, first
    while size <= max(2 * last, up_to):
        sizes[size] = within(size)
        last = last if sizes[size] else size
        size = size + 1 if size < EVERY else ceil((FINE if size < LARGEST_WITHOUT_LAW else COARSE) * size)
    good = [n for n in sizes if sizes[n]]
    size = count = _between(within, last, min(n for n in good if n > last))
    while size < count + WINDOW:
        size, count = size + 1, count if within(size) else size + 1
    more = f", {sum(n >= size for n in sizes)} larger ones up to {max(sizes)}" if max(sizes) >= size else ""
    dip = _between(within, max((n for n in sizes if n < good[0]), default=first - 1), good[0])
    return count, dip, f"every N from {count} to {size - 1} was solved{more}"


def _between(within: Within, low: int, high: int) -> int:
    """The smallest size within the limit between `low` (beyond it) and `high` (within it)."""
    while high - low > 1:
        middle = (low + high) // 2
        low, high = (low, middle) if within(middle) else (middle, high)
    return high


def choose(
    cache: SolutionCache, modes: range, error: float, rules: Rules | None = None
) -> tuple[list[Choice], dict[str, str]]:
    """(sufficient size and cost of every discrete model with these rules, reason by name for skipped models).

    The errors of all `modes` are within `error`. Includes the rules of the literature for this beam
    (`Rules.alternatives`). Raises InputError.
    """
    rules, beam, names = rules or Rules(), cache.beam, []
    left_out = rules.without_effect(beam)
    for model in discrete():
        try:
            if model.name not in MODELS.built_in:
                sufficient_size(cache, model.name, modes, error)
            names.append(model.name)
        except InputError as problem:
            left_out[model.name] = str(problem)
    sizes = {one: sufficient_size(cache, one.model, modes, error, one.settings) for one in rules.variants(names)}
    for one in rules.alternatives(beam):
        own = max((size.count for same, size in sizes.items() if same.model == one.model), default=0)
        try:
            if one not in sizes:
                most = max(LARGEST_ALTERNATIVE, 5 * own)
                sizes[one] = sufficient_size(cache, one.model, modes, error, one.settings, most)
        except InputError as problem:
            left_out[one.title] = str(problem)

    def solver(one: Variant, count: int) -> Callable[[], object]:
        return lambda: MODELS[one.model].build(beam, count, **dict(one.settings)).modes(modes[-1])

    times = interleaved_medians([solver(one, size.count) for one, size in sizes.items()])
    choices = []
    for (one, size), seconds in zip(sizes.items(), times, strict=True):
        law = not one.settings and beam.uniform and one.model in LAWS and has_law(beam, size.mode, size.count)
        built = MODELS[one.model].build(beam, size.count, **dict(one.settings))
        choice = Choice(
            variant=one,
            size=size,
            unknowns=built.n_elastic + beam.rigid_motions,
            error=cache.frequency_error(one.model, size.count, size.mode, one.settings),
            expected_error=expected_error(one.model, beam, size.mode, size.count) if law else None,
            run_time_s=seconds,
        )
        choices.append(choice)
    return choices, left_out
