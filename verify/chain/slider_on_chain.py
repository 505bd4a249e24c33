"""Sliders and feet on the nonlinear chain with the contact of `dynamics`, coupled one-way or two-way.

The joints define the paper's C2 contact line over the material coordinate; the motion of the surface includes the
shortening of the chain. Steps, margins, coupling and result are those of a run on the linear chain.
"""

from collections.abc import Callable
from dataclasses import replace as changed
from time import perf_counter, thread_time
from types import SimpleNamespace
from typing import TYPE_CHECKING, Any

import numpy as np
from msgspec.structs import replace

from verify.arrays import Array, ComplexArray
from verify.chain.kinematics import at_rest, energies
from verify.chain.motion import from_rest, highest_frequency, step_limit
from verify.chain.statics import solve_static
from verify.chain.system import ChainState, LinkLoad, build_system, straight_chain
from verify.dynamics.arguments import Excitation, Keep, Sliders, Step
from verify.dynamics.initial_state import PASSES, SETTLED, compliance_of, equilibrium, set_down
from verify.dynamics.linear_system import Stage, Steps, basis_of
from verify.dynamics.request import KEEP, Request, request_of
from verify.dynamics.result import Motion
from verify.dynamics.simulate import stages_from_rest
from verify.dynamics.slider_run import Progress, SliderRun
from verify.dynamics.state import DONE, NOT_FINITE, OFF_PIECES, Surface
from verify.dynamics.stepping import Assembly, Run, response_of
from verify.errors import InputError, shown
from verify.problem.beam import Beam
from verify.segments.reading import contact_line
from verify.settings import Links, Load
from verify.validation import check_integer, check_number

if TYPE_CHECKING:
    from verify.chain.slider_kernels import Chain

RADIANS = 0.5  # phase of the highest mode per step of the two-way march, rad
CHUNK, MARCHED = 20_000, 200  # steps between two interrupts, one-way and two-way


def slide_on_chain(
    beam: Beam,
    excitation: Excitation,
    duration: float,
    *,
    slider: Sliders,
    count: int,
    links: Links = "rigid",
    load: Load = "reciprocal",
    joint_dashpot: float = 0.0,
    step: Step | float | None = None,
    keep: Keep = KEEP,
    tolerance: float = 1e-9,
    progress: Callable[[float], None] = lambda part: None,
) -> Motion:
    """Sliders, with or without feet, on a chain of `count` links from rest under suddenly applied forces.

    Arguments are those of `simulate`, and `links`, rigid or stretching by the beam's own EA / l; `load`, the joints
    that take a force; `joint_dashpot`, N m s, of every joint with a spring. One-way the chain moves by adaptive steps
    of `tolerance`; two-way by steps that resolve its highest mode, from its equilibrium under feet. `coupling` and
    `margins` are those of the linear chain; energies of stretching links are not in the balance.

    Raises InputError as `simulate` does; for forces that grow and circuits; for hard contact, a raw contact line and an
    unresolved motion of the chain; with two-way coupling for normal = "bilateral", stretching links, and a preload that
    depends on deflection.
    """
    began = perf_counter()
    check_integer("count", count, 2)
    check_number("tolerance", tolerance, "relative", above=0, below=0.1)
    request = request_of(beam, excitation, duration, count=count, slider=slider, start="rest", step=step, keep=keep)
    _check(excitation, request, links)
    system = build_system(
        beam, count, request.forces, request.frequency_hz, load=load, joint_dashpot=joint_dashpot, links=links
    )
    basis = basis_of(beam, "segment", count, None, "spline")
    stages = stages_from_rest(request, basis, 0.0)
    notes = (f"nonlinear chain of {links} links from rest; coupling and margins are those of the linear chain",)
    run = ChainRun.of(request, basis, stages, notes)
    up = np.triu(np.ones((count, count + 1)), 1)  # a unit step of one link displaces all joints after it
    line = contact_line(straight_chain(system), up)
    motion = replace(run, system=system, line=line, tolerance=tolerance).converged(progress)
    statistics = replace(motion.statistics, set_up_s=perf_counter() - began - motion.statistics.wall_s)
    return replace(motion, model="chain", statistics=statistics, end=replace(motion.end, model="chain"))


