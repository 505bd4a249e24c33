"""The step of a slider that the beam feels, judged: halved until the slider's way stands.

What the start excites is known before a run, and steps follow it (`step_size`). Friction turns round when it will and
excites every mode; what a step makes of that no estimate tells, but a second run in steps twice as long.
"""

from collections.abc import Callable, Iterator, Sequence
from math import ceil

import msgspec
import numpy as np
from msgspec.structs import replace

from verify.motion.result import Motion
from verify.motion.sound_books import Excess
from verify.motion.step_size import stepped
from verify.motion.surface import Stage
from verify.patience import waited_for

KNOWN = 0.01
"""Of the displacement, and of the longest way: what moves more with its step is not known."""
STANDS = 0.4 * KNOWN
"""What halving the step may move at last: where errors fall as dt^(1/2), the slowest seen of sliders that stick, 2.4
times as much is left."""
LOOKS = 16
"""Samples at least by which two runs are compared: at one alone, runs that are far apart may meet."""
HALVINGS = 4
"""Of the step at most: sixteen times the work."""
COARSER = 0.75
"""Of the steps of a run, at most those of one that is to tell of it: where samples stand close it takes no fewer."""
SHARE = 0.6
"""Of what is left of the progress, told of each run: how many there will be is not known."""
SAMPLED = ("times", "deflection", "travelled", "speed", "friction", "normal_force", "surface_speed")
"""Of a motion, a row for each sample."""
Told = Callable[[float], None]


class Ran(msgspec.Struct, frozen=True, eq=False):
    """A slider's run and whether it can be."""

    motion: Motion
    stages: list[Stage]
    """In the steps that it took."""
    excess: Excess | None
    """What it gave the beam beyond all that was put in."""


def until_it_stands(
    run: Callable[[list[Stage], Told], Ran],
    stages: list[Stage],
    seconds: Callable[[int], float],
    progress: Told,
) -> Ran:
    """The first run in steps as those of `stages`, or in a half, a quarter, ... of them, that confirms the one before.

    The first of all takes steps twice as long, to be compared with, or where samples stand too close for that, no
    other. Where none confirms, or all with the next would take longer than is waited for (so many steps take
    `seconds`), the last that was run, or broken off. What the runs before took is added to its cost; a note says how
    far it stands.
    """
    closer = ceil(LOOKS / sum(stage.n_steps // stage.every for stage in stages))
    left, ran, layouts = 1.0, list[Ran](), list(_layouts(stages, closer))
    while len(ran) < len(layouts) and (len(ran) < 2 or waited_for(seconds(_steps_of_all(layouts[: len(ran) + 1])))):
        ran.append(run(layouts[len(ran)], _part_of(progress, 1.0 - left, SHARE * left)))
        left *= 1.0 - SHARE
        if ran[-1].motion.statistics.interrupted or _stands(ran):
            break
    found = _thinned(_with_cost(ran), closer)
    if not found.motion.statistics.interrupted:
        progress(1.0)
    return found


def _stands(ran: Sequence[Ran]) -> bool:
    """Whether the last run confirms the one before it."""
    return len(ran) > 1 and ran[-1].excess is None and moved(ran[-2].motion, ran[-1].motion) <= STANDS


def _layouts(stages: list[Stage], closer: int) -> Iterator[list[Stage]]:
    """In longer steps, where they are any longer, then in these and in halves of them."""
    dt = max(stage.dt for stage in stages)
    coarse, own = (stepped(stages, step, closer) for step in (2.0 * dt, dt))
    if steps_in(coarse) <= COARSER * steps_in(own):
        yield coarse
    yield own
    for n in range(1, HALVINGS + 1):
        yield stepped(stages, dt / 2.0**n, closer)


def steps_in(stages: Sequence[Stage]) -> int:
    """Of all stages."""
    return sum(stage.n_steps for stage in stages)


def _steps_of_all(layouts: Sequence[list[Stage]]) -> int:
    return sum(map(steps_in, layouts))


def moved(coarse: Motion, fine: Motion) -> float:
    """How far a slider's way moved with its step: of its end, and of the longest way at any sample.

    Infinite where one run ended otherwise, or another time, than the other; 0 where neither moved.
    """
    ends = coarse.end.time, fine.end.time
    if coarse.statistics.finished != fine.statistics.finished or abs(ends[0] - ends[1]) > KNOWN * ends[1]:
        return float("inf")
    n = min(len(coarse.travelled), len(fine.travelled))
    apart, way = abs(coarse.travelled[:n] - fine.travelled[:n]), abs(fine.travelled[:n])
    return max(_part(apart[-1], way[-1]), _part(apart.max(), way.max()))


def _part(one: float, of: float) -> float:
    return float(np.divide(one, of)) if of else 0.0 if not one else float("inf")


def _part_of(progress: Told, begins: float, share: float) -> Told:
    return lambda part: progress(begins + share * part)


def _with_cost(ran: Sequence[Ran]) -> Ran:
    """The last run, with what all of them took, and a note on how far it stands unless it was broken off."""
    motion, costs = ran[-1].motion, [one.motion.statistics for one in ran]
    judged = len(ran) > 1 and not motion.statistics.interrupted
    part = moved(ran[-2].motion, motion) if judged else None
    statistics = replace(
        motion.statistics,
        set_up_s=sum(cost.set_up_s for cost in costs),
        wall_s=sum(cost.wall_s for cost in costs),
        loop_s=sum(cost.loop_s for cost in costs),
        moved=part,
    )
    said = (_said(part, motion.statistics.step_s),) if part is not None else ()
    return replace(ran[-1], motion=replace(motion, statistics=statistics, notes=(*motion.notes, *said)))


def _thinned(ran: Ran, closer: int) -> Ran:
    """With the samples that were asked for, of so many times as many."""
    kept = {name: getattr(ran.motion, name)[::closer] for name in SAMPLED}
    return replace(ran, motion=replace(ran.motion, **kept))


def _said(part: float, dt: float) -> str:
    """How far the way of a slider stands in steps of dt, seconds."""
    told = f"the slider's way moves by {100.0 * part:.2g} %" if np.isfinite(part) else "the run ends otherwise"
    said = f"step: from steps of {2.0 * dt:.3g} s to {dt:.3g} s {told}"
    return said if part <= KNOWN else f"{said}; give a shorter step, and halve it until what you read stands"
