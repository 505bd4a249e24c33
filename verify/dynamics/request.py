"""A validated simulation request: sliders, damping, time steps of the envelope, continuation of a run."""

from collections.abc import Sequence
from math import inf
from typing import Any

import msgspec
import numpy as np
from msgspec.structs import replace

from verify.actuators.on_beam import Mounted
from verify.arrays import Array
from verify.dynamics.circuits import check_circuits
from verify.dynamics.contact_assembly import check_sliders
from verify.dynamics.excitation import CONSTANT, SMOOTH_STEP, check_damping
from verify.dynamics.linear_system import Growth, Stage, cut
from verify.dynamics.result import EndState
from verify.errors import InputError, shown, written
from verify.linear.mesh import part_counts
from verify.linear.positions import loads_on, vector_on
from verify.linear.registry import MODELS
from verify.linear.time_basis import Ratio, TimeBasis, damping_in
from verify.problem.beam import Beam, PointLoad, check_frequency
from verify.problem.slider import GRAVITY, Slider
from verify.validation import as_tuple, check_integer, check_number, check_type, check_unmasked, python_scalar

STEPS_PER_PERIOD, FEET_STEPS_PER_PERIOD = 64, 61
"""Least number of time steps per drive period. For feet it is prime, so that equally spaced points on a wave do not
all reverse their friction in the same steps."""
FEET_MODES = 80
"""Default number of modes of the exact beam under feet."""
SHORTEST = 1e-100
"""Least duration, s, and least growth in periods (a shorter growth is a step): squares do not underflow."""
COARSEST = 0.25
"""Largest step of a slider in drive periods."""
MOST_PERIODS = 1e12
"""Number of drive periods after which rounding of the phase is 1e-3 rad."""
MOST_STEPS = 2e9
MOST_SAMPLES = 10_000_000
Envelope = Sequence[tuple[float, Sequence[float]]]
"""Envelope of the forces: pieces (seconds, coefficients of ascending powers of t / seconds)."""


class Request(msgspec.Struct, frozen=True, eq=False, kw_only=True):
    """A validated simulation, its time divided into steps."""

    beam: Beam
    forces: tuple[PointLoad, ...]
    frequency_hz: float
    model: str
    count: int | None
    modes: int | None
    start: str
    modal_damping: float | None
    """Damping ratio of every mode; None: by the beam's loss factor."""
    sliders: tuple[Slider, ...]
    starts: tuple[float, ...]
    """Initial positions of the sliders, m; in a continued run those of the first run."""
    prescribed_speeds: tuple[float | None, ...]
    fixed: tuple[bool, ...]
    points: Array
    pieces: tuple[Growth, ...]
    step: float | None
    before: EndState | None
    circuits: tuple[Mounted, ...] = ()

    @property
    def omega(self) -> float:
        """2 pi f, rad/s."""
        return 2.0 * np.pi * self.frequency_hz

    @property
    def feet(self) -> bool:
        """Whether the sliders have unilateral contact."""
        return bool(self.sliders) and self.sliders[0].contact is not None

    @property
    def two_way(self) -> bool:
        """Whether the sliders act on the beam."""
        return bool(self.sliders) and self.sliders[0].coupling == "two-way"

    @property
    def sticks_in_several_ways(self) -> bool:
        """Whether static friction above the kinetic one holds several rigid points of feet."""
        holds = any(slider.mu_static is not None and slider.mu_static > slider.mu for slider in self.sliders)
        points = [foot.points for slider in self.sliders for foot in slider.feet]
        return self.feet and holds and sum(points) > 1

    @property
    def gravity(self) -> float:
        """Least normal force over moving mass of the sliders, m/s^2; without sliders standard gravity."""
        return min((slider.effective_gravity for slider in self.sliders), default=GRAVITY)

    def damping_in(self, basis: TimeBasis | None) -> Ratio:
        """Damping ratio of all modes of a basis, or (n,) of each. Raises InputError for an overdamped mode."""
        return 0.0 if basis is None else damping_in(basis, self.modal_damping)

    def notes(self, basis: TimeBasis | None) -> tuple[str, ...]:
        """Notes on modes, damping and growth of the forces."""
        notes = [f"modes: {basis.method}" if basis else f"steady field of the {self.model} model, no modes"]
        if self.modal_damping is not None:
            notes.append(f"damping: ratio {self.modal_damping:g}")
        elif self.beam.loss_factor:
            notes.append(f"damping: loss factor {self.beam.loss_factor:g}")
        if len(self.pieces) > 1:
            notes.append(f"forces grow over {sum(piece.steps.duration for piece in self.pieces[:-1]):.6g} s")
            reached = float(np.sum(self.pieces[-2].coefficients))
            if abs(reached - 1.0) >= 1e-9:
                notes.append(f"forces jump from {reached:.6g} times their amplitude to all of it")
        return tuple(notes)

    def end(self, stage: Stage, z: Any, time: float, **contact: Any) -> EndState:
        """The end state at a time, s, with the total state z of the last stage."""
        q, rates = stage.rows.state(z)
        steady = self.start == "steady"
        return EndState(
            beam=self.beam, model=self.model, count=self.count, time=time, q=q, rates=rates, steady=steady, **contact
        )

    def split(self, outputs: Array) -> list[Array]:
        """Deflections (n, p), voltages and charges (n, circuits) of outputs (n, p + 2 circuits)."""
        return np.split(outputs, [len(self.points), len(self.points) + len(self.circuits)], axis=1)

    def continued(self, stage: Stage) -> Any:
        """Total state z at the end of the earlier run. Raises InputError for other modes."""
        before, sizes = self.before, stage.rows.sizes
        assert before is not None
        if (n := len(before.q)) not in sizes:
            raise InputError(f"continue_from has {n} modes and this run {sizes[0]}: give both the same modes")
        return stage.rows.of_state(before.q, before.rates)


