"""Masses, springs, elastic ends, axial force and ground on a chain of rigid links, against beams by their states."""

from math import pi, sin
from time import process_time

import numpy as np
import pytest
from msgspec.structs import replace
from states_reference import frequency_near

from verify.attached import PointMass, PointSpring
from verify.beam import Beam
from verify.errors import InputError
from verify.models.catalogue import MODELS
from verify.section import Section
from verify.segments import carried, loaded
from verify.segments.assembly import build_chain, chain_pencil
from verify.segments.attached import felt_at, mended, places_on
from verify.segments.buckling import buckling_load
from verify.segments.linear import n_elastic, solve_modes, unknowns

L, EI, RHO_A = 0.73, 3.7, 0.31
M = RHO_A * L
STRIP = Beam(length=L, bending_stiffness=EI, mass_per_length=RHO_A)
ENDS = {
    "PP": ("pinned", "pinned"),
    "CF": ("clamped", "free"),
    "FF": ("free", "free"),
    "CC": ("clamped", "clamped"),
    "GP": ("guided", "pinned"),
    "PF": ("pinned", "free"),
}


LADEN = replace(
    STRIP,
    supports=("clamped", "free"),
    tension=3.0,
    foundation=40.0,
    rotary_inertia=3e-4,
    shear_stiffness=900.0,
    mass=(PointMass(position=0.31 * L, mass=0.2 * M), PointMass(position=L, mass=0.1 * M, rotary_inertia=2e-4)),
    spring=(PointSpring(position=0.62 * L, stiffness=60.0, rotational=1.3),),
)


def mass(at, **given):
    return {"mass": (PointMass(position=at * L, **given),)}


def spring(at, **given):
    return {"spring": (PointSpring(position=at * L, **given),)}


def a_mass(at):
    return mass(at, mass=0.4 * M)


def a_spring(at):
    return spring(at, stiffness=200 * EI / L**3)


def a_rotary_inertia(at):
    return mass(at, rotary_inertia=0.01 * M * L**2)


def a_rotational_spring(at):
    return spring(at, rotational=8 * EI / L)


def errors(beam, mode, counts, theory="euler-bernoulli", **settings):
    found = [solve_modes(beam, mode, n, theory=theory, **settings).frequencies_hz[-1] for n in counts]
    exact = frequency_near(beam, theory, found[-1])
    return [f / exact - 1 for f in found]


def order(beam, mode, counts, theory="euler-bernoulli", **settings):
    first, second = errors(beam, mode, counts, theory, **settings)
    return np.log(abs(first / second)) / np.log(counts[1] / counts[0])


@pytest.mark.parametrize("what", [a_mass, a_spring, a_rotary_inertia, a_rotational_spring], ids=lambda f: f.__name__)
@pytest.mark.parametrize("supports", ["PP", "FF", "GP"])
@pytest.mark.parametrize(("at", "counts"), [(3 / 8, (80, 160)), (1 / 3, (100, 400))], ids=["on a joint", "between"])
def test_whatever_stands_inside_keeps_order_four(what, supports, at, counts):
    """On a joint, and a third of a link off one."""
    beam = replace(STRIP, supports=ENDS[supports], **what(at))
    assert order(beam, 1, counts) == pytest.approx(4.0, abs=0.15)


@pytest.mark.parametrize(
    ("what", "mode", "expected"),
    [
        (a_mass, 1, 8.9e-11),
        (a_mass, 3, -2.3e-8),
        (a_spring, 1, -3.7e-10),
        (a_rotary_inertia, 1, -1.0e-9),
        (a_rotary_inertia, 3, -2.5e-6),
        (a_rotational_spring, 1, 3.2e-8),
        (a_rotational_spring, 3, 4.5e-7),
    ],
)
def test_errors_on_a_cantilever_of_eighty_segments(what, mode, expected):
    """Whose order changes along the way, as without anything on it, where Gregory's joints change sign."""
    beam = replace(STRIP, supports=ENDS["CF"], **what(3 / 8))
    assert errors(beam, mode, (80,))[0] == pytest.approx(expected, rel=0.06)


