"""Acceleration of the planar chain of rigid links in O(N), absolute angles: articulated bodies, and a rolling tip.

State: absolute angles, their rates, energy lost in dashpots, work of loads and hub. Link i has the direction
e = (cos, sin) and the normal t = (-sin, cos). From the tip towards the base the chain beyond a joint that accelerates by
a needs the force B a + beta there, B a symmetric 2 x 2 mass: one link adds itself by a rank-one update (R. Featherstone,
Rigid Body Dynamics Algorithms, 2008, chapter 7, here in the frame of the base); from the base on follow the angular
accelerations. The roller's force is that which cancels the tip's acceleration across, by the response to a unit force
there. Its closure y_N = 0 is one dependent joint angle, that with the longest lever arm: all links beyond turn with it
(R. A. Wehage and E. J. Haug, J. Mech. Design 104 (1982) 247, the paper's ref. 6).
"""

from collections.abc import Sequence

import numpy as np

from verify.arrays import Array
from verify.chain.kinematics import hub
from verify.chain.runge_kutta import ACCELERATION
from verify.chain.system import ChainState, ChainSystem, circular
from verify.jit import FAST, inline, jit

HALF, MASS_X, MASS_Y, INERTIA, SPRING, DASHPOT, WEIGHT_X, WEIGHT_Y = range(8)
"""Columns of `links`, (N, 8): half length, mass that resists along x and y, inertia, joint, weight."""
ARM, FX, FY, MOMENT, OMEGA, PHASE, LINK = range(7)
"""Columns of `loads`, (n_loads, 7): a load on link 0..N-1, its arm from the middle; times cos(omega t + phase)."""
OFFSET, RATE, SWING, SWING_OMEGA, SWING_PHASE, ROLLER, TIP_SPRING, PIVOT, LENGTH = range(9)
"""Entries of `numbers`: rotation of the hub, roller, axial spring there, dependent joint; length."""
COS, SIN, TORQUE, FORCE_X, FORCE_Y, INWARD, VX, VY, GAIN_X, GAIN_Y, MOBILITY, UNIT = range(12)
"""Columns of `scratch`, (N + 1, 12); `UNIT` ends as the accelerations per force of the roller, the last the tip's."""
SHORT_ARM = 0.1
"""A dependent joint is exchanged where its lever arm falls below this part of the chain."""


@inline(fastmath=FAST)
def place(theta: Array, omega: Array, links: Array, pivot: int, w: Array) -> tuple[float, float, float, float, float, float]:
    """Cosines and sines; the tip's y and its rate due to links before `pivot`, x, y, and their rates due to the others.

    Below 0.5 rad by their series, at a third of the time.
    """
    n, largest = theta.size, 0.0
    for i in range(n):
        largest = max(largest, abs(theta[i]))
    small, x, y, vx, vy, rise, climb = largest <= 0.5, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0
    for i in range(n):
        if small:
            z = theta[i] * theta[i]
            p = 1 / 40320 - z * (1 / 3628800 - z * (1 / 479001600 - z / 87178291200))
            q = 1 / 362880 - z * (1 / 39916800 - z * (1 / 6227020800 - z / 1307674368000))
            c = 1.0 - z * (0.5 - z * (1 / 24 - z * (1 / 720 - z * p)))
            s = theta[i] * (1.0 - z * (1 / 6 - z * (1 / 120 - z * (1 / 5040 - z * q))))
        else:
            c, s = np.cos(theta[i]), np.sin(theta[i])
        w[i, COS], w[i, SIN] = c, s
        if i == pivot:
            rise, climb, x, y, vx, vy = y, vy, 0.0, 0.0, 0.0, 0.0
        length = 2.0 * links[i, HALF]
        swing = length * omega[i]
        x, y, vx, vy = x + length * c, y + length * s, vx - swing * s, vy + swing * c
    return rise, climb, x, y, vx, vy


