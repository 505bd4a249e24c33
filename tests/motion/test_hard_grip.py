"""A light slider that friction grips hard: caught in a small part of a step, it goes on with the surface."""

import numpy as np
import pytest
from interpreted import interpreted
from mpmath import mp
from scipy.integrate import solve_ivp

from verify.beam import Beam, PointForce
from verify.fem_beam import solve_harmonic
from verify.motion import friction_kernels, way_kernels
from verify.motion.simulate import simulate
from verify.slider import Slider

STRIP = Beam(length=0.3, width=0.01, thickness=0.002, youngs_modulus=100e9, density=8000.0, loss_factor=0.01)
PUSHES = (PointForce(position=0.033, amplitude=5.0, phase_deg=20.0), PointForce(position=0.26, amplitude=3.0))
SOFT = (PointForce(position=0.033, amplitude=0.005, phase_deg=20.0), PointForce(position=0.26, amplitude=0.003))
"""A slope of 2e-6, of whose square nothing is felt."""
GIVEN = {"model": "fem", "count": 13, "start": "steady", "samples": 30}


@pytest.mark.parametrize("law", ["tanh", "coulomb"])
def test_a_light_slider_that_is_gripped_hard_goes_the_way_of_the_surface_at_the_step_chosen(law):
    """0.1 mg under 0.2 N, put at rest on a steady wave: caught within 1e-5 of a period, it goes -(h/2) (w' - w'_0)."""
    slider = Slider(mass=1e-7, mu=0.3, preload=0.2, law=law, position=0.123, coupling="one-way")
    run = simulate(STRIP, SOFT, 700.0, 7.3 / 700.0, slider=slider, **GIVEN)
    slope = solve_harmonic(STRIP, SOFT, 700.0, 13).slope([slider.position])[0]
    turned = np.real(slope * (np.exp(2j * np.pi * 700.0 * run.times) - 1.0))
    assert run.travelled == pytest.approx(-0.5 * STRIP.thickness * turned, abs=2e-4 * STRIP.thickness * abs(slope))


@pytest.mark.parametrize("law", ["tanh", "coulomb"])
def test_so_does_one_that_the_beam_feels(law):
    """Friction that takes it along gives the beam 1e-7 of what its forces do: in 64 steps a period it was thrown off."""
    given = {"mass": 1e-7, "mu": 0.3, "preload": 0.2, "law": law, "position": 0.123, "normal": "massless"}
    felt = Slider(coupling="two-way", **given)
    run = simulate(STRIP, SOFT, 700.0, 7.3 / 700.0, slider=felt, step=1.0 / (64.0 * 700.0), **GIVEN)
    slope = solve_harmonic(STRIP, SOFT, 700.0, 13).slope([felt.position])[0]
    turned = np.real(slope * (np.exp(2j * np.pi * 700.0 * run.times) - 1.0))
    assert run.travelled == pytest.approx(-0.5 * STRIP.thickness * turned, abs=2e-4 * STRIP.thickness * abs(slope))


@pytest.mark.parametrize(
    ("law", "mass", "within"),
    [
        ({"slope": 3e4}, 4e-5, 3e-5),
        ({"slope": 3e4}, 1.3e-3, 3e-5),
        ({"slope": 3e3}, 1.7e-2, 3e-5),
        ({"law": "coulomb"}, 1.3e-3, 3e-5),
        ({"law": "coulomb"}, 1.7e-2, 1e-4),
        ({"law": "coulomb", "kinematics": "following"}, 1e-8, 3e-5),
    ],
)
def test_how_hard_friction_grips_needs_no_finer_step(law, mass, within):
    """Held all the time, and swept under at every turn of the surface, which friction follows or not."""
    slider = Slider(mass=mass, mu=0.3, preload=0.2, position=0.123, coupling="one-way", **law)
    coarse, fine = (
        simulate(STRIP, PUSHES, 700.0, 4.1 / 700.0, slider=slider, step=one, **GIVEN) for one in (None, 1e-7)
    )
    assert coarse.travelled == pytest.approx(fine.travelled, abs=within * abs(fine.travelled).max())


def way_by_small_steps(rho, alpha, tau, n=3000):
    """The integral of rho over tau under rho' = -(tanh rho + alpha), by Runge and Kutta's rule; all (draws,)."""
    moved, h = np.zeros_like(rho), tau / n
    for _ in range(n):
        first = -(np.tanh(rho) + alpha)
        second = -(np.tanh(rho + 0.5 * h * first) + alpha)
        third = -(np.tanh(rho + 0.5 * h * second) + alpha)
        fourth = -(np.tanh(rho + h * third) + alpha)
        moved += h * (rho + h * (first + second + third) / 6.0)
        rho = rho + h * (first + 2.0 * second + 2.0 * third + fourth) / 6.0
    return moved, rho


