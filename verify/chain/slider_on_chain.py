"""Sliders and feet on the nonlinear chain: the contact of `dynamics`, one-way or acting on the chain.

The joints define the paper's C2 contact line over the material coordinate; the links shorten the chain, and the surface
moves along with every point of them. Steps, margins, coupling and result are those of a run on the linear chain.
"""

from collections.abc import Callable, Sequence
from dataclasses import replace as changed
from time import perf_counter, thread_time
from types import SimpleNamespace
from typing import Any

import numpy as np
from msgspec.structs import replace

from verify.arrays import Array, ComplexArray
from verify.chain.kinematics import at_rest, energies
from verify.chain.motion import ElasticMotion, elastic_step_limit, from_rest, highest_frequency, step_limit
from verify.chain.statics import solve_static
from verify.chain.system import ChainState, ChainSystem, LinkLoad, axial_stiffness, build_system, straight_chain
from verify.dynamics import layout as lay
from verify.dynamics.initial_state import PASSES, set_down
from verify.dynamics.linear_system import Stage, basis_of, stages_from_rest
from verify.dynamics.request import request_of
from verify.dynamics.result import END, INTERRUPTED, Motion
from verify.dynamics.slider_run import Progress, SliderRun
from verify.dynamics.stepping import Contacts, Recorded, Run
from verify.errors import InputError
from verify.linear.positions import Forces, Numbers
from verify.options import LINKS, Links
from verify.problem.beam import Beam
from verify.problem.slider import Slider
from verify.segments.reading import contact_line
from verify.validation import check_number, check_whole, check_word

RADIANS = 0.5
"""Phase of the highest mode in a step of the two-way march."""
CHUNK, MARCHED = 20_000, 200
"""Steps between two checks for an interrupt, one-way and two-way."""


def slide_on_chain(
    beam: Beam,
    forces: Forces,
    frequency_hz: float,
    duration: float,
    *,
    slider: Slider | Sequence[Slider],
    count: int,
    links: Links = "rigid",
    joint_dashpot: float = 0.0,
    prescribed_speed: float | Sequence[float | None] | None = None,
    fixed_position: bool | Sequence[bool] = False,
    at: Numbers = (),
    samples: int = 201,
    step: float | None = None,
    steps_per_period: int | None = None,
    tolerance: float = 1e-9,
    progress: Callable[[float], None] = lambda part: None,
) -> Motion:
    """Sliders, with or without feet, on a chain of `count` links from rest under forces that act at once.

    Arguments are those of `simulate`, and `links`, rigid or stretching by the beam's own EA / l; `joint_dashpot`,
    N m s, of every joint with a spring. One-way the chain moves by adaptive steps of `tolerance`; two-way by steps that
    resolve its highest mode, from its equilibrium under feet. `coupling` and `margins` are those of the linear chain;
    energies of stretching links are not in the balance.

    Raises InputError as `simulate` does; for a hard contact, the straight edges of links, two-way normal = "held" and
    stretching links; for a motion of the chain that is not resolved.
    """
    began = perf_counter()
    check_word("links", links, LINKS)
    check_whole("count", count, 2)
    check_number("tolerance", tolerance, "relative", above=0, below=0.1)
    request = request_of(
        beam,
        forces,
        frequency_hz,
        duration,
        model="segment",
        count=count,
        modes=None,
        start="rest",
        soft_start_periods=0.0,
        envelope=(),
        modal_damping=None,
        slider=slider,
        prescribed_speed=prescribed_speed,
        fixed_position=fixed_position,
        at=at,
        samples=samples,
        step=step,
        steps_per_period=steps_per_period,
        continue_from=None,
    )
    for one in request.sliders:
        if one.contact is not None and one.contact.hard:
            raise InputError("slider.contact is hard: a nonlinear chain carries feet on springs, give contact.stiffness")
        if one.line != "spline":
            raise InputError(f"slider.line = {one.line!r}: contact with a nonlinear chain is along its spline")
        if request.two_way and one.contact is None and one.normal == "held":
            raise InputError("slider.normal = 'held': a nonlinear chain responds to friction alone, give 'massless'")
    if not request.sliders:
        raise InputError("slider is missing: give one, or use verify.chain.motion")
    system = build_system(
        beam, count, request.forces, frequency_hz, load="reciprocal", joint_dashpot=joint_dashpot
    )
    basis = basis_of(beam, "segment", count, None, "spline")
    stages = stages_from_rest(basis, request.forces, request.omega, 0.0, request.pieces, 0.0)
    notes = (f"the nonlinear chain of {links} links from rest; coupling and margins are those of the linear one",)
    run = ChainRun.of(request, basis, stages, notes, sequence=not isinstance(slider, Slider))
    run = replace(run, system=system, links=links, tolerance=tolerance)
    motion = run.converged(progress)
    statistics = replace(motion.statistics, set_up_s=perf_counter() - began - motion.statistics.wall_s)
    return replace(motion, model="chain", statistics=statistics, end=replace(motion.end, model="chain"))


