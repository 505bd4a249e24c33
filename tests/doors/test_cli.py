"""The command line as its users meet it."""

import csv
import io
import json
import os
import re
import subprocess
import sys
import tomllib
from pathlib import Path

import pytest

OWN = Path(__file__).parents[1] / "identify" / "data" / "exudyn-cantilever.csv"


def test_run_paper_passes_and_writes_its_report(verify, tmp_path):
    status, out, err = verify("run", "paper")
    assert status == 0
    assert "all 25 gates passed" in out
    assert err == ""
    assert sorted(p.name for p in (tmp_path / "reports").iterdir()) == ["paper", "paper.html"]


def test_run_as_json_holds_the_gates_and_nothing_else_is_printed(verify):
    status, out, _ = verify("run", "paper", "--json", "--no-report")
    data = json.loads(out)
    assert status == 0
    assert data["passed"] is True
    assert data["report"] is None
    gate = next(g for g in data["gates"] if g["id"] == "segment-mode-22")
    assert gate["measured"] == pytest.approx(-0.00428024, abs=5e-9)
    assert gate["expected"] == "-0.00428024 ± 5e-09"
    assert gate["band"] == {"expect": -0.00428024, "within": 5e-9, "at_least": None, "at_most": None}


def test_a_failing_gate_exits_with_1_and_says_which_and_why(verify, tmp_path):
    status, out, _ = verify("run", "paper", "--set", "gate.segment-mode-22.expect=-0.005")
    assert status == 1
    assert "1 of 25 gates failed" in out
    assert "gate segment-mode-22: measured -0.00428" in out
    assert "failed" in (tmp_path / "reports" / "paper.html").read_text("utf-8")[:600]


def test_a_closed_form_figure(verify):
    assert verify("measure", "mode.frequency", "model=analytic", "mode=22")[:2] == (
        0,
        "mode.frequency = 4469.94052769 Hz\n",
    )


def test_a_measured_bracket_as_json(verify):
    _, out, _ = verify("measure", "mode.bracket", "mode=5", "count=13", "--json")
    data = json.loads(out)
    assert data["quantity"] == "mode.bracket"
    assert data["arguments"] == {"mode": 5, "count": 13}
    assert data["unit"] == "Hz"
    assert data["value"]["lower"] < 230.88535783517 < data["value"]["upper"]


def test_a_measured_order_takes_a_comma_separated_list(verify):
    _, out, _ = verify("measure", "mode.order", "model=fem", "mode=5", "counts=40,80,160", "--json")
    data = json.loads(out)
    assert data["arguments"]["counts"] == [40, 80, 160]
    assert data["value"] == pytest.approx(3.997, abs=1e-3)


def test_an_override_reaches_measure_table_and_plan(verify):
    _, out, _ = verify("measure", "mode.frequency", "model=analytic", "mode=22", "--set", "beam.length=0.25", "--json")
    assert json.loads(out)["value"] == pytest.approx(4 * 4469.94052769, rel=1e-11)
    _, out, _ = verify("table", "paper", "--modes", "3", "--counts", "8,16", "--set", "beam.length=0.25", "--json")
    assert json.loads(out)[0]["exact_hz"] == pytest.approx(4 * 9 / 484 * 4469.94052769, rel=1e-11)
    _, out, _ = verify("plan", "paper", "--set", "spectrum.count=57", "--json")
    assert any(solve["count"] == 57 for solve in json.loads(out)["solves"])


def test_a_single_mode_and_a_single_count_make_a_table(verify):
    status, out, _ = verify("table", "paper", "--modes", "5", "--counts", "49")
    assert status == 0
    assert "mode 5" in out
    assert "230.883" in out


def test_the_table_fits_into_eighty_columns(verify, monkeypatch):
    monkeypatch.setenv("COLUMNS", "80")
    _, out, _ = verify("table", "paper", "--modes", "1,22", "--counts", "10,49,98")
    assert max(len(line.rstrip()) for line in out.splitlines()) <= 80
    assert "4450.808" in out
    assert "-0.4280" in out


def test_csv_and_markdown_hold_the_json_table(verify):
    arguments = ("table", "paper", "--modes", "5,22", "--counts", "20,49,98")
    rows = json.loads(verify(*arguments, "--json")[1])
    table = list(csv.DictReader(io.StringIO(verify(*arguments, "--csv")[1])))
    assert [float(r["exact_hz"]) for r in table] == [r["exact_hz"] for r in rows]
    assert [r["segment_error"] and float(r["segment_error"]) for r in table] == [
        "" if r["segment_error"] is None else r["segment_error"] for r in rows
    ]
    assert table[3]["segment_frequency_hz"] == ""  # mode 22 of 20 segments does not exist
    lines = verify(*arguments, "--markdown")[1].splitlines()
    assert len(lines) == 2 + len(rows)
    assert set(lines[1]) <= set("|-: ")


def test_the_table_says_why_a_cell_is_empty(verify):
    rows = json.loads(verify("table", "paper", "--modes", "22", "--counts", "20,49", "--json")[1])
    assert rows[0]["segment_frequency_hz"] is None
    assert rows[0]["notes"] == ["mode = 22: the segment model at count = 20 has 19 elastic modes, raise count"]
    assert rows[1]["segment_error"] == pytest.approx(-0.00428024, abs=5e-9)
    assert rows[1]["bracket_width"] == pytest.approx(0.00688618, abs=1e-7)
    assert rows[1]["fem_run_time_s"] > 0


