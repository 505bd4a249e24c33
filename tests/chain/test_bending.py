"""A cantilever of links under large dead loads: the elastica, circles, small loads, buckling, what is refused."""

import numpy as np
import pytest
from chain_reference import elastica_tip
from msgspec.structs import replace
from scipy.integrate import solve_ivp
from scipy.optimize import brentq, minimize

from verify import segment_model
from verify.attached import PointMass
from verify.beam import Beam
from verify.chain.bending import bend
from verify.chain.problems import cantilever_tip
from verify.errors import InputError
from verify.section import Section

ROD = Beam(
    length=0.83, width=0.013, thickness=0.0021, youngs_modulus=113e9, density=4470.0, supports=("clamped", "free")
)
L, EI = ROD.length, ROD.bending_stiffness
UNIT = EI / L**2


def test_the_tip_under_a_dead_load_of_four_is_that_of_the_chain_and_near_the_elasticas():
    """P L^2 / EI = 4: w / L = 0.669964 and 1 - x / L = 0.328944 (Bisshopp and Drucker); 80 links have 0.669954."""
    found = bend(ROD, 80, 4.0 * UNIT)
    assert found.deflection / L == pytest.approx(0.669954, abs=5e-7)
    assert found.shortening / L == pytest.approx(0.328944, abs=5e-7)
    assert (found.deflection / L, found.shortening / L) == pytest.approx(elastica_tip(4.0), abs=2e-5)
    assert found.deflection / L - 0.669964 == pytest.approx(-1.0e-5, abs=0.1e-5)
    unit = cantilever_tip(4.0, 80)
    assert (found.deflection / L, found.shortening / L) == pytest.approx((unit.deflection, unit.shortening), rel=1e-10)


def test_the_tip_tends_to_the_elastica_with_order_two():
    exact = elastica_tip(2.7)[0]
    errors = [bend(ROD, n, 2.7 * UNIT).deflection / L - exact for n in (20, 40)]
    assert errors[0] / errors[1] == pytest.approx(4.0, rel=0.05)


def test_joints_lie_a_link_apart_and_end_at_the_tip():
    found = bend(ROD, 23, (0.7 * UNIT, -3.1 * UNIT), moment=0.4 * EI / L)
    assert found.joints.shape == (24, 2)
    assert np.array_equal(found.joints[0], [0.0, 0.0])
    assert np.hypot(*np.diff(found.joints, axis=0).T) == pytest.approx(np.full(23, L / 23), rel=1e-12)
    assert np.array_equal(found.tip, found.joints[-1])
    assert found.shortening == L - found.tip[0]
    assert found.angles == pytest.approx(np.arctan2(*np.diff(found.joints, axis=0).T[::-1]), abs=1e-12)


def test_every_joint_carries_the_moment_of_the_load_about_where_it_lies():
    along, across, moment = 0.7 * UNIT, -3.1 * UNIT, 0.4 * EI / L
    found = bend(ROD, 23, (along, across), moment=moment)
    arm = found.tip - found.joints
    assert found.moments == pytest.approx(
        arm[:, 0] * across - arm[:, 1] * along + moment, abs=1e-7 * abs(found.moments).max()
    )
    assert found.curvature == pytest.approx(found.moments / EI, rel=1e-14)


def test_a_moment_bends_an_even_circle_and_2_pi_closes_it():
    found = bend(ROD, 12, moment=2 * np.pi * EI / L, wall="half")
    assert np.hypot(*found.tip) < 1e-12 * L
    assert found.curvature == pytest.approx(np.full(13, 2 * np.pi / L), rel=1e-9)
    assert found.energy == pytest.approx(0.5 * EI * (2 * np.pi / L) ** 2 * L, rel=1e-9)
    assert found.turn == pytest.approx(2 * np.pi, rel=1e-9)
    assert found.angles == pytest.approx(2 * np.pi * (np.arange(12) + 0.5) / 12, rel=1e-9)  # at the links' middles


