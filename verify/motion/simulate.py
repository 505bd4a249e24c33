"""A linear beam in time: in closed form without a slider, by exact modal steps with one."""

from collections.abc import Callable
from time import perf_counter
from typing import TYPE_CHECKING

import numpy as np

from verify.linear.positions import Forces, Numbers, forces_on
from verify.linear.registry import MODELS
from verify.linear.surface import contact_range
from verify.linear.time_basis import TimeBasis
from verify.motion.contact import Coupling
from verify.motion.forcing import check_free_phases, check_no_resonance
from verify.motion.request import STEPS_PER_PERIOD, Envelope, Request, requested
from verify.motion.result import EndState, Motion, Statistics
from verify.motion.slider_run import Laid, begin, coupling_on, put_on, slide, steady_field, times_of
from verify.motion.surface import Stage, basis_of, free_at, on_ground, stages_from_rest, steady_stage
from verify.motion.validity import margins_of
from verify.options import Start
from verify.problem.beam import Beam
from verify.problem.slider import Slider
from verify.validation import check_kind

if TYPE_CHECKING:
    from verify.dynamics.free_vibration import FreeVibration

CLOSED_FORM_ROWS = 2000
ROUNDED = 1e-9
"""Of the forces: so far off all of them a growth may end by rounding."""


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
) -> Motion:
    """A driven beam from rest or in its steady state, with a slider or without.

    Forces are amplitude cos(omega t + phase), so that cos(0) = 1 is a step load at the start from rest. Modes advance
    exactly by any time; of a slider's step only friction and coupling are approximate.

    Parameters
    ----------
    beam : Beam
        With its supports and what it carries.
    forces : PointForce or sequence
        Amplitudes in newton, phases in degrees.
    frequency_hz : float
        Of all forces.
    duration : float
        Seconds.
    model, count : str, int
        Model of the beam and its number of segments or elements.
    modes : int, optional
        Number of modes of the exact beam from rest, 400 unless given; the other models keep all they have.
    start : {"rest", "steady"}
        Beam at rest, or in its steady state under the forces.
    soft_start_periods : float
        Periods over which the forces grow as 3 p^2 - 2 p^3.
    envelope : sequence of (seconds, coefficients)
        Any other growth, piece after piece: in each the forces have the share c0 + c1 p + c2 p^2 + ... of their
        amplitude, p from 0 to 1 within the piece; [(0.02, [0, 1])] grows linearly over 20 ms.
    modal_damping : float, optional
        Damping ratio of every mode; unless given that of the beam's loss factor at each mode.
    slider : Slider, optional
        Coupled two-way it lies on the beam from the start: its weight bends it, and in the steady state its mass is
        part of it.
    at : float or sequence
        Places of the deflection, (p,), metres.
    samples : int
        Number of times, evenly on each piece of growth and after.
    step, steps_per_period : float, int
        Of a slider alone. Unless `step` is given, steps are at most this part of the drive's period, resolve the modes
        that the start excites, and are refined until a two-way coupled slider's displacement converges
        (`statistics.moved`).
    ledger : bool
        Whether the energy balance is computed, from rest.
    continue_from : Motion or FreeVibration, optional
        A run that this one continues, with the same `start`; a slider keeps its place and speed.
    progress : callable
        Called with the fraction done.

    Returns
    -------
    Motion
        Up to where the run was interrupted or the slider left the beam, as `statistics.stopped` states.

    Raises
    ------
    InputError
        For bad arguments, and for a two-way coupled run in which the contact makes energy.
    """
    began = perf_counter()
    if slider is not None:
        check_kind("slider", slider, Slider)
        slider.check_stays()
    request = requested(
        beam,
        forces_on(beam, forces),
        frequency_hz,
        duration,
        model=model,
        count=count,
        modes=modes,
        modal_damping=modal_damping,
        start=start,
        soft_start_periods=soft_start_periods,
        envelope=envelope,
        before=continue_from,
        at=at,
        samples=samples,
        step=step,
        steps_per_period=steps_per_period,
        ledger=ledger,
        slider=slider,
    )
    stages, basis, coupling = _prepare(request)
    if slider is None or coupling is None:
        return _closed_form(request, stages, basis, began)
    ground = contact_range(beam, put_on(request, slider)[0])
    laid = Laid(
        request=request,
        slider=slider,
        stages=[on_ground(stage, ground) for stage in stages],
        basis=basis,
        coupling=coupling,
        began=began,
        notes=_notes(request, basis),
    )
    return slide(laid, progress)


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
    stage = steady_of(request, None, request.origin)
    coupling = coupling_on(request, slider, stage, None) if slider else None
    if coupling is None or not coupling.two_way:
        return [stage], None, coupling
    basis = basis_of(request.beam, request.model, request.count, request.modes, request.line)
    return [steady_of(request, basis, request.origin)], basis, coupling


def steady_of(request: Request, basis: TimeBasis | None, origin: float) -> Stage:
    """The stage of a steady beam, with free modes where there is a basis. Raises InputError."""
    field = steady_field(request, request.forces)
    return steady_stage(field, request.pieces[-1].steps, origin, basis, request.damping_in(basis))


def _notes(request: Request, basis: TimeBasis | None) -> tuple[str, ...]:
    """Modes, damping and growth of the forces."""
    notes = [f"modes: {basis.method}" if basis else f"steady field of the {request.model} model, no modes"]
    eta, replaced = request.beam.loss_factor, request.damping_replaced
    by_mode = MODELS[request.model].sized
    if request.start == "steady" and replaced and not by_mode:
        notes.append(f"damping: a loss factor {2.0 * request.damping:g} in the steady field")
    elif request.damping or eta:
        notes.append(f"damping: ratio {request.damping:g}" if replaced else f"damping: loss factor {eta:g}")
    if len(request.pieces) > 1:
        grown = sum(piece.steps.n * piece.steps.dt for piece in request.pieces[:-1])
        notes.append(f"forces grow over {grown:.6g} s")
        reached = float(np.sum(request.pieces[-2].coefficients))
        if abs(reached - 1.0) >= ROUNDED:
            notes.append(f"forces jump from {reached:.6g} times their amplitude to all of it")
    return tuple(notes)


def _closed_form(request: Request, stages: list[Stage], basis: TimeBasis | None, began: float) -> Motion:
    """Nothing nonlinear: every sample is evaluated where it stands."""
    ready = perf_counter()
    z = begin(request, stages[0], basis, None)
    parts = [stages[0].deflection(z, np.zeros(1), request.points)]
    state = stages[0].state(z, 0.0)
    for stage in stages:
        z = stage.start(*state) if stage.forced else z
        blocks = np.array_split(stage.sample_times, max(stage.n_steps // stage.every // CLOSED_FORM_ROWS, 1))
        parts += [stage.deflection(z, block, request.points) for block in blocks]
        state = stage.state(free_at(stage, z, stage.duration), stage.duration)
    times, ledger = times_of(request, stages), None
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
        ledger=ledger,
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
