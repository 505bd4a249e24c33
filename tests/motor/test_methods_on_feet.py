"""Both ways of driving under a slider that may leave the beam: one actuator and an absorber, or two forces."""

import pytest
from msgspec.structs import replace

from verify.judge.workbench import Workbench
from verify.scenes.scene import load_scene
from verify.slider import Foot
from verify.studies.methods_figures import methods_study

ON_FEET = (
    "methods.steps=3",
    "methods.duration=0.05",
    "slider.law=coulomb",
    "slider.mass=0.02",
    "slider.preload=0.6",
    "slider.normal=held",
    "slider.contact.stiffness=1e6",
    "slider.contact.damping=30",
)


@pytest.fixture(scope="module")
def rides():
    """Speeds of a foot of one wavelength on springs, 200 Hz below the drive, at it and above."""
    scene = load_scene("absorbing-end", ON_FEET)
    scene = replace(scene, slider=replace(scene.slider, foot=(Foot(length=0.0465, points=31),)))
    found = methods_study(scene, Workbench(scene.beam), scene.methods)
    assert "free to leave the surface, one-way, pressed on with 0.7962 N, mu = 0.2, Coulomb" in found.slider
    return {round(ride.off_hz): ride for ride in found.rides}


def test_a_slider_that_may_leave_is_driven_a_hundred_times_faster_than_one_that_never_does(rides):
    """Crests carry it: of first order in the wave, where what never leaves drifts in second order."""
    scene = load_scene("absorbing-end", ("methods.steps=3",))
    held = {round(ride.off_hz): ride for ride in methods_study(scene, Workbench(scene.beam), scene.methods).rides}
    for way in ("device", "forces"):
        assert getattr(rides[0], way) / getattr(held[0], way) > 100.0


def test_at_the_drive_both_ways_move_it_alike_and_off_it_the_absorber_alone_keeps_its_way(rides):
    assert rides[0].device == pytest.approx(rides[0].forces, rel=0.05)
    assert rides[0].device < -1e-3
    for off in (-200, 200):
        assert rides[off].device == pytest.approx(rides[0].device, rel=0.03)
    assert rides[200].forces > 1e-3