@pytest.mark.parametrize("wall", ["gregory", "half", "third-order"])
@pytest.mark.parametrize("moment", [0.0, 0.83, -1.7])
def test_turn_and_energy_tend_to_the_elasticas_with_order_two(wall, moment):
    load = (0.6 * UNIT, 2.3 * UNIT)
    turn, energy = elastica_under(*load, moment * EI / L)
    found = [bend(ROD, n, load, moment=moment * EI / L, wall=wall) for n in (30, 60, 120)]
    for exact, told in ((turn, [one.turn for one in found]), (energy, [one.energy for one in found])):
        off = np.array(told) / exact - 1
        assert abs(off[-1]) < 3e-4
        assert off[0] / off[1] == pytest.approx(4.0, rel=0.25)
        assert off[1] / off[2] == pytest.approx(4.0, rel=0.12)


@pytest.mark.parametrize("moment", [0.83, -1.7])
def test_what_load_and_moment_do_is_what_the_rod_takes_up(moment):
    """To every moment a little more: dE = F . d(tip) + M d(turn), whatever the count."""
    rod = replace(ROD, section=(Section(length=0.33), Section(length=0.5, thickness=0.0013)))
    force, step = np.array([0.2, 0.7]) * UNIT, 1e-4 * EI / L
    below, above = (bend(rod, 9, force, moment=moment * EI / L + side * step) for side in (-1, 1))
    work = force @ (above.tip - below.tip) + moment * EI / L * (above.turn - below.turn)
    assert above.energy - below.energy == pytest.approx(work, rel=1e-5)


def elastica_under(along, across, moment):
    """(turn of the tip, energy) of the rod by shooting: EI theta' = M, M' = along sin(theta) - across cos(theta)."""

    def integrated(clamp):
        def rate(s, state):
            theta, bent, _ = state
            return bent / EI, along * np.sin(theta) - across * np.cos(theta), bent**2 / (2 * EI)

        return solve_ivp(rate, (0.0, L), (0.0, clamp, 0.0), method="DOP853", rtol=1e-12, atol=1e-14).y[:, -1]

    size = (abs(across) + abs(along)) * L + abs(moment)
    clamp = brentq(lambda clamp: integrated(clamp)[1] - moment, moment - 0.1 * size, moment + size, xtol=1e-13)
    return tuple(integrated(clamp)[[0, 2]])


def test_a_small_load_bends_as_the_linear_cantilever_and_stores_half_its_work():
    force = 1e-4 * UNIT
    found = bend(ROD, 200, force)
    assert found.deflection == pytest.approx(force * L**3 / (3 * EI), rel=1e-4)
    assert found.energy == pytest.approx(0.5 * force * found.deflection, rel=1e-6)
    assert found.curvature[0] == pytest.approx(force * L / EI, rel=1e-7)


def test_a_pull_along_stiffens_and_a_push_bends_further():
    plain = bend(ROD, 40, (0.0, 1.3 * UNIT)).deflection
    assert bend(ROD, 40, 1.3 * UNIT).deflection == plain
    assert bend(ROD, 40, (2.0 * UNIT, 1.3 * UNIT)).deflection < 0.7 * plain
    assert bend(ROD, 40, (-1.0 * UNIT, 1.3 * UNIT)).deflection > 1.2 * plain


def test_a_stepped_rod_bends_by_the_stiffness_of_its_pieces():
    """A small tip load: w = integral of F (L - x)^2 / EI."""
    rod = replace(ROD, section=(Section(length=0.33), Section(length=0.5, thickness=0.0013)))
    force, soft = 1e-4 * UNIT, EI * (0.0013 / 0.0021) ** 3
    found = bend(rod, 83, force)
    expected = force * (((L**3 - 0.5**3) / EI) + 0.5**3 / soft) / 3
    assert found.deflection == pytest.approx(expected, rel=2e-3)
    at = int(np.searchsorted(np.linspace(0, L, 84), 0.33 + 1e-9)) - 1
    assert found.curvature[at] == pytest.approx(found.moments[at] / soft, rel=1e-12)
    assert found.curvature[at - 1] == pytest.approx(found.moments[at - 1] / EI, rel=1e-12)


