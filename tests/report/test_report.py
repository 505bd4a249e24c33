"""Kept runs, drawings, charts, results as text and data, the terminal."""

import csv
import json
import re
from datetime import UTC, datetime, timedelta
from io import BytesIO, StringIO
from xml.etree import ElementTree

import msgspec
import numpy as np
import pytest
from PIL import Image
from rich.console import Console

from verify.analysis.verdict import void
from verify.errors import InputError
from verify.report import archive
from verify.report.archive import compare_runs, read_runs, save_run, saved_in
from verify.report.beam_drawing import NARROW, WIDTH, beam_figure
from verify.report.page import run_page
from verify.report.plotting import MODEL_COLORS, drawn, figure_files, movie_image
from verify.report.result import Column, Figure, Result, Table, to_json
from verify.report.summary import print_run, run_data
from verify.scene.load import scene_from
from verify.scene.model import Scene

# --- Archive ---


@pytest.fixture(scope="module")
def bare_run(small_run):
    return msgspec.structs.replace(small_run, results={})


@pytest.fixture
def clock(monkeypatch):
    """Every look at the clock is a second later."""

    class Clock(datetime):
        seconds = 0

        @classmethod
        def now(cls, tz=None):
            cls.seconds += 1
            return datetime(2031, 5, 7, 11, 13, 17, tzinfo=UTC) + timedelta(seconds=cls.seconds)

    monkeypatch.setattr(archive, "datetime", Clock)


def test_newest_runs_are_kept(bare_run, tmp_path, clock):
    folders = [save_run(bare_run, tmp_path, "small", keep=2).folder for _ in range(3)]
    assert saved_in(tmp_path / "small") == folders[1:]
    assert sorted(one.name for one in folders[2].iterdir()) == ["index.html", "run.json"]
    assert (tmp_path / "small.html").read_bytes() == (folders[2] / "index.html").read_bytes()
    assert [one.name for one in tmp_path.iterdir() if one.name.startswith(".")] == []


def test_without_keeping_one_page(bare_run, tmp_path):
    saved = save_run(bare_run, tmp_path, "small", keep=0)
    assert saved.folder is None
    assert [one.name for one in tmp_path.iterdir()] == ["small.html"]


def test_failed_write_leaves_nothing(bare_run, tmp_path):
    (tmp_path / "small").write_text("a file")
    with pytest.raises(InputError, match="--keep 0"):
        save_run(bare_run, tmp_path, "small")
    assert [one.name for one in tmp_path.iterdir()] == ["small"]


def test_runs_are_read_from_every_level(bare_run, tmp_path):
    folder = save_run(bare_run, tmp_path, "small", "verify run small.toml").folder
    for path in (folder / "run.json", folder, tmp_path / "small", tmp_path):
        (run,) = read_runs(path, "A").values()
        assert run["command"] == "verify run small.toml"
        assert run["gates"][0]["value"] == bare_run.gates[0].value


@pytest.mark.parametrize("text", ["{}", "[]", "no json", '{"gates": []}'])
def test_other_json_is_refused(tmp_path, text):
    (tmp_path / "run.json").write_text(text)
    with pytest.raises(InputError, match="no saved run"):
        read_runs(tmp_path / "run.json", "A")


def data_of(run):
    return {"small": json.loads(json.dumps(run_data(run) | {"report": "small"}))}


def test_missing_gate_is_broken(small_run):
    after = data_of(small_run)
    del after["small"]["gates"][0]
    assert compare_runs(data_of(small_run), after).data["broken"] == ["small: third-frequency"]


def test_changed_level_is_listed(small_run, full_run):
    (table, *_) = compare_runs(data_of(small_run), data_of(full_run)).tables
    assert table.records() == [
        {"report": "small", "level": "trusted → not trusted", "headline now": full_run.verdict.headline}
    ]


def test_changed_input_is_named(small_run):
    after = data_of(small_run)
    after["small"]["inputs"]["beam"]["length"] = 0.41
    after["small"]["gates"][0]["value"] *= 1.05
    result = compare_runs(data_of(small_run), after)
    gates, inputs = (table.records() for table in result.tables)
    assert inputs == [{"report": "small", "key": "beam.length", "before": "0.37", "after": "0.41"}]
    assert abs(abs(gates[0]["change"]) - 0.05) < 1e-12
    assert result.data["broken"] == []


