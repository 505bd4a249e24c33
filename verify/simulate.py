"""Time: a linear beam by exact steps, and a slider on it; what nothing nonlinear touches is not stepped at all."""

from collections.abc import Callable, Sequence
from time import perf_counter
from typing import Literal

import msgspec
import numpy as np
from msgspec.structs import replace

from verify.beam import Beam, PointForce, check_number, check_whole
from verify.contact import Coupling, Margins, coupling_of, law_entries
from verify.errors import InputError
from verify.fields import check_drive
from verify.forcing import CONSTANT, SMOOTH_STEP, check_no_resonance
from verify.motion import EndState, Ledger, Motion, Statistics
from verify.moving_surface import Growth, Stage, basis_of, check_line, cut, free_at, stages_from_rest, steady_stage
from verify.patience import check_work
from verify.slider import GRAVITY, Slider
from verify.slider_run import Sliding, run_stages, slider_seconds
from verify.time_basis import Array, TimeBasis

STEPS_PER_PERIOD = 64
COARSEST = 0.25
"""Of a period: longer steps of a slider are refused."""
Envelope = Sequence[tuple[float, Sequence[float]]]
"""Pieces (seconds, coefficients of powers of t / seconds) of the forces' amplitude."""
CLOSED_FORM_ROWS = 2000


class Request(msgspec.Struct, frozen=True, eq=False, kw_only=True):
    """A simulation, checked and with its steps laid out."""

    beam: Beam
    forces: tuple[PointForce, ...]
    frequency_hz: float
    model: str
    count: int | None
    modes: int
    start: str
    damping: float
    slider: Slider | None
    points: Array
    pieces: tuple[Growth, ...]
    accounts: bool
    before: EndState | None

    @property
    def omega(self) -> float:
        """2 pi f, rad/s."""
        return 2.0 * np.pi * self.frequency_hz

    @property
    def origin(self) -> float:
        """Seconds that have passed when this run begins."""
        return self.before.time if self.before else 0.0

    @property
    def n_steps(self) -> int:
        """Of all pieces."""
        return sum(piece.steps.n for piece in self.pieces)

    @property
    def damping_replaced(self) -> bool:
        """Whether the ratio of every mode is another than half the beam's loss factor."""
        return self.damping != 0.5 * self.beam.loss_factor

    @property
    def line(self) -> str:
        """The contact line."""
        return self.slider.line if self.slider else "spline"


def simulate(
    beam: Beam,
    forces: Sequence[PointForce],
    frequency_hz: float,
    duration: float,
    *,
    model: Literal["analytic", "fem", "segment"] = "segment",
    count: int | None = None,
    modes: int = 400,
    start: Literal["rest", "steady"] = "rest",
    soft_start_periods: float = 0.0,
    envelope: Envelope = (),
    modal_damping: float | None = None,
    slider: Slider | None = None,
    at: Sequence[float] = (),
    samples: int = 201,
    step: float | None = None,
    ledger: bool = True,
    continue_from: Motion | None = None,
    progress: Callable[[float], None] = lambda part: None,
    patient: bool = True,
) -> Motion:
    """A driven beam from rest or in its steady state for `duration` seconds, with a slider or without.

    Forces are amplitude cos(omega t + phase): from rest cos(0) = 1 is a step load, which `soft_start_periods`
    spreads as 3 p^2 - 2 p^3; any other growth is an `envelope` of polynomial pieces, after which the amplitudes are
    those given. Modes advance exactly by any step; `step` (default a 64th of a period) is the slider's alone. The
    exact beam keeps `modes` modes from rest and none in its steady state. Damping is a ratio of every mode, half
    the beam's loss factor unless given. `at` are metres where the deflection is kept. Returns what was reached
    where the run was interrupted or the slider left the beam, and says so. Without `patient` a slider's run longer than
    is waited for (`patience`) is refused. Raises InputError.
    """
    began = perf_counter()
    request = _request(beam, tuple(forces), frequency_hz, duration, model, count, modes, start, soft_start_periods,
                       envelope, modal_damping, slider, at, samples, step, ledger, continue_from)  # fmt: skip
    stages, basis, coupling = _prepare(request)
    if slider is None:
        return _closed_form(request, stages, basis, began)
    assert coupling is not None
    if not patient:
        seconds = slider_seconds(request.n_steps, len(basis.omegas) if basis else 0, coupling.two_way)
        check_work("duration", duration, seconds, "shorten it or lengthen the step")
    return _with_slider(request, stages, basis, coupling, began, progress)


