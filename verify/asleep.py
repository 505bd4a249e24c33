"""Parts of Python, numpy, scipy and scikit-fem that others import and hardly a command looks into: asleep until then.

`import scipy` reaches for everything that numpy has, its test tools and Fortran tools among it, which is longer than
all of numpy; each module of scikit-fem for every solver that scipy has. The command line leaves them unread: a module
is there under its name, and is read when anybody first looks into it (the standard library's `LazyLoader`), or, of
those that are imported again without being looked into, when anybody first asks for a name that it does not have.
A package that only gathers names hands on its modules, and some names from their homes, without being read.
`import verify` does nothing of the kind to whoever imports it.
"""

import os
import sys
from collections.abc import Mapping
from types import ModuleType
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from collections.abc import Iterator, Sequence
    from importlib.abc import Loader
    from importlib.machinery import ModuleSpec

    Homes = Mapping[str, str]
    """By name: the module below a package that has it, or another module, a colon and what it is there."""

GATHERS: "dict[str, Homes]" = {
    "numpy.polynomial": {},
    "scipy._lib.array_api_compat.numpy": {},  # all of numpy's
    "scipy.linalg": {
        **dict.fromkeys(("solve_banded", "solve_triangular", "solveh_banded"), "_basic"),
        **dict.fromkeys(("eig", "eigh"), "_decomp"),
        **dict.fromkeys(("lu_factor", "lu_solve"), "_decomp_lu"),
        "LinAlgError": "_misc",
        "cholesky": "_decomp_cholesky",
        "get_lapack_funcs": "lapack",
    },
    "scipy.sparse.linalg": {
        **dict.fromkeys(("MatrixRankWarning", "splu", "spsolve"), "_dsolve.linsolve"),
        **dict.fromkeys(("ArpackNoConvergence", "eigs", "eigsh"), "_eigen.arpack.arpack"),
        **dict.fromkeys(("LinearOperator", "aslinearoperator"), "_interface"),
        **dict.fromkeys(("cg", "gmres"), "_isolve.iterative"),
    },
    **{f"scipy.sparse.linalg.{part}": {} for part in ("_dsolve", "_eigen", "_eigen.arpack", "_isolve")},
    "scipy._lib.array_api_extra": {},
    "scipy.sparse": {
        **{name: f"_{name[:3]}" for name in ("coo_array", "coo_matrix", "csc_array", "csc_matrix", "csr_array")},
        **dict.fromkeys(("SparseEfficiencyWarning", "issparse", "sparray"), "_base"),
        **dict.fromkeys(("block_array", "diags_array", "eye", "eye_array", "hstack", "vstack"), "_construct"),
        "spmatrix": "_matrix",
    },
    "skfem": {},
    "skfem.assembly": {"BilinearForm": "form.bilinear_form", "CellBasis": "basis.cell_basis"},
    "skfem.assembly.basis": {
        "AbstractBasis": "abstract_basis",
        "Basis": "skfem.assembly.basis.cell_basis:CellBasis",
        "CellBasis": "cell_basis",
    },
    "skfem.assembly.form": {"Form": "form"},
    "skfem.element": {
        "BOUNDARY_ELEMENT_MAP": "verify.asleep:ELEMENTS_OF_BOUNDARIES",
        "DiscreteField": "discrete_field",
        "Element": "element",
        "ElementComposite": "element_composite",
        "ElementLineP1": "element_line.element_line_p1",
        "ElementQuad1": "element_quad.element_quad1",
        "ElementTriP1": "element_tri.element_tri_p1",
        "ElementVector": "element_vector",
    },
    **{f"skfem.element.element_{shape}": {} for shape in ("hex", "line", "quad", "tet", "tri")},
    "skfem.mapping": {"Mapping": "mapping", "MappingAffine": "mapping_affine"},
    "skfem.mesh": {"Mesh": "mesh", "Mesh2D": "mesh_2d", "Mesh3D": "mesh_3d", "MeshLine1": "mesh_line_1"},
}
"""Packages whose own file gathers names: their modules do without it. With some names' homes."""

_ANNOTATIONS = {"NDArray": "numpy:ndarray", "ArrayLike": "typing:Any"}

