"""Compiled friction of a slider with several points on a surface that does not respond to them."""

import numpy as np

from verify.arrays import Array, Indices
from verify.dynamics import layout as lay
from verify.dynamics.friction import elastic_force, line_force, tanh_force
from verify.dynamics.point_forces import friction_limit
from verify.jit import inline

START, STOP, LEAST, MOST = range(4, 8)
"""Columns of `spans` here: relative speed at the start, gain that stops the point, bounds of its friction."""
ROUNDS = 100
"""Newton steps and bisections for the gain of speed: bisection alone reaches its rounding in about 60."""


@inline
def slope_of_friction(
    dt: float, gained: float, late: float, slider: Array, point: Array, touch: Array, work: Array
) -> float:
    """Derivative of a point's friction by the gain of its slider; `work` gets STOP and the bounds of the force."""
    kinetic, v, steepness = slider[lay.MU] * touch[lay.NORMAL], slider[lay.V], slider[lay.STEEPNESS]
    static, stuck = slider[lay.MU_STATIC] * touch[lay.NORMAL], touch[lay.WAS_STUCK] > 0.0
    start, rise, mobility, work[STOP] = work[START], touch[lay.SURFACE_DELTA_V], dt * slider[lay.INVERSE_MASS], gained
    if point[lay.TANGENTIAL] > 0.0:
        slip, limit = v + 0.5 * gained - touch[lay.MEAN], friction_limit(slider, touch)
        force, soft, stiffness = elastic_force(dt, slip, 0.0, limit, kinetic, steepness, point, touch)
        work[0], work[LEAST], work[MOST] = soft, force, force
        if steepness > 0.0:
            soft = steepness * (kinetic - force * force / (kinetic + 1e-300))
            soft /= soft + stiffness
        return -0.5 * stiffness * soft
    rounding, end = 1e-13 * (abs(v) + abs(start) + abs(rise) + mobility * kinetic), start + gained - rise
    least, most, slope = line_force(start, end, mobility, kinetic, static, steepness, late, stuck, rounding)
    work[0], work[LEAST], work[MOST] = 0.0, least, most
    if least < most:
        work[0] = 1.0 if stuck or abs(start) <= rounding else 0.5
    elif steepness == 0.0 and abs(start) < mobility * (static + kinetic) and abs(end) > rounding:
        work[STOP] = rise - start
    return float(slope)


@inline
def solve_one_way_friction(
    last: int, dt: float, sliders: Array, points: Array, contacts: Array, indices: Indices, spans: Array
) -> float:
    """Friction of a slider, its last point this one, on feet without response of the beam; what its momentum lacks, N.

    The points are coupled by the slider's gain of speed alone, and friction falls with it: one root, by Newton's method
    between bounds. It may lie at a gain that stops a point, where what the other points leave is shared by the points
    at rest as their limits go. Sets of `spans` 1 or 0.5 (from an event in the step) of a point at rest, and mean loss.
    """
    slider, first = sliders[indices[last, lay.OF_SLIDER]], last
    while first > 0 and indices[first - 1, lay.OF_SLIDER] == indices[last, lay.OF_SLIDER]:
        first -= 1
    mobility, v, steepness = dt * slider[lay.INVERSE_MASS], slider[lay.V], slider[lay.STEEPNESS]
    pulled, gained, limit, rest, resting = slider[lay.DELTA_V], slider[lay.DELTA_V], 0.0, 0.0, False
    for i in range(first, last + 1):
        touch, normal = contacts[i], contacts[i, lay.NORMAL]
        start = v - touch[lay.MEAN] + 0.5 * touch[lay.SURFACE_DELTA_V]
        spans[i, START] = start
        limit += mobility * normal * slider[lay.MU_STATIC]
        gained += mobility * touch[lay.WAS_FRICTION]
        if normal > 0.0 and (touch[lay.WAS_STUCK] > 0.0 or abs(start) <= 1e-13 * mobility * slider[lay.MU] * normal):
            rest, resting = touch[lay.SURFACE_DELTA_V] - start, True
    low, high = pulled - 1.001 * limit, pulled + 1.001 * limit
    gained = min(max(rest if resting else gained, low), high)  # between the limits of friction a point at rest stays
    late = max(1.0 - 2.0 / (limit * steepness + 1e-300), 0.0)
    least, most, miss, exact = 0.0, 0.0, 0.0, steepness > 0.0 and first == last and points[last, lay.TANGENTIAL] == 0.0
    if exact:
        kinetic, late = slider[lay.MU] * contacts[last, lay.NORMAL], 0.0
        least = tanh_force(
            spans[last, START], contacts[last, lay.SURFACE_DELTA_V] - pulled, mobility, kinetic, steepness
        )
        spans[last, 0], spans[last, LEAST], spans[last, MOST], gained = (
            0.0,
            least,
            least,
            pulled + mobility * least,
        )
    for _ in range(0 if exact else ROUNDS):
        least, most, slope = 0.0, 0.0, 0.0
        for i in range(first, last + 1):
            slope += slope_of_friction(dt, gained, late, slider, points[i], contacts[i], spans[i])
            least, most = least + spans[i, LEAST], most + spans[i, MOST]
        miss = gained - pulled - mobility * most
        if miss > 0.0:
            high = gained
        else:
            miss, low = min(gained - pulled - mobility * least, 0.0), gained
        after = gained - miss / (1.0 - mobility * slope)
        if not low < after < high:
            after = 0.5 * (low + high)
        for i in range(first, last + 1):  # to the first stop on the line
            if min(gained, after) < spans[i, STOP] < max(gained, after):
                after = spans[i, STOP]
        if abs(miss) <= 1e-14 * limit or (after - gained) * (after - low) * (after - high) == 0.0:
            break
        gained = after
    share, total = 0.5, 0.0
    if mobility > 0.0 and most > least:
        share = min(max(((gained - pulled) / mobility - least) / (most - least), 0.0), 1.0)
    for i in range(first, last + 1):
        contacts[i, lay.FRICTION] = spans[i, LEAST] + share * (spans[i, MOST] - spans[i, LEAST])
        total += contacts[i, lay.FRICTION]
    slider[lay.DELTA_V] = pulled + mobility * total
    mean = v + 0.5 * slider[lay.DELTA_V]
    for i in range(first, last + 1):
        touch, work = contacts[i], spans[i]
        force, kinetic = touch[lay.FRICTION], slider[lay.MU] * touch[lay.NORMAL]
        start, slip = work[START], mean - touch[lay.MEAN]
        end, loss = start + gained - touch[lay.SURFACE_DELTA_V], -force * slip
        if points[i, lay.TANGENTIAL] > 0.0:
            pass
        elif steepness > 0.0:
            loss += late * kinetic * np.tanh(steepness * end) * (end - slip)
        elif start * end <= 0.0 or work[0] > 0.0:  # before and after the reversal
            side = -1.0 if start < 0.0 else 1.0
            before = abs(start) / (max(mobility * (kinetic + side * force), 0.0) + abs(start - end) + 1e-300)
            loss = 0.5 * kinetic * (abs(start) * before + abs(end) * (1.0 - before))
        touch[lay.SLIP], work[1] = slip, loss
    return abs(gained - slider[lay.DELTA_V]) / mobility if mobility > 0.0 else 0.0