def test_plan_names_what_runs_what_is_skipped_and_what_cannot_work(verify):
    _, out, _ = verify("plan", "paper", "--set", "gate.segment-order.quantity=mode.ordr")
    assert "did you mean 'mode.order'" in out.replace("\n", " ").replace("  ", " ")
    assert "contact search: the scene has no slider" in out
    data = json.loads(verify("plan", "paper", "--json")[1])
    at_49 = [s for s in data["solves"] if s["count"] == 49]
    assert {s["model"] for s in at_49} == {"segment", "fem"}
    assert "gate exact-mode-22" in data["closed_forms"]


def test_plan_counts_a_wave_study_and_its_gates_as_harmonic(verify):
    data = json.loads(verify("plan", "paper-wave", "--json")[1])
    assert data["closed_forms"] == []
    assert any(
        who.startswith("wave (harmonic fields of segments and Hermite elements at N = 49") for who in data["harmonic"]
    )
    left_out = {skipped["what"] for skipped in data["skipped"]}
    assert not left_out & {"numpy, scipy, scikit-fem", "scikit-fem", "harmonic response"}
    bare = json.loads(verify("plan", "steel-cantilever", "--json")[1])
    assert {"harmonic response", "wave study"} <= {skipped["what"] for skipped in bare["skipped"]}


def test_claims_are_planned_by_the_figures_they_name_and_not_once_more_as_a_study(verify):
    data = json.loads(verify("plan", "paper", "--json")[1])
    assert {skipped["what"] for skipped in data["skipped"]}.isdisjoint({"claims study", "sensitivity study"})
    who = [*data["closed_forms"], *(name for solve in data["solves"] for name in solve["asked_by"])]
    assert any(name.startswith("claim ") for name in who)
    assert not any(name.startswith("claims") for name in who)
    assert any(name.startswith("sensitivity") for name in data["closed_forms"])


def test_a_gate_that_cannot_be_evaluated_runs_no_slider(verify, tmp_path):
    (tmp_path / "still.toml").write_text(
        "name = 'still'\nbeam = {length = 0.7, width = 0.03, thickness = 0.002, youngs_modulus = 113e9, density = 4470}"
        "\nslider = {mass = 0.1, mu = 0.2}\n[[gate]]\nid = 'g'\nquantity = 'mode.nothing'\nat_least = 0\nwhy = 'w'\n"
    )
    data = json.loads(verify("plan", "still.toml", "--json")[1])
    assert [problem["who"] for problem in data["problems"]] == ["gate g"]
    assert "slider" in {skipped["what"] for skipped in data["skipped"]}


def test_a_motion_without_a_slider_is_skipped_as_a_study_with_its_reason(verify, tmp_path):
    (tmp_path / "m.toml").write_text(
        "name = 'm'\nbeam = {length = 0.7, width = 0.03, thickness = 0.002, youngs_modulus = 113e9, density = 4470}\n"
        "drive = {frequency_hz = 433.0, force = [{position = 0.1}]}\nmotion = {duration = 1e-3}\n"
    )
    data = json.loads(verify("plan", "m.toml", "--json")[1])
    why = {skipped["what"]: skipped["why"] for skipped in data["skipped"]}
    assert why["motion study"].startswith("the scene has no [slider]")
    assert data["stepped"] == []
    status, _, err = verify("table", "m.toml", "--of", "motion")
    assert (status, err.startswith("verify: --of motion: the scene has no [slider]")) == (2, True)


def test_a_map_may_be_of_the_exact_beam_and_readings_may_not(verify):
    assert verify("plan", "paper-wave", "--set", "wave.model=analytic")[0] == 0
    assert (
        "wave.model = 'segmnt' is not known: did you mean 'segment'?"
        in (verify("plan", "paper-wave", "--set", "wave.model=segmnt")[2])
    )
    assert (
        "readings.model = 'analytic' is not known: known are fem, segment"
        in (verify("plan", "paper-slider", "--set", "readings.model=analytic")[2])
    )


def test_plan_of_a_size_that_does_not_fit_says_so_without_allocating(verify):
    status, out, _ = verify("plan", "paper", "--set", "spectrum.count=10000000000000")
    assert status == 1
    assert "cannot run: spectrum" in out


def test_quantities_and_scenes_are_listed(verify):
    out = verify("quantities")[1]
    assert "mode.frequency_error" in out
    assert "analytic | fem | segment | mean; required" in out
    listed = json.loads(verify("quantities", "--json")[1])
    assert {q["quantity"] for q in listed} >= {"mode.frequency", "mode.order", "mode.bracket", "mode.shape_error"}
    assert "paper" in verify("scenes")[1]
    assert json.loads(verify("scenes", "--json")[1])[0]["gates"] > 0


def test_choose_answers_for_both_models_and_one_part_less_is_not_enough(verify):
    data = json.loads(verify("choose", "--mode", "22", "--error", "1%", "--json")[1])
    assert {c["model"]: c["count"] for c in data["choices"]} == {"segment": 42, "fem": 35}
    segment = data["choices"][0]
    assert segment["error"] == pytest.approx(-0.00917, abs=1e-5)
    assert segment["expected_error"] == pytest.approx(segment["error"], rel=1e-9)
    assert segment["run_time_s"] > 0
    assert [c["smaller"] for c in data["choices"]] == [None, None]
    words = " ".join(verify("choose", "--mode", "22", "--error", "0.01")[1].split())
    assert "segments: N = 41 does not; every larger N does, proven by the discrete dispersion" in words


