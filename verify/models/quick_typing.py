"""Numba's types of arithmetic, each worked out once: a fifth of the time of compilation.

For every `+` and every entry of an array numba tries one template after the other, and one of them compares all its
flags, though the answer depends on the types alone. While something is compiled, answers for operators are kept, and
the collector of cycles, which finds hardly any in a compiler's graphs, rests.
"""

import gc
import operator
from typing import Any

from numba.core.types.functions import BaseFunction

_ARITHMETIC = ("add", "sub", "mul", "truediv", "floordiv", "mod", "pow", "neg", "iadd", "isub", "imul", "itruediv")
_OTHERS = ("lt", "le", "gt", "ge", "eq", "ne", "getitem", "setitem")
OPERATORS = {getattr(operator, name) for name in (*_ARITHMETIC, *_OTHERS)}
_known: dict[Any, tuple[Any, Any]] = {}
"""By operator and types: numba's function, and the signature that it found."""
_tried: Any = getattr(BaseFunction, "get_call_type", None)
"""Numba's own; None in a numba that has it no more, which then tries every time."""
_collecting: list[bool] = []


def _call_type(self: Any, context: Any, args: Any, more: Any) -> Any:
    """As numba finds it, by trying."""
    if more or self.typing_key not in OPERATORS:
        return _tried(self, context, args, more)
    key = context, self.typing_key, tuple(args)
    function, signature = _known.get(key, (None, None))
    if function is not self:
        signature = _tried(self, context, args, more)
        _known[key] = self, signature
    return signature


def begin() -> None:
    """From here on something is compiled."""
    _collecting.append(gc.isenabled())
    gc.disable()
    if _tried is not None:
        BaseFunction.get_call_type = _call_type  # type: ignore[method-assign, assignment]


def end() -> None:
    """It is compiled."""
    if _tried is not None:
        BaseFunction.get_call_type = _tried  # type: ignore[method-assign]
    if _collecting.pop():
        gc.enable()
