"""Driver of the compiled loop: rows and tables of a stage, chunks of steps, raw samples."""

from collections.abc import Callable, Sequence
from time import thread_time

import msgspec
import numpy as np
from msgspec.structs import replace

from verify.arrays import Array, ComplexArray
from verify.contact.state import SPRING, Bodies, Kind, Records, Response
from verify.dynamics import state
from verify.dynamics.linear_system import Stage

CHUNK = 20_000  # Number of steps between checks for an interrupt
EVENTS = 20_000  # Capacity of the event log
RESOLVED = 1.5
"""Phase or decay of a row per step, rad or neper, above which rates are means over the step.

Simpson's rule by the rates at both ends misses (1.5/2)^4/180 = 0.2 % of a mean there."""
REACH, FARTHEST = 2, 128
"""Number of pieces of a table on each side of the points: in the first table, and at most; each doubles the last."""
Progress = Callable[[int], None]


class Assembly(msgspec.Struct, eq=False, kw_only=True):
    """Sliders with their feet and points on a beam; advanced in place by `run_stages`.

    `contact_assembly` fills it in once; every run advances a `copy`.
    """

    start: float
    """Initial position of the first slider, m, the origin of distances and edges, so that nanometres are exact."""
    sliders: Records  # (sliders,)
    feet: Records  # (feet,), empty for points without feet
    points: Records  # (points,), static, in the order of the sliders
    contacts: Records  # (points,), state of the points
    kind: Kind
    moving_load: bool = False
    """Prescribed speed without friction: the run continues without contact after a point has left the beam."""
    at_rest: bool = False  # Whether the state is an equilibrium, with depths of the middle of the first step
    restitution: float | None = None
    """Coefficient of hard contact (`impact`): one point with a foot, one-way; None for the other laws."""

    @property
    def bodies(self) -> Bodies:
        """The arrays as the kernels advance them."""
        return Bodies(self.sliders, self.feet, self.points, self.contacts)

    @property
    def springs(self) -> bool:
        """Whether the points have springs in unilateral contact."""
        return self.kind.normal_law == SPRING and self.restitution is None

    def copy(self) -> "Assembly":
        """The same state in arrays of its own, to be advanced."""
        return replace(self, **{name: array.copy() for name, array in self.bodies._asdict().items()})


