"""Friction laws on a rigid surface: each step against other solvers, long runs against closed forms."""

from math import asinh, atan, atanh, exp, pi, sinh, sqrt

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from mpmath import mp
from scipy.integrate import solve_ivp

from verify.errors import InputError
from verify.motion import rigid_surface
from verify.motion.friction_kernels import coulomb_span, slide_on_belt, tanh_speed_change
from verify.motion.records import SLIPS, STICKS, TURNS
from verify.motion.rigid_surface import coulomb_decrement, creep_speed, free_decay, stick_slip_times


def power_of_ten(low, high):
    return st.floats(low, high).map(lambda e: 10.0**e)


signs = st.sampled_from([-1.0, 1.0])


@settings(max_examples=60, deadline=None)
@given(
    rho=power_of_ten(-3, 2.5),
    sign=signs,
    alpha=st.floats(-4, 4),
    slope=power_of_ten(0, 6),
    b=power_of_ten(-2, 2),
    tau=power_of_ten(-4, 2),
)
def test_a_step_of_eq_3_is_scipys_radau(rho, sign, alpha, slope, b, tau):
    """R' = -b tanh(K r) - a over a step of tau = K b dt, in units of K."""
    dt = tau / (slope * b)
    found = tanh_speed_change(sign * rho / slope, alpha * b, b, slope, dt)
    run = solve_ivp(
        lambda t, y: [-np.tanh(y[0]) - alpha, np.tanh(y[0])],
        (0, tau),
        [sign * rho, 0.0],
        method="Radau",
        rtol=1e-9,
        atol=1e-12,
        jac=lambda t, y: [[-1 / np.cosh(min(abs(y[0]), 300)) ** 2, 0], [1 / np.cosh(min(abs(y[0]), 300)) ** 2, 0]],
    )
    assert found * slope == pytest.approx(-run.y[1, -1], abs=2e-7 * tau + 1e-10)


@settings(max_examples=100, deadline=None)
@given(
    rho=power_of_ten(-3, 3),
    sign=signs,
    off=power_of_ten(-9, 4),
    beyond=signs,
    slope=power_of_ten(0, 7),
    b=power_of_ten(-2, 2),
    tau=power_of_ten(-6, 6),
)
def test_a_step_is_exact_at_any_stiffness_and_next_to_the_limit_of_friction(rho, sign, off, beyond, slope, b, tau):
    """Against forty digits; alpha = 1 -+ off, where the surface accelerates as fast as friction can follow."""
    alpha = abs(1.0 + beyond * off)
    dt = tau / (slope * b)
    change = tanh_speed_change(sign * rho / slope, alpha * b, b, slope, dt) * slope
    assert abs(change) <= tau * (1 + 1e-12)
    expected = change_in_forty_digits(sign * rho, alpha, slope * b * dt)
    assert change == pytest.approx(expected, abs=(1e-6 if off < 1e-5 else 1e-9) * tau + 1e-13 * rho)


def change_in_forty_digits(rho, alpha, tau):
    """What friction adds to rho: by bisection of time(end) = int d rho / (tanh rho + alpha), alpha >= 0."""
    with mp.workdps(40):
        start, alpha, tau = mp.mpf(rho), mp.mpf(alpha), mp.mpf(tau)

        def passed(r):
            if alpha == 1:
                return r / 2 - mp.exp(-2 * r) / 4
            return (alpha * r - mp.log(abs(alpha * mp.cosh(r) + mp.sinh(r)))) / (alpha**2 - 1)

        rest = -mp.atanh(alpha) if alpha < 1 else start - (1 + alpha) * tau
        near, far = start, rest
        for _ in range(90):
            middle = (near + far) / 2
            if passed(start) - passed(middle) > tau:
                far = middle
            else:
                near = middle
        return float((near + far) / 2 - start + alpha * tau)


