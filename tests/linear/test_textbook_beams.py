"""Exact beams with attachments, axial force and foundation, and their buckling."""

from itertools import product

import mpmath
import numpy as np
import pytest
from msgspec.structs import replace
from scipy.optimize import brentq

from tests.reference.transfer import has_frequency_within
from verify.analytic_modes import ExactModel
from verify.errors import InputError
from verify.exact import closed_forms
from verify.exact.characteristic import check_stable
from verify.options import SUPPORTS
from verify.problem.beam import Beam, PointForce
from verify.problem.cross_section import Section
from verify.problem.point_attachments import PointMass, PointSpring

# --- Textbook beams ---

PAIRS = list(product(SUPPORTS, SUPPORTS))
BAR = Beam(length=0.61, width=0.023, thickness=0.0047, youngs_modulus=113e9, density=4470.0)
DIGITS = 1e-13
"""Relative. Seen: 7e-16 where nothing is ill-conditioned."""


def wavenumber_length(beam, hertz):
    return float(np.sqrt(2 * np.pi * hertz / beam.wave_constant) * beam.length)


def hertz_of(beam, y):
    return float(y) ** 2 * beam.wave_constant / (2 * np.pi * beam.length**2)


def solves(equation, beam, mode, theory="euler-bernoulli", rel=DIGITS):
    """The figure of a mode is a root of an equation in beta L, in extended precision."""
    found = ExactModel(beam, theory).frequency_hz(mode)
    with mpmath.workdps(60):
        start = mpmath.mpf(wavenumber_length(beam, found))
        root = mpmath.findroot(equation, (start * (1 - mpmath.mpf("1e-8")), start), tol=1e-50, verify=False)
        assert hertz_of(beam, root) == pytest.approx(found, rel=rel)
    return wavenumber_length(beam, found)


@pytest.mark.parametrize("mode", [1, 2, 3, 7, 19])
def test_a_cantilever_with_a_tip_mass_that_turns(mode):
    """1 + c ch + M y (c sh - s ch) - J y^3 (s ch + c sh) + M J y^4 (1 - c ch) = 0 (Laura, J. Sound Vib. 37, 1974)."""
    m, j = 0.31, 0.0017
    whole = BAR.mass_per_length * BAR.length
    tip = PointMass(position=BAR.length, mass=m * whole, rotary_inertia=j * whole * BAR.length**2)
    beam = replace(BAR, supports=("clamped", "free"), mass=(tip,))

    def equation(y):
        c, s, ch, sh = mpmath.cos(y), mpmath.sin(y), mpmath.cosh(y), mpmath.sinh(y)
        turning = -j * y**3 * (s * ch + c * sh) + m * j * y**4 * (1 - c * ch)
        return 1 + c * ch + m * y * (c * sh - s * ch) + turning

    solves(equation, beam, mode)
    assert ExactModel(beam).frequency_hz(mode) < ExactModel(replace(beam, mass=())).frequency_hz(mode)


@pytest.mark.parametrize("mode", [1, 2, 3, 6, 14])
def test_a_pinned_beam_with_a_spring_off_its_middle(mode):
    """1 + k G(a, a) = 0, Green's function by sines and hyperbolic sines."""
    part, size = 0.37, 830.0
    stiffness = size * BAR.bending_stiffness / BAR.length**3
    beam = replace(BAR, spring=(PointSpring(position=part * BAR.length, stiffness=stiffness),))
    at, size = (mpmath.mpf(v) for v in (beam.spring[0].position / BAR.length, size))

    def equation(y):
        waves = mpmath.sin(y * at) * mpmath.sin(y * (1 - at)) / mpmath.sin(y)
        decays = mpmath.sinh(y * at) * mpmath.sinh(y * (1 - at)) / mpmath.sinh(y)
        return (1 + size * (waves - decays) / (2 * y**3)) * mpmath.sin(y)

    solves(equation, beam, mode)


