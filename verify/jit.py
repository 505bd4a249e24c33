"""Numba options of all kernels: `jit` for a kernel called from Python, `inline` and `once` for those called by kernels.

Numba optimises a function again in each of its callers, and compiles it again for every constant integer or truth value
among its arguments. So `once` stands where one place calls a function, and kernels pass such values in variables.
Kernels allocate nothing, so numba's reference counting is off (`_nrt`), which doubles the speed of a motor run.

Numba's cache checks the file of the entry point alone, while all that it calls is compiled into it. So the name of the
cache folder has a digest of all kernel modules. It is in `NUMBA_CACHE_DIR` or, by default, in this package; where
neither is writable, numba's user-wide cache or none is used.
"""

from collections.abc import Callable
from functools import partial
from hashlib import sha256
from pathlib import Path
from typing import Any, TypeVar, overload

from numba import config, njit

Function = TypeVar("Function", bound=Callable[..., Any])
_PACKAGE = Path(__file__).parent
_NAMES = (
    *("*/*kernels.py", "chain/*_links.py", "chain/runge_kutta.py", "contact/*.py", "dynamics/*.py"),
    "engines/slider.py",
)
_SOURCES = sorted({Path(__file__), *(source for name in _NAMES for source in _PACKAGE.glob(name))})
_DIGEST = sha256(b"".join(source.read_bytes() for source in _SOURCES)).hexdigest()[:16]
_CACHE = Path(config.CACHE_DIR or _PACKAGE / "__pycache__") / f"kernels-{_DIGEST}"  # type: ignore[attr-defined]
FAST = {"reassoc", "contract", "nsz"}  # `fastmath` of sums over modes, whose order is free


@overload  # `@inline`: the decorated function keeps its type
def inline(function: Function) -> Function: ...
@overload  # `@inline(fastmath=FAST)`: a decorator
def inline(**options: Any) -> Callable[[Function], Function]: ...
def inline(function: Any = None, **options: Any) -> Any:
    """Compile a function into the kernels that call it, with numba's `options`."""
    options = {"error_model": "numpy", "_nrt": False, "no_cpython_wrapper": True, "no_cfunc_wrapper": True, **options}
    compiled = partial(njit, **options)
    return compiled if function is None else compiled(function)


def once(function: Function) -> Function:
    """Compile a function as part of the single place that calls it, with the options of that place."""
    options: dict[str, Any] = {"error_model": "numpy", "_nrt": False, "inline": "always"}
    compiled: Function = njit(**options)(function)
    return compiled


@overload  # `@jit`: the decorated function keeps its type
def jit(function: Function) -> Function: ...
@overload  # `@jit(fastmath=FAST)`: a decorator
def jit(**options: Any) -> Callable[[Function], Function]: ...
def jit(function: Any = None, **options: Any) -> Any:
    """Compile a kernel at its first call, with numba's `options`, and cache it on disk."""
    if function is None:
        return partial(jit, **options)
    options = {"error_model": "numpy", "_nrt": False, "no_cfunc_wrapper": True, **options}
    before = config.CACHE_DIR  # type: ignore[attr-defined]
    config.CACHE_DIR = str(_CACHE)  # type: ignore[attr-defined]  # numba reads it where a function is decorated
    try:
        return njit(cache=True, **options)(function)
    except RuntimeError:  # no folder is writable
        return njit(**options)(function)
    finally:
        config.CACHE_DIR = before  # type: ignore[attr-defined]
