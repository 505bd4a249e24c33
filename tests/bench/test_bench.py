"""The bench of real scenes: known errors and orders, references that name themselves, inputs that all move something."""

import json
import sys
from functools import cache
from importlib.machinery import ModuleSpec
from types import ModuleType

import msgspec
import numpy as np
import pytest

from verify.bench import measuring, peer_set, ride_set, running
from verify.bench.against import moved
from verify.bench.keeping import page
from verify.bench.request import Bench
from verify.bench.running import benched
from verify.bench.sets import SETS, all_cases, settled
from verify.bench.study import BenchStudy
from verify.cli import status_of
from verify.errors import InputError
from verify.judge.workbench import Workbench
from verify.models.catalogue import MODELS
from verify.peers import case as peer_case
from verify.peers import catalogue, references
from verify.peers.breaking import Break
from verify.peers.case import PeerRun
from verify.peers.catalogue import PEERS, Peer
from verify.report.html import page as report
from verify.report.plain import finite, run_as_plain
from verify.run.plan import plan_scene
from verify.run.runner import n_steps, run_scene
from verify.scenes.checked import checked
from verify.scenes.scene import load_scene, scene_type

QUICK = {"imports": False, "rounds": 3, "peers": False}
STRIP = {
    "name": "strip",
    "beam": {"length": 0.41, "width": 0.013, "thickness": 0.0011, "youngs_modulus": 113e9, "density": 4470.0},
    "drive": {"frequency_hz": 1730.0, "force": [{"position": 0.011}, {"position": 0.4, "phase_deg": 90.0}]},
    "slider": {"mass": 2e-4, "mu": 0.2, "slope": 100.0},
    "motion": {"duration": 1.5e-3, "counts": [40, 80, 160]},
}


def found_of(scene, **asked):
    return benched(Bench(**{**QUICK, **asked}), scene, Workbench(scene.beam))


def strip(**more):
    return checked(STRIP | more, scene_type())


@pytest.fixture(autouse=True, scope="module")
def one_run_to_a_turn():
    """What is tested here are no times."""
    before, measuring.TURN_S = measuring.TURN_S, 0.0
    yield
    measuring.TURN_S = before


@pytest.fixture(scope="module")
def paper():
    """Modes, fields and motions of the paper's beam."""
    return found_of(load_scene("paper"), counts=(24, 49, 98, 196), modes=(5, 22))


@pytest.fixture(scope="module")
def moving():
    """A slider and a nonlinear chain."""
    return found_of(strip(), sets=("slider", "chain"), counts=(30, 60), duration=6e-4)


def rows(found, **its):
    return [row for row in found.rows if all(getattr(row, name) == value for name, value in its.items())]


def row(found, **its):
    (one,) = rows(found, **its)
    return one


# --- What is found -------------------------------------------------------------------------------------------------


def test_the_papers_mode_has_the_errors_that_are_known(paper):
    at = {"set": "modes", "about": "mode 22", "count": 49}
    assert row(paper, method="segments", **at).error == pytest.approx(-0.00428024133, rel=1e-8)
    assert row(paper, method="Hermite elements", **at).error == pytest.approx(0.00260015828, rel=1e-8)
    assert row(paper, method="stock scikit-fem", **at).error == pytest.approx(0.00260015828, rel=1e-6)
    mean = (row(paper, method=name, **at).error for name in ("segments", "Hermite elements"))
    assert row(paper, method="mean of both", **at).error == pytest.approx(sum(mean) / 2, rel=1e-9)
    assert row(paper, method="exact", set="modes", about="mode 22").error == 0.0


@pytest.mark.parametrize(
    ("which", "method", "order", "off"),
    [
        ("modes", "segments", 4.0, 0.15),
        ("modes", "Hermite elements", 4.0, 0.05),
        ("modes", "mean of both", 6.0, 0.1),
        ("harmonic", "segments", 4.0, 0.2),
        ("harmonic", "Hermite elements", 4.0, 0.1),
        ("transient", "segments", 4.0, 0.2),
        ("transient", "Hermite elements", 4.0, 0.1),
    ],
)
def test_errors_fall_at_their_order(paper, which, method, order, off):
    finest = [one for one in rows(paper, set=which, method=method) if one.count == 196]
    assert finest
    for one in finest:
        assert abs(one.order - order) < off


def test_integrators_of_the_chain_have_their_orders(moving):
    at = {"set": "chain", "about": "N = 30"}
    for method, order, off in (("RK4", 4.0, 0.3), ("kicks, 1", 2.0, 0.3), ("adaptive", 1.0, 0.15)):
        assert abs(rows(moving, method=method, **at)[-1].order - order) < off
    kicks = [one.error for one in rows(moving, method="kicks, 2", **at)]
    assert kicks[0] / kicks[-1] > 16.0**2  # order 2 at the least, over steps that are halved four times
    departure = row(moving, method="linear flow", **at).error
    assert kicks[-1] < 1e-2 * departure < 1e-4


