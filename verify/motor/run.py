"""A slider that may leave the surface, on a linear beam in time: laid out, stepped, told."""

from collections.abc import Callable
from time import perf_counter

import msgspec
import numpy as np
from msgspec.structs import replace

from verify.beam import Beam
from verify.checks import check_number
from verify.errors import InputError
from verify.models.arrays import Array
from verify.models.places import Forces, Numbers, as_forces, as_typed
from verify.models.time_basis import TimeBasis
from verify.motion.carried import steady_field
from verify.motion.contact import FELT, Coupling
from verify.motion.forcing import check_no_resonance
from verify.motion.moving_mass import receptance
from verify.motion.request import Driven, Modelled, Request, Started, Watched, requested
from verify.motion.step_size import stepped
from verify.motion.surface import Stage, basis_of, stages_from_rest, steady_stage
from verify.motor.combine import CHAIN, check_combines
from verify.motor.laid import check_on_beam, feet_of, put_down
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
    slider: Slider
    start: float
    """Metres from the left end."""
    stages: list[Stage]
    basis: TimeBasis | None
    """None where no mode is free."""
    z: Array
    """(2, n), the free modes at the start."""
    coupling: Coupling
    contact_rate: float
    """Natural frequency of the contact, rad/s."""
    sag: float
    """Static deflection under what presses, metres."""
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
    began = perf_counter()
    check_combines(model, start, slider)
    held = Held(held_speed, frozen)
    if held_speed is not None:
        check_number("held_speed", held_speed, "m/s")
    request = requested(
        Driven(beam, as_forces(forces), frequency_hz, duration),
        Modelled("segment" if model == CHAIN else model, count, modes, modal_damping),
        Started(start, soft_start_periods, (), None),
        Watched(at, samples, step, steps_per_period, False),
        slider,
    )
    if model == CHAIN:
        from verify.motor.on_chain import check_chain, run_on_chain

        check_chain(request, soft_start_periods)
        return run_on_chain(request, slider, links, held, began, progress)
    if links != "rigid":
        raise InputError(f"links = {links!r} is of model = 'chain': leave it out on {model}")
    before = continue_from.state if continue_from is not None else None
    plan = lay_out(request, slider, before)
    return carry_out(plan, before, held, began, progress, patient)


class Held(msgspec.Struct, frozen=True):
    """What is kept of a stage's motion along the beam."""

    speed: float | None = None
    """m/s; None: friction moves it."""
    frozen: bool = False
    """Whether it stays at its place."""


def lay_out(request: Request, slider: Slider, before: MotorState | None) -> Plan:
    """The stages of a run, its modes, and how the slider is coupled. Raises InputError."""
    request, x = replace(request, before=None), slider.start_on(request.beam)
    check_on_beam(slider, request.beam, x)
    origin = before.time if before else 0.0
    basis, two_way = _basis(request), slider.coupling == "two-way"
    stages = _stages(request, basis, origin)
    coupling = _coupling(request, slider, stages[-1], basis, x)
    two_way = coupling.two_way
    if two_way and basis is None:
        basis = basis_of(request.beam, request.model, request.count, request.modes, "spline")
        stages = _stages(request, basis, origin)
    sagging = _weighed(basis, slider, x) if basis else np.zeros(0)
    n = len(stages[0].modal.squares)
    q, rates = (sagging if two_way else np.zeros(n)), np.zeros(n)
    if before is not None:
        if len(before.q) != n:
            raise InputError(f"continue_from has {len(before.q)} modes and this run {n}: give both the same model")
        q, rates = before.q, before.rates
    rate = contact_rate(slider, basis if two_way else None, x)
    stages = stepped(stages, _step(request, rate, stages[0], two_way))
    return Plan(
        request=request,
        slider=slider,
        start=x,
        stages=stages,
        basis=basis,
        z=stages[0].start(q, rates),
        coupling=coupling,
        contact_rate=rate,
        sag=_sag(request, slider, x),
        notes=_notes(request, basis, coupling),
    )


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


def _coupling(request: Request, slider: Slider, stage: Stage, basis: TimeBasis | None, x: float) -> Coupling:
    """One-way or two-way by size, unless the slider says which: what its load moves, over what the drive moves."""
    from verify.beam import PointForce

    beam, omega = request.beam, request.omega
    moved, turned = (float(np.hypot(*stage.drive_shapes(np.array([x]), d)[:2, 0])) for d in (0, 1))
    felt = (
        receptance(basis, x, omega, request.damping)
        if basis
        else complex(steady_field(request, (PointForce(position=x),)).deflection([x])[0])
    )
    lever, k = beam.surface_distance, float(np.sqrt(omega / beam.wave_constant))
    rub = slider.mu * slider.normal_force * lever**2 * np.sqrt(2.0) * omega / (4.0 * beam.bending_stiffness * k)
    across = slider.normal_force * abs(felt) / moved if moved else np.inf
    along = rub / (lever * omega * turned) if turned else None
    forced = slider.coupling != "auto"
    return Coupling(
        two_way=slider.coupling == "two-way" if forced else along is None or max(along, across) > FELT,
        friction_size=along,
        normal_size=float(across),
        normal="held",
        forced=forced,
    )


