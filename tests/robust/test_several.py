"""Several scenes in one command, ended on the way or run twice at once: no process stays, no page is half."""

import json
import os
import signal
import sys
from pathlib import Path
from time import monotonic, sleep

import pytest
from ended import started, whole

pytestmark = pytest.mark.skipif(sys.platform != "linux", reason="sessions of processes are read from /proc")
SCENE = """
name = "NAME"
beam = { length = 0.61, width = 0.03, thickness = 0.002, youngs_modulus = 71e9, density = 2710.0 }
spectrum = { modes = 4, count = COUNT }
"""
NAMES = ("first", "second", "third")
LONGEST_S = 60.0


def of_session(leader):
    """Processes that still run in the session of one."""
    found = set()
    for entry in Path("/proc").iterdir():
        if entry.name.isdigit() and int(entry.name) != leader:
            try:
                fields = (entry / "stat").read_text().rpartition(")")[2].split()
            except OSError:
                continue
            if int(fields[3]) == leader and fields[0] != "Z":
                found.add(int(entry.name))
    return found


@pytest.mark.parametrize(("how", "status"), [(signal.SIGINT, 130), (signal.SIGTERM, 143)])
def test_a_run_of_several_that_is_told_to_end_takes_its_processes_with_it(tmp_path, how, status):
    """Told as soon as two scenes are at work; the reports that were whole by then stay."""
    words = ["run", "paper-slider", "stress", "--reports", "out"]
    process = started(words, tmp_path, VERIFY_JOBS="2", start_new_session=True)
    until = monotonic() + LONGEST_S
    while len(of_session(process.pid)) < 2 and monotonic() < until:
        sleep(0.02)
    assert len(of_session(process.pid)) >= 2
    process.send_signal(how)
    _, err = process.communicate()
    assert process.returncode == status
    assert err.decode().endswith("nothing half-written is left\n")
    assert b"Traceback" not in err
    assert of_session(process.pid) == set()
    assert not (tmp_path / "out" / "index.html").exists()
    assert not list(tmp_path.rglob("*.part"))


def test_two_runs_of_the_same_scenes_at_once_leave_all_whole(tmp_path):
    for n, name in enumerate(NAMES):
        (tmp_path / f"{name}.toml").write_text(SCENE.replace("NAME", name).replace("COUNT", str(9 + n)))
    words = ["run", *(f"{name}.toml" for name in NAMES)]
    runs = [started(words, tmp_path, VERIFY_JOBS="2") for _ in range(2)]
    assert [run.communicate()[1] for run in runs] == [b"", b""]
    assert [run.returncode for run in runs] == [0, 0]
    reports = tmp_path / "reports"
    assert sorted(path.name for path in reports.glob("*.html")) == sorted([*(f"{name}.html" for name in NAMES), "index.html"])  # fmt: skip
    assert all(whole(path) for path in reports.rglob("*.html"))
    for name in NAMES:
        kept = list((reports / name).iterdir())
        assert len(kept) == 2
        assert {json.loads((run / "run.json").read_text("utf-8"))["report"] for run in kept} == {name}
    assert not [path for path in os.listdir(reports) if path.startswith(".")]
