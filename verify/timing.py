"""Comparable run times: jobs alternate, medians of processor time."""

import sys
from collections.abc import Callable, Sequence
from itertools import pairwise
from statistics import median
from time import get_clock_info, perf_counter, process_time

_SOLVERS = ("verify.elements.", "verify.segments.", "verify.exact.", "verify.analytic_modes", "verify.dynamics.")
_CLOCK = process_time if get_clock_info("process_time").resolution < 1e-5 else perf_counter


def interleaved_medians(jobs: Sequence[Callable[[], object]], budget_s: float = 0.008) -> list[float]:
    """Median processor seconds of each job over alternating rounds; at least one round, at most 15."""
    rounds: list[list[float]] = []
    start = perf_counter()
    while len(rounds) < 15 and (not rounds or perf_counter() - start < budget_s):
        times = [_CLOCK()]
        for job in jobs:
            job()
            times.append(_CLOCK())
        rounds.append([after - before for before, after in pairwise(times)])
    return [median(times) for times in zip(*rounds, strict=True)]


def forget() -> None:
    """Clear the models' caches of solutions."""
    for name, module in list(sys.modules.items()):
        if name.startswith(_SOLVERS):
            for value in list(vars(module).values()):
                if callable(clear := getattr(value, "cache_clear", None)):
                    clear()
