"""Which member of the family a list is of, and how surely: differences of log frequencies, and what may be wrong first.

A list may be in another unit, scaled by one factor, lack modes or have some too many: each such reading of it costs
something in the comparison, so that none is taken up unless it explains what the plain one does not.
"""

from collections.abc import Callable, Sequence
from functools import partial
from itertools import product
from math import exp, inf, log, pi, sqrt

import msgspec
import numpy as np

from verify.identify.alignment import BAND, Pairs, aligned_pairs, in_order_of
from verify.identify.clamps import Clamp
from verify.identify.family import EXACT, Candidate, Solver, goes_up_and_down, inner_places
from verify.identify.searching import best_size, closest
from verify.models.arrays import Array

FLOOR = 1e-9
"""Relative difference of frequencies that eigenvalue solvers leave: smaller ones are alike."""
SURE = 100.0
"""By how much likelier the best has to be than another for both to be told apart, with noise of unknown size."""
TOLERANCE = 1e-3
"""Up to here a candidate is said to explain a list."""
UNITS = {
    2.0 * pi: "too large by 2 pi: they are in rad/s, not Hz",
    0.5 / pi: "too small by 2 pi: they were divided by 2 pi once too often",
    1e3: "too large by 1000: they are in mHz, or lengths or stiffnesses in another unit",
    1e-3: "too small by 1000: they are in kHz",
    60.0: "too large by 60: they are per minute, not per second",
    1.0 / 60.0: "too small by 60: they were divided by 60",
    2e3 * pi: "too large by 2000 pi: they are in rad/s, and off by 1000",
    0.5e-3 / pi: "too small by 2000 pi: they are in rad/ms, or divided by 2 pi and 1000",
}
"""Factors that a wrong unit brings, and which."""
_NEAR_UNIT = 0.06
"""Difference in log frequency up to which a common factor may be a wrong unit and something else: E or rho off by an
eighth, as handbooks differ; 7.5 is no 2 pi."""
_UNKNOWN_NOISE = 1e-4
"""Relative; of a list that is too short to show its own."""
_ANYWHERE_NEAR = 0.7
"""Difference in log frequency that dividing a beam and missing a mode or two may make."""
UNIT_COST, SCALE_COST, _SKIP_COST = 5.0, 9.0, 6.0
"""In natural logarithms of likelihood."""
_CLOSER = 6
"""Candidates that are looked at closely on a beam with steps."""
_MEDIAN = pi / 2.0
"""Variance of a median over that of a mean, of normal noise."""
_TOLD_OFF = 0.975
"""Of the chance that what was fitted lies below its upper bound: two bounds hold 95 of a hundred."""


class Fit(msgspec.Struct, frozen=True, eq=False, kw_only=True):
    """One candidate beside a list."""

    candidate: Candidate
    count: int | None
    pairs: Pairs
    factor: float
    """What the list is multiplied by, all of it, over the candidate."""
    differences: Array
    """(k,), relative, list over candidate without the factor."""
    residual: float
    """Root mean square of the differences, less what the rounding of the list explains."""
    score: float
    """Minus log likelihood with noise of unknown size, and what its reading costs: the least is best."""
    clamp: Clamp | None = None
    """The rotational spring that stands in place of a clamped end; None where the walls are those of the scene."""
    weight: float = 0.0
    """Of all differences on what was fitted, relative: noise of one on each puts it off by 1 / weight; 0 of nothing."""

    @property
    def fitted(self) -> float:
        """Logarithm of what was fitted to the list: a clamp's stiffness, else the factor."""
        return log(self.factor if self.clamp is None else self.clamp.stiffness)


class Reading(msgspec.Struct, frozen=True, kw_only=True):
    """How a list may be read."""

    factor: float | None
    """None: whatever fits."""
    aligned: bool
    """Whether modes may be missing or too many."""
    cost: float


PLAIN = Reading(factor=1.0, aligned=False, cost=0.0)
SCALED = Reading(factor=None, aligned=False, cost=SCALE_COST)
FEWEST = 3
"""Entries below which a factor or a spring may always be fitted."""


def in_order(n: int, units: Sequence[float]) -> tuple[Reading, ...]:
    """Readings by which no mode is missing, the plain one first."""
    scaled = [Reading(factor=factor, aligned=False, cost=UNIT_COST) for factor in units]
    return PLAIN, *scaled, *([SCALED] if n >= FEWEST else [])


