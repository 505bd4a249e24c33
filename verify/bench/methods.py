"""Benchmark sets: quantities of interest with methods and references, for the paper's beam or that of a scene."""

import dataclasses
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from math import ceil, sqrt
from typing import Any

import numpy as np
from msgspec.structs import replace
from scipy.interpolate import CubicSpline

from verify.analytic_modes import ExactModel
from verify.arrays import Array
from verify.bench.work_precision import Method, Question
from verify.chain.departure import DrivenChain, linear_deflection
from verify.chain.kinematics import at_rest
from verify.chain.motion import simulate as simulate_chain
from verify.chain.motion import step_limit
from verify.chain.system import build_system
from verify.dynamics.arguments import Excitation, Keep
from verify.dynamics.simulate import simulate
from verify.elements.stock import stock_frequency_hz
from verify.engines.base import ENGINES, chain_of, missing
from verify.errors import InputError
from verify.linear.registry import MODELS
from verify.problem.beam import Beam, PointForce
from verify.problem.slider import Slider
from verify.validation import check_choice

SIZES = (24, 49, 98, 196, 392)
PARTS = {"segment": "segments", "fem": "elements"}
LINKS, SLIDER_LINKS = 49, (49, 399)
SOFT_START = 2.0  # periods over which forces grow: a step load has no integer order of convergence
BEAM = Beam(length=0.5, width=0.02, thickness=0.001, youngs_modulus=70e9, density=2700.0)
FORCES = (PointForce(position=0.0116), PointForce(position=0.4884, phase_deg=90.0))
ENDS = Keep(samples=2)
SLIDER = Slider(mass=1.0193679918450561e-3, mu=0.2, slope=1e4)


@dataclass(frozen=True)
class Problem:
    """A driven beam with a slider, a mode number and a duration."""

    beam: Beam = BEAM
    forces: tuple[PointForce, ...] = FORCES
    frequency_hz: float = 4276.0
    slider: Slider = SLIDER
    duration: float = 1e-3
    mode: int = 22
    sizes: Sequence[int] = SIZES

    @property
    def name(self) -> str:
        """Conditions."""
        return f"{self.frequency_hz:g} Hz, {1e3 * self.duration:g} ms"


def problem_of(scene: Any) -> Problem:
    """Beam, drive and slider of a scene; default slider: the paper's; no forces without a drive."""
    if scene.drive is None:
        return Problem(beam=scene.beam, forces=())
    duration = scene.motion.duration if scene.motion else 4.0 / scene.drive.frequency_hz
    return Problem(scene.beam, tuple(scene.forces), scene.drive.frequency_hz, scene.slider or SLIDER, duration)


def rms(values: Any, exact: Any) -> float:
    """Rms of a difference over the rms of the exact values."""
    return float(np.sqrt(np.mean(abs(values - exact) ** 2) / np.mean(abs(exact) ** 2)))


def frequency_by(problem: Problem, model: str, **settings: str) -> Callable[[int], float]:
    """Number of parts -> frequency of the problem's mode, Hz."""
    build, mode = MODELS[model].build, problem.mode
    return lambda n: float(build(problem.beam, n, **settings).modes(mode).frequencies_hz[mode - 1])


def modes(problem: Problem) -> Iterator[Question]:
    """Natural frequency by number of parts."""
    beam, mode = problem.beam, problem.mode
    exact = ExactModel(beam).frequency_hz(mode)
    segments, elements = frequency_by(problem, "segment"), frequency_by(problem, "fem")
    methods = [
        Method("segments", segments, problem.sizes, model="segment"),
        Method("elements", elements, problem.sizes, model="fem"),
        Method("mean of both", lambda n: 0.5 * (segments(n) + elements(n)), problem.sizes, model="mean"),
        Method("stock scikit-fem", lambda n: stock_frequency_hz(beam, mode, n), problem.sizes),
        Method("exact", lambda _: ExactModel(beam).frequency_hz(mode), (0,), "", "analytic"),
    ]
    walls = ("half", "welded", "third-order") if "clamped" in beam.supports else ()
    by_wall = ((wall, frequency_by(problem, "segment", wall=wall)) for wall in walls)
    methods += [Method(f"segments, {wall} wall", solver, problem.sizes) for wall, solver in by_wall]
    title = f"frequency of mode {mode}"
    yield Question("modes", title, "exact frequency", 1e-14, lambda hertz: hertz / exact - 1.0, methods)


