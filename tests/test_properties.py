"""What holds for every beam: scaling, symmetry, monotony, orthogonality, traces; and no tracebacks."""

import numpy as np
import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st
from msgspec.structs import replace

from verify.beam import Beam
from verify.elements import linear as fem_beam
from verify.elements.mesh import build_elements
from verify.elements.pencil import element_pencil
from verify.errors import InputError
from verify.exact import modes as analytic_modes
from verify.models.division import part_counts
from verify.options import SUPPORTS
from verify.quantities.catalogue import QUANTITIES
from verify.section import Section
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
        from verify.models.eigen import lowest

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


@settings(max_examples=80, deadline=None)
@given(
    st.dictionaries(
        st.sampled_from(
            ["model", "mode", "count", "counts", "wall", "joints", "grading", "theory", "error", "modes", "node", "x"]
        ),
        st.one_of(
            st.integers(-2, 30),
            st.floats(),
            st.sampled_from(["segment", "fem", "analytic", "mean", "half", "printed", "rayleigh", "nan", ""]),
            st.lists(st.integers(0, 30), max_size=4),
        ),
        max_size=5,
    ),
    st.sampled_from(
        [
            "mode.frequency",
            "mode.frequency_error",
            "mode.order",
            "mode.bracket",
            "mode.shape_error",
            "mode.law_ratio",
            "mode.node_position",
            "mode.count_needed",
            "mode.curvature_error",
        ]
    ),
    stepped_beams() | supports.map(lambda ends: replace(BASE, supports=ends)),
)
def test_any_arguments_give_a_figure_or_a_sentence(arguments, name, beam):
    from verify.judge.workbench import Workbench
    from verify.quantities.catalogue import arguments_of, evaluate, quantity
    from verify.scenes.scene import Scene

    found = quantity(name)
    try:
        value = evaluate(found, arguments_of(found, arguments), Scene(name="s", beam=beam), Workbench(beam))
    except InputError as error:
        assert str(error)
    else:
        assert value is not None


FIGURES = st.one_of(
    st.floats(),
    st.floats(-1.0, 1.0),
    st.floats(1.0, 1e4),
    st.integers(-2, 60),
    st.sampled_from(
        ["segment", "fem", "analytic", "force", "displacement", "lever", "links", "deflection", "axis_ratio", ""]
    ),
    st.lists(st.floats(-0.1, 0.8), max_size=3),
)
WAVE_ARGUMENTS = [
    "model",
    "count",
    "counts",
    "frequency_hz",
    "phase_deg",
    "position",
    "loss_factor",
    "modal_damping",
    "joint_dashpot",
    "drive",
    "load",
    "reading",
    "window",
    "x",
    "of",
    "span",
]
PLACES = st.one_of(st.sampled_from([0.0, 0.01, 0.1, 0.3, 0.73]), st.floats(0.0, 0.73))
WAVE_FIGURES = st.sampled_from(sorted(name for name in QUANTITIES if name.startswith("wave.")))


def wave_figure(name, arguments, beam, forces):
    """A figure of two forces or none at all: None where a sentence refused it."""
    from verify.judge.workbench import Workbench
    from verify.quantities.catalogue import arguments_of, evaluate, quantity
    from verify.scenes.scene import Drive, Scene, SceneForce

    found = quantity(name)
    drive = Drive(
        frequency_hz=433.0,
        force=tuple(
            SceneForce(position=p * beam.length, amplitude=a, phase_deg=70.0 * i) for i, (p, a) in enumerate(forces)
        ),
    )
    try:
        scene = Scene(name="s", beam=beam, drive=drive)
        return evaluate(found, arguments_of(found, arguments), scene, Workbench(beam))
    except InputError as error:
        assert str(error)
        assert "\n" not in str(error)
        return None


@settings(max_examples=150, deadline=None)
@given(
    st.dictionaries(st.sampled_from(WAVE_ARGUMENTS), FIGURES, max_size=5),
    WAVE_FIGURES,
    stepped_beams() | supports.map(lambda ends: replace(BASE, supports=ends)),
    st.lists(st.tuples(st.floats(0, 1), st.sampled_from([0.0, 1.0, 2.5e-6])), max_size=3),
)
def test_any_wave_arguments_give_a_figure_or_a_sentence(arguments, name, beam, forces):
    value = wave_figure(name, arguments, beam, forces)
    assert value is None or not np.isnan(value)


@st.composite
def sensible_waves(draw):
    """(quantity, arguments it takes, most of them right): most examples reach the numerics."""
    name, model = draw(WAVE_FIGURES), draw(st.sampled_from(["analytic", "segment", "fem"]))
    given = {"model": model, "frequency_hz": draw(st.floats(1.0, 3e4))}
    given |= {"count": draw(st.integers(1, 120))} if model != "analytic" else {}
    optional = {
        "phase_deg": st.floats(-200, 200),
        "position": st.floats(0.0, 0.2),
        "loss_factor": st.floats(0, 1),
        "drive": st.sampled_from(["force", "displacement"]),
        "window": st.tuples(PLACES, PLACES).map(list),
    }
    for argument in draw(st.lists(st.sampled_from(sorted(optional)), max_size=3, unique=True)):
        given[argument] = draw(optional[argument])
    given |= {"x": draw(PLACES)} if name == "wave.deflection" else {}
    if name == "wave.order":
        given = {k: v for k, v in given.items() if k != "count"} | {"model": "fem", "counts": [60, 90, 120]}
    return name, given


@settings(max_examples=150, deadline=None)
@given(sensible_waves(), supports)
def test_any_sensible_wave_is_a_figure_or_a_sentence(asked, ends):
    value = wave_figure(*asked, replace(BASE, supports=ends), [(0.03, 1.0), (0.97, 1.3)])
    assert value is None or not np.isnan(value)


@settings(max_examples=60, deadline=None)
@given(
    sensible_waves(),
    supports,
    st.lists(
        st.sampled_from(
            [
                "frequency_hz=300:5000:3",
                "phase_deg=-90:180:3",
                "position=0:0.3:3",
                "loss_factor=0:0.5:2",
                "count=2:60:3",
            ]
        ),
        min_size=1,
        max_size=2,
    ),
)
def test_any_sweep_gives_a_map_or_a_sentence(asked, ends, sweeps):
    from verify.judge.workbench import Workbench
    from verify.scenes.scene import Drive, Scene, SceneForce
    from verify.studies.wave.design_map import design_map, parse_axis

    beam = replace(BASE, supports=ends)
    far = SceneForce(position=0.03, measured_from="right", phase_deg=90.0)
    scene = Scene(name="s", beam=beam, drive=Drive(frequency_hz=433.0, force=(SceneForce(position=0.02), far)))
    name, arguments = asked
    axes = tuple(parse_axis(text) for text in sweeps)
    try:
        rest = {k: v for k, v in arguments.items() if k not in {axis.name for axis in axes}}
        found = design_map(name, rest, axes, scene, Workbench(beam))
    except InputError as error:
        assert str(error)
    else:
        assert not np.isnan(found.values).all()
        assert bool(found.reasons) == bool(np.isnan(found.values).any())
