"""Feet on a beam that they move, several sliders on one beam, free beams."""

from math import pi

import numpy as np
import pytest
from driven_strip import HERTZ as STRIP_HERTZ
from driven_strip import PAIR, PERIOD, STRIP
from msgspec.structs import replace
from reference.slider import hermite_modes

from verify import (
    Beam,
    Contact,
    Excitation,
    Foot,
    InputError,
    Keep,
    PointForce,
    PointSpring,
    PrescribedSlider,
    Slider,
    Step,
    simulate,
)
from verify.dynamics.linear_system import basis_of

BEAM = Beam(length=0.31, width=0.017, thickness=0.0023, youngs_modulus=113e9, density=4470.0)
HERTZ, ZETA, START = 700.0, 0.02, 0.117
TURN, OMEGA = 1.0 / HERTZ, 2.0 * pi * HERTZ
FORCES = (PointForce(position=0.05, amplitude=9.0), PointForce(position=0.23, amplitude=6.0, phase_deg=77.0))


def put(**own):
    given = {"mu": 0.3, "law": "coulomb", "gravity": 0.0, "position": START, "mass": 0.02, "preload": 4.0}
    return Slider(**{**given, **own})


@pytest.mark.parametrize(("share", "start"), [(0.7, "rest"), (3.0, "rest"), (3.0, "steady")])
def test_a_motor_that_stays_on_is_an_added_mass_on_a_spring(share, start):
    """m/(1 - m omega^2/k) at the place, in every mode of the same elements: by one linear solve.

    `share` is the body's own frequency on its contact over that of the drive.
    """
    mass, stiffness = 0.011, 0.011 * (share * OMEGA) ** 2
    own, shape = hermite_modes(BEAM, 4)
    loads = sum(f.amplitude * 1e-3 * np.exp(1j * np.deg2rad(f.phase_deg)) * shape(f.position, 0) for f in FORCES)
    here, felt = shape(START, 0), mass * OMEGA**2 / (1.0 - mass * OMEGA**2 / stiffness)
    alone = np.diag(own**2 - OMEGA**2 + 2j * ZETA * own * OMEGA)
    with_it, without = (np.linalg.solve(alone - one * np.outer(here, here), loads) @ here for one in (felt, 0.0))
    assert abs(with_it / without - 1.0) > 0.2
    slider = put(mass=mass, mu=1e-9, preload=2.0, contact=Contact(stiffness=stiffness))
    small = [replace(one, amplitude=1e-3 * one.amplitude) for one in FORCES]
    per, turns, grown = (400, 60, 20.0) if start == "rest" else (400, 700, 0.0)
    asked = {"model": "fem", "count": 4, "modal_damping": ZETA, "start": start, "step": TURN / per}
    keep = Keep(samples=turns * per // 20 + 1)
    found = simulate(BEAM, Excitation(small, HERTZ, grown), turns * TURN, slider=slider, keep=keep, **asked)
    last = found.times > (turns - 20) * TURN + 1e-9
    height = found.height[last, 0] - found.height[last, 0].mean()
    height = 2.0 * np.mean(height * np.exp(-1j * OMEGA * found.times[last]))
    wanted = with_it / (1.0 - mass * OMEGA**2 / stiffness)
    assert height == pytest.approx(wanted, abs=5e-3 * abs(wanted))


def held_at(speed, steps):
    """Mean friction over mu N on a point that rubs a little and stays on, from rest over twelve periods."""
    slider = put(mu=0.004, preload=30.0, contact=Contact(stiffness=4e5, damping=30.0))
    asked = {"model": "analytic", "modes": 4, "modal_damping": ZETA, "start": "rest", "step": TURN / steps}
    held = PrescribedSlider(slider, speed, fixed_position=True)
    found = simulate(BEAM, Excitation(FORCES, HERTZ), 12 * TURN, slider=held, keep=Keep(samples=13), **asked)
    assert found.contact_fraction[1:].mean() == pytest.approx(1.0, rel=1e-9)
    return found.friction[1:].mean() / (slider.mu * slider.preload)


def test_friction_that_the_beam_feels_reverses_within_the_step():
    """Of second order at every speed; a turn at the next step leaves up to 2/steps of mu N, at random."""
    speeds = (0.0, 0.004, -0.0031, 0.0073, 0.0017)
    coarse, fine, true = (np.array([held_at(speed, steps) for speed in speeds]) for steps in (101, 404, 4000))
    assert np.ptp(true) > 1.5
    assert np.abs(fine - true).max() < 1e-4
    assert 8.0 < np.linalg.norm(coarse - true) / np.linalg.norm(fine - true) < 32.0


# --- energy: a foot reads w(X) at X = x + (h/2) w'(x), and its force works on every mode by as much as that moves w(X)

PLACE, PRESS, SPRING = 0.1187, 1e4, 6e6
# --- a cantilever that feet run along and off

CANTILEVER = Beam(
    length=0.1, width=0.008, thickness=0.002, youngs_modulus=200e9, density=7850.0, supports=("clamped", "free")
)
SPRUNG = Slider(
    mass=0.02,
    mu=1e-6,
    position=0.015,
    preload=30.0,
    coupling="two-way",
    contact=Contact(stiffness=1e6, damping=5.0),
    foot=(Foot(length=0.009, points=2, offset=0.003),),
)


def crossing(slider=SPRUNG, duration=0.006, amplitude=0.0, speed=20.0, fixed_position=False, samples=37, **given):
    asked = {"model": "fem", "count": 10, "start": "rest", "modal_damping": 0.0, "keep": Keep(samples=samples)}
    excitation = Excitation(PointForce(position=0.05, amplitude=amplitude), 5000.0)
    slider = PrescribedSlider(slider, speed, fixed_position)
    return simulate(CANTILEVER, excitation, duration, slider=slider, **{**asked, **given})


@pytest.mark.parametrize("face", ["upper", "lower"])
def test_running_feet_work_on_the_beam_what_the_beam_gains(face):
    """Nothing drives it or damps it. A slope of up to 0.06 gives the feet as much again as the rise of the material."""
    slider = replace(SPRUNG, foot=(replace(SPRUNG.foot[0], face=face),), gravity=0.0)
    before = crossing(slider, duration=4e-4, step=6e-7, samples=2)
    found = crossing(slider, duration=2.9e-3, step=6e-7, samples=2, start=before)
    omegas = basis_of(CANTILEVER, "fem", 10, None, "spline").omegas
    first, last = (
        0.5 * float(one.rates @ one.rates + (omegas * one.q) @ (omegas * one.q)) for one in (before.end, found.end)
    )
    balance, gained = found.energy, last - first
    work = balance.friction_on_beam + balance.normal_on_beam
    assert gained > 0.01
    assert work == pytest.approx(gained, rel=1e-10)
    assert work == pytest.approx(-balance.normal_work - balance.tangential_work, rel=1e-9)
    assert abs(balance.slope_work) > 0.5 * gained
    assert abs(balance.residual) < 1e-6 * gained


HARD = replace(SPRUNG, coupling="one-way", contact=Contact(restitution=0.3), foot=())
ENDS = {
    "springs": ({}, 0.085 - 0.003 - 0.00225),
    "hard": ({"slider": HARD, "model": "analytic", "count": None, "start": "steady", "modal_damping": 0.01}, 0.085),
}


@pytest.mark.parametrize("name", ENDS)
def test_a_slider_that_runs_off_the_beam_ends_there_with_state_and_energy(name):
    given, way = ENDS[name]
    found = crossing(**{"amplitude": 3.0, **given})
    assert found.statistics.stopped.startswith("left the")
    travelled = found.end.position - found.start
    assert found.times[-1] < found.end.time
    assert travelled == pytest.approx(found.end.speed * found.end.time, rel=1e-9)
    assert abs(travelled - way) <= 20.0 * found.statistics.step_s
    if name == "springs":
        fine = crossing(step=Step(per_period=1600))
        assert abs(fine.energy.residual) < 2e-6 * fine.energy.slider
        there = crossing(step=fine.statistics.step_s, duration=fine.end.time, samples=2)
        assert there.statistics.stopped == "end"
        assert there.end.feet == pytest.approx(fine.end.feet, rel=1e-9, abs=1e-12)


@pytest.mark.parametrize("coupling", ["one-way", "two-way"])
def test_a_slider_kept_at_its_place_goes_up_no_slope_at_any_speed(coupling):
    slider = replace(SPRUNG, coupling=coupling, mu=0.3)
    given = {"fixed_position": True, "duration": 2e-3, "amplitude": 90.0, "step": 4e-7}
    still, found = (crossing(slider, speed=speed, **given) for speed in (0.0, 7.0))
    assert found.energy.slope_work == still.energy.slope_work == 0.0
    assert abs(found.energy.residual) < 2e-4 * found.energy.contact_loss
    if coupling == "one-way":
        assert found.energy.contact_loss == pytest.approx(still.energy.contact_loss, rel=1e-9)


# --- several sliders, and sliders between two beams

LIGHT = Slider(
    mass=0.01, mu=0.17, law="coulomb", preload=0.3, position=0.237, coupling="two-way", contact=Contact(stiffness=4e5)
)
KEPT = {"model": "segment", "count": 49}
DRIVEN = Excitation(PAIR, STRIP_HERTZ)


def test_sliders_that_the_beam_does_not_feel_move_as_each_alone():
    first = replace(LIGHT, coupling="one-way", foot=(Foot(length=0.044, points=23),))
    other = replace(first, mass=0.034, mu=0.11, position=0.331, foot=(Foot(length=0.03, points=11),))
    pulled = PrescribedSlider(replace(first, position=0.271), speed=0.0031)
    both, points = simulate(STRIP, DRIVEN, 4e-3, slider=[first, other, pulled], keep=Keep(samples=18), **KEPT), 0
    for number, slider in enumerate((first, other, pulled)):
        asked = {"step": both.statistics.step_s, "keep": Keep(samples=18), **KEPT}
        alone = simulate(STRIP, DRIVEN, 4e-3, slider=slider, **asked)
        own = slice(points, points := points + len(alone.point_offsets))
        assert both.start[number] == alone.start
        assert both.travelled[:, number] == pytest.approx(alone.travelled, rel=1e-6, abs=1e-12)
        assert both.height[:, number] == pytest.approx(alone.height[:, 0], rel=1e-6, abs=1e-12)
        assert both.point_offsets[own] == pytest.approx(alone.point_offsets, abs=1e-15)


def pinned_answers(x, at, hertz, ratio):
    """Deflections of the plain pinned beam at places under 1 N at x, by its sines."""
    n = np.arange(1, 2001)[:, None] * np.pi / STRIP.length
    own, omega = n**2 * np.sqrt(STRIP.bending_stiffness / STRIP.mass_per_length), 2.0 * np.pi * hertz
    share = 2.0 / (STRIP.mass_per_length * STRIP.length) / (own**2 - omega**2 + 2j * ratio * own * omega)
    return (share * np.sin(n * x) * np.sin(n * at)).sum(axis=0)


def test_the_size_of_coupling_is_of_the_loads_of_all_sliders():
    ratio, hertz = 0.011, 3911.0
    first = replace(LIGHT, coupling="one-way", gravity=0.0, preload=1.3e-3)
    sliders = [first, replace(first, position=0.331, preload=0.9e-3), replace(first, position=0.268, mu=0.4)]
    at = np.array([one.position for one in sliders])
    driven = sum(
        one.amplitude * np.exp(1j * np.radians(one.phase_deg)) * pinned_answers(one.position, at, hertz, ratio)
        for one in PAIR
    )
    lifted = sum(one.preload * np.abs(pinned_answers(one.position, at, hertz, ratio)) for one in sliders)
    asked = {"model": "analytic", "modal_damping": ratio, "keep": Keep(samples=2)}
    excitation = Excitation(PAIR, hertz)
    coupling = simulate(STRIP, excitation, 2e-5, slider=sliders, **asked).coupling
    assert not coupling.two_way
    assert coupling.normal_size == pytest.approx((lifted / np.abs(driven)).max(), rel=1e-3)
    assert coupling.normal_size > 1.5 * simulate(STRIP, excitation, 2e-5, slider=first, **asked).coupling.normal_size


@pytest.mark.parametrize("law", ["coulomb", "tanh"])
def test_two_beams_that_feel_the_slider_between_them_move_as_one_that_feels_half_of_it(law):
    """By symmetry: half the mass along the beam, and a foot that stays where it is."""
    stiff = replace(STRIP, thickness=0.004, loss_factor=0.02)
    own = {"mu": 0.17, "law": law, "slope": 80.0 if law == "tanh" else None, "gravity": 0.0, "position": 0.237}
    own |= {"coupling": "two-way", "preload": 3.0, "contact": Contact(stiffness=4e5, damping=8.0)}
    between = Slider(mass=0.06, foot=(Foot(length=0.03, points=7, mirrored=True),), **own)
    half = Slider(mass=0.03, foot=(Foot(length=0.03, points=7, mass=1e12, pitches=False),), **own)
    kept = {"model": "fem", "count": 30, "keep": Keep(samples=30), "start": "rest"}
    grown = Excitation([replace(one, amplitude=60.0) for one in PAIR], STRIP_HERTZ, soft_start_periods=2.0)
    two, one, free = (
        simulate(stiff, grown, 4e-3, slider=slider, **kept)
        for slider in (between, half, replace(between, coupling="one-way"))
    )
    assert two.speed[-1] == pytest.approx(one.speed[-1], rel=2e-3)
    assert two.normal_force[5:] == pytest.approx(2.0 * one.normal_force[5:], rel=2e-3, abs=2e-3)
    assert abs(free.speed[-1] / two.speed[-1] - 1.0) > 0.05


def test_a_preload_spring_eases_as_the_beam_gives_way():
    """P/(1 + k_s (1/k + compliance))."""
    own = {"mass": 1e-3, "law": "tanh", "slope": 30.0, "gravity": 0.0, "preload": 0.02, "preload_stiffness": 4e4}
    slider = Slider(mu=0.2, coupling="two-way", position=0.237, contact=Contact(stiffness=1e5), **own)
    still = Excitation([replace(one, amplitude=1e-9) for one in PAIR], STRIP_HERTZ)
    found = simulate(STRIP, still, 1e-3, slider=slider, model="fem", count=30, keep=Keep(samples=5))
    compliance = (0.237 * 0.263) ** 2 / (3.0 * STRIP.bending_stiffness * 0.5)
    assert found.normal_force[1:] == pytest.approx(0.02 / (1.0 + 4e4 * (1e-5 + compliance)), rel=1e-3)


@pytest.mark.parametrize("coupling", ["one-way", "two-way"])
def test_a_continued_run_equals_one_run(coupling):
    contact = Contact(stiffness=3e6, damping=30.0)
    slider = replace(LIGHT, coupling=coupling, preload=1.3, contact=contact, foot=(Foot(length=0.044, points=23),))
    asked = {"slider": slider, **KEPT}
    whole = simulate(STRIP, DRIVEN, 12 * PERIOD, keep=Keep(samples=13), **asked)
    first = simulate(STRIP, DRIVEN, 6 * PERIOD, keep=Keep(samples=7), **asked)
    second = simulate(STRIP, DRIVEN, 6 * PERIOD, start=first, keep=Keep(samples=7), **asked)
    assert second.times[0] == pytest.approx(first.times[-1])
    assert second.travelled[-1] == pytest.approx(whole.travelled[-1], rel=1e-7)
    assert second.height[-1] == pytest.approx(whole.height[-1], rel=1e-6)


# --- on a beam that nothing holds


def bar(**given):
    own = {"length": 0.06, "width": 0.006, "thickness": 0.002, "youngs_modulus": 105e9, "density": 8500.0}
    return Beam(supports=("free", "free"), loss_factor=0.01, **own, **given)


def test_a_slider_runs_on_a_beam_that_nothing_holds_as_on_soft_springs():
    forces = (PointForce(position=0.008, amplitude=2.0), PointForce(position=0.052, amplitude=1.5, phase_deg=70.0))
    contact = Contact(stiffness=5e6, damping=30.0)
    slider = Slider(mass=2e-3, mu=0.3, slope=60.0, preload=8.0, position=0.031, coupling="one-way", contact=contact)
    lying = bar(spring=tuple(PointSpring(position=x, stiffness=10.0) for x in (0.0, 0.06)))
    asked, excitation = {"slider": slider, "keep": Keep(samples=3)}, Excitation(forces, 31e3)
    exact = simulate(bar(), excitation, 1e-3, model="analytic", **asked)
    assert abs(exact.travelled[-1]) > 5e-8
    for model, count in (("segment", 31), ("fem", 40)):
        free, held = (simulate(beam, excitation, 1e-3, model=model, count=count, **asked) for beam in (bar(), lying))
        assert free.travelled == pytest.approx(held.travelled, rel=1e-5)
        assert free.travelled == pytest.approx(exact.travelled, rel=5e-3)
    with pytest.raises(InputError, match=r"beam\.supports"):
        simulate(bar(), excitation, 1e-4, slider=replace(slider, coupling="two-way"), model="fem", count=17)


@pytest.mark.parametrize(("points", "preload", "stiffness"), [(3, 816.0, 1.2e6), (5, 586.0, 7.8e6)])
def test_a_preload_that_has_no_equilibrium_within_small_slopes_is_refused(points, preload, stiffness):
    strip = Beam(length=0.3, width=0.012, thickness=0.0003, youngs_modulus=70e9, density=2700.0)
    foot, contact = Foot(length=0.03, points=points), Contact(stiffness=stiffness, damping=3.0)
    slider = Slider(mass=0.02, mu=0.3, law="coulomb", contact=contact, foot=(foot,), preload=preload)
    drive = Excitation(PointForce(position=0.05, amplitude=0.1), 400.0)
    with pytest.raises(InputError, match=r"slider\.preload"):
        simulate(strip, drive, 1e-5, count=30, slider=slider, start="rest", keep=Keep(samples=2), step=1e-6)


def test_a_clasp_of_equal_feet_is_at_rest_on_a_beam_that_it_does_not_bend():
    feet = (Foot(length=0.03, points=7), Foot(length=0.03, points=7, face="lower"))
    own = {"mu": 0.17, "law": "coulomb", "gravity": 0.0, "position": 0.237, "coupling": "two-way", "preload": 3.0}
    clasp = Slider(mass=0.06, contact=Contact(stiffness=4e5, damping=8.0), foot=feet, **own)
    still = Excitation([replace(one, amplitude=1e-9) for one in PAIR], STRIP_HERTZ)
    found = simulate(STRIP, still, 1e-3, slider=clasp, model="analytic", start="rest", keep=Keep(at=0.237, samples=5))
    assert found.normal_force == pytest.approx(np.full(5, 3.0), rel=1e-6)
    assert found.pressures.reshape(5, 2, 7).sum(axis=2) == pytest.approx(np.full((5, 2), 1.5), rel=1e-6)
    assert np.abs(found.deflection).max() < 1e-9
