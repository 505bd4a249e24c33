"""Checks of friction laws and of the nonlinear chain."""

from collections.abc import Callable
from functools import partial
from math import inf, tanh

import numpy as np

from verify.cases import roll_up
from verify.cases.creep import creep_speed, free_decay
from verify.chain.kinematics import at_rest
from verify.chain.motion import simulate, step_limit
from verify.chain.system import build_system
from verify.problem.slider import GRAVITY
from verify.stress.engine import check, worst
from verify.stress.reference import STRIP, D

SPEED, MU, SLOPE, STEPS = 0.1, 0.23, 310.0, 4096


def speed_left(slope: float, time: float) -> D:
    """Speed after a free slide with tanh friction: sinh(K v) = sinh(K v0) exp(-mu g K t), m/s."""
    k, start = D(slope), D(slope) * D(SPEED)
    rate = D(MU * GRAVITY) * k * D(time)
    if start - rate > 200:  # sinh is half an exponential to 1e-174
        return (start - rate) / k
    x = (start.exp() - (-start).exp()) / 2 * (-rate).exp() if start < 200 else (start - rate).exp() / 2
    return (x + (x * x + 1).sqrt()).ln() / k


def rk4_decay(slope: float, time: float) -> float:
    """Speed after a free slide by classical Runge-Kutta in 4096 steps, m/s."""
    v, h, limit = SPEED, time / STEPS, MU * GRAVITY
    for _ in range(STEPS):
        a = -limit * tanh(slope * v)
        b = -limit * tanh(slope * (v + 0.5 * h * a))
        c = -limit * tanh(slope * (v + 0.5 * h * b))
        v += h * (a + 2.0 * b + 2.0 * c - limit * tanh(slope * (v + h * c))) / 6.0
    return v


def decay_error(slope: float, method: Callable[[float, float], float]) -> float:
    """Error of the speed before and after the stop under Coulomb friction, over the initial speed."""
    times = [part * SPEED / (MU * GRAVITY) for part in (0.7, 1.3)]
    return worst([float(D(method(slope, t)) - speed_left(slope, t)) for t in times]) / SPEED


_RK4 = ("RK4 in 4096 steps", partial(decay_error, method=rk4_decay))


@check("friction-slope", "slope, s/m", (1e-3, 1.0, 1e3, 1e6, 1e9), 1e-10, beyond=(1e12, 1e15), baseline=_RK4)
def friction_slope(slope: float) -> float:
    """Speed after a free slide with tanh friction, viscous to step-like."""
    return decay_error(slope, lambda slope, time: free_decay(MU, slope, SPEED, time))


@check("friction-creep", "1 - F / (mu m g)", (0.9, 0.1, 1e-3, 1e-5, 2e-6), 1e-10, beyond=(1e-7, 1e-12), refused=True)
def friction_creep(left: float) -> float:
    """Creep speed under a force close to mu m g against artanh, error times the distance from mu m g."""
    force = (1.0 - left) * MU * GRAVITY
    share = D(force) / D(MU * GRAVITY)
    exact = ((1 + share) / (1 - share)).ln() / 2 / D(SLOPE)
    return left * abs(float(D(creep_speed(MU, SLOPE, force)) / exact - 1))


@check("chain-roll-up", "turns", (1, 5, 20), 1e-12, beyond=(40,))
def chain_roll_up(turns: float) -> float:
    """Gap of a cantilever of 100 links rolled into closed circles by an end moment, over its length."""
    return roll_up.gap("half", 100, turns)


@check("rk4-stability", "dt / limit", (0.1, 0.5, 0.9, 0.99), 1e-12, beyond=(1.01, 2.0), refused=True)
def rk4_stability(part: float) -> float:
    """Energy gain of a chain of 12 links, from scattered angles, in 2000 RK4 steps."""
    system = build_system(STRIP, 12)
    start = at_rest(system, 1e-7 * np.random.default_rng(3).standard_normal(12))
    step = part * step_limit(system)
    motion = simulate(system, start, [0.0, 2000 * step], step=step)
    kinetic, elastic, _ = motion.energies()
    total = kinetic + elastic
    return max(float(total[-1] / total[0]) - 1.0, 0.0) if motion.statistics.finished else inf
