"""Where the lowest eigenvalues of many small pencils lie, by counts and determinants alone: no vectors, nothing dense.

Two counts tell about where modes lie, over the fourth root, and how much closer the higher ones do; there a grid is
laid that is a few times as dense as they are. Between two counts that differ by one the determinant, but for how it
grows, is a sine, alike on both sides of zero; a polynomial through fourteen points of the grid has its zeros, also two
between two points. Where a polynomial through fewer says otherwise, what is found is a point of one more.
Where there are not as many zeros as are counted, modes are followed by false position as mended by Anderson and Bjoerck
(BIT 13 (1973), p. 253), and where they lie close together by halves. What is found is a shift to start from, and no
more: who takes it judges what comes of it.
"""

from typing import Any, TypeVar

import msgspec
import numpy as np
from msgspec.structs import replace

from verify.models.arrays import Array, BoolArray, Indices
from verify.models.band_stack import Pencils, tally

_PHASE = 1.9
"""Of a mode, in sums of (M_ii / K_ii)^(1/4): 1.8 of a uniform chain, 2.0 of elements."""
_BEYOND = 2.0
"""Modes beyond the last that the grid goes: bodies and steps take them up or down."""
_BENT = 3.0
"""Of how much closer modes lie the higher they are, at most."""
_FAR = 0.8
"""Of the modes: with fewer below where they were thought to end, they are sought twice as far."""
_GRID = 2.5
"""Points for each eigenvalue."""
_WIDENED = 3
"""Times that a grid is laid anew where it ends before the last mode."""
_NODES = 14
"""Points of the grid about a mode, as many below as above where there are."""
_MIRRORED = _NODES // 2 - 1
"""Points on the other side of zero, where the determinant is what it is on this."""
_ROUND = 3.0
"""Points from zero within which a determinant has not begun to grow as it does beyond."""
_MIDDLE = 0.5 * (_NODES - 1)
"""Of the points, from the first."""
_PARTS = 128
"""Of the step of the grid: where modes between two points are told apart."""
_DOUBT = 5e-5
"""Of the distance to the next mode: what may be off by more is looked at."""
_NEWTON = 3
_ROUNDS = 14
"""Of false position and halving at most."""
_NEAR = 0.02
"""Of the distance to the next mode: what has moved less in a round is off by about the square of that."""
_ENDLESS = 300.0
"""Logarithm of a number that is as good as endless."""
AnyArray = TypeVar("AnyArray", Array, Indices)


class _Scale(msgspec.Struct, frozen=True, eq=False):
    """Places of which about `_GRID` lie between two modes, all (n_beams,)."""

    ends: Array
    """The fourth root of an eigenvalue."""
    places: Array
    """Its place."""
    bent: Array
    """How much closer modes lie the higher they are: the fourth root goes like u / (1 + bent u^2)^(1/2)."""

    def values(self, at: Array, which: Any = slice(None)) -> Array:
        """Eigenvalues at places (..., n_beams), or of some beams."""
        part, bent = at / self.places[which], self.bent[which]
        return np.asarray((self.ends[which] * part) ** 4 * ((1.0 + bent) / (1.0 + bent * part**2)) ** 2)

    def straight(self, at: Array, modes: Array, which: Indices) -> "_Scale":
        """That of some beams laid anew, not bent, by how many modes lie below places (n_beams,)."""
        ends, places, bent = self.ends.copy(), self.places.copy(), self.bent.copy()
        ends[which], places[which], bent[which] = self.values(at)[which] ** 0.25, _GRID * modes[which], 0.0
        return _Scale(ends, places, bent)


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
    def held(self) -> Indices:
        """How many are in it."""
        return np.asarray(self.below_high - self.below_low)

    @property
    def alone(self) -> BoolArray:
        """Whether one is."""
        return np.asarray(self.held == 1, dtype=bool)

    def of(self, mode: Indices, beam: Indices) -> "_Brackets":
        """Those of some modes."""
        return _Brackets(*(getattr(self, name)[mode, beam] for name in self.__struct_fields__))

    def become(self, mode: Indices, beam: Indices, others: "_Brackets") -> None:
        """Put others in place of some."""
        for name in self.__struct_fields__:
            getattr(self, name)[mode, beam] = getattr(others, name)


