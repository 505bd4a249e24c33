"""A slider's run on a beam in time: coupling, initial state, steps, result."""

from collections.abc import Callable
from time import perf_counter
from typing import TYPE_CHECKING

import msgspec
import numpy as np
from msgspec.structs import replace

from verify.arrays import Array, ComplexArray
from verify.errors import InputError, written
from verify.linear.registry import MODELS
from verify.linear.surface import section_at
from verify.linear.time_basis import TimeBasis
from verify.motion import records
from verify.motion.contact import (
    Coupling,
    carried_along,
    couple,
    coupling_of,
    law_of,
    modal_receptance,
    modal_turning,
    weighed_down,
)
from verify.motion.records import Rider
from verify.motion.request import MOST_STEPS, Request, check_same_beam, check_same_modes
from verify.motion.result import EndState, Ledger, Motion, Statistics
from verify.motion.step_control import (
    Ran,
    check_books,
    excess_of,
    gripped_step,
    longest_step,
    missed_by,
    stepped,
    steps_in,
    until_it_stands,
)
from verify.motion.stepping import Sliding, fresh_motion, of_all_steps, on_beam, run_stages
from verify.motion.surface import Stage
from verify.motion.validity import margins_of
from verify.problem.beam import Beam, PointForce
from verify.problem.slider import Slider

if TYPE_CHECKING:
    from verify.linear.field import HarmonicField


def coupling_on(request: Request, slider: Slider, stage: Stage, basis: TimeBasis | None) -> Coupling:
    """Coupling of the slider where it starts. Raises InputError."""
    x, omega = put_on(request, slider)[0], request.omega
    beam, slope = section_at(request.beam, x), abs(stage.drive_shapes(np.array([x]), 1))[:2]
    speed = beam.surface_distance * omega * float(np.hypot(*slope[:, 0]))
    lifted, turned = yielding_at(request, x, np.array([x]), basis)
    return coupling_of(slider, beam, request.frequency_hz, speed, complex(lifted[0]), complex(turned[0]))


def yielding_at(request: Request, x: float, at: Array, basis: TimeBasis | None) -> tuple[ComplexArray, ComplexArray]:
    """(deflections under a unit force at x, slopes under a unit couple there), both at places `at`, (n,), metres.

    Of the modes where there are any, else of the model's steady fields. Raises InputError.
    """
    if basis:
        damping = request.damping_in(basis)
        lifted = basis.shapes(at, 0).T @ modal_receptance(basis, x, request.omega, damping)
        return np.asarray(lifted), modal_turning(basis, x, at, request.omega, damping)
    unit = steady_field(request, (PointForce(position=x),))
    turned = steady_field(request, couple(request.beam, x, request.frequency_hz))
    return np.asarray(unit.deflection(at)), np.asarray(turned.slope(at))


def steady_field(request: Request, forces: tuple[PointForce, ...]) -> "HarmonicField":
    """The steady field of the request's model and damping under these forces. Raises InputError."""
    damping = request.damping if request.damping_replaced else None
    return damped_field(request.model, request.count, request.beam, forces, request.frequency_hz, damping)


def damped_field(
    name: str,
    count: int | None,
    beam: Beam,
    forces: tuple[PointForce, ...],
    frequency_hz: float,
    damping: float | None,
) -> "HarmonicField":
    """The steady field of a model with this damping ratio, that of the beam itself unless given. Raises InputError."""
    model, modal_damping = MODELS.named(name), 0.0
    if damping is not None and (damping != 0.5 * beam.loss_factor or beam.lossless):
        by_mode = model.sized  # the exact beam has no modes to damp
        beam = replace(beam, loss_factor=0.0 if by_mode else 2.0 * damping)
        modal_damping = damping if by_mode else 0.0
    return model.build(beam, count).harmonic(forces, frequency_hz, modal_damping=modal_damping)


def begin(request: Request, stage: Stage, basis: TimeBasis | None, coupling: Coupling | None) -> Array:
    """The free modes at the start, (2, n): those of the run before, else at rest or steady, under a coupled slider.

    Raises InputError.
    """
    n = len(stage.modal.squares)
    if request.before is not None:
        check_same_beam(request.before, request.beam, request.model, request.count)
        check_same_modes(request.before, n, request.start)
        return stage.start(request.before.q, request.before.rates)
    q, rates = np.zeros(n), np.zeros(n)  # of a beam at rest; of a steady one what moves beside its field
    if basis and request.slider and coupling and coupling.pushes_back:
        x = put_on(request, request.slider)[0]
        q = q + weighed_down(basis, x, request.slider.normal_force)
        if stage.forced is None:
            added = carried_along(basis, stage, x, request.slider, request.damping_in(basis))
            q, rates = q + added[0], added[1]
    return stage.start(q, rates)