def _check(excitation: Excitation, request: Request, links: Links) -> None:
    """Raise InputError for an excitation and sliders that the nonlinear chain does not have."""
    for name in ("soft_start_periods", "envelope", "circuits"):
        if value := getattr(excitation, name):
            raise InputError(f"{name} = {shown(value)}: a nonlinear chain starts under sudden forces, leave it out")
    if not request.sliders:
        raise InputError("slider is missing: give one, or `verify.chain.motion.from_rest` for a chain alone")
    for one in request.sliders:
        if one.contact is not None and one.contact.hard:
            raise InputError("slider.contact is hard: on a nonlinear chain feet have springs, give contact.stiffness")
        if one.line != "spline":
            raise InputError(f"slider.line = {one.line!r}: contact with a nonlinear chain is along its spline")
        if request.two_way and one.contact is None and one.normal == "bilateral":
            raise InputError("slider.normal = 'bilateral': a nonlinear chain takes friction alone, give 'massless'")
        if request.two_way and links == "stretching":
            raise InputError("slider.coupling = 'two-way': stretching links move one-way, give links = 'rigid'")
        if request.two_way and (one.preload_stiffness or any(foot.mirrored for foot in one.feet)):
            raise InputError(
                "slider.preload depends on the deflection, by preload_stiffness or a mirrored foot: the equilibrium of "
                "a nonlinear chain is under constant loads, give coupling = 'one-way'"
            )


