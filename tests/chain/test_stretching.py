"""The chain whose links stretch: conservation, orders, its limits of small motion and of stiff links, immovable ends."""

from dataclasses import replace

import numpy as np
import pytest
from chain_reference import woinowsky_krieger
from test_dynamics import beam, odd_chain
from test_stepping import driven, rms

from verify.chain.dynamics import at_rest
from verify.chain.splitting import modal_basis, simulate_linear
from verify.chain.stepping import simulate
from verify.chain.stretching import elastic_step_limit, simulate_elastic
from verify.chain.system import Actuator, LinkLoad, Rotation, axial_stiffness, build_system
from verify.errors import InputError
from verify.section import Section

EA = beam().youngs_modulus * beam().area


@pytest.mark.parametrize("immovable", [True, False])
def test_an_undamped_chain_keeps_its_energy_with_order_five_in_the_step(immovable):
    system = odd_chain(5, 6, tip="roller", dashpots=np.zeros(6), loads=(), rotation=Rotation(), gravity=(1.0, -9.81))
    bent = 0.01 * np.sin(np.pi * system.nodes / system.length) + 0.004 * np.sin(
        2 * np.pi * system.nodes / system.length
    )
    limit = elastic_step_limit(system, 900.0)
    drifts = []
    for share in (0.2, 0.1):
        times = np.linspace(0.0, 0.02, 11)
        motion = simulate_elastic(system, 900.0, times, step=share * limit, immovable=immovable, deflected=bent)
        drifts.append(abs(motion.energies - motion.energies[0]).max() / motion.energies[0])
    assert drifts[1] < 1e-4
    assert np.log2(drifts[0] / drifts[1]) == pytest.approx(5.0, abs=0.7)


def test_small_motion_is_the_linear_chains():
    system, times = driven(20, 1e-3), np.linspace(0.0, 4e-4, 41)
    linear = simulate_linear(modal_basis(system), at_rest(system), times).deflection([0.2])
    assert rms(simulate_elastic(system, EA, times).deflection([0.2]) - linear) < 1e-6 * rms(linear)


def test_stiff_links_go_over_into_rigid_ones_with_the_inverse_of_their_stiffness():
    system, times = driven(12, 60.0), np.linspace(0.0, 4e-4, 41)
    rigid = simulate(system, at_rest(system), times, tolerance=1e-10, ledger=False).deflection([0.2])
    gaps = [rms(simulate_elastic(system, factor * EA, times).deflection([0.2]) - rigid) for factor in (40.0, 4000.0)]
    assert gaps[1] < 0.05 * gaps[0]
    assert gaps[1] < 1e-4 * rms(rigid)


def test_links_as_soft_as_the_beam_lose_most_of_the_rigid_links_nonlinearity():
    system, times = driven(49, 10.0), np.linspace(0.0, 8e-4, 161)
    linear = simulate_linear(modal_basis(system), at_rest(system), times).deflection([0.215])
    rigid = simulate(system, at_rest(system), times, tolerance=1e-9, ledger=False).deflection([0.215])
    soft = simulate_elastic(system, EA, times).deflection([0.215])
    assert 0.01 * rms(rigid - linear) < rms(soft - linear) < 0.5 * rms(rigid - linear)


@pytest.mark.parametrize("amplitude", [0.8, 2.0])
def test_immovable_ends_stiffen_as_woinowsky_and_krieger_say(amplitude):
    which, n = beam(), 16
    radius, omega = which.thickness / np.sqrt(12), np.pi**2 * which.wave_constant / which.length**2
    system = build_system(which, n)
    shape = amplitude * radius * np.sin(np.pi * np.arange(n + 1) / n)
    times = np.linspace(0.0, 1.01 * np.pi / 2 / omega, 201)
    middle = simulate_elastic(system, EA, times, immovable=True, deflected=shape).deflection([which.length / 2])[:, 0]
    k = int(np.argmax(middle < 0))
    crossing = np.interp(0.0, [middle[k], middle[k - 1]], [times[k], times[k - 1]])
    assert np.pi / 2 / crossing / omega == pytest.approx(woinowsky_krieger(amplitude), rel=2e-4)


def test_a_moment_and_a_dashpot_do_what_they_do_to_rigid_links():
    system = build_system(beam("clamped", "free"), 4, joint_dashpot=3e-3)
    system = replace(
        system, loads=(LinkLoad(link=4, at=0.02, moment=0.3), LinkLoad(link=2, at=0.03, force=(0.1, -0.2)))
    )
    times = np.linspace(0.0, 0.02, 5)
    rigid = simulate(system, at_rest(system), times, tolerance=1e-9).deflection([0.43, 0.2])
    stiff = simulate_elastic(system, 100 * EA, times).deflection([0.43, 0.2])
    assert rms(stiff - rigid) < 1e-3 * rms(rigid)


