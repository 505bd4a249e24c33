"""A slider's run on a beam in time: how it is coupled, put on, stepped and told."""

from collections.abc import Callable
from functools import partial
from time import perf_counter
from typing import TYPE_CHECKING

import msgspec
import numpy as np
from msgspec.structs import replace

from verify.beam import Beam, PointForce
from verify.errors import InputError, written
from verify.models.arrays import Array, ComplexArray
from verify.models.catalogue import MODELS, check_count
from verify.models.time_basis import TimeBasis
from verify.models.underfoot import standing_at
from verify.motion.contact import Coupling, coupling_of, law_of
from verify.motion.going_on import check_goes_on
from verify.motion.judged_step import Ran, steps_in, until_it_stands
from verify.motion.margins import margins_of
from verify.motion.moving_mass import carried_along, modal_receptance, weighed_down
from verify.motion.records import (
    DAMPED,
    DRIVEN,
    KEPT_FRICTION,
    KEPT_NORMAL,
    KEPT_SURFACE,
    KEPT_V,
    KEPT_X,
    LIFTED,
    ON_BEAM,
    ON_SLIDER,
    RUBBED,
    STUCK,
    TURNED,
    Rider,
    V,
    X,
)
from verify.motion.request import MOST_STEPS, Request
from verify.motion.result import EndState, Ledger, Motion, Statistics
from verify.motion.sound_books import check_books, excess_of
from verify.motion.step_size import gripped_step, longest_step, missed, speeds, stepped
from verify.motion.stepping import Sliding, Waited, fresh_motion, of_all_steps, run_stages
from verify.motion.surface import Stage
from verify.motion.turning import couple, modal_turning
from verify.motion.windows import on_beam
from verify.patience import check_work
from verify.slider import Slider

if TYPE_CHECKING:
    from verify.models.fields import HarmonicField


def coupling_on(request: Request, slider: Slider, stage: Stage, basis: TimeBasis | None) -> Coupling:
    """How the slider is coupled where it is put on. Raises InputError."""
    x, omega = put_on(request, slider)[0], request.omega
    beam, slope = standing_at(request.beam, x), abs(stage.drive_shapes(np.array([x]), 1))[:2]
    speed = beam.surface_distance * omega * float(np.hypot(*slope[:, 0]))
    return coupling_of(slider, beam, request.frequency_hz, speed, *yielding(request, x, basis))


def yielding(request: Request, x: float, basis: TimeBasis | None) -> tuple[complex, complex]:
    """(deflection under a unit force, m/N, slope under a unit couple, rad/(N m)), both at x. Raises InputError."""
    lifted, turned = yielding_at(request, x, np.array([x]), basis)
    return complex(lifted[0]), complex(turned[0])


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
    check_count(name, count)
    model, settings = MODELS[name], {}
    if damping is not None and (damping != 0.5 * beam.loss_factor or beam.lossless):
        by_mode = "modal_damping" in model.field_settings
        beam = replace(beam, loss_factor=0.0 if by_mode else 2.0 * damping)
        settings = {"modal_damping": damping} if by_mode else {}
    return model.solve_harmonic(beam, forces, frequency_hz, count, **settings)


def begin(request: Request, stage: Stage, basis: TimeBasis | None, coupling: Coupling | None) -> Array:
    """The free modes at the start, (2, n), as the run before left them. Raises InputError.

    Otherwise at rest or steady, and under what a slider that pushes back puts on the beam.
    """
    n = len(stage.modal.squares)
    if request.before is not None:
        check_goes_on(request.before, request.beam, request.model, request.count, n, request.start)
        return stage.start(request.before.q, request.before.rates)
    q, rates = np.zeros(n), np.zeros(n)  # of a beam at rest, and of what a steady one moves beside its field
    if basis and request.slider and coupling and coupling.pushes_back:
        x = put_on(request, request.slider)[0]
        q = q + weighed_down(basis, x, request.slider.normal_force)
        if stage.forced is None:
            added = carried_along(basis, stage, x, request.slider, request.damping_in(basis))
            q, rates = q + added[0], added[1]
    return stage.start(q, rates)


def put_on(request: Request, slider: Slider) -> tuple[float, float, bool]:
    """(position, speed, whether it sticks) at the start: where the run before left it, else as the slider says."""
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
    """A run laid out, before its slider takes a step."""

    request: Request
    slider: Slider
    stages: list[Stage]
    basis: TimeBasis | None
    """None where no mode is free."""
    coupling: Coupling
    began: float
    """Wall clock at the request, seconds."""
    notes: tuple[str, ...]


