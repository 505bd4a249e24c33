"""What the kernels book of a step, where it can be written down: polynomials in time, which Simpson's rule has whole."""

import numpy as np
import pytest
from interpreted import interpreted
from numpy.polynomial import Polynomial

from verify.motion import books_kernels
from verify.motion.kernels import GIVEN_END, PULL, SURFACE

DT, MASS = 0.37, 1.9


def at_thirds(seen, column, of):
    seen[:, column] = of(np.array([0.0, 0.5, 1.0]) * DT)


@pytest.mark.parametrize(
    ("pull", "speed"),
    [
        (Polynomial([0.7, -1.3, 2.1]), Polynomial([0.4, 0.9])),
        (Polynomial([-0.2, 1.1]), Polynomial([0.3, -0.8, 1.7])),
    ],
)
def test_what_pulls_a_slider_works_as_force_times_speed_over_the_step(pull, speed):
    """On the slider at its own speed, on the surface at the surface's, which is straight in a step."""
    seen, took = np.zeros((3, 1 + max(PULL, SURFACE))), np.zeros(1 + GIVEN_END)
    surface = Polynomial([1.3, -0.6])
    at_thirds(seen, PULL, pull)
    at_thirds(seen, SURFACE, surface)
    took[GIVEN_END] = pull.integ()(DT)
    moved = speed.integ()(DT)
    own, below = interpreted(books_kernels, "pulled")(speed(0.0), speed(DT), moved, DT, MASS, seen, took)
    assert own == pytest.approx(MASS * (pull * speed).integ()(DT), rel=1e-13)
    assert below == pytest.approx(MASS * (pull * surface).integ()(DT), rel=1e-13)


def test_friction_works_on_a_surface_that_is_straight_in_a_step_by_parts():
    """Of m dv/dt = F at any speed: F times the surface's speed is m (v s) less m v s', s the surface's."""
    seen = np.zeros((3, 1 + SURFACE))
    surface, speed = Polynomial([1.3, -0.6]), Polynomial([0.3, -0.8, 1.7])
    at_thirds(seen, SURFACE, surface)
    moved = speed.integ()(DT)
    found = interpreted(books_kernels, "by_parts")(speed(0.0), speed(DT), moved, DT, MASS, seen)
    assert found == pytest.approx(-MASS * (speed.deriv() * surface).integ()(DT), rel=1e-13)
