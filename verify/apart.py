"""Pieces of work in processes of their own, as many at once as there are cores; what one of them breaks is its own."""

import os
import signal
import sys
from collections.abc import Callable, Sequence
from contextlib import suppress
from functools import partial
from multiprocessing.connection import Connection
from typing import NoReturn, TypeVar

import msgspec

from verify.cores import jobs, start

Item = TypeVar("Item")
Result = TypeVar("Result")
Words = TypeVar("Words")


class Died(msgspec.Struct, frozen=True):
    """What is known of a process that ended before its work did."""

    status: int
    """Its exit status, or the number of the signal that ended it, negative."""


class _Running(msgspec.Struct, frozen=True):
    index: int
    process: int


def each_apart(
    work: Callable[[Item, Callable[[Words], None]], Result], items: Sequence[Item], hear: Callable[[int, Words], None]
) -> list[Result | Died]:
    """`work` of every item, begun in their order; what it says on the way reaches `hear` with the item's number.

    Each is a process where the system forks safely (Linux) and `jobs` is above 1, else they are done here, one after
    the other. `work` raises nothing: an exception would be a process that died. Of the processes none is left behind.
    """
    n = min(jobs(), len(items))
    if n < 2 or sys.platform != "linux":
        return [work(item, partial(hear, index)) for index, item in enumerate(items)]
    found: dict[int, Result | Died] = {}
    running: dict[Connection, _Running] = {}
    waiting = list(enumerate(items))[::-1]
    try:
        while waiting or running:
            while waiting and len(running) < n:
                _begin(work, *waiting.pop(), running)
            _hear(running, found, hear)
    finally:
        _end(running)
    return [found[index] for index in range(len(items))]


def _begin(
    work: Callable[[Item, Callable[[Words], None]], Result], index: int, item: Item, running: dict[Connection, _Running]
) -> None:
    """A process that does one item, among those that run by the pipe on which it speaks."""
    from multiprocessing import Pipe

    reading, writing = Pipe(duplex=False)
    others = [reading, *running]

    def done() -> NoReturn:
        for pipe in others:
            pipe.close()
        _work(work, item, writing)

    start(done, lambda child: running.update({reading: _Running(index, child)}))
    writing.close()


def _work(work: Callable[[Item, Callable[[Words], None]], Result], item: Item, writing: Connection) -> NoReturn:
    """In the child: nothing of the parent's is flushed, closed or told at its end."""
    status = 1
    try:
        result = work(item, lambda words: writing.send((False, words)))
        writing.send((True, result))
        status = 0
    finally:
        os._exit(status)


def _hear(
    running: dict[Connection, _Running], found: dict[int, Result | Died], hear: Callable[[int, Words], None]
) -> None:
    """Take what is said until a process is done or has died."""
    from multiprocessing.connection import wait

    n = len(running)
    while len(running) == n:
        for pipe in wait(list(running)):
            assert isinstance(pipe, Connection)
            index = running[pipe].index
            try:
                done, said = pipe.recv()
            except (EOFError, OSError):
                child = running.pop(pipe).process
                pipe.close()
                status = os.waitstatus_to_exitcode(os.waitpid(child, 0)[1])
                found.setdefault(index, Died(status))
                continue
            if done:
                found[index] = said
            else:
                hear(index, said)


def _end(running: dict[Connection, _Running]) -> None:
    """None is left behind, whatever happened."""
    for pipe, one in running.items():
        pipe.close()
        with suppress(ProcessLookupError):
            os.kill(one.process, signal.SIGTERM)
        with suppress(ChildProcessError):
            os.waitpid(one.process, 0)
