"""The compiled way of a slider in a step, however hard friction grips.

A hard grip takes a light slider to the surface's speed in a small part of a step, of which its accelerations at both
ends tell nothing. So its way is that of the surface and what the relative speed r adds to it, the integral of r.
"""

import numpy as np

from verify.arrays import Array
from verify.jit import inline
from verify.motion import records as rec
from verify.motion.friction_kernels import friction
from verify.motion.records import Law

STIFF = 0.25
"""K mu N / m times a step: below it Eq. (3) is smooth in a step, whose ends tell the way to 1e-5 of r dt."""


@inline
def _planck(w: float) -> float:
    """The integral of u / (e^u - 1) from 0 to w, by Bernoulli's numbers: off by less than 1e-15 for |w| <= ln 2."""
    s = w * w
    last = 1.0 / 526901760.0 - s * (691.0 / 16999766784000.0 - s / 1120863744000.0)
    next_last = 1.0 / 211680.0 - s * (1.0 / 10886400.0 - s * last)
    return float(w * (1.0 - 0.25 * w + s * (1.0 / 36.0 - s * (1.0 / 3600.0 - s * next_last))))


@inline
def _by_coth(eta: float) -> float:
    """The integral of x coth x from 0 to eta >= 0; far out by Euler's reflection of the dilogarithm."""
    y = 2.0 * eta
    if y <= 0.69:
        return float(0.5 * (eta * eta + _planck(y)))
    w = -np.log1p(-np.exp(-y))
    return float(0.5 * (eta * eta + np.pi * np.pi / 6.0 - _planck(w) - y * w))


@inline
def _by_tanh(delta: float) -> float:
    """The integral of x tanh x from 0 to delta."""
    y = 2.0 * abs(delta)
    w = np.log1p(np.exp(-y))
    found = 0.25 * y * y - np.pi * np.pi / 12.0 - _planck(-w) + y * w
    return float(np.copysign(0.5 * found, delta))


@inline
def _ln_cosh_change(start: float, end: float) -> float:
    """Ln cosh start - ln cosh end, without overflow."""
    first, last = abs(start), abs(end)
    return float(first - last + np.log1p(np.exp(-2.0 * first)) - np.log1p(np.exp(-2.0 * last)))


@inline
def _held_way(rho: float, end: float, alpha: float, tau: float) -> float:
    """The integral of rho over tau under rho' = -(tanh rho + alpha), 0 <= alpha < 1, from rho to `end`.

    With eta = |rho - rest|, rest = -artanh alpha: (1 - alpha^2) d tau = -(coth eta - s alpha) d eta.
    """
    rest = -np.arctanh(alpha)
    side = 1.0 if rho > rest else -1.0
    first, last = abs(rho - rest), abs(end - rest)
    told = _by_coth(first) - _by_coth(last) - 0.5 * side * alpha * (first - last) * (first + last)
    return float(rest * tau + side * told / (1.0 - alpha * alpha))


@inline
def _swept_way(rho: float, end: float, alpha: float) -> float:
    """The same, alpha > 1: (alpha^2 - 1) d tau = -(alpha - tanh delta) d delta, delta = rho + artanh(1/alpha)."""
    lead = np.arctanh(1.0 / alpha)
    first, last = rho + lead, end + lead
    straight = alpha * (rho - end) * (0.5 * (first + last) - lead)
    told = _by_tanh(first) - _by_tanh(last) - lead * _ln_cosh_change(first, last)
    return float((straight - told) / (alpha * alpha - 1.0))


@inline
def relative_way(r: float, a: float, b: float, slope: float, dt: float, change: float) -> float:
    """The integral of r over dt while r' = -b tanh(slope r) - a and friction adds `change` to the slider's speed.

    Exact, as `tanh_speed_change` is, to whose `change` it belongs: mirrored likewise, and parted where formulas do. To
    1e-6 of the largest |r| dt where |a| is b to 1e-7: its logarithms cancel, and the surface is that of `change`.
    """
    side = -1.0 if a < 0.0 else 1.0
    alpha, tau = side * a / b, slope * b * dt
    rho = side * slope * r
    if abs(alpha - 1.0) < 1e-7:
        alpha = 1.0 + (1e-7 if alpha >= 1.0 else -1e-7)
    end = rho + side * slope * change - alpha * tau
    if (rho > 20.0 and end > 20.0) or (rho < -20.0 and end < -20.0):
        return float(0.5 * (r + side * end / slope) * dt)
    way = _held_way(rho, end, alpha, tau) if alpha < 1.0 else _swept_way(rho, end, alpha)
    return float(side * way / (slope * slope * b))


