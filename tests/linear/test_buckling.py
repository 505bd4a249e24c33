"""Buckling loads against Euler's, and what a compressed beam refuses."""

import numpy as np
import pytest
from msgspec.structs import replace
from scipy.optimize import brentq

from verify import analytic_modes
from verify.attached import PointSpring
from verify.beam import Beam, PointForce
from verify.errors import InputError
from verify.exact.buckling import buckling_load, check_stable
from verify.section import Section

STRUT = Beam(length=0.83, width=0.021, thickness=0.0037, youngs_modulus=113e9, density=4470.0)
EULER = np.pi**2 * STRUT.bending_stiffness / STRUT.length**2


def test_eulers_four_columns_and_two_more():
    """(L / effective length)^2; tan x = x for clamped-pinned."""
    root = brentq(lambda x: np.sin(x) - x * np.cos(x), 4.0, 4.6, xtol=1e-15)
    expected = {
        ("pinned", "pinned"): 1.0,
        ("clamped", "free"): 0.25,
        ("clamped", "clamped"): 4.0,
        ("pinned", "clamped"): (root / np.pi) ** 2,
        ("clamped", "guided"): 1.0,
        ("guided", "pinned"): 0.25,
        ("guided", "guided"): 1.0,
        ("free", "guided"): 0.25,
    }
    for supports, factor in expected.items():
        for beam in (replace(STRUT, supports=supports), replace(STRUT, supports=supports[::-1])):
            assert buckling_load(beam) == pytest.approx(factor * EULER, rel=1e-14)


def test_what_can_turn_as_a_whole_carries_no_compression():
    for supports in (("free", "free"), ("pinned", "free")):
        assert buckling_load(replace(STRUT, supports=supports)) == 0.0
        with pytest.raises(InputError, match="buckling load of 0 N"):
            analytic_modes.exact_frequency_hz(replace(STRUT, supports=supports, tension=-1e-3), 1)


@pytest.mark.parametrize("size", [0.03, 2.7, 410.0])
def test_an_elastic_clamp_at_a_pinned_end(size):
    """Tan x = x / (1 + x^2 / k), k = k_r L / EI: from pinned-pinned to clamped-pinned (Timoshenko and Gere, 2.3)."""
    spring = PointSpring(position=STRUT.length, rotational=size * STRUT.bending_stiffness / STRUT.length)
    root = brentq(lambda x: np.sin(x) * (1 + x**2 / size) - x * np.cos(x), 3.1, 4.6, xtol=1e-15)
    assert buckling_load(replace(STRUT, spring=(spring,))) == pytest.approx((root / np.pi) ** 2 * EULER, rel=1e-13)


def test_a_strut_on_a_foundation_buckles_into_the_waves_that_cost_least():
    """Min over n of n^2 + k / (n^2 pi^4), k = k_f L^4 / EI."""
    for k in (30.0, 4e3, 7e5):
        beam = replace(STRUT, foundation=k * STRUT.bending_stiffness / STRUT.length**4)
        expected = min(n**2 + k / (np.pi**4 * n**2) for n in range(1, 30))
        assert buckling_load(beam) == pytest.approx(expected * EULER, rel=1e-13)


def test_a_soft_spring_in_the_middle_and_a_stiff_one():
    """From 16 pi^2 EI / L^3 on the strut buckles in two halves, at 4 times Euler's load; before, by its middle too.

    Then tan(x / 2) / (x / 2) = 1 - 4 x^2 EI / (k L^3) with x^2 = P L^2 / EI (Timoshenko and Gere, 2.5).
    """
    middle, unit = STRUT.length / 2, STRUT.bending_stiffness / STRUT.length**3
    stiff = replace(STRUT, spring=(PointSpring(position=middle, stiffness=16.1 * np.pi**2 * unit),))
    assert buckling_load(stiff) == pytest.approx(4 * EULER, rel=1e-13)
    soft = replace(STRUT, spring=(PointSpring(position=middle, stiffness=90.0 * unit),))
    root = brentq(lambda x: np.tan(x / 2) / (x / 2) - 1 + 4 * x**2 / 90.0, 3.3, 6.2, xtol=1e-15)
    assert buckling_load(soft) == pytest.approx((root / np.pi) ** 2 * EULER, rel=1e-12)


def test_a_stepped_column():
    """tan(x a) tan(y b) = y / x, x^2 = P / EI_1, y^2 = P / EI_2, clamped below, free above (Timoshenko and Gere, 2.14).

    A moment that goes on over the step, EI_1 x^2 = EI_2 y^2, is all that couples them.
    """
    column = replace(
        STRUT, supports=("clamped", "free"), section=(Section(length=0.31), Section(length=0.52, thickness=0.0029))
    )
    lower, upper = (piece.bending_stiffness for piece in column.pieces)

    def equation(force):
        x, y = np.sqrt(force / lower), np.sqrt(force / upper)
        return np.tan(x * 0.31) * np.tan(y * 0.52) - y / x

    expected = brentq(equation, 0.1 * EULER, 0.25 * EULER, xtol=1e-14)
    assert buckling_load(column) == pytest.approx(expected, rel=1e-13)


def test_compression_at_and_beyond_buckling_is_refused_everywhere():
    load = buckling_load(STRUT)
    check_stable(replace(STRUT, tension=-load * (1 - 1e-12)))
    for force in (-load, -3 * load):
        beam = replace(STRUT, tension=force)
        for ask in (
            lambda beam=beam: check_stable(beam),
            lambda beam=beam: analytic_modes.exact_frequency_hz(beam, 1),
            lambda beam=beam: analytic_modes.solve_modes(beam, 3),
            lambda beam=beam: analytic_modes.mode_shape(beam, 1, np.zeros(1)),
            lambda beam=beam: analytic_modes.solve_harmonic(beam, [PointForce(position=0.1)], 50.0),
        ):
            with pytest.raises(InputError, match=rf"beam\.tension = {force!r} N compresses the beam beyond"):
                ask()
