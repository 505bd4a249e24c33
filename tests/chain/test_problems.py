"""The chain's named figures: what they take, what they refuse, and the orders behind their gates."""

from types import SimpleNamespace

import numpy as np
import pytest
from chain_reference import elastica_tip, woinowsky_krieger
from msgspec.structs import replace

from verify.beam import Beam
from verify.chain import departure, problems
from verify.chain.problems import large_amplitude_frequency
from verify.errors import InputError
from verify.quantities.catalogue import arguments_of, evaluate, quantity
from verify.run.gates import judge
from verify.run.plan import plan_scene
from verify.run.runner import workbench_for
from verify.scenes.scene import Gate, MotionAsk, load_scene
from verify.section import Section

CHAIN = load_scene("chain")


def figure(name, scene=CHAIN, **arguments):
    found = quantity(f"chain.{name}")
    return evaluate(found, arguments_of(found, arguments), scene, workbench_for(scene))


def test_a_thousand_times_slower_beam_departs_in_a_thousand_times_the_time():
    """Nothing but the time scale differs: E, force and the frequency's square are a millionth.

    A departure is a difference of motions, whose rounding on another processor moves it by 2e-12.
    """
    slow = 1e-3
    beam = replace(CHAIN.beam, youngs_modulus=CHAIN.beam.youngs_modulus * slow**2)
    drive = replace(CHAIN.drive, frequency_hz=CHAIN.drive.frequency_hz * slow)
    scene = replace(CHAIN, beam=beam, drive=drive, axial_inertia=None)
    found = figure("axial_departure", scene, segments=7, force=6.0 * slow**2, time=4e-4 / slow)
    assert found == pytest.approx(figure("axial_departure", segments=7, force=6.0, time=4e-4), abs=1e-11)


@pytest.mark.parametrize("tip", ["free", "roller"])
def test_on_a_shaken_chain_works_all_that_can(monkeypatch, tip):
    """At speeds of their own, so that no book can take one for another."""
    shaken, simulate = [], problems.simulate
    monkeypatch.setattr(
        problems, "simulate", lambda system, *a, **b: (shaken.append(system), simulate(system, *a, **b))[1]
    )
    problems.shaken_imbalance(5, tip, 1e-6)
    (chain,) = shaken
    (push,), (shake,), turns = chain.loads, chain.actuators, chain.rotation
    speeds = [push.frequency_hz, shake.frequency_hz, turns.frequency_hz]
    assert min(np.diff(sorted([0.0, *speeds]))) > 0.1 * max(speeds)
    assert all(push.force)
    assert push.moment * push.at * shake.amplitude * turns.amplitude * turns.rate > 0.0
    assert (chain.dashpots > 0.0).all()
    assert (chain.axial_spring > 0.0) == (tip == "roller")


ASKED = {
    "turning_frequency": {"mode": 2, "speed": 7.0},
    "cantilever_tip": {"load": 1.7},
    "rollup_gap": {"wall": "gregory"},
    "hanging_frequency": {"mode": 2},
    "large_amplitude_frequency": {"amplitude": 1.3},
    "energy_drift": {"step": 2e-4},
    "transient_deflection": {"time": 2e-4, "x": 0.1, "force": 2.0},
}


@pytest.mark.parametrize("name", ASKED)
def test_segments_and_count_are_one_argument(name):
    assert figure(name, segments=9, **ASKED[name]) == figure(name, count=9, **ASKED[name])


@pytest.mark.parametrize("name", ASKED)
def test_a_chain_needs_its_number_of_links_once(name):
    with pytest.raises(InputError, match="segments is missing"):
        figure(name, **ASKED[name])
    with pytest.raises(InputError, match="count = 10 and segments = 9 mean the same"):
        figure(name, segments=9, count=10, **ASKED[name])


@pytest.mark.parametrize("component", ["deflection", "shortening"])
def test_the_cantilevers_tip_tends_to_the_elastica(component):
    exact = elastica_tip(2.5)[component == "shortening"]
    errors = [figure("cantilever_tip", load=2.5, segments=n, component=component) - exact for n in (30, 60)]
    assert abs(errors[1]) < 1e-4
    assert errors[0] / errors[1] == pytest.approx(4.0, rel=0.1)


def test_amplitudes_are_in_radii_of_gyration_of_the_scenes_beam():
    assert figure("large_amplitude_frequency", amplitude=1.5, segments=7) == pytest.approx(
        woinowsky_krieger(1.5), rel=1e-5
    )


def test_energy_drifts_with_order_four_in_the_step():
    drifts = [figure("energy_drift", segments=6, step=h, periods=0.5) for h in (2.4e-4, 1.2e-4)]
    assert np.log2(drifts[0] / drifts[1]) == pytest.approx(4.1, abs=0.3)


