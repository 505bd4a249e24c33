"""The compiled loop: steps of beam, sliders and feet, energy sums, events and samples."""

import numpy as np

from verify.arrays import Array, Indices
from verify.dynamics import layout as lay
from verify.dynamics.contact_solver import TRANSVERSE, apply_forces, product, set_end_couplings, solve
from verify.dynamics.friction import tanh_change
from verify.dynamics.kinematics import (
    END,
    HALF,
    MIDDLE,
    RATE,
    START,
    VALUE,
    filter_rates,
    find_pieces,
    look,
    rotate_half,
    set_factors,
    set_mean_rates,
    set_shapes,
    shift_factors,
)
from verify.jit import FAST, inline, jit

POWERS = (1.0 / 6.0, 4.0 / 6.0, 3.0 / 6.0, -2.0 / 6.0)
"""Simpson's weights of powers at the start, in mid-step, at the end with the step's contact forces and without: half of
what contact adds by the end is added in mid-step."""


@inline(fastmath=FAST)
def add_powers(
    when: int, weight: float, time: float, drive: Array, rows: Array, factors: Array, forced: Array, loads: Array,
    growth: Array, balance: Array,
) -> None:  # fmt: skip
    """Add the drive's power and the modes' loss, with a weight in seconds, to the balance.

    `forced` (n, drive columns) are the forced parts of the rows over the drive's factors, `loads` (2, n) the
    generalised force phasors, `growth` their envelope.
    """
    angle, part, grown = drive[lay.OMEGA] * (drive[lay.ORIGIN] + time), time / drive[lay.UNIT], 0.0
    c, s, n, first = np.cos(angle), np.sin(angle), rows.shape[1], factors.shape[2] - forced.shape[1]
    for d in range(len(growth) - 1, -1, -1):
        grown = grown * part + growth[d]
    driven, lost = 0.0, 0.0
    for j in range(n):
        rate = factors[when, RATE, j]
        for d in range(forced.shape[1]):
            rate += forced[j, d] * factors[when, RATE, first + d]
        driven += grown * (loads[0, j] * c - loads[1, j] * s) * rate
        lost -= 2.0 * rows[lay.RATE_RE, j] * rate * rate
    balance[lay.DRIVEN] += weight * driven
    balance[lay.LOST] += weight * lost


@jit(no_cpython_wrapper=True)
def move(
    dt: float, codes: Indices, sliders: Array, feet: Array, points: Array, contacts: Array, indices: Indices,
    spans: Array,
) -> None:  # fmt: skip
    """Sliders and feet to the end of the step; a slider with one rigid point follows its law within the step."""
    spring = codes[lay.LAW] == lay.SPRING
    for i in range(0 if spring else points.shape[0]):
        b = indices[i, lay.OF_SLIDER]
        force, light, v = contacts[i, lay.FRICTION], dt * sliders[b, lay.INVERSE_MASS], sliders[b, lay.V]
        gained, mean = sliders[b, lay.GAINED] - light * force, v + 0.5 * sliders[b, lay.GAINED]
        if light > 0.0 and force != 0.0:
            ease = light + 2.0 * contacts[i, lay.OWN]
            bounded = abs(contacts[i, lay.SLIP]) <= 1e-13 * (abs(mean) + abs(contacts[i, lay.SURFACE]))
            if codes[lay.TWO_WAY] > 0 and bounded:
                pass
            elif sliders[b, lay.STEEPNESS] > 0.0:  # Simpson's rule, with the law at half a step
                others = contacts[i, lay.SURFACE] - contacts[i, lay.MEAN] + contacts[i, lay.OWN] * force
                rise = contacts[i, lay.END] + 2.0 * others - contacts[i, lay.START]
                start, a = v - contacts[i, lay.MEAN] - others + 0.5 * rise, 0.5 * (rise - gained)
                most = sliders[b, lay.MU] * max(contacts[i, lay.NORMAL], 0.0)
                half = tanh_change(start, a, 0.5 * ease * most, sliders[b, lay.STEEPNESS]) * light / ease
                mean = v + (4.0 * half + light * force) / 6.0 + 0.5 * gained
            else:
                mean = contacts[i, lay.SURFACE] + spans[i, 1]
        sliders[b, lay.X] += dt * (mean * sliders[b, lay.FREE] + sliders[b, lay.DRIFT])
        if codes[lay.LAW] == lay.BILATERAL and points[i, lay.INERTIA] > 0.0:
            contacts[i, lay.RISE_RATE] += dt * (contacts[i, lay.NORMAL] - points[i, lay.LOAD]) / points[i, lay.INERTIA]
    for b in range(sliders.shape[0]):
        sliders[b, lay.V] += sliders[b, lay.GAINED]
        if spring:
            sliders[b, lay.X] += 0.5 * dt * sliders[b, lay.V] * sliders[b, lay.FREE]
    for k in range(feet.shape[0]):
        feet[k, lay.CLIMB] += feet[k, lay.LIFTED]
        feet[k, lay.TURN] += feet[k, lay.TURNED]
        feet[k, lay.HEIGHT] += 0.5 * dt * feet[k, lay.CLIMB]
        feet[k, lay.PITCH] += 0.5 * dt * feet[k, lay.TURN]
    for i in range(points.shape[0]):
        if points[i, lay.TANGENTIAL] > 0.0:  # stretched to the end of the step, as far as friction lets it
            b, depth, was = indices[i, lay.OF_SLIDER], contacts[i, lay.DEPTH], contacts[i, lay.WAS_DEPTH]
            push = contacts[i, lay.NORMAL] + 0.5 * dt * points[i, lay.STIFF] * contacts[i, lay.CLOSING]
            since = dt if was > 0.0 or depth <= 0.0 else dt * depth / (depth - was) + 0.5 * dt
            top, slip = 0.0, -contacts[i, lay.SLIP]
            if contacts[i, lay.NORMAL] > 0.0:
                mu = sliders[b, lay.MU_STATIC if contacts[i, lay.STUCK] > 0.0 else lay.MU]
                top = mu * max(push, 0.0) / points[i, lay.TANGENTIAL]
                share = contacts[i, lay.FRICTION] / (sliders[b, lay.MU] * contacts[i, lay.NORMAL] + 1e-300)
                if sliders[b, lay.STEEPNESS] > 0.0 and abs(share) < 1.0:
                    slip -= np.arctanh(share) / sliders[b, lay.STEEPNESS]
            contacts[i, lay.STRETCH] = min(max(contacts[i, lay.STRETCH] + since * slip, -top), top)


