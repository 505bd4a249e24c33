"""A validated simulation request: sliders, damping, time steps of the envelope, continuation of a run."""

from collections.abc import Sequence
from math import inf
from typing import Any

import msgspec
import numpy as np
from msgspec.structs import replace

from verify.actuators.on_beam import Mounted
from verify.arrays import Array, ComplexArray
from verify.dynamics.arguments import SHORTEST, Excitation, Keep, PrescribedSlider, Sliders, Step, sliders_of
from verify.dynamics.contact_assembly import check_sliders
from verify.dynamics.excitation import CONSTANT, check_circuits, check_damping
from verify.dynamics.free_vibration import FreeVibration
from verify.dynamics.linear_system import Stage, Steps, cut
from verify.dynamics.result import EndState, Motion
from verify.errors import InputError, shown, written
from verify.linear.mesh import part_counts
from verify.linear.positions import loads_on, vector_on
from verify.linear.registry import MODELS
from verify.linear.time_basis import Ratio, TimeBasis, damping_in
from verify.problem.beam import Beam, PointLoad, check_frequency, is_lossless
from verify.problem.slider import GRAVITY, Slider
from verify.validation import as_tuple, check_number, check_type, python_scalar

STEPS_PER_PERIOD, FEET_STEPS_PER_PERIOD = 64, 61
"""Least number of time steps per drive period. For feet it is prime, so that equally spaced points on a wave do not
all reverse their friction in the same steps."""
FEET_MODES = 80  # Default number of modes of the exact beam under feet
COARSEST = 0.25
"""Largest step of a slider in drive periods: Simpson's rule misses (pi/4)^4/180 = 0.2 % of a surface speed there."""
MOST_PERIODS = 1e12  # Number of drive periods after which rounding of the phase is 1e-3 rad
MOST_STEPS = 2e9
KEEP = Keep()  # Recorded output by default: no deflection, 201 times


class Request(msgspec.Struct, frozen=True, eq=False, kw_only=True):
    """A validated simulation, its time divided into steps."""

    beam: Beam
    forces: tuple[PointLoad, ...]
    frequency_hz: float
    model: str
    count: int | None
    modes: int | None
    start: str
    modal_damping: float | None  # Damping ratio of every mode; None: by the beam's loss factor
    prescribed: tuple[PrescribedSlider, ...]
    starts: tuple[float, ...]  # Initial positions of the sliders, m; in a continued run those of the first run
    points: Array
    pieces: tuple[tuple[Steps, Array], ...]  # Steps, and the amplitude of the forces as a polynomial of t / duration
    step: float | None
    before: EndState | None
    circuits: tuple[Mounted, ...]
    sequence: bool  # Whether results have an axis of sliders

    @property
    def sliders(self) -> tuple[Slider, ...]:
        """The sliders without their prescribed motion."""
        return tuple(one.slider for one in self.prescribed)

    @property
    def omega(self) -> float:
        """2 pi f, rad/s."""
        return 2.0 * np.pi * self.frequency_hz

    @property
    def origin(self) -> float:
        """Start time of the run, s: the end of the earlier one."""
        return self.before.time if self.before else 0.0

    @property
    def feet(self) -> bool:
        """Whether the sliders have unilateral contact."""
        return bool(self.sliders) and self.sliders[0].contact is not None

    @property
    def two_way(self) -> bool:
        """Whether the sliders act on the beam."""
        return bool(self.sliders) and self.sliders[0].coupling == "two-way"

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
            notes.append(f"forces grow over {sum(steps.duration for steps, _ in self.pieces[:-1]):.6g} s")
            reached = float(np.sum(self.pieces[-2][1]))
            if abs(reached - 1.0) >= 1e-9:
                notes.append(f"forces jump from {reached:.6g} times their amplitude to all of it")
        return tuple(notes)

    def released(self, stage: Stage) -> ComplexArray:
        """Free rows z at the start, (n,), from rest or an earlier run. Raises InputError for a run of other modes."""
        if (before := self.before) is None:
            return stage.free(np.zeros(len(stage.rows.rates), dtype=complex))
        if (n := len(before.q)) not in (sizes := stage.rows.sizes):
            raise InputError(f"start has {n} modes and this run {sizes[0]}: give both the same modes")
        return stage.free(stage.rows.of_state(before.q, before.rates))

    def motion(self, stages: Sequence[Stage], outputs: Array, **more: Any) -> Motion:
        """The motion with outputs, (n, p + 2 circuits), at the first samples of the stages."""
        times = np.concatenate([[stages[0].origin], *(stage.origin + stage.sample_times for stage in stages)])
        p, circuits = len(self.points), len(self.circuits)
        deflection, voltages, charges = np.split(outputs, [p, p + circuits], axis=1)
        return Motion(
            model=self.model,
            count=self.count,
            times=times[: len(outputs)],
            points=self.points,
            deflection=deflection,
            voltages=voltages,
            charges=charges,
            **more,
        )

    def end(self, stage: Stage, z: ComplexArray, time: float, **contact: Any) -> EndState:
        """The end state at a time, s, with the total state z of the last stage."""
        q, rates = stage.rows.state(z)
        return EndState(
            beam=self.beam,
            model=self.model,
            count=self.count,
            time=time,
            q=q,
            rates=rates,
            steady=self.start == "steady",
            **contact,
        )


