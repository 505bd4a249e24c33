"""What is compiled in this process, for whoever shows or counts it; numba is not loaded for that."""

from collections.abc import Callable, Iterator
from contextlib import AbstractContextManager, contextmanager, nullcontext
from typing import Any, TypeAlias

import msgspec

Call: TypeAlias = tuple[Any, tuple[Any, ...]]
"""A kernel and what it is called with."""
COMPILING = "compiling kernels, once on this machine"
AT_EVERY_RUN = (
    "kernels are compiled at every run: set NUMBA_CACHE_DIR to a folder that can be written to, then `verify warm-up`"
)


class Compiled(msgspec.Struct, frozen=True):
    """One kernel for one signature."""

    kernel: str
    """With its module: motion.kernels.slide."""
    seconds: float
    """Without those of the kernels that it calls."""


compiled: list[Compiled] = []
"""In the order in which they were ready."""
hearers: list[Callable[[str], None]] = []
"""Told what begins, and nothing, "", when it is over."""
unkept: list[str] = []
"""Kernels for which there is no folder, or none that takes what is written."""
absent: Callable[[Any, Any], bool] | None = None
"""Asked where a kernel is not on disk for these types, whether it may be there by now (`ahead`)."""


def keep_alone(kernel: Any, types: Any) -> AbstractContextManager[None]:
    """Nobody else writes."""
    return nullcontext()


kept: Callable[[Any, Any], AbstractContextManager[None]] = keep_alone
"""Around the writing of a kernel for these types."""


def told() -> tuple[str, ...]:
    """What to say at the end of a run, in sentences."""
    return (AT_EVERY_RUN,) if unkept and compiled else ()


@contextmanager
def heard(hear: Callable[[str], None]) -> Iterator[None]:
    """Tell `hear` what is compiled in the meantime."""
    hearers.append(hear)
    try:
        yield
    finally:
        hearers.remove(hear)
