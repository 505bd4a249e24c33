"""The compiled contact of a slider that the beam feels: what forces do to the modes, and how both sides agree."""

import numpy as np

from verify.models.arrays import Array
from verify.models.kernels import FAST, lean
from verify.motion.friction_kernels import slip
from verify.motion.records import (
    CLIMB,
    FALL,
    FULL_IM,
    FULL_RE,
    HALF_IM,
    HEIGHT,
    LEVEL,
    LEVER,
    LIFT,
    NORMAL,
    OMEGA,
    READ,
    SIGMA,
    STILL,
    SURFACE,
    Z_IM,
    Z_RE,
    Here,
    Law,
    Rider,
    Space,
    Surface,
)
from verify.motion.surface_kernels import carried, climbed, material


@lean(fastmath=FAST, error_model="numpy")
def set_levers(surface: Surface, piece: int, local: Array, x: float, half: float) -> Here:
    """How unit forces on the surface at x load every mode: a tangential one -(h/2) on its slope, w' on its rise.

    A normal one acts on its rise.
    """
    table, edges, modes = surface.table, surface.edges, surface.modes
    length = edges[piece + 1] - edges[piece]
    at = material(local, edges, piece, x, half)
    slope, deflection = 0.0, 0.0
    for d in range(table.shape[1] - 1, -1, -1):
        slope = slope * at + deflection
        deflection = deflection * at + local[STILL, d]
    slope /= length
    stretch = np.sqrt(1.0 + slope * slope)
    for j in range(modes.shape[1]):
        value, first = 0.0, 0.0
        for d in range(table.shape[1] - 1, -1, -1):
            first = first * at + value
            value = value * at + table[piece, d, j]
        modes[LEVER, j] = (slope * value - half * first / length) / stretch
        modes[LIFT, j] = value
    return Here(piece, at, slope)


@lean(fastmath=FAST, error_model="numpy")
def set_reads(surface: Surface, piece: int, local: Array, x: float, half: float) -> None:
    """The deflection of every mode under the slider at x."""
    table, edges, modes = surface.table, surface.edges, surface.modes
    at = material(local, edges, piece, x, half)
    for j in range(modes.shape[1]):
        value = 0.0
        for d in range(table.shape[1] - 1, -1, -1):
            value = value * at + table[piece, d, j]
        modes[READ, j] = value


@lean(fastmath=FAST, error_model="numpy")
def _mobility(modes: Array, acts: int, turn: int) -> float:
    """Tangential speed of the surface after a constant unit force has acted for half a step or a whole one, m/s per N.

    `acts` is the row of the force's levers.
    """
    total = 0.0
    for j in range(modes.shape[1]):
        total += modes[LEVER, j] * modes[acts, j] * modes[turn, j] / modes[OMEGA, j]
    return total


@lean(fastmath=FAST, error_model="numpy")
def _compliance(modes: Array, acts: int) -> float:
    """How far a constant unit force lifts the surface under the slider in a step, m/N."""
    total = 0.0
    for j in range(modes.shape[1]):
        decay, omega = modes[SIGMA, j], modes[OMEGA, j]
        gain = 1.0 - modes[FULL_RE, j] - modes[FULL_IM, j] * decay / omega
        total += modes[READ, j] * modes[acts, j] * gain / (omega * omega + decay * decay)
    return total


@lean(fastmath=FAST, error_model="numpy")
def _press(force: float, acts: int, modes: Array) -> None:
    """Add what a constant force over the whole step adds to the modes: (1 - turn) about the shifted rest position."""
    for j in range(modes.shape[1]):
        decay, omega = modes[SIGMA, j], modes[OMEGA, j]
        real = force * modes[acts, j] / (omega * omega + decay * decay)
        imaginary = -real * decay / omega
        modes[Z_RE, j] += real - (modes[FULL_RE, j] * real - modes[FULL_IM, j] * imaginary)
        modes[Z_IM, j] += imaginary - (modes[FULL_RE, j] * imaginary + modes[FULL_IM, j] * real)


@lean(fastmath=FAST)
def _given_way(modes: Array, acts: int) -> float:
    """How far the free modes have moved the surface along a force's levers, metres."""
    total = 0.0
    for j in range(modes.shape[1]):
        total += modes[acts, j] * modes[Z_RE, j]
    return total


