"""A run of sliders in contact with a beam: initial state, steps, result."""

from collections.abc import Callable
from math import inf
from time import perf_counter
from typing import Any

import msgspec
import numpy as np
from msgspec.structs import replace

from verify.arrays import Array, ComplexArray
from verify.dynamics import layout as lay
from verify.dynamics.contact_assembly import assemble, contact_rate
from verify.dynamics.coupling import Coupling, coupling_of, field_receptance, modal_receptance
from verify.dynamics.initial_state import (
    deepen_between_beams,
    largest_static_deflection,
    set_down,
    static_deflection,
    steady_with_mass,
)
from verify.dynamics.linear_system import Stage
from verify.dynamics.request import MOST_STEPS, Request
from verify.dynamics.result import END, INTERRUPTED, ContactState, EndState, EnergyBalance, Motion, Statistics
from verify.dynamics.step_control import (
    CONVERGED,
    NOT_CONVERGED,
    UNRESOLVED,
    change,
    check_energy,
    doubled,
    feet_step,
    point_step,
    stepped,
    unresolved,
)
from verify.dynamics.stepping import Contacts, Recorded, run_stages
from verify.dynamics.validity import Margins, margins_of
from verify.errors import InputError, written
from verify.linear.field import travelling_wavenumber
from verify.linear.surface import contact_range, section_at
from verify.linear.time_basis import TimeBasis
from verify.problem.slider import Slider

SAMPLED = (
    "times", "deflection", "travelled", "speed", "friction", "normal_force", "surface_speed", "contact_share",
    "stuck_share", "friction_loss", "tangential_work", "height", "pitch", "pressures",
)  # fmt: skip
"""Fields of a motion with a row for each sample."""
Progress = Callable[[float], None]


