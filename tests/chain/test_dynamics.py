"""The nonlinear chain: its accelerations, its closure, its equilibria, its linearisation, and what it refuses."""

from dataclasses import replace
from time import process_time

import numpy as np
import pytest
from chain_reference import by_multipliers, by_partitioning, elastica_tip
from hypothesis import given, settings
from hypothesis import strategies as st
from interpreted import interpreted
from mpmath import mp
from scipy.special import jn_zeros

from verify.beam import Beam, PointForce
from verify.chain import recursion_kernels
from verify.chain.dynamics import (
    accelerated,
    accelerations,
    at_rest,
    choose_pivots,
    energies,
    held_rows,
    keep_pivots,
    linearise,
    positions,
    project,
)
from verify.chain.statics import solve_static
from verify.chain.system import Actuator, ChainState, ChainSystem, LinkLoad, Rotation, build_system
from verify.errors import InputError
from verify.segments import linear as segment_model
from verify.segments.assembly import build_chain, chain_pencil
from verify.segments.links import mass_matrix


def beam(left="pinned", right="pinned", **more):
    return Beam(
        length=0.43, width=0.017, thickness=0.0013, youngs_modulus=68e9, density=2650.0, supports=(left, right), **more
    )


def odd_chain(seed, n, **more):
    """Links, springs, dashpots and loads without any symmetry."""
    rng = np.random.default_rng(seed)
    lengths = rng.uniform(0.02, 0.07, n)
    masses = rng.uniform(0.01, 0.04, n)
    link = 1 + n // 2
    return ChainSystem(
        **{
            "lengths": lengths,
            "masses": masses,
            "inertias": masses * lengths**2 * rng.uniform(0.05, 0.2, n),
            "stiffness": rng.uniform(0.5, 4.0, n),
            "dashpots": rng.uniform(0.0, 2e-3, n),
            "gravity": (0.7, -9.81),
            "rotation": Rotation(offset=0.1, rate=0.3, amplitude=0.2, frequency_hz=7.0, phase_deg=20.0),
            "loads": (
                LinkLoad(link=n, at=0.3 * lengths[-1], force=(0.2, -0.4), moment=0.013),
                LinkLoad(link=link, at=0.9 * lengths[link - 1], force=(-0.1, 0.5), frequency_hz=31.0, phase_deg=40.0),
            ),
            **more,
        }
    )


HELD = {
    "free tip": {},
    "roller": {"tip": "roller"},
    "roller with an axial spring": {"tip": "roller", "axial_spring": 57.0},
    "transverse inertia alone": {"tip": "roller", "axial_inertia": False},
    "transverse inertia alone, free tip, axial load": {"axial_inertia": False},
}
MOVED = {
    "an actuator": {"actuators": (Actuator(link=2, at=0.01, amplitude=1e-3, frequency_hz=40.0, phase_deg=10.0),)},
    "two actuators and a roller": {
        "tip": "roller",
        "actuators": (
            Actuator(link=2, at=0.013, amplitude=1e-3, frequency_hz=40.0, phase_deg=10.0),
            Actuator(link=5, at=0.005, amplitude=-2e-3, frequency_hz=23.0),
        ),
    },
}


def some_state(system, seed):
    rng = np.random.default_rng(100 + seed)
    n = system.n_links
    return ChainState(rng.normal(0, 0.4, n), rng.normal(0, 5.0, n), 0.0137)


@pytest.mark.parametrize("n", [1, 2, 3, 8, 17])
@pytest.mark.parametrize("kind", HELD)
def test_the_recursion_agrees_with_elimination_by_multipliers(kind, n):
    system = odd_chain(n, n, **HELD[kind])
    state = some_state(system, n)
    expected = by_multipliers(system, state.time, state.angles, state.rates)
    assert accelerations(system, state) == pytest.approx(expected, rel=1e-10, abs=1e-11 * abs(expected).max())


@pytest.mark.parametrize("kind", MOVED)
@pytest.mark.parametrize("axial", [True, False])
def test_actuators_agree_with_elimination_by_multipliers(kind, axial):
    system = odd_chain(5, 8, axial_inertia=axial, **MOVED[kind])
    state = some_state(system, 5)
    expected = by_multipliers(system, state.time, state.angles, state.rates)
    assert accelerations(system, state) == pytest.approx(expected, rel=1e-10, abs=1e-11 * abs(expected).max())


