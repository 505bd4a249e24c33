"""The free modes that models bring to time, held against dense solves and against each model's harmonic field."""

import numpy as np
import pytest
from motion_reference import FORCES, FREQUENCY, STRIP
from msgspec.structs import replace

from verify import analytic_modes
from verify.attached import PointMass, PointSpring
from verify.beam import Beam
from verify.elements import linear as fem_beam
from verify.errors import InputError
from verify.exact.in_time import MOST
from verify.models.catalogue import MODELS
from verify.models.fields import phasor
from verify.models.time_basis import taylor_table
from verify.motion.forcing import SMOOTH_STEP
from verify.motion.free_vibration import free_vibration
from verify.motion.surface import Growth, Steps, basis_of, stages_from_rest, steady_stage
from verify.section import Section
from verify.segments import in_time as segment_motion
from verify.segments import linear as segment_model
from verify.segments.assembly import build_chain

HELD = [("pinned", "pinned"), ("clamped", "free"), ("clamped", "clamped"), ("guided", "pinned"), ("pinned", "clamped")]


def held(supports):
    return Beam(length=0.43, width=0.017, thickness=0.0013, youngs_modulus=113e9, density=4470.0, supports=supports)


LOADED = [
    (("pinned", "pinned"), {}),
    (("clamped", "pinned"), {}),
    (("guided", "clamped"), {}),
    (("pinned", "clamped"), {"tension": 20.0}),
    (("clamped", "free"), {"spring": (PointSpring(position=0.3, stiffness=300.0, rotational=2.0),)}),
    (("pinned", "pinned"), {"foundation": 700.0, "mass": (PointMass(position=0.11, mass=0.03, rotary_inertia=4e-6),)}),
    (("clamped", "free"), {"section": (Section(length=0.13, thickness=0.002), Section(length=0.3))}),
]


IN_TIME = [(*given, *of) for of in [("segment", 23, 20), ("fem", 9, 15)] for given in LOADED]
IN_TIME += [(*given, "analytic", None, 12) for given in LOADED if not given[1] or "section" in given[1]]


@pytest.mark.parametrize(("supports", "loads", "model", "count", "last"), IN_TIME)
def test_modes_in_time_are_the_models_own_with_their_sign(supports, loads, model, count, last):
    """Eigenvectors have none, shares q of a shape do: they are those of the phi that `solve_modes` gives."""
    beam = replace(held(supports), **loads)
    basis, x = basis_of(beam, model, count, last), np.linspace(0.0, beam.length, 60)[:-1]
    own = MODELS[model].solve_modes(beam, last, count).shapes(x, 0)
    assert abs(basis.shapes(x, 0)[:last] - own).max() < 2e-6 * abs(own).max()
    let_go = free_vibration(beam, 2, 0.01, amplitude=1e-3, model=model, count=count)
    assert let_go.amplitudes[1] > 1e-5
    assert let_go.end.q[1] == pytest.approx(let_go.amplitudes[1] * np.cos(basis.omegas[1] * 0.01), rel=1e-6)


def dense_segments(n, line="spline"):
    """The dense basis where the closed form would be taken."""
    chain = build_chain(STRIP, n)
    omegas, joints, *_ = segment_motion._dense(STRIP, chain)
    shapes = (
        segment_motion._straight(chain, joints)
        if line == "raw"
        else segment_motion._splined(STRIP, chain, joints, False)
    )
    return omegas, shapes, joints


@pytest.mark.parametrize("supports", HELD)
@pytest.mark.parametrize(("model", "count"), [("segment", 33), ("fem", 21)])
def test_the_sum_over_all_modes_is_the_models_own_harmonic_field(model, count, supports):
    """Undamped: modes, their loads and their reading along the beam together."""
    beam = held(supports)
    basis = basis_of(beam, model, count, 0)
    module = {"segment": segment_model, "fem": fem_beam}[model]
    field = module.solve_harmonic(beam, FORCES, FREQUENCY, count)
    share = sum(phasor(f) * basis.loads(f.position) for f in FORCES) / (basis.omegas**2 - (2 * np.pi * FREQUENCY) ** 2)
    x = np.array([0.013, 0.1417, 0.25, 0.3999])
    for derivative in (0, 1, 2):
        assert share @ basis.shapes(x, derivative) == pytest.approx(
            field.shapes(x, derivative), abs=1e-9 * abs(field.shapes(np.linspace(0, beam.length, 99), derivative)).max()
        )