@pytest.mark.parametrize(
    ("what", "at", "count", "expected", "band"),
    [
        (a_mass, 3 / 8, (80, 160), 2.0, 0.03),
        (a_spring, 3 / 8, (80, 160), 2.0, 0.03),
        (a_rotary_inertia, 3 / 8, (80, 160), 1.05, 0.05),
        (a_rotational_spring, 3 / 8, (80, 160), 1.0, 0.05),
        (a_rotary_inertia, 1 / 3, (40, 160), 1.0, 0.05),
        (a_rotational_spring, 1 / 3, (40, 160), 1.0, 0.05),
    ],
)
def test_a_rigid_link_as_it_is_costs_two_orders_and_three_where_something_turns(what, at, count, expected, band):
    beam = replace(STRIP, **what(at))
    assert order(beam, 1, count, attachment="lever") == pytest.approx(expected, abs=band)


def test_the_middle_of_a_link_feels_a_couple_at_order_two():
    beam = replace(STRIP, **a_rotary_inertia(0.5))
    assert order(beam, 3, (81, 161), attachment="lever") == pytest.approx(2.0, abs=0.05)


END_CASES = {
    "a tip mass and its inertia": ("CF", mass(1.0, mass=0.4 * M, rotary_inertia=0.01 * M * L**2), 1, 4.0),
    "an elastic clamp": ("FF", spring(0.0, stiffness=300 * EI / L**3, rotational=5 * EI / L), 3, 3.95),
    "a mass at a guided end": ("GP", a_mass(0.0), 3, 4.0),
    "a spring at a free end": ("PF", spring(1.0, stiffness=20 * EI / L**3), 2, 4.0),
    "a mass at a free end": ("FF", a_mass(0.0), 1, 4.0),
    "a turning spring at a pin": ("PP", spring(0.0, rotational=5 * EI / L), 1, 3.85),
    "a turning spring and an inertia": (
        "PP",
        spring(1.0, rotational=5 * EI / L) | mass(1.0, rotary_inertia=0.01 * M * L**2),
        1,
        3.8,
    ),
}


@pytest.mark.parametrize("case", END_CASES)
def test_what_stands_at_an_end_keeps_order_four(case):
    supports, what, mode, expected = END_CASES[case]
    assert order(replace(STRIP, supports=ENDS[supports], **what), mode, (120, 240)) == pytest.approx(expected, abs=0.1)


def test_a_turning_end_felt_by_its_link_alone_is_of_order_one():
    beam = replace(STRIP, **spring(0.0, rotational=5 * EI / L))
    assert order(beam, 1, (80, 160), attachment="lever") == pytest.approx(1.0, abs=0.03)


def test_a_spring_too_stiff_to_give_is_a_support():
    clamp = spring(0.0, stiffness=1e16 * EI / L**3, rotational=1e16 * EI / L)
    elastic = solve_modes(replace(STRIP, supports=("free", "pinned"), **clamp), 4, 49)
    clamped = solve_modes(replace(STRIP, supports=("clamped", "pinned")), 4, 49)
    assert elastic.frequencies_hz == pytest.approx(clamped.frequencies_hz, rel=1e-11)


@pytest.mark.parametrize("count", [40, 600])
@pytest.mark.parametrize("s", [0.0, 0.27, 0.5])
def test_a_chain_bends_under_a_force_and_a_couple_where_they_act_as_its_beam_does(count, s):
    """Statics of a pinned beam: F a^2 b^2 / 3EIL, M (L^2 - 3ab) / 3EIL, the turn under F by F a b (b - a) / 3EIL."""
    chain = build_chain(STRIP, count)
    at = (round(0.31 * count) + s) / count
    (force,), (turn,) = felt_at(chain, [at * L], "reciprocal")
    couple = np.append(0.0, turn) - np.append(turn, 0.0)
    x = np.arange(1, count) / count
    moment = np.minimum.outer(x, x) * (1 - np.maximum.outer(x, x))  # of a unit force on each joint
    for one, other, exact in (
        (force, force, at**2 * (1 - at) ** 2 / 3),
        (couple * count, couple * count, (1 - 3 * at * (1 - at)) / 3),
        (force, couple * count, at * (1 - at) * (1 - 2 * at) / 3),
    ):
        found = (moment @ one[1:-1]) @ (moment @ other[1:-1]) / count
        assert found == pytest.approx(exact, rel=1e-9)


