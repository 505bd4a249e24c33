"""The slider's readings: kinematics, start, force, place and model against a Lagrangian of its own, and how they count."""

import numpy as np
import pytest
from bead_reference import ChainCurve, PinnedBeam, mean_speed
from msgspec.structs import replace

from verify import load_scene
from verify.chain.ride import half_steps, ride
from verify.chain.stretching import simulate_elastic
from verify.chain.system import build_system
from verify.errors import InputError
from verify.studies.readings.chain_rides import Chains
from verify.studies.readings.figures import chain_reading, reading, readings_study

SCENE = load_scene("paper-slider")
LENGTH, PLACES = 0.5, (0.0116, 0.5 - 0.0116)


def studied(scene, *progress):
    return readings_study(scene, scene.readings, *progress)


def as_read(kinematics="tangential", soft=0.0, force=1.0, mu=0.2, slope=1e4, place=0.25, per_period=128):
    """The packaged scene under one combination, mu m g = 2 mN kept."""
    drive = replace(SCENE.drive, force=tuple(replace(one, amplitude=force) for one in SCENE.drive.force))
    slider = replace(SCENE.slider, mu=mu, mass=2e-3 / (9.81 * mu), slope=slope, kinematics=kinematics, position=place)
    motion = replace(SCENE.motion, soft_start_periods=soft, steps_per_period=per_period)
    return replace(SCENE, drive=drive, slider=slider, motion=motion, readings=None)


def read(model="segment", count=49, **how):
    return reading(as_read(**how), SCENE.claim, model, count)


def met(one):
    return {claim.id for claim, holds in zip(SCENE.claim, one.met, strict=True) if holds}


def bead(force, mu, slope, place, modes=160):
    beam = PinnedBeam(
        LENGTH,
        0.02,
        0.001,
        70e9,
        2700.0,
        [(x, force, phase) for x, phase in zip(PLACES, (0.0, np.pi / 2), strict=True)],
        4276.0,
        modes,
    )
    return mean_speed(beam, place, mu, slope, 1e-3)


@pytest.mark.parametrize(
    ("force", "mu", "slope", "place", "speed"),
    [(30.0, 0.2, 1e4, 0.25, -0.015417), (30.0, 0.2, 1e4, 0.24, 0.012659), (30.0, 0.31, 1e3, 0.2437, None)],
)
def test_a_slider_that_follows_the_exact_beam_is_a_bead_on_its_surface(force, mu, slope, place, speed):
    """Switched on at once: by modes up to 0.24 MHz, another equation and other steps, to 0.2 % of 1.5 cm/s."""
    found = read("analytic", None, kinematics="following", force=force, mu=mu, slope=slope, place=place, per_period=512)
    expected, push = bead(force, mu, slope, place)
    assert found.speed == pytest.approx(expected, abs=2.5e-5)
    assert found.figures["slider.mean_friction"] / found.mass == pytest.approx(push, abs=0.02 * mu * 9.81)
    if speed is not None:
        assert expected == pytest.approx(speed, rel=1e-3)


def test_what_pushes_a_following_slider_grows_as_the_square_of_the_force_and_asks_nothing_of_friction():
    """At 30 N; at 1 N friction and the turning surface are of one size."""
    by_force = [read(kinematics="following", force=force).speed for force in (10.0, 30.0)]
    assert by_force[1] / by_force[0] == pytest.approx(9.0, rel=0.02)
    by_mu = [read(kinematics="following", force=30.0, mu=mu).speed for mu in (0.05, 0.2, 1.0)]
    assert by_mu == pytest.approx([-0.0153] * 3, rel=2e-3)


def test_the_readings_of_the_claimed_speed_on_49_segments():
    """-1.53 cm/s switched on at once, a tenth of it under a soft start, +1.27 cm/s a hundredth beside the middle."""
    at_once, soft, beside = (
        read(kinematics="following", force=30.0, **how) for how in ({}, {"soft": 2.0}, {"place": 0.24})
    )
    assert [one.speed for one in (at_once, soft, beside)] == pytest.approx([-0.015303, -0.0014722, 0.012683], rel=1e-4)
    assert met(at_once) == {"to-the-left", "mean-speed", "saturation", "reversal"}
    assert met(soft) == {"to-the-left", "saturation", "reversal"}
    assert met(beside) == {"saturation", "mean-force", "surface-speed", "reversal"}


