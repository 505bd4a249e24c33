"""Whether a far motion of the chain is known: it is run a second time, and refused where the two have parted.

Links that turn far move chaotically before long: what a step leaves out grows by a factor for each of their swings, and
a figure with all its digits may have none that is right. The second run takes ten times the tolerance (or, of fixed
steps, a step as `SECOND` says), so that in a motion that is known it stands ten (modal: three) times as far off as the
first. Links that turn less than `FAR` are spared it.
"""

from collections.abc import Callable
from typing import TypeVar

import numpy as np

from verify.chain.result import ChainMotion
from verify.chain.stretching import ElasticMotion
from verify.errors import InputError
from verify.models.arrays import Array

Moved = TypeVar("Moved", ChainMotion, ElasticMotion)
FAR = 0.3
"""Radians. Links that turn no further swing nearly as linear ones, whose errors grow with time alone."""
KNOWN = 0.01
"""Of the largest deflection: two runs that lie no further apart are one motion."""
SECOND = {"tolerance": 10.0, "rk4": 0.5, "modal": 2.0, "stretching": 0.5}
"""Tolerance or step of the second run over the first's: twice RK4's may lie above its stability limit."""
STEPPED = {"rk4": "step", "modal": "step", "stretching": "step of the stretching chain"}
"""What the step of a method is called."""
COARSE = 1e-3
"""A tolerance above this is compared with a tenth of it instead."""


def second(method: str, given: float) -> float:
    """The step of a second run by a method of `STEPPED`, the tolerance of an adaptive one."""
    if method in STEPPED:
        return given * SECOND[method]
    return given * SECOND["tolerance"] if given <= COARSE else given / SECOND["tolerance"]


def refuse_unknown(
    motion: Moved, method: str, given: float, again: Callable[[float], Moved], *, settable: bool = True
) -> None:
    """Raise InputError for a far motion that another step, or another tolerance, does not confirm.

    `given` is the first run's, and `settable` by whoever asked; `again` runs the motion with another, kept at the same
    times. A motion that stopped early is left to whoever asked for it.
    """
    if not motion.finished or (turned := _furthest(motion)) <= FAR:
        return
    name, other = STEPPED.get(method, "tolerance"), second(method, given)
    check = again(other)
    if check.statistics.interrupted:
        raise KeyboardInterrupt
    apart = gaps(motion, check)
    if not (parted := ~(apart <= KNOWN)).any():
        return
    first = int(np.argmax(parted))
    seen = (
        f"the chain stands {100.0 * apart[first]:.3g} % of its largest deflection elsewhere"
        if first < len(check.times)
        else f"it {check.statistics.stopped}"
    )
    raise InputError(
        f"{name} = {given:g} leaves the motion unknown after {motion.times[first]:.4g} s: links turn by up to "
        f"{turned:.2g} rad, and with {name} = {other:g} {seen}; give {f'a smaller {name}, ' * settable}a shorter "
        "time or smaller forces"
    )


def gaps(one: Moved, other: Moved) -> Array:
    """How far the joints of two motions lie apart across, (n,), over the first's largest deflection until then.

    Infinite at times that the other did not reach.
    """
    heights, others = _heights(one), _heights(other)
    kept, largest = len(others), np.maximum.accumulate(abs(heights).max(axis=1))
    found = np.full(len(heights), np.inf)
    found[:kept] = abs(heights[:kept] - others).max(axis=1) / np.where(largest > 0.0, largest, 1.0)[:kept]
    return found


def _furthest(motion: ChainMotion | ElasticMotion) -> float:
    """The largest turn of a link from the straight chain, of links that stretch at the times kept, radians."""
    if isinstance(motion, ChainMotion):
        return motion.statistics.furthest
    spans = np.diff(motion.displacements, axis=1)
    return float(abs(np.arctan2(spans[..., 1], motion.system.lengths + spans[..., 0])).max())


def _heights(motion: ChainMotion | ElasticMotion) -> Array:
    """Y of joints 1..N at the times kept, (n, N), metres."""
    if isinstance(motion, ElasticMotion):
        return motion.displacements[:, 1:, 1]
    return np.asarray(np.cumsum(motion.system.lengths * np.sin(motion.directions()), axis=1))
