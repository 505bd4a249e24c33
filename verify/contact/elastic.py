"""A tangential spring in series with slip by Coulomb's law or by the tanh law: return mapping."""

import math

from verify.contact.state import HOLDS, Path, Record, Slip
from verify.jit import inline, once

ROUNDS = 60
"""Newton steps and bisections for the slip of the tanh law: bisection alone reaches its rounding in about 50."""
SETTLED = 1e-14  # Change of the slip, relative and over 1e-12 m/s, at which it is at its rounding


@inline
def stretching_time(dt: float, contact: Record) -> float:
    """Time for which the mean slip has stretched the spring at mid-step, s: half the step, or since the landing.

    The depth grows on a line from its last value, so that the point lands the share depth/(depth - depth_before) of a
    step before mid-step.
    """
    depth, before = contact.depth, contact.depth_before
    return float(0.5 * dt if before > 0.0 or depth <= 0.0 else dt * depth / (depth - before))


@once
def slip_in_series(size: float, stiffness: float, limit: float, steepness: float) -> float:
    """Slip s of limit tanh(K s) + stiffness s = size, m/s, by Newton's method between bounds (tanh is in 0 to 1)."""
    low, high = max(size - limit, 0.0) / stiffness, size / stiffness
    slipped = low
    for _ in range(ROUNDS):
        t = math.tanh(steepness * slipped)
        miss = limit * t + stiffness * slipped - size
        after = slipped - miss / (limit * steepness * (1.0 - t * t) + stiffness)
        if abs(after - slipped) <= SETTLED * (slipped + 1e-12):
            break
        if miss > 0.0:
            high = slipped
        else:
            low = slipped
        slipped = after if low < after < high else 0.5 * (low + high)
    return slipped


@inline
def mapped(
    mean: float,
    compliance: float,
    limit: float,
    normal: float,
    dt: float,
    slider: Record,
    point: Record,
    contact: Record,
) -> tuple[float, float]:
    """(Friction, stiffness of the spring by slip, N s/m) for the mean slip without it; sets `holds`.

    Coulomb: the trial force up to the limit. Tanh: F = trial - stiffness artanh(F/limit)/K.
    """
    kinetic, spring = slider.mu * normal, point.tangential_stiffness * stretching_time(dt, contact)
    contact.holds = 0.0
    if kinetic <= 0.0:
        return 0.0, spring
    whole = 1.0 + 0.5 * spring * compliance  # the force takes back the slip of its own response
    trial = (point.tangential_stiffness * contact.stretch - spring * mean) / whole
    sign = 1.0 if trial > 0.0 else -1.0
    if slider.steepness > 0.0:
        slipped = slip_in_series(abs(trial), spring / whole, kinetic, slider.steepness)
        return float(sign * kinetic * math.tanh(slider.steepness * slipped)), spring
    if abs(trial) < limit:
        contact.holds = 1.0
        return trial, spring
    return sign * limit, spring


@once
def force(slip: Slip, normal: float, slider: Record, point: Record, contact: Record) -> float:
    """Mean friction in the step, N."""
    limit = limits(slider, contact)
    return mapped(slip.mean, slip.compliance, limit, normal, slip.dt, slider, point, contact)[0]


@once
def slope(path: Path, normal: float, slider: Record, point: Record, contact: Record) -> tuple[float, float, float]:
    """(Friction, the same, its derivative by the end of the path).

    Spring and slip are in series: 1/(dF/ds) = 1/stiffness + 1/(K limit (1 - (F/limit)^2)), the last of the tanh law.
    """
    kinetic, mean = slider.mu * normal, 0.5 * (path.start + path.end)
    value, stiffness = mapped(mean, 0.0, path.limit, normal, path.dt, slider, point, contact)
    series = contact.holds
    if slider.steepness > 0.0:
        of_slip = slider.steepness * (kinetic - value * value / (kinetic + 1e-300))
        series = of_slip / (of_slip + stiffness)
    return value, value, -0.5 * stiffness * series


@inline
def limits(slider: Record, contact: Record) -> float:
    """Largest friction in the step, N: static where the point holds, else kinetic; none of the tanh law."""
    if slider.steepness > 0.0:
        return math.inf
    mu = slider.mu_static if contact.limit_state == HOLDS else slider.mu
    return float(mu * max(contact.normal, 0.0))


@once
def power(path: Path, normal: float, slider: Record, contact: Record) -> float:
    """Power that the mean force takes, W; the spring keeps a part of it."""
    return float(-0.5 * contact.friction * (path.start + path.end))


@once
def update(slip: Slip, normal: float, slider: Record, point: Record, contact: Record) -> float:
    """Stretch the spring to the end of the step, as far as friction at the end lets it; mean of r.

    It has stretched for the whole step, or since the landing, which was `stretching_time` before mid-step. The normal
    force at the end is extrapolated by the rate at which the gap closes.
    """
    after, top = -contact.slip, 0.0
    if contact.normal > 0.0:
        at_end = contact.normal + 0.5 * slip.dt * point.stiffness * contact.closing
        mu = slider.mu_static if contact.sticks > 0.0 else slider.mu
        top = mu * max(at_end, 0.0) / point.tangential_stiffness
        share = contact.friction / (slider.mu * contact.normal + 1e-300)
        if slider.steepness > 0.0 and abs(share) < 1.0:
            after -= math.atanh(share) / slider.steepness
    since = stretching_time(slip.dt, contact) + 0.5 * slip.dt
    contact.stretch = min(max(contact.stretch + since * after, -top), top)
    return float(contact.slip)
