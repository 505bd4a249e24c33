"""Rayleigh's and Timoshenko's theories on a chain of rigid links: thickness inertia, and joints that slip."""

from math import pi

import mpmath as mp
import numpy as np
import pytest
from msgspec.structs import replace
from states_reference import frequency_near

from verify.attached import PointMass, PointSpring
from verify.beam import Beam, PointForce
from verify.errors import InputError
from verify.models.catalogue import MODELS
from verify.section import Section
from verify.segments.linear import build_chain, n_elastic, solve_modes
from verify.segments.loaded import loaded_pencil

L, EI, RHO_A, RHO_I, GA = 0.73, 3.7, 0.31, 3e-5, 2e4
M = RHO_A * L
THICK = Beam(length=L, bending_stiffness=EI, mass_per_length=RHO_A, rotary_inertia=RHO_I, shear_stiffness=GA)
ENDS = {
    "PP": ("pinned", "pinned"),
    "CF": ("clamped", "free"),
    "FF": ("free", "free"),
    "CC": ("clamped", "clamped"),
    "GP": ("guided", "pinned"),
    "CG": ("clamped", "guided"),
}
THEORIES = ["rayleigh", "timoshenko"]


def errors(beam, mode, counts, theory, **settings):
    found = [solve_modes(beam, mode, n, theory=theory, **settings).frequencies_hz[-1] for n in counts]
    exact = frequency_near(beam, theory, found[-1])
    return [f / exact - 1 for f in found]


def order(beam, mode, counts, theory, **settings):
    first, second = errors(beam, mode, counts, theory, **settings)
    return np.log(abs(first / second)) / np.log(counts[1] / counts[0])


def discrete_hz(mode, count, theory):
    """Pinned ends, S = 2 sin(mu/2)/l: the dispersion of `loaded`, in 30 digits."""
    with mp.workdps(30):
        link = mp.mpf(L) / count
        s2 = 4 * mp.sin(mode * mp.pi / (2 * count)) ** 2 / link**2
        soft = mp.mpf(0) if theory == "rayleigh" else mp.mpf(RHO_A) / GA
        a = soft * (RHO_I + RHO_A * link**2 / 12)
        b = RHO_I * s2 + RHO_A * (1 - link**2 * s2 / 6) + soft * EI * s2
        c = EI * s2**2
        return float(mp.sqrt(2 * c / (b + mp.sqrt(b * b - 4 * a * c))) / (2 * mp.pi))


@pytest.mark.parametrize("theory", THEORIES)
@pytest.mark.parametrize("count", [8, 49, 300, 2000])
def test_pinned_links_follow_the_exact_discrete_dispersion(theory, count):
    found = solve_modes(THICK, 5, count, theory=theory).frequencies_hz
    assert found == pytest.approx([discrete_hz(n, count, theory) for n in range(1, 6)], rel=2e-14)


@pytest.mark.parametrize("theory", THEORIES)
@pytest.mark.parametrize("supports", ENDS)
def test_thickness_lowers_a_chain_to_order_two_and_mended_joints_keep_four(theory, supports):
    beam = replace(THICK, supports=ENDS[supports])
    assert order(beam, 3, (160, 320), theory) == pytest.approx(2.0, abs=0.03)
    if "C" not in supports:
        assert order(beam, 3, (80, 160), theory, joints="tensioned") == pytest.approx(4.0, abs=0.05)
    else:  # between four and five, as Gregory's joints are before they change sign
        mended, plain = (errors(beam, 3, (160,), theory, joints=joints)[0] for joints in ("tensioned", "series"))
        assert abs(mended) < 0.015 * abs(plain)


@pytest.mark.parametrize("theory", THEORIES)
def test_the_leading_error_is_that_of_thickness_inertia(theory):
    """omega^2 is off by -(beta r)^2 mu^2/12, r^2 = rho I/rho A, while thickness and shear are small."""
    mode, count = 1, 160
    expected = -0.5 * (mode * pi / L) ** 2 * RHO_I / RHO_A * (mode * pi / count) ** 2 / 12
    assert errors(THICK, mode, (count,), theory)[0] == pytest.approx(expected, rel=0.02)


BODIES = {
    "mass": {"mass": (PointMass(position=0.375 * L, mass=0.4 * M),)},
    "mass off the joints": {"mass": (PointMass(position=L / 3, mass=0.4 * M),)},
    "spring": {"spring": (PointSpring(position=0.375 * L, stiffness=200 * EI / L**3),)},
    "rotary inertia": {"mass": (PointMass(position=0.375 * L, rotary_inertia=0.01 * M * L**2),)},
    "rotational spring": {"spring": (PointSpring(position=0.375 * L, rotational=8 * EI / L),)},
    "mass on a spring": {
        "mass": (PointMass(position=0.375 * L, mass=0.4 * M),),
        "spring": (PointSpring(position=0.375 * L, stiffness=200 * EI / L**3),),
    },
}


