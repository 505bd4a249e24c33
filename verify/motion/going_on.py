"""Whether a run can go on from another."""

from typing import TYPE_CHECKING

from msgspec.structs import replace

from verify.beam import Beam
from verify.errors import InputError
from verify.motion.result import EndState

if TYPE_CHECKING:
    from verify.motor.result import MotorState


def check_goes_on(before: "EndState | MotorState", beam: Beam, model: str, count: int | None, n: int) -> None:
    """Raise InputError where the n modes of a run are not those of the run before; losses and forces may differ."""
    if not len(before.q):
        raise InputError(
            "continue_from is a run with start = 'steady', which has no free modes: go on from one with start = 'rest'"
        )
    if (before.model, before.count) != (model, count):
        raise InputError(
            f"continue_from is of model = {before.model!r}, count = {before.count!r} and this run of "
            f"model = {model!r}, count = {count!r}: give both the same"
        )
    if replace(before.beam, loss_factor=0.0) != replace(beam, loss_factor=0.0):
        raise InputError("continue_from is of another beam: give the one it was run with, but for loss_factor")
    if len(before.q) != n:
        raise InputError(f"continue_from has {len(before.q)} modes and this run {n}: give both the same modes")
