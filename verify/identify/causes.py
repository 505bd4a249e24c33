"""What is behind a list: nothing, another unit, one factor, gaps, a clamp that gives; and what cannot be told apart.

The likeliest is taken. Where another leaves about as much, it is named beside and neither is claimed.
"""

from math import log

import msgspec
import numpy as np

from verify.identify.fitting import (
    FEWEST,
    FLOOR,
    PLAIN,
    SCALED,
    SURE,
    TOLERANCE,
    Data,
    Fit,
    Identified,
    best_of,
    beyond_unit,
    in_order,
    likelier,
    units,
    with_gaps,
)
from verify.identify.yielding import CREDIBLE, borne_out, settled, yielding

_SMALL_FACTOR = 5e-3
"""A common factor nearer to one is believed only where it leaves nothing to explain."""
_SHARE = 0.02
"""Of what a factor changes: one that leaves more does not explain the list."""
_SHARP = 1e-8
"""Rounding of a list, relative, below which what fits it but for rounding is no chance."""
_WRITTEN = 1e-6
"""The same of one or two frequencies of a known size: some forty candidates lie within a tenth of each other."""


def identify(data: Data, count: int | None) -> Identified | None:
    """As `_identify`, with the unit that the list was read in."""
    found, replace = _identify(data, count), msgspec.structs.replace
    if found is None:
        return None
    rivals = tuple(replace(one, read_as=data.read_as) for one in found.rivals)
    return replace(found, read_as=data.read_as, rivals=rivals)


def _identify(data: Data, count: int | None) -> Identified | None:
    """Which candidate a list is of, and what is behind it; None where none has so many modes.

    `count` is the number of its parts; None tries all plausible ones. A clamp that gives is looked for unless the list
    as it stands is one candidate's but for rounding, gaps where nothing else explains the list, they do, and nobody
    says which mode each entry is.
    """
    n, among = len(data.listed if data.paired is None else data.paired.entries), units(data)
    found = best_of(data, count, in_order(n, among))
    if n < FEWEST:
        return None if found is None else _of_few(found, data, count)
    soft = () if found is not None and _plainly(found, data, count) else yielding(data, count)
    soft = tuple(one for one in soft if borne_out(one.best))
    explained = any(one.explained for one in (found, *soft) if one is not None)
    if data.paired is None and not explained:
        gapped = best_of(data, count, with_gaps(among))
        if gapped is not None and _fills(gapped, data) and (found is None or gapped.best.score < found.best.score):
            found = gapped
    if found is not None and not _credible(found):
        found = best_of(data, count, (PLAIN,)) or found
    best = _weighed([*([found] if found is not None else []), *soft], data, count)
    return best if best is None or _tested(best, data, count) else msgspec.structs.replace(best, short=True)


def _of_few(found: Identified, data: Data, count: int | None) -> Identified:
    """What one or two frequencies are: beside what was fitted to them, one common factor that leaves as little.

    Not where the exact beam, or a model of known size, is they without anything that was fitted, nor a factor that
    explains nothing.
    """
    plain = found if _credible(found) else best_of(data, count, (PLAIN,)) or found
    if _unfitted(plain, data, count):
        return plain
    members = tuple(one for one in data.family if count is not None or not one.sized)
    scaled = best_of(msgspec.structs.replace(data, family=members), count, (SCALED,))
    explaining = [scaled] if scaled is not None and scaled.best.residual <= CREDIBLE else []
    both = [msgspec.structs.replace(one, short=True) for one in (plain, *explaining)]
    best, *others = sorted(both, key=lambda one: one.best.residual)
    rivals = [one for one in others if likelier(best.best, one.best, len(one.best.pairs.entries)) < SURE]
    return msgspec.structs.replace(best, rivals=tuple(rivals))


def _unfitted(found: Identified, data: Data, count: int | None) -> bool:
    """Whether the exact beam has these frequencies, or to rounding a model whose size was said."""
    if _exactly(found):
        return True
    return count is not None and settled(found.best, data) and float(np.median(data.rounding)) <= _WRITTEN


def _tested(found: Identified, data: Data, count: int | None) -> bool:
    """Whether two entries at least are left to bear out what was fitted, or what was not explains the list as well."""
    sized = count is None and found.best.candidate.sized
    fitted = sized + (found.reading.factor is None or found.best.clamp is not None)
    if len(found.best.pairs.entries) - fitted >= 2 or (sized and _exactly(found)):
        return True
    return _sharply(found, data)


def _exactly(found: Identified) -> bool:
    """Whether the exact beam, in which no size is fitted, has these frequencies about as well."""
    return any(not one.candidate.sized and one.residual <= TOLERANCE for one in (found.best, *found.alike))


def _fills(gapped: Identified, data: Data) -> bool:
    """Whether a list is explained by gaps, and has entries enough beside those that gaps may fit, or digits."""
    pairs = gapped.best.pairs
    enough = len(pairs.entries) - pairs.skips(len(data.listed)) >= FEWEST
    return gapped.explained and (enough or _sharply(gapped, data))


def _sharply(found: Identified, data: Data) -> bool:
    """Whether a list of so many digits is fitted to its rounding."""
    return settled(found.best, data) and float(np.median(data.rounding)) <= _SHARP


def _plainly(found: Identified, data: Data, count: int | None) -> bool:
    """Whether the list as it stands is a candidate's, to rounding, and not by the choice of a size."""
    known = count is not None or float(np.median(data.rounding)) < _SHARP
    return found.reading == PLAIN and found.best.residual <= FLOOR and known


def _credible(found: Identified) -> bool:
    """Whether what a list is said to suffer from is borne out: what is left is small, and smaller than a factor."""
    if found.reading == PLAIN or found.explained:
        return True
    if found.best.residual > CREDIBLE:
        return False
    return found.reading.factor is not None or _by_factor(found.best)


def _by_factor(best: Fit) -> bool:
    """Whether one factor on all frequencies leaves little of what it changes, a wrong unit apart."""
    change = abs(log(beyond_unit(best.factor)[0]))
    return change >= _SMALL_FACTOR and best.residual <= _SHARE * change


def _weighed(causes: list[Identified], data: Data, count: int | None) -> Identified | None:
    """The likeliest, and beside it those that leave about as much."""
    if not causes:
        return None
    best, *others = sorted(causes, key=lambda one: one.best.score)
    rounding = max(FLOOR, float(np.median(data.rounding)))
    rivals = tuple(one for one in others if _as_good(best, one, rounding, count))
    return msgspec.structs.replace(best, rivals=rivals)


def _as_good(best: Identified, other: Identified, rounding: float, count: int | None) -> bool:
    """Whether another cause leaves about as much as the likeliest, with no more that was fitted.

    A chain whose size was looked for has one fitted number, as the exact beam on a clamp that gives.
    """
    sized = count is None and best.best.candidate.sized
    fit = other.best
    if other.reading.cost > best.reading.cost:
        unsized = [one for one in (other.best, *other.alike) if not one.candidate.sized]
        if not (sized and unsized):
            return False
        fit = unsized[0]
    return likelier(best.best, fit, len(fit.pairs.entries), rounding) < SURE