@pytest.mark.parametrize("body", BODIES)
def test_what_stands_on_a_beam_that_shears_is_of_order_two(body):
    assert order(replace(THICK, **BODIES[body]), 1, (250, 1000), "timoshenko") == pytest.approx(2.0, abs=0.06)


AT_ENDS = {
    "FF mass": ("FF", {"mass": (PointMass(position=0.0, mass=0.4 * M),)}),
    "GP mass": ("GP", {"mass": (PointMass(position=0.0, mass=0.4 * M),)}),
    "CF mass on a spring": (
        "CF",
        {
            "mass": (PointMass(position=L, mass=0.4 * M),),
            "spring": (PointSpring(position=L, stiffness=30 * EI / L**3),),
        },
    ),
    "FF elastic clamp": (
        "FF",
        {"spring": (PointSpring(position=0.0, stiffness=300 * EI / L**3, rotational=5 * EI / L),)},
    ),
}


@pytest.mark.parametrize("case", AT_ENDS)
def test_what_stands_at_an_end_that_shears_is_of_order_two(case):
    supports, what = AT_ENDS[case]
    beam = replace(THICK, supports=ENDS[supports], **what)
    assert order(beam, 1, (320, 960), "timoshenko") == pytest.approx(2.0, abs=0.1)


def test_a_body_that_slips_with_its_joints_alone_would_be_of_order_one(monkeypatch):
    from verify.segments import carried

    monkeypatch.setattr(carried, "shear_give", lambda weights: 1e-9)
    assert order(replace(THICK, **BODIES["mass"]), 1, (80, 160), "timoshenko") == pytest.approx(1.0, abs=0.05)


@pytest.mark.parametrize("supports", ENDS)
@pytest.mark.parametrize("count", [7, 49, 300])
def test_stiff_shear_is_rayleighs_chain_and_no_thickness_is_euler_bernoullis(supports, count):
    body = {"mass": (PointMass(position=0.37 * L, mass=0.2 * M, rotary_inertia=0.003),)}
    beam = replace(THICK, supports=ENDS[supports], **body)
    stiff = replace(beam, shear_stiffness=1e22)
    slender = replace(stiff, rotary_inertia=1e-25)
    rayleigh, plain, limits = (
        solve_modes(beam, 4, count, theory="rayleigh").frequencies_hz,
        solve_modes(beam, 4, count).frequencies_hz,
        [solve_modes(one, 4, count, theory="timoshenko").frequencies_hz for one in (stiff, slender)],
    )
    assert limits[0] == pytest.approx(rayleigh, rel=1e-12)
    assert limits[1] == pytest.approx(plain, rel=1e-12)
    assert solve_modes(slender, 4, count, theory="rayleigh").frequencies_hz == pytest.approx(plain, rel=1e-13)


def test_ground_under_a_beam_that_shears_keeps_order_two():
    beam = replace(THICK, supports=ENDS["CF"], foundation=900.0)
    assert order(beam, 1, (160, 320), "timoshenko") == pytest.approx(2.0, abs=0.03)


@pytest.mark.parametrize("supports", ENDS)
def test_short_chains_that_slip_have_all_their_elastic_modes(supports):
    beam = replace(THICK, supports=ENDS[supports])
    for count in (2, 3, 6):
        n = n_elastic(beam, count, "timoshenko")
        assert n == 2 * count - beam.rigid_motions
        found = solve_modes(beam, n, count, theory="timoshenko").frequencies_hz
        assert np.isfinite(found).all()
        assert (found > 1e-4 * found[-1]).all()
        with pytest.raises(InputError, match="more than the"):
            solve_modes(beam, n + 1, count, theory="timoshenko")


@pytest.mark.parametrize("theory", THEORIES)
def test_a_thick_beam_under_axial_force_and_a_section_that_lacks_a_figure_are_refused(theory):
    with pytest.raises(InputError, match=f"beam.tension.*theory = '{theory}'"):
        solve_modes(replace(THICK, tension=5.0), 2, 9, theory=theory)
    bare = Beam(length=L, bending_stiffness=EI, mass_per_length=RHO_A)
    with pytest.raises(InputError, match=r"beam\.rotary_inertia is missing"):
        solve_modes(bare, 2, 9, theory=theory)
    with pytest.raises(InputError, match="did you mean"):
        solve_modes(THICK, 2, 9, theory=theory[:-1])


REFUSED = (
    ("segment", "solve_modes", (THICK, 2, 5), {"theory": "timoshenko", "joints": "tensioned"}),
    ("segment", "solve_modes", (THICK, 9, 8), {}),
    ("segment", "solve_harmonic", (THICK, (PointForce(position=0.1),), 90.0, 1), {}),
    ("fem", "solve_modes", (THICK, 2, 0), {}),
    ("fem", "solve_modes", (THICK, 40, 7), {}),
)


