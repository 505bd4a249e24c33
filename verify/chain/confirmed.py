"""Motion of the nonlinear chain from rest, rigid or stretching; far motions are confirmed by a second run.

Links that turn far move chaotically before long: step errors grow by a factor for each of their swings, and a figure
with all its digits may have none that is right. Where links turn by more than `FAR` the motion is run again with ten
times the tolerance (or half the fixed step), and refused where the two runs part.
"""

from collections.abc import Callable
from typing import TypeVar

import numpy as np

from verify.arrays import Array
from verify.chain.dynamics import at_rest
from verify.chain.result import ChainMotion
from verify.chain.stepping import simulate
from verify.chain.stretching import ElasticMotion, simulate_elastic
from verify.chain.system import ChainSystem
from verify.errors import InputError
from verify.options import LINKS, Links
from verify.validation import check_word

Moved = TypeVar("Moved", ChainMotion, ElasticMotion)
FAR = 0.3
"""Radians: links that turn no further swing nearly as linear ones."""
KNOWN = 0.01
"""Of the largest deflection: distance of two runs that are one motion."""
COARSE = 1e-3
"""A tolerance above this is compared with a tenth of it instead of ten times it."""


def from_rest(
    system: ChainSystem,
    links: Links,
    axial_stiffness: Array,
    times: Array,
    *,
    tolerance: float,
    progress: Callable[[float], None] = lambda part: None,
) -> ChainMotion | ElasticMotion:
    """The motion from rest at `times`, (n,), evenly spaced from 0, s.

    `axial_stiffness` (N,), newton, is that of links that stretch; rigid ones are moved by adaptive steps of
    `tolerance`. Raises InputError for a run that diverges and for a far one that is not confirmed; KeyboardInterrupt
    for one that was interrupted.
    """
    check_word("links", links, LINKS)
    if links == "stretching":
        stretched = simulate_elastic(system, axial_stiffness, times)
        confirm_stretching(stretched)
        return stretched

    def run(tolerance: float) -> ChainMotion:
        return simulate(system, at_rest(system), times, tolerance=tolerance, ledger=False, progress=progress)

    found = run(tolerance)
    check_moved(found)
    refuse_unknown(found, "tolerance", tolerance, run)
    return found


def confirm_stretching(moved: ElasticMotion) -> None:
    """Raise as `from_rest` does for a stretching chain from rest."""
    check_moved(moved)
    stiffness, times = moved.axial_stiffness, moved.times
    refuse_unknown(
        moved,
        "step",
        moved.statistics.step_s,
        lambda step: simulate_elastic(moved.system, stiffness, times, step=step),
    )


def check_moved(moved: ChainMotion | ElasticMotion) -> None:
    """Raise InputError for a chain's motion that diverged, KeyboardInterrupt for one that was interrupted."""
    if moved.statistics.interrupted:
        raise KeyboardInterrupt
    if not moved.finished:
        raise InputError(f"the chain's motion {moved.statistics.stopped}: give smaller forces")


def refuse_unknown(motion: Moved, name: str, given: float, again: Callable[[float], Moved]) -> None:
    """Raise InputError for a far motion that another step or tolerance does not confirm.

    `name` is "step" or "tolerance" and `given` its value; `again` runs the motion with another, at the same times.
    """
    if not motion.finished or (turned := _furthest(motion)) <= FAR:
        return
    other = 0.5 * given if name == "step" else 10.0 * given if given <= COARSE else given / 10.0
    check = again(other)
    if check.statistics.interrupted:
        raise KeyboardInterrupt
    apart = ~(gaps(motion, check) <= KNOWN)
    if apart.any():
        raise InputError(
            f"{name} = {given:g} does not converge after {motion.times[int(np.argmax(apart))]:.4g} s, where links turn "
            f"by up to {turned:.2g} rad: another run with {name} = {other:g} departs from it; give a shorter time, "
            f"smaller forces or a smaller {name}"
        )


def gaps(one: Moved, other: Moved) -> Array:
    """Distance of the joints of two motions across, (n,), over the first's largest deflection until then.

    Infinite at times that the other did not reach.
    """
    heights, others = _heights(one), _heights(other)
    kept, largest = len(others), np.maximum.accumulate(abs(heights).max(axis=1))
    found = np.full(len(heights), np.inf)
    found[:kept] = abs(heights[:kept] - others).max(axis=1) / np.where(largest > 0.0, largest, 1.0)[:kept]
    return found


def _furthest(motion: ChainMotion | ElasticMotion) -> float:
    """Largest turn of a link from the straight chain, radians; of stretching links at the samples."""
    if isinstance(motion, ChainMotion):
        return motion.statistics.furthest
    spans = np.diff(motion.displacements, axis=1)
    return float(abs(np.arctan2(spans[..., 1], motion.system.lengths + spans[..., 0])).max())


def _heights(motion: ChainMotion | ElasticMotion) -> Array:
    """Y of joints 1..N at the samples, (n, N), metres."""
    if isinstance(motion, ElasticMotion):
        return motion.displacements[:, 1:, 1]
    return np.asarray(np.cumsum(motion.system.lengths * np.sin(motion.directions()), axis=1))
