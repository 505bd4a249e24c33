"""Kernels that a run will ask for, compiled by other processes while it compiles the first of them.

Where a kernel that is planned is not on disk helpers begin at once, and in a run that finds all of them none. They go
through what is planned from the longest on; what they compile stands in numba's cache on disk. The run does meanwhile
what needs no kernel that is missing, then compiles itself what nobody has begun. Who compiles a kernel holds a lock on
its byte of a file without a name, which the system gives back when a process ends: nobody waits for the dead, and
nothing is compiled twice. The byte tells what is done.
"""

import gc
import os
import pickle
import signal
import sys
from collections.abc import Callable, Iterable, Iterator, Sequence
from contextlib import contextmanager, suppress
from functools import cache
from math import log
from typing import Any, NoReturn, Protocol

from verify.cores import jobs, start
from verify.models import compiling
from verify.models.compiling import Call

Typed = tuple[Any, tuple[Any, ...]]
"""A kernel and the types of what it is called with."""
END_WITH_PARENT = 1
"""Of prctl, Linux."""
MOST = 4
"""Helpers; there are no more kernels than would keep these busy."""


DONE, WANTED = b"1", b"2"
"""What stands at a kernel that is on disk, and at one that the run is about to ask for."""
ALIKE = 1.25
"""Ratio of lengths that say nothing about which of two compilations is the longer."""
READY, FREE, BEGUN = range(3)
"""All there; nobody compiles what is missing; somebody else does."""


class Ahead(Protocol):
    """What is known of kernels that are compiled ahead."""

    def first_ready(self, waiting: Sequence[int], needed: Callable[[int], Iterable[Call]]) -> int:
        """Which of those that wait should be done first, by the kernels that each needs."""


class _Alone:
    """Nobody compiles ahead."""

    def first_ready(self, waiting: Sequence[int], needed: Callable[[int], Iterable[Call]]) -> int:
        """The first."""
        return waiting[0]


@contextmanager
def compiled_ahead(planned: Callable[[], Iterable[Call]]) -> Iterator[Ahead]:
    """Where a kernel is missing in the meantime, have other processes compile what is `planned`.

    What is planned twice is compiled once. What is yielded tells what to do first.

    As many as `jobs` says, and none where the system does not fork safely (all but Linux). None is left at the end,
    whatever happens; what they compiled is in `compiling.compiled`. Raises InputError for a wrong number of jobs.
    """
    n = min(jobs() - 1, MOST)
    if n < 1 or sys.platform != "linux" or compiling.absent is not None:
        yield _Alone()
        return
    crew = _Crew(planned, n)
    compiling.absent, compiling.kept = crew.absent, crew.keeping
    try:
        crew.begin()
        yield crew
    finally:
        compiling.absent, compiling.kept = None, compiling.keep_alone
        crew.end()


