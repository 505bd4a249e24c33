"""Pairing, orders, settings and sizes."""

import numpy as np
import pytest
from msgspec.structs import replace

from verify.analysis import compare, sizing
from verify.analysis.sizing import choose_of_all
from verify.analysis.solution_cache import SolutionCache
from verify.analysis.variants import Rules, Variant, every_rule
from verify.errors import InputError, NoBracketError
from verify.exact import error_laws
from verify.linear.modes import Modes
from verify.problem.cross_section import Section
from verify.problem.point_attachments import PointMass
from verify.scene.load import load_scene

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


def test_mac_is_one_for_a_scaled_turned_shape_and_zero_for_an_orthogonal_one():
    likeness = compare.mac(SINES[:2], np.array([-3.7 * SINES[0], SINES[2]]))
    assert likeness == pytest.approx(np.array([[1, 0], [0, 0]]), abs=1e-14)


def test_exchanged_modes_are_paired_by_shape_not_by_rank():
    modes = fake_modes(SINES[[0, 2, 1, 3]])
    assert [compare.paired_index(modes, SINES, n, 1) for n in (1, 2, 3, 4)] == [0, 2, 1, 3]


def test_a_close_pair_that_mixed_a_little_is_still_paired_one_to_one():
    turned = SINES.copy()
    turned[1], turned[2] = 0.9 * SINES[1] + 0.44 * SINES[2], 0.9 * SINES[2] - 0.44 * SINES[1]
    index, likeness = compare.pair_modes(compare.mac(SINES, turned))
    assert list(index) == [0, 1, 2, 3]
    assert likeness[1] == pytest.approx(0.81 / (0.81 + 0.44**2), abs=1e-12)


def test_a_shape_that_no_mode_has_is_said_to_have_no_partner():
    lost = SINES.copy()
    lost[2] = np.sin(9 * np.pi * X)
    with pytest.raises(InputError, match=r"mode = 3: no segment mode at count = 40 .* raise count"):
        compare.paired_index(fake_modes(lost), SINES, 3, 1)


def test_shape_error_is_free_of_sign_and_counts_the_amplitude():
    weights = compare.node_weights(X)
    assert compare.shape_error(SINES[2], -SINES[2], weights) == 0
    assert compare.shape_error(SINES[2], -1.07 * SINES[2], weights) == pytest.approx(0.07, rel=1e-12)
    assert compare.shape_error(SINES[0], SINES[1], weights) == pytest.approx(np.sqrt(2), rel=1e-12)


@pytest.mark.parametrize("order", [0.7, 2.0, 4.0, 6.1])
def test_the_observed_order_of_an_exact_power_is_that_power(order):
    counts = (11, 19, 53, 101)
    assert compare.observed_order(counts, [-33.0 * n**-order for n in counts]) == pytest.approx(order, rel=1e-10)


@pytest.mark.parametrize(
    ("counts", "errors", "message"),
    [
        ((10, 20), (1e-3, 1e-4), "three or more"),
        ((10, 20, 20), (1e-3, 1e-4, 1e-4), "three or more"),
        ((10, 20, 40), (1e-3, -1e-4, -1e-5), "changes sign"),
        ((10, 20, 40), (1e-9, 1e-11, 3e-13), "is rounding"),
        ((10, 20, 40), (1e-3, float("nan"), 1e-5), "not finite"),
    ],
)
def test_an_order_is_refused_where_there_is_none(counts, errors, message):
    with pytest.raises(InputError, match=message):
        compare.observed_order(counts, errors)


@pytest.mark.parametrize("due", [None, 4])
def test_an_order_is_settled_where_the_error_falls_alike_from_size_to_size(due):
    counts, errors = (80, 20, 40), (2e-7, 4.2e-5, 3e-6)
    assert compare.settled_order(counts, errors, due) == compare.observed_order(counts, errors)


@pytest.mark.parametrize(
    ("errors", "due", "message"),
    [
        ((0.122, 0.0024, 0.001), None, r"no settled order between them \(5.67, 1.26\)"),
        ((1e-3, 2e-3, 1e-5), None, "no settled order"),
        ((1e-3, 1e-3 / 37, 1e-3 / 37**2), 4, "5.21, 5.21, where 4 is due"),
        ((1e-3, 1e-3 / 3.0, 1e-4), 4, "no settled order"),
    ],
)
def test_a_slope_through_errors_that_fall_at_no_order_is_refused(errors, due, message):
    assert compare.observed_order((60, 120, 240), errors) > 0.0
    with pytest.raises(InputError, match=message):
        compare.settled_order((60, 120, 240), errors, due)


