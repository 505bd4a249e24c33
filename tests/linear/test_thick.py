"""Rotary inertia and shear: exact beams and chains."""

from math import pi

import mpmath
import mpmath as mp
import numpy as np
import pytest
from msgspec.structs import replace

from tests.reference import dense
from tests.reference.transfer import frequency_near
from verify.errors import InputError
from verify.exact import closed_forms
from verify.exact.modes import exact_frequency_hz, solve_modes
from verify.problem.beam import Beam
from verify.problem.cross_section import Section
from verify.problem.point_attachments import PointMass, PointSpring
from verify.segments import linear as chains

BLOCK = Beam(length=0.43, width=0.019, thickness=0.061, youngs_modulus=113e9, density=4470.0, poissons_ratio=0.31)
OWN = BLOCK.own
CUT_OFF = np.sqrt(OWN.shear_stiffness / OWN.rotary_inertia) / (2 * np.pi)


def huang(supports, b):
    """The equation of a pair of ends, b^2 = rho A L^4 omega^2 / EI (Huang, J. Appl. Mech. 28, 1961, Eqs. 28 to 33)."""
    length = mpmath.mpf(BLOCK.length)
    r2 = mpmath.mpf(OWN.rotary_inertia) / OWN.mass_per_length / length**2
    s2 = mpmath.mpf(OWN.bending_stiffness) / OWN.shear_stiffness / length**2
    root = mpmath.sqrt((r2 - s2) ** 2 + 4 / b**2)
    alpha, beta = (mpmath.sqrt((side * (r2 + s2) + root) / 2) for side in (-1, 1))
    ch, sh = mpmath.cosh(b * alpha), mpmath.sinh(b * alpha)
    c, s, x = mpmath.cos(b * beta), mpmath.sin(b * beta), mpmath.sqrt(1 - b**2 * r2 * s2)
    if supports == ("clamped", "clamped"):
        return 2 - 2 * ch * c + b / x * (b**2 * s2 * (r2 - s2) ** 2 + 3 * s2 - r2) * sh * s
    if supports == ("free", "free"):
        return 2 - 2 * ch * c + b / x * (b**2 * r2 * (r2 - s2) ** 2 + 3 * r2 - s2) * sh * s
    return 2 + (b**2 * (r2 - s2) ** 2 + 2) * ch * c - b * (r2 + s2) / x * sh * s


@pytest.mark.parametrize("supports", [("clamped", "clamped"), ("free", "free"), ("clamped", "free")], ids="-".join)
@pytest.mark.parametrize("mode", [1, 2, 5, 8, 17, 40])
def test_timoshenkos_beam_solves_huangs_equations(supports, mode):
    """Modes 17 and 40 lie above the cut-off, where both roots are waves: his equations go on, by imaginary alpha."""
    found = exact_frequency_hz(replace(BLOCK, supports=supports), mode, "timoshenko")
    assert (found > CUT_OFF) == (mode > 8)
    with mpmath.workdps(40):
        unit = mpmath.sqrt(mpmath.mpf(OWN.mass_per_length) / OWN.bending_stiffness) * mpmath.mpf(BLOCK.length) ** 2
        b = 2 * mpmath.pi * found * unit
        sides = [mpmath.re(huang(supports, b * (1 + side * mpmath.mpf("1e-13")))) for side in (-1, 1)]
    assert sides[0] * sides[1] < 0


@pytest.mark.parametrize("supports", [("clamped", "pinned"), ("free", "free"), ("guided", "clamped")], ids="-".join)
def test_no_mode_is_missed_across_the_cut_off(supports):
    beam = replace(BLOCK, supports=supports)
    others = dense.TimoshenkoElements(beam, np.linspace(0.0, beam.length, 41)).frequencies_hz(22)
    found = solve_modes(beam, 22, "timoshenko").frequencies_hz
    assert found[-1] > 1.5 * CUT_OFF
    assert others == pytest.approx(found, rel=2e-3)


def test_a_pinned_beam_has_its_closed_forms_and_above_the_cut_off_both_families():
    """The lower family n pi / L by Timoshenko's formula, the upper one beside it, and the section's turning alone."""
    g, r2 = OWN.bending_stiffness / OWN.shear_stiffness, OWN.rotary_inertia / OWN.mass_per_length
    families = [CUT_OFF]
    for n in range(1, 40):
        b2 = (n * np.pi / BLOCK.length) ** 2
        half = 1 + b2 * (g + r2)
        root = np.sqrt(half**2 - 4 * b2**2 * g * r2)
        upper = (half + root) / (2 * g * r2) * OWN.bending_stiffness / OWN.mass_per_length
        families += [np.sqrt(upper) / (2 * np.pi), closed_forms.frequency_hz(BLOCK, n, "timoshenko")]
    found = solve_modes(BLOCK, 30, "timoshenko").frequencies_hz
    assert found == pytest.approx(sorted(families)[:30], rel=1e-13)
    cut = replace(BLOCK, section=(Section(length=0.1), Section(length=0.33)))
    for mode in (1, 4, 8):
        for theory in ("rayleigh", "timoshenko"):
            thin = Section(length=0.1, bending_stiffness=OWN.bending_stiffness, mass_per_length=OWN.mass_per_length)
            assert thin.shape is None
            general = exact_frequency_hz(replace(cut, foundation=1e-9), mode, theory)
            assert general == pytest.approx(closed_forms.frequency_hz(BLOCK, mode, theory), rel=1e-13)


