"""A checked simulation request: damping, start, the forces' envelope cut into steps, continuation of an earlier run."""

from collections.abc import Sequence
from math import inf
from typing import TYPE_CHECKING, Any

import msgspec
import numpy as np
from msgspec.structs import replace

from verify.arrays import Array
from verify.errors import InputError, shown, written
from verify.linear.mesh import part_counts
from verify.linear.positions import Numbers, forces_on, vector_on
from verify.linear.registry import MODELS
from verify.linear.time_basis import Ratio, TimeBasis, damping_in
from verify.motion.forcing import CONSTANT, SMOOTH_STEP, check_phase
from verify.motion.result import EndState, Motion
from verify.motion.surface import Growth, check_line, cut
from verify.problem.beam import Beam, PointForce, check_frequency
from verify.problem.slider import Slider
from verify.validation import check_kind, check_number, check_unmasked, check_whole

if TYPE_CHECKING:
    from verify.dynamics.free_vibration import FreeVibration
    from verify.motor.result import MotorState

STEPS_PER_PERIOD = 64
"""Least number of a slider's steps in a period of the drive; `step_control` shortens them further."""
SOFT_START_PERIODS = 2.0
"""Of the drive. Forces that act at once excite all modes, and a slider's path under them does not converge."""
SHORTEST = 1e-100
"""Seconds of a motion, and periods of its growth: their squares are numbers."""
COARSEST = 0.25
"""Longest step of a slider in periods of the drive."""
MOST_STEPS = 2e9
MOST_SAMPLES = 10_000_000
Envelope = Sequence[tuple[float, Sequence[float]]]
"""Pieces (seconds, coefficients of ascending powers of t / seconds, 0 to 1 within each) of the forces' amplitude."""


def soft_start(start: str, periods: float | None) -> float:
    """Periods over which the forces grow: as given, else two from rest and none where the beam moves already."""
    if periods is not None:
        return periods
    return SOFT_START_PERIODS if start == "rest" else 0.0


class Request(msgspec.Struct, frozen=True, eq=False, kw_only=True):
    """A simulation, checked, with its time cut into steps."""

    beam: Beam
    forces: tuple[PointForce, ...]
    frequency_hz: float
    model: str
    count: int | None
    modes: int | None
    start: str
    damping: float
    """Ratio of every mode: as given, else half the beam's loss factor."""
    own_damping: bool
    """Whether no ratio was given."""
    slider: Slider | None
    points: Array
    pieces: tuple[Growth, ...]
    """Cut into the longest steps allowed, of a beam alone from sample to sample."""
    step: float | None
    """Seconds, as given; None where step control chooses it."""
    accounts: bool
    before: Any

    @property
    def omega(self) -> float:
        """2 pi f, rad/s."""
        return 2.0 * np.pi * self.frequency_hz

    @property
    def origin(self) -> float:
        """Seconds that have passed when this run begins."""
        return self.before.time if self.before else 0.0

    @property
    def damping_replaced(self) -> bool:
        """Whether a ratio of every mode replaces the beam's loss factor."""
        given = not self.own_damping and bool(self.beam.loss_factor and self.beam.lossless)
        return given or self.damping != 0.5 * self.beam.loss_factor

    def damping_in(self, basis: TimeBasis | None) -> Ratio:
        """Damping ratio of all modes of a basis, a number or (n,). Raises InputError for an overdamped mode."""
        return self.damping if basis is None else damping_in(basis, self.damping if self.damping_replaced else None)

    @property
    def line(self) -> str:
        """The contact line."""
        return self.slider.line if self.slider else "spline"


