"""Friction on a rigid surface of constant speed, against closed forms."""

from math import asinh, atan, atanh, exp, pi, sinh, sqrt

import pytest

from verify.dynamics.belt import coulomb_decrement, creep_speed, free_decay, stick_slip_times
from verify.errors import InputError


@pytest.mark.parametrize(
    ("mu", "slope", "speed", "time"), [(0.23, 900.0, 0.013, 4.1e-3), (0.07, 31.0, -0.4, 0.31), (1.3, 2e5, 1e-3, 3e-4)]
)
def test_free_decay_follows_its_closed_form(mu, slope, speed, time):
    expected = asinh(sinh(slope * speed) * exp(-mu * 9.81 * slope * time)) / slope
    assert free_decay(mu, slope, speed, time) == pytest.approx(expected, rel=1e-9)


@pytest.mark.parametrize("part", [-0.99999, -0.31, 1e-6, 0.87])
@pytest.mark.parametrize("slope", [3.0, 4e5])
def test_a_force_below_the_limit_creeps_at_its_artanh(slope, part):
    assert creep_speed(0.17, slope, part * 0.17 * 9.81) == pytest.approx(atanh(part) / slope, rel=1e-9)


@pytest.mark.parametrize(
    ("mass", "stiffness", "static", "kinetic", "speed"),
    [(0.7, 310.0, 2.9, 1.7, 0.11), (0.013, 41.0, 0.31, 0.04, 0.9), (5.1, 88.0, 12.0, 11.0, 0.03)],
)
def test_stick_slip_on_a_belt_follows_den_hartog(mass, stiffness, static, kinetic, speed):
    own, drop = sqrt(stiffness / mass), static - kinetic
    stick, slip = stick_slip_times(mass, stiffness, static, kinetic, speed)
    assert stick == pytest.approx(2 * drop / (stiffness * speed), rel=1e-6)
    assert slip == pytest.approx(2 / own * (pi - atan(drop * own / (stiffness * speed))), rel=1e-5)


@pytest.mark.parametrize(("mass", "stiffness", "force"), [(0.7, 310.0, 1.7), (0.021, 9.0, 0.4)])
def test_a_coulomb_oscillator_loses_four_forces_over_stiffness_a_cycle(mass, stiffness, force):
    assert coulomb_decrement(mass, stiffness, force) == pytest.approx(4 * force / stiffness, rel=1e-6)


def test_belts_and_forces_without_such_a_motion_are_refused():
    for part in (1.0, -1.2, 1 - 1e-8):
        with pytest.raises(InputError, match="acceleration = "):
            creep_speed(0.2, 900.0, part * 0.2 * 9.81)
    with pytest.raises(InputError, match="kinetic"):
        stick_slip_times(0.7, 310.0, 1.7, 1.7, 0.11)
    with pytest.raises(InputError, match="lower the speed"):
        stick_slip_times(0.7, 310.0, 2.9, 1.7, 1e12)
