"""How kernels are compiled: by numba, once, and anew when any kernel of their room has been edited.

What numba keeps on disk bears the stamp of the file a function stands in, though what that function calls is compiled
into it: an edit in another file would go unseen. So the stamp here is that of all kernels of the room, with the records
they read; a kernel imports from there alone (`tests/test_imports.py`). Where numba's index has no stamp to put it on,
nothing is kept on disk.
"""

from collections.abc import Callable
from functools import cache, partial
from hashlib import sha256
from pathlib import Path
from typing import Any, TypeVar

from numba import njit

Function = TypeVar("Function", bound=Callable[..., Any])


ALWAYS = {"error_model": "numpy", "no_cfunc_wrapper": True}


def compiled(**options: Any) -> Callable[[Function], Function]:
    """Compile with these options of numba; what is kept on disk holds while the room's kernels stay as they are."""

    def compile_one(function: Function) -> Function:
        found = njit(cache=True, **{**ALWAYS, **options})(function)
        index: Any = getattr(getattr(found, "_cache", None), "_cache_file", None)
        if not hasattr(index, "_source_stamp"):
            return njit(**{**ALWAYS, **options})(function)  # type: ignore[no-any-return]
        index._source_stamp = index._source_stamp, room_stamp(Path(function.__code__.co_filename).parent)
        return found  # type: ignore[no-any-return]

    return compile_one


@cache
def room_stamp(room: Path) -> str:
    """What the room's kernels and records say, as one number."""
    sources = sorted([*room.glob("*kernels.py"), *room.glob("*records.py")])
    return sha256(b"\0".join([one.name.encode() + b"\0" + one.read_bytes() for one in sources])).hexdigest()


lean = partial(compiled, _nrt=False)
"""For kernels that allocate nothing: without numba's memory runtime no loop counts references, twice the speed."""
part = partial(lean, no_cpython_wrapper=True)
"""For kernels that kernels alone call."""
FAST = {"reassoc", "contract", "nsz"}
"""What sums over modes may do with their order."""