@pytest.mark.parametrize("rule", ["reciprocal", "lever"])
@pytest.mark.parametrize("steps", [(), (Section(length=0.29), Section(length=L - 0.29, bending_stiffness=2.1 * EI))])
def test_bodies_are_felt_together_where_each_is_alone(rule, steps):
    """On joints, at middles, at ends, beside a step, between: what one feels no other moves."""
    chain = build_chain(replace(STRIP, section=steps), 23)
    places = [0.0, 0.11, 0.2901, 9 * L / 23, 10.5 * L / 23, 0.6, L - 1e-4, L]
    together = felt_at(chain, places, rule)
    for p, place in enumerate(places):
        for found, alone in zip(together, felt_at(chain, [place], rule), strict=True):
            assert found[p] == pytest.approx(alone[0], rel=1e-13, abs=1e-15)


@pytest.mark.parametrize("supports", [("pinned", "pinned"), ("clamped", "free"), ("guided", "pinned")])
def test_two_links_feel_what_stands_on_them_as_rigid_links_do(supports):
    """Too few to mend: of three on weights are those of a curve through their joints."""
    carried = replace(STRIP, supports=supports, mass=(PointMass(position=0.3 * L, mass=0.1, rotary_inertia=1e-4),))
    by_rule = [
        solve_modes(carried, 1, n, attachment=rule).frequencies_hz for n in (2, 3) for rule in ("reciprocal", "lever")
    ]
    assert by_rule[0] == pytest.approx(by_rule[1], rel=1e-12)
    assert by_rule[2] != pytest.approx(by_rule[3], rel=1e-4)


@pytest.mark.parametrize("s", [0.0, 0.3, 1.0])
@pytest.mark.parametrize("link", [0, 7, 21, 39])
def test_a_place_on_a_long_chain_is_felt_by_eight_joints_and_the_links_between_them_alone(link, s):
    """Exactly: not a rounding is left of a sum that is nought."""
    for supports in (("clamped", "free"), ("pinned", "guided"), ("free", "pinned")):
        deflections, turns = (one[0] for one in mended(supports, 40, np.array([link]), np.array([s])))
        for felt, most in ((deflections, 8), (turns, 7)):
            there = np.flatnonzero(felt)
            assert len(there) <= most
            assert len(there) == 0 or np.ptp(there) < most
        assert np.flatnonzero(deflections).size > 0


def test_a_mirrored_beam_with_everything_on_it_has_the_same_frequencies():
    beam = replace(
        STRIP,
        supports=ENDS["CF"],
        tension=3.0,
        foundation=300.0,
        mass=(
            PointMass(position=0.3 * L, mass=0.2 * M, rotary_inertia=0.003),
            PointMass(position=L, rotary_inertia=0.002),
        ),
        spring=(
            PointSpring(position=0.61 * L, stiffness=900.0, rotational=3.0),
            PointSpring(position=L, rotational=2.0),
        ),
    )
    for count in (2, 5, 8, 13, 300):
        here, there = (solve_modes(one, 2, count, joints="tensioned") for one in (beam, beam.mirrored()))
        assert here.frequencies_hz == pytest.approx(there.frequencies_hz, rel=1e-12)


def discrete_hz(mode, count, tension, ground):
    """Pinned ends: rho A omega^2 (1 - 2 s^2/3) = 16 s^4 EI/l^4 + 4 s^2 T/l^2, and k_f beside."""
    square, link = sin(0.5 * pi * mode / count) ** 2, L / count
    bending = (16 * square**2 * EI / link**4 + 4 * square * tension / link**2) / (1 - 2 * square / 3)
    return np.sqrt((bending + ground) / RHO_A) / (2 * pi)


@pytest.mark.parametrize("count", [7, 49, 2000])
@pytest.mark.parametrize("tension", [-61.0, 173.0])
def test_axial_force_and_ground_follow_the_exact_discrete_dispersion(count, tension):
    found = solve_modes(replace(STRIP, tension=tension, foundation=900.0), 4, count).frequencies_hz
    assert found == pytest.approx([discrete_hz(n, count, tension, 900.0) for n in (1, 2, 3, 4)], rel=3e-14)