def test_the_slider_is_that_of_the_work_against_error(moving):
    """The same runs as `verify table --slider`, and the same reference."""
    from verify.studies.slider.work_precision import work_of

    work = work_of(strip(), (30, 60))
    for one in work.rows:
        method = MODELS[one.model].title
        ours = row(moving, set="slider", method=method, count=one.count)
        assert ours.error == pytest.approx(one.error, rel=1e-9)
        assert ours.reference_uncertainty == pytest.approx(work.step_floor, rel=1e-9)


def test_every_row_is_finite_and_names_its_reference(paper, moving):
    for one in (*paper.rows, *moving.rows):
        assert not one.left_out
        assert one.warm_s > 0.0
        assert one.spread_s >= 0.0
        assert one.first_s > 0.0
        assert one.rounds == 3
        assert one.reference
        assert 0.0 < one.reference_uncertainty < 0.05
        assert np.isfinite(one.error)
    json.dumps(paper.plain(), allow_nan=False)


def test_references_are_as_well_known_as_they_say(paper):
    """Closed forms against 40 digits of mpmath: the uncertainty is a bound, and no idle one."""
    mpmath = pytest.importorskip("mpmath")
    beam = load_scene("paper").beam
    with mpmath.workdps(40):
        b = {name: mpmath.mpf(getattr(beam, name)) for name in ("youngs_modulus", "density", "thickness", "length")}
        omega = (
            (22 * mpmath.pi / b["length"]) ** 2 * b["thickness"] * mpmath.sqrt(b["youngs_modulus"] / b["density"] / 12)
        )
        off = abs(float(Workbench(beam).exact_hz(22) / (omega / (2 * mpmath.pi)) - 1))
    assert off <= rows(paper, set="modes")[0].reference_uncertainty < 1e-14


@pytest.mark.parametrize(
    ("added", "sets", "due"),
    [
        ({}, ("modes", "harmonic", "transient", "slider"), 4.0),
        (
            {"section": [{"length": 0.15}, {"length": 0.26, "thickness": 0.0016}]},
            ("modes", "harmonic", "transient"),
            2.0,
        ),
        ({"section": [{"length": 0.15}, {"length": 0.26, "thickness": 0.0016}]}, ("slider",), 2.0),
        ({"tension": 90.0}, ("modes", "harmonic"), 2.0),
        ({"foundation": 400.0}, ("modes", "harmonic"), 4.0),
    ],
)
def test_every_set_compares_at_the_orders_that_are_due_on_the_beam(added, sets, due):
    """As frequencies fall, so do fields and motions: a chain on steps never comes to order 4."""
    scene, asked = strip(beam=STRIP["beam"] | added), Bench(**QUICK, sets=sets, counts=(40, 80), modes=(2,))
    cases, *_ = all_cases(asked, scene, Workbench(scene.beam))
    lines = {(case.set, entry.line.name): entry.line.orders for case in cases for entry in case.entries}
    assert {name for name, _ in lines} == set(sets)
    for name in sets:
        last = 3.5 if name == "harmonic" else 4.0  # of the parts that carry the forces
        assert lines[name, "segments"] == (min(due, last), due)
        assert lines[name, "Hermite elements"] == (last, 4.0)


@pytest.mark.parametrize(
    ("beam", "order"),
    [
        ({"supports": ["clamped", "free"]}, 2.5),
        ({"mass": [{"position": 0.233, "mass": 0.004, "rotary_inertia": 2e-6}]}, 2.5),
        ({"spring": [{"position": 0.233, "rotational": 1.7}]}, 2.5),
        ({"spring": [{"position": 0.0, "rotational": 1.7}], "mass": [{"position": 0.233, "mass": 0.004}]}, 3.5),
    ],
)
def test_a_field_is_judged_in_the_parts_that_carry_its_forces_too(beam, order):
    """There alone it is off by h^3 and h^2, on a length h; read at 201 places, many links seemed right."""
    scene = strip(
        beam=STRIP["beam"] | beam,
        drive={"frequency_hz": 157.0, "force": [{"position": 0.1363, "amplitude": 0.9}, {"position": 0.2897}]},
    )
    case = cases_of(scene, sets=("harmonic",), counts=(97, 769))["harmonic"]
    judged = case.judge()
    for name, due in (("segments", order), ("Hermite elements", 3.5)):
        coarse, fine = (one for one in case.entries if one.line.name == name)
        assert fine.line.orders == (due, 4.0)
        errors = [judged(one, one.prepare()().answer).error for one in (coarse, fine)]
        assert np.log(errors[0] / errors[1]) / np.log(769 / 97) == pytest.approx(due, abs=0.25)


def cases_of(scene, **asked):
    """By set, unmeasured."""
    cases, *_ = all_cases(Bench(**QUICK, **asked), scene, Workbench(scene.beam))
    return {case.set: case for case in cases}