@settings(max_examples=100, deadline=None)
@given(
    r=st.floats(-0.3, 0.3),
    a=st.floats(-60, 60),
    b=power_of_ten(-2, 2),
    slope=power_of_ten(0, 7),
    dt=power_of_ten(-9, -1),
)
def test_a_step_split_in_two_is_the_same_step(r, a, b, slope, dt):
    """The exact flow is a group; mirrored, it is mirrored to the last digit."""
    whole = tanh_speed_change(r, a, b, slope, dt)
    first = tanh_speed_change(r, a, b, slope, 0.4 * dt)
    second = tanh_speed_change(r + first - 0.4 * a * dt, a, b, slope, 0.6 * dt)
    assert first + second == pytest.approx(whole, abs=2e-6 * b * dt + 1e-12 * abs(r) + 1e-9 / slope)
    assert tanh_speed_change(-r, -a, b, slope, dt) == -whole


@settings(max_examples=100, deadline=None)
@given(r=st.floats(-0.2, 0.2), b=power_of_ten(-2, 2), slope=power_of_ten(0, 7), dt=power_of_ten(-9, 0))
def test_friction_alone_takes_energy_and_never_reverses(r, b, slope, dt):
    """F v_rel <= 0 throughout, so the speed falls towards zero: sinh(K v) = sinh(K v0) e^{-b K dt}."""
    left = r + tanh_speed_change(r, 0.0, b, slope, dt)
    assert abs(left) <= abs(r) * (1 + 1e-12)
    assert left * r >= 0 or abs(left) < 1e-12 / slope + 1e-15 * abs(r)
    if abs(slope * r) < 300 and b * slope * dt < 300:
        assert left == pytest.approx(
            asinh(sinh(slope * r) * exp(-b * slope * dt)) / slope, abs=1e-9 * b * dt + 1e-12 / slope
        )


@settings(max_examples=200, deadline=None)
@given(
    r=st.floats(-1, 1),
    a0=st.floats(-9, 9),
    a1=st.floats(-9, 9),
    kinetic=st.floats(0.01, 5),
    extra=st.floats(0, 2),
    stuck=st.booleans(),
)
def test_coulomb_spans_end_where_the_relative_speed_does(r, a0, a1, kinetic, extra, stuck):
    """R' = -F sign(r) - a, a linear: the span ends at the first zero, at the first |a| = static, or at dt."""
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
        if event == SLIPS:
            assert abs(a0 + (a1 - a0) * used / dt) >= static * (1 - 1e-9)
        else:
            assert holds
            assert used == dt
        return
    path = r - kinetic * np.sign(r) * t - a0 * t - (a1 - a0) * t**2 / (2 * dt)
    assert np.all(path[:-1] * np.sign(r) >= -1e-9)
    assert end == pytest.approx(path[-1], abs=1e-9)
    if event:
        assert end == 0.0
        assert holds == (abs(a[-1]) <= static)
        assert event == (STICKS if holds else TURNS)
    else:
        assert used == dt


@pytest.mark.parametrize(
    ("mu", "slope", "speed", "time"), [(0.23, 900.0, 0.013, 4.1e-3), (0.07, 31.0, -0.4, 0.31), (1.3, 2e5, 1e-3, 3e-4)]
)
def test_free_decay_is_that_of_the_closed_form(mu, slope, speed, time):
    expected = asinh(sinh(slope * speed) * exp(-mu * 9.81 * slope * time)) / slope
    assert free_decay(mu, slope, speed, time) == pytest.approx(expected, rel=1e-9)
    assert free_decay(mu, slope, -speed, time) == -free_decay(mu, slope, speed, time)


@settings(max_examples=40, deadline=None)
@given(mu=st.floats(0.01, 3), slope=power_of_ten(0, 7), part=st.floats(-0.99999, 0.99999))
def test_a_pull_below_the_limit_creeps_at_its_artanh(mu, slope, part):
    expected = atanh(part * mu * 9.81 / (mu * 9.81)) / slope
    assert creep_speed(mu, slope, part * mu * 9.81) == pytest.approx(expected, rel=1e-9, abs=1e-15 / slope)


@pytest.mark.parametrize("part", [1.0, -1.2, 1 - 1e-8])
def test_a_pull_at_the_limit_is_refused_and_does_not_run_for_ever(part):
    with pytest.raises(InputError, match="pull = "):
        creep_speed(0.2, 900.0, part * 0.2 * 9.81)