@pytest.mark.parametrize("more", [{"step": 1e-6}, {"method": "modal", "step": 5e-6}, {"method": "rk4", "step": 1e-6}])
def test_every_method_gives_the_same_transient(more):
    asked = {"time": 3e-4, "x": 0.06, "segments": 20, "force": 5.0}
    assert figure("transient_deflection", **asked, **more) == pytest.approx(
        figure("transient_deflection", **asked), rel=1e-5
    )


def test_the_linear_transient_is_in_proportion_to_the_force():
    asked = {"time": 8e-4, "x": 0.21, "segments": 20}
    big, small = (figure("transient_deflection", **asked, method="linear", force=force) for force in (30.0, 1.0))
    assert big == pytest.approx(30 * small, rel=5e-5)  # the links are read by their sines
    assert abs(figure("transient_deflection", **asked, force=30.0) / big - 1) > 1e-4


@pytest.mark.parametrize(
    ("name", "arguments", "message"),
    [
        (
            "transient_deflection",
            {"time": 1e-3, "x": 0.1, "segments": 49, "step": 3e-5},
            "above the stability limit 2.898e-05 s of rk4",
        ),
        ("transient_deflection", {"time": 1e-3, "x": 0.1, "segments": 9, "method": "modal"}, "step is missing"),
        ("transient_deflection", {"time": 1e-3, "x": 0.6, "segments": 9}, "lies off the chain"),
        ("transient_deflection", {"time": -1e-3, "x": 0.1, "segments": 9}, "time = -0.001"),
        ("hanging_frequency", {"mode": 5, "segments": 4}, "mode = 5"),
        ("large_amplitude_frequency", {"amplitude": 1e5, "segments": 9}, "up to L / 10"),
        ("cantilever_tip", {"load": 1.0, "segments": 9, "component": "slope"}, "component = 'slope' is not known"),
    ],
)
def test_bad_questions_are_refused(name, arguments, message):
    with pytest.raises(InputError, match=message):
        figure(name, **arguments)


def test_a_scene_without_forces_has_no_transient():
    with pytest.raises(InputError, match="has no drive by forces"):
        figure("transient_deflection", load_scene("steel-cantilever"), time=1e-3, x=0.1, segments=9)


def test_the_turning_cantilevers_frequency_is_that_of_the_linearised_chain():
    assert figure("turning_frequency", mode=1, speed=3.0, segments=40) == pytest.approx(3.743511896211, rel=1.1e-4)
    assert figure("turning_frequency", mode=1, speed=0.0, segments=40) == pytest.approx(1.8751040687**2, rel=1e-7)
    half = figure("turning_frequency", mode=1, speed=3.0, segments=40, wall="half")
    assert half < 3.743511896211 * (1 - 3e-4)


def sectioned(*sections, **more):
    """The scene's beam in pieces, each with its share of the length and what it has for itself."""
    beam = replace(CHAIN.beam, section=tuple(Section(length=share * 0.5, **own) for share, own in sections), **more)
    return replace(CHAIN, beam=beam, axial_inertia=None)


@pytest.mark.parametrize(
    ("own", "base"),
    [
        ({"youngs_modulus": 70e9, "thickness": 1e-3}, {"youngs_modulus": 7e9}),
        ({"width": 0.02, "thickness": 1e-3, "density": 2700.0}, {"thickness": 3e-4, "width": 0.07, "density": 900.0}),
    ],
)
def test_a_section_that_is_the_whole_beam_is_the_beam(own, base):
    """1.3178 at two radii of gyration, not the 1.037 of a tenth of E, whatever the beam says where no section does."""
    scene = sectioned((1.0, own), **base)
    found = figure("large_amplitude_frequency", scene, amplitude=2.0, segments=10)
    assert found == pytest.approx(figure("large_amplitude_frequency", amplitude=2.0, segments=10), rel=1e-9)
    assert found == pytest.approx(woinowsky_krieger(2.0), rel=1e-5)
    asked = {"segments": 12, "force": 6.0, "inertia": "elastic", "time": 3e-4, "x": 0.13}
    assert figure("axial_departure", scene, **asked) == pytest.approx(figure("axial_departure", **asked), rel=1e-6)


def test_unlike_sections_have_no_sine_for_a_first_mode():
    scene = sectioned((0.4, {}), (0.6, {"width": 0.03}))
    with pytest.raises(InputError, match=r"beam.section: the first mode of unlike sections is no sine"):
        figure("large_amplitude_frequency", scene, amplitude=2.0, segments=10)