def with_gaps(units: Sequence[float]) -> tuple[Reading, ...]:
    """Readings by which modes are missing or too many."""
    factors = {1.0: 0.0} | dict.fromkeys(units, UNIT_COST)
    return tuple(Reading(factor=factor, aligned=True, cost=cost) for factor, cost in factors.items())


def fit(
    listed: Array,
    rounding: Array,
    candidate: Candidate,
    count: int | None,
    found: Array,
    reading: Reading,
    paired: Pairs | None,
) -> Fit | None:
    """One candidate's frequencies `found` (m,) beside a list (n,), both Hz; None where it has too few.

    `paired` where the pairs are known already.
    """
    n = len(listed)
    logs, known = np.log(listed), np.log(found) if len(found) else np.empty(0)
    pairs = paired or in_order_of(n)
    if reading.aligned:
        if len(known) < n - BAND:
            return None
        pairs = aligned_pairs(logs - log(reading.factor or 1.0), known)
        if not pairs.skips(n):
            return None  # the same as in order
    if len(pairs.modes) == 0 or pairs.modes.max() >= len(known):
        return None
    raw = logs[pairs.entries] - known[pairs.modes]
    shift = float(np.median(raw)) if reading.factor is None else log(reading.factor)
    weight = sqrt(len(raw) / _MEDIAN) if reading.factor is None else 0.0
    off = rounding[pairs.entries]
    return judged_fit(candidate, count, pairs, raw - shift, exp(shift), off, reading.cost, n, weight=weight)


def judged_fit(
    candidate: Candidate,
    count: int | None,
    pairs: Pairs,
    logs: Array,
    factor: float,
    rounding: Array,
    cost: float,
    n: int,
    clamp: Clamp | None = None,
    weight: float = 0.0,
) -> Fit:
    """A candidate by what is left of it, `logs` (k,): its residual and its score among n entries."""
    beyond = np.maximum(abs(logs) - rounding, 0.0)
    residual = float(np.sqrt(np.mean(beyond**2)))
    most = len(pairs.entries) >= min(3, n) and 2 * len(pairs.entries) > n
    total = cost + pairs.skips(n) * _SKIP_COST if most else inf
    return Fit(
        candidate=candidate,
        count=count,
        pairs=pairs,
        factor=factor,
        differences=np.expm1(logs),
        residual=residual,
        score=n * log(sqrt(residual**2 + FLOOR**2)) + total,
        clamp=clamp,
        weight=weight,
    )


class Identified(msgspec.Struct, frozen=True, eq=False, kw_only=True):
    """What a list is, as far as it can be told."""

    fits: tuple[Fit, ...]
    """Every candidate by the best one's reading of the list, the best first."""
    reading: Reading
    alike: tuple[Fit, ...]
    """The others that the best cannot be told apart from."""
    systematic: bool
    """Whether what is left over goes smoothly with the mode, as noise would not."""
    rivals: tuple["Identified", ...] = ()
    """What else may be behind the list: other readings, or a clamp that gives, that leave about as much."""
    read_as: str = "Hz"
    """The unit that somebody said the list is in."""
    short: bool = False
    """Whether it has so few entries beside what was fitted that a fit is no evidence."""

    @property
    def best(self) -> Fit:
        """The best."""
        return self.fits[0]

    @property
    def next(self) -> Fit | None:
        """The best of those that it can be told apart from."""
        return next((fit for fit in self.fits[1:] if fit not in self.alike), None)

    @property
    def same(self) -> tuple[Fit, ...]:
        """Those of `alike` that have the same frequencies, so that no list tells them apart."""
        return tuple(one for one in self.alike if same(one, self.best))

    @property
    def doubtful(self) -> tuple[Fit, ...]:
        """Those of `alike` that a longer, cleaner or coarser list would tell apart."""
        return tuple(one for one in self.alike if not same(one, self.best))

    @property
    def explained(self) -> bool:
        """Whether the best is it: within the tolerance, but noise left over, of a list that is long enough."""
        return self.best.residual <= TOLERANCE and not self.systematic and not self.short

    @property
    def give_or_take(self) -> float:
        """How far what was fitted may be off, relative: by noise of the size that is left, and by another candidate.

        Student's 95 % of the one, and how far those that the list does not tell apart lie from the best; infinite of
        one mode, 0 where nothing was fitted.
        """
        best, free = self.best, len(self.best.pairs.entries) - 1
        if not best.weight:
            return 0.0
        if not free:
            return inf
        from scipy.special import stdtrit

        scatter = sqrt(float(np.sum(np.log1p(best.differences) ** 2)) / free)
        noise = float(stdtrit(free, _TOLD_OFF)) * scatter / best.weight
        return noise + max((abs(one.fitted - best.fitted) for one in self.alike), default=0.0)

    @property
    def odds(self) -> float:
        """How many times farther off the next one is; infinite where there is none."""
        following = self.next
        return following.residual / max(self.best.residual, FLOOR) if following else inf