def test_a_rod_given_by_its_stiffness_alone_bends_alike():
    plain = Beam(length=L, bending_stiffness=EI, mass_per_length=0.17, supports=("clamped", "free"))
    assert bend(plain, 31, 2.2 * UNIT).tip == pytest.approx(bend(ROD, 31, 2.2 * UNIT).tip, rel=1e-9)


def test_losses_do_not_matter_at_rest_and_numpys_whole_numbers_are_counts():
    lossy = replace(ROD, loss_factor=0.02)
    assert np.array_equal(bend(lossy, np.int64(15), [0.0, UNIT]).joints, bend(ROD, 15, UNIT).joints)


STRUT = Beam(
    length=0.3, width=0.015, thickness=0.002, youngs_modulus=110e9, density=4500.0, supports=("clamped", "free")
)


class Links:
    """The same chain of 20 links written out: wall joint 2EI/l, energy, its gradient and its second derivatives."""

    def __init__(self, along, across, moment=0.0, count=20):
        self.along, self.across, self.moment, self.l = along, across, moment, STRUT.length / count
        self.k = np.full(count, STRUT.bending_stiffness / self.l)
        self.k[0] *= 2.0

    def tip(self, theta):
        return self.l * np.array([np.cos(theta).sum(), np.sin(theta).sum()])

    def energy(self, theta):
        x, y = self.tip(theta)
        joints = 0.5 * self.k @ np.diff(theta, prepend=0.0) ** 2
        return joints - self.along * (x - STRUT.length) - self.across * y - self.moment * theta[-1]

    def gradient(self, theta):
        joints = self.k * np.diff(theta, prepend=0.0)
        turned = self.l * (self.along * np.sin(theta) - self.across * np.cos(theta))
        return joints - np.append(joints[1:], self.moment) + turned

    def lowest(self, theta):
        beside = np.diag(self.k[1:], 1)
        loads = self.l * (self.along * np.cos(theta) + self.across * np.sin(theta))
        return np.linalg.eigvalsh(np.diag(self.k + np.append(self.k[1:], 0.0) + loads) - beside - beside.T)[0]

    def least(self, start):
        found = minimize(self.energy, start, jac=self.gradient, method="BFGS", options={"gtol": 1e-9, "maxiter": 5000})
        return self.tip(found.x)


@pytest.mark.parametrize(
    ("along", "across", "moment"),
    [
        (-50.0, 5.0, 0.0),
        (-50.0, -1.0, 0.0),
        (-31.0, 1e-9, 0.0),
        (-50.0, 1e-9, 0.0),
        (-100.0, 1.0, 0.0),
        (-400.0, 20.0, 0.0),
        (-60.0, -3.0, 2.0),
        (-50.0, 0.0, -1e-5),
        (-30.0, 0.5, 0.0),
    ],
)
def test_beyond_its_buckling_load_a_cantilever_lies_where_its_energy_is_least_on_the_side_it_is_pushed_to(
    along, across, moment
):
    """Against the least energy of the links, by BFGS from an arc to that side; Euler's load is 30.16 N."""
    links = Links(along, across, moment)
    found = bend(STRUT, 20, (along, across), moment=moment, wall="half")
    side = np.sign(across * STRUT.length / 3.0 + moment / 2.0)  # of the small deflection
    assert np.sign(found.deflection) == side
    assert links.lowest(found.angles) > 0.0
    assert abs(links.gradient(found.angles)).max() < 1e-9
    assert found.tip == pytest.approx(links.least(side * np.linspace(0.01, 0.5, 20)), abs=1e-6)