@pytest.mark.parametrize(
    ("first", "after"),
    [
        (("choose", "free-free-bar", "--mode", "5", "--error", "0.2%", "--json"), 1),
        (("measure", "free-free-bar", "mode.frequency", "model=analytic", "mode=3"), 1),
        (("compare", "steel-cantilever", str(OWN), "--count", "30", "--json"), 1),
        (("compare-shapes", "steel-cantilever", "no-such.vtu"), 1),
    ],
)
def test_the_scene_stands_first_as_in_other_commands_or_after_its_option(verify, first, after):
    said = first[:after] + first[after + 1 :] + ("--scene", first[after])
    timeless = re.compile(r'"(run_time_s|seconds)": [^,]*')
    here, there = (
        [timeless.sub("", part) if isinstance(part, str) else part for part in verify(*w)] for w in (first, said)
    )
    assert here == there
    status, _, err = verify(*first, "--scene", "paper")
    assert (status, "the scene is given twice" in err) == (2, True)
    assert verify(*first[:after], "paper", *first[after:], "x")[0] == 2


@pytest.mark.parametrize(
    ("words", "missing"),
    [
        (("measure", "paper"), "QUANTITY"),
        (("measure", "mine.toml", "mode=3"), "QUANTITY"),
        (("measure", "mode=3"), "QUANTITY"),
        (("compare",), "SCENE"),
        (("compare", "mine.csv"), "SCENE and FREQUENCIES"),
        (("compare-shapes",), "FILE"),
        (("compare-shapes", "paper"), "FILE"),
        (("compare-shapes", "mine.toml"), "FILE"),
        (("measure", "x=1/mine.toml", "mode=3"), "QUANTITY"),
    ],
)
def test_a_word_that_is_missing_is_named(verify, words, missing):
    status, _, err = verify(*words)
    assert (status, missing in err) == (2, True)


@pytest.mark.parametrize(
    "words",
    [
        ("compare", "d.csv", "--modes", "d.csv"),
        ("compare", "d.csv", "--model", "my:Chain"),
        ("compare", "nowhere.csv", "--modes", "d.csv"),
        ("compare", "d.csv", "strip.toml"),
        ("compare", "d.csv", "steel-cantilever"),
        ("compare", "nowhere.csv", "strip.toml"),
        ("compare-shapes", "d.vtu", "steel-cantilever"),
        ("compare-shapes", "d.vtu", "d.csv"),
    ],
)
def test_a_list_where_the_scene_should_stand_is_told_that_the_scene_comes_first(verify, tmp_path, words):
    (tmp_path / "d.csv").write_text("9.2\n57.9\n162.1\n")
    (tmp_path / "d.vtu").write_bytes(b"<VTKFile>\xff")
    status, _, err = verify(*words)
    assert (status, err.count("\n")) == (2, 1)
    assert f"{words[1]!r} stands where SCENE comes first" in err
    assert f"verify {words[0]} SCENE F" in err


def test_a_scene_that_is_no_toml_is_told_so_wherever_it_is_named(verify, tmp_path):
    (tmp_path / "d.csv").write_text("9.2\n57.9\n162.1\n")
    (tmp_path / "torn.toml").write_text("beam = {length = 0.7")
    for words in (("torn.toml", "d.csv"), ("d.csv", "--scene", "torn.toml"), ("d.csv", "--scene", "d.csv")):
        status, _, err = verify("compare", *words)
        assert (status, "is not TOML" in err, "comes first" in err) == (2, True, False)


def test_a_scene_may_have_an_equals_sign_in_its_path(verify, tmp_path):
    scene = tmp_path / "x=1" / "my.toml"
    scene.parent.mkdir()
    scene.write_text(
        "name = 'my'\nbeam = {length = 0.7, width = 0.03, thickness = 0.002, youngs_modulus = 113e9, density = 4470}\n"
    )
    asked = ("mode.frequency", "model=analytic", "mode=3")
    first, said = verify("measure", "x=1/my.toml", *asked), verify("measure", *asked, "--scene", scene)
    assert first == said
    assert first[0] == 0


def test_choose_says_where_one_part_less_cannot_be_built(verify):
    """Joints of EI - T l^2/12 have no stiffness left in eight links under 410 N, however coarse an error is asked for."""
    taut = ("--mode", "2", "--error", "20%", "--joints", "tensioned", "--set", "beam.tension=410.0")
    chain = json.loads(verify("choose", *taut, "--json")[1])["choices"][0]
    stiffness = 70e9 * 0.02 * 0.001**3 / 12.0
    assert 410.0 * (0.5 / chain["count"]) ** 2 < 12.0 * stiffness < 410.0 * (0.5 / (chain["count"] - 1)) ** 2
    assert chain["count"] == 9
    words = " ".join(verify("choose", *taut)[1].split())
    assert "N = 8 cannot be built (joints = 'tensioned': beam.tension = 410.0 N leaves no stiffness in a joint" in words
    assert "give more segments or choose joints = 'series')" in words


def test_choose_names_the_smaller_number_that_happens_to_do(verify):
    """Clamped-clamped, Gregory's joints: the error of mode 3 crosses zero between 33 and 34 links."""
    clamped = ("--mode", "3", "--error", "1e-6", "--set", 'beam.supports=["clamped","clamped"]')
    segment, element, literature = json.loads(verify("choose", *clamped, "--json")[1])["choices"]
    assert literature["settings"] == {"wall": "half"}
    assert literature["count"] > 100 * segment["count"] / 3
    assert (segment["count"], segment["smaller"], element["smaller"]) == (55, 33, None)
    assert abs(segment["smaller_error"]) <= 1e-6
    words = " ".join(verify("choose", *clamped)[1].split())
    assert "enough from" in words
    assert (
        "N = 54 does not; all N from 55 to 100 do, and those tried up to 105; larger ones do by the error law" in words
    )
    assert "N = 33 happens to do as well" in words
    assert "fewest" not in words


