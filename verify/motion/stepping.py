"""The compiled loop, fed piece by piece: windows of polynomials around the slider, stages of the drive, stops."""

from collections.abc import Callable, Sequence
from time import perf_counter, thread_time

import msgspec
import numpy as np

from verify.beam import PointForce
from verify.models.arrays import Array
from verify.models.fields import phasor
from verify.motion import records
from verify.motion.forcing import turns
from verify.motion.records import Books, Drive, Kept, Rider, Space, Surface
from verify.motion.surface import Stage
from verify.motion.windows import Window, Windows, on_beam, table_seconds
from verify.patience import check_taken

CHUNK = 20_000
"""Steps between two looks at the keyboard."""
EVENTS = 20_000


class Sliding(msgspec.Struct, eq=False, kw_only=True):
    """What grows while a slider runs."""

    start: float
    """Where the slider was put, metres; the loop counts from here, so that nanometres keep their digits."""
    rider: Rider
    points: Array
    """Where the deflection is kept, metres."""
    kept: Kept
    """Its points and the steps between samples are each stage's own."""
    accounts: bool
    ledger: Array
    heard: Callable[[Array], None]
    """Hears each table of the beam's pieces that is read on the way."""
    first: Array
    """(1, 5), the sample before any step, `records.KEPT_X` and so on."""
    first_deflection: Array
    """(1, points)."""
    on_its_way: tuple[float, float] | None = None
    """Height and climb of a slider that was held on the surface before; one that is put on takes the surface's."""
    set_down: tuple[float, float] = (0.0, 0.0)
    """Height and climb before the first step."""
    steps_before: int = 0
    """Of the stages that are over."""
    set_up_s: float = 0.0
    """Wall time spent on tables, not on steps."""
    loop_s: float = 0.0
    """Processor time of the compiled loop alone."""

    @classmethod
    def fresh(
        cls,
        start: float,
        samples: int,
        points: Array,
        rider: Rider,
        accounts: bool,
        heard: Callable[[Array], None] = lambda table: None,
    ) -> "Sliding":
        """Room for a run."""
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
            heard=heard,
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
        """Height and climb of a slider that is held on the surface, metres and m/s."""
        return float(self.motion[records.HEIGHT]), float(self.motion[records.CLIMB])

    @property
    def fall(self) -> float:
        """The largest downward acceleration of the surface under the slider so far, m/s^2."""
        return float(self.motion[records.FALL])

    @property
    def n_kept(self) -> int:
        """Samples so far."""
        return int(self.kept.tally[records.SAMPLES])

    @property
    def events(self) -> Array:
        """Those written down so far, (n, 3): time, kind, x."""
        return self.kept.events[: int(self.kept.tally[records.EVENTS])]

    @property
    def n_lost(self) -> int:
        """Events for which there was no room."""
        return int(self.kept.tally[records.EVENTS]) - len(self.events)


def fresh_motion(speed: float = 0.0, stuck: bool = False) -> Array:
    """What a slider carries from step to step at the start, `Rider.motion`."""
    motion = np.zeros(records.HARDEST + 1)
    motion[[records.V, records.STUCK]] = speed, stuck
    return motion


def of_all_steps(motion: Array, mass: float, seconds: float) -> tuple[float, float, float]:
    """(mean friction, newton, the largest of all steps, mean speed of the surface, m/s) of what a slider carries.

    NaN of a run without a step.
    """
    pushed, swept, hardest = (float(motion[of]) for of in (records.PUSHED, records.SWEPT, records.HARDEST))
    mean = 1.0 / seconds if seconds > 0.0 else float("nan")
    return mass * pushed * mean, mass * hardest, swept * mean


def contact_space(rows: int = 0, degree: int = 3) -> Space:
    """Working space of the compiled contact, on a surface of so many rows."""
    return Space(
        factors=np.empty((2, rows)),
        local=np.zeros((3, degree + 1)),
        seen=np.zeros((3, 6)),
        slip=np.zeros(records.FIRST_EVENT + 2 * records.SPANS),
    )


class Feed(msgspec.Struct, frozen=True, eq=False, kw_only=True):
    """The compiled loop's view of one stage."""

    stage: Stage
    modes: Array
    """`Surface.modes`; advanced in place."""
    drive: Drive
    books: Books
    kept: Kept

    @property
    def z(self) -> Array:
        """The free modes now, (2, n)."""
        return self.modes[: records.Z_IM + 1].copy()

    @property
    def space(self) -> Space:
        """Working space, fresh."""
        return contact_space(self.kept.points.shape[1], self.stage.degree)


