"""The motion of any beam along its length: states of all spans at once, each span too short for anything to grow.

Deflection, turn, moment and transverse force are carried over a span by the power series of its transfer, from one end
to the other of at most one and a half wavenumbers; the states at all ends follow together from the conditions at
both ends of the beam (multiple shooting: Ascher, Mattheij and Russell, Numerical Solution of Boundary Value Problems,
1988, section 4.3). Lengths, forces and frequencies are relative, as in `lineup`.
"""

from collections.abc import Callable
from math import ceil
from typing import TypeVar

import msgspec
import numpy as np

from verify.arrays import Array, ComplexArray, Indices
from verify.errors import InputError
from verify.exact.layout import HELD, Lineup

Carried = TypeVar("Carried", Array, ComplexArray)

TURN = 1
"""Which of w, psi, M, V the turn is."""
_REACH = 1.5
"""Wavenumber times length of a span, at most."""
_TERMS = 26
"""Of the power series, to rounding."""
_MOST = 100_000
"""Spans: more take too much memory, 1 kB each."""
_SAME = 1e-12
"""Of the beam's length: places nearer than that are one."""
_BAND = 5
"""Diagonals on either side."""


class Spans(msgspec.Struct, frozen=True, eq=False, kw_only=True):
    """A beam at one frequency, divided into n spans."""

    ends: Array
    """(n + 1,), of the beam's length."""
    rates: ComplexArray
    """(stretches, 4, 4), d/dx of (w, psi, M, V) by themselves, each relative to its own size."""
    over: Array
    """(n + 1, 4, 4), from left to right of what is fixed at each end of a span."""
    sizes: Array
    """(4,), what a unit of each is: 1, k, k^2, k^3."""
    supports: tuple[str, str]
    stretch: Indices
    """(n,), to which stretch of the line each belongs."""

    def span(self, x: Array) -> Indices:
        """In which each x lies, of the beam's length; the right one of two, to rounding."""
        return np.clip(np.searchsorted(self.ends, x + _SAME, side="right") - 1, 0, len(self.stretch) - 1)

    def states(self, at_ends: ComplexArray, x: Array) -> tuple[Indices, ComplexArray]:
        """(span, states (len(x), 4, k)) at x, of the beam's length, from those right of each end, (n + 1, 4, k)."""
        span = self.span(x)
        begin: ComplexArray = at_ends[span]
        return span, carried(self.rates[self.stretch[span]], x - self.ends[span], begin)

    def within(self, fractions: Array) -> ComplexArray:
        """What carries a state to fractions of its span, (n, len(fractions), 4, 4): alike in all spans of a stretch."""
        counts = np.bincount(self.stretch)
        lengths = np.diff(self.ends[np.append(0, np.cumsum(counts))]) / counts
        distances = (lengths[:, None] * fractions).ravel()
        rates = np.repeat(self.rates, len(fractions), axis=0)
        units: ComplexArray = np.broadcast_to(np.eye(4, dtype=complex), rates.shape)
        found = carried(rates, distances, units)
        return np.asarray(found.reshape(len(counts), len(fractions), 4, 4)[self.stretch])

    def derivative(self, span: Indices, states: ComplexArray, order: int, of: int = 0) -> ComplexArray:
        """A derivative of the deflection by x / L, (len(x), k), of any order, from states of the same places.

        Likewise of another entry `of` the state: 1 is the turn.
        """
        rates = self.rates[self.stretch[span]]
        for _ in range(order):
            states = np.asarray(rates @ states)
        return np.asarray(states[:, of] * self.sizes[of] if of else states[:, 0])


def carried(rates: Carried, distances: Array, states: Carried) -> Carried:
    """e^(rate distance) state, (m, 4, k), by its power series."""
    term = total = np.broadcast_to(states, (len(rates), *states.shape[1:]))
    steps = rates * distances[:, None, None]
    for n in range(1, _TERMS):
        term = steps @ term / n
        total = total + term
    return total


