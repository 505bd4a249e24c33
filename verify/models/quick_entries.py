"""Entries of plain arrays, read and written in a fifth of numba's instructions: a tenth of the time of compilation.

For `a[i, j]` numba unpacks the array into memory, with every length and stride, and leaves it to LLVM to find out that
one address was wanted. While something is compiled here, that address is written down at once. Negative indices count
from the end, as they do in numba; what is no plain array, or no plain index, is left to it.
"""

import operator
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from typing import Any

from numba.core import types as numbas_types
from numba.core.imputils import lower_builtin
from numba.np import arrayobj

NUMBAS = ("getitem_arraynd_intp", "getitem_array_tuple", "setitem_array")
"""Numba's own, which a later numba may call otherwise: then everything is left to it."""
types: Any = numbas_types
"""Not all of its names are typed."""
WORDS = (types.int64, types.uint64)
"""Of what an index is made."""
_open: list[bool] = []
"""Whether something of ours is compiled, once for each that is."""


@contextmanager
def taken() -> Iterator[None]:
    """In the meantime something of ours is compiled."""
    _open.append(True)
    try:
        yield
    finally:
        _open.pop()


def _is_plain(context: Any, array: Any, index: Sequence[Any]) -> bool:
    """Whether whole numbers point to one number of a contiguous array, and nobody wants their bounds checked."""
    return (
        bool(_open)
        and isinstance(array, types.Array)
        and array.layout == "C"
        and array.aligned
        and array.dtype in (types.float64, types.int64)
        and len(index) == array.ndim
        and all(types.unliteral(one) in WORDS for one in index)
        and not context.enable_boundscheck
    )


def _counted(context: Any, builder: Any, kind: Any, number: Any, length: Any) -> Any:
    """An index counted from the start."""
    if isinstance(kind, types.IntegerLiteral):
        number = context.get_constant(types.intp, kind.literal_value)
        if kind.literal_value >= 0:
            return number
    if not kind.signed:
        return number
    from_end = builder.icmp_signed("<", number, context.get_constant(types.intp, 0))
    return builder.select(from_end, builder.add(number, length), number)


def _entry(context: Any, builder: Any, array: Any, value: Any, index: Sequence[Any], numbers: Sequence[Any]) -> Any:
    """The address of one entry, row by row."""
    model = context.data_model_manager[array]
    lengths, data = model.get_field_position("shape"), model.get_field_position("data")
    offset = None
    for axis, (kind, number) in enumerate(zip(index, numbers, strict=True)):
        length = builder.extract_value(value, [lengths, axis])
        counted = _counted(context, builder, kind, number, length)
        offset = counted if offset is None else builder.add(builder.mul(offset, length), counted)
    return builder.gep(builder.extract_value(value, data), [offset], inbounds=True)


def _kinds(index: Any) -> Sequence[Any]:
    """The types of an index, be it a tuple or one number."""
    return tuple(index) if isinstance(index, types.BaseTuple) else (index,)


def _numbers(builder: Any, index: Any, value: Any) -> Sequence[Any]:
    """Its values."""
    if not isinstance(index, types.BaseTuple):
        return (value,)
    return [builder.extract_value(value, i) for i in range(len(index))]


def _reader(numbas: Callable[..., Any]) -> Callable[..., Any]:
    def read(context: Any, builder: Any, sig: Any, args: Any) -> Any:
        array, index = sig.args
        if not _is_plain(context, array, kinds := _kinds(index)):
            return numbas(context, builder, sig, args)
        return builder.load(_entry(context, builder, array, args[0], kinds, _numbers(builder, index, args[1])))

    return read


def _writer(numbas: Callable[..., Any]) -> Callable[..., Any]:
    def write(context: Any, builder: Any, sig: Any, args: Any) -> Any:
        array, index, kind = sig.args
        if not isinstance(kind, types.Number) or not _is_plain(context, array, kinds := _kinds(index)):
            return numbas(context, builder, sig, args)
        at = _entry(context, builder, array, args[0], kinds, _numbers(builder, index, args[1]))
        builder.store(context.cast(builder, args[2], kind, array.dtype), at)
        return context.get_dummy_value()

    return write


def _install() -> None:
    """Give them to numba, where its own have the names known here."""
    if not all(hasattr(arrayobj, name) for name in NUMBAS):
        return
    by_number, by_tuple, written = (getattr(arrayobj, name) for name in NUMBAS)
    instead: Any = lower_builtin
    instead(operator.getitem, types.Array, types.Integer)(_reader(by_number))
    instead(operator.getitem, types.Array, types.BaseTuple)(_reader(by_tuple))
    instead(operator.setitem, types.Array, types.Any, types.Any)(_writer(written))


_install()