class Data(msgspec.Struct, frozen=True, eq=False, kw_only=True):
    """What is to be identified, and on what."""

    listed: Array
    """(n,), Hz, elastic modes alone."""
    rounding: Array
    """(n,), relative."""
    family: tuple[Candidate, ...]
    solver: Solver
    read_as: str = "Hz"
    paired: Pairs | None = None
    """Where mode numbers or shapes say which mode each entry is."""
    sizes: dict[Candidate, tuple[int, ...]] = {}
    """Sizes that were found by a closer look."""

    def fit(self, candidate: Candidate, count: int | None, reading: Reading, paired: Pairs | None) -> Fit | None:
        """One candidate at one size."""
        found = self.solver.or_nothing(candidate, count)
        return fit(self.listed, self.rounding, candidate, count, found, reading, paired)


def units(data: Data) -> tuple[float, ...]:
    """Those factors of a wrong unit that bring the list anywhere near the exact beam."""
    pairs = data.paired or in_order_of(len(data.listed))
    exact = data.solver.or_nothing(Candidate(model=EXACT), None)
    off = float(np.median(np.log(data.listed[pairs.entries] / exact[pairs.modes])))
    return tuple(factor for factor in UNITS if abs(off - log(factor)) < _ANYWHERE_NEAR)


def beyond_unit(factor: float) -> tuple[float, float]:
    """(a factor less the wrong unit that it is near to, that unit's factor): the factor itself and 1 of none."""
    unit = min((1.0, *UNITS), key=lambda one: abs(log(factor / one)))
    near = abs(log(factor / unit)) < _NEAR_UNIT
    return (factor / unit, unit) if near else (factor, 1.0)


def best_of(data: Data, count: int | None, among: Sequence[Reading]) -> Identified | None:
    """The likeliest candidate by the likeliest of these readings; None where none has so many modes."""
    fits = _fits(data, count, among)
    plainly = any(_settled(one) for (_, reading), one in fits.items() if reading == among[0])
    if count is None and not plainly and _looked_closer(data, fits, among):
        fits = _fits(data, count, among)
    best: Fit | None = None
    of_it = PLAIN
    for (_, reading), one in fits.items():
        if best is None or one.score < (best.score - 1e-6 * abs(best.score) if best.score < inf else inf):
            best, of_it = one, reading
    return None if best is None else _ranked(data, best, of_it, count)


def _fits(data: Data, count: int | None, among: Sequence[Reading]) -> dict[tuple[Candidate, Reading], Fit]:
    """The best of every candidate by every reading."""
    tried = (
        (candidate, reading, _sized(partial(_tried, data, candidate, reading, data.paired), data, candidate, count))
        for candidate, reading in product(data.family, among)
    )
    return {(candidate, reading): one for candidate, reading, one in tried if one is not None}


def _tried(data: Data, candidate: Candidate, reading: Reading, paired: Pairs | None, count: int | None) -> Fit | None:
    return data.fit(candidate, count, reading, paired)


def _sized(
    tried: Callable[[int | None], Fit | None], data: Data, candidate: Candidate, count: int | None
) -> Fit | None:
    """The fit at a size, or at the best of all sizes."""
    if not candidate.sized or count is not None:
        return tried(count if candidate.sized else None)
    return best_size(tried, data.sizes.get(candidate, ()))


def _settled(one: Fit) -> bool:
    """Whether but rounding is left over."""
    return one.residual <= FLOOR


