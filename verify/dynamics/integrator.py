"""The compiled loop: steps of beam, sliders and feet, energy sums, events and samples."""

import numpy as np

from verify.arrays import Array, Indices
from verify.dynamics import layout as lay
from verify.dynamics.contact_solver import apply_forces, solve
from verify.dynamics.friction import tanh_change
from verify.dynamics.kinematics import (
    END,
    HALF,
    MIDDLE,
    RATE,
    START,
    VALUE,
    evaluate_surface,
    filter_rates,
    find_pieces,
    rotate_half,
    set_factors,
    set_mean_rates,
    set_shapes,
    shift_factors,
)
from verify.dynamics.point_forces import TRANSVERSE, product, set_end_couplings
from verify.jit import FAST, inline, jit

POWERS = (1.0 / 6.0, 4.0 / 6.0, 3.0 / 6.0, -2.0 / 6.0)
"""Simpson's weights of powers at the start, in mid-step, at the end with the step's contact forces and without: half of
what contact adds by the end is added in mid-step."""


@inline(fastmath=FAST)
def add_powers(
    when: int, weight: float, time: float, drive: Array, factors: Array, forced: Array, loads: Array, growth: Array,
    balance: Array,
) -> None:  # fmt: skip
    """Add the drive's power and the loss of all coordinates, with a weight in seconds, to the balance.

    `forced` are the coordinates over the drive's factors (n, drive columns), added to those of the rows themselves, or
    with circuits over the factors of all columns (coordinates, columns). `loads` (4, coordinates) are the generalised
    force phasors, real and imaginary, the damping, and 1 of a circuit; `growth` is the envelope of the forces.
    """
    angle, part, grown = drive[lay.OMEGA] * (drive[lay.ORIGIN] + time), time / drive[lay.UNIT], 0.0
    c, s, first = np.cos(angle), np.sin(angle), factors.shape[2] - forced.shape[1]
    for d in range(len(growth) - 1, -1, -1):
        grown = grown * part + growth[d]
    driven, lost, resisted = 0.0, 0.0, 0.0
    for j in range(forced.shape[0]):
        rate = factors[when, RATE, j] if first > 0 else 0.0
        for d in range(forced.shape[1]):
            rate += forced[j, d] * factors[when, RATE, first + d]
        driven += grown * (loads[0, j] * c - loads[1, j] * s) * rate
        lost += loads[2, j] * rate * rate
        resisted += loads[3, j] * loads[2, j] * rate * rate
    balance[lay.DRIVEN] += weight * driven
    balance[lay.LOST] += weight * lost
    balance[lay.RESISTED] += weight * resisted


