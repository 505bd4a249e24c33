"""A driven beam in time as one value: what moves, under what, for how long."""

from collections.abc import Callable, Sequence

import msgspec
from msgspec.structs import asdict

from verify.beam import Beam, PointForce
from verify.motion.request import STEPS_PER_PERIOD, Driven, Modelled, Started, Watched, requested
from verify.motion.result import Motion
from verify.motion.simulate import simulate
from verify.options import Start
from verify.slider import Slider


class MotionCase(msgspec.Struct, frozen=True, kw_only=True):
    """One model's beam in time under forces; see `simulate` for what each means."""

    beam: Beam
    forces: tuple[PointForce, ...]
    frequency_hz: float
    duration: float
    """Seconds."""
    model: str
    count: int | None
    modes: int | None
    """That the exact beam keeps; None is as many as it does unless told."""
    start: Start
    soft_start_periods: float
    modal_damping: float | None

    def check(self, *, slider: Slider | None, step: float | None, steps_per_period: int) -> None:
        """Raise InputError for what `run` refuses before anything is solved; steps are a slider's, where one is."""
        if slider is not None:
            slider.check_stays()
        requested(
            Driven(self.beam, self.forces, self.frequency_hz, self.duration),
            Modelled(self.model, self.count, self.modes, self.modal_damping),
            Started(self.start, self.soft_start_periods, (), None),
            Watched((), 2, step, steps_per_period if slider else STEPS_PER_PERIOD, ledger=False),
            slider,
        )

    def run(
        self,
        *,
        slider: Slider | None = None,
        at: Sequence[float] = (),
        samples: int = 2,
        step: float | None = None,
        steps_per_period: int = STEPS_PER_PERIOD,
        ledger: bool = False,
        progress: Callable[[float], None] = lambda part: None,
        patient: bool = True,
    ) -> Motion:
        """The motion, kept at `samples` times and, of the beam, at the places `at`. Raises InputError."""
        return simulate(
            **asdict(self),
            slider=slider,
            at=at,
            samples=samples,
            step=step,
            ledger=ledger,
            progress=progress,
            patient=patient,
            steps_per_period=steps_per_period,
        )
