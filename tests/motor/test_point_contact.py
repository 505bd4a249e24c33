"""A point on a spring and a dashpot over a wave: against DOP853 from event to event, with orders in the step."""

from functools import cache

import numpy as np
import pytest
from driven_strip import HALF, MIDDLE, OMEGA, PERIOD, drive, on_strip, slider_of
from reference.motor import DRAGGED, PRESSED, STUCK, TOUCHED, OneWay, Point, Rider, V, X, Z, body, lift_off_ratio

AMPLITUDE, BACK, MASS, LOAD, STIFFNESS, PERIODS = 1e-6, 0.1, 2e-3, 2.0, 5e6, 5
SPAN = PERIODS * PERIOD
CASES = {
    "sticks and slips": Point(MASS, LOAD, STIFFNESS),
    "tanh": Point(MASS, LOAD, STIFFNESS, slope=300.0),
    "gives way": Point(MASS, LOAD, STIFFNESS, give=2e5),
    "prescribed, gives way, damped": Point(MASS, LOAD, STIFFNESS, give=2e5, prescribed=-2e-4, damping=0.5),
    "pulled, on a preload spring": Point(MASS, LOAD, STIFFNESS, pull=-0.05, load_stiffness=2e5, damping=1.0),
}


@cache
def reference(name):
    """(states at every period, events)."""
    wave, point = drive(AMPLITUDE, BACK)[1], CASES[name]
    level = float(wave.at(MIDDLE + HALF * wave.at(MIDDLE, 0.0)[2], 0.0)[0])
    rest = (level * STIFFNESS - LOAD) / (STIFFNESS + point.load_stiffness)
    start, times = body(MIDDLE, z=rest, v=point.prescribed or 0.0), np.arange(1, PERIODS + 1) * PERIOD
    return Rider(point, OneWay(wave.at, HALF)).run(start, times, PERIOD)


@cache
def run(name, steps):
    asked = {"speed": CASES[name].prescribed, "samples": PERIODS + 1}
    return on_strip(slider_of(CASES[name]), AMPLITUDE, BACK, PERIODS, steps, **asked)


def motion_error(name, steps):
    """Largest of place, speed and height, each over its size."""
    found = run(name, steps)
    found = np.stack([found.travelled[1:] + MIDDLE, found.speed[1:], found.height[1:, 0]], axis=1)
    return np.abs(found - reference(name)[0][:, [X, V, Z]]).max(axis=0) / (1e-7, 1e-3, 1e-6)


@pytest.mark.parametrize("name", CASES)
def test_motion_impulses_and_contact_times_equal_the_event_driven_ode(name):
    found, last = run(name, 4000), reference(name)[0][-1] / SPAN
    assert motion_error(name, 4000).max() < 1e-3
    assert found.normal_force[1:].mean() == pytest.approx(last[PRESSED], abs=5e-6 * LOAD)
    assert found.friction[1:].mean() == pytest.approx(last[DRAGGED], abs=2e-4 * LOAD)
    assert found.contact_fraction[1:].mean() == pytest.approx(last[TOUCHED], abs=2e-4)
    assert found.stick_fraction[1:].mean() == pytest.approx(last[STUCK], abs=2e-4)


@pytest.mark.parametrize("name", CASES)
def test_height_converges_and_the_energy_balance_closes_with_the_square_of_the_step(name):
    """Where a step meets an event is chance: means over several steps, over a factor of 32."""
    some = np.array([125, 133, 141, 149])
    coarse, fine = (np.mean([motion_error(name, n)[2] for n in steps[:2]]) for steps in (some, 32 * some))
    assert 1.5 < np.log2(coarse / fine) / 5.0 < 2.5
    left = [np.mean([abs(run(name, n).energy.residual) for n in steps]) for steps in (some, 32 * some)]
    books = run(name, 4000).energy
    assert left[1] < 1e-5 * (abs(books.normal_work) + abs(books.load_work) + books.friction_loss)
    assert 1.7 < np.log2(left[0] / left[1]) / 5.0 < 2.5


@pytest.mark.parametrize(("ratio", "zeta"), [(0.41, 0.23), (1.7, 0.31), (0.93, 0.42)])
def test_the_least_normal_force_below_lift_off_is_the_closed_form(ratio, zeta):
    """N falls to 1 - share of the load where the acceleration is this share of |1 - r^2/(1 + 2 i zeta r)|."""
    stiffness = MASS * (OMEGA / ratio) ** 2
    damping = 2.0 * zeta * np.sqrt(stiffness * MASS)
    for share in (0.5, 0.9, 1.1):
        load = MASS * AMPLITUDE * OMEGA**2 / (share * lift_off_ratio(ratio, zeta))
        slider = slider_of(Point(MASS, load, stiffness, damping))
        found = on_strip(slider, periods=40, steps=400, speed=0.0, samples=16001)
        assert found.pressures[-2000:].min() / load == pytest.approx(max(1.0 - share, 0.0), abs=2e-3)
