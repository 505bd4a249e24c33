"""What a plan says will be done is what a run does: motions, steps told, studies, and what is skipped with its reason."""

from math import pi

import pytest
from msgspec.structs import replace
from packaged import ran, solve_in_words

from verify.attached import PointSpring
from verify.errors import InputError
from verify.judge.workbench import Workbench
from verify.motion import case
from verify.quantities.catalogue import arguments_of, quantity
from verify.report.terminal import print_plan
from verify.run.asks import asks_of
from verify.run.plan import plan_scene
from verify.run.runner import n_steps, run_scene, workbench_for
from verify.scenes.checked import checked
from verify.scenes.scene import load_scene, packaged_scenes, scene_type
from verify.studies.catalogue import STUDIES, asked_of
from verify.studies.slider.study import SliderStudy


@pytest.mark.parametrize("scene", packaged_scenes())
def test_a_run_does_the_motions_that_were_planned_and_tells_the_steps_that_were_counted(scene):
    assert ran(scene).motions == plan_scene(load_scene(scene)).motions
    assert len(ran(scene).steps) == n_steps(load_scene(scene))


SEARCHED = "mode.count_needed"
"""Solves sizes that nobody knows beforehand."""


@pytest.mark.parametrize("scene", ["instrument-arm", "taut-strip", "thick-bar", "steel-cantilever", "patched-strip"])
def test_a_run_solves_what_was_planned_as_it_was_planned(scene):
    """Sizes, settings, unknowns and methods; a search for a size solves more."""
    planned = {solve_in_words(one) for one in plan_scene(load_scene(scene)).solves}
    done = set(ran(scene).solves)
    assert planned <= done
    if not any(gate.quantity == SEARCHED for gate in load_scene(scene).gate):
        assert done == planned


@pytest.mark.parametrize("scene", packaged_scenes())
def test_every_study_is_run_or_skipped_with_its_reason(scene):
    skipped = {one.what: one.why for one in plan_scene(load_scene(scene)).skipped}
    for name in STUDIES.own():
        assert (name in ran(scene).studies) != (f"{name} study" in skipped), name
        assert skipped.get(f"{name} study", "reason")


def test_the_motions_of_a_slider_s_study_are_counted_where_they_are_done(monkeypatch):
    """Each run of its three models, both ways where a claim asks, the steady wave, the references, and every round."""
    done = []
    true = case.simulate
    monkeypatch.setattr(case, "simulate", lambda *given, **more: done.append(more["model"]) or true(*given, **more))
    scene = load_scene("paper-slider", ("motion.counts=[9, 13]", "motion.count=11", "motion.duration=6e-4"))
    study = SliderStudy()
    asked = study.asked(scene)
    found = study.run(asked, scene, Workbench(scene.beam), {}, lambda step: None)
    assert len(done) == found.motions() == study.n_motions(asked, scene)
    assert done.count("segment") == done.count("fem") == 2 + 7 * 2


def test_a_motion_without_a_slider_is_skipped_with_the_reason_it_has():
    scene = replace(load_scene("paper-slider").bare, slider=None, gate=(), claim=())
    assert scene.motion is not None
    (why,) = [one.why for one in plan_scene(scene).skipped if one.what == "motion study"]
    assert why == "the scene has no [slider]; its [motion] says how gates and claims in time are run"
    assert "motion" not in {study.name for study, _ in asked_of(scene)}


def test_the_kind_of_work_is_what_a_quantity_says_not_what_it_is_called():
    scene = load_scene("paper-slider")
    work = {ask.name: ask.works for ask in asks_of(scene)}
    assert work["friction-size"] == ("harmonic",)  # a slider's figure without a step in it
    assert work["slider-order-fem"] == ("in time",)
    assert {ask.works for ask in asks_of(load_scene("chain")) if ask.kind == "gate"} == {("equilibrium",), ("in time",)}
    stepped = plan_scene(scene).stepped
    assert "gate friction-size" not in stepped
    assert "gate slider-order-fem" in stepped


