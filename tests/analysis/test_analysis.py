"""Pairing by MAC, observed orders, grid convergence, settings and sizes."""

from contextlib import suppress
from itertools import combinations_with_replacement, product

import numpy as np
import pytest
from msgspec.structs import replace

from verify import Beam, ExactModel, PointForce, SegmentModel, verdict
from verify.analysis import comparison, sizing
from verify.analysis.comparison import grid_convergence
from verify.analysis.sizing import choose
from verify.analysis.solution_cache import SolutionCache
from verify.analysis.variants import Rules
from verify.errors import InputError
from verify.linear.modes import Modes
from verify.linear.registry import MODELS
from verify.problem.cross_section import Section
from verify.problem.point_attachments import PointMass
from verify.scene.load import load_scene
from verify.travelling_wave import measure

# --- Comparison ---

X = np.linspace(0, 1, 41)
SINES = np.array([np.sin(n * np.pi * X) for n in (1, 2, 3, 4)])


def fake_modes(shapes):
    return Modes(
        model="segment",
        count=40,
        length=1.0,
        frequencies_hz=np.arange(1.0, len(shapes) + 1),
        nodes=X,
        shapes=lambda x, k: shapes,
        points=X,
        sampled=lambda: shapes,
        curvature_points=X,
        curvatures=lambda: shapes,
    )


def test_modes_are_paired_by_the_mac_of_their_shapes_not_by_rank():
    exchanged = fake_modes(-3.7 * SINES[[0, 2, 1, 3]])
    assert [comparison.paired_index(exchanged, SINES, n, 1) for n in (1, 2, 3, 4)] == [0, 2, 1, 3]
    mixed = SINES.copy()
    mixed[1], mixed[2] = 0.9 * SINES[1] + 0.44 * SINES[2], 0.9 * SINES[2] - 0.44 * SINES[1]
    index, macs = comparison.pair_modes(comparison.mac(SINES, mixed))
    assert list(index) == [0, 1, 2, 3]
    assert macs[1] == pytest.approx(0.81 / (0.81 + 0.44**2), abs=1e-12)
    mixed[2] = np.sin(9 * np.pi * X)
    with pytest.raises(InputError, match=r"mode = 3: no segment mode at count = 40 .* raise count"):
        comparison.paired_index(fake_modes(mixed), SINES, 3, 1)


def test_shape_error_is_independent_of_sign_and_includes_the_amplitude():
    weights = comparison.node_weights(X)
    assert comparison.shape_error(SINES[2], -SINES[2], weights) == 0
    assert comparison.shape_error(SINES[2], -1.07 * SINES[2], weights) == pytest.approx(0.07, rel=1e-12)
    assert comparison.shape_error(SINES[0], SINES[1], weights) == pytest.approx(np.sqrt(2), rel=1e-12)


@pytest.mark.parametrize("order", [0.7, 2.0, 4.0, 6.1])
def test_the_observed_order_of_an_exact_power_is_that_power(order):
    counts = (11, 19, 53, 101)
    assert comparison.observed_order(counts, [-33.0 * n**-order for n in counts]) == pytest.approx(order, rel=1e-10)


@pytest.mark.parametrize(
    ("counts", "errors", "message"),
    [
        ((10, 20, 20), (1e-3, 1e-4, 1e-4), "three or more"),
        ((10, 20, 40), (1e-3, -1e-4, -1e-5), "changes sign"),
        ((10, 20, 40), (1e-9, 1e-11, 3e-13), "within rounding"),
        ((10, 20, 40), (1e-3, float("nan"), 1e-5), "not finite"),
    ],
)
def test_errors_without_an_observed_order_are_an_input_error(counts, errors, message):
    with pytest.raises(InputError, match=message):
        comparison.observed_order(counts, errors)


@pytest.mark.parametrize("expected", [None, 4])
def test_orders_that_agree_from_size_to_size_are_asymptotic(expected):
    counts, errors = (80, 20, 40), (2e-7, 4.2e-5, 3e-6)
    assert comparison.asymptotic_order(counts, errors, expected) == comparison.observed_order(counts, errors)


@pytest.mark.parametrize(
    ("errors", "expected", "message"),
    [
        ((0.122, 0.0024, 0.001), None, r"outside the asymptotic range, .* 5.67, 1.26"),
        ((1e-3, 2e-3, 1e-5), None, "outside the asymptotic range"),
        ((1e-3, 1e-3 / 37, 1e-3 / 37**2), 4, "5.21, 5.21 and 4 is expected"),
        ((1e-3, 1e-3 / 3.0, 1e-4), 4, "outside the asymptotic range"),
    ],
)
def test_a_slope_outside_the_asymptotic_range_is_an_input_error(errors, expected, message):
    assert comparison.observed_order((60, 120, 240), errors) > 0.0
    with pytest.raises(InputError, match=message):
        comparison.asymptotic_order((60, 120, 240), errors, expected)


