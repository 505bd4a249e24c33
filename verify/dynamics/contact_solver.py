"""Compiled contact forces of a step: normal laws, friction laws and the responses of beam, feet and sliders to them.

Forces are constant over the step. Points are swept one after the other (Gauss-Seidel), each law solved exactly with its
own response, the others' forces fixed. The Delassus operator is never formed: `response` holds what all forces add to
the mean rates of the columns, so that a visit costs two products over the columns.
"""

import numpy as np

from verify.arrays import Array, Indices
from verify.dynamics import layout as lay
from verify.dynamics.friction import coulomb_force, elastic_force, held_force, line_force, tanh_force
from verify.dynamics.kinematics import shape_of
from verify.jit import FAST, inline, jit

SWEEPS = 100
"""Sweeps before the friction forces of a step are solved as a block."""
TOLERANCE = 1e-12
"""Change of a force in a sweep, of the largest normal force, at which sweeps have converged."""
DAMPING = 0.1
"""Share of the slip at the end of a step in the condition of a sticking point."""
START, STOP, LEAST, MOST = range(4, 8)
"""Columns of `spans` in `slide`: relative speed at the start, gain that stops the point, bounds of its friction."""
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
def respond(i: int, s: int, force: float, shapes: Array, response: Array) -> None:
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
        climb = touch[lay.RAMP] * (slider[lay.V] + slider[lay.GAINED] - touch[lay.SPEED_END]) + touch[lay.CLOSING]
        if codes[lay.NORMAL_TWO_WAY] > 0:
            own = couplings[1, i, i]
            for j in range(points.shape[0]):
                climb -= couplings[0, i, j] * contacts[j, lay.FRICTION] + couplings[1, i, j] * contacts[j, lay.NORMAL]
        load = point[lay.LOAD] + inertia * (climb + own * n - touch[lay.RISE_RATE])
        return float(load / (1.0 + inertia * own))
    depth, was, dashpot = touch[lay.DEPTH], touch[lay.WAS_DEPTH], point[lay.DASHPOT]
    if depth <= 0.0:
        return 0.0
    force = point[lay.STIFF] * depth
    if dashpot > 0.0:  # it acts from the landing on, on the mean speed of the step
        dashpot *= 0.5 + depth / (depth - was) if was <= 0.0 else 1.0
        foot, arm = feet[k], point[lay.ARM]
        own = 0.5 * dt * (foot[lay.INVERSE_FOOT_MASS] + arm * arm * foot[lay.INVERSE_INERTIA])
        closing = touch[lay.CLOSING] - 0.5 * point[lay.FACE] * (foot[lay.LIFTED] + arm * foot[lay.TURNED])
        if codes[lay.NORMAL_TWO_WAY] > 0:
            closing += product(i, TRANSVERSE, shapes, response)
            own += own_product(i, TRANSVERSE, shapes)
        force = (force + dashpot * (closing + own * n)) / (1.0 + dashpot * own)
    return float(max(force, 0.0))


@inline
def friction_force(
    i: int, dt: float, codes: Indices, slider: Array, point: Array, touch: Array, shapes: Array, response: Array,
    spans: Array,
) -> float:  # fmt: skip
    """Friction of point i on its slider, mean over the step, with its own response."""
    force, normal, work = touch[lay.FRICTION], max(touch[lay.NORMAL], 0.0), spans[i]
    kinetic, static, own, others = slider[lay.MU] * normal, slider[lay.MU_STATIC] * normal, 0.0, 0.0
    light, v, steepness = dt * slider[lay.INVERSE_MASS], slider[lay.V], slider[lay.STEEPNESS]
    if codes[lay.TWO_WAY] > 0:
        own = touch[lay.OWN]
        others = product(i, 0, shapes, response) + own * force
    ease, gained, was_stuck = light + 2.0 * own, slider[lay.GAINED] - light * force, touch[lay.WAS_STUCK]
    mean = touch[lay.MEAN] + others
    slip = v + 0.5 * gained - mean  # mean over the step without this force
    work[0], work[3] = 0.0, 0.0
    if point[lay.TANGENTIAL] > 0.0:
        limit = static if was_stuck > 0.0 else kinetic
        force, work[0], _ = elastic_force(dt, slip, ease, limit, kinetic, steepness, point, touch)
        touch[lay.SLIP] = slip + 0.5 * ease * force
        return float(force)
    if kinetic <= 0.0:
        force = 0.0
    else:
        if codes[lay.LAW] == lay.SPRING:
            rise = touch[lay.RISE] + 2.0 * others
            start, a0, a1 = mean - 0.5 * rise, rise - gained, rise - gained
        else:  # a parabola of exact mean through the speeds at both ends
            start, end = touch[lay.START], touch[lay.END] + 2.0 * others
            rise = end - start
            a0 = 6.0 * mean - 4.0 * start - 2.0 * end - gained
            a1 = 4.0 * end + 2.0 * start - 6.0 * mean - gained
        if steepness > 0.0:
            force = tanh_force(v - mean + 0.5 * rise, rise - gained, ease, kinetic, steepness)
        elif was_stuck == 1.0 and own > 0.0:
            # no mean slip, which alone would leave an alternating one: a share of no slip at the end damps it
            needed = (-2.0 * (1.0 - DAMPING) * slip + DAMPING * (start + rise - v - gained)) / ease
            force = held_force(needed, kinetic, static, touch[lay.WAS_FRICTION], ease, work)
        else:
            left = v - start if was_stuck > 0.0 else 0.0  # of the last step, taken off in this one
            force = coulomb_force(v - start, a0 - left, a1 - left, ease, kinetic, static, was_stuck > 0.0, work)
    if own > 0.0:
        # A force that is constant over the step dissipates where it lies between none and the one without mean slip.
        # Beyond, as in the step of a slip reversal, it returns at most what friction has dissipated before.
        bound = -slip / ease
        wide = np.sqrt(bound * bound + 2.0 * max(touch[lay.LOSS], 0.0) / (dt * ease))
        force = min(max(force, bound - wide), bound + wide)
    touch[lay.SLIP] = slip + 0.5 * ease * force
    return float(force)


