"""Kernels written down for LLVM in about half of numba's instructions, of which it makes machine code the sooner.

Numba keeps what it needs in more than one block in memory, hands on arrays and records number by number, and counts
loops with what any range may ask for; it leaves it to LLVM to find out that little of this was wanted. Here a variable
that has one value stays that value, arrays and records are handed from kernel to part by their addresses, and loops
over whole numbers count. What is asked of them is the same, in the same order; with a numba that this was not tried
with, or that lacks one of the names that this stands on, everything is left to it.
"""

# mypy: disable-error-code="no-untyped-call,attr-defined,no-any-return"

from collections.abc import Callable, Iterable, Sequence
from typing import Any

from llvmlite.ir import IRBuilder
from llvmlite.ir.instructions import LoadInstr
from numba.core import cgutils, ir
from numba.core import types as numbas_types
from numba.core.analysis import compute_use_defs, must_use_alloca
from numba.core.base import OverloadSelector
from numba.core.callconv import CPUCallConv
from numba.core.compiler_machinery import register_pass
from numba.core.datamodel.packer import ArgPacker
from numba.core.imputils import fix_returning_optional
from numba.core.ir_utils import compute_cfg_from_blocks
from numba.core.lowering import Lower
from numba.core.typed_passes import NativeLowering

types: Any = numbas_types
"""Not all of its names are typed."""
NAMES = ("_find_singly_assigned_variable", "extract_function_arguments", "setup_function", "lower_expr", "loadvar")
TRIED = ((0, 68),)
"""Numbas that this was tried with: its names are not all, and one that means something else by them would break."""
KNOWN = all(hasattr(Lower, name) for name in NAMES) and hasattr(CPUCallConv, "_get_arg_packer")
"""Whether this numba lowers by the names that this stands on."""
STEP_FREE = 2
"""Arguments of a range that has no step."""


class QuickLower(Lower):
    """Numba's lowering, with short ways for what kernels are made of."""

    def _find_singly_assigned_variable(self) -> None:
        """Those that numba finds, which live in one block, and those whose one value is there wherever it is asked."""
        super()._find_singly_assigned_variable()
        self._ranges: dict[Any, tuple[Any, Any, Any]] = {}
        self._fields: dict[tuple[Any, int], Any] = {}
        if not self.context.enable_nrt and not self.func_ir.func_id.is_generator:
            self._singly_assigned_vars |= _with_one_value(self.blocks)

    def extract_function_arguments(self) -> Any:
        """Those of the function; records stand in memory, from where parts read what they ask for."""
        values = super().extract_function_arguments()
        for kind, value in zip(self.fndesc.argtypes, values, strict=True):
            if isinstance(kind, types.BaseNamedTuple):
                _places(self.builder).setdefault(value, _place(self.builder, value))
        return values

    def lower_expr(self, resty: Any, expr: Any) -> Any:
        """By the short way where there is one."""
        quick = QUICK.get(expr.op)
        found = quick(self, expr) if quick else None
        return super().lower_expr(resty, expr) if found is None else found


def _with_one_value(blocks: Any) -> set[str]:
    """Variables that are assigned once, in a block that is passed, and written down, before all that ask for them."""
    use_defs, dominators = compute_use_defs(blocks), compute_cfg_from_blocks(blocks).dominators()
    assigned: dict[str, list[int]] = {}
    for offset, block in blocks.items():
        for one in block.find_insts(ir.Assign):
            assigned.setdefault(one.target.name, []).append(offset)
    asked: dict[str, list[int]] = {}
    for offset, names in use_defs.usemap.items():
        for name in names:
            asked.setdefault(name, []).append(offset)
    in_memory = must_use_alloca(blocks)
    return {
        name
        for name, where in assigned.items()
        if len(where) == 1
        and name not in in_memory
        and all(where[0] < at and where[0] in dominators.get(at, ()) for at in asked.get(name, ()))
    }