@pytest.mark.parametrize("supports", [("clamped", "free"), ("free", "free"), ("guided", "clamped")], ids="-".join)
def test_theories_meet_in_their_limits(supports):
    """Rigid in shear Timoshenko is Rayleigh, as 1 / (kappa G A); without rotary inertia that is Euler-Bernoulli."""
    plain = Beam(
        length=0.43,
        supports=supports,
        bending_stiffness=4100.0,
        mass_per_length=3.3,
        rotary_inertia=1e-3,
        shear_stiffness=1e15,
    )
    for mode in (1, 4):
        rayleigh = exact_frequency_hz(plain, mode, "rayleigh")
        assert exact_frequency_hz(plain, mode, "timoshenko") == pytest.approx(rayleigh, rel=1e-7)
        softer = [
            1 - exact_frequency_hz(replace(plain, shear_stiffness=k), mode, "timoshenko") / rayleigh
            for k in (1e9, 1e10)
        ]
        assert softer[0] / softer[1] == pytest.approx(10.0, rel=0.02)
        thin = [
            1 - exact_frequency_hz(replace(plain, rotary_inertia=j), mode, "rayleigh") / exact_frequency_hz(plain, mode)
            for j in (1e-5, 1e-6)
        ]
        assert thin[0] / thin[1] == pytest.approx(10.0, rel=0.01)
        assert thin[1] > 0


def test_a_beams_theories_rank_as_they_must():
    """More ways to move and more to be moved: each lowers every frequency."""
    for supports in (("clamped", "free"), ("free", "pinned"), ("clamped", "guided")):
        beam = replace(BLOCK, supports=supports)
        for mode in (1, 3, 6):
            found = [exact_frequency_hz(beam, mode, theory) for theory in ("timoshenko", "rayleigh", "euler-bernoulli")]
            assert found == sorted(found)
            assert found[0] < 0.999 * found[2]


def test_what_a_theory_lacks_or_has_too_many_of_is_refused():
    plain = Beam(length=0.43, supports=("clamped", "free"), bending_stiffness=4100.0, mass_per_length=3.3)
    with pytest.raises(InputError, match=r"beam\.rotary_inertia is missing: theory = 'rayleigh'"):
        exact_frequency_hz(plain, 1, "rayleigh")
    with pytest.raises(InputError, match=r"beam\.shear_stiffness is missing: theory = 'timoshenko'"):
        exact_frequency_hz(replace(plain, rotary_inertia=1e-3), 1, "timoshenko")
    with pytest.raises(InputError, match="did you mean 'timoshenko'"):
        exact_frequency_hz(plain, 1, "timoshenk")
    for theory in ("rayleigh", "timoshenko"):
        with pytest.raises(InputError, match=f"beam.tension = .* N with theory = '{theory}': there is more than one"):
            exact_frequency_hz(replace(BLOCK, tension=3.0), 1, theory)


# --- Thick chains ---

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
    found = [chains.solve_modes(beam, mode, n, theory=theory, **settings).frequencies_hz[-1] for n in counts]
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
    found = chains.solve_modes(THICK, 5, count, theory=theory).frequencies_hz
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


@pytest.mark.parametrize("supports", ENDS)
@pytest.mark.parametrize("count", [7, 49, 300])
def test_stiff_shear_is_rayleighs_chain_and_no_thickness_is_euler_bernoullis(supports, count):
    body = {"mass": (PointMass(position=0.37 * L, mass=0.2 * M, rotary_inertia=0.003),)}
    beam = replace(THICK, supports=ENDS[supports], **body)
    stiff = replace(beam, shear_stiffness=1e22)
    slender = replace(stiff, rotary_inertia=1e-25)
    rayleigh, plain, limits = (
        chains.solve_modes(beam, 4, count, theory="rayleigh").frequencies_hz,
        chains.solve_modes(beam, 4, count).frequencies_hz,
        [chains.solve_modes(one, 4, count, theory="timoshenko").frequencies_hz for one in (stiff, slender)],
    )
    assert limits[0] == pytest.approx(rayleigh, rel=1e-12)
    assert limits[1] == pytest.approx(plain, rel=1e-12)
    assert chains.solve_modes(slender, 4, count, theory="rayleigh").frequencies_hz == pytest.approx(plain, rel=1e-13)


def test_ground_under_a_beam_that_shears_keeps_order_two():
    beam = replace(THICK, supports=ENDS["CF"], foundation=900.0)
    assert order(beam, 1, (160, 320), "timoshenko") == pytest.approx(2.0, abs=0.03)
