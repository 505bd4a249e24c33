"""A mass that lands on a spring and a dashpot, followed through the blow by DOP853 and in forty digits."""

from math import exp, pi, sqrt

import mpmath as mp
import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.integrate import solve_ivp

from verify.contact import landing
from verify.errors import InputError

MASS, STIFFNESS, SPEED = 3.7e-3, 8.1e4, 0.23


def blow(damping):
    """(seconds in contact, speed after over speed before): until what presses back is nought."""

    def rates(t, y):
        return [y[1], -(STIFFNESS * y[0] + damping * y[1]) / MASS]

    def lets_go(t, y):
        return STIFFNESS * y[0] + damping * y[1] - 1e-30

    lets_go.terminal, lets_go.direction = True, -1
    run = solve_ivp(
        rates, (0.0, 1.0), [0.0, SPEED], method="DOP853", rtol=1e-12, atol=1e-18, events=lets_go, max_step=2e-4
    )
    return run.t_events[0][0], -run.y_events[0][0][1] / SPEED


@pytest.mark.parametrize("zeta", [0.0, 0.03, 0.31, 0.7071, 0.9, 0.999999, 1.0, 1.000001, 1.3, 4.1])
def test_a_mass_leaves_a_dashpot_as_fast_as_it_is_followed_to(zeta):
    own = sqrt(STIFFNESS / MASS)
    time, share = blow(2.0 * zeta * MASS * own)
    assert landing.restitution(zeta) == pytest.approx(share, rel=2e-9)
    assert landing.contact_time(zeta) == pytest.approx(time * own, rel=2e-8)


@pytest.mark.parametrize("zeta", [1e-9, 0.2, 0.99999999, 1.0 + 1e-13, 1.2, 7.0, 300.0])
def test_a_blow_is_the_published_formula_in_forty_digits(zeta):
    """Schwager and Poeschel (2007): beta = zeta, omega^2 = 1 - zeta^2, three branches, here over complex numbers."""
    with mp.workdps(40):
        beta = mp.mpf(zeta)
        omega = mp.sqrt(mp.mpc(1 - beta**2))
        time = -mp.j * mp.log(beta + mp.j * omega) * 2 / omega  # its tangent is 2 beta omega / (beta^2 - omega^2)
        left = mp.exp(-beta * time)
        pull = mp.diff(lambda t: mp.exp(-beta * t) * mp.sin(omega * t) / omega, time, 2)
        assert abs(pull) < 1e-25
    assert landing.restitution(zeta) == pytest.approx(float(left.real), rel=4e-14)


def test_a_dashpot_that_pulled_would_take_the_mass_back_later():
    """Leaving where the spring is slack instead gives exp(-pi zeta / sqrt(1 - zeta^2)): less, and nought at zeta = 1."""
    for zeta in (0.05, 0.4, 0.95):
        side = sqrt(1.0 - zeta**2)
        assert landing.contact_time(zeta) < pi / side
        assert landing.restitution(zeta) > exp(-pi * zeta / side)
    assert landing.restitution(1.0) == pytest.approx(exp(-2.0), rel=1e-15)
    assert landing.restitution(1e-5) == pytest.approx(1.0 - pi * 1e-5 + (0.5 * pi**2 + 2.0) * 1e-10, abs=3e-14)


@given(zeta=st.floats(0.0, 40.0))
def test_more_damping_takes_more_and_the_ratio_comes_back(zeta):
    share = landing.restitution(zeta)
    assert landing.restitution(1.001 * zeta + 1e-9) < share <= 1.0
    assert landing.damping_ratio_for(share) == pytest.approx(zeta, rel=1e-9, abs=1e-14)


def test_a_ratio_is_that_of_mass_spring_and_dashpot():
    assert landing.damping_ratio(MASS, STIFFNESS, 3.1) == pytest.approx(3.1 / (2.0 * sqrt(MASS * STIFFNESS)), rel=1e-15)
    assert landing.damping_ratio(1e-300, 1e-300, 1e-310) == pytest.approx(5e-11, rel=1e-3)


@pytest.mark.parametrize(("ratio", "zeta"), [(0.4, 0.0), (0.4, 0.07), (1.6, 0.0), (1.6, 0.3), (1.0, 0.11)])
def test_a_mass_lifts_off_where_its_contact_first_carries_nothing(ratio, zeta):
    """The steady contact force m (g - x'') by a linear solve at the drive, in real and imaginary parts."""
    rows = np.array([[1.0 - ratio**2, -2.0 * zeta * ratio], [2.0 * zeta * ratio, 1.0 - ratio**2]])
    x = np.linalg.solve(rows, [1.0, 2.0 * zeta * ratio])
    assert landing.lift_off_ratio(ratio, zeta) == pytest.approx(1.0 / np.hypot(*x), rel=1e-12)


def test_a_contact_that_does_not_give_way_lifts_off_where_gravity_ends():
    assert landing.lift_off_ratio(0.0) == 1.0
    assert landing.lift_off_ratio(1.0) == 0.0
    assert landing.lift_off_ratio(1e-6, 0.2) == pytest.approx(1.0, abs=1e-11)


@pytest.mark.parametrize(
    ("wrong", "said"),
    [
        (lambda: landing.restitution(-0.1), "damping_ratio = -0.1"),
        (lambda: landing.restitution(float("nan")), "damping_ratio = nan"),
        (lambda: landing.damping_ratio(0.0, 1.0, 1.0), "mass = 0.0"),
        (lambda: landing.damping_ratio(1.0, -2.0, 1.0), "stiffness = -2.0"),
        (lambda: landing.damping_ratio(1.0, 2.0, -1.0), "damping = -1.0"),
        (lambda: landing.damping_ratio(1e-300, 1e-300, 1e300), r"damping = 1e\+300"),
        (lambda: landing.damping_ratio_for(0.0), "restitution = 0.0"),
        (lambda: landing.damping_ratio_for(1.1), "restitution = 1.1"),
        (lambda: landing.lift_off_ratio(-1.0), "frequency_ratio = -1.0"),
        (lambda: landing.lift_off_ratio(1.0, -1.0), "damping_ratio = -1.0"),
    ],
)
def test_what_is_no_contact_is_refused(wrong, said):
    with pytest.raises(InputError, match=said):
        wrong()
