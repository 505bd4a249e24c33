"""Parts of Python, numpy, scipy and scikit-fem that others import and hardly a command looks into: asleep until then.

`import scipy` reaches for everything that numpy has, its test tools and Fortran tools among it, which is longer than
all of numpy; each module of scikit-fem for every solver that scipy has. The command line leaves them unread: a module
is there under its name, and is read when anybody first looks into it (the standard library's `LazyLoader`), or, of a
package that only gathers the names of its modules, when anybody first asks for a name that is no module of it.
`import verify` does nothing of the kind to whoever imports it.
"""

import sys
from types import ModuleType
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from collections.abc import Sequence
    from importlib.abc import Loader
    from importlib.machinery import ModuleSpec

GATHERS = frozenset({"scipy.linalg", "skfem"})
"""Packages whose own file gathers names and does nothing else: their modules do without it."""

ASLEEP = GATHERS | {
    *("ipaddress", "pydoc", "shutil", "subprocess"),
    *(f"numpy.{part}" for part in ("char", "core", "ctypeslib", "f2py", "fft", "ma", "polynomial")),
    *(f"numpy.{part}" for part in ("rec", "strings", "testing", "typing")),
    "scipy.sparse.csgraph",
    "scipy.sparse.linalg",
}
"""Packages and modules by the names that others import them by."""


class Gathering(ModuleType):
    """A package that is there and not read: its modules are imported by their names, any other name reads it."""

    def __getattr__(self, name: str) -> Any:
        """A module of it; else what it has under a name once it is read. It gathers nothing private."""
        from importlib import import_module
        from importlib.machinery import PathFinder

        if PathFinder.find_spec(f"{self.__name__}.{name}", self.__path__) is not None:
            return import_module(f"{self.__name__}.{name}")
        if name.startswith("_") and not name.endswith("__"):  # as a module asks that may lie beside it or not
            raise AttributeError(f"module {self.__name__!r} has no attribute {name!r}")
        self.__class__ = ModuleType  # type: ignore[assignment]
        assert self.__spec__ is not None
        assert self.__spec__.loader is not None
        self.__spec__.loader.exec_module(self)
        return getattr(self, name)


class Later:
    """The loader of such a package: leaves it unread, and gives way to Python's own."""

    def __init__(self, loader: "Loader") -> None:
        self.loader = loader

    def create_module(self, spec: "ModuleSpec") -> ModuleType | None:
        """As Python's own loader makes it."""
        return self.loader.create_module(spec)

    def exec_module(self, module: ModuleType) -> None:
        """Nothing yet."""
        assert module.__spec__ is not None
        module.__spec__.loader = module.__loader__ = self.loader
        module.__class__ = Gathering


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
            spec.loader = (Later if name in GATHERS else LazyLoader)(spec.loader)  # type: ignore[assignment]
        return spec


def put_to_sleep() -> None:
    """From now on, in this process; once is enough."""
    if Sleepers not in sys.meta_path:
        sys.meta_path.insert(0, Sleepers)
