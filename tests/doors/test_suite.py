"""Several scenes in one command: each judged as if it were alone, none stopped by another, one page over all."""

import json
import os
import re
import signal
import sys
from html.parser import HTMLParser

import pytest

from verify.cli import status_of
from verify.scenes.scene import packaged_scenes

BEAM = "beam = { length = 0.61, width = 0.03, thickness = 0.002, youngs_modulus = 71e9, density = 2710.0 }\n"
GATE = """
[[gate]]
id = "second"
quantity = "mode.frequency"
arguments = { model = "analytic", mode = 2 }
expect = EXPECT
within = 1e-3
why = "2 pi sqrt(E h^2 / 12 rho) / L^2."
"""
SCENES = {
    "held.toml": 'name = "held"\ntitle = "A strip <b>"\n' + BEAM + GATE.replace("EXPECT", "49.90041"),
    "drawn.toml": 'name = "drawn"\nspectrum = { modes = 3, count = 9 }\n' + BEAM + GATE.replace("EXPECT", "49.9008"),
    "fails.toml": 'name = "fails"\n' + BEAM + GATE.replace("EXPECT", "50.5"),
    "wrong.toml": 'name = "wrong"\n' + BEAM.replace("0.61", "-0.61"),
    "same.toml": 'name = "HELD"\n' + BEAM,
    "index.toml": 'name = "index"\n' + BEAM,
}


@pytest.fixture(params=["1", pytest.param("3", marks=pytest.mark.skipif(sys.platform != "linux", reason="forks"))])
def verify(request, capsys, tmp_path, monkeypatch):
    """Run a command line in a folder with small scenes, by one process and by three: (status, output, errors)."""
    monkeypatch.setenv("VERIFY_JOBS", request.param)
    monkeypatch.chdir(tmp_path)
    for name, text in SCENES.items():
        (tmp_path / name).write_text(text)

    def call(*words):
        capsys.readouterr()
        return (status_of(list(words)), *capsys.readouterr())

    return call


class Links(HTMLParser):
    """Names and links of a page."""

    def __init__(self, text):
        super().__init__()
        self.ids, self.hrefs, self.ends = [], [], 0
        self.feed(text)

    def handle_starttag(self, tag, attrs):
        """Of every element."""
        found = dict(attrs)
        self.ids += [found["id"]] if "id" in found else []
        self.hrefs += [found["href"]] if tag == "a" else []


def test_every_scene_is_a_card_with_its_verdict_answer_picture_and_link(verify, tmp_path):
    status, out, err = verify("run", "held.toml", "drawn.toml")
    page = (tmp_path / "reports" / "index.html").read_text("utf-8")
    assert (status, err) == (0, "")
    assert re.search(r"All 2 gates passed: 2 scenes in \d", out)
    assert "<strong>All 2 gates passed: 2 scenes in" in page
    assert page.count("1 gate passed") == 2
    assert page.count("<svg") == 2
    assert "A strip &lt;b&gt;" in page
    assert "At mode 3, against exact Euler-Bernoulli, 9 segments are" in page
    assert page.index('id="scene-held"') < page.index('id="scene-drawn"')
    assert "<code>verify run held.toml drawn.toml</code>" in page
    assert page.rstrip().endswith("</html>")


def test_every_link_of_the_page_leads_somewhere_and_no_name_stands_twice(verify, tmp_path):
    verify("run", "held.toml", "drawn.toml", "fails.toml")
    links = Links((tmp_path / "reports" / "index.html").read_text("utf-8"))
    assert len(set(links.ids)) == len(links.ids)
    assert {href.partition("#")[0] for href in links.hrefs} == {"held.html", "drawn.html", "fails.html"}
    assert "fails.html#gate-second" in links.hrefs
    for href in links.hrefs:
        file, _, name = href.partition("#")
        assert not name or name in Links((tmp_path / "reports" / file).read_text("utf-8")).ids


def test_a_gate_that_fails_is_told_with_its_scene_and_is_the_status(verify, tmp_path):
    status, out, _ = verify("run", "held.toml", "fails.toml")
    page = (tmp_path / "reports" / "index.html").read_text("utf-8")
    assert status == 1
    assert "fails: gate second: measured 49.9004" in out
    assert "1 of 2 gates failed: 2 scenes in" in out
    assert '<div class="verdict failed"' in page
    assert 'href="fails.html#gate-second"' in page


def test_a_scene_that_cannot_run_is_a_row_with_its_sentence_and_stops_none(verify, tmp_path):
    status, out, err = verify("run", "nonsense", "held.toml", "wrong.toml", "fails.toml")
    page = (tmp_path / "reports" / "index.html").read_text("utf-8")
    assert status == 2
    assert "1 of 2 gates failed, 2 scenes could not run: 2 scenes in" in out
    assert re.fullmatch(
        "verify: nonsense: scene = 'nonsense' is neither a packaged scene nor a file: .*\n"
        "verify: wrong.toml: beam.length = -0.61.*\n",
        err,
    )
    assert page.count('<p class="fail">could not run</p>') == 2
    assert sorted(path.name for path in (tmp_path / "reports").glob("*.html")) == [
        "fails.html",
        "held.html",
        "index.html",
    ]