@jit(no_cpython_wrapper=True)
def update_bodies(
    dt: float, codes: Indices, sliders: Array, feet: Array, points: Array, contacts: Array, indices: Indices,
    spans: Array,
) -> None:  # fmt: skip
    """Sliders and feet to the end of the step; a slider with one rigid point follows its law within the step."""
    spring, bilateral = codes[lay.LAW] == lay.SPRING, codes[lay.LAW] == lay.BILATERAL
    for i in range(0 if spring else points.shape[0]):
        slider, touch, inertia = sliders[indices[i, lay.OF_SLIDER]], contacts[i], points[i, lay.INERTIA]
        force, mobility, v, own = (
            touch[lay.FRICTION],
            dt * slider[lay.INVERSE_MASS],
            slider[lay.V],
            touch[lay.SELF_RESPONSE],
        )
        gained, mean = slider[lay.DELTA_V] - mobility * force, v + 0.5 * slider[lay.DELTA_V]
        surface, compliance, steepness = touch[lay.SURFACE], mobility + 2.0 * own, slider[lay.STEEPNESS]
        bounded = codes[lay.TWO_WAY] > 0 and abs(touch[lay.SLIP]) <= 1e-13 * (abs(mean) + abs(surface))
        if mobility == 0.0 or force == 0.0 or bounded:
            pass
        elif steepness > 0.0:  # Simpson's rule, with the law at half a step
            others = surface - touch[lay.MEAN] + own * force
            rise = touch[lay.END] + 2.0 * others - touch[lay.START]
            start, a = v - touch[lay.MEAN] - others + 0.5 * rise, 0.5 * (rise - gained)
            most = slider[lay.MU] * max(touch[lay.NORMAL], 0.0)
            half = tanh_change(start, a, 0.5 * compliance * most, steepness) * mobility / compliance
            mean = v + (4.0 * half + mobility * force) / 6.0 + 0.5 * gained
        else:
            mean = surface + spans[i, 1]
        slider[lay.X] += dt * (mean * slider[lay.FREE] + slider[lay.DRIFT])
        if bilateral and inertia > 0.0:
            touch[lay.POINT_VZ] += dt * (touch[lay.NORMAL] - points[i, lay.LOAD]) / inertia
    for b in range(sliders.shape[0]):
        slider = sliders[b]
        slider[lay.V] += slider[lay.DELTA_V]
        slider[lay.X] += 0.5 * dt * slider[lay.V] * slider[lay.FREE] if spring else 0.0
    for k in range(feet.shape[0]):
        foot = feet[k]
        foot[lay.VELOCITY_Z] += foot[lay.DELTA_VZ]
        foot[lay.PITCH_RATE] += foot[lay.DELTA_PITCH_RATE]
        foot[lay.HEIGHT] += 0.5 * dt * foot[lay.VELOCITY_Z]
        foot[lay.PITCH] += 0.5 * dt * foot[lay.PITCH_RATE]
    for i in range(points.shape[0]):
        spring_rate, touch, slider = points[i, lay.TANGENTIAL], contacts[i], sliders[indices[i, lay.OF_SLIDER]]
        if spring_rate > 0.0:  # stretched to the end of the step, as far as friction lets it
            depth, was, normal = touch[lay.DEPTH], touch[lay.WAS_DEPTH], touch[lay.NORMAL]
            steepness = slider[lay.STEEPNESS]
            since = dt if was > 0.0 or depth <= 0.0 else dt * depth / (depth - was) + 0.5 * dt
            top, slip = 0.0, -touch[lay.SLIP]
            if normal > 0.0:
                push = normal + 0.5 * dt * points[i, lay.STIFF] * touch[lay.CLOSING]
                top = slider[lay.MU_STATIC if touch[lay.STUCK] > 0.0 else lay.MU] * max(push, 0.0) / spring_rate
                share = touch[lay.FRICTION] / (slider[lay.MU] * normal + 1e-300)
                if steepness > 0.0 and abs(share) < 1.0:
                    slip -= np.arctanh(share) / steepness
            touch[lay.STRETCH] = min(max(touch[lay.STRETCH] + since * slip, -top), top)


