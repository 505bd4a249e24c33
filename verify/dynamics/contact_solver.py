"""Compiled contact forces of a step: normal laws, friction laws and the responses of beam, feet and sliders to them.

Points are swept one after the other (Gauss-Seidel), each law solved exactly with its own response, the others' forces
fixed; where the sweeps do not converge, the friction of all points is solved together.
"""

from verify.arrays import Array, Indices
from verify.dynamics import layout as lay
from verify.dynamics.active_sets import SETTLED, revise_limits, solve_active_sets
from verify.dynamics.one_way_friction import solve_one_way_friction
from verify.dynamics.point_forces import (
    HOLDS,
    SLIDES,
    TRANSVERSE,
    add_response,
    friction_force,
    normal_force,
    own_product,
    product,
)
from verify.jit import FAST, inline, jit

SWEEPS = 24
"""Sweeps before the friction forces of a step are solved as a block."""
TOLERANCE = 1e-12
"""Change of a force in a sweep, of the largest normal force, at which sweeps have converged."""
PASSES = 50
"""Rounds of friction at given normal forces and of normal forces at given friction. The one acts on the other by the
slope of the surface and by dashpots, both small; a step that needs more counts as not converged."""


@jit(no_cpython_wrapper=True)
def set_normal_forces(
    every: bool, dt: float, codes: Indices, sliders: Array, feet: Array, points: Array, contacts: Array,
    indices: Indices, shapes: Array, response: Array, couplings: Array,
) -> float:  # fmt: skip
    """Set the normal forces of points in contact and what they add to feet and columns; largest change, N.

    Of every point, or of those whose normal force depends on the forces of the step.
    """
    law, largest = codes[lay.LAW], 0.0
    for i in range(points.shape[0]):
        point, touch = points[i], contacts[i]
        depends = every or law == lay.BILATERAL or point[lay.DASHPOT] > 0.0
        if not depends or (law == lay.SPRING and touch[lay.DEPTH] <= 0.0):
            continue
        slider, k = sliders[indices[i, lay.OF_SLIDER]], indices[i, lay.OF_FOOT]
        normal = normal_force(i, dt, codes, slider, feet, k, points, contacts, shapes, response, couplings)
        more = normal - touch[lay.NORMAL]
        touch[lay.NORMAL] = normal
        if codes[lay.NORMAL_TWO_WAY] > 0 and more != 0.0:
            add_response(i, TRANSVERSE, more, shapes, response)
        if law == lay.SPRING:
            foot, push = feet[k], dt * point[lay.FACE] * more
            foot[lay.DELTA_VZ] += push * foot[lay.INVERSE_FOOT_MASS]
            foot[lay.DELTA_PITCH_RATE] += push * point[lay.ARM] * foot[lay.INVERSE_INERTIA]
        largest = max(largest, abs(more))
    return largest


