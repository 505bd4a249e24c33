"""Checks of time steps, of friction laws, and of the nonlinear chain."""

from collections.abc import Sequence
from functools import cache
from math import asin, atan, exp, inf, pi, sin, sqrt, tanh
from typing import Any

import numpy as np

from verify.problem.beam import PointForce
from verify.problem.slider import GRAVITY, Slider
from verify.stress.engine import check, worst
from verify.stress.reference import STRIP, D, pinned_hertz

HERTZ, MODES = 731.0, 3
STEP = 1.0 / (64 * HERTZ)
ULP = 1.1e-16


def driven(steps: float, slope: float | None = None, mu: float = 0.23, samples: int = 2, **more: Any) -> Any:
    """The strip from rest under a force, in steps where it carries 3 mg with one-way coupling."""
    from verify.dynamics.simulate import simulate

    slider = None if slope is None else Slider(mass=3e-9, mu=mu, slope=slope, coupling="one-way")
    force, at = (PointForce(position=0.37 * STRIP.length, amplitude=1e-3),), [0.29 * STRIP.length]
    settings: dict[str, Any] = {"model": "analytic", "modes": MODES, "step": STEP if slider else None, "slider": slider}
    return simulate(STRIP, force, HERTZ, steps * STEP, **settings, at=at, samples=samples, **more)


@cache
def amplitude() -> float:
    """Largest deflection over 0.2 s, m."""
    return float(abs(driven(0.2 / STEP, samples=2001).deflection).max())


def central_error(steps: float) -> float:
    """Phase error of central differences in units of rounding per step: (omega dt)^3 / 24 a step."""
    turn = 2.0 * pi * float(pinned_hertz(STRIP, MODES)) * STEP
    lag = abs(2.0 * asin(0.5 * turn) - turn) * steps
    return 2.0 * abs(sin(min(0.5 * lag, 0.5 * pi))) / (ULP * steps)


_CENTRAL = ("central differences", central_error)


@check("time-stepping", "steps", (1e3, 1e4, 1e5, 1e6, 1e7), 1.0, slow=True, baseline=_CENTRAL)
def time_stepping(steps: float) -> float:
    """Modes advanced step by step against their closed form, error over 1.1e-16 per step."""
    stepped, closed = driven(steps, 310.0), driven(steps)
    error = abs(stepped.deflection[-1, 0] - closed.deflection[-1, 0])
    return float(error / (amplitude() * ULP * stepped.statistics.steps))


def imbalance(steps: float, slope: float = 310.0) -> float:
    """Energy missing from the balance of a slider on the driven strip, over input work and friction loss."""
    energy = driven(steps, slope).energy
    return float(abs(energy.residual) / (energy.friction_loss + energy.drive_work))


@check("energy-steps", "steps", (1e4, 1e6, 1e7), 1e-6, slow=True)
def energy_steps(steps: float) -> float:
    """Energy balance of a slider on the driven strip over many steps."""
    return imbalance(steps)


@check("energy-slope", "friction slope, s/m", (1.0, 1e3, 1e6, 1e9), 1e-6)
def energy_slope(slope: float) -> float:
    """Energy balance of a slider on the driven strip, 20 000 steps."""
    return imbalance(20_000, slope)


@check("friction-bound", "mu", (1e-6, 1.0, 1e3, 1e6), 1e-12)
def friction_bound(mu: float) -> float:
    """Excess of the friction force over mu m g and of the displacement over what it can cause, slope 1e9 s/m."""
    run, limit = driven(20_000, 1e9, mu), mu * GRAVITY
    reach = 0.5 * limit * float(run.times[-1]) ** 2
    return max(worst(run.friction) / (3e-9 * limit) - 1.0, worst(run.travelled) / reach - 1.0, 0.0)


SPEED, MU, SLOPE, STEEP, STEPS = 0.1, 0.23, 310.0, 1e6, 4096


def speed_left(mu: float, slope: float, time: float) -> D:
    """Of a free slide under tanh friction: sinh(K v) = sinh(K v0) exp(-mu g K t), m/s."""
    k, start = D(slope), D(slope) * D(SPEED)
    rate = D(mu * GRAVITY) * k * D(time)
    if start - rate > 200:  # sinh is half an exponential to 1e-174
        return (start - rate) / k
    x = (start.exp() - (-start).exp()) / 2 * (-rate).exp() if start < 200 else (start - rate).exp() / 2
    return (x + (x * x + 1).sqrt()).ln() / k