def test_a_stepped_beam_has_its_modes_too():
    steps = (Section(length=0.2), Section(length=0.23, thickness=0.002))
    beam = Beam(length=0.43, width=0.017, thickness=0.0013, youngs_modulus=113e9, density=4470.0, section=steps)
    for model in ("segment", "fem"):
        basis = basis_of(beam, model, 40, 0)
        module = {"segment": segment_model, "fem": fem_beam}[model]
        assert basis.omegas[:5] / (2 * np.pi) == pytest.approx(
            module.solve_modes(beam, 5, 40).frequencies_hz, rel=1e-10
        )
    exact = basis_of(beam, "analytic", None, 30)
    assert basis.omegas[:3] == pytest.approx(exact.omegas[:3], rel=1e-5)


def test_the_exact_beam_of_sections_with_a_mass_is_its_shapes_in_every_cell():
    """Higher derivatives by beta^4 of the section that is there; what loses nothing has no damping ratio."""
    sections = (Section(length=0.2), Section(length=0.23, thickness=0.002))
    beam = replace(held(("clamped", "pinned")), section=sections, mass=(PointMass(position=0.31, mass=0.02),))
    basis = basis_of(beam, "analytic", None, 25)
    assert {0.2, 0.31} <= set(np.round(basis.edges, 12))
    table = taylor_table(basis.shapes, basis.edges, 0, len(basis.edges) - 1, basis.degree)
    for x in np.random.default_rng(3).uniform(0.0, 0.43, 40):
        assert read(table, basis.edges, x) == pytest.approx(basis.shapes(np.array([x]), 0)[:, 0], abs=1e-9)
    field = analytic_modes.solve_harmonic(beam, FORCES, FREQUENCY)
    stage = steady_stage(field, Steps(1, 1e-4, 1), 0.0, basis, 0.0)
    table = taylor_table(stage.rows, stage.edges, 0, len(stage.edges) - 1, stage.degree)
    places = np.random.default_rng(4).uniform(0.0, 0.43, 40)
    found = np.array([read(table, stage.edges, x) for x in places]).T
    true = stage.rows(places)
    assert np.all(abs(found - true).max(axis=1) <= 1e-9 * abs(true).max(axis=1))
    sprung = replace(beam, spring=(PointSpring(position=0.1, stiffness=50.0),))
    with pytest.raises(InputError, match=r"beam\.spring: the exact beam in time takes none"):
        basis_of(sprung, "analytic", None, 25)


@pytest.mark.parametrize(("model", "count", "order"), [("segment", 12, 3), ("fem", 12, 2)])
def test_the_surface_is_smooth_across_the_nodes_as_far_as_its_model_says(model, count, order):
    """C2 spline through the joints (Section II.B); C1 Hermite elements; the next derivative jumps."""
    basis = basis_of(STRIP, model, count, 0)
    nodes, tiny = basis.edges[1:-1], 1e-9
    for derivative in range(order + 1):
        left, right = basis.shapes(nodes - tiny, derivative)[:8], basis.shapes(nodes + tiny, derivative)[:8]
        jump = abs(right - left).max() / abs(right).max()
        assert (jump < 1e-5) == (derivative < order), derivative


def test_raw_links_are_straight_and_turn_at_the_joints():
    raw, smooth = segment_motion.time_basis(STRIP, 12, line="raw"), segment_motion.time_basis(STRIP, 12)
    joint, link = raw.edges[5], STRIP.length / 12
    inside = joint + link * np.array([0.1, 0.5, 0.9])
    assert np.ptp(raw.shapes(inside, 1), axis=1) == pytest.approx(0.0, abs=1e-9)
    assert raw.shapes(inside, 2) == pytest.approx(0.0)
    turn = raw.shapes(np.array([joint]), 1)[:, 0] - raw.shapes(np.array([joint - 1e-9]), 1)[:, 0]
    mu = np.pi * np.arange(1, 12) / 12
    expected = -4 * np.sin(mu / 2) ** 2 * raw.shapes(np.array([joint]), 0)[:, 0] / link
    assert turn == pytest.approx(expected, abs=1e-6 * abs(expected).max())  # a joint turns by its second difference
    # corrected joints: (1 - s^2/3) times the raw ones
    at = np.array([joint])
    assert smooth.shapes(at, 0)[:, 0] == pytest.approx((1 - np.sin(mu / 2) ** 2 / 3) * raw.shapes(at, 0)[:, 0])