@inline
def on_surface(dt: float, seen: Array) -> float:
    """The way of the surface in a step."""
    return float(dt * (seen[0, rec.SURFACE] + 4.0 * seen[1, rec.SURFACE] + seen[2, rec.SURFACE]) / 6.0)


@inline(forceinline=True)
def _ended(v: float, seen: Array, took: Array) -> float:
    """The slider's speed at the end of a step."""
    return float(seen[2, rec.SURFACE] if took[rec.STICKING] > 0.0 else v + took[rec.GIVEN_END] + took[rec.CHANGE])


@inline
def smooth_way(v: float, rate: float, dt: float, law: Law, seen: Array, took: Array) -> float:
    """The distance that the slider's own speed makes in a step, by its speed and acceleration at both ends, order 4.

    `rate` is its acceleration at the start.
    """
    v1, rate1 = _ended(v, seen, took), rate
    if took[rec.STICKING] <= 0.0:
        rate1 = seen[2, rec.PULL] + friction(v1 - seen[2, rec.SURFACE], law.static, law)
    return float(0.5 * dt * (v + v1) + dt * dt * (rate - rate1) / 12.0)


@inline
def way(v: float, rate: float, dt: float, slope: float | None, law: Law, seen: Array, took: Array) -> float:
    """The same however hard friction grips; `took` is what `slip` made of it, `seen` the surface that has felt it.

    `slope` is the law's, by itself so that numba drops the branch of the other law.
    """
    if slope is None:
        return float(on_surface(dt, seen) + took[rec.RELATIVE])
    if slope * law.kinetic * dt < STIFF:
        return smooth_way(v, rate, dt, law, seen, took)
    s0, sm, s1 = (
        seen[0, rec.SURFACE],
        seen[1, rec.SURFACE] - took[rec.GIVEN_MIDDLE],
        seen[2, rec.SURFACE] - took[rec.GIVEN_END],
    )
    rise = s1 - s0  # of the line that `slip` puts in the surface's place
    start = v - (s0 + 4.0 * sm + s1) / 6.0 + 0.5 * rise
    return float(on_surface(dt, seen) + relative_way(start, rise / dt, law.kinetic, slope, dt, took[rec.CHANGE]))


@inline(forceinline=True)
def until_caught(grip: float, r: float, dt: float) -> float:
    """Friction per mass as it acts in the mean of a step in which it takes no slider past the surface's speed."""
    return float(-r / dt if abs(grip) * dt > abs(r) else grip)


@inline(forceinline=True)
def _hardest(grip: float, dt: float, slope: float | None, law: Law, took: Array) -> float:
    """The largest friction per mass of a step: where it slips, the law's at its start; what grips hard, its mean."""
    if slope is None:
        return abs(took[rec.CHANGE]) / dt if took[rec.STICKING] > 0.0 and took[rec.N_EVENTS] == 0.0 else law.kinetic
    return abs(grip) if slope * law.kinetic * dt < STIFF else abs(took[rec.CHANGE]) / dt


@inline
def advance(
    moved: float, grip: float, dt: float, slope: float | None, law: Law, motion: Array, seen: Array, took: Array
) -> None:
    """Move the slider to the end of a step, in which its own speed made the distance `moved`.

    `grip` is friction per mass at its start by the law, `slope` the law's, by itself so that numba drops the other.
    """
    before = motion[rec.V] + took[rec.GIVEN_END]
    motion[rec.V] = _ended(motion[rec.V], seen, took)
    motion[rec.PUSHED] += motion[rec.V] - before
    motion[rec.SWEPT] += on_surface(dt, seen)
    hard = _hardest(grip, dt, slope, law, took)
    motion[rec.HARDEST] = hard if hard > motion[rec.HARDEST] else motion[rec.HARDEST]
    motion[rec.X] += moved + dt * (seen[0, rec.DRIFT] + 4.0 * seen[1, rec.DRIFT] + seen[2, rec.DRIFT]) / 6.0
    motion[rec.STUCK] = took[rec.STICKING]
