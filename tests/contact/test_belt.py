"""A spring-held mass on a belt, followed from stick to slip by DOP853 and by the suite's own compiled friction."""

from math import sqrt

import pytest
from scipy.integrate import solve_ivp

from verify.contact.belt import stick_slip_times
from verify.errors import InputError
from verify.motion import rigid_surface

CASES = [(0.31, 420.0, 0.9, 0.5, 0.013), (1.7, 55.0, 2.3, 2.2, 0.4), (0.02, 3e3, 5.0, 0.0, 0.9)]


def followed(mass, stiffness, static, kinetic, speed):
    """(stick, slip): it starts to slip where the spring pulls with `static`, until it is as fast as the belt again."""

    def caught_up(t, y):
        return y[1] - speed

    caught_up.terminal, caught_up.direction = True, 1
    start = [static / stiffness, speed * (1.0 - 1e-13)]
    run = solve_ivp(
        lambda t, y: [y[1], (kinetic - stiffness * y[0]) / mass],
        (0.0, 100.0 * sqrt(mass / stiffness)),
        start,
        method="DOP853",
        rtol=1e-12,
        atol=1e-15,
        events=caught_up,
        max_step=0.1 * sqrt(mass / stiffness),
    )
    slip, x = run.t_events[0][-1], run.y_events[0][-1][0]
    return (static / stiffness - x) / speed, slip


@pytest.mark.parametrize("case", CASES)
def test_a_belt_carries_and_lets_go_as_it_is_followed(case):
    assert stick_slip_times(*case) == pytest.approx(followed(*case), rel=1e-8)


@pytest.mark.parametrize("case", CASES[:2])
def test_compiled_friction_sticks_and_slips_as_long(case):
    assert rigid_surface.stick_slip_times(*case) == pytest.approx(stick_slip_times(*case), rel=2e-6)


@pytest.mark.parametrize(
    ("case", "said"),
    [
        ((0.0, 1.0, 2.0, 1.0, 1.0), "mass = 0.0"),
        ((1.0, -1.0, 2.0, 1.0, 1.0), "stiffness = -1.0"),
        ((1.0, 1.0, 1.0, 1.0, 1.0), "kinetic = 1.0"),
        ((1.0, 1.0, 2.0, -1.0, 1.0), "kinetic = -1.0"),
        ((1.0, 1.0, 2.0, 1.0, 0.0), "speed = 0.0"),
    ],
)
def test_a_belt_that_never_lets_go_is_refused(case, said):
    with pytest.raises(InputError, match=said):
        stick_slip_times(*case)
