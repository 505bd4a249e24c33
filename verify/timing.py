"""Comparable run times: jobs alternate, medians of processor time; the pace of a march in time."""

import sys
from collections.abc import Callable, Sequence
from itertools import pairwise
from statistics import median
from time import get_clock_info, perf_counter, process_time

from verify.errors import InputError

CHECKED = 1000  # steps after which a pace is known: a march begins with steps that are too short
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


class Pace:
    """The steps that a march over `duration`, s, is to take, from the latest of them."""

    def __init__(self, duration: float, most: float) -> None:
        self.duration, self.most, self.steps, self.share = duration, most, 0, 0.0

    def check(self, steps: int, share: float) -> None:
        """Raise InputError where more than `most` are to come, by those since the last check, `CHECKED` or more."""
        if (new := steps - self.steps) < CHECKED:
            return
        needed = steps + (1.0 - share) * new / max(share - self.share, 1e-300)
        if needed > self.most:
            raise InputError(
                f"duration = {self.duration:g} s: this motion needs about {needed:.3g} time steps, more than "
                f"{self.most:g}: give a shorter one, a slower base, a stiffer beam or fewer links and elements"
            )
        self.steps, self.share = steps, share


def forget() -> None:
    """Clear the models' caches of solutions."""
    for name, module in list(sys.modules.items()):
        if name.startswith(_SOLVERS):
            for value in list(vars(module).values()):
                if callable(clear := getattr(value, "cache_clear", None)):
                    clear()