def test_motions_under_a_step_load_fall_at_order_seven_thirds_unless_losses_calm_them():
    """Modes of n^-4 whose phases are lost from N^(2/3) on; damped, those are gone before it shows."""
    asked = {"sets": ("transient",), "counts": (12, 96), "duration": 2e-2, "x": 0.13}
    for losses, low, high in ((0.0, 2.1, 2.6), (0.05, 3.6, 4.2)):
        scene = strip(
            beam=STRIP["beam"] | {"supports": ["guided", "pinned"], "loss_factor": losses},
            motion={"duration": 1.5e-3, "soft_start_periods": 0.0},
            drive={"frequency_hz": 97.0, "force": [{"position": 0.083}, {"position": 0.31, "phase_deg": 40.0}]},
        )
        case = cases_of(scene, **asked)["transient"]
        assert "switched on at once" in case.condition
        judged = case.judge()
        ours = [one for one in case.entries if one.line.name == "Hermite elements"]
        coarse, fine = (judged(one, one.prepare()().answer).error for one in ours)
        assert low < np.log(coarse / fine) / np.log(8.0) < high
        assert ours[0].line.orders == pytest.approx((7.0 / 3.0, 4.0))
        assert "let the forces grow (motion.soft_start_periods)" in ours[0].line.remedy


def test_an_exact_motion_is_known_no_better_than_its_frequencies():
    """Those are known to 2e-14, so that after 0.03 s at 97 Hz and above an exact beam is not known to 1e-15."""
    scene = strip(drive={"frequency_hz": 97.0, "force": [{"position": 0.083}]}, motion={"duration": 0.03})
    case = cases_of(scene, sets=("transient",), counts=(12,), duration=0.03)["transient"]
    coarse = case.entries[0]
    known = case.judge()(coarse, coarse.prepare()().answer).reference.uncertainty
    assert 1.0 < known / (2e-14 * 2.0 * np.pi * 97.0 * 0.03 / np.sqrt(3.0)) < 4.0


def test_the_forces_on_a_chain_are_told_each():
    """No one amplitude of all, as [axial_inertia] has."""
    drive = {
        "frequency_hz": 97.0,
        "force": [{"position": 0.083, "amplitude": 0.05}, {"position": 0.3, "amplitude": 0.03}],
    }
    (chain,) = cases_of(strip(drive=drive), sets=("chain",), counts=(6,)).values()
    assert chain.condition == "0.05 and 0.03 N from rest, a step load, for 1.5 ms"


@pytest.mark.parametrize(("soft", "due"), [(0.0, None), (0.5, (4.0, 4.0))])
def test_a_slider_under_a_step_load_is_asked_for_no_order(soft, due):
    scene = strip(motion={"duration": 1.5e-3, "soft_start_periods": soft})
    line = cases_of(scene, sets=("slider",), counts=(40, 80))["slider"].entries[0].line
    assert line.orders == due
    assert bool(line.remedy) == (due is None)


@pytest.mark.parametrize(("added", "due"), [({}, 4), ({"section": [{"length": 0.15}, {"length": 0.26}]}, 2)])
def test_run_times_over_the_error_of_a_slider_know_the_order_that_is_due(added, due):
    from verify.studies.slider.work_precision import work_of

    scene = strip(beam=STRIP["beam"] | added, motion={"duration": 3e-4, "soft_start_periods": 0.2})
    assert work_of(scene, (30,)).orders == {"segment": due, "fem": 4}


def test_times_on_a_beam_in_tension_are_earned_at_order_two():
    scene = strip(beam=STRIP["beam"] | {"tension": 90.0, "loss_factor": 0.02})
    found = found_of(scene, sets=("harmonic",), counts=(12, 24, 48, 96, 192))
    (told,) = [one for one in found.sentences if one.methods == ("segments", "Hermite elements")]
    assert told.earned
    assert "observed orders 1." in told.text or "observed orders 2." in told.text


# --- Sentences -----------------------------------------------------------------------------------------------------


def test_each_comparison_has_a_sentence_with_its_condition(paper):
    told = [one for one in paper.sentences if one.methods == ("segments", "Hermite elements")]
    assert [(one.set, one.about) for one in told] == [
        ("modes", "mode 5"),
        ("modes", "mode 22"),
        ("harmonic", ""),
        ("transient", ""),
    ]
    for one in told:
        assert one.earned
        assert "paper, " in one.text
        assert "medians of 3 rounds of this run on this machine" in one.text
        assert one.ratio > 0.0
        assert 0.0 < one.at_error < 0.01


def test_a_chain_whose_error_changes_its_sign_earns_nothing():
    """Gregory's wall: the error of the cantilever's first mode passes zero on the way to its order."""
    found = found_of(load_scene("steel-cantilever"), modes=(1,), counts=(10, 20, 40, 80))
    told = next(one for one in found.sentences if one.methods == ("segments", "Hermite elements"))
    assert not told.earned
    assert "segments: errors fall not at order 4" in told.text
    assert {"segments, wall half", "segments, wall welded"} <= {one.method for one in found.rows}


