"""A slider that runs along a cantilever and off it: what its feet work on the beam, how its books and its state end.

They are those of its last whole step.
"""

import numpy as np
import pytest
from msgspec.structs import replace

from verify.beam import Beam, PointForce
from verify.motion.surface import basis_of
from verify.motor.run import run_motor, run_motors
from verify.slider import Contact, Foot, Slider

BEAM = Beam(
    length=0.1, width=0.008, thickness=0.002, youngs_modulus=200e9, density=7850.0, supports=("clamped", "free")
)
SPEED, HERTZ = 20.0, 5000.0
SPRUNG = Slider(
    mass=0.02,
    mu=1e-6,
    position=0.015,
    preload=30.0,
    coupling="two-way",
    contact=Contact(stiffness=1e6, damping=5.0),
    foot=(Foot(length=0.009, points=2, offset=0.003),),
)


def crossing(slider=SPRUNG, duration=0.006, amplitude=0.0, **given):
    asked = {"model": "fem", "count": 10, "start": "rest", "modal_damping": 0.0, "held_speed": SPEED, "samples": 37}
    forces = [PointForce(position=0.05, amplitude=amplitude)]
    return run_motor(BEAM, forces, HERTZ, duration, slider=slider, **{**asked, **given})


def test_the_books_of_a_slider_that_leaves_the_beam_close_with_the_step():
    coarse, fine = (crossing(steps_per_period=steps) for steps in (400, 1600))
    for run in (coarse, fine):
        assert run.statistics.stopped == "left the beam"
        assert run.ledger.kinetic > 0.03
    assert abs(coarse.ledger.residual) < 2e-5 * coarse.ledger.kinetic
    assert abs(fine.ledger.residual) < 2e-6 * fine.ledger.kinetic


def test_the_state_of_a_slider_that_left_is_that_of_a_run_up_to_there():
    step = 1.3e-6
    left = crossing(step=step)
    there = crossing(step=left.statistics.step_s, duration=left.state.time, samples=2)
    assert there.statistics.stopped == "end"
    assert there.statistics.steps == left.statistics.steps
    assert left.times[-1] < left.state.time < left.times[-1] + left.times[1]
    for name in ("time", "travelled", "feet", "q", "rates"):
        found, expected = (np.asarray(getattr(run.state, name)) for run in (left, there))
        assert found == pytest.approx(expected, rel=1e-9, abs=1e-9 * np.abs(expected).max())
    assert there.ledger.residual == pytest.approx(left.ledger.residual, rel=1e-3)


HARD = replace(SPRUNG, coupling="one-way", contact=Contact(restitution=0.3), foot=())
ALONG = {"slider": replace(SPRUNG, coupling="one-way")}
ENDS = {
    "springs that the beam feels": ({}, 0.085 - 0.003 - 0.00225),
    "hard": ({"slider": HARD, "model": "analytic", "count": None, "start": "steady", "modal_damping": 0.01}, 0.085),
    "a chain": ({**ALONG, "model": "chain", "duration": 3e-4, "held_speed": 150.0, "steps_per_period": 67}, None),
}


@pytest.mark.parametrize("name", ENDS)
def test_time_and_place_of_a_slider_that_left_are_of_one_instant(name):
    given, way = ENDS[name]
    run = crossing(**{"amplitude": 3.0, **given})
    assert run.statistics.stopped.startswith("left the")
    assert run.state.travelled == pytest.approx(run.state.speed * run.state.time, rel=1e-9)
    assert run.times[-1] < run.state.time
    if way is not None:
        assert way - 1.5 * SPEED * run.statistics.step_s < run.state.travelled <= way


def held_energy(state):
    """Of the undriven beam, kinetic and elastic, joules."""
    omegas = basis_of(BEAM, "fem", 10, 80, "spline").omegas
    return 0.5 * float(state.rates @ state.rates + (omegas * state.q) @ (omegas * state.q))


@pytest.mark.parametrize("face", ["upper", "lower"])
def test_running_feet_work_on_the_beam_what_the_beam_gains(face):
    """Nothing drives it or damps it. A slope of up to 0.06 gives the feet as much again as the rise of the material."""
    slider = replace(SPRUNG, foot=(replace(SPRUNG.foot[0], face=face),), gravity=0.0)
    before = crossing(slider, duration=4e-4, step=6e-7, samples=2)
    run = crossing(slider, duration=2.9e-3, step=6e-7, samples=2, continue_from=before)
    books, gained = run.ledger, held_energy(run.state) - held_energy(before.state)
    assert gained > 0.01
    assert books.on_beam == pytest.approx(gained, rel=2e-5)
    assert books.on_beam == pytest.approx(-books.across - books.along, rel=1e-9)
    assert abs(books.uphill) > 0.5 * gained
    assert abs(books.residual) < 1e-6 * gained


def test_a_slider_at_rest_goes_up_no_slope():
    run = crossing(held_speed=0.0, duration=1e-3, amplitude=3.0)
    assert run.ledger.uphill == 0.0
    assert run.ledger.across != 0.0


@pytest.mark.parametrize("coupling", ["one-way", "two-way"])
def test_a_slider_that_is_kept_at_its_place_goes_up_none_at_any_speed(coupling):
    """What is booked and what dashpots feel is the rise of the material that stands there."""
    slider = replace(SPRUNG, coupling=coupling, mu=0.3)
    given = {"frozen": True, "duration": 2e-3, "amplitude": 90.0, "step": 4e-7}
    still, run = (crossing(slider, held_speed=speed, **given) for speed in (0.0, 7.0))
    assert run.ledger.uphill == 0.0
    assert abs(run.ledger.residual) < 2e-4 * run.ledger.damped
    if coupling == "one-way":
        assert run.ledger.damped == pytest.approx(still.ledger.damped, rel=1e-9)


@pytest.mark.parametrize("coupling", ["one-way", "two-way"])
def test_a_beam_that_nothing_drives_is_told_so_in_place_of_an_infinite_size(coupling):
    run = crossing(replace(SPRUNG, coupling=coupling), duration=1e-4)
    assert run.notes[1] == f"coupling: {coupling}; the drive does not move the surface under the slider"


@pytest.mark.parametrize("coupling", ["one-way", "two-way"])
def test_of_several_sliders_those_that_left_are_named_in_every_run(coupling):
    """The second, which is near the end: the first still stands where it was put. Then both, side by side."""
    still, gone = (replace(SPRUNG, coupling=coupling, position=x) for x in (0.031, 0.0829))
    given = {"model": "fem", "count": 10, "start": "rest", "modal_damping": 0.0, "samples": 3}
    force = [PointForce(position=0.05, amplitude=3.0)]
    for first, speed, said in (
        (still, 0.0, "of 2 sliders number 2 left the beam, and the runs of all end there"),
        (gone, SPEED, "all 2 sliders left the beam, and their runs end there"),
    ):
        runs = run_motors(BEAM, force, HERTZ, 0.002, sliders=[first, gone], held_speed=[speed, SPEED], **given)
        assert [run.statistics.stopped for run in runs] == ["left the beam"] * 2
        for run in runs:
            assert said in run.notes
    assert not any("sliders" in note for note in crossing(gone, duration=0.002).notes)