@jit(no_cpython_wrapper=True)
def add_sums(
    dt: float, codes: Indices, sliders: Array, feet: Array, points: Array, contacts: Array, indices: Indices,
    feet_of: Indices, shapes: Array, response: Array, spans: Array, sums: Array, balance: Array,
) -> None:  # fmt: skip
    """Works, losses and integrals of the step; sliders and feet are still at its start."""
    spring, two_way = codes[lay.LAW] == lay.SPRING, codes[lay.TWO_WAY] > 0
    for b in range(sliders.shape[0]):
        slider, add, total, normal, surface, touching, sticking, n = sliders[b], sums[b], 0.0, 0.0, 0.0, 0, 0, 0
        mean, prescribed = slider[lay.V] + 0.5 * slider[lay.DELTA_V], slider[lay.INVERSE_MASS] == 0.0
        for i in range(points.shape[0]):
            if indices[i, lay.OF_SLIDER] != b:
                continue
            point, touch, ramp = points[i], contacts[i], 0.0
            force, push, face, lift = touch[lay.FRICTION], touch[lay.NORMAL], point[lay.FACE], touch[lay.LIFT]
            n += 1
            if spring:
                if touch[lay.DEPTH] <= 0.0:
                    continue
                ramp = touch[lay.RAMP]
            else:
                fall, inertia = (touch[lay.POINT_VZ] - touch[lay.CLOSING]) / dt, point[lay.INERTIA]
                if codes[lay.LAW] == lay.BILATERAL and inertia > 0.0:
                    fall = (point[lay.LOAD] - push) / inertia
                    add[lay.LOAD_WORK] -= dt * point[lay.LOAD] * (touch[lay.POINT_VZ] - 0.5 * dt * fall)
                    add[lay.SLOPE_WORK] += dt * push * touch[lay.SLOPE] * mean * slider[lay.FREE]
                add[lay.MAX_FALL] = max(add[lay.MAX_FALL], fall)
            if codes[lay.NORMAL_TWO_WAY] > 0:
                answer = product(i, TRANSVERSE, shapes, response)
                lift += face * answer
                if spring:
                    touch[lay.CLOSING] += answer
                    touch[lay.LIFT] = lift
            total, normal = total + force, normal + push
            if push > 0.0 or not spring:
                surface, touching = surface + touch[lay.SURFACE], touching + 1
            sticking += 1 if touch[lay.STUCK] > 0.0 else 0
            loss = dt * (spans[i, 1] if spring and not two_way else -force * touch[lay.SLIP])
            add[lay.FRICTION_LOSS] += loss
            add[lay.TANGENTIAL_WORK] += loss + dt * force * mean
            if loss < 0.0 and point[lay.TANGENTIAL] == 0.0:
                balance[lay.CREATED] -= loss
            if two_way:
                add[lay.FRICTION_ON_BEAM] -= dt * point[lay.WEIGHT] * force * touch[lay.SURFACE]
            if codes[lay.NORMAL_TWO_WAY] > 0 or spring:
                across = dt * push * face * (lift - ramp)
                add[lay.NORMAL_WORK] += across
                add[lay.NORMAL_ON_BEAM] -= point[lay.WEIGHT] * across
            if spring:
                foot = feet[indices[i, lay.OF_FOOT]]
                closing = touch[lay.CLOSING] - 0.5 * face * (
                    foot[lay.DELTA_VZ] + point[lay.ARM] * foot[lay.DELTA_PITCH_RATE]
                )
                add[lay.SLOPE_WORK] += dt * push * face * ramp
                add[lay.CONTACT_LOSS] += dt * (push - point[lay.STIFF] * touch[lay.DEPTH]) * closing
        if not prescribed:
            add[lay.SLOPE_WORK] += dt * mean * slider[lay.TILT] / slider[lay.INVERSE_MASS]
        add[lay.EXTERNAL_WORK] += dt * mean * (-total if prescribed else slider[lay.EXTERNAL_FORCE])
        add[lay.FRICTION_TIME] += dt * total
        add[lay.NORMAL_TIME] += dt * normal
        add[lay.TOUCH_TIME] += dt * touching / n
        add[lay.STICK_TIME] += dt * sticking / n
        add[lay.SURFACE_TIME] += dt * surface / max(touching, 1)
        add[lay.MAX_FRICTION] = max(add[lay.MAX_FRICTION], abs(total))
    for k in range(feet.shape[0]):
        foot = feet[k]
        force = foot[lay.FOOT_LOAD] - foot[lay.SPRING_RATE] * foot[lay.HEIGHT]
        sums[feet_of[k], lay.LOAD_WORK] += dt * force * (foot[lay.VELOCITY_Z] + 0.5 * foot[lay.DELTA_VZ])


@jit(no_cpython_wrapper=True)
def write_events(
    time: float, dt: float, codes: Indices, sliders: Array, points: Array, contacts: Array, indices: Indices,
    spans: Array, events: Array, tally: Indices,
) -> None:  # fmt: skip
    """Events of the step that begins at `time`; all are counted, as many recorded as fit."""
    spring = codes[lay.LAW] == lay.SPRING
    for i in range(points.shape[0]):
        touch, n, kind, share = contacts[i], 1 if spring else int(spans[i, 3]), 0.0, 0.0
        if spring:
            depth, was, stuck = touch[lay.DEPTH], touch[lay.WAS_DEPTH], touch[lay.STUCK] > 0.0
            if (depth > 0.0) != (was > 0.0):
                kind, share = lay.LANDS if depth > 0.0 else lay.LEAVES, 0.5 - depth / (depth - was)
            elif depth > 0.0 and stuck != (touch[lay.WAS_STUCK] > 0.0):
                kind = lay.STICKS if stuck else lay.SLIPS
        for e in range(n):
            if not spring:
                share, kind = spans[i, 4 + 2 * e], spans[i, 5 + 2 * e]
            if kind in (0.0, lay.TURNS):
                continue
            row = tally[lay.EVENTS]
            if row < events.shape[0]:
                event = events[row]
                event[0], event[1], event[2] = time + share * dt, kind, i
                event[3] = sliders[indices[i, lay.OF_SLIDER], lay.X]
            tally[lay.EVENTS] += 1


