"""Large static bending and torsion in space against the planar chain, shooting, and what rotations and work demand."""

from dataclasses import replace
from math import cos, pi, sin, sqrt

import numpy as np
import pytest
from msgspec import structs
from reference.curved_rods import frequencies, helix
from reference.space_rods import hanging

from verify import Beam, InputError, PointMass, Section, SegmentModel, bend, bend_in_space
from verify.chain.linearisation import linearise
from verify.chain.statics import solve_static
from verify.chain.system import LinkLoad, build_system

ROD = Beam(
    length=0.83, width=0.0043, thickness=0.0021, youngs_modulus=113e9, density=4470.0, supports=("clamped", "free")
)
TURNED = structs.replace(ROD, width=ROD.thickness, thickness=ROD.width)
STEPPED = structs.replace(ROD, section=(Section(length=0.33), Section(length=0.5, thickness=0.0013)))
L, EI = ROD.length, ROD.bending_stiffness
FORCE, MOMENT = EI / L**2, EI / L
STIFFNESS = np.array([0.61, 1.0, 2.3]) * EI
AXES = np.eye(3)


def twisted(s):
    """Twist and curvature of half a turn and more, that grow along the rod."""
    s = np.asarray(s) / L
    return np.stack([1.3 + 0.4 * s, 0.7 - s, 1.9 + s**2], axis=-1) / L


@pytest.mark.parametrize("wall", ["gregory", "half"])
@pytest.mark.parametrize("moment", [0.0, 0.83, -1.7])
@pytest.mark.parametrize(
    ("beam", "planar", "across"), [(ROD, ROD, AXES[2]), (ROD, TURNED, AXES[1]), (STEPPED, STEPPED, AXES[2])]
)
def test_in_either_plane_it_is_the_planar_chain(beam, planar, across, moment, wall):
    along, load = 0.7 * FORCE, 1.3 * FORCE
    flat = bend(planar, 23, (along, load), moment=moment * MOMENT, wall=wall)
    about = np.cross(AXES[0], across)
    found = bend_in_space(beam, 23, along * AXES[0] + load * across, moment=moment * MOMENT * about, wall=wall)
    assert found.joints @ np.stack([AXES[0], across], axis=1) == pytest.approx(flat.joints, abs=1e-9 * L)
    assert found.joints @ about == pytest.approx(0.0, abs=1e-12 * L)
    assert found.moments @ about == pytest.approx(flat.moments, abs=1e-7 * abs(flat.moments).max())
    assert found.energy == pytest.approx(flat.energy, rel=1e-8)


@pytest.mark.parametrize("wall", ["gregory", "half"])
@pytest.mark.parametrize("curvature", [None, twisted])
def test_tip_and_energy_tend_to_the_rod_with_order_two(curvature, wall):
    force, moment, gravity = np.array([-0.4, 1.9, 2.6]) * FORCE, np.array([0.8, -0.3, 0.5]) * MOMENT, (3.0, -4.0, 9.0)
    weight = ROD.mass_per_length * np.array(gravity)
    shape = {"curvature": curvature} if curvature else {}
    tip, energy = hanging(L, STIFFNESS, force, moment=moment, weight=weight, **shape)
    errors = []
    for n in (50, 100):
        bent = bend_in_space(
            ROD, n, force, moment=moment, gravity=gravity, stiffness=STIFFNESS, curvature=curvature, wall=wall
        )
        errors.append([*(bent.tip - tip) / L, bent.energy / energy - 1])
    assert abs(np.array(errors[1])).max() < 5e-4
    assert np.linalg.norm(errors[0][:3]) / np.linalg.norm(errors[1][:3]) == pytest.approx(4.0, rel=0.1)
    assert errors[0][3] / errors[1][3] == pytest.approx(4.0, rel=0.15)


def test_a_rod_of_equal_bending_turned_about_its_axis_gives_the_turned_answer():
    c, s = cos(0.83), sin(0.83)
    turn = np.array([[1.0, 0.0, 0.0], [0.0, c, -s], [0.0, s, c]])
    force, moment, gravity = (
        np.array(one)
        for one in ((-0.3 * FORCE, 2.1 * FORCE, 1.2 * FORCE), (0.4 * MOMENT, 0.0, -0.6 * MOMENT), (5, 2, -7))
    )
    given = {"stiffness": STIFFNESS[[0, 1, 1]]}
    one = bend_in_space(ROD, 17, force, moment=moment, gravity=gravity, curvature=twisted, **given)
    other = bend_in_space(
        ROD,
        17,
        turn @ force,
        moment=turn @ moment,
        gravity=turn @ gravity,
        curvature=lambda s: twisted(s) @ turn.T,
        **given,
    )
    assert other.joints == pytest.approx(one.joints @ turn.T, abs=1e-9 * L)
    assert other.rotations == pytest.approx(turn @ one.rotations @ turn.T, abs=1e-9)
    assert other.energy == pytest.approx(one.energy, rel=1e-8)


def test_moments_balance_the_loads_beyond_every_joint_and_links_keep_their_length():
    force, moment = np.array([0.9, -2.2, 1.4]) * FORCE, np.array([0.3, 0.2, -0.5]) * MOMENT
    bent = bend_in_space(ROD, 19, force, moment=moment, stiffness=STIFFNESS)
    assert bent.moments == pytest.approx(np.cross(bent.tip - bent.joints, force) + moment, abs=1e-7 * MOMENT)
    assert np.linalg.norm(np.diff(bent.joints, axis=0), axis=1) == pytest.approx(np.full(19, L / 19), rel=1e-12)


