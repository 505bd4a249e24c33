"""A run of sliders in contact with a beam: initial state, steps, result."""

from collections.abc import Callable
from math import ceil, inf
from time import perf_counter
from typing import Any

import msgspec
import numpy as np
from msgspec.structs import replace

from verify.arrays import Array, ComplexArray
from verify.dynamics import layout as lay
from verify.dynamics import step_control, validity
from verify.dynamics.contact_assembly import assemble, contact_rate
from verify.dynamics.initial_state import set_down, static_deflection, steady_with_mass
from verify.dynamics.linear_system import Stage
from verify.dynamics.request import Request, check_steps
from verify.dynamics.result import END, ContactState, EnergyBalance, Motion, Statistics
from verify.dynamics.stepping import Contacts, Run, run_stages
from verify.errors import InputError
from verify.linear.surface import contact_range
from verify.linear.time_basis import TimeBasis

COLUMNS = {
    "travelled": lay.OUT_X, "speed": lay.OUT_V, "friction": lay.OUT_FRICTION, "normal_force": lay.OUT_NORMAL,
    "surface_speed": lay.OUT_SURFACE, "contact_fraction": lay.OUT_TOUCH, "stick_fraction": lay.OUT_STUCK,
    "friction_loss": lay.OUT_LOSS, "tangential_work": lay.OUT_ALONG,
}  # fmt: skip
"""Column of the engine's samples by field of `Motion`."""
WORKS = {
    "slope_work": lay.SLOPE_WORK,
    "tangential_work": lay.TANGENTIAL_WORK,
    "normal_work": lay.NORMAL_WORK,
    "contact_loss": lay.CONTACT_LOSS,
    "friction_loss": lay.FRICTION_LOSS,
    "friction_on_beam": lay.FRICTION_ON_BEAM,
    "normal_on_beam": lay.NORMAL_ON_BEAM,
}
"""Column of the engine's sums by term of `EnergyBalance`."""
SAMPLED = ("times", "deflection", "voltages", "charges", "height", "pitch", "pressures", *COLUMNS)
Progress = Callable[[float], None]


