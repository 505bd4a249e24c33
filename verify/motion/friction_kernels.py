"""Compiled friction: Eq. (3) solved exactly within a step, Coulomb's law from event to event.

A slider on a belt, at the end of the file, is friction alone.
"""

import numpy as np

from verify.arrays import Array
from verify.jit import inline, jit
from verify.motion import records as rec
from verify.motion.records import Law, Space


@jit
def tanh_speed_change(r: float, a: float, b: float, slope: float, dt: float) -> float:
    """What friction -b tanh(slope r) adds to a slider's speed in dt, while r' = -b tanh(slope r) - a exactly.

    r is the relative speed at the start and `a` the constant acceleration of the surface. Solved in closed form
    up to one monotone scalar equation, so any slope and any step are stable and exact.
    """
    if b <= 0.0 or dt <= 0.0:
        return 0.0
    alpha, tau = a / b, slope * b * dt
    side = -1.0 if alpha < 0.0 else 1.0  # mirrored, so that the surface accelerates forward
    alpha, rho = side * alpha, side * slope * r
    if (1.0 + alpha) * tau < 0.01:
        return float(side * _brief_change(rho, alpha, tau) / slope)
    if rho > 20.0 and rho - (alpha + 1.0) * tau > 20.0:
        return -side * b * dt  # |tanh| is 1 throughout, to e^-40
    if rho < -20.0 and rho - (alpha - 1.0) * tau < -20.0:
        return side * b * dt
    if abs(alpha - 1.0) < 1e-7:
        alpha = 1.0 + (1e-7 if alpha >= 1.0 else -1e-7)  # 1e-7 of b in this step; the formulas part there
    change = _held_change(rho, alpha, tau) if alpha < 1.0 else _swept_change(rho, alpha, tau)
    added = change + alpha * tau  # rounding gives no more than friction has
    added = -tau if -tau > added else added
    added = tau if tau < added else added
    return float(side * added / slope)


@inline
def _brief_change(rho: float, alpha: float, tau: float) -> float:
    """What friction adds to rho in a short tau, in which logarithms cancel: four stages, off by less than 3e-11 tau."""
    first = np.tanh(rho)
    second = np.tanh(rho - 0.5 * tau * (first + alpha))
    third = np.tanh(rho - 0.5 * tau * (second + alpha))
    fourth = np.tanh(rho - tau * (third + alpha))
    return float(-tau * (first + 2.0 * second + 2.0 * third + fourth) / 6.0)


@inline
def _swept_change(rho: float, alpha: float, tau: float) -> float:
    """Change of rho in tau under rho' = -(tanh rho + alpha), alpha > 1: there is no speed at rest with the surface.

    alpha delta - ln cosh delta falls by (alpha^2 - 1) tau, with delta = rho + artanh(1/alpha). Newton's method on
    the change; it stops where the next step would be rounding.
    """
    grip = np.tanh(rho)
    lean = (alpha * grip + 1.0) / (alpha + grip)  # tanh delta
    fall = (alpha * alpha - 1.0) * tau
    change = -(alpha + np.tanh(rho - 0.5 * (alpha + grip) * tau)) * tau
    for _ in range(80):
        if abs(change) < 4.0:
            grown = np.expm1(change)
            sine, cosine = 0.5 * (grown + grown / (grown + 1.0)), 0.5 * grown * grown / (grown + 1.0)
            inner = cosine + lean * sine
            value, end = np.log1p(inner), (lean * (1.0 + cosine) + sine) / (1.0 + inner)
        else:
            delta = rho + np.arctanh(1.0 / alpha)
            value, end = _ln_cosh(delta + change) - _ln_cosh(delta), np.tanh(delta + change)
        step = (alpha * change - value + fall) / (alpha - end)
        change -= step
        if abs(step) <= 1e-8 * (abs(change) + 1e-8):
            break
    return float(change)


@inline
def _ln_cosh(delta: float) -> float:
    """Ln(2 cosh delta), without overflow."""
    return float(abs(delta) + np.log1p(np.exp(-2.0 * abs(delta))))


