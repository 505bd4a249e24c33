"""Driver of the compiled contact engine: rows and tables of a stage, chunks of the loop, raw samples."""

from collections.abc import Callable, Sequence
from time import thread_time

import msgspec
import numpy as np
from msgspec.structs import asdict, replace

from verify.arrays import Array, ComplexArray, Indices
from verify.dynamics import layout as lay
from verify.dynamics.linear_system import Stage

CHUNK = 20_000
"""Number of steps between checks for an interrupt."""
EVENTS = 20_000
"""Capacity of the event log."""
SPANS = 12
"""Largest number of spans between events in a step, as in `friction`."""
RESOLVED = 1.5
"""Phase or decay of a row per step, rad or neper, above which rates are means over the step."""
REACH, FARTHEST = 2, 128
"""Number of pieces of a table on each side of the points: in the first table, and at most; each doubles the last."""


class Contacts(msgspec.Struct, eq=False, kw_only=True):
    """Sliders with their points on a beam, as arrays in the columns of `layout`; advanced in place by `run_stages`.

    `contact_assembly` fills them in once; every run advances a `copy`.
    """

    start: float
    """Initial position of the first slider, m, the origin of distances and edges, so that nanometres are exact."""
    sliders: Array
    """(sliders, SLIDER)"""
    feet: Array
    """(feet, FOOT); (0, FOOT) for points without feet."""
    points: Array
    """(points, POINT), in the order of the sliders; OFFSET is measured from `start` for the points of all sliders."""
    contacts: Array
    """(points, CONTACT)"""
    indices: Indices
    """(points, 3)"""
    law: int
    """GIVEN, BILATERAL or SPRING, common to all points."""
    two_way: bool
    normal_two_way: bool
    """Whether normal forces act on the beam of a two-way run."""
    following: bool = False
    gravity: float = 0.0
    """m/s^2, along the slope for kinematics "following"."""
    moving_load: bool = False
    """Prescribed speed without friction: the run continues without contact after a point has left the beam."""
    at_rest: bool = False
    """Whether the state is an equilibrium, with depths of the middle of the first step."""
    restitution: float | None = None
    """Coefficient of hard contact (`impact`): one point with a foot, one-way; None for the other laws."""

    def copy(self) -> "Contacts":
        """The same state in arrays of its own, to be advanced."""
        return replace(self, **{k: v.copy() for k, v in asdict(self).items() if isinstance(v, np.ndarray)})


def run_stages(
    stages: Sequence[Stage],
    z: ComplexArray,
    contacts: Contacts,
    places: Array,
    *,
    accounts: bool = False,
    progress: Callable[[int], None] = lambda steps: None,
) -> "Run":
    """Advance a beam and its sliders through all stages, whose `steps` define step, number of steps and sampling.

    z is the free part of the rows at the start, (n,); contacts are advanced in place; deflections are sampled at
    `places`, (p,), m; `accounts`: integrate the work of the drive and the loss of the modes; `progress` is called with
    the number of completed steps.
    """
    run = Run(stages, contacts, places, accounts)
    stopped = "end"
    for i, stage in enumerate(stages):
        z = z if i == 0 else stage.free(z)
        stopped = run.stage(stage, z, progress)
        z = stage.whole(run.z, float(run.tally[lay.STEP] * stage.steps.dt))
        if stopped != "end":
            break
    return run.recorded(z, stages[-1].steps.dt, stopped)


