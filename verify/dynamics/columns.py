"""Compiled motion of the beam: rows and drive in time, as factors of the columns of a surface (`state`)."""

import math

from verify.arrays import Array
from verify.contact.state import Bodies, Kind
from verify.dynamics.state import END, HALF, MIDDLE, RATE, START, VALUE, Beam, Harmonic, Rows
from verify.jit import FAST, inline, once


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
