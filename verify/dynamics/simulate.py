"""Motion of a linear beam: closed form without slider, exact modal steps with sliders in contact."""

from collections.abc import Callable, Sequence
from time import perf_counter

import numpy as np
from msgspec.structs import replace

from verify.actuators.on_beam import Mounted
from verify.blas import one_blas_thread
from verify.dynamics.excitation import check_no_resonance
from verify.dynamics.free_vibration import FreeVibration
from verify.dynamics.linear_system import Stage, basis_of, stages_from_rest, steady_beam, steady_stage
from verify.dynamics.request import Envelope, Request, request_of
from verify.dynamics.result import END, Motion, Statistics
from verify.dynamics.slider_run import SliderRun
from verify.dynamics.validity import margins_of
from verify.linear.positions import Loads, Numbers
from verify.linear.time_basis import TimeBasis
from verify.options import Start
from verify.problem.beam import Beam
from verify.problem.slider import Slider

CLOSED_FORM_ROWS = 2000
"""Number of times evaluated at once."""
Progress = Callable[[float], None]


@one_blas_thread()
def simulate(
    beam: Beam,
    forces: Loads,
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
    circuits: Mounted | Sequence[Mounted] = (),
    progress: Progress = lambda part: None,
) -> Motion:
    """A driven beam from rest or in its steady state, with or without sliders in contact.

    Forces are amplitude cos(omega t + phase): from rest, phase 0 is a step load. Modes advance exactly; the only
    approximation in a time step is contact, whose friction law is solved for the mean velocity over the step.

    Parameters
    ----------
    beam : Beam
        Beam with supports and attachments.
    forces : PointForce, PointMoment or sequence
        Amplitudes in N or N m, phases in degrees; may be empty with a slider.
    frequency_hz : float
        Common frequency of the forces, Hz.
    duration : float
        Duration, s.
    model, count : str, int
        Model of the beam and its number of segments or elements.
    modes : int, optional
        Number of modes of the exact beam, default: 400, under feet 80; discrete models use all their modes.
    start : {"rest", "steady"}, optional
        Beam at rest, or in its steady state under the forces; default: "steady" for sliders with contact, else "rest".
    soft_start_periods : float
        Periods over which the forces grow as 3 p^2 - 2 p^3.
    envelope : sequence of (seconds, coefficients)
        Other growth in consecutive pieces: the amplitude has the factor c0 + c1 p + c2 p^2 + ..., p from 0 to 1 within
        the piece; [(0.02, [0, 1])] is linear growth over 20 ms.
    modal_damping : float, optional
        Damping ratio of every mode; default: by the beam's loss factor.
    slider : Slider or sequence, optional
        With two-way coupling the initial state includes the static deflection under the slider, and in the steady state
        the mass of a bilateral slider. All sliders of a sequence have one coupling and one kind of contact.
    prescribed_speed : float or sequence, optional
        Prescribed speed of the slider, m/s. With mu = 0 a moving load; the run continues after it has left the beam.
    fixed_position : bool or sequence
        Whether the position of a slider is fixed regardless of its speed, so that its motion is periodic.
    at : float or sequence
        Positions of the deflection, (p,), m.
    samples : int
        Number of times, evenly spaced on each piece of growth and after it.
    step, steps_per_period : float, int
        Time step of a slider. By default steps are at most a drive period over `steps_per_period` (64, with feet 61)
        and resolve the contact and the modes that the start excites; a two-way coupled point slider is also run with
        the doubled step (`statistics.step_change`).
    continue_from : Motion or FreeVibration, optional
        A run that this one continues, with the same `start`, and position and speed of the sliders.
    circuits : Mounted or sequence
        Actuators with electrical loads, and sources behind them at `frequency_hz`, whose springs and masses are part of
        the beam (`verify.actuators.on_beam.beam_in_time`); their voltages and charges are results. Without an earlier
        run charges start in equilibrium.
    progress : callable
        Called with the completed fraction.

    Returns
    -------
    Motion
        The motion, until a slider leaves the beam (`statistics.stopped`).

    Raises
    ------
    InputError
        For invalid arguments, and for a residual of the energy balance above 1 %.
    """
    began = perf_counter()
    request = request_of(
        beam, forces, frequency_hz, duration, model=model, count=count, modes=modes, start=start,
        soft_start_periods=soft_start_periods, envelope=envelope, modal_damping=modal_damping, slider=slider,
        prescribed_speed=prescribed_speed, fixed_position=fixed_position, at=at, samples=samples, step=step,
        steps_per_period=steps_per_period, continue_from=continue_from, circuits=circuits,
    )  # fmt: skip
    basis = None
    if request.start == "rest" or request.two_way:
        line = request.sliders[0].line if request.sliders else "spline"
        ports = [load for one in request.circuits for load in one.loads(beam)]
        basis = basis_of(beam, model, count, request.modes, line, [*request.forces, *ports])
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
        if not request.circuits:
            check_no_resonance(basis, request.frequency_hz, damping)
        return stages_from_rest(basis, request.forces, request.omega, damping, request.pieces, origin, request.circuits)
    state = steady_beam(
        request.model, request.count, request.beam, request.forces, request.frequency_hz, request.modal_damping,
        request.circuits,
    )  # fmt: skip
    return [steady_stage(state, request.pieces[-1].steps, origin, basis, damping, request.circuits)]


def _closed_form(request: Request, stages: list[Stage], notes: tuple[str, ...]) -> Motion:
    """A beam without slider: all samples in closed form."""
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
    deflection, voltages, charges = request.split(np.concatenate(parts))
    return Motion(
        model=request.model,
        count=request.count,
        times=times,
        points=request.points,
        deflection=deflection,
        voltages=voltages,
        charges=charges,
        margins=margins,
        notes=notes,
        statistics=Statistics(steps=0, evaluations=len(times), step_s=0.0, set_up_s=0.0, wall_s=seconds, stopped=END),
        end=request.end(stages[-1], whole, float(times[-1])),
    )