def by_model(problem: Problem, solver: Callable[[str], Callable[[int], Any]], exact: str) -> list[Method]:
    """Segments and elements by size (`solver(model)(N)`), and the exact beam with method name `exact`."""
    methods = [Method(word, solver(model), problem.sizes, model=model) for model, word in PARTS.items()]
    return [*methods, Method(exact, solver("analytic"), (0,), "", "analytic")]


def field(problem: Problem) -> Iterator[Question]:
    """Steady field by number of parts."""
    x = np.linspace(0.0, problem.beam.length, 8 * max(problem.sizes) + 1)

    def solver(model: str, shift: float = 0.0) -> Callable[[int], Any]:
        hertz = problem.frequency_hz * (1.0 + shift)
        return lambda n: MODELS[model].build(problem.beam, n or None).harmonic(problem.forces, hertz).deflection(x)

    exact = solver("analytic")(0)
    rounding = rms(solver("analytic", 1e-7)(0), exact) * 1e7 * 8 * np.finfo(float).eps
    methods = by_model(problem, solver, "exact")
    title = f"deflection at {problem.frequency_hz:g} Hz, rms over the beam"
    yield Question("field", title, "exact field", rounding, lambda result: rms(result, exact), methods)


def moved(problem: Problem, model: str, count: int | None, **more: Any) -> Any:
    """Motion from rest."""
    excitation = Excitation(problem.forces, problem.frequency_hz, SOFT_START)
    run = simulate(problem.beam, excitation, problem.duration, model=model, count=count, **more)
    if not run.statistics.finished:
        raise InputError(f"the run {run.statistics.stopped}: shorten motion.duration")
    return run


def transient(problem: Problem) -> Iterator[Question]:
    """Deflection of a point in time by number of parts."""
    more: dict[str, Any] = {"keep": Keep(at=0.37 * problem.beam.length)}

    def solver(model: str) -> Callable[[int], Any]:
        return lambda n: moved(problem, model, n or None, **more).deflection[:, 0]

    exact = moved(problem, "analytic", None, modes=800, **more).deflection[:, 0]
    uncertainty = max(rms(solver("analytic")(0), exact), 1e-13)
    methods = by_model(problem, solver, "exact, 400 modes")
    title = f"deflection at 0.37 L, rms over time, {problem.name}"
    yield Question("transient", title, "exact beam, 800 modes", uncertainty, lambda result: rms(result, exact), methods)


def slider(problem: Problem) -> Iterator[Question]:
    """Displacement of the slider by number of parts, with equal time steps."""
    one = replace(problem.slider, coupling="one-way")

    def solver(model: str) -> Callable[[int], float]:
        return lambda n: float(moved(problem, model, n or None, slider=one, keep=ENDS).travelled[-1])

    exact = solver("analytic")(0)
    methods = by_model(problem, solver, "exact, 400 modes")
    title = f"displacement, one-way, {problem.name}"
    yield Question("slider", title, "exact beam at the same time step", 1e-12, lambda d: d / exact - 1.0, methods)


def ride(problem: Problem) -> Iterator[Question]:
    """Displacement of the slider on 49 segments by time step, for both couplings; reference: a small step."""

    def method(coupling: str) -> tuple[Method, float]:
        one = replace(problem.slider, coupling=coupling)

        def run(per_period: int) -> float:
            step = 1.0 / (problem.frequency_hz * per_period)
            return float(moved(problem, "segment", LINKS, slider=one, step=step, keep=ENDS).travelled[-1])

        fine, finer = run(1024), run(2048)
        steps = (16, 32, 64, 128, 256)
        own = Method(coupling, run, steps, "steps / period", error=lambda result: result / finer - 1.0)
        return own, abs(fine / finer - 1.0)

    pairs = [method("one-way"), method("two-way")]
    title = f"displacement, {LINKS} segments, {problem.name}"
    yield Question("ride", title, "2048 steps a period", max(u for _, u in pairs), float, [one for one, _ in pairs])


