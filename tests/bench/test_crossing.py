"""Run time over error, on lines whose crossing is known beforehand."""

from math import log

import pytest

from verify.judge.crossing import Point, Stretch, Unearned, at_error, converging, crossing, within


def line(constant, order, seconds, growth, sizes=(1 / 24, 1 / 49, 1 / 98), spread=0.0):
    """Errors constant * size^order, seconds that grow with 1 / size."""
    return [Point(h, constant * h**order, seconds * (h * 24) ** -growth, spread) for h in sizes]


def stretch(*given, order=4.0, **more):
    found = converging(line(*given, **more), (order, order), 0.0)
    assert isinstance(found, Stretch)
    return found


def test_a_cost_between_two_sizes_lies_on_a_straight_line_in_logarithms():
    assert at_error([1e-2, 1e-4, 1e-5], [2.0, 8.0, 9.0], 1e-3) == pytest.approx(4.0, rel=1e-12)
    assert at_error([1e-2, 1e-4, 1e-5], [2.0, 8.0, 9.0], 1e-5) == pytest.approx(9.0, rel=1e-12)


def test_the_cheaper_one_changes_where_two_power_laws_meet():
    """Costs a e^(-p/4): 1 e^-0.25 of one, 0.2 e^-0.5 of the other meet at e = 0.2^4."""
    errors = (1e-1, 1e-2, 1e-3, 1e-4)
    one, other = (
        Stretch(tuple(Point(e**0.25, e, a * e**-p) for e in errors), (4.0,) * 3) for a, p in ((1.0, 0.25), (0.2, 0.5))
    )
    found = crossing(one, other)
    assert found.crossings == (pytest.approx(0.2**4, rel=1e-9),)
    assert found.ratios[0][1] == pytest.approx(0.2 * 1e-4**-0.25, rel=1e-9)
    assert (found.low, found.high) == (1e-4, 1e-1)


def test_the_cheaper_one_changes_where_its_own_rows_say_within_the_spread_too():
    """Costs as a bench of a chain had them: straight lines between (ln e, ln r) = (-8.94, -0.41) and (-11.5, 0.02)."""
    errors = (1.3e-4, 1.04e-5, 9.26e-7)
    one = Stretch(tuple(Point(e, e, s, 0.05) for e, s in zip(errors, (2.67, 3.07, 3.97), strict=True)), (1.0,) * 2)
    other = Stretch(tuple(Point(e, e, s, 0.07) for e, s in zip(errors, (1.77, 3.13, 5.2), strict=True)), (4.0,) * 2)
    at = 1.04e-5 * (1.3e-4 / 1.04e-5) ** (log(3.13 / 3.07) / log(3.13 / 3.07 * 2.67 / 1.77))
    found = crossing(one, other)
    assert found.crossings == (pytest.approx(at, rel=1e-12),)
    assert one.seconds(at) == pytest.approx(other.seconds(at), rel=1e-12)


def test_nothing_changes_where_the_difference_lies_within_the_spread():
    one = stretch(1.0, 4.0, 1.0, 1.0, spread=0.6)
    other = stretch(1.3, 4.0, 0.8, 1.3, spread=0.6)
    assert crossing(one, other).crossings == ()


def test_a_line_that_is_exactly_as_dear_stands_at_one():
    one = stretch(1.0, 4.0, 1.0, 1.5)
    assert [ratio for _, ratio in crossing(one, one).ratios] == pytest.approx([1.0] * 3)


@pytest.mark.parametrize(
    ("errors", "why"),
    [
        ((1e-2, 1e-3), "2 sizes"),
        ((1e-2, 3e-3, 2.9e-3), "not at order 4"),
        ((1e-2, -1e-3, 1e-4), "a change of sign"),
        ((1e-2, 6e-4, 3e-5, 4e-5), "not at order 4"),
        ((1e-2, 6e-4, -3e-5, 2e-6), "a change of sign"),
        ((3e-2, 2e-3, 1.2e-4, 0.7), "not at order 4"),
        ((1e-13, 2e-13, 1e-14), "rounding"),
        ((0.96, 0.06, 0.0038), "errors up to 96 % are no answers"),
    ],
)
def test_times_stand_for_nothing_where_errors_do_not_fall_at_their_order(errors, why):
    points = [Point(0.1 / 2**i, error, 1.0) for i, error in enumerate(errors)]
    found = converging(points, (4.0, 4.0), 1e-12)
    assert isinstance(found, Unearned)
    assert why in found.why
    assert found.remedy


@pytest.mark.parametrize(("orders", "told"), [((4.0, 4.0), "4"), ((2.0, 4.0), "2 to 4"), ((1.0, 1.5), "1 to 1.5")])
def test_the_orders_that_were_expected_are_told_where_another_is_seen(orders, told):
    points = [Point(0.1 / 2**i, 0.03 / 64.0**i, 1.0) for i in range(4)]
    found = converging(points, orders, 1e-12)
    assert isinstance(found, Unearned)
    assert found.why == f"errors fall not at order {told} but at 6.00, 6.00, 6.00"


def test_coarse_sizes_before_the_order_and_fine_ones_that_are_rounding_are_left_out():
    errors = (0.9, 1.6e-2, 1e-3, 6.25e-5, 1e-13)
    points = [Point(0.1 / 2**i, error, 1.0) for i, error in enumerate(errors)]
    found = converging(points, (4.0, 4.0), 1e-12)
    assert found.span == (6.25e-5, 1.6e-2)
    assert found.orders == pytest.approx((4.0, 4.0))


@pytest.mark.parametrize(
    ("errors", "smallest", "beyond"),
    [
        ((3e-2, 2e-3, 1.2e-4, -9e-5), 1.2e-4, 1),  # rounding of another sign
        ((3e-2, 2e-3, 1.2e-4, 3e-5, 7e-6), 1.2e-4, 2),  # of order 2 from there on
        ((3e-2, 2e-3, 1.2e-4, 7.6e-6, 6e-5), 1.2e-4, 2),  # what a finer size exceeds is not promised
    ],
)
def test_finer_sizes_that_exceed_no_error_of_the_stretch_take_nothing_from_it(errors, smallest, beyond):
    found = converging([Point(0.1 / 2**i, error, 1.0) for i, error in enumerate(errors)], (4.0, 4.0), 1e-12)
    assert isinstance(found, Stretch)
    assert found.span == (smallest, 3e-2)
    assert found.n_finer == beyond


def test_methods_that_share_no_error_are_not_compared():
    found = crossing(stretch(1e-3, 4.0, 1.0, 1.0), stretch(1e3, 4.0, 1.0, 1.0))
    assert isinstance(found, Unearned)
    assert "no error in common" in found.why


def test_the_time_at_an_error_is_that_of_the_coarsest_size_from_which_on_all_are_within_it():
    points = [Point(0.1 / 2**i, error, float(2**i)) for i, error in enumerate((0.8, 1e-2, -1e-4, 1e-6))]
    assert within(points, 2e-2) == 2.0  # before it stands no answer
    assert within(points, 1e-3) == pytest.approx(2.0 * 2.0**0.5, rel=1e-12)
    assert within(points, 1e-4) == pytest.approx(4.0, rel=1e-12)
    assert within(points, 1e-3, between=False) == 4.0  # of the sizes that ran
    assert within(points[2:], 1e-2) == 4.0  # as coarse as it goes: nothing is foretold
    assert within(points, 1e-7) is None
    assert within([], 1e-3) is None
    assert within([points[2], points[1]], 1e-3) is None  # it was within for a while
