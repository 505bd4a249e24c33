"""A slider that may leave the surface, on a linear beam in time: laid out, stepped, told."""

from collections.abc import Callable, Sequence
from time import perf_counter
from typing import Any

import msgspec
import numpy as np

from verify.beam import Beam, PointForce
from verify.checks import check_number
from verify.errors import InputError
from verify.models.arrays import Array
from verify.models.places import Forces, Numbers, as_forces, as_typed
from verify.models.time_basis import TimeBasis
from verify.motion.carried import steady_field
from verify.motion.contact import Coupling, Margins
from verify.motion.forcing import check_no_resonance
from verify.motion.margins import margins_of
from verify.motion.moving_mass import receptance
from verify.motion.request import Driven, Modelled, Request, Started, Watched, requested
from verify.motion.step_size import stepped
from verify.motion.surface import Stage, basis_of, stages_from_rest, steady_stage
from verify.motor import records
from verify.motor.combine import CHAIN, check_together
from verify.motor.coupling import coupled, in_words, sizes
from verify.motor.laid import Onto, check_on_beam, put_down
from verify.motor.resting import contact_rate, levels_of, press_apart, sag_of, weighed
from verify.motor.result import MotorRun, MotorState
from verify.motor.stepping import RIDES_FROM_HERE, Riding, run_stages
from verify.motor.told import told
from verify.options import Links, Start
from verify.patience import check_work
from verify.slider import Slider

MODES = 80
"""Of the exact beam, unless asked for otherwise."""
STEPS_PER_PERIOD = 61
"""A prime: points that stand evenly in a wave do not all meet the turn of friction at the same phases of it."""
RESOLVED = 0.5
"""Radians of the contact's own swing in a step, unless a step is given: an error of 1 % of its period."""
UNSTABLE = 2.0
SHARP = 0.5 * np.pi
"""Radians of the fastest mode in a step of a beam that feels its slider."""


class Plan(msgspec.Struct, frozen=True, eq=False, kw_only=True):
    """A run laid out, before its first step."""

    request: Request
    onto: tuple[Onto, ...]
    stages: list[Stage]
    tables: tuple[Array, ...]
    """Polynomials of every stage, (pieces, degree + 1, rows)."""
    basis: TimeBasis | None
    """None where no mode is free."""
    z: Array
    """(2, n), the free modes at the start."""
    coupling: Coupling
    contact_rate: float
    """Natural frequency of the contact, rad/s."""
    sag: float
    """Static deflection under what presses, metres."""
    margins: Margins
    """What the beam's own assumptions leave out."""
    notes: tuple[str, ...]


@as_typed
def run_motor(
    beam: Beam,
    forces: Forces,
    frequency_hz: float,
    duration: float,
    *,
    slider: Slider,
    model: str = "segment",
    count: int | None = None,
    modes: int = MODES,
    start: Start = "steady",
    soft_start_periods: float = 0.0,
    modal_damping: float | None = None,
    at: Numbers = (),
    samples: int = 201,
    step: float | None = None,
    steps_per_period: int = STEPS_PER_PERIOD,
    held_speed: float | None = None,
    frozen: bool = False,
    links: Links = "rigid",
    continue_from: MotorRun | None = None,
    progress: Callable[[float], None] = lambda part: None,
    patient: bool = True,
) -> MotorRun:
    """A slider with `slider.contact` on a driven beam, steady or from rest, for `duration` seconds.

    `model` = 'chain' is the nonlinear chain of `count` links, rigid or stretching, from rest and undamped.

    It is put down level where its springs carry what presses it on, at rest across the beam. `held_speed` (m/s) keeps
    it at one speed whatever friction does, as a force-speed curve needs; `frozen` keeps it at its place whatever its
    speed, so that its motion is periodic. Steps are at most a `steps_per_period`-th of the drive's period, and shorter
    where the contact is stiff, unless `step` is given; forces act in mid-step, of second order. Coupled two-way, every
    force of every point acts on the modes. Otherwise as `simulate`. Raises InputError, also for what does not combine.
    """
    given = run_motors(
        beam,
        forces,
        frequency_hz,
        duration,
        sliders=(slider,),
        model=model,
        count=count,
        modes=modes,
        start=start,
        soft_start_periods=soft_start_periods,
        modal_damping=modal_damping,
        at=at,
        samples=samples,
        step=step,
        steps_per_period=steps_per_period,
        held_speed=held_speed,
        frozen=frozen,
        links=links,
        continue_from=() if continue_from is None else (continue_from,),
        progress=progress,
        patient=patient,
    )
    return given[0]


