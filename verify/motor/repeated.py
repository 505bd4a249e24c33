"""Blocks of whole periods of a steady motor held at a speed and at its place, laid out once and run again and again."""

from collections.abc import Callable
from functools import lru_cache
from time import perf_counter

from msgspec.structs import replace

from verify.errors import InputError
from verify.motion.request import Driven, Modelled, Started, Watched, requested
from verify.motor.carry import carry_out
from verify.motor.case import MotorCase
from verify.motor.combine import check_combines
from verify.motor.feet import Placed
from verify.motor.plan import Plan, lay_out
from verify.motor.result import MotorRun, MotorState
from verify.motor.run import MODES

Block = Callable[[MotorState | None], MotorRun]
"""From the state at its end the run of the next; None: from where the slider is put down."""


def blocks(case: MotorCase, speed: float, periods: int, samples: int) -> Block:
    """Runs of so many periods each, with so many samples; the drive is met at the same phase by all. Raises InputError.

    The clock of each begins at 0.
    """
    if case.start != "steady":
        raise InputError(f"start = {case.start!r}: what repeats itself stands on a steady beam, give start = 'steady'")
    check_combines(case.model, case.start, case.slider)
    plan = replace(_laid_out(case, periods, samples), placed=(_held(case, speed),))

    def run(before: MotorState | None) -> MotorRun:
        if before is None:
            return carry_out(plan, (), perf_counter(), lambda part: None, False)[0]
        state = replace(before, time=0.0)
        again = replace(plan, z=plan.stages[0].start(state.q, state.rates))
        return carry_out(again, (state,), perf_counter(), lambda part: None, False)[0]

    return run


def _held(case: MotorCase, speed: float) -> Placed:
    return Placed(case.slider, case.slider.start_on(case.beam), speed, True)


@lru_cache(maxsize=4)
def _laid_out(case: MotorCase, periods: int, samples: int) -> Plan:
    """The plan of a block, whatever the speed that the slider is held at."""
    request = requested(
        Driven(case.beam, case.forces, case.frequency_hz, periods * case.period),
        Modelled(case.model, case.count, case.modes, case.modal_damping, MODES),
        Started(case.start, 0.0, (), None),
        Watched((), samples, None, case.steps_per_period, False),
        case.slider,
    )
    return lay_out(request, (_held(case, 0.0),), ())
