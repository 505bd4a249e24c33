"""Splines, searches and sets that are made here, against scipy's and numpy's, which are the same."""

import numpy as np
import pytest
from scipy.interpolate import CubicSpline

from verify.models.search import least_over, zero_between
from verify.models.spline import natural_or_flat


@pytest.mark.parametrize("n_nodes", [2, 3, 8, 257])
@pytest.mark.parametrize("ends", [(1, 1), (2, 2), (1, 2), (2, 1), (0, 0), (0, 1), (2, 0)])
def test_a_spline_is_scipys_to_rounding(n_nodes, ends):
    rng = np.random.default_rng(61)
    nodes = np.cumsum(0.3 + rng.random(n_nodes)) - 1.7
    values = rng.standard_normal((3, n_nodes))
    kinds = tuple((order, np.zeros(3)) if order else "not-a-knot" for order in ends)
    known = CubicSpline(nodes, values, axis=1, bc_type=kinds)
    own = natural_or_flat(nodes, values, ends)
    x = np.concatenate([nodes, np.linspace(nodes[0], nodes[-1], 301)])
    size = abs(known.c).max()  # of pieces about as long as one
    for derivative in range(5):
        assert own(x, derivative) == pytest.approx(known(x, derivative), abs=3e-13 * size, rel=0.0), derivative
    assert own.c.shape == known.c.shape
    assert own.c == pytest.approx(known.c, abs=3e-13 * size, rel=0.0)


@pytest.mark.parametrize("floor", [0.0, 1e-9, 0.02])
@pytest.mark.parametrize("at", [4269.07, 4252.9, 4289.9])
def test_a_size_that_falls_to_nothing_is_least_where_it_does_in_a_few_steps(floor, at):
    """A reflection's corner, |sin| of a phase, bare or over a floor that losses leave: by hand where it is."""
    steps = []

    def size(x):
        steps.append(len(x))
        return np.hypot(np.sin(0.004 * (x - at)) * (1.0 + 2e-3 * (x - at)), floor)

    found = least_over(size, np.linspace(4250.0, 4290.0, 41), 1e-5)
    assert abs(found.x - at) < 1e-5
    assert found.value == pytest.approx(floor, abs=4e-8, rel=1e-9)
    assert not found.at_edge
    assert len(steps) < 30
    assert steps[0] == 41


def test_a_size_that_still_falls_where_a_search_ends_is_least_there():
    for sign, end in ((1.0, 3.0), (-1.0, 7.0)):
        found = least_over(lambda x, sign=sign: np.exp(sign * x), np.linspace(3.0, 7.0, 9), 1e-6)
        assert found.at_edge
        assert found.x == pytest.approx(end, abs=1e-5)
        assert found.value == pytest.approx(np.exp(sign * found.x), rel=1e-12)


def test_a_zero_is_not_made_up_where_both_ends_have_one_sign():
    with pytest.raises(ValueError, match="different signs"):
        zero_between(lambda x: x * x + 0.1, -1.0, 2.0, 1e-12, 1e-12)