@pytest.mark.parametrize("supports", ENDS)
def test_ground_shifts_every_squared_frequency_alike(supports):
    beam = replace(STRIP, supports=ENDS[supports])
    rigid = beam.rigid_motions
    alone = solve_modes(beam, 3, 30).frequencies_hz
    found = solve_modes(replace(beam, foundation=900.0), 3 + rigid, 30).frequencies_hz
    expected = np.append(np.zeros(rigid), alone**2) + 900.0 / RHO_A / (2 * pi) ** 2
    assert found**2 == pytest.approx(expected, rel=1e-12)


FORCES = [
    ("PP", 50.0),
    ("PP", -30.0),
    ("GP", 50.0),
    ("FF", 50.0),
    ("CF", 50.0),
    ("CF", -12.0),
    ("CC", 50.0),
    ("CC", -30.0),
]


@pytest.mark.parametrize(("supports", "tension"), FORCES)
def test_axial_force_lowers_joints_in_series_to_order_two_and_tensioned_ones_keep_four(supports, tension):
    beam = replace(STRIP, supports=ENDS[supports], tension=tension)
    assert order(beam, 1, (80, 160)) == pytest.approx(2.0, abs=0.02)
    assert order(beam, 1, (80, 160), joints="tensioned") == pytest.approx(4.0, abs=0.07)


@pytest.mark.parametrize("tension", [50.0, -30.0])
def test_the_leading_error_is_a_twelfth_of_mu_squared_of_what_axial_force_gives(tension):
    mode, count = 2, 60
    beta = mode * pi / L
    share = tension * beta**2 / (EI * beta**4 + tension * beta**2)
    found = errors(replace(STRIP, tension=tension), mode, (count,))[0]
    assert found == pytest.approx(0.5 * share * (mode * pi / count) ** 2 / 12, rel=0.03)


def test_a_clamped_wall_has_to_give_up_more_than_other_joints(monkeypatch):
    monkeypatch.setattr(carried, "tension_excess", lambda wall: 0.0)
    beam = replace(STRIP, supports=ENDS["CF"], tension=-12.0)
    assert order(beam, 1, (80, 160), joints="tensioned") == pytest.approx(2.93, abs=0.05)


@pytest.mark.parametrize("joints", ["series", "printed"])
def test_joints_as_printed_know_no_axial_force(joints):
    first, second = (solve_modes(replace(STRIP, tension=50.0), 3, 20, joints=j) for j in (joints, "series"))
    assert (first.frequencies_hz == second.frequencies_hz).all()


BUCKLING = {"PP": pi, "CF": pi / 2, "CC": 2 * pi}


@pytest.mark.parametrize("supports", BUCKLING)
def test_a_chain_buckles_at_order_two_and_a_tensioned_one_at_four(supports):
    exact = EI * (BUCKLING[supports] / L) ** 2
    beam = replace(STRIP, supports=ENDS[supports])
    series, mended = ([buckling_load(beam, n, joints=j) / exact - 1 for n in (40, 80)] for j in ("series", "tensioned"))
    assert np.log2(series[0] / series[1]) == pytest.approx(2.0, abs=0.03)
    assert series[1] == pytest.approx(-((BUCKLING[supports] / 80) ** 2) / 12, rel=0.03)
    assert abs(mended[1]) < 0.02 * abs(series[1])
    if supports == "PP":
        assert np.log2(mended[0] / mended[1]) == pytest.approx(4.0, abs=0.02)


@pytest.mark.parametrize("count", [5, 49, 400])
def test_pinned_links_buckle_where_their_closed_form_says(count):
    expected = 4 * EI * (count / L) ** 2 * sin(pi / (2 * count)) ** 2
    assert buckling_load(STRIP, count) == pytest.approx(expected, rel=2e-12)
    just = replace(STRIP, tension=-(1 - 1e-6) * expected)
    assert solve_modes(just, 1, count).frequencies_hz[0] == pytest.approx(
        discrete_hz(1, count, just.tension, 0.0), rel=1e-9
    )
    with pytest.raises(InputError, match=f"the chain of {count} segments buckles at"):
        solve_modes(replace(STRIP, tension=-(1 + 1e-6) * expected), 1, count)


def test_nothing_holds_a_compressed_pendulum():
    beam = replace(STRIP, supports=ENDS["PF"], tension=-1e-3)
    with pytest.raises(InputError, match="buckles at 0 N"):
        solve_modes(beam, 1, 20)
    assert buckling_load(beam, 20) == 0.0


