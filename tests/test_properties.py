"""What holds for every beam: scaling and symmetry."""

import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st
from msgspec.structs import replace

from verify import Beam, HermiteModel, Section, SegmentModel
from verify.linear.mesh import part_counts
from verify.options import SUPPORTS

MODELS = {"segment": SegmentModel, "fem": HermiteModel}
supports = st.tuples(st.sampled_from(SUPPORTS), st.sampled_from(SUPPORTS))
BASE = Beam(length=0.73, width=0.031, thickness=0.0023, youngs_modulus=113e9, density=4470.0)


@st.composite
def stepped_beams(draw):
    """Two or three sections of moderately different material and thickness."""
    lengths = draw(st.lists(st.floats(0.1, 1.0), min_size=2, max_size=3))
    sections = tuple(
        Section(
            length=n,
            thickness=draw(st.floats(1e-3, 5e-3)),
            youngs_modulus=draw(st.floats(5e10, 3e11)),
            density=draw(st.floats(1e3, 1e4)),
        )
        for n in lengths
    )
    return replace(BASE, length=sum(lengths), section=sections, supports=draw(supports))


@settings(max_examples=60, deadline=None)
@given(supports, st.integers(-9, 3), st.integers(6, 40), st.sampled_from(sorted(MODELS)))
def test_dimensionless_answers_do_not_depend_on_the_unit_of_length(ends, decade, count, model):
    beam = replace(BASE, supports=ends)
    scale = 10.0**decade / 0.73
    scaled = replace(beam, length=0.73 * scale, width=0.031 * scale, thickness=0.0023 * scale)
    here, there = (MODELS[model](b, count).modes(4).frequencies_hz for b in (beam, scaled))
    assert there * scale == pytest.approx(here, rel=1e-13)


@settings(max_examples=40, deadline=None)
@given(stepped_beams(), st.integers(6, 30), st.sampled_from(sorted(MODELS)), st.floats(0.4, 2.5))
def test_a_stepped_beam_and_its_mirror_image_have_the_same_frequencies(beam, count, model, grading):
    lengths = [section.length for section in beam.section]
    assume(part_counts(lengths, count) == part_counts(lengths[::-1], count)[::-1])  # a tie goes to the left
    here = MODELS[model](beam, count, grading=grading).modes(3).frequencies_hz
    there = MODELS[model](beam.mirrored(), count, grading=1.0 / grading).modes(3).frequencies_hz
    assert there == pytest.approx(here, rel=1e-11)
