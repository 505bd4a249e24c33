"""Steps of a slider's run: resolution of the free modes, step doubling, energy made by the contact."""

from collections.abc import Callable, Iterator, Sequence
from itertools import pairwise
from math import ceil, inf

import msgspec
import numpy as np
from msgspec.structs import replace

from verify.arrays import Array
from verify.errors import InputError
from verify.linear.time_basis import TimeBasis
from verify.motion.request import Request
from verify.motion.result import Ledger, Motion
from verify.motion.surface import Stage, cut, free_at

UNSEEN = 1e-4
"""Share of the surface speed, rms, that the steps of a run may miss."""
STICKY = 0.1
"""Step times K mu N / m from which a slider practically sticks to a two-way coupled beam."""
PLACES = 129
"""Places along the beam for the mean square slope of a steady field."""
KNOWN = 0.01
"""Largest change of the displacement under step doubling that counts as converged."""
STANDS = 0.4 * KNOWN
"""Change at which refinement ends: where errors fall as dt^(1/2), the slowest order of sticking sliders, 2.4 times as
much is left."""
LOOKS = 16
"""Least number of samples by which two runs are compared: at one alone, different runs may meet."""
NOT_CONVERGED = "step: not converged, halving it still changes the slider's displacement"
HALVINGS = 4
"""Refinements of the step at most."""
COARSER = 0.75
"""Steps of the first, coarse run over those of the next at most; where samples stand close there is no coarse run."""
SHARE = 0.6
"""Of the remaining progress, reported for each run: how many there will be is not known."""
SAMPLED = ("times", "deflection", "travelled", "speed", "friction", "normal_force", "surface_speed")
"""Fields of a motion with a row for each sample."""
MOST = 10.0
"""Energy given to the beam over all energy put in from which a run is refused. Friction gives nothing of its own; the
factor covers quadrature of the work, truncated modes, and the slope work on a tangential slider."""
Progress = Callable[[float], None]


def _rates(stages: Sequence[Stage], z: Array, length: float) -> tuple[Array, Array, float]:
    """(omega, surface speed of every free mode, of the driven motion), (n,), (n,), but for a common factor.

    Means over the beam, the largest of all stages: omega |q| n pi / L, the slope of the nth mode taken as n pi / L of
    its deflection, whose mean square over a beam of uniform mass is 1/mass.
    """
    starts = [z]
    for before, stage in pairwise(stages):
        starts.append(stage.start(*before.state(free_at(before, starts[-1], before.duration), before.duration)))
    free: Array = np.max([np.hypot(*start) for start in starts], axis=0)
    omegas, last = stages[0].modal.omegas, stages[-1]
    wavenumbers: Array = np.asarray(np.pi / length * np.arange(1.0, len(free) + 1.0), dtype=np.float64)
    if last.forced is not None:
        driven = float(np.linalg.norm(last.forced.amplitudes[:, 0] * wavenumbers))
    else:
        x = np.linspace(0.0, length, PLACES)
        first = np.sqrt((last.free_shapes(x, 0)[0] ** 2).mean())
        driven = float(np.sqrt((last.drive_shapes(x, 1)[:2] ** 2).sum(axis=0).mean()) / first)
    return omegas, np.asarray(omegas * free * wavenumbers), last.omega * driven


def _missed(omegas: Array, free: Array, driven: float, dt: float) -> float:
    """Share of the surface speed, rms, that steps of dt do not resolve.

    The parabola through start, middle and end of a step misses (omega dt / 2)^4 / 180 of the mean of a cosine, and all
    of one that turns faster than that.
    """
    errors = np.minimum((0.5 * omegas * dt) ** 4 / 180.0, 1.0)
    total = np.hypot(driven, np.sqrt((free**2).sum()))
    return float(np.sqrt(((free * errors) ** 2).sum()) / total) if total else 0.0


def missed_by(stages: Sequence[Stage], z: Array, length: float, dt: float) -> float:
    """Share of the surface speed, rms, that steps of dt do not resolve from free modes z."""
    return _missed(*_rates(stages, z, length), dt)


def longest_step(stages: Sequence[Stage], z: Array, length: float, longest: float) -> float:
    """The longest of `longest`, its half, its quarter, ... that misses less than UNSEEN, seconds."""
    if not len(stages[0].modal.omegas):
        return longest
    rates, step = _rates(stages, z, length), longest
    while _missed(*rates, step) > UNSEEN:
        step *= 0.5
    return step


def gripped_step(stages: Sequence[Stage], rate: float, longest: float) -> float:
    """The longest of `longest`, its half, ... in which a two-way coupled slider may stick to the beam, seconds.

    `rate` is K mu N / m, infinite for Coulomb's law. Sticking matches speeds at the end of a step, which feeds energy
    into modes that make more than half a turn in it.
    """
    step, omegas = longest, stages[0].modal.omegas
    fastest = float(omegas.max()) if len(omegas) else 0.0
    while fastest * step > np.pi and rate * step > STICKY:
        step *= 0.5
    return step


