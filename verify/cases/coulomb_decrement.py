"""Decrement of an oscillator with Coulomb friction: every cycle loses the amplitude 4 F / k, whatever the amplitude."""

from math import pi

import numpy as np

from verify.cases.base import case
from verify.cases.rigid_surface import march, on_surface
from verify.problem.slider import Slider

START = 12.5  # amplitude over F / k: slips over the whole of the first cycle


@case("coulomb-decrement", 4.0 * 0.041 / 47.0, 1e-17, "work of friction", stiffness=47.0, force=0.041)
def decrement(stiffness: float, force: float, count: int = 8000) -> float:
    """Loss of amplitude, m, under a friction force, N, by the contact engine in `count` steps a cycle."""
    floor = on_surface(Slider(mass=1.0, mu=1.0, law="coulomb", gravity=1.0), 0.0)
    end = march(floor, count, 2.0 * pi / count, np.array([START + 0j]))
    return (START - float(end.z[0].real)) * force / stiffness