@pytest.mark.parametrize(("off", "within"), [(0.0, 2e-6), (1e-9, 2e-6), (-9e-8, 2e-6), (1.1e-7, 5e-7), (-1e-3, 1e-10)])
def test_a_surface_that_accelerates_as_friction_does_leaves_the_slider_by_as_much_as_small_steps_tell(off, within):
    """Within 1e-7 of mu N / m the closed form parts; forward and back, in shares of the largest relative speed."""
    change, way = interpreted(friction_kernels, "tanh_speed_change"), interpreted(way_kernels, "relative_way")
    draw = np.random.default_rng(29)
    rho, tau, side = draw.uniform(-22.0, 22.0, 80), 10.0 ** draw.uniform(-0.6, 1.5, 80), draw.choice([-1.0, 1.0], 80)
    expected, last = way_by_small_steps(rho, 1.0 + off, tau)
    b, slope = 2.3, 17.0
    given = [
        (s * r / slope, s * (1.0 + off) * b, b, slope, t / (slope * b)) for r, t, s in zip(rho, tau, side, strict=True)
    ]
    found = side * slope * slope * b * np.array([way(*one, change(*one)) for one in given])
    assert abs((found - expected) / (tau * np.maximum(abs(rho), abs(last)))).max() < within


@pytest.mark.parametrize("alpha", [0.0, 0.3, 1.7, 40.0])
@pytest.mark.parametrize("rho", [27.0, 3e3, -3e3, 2e7, -2e7])
def test_a_slider_that_slides_fast_all_the_time_is_a_stone_that_is_thrown(rho, alpha):
    """Friction is all it can be: without that the ways are differences of squares, and lose what these are longer by."""
    change, way = interpreted(friction_kernels, "tanh_speed_change"), interpreted(way_kernels, "relative_way")
    b, slope, tau = 2.3, 17.0, 0.11
    for side in (-1.0, 1.0):
        given = side * rho / slope, side * alpha * b, b, slope, tau / (slope * b)
        found = side * slope * slope * b * way(*given, change(*given))
        assert found == pytest.approx(rho * tau - 0.5 * (alpha + np.sign(rho)) * tau**2, rel=1e-14)


def integral(of, end):
    return float(mp.quad(of, mp.linspace(0, mp.mpf(end), 9)))


@pytest.mark.parametrize("end", [-0.693, -0.41, -0.08, 1e-4, 0.13, 0.37, 0.55, 0.693])
def test_bernoullis_numbers_give_the_integral_of_planck_to_rounding(end):
    exact = integral(lambda u: u / mp.expm1(u) if u else mp.mpf(1), end)
    assert abs(interpreted(way_kernels, "_planck")(end) / exact - 1.0) < 1e-15


@pytest.mark.parametrize("end", [1e-6, 0.21, 0.344, 0.346, 0.9, 4.3, 37.0])
def test_a_slider_that_comes_to_rest_and_one_that_is_swept_have_ways_to_rounding(end):
    """On either side of 2 eta = 0.69, where the one parts; of the other, which cancels near nought, in all its size."""
    coth, tanh = interpreted(way_kernels, "_by_coth"), interpreted(way_kernels, "_by_tanh")
    assert coth(end) == pytest.approx(integral(lambda x: x * mp.coth(x) if x else mp.mpf(1), end), rel=2e-15)
    for side in (-1.0, 1.0):
        exact = side * integral(lambda x: x * mp.tanh(x), end)
        assert tanh(side * end) == pytest.approx(exact, rel=1e-15, abs=3e-16)


@pytest.mark.parametrize(("start", "end"), [(-0.7, 2.1), (0.02, 0.03), (-31.0, 44.0), (800.0, -1100.0)])
def test_the_logarithm_of_cosh_changes_without_overflow(start, end):
    exact = float(mp.log(mp.cosh(start)) - mp.log(mp.cosh(end)))
    assert interpreted(way_kernels, "_ln_cosh_change")(start, end) == pytest.approx(exact, rel=1e-15, abs=2e-16)


@pytest.mark.parametrize("alpha", [0.0, 0.1, 0.7, 1.0, 3.3, 900.0])
def test_what_friction_adds_in_a_short_time_is_off_by_less_than_it_says(alpha):
    """At its longest, against eight parts of it by steps of order 8; the worst draw of this rule comes near the bound."""
    brief, tau, worst = interpreted(friction_kernels, "_brief_change"), 0.00999 / (1.0 + alpha), 0.0
    for rho in (-15.0, -2.1, -0.45, 0.02, 0.45, 1.3):
        moved = solve_ivp(
            lambda t, y: [-np.tanh(y[0]) - alpha, -np.tanh(y[0])],
            (0.0, tau),
            [rho, 0.0],
            method="DOP853",
            rtol=1e-13,
            atol=1e-18,
            max_step=tau / 8,
        )
        worst = max(worst, abs(brief(rho, alpha, tau) - moved.y[1, -1]) / tau)
    assert worst < 3e-11
    assert alpha > 0.0 or worst > 2e-11
