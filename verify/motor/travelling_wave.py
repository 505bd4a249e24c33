"""Sliders on a pure travelling wave w = A cos(omega t - k x) by time integration, for comparison with closed forms."""

from math import cos, isfinite, pi

import numpy as np
from msgspec.structs import replace

from verify.arrays import Array, ComplexArray
from verify.dynamics.contact_assembly import assemble
from verify.dynamics.linear_system import EXACT_DEGREE, Stage, Steps, cut
from verify.dynamics.stepping import run_stages
from verify.errors import InputError
from verify.exact.closed_forms import check_uniform
from verify.motor.steady_state import Means
from verify.problem.beam import Beam
from verify.problem.slider import Contact, Foot, Slider

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


def foot_on_wave(
    beam: Beam,
    frequency_hz: float,
    *,
    speed_ratio: float,
    contact_half_angle: float,
    epsilon: float = 0.0,
    mu: float = 0.2,
    points: int = 61,
    steps_per_period: int = 256,
    amplitude: float = 1e-9,
) -> tuple[Means, float]:
    """(means over the third period, crest speed, m/s) of a rigid foot, one wavelength long, on a layer of springs.

    It moves against the wave at `speed_ratio` times the crest speed, at a height with half angle `contact_half_angle`
    of contact at each crest. `epsilon` = 2 mu kappa/(kappa_t k h): tangential compliance. Coulomb's law.
    """
    wave, periods = wave_stage(beam, amplitude, frequency_hz), 3  # with compliance the start has no influence after two
    k = float(np.sqrt(wave.omega / beam.wave_constant))
    length, thickness = 2.0 * pi / k, 2.0 * beam.surface_distance
    steps = cut(periods * wave.duration, wave.duration / steps_per_period * (1.0 + 1e-9), periods)
    edges: Array = np.linspace(-0.01 * length, 1.01 * length, int(np.ceil(2.0 * pi / 0.3)) + 2)
    stage = replace(wave, edges=edges, steps=steps)
    crest = beam.surface_distance * k * stage.omega * amplitude
    along = 2.0 * mu / (epsilon * k * thickness) if epsilon else None
    contact = Contact(layer_stiffness=1.0, layer_tangential_stiffness=along)
    foot = Foot(length=length, points=points, offset=0.5 * length, pitches=False)
    slider = Slider(mass=1.0, mu=mu, law="coulomb", contact=contact, foot=(foot,))
    assembly = assemble(beam, (replace(slider, coupling="one-way"),), (0.0,), (-speed_ratio * crest,), (True,))
    assembly.feet["inverse_mass"] = 0.0
    assembly.feet["height"] = amplitude * cos(contact_half_angle)
    last = run_stages([stage], np.empty(0, dtype=complex), assembly, np.empty(0)).journal.samples[-1, 0]
    works = [float(last[name]) * periods / stage.duration for name in ("tangential_work", "friction_loss")]
    means = [float(last[name]) for name in ("friction", "normal_force", "contact_fraction", "stick_fraction")]
    return Means(*means, *works), crest
