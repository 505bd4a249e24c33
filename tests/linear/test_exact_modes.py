"""Exact modes against extended precision, and the other beam theories beside them."""

from itertools import product

import mpmath
import numpy as np
import pytest
from msgspec.structs import replace

from verify import analytic_modes
from verify.beam import Beam
from verify.errors import InputError
from verify.exact import closed_forms
from verify.options import SUPPORTS
from verify.section import Section

PAIRS = list(product(SUPPORTS, SUPPORTS))


def characteristic(supports, y):
    """The determinant of the four end conditions over e^{+-ay}, cos, sin in extended precision."""
    conditions = {"pinned": (0, 2), "clamped": (0, 1), "free": (2, 3), "guided": (1, 3)}

    def row(k, x):
        e, c, s = mpmath.exp(-y * x), mpmath.cos(y * x), mpmath.sin(y * x)
        wave = [(c, s), (-s, c), (-c, -s), (s, -c)][k]
        return [*wave, (-1) ** k * e, mpmath.exp(-y * (1 - x))]

    rows = [row(k, 0) for k in conditions[supports[0]]] + [row(k, 1) for k in conditions[supports[1]]]
    return mpmath.det(mpmath.matrix(rows))


@pytest.mark.parametrize("supports", PAIRS, ids="-".join)
@pytest.mark.parametrize("mode", [1, 2, 3, 7, 23])
def test_every_root_solves_its_characteristic_equation_to_rounding(supports, mode):
    found = closed_forms.wavenumber_length(supports, mode)
    with mpmath.workdps(40):
        root = mpmath.findroot(lambda y: characteristic(supports, y), mpmath.mpf(found))
    assert found == pytest.approx(float(root), rel=4e-16)


@pytest.mark.parametrize("supports", PAIRS, ids="-".join)
def test_shapes_are_orthonormal_and_meet_their_ends(titanium_strip, supports):
    beam = replace(titanium_strip, supports=supports)
    points, weights = np.polynomial.legendre.leggauss(16)
    cell = beam.length / 60
    x = (np.arange(60)[:, None] * cell + (points + 1) / 2 * cell).ravel()
    mass = np.tile(weights / 2 * cell, 60) * beam.mass_per_length
    modes = analytic_modes.solve_modes(beam, 30)
    shapes = modes.deflection(x)
    assert abs(shapes * mass @ shapes.T - np.eye(30)).max() < 5e-14
    conditions = {"pinned": (0, 2), "clamped": (0, 1), "free": (2, 3), "guided": (1, 3)}
    for end, support in zip((0.0, beam.length), supports, strict=True):
        for k in conditions[support]:
            size = abs(modes.shapes(x, k)).max(axis=1)
            assert (abs(modes.shapes(np.array([end]), k)[:, 0]) < 2e-14 * size).all()


def test_mode_226_and_mode_100000_do_not_overflow(titanium_strip):
    beam = replace(titanium_strip, supports=("clamped", "free"))
    x = np.linspace(0, beam.length, 7)
    for n in (226, 227, 100_000):
        assert np.isfinite(analytic_modes.mode_shape(beam, n, x)).all()
    tip = analytic_modes.mode_shape(beam, 100_000, np.array([beam.length]))[0]
    assert abs(tip) == pytest.approx(2 / np.sqrt(beam.mass_per_length * beam.length), rel=1e-13)


def test_a_pinned_beams_shape_at_a_high_mode_is_its_sine_in_extended_precision(titanium_strip):
    x = np.array([0.0731, 0.3172, 0.69])
    with mpmath.workdps(40):
        scale = mpmath.sqrt(mpmath.mpf(2) / (mpmath.mpf(titanium_strip.mass_per_length) * titanium_strip.length))
        exact = [scale * mpmath.sin(99_991 * mpmath.pi * mpmath.mpf(xi / titanium_strip.length)) for xi in x]
    found = analytic_modes.mode_shape(titanium_strip, 99_991, x)
    assert found == pytest.approx([float(v) for v in exact], rel=2e-13)


