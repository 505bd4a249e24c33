"""Joints that follow the axial force of a moving base: against links EI/l in the limit, steady rotation, energy."""

from dataclasses import replace

import numpy as np
import pytest

from verify.chain.kinematics import at_rest
from verify.chain.linearisation import tensioned
from verify.chain.motion import simulate
from verify.chain.system import ChainState, LinkLoad, build_system
from verify.errors import InputError
from verify.problem.base_motion import Base, polynomial
from verify.problem.beam import Beam

BEAM = Beam(length=0.8, bending_stiffness=14.0, mass_per_length=1.7, supports=("clamped", "free"))
SHAKEN = Base(
    rotation=polynomial(0.0, 0.2, 0.3, -0.8), x=polynomial(0, 0.1, -9.0, 3.0), y=polynomial(0, 0, 2.0), hub_radius=0.3
)
TIMES = np.linspace(0.0, 0.7, 15)


def moved(count, joints=tensioned, base=SHAKEN, gravity=(9.0, -1.0), **more):
    """Motion from rest on the base."""
    system = joints(replace(build_system(BEAM, count), base=base, gravity=gravity, **more))
    return simulate(system, at_rest(system), TIMES, tolerance=1e-10)


def test_rotation_translation_and_gravity_soften_the_joints_so_that_the_path_has_order_four():
    plain = [moved(n, lambda system: system).in_base()[:, -1] for n in (24, 48, 96)]
    exact = plain[2] + (plain[2] - plain[1]) / 3.0
    errors = [abs(moved(n).in_base()[:, -1] - exact).max() for n in (12, 24)]
    assert 12.0 < errors[0] / errors[1] < 28.0
    assert errors[1] < 0.1 * abs(plain[0] - exact).max()


def test_the_work_of_the_softer_joints_closes_the_energy_balance():
    motion = moved(9, dashpots=np.full(9, 2e-3))
    total = motion.energies().sum(axis=0)
    assert abs(motion.residual()).max() < 1e-8 * (total.max() - total.min())
    stiff = replace(motion, system=replace(motion.system, softening=np.zeros(0)))
    assert abs(stiff.root_moments() - motion.root_moments()).max() > 1e-3 * abs(motion.root_moments()).max()


def test_at_a_constant_rate_they_are_the_joints_of_steady_rotation():
    plain = replace(build_system(BEAM, 7), gravity=(0.0, 0.0))
    bent, rate = 0.01 * np.arange(1.0, 8.0), 5.7
    paths = []
    for more in ({"hub_rate": rate}, {"base": Base(rotation=polynomial(0.0, rate))}):
        system = tensioned(replace(plain, **more))
        paths.append(simulate(system, ChainState(bent, 0.0 * bent), TIMES, tolerance=1e-11).angles)
    assert paths[0] == pytest.approx(paths[1], abs=1e-8)


@pytest.mark.parametrize(
    ("more", "text"),
    [
        ({"loads": (LinkLoad(link=6, at=0.1, force=(0.0, 0.2)),)}, "loads"),
        ({"gravity": (0.0, -90.0)}, "tensioned"),
        ({"base": Base(rotation=polynomial(0.0, 240.0))}, "more links"),
    ],
)
def test_forces_far_bending_and_joints_without_stiffness_are_refused(more, text):
    with pytest.raises(InputError, match=text):
        moved(6, **more)
