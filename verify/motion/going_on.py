"""Whether a run can go on from another."""

from typing import TYPE_CHECKING

from msgspec.structs import replace

from verify.beam import Beam
from verify.errors import InputError
from verify.motion.result import EndState

if TYPE_CHECKING:
    from verify.motor.result import MotorState


def check_goes_on(
    before: "EndState | MotorState", beam: Beam, model: str, count: int | None, n: int, start: str
) -> None:
    """Raise InputError where the n modes of a run are not those of the run before; losses and forces may differ."""
    check_same_beam(before, beam, model, count)
    check_same_modes(before, n, start)


def check_same_modes(before: "EndState | MotorState", n: int, start: str) -> None:
    """Raise InputError where the n modes of a run of the same beam and model are others, or would be lost."""
    _check_same_start(before, start)
    if not n:
        raise InputError(
            "start = 'steady' has no free modes where no slider pushes back, and those of continue_from would be lost: "
            "put one on with coupling = 'two-way'"
        )
    if len(before.q) != n:
        raise InputError(f"continue_from has {len(before.q)} modes and this run {n}: give both the same modes")


def check_same_beam(before: "EndState | MotorState", beam: Beam, model: str, count: int | None) -> None:
    """Raise InputError for a run of another beam, but for its loss factor, or of another model of it."""
    if (before.model, before.count) != (model, count):
        raise InputError(
            f"continue_from is of model = {before.model!r}, count = {before.count!r} and this run of "
            f"model = {model!r}, count = {count!r}: give both the same"
        )
    if replace(before.beam, loss_factor=0.0) != replace(beam, loss_factor=0.0):
        raise InputError("continue_from is of another beam: give the one it was run with, but for loss_factor")


def _check_same_start(before: "EndState | MotorState", start: str) -> None:
    """Raise InputError where modes that hold all of a motion would stand beside a steady field, or the other way."""
    if not len(before.q):
        raise InputError(
            "continue_from is a run with start = 'steady', which has no free modes: go on from one with start = 'rest'"
        )
    if start == "steady" and not before.steady:
        raise InputError(
            "start = 'steady': continue_from is no run with start = 'steady', and what the forces did in it would be "
            "there twice: give start = 'rest', which goes on from where that run ended"
        )
    if start != "steady" and before.steady:
        raise InputError(
            f"start = {start!r}: continue_from is a run with start = 'steady', whose modes move beside a steady field: "
            "give start = 'steady', or go on from a run with start = 'rest'"
        )