def test_a_plan_says_who_asks_for_a_vibration_that_a_buckled_beam_has_not():
    """1.01 of pi^2 EI / L^2 between pinned ends: all that vibrates is refused, friction on its own is not."""
    beam = load_scene("taut-strip").beam
    load = (pi / beam.length) ** 2 * beam.bending_stiffness
    more = (
        "beam.foundation=0",
        "sensitivity={mode=2}",
        'gate=[{id="a", quantity="mode.frequency", why="w", at_least=1, arguments={model="analytic", mode=2}},'
        '{id="b", quantity="friction.free_decay", why="w", at_least=0,'
        "arguments={mu=0.1, slope=10, speed=1, time=0.1}}]",
    )
    for factor, known in ((1.01, {"sensitivity", "gate a", "spectrum", "convergence"}), (0.99, set())):
        problems = plan_scene(load_scene("taut-strip", (f"beam.tension={-factor * load!r}", *more))).problems
        assert {one.who.split(" (")[0] for one in problems} == known
        assert all("buckl" in one.why for one in problems)


@pytest.mark.parametrize("scene", packaged_scenes())
def test_every_packaged_scene_can_be_planned(scene):
    assert plan_scene(load_scene(scene)).problems == ()


@pytest.mark.parametrize(
    ("changed", "said"),
    [
        ("beam.mass=[{position=0.26, mass=0.01}]", "holds a mass or a spring at \\[0.26\\]"),
        ("drive.frequency_hz=20", "shorter than half a wavelength"),
        ("drive.frequency_hz=123456", "lies beyond, give count"),
        ("beam.tension=-1234", "beyond its buckling load"),
        ("beam.foundation=1e9", "no wave runs below 21658.2 Hz on beam.foundation"),
        ("drive.force=[{position=0.2},{position=0.41}]", "leaves the span between two forces"),
    ],
)
def test_what_a_run_of_a_wave_refuses_its_plan_refuses_in_the_same_words(changed, said):
    scene = replace(load_scene("paper-wave", (changed,)), gate=(), claim=())
    problems = {problem.who: problem.why for problem in plan_scene(scene).problems}
    with pytest.raises(InputError, match=said) as refused:
        run_scene(scene)
    assert problems["wave"] == str(refused.value)


@pytest.mark.parametrize("scene", ["thick-bar", "paper", "steel-cantilever"])
def test_a_plan_of_eighty_columns_cuts_nothing(scene, capsys, monkeypatch):
    monkeypatch.setenv("COLUMNS", "80")
    print_plan(plan_scene(load_scene(scene)))
    told = capsys.readouterr().out
    assert "…" not in told
    assert "asked by" in told
    assert max(map(len, told.splitlines())) <= 80


def test_a_slider_on_a_beam_that_the_exact_model_does_not_move_is_refused_by_its_plan_too():
    scene = replace(load_scene("paper-slider"), gate=(), claim=(), readings=None)
    held = replace(scene.beam, spring=(PointSpring(position=0.26, stiffness=321.0),))
    scene = replace(scene, beam=held)
    plan = plan_scene(scene)
    (problem,) = plan.problems
    assert problem.who == "motion"
    with pytest.raises(InputError, match=r"beam\.spring: the exact beam in time takes none") as refused:
        run_scene(scene)
    assert problem.why == str(refused.value)
    untrue = [
        one for one in plan.skipped if one.what in ("slider", "time stepping", "numba", "numpy, scipy, scikit-fem")
    ]
    assert not untrue, "asked for, if in vain"


def test_what_a_slider_on_such_a_beam_is_told_to_ask_for_instead_runs():
    scene = replace(load_scene("paper-slider"), gate=(), claim=(), readings=None)
    held = replace(scene.beam, spring=(PointSpring(position=0.26, stiffness=321.0),))
    (problem,) = plan_scene(replace(scene, beam=held)).problems
    assert "leave [motion] out" in problem.why
    assert "slider.displacement with model = 'fem' or 'segment', count and time" in problem.why
    asked = quantity("slider.displacement")
    for model in ("fem", "segment"):
        given = arguments_of(asked, {"model": model, "count": 12, "time": 1e-3})
        bare = replace(scene, beam=held, motion=None)
        assert abs(float(asked.evaluate(given, bare, workbench_for(bare)))) > 0.0