def request_of(
    beam: Beam, forces: Any, frequency_hz: float, duration: float, *, model: str, count: int | None, modes: int | None,
    start: str | None, soft_start_periods: float, envelope: Envelope, modal_damping: float | None, slider: Any,
    prescribed_speed: Any, fixed_position: Any, at: Any, samples: int, step: float | None,
    steps_per_period: int | None, continue_from: Any, circuits: Any = (),
) -> Request:  # fmt: skip
    """A validated request; arguments as in `simulate`. Raises InputError."""
    check_frequency("frequency_hz", frequency_hz, beam)
    check_number("duration", duration, "seconds", at_least=SHORTEST)
    check_integer("samples", samples, 2, MOST_SAMPLES)
    check_damping(beam, modal_damping)
    kind, sliders = MODELS.named(model), () if slider is None else as_tuple("slider", slider, Slider)
    driven, electrical = loads_on(beam, forces, PointLoad), as_tuple("circuits", circuits, Mounted)
    check_circuits(beam, electrical, 2.0 * np.pi * frequency_hz)
    if not driven and not sliders and not electrical:
        raise InputError("forces is empty: give at least one PointForce")
    feet, two_way = (bool(sliders) and sliders[0].contact is not None), (sliders and sliders[0].coupling == "two-way")
    start = ("steady" if feet else "rest") if start is None else start
    if start not in ("rest", "steady"):
        raise InputError(f"start = {start!r} is not known: known are rest, steady")
    if sliders and sliders[0].line == "raw" and ("raw" not in kind.lines or start == "steady"):
        raise InputError("slider.line = 'raw': this model and start have no straight edges of links, leave it out")
    if modes is not None and start == "steady" and not two_way:
        raise InputError(f"modes = {modes!r}: a steady field without two-way coupling uses no modes, leave it out")
    before = _before(continue_from, beam, model, count, start, sliders)
    if frequency_hz * (duration + (before.time if before else 0.0)) > MOST_PERIODS:
        raise InputError(f"duration = {duration!r} s: rounding makes the phase unknown after 1e12 periods, shorten it")
    replaced = modal_damping != 0.5 * beam.loss_factor or bool(beam.loss_factor and beam.lossless)
    own = before.starts if before and before.contact is not None and sliders else ()
    starts = own or tuple(one.initial_position(beam) for one in sliders)
    if sliders:
        check_sliders(beam, sliders, starts)
    speeds = _each("prescribed_speed", prescribed_speed, len(sliders))
    fixed = tuple(python_scalar(one) for one in _each("fixed_position", fixed_position, len(sliders)))
    for speed, one in zip(speeds, fixed, strict=True):
        check_number("prescribed_speed", 0.0 if speed is None else speed, "m/s")
        check_type("fixed_position", one, bool)
    grown = _growth(soft_start_periods, envelope, frequency_hz, start == "steady" or before is not None)
    longest = _longest_step(frequency_hz, duration, step, steps_per_period, sliders)
    return Request(
        beam=beam,
        forces=driven,
        frequency_hz=frequency_hz,
        model=model,
        count=count,
        modes=FEET_MODES if modes is None and feet and not kind.sized else modes,
        start=start,
        modal_damping=modal_damping if replaced else None,
        sliders=sliders,
        starts=starts,
        prescribed_speeds=speeds,
        fixed=fixed,
        points=vector_on("at", at, beam.length),
        pieces=_cut(duration, grown, longest, samples - 1),
        step=step,
        before=before,
        circuits=electrical,
    )


def _each(field: str, given: Any, n: int) -> tuple[Any, ...]:
    """One value for each slider. Raises InputError."""
    row = given.tolist() if getattr(given, "shape", ()) else given
    values = tuple(row) if isinstance(row, Sequence) else (row,) * n
    if len(values) != n:
        raise InputError(f"{field} has {len(values)} values for {n} sliders: give one per slider, or one for all")
    return values