def slide(laid: Laid, progress: Callable[[float], None], patient: bool) -> Motion:
    """Step the slider through all stages. Raises InputError where that takes too many steps, or too long.

    Also where it was booked, and the contact gave the beam far more than was put in. Unless a step is given, that of a
    slider that the beam feels is halved until its way stands (`judged_step`).
    """
    request, felt = laid.request, laid.coupling.two_way
    stages, step_note = _in_steps(request, laid.stages, begin(request, laid.stages[0], laid.basis, None), laid.coupling)
    laid = replace(laid, stages=stages, notes=(*laid.notes, laid.coupling.note, *step_note))
    duration, ready = sum(stage.duration for stage in stages), perf_counter()
    waited = Waited(rows=len(stages[0].modal.squares), two_way=felt, duration=None if patient else duration)
    if not patient:
        check_work("duration", duration, waited.seconds(steps_in(stages)), "shorten it or lengthen the step")
    if request.step is None and felt:
        ran = until_it_stands(partial(_ran, laid, waited), stages, waited.seconds, progress)
    else:
        ran = _ran(laid, waited, stages, progress)
    check_books(ran.excess, request, ran.stages)
    taken = ran.motion.statistics
    return replace(ran.motion, statistics=replace(taken, set_up_s=taken.set_up_s + ready - laid.began))


def _ran(laid: Laid, waited: Waited, stages: list[Stage], progress: Callable[[float], None]) -> Ran:
    """A run through these stages."""
    request, basis = laid.request, laid.basis
    began = perf_counter()
    z = begin(request, stages[0], basis, laid.coupling)
    sliding = _fresh(request, laid.slider, stages, laid.coupling, waited)
    n_steps = steps_in(stages)
    waited.steps += n_steps
    energy = _beam_energy(basis, *stages[0].state(z, 0.0)) if basis else (0.0, 0.0)
    ready = perf_counter()
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
    lost = (f"events: the first {len(sliding.events)} of {len(sliding.events) + sliding.n_lost}",)
    said = replace(laid, stages=stages, notes=(*laid.notes, *lost * bool(sliding.n_lost)))
    found = _told(said, sliding, statistics, energy, *state)
    if not (laid.coupling.two_way and found.ledger and basis) or statistics.interrupted:
        return Ran(found, stages, None)
    had = _own_energy(sliding) + (sum(energy) if request.before else 0.0)
    way = float(abs(found.travelled).max())
    return Ran(found, stages, excess_of(found.ledger, had, way, request, basis))


def _own_energy(sliding: Sliding) -> float:
    """What the slider had of motion at the start, and what its weight gave as it fell, joules."""
    (height, climb), law = sliding.set_down, sliding.rider.law
    fell = max(height - sliding.held[0], 0.0)
    return 0.5 * law.mass * (float(sliding.first[0, KEPT_V]) ** 2 + climb**2) + law.load * fell


def _told(
    laid: Laid, sliding: Sliding, statistics: Statistics, energy: tuple[float, float], q: Array, rates: Array
) -> Motion:
    """What came of a run that ended with the modes at (q, rates); `energy` is the beam's at its start."""
    request, n = laid.request, sliding.n_kept
    columns, end = np.concatenate([sliding.first, sliding.kept.kept[:n]]).T, _end(laid, sliding, q, rates)
    friction = laid.slider.mass * columns[KEPT_FRICTION]
    mean_friction, hardest, mean_surface = of_all_steps(sliding.motion, laid.slider.mass, end.time - request.origin)
    if _put_at_rest(request, laid.slider):
        friction[0] = 0.0
    return Motion(
        model=request.model,
        count=request.count,
        times=times_of(request, laid.stages)[: n + 1],
        points=request.points,
        deflection=np.concatenate([sliding.first_deflection, sliding.kept.deflections[:n]]),
        slider=laid.slider,
        start=sliding.start,
        travelled=columns[KEPT_X],
        speed=columns[KEPT_V],
        friction=friction,
        surface_speed=columns[KEPT_SURFACE],
        mean_friction=mean_friction,
        largest_friction=hardest,
        mean_surface_speed=mean_surface,
        normal_force=columns[KEPT_NORMAL],
        events=sliding.events,
        coupling=laid.coupling,
        margins=margins_of(request, laid.stages[-1], sliding.fall),
        ledger=_ledger(laid.basis, sliding, energy, q, rates) if sliding.accounts else None,
        notes=laid.notes,
        statistics=statistics,
        end=end,
    )


def _put_at_rest(request: Request, slider: Slider) -> bool:
    """Whether slider and beam stand still at the start: no friction is needed, whatever the sign of rounding."""
    return request.start == "rest" and request.before is None and slider.speed == 0.0


