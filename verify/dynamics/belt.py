"""Friction benchmarks of the contact engine on a rigid surface of constant speed: decay, creep, stick-slip, decrement.

The mass on a spring is a modal row whose rotation moves the surface; the belt is a slider with prescribed speed.
"""

from math import inf, pi, sqrt

import numpy as np
from msgspec.structs import replace

from verify.arrays import Array, ComplexArray
from verify.contact.state import (
    CONTACT,
    COULOMB,
    FOOT,
    POINT,
    PRESCRIBED,
    SLIDER,
    STICKS,
    TANH,
    Bodies,
    Kind,
)
from verify.dynamics.excitation import Rows
from verify.dynamics.linear_system import Stage, Steps
from verify.dynamics.stepping import Assembly, Run, run_stages
from verify.errors import InputError
from verify.problem.slider import GRAVITY
from verify.validation import check_number

STEPS = 4096
STEPS_PER_PERIOD = 8000
BELOW = 1.0 - 1e-6
"""Largest acceleration over mu g with a creep speed: beyond it the speed depends on digits that mu g does not have."""
LARGE = 1e100
"""Largest mass, stiffness, force; the smallest is its reciprocal."""
LEVER = 1e6
"""h/2 of the surface in units of its motion: rotations are 1e-6, their squares rounding."""


def _contact(
    speed: float, mu: float, static: float, slope: float = 0.0, load: float = 1.0, force: float = 0.0, mass: float = inf
) -> Assembly:
    """One contact point at x = 0; an infinite mass is a slider of prescribed speed that moves the surface."""
    sliders, points, contacts = np.zeros(1, SLIDER), np.zeros(1, POINT), np.zeros(1, CONTACT)
    names = ["v", "inverse_mass", "mu", "mu_static", "steepness", "external_force"]
    for name, value in zip(names, (speed, 1.0 / mass, mu, static, slope, force), strict=True):
        sliders[name] = value
    for name, value in zip(("face", "image", "weight", "load", "lever"), (1.0, 1.0, 1.0, load, LEVER), strict=True):
        points[name] = value
    points["law"] = TANH if slope else COULOMB
    return Assembly(
        start=0.0,
        bodies=Bodies(sliders, np.zeros(0, FOOT), points, contacts),
        kind=Kind(PRESCRIBED, mass == inf, False, False, False, 0.0),
    )


def _run(contact: Assembly, steps: int, dt: float, z: ComplexArray | None = None) -> Run:
    """March on a surface at rest, or on a unit mass on a unit spring with the state z = position - i speed."""

    def shapes(x: Array, derivative: int) -> Array:
        slope = -1.0 / LEVER  # the surface moves by -(h/2) w'
        return np.atleast_2d(slope * x if derivative == 0 else np.full(len(x), slope * (derivative == 1)))

    oscillator = Rows(rates=np.array([1j]), participations=np.array([-1j]), loads=np.zeros(1, dtype=complex))
    stage = Stage(
        field=lambda x, derivative, psi: np.zeros((1, len(x)), dtype=complex),
        edges=np.array([-1e300, 1e300]),
        degree=1,
        omega=1.0,
        steps=Steps(steps, dt, steps),
    )
    if z is not None:
        stage = replace(stage, rows=oscillator, shapes=shapes, edges=np.array([-1.0, 1.0]))
    return run_stages([stage], np.empty(0, dtype=complex) if z is None else z, contact, np.empty(0))


def free_decay(mu: float, slope: float, speed: float, time: float, gravity: float = GRAVITY) -> float:
    """Speed, m/s, of a slider with tanh friction after `time` on a surface at rest, from `speed`."""
    contact = _contact(speed, mu, mu, slope, gravity, mass=1.0)
    _run(contact, STEPS, time / STEPS)
    return float(contact.sliders["v"][0])


def creep_speed(mu: float, slope: float, acceleration: float, gravity: float = GRAVITY) -> float:
    """Final creep speed, m/s, under a constant force per mass `acceleration`, m/s^2. Raises InputError."""
    if not abs(acceleration) <= BELOW * mu * gravity:
        raise InputError(f"acceleration = {acceleration!r} is not below mu g = {mu * gravity:.6g} m/s^2: lower it")
    contact, step = _contact(0.0, mu, mu, slope, gravity, acceleration, mass=1.0), 1.0 / (mu * gravity * slope)
    for _ in range(60):
        before = float(contact.sliders["v"][0])
        contact.sliders["x"][0] = 0.0
        _run(contact, 100, step)
        if abs(contact.sliders["v"][0] - before) <= 1e-15 * abs(before):
            break
        step *= 2.0
    return float(contact.sliders["v"][0])


def stick_slip_times(mass: float, stiffness: float, static: float, kinetic: float, speed: float) -> tuple[float, float]:
    """(stick, slip) times, s, of the stick-slip cycle of a mass on a spring on a belt; `static`, `kinetic`: forces, N.

    Raises InputError without a stick-slip cycle.
    """
    if kinetic >= static:
        raise InputError(f"kinetic = {kinetic!r} is not below static = {static!r}: no stick-slip, lower it")
    for name, value in (("mass", mass), ("stiffness", stiffness), ("static", static), ("speed", speed)):
        check_number(name, value, "SI", at_least=1.0 / LARGE, at_most=LARGE)
    second, metre = sqrt(mass / stiffness), static / stiffness  # units in which mass, spring and static force are 1
    belt, step = speed * second / metre, 2.0 * pi / STEPS_PER_PERIOD
    contact = _contact(belt, kinetic / static, 1.0)
    contact.sliders["free"][0] = 0.0
    contact.contacts["sticks"], contact.contacts["friction"] = 1.0, -1.0
    # every slip begins with the static force on a mass that moves with the belt, so that the first cycle is periodic
    steps, slip, position = STEPS_PER_PERIOD // 8, 0.0, 1.0
    z = np.array([position - 1j * belt])
    for _ in range(16):
        recorded = _run(contact, steps, step, z)
        z, elapsed = recorded.z, slip + steps * step
        sticks = recorded.events[recorded.events[:, 1] == STICKS, 0]
        if len(sticks):
            slip += float(sticks[0])
            position = float(z[0].real) - belt * (elapsed - slip)  # at the start of sticking
            return (1.0 - position) / belt * second, slip * second
        slip = elapsed
    raise InputError(f"speed = {speed!r} m/s: the mass does not stick and slip, lower the speed of the belt")


def coulomb_decrement(mass: float, stiffness: float, force: float) -> float:
    """Amplitude loss per cycle, m, of a spring-mass oscillator with Coulomb friction `force`, N."""
    for name, value in (("mass", mass), ("stiffness", stiffness), ("force", force)):
        check_number(name, value, "SI", at_least=1.0 / LARGE, at_most=LARGE)
    contact, start = _contact(0.0, 1.0, 1.0), 12.5
    recorded = _run(contact, STEPS_PER_PERIOD, 2.0 * pi / STEPS_PER_PERIOD, np.array([start + 0j]))
    return (start - float(recorded.z[0].real)) * force / stiffness
