"""Figures of a motor on a foot of one wavelength: beside the driving layer's closed forms, and its motion in time."""

import re
from math import acos, cos, exp, pi, sin, sqrt

import numpy as np
import pytest
from motor_setups import HALF, HERTZ, MIDDLE, OMEGA, PERIOD, STRIP, drive
from msgspec.structs import replace
from scipy.integrate import solve_ivp

from verify.beam import Beam, PointForce
from verify.contact import layer
from verify.errors import InputError
from verify.motor.case import MotorCase
from verify.motor.figures import crest_speed, force_speed, mean_speed, no_load, stall, started, stopped
from verify.motor.on_wave import over_a_wave
from verify.motor.shooting import periodic
from verify.slider import Contact, Foot, Slider

HEIGHT, KAPPA, MU = 1e-8, 2e9, 0.2
FORCES, WAVE = drive(HEIGHT)
CRESTS = HALF * WAVE.k * OMEGA * HEIGHT


def motor(phi, epsilon=0.0, mass=4.0, steps=127):
    """(case, normal force) of an upright foot of 61 points; 50 g of it move across."""
    load = 2.0 * KAPPA * HEIGHT * layer.pressed(phi, phi) / WAVE.k
    give = 2.0 * MU * KAPPA / (epsilon * WAVE.k * 2.0 * HALF) if epsilon else None
    slider = Slider(
        mass=mass,
        mu=MU,
        law="coulomb",
        gravity=0.0,
        preload=load,
        position=MIDDLE,
        coupling="one-way",
        contact=Contact(layer_stiffness=KAPPA, layer_tangential_stiffness=give),
        foot=(Foot(length=2.0 * pi / WAVE.k, points=61, pitches=False, mass=0.05),),
    )
    case = MotorCase(
        beam=STRIP,
        forces=FORCES,
        frequency_hz=HERTZ,
        slider=slider,
        model="analytic",
        count=None,
        start="steady",
        steps_per_period=steps,
    )
    return case, load


@pytest.mark.parametrize(("phi", "epsilon"), [(1.0, 0.0), (1.3, 0.4)])
def test_a_force_speed_curve_is_the_layers(phi, epsilon):
    case, load = motor(phi, epsilon)
    ratios = (-0.6, 0.0, 0.71, 0.87, 1.1)
    for ratio, found in zip(ratios, force_speed(case, [-r * CRESTS for r in ratios]), strict=True):
        assert -found.force / (MU * load) == pytest.approx(layer.force(phi, ratio, epsilon), abs=3e-3)
        assert found.normal_force == pytest.approx(load, rel=1e-3)
        assert found.contact_share == pytest.approx(phi / pi, abs=2e-3)


@pytest.mark.parametrize(
    ("epsilon", "speed", "force"), [(0.0, 0.942089316298, 1.0), (0.1, 0.8875898055, 1.0), (3.0, sin(1.0), 0.6524603173)]
)
def test_no_load_speed_and_stall_force_at_a_half_angle_of_one(epsilon, speed, force):
    case, load = motor(1.0, epsilon)
    assert -no_load(case).speed / CRESTS == pytest.approx(speed, abs=2e-3)
    assert -stall(case).force / (MU * load) == pytest.approx(force, abs=2e-3)


def test_a_search_that_takes_long_in_all_ends_with_what_it_knows(monkeypatch):
    """Each of its readings is waited for, all of them are not: a minute went by without a word."""
    case, _ = motor(1.0, 0.1, steps=61)
    monkeypatch.setenv("VERIFY_PATIENCE", "0.05")
    with pytest.raises(InputError, match=r"lies between (.*) and (.*) m/s, .*, or set VERIFY_PATIENCE") as told:
        no_load(case)
    low, high = (float(word) for word in re.search("between (.*) and (.*) m/s", str(told.value)).groups())
    assert low < -0.8875898055 * CRESTS < high <= 0.0


