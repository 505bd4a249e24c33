"""What a plan advises runs: the section that it names is accepted on the scene as it stands."""

import re
import sys
from pathlib import Path

import pytest
from msgspec.structs import replace

from verify import load_scene
from verify.errors import InputError
from verify.run.plan import plan_scene
from verify.scenes.checked import checked
from verify.scenes.scene import MotionAsk, packaged_scenes, scene_type
from verify.scenes.sections import SECTIONS

sys.path.insert(0, str(Path(__file__).parent))
from test_plan_of_drawn_scenes import scenes

STUDIES = tuple(name for name in SECTIONS.built_in if SECTIONS[name].section is not None)


def silent(scene):
    """A scene without gates, claims and studies: what exists alone, of which a plan advises what could be asked."""
    return replace(scene, gate=(), claim=(), motion=None, **dict.fromkeys(STUDIES))


def advised(scene):
    """Sections that a plan says to add."""
    found = r"add \[(\w+)\](?: with duration = ([\d.e+-]+))?"
    return {pair for one in plan_scene(scene).skipped for pair in re.findall(found, one.why)}


def refusals(scene):
    """Of everything that its plan advises, what is then refused."""
    for name, duration in advised(scene):
        asked = (
            MotionAsk(**({"duration": float(duration)} if duration else {}))
            if name == "motion"
            else SECTIONS[name].section()
        )
        try:
            there = replace(scene, **{name: asked})
        except InputError as error:
            yield f"{scene.name}: {error}"
            continue
        for problem in plan_scene(there).problems:
            yield f"{scene.name}: {problem.why}"


@pytest.mark.parametrize("name", packaged_scenes())
def test_everything_that_a_plan_of_a_packaged_scene_advises_is_accepted(name):
    assert not [*refusals(silent(load_scene(name)))]


def test_everything_that_plans_of_drawn_scenes_advise_is_accepted():
    told = [(seed, scene) for seed, scene in ((n, silent(one)) for n, one in scenes(0, 300)) if scene.slider]
    assert sum(bool(advised(scene)) for _, scene in told) > 10
    assert not [f"{seed}: {why}" for seed, scene in told for why in refusals(scene)]


BEAM = {"length": 0.43, "width": 0.017, "thickness": 0.0013, "youngs_modulus": 71e9, "density": 2710.0}
FORCE = {"position": 0.031, "amplitude": 2.0}
DEVICE = {"position": 0.391, "dashpot": 3.0}


@pytest.mark.parametrize(
    ("slider", "forces", "says"),
    [
        ({"contact": {"stiffness": 4e4}, "foot": [{}]}, 1, "add [methods]"),
        (
            {"contact": {"stiffness": 4e4}, "foot": [{}]},
            2,
            "[motor] would be refused, motor: this study knows no drive",
        ),
        ({}, 2, "[motion] would be refused, motion: a beam in time knows no drive.device"),
    ],
)
def test_beside_a_device_a_study_that_knows_it_is_advised_or_none(slider, forces, says):
    drive = {"frequency_hz": 900.0, "device": [DEVICE], "force": [FORCE, FORCE | {"position": 0.2}][:forces]}
    own = {"mass": 0.02, "mu": 0.2, "law": "coulomb", "preload": 0.4} | slider
    scene = checked({"name": "s", "title": "t", "beam": BEAM, "drive": drive, "slider": own}, scene_type())
    (why,) = (one.why for one in plan_scene(scene).skipped if one.what == "slider")
    assert says in why
