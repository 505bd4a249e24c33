"""Compiled contact forces of one point in a step, the forces of all other points given.

Forces are constant over the step. The Delassus operator is never formed: `response` holds what all forces add to the
mean rates of the columns, so that a visit to a point costs two products over the columns.
"""

import numpy as np

from verify.arrays import Array, Indices
from verify.dynamics import layout as lay
from verify.dynamics.friction import coulomb_force, elastic_force, held_force, tanh_force
from verify.dynamics.kinematics import shape_of
from verify.jit import FAST, inline

CREEP = 1e-5
"""Slip of a sticking point among several, relative to its response to its own friction. It defines forces that rigidity
leaves open (more points than the beam has shapes) up to rounding of slips over it, and moves a point by 1e-5 of what
it would move in the step without friction."""
DAMPING = 0.1
"""Share of the slip at the end of a step in the condition of a sticking point."""
SLIDES, HOLDS, LETS_GO = 0.0, 1.0, 2.0
"""GRIP of a point in the step: kinetic limit; static limit; kinetic limit after the static one was exceeded."""
TRANSVERSE = 1
"""Row of `shapes` of the normal direction; responses are two rows further."""


@inline(fastmath=FAST)
def product(i: int, s: int, shapes: Array, response: Array) -> float:
    """Mean speed of point i in direction s by the mean rates of the columns."""
    total = 0.0
    for j in range(shapes.shape[2]):
        total += shapes[s, i, j] * response[j]
    return total


@inline(fastmath=FAST)
def own_product(i: int, s: int, shapes: Array) -> float:
    """The same by a unit force of the point itself."""
    total = 0.0
    for j in range(shapes.shape[2]):
        total += shapes[s, i, j] * shapes[2 + s, i, j]
    return total


@inline(fastmath=FAST)
def add_response(i: int, s: int, force: float, shapes: Array, response: Array) -> None:
    """Add a force of point i on the beam in direction s to the mean rates of the columns."""
    for j in range(shapes.shape[2]):
        response[j] -= force * shapes[2 + s, i, j]


@inline(fastmath=FAST)
def set_end_couplings(
    rows: Array, n_complex: int, table: Array, edges: Array, points: Array, contacts: Array, indices: Indices,
    shapes: Array, couplings: Array,
) -> None:  # fmt: skip
    """Speed across at the end of the step of what follows the surface, by unit forces: (2, points, points).

    It is read where the point is then, with the convective part v w' of the displacement.
    """
    n = rows.shape[1]
    for i in range(points.shape[0]):
        piece, at, above = indices[i, lay.PIECE], contacts[i, lay.AT_END], contacts[i, lay.ABOVE_END]
        length = edges[piece + 1] - edges[piece]
        lean, v = contacts[i, lay.SLOPE] * points[i, lay.LEVER] / length, contacts[i, lay.SPEED_END] / length
        for s in range(2):
            for k in range(points.shape[0]):
                couplings[s, i, k] = 0.0
        for j in range(n + n_complex):
            value, first, turn = shape_of(piece, j, at, above, table)
            rate, moved = value + lean * turn, v * first
            row = j if j < n else j - n_complex
            # real part of z: rate Re(lambda G b) + moved Re(G b); imaginary part, factor -Im z, likewise
            real = rate * rows[lay.END_RE, row] + moved * rows[lay.GAIN_RE, row]
            imaginary = rate * rows[lay.END_IM, row] + moved * rows[lay.GAIN_IM, row]
            paired = row >= n - n_complex
            for s in range(2):
                for k in range(points.shape[0]):
                    load = shapes[s, k, row] * real
                    if paired:
                        b_re, b_im = shapes[s, k, row], shapes[s, k, row + n_complex]
                        load = real * b_re - imaginary * b_im if j < n else -(real * b_im + imaginary * b_re)
                    couplings[s, i, k] += points[k, lay.WEIGHT] * load


@inline
def normal_force(
    i: int, dt: float, codes: Indices, slider: Array, feet: Array, k: int, points: Array, contacts: Array,
    shapes: Array, response: Array, couplings: Array,
) -> float:  # fmt: skip
    """Normal force of point i of a slider and of foot k, mean over the step, with its own response."""
    point, touch = points[i], contacts[i]
    n, own = touch[lay.NORMAL], 0.0
    if codes[lay.LAW] == lay.PRESCRIBED:
        return float(point[lay.LOAD])
    if codes[lay.LAW] == lay.BILATERAL:  # momentum of the step: the point has the surface's speed at its end
        inertia = point[lay.INERTIA] / dt
        climb = touch[lay.RAMP] * (slider[lay.V] + slider[lay.DELTA_V] - touch[lay.SPEED_END]) + touch[lay.CLOSING]
        if codes[lay.NORMAL_TWO_WAY] > 0:
            own = couplings[1, i, i]
            for j in range(points.shape[0]):
                climb -= couplings[0, i, j] * contacts[j, lay.FRICTION] + couplings[1, i, j] * contacts[j, lay.NORMAL]
        load = point[lay.LOAD] + inertia * (climb + own * n - touch[lay.POINT_VZ])
        return float(load / (1.0 + inertia * own))
    depth, was, dashpot = touch[lay.DEPTH], touch[lay.WAS_DEPTH], point[lay.DASHPOT]
    if depth <= 0.0:
        return 0.0
    force = point[lay.STIFF] * depth
    if dashpot > 0.0:  # it acts from the landing on, on the mean speed of the step
        dashpot *= 0.5 + depth / (depth - was) if was <= 0.0 else 1.0
        foot, arm = feet[k], point[lay.ARM]
        own = 0.5 * dt * (foot[lay.INVERSE_FOOT_MASS] + arm * arm * foot[lay.INVERSE_INERTIA])
        closing = touch[lay.CLOSING] - 0.5 * point[lay.FACE] * (foot[lay.DELTA_VZ] + arm * foot[lay.DELTA_PITCH_RATE])
        if codes[lay.NORMAL_TWO_WAY] > 0:
            closing += product(i, TRANSVERSE, shapes, response)
            own += own_product(i, TRANSVERSE, shapes)
        force = (force + dashpot * (closing + own * n)) / (1.0 + dashpot * own)
    return float(max(force, 0.0))