@pytest.mark.parametrize("n", [8, 30])
def test_the_step_limit_is_safe_and_hardly_too_small(n):
    system, times = driven(n, 1.0), np.linspace(0.0, 3e-3, 31)
    limit = elastic_step_limit(system, EA)
    assert simulate_elastic(system, EA, times, step=limit).finished
    with pytest.raises(InputError, match=r"lies above the stability limit"):
        simulate_elastic(system, EA, times, step=1.01 * limit)
    rate = np.sqrt(12 * EA / system.masses[0] / system.lengths[0])
    assert limit == pytest.approx(2 * np.sqrt(2) / rate)


SECTIONS = (
    Section(length=0.11, width=0.05),
    Section(length=0.2, youngs_modulus=9e9),
    Section(length=0.12, thickness=5e-4),
)
"""Of 0.43 m: EA is about three, a seventh and two fifths of the beam's own."""


def test_every_link_takes_its_own_sections_ea_and_an_immovable_end_that_of_all_in_series():
    which = beam(section=SECTIONS)
    areas = [0.05 * 0.0013, 0.017 * 0.0013, 0.017 * 5e-4]
    own = np.array(areas) * [68e9, 9e9, 68e9]
    assert np.unique(axial_stiffness(which, 43)) == pytest.approx(np.sort(own), rel=1e-14)
    assert axial_stiffness(which, 43)[[0, 20, 42]] == pytest.approx(own, rel=1e-14)
    assert axial_stiffness(beam(), 5) == pytest.approx(np.full(5, EA), rel=1e-15)
    compliance = 0.11 / own[0] + 0.2 / own[1] + 0.12 / own[2]
    assert build_system(which, 43, immovable=True).axial_spring == pytest.approx(1 / compliance, rel=1e-13)
    assert build_system(beam(), 7, immovable=True).axial_spring == pytest.approx(EA / 0.43, rel=1e-13)


def test_a_stepped_chain_under_its_weight_along_x_swings_about_its_static_stretch():
    """Section by section by hand: the force at s is what hangs below it."""
    which = beam("pinned", "free", section=SECTIONS)
    system = replace(build_system(which, 43), gravity=(2.0, 0.0))
    stiffness = axial_stiffness(which, 43)
    below = np.cumsum(system.masses[::-1])[::-1] - 0.5 * system.masses
    stretch = float(np.sum(2.0 * below * system.lengths / stiffness))
    times = np.linspace(0.0, 4e-3, 1201)
    tip, other = (
        simulate_elastic(system, ea, times).displacements[:, -1, 0].mean() for ea in (stiffness, stiffness[::-1].copy())
    )
    assert tip == pytest.approx(stretch, rel=0.03)
    assert abs(tip / other - 1.0) > 0.1


@pytest.mark.parametrize(
    ("change", "request_", "message"),
    [
        ({"actuators": (Actuator(link=1, at=0.0),)}, {}, "for rigid links"),
        ({"rotation": Rotation(rate=1.0)}, {}, "for rigid links"),
        ({"axial_spring": 3.0}, {}, "immovable = True instead"),
        ({}, {"times": [0.0, 1.0, 3.0]}, "evenly spaced"),
        ({}, {"times": [1.0, 2.0]}, "from 0"),
        ({}, {"axial_stiffness": -1.0}, "axial_stiffness = -1.0"),
        ({}, {"axial_stiffness": np.array([EA, EA, np.nan, EA, EA, EA])}, "axial_stiffness = nan"),
        ({}, {"axial_stiffness": np.full(5, EA)}, r"has the shape \(5,\): give one value or one for each of 6 links"),
        ({"axial_inertia": False}, {}, "chain.axial_inertia = False: links that stretch have inertia along x"),
    ],
)
def test_bad_requests_are_refused(change, request_, message):
    system = replace(driven(6, 1.0), **change)
    with pytest.raises(InputError, match=message):
        simulate_elastic(system, request_.get("axial_stiffness", EA), request_.get("times", [0.0, 1e-5]))


def test_steps_are_counted_whole_between_all_samples():
    system, times = driven(7, 3.0), np.linspace(0.0, 3e-4, 4)
    told = simulate_elastic(system, axial_stiffness(beam(), 7), times, step=2.3e-8).statistics
    between = np.ceil(1e-4 / told.step_s - 1e-9)
    assert told.steps == 3 * between
    assert told.evaluations == 4 * told.steps
    assert told.steps * told.step_s == pytest.approx(3e-4)