@inline
def _held_change(rho: float, alpha: float, tau: float) -> float:
    """Change of rho in tau under rho' = -(tanh rho + alpha), 0 <= alpha < 1: rho tends to rest = -artanh alpha.

    With eta = |rho - rest|, ln sinh eta - s alpha eta falls by (1 - alpha^2) tau; solved for ln sinh eta, in which
    the slope lies between 1 - alpha and 1 + alpha.
    """
    rest = -np.arctanh(alpha)
    side = 1.0 if rho > rest else -1.0
    eta = abs(rho - rest)
    if eta == 0.0:
        return 0.0
    lean = side * alpha
    start = _ln_sinh(eta)
    goal = start - lean * eta - (1.0 - alpha * alpha) * tau
    level = goal + lean * eta
    level = level if level < start else start
    for _ in range(80):
        here = _arsinh_exp(level)
        step = (level - lean * here - goal) / (1.0 - lean * np.tanh(here))
        level -= step
        if abs(step) <= 1e-8:  # the next would be its square
            break
    return float(side * _arsinh_exp(level) + rest - rho)


@inline
def _ln_sinh(eta: float) -> float:
    return float(np.log(np.sinh(eta))) if eta < 1.0 else eta - np.log(2.0) + np.log1p(-np.exp(-2.0 * eta))


@inline
def _arsinh_exp(level: float) -> float:
    return float(np.arcsinh(np.exp(level))) if level < 20.0 else level + np.log(2.0)


@jit
def coulomb_span(
    r: float, a0: float, a1: float, kinetic: float, static: float, dt: float, stuck: bool
) -> tuple[float, float, bool, float]:
    """Until friction changes its mind: (time used, r at its end, whether stuck then, kind of event or 0).

    `a0` and `a1` are the acceleration of the surface relative to a slider free of friction, at the start and the
    end of dt, linear between. A slider at rest on the surface stays while |a| <= static; one that slips does so
    under `kinetic` until r = 0, where it sticks if it can.
    """
    rate = (a1 - a0) / dt
    if stuck and abs(a0) > static * (1.0 + 1e-12):
        return 0.0, 0.0, False, rec.SLIPS
    if stuck:
        for bound in (static, -static):
            beyond = (a1 - bound) * (1.0 if bound > 0.0 else -1.0)
            if beyond > 0.0 and rate != 0.0:
                at = (bound - a0) / rate
                at = 0.0 if at < 0.0 else at
                return dt if dt < at else at, 0.0, False, rec.SLIPS
        return dt, 0.0, True, 0.0
    side = np.sign(r) if r != 0.0 else -np.sign(a0 if a0 != 0.0 else rate)
    slowing = kinetic * side + a0  # r(t) = r - slowing t - rate t^2 / 2
    used = _first_zero(r, slowing, rate, dt)
    if used >= dt:
        return dt, r - slowing * dt - 0.5 * rate * dt * dt, False, 0.0
    return used, 0.0, abs(a0 + rate * used) <= static, rec.STICKS if abs(a0 + rate * used) <= static else rec.TURNS


@inline
def _first_zero(r: float, slowing: float, rate: float, dt: float) -> float:
    """The first t in (0, dt) where r - slowing t - rate t^2/2 changes sign, else dt."""
    if r == 0.0:
        # leaves zero now; it comes back where slowing + rate t / 2 = 0
        back = -2.0 * slowing / rate if rate != 0.0 else dt
        return back if 0.0 < back < dt else dt
    discriminant = slowing * slowing + 2.0 * rate * r
    if discriminant < 0.0:
        return dt
    root = np.sqrt(discriminant)
    q = slowing + root if slowing >= 0.0 else slowing - root
    first, second = (2.0 * r / q if q != 0.0 else dt), (-q / rate if rate != 0.0 else dt)
    best = dt
    for t in (first, second):
        if 0.0 < t < best:
            best = t
    return best