def test_a_method_that_answers_wrongly_is_seen(monkeypatch, paper):
    """One part in ten thousand on the elements' eigenvalues: their rows move, their order is gone, nothing is earned."""
    model = type(MODELS["fem"])
    right = model.solve_modes

    def wrong(self, beam, n_modes, count, **settings):
        modes = right(self, beam, n_modes, count, **settings)
        return msgspec.structs.replace(modes, frequencies_hz=modes.frequencies_hz * 1.0001)

    monkeypatch.setattr(model, "solve_modes", wrong)
    found = found_of(load_scene("paper"), sets=("modes",), counts=(24, 49, 98, 196), modes=(5,))
    told = next(one for one in found.sentences if one.methods == ("segments", "Hermite elements"))
    assert not told.earned
    assert "Hermite elements: errors fall not at order 4" in told.text
    seen = [one.text for one in moved(paper.rows, found.rows, "before") if "the error of" in one.text]
    assert len(seen) == 8  # four sizes of the elements, and of the mean that they are half of
    assert all("Hermite elements" in text or "mean of both" in text for text in seen)


# --- What is asked -------------------------------------------------------------------------------------------------


def test_defaults_are_the_scenes_own():
    asked = settled(Bench(), load_scene("paper-slider"))
    assert asked.sets == ("modes", "harmonic", "transient", "slider", "chain")  # its gates ask for chains
    assert (asked.counts, asked.chains, asked.duration) == ((49, 98, 196, 392), (49,), 1e-3)
    assert settled(Bench(), load_scene("chain")).sets == ("modes", "harmonic", "transient", "chain")
    asked = settled(Bench(), load_scene("paper"))
    assert (asked.modes, asked.counts) == ((1, 5, 22), (10, 20, 49, 98, 196))
    assert asked.duration == pytest.approx(4.0 / 4276.0)
    assert settled(Bench(), load_scene("steel-cantilever")).sets == ("modes",)


def test_a_motor_on_the_nonlinear_chain_asks_for_that_set_and_its_number_of_links():
    asked = settled(Bench(), load_scene("preloaded-motor", ("motor.count=40",)))
    assert "chain" in asked.sets
    assert asked.chains == (40,)
    assert "chain" not in settled(Bench(), load_scene("multi-contact-slider")).sets


def test_sets_that_a_scene_has_not_are_named_with_the_reason():
    found = found_of(
        load_scene("steel-cantilever"), sets=("modes", "slider", "harmonic"), counts=(8,), modes=(1,), cold=True
    )
    assert {one.set for one in found.rows} == {"modes"}
    told = " / ".join(found.facts())
    assert "slider is left out: slider: the scene has no [slider], add it" in told
    assert "harmonic is left out: harmonic: nothing drives the beam" in told
    notes = " / ".join(found.notes)
    assert "chain is left out: nothing drives the beam" in notes  # its chains are bent, not driven
    assert (
        SETS["chain"].unasked(load_scene("guided-bar")).startswith("nothing in the scene asks for the nonlinear chain")
    )
    assert "the mean of both takes no part: mode.bracket: with wall = 'gregory'" in notes
    assert "cold: nothing of modes is compiled" in notes


TURNS = {
    "sets": ("modes",),
    "counts": (10, 30),
    "modes": (2,),
    "duration": 1.4e-3,
    "x": 0.17,
    "seconds": 0.2,
    "rounds": 4,
    "peers": True,
    "push": True,
    "imports": True,
    "cold": True,
}


@pytest.mark.parametrize("name", [one.name for one in msgspec.structs.fields(Bench)])
def test_every_input_moves_something(name, monkeypatch, ghost):
    """What is run or what is found: nothing is dropped in silence."""
    monkeypatch.setattr(running, "import_costs", lambda sets: [running.ChildCost("import", 0.1)])
    monkeypatch.setattr(running, "compile_costs", lambda scene, sets: {("harmonic", "segments"): 0.2})
    own = {"modes": "modes", "peers": "modes", "push": "modes", "duration": "transient", "x": "transient"}
    base = {"sets": (own.get(name, "harmonic"),), "counts": (10, 20), "modes": (1,), **QUICK}
    assert told(tuple(base.items())) != told(tuple((base | {name: TURNS[name]}).items()))


@cache
def test_what_is_compiled_for_several_methods_is_said_to_be_told_of_the_first(monkeypatch):
    """Segments and elements run one loop under a slider: it takes seconds of the first and none of the second."""
    monkeypatch.setattr(
        running, "compile_costs", lambda scene, sets: {("modes", "segments"): 2.7, ("modes", "Hermite elements"): 0.06}
    )
    found = found_of(load_scene("paper"), sets=("modes",), counts=(8, 12, 16), modes=(1,), cold=True)
    assert {one.compile_s for one in found.rows if one.method == "Hermite elements"} == {0.06}
    assert any("what several of them need is told of the first alone" in note for note in found.notes)


def told(asked):
    """What a bench of the strip tells, times aside; `asked` are pairs."""
    found = found_of(strip(), **dict(asked))
    times = {"warm_s", "spread_s", "set_up_s", "first_s"}
    plain = [{k: v for k, v in msgspec.to_builtins(one).items() if k not in times} for one in found.rows]
    return json.dumps([plain, found.notes, found.estimate_s, msgspec.to_builtins(found.costs)])


