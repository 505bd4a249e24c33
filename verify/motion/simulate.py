"""Time: a linear beam by exact steps, and a slider on it; what nothing nonlinear touches is not stepped at all."""

from collections.abc import Callable
from time import perf_counter
from typing import TYPE_CHECKING

import numpy as np

from verify.beam import Beam
from verify.checks import check_kind
from verify.models.arrays import Array
from verify.models.catalogue import MODELS
from verify.models.places import Forces, Numbers, as_forces, as_typed
from verify.models.time_basis import TimeBasis, damping_in_words
from verify.models.underfoot import ground_at
from verify.motion.carried import Laid, begin, coupling_on, put_on, slide, steady_field, times_of
from verify.motion.contact import Coupling
from verify.motion.forcing import check_free_phases, check_no_resonance
from verify.motion.margins import margins_of
from verify.motion.request import STEPS_PER_PERIOD, Driven, Envelope, Modelled, Request, Started, Watched, requested
from verify.motion.result import EndState, Ledger, Motion, Statistics
from verify.motion.surface import Stage, basis_of, free_at, on_ground, stages_from_rest, steady_stage
from verify.options import Start
from verify.slider import Slider

if TYPE_CHECKING:
    from verify.motion.free_vibration import FreeVibration

CLOSED_FORM_ROWS = 2000
ROUNDED = 1e-9
"""Of the forces: so far off all of them a growth may end by rounding."""


@as_typed
def simulate(
    beam: Beam,
    forces: Forces,
    frequency_hz: float,
    duration: float,
    *,
    model: str = "segment",
    count: int | None = None,
    modes: int | None = None,
    start: Start = "rest",
    soft_start_periods: float = 0.0,
    envelope: Envelope = (),
    modal_damping: float | None = None,
    slider: Slider | None = None,
    at: Numbers = (),
    samples: int = 201,
    step: float | None = None,
    steps_per_period: int = STEPS_PER_PERIOD,
    ledger: bool = True,
    continue_from: "Motion | FreeVibration | None" = None,
    progress: Callable[[float], None] = lambda part: None,
    patient: bool = True,
) -> Motion:
    """A driven beam from rest or in its steady state for `duration` seconds, with a slider or without.

    Forces are amplitude cos(omega t + phase): from rest cos(0) = 1 is a step load, which `soft_start_periods`
    spreads as 3 p^2 - 2 p^3. Any other growth is an `envelope` of pieces (seconds, coefficients), one after another:
    in each the forces have the part c0 + c1 p + c2 p^2 + ... of what is given, p = t/seconds from 0 to 1 within that
    piece, and all of it afterwards; [(0.02, [0, 1])] grows straight over 20 ms. Modes advance exactly by any time.
    `step` and `steps_per_period` are a slider's, refused without one: unless given, its step is at most that part of
    the drive's period, follows what the start excites (`step_size`) and, of a slider that the beam feels, is halved
    until its way stands (`judged_step`). `modes` is of the exact beam alone, which keeps so many from rest, 400 unless
    given, and none in its steady state; the others keep all they have. Damping is a ratio of every mode; unless
    given, what the beam's loss factor comes to in each (`free_vibration`). A slider that pushes back lies on the beam
    from the start: its weight bends it, and in the steady state its mass is part of it. `at` are p places in metres, or
    one, where the deflection is kept, (n, p), at n = `samples` times, or as many as part all stretches of growth where
    those are more. They stand evenly on each stretch, not over all of them (`times`). `continue_from` is a run from
    rest, or a beam let go, where this one has start = 'rest', and one whose slider pushes back on a steady field where
    it has 'steady'; a slider goes on at the place and the speed that it had. Returns what was reached where the run was
    interrupted or the slider left the beam or came to a step of its surface, and says so. Without `patient` a slider's
    run longer than is waited for (`patience`) is refused; so is one both ways, from rest and booked (`ledger`), in
    which the slider gave the beam far more than was put in. Raises InputError.
    """
    began = perf_counter()
    check_kind("patient", patient, bool)
    if slider is not None:
        check_kind("slider", slider, Slider)
        slider.check_stays()
    request = requested(
        Driven(beam, as_forces(forces), frequency_hz, duration),
        Modelled(model, count, modes, modal_damping),
        Started(start, soft_start_periods, envelope, continue_from),
        Watched(at, samples, step, steps_per_period, ledger),
        slider,
    )
    return _run(request, began, progress, patient)


def _run(request: Request, began: float, progress: Callable[[float], None], patient: bool) -> Motion:
    """What a checked request gives; `began` is the wall clock at its start, seconds. Raises InputError."""
    stages, basis, coupling = _prepare(request)
    if request.slider is None or coupling is None:
        return _closed_form(request, stages, basis, began)
    ground = ground_at(request.beam, put_on(request, request.slider)[0])
    laid = Laid(
        request=request,
        slider=request.slider,
        stages=[on_ground(stage, ground) for stage in stages],
        basis=basis,
        coupling=coupling,
        began=began,
        notes=_notes(request, basis),
    )
    return slide(laid, progress, patient)