@as_typed
def run_motors(
    beam: Beam,
    forces: Forces,
    frequency_hz: float,
    duration: float,
    *,
    sliders: Sequence[Slider],
    model: str = "segment",
    count: int | None = None,
    modes: int = MODES,
    start: Start = "steady",
    soft_start_periods: float = 0.0,
    modal_damping: float | None = None,
    at: Numbers = (),
    samples: int = 201,
    step: float | None = None,
    steps_per_period: int = STEPS_PER_PERIOD,
    held_speed: float | Sequence[float | None] | None = None,
    frozen: bool | Sequence[bool] = False,
    links: Links = "rigid",
    continue_from: Sequence[MotorRun] = (),
    progress: Callable[[float], None] = lambda part: None,
    patient: bool = True,
) -> tuple[MotorRun, ...]:
    """Several sliders on one beam, one run for each: coupled two-way they feel each other through it.

    They rub by one law of one slope and are coupled alike; `held_speed` and `frozen` are of all, or one for each.
    Otherwise as `run_motor`. Raises InputError.
    """
    began = perf_counter()
    check_together(model, start, sliders)
    speeds, stay = _each("held_speed", held_speed, len(sliders)), _each("frozen", frozen, len(sliders))
    for speed in speeds:
        if speed is not None:
            check_number("held_speed", speed, "m/s")
    request = requested(
        Driven(beam, as_forces(forces), frequency_hz, duration),
        Modelled("segment" if model == CHAIN else model, count, modes, modal_damping),
        Started(start, soft_start_periods, (), None),
        Watched(at, samples, step, steps_per_period, False),
        sliders[0],
    )
    each = zip(sliders, speeds, stay, strict=True)
    onto = tuple(Onto(slider, slider.start_on(beam), speed, bool(stays)) for slider, speed, stays in each)
    if model == CHAIN:
        from verify.motor.on_chain import check_chain, run_on_chain

        check_chain(request, soft_start_periods)
        return run_on_chain(request, onto, links, began, progress)
    if links != "rigid":
        raise InputError(f"links = {links!r} is of model = 'chain': leave it out on {model}")
    before = tuple(run.state for run in continue_from)
    return carry_out(lay_out(request, onto, before), before, began, progress, patient)


def _each(field: str, given: Any, n: int) -> tuple[Any, ...]:
    """One for each slider. Raises InputError."""
    found = tuple(given) if isinstance(given, Sequence) else (given,) * n
    if len(found) != n:
        raise InputError(f"{field} has {len(found)} of them for {n} sliders: give one for each, or one for all")
    return found


def lay_out(request: Request, onto: tuple[Onto, ...], before: Sequence[MotorState]) -> Plan:
    """The stages of a run, its modes, and how the sliders are coupled. Raises InputError."""
    if before and len(before) != len(onto):
        raise InputError(f"continue_from has {len(before)} runs for {len(onto)} sliders: give one for each")
    for one in onto:
        check_on_beam(one.slider, request.beam, one.start)
    origin, basis = before[0].time if before else 0.0, _basis(request)
    stages = _stages(request, basis, origin)
    coupling = _coupling(request, onto, stages[-1], basis)
    if coupling.two_way and basis is None:
        basis = basis_of(request.beam, request.model, request.count, request.modes, "spline")
        stages = _stages(request, basis, origin)
    rate = max(contact_rate(one, basis if coupling.two_way else None) for one in onto)
    stages = stepped(stages, _step(request, rate, stages[0], coupling.two_way))
    return Plan(
        request=request,
        onto=onto,
        stages=stages,
        tables=tuple(stage.table(0, len(stage.edges) - 1) for stage in stages),
        basis=basis,
        z=stages[0].start(*_at_start(stages[0], basis if coupling.two_way else None, onto, before)),
        coupling=coupling,
        contact_rate=rate,
        sag=sag_of(request, onto),
        margins=margins_of(request, stages[-1]),
        notes=_notes(request, basis, coupling),
    )


def _at_start(
    stage: Stage, basis: TimeBasis | None, onto: Sequence[Onto], before: Sequence[MotorState]
) -> tuple[Array, Array]:
    """(q, dq/dt) of every mode: as the run before left them, else at rest, or bent by what presses the sliders on."""
    n = len(stage.modal.squares)
    if not before:
        return (weighed(basis, onto) if basis else np.zeros(n)), np.zeros(n)
    if len(before[0].q) != n:
        raise InputError(f"continue_from has {len(before[0].q)} modes and this run {n}: give both the same model")
    return before[0].q, before[0].rates


def _basis(request: Request) -> TimeBasis | None:
    if request.start == "steady":
        return None
    basis = basis_of(request.beam, request.model, request.count, request.modes, "spline")
    check_no_resonance(basis, request.frequency_hz, request.damping)
    return basis


