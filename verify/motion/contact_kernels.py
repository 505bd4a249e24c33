"""The compiled contact of a slider that the beam feels: what forces do to the modes, and how both sides agree."""

import numpy as np

from verify.arrays import Array
from verify.jit import FAST, inline
from verify.motion import records as rec
from verify.motion.friction_kernels import hold, slip
from verify.motion.records import Here, Law, Rider, Space, Surface
from verify.motion.surface_kernels import carried, climbed, material


@inline(fastmath=FAST)
def set_levers(surface: Surface, piece: int, local: Array, x: float, half: float) -> Here:
    """How unit forces on the surface at x load every mode: a tangential one -(h/2) on its slope, w' on its rise.

    A normal one lifts what stands at x: the surface rises there, and slides under it by (h/2) of the turn over x, on a
    rise of w'. It is square to the surface so: what acts straight up would make energy of that sliding.
    """
    table, edges, modes = surface.table, surface.edges, surface.modes
    length = edges[piece + 1] - edges[piece]
    at = material(local, edges, piece, x, half)
    slope, deflection = 0.0, 0.0
    for d in range(table.shape[1] - 1, -1, -1):
        slope = slope * at + deflection
        deflection = deflection * at + local[rec.STILL, d]
    slope /= length
    stretch, above = np.sqrt(1.0 + slope * slope), (x - edges[piece]) / length
    lean = slope * half / length
    for j in range(modes.shape[1]):
        value, first, here, turn = 0.0, 0.0, 0.0, 0.0
        for d in range(table.shape[1] - 1, -1, -1):
            first = first * at + value
            value = value * at + table[piece, d, j]
            turn = turn * above + here
            here = here * above + table[piece, d, j]
        modes[rec.LEVER, j] = (slope * value - half * first / length) / stretch
        modes[rec.LIFT, j] = value + lean * turn
    return Here(piece, at, above, slope)


@inline(fastmath=FAST)
def set_reads(surface: Surface, piece: int, local: Array, x: float, half: float) -> None:
    """How far every mode lifts the slider at x, with what slides under it."""
    table, edges, modes = surface.table, surface.edges, surface.modes
    length = edges[piece + 1] - edges[piece]
    at = material(local, edges, piece, x, half)
    slope, deflection = 0.0, 0.0
    for d in range(table.shape[1] - 1, -1, -1):
        slope = slope * at + deflection
        deflection = deflection * at + local[rec.STILL, d]
    above, lean = (x - edges[piece]) / length, slope * half / (length * length)
    for j in range(modes.shape[1]):
        value, here, turn = 0.0, 0.0, 0.0
        for d in range(table.shape[1] - 1, -1, -1):
            value = value * at + table[piece, d, j]
            turn = turn * above + here
            here = here * above + table[piece, d, j]
        modes[rec.READ, j] = value + lean * turn


@inline(fastmath=FAST)
def _mobilities(modes: Array) -> tuple[float, float, float, float]:
    """Tangential speed of the surface after a constant unit force has acted for half a step and a whole one, m/s per N.

    (Of a tangential force, half and whole, of a normal one, half and whole.)
    """
    half, full, across_half, across = 0.0, 0.0, 0.0, 0.0
    for j in range(modes.shape[1]):
        lever, omega = modes[rec.LEVER, j], modes[rec.OMEGA, j]
        lift = modes[rec.LIFT, j]
        half += lever * lever * modes[rec.HALF_IM, j] / omega
        full += lever * lever * modes[rec.FULL_IM, j] / omega
        across_half += lever * lift * modes[rec.HALF_IM, j] / omega
        across += lever * lift * modes[rec.FULL_IM, j] / omega
    return half, full, across_half, across


@inline(fastmath=FAST)
def _compliances(modes: Array) -> tuple[float, float]:
    """How far constant unit forces lift the surface under the slider in a step, a normal and a tangential one, m/N."""
    by_normal, by_push = 0.0, 0.0
    for j in range(modes.shape[1]):
        decay, omega = modes[rec.SIGMA, j], modes[rec.OMEGA, j]
        gain = 1.0 - modes[rec.FULL_RE, j] - modes[rec.FULL_IM, j] * decay / omega
        lifted = modes[rec.READ, j] * gain / (omega * omega + decay * decay)
        by_normal += modes[rec.LIFT, j] * lifted
        by_push += modes[rec.LEVER, j] * lifted
    return by_normal, by_push


@inline(fastmath=FAST)
def _press(along: float, across: float, modes: Array) -> None:
    """Add what constant forces over the whole step add to the modes: (1 - turn) about the shifted rest position."""
    for j in range(modes.shape[1]):
        decay, omega = modes[rec.SIGMA, j], modes[rec.OMEGA, j]
        real = (along * modes[rec.LEVER, j] + across * modes[rec.LIFT, j]) / (omega * omega + decay * decay)
        imaginary = -real * decay / omega
        modes[rec.Z_RE, j] += real - (modes[rec.FULL_RE, j] * real - modes[rec.FULL_IM, j] * imaginary)
        modes[rec.Z_IM, j] += imaginary - (modes[rec.FULL_RE, j] * imaginary + modes[rec.FULL_IM, j] * real)


