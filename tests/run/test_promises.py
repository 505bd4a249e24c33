"""A plan promises no gate that the run then refuses, and warns of none that it evaluates: beams of every kind."""

from hypothesis import HealthCheck, assume, given, settings
from hypothesis import strategies as st

from verify.errors import InputError
from verify.options import ATTACHMENTS, JOINTS, SUPPORTS, THEORIES, WALLS
from verify.run.gates import judge
from verify.run.plan import plan_scene
from verify.run.runner import workbench_for
from verify.scenes.checked import checked
from verify.scenes.scene import scene_type

LENGTH, EI, LINE = 0.73, 3.55, 0.32
SHAPED = {"width": 0.031, "thickness": 0.0023, "youngs_modulus": 113e9, "density": 4470.0}
BARE = {"bending_stiffness": EI, "mass_per_length": LINE}
SECTIONS = (
    SHAPED,
    BARE,
    {**BARE, "rotary_inertia": 1.9e-7},
    {**BARE, "rotary_inertia": 1.9e-7, "shear_stiffness": 2.3e5},
)
PLACES = st.sampled_from([0.0, 0.211, 0.37, LENGTH])
ONLY_SOLVED = (
    "changes sign between",
    "does not reach it up to",
    "has no order there",
    "no settled order between",
    "nodes between the ends",
    "is rounding (floor",
    "at rest at every node",
)
"""Reasons that no plan can know: they are in the figures."""


def several(kind):
    return st.lists(kind, max_size=2)


BEAMS = st.fixed_dictionaries(
    {
        "section": st.sampled_from(SECTIONS),
        "supports": st.tuples(st.sampled_from(SUPPORTS), st.sampled_from(SUPPORTS)),
        "tension": st.sampled_from([0.0, 0.0, 41.0, -1.3, -30.0, -70.0, -900.0]),
        "foundation": st.sampled_from([0.0, 1900.0]),
        "mass": several(
            st.fixed_dictionaries(
                {"position": PLACES, "mass": st.just(0.05), "rotary_inertia": st.sampled_from([0, 3e-5])}
            )
        ),
        "spring": several(
            st.fixed_dictionaries(
                {"position": PLACES, "stiffness": st.just(900.0), "rotational": st.sampled_from([0.0, 2.3])}
            )
        ),
        "steps": st.booleans(),
    }
)
SETTINGS = {
    "wall": st.sampled_from(WALLS),
    "joints": st.sampled_from(JOINTS),
    "attachment": st.sampled_from(ATTACHMENTS),
    "grading": st.sampled_from([1.0, 1.3]),
}
MODES = {"mode": st.integers(1, 9), "theory": st.sampled_from(THEORIES)}
COUNT = st.integers(1, 14)


def asked(quantity, model, **more):
    return st.tuples(st.just(quantity), st.fixed_dictionaries({"model": st.just(model), **MODES, **more}))


def without_model(quantity, **more):
    return st.tuples(st.just(quantity), st.fixed_dictionaries(more))


GATES = st.lists(
    st.one_of(
        asked("mode.frequency", "analytic"),
        asked("mode.node_position", "analytic"),
        *(
            asked(quantity, model, count=COUNT, **more)
            for quantity in (
                "mode.frequency",
                "mode.frequency_error",
                "mode.shape_error",
                "mode.curvature_error",
                "mode.law_ratio",
            )
            for model, more in (("segment", SETTINGS), ("fem", {"grading": SETTINGS["grading"]}))
        ),
        asked("mode.order", "segment", counts=st.just([7, 11, 17]), **SETTINGS),
        asked("mode.order", "fem", counts=st.just([3, 5, 8])),
        without_model("mode.bracket", count=COUNT, **MODES, **SETTINGS),
        without_model("mode.stiffness_difference", count=COUNT),
        without_model("mode.stock_difference", mode=MODES["mode"], count=COUNT),
    ),
    min_size=5,
    max_size=5,
)


def scene_of(beam, gates):
    """The scene, or None for a beam or gates that no scene may have."""
    beam = dict(beam)
    steps, section = beam.pop("steps"), beam.pop("section")
    if steps:
        beam["section"] = [
            {"length": 0.31},
            {"length": LENGTH - 0.31, **({"thickness": 0.0031} if section is SHAPED else {})},
        ]
    stated = [
        {"id": f"g{i}", "quantity": quantity, "arguments": arguments, "at_least": 0.0, "why": "it is asked"}
        for i, (quantity, arguments) in enumerate(gates)
    ]
    try:
        return checked({"name": "any", "beam": {"length": LENGTH, **section, **beam}, "gate": stated}, scene_type())
    except InputError:
        return None


@settings(max_examples=150, deadline=None, suppress_health_check=[HealthCheck.filter_too_much])
@given(BEAMS, GATES)
def test_what_a_plan_calls_a_problem_is_what_the_run_cannot_evaluate(beam, gates):
    scene = scene_of(beam, gates)
    assume(scene is not None)
    problems = {problem.who.removeprefix("gate "): problem.why for problem in plan_scene(scene).problems}
    bench = workbench_for(scene, gates_only=True)
    for gate in scene.gate:
        reason = judge(gate, scene, bench).reason
        refused = reason.startswith("cannot be evaluated: ")
        assert "the suite itself fails" not in reason, gate
        if not any(words in reason for words in ONLY_SOLVED):
            assert refused == (gate.id in problems), (gate.quantity, gate.arguments, reason, problems.get(gate.id))


def test_elements_refuse_a_mesh_that_buckles_before_it_is_solved():
    """Pinned ends, EI pi^2/L^2 = 65.75 N: two elements buckle at 66.2 N, the exact beam before them."""
    pressed = dict.fromkeys(("mass", "spring"), ()) | {"supports": ["pinned", "pinned"], "foundation": 0.0}
    for tension, sound in ((-66.0, True), (-66.5, False)):
        beam = {**pressed, "section": BARE, "steps": False, "tension": tension}
        scene = scene_of(beam, [("mode.stiffness_difference", {"count": 2})])
        assert scene is not None
        assert (not plan_scene(scene).problems) == sound
