"""A slider that sticks to a beam it pushes back on: friction gains no energy from steps that fast modes outrun."""

from types import SimpleNamespace

import numpy as np
import pytest
from interpreted import interpreted
from scipy.integrate import quad

from verify.beam import Beam, PointForce
from verify.motion import friction_kernels, records
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


def held(needed, before, static, kinetic, side):
    """(mean friction of a step, what the last and this one took) of a slider that stuck on in the last one."""
    seen, took, dt = np.zeros((3, 8)), np.zeros(16), 3e-4
    took[records.STICKING], took[records.CHANGE] = 1.0, side * before * dt
    seen[2, records.SURFACE] = side * needed * dt + 0.7
    law = SimpleNamespace(mass=2.0, kinetic=kinetic)
    given = interpreted(friction_kernels, "hold")(0.7, 0.0, static, law, dt, seen, took)
    return given / dt, took


@pytest.mark.parametrize("side", [1.0, -1.0])
@pytest.mark.parametrize(("before", "needed"), [(1.1, 2.6), (1.9, 2.3), (-0.4, 2.1), (0.2, 9.0)])
def test_a_slider_that_lets_go_is_held_by_the_line_through_two_means_up_to_static_friction_and_then_by_kinetic(
    before, needed, side
):
    """The line through both means, each at the middle of its step; what it had beyond before this step is taken off."""
    static, kinetic = 2.0, 1.3

    def line(share):
        return before + (needed - before) * (share + 0.5)

    passes = (static - before) / (needed - before) - 0.5
    exact = quad(line, 0.0, passes)[0] + (1.0 - passes) * kinetic
    mean, took = held(needed, before, static, kinetic, side)
    assert mean == pytest.approx(side * exact, rel=1e-12)
    assert took[records.FIRST_EVENT] == pytest.approx(passes * 3e-4, rel=1e-12)
    assert took[records.N_EVENTS] == 1.0
    assert held(1.99, before, static, kinetic, side)[0] == pytest.approx(side * 1.99, rel=1e-12)


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
