"""A mass on a shaking surface, flown in small steps beside the closed forms."""

from decimal import Decimal, localcontext
from math import asin, cos, pi, sin, sqrt

import numpy as np
import pytest

from verify.contact.bouncing import bounce_in_step, bouncing_limits, landing_phase, leaving_phase
from verify.errors import InputError


def flown(ratio, step=1e-4):
    """The phase of landing by flying in small steps from where the surface falls away faster than the mass can."""
    theta = 0.0
    while sin(theta) < 1.0 / ratio:
        theta += step
    height, speed = sin(theta), cos(theta)
    while True:
        height += speed * step - 0.5 * step * step / ratio
        speed -= step / ratio
        theta += step
        if height < sin(theta):
            return theta


@pytest.mark.parametrize("ratio", [1.2, 1.5, 2.0, 3.1])
def test_a_mass_lands_where_it_flies_to(ratio):
    assert landing_phase(ratio) == pytest.approx(flown(ratio), abs=2e-3)
    assert leaving_phase(ratio) == pytest.approx(asin(1.0 / ratio), rel=1e-15)


def test_a_flight_lasts_a_period_at_the_root_of_one_and_pi_squared():
    ratio = sqrt(1.0 + pi**2)
    assert landing_phase(ratio) - leaving_phase(ratio) == pytest.approx(2.0 * pi, rel=1e-12)


@pytest.mark.parametrize("ratio", [37.3, 2.71e5, 8.9e8])
def test_a_hard_shake_throws_it_for_as_many_turns_as_it_takes_to_fall(ratio):
    """It is back at the height of the surface's crest after ratio (1 + cos leaving) - 1 radians, and down in a turn."""
    start, lands = leaving_phase(ratio), landing_phase(ratio)
    flown = lands - start
    assert 0.0 <= flown - (ratio * (1.0 + cos(start)) - 1.0) < 2.0 * pi
    with localcontext() as digits:
        digits.prec = 50
        t, r = Decimal(lands) - Decimal(start), Decimal(ratio)
        height = 1 / r + (1 - 1 / r**2).sqrt() * t - t * t / (2 * r)
    assert float(height) == pytest.approx(sin(lands), abs=1e-14 * ratio)


def bounces(ratio, restitution, theta, n=3000):
    """Speed after the last of n landings, each flown to by Newton from a period on; heights of the surface counted."""
    speed = pi / ratio
    for _ in range(n):
        time = 2.0 * pi
        for _ in range(6):
            gap = sin(theta) + speed * time - 0.5 * time * time / ratio - sin(theta + time)
            time -= gap / (speed - time / ratio - cos(theta + time))
        landing = speed - time / ratio
        theta += time
        speed = (1.0 + restitution) * cos(theta) - restitution * landing
    return speed


@pytest.mark.parametrize("restitution", [0.3, 0.6])
def test_a_bounce_in_step_holds_between_its_limits_and_nowhere_else(restitution):
    """One flight a period wants v = pi/ratio = (1+e)/(1-e) cos theta; flown from landing to landing."""
    low, high = bouncing_limits(restitution)
    for ratio in (1.01 * low, 0.99 * high):
        start = asin(sqrt(1.0 - (low / ratio) ** 2))
        assert bounces(ratio, restitution, start + 1e-4) == pytest.approx(pi / ratio, rel=1e-9)
    beyond = 1.02 * high
    start = asin(sqrt(1.0 - (low / beyond) ** 2))
    assert abs(bounces(beyond, restitution, start + 1e-7, 200) * beyond / pi - 1.0) > 1e-4


def bounced(ratio, restitution, theta, speed, periods):
    """(phase, speed) after the next landing about `periods` later, flown to by Newton."""
    time = 2.0 * pi * periods
    for _ in range(8):
        gap = sin(theta) + speed * time - 0.5 * time * time / ratio - sin(theta + time)
        time -= gap / (speed - time / ratio - cos(theta + time))
    after = theta + time
    return np.array([after, (1.0 + restitution) * cos(after) - restitution * (speed - time / ratio)])


@pytest.mark.parametrize(
    ("ratio", "restitution", "periods"), [(1.9, 0.4, 1), (0.71, 0.7, 1), (2.9, 0.25, 1), (4.1, 0.3, 2), (3.4, 0.0, 1)]
)
def test_a_bounce_in_step_comes_back_and_deviations_grow_as_the_map_says(ratio, restitution, periods):
    """The map's derivative by central differences of flights."""
    found = bounce_in_step(ratio, restitution, periods)
    start = np.array([found.phase, found.speed])
    again = bounced(ratio, restitution, *start, periods)
    assert again - (2.0 * pi * periods, 0.0) == pytest.approx(start, rel=1e-11)
    map_of = np.zeros((2, 2))
    for k in range(2):
        way = 1e-6 * np.eye(2)[k]
        ahead, behind = (bounced(ratio, restitution, *(start + side * way), periods) for side in (1, -1))
        map_of[:, k] = (ahead - behind) / 2e-6
    wanted = sorted(np.linalg.eigvals(map_of), key=lambda one: (one.real, one.imag))
    assert sorted(found.multipliers, key=lambda one: (one.real, one.imag)) == pytest.approx(wanted, abs=1e-7)


@pytest.mark.parametrize("restitution", [0.15, 0.45])
def test_a_bounce_loses_its_step_where_a_multiplier_leaves_the_unit_circle(restitution):
    low, high = bouncing_limits(restitution)
    assert max(abs(m) for m in bounce_in_step(1.001 * low, restitution).multipliers) < 1.0
    assert max(abs(m) for m in bounce_in_step(0.999 * high, restitution).multipliers) < 1.0
    assert min(m.real for m in bounce_in_step(high, restitution).multipliers) == pytest.approx(-1.0, abs=1e-9)
    assert max(m.real for m in bounce_in_step(low, restitution).multipliers) == pytest.approx(1.0, abs=1e-6)
    assert max(abs(m) for m in bounce_in_step(1.01 * high, restitution).multipliers) > 1.0


@pytest.mark.parametrize(
    ("wrong", "said"),
    [
        (lambda: bounce_in_step(1.0, 0.3), "acceleration_ratio = 1.0"),
        (lambda: bounce_in_step(-1.0, 0.3), "acceleration_ratio = -1.0"),
        (lambda: bounce_in_step(5.0, 0.3, 0), "periods = 0"),
        (lambda: landing_phase(1.0), "acceleration_ratio = 1.0"),
        (lambda: landing_phase(float("inf")), "acceleration_ratio = inf"),
        (lambda: landing_phase(2**63), "rounding leaves no phase"),
        (lambda: bouncing_limits(1.0), "restitution = 1.0"),
        (lambda: bouncing_limits(-0.1), "restitution = -0.1"),
    ],
)
def test_what_never_leaves_is_refused(wrong, said):
    with pytest.raises(InputError, match=said):
        wrong()