BELTS = [(0.7, 310.0, 2.9, 1.7, 0.11), (0.013, 41.0, 0.31, 0.04, 0.9), (5.1, 88.0, 12.0, 11.0, 0.03)]


@pytest.mark.parametrize(("mass", "stiffness", "static", "kinetic", "speed"), BELTS)
def test_stick_and_slip_on_a_belt_last_what_the_closed_forms_say(mass, stiffness, static, kinetic, speed):
    own, drop = sqrt(stiffness / mass), static - kinetic
    stick, slip = stick_slip_times(mass, stiffness, static, kinetic, speed)
    assert stick == pytest.approx(2 * drop / (stiffness * speed), rel=1e-6)
    assert slip == pytest.approx(2 / own * (pi - atan(drop * own / (stiffness * speed))), rel=1e-5)


@pytest.mark.parametrize(("mass", "stiffness", "static", "kinetic", "speed"), BELTS)
def test_a_mass_slips_first_when_the_belt_has_stretched_its_spring_to_the_limit(
    mass, stiffness, static, kinetic, speed
):
    stretching = static / (stiffness * speed)
    events, state = np.zeros((1, 3)), np.array([0.0, speed, 1.0])
    law = rigid_surface._law(True, kinetic / mass, static / mass, 0.0)
    assert slide_on_belt(37, stretching / 29.3, law, speed, stiffness / mass, 0.0, state, events) == 1
    assert list(events[0]) == pytest.approx([stretching, SLIPS, static / stiffness], rel=1e-12)


def test_a_belt_that_never_lets_slip_is_refused():
    with pytest.raises(InputError, match="without a drop nothing slips"):
        stick_slip_times(0.7, 310.0, 1.7, 1.7, 0.11)
    with pytest.raises(InputError, match="raise speed"):
        stick_slip_times(0.7, 310.0, 2.9, 1.7, 1e-12)
    with pytest.raises(InputError, match="raise speed"):
        stick_slip_times(0.7, 1e-300, 2.9, 1.7, 1e-300)


@pytest.mark.parametrize(("mass", "stiffness", "force"), [(0.7, 310.0, 1.7), (0.021, 9.0, 0.4), (33.0, 5e4, 61.0)])
def test_a_coulomb_oscillator_loses_four_forces_over_the_stiffness_a_cycle(mass, stiffness, force):
    assert coulomb_decrement(mass, stiffness, force) == pytest.approx(4 * force / stiffness, rel=1e-6)


def orders(values, exact):
    errors = abs(np.array(values) - exact)
    return np.log2(errors[:-1] / errors[1:])


def test_a_spring_held_slider_converges_at_order_two_or_better_in_the_step():
    """Slip time by Coulomb's law; a tanh oscillator at K = 40 s/m against DOP853."""
    mass, stiffness, static, kinetic, speed = BELTS[0]
    own = sqrt(stiffness / mass)
    slip = 2 / own * (pi - atan((static - kinetic) * own / (stiffness * speed)))

    def slips(steps):
        with pytest.MonkeyPatch.context() as patch:
            patch.setattr(rigid_surface, "STEPS_PER_PERIOD", steps)
            return stick_slip_times(mass, stiffness, static, kinetic, speed)[1]

    assert min(orders([slips(n) for n in (50, 100, 200, 400)], slip)) > 1.7

    def tanh_end(n):
        state, law = np.array([0.02, 0.0, 0.0]), rigid_surface._law(False, 2.1, 0.0, 40.0)
        slide_on_belt(n, 0.3 / n, law, 0.05, stiffness / mass, 0.4, state, np.zeros((0, 3)))
        return state[1]

    exact = solve_ivp(
        lambda t, y: [y[1], 0.4 - stiffness / mass * y[0] - 2.1 * np.tanh(40 * (y[1] - 0.05))],
        (0, 0.3),
        [0.02, 0.0],
        method="DOP853",
        rtol=1e-12,
        atol=1e-15,
    ).y[1, -1]
    assert min(orders([tanh_end(n) for n in (40, 80, 160, 320)], exact)) > 1.8
    assert tanh_end(640) == pytest.approx(exact, rel=1e-4)