@inline
def slope_of_friction(
    dt: float, gained: float, late: float, slider: Array, point: Array, touch: Array, work: Array
) -> float:
    """Derivative of a point's friction by the gain of its slider; `work` gets STOP and the bounds of the force."""
    kinetic, v, steepness = slider[lay.MU] * touch[lay.NORMAL], slider[lay.V], slider[lay.STEEPNESS]
    static, stuck = slider[lay.MU_STATIC] * touch[lay.NORMAL], touch[lay.WAS_STUCK] > 0.0
    start, rise, light, work[STOP] = work[START], touch[lay.RISE], dt * slider[lay.INVERSE_MASS], gained
    if point[lay.TANGENTIAL] > 0.0:
        slip, limit = v + 0.5 * gained - touch[lay.MEAN], static if stuck else kinetic
        force, soft, stiffness = elastic_force(dt, slip, 0.0, limit, kinetic, steepness, point, touch)
        work[0], work[LEAST], work[MOST] = soft, force, force
        if steepness > 0.0:
            soft = steepness * (kinetic - force * force / (kinetic + 1e-300))
            soft /= soft + stiffness
        return -0.5 * stiffness * soft
    rounding, end = 1e-13 * (abs(v) + abs(start) + abs(rise) + light * kinetic), start + gained - rise
    least, most, slope = line_force(start, end, light, kinetic, static, steepness, late, stuck, rounding)
    work[0], work[LEAST], work[MOST] = 0.0, least, most
    if least < most:
        work[0] = 1.0 if stuck or abs(start) <= rounding else 0.5
    elif steepness == 0.0 and abs(start) < light * (static + kinetic) and abs(end) > rounding:
        work[STOP] = rise - start
    return float(slope)