def put_on(request: Request, slider: Slider) -> tuple[float, float, bool]:
    """(position, speed, whether it sticks) at the start. Raises InputError where the run before left the beam."""
    before = request.before
    if before is None or before.position is None:
        return slider.start_on(request.beam), slider.speed, False
    if not 0.0 <= before.position <= request.beam.length:
        raise InputError(
            f"continue_from ended with the slider at {before.position!r} m, off the beam: continue one that stays on"
        )
    if before.off:
        raise InputError(f"continue_from ended where its slider {before.off}: continue one that stays on its section")
    return before.position, before.speed, before.stuck and slider.law == "coulomb"


class Laid(msgspec.Struct, frozen=True, eq=False, kw_only=True):
    """A slider's run before its first step."""

    request: Request
    slider: Slider
    stages: list[Stage]
    basis: TimeBasis | None
    """None where no mode is free."""
    coupling: Coupling
    began: float
    """Wall clock at the request, seconds."""
    notes: tuple[str, ...]


def slide(laid: Laid, progress: Callable[[float], None]) -> Motion:
    """Step the slider through all stages.

    Unless a step is given, that of a two-way coupled slider is refined until its displacement converges
    (`step_control`). Raises InputError for too many steps and where the contact makes energy.
    """
    request = laid.request
    stages, step_notes = _in_steps(laid, begin(request, laid.stages[0], laid.basis, None))
    laid = replace(laid, stages=stages, notes=(*laid.notes, *laid.coupling.notes, *step_notes))
    ready = perf_counter()

    def run(stages: list[Stage], progress: Callable[[float], None]) -> Ran:
        return _ran(laid, stages, progress)

    if request.step is None and laid.coupling.two_way:
        ran = until_it_stands(run, stages, progress)
    else:
        ran = run(stages, progress)
    check_books(ran.excess, request, ran.stages)
    taken = ran.motion.statistics
    return replace(ran.motion, statistics=replace(taken, set_up_s=taken.set_up_s + ready - laid.began))


def _in_steps(laid: Laid, z: Array) -> tuple[list[Stage], tuple[str, ...]]:
    """The stages in steps that resolve what the start excites; notes on a given step that does not."""
    request, stages, coupling, slider = laid.request, laid.stages, laid.coupling, laid.slider
    duration, dt = sum(stage.duration for stage in stages), max(stage.dt for stage in stages)
    coarsest = 0.5 * dt if coupling.pushes_back and request.step is None else dt  # waves of the contact
    enough = longest_step(stages, z, request.beam.length, coarsest)
    rate = 0.0  # K mu N / m, 1/s: how fast friction brings the slider to the surface speed
    if coupling.two_way:
        rate = np.inf if slider.steepness is None else slider.steepness * slider.mu * slider.normal_force / slider.mass
    if request.step is None:
        enough = gripped_step(stages, rate, enough)
        if duration / enough > MOST_STEPS:
            raise InputError(
                f"duration = {written(duration)} s: what the start excites takes steps of {enough:.2g} s, more than "
                f"{MOST_STEPS:g} of them: shorten the duration, lengthen soft_start_periods, or give a step"
            )
        return stepped(stages, enough), ()
    notes, sticking = [], gripped_step(stages, rate, dt)
    if sticking < dt:
        notes.append(f"step: a sticking contact can make energy in steps above {sticking:.2g} s, half a turn of a mode")
    if enough < dt:
        share = missed_by(stages, z, request.beam.length, dt)
        notes.append(f"step: {100 * share:.2g} % of the surface speed are not resolved, give at most {enough:.2g} s")
    return stages, tuple(notes)


