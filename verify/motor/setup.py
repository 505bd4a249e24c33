"""A run of sliders on feet before its first step, and the run itself: stages, coupling, step, initial state."""

from collections.abc import Callable, Sequence
from time import perf_counter

import msgspec
import numpy as np

from verify.arrays import Array
from verify.errors import InputError
from verify.linear.surface import check_one_range, contact_range, section_at
from verify.linear.time_basis import TimeBasis
from verify.motion.contact import Coupling, Margins, friction_speed
from verify.motion.forcing import check_no_resonance
from verify.motion.request import Request, check_same_modes
from verify.motion.simulate import steady_of
from verify.motion.slider_run import yielding_at
from verify.motion.step_control import stepped
from verify.motion.surface import Stage, basis_of, on_ground, stages_from_rest
from verify.motion.validity import margins_of
from verify.motor import records
from verify.motor.feet import (
    Placed,
    check_on_beam,
    contact_rate,
    levels_of,
    press_apart,
    put_down,
    sag_of,
    weighed,
)
from verify.motor.outcome import Ended, outcome
from verify.motor.result import MotorRun, MotorState
from verify.motor.stepping import RIDES_FROM_HERE, Riding, run_stages

RESOLVED = 0.5
"""Radians of the contact's natural frequency in a step: an error of 1 % of its period."""
UNSTABLE = 2.0
"""Radians at which the step of the contact becomes unstable."""
SHARP = 0.5 * np.pi
"""Radians of the fastest mode in a step of a two-way coupled beam."""


class Setup(msgspec.Struct, frozen=True, eq=False, kw_only=True):
    """A run before its first step."""

    request: Request
    placed: tuple[Placed, ...]
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
    sag: float | None
    """Static deflection under the preload, metres; None of a beam with rigid-body motions."""
    margins: Margins
    """Validity of the beam model."""
    notes: tuple[str, ...]


def lay_out(request: Request, placed: tuple[Placed, ...], before: Sequence[MotorState]) -> Setup:
    """Stages, modes, coupling and step of a run. Raises InputError."""
    for one in placed:
        check_on_beam(one.slider, request.beam, one.start)
    check_one_range(request.beam, [one.start for one in placed])
    ground = contact_range(request.beam, placed[0].start)
    origin, basis = before[0].time if before else 0.0, None
    if request.start == "rest":
        basis = basis_of(request.beam, request.model, request.count, request.modes, "spline")
        check_no_resonance(basis, request.frequency_hz, request.damping_in(basis))
    stages = _stages(request, basis, origin)
    coupling = coupling_of(request, placed, stages[-1], basis)
    if coupling.two_way and basis is None:
        basis = basis_of(request.beam, request.model, request.count, request.modes, "spline")
        stages = _stages(request, basis, origin)
    rate = max(contact_rate(one, basis if coupling.two_way else None) for one in placed)
    stages = stepped(stages, _step(request, rate, stages[0], coupling.two_way))
    stages = [on_ground(stage, ground) for stage in stages]
    n = len(stages[0].modal.squares)
    q, rates = weighed(basis, placed) if basis and coupling.two_way else np.zeros(n), np.zeros(n)
    if before:
        if n or len(before[0].q):
            check_same_modes(before[0], n, request.start)
        q, rates = before[0].q, before[0].rates
    modes = f"modes: {basis.method}" if basis else f"steady field of the {request.model} model, no modes"
    return Setup(
        request=request,
        placed=placed,
        stages=stages,
        tables=tuple(stage.table(0, len(stage.edges) - 1) for stage in stages),
        basis=basis,
        z=stages[0].start(q, rates),
        coupling=coupling,
        contact_rate=rate,
        sag=sag_of(request, placed),
        margins=margins_of(request, stages[-1]),
        notes=(modes, coupling.notes[0]),
    )


def _stages(request: Request, basis: TimeBasis | None, origin: float) -> list[Stage]:
    if request.start == "rest":
        assert basis is not None
        damping = request.damping_in(basis)
        return stages_from_rest(basis, request.forces, request.omega, damping, request.pieces, origin)
    return [steady_of(request, basis, origin)]


