"""Mean speed of a point slider with tanh friction on a pure travelling wave: drift against the wave.

A slow friction law (K V << 1) takes the mean speed of the surface, -(k omega A^2 / 2) (1 + (k h/2)^2); a steep one, a
sign law, its median, which is twice the mean. A point that follows the surface shares its rise and takes the second
term alone.
"""

import numpy as np
from msgspec.structs import replace

from verify.cases.base import case
from verify.cases.beams import STRIP
from verify.cases.wave import OMEGA, K, wave_stage
from verify.dynamics.arguments import sliders_of
from verify.dynamics.contact_assembly import assemble
from verify.dynamics.linear_system import Stage
from verify.dynamics.stepping import run_stages
from verify.problem.slider import Slider
from verify.settings import Kinematics

SQUARE = (K * STRIP.surface_distance) ** 2


def terminal_speed(slider: Slider, amplitude: float) -> float:
    """Mean speed along +x, m/s, of the periodic motion of a slider in bilateral contact with tanh friction.

    Root of the change of speed over a Doppler-shifted wave period; ValueError where a high wave leaves none.
    """
    from scipy.optimize import brentq

    slider, mean = replace(slider, coupling="one-way"), 0.0

    def period(speed: float, stage: Stage) -> tuple[float, float]:
        """(displacement, change of speed) over a period."""
        assembly = assemble(STRIP, sliders_of(slider), (0.5 * STRIP.length,))
        assembly.sliders["v"][0] = speed
        run_stages([stage], np.empty(0, dtype=complex), assembly, np.empty(0))
        return float(assembly.sliders["x"][0]), float(assembly.sliders["v"][0]) - speed

    reach = 2.0 * K * OMEGA * amplitude * (STRIP.surface_distance + amplitude)
    for _ in range(3):
        stage = wave_stage(amplitude, mean)
        speed = brentq(lambda v, on=stage: period(v, on)[1], -reach, reach, xtol=1e-15 * reach, rtol=1e-14)
        mean = period(float(speed), stage)[0] / stage.duration
    return mean


@case("drift-slow", 1.0 + SQUARE, 2e-6, "mean of the surface; (K V)^2 is neglected", slope=3.0)
@case("drift-steep", 2.0 + 2.0 * SQUARE, 3e-3, "median; the ripple (mu g / omega V)^2 is neglected", slope=1e7)
@case("drift-following", SQUARE, 1e-6, "mean of the surface without its rise", slope=3.0, kinematics="following")
def drift(slope: float, kinematics: Kinematics = "tangential") -> float:
    """Mean speed over -(k omega A^2 / 2) by the contact engine, tanh law; mu = 0.02, A = 2.3e-7 m."""
    amplitude = 2.3e-7
    speed = terminal_speed(Slider(mass=1.0, mu=0.02, slope=slope, kinematics=kinematics), amplitude)
    return -speed / (0.5 * K * OMEGA * amplitude**2)
