"""Books of driven beams whose modes hardly turn or hardly die away, by exponentials of matrices."""

from math import ceil, log2, pi
from typing import Any

import numpy as np

from verify.models.arrays import Array
from verify.models.fields import phasor
from verify.motion.result import Ledger
from verify.stress.kind import Floor, Row
from verify.stress.largest import largest
from verify.stress.motion.sliders import BAR, FORCES, HERTZ

GROWN: tuple[tuple[float, tuple[float, ...]], ...] = ((1.1e-3, (0.0, 0.7, 0.5)), (0.6e-3, (1.2, -0.2)))
"""Seconds, and powers of the part of them: how the forces grow before they are as they are."""
DRIVES: tuple[tuple[float, float, tuple[tuple[float, tuple[float, ...]], ...]], ...] = (
    (HERTZ, 2.9e-3, ()),
    (HERTZ, 2.9e-3, GROWN),
    (31.0, 2.3e-3, GROWN),
    (977.0, 0.9e-4, ()),
)
"""Hertz, seconds, growth: over several turns, over less than one, and as short as every mode is slow."""


TERMS, POINTS = 14, 6
"""Of an exponential over a step in which nothing turns by more than half a radian; of Gauss's rule over it."""


def _after(rates: Array, seconds: float) -> Array:
    """e^{A t} of matrices A (n, m, m), for a short time."""
    term = found = np.broadcast_to(np.eye(rates.shape[1]), rates.shape)
    for k in range(1, TERMS):
        term = term @ rates * (seconds / k)
        found = found + term
    return np.asarray(found)


def _over(rates: Array, squares: Array, seconds: float) -> tuple[Array, Array]:
    """(e^{A t} (n, m, m), integrals of e^{A' s} Q e^{A s} from 0 to t, (k, n, m, m)), by doubling a short time."""
    halves = max(ceil(log2(2.0 * seconds * abs(rates).sum(axis=2).max())), 0)
    step = seconds / 2**halves
    points, weights = np.polynomial.legendre.leggauss(POINTS)
    ends = [_after(rates, 0.5 * step * (1.0 + point)) for point in points]
    summed = sum(0.5 * step * w * end.swapaxes(1, 2) @ squares @ end for w, end in zip(weights, ends, strict=True))
    whole = _after(rates, step)
    for _ in range(halves):
        summed, whole = summed + whole.swapaxes(1, 2) @ summed @ whole, whole @ whole
    return whole, np.asarray(summed)


def _followed(ratio: float, hertz: float, seconds: float, grown: Any) -> Array:
    """(kinetic, elastic, work, damped) of the modes of three elements from rest, joules.

    Each mode with its forces is one linear system: omega q, dq/dt, powers of time times cosine and sine.
    """
    from verify.models.catalogue import MODELS

    basis = MODELS["fem"].time_basis(BAR, 3, 9, "spline")
    omegas, omega = basis.omegas, 2.0 * pi * hertz
    loads = np.array([phasor(one) * basis.loads(one.position) for one in FORCES]).sum(axis=0)
    state, begin, spent = np.zeros((len(omegas), 2)), 0.0, np.zeros(2)
    for span, powers in (*grown, (seconds - sum(one for one, _ in grown), (1.0,))):
        k, size = len(powers), 2 + 2 * len(powers)
        rates, squares = np.zeros((len(omegas), size, size)), np.zeros((2, len(omegas), size, size))
        rates[:, 0, 1], rates[:, 1, 0], rates[:, 1, 1] = omegas, -omegas, -2.0 * ratio * omegas
        forces = np.concatenate([np.outer(loads.real, powers), np.outer(-loads.imag, powers)], axis=1)
        rates[:, 1, 2:] = forces
        rising = np.diag(np.arange(1.0, k) / span, -1)
        turning = omega * np.eye(k)
        rates[:, 2:, 2:] = np.block([[rising, -turning], [turning, rising]])
        squares[0, :, 1, 2:] = forces
        squares[1, :, 1, 1] = 2.0 * ratio * omegas
        start = np.zeros((len(omegas), size, 1))
        start[:, :2, 0], start[:, 2, 0], start[:, 2 + k, 0] = state, np.cos(omega * begin), np.sin(omega * begin)
        whole, summed = _over(rates, squares, span)
        spent = spent + (start.swapaxes(1, 2) @ summed @ start).sum(axis=(1, 2, 3))
        state, begin = (whole @ start)[:, :2, 0], begin + span
    return np.array([0.5 * (state[:, 1] ** 2).sum(), 0.5 * (state[:, 0] ** 2).sum(), *spent])


def booked_error(ratio: float) -> float:
    """Of energies, work and loss of a beam from rest with one ratio of every mode, over the largest of them."""
    from verify.motion.simulate import simulate

    worst = 0.0
    for hertz, seconds, grown in DRIVES:
        run = simulate(
            BAR, FORCES, hertz, seconds, model="fem", count=3, modal_damping=ratio, envelope=grown, samples=5
        )
        ledger, exact = run.ledger, _followed(ratio, hertz, seconds, grown)
        assert isinstance(ledger, Ledger)
        found = np.array([ledger.kinetic, ledger.elastic, ledger.work_in, ledger.damped])
        worst = largest(worst, float(abs(found - exact).max() / exact.max()), abs(ledger.residual) / float(exact.max()))
    return worst


ROWS: tuple[Row, ...] = (
    Floor(
        id="books-of-damped-beams",
        title="Energy, work and loss of driven beams from no damping to nearly none of a turn, against exponentials",
        why="motion/energy.py: all integrals are closed; what is missed is rounding.",
        along="ratio",
        at=(0.0, 0.03, 0.9995),
        promise=1e-10,
        error=booked_error,
    ),
)