def test_without_the_turning_surface_friction_reaches_a_fiftieth_of_the_claimed_speed():
    """At mu = 3.2, eleven forces to 150 N, both starts, mid-span: far from the bound 0.49 mu cm/s too."""
    forces = (1, 10, 20, 30, 40, 50, 60, 80, 100, 120, 150)
    speeds = [abs(read(mu=3.2, force=float(f), soft=soft).speed) for f in forces for soft in (0.0, 2.0)]
    assert 0.02e-2 < max(speeds) < 0.035e-2
    assert max(speeds) < 0.022 * 0.5 * 3.2 * 9.81 * 1e-3


def test_the_sense_of_the_first_millisecond_is_the_starts():
    """1 N, tangential, switched on at once: segments go left, the exact beam right; under a soft start both left."""
    at_once = [read(model, n).speed for model, n in (("segment", 49), ("analytic", None))]
    soft = [read(model, n, soft=2.0).speed for model, n in (("segment", 49), ("analytic", None))]
    assert at_once[0] < 0 < at_once[1]
    assert max(soft) < 0
    assert soft[0] / soft[1] - 1 == pytest.approx(0.52, abs=0.01)


def on_the_chain(**how):
    chains, scene = Chains({}), as_read(**how)
    return chain_reading(scene, SCENE.claim, chains), chains.under(scene, 49), scene


@pytest.mark.parametrize("mu", [0.2, 0.05])
def test_on_the_nonlinear_chain_one_reading_meets_every_claim(mu):
    """30 N at once, following, from mid-span: what shortens where it bends draws the surface to the left."""
    found, moved, scene = on_the_chain(kinematics="following", force=30.0, mu=mu)
    assert met(found) == {claim.id for claim in SCENE.claim}
    curve = ChainCurve(moved.times, moved.angles, moved.rates, LENGTH / 49, 0.25, 0.001)
    speed, push = mean_speed(curve, 0.25, mu, 1e4, 1e-3)
    assert found.speed == pytest.approx(speed, rel=0.01)
    # of second order in the slope, as 0.6 % of the speed: at mu = 0.05 2.1 %, in steps an eighth as long as well
    assert found.figures["slider.mean_friction"] / scene.slider.mass == pytest.approx(push, rel=0.025)
    assert found.figures["slider.mean_surface_speed"] == pytest.approx(-4.52e-3, rel=0.01)


def stretching(force, links, phase=90.0, **how):
    """The scene's slider on links that stretch by EA/l, following, at once."""
    scene = as_read(kinematics="following", force=force, **how)
    forces = tuple(replace(one, phase_deg=phase * (one.phase_deg != 0)) for one in scene.forces)
    system = build_system(scene.beam, links, forces, 4276.0, load="reciprocal")
    chain = simulate_elastic(system, 70e9 * 0.02 * 0.001, half_steps(1e-3, 1 / (128 * 4276.0)))
    return ride(chain, scene.beam, replace(scene.slider, coupling="one-way"))


@pytest.mark.parametrize(
    ("links", "speed", "force", "surface"), [(49, -1.559e-2, -3.015e-4, -3.05e-3), (99, -1.562e-2, -1.631e-4, -1.57e-3)]
)
def test_links_that_stretch_as_a_beam_does_keep_every_sign(links, speed, force, surface):
    """Left, both means negative, reversed: the axial inertia of rigid links does not make it; -1.565 cm/s at 199."""
    there, back = stretching(30.0, links), stretching(30.0, links, -90.0)
    assert there.mean_speed == pytest.approx(speed, rel=2e-3)
    assert there.mean_friction == pytest.approx(force, rel=0.01)  # in steps an eighth as long
    assert there.mean_surface_speed == pytest.approx(surface, rel=0.01)
    assert back.displacement / there.displacement == pytest.approx(-0.95, abs=0.01)


