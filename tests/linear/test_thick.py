"""Rotary inertia and shear: exact beams."""

import mpmath
import numpy as np
import pytest
from msgspec.structs import replace
from verify.exact.modes import exact_frequency_hz, solve_modes

from tests.reference import dense
from verify.analytic_modes import ExactModel
from verify.errors import InputError
from verify.exact import closed_forms
from verify.problem.beam import Beam
from verify.problem.cross_section import Section

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
    found = ExactModel(replace(BLOCK, supports=supports), "timoshenko").frequency_hz(mode)
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
    found = ExactModel(beam, "timoshenko").modes(22).frequencies_hz
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
    found = ExactModel(BLOCK, "timoshenko").modes(30).frequencies_hz
    assert found == pytest.approx(sorted(families)[:30], rel=1e-13)
    cut = replace(BLOCK, section=(Section(length=0.1), Section(length=0.33)))
    for mode in (1, 4, 8):
        for theory in ("rayleigh", "timoshenko"):
            thin = Section(length=0.1, bending_stiffness=OWN.bending_stiffness, mass_per_length=OWN.mass_per_length)
            assert thin.shape is None
            general = ExactModel(replace(cut, foundation=1e-9), theory).frequency_hz(mode)
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
        rayleigh = ExactModel(plain, "rayleigh").frequency_hz(mode)
        assert ExactModel(plain, "timoshenko").frequency_hz(mode) == pytest.approx(rayleigh, rel=1e-7)
        softer = [
            1 - ExactModel(replace(plain, shear_stiffness=k), "timoshenko").frequency_hz(mode) / rayleigh
            for k in (1e9, 1e10)
        ]
        assert softer[0] / softer[1] == pytest.approx(10.0, rel=0.02)
        thin = [
            1
            - ExactModel(replace(plain, rotary_inertia=j), "rayleigh").frequency_hz(mode)
            / ExactModel(plain).frequency_hz(mode)
            for j in (1e-5, 1e-6)
        ]
        assert thin[0] / thin[1] == pytest.approx(10.0, rel=0.01)
        assert thin[1] > 0


def test_a_beams_theories_rank_as_they_must():
    """More ways to move and more to be moved: each lowers every frequency."""
    for supports in (("clamped", "free"), ("free", "pinned"), ("clamped", "guided")):
        beam = replace(BLOCK, supports=supports)
        for mode in (1, 3, 6):
            found = [
                ExactModel(beam, theory).frequency_hz(mode) for theory in ("timoshenko", "rayleigh", "euler-bernoulli")
            ]
            assert found == sorted(found)
            assert found[0] < 0.999 * found[2]


def test_what_a_theory_lacks_or_has_too_many_of_is_refused():
    plain = Beam(length=0.43, supports=("clamped", "free"), bending_stiffness=4100.0, mass_per_length=3.3)
    with pytest.raises(InputError, match=r"beam\.rotary_inertia is missing: theory = 'rayleigh'"):
        ExactModel(plain, "rayleigh").frequency_hz(1)
    with pytest.raises(InputError, match=r"beam\.shear_stiffness is missing: theory = 'timoshenko'"):
        ExactModel(replace(plain, rotary_inertia=1e-3), "timoshenko").frequency_hz(1)
    with pytest.raises(InputError, match="did you mean 'timoshenko'"):
        ExactModel(plain, "timoshenk").frequency_hz(1)
    for theory in ("rayleigh", "timoshenko"):
        with pytest.raises(InputError, match=f"beam.tension = .* N with theory = '{theory}': there is more than one"):
            ExactModel(replace(BLOCK, tension=3.0), theory).frequency_hz(1)
