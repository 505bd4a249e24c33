"""A beam's derived values, and what it refuses."""

import math

import pytest

from verify.beam import Beam, PointForce
from verify.errors import InputError

SIZES = {"length": 0.73, "width": 0.031, "thickness": 0.0023, "youngs_modulus": 113e9, "density": 4470.0}


def test_stiffness_and_mass_follow_from_the_rectangle(titanium_strip):
    assert titanium_strip.bending_stiffness == pytest.approx(113e9 * 0.031 * 0.0023**3 / 12, rel=1e-15)
    assert titanium_strip.mass_per_length == pytest.approx(4470 * 0.031 * 0.0023, rel=1e-15)
    ratio = titanium_strip.bending_stiffness / titanium_strip.mass_per_length
    assert titanium_strip.wave_constant == pytest.approx(math.sqrt(ratio), rel=4e-16)


def test_the_papers_beam_has_the_constants_of_its_own_figures(paper_beam):
    assert paper_beam.bending_stiffness == pytest.approx(0.11666667, rel=1e-7)
    assert paper_beam.mass_per_length == pytest.approx(0.054, rel=1e-14)
    assert paper_beam.wave_constant == pytest.approx(1.469862, rel=1e-6)


@pytest.mark.parametrize("field", SIZES)
@pytest.mark.parametrize("value", [math.nan, math.inf, -math.inf, 0.0, -0.02, "long", True])
def test_a_size_that_is_no_positive_number_is_refused_by_name_and_value(field, value):
    with pytest.raises(InputError, match=rf"beam\.{field} = .*give a finite number above 0"):
        Beam(**SIZES | {field: value})


@pytest.mark.parametrize("field", SIZES)
def test_a_size_that_is_missing_is_named_with_what_makes_a_section(field):
    wanted = r"beam\.length = None" if field == "length" else rf"beam\.{field} is missing: a rectangle needs width"
    with pytest.raises(InputError, match=wanted):
        Beam(**SIZES | {field: None})


def test_a_beam_whose_frequencies_would_overflow_is_refused():
    for field in SIZES:
        with pytest.raises(InputError, match="check their units"):
            Beam(**SIZES | {field: 1e-290})


def test_an_unknown_support_is_refused_with_the_nearest_one():
    with pytest.raises(InputError, match="did you mean 'clamped'"):
        Beam(**SIZES, supports=("clampd", "free"))
    with pytest.raises(InputError, match="give two"):
        Beam(**SIZES, supports=("free",))


def test_a_force_off_the_left_end_or_not_finite_is_refused():
    assert PointForce(position=0.0116, phase_deg=90.0).amplitude == 1.0
    with pytest.raises(InputError, match=r"force\.position = -0\.1"):
        PointForce(position=-0.1)
    with pytest.raises(InputError, match=r"force\.amplitude = nan"):
        PointForce(position=0.1, amplitude=math.nan)
