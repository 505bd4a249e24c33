"""What a slider's run can be asked for, and the words for how it was run."""

from collections.abc import Callable
from typing import TYPE_CHECKING

import msgspec

from verify.models.catalogue import MODELS
from verify.units import time_in_words
from verify.words import newtons

if TYPE_CHECKING:
    from verify.motion.contact import Coupling
    from verify.motion.result import Motion, Slid

CHAIN = "chain"
"""What a condition calls the nonlinear chain, which is no model of small vibration."""


class RunFigure(msgspec.Struct, frozen=True, kw_only=True):
    """A named figure of a slider's run."""

    unit: str
    summary: str
    of: "Callable[[Slid, Slid | None], float]"
    """Of the run, and of the one with all phases turned round where `turned` asks for it."""
    turned: bool = False


def felt_in_words(chosen: str, coupling: "Coupling") -> str:
    """Why a slider is coupled two-way that says `chosen`; empty where it is not."""
    if chosen == "one-way":
        return ""
    said = "slider.coupling = 'two-way'; " if chosen == "two-way" else ""
    return said + coupling.told if said or coupling.felt else ""


def left_in_words(found: "Motion", duration: float) -> str:
    """That a slider's run ended before its time, seconds, and why; empty where it did not."""
    if found.statistics.finished or found.statistics.interrupted:
        return ""
    where = f"{found.count} {MODELS[found.model].parts}" if found.count else "the exact beam"
    when = f"after {time_in_words(found.end.time)} of {time_in_words(duration)}"
    return f"on {where} the slider {found.statistics.stopped} {when}"


def _reversal(run: "Slid", turned: "Slid | None") -> float:
    assert turned is not None
    way = run.displacement
    return turned.displacement / way if way else float("nan")


RUN_FIGURES = {
    "slider.displacement": RunFigure(
        unit="m",
        summary="Of the scene's slider along +x after a time.",
        of=lambda run, _: run.displacement,
    ),
    "slider.mean_speed": RunFigure(unit="m/s", summary="Displacement over time.", of=lambda run, _: run.mean_speed),
    "slider.largest_friction": RunFigure(
        unit="N", summary="Largest friction force on the slider.", of=lambda run, _: run.largest_friction
    ),
    "slider.mean_friction": RunFigure(
        unit="N",
        summary="Friction on the slider along +x, mean over time.",
        of=lambda run, _: run.mean_friction,
    ),
    "slider.mean_surface_speed": RunFigure(
        unit="m/s",
        summary="Tangential velocity of the surface under the slider, mean over time.",
        of=lambda run, _: run.mean_surface_speed,
    ),
    "slider.reversal": RunFigure(
        unit="1",
        summary="Displacement with all phases turned round over the displacement; below 0 it reverses.",
        of=_reversal,
        turned=True,
    ),
}
"""By the name of the quantity."""


class Condition(msgspec.Struct, frozen=True, kw_only=True):
    """How a slider was run: what stands beside every figure of it."""

    kinematics: str
    normal: str
    """held: the beam carries the slider's weight and inertia where they are felt; massless: it does not."""
    start: str
    soft_start_periods: float
    forces: tuple[float, ...]
    """Amplitudes, newton."""
    law: str
    mu: float
    slope: float | None
    """K, s/m; None of Coulomb's law, which has none."""
    position: float
    """Where it starts, metres."""
    model: str
    count: int | None
    duration: float

    @property
    def model_words(self) -> str:
        """'49 segments', 'exact beam'."""
        if self.nonlinear:
            return f"{self.count} rigid links, nonlinear"
        model = MODELS.named(self.model)
        return f"{self.count} {model.parts}" if model.sized else model.title

    @property
    def nonlinear(self) -> bool:
        """Whether it is the nonlinear chain."""
        return self.model == CHAIN

    @property
    def kind_words(self) -> str:
        """'chain' for the nonlinear one, else 'linear'."""
        return CHAIN if self.nonlinear else "linear"

    @property
    def start_words(self) -> str:
        """How the beam is set in motion."""
        if self.start == "steady":
            return "beam in its steady state"
        return (
            f"soft start of {self.soft_start_periods:g} periods" if self.soft_start_periods else "switched on at once"
        )

    @property
    def force_words(self) -> str:
        """'1 N', '1 and 0.7 N'."""
        return newtons(self.forces)

    @property
    def run_words(self) -> str:
        """Kinematics, start and duration."""
        return f"{self.kinematics} kinematics, {self.normal} slider, {self.start_words}, {time_in_words(self.duration)}"

    @property
    def words(self) -> str:
        """All of it."""
        slope = "" if self.law == "coulomb" else f", K = {self.slope:g} s/m"
        return (
            f"{self.run_words}, {self.force_words}, mu = {self.mu:g}{slope}, from x = {self.position:g} m, "
            f"{self.model_words}"
        )
