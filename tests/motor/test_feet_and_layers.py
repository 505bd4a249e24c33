"""A motor on a foot of many points: its own motion beside DOP853, and the driving layer that it becomes."""

from functools import cache
from math import cos, pi, sin

import motor_references as by
import numpy as np
import pytest
from motor_setups import HALF, MIDDLE, OMEGA, PERIOD, drive, ridden
from msgspec.structs import replace

from verify.contact import foot as lying
from verify.contact import layer
from verify.motor.outcome import layer_epsilon
from verify.slider import Contact, Foot, Slider

HEIGHT = 1e-8
"""Of the wave, metres: w_t w' is 2e-5 of the speed of its crests."""
WAVE = drive(HEIGHT)[1]
LENGTH = 2.0 * pi / WAVE.k
CRESTS = HALF * WAVE.k * OMEGA * HEIGHT
KAPPA, MU, PERIODS = 2e9, 0.2, 2
FEET = [(0.31, 5, 0.0, True), (1.0, 8, 0.0, True), (1.37, 9, 3.0, True), (0.31, 5, 0.0, False)]


@cache
def followed(spans, n, damping, pitches):
    """(wave lengths, DOP853's rows at each period) of a foot held at a speed."""
    wave = drive(1e-6, 0.1)[1]
    length, mass, load, stiffness = spans * LENGTH, 4e-3, 3.0, 6e6
    arms = by.cells(length, n)
    foot = by.Foot(
        mass,
        mass * length**2 / 12.0,
        load,
        stiffness,
        arms,
        damping=damping,
        mu=MU,
        speed=-1e-4,
        half=HALF,
        pitches=pitches,
    )
    level = by.lain_on(by.felt(wave.at, MIDDLE + arms, 0.0, HALF)[0], load / stiffness)
    times = np.arange(1, PERIODS + 1) * PERIOD
    rows = by.foot_ridden(foot, wave, MIDDLE, [level, 0.0, 0.0, 0.0], times, rtol=1e-8, max_step=0.05 * PERIOD)
    return foot, rows


def foot_run(spans, n, damping, pitches, step):
    foot, _ = followed(spans, n, damping, pitches)
    slider = Slider(
        mass=foot.mass,
        mu=MU,
        law="coulomb",
        gravity=0.0,
        preload=foot.load,
        coupling="one-way",
        contact=Contact(stiffness=foot.stiffness, damping=damping),
        foot=(Foot(length=spans * LENGTH, points=n, pitches=pitches),),
    )
    return ridden(slider, 1e-6, 0.1, PERIODS, step, held_speed=foot.speed, samples=PERIODS + 1)


def foot_misses(case, step):
    """Largest misses of height and pitch (times length) over 1 um, and of N and T over the load."""
    (foot, rows), run = followed(*case), foot_run(*case, step)
    heights = np.abs(run.height[1:, 0] - rows[:, 0]).max() / 1e-6
    turns = np.abs(run.pitch[1:, 0] - rows[:, 2]).max() * case[0] * LENGTH / 1e-6
    impulses = np.array([run.normal_force[1:].sum(), run.friction[1:].sum(), run.contact_share[1:].sum()]) * PERIOD
    scales = PERIODS * PERIOD * np.array([foot.load, foot.load, 1.0])
    return max(heights, turns), *np.abs((impulses - rows[-1, 4:7]) / scales)


@pytest.mark.parametrize("case", FEET)
def test_a_foot_rises_turns_and_rubs_as_dop853_says(case):
    motion, pressed, dragged, touched = foot_misses(case, 4000)
    assert motion < 3e-5
    assert pressed < 1e-6
    assert dragged < 2e-4
    assert touched < 2e-4


@pytest.mark.parametrize("case", [FEET[0], FEET[1], FEET[3]])
def test_a_foot_is_of_second_order_in_the_step(case):
    coarse, fine = (np.mean([foot_misses(case, step)[0] for step in steps]) for steps in ((125, 133), (4000, 4256)))
    assert 1.4 < np.log2(coarse / fine) / 5.0 < 2.6


