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
        ("capstan", 8, 2.0),
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


def test_a_chain_on_a_drum_holds_more_than_a_rope_by_its_polygon():
    """First term: mu (1 + mu^2) phi^3 / (12 N^2) of N ln((1 + mu tan(phi/2N)) / (1 - mu tan(phi/2N))) - mu phi."""
    count = 50
    assert CASES["capstan"].error(count) == pytest.approx(0.23 * (1.0 + 0.23**2) * 3.5**3 / (12.0 * count**2), rel=0.01)


@pytest.mark.parametrize(("name", "at"), [("ramp-stick", 0.0112839), ("ramp-slip", -0.4310562)])
def test_a_block_on_a_ramp_stops_and_sticks_or_slides_back(name, at):
    assert CASES[name].value(37) == pytest.approx(at, abs=1e-7)
    assert CASES[name].error(37) == pytest.approx(0.0, abs=1e-12)
