"""Means of a slider that bounces: what they carry, how far they are off, where they are withheld."""

from math import pi

import numpy as np
import pytest
from motor_references import bounces
from motor_setups import HALF, HERTZ, MIDDLE, OMEGA, STRIP, drive
from msgspec.structs import replace

from verify import load_scene
from verify.errors import InputError
from verify.judge.workbench import Workbench
from verify.motor import figures, settling
from verify.motor.case import MotorCase
from verify.motor.figures import at_speed, comes_to_speed, crest_speed, held, no_load
from verify.quantities.catalogue import QUANTITIES
from verify.slider import Contact, Foot, Slider

MASS, MU, PRELOAD = 2.3e-3, 0.2, 2.3e-5
GRAVITY = PRELOAD / MASS
RATIO = 150.0
"""Acceleration of the surface over that of the fall: a flight lasts up to 48 periods, four blocks of means."""


def bouncing(ratio=RATIO, **given):
    """A point pressed on a place that a wave to the right shakes."""
    pressed = {"gravity": 0.0, "preload": PRELOAD, **given}
    slider = Slider(mass=MASS, mu=MU, law="coulomb", position=MIDDLE, coupling="one-way", **pressed)
    return MotorCase(
        beam=STRIP,
        forces=drive(ratio * GRAVITY / OMEGA**2)[0],
        frequency_hz=HERTZ,
        slider=slider,
        model="analytic",
        count=None,
    )


def hard(restitution, ratio=RATIO):
    return bouncing(ratio, contact=Contact(restitution=restitution))


SPRING = Contact(stiffness=MASS * (0.31 * OMEGA) ** 2, damping=0.02 * MASS * OMEGA)
HANGING = {"gravity": 9.81, "preload": MASS * 9.81 + PRELOAD, "foot": (Foot(face="lower"),)}
"""Pressed against the lower face with a thousand times what is left beyond its weight."""
CASES = {
    "plastic": hard(0.0),
    "restitution 0.3": hard(0.3),
    "restitution 0.5": hard(0.5),
    "restitution 0.8": hard(0.8),
    "spring": bouncing(contact=SPRING),
    "spring without loss": bouncing(contact=Contact(stiffness=SPRING.stiffness)),
    "pressed on by a spring": bouncing(contact=SPRING, preload_stiffness=MASS * (3e-2 * OMEGA) ** 2),
    "clasp": bouncing(
        contact=SPRING,
        foot=(Foot(length=0.04, points=3), Foot(length=0.03, points=2, face="lower", offset=0.004)),
    ),
    "below, with a weight": bouncing(contact=SPRING, **HANGING),
}


@pytest.fixture(scope="module")
def found():
    """At rest and at two fifths of the crests' speed."""
    return {
        name: [at_speed(case, v, periods=23_040) for v in (0.0, 0.4 * crest_speed(case))]
        for name, case in CASES.items()
    }


@pytest.mark.parametrize("name", sorted(set(CASES) - {"pressed on by a spring"}))
def test_the_mean_normal_force_of_a_bouncing_slider_is_what_presses_it_on(name, found):
    """To a few flights in the window, which of a chaotic one another processor's rounding changes; by so much told."""
    for one in found[name]:
        missing = abs(one.normal_force - PRELOAD)
        assert missing < (0.03 if name.startswith("restitution") else 0.01) * PRELOAD
        assert missing <= one.normal_spread + 1e-3 * PRELOAD
        assert one.settled("normal force") == (one.normal_spread <= 0.01 * one.normal_force)


@pytest.mark.parametrize("name", CASES)
def test_friction_is_no_more_than_mu_times_what_presses_on(name, found):
    for one in found[name]:
        assert abs(one.force) <= MU * one.normal_force * (1.0 + 1e-9)
        assert one.rubbed >= 0.0


def test_a_spring_that_presses_a_bouncing_slider_on_adds_its_mean_force():
    """The feet rise on the average, the spring pulls them down: momentum over a window with every height kept."""
    case = CASES["pressed on by a spring"]
    one, run = held(case, 0.0)
    fine = case.run(200 * case.period, held_speed=0.0, frozen=True, samples=200 * 61 + 1, continue_from=run)
    gained = MASS * (fine.state.feet[0, 1] - run.state.feet[0, 1]) / fine.duration
    pressing = PRELOAD + case.slider.preload_stiffness * float(fine.height[1:, 0].mean())
    assert float(fine.normal_force[1:].mean()) == pytest.approx(pressing + gained, rel=1e-3)
    assert one.normal_force == pytest.approx(pressing, rel=5e-3)
    assert pressing > 1.05 * PRELOAD


