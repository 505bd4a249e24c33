"""Checks of time steps, of friction laws, and of the nonlinear chain."""

from functools import cache
from math import asin, atan, exp, inf, pi, sin, sqrt, tanh
from typing import Any

import numpy as np

from verify.problem.beam import PointForce
from verify.problem.slider import GRAVITY, Slider
from verify.stress.engine import check, worst
from verify.stress.reference import STRIP, D

HERTZ, PER_PERIOD, MODES = 731.0, 64, 3
STEP = 1.0 / (PER_PERIOD * HERTZ)
FORCE = (PointForce(position=0.37 * STRIP.length, amplitude=1e-3),)
ULP = 1.1e-16


def driven(duration: float, slider: Slider | None = None, samples: int = 2, **more: Any) -> Any:
    """The strip from rest under a force, in steps of a 64th of the period where it carries a slider."""
    from verify.motion.simulate import simulate

    step, at = STEP if slider else None, [0.29 * STRIP.length]
    settings = {"modes": MODES, "step": step, "slider": slider, "at": at, "samples": samples, **more}
    return simulate(STRIP, FORCE, HERTZ, duration, model="analytic", **settings)


def slider(slope: float = 310.0, mu: float = 0.23) -> Slider:
    """3 mg with one-way coupling."""
    return Slider(mass=3e-9, mu=mu, slope=slope, coupling="one-way")


@cache
def amplitude() -> float:
    """Largest deflection over 0.2 s, m."""
    return float(abs(driven(0.2, samples=2001).deflection).max())


def central_error(steps: float) -> float:
    """Phase error of central differences in units of rounding per step: (omega dt)^3 / 24 a step."""
    from verify.exact.closed_forms import frequency_hz

    turn = 2.0 * pi * frequency_hz(STRIP, MODES) * STEP
    lag = abs(2.0 * asin(0.5 * turn) - turn) * steps
    return 2.0 * abs(sin(min(0.5 * lag, 0.5 * pi))) / (ULP * steps)


_CENTRAL = ("central differences", central_error)


@check("time-stepping", "steps", (1e3, 1e4, 1e5, 1e6, 1e7), 1.0, slow=True, baseline=_CENTRAL)
def time_stepping(steps: float) -> float:
    """Modes advanced step by step against their closed form, error over 1.1e-16 per step."""
    stepped = driven(steps * STEP, slider())
    closed = driven(steps * STEP).deflection[-1, 0]
    return float(abs(stepped.deflection[-1, 0] - closed)) / (amplitude() * ULP * float(stepped.statistics.steps))


def imbalance(steps: float, slope: float) -> float:
    """Energy missing from the balance of a slider on the driven strip, over input work and friction loss."""
    ledger = driven(steps * STEP, slider(slope)).ledger
    return float(abs(ledger.residual) / (ledger.rubbed + ledger.work_in))


@check("energy-steps", "steps", (1e4, 1e6, 1e7), 1e-6, slow=True)
def energy_steps(steps: float) -> float:
    """Energy balance of a slider on the driven strip over many steps."""
    return imbalance(steps, 310.0)


@check("energy-slope", "friction slope, s/m", (1.0, 1e3, 1e6, 1e9), 1e-6)
def energy_slope(slope: float) -> float:
    """Energy balance of a slider on the driven strip, 20 000 steps."""
    return imbalance(20_000, slope)


@check("friction-bound", "mu", (1e-6, 1.0, 1e3, 1e6), 1e-12)
def friction_bound(mu: float) -> float:
    """Excess of the friction force over mu m g and of the displacement over what it can cause, slope 1e9 s/m."""
    one = slider(1e9, mu)
    run = driven(20_000 * STEP, one)
    limit = one.mu * one.normal_force
    reach = 0.5 * limit / one.mass * float(run.times[-1]) ** 2
    return float(np.max([worst(run.friction) / limit - 1.0, worst(run.travelled) / reach - 1.0, 0.0]))


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


def decay_error(method: Any, mu: float, slope: float) -> float:
    """Of the speed left before and after Coulomb friction would have stopped the slide, over the initial speed."""
    times = [part * SPEED / (mu * GRAVITY) for part in (0.7, 1.3)]
    return worst([float(D(method(mu, slope, t)) - speed_left(mu, slope, t)) for t in times]) / SPEED


