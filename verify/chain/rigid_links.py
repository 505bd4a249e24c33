"""Acceleration of the planar chain of rigid links in O(N): absolute angles, articulated bodies, a rolling tip.

State: absolute angles, their rates, energy lost in dashpots, work of loads and hub. A link has the direction (cos, sin)
and the normal t = (-sin, cos). A joint with the acceleration a takes the force B a + beta from the chain beyond it, B a
symmetric 2 x 2 mass; from the tip towards the base every link adds itself by a rank-one update, and from the base on
follow the angular accelerations (R. Featherstone, Rigid Body Dynamics Algorithms, 2008, chapter 7, in the frame of the
base). The roller's force cancels the tip's acceleration across, by the response to a unit force there. The closure
y_N = 0 is met in every stage by one dependent joint angle, that with the longest lever arm: the links beyond turn as
one (R. A. Wehage and E. J. Haug, J. Mech. Design 104 (1982) 247, the paper's ref. 6).
"""

import numpy as np

from verify.arrays import Array
from verify.chain.kinematics import place
from verify.chain.runge_kutta import ACCELERATION, Model
from verify.chain.system import ChainState, ChainSystem
from verify.errors import InputError
from verify.jit import FAST, inline, jit
from verify.problem.base_motion import FIXED

HALF, MASS_X, MASS_Y, INERTIA, SKEW, SPRING, DASHPOT, WEIGHT_X, WEIGHT_Y, BY_SPIN, BY_PULL = range(11)
"""Columns of `links`, (N, 11): half length, mass for x and y, inertia J + h^2 m_y about an end, (m_x - m_y)/4, joint,
weight, stiffness that a joint loses per square of the hub's rate and per acceleration along the straight chain."""
ARM, FX, FY, MOMENT, OMEGA, PHASE, LINK = range(7)
"""Columns of `loads`, (n_loads, 7): link 0..N-1, arm from its middle, load, which is times cos(omega t + phase)."""
PIECE, ROLLER, TIP_SPRING, PIVOT, LENGTH, HUB_RADIUS, FOLLOWS, GRAVITY_X, GRAVITY_Y = range(9)
"""Entries of `numbers`: duration of a piece of `base`, roller, its axial spring, dependent joint, length, radius,
whether joints follow the axial force, gravity."""
COS, SIN, TORQUE, FORCE_X, FORCE_Y, VX, VY, GAIN_X, GAIN_Y, MOBILITY, UNIT = range(11)
"""Columns of `scratch`, (N + 1, 11); `UNIT` ends as accelerations per force of the roller, the last the tip's."""
TINY = 1e-250
"""Forces below this are zero: they fall by 0.27 a link, and subnormal numbers take a hundred times as long."""
CHECKED = 129  # instants of a run at which joints that follow the axial force keep a stiffness
SHORT_ARM = 0.1  # lever arm of the dependent joint over the chain's length below which another joint becomes dependent
Tip = tuple[float, float, float, float, float, float]


@inline(fastmath=FAST)
def directions(theta: Array, omega: Array, links: Array, pivot: int, w: Array) -> Tip:
    """Write cosines and sines of links; return the tip's y and its rate due to links before and after `pivot`."""
    n, largest = theta.size, 0.0
    for i in range(n):
        largest = max(largest, abs(theta[i]))
    small, x, y, vx, vy, tip_y, tip_rate = largest <= 0.4, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0
    for i in range(n):
        if small:  # series to rounding, at a third of the time
            z = theta[i] * theta[i]
            p = 1 / 720 - z * (1 / 40320 - z * (1 / 3628800 - z / 479001600))
            q = 1 / 5040 - z * (1 / 362880 - z * (1 / 39916800 - z / 6227020800))
            c, s = 1.0 - z * (0.5 - z * (1 / 24 - z * p)), theta[i] * (1.0 - z * (1 / 6 - z * (1 / 120 - z * q)))
        else:
            c, s = np.cos(theta[i]), np.sin(theta[i])
        w[i, COS], w[i, SIN] = c, s
        if i == pivot:
            tip_y, tip_rate, x, y, vx, vy = y, vy, 0.0, 0.0, 0.0, 0.0
        length = 2.0 * links[i, HALF]
        swing = length * omega[i]
        x, y, vx, vy = x + length * c, y + length * s, vx - swing * s, vy + swing * c
    return tip_y, tip_rate, x, y, vx, vy


@inline(fastmath={"contract"})
def close(tip: Tip, links: Array, numbers: Array, w: Array) -> tuple[float, float, float, float]:
    """Rotation of the links beyond the dependent joint that closes the chain, change of their rate, cosine and sine."""
    if not numbers[ROLLER] > 0.0:
        return 0.0, 0.0, 1.0, 0.0
    tip_y, tip_rate, x, y, vx, vy = tip
    if abs(x) < SHORT_ARM * numbers[LENGTH]:
        arm, longest = 0.0, 0.0
        for i in range(links.shape[0] - 1, -1, -1):
            arm += 2.0 * links[i, HALF] * w[i, COS]
            if abs(arm) > longest:
                longest, numbers[PIVOT] = abs(arm), i
    # the links after the dependent joint end at -tip_y from it, on their present side
    square, along = x * x + y * y, np.copysign(np.sqrt(x * x + y * y - tip_y * tip_y), x)
    c, s = (along * x - tip_y * y) / square, -(tip_y * x + along * y) / square
    turn = s * (1.0 + s * s / 6.0) if abs(s) < 1e-3 else np.arctan2(s, c)
    return turn, -(tip_rate + c * vy + s * vx) / along, c, s


