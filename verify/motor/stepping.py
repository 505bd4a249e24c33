"""The compiled loop of a slider on feet, fed stage by stage."""

from collections.abc import Callable, Sequence

import msgspec
import numpy as np

from verify.arrays import Array, Indices
from verify.linear.surface import LEFT_BEAM, section_at
from verify.motion.records import Surface
from verify.motion.request import Request
from verify.motion.result import END
from verify.motion.stepping import CHUNK, drive_of, modal_rows
from verify.motion.surface import Stage
from verify.motor import records
from verify.motor.feet import Placed, feet_of, fresh_log, hard_of, rubbing_of
from verify.motor.records import BeamAnswer, Feet, GivenSurface, Hard, Line, Log, Rubbing
from verify.problem.beam import Beam


class Riding(msgspec.Struct, eq=False, kw_only=True):
    """What grows while a slider runs."""

    feet: Feet
    rubbing: Rubbing
    log: Log
    before: Array
    """(points, 2), depth and sticking at the last mid-step."""
    start: float
    points: Array
    """(p,), metres: where the deflection is kept."""
    two_way: bool
    placed: tuple[Placed, ...]
    hard: Hard | None
    """None of a contact on springs."""
    at_start: Array | None = None
    """`energy` before the first step."""
    put_down: Array
    """(feet, 4), their state before the first step."""
    set_off: Array
    """(sliders, 2), distance travelled and speed then."""
    pressed: Array
    """(points,), normal force of the springs then, newton."""
    steps_before: int = 0
    first: Array | None = None
    """(p,), the deflection at the start."""

    @classmethod
    def fresh(cls, placed: Sequence[Placed], request: Request, two_way: bool) -> "Riding":
        """Room for a run."""
        samples, feet = sum(piece.steps.n // piece.steps.every for piece in request.pieces), feet_of(placed)
        rows = np.zeros((len(request.points), 0))  # laid out with every stage
        return cls.of(feet, placed, request.beam, fresh_log(samples, feet, rows, 1), request.points, two_way)

    @classmethod
    def of(cls, feet: Feet, placed: Sequence[Placed], beam: Beam, log: Log, points: Array, two_way: bool) -> "Riding":
        """The same with what is at hand."""
        return cls(
            feet=feet,
            rubbing=rubbing_of(placed[0].slider, section_at(beam, placed[0].start)),
            log=log,
            before=np.full((len(feet.points), 2), -1.0),
            start=placed[0].start,
            points=points,
            two_way=two_way,
            placed=tuple(placed),
            hard=hard_of(placed[0].slider),
            put_down=feet.state.copy(),
            set_off=feet.body.copy(),
            pressed=np.zeros(len(feet.points)),
        )

    @property
    def steps(self) -> int:
        """Of all stages so far."""
        return self.steps_before + int(self.log.tally[records.STEP])

    def set_touch(self, levels: Array) -> None:
        """Depths as the slider is put down on these heights of the surface, (points,)."""
        feet = self.feet
        z = feet.state[feet.foot, records.HEIGHT]
        p = feet.points
        depth = p[:, records.INSET] + p[:, records.FACE] * (p[:, records.IMAGE] * levels - z)
        feet.touch[:, records.DEPTH] = depth
        self.before[:, 0] = depth

    def look(self, step: float) -> None:
        """Remember how it stands before the first step, seconds."""
        self.at_start, self.put_down = self.energy(step), self.feet.state.copy()
        self.set_off = self.feet.body.copy()
        self.pressed = self.feet.points[:, records.STIFF] * np.maximum(self.feet.touch[:, records.DEPTH], 0.0)

    def energy(self, step: float) -> Array:
        """(sliders, 2): kinetic and in the springs across now, joules; these as the loop has them at the end of a step.

        A run that goes on has depths of half a step before, which are drawn on; one put down at rest has its own.
        """
        feet, p, touch = self.feet, self.feet.points, self.feet.touch
        found = np.zeros((len(self.placed), 2))
        found[:, 0] = 0.5 * np.array([one.slider.mass for one in self.placed]) * feet.body[:, records.V] ** 2
        inverse = feet.given[:, [records.FOOT_INVERSE_MASS, records.FOOT_INVERSE_INERTIA]]  # 0 where nothing moves
        masses, inertias = np.divide(1.0, inverse, out=np.zeros_like(inverse), where=inverse > 0.0).T
        across = 0.5 * (masses * feet.state[:, records.CLIMB] ** 2 + inertias * feet.state[:, records.TURN] ** 2)
        np.add.at(found[:, 0], feet.keeper, across)
        climb = feet.state[feet.foot, records.CLIMB] + p[:, records.ARM] * feet.state[feet.foot, records.TURN]
        more = 0.5 * step * p[:, records.FACE] * (touch[:, records.LIFT] - climb)
        depth = np.maximum(touch[:, records.DEPTH] + more, 0.0)
        np.add.at(found[:, 1], feet.owner, 0.5 * p[:, records.STIFF] * depth**2)
        return found


AROUND = 8
"""Pieces on each side of the points that a beam is asked for at once."""


def run_stages(
    stages: Sequence[Stage], tables: Sequence[Array], z: Array, riding: Riding, tell: Callable[[int], None]
) -> tuple[str, Array, Array]:
    """Run through all stages from free modes z; (why it stopped, q, dq/dt of the modes then)."""
    stopped, state = END, (np.empty(0), np.empty(0))
    for i, stage in enumerate(stages):
        z = z if i == 0 else stage.start(*state)
        surface = Surface(modal_rows(stage, z), drive_of(stage), tables[i], stage.edges - riding.start)
        if i == 0:
            riding.first = stage.deflection(z, np.zeros(1), riding.points)[0]
            riding.look(stage.dt)
            riding.feet.piece[:] = np.searchsorted(surface.edges[1:-1], riding.feet.points[:, records.OFFSET])
        riding.steps_before, riding.log.tally[records.STEP] = riding.steps, 0
        rows = np.ascontiguousarray(stage.rows(riding.points).T)
        riding.log = riding.log._replace(every=stage.every, points=rows)
        try:
            stopped = _run_stage(stage, surface, riding, tell)
        except KeyboardInterrupt:
            stopped = "interrupted"
        stopped = stage.beyond(*span_of(riding, stage.dt)) if stopped == LEFT_BEAM else stopped
        state = stage.state(surface.modes[:2].copy(), int(riding.log.tally[records.STEP]) * stage.dt)
        if stopped != END:
            break
    return stopped, *state


def span_of(riding: Riding, step: float, slider: int | None = None) -> tuple[float, float]:
    """The least and largest place of all points, or of one slider's, after a step, seconds: metres from the left."""
    x = riding.start + _after(riding, step)
    x = x if slider is None else x[riding.feet.owner == slider]
    return float(x.min()), float(x.max())


def _after(riding: Riding, step: float) -> Array:
    """Where all points are after another step, seconds: metres from the start, (points,)."""
    feet = riding.feet
    on = feet.body[:, records.X] + step * feet.body[:, records.V] * feet.riders[:, records.FREE]
    return np.asarray(on[feet.owner] + feet.points[:, records.OFFSET])


def beam_answer(surface: Surface) -> BeamAnswer:
    """What unit impulses on the polynomials' coefficients add to their rates, through all free modes."""
    n, (pieces, terms, _) = surface.modes.shape[1], surface.table.shape
    free = surface.table[:, :, :n].reshape(pieces * terms, n)
    return BeamAnswer(
        answer=np.ascontiguousarray(free @ free.T),
        load=np.zeros((pieces, terms)),
        added=np.zeros((pieces, terms)),
        span=np.zeros(2, dtype=np.int64),
    )


def fresh_line(pieces: int, terms: int, rows: int) -> Line:
    """Room for the surface in mid-step on so many pieces, of polynomials with so many terms."""
    stamp = np.full(pieces, -1, dtype=np.int64)
    return Line(local=np.zeros((pieces, 2, terms)), stamp=stamp, factors=np.zeros((2, rows)))


def reckoned() -> GivenSurface:
    """No surface is given."""
    return GivenSurface(np.zeros((0, 0, 2, 0)), np.zeros((0, 0)))


def in_chunks(n_steps: int, riding: Riding, advance: Callable[[int], int], tell: Callable[[int], None]) -> str:
    """All steps of a stage, as many at once as `advance` is given; why it ended. `tell` hears of all steps so far."""
    done = riding.log.tally
    while done[records.STEP] < n_steps:
        why = advance(min(CHUNK, n_steps - int(done[records.STEP])))
        tell(riding.steps)
        if why != records.DONE:
            return WHY[why]
    return END


def _run_stage(stage: Stage, surface: Surface, riding: Riding, tell: Callable[[int], None]) -> str:
    """One stage in chunks; why it ended."""
    from verify.motor import kernels

    if riding.two_way and riding.hard is None:
        return _run_felt(stage, surface, riding, tell)
    line = fresh_line(*surface.table.shape)
    if riding.hard is not None:
        return _run_hard(stage, surface, riding, line, riding.hard, tell)

    def advance(steps: int) -> int:
        return kernels.ride(
            steps, stage.dt, surface, reckoned(), riding.feet, riding.rubbing, None, line, riding.before, riding.log
        )

    return in_chunks(stage.n_steps, riding, advance, tell)


def _run_felt(stage: Stage, surface: Surface, riding: Riding, tell: Callable[[int], None]) -> str:
    """The same of a beam that feels its points.

    How it answers is had near them alone, and anew where they have left that: of all its pieces it would be as many
    numbers as the square of them, which for the exact beam takes seconds and hundreds of megabytes.
    """
    from verify.motor import kernels

    feet = riding.feet
    near = _near(surface, feet.piece)

    def advance(steps: int) -> int:
        nonlocal near
        first, own, beam, line = near
        feet.piece[:] -= first
        why = int(
            kernels.ride(steps, stage.dt, own, reckoned(), feet, riding.rubbing, beam, line, riding.before, riding.log)
        )
        feet.piece[:] += first
        if why != records.OFF_BEAM:
            return why
        feet.piece[:] = np.searchsorted(surface.edges[1:-1], _after(riding, stage.dt))
        if _reach(surface, feet.piece) == (first, first + len(own.table)):
            return why
        near = _near(surface, feet.piece)
        return int(records.DONE)

    return in_chunks(stage.n_steps, riding, advance, tell)


def _reach(surface: Surface, piece: Indices) -> tuple[int, int]:
    """The first piece near these, and the one after the last."""
    return max(int(piece.min()) - AROUND, 0), min(int(piece.max()) + AROUND + 1, len(surface.table))


def _near(surface: Surface, piece: Indices) -> tuple[int, Surface, BeamAnswer, Line]:
    """The number of the first piece near these; the surface, its answer and room for it from there."""
    first, end = _reach(surface, piece)
    own = surface._replace(table=surface.table[first:end], edges=surface.edges[first : end + 1])
    return first, own, beam_answer(own), fresh_line(*own.table.shape)


def _run_hard(
    stage: Stage, surface: Surface, riding: Riding, line: Line, hard: Hard, tell: Callable[[int], None]
) -> str:
    """The same of a hard point."""
    from verify.motor import impact_kernels

    feet, before = riding.feet, riding.before
    if before[0, 0] == RIDES_FROM_HERE:
        added = impact_kernels.put(0.0, surface, feet, riding.rubbing, line)
        before[0, 0] = 1.0 if hard.press + added > 0.0 else -1.0
        riding.look(stage.dt)

    def hop(steps: int) -> int:
        return impact_kernels.hop(steps, stage.dt, surface, feet, riding.rubbing, hard, line, before, riding.log)

    def advance(steps: int) -> int:
        grown = (feet.body, feet.state, feet.touch, feet.sums, before, riding.log.before, riding.log.tally)
        kept = [one.copy() for one in grown]
        why = hop(steps)
        if why == records.OFF_BEAM:  # half-way through a step of flights and blows: again, to the end of that before
            whole = int(riding.log.tally[records.STEP] - kept[-1][records.STEP])
            for one, was in zip(grown, kept, strict=True):
                one[:] = was
            hop(whole)
        feet.touch[0, records.DEPTH] = before[0, 0]  # from where another run goes on
        return why

    return in_chunks(stage.n_steps, riding, advance, tell)


RIDES_FROM_HERE = 2.0
"""In place of a depth: a hard point is put on the surface with the first step."""
WHY = {
    records.OFF_BEAM: LEFT_BEAM,
    records.NOT_FINITE: "diverged",
    records.CHATTERS: "bounced, left or turned 100 000 times within one step",
}
"""Why a run stopped early."""
