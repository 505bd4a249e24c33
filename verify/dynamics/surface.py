"""Compiled surface under contact points: pieces, polynomials, and the motion of the material under every point."""

import math
from typing import NamedTuple

from verify.arrays import Array
from verify.contact.state import PRESCRIBED, SPRING, Bodies, Kind, Record
from verify.dynamics.state import END, MIDDLE, RATE, START, VALUE, Surface
from verify.jit import FAST, inline, jit, once

SIMPSON = (1.0 / 6.0, 0.0, 4.0 / 6.0, 1.0 / 6.0)  # Simpson's weights of START, (HALF), MIDDLE, END
AHEAD = (0.0, 0.5, 0.5, 1.0)  # The instants in steps


class Motion(NamedTuple):
    """Motion of the surface under a point at xi, in metres and seconds."""

    xi: float  # The material under the point, on the piece
    w: float
    slope: float  # w' of the material
    rise: float  # dw/dt of the material
    turn: float  # dw'/dt of the material
    bend: float  # w'' at the point
    turn_at_point: float  # dw'/dt at the point


@inline
def find_pieces(ahead: float, edges: Array, bodies: Bodies) -> bool:
    """Set the piece under every point `ahead` seconds on; whether all are on the pieces."""
    last = len(edges) - 2
    for i in range(bodies.points.shape[0]):
        slider, piece = bodies.sliders[bodies.points[i].slider], bodies.contacts[i].piece
        x = slider.x + ahead * slider.v * slider.free + bodies.points[i].offset
        while piece > 0 and x < edges[piece]:
            piece -= 1
        while piece < last and x > edges[piece + 1]:
            piece += 1
        if x < edges[piece] or x > edges[piece + 1]:
            return False
        bodies.contacts[i].piece = piece
    return True


@inline(fastmath=FAST)
def set_polynomials(when: int, piece: int, mark: int, surface: Surface) -> None:
    """Polynomials of deflection and velocity on one piece, unless they have this mark."""
    if surface.stamps[piece] == mark:
        return
    surface.stamps[piece] = mark
    values, rates = surface.factors[when, VALUE], surface.factors[when, RATE]
    for d in range(surface.table.shape[1]):
        shape, value, rate = surface.table[piece, d], 0.0, 0.0
        for j in range(len(shape)):
            value += shape[j] * values[j]
            rate += shape[j] * rates[j]
        surface.polynomials[piece, VALUE, d], surface.polynomials[piece, RATE, d] = value, rate


@once
def motion_under(xi: float, length: float, lever: float, polynomials: Array) -> Motion:
    """Motion of the material under a point at xi of a piece, by its polynomials (2, degree + 1).

    The material over x is at X = x + lever w'(x) of the mid-line and moves with (-lever dw'/dt, dw/dt).
    """
    w, slope, bend, rise, turn = 0.0, 0.0, 0.0, 0.0, 0.0
    for d in range(polynomials.shape[1] - 1, 0, -1):
        bend = bend * xi + slope
        w = w * xi + polynomials[VALUE, d]
        slope = slope * xi + w
        rise = rise * xi + polynomials[RATE, d]
        turn = turn * xi + rise
    at, turn_at_point = xi + lever * slope / (length * length), turn
    w, slope, rise, turn = 0.0, 0.0, 0.0, 0.0
    for d in range(polynomials.shape[1] - 1, -1, -1):
        slope = slope * at + w
        w = w * at + polynomials[VALUE, d]
        turn = turn * at + rise
        rise = rise * at + polynomials[RATE, d]
    bend, turn_at_point = 2.0 * bend / (length * length), turn_at_point / length
    return Motion(at, w, slope / length, rise, turn / length, bend, turn_at_point)


@inline
def tangential(motion: Motion, lever: float) -> float:
    """Speed of the material along the tangent, m/s."""
    return float((motion.rise * motion.slope - lever * motion.turn) / math.sqrt(1.0 + motion.slope * motion.slope))


@once
def under_foot(when: int, motion: Motion, slider: Record, foot: Record, point: Record, contact: Record) -> None:
    """Depth and speeds of a point of a foot in mid-step; at the start of a run, only its depth."""
    level = point.image * motion.w - foot.height - point.arm * foot.pitch
    depth, lever = point.inset + point.face * level, point.lever
    if when == START:
        contact.depth_before = depth
        return
    along, slope, free = tangential(motion, lever), motion.slope, slider.free
    contact.slope_vz = point.image * slope * free * (slider.v + lever * motion.bend * slider.v)
    contact.vz = point.image * (motion.rise + slope * lever * motion.turn_at_point) + contact.slope_vz
    contact.closing = point.face * (contact.vz - foot.velocity_z - point.arm * foot.pitch_rate)
    contact.depth_before, contact.depth = contact.depth, depth
    contact.mean, contact.surface_delta_v = along, along - contact.surface_before