@inline(forceinline=True)
def _grip(r: float, slope: float | None) -> float:
    """Share of full friction under Eq. (3). Numba drops a branch for what is None, and only then: hence twice."""
    if slope is None:
        return 0.0
    return float(np.tanh(slope * r))


@inline(forceinline=True)
def _tanh_slip(r: float, a: float, b: float, slope: float | None, dt: float) -> float:
    """`tanh_speed_change` where the law has a slope."""
    if slope is None:
        return 0.0
    return tanh_speed_change(r, a, b, slope, dt)


@inline(forceinline=True)
def friction(r: float, static: float | None, law: Law) -> float:
    """Friction per mass at relative speed r where it does not depend on sticking; `static` is the law's."""
    if static is None:
        return -law.kinetic * _grip(r, law.slope)
    return float(-law.kinetic * np.sign(r))


@inline(forceinline=True)
def slip(
    v: float,
    stuck: bool,
    push: float,
    half: float,
    full: float,
    static: float | None,
    law: Law,
    dt: float,
    space: Space,
) -> float:
    """Speed change by friction in one step under a contact force `push` on the beam; fills `space.slip`.

    `static` is the law's, handed on by itself so that numba drops the branch of the other law.

    For tanh the speed of the surface is replaced by its least-squares line, which keeps both moments: order 4
    where friction is smooth, exact where it is steep. Coulomb's law follows the parabola, with sticking and
    slipping located on it.
    """
    seen, took = space.seen, space.slip
    s0 = seen[0, rec.SURFACE]
    sm = seen[1, rec.SURFACE] - took[rec.GIVEN_MIDDLE] + push * half
    s1 = seen[2, rec.SURFACE] - took[rec.GIVEN_END] + push * full
    took[rec.STICKING], took[rec.N_EVENTS] = 0.0, 0.0
    if static is None:
        mean, rise = (s0 + 4.0 * sm + s1) / 6.0, s1 - s0
        took[rec.CHANGE] = _tanh_slip(v - mean + 0.5 * rise, rise / dt, law.kinetic, law.slope, dt)
        return float(took[rec.CHANGE])
    a0, a1 = (4.0 * sm - 3.0 * s0 - s1) / dt, (3.0 * s1 - 4.0 * sm + s0) / dt
    r, used, took[rec.RELATIVE] = 0.0 if stuck else v - s0, 0.0, 0.0
    if abs(r) <= 1e-9 * law.kinetic * dt and abs(a0) <= static:
        r, stuck = 0.0, True  # put on a surface at rest, to rounding
    for _ in range(rec.SPANS):
        slips, before = not stuck, r
        span, r, stuck, event = coulomb_span(r, a0 + (a1 - a0) * used / dt, a1, law.kinetic, static, dt - used, stuck)
        used += span
        if slips:  # r is a parabola
            took[rec.RELATIVE] += 0.5 * span * (before + r) + (a1 - a0) / dt * span * span * span / 12.0
        if event in (rec.STICKS, rec.SLIPS):
            here = rec.FIRST_EVENT + 2 * int(took[rec.N_EVENTS])
            took[here], took[here + 1] = used, event
            took[rec.N_EVENTS] += 1.0
        if used >= dt or (span <= 0.0 and event == 0.0):
            break
    took[rec.CHANGE], took[rec.STICKING] = r + s1 - v, 1.0 if stuck else 0.0
    return float(took[rec.CHANGE])


@inline
def give(dt: float, seen: Array, took: Array) -> None:
    """What everything but friction adds to the speed by the middle and the end of a step."""
    took[rec.GIVEN_MIDDLE] = dt * (5.0 * seen[0, rec.PULL] + 8.0 * seen[1, rec.PULL] - seen[2, rec.PULL]) / 24.0
    took[rec.GIVEN_END] = dt * (seen[0, rec.PULL] + 4.0 * seen[1, rec.PULL] + seen[2, rec.PULL]) / 6.0
