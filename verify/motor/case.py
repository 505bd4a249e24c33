"""A motor as one value, and its runs in blocks of whole periods at a held speed."""

from collections.abc import Callable
from functools import lru_cache
from time import perf_counter
from typing import TYPE_CHECKING, Any

import msgspec
from msgspec.structs import replace

from verify.errors import InputError
from verify.motion.request import requested
from verify.motion.slider_run import damped_field
from verify.motor.combine import check_combines
from verify.motor.feet import Placed
from verify.motor.result import MotorRun, MotorState
from verify.motor.run import MODES, STEPS_PER_PERIOD, run_motor
from verify.motor.setup import Setup, carry_out, lay_out
from verify.options import Links, Start
from verify.problem.beam import Beam, PointForce
from verify.problem.slider import Slider

if TYPE_CHECKING:
    from verify.linear.field import HarmonicField


class MotorCase(msgspec.Struct, frozen=True, kw_only=True):
    """One model's beam under forces with a slider on it; see `run_motor` for what each means."""

    beam: Beam
    forces: tuple[PointForce, ...]
    frequency_hz: float
    slider: Slider
    model: str = "segment"
    count: int | None = 49
    modes: int | None = None
    start: Start = "steady"
    soft_start_periods: float = 0.0
    modal_damping: float | None = None
    steps_per_period: int = STEPS_PER_PERIOD
    links: Links = "rigid"

    @property
    def period(self) -> float:
        """Of the drive, seconds."""
        return 1.0 / self.frequency_hz

    def run(
        self, duration: float, *, progress: Callable[[float], None] = lambda part: None, **settings: Any
    ) -> MotorRun:
        """The run of so many seconds; `settings` are those of `run_motor` beside the case's own. Raises InputError."""
        own = {name: getattr(self, name) for name in self.__struct_fields__}
        return run_motor(**own, duration=duration, progress=progress, **settings)

    def field(self) -> "HarmonicField":
        """The steady field that runs are under in the long run, without the slider. Raises InputError."""
        return damped_field(self.model, self.count, self.beam, self.forces, self.frequency_hz, self.modal_damping)

    def driven(self, factor: float) -> "MotorCase":
        """The same with all forces times a factor."""
        return replace(self, forces=tuple(replace(one, amplitude=factor * one.amplitude) for one in self.forces))

    def turned(self) -> "MotorCase":
        """The same with every force's phase the other way round: the wave runs back."""
        return replace(self, forces=tuple(replace(one, phase_deg=-one.phase_deg) for one in self.forces))

    def on(self, slider: Slider) -> "MotorCase":
        """The same with another slider."""
        return replace(self, slider=slider)


Block = Callable[[MotorState | None], MotorRun]
"""From the state at its end the run of the next; None: from where the slider is put down."""


def blocks(case: MotorCase, speed: float, periods: int, samples: int) -> Block:
    """Runs of so many periods each, with so many samples; the drive is met at the same phase by all. Raises InputError.

    The clock of each begins at 0.
    """
    if case.start != "steady":
        raise InputError(f"start = {case.start!r}: what repeats itself stands on a steady beam, give start = 'steady'")
    check_combines(case.model, case.start, case.slider)
    setup = replace(_laid_out(case, periods, samples), placed=(_held(case, speed),))

    def run(before: MotorState | None) -> MotorRun:
        if before is None:
            return carry_out(setup, (), perf_counter(), lambda part: None)[0]
        state = replace(before, time=0.0)
        again = replace(setup, z=setup.stages[0].start(state.q, state.rates))
        return carry_out(again, (state,), perf_counter(), lambda part: None)[0]

    return run


def _held(case: MotorCase, speed: float) -> Placed:
    return Placed(case.slider, case.slider.start_on(case.beam), speed, True)


@lru_cache(maxsize=4)
def _laid_out(case: MotorCase, periods: int, samples: int) -> Setup:
    """The setup of a block, for any held speed."""
    request = requested(
        case.beam,
        case.forces,
        case.frequency_hz,
        periods * case.period,
        model=case.model,
        count=case.count,
        modes=case.modes,
        modal_damping=case.modal_damping,
        start=case.start,
        soft_start_periods=0.0,
        at=(),
        samples=samples,
        step=None,
        steps_per_period=case.steps_per_period,
        slider=case.slider,
        default_modes=MODES,
    )
    return lay_out(request, (_held(case, 0.0),), ())
