"""Blocks of whole periods of a steady motor held at a speed and at its place, laid out once and run again and again."""

from collections.abc import Callable
from time import perf_counter

from msgspec.structs import replace

from verify.errors import InputError
from verify.motion.request import Driven, Modelled, Started, Watched, requested
from verify.motor.carry import carry_out
from verify.motor.case import MotorCase
from verify.motor.combine import check_combines
from verify.motor.feet import Placed
from verify.motor.plan import lay_out
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
    request = requested(
        Driven(case.beam, case.forces, case.frequency_hz, periods * case.period),
        Modelled(case.model, case.count, case.modes, case.modal_damping, MODES),
        Started(case.start, 0.0, (), None),
        Watched((), samples, None, case.steps_per_period, False),
        case.slider,
    )
    plan = lay_out(request, (Placed(case.slider, case.slider.start_on(case.beam), speed, True),), ())

    def run(before: MotorState | None) -> MotorRun:
        if before is None:
            return carry_out(plan, (), perf_counter(), lambda part: None, True)[0]
        state = replace(before, time=0.0)
        again = replace(plan, z=plan.stages[0].start(state.q, state.rates))
        return carry_out(again, (state,), perf_counter(), lambda part: None, True)[0]

    return run