def run_stages(
    stages: Sequence[Stage],
    z: ComplexArray,
    assembly: Assembly,
    places: Array,
    *,
    accounts: bool = False,
    progress: Progress = lambda steps: None,
) -> "Run":
    """Advance a beam and its sliders through all stages, whose `steps` define step, number of steps and sampling.

    z is the free part of the rows at the start, (n,); the assembly is advanced in place; deflections are sampled at
    `places`, (p,), m; `accounts`: integrate the work of the drive and the loss of the modes; `progress` is called with
    the number of completed steps.
    """
    samples, first = sum(stage.steps.n // stage.steps.every for stage in stages), stages[0]
    run = Run(assembly, samples, len(places) + first.readings.shape[1])
    deflection = first.deflection(z, np.zeros(1), places)
    before = first.rows.energies(first.whole(z, 0.0))
    for i, stage in enumerate(stages):
        z = z if i == 0 else stage.free(z)
        z = stage.whole(run.stage(stage, z, places, accounts, progress), float(run.step * stage.steps.dt))
        if run.stopped != "end":
            break
    after = first.rows.energies(z)
    run.gains, run.accounts = (after[0] - before[0], after[1] - before[1], sum(before)), accounts and not run.left
    run.journal.deflections[0] = deflection
    return run.recorded(z, stage)


class Run:
    """State of a run, its journal and its cost."""

    def __init__(self, assembly: Assembly, samples: int, outputs: int) -> None:
        sliders, feet, points = len(assembly.sliders), len(assembly.feet), len(assembly.points)
        owners = np.zeros(feet, dtype=np.int64)
        if feet:
            owners[assembly.points["foot"]] = assembly.points["slider"]
        self.assembly = assembly
        self.journal = state.Journal(
            progress=np.zeros(1, state.PROGRESS),
            samples=np.zeros((samples + 1, sliders), state.SAMPLE),
            heights=np.zeros((samples + 1, feet, 2)),
            pressures=np.zeros((samples + 1, points)),
            deflections=np.zeros((samples + 1, outputs)),
            places=np.zeros((0, 0)),
            events=np.zeros((EVENTS, 4)),
            sums=np.zeros(sliders, state.SUMS),
            sums_before=np.zeros(sliders, state.SUMS),
            balance=np.zeros(1, state.BALANCE),
            slider_of_foot=owners,
        )
        self.n_steps, self.seconds, self.loop_s, self.set_up_s, self.reach = 0, 0.0, 0.0, 0.0, REACH
        """Number of steps with sliders, and their sum, s; processor time of the loop, and of tables and arrays;
        pieces on each side."""
        self.stopped, self.left, self.end, self.z = "end", False, 0.0, np.empty(0, dtype=complex)
        """"end", a message of `Stage.beyond`, "diverged" or "chatters"; whether a moving load has left the beam; end
        time, s; total state of the rows then."""
        self.gains, self.accounts = (0.0, 0.0, 0.0), False
        """Gains of kinetic and elastic energy of the beam, and its initial energy, J; whether the work of the drive
        and the loss in the beam are computed."""

    @property
    def step(self) -> int:
        """Number of completed steps of the stage."""
        return int(self.journal.progress["step"][0])

    @property
    def events(self) -> Array:
        """(n, 4), those that were recorded."""
        return self.journal.events[: self.n_events]

    @property
    def n_events(self) -> int:
        """Number of events, also beyond the capacity of the journal."""
        return int(self.journal.progress["events"][0])

    def recorded(self, z: ComplexArray, stage: Stage) -> "Run":
        """The run that ended in a stage with the total state z, with the samples that it has.

        Adds the energy of the normal springs at the end of the last step, with depths extrapolated from its middle.
        """
        p, c, feet, dt = self.assembly.points, self.assembly.contacts, self.assembly.feet, stage.steps.dt
        if len(feet):
            foot = feet[p["foot"]]
            rise = foot["velocity_z"] + p["arm"] * foot["pitch_rate"]
            depth = np.maximum(c["depth"] + 0.5 * dt * p["face"] * (c["vz"] - rise), 0.0)
            np.add.at(self.journal.sums["stored"], p["slider"], 0.5 * p["stiffness"] * depth**2)
        n, j = int(self.journal.progress["samples"][0]), self.journal
        ended = {name: getattr(j, name)[:n] for name in ("samples", "heights", "pressures", "deflections")}
        self.journal = j._replace(**ended)
        self.z, self.end = z, stage.origin + self.step * dt
        return self

    def stage(self, stage: Stage, z: ComplexArray, places: Array, accounts: bool, progress: Progress) -> ComplexArray:
        """Advance one stage from free rows z in chunks; the free rows at its end. Sets `stopped`."""
        began, n, rows, self.journal.progress["step"] = thread_time(), len(z), rows_of(stage, z), 0
        columns = n + stage.complex_rows + 2 * stage.powers
        forced, loads, growth = np.zeros((2 * stage.powers, 0)), np.zeros((4, 0)), np.zeros(0)
        if accounts and stage.forced is not None:
            forced, loads = stage.rows.accounts(stage.forced)
            growth = np.array(stage.envelope, dtype=float)
        kept = state.Accounts(accounts, forced, loads, growth, np.zeros(loads.shape[1]))
        if self.journal.deflections.shape[1]:
            self.journal = self.journal._replace(places=np.ascontiguousarray(stage.outputs(places).T))
        response = response_of(self.assembly, n + stage.complex_rows)
        drive, factors = state.Harmonic(stage.omega, stage.origin, stage.unit_s), np.zeros((4, 2, columns))
        first, reason = self._around(stage), state.DONE
        while first is not None and self.step < stage.steps.n and reason not in (state.NOT_FINITE, state.CHATTERS):
            table, edges = stage.table(*first), stage.edges[first[0] : first[1] + 1] - self.assembly.start
            marks = np.full(len(table), -1, dtype=np.int64)
            surface = state.Surface(table, edges, factors, np.zeros((len(table), 2, stage.degree + 1)), marks)
            self.assembly.contacts["piece"] = np.searchsorted(edges[1:-1], self.positions())
            self.set_up_s += thread_time() - began
            beam = state.Beam(rows, stage.complex_rows, drive, surface)
            reason = self._march(stage, beam, response, kept, progress)
            if self.step < stage.steps.n:
                began, last, self.reach = thread_time(), first, min(2 * self.reach, FARTHEST)
                first = None if (around := self._around(stage)) == last else around
        self.z, self.seconds = rows.z_re + 1j * rows.z_im, self.seconds + self.step * stage.steps.dt
        if reason in (state.NOT_FINITE, state.CHATTERS):
            self.stopped = "diverged" if reason == state.NOT_FINITE else "chatters"
        elif self.step < stage.steps.n:
            if self.assembly.moving_load:
                self._go_on(stage, places)
            else:
                x = self.assembly.start + self.positions()
                self.stopped = stage.beyond(float(x.min()), float(x.max()))
        return self.z

    def _march(
        self, stage: Stage, beam: state.Beam, response: Response | None, accounts: state.Accounts, progress: Progress
    ) -> int:
        """Chunks of steps on one table; why they end."""
        from verify.dynamics.impact import Ground, advance_impacts
        from verify.dynamics.integrator import advance

        steps, kind, bodies, reason = stage.steps, self.assembly.kind, self.assembly.bodies, state.DONE
        hard, ground = self.assembly.restitution, Ground(beam, np.zeros((3, beam.surface.table.shape[2])))
        given = steps.dt, kind, beam, bodies, response, accounts, self.journal
        if not self.journal.progress["samples"][0]:
            if hard is None:
                advance(0, 1, *given)
            self.sample_first()
        while reason == state.DONE and self.step < steps.n:
            began, begun, n = thread_time(), self.step, min(CHUNK, steps.n - self.step)
            if hard is None:
                reason = advance(n, steps.every, *given)
            else:
                reason = advance_impacts(n, steps.every, steps.dt, hard, kind, ground, bodies, self.journal)
            self.loop_s += thread_time() - began
            self.n_steps += self.step - begun
            progress(self.n_steps)
        return int(reason)

    def sample_first(self) -> None:
        """Complete the sample before the first step, of feet by the depths; their friction starts in the first step."""
        assembly, sample, journal = self.assembly, self.journal.samples[0], self.journal
        sample["speed"], sample["travelled"] = assembly.sliders["v"], assembly.sliders["x"]
        sample["contact_fraction"] = 1.0
        if assembly.kind.normal_law == SPRING:
            owner, stiffness = assembly.points["slider"], assembly.points["stiffness"]
            depth = np.maximum(assembly.contacts["depth" if assembly.at_rest else "depth_before"], 0.0)
            sample["normal_force"] = np.bincount(owner, stiffness * depth, len(sample))
            journal.sums["stored"] = -0.5 * np.bincount(owner, stiffness * depth**2, len(sample))
            sample["surface_speed"] = np.nan
            journal.pressures[0] = stiffness * np.maximum(assembly.contacts["depth"], 0.0)
        journal.heights[0] = np.transpose([assembly.feet["height"], assembly.feet["pitch"]])
        journal.progress["samples"] = 1

    def positions(self) -> Array:
        """Positions of the points relative to `start`, (points,), m; with feet half a step ahead."""
        points = self.assembly.points
        return np.asarray(self.assembly.sliders["x"][points["slider"]] + points["offset"])

    def _around(self, stage: Stage) -> tuple[int, int] | None:
        """(first, end) piece around all points; None where a point is off the beam."""
        edges, x = stage.edges - self.assembly.start, self.positions()
        if (least := x.min()) < edges[0] or (most := x.max()) > edges[-1]:
            return None
        pieces = len(edges) - 1
        low, high = (min(int(i) - 1, pieces - 1) for i in np.searchsorted(edges, [least, most], side="right"))
        return max(low - self.reach, 0), min(high + 1 + self.reach, pieces)

    def _go_on(self, stage: Stage, places: Array) -> None:
        """Advance the beam to the end of the stage after a moving load has left it."""
        begun, dt, every, journal = self.step, stage.steps.dt, stage.steps.every, self.journal
        rest = np.arange(begun // every + 1, stage.steps.n // every + 1) * every
        row, sliders = int(journal.progress["samples"][0]), self.assembly.sliders
        rows, since = slice(row, row + len(rest)), np.asarray((rest - begun) * dt, dtype=float)
        free = stage.rows.after(self.z, since)
        journal.deflections[rows] = stage.factors(free, since + begun * dt) @ stage.outputs(places)
        journal.samples["travelled"][rows] = sliders["x"] + np.multiply.outer(since, sliders["v"])
        journal.samples["speed"][rows] = sliders["v"]
        sliders["x"] += (stage.steps.n - begun) * dt * sliders["v"]
        self.z = stage.rows.after(self.z, (stage.steps.n - begun) * dt)
        journal.progress["step"], journal.progress["samples"] = stage.steps.n, row + len(rest)
        self.left = True


def response_of(assembly: Assembly, columns: int) -> Response | None:
    """Working space of the response of a beam of so many columns; None with one-way coupling."""
    n = len(assembly.points)
    if not assembly.kind.two_way:
        return None
    return Response(np.zeros((4, n, columns)), np.zeros(columns), np.zeros((2, n, n)), np.zeros((n, n + 1)))


def rows_of(stage: Stage, z: ComplexArray) -> state.Rows:
    """The rows of a stage in state z, as the kernels advance them."""
    rate, dt = stage.rows.rates, stage.steps.dt
    grown = np.expm1(rate * dt)
    gain = stage.rows.participations * np.where(rate == 0.0, dt, grown / np.where(rate == 0.0, 1.0, rate))
    coarse = abs(rate) * dt > RESOLVED
    end = np.where(coarse, gain / dt, stage.rows.participations * grown)
    pairs = (part for value in (z, rate, np.exp(0.5 * rate * dt), gain, end) for part in (value.real, value.imag))
    return state.Rows(*np.array([*pairs, coarse]))  # in the order of `Rows`
