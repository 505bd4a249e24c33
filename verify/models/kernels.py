"""How kernels are compiled: by numba, once, and anew when any kernel of their room has been edited.

What numba keeps on disk bears the stamp of the file a function stands in, though what that function calls is compiled
into it: an edit in another file would go unseen. So the stamp here is that of all kernels of the room, with the records
they read; a kernel imports from there alone (`tests/test_imports.py`). Where numba's index has no stamp to put it on,
nothing is kept on disk; where no folder takes what is kept, kernels are compiled anew and `compiling` knows.

A kernel that Python calls is `lean`; one that kernels alone call is a `part` of them, neither optimised nor turned into
machine code by itself, which takes most of the time of compilation. A part has one signature: what is written out in a
call, numba takes for a type of its own, so that a number or a truth that differs from call to call is a variable.
"""

from collections.abc import Callable
from contextlib import suppress
from functools import cache, partial
from hashlib import sha256
from pathlib import Path
from re import MULTILINE
from re import compile as compile_pattern
from time import perf_counter
from typing import Any, NoReturn, TypeVar

from numba import cfunc, njit, types, version_info
from numba.core import event
from numba.core.codegen import JITCodeLibrary
from numba.core.compiler import Compiler, DefaultPassBuilder
from numba.core.compiler_machinery import PassManager
from numba.core.typed_passes import NativeLowering
from numba.extending import intrinsic

from verify.models import compiling, quick_entries, quick_lowering, quick_typing

Function = TypeVar("Function", bound=Callable[..., Any])
ALWAYS = {"error_model": "numpy", "no_cfunc_wrapper": True}
"""Options of numba for every kernel: divisions are not checked, and no C function is made that nothing calls."""


LOWERED = quick_lowering.KNOWN and version_info.short in quick_lowering.TRIED
"""Whether kernels are written down and optimised our way, by a numba that was tried; else as numba does."""


class _KernelLibrary(JITCodeLibrary):
    """The code of a kernel with all its parts, optimised once: it counts no references that could be pruned before."""

    def _optimize_functions(self, ll_module: Any) -> None:
        if not LOWERED:
            return super()._optimize_functions(ll_module)  # type: ignore[no-untyped-call,no-any-return]
        ll_module.data_layout = self._codegen._data_layout

    def _optimize_final_module(self) -> None:
        if not LOWERED:
            return super()._optimize_final_module()  # type: ignore[no-untyped-call,no-any-return]
        passes, builder = self._codegen._module_pass_manager()  # type: ignore[no-untyped-call]
        passes.run(self._final_module, builder)


class _PartLibrary(_KernelLibrary):
    """The code of a part: linked with what it calls, and left at that."""

    def finalize(self) -> None:
        """Link."""
        self._raise_if_finalized()  # type: ignore[no-untyped-call]
        for library in dict.fromkeys(self._linking_libraries):
            if hasattr(self, "_reload_init"):  # numba from 0.62 on
                self._reload_init.update(library._reload_init)
            self._final_module.link_in(library._get_module_for_linking(), preserve=True)
        self._finalized = True

    def get_pointer_to_function(self, name: str) -> int:
        """None: there is no machine code."""
        self._ensure_finalized()  # type: ignore[no-untyped-call]
        return 0

    @property
    def codegen(self) -> "_PartLibrary":
        """What numba hands a function's Python objects to: nobody, since Python does not call it."""
        return self

    def set_env(self, name: str, env: Any) -> None:
        """Forget them."""


NEEDLESS = {
    "WithLifting",
    "InlineClosureLikes",
    "RewriteDynamicRaises",
    "MakeFunctionToJitFunction",
    "InlineInlinables",
    "FindLiterallyCalls",
    "LiteralUnroll",
    "LiteralPropagationSubPipelinePass",
    "InlineOverloads",
    "NopythonRewrites",
    "AnnotateTypes",
}
"""Passes of numba's for what no kernel has: closures, `with`, exceptions, tuples of types, expressions of arrays."""