# --- Drawing ---

SECTION = {"width": 0.017, "thickness": 0.0023, "youngs_modulus": 71e9, "density": 2710.0}


def texts(scene, width=WIDTH):
    return re.findall(r"<text[^>]*>([^<]*)</text>", figure_files(beam_figure(scene, width), 0.0)[0])


def scene_of(**tables) -> Scene:
    beam = {"length": 0.61, **SECTION, "supports": ["free", "guided"]} | tables.pop("beam", {})
    return scene_from({"name": "drawn", "beam": beam, **tables})


@pytest.mark.parametrize("width", [WIDTH, NARROW])
def test_everything_is_named(width):
    scene = scene_of(
        beam={
            "tension": 43.0,
            "foundation": 310.0,
            "mass": [{"position": 0.1, "mass": 0.021, "rotary_inertia": 3e-6}],
            "spring": [{"position": 0.3, "stiffness": 1700.0, "rotational": 2.5}],
        },
        drive={
            "frequency_hz": 137.0,
            "force": [{"position": 0.1, "amplitude": 1.3, "phase_deg": 29.0}],
            "device": [{"position": 0.5, "dashpot": 0.7}],
        },
        slider={"mass": 0.0031, "mu": 0.23, "position": 0.42},
    )
    words = " ".join(texts(scene, width))
    beam = (
        "free",
        "guided",
        "0.021 kg",
        "3e-06 kg m²",
        "1700 N/m",
        "2.5 N m/rad",
        "43 N",
        "310 N/m²",
        "17 mm × 2.3 mm",
    )
    loads = ("x = 100 mm", "1.3 N, 29°", "137 Hz", "0.7 N s/m", "slider 3.1 g, μ = 0.23")
    assert [part for part in beam + loads if part not in words] == []


@pytest.mark.parametrize("width", [WIDTH, NARROW])
def test_text_does_not_overlap(width):
    forces = [{"position": 0.2 + 0.004 * i, "amplitude": 1.0 + i} for i in range(5)]
    svg = figure_files(beam_figure(scene_of(drive={"frequency_hz": 90.0, "force": forces}), width), 0.0)[0]
    places = [(float(x), float(y)) for x, y in re.findall(r'<text [^>]*?x="([\d.]+)" y="([\d.]+)"', svg)]
    assert len(places) == len(set(places)) >= 10
    for i, (x, y) in enumerate(places):
        assert all(abs(x - u) > 15.0 or abs(y - v) > 8.0 for u, v in places[:i])


# --- Plotting ---


def test_svg_follows_the_page(figures):
    svg = figure_files(figures[0], 0.0)[0]
    root = ElementTree.fromstring(svg)
    assert root.get("role") == "img"
    assert root.get("aria-label") == "Error over N. Solid: segments."
    assert "currentColor" in svg
    assert "#010203" not in svg
    assert "<style" not in svg
    ids = re.findall(r'\bid="([^"]+)"', svg)
    assert len(ids) == len(set(ids))
    assert all(one.startswith("lines-") for one in ids)


def curves_of(*heights):
    """Axes after a chart of segments and elements that end at these heights."""

    def draw(ax):
        for (model, height), style in zip(zip(("segment", "fem"), heights, strict=True), ("-", "--"), strict=True):
            ax.plot([0.0, 1.0, 3.0], [0.0, 0.7, height], style, color=MODEL_COLORS[model], label=model)
        ax.legend()

    return drawn(Figure("curves", "Two curves", "Over x.", draw)).axes[0]


def test_equal_curves_differ_by_more_than_colour():
    ax = curves_of(2.0, 2.0)
    first, second = ax.lines
    assert first.get_linewidth() > second.get_linewidth() + 1.0
    assert first.get_marker() != second.get_marker()
    assert (first.get_linestyle(), second.get_linestyle()) == ("-", "--")
    assert [text.get_text() for text in ax.get_legend().get_texts()] == ["segment", "fem"]


def test_names_stand_at_the_ends_of_curves():
    ax = curves_of(2.0, 1.1)
    assert ax.get_legend() is None
    assert {text.get_text(): text.xy for text in ax.texts} == {"segment": (3.0, 2.0), "fem": (3.0, 1.1)}


