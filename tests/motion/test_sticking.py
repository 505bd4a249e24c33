"""A slider that sticks to a beam it pushes back on: friction gains no energy from steps that fast modes outrun."""

import pytest

from verify.beam import Beam, PointForce
from verify.motion.simulate import simulate
from verify.slider import Slider

BEAM = Beam(length=0.73, width=0.017, thickness=0.0023, youngs_modulus=113e9, density=4430.0)
FORCES = (PointForce(position=0.21, amplitude=0.7), PointForce(position=0.55, amplitude=0.4, phase_deg=70.0))
FASTEST = 2.7626e-6
"""Half a turn of the fastest of 60 elements' modes, seconds."""


def ride(count=60, duration=8e-3, step=None, **given):
    slider = Slider(mass=2e-3, mu=0.3, kinematics="following", **given)
    return simulate(
        BEAM,
        FORCES,
        310.0,
        duration,
        model="fem",
        count=count,
        soft_start_periods=2.0,
        slider=slider,
        step=step,
        samples=2,
    )


def words(run):
    """What is said against its step."""
    return [note for note in run.notes if note.startswith("step:") and "give" in note]


def test_a_slider_that_sticks_moves_as_one_the_beam_hardly_feels():
    felt = ride(count=120, duration=0.01, coupling="two-way", law="coulomb")
    free = ride(count=120, duration=0.01, coupling="one-way", law="coulomb")
    assert felt.displacement == pytest.approx(free.displacement, rel=2e-3)
    assert len(felt.events) == len(free.events) == 0
    assert felt.ledger.rubbed == pytest.approx(0.0, abs=1e-12)
    assert not words(felt)


@pytest.mark.parametrize("law", [{"law": "coulomb"}, {"slope": 1e6}])
def test_a_given_step_in_which_a_stick_feeds_fast_modes_is_said(law):
    (said,) = words(ride(coupling="two-way", step=1.2 * FASTEST, **law))
    assert "half a turn of the fastest mode" in said
    assert not words(ride(coupling="two-way", step=0.9 * FASTEST, **law))
    assert not words(ride(coupling="one-way", step=1.2 * FASTEST, **law))


def test_a_soft_grip_takes_no_shorter_steps_for_modes_that_are_not_excited():
    assert ride(coupling="two-way", slope=100.0, normal="massless").statistics.step_s > 10.0 * FASTEST
