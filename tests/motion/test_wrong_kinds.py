"""What is of another kind than a public verb takes: refused in one sentence that names the field, by no Python error."""

from dataclasses import replace as copied

import numpy as np
import pytest
from msgspec.structs import replace

from verify import (
    Beam,
    Contact,
    PointForce,
    Slider,
    analytic_modes,
    bend,
    fem_beam,
    free_vibration,
    run_motor,
    run_motors,
    segment_model,
    simulate,
)
from verify.chain.dynamics import at_rest
from verify.chain.stepping import simulate as run_chain
from verify.chain.system import build_system
from verify.errors import InputError

STRIP = Beam(length=0.31, width=0.015, thickness=0.002, youngs_modulus=110e9, density=4500.0)
RIDER = Slider(mass=1e-3, mu=0.2)
MOTOR = Slider(mass=5e-3, mu=0.25, contact=Contact(stiffness=1e6))
ASKED = {"beam": STRIP, "forces": PointForce(position=0.05), "frequency_hz": 900.0, "duration": 1e-3, "count": 20}


def refusal(call):
    with pytest.raises(InputError) as found:
        call()
    assert "\n" not in str(found.value)
    return str(found.value)


@pytest.mark.parametrize(
    ("given", "begins"),
    [
        ({"slider": 3}, "slider = 3: give a Slider"),
        ({"slider": [RIDER]}, "slider = [Slider("),
        ({"slider": {"mass": 1.0}}, "slider = {'mass': 1.0}: give a Slider"),
        ({"continue_from": 3}, "continue_from = 3: give a Motion or a FreeVibration"),
        ({"continue_from": 0}, "continue_from = 0: give a Motion or a FreeVibration"),
        ({"envelope": "x"}, "envelope = 'x': give pieces (seconds, coefficients)"),
        ({"envelope": 3}, "envelope = 3: give pieces"),
        ({"envelope": [(1e-4, 2.0)]}, "envelope = [(0.0001, 2.0)]: give pieces"),
        ({"envelope": [[1e-4]]}, "envelope = [[0.0001]]: give pieces"),
        ({"beam": None}, "beam = None: give a Beam"),
    ],
)
def test_simulate(given, begins):
    assert refusal(lambda: simulate(**{**ASKED, "slider": RIDER, **given})).startswith(begins)


@pytest.mark.parametrize(
    ("given", "begins"),
    [
        ({"slider": None}, "slider = None: give a Slider"),
        ({"continue_from": 3}, "continue_from = 3: give a MotorRun"),
        ({"frozen": 3}, "frozen = 3: give a bool"),
        ({"frozen": "no"}, "frozen = 'no': give a bool"),
        ({"beam": "strip"}, "beam = 'strip': give a Beam"),
    ],
)
def test_run_motor(given, begins):
    assert refusal(lambda: run_motor(**{**ASKED, "slider": MOTOR, **given})).startswith(begins)


@pytest.mark.parametrize(
    ("given", "begins"),
    [
        ({"sliders": 3}, "sliders has 3: give a Slider"),
        ({"sliders": [MOTOR, None]}, "sliders has None: give a Slider"),
        ({"sliders": []}, "sliders is empty"),
        ({"sliders": [MOTOR], "continue_from": 3}, "continue_from has 3: give a MotorRun"),
        ({"sliders": [MOTOR], "frozen": [3]}, "frozen = 3: give a bool"),
    ],
)
def test_run_motors(given, begins):
    assert refusal(lambda: run_motors(**{**ASKED, **given})).startswith(begins)


def test_one_slider_alone_stands_for_a_list_of_it_and_numpys_truth_is_one():
    one_way = replace(MOTOR, coupling="one-way")
    (alone,) = run_motors(**ASKED, sliders=one_way, frozen=np.bool_(True))
    assert np.array_equal(alone.travelled, run_motor(**ASKED, slider=one_way, frozen=True).travelled)


@pytest.mark.parametrize("contact", [{}, 3, "hard", RIDER])
def test_a_contact_that_is_none(contact):
    assert "slider.contact = " in refusal(lambda: Slider(mass=1.0, mu=0.1, contact=contact))


