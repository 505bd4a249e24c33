"""Exact frequencies and buckling loads against the closed forms of textbooks and papers."""

import numpy as np
import pytest
from msgspec.structs import replace
from scipy.optimize import brentq

from tests.beams import BEAMS, MODELS, PAIRS, mass, spring, supported
from tests.reference.transfer import has_frequency_within
from verify import Beam, ExactModel, HermiteModel, PointForce, Section, SegmentModel
from verify.errors import InputError
from verify.exact.closed_forms import frequency_hz

BAR = Beam(length=0.61, width=0.023, thickness=0.0047, youngs_modulus=113e9, density=4470.0)
L, EI = BAR.length, BAR.bending_stiffness
DIGITS = 1e-13  # relative; 7e-16 where the problem is well conditioned


def on(letters, **changes):
    return supported(BAR, letters, **changes)


def frequency(beam, mode, theory="euler-bernoulli"):
    return ExactModel(beam, theory).frequency_hz(mode)


# --- Frequencies of Euler-Bernoulli beams ----------------------------------------------------------------------------


@pytest.mark.parametrize("supports", PAIRS, ids="-".join)
def test_a_foundation_adds_its_stiffness_over_the_mass_to_all_squares(supports):
    """omega^2 = omega_0^2 + k_f / (rho A), rigid motions included: the first two of a free beam coincide."""
    bare = replace(BAR, supports=supports)
    beam = replace(bare, foundation=2.3e5)
    own = beam.foundation / beam.mass_per_length / (2 * np.pi) ** 2
    for mode in (1, 2, 3, 8):
        elastic = mode - bare.rigid_motions
        square = own + (frequency_hz(bare, elastic) ** 2 if elastic > 0 else 0.0)
        assert frequency(beam, mode) == pytest.approx(np.sqrt(square), rel=DIGITS)


@pytest.mark.parametrize(("letter", "along", "around"), [("P", 1.0, 0.0), ("C", 1.0, 1.0), ("G", 0.0, 1.0)])
def test_stiff_springs_at_a_free_end_become_the_support_as_1_over_k(letter, along, around):
    support = on(letter + "F")
    errors = []
    for k in (1e6, 1e8):
        beam = on("FF", spring=spring(BAR, 0.0, k * along, k * around))
        errors.append(1 - frequency(beam, 3 - beam.rigid_motions + support.rigid_motions) / frequency(support, 3))
    assert errors[0] > 0
    assert errors[0] / errors[1] == pytest.approx(100.0, rel=0.01)


@pytest.mark.parametrize(("model", "size"), [(SegmentModel, 1e16), (HermiteModel, 1e13), (HermiteModel, 1e30)])
def test_stiff_springs_cost_discrete_models_no_digit(model, size):
    for count in (20, 400):
        stiff = model(on("FP", spring=spring(BAR, 0.0, size, size)), count).modes(4).frequencies_hz
        off = stiff / model(on("CP"), count).modes(4).frequencies_hz - 1
        assert off == pytest.approx(np.zeros(4), abs=3000 / size + 1e-12)


# --- Frequencies of Timoshenko beams ---------------------------------------------------------------------------------

BLOCK = Beam(length=0.43, width=0.019, thickness=0.061, youngs_modulus=113e9, density=4470.0, poissons_ratio=0.31)
OWN = BLOCK.base_section
CUT_OFF = np.sqrt(OWN.shear_stiffness / OWN.rotary_inertia) / (2 * np.pi)


@pytest.mark.parametrize("supports", ["CP", "FF", "GC"])
def test_no_mode_is_missed_across_the_cut_off(supports):
    beam = supported(BLOCK, supports)
    others = HermiteModel(beam, 41, theory="timoshenko").modes(22).frequencies_hz
    found = ExactModel(beam, "timoshenko").modes(22).frequencies_hz
    assert found[-1] > 1.5 * CUT_OFF
    assert others == pytest.approx(found, rel=2e-3)


