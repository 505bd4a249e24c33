"""How many segments or elements an accuracy takes: the error law's guess, confirmed by solves."""

from collections.abc import Callable
from typing import TYPE_CHECKING

import msgspec

from verify.error_laws import expected_error, fewest_parts, smallest_count
from verify.errors import InputError, PairingError
from verify.timing import interleaved_medians
from verify.workbench import Settings, Workbench, model_module

if TYPE_CHECKING:
    from verify.beam import Beam

_LARGEST_COUNT = 200_000


class Choice(msgspec.Struct, frozen=True, kw_only=True):
    """The fewest parts of one model that reach an accuracy, and what they cost."""

    model: str
    count: int
    unknowns: int
    error: float
    """Signed relative frequency error at `count`, solved."""
    expected_error: float | None
    """The same from the error law; None where there is none (stepped beams)."""
    run_time_s: float
    """Median of warm solves, set-up included."""


def count_guess(model: str, beam: "Beam", mode: int, error: float) -> int:
    """Where to begin: the error law's answer, on a stepped beam the fewest parts that have the mode."""
    return smallest_count(model, beam, mode) if beam.stepped else fewest_parts(model, beam, mode, error)


def count_needed(bench: Workbench, model: str, mode: int, error: float, settings: Settings = ()) -> int:
    """The fewest parts whose solved frequency error is within `error`, with one part less outside it.

    From the guess the search gallops in steps that double, so that a right guess costs two solves. Raises
    InputError where no size up to 200 000 reaches the error.
    """

    def reached(count: int) -> bool:
        if model_module(model).n_elastic(bench.beam, count) < mode:
            return False
        try:
            return abs(bench.frequency_error(model, count, mode, settings)) <= error
        except PairingError:
            return False

    guess = count_guess(model, bench.beam, mode, error)
    if reached(guess):
        low, high = _gallop_down(reached, guess, smallest=max(len(bench.beam.pieces), 1 + (model == "segment")))
    else:
        low, high = _gallop_up(reached, guess, model, error)
    while high - low > 1:
        middle = (low + high) // 2
        low, high = (low, middle) if reached(middle) else (middle, high)
    return high


def _gallop_down(reached: Callable[[int], bool], good: int, smallest: int) -> tuple[int, int]:
    """(a count that fails, or one below the smallest; a count that reaches)."""
    step = 1
    while good - step >= smallest:
        if not reached(good - step):
            return good - step, good
        good, step = good - step, 2 * step
    return smallest - 1, good


def _gallop_up(reached: Callable[[int], bool], bad: int, model: str, error: float) -> tuple[int, int]:
    step = 1
    while not reached(bad + step):
        bad, step = bad + step, 2 * step
        if bad + step > _LARGEST_COUNT:
            raise InputError(f"error = {error!r}: the {model} model does not reach it up to count = {bad}")
    return bad, bad + step


def choose(bench: Workbench, mode: int, error: float, models: tuple[str, ...] = ("segment", "fem")) -> list[Choice]:
    """For each model the fewest parts within `error` and the time of a solve, timed in turns. Raises InputError."""
    counts = {model: count_needed(bench, model, mode, error) for model in models}
    jobs = [_solver(bench, model, count, mode) for model, count in counts.items()]
    return [
        Choice(
            model=model, count=count, unknowns=model_module(model).unknowns(bench.beam, count),
            error=bench.frequency_error(model, count, mode), run_time_s=seconds,
            expected_error=None if bench.beam.stepped else expected_error(model, bench.beam, mode, count),
        )
        for (model, count), seconds in zip(counts.items(), interleaved_medians(jobs), strict=True)
    ]  # fmt: skip


def _solver(bench: Workbench, model: str, count: int, mode: int) -> Callable[[], object]:
    return lambda: model_module(model).solve_modes(bench.beam, mode, count)
