"""A simulation as it was asked for: checked, its envelope cut into pieces."""

from collections.abc import Sequence
from math import inf
from typing import TYPE_CHECKING

import msgspec
import numpy as np

from verify.beam import Beam, PointForce
from verify.checks import check_kind, check_number, check_unmasked, check_whole
from verify.errors import InputError, shown, written
from verify.models.arrays import Array
from verify.models.catalogue import EXACT_MODES, MODELS, kept_modes
from verify.models.division import part_counts
from verify.models.fields import check_drive
from verify.models.places import Numbers, places_in_a_row
from verify.models.time_basis import Ratio, TimeBasis, damping_in
from verify.motion.forcing import CONSTANT, SMOOTH_STEP, check_phase
from verify.motion.result import EndState, Motion
from verify.motion.surface import Growth, check_line, cut
from verify.slider import Slider

if TYPE_CHECKING:
    from verify.motion.free_vibration import FreeVibration

STEPS_PER_PERIOD = 64
"""At least: more where the start excites faster modes (`step_size`) or a slider's way asks for it (`judged_step`)."""
SHORTEST = 1e-100
"""Seconds of a motion, and periods of its growth: their squares are numbers."""
COARSEST = 0.25
"""Of a period: longer steps of a slider are refused."""
MOST_STEPS = 2e9
MOST_SAMPLES = 10_000_000
Envelope = Sequence[tuple[float, Sequence[float]]]
"""Pieces (seconds, coefficients of ascending powers of t / seconds, 0 to 1 within each) of the forces' amplitude."""


class Request(msgspec.Struct, frozen=True, eq=False, kw_only=True):
    """A simulation, checked and with its steps laid out."""

    beam: Beam
    forces: tuple[PointForce, ...]
    frequency_hz: float
    model: str
    count: int | None
    modes: int
    start: str
    damping: float
    """Ratio of every mode: as given, else half the beam's loss factor."""
    own_damping: bool
    """Whether none was given."""
    slider: Slider | None
    points: Array
    pieces: tuple[Growth, ...]
    """Cut into steps of the longest length allowed, of a beam alone from sample to sample; a slider's run may take
    shorter ones."""
    step: float | None
    """Seconds, as given; None where the step follows what the start excites."""
    accounts: bool
    before: EndState | None

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
        """Whether a ratio of every mode stands in place of what the beam's loss factor comes to."""
        given = not self.own_damping and bool(self.beam.loss_factor and self.beam.lossless)
        return given or self.damping != 0.5 * self.beam.loss_factor

    def damping_in(self, basis: TimeBasis | None) -> Ratio:
        """Of all modes of a basis, a number or (n,), else as asked. Raises InputError where a mode does not swing."""
        return self.damping if basis is None else damping_in(basis, self.damping if self.damping_replaced else None)

    @property
    def line(self) -> str:
        """The contact line."""
        return self.slider.line if self.slider else "spline"


class Driven(msgspec.Struct, frozen=True, eq=False):
    """What moves, and for how long."""

    beam: Beam
    forces: tuple[PointForce, ...]
    frequency_hz: float
    duration: float
    """Seconds."""


class Modelled(msgspec.Struct, frozen=True, eq=False):
    """By which model of the beam."""

    model: str
    count: int | None
    modes: int | None
    """That the exact beam keeps; None is `otherwise`."""
    damping: float | None
    """Ratio of every mode; None is what the beam's loss factor comes to."""
    otherwise: int = EXACT_MODES


class Started(msgspec.Struct, frozen=True, eq=False):
    """From where."""

    start: str
    soft: float
    """Periods of the drive over which the forces grow."""
    envelope: Envelope
    before: "Motion | FreeVibration | None"


class Watched(msgspec.Struct, frozen=True, eq=False):
    """What is kept, and in which steps."""

    at: Numbers
    samples: int
    step: float | None
    steps_per_period: int
    ledger: bool


def requested(driven: Driven, modelled: Modelled, started: Started, watched: Watched, slider: Slider | None) -> Request:
    """A checked request. Raises InputError."""
    beam, hertz = driven.beam, driven.frequency_hz
    check_drive(beam, driven.forces, hertz)
    check_number("duration", driven.duration, "seconds", above=0)
    check_number("duration", driven.duration, "seconds", at_least=SHORTEST)
    check_kind("ledger", watched.ledger, bool)
    _check_start(modelled.model, started)
    _check_samples(watched.samples)
    zeta = 0.5 * beam.loss_factor if modelled.damping is None else modelled.damping
    said = "half of beam.loss_factor" if modelled.damping is None else "modal_damping"
    check_number(said, zeta, "ratio of every mode", at_least=0, below=1)
    points = places_in_a_row("at", watched.at, beam.length)
    longest = _longest(hertz, driven.duration, watched.step, watched.steps_per_period, slider)
    check_line(modelled.model, started.start, slider.line if slider else "spline")
    before = started.before.end if started.before else None
    if slider is not None and started.before is not None:
        _check_goes_on(started.before, slider)
    check_phase("the drive", hertz, driven.duration, before.time if before else 0.0)
    return Request(
        beam=beam,
        forces=driven.forces,
        frequency_hz=hertz,
        model=modelled.model,
        count=modelled.count,
        modes=_modes(modelled, alone_steady=started.start == "steady" and slider is None),
        start=started.start,
        damping=zeta,
        own_damping=modelled.damping is None,
        slider=slider,
        points=points,
        accounts=watched.ledger,
        step=watched.step,
        before=before,
        pieces=laid_out(driven.duration, _grown(started, hertz), longest, watched.samples - 1),
    )