class _Curve(msgspec.Struct, frozen=True, eq=False):
    """What polynomials through `_NODES` points about each bracket say, (m, n_beams) all."""

    zero: Array
    """Its place, or the middle of the bracket."""
    told: BoolArray
    """Whether it has the zeros that the counts say."""
    middle: Array
    """The place in the middle of the points."""
    slope: Array
    """At the zero."""
    doubt: Array
    """How far the zero of a polynomial without the outermost two points lies from it."""


class _Measured(msgspec.Struct, frozen=True, eq=False):
    """Counts of elastic modes, and logs of determinants without rigid motions and without their growth."""

    pencils: Pencils
    rigid_modes: int
    scale: _Scale
    growth: Array
    """Of each of `_growing`, (3, n_beams)."""

    def at(self, places: Array, which: Any = slice(None)) -> tuple[Indices, Array]:
        """Both at places (..., n_beams), or of some beams."""
        values = self.scale.values(places, which)
        some = self.pencils if isinstance(which, slice) else self.pencils.of_beams(which)
        below, logs = tally(some, np.atleast_2d(values))
        logs = logs.reshape(places.shape) - self.rigid_modes * np.log(values)
        return below.reshape(places.shape) - self.rigid_modes, self.grown_less(logs, places, which)

    def grown_less(self, logs: Array, places: Array, which: Any = slice(None)) -> Array:
        """Logs at places without the growth there."""
        none, once, twice = self.growth[:, which]
        _, far, square = _growing(places)
        return np.asarray(logs - (none + once * far + twice * square))


def _growing(places: Array) -> tuple[float, Array, Array]:
    """What the log of a determinant grows like, on both sides of zero alike."""
    square = places**2
    return 1.0, np.sqrt(square + _ROUND**2), square


def isolated(pencils: Pencils, rigid_modes: int, n_modes: int) -> Array:
    """About where the lowest elastic eigenvalues of K v = lambda M v are, (n_modes, n_beams); not a number if lost."""
    measured, places, below, logs = _gridded(pencils, rigid_modes, n_modes)
    brackets, curve = _on_grid(places, below, logs, n_modes)
    found = _followed(measured, brackets, curve, *_bettered(measured, brackets, curve))
    return np.asarray(np.where(brackets.below_high >= brackets.modes, measured.scale.values(found), np.nan))


def _gridded(pencils: Pencils, rigid_modes: int, n_modes: int) -> tuple[_Measured, Array, Indices, Array]:
    """(what is measured, places, counts and logs of a grid from the mirrored points on, (g, n_beams) all)."""
    n_beams = pencils.mass.shape[2]
    plain = _Measured(pencils, rigid_modes, _scale(pencils, rigid_modes, n_modes), np.zeros((3, n_beams)))
    places = np.arange(0.5, _GRID * (n_modes + _BEYOND))[:, None] + np.zeros(n_beams)
    plain, below, logs = _reaching(plain, places, n_modes)
    growing = np.stack(np.broadcast_arrays(*_growing(places[:, 0])), axis=1)
    growth = np.linalg.pinv(growing) @ np.where(np.isfinite(logs), logs, 0.0)
    measured = _Measured(pencils, rigid_modes, plain.scale, np.asarray(growth, dtype=float))
    mirrored = slice(_MIRRORED - 1, None, -1)
    places, logs = np.concatenate([-places[mirrored], places]), np.concatenate([logs[mirrored], logs])
    return measured, places, np.concatenate([below[mirrored], below]), measured.grown_less(logs, places)


def _reaching(plain: _Measured, places: Array, n_modes: int) -> tuple[_Measured, Indices, Array]:
    """(what is measured, counts, logs) at places (g, n_beams), on a wider scale where they end before the last mode."""
    below, logs = plain.at(places)
    for _ in range(_WIDENED):
        short = np.flatnonzero(below[-1] < n_modes)
        if not len(short):
            break
        plain = replace(plain, scale=plain.scale.straight(places[-1], np.maximum(below[-1], 0) + 0.5, short))
        below[:, short], logs[:, short] = plain.at(places[:, short], short)
    return plain, below, logs