@jit(no_cpython_wrapper=True)
def add_sums(
    dt: float, codes: Indices, sliders: Array, feet: Array, points: Array, contacts: Array, indices: Indices,
    feet_of: Indices, shapes: Array, response: Array, spans: Array, sums: Array, balance: Array,
) -> None:  # fmt: skip
    """Works, losses and integrals of the step; sliders and feet are still at its start."""
    spring = codes[lay.LAW] == lay.SPRING
    for b in range(sliders.shape[0]):
        total, touching, sticking, surface, n, normal = 0.0, 0, 0.0, 0.0, 0, 0.0
        mean = sliders[b, lay.V] + 0.5 * sliders[b, lay.GAINED]
        for i in range(points.shape[0]):
            if indices[i, lay.OF_SLIDER] != b:
                continue
            n += 1
            force, push = contacts[i, lay.FRICTION], contacts[i, lay.NORMAL]
            if not spring:
                fall = (contacts[i, lay.RISE_RATE] - contacts[i, lay.CLOSING]) / dt
                if codes[lay.LAW] == lay.BILATERAL and points[i, lay.INERTIA] > 0.0:
                    fall = (points[i, lay.LOAD] - push) / points[i, lay.INERTIA]
                    climb = contacts[i, lay.RISE_RATE] - 0.5 * dt * fall
                    sums[b, lay.PRESSED] -= dt * points[i, lay.LOAD] * climb
                    sums[b, lay.UPHILL] += dt * push * contacts[i, lay.SLOPE] * mean * sliders[b, lay.FREE]
                sums[b, lay.FALL] = max(sums[b, lay.FALL], fall)
            elif contacts[i, lay.DEPTH] <= 0.0:
                continue
            lift, face = contacts[i, lay.LIFT], points[i, lay.FACE]
            if codes[lay.PRESSES] > 0:
                answer = product(i, TRANSVERSE, shapes, response)
                lift += face * answer
                if spring:
                    contacts[i, lay.CLOSING] += answer
                    contacts[i, lay.LIFT] = lift
            touching += 1 if push > 0.0 or not spring else 0
            total, normal, surface = (
                total + force,
                normal + push,
                surface + (contacts[i, lay.SURFACE] if push > 0.0 or not spring else 0.0),
            )
            sticking += 1.0 if contacts[i, lay.STUCK] > 0.0 else 0.0
            loss = spans[i, 1] if spring and codes[lay.TWO_WAY] == 0 else -force * contacts[i, lay.SLIP]
            sums[b, lay.DISSIPATED] += dt * loss
            sums[b, lay.ALONG] += dt * (loss + force * mean)
            if points[i, lay.TANGENTIAL] == 0.0:
                balance[lay.GAINED_ENERGY] += max(-dt * loss, 0.0)
            if codes[lay.TWO_WAY] > 0:
                sums[b, lay.ON_BEAM] -= dt * points[i, lay.WEIGHT] * force * contacts[i, lay.SURFACE]
            if codes[lay.PRESSES] > 0 or spring:
                across = dt * push * face * (lift - (contacts[i, lay.RAMP] if spring else 0.0))
                sums[b, lay.ACROSS] += across
                sums[b, lay.LIFTED_BEAM] -= points[i, lay.WEIGHT] * across
            if spring:
                k, uphill = indices[i, lay.OF_FOOT], dt * push * face * contacts[i, lay.RAMP]
                sums[b, lay.UPHILL] += uphill
                closing = 0.5 * face * (feet[k, lay.LIFTED] + points[i, lay.ARM] * feet[k, lay.TURNED])
                loss = push - points[i, lay.STIFF] * contacts[i, lay.DEPTH]
                sums[b, lay.DAMPED] += dt * loss * (contacts[i, lay.CLOSING] - closing)
        if sliders[b, lay.INVERSE_MASS] > 0.0:
            sums[b, lay.UPHILL] += dt * mean * sliders[b, lay.TILT] / sliders[b, lay.INVERSE_MASS]
        sums[b, lay.PULLED] += dt * mean * (sliders[b, lay.PULL] if sliders[b, lay.INVERSE_MASS] > 0.0 else -total)
        sums[b, lay.FRICTION_TIME] += dt * total
        sums[b, lay.NORMAL_TIME] += dt * normal
        sums[b, lay.TOUCH_TIME] += dt * touching / n
        sums[b, lay.STICK_TIME] += dt * sticking / n
        sums[b, lay.SURFACE_TIME] += dt * surface / max(touching, 1)
        sums[b, lay.HARDEST] = max(sums[b, lay.HARDEST], abs(total))
    for k in range(feet.shape[0]):
        force = feet[k, lay.PRESS] - feet[k, lay.SPRING_RATE] * feet[k, lay.HEIGHT]
        sums[feet_of[k], lay.PRESSED] += dt * force * (feet[k, lay.CLIMB] + 0.5 * feet[k, lay.LIFTED])


