"""Where links stand, how they move and what energy that is: against complex numbers, differences, and one by one."""

from dataclasses import replace

import numpy as np
import pytest
from test_dynamics import odd_chain

from verify.chain import places, stretching, stretching_kernels
from verify.chain.stretching import ElasticMotion
from verify.chain.system import Actuator, Rotation
from verify.motion.result import Statistics

TURNING = Rotation(offset=0.3, rate=2.0, amplitude=0.4, frequency_hz=5.0, phase_deg=35.0)


def bent(n, seed=3):
    rng = np.random.default_rng(seed)
    return rng.uniform(-0.6, 0.8, (4, n)), rng.uniform(-9.0, 7.0, (4, n)), np.array([0.0, 0.013, 0.21, 1.7])


def test_links_stand_where_turned_sticks_end():
    system, (angles, rates, times) = odd_chain(4, 5, rotation=TURNING), bent(5)
    placed = places.place(system, times, angles, rates)
    for k, t in enumerate(times):
        hub = 0.3 + 2.0 * t + 0.4 * np.sin(2 * np.pi * 5.0 * t + np.deg2rad(35.0))
        end = 0j
        for i in range(5):
            hub += angles[k, i]
            end += system.lengths[i] * np.exp(1j * hub)
            assert complex(*placed.joints[k, i + 1]) == pytest.approx(end, rel=1e-14)
            assert placed.directions[k, i] == pytest.approx(hub, rel=1e-14)
    assert not placed.joints[:, 0].any()
    assert not placed.velocities[:, 0].any()


def test_they_move_as_their_places_change():
    system, (angles, rates, times), h = odd_chain(4, 5, rotation=TURNING), bent(5), 1e-6
    ahead, behind = (places.place(system, times + s * h, angles + s * h * rates, rates).joints for s in (1.0, -1.0))
    assert places.place(system, times, angles, rates).velocities == pytest.approx((ahead - behind) / (2 * h), abs=1e-8)


@pytest.mark.parametrize("felt", [True, False])
def test_many_states_have_the_energies_of_each(felt, monkeypatch):
    system = odd_chain(7, 6, tip="roller", axial_spring=300.0, axial_inertia=felt, rotation=TURNING)
    angles, rates, times = bent(6)
    one_by_one = [places.energies(system, times[k : k + 1], angles[k : k + 1], rates[k : k + 1]) for k in range(4)]
    monkeypatch.setattr(places, "BLOCK", 18)  # three states at a time
    assert places.energies(system, times, angles, rates) == pytest.approx(np.hstack(one_by_one), rel=1e-14)
    assert places.energies(system, times[:0], angles[:0], rates[:0]).shape == (3, 0)


def test_without_inertia_along_x_a_link_has_the_speed_across_alone():
    (angles, rates, times), felt = bent(6), odd_chain(7, 6)
    placed = places.place(felt, times, angles, rates)
    along = 0.5 * (placed.velocities[:, 1:, 0] + placed.velocities[:, :-1, 0])
    less = places.energies(felt, times, angles, rates) - places.energies(
        replace(felt, axial_inertia=False), times, angles, rates
    )
    assert less[0] == pytest.approx(0.5 * along**2 @ felt.masses)
    assert not less[1:].any()


def test_what_is_held_strays_by_its_distance_and_its_speed():
    actuator = Actuator(link=3, at=0.011, amplitude=2e-3, frequency_hz=41.0, phase_deg=25.0)
    system, (angles, rates, times) = odd_chain(8, 5, tip="roller", actuators=(actuator,)), bent(5)
    t, h = times[2], 1e-7
    placed = places.place(system, t, angles[2], rates[2])
    off, leaving = places.strayed(system, t, placed)
    share = 0.011 / system.lengths[2]
    held = (1 - share) * placed.joints[2, 1] + share * placed.joints[3, 1]
    wanted = 2e-3 * np.cos(2 * np.pi * 41.0 * t + np.deg2rad(25.0))
    assert off == pytest.approx([placed.joints[-1, 1], held - wanted], rel=1e-13)
    ahead, behind = (
        places.strayed(system, t + s * h, places.place(system, t + s * h, angles[2] + s * h * rates[2], rates[2]))[0]
        for s in (1.0, -1.0)
    )
    assert leaving == pytest.approx((ahead - behind) / (2 * h), abs=1e-7)