def requested(
    beam: Beam,
    forces: tuple[PointForce, ...],
    frequency_hz: float,
    duration: float,
    *,
    model: str,
    count: int | None,
    modes: int | None,
    modal_damping: float | None,
    start: str,
    soft_start_periods: float,
    at: Numbers,
    samples: int,
    step: float | None,
    steps_per_period: int,
    slider: Slider | None,
    envelope: Envelope = (),
    before: "Motion | FreeVibration | None" = None,
    ledger: bool = False,
    default_modes: int | None = None,
) -> Request:
    """A checked request; arguments as those of `simulate`. Raises InputError."""
    check_frequency("frequency_hz", frequency_hz, beam)
    if not forces_on(beam, forces):
        raise InputError("forces is empty: give at least one PointForce")
    check_number("duration", duration, "seconds", above=0)
    check_number("duration", duration, "seconds", at_least=SHORTEST)
    check_kind("ledger", ledger, bool)
    _check_start(model, start, soft_start_periods, envelope, before)
    check_whole("samples", samples, 2)
    if samples > MOST_SAMPLES:
        raise InputError(f"samples = {samples!r}: keep between 2 and {MOST_SAMPLES} of them")
    zeta = 0.5 * beam.loss_factor if modal_damping is None else modal_damping
    field = "half of beam.loss_factor" if modal_damping is None else "modal_damping"
    check_number(field, zeta, "ratio of every mode", at_least=0, below=1)
    points = vector_on("at", at, beam.length)
    longest = _longest(frequency_hz, duration, step, steps_per_period, slider)
    check_line(model, start, slider.line if slider else "spline")
    if before is not None and slider is not None:
        _check_same_slider(before, slider)
    check_phase("the drive", frequency_hz, duration, before.end.time if before else 0.0)
    kept = default_modes if modes is None and not MODELS.named(model).sized else modes
    if modes is not None and start == "steady" and slider is None:
        raise InputError(f"modes = {modes!r}: a beam with start = 'steady' has a field and no modes, leave it out")
    return Request(
        beam=beam,
        forces=forces,
        frequency_hz=frequency_hz,
        model=model,
        count=count,
        modes=kept,
        start=start,
        damping=zeta,
        own_damping=modal_damping is None,
        slider=slider,
        points=points,
        accounts=ledger,
        step=step,
        before=before.end if before else None,
        pieces=laid_out(duration, _grown(soft_start_periods, envelope, frequency_hz), longest, samples - 1),
    )


def _check_start(
    model: str, start: str, soft: float, envelope: Envelope, before: "Motion | FreeVibration | None"
) -> None:
    check_number("soft_start_periods", soft, "periods of the drive", at_least=0)
    if 0.0 < soft < SHORTEST:
        raise InputError(f"soft_start_periods = {soft!r}: give 0, or at least {SHORTEST:g}, whose square is a number")
    MODELS.named(model)
    if before is not None and not isinstance(getattr(before, "end", None), EndState):
        raise InputError(f"continue_from = {shown(before)}: give a Motion or a FreeVibration")
    if start not in ("rest", "steady"):
        raise InputError(f"start = {start!r} is not known: known are rest, steady")
    grows = not (isinstance(envelope, tuple | list) and not envelope)
    if (soft or grows) and (start == "steady" or before):
        given = f"soft_start_periods = {soft!r}" if soft else f"envelope = {shown(envelope)}"
        moves = "start = 'steady'" if start == "steady" else "continue_from"
        raise InputError(f"{given} with {moves}: a beam that moves already has no start, leave it out")
    if soft and grows:
        raise InputError(f"soft_start_periods = {soft!r} and envelope = {shown(envelope)}: give one of the two")


def _grown(soft: float, envelope: Envelope, frequency_hz: float) -> tuple[tuple[float, Array], ...]:
    """The pieces (seconds, coefficients) over which the forces grow."""
    if soft:
        return ((soft / frequency_hz, SMOOTH_STEP),)
    check_unmasked("envelope", envelope)
    try:
        found = tuple((float(seconds), np.asarray(c, dtype=float)) for seconds, c in envelope)
    except (TypeError, ValueError):
        found = ((0.0, np.zeros(())),)
    if any(c.ndim != 1 for _, c in found):
        raise InputError(f"envelope = {shown(envelope)}: give pieces (seconds, coefficients)")
    return found


def _longest(
    frequency_hz: float, duration: float, step: float | None, steps_per_period: int, slider: Slider | None
) -> float:
    """The longest step of a slider, seconds; infinite without one. Raises InputError."""
    check_whole("steps_per_period", steps_per_period, 1)
    if slider is None:
        for name, given, own in (("step", step, None), ("steps_per_period", steps_per_period, STEPS_PER_PERIOD)):
            if given != own:
                raise InputError(f"{name} = {shown(given)} is a slider's: a beam alone takes no steps, leave it out")
        return inf
    longest = 1.0 / (steps_per_period * frequency_hz) if step is None else step
    check_number("step", longest, "seconds", above=0)
    check_seen(longest, frequency_hz)
    if duration / longest > MOST_STEPS:
        raise InputError(
            f"step = {longest!r} takes more than {MOST_STEPS:g} steps: lengthen the step or shorten the duration"
        )
    return longest


