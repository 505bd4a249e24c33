"""Friction F = -mu N tanh(K r) of the paper, Eq. (3): smooth, without sticking; its mean over a step in closed form."""

import math

from verify.contact.state import Path, Record, Slip
from verify.jit import inline, jit, once

BRIEF = 0.01
"""Nondimensional step below which the closed form of the law would cancel; four stages are off by 3e-11 there."""
FLAT = 20.0  # From there on tanh is 1 to the last digit: 2 e^-40 is 8e-18
EQUAL = 1e-7
"""Distance of alpha from 1 at which the closed forms for either side part; it changes the force by as much."""
SETTLED = 1e-8  # Relative change at which Newton's method ends: the next one would be its square
ROUNDS = 80
"""Newton steps at most: the functions have a curvature of one sign, so that they do not return; 6 are common."""
STRAIGHT = 0.01
"""Half width in K r below which the mean over a line is a series of order 4, whose next term is below 1e-13; above it
the difference of logarithms has no more rounding than that."""


@inline
def ln_cosh(x: float) -> float:
    """Ln(2 cosh x), without overflow."""
    return float(abs(x) + math.log1p(math.exp(-2.0 * abs(x))))


@once
def change_towards_rest(rho: float, alpha: float, tau: float) -> float:
    """Change of rho = K r in the time tau by rho' = -tanh rho - alpha, for alpha < 1: it tends to -artanh alpha.

    With the distance eta from there, ln sinh eta - s alpha eta falls by (1 - alpha^2) tau; Newton's method for
    ln sinh eta, in which the slope lies between 1 - alpha and 1 + alpha.
    """
    rest = -math.atanh(alpha)
    sign, eta = 1.0 if rho > rest else -1.0, abs(rho - rest)
    if eta <= 0.0:
        return 0.0
    lean, after = sign * alpha, 0.0
    start = math.log(math.sinh(eta)) if eta < 1.0 else eta - math.log(2.0) + math.log1p(-math.exp(-2.0 * eta))
    goal = start - lean * eta - (1.0 - alpha * alpha) * tau
    level = min(goal + lean * eta, start)
    for _ in range(ROUNDS):
        after = math.asinh(math.exp(level)) if level < FLAT else level + math.log(2.0)
        step = (level - lean * after - goal) / (1.0 - lean * math.tanh(after))
        level -= step
        if abs(step) <= SETTLED:
            break
    after = math.asinh(math.exp(level)) if level < FLAT else level + math.log(2.0)
    return float(sign * after + rest - rho)


@once
def change_without_rest(rho: float, alpha: float, tau: float) -> float:
    """The same for alpha > 1, where friction is too weak for rest.

    With delta = rho + artanh(1/alpha), alpha delta - ln cosh delta falls by (alpha^2 - 1) tau; Newton's method for the
    change of delta, small changes without cancellation.
    """
    t = math.tanh(rho)
    lean = (alpha * t + 1.0) / (alpha + t)  # tanh delta
    change = -(alpha + math.tanh(rho - 0.5 * (alpha + t) * tau)) * tau
    for _ in range(ROUNDS):
        if abs(change) < 4.0:
            grown = math.expm1(change)
            sine, cosine = 0.5 * (grown + grown / (grown + 1.0)), 0.5 * grown * grown / (grown + 1.0)
            inner = cosine + lean * sine
            value, end = math.log1p(inner), (lean * (1.0 + cosine) + sine) / (1.0 + inner)
        else:
            delta = rho + math.atanh(1.0 / alpha)
            value, end = ln_cosh(delta + change) - ln_cosh(delta), math.tanh(delta + change)
        step = (alpha * change - value + (alpha * alpha - 1.0) * tau) / (alpha - end)
        change -= step
        if abs(step) <= SETTLED * (abs(change) + SETTLED):
            break
    return float(change)


@once
def change_in_brief(rho: float, alpha: float, tau: float) -> float:
    """Change of rho by friction alone in a short time, by the classical method of four stages."""
    first = math.tanh(rho)
    second = math.tanh(rho - 0.5 * tau * (first + alpha))
    third = math.tanh(rho - 0.5 * tau * (second + alpha))
    fourth = math.tanh(rho - tau * (third + alpha))
    return float(-tau * (first + 2.0 * second + 2.0 * third + fourth) / 6.0)


