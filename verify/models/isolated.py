"""Where the lowest eigenvalues of many small pencils lie, by counts and determinants alone: no vectors, nothing dense.

Eigenvalues are counted below the points of a grid that is about twice as dense as they are, over the fourth root, on
which those of a beam lie evenly. Between two counts that differ by one the determinant is a sine but for how it grows:
it is zero first about where a cubic through four points of the grid is, then by false position as mended by Anderson
and Bjoerck (BIT 13 (1973), p. 253), step by step in those alone that still move. What is found is a shift to start
from, and no more: who takes it judges what comes of it.
"""

from functools import partial
from typing import Any, TypeVar

import msgspec
import numpy as np

from verify.models.arrays import Array, BoolArray, Indices
from verify.models.band_stack import tally

_PHASE = 1.9
"""Of a mode, in sums of (M_ii / K_ii)^(1/4): 1.8 of a uniform chain, 2.0 of elements."""
_BEYOND = 1.1
"""How much farther the grid goes than one count says: modes of thick beams lie closer the higher they are."""
_GRID = 2
"""Points for each eigenvalue."""
_NEWTON = 4
_ROUNDS = 8
"""Of false position at most: 0.01 of a distance after the cubic, 1e-4 after one, 1e-7 after two."""
_NEAR = 3e-5
"""Of a distance: what has moved less in a round is as near as a shift has to be."""
_ENDLESS = 300.0
"""Logarithm of a number that is as good as endless."""
AnyArray = TypeVar("AnyArray", Array, Indices)


class _Brackets(msgspec.Struct, frozen=True, eq=False):
    """Between which places each mode of each beam lies, (m, n_beams) all."""

    modes: Indices
    """From 1."""
    low: Array
    high: Array
    below_low: Indices
    """How many lie below `low`."""
    below_high: Indices
    log_low: Array
    """Log of the determinant without its growth, less the more often the other end alone has moved."""
    log_high: Array
    moved: Indices
    """-1 where `low` moved last, 1 where `high` did, 0 at first."""

    @property
    def alone(self) -> BoolArray:
        """Whether one is in it."""
        return np.asarray(self.below_high - self.below_low == 1, dtype=bool)


def isolated(stiffness: Array, mass: Array, rigid_modes: int, n_modes: int) -> Array:
    """About where the lowest elastic eigenvalues of K v = lambda M v are, (n_modes, n_beams); not a number if lost."""
    ends = _ends(stiffness, mass, rigid_modes, n_modes)
    points = np.linspace(0.0, 1.0, _GRID * (n_modes + 1) + 1)[1:, None] * ends
    below, logs = tally(stiffness, mass, points**4)
    spacing = ends / np.maximum(below[-1] - rigid_modes, 1)
    told = partial(_without, rigid_modes)
    brackets, last = _on_grid(points, *told(below, logs, points / spacing), n_modes)
    brackets = _narrowed(brackets, last, *told(*tally(stiffness, mass, last**4), last / spacing))
    found = _between(brackets)
    for _ in range(_ROUNDS - 1):
        mode, beam = np.nonzero(abs(found - last) > _NEAR * spacing)
        if not len(mode):
            break
        at, last = found[mode, beam], found.copy()
        below, logs = tally(np.take(stiffness, beam, axis=2), np.take(mass, beam, axis=2), at[None] ** 4)
        own = _Brackets(*(each[mode, beam] for each in _all_of(brackets)))
        own = _narrowed(own, at, *told(below[0], logs[0], at / spacing[beam]))
        for each, one in zip(_all_of(brackets), _all_of(own), strict=True):
            each[mode, beam] = one
        found[mode, beam] = _between(own)
    return np.asarray(np.where(brackets.below_high >= brackets.modes, found, np.nan) ** 4)


def _ends(stiffness: Array, mass: Array, rigid_modes: int, n_modes: int) -> Array:
    """About where the last of the modes lies, over the fourth root, (n_beams,)."""
    phase = ((mass[:, 0] / stiffness[:, 0]) ** 0.25).sum(axis=0)
    found = _PHASE * (n_modes + 0.5) / phase
    below, _ = tally(stiffness, mass, found[None] ** 4)
    return np.asarray(_BEYOND * found * (n_modes + 0.5) / np.maximum(below[0] - rigid_modes, 1))