@pytest.mark.parametrize("scene", ["steel-cantilever", "stepped-beam", "free-free-bar"])
def test_choose_confirms_its_answer_by_solves_for_any_beam(verify, scene):
    from verify import load_scene
    from verify.judge.workbench import Workbench

    data = json.loads(verify("choose", "--mode", "5", "--error", "0.2%", "--scene", scene, "--json")[1])
    bench = Workbench(load_scene(scene).beam)
    for choice in data["choices"]:
        settings = tuple(choice["settings"].items())
        sizes = (choice["count"], choice["count"] - 1)
        here, less = (abs(bench.frequency_error(choice["model"], n, 5, settings)) for n in sizes)
        assert here <= 0.002 < less


def test_choose_takes_all_of_several_modes_and_names_the_one_that_asks_for_most(verify):
    line = ("--error", "0.1%", "--scene", "instrument-arm", "--set", "beam.mass=[{position=0.8, mass=0.35}]")
    twelve, out = (verify("choose", "--mode", mode, *line, "--json")[1] for mode in ("12", "1-12"))
    lower = {c["model"] + c["settings"].get("wall", ""): c["lower"] for c in json.loads(twelve)["choices"]}
    data = json.loads(out)
    assert data["modes"] == list(range(1, 13))
    assert all(c["lower"] == [] for c in data["choices"])
    counts = {c["model"] + c["settings"].get("wall", ""): c["count"] for c in data["choices"]}
    before = {c["model"] + c["settings"].get("wall", ""): c["count"] for c in json.loads(twelve)["choices"]}
    assert {name for name in lower if lower[name]} == {name for name in counts if counts[name] > before[name]}
    words = verify("choose", "--mode", "1-3", "--error", "1%")[1]
    assert "modes 1 to 3 within 1.0000 % of the exact frequencies: enough from" in words
    assert "for mode" in words
    status, _, err = verify("choose", "--mode", "5-2", "--error", "1%")
    assert (status, "write 2-5" in err) == (2, True)


@pytest.mark.parametrize(
    ("error", "said"),
    [
        ("0.5", "error = '0.5' has no per cent sign: for 0.5 per cent write 0.5% or 0.005, for 50 per cent 50%"),
        ("5", "error = '5' has no per cent sign: for 5 per cent write 5% or 0.05"),
        ("0.1", "for 0.1 per cent write 0.1% or 0.001, for 10 per cent 10%"),
        ("-0.5", "give a relative error from 1e-12 up to 1"),
        ("120%", "give a relative error from 1e-12 up to 1"),
    ],
)
def test_an_error_of_a_tenth_or_more_needs_its_per_cent_sign(verify, error, said):
    status, _, err = verify("choose", "--mode", "2", f"--error={error}")
    assert status == 2
    assert said in " ".join(err.split())
    assert verify("choose", "--mode", "2", "--error", "50%", "--json")[0] == 0


def test_a_complex_figure_has_a_real_and_an_imaginary_part(verify):
    data = json.loads(verify("measure", "wave.deflection", "x=0.25", "loss_factor=1e-3", "--json")[1])
    assert data["value"] == {
        "re": pytest.approx(-1.18467159e-6, rel=1e-8),
        "im": pytest.approx(-1.20317255e-6, rel=1e-8),
    }
    assert data["unit"] == "m"
    assert "i m" in verify("measure", "wave.deflection", "x=0.25")[1]


@pytest.mark.parametrize(
    ("words", "value", "band"),
    [
        (("wave.standing_wave_ratio",), 1.0563563, 2e-7),
        (("wave.standing_wave_ratio", "window=0.125,0.375", "model=fem", "count=400"), 1.05633, 2e-5),
        (("wave.reflection", "phase_deg=-90", "position=0.02"), 0.0274059, 1e-6),
        (("wave.standing_wave_ratio", "drive=displacement"), 2.588, 2e-3),
        (("wave.standing_wave_ratio", "--set", "drive.kind=displacement"), 2.588, 2e-3),
    ],
)
def test_wave_figures_take_the_scenes_drive_and_what_is_given_instead(verify, words, value, band):
    assert json.loads(verify("measure", *words, "--json")[1])["value"] == pytest.approx(value, abs=band)


def test_a_sweep_is_a_map_in_every_layout(verify):
    words = (
        "table",
        "paper",
        "--sweep",
        "frequency_hz=4100:4500:5",
        "--sweep",
        "phase_deg=30:150:3",
        "model=segment",
        "count=49",
    )
    data = json.loads(verify(*words, "--json")[1])
    assert [axis["name"] for axis in data["axes"]] == ["frequency_hz", "phase_deg"]
    assert (len(data["values"]), len(data["values"][0])) == (5, 3)
    rows = list(csv.DictReader(io.StringIO(verify(*words, "--csv")[1])))
    assert len(rows) == 15
    assert float(rows[4]["wave.standing_wave_ratio"]) == data["values"][1][1]
    out = verify(*words)[1]
    assert out.startswith("wave.standing_wave_ratio of 49 segments, scene paper")
    assert "least wave.standing_wave_ratio" in out


@pytest.mark.parametrize(
    ("sweep", "said"),
    [
        (("phase_deg=0:0:3",), "no point has a finite figure"),
        (("phase_deg=0:90:2",), "least wave.standing_wave_ratio = 1.05636 at phase_deg = 90"),
        (("count=20:49:2", "model=segment"), "1 of 2 points have no figure: count = 20"),
    ],
)
def test_maps_of_standing_waves_and_gaps_are_drawn(verify, sweep, said):
    status, out, err = verify("table", "paper", "--sweep", *sweep)
    assert (status, err) == (0, "")
    assert said in " ".join(out.split())


