"""Models on problems of known answer that no gate of a scene judges: orders of the errors, a moving force, energy."""

import pytest

from verify.analysis.comparison import observed_order
from verify.cases.energy import imbalance
from verify.cases.table import CASES


@pytest.mark.parametrize(
    ("name", "first", "order"),
    [
        ("elastica-shortening", 80, 2.0),
        ("hanging-chain", 23, 2.0),
        ("restitution", 500, 1.0),
        ("pendulum", 20, 2.0),
        ("heavy-column", 4, 4.0),
        ("spin-up-tensioned", 8, 4.0),
    ],
)
def test_error_falls_with_the_order_of_the_model(name, first, order):
    counts = [first, 2 * first, 4 * first]
    assert observed_order(counts, [CASES[name].error(n) for n in counts]) == pytest.approx(order, abs=0.15)


def test_segments_under_a_moving_force_deflect_as_by_frybas_series():
    assert [CASES[f"moving-load-{at}"].error() for at in ("deepest", "beside")] == pytest.approx([0.0, 0.0], abs=1e-6)


@pytest.mark.parametrize("tip", ["free", "roller"])
def test_work_energy_and_damping_balance_under_all_loads(tip):
    assert imbalance(tip, 1e-9, 6) < 2e-7
    assert imbalance(tip, 1e-6, 6) < 2e-4
