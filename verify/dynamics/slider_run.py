"""A run of sliders in contact with a beam: initial state, steps, result."""

from collections.abc import Callable
from math import ceil, inf
from time import perf_counter
from typing import Any

import msgspec
import numpy as np
from msgspec.structs import replace

from verify.arrays import Array, ComplexArray
from verify.contact.state import BILATERAL
from verify.dynamics import step_control, validity
from verify.dynamics.contact_assembly import assemble, contact_rate
from verify.dynamics.initial_state import set_down, static_deflection, steady_with_mass
from verify.dynamics.linear_system import Stage
from verify.dynamics.request import Request, check_steps
from verify.dynamics.result import END, ContactState, EnergyBalance, Motion, Statistics
from verify.dynamics.state import SAMPLE
from verify.dynamics.stepping import Assembly, Run, of_all, run_stages
from verify.errors import InputError
from verify.linear.surface import contact_range
from verify.linear.time_basis import TimeBasis

WORKS = (
    *("slope_work", "tangential_work", "normal_work", "contact_loss", "friction_loss", "friction_on_beam"),
    "normal_on_beam",
)
"""Sums of the engine by term of `EnergyBalance`."""
SAMPLES = SAMPLE.names or ()
"""Samples of the engine by field of `Motion`."""
SAMPLED = ("times", "deflection", "voltages", "charges", "height", "pitch", "pressures", *SAMPLES)
FOOT_STATE = ("height", "velocity_z", "pitch", "pitch_rate")
"""Columns of `ContactState.feet`."""
Progress = Callable[[float], None]


