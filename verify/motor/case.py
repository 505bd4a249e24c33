"""A motor as one value: a beam, its forces, a model of it, a slider that may leave it."""

from collections.abc import Callable
from typing import TYPE_CHECKING, Any

import msgspec
from msgspec.structs import replace

from verify.beam import Beam, PointForce
from verify.motion.carried import damped_field
from verify.motor.result import MotorRun
from verify.motor.run import STEPS_PER_PERIOD, run_motor
from verify.options import Links, Start
from verify.slider import Slider

if TYPE_CHECKING:
    from verify.models.fields import HarmonicField


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
