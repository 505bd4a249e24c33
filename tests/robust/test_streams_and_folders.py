"""Closed and full streams, folders that take nothing, homes that are not there, two runs at once."""

import json
import os
import sys

import pytest
from ended import SCENE, SMALL, shell, started, whole

from verify.files import STALE_S, write_whole

pytestmark = pytest.mark.skipif(sys.platform != "linux", reason="a shell, /dev/full and limits of files")
FULL = "verify: what is printed cannot be written (No space left on device): make room, or send it elsewhere\n"


@pytest.fixture
def folder(tmp_path):
    (tmp_path / "mine.toml").write_text(SCENE)
    return tmp_path


@pytest.mark.parametrize("closed", [">&-", "2>&-", "<&- >&- 2>&-"])
def test_a_closed_stream_changes_neither_the_verdict_nor_the_report(folder, closed):
    """Nor does what is printed go into the next file that is opened: it would have the stream's number."""
    status, out, err = shell(f"$V {' '.join(SMALL)} {closed}", folder)
    assert status == 0
    assert err == ""
    assert ("all 1 gates passed" in out) == (">&-" not in closed.replace("2>&-", ""))
    names = sorted(path.name for path in folder.rglob("*.*"))
    assert names == ["index.html", "mine.html", "mine.toml", "run.json"]
    page = (folder / "reports" / "mine.html").read_text("utf-8")
    assert page.startswith("<!doctype html>")
    assert whole(folder / "reports" / "mine.html")


def test_a_refusal_on_a_closed_stream_is_a_status(folder):
    assert shell("$V run nothing 2>&-", folder) == (2, "", "")
    assert shell("$V run nothing >&- 2>/dev/full", folder) == (2, "", "")
    assert shell("$V --nonsense 2>/dev/full", folder) == (2, "", "")


@pytest.mark.parametrize("words", ["run mine.toml --no-report", "scenes --json", "quantities", "plan mine.toml"])
def test_a_full_disk_behind_what_is_printed_is_one_sentence(folder, words):
    assert shell(f"$V {words} >/dev/full", folder) == (2, "", FULL)


def test_a_full_disk_behind_a_report_is_one_sentence_and_leaves_nothing(folder):
    """A limit of 4 KiB for files, which a page exceeds."""
    status, out, err = shell(f"ulimit -f 4; $V {' '.join(SMALL)} | cat", folder)
    assert (status, out) == (0, "")  # of cat
    assert err == "verify: reports = 'reports/mine' cannot be written to (File too large)\n"
    assert list((folder / "reports").iterdir()) == []


def test_a_reader_that_takes_one_line_ends_it_quietly_and_the_report_is_whole(folder):
    status, out, err = shell(f"$V {' '.join(SMALL)} | head -1; exit ${{PIPESTATUS[0]}}", folder)
    assert (status, err) in ((0, ""), (141, ""))  # whichever was faster
    assert out == "A strip\n"
    assert whole(folder / "reports" / "mine.html")


@pytest.mark.parametrize("home", ["-u HOME", "HOME=/proc/1"])
def test_no_home_is_needed(folder, home):
    status, out, err = shell(f"env {home} $V run mine.toml --json", folder)
    assert (status, err) == (0, "")
    assert json.loads(out)["passed"] is True


def test_two_runs_into_one_folder_at_once_leave_one_whole_report(folder):
    runs = [started(SMALL, folder) for _ in range(2)]
    assert [run.communicate()[1] for run in runs] == [b"", b""]
    assert [run.returncode for run in runs] == [0, 0]
    assert sorted(path.name for path in (folder / "reports").iterdir()) == ["mine", "mine.html"]
    assert whole(folder / "reports" / "mine.html")
    kept = sorted((folder / "reports" / "mine").iterdir())
    assert [sorted(one.name for one in run.iterdir()) for run in kept] == [["index.html", "run.json"]] * 2


@pytest.mark.parametrize("kind", ["a file", "a link to nothing", "a loop", "below a file"])
def test_a_folder_of_reports_that_is_none_is_refused_before_anything_is_run(folder, kind):
    reports = folder / "there"
    if kind == "a file":
        reports.write_text("mine")
    elif kind == "below a file":
        reports.write_text("mine")
        reports = reports / "below"
    else:
        reports.symlink_to("there" if kind == "a loop" else "nothing")
    status, out, err = shell(f"$V run mine.toml --reports {reports.relative_to(folder)}", folder)
    assert (status, out) == (2, "")
    assert err.startswith(f"verify: reports = '{reports.relative_to(folder)}' cannot be written to (")
    assert err.count("\n") == 1


def test_a_report_goes_through_a_link_to_a_folder_and_takes_the_place_of_a_link_to_a_file(folder):
    """The file that the second points to lies outside the folder, and stays as it is."""
    (folder / "far").mkdir()
    (folder / "near").symlink_to("far")
    (folder / "kept.html").write_text("mine")
    (folder / "far" / "mine.html").symlink_to(folder / "kept.html")
    assert shell("$V run mine.toml --reports near", folder)[0] == 0
    assert whole(folder / "far" / "mine.html")
    assert not (folder / "far" / "mine.html").is_symlink()
    assert (folder / "kept.html").read_text() == "mine"


@pytest.mark.skipif(not hasattr(os, "getuid") or os.getuid() == 0, reason="nothing is closed to root")
def test_a_folder_that_nobody_may_write_to_is_refused(folder):
    (folder / "shut").mkdir(mode=0o500)
    assert "shut' cannot be written to (Permission denied)" in shell("$V run mine.toml --reports shut", folder)[2]


def test_what_a_killed_run_left_is_taken_away_and_what_another_still_writes_is_not(tmp_path):
    left, young, other = (tmp_path / f".{name}.part" for name in ("r[1].html.old", "r[1].html.new", "s.html.old"))
    for part, age in ((left, STALE_S + 60.0), (young, STALE_S - 60.0), (other, STALE_S + 60.0)):
        part.write_text("half")
        os.utime(part, (part.stat().st_mtime - age,) * 2)
    write_whole(tmp_path / "r[1].html", "whole")
    assert sorted(path.name for path in tmp_path.iterdir()) == sorted([young.name, other.name, "r[1].html"])
