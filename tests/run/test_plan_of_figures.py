"""What a plan knows of a figure that cannot be: places off the beam, sizes through which no order is observed."""

import pytest

from verify.report.terminal import print_plan
from verify.run.gates import judge
from verify.run.plan import plan_scene
from verify.run.runner import workbench_for
from verify.scenes.checked import checked
from verify.scenes.scene import scene_type

BEAM = {"length": 0.7, "width": 0.03, "thickness": 0.002, "youngs_modulus": 7e10, "density": 2700.0}
DRIVE = {"frequency_hz": 431.0, "force": [{"position": 0.11, "amplitude": 1.3}]}
SLIDER = {"mu": 0.2, "mass": 1e-3, "slope": 300.0}


def scene_of(*gates):
    """Gates of (quantity, arguments) on a driven pinned strip with a slider."""
    entries = [
        {"id": f"g{i}", "quantity": quantity, "arguments": arguments, "expect": 4.0, "within": 0.5, "why": "so"}
        for i, (quantity, arguments) in enumerate(gates)
    ]
    data = {
        "name": "planned",
        "beam": BEAM | {"supports": ["pinned", "pinned"], "loss_factor": 0.013},
        "drive": DRIVE,
        "slider": SLIDER,
        "motion": {"duration": 7e-4, "soft_start_periods": 0.1},
        "gate": entries,
    }
    return checked(data, scene_type(data))


OFF = "lies off the beam: give a place between 0 and 0.7 m"
NO_SIZES = "an observed order needs three or more different sizes"


@pytest.mark.parametrize(
    ("quantity", "arguments", "why"),
    [
        ("mode.order", {"model": "fem", "mode": 2, "counts": [20, 40]}, NO_SIZES),
        ("mode.shape_order", {"model": "segment", "mode": 2, "counts": [20, 40, 20]}, NO_SIZES),
        ("wave.order", {"model": "fem", "counts": [20, 40], "of": "deflection"}, NO_SIZES),
        (
            "slider.order",
            {"model": "segment", "count": 12, "steps": [1e-5, 2e-5]},
            f"steps = [1e-05, 2e-05]: {NO_SIZES}",
        ),
        ("mode.deflection", {"model": "fem", "mode": 1, "count": 9, "x": 0.8}, f"x = 0.8 {OFF}"),
        ("mode.slope", {"model": "analytic", "mode": 1, "x": -0.01}, f"x = -0.01 {OFF}"),
        ("wave.deflection", {"x": 0.71}, f"x = 0.71 {OFF}"),
        ("wave.receptance", {"position": 0.9, "x": 0.2}, f"position = 0.9 {OFF}"),
        ("motion.deflection", {"count": 9, "x": 0.8}, f"x = 0.8 {OFF}"),
        ("slider.displacement", {"count": 9, "slider_position": 0.75}, f"slider_position = 0.75 {OFF}"),
        ("chain.transient_deflection", {"segments": 9, "time": 3e-4, "x": 0.9}, f"x = 0.9 {OFF}"),
    ],
)
def test_a_plan_knows_of_a_place_off_the_beam_and_of_too_few_sizes(quantity, arguments, why):
    scene = scene_of((quantity, arguments))
    (problem,) = plan_scene(scene).problems
    assert problem.who == "gate g0"
    assert why in problem.why
    gate = judge(scene.gate[0], scene, workbench_for(scene, gates_only=True))
    assert why in gate.reason


def test_the_end_of_a_beam_is_on_it_to_rounding():
    inside = [("wave.deflection", {"x": x}) for x in (0.0, 0.7, 0.7 * (1.0 + 1e-14))]
    assert plan_scene(scene_of(*inside)).problems == ()


def test_a_plan_s_first_line_says_that_something_cannot_run(capsys):
    sizes = {"model": "fem", "mode": 2, "counts": [20, 40]}
    print_plan(plan_scene(scene_of(("mode.order", sizes), ("mode.frequency", {"model": "fem", "mode": 2, "count": 9}))))
    assert capsys.readouterr().out.splitlines()[0] == "planned will run, but for 1 asked for that cannot"
    print_plan(plan_scene(scene_of(("mode.order", sizes | {"counts": [20, 40, 80]}))))
    assert capsys.readouterr().out.splitlines()[0] == "planned will run"
