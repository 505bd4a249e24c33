"""Motion of a linear beam: closed form without slider, exact modal steps with sliders in contact."""

from time import perf_counter
from typing import Any

import numpy as np
from msgspec.structs import replace

from verify.arrays import Array, ComplexArray
from verify.blas import one_blas_thread
from verify.dynamics.arguments import Excitation, Keep, Sliders, Step
from verify.dynamics.excitation import Forced, check_no_resonance, forced_response, rows_on
from verify.dynamics.free_vibration import FreeVibration
from verify.dynamics.linear_system import EXACT_DEGREE, NO_READINGS, Stage, basis_of, steady_beam
from verify.dynamics.request import KEEP, Request, request_of
from verify.dynamics.result import END, Motion, Statistics
from verify.dynamics.slider_run import Progress, SliderRun
from verify.dynamics.validity import margins_of
from verify.linear.time_basis import Ratio, TimeBasis
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


def beam_in_time(request: Request) -> tuple[TimeBasis | None, list[Stage]]:
    """Free modes, None if none respond, and the stages of a run. Raises InputError, also for a resonance."""
    basis = None
    if request.start == "rest" or request.two_way:
        line = request.sliders[0].line if request.sliders else "spline"
        ports = [load for one in request.circuits for load in one.loads(request.beam)]
        loads = [*request.forces, *ports]
        basis = basis_of(request.beam, request.model, request.count, request.modes, line, loads)
    damping = request.damping_in(basis)
    if basis is None or request.start == "steady":
        return basis, [steady_stage(request, basis, damping)]
    if not request.circuits:
        check_no_resonance(basis, request.frequency_hz, damping)
    return basis, stages_from_rest(request, basis, damping)


def stages_from_rest(request: Request, basis: TimeBasis, damping: Ratio) -> list[Stage]:
    """One stage per piece of the envelope, with the quasi-static response of truncated modes."""
    forces, origin, stages = request.forces, request.origin, list[Stage]()
    rows = rows_on(basis, forces, damping, request.circuits, request.omega)
    tail = basis.tail(forces, request.frequency_hz, damping) if basis.tail and forces else None
    if tail:  # its third derivative jumps where a force acts
        basis = replace(basis, edges=np.union1d(basis.edges, [f.position for f in forces]))
    for steps, envelope in request.pieces:
        unit = steps.duration
        forced = forced_response(rows, request.omega, envelope, unit, origin)
        growth = np.pad(envelope, (0, forced.forward.shape[1] - len(envelope))) if tail else envelope

        def field(x: Array, derivative: int, psi: Any, forced: Forced = forced, growth: Array = growth) -> ComplexArray:
            shapes = forced.drive_shapes(psi)  # truncated modes follow the envelope without delay
            return shapes + np.outer(growth, tail(x, derivative)) if tail else shapes

        stages.append(
            Stage(
                rows=rows,
                forced=forced,
                shapes=rows.shapes(basis),
                field=field,
                edges=_to_the_end(basis.edges, basis.beam),
                degree=basis.degree,
                omega=request.omega,
                origin=origin,
                unit_s=unit,
                envelope=envelope,
                steps=steps,
                complex_rows=len(rows.rates) * bool(request.circuits),
                readings=forced.drive_shapes(rows.readings) if request.circuits else NO_READINGS,
            )
        )
        origin += unit
    return stages


def steady_stage(request: Request, basis: TimeBasis | None, damping: Ratio) -> Stage:
    """A beam in its steady state; the modes of `basis` start at rest and respond to contact forces."""
    case = request.model, request.count, request.beam, request.forces, request.frequency_hz
    state = steady_beam(*case, request.modal_damping, request.circuits)
    harmonic = state.field
    beam, degree = harmonic.beam, 3
    if harmonic.edges is not None:
        edges = harmonic.edges
    else:
        softest = max(p.mass_per_length / p.bending_stiffness for p in beam.pieces) * beam.wave_constant**2
        cells = int(np.ceil(beam.length * abs(harmonic.wavenumber) * softest**0.25 / 0.3)) + 1
        jumps = [*np.cumsum([piece.length for piece in beam.pieces[:-1]])]
        jumps += [attachment.position for attachment in beam.attached]
        jumps += [force.position for force in harmonic.forces]
        jumps += harmonic.couples
        edges, degree = np.union1d(np.linspace(0.0, beam.length, cells + 1), jumps), EXACT_DEGREE
    if basis:
        edges, degree = np.union1d(edges, basis.edges), max(degree, basis.degree)

    def field(x: Array, derivative: int, psi: Any) -> ComplexArray:
        # w'''' = k^4 w between the forces of a uniform exact beam, whose field has four derivatives
        higher, rest = divmod(derivative, 4) if harmonic.count is None and harmonic.beam.uniform else (0, derivative)
        return np.asarray(harmonic.shapes(x, rest) * harmonic.wavenumber ** (4 * higher))[None, :]

    steady = [one.voltage for one in state.actuators] + [one.current / (1j * harmonic.omega) for one in state.actuators]
    stage = Stage(
        field=field,
        edges=_to_the_end(edges, beam),
        degree=degree,
        omega=harmonic.omega,
        origin=request.origin,
        steps=request.pieces[-1][0],
        readings=np.array([steady], dtype=complex),
    )
    if basis is None:
        return stage
    rows = rows_on(basis, (), damping, request.circuits, harmonic.omega)
    return replace(stage, rows=rows, shapes=rows.shapes(basis), complex_rows=len(rows.rates) * bool(request.circuits))


def _to_the_end(edges: Array, beam: Beam) -> Array:
    """Edges with the last one set exactly to the beam's end."""
    return np.append(edges[:-1], beam.length)