def _weighed(basis: TimeBasis, slider: Slider, x: float) -> Array:
    """Modes at rest under what presses the feet on, shared by their points, (n,)."""
    feet, still = feet_of(slider, 0.0), np.zeros(len(basis.omegas))
    for f, given in enumerate(feet.given):
        own = feet.points[(feet.foot == f) & (feet.points[:, 6] > 0.0)]
        still += given[2] / len(own) * basis.shapes(x + own[:, 0], 0).sum(axis=1)
    return np.asarray(still / basis.omegas**2)


def _sag(request: Request, slider: Slider, x: float) -> float:
    """Static deflection of the beam under the net load at the slider, metres, by the first modes of its own model."""
    feet = feet_of(slider, 0.0)
    load = abs(float(feet.given[:, 2].sum()))
    basis = basis_of(request.beam, request.model, request.count, min(request.modes, 20), "spline")
    return load * float((basis.shapes(np.array([x]), 0)[:, 0] ** 2 / basis.omegas**2).sum())


def contact_rate(slider: Slider, basis: TimeBasis | None, x: float) -> float:
    """The fastest natural frequency that the contact may have, rad/s, every point pressed; with the beam's own ease.

    Also at least what a dashpot turns into one: half its rate is as much as a step bears of it.
    """
    feet = feet_of(slider, 0.0)
    ease = np.array([feet.given[f, 0] for f in feet.foot]) + feet.points[:, 1] ** 2 * feet.given[feet.foot, 1]
    along = np.full(len(ease), 1.0 / slider.mass)
    if basis is not None:
        ease = ease + (basis.shapes(x + feet.points[:, 0], 0) ** 2).sum(axis=0)
        lever = basis.beam.surface_distance
        along = along + lever**2 * (basis.shapes(x + feet.points[:, 0], 1) ** 2).sum(axis=0)
    sums = [np.sqrt((feet.points[:, 2] * ease)[feet.foot == f].sum()) for f in range(len(feet.state))]
    damped = [(feet.points[:, 3] * ease)[feet.foot == f].sum() for f in range(len(feet.state))]
    return float(max([*sums, *damped, np.sqrt((feet.points[:, 4] * along).sum())]))


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
    felt = "" if coupling.friction_size is None else f"its friction by {coupling.friction_size:.1e} of its speed and "
    way = "two" if coupling.two_way else "one"
    return (
        modes,
        f"coupling: {way}-way; all that presses the slider on moves the surface by {coupling.normal_size:.1e} of its "
        f"motion, {felt or 'the drive does not move the surface along'}".rstrip(" and"),
    )


def carry_out(
    plan: Plan,
    before: MotorState | None,
    held: Held,
    began: float,
    progress: Callable[[float], None],
    patient: bool,
) -> MotorRun:
    """Step a run that is laid out. Raises InputError where that takes too long."""
    n_steps = sum(stage.n_steps for stage in plan.stages)
    riding = Riding.fresh(plan.slider, plan.request, plan.start, plan.coupling.two_way, held.speed, held.frozen)
    if not patient:
        check_work("duration", plan.request.pieces, riding.seconds(n_steps), "shorten it or lengthen the step")
    begin(plan, riding, before)
    ready = perf_counter()
    stopped, q, rates = run_stages(plan.stages, plan.z, riding, lambda n: progress(n / n_steps))
    clock = (began, ready, perf_counter())
    return told(plan, riding, stopped, (q, rates), clock)


def begin(plan: Plan, riding: Riding, before: MotorState | None) -> None:
    """Put the slider down, or go on from where a run has left it."""
    feet, stage = riding.feet, plan.stages[0]
    if before is not None:
        if before.feet.shape != feet.state.shape or before.touch.shape != feet.touch.shape:
            raise InputError("continue_from has other feet than slider.foot: give both runs the same slider")
        feet.body[:], feet.state[:], feet.touch[:] = (before.travelled, feet.body[1]), before.feet, before.touch
        if riding.held_speed is None:
            feet.body[1] = before.speed
        return
    if riding.hard is not None:
        riding.before[0, 0] = RIDES_FROM_HERE
        return
    levels = stage.deflection(plan.z, np.zeros(1), plan.start + feet.points[:, 0])[0]
    put_down(feet, levels)
    riding.set_touch(levels)
