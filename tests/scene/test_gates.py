"""Bands of gates, and scenes that run."""

from math import inf, nan

import pytest
from msgspec.structs import replace

from tests.beams import STRIP, STRIP_TOML
from verify import load_scene, run_scene
from verify.analysis.solution_cache import Bracket, SolutionCache
from verify.errors import InputError
from verify.quantities.base import QUANTITIES, quantity
from verify.scene.model import Complex, Gate, Scene
from verify.scene.run import plan, run_gate
from verify.validation import convert

# --- Bands ---


@pytest.fixture(autouse=True)
def _own_quantities(monkeypatch):
    monkeypatch.setattr(QUANTITIES, "_members", dict(QUANTITIES))


SCENE = Scene(name="strip", beam=STRIP)


def judged(value, **band):
    """The result of a gate on a quantity that has this value."""
    quantity("test.value", unit="m", reads=())(lambda scene, cache: value)
    gate = Gate(id="g", quantity="test.value", why="test", **band)
    return run_gate(gate, SCENE, SolutionCache(SCENE.beam))


@pytest.mark.parametrize(
    ("value", "band", "passed", "fraction"),
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
        (3.0 + 4.4j, {"expect": Complex(3.0, 4.0), "within": 0.5}, True, 0.8),
        (3.4 + 4.4j, {"expect": Complex(3.0, 4.0), "within": 0.5}, False, 0.8 * 2**0.5),
    ],
)
def test_band_is_judged_from_every_side(value, band, passed, fraction):
    result = judged(value, **band)
    assert result.passed is passed
    assert bool(result.reason) is not passed
    assert result.unit == "m"
    assert result.fraction == (None if fraction is None else pytest.approx(fraction))


@pytest.mark.parametrize(
    ("value", "band"),
    [
        (nan, {"expect": 10.0, "within": 0.5}),
        (inf, {"at_least": 1.0}),
        (1 + 2j, {"expect": 1.0, "within": 9.0}),
        (1.0, {"expect": Complex(1.0, 0.0), "within": 9.0}),
        (complex(nan, 1.0), {"expect": Complex(1.0, 0.0), "within": 9.0}),
        (10.0, {"expect": 10.0}),
        (Bracket(9.0, 12.0), {"expect": 10.0, "within": 5.0}),
        (Bracket(9.0, 12.0), {"at_most": 50.0}),
    ],
)
def test_value_that_cannot_be_judged_fails(value, band):
    result = judged(value, **band)
    assert result.passed is False
    assert result.reason


def test_defect_in_a_quantity_is_a_failed_gate():
    def broken(scene, cache):
        raise ZeroDivisionError("by nothing")

    quantity("test.broken", unit="1", reads=())(broken)
    gate = Gate(id="g", quantity="test.broken", at_most=1.0, why="test")
    result = run_gate(gate, SCENE, SolutionCache(SCENE.beam))
    assert result.passed is False
    assert "ZeroDivisionError: by nothing" in result.reason


@pytest.mark.parametrize(
    ("band", "message"),
    [
        ({}, "give expect with within, or at_least, at_most"),
        ({"expect": 1.0, "at_most": 2.0}, "give expect with within, or at_least, at_most"),
        ({"within": 1.0, "at_most": 2.0}, "together with expect"),
        ({"expect": 1.0, "within": 0.0}, "above 0"),
        ({"expect": 1.0, "within": -1.0}, "above 0"),
        ({"expect": nan, "within": 1.0}, "expect = nan"),
        ({"expect": {"re": inf, "im": 0.5}, "within": 1.0}, "expect.re = inf"),
        ({"at_least": 3.0, "at_most": 2.0}, "exchange them"),
        ({"expect": 1.0, "within": 0.5, "why": ""}, "why"),
        ({"expect": 1.0, "within": "1%"}, "within = '1%': give a finite number"),
    ],
)
def test_gate_without_a_clear_band_is_refused(band, message):
    with pytest.raises(InputError, match=message):
        convert({"id": "g", "quantity": "mode.frequency", "why": "test", **band}, Gate, "gate.g")


# --- Run ---

SCENE_RUN = f"""name = "s"{STRIP_TOML}[drive]
frequency_hz = 311
force = [{{ position = 0.11, measured_from = "right", amplitude = 2.5 }}]
[spectrum]
modes = 3
count = 12
[[gate]]
id = "segments"
quantity = "mode.frequency_error"
arguments = {{ model = "segment", mode = 3, count = 20 }}
expect = -3.6e-5
within = 5e-6
why = "mu^4/1440"
[[gate]]
id = "wrong"
quantity = "mode.frequency"
arguments = {{ model = "analytic", mode = 2 }}
at_most = 1.0
why = "test"
[[gate]]
id = "too-few"
quantity = "mode.frequency"
arguments = {{ model = "fem", mode = 40, count = 3 }}
at_most = 1.0
why = "test"
"""


@pytest.fixture(scope="module")
def path(tmp_path_factory):
    path = tmp_path_factory.mktemp("scene") / "s.toml"
    path.write_text(SCENE_RUN)
    return path


@pytest.fixture(scope="module")
def run(path):
    steps = []
    return run_scene(path, steps.append), steps


def test_gates_pass_fail_and_cannot_be_evaluated(run):
    result, _ = run
    segments, wrong, too_few = result.gates
    assert segments.passed
    assert segments.value == pytest.approx(-3.609e-5, abs=1e-8)
    assert 0.0 < segments.fraction < 0.1
    assert "lies above 1.0" in wrong.reason
    assert too_few.reason.startswith("cannot be evaluated: mode = 40")
    assert [gate.id for gate in result.failed] == ["wrong", "too-few"]
    assert not result.passed


def test_studies_and_what_is_skipped(run, path):
    result, _ = run
    assert "spectrum" in result.results
    assert result.results["spectrum"].tables[0].rows
    assert {one.what for one in result.skipped} == {row.what for row in plan(path) if not row.runs}
    assert "motor" in {one.what for one in result.skipped}
    assert result.seconds > 0.0


def test_beam_alone_runs(path):
    scene = load_scene(path)
    result = run_scene(replace(scene.bare, drive=None))
    assert result.passed
    assert result.results == {}
