"""Friction from loose to locked: slopes, coefficients and pulls over many powers of ten."""

from collections.abc import Iterator
from decimal import Decimal, localcontext
from functools import partial
from itertools import product
from math import atan, copysign, pi, sqrt, tanh

import numpy as np

from verify.models.compiling import Call
from verify.slider import GRAVITY
from verify.stress.kind import Floor, Refusal, Row
from verify.stress.largest import largest
from verify.stress.references.decimals import asinh, exp, sinh

SPEED = 0.1
"""M/s at first."""
READ = (0.7, 1.3)
"""When speeds are read: before and after flat friction would have stopped the slider, over that time."""
MU, SLOPE = 0.23, 310.0
SLIDING, SPAN = 0.41, 0.25
"""Of Coulomb's friction on what slides, m/s^2; of a step, s."""
STEEP = 1e6
STEPS = 4096
"""Of the suite's own run, which the textbook's gets as well."""


def _left(mu: float, slope: float, speed: float, time: float) -> Decimal:
    """Speed that is left: sinh(K v) = sinh(K v0) e^{-mu g K t}."""
    with localcontext() as context:
        context.prec = 50
        k, start = Decimal(slope), Decimal(speed)
        rate = Decimal(mu * GRAVITY) * k * Decimal(time)
        if k * start > 200:  # sinh is half an exponential to 1e-174
            level = k * start - rate
            return level / k if level > 200 else asinh(exp(level) / 2) / k
        return asinh(sinh(k * start) * exp(-rate)) / k


def decay_error(mu: float, slope: float) -> float:
    """Error of what tanh friction leaves of a speed, over that speed."""
    from verify.motion.rigid_surface import free_decay

    worst = 0.0
    for part in READ:
        time = part * SPEED / (mu * GRAVITY)
        worst = largest(worst, abs(float(Decimal(free_decay(mu, slope, SPEED, time)) - _left(mu, slope, SPEED, time))))
    return worst / SPEED


def rk4_error(mu: float, slope: float) -> float:
    """The same by classical Runge-Kutta in as many steps."""
    times = [part * SPEED / (mu * GRAVITY) for part in READ]
    return largest(abs(_rk4(mu, slope, time) - float(_left(mu, slope, SPEED, time))) for time in times) / SPEED


def _rk4(mu: float, slope: float, time: float) -> float:
    v, step, pull = SPEED, time / STEPS, mu * GRAVITY
    for _ in range(STEPS):
        a = -pull * tanh(slope * v)
        b = -pull * tanh(slope * (v + 0.5 * step * a))
        c = -pull * tanh(slope * (v + 0.5 * step * b))
        d = -pull * tanh(slope * (v + step * c))
        v += step * (a + 2.0 * b + 2.0 * c + d) / 6.0
    return v


def _long(mu: float) -> float:
    """Seconds after which e^-60 of the last speed is left."""
    return 30.0 * SPEED / (mu * GRAVITY) + 60.0 / (mu * GRAVITY * STEEP)


def stop_error(mu: float) -> float:
    """Speed that is left long after friction has stopped the slider, over that at first."""
    from verify.motion.rigid_surface import free_decay

    return abs(free_decay(mu, STEEP, SPEED, _long(mu))) / SPEED


def creep_error(gap: float) -> float:
    """Error of the creep under a pull of 1 - gap of mu g, against artanh(1 - gap) / K, times the gap.

    A rounding of the pull moves it by one over the gap and the logarithm.
    """
    from verify.motion.rigid_surface import creep_speed

    pull = (1.0 - gap) * MU * GRAVITY
    with localcontext() as context:
        context.prec = 50
        share = Decimal(pull) / Decimal(MU * GRAVITY)
        exact = ((1 + share) / (1 - share)).ln() / 2 / Decimal(SLOPE)
        return gap * abs(float(Decimal(creep_speed(MU, SLOPE, pull)) / exact - 1))


def _pulled(excess: float) -> float:
    from verify.motion.rigid_surface import creep_speed

    return creep_speed(MU, SLOPE, (1.0 + excess) * MU * GRAVITY)