@inline(fastmath=FAST)
def _given_ways(modes: Array) -> tuple[float, float]:
    """How far the free modes have moved the surface along the levers of a tangential force and of a normal one."""
    along, across = 0.0, 0.0
    for j in range(modes.shape[1]):
        along += modes[rec.LEVER, j] * modes[rec.Z_RE, j]
        across += modes[rec.LIFT, j] * modes[rec.Z_RE, j]
    return along, across


@inline
def _reaction(dt: float, modes: Array, motion: Array, law: Law, seen: Array) -> tuple[float, float]:
    """The normal reaction, mean over a step, that keeps a slider with inertia on the surface.

    (N without a tangential force on the beam, what each newton of that adds.)
    Beam and slider move exactly under one constant force and meet at the end of the step. With fixed levers their
    energy is conserved, so that no step is unstable. Height and climb are the slider's own: what the point under it
    does along x (w' dx/dt and all convective terms) is in the height of the surface where it ends up.
    """
    stiff = 2.0 * law.mass / (dt * dt)
    by_normal, by_push = _compliances(modes)
    own = 1.0 + stiff * by_normal
    free = law.load + stiff * (seen[2, rec.LEVEL] - motion[rec.HEIGHT] - dt * motion[rec.CLIMB])
    return free / own, stiff * by_push / own


@inline
def _balance(
    v: float, stuck: bool, half: float, full: float, static: float | None, law: Law, dt: float, space: Space
) -> float:
    """The contact force, newton, mean over the step, at which slider and beam agree: regula falsi (Illinois).

    The slider's impulse falls as the beam gives way, so there is one root between the limits of friction.
    """
    per = law.mass / dt
    most = law.kinetic
    if static is not None:
        if stuck:
            return per * hold(v, full, static, law, dt, space.seen, space.slip)
        most = static if static > most else most
    high = 1.000001 * law.mass * most
    low = -high
    at_low = per * slip(v, stuck, -low, half, full, static, law, dt, space) - low
    at_high = per * slip(v, stuck, -high, half, full, static, law, dt, space) - high
    force = per * slip(v, stuck, 0.0, half, full, static, law, dt, space)
    for _ in range(60):
        force = low if low > force else force
        force = high if high < force else force
        miss = per * slip(v, stuck, -force, half, full, static, law, dt, space) - force
        if abs(miss) <= 1e-14 * (high - low) or abs(miss) <= 1e-15 * abs(force):
            break
        if miss > 0.0:
            low, at_low, at_high = force, miss, 0.5 * at_high
        else:
            high, at_high, at_low = force, miss, 0.5 * at_low
        force = (low * at_high - high * at_low) / (at_high - at_low)
    return float(force)


@inline
def push_back(
    v: float, stuck: bool, dt: float, here: Here, surface: Surface, rider: Rider, space: Space
) -> tuple[float, float]:
    """Let slider and beam agree on the contact forces of a step and give them to the modes; their work on the beam.

    (Of friction, of the normal reaction), joules; the surface's speeds have what the forces add to them. The levers are
    those of mid-step, so that the forces are off by the square of the step.
    """
    modes, law, seen = surface.modes, rider.law, space.seen
    half, full, across_half, across = _mobilities(modes)
    normal, per_push = 0.0, 0.0
    if law.held:
        normal, per_push = _reaction(dt, modes, rider.motion, law, seen)
        seen[1, rec.SURFACE] -= normal * across_half
        seen[2, rec.SURFACE] -= normal * across
        half, full = half - per_push * across_half, full - per_push * across
    force = _balance(v, stuck, half, full, law.static, law, dt, space)
    along, up = _given_ways(modes)
    way, climb = carried(space.local, surface.edges, here, law.half) - along, 0.0
    if law.held:
        climb = climbed(space.local, surface.edges, here, law.half) - up
        normal -= per_push * force
        _bear(normal, dt, rider)
    _press(-force, -normal, modes)
    seen[1, rec.SURFACE] -= force * half
    seen[2, rec.SURFACE] -= force * full
    along, up = _given_ways(modes)
    return -force * (way + along), -normal * (climb + up)


@inline
def _bear(normal: float, dt: float, rider: Rider) -> None:
    """Give a normal reaction to the slider."""
    motion, law = rider.motion, rider.law
    gained = dt * (normal - law.load) / law.mass
    motion[rec.HEIGHT] += dt * (motion[rec.CLIMB] + 0.5 * gained)
    motion[rec.CLIMB] += gained
    motion[rec.NORMAL] = normal


@inline
def feel(dt: float, motion: Array, law: Law, seen: Array) -> None:
    """The slider's normal reaction and how fast the surface falls away under it, where it does not push back."""
    lift = 4.0 * (seen[0, rec.LEVEL] - 2.0 * seen[1, rec.LEVEL] + seen[2, rec.LEVEL]) / (dt * dt)
    motion[rec.NORMAL] = law.load + (law.mass * lift if law.held else 0.0)
    motion[rec.FALL] = -lift if -lift > motion[rec.FALL] else motion[rec.FALL]
