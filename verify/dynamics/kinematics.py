"""Compiled kinematics: rows and drive in time, the surface under contact points, shapes of all rows at them."""

import numpy as np

from verify.arrays import Array, Indices
from verify.dynamics import layout as lay
from verify.jit import FAST, inline, jit

START, HALF, MIDDLE, END = range(4)
"""Instants of a step. HALF is mid-step; MIDDLE has the deflection of mid-step and, of feet, the MEAN velocity over the
step, displacement/dt, which is exact for every row. Of points without feet it has the velocity with which Simpson's
rule gives that mean, so that means of products of rates and slopes are of order 4 as well."""
VALUE, RATE = range(2)


@inline(fastmath=FAST)
def rotate_half(rows: Array) -> None:
    """Advance every free row by half a step, exactly."""
    for j in range(rows.shape[1]):
        real = rows[lay.Z_RE, j] * rows[lay.HALF_RE, j] - rows[lay.Z_IM, j] * rows[lay.HALF_IM, j]
        rows[lay.Z_IM, j] = rows[lay.Z_RE, j] * rows[lay.HALF_IM, j] + rows[lay.Z_IM, j] * rows[lay.HALF_RE, j]
        rows[lay.Z_RE, j] = real


@inline(fastmath=FAST)
def set_factors(when: int, time: float, n_complex: int, rows: Array, drive: Array, factors: Array) -> None:
    """Factors of all columns and their rates at a time of the stage; `factors` (4, 2, columns)."""
    n = rows.shape[1]
    for j in range(n):
        factors[when, VALUE, j] = rows[lay.Z_RE, j]
        factors[when, RATE, j] = rows[lay.RATE_RE, j] * rows[lay.Z_RE, j] - rows[lay.RATE_IM, j] * rows[lay.Z_IM, j]
    for k in range(n_complex):
        j = n - n_complex + k
        factors[when, VALUE, n + k] = -rows[lay.Z_IM, j]
        factors[when, RATE, n + k] = (
            -rows[lay.RATE_RE, j] * rows[lay.Z_IM, j] - rows[lay.RATE_IM, j] * rows[lay.Z_RE, j]
        )
    omega, unit = drive[lay.OMEGA], drive[lay.UNIT]
    angle = omega * (drive[lay.ORIGIN] + time)
    c, s = np.cos(angle), np.sin(angle)
    power, growth, first = 1.0, 0.0, n + n_complex
    for d in range((factors.shape[2] - first) // 2):
        j = first + 2 * d
        factors[when, VALUE, j], factors[when, VALUE, j + 1] = power * c, -power * s
        factors[when, RATE, j] = growth * c - power * omega * s
        factors[when, RATE, j + 1] = -growth * s - power * omega * c
        growth = (d + 1) * power / unit
        power = power * time / unit


@inline(fastmath=FAST)
def set_mean_rates(dt: float, spring: bool, factors: Array) -> None:
    """Factors of MIDDLE."""
    for j in range(factors.shape[2]):
        mean = (factors[END, VALUE, j] - factors[START, VALUE, j]) / dt
        factors[MIDDLE, VALUE, j] = factors[HALF, VALUE, j]
        ends = factors[START, RATE, j] + factors[END, RATE, j]
        factors[MIDDLE, RATE, j] = mean if spring else 1.5 * mean - 0.25 * ends


@inline(fastmath=FAST)
def filter_rates(dt: float, n_complex: int, rows: Array, factors: Array) -> None:
    """Mean rates over the step in place of those at its end where a row is not resolved."""
    n = rows.shape[1]
    for j in range(n + n_complex):
        if rows[lay.COARSE, j if j < n else j - n_complex] > 0.0:
            factors[END, RATE, j] = (factors[END, VALUE, j] - factors[START, VALUE, j]) / dt


@inline(fastmath=FAST)
def shift_factors(factors: Array) -> None:
    """The end of a step is the start of the next."""
    for j in range(factors.shape[2]):
        factors[START, VALUE, j], factors[START, RATE, j] = factors[END, VALUE, j], factors[END, RATE, j]


@inline
def find_pieces(ahead: float, edges: Array, sliders: Array, points: Array, indices: Indices) -> bool:
    """Set the piece under every point `ahead` seconds on; whether all are on the pieces."""
    last = len(edges) - 2
    for i in range(points.shape[0]):
        b, piece = indices[i, lay.OF_SLIDER], indices[i, lay.PIECE]
        x = sliders[b, lay.X] + ahead * sliders[b, lay.V] * sliders[b, lay.FREE] + points[i, lay.OFFSET]
        while piece > 0 and x < edges[piece]:
            piece -= 1
        while piece < last and x > edges[piece + 1]:
            piece += 1
        if x < edges[piece] or x > edges[piece + 1]:
            return False
        indices[i, lay.PIECE] = piece
    return True


@inline(fastmath=FAST)
def set_polynomials(when: int, piece: int, table: Array, factors: Array, local: Array) -> None:
    """Polynomials of deflection and velocity on one piece; `local` (pieces, 2, degree + 1)."""
    for d in range(table.shape[1]):
        value, rate = 0.0, 0.0
        for j in range(table.shape[2]):
            value += table[piece, d, j] * factors[when, VALUE, j]
            rate += table[piece, d, j] * factors[when, RATE, j]
        local[piece, VALUE, d], local[piece, RATE, d] = value, rate


@inline
def read_surface(
    piece: int, xi: float, length: float, lever: float, local: Array
) -> tuple[float, float, float, float, float, float, float]:
    """Material under a point at xi: (its own xi, w, w', dw/dt, dw'/dt), by metres and seconds; w'' and dw'/dt at xi.

    The material over x is at X = x + lever w'(x) of the mid-line and moves with (-lever dw'/dt, dw/dt).
    """
    value, first, bend, rise, over = 0.0, 0.0, 0.0, 0.0, 0.0
    for d in range(local.shape[2] - 1, 0, -1):
        bend = bend * xi + first
        value = value * xi + local[piece, VALUE, d]
        first = first * xi + value
        rise = rise * xi + local[piece, RATE, d]
        over = over * xi + rise
    at = xi + lever * first / (length * length)
    level, slope, rise, turn = 0.0, 0.0, 0.0, 0.0
    for d in range(local.shape[2] - 1, -1, -1):
        slope = slope * at + level
        level = level * at + local[piece, VALUE, d]
        turn = turn * at + rise
        rise = rise * at + local[piece, RATE, d]
    return at, level, slope / length, rise, turn / length, 2.0 * bend / (length * length), over / length


@jit(no_cpython_wrapper=True)
def evaluate_surface(
    when: int, mark: int, dt: float, gravity: float, codes: Indices, table: Array, edges: Array, factors: Array,
    local: Array, stamp: Indices, sliders: Array, feet: Array, points: Array, contacts: Array, indices: Indices,
) -> None:  # fmt: skip
    """Set the surface under every point at an instant of the step; `stamp` (pieces,) marks polynomials that are ready.

    Sliders are at their place of MIDDLE for feet, at that of START otherwise, with the speed gained in the last step
    for the next.
    """
    spring, follows, share = codes[lay.LAW] == lay.SPRING, codes[lay.FOLLOWING] > 0, 1.0 / 6.0  # Simpson's rule
    ahead = 0.0
    if when == MIDDLE:
        ahead, share = 0.5 * dt, 4.0 / 6.0
    elif when == END:
        ahead = dt
    for i in range(points.shape[0]):
        point, touch, slider, piece = points[i], contacts[i], sliders[indices[i, lay.OF_SLIDER]], indices[i, lay.PIECE]
        if stamp[piece] != mark:
            set_polynomials(when, piece, table, factors, local)
            stamp[piece] = mark
        lever, length, v, free = point[lay.LEVER], edges[piece + 1] - edges[piece], slider[lay.V], slider[lay.FREE]
        x = slider[lay.X] + point[lay.OFFSET]
        if not spring:
            gained = slider[lay.DELTA_V] * ahead / dt
            x += ahead * free * (v + 0.5 * gained)
            v += gained
            if follows:
                x += ahead * touch[lay.DRIFT_END]
        above = (x - edges[piece]) / length
        at, level, slope, rise, turn, bend, over = read_surface(piece, above, length, lever, local)
        along = (rise * slope - lever * turn) / np.sqrt(1.0 + slope * slope)
        lift, on = rise + slope * lever * over, free * v
        if follows:
            tilt, drift = rise * (turn + bend * v) - gravity * slope, -slope * rise * free
            tilt = tilt if slider[lay.INVERSE_MASS] > 0.0 else 0.0  # what prescribes a speed takes it
            if when == START:
                if mark > 0:  # what the forces of the last step have changed by its end, half of it in its middle
                    slider[lay.V] += 0.5 * dt * (tilt - touch[lay.TILT_END])
                    slider[lay.X] += 0.5 * dt * (drift - touch[lay.DRIFT_END])
                slider[lay.TILT], slider[lay.DRIFT] = 0.0, 0.0
            slider[lay.TILT] += share * tilt
            slider[lay.DRIFT] += share * drift
            touch[lay.TILT_END], touch[lay.DRIFT_END] = tilt, drift
            on += drift
        climb = rise + slope * (on + lever * (over + bend * on))
        if spring:
            image, face, foot = point[lay.IMAGE], point[lay.FACE], feet[indices[i, lay.OF_FOOT]]
            depth = image * level - foot[lay.HEIGHT] - point[lay.ARM] * foot[lay.PITCH]
            depth = point[lay.INSET] + face * depth
            if when == START:
                touch[lay.WAS_DEPTH] = depth
                continue
            ramp = image * slope * free * (v + lever * bend * v)
            lift = image * lift + ramp
            touch[lay.WAS_DEPTH], touch[lay.DEPTH], touch[lay.SURFACE_DELTA_V] = (
                touch[lay.DEPTH],
                depth,
                along - touch[lay.BEFORE],
            )
            touch[lay.MEAN], touch[lay.LIFT], touch[lay.RAMP] = along, lift, ramp
            touch[lay.CLOSING] = face * (lift - foot[lay.VELOCITY_Z] - point[lay.ARM] * foot[lay.PITCH_RATE])
        elif when == START:
            touch[lay.START], touch[lay.MEAN], touch[lay.LIFT] = along, share * along, share * lift
            if codes[lay.LAW] == lay.PRESCRIBED:
                touch[lay.POINT_VZ] = climb
        else:
            touch[lay.MEAN] += share * along
            touch[lay.LIFT] += share * lift
        if when == MIDDLE:
            touch[lay.AT], touch[lay.ABOVE], touch[lay.SLOPE] = at, above, slope
        elif when == END:
            touch[lay.END], touch[lay.SPEED_END], touch[lay.CLOSING] = along, free * v, climb
            touch[lay.AT_END], touch[lay.ABOVE_END] = at, above
            touch[lay.RAMP] = free * slope * (1.0 + lever * bend)


@inline(fastmath=FAST)
def shape_of(piece: int, j: int, at: float, above: float, table: Array) -> tuple[float, float, float]:
    """A column's value and derivative by xi at the material under a point, and the derivative at the point."""
    value, first, here, turn = 0.0, 0.0, 0.0, 0.0
    for d in range(table.shape[1] - 1, -1, -1):
        first = first * at + value
        value = value * at + table[piece, d, j]
        turn = turn * above + here
        here = here * above + table[piece, d, j]
    return value, first, turn


@inline(fastmath=FAST)
def set_shapes(
    dt: float, rows: Array, n_complex: int, table: Array, edges: Array, points: Array, contacts: Array,
    indices: Indices, shapes: Array,
) -> None:  # fmt: skip
    """Shapes of all rows at every point in mid-step, tangential and normal, and their mean responses.

    `shapes` (4, points, columns): a tangential force acts on -lever times the slope of the material and on w' times its
    rise, a normal one on the depth of the point, square to the surface: on the rise there, and by w' lever on the turn
    over the point. The other two are G/dt times these, times the weight: a force f at point j changes the mean speed at
    point i by the product of shape i and response j.
    """
    n = rows.shape[1]
    for i in range(points.shape[0]):
        piece, at, above = indices[i, lay.PIECE], contacts[i, lay.AT], contacts[i, lay.ABOVE]
        slope, side = contacts[i, lay.SLOPE], points[i, lay.FACE] * points[i, lay.IMAGE]
        lever, weight = points[i, lay.LEVER] / (edges[piece + 1] - edges[piece]), points[i, lay.WEIGHT] / dt
        stretch, lean = np.sqrt(1.0 + slope * slope), slope * lever
        for j in range(n + n_complex):
            value, first, turn = shape_of(piece, j, at, above, table)
            shapes[0, i, j] = (slope * value - lever * first) / stretch
            shapes[1, i, j] = side * (value + lean * turn)
        for s in range(2):
            for j in range(n - n_complex):
                shapes[2 + s, i, j] = weight * rows[lay.GAIN_RE, j] * shapes[s, i, j]
            for j in range(n - n_complex, n):
                k, real, imaginary = j + n_complex, rows[lay.GAIN_RE, j], rows[lay.GAIN_IM, j]
                shapes[2 + s, i, j] = weight * (real * shapes[s, i, j] - imaginary * shapes[s, i, k])
                shapes[2 + s, i, k] = -weight * (real * shapes[s, i, k] + imaginary * shapes[s, i, j])
