"""What holds for every beam: scaling, symmetry, monotony, orthogonality, traces; and no tracebacks."""

import numpy as np
import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st
from msgspec.structs import replace

from verify import Beam, ExactModel, HermiteModel, Section, SegmentModel
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


@settings(max_examples=40, deadline=None)
@given(stepped_beams(), st.integers(6, 24), st.sampled_from(sorted(MODELS)), st.integers(0, 1), st.floats(1.01, 3.0))
def test_stiffer_is_never_lower_and_heavier_never_higher(beam, count, model, which, factor):
    def changed(**fields):
        sections = list(beam.section)
        sections[which] = replace(sections[which], **fields)
        return MODELS[model](replace(beam, section=tuple(sections)), count).modes(4).frequencies_hz

    section = beam.section[which]
    here = MODELS[model](beam, count).modes(4).frequencies_hz
    assert (changed(youngs_modulus=section.youngs_modulus * factor) >= here * (1 - 1e-12)).all()
    assert (changed(density=section.density * factor) <= here * (1 + 1e-12)).all()


@settings(max_examples=30, deadline=None)
@given(supports, st.integers(7, 25), st.sampled_from(sorted(MODELS)))
def test_elastic_eigenvalues_add_up_to_the_trace(ends, count, model):
    system = MODELS[model](replace(BASE, supports=ends), count).system
    strain = np.asarray(system.strain(np.eye(system.n)))
    stiffness = strain.T @ (system.stiffness[:, None] * strain)
    trace = np.trace(np.linalg.solve(system.mass.toarray(), stiffness))
    values, vectors = system.modes(system.n - system.n_rigid)
    assert values.sum() == pytest.approx(trace, rel=1e-11)
    assert vectors.T @ system.mass @ vectors == pytest.approx(np.eye(len(values)), abs=1e-9)
    if system.n_rigid:
        assert abs(np.asarray(system.strain(system.rigid))).max() < 1e-12


@settings(max_examples=30, deadline=None)
@given(supports, st.integers(9, 40))
def test_shapes_of_elements_are_orthonormal_in_the_mass_of_the_beam(ends, count):
    beam = replace(BASE, supports=ends)
    points, weights = np.polynomial.legendre.leggauss(4)
    h = beam.length / count
    x = (np.arange(count)[:, None] * h + (points + 1) / 2 * h).ravel()
    shapes = HermiteModel(beam, count).modes(6).deflection(x)
    assert shapes * np.tile(weights / 2 * h, count) @ shapes.T * beam.mass_per_length == pytest.approx(
        np.eye(6), abs=1e-9
    )


@settings(max_examples=30, deadline=None)
@given(stepped_beams())
def test_elements_lie_above_the_exact_stepped_frequencies_and_come_down_to_them(beam):
    exact = ExactModel(beam).modes(3).frequencies_hz
    coarse, fine = (HermiteModel(beam, n).modes(3).frequencies_hz for n in (12, 48))
    assert (fine >= exact * (1 - 1e-10)).all()
    assert (fine <= coarse * (1 + 1e-10)).all()
    assert fine == pytest.approx(exact, rel=2e-4)