class Run:
    """State of a run and its raw samples, events and sums; `first` is the sample before the first step."""

    def __init__(self, stages: Sequence[Stage], contacts: Contacts, places: Array, accounts: bool) -> None:
        samples = sum(stage.steps.n // stage.steps.every for stage in stages)
        n, n_sliders, n_feet = len(contacts.points), len(contacts.sliders), len(contacts.feet)
        self.contacts, self.places, self.accounts = contacts, places, accounts
        self.samples, self.first = np.zeros((samples, n_sliders, lay.OUT)), np.zeros((n_sliders, lay.OUT))
        """`first`: speed; for points without feet also friction and surface speed."""
        self.heights, self.pressures = np.zeros((samples, n_feet, 2)), np.zeros((samples, n))
        """Heights and pitches of the feet; normal forces of the points."""
        self.deflections = np.zeros((samples, len(places) + stages[0].readings.shape[1]))
        self.events, self.n_events = np.zeros((EVENTS, 4)), 0
        """Events (time, kind, point, distance travelled); total number, also beyond the capacity."""
        self.sums, self.before = np.zeros((n_sliders, lay.SUMS)), np.zeros((n_sliders, lay.SUMS))
        self.balance, self.tally = np.zeros(lay.BALANCE), np.zeros(3, dtype=np.int64)
        self.spans, self.block = np.zeros((n, 4 + 2 * SPANS)), np.zeros((n, n + 1))
        self.couplings, self.feet_of = np.zeros((2, n, n)), np.zeros(n_feet, dtype=np.int64)
        if n_feet:
            self.feet_of[contacts.indices[:, lay.OF_FOOT]] = contacts.indices[:, lay.OF_SLIDER]
        self.n_steps, self.loop_s, self.set_up_s, self.reach = 0, 0.0, 0.0, REACH
        """Number of steps; processor time of the compiled loop, and of tables and arrays; pieces on each side."""
        self.stopped, self.z = "end", np.empty(0, dtype=complex)
        """"end", a message of `Stage.beyond`, "diverged" or "chatters"; the total state of the rows at the end."""

    def recorded(self, z: ComplexArray, dt: float, stopped: str) -> "Run":
        """The run that ended with the total state z, in steps of dt: its samples and events.

        Adds the energy of the normal springs at the end of the last step, with depths extrapolated from its middle.
        """
        p, c, feet, indices = self.contacts.points, self.contacts.contacts, self.contacts.feet, self.contacts.indices
        if len(feet):
            foot = feet[indices[:, lay.OF_FOOT]]
            climb = foot[:, lay.VELOCITY_Z] + p[:, lay.ARM] * foot[:, lay.PITCH_RATE]
            depth = np.maximum(c[:, lay.DEPTH] + 0.5 * dt * p[:, lay.FACE] * (c[:, lay.LIFT] - climb), 0.0)
            np.add.at(self.sums[:, lay.STORED], indices[:, lay.OF_SLIDER], 0.5 * p[:, lay.STIFF] * depth**2)
        for name in ("samples", "heights", "pressures", "deflections"):
            setattr(self, name, getattr(self, name)[: self.tally[lay.SAMPLES]])
        self.n_events = int(self.tally[lay.EVENTS])
        self.events, self.stopped, self.z = self.events[: min(self.n_events, EVENTS)], stopped, z
        return self

    def stage(self, stage: Stage, z: ComplexArray, progress: Callable[[int], None]) -> str:
        """Advance one stage from free rows z in chunks; the reason of its end."""
        from verify.dynamics.integrator import advance

        began, contacts, n = thread_time(), self.contacts, len(z)
        rows, drive = rows_of(stage, z), np.array([stage.omega, stage.origin, stage.unit_s], dtype=float)
        places = np.ascontiguousarray(stage.outputs(self.places).T) if self.deflections.shape[1] else np.zeros((0, 0))
        own = n + stage.complex_rows
        columns = own + 2 * stage.powers
        forced, loads, growth = np.zeros((0, columns - own)), np.zeros((4, 0)), np.zeros(0)
        if self.accounts and stage.forced is not None:
            forced, loads = stage.rows.accounts(stage.forced)
            growth = np.array(stage.envelope, dtype=float)
        codes = np.zeros(lay.CODES, dtype=np.int64)
        codes[[lay.LAW, lay.TWO_WAY]] = contacts.law, contacts.two_way
        codes[[lay.NORMAL_TWO_WAY, lay.FOLLOWING]] = contacts.two_way and contacts.normal_two_way, contacts.following
        codes[[lay.COMPLEX, lay.ACCOUNTS]] = own - n, self.accounts
        factors, two_way = np.zeros((4, 2, columns)), contacts.two_way
        shapes, response = np.zeros((4, len(contacts.points), own if two_way else 0)), np.zeros(own if two_way else 0)
        self.tally[lay.STEP], first = 0, self._around(stage)
        why, steps = "end", self.n_steps
        while first is not None and self.tally[lay.STEP] < stage.steps.n:
            edges = stage.edges[first[0] : first[1] + 1] - contacts.start
            table = stage.table(*first)
            local = np.zeros((len(table), 2, stage.degree + 1))
            stamp, reason = np.full(len(table), -1, dtype=np.int64), lay.DONE
            contacts.indices[:, lay.PIECE] = np.searchsorted(edges[1:-1], self.positions())
            self.set_up_s += thread_time() - began
            arrays = (
                contacts.gravity, codes, drive, rows, table, edges, contacts.sliders, contacts.feet,
                contacts.points, contacts.contacts, contacts.indices, self.feet_of, factors, local, stamp, shapes,
                response, self.couplings, self.spans, self.block, forced, loads, growth, places, self.samples,
                self.heights, self.pressures, self.deflections, self.events, self.tally, self.sums, self.before,
                self.balance,
            )  # fmt: skip
            rigid = contacts.restitution is not None
            if self.n_steps == 0 and not rigid:
                advance(0, 1, stage.steps.dt, *arrays)
                self.sample_first()
            while reason == lay.DONE and self.tally[lay.STEP] < stage.steps.n:
                began = thread_time()
                n_steps = min(CHUNK, stage.steps.n - int(self.tally[lay.STEP]))
                if rigid:
                    reason = self._impacts(n_steps, stage, codes, drive, rows, table, edges, factors, places)
                else:
                    reason = advance(n_steps, stage.steps.every, stage.steps.dt, *arrays)
                self.loop_s += thread_time() - began
                self.n_steps = steps + int(self.tally[lay.STEP])
                progress(self.n_steps)
            if reason in (lay.NOT_FINITE, lay.CHATTERS):
                why = "diverged" if reason == lay.NOT_FINITE else "chatters"
                break
            if self.tally[lay.STEP] < stage.steps.n:
                began, last, self.reach = thread_time(), first, min(2 * self.reach, FARTHEST)
                first = None if (around := self._around(stage)) == last else around
        self.z = rows[lay.Z_RE] + 1j * rows[lay.Z_IM]
        if why == "end" and self.tally[lay.STEP] < stage.steps.n:
            if contacts.moving_load:
                self._go_on(stage)
            else:
                x = contacts.start + self.positions()
                why = stage.beyond(float(x.min()), float(x.max()))
        return why

    def _impacts(
        self, n_steps: int, stage: Stage, codes: Indices, drive: Array, rows: Array, table: Array, edges: Array,
        factors: Array, places: Array,
    ) -> int:  # fmt: skip
        """Steps of hard contact."""
        from verify.dynamics.impact import advance_impacts

        contacts, steps = self.contacts, stage.steps
        columns, motion = np.zeros((3, table.shape[2])), np.zeros(5)
        return int(
            advance_impacts(
                n_steps, steps.every, steps.dt, float(contacts.restitution or 0.0), codes, drive, rows, table, edges,
                contacts.sliders, contacts.feet, contacts.points, contacts.contacts, contacts.indices, factors, columns,
                motion, self.spans, places, self.samples, self.heights, self.pressures, self.deflections, self.events,
                self.tally, self.sums, self.before,
            )
        )  # fmt: skip

    def sample_first(self) -> None:
        """Sample the state before the first step; friction of a slider with feet starts in the first step."""
        sliders, contacts = self.contacts.sliders, self.contacts.contacts
        self.first[:, [lay.OUT_X, lay.OUT_V]] = sliders[:, [lay.X, lay.V]]
        self.first[:, lay.OUT_TOUCH] = 1.0
        if self.contacts.law == lay.SPRING:
            column = lay.DEPTH if self.contacts.at_rest else lay.WAS_DEPTH
            depth, owner = np.maximum(contacts[:, column], 0.0), self.contacts.indices[:, lay.OF_SLIDER]
            load = self.contacts.points[:, lay.STIFF] * depth
            self.first[:, lay.OUT_NORMAL] = np.bincount(owner, load, len(sliders))
            self.sums[:, lay.STORED] = -0.5 * np.bincount(owner, load * depth, len(sliders))
            self.first[:, lay.OUT_SURFACE] = np.nan
            return
        load, steepness = self.contacts.points[:, lay.LOAD], sliders[:, lay.STEEPNESS]
        slip = sliders[:, lay.V] - contacts[:, lay.START]
        law = np.where(steepness > 0.0, np.tanh(steepness * slip), np.sign(slip))
        self.first[:, lay.OUT_FRICTION] = -sliders[:, lay.MU] * load * law * (contacts[:, lay.STUCK] == 0.0)
        self.first[:, lay.OUT_NORMAL], self.first[:, lay.OUT_SURFACE] = load, contacts[:, lay.START]

    def positions(self) -> Array:
        """Positions of the points relative to `start`, (points,), m; with feet half a step ahead."""
        x, owner = self.contacts.sliders[:, lay.X], self.contacts.indices[:, lay.OF_SLIDER]
        return np.asarray(x[owner] + self.contacts.points[:, lay.OFFSET])

    def _around(self, stage: Stage) -> tuple[int, int] | None:
        """(first, end) piece around all points; None where a point is off the beam."""
        edges, x = stage.edges - self.contacts.start, self.positions()
        if (least := x.min()) < edges[0] or (most := x.max()) > edges[-1]:
            return None
        pieces = len(edges) - 1
        low, high = (min(int(i) - 1, pieces - 1) for i in np.searchsorted(edges, [least, most], side="right"))
        return max(low - self.reach, 0), min(high + 1 + self.reach, pieces)

    def _go_on(self, stage: Stage) -> None:
        """Advance the beam to the end of the stage after a moving load has left it."""
        begun, dt = int(self.tally[lay.STEP]), stage.steps.dt
        rest = np.arange(begun // stage.steps.every + 1, stage.steps.n // stage.steps.every + 1) * stage.steps.every
        row, (x, speed) = int(self.tally[lay.SAMPLES]), self.contacts.sliders[:, [lay.X, lay.V]].T
        rows, since = slice(row, row + len(rest)), np.asarray((rest - begun) * dt, dtype=float)
        free = stage.rows.after(self.z, since)
        self.deflections[rows] = stage.factors(free, since + begun * dt) @ stage.outputs(self.places)
        self.samples[rows, :, lay.OUT_X] = x + np.multiply.outer(since, speed)
        self.samples[rows, :, lay.OUT_V] = speed
        self.contacts.sliders[:, lay.X] += (stage.steps.n - begun) * dt * speed
        self.z = stage.rows.after(self.z, (stage.steps.n - begun) * dt)
        self.tally[[lay.STEP, lay.SAMPLES]] = stage.steps.n, row + len(rest)


def rows_of(stage: Stage, z: ComplexArray) -> Array:
    """The rows of a stage in state z in the columns of the kernels, (ROW, n)."""
    rate, dt = stage.rows.rates, stage.steps.dt
    grown = np.expm1(rate * dt)
    gain = stage.rows.participations * np.where(rate == 0.0, dt, grown / np.where(rate == 0.0, 1.0, rate))
    coarse = abs(rate) * dt > RESOLVED
    end = np.where(coarse, gain / dt, stage.rows.participations * grown)
    pairs = (part for value in (z, rate, np.exp(0.5 * rate * dt), gain, end) for part in (value.real, value.imag))
    return np.array([*pairs, coarse])  # in the order of `layout`
