"""Parallel evaluation by an executor: processes of this machine, or the workers of a dask cluster.

Results are those of a serial evaluation, in the same order.
"""

import os
import sys
from collections.abc import Callable, Iterable, Iterator
from concurrent.futures import BrokenExecutor, CancelledError, Executor, as_completed
from contextlib import ExitStack, contextmanager
from contextvars import ContextVar
from threading import Thread
from time import sleep
from typing import Any, TypeVar

from verify.blas import one_blas_thread
from verify.errors import InputError, shown

Item = TypeVar("Item")
Result = TypeVar("Result")
VARIABLE = "VERIFY_JOBS"  # environment variable with the number of worker processes; unset: 1, of `verify` all cores
CLIENT: ContextVar[Any] = ContextVar("client", default=None)  # client of the cluster inside `with cluster(...)`
PATIENCE = 30.0  # time to reach a scheduler and its first worker, s
ORDER = 0.2
"""Time after the death of a worker, s, in which a Ctrl-C that ended it reaches this process too, and is the error."""


@contextmanager
def cluster(where: str | int) -> Iterator[None]:
    """Inside the context `workers` are those of a dask cluster; a task whose worker dies runs again on another.

    `where` is the address of its scheduler, tcp://host:8786, or a number of processes to start on this machine. Raises
    InputError where dask.distributed is not installed, the scheduler does not respond or has no worker, and for a
    worker with other versions, which may compute other digits.
    """
    try:
        from distributed import Client, LocalCluster
    except ImportError:
        remedy = "pip install 'fem-segment-verify[cluster]', or leave it out"
        raise InputError(f"cluster = {shown(where)}: dask.distributed is not installed, {remedy}") from None
    with ExitStack() as stack:
        address: Any = where
        remedy = "start `dask scheduler` and `dask worker` with verify installed, or correct the address"
        try:
            if isinstance(where, int):
                remedy = "in a script of your own call it below if __name__ == '__main__'"
                options: Any = {"threads_per_worker": 1, "dashboard_address": ":0", "silence_logs": 50}
                with _interrupts_blocked():  # also in the workers, for ever: Ctrl-C is this process's alone
                    address = stack.enter_context(LocalCluster(n_workers=where, **options))
            client = stack.enter_context(Client(address, timeout=PATIENCE, set_as_default=False))
            client.wait_for_workers(1, timeout=PATIENCE)
            theirs = client.run(versions)
        except (OSError, ValueError, ImportError, RuntimeError) as error:
            raise InputError(f"cluster = {shown(where)} has no usable worker ({error}): {remedy}") from None
        for worker, installed in theirs.items():
            if installed != versions():
                both = f"worker {worker} has {installed}, this machine {versions()}"
                raise InputError(f"{both}: install the same versions")
        token = CLIENT.set(client)
        try:
            yield
        finally:
            CLIENT.reset(token)


@contextmanager
def _interrupts_blocked() -> Iterator[None]:
    """Ctrl-C has its effect at the end of the context; threads and processes that start inside inherit the block."""
    if sys.platform == "win32":
        yield
        return
    from multiprocessing.resource_tracker import ensure_running
    from signal import SIG_BLOCK, SIG_SETMASK, SIGINT, pthread_sigmask

    ensure_running()  # which would undo the block
    before = pthread_sigmask(SIG_BLOCK, {SIGINT})
    try:
        yield
    finally:
        pthread_sigmask(SIG_SETMASK, before)


def _end_with_parent() -> None:
    """End this worker by Ctrl-C at once, and with its parent, which may be killed.

    A worker that handles Ctrl-C while it holds the lock of the queue, or waits at its own end of it, never ends.
    """
    from multiprocessing import parent_process
    from signal import SIG_DFL, SIGINT, signal

    signal(SIGINT, SIG_DFL)
    parent: Any = parent_process()
    Thread(target=lambda: (parent.join(), os._exit(1)), daemon=True).start()


@contextmanager
def workers(most: int, processes: int | None = None) -> Iterator[Executor | None]:
    """An executor for `most` items at a time: the cluster's, else of `processes`; default: VERIFY_JOBS.

    None where one process is enough. Raises InputError unless VERIFY_JOBS is a positive integer.
    """
    text = str(processes or os.environ.get(VARIABLE) or 1)
    if not (text.isascii() and text.isdigit() and int(text)):
        raise InputError(f"{VARIABLE} = {text!r}: give a whole number of processes from 1, or leave it unset")
    client, n = CLIENT.get(), min(int(text), most)
    if client is None and n < 2:
        yield None
        return
    from concurrent.futures import ProcessPoolExecutor
    from multiprocessing import active_children, get_context

    others = active_children()
    # Forked workers inherit caches and compiled kernels; macOS and Windows cannot fork safely.
    context = get_context("fork" if sys.platform == "linux" else "spawn")
    pool = ProcessPoolExecutor(n, context, _end_with_parent) if client is None else client.get_executor(pure=False)
    try:
        yield pool
    except BaseException:
        for child in set(active_children()).difference(others) if client is None else ():
            child.terminate()
        pool.shutdown(wait=False)  # on a cluster this cancels what is pending
        raise
    pool.shutdown()


@one_blas_thread()
def _result(function: Callable[[Item], Result], item: Item) -> Result:
    """`function(item)`, here or in a worker, whose processes have the cores to themselves."""
    return function(item)


def completed(
    function: Callable[[Item], Result], items: Iterable[Item], executor: Executor | None, *, first_here: bool = False
) -> Iterator[tuple[int, Result]]:
    """(index, result) of each item as it completes. Function and items must be picklable unless `executor` is None.

    With `first_here` the first item runs in this process, so that forked workers inherit what it compiles. Raises the
    error of the first item that fails; and InputError where a process dies.
    """
    todo = list(items)
    here = len(todo) if executor is None else int(first_here and CLIENT.get() is None)
    for i, item in enumerate(todo[:here]):
        yield i, _result(function, item)
    if executor is None or here == len(todo):
        return
    futures = {executor.submit(_result, function, item): i for i, item in enumerate(todo[here:], here)}
    try:
        for future in as_completed(futures):
            yield futures[future], future.result()
    except Exception as error:
        if isinstance(error, BrokenExecutor | CancelledError) or type(error).__name__ == "KilledWorker":
            sleep(ORDER)
            remedy = f"run again with fewer processes ({VARIABLE}), a sweep --to a file continues from it"
            raise InputError(f"a worker process was killed, by the system where memory is short: {remedy}") from None
        raise


def map_processes(
    function: Callable[[Item], Result],
    items: Iterable[Item],
    progress: Callable[[int], None] = lambda done: None,
    max_workers: int | None = None,
) -> list[Result]:
    """`[function(item) for item in items]` by `workers`; `progress` is called with the index of each that completes.

    The first item runs in this process. Raises what `workers` and `completed` raise.
    """
    todo, results = list(items), dict[int, Result]()
    with workers(len(todo) - 1, max_workers) as executor:
        for i, result in completed(function, todo, executor, first_here=True):
            results[i] = result
            progress(i)
    return [results[i] for i in range(len(todo))]


def versions() -> dict[str, str]:
    """Versions of Python and of the packages on which the digits of a result depend."""
    from importlib.metadata import version
    from platform import python_version

    from verify import __version__

    packages = {name: version(name) for name in ("numpy", "scipy", "numba", "scikit-fem")}
    return {"verify": __version__, "Python": python_version(), **packages}
