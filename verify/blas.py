"""One thread of BLAS in public functions.

Threads do not pay on the matrices of a beam: on two cores two threads take longer than one for every public function
and for all eigenvalues of 3000 unknowns, and by orders of magnitude where other programs are running.
"""

import sys
from collections.abc import Iterator
from contextlib import contextmanager
from functools import cache
from threading import Lock
from typing import Any

_LOCK = Lock()
_open: list[list[tuple[Any, int]]] = []
"""(library, its number of threads before) for each open context: the numbers are those of the process."""


@contextmanager
def one_blas_thread() -> Iterator[None]:
    """Inside the context, or the function that it decorates, BLAS has one thread; then the number that it had before.

    Contexts may nest, and overlap in several threads: the first one to open sets the number, the last one to close
    resets it.
    """
    with _LOCK:
        before = _open[-1] if _open else [(library, library.get_num_threads()) for library in _libraries()]
        if not _open:
            _set([(library, 1) for library, _ in before])
        _open.append(before)
    try:
        yield
    finally:
        with _LOCK:
            _open.pop()
            if not _open:
                _set(before)


def _set(numbers: list[tuple[Any, int]]) -> None:
    """Set the number of threads of each library, in any thread: since 3.8 threadpoolctl ignores all but the first."""
    for library, number in numbers:
        release = getattr(library, "clear_controlling_thread", lambda *, force: None)
        release(force=True)
        library.set_num_threads(number)
        release(force=True)


def _libraries() -> list[Any]:
    """The libraries, numpy's and scipy's. One that is loaded later would have all threads, so that scipy's is loaded.

    Not where numpy's has one thread, as under the command line: the environment holds for both.
    """
    if "scipy.linalg" not in sys.modules:
        loaded = _loaded()
        if loaded and all(library.get_num_threads() == 1 for library in loaded):
            return loaded
    return _with_scipy()


@cache
def _with_scipy() -> list[Any]:
    """Found once: the search takes a millisecond, a small model less."""
    import scipy.linalg  # noqa: F401

    return _loaded()


def _loaded() -> list[Any]:
    from threadpoolctl import ThreadpoolController

    return list(ThreadpoolController().select(user_api="blas").lib_controllers)