def request_of(
    beam: Beam,
    excitation: Excitation,
    duration: float,
    *,
    slider: Sliders | None,
    model: str = "segment",
    count: int | None = None,
    modes: int | None = None,
    modal_damping: float | None = None,
    start: str | Motion | FreeVibration | None = None,
    step: Step | float | None = None,
    keep: Keep = KEEP,
) -> Request:
    """A validated request; arguments as in `simulate`. Raises InputError."""
    if not isinstance(excitation, Excitation):
        raise InputError(f"excitation = {shown(excitation)}: give an Excitation(forces, frequency_hz)")
    check_type("keep", keep, Keep)
    check_number("duration", duration, "seconds", at_least=SHORTEST)
    check_damping(beam, modal_damping)
    kind, prescribed, hertz = MODELS.named(model), sliders_of(slider), excitation.frequency_hz
    sliders = tuple(one.slider for one in prescribed)
    check_frequency("frequency_hz", hertz, beam)
    forces, circuits = loads_on(beam, excitation.forces, PointLoad), as_tuple("circuits", excitation.circuits, Mounted)
    check_circuits(beam, circuits, 2.0 * np.pi * hertz)
    if not forces and not sliders and not circuits:
        raise InputError("forces is empty: give at least one PointForce")
    begins, before = _start(start, excitation, sliders, edges="raw" in kind.lines, modes=modes)
    if before is not None:
        _check_continued(before, beam, model, count, sliders)
    if hertz * (duration + (before.time if before else 0.0)) > MOST_PERIODS:
        raise InputError(f"duration = {duration!r} s: rounding makes the phase unknown after 1e12 periods, shorten it")
    starts = before.starts if before and before.contact is not None and sliders else ()
    starts = starts or tuple(one.initial_position(beam) for one in sliders)
    if sliders:
        check_sliders(beam, sliders, starts)
    if step is not None and not isinstance(step, Step):
        check_number("step", step, "seconds", above=0)
    step = step if isinstance(step, Step) else Step(seconds=python_scalar(step))
    few = bool(sliders and sliders[0].contact) and not kind.sized
    replaced = modal_damping != 0.5 * beam.loss_factor or bool(beam.loss_factor and is_lossless(beam))
    return Request(
        beam=beam,
        forces=forces,
        frequency_hz=hertz,
        model=model,
        count=count,
        modes=FEET_MODES if modes is None and few else modes,
        start=begins,
        modal_damping=modal_damping if replaced else None,
        prescribed=prescribed,
        starts=starts,
        points=vector_on("keep.at", keep.at, beam.length),
        pieces=_cut(duration, excitation.growth, _longest_step(hertz, duration, step, sliders), keep.samples - 1),
        step=step.seconds,
        before=before,
        circuits=circuits,
        sequence=not isinstance(slider, Slider | PrescribedSlider),
    )