def chain_solver(problem: Problem) -> tuple[Callable[..., tuple[Array, Array]], float]:
    """(settings -> times and mid-span deflections of the nonlinear chain from rest, step limit of RK4)."""

    def run(samples: int = 200, **how: Any) -> tuple[Array, Array]:
        system = build_system(problem.beam, LINKS, problem.forces, problem.frequency_hz)
        times, middle = np.linspace(0.0, problem.duration, samples + 1)[1:], [0.5 * problem.beam.length]
        return times, simulate_chain(system, at_rest(system), times, **how).deflection(middle, reading="links")[:, 0]

    return run, step_limit(build_system(problem.beam, LINKS))


def chain_methods(problem: Problem) -> tuple[list[Method], Callable[[tuple[Array, Array]], float], float]:
    """(methods RK4 and adaptive, error against adaptive steps at 1e-10, uncertainty: change from 1e-9 to 1e-10)."""
    run, limit = chain_solver(problem)
    times, exact = run(4000, tolerance=1e-10)
    spline = CubicSpline(np.append(0.0, times), np.append(0.0, exact))
    least = ceil(problem.duration / (0.97 * limit))
    steps = [least * 2**k for k in range(5)]
    rk4 = Method("RK4", lambda n: run(step=problem.duration / n), steps, "steps", "segment")
    adaptive = Method("adaptive", lambda size: run(tolerance=size), (1e-3, 1e-4, 1e-5, 1e-6, 1e-7), "tolerance")
    uncertainty = max(rms(run(4000, tolerance=1e-9)[1], exact), 1e-10)
    return [rk4, adaptive], lambda result: rms(result[1], spline(result[0])), uncertainty


def chain(problem: Problem) -> Iterator[Question]:
    """Nonlinear chain by step or tolerance, and the linear chain, exact in time."""
    methods, error, uncertainty = chain_methods(problem)
    times, x = np.linspace(0.0, problem.duration, 201)[1:], 0.5 * problem.beam.length

    def linear(_: int) -> tuple[Array, Array]:
        system = build_system(problem.beam, LINKS, problem.forces, problem.frequency_hz)
        return times, linear_deflection(system, times, x)

    title = f"mid-span deflection, rms over time, {LINKS} links, step load, {problem.name}"
    methods.append(Method("linear chain, exact in time", linear, (0,), ""))
    yield Question("chain", title, "adaptive steps at 1e-10", uncertainty, error, methods)


def engines(problem: Problem) -> Iterator[Question]:
    """Modes, the nonlinear chain and a slider in other engines and with segments."""
    adapters = {name: one.adapter() for name, one in ENGINES.items() if not missing(one)}
    if not adapters:
        raise InputError("engines: none is installed: pip install exudyn mujoco pin, or leave this set out")
    absent = "".join(f"; {why}" for one in ENGINES.values() if (why := missing(one)))
    beam, mode, hertz, end = problem.beam, problem.mode, problem.frequency_hz, problem.duration
    exact = ExactModel(beam).frequency_hz(mode)

    def frequency(adapter: Any) -> Callable[[int], float]:
        return lambda n: float(adapter.frequencies(chain_of(beam, n, (), hertz))[mode - 1])

    ours = Method("segments", frequency_by(problem, "segment"), problem.sizes[:4])
    theirs = [Method(name, frequency(adapter), problem.sizes[:4]) for name, adapter in adapters.items()]
    title = f"frequency of mode {mode}{absent}"
    yield Question("engines-modes", title, "exact frequency", 1e-14, lambda hertz: hertz / exact - 1.0, [ours, *theirs])

    links = chain_of(beam, LINKS, problem.forces, hertz)
    _, limit = chain_solver(problem)

    def motion(adapter: Any) -> Callable[[int], Any]:
        def run(count: int) -> Any:
            result = finished(adapter.run(links, count, end))
            return result.times[1:], links.deflection(result.angles[1:], 0.5 * beam.length)

        return run

    methods, error, uncertainty = chain_methods(problem)
    methods = [dataclasses.replace(one, name=f"segments, {one.name}") for one in methods]
    sizes = [step_counts(name, problem, limit) for name in adapters]
    methods += [Method(*one, "steps") for one in zip(adapters, map(motion, adapters.values()), sizes, strict=True)]
    title = f"mid-span deflection, rms over time, {LINKS} links, step load, {problem.name}{absent}"
    yield Question("engines-chain", title, "adaptive steps at 1e-10", uncertainty, error, methods)
    if problem.slider.law == "tanh" and problem.slider.contact is None:
        for count in SLIDER_LINKS:
            yield engines_slider(problem, adapters, count, absent)


