"""Which entry of a list is which mode: pairs, and those that order alone makes, with modes missing or too many."""

from math import inf

import msgspec
import numpy as np

from verify.models.arrays import Array, Indices

BAND = 4
"""By how many places pairs may be shifted."""
_SKIP = 0.03
"""What leaving a mode out costs while modes are paired, in log frequency."""


class Pairs(msgspec.Struct, frozen=True, eq=False, kw_only=True):
    """Which entry of a list is which mode."""

    entries: Indices
    """(k,), from 0."""
    modes: Indices
    """(k,), from 0."""

    def skips(self, n: int) -> int:
        """How many modes are missing, and how many of n entries are none."""
        return int(self.modes.max()) + 1 - len(self.modes) + n - len(self.entries) if len(self.modes) else n


def in_order_of(n: int) -> Pairs:
    """Each entry the mode of its own place."""
    return Pairs(entries=np.arange(n), modes=np.arange(n))


def aligned_pairs(logs: Array, known: Array) -> Pairs:
    """The pairs, in order on both sides, of least sum of differences, each mode or entry left out costing `_SKIP`."""
    n, m = len(logs), len(known)
    costs = np.full((n + 1, m + 1), inf)
    came = np.zeros((n + 1, m + 1), dtype=int)
    costs[0, : min(BAND, m) + 1] = _SKIP * np.arange(min(BAND, m) + 1)
    came[0, 1:] = 1
    apart = abs(logs[:, None] - known[None, :])
    for i in range(1, n + 1):
        for j in range(max(i - BAND, 0), min(i + BAND, m) + 1):
            extra = costs[i - 1, j] + _SKIP
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