class ChainRun(SliderRun, frozen=True, eq=False, kw_only=True):
    """Sliders on the nonlinear chain before the first step; basis and stage are those of the linear chain."""

    system: Any = None  # ChainSystem
    line: Any = None  # contact line per unit transverse step of each link, (x, derivative) -> (N, len(x))
    tolerance: float = 1e-9

    def _initial(self) -> tuple[Assembly, ComplexArray]:
        assembly, z = super()._initial()
        if assembly.kind.normal_two_way:
            rises = self._rises(self._rest(assembly))
            ground: Any = SimpleNamespace(
                edges=self.stages[0].edges,
                columns=self.line,
                factors=lambda z, t: rises[None],
                rates_at_start=lambda z: 0.0 * rises,
            )
            set_down(assembly, ground, z)
        return assembly, z

    def _rest(self, assembly: Assembly) -> ChainState:
        """Equilibrium of the chain with the sliders."""
        state, p = at_rest(self.system), assembly.points
        if not assembly.kind.normal_two_way:
            return state

        def surface(normal: Array, friction: Array) -> tuple[Array, Array]:
            nonlocal state
            state = self._static(assembly, normal, friction, state)
            rises = self._rises(state)
            at = self._material(rises, assembly.start + p["offset"], p["lever"])
            return rises @ self.line(at), rises @ self.line(at, 1)

        assert self.basis is not None
        equilibrium(assembly, surface, compliance_of(self.basis, assembly))
        return state

    def _material(self, rises: Array, x: Array, lever: Array) -> Array:
        """Material points under the positions x, m."""
        return np.asarray(x + lever * (rises @ self.line(x, 1)))

    def _rises(self, state: ChainState) -> Array:
        """Transverse steps of the links, (N,), m."""
        return np.asarray(self.system.lengths * np.sin(np.cumsum(state.angles)))

    def _static(self, assembly: Assembly, normal: Array, friction: Array, state: ChainState) -> ChainState:
        """Equilibrium of the chain under contact forces at its points, near a state.

        Dead loads at the far joints have the virtual power of the forces, as in `slider_kernels.load_joints`.
        """
        system, p = self.system, assembly.points
        x, lever = assembly.start + p["offset"], p["lever"]
        across = p["weight"] * p["face"] * p["image"] * normal
        along = p["weight"] * friction
        for _ in range(PASSES):
            rises = self._rises(state)
            at = self._material(rises, x, lever)
            slope, flat, tilted = rises @ self.line(at, 1), self.line(at), self.line(at, 1)
            risen = flat + lever * slope * self.line(x, 1)
            dragged = (slope * flat - lever * tilted) / np.hypot(1.0, slope)
            before = np.clip((x - system.nodes[:-1, None]) / system.lengths[:, None], 0.0, 1.0)
            sums = before @ along, risen @ across + dragged @ along
            steps = np.diff(sums, append=0.0, axis=1).T
            loads = [
                LinkLoad(link=j + 1, at=float(system.lengths[j]), force=(float(fx), float(fy)))
                for j, (fx, fy) in enumerate(steps)
            ]
            last, state = rises, solve_static(changed(system, loads=(*system.loads, *loads)), state)
            if abs(self._rises(state) - last).max() <= SETTLED * abs(last).max():
                break
        return state

    def _states(self, steps: Steps, assembly: Assembly, numbers: Array, progress: Progress) -> tuple[Array, float]:
        """(states of the chain at half steps, with two-way coupling of the first step alone; step of the march, s)."""
        from verify.chain.rigid_links import begin

        system = self.system
        if assembly.kind.two_way:
            states = np.zeros((3, 2 * system.n_links + 2))
            states[0] = begin(system, self._rest(assembly), numbers)
            limit = min(RADIANS / max(highest_frequency(system)[0], 1e-12), 0.5 * step_limit(system))
            return states, float(0.5 * steps.dt / np.ceil(0.5 * steps.dt / limit))
        times = np.linspace(0.0, steps.duration, 2 * steps.n + 1)
        return from_rest(system, times, tolerance=self.tolerance, progress=progress).states, steps.dt

    def _chain(self, stage: Stage, assembly: Assembly, progress: Progress) -> "Chain":
        """The chain before the first step, in the arrays of its kernel."""
        from verify.chain import elastic_links, rigid_links
        from verify.chain.runge_kutta import DORMAND_PRINCE, State
        from verify.chain.slider_kernels import STALE, Chain

        system = self.system
        model = (rigid_links if system.rigid else elastic_links).flatten(system)
        if assembly.kind.two_way:  # dead loads at the far joints
            spare = np.zeros((system.n_links, 7))
            spare[:, 0], spare[:, 6] = 0.5 * system.lengths, np.arange(system.n_links)
            model = model._replace(loads=np.concatenate([model.loads, spare]))
        states, substep = self._states(stage.steps, assembly, model.numbers, progress)
        columns, width, stages = 2 * system.n_links, states.shape[1], len(DORMAND_PRINCE.c)
        powers = self.line.c[::-1] * system.lengths[:, None] ** np.arange(4)[:, None, None]
        control = np.array([0.0, 0.0, 0.0, np.pi, 0.0, 0.0, 0.0])
        return Chain(
            surface=Surface(
                table=np.ascontiguousarray(np.moveaxis(powers, 0, 1)),
                edges=system.nodes - assembly.start,
                factors=np.zeros((4, 2, columns)),
                polynomials=np.zeros((system.n_links, 2, 4)),
                stamps=np.zeros(system.n_links, dtype=np.int64),
            ),
            limits=stage.edges[[0, -1]] - assembly.start,
            load=float(max(one.normal_force for one in self.request.sliders)),
            model=model,
            tableau=DORMAND_PRINCE._replace(weights=np.zeros(0)),
            march=State(
                np.zeros(width), np.zeros((stages + 3, width)), np.zeros(2), control, np.zeros(3, dtype=np.int64)
            ),
            n=(width - 2 * system.rigid) // 2,
            substep=substep,
            states=states,
            probe=np.zeros((2, width)),
            ends=np.zeros(2),
            forces=np.zeros((len(assembly.points), 2)),
            marches=np.array([STALE + 1]),
            before=assembly.copy().bodies,
        )

    def _marched(self, stages: list[Stage], z: ComplexArray, assembly: Assembly, progress: Progress) -> Run:
        from verify.chain.slider_kernels import advance

        (stage,), system, began, two_way = stages, self.system, thread_time(), assembly.kind.two_way
        steps, chain = stage.steps, self._chain(stage, assembly, progress)
        first, n, count = chain.states[0].copy(), chain.n, system.n_links
        run = Run(assembly, steps.n // steps.every, len(self.request.points))
        places = np.zeros((len(self.request.points), 2 * count))
        places[:, :count] = self.line(self.request.points).T
        run.journal, response = run.journal._replace(places=places), response_of(assembly, 2 * count)
        arguments = steps.every, steps.dt, assembly.kind, chain, assembly.bodies, response
        assembly.contacts["depth_before"] = assembly.contacts["depth"]
        advance(0, *arguments, run.journal)
        run.sample_first()
        run.journal.deflections[0] = places[:, :count] @ self._rises(self._rest(assembly))
        run.set_up_s, began = thread_time() - began, thread_time()
        reason, chunk = DONE, MARCHED if two_way else CHUNK
        while reason == DONE and run.step < steps.n:
            reason = advance(min(chunk, steps.n - run.step), *arguments, run.journal)
            progress(run.step / steps.n if two_way else 1.0)
        run.n_steps, run.seconds, run.loop_s = run.step, run.step * steps.dt, thread_time() - began
        if reason == NOT_FINITE:
            run.stopped = "diverged"
        elif reason == OFF_PIECES:
            x = assembly.start + run.positions()
            run.stopped = stage.beyond(float(x.min()), float(x.max()))
        if system.rigid:
            ends = np.array([first, chain.states[0 if two_way else 2 * run.n_steps]])
            angles, rates = (np.diff(part, prepend=0.0) for part in (ends[:, :n], ends[:, n : 2 * n]))
            (k0, k1), (e0, e1), _ = energies(system, np.zeros(2), angles, rates)
            run.gains, run.accounts = (float(k1 - k0), float(e1 - e0), float(k0 + e0)), True
            for name, gained in zip(("lost", "driven"), ends[1, 2 * n :], strict=True):
                run.journal.balance[name] += gained
        return run.recorded(z, stage)
