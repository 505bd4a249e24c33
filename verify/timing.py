"""Run times that can be compared: jobs take turns, medians are kept, of the processor and not of the wall.

What else a machine does at the same time, other scenes or a process that compiles, counts little then.
"""

import sys
from collections.abc import Callable, Sequence
from functools import lru_cache
from statistics import median, quantiles
from time import get_clock_info, perf_counter, process_time

_BUDGET_S = 0.008
"""Time spent on rounds, beside the first: three of them at N = 49, and a whole run is not spent on its own timing."""


_COARSE_S = 1e-5
"""Resolution from which on a clock of the processor says nothing of a solve."""
_CLOCK = process_time if get_clock_info("process_time").resolution < _COARSE_S else perf_counter
_KEEPERS = ("verify.elements.", "verify.segments.", "verify.exact.")
"""Modules of models, which keep some of what they solved."""


def interleaved_medians(jobs: Sequence[Callable[[], object]], budget_s: float = _BUDGET_S) -> list[float]:
    """Median processor seconds of each job over rounds in which all take turns; at least one round, at most 15."""
    rounds: list[list[float]] = []
    start = perf_counter()
    while len(rounds) < 15 and (not rounds or perf_counter() - start < budget_s):
        rounds.append([_seconds(job) for job in jobs])
    return [median(times) for times in zip(*rounds, strict=True)]


def _seconds(job: Callable[[], object]) -> float:
    start = _CLOCK()
    job()
    return _CLOCK() - start


def spread(times: Sequence[float]) -> float:
    """Between the quartiles of two times or more."""
    low, _, high = quantiles(times, n=4, method="inclusive")
    return high - low


def forget() -> None:
    """Let the models forget what they solved for whoever asks again."""
    for clear in _clears(len(sys.modules)):
        clear()


@lru_cache(maxsize=1)
def _clears(n_modules: int) -> tuple[Callable[[], None], ...]:
    """What makes each of them forget, as long as no module is added."""
    kept = (vars(module).values() for name, module in list(sys.modules.items()) if name.startswith(_KEEPERS))
    found = (getattr(value, "cache_clear", None) for values in kept for value in values)
    return tuple(clear for clear in found if callable(clear))
