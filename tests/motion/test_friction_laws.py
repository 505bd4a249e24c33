"""Friction laws within one step and on a rigid surface: against stiff solvers and closed forms."""

from math import asinh, atan, atanh, exp, pi, sinh, sqrt

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.integrate import solve_ivp

from verify.errors import InputError
from verify.motion.friction_kernels import coulomb_span, tanh_speed_change
from verify.motion.records import SLIPS, STICKS, TURNS
from verify.motion.rigid_surface import coulomb_decrement, creep_speed, free_decay, stick_slip_times


def power_of_ten(low, high):
    return st.floats(low, high).map(lambda e: 10.0**e)


@settings(max_examples=40, deadline=None)
@given(
    rho=power_of_ten(-3, 2.5),
    sign=st.sampled_from([-1.0, 1.0]),
    alpha=st.floats(-4, 4),
    slope=power_of_ten(0, 6),
    b=power_of_ten(-2, 2),
    tau=power_of_ten(-4, 2),
)
def test_a_tanh_step_equals_a_stiff_solver(rho, sign, alpha, slope, b, tau):
    """R' = -b tanh(K r) - a over a step of tau = K b dt, in units of K."""
    found = tanh_speed_change(sign * rho / slope, alpha * b, b, slope, tau / (slope * b))

    def steepness(y):
        return 1 / np.cosh(min(abs(y), 300)) ** 2

    run = solve_ivp(
        lambda t, y: [-np.tanh(y[0]) - alpha, np.tanh(y[0])], (0, tau), [sign * rho, 0.0],
        method="Radau", rtol=1e-9, atol=1e-12, jac=lambda t, y: [[-steepness(y[0]), 0], [steepness(y[0]), 0]],
    )  # fmt: skip
    assert found * slope == pytest.approx(-run.y[1, -1], abs=2e-7 * tau + 1e-10)


@settings(max_examples=60, deadline=None)
@given(
    r=st.floats(-0.3, 0.3),
    a=st.floats(-60, 60),
    b=power_of_ten(-2, 2),
    slope=power_of_ten(0, 7),
    dt=power_of_ten(-9, -1),
)
def test_a_tanh_step_in_two_parts_is_the_same_step(r, a, b, slope, dt):
    whole = tanh_speed_change(r, a, b, slope, dt)
    first = tanh_speed_change(r, a, b, slope, 0.4 * dt)
    second = tanh_speed_change(r + first - 0.4 * a * dt, a, b, slope, 0.6 * dt)
    assert first + second == pytest.approx(whole, abs=2e-6 * b * dt + 1e-12 * abs(r) + 1e-9 / slope)
    assert tanh_speed_change(-r, -a, b, slope, dt) == -whole
    assert abs(whole) <= b * dt * (1 + 1e-12)


@settings(max_examples=80, deadline=None)
@given(
    r=st.floats(-1, 1),
    a0=st.floats(-9, 9),
    a1=st.floats(-9, 9),
    kinetic=st.floats(0.01, 5),
    extra=st.floats(0, 2),
    stuck=st.booleans(),
)
def test_coulomb_spans_end_at_the_first_event(r, a0, a1, kinetic, extra, stuck):
    """R' = -F sign(r) - a with a linear: ends at the first zero of r, at the first |a| = static, or at dt."""
    dt, static = 0.83, kinetic + extra
    r = 0.0 if stuck else r
    if not stuck and abs(r) < 1e-6:
        return
    used, end, holds, event = coulomb_span(r, a0, a1, kinetic, static, dt, stuck)
    assert 0.0 <= used <= dt
    t = np.linspace(0.0, used, 200)
    a = a0 + (a1 - a0) * t / dt
    if stuck:
        assert abs(a[:-1]).max() <= static * (1 + 1e-9) or used == 0.0
        assert abs(a[-1]) >= static * (1 - 1e-9) if event == SLIPS else (holds and used == dt)
        return
    path = r - kinetic * np.sign(r) * t - a0 * t - (a1 - a0) * t**2 / (2 * dt)
    assert np.all(path[:-1] * np.sign(r) >= -1e-9)
    assert end == pytest.approx(path[-1], abs=1e-9)
    if event:
        assert holds == (abs(a[-1]) <= static)
        assert event == (STICKS if holds else TURNS)
    else:
        assert used == dt


@pytest.mark.parametrize(
    ("mu", "slope", "speed", "time"), [(0.23, 900.0, 0.013, 4.1e-3), (0.07, 31.0, -0.4, 0.31), (1.3, 2e5, 1e-3, 3e-4)]
)
def test_free_decay_follows_its_closed_form(mu, slope, speed, time):
    expected = asinh(sinh(slope * speed) * exp(-mu * 9.81 * slope * time)) / slope
    assert free_decay(mu, slope, speed, time) == pytest.approx(expected, rel=1e-9)


@pytest.mark.parametrize("part", [-0.99999, -0.31, 1e-6, 0.87])
@pytest.mark.parametrize("slope", [3.0, 4e5])
def test_a_pull_below_the_limit_creeps_at_its_artanh(slope, part):
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


def test_belts_and_pulls_without_such_a_motion_are_refused():
    for pull in (1.0, -1.2, 1 - 1e-8):
        with pytest.raises(InputError, match="pull = "):
            creep_speed(0.2, 900.0, pull * 0.2 * 9.81)
    with pytest.raises(InputError, match="kinetic"):
        stick_slip_times(0.7, 310.0, 1.7, 1.7, 0.11)
    with pytest.raises(InputError, match="raise speed"):
        stick_slip_times(0.7, 310.0, 2.9, 1.7, 1e-12)
