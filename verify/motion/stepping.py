"""The compiled loop, fed piece by piece: windows of polynomials around the slider, stages of the drive, stops."""

from collections.abc import Callable, Sequence
from time import perf_counter

import msgspec
import numpy as np

from verify.beam import PointForce
from verify.models.arrays import Array, Indices
from verify.models.fields import phasor
from verify.motion.forcing import turns
from verify.motion.surface import Stage

CHUNK = 20_000
"""Steps between two looks at the keyboard."""
REACH = 1
"""Pieces of the beam kept ready on each side of the slider."""
EVENTS = 20_000


class Sliding(msgspec.Struct, eq=False, kw_only=True):
    """What grows while a slider runs."""

    start: float
    """Where the slider was put, metres; the loop counts from here, so that nanometres keep their digits."""
    motion: Array
    """(7,): distance travelled, v, whether it sticks and so on, `contact_kernels.X` to `FALL`."""
    law: Array
    two_way: bool
    points: Array
    kept: Array
    """(samples, 5): distance travelled, v, friction per mass, speed of the surface, normal reaction on the slider."""
    deflections: Array
    events: Array
    accounts: bool
    ledger: Array
    first: Array
    first_deflection: Array
    tally: Indices
    """(3,): steps of the present stage, samples and events so far; advanced by the loop together with the motion."""
    on_its_way: tuple[float, float] | None = None
    """Height and climb of a slider that was held on the surface before; one that is put on takes the surface's."""
    steps_before: int = 0
    """Of the stages that are over."""
    set_up_s: float = 0.0
    """Wall time spent on tables, not on steps."""

    @classmethod
    def fresh(cls, start: float, samples: int, points: Array, law: Array, two_way: bool, accounts: bool) -> "Sliding":
        """Room for a run."""
        return cls(
            start=start,
            motion=fresh_motion(),
            law=law,
            two_way=two_way,
            points=points,
            kept=np.zeros((samples, 5)),
            deflections=np.zeros((samples, len(points))),
            events=np.zeros((EVENTS, 3)),
            accounts=accounts,
            ledger=np.zeros(6),
            first=np.zeros(5),
            first_deflection=np.zeros(len(points)),
            tally=np.zeros(3, dtype=np.int64),
        )

    @property
    def steps(self) -> int:
        """Of all stages so far."""
        return self.steps_before + int(self.tally[0])

    @property
    def held(self) -> tuple[float, float]:
        """Height and climb of a slider that is held on the surface, metres and m/s."""
        return float(self.motion[3]), float(self.motion[4])

    @property
    def fall(self) -> float:
        """The largest downward acceleration of the surface under the slider so far, m/s^2."""
        return float(self.motion[6])

    @property
    def n_kept(self) -> int:
        """Samples so far."""
        return int(self.tally[1])

    @property
    def n_events(self) -> int:
        """Events written down so far."""
        return min(int(self.tally[2]), len(self.events))

    @property
    def n_lost(self) -> int:
        """Events for which there was no room."""
        return max(int(self.tally[2]) - len(self.events), 0)


def fresh_motion(speed: float = 0.0, stuck: bool = False) -> Array:
    """What a slider carries from step to step at the start, (7,)."""
    return np.array([0.0, speed, float(stuck), 0.0, 0.0, 0.0, 0.0])


def contact_space() -> tuple[Array, Array]:
    """Working space of the compiled contact: what is seen at three times of a step, and how the slider slips."""
    return np.zeros((3, 6)), np.zeros(45)


class Feed(msgspec.Struct, frozen=True, eq=False, kw_only=True):
    """The compiled loop's view of one stage."""

    stage: Stage
    modes: Array
    """(11, n), see `contact_kernels.Z_RE`; advanced in place."""
    drive: Array
    loads: Array
    forces: Array
    answers: Array
    """(n, drive rows): the forced part of every mode over the drive's time factors; zero in a steady field."""
    points: Array

    @property
    def z(self) -> Array:
        """The free modes now, (2, n)."""
        return self.modes[:2].copy()


def feed(stage: Stage, z: Array, forces: Sequence[PointForce], points: Array) -> Feed:
    """Arrays for one stage with free modes z."""
    modes = np.zeros((11, z.shape[1]))
    modes[0:2], modes[2], modes[3] = z, stage.modal.sigmas, stage.modal.omegas
    modes[4:6], modes[6:8] = turns(stage.modal, 0.5 * stage.dt), turns(stage.modal, stage.dt)
    amplitudes = np.array([phasor(f) for f in forces], dtype=complex)
    loads = np.zeros((len(forces), len(stage.rows(np.zeros(1)))))
    for row, force in zip(loads, forces, strict=True):
        row[:] = stage.load_rows(force.position)
    return Feed(
        stage=stage,
        modes=modes,
        loads=loads,
        drive=np.array([stage.omega, stage.origin, stage.unit_s, *stage.growth]),
        forces=np.array([amplitudes.real, amplitudes.imag]),
        answers=stage.answers,
        points=np.ascontiguousarray(stage.rows(points).T),
    )