def _range(lower: QuickLower, expr: Any) -> Any:
    """A range of whole numbers whose step is written out, or is one."""
    kind = lower.typeof(expr.func.name)
    if getattr(kind, "typing_key", None) is not range or expr.kws or expr.vararg:
        return None
    signature = lower.fndesc.calltypes[expr]
    if any(one is not types.int64 for one in signature.args):
        return None
    word = lower.context.get_value_type(types.int64)
    given = [
        lower.context.cast(lower.builder, lower.loadvar(one.name), lower.typeof(one.name), types.int64)
        for one in expr.args
    ]
    first, last = ([word(0), *given] if len(given) == 1 else given)[:STEP_FREE]
    step = given[STEP_FREE] if len(given) > STEP_FREE else word(1)
    if not getattr(step, "constant", 0):
        return None
    state = cgutils.pack_struct(lower.builder, (first, last, step))
    lower._ranges[state] = first, last, step
    return state


def _begin(lower: QuickLower, expr: Any) -> Any:
    """Where a range stands, and how often it goes on."""
    if lower.typeof(expr.value.name) is not types.range_state64_type:
        return None
    known = lower._ranges.get(lower.loadvar(expr.value.name))
    if known is None:
        return None
    builder, (first, last, step) = lower.builder, known
    at, left = (cgutils.alloca_once(builder, first.type) for _ in range(2))
    towards = step.constant - 1 if step.constant > 0 else step.constant + 1
    way = builder.sub(last, first)
    builder.store(first, at)
    builder.store(builder.sdiv(builder.add(way, way.type(towards)), step), left)
    return cgutils.pack_struct(builder, (at, last, step, left))


def _go_on(lower: QuickLower, expr: Any) -> Any:
    """Where it stands, and whether that is within it."""
    if lower.typeof(expr.value.name) is not types.range_iter64_type:
        return None
    builder = lower.builder
    at, _, step, left = cgutils.unpack_tuple(builder, lower.loadvar(expr.value.name), 4)
    count, now = builder.load(left), builder.load(at)
    builder.store(builder.sub(count, count.type(1), flags=["nsw"]), left)
    builder.store(builder.add(now, step), at)
    return cgutils.pack_struct(builder, (now, builder.icmp_signed(">", count, count.type(0))))


def _part_of_pair(place: int) -> Callable[[QuickLower, Any], Any]:
    def part(lower: QuickLower, expr: Any) -> Any:
        return lower.builder.extract_value(lower.loadvar(expr.value.name), place)

    return part


def _attribute(lower: QuickLower, expr: Any) -> Any:
    """The shape or the size of an array, and what a record holds."""
    kind, name = lower.typeof(expr.value.name), {"shape": "shape", "size": "nitems"}.get(expr.attr)
    if isinstance(kind, types.BaseNamedTuple):
        return _field(lower, lower.loadvar(expr.value.name), kind, expr.attr)
    if name is None or not isinstance(kind, types.Array):
        return None
    place = lower.context.data_model_manager[kind].get_field_position(name)
    return lower.builder.extract_value(lower.loadvar(expr.value.name), place)


QUICK: dict[str, Callable[[QuickLower, Any], Any]] = {
    "call": _range,
    "getiter": _begin,
    "iternext": _go_on,
    "pair_first": _part_of_pair(0),
    "pair_second": _part_of_pair(1),
    "getattr": _attribute,
}
"""By what an expression does."""


def _is_plain(kind: Any) -> bool:
    """Whether an array is its address and its lengths."""
    return isinstance(kind, types.Array) and kind.layout == "C" and kind.aligned