@pytest.mark.parametrize("mode", [1, 2, 3, 4, 9])
def test_a_free_beam_on_equal_end_springs(mode):
    """Tan z + tanh z = 2 k / (EI beta^3) of even modes, coth z - cot z of odd ones, z = beta L / 2; rigid ones count."""
    size = 3.7
    spring = [
        PointSpring(position=at, stiffness=size * BAR.bending_stiffness / BAR.length**3) for at in (0.0, BAR.length)
    ]
    beam = replace(BAR, supports=("free", "free"), spring=tuple(spring))
    assert beam.rigid_motions == 0

    def even(y):
        return mpmath.tan(y / 2) + mpmath.tanh(y / 2) - 2 * size / y**3

    def odd(y):
        return mpmath.coth(y / 2) - mpmath.cot(y / 2) - 2 * size / y**3

    solves(even if mode % 2 else odd, beam, mode)
    bare = replace(beam, spring=())
    if mode < 3:
        rigid = np.sqrt(2 * beam.spring[0].stiffness / (BAR.mass_per_length * BAR.length) * (1, 3)[mode - 1])
        assert ExactModel(beam).frequency_hz(mode) == pytest.approx(rigid / (2 * np.pi), rel=0.03)
    else:
        assert ExactModel(beam).frequency_hz(mode) > ExactModel(bare).frequency_hz(mode - 2)


@pytest.mark.parametrize("supports", PAIRS, ids="-".join)
def test_a_foundation_shifts_every_square_by_its_own(supports):
    """omega^2 = omega_0^2 + k_f / (rho A), rigid motions included: the first two of a free beam coincide."""
    bare = replace(BAR, supports=supports)
    beam = replace(bare, foundation=2.3e5)
    own = beam.foundation / beam.mass_per_length / (2 * np.pi) ** 2
    for mode in (1, 2, 3, 8):
        elastic = mode - bare.rigid_motions
        square = own + (closed_forms.frequency_hz(bare, elastic) ** 2 if elastic > 0 else 0.0)
        assert ExactModel(beam).frequency_hz(mode) == pytest.approx(np.sqrt(square), rel=DIGITS)


@pytest.mark.parametrize("mode", [1, 2, 5, 21])
@pytest.mark.parametrize("pull", [-0.999, -0.6, 0.01, 7.0, 1e3, 1e5])
def test_a_pinned_beam_under_axial_force(pull, mode):
    """omega^2 = (EI b^4 + T b^2) / rho A. At 0.999 of the buckling load 1000 eps of the force are in mode 1."""
    force = pull * np.pi**2 * BAR.bending_stiffness / BAR.length**2
    beam = replace(BAR, tension=force)
    b2 = (mode * np.pi / BAR.length) ** 2
    omega = np.sqrt((BAR.bending_stiffness * b2 + force) * b2 / BAR.mass_per_length)
    loss = 1e3 if pull == -0.999 and mode == 1 else 1.0
    assert ExactModel(beam).frequency_hz(mode) == pytest.approx(omega / (2 * np.pi), rel=DIGITS * loss)


@pytest.mark.parametrize("mode", [1, 2, 3, 11])
@pytest.mark.parametrize("pull", [-3.9, 5.0, 2e3])
def test_a_clamped_beam_under_axial_force(pull, mode):
    """2 a g (1 - cosh a cos g) + (a^2 - g^2) sinh a sin g = 0, a^2 - g^2 = T L^2 / EI (Bokaian, J. Sound Vib. 142, 1990)."""
    t = pull * np.pi**2
    force = t * BAR.bending_stiffness / BAR.length**2
    beam = replace(BAR, supports=("clamped", "clamped"), tension=force)

    def equation(y):
        half = mpmath.mpf(beam.tension) * BAR.length**2 / BAR.bending_stiffness / 2
        root = mpmath.sqrt(half**2 + y**4)
        a, g = mpmath.sqrt(root + half), mpmath.sqrt(root - half)
        waves = (a**2 - g**2) * mpmath.tanh(a) * mpmath.sin(g)
        return 2 * a * g * (1 / mpmath.cosh(a) - mpmath.cos(g)) + waves

    solves(equation, beam, mode)