@pytest.mark.parametrize("dependent", [[0], [3], [6]])
def test_elimination_by_any_dependent_angle_gives_the_same_accelerations(dependent):
    system = odd_chain(3, 7, tip="roller", axial_spring=31.0)
    state = project(system, some_state(system, 3))[0]
    expected = by_partitioning(system, state.time, state.angles, state.rates, dependent)
    assert accelerations(system, state) == pytest.approx(expected, rel=1e-8, abs=1e-9 * abs(expected).max())


@settings(max_examples=25, deadline=None)
@given(st.integers(0, 10_000), st.integers(2, 14), st.booleans(), st.booleans())
def test_the_recursion_holds_for_any_chain(seed, n, roller, axial):
    system = odd_chain(seed, n, tip="roller" if roller else "free", axial_inertia=axial)
    state = some_state(system, seed)
    expected = by_multipliers(system, state.time, state.angles, state.rates)
    assert abs(accelerations(system, state) - expected).max() <= 1e-9 * abs(expected).max()


def test_cosine_and_sine_of_an_angle_are_right_to_rounding_on_both_sides_of_where_series_end():
    angles = np.concatenate([np.linspace(0.37, 0.5, 500, endpoint=False), np.linspace(0.5, 0.6, 100)])
    direction = interpreted(recursion_kernels, "direction")
    for angle in (*angles, *-angles, *np.geomspace(1e-9, 0.37, 200)):
        cosine, sine = direction(angle)
        assert abs(cosine - float(mp.cos(angle))) <= 1.2e-16
        assert abs(sine - float(mp.sin(angle))) <= 6e-17


