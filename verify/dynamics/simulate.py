"""A linear beam in time: in closed form alone, by exact modal steps with sliders in contact."""

from collections.abc import Callable, Sequence
from time import perf_counter

import numpy as np
from msgspec.structs import replace

from verify.dynamics.excitation import check_no_resonance
from verify.dynamics.free_vibration import FreeVibration
from verify.dynamics.linear_system import Stage, basis_of, damped_field, stages_from_rest, steady_stage
from verify.dynamics.request import Envelope, Request, request_of
from verify.dynamics.result import END, Motion, Statistics
from verify.dynamics.slider_run import SliderRun
from verify.dynamics.validity import margins_of
from verify.linear.positions import Forces, Numbers
from verify.linear.time_basis import TimeBasis
from verify.options import Start
from verify.problem.beam import Beam
from verify.problem.slider import Slider

CLOSED_FORM_ROWS = 2000
"""Times evaluated at once."""
Progress = Callable[[float], None]


def simulate(
    beam: Beam,
    forces: Forces,
    frequency_hz: float,
    duration: float,
    *,
    model: str = "segment",
    count: int | None = None,
    modes: int | None = None,
    start: Start | None = None,
    soft_start_periods: float = 0.0,
    envelope: Envelope = (),
    modal_damping: float | None = None,
    slider: Slider | Sequence[Slider] | None = None,
    prescribed_speed: float | Sequence[float | None] | None = None,
    fixed_position: bool | Sequence[bool] = False,
    at: Numbers = (),
    samples: int = 201,
    step: float | None = None,
    steps_per_period: int | None = None,
    continue_from: Motion | FreeVibration | None = None,
    progress: Progress = lambda part: None,
) -> Motion:
    """A driven beam from rest or in its steady state, with sliders in contact or alone.

    Forces are amplitude cos(omega t + phase), so that cos(0) = 1 is a step load at the start from rest. Modes advance
    exactly by any time; of a slider's step only contact is approximate (friction law solved exactly for the mean
    velocity over the step).

    Parameters
    ----------
    beam : Beam
        With its supports and attachments.
    forces : PointForce or sequence
        Amplitudes in N, phases in degrees; may be empty with a slider.
    frequency_hz : float
        Of all forces.
    duration : float
        Seconds.
    model, count : str, int
        Model of the beam and its number of segments or elements.
    modes : int, optional
        Number of modes of the exact beam, 400 unless given, 80 under feet; the other models keep all they have.
    start : {"rest", "steady"}, optional
        Beam at rest, or in its steady state under the forces; "steady" unless given for sliders with contact.
    soft_start_periods : float
        Periods over which the forces grow as 3 p^2 - 2 p^3.
    envelope : sequence of (seconds, coefficients)
        Any other growth, piece after piece: in each the forces have the share c0 + c1 p + c2 p^2 + ... of their
        amplitude, p from 0 to 1 within the piece; [(0.02, [0, 1])] grows linearly over 20 ms.
    modal_damping : float, optional
        Damping ratio of every mode; unless given that of the beam's loss factor at each mode.
    slider : Slider or sequence, optional
        Coupled two-way it lies on the beam from the start: its weight bends it, and in the steady state the mass of a
        bilateral slider is part of it. Sliders of a sequence share coupling and kind of contact.
    prescribed_speed : float or sequence, optional
        Speed of the slider, m/s. Without friction (mu = 0) a moving load, after which the beam vibrates on.
    fixed_position : bool or sequence
        Whether a slider keeps its position, whatever its speed, so that its motion is periodic.
    at : float or sequence
        Places of the deflection, (p,), m.
    samples : int
        Number of times, evenly on each piece of growth and after.
    step, steps_per_period : float, int
        Of a slider. Unless `step` is given, steps are at most this part of the drive's period (64, or 61 with feet),
        resolve the modes that the start excites and the contact, and a two-way coupled point slider is run with the
        doubled step too (`statistics.step_change`).
    continue_from : Motion or FreeVibration, optional
        A run that this one continues, with the same `start`; sliders keep place and speed.
    progress : callable
        Called with the fraction done.

    Returns
    -------
    Motion
        Up to where a slider left the beam (`statistics.stopped`).

    Raises
    ------
    InputError
        For bad arguments, and where the energy balance does not close within 1 %.
    """
    began = perf_counter()
    request = request_of(
        beam, forces, frequency_hz, duration, model=model, count=count, modes=modes, start=start,
        soft_start_periods=soft_start_periods, envelope=envelope, modal_damping=modal_damping, slider=slider,
        prescribed_speed=prescribed_speed, fixed_position=fixed_position, at=at, samples=samples, step=step,
        steps_per_period=steps_per_period, continue_from=continue_from,
    )  # fmt: skip
    basis = None
    if request.start == "rest" or request.two_way:
        line = request.sliders[0].line if request.sliders else "spline"
        basis = basis_of(beam, model, count, request.modes, line)
    stages = _stages(request, basis)
    if not request.sliders:
        motion = _closed_form(request, stages, request.notes(basis))
    else:
        run = SliderRun.of(request, basis, stages, request.notes(basis), sequence=not isinstance(slider, Slider))
        motion = run.converged(progress)
    statistics = motion.statistics
    return replace(motion, statistics=replace(statistics, set_up_s=perf_counter() - began - statistics.wall_s))


def _stages(request: Request, basis: TimeBasis | None) -> list[Stage]:
    """The stages of a run. Raises InputError for a resonance and for unknown phases."""
    origin, damping = request.before.time if request.before else 0.0, request.damping_in(basis)
    if request.start == "rest":
        assert basis is not None
        check_no_resonance(basis, request.frequency_hz, damping)
        return stages_from_rest(basis, request.forces, request.omega, damping, request.pieces, origin)
    field = damped_field(
        request.model, request.count, request.beam, request.forces, request.frequency_hz, request.modal_damping
    )
    return [steady_stage(field, request.pieces[-1].steps, origin, basis, damping)]


def _closed_form(request: Request, stages: list[Stage], notes: tuple[str, ...]) -> Motion:
    """A beam alone: every sample by its closed form."""
    began, first = perf_counter(), stages[0]
    whole = request.continued(first) if request.before else np.zeros(len(first.rows.rates), dtype=complex)
    parts = [first.deflection(first.free(whole), np.zeros(1), request.points)]
    for stage in stages:
        z = stage.free(whole)
        blocks = np.array_split(stage.sample_times, len(stage.sample_times) // CLOSED_FORM_ROWS + 1)
        parts += [stage.deflection(z, block, request.points) for block in blocks]
        whole = stage.whole(stage.rows.after(z, stage.duration), stage.duration)
    times = np.concatenate([[first.origin], *(stage.origin + stage.sample_times for stage in stages)])
    margins, seconds = margins_of(request, stages[-1]), perf_counter() - began
    return Motion(
        model=request.model,
        count=request.count,
        times=times,
        points=request.points,
        deflection=np.concatenate(parts),
        margins=margins,
        notes=notes,
        statistics=Statistics(steps=0, evaluations=len(times), step_s=0.0, set_up_s=0.0, wall_s=seconds, stopped=END),
        end=request.end(stages[-1], whole, float(times[-1])),
    )