def test_an_amplitude_in_radii_of_gyration_asks_for_a_section_that_has_one():
    stated = Beam(length=0.7, bending_stiffness=3.1, mass_per_length=0.2)
    with pytest.raises(InputError, match=r"this figure takes a section's sizes, give its shape, sizes and youngs_mod"):
        large_amplitude_frequency(stated, 1.5, 7)


def test_links_that_stretch_feel_where_the_soft_section_lies():
    asked = {"segments": 20, "force": 6.0, "inertia": "elastic", "time": 4e-4, "of": "rms", "x": 0.13}
    thin, wide = (0.5, {"width": 0.012}), (0.5, {"width": 0.031})
    one, other = (figure("axial_departure", sectioned(*parts), **asked) for parts in ((thin, wide), (wide, thin)))
    assert abs(one / other - 1.0) > 0.05


IN_TIME = {
    "large_amplitude_frequency": {"amplitude": 1.3},
    "energy_drift": {"step": 2e-4},
    "transient_deflection": {"time": 2e-4, "x": 0.1},
    "axial_departure": {"force": 2.0, "time": 2e-4},
}


@pytest.mark.parametrize("name", IN_TIME)
def test_a_loss_factor_is_refused_by_every_figure_in_time_and_the_plan_says_so(name):
    scene = replace(CHAIN, beam=replace(CHAIN.beam, loss_factor=0.01), axial_inertia=None)
    with pytest.raises(InputError, match=r"beam.loss_factor = 0.01: the nonlinear chain moves in time"):
        figure(name, scene, segments=9, **IN_TIME[name])
    gate = Gate(id="it", quantity=f"chain.{name}", arguments={"segments": 9, **IN_TIME[name]}, at_most=1.0, why="x")
    (problem,) = plan_scene(replace(scene, gate=(gate,))).problems
    assert "beam.loss_factor = 0.01" in problem.why


def test_figures_of_chains_of_their_own_do_not_care_for_the_scenes_beam():
    other = replace(CHAIN, beam=replace(CHAIN.beam, loss_factor=0.01, length=0.7, density=900.0), axial_inertia=None)
    for name in ("cantilever_tip", "rollup_gap", "hanging_frequency", "turning_frequency"):
        assert figure(name, other, segments=9, **ASKED[name]) == figure(name, segments=9, **ASKED[name])


@pytest.mark.parametrize("supports", [("clamped", "free"), ("clamped", "pinned")])
@pytest.mark.parametrize("name", ["large_amplitude_frequency", "energy_drift"])
def test_a_figure_between_hinges_refuses_other_ends(name, supports):
    scene = replace(CHAIN, beam=replace(CHAIN.beam, supports=supports), axial_inertia=None)
    with pytest.raises(
        InputError, match=r"beam.supports = \['clamped', .*: this figure is of a beam between two hinges"
    ):
        figure(name, scene, segments=9, **IN_TIME[name])


@pytest.mark.parametrize(
    ("motion", "field"),
    [
        ({"modal_damping": 0.02}, "motion.modal_damping = 0.02"),
        ({"soft_start_periods": 3.0}, "motion.soft_start_periods = 3.0"),
        ({"start": "steady"}, "motion.start = 'steady'"),
        ({"duration": 3e-3}, "motion.soft_start_periods = 2.0 unless given"),
    ],
)
@pytest.mark.parametrize("name", ["transient_deflection", "axial_departure"])
def test_a_scenes_motion_that_a_chain_does_not_make_is_refused(name, motion, field):
    with pytest.raises(InputError, match=rf"{field}: chain.{name} is from rest, undamped"):
        figure(name, replace(CHAIN, motion=MotionAsk(**motion)), segments=9, **IN_TIME[name])
    still = replace(CHAIN, motion=MotionAsk(modal_damping=0.0, soft_start_periods=0.0, duration=3e-3))
    assert figure(name, still, segments=9, **IN_TIME[name]) == figure(name, segments=9, **IN_TIME[name])


@pytest.mark.parametrize(
    ("name", "more", "message"),
    [
        ("transient_deflection", {"method": "linear", "step": 1e-6}, "step = 1e-06 is for method = 'rk4' or 'modal'"),
        ("transient_deflection", {"method": "adaptive", "step": 1e-6}, "step = 1e-06 is for method = 'rk4' or 'modal'"),
        ("transient_deflection", {"step": 1e-6, "tolerance": 1e-6}, "tolerance = 1e-06 is for method = 'adaptive'"),
        ("transient_deflection", {"method": "linear", "tolerance": 1e-6}, "tolerance = 1e-06 is for method"),
        ("energy_drift", {"tolerance": 1e-6}, "tolerance = 1e-06 with step = 0.0002: give one of the two"),
    ],
)
def test_a_setting_that_a_method_does_not_take_is_refused(name, more, message):
    with pytest.raises(InputError, match=message):
        figure(name, segments=9, **{**IN_TIME[name], **more})


