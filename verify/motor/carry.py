"""A run that is laid out, carried out: sliders put down or taken up again, stepped, each run told by itself."""

from collections.abc import Callable, Sequence
from time import perf_counter

from verify.errors import InputError
from verify.motor import records
from verify.motor.feet import put_down
from verify.motor.outcome import Ended, outcome
from verify.motor.plan import Plan
from verify.motor.resting import levels_of, press_apart
from verify.motor.result import MotorRun, MotorState
from verify.motor.stepping import RIDES_FROM_HERE, Riding, run_stages
from verify.patience import check_work

REMEDY = "shorten it, lengthen the step, or give fewer modes or points of contact"


def carry_out(
    plan: Plan,
    before: Sequence[MotorState],
    began: float,
    progress: Callable[[float], None],
    patient: bool,
) -> tuple[MotorRun, ...]:
    """Step a run that is laid out. Raises InputError where that takes too long."""
    n_steps = sum(stage.n_steps for stage in plan.stages)
    riding = Riding.fresh(plan.placed, plan.request, plan.coupling.two_way)
    estimated = riding.seconds(n_steps, plan.tables[-1], plan.request.beam.length)
    if not patient:
        seconds = sum(stage.duration for stage in plan.stages)
        check_work("duration", seconds, estimated, REMEDY)
    begin(plan, riding, before)
    ready = perf_counter()
    stopped, q, rates = run_stages(plan.stages, plan.tables, plan.z, riding, lambda n: progress(n / n_steps))
    ended = Ended(stopped, q, rates, ready - began, perf_counter() - ready, estimated)
    return tuple(outcome(b, plan, riding, ended) for b in range(len(plan.placed)))


def begin(plan: Plan, riding: Riding, before: Sequence[MotorState]) -> None:
    """Put the sliders down, or go on from where runs have left them."""
    feet, stage = riding.feet, plan.stages[0]
    for b, state in enumerate(before):
        own, own_feet = feet.owner == b, feet.keeper == b
        if state.feet.shape != feet.state[own_feet].shape or state.touch.shape != feet.touch[own].shape:
            raise InputError("continue_from has other feet than slider.foot: give both runs the same slider")
        feet.body[b, records.X], feet.state[own_feet], feet.touch[own] = state.travelled, state.feet, state.touch
        if plan.placed[b].held_speed is None:
            feet.body[b, records.V] = state.speed
    if plan.coupling.two_way and plan.basis is not None:
        press_apart(plan.placed, plan.basis, feet)
    if before:
        riding.before[:] = feet.touch[:, [records.DEPTH, records.STUCK]]
        return
    if riding.hard is not None:
        riding.before[0, 0] = RIDES_FROM_HERE
        return
    levels = levels_of(stage, plan.z, plan.request.beam, plan.placed, feet)
    put_down(feet, levels)
    riding.set_touch(levels)
