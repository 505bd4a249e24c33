"""Links that stretch, sliders and feet on the chain: against dense equations and the linear chain."""

import numpy as np
import pytest
from msgspec.structs import replace
from reference.multibody import ridden, rigid_motion, stretching_motion

from verify import Contact, Excitation, Foot, Keep, PrescribedSlider, bend, simulate
from verify.chain.motion import simulate_elastic
from verify.chain.slider_on_chain import slide_on_chain
from verify.chain.system import build_system
from verify.errors import InputError
from verify.problem.beam import Beam, PointForce
from verify.problem.slider import Slider

STRIP = Beam(length=0.5, width=0.02, thickness=0.001, youngs_modulus=70e9, density=2700.0)
HERTZ, STEP = 4276.0, 4e-6
SLIDER = Slider(mass=1e-3, mu=0.23, slope=120.0, position=0.231, coupling="one-way")
FEET = (Foot(length=0.03, points=3),)


def forces(amplitude):
    return (
        PointForce(position=0.0116, amplitude=amplitude, phase_deg=-90.0),
        PointForce(position=0.4871, amplitude=1.3 * amplitude),
    )


def drive(amplitude, hertz=HERTZ):
    return Excitation(forces(amplitude), hertz)


def test_stretching_links_move_as_dense_equations():
    system, times = build_system(STRIP, 9, forces(30.0), HERTZ, links="stretching"), np.linspace(0.0, 4e-4, 5)
    motion, seen = simulate_elastic(system, times), stretching_motion(system, system.axial_stiffness, 4e-4)
    displacements, velocities = motion.moved()
    for i, t in enumerate(times[1:], start=1):
        y, rise, along = seen(t)
        assert displacements[i, :, 1] == pytest.approx(y, abs=1e-5 * abs(y).max())
        assert velocities[i, :, 1] == pytest.approx(rise, abs=1e-5 * abs(rise).max())
        assert velocities[i, :, 0] == pytest.approx(along, abs=1e-3 * abs(along).max())


def slider(**more):
    return replace(SLIDER, **more)


@pytest.mark.parametrize("kinematics", ["tangential", "following"])
@pytest.mark.parametrize("links", ["rigid", "stretching"])
def test_a_slider_moves_as_dense_equations_state(links, kinematics):
    n, duration, one = 7, 2.4e-4, slider(kinematics=kinematics, speed=0.011)
    found = slide_on_chain(STRIP, drive(20.0), duration, slider=one, count=n, step=1e-6, links=links)
    system = build_system(STRIP, n, forces(20.0), HERTZ, load="reciprocal", links=links)
    axial = system.axial_stiffness
    seen = rigid_motion(system, duration) if system.rigid else stretching_motion(system, axial, duration)
    way, speed, _ = ridden(system, seen, one, 0.5 * STRIP.thickness, duration)
    assert found.displacement == pytest.approx(way, rel=2e-5)
    assert found.speed[-1] == pytest.approx(speed, rel=2e-5)
    assert abs(found.energy.slider_residual) < 1e-12 * found.energy.friction_loss


PRESSED = {"contact": Contact(stiffness=1.1e6, damping=17.0), "kinematics": "tangential", "gravity": 0.0}
FACES = (Foot(offset=-0.02, length=0.02, points=3), Foot(offset=0.03, face="lower"))
YIELDS = Contact(stiffness=1.1e6, damping=17.0, tangential_stiffness=4e5)
KINDS = {
    "tanh": {"coupling": "one-way"},
    "tanh two-way": {"mass": 5.0, "mu": 0.4, "coupling": "two-way", "normal": "massless"},
    "coulomb two-way": {"mass": 5.0, "mu": 0.4, "coupling": "two-way", "normal": "massless", "law": "coulomb"},
    "feet": {"coupling": "one-way", "mass": 0.021, "foot": FEET, **PRESSED},
    "feet two-way": {"coupling": "two-way", "mass": 0.021, "foot": FEET, **PRESSED},
    "faces two-way": {"coupling": "two-way", "mass": 0.021, "foot": FACES, **PRESSED, "contact": YIELDS},
}
"""Sliders whose friction grows with the motion."""


def scaled(kind, size):
    own = dict(KINDS[kind])
    own |= {"preload": 0.3 * size} if "contact" in own else {"gravity": 9.81 * size}
    return slider(slope=None if own.get("law") == "coulomb" else 200.0 / size, **own)


@pytest.mark.parametrize("kind", KINDS)
def test_a_slider_departs_from_that_on_the_linear_chain_in_proportion_to_the_motion(kind):
    apart = []
    for size in (0.02, 0.005):
        asked = {"slider": scaled(kind, size), "count": 25, "step": STEP, "keep": Keep(samples=41)}
        bent = slide_on_chain(STRIP, drive(size), 4e-4, **asked)
        straight = simulate(STRIP, drive(size), 4e-4, start="rest", **asked)
        largest = abs(straight.surface_speed[1:]).max()
        apart.append(abs(bent.surface_speed - straight.surface_speed)[1:].max() / largest)
        assert bent.statistics.unconverged == 0
    assert apart[1] < 0.04
    assert np.log2(apart[0] / apart[1]) / 2.0 == pytest.approx(1.0, abs=0.1)


