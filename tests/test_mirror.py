"""Seen from the other side a beam does the same, turned round: every verb, on beams that are like neither end."""

import numpy as np
import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st
from msgspec.structs import replace

from verify import (
    Beam,
    Contact,
    ExactModel,
    Foot,
    HermiteModel,
    PointForce,
    PointMass,
    PointSpring,
    Section,
    SegmentModel,
    Slider,
    free_vibration,
    simulate,
    travelling_wave,
)
from verify.options import ATTACHMENTS, JOINTS, LOADS, SUPPORTS, WALLS

LENGTH = 0.83
MODELS = {"analytic": (ExactModel, ()), "fem": (HermiteModel, (24,)), "segment": (SegmentModel, (24,))}
X = np.array([0.0, 0.011, 0.12, 0.2931, 0.37, 0.6102, 0.81, LENGTH])
OF_MODEL = pytest.mark.parametrize("model", MODELS)


def plain(thickness=0.019, **more):
    sizes = {"length": LENGTH, "width": 0.027, "thickness": thickness, "youngs_modulus": 193e9, "density": 7900.0}
    return Beam(**sizes, **{"supports": ("clamped", "free"), "loss_factor": 0.013} | more)


def laden(supports=("guided", "pinned"), **more):
    """Of sections that end on joints of 24 parts, with a body near one end, one between, springs at both ends."""
    third = LENGTH / 24.0
    parts = ((7 * third, 0.019), (6 * third, 0.023), (11 * third, 0.015))
    return plain(
        supports=supports,
        section=tuple(Section(length=length, thickness=thickness) for length, thickness in parts),
        mass=(
            PointMass(position=0.013, mass=0.3, rotary_inertia=2e-4),
            PointMass(position=0.3507, mass=0.11),
            PointMass(position=0.371, mass=0.2, rotary_inertia=3e-4),
        ),
        spring=(
            PointSpring(position=0.61, stiffness=2.3e4, rotational=170.0),
            PointSpring(position=LENGTH, rotational=3e3),
        ),
        **more,
    )


def other_side(forces):
    return [replace(force, position=LENGTH - force.position) for force in forces]


FORCES = [PointForce(position=0.11, amplitude=1.4), PointForce(position=0.5302, amplitude=0.7, phase_deg=70.0)]


def compared(one, other, sign=1.0, within=1e-9):
    """Values along the last axis, of the other side the last first."""
    assert np.isfinite(one).all()
    assert abs(one - sign * other[..., ::-1]).max() <= within * abs(one).max()


@OF_MODEL
@pytest.mark.parametrize("theory", ["euler-bernoulli", "rayleigh", "timoshenko"])
@pytest.mark.parametrize("supports", [("guided", "pinned"), ("free", "pinned"), ("clamped", "pinned")], ids="-".join)
def test_fields_and_turns_of_the_section_are_turned_round(model, theory, supports):
    kind, size = MODELS[model]
    beam, graded, back = (
        laden(supports),
        *(({}, {}) if model == "analytic" else ({"grading": 1.3}, {"grading": 1 / 1.3})),
    )
    one = kind(beam, *size, theory=theory, **graded).harmonic(FORCES, 317.0)
    other = kind(beam.mirrored(), *size, theory=theory, **back).harmonic(other_side(FORCES), 317.0)
    compared(one.deflection(X), other.deflection(LENGTH - X[::-1]))
    compared(one.slope(X), other.slope(LENGTH - X[::-1]), -1.0)
    compared(one.rotation(X), other.rotation(LENGTH - X[::-1]), -1.0)
    inside = X[1:-1]
    compared(one.derivative(inside, 2), other.derivative(LENGTH - inside[::-1], 2))