@pytest.mark.parametrize(
    "verb",
    [
        lambda beam: analytic_modes.solve_modes(beam, 3),
        lambda beam: fem_beam.solve_modes(beam, 3, 9),
        lambda beam: segment_model.solve_modes(beam, n_modes=3, n_segments=9),
        lambda beam: segment_model.solve_harmonic(beam, PointForce(position=0.1), 90.0, 9),
        lambda beam: bend(beam, 9, 1.0),
        lambda beam: free_vibration(beam, 1, 0.1, amplitude=1e-3, count=9),
    ],
)
@pytest.mark.parametrize("given", [None, 3, "strip", {"length": 1.0}])
def test_a_beam_that_is_none(verb, given):
    assert refusal(lambda: verb(given)).startswith("beam = ")


def test_numbers_under_a_mask_are_no_numbers():
    """They were read as if nothing hid them; an array that masks none is an array."""
    hidden = np.ma.array([0.1, 0.2], mask=[False, True])
    assert refusal(lambda: simulate(**ASKED, at=hidden)).startswith("at = masked_array(")
    assert "numbers under a mask" in refusal(lambda: segment_model.solve_modes(STRIP, 3, 9).deflection(hidden))
    assert len(simulate(**ASKED, at=np.ma.array([0.1, 0.2])).points) == 2


@pytest.mark.parametrize(
    ("call", "begins"),
    [
        (lambda: PointForce(position=0.2, amplitude=np.ma.array(3.0, mask=True)), "amplitude = "),
        (lambda: replace(STRIP, foundation=np.ma.masked), "beam.foundation = masked"),
        (lambda: simulate(**ASKED, modal_damping=np.ma.masked), "modal_damping = masked"),
        (lambda: fem_beam.solve_modes(STRIP, np.ma.array(3, mask=True), 9), "n_modes = "),
        (
            lambda: fem_beam.solve_modes(STRIP, 3, 9).deflection([np.ma.array([0.1, 0.2], mask=[1, 0]), [0.2, 0.3]]),
            "x = [masked_array(",
        ),
        (lambda: simulate(**ASKED, at=[0.1, np.ma.masked]), "at = [0.1, masked]"),
        (lambda: simulate(**ASKED, envelope=[(1e-4, np.ma.array([0.0, 1.0], mask=[1, 0]))]), "envelope = [(0.0001, ma"),
    ],
)
def test_a_number_under_a_mask_is_none_alone_and_in_a_list(call, begins):
    """Its value was read from below the mask: an amplitude of 3 N, a foundation of nought."""
    said = refusal(call)
    assert said.startswith(begins)
    assert " has numbers under a mask: leave them out or unmask them" in said
    assert PointForce(position=0.2, amplitude=np.ma.array(3.0)).amplitude == 3.0


def test_a_chain_reads_nothing_from_below_a_mask():
    """Times and angles were taken as if nothing hid them."""
    system, hidden = build_system(STRIP, 3), np.ma.array([0.01, 0.02, 0.03], mask=[0, 1, 0])
    for field, call in {
        "times": lambda: run_chain(system, at_rest(system), hidden),
        "angles": lambda: at_rest(system, hidden),
        "state.rates": lambda: run_chain(system, copied(at_rest(system), rates=hidden), [1e-5]),
        "chain.stiffness": lambda: at_rest(copied(system, stiffness=hidden)),
    }.items():
        assert refusal(call).startswith(f"{field} = masked_array(")


class Column:
    """Numbers with a verb called `mask`, as a column of a table has."""

    def __array__(self, dtype=None, copy=None):
        return np.array([0.1, 0.2])

    def mask(self, where):
        raise AssertionError


def test_an_array_of_another_library_hides_nothing():
    """Its `mask` is a verb, which was taken for a mask."""
    assert simulate(**ASKED, at=Column()).points.tolist() == [0.1, 0.2]


class Nine:
    """A whole number to Python, with no arithmetic of its own."""

    def __index__(self):
        return 9


def test_what_python_takes_for_a_whole_number_is_one():
    found = fem_beam.solve_modes(STRIP, Nine(), Nine()).frequencies_hz
    assert np.array_equal(found, fem_beam.solve_modes(STRIP, 9, 9).frequencies_hz)
    assert len(simulate(**{**ASKED, "count": Nine()}, samples=Nine()).times) == 9


def test_a_dashpot_of_which_no_number_is_made_is_refused_by_its_name():
    """Of 1e308 N m s another frequency was advised."""
    said = refusal(lambda: segment_model.solve_harmonic(STRIP, PointForce(position=0.1), 90.0, 9, joint_dashpot=1e305))
    assert said.startswith("joint_dashpot = 1e+305: give a finite number of at least 0 and of at most 1e+100")