@pytest.mark.parametrize("supports", [("free", "free"), ("pinned", "free"), ("guided", "guided")])
@pytest.mark.parametrize(("model", "count"), [("segment", 20), ("fem", 20), ("analytic", None)])
def test_a_beam_that_can_drift_away_is_refused(model, count, supports):
    with pytest.raises(InputError, match="rigid motion"):
        basis_of(held(supports), model, count, 20)


def test_what_does_not_fit_a_model_is_refused_in_a_sentence():
    with pytest.raises(InputError, match="count = 9 is for models of parts"):
        basis_of(STRIP, "analytic", 9, 20)
    with pytest.raises(InputError, match="count is missing"):
        basis_of(STRIP, "fem", None, 20)
    with pytest.raises(InputError, match="did you mean 'raw'"):
        segment_motion.time_basis(STRIP, 9, line="row")
    for modes in (0, 2.5, MOST + 1):
        with pytest.raises(InputError, match="modes = "):
            basis_of(STRIP, "analytic", None, modes)


def test_exact_modes_with_their_tail_are_the_exact_field():
    """The first modes in their steady state and the rest following at once: nothing is cut off at the drive's frequency."""
    basis = basis_of(STRIP, "analytic", None, 25)
    x = np.array([0.0163, 0.0371, 0.211, 0.4])
    share = sum(phasor(f) * basis.loads(f.position) for f in FORCES) / (basis.omegas**2 - (2 * np.pi * FREQUENCY) ** 2)
    exact = analytic_modes.solve_harmonic(STRIP, FORCES, FREQUENCY)
    rest = basis.tail(FORCES, FREQUENCY, 0.0)
    for derivative in (0, 1):
        kept = share @ basis.shapes(x, derivative)
        assert kept + rest(x, derivative) == pytest.approx(exact.shapes(x, derivative), rel=1e-9)
        assert abs(rest(x, derivative)).max() < 1e-2 * abs(kept).max()


def read(table, edges, x):
    """A table of pieces at x, (rows,)."""
    piece = int(np.clip(np.searchsorted(edges, x, side="right") - 1, 0, len(edges) - 2))
    return np.polynomial.polynomial.polyval((x - edges[piece]) / (edges[piece + 1] - edges[piece]), table[piece])


@pytest.mark.parametrize(("model", "count"), [("segment", 49), ("fem", 49), ("fem", 98), ("analytic", None)])
@pytest.mark.parametrize("start", ["rest", "steady"])
def test_the_pieces_a_slider_sees_are_the_shapes(model, count, start):
    """49 and 98 parts of 0.5 m: nodes whose rounding lies on the wrong side of themselves."""
    beam = Beam(length=0.5, width=0.02, thickness=0.001, youngs_modulus=70e9, density=2700.0)
    basis = basis_of(beam, model, count, 40)
    if start == "rest":
        stage = stages_from_rest(
            basis, FORCES, 2 * np.pi * FREQUENCY, 0.01, [Growth(Steps(1, 1e-4, 1), SMOOTH_STEP)], 0.0
        )[0]
    else:
        from verify.models.catalogue import MODELS

        stage = steady_stage(
            MODELS[model].solve_harmonic(beam, FORCES, FREQUENCY, count), Steps(1, 1e-4, 1), 0.0, basis, 0.0
        )
    assert stage.edges[-1] == beam.length
    table = taylor_table(stage.rows, stage.edges, 0, len(stage.edges) - 1, stage.degree)
    places = np.random.default_rng(7).uniform(0.0, 0.5, 60)
    found = np.array([read(table, stage.edges, x) for x in places]).T
    true = stage.rows(places)
    assert np.all(abs(found - true).max(axis=1) <= 1e-10 * abs(true).max(axis=1) + 1e-30)