def _without(rigid_modes: int, below: Indices, logs: Array, distances: Array) -> tuple[Indices, Array]:
    """(counts of elastic modes, logs without what cosh gives a beam's determinant at so many distances from zero)."""
    return below - rigid_modes, logs - np.pi * distances


def _all_of(brackets: _Brackets) -> list[Any]:
    return [getattr(brackets, name) for name in _Brackets.__struct_fields__]


def _on_grid(points: Array, below: Indices, logs: Array, n_modes: int) -> tuple[_Brackets, Array]:
    """The brackets of modes and where in each its mode lies, by a cubic, of points, counts and logs (g, n_beams)."""
    modes = np.arange(1, n_modes + 1)
    after = np.array([(below < mode).sum(axis=0) for mode in modes])
    last, first = len(points) - 1, after == 0

    def at(values: AnyArray, which: Indices) -> AnyArray:
        return np.take_along_axis(values, np.clip(which, 0, last), axis=0)

    brackets = _Brackets(
        modes=modes[:, None] + np.zeros_like(after),
        low=np.where(first, 0.0, at(points, after - 1)),
        high=at(points, after),
        below_low=np.where(first, 0, at(below, after - 1)),
        below_high=at(below, after),
        log_low=np.where(first, np.nan, at(logs, after - 1)),
        log_high=at(logs, after),
        moved=np.zeros_like(after),
    )
    around = [after + shift for shift in (-2, -1, 0, 1)]
    signs = [1.0 - 2.0 * ((at(below, i) - brackets.below_low) % 2) for i in around]
    values = [sign * _exp(at(logs, i) - brackets.log_low) for sign, i in zip(signs, around, strict=True)]
    share = _root_of_cubic(*values)
    told = brackets.alone & (after >= 2) & (after < last) & (share > 0.0) & (share < 1.0)
    return brackets, np.where(told, brackets.low + share * (brackets.high - brackets.low), _between(brackets))


def _root_of_cubic(before: Array, low: Array, high: Array, after: Array) -> Array:
    """Where the cubic through values at -1, 0, 1 and 2 is zero between 0 and 1, by Newton's steps."""
    cubed, squared = (after - before) / 6.0 - 0.5 * (high - low), 0.5 * (before + high) - low
    once, share = high - low - squared - cubed, low / (low - high)
    for _ in range(_NEWTON):
        slope = (3.0 * cubed * share + 2.0 * squared) * share + once
        share = share - (((cubed * share + squared) * share + once) * share + low) / slope
    return np.asarray(share)


def _exp(logs: Array) -> Array:
    return np.asarray(np.exp(np.clip(logs, -_ENDLESS, _ENDLESS)))


def _between(brackets: _Brackets) -> Array:
    """Where the determinant's chord is zero; in the middle where a bracket holds several modes."""
    share = 1.0 / (1.0 + _exp(brackets.log_high - brackets.log_low))
    share = np.where(brackets.alone & np.isfinite(share), share, 0.5)
    return np.asarray(brackets.low + share * (brackets.high - brackets.low))


def _narrowed(brackets: _Brackets, at: Array, below: Indices, logs: Array) -> _Brackets:
    """The brackets with what was counted at a place in each."""
    low = below < brackets.modes
    moved = np.where(low, -1, 1)
    left = 1.0 - _exp(logs - np.where(low, brackets.log_low, brackets.log_high))
    less = np.where(moved == brackets.moved, np.log(np.where(left > 0.0, left, 0.5)), 0.0)
    return _Brackets(
        modes=brackets.modes,
        low=np.where(low, at, brackets.low),
        high=np.where(low, brackets.high, at),
        below_low=np.where(low, below, brackets.below_low),
        below_high=np.where(low, brackets.below_high, below),
        log_low=np.where(low, logs, brackets.log_low + less),
        log_high=np.where(low, brackets.log_high + less, logs),
        moved=moved,
    )