def spans_of(line: Lineup, omega2: float, loss_factor: float = 0.0) -> Spans:
    """Divide a line at omega^2 over EI / (rho A L^4); the loss factor acts on EI and kappa G A alone."""
    lossy = 1.0 + 1j * loss_factor
    size = max(omega2, 1.0) ** 0.25
    sizes = size ** np.arange(4)
    scale = sizes[None, :] / sizes[:, None]
    places, rates, ends, belongs = line.places, [], [], []
    for i, stretch in enumerate(line.stretches):
        bend = 1.0 / (stretch.stiffness * lossy)
        shear = stretch.shear / lossy
        p, q = line.tension - stretch.turning * omega2, stretch.mass * omega2 - line.foundation
        squares = abs(p * bend - shear * q) + abs(q * bend * (1.0 + p * shear)) ** 0.5
        n = max(ceil(squares**0.5 * stretch.length / _REACH), 1)
        _check_spans(n)
        rate = np.zeros((4, 4), dtype=complex)
        rate[0, 1], rate[0, 3], rate[1, 2], rate[2, 1], rate[2, 3], rate[3, 0] = 1.0, -shear, bend, p, 1.0, q
        rates.append(rate * scale)
        ends.append(places[i] + stretch.length * np.arange(n) / n)
        belongs += [i] * n
    return Spans(
        ends=np.concatenate([*ends, [places[-1]]]),
        rates=np.array(rates),
        over=_over(line, omega2, np.array(belongs), scale),
        sizes=sizes,
        supports=line.supports,
        stretch=np.array(belongs),
    )


def _check_spans(n: int) -> None:
    """Raise InputError for more spans than memory takes."""
    if n > _MOST:
        raise InputError(
            f"frequency: this beam bends in so many waves that {n} spans follow them, more than {_MOST}: lower "
            "frequency_hz or mode, or what makes its waves so short (beam.tension, beam.foundation)"
        )


def _over(line: Lineup, omega2: float, belongs: Indices, scale: Array) -> Array:
    """The matrices of what is fixed, (n + 1, 4, 4)."""
    over = np.tile(np.eye(4), (len(belongs) + 1, 1, 1))
    for i, joint in enumerate(line.joints):
        at = int(np.searchsorted(belongs, i))
        over[at, 3, 0] -= (joint.stiffness - omega2 * joint.mass) * scale[3, 0]
        over[at, 2, 1] += (joint.rotational - omega2 * joint.inertia) * scale[2, 1]
    return over


def solver(spans: Spans) -> Callable[[ComplexArray], ComplexArray]:
    """Jumps of the state at the ends, (n + 1, 4, k), to states right of each end, (n + 1, 4, k).

    A banded factorisation of the end conditions and of what carries each state to the next.
    """
    from scipy.linalg import solve_banded

    n = len(spans.stretch)
    transfer = spans.within(np.ones(1))[:, 0]
    matrix = _banded(spans, transfer)

    def solve(jumps: ComplexArray) -> ComplexArray:
        right = np.zeros((4 * n + 4, jumps.shape[2]), dtype=complex)
        right[2 : 4 * n + 2] = (transfer @ jumps[:-1]).reshape(4 * n, -1)
        right[4 * n + 2 :] = -jumps[-1][list(HELD[spans.supports[1]])]
        left = solve_banded((_BAND, _BAND), matrix, right).reshape(n + 1, 4, -1)
        return np.asarray(spans.over @ left + jumps)

    return solve


def _banded(spans: Spans, transfer: ComplexArray) -> ComplexArray:
    """The matrix by its diagonals, (2 band + 1, 4 n + 4), of states left of each end."""
    n = len(transfer)
    matrix = np.zeros((2 * _BAND + 1, 4 * n + 4), dtype=complex)
    for row, held in enumerate(HELD[spans.supports[0]]):
        matrix[_BAND + row - held, held] = 1.0
    carry = -transfer @ spans.over[:-1]
    first = 4 * np.arange(n)
    for i in range(4):
        for j in range(4):
            matrix[_BAND + 2 + i - j, first + j] = carry[:, i, j]
        matrix[_BAND - 2, first + 4 + i] = 1.0
    for row, held in enumerate(HELD[spans.supports[1]]):
        for j in range(4):
            matrix[_BAND + 2 + row - j, 4 * n + j] = spans.over[-1, held, j]
    return matrix