class _ScalarCompiler(Compiler):
    """Numba's, without the passes that kernels do not need."""

    lowering: Any = quick_lowering.KernelLowering

    def __init__(self, typingctx: Any, targetctx: Any, library: Any, *given: Any) -> None:
        super().__init__(typingctx, targetctx, library, *given)  # type: ignore[no-untyped-call]
        if LINKED and library is None and not self.state.flags.nrt:
            self.state.library = _KernelLibrary(targetctx.codegen(), "kernel")  # type: ignore[no-untyped-call]
            self.state.library.enable_object_caching()

    def compile_extra(self, func: Any) -> Any:
        """A function, by the pipeline."""
        with quick_entries.taken():
            return super().compile_extra(func)  # type: ignore[no-untyped-call]

    def define_pipelines(self) -> list[Any]:
        """The one pipeline."""
        whole, short = DefaultPassBuilder.define_nopython_pipeline(self.state), PassManager("kernels")  # type: ignore
        lowering = {NativeLowering: self.lowering} if LOWERED else {}
        short.passes.extend(
            [(lowering.get(one, one), why) for one, why in whole.passes if one.__name__ not in NEEDLESS]
        )
        short.finalize()  # type: ignore[no-untyped-call]
        return [short]


class _PartCompiler(_ScalarCompiler):
    """The same, into a part's library."""

    lowering = quick_lowering.PartLowering

    def __init__(self, typingctx: Any, targetctx: Any, library: Any, *given: Any) -> None:
        into = library or _PartLibrary(targetctx.codegen(), "part")  # type: ignore[no-untyped-call]
        super().__init__(typingctx, targetctx, into, *given)


KERNELS, RECORDS, WAYS = "*kernels.py", "*records.py", "quick_*.py"
"""Of a room: what its stamp covers, its kernels, what they read, and how they are compiled."""
_OTHER_ROOM = compile_pattern(rb"^from verify\.(\w+)\.\w*(?:kernels|records) import", MULTILINE)
INNER = (
    "_raise_if_finalized",
    "_ensure_finalized",
    "_get_module_for_linking",
    "_optimize_functions",
    "_optimize_final_module",
)
"""What libraries are made of: numba's own names, which a later numba may not have."""
LINKED = all(hasattr(JITCodeLibrary, name) for name in INNER)
"""Whether parts are only linked and kernels optimised once; else they are compiled as numba does: longer, the same."""
PART = {**ALWAYS, "_nrt": False, "no_cpython_wrapper": True} | ({"pipeline_class": _PartCompiler} if LINKED else {})


def _refuse(*given: Any, **more: Any) -> NoReturn:
    raise TypeError("a part of kernels is called by kernels alone: give it @lean() to call it from Python")


def part(**options: Any) -> Callable[[Function], Function]:
    """Compile, with these options of numba, what kernels alone call and what allocates nothing."""

    def compile_one(function: Function) -> Function:
        found = njit(**{**PART, **options})(function)
        found._compile_for_args = _refuse
        found.add_overload = lambda made: found.overloads.__setitem__(tuple(made.signature.args), made)
        return found  # type: ignore[no-any-return]

    return compile_one


def compiled(**options: Any) -> Callable[[Function], Function]:
    """Compile with these options of numba; what is kept on disk holds while the room's kernels stay as they are."""

    def compile_one(function: Function) -> Function:
        found = njit(**{**ALWAYS, "pipeline_class": _ScalarCompiler, **options})(function)
        nothing = found._cache
        try:
            found.enable_caching()
        except (RuntimeError, OSError):
            compiling.unkept.append(function.__qualname__)
            return found  # type: ignore[no-any-return]
        index: Any = getattr(found._cache, "_cache_file", None)
        if hasattr(index, "_source_stamp"):
            index._source_stamp = index._source_stamp, room_stamp(Path(function.__code__.co_filename).parent)
            _forgive(found, function.__qualname__)
        else:
            found._cache = nothing
        return found  # type: ignore[no-any-return]

    return compile_one