def written_out(ratio, restitution, turns, after):
    """(normal force over the preload, friction over mu times it) of a point in parabolas, after so many turns.

    The surface is A sin theta and runs against the wave on its crests: along +x where sin theta < 0.
    """
    pushed, rubbed, first = 0.0, 0.0, None
    for one in bounces(ratio, restitution, turns):
        if one.phase < 2.0 * pi * after:
            continue
        if first is None:
            first = one.phase  # from its own landing on
            continue
        blow = ratio * one.closing * (1.0 if one.left > one.phase else 1.0 + restitution)
        pushed, rubbed = pushed + blow, rubbed - blow * np.sign(np.sin(one.phase))
        if one.left > one.phase:
            theta = np.linspace(one.phase, one.left, 4001)
            rides = np.maximum(1.0 - ratio * np.sin(theta), 0.0)
            pushed += np.trapezoid(rides, theta)
            rubbed -= np.trapezoid(rides * np.sign(np.sin(theta)), theta)
        last = one.phase
    return pushed / (last - first), rubbed / (last - first)


@pytest.mark.parametrize(("ratio", "restitution"), [(RATIO, 0.0), (RATIO, 0.3), (31.0, 0.0), (31.0, 0.4)])
def test_means_of_a_hard_point_are_those_of_parabolas(ratio, restitution):
    one = at_speed(hard(restitution, ratio), 0.0)
    push, rub = written_out(ratio, restitution, 6000, 700)
    assert push == pytest.approx(1.0, abs=0.02)
    assert one.force / (MU * PRELOAD) == pytest.approx(rub, abs=0.03 + one.spread / (MU * PRELOAD))


def test_two_blocks_in_one_flight_do_not_settle():
    one, _ = held(hard(0.5), 0.0, periods=48)
    assert one.settled() is False
    assert one.spread >= 0.5 * MU * PRELOAD
    assert one.way == 0.0


def test_means_that_have_not_settled_are_told_with_what_to_do():
    """A slider that hardly loses anything: its friction is of either sign, landing by landing."""
    case = hard(0.9)
    one = at_speed(case, 0.0, periods=2880)
    assert not one.settled("force")
    said = figures.not_settled(case, one, ("force",), 2880)
    assert said.startswith("periods = 2880: at 0 m/s the slider bounces and its means have not settled by then")
    assert "give more periods, less slider.contact.restitution or more slider.preload" in said
    with pytest.raises(InputError, match="have not settled"):
        no_load(case, periods=1440)


def test_means_that_patience_has_ended_are_told_in_one_sentence():
    case = bouncing(contact=SPRING)
    one = replace(at_speed(case, 0.0, periods=48), unsettled=("force",))
    said = figures.not_settled(case, one, ("force",), 23_040)
    assert said.endswith(
        ": set VERIFY_PATIENCE to more seconds, or give more slider.contact.damping or more slider.preload"
    )


def test_more_periods_leave_means_less_spread_and_within_what_was_told():
    case = hard(0.6, 40.0)
    few, many = at_speed(case, 0.0, periods=1440), at_speed(case, 0.0, periods=23_040)
    assert many.periods > few.periods
    assert many.spread < few.spread
    assert abs(few.force - many.force) < 2.0 * (few.spread + many.spread)


def test_a_motion_that_repeats_itself_is_read_from_two_blocks():
    one = at_speed(bouncing(0.4, contact=SPRING), 0.0)
    assert one.window == settling.BLOCK
    assert one.settled()
    assert one.normal_force == pytest.approx(PRELOAD, rel=settling.BALANCED)


def test_spreads_of_windows_are_those_of_independent_draws():
    """Twice the standard error covers the mean in 19 of 20; what follows the normal force is known by its balance."""
    draws, covered, known = np.random.default_rng(7), 0, 0
    for _ in range(400):
        rows = draws.normal(3.0, 1.0, (1440, 6))
        plain = settling.spread_of(rows, 0.0, False)
        covered += abs(rows[:, 0].mean() - 3.0) <= plain.force
        rows[:, 0] = 0.2 * rows[:, 1] + 0.01 * rows[:, 2]
        balanced = settling.spread_of(rows, abs(rows[:, 1].mean() - 3.0), True)
        known += abs(rows[:, 0].mean() - 0.63) <= balanced.force
        assert balanced.normal_force == abs(rows[:, 1].mean() - 3.0)
    assert covered > 370
    assert known > 370


def test_a_free_run_that_is_in_flight_at_its_end_has_come_to_no_speed():
    case = hard(0.5)
    run = case.run(40 * case.period, samples=41)
    assert float(run.normal_force[-20:].mean()) == 0.0
    assert not comes_to_speed(run, 20, crest_speed(case))
    still = replace(case, forces=drive(0.4 * GRAVITY / OMEGA**2)[0])
    assert comes_to_speed(still.run(60 * case.period, samples=61), 20, 1e3 * HALF)


@pytest.mark.parametrize("feet", [(Foot(face="lower"),), (Foot(), Foot(face="lower"))], ids=["below", "clasp"])
def test_a_free_run_on_the_lower_face_carries_the_preload_less_the_weight(feet):
    """A tenth of the preload is weight: on a clasp it adds to one foot what it takes from the other."""
    case = bouncing(0.4, contact=SPRING, gravity=0.1 * PRELOAD / MASS, foot=feet)
    run = case.run(200 * case.period, samples=201)
    presses = (0.9 if len(feet) == 1 else 1.0) * PRELOAD
    assert case.slider.normal_force == pytest.approx(presses, rel=1e-12)
    assert run.normal_force[0] == pytest.approx(presses, rel=1e-12)
    assert float(run.normal_force[-20:].mean()) == pytest.approx(presses, rel=0.01)
    heavy = replace(case.slider, preload=4.0 * PRELOAD, gravity=3.0 * PRELOAD / MASS)
    pressed = case.on(heavy).run(200 * case.period, samples=201)
    assert comes_to_speed(pressed, 20, 1e3 * HALF)


