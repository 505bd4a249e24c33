"""Compiled friction of all points together on a beam that responds to it: limits of friction and active sets."""

import numpy as np

from verify.arrays import Array, Indices
from verify.dynamics import layout as lay
from verify.dynamics.friction import elastic_force, stretching_time
from verify.dynamics.point_forces import (
    CREEP,
    HOLDS,
    LETS_GO,
    SLIDES,
    add_response,
    friction_limit,
    product,
    slip_at_start,
    sticking_slip,
)
from verify.jit import inline

SETTLED = 1e-10
"""Change of a force, of the largest normal force, at which Newton's method ends: its next one would be rounding."""
AT_LIMIT = 4
"""Column of `spans` in `solve_active_sets`: 1 or -1 at a limit of friction, else 0."""
ROUNDS = 10
"""Rounds over the number of points, beside 20: with up to 31 points on 8 modes every step converged within them."""


@inline
def revise_limits(
    dt: float, codes: Indices, sliders: Array, points: Array, contacts: Array, indices: Indices, spans: Array
) -> bool:
    """Whether the limit of a rigid point by Coulomb's law changes, with static friction above the kinetic one.

    Several points may then stick in more than one way. Those that reverse their slip in the step try to stick beside
    those that stuck before; of all that exceed the static limit the worst lets go, which loads the others anew.
    """
    tries, worst, exceeds = False, 1.0, -1
    for i in range(points.shape[0]):
        touch, slider = contacts[i], sliders[indices[i, lay.OF_SLIDER]]
        static, own = (
            slider[lay.MU_STATIC] * touch[lay.NORMAL],
            0.5 * dt * slider[lay.INVERSE_MASS] + touch[lay.SELF_RESPONSE],
        )
        if slider[lay.MU_STATIC] <= slider[lay.MU] or points[i, lay.TANGENTIAL] > 0.0 or static <= 0.0:
            continue
        if touch[lay.GRIP] == SLIDES and spans[i, 0] == 0.0:
            start = slip_at_start(codes, slider, touch)
            if start * (2.0 * touch[lay.SLIP] - start) < 0.0:
                touch[lay.GRIP], tries = HOLDS, True
        elif touch[lay.GRIP] == HOLDS and spans[i, 0] == 0.0:
            excess = abs(touch[lay.FRICTION] - touch[lay.SLIP] / own) / static
            if excess > worst:
                worst, exceeds = excess, i
    if not tries and exceeds >= 0:
        contacts[exceeds, lay.GRIP] = LETS_GO
    return tries or exceeds >= 0


@inline
def law_residual(
    dt: float, codes: Indices, slip: float, slider: Array, point: Array, touch: Array
) -> tuple[float, float, float, float]:
    """Residual of a point's law within its limit of friction, for its mean slip and force: (by force, by slip, value).

    The last value is the force, N, that meets the law without its limit by the point's own response. The residual of a
    rigid sticking point is a slip, m/s, all others are forces, N.
    """
    force, normal, steepness = touch[lay.FRICTION], max(touch[lay.NORMAL], 0.0), slider[lay.STEEPNESS]
    kinetic = slider[lay.MU] * normal
    if kinetic <= 0.0:
        return 1.0, 0.0, force, 0.0
    if steepness > 0.0 and point[lay.TANGENTIAL] > 0.0:  # spring and slip in series
        by_law, _, stiffness = elastic_force(dt, slip, 0.0, kinetic, kinetic, steepness, point, touch)
        slope = steepness * (kinetic - by_law * by_law / kinetic)
        return 1.0, stiffness * slope / (slope + stiffness), force - by_law, by_law
    if steepness > 0.0:
        t = np.tanh(steepness * slip)
        return 1.0, kinetic * steepness * (1.0 - t * t), force + kinetic * t, -kinetic * t
    if point[lay.TANGENTIAL] > 0.0:
        spring = point[lay.TANGENTIAL] * stretching_time(dt, touch)
        trial = point[lay.TANGENTIAL] * touch[lay.STRETCH] - spring * slip
        return 1.0, spring, force - trial, trial
    stuck = touch[lay.WAS_STUCK] > 0.0 or touch[lay.GRIP] == HOLDS
    own = 0.5 * dt * slider[lay.INVERSE_MASS] + touch[lay.SELF_RESPONSE] + 1e-300
    excess = slip - (sticking_slip(codes, slider, touch) if stuck else 0.0) + CREEP * own * force
    return CREEP * own, 1.0, excess, force - excess / own


@inline
def mean_slip(i: int, slider: Array, touch: Array, shapes: Array, response: Array) -> float:
    """Mean slip of point i in the step under all forces, m/s."""
    return float(slider[lay.V] + 0.5 * slider[lay.DELTA_V] - touch[lay.MEAN] - product(i, 0, shapes, response))


@inline
def add_friction(i: int, more: float, dt: float, slider: Array, touch: Array, shapes: Array, response: Array) -> None:
    """Add to the friction of point i, and what that adds to its slider and to the columns."""
    touch[lay.FRICTION] += more
    slider[lay.DELTA_V] += dt * slider[lay.INVERSE_MASS] * more
    add_response(i, 0, more, shapes, response)


@inline
def bounded(slider: Array, touch: Array) -> bool:
    """Whether the law of a point has limits: Coulomb's, of a point that is pressed on."""
    return bool(slider[lay.STEEPNESS] == 0.0 and friction_limit(slider, touch) > 0.0)


