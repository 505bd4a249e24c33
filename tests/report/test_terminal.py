"""A run in terminals of 80 and 120 columns, and in short."""

from io import StringIO

import pytest
from rich.console import Console

from verify.report.summary import expected, run_data, verdict, worst_gate
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


def test_run_data_is_complete(full_run):
    data = run_data(full_run, "verify run")
    assert [gate["passed"] for gate in data["gates"]] == [True, False]
    assert data["inputs"]["beam"]["length"] == 0.37
    assert set(data["results"]) == {"spectrum", "made"}
    assert "gate" not in data["inputs"]
    assert data["environment"]["numpy"]


def test_void_results_lead_the_verdict(small_run):
    import msgspec

    from verify.report.page import run_page
    from verify.report.result import Result

    void = Result("", warnings=["Lift-off: the surface falls away from the slider.", "more"])
    run = msgspec.structs.replace(small_run, results={"motion": void})
    assert verdict(run).startswith("No valid result: The slider. All 2 gates passed")
    page = run_page(run)
    assert page.index('class="verdict void"') < page.index("Lift-off") < page.index("<nav")
    assert "No valid result" in printed(run, 80)
