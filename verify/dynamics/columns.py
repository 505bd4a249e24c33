"""Compiled motion of the beam: factors of the columns of a surface in time (`state`), response to contact forces."""

import math

from verify.arrays import Array
from verify.contact.points import NORMAL, TANGENTIAL
from verify.contact.state import BILATERAL, Bodies, Kind, Record, Response
from verify.dynamics.state import END, HALF, MIDDLE, RATE, START, VALUE, Beam, Harmonic, Rows, Surface
from verify.jit import FAST, inline, jit, once


@inline(fastmath=FAST)
def rotate_half(rows: Rows) -> None:
    """Advance every free row by half a step, exactly."""
    for j in range(len(rows.z_re)):
        real = rows.z_re[j] * rows.half_re[j] - rows.z_im[j] * rows.half_im[j]
        rows.z_im[j] = rows.z_re[j] * rows.half_im[j] + rows.z_im[j] * rows.half_re[j]
        rows.z_re[j] = real


@inline(fastmath=FAST)
def set_row_factors(n_complex: int, rows: Rows, values: Array, rates: Array) -> None:
    """Factors of the columns of the rows and their rates."""
    n = len(rows.z_re)
    for j in range(n):
        values[j] = rows.z_re[j]
        rates[j] = rows.rate_re[j] * rows.z_re[j] - rows.rate_im[j] * rows.z_im[j]
    for k in range(n_complex):
        j = n - n_complex + k
        values[n + k] = -rows.z_im[j]
        rates[n + k] = -rows.rate_re[j] * rows.z_im[j] - rows.rate_im[j] * rows.z_re[j]


