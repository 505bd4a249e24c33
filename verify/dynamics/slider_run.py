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
from verify.dynamics.result import END, FOOT_STATE, Coupling, EnergyBalance, Margins, Motion, Statistics
from verify.dynamics.state import SAMPLE
from verify.dynamics.stepping import Assembly, Run, run_stages
from verify.errors import InputError
from verify.linear.surface import contact_range
from verify.linear.time_basis import TimeBasis

WORKS = (
    *("slope_work", "tangential_work", "normal_work", "contact_loss", "friction_loss", "friction_on_beam"),
    "normal_on_beam",
)
"""Sums of the engine by term of `EnergyBalance`."""
SAMPLES = SAMPLE.names or ()  # Samples of the engine by field of `Motion`
SAMPLED = ("times", "deflection", "voltages", "charges", "height", "pitch", "pressures", *SAMPLES)
Progress = Callable[[float], None]


class SliderRun(msgspec.Struct, frozen=True, eq=False, kw_only=True):
    """Sliders on a beam before the first step."""

    request: Request
    basis: TimeBasis | None  # None without free modes
    stages: list[Stage]
    assembly: Assembly  # Sliders without transverse motion, feet at height 0; a run advances a copy
    coupling: Coupling
    margins: Margins
    notes: tuple[str, ...]

    @classmethod
    def of(cls, request: Request, basis: TimeBasis | None, stages: list[Stage], notes: tuple[str, ...]) -> "SliderRun":
        """A run with time steps that resolve motion and contact. Raises InputError."""
        stages = [stage.within(contact_range(request.beam, request.starts[0])) for stage in stages]
        assembly, free = assemble(request.beam, request.prescribed, request.starts), basis if request.two_way else None
        rate = contact_rate(assembly, request.sliders, free) if request.feet else 0.0
        if request.feet:
            stages = step_control.feet_stages(request, stages, rate, float(free.omegas.max()) if free else 0.0)
        else:
            stages, more = step_control.point_stages(request, stages)
            notes += more
        check_steps(sum(stage.duration for stage in stages), stages[-1].steps.dt)
        return cls(
            request=request,
            basis=basis,
            stages=stages,
            assembly=assembly,
            coupling=validity.coupling_of(request, basis, stages[-1]),
            margins=validity.margins_of(request, stages[-1], rate),
            notes=notes,
        )

    def _initial(self) -> tuple[Assembly, ComplexArray]:
        """Sliders in equilibrium or in the state of an earlier run, and free rows, (n,). Raises InputError."""
        request, basis, stage, before = self.request, self.basis, self.stages[0], self.request.before
        assembly, z = self.assembly.copy(), request.released(stage)
        rise: Array | float = 0.0
        if basis and assembly.kind.normal_two_way:
            still, rise = static_deflection(basis, assembly, stage)
            if before is None:
                z = stage.rows.of_state(still, 0.0 * still)
                if stage.forced is None and assembly.kind.normal_law == BILATERAL:
                    z = z + steady_with_mass(basis, stage, assembly, request.damping_in(basis))
                z = stage.free(z)
        if before is None or before.contact is None:
            set_down(assembly, stage, z, rise)
            return assembly, z
        state = before.contact
        if state.contacts.shape != assembly.contacts.shape or len(state.feet) != len(assembly.feet):
            raise InputError("start: its feet differ from slider.foot, give both runs the same slider")
        prescribed = assembly.sliders["inverse_mass"] == 0.0
        assembly.sliders["x"] = state.sliders["x"]
        assembly.sliders["v"] = np.where(prescribed, assembly.sliders["v"], state.sliders["v"])
        for name in FOOT_STATE:
            assembly.feet[name] = state.feet[name]
        assembly.contacts[:] = state.contacts
        return assembly, z

    def converged(self, progress: Progress) -> Motion:
        """The run; where friction acts on its own slip, also the change when an automatic step is doubled.

        That is two-way coupled point sliders, and feet that may stick in more than one way.

        Raises InputError for a residual of the energy balance above its tolerance.
        """
        request, stages, (assembly, z) = self.request, self.stages, self._initial()
        # static friction above the kinetic one may hold several rigid points in more than one way
        several = len(assembly.points) > 1 and any(assembly.sliders["mu_static"] > assembly.sliders["mu"])
        if (request.feet and not several) or not request.two_way or request.step is not None:
            return step_control.checked(self.run(stages, assembly, z, progress), request, stages)
        closer = ceil(step_control.COMPARED / sum(stage.steps.n // stage.steps.every for stage in stages))
        dt = max(stage.steps.dt for stage in stages)
        rough = [stage.stepped(2.0 * dt, closer) for stage in stages]
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
        motion = replace(fine, statistics=statistics, notes=notes, **kept)
        return step_control.checked(motion, request, stages)

    def run(self, stages: list[Stage], assembly: Assembly, z: ComplexArray, progress: Progress) -> Motion:
        """One run through these stages from an initial state of the assembly, which is advanced, and of free rows."""
        began, request, kinetic = perf_counter(), self.request, self._kinetic(assembly)
        recorded = self._marched(stages, z, assembly, progress)
        journal, sums, gained = recorded.journal, recorded.journal.sums, self._kinetic(assembly) - kinetic
        if request.start == "rest" and request.before is None:
            # at rest on a beam at rest, whatever the sign of rounding
            journal.samples["friction"][0, [slider.speed == 0.0 for slider in request.sliders]] = 0.0
        offsets = np.array(request.starts) - request.starts[0]
        mean = 1.0 / recorded.seconds if recorded.seconds > 0.0 else float("nan")
        notes, kept = list(self.notes), len(recorded.events)
        notes += [f"events: the first {kept} of {recorded.n_events}"] * (recorded.n_events > kept)
        notes += ["energy: work of the drive and losses of the beam until the load has left it"] * recorded.left
        margins, fall = self.margins, float(sums["max_fall"].max())
        if not request.feet:
            margins = replace(margins, lift_off=fall / request.gravity if request.gravity else inf)

        def each(values: Array) -> Any:
            """Values of all sliders of a sequence, or of the single slider."""
            own = np.array(values if request.sequence else values[..., 0], order="C")
            return own if own.ndim else float(own)

        return request.motion(
            stages,
            journal.deflections,
            slider=request.sliders if request.sequence else request.sliders[0],
            start=request.starts if request.sequence else request.starts[0],
            **{name: each(journal.samples[name]) for name in SAMPLES},
            height=journal.heights[:, :, 0],
            pitch=journal.heights[:, :, 1],
            pressures=journal.pressures,
            point_offsets=assembly.points["offset"] - offsets[assembly.points["slider"]],
            events=recorded.events,
            mean_friction=each(mean * sums["friction_time"]),
            largest_friction=each(sums["max_friction"].copy()),
            mean_surface_speed=each(mean * sums["surface_time"]),
            coupling=self.coupling,
            margins=margins,
            energy=_balance(recorded, gained, assembly.kind.two_way),
            notes=tuple(notes),
            statistics=Statistics(
                steps=recorded.n_steps,
                evaluations=2 * recorded.n_steps + 1,
                step_s=stages[-1].steps.dt,
                set_up_s=recorded.set_up_s,
                wall_s=perf_counter() - began,
                loop_s=recorded.loop_s,
                unconverged=int(journal.balance["unconverged"][0]),
                stopped=recorded.stopped,
            ),
            end=request.end(
                stages[-1],
                recorded.z,
                recorded.end,
                starts=request.starts,
                sliders=request.sliders,
                contact=assembly.bodies,
                off="" if recorded.stopped in (END, "diverged", "chatters") else recorded.stopped,
            ),
        )

    def _marched(self, stages: list[Stage], z: ComplexArray, assembly: Assembly, progress: Progress) -> Run:
        """Beam and sliders at the end of their march."""
        n_steps, request = sum(stage.steps.n for stage in stages), self.request
        # impacts do not act on the beam: its balance is exact
        accounts = request.start == "rest" and assembly.restitution is None
        given = stages, z, assembly, request.points
        return run_stages(*given, accounts=accounts, progress=lambda n: progress(n / n_steps))

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


def _balance(recorded: Run, gained: float, two_way: bool) -> EnergyBalance:
    """The energy balance with the gain of kinetic energy of sliders and feet, J."""
    tables = recorded.journal.sums, recorded.journal.balance
    works, balance = ({name: float(one[name].sum()) for name in one.dtype.names or ()} for one in tables)
    kinetic, elastic, initial = recorded.gains
    load = works["external_work"] + works["load_work"]
    work = works["normal_work"] + works["tangential_work"] + works["slope_work"] + load
    residual = work - works["friction_loss"] - works["contact_loss"] - gained - works["stored"]
    contact = (works["friction_on_beam"] + works["normal_on_beam"]) * two_way
    beam = balance["driven"] + contact - balance["lost"] - kinetic - elastic
    return EnergyBalance(
        kinetic=kinetic,
        elastic=elastic,
        slider=gained,
        contact_elastic=works["stored"],
        drive_work=balance["driven"],
        load_work=load,
        damping_loss=balance["lost"] - balance["resisted"],
        circuit_loss=balance["resisted"],
        **{name: works[name] for name in WORKS},
        initial=initial,
        created=balance["created"],
        slider_residual=residual,
        residual=beam if recorded.accounts and abs(beam) > abs(residual) else residual,
    )
