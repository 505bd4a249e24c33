"""The page of a run: complete, well formed, without network and scripts, readable in every setting."""

import json
import re
import shutil
import subprocess
import tomllib
from dataclasses import replace
from html import escape, unescape
from html.parser import HTMLParser

import msgspec
import pytest

from verify.analysis.verdict import Margin
from verify.report.page import failed_line, index_result, run_page, scene_line, write_index
from verify.report.result import Column, Table

VOID = {"meta", "link", "img", "source", "br"}


class Parsed(HTMLParser):
    """Open elements, ids, addresses, text of a page; raises where elements do not close in order."""

    def __init__(self, text):
        super().__init__()
        self.open, self.ids, self.addresses, self.tags, self.text = [], [], [], [], ""
        self.feed(text)
        assert self.open == []

    def handle_starttag(self, tag, attrs):
        self.tags.append((tag, dict(attrs)))
        self.ids += [value for name, value in attrs if name == "id"]
        self.addresses += [value for name, value in attrs if name in ("href", "src", "srcset", "xlink:href")]
        if tag not in VOID:
            self.open.append(tag)

    def handle_startendtag(self, tag, attrs):
        self.handle_starttag(tag, attrs)
        if tag not in VOID:
            self.handle_endtag(tag)

    def handle_endtag(self, tag):
        if tag not in VOID:
            assert self.open.pop() == tag

    def handle_data(self, data):
        self.text += data


@pytest.fixture(scope="module")
def html(full_run):
    return run_page(full_run, "verify run small.toml --set beam.length=0.4")


@pytest.fixture(scope="module")
def page(html):
    return Parsed(html)


def test_page_needs_no_network(page):
    assert all(one.startswith(("#", "data:")) for one in page.addresses)
    assert not {tag for tag, _ in page.tags} & {"script", "iframe", "object"}


def test_ids_are_unique_and_linked(page):
    assert len(page.ids) == len(set(page.ids))
    assert {one[1:] for one in page.addresses if one.startswith("#")} <= set(page.ids)


def test_page_has_every_part(full_run, page):
    for result in full_run.results.values():
        assert result.summary in page.text
        for table in result.tables:
            assert table.title in page.text
            assert all(cell in page.text for row in table.text_rows() for cell in row)
    for gate in full_run.gates:
        assert gate.gate.id in page.text
        assert (gate.reason or gate.gate.why) in page.text
    for skipped in full_run.skipped:
        assert skipped.why in page.text
    assert "1 of 2 gates failed" in page.text
    assert "verify run small.toml --set beam.length=0.4" in page.text
    assert "Mode 5 is not converged." in page.text
    assert "A strip <clamped & pinned>" in page.text


def test_inputs_are_values_of_a_scene_file(full_run, html):
    (text,) = re.findall(r"<pre[^>]*><code>(name = .*?)</code>", html, re.DOTALL)
    inputs, beam = tomllib.loads(unescape(text)), full_run.scene.beam
    assert (inputs["beam"]["length"], inputs["beam"]["supports"]) == (beam.length, list(beam.supports))
    assert [force["phase_deg"] for force in inputs["drive"]["force"]] == [31.0, -77.0, 143.0]


def test_figures_have_names_and_downloads(full_run, page):
    figures = [figure for result in full_run.results.values() for figure in result.figures]
    labels = [attrs["aria-label"] for tag, attrs in page.tags if tag == "svg"]
    assert all(f"{figure.title}. {figure.caption}" in labels for figure in figures)
    names = [attrs["download"] for tag, attrs in page.tags if tag == "a" and "download" in attrs]
    assert {"small-made-lines.svg", "small-made-lines.png", "small-beam.png"} <= set(names)
    images = [attrs for tag, attrs in page.tags if tag == "img"]
    assert [image["alt"] for image in images] == ["Moving line. One period."]
    assert any(tag == "source" and "prefers-reduced-motion" in attrs["media"] for tag, attrs in page.tags)


def test_no_sentence_stands_twice(full_run, page):
    results = full_run.results.values()
    sentences = [result.summary for result in results] + [text for result in results for text in result.warnings]
    assert [page.text.count(one) for one in [*sentences, full_run.failed[0].reason]] == [1] * (len(sentences) + 1)


def test_verdict_results_margins_caveats_and_speeds_lead(small_run, made_result):
    sizes = {"plate": 0.031, "shear": 0.025, "links": 0.02, "wave": 0.013, "step": 0.004, "same": 0.0}
    margins = [Margin(name=name, size=size, where="at 5") for name, size in sizes.items()]
    speeds = Table("Speed of the slider", [Column("kinematics"), Column("speed", "m/s")], [("tangential", -0.013)])
    made = replace(made_result, tables=[*made_result.tables, speeds], margins=margins)
    run = msgspec.structs.replace(small_run, results={"made": made}, margins=())
    text = run_page(run)
    also = "also: shear 2.5 % at 5, links 2 % at 5, wave 1.3 % at 5"
    order = (
        run.verdict.headline,
        also,
        "Mode 5 is 1.73 % off.",
        ">links 2 % at 5<",
        "<details class",
        ">wave 1.3 % at 5<",
    )
    order += (">step 0.4 % at 5<", "Mode 5 is not", ">tangential<", "<nav")
    places = [text.index(one) for one in order]
    assert places == sorted(places)
    assert "same" not in text
    assert 'class="verdict conditional"' in text
    assert text.count("tangential") == 1