@inline
def slide(
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
    light, v, steepness = dt * slider[lay.INVERSE_MASS], slider[lay.V], slider[lay.STEEPNESS]
    pulled, gained, limit, rest, resting = slider[lay.GAINED], slider[lay.GAINED], 0.0, 0.0, False
    for i in range(first, last + 1):
        touch, normal = contacts[i], contacts[i, lay.NORMAL]
        start = v - touch[lay.MEAN] + 0.5 * touch[lay.RISE]
        spans[i, START] = start
        limit += light * normal * slider[lay.MU_STATIC]
        gained += light * touch[lay.WAS_FRICTION]
        if normal > 0.0 and (touch[lay.WAS_STUCK] > 0.0 or abs(start) <= 1e-13 * light * slider[lay.MU] * normal):
            rest, resting = touch[lay.RISE] - start, True
    low, high = pulled - 1.001 * limit, pulled + 1.001 * limit
    gained = min(max(rest if resting else gained, low), high)  # between the limits of friction a point at rest stays
    late = max(1.0 - 2.0 / (limit * steepness + 1e-300), 0.0)
    least, most, miss, exact = 0.0, 0.0, 0.0, steepness > 0.0 and first == last and points[last, lay.TANGENTIAL] == 0.0
    if exact:
        kinetic, late = slider[lay.MU] * contacts[last, lay.NORMAL], 0.0
        least = tanh_force(spans[last, START], contacts[last, lay.RISE] - pulled, light, kinetic, steepness)
        spans[last, 0], spans[last, LEAST], spans[last, MOST], gained = 0.0, least, least, pulled + light * least
    for _ in range(0 if exact else SWEEPS):
        least, most, slope = 0.0, 0.0, 0.0
        for i in range(first, last + 1):
            slope += slope_of_friction(dt, gained, late, slider, points[i], contacts[i], spans[i])
            least, most = least + spans[i, LEAST], most + spans[i, MOST]
        miss = gained - pulled - light * most
        if miss > 0.0:
            high = gained
        else:
            miss, low = min(gained - pulled - light * least, 0.0), gained
        after = gained - miss / (1.0 - light * slope)
        if not low < after < high:
            after = 0.5 * (low + high)
        for i in range(first, last + 1):  # to the first stop on the line
            if min(gained, after) < spans[i, STOP] < max(gained, after):
                after = spans[i, STOP]
        if abs(miss) <= 1e-14 * limit or (after - gained) * (after - low) * (after - high) == 0.0:
            break
        gained = after
    share, total = 0.5, 0.0
    if light > 0.0 and most > least:
        share = min(max(((gained - pulled) / light - least) / (most - least), 0.0), 1.0)
    for i in range(first, last + 1):
        contacts[i, lay.FRICTION] = spans[i, LEAST] + share * (spans[i, MOST] - spans[i, LEAST])
        total += contacts[i, lay.FRICTION]
    slider[lay.GAINED] = pulled + light * total
    mean = v + 0.5 * slider[lay.GAINED]
    for i in range(first, last + 1):
        touch, work = contacts[i], spans[i]
        force, kinetic = touch[lay.FRICTION], slider[lay.MU] * touch[lay.NORMAL]
        start, slip = work[START], mean - touch[lay.MEAN]
        end, loss = start + gained - touch[lay.RISE], -force * slip
        if points[i, lay.TANGENTIAL] > 0.0:
            pass
        elif steepness > 0.0:
            loss += late * kinetic * np.tanh(steepness * end) * (end - slip)
        elif start * end <= 0.0 or work[0] > 0.0:  # before and after the reversal
            side = -1.0 if start < 0.0 else 1.0
            before = abs(start) / (max(light * (kinetic + side * force), 0.0) + abs(start - end) + 1e-300)
            loss = 0.5 * kinetic * (abs(start) * before + abs(end) * (1.0 - before))
        touch[lay.SLIP], work[1] = slip, loss
    return abs(gained - slider[lay.GAINED]) / light if light > 0.0 else 0.0


@jit(no_cpython_wrapper=True)
def solve(
    dt: float, codes: Indices, sliders: Array, feet: Array, points: Array, contacts: Array, indices: Indices,
    shapes: Array, response: Array, couplings: Array, spans: Array, block: Array, balance: Array,
) -> None:  # fmt: skip
    """Contact forces of the step into `contacts`, and what they add to sliders, feet and the columns (`response`).

    `block` (points, points + 1) is working space.
    """
    law, two_way, normal_two_way = codes[lay.LAW], codes[lay.TWO_WAY] > 0, codes[lay.NORMAL_TWO_WAY] > 0
    for b in range(sliders.shape[0]):
        slider = sliders[b]
        slider[lay.GAINED] = dt * (slider[lay.INVERSE_MASS] * slider[lay.EXTERNAL_FORCE] + slider[lay.TILT])
    for k in range(feet.shape[0]):
        foot = feet[k]
        press = foot[lay.FOOT_LOAD] - foot[lay.SPRING_RATE] * foot[lay.HEIGHT]
        foot[lay.LIFTED], foot[lay.TURNED] = dt * foot[lay.INVERSE_FOOT_MASS] * press, 0.0
    for j in range(len(response)):
        response[j] = 0.0
    n, alone = points.shape[0], law == lay.SPRING and not two_way  # normal forces do not depend on friction
    coupled, largest, sweeps, changed = law == lay.BILATERAL or (n > 1 and two_way), 0.0, 0, 0.0
    for i in range(n):
        touch = contacts[i]
        touch[lay.WAS_FRICTION], touch[lay.WAS_STUCK] = touch[lay.FRICTION], touch[lay.STUCK]
        touch[lay.NORMAL], touch[lay.FRICTION], touch[lay.SLIP], touch[lay.STUCK] = 0.0, 0.0, 0.0, 0.0
        touch[lay.OWN] = own_product(i, 0, shapes) if two_way else 0.0
        coupled = coupled or points[i, lay.DASHPOT] > 0.0
    while sweeps < SWEEPS:
        changed = 0.0
        sweeps += 1
        for i in range(n):
            point, touch = points[i], contacts[i]
            if law == lay.SPRING and touch[lay.DEPTH] <= 0.0:
                continue
            slider, k = sliders[indices[i, lay.OF_SLIDER]], indices[i, lay.OF_FOOT]
            if sweeps == 1 or law == lay.BILATERAL or point[lay.DASHPOT] > 0.0:
                normal = normal_force(i, dt, codes, slider, feet, k, points, contacts, shapes, response, couplings)
                more = normal - touch[lay.NORMAL]
                touch[lay.NORMAL] = normal
                if normal_two_way and more != 0.0:
                    respond(i, TRANSVERSE, more, shapes, response)
                if law == lay.SPRING:
                    foot, push = feet[k], dt * point[lay.FACE] * more
                    foot[lay.LIFTED] += push * foot[lay.INVERSE_FOOT_MASS]
                    foot[lay.TURNED] += push * point[lay.ARM] * foot[lay.INVERSE_INERTIA]
                changed, largest = max(changed, abs(more)), max(largest, normal)
            if alone:
                continue
            force = friction_force(i, dt, codes, slider, point, touch, shapes, response, spans)
            more = force - touch[lay.FRICTION]
            if more != 0.0:
                touch[lay.FRICTION] = force
                slider[lay.GAINED] += dt * slider[lay.INVERSE_MASS] * more
                if two_way:
                    respond(i, 0, more, shapes, response)
                changed = max(changed, abs(more))
        if changed <= TOLERANCE * largest or not coupled:
            changed = 0.0
            break
    balance[lay.SWEEPS] += sweeps
    for i in range(n if alone else 0):
        if i + 1 == n or indices[i + 1, lay.OF_SLIDER] != indices[i, lay.OF_SLIDER]:
            changed = max(changed, slide(i, dt, sliders, points, contacts, indices, spans))
    if changed > TOLERANCE * largest and two_way:
        changed = solve_block(dt, sliders, points, contacts, indices, shapes, response, spans, block)
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


@inline
def solve_block(
    dt: float, sliders: Array, points: Array, contacts: Array, indices: Indices, shapes: Array, response: Array,
    spans: Array, block: Array,
) -> float:  # fmt: skip
    """Friction of all rigid points together, which a beam responds to: Newton's method on active sets; last change."""
    n, changed = points.shape[0], 0.0
    for _ in range(4 * n + 20):
        for i in range(n):  # row i: what the law asks of all changes of force
            touch, row, b = contacts[i], block[i], indices[i, lay.OF_SLIDER]
            slider, force = sliders[b], touch[lay.FRICTION]
            most, steepness = slider[lay.MU] * max(touch[lay.NORMAL], 0.0), slider[lay.STEEPNESS]
            slip = slider[lay.V] + 0.5 * slider[lay.GAINED] - touch[lay.MEAN] - product(i, 0, shapes, response)
            light, diagonal, slope, miss = dt * slider[lay.INVERSE_MASS], 0.0, 1.0, slip
            tried = force - slip / (0.5 * light + touch[lay.OWN] + 1e-300)
            if points[i, lay.TANGENTIAL] > 0.0 or most == 0.0:
                diagonal, slope, miss = 1.0, 0.0, 0.0
            elif steepness > 0.0:
                t = np.tanh(steepness * slip)
                diagonal, slope, miss = 1.0, most * steepness * (1.0 - t * t), force + most * t
            elif abs(tried) >= most:  # slips
                diagonal, slope, miss = 1.0, 0.0, force - most * np.sign(tried)
            spans[i, 0] = 1.0 if diagonal == 0.0 else 0.0
            for k in range(n):
                row[k] = 0.5 * slope * light if indices[k, lay.OF_SLIDER] == b else 0.0
                for j in range(shapes.shape[2] if slope != 0.0 else 0):
                    row[k] += slope * shapes[0, i, j] * shapes[2, k, j]
            row[i] = (row[i] + diagonal) * (1.0 + 1e-10)  # points that share one slider alone
            row[n] = -miss
        for k in range(n):
            for i in range(n):
                if i != k:
                    share = block[i, k] / block[k, k]
                    for j in range(k, n + 1):
                        block[i, j] -= share * block[k, j]
        changed = 0.0
        for i in range(n):
            slider, more = sliders[indices[i, lay.OF_SLIDER]], block[i, n] / block[i, i]
            contacts[i, lay.FRICTION] += more
            slider[lay.GAINED] += dt * slider[lay.INVERSE_MASS] * more
            respond(i, 0, more, shapes, response)
            changed = max(changed, abs(more))
        if changed == 0.0 or changed <= 1e-13 * abs(contacts[0, lay.FRICTION]):
            break
    for i in range(n):
        slider, touch = sliders[indices[i, lay.OF_SLIDER]], contacts[i]
        touch[lay.SLIP] = slider[lay.V] + 0.5 * slider[lay.GAINED] - touch[lay.MEAN] - product(i, 0, shapes, response)
    return changed


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