def test_an_evaluation_costs_in_proportion_to_the_links():
    """Side by side: twenty times the links may cost at most 20^1.1 of the time, and an allowance for noise."""

    def seconds(n):
        answer, still = accelerated(build_system(beam(), n)), np.zeros(n)
        start = process_time()
        for _ in range(10_000_000 // n // 50):
            answer(0.0, still, still)
        return (process_time() - start) * n

    seconds(500)
    few, many = (min(found) for found in zip(*[(seconds(500), seconds(10_000)) for _ in range(9)], strict=True))
    assert many / few < 1.5 * 20**1.1


@pytest.mark.parametrize("dependent", [1, 4, 9])
def test_projection_moves_the_dependent_angle_alone_and_meets_the_roller(dependent):
    system = odd_chain(9, 9, tip="roller", rotation=Rotation(offset=0.003))
    state = some_state(system, 2)
    angles = 0.04 * state.angles
    found, moved = project(system, ChainState(angles, state.rates, state.time), [dependent])
    place, speed = positions(system, found)
    assert abs(place[-1, 1]) < 1e-14
    assert abs(speed[-1, 1]) < 1e-13
    others = np.arange(9) != dependent - 1
    assert np.array_equal(found.angles[others], angles[others])
    assert moved > 1e-3


def test_a_state_on_its_points_is_left_where_it_is():
    system = odd_chain(9, 9, tip="roller")
    first, _ = project(system, ChainState(0.2 * some_state(system, 2).angles, np.zeros(9)))
    again, moved = project(system, first)
    assert moved < 1e-15
    assert again.angles == pytest.approx(first.angles, abs=1e-15)


def test_the_base_joint_is_the_best_pivot_of_a_straight_chain():
    system = build_system(beam(), 12)
    rows = held_rows(system, at_rest(system))
    assert rows[0] == pytest.approx(0.43 * (1 - np.arange(12) / 12))
    assert list(choose_pivots(rows)) == [0]


def test_dependent_angles_are_kept_until_their_lever_arms_are_short():
    rows = np.array([[1.0, 0.7, 0.05], [0.4, 0.3, 0.0]])
    assert list(keep_pivots(rows[:1], np.array([1]))) == [1]
    assert list(keep_pivots(rows[:1], np.array([2]))) == [0]
    assert sorted(choose_pivots(rows)) == [0, 1]
    assert list(keep_pivots(rows, np.array([2, 1]))) == [2, 1]
    assert sorted(keep_pivots(np.array([[1.0, 0.7, 0.005], [0.4, 0.1, 0.0]]), np.array([1, 2]))) == [0, 1]


def test_points_that_cannot_be_held_at_once_are_refused():
    twice = (Actuator(link=2, at=0.01), Actuator(link=2, at=0.01, amplitude=1e-3))
    system = odd_chain(4, 6, actuators=twice)
    with pytest.raises(InputError, match="cannot be held at once"):
        at_rest(system)


@pytest.mark.parametrize("supports", [("pinned", "pinned"), ("clamped", "free"), ("clamped", "pinned")])
def test_at_rest_the_linearisation_is_the_segment_model(supports):
    which, n = beam(*supports), 14
    system = build_system(which, n)
    linear = linearise(system, at_rest(system))
    chain = build_chain(which, n)
    pencil = chain_pencil(chain)
    # angles to positions adds up, the other way takes differences: the mass matrix is compared where nothing cancels
    all_free = build_chain(beam("free", "free"), n)
    places = np.vstack([np.zeros(n), np.tril(np.ones((n, n))) @ np.diag(system.lengths) @ np.tril(np.ones((n, n)))])
    mass = places.T @ mass_matrix(all_free, dense=True) @ places * which.mass_per_length * chain.unit
    assert linear.mass == pytest.approx(mass, rel=1e-13)
    joints = 1.0 / chain.compliances[:-1] * which.bending_stiffness / chain.unit
    assert linear.stiffness == pytest.approx(np.diag(joints), rel=1e-15)
    exact = 2 * np.pi * segment_model.solve_modes(which, pencil.n, n).frequencies_hz
    assert linear.frequencies() == pytest.approx(exact, rel=3e-11)


@pytest.mark.parametrize("axial_inertia", [True, False])
def test_the_linearisation_is_the_derivative_of_the_accelerations_at_a_bent_equilibrium(axial_inertia):
    """Without inertia along x masses depend on the directions themselves, that of the base among them."""
    system = odd_chain(
        11,
        6,
        axial_inertia=axial_inertia,
        tip="roller",
        axial_spring=40.0,
        rotation=Rotation(offset=0.2),
        loads=(LinkLoad(link=3, at=0.01, force=(0.3, 2.0), moment=0.02),),
    )
    rest = solve_static(system)
    assert abs(np.cumsum(rest.angles)).max() > 0.1
    linear = linearise(system, rest)
    basis = linear.independent()
    step, own = 1e-5, np.zeros((5, 5))
    for j, direction in enumerate(basis.T):
        ahead, behind = (
            accelerations(system, project(system, ChainState(rest.angles + sign * step * direction, np.zeros(6)))[0])
            for sign in (1, -1)
        )
        own[:, j] = np.linalg.lstsq(basis, (ahead - behind) / (2 * step), rcond=None)[0]
    mass, stiffness = (basis.T @ m @ basis for m in (linear.mass, linear.stiffness))
    assert own == pytest.approx(-np.linalg.solve(mass, stiffness), rel=1e-5, abs=1e-6 * abs(own).max())


@pytest.mark.parametrize(("n", "exact"), [(1, [1.5**0.5]), (2, [1.21013484, 3.24585485])])
def test_a_hanging_chain_of_one_and_two_links_swings_as_known(n, exact):
    assert hanging(n) == pytest.approx(exact, rel=5e-9)


def hanging(n, length=0.83, g=9.81):
    lengths, masses = np.full(n, length / n), np.full(n, 0.31 / n)
    still = np.zeros(n)
    system = ChainSystem(
        lengths=lengths,
        masses=masses,
        inertias=masses * lengths**2 / 12,
        stiffness=still,
        dashpots=still,
        gravity=(g, 0.0),
    )
    return linearise(system, at_rest(system)).frequencies() * np.sqrt(length / g)


@pytest.mark.parametrize("mode", [1, 2, 3])
def test_a_long_hanging_chain_tends_to_the_bessel_limit_with_order_two(mode):
    limit = jn_zeros(0, mode)[-1] / 2
    errors = [hanging(n)[mode - 1] / limit - 1 for n in (40, 80)]
    assert np.log2(errors[0] / errors[1]) == pytest.approx(2.0, abs=0.05)
    assert abs(errors[1]) < 1e-3 * mode**2


@pytest.mark.parametrize("load", [0.3, 2.0, 7.0])
def test_a_cantilever_under_a_dead_tip_load_is_the_elastica_with_order_two(load):
    which = beam("clamped", "free")
    errors = []
    for n in (20, 40):
        system = build_system(which, n)
        force = load * which.bending_stiffness / which.length**2
        system = replace(system, loads=(LinkLoad(link=n, at=float(system.lengths[-1]), force=(0.0, force)),))
        tip = positions(system, solve_static(system))[0][-1] / which.length
        errors.append(np.array([tip[1], 1 - tip[0]]) - elastica_tip(load))
    assert abs(errors[1]).max() < 3e-4
    assert np.log2(errors[0][0] / errors[1][0]) == pytest.approx(2.0, abs=0.15)


@pytest.mark.parametrize(("wall", "gap"), [("half", 0.0), ("gregory", 1.4e-3)])
def test_an_end_moment_rolls_a_cantilever_up(wall, gap):
    which, n = beam("clamped", "free"), 20
    system = build_system(which, n, wall=wall)
    moment = 2 * np.pi * which.bending_stiffness / which.length
    system = replace(system, loads=(LinkLoad(link=n, at=0.0, moment=moment),))
    tip = positions(system, solve_static(system))[0][-1] / which.length
    assert np.hypot(*tip) == pytest.approx(gap, rel=0.05, abs=1e-12)


def test_the_roller_ended_chain_buckles_at_its_own_load():
    """Rigid links with springs k at the joints: P = 4 k / l sin^2(pi / 2N), a shade below pi^2 EI / L^2."""
    which, n = beam(), 9
    system = build_system(which, n)
    spring, length = system.stiffness[1], system.lengths[0]
    critical = 4 * spring / length * np.sin(np.pi / (2 * n)) ** 2

    def lowest(share):
        pressed = replace(system, loads=(LinkLoad(link=n, at=float(length), force=(-share * critical, 0.0)),))
        return linearise(pressed, at_rest(pressed)).frequencies()[0]

    assert (lowest(0.75) / lowest(0.0)) ** 2 == pytest.approx(0.25, rel=2e-3)
    assert lowest(1 - 1e-7) < 4e-4 * lowest(0.0)
    with pytest.raises(InputError, match="unstable"):
        lowest(1.001)


def test_an_equilibrium_stands_still_whatever_holds_it():
    for kind in (
        {"tip": "roller", "axial_spring": 80.0},
        {},
        {"actuators": (Actuator(link=4, at=0.01, amplitude=0.02),)},
    ):
        system = odd_chain(21, 9, rotation=Rotation(offset=-0.2), **kind)
        system = replace(system, loads=system.loads[:1])
        rest = solve_static(system)
        still = accelerations(system, rest)
        unbent = accelerations(system, at_rest(system))
        assert abs(still).max() < 1e-7 * abs(unbent).max()


def test_the_load_is_raised_in_parts_where_it_must_be():
    which = beam("clamped", "free")
    system = build_system(which, 30)
    force = 60.0 * which.bending_stiffness / which.length**2
    system = replace(system, loads=(LinkLoad(link=30, at=float(system.lengths[-1]), force=(0.0, force)),))
    tip = positions(system, solve_static(system))[0][-1] / which.length
    assert tip[1] == pytest.approx(elastica_tip(60.0)[0], abs=2e-3)


def test_a_mechanism_without_equilibrium_is_refused():
    system = build_system(beam("pinned", "free"), 6)
    with pytest.raises(InputError, match="no equilibrium found"):
        solve_static(replace(system, loads=(LinkLoad(link=3, at=0.0, moment=0.2),)))


def test_ten_thousand_links_find_their_equilibrium():
    which, n = beam("clamped", "free"), 10_000
    system = build_system(which, n)
    force = 4.0 * which.bending_stiffness / which.length**2
    system = replace(system, loads=(LinkLoad(link=n, at=float(system.lengths[-1]), force=(0.0, force)),))
    tip = positions(system, solve_static(system))[0][-1] / which.length
    assert (tip[1], 1 - tip[0]) == pytest.approx(elastica_tip(4.0), abs=3e-9)


def test_elastic_and_gravitational_energy_are_those_of_the_links():
    system = odd_chain(2, 5, tip="roller", axial_spring=900.0)
    state = project(system, ChainState(np.array([0.4, -0.5, 0.2, -0.3, 0.1]), np.array([2.0, -1.0, 3.0, 0.5, -4.0])))[0]
    joints, speeds = positions(system, state)
    middles, drifts = (joints[1:] + joints[:-1]) / 2, (speeds[1:] + speeds[:-1]) / 2
    spin = np.cumsum(state.rates) + 0.3 + 0.2 * 2 * np.pi * 7.0 * np.cos(np.deg2rad(20.0))
    kinetic, elastic, height = energies(system, state)
    assert kinetic == pytest.approx(0.5 * (system.masses @ (drifts**2).sum(1) + system.inertias @ spin**2))
    spring = 0.5 * 900.0 * (joints[-1, 0] - system.lengths.sum()) ** 2
    assert elastic == pytest.approx(0.5 * system.stiffness @ state.angles**2 + spring)
    assert height == pytest.approx(-system.masses @ (middles @ np.array([0.7, -9.81])))


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"lengths": [0.1, 0.0, 0.1]}, r"chain.lengths of link 2 = 0.0: give a finite number, above 0"),
        ({"masses": [0.1, 0.2, 0.0]}, r"chain.masses of link 3 = 0.0"),
        ({"masses": [-0.1, 0.2, 0.1]}, r"chain.masses of link 1 = -0.1"),
        ({"inertias": [1e-5, 0.0, 1e-5]}, r"chain.inertias of link 2 = 0.0"),
        ({"stiffness": [0.0, -1.0, 1.0]}, r"chain.stiffness of link 2 = -1.0: give a finite number, at least 0"),
        ({"dashpots": [0.0, 0.0, -1e-3]}, r"chain.dashpots of link 3 = -0.001"),
        ({"dashpots": [0.0, np.nan, 0.0]}, r"chain.dashpots of link 2 = nan"),
        ({"masses": [0.1, 0.2]}, r"chain.masses has the shape \(2,\): give one value for each of 3 links"),
        ({"loads": (LinkLoad(link=4, at=0.0, force=(0.0, 1.0)),)}, r"load.link = 4: the chain has links 1 to 3"),
        ({"loads": (LinkLoad(link=0, at=0.0, force=(0.0, 1.0)),)}, r"load.link = 0"),
        ({"loads": (LinkLoad(link=2, at=0.11, force=(0.0, 1.0)),)}, r"load.at = 0.11 lies off link 2"),
        ({"actuators": (Actuator(link=5, at=0.0),)}, r"actuator.link = 5"),
        ({"actuators": tuple(Actuator(link=1, at=0.01 * i) for i in range(5))}, r"are 5: give at most 4"),
        ({"tip": "pinned"}, r"sum of l cos theta equals L for theta = 0 alone"),
        ({"axial_spring": 3.0}, r"acts at a roller"),
        ({"axial_spring": -3.0, "tip": "roller"}, r"chain.axial_spring = -3.0"),
        ({"gravity": (0.0, np.inf)}, r"chain.gravity = inf"),
    ],
)
def test_bad_chains_are_refused_with_the_field_and_the_remedy(change, message):
    good = {
        "lengths": [0.1, 0.1, 0.1],
        "masses": [0.1, 0.2, 0.1],
        "inertias": [1e-5] * 3,
        "stiffness": [0.0, 1.0, 1.0],
        "dashpots": [0.0] * 3,
    }
    arrays = {k: np.array(v, dtype=float) if isinstance(v, list) else v for k, v in {**good, **change}.items()}
    with pytest.raises(InputError, match=message):
        ChainSystem(**arrays)