@jit(no_cpython_wrapper=True)
def write_events(
    time: float, dt: float, codes: Indices, sliders: Array, points: Array, contacts: Array, indices: Indices,
    spans: Array, events: Array, tally: Indices,
) -> None:  # fmt: skip
    """Events of the step that begins at `time`; all are counted, as many recorded as fit."""
    for i in range(points.shape[0]):
        x, depth, was = sliders[indices[i, lay.OF_SLIDER], lay.X], contacts[i, lay.DEPTH], contacts[i, lay.WAS_DEPTH]
        n = int(spans[i, 3])
        kind, share = 0.0, 0.0
        if codes[lay.LAW] == lay.SPRING:
            n = 1
            if (depth > 0.0) != (was > 0.0):
                kind, share = lay.LANDS if depth > 0.0 else lay.LEAVES, 0.5 - depth / (depth - was)
            elif depth > 0.0 and (contacts[i, lay.STUCK] > 0.0) != (contacts[i, lay.WAS_STUCK] > 0.0):
                kind = lay.STICKS if contacts[i, lay.STUCK] > 0.0 else lay.SLIPS
        for e in range(n):
            if codes[lay.LAW] != lay.SPRING:
                share, kind = spans[i, 4 + 2 * e], spans[i, 5 + 2 * e]
            if kind in (0.0, lay.TURNS):
                continue
            row = tally[lay.EVENTS]
            if row < events.shape[0]:
                events[row, 0], events[row, 1], events[row, 2], events[row, 3] = time + share * dt, kind, i, x
            tally[lay.EVENTS] += 1


