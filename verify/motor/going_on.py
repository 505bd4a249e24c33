"""Whether sliders can go on from where runs have left them: one motion of one beam, each slider where it was put."""

from collections.abc import Sequence

import numpy as np

from verify.errors import InputError, written
from verify.motion.going_on import check_same_beam
from verify.motion.request import Request
from verify.motor.feet import Placed
from verify.motor.result import MotorRun


def check_runs(runs: Sequence[MotorRun], request: Request, placed: Sequence[Placed]) -> None:
    """Raise InputError for runs of other beams, models or instants, of as many as there are not, or put elsewhere."""
    if runs and len(runs) != len(placed):
        raise InputError(f"continue_from has {len(runs)} runs for {len(placed)} sliders: give one for each")
    for run, one in zip(runs, placed, strict=bool(runs)):
        check_same_beam(run.state, request.beam, request.model, request.count)
        _check_one_motion(runs[0], run)
        if run.start is not None and run.start != one.start:
            raise InputError(
                f"continue_from is of a slider that was put on at {written(run.start)} m, and slider.position = "
                f"{written(one.start)} m: it goes on from where it is, leave its position as it was"
            )
        own = run.slider.speed if run.slider else 0.0
        if one.slider.speed not in (0.0, own, run.state.speed):
            raise InputError(
                f"continue_from is of a slider that goes at {written(run.state.speed)} m/s by its end, and "
                f"slider.speed = {written(one.slider.speed)} m/s: it goes on as it goes, leave its speed as it was"
            )


def _check_one_motion(first: MotorRun, run: MotorRun) -> None:
    """Raise InputError for runs that do not end at one instant of one motion of the beam."""
    ends, others = first.state, run.state
    if ends.time != others.time:
        raise InputError(
            f"continue_from holds runs that end at {written(ends.time)} s and {written(others.time)} s: give those of "
            "one run_motors"
        )
    if not (np.array_equal(ends.q, others.q) and np.array_equal(ends.rates, others.rates)):
        raise InputError(
            "continue_from holds runs under which the beam moves otherwise at their end: give those of one run_motors"
        )
