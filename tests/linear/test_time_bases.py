"""Modes of models for motion in time against their harmonic fields."""

import numpy as np
import pytest
from msgspec.structs import replace

from tests.beams import BEAMS
from verify.analytic_modes import ExactModel
from verify.errors import InputError
from verify.fem_beam import HermiteModel
from verify.linear.field import phasor
from verify.linear.registry import MODELS
from verify.problem.beam import Beam, PointForce
from verify.problem.point_attachments import PointMass
from verify.segment_model import SegmentModel

STRIP = Beam(length=0.43, width=0.017, thickness=0.0013, youngs_modulus=113e9, density=4470.0)
FREQUENCY = 1310.0
FORCES = (
    PointForce(position=0.037, amplitude=1.3, phase_deg=17.0),
    PointForce(position=0.402, amplitude=0.8, phase_deg=101.0),
)
BODY = PointMass(position=0.11, mass=0.03, rotary_inertia=4e-6)
LOADED = ("pinned-pinned", "guided-clamped", "stepped", "masses-springs-steps", "tension-masses", "foundation")


def steady(basis, frequency=FREQUENCY):
    """Steady modal coordinates under the forces, (n,)."""
    loads = sum(phasor(force) * basis.loads(force.position) for force in FORCES)
    return loads / (basis.omegas**2 - (2 * np.pi * frequency) ** 2)


@pytest.mark.parametrize("name", LOADED)
@pytest.mark.parametrize(("model", "count"), [(SegmentModel, 33), (HermiteModel, 21)])
def test_the_sum_over_all_modes_is_the_harmonic_field(model, count, name):
    """Undamped: modes, their loads and their reading along the beam together."""
    model = model(BEAMS[name], count)
    basis, field = model.time_basis(), model.harmonic(FORCES, FREQUENCY)
    x, every = np.array([0.013, 0.1417, 0.25, 0.3999]), np.linspace(0, model.beam.length, 99)
    for derivative in (0, 1, 2):
        bound = 1e-9 * abs(field.shapes(every, derivative)).max()
        assert steady(basis) @ basis.shapes(x, derivative) == pytest.approx(field.shapes(x, derivative), abs=bound)
    modes = model.modes(20)
    assert basis.omegas[:20] / (2 * np.pi) == pytest.approx(modes.frequencies_hz, rel=1e-9)
    assert abs(basis.shapes(x, 0)[:20] - modes.shapes(x, 0)).max() < 2e-6 * abs(modes.shapes(x, 0)).max()


@pytest.mark.parametrize(("kept", "driven"), [(25, 3), (25, 25), (3, 3)])
@pytest.mark.parametrize("off", [0.0, 3e-11, 7e-5])
def test_the_tail_of_the_exact_modes_exists_at_an_undamped_resonance_of_one_of_them(kept, driven, off):
    """Between pinned ends: the sum of sine modes from the first that is left out on."""
    model = ExactModel(STRIP)
    frequency = (1.0 + off) * model.frequency_hz(driven)
    basis, x = model.time_basis(modes=kept), np.array([0.0163, 0.0371, 0.211, 0.4])
    k = np.arange(kept + 1, 100_000) * np.pi / STRIP.length
    receptances = 2.0 / STRIP.mass_per_length / STRIP.length
    receptances = receptances / ((k**2 * STRIP.wave_constant) ** 2 - (2.0 * np.pi * frequency) ** 2)
    for derivative, shapes in ((0, np.sin(np.outer(x, k))), (1, k * np.cos(np.outer(x, k)))):
        expected = sum(phasor(one) * (shapes @ (receptances * np.sin(k * one.position))) for one in FORCES)
        found = basis.tail(FORCES, frequency, 0.0)(x, derivative)
        assert found == pytest.approx(expected, abs=2e-7 * abs(expected).max())


@pytest.mark.parametrize("position", [0.11, 0.43])
def test_a_body_rotates_as_the_beam_does(position):
    """Inside by its weights of the links, at an end beyond the end joint."""
    beam = replace(STRIP, supports=("clamped", "free"), mass=(replace(BODY, position=position),))
    off = []
    for count in (40, 80):
        basis = SegmentModel(beam, count).time_basis()
        slopes, found = basis.shapes(np.array([position]), 1)[:3, 0], basis.attached_turns()[:3, 0]
        off.append(abs(found / slopes - 1.0).max())
    assert off[1] < 0.5 * off[0] < 5e-3


@pytest.mark.parametrize(("model", "order"), [(SegmentModel, 3), (HermiteModel, 2)])
def test_the_contact_line_of_links_is_of_class_c2_and_of_elements_c1(model, order):
    """C2 spline through the joints (Section II.B); C1 Hermite elements; the next derivative jumps."""
    basis = model(STRIP, 12).time_basis()
    nodes, tiny = basis.edges[1:-1], 1e-9
    for derivative in range(order + 1):
        left, right = basis.shapes(nodes - tiny, derivative)[:8], basis.shapes(nodes + tiny, derivative)[:8]
        assert (abs(right - left).max() / abs(right).max() < 1e-5) == (derivative < order), derivative


def test_raw_links_are_straight_and_turn_at_the_joints():
    model = SegmentModel(STRIP, 12)
    raw, smooth = model.time_basis(line="raw"), model.time_basis()
    joint, link = raw.edges[5], STRIP.length / 12
    inside = joint + link * np.array([0.1, 0.5, 0.9])
    assert np.ptp(raw.shapes(inside, 1), axis=1) == pytest.approx(0.0, abs=1e-9)
    assert raw.shapes(inside, 2) == pytest.approx(0.0)
    turn = raw.shapes(np.array([joint]), 1)[:, 0] - raw.shapes(np.array([joint - 1e-9]), 1)[:, 0]
    mu = np.pi * np.arange(1, 12) / 12
    expected = -4 * np.sin(mu / 2) ** 2 * raw.shapes(np.array([joint]), 0)[:, 0] / link
    assert turn == pytest.approx(expected, abs=1e-6 * abs(expected).max())  # a joint's angle is its second difference
    # corrected joints: (1 - s^2/3) times the raw ones
    at = np.array([joint])
    assert smooth.shapes(at, 0)[:, 0] == pytest.approx((1 - np.sin(mu / 2) ** 2 / 3) * raw.shapes(at, 0)[:, 0])


@pytest.mark.parametrize("supports", [("free", "free"), ("pinned", "free"), ("guided", "guided")])
@pytest.mark.parametrize("model", MODELS.built_in)
def test_a_beam_that_can_drift_away_is_refused(model, supports):
    beam, model = replace(STRIP, supports=supports), MODELS[model]
    with pytest.raises(InputError, match="rigid-body motion"):
        model.build(beam, 20 if model.sized else None).time_basis()


def test_dashpots_of_the_joints_are_for_harmonic_motion():
    with pytest.raises(InputError, match=r"joint_dashpot = 0\.3 is for harmonic fields"):
        SegmentModel(STRIP, 20, joint_dashpot=0.3).time_basis()
