"""Chains by themselves: Eq. (1), steps, unequal links, loads, readings, losses and devices."""

from math import pi, sqrt

import numpy as np
import pytest
from msgspec.structs import replace

from tests.reference.transfer import frequency_near, state
from verify.errors import InputError
from verify.exact import closed_forms
from verify.problem.beam import Beam, PointForce
from verify.problem.cross_section import Section
from verify.problem.point_attachments import PointMass, PointSpring
from verify.segment_model import SegmentModel

STEPPED = Beam(
    length=0.6,
    width=0.02,
    thickness=0.004,
    youngs_modulus=70e9,
    density=2700.0,
    supports=("clamped", "pinned"),
    section=(Section(length=0.25), Section(length=0.35, thickness=0.002, youngs_modulus=210e9, density=7850.0)),
)
FORCE = PointForce(position=0.111)
X = np.array([0.0171, 0.2003, 0.4444, 0.61])


def order(beam, mode, counts, **settings):
    found = [SegmentModel(beam, n, **settings).modes(mode).frequencies_hz[-1] for n in counts]
    exact = frequency_near(beam, "euler-bernoulli", found[-1])
    return np.log(abs((found[0] / exact - 1) / (found[1] / exact - 1))) / np.log(counts[1] / counts[0])


def test_two_links_swing_as_worked_out_by_hand(titanium_strip):
    """One unknown y: spring (2 y / l)^2 k, kinetic energy 2 m y'^2 / 3, so omega^2 = 6 EI / (rho A l^4)."""
    omega = sqrt(6) * titanium_strip.wave_constant / (titanium_strip.length / 2) ** 2
    assert SegmentModel(titanium_strip, 2).modes(1).frequencies_hz[0] == pytest.approx(omega / (2 * pi), rel=1e-15)


def test_a_joint_between_sections_is_two_half_links_one_after_the_other():
    """Eq. (1) with its indices put right, in the stiffness and the mean length of the first section."""
    links = SegmentModel(STEPPED, 12)
    k = 1 / links.chain.compliances[5]
    (li, lj), ratio = links.links.lengths[4:6], 3 / 8
    assert k == pytest.approx(2 * ratio / (lj + ratio * li), rel=1e-14)


def test_eq_1_put_right_is_of_order_two_and_as_printed_of_order_one():
    assert order(STEPPED, 2, (96, 192)) == pytest.approx(2.0, abs=0.03)
    assert order(STEPPED, 2, (384, 768), joints="printed") == pytest.approx(1.0, abs=0.03)
    orders = [SegmentModel(STEPPED, 9, joints=joints).expected_order() for joints in ("series", "printed")]
    assert orders == [2, 1]


def test_unequal_links_are_of_order_two(titanium_strip):
    assert order(titanium_strip, 3, (60, 120), grading=2.5) == pytest.approx(2.0, abs=0.05)
    assert SegmentModel(titanium_strip, 60, grading=2.5).expected_order() == 2


def test_printed_and_series_agree_where_the_paper_needs_them(titanium_strip):
    lighter = (Section(length=0.3), Section(length=0.43, density=1000.0))
    for beam in (titanium_strip, replace(titanium_strip, section=lighter)):
        printed, series = (SegmentModel(beam, 20, joints=j).modes(5).frequencies_hz for j in ("printed", "series"))
        assert printed == pytest.approx(series, rel=1e-13)


@pytest.mark.parametrize(
    ("change", "settings", "expected"),
    [
        ({"tension": 3.0}, {}, 2),
        ({"tension": 3.0}, {"joints": "tensioned"}, 4),
        ({"mass": (PointMass(position=0.3, mass=0.1, rotary_inertia=1e-4),)}, {}, 4),
        ({"mass": (PointMass(position=0.3, mass=0.1, rotary_inertia=1e-4),)}, {"attachment": "lever"}, 1),
        ({"mass": (PointMass(position=0.3, mass=0.1),)}, {"attachment": "lever"}, 2),
        ({"foundation": 30.0}, {"theory": "timoshenko"}, 2),
        ({"supports": ("free", "pinned"), "spring": (PointSpring(position=0.0, rotational=2.0),)}, {"wall": "half"}, 2),
        ({"tension": 3.0, "spring": (PointSpring(position=0.2, rotational=2.0),)}, {"joints": "tensioned"}, None),
    ],
)
def test_the_expected_order_is_the_least_that_applies(titanium_strip, change, settings, expected):
    assert SegmentModel(replace(titanium_strip, **change), 20, **settings).expected_order() == expected


@pytest.mark.parametrize(
    ("load", "reading", "expected"),
    [("lever", "raw", 2.0), ("reciprocal", "raw", 2.0), ("reciprocal", "links", 2.0), ("reciprocal", "corrected", 4.0)],
)
def test_orders_of_loads_and_readings(titanium_strip, load, reading, expected):
    forces = (PointForce(position=0.73 / 8, amplitude=0.7), PointForce(position=0.73 * 5 / 6))
    every = np.linspace(0.01, 0.72, 57)
    exact = sum(
        one.amplitude
        * np.array([state(titanium_strip, "euler-bernoulli", 123.0, one.position, float(x))[0] for x in every])
        for one in forces
    )
    off = []
    for n in (60, 480):
        found = SegmentModel(titanium_strip, n, load=load, reading=reading).harmonic(forces, 123.0).deflection(every)
        off.append(abs(found - exact).max() / abs(exact).max())
    assert np.log2(off[0] / off[1]) / 3 == pytest.approx(expected, abs=0.2)


def test_one_loss_factor_one_modal_ratio_one_dashpot_damp_a_resonance_alike(titanium_strip):
    frequency, eta = closed_forms.frequency_hz(titanium_strip, 3), 0.004
    dashpot = eta * titanium_strip.bending_stiffness / (0.73 / 60) / (2 * pi * frequency)
    by_loss = SegmentModel(replace(titanium_strip, loss_factor=eta), 60).harmonic(FORCE, frequency).deflection(X)
    model = SegmentModel(titanium_strip, 60)
    by_ratio = model.harmonic(FORCE, frequency, modal_damping=eta / 2).deflection(X)
    by_dashpot = SegmentModel(titanium_strip, 60, joint_dashpot=dashpot).harmonic(FORCE, frequency).deflection(X)
    assert by_ratio == pytest.approx(by_loss, rel=0.002)
    assert by_dashpot == pytest.approx(by_loss, rel=1e-10)
    with pytest.raises(InputError, match="resonance of the segment model"):
        model.harmonic(FORCE, float(model.modes(3).frequencies_hz[2]))


@pytest.mark.parametrize("theory", ["euler-bernoulli", "rayleigh", "timoshenko"])
def test_sweeps_and_receptances_are_the_fields_of_each_frequency(titanium_strip, theory):
    beam = replace(titanium_strip, supports=("clamped", "free"), loss_factor=0.01, foundation=40.0)
    model, frequencies = SegmentModel(beam, 31, theory=theory), [31.0, 77.0, 140.0, 211.0, 390.0, 613.0]
    swept = model.harmonic(FORCE, frequencies).deflection(X)
    receptance = model.receptance([FORCE.position], frequencies, X)[:, 0]
    for i, frequency in enumerate(frequencies):
        alone = model.harmonic(FORCE, frequency).deflection(X)
        assert swept[i] == pytest.approx(alone, rel=1e-8)
        assert receptance[i] == pytest.approx(alone, rel=1e-8)