def test_index_links_to_reports(full_run, small_run, tmp_path):
    from verify.report.archive import Saved

    saved = Saved(tmp_path / "small.html", None)
    lines = [scene_line(small_run, "good", saved), scene_line(full_run, "bad", None), failed_line("lost", ["no beam"])]
    write_index(lines, tmp_path / "index.html", "verify run", 1.5)
    page = Parsed((tmp_path / "index.html").read_text("utf-8"))
    assert "small.html" in page.addresses
    assert "2 of 3 scenes failed. Verdicts: 1 cannot run, 1 not trusted, 1 trusted." in page.text
    assert "no beam" in page.text
    assert [row[1] for row in index_result(lines).tables[0].rows] == ["lost", "bad", "good"]
    assert json.dumps(lines)


@pytest.mark.parametrize(("passed", "gates", "colour"), [(True, [3, 3], "gates-passed"), (True, [0, 0], "not-trusted"),
                                                         (False, [2, 3], "not-trusted")])  # fmt: skip
def test_banner_of_the_index_is_that_of_the_gates(small_run, tmp_path, passed, gates, colour):
    line = scene_line(small_run, "lifts-off", None) | {"level": "not trusted", "passed": passed, "gates": gates}
    write_index([scene_line(small_run, "good", None), line], tmp_path / "index.html", "verify run", 1.5)
    assert f'class="verdict {colour}"' in (tmp_path / "index.html").read_text("utf-8")


MEASURE = """<script>onload = () => { const f = document.getElementById("f"), d = f.contentDocument, s = getComputedStyle;
const seen = ["body", ".soft", "td", "a", ".verdict strong"].map(q => { let e = d.querySelector(q), c = s(e).color, b;
  for (b = e; b && ["rgba(0, 0, 0, 0)", "transparent"].includes(s(b).backgroundColor); b = b.parentElement);
  return [c, s(b || d.body).backgroundColor]; });
const boxes = [...d.querySelectorAll(".drawing text")].map(e => e.getBoundingClientRect()).filter(b => b.height);
document.title = JSON.stringify({ wide: d.documentElement.scrollWidth, colours: seen, labels: boxes.length,
  right: Math.max(...boxes.map(b => b.right)), letter: Math.min(...boxes.map(b => b.height)) }); }</script>"""


@pytest.mark.skipif(not shutil.which("chromium"), reason="no chromium")
@pytest.mark.parametrize(("dark", "width"), [(False, 1200), (True, 1200), (False, 360), (True, 360)])
def test_browser_shows_it(html, tmp_path, dark, width):
    frame = (
        f'<iframe id="f" width="{width}" height="900" style="border:0" srcdoc="{escape(html, quote=True)}"></iframe>'
    )
    (tmp_path / "frame.html").write_text(f"<!doctype html>{frame}{MEASURE}", "utf-8")
    settings = ["--headless", "--no-sandbox", "--disable-gpu", "--enable-logging=stderr", "--virtual-time-budget=5000"]
    scheme = f"--blink-settings=preferredColorScheme={0 if dark else 1}"
    command = ["chromium", *settings, scheme, f"--user-data-dir={tmp_path / 'profile'}", "--dump-dom"]
    done = subprocess.run(
        [*command, (tmp_path / "frame.html").as_uri()], capture_output=True, text=True, timeout=200, check=True
    )
    seen = json.loads(re.search(r"<title>(.*?)</title>", done.stdout)[1])
    assert "CONSOLE" not in done.stderr
    assert seen["wide"] <= width
    assert seen["right"] <= width
    assert seen["letter"] >= 9.0  # pixels
    assert seen["labels"] == 10  # once, and none is left out: 3 forces of two lines, drive, section, two ends

    def luminance(colour):
        parts = [float(p) / 255.0 for p in re.findall(r"[\d.]+", colour)[:3]]
        linear = [p / 12.92 if p <= 0.04045 else ((p + 0.055) / 1.055) ** 2.4 for p in parts]
        return 0.2126 * linear[0] + 0.7152 * linear[1] + 0.0722 * linear[2]

    for ink, paper in seen["colours"]:
        a, b = luminance(ink), luminance(paper)
        assert (a > b) == dark
        assert (max(a, b) + 0.05) / (min(a, b) + 0.05) >= 4.5
