"""The size at which a candidate fits a list best: downhill, or by what a few sizes say of the others."""

from collections.abc import Callable, Sequence
from itertools import pairwise
from math import ceil, inf
from typing import TYPE_CHECKING, TypeAlias

import numpy as np

from verify.models.arrays import Array

if TYPE_CHECKING:
    from verify.identify.fitting import Fit

COUNTS = (2, 400)
"""Sizes that are tried where nobody says the size."""
_GRID = 1.5
"""Ratio of neighbouring sizes in a first look."""
_CLOSE = 1.06
"""The same in a closer one."""
_NEAR, _NEARLY = 12, 0.12
"""How far around the best size, and relative, others are tried where errors go up and down with the size."""
_POWERS = (1, 2, 3, 4)
"""Of 1/N, by which errors go with the size."""
_FIRST, _AT_ONCE, _ROUNDS = 16, 10, 6
"""Sizes from which on powers of 1/N describe errors; sizes that are tried before they are asked again; how often."""

Tried: TypeAlias = "Callable[[int | None], Fit | None]"
Known: TypeAlias = "dict[int, Fit | None]"


def best_size(tried: Tried, more: Sequence[int] = ()) -> "Fit | None":
    """The fit at the best of all sizes: a look at some, then downhill from where those around point.

    `more` sizes are looked at beside.
    """
    known: Known = {}
    for size in _grid(_GRID):
        known[size] = tried(size)
        if _rising([one.score for one in known.values() if one is not None]):
            break
    known |= {size: tried(size) for size in more}
    sizes = sorted(known)
    at = min(range(len(sizes)), key=lambda i: _score(tried, known, sizes[i]))
    if _score(tried, known, sizes[at]) == inf:
        return None
    pointed = _pointed_to([known[n] for n in sizes[max(at - 1, 0) : at + 2]])
    here = min({sizes[at], pointed}, key=lambda n: _score(tried, known, n))
    return known[downhill(tried, known, here, lambda size: 1)]


def closest(
    tried: Tried, places: Sequence[float], more: Sequence[int], settled: "Callable[[Fit], bool]"
) -> "Fit | None":
    """The fit at the best of all sizes where errors go up and down with the size.

    `places`, of the length, are where something stands that is felt by where it falls within a part: errors are powers
    of 1/N times a polynomial of that (`_likeliest`). Without any, sizes are tried around the best that is known.
    """
    known: Known = {size: tried(size) for size in {*_grid(_GRID), *more}}
    if places:
        known |= {size: tried(size) for size in _grid(_CLOSE) if size not in known}
        for _ in range(_ROUNDS):
            if any(one is not None and settled(one) for one in known.values()):
                break
            for size in _likeliest(known, places)[:_AT_ONCE]:
                known[size] = tried(size)
    here = min(sorted(known), key=lambda n: _score(tried, known, n))
    best = known[here]
    if best is None or settled(best):
        return best
    return known[downhill(tried, known, here, lambda size: max(_NEAR, ceil(_NEARLY * size)))]


def _score(tried: Tried, known: Known, size: int) -> float:
    if size not in known:
        known[size] = tried(size) if COUNTS[0] <= size <= COUNTS[1] else None
    one = known[size]
    return inf if one is None else one.score


def downhill(tried: Tried, known: Known, here: int, near: Callable[[int], int]) -> int:
    """The best size of those as near to it as `near` says, from `here` on: the nearest first, and anew at a better."""
    seen: set[int] = set()
    while unseen := [n for n in range(here - near(here), here + near(here) + 1) if n not in seen]:
        there = min(unseen, key=lambda n: abs(n - here))
        seen.add(there)
        if _score(tried, known, there) < _score(tried, known, here):
            here = there
    return here


def _likeliest(known: Known, places: Sequence[float]) -> list[int]:
    """Sizes that were not tried, the likeliest first: by what the differences of the others go with."""
    fits = {size: one for size, one in known.items() if one is not None and size >= _FIRST}
    most = max((len(one.differences) for one in fits.values()), default=0)
    fits = {size: one for size, one in fits.items() if len(one.differences) == most}
    others = [size for size in range(_FIRST, COUNTS[1] + 1) if size not in known]
    if not fits:
        return others
    sizes = np.array(list(fits))
    weights = sizes[:, None] ** 2.0  # what is left out goes with a high power of 1/N
    given = np.array([np.log1p(one.differences) for one in fits.values()])
    found = np.linalg.lstsq(weights * _columns(sizes, places), weights * given, rcond=None)[0]
    off = np.sqrt(np.mean((_columns(np.array(others), places) @ found) ** 2, axis=1))
    return [others[i] for i in np.argsort(off, kind="stable")]


def _columns(sizes: Array, places: Sequence[float]) -> Array:
    """What differences at sizes (n,) go with, (n, columns): one, powers of 1/N, and each times s and s^2.

    s is the part of a link that lies before a place.
    """
    parts = [np.ones(len(sizes))]
    for place in places:
        s = (place * sizes) % 1.0
        parts += [s, s**2]
    return np.stack([np.ones(len(sizes)), *(part / sizes**power for power in _POWERS for part in parts)], axis=1)


def _rising(scores: list[float]) -> bool:
    """Whether the best size lies behind: the last three scores go up from the least."""
    return len(scores) > 3 and scores[-4] == min(scores) and scores[-4] < scores[-3] < scores[-2] <= scores[-1]


def _pointed_to(around: "list[Fit | None]") -> int:
    """The size at which differences that go straight with 1/N^p between neighbours would be least."""
    fits = [one for one in around if one is not None and one.count is not None]
    best = min(fits, key=lambda one: one.score)
    assert best.count is not None
    size, least = float(best.count), inf
    for one, other in pairwise(fits):
        if one.count is None or other.count is None or len(one.differences) != len(other.differences):
            continue
        step = other.differences - one.differences
        part = float(-(step @ one.differences) / max(float(step @ step), 1e-300))
        left = float(np.sum((one.differences + part * step) ** 2))
        if 0.0 <= part <= 1.0 and left < least:
            squares = one.count**-2.0 + part * (other.count**-2.0 - one.count**-2.0)
            size, least = squares**-0.5, left
    return round(size)


def _grid(ratio: float) -> list[int]:
    sizes, size = [], COUNTS[0]
    while size < COUNTS[1]:
        sizes.append(size)
        size = max(size + 1, round(ratio * size))
    return [*sizes, COUNTS[1]]