@inline(fastmath={"contract"})
def from_tip(links: Array, pull: float, w: Array, out: Array) -> None:
    """Backward recursion: gains, free and unit terms of the links, from torques and forces in `w` and a tip force."""
    b11, b12, b22, f1, f2, r1, r2 = 0.0, 0.0, 0.0, -pull, 0.0, 0.0, -1.0
    for i in range(links.shape[0] - 1, -1, -1):
        hs, hc = 2.0 * links[i, HALF] * w[i, SIN], 2.0 * links[i, HALF] * w[i, COS]
        mx, my, p1, p2, ss = links[i, MASS_X], links[i, MASS_Y], w[i, FORCE_X], w[i, FORCE_Y], hs * hs
        # the latency of the recursion limits speed: three fused products, a division, another product
        own = links[i, INERTIA] + links[i, SKEW] * ss
        g = 1.0 / ((own + b11 * ss) + (b22 * (hc * hc) - b12 * (2.0 * hs * hc)))
        u1, u2 = b12 * hc - (b11 + 0.5 * mx) * hs, (b22 + 0.5 * my) * hc - b12 * hs
        free = g * (w[i, TORQUE] + hc * (0.5 * p2 - f2) - hs * (0.5 * p1 - f1))
        unit = g * (hs * r1 - hc * r2)
        w[i, GAIN_X], w[i, GAIN_Y], w[i, MOBILITY], w[i, UNIT], out[i] = g * u1, g * u2, g, unit, free
        b11, b12, b22 = b11 + mx - g * (u1 * u1), b12 - g * (u1 * u2), b22 + my - g * (u2 * u2)
        f1, f2, r1, r2 = f1 - p1 + u1 * free, f2 - p2 + u2 * free, r1 + u1 * unit, r2 + u2 * unit
        if i & 63 == 0:
            r1, r2 = (0.0, 0.0) if abs(r1) + abs(r2) < TINY else (r1, r2)
            f1, f2 = (0.0, 0.0) if abs(f1) + abs(f2) < TINY else (f1, f2)


@inline(fastmath={"contract"})
def from_base(links: Array, roller: bool, drift: float, w: Array, out: Array) -> None:
    """Forward recursion: angular accelerations, (N,), from the terms of `from_tip`; those per unit tip force in `w`.

    `drift` is the tip's transverse acceleration due to the present rates.
    """
    a1, a2, r1, r2 = 0.0, 0.0, 0.0, 0.0
    n = out.size
    for i in range(n):
        hs, hc = 2.0 * links[i, HALF] * w[i, SIN], 2.0 * links[i, HALF] * w[i, COS]
        free = out[i] - w[i, GAIN_X] * a1 - w[i, GAIN_Y] * a2
        unit = w[i, UNIT] - w[i, GAIN_X] * r1 - w[i, GAIN_Y] * r2
        out[i], w[i, UNIT] = free, unit
        a1, a2, r1, r2 = a1 - free * hs, a2 + free * hc, r1 - unit * hs, r2 + unit * hc
    if roller:
        w[n, UNIT], force = r2, (a2 + drift) / r2
        for i in range(n):
            out[i] -= force * w[i, UNIT]


@inline(fastmath={"contract"})
def move_hub(t: float, numbers: Array, base: Array) -> tuple[float, float, float, float]:
    """Angle and rate of the hub at time t, and the acceleration of the joint on it along x and y."""
    piece = min(int(t / numbers[PIECE]), base.shape[0] - 1)
    s, p = t - piece * numbers[PIECE] if piece else t, base[piece]
    angle = p[0] + s * (p[1] + s * (p[2] + s * (p[3] + s * (p[4] + s * p[5]))))
    rate = p[1] + s * (2.0 * p[2] + s * (3.0 * p[3] + s * (4.0 * p[4] + s * 5.0 * p[5])))
    turn = 2.0 * p[2] + s * (6.0 * p[3] + s * (12.0 * p[4] + s * 20.0 * p[5]))
    ax, ay = p[6] + s * (p[7] + s * (p[8] + s * p[9])), p[10] + s * (p[11] + s * (p[12] + s * p[13]))
    if numbers[HUB_RADIUS] != 0.0:
        c, sine = numbers[HUB_RADIUS] * np.cos(angle), numbers[HUB_RADIUS] * np.sin(angle)
        ax, ay = ax - turn * sine - rate * rate * c, ay + turn * c - rate * rate * sine
    return angle, rate, ax, ay