def rk4_decay(mu: float, slope: float, time: float) -> float:
    """The speed left by classical Runge-Kutta in 4096 steps, m/s."""
    v, h, limit = SPEED, time / STEPS, mu * GRAVITY
    for _ in range(STEPS):
        a = -limit * tanh(slope * v)
        b = -limit * tanh(slope * (v + 0.5 * h * a))
        c = -limit * tanh(slope * (v + 0.5 * h * b))
        v += h * (a + 2.0 * b + 2.0 * c - limit * tanh(slope * (v + h * c))) / 6.0
    return v


def decay(mu: float, slope: float, time: float) -> float:
    """The speed left in the package, m/s."""
    from verify.dynamics.belt import free_decay

    return free_decay(mu, slope, SPEED, time)


def decay_error(mu: float, slope: float, method: Any = decay) -> float:
    """Of the speed left before and after Coulomb friction would have stopped the slide, over the initial speed."""
    times = [part * SPEED / (mu * GRAVITY) for part in (0.7, 1.3)]
    return worst([float(D(method(mu, slope, t)) - speed_left(mu, slope, t)) for t in times]) / SPEED


_RK4 = ("RK4 in 4096 steps", lambda slope: decay_error(MU, slope, rk4_decay))


@check("friction-slope", "slope, s/m", (1e-3, 1.0, 1e3, 1e6, 1e9), 1e-10, beyond=(1e12, 1e15), baseline=_RK4)
def friction_slope(slope: float) -> float:
    """Speed left of a free slide under tanh friction, viscous to step-like."""
    return decay_error(MU, slope)


@check("friction-coefficient", "mu", (1e-9, 1e-3, 1.0, 1e3, 1e6), 1e-10, beyond=(1e9, 1e12))
def friction_coefficient(mu: float) -> float:
    """Speed left of a free slide under tanh friction of slope 1e6 s/m."""
    return decay_error(mu, STEEP)


@check("friction-rest", "mu", (1e-6, 1.0, 1e6), 1e-20)
def friction_rest(mu: float) -> float:
    """Speed long after tanh friction has stopped a slide, over the initial speed."""
    return abs(decay(mu, STEEP, (30.0 * SPEED + 60.0 / STEEP) / (mu * GRAVITY))) / SPEED  # exp(-60) of the last speed


@check("friction-creep", "1 - F / (mu m g)", (0.9, 0.1, 1e-3, 1e-5, 2e-6), 1e-10, beyond=(1e-7, 1e-12), refused=True)
def friction_creep(left: float) -> float:
    """Creep speed under a force close to mu m g against artanh, error times the distance from mu m g."""
    from verify.dynamics.belt import creep_speed

    force = (1.0 - left) * MU * GRAVITY
    share = D(force) / D(MU * GRAVITY)
    exact = ((1 + share) / (1 - share)).ln() / 2 / D(SLOPE)
    return left * abs(float(D(creep_speed(MU, SLOPE, force)) / exact - 1))


_BELT = (2.0 * pi / 4000) ** 2 / 12.0
"""Order 2 in 4000 steps of the spring's period, (omega dt)^2 / 12."""


@check("stick-slip", "belt speed, m/s", (0.3, 0.03, 3e-3, 3e-4), _BELT, beyond=(1e-7, 1e-12), refused=True)
def stick_slip(speed: float) -> float:
    """Stick and slip times of Coulomb friction on a belt, integrated, against their closed form."""
    from verify.dynamics import belt

    mass, stiffness, static, kinetic = 1.3, 170.0, 5.1, 3.7
    omega, drop = sqrt(stiffness / mass), (static - kinetic) / stiffness
    exact = np.array([2.0 * drop / speed, (2.0 * pi - 2.0 * atan(omega * drop / speed)) / omega])
    return worst(np.array(belt.stick_slip_times(mass, stiffness, static, kinetic, speed)) / exact - 1.0)


LINKS, SHORT, RATE = 100, 12, 17.3


@check("chain-roll-up", "turns", (1, 5, 20), 1e-12, beyond=(40,))
def chain_roll_up(turns: float) -> float:
    """Gap of a cantilever of 100 links rolled into closed circles by an end moment, over its length."""
    from verify.chain.benchmarks import rollup_gap

    return rollup_gap(LINKS, "half", turns)


def elastica(load: float) -> tuple[float, float]:
    """(w / L, 1 - x / L) of a tip under P L^2 / EI: Bisshopp and Drucker, Quart. Appl. Math. 3 (1945) 272."""
    from scipy.optimize import brentq
    from scipy.special import ellipe, ellipeinc, ellipkinc, ellipkm1

    def gap(log_rest: float) -> float:
        rest = exp(log_rest)  # the sine of the tip's slope is 1 - rest, k^2 = 1 - rest / 2
        return float(ellipkm1(0.5 * rest) - ellipkinc(asin(sqrt(1.0 / (2.0 - rest))), 1.0 - 0.5 * rest)) - root

    root = sqrt(load)
    rest = exp(brentq(gap, -2.0 * root - 9.0, -1e-12, xtol=1e-14))
    m, phi = 1.0 - 0.5 * rest, asin(sqrt(1.0 / (2.0 - rest)))
    return 1.0 - 2.0 / root * float(ellipe(m) - ellipeinc(phi, m)), 1.0 - sqrt(2.0 * (1.0 - rest)) / root


