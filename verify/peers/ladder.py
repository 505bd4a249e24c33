"""How long a step may be: errors of runs, and the search for the longest step within a wanted one. No engine here."""

from collections.abc import Callable
from math import exp, inf, isfinite, log, sqrt
from typing import TypeVar

import numpy as np

from verify.checks import check_number
from verify.field_docs import Value
from verify.models.arrays import Array
from verify.peers.case import PeerRun

FINEST = 1.15
"""Two steps nearer than this are not told apart."""
HALVINGS = 14
CAREFUL = 0.98
"""Of a step guessed by a power law, so that it is good enough where the law holds."""
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
    """The longest step whose run is within `wanted` of a reference: shortened from `first` on, then closed in upon.

    `reference` gives the error of what `run` gave: nan or infinite where that broke. The step is within FINEST of one
    that is too long; all shorter ones tried are good enough. `clock` are the seconds of a run: one that will take more
    than `patience` is not begun. Steps go by the power law of the last two where they follow one. Raises InputError.
    """
    check_number("first", first, "seconds", above=0)
    check_number("wanted", wanted, "relative error", above=0)
    tried: list[Tried] = []
    step, took, why = first, 0.0, ""
    while not why and step:
        if tried and took * tried[-1].step > patience * step:
            why = f"a step of {step:.3g} s takes more than {patience:g} s"
            break
        found = run(step)
        took, error = clock(found), reference(found)
        tried.append(Tried(step=step, error=error if isfinite(error) else inf))
        good, bad = _bracket(tried, wanted)
        step, why = (_longer(good, bad, tried, wanted), "") if good else (_shorter(tried, wanted), _hopeless(tried))
    good, _ = _bracket(tried, wanted)
    best = good or min(tried, key=lambda rung: rung.error)
    ladder = tuple(sorted(tried, key=lambda rung: -rung.step))
    return Rung(step=best.step, error=best.error, why_not="" if good else why, tried=ladder)


def _bracket(tried: list[Tried], wanted: float) -> tuple[Tried | None, Tried | None]:
    """The longest step that was good enough and the shortest that was not."""
    good = [rung for rung in tried if rung.error <= wanted]
    bad = [rung for rung in tried if rung.error > wanted]
    return max(good, key=_length, default=None), min(bad, key=_length, default=None)


def _length(rung: Tried) -> float:
    return rung.step


def _shorter(tried: list[Tried], wanted: float) -> float:
    """The next step where none was good enough: half, or where the power law of the last two would be."""
    last = tried[-1]
    guess = _by_power(tried[-2], last, wanted) if len(tried) > 1 else 0.0
    return min(max(CAREFUL * guess, last.step / 8.0), last.step / FINEST) if guess else 0.5 * last.step


def _longer(good: Tried, bad: Tried | None, tried: list[Tried], wanted: float) -> float:
    """The next step between a good one and one that is too long; 0 where they are not told apart, or none is."""
    if bad is None or bad.step <= FINEST * good.step * (1.0 + 1e-9):
        return 0.0
    guess = CAREFUL * _by_power(good, bad, wanted) if tried[-1] is good else 0.0
    if guess <= FINEST * good.step:
        return FINEST * good.step if guess else sqrt(good.step * bad.step)
    return min(guess, bad.step / sqrt(FINEST))


def _by_power(one: Tried, other: Tried, wanted: float) -> float:
    """The step at which the power law through two rungs gives the wanted error; 0 where there is none."""
    long, short = (one, other) if one.step > other.step else (other, one)
    if not (isfinite(long.error) and 0.0 < FLOOR * long.error > short.error > 0.0):
        return 0.0
    order = log(long.error / short.error) / log(long.step / short.step)
    return short.step * exp(log(wanted / short.error) / order)


def _hopeless(tried: list[Tried]) -> str:
    """Why going on would find nothing; empty while it may."""
    last = [rung.error for rung in tried[-3:]]
    if len(last) == 3 and isfinite(last[0]) and last[1] > FLOOR * last[0] and last[2] > FLOOR * last[1]:
        return f"its error stays at {min(last):.1e} over shorter steps"
    if len(tried) > HALVINGS:
        return f"no step down to {tried[-1].step:.3g} s was good enough"
    return ""


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