@once
def follow(
    when: int, first_step: bool, dt: float, gravity: float, motion: Motion, v: float, slider: Record, contact: Record
) -> float:
    """Drift of a slider that follows the surface, m/s; adds to the step's mean of it and of the acceleration.

    The tangent turns under it, and gravity pulls it down the slope. At the start of a step the slider gets what the
    contact forces of the last step have changed by its end: half of it in its middle.
    """
    drift = -motion.slope * motion.rise * slider.free
    tilt = motion.rise * (motion.turn + motion.bend * v) - gravity * motion.slope
    tilt = tilt if slider.inverse_mass > 0.0 else 0.0  # what prescribes a speed takes it
    if when == START:
        if not first_step:
            slider.v += 0.5 * dt * (tilt - contact.tilt_end)
            slider.x += 0.5 * dt * (drift - contact.drift_end)
        slider.tilt, slider.drift = 0.0, 0.0
    slider.tilt += SIMPSON[when] * tilt
    slider.drift += SIMPSON[when] * drift
    contact.tilt_end, contact.drift_end = tilt, drift
    return float(drift)


@once
def under_point(
    when: int,
    kind: Kind,
    motion: Motion,
    xi: float,
    v: float,
    on: float,
    slider: Record,
    point: Record,
    contact: Record,
) -> None:
    """Speeds of the surface under a point without foot, which moves along it with the speed `on`, at xi."""
    along, slope, lever = tangential(motion, point.lever), motion.slope, point.lever
    turn = motion.turn_at_point
    vz = motion.rise + slope * (on + lever * (turn + motion.bend * on))  # dw/dt + w' dX/dt, X = x + (h/2) w'
    if when == START:
        contact.start, contact.mean, contact.vz = along, 0.0, 0.0
        if kind.normal_law == PRESCRIBED:
            contact.point_vz = vz
    contact.mean += SIMPSON[when] * along
    contact.vz += SIMPSON[when] * (motion.rise + slope * lever * turn)
    if when == END:
        contact.end, contact.v_end, contact.closing = along, slider.free * v, vz
        contact.xi_end, contact.xi_point_end = motion.xi, xi
        contact.slope_vz = slider.free * slope * (1.0 + lever * motion.bend)


@jit(no_cpython_wrapper=True)
def evaluate_surface(when: int, mark: int, dt: float, kind: Kind, surface: Surface, bodies: Bodies) -> None:
    """Set the surface under every point at an instant of the step; `mark` is that of the instant, 0 at first.

    Sliders are at their place of MIDDLE for feet, at that of START otherwise, with the speed gained in the last step
    for the next.
    """
    spring = kind.normal_law == SPRING
    for i in range(bodies.points.shape[0]):
        point, contact, slider = bodies.points[i], bodies.contacts[i], bodies.sliders[bodies.points[i].slider]
        set_polynomials(when, contact.piece, mark, surface)
        start, length = surface.edges[contact.piece], surface.edges[contact.piece + 1] - surface.edges[contact.piece]
        x, v, ahead = slider.x + point.offset, slider.v, AHEAD[when] * dt
        if not spring:
            x += ahead * slider.free * (v + 0.5 * AHEAD[when] * slider.delta_v)
            v += AHEAD[when] * slider.delta_v
            x += ahead * contact.drift_end if kind.following else 0.0
        xi = (x - start) / length
        motion = motion_under(xi, length, point.lever, surface.polynomials[contact.piece])
        if spring:
            under_foot(when, motion, slider, bodies.feet[point.foot], point, contact)
        else:
            on = slider.free * v
            if kind.following:
                on += follow(when, mark == 0, dt, kind.gravity, motion, v, slider, contact)
            under_point(when, kind, motion, xi, v, on, slider, point, contact)
        if when == MIDDLE:
            contact.xi, contact.xi_point, contact.slope = motion.xi, xi, motion.slope


@jit(no_cpython_wrapper=True)
def set_start_speeds(start: int, mark: int, surface: Surface, bodies: Bodies) -> None:
    """Set the speed of the surface under points without feet at the start of a step, START; moves nothing."""
    for i in range(bodies.points.shape[0]):
        point, contact = bodies.points[i], bodies.contacts[i]
        set_polynomials(start, contact.piece, mark, surface)
        left, length = surface.edges[contact.piece], surface.edges[contact.piece + 1] - surface.edges[contact.piece]
        xi = (bodies.sliders[point.slider].x + point.offset - left) / length
        motion = motion_under(xi, length, point.lever, surface.polynomials[contact.piece])
        contact.start = tangential(motion, point.lever)