def _followed(measured: _Measured, brackets: _Brackets, curve: _Curve, found: Array, values: Array) -> Array:
    """Places (m, n_beams) where modes are that moved from a curve's zero to `found`, all of them in their place.

    `values` are determinants at the zero, not a number where nobody has looked.
    """
    apart, last = curve.told.copy(), curve.zero
    for _ in range(_ROUNDS):
        mode, beam = np.nonzero(~apart | (abs(found - last) > _NEAR * between(found)))
        if not len(mode):
            break
        at, before, last = found[mode, beam], last[mode, beam], found.copy()
        own = brackets.of(mode, beam)
        apart[mode, beam] = own.alone
        below, logs = measured.at(at, beam)
        own, value = _narrowed(own, at, below, logs), _signed(below, logs)
        brackets.become(mode, beam, own)
        secant = at - value * (at - before) / (value - values[mode, beam])
        inside = own.alone & (secant > own.low) & (secant < own.high)
        found[mode, beam], values[mode, beam] = np.where(inside, secant, _between(own)), value
    return found


def between(places: Array) -> Array:
    """How far each lies from the next one, below or above, the first from its like below zero, (m, n_beams)."""
    steps = np.diff(places, axis=0, prepend=-places[:1])
    return np.asarray(np.minimum(steps, np.concatenate([steps[1:], steps[-1:]])))


def _scale(pencils: Pencils, rigid_modes: int, n_modes: int) -> _Scale:
    """By the counts at about where the last of the modes lies, over the fourth root, and half way to it."""
    phase = ((pencils.mass[:, 0] / pencils.stiffness[:, 0]) ** 0.25).sum(axis=0)
    ends = _PHASE * (n_modes + 0.5) / phase
    below, _ = tally(pencils, (np.array([[0.5], [1.0], [2.0]]) * ends) ** 4)
    below = np.maximum(below - rigid_modes + 0.5, 1.0)
    far = below[1] < _FAR * n_modes
    half, whole = np.where(far, below[1:], below[:-1])
    part = (half + 0.5) / whole
    bent = np.clip((0.25 - part**2) / (0.75 * part**2), 0.0, _BENT)
    return _Scale(np.where(far, 2.0 * ends, ends), _GRID * whole, bent)


