"""Coulomb's law: a rigid point sticks up to mu_static N and slides under mu N, with a limit of its own for each.

A single point is followed from event to event within the step. Points that stick together on a surface with a response
take the force that lets none of them slip in the mean of the step.
"""

import math

from verify.contact.state import EVENTS, HOLDS, SLIPS, STICKS, TURNS, Path, Record, Slip
from verify.jit import inline, jit, once

CREEP = 1e-5
"""Slip of a sticking point among several, relative to its response to its own friction. It defines forces that rigidity
leaves open (more points than the beam has shapes) up to rounding of slips over it, and moves a point by 1e-5 of what
it would move in the step without friction."""
BEYOND = 1.0 + 1e-12  # A point that sticks has its force from the last step, up to this rounding of its limit
AT_REST = 1e-9
"""Speed, of what friction changes in a step, below which a slider that is put on a surface at rest has its speed."""


@inline
def sign(x: float) -> float:
    """1, -1 or 0."""
    return 1.0 if x > 0.0 else -1.0 if x < 0.0 else 0.0


@jit(no_cpython_wrapper=True)
def span(
    r: float, a0: float, a1: float, kinetic: float, static: float, dt: float, sticks: bool
) -> tuple[float, float, bool, float]:
    """Until the friction force changes: (time used, r at its end, whether the point sticks then, kind of event or 0).

    `a0` and `a1` are the acceleration of the surface relative to a slider free of friction, at the start and the end
    of dt, linear between. A slider at rest on the surface stays while |a| <= static; one that slips does so under
    `kinetic` until r = 0, where it sticks if it can.
    """
    rate = (a1 - a0) / dt
    if sticks and abs(a0) > static * BEYOND:
        return 0.0, 0.0, False, SLIPS
    if sticks:
        for bound in (static, -static):
            beyond = (a1 - bound) * (1.0 if bound > 0.0 else -1.0)
            if beyond > 0.0 and rate != 0.0:
                return min(max((bound - a0) / rate, 0.0), dt), 0.0, False, SLIPS
        return dt, 0.0, True, 0.0
    side = sign(r) if r != 0.0 else -sign(a0 if a0 != 0.0 else rate)
    slowing, used = kinetic * side + a0, dt  # r(t) = r - slowing t - rate t^2 / 2
    if r == 0.0:  # leaves zero now; it comes back where slowing + rate t / 2 = 0
        back = -2.0 * slowing / rate if rate != 0.0 else dt
        used = back if 0.0 < back < dt else dt
    elif slowing * slowing + 2.0 * rate * r >= 0.0:
        root = math.sqrt(slowing * slowing + 2.0 * rate * r)
        q = slowing + root if slowing >= 0.0 else slowing - root  # without cancellation
        first, second = (2.0 * r / q if q != 0.0 else dt), (-q / rate if rate != 0.0 else dt)
        used = first if 0.0 < first < used else used
        used = second if 0.0 < second < used else used
    if used >= dt:
        return dt, r - slowing * dt - 0.5 * rate * dt * dt, False, 0.0
    sticks = abs(a0 + rate * used) <= static
    return used, 0.0, sticks, STICKS if sticks else TURNS


@once
def from_event_to_event(slip: Slip, kinetic: float, static: float, sticks: bool, contact: Record) -> float:
    """Mean friction in the step, exact for a linear acceleration; sets `holds`, `slip_by_law` and the events."""
    r, a0, change, force, used = slip.start, slip.first, slip.last - slip.first, 0.0, 0.0
    if sticks:  # what the last step left of its slip is taken off in this one
        a0 -= r
    own = slip.compliance
    contact.holds, contact.slip_by_law, contact.events = 0.0, 0.0, 0
    if abs(r) <= AT_REST * own * kinetic and abs(a0) <= own * static:
        r, sticks = 0.0, True
    for _ in range(EVENTS):
        slides, before, start = not sticks, r, a0 + change * used
        time, r, sticks, event = span(r, start, a0 + change, own * kinetic, own * static, 1.0 - used, sticks)
        if slides:  # r is a parabola
            side = sign(before) if before != 0.0 else -sign(start if start != 0.0 else change)
            force -= side * kinetic * time
            contact.slip_by_law += 0.5 * time * (before + r) + change * time * time * time / 12.0
        elif own > 0.0:
            force += (start + 0.5 * change * time) * time / own
        used += time
        if event != 0.0:
            n = contact.events
            contact.event_share[n], contact.event_kind[n] = used, event
            contact.events = n + 1
        if used >= 1.0 or (time <= 0.0 and event == 0.0):
            break
    if sticks:
        contact.holds = 1.0 if contact.events == 0 else 0.5
    return float(min(max(force, -max(static, kinetic)), max(static, kinetic)))


