"""Landing of a mass that bounces on a vibrating surface A sin theta: phase of the first impact after lift-off.

It leaves at asin(1 / ratio), ratio = A omega^2 over the acceleration of the preload, g + F/m, and flies along a
parabola. P. J. Holmes, J. Sound Vib. 84 (1982) 173.
"""

from math import asin, cos, pi, sin

from verify.cases.base import case
from verify.cases.layer import root
from verify.cases.wave import OMEGA, K, held_on, wave_stage
from verify.contact.state import LANDS
from verify.problem.slider import Contact, Slider
from verify.validation import check_integer

SEARCH_STEP = 2.0 * pi / 720
"""Step of the first search for a landing, rad."""
AMPLITUDE = 1e-12
"""Of the wave, m: so low that the material under a place does not move along."""


def landing_phase(ratio: float) -> float:
    """Phase of the first landing after lift-off in closed form, radians; six digits up to a ratio of 1e9."""
    start = asin(1.0 / ratio)

    def gap(theta: float) -> float:
        t = theta - start
        return sin(start) + cos(start) * t - 0.5 * t * t / ratio - sin(theta)

    # no landing before the parabola falls to the crests, which the mass passes within a quarter of a period
    above_crests = ratio * (1.0 + cos(start)) - 1.0
    after = start + SEARCH_STEP * max(int(above_crests / SEARCH_STEP), 1)
    while gap(after) > 0.0:
        after += SEARCH_STEP
    return root(gap, after - SEARCH_STEP, after)


@case("landing", landing_phase(1.5), 1e-14, "P. J. Holmes, J. Sound Vib. 84 (1982) 173", ratio=1.5)
def simulated_phase(ratio: float, count: int = 64) -> float:
    """The same of hard contact held on a travelling wave, `count` steps a period; a ratio below 4.6."""
    check_integer("count", count, 8)
    place = 6.5 * pi / K  # where the wave is a sine of time
    slider = Slider(mass=1.0, mu=0.2, law="coulomb", contact=Contact(), gravity=AMPLITUDE * OMEGA**2 / ratio)
    run, _ = held_on(wave_stage(AMPLITUDE), slider, place, count, periods=2, velocity_z=AMPLITUDE * OMEGA)
    return float(run.events[run.events[:, 1] == LANDS, 0][0]) * OMEGA