def test_a_pinned_timoshenko_beam_has_two_families_and_a_mode_of_pure_rotation():
    """b^2 = (n pi / L)^2: both roots of g r^2 x^2 - (1 + b^2 (g + r^2)) x + b^4, and the cut-off."""
    g, r2 = OWN.bending_stiffness / OWN.shear_stiffness, OWN.rotary_inertia / OWN.mass_per_length
    b2 = (np.arange(1, 40) * np.pi / BLOCK.length) ** 2
    half = 1 + b2 * (g + r2)
    high = (half + np.sqrt(half**2 - 4 * b2**2 * g * r2)) / (2 * g * r2)
    squares = np.concatenate([high, b2**2 / (g * r2) / high]) * OWN.bending_stiffness / OWN.mass_per_length
    families = np.sort([CUT_OFF, *np.sqrt(squares) / (2 * np.pi)])[:30]
    assert ExactModel(BLOCK, "timoshenko").modes(30).frequencies_hz == pytest.approx(families, rel=1e-13)
    cut = replace(BLOCK, section=(Section(length=0.1), Section(length=0.33)), foundation=1e-9)
    rayleigh = np.sqrt(OWN.bending_stiffness / OWN.mass_per_length * b2**2 / (1 + r2 * b2)) / (2 * np.pi)
    for mode in (1, 4, 8):  # by the general equation of several sections
        assert frequency(cut, mode, "timoshenko") == pytest.approx(families[mode - 1], rel=1e-13)
        assert frequency(cut, mode, "rayleigh") == pytest.approx(rayleigh[mode - 1], rel=1e-13)


@pytest.mark.parametrize("count", [7, 300])
@pytest.mark.parametrize("letters", ["PP", "CF", "FF", "GC"])
@pytest.mark.parametrize("model", MODELS)
def test_theories_agree_in_their_limits(model, letters, count):
    """Timoshenko without shear is Rayleigh, Rayleigh without rotary inertia is Euler-Bernoulli."""
    body = {"mass": mass(BLOCK, 0.37, 0.2, 0.003)}
    plain = Beam(length=0.43, bending_stiffness=4100.0, mass_per_length=3.3, rotary_inertia=1e-3, shear_stiffness=1e15)
    beam = supported(plain, letters, **body)

    def hertz(theory, **changes):
        size = {} if model == "exact" else {"count": count}
        return MODELS[model](replace(beam, **changes), theory=theory, **size).modes(4).frequencies_hz

    rayleigh, euler = hertz("rayleigh"), hertz("euler-bernoulli")
    assert hertz("timoshenko", shear_stiffness=1e19) == pytest.approx(rayleigh, rel=1e-12)
    assert hertz("rayleigh", rotary_inertia=1e-25) == pytest.approx(euler, rel=1e-13)


# --- Buckling --------------------------------------------------------------------------------------------------------

EULER = np.pi**2 * EI / L**2


def load(beam):
    return ExactModel(beam).buckling_load() / EULER


@pytest.mark.parametrize(
    ("letters", "factor"),
    [
        ("PP", 1.0),
        ("CF", 0.25),
        ("CC", 4.0),
        ("PC", (4.493409457909064 / np.pi) ** 2),  # tan x = x
        ("CG", 1.0),
        ("GP", 0.25),
        ("GG", 1.0),
        ("FG", 0.25),
    ],
)
def test_eulers_columns_buckle_at_their_effective_length(letters, factor):
    assert [load(on(pair)) for pair in (letters, letters[::-1])] == pytest.approx([factor, factor], rel=1e-14)


@pytest.mark.parametrize("size", [0.03, 2.7, 410.0])
def test_a_column_with_an_elastic_clamp(size):
    """Tan x = x / (1 + x^2 / k), k = k_r L / EI (Timoshenko and Gere, 2.3)."""
    root = brentq(lambda x: np.sin(x) * (1 + x**2 / size) - x * np.cos(x), 3.1, 4.6, xtol=1e-15)
    assert load(on("PP", spring=spring(BAR, 1.0, rotational=size))) == pytest.approx((root / np.pi) ** 2, rel=1e-13)


@pytest.mark.parametrize("k", [30.0, 1900.0, 7e5])
def test_a_column_on_a_foundation_buckles_in_the_waves_of_least_load(k):
    """Min over n of n^2 + k / (n^2 pi^4), k = k_f L^4 / EI; elements above it by order four."""
    beam = on("PP", foundation=k * EI / L**4)
    expected = min(n**2 + k / (np.pi**4 * n**2) for n in range(1, 30))
    assert load(beam) == pytest.approx(expected, rel=1e-13)
    if k < 2e3:
        assert HermiteModel(beam, 40).buckling_load() / EULER == pytest.approx(expected, rel=2e-6)


def test_a_column_with_a_spring_at_mid_span():
    """From 16 pi^2 EI / L^3 on two half waves, 4 times Euler's load; below tan(x / 2) / (x / 2) = 1 - 4 x^2 EI / (k L^3).

    x^2 = P L^2 / EI (Timoshenko and Gere, 2.5).
    """
    assert load(on("PP", spring=spring(BAR, 0.5, 16.1 * np.pi**2))) == pytest.approx(4, rel=1e-13)
    root = brentq(lambda x: np.tan(x / 2) / (x / 2) - 1 + 4 * x**2 / 90.0, 3.3, 6.2, xtol=1e-15)
    assert load(on("PP", spring=spring(BAR, 0.5, 90.0))) == pytest.approx((root / np.pi) ** 2, rel=1e-12)