@pytest.mark.parametrize(
    ("given", "why"),
    [
        ({"sets": ["mode"]}, "sets"),
        ({"counts": [20, 20]}, "names one twice"),
        ({"counts": [1]}, "counts"),
        ({"modes": []}, "modes"),
        ({"seconds": 0.0}, "seconds"),
        ({"duration": -1.0}, "duration"),
        ({"rounds": 2}, "rounds"),
        ({"x": 0.41}, "lies off the beam"),
        ({"speed": 1}, "speed"),
    ],
)
def test_what_is_wrong_is_refused_in_one_sentence(given, why):
    with pytest.raises(InputError, match=why) as refused:
        strip(bench=given)
    assert len(refused.value.sentences) == 1


def test_nothing_left_to_measure_is_refused():
    with pytest.raises(InputError, match=r"nothing is left to measure.*has no \[slider\]"):
        found_of(load_scene("paper"), sets=("slider",))


def test_what_does_not_fit_into_the_time_is_named():
    found = found_of(load_scene("paper"), sets=("modes",), counts=(20, 400, 3000), modes=(1,), seconds=1.0)
    left = {one.count for one in found.rows if one.left_out}
    assert left == {3000}
    assert found.estimate_s <= 1.0
    assert all("give more seconds" in one.left_out for one in found.rows if one.left_out)


# --- Other engines -------------------------------------------------------------------------------------------------


class Ghost:
    """An engine that moves chain and slider exactly but for what its step makes of it, order 2."""

    def frequencies(self, case):
        return np.arange(1.0, case.n) * 100.0

    def prepare(self, case, sled=None):
        def run(step, end):
            steps, step = peer_case.count(step, end)
            times, off = np.linspace(end / 50, end, 50), 1.0 + (step / COARSE) ** 2
            slid = (np.zeros(0), np.zeros(0)) if sled is None else exact_ride(case, sled, end).at(times)
            return PeerRun(
                times=times,
                deflection=off * references.deflection(case, times),
                distance=off * slid[0],
                speed=off * slid[1],
                seconds=2e-3,
                set_up_s=1e-3,
                steps=steps,
                broke="stalled Newton at t = 2 us" if step > 1.1e-5 else "",
            )

        return run


RIDE_STEPS = 1500
COARSE = 1e-4
"""A step that makes everything twice as large."""
GHOST = Peer(name="Ghost", package="ghost-engine", module="ghost_engine", home="ghost_engine:Ghost", implicit=True)


@cache
def exact_ride(case, sled, end):
    return references.ride(case, sled, end, RIDE_STEPS)


@pytest.fixture
def ghost(monkeypatch):
    """An engine that is there beside three that are not."""
    module = ModuleType("ghost_engine")
    module.__spec__, module.Ghost = ModuleSpec("ghost_engine", None), Ghost
    monkeypatch.setitem(sys.modules, "ghost_engine", module)
    monkeypatch.setattr(catalogue, "installed", lambda peer: "1.2" if peer.name == "Ghost" else None)
    monkeypatch.setattr(peer_set, "installed", catalogue.installed)
    monkeypatch.setattr(references, "RIDE_STEPS", RIDE_STEPS)
    with PEERS.registered(GHOST):
        yield


def gently(**drive):
    """The strip under forces so small that the nonlinear chain is the linear one."""
    force = [one | {"amplitude": 1e-2} for one in STRIP["drive"]["force"]]
    return strip(drive=STRIP["drive"] | {"force": force} | drive)


def test_an_engine_whose_chain_is_too_short_for_a_mode_is_left_out_there_with_the_reason(ghost):
    found = found_of(strip(), sets=("modes",), counts=(8, 30), modes=(9,), peers=True)
    short, enough = rows(found, set="modes", method="Ghost")
    assert short.left_out == "mode = 9: the Ghost model at count = 8 has 7 elastic modes, raise count"
    assert enough.error == pytest.approx(900.0 / Workbench(strip().beam).exact_hz(9) - 1)


def test_an_engine_that_refuses_one_size_stands_at_the_others(ghost):
    found = found_of(strip(), sets=("modes",), counts=(4, 30), modes=(2,), peers=True)
    assert row(found, set="modes", method="Ghost").count == 30
    assert any(note.startswith("Ghost is left out of some sizes: count = 4: ") for note in found.notes)


@pytest.mark.parametrize(("count", "finest"), [(49, 1 / 768), (99, 1 / 768), (199, 1 / 1536), (399, 1 / 3072)])
def test_our_slider_beside_engines_goes_to_finer_steps_the_more_links_there_are(count, finest):
    """A step load rings modes up to the highest: at 399 links the steps of 49 came to 7e-5 and told nothing at 1e-5."""
    scene = strip()
    period = 1.0 / scene.drive.frequency_hz
    own = list(ride_set._own(scene, settled(Bench(duration=100.0 * period), scene), scene.slider, count))
    assert own[0].size == pytest.approx(period / 12.0, rel=0.01)
    assert own[-1].size == pytest.approx(finest * period, rel=0.01)


