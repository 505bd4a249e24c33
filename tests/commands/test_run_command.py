"""`verify run` and `verify diff`: gates, reports, exit status, streams."""

import json
import os
import subprocess
import sys
from pathlib import Path

import pytest
from test_commands import BARE

from verify.cli import status_of

pytestmark = pytest.mark.usefixtures("here")
VERIFY = [sys.executable, "-m", "verify"]


@pytest.fixture
def here(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "bare.toml").write_text(BARE)
    (tmp_path / "off.toml").write_text(BARE.replace('"bare"', '"off"').replace("28.7860404", "28.8"))


def test_run_writes_page_and_data(capsys):
    assert status_of(["run", "bare.toml"]) == 0
    out = capsys.readouterr().out
    assert "1 gate passed" in out
    assert "report: reports/bare.html" in out
    (folder,) = Path("reports/bare").iterdir()
    data = json.loads((folder / "run.json").read_text())
    assert data["gates"][0]["value"] == pytest.approx(28.7860404, abs=1e-4)
    assert data["command"] == "verify run bare.toml"


def test_failed_gate_is_status_one(capsys):
    assert status_of(["run", "off.toml", "--json", "--no-report"]) == 1
    data = json.loads(capsys.readouterr().out)
    assert data["passed"] is False
    assert 100.0 < data["gates"][0]["fraction"] < 150.0
    assert not Path("reports").exists()


def test_override_skips_gates(capsys):
    assert status_of(["run", "bare.toml", "--set", "beam.length=0.5", "--to", "out"]) == 0
    assert "skipped fundamental" in capsys.readouterr().out
    assert {one.name for one in Path("out").iterdir()} == {"bare_beam.length=0.5", "bare_beam.length=0.5.html"}


def test_a_run_that_judges_nothing_has_not_passed(capsys):
    head, _, tail = BARE.partition("[spectrum]")
    Path("gates.toml").write_text(head + "[[gate]]" + tail.partition("[[gate]]")[2])
    assert status_of(["run", "gates.toml", "--no-report"]) == 0
    assert status_of(["run", "gates.toml", "--no-report", "--set", "beam.length=0.5"]) == 1
    assert "nothing is judged" in capsys.readouterr().out


@pytest.mark.parametrize("table", ["gate", "claim"])
def test_an_emptied_list_is_refused_since_it_judges_nothing(capsys, table):
    Path("empty.toml").write_text(f"{table} = []\n" + BARE.partition("[[gate]]")[0] + "[convergence]\ncounts = [9, 19]")
    assert status_of(["run", "empty.toml", "--no-report"]) == 2
    assert f"{table} = []" in capsys.readouterr().err
    Path("empty.toml").write_text(BARE.partition("[[gate]]")[0] + "[convergence]\ncounts = [9, 19]")
    assert status_of(["run", "empty.toml", "--no-report"]) == 0


def test_several_scenes_have_an_index(capsys):
    assert status_of(["run", "bare.toml", "off.toml"]) == 1
    out, err = capsys.readouterr()
    assert "1 of 2 scenes failed" in out
    assert err.splitlines() == ["2 scenes", "1 of 2 scenes: bare.toml", "2 of 2 scenes: off.toml"]
    page = Path("reports/index.html").read_text()
    assert 'href="bare.html"' in page
    assert 'href="off.html"' in page


def test_processes_change_nothing(capsys, monkeypatch):
    seen = []
    for jobs in ("1", "3"):
        monkeypatch.setenv("VERIFY_JOBS", jobs)
        assert status_of(["run", "bare.toml", "off.toml", "bare.toml", "--no-report", "--json"]) == 1
        lines = json.loads(capsys.readouterr().out)["scenes"]
        seen.append([{**line, "seconds": 0.0} for line in lines])
    assert seen[0] == seen[1]
    assert [line["scene"] for line in seen[0]] == ["bare", "off", "bare"]


def test_scene_that_cannot_run(capsys):
    assert status_of(["run", "bare.toml", "nowhere", "--no-report", "--json"]) == 2
    good, bad = json.loads(capsys.readouterr().out)["scenes"]
    assert good["passed"] is True
    assert "nowhere" in bad["errors"][0]


def test_diff_of_saved_runs(capsys):
    assert status_of(["run", "bare.toml"]) == 0
    assert status_of(["run", "bare.toml", "--set", "gate.fundamental.within=1e-9", "--to", "later"]) == 1
    capsys.readouterr()
    assert status_of(["diff", "reports", "later", "--json"]) == 1
    data = json.loads(capsys.readouterr().out)
    assert [one.endswith(": fundamental") for one in data["broken"]] == [True]
    assert status_of(["diff", "later", "reports"]) == 0
    assert status_of(["diff", "reports", "reports"]) == 0


def test_interrupt_is_status_130(capsys, monkeypatch):
    def interrupted(*arguments, **more):
        raise KeyboardInterrupt

    monkeypatch.setattr("verify.commands.run.run_scene", interrupted)
    assert status_of(["run", "bare.toml"]) == 130
    assert capsys.readouterr().err.strip() == "verify: interrupted"
    assert not list(Path("reports").iterdir())


@pytest.mark.skipif(sys.platform == "win32", reason="pipes of POSIX")
@pytest.mark.parametrize(
    "line", ["scenes show paper", "measure paper mode.frequency model=analytic mode=1", "run bare.toml"]
)
def test_broken_pipe_is_status_141(line):
    reading, writing = os.pipe()
    os.close(reading)
    done = subprocess.run([*VERIFY, *line.split()], stdout=writing, stderr=subprocess.PIPE, check=False)
    os.close(writing)
    assert done.returncode == 141
    assert done.stderr == b""


@pytest.mark.skipif(sys.platform == "win32", reason="streams of POSIX")
@pytest.mark.parametrize(
    ("line", "status"), [("measure paper mode.frequency model=analytic mode=1", 0), ("measure paper nosuch", 2)]
)
def test_closed_streams_change_no_status(line, status):
    done = subprocess.run(["sh", "-c", '"$@" >&- 2>&-', "sh", *VERIFY, *line.split()], check=False)
    assert done.returncode == status


@pytest.mark.skipif(not Path("/dev/full").exists(), reason="no /dev/full")
def test_full_disk_is_one_sentence():
    with open("/dev/full", "w") as full:
        done = subprocess.run([*VERIFY, "scenes"], stdout=full, stderr=subprocess.PIPE, check=False)
    assert done.returncode == 2
    assert done.stderr.count(b"\n") == 1
    assert b"disk space" in done.stderr
