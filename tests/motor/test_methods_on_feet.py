"""Both ways of driving under a slider that may leave the beam: one actuator and an absorber, or two forces."""

import pytest
from msgspec.structs import replace

from verify.judge.workbench import Workbench
from verify.scenes.scene import load_scene
from verify.slider import Slider
from verify.studies.methods.figures import methods_study


def rides_of(scene):
    """Speeds by hertz off the drive, and how the slider was run."""
    found = methods_study(scene, Workbench(scene.beam), scene.methods)
    return {round(ride.off_hz): ride for ride in found.rides}, found.slider


@pytest.fixture(scope="module")
def scene():
    return load_scene("absorbing-end", ("methods.steps=3",))


@pytest.fixture(scope="module")
def on_feet(scene):
    """A foot of one wavelength on springs, 200 Hz below the drive, at it and above."""
    rides, words = rides_of(scene)
    assert words.startswith("free to leave the surface, one-way, pressed on with 0.7962 N, mu = 0.2, Coulomb")
    return rides


def test_a_slider_that_may_leave_is_driven_a_hundred_times_faster_than_one_that_never_does(scene, on_feet):
    """Crests carry it: of first order in the wave, where what never leaves drifts in second order."""
    held = Slider(mass=1.0193679918450561e-3, mu=0.2, slope=1e4, normal="massless")
    rides, words = rides_of(replace(scene, slider=held))
    assert words.startswith("always on the surface, one-way, tangential kinematics, mu = 0.2, K = 10000 s/m")
    for way in ("device", "forces"):
        assert getattr(on_feet[0], way) / getattr(rides[0], way) > 100.0


def test_at_the_drive_both_ways_move_it_alike_and_off_it_the_absorber_alone_keeps_its_way(on_feet):
    assert on_feet[0].device == pytest.approx(on_feet[0].forces, rel=0.03)
    assert on_feet[0].device < -1e-3
    for off in (-200, 200):
        assert on_feet[off].device == pytest.approx(on_feet[0].device, rel=0.03)
    assert on_feet[200].forces > 1e-3
