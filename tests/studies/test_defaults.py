"""What a scene gets that says little: a map about its own drive, a start that converges, a study left out with reason."""

import numpy as np
import pytest

from verify.motion.starting import soft_start
from verify.run.plan import plan_scene
from verify.run.runner import run_scene
from verify.scenes.checked import checked
from verify.scenes.scene import scene_type

STRIP = {"length": 0.41, "width": 0.013, "thickness": 0.0011, "youngs_modulus": 113e9, "density": 4470.0}
DRIVE = {"frequency_hz": 1730.0, "force": [{"position": 0.011}, {"position": 0.4, "phase_deg": 90.0}]}


def scene(**tables):
    return checked({"name": "own", "beam": STRIP} | tables, scene_type())


def test_a_map_spans_a_tenth_below_and_above_the_scenes_own_drive():
    found = run_scene(scene(drive=DRIVE, wave={"counts": [30, 60, 90], "count": 30})).found["wave"]
    frequencies = next(axis.values for axis in found.map.axes if axis.name == "frequency_hz")
    assert frequencies[0] == pytest.approx(1557.0, rel=1e-12)
    assert frequencies[-1] == pytest.approx(1903.0, rel=1e-12)
    assert len(frequencies) == 121
    assert np.isfinite(found.map.values).mean() > 0.9


def test_an_axis_alone_spans_the_drive_too():
    from verify.studies.wave.design_map import parse_axis

    axis = parse_axis("frequency_hz", 1730.0)
    assert (axis.values[0], axis.values[-1], len(axis.values)) == (pytest.approx(1557.0), pytest.approx(1903.0), 241)


@pytest.mark.parametrize(
    ("start", "given", "periods"), [("rest", None, 2.0), ("rest", 0.0, 0.0), ("rest", 3.5, 3.5), ("steady", None, 0.0)]
)
def test_a_beam_at_rest_is_started_softly_unless_somebody_says_otherwise(start, given, periods):
    assert soft_start(start, given) == periods
    asked = {"start": start} | ({} if given is None else {"soft_start_periods": given})
    slider = {"mass": 2e-4, "mu": 0.2}
    assert scene(drive=DRIVE, slider=slider, motion=asked).motion.soft_start == periods


def test_the_default_start_is_the_one_that_converges():
    """Displacement of a slider at N, 2 N, 4 N: differences fall evenly after a soft start, under a step they turn."""
    from verify.simulate import simulate
    from verify.slider import Slider

    loaded = scene(drive=DRIVE)
    slider = Slider(mass=2e-4, mu=0.2, slope=100.0, coupling="one-way")

    def falls(periods):
        asked = {"slider": slider, "samples": 2, "soft_start_periods": periods}
        ends = [
            simulate(loaded.beam, loaded.forces, 1730.0, 3e-3, count=n, **asked).displacement for n in (40, 80, 160)
        ]
        return (ends[1] - ends[0]) / (ends[2] - ends[1])

    assert 8.0 < falls(soft_start("rest", None)) < 17.0
    assert falls(0.0) < 0.0


def test_a_material_of_more_than_one_section_is_not_turned_and_plan_says_why():
    stepped = checked(
        {
            "name": "s",
            "beam": STRIP | {"section": [{"length": 0.2}, {"length": 0.21, "thickness": 0.002}]},
            "sensitivity": {"mode": 2},
        },
        scene_type(),
    )
    why = "a beam of 2 sections has more than one modulus and density to turn"
    assert any(why in one.why for one in plan_scene(stepped).skipped)
    assert "sensitivity" not in run_scene(stepped).found
    plain = checked(
        {
            "name": "p",
            "beam": {"length": 0.3, "bending_stiffness": 2.0, "mass_per_length": 0.1},
            "sensitivity": {"mode": 2},
        },
        scene_type(),
    )
    assert any("given by its stiffness and mass" in one.why for one in plan_scene(plain).skipped)
    assert "sensitivity" not in run_scene(plain).found


def test_the_material_of_a_beam_with_a_body_is_turned_by_the_exact_equation():
    from verify.exact.modes import exact_frequency_hz

    loaded = scene(sensitivity={"mode": 2})
    with_body = checked(
        {"name": "b", "beam": STRIP | {"mass": [{"position": 0.13, "mass": 0.01}]}, "sensitivity": {"mode": 2}},
        scene_type(),
    )
    found = run_scene(with_body).found["sensitivity"]
    middle = found.frequencies_hz[2][12]
    assert middle == pytest.approx(exact_frequency_hz(with_body.beam, 2), rel=1e-12)
    assert middle < exact_frequency_hz(loaded.beam, 2)
    low, high = found.frequencies_hz[2][0], found.frequencies_hz[2][-1]
    assert (high / low) ** 2 == pytest.approx(1.03 / 0.97, rel=1e-9)