def _request(
    beam: Beam, forces: tuple[PointForce, ...], frequency_hz: float, duration: float, model: str, count: int | None,
    modes: int, start: str, soft: float, envelope: Envelope, damping: float | None, slider: Slider | None,
    at: Sequence[float], samples: int, step: float | None, ledger: bool, before: Motion | None,
) -> Request:  # fmt: skip
    check_drive(beam, forces, frequency_hz)
    check_number("duration", duration, "seconds", above=0)
    check_number("soft_start_periods", soft, "periods of the drive", at_least=0)
    if model not in ("analytic", "fem", "segment"):
        raise InputError(f"model = {model!r} is not known: known are analytic, fem, segment")
    if start not in ("rest", "steady"):
        raise InputError(f"start = {start!r} is not known: known are rest, steady")
    if (soft or envelope) and (start == "steady" or before):
        raise InputError(f"soft_start_periods = {soft!r}: a beam that moves already has no start, leave it out")
    if soft and envelope:
        raise InputError(f"soft_start_periods = {soft!r} and an envelope: give one of the two")
    check_whole("samples", samples, 2)
    if samples > 10_000_000:
        raise InputError(f"samples = {samples!r}: keep between 2 and 10000000 of them")
    zeta = 0.5 * beam.loss_factor if damping is None else damping
    check_number("modal_damping", zeta, "ratio of every mode", at_least=0, below=1)
    points = np.atleast_1d(np.asarray(at, dtype=float)) if len(at) else np.empty(0)
    if not np.all((points >= 0.0) & (points <= beam.length)):
        raise InputError(f"at = {points.tolist()!r} leaves the beam: give positions between 0 and {beam.length!r} m")
    longest = 1.0 / (STEPS_PER_PERIOD * frequency_hz) if step is None else step
    check_number("step", longest, "seconds", above=0)
    if slider is not None and longest * frequency_hz > COARSEST:
        raise InputError(
            f"step = {longest!r} s is {longest * frequency_hz:.3g} periods of the drive, which a slider would not see: "
            f"give at most {COARSEST / frequency_hz:.3g} s"
        )
    if duration / longest > 2e9:
        raise InputError(f"step = {longest!r} takes more than 2e9 steps: lengthen the step or shorten the duration")
    check_line(model, start, slider.line if slider else "spline")
    grown = (
        ((soft / frequency_hz, SMOOTH_STEP),) if soft else tuple((s, np.asarray(c, dtype=float)) for s, c in envelope)
    )
    return Request(beam=beam, forces=forces, frequency_hz=frequency_hz, model=model, count=count, modes=modes,
                   start=start, damping=zeta, slider=slider, points=points, accounts=ledger,
                   before=before.end if before else None,
                   pieces=_laid_out(duration, grown, longest, samples - 1))  # fmt: skip


def _laid_out(
    duration: float, grown: Sequence[tuple[float, Array]], longest: float, samples: int
) -> tuple[Growth, ...]:
    """Steps of every piece of the envelope and of the constant forces after it, samples shared by length."""
    lengths = [seconds for seconds, _ in grown]
    if any(not 0.0 < s < np.inf for s in lengths) or any(not len(c) or not np.all(np.isfinite(c)) for _, c in grown):
        raise InputError(
            "envelope: give pieces (seconds, coefficients), each longer than 0 s and of finite coefficients"
        )
    rest = duration - sum(lengths)
    if grown and rest < -1e-12 * duration:
        raise InputError(
            f"the forces grow over {sum(lengths)!r} s of duration = {duration!r} s: shorten soft_start_periods or "
            "envelope, or lengthen the duration"
        )
    pieces = list(grown) + ([(rest, CONSTANT)] if rest > 1e-12 * duration else [])
    shares = [max(round(samples * seconds / duration), 1) for seconds, _ in pieces]
    shares[-1] = max(samples - sum(shares[:-1]), 1)
    return tuple(Growth(cut(seconds, longest, share), c) for (seconds, c), share in zip(pieces, shares, strict=True))


def _prepare(request: Request) -> tuple[list[Stage], TimeBasis | None, Coupling | None]:
    """The stages of a run, the modes behind them where there are any, and how the slider is coupled."""
    if request.start == "rest":
        basis = basis_of(request.beam, request.model, request.count, request.modes, request.line)
        check_no_resonance(basis, request.frequency_hz, request.damping)
        stages = stages_from_rest(basis, request.forces, request.omega, request.damping, request.pieces, request.origin)
        return stages, basis, _coupling(request, stages[-1])
    stage = _steady(request, None)
    coupling = _coupling(request, stage)
    if coupling is None or not coupling.two_way:
        return [stage], None, coupling
    basis = basis_of(request.beam, request.model, request.count, request.modes, request.line)
    return [_steady(request, basis)], basis, coupling