def test_a_ratio_that_is_infinite_is_no_gap_and_what_is_largest_is_told_beside_it(verify):
    """Forces in phase and against phase: a standing wave at every frequency."""
    words = ("table", "paper", "--sweep", "frequency_hz=4000:4600:4", "--sweep", "phase_deg=0:180:3", "model=segment")
    out = " ".join(verify(*words, "count=49")[1].split())
    assert (
        "infinite at 8 of 12 points, elsewhere largest wave.standing_wave_ratio = 4.93535 at frequency_hz = 4400" in out
    )
    data = json.loads(verify(*words, "count=49", "--json")[1])
    assert data["infinite"] == [[i, j] for i in range(4) for j in (0, 2)]
    assert [row[::2] for row in data["values"]] == [[None, None]] * 4
    rows = list(csv.DictReader(io.StringIO(verify(*words, "count=49", "--csv")[1])))
    assert [float(row["wave.standing_wave_ratio"]) == float("inf") for row in rows] == [True, False, True] * 4
    (line,) = (
        found for found in verify("table", "paper", "--sweep", "phase_deg=0:0:3")[1].splitlines() if "finite" in found
    )
    assert line == "no point has a finite figure, it is infinite at 3 of 3"


def test_a_map_under_one_force_is_drawn_or_refused(verify, tmp_path):
    (tmp_path / "one.toml").write_text(
        'name = "one"\n[beam]\nlength = 0.5\nwidth = 0.02\nthickness = 0.001\nyoungs_modulus = 70e9\ndensity = 2700.0\n'
        "[drive]\nfrequency_hz = 4276.0\nforce = [{ position = 0.0116 }]\n"
    )
    status, out, _ = verify("table", "one.toml", "--sweep", "frequency_hz=4000:4100:3")
    assert status == 0
    assert "no point has a finite figure" in out  # undamped, one force makes a standing wave
    status, _, err = verify("table", "one.toml", "--sweep", "phase_deg=0:90:3")
    assert status == 2
    assert "the scene has 1" in err


def test_a_standing_wave_in_a_sweep_is_empty_in_json_not_a_number_json_cannot_hold(verify):
    data = json.loads(verify("table", "paper", "--sweep", "phase_deg=0:90:2", "--json")[1])
    assert data["values"][0] is None
    assert data["values"][1] == pytest.approx(1.0563563, abs=1e-6)


def test_the_motors_figures_over_sizes(verify):
    rows = json.loads(verify("table", "paper", "--wave", "--counts", "49,98", "--json")[1])
    assert [(r["model"], r["count"]) for r in rows] == [
        ("analytic", None),
        ("segment", 49),
        ("segment", 98),
        ("fem", 49),
        ("fem", 98),
    ]
    assert rows[1]["drive_standing_wave_ratio"] == pytest.approx(1.2059534, abs=1e-6)
    assert rows[1]["best_frequency_hz"] == pytest.approx(4252.73, abs=0.05)
    assert rows[1]["best_standing_wave_ratio"] < 1.001
    assert rows[1]["notes"] == []


def test_the_motors_table_fits_into_eighty_columns_with_every_figure_whole(verify, monkeypatch):
    monkeypatch.setenv("COLUMNS", "80")
    out = verify("table", "paper", "--wave", "--counts", "49,10000")[1]
    assert max(map(len, out.splitlines())) <= 80
    assert "…" not in out
    for word in ("1.20595", "-0.06775", "-3.1863", "4252.74", "10000", "best Hz", "axis ratio"):
        assert word in out, word
    out = verify("table", "paper", "--wave", "--counts", "30")[1]
    told = " ".join(out.split())
    assert "– segment, N = 30: the reflection falls off the search, at its edge, 4340.14 Hz" in told
    (line,) = (line for line in out.splitlines() if line.split()[:2] == ["segments", "30"])
    assert line.split()[-5:] == ["falls", "off", "–", "–", "–"]
    rows = json.loads(
        verify("table", "paper", "--wave", "--counts", "49", "--set", "drive.force.1.phase_deg=0", "--json")[1]
    )
    assert rows[1]["best_frequency_hz"] is None
    assert "the wave stands at every frequency" in rows[1]["notes"][0]


def test_what_init_offers_in_comments_runs_when_it_is_taken(verify, tmp_path):
    """[drive], [slider] and [motion] without their comment signs."""
    assert verify("init", "my.toml")[0] == 0
    lines = (tmp_path / "my.toml").read_text("utf-8").splitlines()
    first, last = (
        lines.index(next(x for x in lines if x.startswith("# [drive]"))),
        lines.index("[spectrum]                        # errors of modes 1..modes at one size"),
    )
    taken = [line.removeprefix("# ") for line in lines[first:last]]
    text = "\n".join([*lines[:first], *taken])
    (tmp_path / "mine.toml").write_text(text, "utf-8")
    status, out, _ = verify(
        "run", "mine.toml", "--no-report", "--set", "motion.counts=[15,20,25]", "--set", "motion.count=20"
    )
    assert status == 0
    assert "mean speed" in out