def moved(system, u, v, axial):
    none = Statistics(steps=0, evaluations=0, step_s=0.0, set_up_s=0.0, wall_s=0.0, stopped="end")
    return ElasticMotion(
        system=system, times=np.zeros(len(u)), displacements=u, velocities=v, axial_stiffness=axial, statistics=none
    )


def joint_mass(system):
    """Over the joints, written out link by link: the middle has m, the difference of the ends J/l^2."""
    n = system.n_links
    found = np.zeros((n + 1, n + 1))
    for i, (length, mass, inertia) in enumerate(zip(system.lengths, system.masses, system.inertias, strict=True)):
        middle, spin = np.zeros(n + 1), np.zeros(n + 1)
        middle[i : i + 2], spin[i : i + 2] = (0.5, 0.5), (-1.0 / length, 1.0 / length)
        found += mass * np.outer(middle, middle) + inertia * np.outer(spin, spin)
    return found


STRETCHED = {"dashpots": np.zeros(5), "loads": (), "rotation": Rotation(), "gravity": (0.8, -9.81)}
AXIAL = np.array([40.0, 55.0, 37.0, 61.0, 48.0])


def test_forces_on_stretching_links_are_the_slopes_of_their_energy():
    """M u'' = -dE/du, by central differences, for links of each their own stiffness, far from straight."""
    system, rng, h = odd_chain(6, 5, **STRETCHED), np.random.default_rng(2), 1e-6
    u = np.vstack([[0.0, 0.0], np.cumsum(rng.uniform(-0.03, 0.02, (5, 2)), axis=0)])
    stages = np.zeros((4, 6, 2))
    flat = stretching._flattened(system, AXIAL, False)
    stretching_kernels.march(flat, 0.0, 1e-9, 1, u.copy(), np.zeros((6, 2)), stages, np.zeros((2, 6, 2)))
    shifts = h * np.eye(12)[2:].reshape(10, 6, 2)
    ahead, behind = (moved(system, u + s * shifts, np.zeros((10, 6, 2)), AXIAL).energies for s in (1.0, -1.0))
    forces = (joint_mass(system) @ stages[0])[1:].ravel()
    assert forces == pytest.approx(-(ahead - behind) / (2 * h), rel=1e-6, abs=1e-6)


def test_their_kinetic_energy_is_that_of_every_link():
    system, rng = odd_chain(6, 5, **STRETCHED), np.random.default_rng(5)
    u, v = np.zeros((1, 6, 2)), rng.uniform(-2.0, 3.0, (1, 6, 2))
    mass = joint_mass(system)
    assert moved(system, u, v, AXIAL).energies == pytest.approx(0.5 * np.einsum("ia,ij,ja->", v[0], mass, v[0]))


def test_a_link_that_has_turned_past_half_a_turn_bends_its_joint_by_what_is_less():
    """Directions of +170 and -170 degrees are 20 degrees apart, not 340."""
    system = odd_chain(6, 2, **STRETCHED | {"dashpots": np.zeros(2), "gravity": (0.0, 0.0)})
    ends = np.cumsum(system.lengths * np.exp(1j * np.deg2rad([170.0, -170.0])))
    straight = np.cumsum(system.lengths)
    u = np.array([[[0.0, 0.0], *([z.real - x, z.imag] for z, x in zip(ends, straight, strict=True))]])
    found = moved(system, u, np.zeros_like(u), AXIAL[:2]).energies[0]
    bends = np.deg2rad([170.0, 20.0])
    assert found == pytest.approx(0.5 * system.stiffness @ bends**2, rel=1e-12)
