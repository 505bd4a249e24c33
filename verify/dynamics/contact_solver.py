"""Compiled contact forces of a step: normal laws, friction laws and the responses of beam, feet and sliders to them.

Forces are constant over the step. Points are swept one after the other (Gauss-Seidel), each law solved exactly with its
own response, the others' forces fixed. The Delassus operator is never formed: `response` holds what all forces add to
the mean rates of the columns, so that a visit costs two products over the columns.
"""

import numpy as np

from verify.arrays import Array, Indices
from verify.dynamics import layout as lay
from verify.dynamics.friction import coulomb_force, elastic_force, held_force, line_force, tanh_force
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
            value, first, here, turn = 0.0, 0.0, 0.0, 0.0
            for d in range(table.shape[1] - 1, -1, -1):
                first = first * at + value
                value = value * at + table[piece, d, j]
                turn = turn * above + here
                here = here * above + table[piece, d, j]
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
    i: int, dt: float, codes: Indices, sliders: Array, feet: Array, points: Array, contacts: Array, indices: Indices,
    shapes: Array, response: Array, couplings: Array,
) -> float:  # fmt: skip
    """Normal force of point i, mean over the step, with its own response."""
    n = contacts[i, lay.NORMAL]
    if codes[lay.LAW] == lay.GIVEN:
        return float(points[i, lay.LOAD])
    if codes[lay.LAW] == lay.BILATERAL:  # momentum of the step: the point has the surface's speed at its end
        b, inertia = indices[i, lay.OF_SLIDER], points[i, lay.INERTIA] / dt
        speed = sliders[b, lay.V] + sliders[b, lay.GAINED] - contacts[i, lay.SPEED_END]
        climb, own = contacts[i, lay.CLOSING] + contacts[i, lay.RAMP] * speed, 0.0
        if codes[lay.PRESSES] > 0:
            own = couplings[1, i, i]
            for k in range(points.shape[0]):
                climb -= couplings[0, i, k] * contacts[k, lay.FRICTION] + couplings[1, i, k] * contacts[k, lay.NORMAL]
        return float(
            (points[i, lay.LOAD] + inertia * (climb + own * n - contacts[i, lay.RISE_RATE])) / (1.0 + inertia * own)
        )
    depth, was, k = contacts[i, lay.DEPTH], contacts[i, lay.WAS_DEPTH], indices[i, lay.OF_FOOT]
    if depth <= 0.0:
        return 0.0
    force, dashpot = points[i, lay.STIFF] * depth, points[i, lay.DASHPOT]
    if dashpot > 0.0:  # it acts from the landing on, on the mean speed of the step
        dashpot *= 0.5 + depth / (depth - was) if was <= 0.0 else 1.0
        arm, closing = points[i, lay.ARM], contacts[i, lay.CLOSING]
        own = 0.5 * dt * (feet[k, lay.INVERSE_FOOT_MASS] + arm * arm * feet[k, lay.INVERSE_INERTIA])
        closing -= 0.5 * points[i, lay.FACE] * (feet[k, lay.LIFTED] + arm * feet[k, lay.TURNED])
        if codes[lay.PRESSES] > 0:
            closing += product(i, TRANSVERSE, shapes, response)
            own += own_product(i, TRANSVERSE, shapes)
        force = (force + dashpot * (closing + own * n)) / (1.0 + dashpot * own)
    return float(max(force, 0.0))


