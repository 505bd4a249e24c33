"""A motor on a beam that feels it: one system of equations by DOP853, an added impedance, and the always-on limit."""

from functools import cache
from math import pi

import motor_references as by
import numpy as np
import pytest
from books_reference import hermite_modes
from motor_setups import MIDDLE, PERIOD, STRIP, drive, ridden

from verify.beam import Beam, PointForce
from verify.motion.simulate import simulate
from verify.motor import stepping
from verify.motor.run import run_motor
from verify.slider import Contact, Foot, Slider

BEAM = Beam(length=0.31, width=0.017, thickness=0.0023, youngs_modulus=113e9, density=4470.0)
HERTZ, ZETA, START, LOAD, MASS, STIFFNESS, TURNS = 700.0, 0.02, 0.117, 4.0, 0.02, 1.5e6, 3
TURN = 1.0 / HERTZ
FORCES = (
    PointForce(position=0.05, amplitude=9.0),
    PointForce(position=0.23, amplitude=6.0, phase_deg=77.0),
)
CASES = {"coulomb": {}, "tanh": {"slope": 40.0}, "damped": {"damping": 8.0}, "gives way": {"give": 3e5}}


def modes(grow=TURN):
    """Of four elements written out."""
    own, shape = hermite_modes(BEAM)
    forces = [(f.amplitude, np.deg2rad(f.phase_deg), f.position) for f in FORCES]
    return by.Modes(own, shape, ZETA, forces, 2.0 * pi * HERTZ, 0.5 * BEAM.thickness, grow)


@cache
def followed(name):
    """(states of beam and body after each period, events) by DOP853."""
    beam, point = modes(), by.Point(MASS, MASS, LOAD, STIFFNESS, mu=0.3, half=0.5 * BEAM.thickness, **CASES[name])
    q, level = beam.lying(START, LOAD)
    start = by.body(x=START, z=level - LOAD / STIFFNESS, beam=beam.beam)
    start[: len(q)] = q
    times = np.arange(1, TURNS + 1) * TURN
    found = by.Rider(point, beam).run(start, times[-1], times, TURN, rtol=1e-9, max_step=0.02)
    return found.states[:, beam.beam :], found.events


def run_of(name, step, **asked):
    given = CASES[name]
    slider = Slider(
        mass=MASS,
        mu=0.3,
        law="tanh" if "slope" in given else "coulomb",
        slope=given.get("slope"),
        gravity=0.0,
        preload=LOAD,
        position=START,
        coupling="two-way",
        contact=Contact(stiffness=STIFFNESS, damping=given.get("damping", 0.0), tangential_stiffness=given.get("give")),
    )
    given = {"model": "fem", "count": 4, "modal_damping": ZETA, "soft_start_periods": 1.0, **asked}
    return run_motor(
        BEAM, FORCES, HERTZ, TURNS * TURN, slider=slider, start="rest", samples=TURNS + 1, step=TURN / step, **given
    )


def misses(name, step):
    """Of the way over 1 um, of speed over 1 cm/s, of height over 10 um; of N over the load."""
    (states, _), run = followed(name), run_of(name, step)
    found = np.stack([run.travelled[1:] + START, run.speed[1:], run.height[1:, 0]], axis=1)
    motion = np.abs(found - states[:, [by.X, by.V, by.Z]]).max(axis=0) / (1e-6, 1e-2, 1e-5)
    span = TURNS * TURN
    return *motion, abs(run.normal_force[1:].mean() - states[-1, by.PRESSED] / span) / LOAD


@pytest.mark.parametrize("name", CASES)
def test_beam_and_motor_are_one_system_of_equations(name):
    way, speed, height, pressed = misses(name, 8000)
    assert way < 5e-4
    assert speed < 5e-4
    assert height < 1e-5
    assert pressed < 3e-7


@pytest.mark.parametrize("name", CASES)
def test_two_way_is_of_second_order_too(name):
    """Height, over a factor of 64 in the step."""
    coarse, fine = (np.mean([misses(name, step)[2] for step in steps]) for steps in ((125, 133), (8000, 8512)))
    assert 1.6 < np.log2(coarse / fine) / 6.0 < 2.4


@pytest.mark.parametrize("name", CASES)
def test_the_books_of_motor_and_beam_close(name):
    """What the feet give to the beam is what the surface gives to them, but for steps."""
    found = [run_of(name, step).ledger for step in (250, 4000)]
    sizes = [abs(one.residual) / (abs(one.across) + abs(one.pressed) + one.rubbed) for one in found]
    assert sizes[1] < 2e-5
    assert sizes[1] < 0.1 * sizes[0]


