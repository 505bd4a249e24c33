"""A foot of many points: lift-off, the layer that many points become, feet on both faces."""

from math import cos, pi

import numpy as np
import pytest
import reference.motor as by
from driven_strip import HALF, HERTZ, OMEGA, PAIR, STRIP, drive, on_strip
from msgspec.structs import replace

from verify import Contact, Excitation, Foot, Keep, Slider, simulate
from verify.analysis.linearity import sag_margins
from verify.analysis.solution_cache import SolutionCache
from verify.cases import layer

HEIGHT = 1e-8
"""Of the wave, metres: w_t w' is 2e-5 of the speed of its crests."""
WAVE = drive(HEIGHT)[1]
LENGTH = 2.0 * pi / WAVE.k
CRESTS = HALF * WAVE.k * OMEGA * HEIGHT
KAPPA, MU = 2e9, 0.2


def put(**given):
    own = {"mass": 1.0, "mu": MU, "law": "coulomb", "gravity": 0.0, "coupling": "one-way"}
    return Slider(**{**own, **given})


@pytest.mark.parametrize(("ratio", "zeta"), [(0.41, 0.23), (1.7, 0.31), (0.93, 0.42)])
def test_the_least_normal_force_below_lift_off_is_the_closed_form(ratio, zeta):
    """N falls to 1 - share of the load where the acceleration is this share of |1 - r^2/(1 + 2 i zeta r)|."""
    stiffness = 2e-3 * (OMEGA / ratio) ** 2
    contact = Contact(stiffness=stiffness, damping=2.0 * zeta * np.sqrt(stiffness * 2e-3))
    for share in (0.5, 0.9, 1.1):
        load = 2e-3 * 1e-6 * OMEGA**2 / (share * by.lift_off_ratio(ratio, zeta))
        slider = put(mass=2e-3, preload=load, contact=contact)
        found = on_strip(slider, periods=40, steps=400, speed=0.0, samples=16001)
        assert found.pressures[-2000:].min() / load == pytest.approx(max(1.0 - share, 0.0), abs=2e-3)


def slid(phi, r, epsilon=0.0, n=61, steps=127):
    """(run, load) of an upright foot of one wavelength at r times the crests' speed, fixed at its place."""
    load = 2.0 * KAPPA * HEIGHT * layer.normal_integral(phi, phi) / WAVE.k
    give = 2.0 * MU * KAPPA / (epsilon * WAVE.k * 2.0 * HALF) if epsilon else None
    contact = Contact(layer_stiffness=KAPPA, layer_tangential_stiffness=give)
    feet = (Foot(length=LENGTH, points=n, pitches=False, mass=0.05),)
    slider = put(mass=0.05, speed=-r * CRESTS, preload=load, foot=feet, contact=contact)
    given = {"speed": -r * CRESTS, "fixed_position": True, "samples": 4}
    return on_strip(slider, HEIGHT, periods=3, steps=steps, **given), load


def dragged(phi, r, epsilon=0.0, **given):
    """F/(mu N) over the last period; the wave runs to the right and its crests drive to the left."""
    run, load = slid(phi, r, epsilon, **given)
    return -run.friction[-1] / (MU * load)


@pytest.mark.parametrize("phi", [0.5, 1.5, 2.2])
@pytest.mark.parametrize(("r", "epsilon"), [(0.9, 0.0), (0.3, 0.5), (0.8, 3.0), (-0.4, 1.3)])
def test_a_foot_of_many_points_is_a_driving_layer(phi, r, epsilon):
    run, load = slid(phi, r, epsilon, steps=257)
    found = -run.friction[-1] / (MU * load)
    assert found == pytest.approx(layer.force(phi, r, epsilon), abs=2e-3)
    assert run.contact_fraction[-1] == pytest.approx(phi / pi, abs=2e-3)
    assert run.margins.presliding == pytest.approx(epsilon, rel=1e-12)
    assert run.height[-1, 0] / HEIGHT == pytest.approx(cos(phi), abs=2e-3)


def test_a_layer_that_gives_way_is_of_second_order_in_the_step():
    cases = [(1.0, 0.87, 0.1), (1.0, 0.0, 3.0), (1.4, 0.5, 0.7), (0.7, 0.9, 1.0), (1.9, 0.3, 0.4), (1.3, 0.68, 0.4)]
    best = np.array([dragged(*case, steps=4999) for case in cases])
    off = [[np.subtract([dragged(*case, steps=n) for case in cases], best) for n in s] for s in ((31, 37), (251, 257))]
    coarse, fine = np.sqrt(np.mean(np.square(off), axis=(1, 2)))
    assert 1.5 < np.log2(coarse / fine) / 3.0 < 2.5
    assert fine < 3e-4


