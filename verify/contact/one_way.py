"""Friction of a slider with several points on a surface that does not respond to them.

The points are coupled by the slider's gain of speed g alone, g = g_0 + dt/m sum F_i(g) with the gain g_0 by external
forces, found by Newton's method between bounds. Friction falls with g, so that the root is the only one, but where a
point may stop whose static limit is above its kinetic one: then the first guess, at which points that stick stay at
rest, decides. The root may lie at a gain that stops a point, where what the other points leave is shared by the points
at rest in proportion to the range of their forces.
"""

from verify.contact import laws
from verify.contact.points import slip_of
from verify.contact.state import Bodies, Kind, Path, Record
from verify.jit import inline, jit, once

ROUNDS = 100  # Newton steps and bisections for the gain of speed: bisection alone reaches its rounding in about 60
AT_REST = 1e-13
"""Speed, over the speeds of which it is a difference, at which a point is at rest: their rounding over a step."""
WIDER = 1.001  # Bounds of the gain of speed, over all limits of friction, so that a root at a limit is within them
SETTLED = 1e-14  # Momentum that is missing, over that of all limits of friction, at which the root is at its rounding


@inline
def path_of(dt: float, gained: float, end_weight: float, slider: Record, contact: Record, limit: float) -> Path:
    """Relative speed of a point in a step in which the slider gains the speed `gained`."""
    start = slider.v - contact.mean + 0.5 * contact.surface_delta_v
    mobility = dt * slider.inverse_mass
    speeds = abs(slider.v) + abs(start) + abs(contact.surface_delta_v) + mobility * slider.mu * contact.normal
    end = start + gained - contact.surface_delta_v
    return Path(start, end, mobility, end_weight, limit, AT_REST * speeds, dt)


@inline
def forces_at(
    gained: float, end_weight: float, first: int, last: int, dt: float, bodies: Bodies
) -> tuple[float, float, float]:
    """(Least, largest friction of points first..last, derivative by the gain of speed); sets those of every point.

    `stopping_gain` is the gain at which a rigid point stops within the step, else the present one.
    """
    least, most, slope, slider = 0.0, 0.0, 0.0, bodies.sliders[bodies.points[last].slider]
    for i in range(first, last + 1):
        point, contact = bodies.points[i], bodies.contacts[i]
        path = path_of(dt, gained, end_weight, slider, contact, laws.limits(slider, point, contact))
        low, high, rate = laws.slope(path, contact.normal, slider, point, contact)
        contact.least, contact.most, contact.stopping_gain = low, high, gained
        least, most, slope = least + low, most + high, slope + rate
        if not laws.set_valued(point.law):
            continue
        stops = abs(path.start) < path.mobility * (slider.mu_static + slider.mu) * contact.normal
        if low < high:
            contact.holds = 1.0 if contact.sticks_before > 0.0 or abs(path.start) <= path.rounding else 0.5
        else:
            contact.holds = 0.0
            contact.stopping_gain = contact.surface_delta_v - path.start if stops else gained
    return least, most, slope


@once
def gain_of_speed(first: int, last: int, dt: float, end_weight: float, bodies: Bodies) -> tuple[float, float]:
    """(Root g, share of the range of the forces of points at rest).

    The first guess is the gain at which a point that sticks stays at rest, else that by the last friction.
    """
    slider = bodies.sliders[bodies.points[last].slider]
    mobility, external_gain, gained, limit = dt * slider.inverse_mass, slider.delta_v, slider.delta_v, 0.0
    rest, resting = 0.0, False
    for i in range(first, last + 1):
        contact = bodies.contacts[i]
        start = slider.v - contact.mean + 0.5 * contact.surface_delta_v
        limit += mobility * contact.normal * slider.mu_static
        gained += mobility * contact.friction_before
        at_rest = contact.sticks_before > 0.0 or abs(start) <= AT_REST * mobility * slider.mu * contact.normal
        if contact.normal > 0.0 and at_rest:
            rest, resting = contact.surface_delta_v - start, True
    low, high = external_gain - WIDER * limit, external_gain + WIDER * limit
    gained = min(max(rest if resting else gained, low), high)
    least, most, missing = 0.0, 0.0, 0.0
    for _ in range(ROUNDS):
        least, most, slope = forces_at(gained, end_weight, first, last, dt, bodies)
        missing = gained - external_gain - mobility * most
        if missing > 0.0:
            high = gained
        else:
            missing, low = min(gained - external_gain - mobility * least, 0.0), gained
        after = gained - missing / (1.0 - mobility * slope)
        if not low < after < high:
            after = 0.5 * (low + high)
        for i in range(first, last + 1):  # to the first stop on the way
            if min(gained, after) < bodies.contacts[i].stopping_gain < max(gained, after):
                after = bodies.contacts[i].stopping_gain
        if abs(missing) <= SETTLED * limit or (after - gained) * (after - low) * (after - high) == 0.0:
            break
        gained = after
    if mobility > 0.0 and most > least:
        return gained, min(max(((gained - external_gain) / mobility - least) / (most - least), 0.0), 1.0)
    return gained, 0.5  # at a prescribed speed: friction at rest is open, its middle is taken


@jit(no_cpython_wrapper=True)
def solve_one_way_friction(last: int, dt: float, kind: Kind, bodies: Bodies) -> float:
    """Friction of a slider, its last point this one; what its momentum lacks, N.

    A single point has the force of its law with its own response. Of several the mean of a smooth law on a line takes a
    share `end_weight` of its value at the end, which damps a slider that friction stops within a step: with the mean
    alone, weight 1/2 of the end, the relative speed would alternate where dt/m K sum(mu N) is above 2; 1 - 2/that is
    the least weight in addition that does not.
    """
    slider, first, limit = bodies.sliders[bodies.points[last].slider], last, 0.0
    while first > 0 and bodies.points[first - 1].slider == bodies.points[last].slider:
        first -= 1
    mobility, external_gain, total, end_weight, gained = dt * slider.inverse_mass, slider.delta_v, 0.0, 0.0, 0.0
    if first == last:
        point, contact = bodies.points[last], bodies.contacts[last]
        slip = slip_of(dt, total, kind, slider, contact)  # 0.0; a constant would compile it anew
        contact.friction = laws.force(slip, contact.normal, slider, point, contact)
        gained = external_gain + mobility * contact.friction
    else:
        for i in range(first, last + 1):
            limit += mobility * bodies.contacts[i].normal * slider.mu_static
        end_weight = max(1.0 - 2.0 / (limit * slider.steepness + 1e-300), 0.0)
        gained, share = gain_of_speed(first, last, dt, end_weight, bodies)
        for i in range(first, last + 1):
            contact = bodies.contacts[i]
            contact.friction = contact.least + share * (contact.most - contact.least)
    for i in range(first, last + 1):
        total += bodies.contacts[i].friction
    slider.delta_v = external_gain + mobility * total
    for i in range(first, last + 1):
        point, contact = bodies.points[i], bodies.contacts[i]
        path = path_of(dt, slider.delta_v, end_weight, slider, contact, 0.0)
        contact.slip = 0.5 * (path.start + path.end)
        contact.power = laws.power(path, contact.normal, slider, point, contact)
    return abs(gained - slider.delta_v) / mobility if mobility > 0.0 else 0.0