STRIP = {"length": 0.61, "width": 0.03, "thickness": 0.002, "youngs_modulus": 71e9, "density": 2710.0}
DRIVE = {"frequency_hz": 310.0, "force": [{"position": 0.1}, {"position": 0.47, "phase_deg": 90.0}]}
SLIDER = {"mass": 1e-4, "mu": 0.2}


@pytest.mark.parametrize(
    ("quantity", "arguments", "more", "said"),
    [
        ("slider.displacement", {"count": 9}, {}, "time is missing"),
        ("slider.displacement", {"count": 9, "time": 3e-3}, {}, "the forces grow over 0.0064"),
        ("motion.deflection", {"model": "analytic", "x": 0.2, "time": 3e-3, "start": "steady"}, {"frequency_hz": 112.27591886485595}, "of mode 3"),
        ("wave.crest_speed", {}, {"frequency_hz": 112.27591886485595}, "undamped resonance of mode 3 of the analytic model"),
        ("wave.crest_speed", {"model": "segment", "count": 3}, {}, "lies beyond, give count"),
        ("wave.reflection", {"window": [0.05, 0.4]}, {}, "leaves the span between two forces"),
        ("wave.reflection_per_degree", {}, {"force": [{"position": 0.1}]}, "a phase between two forces, the scene has 1"),
        ("slider.coupling_size", {"of": "normal"}, {"slider": None}, "the scene has no slider"),
        ("chain.slider_displacement", {"segments": 9}, {}, "time is missing"),
        ("chain.transient_deflection", {"segments": 9, "x": 0.2, "time": 1e-3}, {"force": []}, "has no drive by forces"),
    ],
)  # fmt: skip
def test_what_a_figure_of_a_driven_beam_is_refused_for_before_anything_is_solved_its_plan_says(
    quantity, arguments, more, said
):
    """Mode 3 of the strip is at 112.27591886485595 Hz, where an undamped beam has no steady field."""
    gate = {"id": "g", "quantity": quantity, "arguments": arguments, "at_least": 0.0, "why": "w"}
    slider = {"slider": SLIDER} if more.get("slider", SLIDER) else {}
    drive = DRIVE | {name: value for name, value in more.items() if name != "slider"}
    scene = checked({"name": "s", "beam": STRIP, "drive": drive, "gate": [gate]} | slider, scene_type())
    (problem,) = plan_scene(scene).problems
    assert said in problem.why
    run = run_scene(scene)
    assert run.gates[0].reason == f"cannot be evaluated: {problem.why}"
    assert (run.n_fields, run.n_motions, run.solves) == (0, 0, ())


def test_a_plan_of_what_cannot_run_exits_with_1_and_says_it(capsys, tmp_path, monkeypatch):
    from verify.cli import status_of

    assert status_of(["plan", "paper"]) == 0
    assert status_of(["plan", "paper", "--set", "gate.segment-order.quantity=mode.ordr"]) == 1
    assert "cannot run: gate segment-order" in capsys.readouterr().out


def test_a_plan_says_that_the_forces_on_a_slider_s_beam_grow_for_longer_than_they_act():
    scene = replace(load_scene("paper-slider"), gate=(), claim=(), readings=None)
    scene = replace(scene, motion=replace(scene.motion, duration=3e-4))
    (problem,) = plan_scene(scene).problems
    assert (problem.who, problem.why[:39]) == ("motion", "the forces grow over 0.000467726847521 ")
    with pytest.raises(InputError, match="the forces grow over") as refused:
        run_scene(scene)
    assert problem.why == str(refused.value)


def test_a_rule_that_nobody_asked_for_is_left_out_where_it_cannot_be_built():
    """A joint EI/l - T l/12 has no stiffness left of ten links of a taut strip; asked for by name it is refused."""
    given = {
        "name": "taut",
        "title": "Taut",
        "beam": {"length": 1.4, "bending_stiffness": 0.017, "mass_per_length": 0.05, "tension": 90.0},
        "convergence": {"modes": [2], "counts": [10, 49]},
    }
    plan = plan_scene(checked(given, scene_type()))
    assert [one.count for one in plan.solves if ("joints", "tensioned") in one.settings] == [49]
    assert plan.problems == ()
    given["convergence"]["joints"] = ["series", "tensioned"]
    (problem,) = plan_scene(checked(given, scene_type())).problems
    assert "leaves no stiffness in a joint of 10 segments" in problem.why
