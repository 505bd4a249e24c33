"""Compiled friction laws: the force on a slider in one step, with its own response and the surface's solved exactly.

The relative speed r = v - s of a point follows r' = compliance f - a in units of one step: f is the friction force on
the slider, `a` the gain of the surface over a slider without friction, `compliance` = dt/m + 2 w with the `mobility`
dt/m of the slider and the mean response w of the surface to a unit force.
"""

import numpy as np

from verify.arrays import Array
from verify.dynamics import layout as lay
from verify.jit import inline, jit

SPANS = 12
"""Spans between events in one step of Coulomb's law."""
BRIEF = 0.01
"""Nondimensional step below which the closed form of the tanh law would cancel."""
FLAT = 20.0
"""From there on tanh is 1 to the last digit."""


@jit
def tanh_change(r: float, a: float, b: float, steepness: float) -> float:
    """What friction adds to r in a unit of time in which r' = -b tanh(K r) - a, in closed form for any K and b.

    With rho = K r and alpha = a/b: for alpha < 1 rho tends to rest = -artanh alpha, and with eta = |rho - rest|
    ln sinh eta - s alpha eta falls by (1 - alpha^2) tau; solved for ln sinh eta, in which the slope lies between
    1 - alpha and 1 + alpha. For alpha > 1, alpha delta - ln cosh delta falls by (alpha^2 - 1) tau with
    delta = rho + artanh(1/alpha), by Newton's method on the change.
    """
    if b <= 0.0:
        return 0.0
    alpha, tau = a / b, steepness * b
    side = -1.0 if alpha < 0.0 else 1.0  # mirrored, so that the surface accelerates forward
    alpha, rho = side * alpha, side * steepness * r
    if (1.0 + alpha) * tau < BRIEF:  # four stages, off by less than 3e-11 tau
        first = np.tanh(rho)
        second = np.tanh(rho - 0.5 * tau * (first + alpha))
        third = np.tanh(rho - 0.5 * tau * (second + alpha))
        fourth = np.tanh(rho - tau * (third + alpha))
        return float(-side * tau * (first + 2.0 * second + 2.0 * third + fourth) / 6.0 / steepness)
    if rho > FLAT and rho - (alpha + 1.0) * tau > FLAT:
        return -side * b
    if rho < -FLAT and rho - (alpha - 1.0) * tau < -FLAT:
        return side * b
    if abs(alpha - 1.0) < 1e-7:
        alpha = 1.0 + (1e-7 if alpha >= 1.0 else -1e-7)  # 1e-7 of b in this step; the formulas part there
    if alpha < 1.0:
        rest = -np.arctanh(alpha)
        sign, eta = 1.0 if rho > rest else -1.0, abs(rho - rest)
        change = 0.0
        if eta > 0.0:
            lean = sign * alpha
            start = np.log(np.sinh(eta)) if eta < 1.0 else eta - np.log(2.0) + np.log1p(-np.exp(-2.0 * eta))
            goal = start - lean * eta - (1.0 - alpha * alpha) * tau
            level = min(goal + lean * eta, start)
            here = 0.0
            for _ in range(80):
                here = np.arcsinh(np.exp(level)) if level < FLAT else level + np.log(2.0)
                step = (level - lean * here - goal) / (1.0 - lean * np.tanh(here))
                level -= step
                if abs(step) <= 1e-8:  # the next would be its square
                    break
            here = np.arcsinh(np.exp(level)) if level < FLAT else level + np.log(2.0)
            change = sign * here + rest - rho
    else:
        grip = np.tanh(rho)
        lean = (alpha * grip + 1.0) / (alpha + grip)  # tanh delta
        change = -(alpha + np.tanh(rho - 0.5 * (alpha + grip) * tau)) * tau
        for _ in range(80):
            if abs(change) < 4.0:
                grown = np.expm1(change)
                sine, cosine = 0.5 * (grown + grown / (grown + 1.0)), 0.5 * grown * grown / (grown + 1.0)
                inner = cosine + lean * sine
                value, end = np.log1p(inner), (lean * (1.0 + cosine) + sine) / (1.0 + inner)
            else:
                delta = rho + np.arctanh(1.0 / alpha)
                value, end = ln_cosh(delta + change) - ln_cosh(delta), np.tanh(delta + change)
            step = (alpha * change - value + (alpha * alpha - 1.0) * tau) / (alpha - end)
            change -= step
            if abs(step) <= 1e-8 * (abs(change) + 1e-8):
                break
    added = min(max(change + alpha * tau, -tau), tau)  # rounding gives no more than friction has
    return float(side * added / steepness)


@inline
def ln_cosh(x: float) -> float:
    """Ln(2 cosh x), without overflow."""
    return float(abs(x) + np.log1p(np.exp(-2.0 * abs(x))))


