"""Closed forms of contact against direct sums, integrated motions and published formulas in many digits."""

from math import acos, asin, cos, pi, sin, sqrt

import mpmath as mp
import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from reference.motor import bounces

from verify.cases import layer
from verify.cases.landing import landing_phase
from verify.cases.restitution import contact_time, restitution

ANGLES, SPEEDS, COMPLIANCES = st.floats(0.05, 3.0), st.floats(-0.9, 1.3), st.floats(0.01, 20.0)


def return_mapped(phi, r, epsilon, steps=8000):
    """F/(mu N) by return mapping of the shear in small steps over the contact."""
    s = np.linspace(-phi, phi, steps + 1)
    y, total = 0.0, 0.0
    for rate, limit in zip(np.diff(np.sin(s)) - r * np.diff(s), epsilon * (np.cos(s[1:]) - cos(phi)), strict=True):
        before, y = y, max(-limit, min(limit, y + rate))
        total += 0.5 * (before + y) * 2.0 * phi / steps
    return total / (2.0 * epsilon * (sin(phi) - phi * cos(phi)))


@pytest.mark.parametrize(
    ("phi", "r", "epsilon"),
    [
        (1.0, 0.0, 3.0),
        (1.0, 0.87, 0.1),
        (2.1, -0.3, 1.7),
        (1.0, 1.2, 0.3),
        (3.0, -1.7, 2.0),  # slips from the start and sticks before the crest
        (2.0, 0.90803, 0.02),
        (1.27, 0.75483, 0.4),  # a short slip
    ],
)
def test_the_force_of_a_layer_is_that_of_return_mapping(phi, r, epsilon):
    assert layer.force(phi, r, epsilon) == pytest.approx(return_mapped(phi, r, epsilon), abs=2e-5)


@given(phi=ANGLES, r=SPEEDS, epsilon=COMPLIANCES)
def test_a_layer_transmits_at_most_mu_n_and_less_at_a_higher_speed(phi, r, epsilon):
    slow, fast = layer.force(phi, r, epsilon), layer.force(phi, r + 0.05, epsilon)
    assert -1.0 - 1e-9 <= fast <= slow + 1e-9 <= 1.0 + 2e-9


@given(phi=st.floats(0.05, 2.5), epsilon=COMPLIANCES)
def test_the_force_vanishes_at_the_no_load_speed_and_a_stuck_layer_moves_at_the_mean_of_the_crest(phi, epsilon):
    speed = layer.no_load_speed(phi, epsilon)
    assert layer.force(phi, speed, epsilon) == pytest.approx(0.0, abs=1e-9)
    if epsilon >= 1.0 / phi - cos(phi) / sin(phi):
        assert speed == pytest.approx(sin(phi) / phi, rel=1e-12)


@given(phi=ANGLES, r=st.one_of(st.floats(-0.9, 0.95), st.floats(1.05, 1.3)))
def test_a_stiff_layer_tends_to_coulomb_friction(phi, r):
    assert layer.force(phi, r, 1e-10) == pytest.approx(layer.force(phi, r), abs=2e-3)


@pytest.mark.parametrize(("phi", "r"), [(1.3, 0.8), (2.3, 0.31), (0.21, 0.9902)])
def test_force_and_efficiency_are_integrals_over_the_contact(phi, r):
    with mp.workdps(30):
        psi = acos(r)
        ahead, behind = (
            [mp.quad(lambda s, n=n: (mp.cos(s) - mp.cos(phi)) * mp.cos(s) ** n, span) for n in (0, 1)]
            for span in ([0, psi], [psi, phi])
        )
        drag, power = float(ahead[0] - behind[0]), float(ahead[1] - behind[1])
        normal = float(ahead[0] + behind[0])
    assert layer.force(phi, r) == pytest.approx(drag / normal, rel=1e-11)
    assert layer.efficiency(phi, r) == pytest.approx(r * drag / power, rel=1e-11)


@pytest.mark.parametrize("ratio", [1.5, 2.0, 37.3, 2.71e5])
def test_a_mass_lands_where_its_parabola_meets_the_surface(ratio):
    lands, leaves = landing_phase(ratio), asin(1.0 / ratio)
    if ratio < 10.0:
        assert lands == pytest.approx(bounces(ratio, 0.0, 3)[0].phase, abs=1e-12)
    time = lands - leaves
    height = 1.0 / ratio + sqrt(1.0 - 1.0 / ratio**2) * time - 0.5 * time * time / ratio
    assert height == pytest.approx(sin(lands), abs=1e-13 * max(ratio, 10.0))
    assert 0.0 <= time - (ratio * (1.0 + cos(leaves)) - 1.0) < 2.0 * pi or ratio < 10.0


@pytest.mark.parametrize("zeta", [0.0, 1e-9, 0.2, 0.99999999, 1.0, 1.0 + 1e-13, 1.2, 7.0, 300.0])
def test_restitution_and_contact_time_are_the_published_formulas_in_forty_digits(zeta):
    """Schwager and Poeschel (2007) over complex numbers."""
    with mp.workdps(40):
        beta = mp.mpf(zeta) + mp.mpf(10) ** -30
        omega = mp.sqrt(mp.mpc(1 - beta**2))
        time = -mp.j * mp.log(beta + mp.j * omega) * 2 / omega  # its tangent is 2 beta omega / (beta^2 - omega^2)
        expected = float(mp.exp(-beta * time).real)
    assert restitution(zeta) == pytest.approx(expected, rel=4e-14)
    assert contact_time(zeta) == pytest.approx(float(time.real), rel=4e-14)