def test_a_shape_of_small_amplitude_under_a_heavy_body_has_a_small_error(titanium_strip):
    heavy = replace(titanium_strip, mass=(PointMass(position=0.3 * titanium_strip.length, mass=1e12),))
    assert SolutionCache(heavy).shape_error("fem", 10, 1) < 1e-3


# --- Grid convergence ---


def covers(found, exact):
    return abs(found.value - exact) <= found.index * abs(found.value)


@pytest.mark.parametrize(("order", "expected", "safe"), [(1.7, None, 1.25), (2.9, 2, None)])
def test_a_power_law_is_extrapolated_to_its_limit(order, expected, safe):
    """Unequal ratios of sizes; a theoretical order below the observed one widens the band."""
    counts, limit = (13, 47, 29), 311.7
    values = [limit * (1.0 - 3.0 * n**-order) for n in counts]
    found = grid_convergence(counts, values, expected)
    assert found.order == pytest.approx(order, rel=1e-10)
    error = limit / values[1] - 1.0
    if safe:
        assert found.extrapolated == pytest.approx(limit, rel=1e-13)
        assert found.index == pytest.approx(safe * error, rel=1e-10)
    else:
        assert found.index > 1.5 * 1.25 * error
        assert found.extrapolated > limit


def test_values_that_do_not_converge_have_an_infinite_band():
    found = grid_convergence((10, 20, 40), (1.0, 1.1, 1.31))
    assert (found.order, found.index, found.extrapolated) == (None, float("inf"), 1.31)
    oscillating = grid_convergence((10, 20, 40), (1.0, 1.4, 1.1))
    assert oscillating.order == pytest.approx(np.log2(4.0 / 3.0), rel=1e-10)


@pytest.mark.parametrize(
    ("model", "settings", "expected", "limited", "unlimited"),
    [
        ("segment", (), 4, (0.90, 0.98), (0.75, 0.88)),
        ("segment", (("wall", "half"),), 2, (0.98, 1.0), (0.88, 0.98)),
        ("fem", (), 4, (0.96, 1.0), (0.92, 0.98)),
    ],
)
def test_the_uncertainty_band_contains_the_exact_frequency(
    titanium_strip, model, settings, expected, limited, unlimited
):
    """Fraction of bands that do, over supports, modes, sizes, ratios: 0.97 without attachments, 0.90 with no order known.

    With Gregory's wall the error changes sign: bands by the observed order alone are too narrow in a fifth of cases.
    """
    by_theory, observed = [], []
    for supports in combinations_with_replacement(("pinned", "clamped", "free", "guided"), 2):
        if settings and "clamped" not in supports:
            continue
        cache = SolutionCache(replace(titanium_strip, supports=supports))
        for mode, n, ratio in product((13, 5, 2, 1), (8, 13, 20, 31), (1.3, 2.0)):
            counts = [round(n * ratio**2), round(n * ratio), n]
            with suppress(InputError):  # too few parts for the mode
                hertz = [cache.frequency_hz(model, count, mode, settings) for count in counts]
                exact = cache.exact_hz(mode)
                by_theory.append(covers(grid_convergence(counts, hertz, expected), exact))
                observed.append(covers(grid_convergence(counts, hertz), exact))
    assert len(by_theory) > 60
    assert limited[0] <= np.mean(by_theory) <= limited[1]
    assert unlimited[0] <= np.mean(observed) <= unlimited[1]


# --- Settings ---

CANTILEVER = load_scene("steel-cantilever").beam


def test_a_setting_of_no_model_is_an_input_error():
    with pytest.raises(InputError, match=r"wall = 'half' is not a setting of fem: leave it out"):
        Rules(wall="half").variants(["fem"])


def test_the_alternatives_are_those_with_an_effect_on_the_beam():
    assert Rules().alternatives(load_scene("paper").beam) == ()
    taut = replace(CANTILEVER, tension=80.0, mass=(PointMass(position=0.1, mass=0.02),))
    labels = [one.label for one in Rules().alternatives(taut)]
    assert labels == [f"segment {one}" for one in ("wall=half", "joints=tensioned", "attachment=lever")]
    assert list(Rules(wall="half").without_effect(load_scene("paper").beam)) == ["wall"]


# --- Sizing ---


def worst_error(bench, model, modes, count):
    try:
        return max(abs(bench.frequency_error(model, count, mode)) for mode in modes)
    except InputError:  # no such mode
        return float("inf")