def test_both_files_show_one_chart(figures):
    svg, png = figure_files(figures[2], 80.0)
    assert svg == figure_files(figures[2], 0.0)[0]
    assert Image.open(BytesIO(png)).size == pytest.approx((80 * 5.4, 80 * 3.5), abs=1)


def test_movie_has_every_frame(movie):
    moving, still = (Image.open(BytesIO(image)) for image in movie_image(movie))
    assert moving.n_frames == 5
    assert getattr(still, "n_frames", 1) == 1
    assert still.size == moving.size


# --- Result ---


def test_json_keeps_values(made_result):
    data = json.loads(to_json(made_result.to_dict()))
    first = data["tables"][0]
    assert data["summary"] == made_result.summary
    assert data["z"] == {"re": 1.5, "im": -2.5}
    assert first["rows"][0] == {"mode": 1, "model": "segment", "frequency": 443.25, "error": -0.0021}
    assert first["rows"][2]["frequency"] is None
    assert data["warnings"] == ["Mode 5 is not converged."]


def test_numpy_values_are_json():
    value = {"a": np.arange(3), "b": np.float64(0.5), "c": np.int64(7), "d": (np.inf, -1.0)}
    assert json.loads(to_json(value)) == {"a": [0, 1, 2], "b": 0.5, "c": 7, "d": [None, -1.0]}


def test_csv_is_in_si_units(made_result):
    head, first, second, _ = csv.reader(StringIO(made_result.tables[0].csv()))
    assert head == ["mode", "model", "frequency, Hz", "error"]
    assert float(first[3]) == -0.0021
    assert second[3] == ""


def test_markdown_escapes_bars(made_result):
    lines = made_result.tables[0].markdown().splitlines()
    assert lines[0] == "| mode | model | frequency, Hz | error, % |"
    assert "a\\|b" in lines[4]
    assert lines[2].count("|") == 5


@pytest.mark.parametrize("width", [80, 120])
def test_terminal_tables_fit(width):
    rows = [
        (n, "segments with a long name of the model", *(1.23456789e-5 * n * k for k in range(1, 12))) for n in (1, 2)
    ]
    columns = [Column("N"), Column("model"), *(Column(f"value {k}", "Hz", ".9g") for k in range(1, 12))]
    out = StringIO()
    Table("Wide", columns, rows).print(Console(file=out, width=width))
    text = out.getvalue()
    assert max(map(len, text.splitlines())) <= width
    assert text.count("…") == 0
    assert all(cell in text for row in Table("", columns, rows).text_rows() for cell in row[2:])


# --- Terminal ---


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


def test_worst_and_skipped_gates_are_named(small_run):
    (worst, other) = sorted(small_run.gates, key=lambda gate: gate.fraction, reverse=True)
    assert f"All 2 gates passed, the worst is {worst.id}" in printed(small_run, 200)
    skipped = msgspec.structs.replace(worst, passed=None, fraction=None, reason="stated for other values")
    text = printed(msgspec.structs.replace(small_run, gates=(skipped, other)), 200)
    assert "1 gate passed (1 skipped: --set changes" in text
    assert f"skipped {worst.id}: stated" in text


def test_run_data_is_complete(full_run):
    data = run_data(full_run, "verify run")
    assert [gate["passed"] for gate in data["gates"]] == [True, False]
    assert data["inputs"]["beam"]["length"] == 0.37
    assert set(data["results"]) == {"spectrum", "made"}
    assert "gate" not in data["inputs"]
    assert data["environment"]["numpy"]


def test_a_failed_gate_and_a_stopped_slider_are_never_green(small_run, full_run):
    assert small_run.verdict.level == "trusted"
    assert full_run.verdict.level == "not trusted"
    assert "elements-lie-above" in full_run.verdict.headline
    stopped = Result(margins=[void("the run", "the slider left the beam after 3 ms")])
    run = msgspec.structs.replace(small_run, results={"motion": stopped})
    assert run.verdict.headline == "Not to be trusted: the slider left the beam after 3 ms."
    assert 'class="verdict not-trusted"' in run_page(run)
    assert run_data(run)["verdict"]["level"] == run_data(run)["results"]["motion"]["verdict"]["level"] == "not trusted"
    empty = msgspec.structs.replace(small_run, gates=(), results={})
    assert (empty.verdict.level, printed(empty, 200).count("Not to be trusted")) == ("not trusted", 1)
