"""Equilibria of the nonlinear chain and small motion about them: elastica, buckling, hanging and rotating chains."""

from dataclasses import replace

import numpy as np
import pytest
from msgspec import structs
from reference.multibody import by_multipliers
from scipy.integrate import solve_ivp
from scipy.optimize import brentq
from scipy.special import ellipk

from verify import bend
from verify.chain.kinematics import at_rest
from verify.chain.linearisation import linearise
from verify.chain.statics import solve_static
from verify.chain.system import LinkLoad, build_system
from verify.errors import InputError
from verify.problem.beam import Beam
from verify.problem.cross_section import Section
from verify.problem.point_attachments import PointMass
from verify.segment_model import SegmentModel

ROD = Beam(
    length=0.83, width=0.013, thickness=0.0021, youngs_modulus=113e9, density=4470.0, supports=("clamped", "free")
)
L, EI = ROD.length, ROD.bending_stiffness
FORCE, MOMENT = EI / L**2, EI / L
HINGED = structs.replace(ROD, supports=("pinned", "pinned"))


def elastica_under(along, across, moment):
    """(turn of the tip, energy) of the rod by shooting: EI theta' = M, M' = along sin(theta) - across cos(theta)."""

    def integrated(clamp):
        def rate(s, state):
            theta, bent, _ = state
            return bent / EI, along * np.sin(theta) - across * np.cos(theta), bent**2 / (2 * EI)

        return solve_ivp(rate, (0.0, L), (0.0, clamp, 0.0), method="DOP853", rtol=1e-12, atol=1e-14).y[:, -1]

    size = (abs(across) + abs(along)) * L + abs(moment)
    clamp = brentq(lambda clamp: integrated(clamp)[1] - moment, moment - 0.1 * size, moment + size, xtol=1e-13)
    return integrated(clamp)[[0, 2]]


@pytest.mark.parametrize("wall", ["gregory", "half", "third-order"])
@pytest.mark.parametrize("moment", [0.0, 0.83, -1.7])
def test_turn_and_energy_tend_to_the_elastica_with_order_two(wall, moment):
    load = (0.6 * FORCE, 2.3 * FORCE)
    bent = [bend(ROD, n, load, moment=moment * MOMENT, wall=wall) for n in (60, 120)]
    errors = np.array([[one.turn, one.energy] for one in bent]) / elastica_under(*load, moment * MOMENT) - 1
    assert abs(errors[1]).max() < 3e-4
    assert errors[0] / errors[1] == pytest.approx(4.0, rel=0.15)


def test_joint_moments_balance_the_load_about_every_joint():
    along, across, moment = 0.7 * FORCE, -3.1 * FORCE, 0.4 * MOMENT
    found = bend(ROD, 23, (along, across), moment=moment)
    arm = found.tip - found.joints
    expected = arm[:, 0] * across - arm[:, 1] * along + moment
    assert found.moments == pytest.approx(expected, abs=1e-7 * abs(expected).max())
    assert np.hypot(*np.diff(found.joints, axis=0).T) == pytest.approx(np.full(23, L / 23), rel=1e-12)
    assert found.curvature == pytest.approx(found.moments / EI, rel=1e-14)


@pytest.mark.parametrize("moment", [0.83, -1.7])
def test_work_of_a_growing_moment_is_the_energy_of_a_stepped_rod(moment):
    rod = structs.replace(ROD, section=(Section(length=0.33), Section(length=0.5, thickness=0.0013)))
    force, step = np.array([0.2, 0.7]) * FORCE, 1e-4 * MOMENT
    below, above = (bend(rod, 9, force, moment=moment * MOMENT + side * step) for side in (-1, 1))
    work = force @ (above.tip - below.tip) + moment * MOMENT * (above.turn - below.turn)
    assert above.energy - below.energy == pytest.approx(work, rel=1e-5)


def test_a_moment_of_two_pi_closes_the_circle_of_equal_joints():
    circle = bend(ROD, 12, moment=2 * np.pi * MOMENT, wall="half")
    assert circle.turn == pytest.approx(2 * np.pi, rel=1e-9)
    assert circle.energy == pytest.approx(2 * np.pi**2 * MOMENT, rel=1e-9)