@check("chain-dead-load", "P L^2 / EI", (0.1, 1.0, 4.0, 10.0, 100.0), 1.0, beyond=(1000.0, 1e4))
def chain_dead_load(load: float) -> float:
    """Tip of 100 links under a dead load against the elastica, error over its bound load / (12 N^2)."""
    from verify.chain.benchmarks import cantilever_tip

    tip, (w, u) = cantilever_tip(load, LINKS), elastica(load)
    return worst(tip.deflection - w, tip.shortening - u) / (load / (12.0 * LINKS**2))


def pendulum(turns: Sequence[float], gravity: float = 0.0, **how: Any) -> Any:
    """Motion at these turns of twelve stiff links about a pin, gravity along x, straight and rotating at first."""
    from verify.chain.motion import simulate, step_limit
    from verify.chain.system import ChainState, ChainSystem
    from verify.segments.chain import link_inertia

    lengths, masses = np.full(SHORT, 0.73 / SHORT), np.full(SHORT, 0.31 / SHORT)
    stiffness, none = np.append(0.0, np.full(SHORT - 1, 2.9)), np.zeros(SHORT)
    system = ChainSystem(
        lengths=lengths,
        masses=masses,
        inertias=link_inertia(masses, lengths),
        stiffness=stiffness,
        dashpots=none,
        gravity=(gravity, 0.0),
    )
    start = ChainState(none, np.append(RATE, none[1:]))
    if "method" in how:
        how["step"] = 0.5 * step_limit(system)
    return simulate(system, start, [2.0 * pi * turn / RATE for turn in turns], **how)


@check("chain-spin", "turns", (1.0, 10.0, 100.0), 1e-10)
def chain_spin(turns: float) -> float:
    """Straight chain rotating about its pin by RK4: error of its angle and its bending over the angle."""
    first, *bending = pendulum([turns], method="rk4").angles[-1] / (2.0 * pi * turns)
    return worst(first - 1.0, bending)


@check("chain-whirl", "turns", (1.0, 10.0, 30.0), 2.0)
def chain_whirl(turns: float) -> float:
    """Heavy chain whirling over its pin: energy drift over the sum of the steps' tolerances of 1e-10."""
    motion = pendulum([0.0, turns], 9.81, tolerance=1e-10)
    return float(abs(motion.residual()[-1] / motion.energies()[0][0]) / (1e-10 * motion.statistics.steps))


def strip_limit(n: int, scatter: float = 0.0) -> tuple[Any, Any, float]:
    """(system, start, RK4 step limit) of the strip as a chain, at rest or in scattered angles."""
    from verify.chain.kinematics import at_rest
    from verify.chain.motion import step_limit
    from verify.chain.system import build_system

    system = build_system(STRIP, n)
    start = at_rest(system, scatter * np.random.default_rng(3).standard_normal(n))
    return system, start, step_limit(system)


@check("rk4-stability", "dt / limit", (0.1, 0.5, 0.9, 0.99), 1e-12, beyond=(1.01, 2.0), refused=True)
def rk4_stability(part: float) -> float:
    """Energy gain of a chain of 12 links in 2000 RK4 steps."""
    from verify.chain.motion import simulate

    system, start, limit = strip_limit(SHORT, 1e-7)
    step = part * limit
    motion = simulate(system, start, [0.0, 2000 * step], method="rk4", step=step)
    kinetic, elastic, _ = motion.energies()
    total = kinetic + elastic
    return max(float(total[-1] / total[0]) - 1.0, 0.0) if motion.statistics.finished else inf


@check("rk4-limit", "N", (8, 20, 49, 200, 1000), 1e-3)
def rk4_limit(n: float) -> float:
    """RK4 step limit of a pinned chain against 2 sqrt(2) over its highest mode in closed form."""
    s2 = sin((n - 1.0) * pi / n / 2.0) ** 2
    highest = sqrt(48.0 * s2 * s2 / (3.0 - 2.0 * s2)) * STRIP.wave_constant * (n / STRIP.length) ** 2
    return abs(strip_limit(int(n))[2] * highest / (2.0 * sqrt(2.0)) - 1.0)