@inline
def friction_force(
    i: int, dt: float, codes: Indices, sliders: Array, points: Array, contacts: Array, indices: Indices, shapes: Array,
    response: Array, spans: Array,
) -> float:  # fmt: skip
    """Friction of point i on its slider, mean over the step, with its own response."""
    b, force = indices[i, lay.OF_SLIDER], contacts[i, lay.FRICTION]
    normal = max(contacts[i, lay.NORMAL], 0.0)
    kinetic, static = sliders[b, lay.MU] * normal, sliders[b, lay.MU_STATIC] * normal
    light, v, steepness = dt * sliders[b, lay.INVERSE_MASS], sliders[b, lay.V], sliders[b, lay.STEEPNESS]
    own, others = 0.0, 0.0
    if codes[lay.TWO_WAY] > 0:
        own = contacts[i, lay.OWN]
        others = product(i, 0, shapes, response) + own * force
    ease, gained = light + 2.0 * own, sliders[b, lay.GAINED] - light * force
    mean = contacts[i, lay.MEAN] + others
    slip = v + 0.5 * gained - mean  # mean over the step without this force
    stuck = contacts[i, lay.WAS_STUCK] > 0.0
    spans[i, 0], spans[i, 3] = 0.0, 0.0
    if points[i, lay.TANGENTIAL] > 0.0:
        stiff, depth, was = points[i, lay.TANGENTIAL], contacts[i, lay.DEPTH], contacts[i, lay.WAS_DEPTH]
        since = 0.5 * dt if was > 0.0 or depth <= 0.0 else dt * depth / (depth - was)
        full = 1.0 + 0.5 * stiff * since * ease
        trial = stiff * (contacts[i, lay.STRETCH] - since * slip) / full
        force, spans[i, 0] = elastic_force(
            trial, stiff * since / full, static if stuck else kinetic, kinetic, steepness
        )
    elif kinetic <= 0.0:
        force = 0.0
    else:
        if codes[lay.LAW] == lay.SPRING:
            rise = contacts[i, lay.RISE] + 2.0 * others
            start, a0, a1 = mean - 0.5 * rise, rise - gained, rise - gained
        else:  # a parabola of exact mean through the speeds at both ends
            start, end = contacts[i, lay.START], contacts[i, lay.END] + 2.0 * others
            rise = end - start
            a0 = 6.0 * mean - 4.0 * start - 2.0 * end - gained
            a1 = 4.0 * end + 2.0 * start - 6.0 * mean - gained
        if steepness > 0.0:
            force = tanh_force(v - mean + 0.5 * rise, rise - gained, ease, kinetic, steepness)
        elif contacts[i, lay.WAS_STUCK] == 1.0 and own > 0.0:
            # no mean slip, which alone would leave an alternating one: a share of no slip at the end damps it
            needed = (-2.0 * (1.0 - DAMPING) * slip + DAMPING * (start + rise - v - gained)) / ease
            force = held_force(i, needed, kinetic, static, contacts[i, lay.WAS_FRICTION], ease, spans)
        else:
            left = v - start if stuck else 0.0  # of the last step, taken off in this one
            force = coulomb_force(i, v - start, a0 - left, a1 - left, ease, kinetic, static, stuck, spans)
    if own > 0.0 and points[i, lay.TANGENTIAL] == 0.0:
        # A force that is constant over the step dissipates where it lies between none and the one without mean slip.
        # Beyond, as in the step of a slip reversal, it returns at most what friction has dissipated before.
        bound = -slip / ease
        wide = np.sqrt(bound * bound + 2.0 * max(contacts[i, lay.LOSS], 0.0) / (dt * ease))
        force = min(max(force, bound - wide), bound + wide)
    contacts[i, lay.SLIP] = slip + 0.5 * ease * force
    return float(force)


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
    light, v, steepness, pulled = (
        dt * slider[lay.INVERSE_MASS],
        slider[lay.V],
        slider[lay.STEEPNESS],
        slider[lay.GAINED],
    )
    most, gained, rest, resting = 0.0, pulled, 0.0, False
    for i in range(first, last + 1):
        touch, work = contacts[i], spans[i]
        most += touch[lay.NORMAL] * slider[lay.MU_STATIC]
        gained += light * touch[lay.WAS_FRICTION]
        work[START] = v - touch[lay.MEAN] + 0.5 * touch[lay.RISE]
        still = abs(work[START]) <= 1e-13 * light * slider[lay.MU] * touch[lay.NORMAL]
        if (touch[lay.WAS_STUCK] > 0.0 or still) and touch[lay.NORMAL] > 0.0:
            rest, resting = touch[lay.RISE] - work[START], True
    low, high = pulled - 1.001 * light * most, pulled + 1.001 * light * most
    gained = min(max(rest if resting else gained, low), high)  # between the limits of friction a point at rest stays
    late = max(1.0 - 2.0 / (light * most * steepness + 1e-300), 0.0)
    least, top, miss, exact = 0.0, 0.0, 0.0, steepness > 0.0 and first == last and points[last, lay.TANGENTIAL] == 0.0
    if exact:
        kinetic, rise, late = slider[lay.MU] * contacts[last, lay.NORMAL], contacts[last, lay.RISE], 0.0
        least = tanh_force(spans[last, START], rise - pulled, light, kinetic, steepness)
        spans[last, 0], spans[last, LEAST], spans[last, MOST], gained = 0.0, least, least, pulled + light * least
    for _ in range(0 if exact else SWEEPS):
        least, top, slope = 0.0, 0.0, 0.0
        for i in range(first, last + 1):
            touch, work, stiff = contacts[i], spans[i], points[i, lay.TANGENTIAL]
            kinetic, static = slider[lay.MU] * touch[lay.NORMAL], slider[lay.MU_STATIC] * touch[lay.NORMAL]
            stuck, start, rise, work[STOP] = touch[lay.WAS_STUCK] > 0.0, work[START], touch[lay.RISE], gained
            if stiff > 0.0:
                depth, was = touch[lay.DEPTH], touch[lay.WAS_DEPTH]
                since = 0.5 * dt if was > 0.0 or depth <= 0.0 else dt * depth / (depth - was)
                trial = stiff * (touch[lay.STRETCH] - since * (v + 0.5 * gained - touch[lay.MEAN]))
                force, soft = elastic_force(trial, stiff * since, static if stuck else kinetic, kinetic, steepness)
                work[0], work[LEAST], work[MOST] = soft, force, force
                if steepness > 0.0:
                    soft = steepness * (kinetic - force * force / (kinetic + 1e-300))
                    soft /= soft + stiff * since
                slope -= 0.5 * stiff * since * soft
            else:
                rounding, end = 1e-13 * (abs(v) + abs(start) + abs(rise) + light * kinetic), start + gained - rise
                work[LEAST], work[MOST], fall = line_force(
                    start, end, light, kinetic, static, steepness, late, stuck, rounding
                )
                slope += fall
                work[0] = 0.0
                if work[LEAST] < work[MOST]:
                    work[0] = 1.0 if stuck or abs(start) <= rounding else 0.5
                elif steepness == 0.0 and abs(start) < light * (static + kinetic) and abs(end) > rounding:
                    work[STOP] = rise - start
            least, top = least + work[LEAST], top + work[MOST]
        miss = gained - pulled - light * top
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
        if abs(miss) <= 1e-14 * light * most or (after - gained) * (after - low) * (after - high) == 0.0:
            break
        gained = after
    share, total = 0.5, 0.0
    if light > 0.0 and top > least:
        share = min(max(((gained - pulled) / light - least) / (top - least), 0.0), 1.0)
    for i in range(first, last + 1):
        contacts[i, lay.FRICTION] = spans[i, LEAST] + share * (spans[i, MOST] - spans[i, LEAST])
        total += contacts[i, lay.FRICTION]
    slider[lay.GAINED] = pulled + light * total
    for i in range(first, last + 1):
        touch, work, force = contacts[i], spans[i], contacts[i, lay.FRICTION]
        kinetic, start, slip = (
            slider[lay.MU] * touch[lay.NORMAL],
            work[START],
            v + 0.5 * slider[lay.GAINED] - touch[lay.MEAN],
        )
        end, touch[lay.SLIP], work[1] = start + gained - touch[lay.RISE], slip, -force * slip
        if points[i, lay.TANGENTIAL] == 0.0 and steepness > 0.0:
            work[1] += late * kinetic * np.tanh(steepness * end) * (end - slip)
        elif points[i, lay.TANGENTIAL] == 0.0 and (
            start * end <= 0.0 or work[0] > 0.0
        ):  # before and after the reversal
            side = -1.0 if start < 0.0 else 1.0
            before = abs(start) / (max(light * (kinetic + side * force), 0.0) + abs(start - end) + 1e-300)
            work[1] = 0.5 * kinetic * (abs(start) * before + abs(end) * (1.0 - before))
    return abs(gained - slider[lay.GAINED]) / light if light > 0.0 else 0.0


