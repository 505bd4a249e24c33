"""The amplification of time steps against the tableaux and the motions whose steps it describes."""

from math import sqrt

import numpy as np
import pytest

from verify.chain import runge_kutta
from verify.linear.step_schemes import DORMAND_PRINCE, RK4, alphas, generalised_alpha


@pytest.mark.parametrize(
    ("scheme", "tableau"), [(DORMAND_PRINCE, runge_kutta.DORMAND_PRINCE), (RK4, runge_kutta.RK4)], ids=["DP", "RK4"]
)
def test_an_explicit_scheme_multiplies_a_mode_as_the_stages_of_its_tableau_do(scheme, tableau):
    for z in (0.31j, -0.2 + 0.9j, 1.7j - 0.4):
        k = []
        for row in tableau.a[: len(tableau.c)]:
            k.append(z * (1.0 + sum(w * one for w, one in zip(row, k, strict=False))))
        step = 1.0 + tableau.a[-1] @ k
        assert 1.0 + scheme.state_roots(np.array(z))[0] == pytest.approx(step, rel=1e-12)


def test_dormand_and_prince_have_the_errors_and_the_limit_of_their_row():
    (fast, p), (damped, q) = DORMAND_PRINCE.frequency, DORMAND_PRINCE.numerical
    found = []
    for x in (0.2, 0.1):
        s = DORMAND_PRINCE.undamped(np.array(x))
        found.append([(s.imag - 1.0) / x**p, -s.real / abs(s) / x**q])
    fine, coarse = found[1], found[0]
    assert [b + (b - a) / 3.0 for a, b in zip(coarse, fine, strict=True)] == pytest.approx([fast, damped], rel=0.01)
    grows = [DORMAND_PRINCE.undamped(np.array(DORMAND_PRINCE.limit * by)).real for by in (0.999, 1.001)]
    assert grows[0] < 0.0 < grows[1]


def test_generalised_alpha_is_of_order_two_and_leaves_its_radius_of_the_fastest_modes():
    mass, force, gamma, beta = alphas(0.73)
    assert gamma == pytest.approx(0.5 - mass + force, rel=1e-14)  # order 2
    assert beta == pytest.approx((gamma + 0.5) ** 2 / 4.0, rel=1e-14)  # largest damping of fast modes
    fast = generalised_alpha(0.73).undamped(np.array(1e6))
    assert np.exp(fast.real * 1e6) == pytest.approx(0.73, rel=1e-3)
    trapezoidal = generalised_alpha(1.0).undamped(np.array(0.8))
    assert [trapezoidal.real, trapezoidal.imag] == pytest.approx([0.0, 2.0 * np.arctan(0.4) / 0.8], abs=1e-12)
    assert sqrt(8.0) == pytest.approx(RK4.limit)
