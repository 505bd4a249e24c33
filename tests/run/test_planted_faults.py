"""Every gate of a packaged scene is green, and red when the fault it exists for is planted."""

from itertools import chain

import faults.everything  # noqa: F401
import pytest
from faults import anything, contact, driven, felt, followed, modes, motion, motor, stress, waves
from faults import chain as of_the_chain

from verify.quantities.catalogue import QUANTITIES
from verify.run.gates import judge
from verify.run.runner import workbench_for
from verify.scenes.scene import load_scene, packaged_scenes

AT_A_PLACE = ("wave.deflection", "wave.slope", "wave.curvature", "wave.lumped_swr")
FAMILIES = (
    modes.FAULTS,
    waves.FAULTS,
    of_the_chain.FAULTS,
    motion.FAULTS,
    driven.FAULTS,
    stress.FAULTS,
    anything.FAULTS,
    felt.FAULTS,
    followed.FAULTS,
    contact.FAULTS,
    motor.FAULTS,
)
FAULTS = {
    scene: dict(chain.from_iterable(family.get(scene, {}).items() for family in FAMILIES))
    for scene in packaged_scenes()
}
PLANTED = [(scene, fault) for scene, faults in FAULTS.items() for fault in faults]


def failed_gates(scene, among):
    bench = workbench_for(scene, gates_only=True)
    return {gate.id for gate in scene.gate if gate.id in among and not judge(gate, scene, bench).passed}


def test_the_papers_gates_are_green():
    scene = load_scene("paper")
    assert failed_gates(scene, {gate.id for gate in scene.gate}) == set()


@pytest.mark.parametrize(("scene", "fault"), PLANTED, ids=lambda part: getattr(part, "__name__", part))
def test_a_planted_fault_turns_its_gates_red(scene, fault, monkeypatch):
    fault(monkeypatch)
    expected = FAULTS[scene][fault]
    assert failed_gates(load_scene(scene), expected) == expected


@pytest.mark.parametrize("scene", packaged_scenes())
def test_every_gate_of_a_scene_has_a_fault_that_turns_it_red(scene):
    assert {gate.id for gate in load_scene(scene).gate} == set().union(*FAULTS[scene].values())


def test_no_quantity_is_without_a_gate_in_a_packaged_scene():
    gates = [gate for name in packaged_scenes() for gate in load_scene(name).gate]
    assert {gate.quantity for gate in gates} == set(QUANTITIES)


def test_every_wave_gate_says_its_damping_and_its_window():
    gates = [gate for name in packaged_scenes() for gate in load_scene(name).gate if gate.quantity.startswith("wave.")]
    assert len(gates) >= 26
    for gate in gates:
        given = gate.arguments
        dampings = [
            f"{word} {given[name]:{form}}"
            for word, name, form in (
                ("loss factor", "loss_factor", "g"),
                ("ratio", "modal_damping", "g"),
                ("dashpots", "joint_dashpot", ".0e"),
            )
            if given.get(name)
        ]
        damping = ", ".join(dampings).replace("e-0", "e-") + " N m s" * ("joint_dashpot" in given) + ", "
        at_a_point = gate.quantity in (*AT_A_PLACE, "wave.receptance") or given.get("of") == "deflection"
        at_a_point |= gate.quantity == "wave.axis_ratio" and "x" in given
        window = "[{} m, {} m]".format(*given["window"]) if "window" in given else "[L/4, 3L/4]"
        x = given.get("x", 0.25)
        place = ("at L/2" if x == 0.25 else f"at {x} m") if at_a_point else window
        if gate.quantity.startswith("wave.absorber") and "model" not in given:
            place = "half-infinite"
        assert gate.why.lower().startswith(((damping if dampings else "undamped, ") + place).lower()), gate.id