def test_init_writes_a_scene_that_runs_and_does_not_overwrite(verify, tmp_path):
    assert verify("init", "my.toml")[0] == 0
    assert "# " in (tmp_path / "my.toml").read_text("utf-8")
    assert verify("run", "my.toml")[0] == 0
    (tmp_path / "my.toml").write_text("mine")
    status, _, err = verify("init", "my.toml")
    assert (status, (tmp_path / "my.toml").read_text("utf-8")) == (2, "mine")
    assert "--force" in err
    assert verify("init", "my.toml", "--force")[0] == 0
    data = json.loads(verify("init", "other.toml", "--json")[1])
    assert data == {"path": "other.toml", "next": ["verify", "run", "other.toml"]}
    assert (tmp_path / "other.toml").exists()


BAD = [
    ("run", "papr"),
    ("run", "none.toml"),
    ("run", "."),
    ("table", "paper", "--modes", "0"),
    ("table", "paper", "--counts", "x"),
    ("table", "paper", "--counts", "1e3"),
    ("table", "paper", "--counts", "10000000000000"),
    ("table", "paper", "--modes", ""),
    ("table", "paper", "--counts", "1,2"),
    ("measure", "mode.frequncy"),
    ("measure", "mode.frequency", "model=segmnt", "mode=1"),
    ("measure", "mode.frequency", "model=segment", "mode=0", "count=9"),
    ("measure", "mode.frequency", "model=segment", "mode=9", "count=9"),
    ("measure", "mode.frequency", "model=fem", "mode=19", "count=9"),
    ("measure", "mode.frequency", "model=segment", "mode=1", "count=10000000000000"),
    ("measure", "mode.frequency", "model=segment", "mode=1", "count=-4"),
    ("measure", "mode.frequency", "model=segment", "mode=nan", "count=9"),
    ("measure", "mode.frequency", "mode"),
    ("measure", "mode.frequency"),
    ("measure", "mode.frequency", "model=analytic", "mode=1", "extra=2"),
    ("measure", "mode.frequency", "model=analytic", "mode=1", "--scene", "nowhere"),
    ("measure", "mode.frequency", "model=analytic", "mode=1", "--set", "beam.length=nan"),
    ("measure", "mode.frequency", "model=analytic", "mode=1", "--set", "beam.thickness=0"),
    ("measure", "mode.frequency", "model=analytic", "mode=1", "--set", "beam.density=-inf"),
    ("measure", "mode.frequency", "model=analytic", "mode=1", "--set", "beam.lenght=1"),
    ("measure", "mode.bracket", "mode=3", "count=9", "--set", "beam.supports=clamped,free"),
    ("measure", "mode.count_needed", "model=segment", "mode=3", "error=0"),
    ("measure", "mode.count_needed", "model=segment", "mode=3", "error=1e-30"),
    ("measure", "drive.quarter_wavelength", "frequency_hz=0"),
    ("measure", "drive.rule_frequency", "mode=1"),
    ("choose", "--mode", "0", "--error", "1%"),
    ("choose", "--mode", "x", "--error", "1%"),
    ("choose", "--mode", "3", "--error", "0"),
    ("choose", "--mode", "3", "--error", "nan"),
    ("choose", "--mode", "3", "--error", "-1%"),
    ("choose", "--mode", "3"),
    ("measure", "mode.frequency", "model=fem", "mode=3", "count=9", "wall=half"),
    ("measure", "mode.frequency", "model=segment", "mode=3", "count=9", "wall=hlf"),
    ("measure", "mode.frequency", "model=analytic", "mode=3", "theory=rayleigh", "--scene", "taut-strip"),
    ("measure", "mode.bracket", "mode=3", "count=9", "--scene", "steel-cantilever"),
    ("run", "stepped-beam", "--set", "beam.section.0.length=0.3"),
    ("run", "stepped-beam", "--set", "beam.section.0.lenght=0.3"),
    ("measure", "wave.standing_wave_ratio", "window=0,0.2"),
    ("measure", "wave.standing_wave_ratio", "window=0.2,0.21"),
    ("measure", "wave.standing_wave_ratio", "window=0.2"),
    ("measure", "wave.standing_wave_ratio", "loss_factor=-0.1"),
    ("measure", "wave.standing_wave_ratio", "frequency_hz=nan"),
    ("measure", "wave.standing_wave_ratio", "frequency_hz=inf"),
    ("measure", "wave.standing_wave_ratio", "position=0.6"),
    ("measure", "wave.standing_wave_ratio", "position=-0.1"),
    ("measure", "wave.standing_wave_ratio", "model=segment"),
    ("measure", "wave.standing_wave_ratio", "model=fem", "count=20", "load=lever"),
    ("measure", "wave.standing_wave_ratio", "modal_damping=0.1"),
    ("measure", "wave.standing_wave_ratio", "--scene", "steel-cantilever"),
    ("measure", "wave.standing_wave_ratio", "count=5"),
    ("measure", "mode.frequency", "model=analytic", "mode=3", "count=5"),
    ("measure", "wave.order", "model=fem", "counts=98,196,392", "count=5"),
    ("measure", "wave.standing_wave_ratio", "model=segment", "count=3"),
    ("measure", "wave.standing_wave_ratio", "position=0"),
    ("measure", "wave.best_frequency", "phase_deg=0"),
    ("measure", "wave.power_imbalance", "model=segment", "count=49", "loss_factor=0.01", "joint_dashpot=1e-6"),
    ("measure", "wave.power_imbalance", "model=fem", "count=49", "loss_factor=0.01", "modal_damping=0.01"),
    ("table", "paper", "--sweep", "count=49:98:2"),
    ("table", "paper", "--sweep", "position=0:0:1"),
    ("measure", "mode.frequency", "model=analytic", "mode=1", "mode=2"),
    ("measure", "wave.deflection", "x=0.6"),
    ("measure", "wave.deflection", "x=nan"),
    ("measure", "wave.deflection", "x=0.25", "frequency_hz=4469.94052768887"),
    ("table", "paper", "--sweep", "frequency=1:2:3"),
    ("table", "paper", "--sweep", "frequency_hz=1:2"),
    ("table", "paper", "--sweep", "frequency_hz=4000:4100:3", "--quantity", "mode.frequency"),
    ("table", "paper", "--sweep", "frequency_hz=4000:4100:3", "--quantity", "wave.deflection", "x=0.2"),
    ("table", "paper", "model=segment"),
    ("table", "steel-cantilever", "--wave"),
    ("run", "paper-wave", "--set", "drive.force.0.position=0.6"),
    ("run", "paper-wave", "--set", "wave.counts=0,2"),
    ("plan", "papr"),
    ("nosuch",),
    ("init", "no/such/folder/my.toml"),
    ("run", "paper", "--set", "beam"),
]


