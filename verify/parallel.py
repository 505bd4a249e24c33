"""Parallel evaluation in several processes, with the results of a serial one in the same order."""

import os
import sys
from collections.abc import Callable, Iterable
from typing import TypeVar

from verify.errors import InputError

Item = TypeVar("Item")
Result = TypeVar("Result")
VARIABLE = "VERIFY_JOBS"  # environment variable with the number of worker processes; 1 where it is unset


def map_processes(
    function: Callable[[Item], Result],
    items: Iterable[Item],
    progress: Callable[[int], None] = lambda done: None,
    max_workers: int | None = None,
) -> list[Result]:
    """`[function(item) for item in items]` in `max_workers` processes; default: VERIFY_JOBS.

    `progress` is called with the index of each item that completes. The first item runs in this process, so that
    workers inherit compiled functions and caches. Function and items must be picklable where the platform cannot fork.
    Raises the error of the first item that fails, pending items are cancelled; and InputError unless VERIFY_JOBS is a
    positive integer.
    """
    text = str(max_workers or os.environ.get(VARIABLE, "") or 1)
    if not (text.isascii() and text.isdigit() and int(text)):
        raise InputError(f"{VARIABLE} = {text!r}: give a whole number of processes from 1, or leave it unset")
    todo = list(items)
    workers = min(int(text), len(todo) - 1)
    alone = len(todo) if workers < 2 else 1
    results = []
    for i, item in enumerate(todo[:alone]):
        results.append(function(item))
        progress(i)
    if alone == len(todo):
        return results
    from concurrent.futures import ProcessPoolExecutor, as_completed
    from multiprocessing import get_context

    # Forked workers inherit caches and compiled kernels; macOS and Windows cannot fork safely.
    context = get_context("fork" if sys.platform == "linux" else "spawn")
    with ProcessPoolExecutor(workers, mp_context=context) as pool:
        futures = {pool.submit(function, item): i for i, item in enumerate(todo[1:], 1)}
        try:
            for future in as_completed(futures):
                future.result()
                progress(futures[future])
        except BaseException:
            pool.shutdown(wait=False, cancel_futures=True)
            raise
    return results + [future.result() for future in futures]