def test_what_presses_a_slider_on_is_each_foots_own():
    """Newton: the weight, 0.6 N, is shared; it lifts a foot off the lower face, and sinks into either beam alike."""
    own = {"mass": 0.06, "gravity": 10.0, "mu": 0.2, "contact": SPRING}
    above, below, between = Foot(), Foot(face="lower", mass=0.01), Foot(mirrored=True)
    for feet, preload, presses, load, fall in (
        ((above,), 2.0, 2.6, 2.6, 2.6 / 0.06),
        ((below,), 2.0, 1.4, 1.4, 140.0),
        ((below,), 0.5, 0.0, 0.0, 0.0),
        ((above, below), 2.0, 1.3 + 0.7, 2.0, 1.3 / 0.03),
        ((between,), 2.0, 4.0, 2.0, 2.0 / 0.06),
        ((between,), 0.2, 0.6, 0.3, 0.3 / 0.06),
    ):
        slider = Slider(preload=preload, foot=feet, **own)
        assert slider.normal_force == pytest.approx(presses, rel=1e-12)
        assert slider.load == pytest.approx(load, rel=1e-12)
        assert slider.effective_gravity == pytest.approx(fall, rel=1e-12)


def test_margins_and_sizes_of_a_slider_below_are_of_what_presses_it_on():
    above = bouncing(0.4, contact=SPRING, gravity=0.6 * PRELOAD / MASS, foot=(Foot(),))
    one = above.run(above.period, samples=2)
    below = above.on(replace(above.slider, foot=(Foot(face="lower"),))).run(above.period, samples=2)
    assert below.beam_margins.lift_off == pytest.approx(one.beam_margins.lift_off * 1.6 / 0.4, rel=1e-12)
    assert below.coupling.normal_size == pytest.approx(one.coupling.normal_size * 0.4 / 1.6, rel=1e-12)
    assert below.coupling.friction_size == pytest.approx(one.coupling.friction_size * 0.4 / 1.6, rel=1e-12)


MEASURED = ("stall_force", "force_speed", "normal_mean", "contact_share", "power", "wear_power", "efficiency")


@pytest.mark.parametrize("name", MEASURED)
def test_a_figure_of_means_that_have_not_settled_is_refused_with_field_value_and_remedy(name):
    """Feet of the packaged motor that fly for many periods, and four blocks at most."""
    scene, quantity = load_scene("preloaded-motor"), QUANTITIES[f"slider.{name}"]
    speed = {} if name == "stall_force" else {"speed": -0.01}
    asked = quantity.arguments(model="analytic", preload=0.002, periods=48, **speed)
    with pytest.raises(InputError, match=r"periods = 48: at .*not settled.*: give more periods, more slider.contact.d"):
        quantity.evaluate(asked, scene, Workbench(scene.beam))


@pytest.mark.parametrize("name", ["free_speed", "start_time"])
def test_a_free_run_without_a_steady_end_is_refused_with_field_value_and_remedy(name):
    scene, quantity = load_scene("preloaded-motor"), QUANTITIES[f"slider.{name}"]
    asked = quantity.arguments(model="analytic", preload=0.002, periods=60, last=20)
    with pytest.raises(InputError, match=r"periods = 60 with last = 20: the free run has no steady end.* give more"):
        quantity.evaluate(asked, scene, Workbench(scene.beam))


@pytest.mark.parametrize(("given", "pushed"), [({"mass": 1.0}, "0.97 of mu N"), ({"mass": 10.0}, "1 of mu N")])
def test_a_slider_that_friction_still_speeds_up_has_no_free_speed(given, pushed):
    """Its halves run nearly alike beside the crests; friction takes seconds to bring it to their speed."""
    scene = load_scene("preloaded-motor")
    for name in ("free_speed", "start_time"):
        quantity = QUANTITIES[f"slider.{name}"]
        with pytest.raises(InputError, match=rf"no steady end.*{pushed} push it on"):
            quantity.evaluate(quantity.arguments(model="analytic", **given), scene, Workbench(scene.beam))


def test_a_slider_that_begins_at_its_free_speed_takes_no_time_to_get_there():
    quantity, at_once = QUANTITIES["slider.start_time"], load_scene("preloaded-motor", ("slider.speed=0.0",))
    asked = quantity.arguments(model="analytic")
    assert quantity.evaluate(asked, at_once, Workbench(at_once.beam)) > 1e-3
    speed = QUANTITIES["slider.free_speed"].evaluate(asked, at_once, Workbench(at_once.beam))
    there = load_scene("preloaded-motor", (f"slider.speed={speed!r}",))
    with pytest.raises(
        InputError, match=r"periods = .*the slider begins at -0\.0266.* no way takes a time; give slider"
    ):
        quantity.evaluate(asked, there, Workbench(there.beam))