@pytest.mark.parametrize(("phi", "ratio"), [(0.8, 0.83), (2.3, 0.61), (3.0, -0.3)])
def test_friction_of_two_points_turns_where_the_wave_says_and_not_with_the_next_step(phi, ratio):
    wrong = []
    for steps in (61, 122, 488):
        found, _ = over_a_wave(
            STRIP, HERTZ, speed_ratio=ratio, contact_half_angle=phi, points=2, steps_per_period=steps, mu=MU
        )
        assert found.given == pytest.approx(found.power + found.rubbed, rel=1e-9)
        wrong.append(found.force / (MU * found.normal_force) + layer.force(phi, ratio))
    assert abs(np.array(wrong)) == pytest.approx(0.0, abs=6e-3)  # a step is 2 / 61 = 0.033 of it
    assert abs(wrong[2]) < 6e-5


LAWS = {"coulomb": ("coulomb", None, 0.04), "a steep tanh": ("tanh", 1e5, 0.04), "light": ("coulomb", None, 0.008)}


@pytest.mark.parametrize("law", LAWS)
def test_a_motor_of_one_point_gives_the_same_in_the_usual_steps_and_in_many(law):
    few, many = (_on_one_point(*LAWS[law], steps) for steps in (61, 700))
    assert few[0] == pytest.approx(many[0], rel=0.01)
    assert few[1] == pytest.approx(many[1], abs=0.006)


def _on_one_point(name, slope, mass, steps):
    """(stall force, N, free speed over that of the crests) of one that never leaves the beam."""
    case = _one_point(steps_per_period=steps)
    case = replace(case, slider=replace(case.slider, law=name, slope=slope, mass=mass))
    run = case.run(300 * case.period, samples=301)
    return stall(case).force, mean_speed(run, 100)[0] / crest_speed(case)


def _one_point(**given):
    """A motor of one contact point on the wave of two unequal forces."""
    case, _ = motor(1.0)
    forces = (PointForce(position=0.012, amplitude=6.0), PointForce(position=0.25, amplitude=9.0, phase_deg=70.0))
    beam = Beam(length=0.26, width=0.012, thickness=0.0014, youngs_modulus=200e9, density=7850.0)
    slider = replace(
        case.slider,
        mu=0.25,
        preload=8.0,
        position=0.115,
        contact=Contact(stiffness=2e5, damping=40.0),
        foot=(Foot(points=1, mass=0.02),),
    )
    return replace(case, beam=beam, forces=forces, frequency_hz=7300.0, slider=slider, **given)


@pytest.mark.parametrize("steps", [61, 64])
def test_friction_that_the_beam_feels_is_that_of_many_steps_in_the_usual_ones(steps):
    """Within 2e-4 of mu N: turned round with the steps it was up to 2e-2 off, the whole force being 2.4e-2."""
    case = _one_point(model="fem", count=9)
    felt = case.on(replace(case.slider, coupling="two-way"))
    coarse, fine = (stall(replace(felt, steps_per_period=each)).force for each in (steps, 900))
    assert coarse == pytest.approx(fine, abs=2e-4 * 0.25 * 8.0)
    assert abs(fine) > 0.02 * 0.25 * 8.0


@pytest.mark.parametrize(("model", "count"), [("analytic", None), ("segment", 40)])
def test_crests_of_a_damped_motor_are_those_that_its_slider_sees(model, count):
    slow, damped = (_one_point(model=model, count=count, modal_damping=zeta) for zeta in (None, 0.05))
    seen = damped.run(damped.period, held_speed=0.0, frozen=True, samples=62).surface_speed
    assert crest_speed(damped) == pytest.approx(np.nanmax(abs(seen)), rel=3e-3)
    assert crest_speed(slow) < 0.9 * crest_speed(damped)


@pytest.mark.parametrize(("tension", "foundation"), [(0.0, 0.0), (4300.0, 0.0), (0.0, 2.6e6), (-700.0, 1.1e6)])
def test_the_give_of_a_contact_is_over_a_wavelength_of_the_beam_as_it_is_held(tension, foundation):
    case = _one_point(model="fem", count=40)
    stiffness, mass = case.beam.pieces[0].bending_stiffness, case.beam.pieces[0].mass_per_length
    load = mass * (2.0 * pi * 7300.0) ** 2 - foundation
    k = sqrt((sqrt(tension**2 + 4.0 * stiffness * load) - tension) / (2.0 * stiffness))
    give = Contact(stiffness=2e5, damping=40.0, tangential_stiffness=9e4)
    beam = replace(case.beam, tension=tension, foundation=foundation)
    case = replace(case, beam=beam, slider=replace(case.slider, contact=give))
    found = case.run(case.period, samples=2).motor_margins
    assert found.epsilon == pytest.approx(2.0 * 0.25 * 2e5 / (9e4 * k * 0.0014), rel=1e-12)
    still = replace(case, beam=replace(beam, foundation=foundation + 1.4 * load))
    assert still.run(case.period, samples=2).motor_margins.epsilon is None


