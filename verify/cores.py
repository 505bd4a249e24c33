"""Independent work shared among the cores: the same results, to the last digit and in the same order."""

import os
import pickle
import select
import signal
import sys
from collections.abc import Callable, Iterable, Iterator, Sequence
from contextlib import contextmanager, suppress
from typing import BinaryIO, NoReturn, TypeVar

from verify.errors import InputError

VARIABLE = "VERIFY_JOBS"
"""The environment variable that says how many processes work; one where it is not set, as in Python."""
Item = TypeVar("Item")
Result = TypeVar("Result")


def jobs() -> int:
    """How many processes work. Raises InputError where the variable is no whole number above 0."""
    given = os.environ.get(VARIABLE, "") or "1"
    if not (given.isascii() and given.isdigit() and int(given)):
        raise InputError(f"{VARIABLE} = {given!r}: give a whole number of processes from 1, or leave it unset")
    return int(given)


def for_each(work: Callable[[Item], Result], items: Sequence[Item], tell: Callable[[int], None]) -> list[Result]:
    """`work` of every item, in their order; `tell` hears of each how many there are with it.

    The first is done here, so that what is compiled and kept for it is there for all; the others by `jobs` processes
    where there are several and the system forks safely (Linux), else here too. What a process that dies leaves undone
    is done here. Raises what `work` raises of the first item that it refuses.
    """
    n = min(jobs(), len(items) - 1)
    if n < 2 or sys.platform != "linux":
        return [_told(tell, number, work(item)) for number, item in enumerate(items, 1)]
    found: dict[int, Result | Exception] = {0: _told(tell, 1, work(items[0]))}
    children: dict[int, tuple[int, BinaryIO]] = {}
    try:
        for part in range(n):
            share = range(1 + part, len(items), n)
            _begin(work, items, share, children)
        _gather(children, found, tell)
    finally:
        _end(children)
    return _in_order(work, items, found, tell)


def at_once(work: Callable[[Item], Result], items: Sequence[Item]) -> list[Result]:
    """`work` of every item, in their order: a share here, the others in `jobs` - 1 processes, likewise (`for_each`).

    Who works here does not listen meanwhile, and a pipe holds 64 kB: each process sends what it found when it is done.
    """
    n = min(jobs(), len(items))
    if n < 2 or sys.platform != "linux":
        return [work(item) for item in items]
    found: dict[int, Result | Exception] = {}
    children: dict[int, tuple[int, BinaryIO]] = {}
    _give_back()
    try:
        for part in range(1, n):
            _begin(work, items, range(part, len(items), n), children, at_end=True)
        for index in range(0, len(items), n):
            try:
                found[index] = work(items[index])
            except Exception as error:
                found[index] = error
                break
        _gather(children, found, lambda _: None)
    finally:
        _end(children)
    return _in_order(work, items, found, lambda _: None)


def _give_back() -> None:
    """Give what has been freed back to the system, where the C library can: after a fork both copy it page by page.

    They would as soon as they took it anew, 30 MB of it in a sweep, and be a quarter longer for that.
    """
    from ctypes import CDLL

    with suppress(OSError, AttributeError):
        CDLL(None).malloc_trim(0)


def _in_order(
    work: Callable[[Item], Result],
    items: Sequence[Item],
    found: dict[int, Result | Exception],
    tell: Callable[[int], None],
) -> list[Result]:
    """What was found of all items; what is missing is done here. Raises what `work` raised of the first."""
    for index, item in enumerate(items):
        if index not in found:
            found[index] = _told(tell, len(found) + 1, work(item))
        if isinstance(failed := found[index], Exception):
            raise failed
    return [found[index] for index in range(len(items))]  # type: ignore[misc]


def _told(tell: Callable[[int], None], number: int, result: Result) -> Result:
    tell(number)
    return result


def start(work: Callable[[], NoReturn], keep: Callable[[int], None]) -> None:
    """`work` in a process of its own, whose number `keep` hears.

    A request to end waits until then. While a process begins, libraries that asked to be told of it (logging, for one)
    have functions of theirs called, and what a handler of signals raises in these is printed and lost; and a process
    of which nobody has heard would stay behind. What was written and not yet sent off is sent off first, or the new
    process would write it again.
    """
    for stream in (sys.stdout, sys.stderr):
        with suppress(OSError, ValueError, AttributeError):
            stream.flush()
    told: list[int] = []
    with _heard_later(told):
        if child := os.fork():
            keep(child)
    if not child:
        work()
    for number in told:
        signal.raise_signal(number)


@contextmanager
def _heard_later(told: list[int]) -> Iterator[None]:
    """Requests to end are noted, and what answers them is put back in the end."""
    from threading import current_thread, main_thread

    asked = {signal.SIGINT, signal.SIGTERM, getattr(signal, "SIGHUP", signal.SIGTERM)}
    before = {number: signal.getsignal(number) for number in asked if current_thread() is main_thread()}
    before = {number: answer for number, answer in before.items() if answer is not None}
    for number in before:
        signal.signal(number, lambda number, _: told.append(number))
    try:
        yield
    finally:
        for number, answer in before.items():
            signal.signal(number, answer)


def _begin(
    work: Callable[[Item], Result],
    items: Sequence[Item],
    share: Sequence[int],
    children: dict[int, tuple[int, BinaryIO]],
    *,
    at_end: bool = False,
) -> None:
    """A process that does its share and writes every result, or its first refusal, among `children` by its pipe.

    As they come, or all `at_end`.
    """
    reading, writing = os.pipe()
    others = [reading, *(pipe.fileno() for _, pipe in children.values())]

    def done() -> NoReturn:
        for pipe in others:
            os.close(pipe)
        _write(_results(work, items, share), writing, at_end=at_end)

    start(done, lambda child: children.update({reading: (child, os.fdopen(reading, "rb"))}))
    os.close(writing)


def _results(
    work: Callable[[Item], Result], items: Sequence[Item], share: Sequence[int]
) -> Iterator[tuple[int, Result | Exception]]:
    """By index, up to the first refusal."""
    for index in share:
        try:
            result = work(items[index])
        except Exception as error:
            yield index, error
            return
        yield index, result


def _write(results: Iterable[tuple[int, Result | Exception]], writing: int, *, at_end: bool) -> NoReturn:
    """In the child: nothing of the parent's is flushed, closed or told at its end."""
    try:
        with os.fdopen(writing, "wb") as pipe:
            for result in list(results) if at_end else results:
                pickle.dump(result, pipe)
                pipe.flush()
    finally:
        os._exit(0)


def _gather(
    children: dict[int, tuple[int, BinaryIO]], found: dict[int, Result | Exception], tell: Callable[[int], None]
) -> None:
    """Take results as they come, until every process has closed its pipe."""
    left = set(children)
    while left:
        for ready in select.select(left, [], [])[0]:
            try:
                index, result = pickle.load(children[ready][1])
            except (EOFError, pickle.UnpicklingError):
                left.remove(ready)
                continue
            found[index] = _told(tell, len(found) + 1, result)


def _end(children: dict[int, tuple[int, BinaryIO]]) -> None:
    """None is left behind, whatever happened."""
    for child, pipe in children.values():
        pipe.close()
        with suppress(ProcessLookupError):
            os.kill(child, signal.SIGTERM)
        with suppress(ChildProcessError):
            os.waitpid(child, 0)