def _growth(soft: float, envelope: Envelope, frequency_hz: float, moves: bool) -> list[tuple[float, Array]]:
    """Pieces (seconds, coefficients) of the growth of the forces. Raises InputError."""
    check_number("soft_start_periods", soft, "periods of the drive", at_least=0)
    check_unmasked("envelope", envelope)
    try:
        pieces = [(float(seconds), np.asarray(c, dtype=float)) for seconds, c in envelope]
        good = all(0.0 < s < inf and c.ndim == 1 and len(c) and np.isfinite(c).all() for s, c in pieces)
    except (TypeError, ValueError):
        pieces, good = [], False
    if not good:
        raise InputError(f"envelope = {shown(envelope)}: give pieces (seconds above 0, finite coefficients)")
    if soft and pieces:
        raise InputError(f"soft_start_periods = {soft!r} and envelope = {shown(envelope)}: give one of the two")
    if (soft or pieces) and moves:
        given = f"soft_start_periods = {soft!r}" if soft else f"envelope = {shown(envelope)}"
        raise InputError(f"{given} with start = 'steady' or continue_from: growth starts from rest, leave it out")
    return [(soft / frequency_hz, SMOOTH_STEP)] if soft >= SHORTEST else pieces


def _longest_step(
    frequency_hz: float, duration: float, step: float | None, steps_per_period: int | None, sliders: Sequence[Slider]
) -> float:
    """Largest time step of a slider, s; infinite without slider. Raises InputError."""
    if not sliders:
        if step is not None or steps_per_period is not None:
            name = "steps_per_period" if step is None else "step"
            raise InputError(f"{name}: a beam without slider has no time steps, leave it out or give slider")
        return inf
    least = STEPS_PER_PERIOD if sliders[0].contact is None else FEET_STEPS_PER_PERIOD
    per_period = least if steps_per_period is None else steps_per_period
    check_integer("steps_per_period", per_period, 1)
    longest = 1.0 / (per_period * frequency_hz) if step is None else step
    check_number("step", longest, "seconds", above=0)
    if longest * frequency_hz > COARSEST:
        most = f"{COARSEST / frequency_hz:.3g} s"
        raise InputError(f"step = {longest!r} s does not resolve the drive: give at most {most}")
    check_steps(duration, longest)
    return longest


def check_steps(duration: float, step: float) -> None:
    """Raise InputError for too many steps of this length, s."""
    if duration / step > MOST_STEPS:
        raise InputError(
            f"duration = {written(duration)} s: {duration / step:.2g} steps are too many, shorten it or lengthen step"
        )


def _cut(duration: float, grown: list[tuple[float, Array]], longest: float, samples: int) -> tuple[Growth, ...]:
    """Time steps of the envelope's pieces and of the constant forces after them; samples in proportion to duration.

    At least one sample per piece. Raises InputError.
    """
    total = sum(seconds for seconds, _ in grown)
    rest = duration - total
    if rest < -1e-12 * duration:
        raise InputError(
            f"soft_start_periods or envelope last {written(total)} s: increase duration = {written(duration)} s"
        )
    pieces = grown + ([(rest, CONSTANT)] if rest > 1e-12 * duration else [])
    shares = [max(round(samples * seconds / duration), 1) for seconds, _ in pieces]
    shares[-1] = samples - sum(shares[:-1])
    if shares[-1] < 1:
        shares = part_counts([seconds for seconds, _ in pieces], max(samples, len(pieces)))
    return tuple(Growth(cut(seconds, longest, share), c) for (seconds, c), share in zip(pieces, shares, strict=True))


def _before(
    run: Any, beam: Beam, model: str, count: int | None, start: str, sliders: Sequence[Slider]
) -> EndState | None:
    """The state that a run continues. Raises InputError for another beam, model, start or slider."""
    if run is None:
        return None
    before = getattr(run, "end", None)
    if not isinstance(before, EndState):
        raise InputError(f"continue_from = {shown(run)}: give a Motion or a FreeVibration")
    ran = (before.model, before.count, "steady" if before.steady else "rest")
    for name, here, there in zip(("model", "count", "start"), (model, count, start), ran, strict=True):
        if here != there:
            raise InputError(f"{name} = {here!r}: continue_from is a run with {name} = {there!r}, give the same")
    if replace(before.beam, loss_factor=0.0) != replace(beam, loss_factor=0.0):
        raise InputError("continue_from is a run of another beam: give the same beam (loss_factor may differ)")
    if before.contact is None or not sliders:
        return before
    if before.off:
        raise InputError(f"continue_from: its slider {before.off}, continue a run whose slider did not")
    if len(sliders) != len(before.starts):
        raise InputError(f"continue_from has {len(before.starts)} sliders and this run {len(sliders)}: give as many")
    states = zip(sliders, before.starts, before.contact.sliders.tolist(), before.sliders, strict=True)
    for slider, first, (travelled, speed), earlier in states:
        own = (slider.position, (None, first, first + travelled)), (slider.speed, (0.0, earlier.speed, speed))
        for name, (value, known) in zip(("position", "speed"), own, strict=True):
            if value not in known:
                raise InputError(f"slider.{name} = {value!r}: the earlier run ends with {known[-1]!r}, leave it out")
    return before