def step_error(tau: float) -> float:
    """Of what tanh friction adds in one step on a surface that speeds up by a part of mu g, over all it can add.

    With u = e^{2 K r}, -tau is ln((1 + alpha) u - 1 + alpha) / (1 - alpha^2) - ln u / (2 (1 - alpha)) from start to
    end: by how much the time of the step is missed, times how fast the speed changes at its end.
    """
    from verify.motion.friction_kernels import tanh_speed_change

    worst = 0.0
    for alpha in (-2.3, -1.02, -0.61, 0.3, 0.93, 1.4, 7.0):
        for rho in (-3.1, -0.4, 0.0, 0.7, 6.0):
            change = tanh_speed_change(
                rho / SLOPE, alpha * MU * GRAVITY, MU * GRAVITY, SLOPE, tau / SLOPE / MU / GRAVITY
            )
            end = rho + SLOPE * change - alpha * tau
            with localcontext() as context:
                context.prec = 50
                lean = Decimal(alpha)
                parts = [
                    (abs((1 + lean) * u - 1 + lean).ln() / (1 - lean**2) - u.ln() / (2 * (1 - lean)))
                    for u in (exp(2 * Decimal(rho)), exp(2 * Decimal(end)))
                ]
                missed = float(parts[0] - parts[1] - Decimal(tau))
            worst = largest(worst, abs(missed * (tanh(end) + alpha)) / ((1.0 + abs(alpha)) * tau))
    return worst


def belt_error(speed: float) -> float:
    """Worst relative error of stick and slip times on a belt, followed and in closed form, against a spring's turns."""
    from verify.contact import belt
    from verify.motion import rigid_surface

    mass, stiffness, static, kinetic = 1.3, 170.0, 5.1, 3.7
    omega, drop = sqrt(stiffness / mass), (static - kinetic) / stiffness
    exact_stick = 2.0 * drop / speed
    exact_slip = (2.0 * pi - 2.0 * atan(omega * drop / speed)) / omega
    worst = 0.0
    for times in (rigid_surface.stick_slip_times, belt.stick_slip_times):
        stick, slip = times(mass, stiffness, static, kinetic, speed)
        worst = largest(worst, abs(stick / exact_stick - 1.0), abs(slip / exact_slip - 1.0))
    return worst


def _slow_belt(speed: float) -> float:
    from verify.motion.rigid_surface import stick_slip_times

    return stick_slip_times(1.3, 170.0, 5.1, 3.7, speed)[0]


def _belt(law: str) -> Iterator[Call]:
    """Loops of a slider on a belt."""
    from verify.motion.warm import on_belt

    return on_belt(law)


def span_error(static: float) -> float:
    """Of how long Coulomb friction keeps its mind in a step on a surface that speeds up evenly more and more.

    Which speeds cross nought within the step is found among all roots of r - (k + a) t - b t^2 / 2.
    """
    from verify.motion.friction_kernels import coulomb_span

    worst = 0.0
    for r, a0, a1, stuck in product(
        (0.0, 0.061, 0.3, 1.0, -0.17), (-4.1, -0.5, 0.3, 5.2), (-6.3, -1.2, -0.4, 1.1, 8.1), (0, 1)
    ):
        given = (0.0 if stuck else r, a0, a1)
        used, end, holds, kind = coulomb_span(*given, SLIDING, static, SPAN, bool(stuck))
        known, left, still = _stuck_span(a0, a1, static) if stuck else _slipping_span(*given, static)
        worst = largest(worst, abs(used - known) / SPAN, abs(end - left), float(holds != still))
        worst = largest(worst, float((kind == 0.0) != (used >= SPAN)))
    return worst


def _stuck_span(a0: float, a1: float, static: float) -> tuple[float, float, bool]:
    """(Time, relative speed, whether it sticks) of one at rest, until what drags it is more than it holds."""
    if abs(a0) > static:
        return 0.0, 0.0, False
    share = (copysign(static, a1) - a0) / (a1 - a0) if abs(a1) > static else 1.0
    return share * SPAN, 0.0, share >= 1.0


def _slipping_span(r: float, a0: float, a1: float, static: float) -> tuple[float, float, bool]:
    """The same of one that slips, until its speed is the surface's."""
    rate = (a1 - a0) / SPAN
    slowing = a0 + SLIDING * (np.sign(r) or -np.sign(a0))
    found = np.roots([-0.5 * rate, -slowing, r])
    crossed = sorted(float(t.real) for t in found if abs(t.imag) < 1e-12 and 1e-12 < t.real < SPAN)
    if not crossed:
        return SPAN, r - slowing * SPAN - 0.5 * rate * SPAN**2, False
    return crossed[0], 0.0, abs(a0 + rate * crossed[0]) <= static


def spans() -> Iterator[Call]:
    """One stretch of Coulomb friction by itself."""
    from verify.motion.friction_kernels import coulomb_span

    yield coulomb_span, (0.0, 0.0, 1.0, 1.0, 1.0, 1.0, False)


