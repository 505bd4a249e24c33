"""Chains with rotary inertia and shear."""

from math import pi

import mpmath as mp
import numpy as np
import pytest
from msgspec.structs import replace

from tests.reference.transfer import frequency_near
from verify.fem_beam import HermiteModel
from verify.problem.beam import Beam, PointForce
from verify.problem.cross_section import Section
from verify.problem.point_attachments import PointMass, PointSpring
from verify.segment_model import SegmentModel

L, EI, RHO_A, RHO_I, GA = 0.73, 3.7, 0.31, 3e-5, 2e4
M = RHO_A * L
THICK = Beam(length=L, bending_stiffness=EI, mass_per_length=RHO_A, rotary_inertia=RHO_I, shear_stiffness=GA)
ENDS = {
    "PP": ("pinned", "pinned"),
    "CF": ("clamped", "free"),
    "FF": ("free", "free"),
    "CC": ("clamped", "clamped"),
    "GP": ("guided", "pinned"),
    "CG": ("clamped", "guided"),
}
THEORIES = ["rayleigh", "timoshenko"]


def errors(beam, mode, counts, theory, **settings):
    found = [SegmentModel(beam, n, theory=theory, **settings).modes(mode).frequencies_hz[-1] for n in counts]
    exact = frequency_near(beam, theory, found[-1])
    return [f / exact - 1 for f in found]


def order(beam, mode, counts, theory, **settings):
    first, second = errors(beam, mode, counts, theory, **settings)
    return np.log(abs(first / second)) / np.log(counts[1] / counts[0])


def discrete_hz(mode, count, theory):
    """Pinned ends, S = 2 sin(mu/2)/l: their dispersion (`docs/theory.md`) in 30 digits."""
    with mp.workdps(30):
        link = mp.mpf(L) / count
        s2 = 4 * mp.sin(mode * mp.pi / (2 * count)) ** 2 / link**2
        soft = mp.mpf(0) if theory == "rayleigh" else mp.mpf(RHO_A) / GA
        a = soft * (RHO_I + RHO_A * link**2 / 12)
        b = RHO_I * s2 + RHO_A * (1 - link**2 * s2 / 6) + soft * EI * s2
        c = EI * s2**2
        return float(mp.sqrt(2 * c / (b + mp.sqrt(b * b - 4 * a * c))) / (2 * mp.pi))


@pytest.mark.parametrize("theory", THEORIES)
@pytest.mark.parametrize("count", [8, 49, 300, 2000])
def test_pinned_links_follow_the_exact_discrete_dispersion(theory, count):
    found = SegmentModel(THICK, count, theory=theory).modes(5).frequencies_hz
    assert found == pytest.approx([discrete_hz(n, count, theory) for n in range(1, 6)], rel=2e-14)


@pytest.mark.parametrize("theory", THEORIES)
@pytest.mark.parametrize("supports", ENDS)
def test_thickness_lowers_a_chain_to_order_two_and_corrected_joints_keep_four(theory, supports):
    beam = replace(THICK, supports=ENDS[supports])
    assert order(beam, 3, (160, 320), theory) == pytest.approx(2.0, abs=0.03)
    if "C" not in supports:
        assert order(beam, 3, (80, 160), theory, joints="tensioned") == pytest.approx(4.0, abs=0.05)
    else:  # between four and five, as Gregory's joints are before they change sign
        corrected, plain = (errors(beam, 3, (160,), theory, joints=joints)[0] for joints in ("tensioned", "series"))
        assert abs(corrected) < 0.015 * abs(plain)


@pytest.mark.parametrize("theory", THEORIES)
def test_the_leading_error_is_that_of_thickness_inertia(theory):
    """omega^2 is off by -(beta r)^2 mu^2/12, r^2 = rho I/rho A, while thickness and shear are small."""
    mode, count = 1, 160
    expected = -0.5 * (mode * pi / L) ** 2 * RHO_I / RHO_A * (mode * pi / count) ** 2 / 12
    assert errors(THICK, mode, (count,), theory)[0] == pytest.approx(expected, rel=0.02)


BODIES = {
    "mass": {"mass": (PointMass(position=0.375 * L, mass=0.4 * M),)},
    "mass off the joints": {"mass": (PointMass(position=L / 3, mass=0.4 * M),)},
    "spring": {"spring": (PointSpring(position=0.375 * L, stiffness=200 * EI / L**3),)},
    "rotary inertia": {"mass": (PointMass(position=0.375 * L, rotary_inertia=0.01 * M * L**2),)},
    "rotational spring": {"spring": (PointSpring(position=0.375 * L, rotational=8 * EI / L),)},
    "mass on a spring": {
        "mass": (PointMass(position=0.375 * L, mass=0.4 * M),),
        "spring": (PointSpring(position=0.375 * L, stiffness=200 * EI / L**3),),
    },
}


