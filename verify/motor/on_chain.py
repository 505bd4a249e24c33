"""A slider on feet on the nonlinear chain, one-way: the chain moves first, its surface is kept in mid-steps."""

from collections.abc import Callable
from time import perf_counter

import numpy as np

from verify.arrays import Array
from verify.chain.motion import ChainMotion, ElasticMotion, from_rest
from verify.chain.ride import joint_steps, line_rows, piece_at
from verify.chain.system import axial_stiffness, build_system
from verify.dynamics.linear_system import Stage, basis_of, stages_from_rest
from verify.dynamics.request import request_of
from verify.dynamics.result import END, EndState, EnergyBalance, Motion, Statistics
from verify.dynamics.slider_run import SliderRun
from verify.errors import InputError
from verify.linear.positions import SLACK, Forces
from verify.linear.surface import section_at
from verify.motor import records
from verify.motor.feet import Placed, feet_of, put_down, rubbing_of
from verify.motor.records import Feet, GivenSurface, Line, Log
from verify.options import LINKS, Links
from verify.problem.beam import Beam
from verify.problem.slider import Slider
from verify.validation import check_whole, check_word

BESIDE = 2
"""Links beside those under the feet on which the slider may run."""
TOLERANCE = 1e-9
CHUNK = 20_000
"""Steps between two checks for an interrupt."""
EVENTS = 20_000