def test_a_strut_pushed_at_50_newton_and_5_across_bends_to_its_left_as_it_was_worked_out():
    """Least energy, found outside this suite: (0.0728, 0.2426) m and -3.87 J; it stood at y = -0.0598 m, unstable."""
    found = bend(STRUT, 20, (-50.0, 5.0), wall="half")
    assert found.tip == pytest.approx([0.0728, 0.2426], abs=5e-5)
    assert found.energy + 50.0 * (found.tip[0] - 0.3) - 5.0 * found.deflection == pytest.approx(-3.87, abs=5e-3)


def test_a_moment_against_the_force_leads_to_one_side_or_the_other_as_either_is_larger():
    tips = [bend(STRUT, 20, (-60.0, -3.0), moment=moment).deflection for moment in (0.5, 0.7)]
    assert tips[0] < -0.2
    assert tips[1] > 0.2


@pytest.mark.parametrize("along", [-31.0, -50.0, -400.0])
def test_a_straight_strut_beyond_its_buckling_load_is_refused_with_the_load_and_what_to_do(along):
    load = segment_model.buckling_load(STRUT, 20, wall="half")
    with pytest.raises(InputError) as found:
        bend(STRUT, 20, (along, 0.0), wall="half")
    assert f"load = ({along!r}, 0.0) N pushes" in str(found.value)
    assert f"its buckling load of {load:.6g} N" in str(found.value)
    assert "give a small force across" in str(found.value)
    assert bend(STRUT, 20, (-0.9999 * load, 0.0), wall="half").deflection == 0.0
    assert bend(STRUT, 20, (-along, 0.0), wall="half").deflection == 0.0


def test_a_push_to_a_side_that_rounding_would_choose_is_refused():
    with pytest.raises(InputError, match=r"buckles the cantilever \(its buckling load is 30.1\d* N\): at 0.602"):
        bend(STRUT, 20, (-50.0, 1e-30), wall="half")


def test_a_load_that_snaps_under_a_moment_is_refused_with_the_moment_that_grows_with_it():
    """A force of 1000 N across that a moment of 300 N m rolls up the other way."""
    with pytest.raises(InputError) as found:
        bend(STRUT, 9, 1000.0, moment=-300.0, wall="half")
    assert "load = (0.0, 1000.0) N with moment = -300.0 N m buckles" in str(found.value)
    assert "give another moment, or less load" in str(found.value)
    assert bend(STRUT, 9, 1000.0, moment=3.0, wall="half").deflection > 0.0
    assert bend(STRUT, 9, 10.0, moment=-300.0, wall="half").energy > 0.0


@pytest.mark.parametrize(
    ("asked", "said"),
    [
        ({"beam": replace(ROD, supports=("pinned", "pinned"))}, "give ('clamped', 'free')"),
        (
            {"beam": replace(ROD, mass=(PointMass(position=0.2, mass=0.1),))},
            "beam.mass: the nonlinear chain takes none",
        ),
        ({"load": (1.0, 2.0, 3.0)}, "load = (1.0, 2.0, 3.0): give one number"),
        ({"load": "heavy"}, "load = 'heavy'"),
        ({"load": np.nan}, "newton"),
        ({"moment": np.inf}, "moment = inf"),
        ({"count": 1}, "count = 1: give a whole number of at least 2"),
        ({"count": 2.5}, "count = 2.5"),
        ({"count": 10**6}, "segments = 1000000"),
        ({"wall": "wall"}, "wall = 'wall'"),
        ({"wall": "welded"}, "welded"),
        ({"load": 1e12}, "no equilibrium found"),
        ({"beam": replace(ROD, tension=3.0)}, "beam.tension = 3.0 N: bend takes it as load = (along, across)"),
        ({"joints": "tensioned"}, "joints = 'tensioned' are of a beam.tension"),
    ],
    ids=str,
)
def test_bad_input_is_refused_in_one_sentence(asked, said):
    with pytest.raises(InputError) as found:
        bend(**{"beam": ROD, "count": 9, "load": UNIT, **asked})
    assert said in str(found.value)
    assert "\n" not in str(found.value)