@jit(no_cpython_wrapper=True)
def sample(
    span: float, codes: Indices, sliders: Array, feet: Array, points: Array, contacts: Array, indices: Indices,
    factors: Array, places: Array, samples: Array, heights: Array, pressures: Array, deflections: Array, sums: Array,
    before: Array, tally: Indices,
) -> None:  # fmt: skip
    """Record the state at the end of a step, and means over the interval of that many seconds."""
    row, spring = tally[lay.SAMPLES], codes[lay.LAW] == lay.SPRING
    for b in range(sliders.shape[0]):
        slider, sample, done, last, speed, n = sliders[b], samples[row, b], sums[b], before[b], 0.0, 0
        v, mu, steepness = slider[lay.V], slider[lay.MU], slider[lay.STEEPNESS]
        sample[lay.OUT_X], sample[lay.OUT_V] = slider[lay.X], v
        for s in range(4):  # friction, normal force and the shares of points, in one order in both
            sample[lay.OUT_FRICTION + s] = (done[lay.FRICTION_TIME + s] - last[lay.FRICTION_TIME + s]) / span
        sample[lay.OUT_LOSS] = done[lay.FRICTION_LOSS] - last[lay.FRICTION_LOSS]
        sample[lay.OUT_ALONG] = done[lay.TANGENTIAL_WORK] - last[lay.TANGENTIAL_WORK]
        for s in range(done.size):
            last[s] = done[s]
        for i in range(points.shape[0]):
            touch = contacts[i]
            if indices[i, lay.OF_SLIDER] != b:
                continue
            normal, surface, force = touch[lay.NORMAL], touch[lay.SURFACE], touch[lay.FRICTION]
            pressures[row, i] = normal
            if not spring:
                surface = touch[lay.START]
                if touch[lay.STUCK] == 0.0:
                    law = np.tanh(steepness * (v - surface)) if steepness > 0.0 else np.sign(v - surface)
                    force = -mu * max(normal, 0.0) * law
                sample[lay.OUT_FRICTION], sample[lay.OUT_NORMAL] = force, normal
            if normal > 0.0 or not spring:
                speed, n = speed + surface, n + 1
        sample[lay.OUT_SURFACE] = speed / n if n > 0 else np.nan
    for k in range(feet.shape[0]):
        heights[row, k, 0], heights[row, k, 1] = feet[k, lay.HEIGHT], feet[k, lay.PITCH]
    for p in range(places.shape[0]):
        total = 0.0
        for j in range(places.shape[1]):
            total += places[p, j] * factors[START, VALUE, j]
        deflections[row, p] = total
    tally[lay.SAMPLES] += 1