SPARED: "dict[str, Homes]" = {
    "numpy._core._add_newdocs": {},  # docstrings of what is compiled
    "numpy._core._add_newdocs_scalars": {},
    "numpy._typing": _ANNOTATIONS,  # which numpy.linalg and scipy write and nobody reads
    "numpy.typing": _ANNOTATIONS,
    "typing_extensions": {name: f"typing:{name}" for name in ("NotRequired", "Required", "get_type_hints")},
    "secrets": {"randbits": "verify.asleep:randbits"},  # which numpy asks for a seed where it is given none
    "pickle": {name: f"_pickle:{name}" for name in ("dumps", "loads")},
    **{name: {} for name in ("ctypes", "tokenize")},
}
"""Modules that are imported again by those who do without them. With what stands for some names of theirs."""

ASLEEP = {
    *GATHERS,
    *SPARED,
    *("ipaddress", "pydoc", "shutil", "subprocess"),
    *(f"numpy.{part}" for part in ("char", "core", "ctypeslib", "f2py", "fft", "ma", "rec", "strings", "testing")),
    "scipy.sparse.csgraph",
}
"""Packages and modules by the names that others import them by."""


class Unread(ModuleType):
    """One of `SPARED`: there, and not read."""

    def __getattr__(self, name: str) -> Any:
        """What it has under a name: from its home where that is known, else once it is read."""
        if name == "__path__":  # as `from` asks of what may be a package
            raise AttributeError(f"module {self.__name__!r} is no package")
        from contextlib import suppress
        from importlib import import_module

        if home := (GATHERS | SPARED)[self.__name__].get(name):
            module, _, there = home.partition(":")
            with suppress(ImportError, AttributeError):  # in another version it is elsewhere
                return getattr(import_module(module if there else f"{self.__name__}.{module}"), there or name)
        return self._read(name)

    def _read(self, name: str) -> Any:
        self.__class__ = ModuleType  # type: ignore[assignment]
        assert self.__spec__ is not None
        assert self.__spec__.loader is not None
        self.__spec__.loader.exec_module(self)
        return getattr(self, name)


class Gathering(Unread):
    """One of `GATHERS`: its modules are imported by their names, any other name reads it."""

    def _read(self, name: str) -> Any:
        """A module of it; else what it has under a name once it is read. It gathers nothing private."""
        from importlib import import_module
        from importlib.machinery import PathFinder

        if PathFinder.find_spec(f"{self.__name__}.{name}", self.__path__) is not None:
            return import_module(f"{self.__name__}.{name}")
        if name.startswith("_") and not name.endswith("__"):  # as a module asks that may lie beside it or not
            raise AttributeError(f"module {self.__name__!r} has no attribute {name!r}")
        return super()._read(name)


def randbits(k: int) -> int:
    """As `secrets.randbits`, without what else it reads: a number of so many bits that nobody foresees."""
    return int.from_bytes(os.urandom((k + 7) // 8), "big") >> (-k % 8)


class LateMap(Mapping[Any, Any]):
    """A mapping that a package of `GATHERS` makes of all that it gathers: made when anybody looks into it."""

    def __init__(self, package: str, name: str) -> None:
        self.package, self.name = package, name

    def _all(self) -> Any:
        from importlib import import_module

        package = import_module(self.package)
        if isinstance(package, Unread):
            package._read("__all__")
        return vars(package)[self.name]

    def __getitem__(self, key: Any) -> Any:
        return self._all()[key]

    def __iter__(self) -> "Iterator[Any]":
        return iter(self._all())

    def __len__(self) -> int:
        return len(self._all())


ELEMENTS_OF_BOUNDARIES = LateMap("skfem.element", "BOUNDARY_ELEMENT_MAP")
"""Asked for where a mesh is made, and looked into where it is curved or solid."""


class Later:
    """The loader of these: leaves them unread, and gives way to Python's own."""

    def __init__(self, loader: "Loader") -> None:
        self.loader = loader

    def create_module(self, spec: "ModuleSpec") -> ModuleType | None:
        """As Python's own loader makes it."""
        return self.loader.create_module(spec)

    def exec_module(self, module: ModuleType) -> None:
        """Nothing yet."""
        assert module.__spec__ is not None
        module.__spec__.loader = module.__loader__ = self.loader
        module.__class__ = Gathering if module.__name__ in GATHERS else Unread


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
            mine = name in GATHERS or name in SPARED
            spec.loader = (Later if mine else LazyLoader)(spec.loader)  # type: ignore[assignment]
        return spec


def put_to_sleep() -> None:
    """From now on, in this process; once is enough."""
    if Sleepers not in sys.meta_path:
        sys.meta_path.insert(0, Sleepers)
