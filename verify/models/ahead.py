"""Kernels that a run will ask for, compiled by other processes while it compiles the first of them.

Nothing begins before a kernel is missing, so that a run that finds all of them pays nothing. From then on the run goes
through what is planned from the front and a helper from the back, until they meet; what comes back stands in numba's
cache on disk. Who compiles a kernel holds a lock on its byte of a file without a name, which the system gives back
when a process ends: nobody waits for the dead, and nothing is compiled twice.
"""

import gc
import os
import pickle
import signal
import sys
from collections.abc import Callable, Iterable, Iterator, Sequence
from contextlib import contextmanager, suppress
from typing import Any, NoReturn

from verify.cores import jobs
from verify.models import compiling
from verify.models.compiling import Call

Typed = tuple[Any, tuple[Any, ...]]
"""A kernel and the types of what it is called with."""
END_WITH_PARENT = 1
"""Of prctl, Linux."""
MOST = 4
"""Helpers; there are no more kernels than would keep these busy."""


@contextmanager
def compiled_ahead(planned: Callable[[], Iterable[Call]]) -> Iterator[None]:
    """Where a kernel is missing in the meantime, have other processes compile what is `planned`, in order of need.

    What is planned twice is compiled once.

    As many as `jobs` says, and none where the system does not fork safely (all but Linux). None is left at the end,
    whatever happens; what they compiled is in `compiling.compiled`. Raises InputError for a wrong number of jobs.
    """
    n = min(jobs() - 1, MOST)
    if n < 1 or sys.platform != "linux" or compiling.absent is not None:
        yield
        return
    crew = _Crew(planned, n)
    compiling.absent, compiling.kept = crew.absent, crew.keeping
    try:
        yield
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
        self.helpers: list[tuple[int, int]] = []
        """Process and the reading end of its pipe."""

    def absent(self, kernel: Any, types: Any) -> bool:
        """Wait until nobody else compiles a kernel that is not on disk; whether it is worth another look there."""
        if self.locks < 0:
            if os.getpid() != self.owner or compiling.unkept:
                return False
            typed = ((one, tuple(one.typeof_pyval(value) for value in given)) for one, given in self.planned())
            self.calls = list(dict.fromkeys(typed))  # each once
            self.locks = os.memfd_create("kernels")
        found = [i for i, call in enumerate(self.calls) if call[0] is kernel and call[1] == tuple(types)]
        if not found:
            return False
        if not self._claimed(found[0]):
            for hear in compiling.hearers:
                hear(compiling.COMPILING)
            os.lseek(self.locks, found[0], os.SEEK_SET)
            os.lockf(self.locks, os.F_LOCK, 1)
            for hear in compiling.hearers:
                hear("")
        if not self.helpers and os.getpid() == self.owner:
            self._start()
        return True

    def _claimed(self, index: int) -> bool:
        """Whether nobody else compiles this, from here on."""
        os.lseek(self.locks, index, os.SEEK_SET)
        try:
            os.lockf(self.locks, os.F_TLOCK, 1)
        except OSError:
            return False
        return True

    def _give_back(self, index: int) -> None:
        os.lseek(self.locks, index, os.SEEK_SET)
        os.lockf(self.locks, os.F_ULOCK, 1)

    @contextmanager
    def keeping(self, kernel: Any, types: Any) -> Iterator[None]:
        """One writes at a time, to its end: numba's index of a kernel is read, added to and written."""
        if self.locks < 0:
            yield
            return
        before = signal.pthread_sigmask(signal.SIG_BLOCK, {signal.SIGTERM})
        try:
            os.lseek(self.locks, len(self.calls), os.SEEK_SET)
            os.lockf(self.locks, os.F_LOCK, 1)
            yield
        finally:
            self._give_back(len(self.calls))
            for index, call in enumerate(self.calls):
                if call[0] is kernel and call[1] == tuple(types):
                    self._give_back(index)
            signal.pthread_sigmask(signal.SIG_SETMASK, before)

    def _start(self) -> None:
        for stream in (sys.stdout, sys.stderr):
            with suppress(OSError, ValueError, AttributeError):
                stream.flush()
        count = len(self.calls)
        for helper in range(min(self.n, count - 1)):
            first = count - helper * count // self.n
            order = [*range(first - 1, -1, -1), *range(count - 1, first - 1, -1)]
            reading, writing = os.pipe()
            if (child := os.fork()) == 0:
                self._help(order, writing)
            os.close(writing)
            self.helpers.append((child, reading))

    def _help(self, order: Sequence[int], writing: int) -> NoReturn:
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
            compiling.begin_anew()
            for index in order:
                if not self._claimed(index):
                    continue
                compiling.compiled.clear()
                kernel, types = self.calls[index]
                kernel.compile(types)
                self._give_back(index)
                os.write(writing, pickle.dumps(compiling.compiled))
        finally:
            os._exit(0)

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
