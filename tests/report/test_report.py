"""The report: one file, offline, drawn in a real browser."""

import json
import re
import shutil
import subprocess

import pytest

from verify import run_scene
from verify.report.html import environment, page, write_report

CHROMIUM = shutil.which("chromium") or shutil.which("chromium-browser") or shutil.which("google-chrome")
QUIET = [
    "--headless",
    "--no-sandbox",
    "--disable-gpu",
    "--disable-quic",
    "--no-first-run",
    "--disable-sync",
    "--disable-background-networking",
    "--disable-component-update",
]


@pytest.fixture(scope="module")
def result():
    return run_scene("paper")


@pytest.fixture(scope="module")
def html(result):
    return page(result, "verify run paper")


def without_plotly(html):
    return re.sub(r"<script>/\*\*.*?</script>", "", html, flags=re.DOTALL)


def test_the_verdict_stands_before_the_gates_and_the_gates_before_the_figures(html):
    body = html[html.index("<body>") :]
    marks = [body.index(text) for text in ("Passed: all 24 gates", "<h2>Gates", ">Figures<", "How this was made")]
    assert marks == sorted(marks)


def test_every_gate_is_a_row_with_its_figures_and_its_reason(html, result):
    from markupsafe import escape

    for gate in result.gates:
        assert f"<b>{gate.id}</b>" in html.replace("<wbr>", "")
        assert str(escape(gate.expected)) in html
        assert str(escape(gate.why)) in html


def test_the_page_asks_no_network_and_shows_no_path_of_this_machine(html, tmp_path):
    ours = without_plotly(html)
    assert not re.search(r"(src|href)=\"(?!data:)", ours)
    assert "http" not in ours
    assert str(tmp_path.parts[1]) + "/" not in ours


def test_the_figures_are_plain_data(html):
    figures = json.loads(re.search(r'id="figures">(.*?)</script>', html, re.DOTALL)[1])
    assert set(figures) == {"mode-errors", "model-form", "convergence", "bracket", "work-precision", "sensitivity"}
    segments = figures["mode-errors"]["data"][0]
    assert segments["x"][-1] == 22
    assert segments["y"][-1] == pytest.approx(-0.428024, abs=1e-6)
    timoshenko = next(t for t in figures["model-form"]["data"] if t["name"] == "Timoshenko")
    assert timoshenko["y"][-1] == pytest.approx(0.3317, abs=1e-4)


def test_a_title_cannot_break_out_of_the_page(result):
    from msgspec.structs import replace

    hostile = replace(result, scene=replace(result.scene, title="</script><script>alert(1)</script>"))
    assert "<script>alert" not in page(hostile, "verify run x")


def test_a_scene_without_studies_or_gates_still_has_a_page(result):
    from msgspec.structs import replace

    bare = replace(result, gates=(), found={})
    text = page(bare, "verify run x")
    assert "No gates" in text
    assert "Plotly" not in text


def test_the_environment_names_versions():
    assert {"Python", "numpy", "scipy", "scikit-fem", "processors"} <= set(environment())


@pytest.fixture(scope="module")
def wave_result():
    return run_scene("paper-wave")


@pytest.fixture(scope="module")
def wave_html(wave_result):
    return page(wave_result, "verify run paper-wave")


def test_the_report_of_a_wave_shows_envelopes_ellipses_map_and_the_motor_over_sizes(wave_html):
    figures = json.loads(re.search(r'id="figures">(.*?)</script>', wave_html, re.DOTALL)[1])
    assert set(figures) == {"wave-envelopes", "wave-ellipses", "wave-map", "wave-sizes"}
    assert [trace["name"] for trace in figures["wave-envelopes"]["data"]] == [
        "exact beam",
        "segments",
        "Hermite elements",
    ]
    heat = figures["wave-map"]["data"][0]
    assert (len(heat["z"]), len(heat["z"][0])) == (91, 121)
    assert "magnified" in wave_html
    assert "The motor over sizes" in wave_html
    assert "Where to drive" in wave_html


def wave_map(study):
    """The map's chart: (caption, axis of phases, its traces)."""
    from verify.studies.wave_charts import wave_charts

    found = next(chart for chart in wave_charts(study) if chart.id == "wave-map")
    return found.caption, found.layout["yaxis"], found.data


def small_study(*overrides):
    from verify import load_scene
    from verify.judge.workbench import Workbench
    from verify.studies.wave_figures import wave_study

    scene = load_scene(
        "paper-wave", ("wave.counts=[49]", "wave.frequency_hz=4200,4300,11", "wave.phase_deg=0,180,13", *overrides)
    )
    return wave_study(scene, Workbench(scene.beam), scene.wave)


@pytest.mark.parametrize(
    ("overrides", "pure"),
    [
        ((), True),
        (("drive.kind=displacement",), False),
        (("drive.force.1.amplitude=0.7",), False),
        (("drive.force.1.position=0.02",), False),
        (("beam.supports=clamped,clamped",), False),
    ],
)
def test_the_map_speaks_of_a_pure_phase_only_where_there_is_one(overrides, pure):
    caption = wave_map(small_study(*overrides))[0]
    assert ("pure along phase = -kL" in caption) is pure
    assert "with loss factor 0.001, as the operating points" in caption


