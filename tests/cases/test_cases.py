"""Models on problems of known answer: orders of their errors, energy, sizes that belong to the problem."""

import pytest

from verify.cases.energy import imbalance
from verify.cases.table import CASES
from verify.errors import InputError
from verify.problem.beam import Beam
from verify.quantities.base import evaluate
from verify.scene.model import Scene

SCENE = Scene(name="cases", beam=Beam(length=0.5, width=0.02, thickness=0.001, youngs_modulus=70e9, density=2700.0))


@pytest.mark.parametrize(
    ("case", "counts", "order"),
    [
        ("elastica-deflection", (20, 40, 80), 2.0),
        ("elastica-shortening", (80, 160, 320), 2.0),
        ("hanging-chain", (23, 46, 92), 2.0),
        ("rotating-cantilever-1", (80, 160, 320), 2.0),
        ("rotating-cantilever-3", (40, 80, 160), 2.0),
        ("restitution", (500, 1000, 2000), 1.0),
    ],
)
def test_error_falls_with_the_order_of_the_model(case, counts, order):
    assert evaluate("case.order", {"case": case, "counts": counts}, SCENE, None) == pytest.approx(order, abs=0.15)


@pytest.mark.parametrize("name", ["moving-load-deepest", "moving-load-beside"])
def test_segments_under_a_moving_force_deflect_as_by_frybas_series(name):
    assert CASES[name].error() == pytest.approx(0.0, abs=1e-6)


@pytest.mark.parametrize("tip", ["free", "roller"])
def test_work_energy_and_damping_balance_under_all_loads(tip):
    assert imbalance(tip, 1e-9, 6) < 2e-7
    assert imbalance(tip, 1e-6, 6) < 2e-4


@pytest.mark.parametrize("name", ["hanging-two-bars", "roll-up-gregory", "creep-speed"])
def test_a_size_that_belongs_to_the_problem_is_not_changed(name):
    with pytest.raises(InputError, match="count = 7"):
        CASES[name].value(7)
    with pytest.raises(InputError, match="case = 'elastica'"):
        evaluate("case.value", {"case": "elastica"}, SCENE, None)