@inline(fastmath=FAST)
def close(theta: Array, omega: Array, links: Array, numbers: Array, w: Array) -> tuple[float, float]:
    """Turn of the links beyond the dependent joint, and change of their rates, by which the tip stays on y = 0."""
    rise, climb, x, y, vx, vy = place(theta, omega, links, int(numbers[PIVOT]), w)
    if abs(x) < SHORT_ARM * numbers[LENGTH]:
        arm, longest = 0.0, 0.0
        for i in range(theta.size - 1, -1, -1):
            arm += 2.0 * links[i, HALF] * w[i, COS]
            if abs(arm) > longest:
                longest, numbers[PIVOT] = abs(arm), i
        rise, climb, x, y, vx, vy = place(theta, omega, links, int(numbers[PIVOT]), w)
    angle = np.arcsin(-rise / np.sqrt(x * x + y * y))
    turn = (angle if x > 0.0 else np.pi - angle) - np.arctan2(y, x)
    turn -= 2.0 * np.pi * np.round(turn / (2.0 * np.pi))
    c, s = np.cos(turn), np.sin(turn)
    return turn, -(climb + c * vy + s * vx) / (c * x - s * y)


@inline(fastmath={"contract"})
def from_tip(links: Array, pull: float, w: Array, out: Array) -> None:
    """Gains, free and unit terms of all links from directions, torques, forces and inward accelerations in `w`.

    `pull` is a force along x at the tip.
    """
    b11, b12, b22, f1, f2, r1, r2 = 0.0, 0.0, 0.0, -pull, 0.0, 0.0, -1.0
    for i in range(links.shape[0] - 1, -1, -1):
        c, s, h, mx, my, u = w[i, COS], w[i, SIN], links[i, HALF], links[i, MASS_X], links[i, MASS_Y], w[i, INWARD]
        hs, hc = 2.0 * h * s, 2.0 * h * c
        # the recursion is as long as its latency: three fused products, a division, another product
        own = links[i, INERTIA] + 0.25 * (mx * hs * hs + my * hc * hc)
        g = 1.0 / (own + b11 * (hs * hs) - b12 * (2.0 * hs * hc) + b22 * (hc * hc))
        u1, u2 = b12 * hc - b11 * hs - 0.5 * mx * hs, b22 * hc - b12 * hs + 0.5 * my * hc
        # bias at the far joint, and forces with those of inertia, by the inward acceleration
        f1, f2 = f1 - 2.0 * u * (b11 * c + b12 * s), f2 - 2.0 * u * (b12 * c + b22 * s)
        p1, p2 = w[i, FORCE_X] + u * mx * c, w[i, FORCE_Y] + u * my * s
        free = g * (w[i, TORQUE] + hc * (0.5 * p2 - f2) - hs * (0.5 * p1 - f1))
        unit = g * (hs * r1 - hc * r2)
        w[i, GAIN_X], w[i, GAIN_Y], w[i, MOBILITY], w[i, UNIT], out[i] = g * u1, g * u2, g, unit, free
        b11, b12, b22 = b11 + mx - g * (u1 * u1), b12 - g * (u1 * u2), b22 + my - g * (u2 * u2)
        f1, f2, r1, r2 = f1 - p1 + u1 * free, f2 - p2 + u2 * free, r1 + u1 * unit, r2 + u2 * unit


@inline(fastmath={"contract"})
def from_base(links: Array, roller: bool, w: Array, out: Array) -> None:
    """Angular accelerations, (N,), from the terms of `from_tip`; those per unit force at the tip remain in `w`."""
    a1, a2, r1, r2 = 0.0, 0.0, 0.0, 0.0
    n = out.size
    for i in range(n):
        c, s, length, inward = w[i, COS], w[i, SIN], 2.0 * links[i, HALF], 2.0 * w[i, INWARD]
        free = out[i] - w[i, GAIN_X] * a1 - w[i, GAIN_Y] * a2
        unit = w[i, UNIT] - w[i, GAIN_X] * r1 - w[i, GAIN_Y] * r2
        out[i], w[i, UNIT] = free, unit
        a1, a2 = a1 - inward * c - free * (length * s), a2 - inward * s + free * (length * c)
        r1, r2 = r1 - unit * (length * s), r2 + unit * (length * c)
    if roller:
        w[n, UNIT] = r2
        for i in range(n):
            out[i] -= a2 / r2 * w[i, UNIT]


