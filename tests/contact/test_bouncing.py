"""A mass on a shaking surface, flown in small steps beside the closed forms."""

from math import asin, cos, pi, sin, sqrt

import pytest

from verify.contact.bouncing import bouncing_limits, landing_phase, leaving_phase
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


@pytest.mark.parametrize(
    ("wrong", "said"),
    [
        (lambda: landing_phase(1.0), "acceleration_ratio = 1.0"),
        (lambda: landing_phase(float("inf")), "acceleration_ratio = inf"),
        (lambda: bouncing_limits(1.0), "restitution = 1.0"),
        (lambda: bouncing_limits(-0.1), "restitution = -0.1"),
    ],
)
def test_what_never_leaves_is_refused(wrong, said):
    with pytest.raises(InputError, match=said):
        wrong()
