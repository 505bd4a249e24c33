"""Friction mu m g tanh(K v) on a surface at rest: creep under a force m a below mu m g, and decay."""

from math import atanh

from verify.cases.base import case
from verify.cases.rigid_surface import march, on_surface
from verify.errors import InputError
from verify.problem.slider import GRAVITY, Slider

STEPS = 4096
"""Steps of a decay."""
BELOW = 1.0 - 1e-6
"""Largest acceleration over mu g with a creep speed: beyond it the speed depends on digits that mu g does not have."""


CREEP = atanh(1.9 / (0.31 * GRAVITY)) / 420.0  # m/s


def free_decay(mu: float, slope: float, speed: float, time: float, gravity: float = GRAVITY) -> float:
    """Speed, m/s, of a slider with tanh friction after `time` on a surface at rest, from `speed`."""
    assembly = on_surface(Slider(mass=1.0, mu=mu, slope=slope, speed=speed, gravity=gravity))
    march(assembly, STEPS, time / STEPS)
    return float(assembly.sliders["v"][0])


@case("creep-speed", CREEP, 1e-17, "a = mu g tanh(K v)", mu=0.31, slope=420.0, acceleration=1.9)
def creep_speed(mu: float, slope: float, acceleration: float, gravity: float = GRAVITY) -> float:
    """Final speed, m/s, under a force per mass, m/s^2, of the contact engine, tanh law. Raises InputError."""
    if not abs(acceleration) <= BELOW * mu * gravity:
        raise InputError(f"acceleration = {acceleration!r} is not below mu g = {mu * gravity:.6g} m/s^2: lower it")
    assembly, step = on_surface(Slider(mass=1.0, mu=mu, slope=slope, gravity=gravity)), 1.0 / (mu * gravity * slope)
    slider = assembly.sliders[0]
    slider["external_force"] = acceleration
    for _ in range(60):
        before = float(slider["v"])
        slider["x"] = 0.0
        march(assembly, 100, step)
        if abs(slider["v"] - before) <= 1e-15 * abs(before):
            break
        step *= 2.0
    return float(slider["v"])