@jit(signature_or_function=ACCELERATION, no_cfunc_wrapper=False, fastmath=FAST)
def accelerate(t: float, y: Array, out: Array, links: Array, loads: Array, numbers: Array, w: Array) -> None:
    """Derivatives of rates, dissipation and work into out[N:], after the closure of a rolling tip (see `runge_kutta`)."""
    n = links.shape[0]
    theta, omega, roller, pivot = y[:n], y[n : 2 * n], numbers[ROLLER] > 0.0, 0
    turn, change = 0.0, 0.0
    if roller:
        turn, change = close(theta, omega, links, numbers, w)
        pivot = int(numbers[PIVOT])
    else:
        place(theta, omega, links, n, w)
    cos_turn, sin_turn = np.cos(turn), np.sin(turn)
    phase = numbers[SWING_OMEGA] * t + numbers[SWING_PHASE]
    angle = numbers[OFFSET] + numbers[RATE] * t + numbers[SWING] * np.sin(phase)
    rate = numbers[RATE] + numbers[SWING] * numbers[SWING_OMEGA] * np.cos(phase)
    lost, power, vx, vy, moment, pull = 0.0, 0.0, 0.0, 0.0, 0.0, 0.0
    power = -rate * (links[0, SPRING] * (theta[0] - angle) + links[0, DASHPOT] * (omega[0] - rate))
    for i in range(n):
        if i >= pivot:
            c, s = w[i, COS], w[i, SIN]
            w[i, COS], w[i, SIN] = cos_turn * c - sin_turn * s, sin_turn * c + cos_turn * s
            theta[i] += turn
            omega[i] += change
        turning = omega[i] - rate
        after = -links[i, SPRING] * (theta[i] - angle) - links[i, DASHPOT] * turning
        lost += links[i, DASHPOT] * turning * turning
        w[i - 1, TORQUE] = moment - after
        angle, rate, moment = theta[i], omega[i], after
        swing = links[i, HALF] * rate
        w[i, FORCE_X], w[i, FORCE_Y], w[i, INWARD] = links[i, WEIGHT_X], links[i, WEIGHT_Y], swing * rate
        w[i, VX], w[i, VY] = vx, vy
        vx, vy = vx - 2.0 * swing * w[i, SIN], vy + 2.0 * swing * w[i, COS]
    w[n - 1, TORQUE] = moment
    for k in range(loads.shape[0]):
        i, now = int(loads[k, LINK]), np.cos(loads[k, OMEGA] * t + loads[k, PHASE])
        fx, fy, c, s = now * loads[k, FX], now * loads[k, FY], w[i, COS], w[i, SIN]
        torque, swing = now * loads[k, MOMENT] + loads[k, ARM] * (c * fy - s * fx), links[i, HALF] * omega[i]
        power += fx * (w[i, VX] - swing * s) + fy * (w[i, VY] + swing * c) + torque * omega[i]
        w[i, FORCE_X] += fx
        w[i, FORCE_Y] += fy
        w[i, TORQUE] += torque
    if numbers[TIP_SPRING] > 0.0:
        for i in range(n):  # 1 - cos without cancellation
            c, s = w[i, COS], w[i, SIN]
            pull += numbers[TIP_SPRING] * 2.0 * links[i, HALF] * (s * s / (1.0 + c) if c > 0.0 else 1.0 - c)
    from_tip(links, pull, w, out[n : 2 * n])
    from_base(links, roller, w, out[n : 2 * n])
    out[2 * n], out[2 * n + 1] = lost, power