class SliderRun(msgspec.Struct, frozen=True, eq=False, kw_only=True):
    """Sliders on a beam before the first step."""

    request: Request
    basis: TimeBasis | None
    """None without free modes."""
    stages: list[Stage]
    contacts: Contacts
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
            contacts=assemble(beam, request.sliders, starts, request.prescribed_speeds, request.fixed),
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
        rate, fastest = contact_rate(self.contacts, request.sliders, basis), float(basis.omegas.max()) if basis else 0.0
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

    def _initial(self) -> tuple[Contacts, ComplexArray]:
        """Sliders in equilibrium or in the state of an earlier run, and free rows, (n,). Raises InputError."""
        request, basis, stage, before = self.request, self.basis, self.stages[0], self.request.before
        contacts, z = self.contacts.copy(), self._unloaded()
        dt = stage.steps.dt if contacts.law == lay.SPRING and contacts.restitution is None else 0.0
        rise: Array | float = 0.0

        def released(q: Array, seconds: float) -> Array:
            rows = stage.rows
            return rows.state(rows.after(rows.of_state(q, 0.0 * q), seconds))[0][: len(q)] if dt else q

        if basis and contacts.normal_two_way:
            still, rise = static_deflection(basis, contacts, released, dt)
            if before is None:
                z = stage.rows.of_state(still, 0.0 * still)
                if stage.forced is None and contacts.law == lay.BILATERAL:
                    z = z + steady_with_mass(basis, stage, contacts, request.damping_in(basis))
                z = stage.free(z)
        if before is None or before.contact is None:
            set_down(contacts, stage, z, rise)
            return contacts, z
        state = before.contact
        if state.points.shape != contacts.contacts.shape or len(state.feet) != len(contacts.feet):
            raise InputError("start: its feet differ from slider.foot, give both runs the same slider")
        prescribed = contacts.sliders[:, lay.INVERSE_MASS] == 0.0
        contacts.sliders[:, lay.X] = state.sliders[:, 0]
        contacts.sliders[:, lay.V] = np.where(prescribed, contacts.sliders[:, lay.V], state.sliders[:, 1])
        contacts.feet[:, : lay.PITCH_RATE + 1], contacts.contacts[:] = state.feet, state.points
        return contacts, z

    def converged(self, progress: Progress) -> Motion:
        """The run; where friction acts on its own slip, also the change when an automatic step is doubled.

        That is two-way coupled point sliders, and feet that may stick in more than one way.

        Raises InputError for a residual of the energy balance above its tolerance.
        """
        request, stages, start = self.request, self.stages, self._initial()
        if (request.feet and not request.sticks_in_several_ways) or not request.two_way or request.step is not None:
            return self._checked(self.run(stages, *start, progress))
        closer = ceil(step_control.COMPARED / sum(stage.steps.n // stage.steps.every for stage in stages))
        dt = max(stage.steps.dt for stage in stages)
        rough = step_control.stepped(stages, 2.0 * dt, closer)
        close = [one.stepped(0.5 * of.steps.dt, closer) for one, of in zip(stages, rough, strict=True)]  # samples fit
        coarse = self.run(rough, *start, lambda part: progress(part / 3.0))
        fine = self.run(close, *start, lambda part: progress((1.0 + 2.0 * part) / 3.0))
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

    def run(self, stages: list[Stage], contacts: Contacts, z: ComplexArray, progress: Progress) -> Motion:
        """One run through these stages from an initial state of contacts and free rows."""
        began, request, contacts = perf_counter(), self.request, contacts.copy()
        p, depth = contacts.points, np.maximum(contacts.contacts[:, lay.DEPTH], 0.0)
        kinetic = self._kinetic(contacts)
        heights, pressures = contacts.feet[None][:, :, [lay.HEIGHT, lay.PITCH]].copy(), (p[:, lay.STIFF] * depth)[None]
        recorded, deflection, beam, accounts = self._marched(stages, z, contacts, progress)
        gains = self._kinetic(contacts) - kinetic, float(recorded.sums[:, lay.STORED].sum()), *beam
        n, kept = len(recorded.samples), np.concatenate([recorded.first[None], recorded.samples])
        if request.start == "rest" and request.before is None:
            still = np.array([slider.speed == 0.0 for slider in request.sliders])
            kept[0, still, lay.OUT_FRICTION] = 0.0  # at rest on a beam at rest, whatever the sign of rounding
        heights = np.concatenate([heights, recorded.heights])
        deflection, voltages, charges = request.split(np.concatenate([deflection, recorded.deflections]))
        steps = recorded.n_steps
        for stage in stages:
            if steps <= stage.steps.n:
                break
            steps -= stage.steps.n
        end = stage.origin + steps * stage.steps.dt
        seconds, sums, margins = end - stages[0].origin, recorded.sums, self.margins
        mean = 1.0 / seconds if seconds > 0.0 else float("nan")
        if not request.feet:
            fall = float(sums[:, lay.MAX_FALL].max())
            margins = replace(margins, lift_off=fall / request.gravity if request.gravity else inf)
        offsets = np.array(request.starts) - request.starts[0]
        lost = (f"events: the first {len(recorded.events)} of {recorded.n_events}",)
        left = recorded.stopped not in (END, "diverged", "chatters")
        state = (
            contacts.sliders[:, [lay.X, lay.V]],
            contacts.feet[:, : lay.PITCH_RATE + 1].copy(),
            contacts.contacts.copy(),
        )

        def each(values: Array) -> Any:
            """Values of all sliders of a sequence, or of the single slider."""
            own = np.array(values if self.sequence else values[..., 0], order="C")
            return own if own.ndim else float(own)

        return Motion(
            model=request.model,
            count=request.count,
            times=np.concatenate([[stages[0].origin], *(s.origin + s.sample_times for s in stages)])[: n + 1],
            points=request.points,
            deflection=deflection,
            voltages=voltages,
            charges=charges,
            slider=request.sliders if self.sequence else request.sliders[0],
            start=request.starts if self.sequence else request.starts[0],
            **{name: each(kept[:, :, column]) for name, column in COLUMNS.items()},
            height=heights[:, :, 0],
            pitch=heights[:, :, 1],
            pressures=np.concatenate([pressures, recorded.pressures]),
            point_offsets=p[:, lay.OFFSET] - offsets[contacts.indices[:, lay.OF_SLIDER]],
            events=recorded.events,
            mean_friction=each(mean * sums[:, lay.FRICTION_TIME]),
            largest_friction=each(sums[:, lay.MAX_FRICTION]),
            mean_surface_speed=each(mean * sums[:, lay.SURFACE_TIME]),
            coupling=self.coupling,
            margins=margins,
            energy=_balance(recorded, gains, contacts.two_way, accounts),
            notes=(*self.notes, *lost * (recorded.n_events > len(recorded.events))),
            statistics=Statistics(
                steps=recorded.n_steps,
                evaluations=2 * recorded.n_steps + 1,
                step_s=stages[-1].steps.dt,
                set_up_s=recorded.set_up_s,
                wall_s=perf_counter() - began,
                loop_s=recorded.loop_s,
                unconverged=int(recorded.balance[lay.UNCONVERGED]),
                stopped=recorded.stopped,
            ),
            end=request.end(
                stages[-1],
                recorded.z,
                end,
                starts=request.starts,
                sliders=request.sliders,
                contact=ContactState(*state),
                off=recorded.stopped if left else "",
            ),
        )

    def _marched(
        self, stages: list[Stage], z: ComplexArray, contacts: Contacts, progress: Progress
    ) -> tuple[Run, Array, tuple[float, float, float], bool]:
        """March beam and sliders to the end.

        Returns the run, the initial deflection (1, p), m, with readings, the beam's gains of kinetic and elastic energy
        and its initial energy, J, and whether the work of the drive and the loss in the beam are computed.
        """
        n_steps, points = sum(stage.steps.n for stage in stages), self.request.points
        # impacts do not act on the beam: its balance is exact
        rest = self.request.start == "rest" and contacts.restitution is None
        kinetic, elastic = stages[0].rows.energies(stages[0].whole(z, 0.0))
        deflection = stages[0].deflection(z, np.zeros(1), points)
        recorded = run_stages(stages, z, contacts, points, accounts=rest, progress=lambda n: progress(n / n_steps))
        after = stages[-1].rows.energies(recorded.z)
        return recorded, deflection, (after[0] - kinetic, after[1] - elastic, kinetic + elastic), rest

    def _kinetic(self, contacts: Contacts) -> float:
        """Kinetic energy of sliders and feet, along and across the beam, J."""
        feet, masses = contacts.feet, np.array([slider.mass for slider in self.request.sliders])
        twice = masses @ contacts.sliders[:, lay.V] ** 2
        if len(feet):
            inverse = feet[:, [lay.INVERSE_FOOT_MASS, lay.INVERSE_INERTIA]]  # 0 where nothing moves
            inertia = np.divide(1.0, inverse, out=np.zeros_like(inverse), where=inverse > 0.0)
            twice += (inertia * feet[:, [lay.VELOCITY_Z, lay.PITCH_RATE]] ** 2).sum()
        if contacts.law == lay.BILATERAL:
            twice += contacts.points[:, lay.INERTIA] @ contacts.contacts[:, lay.POINT_VZ] ** 2
        return 0.5 * float(twice)


def _balance(recorded: Run, gains: tuple[float, ...], two_way: bool, accounts: bool) -> EnergyBalance:
    """The energy balance; `gains` of sliders, springs, modes (kinetic, elastic), and initial energy of the modes, J."""
    s, (slider, stored, kinetic, elastic, initial) = recorded.sums.sum(axis=0), gains
    work = s[lay.NORMAL_WORK] + s[lay.TANGENTIAL_WORK] + s[lay.SLOPE_WORK] + s[lay.EXTERNAL_WORK] + s[lay.LOAD_WORK]
    residual = work - s[lay.FRICTION_LOSS] - s[lay.CONTACT_LOSS] - slider - stored
    driven, lost, resisted = (float(recorded.balance[column]) for column in (lay.DRIVEN, lay.LOST, lay.RESISTED))
    beam = driven + (s[lay.FRICTION_ON_BEAM] + s[lay.NORMAL_ON_BEAM]) * two_way - lost - kinetic - elastic
    return EnergyBalance(
        kinetic=kinetic,
        elastic=elastic,
        slider=slider,
        contact_elastic=stored,
        drive_work=driven,
        load_work=float(s[lay.EXTERNAL_WORK] + s[lay.LOAD_WORK]),
        damping_loss=lost - resisted,
        circuit_loss=resisted,
        **{name: float(s[column]) for name, column in WORKS.items()},
        initial=initial,
        created=float(recorded.balance[lay.CREATED]),
        slider_residual=float(residual),
        residual=float(beam if accounts and abs(beam) > abs(residual) else residual),
    )
