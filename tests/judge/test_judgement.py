"""Judgement on arrays whose answer is known."""

import numpy as np
import pytest
from msgspec.structs import replace

from verify.attached import PointMass
from verify.errors import InputError, NoBracketError, NoFigureError, PairingError
from verify.judge import compare
from verify.judge.cache import SolutionCache
from verify.models.modes import Modes

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
    with pytest.raises(PairingError, match=r"mode = 3: no segment mode at count = 40 .* raise count"):
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


def test_a_complex_error_has_an_order_where_it_keeps_its_direction():
    counts, turns = (10, 20, 40), np.exp(1j * np.array([0.1, 0.9, 1.5]))
    errors = [7.0 * n**-2.0 * turn for n, turn in zip(counts, turns, strict=True)]
    assert compare.settled_order(counts, errors) == pytest.approx(2.0, rel=1e-10)
    with pytest.raises(InputError, match="changes sign"):
        compare.settled_order(counts, [errors[0], 1j * errors[1], errors[2]])


def test_a_bracket_knows_its_middle_and_refuses_to_be_thinner_than_rounding():
    found = compare.bracket(99.0, 101.0)
    assert (found.mean, found.relative_width) == (100.0, 0.02)
    for below, above in ((100.0, 100.0 + 1e-12), (101.0, 99.0), (float("nan"), 1.0)):
        with pytest.raises(NoBracketError):
            compare.bracket(below, above)


def test_an_unknown_reading_is_refused_with_those_there_are(titanium_strip):
    with pytest.raises(InputError, match="corrected, raw"):
        SolutionCache(titanium_strip).shape_error("segment", 8, 3, "spline")


def test_a_shape_that_rests_at_every_node_has_no_error():
    """Mode 2 of a pinned beam in one part: 0/0, said in a sentence."""
    with pytest.raises(NoFigureError, match="at rest at every node"):
        compare.shape_error(np.zeros(2), np.array([1e-9, 2e-9]), np.array([0.3, 0.3]))


@pytest.mark.parametrize("parts", [1, 2, 3, 5, 8])
def test_a_mode_seen_at_its_own_nodes_alone_has_no_error(titanium_strip, parts):
    """sin(pi) is 1e-16 in floating point: an error relative to that was told, 6.4 of mode 3 in three elements."""
    with pytest.raises(NoFigureError, match="at rest at every node"):
        SolutionCache(titanium_strip).shape_error("fem", parts, parts)
    assert 1e-4 < SolutionCache(titanium_strip).shape_error("fem", parts + 1, parts) < 0.3


@pytest.mark.parametrize("size", [1e-6, 1e4])
def test_a_mode_seen_at_its_own_nodes_alone_has_no_error_whatever_the_beam_weighs(titanium_strip, size):
    """Deflections of unit modal mass go by the root of the mass: 1e9 m of a speck, 1e-6 m of a bridge."""
    sizes = {name: size * getattr(titanium_strip, name) for name in ("length", "width", "thickness")}
    with pytest.raises(NoFigureError, match="at rest at every node"):
        SolutionCache(replace(titanium_strip, **sizes)).shape_error("fem", 3, 3)
    assert 1e-4 < SolutionCache(replace(titanium_strip, **sizes)).shape_error("fem", 4, 3) < 0.3


def test_a_shape_that_a_heavy_body_keeps_small_is_not_taken_for_rest(titanium_strip):
    heavy = replace(titanium_strip, mass=(PointMass(position=0.3 * titanium_strip.length, mass=1e12),))
    assert SolutionCache(heavy).shape_error("fem", 10, 1) < 1e-3


def test_all_nodes_of_a_high_mode_are_found_each_where_it_is():
    found = compare.zeros(lambda x: np.sin(61 * np.pi * x / 0.73), 0.73, 61)
    assert found == pytest.approx(0.73 * np.arange(1, 61) / 61, abs=1e-13)


def test_three_modes_find_their_likes_among_five_shapes():
    """More shapes than modes: each mode one, by the largest sum, though two of them are most like the same shape."""
    likeness = np.array([[0.1, 0.9, 0.0, 0.0, 0.0], [0.0, 0.8, 0.7, 0.0, 0.1], [0.0, 0.0, 0.0, 0.2, 0.6]])
    index, mac = compare.pair_modes(likeness)
    assert list(index) == [1, 2, 4]
    assert list(mac) == [0.9, 0.7, 0.6]
    own, _ = compare.pair_modes(np.eye(3, 5) + 0.1)
    assert list(own) == [0, 1, 2]