def slid(phi, r, epsilon=0.0, n=61, step=127, periods=3, **asked):
    """(run, load) of an upright foot of one wavelength at r times the crests' speed, its place kept."""
    load = 2.0 * KAPPA * HEIGHT * layer.pressed(phi, phi) / WAVE.k
    give = 2.0 * MU * KAPPA / (epsilon * WAVE.k * 2.0 * HALF) if epsilon else None
    given = {"mass": 0.05, "speed": -r * CRESTS, **asked.pop("slider", {})}
    foot = Foot(length=LENGTH, points=n, pitches=False, mass=0.05)
    slider = Slider(
        mu=MU,
        law="coulomb",
        gravity=0.0,
        preload=load,
        coupling="one-way",
        foot=(foot,),
        contact=Contact(layer_stiffness=KAPPA, layer_tangential_stiffness=give),
        **given,
    )
    asked = {"held_speed": -r * CRESTS, "frozen": True, "samples": periods + 1, **asked}
    return ridden(slider, HEIGHT, periods=periods, step=step, **asked), load


def dragged(phi, r, epsilon=0.0, **given):
    """F/(mu N) over the last period; the wave runs to the right and its crests drive to the left."""
    run, load = slid(phi, r, epsilon, **given)
    return -run.friction[-1] / (MU * load)


@pytest.mark.parametrize("phi", [0.5, 1.0, 1.5, 2.2])
@pytest.mark.parametrize(("r", "epsilon"), [(0.6, 0.0), (0.9, 0.0), (0.3, 0.5), (0.8, 3.0), (0.0, 18.0), (-0.4, 1.3)])
def test_a_foot_of_many_points_is_a_driving_layer(phi, r, epsilon):
    assert dragged(phi, r, epsilon) == pytest.approx(layer.force(phi, r, epsilon), abs=2e-3)
    run, _ = slid(phi, r, epsilon)
    assert run.contact_share[-1] == pytest.approx(phi / pi, abs=2e-3)
    assert run.motor_margins.epsilon == pytest.approx(epsilon, rel=1e-12)
    assert run.height[-1, 0] / HEIGHT == pytest.approx(cos(phi), abs=2e-3)


@pytest.mark.parametrize(("phi", "r"), [(0.6, 0.9), (1.0, 0.6), (1.3, 0.8)])
def test_power_and_efficiency_are_the_layers(phi, r):
    run, load = slid(phi, r, step=509)
    given = run.carried[-1] / PERIOD / (MU * load * CRESTS)
    assert given == pytest.approx(r * layer.force(phi, r) / layer.efficiency(phi, r), abs=1e-3)
    assert -run.friction[-1] * r * CRESTS / (run.carried[-1] / PERIOD) == pytest.approx(
        layer.efficiency(phi, r), abs=1e-3
    )
    assert run.rubbed[-1] / PERIOD / (MU * load * CRESTS) == pytest.approx(given - r * layer.force(phi, r), abs=1e-3)


def test_a_layer_that_gives_way_is_of_second_order_in_the_step():
    """Root mean square over cases, against the same foot in steps finer by far: the number of points does not tell."""
    cases = [(1.0, 0.87, 0.1), (1.0, 0.0, 3.0), (1.4, 0.5, 0.7), (0.7, 0.9, 1.0), (1.9, 0.3, 0.4), (1.3, 0.68, 0.4)]
    best = np.array([dragged(*case, step=4999) for case in cases])
    off = [[np.subtract([dragged(*case, step=n) for case in cases], best) for n in s] for s in ((31, 37), (251, 257))]
    coarse, fine = np.sqrt(np.mean(np.square(off), axis=(1, 2)))
    assert 1.5 < np.log2(coarse / fine) / 3.0 < 2.5
    assert fine < 3e-4