@pytest.mark.parametrize("name", ["large_amplitude_frequency", "energy_drift", "axial_departure"])
def test_one_link_between_held_ends_is_refused_in_words_and_in_a_gates_verdict(name):
    arguments = {"segments": 1, **IN_TIME[name]}
    with pytest.raises(InputError, match=r"segments = 1: a single link between two held ends cannot move"):
        figure(name, **arguments)
    gate = Gate(id="it", quantity=f"chain.{name}", arguments=arguments, at_most=1.0, why="x")
    assert judge(gate, CHAIN, workbench_for(CHAIN)).reason.startswith("cannot be evaluated: segments = 1: a single")


@pytest.mark.parametrize(
    ("name", "arguments", "scene", "message"),
    [
        ("hanging_frequency", {"mode": 1, "segments": 10**9}, (), "segments = 1000000000: the modes"),
        ("turning_frequency", {"mode": 1, "speed": 1.0, "segments": 10**6}, (), "segments = 1000000: the modes"),
        ("cantilever_tip", {"load": 1.0, "segments": 10**12}, (), "segments = 1000000000000: an equilibrium"),
        ("rollup_gap", {"segments": 10**12}, (), "segments = 1000000000000: an equilibrium"),
        ("energy_drift", {"segments": 10**5}, (), "segments = 100000: the modes"),
        ("large_amplitude_frequency", {"segments": 10**5, "amplitude": 1.0}, (), "segments = 100000: the modes"),
        (
            "transient_deflection",
            {"segments": 10**12, "time": 1e-3, "x": 0.1},
            (),
            "segments = 1000000000000: a motion",
        ),
        (
            "transient_deflection",
            {"segments": 49, "time": 1e3, "x": 0.1},
            (),
            r"time = 1000 s takes about .* accelerations of links and 4e\+08 are the most",
        ),
        (
            "transient_deflection",
            {"segments": 49, "time": 1e3, "x": 0.1, "step": 1e-6},
            (),
            r"time = 1000 s takes about 2.4e\+11",
        ),
        (
            "transient_deflection",
            {"segments": 49, "time": 1e3, "x": 0.1, "step": 1e-9, "method": "modal"},
            (),
            "time = 1000 s takes about",
        ),
        ("energy_drift", {"segments": 60, "periods": 1000.0}, (), "takes about .* accelerations of links"),
        ("energy_drift", {"segments": 9, "step": 1e-300}, (), "takes about .* accelerations of links"),
        (
            "axial_departure",
            {"segments": 49, "force": 1.0},
            ("drive.frequency_hz=1e12",),
            r"time = 0.001 s at drive.frequency_hz = 1000000000000.0 would keep 4e\+10 states",
        ),
        (
            "axial_departure",
            {"segments": 49, "force": 1.0, "time": 0.09},
            ("beam.youngs_modulus=70e15",),
            "takes about .* accelerations",
        ),
        (
            "axial_departure",
            {"segments": 49, "force": 1.0, "inertia": "elastic"},
            ("beam.youngs_modulus=70e18",),
            "takes about .* accelerations",
        ),
    ],
)
def test_work_and_memory_are_counted_before_they_are_spent(name, arguments, scene, message):
    with pytest.raises(InputError, match=message) as refused:
        figure(name, load_scene("chain", ("axial_inertia={}", *scene)), **arguments)
    assert len(str(refused.value)) < 250


def test_a_long_figure_tells_how_far_it_is():
    heard, bench = [], workbench_for(CHAIN)
    bench.tell = heard.append
    found = quantity("chain.transient_deflection")
    evaluate(found, arguments_of(found, {"time": 2e-2, "x": 0.1, "segments": 49}), CHAIN, bench)
    assert len(heard) > 2
    assert heard == sorted(heard)
    assert 0.0 < heard[0] < heard[-1] <= 1.0


def test_a_stretching_chain_that_breaks_off_gives_no_departure(monkeypatch):
    broken = SimpleNamespace(
        finished=False, statistics=SimpleNamespace(stopped="diverged at 0.3 ms", interrupted=False)
    )
    monkeypatch.setattr(departure, "simulate_elastic", lambda *given, **more: broken)
    with pytest.raises(InputError, match=r"chain under 7.3 N diverged at 0.3 ms: give a smaller force"):
        figure("axial_departure", segments=5, force=7.3, inertia="elastic")