@pytest.mark.parametrize("words", BAD, ids=" ".join)
def test_bad_input_is_one_sentence_and_exit_2(verify, tmp_path, words):
    status, out, err = verify(*words)
    assert status == 2
    assert out == ""
    assert "Traceback" not in err
    assert err.strip()
    assert err.startswith("Usage") or len(err.strip().splitlines()) == 1
    assert not list(tmp_path.rglob("*.html"))


def test_an_unwritable_report_folder_is_refused_before_anything_is_run(verify, tmp_path):
    (tmp_path / "file").write_text("mine")
    status, out, err = verify("run", "paper", "--reports", "file/below")
    assert (status, out) == (2, "")
    assert "reports = 'file/below' cannot be written to" in err
    assert (tmp_path / "file").read_text() == "mine"


def test_an_interrupt_leaves_nothing_half_written(verify, tmp_path, monkeypatch):
    from verify.report import html

    def interrupted(*_):
        raise KeyboardInterrupt

    monkeypatch.setattr(html, "rendered", interrupted)
    status, _, err = verify("run", "paper")
    assert status == 130
    assert "interrupted" in err
    assert list((tmp_path / "reports").iterdir()) == []


def test_a_write_that_fails_midway_keeps_the_old_file(tmp_path, monkeypatch):
    import os

    from verify.errors import InputError
    from verify.files import write_whole

    target = tmp_path / "r.html"
    target.write_text("old")
    monkeypatch.setattr(os, "replace", lambda *_: (_ for _ in ()).throw(OSError(28, "No space left on device")))
    with pytest.raises(InputError, match="No space left"):
        write_whole(target, "new")
    assert [p.name for p in tmp_path.iterdir()] == ["r.html"]
    assert target.read_text() == "old"


def test_an_interrupt_during_the_first_import_is_answered_too():
    """Deterministic: the import of click is what is interrupted."""
    code = (
        "import sys, runpy\n"
        "class Interrupt:\n"
        "    def find_spec(self, name, path=None, target=None):\n"
        "        if name == 'click':\n"
        "            raise KeyboardInterrupt\n"
        "sys.meta_path.insert(0, Interrupt())\n"
        "runpy.run_module('verify', run_name='__main__')\n"
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=False)
    assert (done.returncode, done.stdout) == (130, "")
    assert done.stderr == "verify: interrupted; nothing half-written is left\n"


def test_the_installed_command_is_the_module():
    from importlib.metadata import entry_points

    (command,) = [e for e in entry_points(group="console_scripts") if e.name == "verify"]
    assert command.value == "verify.__main__:main"


@pytest.mark.parametrize(
    "words",
    [
        ("table", "paper", "--counts", "30,40"),
        ("table", "paper", "--wave", "--counts", "49"),
        ("quantities",),
        ("table", "paper", "--sweep", "frequency_hz=4000:4600:241", "--csv"),
        ("plan", "paper"),
    ],
    ids=" ".join,
)
def test_a_reader_that_leaves_ends_the_command_without_a_word(words):
    """The reader has gone before the first line is written."""
    read, write = os.pipe()
    os.close(read)
    done = subprocess.run(
        [sys.executable, "-m", "verify", *words], stdout=write, stderr=subprocess.PIPE, text=True, check=False
    )
    os.close(write)
    assert (done.returncode, done.stderr) == (141, "")


@pytest.mark.parametrize(
    "words",
    [("table", "paper", "--counts", "30,40"), ("plan", "steel-cantilever"), ("choose", "--mode", "3", "--error", "1%")],
    ids=" ".join,
)
def test_a_terminal_that_knows_ascii_alone_is_written_to(words):
    done = subprocess.run(
        [sys.executable, "-m", "verify", *words],
        capture_output=True,
        check=False,
        env=os.environ | {"PYTHONIOENCODING": "ascii", "PYTHONUTF8": "0"},
    )
    assert (done.returncode, done.stderr) == (0, b"")
    assert done.stdout.isascii()


def test_a_spectrum_that_does_not_fit_into_memory_is_refused_not_left_empty(verify, tmp_path):
    status, out, err = verify("run", "paper", "--set", "spectrum.count=10000000000000")
    assert (status, out) == (2, "")
    assert "GiB" in err
    assert not list(tmp_path.rglob("*.html"))


def test_the_module_runs_as_a_program():
    done = subprocess.run([sys.executable, "-m", "verify", "--version"], capture_output=True, text=True, check=True)
    assert done.stdout.startswith("verify, version ")


def test_segments_and_count_are_one_argument_everywhere(verify):
    by_count = verify("measure", "mode.frequency", "model=segment", "mode=5", "count=37", "--json")
    assert by_count == verify("measure", "mode.frequency", "model=segment", "mode=5", "segments=37", "--json")
    status, _, err = verify("measure", "mode.frequency", "model=segment", "mode=5", "segments=37", "count=9")
    assert status == 2
    assert "mean the same" in err


