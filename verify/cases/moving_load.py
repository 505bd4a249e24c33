"""A force that crosses a pinned beam at half its critical speed, pi / L sqrt(EI / rho A): Fryba's moving force.

Deflections over P L^3 / 48 EI, that of mid-span at rest; mid-span is deepest when the force is at 2L/3. The force is
the preload of a slider without friction and with hardly any mass.
"""

from math import pi

import numpy as np

from verify.cases.base import case
from verify.cases.beams import HERTZ, STRIP
from verify.dynamics.arguments import Excitation, Keep, PrescribedSlider
from verify.dynamics.simulate import simulate
from verify.problem.slider import Slider

SPEED = 0.5 * pi / STRIP.length * STRIP.wave_constant
"""Half the critical speed, m/s."""
FORCE = 1e-4  # N; the slope of the surface moves the contact point, a share of 8e-5 per newton
STEPS = 4096  # of a run
FRYBA = "L. Fryba, Vibration of solids and structures under moving loads"


def series(x: float, force_at: float, terms: int = 2000) -> float:
    """Deflection at x/L when the force is at `force_at` times L, by a series whose terms fall with the fourth power."""
    j = np.arange(1, terms + 1)
    time, natural, driven = 2.0 * pi * force_at, j**2, 0.5 * j  # over the first natural frequency
    parts = (np.sin(driven * time) - driven / natural * np.sin(natural * time)) / (natural**2 - driven**2)
    return 96.0 / pi**4 * float(parts @ np.sin(pi * x * j))


@case("moving-load-deepest", series(0.5, 2 / 3), 1e-12, FRYBA, x=0.5, force_at=2 / 3)
@case("moving-load-beside", series(0.3, 0.4), 1e-12, FRYBA, x=0.3, force_at=0.4)
def deflection(x: float, force_at: float, count: int = 98) -> float:
    """Deflection at x/L when the force is at `force_at` times L, of segments in time."""
    load = PrescribedSlider(Slider(mass=1e-9, preload=FORCE, mu=0.0, gravity=0.0, position=0.0), SPEED)
    seconds, keep = force_at * STRIP.length / SPEED, Keep(at=x * STRIP.length, samples=2)
    drive, step = Excitation((), HERTZ), seconds / STEPS  # no forces beside the load
    motion = simulate(STRIP, drive, seconds, model="segment", count=count, slider=load, step=step, keep=keep)
    return -float(motion.deflection[-1, 0]) * 48.0 * STRIP.bending_stiffness / (FORCE * STRIP.length**3)