def _array(context: Any, builder: Any, kind: Any, data: Any, lengths: Sequence[Any]) -> Any:
    """An array of rows without gaps, that owns nothing, as numba has it."""
    word = context.get_value_type(types.intp)
    size = word(context.get_abi_sizeof(context.get_data_type(kind.dtype)))
    strides: list[Any] = []
    stride = size
    for length in reversed(lengths):
        strides.insert(0, stride)
        stride = builder.mul(stride, length)
    count = lengths[0]
    for length in lengths[1:]:
        count = builder.mul(count, length)
    model = context.data_model_manager[kind]
    value = model.get_value_type()(None)
    for name, field in (("nitems", count), ("itemsize", size), ("data", data)):
        value = builder.insert_value(value, field, model.get_field_position(name))
    for name, fields in (("shape", lengths), ("strides", strides)):
        for axis, field in enumerate(fields):
            value = builder.insert_value(value, field, [model.get_field_position(name), axis])
    return value


def _pieces(context: Any, builder: Any, kind: Any, value: Any) -> list[Any]:
    """The address and the lengths of an array."""
    model = context.data_model_manager[kind]
    shape = model.get_field_position("shape")
    lengths = [builder.extract_value(value, [shape, axis]) for axis in range(kind.ndim)]
    return [builder.extract_value(value, model.get_field_position("data")), *lengths]


class _ByAddress(ArgPacker):
    """Records handed on by their addresses, arrays by their addresses and lengths, all else as numba does."""

    def __init__(self, context: Any, kinds: Sequence[Any]) -> None:
        self.context, self.kinds = context, kinds

    def _numbas(self, kind: Any) -> ArgPacker:
        return ArgPacker(self.context.data_model_manager, [kind])

    def _types(self, kind: Any) -> Sequence[Any]:
        if isinstance(kind, types.BaseNamedTuple):
            return [self.context.get_value_type(kind).as_pointer()]
        if _is_plain(kind):
            word = self.context.get_value_type(types.intp)
            return [self.context.get_data_type(kind.dtype).as_pointer(), *[word] * kind.ndim]
        if kind is types.boolean:
            return [self.context.get_value_type(kind)]
        return self._numbas(kind).argument_types

    @property
    def argument_types(self) -> tuple[Any, ...]:
        """Of LLVM."""
        return tuple(one for kind in self.kinds for one in self._types(kind))

    def as_arguments(self, builder: Any, values: Sequence[Any]) -> tuple[Any, ...]:
        """What is handed on."""
        return tuple(
            one for kind, value in zip(self.kinds, values, strict=True) for one in self._handed(builder, kind, value)
        )

    def _handed(self, builder: Any, kind: Any, value: Any) -> Sequence[Any]:
        if isinstance(kind, types.BaseNamedTuple):
            return [_place(builder, value)]
        if _is_plain(kind):
            return _pieces(self.context, builder, kind, value)
        return [value] if kind is types.boolean else self._numbas(kind).as_arguments(builder, [value])

    def from_arguments(self, builder: Any, args: Iterable[Any]) -> list[Any]:
        """What comes in."""
        left, values = list(args), []
        for kind in self.kinds:
            n = len(self._types(kind))
            values.append(self._taken(builder, kind, left[:n]))
            left = left[n:]
        return values

    def _taken(self, builder: Any, kind: Any, given: list[Any]) -> Any:
        if isinstance(kind, types.BaseNamedTuple):
            return _record_at(builder, given[0])
        if _is_plain(kind):
            return _array(self.context, builder, kind, given[0], given[1:])
        return given[0] if kind is types.boolean else self._numbas(kind).from_arguments(builder, given)[0]

    def assign_names(self, args: Any, names: Any) -> None:
        """None."""


def _places(builder: Any) -> dict[Any, Any]:
    """Addresses of the records of a function, by their values."""
    if not hasattr(builder, "_places"):
        builder._places = {}
    return builder._places


def _record_at(builder: Any, address: Any) -> Any:
    """A record that stands somewhere."""
    value = builder.load(address)
    _places(builder)[value] = address
    return value


def _place(builder: Any, record: Any) -> Any:
    """Where a record stands; it is written down where it was in no memory."""
    return _places(builder).get(record) or cgutils.alloca_once_value(builder, record)


