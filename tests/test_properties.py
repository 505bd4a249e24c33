"""What holds for every beam: scaling, symmetry, monotony, orthogonality, traces; and no tracebacks."""

import numpy as np
import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st
from msgspec.structs import replace
from verify.elements.mesh import build_elements
from verify.elements.pencil import element_pencil

from verify import analytic_modes
from verify.elements import linear as fem_beam
from verify.linear.mesh import part_counts
from verify.options import SUPPORTS
from verify.problem.beam import Beam
from verify.problem.cross_section import Section
from verify.segments import linear as segment_model
from verify.segments import links as chain_of_links

SOLVERS = {"segment": segment_model.solve_modes, "fem": fem_beam.solve_modes}
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
@given(supports, st.integers(-9, 3), st.integers(6, 40), st.sampled_from(sorted(SOLVERS)))
def test_dimensionless_answers_do_not_depend_on_the_unit_of_length(ends, decade, count, model):
    beam = replace(BASE, supports=ends)
    scale = 10.0**decade / 0.73
    scaled = replace(beam, length=0.73 * scale, width=0.031 * scale, thickness=0.0023 * scale)
    here, there = (SOLVERS[model](b, 4, count).frequencies_hz for b in (beam, scaled))
    assert there * scale == pytest.approx(here, rel=1e-13)


@settings(max_examples=40, deadline=None)
@given(stepped_beams(), st.integers(6, 30), st.sampled_from(sorted(SOLVERS)), st.floats(0.4, 2.5))
def test_a_stepped_beam_and_its_mirror_image_have_the_same_frequencies(beam, count, model, grading):
    lengths = [section.length for section in beam.section]
    assume(part_counts(lengths, count) == part_counts(lengths[::-1], count)[::-1])  # a tie goes to the left
    here = SOLVERS[model](beam, 3, count, grading=grading).frequencies_hz
    there = SOLVERS[model](beam.mirrored(), 3, count, grading=1.0 / grading).frequencies_hz
    assert there == pytest.approx(here, rel=1e-11)


@settings(max_examples=40, deadline=None)
@given(stepped_beams(), st.integers(6, 24), st.sampled_from(sorted(SOLVERS)), st.integers(0, 1), st.floats(1.01, 3.0))
def test_stiffer_is_never_lower_and_heavier_never_higher(beam, count, model, which, factor):
    def changed(**fields):
        sections = list(beam.section)
        sections[which] = replace(sections[which], **fields)
        return SOLVERS[model](replace(beam, section=tuple(sections)), 4, count).frequencies_hz

    section = beam.section[which]
    here = SOLVERS[model](beam, 4, count).frequencies_hz
    assert (changed(youngs_modulus=section.youngs_modulus * factor) >= here * (1 - 1e-12)).all()
    assert (changed(density=section.density * factor) <= here * (1 + 1e-12)).all()


@settings(max_examples=30, deadline=None)
@given(supports, st.integers(7, 25))
def test_elastic_eigenvalues_of_both_models_add_up_to_the_trace(ends, count):
    beam = replace(BASE, supports=ends)
    chain = segment_model.build_chain(beam, count)
    pencils = [segment_model.chain_pencil(chain)]
    pencils.append(element_pencil(build_elements(beam, count)))
    for pencil in pencils:
        strain = pencil.strain(np.eye(pencil.n))
        stiffness = strain.T @ (pencil.stiffness[:, None] * strain)
        trace = np.trace(np.linalg.solve(pencil.mass_matrix(), stiffness))
        from verify.linear.eigen import lowest

        assert lowest(pencil, pencil.n - pencil.rigid_modes).values.sum() == pytest.approx(trace, rel=1e-11)
        if pencil.rigid_modes:
            assert abs(pencil.strain(pencil.rigid)).max() < 1e-12


@settings(max_examples=30, deadline=None)
@given(supports, st.integers(9, 40))
def test_shapes_are_orthonormal_in_the_models_own_mass(ends, count):
    beam = replace(BASE, supports=ends)
    chain = segment_model.build_chain(beam, count)
    raw = segment_model.solve_modes(beam, 6, count).readings["raw"]()
    mass = chain_of_links.mass_matrix(replace(chain, supports=("free", "free")), dense=True)
    gram = raw @ mass @ raw.T * beam.mass_per_length * chain.unit
    assert gram == pytest.approx(np.eye(6), abs=1e-9)
    modes = fem_beam.solve_modes(beam, 6, count)
    points, weights = np.polynomial.legendre.leggauss(4)
    h = beam.length / count
    x = (np.arange(count)[:, None] * h + (points + 1) / 2 * h).ravel()
    gram = modes.deflection(x) * np.tile(weights / 2 * h, count) @ modes.deflection(x).T * beam.mass_per_length
    assert gram == pytest.approx(np.eye(6), abs=1e-9)


@settings(max_examples=30, deadline=None)
@given(stepped_beams())
def test_elements_lie_above_the_exact_stepped_frequencies_and_come_down_to_them(beam):
    exact = [analytic_modes.stepped_frequency_hz(beam, n) for n in (1, 2, 3)]
    coarse, fine = (fem_beam.solve_modes(beam, 3, n).frequencies_hz for n in (12, 48))
    assert (fine >= np.array(exact) * (1 - 1e-10)).all()
    assert (fine <= coarse * (1 + 1e-10)).all()
    assert fine == pytest.approx(exact, rel=2e-4)
