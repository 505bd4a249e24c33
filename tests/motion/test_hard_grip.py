"""A light slider that friction grips hard: caught in a small part of a step, it goes on with the surface."""

import numpy as np
import pytest

from verify.beam import Beam, PointForce
from verify.fem_beam import solve_harmonic
from verify.motion.simulate import simulate
from verify.slider import Slider

STRIP = Beam(length=0.3, width=0.01, thickness=0.002, youngs_modulus=100e9, density=8000.0, loss_factor=0.01)
PUSHES = (PointForce(position=0.033, amplitude=5.0, phase_deg=20.0), PointForce(position=0.26, amplitude=3.0))
SOFT = (PointForce(position=0.033, amplitude=0.005, phase_deg=20.0), PointForce(position=0.26, amplitude=0.003))
"""A slope of 2e-6, of whose square nothing is felt."""
GIVEN = {"model": "fem", "count": 13, "start": "steady", "samples": 30}


@pytest.mark.parametrize("law", ["tanh", "coulomb"])
def test_a_light_slider_that_is_gripped_hard_goes_the_way_of_the_surface_at_the_step_chosen(law):
    """0.1 mg under 0.2 N, put at rest on a steady wave: caught within 1e-5 of a period, it goes -(h/2) (w' - w'_0)."""
    slider = Slider(mass=1e-7, mu=0.3, preload=0.2, law=law, position=0.123, coupling="one-way")
    run = simulate(STRIP, SOFT, 700.0, 7.3 / 700.0, slider=slider, **GIVEN)
    slope = solve_harmonic(STRIP, SOFT, 700.0, 13).slope([slider.position])[0]
    turned = np.real(slope * (np.exp(2j * np.pi * 700.0 * run.times) - 1.0))
    assert run.travelled == pytest.approx(-0.5 * STRIP.thickness * turned, abs=2e-4 * STRIP.thickness * abs(slope))


@pytest.mark.parametrize(
    ("law", "mass", "within"),
    [
        ({"slope": 3e4}, 4e-5, 3e-5),
        ({"slope": 3e4}, 1.3e-3, 3e-5),
        ({"slope": 3e3}, 1.7e-2, 3e-5),
        ({"law": "coulomb"}, 1.3e-3, 3e-5),
        ({"law": "coulomb"}, 1.7e-2, 1e-4),
        ({"law": "coulomb", "kinematics": "following"}, 1e-8, 3e-5),
    ],
)
def test_how_hard_friction_grips_needs_no_finer_step(law, mass, within):
    """Held all the time, and swept under at every turn of the surface, which friction follows or not."""
    slider = Slider(mass=mass, mu=0.3, preload=0.2, position=0.123, coupling="one-way", **law)
    coarse, fine = (
        simulate(STRIP, PUSHES, 700.0, 4.1 / 700.0, slider=slider, step=one, **GIVEN) for one in (None, 1e-7)
    )
    assert coarse.travelled == pytest.approx(fine.travelled, abs=within * abs(fine.travelled).max())