@jit(no_cpython_wrapper=True)
def solve(
    dt: float, codes: Indices, sliders: Array, feet: Array, points: Array, contacts: Array, indices: Indices,
    shapes: Array, response: Array, couplings: Array, spans: Array, block: Array, balance: Array,
) -> None:  # fmt: skip
    """Contact forces of the step into `contacts`, and what they add to sliders, feet and the columns (`response`).

    `block` (points, points + 1) is working space.
    """
    law, two_way, n = codes[lay.LAW], codes[lay.TWO_WAY] > 0, points.shape[0]
    for b in range(sliders.shape[0]):
        slider = sliders[b]
        slider[lay.DELTA_V] = dt * (slider[lay.INVERSE_MASS] * slider[lay.EXTERNAL_FORCE] + slider[lay.TILT])
    for k in range(feet.shape[0]):
        foot = feet[k]
        press = foot[lay.FOOT_LOAD] - foot[lay.SPRING_RATE] * foot[lay.HEIGHT]
        foot[lay.DELTA_VZ], foot[lay.DELTA_PITCH_RATE] = dt * foot[lay.INVERSE_FOOT_MASS] * press, 0.0
    for j in range(len(response)):
        response[j] = 0.0
    alone = law == lay.SPRING and not two_way  # normal forces do not depend on friction
    coupled, largest, sweeps, changed = law == lay.BILATERAL or (n > 1 and two_way), 0.0, 0, 0.0
    for i in range(n):
        touch = contacts[i]
        touch[lay.WAS_FRICTION], touch[lay.WAS_STUCK] = touch[lay.FRICTION], touch[lay.STUCK]
        touch[lay.NORMAL], touch[lay.FRICTION], touch[lay.SLIP], touch[lay.STUCK] = 0.0, 0.0, 0.0, 0.0
        touch[lay.SELF_RESPONSE] = own_product(i, 0, shapes) if two_way else 0.0
        touch[lay.GRIP] = HOLDS if touch[lay.WAS_STUCK] > 0.0 else SLIDES
        coupled = coupled or points[i, lay.DASHPOT] > 0.0
    while True:
        for _ in range(SWEEPS):
            sweeps += 1
            changed = set_normal_forces(
                sweeps == 1, dt, codes, sliders, feet, points, contacts, indices, shapes, response, couplings
            )
            largest = max(largest, changed)  # that of the first sweep is the largest force
            for i in range(0 if alone else n):
                touch, slider = contacts[i], sliders[indices[i, lay.OF_SLIDER]]
                if law == lay.SPRING and touch[lay.DEPTH] <= 0.0:
                    continue
                force = friction_force(i, dt, codes, slider, points[i], touch, shapes, response, spans)
                more = force - touch[lay.FRICTION]
                if more != 0.0:
                    touch[lay.FRICTION] = force
                    slider[lay.DELTA_V] += dt * slider[lay.INVERSE_MASS] * more
                    if two_way:
                        add_response(i, 0, more, shapes, response)
                    changed = max(changed, abs(more))
            if changed <= TOLERANCE * largest or not coupled:
                changed = 0.0
                break
        for _ in range(PASSES if changed > 0.0 and two_way else 0):
            changed = solve_active_sets(
                dt, codes, largest, sliders, points, contacts, indices, shapes, response, spans, block
            )
            differs = set_normal_forces(  # a constant would compile it a second time
                sweeps == 0, dt, codes, sliders, feet, points, contacts, indices, shapes, response, couplings
            )
            changed = max(changed, differs)
            if differs <= SETTLED * largest:
                break
        if alone or not (n > 1 and two_way) or not revise_limits(dt, codes, sliders, points, contacts, indices, spans):
            break
    balance[lay.SWEEPS] += sweeps
    for i in range(n if alone else 0):
        if i + 1 == n or indices[i + 1, lay.OF_SLIDER] != indices[i, lay.OF_SLIDER]:
            changed = max(changed, solve_one_way_friction(i, dt, sliders, points, contacts, indices, spans))
    balance[lay.UNCONVERGED] += 1.0 if changed > 1e-9 * largest else 0.0
    balance[lay.RESIDUAL] = max(balance[lay.RESIDUAL], changed)
    for i in range(n):
        touch = contacts[i]
        mean = touch[lay.MEAN]
        surface = mean + product(i, 0, shapes, response) if two_way else mean
        touch[lay.STUCK] = spans[i, 0] if touch[lay.NORMAL] > 0.0 else 0.0
        touch[lay.SURFACE], touch[lay.BEFORE] = surface, 2.0 * surface - mean
        if points[i, lay.TANGENTIAL] == 0.0:
            touch[lay.LOSS] -= dt * touch[lay.FRICTION] * touch[lay.SLIP]


@inline(fastmath=FAST)
def apply_forces(codes: Indices, rows: Array, points: Array, contacts: Array, shapes: Array) -> None:
    """Forces that are constant over the step, to the rows at its end: exact."""
    n, n_complex = rows.shape[1], codes[lay.COMPLEX]
    for j in range(n):
        real, imaginary = 0.0, 0.0
        for i in range(points.shape[0]):
            along, across = points[i, lay.WEIGHT] * contacts[i, lay.FRICTION], 0.0
            if codes[lay.NORMAL_TWO_WAY] > 0:
                across = points[i, lay.WEIGHT] * contacts[i, lay.NORMAL]
            real -= along * shapes[0, i, j] + across * shapes[1, i, j]
            if j >= n - n_complex:
                imaginary -= along * shapes[0, i, j + n_complex] + across * shapes[1, i, j + n_complex]
        rows[lay.Z_RE, j] += rows[lay.GAIN_RE, j] * real - rows[lay.GAIN_IM, j] * imaginary
        rows[lay.Z_IM, j] += rows[lay.GAIN_RE, j] * imaginary + rows[lay.GAIN_IM, j] * real