@pytest.mark.parametrize(("count", "rungs"), [(49, 8), (99, 8), (199, 9), (399, 10)])
def test_so_does_an_engine_whose_steps_no_limit_shortens(monkeypatch, count, rungs):
    """An implicit one came to 1.06e-5 of a chain of 399 links. The explicit limit falls as the links' length squared."""
    monkeypatch.setitem(sys.modules, "ghost_engine", ModuleType("ghost_engine"))
    scene = strip()
    links = peer_case.case_of(scene.beam, count, scene.forces, scene.drive.frequency_hz)
    for implicit, told in ((True, rungs), (False, 7)):
        with PEERS.registered(msgspec.structs.replace(GHOST, implicit=implicit)):
            sizes = [entry.size for entry in peer_set.ladder("Ghost", Ghost(), links, None, 5e-3)]
        assert sizes[0] / sizes[-1] == pytest.approx(2.0 ** (told - 1), rel=1e-9)


@pytest.mark.parametrize(("dense", "growth"), [(False, 2.0), (True, 3.7)])
def test_steps_of_full_matrices_alone_are_thought_to_take_time_by_links_squared(monkeypatch, dense, growth):
    """Of 400 links beside 200: an engine in O(N) was left out of a bench for hours that it takes minutes for."""
    monkeypatch.setitem(sys.modules, "ghost_engine", ModuleType("ghost_engine"))
    with PEERS.registered(msgspec.structs.replace(GHOST, dense=dense)):
        scene = strip()
        drawn = [peer_case.case_of(scene.beam, n, scene.forces, scene.drive.frequency_hz) for n in (200, 400)]
        first, other = (next(peer_set.ladder("Ghost", Ghost(), links, None, 5e-3)) for links in drawn)
    made = [peer_set.START_S + peer_set.START_LINKS_S * links.n**2 for links in drawn]
    assert other.size == first.size
    assert (other.estimate_s - made[1]) / (first.estimate_s - made[0]) == pytest.approx(growth, rel=0.05)


def test_an_engine_that_is_there_stands_in_modes_chain_and_slider_and_one_that_is_not_is_named(ghost):
    found = found_of(
        gently(), sets=("modes", "chain", "slider"), counts=(30,), modes=(2,), duration=6e-4, seconds=90.0, peers=True
    )
    assert row(found, set="modes", method="Ghost").error == pytest.approx(
        200.0 / Workbench(strip().beam).exact_hz(2) - 1
    )
    for which in ("chain", "slider"):
        own = rows(found, set=which, method="Ghost")
        assert len(own) == peer_set.RUNGS + peer_set.MORE
        *run, last = own  # the one before is within a tenth of the least error that is asked for
        assert last.left_out == "longer steps of Ghost come to 0.001 %, it is not run"
        for one in run:
            assert one.error == pytest.approx((one.settings["step"] / COARSE) ** 2, rel=0.03, abs=1e-6)
    assert "MuJoCo is not installed: pip install 'fem-segment-verify[peers]', or go without it" in found.notes
    assert found.versions["Ghost"] == "1.2"
    races = {one.methods: one for one in found.sentences if "Ghost" in one.methods and one.set != "modes"}
    assert set(races) == {("kicks, 2", "Ghost"), ("RK4", "Ghost"), (ride_set.OURS, "Ghost")}
    for methods, one in races.items():
        assert one.earned
        assert f": {methods[0]} against Ghost: at 0.1 % Ghost takes " in one.text
        if methods[0] == "RK4":
            assert one.at_error == 1e-3
            assert "at 0.001 % nothing is said, RK4 comes to 0.00" in one.text
        else:
            assert one.at_error == 1e-5
            assert "at 0.001 % Ghost takes " in one.text


def test_an_engine_is_held_against_a_slider_on_the_exact_chain_as_well_as_that_is_known(ghost):
    """A hundredth of a newton departs by a hundredth of a hundredth of what a tenth does: the square of the force."""
    its = settled(Bench(counts=(30,), duration=6e-4), gently())
    small, large = (ride_set.departs(scene, its, 30) for scene in (gently(), strip()))
    assert large / small == pytest.approx(1e4, rel=0.05)
    assert small < ride_set.SMALL < large
    found = found_of(gently(), sets=("slider",), counts=(30,), duration=6e-4, seconds=90.0, peers=True)
    own = rows(found, set="slider", method="Ghost")
    own = [one for one in own if not one.left_out]
    assert {one.reference for one in own} == {
        "a slider on the exact linear chain, and how far the nonlinear one departs"
    }
    assert all(one.reference_uncertainty == pytest.approx(small, rel=1e-6) for one in own)


def test_an_engine_under_larger_forces_is_held_against_its_own_shortest_step(ghost):
    found = found_of(strip(), sets=("slider",), counts=(30,), duration=6e-4, seconds=90.0, peers=True)
    own = rows(found, set="slider", method="Ghost")
    assert own[-1].left_out == "longer steps of Ghost come to 0.001 %, it is not run"
    run = [one for one in own if not one.left_out]
    assert len(run) == len(own) - 1
    assert all(one.error > 0.0 for one in run)
    assert own[3].order == pytest.approx(2.0, abs=0.05)