def times_of(request: Request, stages: list[Stage]) -> Array:
    """When the start and the samples of all stages stand, (n,), seconds."""
    return np.concatenate([[request.origin], *(stage.origin + stage.sample_times for stage in stages)])


def _in_steps(
    request: Request, stages: list[Stage], z: Array, coupling: Coupling
) -> tuple[list[Stage], tuple[str, ...]]:
    """The stages in steps that follow what the start excites; of given steps, a note by how much they are too long."""
    duration, dt = sum(stage.duration for stage in stages), max(stage.dt for stage in stages)
    coarsest = 0.5 * dt if coupling.pushes_back and request.step is None else dt  # its waves run within a step
    enough = longest_step(stages, z, request.beam.length, coarsest)
    rate = _grip(request.slider) if request.slider and coupling.two_way else 0.0
    said = _sticking_note(stages, rate, dt) if request.step is not None else ()
    if request.step is None:
        enough = gripped_step(stages, rate, enough)
        if duration / enough > MOST_STEPS:
            raise InputError(
                f"duration = {written(duration)} s: what the start excites takes steps of {enough:.2g} s, more than "
                f"{MOST_STEPS:g} of them: shorten the duration, lengthen soft_start_periods, or give a step"
            )
        return stepped(stages, enough), ()
    if enough >= dt:
        return stages, said
    share = missed(*speeds(stages, z, request.beam.length), dt)
    return stages, (
        *said,
        f"step: {dt:.3g} s is {dt / enough:.3g} times too long for what the start excites and misses "
        f"{100 * share:.2g} % of the surface's speed; give at most {enough:.2g} s",
    )


def _sticking_note(stages: list[Stage], rate: float, dt: float) -> tuple[str, ...]:
    """Of given steps, that a stick may gain energy in them."""
    enough = gripped_step(stages, rate, dt)
    if enough >= dt:
        return ()
    return (
        f"step: {dt:.3g} s is longer than half a turn of the fastest mode, in which a slider that sticks to the beam "
        f"can gain energy from friction; give at most {enough:.2g} s",
    )


def _grip(slider: Slider) -> float:
    """K mu N / m, how fast friction takes the slider to the surface's speed, 1/s; endless for Coulomb's law."""
    return (
        float("inf") if slider.steepness is None else slider.steepness * slider.mu * slider.normal_force / slider.mass
    )


def _fresh(request: Request, slider: Slider, stages: list[Stage], coupling: Coupling, waited: Waited) -> Sliding:
    """Room for the slider's run from where it starts."""
    start, speed, stuck = put_on(request, slider)
    law = law_of(slider, standing_at(request.beam, start))
    rider = Rider(fresh_motion(speed, stuck), law, coupling.two_way or None)
    samples = sum(stage.n_steps // stage.every for stage in stages)
    booked = request.accounts and request.start == "rest"
    sliding = Sliding.fresh(start, samples, request.points, rider, booked, waited.read)
    if request.before is not None and request.before.height is not None:
        sliding.on_its_way = request.before.height, request.before.climb
    return sliding


def _end(laid: Laid, sliding: Sliding, q: Array, rates: Array) -> EndState:
    request, stages = laid.request, laid.stages
    height, climb = sliding.held if laid.coupling.pushes_back else (None, 0.0)
    x = sliding.start + float(sliding.motion[X])
    return EndState(
        beam=request.beam,
        model=request.model,
        count=request.count,
        time=reached(stages, sliding.steps),
        q=q,
        rates=rates,
        steady=request.start == "steady",
        position=x,
        speed=float(sliding.motion[V]),
        stuck=bool(sliding.motion[STUCK] > 0.0),
        height=height,
        climb=climb,
        off="" if on_beam(stages[-1], sliding.start, float(sliding.motion[X])) else stages[-1].beyond(x, x),
    )


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


def _ledger(
    basis: TimeBasis | None, sliding: Sliding, before: tuple[float, float], q: Array, rates: Array
) -> Ledger | None:
    if basis is None:
        return None
    booked = sliding.ledger.tolist()
    on_beam, lifted, driven, damped = (booked[of] for of in (ON_BEAM, LIFTED, DRIVEN, DAMPED))
    kinetic, elastic = _beam_energy(basis, q, rates)
    gained = kinetic + elastic - sum(before)
    charged = on_beam + lifted if sliding.rider.two_way else 0.0
    return Ledger(
        kinetic=kinetic,
        elastic=elastic,
        slider=booked[ON_SLIDER],
        work_in=driven,
        damped=damped,
        rubbed=booked[RUBBED],
        contact_on_beam=on_beam,
        normal_on_beam=lifted,
        residual=driven + charged - damped - gained,
        turned=booked[TURNED],
    )