def test_the_operating_points_lie_on_the_map_they_are_drawn_on():
    """Same model, same damping, same phase axis: the point's reflection is the map's at that place."""
    study = small_study(
        "drive.force.0.phase_deg=30",
        "drive.force.1.phase_deg=120",
        "wave.phase_deg=60,210,61",
        "wave.frequency_hz=4240,4260,81",
        "wave.quantity=wave.reflection",
    )
    _, axis, (heat, *points) = wave_map(study)
    assert "relative to the first" in axis["title"]["text"]
    quiet = points[0]
    assert quiet["y"] == [pytest.approx(90.0)]
    row, column = (
        min(range(len(v)), key=lambda i: abs(v[i] - at[0]))
        for v, at in ((heat["y"], quiet["y"]), (heat["x"], quiet["x"]))
    )
    assert heat["z"][row][column] == pytest.approx(study.points[0].reflection, abs=5e-4)
    assert heat["z"][row][column] == min(heat["z"][row])


def test_what_is_missing_in_a_wave_report_is_said(wave_result):
    """A drive in phase has no best frequency; a coarse chain's lies beyond the search."""
    from msgspec.structs import replace

    study = small_study("drive.force.1.phase_deg=0", "wave.phase_deg=0,0.5,3")
    text = page(replace(wave_result, gates=(), found={"wave": study}), "verify run x")
    assert "the wave stands at every frequency" in text
    study = small_study("wave.counts=[30]", "wave.count=30")
    assert "at the edge of the search" in page(replace(wave_result, gates=(), found={"wave": study}), "verify run x")


@pytest.fixture(scope="module")
def chain_result():
    return run_scene("chain")


def test_the_report_of_a_chain_shows_all_models_side_by_side_and_departures_over_the_force(chain_result):
    text = page(chain_result, "verify run chain")
    figures = json.loads(re.search(r'id="figures">(.*?)</script>', text, re.DOTALL)[1])
    assert set(figures) == {"axial-models", "axial-departures"}
    lines = {trace["name"]: trace for trace in figures["axial-models"]["data"]}
    assert {"exact field", "Hermite elements", "linear chain", "chain of rigid links"} < set(lines)
    assert lines["chain of rigid links"]["y"][-1] == pytest.approx(-8.692475933, abs=1e-6)
    assert lines["linear chain"]["y"][-1] == pytest.approx(-8.2345302521, abs=1e-6)
    rigid, *_, scale = figures["axial-departures"]["data"]
    assert rigid["x"] == scale["x"] == [0.1, 1.0, 10.0, 30.0]
    assert rigid["y"][2] == pytest.approx(3.896397e-2, rel=1e-4)
    for words in (
        "How linear the chain of rigid links is",
        "3.90e-02",
        "3.93e-06",
        "7.86e-03",
        "side by side",
        "links that stretch by EA/l",
        ">linear</td>",
        ">nonlinear</td>",
    ):
        assert words in text, words


@pytest.mark.skipif(CHROMIUM is None, reason="no Chromium on this machine: the report was not opened in a browser")
@pytest.mark.parametrize(("name", "charts", "traces"), [("paper", 6, 6), ("paper-wave", 4, 3), ("chain", 2, 2)])
def test_a_real_browser_draws_every_chart(request, tmp_path, name, charts, traces):
    """Every chart, and a scatter layer in those that are not maps alone."""
    path = tmp_path / "report.html"
    result = request.getfixturevalue({"paper": "result", "paper-wave": "wave_result", "chain": "chain_result"}[name])
    write_report(result, path, f"verify run {name}")
    profile = f"--user-data-dir={tmp_path / 'profile'}"
    done = subprocess.run(
        [CHROMIUM, *QUIET, profile, "--virtual-time-budget=20000", "--dump-dom", path.as_uri()],
        capture_output=True,
        text=True,
        timeout=180,
        check=True,
    )
    assert f'data-drawn="{charts}"' in done.stdout
    assert done.stdout.count('class="main-svg"') >= charts
    assert done.stdout.count("scatterlayer") >= traces
    assert ("heatmaplayer" in done.stdout) or name != "paper-wave"


def test_the_report_says_where_the_mean_of_both_is_farther_off_than_elements(titanium_strip):
    from verify.judge.workbench import Workbench
    from verify.studies.convergence import Convergence
    from verify.studies.convergence_figures import convergence
    from verify.studies.mode_charts import mean_in_words

    bench = Workbench(titanium_strip)
    low = convergence(bench, Convergence(modes=(3, 7), counts=(12, 24)))
    assert mean_in_words(low).endswith("always nearer than elements alone.")
    high = convergence(bench, Convergence(modes=(3, 9), counts=(12, 13, 24)))
    assert mean_in_words(high).endswith("beyond about n = 0.7 N: mode 9 at N = 12.")
