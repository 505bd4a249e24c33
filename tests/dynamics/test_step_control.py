"""Checks of steps and energy: what they name is an error, not rounding."""

import pytest

from verify import Beam, Contact, Excitation, Foot, Keep, PointForce, Slider, simulate

BEAM = Beam(
    length=0.91, width=0.037, thickness=0.0083, youngs_modulus=113e9, density=4470.0, supports=("clamped", "free"),
    loss_factor=0.01,
)  # fmt: skip


@pytest.mark.parametrize("law", ["tanh", "coulomb"])
@pytest.mark.parametrize(("model", "count"), [("segment", 11), ("fem", 5), ("analytic", None)])
@pytest.mark.parametrize("stiffness", [2.3e4, 1.7e6])
def test_a_clasp_at_rest_has_no_note_that_a_moving_one_lacks(law, model, count, stiffness):
    contact = Contact(stiffness=stiffness, damping=7.0, tangential_stiffness=0.3 * stiffness)
    feet = Foot(), Foot(face="lower")
    clasp = Slider(
        mass=0.21, mu=0.23, law=law, position=0.37, preload=37.0, gravity=0.0, contact=contact, foot=feet
    )  # fmt: skip
    settings = {"model": model, "count": count, "slider": clasp, "start": "rest", "keep": Keep(samples=11)}
    still = simulate(BEAM, Excitation((), 53.0), 0.04, **settings)
    driven = simulate(BEAM, Excitation(PointForce(position=0.61, amplitude=1.3), 53.0), 0.04, **settings)
    assert set(still.notes) <= set(driven.notes)
    assert abs(still.displacement) < 1e-15
    assert driven.energy.drive_work > 1e-6
    assert abs(still.energy.residual) < 1e-12 * 37.0**2 / stiffness
