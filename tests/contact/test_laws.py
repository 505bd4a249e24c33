"""Each friction law in one step against the same law in thousands of small ones; its derivative, its dissipation."""

import numpy as np
import pytest
from numba import njit

from verify.contact import laws
from verify.contact.state import CONTACT, LAWS, POINT, SLIDER, Path, Slip

DT, MU, STATIC, LOAD, STEEPNESS = 1e-3, 0.3, 0.45, 7.0, 40.0
PARTS = 200_000


@njit
def force_of(slip, normal, slider, point, contact):
    return laws.force(slip, normal, slider, point, contact)


@njit
def slope_of(path, normal, slider, point, contact):
    return laws.slope(path, normal, slider, point, contact)


def bodies(law, static=MU):
    slider, point, contact = np.zeros(1, SLIDER), np.zeros(1, POINT), np.zeros(1, CONTACT)
    slider["mu"], slider["mu_static"], point["law"] = MU, static, LAWS[law]
    slider["steepness"] = STEEPNESS if law == "tanh" else 0.0
    contact["normal"] = LOAD
    return slider[0], point[0], contact[0]


def slip(r, a0, a1, compliance):
    return Slip(r, a0, a1, r - (2.0 * a0 + a1) / 6.0, 0.0, compliance, compliance, DT, False, False)


def in_small_steps(law, r, a0, a1, compliance, static):
    """Mean friction of r' = c f - a in unit time; Coulomb's law sticks within a small step where its limit lets it."""
    total, sticks = 0.0, False
    for a in a0 + (a1 - a0) * (np.arange(PARTS) + 0.5) / PARTS:
        held = (a / compliance) - r * PARTS / compliance  # stops r in this small step
        if law == "tanh":
            f = -MU * LOAD * np.tanh(STEEPNESS * r)
        elif (sticks or abs(r) * PARTS <= 2.0 * compliance * MU * LOAD) and abs(held) <= static * LOAD:
            f, sticks = held, True
        else:
            f, sticks = -MU * LOAD * (np.sign(r) if r else -np.sign(a)), False
        total, r = total + f / PARTS, r + (compliance * f - a) / PARTS
    return total


@pytest.mark.parametrize(
    ("law", "static", "r", "a0", "a1"),
    [
        ("tanh", MU, 0.11, -0.2, 0.5),
        ("tanh", MU, -0.02, 0.31, 0.37),
        ("coulomb", MU, 0.7, 0.4, 0.9),
        ("coulomb", MU, 0.05, -0.3, 0.2),
        ("coulomb", STATIC, 0.21, 1.9, 0.1),
        ("coulomb", MU, 0.0, 1.1, -0.6),  # leaves rest and comes back to it
        ("coulomb", STATIC, -0.3, -0.2, -2.9),
    ],
)
def test_the_friction_of_a_step_is_that_of_small_steps(law, static, r, a0, a1):
    compliance = 0.37
    slider, point, contact = bodies(law, static)
    by_law = force_of(slip(r, a0, a1, compliance), LOAD, slider, point, contact)
    if law == "tanh":  # with the mean acceleration, the mean of r being exact
        a, r = 0.5 * (a0 + a1), r - (2.0 * a0 + a1) / 6.0 + 0.25 * (a0 + a1)
        a0 = a1 = a
    assert by_law == pytest.approx(in_small_steps(law, r, a0, a1, compliance, static), abs=3e-4 * MU * LOAD)


@pytest.mark.parametrize(("before", "needed", "holds"), [(2.0, 1.5, False), (0.4, 1.9, False), (0.1, 0.7, True)])
def test_a_held_point_slides_under_no_more_than_its_limit(before, needed, holds):
    """Forces over mu N, which the last one exceeds where the normal force has fallen since."""
    slider, point, contact = bodies("coulomb")
    scale, compliance = MU * LOAD, 0.37
    contact["sticks_before"], contact["friction_before"] = 1.0, before * scale
    mean = -0.5 * compliance * needed * scale
    moving = Slip(0.0, -2.0 * mean, -2.0 * mean, mean, 0.0, 0.1, compliance, DT, False, True)
    force = force_of(moving, LOAD, slider, point, contact) / scale
    assert 0.0 < force <= 1.0 + 1e-12
    assert (force == pytest.approx(needed)) is holds


@pytest.mark.parametrize("law", sorted(LAWS))
@pytest.mark.parametrize(("start", "end"), [(0.2, 0.11), (0.13, -0.07), (-0.3, -0.31), (0.02, 0.0203)])
def test_the_slope_of_friction_is_its_derivative_and_no_friction_rises_with_the_slip(law, start, end):
    def friction(end):
        slider, point, contact = bodies(law)
        return slope_of(Path(start, end, 0.04, 0.3, np.inf, 1e-13, DT), LOAD, slider, point, contact)

    step = 1e-6
    least, most, slope = friction(end)
    assert least == most
    difference = (friction(end + step)[0] - friction(end - step)[0]) / (2.0 * step)
    assert slope == pytest.approx(difference, rel=2e-3, abs=1e-5)
    assert slope <= 0.0
