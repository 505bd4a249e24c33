"""What holds for every beam: scaling."""

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from msgspec.structs import replace

from verify import Beam, HermiteModel, SegmentModel
from verify.options import SUPPORTS

MODELS = {"segment": SegmentModel, "fem": HermiteModel}
supports = st.tuples(st.sampled_from(SUPPORTS), st.sampled_from(SUPPORTS))
BASE = Beam(length=0.73, width=0.031, thickness=0.0023, youngs_modulus=113e9, density=4470.0)


@settings(max_examples=60, deadline=None)
@given(supports, st.integers(-9, 3), st.integers(6, 40), st.sampled_from(sorted(MODELS)))
def test_dimensionless_answers_do_not_depend_on_the_unit_of_length(ends, decade, count, model):
    beam = replace(BASE, supports=ends)
    scale = 10.0**decade / 0.73
    scaled = replace(beam, length=0.73 * scale, width=0.031 * scale, thickness=0.0023 * scale)
    here, there = (MODELS[model](b, count).modes(4).frequencies_hz for b in (beam, scaled))
    assert there * scale == pytest.approx(here, rel=1e-13)