def test_a_slider_rides_on_stretching_links_as_on_rigid_ones_where_forces_are_small():
    """At 0.3 N: the same surface by other unknowns, to the square of the slopes."""
    rigid = on_the_chain(kinematics="following", force=0.3, slope=50.0)[0].figures["slider.displacement"]
    assert stretching(0.3, 49, slope=50.0).displacement == pytest.approx(rigid, rel=2e-3)


def test_a_chain_under_small_forces_reads_as_the_linear_one():
    """To the share of its shortening, which grows with the force: the surface's speed along x is linear plus square."""
    gaps = []
    for force in (0.01, 0.02):
        found, _, _ = on_the_chain(force=force, slope=50.0)
        linear = read(force=force, slope=50.0)
        gaps.append(found.figures["slider.mean_surface_speed"] / linear.figures["slider.mean_surface_speed"] - 1)
    assert abs(gaps[1]) < 5e-3
    assert gaps[1] / gaps[0] == pytest.approx(2.0, rel=0.1)


def test_means_are_the_balances_of_the_run():
    """Mean friction is m dv / t in the tangential kinematics, the slope at the end the mean of the surface's speed."""
    from verify.motion.figures import RUN_FIGURES
    from verify.studies.slider.work_precision import run_once

    scene = as_read(slope=70.0, mu=0.3, place=0.231, soft=2.0)
    run = run_once(scene, "analytic", None, samples=2)
    friction = RUN_FIGURES["slider.mean_friction"].of(run, None)
    assert friction * 1e-3 == pytest.approx(scene.slider.mass * run.speed[-1], rel=5e-4)
    at_once = as_read(slope=70.0, mu=0.3, place=0.231, per_period=1024)
    run = run_once(at_once, "analytic", None, samples=2)
    surface = RUN_FIGURES["slider.mean_surface_speed"].of(run, None)
    beam = PinnedBeam(LENGTH, 0.02, 0.001, 70e9, 2700.0, [(PLACES[0], 1.0, 0.0), (PLACES[1], 1.0, np.pi / 2)], 4276.0)
    assert surface == pytest.approx(-beam.half * beam.seen(1e-3, 0.231)[0] / 1e-3, rel=5e-3)


# --- The study ---------------------------------------------------------------------------------------------------

SMALL = {
    "kinematics": ("tangential", "following"),
    "soft_start_periods": (2.0, 0.0),
    "positions": (0.25, 0.24),
    "forces": (30.0,),
    "mu": (0.2, 0.31),
    "slope": (),
}


def small(**asked):
    return replace(SCENE, gate=(), readings=replace(SCENE.readings, **(SMALL | {"shown": 1, "chain": False} | asked)))


@pytest.fixture(scope="module")
def study():
    told = []
    found = studied(small(), told.append)
    from verify.run.runner import n_steps

    assert len(told) == n_steps(small()) - n_steps(replace(small(), readings=None))
    return found


def test_every_combination_is_run_once_and_grouped_by_kinematics_start_and_place(study):
    assert len(study.readings) == 16
    assert len({one.condition for one in study.readings}) == 16
    assert [len(group.readings) for group in study.groups] == [2] * 8
    assert study.n_runs == 2 * (16 + 1)
    assert study.searched["slope"] == (1e4,)
    assert all(one.mass * one.condition.mu * 9.81 == pytest.approx(2e-3) for one in study.readings)


def test_the_exact_beam_stands_beside_the_readings_that_meet_most(study):
    beside = [group for group in study.groups if group.exact]
    assert len(beside) == 1
    assert beside[0].best.n_met == max(one.n_met for one in study.readings)
    assert beside[0].exact.condition == replace(beside[0].best.condition, model="analytic", count=None)


def test_a_verdict_turns_with_what_the_pairs_say(study):
    """Counted here from the conditions alone."""
    sense = [claim.id for claim in study.claims].index("to-the-left")
    by_place = next(turn for turn in study.turns if (turn.claim, turn.by) == ("to-the-left", "place"))
    pairs = [
        (a, b)
        for a in study.readings
        for b in study.readings
        if b.condition.position == 0.24 and replace(b.condition, position=0.25) == a.condition
    ]
    assert by_place.pairs == len(pairs) == 8
    assert by_place.turned == sum(a.met[sense] != b.met[sense] for a, b in pairs) > 0
    assert not any(turn.by in ("force", "slope K") for turn in study.turns)


