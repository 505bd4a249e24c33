"""Of many points under tanh one speed agrees with all their friction, to rounding and after a few looks at them."""

from types import SimpleNamespace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from interpreted import interpreted

from verify.motor import beam_kernels, rub_kernels
from verify.motor.records import PUSH, RUB, SURFACE, SURFACE_BEFORE

MU, MASS, DT = 0.23, 0.05, 1.0 / 4276.0 / 61.0


def touching(phase, points=32, speed=0.05):
    """Crests of a wave under a foot that is as long as it: those that rise press, each turned on by a step."""
    touch = np.zeros((points, 64))
    angle = phase + np.linspace(0.0, 2.0 * np.pi, points, endpoint=False)
    touch[:, SURFACE] = speed * np.cos(angle)
    touch[:, SURFACE_BEFORE] = speed * np.cos(angle - np.pi / 61.0)
    touch[:, PUSH] = np.maximum(0.5 / points * (0.3 + np.cos(angle)), 0.0)
    return touch


def mean_of_tanh(low, high, slope):
    """By Gauss's rule on pieces no longer than half a turn of the law."""
    parts = np.linspace(low, high, 2 + int(2.0 * slope * abs(high - low)))
    nodes, weights = np.polynomial.legendre.leggauss(12)
    middles, halves = 0.5 * (parts[1:] + parts[:-1]), 0.5 * np.diff(parts)
    return (np.tanh(slope * (middles + nodes[:, None] * halves)) * weights[:, None] * halves).sum() / (high - low)


def agreed(touch, v, slope, pull=0.03):
    """(mean, end, how often all points were looked at)."""
    agree, looks = interpreted(rub_kernels, "agree"), []
    slid = agree.__globals__["_slid"]
    agree.__globals__["_slid"] = lambda *given: looks.append(given[2]) or slid(*given)
    return *agree(0, len(touch), DT / MASS, pull, v, MU, slope, touch), len(looks)


@settings(max_examples=60, deadline=None)
@given(phase=st.floats(0.0, 6.28), v=st.floats(-0.06, 0.06), slope=st.sampled_from([3.0, 300.0, 1e4, 3e6]))
def test_a_slider_s_mean_speed_agrees_with_friction_on_all_its_points(phase, v, slope):
    touch, pull = touching(phase), 0.03
    mean, end, looks = agreed(touch, v, slope, pull)
    assert end == pytest.approx(2.0 * mean - v, abs=1e-17)
    wide = 0.5 * DT / MASS * MU * touch[:, PUSH].sum()
    friction = 0.0
    for ahead, before, push, rub in touch[:, [SURFACE, SURFACE_BEFORE, PUSH, RUB]]:
        half = 0.5 * abs(ahead - before) - wide
        turned = np.tanh(slope * (ahead - mean))
        if half * slope >= 1.0:
            turned = mean_of_tanh(ahead - mean - half, ahead - mean + half, slope)
        assert rub == pytest.approx(MU * push * turned, abs=1e-10 * MU * push)
        friction += rub
    assert mean - v == pytest.approx(0.5 * DT / MASS * (pull + friction), abs=1e-14 * (abs(v) + wide))
    assert looks <= 12


def test_most_steps_take_three_looks():
    """Where Newton's step had come to its end all further looks halved a way that was none: forty."""
    looks = [agreed(touching(0.37 * i), 0.05 * np.sin(i), 1e4)[2] for i in range(40)]
    assert np.median(looks) <= 3
    assert max(looks) <= 12


@pytest.mark.parametrize("slope", [40.0, 1e4])
def test_a_point_on_a_beam_that_feels_it_takes_a_few_looks(slope):
    slide = interpreted(beam_kernels, "slide_by_tanh")
    looks = []
    slide.__globals__["np"] = SimpleNamespace(tanh=lambda x: looks.append(x) or np.tanh(x))
    most, ease = 0.031, 0.7
    for slip in np.linspace(-0.04, 0.05, 37):
        looks.clear()
        force = slide(most, slip, ease, slope)
        assert force == pytest.approx(most * np.tanh(slope * (slip - ease * force)), abs=3e-12 * slope * most * ease)
        assert len(looks) <= 20, slip