@jit(fastmath=FAST)
def respond(link: int, arm: float, fx: float, fy: float, links: Array, numbers: Array, w: Array, out: Array) -> None:
    """Angular accelerations, (N,), that a force at a point of a link adds at the state of the last `accelerate`.

    `link` from 0, `arm` from its middle, m; per newton a column of the Delassus operator by `point_acceleration`.
    """
    n = out.size
    f1, f2, a1, a2 = 0.0, 0.0, 0.0, 0.0
    for i in range(n):
        out[i] = 0.0
    for i in range(link, -1, -1):
        reach, p1, p2 = (links[i, HALF] + arm, fx, fy) if i == link else (2.0 * links[i, HALF], -f1, -f2)
        torque = reach * (w[i, COS] * p2 - w[i, SIN] * p1)
        out[i] = w[i, MOBILITY] * torque
        f1, f2 = w[i, GAIN_X] * torque - p1, w[i, GAIN_Y] * torque - p2
    for i in range(n):
        out[i] -= w[i, GAIN_X] * a1 + w[i, GAIN_Y] * a2
        swing = 2.0 * links[i, HALF] * out[i]
        a1, a2 = a1 - swing * w[i, SIN], a2 + swing * w[i, COS]
    if numbers[ROLLER] > 0.0:
        for i in range(n):
            out[i] -= a2 / w[n, UNIT] * w[i, UNIT]


@jit(fastmath=FAST)
def point_acceleration(link: int, arm: float, alpha: Array, links: Array, w: Array) -> tuple[float, float]:
    """Acceleration of a point, m/s^2, by angular accelerations of the links, without that of their rates."""
    x, y = 0.0, 0.0
    for i in range(link + 1):
        swing = (2.0 * links[i, HALF] if i < link else links[i, HALF] + arm) * alpha[i]
        x, y = x - swing * w[i, SIN], y + swing * w[i, COS]
    return x, y


def flatten(system: ChainSystem) -> tuple[Array, Array, Array, Array]:
    """(links, loads, numbers, scratch) of a chain, the data of `accelerate`."""
    half, turn, masses, n = system.lengths / 2.0, system.rotation, system.masses, system.n_links
    weights = [component * masses for component in system.gravity]
    own = [half, masses * system.axial_inertia, masses, system.inertias, system.stiffness, system.dashpots, *weights]
    loads = [
        (p.at - half[p.link - 1], *p.force, p.moment, circular(p.frequency_hz), np.deg2rad(p.phase_deg), p.link - 1)
        for p in system.loads
    ]
    swing = (turn.amplitude, circular(turn.frequency_hz), np.deg2rad(turn.phase_deg))
    numbers = (turn.offset, turn.rate, *swing, system.tip == "roller", system.axial_spring, 0.0, system.length)
    return (
        np.array(np.stack(own, axis=1), dtype=float, order="C"),
        np.array(loads, dtype=float).reshape(len(loads), 7),
        np.array(numbers, dtype=float),
        np.zeros((n + 1, UNIT + 1)),
    )


def absolute(system: ChainSystem, state: ChainState) -> Array:
    """The march's state, (2 N + 2,), of relative angles and rates."""
    angle, rate = hub(system.rotation, state.time)
    return np.concatenate([angle + np.cumsum(state.angles), rate + np.cumsum(state.rates), [0.0, 0.0]])


def accelerations(system: ChainSystem, state: ChainState) -> Array:
    """Relative angular accelerations, (N,), rad/s^2, at a state that meets the roller."""
    y, turn = absolute(system, state), system.rotation
    out = np.zeros_like(y)
    accelerate(state.time, y, out, *flatten(system))
    omega = circular(turn.frequency_hz)
    base = -turn.amplitude * omega**2 * np.sin(omega * state.time + np.deg2rad(turn.phase_deg))
    return np.diff(out[system.n_links : -2], prepend=base)


def delassus(system: ChainSystem, state: ChainState, points: Sequence[tuple[int, float]]) -> Array:
    """Accelerations of points per force at them, (2 m, 2 m), 1/kg; x and y of each point, symmetric.

    A point is its link, 1..N, and metres from the link's near joint.
    """
    y, model = absolute(system, state), flatten(system)
    accelerate(state.time, y, np.zeros_like(y), *model)
    links, _, numbers, w = model
    places = [(link - 1, at - float(links[link - 1, HALF])) for link, at in points]
    alpha, columns = np.zeros(system.n_links), []
    for link, arm in places:
        for force in ((1.0, 0.0), (0.0, 1.0)):
            respond(link, arm, *force, links, numbers, w, alpha)
            columns.append([part for to in places for part in point_acceleration(*to, alpha, links, w)])
    return np.array(columns).T