def _forgive(kernel: Any, name: str) -> None:
    """A file that cannot be read is compiled again; one that cannot be written is done without, and `compiling` knows.

    Nothing is half-written: numba writes each file beside its place and renames it.
    """
    kept = kernel._cache
    load, save = kept.load_overload, kept.save_overload

    def load_or_compile(signature: Any, target: Any) -> Any:
        found = load_unless_damaged(signature, target)
        if found is None and compiling.absent and compiling.absent(kernel, signature):
            return load_unless_damaged(signature, target)
        return found

    def load_unless_damaged(signature: Any, target: Any) -> Any:
        try:
            return load(signature, target)
        except Exception:  # whatever a damaged pickle raises
            with suppress(OSError):
                kept.flush()
            return None

    def save_or_tell(signature: Any, made: Any) -> None:
        try:
            with compiling.kept(kernel, signature):
                save(signature, made)
        except OSError:
            compiling.unkept.append(name)

    kept.load_overload, kept.save_overload = load_or_compile, save_or_tell


class _Watch(event.Listener):
    """Tells `compiling` what is compiled; one kernel's compilation asks for that of those it calls."""

    def __init__(self) -> None:
        self.open: list[tuple[float, float]] = []
        """When each began, and the seconds of those within it."""

    def on_start(self, event: Any) -> None:
        """A kernel's compilation begins."""
        if not self.open:
            quick_typing.begin()
            _tell(compiling.COMPILING)
        self.open.append((perf_counter(), 0.0))

    def on_end(self, event: Any) -> None:
        """It is over."""
        (began, within), function = self.open.pop(), event.data["dispatcher"].py_func
        seconds = perf_counter() - began
        if self.open:
            self.open[-1] = self.open[-1][0], self.open[-1][1] + seconds
        kernel = f"{function.__module__.removeprefix('verify.')}.{function.__qualname__}"
        compiling.compiled.append(compiling.Compiled(kernel, seconds - within))
        if not self.open:
            quick_typing.end()
            _tell("")


def _tell(what: str) -> None:
    for hear in compiling.hearers:
        hear(what)


event.register("numba:compile", _Watch())  # type: ignore[no-untyped-call]


@cache
def room_stamp(room: Path) -> str:
    """What kernels and records of the room say, and those of rooms that they import from, as one number."""
    sources = [
        one.name.encode() + b"\n" + one.read_bytes()
        for one in sorted([*room.glob(KERNELS), *room.glob(RECORDS), *room.glob(WAYS)])
    ]
    others = sorted(set(_OTHER_ROOM.findall(b"\n".join(sources))) - {room.name.encode()})
    return sha256(
        b"\0".join([*sources, *(room_stamp(room.parent / one.decode()).encode() for one in others)])
    ).hexdigest()


lean = partial(compiled, _nrt=False)
"""For kernels that allocate nothing: without numba's memory runtime no loop counts references, twice the speed."""
FAST = {"reassoc", "contract", "nsz"}
"""What sums over modes may do with their order."""


def _pointer_to(kind: Any) -> Any:
    """What turns an address into a pointer of which kernels read and write numbers of a kind by their places."""
    pointer = types.CPointer(kind)  # type: ignore[no-untyped-call]

    @intrinsic
    def at(typing: Any, address: Any) -> Any:
        def made(context: Any, builder: Any, signature: Any, given: Any) -> Any:
            return builder.inttoptr(given[0], context.get_value_type(pointer))

        return pointer(types.int64), made

    return at


numbers_at, whole_numbers_at = _pointer_to(types.float64), _pointer_to(types.int64)


def callback(part: Callable[[Any, Any], None], whole: Any, numbers: Any) -> Any:
    """A C function of two pointers, which it leaves alone: it calls a part on two arrays, which have to live on.

    `whole` are 64-bit whole numbers, `numbers` floating-point ones of 64 bits.
    """
    at, to = whole.ctypes.data, numbers.ctypes.data

    def call(first: Any, second: Any) -> None:
        part(whole_numbers_at(at), numbers_at(to))

    return cfunc(types.void(types.voidptr, types.voidptr))(call)