@pytest.mark.parametrize("size", [0.3, 25.0])
def test_work_of_a_growing_force_is_the_energy_of_a_stepped_rod_that_is_curved_at_rest(size):
    force, step = size * np.array([0.4, 1.1, 0.7]) * FORCE, np.array([0.2, 1.0, -0.5]) * 1e-4 * FORCE
    below, above = (bend_in_space(STEPPED, 5, force + side * step, curvature=twisted) for side in (-1, 1))
    assert above.energy - below.energy == pytest.approx(force @ (above.tip - below.tip), rel=1e-6)


def test_a_deep_cantilever_buckles_sideways_at_prandtls_load():
    """P = 4.0126 sqrt(EI GJ)/L^2 (L. Prandtl 1899), the deep side being rigid."""
    given = {"stiffness": (0.4 * EI, EI, 1e4 * EI)}
    critical = 4.0126 * sqrt(0.4) * EI / L**2
    bent = bend_in_space(ROD, 80, (0.0, 0.998 * critical, 0.0), **given)
    assert bent.displacement[2] == pytest.approx(0.0, abs=1e-9 * L)
    with pytest.raises(InputError, match="force"):
        bend_in_space(ROD, 80, (0.0, 1.002 * critical, 0.0), **given)
    assert bend_in_space(ROD, 80, (0.0, 1.1 * critical, 1e-3 * critical), **given).displacement[2] > 0.1 * L


def test_an_end_moment_of_two_pi_closes_the_circle_of_equal_joints():
    circle = bend_in_space(ROD, 12, moment=(0.0, 0.0, 2 * pi * MOMENT), stiffness=(EI, EI, EI), wall="half")
    assert circle.tip == pytest.approx(np.zeros(3), abs=1e-9 * L)
    assert circle.energy == pytest.approx(2 * pi**2 * MOMENT, rel=1e-9)


def test_without_loads_a_curved_rod_keeps_its_shape():
    bent = bend_in_space(ROD, 40, curvature=twisted)
    assert bent.displacement == pytest.approx(np.zeros(3), abs=1e-12 * L)
    assert bent.tip == pytest.approx(hanging(L, STIFFNESS, np.zeros(3), curvature=twisted)[0], abs=1e-6 * L)


def test_a_straight_rod_at_rest_has_the_frequencies_of_the_linear_chain_in_both_planes():
    planes = [SegmentModel(beam, 14).modes(4).frequencies_hz for beam in (ROD, TURNED)]
    found = bend_in_space(ROD, 14).frequencies_hz(6)
    assert found == pytest.approx(np.sort(np.concatenate(planes))[:6], rel=1e-9)


def test_about_an_equilibrium_its_plane_has_the_frequencies_of_the_planar_chain():
    system, given = build_system(ROD, 14), {"stiffness": (EI, EI, 400 * EI)}
    end = LinkLoad(link=14, at=float(system.lengths[-1]), force=(0.6 * FORCE, 1.8 * FORCE))
    loaded = replace(system, loads=(end,), gravity=(-3.0, 8.0))
    planar = linearise(loaded, solve_static(loaded)).frequencies() / (2 * pi)
    bent = bend_in_space(ROD, 14, (0.6 * FORCE, 0, 1.8 * FORCE), gravity=(-3.0, 0, 8.0), **given)
    away = abs(bent.frequencies_hz(6)[:, None] / planar[:3] - 1)
    assert away.min(axis=0) == pytest.approx(0.0, abs=1e-7)


@pytest.mark.parametrize(("radius", "pitch"), [(L / 2.1, 0.0), (L / 4.1, 0.05)])
def test_arcs_and_helices_at_rest_have_the_frequencies_of_rods_with_order_four(radius, pitch):
    axes = helix(radius, pitch)
    turn = axes(np.zeros(1))[0].T @ [0.0, 0.0, 1.0 / np.hypot(radius, pitch)]
    mass = ROD.mass_per_length
    exact = frequencies(axes, L, lambda s: STIFFNESS, lambda s: mass)[:3] / (2 * pi)
    errors = []
    for n in (25, 50):
        rod = bend_in_space(ROD, n, curvature=lambda s: np.tile(turn, (len(s), 1)), stiffness=STIFFNESS)
        errors.append(rod.frequencies_hz(3) / exact - 1)
    assert np.log2(errors[0] / errors[1]) == pytest.approx(4.0, abs=0.5)
    assert errors[1] == pytest.approx(0.0, abs=2e-6)


@pytest.mark.parametrize(
    ("beam", "settings", "field"),
    [
        (structs.replace(ROD, supports=("pinned", "pinned")), {}, "supports"),
        (structs.replace(ROD, mass=(PointMass(position=0.3, mass=0.1),)), {}, "mass"),
        (ROD, {"force": 1.0}, "force"),
        (ROD, {"moment": (0.0, np.nan, 0.0)}, "moment"),
        (ROD, {"count": 1}, "count"),
        (ROD, {"curvature": lambda s: s}, "curvature"),
        (ROD, {"curvature": 3.0}, "curvature"),
        (ROD, {"stiffness": -1.0}, "GJ and two EI"),
        (ROD, {"stiffness": (1.0, 0.0, 2.0)}, "stiffness"),
        (STEPPED, {"stiffness": (1.0, 1.0, 2.0)}, "stiffness"),
    ],
)
def test_bad_bending_in_space_is_refused_by_field(beam, settings, field):
    with pytest.raises(InputError, match=field):
        bend_in_space(beam, **{"count": 10, "force": (0.0, 0.0, 1.0), **settings})


def test_frequencies_under_a_moment_are_refused():
    with pytest.raises(InputError, match="moment"):
        bend_in_space(ROD, 10, moment=(MOMENT, 0.0, 0.0)).frequencies_hz()
