"""A rigid foot on the crests of a wave: sums over many springs, and over the places where a short one stands."""

from math import cos, pi, sin

import numpy as np
import pytest
from scipy.optimize import brentq

from verify.contact import foot, layer
from verify.errors import InputError

S = (np.arange(200_000) + 0.5) * 2.0 * pi / 200_000 - pi


def lain(load):
    """Height over A at which many springs carry `load`."""
    return brentq(lambda z: np.maximum(np.cos(S) - z, 0.0).mean() - load, -load - 1.0, 1.0, xtol=1e-14)


@pytest.mark.parametrize("load", [0.003, 0.11, 0.32, 0.95, 1.0, 1.7])
def test_a_foot_lies_as_deep_as_many_springs(load):
    height = lain(load)
    assert foot.standing_height(load) == pytest.approx(height, abs=3e-9)
    share = np.mean(np.cos(S) > height)
    assert foot.contact_half_angle(load) / pi == pytest.approx(share, abs=2e-5)


@pytest.mark.parametrize(("load", "r"), [(0.11, 0.8), (0.32, 0.1), (0.95, -0.4), (1.0, 0.3), (1.7, 0.6), (1.7, -1.2)])
def test_a_foot_is_driven_by_what_is_faster_than_it(load, r):
    pressures = np.maximum(np.cos(S) - lain(load), 0.0)
    assert foot.foot_force(load, r) == pytest.approx(
        float((pressures * np.sign(np.cos(S) - r)).sum() / pressures.sum()), abs=5e-5
    )


def test_a_foot_that_touches_everywhere_goes_on_from_one_that_hardly_does():
    for r in (-0.7, 0.2, 0.9):
        assert foot.foot_force(1.0, r) == pytest.approx(layer.force(pi - 1e-9, r), abs=1e-8)
        assert foot.foot_force(1.0 - 1e-12, r) == pytest.approx(foot.foot_force(1.0, r), abs=1e-4)
    assert foot.foot_force(40.0, 0.0) == pytest.approx(2.0 / (pi * 40.0), rel=1e-12)


def test_a_light_load_touches_as_the_cube_root_of_it():
    """G(phi) = phi^3/3 there."""
    assert foot.contact_half_angle(1e-6) == pytest.approx((3.0 * pi * 1e-6) ** (1 / 3), rel=1e-4)


def stood(span, places=4001, within=2001):
    """(height, surface speed) where a short upright foot stands on the highest point below it, over one period."""
    middles = (np.arange(places) + 0.5) * 2.0 * pi / places
    under = middles[:, None] + np.linspace(-span, span, within)[None, :]
    heights = np.cos(under).max(axis=1)
    return heights, heights  # the surface runs at V times its height over A


@pytest.mark.parametrize("span", [0.0, 0.2, 0.9, 1.5, 2.2, 3.3])
@pytest.mark.parametrize("r", [-1.3, -0.3, 0.0, 0.44, 0.91, 1.2])
def test_a_short_foot_is_driven_by_the_highest_point_below_it(span, r):
    _, speeds = stood(span)
    assert foot.short_foot_force(span, r) == pytest.approx(float(np.sign(speeds - r).mean()), abs=2e-3)


@pytest.mark.parametrize("span", [0.1, 0.7, 1.4])
def test_a_short_foot_runs_at_the_sine_of_its_span_and_starts_no_load_above_its_dead_band(span):
    speed = foot.short_foot_speed(span)
    assert speed == pytest.approx(sin(span), rel=1e-15)
    assert foot.short_foot_force(span, speed) == pytest.approx(0.0, abs=1e-12)
    assert foot.dead_band(span) == pytest.approx(2.0 * span / pi, rel=1e-12)  # 2 b / lambda
    heights, _ = stood(span)
    assert foot.height_swing(span) == pytest.approx(float(np.ptp(heights)), abs=1e-5)
    assert foot.height_swing(span) == pytest.approx(1.0 + cos(span), rel=1e-15)


def test_a_foot_of_half_a_wavelength_drives_with_all_its_friction_and_of_a_whole_one_stands_still():
    assert foot.dead_band(0.5 * pi) == foot.dead_band(2.0) == 1.0
    assert foot.short_foot_speed(0.5 * pi) == 1.0
    assert foot.height_swing(pi) == foot.height_swing(9.0) == 0.0
    assert foot.dead_band(0.0) == 0.0


@pytest.mark.parametrize(
    ("wrong", "said"),
    [
        (lambda: foot.contact_half_angle(0.0), "load = 0.0"),
        (lambda: foot.standing_height(float("inf")), "load = inf"),
        (lambda: foot.foot_force(2.0, float("nan")), "speed_ratio = nan"),
        (lambda: foot.short_foot_force(-0.1, 0.0), "span = -0.1"),
        (lambda: foot.short_foot_force(0.1, float("nan")), "speed_ratio = nan"),
        (lambda: foot.height_swing(-1.0), "span = -1.0"),
        (lambda: foot.short_foot_speed(-1.0), "span = -1.0"),
    ],
)
def test_a_foot_that_is_none_is_refused(wrong, said):
    with pytest.raises(InputError, match=said):
        wrong()
