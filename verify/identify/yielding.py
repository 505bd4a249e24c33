"""What a list is if a clamped end of the beam gives: one fitted spring beside each candidate of the family.

Sizes are looked for by what the exact frequencies lose, times those of the candidate at rigid walls; the spring is then
fitted to the candidate's own frequencies, by Gauss and Newton in its compliance.
"""

from collections.abc import Iterator
from functools import partial
from itertools import product
from math import exp

import msgspec
import numpy as np

from verify.errors import InputError
from verify.identify.alignment import Pairs, in_order_of
from verify.identify.clamps import SOFTEST, STIFFEST, Loss, clamp_of, clamped_ends, loss_of, softened
from verify.identify.family import EXACT, Candidate, frequencies_hz
from verify.identify.fitting import (
    FEWEST,
    FLOOR,
    SCALE_COST,
    UNIT_COST,
    Data,
    Fit,
    Identified,
    Reading,
    judged_fit,
    ranked,
    units,
)
from verify.identify.searching import best_size, downhill
from verify.models.arrays import Array

READING = Reading(factor=1.0, aligned=False, cost=SCALE_COST)
"""As a common factor, a clamp that gives costs one fitted number."""
_CLOSER = 6
"""Candidates whose own frequencies the spring is fitted to: the nearest, and all of Euler and Bernoulli."""
_STEPS, _SETTLED = 12, 1e-10
"""Of a fit, and the change of frequencies, relative, at which it has settled."""
SHARE, CREDIBLE = 0.1, 0.02
"""What may be left: of the change that a cause makes, and at most, for it to explain a list."""


def yielding(data: Data, count: int | None) -> tuple[Identified, ...]:
    """What the list is if the left clamped end gives, the right one, both, in hertz or another unit: what there is."""
    if len(data.listed) < FEWEST:
        return ()
    tried = product((1.0, *units(data)), clamped_ends(data.solver.beam))
    found = (_in_unit(data, count, factor, ends) for factor, ends in tried)
    return tuple(one for one in found if one is not None)


def _in_unit(data: Data, count: int | None, factor: float, ends: tuple[str, ...]) -> Identified | None:
    """The same of a list that is too large by a factor."""
    found = _of_ends(msgspec.structs.replace(data, listed=data.listed / factor), count, ends)
    if found is None or factor == 1.0:
        return found
    reading = Reading(factor=factor, aligned=False, cost=READING.cost + UNIT_COST)
    fits = [msgspec.structs.replace(one, factor=factor, score=one.score + UNIT_COST) for one in found.fits]
    return ranked(data, fits, reading)


def frequencies_of(data: Data, one: Fit) -> Array:
    """The frequencies of a candidate as it was fitted, its clamp included, (n_modes or fewer,), Hz."""
    beam, size = data.solver.beam, one.count if one.candidate.sized else None
    if one.clamp is None:
        return data.solver(one.candidate, size)
    return frequencies_hz(one.candidate, softened(beam, one.clamp), size, data.solver.n_modes)


def _of_ends(data: Data, count: int | None, ends: tuple[str, ...]) -> Identified | None:
    """All candidates with a spring at these ends; None where none has one within what is looked for."""
    try:
        loss = loss_of(data.solver.beam, ends, data.solver.n_modes)
    except InputError:
        return None
    near = sorted(_near(data, loss, ends, count), key=lambda one: one.score)
    if not near or not borne_out(near[0], 2.0):
        return None
    plain = [one for one in near if one.candidate.theory == "euler-bernoulli"]
    closer = [*plain, *(one for one in near[:_CLOSER] if one not in plain)]
    found: list[Fit] = []
    for one in sorted(closer, key=lambda one: one.candidate.sized):
        enough = count is not None or any(settled(fit, data) for fit in found)
        found += [fit] if (fit := _close(data, loss, ends, one, searched=not enough)) is not None else []
    return ranked(data, found, READING) if found else None


def borne_out(one: Fit, times: float = 1.0) -> bool:
    """Whether a clamp that gives leaves little of the change that it makes, about 2 EI/(k_r L)."""
    assert one.clamp is not None
    return one.residual <= times * min(CREDIBLE, SHARE * 2.0 / one.clamp.stiffness)


def settled(one: Fit, data: Data) -> bool:
    """Whether but the rounding of the list is left."""
    return one.residual <= max(FLOOR, float(np.median(data.rounding)))


def _near(data: Data, loss: Loss, ends: tuple[str, ...], count: int | None) -> Iterator[Fit]:
    """Every candidate, by what the exact frequencies lose; of unknown size Euler's and Bernoulli's alone."""
    for one in data.family:
        if not one.packaged or one.attachment is not None or one.wall == "welded":
            continue
        if count is None and one.sized and one.theory != "euler-bernoulli":
            continue
        tried = partial(_lost, data, loss, ends, one)
        near = best_size(tried) if count is None and one.sized else tried(count if one.sized else None)
        if near is not None:
            yield near