@pytest.mark.parametrize("start", ["rest", "steady"])
@pytest.mark.parametrize("share", [0.7, 3.0])
def test_a_motor_that_stays_on_is_an_added_mass_on_a_spring(share, start):
    """m/(1 - m omega^2/k) at the place, in every mode of the same elements: by one linear solve.

    `share` is the body's own frequency on its contact over that of the drive.
    """
    omega, mass, place = 2.0 * pi * HERTZ, 0.011, 0.117
    stiffness = mass * (share * omega) ** 2
    own, shape = hermite_modes(BEAM)
    loads = sum(f.amplitude * 1e-3 * np.exp(1j * np.deg2rad(f.phase_deg)) * shape(f.position, 0) for f in FORCES)
    here, felt = shape(place, 0), mass * omega**2 / (1.0 - mass * omega**2 / stiffness)
    matrix = np.diag(own**2 - omega**2 + 2j * ZETA * own * omega) - felt * np.outer(here, here)
    with_it = np.linalg.solve(matrix, loads) @ here
    without = np.linalg.solve(matrix + felt * np.outer(here, here), loads) @ here
    assert abs(with_it / without - 1.0) > 0.2

    slider = Slider(
        mass=mass,
        mu=1e-9,
        gravity=0.0,
        preload=2.0,
        position=place,
        coupling="two-way",
        contact=Contact(stiffness=stiffness),
    )
    small = [PointForce(position=f.position, amplitude=1e-3 * f.amplitude, phase_deg=f.phase_deg) for f in FORCES]
    per, turns = 400, 60 if start == "rest" else 700
    run = run_motor(
        BEAM,
        small,
        HERTZ,
        turns * TURN,
        slider=slider,
        model="fem",
        count=4,
        modal_damping=ZETA,
        start=start,
        soft_start_periods=20.0 if start == "rest" else 0.0,
        samples=turns * per // 20 + 1,
        step=TURN / per,
    )
    last = run.times > (turns - 20) * TURN + 1e-9
    turning = np.exp(-1j * omega * run.times[last])
    height = 2.0 * np.mean((run.height[last, 0] - run.height[last, 0].mean()) * turning)
    wanted = with_it / (1.0 - mass * omega**2 / stiffness)
    assert height == pytest.approx(wanted, abs=5e-3 * abs(wanted))


def test_a_stiff_contact_under_a_large_preload_is_the_slider_that_stays_on():
    """What differs is what moves across: N = P + m_f z'' in place of P, of first order in the foot's mass."""
    given = {"mass": 2e-3, "mu": 0.2, "slope": 150.0, "gravity": 0.0, "coupling": "one-way", "preload": 15.0}
    forces, _ = drive(1e-6, 0.1)
    always = simulate(
        STRIP,
        forces,
        1.0 / PERIOD,
        6.0 * PERIOD,
        model="analytic",
        slider=Slider(**given, position=MIDDLE),
        start="steady",
        samples=7,
        step=PERIOD / 4000.0,
    )
    off = []
    for foot in (4e-4, 2e-4, 1e-4):
        contact = Contact(stiffness=2e8, damping=2.0 * np.sqrt(2e8 * foot))
        slider = Slider(**given, contact=contact, foot=(Foot(mass=foot),))
        run = ridden(slider, 1e-6, 0.1, 6, 4000, samples=7)
        assert np.all(run.contact_share > 0.999)
        off.append(np.abs(run.speed - always.speed).max() / np.abs(always.speed).max())
    assert off[-1] < 1e-2
    orders = np.log2(np.array(off)[:-1] / np.array(off)[1:])
    assert np.all((orders > 0.6) & (orders < 1.4))


def held_at(speed, steps):
    """Mean friction over mu N on a point that rubs a little and stays on, from rest over twelve periods."""
    slider = Slider(mass=MASS, mu=0.004, law="coulomb", gravity=0.0, preload=30.0, position=START,
                    coupling="two-way", contact=Contact(stiffness=4e5, damping=30.0))  # fmt: skip
    given = {"model": "analytic", "modes": 4, "modal_damping": ZETA, "start": "rest", "samples": 13}
    run = run_motor(
        BEAM, FORCES, HERTZ, 12 * TURN, slider=slider, step=TURN / steps, held_speed=speed, frozen=True, **given
    )
    assert run.contact_share[1:].mean() == pytest.approx(1.0, rel=1e-9)
    return run.friction[1:].mean() / (slider.mu * slider.preload)