def test_mode_22_of_the_papers_beam_by_three_theories(paper_beam):
    by_hand = (22 * np.pi) ** 2 / (2 * np.pi * 0.25) * np.sqrt(70e9 / 2700 / 12) * 1e-3
    assert closed_forms.frequency_hz(paper_beam, 22) == pytest.approx(by_hand, rel=1e-14)
    b2 = (22 * np.pi * 0.001 / 0.5) ** 2 / 12
    assert closed_forms.frequency_hz(paper_beam, 22, "rayleigh") == pytest.approx(by_hand / np.sqrt(1 + b2), rel=1e-14)
    assert closed_forms.frequency_hz(paper_beam, 22, "timoshenko") == pytest.approx(4455.11, abs=0.005)


def test_timoshenkos_frequency_solves_the_equations_of_motion(titanium_strip):
    """Shear and moment balance of a sine, a 2x2 eigenproblem, in extended precision."""
    beam, mode = titanium_strip, 13
    with mpmath.workdps(40):
        k = mode * mpmath.pi / beam.length
        e_i, rho_a = mpmath.mpf(beam.bending_stiffness), mpmath.mpf(beam.mass_per_length)
        rho_i = mpmath.mpf(beam.density) * beam.second_moment
        shear = mpmath.mpf(5) / 6 * beam.youngs_modulus / (2 * (1 + mpmath.mpf(beam.poissons_ratio))) * beam.area
        stiffness = mpmath.matrix([[shear * k**2, -shear * k], [-shear * k, e_i * k**2 + shear]])
        trace = stiffness[0, 0] / rho_a + stiffness[1, 1] / rho_i
        det = mpmath.det(stiffness) / (rho_a * rho_i)
        omega2 = trace / 2 - mpmath.sqrt(trace**2 / 4 - det)
        expected = float(mpmath.sqrt(omega2) / (2 * mpmath.pi))
    assert closed_forms.frequency_hz(beam, mode, "timoshenko") == pytest.approx(expected, rel=1e-13)


def test_the_drive_rule_and_the_quarter_wave_give_the_papers_figures(paper_beam):
    assert closed_forms.rule_frequency_hz(paper_beam, 21, 22) == pytest.approx(4275.99, abs=0.005)
    assert closed_forms.quarter_wavelength(paper_beam, 4276.0) == pytest.approx(0.011618, abs=5e-7)


def test_what_has_no_closed_form_is_refused(titanium_strip):
    clamped = replace(titanium_strip, supports=("clamped", "pinned"))
    with pytest.raises(InputError, match="use euler-bernoulli"):
        closed_forms.frequency_hz(clamped, 3, "rayleigh")
    with pytest.raises(InputError, match="did you mean 'timoshenko'"):
        closed_forms.frequency_hz(titanium_strip, 3, "timoshenk")
    with pytest.raises(InputError, match="mode = 0"):
        closed_forms.frequency_hz(titanium_strip, 0)
    with pytest.raises(InputError, match="n_modes = 0"):
        analytic_modes.solve_modes(titanium_strip, 0)
    with pytest.raises(InputError, match=r"x = 0\.74 lies off the beam"):
        analytic_modes.solve_modes(titanium_strip, 2).deflection([0.1, 0.74])


LONG = Beam(length=0.42, width=0.03, thickness=0.004, youngs_modulus=71e9, density=2710.0, supports=("clamped", "free"))
WORK = [
    (LONG, "euler-bernoulli", 1.5e-5),
    (LONG, "timoshenko", 6e-4),
    (replace(LONG, section=(Section(length=0.22), Section(length=0.2, thickness=0.003))), "euler-bernoulli", 9e-4),
]


@pytest.mark.parametrize("mode", [0, -3, 2.5, "2", None, 10**31, 10**400])
def test_a_mode_that_is_none_or_beyond_all_formulas_is_refused(mode):
    for beam in (WORK[0][0], WORK[2][0]):
        for solve in (analytic_modes.exact_frequency_hz, lambda beam, mode: analytic_modes.mode_shape(beam, mode, 0.1)):
            with pytest.raises(InputError, match="mode = "):
                solve(beam, mode)
