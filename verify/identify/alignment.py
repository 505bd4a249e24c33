"""Which entry of a list is which mode: pairs, and those that order alone makes, with modes missing or too many."""

from itertools import pairwise
from math import inf

import msgspec
import numpy as np

from verify.models.arrays import Array, Indices

BAND = 4
"""By how many places pairs may be shifted."""
_SKIP, _LEFT_OUT = 0.03, 0.04
"""What a mode that is missing costs while modes are paired, and an entry that is none, in log frequency."""


class Pairs(msgspec.Struct, frozen=True, eq=False, kw_only=True):
    """Which entry of a list is which mode."""

    entries: Indices
    """(k,), from 0."""
    modes: Indices
    """(k,), from 0."""

    def skips(self, n: int) -> int:
        """How many modes are missing, and how many of n entries are none."""
        return int(self.modes.max()) + 1 - len(self.modes) + n - len(self.entries) if len(self.modes) else n

    def apart(self, n: int) -> dict[int, int]:
        """The modes of those of n entries that are left out though their place is free, from 0.

        Where their neighbours leave as many modes out as entries, and behind the last pair.
        """
        ends = [(-1, -1), *zip(map(int, self.entries), map(int, self.modes), strict=True)]
        ends.append((n, ends[-1][1] + n - ends[-1][0]))
        free: dict[int, int] = {}
        for (entry, mode), (later, above) in pairwise(ends):
            if later - entry == above - mode:
                free |= {entry + i: mode + i for i in range(1, later - entry)}
        return free


def in_order_of(n: int) -> Pairs:
    """Each entry the mode of its own place."""
    return Pairs(entries=np.arange(n), modes=np.arange(n))


def aligned_pairs(logs: Array, known: Array) -> Pairs:
    """The pairs, in order on both sides, of least sum of differences and of what is left out."""
    n, m = len(logs), len(known)
    costs = np.full((n + 1, m + 1), inf)
    came = np.zeros((n + 1, m + 1), dtype=int)
    costs[0, : min(BAND, m) + 1] = _SKIP * np.arange(min(BAND, m) + 1)
    came[0, 1:] = 1
    apart = abs(logs[:, None] - known[None, :])
    for i in range(1, n + 1):
        for j in range(max(i - BAND, 0), min(i + BAND, m) + 1):
            extra = costs[i - 1, j] + _LEFT_OUT
            pair = costs[i - 1, j - 1] + apart[i - 1, j - 1] if j else inf
            missing = costs[i, j - 1] + _SKIP if j else inf
            costs[i, j] = min(pair, extra, missing)
            came[i, j] = (pair, missing, extra).index(costs[i, j])
    i, j = n, int(np.argmin(costs[n]))
    entries, modes = [], []
    while i or j:
        step = came[i, j] if i else 1
        if step == 0:
            entries.append(i - 1)
            modes.append(j - 1)
        i, j = i - (step != 1), j - (step != 2)
    return Pairs(entries=np.array(entries[::-1], dtype=np.intp), modes=np.array(modes[::-1], dtype=np.intp))