def test_a_name_that_is_taken_is_not_run_over_another(verify, tmp_path):
    """Nor where names differ in their case alone, which some file systems do not see."""
    status, out, err = verify("run", "held.toml", "same.toml", "index.toml", "held.toml")
    assert status == 2
    assert "same.toml: name = 'HELD': its report would take the place of that of held.toml" in err
    assert "index.toml: name = 'index': its report would take the place of the page of all scenes" in err
    assert "All 1 gates passed, 2 scenes could not run: 1 scene in" in out


def test_where_no_scene_can_run_all_is_refused_and_nothing_written(verify, tmp_path):
    status, out, err = verify("run", "wrong.toml", "nonsense", "--json")
    assert (status, out) == (2, "")
    assert [line.split(":")[1].strip() for line in err.splitlines()] == ["wrong.toml", "nonsense"]
    assert not list(tmp_path.rglob("*.html"))


def test_as_json_every_scene_says_what_it_says_alone(verify):
    alone = json.loads(verify("run", "fails.toml", "--json", "--no-report")[1])
    status, out, err = verify("run", "held.toml", "nonsense", "fails.toml", "--json", "--no-report")
    data = json.loads(out)
    assert (status, err.count("verify: ")) == (2, 1)
    assert [data["passed"], data["report"], len(data["scenes"])] == [False, None, 3]
    assert [scene["passed"] for scene in data["scenes"]] == [True, False, False]
    assert data["scenes"][1]["error"][0].startswith("scene = 'nonsense' is neither")
    for timed in (alone, *alone["gates"], data["scenes"][2], *data["scenes"][2]["gates"]):
        timed["seconds"] = 0.0
    assert data["scenes"][2] == alone


def test_overrides_are_those_of_every_scene_and_of_their_names(verify, tmp_path):
    status, _, _ = verify("run", "held.toml", "drawn.toml", "--set", "beam.length=0.4")
    assert status == 0
    names = sorted(path.name for path in (tmp_path / "reports").glob("*.html"))
    assert names == ["drawn--beam.length=0.4.html", "held--beam.length=0.4.html", "index.html"]
    page = (tmp_path / "reports" / "index.html").read_text("utf-8")
    assert page.count("1 not applicable") == 2
    assert 'href="drawn--beam.length=0.4.html"' in page


def test_runs_of_several_are_kept_as_those_of_one(verify, tmp_path):
    for _ in range(3):
        assert verify("run", "held.toml", "drawn.toml", "--keep", "2")[0] == 0
    for name in ("held", "drawn"):
        assert len(list((tmp_path / "reports" / name).iterdir())) == 2
    page, alone = (tmp_path / "reports" / "held.html").read_text("utf-8"), os.environ["VERIFY_JOBS"] == "1"
    assert ("up to 2: run times here are of a machine that did other things too" in page) is not alone
    assert verify("diff", "reports/held", "reports")[0] == 0
    assert not list((tmp_path / "reports").rglob(".*"))


def test_a_process_that_is_killed_is_a_row(verify, tmp_path, monkeypatch):
    if os.environ["VERIFY_JOBS"] == "1":
        pytest.skip("it would be this one")
    from verify.run import runner

    true = runner.run_scene

    def killed(scene, *others):
        if scene.name == "fails":
            os.kill(os.getpid(), signal.SIGKILL)
        return true(scene, *others)

    monkeypatch.setattr(runner, "run_scene", killed)
    status, out, err = verify("run", "held.toml", "fails.toml", "drawn.toml")
    assert status == 2
    assert "fails: its process ended before it was done (signal 9)" in err
    assert "All 2 gates passed, 1 scene could not run" in out


def test_a_fault_of_the_suites_own_is_a_row(verify, monkeypatch):
    from verify.run import runner

    true = runner.run_scene
    monkeypatch.setattr(runner, "run_scene", lambda scene, *others: 1 / 0 if scene.name == "held" else true(scene, *others))  # fmt: skip
    status, out, err = verify("run", "held.toml", "drawn.toml", "--no-report")
    assert status == 2
    assert "held: the suite itself fails on it (ZeroDivisionError: division by zero), `verify run held.toml`" in err
    assert "All 1 gates passed, 1 scene could not run" in out


def test_without_a_name_all_packaged_scenes_are_asked_for(verify, monkeypatch):
    """And the one with most to do is begun first."""
    from verify import apart

    begun = []
    monkeypatch.setattr(apart, "each_apart", lambda work, items, hear: begun.extend(items) or [apart.Died(1) for _ in items])  # fmt: skip
    assert verify("run", "--no-report")[0] == 2
    assert sorted(one.name for one in begun) == sorted(packaged_scenes())
    assert begun[0].name == "stress"
    assert [one.steps for one in begun] == sorted((one.steps for one in begun), reverse=True)


def test_a_folder_that_takes_nothing_is_refused_before_anything_is_run(verify, tmp_path):
    assert verify("run", "held.toml", "drawn.toml", "--reports", "held.toml/in")[:2] == (2, "")
    assert (tmp_path / "held.toml").read_text() == SCENES["held.toml"]


def test_without_a_report_nothing_is_written_and_nothing_is_drawn(verify, tmp_path, monkeypatch):
    from verify.report import drawing

    monkeypatch.setattr(drawing, "drawn", lambda chart: 1 / 0)
    assert verify("run", "held.toml", "drawn.toml", "--no-report")[0] == 0
    assert sorted(path.name for path in tmp_path.iterdir()) == sorted(SCENES)
