"""A run in terminals of 80 and 120 columns, and in short."""

from io import StringIO

import pytest
from rich.console import Console

from verify.report.summary import expected, gates_table, run_data, value_text, verdict, worst_gate
from verify.report.terminal import print_run
from verify.scene.model import Complex, Gate


def printed(run, width):
    out = StringIO()
    print_run(run, Console(file=out, width=width, markup=False, highlight=False))
    return out.getvalue()


@pytest.mark.parametrize("width", [80, 120])
def test_run_fits_the_terminal(full_run, width):
    text = printed(full_run, width)
    assert max(map(len, text.splitlines())) <= width
    assert "1 of 2 gates failed" in text.splitlines()[-1]
    assert "FAIL elements-lie-above: 0.037 lies above 0.01 & <more>" in text
    assert "third-frequency" in text
    assert "All modes: 40 rows" in text


def test_worst_gate_is_named(small_run, full_run):
    assert "worst gate: third-frequency" in printed(small_run, 80) or "worst gate: elements" in printed(small_run, 80)
    assert worst_gate(full_run).gate.id == "elements-lie-above"
    assert verdict(small_run) == "All 2 gates passed"


def test_failed_gates_come_first(full_run):
    assert [row[0] for row in gates_table(full_run).rows] == ["FAIL", "pass"]


@pytest.mark.parametrize(
    ("band", "text"),
    [
        ({"expect": 4469.941234567, "within": 0.5}, "4469.94 ± 0.5"),
        ({"expect": Complex(0.25, -0.125), "within": 1e-3}, "0.25 - 0.125i ± 0.001"),
        ({"expect": 22.37}, "contains 22.37"),
        ({"at_least": 0.9, "at_most": 1.1}, "at least 0.9, at most 1.1"),
    ],
)
def test_criterion_in_needed_digits(band, text):
    assert expected(Gate(id="g", quantity="mode.frequency", why="test", **band)) == text


def test_values_of_every_kind():
    from verify.judge.bracket import Bracket

    assert value_text(Bracket(lower=1.25, upper=1.5)) == "1.25 to 1.5"
    assert value_text(0.5 - 2.0j) == "0.5 - 2i"
    assert value_text(None) == "–"


def test_run_data_is_complete(full_run):
    data = run_data(full_run, "verify run")
    assert [gate["passed"] for gate in data["gates"]] == [True, False]
    assert data["inputs"]["beam"]["length"] == 0.37
    assert set(data["results"]) == {"spectrum", "made"}
    assert "gate" not in data["inputs"]
    assert data["environment"]["numpy"]