@pytest.mark.parametrize("kind", ["tanh two-way", "feet two-way"])
def test_contact_takes_from_a_damped_chain_what_it_gives_and_dissipates(kind):
    parts = []
    for step in (1e-6, 5e-7):
        given = {"count": 25, "step": step, "joint_dashpot": 1e-4, "keep": Keep(samples=11)}
        found = slide_on_chain(STRIP, drive(1.0), 4e-4, slider=scaled(kind, 1.0), **given).energy
        assert found.damping_loss > 0.3 * found.drive_work > 0.0
        parts.append(abs(found.residual) / found.friction_loss)
    assert parts[1] < 2e-2
    assert parts[0] > 2.0 * parts[1]


def test_a_slider_crosses_links_as_on_the_linear_chain():
    own = {"mass": 1.0, "position": 0.2355, "speed": 20.0, "slope": 500.0, "gravity": 0.3924}
    one = slider(**{**KINDS["tanh two-way"], **own})
    asked = {"slider": one, "count": 25, "step": STEP, "keep": Keep(samples=401)}
    found = slide_on_chain(STRIP, drive(0.04), 1.6e-3, **asked)
    linear = simulate(STRIP, drive(0.04), 1.6e-3, **asked)
    assert found.displacement > STRIP.length / 25  # more than a link
    assert found.surface_speed == pytest.approx(linear.surface_speed, abs=0.01 * abs(linear.surface_speed).max())


def test_a_foot_at_rest_bends_the_chain_as_its_load_and_stays():
    arm = replace(STRIP, supports=("clamped", "free"))
    load, position = 0.3 * arm.bending_stiffness / arm.length**2, arm.length * 19 / 20
    own = {"mass": 0.021, "preload": load, "position": position, "coupling": "two-way", **PRESSED}
    found = slide_on_chain(arm, Excitation((), HERTZ), 1e-3, slider=slider(**own), count=20, keep=Keep(at=position))
    short = replace(arm, length=position)
    assert found.deflection[0, 0] == pytest.approx(-bend(short, 190, load).deflection, rel=2e-3)
    assert found.normal_force == pytest.approx(load, rel=1e-4)
    assert found.height == pytest.approx(found.height[0, 0], rel=1e-4)
    assert abs(found.speed).max() < 1e-6


@pytest.mark.parametrize("links", ["rigid", "stretching"])
def test_the_surface_of_a_chain_is_continuous_at_a_joint(links):
    joint, own = 3 * STRIP.length / 9, KINDS["feet"] | {"foot": (), "preload": 9.0}
    left, right = (
        slide_on_chain(STRIP, drive(30.0), 5e-4, slider=held, count=9, links=links, keep=Keep(samples=9))
        for held in (PrescribedSlider(slider(**own, position=x), 0.0, True) for x in (joint - 1e-9, joint + 1e-9))
    )
    left, right = left.surface_speed[1:], right.surface_speed[1:]
    assert left == pytest.approx(right, abs=1e-6 * np.nanmax(abs(left)))


def test_sliders_on_one_chain_move_as_each_by_itself_one_way():
    pair, asked = [slider(position=0.231), slider(position=0.317, mu=0.31)], {"count": 9, "step": STEP}
    both = slide_on_chain(STRIP, drive(3.0), 3e-4, slider=pair, **asked)
    for i, one in enumerate(pair):
        alone = slide_on_chain(STRIP, drive(3.0), 3e-4, slider=one, **asked)
        assert both.travelled[:, i] == pytest.approx(alone.travelled, rel=1e-9, abs=1e-18)


def test_a_slider_that_leaves_the_chain_ends_the_run():
    found = slide_on_chain(STRIP, drive(2.0), 2e-4, slider=slider(speed=2000.0), count=10, step=STEP)
    assert found.statistics.stopped.startswith("left")
    assert 0.0 < found.end.time < 2e-4


@pytest.mark.parametrize("links", ["rigid", "stretching"])
def test_a_chain_whose_motion_is_not_resolved_is_refused(links):
    with pytest.raises(InputError, match=r"tolerance|step"):
        slide_on_chain(
            STRIP, drive(1e5, 900.0), 3e-3, slider=slider(**KINDS["feet"], preload=0.3), links=links, count=9
        )


@pytest.mark.parametrize(
    ("change", "field"),
    [
        ({"coupling": "two-way"}, "normal"),
        ({"line": "raw"}, "line"),
        ({"contact": Contact(restitution=0.3)}, "stiffness"),
        ({"contact": Contact(stiffness=1e5), "coupling": "two-way"}, "rigid"),
        ({**KINDS["feet two-way"], "preload": 0.3, "preload_stiffness": 200.0, "links": "rigid"}, "preload"),
    ],
)
def test_sliders_that_a_chain_does_not_support_are_refused(change, field):
    links = change.pop("links", "stretching")
    with pytest.raises(InputError, match=field):
        slide_on_chain(STRIP, drive(2.0), 2e-4, slider=slider(**change), count=10, links=links)


@pytest.mark.parametrize("growth", [{"soft_start_periods": 2.0}, {"envelope": [(1e-4, [0.0, 1.0])]}])
def test_forces_that_grow_are_refused_on_a_chain(growth):
    with pytest.raises(InputError, match=next(iter(growth))):
        slide_on_chain(STRIP, Excitation(forces(2.0), HERTZ, **growth), 2e-4, slider=SLIDER, count=10)