def run_on_chain(
    beam: Beam,
    forces: Forces,
    frequency_hz: float,
    duration: float,
    *,
    slider: Slider,
    count: int,
    links: Links = "rigid",
    prescribed_speed: float | None = None,
    fixed_position: bool = False,
    samples: int = 201,
    step: float | None = None,
    steps_per_period: int | None = None,
    progress: Callable[[float], None] = lambda part: None,
) -> Motion:
    """A slider with contact on a chain of `count` rigid or stretching links from rest, undamped.

    Arguments as those of `simulate`; margins and coupling are those of the linear chain. Raises InputError.
    """
    began = perf_counter()
    check_word("links", links, LINKS)
    check_whole("count", count, 2)
    if slider.contact is None or slider.contact.hard or slider.coupling != "one-way":
        raise InputError("slider: a nonlinear chain carries feet on springs one-way, give contact.stiffness, 'one-way'")
    request = request_of(
        beam,
        forces,
        frequency_hz,
        duration,
        model="segment",
        count=count,
        modes=None,
        start="rest",
        soft_start_periods=0.0,
        envelope=(),
        modal_damping=None,
        slider=slider,
        prescribed_speed=prescribed_speed,
        fixed_position=fixed_position,
        at=(),
        samples=samples,
        step=step,
        steps_per_period=steps_per_period,
        continue_from=None,
    )
    if beam.loss_factor:
        raise InputError(f"beam.loss_factor = {beam.loss_factor!r}: a nonlinear chain is undamped, give 0.0")
    basis = basis_of(beam, "segment", count, None, "spline")
    linear = SliderRun.of(
        request, basis, stages_from_rest(basis, request.forces, request.omega, 0.0, request.pieces, 0.0), (), False
    )
    stage, start = linear.stages[0], request.starts[0]
    times: Array = np.linspace(0.0, stage.duration, 2 * stage.steps.n + 1)
    system = build_system(beam, count, request.forces, frequency_hz, load="reciprocal")
    moved = from_rest(system, links, axial_stiffness(beam, count), times, tolerance=TOLERANCE, progress=progress)
    ready, placed = perf_counter(), Placed(slider, start, prescribed_speed, fixed_position)
    given, edges = surface_given(moved, placed, stage.edges)
    feet = feet_of((placed,))
    put_down(feet, np.zeros(len(feet.points)))
    first = _first(slider, feet)
    log = _fresh_log(stage.steps.n // stage.steps.every, stage.steps.every, feet)
    energies = _energies(slider, feet)
    stopped = _march(stage, edges - start, given, feet, log, slider, beam, start)
    n = int(log.tally[records.SAMPLES])
    rows = np.concatenate([first, log.kept[:n, 0]])
    events = log.events[: int(log.tally[records.EVENTS])].copy()
    steps = int(log.tally[records.STEP])
    sums, seconds, state = feet.sums[0], steps * stage.steps.dt, feet.state.copy()
    pieces = np.searchsorted(edges[1:-1] - start, feet.points[:, records.OFFSET])  # under the feet at the start
    drawn = float(np.sqrt(np.mean(given.along[:, pieces.min() : pieces.max() + 2] ** 2)))
    heights = np.concatenate([np.zeros((1, len(state), 2)), log.heights[:n]])
    heights[0, :, 0] = energies[2]
    return Motion(
        model="chain",
        count=count,
        times=np.concatenate([[0.0], stage.sample_times])[: n + 1],
        points=request.points,
        deflection=np.zeros((n + 1, 0)),
        slider=slider,
        start=start,
        travelled=rows[:, records.KEPT_X],
        speed=rows[:, records.KEPT_V],
        friction=rows[:, records.KEPT_RUB],
        normal_force=rows[:, records.KEPT_PUSH],
        surface_speed=rows[:, records.KEPT_SURFACE],
        contact_share=rows[:, records.KEPT_TOUCHING],
        stuck_share=rows[:, records.KEPT_STICKING],
        friction_loss=rows[:, records.KEPT_RUBBED],
        tangential_work=rows[:, records.KEPT_ALONG],
        height=heights[:, :, 0],
        pitch=heights[:, :, 1],
        pressures=np.concatenate([energies[3][None], log.pressures[:n]]),
        point_offsets=feet.points[:, records.OFFSET],
        events=events,
        mean_friction=float(sums[records.MEAN_RUB]) / seconds if seconds else float("nan"),
        largest_friction=float("nan"),
        mean_surface_speed=float("nan"),
        coupling=linear.coupling,
        margins=linear.margins,
        energy=_balance(slider, feet, energies),
        notes=(
            f"the nonlinear chain, {links} links, from rest; margins are those of the linear chain",
            f"its surface moves along x at {drawn:.3g} m/s rms",
        ),
        statistics=Statistics(
            steps=steps,
            evaluations=steps,
            step_s=stage.steps.dt,
            set_up_s=ready - began,
            wall_s=perf_counter() - ready,
            stopped=stopped,
        ),
        end=EndState(beam=beam, model="chain", count=count, time=seconds, q=np.zeros(0), rates=np.zeros(0)),
    )


def _first(slider: Slider, feet: Feet) -> Array:
    """The sample before the first step, (1, 9)."""
    row = np.zeros((1, 9))
    row[0, [records.KEPT_V, records.KEPT_PUSH]] = feet.body[0, records.V], slider.normal_force
    row[0, [records.KEPT_TOUCHING, records.KEPT_SURFACE]] = 1.0, np.nan
    return row


def _fresh_log(samples: int, every: int, feet: Feet) -> Log:
    return Log(
        every=every,
        kept=np.zeros((samples, 1, 9)),
        heights=np.zeros((samples, len(feet.state), 2)),
        pressures=np.zeros((samples, len(feet.points))),
        events=np.zeros((EVENTS, 4)),
        tally=np.zeros(3, dtype=np.int64),
        before=np.zeros((1, records.SUMS)),
    )


def _energies(slider: Slider, feet: Feet) -> tuple[float, float, Array, Array]:
    """(kinetic, in the contact springs, J; heights of the feet, m; normal forces of the points, N) at the start.

    Sets the depths of the points.
    """
    p = feet.points
    depth = p[:, records.INSET] - p[:, records.FACE] * feet.state[feet.foot, records.HEIGHT]
    feet.touch[:, records.DEPTH] = depth
    push = p[:, records.STIFF] * np.maximum(depth, 0.0)
    elastic = 0.5 * float(push @ depth)
    return 0.5 * slider.mass * float(feet.body[0, records.V]) ** 2, elastic, feet.state[:, 0].copy(), push


def _march(
    stage: Stage, edges: Array, given: GivenSurface, feet: Feet, log: Log, slider: Slider, beam: Beam, start: float
) -> str:
    """All steps; why they ended. `edges` are metres from the start of the slider."""
    from verify.motor import kernels

    pieces, (_, _, _, terms) = len(edges) - 1, given.local.shape
    line = Line(local=np.zeros((pieces, 2, terms)), stamp=np.full(pieces, -1, dtype=np.int64))
    before, offsets = np.full((len(feet.points), 2), -1.0), feet.points[:, records.OFFSET]
    before[:, 0] = feet.touch[:, records.DEPTH]
    feet.piece[:] = np.clip(np.searchsorted(edges[1:-1], offsets), 0, pieces - 1)
    rubbing, dt, reason = rubbing_of(slider, section_at(beam, start)), stage.steps.dt, records.DONE
    while reason == records.DONE and log.tally[records.STEP] < stage.steps.n:
        n = min(CHUNK, stage.steps.n - int(log.tally[records.STEP]))
        reason = kernels.ride(n, dt, edges, given, feet, rubbing, line, before, log)
    if reason == records.DONE:
        return END
    if reason == records.NOT_FINITE:
        return "diverged"
    x = start + feet.body[0, records.X] + dt * feet.body[0, records.V] * feet.riders[0, records.FREE] + offsets
    edges, first, last = edges + start, float(x.min()), float(x.max())
    end = 0 if edges[0] - first > last - edges[-1] else -1
    if abs(edges[end] - stage.edges[end]) < SLACK * stage.edges[-1]:
        return stage.beyond(first, last)
    return "left the links that it was put on"


def _balance(slider: Slider, feet: Feet, before: tuple[float, float, Array, Array]) -> EnergyBalance:
    sums, inverse = feet.sums[0], feet.given[:, [records.FOOT_INVERSE_MASS, records.FOOT_INVERSE_INERTIA]]
    inertia = np.divide(1.0, inverse, out=np.zeros_like(inverse), where=inverse > 0.0)
    across = 0.5 * float((inertia * feet.state[:, [records.CLIMB, records.TURN]] ** 2).sum())
    kinetic = 0.5 * slider.mass * float(feet.body[0, records.V]) ** 2 + across - before[0]
    stored = float(sums[records.STORED]) - before[1]
    normal, along, uphill = (float(sums[column]) for column in (records.ACROSS, records.ALONG, records.UPHILL))
    load, rubbed = float(sums[records.PRESSED] + sums[records.PULLED]), float(sums[records.RUBBED])
    damped = float(sums[records.DAMPED])
    residual = normal + along + uphill + load - rubbed - damped - kinetic - stored
    return EnergyBalance(
        kinetic=0.0,
        elastic=0.0,
        slider=kinetic,
        contact_elastic=stored,
        drive_work=0.0,
        load_work=load,
        tangential_work=along,
        normal_work=normal,
        slope_work=uphill,
        damping_loss=0.0,
        friction_loss=rubbed,
        contact_loss=damped,
        friction_on_beam=-along,
        normal_on_beam=-normal,
        initial=0.0,
        created=float("nan"),
        slider_residual=residual,
        residual=residual,
    )


def surface_given(moved: ChainMotion | ElasticMotion, placed: Placed, ground: Array) -> tuple[GivenSurface, Array]:
    """The contact line on the links under all feet and beside them, in mid-steps, and its edges, m from the left end.

    `ground` is the range of the contact: links beyond a step of the surface are left out.
    """
    system, near = moved.system, SLACK * moved.system.length
    ends = [
        placed.start + foot.offset + side * 0.5 * foot.length for foot in placed.slider.feet for side in (-1.0, 1.0)
    ]
    first = max(piece_at(system, min(ends)) - BESIDE, piece_at(system, ground[0] + near))
    last = min(piece_at(system, max(ends)) + BESIDE, piece_at(system, ground[-1] - near))
    heights, rises, along = (part[1::2] for part in joint_steps(moved))
    rows = line_rows(system)[:, first : last + 1]  # (N, pieces, 4)
    local = np.stack([np.einsum("tn,npd->tpd", steps, rows) for steps in (heights, rises)], axis=2)
    edges = system.nodes[first : last + 2]
    return GivenSurface(np.ascontiguousarray(local), np.ascontiguousarray(along[:, first : last + 2])), edges
