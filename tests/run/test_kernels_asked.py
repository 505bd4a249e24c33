"""What a plan says is compiled, against what really runs: of every quantity, and of every packaged scene.

Quantities in a process of its own, in which a kernel is asked for when it is first called; what ran is forgotten in between.
"""

import json
import os
import subprocess
import sys
from pathlib import Path

import pytest
from msgspec.structs import replace
from packaged import names, ran

from verify.run.asks import Ask, studies_in_turn
from verify.run.kernels_asked import ready_first
from verify.run.runner import run_scene
from verify.scenes.scene import load_scene, packaged_scenes

TESTS = Path(__file__).parent.parent
START = """
import json
from packaged import forget, listening, named
ran = []
listening(ran).start()
def told(planned):
    return {"ran": ran[:], "planned": [named(kernel, map(kernel.typeof_pyval, given)) for kernel, given in planned]}
"""
OF_QUANTITIES = """
from quantities.test_every_input import CASES, asked_of, figure, checked, scene_type
from verify.quantities.catalogue import QUANTITIES, arguments_of
found = {}
for name, cases in CASES.items():
    for i, case in enumerate(cases if QUANTITIES[name].work in ("in time", "equilibrium") else ()):
        forget(), ran.clear()
        asked = asked_of(name, case)
        figure(asked)
        given = {key: value for key, value in asked.arguments.items() if value is not None}
        arguments, scene = arguments_of(QUANTITIES[name], given), checked(asked.scene, scene_type())
        found[f"{name} {i}"] = told(QUANTITIES[name].kernels(arguments, scene))
print(json.dumps(found))
"""


def compared(code, *given):
    """(what ran, what was planned) by name."""
    path = os.pathsep.join([str(TESTS), *sys.path])
    command = [sys.executable, "-c", START + code, *given]
    surroundings = {**os.environ, "PYTHONPATH": path, "VERIFY_JOBS": "1"}
    done = subprocess.run(command, capture_output=True, text=True, env=surroundings, check=False)
    assert done.returncode == 0, done.stderr
    found = json.loads(done.stdout.splitlines()[-1])
    return {name: tuple({tuple(k) for k in one[kind]} for kind in ("ran", "planned")) for name, one in found.items()}


def test_every_quantity_says_which_kernels_it_runs():
    """Whether a beam feels its slider only a size may tell: then both loops are planned, and one of them runs."""
    found = compared(OF_QUANTITIES)
    assert len(found) > 60
    for name, (called, planned) in found.items():
        assert called <= planned, name
        assert names(planned) == names(called), name
    assert sum(bool(called) for called, _ in found.values()) > 45


@pytest.mark.parametrize("scene", packaged_scenes())
def test_a_scene_plans_what_it_runs(scene):
    called, planned = set(ran(scene).called), set(ran(scene).planned)
    assert called <= planned
    assert names(planned) == names(called)


def test_scenes_with_time_in_them_call_kernels_and_others_none():
    """Else nothing would be compared above."""
    assert {name for name, _ in ran("moving-load").called} == {"motion.kernels.slide"}
    assert ran("paper").called == ran("thick-bar").called == []


def test_gates_that_need_fewest_kernels_run_first_and_stand_where_the_scene_has_them(monkeypatch):
    monkeypatch.setenv("VERIFY_JOBS", "1")  # nobody compiles ahead
    scene, heard = load_scene("paper-slider"), []
    found = run_scene(replace(scene, claim=(), readings=None), heard.append)
    assert [gate.id for gate in found.gates] == [gate.id for gate in scene.gate]
    order = [step.removeprefix("gate ") for step in heard if step.startswith("gate ")]
    assert sorted(order) == sorted(gate.id for gate in scene.gate)
    assert order.index("beam-segments") < order.index("free-decay") < order.index("slider-segments")
    assert max(map(order.index, ("slider-segments", "creep"))) < order.index("chain-slider")
    assert [gate.id for gate in found.gates].index("chain-slider") < [gate.id for gate in found.gates].index(
        "beam-segments"
    )


class Slow:
    """Others compile what some asks need; one ends whenever all that are left wait."""

    def __init__(self, begun):
        self.begun, self.seen = begun, []

    def first_ready(self, waiting, needed):
        self.seen.append(list(waiting))
        ready = [one for one in waiting if not set(needed(one)) & set(self.begun)]
        if not ready:
            self.begun.pop(0)
            return self.first_ready(waiting, needed)
        return ready[0]


def test_what_waits_for_a_kernel_comes_later_and_studies_keep_their_order():
    def ask(kind, name, *kernels):
        return Ask(kind=kind, name=name, kernels=lambda: [(kernel, ()) for kernel in kernels])

    asks = [
        ask("gate", "both", "march", "slide"),
        ask("gate", "slides", "slide"),
        ask("gate", "free"),
        ask("study", "motion", "slide"),
        ask("study", "wave"),
    ]
    ahead = Slow([("slide", ()), ("march", ())])
    order = [asks[number].name for number in ready_first(asks, ahead)]
    assert order == ["free", "slides", "motion", "wave", "both"]
    assert all(4 not in waiting or 3 not in waiting for waiting in ahead.seen)
    assert [asks[number].name for number in ready_first(asks, Slow([]))] == ["free", "slides", "both", "motion", "wave"]


def test_a_study_of_claims_names_the_kernels_of_claims_that_stand_alone():
    """Those about the run of its slider's study run nothing more."""
    scene = load_scene("paper-slider")
    assert not list(of_claims(scene).kernels())
    elsewhere = replace(scene.claim[0], arguments={"count": 24, "model": "segment"})
    assert {kernel.__name__ for kernel, _ in of_claims(replace(scene, claim=(elsewhere,))).kernels()} == {"slide"}


def of_claims(scene):
    return next(ask for ask in studies_in_turn(scene) if ask.name == "claims")


def test_solves_are_told_in_an_order_of_their_own():
    found = run_scene("thick-bar").solves
    keys = [(one.model, one.count, repr(one.settings)) for one in found]
    assert len(keys) > 4
    assert keys == sorted(keys)
