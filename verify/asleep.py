"""Parts of numpy and scipy that others import and hardly a command looks into: they stay asleep until one does.

`import scipy` reaches for everything that numpy has, its test tools and Fortran tools among it, which is longer than
all of numpy. The command line leaves them unread by the standard library's `LazyLoader`: a module is there under its
name, and is read when anybody first looks into it. `import verify` does nothing of the kind to whoever imports it.
"""

import sys
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Sequence
    from importlib.machinery import ModuleSpec
    from types import ModuleType

ASLEEP = frozenset(
    {
        *(f"numpy.{part}" for part in ("char", "core", "ctypeslib", "f2py", "fft", "ma", "polynomial")),
        *(f"numpy.{part}" for part in ("rec", "strings", "testing", "typing")),
        "scipy.linalg",
        "scipy.sparse.csgraph",
        "scipy.sparse.linalg",
    }
)
"""Packages and modules by the names that others import them by."""


class Sleepers:
    """Finds what `ASLEEP` names, as Python's own finder does, and leaves it unread: for `sys.meta_path`."""

    @staticmethod
    def find_spec(
        name: str, path: "Sequence[str] | None" = None, target: "ModuleType | None" = None
    ) -> "ModuleSpec | None":
        """The module, to be read when it is first looked into; None for all others."""
        if name not in ASLEEP:
            return None
        from importlib.machinery import PathFinder
        from importlib.util import LazyLoader

        spec = PathFinder.find_spec(name, path, target)
        if spec is not None and spec.loader is not None:
            spec.loader = LazyLoader(spec.loader)
        return spec


def put_to_sleep() -> None:
    """From now on, in this process; once is enough."""
    if Sleepers not in sys.meta_path:
        sys.meta_path.insert(0, Sleepers)
