"""Compiled rigid contact of one point: flights, impacts with restitution, riding until it lifts off.

The surface does not respond to the point, so that its motion is known at every instant: landings and lift-offs are
bracketed and bisected wherever they fall in a step. Friction is that of `friction`, of impulses at an impact.
"""

import numpy as np

from verify.arrays import Array, Indices
from verify.dynamics import layout as lay
from verify.dynamics.friction import coulomb_force, tanh_force
from verify.dynamics.integrator import sample
from verify.dynamics.kinematics import END, find_pieces, rotate_half, set_factors, shift_factors
from verify.jit import FAST, inline, jit

BISECTIONS = 100
IMPACTS = 100_000
"""Landings, lift-offs and pieces of a step, at most."""
REST = 1e-6
"""Shortest flight, as a fraction of a step."""
ROUNDING = 4e-15
"""Rounding in the height of a flight, relative to the height of the surface and its speed times the time."""
LOW = 1e4
"""Height, over that rounding, above which a flight counts whatever energy it loses."""
LEVEL, CLIMB, RAMP, ACCELERATION, ALONG = range(5)
"""`motion`: height of the surface, its rate under the moving point, the part by slopes, acceleration of a point that
rides on it, tangential speed of the material."""


@inline(fastmath=FAST)
def surface_at(
    time: float, since: float, x: float, v: float, n_complex: int, rows: Array, drive: Array, table: Array,
    edges: Array, lever: float, columns: Array, motion: Array,
) -> None:  # fmt: skip
    """Set the surface under x at a time of the stage, `since` seconds after the state of the rows."""
    piece, n, omega, unit = 0, rows.shape[1], drive[lay.OMEGA], drive[lay.UNIT]
    while piece < len(edges) - 2 and x > edges[piece + 1]:
        piece += 1
    for j in range(n + n_complex):
        k = j if j < n else j - n_complex
        grown = np.exp(rows[lay.RATE_RE, k] * since)
        c, s = grown * np.cos(rows[lay.RATE_IM, k] * since), grown * np.sin(rows[lay.RATE_IM, k] * since)
        real = rows[lay.Z_RE, k] * c - rows[lay.Z_IM, k] * s
        imaginary = rows[lay.Z_RE, k] * s + rows[lay.Z_IM, k] * c
        for d in range(3):
            columns[d, j] = real if j < n else -imaginary
            real, imaginary = (
                rows[lay.RATE_RE, k] * real - rows[lay.RATE_IM, k] * imaginary,
                rows[lay.RATE_RE, k] * imaginary + rows[lay.RATE_IM, k] * real,
            )
    angle, first = omega * (drive[lay.ORIGIN] + time), n + n_complex
    c, s, power, rate, bend = np.cos(angle), np.sin(angle), 1.0, 0.0, 0.0
    for d in range((columns.shape[1] - first) // 2):
        j = first + 2 * d
        columns[0, j], columns[0, j + 1] = power * c, -power * s
        columns[1, j], columns[1, j + 1] = rate * c - power * omega * s, -rate * s - power * omega * c
        fall = bend - omega * omega * power
        columns[2, j], columns[2, j + 1] = fall * c - 2.0 * rate * omega * s, -fall * s - 2.0 * rate * omega * c
        bend = (d + 1) * rate / unit
        rate = (d + 1) * power / unit
        power = power * time / unit
    length, degree = edges[piece + 1] - edges[piece], table.shape[1]
    at = (x - edges[piece]) / length
    for attempt in range(2):  # the material under x first, then what it does
        w, slope, curve, rise, turn, fall, lean = 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0
        for d in range(degree - 1, -1, -1):
            value, speed, acceleration = 0.0, 0.0, 0.0
            for j in range(columns.shape[1]):
                value += table[piece, d, j] * columns[0, j]
                speed += table[piece, d, j] * columns[1, j]
                acceleration += table[piece, d, j] * columns[2, j]
            curve = curve * at + slope
            slope = slope * at + w
            w = w * at + value
            turn = turn * at + rise
            rise = rise * at + speed
            lean = lean * at + fall
            fall = fall * at + acceleration
        slope, curve, turn, lean = slope / length, 2.0 * curve / (length * length), turn / length, lean / length
        if attempt == 0:
            at += lever * slope / length
    passed = v + lever * (turn + curve * v)
    motion[LEVEL], motion[CLIMB], motion[RAMP] = w, rise + slope * passed, slope * (v + lever * curve * v)
    motion[ACCELERATION] = fall + lever * slope * lean + (2.0 * turn + curve * passed) * passed
    motion[ALONG] = (rise * slope - lever * turn) / np.sqrt(1.0 + slope * slope)


@jit
def advance_impacts(
    n_steps: int, every: int, dt: float, restitution: float, codes: Indices, drive: Array, rows: Array, table: Array,
    edges: Array, sliders: Array, feet: Array, points: Array, contacts: Array, indices: Indices, factors: Array,
    columns: Array, motion: Array, spans: Array, places: Array, samples: Array, heights: Array, pressures: Array,
    deflections: Array, events: Array, tally: Indices, sums: Array, before: Array,
) -> int:  # fmt: skip
    """Advance a rigid point by up to n_steps from step tally[STEP]; why it returns.

    `contacts[0, DEPTH]` is 1 while it rides and -1 while it flies; at 0 it is set down on the surface. `columns` (3,
    columns) and `motion` (5,) are working space.
    """
    slider, foot, touch, total, n_complex = sliders[0], feet[0], contacts[0], sums[0], codes[lay.COMPLEX]
    mass, lever, free = 1.0 / foot[lay.INVERSE_FOOT_MASS], points[0, lay.LEVER], slider[lay.FREE]
    inverse, mu, steepness = slider[lay.INVERSE_MASS], slider[lay.MU], slider[lay.STEEPNESS]
    load, along = -foot[lay.FOOT_LOAD] / mass, slider[lay.EXTERNAL_FORCE] * inverse
    for _ in range(n_steps):
        time, done, origin = tally[lay.STEP] * dt, 0.0, drive[lay.ORIGIN]
        for _ in range(IMPACTS):
            left = dt - done
            if left <= 1e-15 * dt:
                break
            if touch[lay.DEPTH] == 0.0:
                surface_at(time, done, slider[lay.X], free * slider[lay.V],
                    n_complex, rows, drive, table, edges, lever, columns, motion)  # fmt: skip
                foot[lay.HEIGHT], foot[lay.VELOCITY_Z] = motion[LEVEL], motion[CLIMB]
                touch[lay.DEPTH] = 1.0 if load + motion[ACCELERATION] > 0.0 else -1.0
            riding, low, high, x, v = touch[lay.DEPTH] > 0.0, 0.0, left, slider[lay.X], slider[lay.V]
            ended = False
            for trial in range(2 + BISECTIONS):  # both halves of what is left, then bisection
                s = left * 0.5 * (trial + 1) if trial < 2 else 0.5 * (low + high)
                if (trial == 1 and ended) or (trial > 1 and not low < s < high):
                    continue
                ax = 0.0 if riding else along
                surface_at(time + done + s, done + s, x + free * (v + 0.5 * ax * s) * s, free * (v + ax * s),
                    n_complex, rows, drive, table, edges, lever, columns, motion)  # fmt: skip
                margin = foot[lay.HEIGHT] + (foot[lay.VELOCITY_Z] - 0.5 * load * s) * s - motion[LEVEL]
                margin = load + motion[ACCELERATION] if riding else margin
                if margin < 0.0:
                    high, ended = s, True
                else:
                    low = s
                if trial == 1 and not ended:
                    break
            s = high
            if not riding:
                moved, rise = (v + 0.5 * along * s) * s, (foot[lay.VELOCITY_Z] - 0.5 * load * s) * s
                slider[lay.X], slider[lay.V] = x + free * moved, v + along * s
                foot[lay.HEIGHT] += rise
                foot[lay.VELOCITY_Z] -= load * s
                total[lay.EXTERNAL_WORK] += slider[lay.EXTERNAL_FORCE] * moved * (inverse > 0.0)
                total[lay.LOAD_WORK] -= mass * load * rise
                touch[lay.NORMAL], touch[lay.FRICTION], touch[lay.STUCK] = 0.0, 0.0, 0.0
                normal, force, share, speed, ramp, into, across = 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0
            else:
                surface_at(time + done, done, x, free * v, n_complex, rows, drive, table, edges, lever, columns, motion)
                speed = motion[ALONG]
                middle = x + free * 0.5 * v * s
                surface_at(time + done + 0.5 * s, done + 0.5 * s, middle, free * v,
                    n_complex, rows, drive, table, edges, lever, columns, motion)  # fmt: skip
                normal, share, ramp = mass * max(load + motion[ACCELERATION], 0.0), s, motion[RAMP]
                surface_at(time + done + s, done + s, x + free * v * s, free * v,
                    n_complex, rows, drive, table, edges, lever, columns, motion)  # fmt: skip
            compliance, gain = inverse, 0.0
            if not riding and ended:  # landing: restitution across, friction of the impulse along
                surface_at(time + done + s, done + s, slider[lay.X], free * slider[lay.V],
                    n_complex, rows, drive, table, edges, lever, columns, motion)  # fmt: skip
                foot[lay.HEIGHT] = motion[LEVEL]
                into = max(motion[CLIMB] - foot[lay.VELOCITY_Z], 0.0)
                normal, share, speed, ramp = mass * (1.0 + restitution) * into, 1.0, motion[ALONG], motion[RAMP]
                foot[lay.VELOCITY_Z] += normal / mass
                total[lay.CONTACT_LOSS] += 0.5 * normal * into * (1.0 - restitution)
            if share > 0.0:
                v = slider[lay.V]
                if riding:
                    compliance, gain = s * inverse, motion[ALONG] - speed - s * along
                start = v - speed
                if steepness > 0.0:
                    force = tanh_force(start, gain, compliance, mu * normal, steepness)
                    touch[lay.STUCK] = 0.0
                else:
                    stuck = riding and touch[lay.STUCK] > 0.0
                    shift = start if stuck else 0.0
                    force = coulomb_force(start, gain - shift, gain - shift, compliance, mu * normal,
                                          slider[lay.MU_STATIC] * normal, stuck, spans[0])  # fmt: skip
                    touch[lay.STUCK] = spans[0, 0] if riding else 0.0
                after = v + share * inverse * force + (s * along if riding else 0.0)
                mean, surface = 0.5 * (v + after), 0.5 * (speed + motion[ALONG])
                slider[lay.V] = after
                if riding:
                    slider[lay.X] = x + free * mean * s
                    surface_at(time + done + s, done + s, slider[lay.X], free * after,
                        n_complex, rows, drive, table, edges, lever, columns, motion)  # fmt: skip
                    rise = motion[LEVEL] - foot[lay.HEIGHT]
                    across = 0.5 * mass * (motion[CLIMB] ** 2 - foot[lay.VELOCITY_Z] ** 2) + mass * load * rise
                    foot[lay.HEIGHT], foot[lay.VELOCITY_Z] = motion[LEVEL], motion[CLIMB]
                    total[lay.LOAD_WORK] -= mass * load * rise
                    total[lay.TOUCH_TIME] += s
                    total[lay.STICK_TIME] += s if touch[lay.STUCK] > 0.0 else 0.0
                    touch[lay.NORMAL], touch[lay.FRICTION], touch[lay.SURFACE] = normal, force, surface
                    total[lay.MAX_FRICTION] = max(total[lay.MAX_FRICTION], abs(force))
                    total[lay.SURFACE_TIME] += s * surface
                else:
                    across = normal * motion[CLIMB]
                total[lay.SLOPE_WORK] += share * normal * ramp
                total[lay.NORMAL_WORK] += across - share * normal * ramp
                total[lay.NORMAL_ON_BEAM] -= across - share * normal * ramp
                total[lay.TANGENTIAL_WORK] += share * force * surface
                total[lay.FRICTION_LOSS] += share * force * (surface - mean)
                total[lay.FRICTION_TIME] += share * force
                total[lay.NORMAL_TIME] += share * normal
                ax = slider[lay.EXTERNAL_FORCE] * (s if riding else 0.0)
                total[lay.EXTERNAL_WORK] += mean * (ax if inverse > 0.0 else -share * force)
            done += s
            kind = 0.0
            if riding and ended and s < left:
                kind, touch[lay.DEPTH] = lay.LEAVES, -1.0
            elif not riding and ended:
                kind = lay.LANDS
                away, contact_load = restitution * into, load + motion[ACCELERATION]
                if contact_load > 0.0:  # a flight too short for the step, or low and fed by rounding
                    height = away * away / (2.0 * contact_load)
                    known = ROUNDING * (abs(motion[LEVEL]) + abs(motion[CLIMB]) * (time + dt))
                    fed = (1.0 - restitution**2) * height <= known and height <= LOW * known
                    if 2.0 * away <= REST * dt * contact_load or fed:
                        touch[lay.DEPTH], foot[lay.VELOCITY_Z] = 1.0, motion[CLIMB]
                        total[lay.CONTACT_LOSS] += 0.5 * mass * away * away  # what is left of the bounce
                        total[lay.NORMAL_WORK] -= mass * away * motion[CLIMB]
                        total[lay.NORMAL_ON_BEAM] += mass * away * motion[CLIMB]
            if kind > 0.0:
                row = tally[lay.EVENTS]
                if row < events.shape[0]:
                    events[row, 0], events[row, 1] = origin + time + done, kind
                    events[row, 2], events[row, 3] = 0.0, slider[lay.X]
                tally[lay.EVENTS] += 1
        if dt - done > 1e-15 * dt:
            return lay.CHATTERS
        rotate_half(rows)
        rotate_half(rows)
        tally[lay.STEP] += 1
        if not np.isfinite(slider[lay.V] + foot[lay.HEIGHT]):
            return lay.NOT_FINITE
        if tally[lay.STEP] % every == 0:
            set_factors(END, time + dt, n_complex, rows, drive, factors)
            shift_factors(factors)
            sample(every * dt, codes, sliders, feet, points, contacts, indices, factors, places, samples, heights,
                   pressures, deflections, sums, before, tally)  # fmt: skip
        if not find_pieces(0.0, edges, sliders, points, indices):
            return lay.OFF_PIECES
    return lay.DONE