def _steady(request: Request, basis: TimeBasis | None) -> Stage:
    from verify.waves import solve_by_model

    if request.model != "analytic" and request.count is None:
        raise InputError(f"count is missing: give the number of segments or elements for model = {request.model}")
    beam, settings = request.beam, {}
    if request.damping_replaced:
        beam = replace(beam, loss_factor=2.0 * request.damping if request.model == "analytic" else 0.0)
        settings = {} if request.model == "analytic" else {"modal_damping": request.damping}
    field = solve_by_model(request.model, beam, request.forces, request.frequency_hz, request.count, settings)
    return steady_stage(field, request.pieces[-1].steps, request.origin, basis, request.damping)


def _coupling(request: Request, stage: Stage) -> Coupling | None:
    if request.slider is None:
        return None
    x = np.array([request.slider.start_on(request.beam)])
    slope = abs(stage.drive_shapes(x, 1))[:2]
    speed = 0.5 * request.beam.thickness * request.omega * float(np.hypot(*slope[:, 0]))
    return coupling_of(request.slider, request.beam, request.frequency_hz, speed)


def margins_of(request: Request, stage: Stage) -> Margins:
    """How far the run can be believed, from the steady part of its motion."""
    from verify.validity import axial_inertia_size, discretisation, model_form

    x = np.linspace(0.0, request.beam.length, 400)
    steady, slopes = stage.drive_shapes(x, 0)[:2], stage.drive_shapes(x, 1)[:2]
    amplitude = float(np.hypot(*steady).max())
    pressing = request.slider.normal_force / request.slider.mass if request.slider else GRAVITY
    square = 0.5 * float((slopes**2).sum(axis=0).mean())
    return Margins(
        lift_off=request.omega**2 * amplitude / pressing,
        nonlinearity=axial_inertia_size(request.beam, request.frequency_hz, square),
        model_form=model_form(request.beam, request.frequency_hz),
        discretisation=discretisation(request.beam, request.model, request.count, request.frequency_hz),
    )


def _begin(request: Request, stage: Stage) -> Array:
    """The free modes at the start, (2, n)."""
    n = len(stage.modal.squares)
    if request.before is None:
        return stage.start(np.zeros(n), np.zeros(n)) if stage.forced else np.zeros((2, n))
    if len(request.before.q) != n:
        raise InputError(f"continue_from has {len(request.before.q)} modes and this run {n}: give both the same model")
    return stage.start(request.before.q, request.before.rates)


def _notes(request: Request, basis: TimeBasis | None) -> tuple[str, ...]:
    notes = [f"modes: {basis.method}" if basis else f"steady field of the {request.model} model, no modes"]
    notes += _damping_notes(request, basis)
    if len(request.pieces) > 1:
        grown = sum(piece.steps.n * piece.steps.dt for piece in request.pieces[:-1])
        notes.append(f"forces grow over {grown:.6g} s")
    return tuple(notes)


def _damping_notes(request: Request, basis: TimeBasis | None) -> list[str]:
    """Which damping acts, and what it stands for: a ratio and a loss factor twice it agree at a resonance only."""
    ratio, eta = f"a ratio {request.damping:g} of every mode", request.beam.loss_factor
    if request.start == "steady" and request.model == "analytic" and request.damping_replaced:
        return [f"damping: a loss factor {2.0 * request.damping:g} in the steady field in place of {ratio}"]
    notes = []
    if request.start == "steady" and eta and not request.damping_replaced:
        notes.append(f"damping: the loss factor {eta:g} in the steady field")
    if request.damping and (basis or not notes):
        notes.append(f"damping: {ratio}" + (f" in place of the loss factor {eta:g}" if eta else ""))
    elif eta and request.damping_replaced:
        notes.append(f"damping: none, in place of the loss factor {eta:g}")
    return notes