class _Crew:
    """The processes that help one, and what they share."""

    def __init__(self, planned: Callable[[], Iterable[Call]], n: int) -> None:
        self.planned, self.n, self.owner = planned, n, os.getpid()
        self.calls: list[Typed] = []
        self.locks = -1
        """A byte for every call, and one more for who writes."""
        self.needs: dict[int, tuple[int, ...]] = {}
        """Numbers of the calls that those who wait need."""
        self.helpers: list[tuple[int, int]] = []
        """Process and the reading end of its pipe."""

    def begin(self) -> None:
        """Where a kernel is missing, have helpers begin."""
        self.calls = list(dict.fromkeys(map(_typed, self.planned())))  # each once
        if not compiling.unkept and not all(map(_is_kept, self.calls)):
            self.locks = os.memfd_create("kernels")
            self._start()

    def absent(self, kernel: Any, types: Any) -> bool:
        """Wait until nobody else compiles a kernel that is not on disk; whether it is worth another look there."""
        if self.locks < 0:
            return False
        found = [i for i, call in enumerate(self.calls) if call[0] is kernel and call[1] == tuple(types)]
        if not found:
            return False
        if not self._claimed(found[0]):
            for hear in compiling.hearers:
                hear(compiling.COMPILING)
            self._lock(found[0], os.F_LOCK)
            for hear in compiling.hearers:
                hear("")
        return True

    def first_ready(self, waiting: Sequence[int], needed: Callable[[int], Iterable[Call]]) -> int:
        """The first whose kernels are all there, else the one that misses least of what nobody compiles.

        The longest is left to helpers, who are free in the meantime. Where others compile what all of them need, what
        nobody has begun is compiled meanwhile.
        """
        if self.locks < 0:
            return waiting[0]
        while True:
            states = [max(map(self._state, self._needs(one, needed)), default=READY) for one in waiting]
            if min(states) < BEGUN or not self._compiled_one():
                alike = [one for one, state in zip(waiting, states, strict=True) if state == min(states)]
                one = min(alike, key=lambda one: self._missing(self._needs(one, needed)))
                self._want(self._needs(one, needed))
                return one

    def _want(self, indices: Iterable[int]) -> None:
        """Have helpers begin these last: the run itself is about to."""
        for index in indices:
            if self._state(index) == FREE:
                os.pwrite(self.locks, WANTED, index)

    def _needs(self, one: int, needed: Callable[[int], Iterable[Call]]) -> tuple[int, ...]:
        if one not in self.needs:
            self.needs[one] = self._numbers(needed(one))
        return self.needs[one]

    def _missing(self, indices: Iterable[int]) -> tuple[int, int]:
        """How many of these nobody has begun, and their length."""
        lengths = [_length(self.calls[index][0]) for index in indices if self._state(index) == FREE]
        return len(lengths), sum(lengths)

    def _numbers(self, calls: Iterable[Call]) -> tuple[int, ...]:
        """Of these calls."""
        asked = set(map(_typed, calls))
        return tuple(i for i, call in enumerate(self.calls) if call in asked)

    def _state(self, index: int) -> int:
        """Of a kernel."""
        if os.pread(self.locks, 1, index) == DONE:
            return READY
        try:
            self._lock(index, os.F_TEST)
        except OSError:
            return BEGUN
        return FREE

    def _compiled_one(self) -> bool:
        """Compile what nobody has begun; whether there was any."""
        free = [index for index in range(len(self.calls)) if self._state(index) == FREE]
        return any(self._made(index) for index in free)

    def _made(self, index: int) -> bool:
        """Compile this, unless somebody else has begun."""
        if not self._claimed(index):
            return False
        kernel, types = self.calls[index]
        kernel.compile(types)
        self._done(index)
        return True

    def _done(self, index: int) -> None:
        os.pwrite(self.locks, DONE, index)
        self._give_back(index)

    def _claimed(self, index: int) -> bool:
        """Whether nobody else compiles this, from here on."""
        try:
            self._lock(index, os.F_TLOCK)
        except OSError:
            return False
        return True

    def _give_back(self, index: int) -> None:
        self._lock(index, os.F_ULOCK)

    def _lock(self, index: int, how: int) -> None:
        """On the byte of a call. Raises OSError where another process has it and `how` does not wait."""
        os.lseek(self.locks, index, os.SEEK_SET)
        os.lockf(self.locks, how, 1)

    @contextmanager
    def keeping(self, kernel: Any, types: Any) -> Iterator[None]:
        """One writes at a time, to its end: numba's index of a kernel is read, added to and written."""
        if self.locks < 0:
            yield
            return
        before = signal.pthread_sigmask(signal.SIG_BLOCK, {signal.SIGTERM})
        try:
            self._lock(len(self.calls), os.F_LOCK)
            yield
        finally:
            self._give_back(len(self.calls))
            for index, call in enumerate(self.calls):
                if call[0] is kernel and call[1] == tuple(types):
                    self._done(index)
            signal.pthread_sigmask(signal.SIG_SETMASK, before)

    def _start(self) -> None:
        for _ in range(min(self.n, len(self.calls) - 1)):
            self._start_one()

    def _start_one(self) -> None:
        reading, writing = os.pipe()
        start(lambda: self._help(writing), lambda child: self.helpers.append((child, reading)))
        os.close(writing)

    def _help(self, writing: int) -> NoReturn:
        """In a helper: compile what nobody has begun, and tell at each what it took."""
        try:
            signal.signal(signal.SIGINT, signal.SIG_IGN)  # whoever started it ends it
            signal.signal(signal.SIGTERM, signal.SIG_DFL)
            from ctypes import CDLL

            CDLL(None).prctl(END_WITH_PARENT, signal.SIGTERM)
            if os.getppid() != self.owner:
                os._exit(0)
            gc.disable()
            compiling.hearers.clear()
            left = self._longest_first()
            while left := [index for index in left if self._state(index) == FREE]:
                compiling.compiled.clear()
                if self._made(self._choice(left)):
                    os.write(writing, pickle.dumps(compiling.compiled))
        finally:
            os._exit(0)

    def _choice(self, left: Sequence[int]) -> int:
        """The first that the run is not about to ask for, else the last."""
        return next((index for index in left if os.pread(self.locks, 1, index) != WANTED), left[-1])

    def _longest_first(self) -> list[int]:
        """Numbers of the calls; of those about as long the last comes first, since the run begins at the other end.

        One kernel's other types come after all kernels: they share parts with its first.
        """
        kernels = [kernel for kernel, _ in self.calls]
        size = {kernel: -round(log(_length(kernel), ALIKE)) for kernel in kernels}
        return sorted(range(len(kernels)), key=lambda i: (kernels[i + 1 :].count(kernels[i]), size[kernels[i]], -i))

    def end(self) -> None:
        """End the helpers, and hear what they did."""
        if os.getpid() != self.owner:
            return
        for child, _ in self.helpers:
            with suppress(ProcessLookupError):
                os.kill(child, signal.SIGTERM)
        for child, reading in self.helpers:
            with suppress(ChildProcessError):
                os.waitpid(child, 0)
            with os.fdopen(reading, "rb") as pipe, suppress(EOFError, pickle.UnpicklingError):
                while True:
                    compiling.compiled.extend(pickle.load(pipe))
        if self.locks >= 0:
            os.close(self.locks)


def _typed(call: Call) -> Typed:
    kernel, given = call
    return kernel, tuple(map(kernel.typeof_pyval, given))


def _is_kept(call: Typed) -> bool:
    """Whether a kernel stands in numba's index on disk; one of which a later numba does not tell is taken for kept."""
    kernel, types = call
    try:
        index, key = kernel._cache._cache_file, kernel._cache._index_key(types, kernel.targetctx.codegen())
        return key in index._load_index()
    except AttributeError:
        return True
    except Exception:  # whatever a damaged pickle raises
        return False


@cache
def _length(kernel: Any) -> int:
    """Bytes of Python in a kernel and its parts: what its compilation takes goes by them."""
    return sum(len(one.__code__.co_code) for one in _with_parts(kernel.py_func, {}))


def _with_parts(function: Any, found: dict[Any, None]) -> dict[Any, None]:
    """A function and those that it calls, and so on, each once."""
    if function not in found:
        found[function] = None
        for name in function.__code__.co_names:
            part = getattr(function.__globals__.get(name), "py_func", None)
            if part is not None:
                _with_parts(part, found)
    return found