class ChainRun(SliderRun, frozen=True, eq=False, kw_only=True):
    """Sliders on the nonlinear chain before the first step; basis and stage are those of the linear chain."""

    system: ChainSystem | None = None
    links: Links = "rigid"
    tolerance: float = 1e-9

    def _initial(self, contacts: Contacts, loaded: bool = True) -> ComplexArray:
        z = super()._initial(contacts, loaded)
        if loaded and contacts.presses:
            still = self._static(contacts)
            ground: Any = SimpleNamespace(
                edges=self.stages[0].edges,
                factors=lambda z, t: self._rises(still)[None],
                rates_at_start=lambda z: np.zeros(len(still.angles)),
                columns=self._line(),
            )
            set_down(contacts, ground, z)
        return z

    def _line(self) -> Any:
        """The contact line by unit steps across at the links, (x, derivative) -> (N, len(x))."""
        assert self.system is not None
        n = self.system.n_links
        return contact_line(straight_chain(self.system), np.triu(np.ones((n, n + 1)), 1))

    def _rises(self, state: ChainState) -> Array:
        """Components of the links across, (N,), m."""
        assert self.system is not None
        return np.asarray(self.system.lengths * np.sin(np.cumsum(state.angles)))

    def _static(self, contacts: Contacts) -> ChainState:
        """Equilibrium of the chain under the load of feet, shared equally among their points."""
        system, p, line = self.system, contacts.points, self._line()
        assert system is not None
        state = at_rest(system)
        if not contacts.presses:
            return state
        foot, x = contacts.indices[:, lay.OF_FOOT], contacts.start + p[:, lay.OFFSET]
        push = p[:, lay.STIFF] * np.maximum(contacts.contacts[:, lay.DEPTH], 0.0)
        side = p[:, lay.FACE] * p[:, lay.IMAGE]
        group = foot[:, None] * 4 + (side[:, None] > 0.0)
        for number in np.unique(group):
            own = group[:, 0] == number
            push[own] = push[own].mean()
        push *= p[:, lay.WEIGHT] * side
        for _ in range(PASSES):
            rises, at = self._rises(state), x
            for _ in range(PASSES):
                at = x + p[:, lay.LEVER] * (rises @ line(at, 1))
            lean = p[:, lay.LEVER] * (rises @ line(at, 1))
            total = -(line(at) + lean * line(x, 1)) @ push
            across = total - np.append(total[1:], 0.0)
            loads = tuple(
                LinkLoad(link=j + 1, at=float(system.lengths[j]), force=(0.0, float(across[j])))
                for j in range(system.n_links)
            )
            state = solve_static(changed(system, loads=(*system.loads, *loads)), state)
        return state

    def _marched(
        self, stages: list[Stage], z: ComplexArray, contacts: Contacts, progress: Progress
    ) -> tuple[Recorded, Array, tuple[float, float, float], bool]:
        from verify.chain import elastic_links, rigid_links
        from verify.chain.runge_kutta import DORMAND_PRINCE
        from verify.chain.slider_kernels import STALE, advance

        (stage,), system, began = stages, self.system, thread_time()
        assert system is not None
        steps, count, rigid, two_way = stage.steps, system.n_links, self.links == "rigid", contacts.two_way
        axial, n = axial_stiffness(self.request.beam, count), count if rigid else 2 * count + 2
        still, spare = self._static(contacts), np.zeros((count if two_way else 0, 7))
        model: Any = rigid_links if rigid else elastic_links
        data = list(rigid_links.flatten(system) if rigid else elastic_links.flatten(system, axial, False))
        spare[:, 0], spare[:, 6] = 0.5 * system.lengths[: len(spare)] if rigid else 1.0, np.arange(len(spare))
        data[1] = np.concatenate([data[1], spare])
        if two_way:
            states = np.zeros((3, 2 * n + (2 if rigid else 0)))
            if rigid:
                states[0] = rigid_links.begin(system, still, data[2])
                limit = min(RADIANS / max(highest_frequency(system)[0], 1e-12), 0.5 * step_limit(system))
            else:
                limit = elastic_step_limit(system, axial) / 4.0
            substep = 0.5 * steps.dt / np.ceil(0.5 * steps.dt / limit)
        else:
            times, substep = np.linspace(0.0, steps.duration, 2 * steps.n + 1), steps.dt
            moved = from_rest(system, self.links, axial, times, tolerance=self.tolerance, progress=progress)
            if isinstance(moved, ElasticMotion):
                states = np.concatenate([part.reshape(len(times), n) for part in (moved.displacements, moved.velocities)], 1)
            else:
                quadratures = np.stack([moved.dissipated, moved.work_in], axis=1)
                states = np.concatenate([moved.directions(), np.cumsum(moved.rates, axis=1), quadratures], axis=1)
        points, columns, width = len(contacts.points), 2 * count, states.shape[1]
        clock, counts, tableau = np.array([0.0, substep]), np.zeros(4, dtype=np.int64), DORMAND_PRINCE
        chain = (
            *data, tableau.a, tableau.c, n, substep, np.zeros(0), np.zeros((len(tableau.c) + 3, width)),
            clock, np.array([0.0, 0.0, 0.0, np.pi, 0.0, 0.0, 0.0]), counts, np.zeros(width), np.zeros(2), states,
            np.zeros((2, width)),
        )  # fmt: skip
        line, run = self._line(), Run(stages, contacts, self.request.points, False)
        powers = line.c[::-1] * system.lengths[:, None] ** np.arange(4)[:, None, None]
        places = np.zeros((len(self.request.points), columns))
        places[:, :count] = line(self.request.points).T if len(places) else 0.0
        codes = np.zeros(lay.CODES, dtype=np.int64)
        codes[[lay.LAW, lay.TWO_WAY, lay.PRESSES, lay.FOLLOWING]] = (
            contacts.law, two_way, contacts.presses, contacts.following,
        )  # fmt: skip
        contact = (
            codes, np.ascontiguousarray(np.moveaxis(powers, 0, 1)), system.nodes - contacts.start, contacts.sliders,
            contacts.feet, contacts.points, contacts.contacts, contacts.indices, run.feet_of,
            np.zeros((4, 2, columns)), np.zeros((count, 2, 4)), np.zeros(count, dtype=np.int64),
            np.zeros((4, points, columns)), np.zeros(columns), run.couplings, run.spans, run.block,
            contacts.sliders.copy(), contacts.feet.copy(), contacts.contacts.copy(), np.zeros((points, 2)),
            np.array([STALE + 1]), places, run.samples, run.heights, run.pressures, run.deflections, run.events,
            run.tally, run.sums, run.before, run.balance,
        )  # fmt: skip
        run.sample_first()
        deflection, first = (places[:, :count] @ self._rises(still))[None], states[0].copy()
        unit = max(one.normal_force for one in self.request.sliders)
        limits = stage.edges[[0, -1]] - contacts.start
        run.set_up_s, began = thread_time() - began, thread_time()
        reason, stopped, chunk = lay.DONE, END, MARCHED if two_way else CHUNK
        try:
            while reason == lay.DONE and run.tally[lay.STEP] < steps.n:
                n_steps = min(chunk, steps.n - int(run.tally[lay.STEP]))
                reason = advance(n_steps, steps.every, steps.dt, contacts.gravity, unit, limits, *chain, *contact)
                progress(float(run.tally[lay.STEP]) / steps.n)
        except KeyboardInterrupt:
            stopped = INTERRUPTED
        run.n_steps, run.loop_s = int(run.tally[lay.STEP]), thread_time() - began
        if reason == lay.NOT_FINITE:
            stopped = "diverged"
        elif reason == lay.OFF_PIECES:
            x = contacts.start + run.positions()
            stopped = stage.beyond(float(x.min()), float(x.max()))
        recorded, gains = run.recorded(z, steps.dt, stopped), (0.0, 0.0, 0.0)
        if rigid:
            ends = np.array([first, states[0 if two_way else 2 * run.n_steps]])
            angles, rates = (np.diff(part, prepend=0.0) for part in (ends[:, :n], ends[:, n : 2 * n]))
            (k0, k1), (e0, e1), _ = energies(system, np.zeros(2), angles, rates)
            gains = float(k1 - k0), float(e1 - e0), float(k0 + e0)
            run.balance[lay.LOST] += ends[1, 2 * n]
            run.balance[lay.DRIVEN] += ends[1, 2 * n + 1]
        return recorded, deflection, gains, rigid