def test_points_become_a_layer_as_the_square_of_their_distance_or_faster():
    """Root mean square of F/(mu N) over loads and speeds, of 4 to 32 points a wavelength that carry a given load."""
    cases = [(phi, r) for phi in (0.7, 0.9, 1.1, 1.3, 1.6) for r in (0.2, 0.71, 0.83)]
    off = []
    for n in (4, 8, 16, 32):
        misses = [dragged(phi, r, n=n, step=509) - layer.force(phi, r) for phi, r in cases]
        off.append(np.sqrt(np.mean(np.square(misses))))
    assert off[-1] < 1.5e-3
    order = np.log2(off[0] / off[-1]) / 3.0
    assert 1.4 < order < 3.2


@pytest.mark.parametrize(("phi", "epsilon"), [(1.0, 0.0), (1.0, 0.1), (1.3, 18.0), (0.6, 0.03)])
def test_a_slider_runs_free_at_the_no_load_speed(phi, epsilon):
    """From 3 % above and below, of 4 kg so that a period does not tell."""
    wanted = layer.no_load_speed(phi, epsilon)
    for start in (0.97, 1.03):
        given = {"slider": {"mass": 4.0, "speed": -start * wanted * CRESTS}, "held_speed": None, "periods": 200}
        run, _ = slid(phi, 0.0, epsilon, step=127, **given)
        assert -run.speed[-1] / CRESTS == pytest.approx(wanted, abs=2e-3)


def test_the_papers_figures_of_a_stuck_layer_and_of_coulombs_are_eleven_per_cent_apart():
    sticks, slips = (-dragged(1.0, r, e) for r, e in ((sin(1.0), 18.0), (0.942089316298, 0.0)))
    assert abs(sticks) < 2e-3
    assert abs(slips) < 3e-3


@pytest.mark.parametrize("waves", [0.15, 0.3, 0.42, 0.5])
def test_a_short_foot_drives_by_its_length_and_has_a_dead_band(waves):
    """Upright, so light and pressed so hard that it never leaves; a point gives way by a hundredth of the height."""
    span, n, pressed = pi * waves, 41, 0.01
    for r in (0.0, 0.3):
        slider = Slider(
            mass=1.0,
            mu=MU,
            law="coulomb",
            gravity=0.0,
            preload=pressed,
            coupling="one-way",
            contact=Contact(stiffness=3e9, damping=40.0),
            foot=(Foot(length=waves * LENGTH * n / (n - 1.0), points=n, pitches=False, mass=2e-6),),
        )
        run = ridden(slider, HEIGHT, periods=2, step=16000, held_speed=-r * CRESTS, frozen=True, samples=3)
        assert -run.friction[-1] / (MU * pressed) == pytest.approx(lying.short_foot_force(span, r), abs=0.02)
    assert lying.dead_band(span) == pytest.approx(min(2.0 * waves, 1.0), rel=1e-12)


def test_a_point_alone_is_not_driven_at_all_while_it_stays_on():
    slider = Slider(
        mass=1.0,
        mu=MU,
        law="coulomb",
        gravity=0.0,
        preload=1.0,
        coupling="one-way",
        contact=Contact(stiffness=3e9, damping=40.0),
        foot=(Foot(mass=2e-4),),
    )
    run = ridden(slider, HEIGHT, periods=2, step=4000, held_speed=0.0, frozen=True, samples=3)
    assert run.friction[-1] / MU == pytest.approx(0.0, abs=2e-3)


def test_epsilon_is_that_of_the_foot_which_slips_least_before_it_gives_way():
    """Each foot has all of one stiffness and a layer's along its length: the short one gives way three times as far."""
    contact = Contact(stiffness=3.1e5, layer_tangential_stiffness=7.7e6)
    feet = (Foot(length=0.021, points=3, offset=-0.03), Foot(length=0.007, points=3, offset=0.02))
    slider = Slider(mass=0.01, mu=0.23, law="coulomb", preload=0.4, contact=contact, foot=feet)
    expected = 2.0 * 0.23 * 3.1e5 / (7.7e6 * 0.007 * 91.0 * 0.0013)
    assert layer_epsilon(slider, 91.0, 0.0013) == pytest.approx(expected, rel=1e-14)
    assert layer_epsilon(replace(slider, foot=feet[::-1]), 91.0, 0.0013) == pytest.approx(expected, rel=1e-14)
