"""A rigid foot of springs on a pure travelling wave against the continuous elastic layer, `layer.force`.

Points in the middles of equal cells converge with order 2, as do the time steps that are refined with them.
"""

from math import ceil, cos, pi

import numpy as np
from msgspec.structs import replace

from verify.cases import layer
from verify.cases.base import case
from verify.cases.beams import STRIP
from verify.cases.wave import CREST, K, wave_stage
from verify.contact.state import Record
from verify.dynamics.arguments import PrescribedSlider
from verify.dynamics.contact_assembly import assemble
from verify.dynamics.linear_system import cut
from verify.dynamics.stepping import run_stages
from verify.errors import InputError
from verify.problem.slider import Contact, Foot, Slider

MU, AMPLITUDE = 0.2, 1e-9  # the force over mu N does not depend on them
PERIODS = 3  # with compliance the start has no influence after two
JOHNSON = "K. L. Johnson, Contact Mechanics (1985), section 8.3: sticks, slips forward and back"
SASHIDA = "T. Sashida and T. Kenjo, An Introduction to Ultrasonic Motors (1993)"


def foot_on_wave(half_angle: float, speed_ratio: float, epsilon: float, points: int, steps: int) -> Record:
    """Sample of the third period, in `steps`, of a foot of springs, one wavelength long, with Coulomb's law.

    It moves against the wave at `speed_ratio` times the crest speed, at a height with half angle `half_angle` of
    contact at each crest. `epsilon` = 2 mu kappa/(kappa_t k h): tangential compliance.
    """
    wave, length = wave_stage(AMPLITUDE), 2.0 * pi / K
    longest = wave.duration / steps * (1.0 + 1e-9)
    edges = np.linspace(-0.01 * length, 1.01 * length, ceil(2.0 * pi / 0.3) + 2)
    stage = replace(wave, edges=edges, steps=cut(PERIODS * wave.duration, longest, PERIODS))
    along = 2.0 * MU / (2.0 * epsilon * K * STRIP.surface_distance) if epsilon else None
    contact = Contact(layer_stiffness=1.0, layer_tangential_stiffness=along)
    foot = Foot(length=length, points=points, offset=0.5 * length, pitches=False)
    slider = Slider(mass=1.0, mu=MU, law="coulomb", contact=contact, foot=(foot,), coupling="one-way")
    held = PrescribedSlider(slider, -speed_ratio * CREST * AMPLITUDE, fixed_position=True)
    assembly = assemble(STRIP, [held], (0.0,))
    assembly.feet["inverse_mass"] = 0.0
    assembly.feet["height"] = AMPLITUDE * cos(half_angle)
    return run_stages([stage], np.empty(0, dtype=complex), assembly, np.empty(0)).journal.samples[-1, 0]


@case("foot-coulomb", layer.force(1.0, 0.7), 1e-12, SASHIDA, half_angle=1.0, speed_ratio=0.7)
@case("foot", layer.force(1.3, 0.8, 0.3), 1e-12, JOHNSON, half_angle=1.3, speed_ratio=0.8, epsilon=0.3)
@case("foot-stiff", layer.force(0.9, 0.85, 0.1), 1e-12, JOHNSON, half_angle=0.9, speed_ratio=0.85, epsilon=0.1)
def force(half_angle: float, speed_ratio: float, epsilon: float = 0.0, count: int = 61) -> float:
    """-F/(mu N) of `count` springs of the contact engine, in time steps in proportion, 256 a period at 61."""
    last = foot_on_wave(half_angle, speed_ratio, epsilon, count, round(256 * count / 61))
    if last["normal_force"] <= 0.0:
        raise InputError(f"count = {count!r}: no point is in contact, give more")
    return float(-last["friction"] / (MU * last["normal_force"]))