@jit(no_cpython_wrapper=True)
def sample(
    span: float, codes: Indices, sliders: Array, feet: Array, points: Array, contacts: Array, indices: Indices,
    factors: Array, places: Array, samples: Array, heights: Array, pressures: Array, deflections: Array, sums: Array,
    before: Array, tally: Indices,
) -> None:  # fmt: skip
    """Record the state at the end of a step, and means over the interval of that many seconds."""
    row = tally[lay.SAMPLES]
    for b in range(sliders.shape[0]):
        samples[row, b, lay.KEPT_X], samples[row, b, lay.KEPT_V] = sliders[b, lay.X], sliders[b, lay.V]
        samples[row, b, lay.KEPT_FRICTION] = (sums[b, lay.FRICTION_TIME] - before[b, lay.FRICTION_TIME]) / span
        samples[row, b, lay.KEPT_NORMAL] = (sums[b, lay.NORMAL_TIME] - before[b, lay.NORMAL_TIME]) / span
        samples[row, b, lay.KEPT_TOUCH] = (sums[b, lay.TOUCH_TIME] - before[b, lay.TOUCH_TIME]) / span
        samples[row, b, lay.KEPT_STUCK] = (sums[b, lay.STICK_TIME] - before[b, lay.STICK_TIME]) / span
        samples[row, b, lay.KEPT_LOSS] = sums[b, lay.DISSIPATED] - before[b, lay.DISSIPATED]
        samples[row, b, lay.KEPT_ALONG] = sums[b, lay.ALONG] - before[b, lay.ALONG]
        samples[row, b, lay.KEPT_SURFACE] = np.nan
        for s in range(sums.shape[1]):
            before[b, s] = sums[b, s]
    for b in range(sliders.shape[0]):
        speed, n = 0.0, 0
        for i in range(points.shape[0]):
            if indices[i, lay.OF_SLIDER] != b:
                continue
            pressures[row, i] = contacts[i, lay.NORMAL]
            if codes[lay.LAW] != lay.SPRING:
                slip, force = sliders[b, lay.V] - contacts[i, lay.START], contacts[i, lay.FRICTION]
                most, steepness = sliders[b, lay.MU] * max(contacts[i, lay.NORMAL], 0.0), sliders[b, lay.STEEPNESS]
                if contacts[i, lay.STUCK] == 0.0:
                    force = -most * (np.tanh(steepness * slip) if steepness > 0.0 else np.sign(slip))
                samples[row, b, lay.KEPT_FRICTION] = force
                samples[row, b, lay.KEPT_NORMAL] = contacts[i, lay.NORMAL]
                speed, n = speed + contacts[i, lay.START], n + 1
            elif contacts[i, lay.NORMAL] > 0.0:
                speed, n = speed + contacts[i, lay.SURFACE], n + 1
        if n > 0:
            samples[row, b, lay.KEPT_SURFACE] = speed / n
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
                add_powers(when, dt * POWERS[when], time + 0.5 * dt * min(when, 2), drive, rows, factors, forced, loads,
                           growth, balance)  # fmt: skip
        if two_way:
            filter_rates(dt, n_complex, rows, factors)
        set_mean_rates(dt, spring, factors)
        for b in range(sliders.shape[0] if spring and n_steps > 0 else 0):
            sliders[b, lay.X] += 0.5 * dt * sliders[b, lay.V] * sliders[b, lay.FREE]
        for k in range(feet.shape[0] if n_steps > 0 else 0):
            feet[k, lay.HEIGHT] += 0.5 * dt * feet[k, lay.CLIMB]
            feet[k, lay.PITCH] += 0.5 * dt * feet[k, lay.TURN]
        for when in range(last + 1):
            if when == HALF or (spring and when != MIDDLE and n_steps > 0) or (n_steps == 0 and when != START):
                continue
            ready = mark + 4 if when == END and not two_way else mark + when  # the start of the next step as well
            look(when, ready, dt, gravity, codes, table, edges, factors, local, stamp, sliders, feet, points, contacts,
                 indices)  # fmt: skip
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
        move(dt, codes, sliders, feet, points, contacts, indices, spans)
        write_events(drive[lay.ORIGIN] + time, dt, codes, sliders, points, contacts, indices, spans, events, tally)
        tally[lay.STEP] += 1
        if two_way or accounts:
            set_factors(last, time + dt, n_complex, rows, drive, factors)
        if accounts:
            add_powers(last, dt * POWERS[MIDDLE], time + dt, drive, rows, factors, forced, loads, growth, balance)
        if two_way:
            filter_rates(dt, n_complex, rows, factors)
        shift_factors(factors)
        if not np.isfinite(sliders[0, lay.V] + factors[START, VALUE, 0]):
            return lay.NOT_FINITE
        if tally[lay.STEP] % every == 0:
            for when in range(0 if spring or not find_pieces(0.0, edges, sliders, points, indices) else 1):
                look(when, mark + 4, dt, gravity, codes, table, edges, factors, local, stamp, sliders, feet, points,
                     contacts, indices)  # fmt: skip
            sample(every * dt, codes, sliders, feet, points, contacts, indices, factors, places, samples, heights,
                   pressures, deflections, sums, before, tally)  # fmt: skip
    return lay.DONE
