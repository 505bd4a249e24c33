"""A slider on a driving layer: sums over the contact, step by step, beside the closed forms."""

from itertools import pairwise
from math import cos, pi, sin

import mpmath as mp
import pytest
from hypothesis import given
from hypothesis import strategies as st

from verify.contact.layer import _even_at, efficiency, force, half_space_force, no_load_speed
from verify.errors import InputError

ANGLES = st.floats(0.05, 3.0)
SPEEDS = st.floats(-0.9, 1.3)
GIVES = st.floats(0.01, 20.0)


def mapped(phi, r, epsilon, steps):
    """F/(mu N) by return mapping: stretch in small steps, cut back to the limit where it passes that."""
    step, y, total = 2.0 * phi / steps, 0.0, 0.0
    for i in range(steps):
        s = -phi + (i + 1) * step
        limit = epsilon * (cos(s) - cos(phi))
        rate = sin(s) - sin(s - step) - r * step
        after = max(-limit, min(limit, y + rate))
        total += 0.5 * step * (y + after)
        y = after
    return total / (2.0 * epsilon * (sin(phi) - phi * cos(phi)))


@pytest.mark.parametrize(
    ("phi", "r", "epsilon"),
    [
        (1.0, 0.0, 3.0),
        (1.0, 0.87, 0.1),
        (1.3, 0.6, 0.4),
        (2.1, -0.3, 1.7),
        (0.4, 0.99, 0.05),
        (1.0, 1.2, 0.3),
        (3.0, -1.7, 2.0),  # slips from the start and sticks before the crest
        (3.0, -1.7, 3.0),
        (2.0, 0.90803, 0.02),  # two short slips, a hundredth of the contact and less
        (2.0, 0.9080602, 0.02),
        (1.27, 0.75483, 0.4),
    ],
)
def test_a_layer_that_gives_way_carries_what_return_mapping_finds(phi, r, epsilon):
    coarse, fine = mapped(phi, r, epsilon, 4000), mapped(phi, r, epsilon, 8000)
    assert abs(coarse - fine) < 1e-3
    assert force(phi, r, epsilon) == pytest.approx(fine, abs=3.0 * abs(coarse - fine) + 1e-8)


def test_the_no_load_speed_counts_a_short_slip():
    """By return mapping in 2e6 steps."""
    assert no_load_speed(1.27, 0.4) == pytest.approx(0.7548422402, rel=1e-9)


@given(phi=ANGLES, r=SPEEDS, epsilon=GIVES)
def test_no_layer_carries_more_than_friction_and_none_drives_more_at_more_speed(phi, r, epsilon):
    slow, fast = force(phi, r, epsilon), force(phi, r + 0.05, epsilon)
    assert -1.0 - 1e-9 <= fast <= slow + 1e-9 <= 1.0 + 2e-9


@given(phi=ANGLES, r=st.one_of(st.floats(-0.9, 0.95), st.floats(1.05, 1.3)))
def test_a_layer_that_hardly_gives_way_is_coulombs(phi, r):
    """But where the slider is as fast as the crests: there the stretch grows too slowly to reach any limit."""
    assert force(phi, r, 1e-10) == pytest.approx(force(phi, r), abs=2e-3)


@given(phi=st.floats(0.05, 2.5), epsilon=GIVES)
def test_nothing_pulls_at_the_no_load_speed_and_a_stuck_layer_runs_at_the_mean_of_the_crest(phi, epsilon):
    speed = no_load_speed(phi, epsilon)
    assert force(phi, speed, epsilon) == pytest.approx(0.0, abs=1e-9)
    if epsilon >= 1.0 / phi - cos(phi) / sin(phi):
        assert speed == pytest.approx(sin(phi) / phi, rel=1e-12)
    assert min(cos(phi), sin(phi) / phi) - 1e-12 <= speed <= 1.0