@pytest.mark.parametrize(
    ("make", "message"),
    [
        (lambda: build_system(beam("guided", "pinned"), 9), "starts at a pinned or clamped end"),
        (lambda: build_system(beam("pinned", "clamped"), 9), "ends free or pinned"),
        (lambda: build_system(beam("clamped", "free"), 9, wall="welded"), "choose another wall"),
        (lambda: build_system(beam(), 9, joint_dashpot=-1.0), "joint_dashpot = -1.0"),
        (lambda: build_system(beam(), 9, [PointForce(position=0.44)], 10.0), "lies off the beam"),
        (lambda: LinkLoad(link=1, at=0.0, force=(np.nan, 0.0)), "load.force x = nan"),
        (lambda: project(odd_chain(1, 4, tip="roller"), ChainState(np.zeros(4), np.zeros(4)), [5]), "between 1 and 4"),
        (lambda: project(odd_chain(1, 4), ChainState(np.zeros(3), np.zeros(4))), "state.angles: give 4"),
        (lambda: accelerations(odd_chain(1, 2), ChainState(np.zeros(2), np.array([0.0, np.nan]))), "state.rates"),
    ],
)
def test_bad_requests_are_refused(make, message):
    with pytest.raises(InputError, match=message):
        make()


@pytest.mark.parametrize("sign", [-1.0, 1.0])
def test_one_large_angle_of_either_sign_takes_the_cosines_of_all(sign):
    """The series of small ones is off by 1e-3 at two quarters of a turn."""
    angles, work = sign * np.array([0.1, 3.1, 0.4]), np.zeros((3, 2))
    interpreted(recursion_kernels, "cosines")(angles, work)
    assert work == pytest.approx(np.stack([np.cos(angles), np.sin(angles)], axis=1), abs=2e-16)
