"""The law of EI that the joints of a chain follow: constant, stepped or smooth, and the joints off it."""

import itertools
from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from verify.arrays import Array
from verify.errors import InputError, shown

ALIKE = 2e-3
"""Relative difference up to which joints have the same EI."""
RUN = 3
"""Joints in a row of one EI that are a piece; fewer may be off the law."""
ROUGH = 0.04
"""Relative distance of EI at a joint from that of a cone through its neighbours up to which the law is smooth."""
MANY = 4
"""Joints that a sentence names."""


SCENE = "the beam that they mean as a scene"


class Law(NamedTuple):
    """EI without the joints off it, at the joints and of the links beyond, (N,), N m^2, and the numbers of those."""

    kind: str
    joints: Array
    links: Array
    odd: list[int]

    def faults(self, names: list[str], ratios: Array) -> list[str]:
        """The joints off the law by name, of `ratios` times its EI, as one fault or none."""
        return named(f"joint{'s' * (len(self.odd) > 1)} off a {self.kind} EI:", names, ratios, self.odd)


def named(what: str, names: list[str], ratios: Array, odd: Sequence[int]) -> list[str]:
    """One fault, `what` of the joints `odd` by their names with ratios, or none."""
    each = [f"{names[j] or 'the wall'} ({ratios[j]:.3g} times)" for j in odd]
    return [f"{what} {first(each)}"] if each else []


def first(texts: list[str]) -> str:
    """The first MANY, and how many there are more."""
    return ", ".join(texts[:MANY]) + f" and {len(texts) - MANY} more" * (len(texts) > MANY)


def fitted_law(values: Array, places: Array, names: list[str], meant: float | None = None) -> Law:
    """The law of EI at the joints, `values`, (N,), at `places`. Those next to the wall, which have factors, follow.

    `meant`: constant EI that a scene has, N m^2, for values that have none. Raises InputError for values of no law.
    """
    n, first = len(values), min(3, len(values) // 3)
    few, steps = max(1, n // 5), abs(values[first + 1 :] / values[first:-1] - 1.0) > ALIKE
    starts = [first, *(first + 1 + np.flatnonzero(steps)).tolist(), n]
    runs = [(a, b) for a, b in itertools.pairwise(starts) if b - a >= RUN - (a == first)]  # those at the wall are more
    levels = np.array([np.median(values[a:b]) for a, b in runs])
    lone = sorted(set(range(first, n)).difference(*(range(a, b) for a, b in runs)))
    if runs and np.ptp(levels) <= ALIKE * levels.min() and len(lone) <= few:
        level = np.full(n, float(np.median(levels)))
        return Law("constant", level, level, lone)
    level = np.full(n, float(np.median(values[first:])))
    if np.ptp(values[first:]) < ROUGH * level[0]:
        return Law("nearly constant", level, level, [])
    if meant:
        off = [j for j in range(first, n) if abs(values[j] / meant - 1.0) > ALIKE]
        return Law("constant", np.full(n, meant), np.full(n, meant), off)
    if len(runs) > 1 and len(lone) <= few + len(runs) - 1:
        done = np.searchsorted([b for _, b in runs], np.arange(n), side="right")
        before, ahead = levels[np.maximum(done - 1, 0)], levels[np.minimum(done, len(runs) - 1)]
        for (_, b), (c, _), level in zip(runs, runs[1:], levels, strict=False):  # up to the last one of the run before
            alike = [j for j in range(b, c) if abs(values[j] / level - 1.0) <= ALIKE]
            ahead[b : alike[-1] + 1 if alike else b] = level
        lone = [j for j in lone if abs(values[j] / ahead[j] - 1.0) > ALIKE]
        low, high = np.minimum(before, ahead), np.maximum(before, ahead)
        series = [j for j in lone if low[j] < values[j] < high[j]]
        joints = np.where(np.isin(range(n), series), values, ahead)
        return Law("stepped", joints, ahead, [j for j in lone if j not in series])
    return _smooth(values, places / np.ptp(places), first, few, names)


def _smooth(values: Array, places: Array, first: int, few: int, names: list[str]) -> Law:
    """The law of which each value is near that of a cone, EI^(1/4), through its neighbours but for a `few` joints."""
    law, odd, n, x = values.copy(), list[int](), len(values) - first, places[first:]
    if n <= 2 * RUN:
        text = f"the stiffness of its {len(values)} joints varies, too few to tell a law of it from a fault"
        raise InputError(f"{text}: give {2 * RUN + 4} links or more, or {SCENE}")
    before, after = np.array([1, *range(n - 2), n - 2]), np.array([2, *range(2, n), n - 3])
    share = (x - x[before]) / (x[after] - x[before])
    while law.min() > 0.0:
        size = law[first:] ** 0.25
        expected = np.maximum(size[before] + share * (size[after] - size[before]), 0.0) ** 4
        apart = abs(law[first:] - expected) / np.maximum(law[first:], expected)
        apart[-2:] *= 0.1  # without much moment
        worst = int(apart.argmax())
        if apart[worst] < ROUGH:
            near = slice(first, first + 6)  # a cubic: d^4 of a conical rod to 5e-4, a quadratic to 7e-3
            law[:first] = np.polyval(np.polyfit(places[near], law[near], 3), places[:first])
            if law.min() > 0.0:
                return Law("smooth", law, 0.5 * (law + np.append(law[1:], law[-1])), sorted(odd))
        elif len(odd) == few:
            break
        else:
            odd.append(first + worst)
            law[first + worst] = expected[worst]
    off = ", ".join(shown(names[j]) for j in sorted(odd) or range(first, len(values)))
    text = f"the stiffness of its joints follows no constant, stepped or smooth law (above all {off})"
    raise InputError(f"{text}: give {SCENE}")
