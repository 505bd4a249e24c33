"""A linear beam in time, driven or let go, with a slider on it or without. The room is `verify.motion`.

The module is its own verb: `verify.simulate(...)` and `verify.simulate.simulate(...)` are one.
"""

import sys
from types import ModuleType
from typing import TYPE_CHECKING

from verify.motion.free_vibration import FreeVibration, free_vibration
from verify.motion.result import Motion
from verify.motion.simulate import simulate

if TYPE_CHECKING:
    from inspect import Signature

__all__ = ["FreeVibration", "Motion", "free_vibration", "simulate"]


class _Verb(ModuleType):
    """A module that can be called: its name under `verify` is that of the verb in it."""

    __call__ = staticmethod(simulate)

    @property
    def __signature__(self) -> "Signature":
        from inspect import signature

        return signature(simulate)


sys.modules[__name__].__class__ = _Verb