def _stages(request: Request, basis: TimeBasis | None, origin: float) -> list[Stage]:
    if request.start == "rest":
        assert basis is not None
        return stages_from_rest(basis, request.forces, request.omega, request.damping, request.pieces, origin)
    field = steady_field(request, request.forces)
    return [steady_stage(field, request.pieces[-1].steps, origin, basis, request.damping)]


def _coupling(request: Request, onto: Sequence[Onto], stage: Stage, basis: TimeBasis | None) -> Coupling:
    """One-way or two-way by size, unless the sliders say which: what their load moves, over what the drive moves."""
    sizes = [_sizes(request, one, stage, basis) for one in onto]
    across = max(size for size, _ in sizes)
    along = None if any(size is None for _, size in sizes) else max(size or 0.0 for _, size in sizes)
    return coupled(onto[0].slider, across, along)


def _sizes(request: Request, one: Onto, stage: Stage, basis: TimeBasis | None) -> tuple[float, float | None]:
    """What all that presses a slider on moves the surface by, over its own motion: (across, by friction along)."""
    beam, omega, slider, x = request.beam, request.omega, one.slider, np.array([one.start])
    moved, turned = (float(np.hypot(*stage.drive_shapes(x, d)[:2, 0])) for d in (0, 1))
    felt = (
        receptance(basis, one.start, omega, request.damping)
        if basis
        else complex(steady_field(request, (PointForce(position=one.start),)).deflection(x)[0])
    )
    return sizes(slider, beam, omega, moved, turned, felt)


def _step(request: Request, rate: float, stage: Stage, two_way: bool) -> float:
    """The step, seconds: as given where it is stable, else of the drive's period, the contact's and the modes' own."""
    longest = stage.dt
    fastest = float(stage.modal.omegas.max()) if two_way and len(stage.modal.omegas) else 0.0
    if request.step is not None:
        for field, turns, most in (("contact", rate, UNSTABLE), ("fastest mode", fastest, np.pi)):
            if turns * request.step >= most:
                raise InputError(
                    f"step = {request.step!r} s is {turns * request.step:.3g} radians of the {field}'s own motion, and "
                    f"that grows without bound from {most:.3g} on: give at most {RESOLVED / turns:.3g} s"
                )
        return longest
    return min(longest, RESOLVED / rate if rate else longest, SHARP / fastest if fastest else longest)


def _notes(request: Request, basis: TimeBasis | None, coupling: Coupling) -> tuple[str, ...]:
    modes = f"modes: {basis.method}" if basis else f"steady field of the {request.model} model, no modes"
    return modes, f"coupling: {'two' if coupling.two_way else 'one'}-way; {in_words(coupling)}"


def carry_out(
    plan: Plan,
    before: Sequence[MotorState],
    began: float,
    progress: Callable[[float], None],
    patient: bool,
) -> tuple[MotorRun, ...]:
    """Step a run that is laid out. Raises InputError where that takes too long."""
    n_steps = sum(stage.n_steps for stage in plan.stages)
    riding = Riding.fresh(plan.onto, plan.request, plan.coupling.two_way)
    if not patient:
        seconds = sum(stage.duration for stage in plan.stages)
        check_work("duration", seconds, riding.seconds(n_steps), "shorten it or lengthen the step")
    begin(plan, riding, before)
    ready = perf_counter()
    stopped, q, rates = run_stages(plan.stages, plan.tables, plan.z, riding, lambda n: progress(n / n_steps))
    clock = (began, ready, perf_counter())
    return tuple(told(b, plan, riding, stopped, (q, rates), clock) for b in range(len(plan.onto)))


def begin(plan: Plan, riding: Riding, before: Sequence[MotorState]) -> None:
    """Put the sliders down, or go on from where runs have left them."""
    feet, stage = riding.feet, plan.stages[0]
    for b, state in enumerate(before):
        own, own_feet = feet.owner == b, feet.keeper == b
        if state.feet.shape != feet.state[own_feet].shape or state.touch.shape != feet.touch[own].shape:
            raise InputError("continue_from has other feet than slider.foot: give both runs the same slider")
        feet.body[b, records.X], feet.state[own_feet], feet.touch[own] = state.travelled, state.feet, state.touch
        if plan.onto[b].held_speed is None:
            feet.body[b, records.V] = state.speed
    if before:
        riding.before[:] = feet.touch[:, [records.DEPTH, records.STUCK]]
        return
    if riding.hard is not None:
        riding.before[0, 0] = RIDES_FROM_HERE
        return
    if plan.coupling.two_way and plan.basis is not None:
        press_apart(plan.onto, plan.basis, feet)
    levels = levels_of(stage, plan.z, plan.request.beam, plan.onto, feet)
    put_down(feet, levels)
    riding.set_touch(levels)
