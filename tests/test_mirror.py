"""The mirror image of a beam moves as the mirror image of its motion: chains, sliders, feet."""

from typing import get_args

import numpy as np
import pytest
from hypothesis import assume, example, given, settings
from hypothesis import strategies as st
from msgspec.structs import replace

from verify import Beam, Contact, Excitation, Foot, Keep, PointForce, PointMass, SegmentModel, Slider, simulate
from verify.problem.supports import SUPPORTS
from verify.settings import WALLS, Attachment, Load

LENGTH = 0.83
X = np.array([0.0, 0.011, 0.12, 0.2931, 0.37, 0.6102, 0.81, LENGTH])


def plain(thickness=0.019, **more):
    sizes = {"length": LENGTH, "width": 0.027, "thickness": thickness, "youngs_modulus": 193e9, "density": 7900.0}
    return Beam(**sizes, **{"supports": ("clamped", "free"), "loss_factor": 0.013} | more)


def other_side(forces):
    return [replace(force, position=LENGTH - force.position) for force in forces]


FORCES = [PointForce(position=0.11, amplitude=1.4), PointForce(position=0.5302, amplitude=0.7, phase_deg=70.0)]


def compared(one, other):
    """Values along the last axis, of the other side the last first."""
    assert np.isfinite(one).all()
    assert abs(one - other[..., ::-1]).max() <= 1e-8 * abs(one).max()


@settings(max_examples=60, deadline=None)
@given(
    supports=st.tuples(*[st.sampled_from(SUPPORTS)] * 2),
    places=st.lists(st.integers(0, 46), min_size=1, max_size=2, unique=True),
    shift=st.sampled_from([0.1, 0.43, 0.5, 1.0]),
    wall=st.sampled_from([name for name, rule in WALLS.items() if not (rule.first or rule.fault)]),
    joints=st.sampled_from(["series", "printed"]),
    load=st.sampled_from(get_args(get_args(Load)[0])),
    attachment=st.sampled_from(get_args(get_args(Attachment)[0])),
)
# exactly a link apart, the corrected weights of two bodies have no nearest direction
@example(("clamped", "free"), [46, 44], 0.43, "gregory", "series", "lever", "reciprocal")
def test_whatever_the_chain_makes_of_walls_joints_loads_and_bodies_it_makes_at_both_ends(
    supports, places, shift, wall, joints, load, attachment
):
    """Bodies and forces a link apart and more, also beside an end: of closer ones rounding of the weights decides."""
    assume(len(places) == 1 or abs(places[0] - places[1]) > 1)
    at = [LENGTH * (place + shift) / 48.0 for place in places]
    # at and about the middle both a body and a pair are laid on the links left of them
    assume(min(abs(x - 0.5 * LENGTH) for x in [*at, np.mean(at)]) > 1e-6)
    bodies = tuple(PointMass(position=x, mass=0.2 + 0.1 * i) for i, x in enumerate(at))
    beam = plain(supports=supports, mass=bodies)
    forces = [PointForce(position=x, phase_deg=20.0 * i) for i, x in enumerate(at)]
    chosen = {"wall": wall, "joints": joints, "load": load, "attachment": attachment}
    one = SegmentModel(beam, 24, **chosen).harmonic(forces, 271.0)
    other = SegmentModel(beam.mirrored(), 24, **chosen).harmonic(other_side(forces), 271.0)
    compared(one.deflection(X), other.deflection(LENGTH - X[::-1]))


@pytest.mark.parametrize("model", ["analytic", "fem", "segment"])
@pytest.mark.parametrize(
    "more",
    [
        {"slope": 70.0},
        {"slope": 70.0, "kinematics": "following", "coupling": "one-way"},
        {"law": "coulomb", "mu_static": 0.4, "coupling": "one-way"},
    ],
)
def test_a_slider_is_carried_the_other_way(model, more):
    size = {"modes": 40} if model == "analytic" else {"count": 24}
    beam, pushes = plain(thickness=0.0019), [replace(force, amplitude=9.0 * force.amplitude) for force in FORCES]
    ridden = Slider(mass=0.021, mu=0.3, preload=0.4, position=0.377, speed=0.004, **more)
    back = replace(ridden, position=LENGTH - 0.377, speed=-0.004)
    sides = (beam, pushes, ridden, X), (beam.mirrored(), other_side(pushes), back, LENGTH - X[::-1])
    one, other = (
        simulate(beam, Excitation(forces, 433.0), 0.02, slider=slider, model=model, keep=Keep(at=x), **size)
        for beam, forces, slider, x in sides
    )
    compared(one.deflection, other.deflection)
    for name in ("travelled", "speed", "friction"):
        here, there = (getattr(each, name) for each in (one, other))
        assert abs(here + there).max() <= 1e-6 * abs(here).max(), name
    for name in ("friction_loss", "drive_work", "slope_work", "friction_on_beam", "normal_on_beam"):
        here, there = (getattr(each.energy, name) for each in (one, other))
        assert there == pytest.approx(here, rel=1e-6, abs=1e-9 * abs(one.energy.drive_work)), name


@pytest.mark.parametrize("given", [{"stiffness": 2e5, "tangential_stiffness": 7e4}, {"layer_stiffness": 4e6}])
def test_feet_are_pressed_as_much_and_carried_the_other_way(given):
    feet = Foot(length=0.03, points=3), Foot(length=0.01, points=2, offset=0.05)
    turned = feet[0], replace(feet[1], offset=-0.05)
    pushes = [replace(force, amplitude=0.4 * force.amplitude) for force in FORCES]
    runs = []
    for beam, forces, place, foot, pull in (
        (plain(thickness=0.0019), pushes, 0.377, feet, -0.02),
        (plain(thickness=0.0019).mirrored(), other_side(pushes), LENGTH - 0.377, turned, 0.02),
    ):
        law = {"external_force": pull}
        law |= {"law": "coulomb"} if "tangential_stiffness" in given else {"slope": 70.0}
        slider = Slider(mass=0.021, mu=0.3, preload=0.4, position=place, contact=Contact(**given), foot=foot, **law)
        runs.append(simulate(beam, Excitation(forces, 433.0), 0.01, slider=slider, count=24))
    one, other = runs
    assert abs(one.travelled + other.travelled).max() <= 1e-6 * abs(one.travelled).max()
    assert other.height == pytest.approx(one.height, abs=1e-6 * abs(one.height).max())
    assert other.pitch == pytest.approx(-one.pitch, abs=1e-6 * abs(one.pitch).max())
    assert other.normal_force == pytest.approx(one.normal_force, abs=1e-6 * abs(one.normal_force).max())