@jit(no_cpython_wrapper=True)
def solve(
    dt: float, codes: Indices, sliders: Array, feet: Array, points: Array, contacts: Array, indices: Indices,
    shapes: Array, response: Array, couplings: Array, spans: Array, block: Array, balance: Array,
) -> None:  # fmt: skip
    """Contact forces of the step into `contacts`, and what they add to sliders, feet and the columns (`response`).

    `block` (points, points + 1) is working space.
    """
    law, two_way, presses = codes[lay.LAW], codes[lay.TWO_WAY] > 0, codes[lay.PRESSES] > 0
    for b in range(sliders.shape[0]):
        sliders[b, lay.GAINED] = dt * (sliders[b, lay.INVERSE_MASS] * sliders[b, lay.PULL] + sliders[b, lay.TILT])
    for k in range(feet.shape[0]):
        press = feet[k, lay.PRESS] - feet[k, lay.SPRING_RATE] * feet[k, lay.HEIGHT]
        feet[k, lay.LIFTED], feet[k, lay.TURNED] = dt * feet[k, lay.INVERSE_FOOT_MASS] * press, 0.0
    for j in range(len(response)):
        response[j] = 0.0
    alone, coupled, largest = law == lay.SPRING and not two_way, law == lay.BILATERAL, 0.0
    for i in range(points.shape[0]):
        contacts[i, lay.WAS_FRICTION] = contacts[i, lay.FRICTION]
        contacts[i, lay.NORMAL], contacts[i, lay.FRICTION], contacts[i, lay.SLIP] = 0.0, 0.0, 0.0
        contacts[i, lay.WAS_STUCK], contacts[i, lay.STUCK] = contacts[i, lay.STUCK], 0.0
        contacts[i, lay.OWN] = own_product(i, 0, shapes) if two_way else 0.0
        coupled = coupled or (points.shape[0] > 1 and two_way) or points[i, lay.DASHPOT] > 0.0
    sweeps, changed = 0, 0.0
    while sweeps < SWEEPS:
        changed = 0.0
        sweeps += 1
        for i in range(points.shape[0]):
            if law == lay.SPRING and contacts[i, lay.DEPTH] <= 0.0:
                continue
            b, k = indices[i, lay.OF_SLIDER], indices[i, lay.OF_FOOT]
            if sweeps == 1 or law == lay.BILATERAL or points[i, lay.DASHPOT] > 0.0:
                normal = normal_force(
                    i, dt, codes, sliders, feet, points, contacts, indices, shapes, response, couplings
                )
                more = normal - contacts[i, lay.NORMAL]
                contacts[i, lay.NORMAL] = normal
                if presses and more != 0.0:
                    respond(i, TRANSVERSE, more, shapes, response)
                if law == lay.SPRING:
                    push = dt * points[i, lay.FACE] * more
                    feet[k, lay.LIFTED] += push * feet[k, lay.INVERSE_FOOT_MASS]
                    feet[k, lay.TURNED] += push * points[i, lay.ARM] * feet[k, lay.INVERSE_INERTIA]
                changed, largest = max(changed, abs(more)), max(largest, normal)
            if alone:  # normal forces do not depend on friction
                continue
            force = friction_force(i, dt, codes, sliders, points, contacts, indices, shapes, response, spans)
            more = force - contacts[i, lay.FRICTION]
            if more != 0.0:
                contacts[i, lay.FRICTION] = force
                sliders[b, lay.GAINED] += dt * sliders[b, lay.INVERSE_MASS] * more
                if two_way:
                    respond(i, 0, more, shapes, response)
                changed = max(changed, abs(more))
        if changed <= TOLERANCE * largest or not coupled:
            changed = 0.0
            break
    balance[lay.SWEEPS] += sweeps
    for i in range(points.shape[0] if alone else 0):
        if i + 1 == points.shape[0] or indices[i + 1, lay.OF_SLIDER] != indices[i, lay.OF_SLIDER]:
            changed = max(changed, slide(i, dt, sliders, points, contacts, indices, spans))
    if changed > TOLERANCE * largest and two_way:
        changed = solve_block(dt, sliders, points, contacts, indices, shapes, response, spans, block)
        balance[lay.BLOCKS] += 1.0
    balance[lay.UNCONVERGED] += 1.0 if changed > 1e-9 * largest else 0.0
    balance[lay.RESIDUAL] = max(balance[lay.RESIDUAL], changed)
    for i in range(points.shape[0]):
        contacts[i, lay.STUCK] = spans[i, 0] if contacts[i, lay.NORMAL] > 0.0 else 0.0
        if two_way:
            contacts[i, lay.SURFACE] = contacts[i, lay.MEAN] + product(i, 0, shapes, response)
        else:
            contacts[i, lay.SURFACE] = contacts[i, lay.MEAN]
        if points[i, lay.TANGENTIAL] == 0.0:
            contacts[i, lay.LOSS] -= dt * contacts[i, lay.FRICTION] * contacts[i, lay.SLIP]
        contacts[i, lay.BEFORE] = 2.0 * contacts[i, lay.SURFACE] - contacts[i, lay.MEAN]