def one_step() -> Iterator[Call]:
    """One step of tanh friction by itself."""
    from verify.motion.friction_kernels import tanh_speed_change

    yield tanh_speed_change, (0.0, 0.0, 1.0, 1.0, 1.0)


ROWS: tuple[Row, ...] = (
    Floor(
        id="friction-slope",
        title="Tanh friction from viscous to a step, speed left of a free slide",
        why="motion/friction_kernels.py: solved in closed form, so that any slope is exact; 1e-11 of a short step.",
        along="s/m",
        at=(1e-3, 1.0, 1e3, 1e6, 1e9),
        beyond=(1e12, 1e15),
        promise=1e-10,
        error=lambda slope: decay_error(MU, slope),
        beside=lambda slope: rk4_error(MU, slope),
        textbook="RK4 in as many steps",
        seconds=5.0,
        kernels=partial(_belt, "tanh"),
    ),
    Floor(
        id="friction-coefficient",
        title="Tanh friction over the coefficient, speed left of a free slide",
        why="The same.",
        along="mu",
        at=(1e-9, 1e-3, 1.0, 1e3, 1e6),
        beyond=(1e9, 1e12),
        promise=1e-10,
        error=lambda mu: decay_error(mu, STEEP),
        beside=lambda mu: rk4_error(mu, STEEP),
        textbook="RK4 in as many steps",
        kernels=partial(_belt, "tanh"),
    ),
    Floor(
        id="friction-in-one-step",
        title="Tanh friction in one step on a surface that speeds up by more or less than friction can follow",
        why="motion/friction_kernels.py: one monotone equation to rounding; 1e-11 of a short step.",
        along="K mu g dt",
        at=(1e-3, 0.3, 4.0, 30.0),
        promise=1e-10,
        error=step_error,
        kernels=one_step,
    ),
    Floor(
        id="friction-comes-to-rest",
        title="What is left of a speed long after tanh friction has stopped it, at any coefficient",
        why="The closed form falls by e^-60: what is left is 0 to 1e-20 of it, and no step feeds it.",
        along="mu",
        at=(1e-6, 1.0, 1e6),
        promise=1e-20,
        error=stop_error,
        beside=lambda mu: abs(_rk4(mu, STEEP, _long(mu))) / SPEED,
        textbook="RK4 in as many steps",
        kernels=partial(_belt, "tanh"),
    ),
    Floor(
        id="friction-creep",
        title="Creep under a pull close to mu g, error times the gap",
        why="motion/rigid_surface.py: settled to 1e-15 of itself; a rounding of the pull is 1.1e-16 over the gap.",
        along="mu g left",
        at=(0.9, 0.1, 1e-3, 1e-5, 2e-6),
        promise=1e-10,
        error=creep_error,
        kernels=partial(_belt, "tanh"),
    ),
    Refusal(
        id="friction-creep-beyond",
        title="Pulls at mu g or nearer than a millionth",
        why="motion/rigid_surface.py HELD: the creep would depend on digits that mu g does not have.",
        along="mu g too much",
        at=(-1e-7, 0.0, 1e-6, 1e3),
        names=("pull", "mu g"),
        ask=_pulled,
        taken=(-2e-6,),
        kernels=partial(_belt, "tanh"),
    ),
    Floor(
        id="stick-slip",
        title="Stick and slip on a belt from fast to slow, Coulomb friction, against the closed form",
        why="The spring is followed in 4000 steps of its period, of order 2: (omega dt)^2 / 12 = 2.1e-7.",
        along="m/s",
        at=(0.3, 0.03, 3e-3, 3e-4),
        promise=(2.0 * pi / 4000) ** 2 / 12.0,
        error=belt_error,
        seconds=3.0,
        kernels=partial(_belt, "coulomb"),
    ),
    Refusal(
        id="stick-slip-beyond",
        title="Belts so slow that a stick takes more steps than are waited for",
        why="motion/rigid_surface.py MOST_STEPS.",
        along="m/s",
        at=(1e-7, 1e-12, 1e-300),
        names=("speed", "stretches the spring"),
        ask=_slow_belt,
        taken=(0.03,),
        kernels=partial(_belt, "coulomb"),
    ),
    Floor(
        id="coulomb-spans",
        title="Coulomb friction in a step on a surface that speeds up or slows: when its mind changes, against roots",
        why="motion/friction_kernels.py: linear accelerations, hence roots of a parabola; each way out of a step.",
        along="static friction, m/s^2",
        at=(0.6, 2.4),
        promise=1e-12,
        error=span_error,
        kernels=spans,
    ),
)
