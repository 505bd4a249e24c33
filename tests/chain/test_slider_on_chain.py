"""Links that stretch and a slider on the chain: against dense equations."""

from dataclasses import replace

import numpy as np
import pytest
from reference.multibody import ridden, rigid_motion, stretching_motion
from verify.chain.ride import half_steps, ride, ride_from_rest

from verify import simulate
from verify.chain.motion import elastic_step_limit, simulate_elastic
from verify.chain.system import axial_stiffness, build_system
from verify.errors import InputError
from verify.problem.beam import Beam, PointForce
from verify.problem.slider import Slider

STRIP = Beam(length=0.5, width=0.02, thickness=0.001, youngs_modulus=70e9, density=2700.0)
HERTZ, STEP = 4276.0, 4e-6
SLIDER = Slider(mass=1e-3, mu=0.23, slope=120.0, position=0.231, coupling="one-way")


def forces(amplitude):
    return (
        PointForce(position=0.0116, amplitude=amplitude, phase_deg=-90.0),
        PointForce(position=0.4871, amplitude=1.3 * amplitude),
    )


def test_stretching_links_move_as_dense_equations():
    system = build_system(STRIP, 9, forces(30.0), HERTZ)
    times, axial = np.linspace(0.0, 4e-4, 5), axial_stiffness(STRIP, 9)
    motion, seen = simulate_elastic(system, axial, times), stretching_motion(system, axial, 4e-4)
    for i, t in enumerate(times[1:], start=1):
        y, rise, along = seen(t)
        assert motion.displacements[i, :, 1] == pytest.approx(y, abs=1e-5 * abs(y).max())
        assert motion.velocities[i, :, 1] == pytest.approx(rise, abs=1e-5 * abs(rise).max())
        assert motion.velocities[i, :, 0] == pytest.approx(along, abs=1e-3 * abs(along).max())


def test_energy_of_free_stretching_links_drifts_with_order_five():
    system = replace(build_system(STRIP, 6), gravity=(1.0, -9.81))
    bent = 0.01 * np.sin(np.pi * system.nodes / 0.5) + 0.004 * np.sin(2 * np.pi * system.nodes / 0.5)
    axial = 1e-4 * STRIP.youngs_modulus * STRIP.own.area
    limit, drifts = elastic_step_limit(system, axial), []
    for share in (0.4, 0.2):
        motion = simulate_elastic(system, axial, np.linspace(0.0, 0.02, 11), step=share * limit, deflected=bent)
        drifts.append(abs(motion.energies - motion.energies[0]).max() / motion.energies[0])
    assert drifts[1] < 1e-3
    assert np.log2(drifts[0] / drifts[1]) == pytest.approx(5.0, abs=0.9)
    with pytest.raises(InputError, match="step"):
        simulate_elastic(system, axial, [0.0, 0.02], step=1.01 * limit)


@pytest.mark.parametrize("kinematics", ["tangential", "following"])
@pytest.mark.parametrize("links", ["rigid", "stretching"])
def test_a_slider_rides_as_dense_equations_state(links, kinematics):
    n, duration, slider = 7, 2.4e-4, replace_slider(kinematics=kinematics, speed=0.011)
    found = ride_from_rest(STRIP, forces(20.0), HERTZ, slider, n, duration, step=1e-6, links=links)
    system = build_system(STRIP, n, forces(20.0), HERTZ, load="reciprocal")
    seen = (
        rigid_motion(system, duration)
        if links == "rigid"
        else stretching_motion(system, axial_stiffness(STRIP, n), duration)
    )
    way, speed, _ = ridden(system, seen, slider, 0.5 * STRIP.thickness, duration)
    assert found.displacement == pytest.approx(way, rel=2e-5)
    assert found.speed[-1] == pytest.approx(speed, rel=2e-5)


def replace_slider(**more):
    from msgspec.structs import replace as changed

    return changed(SLIDER, **more)


@pytest.mark.parametrize("kinematics", ["tangential", "following"])
def test_the_sliders_energy_balance_closes_with_order_four(kinematics):
    parts = []
    for step in (4e-6, 2e-6):
        found = ride_from_rest(
            STRIP, forces(8.0), HERTZ, replace_slider(kinematics=kinematics), 17, 4e-4, step=step
        ).ledger
        parts.append(abs(found.residual) / found.rubbed)
    assert parts[1] < 1e-4
    assert np.log2(parts[0] / parts[1]) == pytest.approx(4.0, abs=0.3)


def test_small_waves_carry_a_slider_as_on_the_linear_chain():
    found = ride_from_rest(STRIP, forces(1e-3), HERTZ, SLIDER, 25, 8e-4, step=STEP)
    linear = simulate(STRIP, forces(1e-3), HERTZ, 8e-4, count=25, slider=SLIDER, step=STEP)
    assert found.displacement == pytest.approx(linear.displacement, rel=1e-4)
    steady = simulate(STRIP, forces(1e-3), HERTZ, 1e-4, count=25, slider=SLIDER, start="steady", step=STEP)
    assert found.coupling.friction_size == pytest.approx(steady.coupling.friction_size, rel=1e-9)


@pytest.mark.parametrize(
    ("change", "field"),
    [
        ({"coupling": "two-way"}, "coupling"),
        ({"coupling": "auto", "mass": 0.3}, "auto"),
        ({"line": "raw"}, "line"),
        ({"speed": 400.0}, "position"),
        ({"position": 0.25, "speed": -0.5}, "number of segments"),
    ],
)
def test_sliders_that_a_chain_does_not_carry_are_refused(change, field):
    with pytest.raises(InputError, match=field):
        ride_from_rest(STRIP, forces(2.0), HERTZ, replace_slider(**change), 10, 2e-4, step=STEP)


def test_states_that_do_not_stand_twice_in_a_step_are_refused():
    system = build_system(STRIP, 9, forces(1.0), HERTZ)
    motion = simulate_elastic(system, axial_stiffness(STRIP, 9), half_steps(4e-5, STEP)[:-1])
    with pytest.raises(InputError, match="times"):
        ride(motion, STRIP, SLIDER)