@inline
def solve_block(
    dt: float, sliders: Array, points: Array, contacts: Array, indices: Indices, shapes: Array, response: Array,
    spans: Array, block: Array,
) -> float:  # fmt: skip
    """Friction of all rigid points together, which a beam responds to: Newton's method on active sets; last change."""
    n, changed = points.shape[0], 0.0
    for _ in range(4 * n + 20):
        for i in range(n):  # row i: what the law asks of all changes of force
            b, force = indices[i, lay.OF_SLIDER], contacts[i, lay.FRICTION]
            most = sliders[b, lay.MU] * max(contacts[i, lay.NORMAL], 0.0)
            slip = sliders[b, lay.V] + 0.5 * sliders[b, lay.GAINED] - contacts[i, lay.MEAN]
            slip -= product(i, 0, shapes, response)
            own = 0.5 * dt * sliders[b, lay.INVERSE_MASS] + contacts[i, lay.OWN] + 1e-300
            diagonal, slope, miss = 0.0, 1.0, slip
            if points[i, lay.TANGENTIAL] > 0.0 or most == 0.0:
                diagonal, slope, miss = 1.0, 0.0, 0.0
            elif sliders[b, lay.STEEPNESS] > 0.0:
                t = np.tanh(sliders[b, lay.STEEPNESS] * slip)
                diagonal, slope, miss = 1.0, most * sliders[b, lay.STEEPNESS] * (1.0 - t * t), force + most * t
            elif abs(force - slip / own) >= most:  # slips
                diagonal, slope, miss = 1.0, 0.0, force - most * np.sign(force - slip / own)
            spans[i, 0] = 1.0 if diagonal == 0.0 else 0.0
            for k in range(n):
                block[i, k] = 0.0
                if slope != 0.0 and sliders[b, lay.INVERSE_MASS] > 0.0 and indices[k, lay.OF_SLIDER] == b:
                    block[i, k] = 0.5 * slope * dt * sliders[b, lay.INVERSE_MASS]
                for j in range(shapes.shape[2] if slope != 0.0 else 0):
                    block[i, k] += slope * shapes[0, i, j] * shapes[2, k, j]
            block[i, i] = (block[i, i] + diagonal) * (1.0 + 1e-10)  # points that share one slider alone
            block[i, n] = -miss
        for k in range(n):
            for i in range(n):
                if i != k:
                    share = block[i, k] / block[k, k]
                    for j in range(k, n + 1):
                        block[i, j] -= share * block[k, j]
        changed = 0.0
        for i in range(n):
            b, more = indices[i, lay.OF_SLIDER], block[i, n] / block[i, i]
            contacts[i, lay.FRICTION] += more
            sliders[b, lay.GAINED] += dt * sliders[b, lay.INVERSE_MASS] * more
            respond(i, 0, more, shapes, response)
            changed = max(changed, abs(more))
        if changed == 0.0 or changed <= 1e-13 * abs(contacts[0, lay.FRICTION]):
            break
    for i in range(n):
        b = indices[i, lay.OF_SLIDER]
        contacts[i, lay.SLIP] = sliders[b, lay.V] + 0.5 * sliders[b, lay.GAINED] - contacts[i, lay.MEAN]
        contacts[i, lay.SLIP] -= product(i, 0, shapes, response)
    return changed


@inline(fastmath=FAST)
def apply_forces(codes: Indices, rows: Array, points: Array, contacts: Array, shapes: Array) -> None:
    """Forces that are constant over the step, to the rows at its end: exact."""
    n, n_complex = rows.shape[1], codes[lay.COMPLEX]
    for j in range(n):
        real, imaginary = 0.0, 0.0
        for i in range(points.shape[0]):
            along, across = points[i, lay.WEIGHT] * contacts[i, lay.FRICTION], 0.0
            if codes[lay.PRESSES] > 0:
                across = points[i, lay.WEIGHT] * contacts[i, lay.NORMAL]
            real -= along * shapes[0, i, j] + across * shapes[1, i, j]
            if j >= n - n_complex:
                imaginary -= along * shapes[0, i, j + n_complex] + across * shapes[1, i, j + n_complex]
        rows[lay.Z_RE, j] += rows[lay.GAIN_RE, j] * real - rows[lay.GAIN_IM, j] * imaginary
        rows[lay.Z_IM, j] += rows[lay.GAIN_RE, j] * imaginary + rows[lay.GAIN_IM, j] * real