@jit
def advance(
    n_steps: int, every: int, dt: float, gravity: float, codes: Indices, drive: Array, rows: Array, table: Array,
    edges: Array, sliders: Array, feet: Array, points: Array, contacts: Array, indices: Indices, feet_of: Indices,
    factors: Array, local: Array, stamp: Indices, shapes: Array, response: Array, couplings: Array, spans: Array,
    block: Array, forced: Array, loads: Array, growth: Array, places: Array, samples: Array, heights: Array,
    pressures: Array, deflections: Array, events: Array, tally: Indices, sums: Array, before: Array, balance: Array,
) -> int:  # fmt: skip
    """Advance beam and sliders by up to n_steps from step tally[STEP]; why it returns.

    Time is the number of the step times dt. All arrays are advanced in place, together, so that they agree whenever the
    caller is interrupted. `feet_of` (feet,) is the slider of every foot, `places` (p, columns) the columns at the
    positions of the deflection.
    """
    spring, two_way, n_complex = codes[lay.LAW] == lay.SPRING, codes[lay.TWO_WAY] > 0, codes[lay.COMPLEX]
    accounts = codes[lay.ACCOUNTS] > 0
    last = factors.shape[0] - 1  # END, as a number of the run: numba compiles a function again for every constant
    set_factors(last, tally[lay.STEP] * dt, n_complex, rows, drive, factors)
    shift_factors(factors)
    for _ in range(n_steps if n_steps > 0 else 1):
        step = tally[lay.STEP]
        time, mark = step * dt, 4 * step
        if not find_pieces(0.5 * dt if spring and n_steps > 0 else 0.0, edges, sliders, points, indices):
            return lay.OFF_PIECES
        for when in range(0, last + 1 if n_steps > 0 else 0):
            if when == MIDDLE:
                continue
            if when > START:
                rotate_half(rows)
                set_factors(when, time + (0.5 * dt if when == HALF else dt), n_complex, rows, drive, factors)
            if accounts:
                add_powers(when, dt * POWERS[when], time + 0.5 * dt * min(when, 2), drive, factors, forced, loads,
                           growth, balance)  # fmt: skip
        if two_way:
            filter_rates(dt, n_complex, rows, factors)
        set_mean_rates(dt, spring, factors)
        for b in range(sliders.shape[0] if spring and n_steps > 0 else 0):
            sliders[b, lay.X] += 0.5 * dt * sliders[b, lay.V] * sliders[b, lay.FREE]
        for k in range(feet.shape[0] if n_steps > 0 else 0):
            feet[k, lay.HEIGHT] += 0.5 * dt * feet[k, lay.VELOCITY_Z]
            feet[k, lay.PITCH] += 0.5 * dt * feet[k, lay.PITCH_RATE]
        for when in range(last + 1):
            if when == HALF or (spring and when != MIDDLE and n_steps > 0) or (n_steps == 0 and when != START):
                continue
            ready = mark + 4 if when == END and not two_way else mark + when  # the start of the next step as well
            evaluate_surface(
                when,
                ready,
                dt,
                gravity,
                codes,
                table,
                edges,
                factors,
                local,
                stamp,
                sliders,
                feet,
                points,
                contacts,
                indices,
            )
        if n_steps == 0:
            return lay.DONE
        if two_way:
            set_shapes(dt, rows, n_complex, table, edges, points, contacts, indices, shapes)
            if codes[lay.LAW] == lay.BILATERAL:
                set_end_couplings(rows, n_complex, table, edges, points, contacts, indices, shapes, couplings)
        solve(dt, codes, sliders, feet, points, contacts, indices, shapes, response, couplings, spans, block, balance)
        if two_way:
            apply_forces(codes, rows, points, contacts, shapes)
        add_sums(dt, codes, sliders, feet, points, contacts, indices, feet_of, shapes, response, spans, sums, balance)
        update_bodies(dt, codes, sliders, feet, points, contacts, indices, spans)
        write_events(drive[lay.ORIGIN] + time, dt, codes, sliders, points, contacts, indices, spans, events, tally)
        tally[lay.STEP] += 1
        if two_way or accounts:
            set_factors(last, time + dt, n_complex, rows, drive, factors)
        if accounts:
            add_powers(last, dt * POWERS[MIDDLE], time + dt, drive, factors, forced, loads, growth, balance)
        if two_way:
            filter_rates(dt, n_complex, rows, factors)
        shift_factors(factors)
        if not np.isfinite(sliders[0, lay.V] + factors[START, VALUE, 0]):
            return lay.NOT_FINITE
        if tally[lay.STEP] % every == 0:
            for when in range(0 if spring or not find_pieces(0.0, edges, sliders, points, indices) else 1):
                evaluate_surface(
                    when,
                    mark + 4,
                    dt,
                    gravity,
                    codes,
                    table,
                    edges,
                    factors,
                    local,
                    stamp,
                    sliders,
                    feet,
                    points,
                    contacts,
                    indices,
                )
            sample(every * dt, codes, sliders, feet, points, contacts, indices, factors, places, samples, heights,
                   pressures, deflections, sums, before, tally)  # fmt: skip
    return lay.DONE