@inline
def tanh_force(r: float, a: float, compliance: float, most: float, steepness: float) -> float:
    """Mean friction in the step by the tanh law: the closed form, or the mean over a given sweep without response."""
    if compliance * most * steepness > 1e-9:
        return float(tanh_change(r, a, compliance * most, steepness) / compliance)
    half, middle = 0.5 * steepness * abs(a), steepness * (r - 0.5 * a)
    if half < 0.1:
        t = np.tanh(middle)
        return float(-most * (t - half * half / 3.0 * t * (1.0 - t * t)))
    return float(-most * (ln_cosh(middle + half) - ln_cosh(middle - half)) / (2.0 * half))


@jit
def coulomb_span(
    r: float, a0: float, a1: float, kinetic: float, static: float, dt: float, stuck: bool
) -> tuple[float, float, bool, float]:
    """Until the friction force changes: (time used, r at its end, whether stuck then, kind of event or 0).

    `a0` and `a1` are the acceleration of the surface relative to a slider free of friction, at the start and the
    end of dt, linear between. A slider at rest on the surface stays while |a| <= static; one that slips does so
    under `kinetic` until r = 0, where it sticks if it can.
    """
    rate = (a1 - a0) / dt
    if stuck and abs(a0) > static * (1.0 + 1e-12):
        return 0.0, 0.0, False, lay.SLIPS
    if stuck:
        for bound in (static, -static):
            beyond = (a1 - bound) * (1.0 if bound > 0.0 else -1.0)
            if beyond > 0.0 and rate != 0.0:
                return min(max((bound - a0) / rate, 0.0), dt), 0.0, False, lay.SLIPS
        return dt, 0.0, True, 0.0
    side = np.sign(r) if r != 0.0 else -np.sign(a0 if a0 != 0.0 else rate)
    slowing, used = kinetic * side + a0, dt  # r(t) = r - slowing t - rate t^2 / 2
    if r == 0.0:  # leaves zero now; it comes back where slowing + rate t / 2 = 0
        back = -2.0 * slowing / rate if rate != 0.0 else dt
        used = back if 0.0 < back < dt else dt
    elif slowing * slowing + 2.0 * rate * r >= 0.0:
        root = np.sqrt(slowing * slowing + 2.0 * rate * r)
        q = slowing + root if slowing >= 0.0 else slowing - root
        first, second = (2.0 * r / q if q != 0.0 else dt), (-q / rate if rate != 0.0 else dt)
        used = first if 0.0 < first < used else used
        used = second if 0.0 < second < used else used
    if used >= dt:
        return dt, r - slowing * dt - 0.5 * rate * dt * dt, False, 0.0
    sticks = abs(a0 + rate * used) <= static
    return used, 0.0, sticks, lay.STICKS if sticks else lay.TURNS


@inline
def coulomb_force(
    r: float, a0: float, a1: float, compliance: float, kinetic: float, static: float, stuck: bool, work: Array
) -> float:
    """Mean friction in the step by Coulomb's law, from event to event.

    Sets `work` (4 + 2 SPANS,), the row of a point: 1 where it sticks all the step, 0.5 where from an event in it to its
    end; the relative displacement over dt, r at the end, the number of events, and of each the share of the step and
    its kind.
    """
    force, used, moved, n = 0.0, 0.0, 0.0, 0
    if abs(r) <= 1e-9 * compliance * kinetic and abs(a0) <= compliance * static:
        r, stuck = 0.0, True  # put on a surface at rest, to rounding
    for _ in range(SPANS):
        slips, before, start = not stuck, r, a0 + (a1 - a0) * used
        span, r, stuck, event = coulomb_span(r, start, a1, compliance * kinetic, compliance * static, 1.0 - used, stuck)
        if slips:  # r is a parabola
            side = np.sign(before) if before != 0.0 else np.sign(r)
            force -= side * kinetic * span
            moved += 0.5 * span * (before + r) + (a1 - a0) * span * span * span / 12.0
        elif compliance > 0.0:
            force += (start + 0.5 * (a1 - a0) * span) * span / compliance
        used += span
        if event != 0.0:
            work[4 + 2 * n], work[5 + 2 * n] = used, event
            n += 1
        if used >= 1.0 or (span <= 0.0 and event == 0.0):
            break
    sticks = 1.0 if n == 0 else 0.5  # within the step
    work[0], work[1], work[2], work[3] = sticks if stuck else 0.0, moved, r, n
    return float(min(max(force, -max(static, kinetic)), max(static, kinetic)))