@once
def held_alone(
    sticking_force: float, kinetic: float, static: float, last: float, compliance: float, contact: Record
) -> float:
    """Mean friction of a point that sticks alone to a surface with a response, from the force that would hold it.

    A force that is constant in the step lets the surface move less evenly than the true one, so that means decide. The
    force is taken as the line through the last mean, half a step before the start, and this one in mid-step: it slips
    where that passes the static limit, from the share `stays` on, under the kinetic one.
    """
    size, sign = abs(sticking_force), 1.0 if sticking_force > 0.0 else -1.0
    contact.holds, contact.slip_by_law, contact.events = 1.0, 0.0, 0
    if size <= static:
        return sticking_force
    stays = 0.0  # of a limit that has fallen below the last force already
    if sign * last < static:
        stays = max((static - sign * last) / (size - sign * last) - 0.5, 0.0)
    mean = stays * 0.5 * (0.5 * (sign * last + size) + static) + (1.0 - stays) * kinetic
    end = -sign * (size - mean) * compliance  # r at the end, grown on a line since it slips
    contact.holds, contact.slip_by_law, contact.events = 0.0, 0.5 * (1.0 - stays) * end, 1
    contact.event_share[0], contact.event_kind[0] = stays, SLIPS
    return float(sign * mean)


@once
def held_among_others(sticking_force: float, limit: float, compliance: float, contact: Record) -> float:
    """Mean friction of one of several sticking points: what it needs, up to its limit in the step."""
    force = min(max(sticking_force, -limit), limit)
    contact.holds, contact.slip_by_law, contact.events = 1.0, 0.5 * compliance * (force - sticking_force), 0
    if force != sticking_force:
        contact.holds, contact.events = 0.0, 1
        contact.event_share[0], contact.event_kind[0] = 1.0, SLIPS
    return float(force)


@once
def force(slip: Slip, normal: float, slider: Record, point: Record, contact: Record) -> float:
    """Mean friction in the step, N."""
    kinetic, static, stuck = slider.mu * normal, slider.mu_static * normal, contact.sticks_before
    sticking_force = -2.0 * (slip.mean - slip.sticking) / slip.compliance
    if slip.several and (stuck > 0.0 or contact.limit_state == HOLDS):
        return held_among_others(sticking_force / (1.0 + CREEP), limits(slider, contact), slip.compliance, contact)
    if stuck == 1.0 and slip.own:
        return held_alone(sticking_force, kinetic, static, contact.friction_before, slip.compliance, contact)
    static = kinetic if slip.several else static  # beyond it `active_sets.revise_limits` lets the point try
    return from_event_to_event(slip, kinetic, static, stuck > 0.0, contact)


@once
def slope(path: Path, normal: float, slider: Record, point: Record, contact: Record) -> tuple[float, float, float]:
    """(Least, largest mean friction, its derivative by the end of the path).

    Both forces differ where the point is at rest at the end: they bound what sticking takes.
    """
    kinetic, static, r, end = slider.mu * normal, slider.mu_static * normal, path.start, path.end
    rests = abs(end) <= path.rounding
    if contact.sticks_before > 0.0 or abs(r) <= path.rounding:
        slides = -sign(end) * kinetic
        return (-static, static, 0.0) if rests else (slides, slides, 0.0)
    side = sign(r)
    r, end = side * r, side * end
    if rests and r < path.mobility * (static + kinetic):
        top = static - r / path.mobility
        return (-kinetic, top, 0.0) if side > 0.0 else (-top, kinetic, 0.0)
    if end >= 0.0:
        return -side * kinetic, -side * kinetic, 0.0
    change, own = r - end, path.mobility * kinetic
    # it reverses, r on two lines: a = change + mobility force satisfies (own + a) (end + a - own) = r (a - own)
    root = math.sqrt(change * change - 4.0 * own * (r + end - own))
    force = -2.0 * kinetic * (r + end - own) / (change + root)
    return side * force, side * force, (force - kinetic) / root


@inline
def limits(slider: Record, contact: Record) -> float:
    """Largest friction in the step, N: static where the point holds, else kinetic."""
    mu = slider.mu_static if contact.limit_state == HOLDS else slider.mu
    return float(mu * max(contact.normal, 0.0))


@once
def power(path: Path, normal: float, slider: Record, contact: Record) -> float:
    """Dissipated power of the step, W, under the kinetic limit before and after a reversal.

    With r' = mobility f - a in units of the step, start - end = a - mobility F of the mean force F. Before the reversal
    f = -kinetic (of start > 0), so that |r| falls by mobility (kinetic + F) + start - end: the reversal is at the share
    start over that of the step, and |r| has the means start/2 before it and |end|/2 after it.
    """
    start, end, force, kinetic = path.start, path.end, contact.friction, slider.mu * normal
    if start * end > 0.0 and contact.holds == 0.0:
        return float(-0.5 * force * (start + end))
    side = -1.0 if start < 0.0 else 1.0
    before = abs(start) / (max(path.mobility * (kinetic + side * force), 0.0) + abs(start - end) + 1e-300)
    return float(0.5 * kinetic * (abs(start) * before + abs(end) * (1.0 - before)))


@once
def update(slip: Slip, normal: float, slider: Record, point: Record, contact: Record) -> float:
    """Mean of r over the step, m/s."""
    return float(contact.slip_by_law)