def test_points_become_a_layer_as_the_square_of_their_distance():
    cases = [(phi, r) for phi in (0.7, 0.9, 1.1, 1.3, 1.6) for r in (0.2, 0.71, 0.83)]
    off = [
        np.sqrt(np.mean([(dragged(*one, n=n, steps=509) - layer.force(*one)) ** 2 for one in cases]))
        for n in (4, 8, 16, 32)
    ]
    assert off[-1] < 1.5e-3
    assert 1.4 < np.log2(off[0] / off[-1]) / 3.0 < 3.2


@pytest.mark.parametrize("waves", [0.0, 0.15, 0.42])
def test_a_short_foot_drives_by_its_length(waves):
    """Upright, so light and pressed so hard that it never leaves; a point gives way by a hundredth of the height."""
    span, n = pi * waves, 41 if waves else 1
    foot = Foot(length=waves * LENGTH * n / (n - 1.0), points=n, pitches=False, mass=2e-6) if waves else Foot(mass=2e-6)
    slider = put(preload=0.01, contact=Contact(stiffness=3e9, damping=40.0), foot=(foot,))
    for r in (0.0, 0.3) if waves else (0.0,):
        run = on_strip(slider, HEIGHT, periods=2, steps=16000, speed=-r * CRESTS, fixed_position=True, samples=3)
        wanted = by.short_foot_force(span, r) if waves else 0.0
        assert -run.friction[-1] / (MU * 0.01) == pytest.approx(wanted, abs=0.02)


def test_epsilon_is_that_of_the_foot_which_slips_least_before_it_gives_way():
    """Each foot has all of one stiffness and a layer's along its length: the short one gives way three times as far."""
    contact = Contact(stiffness=3.1e5, layer_tangential_stiffness=7.7e6)
    feet = (Foot(length=0.021, points=3, offset=-0.03), Foot(length=0.007, points=3, offset=0.02))
    slider = Slider(mass=0.01, mu=0.23, law="coulomb", preload=0.4, contact=contact, foot=feet)
    expected = 2.0 * 0.23 * 3.1e5 / (7.7e6 * 0.007 * 91.0 * 0.0013)
    for own in (slider, replace(slider, foot=feet[::-1])):
        run = moved(own, seconds=2e-5, step=1e-7)
        k = np.sqrt(2.0 * np.pi * HERTZ / run.end.beam.wave_constant)
        thickness = 2.0 * run.end.beam.surface_distance
        assert run.margins.presliding == pytest.approx(expected * 91.0 * 0.0013 / (k * thickness), rel=1e-12)


STILL = [replace(one, amplitude=1e-9) for one in PAIR]
SLIDER = Slider(
    mass=0.21,
    mu=0.17,
    law="coulomb",
    preload=23.0,
    position=0.237,
    coupling="one-way",
    contact=Contact(stiffness=5e7, damping=900.0),
    foot=(Foot(length=0.044, points=23),),
)


def moved(slider, seconds=4e-3, forces=PAIR, beam=STRIP, samples=18, **given):
    kept = {"model": "segment", "count": 49, "keep": Keep(samples=samples), **given}
    return simulate(beam, Excitation(forces, HERTZ), seconds, slider=slider, **kept)


def test_feet_on_both_faces_are_driven_the_same_way_and_do_not_bend_the_beam():
    """At a crest the upper surface runs back, and the lower one where the beam is lowest, half a wave on."""
    foot = SLIDER.foot[0]
    upper, clasp, lower = (
        moved(replace(SLIDER, gravity=gravity, foot=feet))
        for gravity, feet in (
            (9.81, (foot,)),
            (0.0, (foot, replace(foot, face="lower"))),
            (0.0, (replace(foot, face="lower"),)),
        )
    )
    assert np.sign(upper.speed[-1]) == np.sign(clasp.speed[-1]) == np.sign(lower.speed[-1]) != 0.0
    assert sag_margins(SolutionCache(STRIP), clasp.slider)[0].size < 1e-20
    assert sag_margins(SolutionCache(STRIP), upper.slider)[0].level == "not trusted"
    assert clasp.normal_force[-9:].mean() == pytest.approx(23.0, rel=0.2)


