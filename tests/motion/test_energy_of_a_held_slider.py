"""A slider that the beam carries makes no energy of its own, however heavy, short its step and few the parts."""

import pytest

from verify.beam import Beam, PointForce
from verify.motion.simulate import simulate
from verify.slider import Slider

STRIP = Beam(
    length=0.18,
    width=0.009,
    thickness=0.0016,
    youngs_modulus=114e9,
    density=4430.0,
    supports=("clamped", "free"),
    loss_factor=0.012,
)
FORCES = (
    PointForce(position=0.021, amplitude=2.3, phase_deg=17.0),
    PointForce(position=0.167, amplitude=1.4, phase_deg=-71.0),
)


def ridden(step, mass, preload, place=0.0745, **model):
    slider = Slider(mass=mass, mu=0.27, slope=400.0, position=place, preload=preload, coupling="two-way")
    return simulate(STRIP, FORCES, 13.7e3, 1.5e-3, slider=slider, step=step, samples=2001, **model)


@pytest.mark.parametrize(
    ("step", "mass", "preload", "model"),
    [
        (None, 0.1, 0.5, {"model": "segment", "count": 49}),
        (2e-8, 0.003, 0.5, {"model": "segment", "count": 20}),
        (None, 0.3, 0.5, {"model": "fem", "count": 24}),
        (5e-8, 1.0, 0.5, {"model": "analytic", "modes": 20}),
        (None, 0.02, 50.0, {"model": "segment", "count": 49}),
    ],
)
def test_the_reaction_stays_that_of_a_mass_on_a_moving_surface(step, mass, preload, model):
    """Within what weight and the surface's acceleration ask for; straight up it grew to 1e5 N and more in these."""
    found = ridden(step, mass, preload, **model)
    load = mass * 9.81 + preload
    first, last = found.normal_force[200:800], found.normal_force[-600:]
    assert abs(last - load).max() < 6.0 * abs(first - load).max()
    books = found.ledger
    assert abs(books.residual) < 5e-4 * (books.work_in + books.elastic)


def test_halving_the_step_leaves_the_way_where_it_was():
    ways = [ridden(step, 0.003, 0.5, 0.083, model="segment", count=20).displacement for step in (8e-8, 4e-8, 2e-8)]
    assert ways[1] == pytest.approx(ways[2], rel=2e-3)
    assert abs(ways[1] - ways[2]) < 0.5 * abs(ways[0] - ways[1])