def decay(mu: float, slope: float, time: float) -> float:
    """The speed left in the package, m/s."""
    from verify.motion.rigid_surface import free_decay

    return free_decay(mu, slope, SPEED, time)


_RK4_SLOPE = ("RK4 in 4096 steps", lambda slope: decay_error(rk4_decay, MU, slope))


@check("friction-slope", "slope, s/m", (1e-3, 1.0, 1e3, 1e6, 1e9), 1e-10, beyond=(1e12, 1e15), baseline=_RK4_SLOPE)
def friction_slope(slope: float) -> float:
    """Speed left of a free slide under tanh friction, viscous to step-like."""
    return decay_error(decay, MU, slope)


@check("friction-coefficient", "mu", (1e-9, 1e-3, 1.0, 1e3, 1e6), 1e-10, beyond=(1e9, 1e12))
def friction_coefficient(mu: float) -> float:
    """Speed left of a free slide under tanh friction of slope 1e6 s/m."""
    return decay_error(decay, mu, STEEP)


def long_time(mu: float) -> float:
    """Seconds after which exp(-60) of the last speed is left."""
    return 30.0 * SPEED / (mu * GRAVITY) + 60.0 / (mu * GRAVITY * STEEP)


@check("friction-rest", "mu", (1e-6, 1.0, 1e6), 1e-20)
def friction_rest(mu: float) -> float:
    """Speed long after tanh friction has stopped a slide, over the initial speed."""
    return abs(decay(mu, STEEP, long_time(mu))) / SPEED


@check("friction-creep", "1 - F / (mu m g)", (0.9, 0.1, 1e-3, 1e-5, 2e-6), 1e-10, beyond=(1e-7, 1e-12), refused=True)
def friction_creep(left: float) -> float:
    """Creep speed under a force close to mu m g against artanh, error times the distance from mu m g."""
    from verify.motion.rigid_surface import creep_speed

    pull = (1.0 - left) * MU * GRAVITY
    share = D(pull) / D(MU * GRAVITY)
    exact = ((1 + share) / (1 - share)).ln() / 2 / D(SLOPE)
    return left * abs(float(D(creep_speed(MU, SLOPE, pull)) / exact - 1))


_BELT = (2.0 * pi / 4000) ** 2 / 12.0
"""Order 2 in 4000 steps of the spring's period, (omega dt)^2 / 12."""


@check("stick-slip", "belt speed, m/s", (0.3, 0.03, 3e-3, 3e-4), _BELT, beyond=(1e-7, 1e-12), refused=True)
def stick_slip(speed: float) -> float:
    """Stick and slip times of Coulomb friction on a belt, integrated and in closed form."""
    from verify.exact.contact import belt
    from verify.motion import rigid_surface

    mass, stiffness, static, kinetic = 1.3, 170.0, 5.1, 3.7
    omega, drop = sqrt(stiffness / mass), (static - kinetic) / stiffness
    exact = np.array([2.0 * drop / speed, (2.0 * pi - 2.0 * atan(omega * drop / speed)) / omega])
    found = [
        law(mass, stiffness, static, kinetic, speed) for law in (rigid_surface.stick_slip_times, belt.stick_slip_times)
    ]
    return worst(np.array(found) / exact - 1.0)


LINKS, SHORT, RATE = 100, 12, 17.3


@check("chain-roll-up", "turns", (1, 5, 20), 1e-12, beyond=(40,))
def chain_roll_up(turns: float) -> float:
    """Gap of a cantilever of 100 links rolled into closed circles by an end moment, over its length."""
    from verify.chain.benchmarks import rollup_gap

    return rollup_gap(LINKS, "half", turns)


@cache
def elastica(load: float) -> tuple[float, float]:
    """(w / L, 1 - x / L) of a tip under P L^2 / EI: Bisshopp and Drucker, Quart. Appl. Math. 3 (1945) 272."""
    from scipy.optimize import brentq
    from scipy.special import ellipe, ellipeinc, ellipkinc, ellipkm1

    root = sqrt(load)

    def modulus(log_rest: float) -> tuple[float, float, float]:
        """k^2, phi, 1 - k^2 of a tip whose slope's sine is 1 - exp(log_rest)."""
        rest = exp(log_rest)
        return 1.0 - 0.5 * rest, asin(sqrt(1.0 / (2.0 - rest))), 0.5 * rest

    def gap(log_rest: float) -> float:
        m, phi, m1 = modulus(log_rest)
        return float(ellipkm1(m1) - ellipkinc(phi, m)) - root

    m, phi, _ = modulus(brentq(gap, -2.0 * root - 9.0, -1e-12, xtol=1e-14))
    return 1.0 - 2.0 / root * float(ellipe(m) - ellipeinc(phi, m)), 1.0 - sqrt(2.0 * (2.0 * m - 1.0)) / root