def slider_seconds(steps: float, rows: int, two_way: bool) -> float:
    """An estimate from above of the time the loop takes: so much for a step, and for each mode that it advances."""
    return steps * (8e-6 + 6e-8 * rows if two_way else 1.5e-6 + 1.5e-8 * rows)


Window = tuple[Array, Array]
"""Polynomials of the pieces around the slider, (pieces, degree + 1, rows), and their edges, metres."""


def on_beam(stage: Stage, start: float, travelled: float) -> bool:
    """Whether start + travelled lies on the beam, judged as the loop does, in distances from the start."""
    return bool(stage.edges[0] - start <= travelled <= stage.edges[-1] - start)


def window(stage: Stage, start: float, travelled: float) -> Window | None:
    """The polynomials around start + travelled, their edges counted from start; None off the beam."""
    if not on_beam(stage, start, travelled):
        return None
    edges = stage.edges - start
    pieces = len(edges) - 1
    here = int(np.clip(np.searchsorted(edges, travelled, side="right") - 1, 0, pieces - 1))
    first, last = max(here - REACH, 0), min(here + REACH + 1, pieces)
    return stage.table(first, last), edges[first : last + 1]


def room(fed: Feed) -> tuple[Array, Array, Array, Array]:
    """Working space of the compiled loop: time factors, local polynomials, what is seen, how it slips."""
    rows = fed.points.shape[1]
    return np.empty((2, rows)), np.zeros((3, fed.stage.degree + 1)), *contact_space()


def look(fed: Feed, around: Window, sliding: Sliding) -> None:
    """The first sample: the slider as it is put on, before any step; a slider on its way keeps its height and climb."""
    from verify.motion import kernels

    speed, friction = kernels.look(fed.modes, fed.drive, *around, sliding.motion, sliding.law, *room(fed)[:3])
    sliding.first[:] = sliding.motion[0], sliding.motion[1], friction, speed, sliding.motion[5]
    if sliding.on_its_way is not None:
        sliding.motion[kernels.HEIGHT], sliding.motion[kernels.CLIMB] = sliding.on_its_way
    if len(sliding.points):
        sliding.first_deflection[:] = fed.stage.deflection(fed.z, np.zeros(1), sliding.points)[0]


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
        fed = feed(stage, z if i == 0 else stage.start(*state), forces, sliding.points)
        around = window(stage, sliding.start, float(sliding.motion[0]))
        if i == 0 and around:
            look(fed, around, sliding)
        sliding.set_up_s += perf_counter() - began
        sliding.steps_before, sliding.tally[0] = sliding.steps, 0
        try:
            stopped = _run_stage(fed, around, sliding, tell)
        except KeyboardInterrupt:
            stopped = "interrupted"
        state = stage.state(fed.z, int(sliding.tally[0]) * stage.dt)
        if stopped != "end":
            break
    return stopped, *state


def _run_stage(fed: Feed, around: Window | None, sliding: Sliding, tell: Callable[[int], None]) -> str:
    """One stage in chunks; why it ended. The loop keeps its own books, so that an interrupt finds them closed."""
    from verify.motion import kernels

    s, stage, space = sliding, fed.stage, room(fed)
    while around and s.tally[0] < stage.n_steps:
        why = kernels.slide(
            min(CHUNK, stage.n_steps - s.tally[0]),
            stage.dt,
            fed.modes,
            fed.drive,
            *around,
            s.motion,
            s.law,
            s.two_way,
            fed.loads,
            fed.forces,
            fed.answers,
            s.accounts,
            s.ledger,
            stage.every,
            s.kept,
            fed.points,
            s.deflections,
            s.events,
            s.tally,
            *space,
        )
        tell(s.steps)
        if why == kernels.NOT_FINITE:
            return "diverged"
        if why == kernels.OFF_PIECES:
            began = perf_counter()
            around = window(stage, s.start, float(s.motion[0]))
            s.set_up_s += perf_counter() - began
    return "end" if around and on_beam(stage, s.start, float(s.motion[0])) else "left the beam"