def stepped(stages: Sequence[Stage], step: float, closer: int = 1) -> list[Stage]:
    """The same stages in steps no longer than `step`, with `closer` times as many samples."""
    found = []
    for stage in stages:
        steps = cut(stage.duration, step, closer * (stage.n_steps // stage.every))
        found.append(replace(stage, n_steps=steps.n, dt=steps.dt, every=steps.every))
    return found


def steps_in(stages: Sequence[Stage]) -> int:
    """Number of steps of all stages."""
    return sum(stage.n_steps for stage in stages)


class Excess(msgspec.Struct, frozen=True):
    """Energy that a slider gave its beam, and all energy put in, joules."""

    made: float
    put_in: float


class Ran(msgspec.Struct, frozen=True, eq=False):
    """A slider's run, its stages, and the energy that its contact made beyond what is plausible."""

    motion: Motion
    stages: list[Stage]
    excess: Excess | None


def until_it_stands(run: Callable[[list[Stage], Progress], Ran], stages: list[Stage], progress: Progress) -> Ran:
    """Runs in steps of 2 dt, dt, dt/2, ... until one confirms the run before; the last one.

    The coarse run is left out where samples stand too close for it. Costs of all runs are added up; `moved` in the
    statistics is the last change of the displacement.
    """
    dt = max(stage.dt for stage in stages)
    closer = ceil(LOOKS / sum(stage.n_steps // stage.every for stage in stages))
    left, ran = 1.0, list[Ran]()
    for layout in _layouts(stages, dt, closer):
        begins, share = 1.0 - left, SHARE * left
        ran.append(run(layout, lambda part, begins=begins, share=share: progress(begins + share * part)))  # type: ignore[misc]
        left *= 1.0 - SHARE
        if ran[-1].motion.statistics.interrupted:
            break
        if len(ran) > 1 and ran[-1].excess is None and moved(ran[-2].motion, ran[-1].motion) <= STANDS:
            break
    motion, costs = ran[-1].motion, [one.motion.statistics for one in ran]
    compared = len(ran) > 1 and not motion.statistics.interrupted
    statistics = replace(
        motion.statistics,
        set_up_s=sum(cost.set_up_s for cost in costs),
        wall_s=sum(cost.wall_s for cost in costs),
        loop_s=sum(cost.loop_s for cost in costs),
        moved=moved(ran[-2].motion, motion) if compared else None,
    )
    if compared:
        progress(1.0)
    kept = {name: getattr(motion, name)[::closer] for name in SAMPLED}
    last = statistics.moved
    notes = (f"{NOT_CONVERGED}, last by {100.0 * last:.2g} %",) if last is not None and last > KNOWN else ()
    motion = replace(motion, statistics=statistics, notes=(*motion.notes, *notes), **kept)
    return replace(ran[-1], motion=motion)


def _layouts(stages: list[Stage], dt: float, closer: int) -> Iterator[list[Stage]]:
    coarse, own = (stepped(stages, step, closer) for step in (2.0 * dt, dt))
    if steps_in(coarse) <= COARSER * steps_in(own):
        yield coarse
    yield own
    for n in range(1, HALVINGS + 1):
        yield stepped(stages, dt / 2.0**n, closer)


def moved(coarse: Motion, fine: Motion) -> float:
    """Relative change of the displacement with the step: at the end, and over the largest at any sample.

    Infinite where the runs end differently; 0 where neither moved.
    """
    ends = coarse.end.time, fine.end.time
    if coarse.statistics.finished != fine.statistics.finished or abs(ends[0] - ends[1]) > KNOWN * ends[1]:
        return inf
    n = min(len(coarse.travelled), len(fine.travelled))
    apart, way = abs(coarse.travelled[:n] - fine.travelled[:n]), abs(fine.travelled[:n])
    pairs = ((float(apart[-1]), float(way[-1])), (float(apart.max()), float(way.max())))
    return max(one / of if of else 0.0 if not one else inf for one, of in pairs)


def excess_of(ledger: Ledger, had: float, way: float, request: Request, basis: TimeBasis) -> Excess | None:
    """Energy that the slider gave the beam where that is more than MOST times what was put in.

    `had` is the energy of slider and beam at the start, joules, `way` the largest displacement of the slider, metres:
    its weight gives load times sag over that distance, by a slope of pi/L of the sag.
    """
    made, put_in = ledger.contact_on_beam + ledger.normal_on_beam, abs(ledger.work_in) + had
    slider = request.slider
    if made > MOST * put_in and slider is not None and slider.normal == "held":
        x = np.linspace(0.0, basis.beam.length, 101)
        sags = ((basis.shapes(x, 0) / basis.omegas[:, None]) ** 2).sum(axis=0)
        put_in += float(slider.normal_force**2 * sags.max() * min(np.pi * way / basis.beam.length, 1.0))
    return None if made <= MOST * put_in else Excess(made, put_in)


def check_books(excess: Excess | None, request: Request, stages: Sequence[Stage]) -> None:
    """Raise InputError for a run whose contact made energy."""
    if excess is None:
        return
    dt = max(stage.dt for stage in stages)
    if not np.isfinite(excess.put_in):
        raise InputError(
            f"step = {dt:.3g} s: the energy put into the beam overflows; give smaller forces or a lighter slider"
        )
    enough = gripped_step(stages, inf, 0.5 * dt)
    raise InputError(
        f"step = {dt:.3g} s: the contact gave the beam {excess.made:.3g} J where {excess.put_in:.3g} J were put in; "
        f"give a step of at most {enough:.2g} s (steps_per_period = {ceil(1.0 / (enough * request.frequency_hz))})"
    )
