"""Friction on a rigid surface of constant speed, against closed forms; decay and creep are stress checks."""

from math import atan, pi, sqrt

import pytest

from verify.dynamics.belt import coulomb_decrement, creep_speed, stick_slip_times
from verify.errors import InputError


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
