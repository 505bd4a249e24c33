"""The compiled loop of one slider, stage by stage, on tables of the beam's pieces around the slider."""

from collections.abc import Callable, Sequence
from time import perf_counter, thread_time

import msgspec
import numpy as np

from verify.arrays import Array
from verify.linear.field import phasor
from verify.motion import records
from verify.motion.forcing import turns
from verify.motion.records import Books, Drive, Kept, Rider, Space, Surface
from verify.motion.surface import Stage
from verify.problem.beam import PointForce

CHUNK = 20_000
"""Steps between two checks for an interrupt."""
EVENTS = 20_000
REACH = 1
"""Pieces in a table on each side of those that the slider is among."""
WIDEST = 32
"""Largest table in pieces."""
MOST_BYTES = 2**27
"""Of all tables in the cache."""
Window = tuple[Array, Array]
"""Polynomials of some pieces, (pieces, degree + 1, rows), and their edges, metres."""


class Sliding(msgspec.Struct, eq=False, kw_only=True):
    """State and samples of a slider's run."""

    start: float
    """Initial position, metres; the loop counts from here, so that nanometres keep their digits."""
    rider: Rider
    points: Array
    """Where the deflection is sampled, metres."""
    kept: Kept
    """`points` and `every` are each stage's own."""
    accounts: bool
    ledger: Array
    first: Array
    """(1, 5), the sample before any step, `records.KEPT_X` and so on."""
    first_deflection: Array
    """(1, points)."""
    on_its_way: tuple[float, float] | None = None
    """Height and climb of a slider that continues on the surface; a new one takes the surface's."""
    set_down: tuple[float, float] = (0.0, 0.0)
    """Height and climb before the first step."""
    steps_before: int = 0
    """Of finished stages."""
    set_up_s: float = 0.0
    """Wall time of tables."""
    loop_s: float = 0.0
    """Processor time of the compiled loop."""

    @classmethod
    def fresh(cls, start: float, samples: int, points: Array, rider: Rider, accounts: bool) -> "Sliding":
        """Arrays for a run."""
        return cls(
            start=start,
            rider=rider,
            points=points,
            kept=Kept(
                every=1,
                kept=np.zeros((samples, 5)),
                points=np.empty((0, 0)),
                deflections=np.zeros((samples, len(points))),
                events=np.zeros((EVENTS, 3)),
                tally=np.zeros(3, dtype=np.int64),
            ),
            accounts=accounts,
            ledger=np.zeros(records.TURNED + 1),
            first=np.zeros((1, 5)),
            first_deflection=np.zeros((1, len(points))),
        )

    @property
    def motion(self) -> Array:
        """(10,), `records.X` and so on."""
        return self.rider.motion

    @property
    def steps(self) -> int:
        """Of all stages so far."""
        return self.steps_before + int(self.kept.tally[records.STEP])

    @property
    def held(self) -> tuple[float, float]:
        """Height and climb of a slider held on the surface, metres and m/s."""
        return float(self.motion[records.HEIGHT]), float(self.motion[records.CLIMB])

    @property
    def n_kept(self) -> int:
        """Samples so far."""
        return int(self.kept.tally[records.SAMPLES])

    @property
    def events(self) -> Array:
        """Recorded events so far, (n, 3): time, kind, x."""
        return self.kept.events[: int(self.kept.tally[records.EVENTS])]

    @property
    def n_lost(self) -> int:
        """Events beyond the capacity."""
        return int(self.kept.tally[records.EVENTS]) - len(self.events)


def fresh_motion(speed: float = 0.0, stuck: bool = False) -> Array:
    """`Rider.motion` at the start."""
    motion = np.zeros(records.HARDEST + 1)
    motion[[records.V, records.STUCK]] = speed, stuck
    return motion


def of_all_steps(motion: Array, mass: float, seconds: float) -> tuple[float, float, float]:
    """(mean friction, newton, largest friction of all steps, mean speed of the surface, m/s); NaN without a step."""
    pushed, swept, hardest = (float(motion[of]) for of in (records.PUSHED, records.SWEPT, records.HARDEST))
    mean = 1.0 / seconds if seconds > 0.0 else float("nan")
    return mass * pushed * mean, mass * hardest, swept * mean


def contact_space(rows: int = 0, degree: int = 3) -> Space:
    """Working space of the kernels, on a surface of so many rows."""
    return Space(
        factors=np.empty((2, rows)),
        local=np.zeros((3, degree + 1)),
        seen=np.zeros((3, 6)),
        slip=np.zeros(records.FIRST_EVENT + 2 * records.SPANS),
    )


def modal_rows(stage: Stage, z: Array) -> Array:
    """`Surface.modes` of a stage with free modes z."""
    modes = np.zeros((records.READ + 1, z.shape[1]))
    modes[[records.Z_RE, records.Z_IM]] = z
    modes[records.SIGMA], modes[records.OMEGA] = stage.modal.sigmas, stage.modal.omegas
    modes[[records.HALF_RE, records.HALF_IM]] = turns(stage.modal, 0.5 * stage.dt)
    modes[[records.FULL_RE, records.FULL_IM]] = turns(stage.modal, stage.dt)
    return modes


def drive_of(stage: Stage) -> Drive:
    """The drive of a stage as the kernels read it."""
    growth = np.array(stage.growth, dtype=float)
    return Drive(omega=float(stage.omega), origin=float(stage.origin), unit=float(stage.unit_s), growth=growth)