def _closed_form(request: Request, stages: list[Stage], basis: TimeBasis | None, began: float) -> Motion:
    """Nothing nonlinear: every sample is evaluated where it stands."""
    ready = perf_counter()
    z = start = _begin(request, stages[0])
    parts = [stages[0].deflection(z, np.zeros(1), request.points)]
    state = stages[0].state(z, 0.0)
    for stage in stages:
        z = stage.start(*state) if stage.forced else z
        blocks = np.array_split(stage.sample_times, max(stage.n_steps // stage.every // CLOSED_FORM_ROWS, 1))
        parts += [stage.deflection(z, block, request.points) for block in blocks]
        state = stage.state(free_at(stage, z, stage.duration), stage.duration)
    times = _times(request, stages)
    wall = perf_counter() - ready
    return Motion(
        model=request.model, count=request.count, times=times, points=request.points,
        deflection=np.concatenate(parts), slider=None, start=None, travelled=np.empty(0), speed=np.empty(0),
        friction=np.empty(0),
        surface_speed=np.empty(0), events=np.empty((0, 3)), coupling=None, margins=margins_of(request, stages[-1]),
        ledger=_closed_ledger(request, stages, basis, start), notes=_notes(request, basis),
        statistics=Statistics(steps=0, evaluations=len(times), step_s=0.0, set_up_s=ready - began, wall_s=wall,
                              stopped="end"),
        end=EndState(time=float(times[-1]), q=state[0], rates=state[1]),
    )  # fmt: skip


def _times(request: Request, stages: list[Stage]) -> Array:
    """When the start and the samples of all stages stand, (n,), seconds."""
    return np.concatenate([[request.origin], *(stage.origin + stage.sample_times for stage in stages)])


def _closed_ledger(request: Request, stages: list[Stage], basis: TimeBasis | None, z: Array) -> Ledger | None:
    """The books of a beam alone from rest; a steady beam has no energy to gain, a continued run is not booked."""
    if basis is None or not request.accounts or request.before is not None:
        return None
    from verify.energy import driven_ledger

    return driven_ledger(stages, basis, z)


def _with_slider(
    request: Request, stages: list[Stage], basis: TimeBasis | None, coupling: Coupling, began: float,
    progress: Callable[[float], None],
) -> Motion:  # fmt: skip
    slider = request.slider
    assert slider is not None
    start, speed, stuck = _put_on(request, slider)
    sliding = Sliding.fresh(start, sum(stage.n_steps // stage.every for stage in stages), request.points,
                            law_entries(slider, request.beam), coupling.two_way,
                            request.accounts and request.start == "rest")  # fmt: skip
    sliding.motion[1:] = speed, stuck
    z = _begin(request, stages[0])
    energy = _beam_energy(basis, *stages[0].state(z, 0.0)) if basis else (0.0, 0.0)
    ready = perf_counter()
    stopped, q, rates = run_stages(stages, z, sliding, request.forces, lambda n: progress(n / request.n_steps))
    wall = perf_counter() - ready - sliding.set_up_s
    n = sliding.n_kept
    first = sliding.first
    ledger = _ledger(basis, sliding, energy, q, rates, coupling) if sliding.accounts else None
    times = _times(request, stages)[: n + 1]
    columns = np.concatenate([first[None, :4], sliding.kept[:n]])
    return Motion(
        model=request.model, count=request.count, times=times, points=request.points,
        deflection=np.concatenate([sliding.first_deflection[None], sliding.deflections[:n]]), slider=slider,
        start=start, travelled=columns[:, 0], speed=columns[:, 1], friction=slider.mass * columns[:, 2],
        surface_speed=columns[:, 3],
        events=sliding.events[: sliding.n_events], coupling=coupling, margins=margins_of(request, stages[-1]),
        ledger=ledger, notes=_notes(request, basis),
        statistics=Statistics(steps=sliding.steps, evaluations=2 * sliding.steps + 1, step_s=stages[-1].dt,
                              set_up_s=ready - began + sliding.set_up_s, wall_s=wall, stopped=stopped),
        end=EndState(time=_reached(stages, sliding.steps), q=q, rates=rates,
                     position=start + float(sliding.motion[0]), speed=float(sliding.motion[1]),
                     stuck=bool(sliding.motion[2] > 0.0)),
    )  # fmt: skip


def _put_on(request: Request, slider: Slider) -> tuple[float, float, float]:
    """(position, speed, whether it sticks) at the start: where the run before left it, else as the slider says."""
    before = request.before
    if before is None or before.position is None:
        return slider.start_on(request.beam), slider.speed, 0.0
    if not 0.0 <= before.position <= request.beam.length:
        raise InputError(
            f"continue_from ended with the slider at {before.position!r} m, off the beam: continue one that stays on"
        )
    return before.position, before.speed, float(before.stuck and slider.law == "coulomb")


def _reached(stages: list[Stage], steps: int) -> float:
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
    basis: TimeBasis | None, sliding: Sliding, before: tuple[float, float], q: Array, rates: Array, coupling: Coupling
) -> Ledger | None:
    if basis is None:
        return None
    on_beam, on_slider, driven, damped, rubbed = (float(v) for v in sliding.ledger)
    kinetic, elastic = _beam_energy(basis, q, rates)
    gained = kinetic + elastic - sum(before)
    charged = on_beam if coupling.two_way else 0.0
    return Ledger(kinetic=kinetic, elastic=elastic, slider=on_slider, work_in=driven, damped=damped, rubbed=rubbed,
                  contact_on_beam=on_beam, residual=driven + charged - damped - gained)  # fmt: skip