def _step(request: Request, rate: float, stage: Stage, two_way: bool) -> float:
    """The step, seconds: as given where it is stable, else of the drive's period, the contact and the fastest mode."""
    longest = stage.dt
    fastest = float(stage.modal.omegas.max()) if two_way and len(stage.modal.omegas) else 0.0
    if request.step is None:
        return min(longest, RESOLVED / rate if rate else longest, SHARP / fastest if fastest else longest)
    for field, omega, most in (("contact", rate, UNSTABLE), ("fastest mode", fastest, np.pi)):
        if omega * request.step >= most:
            raise InputError(
                f"step = {request.step!r} s is {omega * request.step:.3g} radians of the {field}, unstable from "
                f"{most:.3g} on: give at most {RESOLVED / omega:.3g} s"
            )
    return longest


def coupling_of(request: Request, placed: Sequence[Placed], stage: Stage, basis: TimeBasis | None) -> Coupling:
    """Coupling by what the load of all sliders moves the surface by, over its motion by the drive.

    Across by the normal force, along by full friction (None where the drive does not turn the surface); each under the
    slider where it is largest.
    """
    beam, omega = section_at(request.beam, placed[0].start), request.omega
    places = np.array([one.start for one in placed])
    across, friction = np.zeros(len(placed)), np.zeros(len(placed))
    for one in placed:
        lifted, turned = yielding_at(request, one.start, places, basis)
        across += one.slider.load * np.abs(lifted)
        friction += [friction_speed(one.slider, beam, omega, complex(turn)) for turn in turned]
    moved, turning = (np.hypot(*stage.drive_shapes(places, d)[:2]) for d in (0, 1))
    speeds, choice = beam.surface_distance * omega * turning, placed[0].slider.coupling
    with np.errstate(divide="ignore", invalid="ignore"):
        normal_size = float(np.where(moved > 0.0, across / moved, np.inf).max())
        friction_size = float((friction / speeds).max()) if (speeds > 0.0).all() else None
    return Coupling(
        two_way=choice == "two-way",
        friction_size=friction_size,
        normal_size=normal_size,
        normal="held",
        forced=True,
    )


def carry_out(
    setup: Setup, before: Sequence[MotorState], began: float, progress: Callable[[float], None]
) -> tuple[MotorRun, ...]:
    """Run all stages. Raises InputError where a slider cannot be put down."""
    n_steps = sum(stage.n_steps for stage in setup.stages)
    riding = Riding.fresh(setup.placed, setup.request, setup.coupling.two_way)
    begin(setup, riding, before)
    ready = perf_counter()
    stopped, q, rates = run_stages(setup.stages, setup.tables, setup.z, riding, lambda n: progress(n / n_steps))
    ended = Ended(stopped, q, rates, ready - began, perf_counter() - ready)
    return tuple(outcome(b, setup, riding, ended) for b in range(len(setup.placed)))


def begin(setup: Setup, riding: Riding, before: Sequence[MotorState]) -> None:
    """Initial state of the sliders: at rest on the surface, or that of the runs before. Raises InputError."""
    feet = riding.feet
    for b, state in enumerate(before):
        own, own_feet = feet.owner == b, feet.keeper == b
        if state.feet.shape != feet.state[own_feet].shape or state.touch.shape != feet.touch[own].shape:
            raise InputError("continue_from has other feet than slider.foot: give both runs the same slider")
        feet.body[b, records.X], feet.state[own_feet], feet.touch[own] = state.travelled, state.feet, state.touch
        if setup.placed[b].held_speed is None:
            feet.body[b, records.V] = state.speed
    if setup.coupling.two_way and setup.basis is not None:
        press_apart(setup.placed, setup.basis, feet)
    if before:
        riding.before[:] = feet.touch[:, [records.DEPTH, records.STUCK]]
    elif riding.hard is not None:
        riding.before[0, 0] = RIDES_FROM_HERE
    else:
        levels = levels_of(setup.stages[0], setup.z, setup.request.beam, setup.placed, feet)
        put_down(feet, levels)
        riding.set_touch(levels)