@jit(signature_or_function=ACCELERATION, no_cfunc_wrapper=False, fastmath=FAST)
def accelerate(t: float, y: Array, out: Array, model: Model) -> None:
    """Write derivatives of rates, dissipation and work to out[N:], after the closure of a tip on a roller."""
    links, loads, numbers, w, base = model
    n = links.shape[0]
    theta, omega, roller, pivot = y[:n], y[n : 2 * n], numbers[ROLLER] > 0.0, int(numbers[PIVOT])
    turn, change, cos_turn, sin_turn = close(directions(theta, omega, links, pivot, w), links, numbers, w)
    angle, rate, hub_x, hub_y = move_hub(t, numbers, base)
    lost, vx, vy, ax, ay, moment, pull = 0.0, 0.0, 0.0, hub_x, hub_y, 0.0, 0.0
    square, outward, hub_rate, power = 0.0, 0.0, rate, 0.0
    if numbers[FOLLOWS] > 0.0:
        square, c, s = rate * rate, np.cos(angle), np.sin(angle)
        outward = (numbers[GRAVITY_X] - hub_x) * c + (numbers[GRAVITY_Y] - hub_y) * s
    for i in range(n):
        c, s = w[i, COS], w[i, SIN]
        if i >= pivot:
            c, s = cos_turn * c - sin_turn * s, sin_turn * c + cos_turn * s
            w[i, COS], w[i, SIN] = c, s
            theta[i] += turn
            omega[i] += change
        turning, bend = omega[i] - rate, theta[i] - angle
        softer = (square * links[i, BY_SPIN] + outward * links[i, BY_PULL]) * bend
        after = softer - links[i, SPRING] * bend - links[i, DASHPOT] * turning
        power += softer * turning + (hub_rate * after if i == 0 else 0.0)
        lost += links[i, DASHPOT] * turning * turning
        w[i - 1, TORQUE] = moment - after  # of i = 0 into the last row, which is set below
        angle, rate, moment = theta[i], omega[i], after
        # velocity of the near joint, and forces of inertia by the accelerations that belong to the rates
        swing = links[i, HALF] * rate
        along, across = swing * rate * c, swing * rate * s
        w[i, VX], w[i, VY] = vx, vy
        w[i, FORCE_X] = links[i, WEIGHT_X] - links[i, MASS_X] * (ax - along)
        w[i, FORCE_Y] = links[i, WEIGHT_Y] - links[i, MASS_Y] * (ay - across)
        power -= links[i, MASS_X] * hub_x * (vx - swing * s) + links[i, MASS_Y] * hub_y * (vy + swing * c)
        vx, vy, ax, ay = vx - 2.0 * swing * s, vy + 2.0 * swing * c, ax - 2.0 * along, ay - 2.0 * across
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
    from_base(links, roller, ay, w, out[n : 2 * n])
    out[2 * n], out[2 * n + 1] = lost, power


def flatten(system: ChainSystem, end: float = 0.0) -> Model:
    """The data of `accelerate` up to the time `end`, s, which a moving base needs."""
    half, masses, n = system.lengths / 2.0, system.masses, system.n_links
    weights = [component * masses for component in system.gravity]
    along = masses * system.axial_inertia
    inertia = [system.inertias + half**2 * masses, 0.25 * (along - masses)]
    losses = [np.zeros(n)] * 2
    if follows := len(system.softening) > 0:
        moments = masses * (system.nodes[:-1] + half), masses
        losses = [system.softening * np.cumsum(moment[::-1])[::-1] for moment in moments]
        softest = system.stiffness - system.softening * system.tension(np.linspace(0.0, end, CHECKED))
        if (softest[:, system.stiffness > 0.0] <= 0.0).any():
            raise InputError(f"count = {n}: the axial force leaves no stiffness in a joint, give more links")
    own = [half, along, masses, *inertia, system.stiffness, system.dashpots, *weights, *losses]
    loads = system.load_table
    loads[:, ARM] -= half[loads[:, LINK].astype(int)]
    if system.base is FIXED:
        base, piece = np.zeros((1, 14)), np.inf
        base[0, 1] = system.hub_rate
    else:
        base = system.base.table(end)
        piece = end / len(base)
    radius = system.base.hub_radius
    numbers = (piece, system.tip == "roller", system.axial_spring, 0.0, system.length, radius, follows, *system.gravity)
    return Model(
        np.array(np.stack(own, axis=1), dtype=float, order="C"),
        loads,
        np.array(numbers, dtype=float),
        np.zeros((n + 1, UNIT + 1)),
        base,
    )


def begin(system: ChainSystem, state: ChainState, numbers: Array) -> Array:
    """Initial state of the march, (2 N + 2,); the joint with the longest lever arm is dependent."""
    placed = place(system, state.time, state.angles, state.rates)
    numbers[PIVOT] = np.argmax(abs(placed.joints[-1, 0] - placed.joints[:-1, 0]))
    return np.concatenate([placed.directions, placed.rates, [0.0, 0.0]])
