"""A rigid foot of springs on a pure travelling wave against the continuous elastic layer, `layer.force`.

Points in the middles of equal cells converge with order 2, as do the time steps that are refined with them.
"""

from math import cos, pi

import numpy as np
from msgspec.structs import replace

from verify.arrays import Array
from verify.cases import layer
from verify.cases.base import case
from verify.cases.beams import HERTZ, STRIP
from verify.cases.wave import wave_stage
from verify.dynamics.contact_assembly import assemble
from verify.dynamics.linear_system import cut
from verify.dynamics.stepping import run_stages
from verify.errors import InputError
from verify.motor.steady_state import Means
from verify.problem.beam import Beam
from verify.problem.slider import Contact, Foot, Slider

MU = 0.2  # the force over mu N does not depend on it


def foot_on_wave(
    beam: Beam,
    frequency_hz: float,
    *,
    speed_ratio: float,
    contact_half_angle: float,
    epsilon: float = 0.0,
    mu: float = MU,
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


JOHNSON = "K. L. Johnson, Contact Mechanics (1985), section 8.3: sticks, slips forward and back"
SASHIDA = "T. Sashida and T. Kenjo, An Introduction to Ultrasonic Motors (1993)"


@case("foot-coulomb", layer.force(1.0, 0.7), 1e-12, SASHIDA, contact_half_angle=1.0, speed_ratio=0.7)
@case("foot", layer.force(1.3, 0.8, 0.3), 1e-12, JOHNSON, contact_half_angle=1.3, speed_ratio=0.8, epsilon=0.3)
@case("foot-stiff", layer.force(0.9, 0.85, 0.1), 1e-12, JOHNSON, contact_half_angle=0.9, speed_ratio=0.85, epsilon=0.1)
def force(count: int = 61, **contact: float) -> float:
    """-F/(mu N) of `count` springs of the contact engine, in time steps in proportion, 256 a period at 61."""
    means, _ = foot_on_wave(STRIP, HERTZ, mu=MU, points=count, steps_per_period=round(256 * count / 61), **contact)
    if means.normal_force <= 0.0:
        raise InputError(f"count = {count!r}: no point is in contact, give more")
    return -means.force / (MU * means.normal_force)
