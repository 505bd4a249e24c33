"""The nonlinear chain from rest under a slider, rigid or stretching: broken-off and unknown motions are refused."""

from collections.abc import Callable
from math import inf

from verify.chain.dynamics import at_rest
from verify.chain.far import refuse_unknown
from verify.chain.result import ChainMotion
from verify.chain.stepping import simulate
from verify.chain.stretching import ElasticMotion, simulate_elastic
from verify.chain.system import ChainSystem
from verify.errors import InputError, near_name
from verify.models.arrays import Array
from verify.options import LINKS, Links


def check_known(links: str) -> None:
    """Raise InputError for links that no chain has."""
    if links not in LINKS:
        raise InputError(f"links = {links!r} is not known: {near_name(links, LINKS)}")


def from_rest(
    system: ChainSystem,
    links: Links,
    axial_stiffness: Array,
    times: Array,
    *,
    tolerance: float,
    settable: bool = False,
    most: float = inf,
    progress: Callable[[float], None] = lambda part: None,
) -> ChainMotion | ElasticMotion:
    """The motion from rest, kept at `times`, (n,), even from 0, s.

    `axial_stiffness` (N,), newton, is that of links that stretch; rigid ones are moved by adaptive steps of
    `tolerance`, which whoever asks may give where it is `settable`. Raises InputError for a run that takes too much or
    breaks off, and for a far one that another tolerance, or half the step, does not confirm (`chain.far`);
    KeyboardInterrupt for one that was broken off.
    """
    check_known(links)
    if links == "stretching":
        moved = simulate_elastic(system, axial_stiffness, times, most=most)
        confirm_stretching(moved, most)
        return moved

    def run(tolerance: float, most: float, progress: Callable[[float], None]) -> ChainMotion:
        return simulate(system, at_rest(system), times, tolerance=tolerance, ledger=False, most=most, progress=progress)

    found = run(tolerance, most, progress)
    check_moved(found)
    refuse_unknown(found, "adaptive", tolerance, lambda other: run(other, most, lambda part: None), settable=settable)
    return found


def confirm_stretching(moved: ElasticMotion, most: float) -> None:
    """Raise as `from_rest` does for a stretching chain from rest that broke off, or that half its step parts from."""
    check_moved(moved)

    def again(step: float) -> ElasticMotion:
        return simulate_elastic(moved.system, moved.axial_stiffness, moved.times, step=step, most=2.0 * most)

    refuse_unknown(moved, "stretching", moved.statistics.step_s, again, settable=False)


def check_moved(moved: ChainMotion | ElasticMotion) -> None:
    """Raise InputError for a chain's motion that broke off, KeyboardInterrupt for one that was broken off."""
    if moved.statistics.interrupted:
        raise KeyboardInterrupt
    if not moved.finished:
        raise InputError(f"the chain's motion {moved.statistics.stopped}: give smaller forces")