@check("chain-dead-load", "P L^2 / EI", (0.1, 1.0, 4.0, 10.0, 100.0), 1.0, beyond=(1000.0, 1e4))
def chain_dead_load(load: float) -> float:
    """Tip of 100 links under a dead load against the elastica, error over its bound load / (12 N^2)."""
    from verify.chain.benchmarks import cantilever_tip

    found, (w, u) = cantilever_tip(load, LINKS), elastica(load)
    return worst(found.deflection - w, found.shortening - u) / (load / (12.0 * LINKS**2))


def pendulum(gravity: float = 0.0) -> tuple[Any, Any]:
    """Twelve stiff links about a pin, gravity along x, straight and rotating as a whole."""
    from verify.chain.system import ChainState, ChainSystem
    from verify.segments.chain import link_inertia

    lengths, masses = np.full(SHORT, 0.73 / SHORT), np.full(SHORT, 0.31 / SHORT)
    system = ChainSystem(
        lengths=lengths,
        masses=masses,
        inertias=link_inertia(masses, lengths),
        stiffness=np.append(0.0, np.full(SHORT - 1, 2.9)),
        dashpots=np.zeros(SHORT),
        gravity=(gravity, 0.0),
    )
    return system, ChainState(np.zeros(SHORT), np.append(RATE, np.zeros(SHORT - 1)))


@check("chain-spin", "turns", (1.0, 10.0, 100.0), 1e-10)
def chain_spin(turns: float) -> float:
    """Straight chain rotating about its pin by RK4: error of its angle and its bending over the angle."""
    from verify.chain.motion import simulate, step_limit

    system, start = pendulum()
    end = 2.0 * pi * turns / RATE
    motion = simulate(system, start, [end], method="rk4", step=0.5 * step_limit(system))
    return worst(motion.angles[-1][0] / (RATE * end) - 1.0, motion.angles[-1][1:] / (RATE * end))


@check("chain-whirl", "turns", (1.0, 10.0, 30.0), 2.0)
def chain_whirl(turns: float) -> float:
    """Heavy chain whirling over its pin: energy drift over the sum of the steps' tolerances of 1e-10."""
    from verify.chain.motion import simulate

    motion = simulate(*pendulum(9.81), [0.0, 2.0 * pi * turns / RATE], tolerance=1e-10)
    return abs(float(motion.residual()[-1] / motion.energies()[0][0])) / (1e-10 * motion.statistics.steps)


@check("rk4-stability", "dt / limit", (0.1, 0.5, 0.9, 0.99), 1e-12, beyond=(1.01, 2.0), refused=True)
def rk4_stability(part: float) -> float:
    """Energy gain of a chain of 12 links in 2000 RK4 steps."""
    from verify.chain.kinematics import at_rest
    from verify.chain.motion import simulate, step_limit
    from verify.chain.system import build_system

    system = build_system(STRIP, SHORT)
    start = at_rest(system, 1e-7 * np.random.default_rng(3).standard_normal(SHORT))
    step = part * step_limit(system)
    motion = simulate(system, start, [0.0, 2000 * step], method="rk4", step=step)
    kinetic, elastic, _ = motion.energies()
    total = kinetic + elastic
    return max(float(total[-1] / total[0]) - 1.0, 0.0) if motion.finished else inf


@check("rk4-limit", "N", (8, 20, 49, 200, 1000), 1e-3)
def rk4_limit(n: float) -> float:
    """RK4 step limit of a pinned chain against 2 sqrt(2) over its highest mode in closed form."""
    from verify.chain.motion import step_limit
    from verify.chain.system import build_system

    s2 = sin((n - 1.0) * pi / n / 2.0) ** 2
    highest = sqrt(48.0 * s2 * s2 / (3.0 - 2.0 * s2)) * STRIP.wave_constant * (n / STRIP.length) ** 2
    system = build_system(STRIP, int(n))
    return abs(step_limit(system) * highest / (2.0 * sqrt(2.0)) - 1.0)