@jit(no_cpython_wrapper=True)
def change(r: float, a: float, b: float, steepness: float) -> float:
    """What friction adds to r in a unit of time in which r' = -b tanh(K r) - a, in closed form for any K and b."""
    if b <= 0.0:
        return 0.0
    alpha, tau = a / b, steepness * b
    side = -1.0 if alpha < 0.0 else 1.0  # mirrored, so that the surface accelerates forward
    alpha, rho = side * alpha, side * steepness * r
    if (1.0 + alpha) * tau < BRIEF:
        return side * change_in_brief(rho, alpha, tau) / steepness
    if rho > FLAT and rho - (alpha + 1.0) * tau > FLAT:
        return -side * b
    if rho < -FLAT and rho - (alpha - 1.0) * tau < -FLAT:
        return side * b
    if abs(alpha - 1.0) < EQUAL:
        alpha = 1.0 + (EQUAL if alpha >= 1.0 else -EQUAL)
    whole = change_towards_rest(rho, alpha, tau) if alpha < 1.0 else change_without_rest(rho, alpha, tau)
    added = min(max(whole + alpha * tau, -tau), tau)  # rounding gives no more than friction has
    return float(side * added / steepness)


@once
def force(slip: Slip, normal: float, slider: Record, point: Record, contact: Record) -> float:
    """Mean friction in the step, N: the closed form, or the mean over a given sweep of r without a response.

    The acceleration of the surface is its mean; r at the start follows from the mean of r.
    """
    limit, steepness, a = slider.mu * normal, slider.steepness, 0.5 * (slip.first + slip.last)
    if slip.compliance * limit * steepness > 1e-9:  # below, the response changes half of that of the mean
        return change(slip.mean + 0.5 * a, a, slip.compliance * limit, steepness) / slip.compliance
    return float(limit * mean_over_line(slip.mean + 0.5 * a, slip.mean - 0.5 * a, 0.0, steepness)[0])


@inline
def mean_over_line(start: float, end: float, end_weight: float, steepness: float) -> tuple[float, float]:
    """(Mean of -tanh(K r), its derivative by `end`) where r goes from `start` to `end` on a line.

    A share `end_weight` of the value at its end is taken instead.
    """
    t, half, middle = math.tanh(steepness * end), 0.5 * steepness * (end - start), 0.5 * steepness * (end + start)
    if abs(half) < STRAIGHT:
        mean = math.tanh(middle)
        left = 1.0 - mean * mean
        square = half * half
        rate = (0.5 - half / 3.0 * mean) * left
        mean -= square * mean * left * (1.0 / 3.0 - square * (2.0 - 3.0 * mean * mean) / 15.0)
    else:
        mean = (ln_cosh(middle + half) - ln_cosh(middle - half)) / (2.0 * half)
        rate = (t - mean) / (2.0 * half)
    return -(mean + end_weight * (t - mean)), -steepness * (rate + end_weight * (1.0 - t * t - rate))


@once
def slope(path: Path, normal: float, slider: Record, point: Record, contact: Record) -> tuple[float, float, float]:
    """(Friction, the same, its derivative by the end of the path)."""
    limit, (mean, rate) = slider.mu * normal, mean_over_line(path.start, path.end, path.end_weight, slider.steepness)
    return limit * mean, limit * mean, limit * rate


@once
def limits(slider: Record, contact: Record) -> float:
    """No limit: the law itself stays below mu N."""
    return math.inf


@once
def power(path: Path, normal: float, slider: Record, contact: Record) -> float:
    """Dissipated power of the step, W: that of the mean force at the mean slip, and of the share of it at the end.

    A reversal with equal speeds before and after it dissipates nothing by this, as the mean force is zero.
    """
    slip, end_weight = 0.5 * (path.start + path.end), path.end_weight * slider.mu * normal
    return float(-contact.friction * slip + end_weight * math.tanh(slider.steepness * path.end) * (path.end - slip))


@once
def update(slip: Slip, normal: float, slider: Record, point: Record, contact: Record) -> float:
    """Mean of r over the step, m/s: the slider by Simpson's rule with the closed form at half a step.

    The surface responds to the mean force.
    """
    limit, a, force = slider.mu * normal, 0.5 * (slip.first + slip.last), contact.friction
    half = change(slip.mean + 0.5 * a, 0.5 * a, 0.5 * slip.compliance * limit, slider.steepness) / slip.compliance
    of_surface = 0.5 * (slip.compliance - slip.mobility) * force
    return float(slip.mean + of_surface + slip.mobility * (4.0 * half + force) / 6.0)