def _modes(modelled: Modelled, alone_steady: bool) -> int:
    """How many are kept. Raises InputError for a number of them where none is needed."""
    kept = kept_modes(modelled.model, modelled.modes, modelled.otherwise)
    if modelled.modes is not None and alone_steady:
        raise InputError(
            f"modes = {modelled.modes!r}: a beam with start = 'steady' has a field and no modes, leave it out"
        )
    return kept


def _grown(started: Started, frequency_hz: float) -> tuple[tuple[float, Array], ...]:
    """The pieces (seconds, coefficients) over which the forces grow."""
    if started.soft:
        return ((started.soft / frequency_hz, SMOOTH_STEP),)
    check_unmasked("envelope", started.envelope)
    try:
        found = tuple((float(seconds), np.asarray(c, dtype=float)) for seconds, c in started.envelope)
    except (TypeError, ValueError):
        found = ((0.0, np.zeros(())),)
    if any(c.ndim != 1 for _, c in found):
        raise InputError(f"envelope = {shown(started.envelope)}: give pieces (seconds, coefficients)")
    return found


def _check_samples(samples: int) -> None:
    check_whole("samples", samples, 2)
    if samples > MOST_SAMPLES:
        raise InputError(f"samples = {samples!r}: keep between 2 and {MOST_SAMPLES} of them")


def _check_start(model: str, started: Started) -> None:
    start, soft, envelope, before = started.start, started.soft, started.envelope, started.before
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


def _check_goes_on(before: "Motion | FreeVibration", slider: Slider) -> None:
    """Raise InputError for a slider that is put elsewhere than where the one of the run before is by now."""
    own = getattr(before, "slider", None)
    end = before.end
    if own is None or end.off or end.position is None or not 0.0 <= end.position <= end.beam.length:
        return  # nobody goes on from there
    for name, unit, unsaid, ended in (("position", "m", None, end.position), ("speed", "m/s", 0.0, end.speed)):
        given = getattr(slider, name)
        if given not in (unsaid, getattr(own, name), ended):
            raise InputError(
                f"slider.{name} = {given!r}: the slider goes on as continue_from left it, at {ended!r} {unit}; give "
                f"the {name} of that run's slider, {getattr(own, name)!r}, or none"
            )


def _longest(
    frequency_hz: float, duration: float, step: float | None, steps_per_period: int, slider: Slider | None
) -> float:
    """The longest step of a slider, seconds; endless without one. Raises InputError."""
    check_whole("steps_per_period", steps_per_period, 1)
    if slider is None:
        _check_alone(step, steps_per_period)
        return inf
    longest = 1.0 / (steps_per_period * frequency_hz) if step is None else step
    check_number("step", longest, "seconds", above=0)
    check_seen(longest, frequency_hz)
    if duration / longest > MOST_STEPS:
        raise InputError(
            f"step = {longest!r} takes more than {MOST_STEPS:g} steps: lengthen the step or shorten the duration"
        )
    return longest


def _check_alone(step: float | None, steps_per_period: int) -> None:
    """Raise InputError for the steps of a beam without a slider."""
    for name, given, own in (("step", step, None), ("steps_per_period", steps_per_period, STEPS_PER_PERIOD)):
        if given != own:
            raise InputError(f"{name} = {shown(given)} is a slider's: a beam alone takes no steps, leave it out")


def check_seen(step: float, frequency_hz: float) -> None:
    """Raise InputError for a slider's step, seconds, in which too much of a period of the drive passes."""
    if step * frequency_hz > COARSEST:
        raise InputError(
            f"step = {step!r} s is {step * frequency_hz:.3g} periods of the drive, which a slider would not see: "
            f"give at most {COARSEST / frequency_hz:.3g} s"
        )


def _check_growth(duration: float, grown: Sequence[tuple[float, Array]]) -> None:
    """Raise InputError where forces grow for longer, seconds, than they act."""
    growing = sum(seconds for seconds, _ in grown)
    soft = any(coefficients is SMOOTH_STEP for _, coefficients in grown)
    if duration - growing < -1e-12 * duration:
        raise InputError(
            f"the forces grow over {written(growing)} s of duration = {written(duration)} s: "
            f"{'lower soft_start_periods' if soft else 'shorten envelope'}, or lengthen the duration"
        )


def laid_out(duration: float, grown: Sequence[tuple[float, Array]], longest: float, samples: int) -> tuple[Growth, ...]:
    """Steps of every piece of the envelope and of the constant forces after it, samples shared by length.

    As many samples as are asked for, or one for each stretch where those are more.
    """
    lengths = [seconds for seconds, _ in grown]
    if any(not 0.0 < s < np.inf for s in lengths) or any(not len(c) or not np.all(np.isfinite(c)) for _, c in grown):
        raise InputError(
            "envelope: give pieces (seconds, coefficients), each longer than 0 s and of finite coefficients"
        )
    _check_growth(duration, grown)
    rest = duration - sum(lengths)
    pieces = list(grown) + ([(rest, CONSTANT)] if rest > 1e-12 * duration else [])
    shares = [max(round(samples * seconds / duration), 1) for seconds, _ in pieces]
    shares[-1] = samples - sum(shares[:-1])
    if shares[-1] < 1:
        shares = part_counts([seconds for seconds, _ in pieces], max(samples, len(pieces)))
    return tuple(Growth(cut(seconds, longest, share), c) for (seconds, c), share in zip(pieces, shares, strict=True))