@pytest.mark.parametrize("push", [1.2, 2.6])
def test_a_buckled_cantilever_bends_to_the_side_of_the_disturbance(push):
    critical = np.pi**2 * EI / (4 * L**2)
    left, right = (bend(ROD, 40, (-push * critical, side * 1e-3 * critical)) for side in (-1, 1))
    assert right.deflection > 0.5 * L
    assert left.deflection == pytest.approx(-right.deflection, rel=1e-8)
    tip_angle = brentq(lambda a: (2 * ellipk(np.sin(0.5 * a) ** 2) / np.pi) ** 2 - push, 0.01, 3.0)
    assert right.turn == pytest.approx(tip_angle, rel=0.02)  # of the strut without a disturbance
    with pytest.raises(InputError, match="buckling load"):
        bend(ROD, 40, (-push * critical, 0.0))


def test_a_roller_ended_chain_buckles_at_four_k_over_l():
    """P = 4 k / l sin^2(pi / 2N)."""
    system = build_system(HINGED, 9)
    critical = 4 * system.stiffness[1] / system.lengths[0] * np.sin(np.pi / 18) ** 2

    def lowest(share):
        force = LinkLoad(link=9, at=float(system.lengths[0]), force=(-share * critical, 0.0))
        return linearise(replace(system, loads=(force,)), at_rest(system)).frequencies()[0]

    assert (lowest(0.75) / lowest(0.0)) ** 2 == pytest.approx(0.25, rel=2e-3)
    with pytest.raises(InputError, match="unstable"):
        lowest(1.001)


@pytest.mark.parametrize("supports", [("pinned", "pinned"), ("clamped", "free"), ("clamped", "pinned")])
def test_small_motion_at_rest_is_that_of_the_segment_model(supports):
    beam = structs.replace(ROD, supports=supports)
    system = build_system(beam, 14)
    exact = 2 * np.pi * SegmentModel(beam, 14).modes(8).frequencies_hz
    assert linearise(system, at_rest(system)).frequencies()[:8] == pytest.approx(exact, rel=1e-9)


def slopes(system, angles, step):
    """Derivatives of the multiplier equations' accelerations by angles, (N, N), without projection."""

    def accelerations(change):
        return by_multipliers(system, 0.0, angles + change, np.zeros(len(angles)))

    changes = step * np.eye(len(angles))
    return np.transpose([accelerations(c) - accelerations(-c) for c in changes]) / (2 * step)


@pytest.mark.parametrize("axial_inertia", [True, False])
def test_the_linearisation_is_the_derivative_of_the_multiplier_equations(axial_inertia):
    rng = np.random.default_rng(11)
    lengths, masses = rng.uniform(0.02, 0.07, 6), rng.uniform(0.01, 0.04, 6)
    system = replace(
        build_system(HINGED, 6), lengths=lengths, masses=masses, inertias=masses * lengths**2 / 9,
        stiffness=rng.uniform(0.5, 4.0, 6), axial_inertia=axial_inertia, axial_spring=40.0, gravity=(0.7, -9.81),
        loads=(LinkLoad(link=3, at=0.01, force=(0.3, 2.0), moment=0.02),),
    )  # fmt: skip
    rest = solve_static(system)
    resting, fallen = (by_multipliers(system, 0.0, angles, np.zeros(6)) for angles in (rest.angles, np.zeros(6)))
    assert abs(resting).max() < 1e-7 * abs(fallen).max()
    linear = linearise(system, rest)
    basis = linear.independent()
    assert linear.constraint @ basis == pytest.approx(0.0, abs=1e-15)
    expected = np.linalg.lstsq(basis, slopes(system, rest.angles, 1e-5) @ basis, rcond=None)[0]
    mass, stiffness = (basis.T @ m @ basis for m in (linear.mass, linear.stiffness))
    assert np.linalg.solve(mass, -stiffness) == pytest.approx(expected, rel=1e-4, abs=1e-4 * abs(expected).max())


@pytest.mark.parametrize(
    ("beam", "settings", "field"),
    [
        (HINGED, {}, "supports"),
        (structs.replace(ROD, mass=(PointMass(position=0.3, mass=0.1),)), {}, "mass"),
        (structs.replace(ROD, tension=3.0), {}, "tension"),
        (ROD, {"load": [1.0, 2.0, 3.0]}, "load"),
        (ROD, {"count": 1}, "count"),
        (ROD, {"moment": np.inf}, "moment"),
        (ROD, {"joints": "glued"}, "joints"),
    ],
)
def test_bad_bending_is_refused_by_field(beam, settings, field):
    with pytest.raises(InputError, match=field):
        bend(beam, **{"count": 10, "load": 1.0, **settings})
