"""What parts tell of how a beam bends that moves nearly as a whole: right to a thousandth, or refused."""

import numpy as np
import pytest
from msgspec.structs import replace

from verify import analytic_modes, fem_beam, segment_model
from verify.beam import Beam, PointForce
from verify.errors import InputError

BAR = Beam(length=1.0, width=0.02, thickness=0.009, youngs_modulus=8.27e10, density=7765.0, supports=("free", "free"))
FORCES = (PointForce(position=0.2), PointForce(position=0.8))
X = np.array([0.1, 0.3, 0.45, 0.9])
MODELS = {"fem": fem_beam.solve_harmonic, "segment": segment_model.solve_harmonic}


@pytest.mark.parametrize("order", [1, 2])
@pytest.mark.parametrize("model", MODELS)
@pytest.mark.parametrize("hertz", [3e-5, 3e-4, 3e-3, 3e-2, 0.3])
@pytest.mark.parametrize("supports", [("free", "free"), ("guided", "free"), ("guided", "guided")])
def test_slopes_and_curvatures_of_a_floating_bar_are_right_or_refused(order, model, hertz, supports):
    beam = replace(BAR, supports=supports)
    exact = analytic_modes.solve_harmonic(beam, FORCES, hertz).derivative(X, order)
    told = 0
    for count in (80, 400, 2000):
        field = MODELS[model](beam, FORCES, hertz, count)
        try:
            found = field.derivative(X, order)
        except InputError as refusal:
            assert "keep no digits of how it bends: give fewer parts, model = analytic" in str(refusal)
            continue
        told += 1
        assert abs(found - exact).max() < 1.2e-3 * abs(exact).max()
    assert told == 3 or hertz < 0.3
    assert told < 3 or hertz > 3e-5


@pytest.mark.parametrize("model", MODELS)
def test_a_beam_that_is_held_is_read_under_a_drive_as_slow(model):
    held = replace(BAR, supports=("clamped", "free"))
    exact = analytic_modes.solve_harmonic(held, FORCES, 3e-5)
    for order in (1, 2):
        found = MODELS[model](held, FORCES, 3e-5, 2000).derivative(X, order)
        assert found == pytest.approx(exact.derivative(X, order), abs=2e-6 * abs(exact.derivative(X, order)).max())
