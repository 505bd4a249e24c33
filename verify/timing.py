"""Run times that can be compared: jobs take turns, medians are kept."""

from collections.abc import Callable, Sequence
from time import perf_counter

_BUDGET_S = 0.008
"""Time spent on rounds, beside the first: three of them at N = 49, and a whole run is not spent on its own timing."""


def interleaved_medians(jobs: Sequence[Callable[[], object]], budget_s: float = _BUDGET_S) -> list[float]:
    """Median seconds of each job over rounds in which all take turns; at least one round, at most 15."""
    rounds: list[list[float]] = []
    start = perf_counter()
    while len(rounds) < 15 and (not rounds or perf_counter() - start < budget_s):
        rounds.append([_seconds(job) for job in jobs])
    return [_median(times) for times in zip(*rounds, strict=True)]


def _median(times: Sequence[float]) -> float:
    half, ordered = len(times) // 2, sorted(times)
    return 0.5 * (ordered[half] + ordered[~half])


def _seconds(job: Callable[[], object]) -> float:
    start = perf_counter()
    job()
    return perf_counter() - start
