"""Means and the largest of a slider's run are of all its steps, however few samples are kept of them."""

import numpy as np
import pytest

from verify import Beam, PointForce, Slider, simulate

ROD = Beam(
    length=0.42, width=0.012, thickness=0.004, youngs_modulus=205e9, density=7830.0, supports=("clamped", "free")
)
FORCES = (PointForce(position=0.31, amplitude=20.0, phase_deg=-60.0), PointForce(position=0.37, amplitude=13.0))
MASS, MU, PRESSED = 0.002, 0.3, 0.5 + 0.002 * 9.81


def ride(soft, samples=2, step=None, **given):
    slider = Slider(**{"mass": MASS, "mu": MU, "position": 0.2003, "preload": 0.5, "coupling": "one-way"} | given)
    return simulate(
        ROD,
        FORCES,
        130.0,
        0.03,
        model="segment",
        count=23,
        soft_start_periods=soft,
        slider=slider,
        samples=samples,
        step=step,
    )


LAWS = {"flat": {"slope": 40.0}, "steep": {"slope": 5000.0}, "coulomb": {"law": "coulomb"}}


@pytest.mark.parametrize("soft", [0.0, 2.0])
@pytest.mark.parametrize("law", LAWS)
def test_mean_friction_is_the_momentum_that_the_slider_gained_over_the_time(law, soft):
    run = ride(soft, **LAWS[law])
    assert run.mean_friction * 0.03 == pytest.approx(MASS * run.speed[-1], rel=1e-9)


@pytest.mark.parametrize("soft", [0.0, 2.0])
@pytest.mark.parametrize("law", LAWS)
@pytest.mark.parametrize("coupling", ["one-way", "two-way"])
def test_figures_of_a_run_are_those_of_a_run_that_is_kept_at_every_one_of_much_finer_steps(law, soft, coupling):
    few = ride(soft, coupling=coupling, **LAWS[law])
    fine = ride(soft, samples=60_001, step=0.5e-6, coupling=coupling, **LAWS[law])
    friction, surface = (
        float(np.trapezoid(values, fine.times)) / 0.03 for values in (fine.friction, fine.surface_speed)
    )
    close = 0.02 if coupling == "two-way" or not soft else 2e-3
    assert few.mean_friction == pytest.approx(friction, rel=close)
    assert few.mean_surface_speed == pytest.approx(surface, rel=close)
    assert few.largest_friction == pytest.approx(abs(fine.friction).max(), rel=0.05)


def test_a_slider_at_rest_on_a_beam_at_rest_needs_no_friction():
    """It is held all along by a ninth of what it could be: rounding of the surface's speed is no slip."""
    run = ride(2.0, samples=301, law="coulomb")
    assert run.friction[0] == 0.0
    assert 5e-3 < run.largest_friction < 7e-3 < 0.05 * MU * PRESSED


def test_a_slider_put_on_with_a_speed_slips_from_the_start():
    run = ride(2.0, samples=31, law="coulomb", speed=-0.3)
    assert run.friction[0] == pytest.approx(MU * PRESSED)
    assert run.largest_friction == pytest.approx(MU * PRESSED)


@pytest.mark.parametrize("mu", [0.02, 0.3])
def test_the_largest_friction_is_what_the_law_gives_where_it_slips(mu):
    slips = ride(0.0, law="coulomb", mu=mu)
    assert slips.largest_friction == pytest.approx(mu * PRESSED)


def test_a_beam_alone_has_no_friction():
    run = simulate(ROD, FORCES, 130.0, 0.01, model="segment", count=23)
    assert np.isnan([run.mean_friction, run.largest_friction, run.mean_surface_speed]).all()
