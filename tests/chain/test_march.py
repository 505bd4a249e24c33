"""The Runge-Kutta march with another acceleration than a chain's."""

import numpy as np
import pytest
from scipy.special import ellipj, ellipk

from verify.chain.runge_kutta import ACCELERATION, DONE, DORMAND_PRINCE, RK4, integrate
from verify.jit import jit


@jit(signature_or_function=ACCELERATION, no_cfunc_wrapper=False)
def pendulum(t, y, out, links, loads, numbers, scratch):
    """Theta'' = -omega^2 sin theta, and the action integral of theta'^2."""
    out[1] = -(numbers[0] ** 2) * np.sin(y[0])
    out[2] = y[1] ** 2


DATA = (np.zeros((0, 1)), np.zeros((0, 1)), np.array([2.7]), np.zeros((1, 1)))


def swing(tableau, times, step, tolerance=1e-10):
    y = np.array([2.1, 0.0, 0.0])
    control = (tolerance, 1e-3 * tolerance, 1e-3 * tolerance, np.inf)
    run = integrate(pendulum, DATA, tableau, 1, y, 0.0, np.asarray(times), step, control)
    assert run.status == DONE
    assert run.kept[-1] == pytest.approx(y, abs=0.0)
    return run.kept


def exact(times):
    m = np.sin(0.5 * 2.1) ** 2
    return 2.0 * np.arcsin(np.sqrt(m) * ellipj(ellipk(m) - 2.7 * np.asarray(times), m)[0])


def test_a_pendulum_of_large_amplitude_swings_by_jacobis_function():
    times = np.linspace(0.0, 7.3, 23)
    kept = swing(DORMAND_PRINCE, times, 0.1)
    assert kept[:, 0] == pytest.approx(exact(times), abs=3e-8)
    assert 0.5 * kept[:, 1] ** 2 - 2.7**2 * np.cos(kept[:, 0]) == pytest.approx(-(2.7**2) * np.cos(2.1), rel=1e-7)
    period = 4.0 * ellipk(np.sin(1.05) ** 2) / 2.7
    action = swing(DORMAND_PRINCE, [period], 0.1)[-1, 2]
    fine = np.linspace(0.0, period, 20_001)
    assert action == pytest.approx(np.trapezoid(np.gradient(exact(fine), fine, edge_order=2) ** 2, fine), rel=1e-6)


def error(tableau, step, tolerance=1e-10):
    times = np.linspace(0.0, 3.2, 321)
    return abs(swing(tableau, times, step, tolerance)[:, 0] - exact(times)).max()


def test_fixed_steps_converge_with_order_four_between_steps_too():
    errors = [error(RK4, step) for step in (0.04, 0.02, 0.01)]
    assert np.log2(np.array(errors[:-1]) / errors[1:]) == pytest.approx([4.0, 4.0], abs=0.3)


def test_controlled_steps_converge_with_their_tolerance():
    loose, tight = (error(DORMAND_PRINCE, 0.1, size) for size in (1e-5, 1e-8))
    assert tight < 1e-6
    assert 100.0 < loose / tight < 10_000.0