def _on_grid(points: Array, below: Indices, logs: Array, n_modes: int) -> tuple[_Brackets, _Curve]:
    """The brackets of modes and the curve in each, of points, counts and logs (g, n_beams)."""
    modes, last = np.arange(1, n_modes + 1)[:, None], len(points) - 1
    counts = np.clip(below[_MIRRORED:], 0, n_modes).astype(np.uint16)  # four times as fast as whole numbers
    less = np.add.reduce(counts[:, None] < modes.astype(np.uint16), axis=0, dtype=np.uint16)
    after = less.astype(np.intp) + _MIRRORED
    inside = after > _MIRRORED

    def at(values: AnyArray, which: Indices) -> AnyArray:
        return np.take_along_axis(values, np.clip(which, 0, last), axis=0)

    brackets = _Brackets(
        modes=modes + np.zeros_like(after),
        low=np.maximum(at(points, after - 1), 0.0),
        high=at(points, after),
        below_low=np.where(inside, at(below, after - 1), 0),
        below_high=at(below, after),
        log_low=np.where(inside, at(logs, after - 1), np.nan),
        log_high=at(logs, after),
        moved=np.zeros_like(after),
    )
    first = np.clip(after - _NODES // 2, 0, last + 1 - _NODES)
    values, at_first = _signed(below, logs), first * below.shape[1] + np.arange(below.shape[1])
    nodes = np.array([values.ravel().take(at_first + node * below.shape[1]) for node in range(_NODES)])
    curve = _curve(nodes, at(points, after - 1), at(points, first) + _MIDDLE, brackets)
    told = curve.told & inside & (brackets.below_high >= modes)
    zero = np.where(told, curve.zero, 0.5 * (brackets.low + brackets.high))
    return brackets, replace(curve, zero=zero, told=told)


def _signed(below: Indices, logs: Array) -> Array:
    """Determinants by the modes below and their logs."""
    return np.asarray((1.0 - 2.0 * (below % 2)) * _exp(logs))


def _curve(values: Array, low: Array, middle: Array, brackets: _Brackets) -> _Curve:
    """The curve through `values`, (nodes, m, n_beams), about `middle`, with its zeros past the points `low`."""
    nodes, begin = np.arange(_NODES) - _MIDDLE, low - middle
    powers = np.tensordot(np.linalg.inv(np.vander(nodes, increasing=True)), values, 1)
    ends = [_polynomial(powers, begin + step) for step in (0.0, 1.0)]
    zero = _zero(powers, begin + ends[0] / (ends[0] - ends[1]))
    told = brackets.alone & (zero > begin) & (zero < begin + 1.0)
    mode, beam = np.nonzero(~told)
    some = _parted(powers[:, mode, beam], begin[mode, beam], brackets.of(mode, beam))
    zero[mode, beam], told[mode, beam] = some
    slope = _polynomial(_slopes(powers), zero)
    without = (powers[-2] + powers[-1] * zero) / slope
    for node in nodes[1:-1]:
        without *= zero - node
    return _Curve(zero=zero + middle, told=told, middle=middle, slope=slope, doubt=abs(without))


def _parted(powers: Array, begin: Array, brackets: _Brackets) -> tuple[Array, BoolArray]:
    """(where some polynomials' zeros past `begin` are, whether there are as many as are counted)."""
    parts = np.array([_polynomial(powers, begin + part) for part in np.linspace(0.0, 1.0, _PARTS + 1)])
    seen = np.cumsum(np.signbit(parts[1:]) != np.signbit(parts[:-1]), axis=0)
    order, which = brackets.modes - brackets.below_low, np.arange(len(begin))
    part = np.minimum((seen < order).sum(axis=0), _PARTS - 1)
    before, after = parts[part, which], parts[part + 1, which]
    zero = _zero(powers, begin + (part + before / (before - after)) / _PARTS)
    return zero, (seen[-1] == brackets.held) & (zero > begin) & (zero < begin + 1.0)


def _zero(powers: Array, at: Array) -> Array:
    """A polynomial's zero next to a place, by Newton's steps."""
    slopes = _slopes(powers)
    for _ in range(_NEWTON):
        at = at - _polynomial(powers, at) / _polynomial(slopes, at)
    return at


def _slopes(powers: Array) -> Array:
    """Powers of a polynomial's slope."""
    return np.asarray(powers[1:] * np.arange(1.0, len(powers)).reshape(-1, *[1] * (powers.ndim - 1)))


def _polynomial(powers: Array, at: Array) -> Array:
    """By its powers, the lowest first (Horner)."""
    value = powers[-1] * at
    for power in powers[-2:0:-1]:
        value += power
        value *= at
    return np.asarray(value + powers[0])


def _exp(logs: Array) -> Array:
    return np.asarray(np.exp(np.clip(logs, -_ENDLESS, _ENDLESS)))


def _bettered(measured: _Measured, brackets: _Brackets, curve: _Curve) -> tuple[Array, Array]:
    """(zeros of the curves, not a number), of those in doubt what is next to it and the determinant there.

    That is where the polynomial through the curve's points and its zero is zero; brackets are narrowed in their place.
    """
    found, values = curve.zero.copy(), np.full_like(curve.zero, np.nan)
    mode, beam = np.nonzero(curve.told & ~(curve.doubt < _DOUBT * between(found)))
    if not len(mode):
        return found, values
    at = found[mode, beam]
    below, logs = measured.at(at, beam)
    narrowed = _narrowed(brackets.of(mode, beam), at, below, logs)
    brackets.become(mode, beam, narrowed)
    value, away = _signed(below, logs), at - curve.middle[mode, beam]
    # of the product of all distances to the points, which is zero there, the slope over itself
    rise = np.asarray(sum(1.0 / (away + _MIDDLE - node) for node in range(_NODES)))
    better = at - value / (curve.slope[mode, beam] + value * rise)
    told = (better > narrowed.low) & (better < narrowed.high)
    found[mode, beam], values[mode, beam] = np.where(told, better, _between(narrowed)), value
    return found, values


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