def _prepare(request: Request) -> tuple[list[Stage], TimeBasis | None, Coupling | None]:
    """The stages of a run, the modes behind them where there are any, and how the slider is coupled."""
    slider = request.slider
    if request.start == "rest":
        basis = basis_of(request.beam, request.model, request.count, request.modes, request.line)
        damping = request.damping_in(basis)
        check_no_resonance(basis, request.frequency_hz, damping)
        check_free_phases(basis, damping, sum(piece.steps.n * piece.steps.dt for piece in request.pieces))
        stages = stages_from_rest(basis, request.forces, request.omega, damping, request.pieces, request.origin)
        return stages, basis, coupling_on(request, slider, stages[-1], basis) if slider else None
    stage = _steady(request, None)
    coupling = coupling_on(request, slider, stage, None) if slider else None
    if coupling is None or not coupling.two_way:
        return [stage], None, coupling
    basis = basis_of(request.beam, request.model, request.count, request.modes, request.line)
    return [_steady(request, basis)], basis, coupling


def _steady(request: Request, basis: TimeBasis | None) -> Stage:
    field = steady_field(request, request.forces)
    damping = request.damping_in(basis)
    return steady_stage(field, request.pieces[-1].steps, request.origin, basis, damping)


def _notes(request: Request, basis: TimeBasis | None) -> tuple[str, ...]:
    notes = [f"modes: {basis.method}" if basis else f"steady field of the {request.model} model, no modes"]
    notes += _damping_notes(request, basis)
    if len(request.pieces) > 1:
        grown = sum(piece.steps.n * piece.steps.dt for piece in request.pieces[:-1])
        reached = float(np.sum(request.pieces[-2].coefficients))
        jump = "" if abs(reached - 1.0) < ROUNDED else f" to {reached:.6g} times what is given, and jump to that"
        notes.append(f"forces grow over {grown:.6g} s{jump}")
    return tuple(notes)


def _damping_notes(request: Request, basis: TimeBasis | None) -> list[str]:
    """Which damping acts, and what it stands for: a ratio and a loss factor twice it agree at a resonance only."""
    ratio, eta = f"a ratio {request.damping:g} of every mode", request.beam.loss_factor
    by_mode = "modal_damping" in MODELS[request.model].field_settings
    if request.start == "steady" and request.damping_replaced and not by_mode:
        return [f"damping: a loss factor {2.0 * request.damping:g} in the steady field in place of {ratio}"]
    notes = []
    if request.start == "steady" and eta and not request.damping_replaced:
        notes.append(f"damping: the loss factor {eta:g} in the steady field")
    if basis and basis.ratios is not None and not request.damping_replaced:
        return [*notes, f"damping: {damping_in_words(basis.ratios, request.beam)}"]
    if request.damping and (basis or not notes):
        notes.append(f"damping: {ratio}" + (f" in place of the loss factor {eta:g}" if eta else ""))
    elif eta and request.damping_replaced:
        notes.append(f"damping: none, in place of the loss factor {eta:g}")
    return notes


def _closed_form(request: Request, stages: list[Stage], basis: TimeBasis | None, began: float) -> Motion:
    """Nothing nonlinear: every sample is evaluated where it stands."""
    ready = perf_counter()
    z = start = begin(request, stages[0], basis, None)
    parts = [stages[0].deflection(z, np.zeros(1), request.points)]
    state = stages[0].state(z, 0.0)
    for stage in stages:
        z = stage.start(*state) if stage.forced else z
        blocks = np.array_split(stage.sample_times, max(stage.n_steps // stage.every // CLOSED_FORM_ROWS, 1))
        parts += [stage.deflection(z, block, request.points) for block in blocks]
        state = stage.state(free_at(stage, z, stage.duration), stage.duration)
    times = times_of(request, stages)
    wall = perf_counter() - ready
    return Motion(
        model=request.model,
        count=request.count,
        times=times,
        points=request.points,
        deflection=np.concatenate(parts),
        slider=None,
        start=None,
        travelled=np.empty(0),
        speed=np.empty(0),
        friction=np.empty(0),
        normal_force=np.empty(0),
        surface_speed=np.empty(0),
        mean_friction=float("nan"),
        largest_friction=float("nan"),
        mean_surface_speed=float("nan"),
        events=np.empty((0, 3)),
        coupling=None,
        margins=margins_of(request, stages[-1]),
        ledger=_closed_ledger(request, stages, basis, start),
        notes=_notes(request, basis),
        statistics=Statistics(
            steps=0, evaluations=len(times), step_s=0.0, set_up_s=ready - began, wall_s=wall, stopped="end"
        ),
        end=EndState(
            beam=request.beam,
            model=request.model,
            count=request.count,
            time=float(times[-1]),
            q=state[0],
            rates=state[1],
            steady=request.start == "steady",
        ),
    )


def _closed_ledger(request: Request, stages: list[Stage], basis: TimeBasis | None, z: Array) -> Ledger | None:
    """The books of a beam alone from rest; a steady beam has no energy to gain, a continued run is not booked."""
    if basis is None or not request.accounts or request.before is not None:
        return None
    from verify.motion.energy import driven_ledger

    return driven_ledger(stages, basis, z)
