"""Compiled response of the beam's rows to unit contact forces at every point."""

import math

from verify.arrays import Array
from verify.contact.response import NORMAL, TANGENTIAL
from verify.contact.state import BILATERAL, Bodies, Kind, Record, Response
from verify.dynamics.state import Beam, Rows, Surface
from verify.jit import FAST, inline, jit


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