def test_friction_on_a_beam_that_feels_it_turns_round_within_the_step():
    """Of second order at every speed; a turn at the next step leaves up to 2/steps of mu N, at random."""
    speeds = (0.0, 0.004, -0.0031, 0.0073, 0.0017)
    coarse, fine, true = (np.array([held_at(speed, steps) for speed in speeds]) for steps in (101, 404, 4000))
    assert np.ptp(true) > 1.5
    assert np.abs(fine - true).max() < 1e-4
    assert 8.0 < np.linalg.norm(coarse - true) / np.linalg.norm(fine - true) < 32.0


def test_a_point_that_sticks_on_a_beam_that_feels_it_does_not_shake_loose_with_the_step():
    """Sticking 7.77e-3 of the time, by an own time-stepping code in 64 000 to 1 000 000 steps of a period."""
    strip = Beam(length=0.15, width=0.015, thickness=0.002, youngs_modulus=210e9, density=7850.0)
    forces = [PointForce(position=0.04, amplitude=30.0), PointForce(position=0.12, amplitude=22.0, phase_deg=70.0)]
    slider = Slider(mass=0.02, mu=0.3, law="coulomb", preload=6.1962, gravity=0.0, position=0.07, speed=0.02,
                    pull=-0.15, coupling="two-way", contact=Contact(stiffness=3e5, damping=4.0))  # fmt: skip
    given = {"model": "analytic", "modes": 24, "modal_damping": 0.004, "start": "rest", "samples": 9}
    runs = [
        run_motor(strip, forces, 3000.0, 8 / 3000.0, slider=slider, step=1.0 / 3000.0 / steps, **given)
        for steps in (976, 3904, 15616)
    ]
    assert [len(run.events) for run in runs] == [18, 18, 18]
    assert runs[2].stuck_share[1:].mean() == pytest.approx(7.77e-3, rel=5e-3)
    assert runs[2].speed[-1] == pytest.approx(-9.6427e-3, rel=1e-4)


@pytest.mark.parametrize("around", [0, 1])
def test_a_beam_that_is_told_of_piece_by_piece_moves_as_one_that_is_told_of_whole(around, monkeypatch):
    """A slider that runs over a dozen of its pieces on a foot that stands on three of them."""
    foot = {"foot": (Foot(length=0.013, points=3, offset=-0.004),)}

    def run():
        slider = Slider(mass=MASS, mu=0.3, preload=LOAD, gravity=0.0, speed=9.0, position=START, coupling="two-way",
                        contact=Contact(stiffness=STIFFNESS), **foot)  # fmt: skip
        return run_motor(BEAM, FORCES, HERTZ, 6e-3, model="segment", count=60, slider=slider, samples=7)

    whole = run()
    assert whole.travelled[-1] > 10 * BEAM.length / 60
    monkeypatch.setattr(stepping, "AROUND", around)
    found = run()
    assert found.travelled == pytest.approx(whole.travelled, rel=1e-12)
    assert found.friction == pytest.approx(whole.friction, rel=1e-9)


@pytest.mark.parametrize("damping", [0.0, 0.4])
def test_the_time_of_a_step_grows_as_forces_are_spread_over_the_pieces_between_the_points(damping, monkeypatch):
    """Each force goes to every polynomial's every coefficient: 9 x 9 of them a piece, and again for a dashpot.

    Feet far apart on exact modes, 0.3 ms a step, were thought to take a third of that.
    """
    asked, felt = [], stepping.Riding.seconds
    monkeypatch.setattr(stepping.Riding, "seconds", lambda self, *on: asked.append((self, on)) or felt(self, *on))
    for apart in (0.01, 0.03, 0.05):
        contact = Contact(stiffness=6e4, damping=damping)
        feet = (Foot(offset=-apart), Foot(offset=apart))
        ridden(Slider(mass=0.012, mu=0.2, preload=0.4, coupling="two-way", contact=contact, foot=feet), periods=1)
    near, wide, wider = (felt(riding, 1000, *on) - felt(riding, 0, *on) for riding, (_, *on) in asked)
    (pieces, terms, _), length = asked[0][1][1].shape, asked[0][1][2]
    spread = 2 * terms**2 * pieces * 0.04 / length * 7e-7
    assert wide - near == pytest.approx((6.0 if damping else 4.0) * spread, rel=1e-9)
    assert wider - wide == pytest.approx(wide - near, rel=1e-9)
