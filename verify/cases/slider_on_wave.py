"""Mean speed of a point slider with tanh friction on a pure travelling wave: drift against the wave.

A slow friction law (K V << 1) takes the mean speed of the surface, -(k omega A^2 / 2) (1 + (k h/2)^2); a steep one, a
sign law, its median, which is twice the mean. A point that follows the surface shares its rise and takes the second
term alone.
"""

from math import isfinite, pi

import numpy as np
from msgspec.structs import replace

from verify.arrays import ComplexArray
from verify.cases.base import case
from verify.cases.beams import HERTZ, STRIP, THICKNESS
from verify.cases.wave import wave_stage
from verify.dynamics.contact_assembly import assemble
from verify.dynamics.linear_system import Stage
from verify.dynamics.stepping import run_stages
from verify.errors import InputError
from verify.options import Kinematics
from verify.problem.beam import Beam
from verify.problem.slider import Slider


def terminal_speed(beam: Beam, slider: Slider, amplitude: float, frequency_hz: float) -> float:
    """Mean speed along +x, m/s, of the periodic motion of a slider in bilateral contact with tanh friction.

    Root of the change of speed over a Doppler-shifted wave period. Raises InputError without a root.
    """
    from scipy.optimize import brentq

    slider.check_bilateral()
    slider, start, mean = replace(slider, coupling="one-way"), slider.initial_position(beam), 0.0
    no_rows: ComplexArray = np.empty(0, dtype=complex)

    def period(speed: float, stage: Stage) -> tuple[float, float]:
        """(displacement, change of speed) over a period."""
        assembly = assemble(beam, (slider,), (start,), (None,), (False,))
        assembly.sliders["v"][0] = speed
        run_stages([stage], no_rows, assembly, np.empty(0))
        travelled, reached = assembly.sliders["x"][0], assembly.sliders["v"][0]
        if not isfinite(reached):
            raise InputError(f"amplitude = {amplitude!r} m: the slider leaves the steep wave, lower it")
        return float(travelled), float(reached) - speed

    for _ in range(3):
        stage = wave_stage(beam, amplitude, frequency_hz, mean)
        k = np.sqrt(stage.omega / beam.wave_constant)
        reach = 2.0 * k * stage.omega * amplitude * (beam.surface_distance + amplitude)
        if not period(-reach, stage)[1] > 0.0 > period(reach, stage)[1]:
            raise InputError(f"amplitude = {amplitude!r} m: no periodic motion, raise mu or slope")
        speed = brentq(lambda v, on=stage: period(v, on)[1], -reach, reach, xtol=1e-15 * reach, rtol=1e-14)
        mean = period(float(speed), stage)[0] / stage.duration
    return mean


SQUARE = 0.25 * (2.0 * pi * HERTZ / STRIP.wave_constant) * THICKNESS**2
"""(k h/2)^2."""


@case("drift-slow", 1.0 + SQUARE, 2e-6, "mean of the surface; (K V)^2 is neglected", slope=3.0)
@case("drift-steep", 2.0 + 2.0 * SQUARE, 3e-3, "median; the ripple (mu g / omega V)^2 is neglected", slope=1e7)
@case("drift-following", SQUARE, 1e-6, "mean of the surface without its rise", slope=3.0, kinematics="following")
def drift(slope: float, kinematics: Kinematics = "tangential") -> float:
    """Mean speed over -(k omega A^2 / 2) by the contact engine, tanh law; mu = 0.02, A = 2.3e-7 m."""
    amplitude, omega = 2.3e-7, 2.0 * pi * HERTZ
    unit = 0.5 * float(np.sqrt(omega / STRIP.wave_constant)) * omega * amplitude**2
    slider = Slider(mass=1.0, mu=0.02, slope=slope, kinematics=kinematics)
    return -terminal_speed(STRIP, slider, amplitude, HERTZ) / unit