@pytest.mark.parametrize("supports", ENDS)
@pytest.mark.parametrize("attachment", ["reciprocal", "lever"])
def test_short_loaded_chains_have_all_their_elastic_modes_and_no_more(supports, attachment):
    beam = replace(STRIP, supports=ENDS[supports], **mass(0.4, mass=0.1 * M, rotary_inertia=2e-4))
    tip = PointMass(position=L, rotary_inertia=1e-3)
    if supports in ("CF", "PF", "FF", "PP"):
        beam = replace(beam, mass=(*beam.mass, tip))
    for count in (2, 3, 5):
        n = n_elastic(beam, count, attachment=attachment)
        extra = attachment == "reciprocal" and len(beam.mass) == 2
        assert (
            unknowns(beam, count, attachment=attachment)
            == unknowns(STRIP, count) - (sum(s in ("pinned", "clamped") for s in ENDS[supports]) - 2) + extra
        )
        found = solve_modes(beam, n, count, attachment=attachment).frequencies_hz
        assert np.isfinite(found).all()
        assert (found > 1e-4 * found[-1]).all()
        with pytest.raises(InputError, match="more than the"):
            solve_modes(beam, n + 1, count, attachment=attachment)


@pytest.mark.parametrize(("beyond", "known"), [(0.0, 1), (0.21, 2)])
def test_what_turns_where_sections_meet_takes_a_chain_to_order_one(beyond, known):
    """Both of a step's curvatures meet in the turn of its place, and links on either side know one each."""
    sections = (
        Section(length=0.32, bending_stiffness=6.25, mass_per_length=0.194),
        Section(length=0.41, bending_stiffness=1.85, mass_per_length=0.556),
    )
    beam = Beam(
        length=0.73,
        bending_stiffness=3.7,
        mass_per_length=0.31,
        supports=("pinned", "guided"),
        section=sections,
        mass=(PointMass(position=0.32 + beyond, rotary_inertia=8e-4),),
    )
    assert MODELS["segment"].order(beam) == known
    found = [solve_modes(beam, 3, n).frequencies_hz[-1] for n in (120, 480)]
    exact = frequency_near(beam, "euler-bernoulli", found[-1])
    errors = [f / exact - 1 for f in found]
    assert np.log(errors[0] / errors[1]) / np.log(4) == pytest.approx(known, abs=0.15)


@pytest.mark.parametrize("settings", [{}, {"theory": "timoshenko"}, {"joints": "tensioned", "theory": "rayleigh"}])
def test_matrices_of_few_unknowns_are_those_that_are_made_sparse_of_many(settings, monkeypatch):
    few = chain_pencil(build_chain(LADEN, 17, **settings))
    strain, weights = few.strain_matrix().toarray(), few.mass_matrix()
    monkeypatch.setattr(loaded, "DENSE_UNKNOWNS", 0)
    many = chain_pencil(build_chain(LADEN, 17, **settings))
    for one, sparse in ((strain, many.strain_matrix()), (weights, many.mass_matrix())):
        other = sparse.toarray()
        assert abs(one - other).max() <= 1e-13 * abs(other).max()
    assert abs(strain - few.strain(np.eye(few.n))).max() == 0.0


def test_what_a_small_chain_carries_takes_it_a_few_times_as_long():
    """4 times; made of sparse matrices it was 18."""
    times = []
    for _ in range(9):
        for beam in (STRIP, replace(STRIP, foundation=50.0)):
            begun = process_time()
            solve_modes(beam, 10, 20)
            times.append(process_time() - begun)
    assert min(times[1::2]) < 9.0 * min(times[::2])


@pytest.mark.parametrize("base", [0.2, 1.0, 5.0])
@pytest.mark.parametrize(("part", "even"), [(0.045, True), (0.055, False)])
def test_whether_links_around_a_place_are_equally_long_is_a_matter_of_their_own_length(base, part, even):
    lengths = base * (1.0 + part * np.array([0, 0, 0.3, 0, 0.1, 0, 1.0, 0.2, 0, 0, 0, 0.0]))
    links, on, about = places_on(lengths, np.array([lengths[:5].sum() + 0.37 * lengths[5]]))
    assert links.tolist() == [5]
    assert on == pytest.approx([0.37])
    assert about.tolist() == [even]