def _lost(data: Data, loss: Loss, ends: tuple[str, ...], candidate: Candidate, count: int | None) -> Fit | None:
    """A candidate's frequencies at rigid walls, less what the best clamp takes of the exact ones."""
    found, pairs = data.solver.or_nothing(candidate, count), _pairs(data)
    if pairs.modes.max() >= min(len(found), loss.logs.shape[1]):
        return None
    raw = np.log(data.listed[pairs.entries]) - np.log(found[pairs.modes])
    logs = loss.logs[:, pairs.modes]
    off = raw - logs
    at = int(np.clip(np.argmin(np.sum(off**2, axis=1)), 1, len(logs) - 2))
    slope = (logs[at + 1] - logs[at - 1]) / 2.0
    step = float(np.clip(float(slope @ off[at]) / float(slope @ slope), -1.0, 1.0))
    ratio = float(loss.compliances[1] / loss.compliances[0])
    return _fit(data, candidate, count, ends, float(loss.compliances[at]) * ratio**step, off[at] - step * slope)


def _close(data: Data, loss: Loss, ends: tuple[str, ...], near: Fit, *, searched: bool) -> Fit | None:
    """The same with the candidate's own frequencies on that clamp, where `searched` at the best size from there on."""
    tried = partial(_fitted, data, loss, ends, near)
    if not searched or near.count is None:
        return tried(near.count)
    known: dict[int, Fit | None] = {near.count: tried(near.count)}
    return known[downhill(tried, known, near.count, lambda size: 1)]


def _fitted(data: Data, loss: Loss, ends: tuple[str, ...], near: Fit, count: int | None) -> Fit | None:
    """A candidate at one size with the clamp that fits best; None where that is beyond what is looked for."""
    assert near.clamp is not None
    pairs, compliance = _pairs(data), 1.0 / near.clamp.stiffness
    slope, enough = _slope(loss, compliance, pairs), max(_SETTLED, 0.01 * float(np.median(data.rounding)))
    off = _off(data, near.candidate, count, ends, compliance, pairs)
    for _ in range(_STEPS):
        if off is None:
            return None
        step = float(np.clip(float(slope @ off) / float(slope @ slope), -1.0, 1.0))
        if abs(step) * float(abs(slope).max()) < enough:
            break
        compliance *= exp(step)
        if not 1.0 / STIFFEST < compliance < 1.0 / SOFTEST:
            return None
        before, off = off, _off(data, near.candidate, count, ends, compliance, pairs)
        slope = slope if off is None else (before - off) / step
    return None if off is None else _fit(data, near.candidate, count, ends, compliance, off)


def _slope(loss: Loss, compliance: float, pairs: Pairs) -> Array:
    """Of log frequency over log compliance, (paired modes,)."""
    logs, at = np.log(loss.compliances), int(np.searchsorted(loss.compliances, compliance))
    at = min(max(at, 1), len(logs) - 2)
    return np.asarray((loss.logs[at + 1] - loss.logs[at - 1])[pairs.modes] / (logs[at + 1] - logs[at - 1]))


def _off(
    data: Data, candidate: Candidate, count: int | None, ends: tuple[str, ...], compliance: float, pairs: Pairs
) -> Array | None:
    """Log of the list over a candidate on a clamp, paired; None where there is no such candidate."""
    beam = data.solver.beam
    clamped = softened(beam, clamp_of(beam, ends, compliance))
    try:
        found = frequencies_hz(candidate, clamped, count if candidate.model != EXACT else None, data.solver.n_modes)
    except InputError:
        return None
    if pairs.modes.max() >= len(found):
        return None
    data.solver.asked.add((candidate, count))
    return np.asarray(np.log(data.listed[pairs.entries]) - np.log(found[pairs.modes]))


def _pairs(data: Data) -> Pairs:
    return data.paired or in_order_of(len(data.listed))


def _fit(
    data: Data, candidate: Candidate, count: int | None, ends: tuple[str, ...], compliance: float, off: Array
) -> Fit:
    pairs = _pairs(data)
    rounding = data.rounding[pairs.entries]
    clamp = clamp_of(data.solver.beam, ends, compliance)
    loss = loss_of(data.solver.beam, ends, data.solver.n_modes)
    weight = float(np.linalg.norm(_slope(loss, compliance, pairs)))
    return judged_fit(candidate, count, pairs, off, 1.0, rounding, READING.cost, len(data.listed), clamp, weight)
