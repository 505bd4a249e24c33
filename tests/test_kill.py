"""Runs that are killed or interrupted at any moment: files are whole or absent, the next run passes."""

import signal
import subprocess
import sys
from time import sleep

import pytest

pytestmark = pytest.mark.skipif(sys.platform == "win32", reason="signals")
SCENE = """
name = "mine"
beam = { length = 0.61, width = 0.03, thickness = 0.002, youngs_modulus = 71e9, density = 2710.0 }
spectrum = { modes = 5, count = 12 }
[[gate]]
id = "first"
quantity = "mode.frequency"
arguments = { model = "segment", mode = 1, count = 12 }
at_least = 1.0
why = "It is solved."
"""


def started(folder, *words):
    command = [sys.executable, "-m", "verify", *words]
    return subprocess.Popen(command, cwd=folder, stdout=subprocess.PIPE, stderr=subprocess.PIPE)


def check_complete(folder):
    """Every page under `reports` is complete."""
    pages = [page for page in folder.rglob("[!.]*.html") if not any(p.startswith(".") for p in page.parts)]
    assert all(page.read_text("utf-8").rstrip().endswith("</html>") for page in pages)


def test_killed_run_leaves_no_half_file(tmp_path):
    (tmp_path / "mine.toml").write_text(SCENE)
    for how, seconds in ((signal.SIGKILL, 0.67), (signal.SIGINT, 1.41), (signal.SIGTERM, 0.99), (signal.SIGKILL, 1.55)):
        process = started(tmp_path, "run", "mine.toml")
        sleep(seconds)
        process.send_signal(how)
        process.communicate(timeout=120)
        check_complete(tmp_path / "reports")
    process = started(tmp_path, "run", "mine.toml")
    out, err = process.communicate(timeout=120)
    assert (process.returncode, err) == (0, b""), out
    assert (tmp_path / "reports").is_dir()
    check_complete(tmp_path / "reports")