def _looked_closer(data: Data, fits: dict[tuple[Candidate, Reading], Fit], among: Sequence[Reading]) -> bool:
    """Whether there are better sizes, kept in `data.sizes`: those of other readings, or where errors go up and down.

    Of all chains that carry bodies on their links, and, of a beam with steps, of the candidates that are nearest.
    """
    by_another = {one.candidate: one.count for one in fits.values() if one.count is not None and _settled(one)}
    if by_another:
        data.sizes.update({one: (*data.sizes.get(one, ()), count) for one, count in by_another.items()})
        return True
    beam, score = data.solver.beam, {key: one.score for key, one in fits.items()}
    uneven = [one for one in data.family if one.sized and goes_up_and_down(beam, one)]
    best = {one: min(among, key=lambda reading: score.get((one, reading), inf)) for one in uneven}
    nearest = sorted(uneven, key=lambda one: (one.attachment is None, score.get((one, best[one]), inf)))
    carrying = sum(one.attachment is not None for one in uneven)
    places = inner_places(beam)
    found = False
    for one in nearest[: max(carrying, _CLOSER)]:
        for reading in dict.fromkeys([among[0], best[one]]):
            tried = partial(_tried, data, one, reading, data.paired)
            fit = closest(tried, places if one.attachment is not None else (), data.sizes.get(one, ()), _settled)
            if fit is not None and fit.count is not None:
                data.sizes[one] = (*data.sizes.get(one, ()), fit.count)
                found = True
                if _settled(fit):
                    return True
    return found


def _ranked(data: Data, best: Fit, reading: Reading, count: int | None) -> Identified:
    """All candidates by the best one's pairs and factor, those as near as the best named."""
    known = Reading(factor=reading.factor, aligned=False, cost=reading.cost)
    sized = (_sized(partial(_tried, data, one, known, best.pairs), data, one, count) for one in data.family)
    return ranked(data, [one for one in sized if one is not None], reading)


def ranked(data: Data, found: Sequence[Fit], reading: Reading) -> Identified:
    """Fits of candidates by one reading, one at least, the best first, those as near as it named."""
    place = {candidate: i for i, candidate in enumerate(data.family)}
    fitted = reading.cost >= SCALE_COST  # a number to the list, so that its last digits tell nobody apart
    floor = max(FLOOR, float(np.median(data.rounding))) if fitted else FLOOR
    fits = _preferred(sorted(found, key=lambda one: (max(one.residual, FLOOR), place[one.candidate])), place)
    n = len(fits[0].pairs.entries)
    return Identified(
        fits=fits,
        reading=reading,
        alike=tuple(one for one in fits[1:] if likelier(fits[0], one, n, floor) < SURE),
        systematic=smooth(fits[0], data.rounding),
    )


def _preferred(fits: list[Fit], place: dict[Candidate, int]) -> tuple[Fit, ...]:
    """Among those that fit the same to rounding, the earliest of the family first."""
    first = min((one for one in fits if same(one, fits[0])), key=lambda one: place[one.candidate])
    return (first, *(one for one in fits if one is not first))


def same(one: Fit, other: Fit) -> bool:
    """Whether two candidates have the same frequencies, to rounding."""
    return bool(abs(one.differences - other.differences).max() <= 10.0 * FLOOR)


def likelier(best: Fit, other: Fit, n: int, floor: float = FLOOR) -> float:
    """How many times likelier the best is, noise of unknown size on n modes; rounding, `floor`, tells nobody apart.

    One or two modes say nothing of their noise, so that `_UNKNOWN_NOISE` is supposed.
    """
    floor = floor if n > 2 else _UNKNOWN_NOISE
    ratio = sqrt(other.residual**2 + floor**2) / sqrt(best.residual**2 + floor**2)
    return exp(min(n * log(ratio), 700.0)) if ratio > 1.0 else 1.0


def smooth(one: Fit, rounding: Array) -> bool:
    """Whether differences go with the mode: their steps are small beside them (von Neumann's ratio, 2 of noise).

    Of normal noise on six to ten modes at most one list in a hundred is called so (400 000 draws of each): one where
    nothing was fitted, fewer where a factor or a clamp took some of it, and of more modes.
    """
    values = np.log1p(one.differences)
    if len(values) < 6 or one.residual <= 1e-7 or one.residual < float(np.median(rounding)):
        return False
    least = min(0.067 * len(values) - 0.075, 0.6)
    return float(np.sum(np.diff(values) ** 2) / np.sum(values**2)) < least


def deviates(exact: Array, listed: Array, fitted: Fit) -> float:
    """Largest difference of a list from the exact beam, its factor taken out."""
    return float(abs(listed[fitted.pairs.entries] / fitted.factor / exact[fitted.pairs.modes] - 1.0).max())