class SliderRun(msgspec.Struct, frozen=True, eq=False, kw_only=True):
    """Sliders on a beam before the first step."""

    request: Request
    basis: TimeBasis | None
    """None where no mode is free."""
    stages: list[Stage]
    coupling: Coupling
    margins: Margins
    notes: tuple[str, ...]
    sequence: bool
    """Whether the result has an axis of sliders."""

    @classmethod
    def of(
        cls, request: Request, basis: TimeBasis | None, stages: list[Stage], notes: tuple[str, ...], sequence: bool
    ) -> "SliderRun":
        """The run in steps that resolve motion and contact. Raises InputError."""
        beam, omega, sliders, starts = request.beam, request.omega, request.sliders, request.starts
        stages = [stage.within(contact_range(beam, starts[0])) for stage in stages]
        if basis is not None and request.start == "rest":
            receptance = modal_receptance(basis, omega, request.damping_in(basis))
        else:
            receptance = field_receptance(
                beam, request.model, request.count, request.frequency_hz, request.modal_damping
            )
        gravity = min(slider.effective_gravity for slider in sliders)
        margins = margins_of(beam, request.model, request.count, stages[-1], gravity, None)
        coupling = coupling_of(beam, sliders, starts, stages[-1], receptance)
        run = cls(
            request=request,
            basis=basis,
            stages=stages,
            coupling=coupling,
            margins=margins,
            notes=notes,
            sequence=sequence,
        )
        return run._with_feet_steps() if request.feet else run._with_point_steps()

    def _contacts(self) -> Contacts:
        request = self.request
        return assemble(request.beam, request.sliders, request.starts, request.prescribed_speeds, request.fixed)

    def _with_feet_steps(self) -> "SliderRun":
        request, contacts, basis = self.request, self._contacts(), self.basis if self.request.two_way else None
        rate, longest = contact_rate(contacts, request.sliders, basis), self.stages[0].steps.dt
        fastest = float(basis.omegas.max()) if basis else 0.0
        stages = stepped(self.stages, feet_step(longest, rate, fastest, request.step))
        margins = replace(
            self.margins,
            presliding=presliding(request),
            contact_step=rate * stages[-1].steps.dt,
            static_deflection=largest_static_deflection(request.beam, request.model, request.count, contacts),
        )
        return replace(self, stages=stages, margins=margins)

    def _with_point_steps(self) -> "SliderRun":
        request, stages, slider = self.request, self.stages, self.request.sliders[0]
        z, longest = self._initial(self._contacts(), loaded=False), max(stage.steps.dt for stage in stages)
        rate = 0.0
        if request.two_way:
            rates = [(s.steepness or inf) * s.mu * s.normal_force / s.mass for s in request.sliders if s.mu]
            rate = max(rates, default=0.0)
        if request.step is not None:
            share = unresolved(stages, z, request.beam.length, longest)
            enough = point_step(stages, z, request.beam.length, longest, 0.0)
            note = f"step: {100 * share:.2g} % of the surface speed are not resolved, give at most {enough:.2g} s"
            return replace(self, notes=(*self.notes, *(note,) * (enough < longest)))
        if request.two_way and slider.normal == "held":
            longest *= 0.5  # the contact excites waves of its own
        step = point_step(stages, z, request.beam.length, longest, rate)
        duration = sum(stage.duration for stage in stages)
        if duration / step > MOST_STEPS:
            raise InputError(
                f"duration = {written(duration)} s: the modes that the start excites need steps of {step:.2g} s, more "
                f"than {MOST_STEPS:g} of them: shorten the duration, lengthen soft_start_periods, or give a step"
            )
        return replace(self, stages=stepped(stages, step))

    def _initial(self, contacts: Contacts, loaded: bool = True) -> ComplexArray:
        """Free rows at the start, (n,); sets the sliders down, or continues them. Raises InputError."""
        request, basis, stage, before = self.request, self.basis, self.stages[0], self.request.before
        still, z = np.zeros(len(stage.rows.rates)), np.zeros(len(stage.rows.rates), dtype=complex)
        if basis and loaded and contacts.presses:
            still = static_deflection(basis, contacts)
            deepen_between_beams(basis, contacts, still)
            z = stage.rows.of_state(still, 0.0 * still)
            if stage.forced is None and contacts.law == lay.BILATERAL:
                z = z + steady_with_mass(basis, stage, contacts, request.damping_in(basis))
        if before is not None:
            if len(before.q) != len(z):
                raise InputError(
                    f"continue_from has {len(before.q)} modes and this run {len(z)}: give both the same modes"
                )
            z = stage.rows.of_state(before.q, before.rates)
        z = stage.free(z)
        if before is None or before.contact is None:
            set_down(contacts, stage, z)
            return z
        state = before.contact
        if state.points.shape != contacts.contacts.shape or len(state.feet) != len(contacts.feet):
            raise InputError("continue_from has other feet than slider.foot: give both runs the same slider")
        prescribed = contacts.sliders[:, lay.INVERSE_MASS] == 0.0
        contacts.sliders[:, lay.X] = state.sliders[:, 0]
        contacts.sliders[:, lay.V] = np.where(prescribed, contacts.sliders[:, lay.V], state.sliders[:, 1])
        contacts.feet[:, : lay.TURN + 1], contacts.contacts[:] = state.feet, state.points
        return z

    def converged(self, progress: Progress) -> Motion:
        """The run; of a two-way coupled point slider whose step is not given with the change by doubling it.

        Raises InputError where the energy balance does not close.
        """
        request = self.request
        if request.feet or not request.two_way or request.step is not None:
            return self._checked(self.run(self.stages, progress))
        coarse, fine, closer = doubled(self.run, self.stages, progress)
        if fine.statistics.interrupted:
            return fine
        moved = change(coarse, fine)
        notes = (f"{NOT_CONVERGED} by {100.0 * moved:.2g} %",) * (moved > CONVERGED)
        kept = {name: getattr(fine, name)[::closer] for name in SAMPLED}
        wall = coarse.statistics.wall_s + fine.statistics.wall_s
        statistics = replace(
            fine.statistics,
            step_change=moved,
            wall_s=wall,
            loop_s=coarse.statistics.loop_s + fine.statistics.loop_s,
        )
        return self._checked(replace(fine, statistics=statistics, notes=(*fine.notes, *notes), **kept))

    def _checked(self, motion: Motion) -> Motion:
        """A motion with a note on its energy balance. Raises InputError where that does not close."""
        if motion.statistics.interrupted or motion.energy is None:
            return motion
        dt, request, stages, resolved = motion.statistics.step_s, self.request, self.stages, True
        if request.step is not None:
            z = self._initial(self._contacts(), loaded=False)
            resolved = unresolved(stages, z, request.beam.length, dt) <= UNRESOLVED
        notes = check_energy(motion.energy, dt, request.frequency_hz, request.feet, resolved)
        return replace(motion, notes=(*motion.notes, *notes))

    def run(self, stages: list[Stage], progress: Progress) -> Motion:
        """One run through these stages. Raises InputError."""
        began, request, contacts = perf_counter(), self.request, self._contacts()
        z = self._initial(contacts)
        kinetic = _kinetic(request.sliders, contacts)
        beam = _beam_energy(self.basis, stages[0], z, 0.0)
        first = (
            stages[0].deflection(z, np.zeros(1), request.points),
            contacts.feet[None][:, :, [lay.HEIGHT, lay.PITCH]].copy(),
            (contacts.points[:, lay.STIFF] * np.maximum(contacts.contacts[:, lay.DEPTH], 0.0))[None],
        )
        n_steps, accounts = sum(stage.steps.n for stage in stages), request.start == "rest"
        recorded = run_stages(
            stages, z, contacts, request.points, accounts=accounts, progress=lambda n: progress(n / n_steps)
        )
        gains = (
            _kinetic(request.sliders, contacts) - kinetic,
            float(recorded.sums[:, lay.STORED].sum()),
            *(_beam_energy(self.basis, stages[-1], recorded.z, None) - beam).tolist(),
            float(beam.sum()),
        )
        statistics = Statistics(
            steps=recorded.n_steps,
            evaluations=2 * recorded.n_steps + 1,
            step_s=stages[-1].steps.dt,
            set_up_s=recorded.set_up_s,
            wall_s=perf_counter() - began,
            loop_s=recorded.loop_s,
            unconverged=int(recorded.balance[lay.UNCONVERGED]),
            stopped=recorded.stopped,
        )
        return self._motion(
            stages, contacts, recorded, first, statistics, _balance(recorded, gains, contacts, accounts)
        )

    def _motion(
        self,
        stages: list[Stage],
        contacts: Contacts,
        recorded: Recorded,
        first: tuple[Array, ...],
        statistics: Statistics,
        energy: EnergyBalance,
    ) -> Motion:
        request, n = self.request, len(recorded.samples)
        recordings = recorded.deflections, recorded.heights, recorded.pressures
        deflection, heights, pressures = (np.concatenate(pair) for pair in zip(first, recordings, strict=True))
        kept = np.concatenate([recorded.first[None], recorded.samples])
        if request.start == "rest" and request.before is None:
            still = np.array([slider.speed == 0.0 for slider in request.sliders])
            kept[0, still, lay.KEPT_FRICTION] = 0.0  # at rest on a beam at rest, whatever the sign of rounding
        end = _time_after(stages, recorded.n_steps)
        seconds = end - stages[0].origin
        sums, mean = recorded.sums, 1.0 / seconds if seconds > 0.0 else float("nan")

        def along(column: int) -> Array:
            return np.ascontiguousarray(kept[:, :, column] if self.sequence else kept[:, 0, column])

        def total(values: Array) -> Any:
            return values if self.sequence else float(values[0])

        lost = (f"events: the first {len(recorded.events)} of {recorded.n_events}",)
        margins = self.margins
        if not request.feet:
            gravity = min(slider.effective_gravity for slider in request.sliders)
            fall = float(sums[:, lay.FALL].max())
            margins = replace(margins, lift_off=fall / gravity if gravity else inf)
        own = contacts.indices[:, lay.OF_SLIDER]
        offsets = contacts.points[:, lay.OFFSET] - (np.array(request.starts) - request.starts[0])[own]
        whole = stages[-1]
        q, rates = whole.rows.state(recorded.z)
        left = recorded.stopped not in (END, INTERRUPTED, "diverged", "chatters")
        return Motion(
            model=request.model,
            count=request.count,
            times=np.concatenate([[stages[0].origin], *(s.origin + s.sample_times for s in stages)])[: n + 1],
            points=request.points,
            deflection=deflection,
            slider=request.sliders if self.sequence else request.sliders[0],
            start=request.starts if self.sequence else request.starts[0],
            travelled=along(lay.KEPT_X),
            speed=along(lay.KEPT_V),
            friction=along(lay.KEPT_FRICTION),
            normal_force=along(lay.KEPT_NORMAL),
            surface_speed=along(lay.KEPT_SURFACE),
            contact_share=along(lay.KEPT_TOUCH),
            stuck_share=along(lay.KEPT_STUCK),
            friction_loss=along(lay.KEPT_LOSS),
            tangential_work=along(lay.KEPT_ALONG),
            height=heights[:, :, 0],
            pitch=heights[:, :, 1],
            pressures=pressures,
            point_offsets=offsets,
            events=recorded.events,
            mean_friction=total(mean * sums[:, lay.FRICTION_TIME]),
            largest_friction=total(sums[:, lay.HARDEST]),
            mean_surface_speed=total(mean * sums[:, lay.SURFACE_TIME]),
            coupling=self.coupling,
            margins=margins,
            energy=energy,
            notes=(*self.notes, *lost * (recorded.n_events > len(recorded.events))),
            statistics=statistics,
            end=EndState(
                beam=request.beam,
                model=request.model,
                count=request.count,
                time=end,
                q=q,
                rates=rates,
                steady=request.start == "steady",
                starts=request.starts,
                sliders=request.sliders,
                contact=ContactState(
                    contacts.sliders[:, [lay.X, lay.V]],
                    contacts.feet[:, : lay.TURN + 1].copy(),
                    contacts.contacts.copy(),
                ),
                off=recorded.stopped if left else "",
            ),
        )