def test_a_beam_pulled_very_hard_is_a_string_with_stiff_ends():
    """omega_n = n pi c / L (1 + 2 e + (4 + n^2 pi^2 / 2) e^2), e^2 = EI / (T L^2) (Morse, Vibration and Sound, 1948)."""
    e = 1e-3
    force = BAR.bending_stiffness / (e * BAR.length) ** 2
    beam = replace(BAR, supports=("clamped", "clamped"), tension=force)
    for n in (1, 2, 3):
        string = n / (2 * BAR.length) * np.sqrt(force / BAR.mass_per_length)
        expected = string * (1 + 2 * e + (4 + n**2 * np.pi**2 / 2) * e**2)
        assert ExactModel(beam).frequency_hz(n) == pytest.approx(expected, rel=3e-7)


def test_stiff_springs_at_a_free_end_become_the_support():
    """As 1 / k, for all ways in which an end can be held."""
    held = {"pinned": (1.0, 0.0), "clamped": (1.0, 1.0), "guided": (0.0, 1.0)}
    sizes = BAR.bending_stiffness / BAR.length**3, BAR.bending_stiffness / BAR.length
    for support, (along, around) in held.items():
        exact = ExactModel(replace(BAR, supports=(support, "free"))).frequency_hz(3)
        errors = []
        for k in (1e6, 1e8):
            spring = PointSpring(position=0.0, stiffness=k * along * sizes[0], rotational=k * around * sizes[1])
            beam = replace(BAR, supports=("free", "free"), spring=(spring,))
            free = beam.rigid_motions - replace(BAR, supports=(support, "free")).rigid_motions
            errors.append(1 - ExactModel(beam).frequency_hz(3 - free) / exact)
        assert errors[0] > 0
        assert errors[0] / errors[1] == pytest.approx(100.0, rel=0.01)


def test_the_frequency_of_a_compressed_beam_vanishes_as_it_buckles():
    """omega^2 goes as 1 - P / P_c: by a mean value, linear to first order in what is left of the load."""
    beam = replace(BAR, supports=("clamped", "pinned"))
    load = ExactModel(beam).buckling_load()
    squares = [ExactModel(replace(beam, tension=-load * (1 - part))).frequency_hz(1) ** 2 for part in (1e-3, 1e-4)]
    assert squares[0] / squares[1] == pytest.approx(10.0, rel=1e-3)
    nearly = replace(beam, tension=-0.999 * load)
    assert has_frequency_within(nearly, "euler-bernoulli", ExactModel(nearly).frequency_hz(1), 2e-13)


# --- Buckling ---

STRUT = Beam(length=0.83, width=0.021, thickness=0.0037, youngs_modulus=113e9, density=4470.0)
EULER = np.pi**2 * STRUT.bending_stiffness / STRUT.length**2


def test_eulers_four_columns_and_two_more():
    """(L / effective length)^2; tan x = x for clamped-pinned."""
    root = brentq(lambda x: np.sin(x) - x * np.cos(x), 4.0, 4.6, xtol=1e-15)
    expected = {
        ("pinned", "pinned"): 1.0,
        ("clamped", "free"): 0.25,
        ("clamped", "clamped"): 4.0,
        ("pinned", "clamped"): (root / np.pi) ** 2,
        ("clamped", "guided"): 1.0,
        ("guided", "pinned"): 0.25,
        ("guided", "guided"): 1.0,
        ("free", "guided"): 0.25,
    }
    for supports, factor in expected.items():
        for beam in (replace(STRUT, supports=supports), replace(STRUT, supports=supports[::-1])):
            assert ExactModel(beam).buckling_load() == pytest.approx(factor * EULER, rel=1e-14)


def test_what_can_turn_as_a_whole_carries_no_compression():
    for supports in (("free", "free"), ("pinned", "free")):
        assert ExactModel(replace(STRUT, supports=supports)).buckling_load() == 0.0
        with pytest.raises(InputError, match="buckling load of 0 N"):
            ExactModel(replace(STRUT, supports=supports, tension=-1e-3)).frequency_hz(1)