@inline(fastmath=FAST)
def set_drive_factors(first: int, time: float, harmonic: Harmonic, values: Array, rates: Array) -> None:
    """Factors of the columns of the drive, from `first` on, and their rates at a time of the stage, s."""
    omega, unit = harmonic.omega, harmonic.unit
    angle = omega * (harmonic.origin + time)
    c, s = math.cos(angle), math.sin(angle)
    power, growth = 1.0, 0.0
    for d in range((len(values) - first) // 2):
        j = first + 2 * d
        values[j], values[j + 1] = power * c, -power * s
        rates[j] = growth * c - power * omega * s
        rates[j + 1] = -growth * s - power * omega * c
        growth = (d + 1) * power / unit
        power = power * time / unit


@once
def set_factors(when: int, time: float, beam: Beam) -> None:
    """Factors of all columns and their rates at a time of the stage, s."""
    values, rates = beam.surface.factors[when, VALUE], beam.surface.factors[when, RATE]
    set_row_factors(beam.n_complex, beam.rows, values, rates)
    set_drive_factors(len(beam.rows.z_re) + beam.n_complex, time, beam.harmonic, values, rates)


@inline(fastmath=FAST)
def set_mean_rates(dt: float, spring: bool, factors: Array) -> None:
    """Factors of MIDDLE."""
    for j in range(factors.shape[2]):
        mean = (factors[END, VALUE, j] - factors[START, VALUE, j]) / dt
        factors[MIDDLE, VALUE, j] = factors[HALF, VALUE, j]
        ends = factors[START, RATE, j] + factors[END, RATE, j]
        factors[MIDDLE, RATE, j] = mean if spring else 1.5 * mean - 0.25 * ends


@inline(fastmath=FAST)
def filter_rates(dt: float, n_complex: int, coarse: Array, factors: Array) -> None:
    """Mean rates over the step in place of those at its end where a row is not resolved."""
    n = len(coarse)
    for j in range(n + n_complex):
        if coarse[j if j < n else j - n_complex] > 0.0:
            factors[END, RATE, j] = (factors[END, VALUE, j] - factors[START, VALUE, j]) / dt


@inline(fastmath=FAST)
def shift_factors(factors: Array) -> None:
    """The end of a step is the start of the next."""
    for j in range(factors.shape[2]):
        factors[START, VALUE, j], factors[START, RATE, j] = factors[END, VALUE, j], factors[END, RATE, j]


@inline(fastmath=FAST)
def apply_forces(kind: Kind, beam: Beam, bodies: Bodies, shapes: Array) -> None:
    """Contact forces, constant over the step, to the rows at its end: exact. `shapes` as in `contact.Response`."""
    rows, n = beam.rows, len(beam.rows.z_re)
    for j in range(n):
        real, imaginary = 0.0, 0.0
        for i in range(bodies.points.shape[0]):
            weight, contact = bodies.points[i].weight, bodies.contacts[i]
            along, across = weight * contact.friction, 0.0
            if kind.normal_two_way:
                across = weight * contact.normal
            real -= along * shapes[0, i, j] + across * shapes[1, i, j]
            if j >= n - beam.n_complex:
                k = j + beam.n_complex
                imaginary -= along * shapes[0, i, k] + across * shapes[1, i, k]
        rows.z_re[j] += rows.gain_re[j] * real - rows.gain_im[j] * imaginary
        rows.z_im[j] += rows.gain_re[j] * imaginary + rows.gain_im[j] * real


@inline(fastmath=FAST)
def shape_of(piece: int, j: int, xi: float, xi_point: float, table: Array) -> tuple[float, float, float]:
    """A column's value and derivative by xi at the material under a point, and the derivative at the point."""
    value, first, here, turn = 0.0, 0.0, 0.0, 0.0
    for d in range(table.shape[1] - 1, -1, -1):
        first = first * xi + value
        value = value * xi + table[piece, d, j]
        turn = turn * xi_point + here
        here = here * xi_point + table[piece, d, j]
    return value, first, turn


@inline(fastmath=FAST)
def set_shapes(i: int, columns: int, surface: Surface, point: Record, contact: Record, shapes: Array) -> None:
    """Tangential and normal speed of the surface at point i by unit rates of the first columns, in mid-step.

    A tangential force acts on -lever times the slope of the material and on w' times its rise, a normal one on the
    depth of the point, square to the surface: on the rise there, and by w' lever on the turn over the point.
    """
    piece, xi, xi_point, slope = contact.piece, contact.xi, contact.xi_point, contact.slope
    lever, side = point.lever / (surface.edges[piece + 1] - surface.edges[piece]), point.face * point.image
    stretch, lean = math.sqrt(1.0 + slope * slope), slope * lever
    for j in range(columns):
        value, first, turn = shape_of(piece, j, xi, xi_point, surface.table)
        shapes[TANGENTIAL, i, j] = (slope * value - lever * first) / stretch
        shapes[NORMAL, i, j] = side * (value + lean * turn)


@inline(fastmath=FAST)
def set_mean_responses(i: int, dt: float, rows: Rows, n_complex: int, weight: float, shapes: Array) -> None:
    """Mean rates of the columns by unit forces of point i: G/dt times its shapes, times its weight.

    The columns of a complex row have the factors Re z and -Im z, so that their rates are the real part of G b and minus
    its imaginary part, with b = psi_re + i psi_im.
    """
    n, scale = len(rows.gain_re), weight / dt
    for s in range(2):
        for j in range(n - n_complex):
            shapes[2 + s, i, j] = scale * rows.gain_re[j] * shapes[s, i, j]
        for j in range(n - n_complex, n):
            k, real, imaginary = j + n_complex, rows.gain_re[j], rows.gain_im[j]
            shapes[2 + s, i, j] = scale * (real * shapes[s, i, j] - imaginary * shapes[s, i, k])
            shapes[2 + s, i, k] = -scale * (real * shapes[s, i, k] + imaginary * shapes[s, i, j])


@inline(fastmath=FAST)
def set_end_coupling(
    i: int, rows: Rows, n_complex: int, surface: Surface, bodies: Bodies, shapes: Array, couplings: Array
) -> None:
    """Speed across at the end of the step of point i, which follows the surface, by unit forces of all points.

    It is read where the point is then, with the convective part v w' of the displacement: of the real part of z
    rate Re(lambda G b) + moved Re(G b); the factor -Im z of an imaginary part changes the sign of its terms.
    """
    n, contact, points = len(rows.gain_re), bodies.contacts[i], bodies.points
    length = surface.edges[contact.piece + 1] - surface.edges[contact.piece]
    lean, v = contact.slope * points[i].lever / length, contact.v_end / length
    for k in range(points.shape[0]):
        couplings[0, i, k], couplings[1, i, k] = 0.0, 0.0
    for j in range(n + n_complex):
        value, first, turn = shape_of(contact.piece, j, contact.xi_end, contact.xi_point_end, surface.table)
        rate, moved = value + lean * turn, v * first
        row = j if j < n else j - n_complex
        real = rate * rows.end_re[row] + moved * rows.gain_re[row]
        imaginary = rate * rows.end_im[row] + moved * rows.gain_im[row]
        paired = row >= n - n_complex
        for s in range(2):
            for k in range(points.shape[0]):
                speed = shapes[s, k, row] * real
                if paired:
                    b_re, b_im = shapes[s, k, row], shapes[s, k, row + n_complex]
                    speed = real * b_re - imaginary * b_im if j < n else -(real * b_im + imaginary * b_re)
                couplings[s, i, k] += points[k].weight * speed


@jit(no_cpython_wrapper=True)
def set_response(dt: float, kind: Kind, beam: Beam, bodies: Bodies, response: Response) -> None:
    """Shapes of all rows at every point in mid-step, their mean responses, and of bilateral contact the couplings."""
    rows, surface, shapes = beam.rows, beam.surface, response.shapes
    for i in range(bodies.points.shape[0]):
        point, contact = bodies.points[i], bodies.contacts[i]
        set_shapes(i, len(rows.gain_re) + beam.n_complex, surface, point, contact, shapes)
        set_mean_responses(i, dt, rows, beam.n_complex, point.weight, shapes)
    for i in range(bodies.points.shape[0] if kind.normal_law == BILATERAL else 0):
        set_end_coupling(i, rows, beam.n_complex, surface, bodies, shapes, response.couplings)