def _time_after(stages: list[Stage], steps: int) -> float:
    """The time after so many steps, s."""
    for stage in stages:
        if steps <= stage.steps.n:
            break
        steps -= stage.steps.n
    return stage.origin + steps * stage.steps.dt


def _kinetic(sliders: tuple[Slider, ...], contacts: Contacts) -> float:
    """Of sliders and feet, along and across the beam, J."""
    feet, bilateral = contacts.feet, contacts.law == lay.BILATERAL
    masses = np.array([slider.mass for slider in sliders])
    inverse = feet[:, [lay.INVERSE_FOOT_MASS, lay.INVERSE_INERTIA]]  # 0 where nothing moves
    inertia = np.divide(1.0, inverse, out=np.zeros_like(inverse), where=inverse > 0.0)
    across = inertia * feet[:, [lay.CLIMB, lay.TURN]] ** 2
    rise = contacts.points[:, lay.INERTIA] @ contacts.contacts[:, lay.RISE_RATE] ** 2 if bilateral else 0.0
    return 0.5 * float(masses @ contacts.sliders[:, lay.V] ** 2 + across.sum() + rise)


def _beam_energy(basis: TimeBasis | None, stage: Stage, z: ComplexArray, t: float | None) -> Array:
    """(kinetic, elastic) of the modes, J; `z` is the free part at time t, or all of the motion for None."""
    if basis is None:
        return np.zeros(2)
    q, rates = stage.rows.state(z if t is None else stage.whole(z, t))
    return 0.5 * np.array([rates @ rates, (basis.omegas**2 * q) @ q])