def _ran(laid: Laid, stages: list[Stage], progress: Callable[[float], None]) -> Ran:
    """A run through these stages."""
    request, basis, slider, coupling = laid.request, laid.basis, laid.slider, laid.coupling
    began = perf_counter()
    z = begin(request, stages[0], basis, coupling)
    start, speed, stuck = put_on(request, slider)
    law = law_of(slider, section_at(request.beam, start))
    rider = Rider(fresh_motion(speed, stuck), law, coupling.two_way or None)
    samples = sum(stage.n_steps // stage.every for stage in stages)
    booked = request.accounts and request.start == "rest"
    sliding = Sliding.fresh(start, samples, request.points, rider, booked)
    if request.before is not None and request.before.height is not None:
        sliding.on_its_way = request.before.height, request.before.climb
    energy = _beam_energy(basis, *stages[0].state(z, 0.0)) if basis else (0.0, 0.0)
    ready, n_steps = perf_counter(), steps_in(stages)
    stopped, *state = run_stages(stages, z, sliding, request.forces, lambda n: progress(n / n_steps))
    statistics = Statistics(
        steps=sliding.steps,
        evaluations=2 * sliding.steps + 1,
        step_s=stages[-1].dt,
        set_up_s=ready - began + sliding.set_up_s,
        wall_s=perf_counter() - ready - sliding.set_up_s,
        loop_s=sliding.loop_s,
        stopped=stopped,
    )
    found = _motion(replace(laid, stages=stages), sliding, statistics, energy, *state)
    if not (coupling.two_way and found.ledger and basis) or statistics.interrupted:
        return Ran(found, stages, None)
    height, climb = sliding.set_down
    had = 0.5 * law.mass * (float(sliding.first[0, records.KEPT_V]) ** 2 + climb**2)
    had += law.load * max(height - sliding.held[0], 0.0) + (sum(energy) if request.before else 0.0)
    return Ran(found, stages, excess_of(found.ledger, had, float(abs(found.travelled).max()), request, basis))


def _motion(
    laid: Laid, sliding: Sliding, statistics: Statistics, energy: tuple[float, float], q: Array, rates: Array
) -> Motion:
    """The result of a run that ended with the modes at (q, rates); `energy` is the beam's at its start."""
    request, slider, n, motion = laid.request, laid.slider, sliding.n_kept, sliding.motion
    kept = np.concatenate([sliding.first, sliding.kept.kept[:n]]).T
    friction, end = slider.mass * kept[records.KEPT_FRICTION], reached(laid.stages, sliding.steps)
    mean_friction, hardest, mean_surface = of_all_steps(motion, slider.mass, end - request.origin)
    if request.start == "rest" and request.before is None and slider.speed == 0.0:
        friction[0] = 0.0  # of a slider at rest on a beam at rest, whatever the sign of rounding
    lost = (f"events: the first {len(sliding.events)} of {len(sliding.events) + sliding.n_lost}",)
    height, climb = sliding.held if laid.coupling.pushes_back else (None, 0.0)
    x, last = sliding.start + float(motion[records.X]), laid.stages[-1]
    return Motion(
        model=request.model,
        count=request.count,
        times=times_of(request, laid.stages)[: n + 1],
        points=request.points,
        deflection=np.concatenate([sliding.first_deflection, sliding.kept.deflections[:n]]),
        slider=slider,
        start=sliding.start,
        travelled=kept[records.KEPT_X],
        speed=kept[records.KEPT_V],
        friction=friction,
        surface_speed=kept[records.KEPT_SURFACE],
        mean_friction=mean_friction,
        largest_friction=hardest,
        mean_surface_speed=mean_surface,
        normal_force=kept[records.KEPT_NORMAL],
        events=sliding.events,
        coupling=laid.coupling,
        margins=margins_of(request, last, float(motion[records.FALL])),
        ledger=_ledger(laid.basis, sliding, energy, q, rates) if sliding.accounts and laid.basis else None,
        notes=(*laid.notes, *lost * bool(sliding.n_lost)),
        statistics=statistics,
        end=EndState(
            beam=request.beam,
            model=request.model,
            count=request.count,
            time=end,
            q=q,
            rates=rates,
            steady=request.start == "steady",
            position=x,
            speed=float(motion[records.V]),
            stuck=bool(motion[records.STUCK] > 0.0),
            height=height,
            climb=climb,
            off="" if on_beam(last, sliding.start, float(motion[records.X])) else last.beyond(x, x),
        ),
    )


def times_of(request: Request, stages: list[Stage]) -> Array:
    """Times of the start and the samples of all stages, (n,), seconds."""
    return np.concatenate([[request.origin], *(stage.origin + stage.sample_times for stage in stages)])


def reached(stages: list[Stage], steps: int) -> float:
    """The time after so many steps, seconds."""
    for stage in stages:
        if steps <= stage.n_steps:
            break
        steps -= stage.n_steps
    return stage.origin + steps * stage.dt


def _beam_energy(basis: TimeBasis, q: Array, rates: Array) -> tuple[float, float]:
    """(kinetic, elastic), joules."""
    return 0.5 * float(rates @ rates), 0.5 * float((basis.omegas**2 * q) @ q)


def _ledger(basis: TimeBasis, sliding: Sliding, before: tuple[float, float], q: Array, rates: Array) -> Ledger:
    on_beam_, on_slider, driven, damped, rubbed, lifted, turned = sliding.ledger.tolist()
    kinetic, elastic = _beam_energy(basis, q, rates)
    charged = on_beam_ + lifted if sliding.rider.two_way else 0.0
    return Ledger(
        kinetic=kinetic,
        elastic=elastic,
        slider=on_slider,
        work_in=driven,
        damped=damped,
        rubbed=rubbed,
        contact_on_beam=on_beam_,
        normal_on_beam=lifted,
        residual=driven + charged - damped - (kinetic + elastic - sum(before)),
        turned=turned,
    )