@pytest.mark.parametrize(("model", "verb", "given", "settings"), REFUSED)
def test_a_refusal_of_a_size_names_count_to_who_wrote_count(model, verb, given, settings):
    """As scenes, the command line and all verbs over models say it; `n_segments` is what a model's own page says."""
    with pytest.raises(InputError, match=r"\bcount\b") as told:
        getattr(MODELS[model], verb)(*given, **settings)
    assert "n_segments" not in str(told.value)
    assert "n_elements" not in str(told.value)


def test_mended_joints_that_slip_take_six_links():
    with pytest.raises(InputError, match="n_segments = 5"):
        solve_modes(THICK, 2, 5, theory="timoshenko", joints="tensioned")


def test_how_bodies_are_felt_is_nothing_to_a_thick_chain_that_carries_none():
    beam = Beam(
        length=0.3, width=0.04, thickness=0.025, youngs_modulus=210e9, density=7850.0, supports=("clamped", "free")
    )
    for joints in ("series", "tensioned"):
        felt, lever = (
            solve_modes(beam, 4, 13, theory="timoshenko", joints=joints, attachment=attachment).frequencies_hz
            for attachment in ("reciprocal", "lever")
        )
        assert (felt == lever).all(), joints


@pytest.mark.parametrize("theory", THEORIES)
@pytest.mark.parametrize("wall", ["gregory", "half"])
@pytest.mark.parametrize("grading", [1.0, 0.02, 50.0])
def test_tensioned_joints_leave_chains_of_unlike_links_their_mass(theory, wall, grading):
    """What joints take off the mass is no more than links have to give, be they long beside short or heavy by light."""
    sections = (
        Section(length=0.31, thickness=0.0031, density=1900.0),
        Section(length=0.42, thickness=0.0013, density=8100.0),
    )
    beam = Beam(
        length=L,
        width=0.02,
        thickness=0.003,
        youngs_modulus=71e9,
        density=2600.0,
        section=sections,
        supports=("clamped", "free"),
    )
    for count in (9, 24):
        chain = build_chain(beam, count, joints="tensioned", wall=wall, theory=theory, grading=grading)
        values = np.linalg.eigvalsh(loaded_pencil(chain).mass_matrix())
        assert values.min() > 0
        settings = {"joints": "tensioned", "wall": wall, "theory": theory, "grading": grading}
        assert (np.diff(solve_modes(beam, 4, count, **settings).frequencies_hz) > 0).all()


@pytest.mark.parametrize("theory", THEORIES)
def test_a_tensioned_joint_takes_the_harmonic_mean_of_what_its_links_have(theory):
    beam = replace(THICK, supports=("free", "pinned"))
    chain = build_chain(beam, 7, joints="tensioned", theory=theory, grading=3.0)
    l = chain.lengths  # noqa: E741
    mean = 2 / (1 / l[1:] + 1 / l[:-1])
    assert chain.joint_inertias[1:-1] == pytest.approx(RHO_I / (RHO_A * chain.unit**2) * mean / 12, rel=1e-12)
    if theory == "timoshenko":
        assert chain.slip_masses[1:-1] == pytest.approx(mean / 12, rel=1e-12)


@pytest.mark.parametrize("theory", THEORIES)
@pytest.mark.parametrize(("end", "hold"), [(0, 0.3), (1, 20.0)])
def test_mended_joints_before_an_elastic_clamp_keep_order_four(theory, end, hold):
    """Only the joint's own turn mends its links' inertia, not that of the spring behind it: order 1 otherwise."""
    clamp = PointSpring(position=(0.0, L)[end], rotational=hold * EI / L)
    beam = replace(THICK, supports=(("pinned", "free"), ("free", "pinned"))[end], spring=(clamp,))
    assert order(beam, 1, (80, 160), theory, joints="tensioned") == pytest.approx(4.0, abs=0.12)
    assert abs(errors(beam, 1, (160,), theory, joints="tensioned")[0]) < 1e-9


def test_walls_that_take_more_off_a_thick_beams_mass_than_its_links_have_are_refused():
    """Five joints at either end of two links; by its own theory no figure is asked of them in vain."""
    beam = Beam(
        length=1.0, bending_stiffness=1.0, mass_per_length=1.0, rotary_inertia=0.27, supports=("clamped", "clamped")
    )
    asked = {"wall": "five-joint", "theory": "rayleigh"}
    with pytest.raises(
        InputError, match=r"^n_segments = 2: joints = 'tensioned' and wall = 'five-joint' take more off"
    ):
        solve_modes(beam, 1, 2, joints="tensioned", **asked)
    assert solve_modes(beam, 1, 2, **asked).frequencies_hz[0] > 0.0
    assert solve_modes(beam, 1, 9, joints="tensioned", **asked).frequencies_hz[0] > 0.0
