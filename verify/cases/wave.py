"""A pure travelling wave w = A cos(omega t - k x) on the strip under a slider, one-way."""

from math import pi, sqrt

import numpy as np
from msgspec.structs import replace

from verify.cases.beams import HERTZ, STRIP
from verify.contact.state import Record
from verify.dynamics.arguments import PrescribedSlider
from verify.dynamics.contact_assembly import assemble
from verify.dynamics.linear_system import EXACT_DEGREE, Stage, Steps, cut
from verify.dynamics.stepping import Run, run_stages
from verify.problem.slider import Slider

STEPS = 1024
"""Time steps of a point slider per period."""
OMEGA = 2.0 * pi * HERTZ
K = sqrt(OMEGA / STRIP.wave_constant)
"""Wavenumber, 1/m."""
CREST = STRIP.surface_distance * K * OMEGA
"""Surface speed at the crests over the amplitude, 1/s."""


def wave_stage(amplitude: float, mean: float = 0.0) -> Stage:
    """One wave period (Doppler shifted) for a slider of mean speed `mean`, m/s."""
    return Stage(
        field=lambda x, derivative, psi: (amplitude * (-1j * K) ** derivative * np.exp(-1j * K * x))[None],
        edges=np.linspace(0.0, STRIP.length, int(STRIP.length * K / 0.3) + 2),
        degree=EXACT_DEGREE,
        omega=OMEGA,
        steps=Steps(STEPS, 2.0 * pi / (OMEGA - K * mean) / STEPS, STEPS),
    )


def held_on(
    wave: Stage, slider: Slider, x: float, count: int, *, periods: int, velocity_z: float
) -> tuple[Run, Record]:
    """(run, foot at its end) of a point of unilateral contact held at x, m, that starts at height 0 with a speed, m/s.

    Of `count` time steps a period; one-way.
    """
    held = PrescribedSlider(replace(slider, coupling="one-way"), 0.0, fixed_position=True)
    assembly = assemble(STRIP, [held], (x,))
    assembly.feet["velocity_z"] = velocity_z
    stage = replace(wave, steps=cut(periods * wave.duration, wave.duration / count, periods))
    return run_stages([stage], np.empty(0, dtype=complex), assembly, np.empty(0)), assembly.feet[0]