def check_seen(step: float, frequency_hz: float) -> None:
    """Raise InputError for a slider's step, seconds, that does not resolve the period of the drive."""
    if step * frequency_hz > COARSEST:
        raise InputError(
            f"step = {step!r} s is {step * frequency_hz:.3g} periods of the drive, which it does not resolve: "
            f"give at most {COARSEST / frequency_hz:.3g} s"
        )


def laid_out(duration: float, grown: Sequence[tuple[float, Array]], longest: float, samples: int) -> tuple[Growth, ...]:
    """Steps of every piece of the envelope and of the constant forces after it, samples shared by length.

    As many samples as requested, or one for each piece where those are more. Raises InputError.
    """
    lengths = [seconds for seconds, _ in grown]
    if any(not 0.0 < s < np.inf for s in lengths) or any(not len(c) or not np.all(np.isfinite(c)) for _, c in grown):
        raise InputError(
            "envelope: give pieces (seconds, coefficients), each longer than 0 s and of finite coefficients"
        )
    rest = duration - sum(lengths)
    if rest < -1e-12 * duration:
        soft = any(coefficients is SMOOTH_STEP for _, coefficients in grown)
        raise InputError(
            f"the forces grow over {written(sum(lengths))} s of duration = {written(duration)} s: "
            f"{'lower soft_start_periods' if soft else 'shorten envelope'}, or lengthen the duration"
        )
    pieces = list(grown) + ([(rest, CONSTANT)] if rest > 1e-12 * duration else [])
    shares = [max(round(samples * seconds / duration), 1) for seconds, _ in pieces]
    shares[-1] = samples - sum(shares[:-1])
    if shares[-1] < 1:
        shares = part_counts([seconds for seconds, _ in pieces], max(samples, len(pieces)))
    return tuple(Growth(cut(seconds, longest, share), c) for (seconds, c), share in zip(pieces, shares, strict=True))


def _check_same_slider(before: "Motion | FreeVibration", slider: Slider) -> None:
    """Raise InputError for a slider placed elsewhere than where the slider of the earlier run is by now."""
    own, end = getattr(before, "slider", None), before.end
    if own is None or end.off or end.position is None or not 0.0 <= end.position <= end.beam.length:
        return  # the run is refused for that where it begins
    for name, unit, unsaid, ended in (("position", "m", None, end.position), ("speed", "m/s", 0.0, end.speed)):
        given = getattr(slider, name)
        if given not in (unsaid, getattr(own, name), ended):
            raise InputError(
                f"slider.{name} = {given!r}: the slider continues from {ended!r} {unit}; give the {name} of the "
                f"earlier run's slider, {getattr(own, name)!r}, or none"
            )


def check_same_beam(before: "EndState | MotorState", beam: Beam, model: str, count: int | None) -> None:
    """Raise InputError where a run continues one of another beam (but for its loss factor) or another model."""
    if (before.model, before.count) != (model, count):
        raise InputError(
            f"continue_from is of model = {before.model!r}, count = {before.count!r} and this run of "
            f"model = {model!r}, count = {count!r}: give both the same"
        )
    if replace(before.beam, loss_factor=0.0) != replace(beam, loss_factor=0.0):
        raise InputError("continue_from is of another beam: give the one it was run with, but for loss_factor")


def check_same_modes(before: "EndState | MotorState", n: int, start: str) -> None:
    """Raise InputError where the n free modes of a run are not those of the run that it continues."""
    if not len(before.q):
        raise InputError(
            "continue_from is a run with start = 'steady', which has no free modes: continue one with start = 'rest'"
        )
    if (start == "steady") != before.steady:
        own = "steady" if before.steady else "rest"
        raise InputError(f"start = {start!r}: continue_from is a run with start = {own!r}, give that")
    if not n:
        raise InputError(
            "start = 'steady' without two-way coupling has no free modes, and those of continue_from would be lost: "
            "put a slider on with coupling = 'two-way'"
        )
    if len(before.q) != n:
        raise InputError(f"continue_from has {len(before.q)} modes and this run {n}: give both the same modes")
