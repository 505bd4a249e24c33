"""Bands judge from every side; what cannot be judged fails with its reason."""

from math import inf, nan

import numpy as np
import pytest

from verify.errors import InputError
from verify.judge.bracket import Bracket
from verify.quantities.catalogue import QUANTITIES
from verify.run.gates import expectation, judge
from verify.run.plan import asks_of
from verify.run.runner import workbench_for
from verify.scenes.checked import checked
from verify.scenes.scene import Complex, Gate, load_scene
from verify.segments import linear as segment_model

PAPER = load_scene("paper")


def verdict(monkeypatch, value, **band):
    """The verdict on a figure that comes out as `value`."""
    from msgspec.structs import replace

    fixed = replace(QUANTITIES["mode.frequency"], evaluate=lambda *given: value)
    monkeypatch.setitem(QUANTITIES, "mode.frequency", fixed)
    gate = Gate(id="g", quantity="mode.frequency", arguments={"model": "analytic", "mode": 3}, why="test", **band)
    return judge(gate, PAPER, workbench_for(PAPER))


@pytest.mark.parametrize(
    ("value", "band", "passed", "share"),
    [
        (10.4, {"expect": 10.0, "within": 0.5}, True, 0.8),
        (9.4, {"expect": 10.0, "within": 0.5}, False, 1.2),
        (10.6, {"expect": 10.0, "within": 0.5}, False, 1.2),
        (2.0, {"at_most": 8.0}, True, 0.25),
        (8.1, {"at_most": 8.0}, False, 8.1 / 8.0),
        (10.0, {"at_least": 8.0}, True, 0.8),
        (7.0, {"at_least": 8.0}, False, 8.0 / 7.0),
        (7.0, {"at_least": 6.0, "at_most": 10.0}, True, 0.5),
        (-5.0, {"at_most": 0.0}, True, None),
        (Bracket(9.0, 12.0), {"expect": 10.0}, True, 1 / 3),
        (Bracket(9.0, 12.0), {"expect": 12.0}, False, 1.0),
        (Bracket(9.0, 12.0), {"expect": 8.0}, False, 2.5 / 1.5),
    ],
)
def test_a_band_judges_from_every_side(monkeypatch, value, band, passed, share):
    found = verdict(monkeypatch, value, **band)
    assert found.passed is passed
    assert bool(found.reason) is not passed
    assert found.share == (None if share is None else pytest.approx(share))


@pytest.mark.parametrize(
    ("value", "band"),
    [
        (nan, {"expect": 10.0, "within": 0.5}),
        (inf, {"at_least": 1.0}),
        (1 + 2j, {"expect": 1.0, "within": 9.0}),
        (10.0, {"expect": 10.0}),
        (Bracket(9.0, 12.0), {"expect": 10.0, "within": 5.0}),
        (Bracket(9.0, 12.0), {"at_most": 50.0}),
    ],
)
def test_a_figure_that_cannot_be_judged_fails(monkeypatch, value, band):
    found = verdict(monkeypatch, value, **band)
    assert not found.passed
    assert found.reason


@pytest.mark.parametrize(
    ("quantity", "arguments", "reason"),
    [
        ("mode.frequncy", {}, "did you mean 'mode.frequency'"),
        ("mode.frequency", {"model": "segmnt", "mode": 1}, "did you mean 'segment'"),
        ("mode.frequency", {"model": "segment", "mode": 9, "count": 9}, "has 8 elastic modes"),
        ("mode.frequency", {"model": "segment", "mode": 9}, "count is missing"),
        (
            "mode.frequency",
            {"model": "fem", "mode": 9, "count": 20, "attachment": "lever"},
            "is a setting of model = segment",
        ),
        ("mode.order", {"model": "segment", "mode": 3, "counts": [10, 20]}, "three or more"),
    ],
)
def test_a_gate_that_cannot_be_evaluated_fails_with_the_reason(quantity, arguments, reason):
    gate = Gate(id="g", quantity=quantity, arguments=arguments, expect=1.0, within=1.0, why="test")
    found = judge(gate, PAPER, workbench_for(PAPER))
    assert not found.passed
    assert reason in found.reason
    assert found.reason.startswith("cannot be evaluated: ")


def test_a_model_that_breaks_is_a_failed_gate_not_a_crash(monkeypatch):
    def broken(*_):
        raise np.linalg.LinAlgError("singular")

    monkeypatch.setattr(segment_model, "lowest", broken)
    found = judge(PAPER.gate[0], PAPER, workbench_for(PAPER))
    assert found.reason == (
        "cannot be evaluated: the suite itself fails on it, `verify measure mode.dispersion_error` shows where"
    )


@pytest.mark.parametrize(
    ("band", "message"),
    [
        ({}, "no clear band"),
        ({"expect": 1.0, "at_most": 2.0}, "no clear band"),
        ({"within": 1.0, "at_most": 2.0}, "together with expect"),
        ({"expect": 1.0, "within": 0.0}, "above 0"),
        ({"expect": 1.0, "within": -1.0}, "above 0"),
        ({"expect": nan, "within": 1.0}, "expect = nan"),
        ({"at_least": 3.0, "at_most": 2.0}, "exchange them"),
    ],
)
def test_a_gate_without_a_clear_band_is_no_gate(band, message):
    with pytest.raises(InputError, match=message):
        checked({"id": "g", "quantity": "mode.frequency", "why": "test", **band}, Gate)


def test_a_gate_without_a_reason_is_refused():
    with pytest.raises(InputError, match="why"):
        checked({"id": "g", "quantity": "mode.frequency", "expect": 1.0, "within": 1.0}, Gate)
    with pytest.raises(InputError, match="why"):
        checked({"id": "g", "quantity": "mode.frequency", "expect": 1.0, "within": 1.0, "why": ""}, Gate)


def test_no_sentence_speaks_of_null_or_of_a_class():
    """Neither in the refusal of an argument nor in the list of quantities."""
    from verify.quantities.catalogue import arguments_of, described, quantity

    for name in QUANTITIES:
        for key in ("count", "counts", "model", "mode", "x", "window", "error"):
            for value in (5, "five", [5], -1):
                try:
                    arguments_of(quantity(name), {key: value})
                except InputError as error:
                    assert "null" not in str(error), str(error)
                    assert "<class" not in str(error), str(error)
    assert "<class" not in str(described())


def test_an_endless_figure_beside_a_complex_expectation_is_a_word(monkeypatch):
    assert verdict(monkeypatch, inf, expect=Complex(1.0, 2.0), within=0.5).reason.startswith("measured infinity, and")


def test_expectations_read_as_sentences():
    def words(**band):
        return expectation(Gate(id="g", quantity="q", why="test", **band))

    assert words(expect=-0.25, within=1e-3) == "-0.25 ± 0.001"
    assert words(expect=3.5) == "contains 3.5"
    assert words(at_least=1.0, at_most=2.0) == "at least 1.0, at most 2.0"


def test_gates_that_need_the_same_modes_share_one_solve():
    bench = workbench_for(PAPER, gates_only=True)
    for gate in PAPER.gate:
        judge(gate, PAPER, bench)
    sizes = [(solve.model, solve.count) for solve in bench.solves]
    assert len(sizes) == len(set(sizes))
    planned = {(n.model, n.count) for ask in asks_of(PAPER, gates_only=True) for n in ask.needs}
    assert set(sizes) == planned | {("segment", 41)}  # the size below the first under one per cent