def _balance(recorded: Recorded, gains: tuple[float, ...], contacts: Contacts, rest: bool) -> EnergyBalance:
    """Works, losses and gains."""
    s, (slider, stored, kinetic, elastic, initial) = recorded.sums.sum(axis=0), gains
    load = s[lay.PULLED] + s[lay.PRESSED]
    residual = s[lay.ACROSS] + s[lay.ALONG] + s[lay.UPHILL] + load - s[lay.DISSIPATED] - s[lay.DAMPED] - slider - stored
    driven, lost = (float(recorded.balance[column]) for column in (lay.DRIVEN, lay.LOST))
    whole = residual
    if rest:
        charged = s[lay.ON_BEAM] + s[lay.LIFTED_BEAM] if contacts.two_way else 0.0
        beam = driven + charged - lost - kinetic - elastic
        whole = beam if abs(beam) > abs(residual) else residual
    return EnergyBalance(
        kinetic=kinetic,
        elastic=elastic,
        slider=slider,
        contact_elastic=stored,
        drive_work=driven,
        load_work=float(load),
        tangential_work=float(s[lay.ALONG]),
        normal_work=float(s[lay.ACROSS]),
        slope_work=float(s[lay.UPHILL]),
        damping_loss=lost,
        friction_loss=float(s[lay.DISSIPATED]),
        contact_loss=float(s[lay.DAMPED]),
        friction_on_beam=float(s[lay.ON_BEAM]),
        normal_on_beam=float(s[lay.LIFTED_BEAM]),
        initial=initial,
        created=float(recorded.balance[lay.GAINED_ENERGY]),
        slider_residual=float(residual),
        residual=float(whole),
    )


def presliding(request: Request) -> float | None:
    """2 mu kappa / (kappa_t k h), the largest of all feet (`Margins.presliding`)."""
    largest = 0.0
    for slider, start in zip(request.sliders, request.starts, strict=True):
        contact, section = slider.contact, section_at(request.beam, start)
        if contact is None or contact.hard:
            return None
        compliances = [(contact.across(foot.length), contact.along(foot.length)) for foot in slider.feet]
        if all(along for _, along in compliances):
            k = travelling_wavenumber(section, request.frequency_hz)
            if k is None:
                return None
            ratio = max(across / along for across, along in compliances)
            largest = max(largest, slider.mu * ratio / (k * section.surface_distance))
    return largest
