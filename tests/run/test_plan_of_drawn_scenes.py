"""What a plan says of a scene that nobody wrote is what its run does: solves, motions, fields, and what is refused."""

import sys
from pathlib import Path

import pytest

from verify.errors import InputError
from verify.run.plan import plan_scene
from verify.run.runner import run_scene
from verify.scenes.checked import checked
from verify.scenes.scene import scene_type

sys.path.insert(0, str(Path(__file__).parents[1] / "robust"))

from drawn import Draw
from drawn_scenes import Drawn

SEARCHED = "mode.count_needed"
"""Solves sizes that nobody knows beforehand."""
TOLD_BEFOREHAND = (
    "time is missing", "has no slider", "has no drive", "the forces grow over", "leaves the span between two forces",
    "shorter than half a wavelength", "takes imposed forces", "lies beyond, give count", "undamped resonance of mode",
    "no wave runs below", "position and phase_deg are for two forces", "a phase between two forces", "lies off the beam",
    "an observed order needs three",
)  # fmt: skip
"""Refusals of figures of a driven beam that a plan has to know; there are others that stand in a field alone."""
DRIVEN = ("wave.", "slider.displacement", "slider.mean", "slider.deflection", "motion.", "chain.slider_")


def scenes(first, last):
    """Drawn scenes that are scenes, with their numbers."""
    for seed in range(first, last):
        draw = Draw(seed)
        draw.strangeness = 0
        tables = Drawn(draw).tables
        tables.pop("readings", None)  # whose runs are counted by tests of their own
        try:
            yield seed, checked(tables, scene_type(tables))
        except InputError:
            continue


def compared(scene):
    """What a run did otherwise than its plan said. A study that a run refuses leaves nothing to compare."""
    plan = plan_scene(scene)
    known = {problem.who for problem in plan.problems}
    try:
        run = run_scene(scene)
    except InputError:
        return []
    wrong = [*of_solves(scene, plan, run)]
    for gate in run.gates:
        refused, warned = gate.reason.startswith("cannot be evaluated: "), f"gate {gate.id}" in known
        asked = f"{gate.quantity} {gate.arguments}: {gate.reason}"
        if warned and not refused:
            wrong.append(f"{asked}: the plan warns of what is evaluated")
        silent = refused and not warned and gate.quantity.startswith(DRIVEN)
        if silent and any(words in gate.reason for words in TOLD_BEFOREHAND):
            wrong.append(f"{asked}: the plan is silent")
    return wrong


def of_solves(scene, plan, run):
    """What was solved, once, of what was planned."""
    planned = {(one.model, one.count, one.settings) for one in plan.solves}
    done = [(one.model, one.count, one.settings) for one in run.solves]
    if SEARCHED not in {one.quantity for one in (*scene.gate, *scene.claim)}:
        if set(done) - planned:
            yield f"solved unplanned: {set(done) - planned}"
        if len(done) != len(set(done)):
            yield f"solved twice: {done}"
    if run.n_fields and not plan.harmonic:
        yield f"{run.n_fields} fields that no plan lists"
    if run.n_motions and not plan.stepped:
        yield f"{run.n_motions} motions that no plan lists"
    if sum(found.motions() for found in run.found.values()) != plan.motions:
        yield f"{plan.motions} motions of studies are planned"


def otherwise(first, last):
    found = {seed: compared(scene) for seed, scene in scenes(first, last)}
    assert len(found) > 0.15 * (last - first)
    return {seed: wrong for seed, wrong in found.items() if wrong}


@pytest.mark.parametrize("row", range(4))
def test_what_a_plan_says_of_a_drawn_scene_is_what_its_run_does(row):
    assert otherwise(20 * row, 20 * (row + 1)) == {}


@pytest.mark.hostile
@pytest.mark.parametrize("row", range(20))
def test_what_plans_say_of_a_thousand_drawn_scenes_is_what_their_runs_do(row):
    assert otherwise(1000 + 50 * row, 1050 + 50 * row) == {}