def test_efficiency_is_best_where_the_layers_is():
    case, load = motor(1.0)
    ratios = np.array([0.6, 0.68561, 0.8])
    found = force_speed(case, -ratios * CRESTS)
    assert [one.efficiency for one in found] == pytest.approx([layer.efficiency(1.0, r) for r in ratios], abs=3e-3)
    assert found[1].power / (MU * load * CRESTS) == pytest.approx(0.62306, abs=2e-3)
    for one in found:
        assert one.given == pytest.approx(one.power + one.rubbed, rel=1e-6)


def test_a_motor_starts_by_the_layers_force_over_its_mass():
    """M dv/dt = mu N F(v/V): to 1 - 1/e of the no-load speed; near that with a time constant in closed form."""
    phi, mass = 1.0, 40.0
    case, load = motor(phi, mass=mass)
    speed = layer.no_load_speed(phi)
    rate = MU * load / (mass * CRESTS)

    def reached(t, r):
        return r[0] - (1.0 - exp(-1.0)) * speed

    reached.terminal = True
    run = solve_ivp(
        lambda t, r: [rate * layer.force(phi, r[0])], (0.0, 5.0 / rate), [0.0], events=reached, rtol=1e-9, max_step=0.01
    )
    found = started(case, -speed * CRESTS, periods=300)
    assert found.time == pytest.approx(run.t_events[0][0], rel=5e-3)
    assert found.time > 20.0 * PERIOD

    psi = acos(speed)
    constant = mass * CRESTS * sin(psi) * 2.0 * layer.pressed(phi, phi) / (4.0 * MU * load * (cos(psi) - cos(phi)))
    late = found.run
    left = speed + late.speed / CRESTS
    last = (left > 0.005) & (left < 0.02)
    falls = np.polyfit(late.times[last], np.log(left[last]), 1)[0]
    assert -1.0 / falls == pytest.approx(constant, rel=0.08)


def test_a_motor_stops_by_friction_alone():
    """At mu N/m, once nothing drives it: 1/e of the speed is left after (1 - 1/e) m v/(mu N)."""
    case, load = motor(1.0, mass=40.0)
    before = case.run(3.0 * PERIOD, held_speed=-0.8 * CRESTS, samples=4)
    found = stopped(case, before, periods=200)
    assert found.time == pytest.approx((1.0 - exp(-1.0)) * 40.0 * 0.8 * CRESTS / (MU * load), rel=2e-2)
    assert abs(found.end_speed) < 1e-6 * CRESTS


@pytest.mark.parametrize(("ratio", "zeta"), [(0.6, 0.07), (1.9, 0.2)])
def test_a_point_that_stays_on_repeats_itself_with_the_multipliers_of_its_spring(ratio, zeta):
    """exp(omega_c T (-zeta +- i sqrt(1 - zeta^2))) over a period."""
    mass, own = 2e-3, OMEGA / ratio
    stiffness = mass * own**2
    slider = Slider(
        mass=mass,
        mu=MU,
        gravity=0.0,
        preload=30.0 * mass * HEIGHT * OMEGA**2,
        position=MIDDLE,
        coupling="one-way",
        contact=Contact(stiffness=stiffness, damping=2.0 * zeta * sqrt(stiffness * mass)),
    )
    case = MotorCase(
        beam=STRIP,
        forces=FORCES,
        frequency_hz=HERTZ,
        slider=slider,
        model="analytic",
        count=None,
        start="steady",
        steps_per_period=1000,
    )
    found = periodic(case)
    assert found.missed < 1e-8
    wanted = np.exp(own * PERIOD * (-zeta + 1j * sqrt(1.0 - zeta**2) * np.array([1.0, -1.0])))
    assert found.stable
    assert sorted(found.multipliers, key=lambda one: one.imag) == pytest.approx(
        sorted(wanted, key=lambda one: one.imag), abs=2e-3
    )