@inline
def friction_limit(slider: Array, touch: Array) -> float:
    """Largest friction of a point in the step, N: static where it holds, else kinetic."""
    return float(slider[lay.MU_STATIC if touch[lay.GRIP] == HOLDS else lay.MU] * max(touch[lay.NORMAL], 0.0))


@inline
def slip_at_start(codes: Indices, slider: Array, touch: Array) -> float:
    """Slip s_0 at the start of the step from its mean s and end e without contact forces, 2 s - e, m/s."""
    if codes[lay.LAW] == lay.SPRING:
        return float(slider[lay.V] - touch[lay.MEAN] + 0.5 * touch[lay.SURFACE_DELTA_V])
    return float(slider[lay.V] - 2.0 * touch[lay.MEAN] + touch[lay.END])


@inline
def sticking_slip(codes: Indices, slider: Array, touch: Array) -> float:
    """Mean slip s of a sticking point, m/s.

    None alone would leave one that alternates. A share D of no slip at the end damps it: (1 - D) s + D (s - s_0/2) = 0.
    """
    return 0.5 * DAMPING * slip_at_start(codes, slider, touch)


@inline
def friction_force(
    i: int, dt: float, codes: Indices, slider: Array, point: Array, touch: Array, shapes: Array, response: Array,
    spans: Array,
) -> float:  # fmt: skip
    """Friction of point i on its slider, mean over the step, with its own response."""
    force, normal, work, several = touch[lay.FRICTION], max(touch[lay.NORMAL], 0.0), spans[i], shapes.shape[1] > 1
    kinetic, static, own, others = slider[lay.MU] * normal, slider[lay.MU_STATIC] * normal, 0.0, 0.0
    mobility, v, steepness = dt * slider[lay.INVERSE_MASS], slider[lay.V], slider[lay.STEEPNESS]
    if codes[lay.TWO_WAY] > 0:
        own = touch[lay.SELF_RESPONSE]
        others = product(i, 0, shapes, response) + own * force
    compliance, gained, was_stuck = (
        mobility + 2.0 * own,
        slider[lay.DELTA_V] - mobility * force,
        touch[lay.WAS_STUCK],
    )
    mean = touch[lay.MEAN] + others
    slip = v + 0.5 * gained - mean  # mean over the step without this force
    work[0], work[3] = 0.0, 0.0
    if point[lay.TANGENTIAL] > 0.0:
        limit = friction_limit(slider, touch)
        force, work[0], _ = elastic_force(dt, slip, compliance, limit, kinetic, steepness, point, touch)
        touch[lay.SLIP] = slip + 0.5 * compliance * force
        return float(force)
    if kinetic <= 0.0:
        force = 0.0
    else:
        if codes[lay.LAW] == lay.SPRING:
            rise = touch[lay.SURFACE_DELTA_V] + 2.0 * others
            start, a0, a1 = mean - 0.5 * rise, rise - gained, rise - gained
        else:  # a parabola of exact mean through the speeds at both ends
            start, end = touch[lay.START], touch[lay.END] + 2.0 * others
            rise = end - start
            a0 = 6.0 * mean - 4.0 * start - 2.0 * end - gained
            a1 = 4.0 * end + 2.0 * start - 6.0 * mean - gained
        if steepness > 0.0:
            force = tanh_force(v - mean + 0.5 * rise, rise - gained, compliance, kinetic, steepness)
        elif several and (was_stuck > 0.0 or touch[lay.GRIP] == HOLDS):
            static = friction_limit(slider, touch)
            needed = -2.0 * (slip - sticking_slip(codes, slider, touch)) / (compliance * (1.0 + CREEP))
            force = min(max(needed, -static), static)
            work[0], work[2], work[3] = 1.0 if force == needed else 0.0, compliance * (force - needed), 0.0
            work[1] = 0.5 * work[2]
            if force != needed:
                work[3], work[4], work[5] = 1.0, 1.0, lay.SLIPS
        elif was_stuck == 1.0 and own > 0.0:
            needed = -2.0 * (slip - sticking_slip(codes, slider, touch)) / compliance
            force = held_force(needed, kinetic, static, touch[lay.WAS_FRICTION], compliance, work)
        else:
            left = v - start if was_stuck > 0.0 else 0.0  # of the last step, taken off in this one
            static = kinetic if several else static  # beyond it `revise_limits` lets the point try
            force = coulomb_force(v - start, a0 - left, a1 - left, compliance, kinetic, static, was_stuck > 0.0, work)
    if own > 0.0:
        # A force that is constant over the step dissipates where it lies between none and the one without mean slip.
        # Beyond, as in the step of a slip reversal, it returns at most what friction has dissipated before.
        bound = -slip / compliance
        wide = np.sqrt(bound * bound + 2.0 * max(touch[lay.LOSS], 0.0) / (dt * compliance))
        force = min(max(force, bound - wide), bound + wide)
    touch[lay.SLIP] = slip + 0.5 * compliance * force
    return float(force)