def test_a_stepped_column():
    """tan(x a) tan(y b) = y / x, x^2 = P / EI_1, y^2 = P / EI_2 (Timoshenko and Gere, 2.14)."""
    column = on("CF", section=(Section(length=0.23), Section(length=0.38, thickness=0.0037)))
    lower, upper = (piece.bending_stiffness for piece in column.pieces)

    def equation(force):
        x, y = np.sqrt(force * EULER / lower), np.sqrt(force * EULER / upper)
        return np.tan(x * 0.23) * np.tan(y * 0.38) - y / x

    assert load(column) == pytest.approx(brentq(equation, 0.1, 0.25, xtol=1e-14), rel=1e-13)


def test_the_frequency_of_a_compressed_beam_vanishes_at_buckling():
    """omega^2 goes as 1 - P / P_c to first order."""
    critical = load(on("CP")) * EULER
    squares = [frequency(on("CP", tension=-critical * (1 - part)), 1) ** 2 for part in (1e-3, 1e-4)]
    assert squares[0] / squares[1] == pytest.approx(10.0, rel=1e-3)
    nearly = on("CP", tension=-0.999 * critical)
    assert has_frequency_within(nearly, "euler-bernoulli", frequency(nearly, 1), 2e-13)


@pytest.mark.parametrize("part", [1.0, 3.0])
def test_compression_at_and_beyond_buckling_is_an_input_error(part):
    beam = on("PP", tension=-part * ExactModel(on("PP")).buckling_load())
    for work in (
        lambda: frequency(beam, 1),
        lambda: ExactModel(beam).modes(3),
        lambda: ExactModel(beam).mode_shape(1, np.zeros(1)),
        lambda: ExactModel(beam).harmonic([PointForce(position=0.1)], 50.0),
    ):
        with pytest.raises(InputError, match=rf"beam\.tension = {beam.tension!r} N exceeds the buckling load"):
            work()


@pytest.mark.parametrize("mode", [0, -3, 2.5, "2", None, 10**31, 10**400])
@pytest.mark.parametrize("beam", [on("CF"), BEAMS["stepped"]])
def test_a_mode_that_does_not_exist_is_an_input_error(beam, mode):
    for verb in (ExactModel(beam).frequency_hz, lambda mode: ExactModel(beam).mode_shape(mode, 0.1)):
        with pytest.raises(InputError, match="mode = "):
            verb(mode)


# --- Nearly free beams at low frequency ------------------------------------------------------------------------------


def low_fields(beam, model, ratio, verb="harmonic"):
    """Field of 400 parts and of the exact beam at a fraction of the first mode of the free beam."""
    force = PointForce(position=0.31 * L, amplitude=1.7)
    hertz = ratio * frequency(on("FF"), 1)
    return [getattr(one, verb)(force, hertz) for one in (model(beam, 400), ExactModel(beam))]


@pytest.mark.parametrize("verb", ["harmonic", "imposed"])
@pytest.mark.parametrize("loss", [0.0, 0.013])
@pytest.mark.parametrize("model", [SegmentModel, HermiteModel])
@pytest.mark.parametrize("ratio", [1e-2, 1e-4, 1e-7])
def test_a_free_beam_keeps_its_bending_beside_its_rigid_motion(model, loss, ratio, verb):
    here, exact = low_fields(on("FF", loss_factor=loss), model, ratio, verb)
    x = np.linspace(0.04, 0.97, 17) * L
    for order, most in ((0, 1e-11), (2, 3e-5)):
        wanted = exact.derivative(x, order)
        assert abs(here.derivative(x, order) - wanted).max() < most * abs(wanted).max()


@pytest.mark.parametrize("model", [SegmentModel, HermiteModel])
def test_fewer_than_four_digits_are_refused(model):
    """On soft ground curvature goes before deflection; both are right a little above."""
    beam, x = on("FF", foundation=1e-10 * EI / L**4, loss_factor=0.013), np.linspace(0.04, 0.97, 17) * L
    here, exact = low_fields(beam, model, 1e-3)
    wanted = exact.derivative(x, 2)
    assert abs(here.derivative(x, 2) - wanted).max() < 1e-4 * abs(wanted).max()
    here, exact = low_fields(beam, model, 1e-4)
    assert here.deflection(x) == pytest.approx(exact.deflection(x), rel=1e-9)
    with pytest.raises(InputError, match=r"derivative 2 .* lower count"):
        here.derivative(x, 2)
    with pytest.raises(InputError, match="lower count"):
        low_fields(beam, model, 1e-7)