def _field(lower: QuickLower, value: Any, kind: Any, name: str) -> Any:
    """What a record holds that was handed on by its address, read at the beginning of the function, once."""
    address, place = _places(lower.builder).get(value), kind.fields.index(name)
    if address is None or not isinstance(value, LoadInstr):  # a record at hand is written there after that beginning
        return None
    if (value, place) not in lower._fields:
        with lower.builder.goto_entry_block():
            lower._fields[value, place] = _read(lower.context, lower.builder, kind[place], address, place)
    return lower._fields[value, place]


def _read(context: Any, builder: Any, kind: Any, record: Any, place: int) -> Any:
    """One field of a record in memory."""
    at = cgutils.gep_inbounds(builder, record, 0, place)
    if isinstance(kind, types.BaseNamedTuple):
        return _record_at(builder, at)
    if not _is_plain(kind):
        return builder.load(at)
    model = context.data_model_manager[kind]
    data = builder.load(cgutils.gep_inbounds(builder, at, 0, model.get_field_position("data")))
    shape = model.get_field_position("shape")
    lengths = [builder.load(cgutils.gep_inbounds(builder, at, 0, shape, axis)) for axis in range(kind.ndim)]
    return _array(context, builder, kind, data, lengths)


class _PartConvention(CPUCallConv):
    """How parts are called: as numba does, but for what is handed on."""

    def _get_arg_packer(self, argtypes: Any) -> Any:
        return _ByAddress(self.context, argtypes)


def _declared(context: Any, module: Any, descriptor: Any) -> Any:
    """A part in a module that calls it, or is it."""
    convention = _PartConvention(context)
    kind = convention.get_function_type(descriptor.restype, descriptor.argtypes)
    function = cgutils.get_or_insert_function(module, kind, descriptor.mangled_name)
    convention.decorate_function(function, descriptor.args, descriptor.argtypes, noalias=descriptor.noalias)
    return function


class PartLower(QuickLower):
    """Of a part."""

    @property
    def call_conv(self) -> Any:
        """By addresses."""
        return _PartConvention(self.context)

    def setup_function(self, fndesc: Any) -> None:
        """As numba does, by this convention."""
        self.function = _declared(self.context, self.module, fndesc)
        self.entry_block = self.function.append_basic_block("entry")
        self.builder = IRBuilder(self.entry_block)
        self.call_helper = self.call_conv.init_call_helper(self.builder)


def calling(descriptor: Any, libraries: Sequence[Any]) -> Any:
    """What writes down a call of a part."""

    def call(context: Any, builder: Any, signature: Any, given: Any) -> Any:
        convention = _PartConvention(context)
        function = _declared(context, builder.module, descriptor)
        status, value = convention.call_function(builder, function, descriptor.restype, descriptor.argtypes, given)
        with cgutils.if_unlikely(builder, status.is_error):
            context.call_conv.return_status_propagate(builder, status)
        return fix_returning_optional(context, builder, signature, status, value)

    call.signature, call.libs = descriptor.argtypes, tuple(libraries)
    return call


@register_pass(mutates_CFG=True, analysis_only=False)
class KernelLowering(NativeLowering):
    """Of a kernel that Python calls."""

    _name = "kernel_lowering"

    @property
    def lowering_class(self) -> Any:
        """With short ways."""
        return QuickLower


@register_pass(mutates_CFG=True, analysis_only=False)
class PartLowering(NativeLowering):
    """Of a part."""

    _name = "part_lowering"

    @property
    def lowering_class(self) -> Any:
        """With short ways, called by addresses."""
        return PartLower

    def run_pass(self, state: Any) -> bool:
        """As numba does; then its calls are written down here."""
        done = super().run_pass(state)
        made, call = state["cr"], calling(state["cr"].fndesc, [state.library])
        state.targetctx._defns[made.cfunc] = defined = OverloadSelector()
        defined.append(call, call.signature)
        return bool(done)