def test_a_bracket_knows_its_middle_and_refuses_to_be_thinner_than_rounding():
    found = compare.bracket(99.0, 101.0)
    assert (found.mean, found.relative_width) == (100.0, 0.02)
    for below, above in ((100.0, 100.0 + 1e-12), (101.0, 99.0), (float("nan"), 1.0)):
        with pytest.raises(NoBracketError):
            compare.bracket(below, above)


def test_a_shape_that_a_heavy_body_keeps_small_is_not_taken_for_rest(titanium_strip):
    heavy = replace(titanium_strip, mass=(PointMass(position=0.3 * titanium_strip.length, mass=1e12),))
    assert SolutionCache(heavy).shape_error("fem", 10, 1) < 1e-3


def test_all_nodes_of_a_high_mode_are_found_each_where_it_is():
    found = compare.zeros(lambda x: np.sin(61 * np.pi * x / 0.73), 0.73, 61)
    assert found == pytest.approx(0.73 * np.arange(1, 61) / 61, abs=1e-13)


# --- Settings ---

CANTILEVER = load_scene("steel-cantilever").beam


def labels(variants):
    return [one.label for one in variants]


def test_a_setting_that_no_model_has_is_refused():
    with pytest.raises(InputError, match=r"wall = 'half' is a setting of none of fem: leave it out"):
        Rules(wall="half").variants(["fem"])


def test_the_rules_that_make_a_difference_are_those_of_what_the_beam_has():
    assert every_rule(load_scene("paper").beam) == ()
    walls = labels(every_rule(CANTILEVER))
    assert walls == [f"segment wall={wall}" for wall in ("half", "welded", "third-order", "five-joint")]
    stepped = replace(
        CANTILEVER, section=(Section(length=0.25), Section(length=CANTILEVER.length - 0.25, youngs_modulus=70e9))
    )
    assert "segment joints=printed" in labels(every_rule(stepped))
    assert "segment wall=welded" not in labels(every_rule(stepped))
    taut = replace(CANTILEVER, tension=80.0, mass=(PointMass(position=0.1, mass=0.02),))
    assert labels(every_rule(taut))[-2:] == ["segment joints=tensioned", "segment attachment=lever"]
    assert labels(every_rule(CANTILEVER, (("theory", "timoshenko"),)))[0] == "segment wall=half theory=timoshenko"


def test_a_choice_shows_69_links_of_the_literature_beside_19():
    choices, left_out = choose_of_all(SolutionCache(CANTILEVER), 5, 1e-3)
    found = {one.variant.label: one.count for one in choices}
    assert found["segment"] == 19
    assert found["segment wall=half"] == 69
    assert not left_out


def test_under_tension_a_choice_shows_the_joint_that_needs_a_sixth_of_the_links():
    found = {
        one.variant.label: one.count for one in choose_of_all(SolutionCache(load_scene("taut-strip").beam), 3, 1e-3)[0]
    }
    assert (found["segment"], found["segment joints=tensioned"]) == (56, 10)


def test_the_theoretical_orders_are_told_for_the_beam_at_hand():
    orders = {
        "gregory": Variant("segment").order(CANTILEVER),
        "half": Variant("segment", (("wall", "half"),)).order(CANTILEVER),
        "stepped": Variant("segment").order(load_scene("stepped-beam").beam),
        "printed": Variant("segment", (("joints", "printed"),)).order(load_scene("stepped-beam").beam),
        "taut": Variant("segment").order(load_scene("taut-strip").beam),
        "tensioned": Variant("segment", (("joints", "tensioned"),)).order(load_scene("taut-strip").beam),
        "elements": Variant("fem").order(load_scene("stepped-beam").beam),
    }
    assert orders == {
        "gregory": 4,
        "half": 2,
        "stepped": 2,
        "printed": 1,
        "taut": 2,
        "tensioned": 4,
        "elements": 4,
    }


# --- Sizing ---


def errors_of(bench, model, mode, sizes, settings=()):
    """The size of the solved error at every size, infinite where the model has no such mode."""
    found = {}
    for count in sizes:
        try:
            found[count] = abs(bench.frequency_error(model, count, mode, settings))
        except InputError:
            found[count] = float("inf")
    return found


