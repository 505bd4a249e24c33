"""Motion of a linear beam: closed form without slider, exact modal steps with sliders in contact."""

from collections.abc import Callable
from time import perf_counter

import numpy as np
from msgspec.structs import replace

from verify.blas import one_blas_thread
from verify.dynamics.arguments import Excitation, Keep, Sliders, Step, is_sequence
from verify.dynamics.excitation import check_no_resonance
from verify.dynamics.free_vibration import FreeVibration
from verify.dynamics.linear_system import Stage, basis_of, stages_from_rest, steady_beam, steady_stage
from verify.dynamics.request import KEEP, Request, request_of
from verify.dynamics.result import END, Motion, Statistics
from verify.dynamics.slider_run import SliderRun
from verify.dynamics.validity import margins_of
from verify.linear.time_basis import TimeBasis
from verify.problem.beam import Beam
from verify.settings import Start

CLOSED_FORM_ROWS = 2000
"""Number of times evaluated at once."""
Progress = Callable[[float], None]


@one_blas_thread()
def simulate(
    beam: Beam,
    excitation: Excitation,
    duration: float,
    *,
    model: str = "segment",
    count: int | None = None,
    modes: int | None = None,
    modal_damping: float | None = None,
    slider: Sliders | None = None,
    start: Start | Motion | FreeVibration | None = None,
    step: Step | float | None = None,
    keep: Keep = KEEP,
    progress: Progress = lambda part: None,
) -> Motion:
    """A driven beam from rest or in its steady state, with or without sliders in contact.

    Modes advance exactly; the only approximation in a time step is contact, whose friction law is solved for the mean
    velocity over the step.

    Parameters
    ----------
    beam : Beam
        Beam with supports and attachments.
    excitation : Excitation
        Forces, their frequency and growth, and circuits; the forces may be empty with a slider.
    duration : float
        Duration, s.
    model, count : str, int
        Model of the beam and its number of segments or elements.
    modes : int, optional
        Number of modes of the exact beam, default: 400, under feet 80; discrete models use all their modes.
    modal_damping : float, optional
        Damping ratio of every mode; default: by the beam's loss factor.
    slider : Slider, PrescribedSlider or sequence, optional
        With two-way coupling the initial state includes the static deflection under the slider, and in the steady state
        the mass of a bilateral slider. All sliders of a sequence have one coupling and one kind of contact.
    start : {"rest", "steady"}, Motion or FreeVibration, optional
        Beam at rest, or in its steady state under the forces, or the end of an earlier run, which this run continues
        from the same initial state, with position and speed of the sliders. Without an earlier run charges of circuits
        start in equilibrium. Default: "steady" for sliders with contact, else "rest".
    step : Step or float, optional
        Time step of a slider, a number in s. By default a two-way coupled point slider is also run with the doubled
        step (`statistics.step_change`).
    keep : Keep
        Positions of the deflection and number of samples.
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
        beam,
        excitation,
        duration,
        model=model,
        count=count,
        modes=modes,
        modal_damping=modal_damping,
        slider=slider,
        start=start,
        step=step,
        keep=keep,
    )
    basis = None
    if request.start == "rest" or request.two_way:
        line = request.sliders[0].line if request.sliders else "spline"
        ports = [load for one in request.circuits for load in one.loads(beam)]
        basis = basis_of(beam, model, count, request.modes, line, [*request.forces, *ports])
    stages = _stages(request, basis)
    if not request.sliders:
        motion = _closed_form(request, stages, request.notes(basis))
    else:
        run = SliderRun.of(request, basis, stages, request.notes(basis), sequence=is_sequence(slider))
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
    case = request.model, request.count, request.beam, request.forces, request.frequency_hz
    state = steady_beam(*case, request.modal_damping, request.circuits)
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