def step_counts(engine: str, problem: Problem, limit: float) -> list[int]:
    """Numbers of steps of an engine: from the longest step that is stable, or has a meaning, down by halves."""
    hertz, implicit = problem.frequency_hz, ENGINES[engine].implicit
    longest = 0.02 / hertz if implicit else min(1.0 / (12.0 * hertz), 0.97 * limit)
    return [ceil(problem.duration / longest) * 2**k for k in range(7 if implicit else 6)]


def finished(run: Any) -> Any:
    """The run of an engine. Raises InputError if it failed."""
    if run.failure:
        raise InputError(f"engines: {run.failure}")
    return run


def engines_slider(problem: Problem, adapters: dict[str, Any], count: int, absent: str) -> Question:
    """Displacement of a one-way slider on `count` links over time, by time step; reference: 2048 steps a period.

    Joints take the forces by the reciprocal rule in all. Where the stability of RK4 demands less than a 400th of a
    period explicit engines use a rule of order 2 and one stage, in steps of 1 / sqrt(2) of that limit.
    """
    from verify.engines.slider import displacement

    beam, hertz, end = problem.beam, problem.frequency_hz, problem.duration
    one = replace(problem.slider, coupling="one-way")
    links = chain_of(beam, count, problem.forces, hertz, load="reciprocal", soft_start_periods=SOFT_START)
    limit = step_limit(build_system(beam, count))
    order, longest, most = (4, limit, 4) if limit * hertz > 1.0 / 400.0 else (2, limit / sqrt(2.0), 1)

    def own(per_period: int, samples: int = 41) -> tuple[Array, Array]:
        more: dict[str, Any] = {"step": 1.0 / (hertz * per_period), "keep": Keep(samples=samples)}
        run = moved(problem, "segment", count, slider=one, **more)
        return run.times, run.travelled

    def method(name: str) -> Method:
        def run(steps: int) -> tuple[Array, Array]:
            return displacement(links, finished(adapters[name].run(links, steps, end, order)), one)

        return Method(name, run, step_counts(name, problem, longest)[: 4 if ENGINES[name].implicit else most], "steps")

    spline = CubicSpline(*own(2048, 2001))

    def error(result: tuple[Array, Array]) -> float:
        return rms(result[1], spline(result[0]))

    methods = [
        Method("segments", own, (16, 32, 64, 128, 256), "steps / period", "segment"),
        Method("segments, modes known", own, (16, 32, 64, 128, 256), "steps / period", again=True),
        *map(method, adapters),
    ]
    linked = DrivenChain(beam=beam, forces=problem.forces, frequency_hz=hertz, count=LINKS)
    _, gap = linked.departure(end, one.initial_position(beam))
    title = f"displacement, one-way, rms over time, {count} links, {problem.name}{absent}"
    return Question(f"engines-slider-{count}", title, "linear chain, 2048 steps a period", gap, error, methods)


_ALL: tuple[Callable[[Problem], Iterator[Question]], ...] = modes, field, transient, slider, ride, chain, engines
SETS = {one.__name__: one for one in _ALL}


def questions(names: Sequence[str], problem: Problem) -> Iterator[Question]:
    """Questions of the named sets (default: all). Raises InputError for an unknown or impossible set."""
    for name in names:
        check_choice("set", name, tuple(SETS))
    for name in names or SETS:
        if name != "modes" and not problem.forces:
            raise InputError(f"{name}: the scene has no [drive] with forces, add it or bench its modes alone")
        yield from SETS[name](problem)