class SliderRun(msgspec.Struct, frozen=True, eq=False, kw_only=True):
    """Sliders on a beam before the first step."""

    request: Request
    basis: TimeBasis | None
    """None without free modes."""
    stages: list[Stage]
    assembly: Assembly
    """Sliders without transverse motion, feet at height 0; a run advances a copy."""
    coupling: validity.Coupling
    margins: validity.Margins
    notes: tuple[str, ...]
    sequence: bool
    """Whether the result has an axis of sliders."""

    @classmethod
    def of(
        cls, request: Request, basis: TimeBasis | None, stages: list[Stage], notes: tuple[str, ...], sequence: bool
    ) -> "SliderRun":
        """A run with time steps that resolve motion and contact. Raises InputError."""
        beam, hertz, starts = request.beam, request.frequency_hz, request.starts
        stages = [stage.within(contact_range(beam, starts[0])) for stage in stages]
        if basis is not None and request.start == "rest":
            receptance = validity.modal_receptance(basis, request.omega, request.damping_in(basis))
        else:
            receptance = validity.field_receptance(beam, request.model, request.count, hertz, request.modal_damping)
        run = cls(
            request=request,
            basis=basis,
            stages=stages,
            assembly=assemble(beam, request.prescribed, starts),
            coupling=validity.coupling_of(beam, request.sliders, starts, stages[-1], receptance),
            margins=validity.margins_of(request, stages[-1]),
            notes=notes,
            sequence=sequence,
        )
        run = run._with_feet_steps() if request.feet else run._with_point_steps()
        check_steps(sum(stage.duration for stage in run.stages), run.stages[-1].steps.dt)
        return run

    def _with_feet_steps(self) -> "SliderRun":
        request, basis = self.request, self.basis if self.request.two_way else None
        rate, fastest = contact_rate(self.assembly, request.sliders, basis), float(basis.omegas.max()) if basis else 0.0
        step = step_control.feet_step(self.stages[0].steps.dt, rate, fastest, request.step)
        stages, slips = step_control.stepped(self.stages, step), validity.presliding(request)
        margins = replace(self.margins, presliding=slips, contact_step=rate * stages[-1].steps.dt)
        return replace(self, stages=stages, margins=margins)

    def _with_point_steps(self) -> "SliderRun":
        request, stages, length, rate = self.request, self.stages, self.request.beam.length, 0.0
        z, longest = self._unloaded(), max(stage.steps.dt for stage in stages)
        if request.step is not None:
            share = step_control.unresolved(stages, z, length, longest)
            enough = step_control.point_step(stages, z, length, longest, 0.0)
            note = f"step: {100 * share:.2g} % of the surface speed is not resolved, give at most {enough:.2g} s"
            return replace(self, notes=(*self.notes, *(note,) * (enough < longest)))
        if request.two_way:
            rates = ((s.steepness or inf) * s.mu * s.normal_force / s.mass for s in request.sliders if s.mu)
            rate = max(rates, default=0.0)
            if request.sliders[0].normal == "bilateral":
                longest *= 0.5  # the contact excites waves
        step = step_control.point_step(stages, z, length, longest, rate)
        return replace(self, stages=step_control.stepped(stages, step))

    def _unloaded(self) -> ComplexArray:
        """Free rows at the start, (n,), without deflection under the sliders. Raises InputError."""
        stage = self.stages[0]
        at_rest = np.zeros(len(stage.rows.rates), dtype=complex)
        return stage.free(self.request.continued(stage) if self.request.before else at_rest)

    def _initial(self) -> tuple[Assembly, ComplexArray]:
        """Sliders in equilibrium or in the state of an earlier run, and free rows, (n,). Raises InputError."""
        request, basis, stage, before = self.request, self.basis, self.stages[0], self.request.before
        assembly, z = self.assembly.copy(), self._unloaded()
        dt = stage.steps.dt if assembly.springs else 0.0
        rise: Array | float = 0.0

        def released(q: Array, seconds: float) -> Array:
            rows = stage.rows
            return rows.state(rows.after(rows.of_state(q, 0.0 * q), seconds))[0][: len(q)] if dt else q

        if basis and assembly.kind.normal_two_way:
            still, rise = static_deflection(basis, assembly, released, dt)
            if before is None:
                z = stage.rows.of_state(still, 0.0 * still)
                if stage.forced is None and assembly.kind.normal_law == BILATERAL:
                    z = z + steady_with_mass(basis, stage, assembly, request.damping_in(basis))
                z = stage.free(z)
        if before is None or before.contact is None:
            set_down(assembly, stage, z, rise)
            return assembly, z
        state = before.contact
        if state.points.shape != assembly.contacts.shape or len(state.feet) != len(assembly.feet):
            raise InputError("start: its feet differ from slider.foot, give both runs the same slider")
        prescribed = assembly.sliders["inverse_mass"] == 0.0
        assembly.sliders["x"] = state.sliders[:, 0]
        assembly.sliders["v"] = np.where(prescribed, assembly.sliders["v"], state.sliders[:, 1])
        for name, values in zip(FOOT_STATE, state.feet.T, strict=True):
            assembly.feet[name] = values
        assembly.contacts[:] = state.points
        return assembly, z

    def converged(self, progress: Progress) -> Motion:
        """The run; where friction acts on its own slip, also the change when an automatic step is doubled.

        That is two-way coupled point sliders, and feet that may stick in more than one way.

        Raises InputError for a residual of the energy balance above its tolerance.
        """
        request, stages, (assembly, z) = self.request, self.stages, self._initial()
        if (request.feet and not request.sticks_in_several_ways) or not request.two_way or request.step is not None:
            return self._checked(self.run(stages, assembly, z, progress))
        closer = ceil(step_control.COMPARED / sum(stage.steps.n // stage.steps.every for stage in stages))
        dt = max(stage.steps.dt for stage in stages)
        rough = step_control.stepped(stages, 2.0 * dt, closer)
        close = [one.stepped(0.5 * of.steps.dt, closer) for one, of in zip(stages, rough, strict=True)]  # samples fit
        coarse = self.run(rough, assembly.copy(), z, lambda part: progress(part / 3.0))
        fine = self.run(close, assembly, z, lambda part: progress((1.0 + 2.0 * part) / 3.0))
        moved, cost = step_control.change(coarse, fine), coarse.statistics
        note = f"step: not converged, doubling it changes the slider's displacement by {100.0 * moved:.2g} %"
        statistics = replace(
            fine.statistics,
            step_change=moved,
            wall_s=cost.wall_s + fine.statistics.wall_s,
            loop_s=cost.loop_s + fine.statistics.loop_s,
        )
        kept: dict[str, Any] = {name: getattr(fine, name)[::closer] for name in SAMPLED}
        notes = (*fine.notes, *(note,) * (moved > step_control.CONVERGED))
        return self._checked(replace(fine, statistics=statistics, notes=notes, **kept))

    def _checked(self, motion: Motion) -> Motion:
        """A motion with a note on its energy balance. Raises InputError for a residual above its tolerance."""
        if motion.energy is None:
            return motion
        statistics, request, resolved = motion.statistics, self.request, True
        dt = statistics.step_s
        if request.step is not None:
            share = step_control.unresolved(self.stages, self._unloaded(), request.beam.length, dt)
            resolved = share <= step_control.UNRESOLVED
        notes = step_control.check_energy(motion, request.frequency_hz, request.feet, resolved)
        if statistics.unconverged:
            notes += (f"step: contact forces did not converge in {statistics.unconverged} of {statistics.steps} steps",)
        return replace(motion, notes=(*motion.notes, *notes))

    def run(self, stages: list[Stage], assembly: Assembly, z: ComplexArray, progress: Progress) -> Motion:
        """One run through these stages from an initial state of the assembly, which is advanced, and of free rows."""
        began, request = perf_counter(), self.request
        kinetic = self._kinetic(assembly)
        recorded, deflection, beam, accounts = self._marched(stages, z, assembly, progress)
        gains = self._kinetic(assembly) - kinetic, float(recorded.journal.sums["stored"].sum()), *beam
        journal, sums, n = recorded.journal, recorded.journal.sums, len(recorded.journal.samples)
        journal.deflections[0] = deflection[0]
        if request.start == "rest" and request.before is None:
            still = np.array([slider.speed == 0.0 for slider in request.sliders])
            journal.samples["friction"][0, still] = 0.0  # at rest on a beam at rest, whatever the sign of rounding
        mean = 1.0 / recorded.seconds if recorded.seconds > 0.0 else float("nan")
        deflections, voltages, charges = request.split(journal.deflections)

        def each(values: Array) -> Any:
            """Values of all sliders of a sequence, or of the single slider."""
            own = np.array(values if self.sequence else values[..., 0], order="C")
            return own if own.ndim else float(own)

        return Motion(
            model=request.model,
            count=request.count,
            times=np.concatenate([[stages[0].origin], *(s.origin + s.sample_times for s in stages)])[:n],
            points=request.points,
            deflection=deflections,
            voltages=voltages,
            charges=charges,
            slider=request.sliders if self.sequence else request.sliders[0],
            start=request.starts if self.sequence else request.starts[0],
            **{name: each(journal.samples[name]) for name in SAMPLES},
            height=journal.heights[:, :, 0],
            pitch=journal.heights[:, :, 1],
            pressures=journal.pressures,
            point_offsets=self._point_offsets(assembly),
            events=recorded.events,
            mean_friction=each(mean * sums["friction_time"]),
            largest_friction=each(sums["max_friction"].copy()),
            mean_surface_speed=each(mean * sums["surface_time"]),
            coupling=self.coupling,
            margins=self._margins(float(sums["max_fall"].max())),
            energy=_balance(recorded, gains, assembly.kind.two_way, accounts),
            notes=self._notes(recorded),
            statistics=_statistics(recorded, stages[-1].steps.dt, perf_counter() - began),
            end=request.end(
                stages[-1],
                recorded.z,
                recorded.end,
                starts=request.starts,
                sliders=request.sliders,
                contact=_state(assembly),
                off="" if recorded.stopped in (END, "diverged", "chatters") else recorded.stopped,
            ),
        )

    def _margins(self, fall: float) -> validity.Margins:
        """Margins with the largest downward acceleration of the surface, m/s^2, of points without feet."""
        if self.request.feet:
            return self.margins
        return replace(self.margins, lift_off=fall / self.request.gravity if self.request.gravity else inf)

    def _notes(self, recorded: Run) -> tuple[str, ...]:
        """Notes, with one on events beyond the capacity and one on a load that has left the beam."""
        lost = (f"events: the first {len(recorded.events)} of {recorded.n_events}",)
        left = ("energy: work of the drive and losses of the beam until the load has left it",)
        return (*self.notes, *lost * (recorded.n_events > len(recorded.events)), *left * recorded.left)

    def _point_offsets(self, assembly: Assembly) -> Array:
        """Positions of the points relative to their slider, (points,), m."""
        offsets = np.array(self.request.starts) - self.request.starts[0]
        return np.asarray(assembly.points["offset"] - offsets[assembly.points["slider"]])

    def _marched(
        self, stages: list[Stage], z: ComplexArray, assembly: Assembly, progress: Progress
    ) -> tuple[Run, Array, tuple[float, float, float], bool]:
        """March beam and sliders to the end.

        Returns the run, the initial deflection (1, p), m, with readings, the beam's gains of kinetic and elastic energy
        and its initial energy, J, and whether the work of the drive and the loss in the beam are computed.
        """
        n_steps, points = sum(stage.steps.n for stage in stages), self.request.points
        # impacts do not act on the beam: its balance is exact
        rest = self.request.start == "rest" and assembly.restitution is None
        kinetic, elastic = stages[0].rows.energies(stages[0].whole(z, 0.0))
        deflection = stages[0].deflection(z, np.zeros(1), points)
        recorded = run_stages(stages, z, assembly, points, accounts=rest, progress=lambda n: progress(n / n_steps))
        after = stages[-1].rows.energies(recorded.z)
        gains = after[0] - kinetic, after[1] - elastic, kinetic + elastic
        return recorded, deflection, gains, rest and not recorded.left

    def _kinetic(self, assembly: Assembly) -> float:
        """Kinetic energy of sliders and feet, along and across the beam, J."""
        feet, masses = assembly.feet, np.array([slider.mass for slider in self.request.sliders])
        twice = masses @ assembly.sliders["v"] ** 2
        for inverse, rate in (("inverse_mass", "velocity_z"), ("inverse_inertia", "pitch_rate")):
            moves = feet[inverse] > 0.0  # 0 where nothing moves
            twice += (feet[rate][moves] ** 2 / feet[inverse][moves]).sum()
        if assembly.kind.normal_law == BILATERAL:
            twice += assembly.points["mass"] @ assembly.contacts["point_vz"] ** 2
        return 0.5 * float(twice)


def _state(assembly: Assembly) -> ContactState:
    """State of sliders, feet and points."""
    sliders, feet = assembly.sliders, assembly.feet
    return ContactState(
        sliders=np.stack([sliders["x"], sliders["v"]], axis=1),
        feet=np.stack([feet[name] for name in FOOT_STATE], axis=1),
        points=assembly.contacts.copy(),
    )


def _statistics(recorded: Run, dt: float, wall: float) -> Statistics:
    """Cost of a run of steps of dt that took `wall` seconds."""
    return Statistics(
        steps=recorded.n_steps,
        evaluations=2 * recorded.n_steps + 1,
        step_s=dt,
        set_up_s=recorded.set_up_s,
        wall_s=wall,
        loop_s=recorded.loop_s,
        unconverged=int(recorded.balance["unconverged"]),
        stopped=recorded.stopped,
    )


def _balance(recorded: Run, gains: tuple[float, ...], two_way: bool, accounts: bool) -> EnergyBalance:
    """The energy balance; `gains` of sliders, springs, modes (kinetic, elastic), and initial energy of the modes, J."""
    sums, (slider, stored, kinetic, elastic, initial) = recorded.journal.sums, gains
    works, balance = of_all(sums), recorded.balance
    load = works["external_work"] + works["load_work"]
    work = works["normal_work"] + works["tangential_work"] + works["slope_work"] + load
    residual = work - works["friction_loss"] - works["contact_loss"] - slider - stored
    contact = (works["friction_on_beam"] + works["normal_on_beam"]) * two_way
    beam = balance["driven"] + contact - balance["lost"] - kinetic - elastic
    return EnergyBalance(
        kinetic=kinetic,
        elastic=elastic,
        slider=slider,
        contact_elastic=stored,
        drive_work=balance["driven"],
        load_work=load,
        damping_loss=balance["lost"] - balance["resisted"],
        circuit_loss=balance["resisted"],
        **{name: works[name] for name in WORKS},
        initial=initial,
        created=balance["created"],
        slider_residual=residual,
        residual=beam if accounts and abs(beam) > abs(residual) else residual,
    )