def _books(stage: Stage, forces: Sequence[PointForce], sliding: Sliding) -> Books:
    amplitudes = np.array([phasor(f) for f in forces], dtype=complex)
    loads = np.zeros((len(forces), len(stage.rows(np.zeros(1)))))
    for row, force in zip(loads, forces, strict=True):
        row[:] = stage.load_rows(force.position)
    return Books(
        open=sliding.accounts,
        loads=loads,
        forces=np.array([amplitudes.real, amplitudes.imag]),
        answers=stage.answers,
        ledger=sliding.ledger,
    )


def on_beam(stage: Stage, start: float, travelled: float) -> bool:
    """Whether start + travelled lies on the beam, compared as in the loop, by distances from the start."""
    return bool(stage.edges[0] - start <= travelled <= stage.edges[-1] - start)


class Windows(msgspec.Struct, eq=False):
    """Tables of one stage around a slider that started at `start`, metres, in a cache."""

    stage: Stage
    start: float
    size: int = 1
    """Pieces of the next table: twice those of the one before."""
    kept: dict[tuple[int, int], Window] = msgspec.field(default_factory=dict)

    def around(self, travelled: float) -> Window | None:
        """The polynomials around start + travelled, their edges counted from start; None off the beam."""
        if not on_beam(self.stage, self.start, travelled):
            return None
        edges = self.stage.edges - self.start
        pieces = len(edges) - 1
        here = int(np.clip(np.searchsorted(edges, travelled, side="right") - 1, 0, pieces - 1))
        first = here // self.size * self.size
        span = max(first - REACH, 0), min(first + self.size + REACH, pieces)
        self.size = min(2 * self.size, WIDEST)
        if span not in self.kept:
            table = self.stage.table(*span)
            if sum(one.nbytes for one, _ in self.kept.values()) + table.nbytes > MOST_BYTES:
                self.kept.clear()
            self.kept[span] = table, edges[span[0] : span[1] + 1]
        return self.kept[span]


def run_stages(
    stages: Sequence[Stage],
    z: Array,
    sliding: Sliding,
    forces: Sequence[PointForce],
    progress: Callable[[int], None],
) -> tuple[str, Array, Array]:
    """Run through all stages from free modes z; (why it stopped, q, dq/dt of the modes then).

    `progress` is called with the number of steps done.
    """
    stopped, state = "end", (np.empty(0), np.empty(0))
    for i, stage in enumerate(stages):
        began = perf_counter()
        modes = modal_rows(stage, z if i == 0 else stage.start(*state))
        surface = Surface(modes, drive_of(stage), np.zeros((0, 0, 0)), np.zeros(0))
        books = _books(stage, forces, sliding)
        kept = sliding.kept._replace(every=stage.every, points=np.ascontiguousarray(stage.rows(sliding.points).T))
        windows = Windows(stage, sliding.start)
        around = windows.around(float(sliding.motion[records.X]))
        if i == 0 and around:
            _first_sample(stage, surface, around, books, kept, sliding)
        sliding.set_up_s += perf_counter() - began
        sliding.steps_before, sliding.kept.tally[records.STEP] = sliding.steps, 0
        try:
            stopped = _run_stage(stage, surface, windows, around, books, kept, sliding, progress)
        except KeyboardInterrupt:  # the loop advances all arrays together, so that they agree here
            stopped = "interrupted"
        z = modes[: records.Z_IM + 1].copy()
        state = stage.state(z, int(sliding.kept.tally[records.STEP]) * stage.dt)
        if stopped != "end":
            break
    return stopped, *state


def _first_sample(stage: Stage, surface: Surface, around: Window, books: Books, kept: Kept, sliding: Sliding) -> None:
    """The slider before any step; one that continues on the surface keeps its height and climb."""
    from verify.motion import kernels

    kept = kept._replace(
        every=1, kept=sliding.first, deflections=sliding.first_deflection, tally=np.zeros_like(kept.tally)
    )
    surface = surface._replace(table=around[0], edges=around[1])
    space = contact_space(kept.points.shape[1], stage.degree)
    kernels.slide(0, stage.dt, surface, sliding.rider, books, kept, space)
    if sliding.on_its_way is not None:
        sliding.motion[records.HEIGHT], sliding.motion[records.CLIMB] = sliding.on_its_way
    sliding.set_down = sliding.held


def _run_stage(
    stage: Stage,
    surface: Surface,
    windows: Windows,
    around: Window | None,
    books: Books,
    kept: Kept,
    sliding: Sliding,
    progress: Callable[[int], None],
) -> str:
    """One stage in chunks; why it ended."""
    from verify.motion import kernels

    space = contact_space(kept.points.shape[1], stage.degree)
    done, motion = kept.tally, sliding.motion
    while around and done[records.STEP] < stage.n_steps:
        steps = min(CHUNK, stage.n_steps - int(done[records.STEP]))
        surface = surface._replace(table=around[0], edges=around[1])
        began = thread_time()
        why = kernels.slide(steps, stage.dt, surface, sliding.rider, books, kept, space)
        sliding.loop_s += thread_time() - began
        progress(sliding.steps)
        if why == records.NOT_FINITE:
            return "diverged"
        if why == records.OFF_PIECES:
            reading = perf_counter()
            around = windows.around(float(motion[records.X]))
            sliding.set_up_s += perf_counter() - reading
    at = float(motion[records.X])
    if around and on_beam(stage, sliding.start, at):
        return "end"
    return stage.beyond(sliding.start + at, sliding.start + at)
