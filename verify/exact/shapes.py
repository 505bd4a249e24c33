"""Mode shapes of any beam at its exact frequencies, with their derivatives."""

from collections.abc import Callable, Sequence
from contextlib import suppress
from functools import lru_cache

import msgspec
import numpy as np

from verify.arrays import Array, ComplexArray
from verify.errors import InputError
from verify.exact.layout import Lineup, line_up
from verify.exact.roots import wavenumber_length
from verify.exact.transfer import Spans, carried, solver, spans_of
from verify.problem.beam import Beam

_TOGETHER = 4096
"""Modes times places that are carried at once."""
_POINTS = 12
"""Of Gauss's rule on every span."""
_PAIR = 1e-9
"""Relative: frequencies that lie closer share a plane of shapes, of which orthogonal ones are taken."""
_TRIES = 6
"""Forces, of which one is sure to be far from what does no work on the mode."""
_NUDGE = 7e-16
_NUDGES = 12
"""Relative steps off a resonance, and how many."""
_STILL = 1e-9
"""Of the largest deflection: what is less does not show where a beam first moves."""


class _Mode(msgspec.Struct, frozen=True, eq=False):
    """One mode: its spans and the states right of their ends, (n + 1, 4, 1), of modal mass 1 over rho A L."""

    spans: Spans
    states: ComplexArray


def general_shapes(beam: Beam, modes: Sequence[int], x: Array, derivative: int, theory: str) -> Array:
    """Mass-normalised shapes or derivatives of them, of any order, (modes, len(x)), SI; x in metres.

    Positive where the beam first moves off its left end. From the right where a derivative jumps.
    """
    xi = np.minimum(np.asarray(x, dtype=float) / beam.length, 1.0)
    found = np.empty((len(modes), len(xi)))
    together = max(_TOGETHER // max(len(xi), 1), 1)
    for first in range(0, len(modes), together):
        some = tuple(modes[first : first + together])
        rates, states = _carried(beam, some, xi.tobytes(), theory)
        for _ in range(derivative):
            states = np.asarray(rates @ states)
        found[first : first + together] = states[:, 0, 0].reshape(len(some), len(xi))
    return np.asarray(found * ((beam.mass_per_length * beam.length) ** -0.5 / beam.length**derivative))


@lru_cache(maxsize=16)
def _carried(beam: Beam, modes: tuple[int, ...], xi: bytes, theory: str) -> tuple[Array, Array]:
    """Rates (modes * places, 4, 4) and states (.., 4, 1) of some modes at the same places, which they are carried to.

    At once, and kept for the next derivative there: a window of a slider asks for four of hundreds of modes. Shapes
    have no loss, so that both are real.
    """
    places, rates, distances, states = np.frombuffer(xi), [], [], []
    for mode in modes:
        its = _mode(beam, mode, theory)
        span = its.spans.span(places)
        rates.append(its.spans.rates[its.spans.stretch[span]])
        distances.append(places - its.spans.ends[span])
        states.append(its.states[span])
    rate = np.ascontiguousarray(np.concatenate(rates).real)
    begin = np.ascontiguousarray(np.concatenate(states).real)
    return rate, carried(rate, np.concatenate(distances), begin)


@lru_cache(maxsize=500)
def _mode(beam: Beam, mode: int, theory: str) -> _Mode:
    """One mode; of a pair of one frequency the second is orthogonal to the first."""
    line, beta = line_up(beam, theory), wavenumber_length(beam, mode, theory)
    paired = mode > 1 and beta - wavenumber_length(beam, mode - 1, theory) < _PAIR * beta
    spans, found = _beside(line, beta**4, (mode, mode - 1) if paired else (mode,))
    states = found[0]
    if paired:
        states = states - found[1] * (_inner(line, spans, *found) / _inner(line, spans, found[1], found[1]))
    states = states / np.sqrt(_inner(line, spans, states, states))
    return _Mode(spans, states * _sign(spans, states, mode))


def _beside(line: Lineup, omega2: float, modes: tuple[int, ...]) -> tuple[Spans, list[ComplexArray]]:
    """Spans at a resonance and motions that need no force there; a rounding beside it where equations are singular."""
    for step in range(_NUDGES):
        with suppress(np.linalg.LinAlgError):
            spans = spans_of(line, omega2 * (1.0 + step * _NUDGE))
            solve = solver(spans)
            return spans, [_free(solve, spans, mode) for mode in modes]
    raise InputError("mode: no shape is found at this frequency, which rounding does not tell from a neighbour's")


def _free(solve: Callable[[ComplexArray], ComplexArray], spans: Spans, mode: int) -> ComplexArray:
    """The motion that needs no force: of the answers to a few, at resonance, the largest (inverse iteration)."""
    phases = np.arange(4.0 * len(spans.ends))[:, None] * (1.0 + 0.37 * mode + 0.11 * np.arange(_TRIES))
    answers = solve(np.cos(phases).reshape(-1, 4, _TRIES).astype(complex))
    sizes = abs(answers).max(axis=(0, 1))
    best = int(sizes.argmax())
    return np.asarray(answers[:, :, best : best + 1] / sizes[best])


def _inner(line: Lineup, spans: Spans, one: ComplexArray, other: ComplexArray) -> float:
    """The modal mass that two motions share, over rho A L: deflection and turning, of the beam and what is on it."""
    points, weights = np.polynomial.legendre.leggauss(_POINTS)
    lengths = np.diff(spans.ends)
    within = spans.within(0.5 * (points + 1.0))
    values = [np.real(within @ states[:-1, None])[..., 0] for states in (one, other)]
    w, turn = (values[0][:, :, k] * values[1][:, :, k] @ weights * 0.5 * lengths for k in (0, 1))
    mass, turning = (
        np.array([getattr(s, name) for s in line.stretches])[spans.stretch] for name in ("mass", "turning")
    )
    total = float(w @ mass + turn @ turning * spans.sizes[1] ** 2)
    for i, joint in enumerate(line.joints):
        at = int(np.searchsorted(spans.stretch, i))
        total += joint.mass * float(np.real(one[at, 0, 0] * other[at, 0, 0]))
        total += joint.inertia * float(np.real(one[at, 1, 0] * other[at, 1, 0])) * spans.sizes[1] ** 2
    return total


def _sign(spans: Spans, states: ComplexArray, mode: int) -> float:
    """+1 or -1, so that the shape is positive where it first moves off the left end."""
    near = np.array([1e-3 / mode])
    first = spans.states(states, near)[1][:, 0, 0]
    deflections = np.real(np.concatenate([first, states[:, 0, 0]]))
    moved = deflections[abs(deflections) > _STILL * abs(deflections).max()]
    return float(np.sign(moved[0])) if len(moved) else 1.0