@pytest.mark.parametrize(
    "words", [("run", "paper"), ("stress", "tip-mass"), ("measure", "paper", "beam.mass"), ("catalogue", "paper")]
)
def test_a_patience_that_is_none_is_refused_before_anything_is_done(verify, tmp_path, monkeypatch, words):
    monkeypatch.setenv("VERIFY_PATIENCE", "abc")
    status, out, err = verify(*words)
    assert (status, out) == (2, "")
    assert err == "verify: VERIFY_PATIENCE = 'abc': give seconds above 0 in the environment, or leave it unset\n"
    assert not list(tmp_path.iterdir())


def test_a_terminal_without_a_width_is_taken_for_one_of_eighty(verify, monkeypatch):
    monkeypatch.setenv("COLUMNS", "0")
    _, out, _ = verify("run", "paper", "--no-report")
    assert "all 25 gates passed" in out
    assert max(map(len, out.splitlines())) <= 80


def test_a_path_that_is_no_utf_8_is_run_and_kept(verify, tmp_path):
    verify("init", "mine.toml")
    name = os.fsdecode(b"b\xff.toml")
    (tmp_path / name).write_bytes((tmp_path / "mine.toml").read_bytes())
    status, _, err = verify("run", name)
    assert (status, err) == (0, "")
    (page,) = (tmp_path / "reports").glob("*.html")
    assert "udcff" in page.read_text(encoding="utf-8")


@pytest.mark.parametrize("name", ["index", "stress-table"])
def test_no_report_of_a_scene_takes_the_place_of_a_page_that_others_have(verify, tmp_path, name):
    verify("init", "mine.toml")
    text = (tmp_path / "mine.toml").read_text()
    (tmp_path / "mine.toml").write_text(re.sub(r'^name = ".*?"', f'name = "{name}"', text, flags=re.MULTILINE))
    status, _, err = verify("run", "mine.toml")
    assert status == 2
    assert f"name = '{name}': its report would take the place of the page of " in err
    assert not (tmp_path / "reports").exists()
    assert verify("run", "mine.toml", "--no-report")[0] == 0


@pytest.mark.parametrize(
    "words",
    [
        ("export", "mine.toml", "--what", "modes", "--format", "vtu", "--to", "mine.toml"),
        ("export", "mine.toml", "--what", "tables", "--format", "json", "--to", "other.toml"),
        ("schema", "--to", "mine.toml"),
    ],
)
def test_what_is_no_scene_takes_the_place_of_none(verify, tmp_path, words):
    verify("init", "mine.toml")
    before = (tmp_path / "mine.toml").read_text()
    status, _, err = verify(*words)
    assert status == 2
    assert "ends in .toml, as scenes do, and this is none" in err
    assert (tmp_path / "mine.toml").read_text() == before
    assert not (tmp_path / "other.toml").exists()


def test_what_is_swept_is_not_given_too(verify):
    status, _, err = verify("table", "paper", "--sweep", "frequency_hz=4000:4600:3", "frequency_hz=9999")
    assert (status, err) == (2, "verify: frequency_hz = 9999: is swept, give it once, to --sweep\n")


def test_one_mistake_in_a_scene_with_claims_is_one_sentence(verify):
    status, _, err = verify("plan", "paper-slider", "--set", "slider.mu=-1")
    assert status == 2
    assert err.count("\n") == 1
    assert err.startswith("verify: slider.mu = -1")


def test_a_plan_says_whose_sizes_are_looked_through(verify):
    _, out, _ = verify("plan", "taut-strip")
    assert "more sizes, looked through one after another, for gate series-count" in " ".join(out.split())
    planned = json.loads(verify("plan", "taut-strip", "--json")[1])
    assert planned["searched"] == ["gate series-count", "gate tensioned-count"]
    assert json.loads(verify("plan", "driven-cantilever", "--json")[1])["searched"] == []


def test_modes_that_ask_for_few_parts_are_not_solved_for(verify):
    """Of sixty modes the last asks for most; with a thousand even those near it would take too long."""
    status, out, _ = verify("choose", "--mode", "1-60", "--error", "1%", "--json")
    single = verify("choose", "--mode", "60", "--error", "1%", "--json")[1]
    assert status == 0
    several, one = (json.loads(text)["choices"] for text in (out, single))
    assert [(each["model"], each["count"], each["mode"]) for each in several] == [
        (each["model"], each["count"], 60) for each in one
    ]
    status, _, err = verify("choose", "--mode", "1-1000", "--error", "1%")
    assert status == 2
    assert re.match(r"verify: mode = 1000 would take about \d+ (s|minutes), more than the 20 s", err)


def test_a_copy_is_renamed_where_its_name_stands_and_its_next_command_can_be_typed(verify, tmp_path):
    """A title of several lines may hold one that looks like it."""
    given = (tmp_path / "told.toml", verify("show", "steel-cantilever")[1])
    given[0].write_text(
        'title = """\nname = "inner"\n"""\n' + re.sub(r"^title = .*$", "", given[1], flags=re.MULTILINE)
    )
    status, out, _ = verify("init", "my beam.toml", "--from", "told.toml")
    assert status == 0
    assert out == "wrote my beam.toml; next: verify run 'my beam.toml'\n"
    written = tomllib.loads((tmp_path / "my beam.toml").read_text())
    assert (written["name"], written["title"]) == ("my-beam", 'name = "inner"\n')
