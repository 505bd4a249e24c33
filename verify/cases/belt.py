"""Stick and slip of a mass on a spring on a belt, Coulomb's law with a static limit.

The mass sticks until the spring holds the static force and slips back to 2 F_k - F_s. On a slow belt the spring is
stretched for seconds; on a fast one the mass oscillates about the stretch that F_k holds and hardly sticks.
"""

from math import atan, pi, sqrt

import numpy as np

from verify.cases.base import case
from verify.cases.rigid_surface import march, on_surface
from verify.contact.state import STICKS
from verify.errors import InputError
from verify.problem.slider import Slider
from verify.validation import check_integer


def stick_slip_times(
    mass: float, stiffness: float, static: float, kinetic: float, speed: float, count: int = 8000
) -> tuple[float, float]:
    """(stick, slip) times of a cycle, s, in `count` steps a natural period; `static`, `kinetic`: forces, N.

    Raises InputError without a stick-slip cycle.
    """
    check_integer("count", count, 8)
    if kinetic >= static:
        raise InputError(f"kinetic = {kinetic!r} is not below static = {static!r}: no stick-slip, lower it")
    second, metre = sqrt(mass / stiffness), static / stiffness  # units in which mass, spring and static force are 1
    belt, step = speed * second / metre, 2.0 * pi / count
    slider = Slider(mass=1.0, mu=kinetic / static, mu_static=1.0, law="coulomb", gravity=1.0)
    assembly = on_surface(slider, belt)
    assembly.sliders["free"][0] = 0.0
    assembly.contacts["sticks"], assembly.contacts["friction"] = 1.0, -1.0
    # every slip begins with the static force on a mass that moves with the belt, so that the first cycle is periodic
    steps, slip, position = count // 8, 0.0, 1.0
    z = np.array([position - 1j * belt])
    for _ in range(16):
        recorded = march(assembly, steps, step, z)
        z, elapsed = recorded.z, slip + steps * step
        sticks = recorded.events[recorded.events[:, 1] == STICKS, 0]
        if len(sticks):
            slip += float(sticks[0])
            position = float(z[0].real) - belt * (elapsed - slip)  # at the start of sticking
            return (1.0 - position) / belt * second, slip * second
        slip = elapsed
    raise InputError(f"speed = {speed!r} m/s: the mass does not stick and slip, lower the speed of the belt")


PHASES = ("stick", "slip")
SYSTEM = {"mass": 0.19, "stiffness": 47.0, "static": 0.83, "kinetic": 0.52}  # kg, N/m, N, N
HARTOG = "J. P. Den Hartog, Mechanical Vibrations: free oscillation about the stretch of the kinetic force"


def exact(phase: str, speed: float) -> float:
    """2 (F_s - F_k) / (k V), or (2 / omega) (pi - atan((F_s - F_k) omega / (k V))), s."""
    rate, omega = (0.83 - 0.52) / (47.0 * speed), sqrt(47.0 / 0.19)
    return 2.0 * rate if phase == "stick" else 2.0 / omega * (pi - atan(rate * omega))


@case("slow-belt-stick", exact("stick", 0.0037), 1e-15, HARTOG, phase="stick", speed=0.0037, **SYSTEM)
@case("slow-belt-slip", exact("slip", 0.0037), 1e-15, HARTOG, phase="slip", speed=0.0037, **SYSTEM)
@case("fast-belt-stick", exact("stick", 0.43), 1e-15, HARTOG, phase="stick", speed=0.43, **SYSTEM)
@case("fast-belt-slip", exact("slip", 0.43), 1e-15, HARTOG, phase="slip", speed=0.43, **SYSTEM)
def phase_time(phase: str, count: int = 8000, **system: float) -> float:
    """Stick or slip time of a cycle, s, by the contact engine with Coulomb's law."""
    return stick_slip_times(**system, count=count)[PHASES.index(phase)]