@pytest.mark.parametrize("size", [0.03, 2.7, 410.0])
def test_an_elastic_clamp_at_a_pinned_end(size):
    """Tan x = x / (1 + x^2 / k), k = k_r L / EI: from pinned-pinned to clamped-pinned (Timoshenko and Gere, 2.3)."""
    spring = PointSpring(position=STRUT.length, rotational=size * STRUT.bending_stiffness / STRUT.length)
    root = brentq(lambda x: np.sin(x) * (1 + x**2 / size) - x * np.cos(x), 3.1, 4.6, xtol=1e-15)
    assert ExactModel(replace(STRUT, spring=(spring,))).buckling_load() == pytest.approx(
        (root / np.pi) ** 2 * EULER, rel=1e-13
    )


def test_a_strut_on_a_foundation_buckles_into_the_waves_that_cost_least():
    """Min over n of n^2 + k / (n^2 pi^4), k = k_f L^4 / EI."""
    for k in (30.0, 4e3, 7e5):
        beam = replace(STRUT, foundation=k * STRUT.bending_stiffness / STRUT.length**4)
        expected = min(n**2 + k / (np.pi**4 * n**2) for n in range(1, 30))
        assert ExactModel(beam).buckling_load() == pytest.approx(expected * EULER, rel=1e-13)


def test_a_soft_spring_in_the_middle_and_a_stiff_one():
    """From 16 pi^2 EI / L^3 on the strut buckles in two halves, at 4 times Euler's load; before, by its middle too.

    Then tan(x / 2) / (x / 2) = 1 - 4 x^2 EI / (k L^3) with x^2 = P L^2 / EI (Timoshenko and Gere, 2.5).
    """
    middle, unit = STRUT.length / 2, STRUT.bending_stiffness / STRUT.length**3
    stiff = replace(STRUT, spring=(PointSpring(position=middle, stiffness=16.1 * np.pi**2 * unit),))
    assert ExactModel(stiff).buckling_load() == pytest.approx(4 * EULER, rel=1e-13)
    soft = replace(STRUT, spring=(PointSpring(position=middle, stiffness=90.0 * unit),))
    root = brentq(lambda x: np.tan(x / 2) / (x / 2) - 1 + 4 * x**2 / 90.0, 3.3, 6.2, xtol=1e-15)
    assert ExactModel(soft).buckling_load() == pytest.approx((root / np.pi) ** 2 * EULER, rel=1e-12)


def test_a_stepped_column():
    """tan(x a) tan(y b) = y / x, x^2 = P / EI_1, y^2 = P / EI_2, clamped below, free above (Timoshenko and Gere, 2.14).

    A moment that goes on over the step, EI_1 x^2 = EI_2 y^2, is all that couples them.
    """
    column = replace(
        STRUT, supports=("clamped", "free"), section=(Section(length=0.31), Section(length=0.52, thickness=0.0029))
    )
    lower, upper = (piece.bending_stiffness for piece in column.pieces)

    def equation(force):
        x, y = np.sqrt(force / lower), np.sqrt(force / upper)
        return np.tan(x * 0.31) * np.tan(y * 0.52) - y / x

    expected = brentq(equation, 0.1 * EULER, 0.25 * EULER, xtol=1e-14)
    assert ExactModel(column).buckling_load() == pytest.approx(expected, rel=1e-13)


def test_compression_at_and_beyond_buckling_is_refused_everywhere():
    load = ExactModel(STRUT).buckling_load()
    check_stable(replace(STRUT, tension=-load * (1 - 1e-12)))
    for force in (-load, -3 * load):
        beam = replace(STRUT, tension=force)
        for ask in (
            lambda beam=beam: check_stable(beam),
            lambda beam=beam: ExactModel(beam).frequency_hz(1),
            lambda beam=beam: ExactModel(beam).modes(3),
            lambda beam=beam: ExactModel(beam).mode_shape(1, np.zeros(1)),
            lambda beam=beam: ExactModel(beam).harmonic([PointForce(position=0.1)], 50.0),
        ):
            with pytest.raises(InputError, match=rf"beam\.tension = {force!r} N compresses the beam beyond"):
                ask()