@inline
def held_force(needed: float, kinetic: float, static: float, last: float, compliance: float, work: Array) -> float:
    """Mean friction in the step of a point that sticks to a surface with a response, from the force that it `needed`.

    A force that is constant in the step lets the surface move less evenly than the true one, so that means decide. It
    slips where the line through the last mean and this one passes the static limit. `work` as in `coulomb_force`.
    """
    size, sign = abs(needed), 1.0 if needed > 0.0 else -1.0
    work[0], work[1], work[2], work[3] = 1.0, 0.0, 0.0, 0.0
    if size <= static:
        return needed
    stays = min(max((static - sign * last) / (size - sign * last) - 0.5, 0.0), 1.0)
    mean = stays * 0.5 * (0.5 * (sign * last + size) + static) + (1.0 - stays) * kinetic
    work[0], work[2], work[3] = 0.0, -sign * (size - mean) * compliance, 1.0
    work[1] = 0.5 * (1.0 - stays) * work[2]
    work[4], work[5] = stays, lay.SLIPS
    return float(sign * mean)


@inline
def line_force(
    r: float, end: float, mobility: float, kinetic: float, static: float, steepness: float, late: float, stuck: bool,
    rounding: float,
) -> tuple[float, float, float]:  # fmt: skip
    """(Least, largest mean friction, its derivative) of a point whose relative speed goes from r to `end` in the step.

    Both forces differ where the point is at rest at the end: they bound what sticking takes. `mobility` bends the
    line at a reversal by the point's own force, so that r' = mobility f - a as in `coulomb_span`. Tanh: the mean over
    the line; a share `late` of the force at its end damps a slider that friction stops within a step.
    """
    if steepness > 0.0:
        t, half, middle = np.tanh(steepness * end), 0.5 * steepness * (end - r), 0.5 * steepness * (end + r)
        if abs(half) < 0.1:
            mean = np.tanh(middle)
            left = 1.0 - mean * mean
            mean, rate = mean - half * half / 3.0 * mean * left, (0.5 - half / 3.0 * mean) * left
        else:
            mean = (ln_cosh(middle + half) - ln_cosh(middle - half)) / (2.0 * half)
            rate = (t - mean) / (2.0 * half)
        force = -kinetic * (mean + late * (t - mean))
        return force, force, -kinetic * steepness * (rate + late * (1.0 - t * t - rate))
    rests = abs(end) <= rounding
    if stuck or abs(r) <= rounding:
        return (-static, static, 0.0) if rests else (-np.sign(end) * kinetic, -np.sign(end) * kinetic, 0.0)
    side = np.sign(r)
    r, end = side * r, side * end
    if rests and r < mobility * (static + kinetic):
        top = static - r / mobility
        return (-kinetic, top, 0.0) if side > 0.0 else (-top, kinetic, 0.0)
    if end >= 0.0:
        return -side * kinetic, -side * kinetic, 0.0
    change, own = r - end, mobility * kinetic
    # it reverses: a = change + mobility force satisfies (own + a) (end + a - own) = r (a - own), piecewise linear
    root = np.sqrt(change * change - 4.0 * own * (r + end - own))
    force = -2.0 * kinetic * (r + end - own) / (change + root)
    return side * force, side * force, (force - kinetic) / root


@inline
def stretching_time(dt: float, touch: Array) -> float:
    """Time for which the mean slip has stretched the spring at mid-step, s: half the step, or since the landing."""
    depth, was = touch[lay.DEPTH], touch[lay.WAS_DEPTH]
    return float(0.5 * dt if was > 0.0 or depth <= 0.0 else dt * depth / (depth - was))


@inline
def elastic_force(
    dt: float,
    slip: float,
    compliance: float,
    limit: float,
    kinetic: float,
    steepness: float,
    point: Array,
    touch: Array,
) -> tuple[float, float, float]:
    """(Friction of an elastic tangential contact, 1 where it sticks, stiffness by slip, N s/m) by return mapping.

    `slip` is that of the step without this force, `compliance` its gain by one. Coulomb: the trial force up to the
    limit. Tanh: spring and slip in series, F = trial - stiffness artanh(F/limit)/K.
    """
    spring = point[lay.TANGENTIAL] * stretching_time(dt, touch)
    full = 1.0 + 0.5 * spring * compliance
    trial, stiffness = (point[lay.TANGENTIAL] * touch[lay.STRETCH] - spring * slip) / full, spring / full
    if kinetic <= 0.0:
        return 0.0, 0.0, spring
    if steepness == 0.0:
        return (trial, 1.0, spring) if abs(trial) < limit else (float(np.sign(trial) * limit), 0.0, spring)
    size, sign = abs(trial), 1.0 if trial > 0.0 else -1.0
    low, high = max(size - kinetic, 0.0) / stiffness, size / stiffness  # tanh lies between 0 and 1
    slipped = low
    for _ in range(60):
        t = np.tanh(steepness * slipped)
        miss = kinetic * t + stiffness * slipped - size
        after = slipped - miss / (kinetic * steepness * (1.0 - t * t) + stiffness)
        if abs(after - slipped) <= 1e-14 * (slipped + 1e-12):
            break
        if miss > 0.0:
            high = slipped
        else:
            low = slipped
        slipped = after if low < after < high else 0.5 * (low + high)
    return float(sign * kinetic * np.tanh(steepness * slipped)), 0.0, spring