def by_brute_force(errors, error):
    """(the size from which on all are within, the smallest of all that are, None where it is the same)."""
    enough = max((n for n in errors if errors[n] > error), default=min(errors) - 1) + 1
    least = min((n for n in errors if errors[n] <= error), default=enough)
    return enough, least if least < enough else None


def smallest(beam, model):
    return max(len(beam.pieces), 1 + (model == "segment"))


@pytest.mark.parametrize(
    ("model", "supports", "mode", "most"),
    [
        ("segment", ("clamped", "clamped"), 3, 70),
        ("segment", ("clamped", "free"), 2, 70),
        ("segment", ("pinned", "clamped"), 4, 70),
        ("segment", ("free", "free"), 3, 70),
        ("segment", ("guided", "pinned"), 5, 70),
        ("fem", ("clamped", "guided"), 3, 40),
        ("fem", ("pinned", "pinned"), 4, 40),
    ],
)
def test_from_here_on_is_what_every_size_tried_says(titanium_strip, model, supports, mode, most):
    bench = SolutionCache(replace(titanium_strip, supports=supports))
    errors = errors_of(bench, model, mode, range(smallest(bench.beam, model), most))
    compared = 0
    for error in (0.3, 0.04, 1e-2, 1.1e-3, 3e-5, 3e-6, 1e-6):
        expected = by_brute_force(errors, error)
        if expected[0] <= most - 10:
            found = sizing.enough_from(bench, model, mode, error)
            assert (found.count, found.smaller) == expected, error
            compared += 1
    assert compared >= 4


def test_an_error_that_changes_its_sign_does_before_it_stays(titanium_strip):
    beam = replace(titanium_strip, supports=("clamped", "clamped"))
    found = sizing.enough_from(SolutionCache(beam), "segment", 3, 1e-6)
    assert (found.count, found.smaller) == (55, 33)


def test_all_of_several_modes_are_kept_and_the_one_that_asks_for_most_is_named():
    """With 2EI/l at the clamp mode 10 needs more links than mode 12."""
    bench, settings = SolutionCache(load_scene("instrument-arm").beam), (("wall", "half"),)
    found = sizing.enough_from(bench, "segment", range(1, 13), 1e-3, settings)
    alone = {mode: sizing.enough_from(bench, "segment", mode, 1e-3, settings).count for mode in (10, 12)}
    assert (found.count, found.mode) == (alone[10], 10)
    assert alone[12] < alone[10]
    twelve = next(one for one in sizing.choose(bench, 12, 1e-3, (sizing.Variant("segment", settings),)))
    assert twelve.lower == (10,)


@pytest.mark.parametrize(("model", "error"), [("segment", 0.01), ("fem", 0.035), ("fem", 1e-4)])
def test_all_of_several_modes_by_the_dispersion(titanium_strip, model, error):
    bench = SolutionCache(titanium_strip)
    errors = [errors_of(bench, model, mode, range(9, 60)) for mode in (7, 8, 9)]
    expected = by_brute_force({n: max(each[n] for each in errors) for n in errors[0]}, error)
    found = sizing.enough_from(bench, model, range(7, 10), error)
    assert (found.count, found.smaller) == expected
    assert found.mode == 9


def leading(model, beam, mode, count):
    return error_laws.leading_error(model, beam.supports, mode, count)


@pytest.mark.parametrize(
    "supports", [("clamped", "clamped"), ("clamped", "free"), ("free", "free"), ("pinned", "guided")]
)
@pytest.mark.parametrize("model", ["segment", "fem"])
@pytest.mark.parametrize("error", [3e-3, 1e-6, 1e-8, 4e-10, 3e-11])
def test_the_law_is_kept_from_there_on_and_not_before(titanium_strip, supports, model, error):
    beam = replace(titanium_strip, supports=supports)
    found = error_laws.parts_from_here_on(model, beam, 2, error)
    sizes = range(error_laws.smallest_count(beam, 2), 12_000)
    law = error_laws.expected_error if supports == ("pinned", "guided") else leading
    failing = [n for n in sizes if abs(law(model, beam, 2, n)) > error]
    assert found == max(failing, default=sizes[0] - 1) + 1
    assert found < 12_000