def test_our_own_slider_takes_the_steps_that_are_told(ghost):
    """Also where samples lie nearer than a step: its error falls at its order from the longest step on."""
    from verify.motion.simulate import simulate

    scene = gently()
    found = found_of(scene, sets=("slider",), counts=(30,), duration=6e-4, seconds=90.0, peers=True)
    ours = rows(found, set="slider", method=ride_set.OURS)
    steps = [round(6e-4 / one.settings["step"]) for one in ours]
    assert steps == [steps[0] * 2**k for k in range(len(ours))]
    seen = [one.order for one in ours if one.order is not None]
    assert len(seen) >= 4
    assert all(1.5 < order < 4.8 for order in seen)
    forces, end = scene.forces, 6e-4
    slider = msgspec.structs.replace(scene.slider, coupling="one-way")
    finest = {"count": 30, "slider": slider, "ledger": False, "samples": steps[0] + 1}
    one, true = (
        simulate(scene.beam, forces, 1730.0, end, step=end / n * (1 + 1e-9), **finest)
        for n in (steps[1], steps[0] * 2 ** (len(ours) + 1))
    )
    assert one.statistics.steps == steps[1]
    off = [
        np.sqrt(np.mean((a - b) ** 2) / np.mean(b**2))
        for a, b in ((one.travelled, true.travelled), (one.speed, true.speed))
    ]
    assert ours[1].error == pytest.approx(max(off), rel=1e-6)


def test_an_engine_that_breaks_is_said_in_its_row(ghost):
    slow = gently(frequency_hz=640.0)
    found = found_of(slow, sets=("chain",), counts=(12,), duration=6e-4, seconds=60.0, peers=True)
    first = rows(found, method="Ghost")[0]
    assert first.left_out == "Ghost broke: stalled Newton at t = 2 us"


def test_an_engine_that_is_pushed_says_what_it_did_or_that_nobody_knows(ghost, monkeypatch):
    asked = {"sets": ("modes",), "counts": (30,), "modes": (1,), "peers": False, "push": True}
    found = found_of(gently(), **asked)
    assert found.pushed == ()
    assert any(
        note.startswith("Ghost is not pushed: peer = 'Ghost': how it breaks is known of") for note in found.notes
    )
    done = Break(
        engine="Ghost", links=30, pushed="hard", did="it went home", until=1e-4, asked=2e-4, steps=3, seconds=0.1
    )
    monkeypatch.setattr(peer_set, "pushed", lambda name, case, end: done)
    found = found_of(gently(), **asked)
    assert found.pushed == (done,)
    (table,) = [one for one in found.tables() if one.title == "Other engines pushed until they break"]
    assert table.rows == (("Ghost", 30, "hard", "it went home", 3, 0.1),)
    assert "it went home" in page(found, "verify bench paper")


@pytest.mark.parametrize("name", ["transient", "slider"])
def test_a_set_that_the_exact_beam_has_no_motion_for_is_refused_by_a_key_of_the_bench(name):
    """Nothing in [bench] chooses a model; a run tells it in the terminal too, as the set was asked for."""
    scene = strip(beam=STRIP["beam"] | {"tension": 90.0})
    (told,) = all_cases(Bench(**QUICK, sets=(name,)), scene, Workbench(scene.beam))[2]
    assert told.endswith(f"the exact beam in time takes none, leave it out or give bench.sets without '{name}'")
    assert told.startswith(f"{name} is left out: beam.tension")


def test_a_part_of_a_run_tells_the_time_of_the_whole():
    """A tenth of the steps after 1 s of set-up: 3 s measured are 1 s and ten times 2 s."""
    assert measuring._of_the_whole(3.0, 1.0 / 3.0, 0.1) == pytest.approx((21.0, 1.0 / 21.0))
    assert measuring._of_the_whole(3.0, None, 0.5) == (6.0, None)


def test_without_engines_nothing_but_their_names_is_told(monkeypatch):
    monkeypatch.setattr(peer_set, "missing", lambda peer: f"{peer.name} is away")
    cases, notes, _ = all_cases(
        Bench(sets=("modes", "slider"), counts=(20,), modes=(1,)), strip(), Workbench(strip().beam)
    )
    assert [case.name for case in cases if case.entries] == ["modes, mode 1", "slider"]
    assert notes[-3:] == [f"{name} is away" for name in ("Exudyn", "MuJoCo", "Pinocchio")]


# --- Where it is told ----------------------------------------------------------------------------------------------


def test_a_scene_with_a_bench_has_it_in_its_plan_its_run_and_its_report():
    scene = strip(bench={"sets": ["modes"], "counts": [10, 20, 40], "modes": [1], **QUICK})
    (asked,) = [one for one in plan_scene(scene).solves if one.model == "fem" and one.count == 40]
    assert asked.asked_by[0].startswith("bench (modes at N = 10, 20, 40, about 20 s of work at most)")
    steps = []
    result = run_scene(scene, steps.append)
    assert len([one for one in steps if one.startswith("bench")]) == BenchStudy().n_steps(scene.bench, scene)
    assert n_steps(scene) >= len(steps) > 0
    html = report(result, "verify run strip")
    assert "bench-modes" in html
    assert "Run time against error" in html
    assert "segments against Hermite elements" in html
    plain = finite(run_as_plain(result, None))
    assert set(plain["bench"]) >= {"scene", "date", "machine", "versions", "costs", "rows", "sentences"}