@lean()
def _reaction(dt: float, modes: Array, motion: Array, law: Law, seen: Array) -> tuple[float, float]:
    """The normal reaction, mean over a step, that keeps a slider with inertia on the surface.

    (N without a tangential force on the beam, what each newton of that adds.)
    Beam and slider move exactly under one constant force and meet at the end of the step. With fixed levers their
    energy is conserved, so that no step is unstable. Height and climb are the slider's own: what the point under it
    does along x (w' dx/dt and all convective terms) is in the height of the surface where it ends up.
    """
    stiff = 2.0 * law.mass / (dt * dt)
    own = 1.0 + stiff * _compliance(modes, LIFT)
    free = law.load + stiff * (seen[2, LEVEL] - motion[HEIGHT] - dt * motion[CLIMB])
    return free / own, stiff * _compliance(modes, LEVER) / own


@lean(error_model="numpy")
def _balance(v: float, stuck: bool, half: float, full: float, law: Law, dt: float, space: Space) -> float:
    """The contact force, newton, mean over the step, at which slider and beam agree: regula falsi (Illinois).

    The slider's impulse falls as the beam gives way, so there is one root between the limits of friction.
    """
    per = law.mass / dt
    high = 1.000001 * law.mass * max(law.kinetic, law.static)
    low = -high
    at_low = per * slip(v, stuck, -low, half, full, law, dt, space) - low
    at_high = per * slip(v, stuck, -high, half, full, law, dt, space) - high
    force = per * slip(v, stuck, 0.0, half, full, law, dt, space)
    for _ in range(60):
        force = min(max(force, low), high)
        miss = per * slip(v, stuck, -force, half, full, law, dt, space) - force
        if abs(miss) <= 1e-14 * (high - low) or abs(miss) <= 1e-15 * abs(force):
            break
        if miss > 0.0:
            low, at_low, at_high = force, miss, 0.5 * at_high
        else:
            high, at_high, at_low = force, miss, 0.5 * at_low
        force = (low * at_high - high * at_low) / (at_high - at_low)
    return float(force)


@lean()
def push_back(
    v: float, stuck: bool, dt: float, here: Here, surface: Surface, rider: Rider, space: Space
) -> tuple[float, float]:
    """Let slider and beam agree on the contact forces of a step and give them to the modes; their work on the beam.

    (Of friction, of the normal reaction), joules. The levers are those of mid-step, so that the forces are off by the
    square of the step.
    """
    modes, law, seen = surface.modes, rider.law, space.seen
    half, full = _mobility(modes, LEVER, HALF_IM), _mobility(modes, LEVER, FULL_IM)
    normal, per_push = 0.0, 0.0
    if law.held:
        normal, per_push = _reaction(dt, modes, rider.motion, law, seen)
        across_half, across = _mobility(modes, LIFT, HALF_IM), _mobility(modes, LIFT, FULL_IM)
        seen[1, SURFACE] -= normal * across_half
        seen[2, SURFACE] -= normal * across
        half, full = half - per_push * across_half, full - per_push * across
    force = _balance(v, stuck, half, full, law, dt, space)
    way = carried(space.local, surface.edges, here, law.half) - _given_way(modes, LEVER)
    climb = climbed(space.local, here.at) - _given_way(modes, LIFT) if law.held else 0.0
    if law.held:
        normal -= per_push * force
        _bear(normal, dt, modes, rider)
    _press(-force, LEVER, modes)
    seen[2, SURFACE] -= force * full
    lifted = -normal * (climb + _given_way(modes, LIFT)) if law.held else 0.0
    return -force * (way + _given_way(modes, LEVER)), lifted


@lean()
def _bear(normal: float, dt: float, modes: Array, rider: Rider) -> None:
    """Give a normal reaction to slider and beam."""
    motion, law = rider.motion, rider.law
    _press(-normal, LIFT, modes)
    gained = dt * (normal - law.load) / law.mass
    motion[HEIGHT] += dt * (motion[CLIMB] + 0.5 * gained)
    motion[CLIMB] += gained
    motion[NORMAL] = normal


@lean(inline="always")
def feel(dt: float, rider: Rider, seen: Array) -> None:
    """The slider's normal reaction and how fast the surface falls away under it, where it does not push back."""
    motion, law = rider.motion, rider.law
    lift = 4.0 * (seen[0, LEVEL] - 2.0 * seen[1, LEVEL] + seen[2, LEVEL]) / (dt * dt)
    motion[NORMAL] = law.load + (law.mass * lift if law.held else 0.0)
    motion[FALL] = max(motion[FALL], -lift)
