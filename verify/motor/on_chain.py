"""A slider that may leave the surface, on the nonlinear chain, which moves first, kept in the middle of every step."""

from collections.abc import Callable
from time import perf_counter

import numpy as np
from msgspec.structs import replace

from verify.arrays import Array
from verify.chain.motion import ChainMotion, ElasticMotion, from_rest
from verify.chain.ride import joint_steps, line_rows, piece_at
from verify.chain.system import axial_stiffness, build_system
from verify.errors import InputError
from verify.linear.positions import SLACK
from verify.linear.surface import LEFT_BEAM
from verify.motion.records import READ, Drive, Surface
from verify.motion.request import Request
from verify.motion.surface import Stage
from verify.motor import records
from verify.motor.combine import CHAIN
from verify.motor.feet import Placed
from verify.motor.outcome import Ended, outcome
from verify.motor.records import GivenSurface
from verify.motor.result import MotorRun
from verify.motor.setup import Setup, begin, lay_out
from verify.motor.stepping import Riding, fresh_line, in_chunks, span_of
from verify.options import Links
from verify.validation import check_whole

BESIDE = 2
"""Links beside those under the feet on which the slider may run."""
TOLERANCE = 1e-9


def run_on_chain(
    request: Request,
    placed: tuple[Placed, ...],
    links: Links,
    began: float,
    progress: Callable[[float], None],
) -> tuple[MotorRun, ...]:
    """`request` is that of a linear chain from rest: its margins and steps are taken. Raises InputError."""
    if len(request.points):
        raise InputError(
            f"at = {request.points.tolist()!r}: a nonlinear chain under a slider keeps no deflections, leave it out"
        )
    setup = lay_out(request, placed, ())
    assert request.count is not None
    check_whole("count", request.count, 2)
    stage = setup.stages[0]
    times: Array = np.linspace(0.0, stage.duration, 2 * stage.n_steps + 1)
    system = build_system(request.beam, request.count, request.forces, request.frequency_hz, load="reciprocal")
    axial = axial_stiffness(request.beam, request.count)
    moved = from_rest(system, links, axial, times, tolerance=TOLERANCE, progress=progress)
    ready = perf_counter()
    note = f"the nonlinear chain, {links} links, from rest; margins are those of the linear chain's steady field"
    given, edges = surface_given(moved, setup)
    runs = [_ride(replace(setup, placed=(one,)), given, edges - one.start, (began, ready), progress) for one in placed]
    return tuple(
        replace(run, model=CHAIN, state=replace(run.state, model=CHAIN), notes=(note, *run.notes[1:])) for run in runs
    )


def _ride(
    setup: Setup,
    given: GivenSurface,
    edges: Array,
    begun: tuple[float, float],
    progress: Callable[[float], None],
) -> MotorRun:
    """One slider on a chain that does not feel it, hence none of the others; `given` is the surface under all.

    `edges` are metres from where the slider starts.
    """
    from verify.motor import kernels

    stage = setup.stages[0]
    riding = Riding.fresh(setup.placed, setup.request, False)
    riding.log = riding.log._replace(every=stage.every, points=np.zeros((0, 0)))
    begin(setup, riding, ())
    riding.look(stage.dt)
    riding.first = np.zeros(0)
    offsets = riding.feet.points[:, records.OFFSET]
    riding.feet.piece[:] = np.clip(np.searchsorted(edges[1:-1], offsets), 0, len(edges) - 2)
    first, last = int(riding.feet.piece.min()), int(riding.feet.piece.max())
    drawn = float(np.sqrt(np.mean(given.along[:, first : last + 2] ** 2)))
    drive = Drive(omega=0.0, origin=0.0, unit=1.0, growth=np.zeros(0))
    surface = Surface(np.zeros((READ + 1, 0)), drive, np.zeros((0, 0, 0)), edges)  # no modes, the surface is given
    line = fresh_line(given.local.shape[1], given.local.shape[3], 0)

    def advance(steps: int) -> int:
        return kernels.ride(
            steps, stage.dt, surface, given, riding.feet, riding.rubbing, None, line, riding.before, riding.log
        )

    stopped = in_chunks(stage.n_steps, riding, advance, lambda n: progress(n / stage.n_steps))
    stopped = _gone(edges, stage, riding) if stopped == LEFT_BEAM else stopped
    state = stage.state(np.zeros((2, 0)), 0.0) if not len(stage.modal.omegas) else (np.zeros(0), np.zeros(0))
    began, ready = begun
    run = outcome(0, setup, riding, Ended(stopped, *state, ready - began, perf_counter() - ready))
    return replace(run, motor_margins=replace(run.motor_margins, drawn=drawn))


def _gone(edges: Array, stage: Stage, riding: Riding) -> str:
    """What a slider has done that went beyond the links under it: those kept, or the last before a step."""
    edges, (first, last) = edges + riding.start, span_of(riding, stage.dt)
    end = 0 if edges[0] - first > last - edges[-1] else -1
    stepped = stage.ends[end] != LEFT_BEAM and abs(edges[end] - stage.edges[end]) < SLACK * stage.edges[-1]
    return stage.ends[end] if stepped else "left the links that it was put on"


def surface_given(moved: ChainMotion | ElasticMotion, setup: Setup) -> tuple[GivenSurface, Array]:
    """The contact line on the links under all feet and beside them, at every other time kept: in mid-steps; its edges.

    Edges are metres from the left end. Links beyond a step of the surface are left out.
    """
    system, ground = moved.system, setup.stages[0].edges
    near = SLACK * system.length
    ends = [
        one.start + foot.offset + side * 0.5 * foot.length
        for one in setup.placed
        for foot in one.slider.feet
        for side in (-1.0, 1.0)
    ]
    first = max(piece_at(system, min(ends)) - BESIDE, piece_at(system, ground[0] + near))
    last = min(piece_at(system, max(ends)) + BESIDE, piece_at(system, ground[-1] - near))
    heights, rises, along = (part[1::2] for part in joint_steps(moved))
    rows = line_rows(system)[:, first : last + 1]  # (N, pieces, 4)
    local = np.stack([np.einsum("tn,npd->tpd", steps, rows) for steps in (heights, rises)], axis=2)
    edges = system.nodes[first : last + 2]
    return GivenSurface(np.ascontiguousarray(local), np.ascontiguousarray(along[:, first : last + 2])), edges
