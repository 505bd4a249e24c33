"""Motion of a linear beam: closed form without slider, exact modal steps with sliders in contact."""

from time import perf_counter

import numpy as np
from msgspec.structs import replace

from verify.blas import one_blas_thread
from verify.dynamics.arguments import Excitation, Keep, Sliders, Step
from verify.dynamics.free_vibration import FreeVibration
from verify.dynamics.linear_system import Stage
from verify.dynamics.request import KEEP, Request, request_of
from verify.dynamics.result import END, Motion, Statistics
from verify.dynamics.slider_run import Progress, SliderRun
from verify.dynamics.stages import beam_in_time
from verify.dynamics.validity import margins_of
from verify.problem.beam import Beam
from verify.settings import Start

CLOSED_FORM_ROWS = 2000  # Number of times evaluated at once


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
    velocity over the step. Raises InputError for invalid arguments, and for a residual of the energy above 1 %.

    Parameters
    ----------
    beam, excitation, duration : Beam, Excitation, float
        Beam, its forces and circuits (forces may be empty with a slider), and duration, s.
    model, count, modes, modal_damping : str, int, int, float
        Model, number of segments or elements, number of modes of the exact beam (default: 400, under feet 80; discrete
        models use all), damping ratio of every mode (default: by the beam's loss factor).
    slider : Slider, PrescribedSlider or sequence, optional
        With two-way coupling the initial state includes the static deflection under the slider, and in the steady state
        the mass of a bilateral slider. All sliders of a sequence have one coupling and one kind of contact. The run
        ends where one leaves the beam (`statistics.stopped`).
    start : {"rest", "steady"}, Motion or FreeVibration, optional
        At rest, in the steady state under the forces (default with contact), or the end of an earlier run, which this
        one continues with its sliders. Without an earlier run charges of circuits start in equilibrium.
    step, keep, progress : Step or float, Keep, callable
        Time step of a slider, a number in s (by default a two-way coupled point slider is also run with the doubled
        step, `statistics.step_change`); recorded output; called with the completed fraction.
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
    basis, stages = beam_in_time(request)
    if request.sliders:
        motion = SliderRun.of(request, basis, stages, request.notes(basis)).converged(progress)
    else:
        motion = _closed_form(request, stages, request.notes(basis))
    statistics = motion.statistics
    return replace(motion, statistics=replace(statistics, set_up_s=perf_counter() - began - statistics.wall_s))


def _closed_form(request: Request, stages: list[Stage], notes: tuple[str, ...]) -> Motion:
    """A beam without slider: all samples in closed form."""
    began, z = perf_counter(), request.released(stages[0])
    outputs = [stages[0].deflection(z, np.zeros(1), request.points)]
    for i, stage in enumerate(stages):
        z = stage.free(z) if i else z
        blocks = np.array_split(stage.sample_times, len(stage.sample_times) // CLOSED_FORM_ROWS + 1)
        outputs += [stage.deflection(z, block, request.points) for block in blocks]
        z = stage.whole(stage.rows.after(z, stage.duration), stage.duration)
    evaluations, time = sum(map(len, outputs)), float(stage.origin + stage.sample_times[-1])
    seconds = perf_counter() - began
    return request.motion(
        stages,
        np.concatenate(outputs),
        margins=margins_of(request, stage),
        notes=notes,
        statistics=Statistics(steps=0, evaluations=evaluations, step_s=0.0, set_up_s=0.0, wall_s=seconds, stopped=END),
        end=request.end(stage, z, time),
    )