def pinned_sag(x, at, load):
    """Deflection of a pinned beam at x under a load, metres: the closed form."""
    length = STRIP.length
    c, y = (length - at, x) if x <= at else (at, length - x)
    return load * c * y * (length**2 - c**2 - y**2) / (6.0 * length * STRIP.bending_stiffness)


def test_feet_of_a_clasp_that_are_not_above_each_other_bend_the_beam_by_their_couple():
    feet = (Foot(length=0.03, points=5, offset=-0.031), Foot(length=0.02, points=3, offset=0.043, face="lower"))
    slider = replace(SLIDER, gravity=0.0, preload=0.0031, foot=feet)
    loads = [
        (slider.initial_position(STRIP) + foot.offset, 0.5 * sign * slider.normal_force)
        for foot, sign in zip(feet, (-1.0, 1.0), strict=True)
    ]
    x = np.linspace(0.0, STRIP.length, 4001)
    slopes = np.gradient([sum(pinned_sag(at, *one) for one in loads) for at in x], x)
    assert sag_margins(SolutionCache(STRIP), slider)[0].size == pytest.approx(max(slopes**2), rel=1e-2)


def test_weight_presses_an_upper_foot_on_a_lower_one_off_and_sinks_into_springs_on_both_sides():
    stiff = replace(SLIDER, gravity=9.81, contact=Contact(stiffness=5e7))
    for face, load in (("upper", 23.0 + 0.21 * 9.81), ("lower", 23.0 - 0.21 * 9.81)):
        slider = replace(stiff, foot=(replace(SLIDER.foot[0], face=face),))
        found = moved(slider, 1e-3, STILL, samples=5)
        assert found.normal_force[1:] == pytest.approx(load, rel=1e-6)
        assert found.height[0, 0] == pytest.approx((-load if face == "upper" else load) / 5e7, rel=1e-6)
    between = replace(stiff, foot=(replace(SLIDER.foot[0], mirrored=True),))
    assert moved(between, 1e-3, STILL, samples=5).height[:, 0] == pytest.approx(-0.21 * 9.81 / 1e8, rel=1e-6)


def test_a_slider_between_two_beams_stays_in_the_middle_and_is_pressed_alike_from_both():
    found = moved(replace(SLIDER, gravity=0.0, foot=(replace(SLIDER.foot[0], mirrored=True),)))
    points = found.pressures.shape[1] // 2
    assert np.abs(found.height).max() < 1e-12
    lower, upper = found.pressures[:10, :points], found.pressures[:10, points:]  # then rounding grows: it may pitch
    assert lower == pytest.approx(upper, rel=1e-6, abs=1e-5)
    assert found.pressures[5:].sum(axis=1).min() > 0.0
    assert np.sign(found.speed[-1]) == np.sign(moved(SLIDER).speed[-1])


LAWS = [{"mass": 40.0}, {"mass": 1e-3}, {"mass": 1e-2, "mu_static": 0.4}, {"mass": 1e-3, "law": "tanh", "slope": 1e4}]


@pytest.mark.parametrize("own", LAWS)
def test_points_of_one_slider_take_its_momentum_and_create_no_energy(own):
    """Light sliders are at rest on single points of the wave in most steps; a stopped one on all of them."""
    load = 2.0 * KAPPA * HEIGHT * layer.normal_integral(1.0, 1.0) / WAVE.k
    feet = (Foot(length=LENGTH, points=61, pitches=False, mass=0.05),)
    slider = put(preload=load, contact=Contact(layer_stiffness=KAPPA), foot=feet, speed=-0.03 * CRESTS, **own)
    for height in (HEIGHT, 0.0):
        run = on_strip(slider, height, 0.0, 12, 61, samples=13)
        energy, gained = run.energy, slider.mass * (run.speed[-1] - slider.speed)
        assert run.statistics.unconverged == 0
        assert energy.created <= 1e-15 * energy.friction_loss
        assert energy.friction_loss > 0.0
        assert run.mean_friction * run.times[-1] == pytest.approx(gained, rel=1e-10)
        assert run.friction_loss.sum() - run.tangential_work.sum() == pytest.approx(
            0.5 * slider.mass * (slider.speed**2 - run.speed[-1] ** 2), rel=1e-8
        )