def sums(phi, r):
    """(force, power into the layer) over the contact in 30 digits, each over its own unit."""
    with mp.workdps(30):
        phi, psi = mp.mpf(phi), mp.acos(mp.mpf(r))
        depth = lambda s: mp.cos(s) - mp.cos(phi)  # noqa: E731
        given = lambda s: depth(s) * mp.cos(s)  # noqa: E731
        edges = [0, psi], [psi, phi]
        pull = mp.quad(depth, edges[0]) - mp.quad(depth, edges[1])
        power = mp.quad(given, edges[0]) - mp.quad(given, edges[1])
        return float(pull / mp.quad(depth, [0, phi])), float(mp.mpf(r) * pull / power)


@pytest.mark.parametrize(("phi", "r"), [(1.3, 0.8), (1.0, 0.8), (2.3, 0.31), (0.21, 0.9902)])
def test_force_and_efficiency_are_sums_over_the_contact(phi, r):
    pull, share = sums(phi, r)
    assert force(phi, r) == pytest.approx(pull, rel=1e-12)
    assert efficiency(phi, r) == pytest.approx(share, rel=1e-12)


def test_a_small_contact_runs_at_two_sines_of_ten_degrees_of_its_edge():
    """2 G(psi) = G(phi) with G(s) = s phi^2/2 - s^3/6 there: psi/phi = 2 sin(pi/18)."""
    phi = 1e-3
    assert (1.0 - no_load_speed(phi)) / (0.5 * phi**2) == pytest.approx(4.0 * sin(pi / 18) ** 2, rel=1e-6)


def test_a_half_space_is_nearer_to_its_crests_than_a_layer():
    """v0/V = 1 - 0.326387970816785 q; periodic boundary elements agree to 1e-3 (REFERENCE)."""
    for q in (0.07, 0.3, 0.8):
        assert half_space_force(q, 1.0 - 0.326387970816785 * q) == pytest.approx(0.0, abs=1e-12)
    assert half_space_force(0.3, 0.2) == 1.0
    assert half_space_force(0.3, 1.0) == -1.0


@pytest.mark.parametrize(
    ("wrong", "said"),
    [
        (lambda: force(0.0, 0.3), "contact_half_angle = 0.0"),
        (lambda: force(3.2, 0.3), "contact_half_angle = 3.2"),
        (lambda: force(1.0, float("nan")), "speed_ratio = nan"),
        (lambda: no_load_speed(1.0, -0.1), "epsilon = -0.1"),
        (lambda: efficiency(1.0, 1.0), "speed_ratio = 1.0"),
        (lambda: efficiency(2.9, 0.999), "speed_ratio = 0.999"),
        (lambda: half_space_force(1.0, 0.5), "pressure_ratio = 1.0"),
    ],
)
def test_what_is_no_contact_is_refused(wrong, said):
    with pytest.raises(InputError, match=said):
        wrong()


def test_the_layers_force_at_rest_is_all_of_friction_only_while_it_gives_way_little():
    """For phi < pi/2 up to epsilon = cot phi."""
    phi = 0.8
    edge = cos(phi) / sin(phi)
    assert force(phi, 0.0, 0.999 * edge) == pytest.approx(1.0, abs=1e-12)
    assert force(phi, 0.0, 1.01 * edge) < 1.0 - 1e-7


@given(st.floats(-1.3, 1.3), st.floats(-1.0, 1.0))
def test_every_place_where_the_layer_runs_evenly_with_the_crest_is_found_in_a_wavelength(r, slope):
    """Each change of sign of cos s + slope sin s - r on a fine circle lies beside one of them, and each is a zero."""

    def ahead(s):
        return cos(s) + slope * sin(s) - r

    found = _even_at(r, slope)
    assert all(abs(ahead(s)) < 1e-7 for s in found)
    circle = [pi * (k / 500.0 - 1.0) for k in range(1001)]
    for before, after in pairwise(circle):
        if ahead(before) * ahead(after) < 0.0:
            assert any(before - 1e-7 <= s <= after + 1e-7 for s in found)
