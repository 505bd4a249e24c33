"""What every engine is given, and what is refused."""

import msgspec
import numpy as np
import pytest
from peer_cases import FORCES, FREQUENCY

from verify.beam import PointForce
from verify.errors import InputError
from verify.peers.case import case_of, sled_of, surface_speed
from verify.slider import Slider, changed

SLIDER = Slider(mass=1e-3, mu=0.2, preload=0.4, position=0.31, coupling="one-way")


def test_a_case_has_the_beams_own_mass_length_and_stiffness(titanium_strip, asymmetric_case):
    case, beam = asymmetric_case, titanium_strip
    assert case.n * case.mass == pytest.approx(beam.mass_per_length * beam.length, rel=1e-14)
    assert case.length == pytest.approx(0.73, rel=1e-14)
    assert case.spring == pytest.approx(13 * beam.bending_stiffness / 0.73, rel=1e-14)
    assert case.inertia == pytest.approx(case.mass * (0.73 / 13) ** 2 / 12, rel=1e-14)


def test_forces_lead_by_their_phases(asymmetric_case):
    t = 1.3e-4
    turned = 2 * np.pi * FREQUENCY * t + np.radians([-37.0, 71.0, 160.0])
    assert asymmetric_case.now(t) == pytest.approx([0.013, 0.021, 0.005] * np.cos(turned), rel=1e-12)


def test_a_place_is_a_link_and_what_is_left_on_it(asymmetric_case):
    link = 0.73 / 13
    assert asymmetric_case.place(0.0731) == (1, pytest.approx(0.0731 - link, rel=1e-12))
    assert asymmetric_case.place(3 * link)[0] == 3
    assert asymmetric_case.place(0.73) == (12, pytest.approx(link, rel=1e-12))


@pytest.mark.parametrize(
    ("change", "count", "forces", "said"),
    [
        ({"supports": ("clamped", "pinned")}, 13, FORCES, "beam.supports .*give"),
        ({"tension": 3.0}, 13, FORCES, "beam.tension"),
        ({"loss_factor": 0.01}, 13, FORCES, "beam.loss_factor = 0.01"),
        ({}, 5, FORCES, "count = 5"),
        ({}, 13, (PointForce(position=0.74),), r"force\[0\].position = 0.74 lies off the beam"),
    ],
)
def test_what_the_peers_chain_is_not_is_refused_by_name(titanium_strip, change, count, forces, said):
    with pytest.raises(InputError, match=said):
        case_of(msgspec.structs.replace(titanium_strip, **change), count, forces, FREQUENCY)


@pytest.mark.parametrize("change", [{"law": "coulomb"}, {"kinematics": "following"}, {"coupling": "auto"}])
def test_a_slider_that_does_more_is_refused_by_name(titanium_strip, change):
    ((field, word),) = change.items()
    with pytest.raises(InputError, match=f"slider.{field} = '{word}'"):
        sled_of(titanium_strip, changed(SLIDER, **change))


def test_a_sled_is_pressed_on_by_weight_and_preload(titanium_strip):
    sled = sled_of(titanium_strip, SLIDER)
    assert sled.friction == pytest.approx(0.2 * (9.81e-3 + 0.4), rel=1e-12)
    assert sled.half_thickness == pytest.approx(0.00115, rel=1e-14)
    assert sled.force(1e9) == -sled.friction
    assert sled.force(-2e-5) == pytest.approx(sled.friction * np.tanh(0.2), rel=1e-12)


def test_the_surface_follows_turning_links_and_reads_a_parabola_of_spins_between_joints(asymmetric_case, sled):
    """Catmull and Rom's cubic is exact up to parabolas in the joints' spins, which are means of two links."""
    middles = (np.arange(13) + 0.5) * asymmetric_case.link
    spins, x = 3.0 - 2.0 * middles + 7.0 * middles**2, 0.2573
    joints = 3.0 - 2.0 * x + 7.0 * (x**2 + 0.25 * asymmetric_case.link**2)
    assert surface_speed(asymmetric_case, sled, spins, x) == pytest.approx(-sled.half_thickness * joints, rel=1e-12)
    near = spins[2:7].tolist()
    assert surface_speed(asymmetric_case, sled, near, x, 2) == surface_speed(asymmetric_case, sled, spins, x)
