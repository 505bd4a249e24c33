"""A pure travelling wave w = A cos(omega t - k x) under a slider, one-way."""

from math import pi

import numpy as np
from msgspec.structs import replace

from verify.contact.state import Record
from verify.dynamics.contact_assembly import assemble
from verify.dynamics.linear_system import EXACT_DEGREE, Stage, Steps, cut
from verify.dynamics.stepping import Run, run_stages
from verify.exact.closed_forms import check_uniform
from verify.problem.beam import Beam
from verify.problem.slider import Slider

STEPS = 1024
"""Time steps of a point slider per period."""


def wave_stage(beam: Beam, amplitude: float, frequency_hz: float, mean: float = 0.0) -> Stage:
    """One wave period (Doppler shifted) for a slider of mean speed `mean`, m/s. Raises InputError for a step."""
    check_uniform(beam)
    omega = 2.0 * pi * frequency_hz
    k = float(np.sqrt(omega / beam.wave_constant))
    return Stage(
        field=lambda x, derivative, psi: (amplitude * (-1j * k) ** derivative * np.exp(-1j * k * x))[None],
        edges=np.linspace(0.0, beam.length, int(beam.length * k / 0.3) + 2),
        degree=EXACT_DEGREE,
        omega=omega,
        steps=Steps(STEPS, 2.0 * pi / (omega - k * mean) / STEPS, STEPS),
    )


def held_on(
    beam: Beam, wave: Stage, slider: Slider, x: float, count: int, *, periods: int, velocity_z: float
) -> tuple[Run, Record]:
    """(run, foot at its end) of a point of unilateral contact held at x, m, that starts at height 0 with a speed, m/s.

    Of `count` time steps a period; one-way.
    """
    assembly = assemble(beam, (replace(slider, coupling="one-way"),), (x,), (0.0,), (True,))
    assembly.feet["velocity_z"] = velocity_z
    stage = replace(wave, steps=cut(periods * wave.duration, wave.duration / count, periods))
    return run_stages([stage], np.empty(0, dtype=complex), assembly, np.empty(0)), assembly.feet[0]