def feed(stage: Stage, z: Array, forces: Sequence[PointForce], sliding: Sliding) -> Feed:
    """What one stage with free modes z gives to the loop."""
    modes = np.zeros((records.READ + 1, z.shape[1]))
    modes[[records.Z_RE, records.Z_IM]] = z
    modes[records.SIGMA], modes[records.OMEGA] = stage.modal.sigmas, stage.modal.omegas
    modes[[records.HALF_RE, records.HALF_IM]] = turns(stage.modal, 0.5 * stage.dt)
    modes[[records.FULL_RE, records.FULL_IM]] = turns(stage.modal, stage.dt)
    return Feed(
        stage=stage,
        modes=modes,
        drive=Drive(
            omega=float(stage.omega),
            origin=float(stage.origin),
            unit=float(stage.unit_s),
            growth=np.array(stage.growth, dtype=float),
        ),
        books=_books(stage, forces, sliding),
        kept=sliding.kept._replace(every=stage.every, points=np.ascontiguousarray(stage.rows(sliding.points).T)),
    )


def _books(stage: Stage, forces: Sequence[PointForce], sliding: Sliding) -> Books:
    """What the work of the forces is reckoned from."""
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


def slider_seconds(steps: float, rows: int, two_way: bool) -> float:
    """An estimate from above of the time the loop takes: so much for a step, and for each mode that it advances."""
    return steps * (8e-6 + 6e-8 * rows if two_way else 1.5e-6 + 1.5e-8 * rows)


class Waited(msgspec.Struct, eq=False, kw_only=True):
    """What a slider's runs take, one after another: steps that are begun, and what they read of the beam on the way."""

    rows: int
    two_way: bool
    duration: float | None
    """Seconds of the motion, refused where the runs take longer than is waited for; None however long they take."""
    steps: int = 0
    reading_s: float = 0.0

    def seconds(self, steps: float) -> float:
        """An estimate from above of so many steps and all that was read."""
        return slider_seconds(steps, self.rows, self.two_way) + self.reading_s

    def read(self, table: Array) -> None:
        """Hear of a table of the beam's pieces. Raises InputError where it is too much."""
        self.reading_s += table_seconds(table)
        if self.duration is not None:
            remedy = "the slider comes by ever more of the beam, shorten it or keep fewer modes"
            check_taken("duration", self.duration, self.seconds(self.steps), remedy)


def look(fed: Feed, around: Window, sliding: Sliding) -> None:
    """The first sample: the slider as it is put on, before any step; a slider on its way keeps its height and climb."""
    from verify.motion import kernels

    kept = fed.kept._replace(
        every=1, kept=sliding.first, deflections=sliding.first_deflection, tally=np.zeros_like(fed.kept.tally)
    )
    surface = Surface(fed.modes, fed.drive, *around)
    kernels.slide(0, fed.stage.dt, surface, sliding.rider, fed.books, kept, fed.space)
    if sliding.on_its_way is not None:
        sliding.motion[records.HEIGHT], sliding.motion[records.CLIMB] = sliding.on_its_way
    sliding.set_down = sliding.held


def run_stages(
    stages: Sequence[Stage],
    z: Array,
    sliding: Sliding,
    forces: Sequence[PointForce],
    tell: Callable[[int], None],
) -> tuple[str, Array, Array]:
    """Run through all stages from free modes z; (why it stopped, q, dq/dt of the modes then).

    `tell` hears the steps done.
    """
    stopped, state = "end", (np.empty(0), np.empty(0))
    for i, stage in enumerate(stages):
        began = perf_counter()
        fed = feed(stage, z if i == 0 else stage.start(*state), forces, sliding)
        windows = Windows(stage, sliding.start, sliding.heard)
        around = windows.around(float(sliding.motion[records.X]))
        if i == 0 and around:
            look(fed, around, sliding)
        sliding.set_up_s += perf_counter() - began
        sliding.steps_before, sliding.kept.tally[records.STEP] = sliding.steps, 0
        try:
            stopped = _run_stage(fed, windows, around, sliding, tell)
        except KeyboardInterrupt:
            stopped = "interrupted"
        state = stage.state(fed.z, int(sliding.kept.tally[records.STEP]) * stage.dt)
        if stopped != "end":
            break
    return stopped, *state


def _run_stage(
    fed: Feed, windows: Windows, around: Window | None, sliding: Sliding, tell: Callable[[int], None]
) -> str:
    """One stage in chunks; why it ended. The loop keeps its own books, so that an interrupt finds them closed."""
    from verify.motion import kernels

    s, stage, space = sliding, fed.stage, fed.space
    done, motion = s.kept.tally, s.motion
    while around and done[records.STEP] < stage.n_steps:
        steps = min(CHUNK, stage.n_steps - int(done[records.STEP]))
        surface = Surface(fed.modes, fed.drive, *around)
        began = thread_time()
        why = kernels.slide(steps, stage.dt, surface, s.rider, fed.books, fed.kept, space)
        s.loop_s += thread_time() - began
        tell(s.steps)
        if why == records.NOT_FINITE:
            return "diverged"
        if why == records.OFF_PIECES:
            began = perf_counter()
            around = windows.around(float(motion[records.X]))
            s.set_up_s += perf_counter() - began
    at = float(motion[records.X])
    return "end" if around and on_beam(stage, s.start, at) else stage.beyond(s.start + at, s.start + at)
