"""Input that cannot be used is one sentence and status 2, whichever command reads it, and leaves no half file."""

import json
import os
import re
import subprocess
import sys
from math import pi, sqrt
from pathlib import Path

import pytest

from verify.cli import status_of

BEAM = """name = "bare"
title = "red \\u001b[31m and a null \\u0000"
[beam]
length = 0.43
bending_stiffness = 3.1
mass_per_length = 0.27
supports = ["pinned", "pinned"]
[sweep]
quantities = ["mode.frequency"]
over = { "beam.length" = [0.43, 2020-01-31] }
arguments = { mode = 1, model = "analytic" }
"""
ROUNDED = 'chain stepped-beam --count 9 --set beam.supports=["pinned","pinned"] --set beam.section.1.thickness=1e6'
READERS = dict.fromkeys(("", ".csv", ".vtu", ".uff"), "compare steel-cantilever {}") | {
    ".toml": "plan {}",
    ".xml": "compare {}",
    ".txt": "compare steel-cantilever 27.6 --modes {}",
    ".json": "diff {0} {0}",
    ".jsonl": "sweep steel-cantilever mode.frequency mode=1,2 model=analytic --to {}",
}
GATE = {"id": "g", "passed": True, "value": 1.5, "expected": "2"}
RUN = {"report": "a", "verdict": {"level": "trusted", "headline": "h"}, "gates": [GATE], "inputs": {}}
RUN |= {"environment": {"numpy": "2"}}
CONTROL = re.compile(r"[\x00-\x09\x0b-\x1f\x7f-\x9f]")
VERIFY = [sys.executable, "-m", "verify"]
POSIX = pytest.mark.skipif(sys.platform == "win32", reason="pipes, devices and limits of POSIX")


@pytest.fixture(autouse=True)
def folder(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "bare.toml").write_text(BEAM)
    return tmp_path


@pytest.fixture
def refused(capsys):
    """Call a command line that is refused; its only sentence."""

    def called(line):
        assert status_of(line.split()) == 2
        out, err = capsys.readouterr()
        assert (out, err[:8], err.count("\n")) == ("", "verify: ", 1)
        assert not re.search(r"regex|Traceback|Error\b|known are\s*$", err)
        return err

    return called


@POSIX
@pytest.mark.parametrize("what", ["too long", "pipe", "device", "too large", "closed folder"])
@pytest.mark.parametrize("suffix", READERS)
def test_a_path_that_is_no_ordinary_file_is_one_sentence(folder, refused, suffix, what):
    path = folder / f"file{suffix}"
    if what == "too long":
        path = folder / ("a" * 300 + suffix)
    elif what == "pipe":
        os.mkfifo(path)
    elif what == "device":
        path.symlink_to("/dev/zero")
    elif what == "too large":
        path.touch()
        os.truncate(path, 2_100_000_000)  # takes no place on disk
    elif os.geteuid() == 0:
        pytest.skip("the superuser may enter every folder")
    else:
        path = folder / "closed" / path.name
        path.parent.mkdir(mode=0)
    refused(READERS[suffix].format(path))


@POSIX
def test_a_sweep_beyond_the_limit_of_files_names_the_file_and_continues(folder):
    import resource

    words = [*VERIFY, "sweep", "bare.toml", "mode.frequency", "mode=1-9", "model=analytic", "--to"]
    limit = lambda: resource.setrlimit(resource.RLIMIT_FSIZE, (1500, 1500))  # noqa: E731
    cut = subprocess.run([*words, "cut"], capture_output=True, preexec_fn=limit, text=True, check=False)
    assert (cut.returncode, "'cut'" in cut.stderr, cut.stderr.count("\n")) == (2, True, 1)
    whole, again = (subprocess.run([*words, name], capture_output=True, check=True) for name in ("whole", "cut"))
    assert again.stdout == whole.stdout
    assert Path("cut").read_bytes() == Path("whole").read_bytes()


@pytest.mark.parametrize("value", [2, "2", [1.5], {"re": 1.5, "im": 0.0}, None, True, 10**400, "\x1b[31m"])
@pytest.mark.parametrize("place", ["value", "passed", "id", "expected", "inputs", "gates"])
def test_runs_of_other_types_are_compared_or_refused(capsys, place, value):
    other = json.loads(json.dumps(RUN))
    (other["gates"][0] if place in GATE else other)[place] = value
    for name, run in {"a.json": RUN, "b.json": other}.items():
        Path(name).write_text(json.dumps(run))
    for pair in (("a.json", "b.json"), ("b.json", "a.json")):
        status = status_of(["diff", *pair])
        out, err = capsys.readouterr()
        assert (status in (0, 1)) == (err == "")
        assert not CONTROL.search(out)


def test_a_date_in_a_swept_list_is_a_reason(capsys):
    assert status_of(["table", "bare.toml", "--study", "sweep", "--json"]) == 0
    good, dated = json.loads(capsys.readouterr().out)["tables"][0]["rows"]
    assert good["mode.frequency"] == pytest.approx(pi / 2.0 * sqrt(3.1 / 0.27) / 0.43**2, rel=1e-9)
    assert (dated["mode.frequency"], "2020-01-31" in dated["reason"]) == (None, True)


@pytest.mark.parametrize(
    "line", ["run bare.toml --no-report", "table bare.toml --study sweep", "scenes show bare.toml"]
)
def test_control_characters_do_not_reach_the_terminal(capsys, line):
    status_of(line.split())
    assert not CONTROL.search(capsys.readouterr().out)


@pytest.mark.parametrize("text", ["", "<mujoco>", "<sdf/>", "<robot><link/></robot", "<mujoco><worldbody/>"])
def test_rules_and_damage_are_said_in_words(refused, text):
    Path("chain.xml").write_text(text)
    named = ["plan bare.toml --set name=a/b", "measure bare.toml drive.moment_per_volt a=1"]
    for line in ["compare chain.xml", ROUNDED, *named]:
        refused(line)


def test_charts_are_drawn_whatever_backend_the_environment_names():
    words = [*VERIFY, "export", "bare.toml", "--what", "modes", "--to", "modes.png"]
    subprocess.run(words, check=True, capture_output=True, env=os.environ | {"MPLBACKEND": "nonsense"})
    assert Path("modes.png").read_bytes()[1:4] == b"PNG"


def test_an_interrupt_while_a_file_is_tidied_up_leaves_no_folder(folder):
    script = """
import os, shutil, signal
from pathlib import Path
from verify.files import write_whole
todo = [shutil.rmtree, lambda *words, **options: os.kill(os.getpid(), signal.SIGINT)]
shutil.rmtree = lambda *words, **options: todo.pop()(*words, **options)
write_whole(Path("a.csv"), "text")
"""
    subprocess.run([sys.executable, "-c", script], capture_output=True, check=False)
    assert sorted(one.name for one in folder.iterdir()) == ["a.csv", "bare.toml"]