@pytest.mark.parametrize("body", BODIES)
def test_what_stands_on_a_beam_that_shears_is_of_order_two(body):
    assert order(replace(THICK, **BODIES[body]), 1, (250, 1000), "timoshenko") == pytest.approx(2.0, abs=0.06)


AT_ENDS = {
    "FF mass": ("FF", {"mass": (PointMass(position=0.0, mass=0.4 * M),)}),
    "GP mass": ("GP", {"mass": (PointMass(position=0.0, mass=0.4 * M),)}),
    "CF mass on a spring": (
        "CF",
        {
            "mass": (PointMass(position=L, mass=0.4 * M),),
            "spring": (PointSpring(position=L, stiffness=30 * EI / L**3),),
        },
    ),
    "FF elastic clamp": (
        "FF",
        {"spring": (PointSpring(position=0.0, stiffness=300 * EI / L**3, rotational=5 * EI / L),)},
    ),
}


@pytest.mark.parametrize("case", AT_ENDS)
def test_what_stands_at_an_end_that_shears_is_of_order_two(case):
    supports, what = AT_ENDS[case]
    beam = replace(THICK, supports=ENDS[supports], **what)
    assert order(beam, 1, (320, 960), "timoshenko") == pytest.approx(2.0, abs=0.1)


@pytest.mark.parametrize("supports", ENDS)
@pytest.mark.parametrize("count", [7, 49, 300])
def test_stiff_shear_is_rayleighs_chain_and_no_thickness_is_euler_bernoullis(supports, count):
    body = {"mass": (PointMass(position=0.37 * L, mass=0.2 * M, rotary_inertia=0.003),)}
    beam = replace(THICK, supports=ENDS[supports], **body)
    stiff = replace(beam, shear_stiffness=1e16)
    slender = replace(stiff, rotary_inertia=1e-25)
    rayleigh, plain, limits = (
        SegmentModel(beam, count, theory="rayleigh").modes(4).frequencies_hz,
        SegmentModel(beam, count).modes(4).frequencies_hz,
        [SegmentModel(one, count, theory="timoshenko").modes(4).frequencies_hz for one in (stiff, slender)],
    )
    assert limits[0] == pytest.approx(rayleigh, rel=1e-12)
    assert limits[1] == pytest.approx(plain, rel=1e-12)
    assert SegmentModel(slender, count, theory="rayleigh").modes(4).frequencies_hz == pytest.approx(plain, rel=1e-13)


def test_ground_under_a_beam_that_shears_keeps_order_two():
    beam = replace(THICK, supports=ENDS["CF"], foundation=900.0)
    assert order(beam, 1, (160, 320), "timoshenko") == pytest.approx(2.0, abs=0.03)


@pytest.mark.parametrize("settings", [{}, {"theory": "rayleigh", "joints": "tensioned"}, {"theory": "timoshenko"}])
def test_a_field_decays_by_the_wavenumber_with_dashpots_in_the_joints(settings):
    model = SegmentModel(
        Beam(length=80.0, width=0.02, thickness=0.02, youngs_modulus=70e9, density=2700.0, supports=("free", "free")),
        200, joint_dashpot=200.0, reading="raw", **settings,
    )  # fmt: skip
    here, there = model.harmonic(PointForce(position=5.1), 300.0).deflection(model.unit * np.array([80.0, 81.0]))
    k = 1j * np.log(there / here) / model.unit
    assert k.imag < -0.8
    assert model.wavenumber(300.0) == pytest.approx(k, rel=1e-9)


def test_elements_carry_waves_up_to_a_half_wave_each_on_the_worst_section():
    """By the fastest waves of elements in closed form; softer with shear, lower on a section of half the thickness."""
    beam = Beam(length=0.43, width=0.019, thickness=0.003, youngs_modulus=113e9, density=4470.0, poissons_ratio=0.31)
    model = HermiteModel(beam, 11)
    assert model.cut_off_hz == pytest.approx((1680 / 17) ** 0.5 * beam.wave_constant / (2 * pi * model.unit**2))
    assert model.wavenumber(model.cut_off_hz * (1 - 1e-9)) * model.unit == pytest.approx(pi, abs=1e-4)
    assert 0.9 < HermiteModel(beam, 11, theory="timoshenko").cut_off_hz / model.cut_off_hz < 0.999
    stepped = replace(beam, section=(Section(length=0.23), Section(length=0.2, thickness=0.0015)))
    for kind in (HermiteModel, SegmentModel):
        assert kind(stepped, 43).cut_off_hz == pytest.approx(0.5 * kind(beam, 43).cut_off_hz)