@inline
def solve_rows(
    dt: float, codes: Indices, sliders: Array, points: Array, contacts: Array, indices: Indices, shapes: Array,
    response: Array, spans: Array, block: Array,
) -> None:  # fmt: skip
    """Changes of all forces, in the last column, at which the residuals of points between their limits vanish.

    The matrix is positive definite up to the scale of its rows: elimination without pivoting.
    """
    n = points.shape[0]
    for i in range(n):
        touch, row, b = contacts[i], block[i], indices[i, lay.OF_SLIDER]
        slider, diagonal, slope, miss = sliders[b], 1.0, 0.0, 0.0
        if spans[i, AT_LIMIT] == 0.0:
            slip = mean_slip(i, slider, touch, shapes, response)
            diagonal, slope, miss, _ = law_residual(dt, codes, slip, slider, points[i], touch)
        for k in range(n):
            row[k] = 0.5 * slope * dt * slider[lay.INVERSE_MASS] if indices[k, lay.OF_SLIDER] == b else 0.0
            for j in range(shapes.shape[2] if slope != 0.0 else 0):
                row[k] += slope * shapes[0, i, j] * shapes[2, k, j]
        row[i] += diagonal
        row[n] = -miss
    for k in range(n):
        for i in range(n):
            if i != k:
                share = block[i, k] / block[k, k]
                for j in range(k, n + 1):
                    block[i, j] -= share * block[k, j]
    for i in range(n):
        block[i, n] /= block[i, i]


@inline
def step_to_limit(
    dt: float, sliders: Array, contacts: Array, indices: Indices, shapes: Array, response: Array, spans: Array,
    block: Array,
) -> float:  # fmt: skip
    """Add the changes of forces up to the first limit on the way; the largest one, N, infinite where a limit stops."""
    n, share, first, side, largest = contacts.shape[0], 1.0, -1, 0.0, 0.0
    for i in range(n):
        touch, slider, more = contacts[i], sliders[indices[i, lay.OF_SLIDER]], block[i, n]
        if spans[i, AT_LIMIT] == 0.0 and bounded(slider, touch):
            limit = friction_limit(slider, touch)
            if abs(touch[lay.FRICTION] + share * more) > limit:
                first, side = i, np.sign(more)
                share = max((side * limit - touch[lay.FRICTION]) / more, 0.0)
    for i in range(n):
        touch, slider, more = contacts[i], sliders[indices[i, lay.OF_SLIDER]], share * block[i, n]
        if i == first:
            more = side * friction_limit(slider, touch) - touch[lay.FRICTION]
            spans[i, AT_LIMIT] = side
        add_friction(i, more, dt, slider, touch, shapes, response)
        largest = max(largest, abs(more))
    return np.inf if first >= 0 else largest


@inline
def release_worst(
    dt: float, codes: Indices, sliders: Array, points: Array, contacts: Array, indices: Indices, shapes: Array,
    response: Array, spans: Array,
) -> bool:  # fmt: skip
    """Set the slips; whether a point leaves its limit: that whose law asks for the least share of it."""
    least, leaves = 1.0 - SETTLED, -1
    for i in range(points.shape[0]):
        slider, touch = sliders[indices[i, lay.OF_SLIDER]], contacts[i]
        touch[lay.SLIP] = mean_slip(i, slider, touch, shapes, response)
        if spans[i, AT_LIMIT] != 0.0:
            _, _, _, wanted = law_residual(dt, codes, touch[lay.SLIP], slider, points[i], touch)
            share = spans[i, AT_LIMIT] * wanted / friction_limit(slider, touch)
            if share < least:
                least, leaves = share, i
    if leaves >= 0:
        spans[leaves, AT_LIMIT] = 0.0
    return leaves >= 0


@inline
def solve_active_sets(
    dt: float, codes: Indices, largest: float, sliders: Array, points: Array, contacts: Array, indices: Indices,
    shapes: Array, response: Array, spans: Array, block: Array,
) -> float:  # fmt: skip
    """Friction of all points together, which a beam responds to, at given normal forces; change of the last round, N.

    With Coulomb's law a strictly convex quadratic program with bounds, whose primal active sets (Nocedal and Wright,
    Numerical Optimization 2006, sec. 16.5) end after finitely many rounds. Smooth laws are solved by Newton's method in
    the same rounds.
    """
    n, changed = points.shape[0], np.inf
    for i in range(n):  # start between the limits
        touch, slider = contacts[i], sliders[indices[i, lay.OF_SLIDER]]
        limit, force = friction_limit(slider, touch), touch[lay.FRICTION]
        inside = min(max(force, -limit), limit)
        add_friction(i, inside - force, dt, slider, touch, shapes, response)
        spans[i, AT_LIMIT] = np.sign(inside) if bounded(slider, touch) and abs(inside) == limit else 0.0
    for _ in range(ROUNDS * n + 20):
        solve_rows(dt, codes, sliders, points, contacts, indices, shapes, response, spans, block)
        changed = step_to_limit(dt, sliders, contacts, indices, shapes, response, spans, block)
        if changed < np.inf:
            leaves = release_worst(dt, codes, sliders, points, contacts, indices, shapes, response, spans)
            if not leaves and changed <= SETTLED * largest:
                break
    for i in range(n):
        sticks = spans[i, AT_LIMIT] == 0.0 and sliders[indices[i, lay.OF_SLIDER], lay.STEEPNESS] == 0.0
        spans[i, 0], spans[i, 3] = 1.0 if sticks else 0.0, 0.0  # without events in the step
    return changed