@settings(max_examples=60, deadline=None)
@given(
    supports=st.tuples(*[st.sampled_from(SUPPORTS)] * 2),
    places=st.lists(st.integers(0, 46), min_size=1, max_size=2, unique=True),
    shift=st.sampled_from([0.1, 0.43, 0.5, 1.0]),
    wall=st.sampled_from([one for one in WALLS if one != "welded"]),
    joints=st.sampled_from([one for one in JOINTS if one != "tensioned"]),
    load=st.sampled_from(LOADS),
    attachment=st.sampled_from(ATTACHMENTS),
)
def test_whatever_the_chain_makes_of_walls_joints_loads_and_bodies_it_makes_at_both_ends(
    supports, places, shift, wall, joints, load, attachment
):
    """Bodies and forces a link apart and more, also beside an end: of closer ones rounding of the weights decides."""
    assume(len(places) == 1 or abs(places[0] - places[1]) > 1)
    at = [LENGTH * (place + shift) / 48.0 for place in places]
    assume(abs(np.mean(at) - 0.5 * LENGTH) > 1e-6)  # about the middle both crowds are told from the left
    bodies = tuple(PointMass(position=x, mass=0.2 + 0.1 * i) for i, x in enumerate(at))
    beam = plain(supports=supports, mass=bodies)
    forces = [PointForce(position=x, phase_deg=20.0 * i) for i, x in enumerate(at)]
    chosen = {"wall": wall, "joints": joints, "load": load, "attachment": attachment}
    one = SegmentModel(beam, 24, **chosen).harmonic(forces, 271.0)
    other = SegmentModel(beam.mirrored(), 24, **chosen).harmonic(other_side(forces), 271.0)
    compared(one.deflection(X), other.deflection(LENGTH - X[::-1]), within=1e-8)


@OF_MODEL
def test_waves_run_the_other_way_and_devices_take_up_as_much(model):
    kind, size = MODELS[model]
    beam = replace(plain(thickness=0.0019), supports=("pinned", "free"))
    device = travelling_wave.matched_device(beam, 971.0, 0.799)
    far = travelling_wave.matched_device(beam.mirrored(), 971.0, LENGTH - 0.799)
    assert far.dashpot == pytest.approx(device.dashpot, rel=1e-9)
    one = kind(beam, *size).harmonic(FORCES, 971.0, devices=device)
    other = kind(beam.mirrored(), *size).harmonic(other_side(FORCES), 971.0, devices=far)
    compared(one.deflection(X), other.deflection(LENGTH - X[::-1]), within=1e-7)
    here, there = (
        travelling_wave.measure(each, window)
        for each, window in ((one, (0.21, 0.43)), (other, (LENGTH - 0.43, LENGTH - 0.21)))
    )
    assert abs(there.waves.forward) == pytest.approx(abs(here.waves.backward), rel=1e-6)
    assert abs(there.waves.backward) == pytest.approx(abs(here.waves.forward), rel=1e-6)
    assert there.travelling_index == pytest.approx(here.travelling_index, rel=1e-6)
    assert there.s3_range == pytest.approx([-one for one in here.s3_range[::-1]], rel=1e-6)


@OF_MODEL
def test_a_beam_let_go_moves_as_its_mirror_image(model):
    size = {"modes": 30} if model == "analytic" else {"count": 24}
    beam = laden(("clamped", "free"))
    beam = replace(beam, spring=()) if model == "analytic" else beam
    x, values = np.array([0.0, 0.3507, 0.61, LENGTH]), np.array([0.0, 0.003, 0.01, 0.007])

    def speed(at):
        return 0.3 * (at / LENGTH) ** 2

    one = free_vibration(beam, (x, values), 0.03, velocity=speed, model=model, at=X, **size)
    back = (LENGTH - x[::-1], values[::-1])
    other = free_vibration(
        beam.mirrored(), back, 0.03, velocity=lambda at: speed(LENGTH - at), model=model, at=LENGTH - X[::-1], **size
    )
    compared(one.deflection, other.deflection, within=1e-6)
    assert other.kinetic == pytest.approx(one.kinetic, rel=1e-4)  # speeds of bodies are told by differences


@OF_MODEL
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
    one = simulate(beam, pushes, 433.0, 0.02, slider=ridden, model=model, at=X, **size)
    other = simulate(
        beam.mirrored(), other_side(pushes), 433.0, 0.02, slider=back, model=model, at=LENGTH - X[::-1], **size
    )
    compared(one.deflection, other.deflection, within=1e-8)
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
        runs.append(simulate(beam, forces, 433.0, 0.01, slider=slider, count=24))
    one, other = runs
    assert abs(one.travelled + other.travelled).max() <= 1e-6 * abs(one.travelled).max()
    assert other.height == pytest.approx(one.height, abs=1e-6 * abs(one.height).max())
    assert other.pitch == pytest.approx(-one.pitch, abs=1e-6 * abs(one.pitch).max())
    assert other.normal_force == pytest.approx(one.normal_force, abs=1e-6 * abs(one.normal_force).max())