def test_a_page_that_is_kept_names_machine_and_versions_and_no_path(paper, tmp_path):
    text = page(paper, "verify bench paper --seconds 40")
    assert "\nMade by `verify bench paper --seconds 40`.\n" in text
    assert text.startswith("# Run time against error: paper\n")
    assert paper.date in text
    assert f"numpy {np.__version__}" in text
    assert "/tmp" not in text
    assert "/home" not in text
    assert text.count("| segments | N = 49 |") == 4
    flat = " ".join(text.split())
    assert all(" ".join(fact.split()) in flat for fact in paper.facts())
    assert all(len(line) <= 120 for line in text.splitlines())


def test_charts_have_a_line_for_every_method_and_stand_on_logarithms(paper):
    (modes, harmonic, transient) = paper.charts()
    assert [one.id for one in paper.charts()] == ["bench-modes", "bench-harmonic", "bench-transient"]
    names = {line.name for line in modes.lines if line.keyed}
    assert {"segments", "Hermite elements", "stock scikit-fem", "mean of both"} <= names
    assert {line.name for line in transient.lines} == {"segments", "Hermite elements"}  # the reference itself has none
    for chart in (modes, harmonic, transient):
        assert chart.x.log
        assert chart.y.log
        for line in chart.lines:
            assert all(value is None or value > 0.0 for value in (*line.x, *line.y))


def test_the_command_prints_json_that_it_reads_again(tmp_path, capsys, monkeypatch):
    monkeypatch.setattr("os.getloadavg", lambda: (0.3, 0.0, 0.0))
    line = ["bench", "paper", "--sets", "modes", "--counts", "20,30", "--modes", "1", "--set", "bench.imports=false"]
    line += ["--set", "bench.rounds=3"]
    assert status_of([*line, "--json"]) == 0
    old = json.loads(capsys.readouterr().out)
    assert old["scene"] == "paper"
    assert {"processor", "cores", "system"} == set(old["machine"])
    kept = {"set", "method", "model", "settings", "count", "error", "reference", "reference_uncertainty", "order"}
    kept |= {"warm_s", "spread_s", "set_up_s", "first_s", "compile_s", "rounds", "left_out"}
    assert all(kept <= set(one) for one in old["rows"])
    assert all({"set", "text", "earned", "ratio"} <= set(one) for one in old["sentences"])
    path = tmp_path / "old.json"
    for one in old["rows"]:
        if one["method"] == "stock scikit-fem":
            one["warm_s"] = 40.0 * one["warm_s"]
    old["machine"]["processor"], old["versions"]["numpy"] = "an abacus", "0.9"
    path.write_text(json.dumps(old))
    assert status_of([*line, "--against", str(path), "--keep", str(tmp_path / "kept")]) == 0
    out = " ".join(capsys.readouterr().out.split())
    assert f"against {old['date']} (an abacus, numpy 0.9): stock scikit-fem in modes, mode 1, N = 20 takes 0.0" in out
    kept = (tmp_path / "kept" / "paper.md").read_text()
    assert kept.startswith("# Run time against error: paper")
    made = "verify bench paper --set bench.imports=false --set bench.rounds=3 --sets modes --counts 20,30 --modes 1"
    assert f"Made by `{made} --against old.json --keep kept`." in " ".join(kept.split())
    for layout in ("--csv", "--markdown"):
        assert status_of([*line, layout]) == 0
        assert "stock scikit-fem" in capsys.readouterr().out


@pytest.mark.parametrize(
    ("words", "why"),
    [
        (["--sets", "mode"], "sets"),
        (["--counts", "a"], "counts"),
        (["--seconds", "many"], "seconds"),
        (["--seconds", "1e-9"], "nothing is left to measure"),
        (["--against", "none.json"], "cannot be read"),
        (["--modes", "0"], "modes"),
    ],
)
def test_the_command_refuses_in_one_sentence(words, why, capsys):
    assert status_of(["bench", "paper", *words]) == 2
    said = capsys.readouterr().err
    assert said.startswith("verify: ")
    assert why in said
    assert said.count("\n") == 1


def test_an_earlier_bench_of_another_scene_is_refused(tmp_path, capsys):
    path = tmp_path / "old.json"
    path.write_text('{"scene": "chain", "rows": []}')
    words = ["bench", "paper", "--sets", "modes", "--counts", "8", "--modes", "1", "--set", "bench.imports=false"]
    assert status_of([*words, "--against", str(path)]) == 2
    assert "about the scene 'chain', not 'paper'" in capsys.readouterr().err


def test_a_wall_that_a_beam_with_steps_has_none_of_is_named_with_the_reason():
    found = found_of(load_scene("stepped-beam"), sets=("modes",), counts=(8, 12, 16), modes=(1,))
    assert any(
        note.startswith("segments, wall welded takes no part: wall = 'welded' is for uniform") for note in found.notes
    )
    for without in ("steel-cantilever", "paper"):
        notes = found_of(load_scene(without), sets=("modes",), counts=(8, 12, 16), modes=(1,)).notes
        assert not any("welded takes no part" in note for note in notes)
