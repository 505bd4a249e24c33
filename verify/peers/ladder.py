"""How long a step may be: errors of runs, and the search for the longest step within a wanted one. No engine here."""

from collections.abc import Callable
from math import inf, isfinite, sqrt
from typing import TypeVar

import numpy as np

from verify.checks import check_number
from verify.field_docs import Value
from verify.models.arrays import Array
from verify.peers.case import PeerRun

FINEST = 1.15
"""Two steps nearer than this are not told apart."""
HALVINGS = 14
FLOOR = 0.8
"""An error that falls to more than this share twice over halved steps has reached its floor."""
LEAST_SAMPLES = 40
R = TypeVar("R")


class Tried(Value, frozen=True, kw_only=True):
    """One rung."""

    step: float
    """Seconds."""
    error: float
    """Infinite where the run broke."""


class Rung(Value, frozen=True, kw_only=True):
    """What a ladder found."""

    step: float
    """The longest step within the wanted error; where none was found the one of the least error, seconds."""
    error: float
    """At that step."""
    why_not: str
    """Why no step was found; empty where one was."""
    tried: tuple[Tried, ...]
    """From the longest step on."""

    @property
    def reached(self) -> bool:
        """Whether a step was found."""
        return not self.why_not


def longest_step(
    run: Callable[[float], R],
    first: float,
    wanted: float,
    reference: Callable[[R], float],
    *,
    patience: float = inf,
    clock: Callable[[R], float] = lambda found: 0.0,
) -> Rung:
    """The longest step whose run is within `wanted` of a reference: halved from `first` on, then bisected.

    `reference` gives the error of what `run` gave: nan or infinite where that broke. The step is within FINEST of one
    that is too long; all shorter ones tried are good enough. `clock` are the seconds of a run: one that will take more
    than `patience` is not begun. Raises InputError.
    """
    check_number("first", first, "seconds", above=0)
    check_number("wanted", wanted, "relative error", above=0)
    tried: list[Tried] = []
    took = 0.0
    step, good, bad, why = first, 0.0, inf, ""
    while True:
        if took * _longer(tried, step) > patience:
            why = f"a step of {step:.3g} s takes more than {patience:g} s"
            break
        found = run(step)
        took, error = clock(found), reference(found)
        tried.append(Tried(step=step, error=error if isfinite(error) else inf))
        good, bad = (step, bad) if tried[-1].error <= wanted else (good, min(bad, step))
        if good:
            if bad / good <= FINEST or bad == inf:
                break
            step = sqrt(good * bad)
        else:
            if why := _hopeless(tried):
                break
            step *= 0.5
    return _rung(tried, good, why if not good else "")


def _longer(tried: list[Tried], step: float) -> float:
    """How many times as long as the last run one of this step takes."""
    return tried[-1].step / step if tried else 1.0


def _hopeless(tried: list[Tried]) -> str:
    """Why halving on would find nothing; empty while it may."""
    last = [rung.error for rung in tried[-3:]]
    if len(last) == 3 and isfinite(last[0]) and last[1] > FLOOR * last[0] and last[2] > FLOOR * last[1]:
        return f"its error stays at {min(last):.1e} over shorter steps"
    if len(tried) > HALVINGS:
        return f"no step down to {tried[-1].step:.3g} s was good enough"
    return ""


def _rung(tried: list[Tried], good: float, why: str) -> Rung:
    ladder = tuple(sorted(tried, key=lambda rung: -rung.step))
    best = min(ladder, key=lambda rung: abs(rung.step - good) if good else rung.error)
    return Rung(step=best.step, error=best.error, why_not=why, tried=ladder)


def relative_rms(values: Array, exact: Array) -> float:
    """Rms of a difference over the rms of what is exact; infinite where a value is not finite."""
    if not np.isfinite(values).all():
        return inf
    return float(np.sqrt(np.mean((values - exact) ** 2) / np.mean(exact**2)))


def deflection_error(run: PeerRun, exact: Callable[[Array], Array]) -> float:
    """Relative rms error of mid-span over the samples kept; infinite where a run broke or kept too few to tell."""
    if run.broke or len(run.times) < LEAST_SAMPLES:
        return inf
    return relative_rms(run.deflection, exact(run.times))


def ride_error(run: PeerRun, exact: Callable[[Array], tuple[Array, Array]]) -> float:
    """The larger of the relative rms errors of a slider's distance and of its speed; infinite likewise."""
    if run.broke or len(run.times) < LEAST_SAMPLES:
        return inf
    pairs = zip((run.distance, run.speed), exact(run.times), strict=True)
    return max(relative_rms(found, true) for found, true in pairs)
