"""Sweeps keep the order of their lists and the rows of failures; claims are compared with quantities."""

import pytest
from msgspec.structs import replace

from verify.analysis.solution_cache import SolutionCache
from verify.errors import InputError
from verify.exact.closed_forms import frequency_hz
from verify.quantities.base import evaluate
from verify.scene.load import load_scene
from verify.scene.model import Claim
from verify.studies.base import studies_of
from verify.studies.claims import Claims
from verify.studies.sweep import Sweep


def column(table, name):
    return [record[name] for record in table.records()]


PAPER = load_scene("paper")
FREQUENCY = {"model": "analytic", "mode": 3}


def run_sweep(scene, quantities, over, **settings):
    return Sweep(quantities=tuple(quantities), over=over, **settings).run(scene, None, lambda step: None)


def test_rows_follow_the_lists_with_the_first_key_slowest():
    result = run_sweep(
        PAPER,
        ["mode.frequency"],
        {"beam.density": [2500.0, 2900.0], "beam.length": [0.4, 0.7, 0.5]},
        arguments=FREQUENCY,
    )
    table = result.tables[0]
    assert column(table, "beam.density") == [2500.0] * 3 + [2900.0] * 3
    assert column(table, "beam.length") == [0.4, 0.7, 0.5] * 2
    for row in table.records():
        beam = replace(PAPER.beam, density=row["beam.density"], length=row["beam.length"])
        assert row["mode.frequency"] == pytest.approx(frequency_hz(beam, 3), rel=1e-13)


def test_failed_combinations_are_rows_with_the_reason():
    over = {"beam.density": [2700.0, -1.0, 3100.0]}
    result = run_sweep(PAPER, ["mode.frequency"], over, arguments=FREQUENCY)
    good, bad, other = result.tables[0].records()
    assert good["mode.frequency"] > other["mode.frequency"]
    assert bad["mode.frequency"] is None
    assert "beam.density = -1.0" in bad["reason"]
    assert "1 without a value" in result.summary


def test_keys_joined_by_commas_vary_together():
    over = {"drive.force.*.amplitude, drive.frequency_hz": [[1.0, 4276.0], [3.0, 4290.0]]}
    table = run_sweep(load_scene("paper-wave"), ["wave.crest_speed"], over, arguments={"model": "analytic"}).tables[0]
    assert column(table, "drive.frequency_hz") == [4276.0, 4290.0]
    slow, fast = column(table, "wave.crest_speed")
    assert 2.5 < fast / slow < 3.5


def test_sweeps_render(renders):
    one = run_sweep(PAPER, ["mode.frequency"], {"mode": [1, 2, 40]}, arguments={"model": "analytic"})
    axes = renders(one)["sweep-mode.frequency"]
    assert axes.get_xlabel() == "mode"
    assert axes.get_ylabel() == "mode.frequency, Hz"
    two = run_sweep(PAPER, ["mode.frequency"], {"model": ["fem", "segment"], "count": [9, 21]}, arguments={"mode": 4})
    assert [text.get_text() for text in renders(two)["sweep-mode.frequency"].get_xticklabels()] == ["fem", "segment"]


@pytest.mark.parametrize(
    ("quantities", "over", "word"),
    [
        (["mode.frequencey"], {"mode": [1]}, "mode.frequency"),
        (["mode.frequency"], {"mod": [1]}, "'mode'"),
        (["mode.frequency"], {"beam.lenght": [1.0]}, "'length'"),
        (["mode.frequency"], {"drive.force.7.amplitude": [1.0]}, "7 is not known"),
        (["mode.frequency"], {"mode": list(range(1, 1000)), "count": list(range(1, 1000))}, "combinations"),
    ],
)
def test_wrong_sweeps_are_refused_before_they_run(quantities, over, word):
    with pytest.raises(InputError, match=word):
        run_sweep(PAPER, quantities, over, arguments={"model": "segment"})


def claim(**other):
    own = {"id": "a", "source": "somebody", "quantity": "mode.frequency", "arguments": FREQUENCY, "read": "stated"}
    return Claim(**own | other)


def test_claims_equal_the_quantities(run, renders):
    claims = (
        claim(value=83.1, tolerance=0.1),
        claim(id="b", value="negative"),
        claim(id="c", arguments={"mode": 2}, value="positive"),
    )
    result = run(replace(PAPER.bare, claim=claims), Claims())
    expected = evaluate("mode.frequency", FREQUENCY, PAPER, SolutionCache(PAPER.beam))
    assert column(result.tables[0], "computed")[:2] == pytest.approx([expected] * 2)
    assert column(result.tables[0], "agrees") == [True, False, None]
    assert column(result.tables[0], "claimed") == ["83.1 ± 0.1", "negative", "positive"]
    assert "Claim c is not evaluated" in result.warnings[0]
    assert result.summary.startswith("1 of 2 ")
    renders(result)


def test_claims_of_the_slider_are_computed_on_the_scene(run):
    table = run("paper-slider", Claims()).tables[0]
    rows = {row["claim"]: row for row in table.records()}
    assert rows["to-the-left"]["agrees"] is True
    assert rows["mean-speed"]["agrees"] is False
    assert rows["to-the-left"]["computed"] == pytest.approx(-1.3833e-9, rel=1e-3)
    assert rows["to-the-left"]["exact beam"] == pytest.approx(-9.107e-10, rel=1e-3)


def test_sections_and_what_they_imply():
    assert [name for name, _ in studies_of(load_scene("paper-slider"))] == ["wave", "motion", "claims", "sweep"]
    assert "motion" not in dict(studies_of(replace(load_scene("paper-slider").bare, slider=None)))
    assert [name for name, _ in studies_of(load_scene("taut-strip"))] == ["spectrum", "convergence"]
