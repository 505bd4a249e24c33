"""The search for the longest step, on errors whose answer is known."""

from math import inf, nan

import numpy as np
import pytest

from verify.errors import InputError
from verify.peers.case import PeerRun
from verify.peers.ladder import FINEST, deflection_error, longest_step, relative_rms, ride_error


def search(error, first, wanted, **more):
    """(what was found, the steps in the order in which they were run)."""
    asked = []

    def run(step):
        asked.append(step)
        return error(step)

    return longest_step(run, first, wanted, lambda found: found, **more), asked


@pytest.mark.parametrize(("order", "size"), [(1, 300.0), (2, 1e9), (4, 1e15)])
@pytest.mark.parametrize("wanted", [1e-3, 1e-5])
def test_a_method_of_any_order_gets_its_own_longest_step(order, size, wanted):
    found, asked = search(lambda step: size * step**order, 2e-5, wanted)
    exact = (wanted / size) ** (1 / order)
    if exact > 2e-5:
        assert (found.step, len(asked)) == (2e-5, 1)
        return
    assert found.reached
    assert exact / FINEST <= found.step <= exact
    assert found.error == size * found.step**order
    assert len(asked) <= 8


def test_a_limit_of_stability_is_found_as_closely():
    found, asked = search(lambda step: inf if step > 3.1e-6 else 1e-9, 2e-5, 1e-3)
    assert 3.1e-6 / FINEST <= found.step <= 3.1e-6
    assert len(asked) <= 10


def test_all_shorter_steps_tried_are_good_enough_where_an_error_wavers():
    found, _ = search(lambda step: 1e9 * step**2 * (1.5 + np.sin(2e7 * step)), 2e-5, 1e-4)
    assert found.reached
    assert all(rung.error <= 1e-4 for rung in found.tried if rung.step <= found.step)
    assert any(rung.error > 1e-4 for rung in found.tried if rung.step > found.step)


def test_a_floor_of_the_error_is_said_and_the_least_of_it_kept():
    found, _ = search(lambda step: 2e-4 + 1e9 * step**2, 2e-5, 1e-4)
    assert not found.reached
    assert "stays at 2.0e-04" in found.why_not
    assert found.error == min(rung.error for rung in found.tried)


@pytest.mark.parametrize("broken", [nan, inf])
def test_runs_that_all_break_end_in_words(broken):
    found, asked = search(lambda step: broken, 1e-5, 1e-3)
    assert found.why_not == f"no step down to {min(asked):.3g} s was good enough"
    assert found.error == inf


def test_a_run_that_would_take_too_long_is_not_begun():
    found, asked = search(lambda step: 1e9 * step**2, 2e-5, 1e-5, patience=1.0, clock=lambda error: 1e-5)
    assert found.reached  # quick runs are all begun
    slow, asked_slowly = search(lambda step: 1e9 * step**2, 2e-5, 1e-5, patience=1.0, clock=lambda error: 0.7)
    assert slow.why_not.endswith("takes more than 1 s")
    assert asked_slowly == asked[:1]


def test_bad_input_is_refused_by_name():
    with pytest.raises(InputError, match="first = 0"):
        search(lambda step: 0.0, 0.0, 1e-3)
    with pytest.raises(InputError, match="wanted = -1"):
        search(lambda step: 0.0, 1e-5, -1)


def run_of(count, broke="", off=0.0):
    times = np.linspace(1e-5, 1e-3, count)
    wave = np.sin(9e3 * times)
    return PeerRun(
        times=times,
        deflection=wave * (1 + off),
        distance=wave * (1 - 2 * off),
        speed=wave * (1 + 3 * off),
        seconds=0.0,
        set_up_s=0.0,
        steps=count,
        broke=broke,
    )


def test_errors_are_relative_rms_and_infinite_where_a_run_broke_or_kept_too_little():
    def exact(times):
        return np.sin(9e3 * times)

    assert deflection_error(run_of(60, off=0.01), exact) == pytest.approx(0.01, rel=1e-9)
    assert ride_error(run_of(60, off=0.01), lambda t: (exact(t), exact(t))) == pytest.approx(0.03, rel=1e-9)
    for lost in (run_of(60, "at t = 1 s"), run_of(39)):
        assert deflection_error(lost, exact) == inf
        assert ride_error(lost, lambda t: (exact(t), exact(t))) == inf
    assert relative_rms(np.array([1.0, nan]), np.ones(2)) == inf