def _start(
    start: Any, excitation: Excitation, sliders: Sequence[Slider], *, edges: bool, modes: int | None
) -> tuple[str, EndState | None]:
    """("rest" or "steady", state that the run continues); `edges`: whether the model has straight links.

    Raises InputError for another start, and for what this one excludes.
    """
    before = getattr(start, "end", None)
    if isinstance(before, EndState):
        start = "steady" if before.steady else "rest"
    else:
        before, start = None, ("steady" if sliders and sliders[0].contact else "rest") if start is None else start
    if not isinstance(start, str) or start not in ("rest", "steady"):
        raise InputError(f"start = {shown(start)}: give 'rest', 'steady', a Motion or a FreeVibration")
    if sliders and sliders[0].line == "raw" and (not edges or start == "steady"):
        raise InputError("slider.line = 'raw': this model and start have no straight edges of links, leave it out")
    if modes is not None and start == "steady" and not (sliders and sliders[0].coupling == "two-way"):
        raise InputError(f"modes = {modes!r}: a steady field without two-way coupling uses no modes, leave it out")
    if (excitation.soft_start_periods or excitation.envelope) and (start == "steady" or before is not None):
        name = "soft_start_periods" if excitation.soft_start_periods else "envelope"
        value = shown(getattr(excitation, name))
        raise InputError(f"{name} = {value}: forces grow from start = 'rest' alone, leave it out or give this start")
    return start, before


def _longest_step(frequency_hz: float, duration: float, step: Step, sliders: Sequence[Slider]) -> float:
    """Largest time step of a slider, s; infinite without slider. Raises InputError."""
    if not sliders:
        if step != Step():
            raise InputError("step: a beam without slider has no time steps, leave it out or give slider")
        return inf
    least = STEPS_PER_PERIOD if sliders[0].contact is None else FEET_STEPS_PER_PERIOD
    per_period = least if step.per_period is None else step.per_period
    longest = 1.0 / (per_period * frequency_hz) if step.seconds is None else step.seconds
    if longest * frequency_hz > COARSEST:
        most = f"{COARSEST / frequency_hz:.3g} s"
        given = f"step = {longest!r} s" if step.seconds is not None else f"step.per_period = {per_period!r}"
        raise InputError(f"{given} does not resolve the drive: give a step of at most {most}")
    check_steps(duration, longest)
    return longest


def check_steps(duration: float, step: float) -> None:
    """Raise InputError for too many steps of this length, s."""
    if duration / step > MOST_STEPS:
        raise InputError(
            f"duration = {written(duration)} s: {duration / step:.2g} steps are too many, shorten it or lengthen step"
        )


def _cut(
    duration: float, grown: list[tuple[float, Array]], longest: float, samples: int
) -> tuple[tuple[Steps, Array], ...]:
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
    return tuple((cut(seconds, longest, share), c) for (seconds, c), share in zip(pieces, shares, strict=True))


def _check_continued(before: EndState, beam: Beam, model: str, count: int | None, sliders: Sequence[Slider]) -> None:
    """Raise InputError for a run that continues one of another beam, model or slider."""
    for name, here, there in (("model", model, before.model), ("count", count, before.count)):
        if here != there:
            raise InputError(f"{name} = {here!r}: start is a run with {name} = {there!r}, give the same")
    if before.beam != beam and replace(before.beam, loss_factor=0.0) != replace(beam, loss_factor=0.0):
        raise InputError("start is a run of another beam: give the same beam (loss_factor may differ)")
    if before.contact is None or not sliders:
        return
    if before.off:
        raise InputError(f"start: its slider {before.off}, continue a run whose slider did not")
    if len(sliders) != len(before.starts):
        raise InputError(f"start has {len(before.starts)} sliders and this run {len(sliders)}: give as many")
    moved = before.contact.sliders[["x", "v"]].tolist()
    for slider, first, (travelled, speed), earlier in zip(sliders, before.starts, moved, before.sliders, strict=True):
        own = (slider.position, (None, first, first + travelled)), (slider.speed, (0.0, earlier.speed, speed))
        for name, (value, known) in zip(("position", "speed"), own, strict=True):
            if value not in known:
                raise InputError(f"slider.{name} = {value!r}: the earlier run ends with {known[-1]!r}, leave it out")