@pytest.mark.parametrize(
    ("model", "supports", "modes", "most"),
    [
        ("segment", ("clamped", "clamped"), range(3, 4), 70),
        ("segment", ("clamped", "free"), range(2, 3), 70),
        ("segment", ("free", "free"), range(3, 4), 70),
        ("segment", ("guided", "pinned"), range(5, 6), 70),
        ("fem", ("clamped", "guided"), range(3, 4), 40),
        ("segment", ("pinned", "pinned"), range(7, 10), 60),
        ("fem", ("pinned", "pinned"), range(7, 10), 60),
    ],
)
def test_the_sufficient_size_is_that_of_an_enumeration(titanium_strip, model, supports, modes, most):
    """All larger sizes are sufficient too; `smaller` is the smallest before the error changes its sign (33 and 55)."""
    bench, compared = SolutionCache(replace(titanium_strip, supports=supports)), 0
    errors = {n: worst_error(bench, model, modes, n) for n in range(1 + (model == "segment"), most)}
    for error in (0.3, 0.04, 1e-2, 1.1e-3, 1e-4, 3e-5, 3e-6, 1e-6):
        enough = max((n for n in errors if errors[n] > error), default=min(errors) - 1) + 1
        if enough <= most - 10:
            least = min(n for n in errors if errors[n] <= error)
            found = sizing.sufficient_size(bench, model, modes, error)
            expected = (enough, least if least < enough else None, modes[-1])
            assert (found.count, found.smaller, found.mode) == expected, error
            compared += 1
    assert compared >= 3


def test_the_size_holds_for_every_larger_one_where_errors_alternate_with_the_parity_of_n():
    """A stepped chain with printed joints: 71 links are within 0.1 %, 72 and 74 are not."""
    beam = load_scene("beam: 1 m x 40 x 12 mm steel, clamped-free").beam
    beam = replace(beam, section=(Section(length=0.5), Section(length=0.5, thickness=0.008)))
    bench, settings = SolutionCache(beam), {"joints": "printed", "wall": "half"}
    hertz = [MODELS["segment"].build(beam, n, **settings).modes(5).frequencies_hz[4] for n in range(60, 91)]
    beyond = [abs(one / bench.exact_hz(5) - 1.0) > 1e-3 for one in hertz]
    found = sizing.sufficient_size(bench, "segment", 5, 1e-3, tuple(settings.items()))
    assert (found.smaller, found.count) == (60 + beyond.index(False), 91 - beyond[::-1].index(True)) == (71, 75)


def test_the_mode_of_the_largest_size_is_named_and_may_not_be_the_highest():
    """With 2EI/l at the clamp mode 10 needs more links than mode 12."""
    bench, settings = SolutionCache(load_scene("instrument-arm").beam), (("wall", "half"),)
    found = sizing.sufficient_size(bench, "segment", range(1, 13), 1e-3, settings)
    alone = {mode: sizing.sufficient_size(bench, "segment", mode, 1e-3, settings).count for mode in (10, 12)}
    assert (found.count, found.mode) == (alone[10], 10)
    assert alone[12] < alone[10]
    twelve = next(
        one for one in choose(bench, range(1, 13), 1e-3, Rules(wall="half"))[0] if one.variant.model == "segment"
    )
    assert (twelve.size.count, twelve.size.mode) == (found.count, 10)


def test_a_driven_wave_is_trusted_where_its_reflection_is():
    """A frequency error of shear or of links changes the reflection by k L/4 times itself."""
    beam = Beam(length=0.12, width=0.008, thickness=0.0015, youngs_modulus=70e9, density=2700.0)
    forces = [PointForce(position=0.011), PointForce(position=0.109, phase_deg=90.0)]

    def reflection(model):
        return measure(model.harmonic(forces, 7450.0), (0.03, 0.09)).reflection

    exact, errors = reflection(ExactModel(beam)), {}
    errors["shear and rotary inertia"] = reflection(ExactModel(beam, theory="timoshenko")) - exact
    errors["discretisation of 14 segments"] = reflection(SegmentModel(beam, 14)) - exact
    errors["discretisation of 40 segments"] = reflection(SegmentModel(beam, 40)) - exact
    margins = {one.name: one for n in (14, 40) for one in verdict(SegmentModel(beam, n), frequency_hz=7450.0).margins}
    for name, error in errors.items():
        assert 0.01 * margins[name].size / margins[name].fine == pytest.approx(abs(error), rel=0.2, abs=2e-4)
    assert [margins[name].level for name in errors] == ["conditional", "conditional", "trusted"]
