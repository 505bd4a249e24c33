"""A slider on a rigid surface of constant speed, pulled or held by a spring, by the friction steps of the beam runs."""

from math import pi, sqrt

import numpy as np

from verify.arrays import Array
from verify.errors import InputError
from verify.motion.records import SLIPS, STICKS, Law
from verify.problem.slider import GRAVITY
from verify.validation import check_number

STEPS = 4096
STEPS_PER_PERIOD = 4000
EVENTS = 64
HELD = 1.0 - 1e-6
"""Share of mu g up to which a pull is held: beyond it the creep depends on digits that mu g does not have."""
DOUBLINGS = 60
"""Of the step, from the time that friction takes to act."""
MOST_STEPS = 40_000_000
LARGE = 1e100
"""Of a mass, a stiffness, a force; the least is one over it."""


def _law(coulomb: bool, kinetic: float, static: float, slope: float) -> Law:
    """Friction alone, accelerations in m/s^2."""
    return Law(
        kinetic=float(kinetic),
        static=float(static) if coulomb else None,
        slope=None if coulomb else float(slope),
        mass=1.0,
        half=0.0,
        gravity=GRAVITY,
        following=False,
        held=False,
        load=GRAVITY,
    )


def _slide(n: int, dt: float, law: Law, belt: float, stiffness: float, pull: float, state: Array, events: Array) -> int:
    """`slide_on_belt`, compiled at its first use."""
    from verify.motion.friction_kernels import slide_on_belt

    return int(slide_on_belt(n, dt, law, belt, stiffness, pull, state, events))


def free_decay(mu: float, slope: float, speed: float, time: float, gravity: float = GRAVITY) -> float:
    """Speed that tanh friction leaves of `speed` after `time` on a surface at rest, m/s."""
    state = np.array([0.0, speed, 0.0])
    _slide(STEPS, time / STEPS, _law(False, mu * gravity, 0.0, slope), 0.0, 0.0, 0.0, state, np.zeros((0, 3)))
    return float(state[1])


def creep_speed(mu: float, slope: float, pull: float, gravity: float = GRAVITY) -> float:
    """Speed at which a slider under the constant acceleration `pull` creeps in the end, m/s. Raises InputError."""
    if not abs(pull) <= HELD * mu * gravity:
        raise InputError(f"pull = {pull!r} is not below mu g = {mu * gravity!r} m/s^2 by a millionth: lower pull")
    state, law = np.array([0.0, 0.0, 0.0]), _law(False, mu * gravity, 0.0, slope)
    step = 1.0 / (mu * gravity * slope)
    for _ in range(DOUBLINGS):
        before = state[1]
        _slide(100, step, law, 0.0, 0.0, pull, state, np.zeros((0, 3)))
        if abs(state[1] - before) <= 1e-15 * abs(state[1]):
            break
        step *= 2.0
    return float(state[1])


def stick_slip_times(mass: float, stiffness: float, static: float, kinetic: float, speed: float) -> tuple[float, float]:
    """(stick, slip) seconds of the settled motion of a spring-held mass on a belt; static and kinetic are forces.

    Raises InputError where it does not stick and slip.
    """
    if kinetic >= static:
        raise InputError(
            f"kinetic = {kinetic!r} is not below static = {static!r}: without a drop nothing slips, lower it"
        )
    for name, value in (("mass", mass), ("stiffness", stiffness), ("static", static), ("speed", speed)):
        check_number(name, value, "SI", at_least=1.0 / LARGE, at_most=LARGE)
    period = 2.0 * pi * sqrt(mass / stiffness)
    step = period / STEPS_PER_PERIOD
    stretching = static / stiffness / speed  # seconds until the belt has stretched the spring
    steps = 4.0 * (period + 3.0 * stretching) / step
    if not steps <= MOST_STEPS:
        raise InputError(
            f"speed = {speed!r} m/s stretches the spring for {stretching / period:.1e} of its periods: raise speed"
        )
    events, state = np.zeros((EVENTS, 3)), np.array([0.0, speed, 1.0])
    law = _law(True, kinetic / mass, static / mass, 0.0)
    n = _slide(int(steps), step, law, speed, stiffness / mass, 0.0, state, events)
    kinds = events[:n, 1]
    sticks, slips = events[:n][kinds == STICKS, 0], events[:n][kinds == SLIPS, 0]
    if len(sticks) < 2 or len(slips) < 2:
        raise InputError(f"speed = {speed!r} m/s: the mass does not stick and slip, lower the speed of the belt")
    last = slips[slips > sticks[0]][-1]
    begin = sticks[sticks < last][-1]
    before = slips[slips < begin][-1]
    return float(last - begin), float(begin - before)


def coulomb_decrement(mass: float, stiffness: float, force: float) -> float:
    """Amplitude that a spring-mass oscillator on a floor with Coulomb friction `force` loses in a cycle, metres."""
    for name, value in (("mass", mass), ("stiffness", stiffness), ("force", force)):
        check_number(name, value, "SI", at_least=1.0 / LARGE, at_most=LARGE)
    period = 2.0 * pi * sqrt(mass / stiffness)
    start = 12.5 * force / stiffness
    events, state = np.zeros((EVENTS, 3)), np.array([start, 0.0, 0.0])
    law = _law(True, force / mass, force / mass, 0.0)
    n = _slide(2 * STEPS_PER_PERIOD, period / STEPS_PER_PERIOD, law, 0.0, stiffness / mass, 0.0, state, events)
    turns = events[:n, 2]
    ahead = turns[turns > 0.0]
    return float(start - ahead[0])
