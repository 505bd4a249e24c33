"""Impact of a mass on a unilateral spring k and dashpot c: speed after over speed before, and duration.

omega_0 = sqrt(k/m), zeta = c / (2 m omega_0), without gravity. The contact ends where its force would become tensile.
T. Schwager and T. Poeschel, Granular Matter 9 (2007) 465. With tension a damping ratio of 0.3 would give 0.372.
"""

from math import asinh, atan2, exp, sqrt

from verify.cases.base import case
from verify.cases.wave import OMEGA, held_on, wave_stage
from verify.problem.slider import Contact, Slider


def contact_time(damping_ratio: float) -> float:
    """Duration of an impact times omega_0, 2 acos(zeta)/sqrt(1 - zeta^2); acosh for zeta > 1."""
    square = (1.0 - damping_ratio) * (1.0 + damping_ratio)
    if square == 0.0:
        return 2.0
    side = sqrt(abs(square))
    return 2.0 * (atan2(side, damping_ratio) if square > 0.0 else asinh(side)) / side


def restitution(damping_ratio: float) -> float:
    """Speed after over speed before an impact on spring and dashpot in closed form, exp(-zeta contact_time)."""
    return exp(-damping_ratio * contact_time(damping_ratio))


@case("restitution", restitution(0.3), 1e-15, "Schwager and Poeschel 2007", damping_ratio=0.3)
def simulated(damping_ratio: float, count: int = 4096) -> float:
    """The same of the contact engine, `count` steps a period 2 pi / omega_0; order 1, due to the dashpot."""
    contact = Contact(stiffness=OMEGA**2, damping=2.0 * damping_ratio * OMEGA)
    slider = Slider(mass=1.0, mu=0.2, law="coulomb", contact=contact, gravity=1e-9)  # next to none
    _, foot = held_on(wave_stage(0.0), slider, 0.25, count, periods=1, velocity_z=-1.0)
    return float(foot["velocity_z"])