def test_the_bound_is_that_of_friction_from_rest_and_is_held_against_tangential_readings_alone():
    found = studied(small(mu=(3.0, 3.2), positions=(0.25,), shown=0)).bounds[0]
    assert found.least_mu == pytest.approx(2 * 0.015 / (9.81 * 1e-3))
    assert found.n_above == 2
    assert found.fastest == pytest.approx(-0.00025, rel=0.05)
    assert not studied(small(mu=(), kinematics=("following",), positions=(), shown=0)).bounds


def test_a_slider_that_leaves_the_beam_is_no_reading_of_anything():
    slider = replace(SCENE.slider, speed=-2.0)
    scene = replace(small(positions=(0.001,), mu=(), kinematics=(), soft_start_periods=(), shown=0), slider=slider)
    one = studied(scene).readings[0]
    assert (one.stopped, one.figures, one.n_met) == ("left the beam", {}, 0)


def test_readings_without_claims_are_figures_without_verdicts():
    from verify.studies.readings.words import met_words, searched_words, turn_words

    found = studied(replace(small(positions=(), shown=0), claim=()))
    assert found.n_runs == len(found.readings) == 8
    assert all(one.met == () and one.speed for one in found.readings)
    assert not found.turns
    assert not turn_words(found)
    assert met_words(found.readings[0]) == "none"
    assert "Nothing is fitted" in searched_words(found)


@pytest.mark.parametrize(
    ("overrides", "message"),
    [
        (("readings.mu=[0.2,0.2]",), "holds a value twice"),
        (("readings.forces=[1,0]",), "readings.forces[1] = 0"),
        (("readings.positions=[0.6]",), "lies off the beam"),
        (("readings.soft_start_periods=[5]",), "take longer than the 0.001 s"),
        (("motion.start=steady", "motion.soft_start_periods=0", "readings.chain=false"), "a steady beam has no start"),
        (("slider.law=coulomb",), "Coulomb's has none"),
        (("slider.preload=1.0",), "leaves no weight at mu = 0.2"),
        (("slider.gravity=0", "slider.preload=0.01"), "leaves no weight"),
        (("beam.supports=clamped,clamped",), "readings.chain with beam.supports"),
        (("beam.loss_factor=0.001",), "is undamped"),
        (("motion.count=300",), "300 links are more than 250"),
        (("readings.duration=10",), "multiplied, are more than"),
        (("readings.kinematics=[sideways]",), "sideways"),
        (("readings.duration=1e308", "readings.chain=false"), "multiplied, are more than"),
    ],
)
def test_lists_that_cannot_be_run_are_refused_in_one_sentence_before_anything_runs(overrides, message):
    with pytest.raises(InputError) as refused:
        load_scene("paper-slider", overrides)
    assert message in str(refused.value)
    assert "\n" not in str(refused.value)
    assert "inf" not in str(refused.value).split()


def test_too_many_readings_are_counted_before_they_are_refused():
    many = ",".join(str(0.01 + 0.001 * i) for i in range(300))
    with pytest.raises(InputError, match="make 24000 readings"):
        load_scene("paper-slider", (f"readings.mu=[{many}]",))


def test_a_steady_beam_has_no_start_among_what_is_searched():
    from verify.studies.readings.figures import searched_of
    from verify.studies.readings.words import searched_words

    scene = small(positions=(), mu=(), kinematics=(), soft_start_periods=(), forces=(), chain=False, shown=0)
    steady = replace(scene, motion=replace(scene.motion, start="steady", soft_start_periods=0.0))
    assert searched_of(steady, steady.readings)["soft_start_periods"] == ()
    found = studied(steady)
    assert "start 0 periods" not in searched_words(found)
    assert found.readings[0].condition.start == "steady"


def test_readings_as_rows_are_all_readings_with_what_they_meet(study):
    rows = study.records()
    assert len(rows) == len(study.readings)
    for row, one in zip(rows, study.readings, strict=True):
        assert row["slider.mean_speed"] == one.speed
        assert [row[f"meets {claim.id}"] for claim in study.claims] == list(one.met)
        assert row["mu"] == one.condition.mu
